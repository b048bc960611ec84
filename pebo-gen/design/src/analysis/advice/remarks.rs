//! Remarks for the user of an observer, on which no claim depends: equilibrium, drift, and restarts of the extension.
//!
//! Computed once, on first use: callers that print no remarks, as the macro, do not pay for them.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Expr, Symbol};

use super::drift::rebase_residuals;
use super::remark::{Drift, Equilibrium};
use crate::analysis::design::Derivation;

impl Derivation {
    /// The equilibrium of the plant, which must be the one of this derivation; none without a proved cascade.
    pub fn operating_point(&self, plant: &Plant) -> Option<&Equilibrium> {
        self.remarks.operating_point.get_or_init(|| Equilibrium::of(plant, self)).as_ref()
    }

    /// The components of the extension that a constant bias makes run away; none without a proved cascade, where there is
    /// no such component, or where the extension is moved to the estimate at each sample.
    pub fn drift(&self, plant: &Plant) -> Option<&Drift> {
        if self.at_estimate().is_some() {
            return None;
        }
        let found = || Drift::of(plant, self).filter(|drift| !drift.integrators.is_empty());
        self.remarks.drift.get_or_init(found).as_ref()
    }

    /// The borders at which components of the transform provably or possibly jump: theta is another constant on each
    /// side. None if the borders are undecided.
    pub fn jumps(&self, plant: &Plant) -> Vec<(Symbol, Expr)> {
        let (arena, domain) = (&plant.arena, self.domain(plant));
        let constant: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let varies = |expr: Expr| !arena.symbols_of(&[expr]).is_subset(&constant);
        let of_component = |(component, z): (Expr, &Symbol)| {
            let jumps = domain.jumps(arena, component, varies).unwrap_or_default();
            jumps.into_iter().map(|jump| (*z, jump.border)).collect::<Vec<_>>()
        };
        plant.transform().into_iter().zip(&plant.z).flat_map(of_component).collect()
    }

    /// Tests whether a constant may be moved from theta to the extension at run time (`Rebase` of the runtime): proved.
    pub fn can_rebase(&self, plant: &Plant) -> bool {
        *self.remarks.rebase.get_or_init(|| {
            let domain = plant.domain();
            // One at the estimate has its slopes where the extension is, and has to be moved.
            if self.at_estimate().is_some() {
                return true;
            }
            let regression = self.regression.result.as_ref();
            regression
                .and_then(|regression| rebase_residuals(plant, self.class, regression))
                .is_some_and(|residuals| residuals.iter().all(|e| is_zero(&plant.arena, *e, &domain)))
        })
    }
}
