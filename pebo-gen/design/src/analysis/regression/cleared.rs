//! Identities in the form in which the components of the transform are linear.
//!
//! In: the plant's identities; the value `g` of an output is one, `V - g = 0`. Out: of each the first form that is
//! affine in the transform, with the identity as it is written first: `V = p/(1 + p)` is `V + (V - 1)*p = 0`. Each form
//! is proved to vanish on the domain.

use std::collections::{BTreeMap, BTreeSet};

use super::equation::{Equation, outputs_of};
use super::implicit;
use super::premises::Premises;
use super::separation::is_separable;
use crate::analysis::affine::{self, Row};
use crate::plant::Plant;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::opaque::OpaqueTerms;
use pebo_cas::forms::tidy::with_fewer_conditions;
use pebo_cas::number::rational::half;
use pebo_cas::solve::{self, cleared, solve};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Function, Node, Symbol};

/// Affine functions of the transform that vanish by an identity; none where no form of it is one.
pub(super) fn rows(premises: &Premises<'_>, identity: Expr) -> Result<Vec<Row>, Obstacle> {
    let (plant, domain) = (premises.plant, premises.domain);
    // On its own manifold an identity says 0 = 0: its equation in z is found elsewhere.
    let everywhere = domain.without_equations();
    let written = affine::of(plant, &everywhere, identity);
    if let Ok(Some(row)) = written {
        return Ok(vec![row]);
    }
    let affine = |form| as_written(plant, &everywhere, form).or_else(|| affine::of(plant, &everywhere, form).ok()?);
    let by_others = with_other_values(premises, identity).into_iter().chain(with_other_angles(premises, identity));
    if let Some(row) = forms(premises, identity).into_iter().chain(by_others).find_map(affine) {
        return Ok(vec![row]);
    }
    let components: Vec<Row> = components(premises, identity).into_iter().filter_map(affine).collect();
    if components.is_empty() { written.map(|_| components) } else { Ok(components) }
}

/// The equation of an output's value, if that is linear in z and depends on it.
pub(super) fn value(premises: &Premises<'_>, output: usize) -> Option<Equation> {
    let value = premises.plant.y[output].value?.expr;
    let rows = rows(premises, premises.arena().sub(premises.output(output), value)).ok()?;
    let row = rows.into_iter().find(|row| row[1..].iter().any(|factor| !premises.arena().is_zero(*factor)))?;
    Some(Equation::instant(premises, premises.of_row(&row), vec![output]))
}

/// A form over the transform, terms free of x left as written.
fn as_written(plant: &Plant, everywhere: &Domain, form: Expr) -> Option<Row> {
    let hidden = plant.hidden();
    let mut frozen = OpaqueTerms::new(&plant.arena, &hidden);
    let form = frozen.replace(&[form])[0];
    let row = affine::of(plant, everywhere, form).ok()??;
    Some(row.into_iter().map(|entry| frozen.restore(entry)).collect())
}

/// The identities as equations between z, y and u: in a form that is affine in z, else in one with separable terms,
/// else as written; without a left inverse, those that are affine.
pub(super) fn in_z(premises: &Premises<'_>) -> Vec<Equation> {
    let mut found: Vec<Equation> = Vec::new();
    for identity in &premises.plant.identities {
        for rate in forms_in_z(premises, identity.expr) {
            // A bearing under `g_y` and the same written as an identity.
            let equation = Equation::instant(premises, rate, outputs_of(premises.plant, identity));
            match found.iter_mut().find(|known| known.is_same(&equation, premises)) {
                Some(known) => known.outputs.extend(equation.outputs),
                None => found.push(equation),
            }
        }
    }
    found
}

fn forms_in_z(premises: &Premises<'_>, identity: Expr) -> Vec<Expr> {
    let in_z = |form: Expr| premises.at_left_inverse(form).unwrap_or(form);
    let linear = || {
        let rows = rows(premises, identity).unwrap_or_default();
        rows.iter().map(|row| premises.of_row(row)).collect::<Vec<Expr>>()
    };
    let written = in_z(identity);
    if premises.cascade.lambda.is_some() || premises.left_inverse.is_none() {
        // Functions of theta are of no use here.
        // A left inverse may divide where the affine function does not: `z1*(z2/z1)`.
        if !premises.is_hidden(written)
            && let Some(row) = premises.row(written)
        {
            return vec![with_fewer_conditions(premises.arena(), premises.domain, written, &[premises.of_row(&row)])];
        }
        return Some(linear()).filter(|forms| !forms.is_empty()).unwrap_or_else(|| vec![written]);
    }
    let everywhere = premises.domain.without_equations();
    let affine = |form: Expr| affine::of(premises.plant, &everywhere, form).ok().flatten();
    match affine(identity) {
        // A component of phi may be a product of others, which the left inverse writes out.
        Some(row) if premises.row(written).is_none() => return vec![premises.of_row(&row)],
        Some(_) => {}
        None => {
            if let Some(form) = with_other_values(premises, identity).filter(|form| affine(*form).is_some()) {
                return vec![in_z(form)];
            }
        }
    }
    let separable = |form: &Expr| is_separable(premises, *form);
    if separable(&written) {
        return vec![written];
    }
    Some(linear())
        .filter(|forms| !forms.is_empty())
        .unwrap_or_else(|| vec![forms(premises, identity).into_iter().map(in_z).find(separable).unwrap_or(written)])
}

