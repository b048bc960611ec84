//! Claim 1, the cascade: the transform moves by known signals.
//!
//! In: the plant. Out: h(y, u) with `d(phi)/dx f_x + d(phi)/dy f_y = h`, or, where that fails, Lambda(y, u) and h(y, u)
//! with `Lambda phi + h` on the right ([`gpebo`]), or the terms of the derivative that depend on x, a point that shows
//! it, and a repaired transform if multiples of the outputs give one (Ortega et al. 2015, eq. 3).

mod bounded;
mod gpebo;
mod killing;
mod momentum;

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::class::Mechanical;
use crate::plant::{self, Formula, Plant, TransformOrigin};
use crate::source::{Code, Diagnostic, listed};
use pebo_cas::domain::zero::{Answer, decide, is_zero, point_of};
use pebo_cas::forms::opaque::as_written;
use pebo_cas::linear::comparison::combine;
use pebo_cas::linear::contrast::contrast;
use pebo_cas::number::interval::Precision;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Symbol};

use super::design::{Cascade, Claim, Class, Comparison, Verdict, Witness};
use super::{affine, blame, pencil};
use pebo_cas::forms::tidy::{authors_form, proved_shortest, shortest, with_fewer_conditions};

/// One component of the derivative of the transform.
enum Component {
    /// Free of x.
    Free(Expr),
    /// Dependent on x by its form, with the obstacle where no points show it; these are looked for where it is refused.
    Dependent(RateForm, Obstacle),
    /// It could not be decided.
    Open(Obstacle),
}

/// The dependence of a rate on x, as two points show it.
struct Dependence {
    /// The term that varies with x.
    residual: Expr,
    witness: Witness,
    through: Vec<Symbol>,
}

/// Proves or refutes the cascade: the plain one, else, unless only that is wanted, the generalised one. A generalised one
/// that samples of values do not drive is preferred to a plain one that they do: there their noise adds up.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> (Class, Claim<Cascade>) {
    let lie = plant.derivative_of_transform();
    let components: Vec<Component> =
        lie.iter().enumerate().map(|(index, rate)| component_of(plant, domain, index, *rate)).collect();
    if plant.cascade_class != Some(Class::Gpebo) && components.iter().all(|c| matches!(c, Component::Free(_))) {
        let h: Vec<Expr> = components.iter().filter_map(Component::free).collect();
        if let Some(rows) = with_fewer_values(plant, domain, &lie, &h).filter(|_| plant.cascade_class.is_none()) {
            let result = Cascade { plain: Some(h), ..gpebo::cascade(plant, domain, rows) };
            return (Class::Gpebo, Claim { verdict: Verdict::Proved, result: Some(result) });
        }
        return (Class::Pebo, Claim { verdict: Verdict::Proved, result: Some(Cascade { h, ..Cascade::default() }) });
    }
    let row = |(rate, component): (&Expr, &Component)| match component {
        Component::Free(h) => Ok(Some(gpebo::known(plant, *h))),
        Component::Open(Obstacle::NoPoint) => Err(Obstacle::NoPoint),
        // Quadratic in momenta: not affine, by points.
        Component::Dependent(..) if is_implicit(plant) => {
            affine::refuted(plant, domain, *rate).map_or(Err(Obstacle::NoWitness), |_| Ok(None))
        }
        _ => gpebo::row(plant, domain, *rate),
    };
    let rows: Vec<Result<Option<affine::Row>, Obstacle>> = lie.iter().zip(&components).map(row).collect();
    let generalised = rows.iter().all(|row| matches!(row, Ok(Some(_))));
    let mends = mends(plant, domain, &lie, &components);
    if generalised && plant.cascade_class != Some(Class::Pebo) {
        let rows: Vec<affine::Row> = rows.into_iter().filter_map(|row| row.ok()?).collect();
        let rows = with_fewer_values(plant, domain, &lie, &rows.concat()).unwrap_or(rows);
        let result = gpebo::cascade(plant, domain, rows);
        let plain = components.iter().any(|c| c.free().is_none()).then(|| mends.into_iter().collect()).flatten();
        let result = Cascade { mend: plain, ..result };
        return (Class::Gpebo, Claim { verdict: Verdict::Proved, result: Some(result) });
    }
    if plant.cascade_class == Some(Class::Pebo) {
        let mut refusals = Vec::new();
        let claim = pencil::refuse(plant, domain, &mut refusals);
        let claim = claim.unwrap_or_else(|| refuse(plant, domain, (&components, &mends), |_| Ok(None), &mut refusals));
        let note =
            "d(phi)/dt is Lambda(y, u) phi + h(y, u): without `class: pebo` this phi gives a generalised observer";
        found.extend(refusals.into_iter().map(|refusal| if generalised { refusal.note(note) } else { refusal }));
        return (Class::Pebo, claim);
    }
    let mut refusals = Vec::new();
    let claim = refuse(plant, domain, (&components, &mends), |index| rows[index].clone(), &mut refusals);
    let note = "d(phi)/dt is not of the form Lambda(y, u) phi + h(y, u) either, which a generalised observer needs";
    let noted = |refusal: Diagnostic| if refusal.code == Code::CascadeRefuted { refusal.note(note) } else { refusal };
    found.extend(refusals.into_iter().map(noted));
    (Class::Pebo, claim)
}

