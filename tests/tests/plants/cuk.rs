/// DC-DC Cuk converter, inductor currents from capacitor voltages.
#[pebo_macros::pebo_model(
    reference = "Ortega et al. 2015, Section 5.3, case I",
    assume(L1 > 0, C2 > 0, L3 > 0, C4 > 0, 0 < d < 1),
    units(L1 = "H", C2 = "F", L3 = "H", C4 = "F", G = "S", E = "V", i1 = "A", i3 = "A", v2 = "V", v4 = "V")
)]
pub(crate) mod cuk {
    pub(crate) const L1: f64 = 10e-3;
    pub(crate) const C2: f64 = 22e-6;
    pub(crate) const L3: f64 = 10e-3;
    pub(crate) const C4: f64 = 22.9e-6;
    pub(crate) const G: f64 = 0.0447;
    pub(crate) const E: f64 = 12.0;

    /// Inductor currents in A.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct X {
        pub(crate) i1: f64,
        pub(crate) i3: f64,
    }

    /// Capacitor voltages in V.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct Y {
        pub(crate) v2: f64,
        pub(crate) v4: f64,
    }

    /// The duty cycle.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(crate) struct U {
        pub(crate) d: f64,
    }

    /// The share of the period in which the switch is open.
    fn off(u: U) -> f64 {
        1.0 - u.d
    }

    pub(crate) fn f_x(y: &Y, u: U) -> X {
        let Y { v2, v4 } = *y;
        let i1 = (E - off(u) * v2) / L1;
        X { i1, i3: -(u.d * v2 + v4) / L3 }
    }

    pub(crate) fn f_y(x: &X, y: &Y, u: U) -> Y {
        Y { v2: (off(u) * x.i1 + u.d * x.i3) / C2, v4: (x.i3 - G * y.v4) / C4 }
    }

    pub(crate) fn phi(X { i1, i3 }: &X) -> [f64; 2] {
        [*i1, *i3]
    }
}
