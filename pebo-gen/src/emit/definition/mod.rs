//! The functions of the runtime's `Model` as the derivation defines them.
//!
//! In: an accepted derivation. Out: for each function its arguments and its entries.

pub(crate) mod choice;
mod fundamental;
pub(crate) mod tasks;

use Argument::{Eta, Extension, Theta, U, X, Y, Z};

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::error::EmitError;
use fundamental::constant_entries;
use pebo_cas::{Arena, Expr, Function, Node, Rational, Symbol};
use pebo_design::analysis::{
    Class, Derivation, LeftInverse, Outcome, OutputSlopes, Regression, RegressionKind, RelatedTransform,
};
use pebo_design::plant::{Plant, Settings};

/// An argument of a function of `Model`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Argument {
    Extension,
    Y,
    U,
    Z,
    Eta,
    Theta,
    X,
}

impl Argument {
    /// Its name in the runtime's trait.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Extension => "extension",
            Self::Y => "y",
            Self::U => "u",
            Self::Z => "z",
            Self::Eta => "eta",
            Self::Theta => "theta",
            Self::X => "x",
        }
    }
}

/// A vector or matrix that an argument holds: by columns, and the method that gives it.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) access: Option<&'static str>,
    pub(super) columns: Vec<Vec<Symbol>>,
}

/// A size of the module: the name of its constant, its value, and the counted objects.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) name: &'static str,
    pub(super) value: usize,
}

/// The shape of a function's result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shape {
    /// A vector of this size.
    Vector(&'static str),
    /// A matrix of so many rows and columns.
    Matrix(&'static str, &'static str),
}

/// The constant with the number of equations that hold at every instant beside those of rates.
pub(super) const INSTANTS: &str = "NI";

/// The function that a mechanical model has besides those of `Model`.
pub(super) const VELOCITY: &str = "velocity";

/// The periods of the outputs, of a model with outputs that are angles.
pub(super) const PERIODS: &str = "periods";

/// The regression's unknowns as functions of theta, and their derivatives, of a model that has more of them.
pub(super) const FUNCTIONS: &str = "functions";

/// The values of these functions.
pub(super) const ETA: &str = "eta";

/// Their derivatives.
pub(super) const SLOPES: &str = "slopes";

/// The transform and its derivatives by the recovered states, of a model whose components of phi depend on one another.
pub(super) const TRANSFORM: &str = "transform";

/// The components of phi.
pub(super) const PHI: &str = "phi";

/// Their derivatives.
pub(super) const PHI_SLOPES: &str = "phi_slopes";

/// The slopes of the rates by the outputs, of a model whose observer has these among its states.
pub(super) const OUTPUT_SLOPES: &str = "output_slopes";

/// Those of the known side of the regression.
pub(super) const RATE_SLOPES: &str = "rate_slopes";

/// Those of `h`.
pub(super) const CASCADE_SLOPES: &str = "cascade_slopes";

/// One function.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    pub(super) name: &'static str,
    pub(super) shape: Shape,
    /// The entries by rows; a vector has one in each.
    pub(super) rows: Vec<Vec<Expr>>,
}

/// A function of the runtime's `Model`, which gives the values of one or more definitions.
#[derive(Clone, Debug)]
pub(super) struct Group<'d> {
    pub(super) name: &'static str,
    /// Its arguments, `Y` for the terms of the sample.
    pub(super) arguments: Vec<Argument>,
    pub(super) members: Vec<&'d Definition>,
}

/// The functions of `Model` by name: their arguments, `Y` for the terms of the sample, and the definitions whose values
/// they give.
pub(super) const GROUPS: [(&str, &[Argument], &[&str]); 10] = [
    (PERIODS, &[], &[PERIODS]),
    ("flow", &[Y, U], &["h", "lambda"]),
    ("regression", &[Extension, Y, U], &["phi_0", "phi_1"]),
    ("primitive", &[Extension, Y], &["primitive_0", "primitive_1"]),
    (OUTPUT_SLOPES, &[Y, U, Z], &[RATE_SLOPES, CASCADE_SLOPES]),
    ("theta", &[Eta], &["theta"]),
    (FUNCTIONS, &[Theta], &[ETA, SLOPES]),
    (TRANSFORM, &[X, Y], &[PHI, PHI_SLOPES]),
    ("recover", &[Z, Y], &["phi_left"]),
    (VELOCITY, &[Z, Y], &[VELOCITY]),
];

