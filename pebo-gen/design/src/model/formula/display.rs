//! A formula as text in its own grammar, with the parentheses that it needs and no others.

use std::fmt;

use super::{Comparison, Formula, Operator, Relation, Term};
use pebo_cas::graph::function::pieces::suffix;

/// The binding strength of the outermost operator of a formula.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Sign,
    Power,
    Atom,
}

impl Formula {
    fn binding(&self) -> Binding {
        match &self.term {
            Term::Number(_) | Term::Name(_) | Term::Estimate(_) | Term::Call(..) | Term::Table(..) => Binding::Atom,
            Term::Negative(_) => Binding::Sign,
            Term::Binary(Operator::Add | Operator::Subtract, ..) => Binding::Sum,
            Term::Binary(Operator::Multiply | Operator::Divide, ..) => Binding::Product,
            Term::Binary(Operator::Power, ..) => Binding::Power,
        }
    }

    /// Writes it as an operand of something that binds at least as tightly as `least`.
    fn write(&self, f: &mut fmt::Formatter<'_>, least: Binding) -> fmt::Result {
        if self.binding() < least { write!(f, "({self})") } else { write!(f, "{self}") }
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.term {
            Term::Number(number) => f.write_str(number.text()),
            Term::Name(name) => f.write_str(name),
            Term::Estimate(name) => write!(f, "hat({name})"),
            Term::Negative(operand) => {
                f.write_str("-")?;
                operand.write(f, Binding::Sign)
            }
            Term::Binary(operator, left, right) => {
                // Of two operators of one kind the left one comes first, of two powers the right one.
                let (sign, on_left, on_right) = match operator {
                    Operator::Add => (" + ", Binding::Sum, Binding::Product),
                    Operator::Subtract => (" - ", Binding::Sum, Binding::Product),
                    Operator::Multiply => ("*", Binding::Product, Binding::Sign),
                    Operator::Divide => ("/", Binding::Product, Binding::Sign),
                    Operator::Power => ("^", Binding::Atom, Binding::Sign),
                };
                left.write(f, on_left)?;
                f.write_str(sign)?;
                right.write(f, on_right)
            }
            Term::Table(table, order, argument) => write!(f, "{}{}({argument})", table.name, suffix(*order)),
            Term::Call(function, arguments) => {
                write!(f, "{}(", function.row().name)?;
                for (index, argument) in arguments.iter().enumerate() {
                    write!(f, "{}{argument}", if index == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Less => "<",
            Self::LessOrEqual => "<=",
            Self::Greater => ">",
            Self::GreaterOrEqual => ">=",
            Self::NotEqual => "!=",
        })
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.first)?;
        self.rest.iter().try_for_each(|(relation, side)| write!(f, " {relation} {side}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::formula::{Estimates, SpanMap, parse_comparison, parse_formula};

    fn parsed(text: &str) -> Formula {
        parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused).unwrap()
    }

    #[test]
    fn a_printed_formula_reads_back_as_itself() {
        for (text, printed) in [
            ("(E-(1-d)*v2)/L1", "(E - (1 - d)*v2)/L1"),
            ("-x^2 + (-x)**2", "-x^2 + (-x)^2"),
            ("2^3^2 - (2^3)^2", "2^3^2 - (2^3)^2"),
            ("a - (b - c) - (d + e)", "a - (b - c) - (d + e)"),
            ("a/(b*c)/d*(e/f)", "a/(b*c)/d*(e/f)"),
            ("-(a + b) * -c / -10e-3", "-(a + b)*-c/-10e-3"),
            ("x^-1 + x^(a+1) + -(-x)", "x^-1 + x^(a + 1) + --x"),
            ("atan2(sin(q), .5) + ln(x)", "atan2(sin(q), .5) + log(x)"),
            ("(((((x)))))", "x"),
        ] {
            assert_eq!(parsed(text).to_string(), printed, "{text}");
            assert_eq!(parsed(printed).to_string(), printed, "{text}");
        }
    }

    #[test]
    fn a_comparison_keeps_its_chain() {
        let text = "0<d <= 1-e";
        let read = parse_comparison(text, &SpanMap::verbatim(text, 0), &[]).unwrap();
        assert_eq!(read.to_string(), "0 < d <= 1 - e");
    }
}
