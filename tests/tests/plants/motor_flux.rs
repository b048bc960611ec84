/// Fluxes of a permanent magnet motor from its currents.
#[pebo_macros::pebo_model(
    reference = "Ortega et al. 2015, Section 5.2, eq. 28",
    assume(L > 0, lambda_m > 0),
    units(
        R = "ohm", L = "H", lambda_m = "Wb", l1 = "Wb", l2 = "Wb", i1 = "A", i2 = "A", omega = "rad/s", v1 = "V", v2 = "V"
    )
)]
pub(crate) mod motor_flux {
    #![allow(non_upper_case_globals)]

    pub(crate) const R: f64 = 8.875;
    pub(crate) const L: f64 = 40.03e-3;
    pub(crate) const n_p: f64 = 5.0;
    pub(crate) const lambda_m: f64 = 0.2086;

    #[derive(Clone, Copy)]
    pub(crate) struct X {
        pub(crate) l1: f64,
        pub(crate) l2: f64,
    }
    #[derive(Clone, Copy)]
    pub(crate) struct Y {
        pub(crate) i1: f64,
        pub(crate) i2: f64,
    }
    pub(crate) struct U {
        pub(crate) v1: f64,
        pub(crate) v2: f64,
    }
    /// The speed, not measured.
    pub(crate) struct W {
        pub(crate) omega: f64,
    }

    /// The fluxes of the magnet.
    fn magnet(x: X, y: Y) -> (f64, f64) {
        (x.l1 - L * y.i1, x.l2 - L * y.i2)
    }

    pub(crate) fn f_x(y: Y, u: &U) -> X {
        X { l1: u.v1 - R * y.i1, l2: u.v2 - R * y.i2 }
    }

    pub(crate) fn f_y(x: X, y: Y, u: &U, w: &W) -> Y {
        let (m1, m2) = magnet(x, y);
        Y { i1: (u.v1 - R * y.i1 + n_p * w.omega * m2) / L, i2: (u.v2 - R * y.i2 - n_p * w.omega * m1) / L }
    }

    pub(crate) fn phi(x: &X) -> [f64; 2] {
        [x.l1, x.l2]
    }

    pub(crate) fn identities(x: X, y: Y) -> [f64; 1] {
        let (m1, m2) = magnet(x, y);
        [m1.powi(2) + m2.powi(2) - lambda_m.powi(2)]
    }
}