/// The functions of a model, and the symbols that their arguments hold.
#[derive(Clone, Debug)]
pub(super) struct Definitions<'a> {
    pub(super) functions: Vec<Definition>,
    /// The number of equations that hold at every instant beside those of rates.
    instants: usize,
    /// The equations that the module has.
    pub(super) regression: Regression,
    pub(super) left_inverse: &'a LeftInverse,
    pub(super) class: Class,
    y: Vec<Symbol>,
    u: Vec<Symbol>,
    z: Vec<Symbol>,
    /// theta, where the unknowns are functions of it that a step computes.
    theta: Vec<Symbol>,
    /// The recovered states, where the transform is a function that a step computes.
    x: Vec<Symbol>,
    /// chi of an integrator, xi of a fundamental solution.
    pub(super) chi: Vec<Symbol>,
    /// The columns of Psi, for a fundamental solution.
    pub(super) psi: Vec<Vec<Symbol>>,
    /// The same as expressions: a constant entry is its number 0 or 1.
    pub(super) psi_entries: Vec<Vec<Expr>>,
}

impl<'a> Definitions<'a> {
    /// Collects the formulas of an accepted derivation.
    pub(super) fn of(
        plant: &Plant,
        derivation: &'a Derivation,
        settings: Option<&Settings<Rational>>,
    ) -> Result<Self, EmitError> {
        if derivation.outcome != Outcome::Accepted {
            return Err(EmitError::NotAccepted);
        }
        let cascade = derivation.cascade.result.as_ref().ok_or(EmitError::Missing("cascade"))?;
        let left_inverse = derivation.left_inverse.result.as_ref().ok_or(EmitError::Missing("left inverse"))?;
        let regression = derivation.regression.result.as_ref().ok_or(EmitError::Missing("regression"))?;
        let arena = &plant.arena;
        let regression = regression.computed(arena, settings.is_some_and(Settings::uses_all_rates));
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let (chi, psi) = match derivation.class {
            Class::Pebo => (plant.chi.clone(), Vec::new()),
            Class::Gpebo => (plant.xi.clone(), columns(&plant.psi)),
        };

        let constant = cascade.lambda.as_ref().map(|lambda| constant_entries(arena, lambda)).unwrap_or_default();
        let entry = |(row, column): (usize, usize), symbol: Symbol| {
            constant.get(row).and_then(|entries| entries[column]).unwrap_or_else(|| arena.of_symbol(symbol))
        };
        let psi_entries: Vec<Vec<Expr>> = psi
            .iter()
            .enumerate()
            .map(|(column, entries)| entries.iter().enumerate().map(|(row, &s)| entry((row, column), s)).collect())
            .collect();
        let known: BTreeMap<Symbol, Expr> =
            psi.iter().flatten().copied().zip(psi_entries.iter().flatten().copied()).collect();

        let vector = |name, size, entries: Vec<Expr>| Definition {
            name,
            shape: Shape::Vector(size),
            rows: entries.into_iter().map(|entry| vec![entry]).collect(),
        };
        let matrix = |name, rows, columns, entries: &[Vec<Expr>]| Definition {
            name,
            shape: Shape::Matrix(rows, columns),
            rows: entries.to_vec(),
        };
        let periods = plant.periods_of_outputs().map(|periods| vector(PERIODS, "NY", periods));
        let mut functions = Vec::from_iter(periods);
        functions.push(vector("h", "NZ", cascade.h.clone()));
        if derivation.class == Class::Gpebo {
            let lambda = cascade.lambda.as_ref().ok_or(EmitError::Missing("lambda"))?;
            functions.push(matrix("lambda", "NZ", "NZ", lambda));
        }
        functions.push(vector("phi_0", "NR", regression.phi_0.clone()));
        functions.push(matrix("phi_1", "NR", "NE", &regression.phi_1));
        if regression.kind == RegressionKind::Dynamic {
            let rows = regression.rows().into_iter().map(|row| y.get(row).map(|&s| arena.of_symbol(s)));
            let outputs: Option<Vec<Expr>> = rows.collect();
            let outputs = outputs.ok_or(EmitError::Missing("row of the regression"))?;
            functions.push(vector("primitive_0", "NR", outputs));
        }
        if regression.kind == RegressionKind::Implicit {
            functions.push(vector("primitive_0", "NR", regression.primitive_0.clone()));
            // The trait admits no unknown under the derivative.
            if regression.primitive_1.iter().flatten().any(|factor| !arena.is_zero(*factor)) {
                functions.push(matrix("primitive_1", "NR", "NE", &regression.primitive_1));
            }
        }
        if let Some(slopes) =
            OutputSlopes::of(plant, cascade, &regression).filter(|_| settings.is_some_and(|settings| settings.output))
        {
            let is_some = |rows: &[Vec<Expr>]| rows.iter().flatten().any(|slope| !arena.is_zero(*slope));
            let members = [(RATE_SLOPES, "NR", slopes.rates), (CASCADE_SLOPES, "NZ", slopes.cascade)];
            let members = members.into_iter().filter(|(.., entries)| is_some(entries));
            functions.extend(members.map(|(name, size, entries)| matrix(name, size, "NR", &entries)));
        }
        functions.push(vector("theta", "NZ", regression.theta.clone()));
        let slopes = regression.slopes(plant);
        let theta = if slopes.is_some() { plant.theta.clone() } else { Vec::new() };
        if let Some(slopes) = slopes {
            functions.push(vector(ETA, "NE", regression.eta.clone()));
            functions.push(matrix(SLOPES, "NE", "NZ", &slopes));
        }
        let related = RelatedTransform::of(plant, cascade, left_inverse, &regression);
        let mut x = Vec::new();
        if let Some(RelatedTransform { phi, slopes }) = related {
            x = left_inverse.x.iter().map(|(state, _)| *state).collect();
            functions.push(vector(PHI, "NZ", phi));
            functions.push(matrix(PHI_SLOPES, "NZ", "NX", &slopes));
        }
        let states = left_inverse.x.iter().map(|state| state.1).collect();
        functions.push(vector("phi_left", "NX", states));
        if let Some(pebo_design::plant::Class::Mechanical(mechanical)) = &plant.class {
            functions.push(vector(VELOCITY, "NY", mechanical.velocities.clone()));
        }
        for entry in functions.iter_mut().flat_map(|function| &mut function.rows).flatten() {
            *entry = without_magnitudes(arena, arena.substitute(*entry, &known));
        }
        Ok(Self {
            functions,
            instants: regression.instants(arena),
            regression,
            left_inverse,
            class: derivation.class,
            y,
            u: plant.u.clone(),
            z: plant.z.clone(),
            theta,
            x,
            chi,
            psi,
            psi_entries,
        })
    }

