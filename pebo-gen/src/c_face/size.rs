//! The memory of an observer: a bound for all targets, from the types of the runtime library that it is made of.
//!
//! ```text
//! type of the observer -> layout of each part, as on a 64-bit target without niches -> words of 64 bits
//! ```
//!
//! A structure takes the sum of its fields, rounded up to its alignment, as the compiler sorts fields by alignment; an
//! optional value takes one alignment more. Pointers and counters are those of 64 bits. Holds when: fields are those of
//! `pebo_runtime` that emitted code is written for; the face asserts the bound where it is compiled, so that a change
//! there ends in a message and not in memory that is too small. On 32-bit targets no part is larger.

use syn::{GenericArgument, PathArguments, Type};

use super::module::Module;
use crate::emit::Scalar;

/// The words of 64 bits that the face sets aside for an observer; none if a type is not known here.
pub(super) fn words(module: &Module, scalar: Scalar) -> Option<usize> {
    let layouts = Layouts { module, scalar: if scalar == Scalar::F32 { 4 } else { 8 } };
    let observer = layouts.of(&module.tuned)?;
    let size = |name: &str| module.sizes.get(name).copied();
    let limits = module.has_limits.then(|| Some(layouts.limits(size("NY")?, size("NU")?)));
    let gate = module.has_gate.then(|| Layout::of(&[layouts.scalars(1), Layout::COUNTER, Layout::COUNTER]));
    let place = [Some(Layout::WORD), Some(observer), Some(layouts.scalars(start(module)?))];
    let parts: Option<Vec<Layout>> = place.into_iter().chain(limits).chain(gate.map(Some)).collect();
    Some(Layout::of(&parts?).size.div_ceil(Layout::WORD.size))
}

/// The number of components of the extension.
pub(super) fn start(module: &Module) -> Option<usize> {
    module.sizes.get(start_name(module)).copied()
}

/// The name of that number in the emitted module.
pub(super) fn start_name(module: &Module) -> &'static str {
    if module.sizes.contains_key("NO") { "NO" } else { "NZ" }
}

/// The size of a type in bytes, and its alignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    size: usize,
    align: usize,
}

impl Layout {
    /// A pointer, or an index.
    const WORD: Self = Self { size: 8, align: 8 };
    /// A counter of 32 bits.
    const COUNTER: Self = Self { size: 4, align: 4 };
    /// A flag.
    const FLAG: Self = Self { size: 1, align: 1 };

    /// A structure of fields, or of numbers.
    fn of(fields: &[Self]) -> Self {
        let align = fields.iter().map(|field| field.align).max().unwrap_or(1);
        let size: usize = fields.iter().map(|field| field.size).sum();
        Self { size: size.next_multiple_of(align), align }
    }

    fn times(self, count: usize) -> Self {
        Self { size: self.size * count, ..self }
    }

    /// The same, or nothing.
    fn optional(self) -> Self {
        Self { size: self.size + self.align, ..self }
    }
}

/// Layouts of the types of a module.
struct Layouts<'a> {
    module: &'a Module,
    /// The bytes of a number.
    scalar: usize,
}

