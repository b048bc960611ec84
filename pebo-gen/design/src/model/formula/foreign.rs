//! Syntax of other languages that formulas do not have, with replacements.

/// A replacement for a word that other languages have between operands.
pub(super) fn operator(word: &str) -> Option<&'static str> {
    Some(match word {
        "and" => AND,
        "or" => "what holds only sometimes is no assumption: write what holds wherever the plant operates",
        "if" | "else" | "then" => BRANCHES,
        "mod" => "formulas have no remainder; a state known up to a period stands under `angles`",
        _ => return None,
    })
}

/// A replacement for two comparisons in one.
const AND: &str = "write each comparison as an entry of its own, as `[0 < v, v < 24]`, or a chain, as `0 < v < 24`";

/// A replacement for branches.
const BRANCHES: &str = "formulas have no branches: use max, min, sat, sign or abs";

/// A replacement for a call that other languages have; the argument begins with time if it is `timed`.
pub(super) fn call(name: &str, timed: bool) -> Option<String> {
    Some(match name.to_ascii_lowercase().as_str() {
        "if" | "ifelse" | "where" | "piecewise" | "cases" => BRANCHES.to_owned(),
        "interp" | "interp1" | "interp1d" | "interpolate" | "lookup" | "table" | "lut" | "spline" | "pchip" => {
            "write its points under `define`, as `curve: {table: load, points: [[0, 0], [1, 2]]}`, and `curve` here"
                .to_owned()
        }
        "der" | "diff" | "deriv" | "derivative" | "ddt" => {
            "formulas have no derivatives: write the formula of the derivative in its place".to_owned()
        }
        "int" | "integral" | "integrate" => {
            "formulas have no integrals: make the integral a state, whose rate stands under `f_x`".to_owned()
        }
        "delay" => DELAY.to_owned(),
        "pow" => "write `a^b` for the power".to_owned(),
        "heaviside" => format!("write `(1 + sign(a))/2` for `{name}(a)`"),
        "log10" => "write `log(a)/log(10)`: `log` is the natural logarithm".to_owned(),
        "log2" => "write `log(a)/log(2)`: `log` is the natural logarithm".to_owned(),
        _ if timed => format!("write `{name}` for its value now; {DELAY}"),
        _ => return None,
    })
}

/// A replacement for a delayed signal.
const DELAY: &str =
    "formulas have no delayed signals: a delayed input is an input of its own, with its own name under `u`";

/// A replacement for an operator of other languages, with which `rest` begins.
pub(super) fn character(before: &str, rest: &str) -> Option<String> {
    Some(match rest.chars().next()? {
        '&' => AND.to_owned(),
        '?' | ':' => BRANCHES.to_owned(),
        '%' => "write a share of 1, as `0.5` for 50 %".to_owned(),
        '|' if !before.contains('|') => {
            let inner = rest[1..].split('|').next().filter(|inner| !inner.is_empty() && inner.len() + 1 < rest.len());
            format!("the absolute value is `abs({})`", inner.unwrap_or("a"))
        }
        _ => return None,
    })
}