    /// The functions of `Model` that the module has.
    pub(super) fn groups(&self) -> Vec<Group<'_>> {
        let groups = GROUPS.iter().map(|&(name, arguments, members)| {
            let members = self.functions.iter().filter(|function| members.contains(&function.name)).collect();
            Group { name, arguments: arguments.to_vec(), members }
        });
        groups.filter(|group| !group.members.is_empty()).collect()
    }

    /// The parts of an argument.
    pub(super) fn parts(&self, argument: Argument) -> Vec<Part> {
        let column = |access, symbols: &[Symbol]| Part { access, columns: vec![symbols.to_vec()] };
        match (argument, self.class) {
            (Argument::Y, _) => vec![column(None, &self.y)],
            (Argument::U, _) => vec![column(None, &self.u)],
            (Argument::Z, _) => vec![column(None, &self.z)],
            (Argument::Eta, _) => vec![column(None, &self.regression.eta_symbols)],
            (Argument::Theta, _) => vec![column(None, &self.theta)],
            (Argument::X, _) => vec![column(None, &self.x)],
            (Argument::Extension, Class::Pebo) => vec![column(Some("chi"), &self.chi)],
            (Argument::Extension, Class::Gpebo) => {
                vec![column(Some("xi"), &self.chi), Part { access: Some("psi"), columns: self.psi.clone() }]
            }
        }
    }

    /// The symbols that an argument holds, column by column.
    pub(super) fn symbols(&self, argument: Argument) -> Vec<Symbol> {
        self.parts(argument).into_iter().flat_map(|part| part.columns.concat()).collect()
    }

    /// Tests whether a step computes the unknowns as functions of theta, or the transform.
    pub(super) fn has_functions(&self) -> bool {
        !self.theta.is_empty() || self.has_transform()
    }

    /// Tests whether the transform is a function that a step computes.
    pub(super) fn has_transform(&self) -> bool {
        !self.x.is_empty()
    }

    /// Tests whether the observer has outputs among its states.
    pub(super) fn has_output_slopes(&self) -> bool {
        self.functions.iter().any(|function| [RATE_SLOPES, CASCADE_SLOPES].contains(&function.name))
    }

    /// Tests whether equations hold at every instant beside those of rates.
    pub(super) fn has_instants(&self) -> bool {
        self.instants > 0
    }

    /// The constant generics of the model, in the order of the runtime's trait, and the number of equations of an
    /// instant where there are some beside those of rates.
    pub(super) fn sizes(&self) -> Vec<Size> {
        let mut sizes = vec![
            Size { name: "NX", value: self.left_inverse.x.len() },
            Size { name: "NY", value: self.y.len() },
            Size { name: "NU", value: self.u.len() },
            Size { name: "NZ", value: self.z.len() },
            Size { name: "NR", value: self.regression.phi_0.len() },
            Size { name: "NE", value: self.regression.eta_symbols.len() },
        ];
        sizes.extend(self.has_instants().then_some(Size { name: INSTANTS, value: self.instants }));
        sizes
    }
}

