//! Labels of curves, with formulas typeset: `hat(i1) - i1` becomes an i with a hat and a subscript, a minus sign, an i
//! with a subscript.

use pebo_cas::print::letter::{greek, parts};
use pebo_design::model::formula::{Formula, Operator, Term};

/// A label: pieces of text in a row.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Label {
    pub(crate) runs: Vec<Piece>,
}

/// A piece of a label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub(crate) text: String,
    /// Variables are slanted; numbers, functions and signs are not.
    pub(crate) italic: bool,
    pub(crate) height: Height,
}

/// The height of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Height {
    Line,
    Below,
    Above,
}

// The binding strength of a formula's outermost operation.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const POWER: u8 = 3;
const ATOM: u8 = 4;

impl Label {
    /// The label of a formula.
    pub(crate) fn formula(formula: &Formula) -> Self {
        let mut label = Self::default();
        label.write(formula, SUM);
        label
    }

    /// The label of a name.
    pub(crate) fn name(name: &str) -> Self {
        let mut label = Self::default();
        label.write_name(name, false);
        label
    }

    /// Ten to some power.
    pub(crate) fn power_of_ten(exponent: i32) -> Self {
        let mut label = Self::default();
        label.upright("10");
        label.push(&exponent.to_string().replace('-', "−"), false, Height::Above);
        label
    }

    /// The label of a plain text.
    pub(crate) fn text(text: &str) -> Self {
        let mut label = Self::default();
        label.upright(text);
        label
    }

    /// The label of a unit behind "in": `m^3/s` has its 3 raised.
    pub(crate) fn unit(unit: &str) -> Self {
        let mut label = Self::default();
        let mut parts = unit.split('^');
        label.upright(parts.next().unwrap_or_default());
        for part in parts {
            let digits = part.trim_start_matches('-').trim_start_matches(|c: char| c.is_ascii_digit());
            let (exponent, rest) = part.split_at(part.len() - digits.len());
            if exponent.trim_start_matches('-').is_empty() {
                label.upright(&format!("^{part}"));
            } else {
                label.push(&exponent.replace('-', "−"), false, Height::Above);
                label.upright(rest);
            }
        }
        label
    }

    /// The label with its unit behind it.
    pub(crate) fn in_unit(self, unit: &str) -> Self {
        self.then(Self::text(" in ")).then(Self::unit(unit))
    }

    /// The label with another one behind it.
    pub(crate) fn then(mut self, other: Self) -> Self {
        for run in other.runs {
            self.push(&run.text, run.italic, run.height);
        }
        self
    }

    /// The label of a state's estimate.
    pub(crate) fn estimate(state: &str) -> Self {
        let mut label = Self::default();
        label.write_name(state, true);
        label
    }

    /// The label of a state's estimate less the state.
    pub(crate) fn error(state: &str) -> Self {
        let mut label = Self::default();
        label.write_name(state, true);
        label.upright(" − ");
        label.write_name(state, false);
        label
    }

    /// The label with a remark in parentheses.
    pub(crate) fn remark(mut self, remark: &str) -> Self {
        self.upright(&format!(" ({remark})"));
        self
    }

