//! The explicit method, for plants about as fast as their sampling.
//!
//! Method: Dormand and Prince's explicit Runge-Kutta pair of order 5(4), from a library. The first step tried is the
//! whole interval: a well-sampled loop needs one step a sample.

use std::fmt;

use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::OrdinaryNumericalMethod;

use super::equation::{ABSOLUTE, Equation, RELATIVE, SHORTEST, Solver, Standstill, StepCallback};

/// The method, made once for the run: its start resets everything but the count of its steps, which nothing depends on.
pub(crate) struct ExplicitMethod<const N: usize>(DormandPrinceOf<N>);

type DormandPrinceOf<const N: usize> = ExplicitRungeKutta<Ordinary, DormandPrince, f64, [f64; N], 5, 7, 7>;

impl<const N: usize> ExplicitMethod<N> {
    pub(crate) fn new() -> Self {
        Self(ExplicitRungeKutta::dopri5().rtol(RELATIVE).atol(ABSOLUTE).max_steps(usize::MAX))
    }
}

impl<const N: usize> fmt::Debug for ExplicitMethod<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Explicit<{N}>")
    }
}

impl<const N: usize> Solver for ExplicitMethod<N> {
    fn solve(
        &mut self,
        rates: &Equation,
        state: &mut [f64],
        length: f64,
        most: u64,
        mut watch: Option<&mut StepCallback<'_>>,
    ) -> Result<u64, Standstill> {
        let mut start = [0.0; N];
        start[..state.len()].copy_from_slice(state);
        let method = &mut self.0;
        let origin = rates.0.borrow().origin;
        let standstill = |method: &DormandPrinceOf<N>, steps| Standstill {
            steps,
            at: origin + method.t(),
            state: method.y()[..state.len()].to_vec(),
            fast: None,
        };
        method.h0 = length;
        let mut steps = 0;
        if method.init(rates, 0.0, length, &start).is_err() {
            return Err(Standstill { steps, at: origin, state: state.to_vec(), fast: None });
        }
        loop {
            let rest = length - method.t();
            if rest <= SHORTEST * length {
                break;
            }
            if steps == most || method.h().is_nan() || method.h() <= SHORTEST * length {
                return Err(standstill(method, steps));
            }
            if method.h() > rest {
                method.set_h(rest);
            }
            let before = method.t();
            if method.step(rates).is_err() {
                return Err(standstill(method, steps));
            }
            steps += 1;
            // A refused step has changed nothing.
            if method.t() > before
                && let Some(watch) = &mut watch
                && watch(method.t(), &method.y()[..state.len()])
            {
                break;
            }
        }
        state.copy_from_slice(&method.y()[..state.len()]);
        Ok(steps)
    }
}
