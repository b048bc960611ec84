//! Outputs given by value: `V = g(x, y, u)` in place of `V' = f_y`.
//!
//! In: outputs with their values. Out: the identities `V - g = 0`, and the rates that follow from the values along the
//! plant. A value that depends on an input has none: the rate of an input is not known.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::Diagnostics;
use pebo_cas::{Arena, Expr, Symbol};

use super::parts::{Formula, Output, State, confined};

/// Refuses a value that depends on the output itself, or on a symbol that is not allowed.
pub(super) fn confine(arena: &Arena, outputs: &[Output], allowed: &BTreeSet<Symbol>, problems: &mut Diagnostics) {
    for output in outputs {
        let Some(value) = output.value else { continue };
        let others: BTreeSet<Symbol> = allowed.iter().copied().filter(|symbol| *symbol != output.symbol).collect();
        let name = arena.name(output.symbol);
        let place = format!("the value of {name}");
        let confined = confined(arena, value.expr, value.span, &others, &place);
        // A rate often holds the output that it is of; a value of that kind would be an equation for the output.
        let of_itself = arena.symbols_of(&[value.expr]).contains(&output.symbol);
        problems.keep(confined.map_err(|refusal| {
            if !of_itself {
                return refusal;
            }
            refusal.help(format!(
                "`g_y` takes the value of `{name}` in the other signals; if this is its time derivative, write it under `f_y`"
            ))
        }));
    }
}

/// The identities of the given values.
pub(super) fn identities(arena: &Arena, outputs: &[Output]) -> Vec<Formula> {
    let difference = |output: &Output| {
        let value = output.value?;
        Some(Formula { expr: arena.sub(arena.of_symbol(output.symbol), value.expr), span: value.span })
    };
    outputs.iter().filter_map(difference).collect()
}

/// Gives outputs without a rate that of their value along the plant, where all that the value depends on has one.
pub(super) fn move_along(
    arena: &Arena,
    states: &[State],
    outputs: &mut [Output],
    time: Option<Symbol>,
    constants: &BTreeSet<Symbol>,
) {
    let mut rates: BTreeMap<Symbol, Expr> = states.iter().map(|state| (state.symbol, state.rate.expr)).collect();
    rates.extend(outputs.iter().filter_map(|output| Some((output.symbol, output.rate?.expr))));
    rates.extend(time.map(|time| (time, arena.one())));
    // A value may depend on outputs that are themselves given by their value: each pass gives at least one a rate.
    loop {
        let known = |symbol: &Symbol| rates.contains_key(symbol) || constants.contains(symbol);
        let next = outputs.iter_mut().find_map(|output| {
            let value = output.value.filter(|_| output.rate.is_none())?;
            arena.symbols_of(&[value.expr]).iter().all(known).then_some((output, value))
        });
        let Some((output, value)) = next else { return };
        let rate = arena.directional(value.expr, &rates);
        output.rate = Some(Formula { expr: rate, span: value.span });
        rates.insert(output.symbol, rate);
    }
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::{Code, Diagnostic, Source};

    fn resolved(lines: &str) -> Result<Plant, Vec<Diagnostic>> {
        let text =
            format!("model: m\nparameters: [k]\nx: [a, b]\nu: [v]\nw: [w]\nf_x: {{a: v, b: a}}\nphi: [a]\n{lines}\n");
        Plant::resolve(&Model::parse(&Source::new("m", text.as_str()).unwrap()).unwrap())
    }

    /// The identities, and the rates of the outputs.
    fn meaning(lines: &str) -> (Vec<String>, Vec<Option<String>>) {
        let plant = resolved(lines).unwrap();
        let print = |expr| plant.arena.print(expr);
        let rates = plant.y.iter().map(|output| output.rate.map(|rate| print(rate.expr))).collect();
        (plant.identities.iter().map(|identity| print(identity.expr)).collect(), rates)
    }

    #[test]
    fn a_value_is_an_identity_and_has_its_rate_along_the_plant() {
        let text = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        let rates = |texts: &[Option<&str>]| texts.iter().map(|t| t.map(str::to_owned)).collect::<Vec<_>>();
        for (lines, identities, expected) in [
            ("y: [p]\ng_y: {p: k*b}", text(&["p - k*b"]), rates(&[Some("k*a")])),
            // The rate of an input is not known.
            ("y: [p]\ng_y: {p: b + v}", text(&["p - b - v"]), rates(&[None])),
            // By way of another output, in either order.
            ("y: [p, q]\ng_y: {p: 2*q, q: b}", text(&["p - 2*q", "q - b"]), rates(&[Some("2*a"), Some("a")])),
            ("y: [p, q]\ng_y: {p: q}\nf_y: {q: b}", text(&["p - q"]), rates(&[Some("b"), Some("b")])),
            ("y: [p, q]\ng_y: {p: q}", text(&["p - q"]), rates(&[None, None])),
            // A rate that the author gives is kept.
            ("y: [p]\ng_y: {p: b}\nf_y: {p: a + 0}", text(&["p - b"]), rates(&[Some("a")])),
        ] {
            assert_eq!(meaning(lines), (identities, expected), "{lines}");
        }
    }

    #[test]
    fn a_value_depends_on_other_signals_that_are_known() {
        for (lines, name) in [("y: [p]\ng_y: {p: p + b}", "`p`"), ("y: [p]\ng_y: {p: b + w}", "`w`")] {
            let refused = resolved(lines).expect_err(lines);
            assert_eq!((refused.len(), refused[0].code), (1, Code::MisplacedName), "{lines}");
            assert!(
                refused[0].message.starts_with("the value of p cannot depend on") && refused[0].message.ends_with(name)
            );
            let asks_for_f_y = refused[0].help.as_ref().is_some_and(|help| help.ends_with("write it under `f_y`"));
            assert_eq!(asks_for_f_y, name == "`p`", "{lines}");
        }
    }
}
