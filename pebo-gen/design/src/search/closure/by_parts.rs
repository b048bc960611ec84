//! Transforms of plants with unknown constants, by integration by parts.
//!
//! In: a plant some of whose states have the rate zero. Out: functions of x and y whose rates are affine in themselves.
//! Where a constant c multiplies the rate of w in another rate, c*w is taken into the component instead, as the
//! constant has no rate: `y'' = -a*y - b*y' + u` with unknown a and b, and y measured, has `z = y' + b*y` with
//! `z' = -a*y + u`. The rates then consist of the components, and of products of constants and known signals, which are
//! components too. A heading of which the rates of a position show sine and cosine has the bias of its gyroscope so.
//!
//! This is how an observable linear plant comes to its observer form, in which its unknown coefficients multiply
//! measured signals alone (Marino and Tomei 1992).

use std::collections::BTreeSet;

use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Node, Rational, Symbol};

use super::MOST;
use super::products::{Term, apart, terms};
use crate::search::integral::antiderivative;
use crate::search::problem::Problem;

/// Steps by parts, and rounds over all rates, after which they are assumed endless.
const MOST_STEPS: usize = 500;
const MOST_ROUNDS: usize = 12;

/// A function of x in a rate, and the component that begins with it.
struct Component {
    lead: Expr,
    function: Expr,
}

/// The functions; none where it does not end.
pub(in crate::search) fn by_parts(
    problem: &Problem<'_>,
    constants: &BTreeSet<Symbol>,
) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let mut search = ByParts { problem, constants, components: Vec::new(), steps: 0 };
    for _ in 0..MOST_ROUNDS {
        let before: Vec<Expr> = search.functions();
        for rate in problem.output_rates() {
            if search.reduced(rate, None)?.is_none() {
                return Ok(None);
            }
        }
        let mut index = 0;
        while index < search.components.len() {
            let rate = problem.rate(search.components[index].function);
            if search.reduced(rate, Some(index))?.is_none() {
                return Ok(None);
            }
            index += 1;
        }
        if search.functions() == before {
            let rates: Vec<Expr> = before.iter().map(|function| problem.rate(*function)).collect();
            let mut found = before;
            for rate in problem.output_rates().into_iter().chain(rates) {
                let Some(rest) = search.reduced(rate, None)? else { return Ok(None) };
                for of_constants in search.of_constants(rest)? {
                    let is_new = |other: &Expr| arena.as_number(arena.div(of_constants, *other)).is_none();
                    if found.iter().all(is_new) {
                        found.push(of_constants);
                    }
                }
            }
            return Ok((found.len() <= MOST).then_some(found));
        }
    }
    Ok(None)
}

struct ByParts<'a, 'b> {
    problem: &'a Problem<'b>,
    constants: &'a BTreeSet<Symbol>,
    components: Vec<Component>,
    steps: usize,
}

impl ByParts<'_, '_> {
    fn functions(&self) -> Vec<Expr> {
        self.components.iter().map(|component| component.function).collect()
    }

    /// The rate without its components; constants alone are left. A component with this rate absorbs the terms
    /// integrated by parts. None where it does not end.
    fn reduced(&mut self, rate: Expr, owner: Option<usize>) -> Result<Option<Expr>, Obstacle> {
        let arena = self.problem.arena;
        let mut rest = rate;
        loop {
            let Some(terms) = self.terms(rest)? else { return Ok(None) };
            let open: Vec<Term> = terms.into_iter().filter(|term| !self.is_constant(term.product)).collect();
            if open.is_empty() {
                return Ok(Some(rest));
            }
            self.steps += 1;
            if self.steps > MOST_STEPS {
                return Ok(None);
            }
            // Components first: the rest may cancel terms that would be integrated by parts.
            let component = |term: &Term| self.components.iter().find(|component| component.lead == term.product);
            if let Some((term, component)) = open.iter().find_map(|term| Some((term, component(term)?))) {
                rest = arena.sub(rest, arena.mul(term.coefficient, component.function));
                continue;
            }
            let term = &open[0];
            if let Some(index) = owner
                && let Some(part) = self.part(term)?
            {
                let moved = arena.sub(self.components[index].function, part);
                self.components[index].function = moved;
                rest = arena.sub(rest, self.problem.rate(part));
                continue;
            }
            if self.components.len() == MOST {
                return Ok(None);
            }
            self.components.push(Component { lead: term.product, function: term.product });
        }
    }