impl Layouts<'_> {
    fn scalars(&self, count: usize) -> Layout {
        Layout { size: self.scalar * count, align: self.scalar }
    }

    /// The layout of a type.
    fn of(&self, ty: &Type) -> Option<Layout> {
        let (name, arguments) = named(ty)?;
        match name.as_str() {
            "Observer" => self.observer(&arguments),
            "LateObserver" => self.late_observer(&arguments),
            _ => self.model(&name, &arguments).or_else(|| self.part(&name, &arguments)),
        }
    }

    /// The number that an argument of a type stands for.
    fn count(&self, arguments: &[Type], place: usize) -> Option<usize> {
        let (name, _) = named(arguments.get(place)?)?;
        self.module.sizes.get(&name).copied()
    }

    /// An observer: of the model and a filter if it is the module's own abbreviation, which has the estimator alone.
    fn observer(&self, arguments: &[Type]) -> Option<Layout> {
        let module = self.module;
        let size = |name: &str| module.sizes.get(name).copied();
        let (ny, nu, nr, ne) = match arguments.len() {
            1 => (size("NY")?, size("NU")?, size("NR")?, size("NE")?),
            _ => (
                self.count(arguments, 3)?,
                self.count(arguments, 4)?,
                self.count(arguments, 6)?,
                self.count(arguments, 7)?,
            ),
        };
        let (model, estimator) = match arguments {
            [estimator] => (self.scalars(module.constants), estimator),
            [model, estimator, ..] => (self.of(model)?, estimator),
            [] => return None,
        };
        let regression = match arguments.get(8) {
            Some(regression) => self.of(regression)?,
            None => self.filtered(nr, ne),
        };
        let is_output_form = arguments.iter().any(|argument| mentions(argument, "OutputForm"));
        let (extension, terms) = if is_output_form {
            (self.fundamental(ne), self.scalars(module.terms + ny))
        } else {
            (self.of(&module.extension)?, self.scalars(module.terms))
        };
        let state = Layout::of(&[
            self.scalars(ny).optional(),
            self.scalars(nu).optional(),
            extension,
            regression,
            self.of(estimator)?,
            Layout::COUNTER,
        ]);
        // The number of samples, or the form without drift with its number.
        let trigger = Layout::of(&[self.scalars(1).optional(), Layout::COUNTER]);
        Some(Layout::of(&[
            model,
            state,
            terms.optional(),
            Layout::of(&[trigger, Layout::WORD]).optional(),
            Layout::of(&[self.scalars(ny), Layout::WORD]).optional(),
            Layout::of(&[Layout::WORD.optional().times(nr), Layout::WORD]).optional(),
            Layout::FLAG,
        ]))
    }

    fn late_observer(&self, arguments: &[Type]) -> Option<Layout> {
        let observer = self.observer(arguments)?;
        let (ny, nu, nr) = (self.count(arguments, 3)?, self.count(arguments, 4)?, self.count(arguments, 6)?);
        let flags = Layout::FLAG.times(ny);
        let instant = Layout::of(&[self.scalars(1 + nu + ny), flags]);
        let arrivals = [instant.times(self.count(arguments, 9)?), Layout::WORD.times(2), self.scalars(2 * ny)];
        let late = [self.scalars(ny), Layout::WORD.times(nr), flags];
        Some(Layout::of(&[observer, observer.optional(), Layout::of(&arrivals), Layout::of(&late)]))
    }

    /// A model: the module's own, or one of the runtime's around it.
    fn model(&self, name: &str, arguments: &[Type]) -> Option<Layout> {
        Some(match name {
            _ if name == self.module.type_name => self.scalars(self.module.constants),
            "OutputForm" => {
                let rows = self.count(arguments, 2)?;
                let expected = Layout::of(&[Layout::WORD.times(rows), self.scalars(rows)]);
                Layout::of(&[self.of(arguments.first()?)?, expected.optional()])
            }
            "Within" => Layout::of(&[self.of(arguments.first()?)?, self.scalars(2 * self.count(arguments, 2)?)]),
            _ => return None,
        })
    }

    /// An estimator, an extension, or an operator on the regression.
    fn part(&self, name: &str, arguments: &[Type]) -> Option<Layout> {
        let count = |place: usize| self.count(arguments, place);
        let inner = || self.of(arguments.get(1)?);
        Some(match name {
            "Integrator" => self.scalars(2 * count(1)?),
            "Fundamental" => self.fundamental(count(1)?),
            "Gradient" => self.gradient(count(1)?),
            "NormalisedGradient" => Layout::of(&[self.gradient(count(1)?), self.scalars(1)]),
            "LeastSquares" => self.least_squares(count(1)?),
            "AdaptiveLeastSquares" => {
                let (nr, ne) = (count(1)?, count(2)?);
                Layout::of(&[self.least_squares(ne), self.scalars(ne + 2 + 3 * nr)])
            }
            "Bounded" => {
                let ne = count(2)?;
                Layout::of(&[inner()?, self.scalars(4 * ne), self.scalars(ne * ne).optional()])
            }
            "Drem" => Layout::of(&[inner()?, self.scalars(3 * count(2)?)]),
            "Kreisselmeier" => {
                let ne = count(1)?;
                self.scalars(3 * ne + DECAY + 2 * ne * ne)
            }
            "Response" => {
                let ne = count(3)?;
                Layout::of(&[self.scalars(2 * ne), inner()?.times(ne + 2)])
            }
            "FiniteTime" => {
                let ne = count(2)?;
                let reference = self.scalars(ne + 2 * ne * ne + 2);
                let drem = Layout::of(&[inner()?, self.scalars(3 * ne)]);
                Layout::of(&[drem, self.scalars(1), self.scalars(1).optional(), reference.times(2)])
            }
            "SampledRegression" => {
                let (nr, ne) = (count(1)?, count(2)?);
                self.scalars(2 * nr + nr * ne)
            }
            "WindowedRegression" => {
                let (nr, ne, samples) = (count(1)?, count(2)?, count(3)?);
                let sides = self.scalars((nr + nr * ne + 1) * (samples + 4));
                Layout::of(&[Layout::FLAG, sides, Layout::WORD])
            }
            _ => return None,
        })
    }

    fn fundamental(&self, nz: usize) -> Layout {
        self.scalars(2 * (nz + nz * nz))
    }

    fn gradient(&self, ne: usize) -> Layout {
        let information = self.scalars(information(ne));
        Layout::of(&[information, information.optional(), self.scalars(2 * ne)])
    }

    fn least_squares(&self, ne: usize) -> Layout {
        self.scalars(2 * information(ne) + DECAY + 3 * ne)
    }

    /// The regression behind a filter: bandwidth, weights and outputs, each a sum with its carry.
    fn filtered(&self, nr: usize, ne: usize) -> Layout {
        let filter = Layout::of(&[self.scalars(4), Layout::FLAG]);
        Layout::of(&[filter, self.scalars(2 * (nr + nr * ne))])
    }

    fn limits(&self, ny: usize, nu: usize) -> Layout {
        Layout::of(&[self.scalars(2 * (ny + nu)), self.scalars(1).optional()])
    }
}

/// The numbers of a rate with its share of a step.
const DECAY: usize = 4;

/// The numbers of an information matrix of so many unknowns: rows, weights and targets.
fn information(unknowns: usize) -> usize {
    unknowns * (unknowns + 2)
}

/// The last name of a path, with its arguments.
fn named(ty: &Type) -> Option<(String, Vec<Type>)> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last()?;
    let arguments = match &last.arguments {
        PathArguments::AngleBracketed(list) => list
            .args
            .iter()
            .filter_map(|argument| match argument {
                GenericArgument::Type(ty) => Some(ty.clone()),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    };
    Some((last.ident.to_string(), arguments))
}

/// Tests whether a type, or one of its arguments, has this name.
pub(super) fn mentions(ty: &Type, name: &str) -> bool {
    named(ty)
        .is_some_and(|(found, arguments)| found == name || arguments.iter().any(|argument| mentions(argument, name)))
}
