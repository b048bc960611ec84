/// Surface-mounted permanent magnet synchronous motor, position from currents and speed
#[pebo_macros::pebo_model(
    reference = "Ortega et al. 2015, Section 5.2",
    assume(L > 0.0, lambda_m > 0.0, n_p > 0.0),
    angles(q = 2 * PI / n_p)
)]
pub(crate) mod pmsm {
    #![allow(non_upper_case_globals)]

    pub(crate) const R: f64 = 8.875;
    pub(crate) const L: f64 = 40.03e-3;
    pub(crate) const n_p: f64 = 5.0;
    pub(crate) const lambda_m: f64 = 0.2086;

    #[derive(Clone, Copy)]
    pub(crate) struct X {
        pub(crate) q: f64,
    }
    #[derive(Clone, Copy)]
    pub(crate) struct Y {
        pub(crate) i1: f64,
        pub(crate) i2: f64,
    }
    #[derive(Clone, Copy)]
    pub(crate) struct U {
        pub(crate) v1: f64,
        pub(crate) v2: f64,
        pub(crate) w: f64,
    }

    pub(crate) fn f_x(u: U) -> X {
        X { q: u.w }
    }

    pub(crate) fn f_y(x: X, y: Y, u: U) -> Y {
        let (sine, cosine) = (n_p * x.q).sin_cos();
        let emf = n_p * lambda_m * u.w;
        Y { i1: (u.v1 - R * y.i1 + emf * sine) / L, i2: (u.v2 - R * y.i2 - emf * cosine) / L }
    }

    pub(crate) fn phi(x: X, y: Y) -> [f64; 2] {
        let angle = n_p * x.q;
        [L * y.i1 + lambda_m * angle.cos(), L.mul_add(y.i2, lambda_m * angle.sin())]
    }
}
