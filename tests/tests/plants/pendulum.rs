#[pebo_macros::pebo_model]
pub(crate) mod pendulum {
    #![allow(non_upper_case_globals)]

    const m: f64 = 1.0;
    const l: f64 = 0.5;
    const g: f64 = 9.81;

    pub(crate) struct X {
        pub(crate) p: f64,
    }
    pub(crate) struct Y {
        pub(crate) q: f64,
    }
    pub(crate) struct U {
        pub(crate) tau: f64,
    }

    pub(crate) fn f_x(y: &Y, u: &U) -> X {
        X { p: u.tau - m * g * l * f64::sin(y.q) }
    }
    pub(crate) fn f_y(x: &X) -> Y {
        Y { q: x.p / (m * l.powi(2)) }
    }
    pub(crate) fn phi(x: &X) -> f64 {
        x.p
    }
}
