#[pebo_macros::pebo_model(title = "Levitated ball, position from current and speed", assume(k > 0, c - q > 0, i > 0))]
pub(crate) mod ball {
    #![allow(non_upper_case_globals)]

    const R: f64 = 2.52;
    const k: f64 = 6.4e-5;
    const c: f64 = 0.005;

    pub(crate) struct X {
        pub(crate) q: f64,
    }
    pub(crate) struct Y {
        pub(crate) i: f64,
    }
    pub(crate) struct U {
        pub(crate) e: f64,
        pub(crate) v: f64,
    }

    pub(crate) fn f_x(u: &U) -> X {
        X { q: u.v }
    }
    pub(crate) fn f_y(&X { q }: &X, &Y { i }: &Y, &U { e, v }: &U) -> Y {
        Y { i: (e - R * i) * (c - q) / k - v * i / (c - q) }
    }
    pub(crate) fn phi(x: &X, y: &Y) -> f64 {
        k * y.i / (c - x.q)
    }
}