/// The rates as affine functions of the transform, where these hold fewer outputs that are given by value than the formulas
/// of a cascade do.
fn with_fewer_values(plant: &Plant, domain: &Domain, rates: &[Expr], cascade: &[Expr]) -> Option<Vec<affine::Row>> {
    let arena = &plant.arena;
    let held = |formulas: &[Expr]| {
        let symbols = arena.symbols_of(formulas);
        plant.y.iter().filter(|output| output.value.is_some() && symbols.contains(&output.symbol)).count()
    };
    if held(cascade) == 0 {
        return None;
    }
    let everywhere = domain.without_equations();
    let rows: Option<Vec<affine::Row>> =
        rates.iter().map(|rate| affine::of(plant, &everywhere, *rate).ok().flatten()).collect();
    rows.filter(|rows| held(&rows.concat()) < held(cascade))
}

/// The obstacles to the cascade, component by component; components that `row` makes affine in the transform are
/// obstacles to a plain one alone.
fn refuse(
    plant: &Plant,
    domain: &Domain,
    (components, mends): (&[Component], &[Option<Expr>]),
    row: impl Fn(usize) -> Result<Option<affine::Row>, Obstacle>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Cascade> {
    let mut residuals = vec![plant.arena.zero(); components.len()];
    let mut first = None;
    for (index, component) in components.iter().enumerate() {
        match (component, row(index)) {
            (Component::Free(_), _) | (_, Ok(Some(_))) => {}
            (Component::Open(obstacle), _) => found.push(undecided(plant, index, obstacle)),
            (Component::Dependent(rate, otherwise), row) => match (dependence(plant, domain, rate), row) {
                (None, _) => found.push(undecided(plant, index, otherwise)),
                (Some(_), Err(obstacle)) => found.push(undecided(plant, index, &obstacle)),
                (Some(shown), _) => {
                    let refusal = refuted(plant, index, &shown, mends[index]);
                    let refusal = blame::cascade(plant, domain, index, refusal);
                    found.push(structure(plant, domain, index, refusal));
                    residuals[index] = shown.residual;
                    first.get_or_insert(shown.witness);
                }
            },
        }
    }
    match first {
        Some(_) => {
            let result = Cascade { residual: residuals, witness: first, ..Cascade::default() };
            Claim { verdict: Verdict::Refuted, result: Some(result) }
        }
        None => Claim { verdict: Verdict::Undecided, result: None },
    }
}

impl Component {
    fn free(&self) -> Option<Expr> {
        match self {
            Self::Free(rate) => Some(*rate),
            _ => None,
        }
    }
}

/// One component, by the knowledge of the class where there is any.
fn component_of(plant: &Plant, domain: &Domain, index: usize, rate: Expr) -> Component {
    let Some(plant::Class::Mechanical(mechanical)) = &plant.class else { return component(plant, domain, rate) };
    if plant.origin == TransformOrigin::Found {
        return component_found(plant, domain, mechanical, (plant.phi[index].expr, rate));
    }
    match killing::is_killing(&plant.arena, domain, mechanical, &mechanical.frame.column(index)) {
        Ok(true) => Component::Free(momentum::rate(plant, domain, mechanical, index)),
        Ok(false) => match &mechanical.in_velocities {
            // The rate has no normal form; points prove that it varies.
            Some(printed) => {
                let varying = killing::quadratic(&plant.arena, mechanical, index, &printed.velocities);
                let rate =
                    RateForm { rate, printed: plant.arena.add(mechanical.h[index], varying), varying: Some(varying) };
                Component::Dependent(rate, Obstacle::NoWitness)
            }
            None => component(plant, domain, rate),
        },
        Err(obstacle) => Component::Open(obstacle),
    }
}

/// A component that was searched for, and its rate: the class knows of its own T alone, not of this one. The rate of
/// momenta along a Killing field is the rate at zero velocity.
fn component_found(
    plant: &Plant,
    domain: &Domain,
    mechanical: &Mechanical,
    (momentum, rate): (Expr, Expr),
) -> Component {
    let (arena, hidden) = (&plant.arena, plant.hidden());
    let rest: BTreeMap<Symbol, Expr> = plant.x.iter().map(|state| (state.symbol, arena.zero())).collect();
    let field: Vec<Expr> = plant.x.iter().map(|state| arena.derivative(momentum, state.symbol)).collect();
    let is_linear = !field.iter().any(|entry| arena.depends_on(*entry, &hidden))
        && is_zero(arena, arena.substitute(momentum, &rest), domain);
    if is_linear && killing::is_killing(arena, domain, mechanical, &field) == Ok(true) {
        return Component::Free(proved_shortest(arena, domain, arena.substitute(rate, &rest)));
    }
    component(plant, domain, rate)
}

fn component(plant: &Plant, domain: &Domain, rate: Expr) -> Component {
    let arena = &plant.arena;
    let hidden = plant.hidden();
    if !arena.depends_on(rate, &hidden) {
        return match point_of(arena, rate, domain) {
            Some(_) => Component::Free(proved_shortest(arena, domain, rate)),
            None => Component::Open(Obstacle::NoPoint),
        };
    }
    let tidy = |field: Result<Field<'_>, Obstacle>| {
        let field = field?;
        let fraction = field.fraction(rate)?;
        Ok(field.show(&fraction))
    };
    let everywhere = tidy(Field::over(arena, &domain.facts, &[rate]));
    let tidied = match everywhere {
        // On the manifold the rate may be free of x.
        Ok(tidied) if !domain.manifold.is_empty() && arena.depends_on(tidied, &hidden) => {
            tidy(Field::on(arena, domain, &[rate])).or(Ok(tidied))
        }
        other => other,
    };
    let tidied = match tidied {
        Ok(tidied) => tidied,
        // An expression without a normal form may still differ at points.
        Err(obstacle) => {
            let rate = RateForm { rate, printed: rate, varying: None };
            return free_on_cells(plant, domain, rate.rate).unwrap_or(Component::Dependent(rate, obstacle));
        }
    };
    // A number has no other form.
    if arena.as_number(tidied).is_some() {
        return match point_of(arena, rate, domain) {
            Some(_) => Component::Free(tidied),
            None => Component::Open(Obstacle::NoPoint),
        };
    }
    if !arena.depends_on(tidied, &hidden) {
        // The normal form is free of x; the zero test confirms that it equals the rate.
        return match decide(arena, arena.sub(rate, tidied), domain) {
            // It does not depend on x, so its value at any x will do: there the author's own form may have more values.
            Answer::Zero => {
                let origin = hidden.iter().map(|symbol| (*symbol, arena.zero())).collect();
                let plain = proved_shortest(arena, domain, arena.substitute(rate, &origin));
                // Terms free of x as they are written, then terms that cancel, then the normal form.
                let forms = as_written(arena, domain, rate, &hidden);
                let forms = forms.into_iter().chain([shortest(arena, domain, rate), plain]);
                let equal =
                    |form: &Expr| !arena.depends_on(*form, &hidden) && is_zero(arena, arena.sub(*form, tidied), domain);
                let forms: Vec<Expr> = forms.filter(equal).chain([tidied]).collect();
                let own = authors_form(arena, rate, &forms).unwrap_or(tidied);
                Component::Free(with_fewer_conditions(arena, domain, own, &forms))
            }
            Answer::Open(obstacle) => Component::Open(obstacle),
            Answer::NonZero(_) => Component::Open(Obstacle::NoWitness),
        };
    }
    let dependent = RateForm { rate, printed: tidied, varying: None };
    free_on_cells(plant, domain, rate).unwrap_or(Component::Dependent(dependent, Obstacle::NoWitness))
}