    fn write(&mut self, formula: &Formula, least: u8) {
        let binding = binding(formula);
        if binding < least {
            self.upright("(");
            self.write(formula, SUM);
            self.upright(")");
            return;
        }
        match &formula.term {
            Term::Number(number) => self.upright(number.text()),
            Term::Name(name) => self.write_name(name, false),
            Term::Estimate(name) => self.write_name(name, true),
            Term::Negative(operand) => {
                self.upright("−");
                self.write(operand, PRODUCT);
            }
            Term::Binary(Operator::Power, base, exponent) => {
                self.write(base, ATOM);
                if let Term::Number(number) = &exponent.term {
                    self.push(number.text(), false, Height::Above);
                } else {
                    self.upright("^");
                    self.write(exponent, ATOM);
                }
            }
            Term::Binary(operator, left, right) => {
                let (sign, least) = match operator {
                    Operator::Add => (" + ", PRODUCT),
                    Operator::Subtract => (" − ", PRODUCT),
                    Operator::Multiply => ("\u{2009}", POWER),
                    Operator::Divide | Operator::Power => ("/", POWER),
                };
                self.write(left, binding);
                self.upright(sign);
                self.write(right, least);
            }
            Term::Table(table, order, argument) => {
                self.write_name(&table.name, false);
                self.upright(&"′".repeat(*order));
                self.upright("(");
                self.write(argument, SUM);
                self.upright(")");
            }
            Term::Call(function, arguments) => {
                self.upright(function.row().name);
                self.upright("(");
                for (index, argument) in arguments.iter().enumerate() {
                    if index > 0 {
                        self.upright(", ");
                    }
                    self.write(argument, SUM);
                }
                self.upright(")");
            }
        }
    }

    /// A name: its letter, its index below. A word gets no hat above, which would stand on its first letter.
    fn write_name(&mut self, name: &str, hat: bool) {
        let (base, index) = parts(name);
        let base = greek(base).map_or_else(|| base.to_owned(), String::from);
        let is_letter = base.chars().count() == 1;
        match (hat, is_letter) {
            (true, true) => self.push(&hatted(&base), true, Height::Line),
            (true, false) => {
                self.upright("hat(");
                self.push(&base, true, Height::Line);
            }
            (false, _) => self.push(&base, true, Height::Line),
        }
        if !index.is_empty() {
            self.push(index, false, Height::Below);
        }
        if hat && !is_letter {
            self.upright(")");
        }
    }

    fn upright(&mut self, text: &str) {
        self.push(text, false, Height::Line);
    }

    fn push(&mut self, text: &str, italic: bool, height: Height) {
        if text.is_empty() {
            return;
        }
        match self.runs.last_mut() {
            Some(last) if last.italic == italic && last.height == height => last.text.push_str(text),
            _ => self.runs.push(Piece { text: text.to_owned(), italic, height }),
        }
    }
}

fn binding(formula: &Formula) -> u8 {
    match &formula.term {
        Term::Number(_) | Term::Name(_) | Term::Estimate(_) | Term::Call(..) | Term::Table(..) => ATOM,
        Term::Negative(_) | Term::Binary(Operator::Add | Operator::Subtract, ..) => SUM,
        Term::Binary(Operator::Multiply | Operator::Divide, ..) => PRODUCT,
        Term::Binary(Operator::Power, ..) => POWER,
    }
}

/// The letter with a hat: one character where there is one, for not every font can combine.
fn hatted(letter: &str) -> String {
    const PLAIN: &str = "aceghijosuwyzACEGHIJOSUWYZ";
    const HATTED: &str = "âĉêĝĥîĵôŝûŵŷẑÂĈÊĜĤÎĴÔŜÛŴŶẐ";
    let found = PLAIN.chars().zip(HATTED.chars()).find(|(plain, _)| letter.starts_with(*plain));
    found.map_or_else(|| format!("{letter}\u{302}"), |(_, hatted)| hatted.to_string())
}

#[cfg(test)]
mod tests {
    use super::{Height, Label};

    #[test]
    fn exponents_of_units_are_raised() {
        let runs = |unit: &str| {
            let height = |height| if height == Height::Above { "^" } else { "_" };
            let label = Label::unit(unit);
            label.runs.iter().flat_map(|run| [height(run.height), run.text.as_str()]).collect::<String>()
        };
        assert_eq!(runs("m^3/s"), "_m^3_/s");
        assert_eq!(runs("N m s^-1"), "_N m s^−1");
        assert_eq!(runs("rad/s"), "_rad/s");
        // Text that is no exponent is kept as written.
        assert_eq!(runs("V^x ^"), "_V^x ^");
        assert_eq!(runs("m^-"), "_m^-");
        assert_eq!(runs(""), "");
    }
}
