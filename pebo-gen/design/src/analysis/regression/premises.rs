//! The claims that a regression builds on, and formulas in the coordinates z that they justify.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::affine::Row;
use crate::analysis::design::{Cascade, Class, LeftInverse};
use crate::plant::Plant;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy;
use pebo_cas::tower::Field;
use pebo_cas::{Arena, Domain, Expr, Symbol};

/// A plant with its proved cascade.
#[derive(Clone, Copy)]
pub(in crate::analysis) struct Premises<'a> {
    pub(in crate::analysis) plant: &'a Plant,
    pub(in crate::analysis) domain: &'a Domain,
    pub(in crate::analysis) class: Class,
    pub(in crate::analysis) cascade: &'a Cascade,
    /// The left inverse, where it is proved.
    pub(in crate::analysis) left_inverse: Option<&'a LeftInverse>,
}

impl<'a> Premises<'a> {
    pub(super) fn arena(&self) -> &'a Arena {
        &self.plant.arena
    }

    /// The coordinates z.
    pub(super) fn z(&self) -> Vec<Expr> {
        self.plant.z.iter().map(|z| self.arena().of_symbol(*z)).collect()
    }

    /// Their symbols.
    pub(super) fn unknown(&self) -> BTreeSet<Symbol> {
        self.plant.z.iter().copied().collect()
    }

    /// The symbols of parameters.
    pub(super) fn constants(&self) -> BTreeSet<Symbol> {
        self.plant.parameters.iter().map(|parameter| parameter.symbol).collect()
    }

    pub(super) fn output(&self, output: usize) -> Expr {
        self.arena().of_symbol(self.plant.y[output].symbol)
    }

    pub(super) fn shortest(&self, expr: Expr) -> Expr {
        tidy::shortest(self.arena(), self.domain, expr)
    }

    /// Tests whether an expression is proved to vanish on the domain.
    pub(super) fn vanishes(&self, expr: Expr) -> bool {
        is_zero(self.arena(), expr, self.domain)
    }

    /// Tests whether two expressions are proved equal on the domain.
    pub(super) fn are_equal(&self, first: Expr, second: Expr) -> bool {
        self.vanishes(self.arena().sub(first, second))
    }

    pub(super) fn is_hidden(&self, expr: Expr) -> bool {
        self.arena().depends_on(expr, &self.plant.hidden())
    }

    /// Tests whether an unmeasured signal occurs.
    pub(super) fn is_moved(&self, expr: Expr) -> bool {
        self.arena().depends_on(expr, &self.plant.w.iter().copied().collect())
    }

    /// A function of z at z = phi(x, y).
    pub(super) fn at_phi(&self, in_z: Expr) -> Expr {
        let transform = self.plant.z.iter().copied().zip(self.plant.transform());
        self.arena().substitute(in_z, &transform.collect())
    }

    /// A function of z with the states of the extension for z, where theta is zero.
    pub(super) fn at_extension(&self, in_z: Expr) -> Expr {
        let plant = self.plant;
        let extension = if self.cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
        let states = extension.iter().map(|state| self.arena().of_symbol(*state));
        self.arena().substitute(in_z, &plant.z.iter().copied().zip(states).collect())
    }

    /// The factors of theta, from those of `z = chi + theta` or `z = xi + Psi theta`.
    pub(super) fn of_theta(&self, factors: &[Expr]) -> Vec<Expr> {
        let psi = &self.plant.psi;
        let column = |j: usize| psi.iter().map(|row| self.arena().of_symbol(row[j])).collect::<Vec<Expr>>();
        match self.cascade.lambda {
            Some(_) => (0..factors.len()).map(|j| self.arena().dot(factors, &column(j))).collect(),
            None => factors.to_vec(),
        }
    }

    /// A formula at the left inverse, if there is one. Where that is partial, states may be left.
    pub(super) fn at_left_inverse(&self, formula: Expr) -> Option<Expr> {
        let inverse: BTreeMap<Symbol, Expr> = self.left_inverse?.x.iter().copied().collect();
        Some(self.arena().substitute(formula, &inverse))
    }

    /// A rate as a function of z: a non-smooth one as it is on the domain, since the assumptions on the states decide
    /// the side, and are not known of z.
    pub(super) fn in_z(&self, rate: Expr) -> Option<Expr> {
        let arena = self.arena();
        let decided = || {
            let field = Field::over(arena, &self.domain.facts, &[rate])?;
            Ok::<Expr, pebo_cas::tower::Obstacle>(field.show(&field.fraction(rate)?))
        };
        let is_divided = arena.dividers(&[rate]).into_iter().any(|part| self.is_hidden(part));
        self.at_left_inverse(if is_divided { decided().unwrap_or(rate) } else { rate })
    }

    /// The affine function of z with these coefficients, the known term first.
    pub(super) fn of_row(&self, row: &[Expr]) -> Expr {
        self.arena().add(row[0], self.arena().dot(&row[1..], &self.z()))
    }

    /// A function of z as an affine one, the known term first, with coefficients free of z; none if it is not affine.
    pub(super) fn row(&self, in_z: Expr) -> Option<Row> {
        let (arena, unknown) = (self.arena(), self.unknown());
        let mut row: Row = self.plant.z.iter().map(|z| self.shortest(arena.derivative(in_z, *z))).collect();
        row.insert(0, self.shortest(arena.sub(in_z, arena.dot(&row, &self.z()))));
        let free = !row.iter().any(|entry| arena.depends_on(*entry, &unknown));
        (free && self.are_equal(in_z, self.of_row(&row))).then_some(row)
    }

    /// The rate of a component of the transform: `Lambda z + h`.
    pub(super) fn velocity(&self, component: usize) -> Expr {
        let lambda = self.cascade.lambda.as_ref().map(|lambda| self.arena().dot(&lambda[component], &self.z()));
        self.arena().sum(lambda.into_iter().chain([self.cascade.h[component]]))
    }
}