/// The expression with `abs(a)^2` as `a^2`, and so for every even power.
fn without_magnitudes(arena: &Arena, expr: Expr) -> Expr {
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for part in arena.postorder(&[expr]) {
        let rebuilt = arena.rebuild(part, &known);
        let rebuilt = match arena.node(rebuilt) {
            Node::Product(product) => {
                let factors = product.factors.iter().map(|(base, exponent)| match arena.node(*base) {
                    Node::Call(Function::Abs, inner)
                        if exponent.is_integer() && exponent.numerator().trailing_zeros() > 0 =>
                    {
                        (inner[0], exponent.clone())
                    }
                    _ => (*base, exponent.clone()),
                });
                arena.multiply(&product.coefficient, factors)
            }
            _ => rebuilt,
        };
        known.insert(part, rebuilt);
    }
    known[&expr]
}

/// The columns of a square table of rows.
fn columns(rows: &[Vec<Symbol>]) -> Vec<Vec<Symbol>> {
    (0..rows.len()).map(|column| rows.iter().map(|row| row[column]).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_powers_need_no_magnitude() {
        let arena = Arena::new();
        let [q, r] = ["q", "r"].map(|name| arena.variable(name));
        let magnitude = arena.call(Function::Abs, &[q]);
        let power = |exponent: i64| arena.power(magnitude, &exponent.into());
        let cases = [(power(2), "q^2"), (power(-4), "1/q^4"), (power(3), "abs(q)^3"), (magnitude, "abs(q)")];
        for (written, expected) in cases {
            assert_eq!(arena.print(without_magnitudes(&arena, written)), expected);
        }
        let inside = arena.sqrt(arena.add(r, arena.div(power(2), arena.power(q, &4.into()))));
        assert_eq!(arena.print(without_magnitudes(&arena, inside)), "sqrt(r + 1/q^2)");
    }
}
