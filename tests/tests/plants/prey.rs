#[pebo_macros::pebo_model(title = "Lotka-Volterra, prey from predators", assume(x > 0, y > 0))]
pub(crate) mod prey {
    #![allow(non_upper_case_globals)]

    pub(crate) const a: f64 = 1.0;
    pub(crate) const b: f64 = 0.5;
    pub(crate) const c: f64 = 0.7;
    pub(crate) const d: f64 = 0.3;

    pub(crate) struct X {
        pub(crate) x: f64,
    }
    pub(crate) struct Y {
        pub(crate) y: f64,
    }

    pub(crate) fn f_x(x: &X, y: &Y) -> X {
        X { x: x.x * (a - b * y.y) }
    }
    pub(crate) fn f_y(x: &X, y: &Y) -> Y {
        Y { y: y.y * (d * x.x - c) }
    }
    pub(crate) fn phi(x: &X) -> [f64; 1] {
        [x.x.ln()]
    }
}