    /// The function with the term in its rate: a constant times a function whose rate holds the rest of the product.
    fn part(&self, term: &Term) -> Result<Option<Expr>, Obstacle> {
        let (arena, problem) = (self.problem.arena, self.problem);
        let held = arena.symbols_of(&[term.product]);
        let outputs = problem.y.iter().map(|symbol| (arena.of_symbol(*symbol), Some(*symbol)));
        let functions = self.components.iter().map(|component| (component.function, None));
        let candidates: Vec<(Expr, Option<Symbol>)> = outputs.chain(functions).collect();
        // A constant, or all that is constant: `1/(1 + c)` is a factor as a whole.
        let single = self.constants.iter().filter(|constant| held.contains(constant)).map(|c| arena.of_symbol(*c));
        for factor in single.chain(self.constant_part(term.product)) {
            let remaining = arena.div(term.product, factor);
            if arena.symbols_of(&[remaining]).is_subset(self.constants) {
                continue;
            }
            for (function, output) in &candidates {
                let Some(terms) = self.terms(problem.rate(*function))? else { continue };
                let Some(own) = terms.iter().find(|own| own.product == remaining) else { continue };
                let ratio = arena.div(term.coefficient, own.coefficient);
                let signals: BTreeSet<Symbol> =
                    arena.symbols_of(&[ratio]).into_iter().filter(|s| problem.signals.contains(s)).collect();
                let whole = match output {
                    _ if signals.is_empty() => Some(arena.mul(ratio, *function)),
                    Some(output) if signals.iter().eq([output]) => {
                        antiderivative(arena, &problem.domain, ratio, *output)
                    }
                    _ => None,
                };
                if let Some(whole) = whole {
                    return Ok(Some(arena.mul(factor, whole)));
                }
            }
        }
        Ok(None)
    }

    /// The factors that are constant, where there are any.
    fn constant_part(&self, product: Expr) -> Option<Expr> {
        let arena = self.problem.arena;
        let Node::Product(product) = arena.node(product) else { return None };
        let is_constant = |factor: &&(Expr, Rational)| arena.symbols_of(&[factor.0]).is_subset(self.constants);
        let part: Vec<(Expr, Rational)> = product.factors.iter().filter(is_constant).cloned().collect();
        (!part.is_empty()).then(|| arena.multiply(&Rational::ONE, part))
    }

    fn is_constant(&self, product: Expr) -> bool {
        self.problem.arena.symbols_of(&[product]).is_subset(self.constants)
    }

    /// The terms of a formula; functions of hidden symbols are symbols themselves, where they do not cancel.
    fn terms(&self, formula: Expr) -> Result<Option<Vec<Term>>, Obstacle> {
        let (arena, hidden) = (self.problem.arena, &self.problem.hidden);
        let plain = terms(self.problem, formula, hidden)?;
        if plain.is_some() {
            return Ok(plain);
        }
        let is_call = |part: &Expr| matches!(arena.node(*part), Node::Call(..)) && arena.depends_on(*part, hidden);
        let calls = arena.postorder(&[formula]).into_iter().filter(is_call);
        let named: Vec<(Expr, Symbol)> = calls.map(|call| (call, arena.generated(&arena.print(call)))).collect();
        let opaque =
            arena.replace(formula, &named.iter().map(|(call, name)| (*call, arena.of_symbol(*name))).collect());
        let hidden = hidden.iter().copied().chain(named.iter().map(|(_, name)| *name)).collect();
        let calls = named.iter().map(|(call, name)| (*name, *call)).collect();
        let restored = |term: Term| Term { product: arena.substitute(term.product, &calls), ..term };
        Ok(terms(self.problem, opaque, &hidden)?.map(|terms| terms.into_iter().map(restored).collect()))
    }

    /// The polynomials in the constants that multiply known signals which are independent of each other.
    fn of_constants(&self, formula: Expr) -> Result<Vec<Expr>, Obstacle> {
        let (arena, problem) = (self.problem.arena, self.problem);
        let field = Field::over(arena, &problem.domain.facts, &[formula])?;
        let fraction = field.fraction(formula)?;
        let others: BTreeSet<Symbol> =
            problem.signals.iter().copied().filter(|signal| !problem.hidden.contains(signal)).collect();
        let (known, constants) = (field.kernels_of(&others), field.kernels_of(self.constants));
        let Some([divisor, _]) = apart(&field, fraction.denominator(), [&constants, &known])? else {
            return Ok(Vec::new());
        };
        let divisor = field.show_factored(&field.quotient(&Poly::one(), &divisor)?);
        let known: Vec<u32> = known.into_iter().collect();
        let mut found = Vec::new();
        for (_, polynomial) in fraction.numerator().collect(&known) {
            let formula = arena.mul(field.show(&field.of_polynomial(&polynomial)?), divisor);
            if arena.depends_on(formula, self.constants) {
                found.push(self.without_numbers(formula)?);
            }
        }
        Ok(found)
    }

    /// The formula without its factor of parameters, and with a first term that is not subtracted.
    fn without_numbers(&self, formula: Expr) -> Result<Expr, Obstacle> {
        let (arena, problem) = (self.problem.arena, self.problem);
        let field = Field::over(arena, &problem.domain.facts, &[formula])?;
        let fraction = field.fraction(formula)?;
        let kernels: Vec<u32> = field.kernels_of(self.constants).into_iter().collect();
        let parts = fraction.numerator().collect(&kernels);
        let Some((first, rest)) = parts.split_first() else { return Ok(formula) };
        let mut common = first.1.clone();
        for (_, coefficient) in rest {
            common = common.gcd(coefficient, field.limit())?;
        }
        let bare = arena.div(formula, field.show(&field.of_polynomial(&common)?));
        let is_subtracted = field.fraction(bare)?.numerator().leading_coefficient().is_negative();
        Ok(if is_subtracted { arena.neg(bare) } else { bare })
    }
}
