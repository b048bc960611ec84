//! Diagnostics on what the pool of equations lacks for a regression.

use super::pool::Rate;
use crate::plant::{Formula, Plant, RelationForm};
use crate::source::{Code, Diagnostic, Span, listed};
use pebo_cas::Expr;
use pebo_cas::tower::Obstacle;

const NOT_AFFINE: &str = "not an affine function of phi with coefficients in y and u";
const NOT_SEARCHED: &str =
    "for a generalised cascade, z = xi + Psi theta, other functions of phi than products are not searched for";

fn open(span: Span, message: impl Into<Box<str>>) -> Diagnostic {
    Diagnostic::error(Code::RegressionUndecided, span, message)
}

/// An identity without functions of theta, or without those that are affine under a generalised cascade.
pub(super) fn not_in_identity(span: Span, is_generalised: bool) -> Diagnostic {
    if is_generalised {
        open(span, "for a generalised cascade, no regression was found in this identity")
            .label(NOT_AFFINE)
            .note(NOT_SEARCHED)
            .help("choose a phi in which it is affine, or one whose derivative is free of x")
    } else {
        open(span, "no regression that is linear in functions of theta was found in this identity")
            .help("write it as a polynomial in the components of phi, or give `f_y` for an output")
    }
}

/// No output has a rate, and there are no identities.
pub(super) fn without_equations(plant: &Plant) -> Diagnostic {
    let span = plant.y.first().map_or(Span::point(0), |output| output.span);
    let message = "the model gives no equation from which the unknowns could be estimated";
    Diagnostic::error(Code::RegressionNonlinear, span, message)
        .label("no output has a rate under `f_y`, and there are no `identities`")
        .help("give `f_y` for an output, or an expression in x and y that is zero under `identities`")
}

/// Outputs that unmeasured signals move, perhaps not in all combinations.
pub(super) fn maybe_hidden(plant: &Plant, outputs: &[usize], span: Span) -> Diagnostic {
    let names: Vec<String> = outputs.iter().map(|index| plant.arena.name(plant.y[*index].symbol)).collect();
    let message =
        "it could not be decided whether the outputs determine the unknowns while unmeasured signals act on them";
    open(span, message)
        .note(format!(
            "no regression was found among the combinations of {} with constant coefficients that are free of these \
             signals",
            listed(names.iter().map(String::as_str))
        ))
        .help(
            "give `f_y` for an output whose rate is free of the unmeasured signals, or an identity under `identities`",
        )
}

/// A rate that is linear in functions of theta: from these it was not recovered, or they are of no use under a
/// generalised cascade.
pub(super) fn in_functions(plant: &Plant, rate: &Rate, functions: Option<&Vec<Expr>>) -> Diagnostic {
    let output = plant.arena.name(plant.y[rate.output].symbol);
    let Some(functions) = functions else {
        let message = format!("it could not be decided whether the rate of {output} is linear in functions of theta");
        return open(rate.formula.span, message)
            .label(NOT_AFFINE)
            .note(format!("obstacle: {NOT_SEARCHED}"))
            .help("choose a phi whose derivative is free of x, or one in which this rate is affine");
    };
    let functions: Vec<String> = functions.iter().map(|function| plant.arena.print(*function)).collect();
    let message =
        format!("the rate of {output} is linear in functions of theta, but theta was not recovered from them");
    open(rate.formula.span, message)
        .label(NOT_AFFINE)
        .note(format!("the functions of theta: {}", functions.join(", ")))
        .help("choose a phi in which this rate is affine, or give an identity under `identities`")
}

/// A rate that is not affine in phi, by these of its summands.
pub(super) fn refuted(plant: &Plant, index: usize, summands: &[Formula], point: &str) -> Diagnostic {
    let output = plant.arena.name(plant.y[index].symbol);
    let (first, others) = summands.split_first().map_or((plant.y[index].span, &[][..]), |(f, rest)| (f.span, rest));
    let message = format!("the rate of {output} is not linear in the unknowns");
    let diagnostic = Diagnostic::error(Code::RegressionNonlinear, first, message);
    let also =
        |diagnostic: Diagnostic, other: &Formula| diagnostic.also(other.span, "this term is not affine in phi either");
    others
        .iter()
        .fold(diagnostic, also)
        .label(NOT_AFFINE)
        .note(point)
        .note(
            "the rate is not a sum of known signals times functions of theta either: polynomials, exponentials, sines \
             and cosines of z were tried",
        )
        .help(
            "choose a phi in which this rate is affine, leave the output's rate out of `f_y` if others suffice, or give \
             an identity under `identities`",
        )
}