/// A rate that is the same function of y and u on all cells that states distinguish, as the rate of `a + sat(a)` may be.
fn free_on_cells(plant: &Plant, domain: &Domain, rate: Expr) -> Option<Component> {
    let arena = &plant.arena;
    let hidden = plant.hidden();
    let cells = domain.cells(arena, &[rate], |divider| arena.depends_on(divider, &hidden)).ok()?;
    let cell = &cells.first()?.domain;
    let branch = cell.analytic(arena, &[rate])[0];
    if branch == rate {
        return None;
    }
    let field = Field::on(arena, cell, &[branch]).ok()?;
    let common = field.show(&field.fraction(branch).ok()?);
    let is_free = !arena.depends_on(common, &hidden) && is_zero(arena, arena.sub(rate, common), domain);
    is_free.then(|| Component::Free(proved_shortest(arena, domain, common)))
}

/// A rate and its printed form.
struct RateForm {
    rate: Expr,
    printed: Expr,
    /// The term of the printed form that varies with x, if known.
    varying: Option<Expr>,
}

/// The dependence on x, with two points of the domain that show it: the same y, u and parameters, another value.
///
/// If the varying term of the printed form is unknown, it is the difference to its value at the second point.
fn dependence(plant: &Plant, domain: &Domain, form: &RateForm) -> Option<Dependence> {
    let arena = &plant.arena;
    let RateForm { rate, printed, varying } = *form;
    let hidden = plant.hidden();
    let points = contrast(arena, rate, &[arena.one()], &hidden, domain)?;
    let ([_, reference], [here, there]) = (points.points.as_slice(), points.values.as_slice()) else { return None };
    let read = if varying.is_some() { rate } else { printed };
    let through: Vec<Symbol> = arena.symbols_of(&[read]).intersection(&hidden).copied().collect();
    let fixed: BTreeMap<Symbol, Expr> = through.iter().filter_map(|s| Some((*s, *reference.get(s)?))).collect();
    let residual =
        varying.unwrap_or_else(|| shortest(arena, domain, arena.sub(printed, arena.substitute(printed, &fixed))));
    let difference = here.sub(there, Precision::new(256))?;
    let compared = Comparison::of([printed, read], &points, &hidden);
    let witness = Witness {
        expr: residual,
        point: points.points[0].iter().map(|(symbol, value)| (*symbol, *value)).collect(),
        bounds: (difference.lo(), difference.hi()),
        compared: Some(compared),
    };
    Some(Dependence { residual, witness, through })
}

