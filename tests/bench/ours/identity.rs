//! Jobs about expressions: a list of residuals to be proved zero, or a model file to be derived.

use std::collections::BTreeMap;

use pebo_cas::Domain;
use pebo_cas::Relation;
use pebo_cas::domain::zero::decide;
use pebo_cas::{Arena, Expr};
use pebo_gen::analysis::Outcome;
use pebo_gen::derive;
use pebo_gen::model::formula::{Estimates, SpanMap, parse_formula};
use pebo_gen::plant::{Scope, lower};
use pebo_gen::source::Source;
use serde_json::Value;

use crate::protocol::{Work, entries, pairs, texts};

/// The rates of the transform less their known values, and identities as they are: all zero.
pub(crate) fn proof(job: &Value, alone: bool) -> Result<Work, String> {
    let arena = Arena::new();
    let mut scope = Scope::new();
    for name in texts(job, "symbols") {
        scope.define(name, arena.variable(name));
    }
    for (name, text) in pairs(job, "define") {
        let meaning = value(&arena, &scope, text)?;
        scope.define(name, meaning);
    }
    let mut domain = Domain::default();
    for text in texts(job, "assume") {
        domain.facts.assume(value(&arena, &scope, text)?, Relation::Positive);
    }
    let mut rates = BTreeMap::new();
    for (state, rate) in entries(job, "rates") {
        rates.insert(arena.symbol(state), value(&arena, &scope, rate)?);
    }
    let mut identities = Vec::new();
    for text in texts(job, "zero") {
        identities.push(value(&arena, &scope, text)?);
    }
    let mut claims = Vec::new();
    for (phi, side) in pairs(job, "claims") {
        claims.push((value(&arena, &scope, phi)?, value(&arena, &scope, side)?));
    }
    let derived = move |arena: &Arena| -> Vec<Expr> {
        let rate = |(phi, side): &(Expr, Expr)| arena.sub(arena.directional(*phi, &rates), *side);
        identities.iter().copied().chain(claims.iter().map(rate)).collect()
    };
    let found = alone.then(|| derived(&arena));
    Ok(Box::new(move || {
        let residuals = found.unwrap_or_else(|| derived(&arena));
        let open = residuals.iter().map(|residual| decide(&arena, *residual, &domain)).find(|answer| !answer.is_zero());
        Box::new(move || open.map_or(Ok(()), |answer| Err(format!("{answer:?}"))))
    }))
}

/// All claims of a model file, from its text.
pub(crate) fn derivation(job: &Value) -> Result<Work, String> {
    let path = job["path"].as_str().ok_or("the job has no path")?;
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let source = Source::new(path, text).map_err(|_| "not a source".to_owned())?;
    Ok(Box::new(move || {
        let answer = derive(&source);
        Box::new(move || match answer {
            Ok(derived) if derived.derivation.outcome == Outcome::Accepted => Ok(()),
            Ok(derived) => Err(format!("{:?}", derived.derivation.outcome)),
            Err(diagnostics) => Err(diagnostics.first().map_or_else(String::new, |first| first.message.to_string())),
        })
    }))
}

fn value(arena: &Arena, scope: &Scope, text: &str) -> Result<Expr, String> {
    let formula = parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused)
        .map_err(|diagnostic| diagnostic.message.to_string())?;
    lower(arena, scope, &formula).map_err(|diagnostic| diagnostic.message.to_string())
}
