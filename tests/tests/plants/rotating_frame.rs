#[pebo_macros::pebo_model(
    title = "Two components of a vector in a rotating frame from the integral of one",
    class = "gpebo",
    assume(k > 0)
)]
pub(crate) mod rotating_frame {
    #![allow(non_upper_case_globals)]

    pub(crate) const k: f64 = 2.0;

    #[derive(Clone, Copy)]
    pub(crate) struct X {
        pub(crate) a: f64,
        pub(crate) b: f64,
    }
    pub(crate) struct Y {
        pub(crate) s: f64,
    }
    pub(crate) struct U {
        pub(crate) w: f64,
        pub(crate) v: f64,
    }

    pub(crate) fn f_x(x: X, u: &U) -> X {
        X { b: -u.w * x.a, a: u.w * x.b + u.v }
    }
    pub(crate) fn f_y(x: &X) -> Y {
        Y { s: k * x.a }
    }
    pub(crate) fn phi(x: X) -> X {
        x
    }
}
