//! The forms of ordinary Rust that the attribute reads mean what the compiled functions compute.

use pebo_macros::pebo_model;

/// Two states by everything that the reader knows, in single precision.
#[pebo_model(assume(M > 0))]
mod forms {
    use core::f32::consts::{self, FRAC_PI_2 as QUARTER, PI};

    /// A name for the type, as firmware likes it.
    pub(crate) type Real = f32;

    const M: Real = 2.0;
    const TWICE: Real = 2.0 * M;
    const GAINS: [Real; 2] = [0.5, 0.25];
    const POLES: i32 = 3;
    const FIRST: usize = 0;

    #[derive(Debug, PartialEq)]
    pub(crate) struct X {
        pub(crate) p: Real,
        pub(crate) r: Real,
    }
    #[derive(Debug)]
    pub(crate) struct Y {
        pub(crate) q: Real,
        pub(crate) s: Real,
    }
    #[derive(Debug)]
    pub(crate) struct U {
        pub(crate) tau: Real,
    }

    const fn doubled(a: Real) -> Real {
        a + a
    }

    fn torque(&Y { q, .. }: &Y) -> Real {
        let (sine, cosine) = q.sin_cos();
        sine.mul_add(GAINS[FIRST], cosine * GAINS[1])
    }

    pub(crate) fn f_x(y: &Y, &U { tau }: &U) -> X {
        let scale: Real = M.recip();
        let scale = { scale * TWICE };
        let [first, second] = GAINS;
        let friction = y.q.signum().max(first) - tau.clamp(-second, second).min(y.q);
        let base = X { p: tau * scale + torque(y) + friction, r: 0.0 };
        let turns = (y.q / PI).powi(POLES) + (y.q * consts::TAU).cos() - QUARTER;
        X { r: doubled(turns) + first.hypot(second) + 30.0_f32.to_radians() + f32::from(2_u8), ..base }
    }

    pub(crate) fn f_y(x: &X) -> Y {
        let X { p, r } = *x;
        Y { q: p / M, s: r * core::f32::consts::SQRT_2 }
    }

    pub(crate) fn phi(X { p, r }: &X) -> (Real, Real) {
        (*p, *r)
    }
}

#[test]
fn the_read_plant_is_the_compiled_one() {
    use forms::{NR, U, X, Y};
    for (q, tau) in [(0.3, 1.5), (-2.0, 0.25), (4.0, -8.0)] {
        let (y, u) = (Y { q, s: 0.0 }, U { tau });
        let (rate, h) = (forms::f_x(&y, &u), forms::h(&y, &u));
        // A dozen operations of single precision on values below ten.
        for (written, derived) in [(rate.p, h[0]), (rate.r, h[1])] {
            assert!((written - derived).abs() < 1e-5, "{written} and {derived}");
        }
        let x = X { p: 0.7, r: -0.2 };
        let z: [f32; 2] = forms::phi(&x).into();
        assert_eq!(forms::phi_left(z, &y), x);
        let (known, factor): ([f32; NR], _) = (forms::phi_0(z, &y, &u), forms::phi_1(z, &y, &u));
        let slopes = forms::f_y(&x);
        assert!((known[0] - slopes.q).abs() < 1e-6 && (known[1] - slopes.s).abs() < 1e-6 && y.s == 0.0);
        assert!((factor[0][0] - 0.5_f32).abs() < 1e-6 && factor[0][1] == 0.0);
    }
}

/// Names of the paper that the author gives to something else.
#[pebo_model(assume(h > 0))]
mod taken {
    #![allow(non_upper_case_globals)]

    pub(crate) const h: f64 = 2.0;

    pub(crate) struct X {
        pub(crate) lambda: f64,
    }
    pub(crate) struct Y {
        pub(crate) phi_0: f64,
    }

    pub(crate) fn phi_1(y: &Y) -> f64 {
        h * y.phi_0
    }
    pub(crate) fn f_x(y: &Y) -> X {
        X { lambda: phi_1(y) }
    }
    pub(crate) fn f_y(x: &X) -> Y {
        Y { phi_0: x.lambda }
    }
    pub(crate) fn phi(x: &X) -> [f64; 1] {
        [x.lambda]
    }
}

#[test]
fn names_that_the_module_has_stay_the_authors() {
    let y = taken::Y { phi_0: 1.5 };
    let [known] = taken::phi_0([0.25], &y);
    let x = taken::phi_left([known], &y);
    assert_eq!(
        [taken::h, taken::phi_1(&y), taken::f_y(&x).phi_0].map(f64::to_bits),
        [2.0, 3.0, 0.25].map(f64::to_bits)
    );
    // The model has all of them.
    let model = taken::Taken::new(&taken::Parameters::default());
    let ([h], [[factor]]) = (model.h((&y).into(), taken::U), model.phi_1([0.25], y.into(), taken::U));
    assert_eq!([h, factor].map(f64::to_bits), [3.0, 1.0].map(f64::to_bits));
}