/// A form of a regression that is not affine in z.
#[derive(Clone, Copy)]
pub(super) enum OtherForm {
    /// The rate times an unknown that it is divided by.
    Multiplied,
    /// In a function of this component, which is constant.
    Function(usize),
    /// As a function of z, which is not known without a left inverse.
    Unknown,
}

/// A rate that is not affine in z, but may be linear in the unknowns in another form.
pub(super) fn not_in_other_forms(plant: &Plant, rate: &Rate, point: &str, form: OtherForm) -> Diagnostic {
    let arena = &plant.arena;
    let output = arena.name(plant.y[rate.output].symbol);
    let message =
        format!("it could not be decided whether a regression for the rate of {output} is linear in the unknowns");
    let diagnostic = open(rate.formula.span, message).label(NOT_AFFINE).note(point);
    match form {
        OtherForm::Multiplied => diagnostic
            .note(
                "an unknown divides this rate, and the rate times it is no derivative of what is affine in phi with \
                 polynomials of the outputs for coefficients; other factors were not tried",
            )
            .help("choose a phi in which this rate is affine, or measure another output"),
        OtherForm::Unknown => diagnostic
            .note("without a left inverse this rate is not known as a function of z, which may be linear in functions of theta")
            .help("give the left inverse under `phi_left`, or choose a phi in which this rate is affine"),
        OtherForm::Function(component) => {
            let phi = arena.print(plant.phi[component].expr);
            diagnostic
                .note(format!("`{phi}` is constant, and so is each of its functions"))
                .help(format!("take the functions of `{phi}` that this rate holds as components of phi"))
        }
    }
}

/// A rate, or an identity, of which nothing is proved.
pub(super) fn undecided(plant: &Plant, index: usize, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let output = plant.y.get(index).map_or_else(String::new, |o| format!(" of {}", plant.arena.name(o.symbol)));
    open(span, format!("it could not be decided whether the rate{output} is linear in the unknowns"))
        .note(format!("obstacle: {obstacle}"))
        .help("simplify the formula, or state signs under `assume`")
}

/// Reports that there is no regression to first order either.
pub(super) fn no_local_one(span: Span) -> Diagnostic {
    open(span, "no identifiable regression was found to first order at the estimate".to_owned())
        .label("`regression: local` admits one")
        .note("it needs a left inverse, and equations whose slopes by z identify all of its components over time")
        .help("measure another signal")
}

/// Reports that no regression was found to be monotone.
pub(super) fn no_monotone_one(plant: &Plant) -> Diagnostic {
    let span = plant.phi.first().map_or(Span::NOWHERE, |phi| phi.span);
    open(span, "no regression was found that is monotone in the unknowns".to_owned())
        .note("it needs a plain cascade, and equations of one component of phi each, whose slopes by it have one sign")
        .help("bound the states under `assume` to where the slopes have one sign, or write `regression: local`")
}

/// Reports that no regression has the chosen form.
pub(super) fn no_such_form(plant: &Plant, (form, span): (RelationForm, Span)) -> Diagnostic {
    let (how, needs, other) = match form {
        RelationForm::Static => (
            "from a relation among the components of phi as it holds at every instant",
            "it needs an output that is given by its value (`g_y`), an identity, or components of phi that outputs and \
             parameters relate",
            "differentiated",
        ),
        RelationForm::Differentiated => (
            "by differentiating a relation among the components of phi",
            "it needs a relation of degree two in the components of phi, with constant coefficients at their products, \
             whose derivative is affine in them",
            "static",
        ),
    };
    let message = format!("no identifiable regression was found {how}");
    let diagnostic = Diagnostic::error(Code::RegressionUndecided, span, message)
        .label(format!("`regression: {}` asks for one", form.name()))
        .note(needs);
    let about = plant.identities.first().map(|identity| (identity.span, "the identity"));
    let about = about.or_else(|| Some((plant.phi.first()?.span, "phi")));
    let diagnostic = about.into_iter().fold(diagnostic, |diagnostic, (span, what)| diagnostic.also(span, what));
    diagnostic.help(format!("leave out `regression`, or write `regression: {other}`"))
}