/// The components that are free of x, and the others mended, where that can be.
fn mends(plant: &Plant, domain: &Domain, lie: &[Expr], components: &[Component]) -> Vec<Option<Expr>> {
    let component = |((rate, component), phi): ((&Expr, &Component), &Formula)| match component {
        Component::Free(_) => Some(phi.expr),
        Component::Dependent(..) => mend(plant, domain, *rate, phi.expr),
        Component::Open(_) => None,
    };
    lie.iter().zip(components).zip(&plant.phi).map(component).collect()
}

/// The component with constant multiples of outputs added so that its derivative is free of x.
fn mend(plant: &Plant, domain: &Domain, rate: Expr, phi: Expr) -> Option<Expr> {
    let arena = &plant.arena;
    let measured: Vec<(Symbol, Expr)> = plant.y.iter().filter_map(|o| o.rate.map(|r| (o.symbol, r.expr))).collect();
    if is_implicit(plant) {
        // Quadratic in momenta that no multiple of a velocity cancels.
        return None;
    }
    let mut roots = vec![rate];
    roots.extend(measured.iter().map(|m| m.1));
    let field = Field::over(arena, &domain.facts, &roots).ok()?;
    let mut basis = vec![arena.one()];
    basis.extend(measured.iter().map(|m| m.1));
    let coefficients = combine(&field, rate, &basis, &plant.hidden()).ok()??;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let mut mended = phi;
    for ((output, _), coefficient) in measured.iter().zip(&coefficients[1..]) {
        let coefficient = field.show(coefficient);
        if !arena.symbols_of(&[coefficient]).is_subset(&constants) {
            return None;
        }
        mended = arena.sub(mended, arena.mul(coefficient, arena.of_symbol(*output)));
    }
    // A component that no longer holds a state, or is zero by an output's value, would be of no use.
    let useful = mended != phi && arena.depends_on(mended, &plant.hidden()) && !is_zero(arena, mended, domain);
    let proved = || matches!(component(plant, domain, arena.directional(mended, &plant.rates())), Component::Free(_));
    (useful && proved()).then_some(mended)
}

