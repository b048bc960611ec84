//! What is worth knowing in use and no claim rests on: where the plant rests, what drifts, whether the extension can be
//! started anew in motion.
//!
//! Worked out once, when it is first asked for: what does not print it, as the macro, does not pay for it.
//!
//! One thing with `design`, `drift` and `equilibrium`: a derivation keeps the remarks on itself, which are made of it.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::domain::zero::decide;
use pebo_cas::{Expr, Symbol};

use super::drift::{Drift, rebase_residuals};
use super::equilibrium::Equilibrium;
use crate::analysis::design::Derivation;

/// What has been asked for so far.
#[derive(Debug, Default)]
pub struct Remarks {
    operating_point: OnceCell<Option<Equilibrium>>,
    drift: OnceCell<Option<Drift>>,
    rebase: OnceCell<bool>,
}

impl Derivation {
    /// Where the plant, which must be the one that this was derived of, rests; none without a proved cascade.
    pub fn operating_point(&self, plant: &Plant) -> Option<&Equilibrium> {
        self.remarks.operating_point.get_or_init(|| Equilibrium::of(plant, self)).as_ref()
    }

    /// The components of the extension that a constant bias makes run away; none without a proved cascade, or where
    /// there is no such component.
    pub fn drift(&self, plant: &Plant) -> Option<&Drift> {
        let found = || Drift::of(plant, self).filter(|drift| !drift.integrators.is_empty());
        self.remarks.drift.get_or_init(found).as_ref()
    }

    /// The borders at which components of the transform jump, or were not shown not to: theta is another constant on each
    /// side. None where it is open which borders there are.
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

    /// Whether a constant may be moved from theta to the extension in motion (`Rebase` of the runtime): proved.
    pub fn can_rebase(&self, plant: &Plant) -> bool {
        *self.remarks.rebase.get_or_init(|| {
            let domain = plant.domain();
            let regression = self.regression.result.as_ref();
            regression
                .and_then(|regression| rebase_residuals(plant, self.class, regression))
                .is_some_and(|residuals| residuals.iter().all(|e| decide(&plant.arena, *e, &domain).is_zero()))
        })
    }
}
