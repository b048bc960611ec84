//! Identities in the form in which the components of the transform are linear.
//!
//! In: the plant's identities; the value `g` of an output is one, `V - g = 0`. Out: of each the first form that is
//! affine in the transform, with the identity as it is written first: `V = p/(1 + p)` is `V + (V - 1)*p = 0`. Each form
//! is proved to vanish on the domain.

use std::collections::{BTreeMap, BTreeSet};

use super::equation::{self, outputs_of};
use super::separation;
use crate::analysis::affine;
use crate::analysis::design::LeftInverse;
use crate::plant::Plant;
use crate::plant::matrix::dot;
use pebo_cas::domain::zero::decide;
use pebo_cas::forms::opaque::OpaqueTerms;
use pebo_cas::solve::{Equation, cleared, solve};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Node, Symbol};

/// Affine functions of the transform that vanish by an identity; none where no form of it is one.
pub(super) fn rows(plant: &Plant, domain: &Domain, identity: Expr) -> Result<Vec<affine::Row>, Obstacle> {
    // On its own manifold an identity says 0 = 0: its equation in z is found elsewhere.
    let everywhere = domain.without_equations();
    let written = affine::of(plant, &everywhere, identity);
    if let Ok(Some(row)) = written {
        return Ok(vec![row]);
    }
    let affine = |form| as_written(plant, &everywhere, form).or_else(|| affine::of(plant, &everywhere, form).ok()?);
    let by_others = with_other_values(plant, domain, identity);
    if let Some(row) = forms(plant, domain, identity).into_iter().chain(by_others).find_map(affine) {
        return Ok(vec![row]);
    }
    let components: Vec<affine::Row> = components(plant, domain, identity).into_iter().filter_map(affine).collect();
    if components.is_empty() { written.map(|_| components) } else { Ok(components) }
}

/// A form over the transform, terms free of x left as written.
fn as_written(plant: &Plant, everywhere: &Domain, form: Expr) -> Option<affine::Row> {
    let hidden = plant.hidden();
    let mut frozen = OpaqueTerms::new(&plant.arena, &hidden);
    let form = frozen.replace(&[form])[0];
    let row = affine::of(plant, everywhere, form).ok()??;
    Some(row.into_iter().map(|entry| frozen.restore(entry)).collect())
}

/// The identities as equations between z, y and u: in a form that is affine in z, else in one with separable terms,
/// else as written.
pub(super) fn in_z(plant: &Plant, domain: &Domain, left_inverse: &LeftInverse) -> Vec<equation::Equation> {
    let arena = &plant.arena;
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
    let of = |identity: Expr| {
        let written = arena.substitute(identity, &inverse);
        let everywhere = domain.without_equations();
        let is_affine = |form: Expr| matches!(affine::of(plant, &everywhere, form), Ok(Some(_)));
        if let Some(linear) = with_other_values(plant, domain, identity).filter(|form| is_affine(*form))
            && !is_affine(identity)
        {
            return vec![arena.substitute(linear, &inverse)];
        }
        let separable = |form: &Expr| matches!(separation::separate(plant, domain, &[*form]), Ok(Some(_)));
        if separable(&written) {
            return vec![written];
        }
        match rows(plant, domain, identity) {
            Ok(rows) if !rows.is_empty() => {
                rows.iter().map(|row| arena.add(row[0], dot(arena, &row[1..], &z))).collect()
            }
            _ => {
                let others = forms(plant, domain, identity).into_iter().map(|form| arena.substitute(form, &inverse));
                vec![others.into_iter().find(separable).unwrap_or(written)]
            }
        }
    };
    let mut found: Vec<equation::Equation> = Vec::new();
    for identity in &plant.identities {
        for rate in of(identity.expr) {
            // A bearing under `g_y` and the same written as an identity.
            match found.iter_mut().find(|known| known.rate == rate || known.rate == arena.neg(rate)) {
                Some(known) => known.outputs.extend(outputs_of(plant, identity)),
                None => found.push(equation::Equation::instant(arena, rate, outputs_of(plant, identity))),
            }
        }
    }
    found
}

/// An identity with the states that the other equations give: `c = a*b` is linear where an output is b.
fn with_other_values(plant: &Plant, domain: &Domain, identity: Expr) -> Option<Expr> {
    let arena = &plant.arena;
    let hidden = plant.hidden();
    let others = domain.manifold.equations().iter().copied().filter(|other| *other != identity).collect();
    let mut values = domain.manifold.of(arena, &domain.facts, others).determined();
    values.retain(|symbol, value| hidden.contains(symbol) && !arena.depends_on(*value, &hidden));
    let form = arena.substitute(identity, &values);
    (form != identity && arena.depends_on(form, &hidden)).then_some(form)
}

/// The components of the transform that are functions of a state given by an identity, each less its value.
fn components(plant: &Plant, domain: &Domain, identity: Expr) -> Vec<Expr> {
    let arena = &plant.arena;
    let hidden = plant.hidden();
    let states: Vec<Symbol> = arena.symbols_of(&[identity]).intersection(&hidden).copied().collect();
    let ([state], Some(value)) = (states.as_slice(), value(plant, identity)) else { return Vec::new() };
    let equation = Equation { formula: identity, value: arena.zero() };
    let known = solve(arena, domain, &[equation], &[*state]).unwrap_or_default().remove(state).unwrap_or_default();
    let is_the_state = |known: &Expr| {
        let error = arena.sub(arena.substitute(*known, &value), arena.of_symbol(*state));
        !arena.depends_on(*known, &hidden) && decide(arena, error, &domain.without_equations()).is_zero()
    };
    let Some(known) = known.into_iter().find(is_the_state) else { return Vec::new() };
    let at = BTreeMap::from([(*state, known)]);
    let value = |phi: Expr| Some(arena.substitute(phi, &at)).filter(|value| !arena.depends_on(*value, &hidden));
    let of_state = |phi: &Expr| arena.depends_on(*phi, &hidden);
    plant.transform().into_iter().filter(of_state).filter_map(|phi| Some(arena.sub(phi, value(phi)?))).collect()
}

/// Other forms of an identity, each proved.
fn forms(plant: &Plant, domain: &Domain, identity: Expr) -> Vec<Expr> {
    let arena = &plant.arena;
    let value = value(plant, identity);
    let mut forms = cleared(arena, domain, identity, &plant.hidden());
    forms.retain(|form| match &value {
        Some(value) => decide(arena, arena.substitute(*form, value), &domain.without_equations()).is_zero(),
        None => decide(arena, *form, domain).is_zero(),
    });
    forms
}

/// An output as a function given by an identity, where it is one term of the identity.
fn value(plant: &Plant, identity: Expr) -> Option<BTreeMap<Symbol, Expr>> {
    let arena = &plant.arena;
    let Node::Sum(sum) = arena.node(identity) else { return None };
    plant.y.iter().find_map(|output| {
        let (_, slope) = sum.terms.iter().find(|(term, _)| arena.as_symbol(*term) == Some(output.symbol))?;
        let value = arena.sub(arena.of_symbol(output.symbol), arena.scale(identity, &slope.recip()?));
        let alone = !arena.depends_on(value, &BTreeSet::from([output.symbol]));
        alone.then(|| BTreeMap::from([(output.symbol, value)]))
    })
}