/// Characters of a formula that a reader takes in at a glance.
const LONGEST: usize = 60;

fn refuted(
    plant: &Plant,
    index: usize,
    Dependence { residual, witness, through }: &Dependence,
    mend: Option<Expr>,
) -> Diagnostic {
    let arena = &plant.arena;
    let names: Vec<String> = through.iter().map(|s| arena.name(*s)).collect();
    let printed = arena.print(*residual);
    // A long label is not repeated.
    let term = if printed.len() <= LONGEST { format!("`{printed}`") } else { "this term".to_owned() };
    let component = index + 1;
    let diagnostic = Diagnostic::error(
        Code::CascadeRefuted,
        plant.phi[index].span,
        format!(
            "the derivative of phi component {component} is not free of {}",
            listed(names.iter().map(String::as_str))
        ),
    )
    .label(format!("its derivative keeps the term `{printed}`"))
    .note(format!("d(phi)/dt must be a function of y and u alone, but {term} remains in z{component}'"))
    .note(
        witness
            .compared
            .as_ref()
            .map_or_else(|| witness.sentence(arena), |compared| compared.sentence(arena, &format!("z{component}'"))),
    );
    match mend {
        Some(mend) => diagnostic.help(format!("use `{}` for this component", arena.print(mend))),
        None => diagnostic.help("choose a phi whose derivative along the plant is free of the unmeasured states"),
    }
}

/// Tests whether the plant is a mechanical one whose inverse of M is not written out.
fn is_implicit(plant: &Plant) -> bool {
    matches!(&plant.class, Some(plant::Class::Mechanical(mechanical)) if mechanical.in_velocities.is_some())
}

/// For a mechanical plant, the entries of Assumption 3 that do not vanish.
fn structure(plant: &Plant, domain: &Domain, index: usize, refusal: Diagnostic) -> Diagnostic {
    let Some(plant::Class::Mechanical(mechanical)) = &plant.class else { return refusal };
    if plant.origin == TransformOrigin::Found {
        return refusal;
    }
    let arena = &plant.arena;
    let name = index + 1;
    if mechanical.in_velocities.is_some() {
        return refusal.help(killing_help(name));
    }
    let Ok(entries) = killing::offending(arena, domain, mechanical, index) else { return refusal };
    let noted = entries.into_iter().fold(refusal, |refusal, (row, column, entry)| {
        let entry = arena.print(shortest(arena, domain, entry));
        refusal.note(format!(
            "in Assumption 3, B_({name}) + B_({name})' has the nonzero entry ({}, {}) = {entry}",
            row + 1,
            column + 1
        ))
    });
    noted.help(killing_help(name))
}

fn killing_help(name: usize) -> String {
    format!("choose for column {name} of T a Killing field of M: one along which M does not change")
}

fn undecided(plant: &Plant, index: usize, obstacle: &Obstacle) -> Diagnostic {
    Diagnostic::error(
        Code::CascadeUndecided,
        plant.phi[index].span,
        format!("it could not be decided whether the derivative of phi component {} is free of x", index + 1),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("write the formulas with fewer functions, or state signs under `assume`")
}