/// An identity with the states that the other equations give: `c = a*b` is linear where an output is b.
fn with_other_values(premises: &Premises<'_>, identity: Expr) -> Option<Expr> {
    let (arena, domain, hidden) = (premises.arena(), premises.domain, premises.plant.hidden());
    let others = domain.manifold.equations().iter().copied().filter(|other| *other != identity).collect();
    let mut values = domain.manifold.of(arena, &domain.facts, others).determined();
    values.retain(|symbol, value| hidden.contains(symbol) && !arena.depends_on(*value, &hidden));
    let form = arena.substitute(identity, &values);
    (form != identity && arena.depends_on(form, &hidden)).then_some(form)
}

/// An identity with distances by the angles that other equations give: `sqrt(p^2 + s^2)` is `p*cos(b) + s*sin(b)` where an
/// output is the bearing `b = atan2(s, p)`.
fn with_other_angles(premises: &Premises<'_>, identity: Expr) -> Option<Expr> {
    let (arena, everywhere) = (premises.arena(), premises.domain.without_equations());
    let roots: Vec<(Expr, Expr)> =
        arena.postorder(&[identity]).into_iter().filter_map(|part| root(arena, part)).collect();
    let by_angle = |other: &Expr| {
        let ([side, ahead], angle) = angle(arena, *other)?;
        let square = arena.add(arena.mul(side, side), arena.mul(ahead, ahead));
        let is_distance = |(_, of): &&(Expr, Expr)| is_zero(arena, arena.sub(*of, square), &everywhere);
        let (distance, _) = roots.iter().find(is_distance)?;
        let along = |function, side| arena.mul(arena.call(function, &[angle]), side);
        let projected = arena.add(along(Function::Cos, ahead), along(Function::Sin, side));
        Some(arena.replace(identity, &[(*distance, projected)].into_iter().collect()))
    };
    premises.domain.manifold.equations().iter().filter(|other| **other != identity).find_map(by_angle)
}

/// A square root, and that of which it is one.
fn root(arena: &Arena, part: Expr) -> Option<(Expr, Expr)> {
    let Node::Product(product) = arena.node(part) else { return None };
    match product.factors.as_slice() {
        [(base, exponent)] if product.coefficient.is_one() && *exponent == half() => Some((part, *base)),
        _ => None,
    }
}

/// The sides of the one angle in an equation that is a term of it, and the angle by the other terms.
fn angle(arena: &Arena, equation: Expr) -> Option<([Expr; 2], Expr)> {
    let Node::Sum(sum) = arena.node(equation) else { return None };
    let sides = |term: Expr| match arena.node(term) {
        Node::Call(Function::Atan2, arguments) => <[Expr; 2]>::try_from(arguments.to_vec()).ok(),
        _ => None,
    };
    let (term, slope, sides) = sum.terms.iter().find_map(|(term, slope)| Some((*term, slope, sides(*term)?)))?;
    let rest = arena.sub(equation, arena.scale(term, slope));
    Some((sides, arena.scale(rest, &-&slope.recip()?)))
}

/// The components of the transform that are functions of a state given by an identity, each less its value.
fn components(premises: &Premises<'_>, identity: Expr) -> Vec<Expr> {
    let (arena, plant, domain, hidden) = (premises.arena(), premises.plant, premises.domain, premises.plant.hidden());
    let states: Vec<Symbol> = arena.symbols_of(&[identity]).intersection(&hidden).copied().collect();
    let ([state], Some(value)) = (states.as_slice(), output_value(plant, identity)) else { return Vec::new() };
    let equation = solve::Equation { formula: identity, value: arena.zero() };
    let known = solve(arena, domain, &[equation], &[*state]).unwrap_or_default().remove(state).unwrap_or_default();
    let is_the_state = |known: &Expr| {
        let error = arena.sub(arena.substitute(*known, &value), arena.of_symbol(*state));
        !arena.depends_on(*known, &hidden) && is_zero(arena, error, &domain.without_equations())
    };
    let Some(known) = known.into_iter().find(is_the_state) else { return Vec::new() };
    let at = BTreeMap::from([(*state, known)]);
    let value = |phi: Expr| Some(arena.substitute(phi, &at)).filter(|value| !arena.depends_on(*value, &hidden));
    let of_state = |phi: &Expr| arena.depends_on(*phi, &hidden);
    plant.transform().into_iter().filter(of_state).filter_map(|phi| Some(arena.sub(phi, value(phi)?))).collect()
}

/// Other forms of an identity, each proved.
fn forms(premises: &Premises<'_>, identity: Expr) -> Vec<Expr> {
    let (arena, domain) = (premises.arena(), premises.domain);
    let value = output_value(premises.plant, identity);
    let mut forms = cleared(arena, domain, identity, &premises.plant.hidden());
    // A state may be a quotient of components of phi.
    let divisor = premises.at_left_inverse(identity).and_then(|in_z| implicit::factor(premises, in_z).ok()?);
    let of_z = divisor.filter(|divisor| arena.depends_on(*divisor, &premises.unknown()));
    forms.extend(of_z.map(|divisor| arena.mul(identity, premises.at_phi(divisor))));
    forms.retain(|form| match &value {
        Some(value) => is_zero(arena, arena.substitute(*form, value), &domain.without_equations()),
        None => premises.vanishes(*form),
    });
    forms
}

/// An output as a function given by an identity, where it is one term of the identity.
fn output_value(plant: &Plant, identity: Expr) -> Option<BTreeMap<Symbol, Expr>> {
    let arena = &plant.arena;
    let Node::Sum(sum) = arena.node(identity) else { return None };
    plant.y.iter().find_map(|output| {
        let (_, slope) = sum.terms.iter().find(|(term, _)| arena.as_symbol(*term) == Some(output.symbol))?;
        let value = arena.sub(arena.of_symbol(output.symbol), arena.scale(identity, &slope.recip()?));
        let alone = !arena.depends_on(value, &BTreeSet::from([output.symbol]));
        alone.then(|| BTreeMap::from([(output.symbol, value)]))
    })
}
