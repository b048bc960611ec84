//! The crate symplex at the jobs of the benchmarks: proofs by the recipes below, polynomials by its `MultiPoly`.

#[path = "../../../ours/protocol.rs"]
mod protocol;

use std::collections::BTreeMap;
use std::process::ExitCode;

use protocol::{JobOptions, Work, entries, number, pairs, terms, texts};
use serde_json::Value;
use symplex::num_bigint::BigInt;
use symplex::num_rational::Ratio;
use symplex::prelude::{Assumption, Context, Ex, MultiPoly};

type Poly = MultiPoly<symplex::multipoly::Lex>;

fn main() -> ExitCode {
    protocol::serve(|job: &Value, how: &JobOptions| match job["kind"].as_str() {
        Some("zero") if how.recipe == "by hand" && job["by_hand"].is_null() => Err("nothing by hand".to_owned()),
        Some("zero") if how.recipe == "by hand" => proof(&job["by_hand"], how),
        Some("zero") => proof(job, how),
        Some("product") => product(job),
        Some("gcd") => gcd(job),
        _ => Err("an unknown kind of job".to_owned()),
    })
}

/// The recipe turns the expression into 0.
fn vanishes(expr: &Ex, recipe: &str) -> bool {
    let reduced = match recipe {
        "equals" => return expr.equals(&(expr - &expr.clone())) == Some(true),
        "expand" => expr.expand(),
        "ratsimp" | "by hand" => expr.ratsimp(),
        "simplify" => expr.simplify(),
        "expand_trig" => expr.expand_trig().ratsimp().simplify_trig(),
        "exp" => expr.rewrite_as_exp().ratsimp(),
        _ => return false,
    };
    reduced.is_zero_structural()
}

/// The formulas of a job: symplex reads some names as constants, so every name gets a tail.
struct Reader {
    context: Context,
    names: BTreeMap<String, Ex>,
}

impl Reader {
    fn value(&self, text: &str) -> Result<Ex, String> {
        let mut tailed = String::new();
        let mut used = Vec::new();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
            let (word, after) = rest.split_at(if first.is_ascii_alphabetic() { length } else { 1 });
            tailed.push_str(word);
            if let Some(meaning) = self.names.get(word) {
                tailed.push_str("_q");
                used.push((self.context.symbol(&format!("{word}_q")), meaning));
            }
            rest = after;
        }
        let parsed = self.context.parse(&tailed).map_err(|error| error.to_string())?;
        let map: Vec<(&Ex, &Ex)> =
            used.iter().filter(|(symbol, meaning)| symbol != *meaning).map(|(s, m)| (s, *m)).collect();
        Ok(if map.is_empty() { parsed } else { parsed.subs_map(&map) })
    }
}

/// The rates of the transform less their known values, and identities as they are: all zero.
fn proof(job: &Value, how: &JobOptions) -> Result<Work, String> {
    let context = Context::new();
    let assumed: Vec<&str> = texts(job, "assume").collect();
    let mut reader = Reader { context, names: BTreeMap::new() };
    for name in texts(job, "symbols") {
        let sign = if assumed.contains(&name) { Assumption::Positive } else { Assumption::Real };
        let symbol = reader.context.symbol_with(&format!("{name}_q"), &[sign]).map_err(|error| error.to_string())?;
        reader.names.insert(name.to_owned(), symbol);
    }
    for (name, text) in pairs(job, "define") {
        let meaning = reader.value(text)?;
        reader.names.insert(name.to_owned(), meaning);
    }
    let named = |(name, text): (&str, &str)| Ok::<_, String>((reader.names[name].clone(), reader.value(text)?));
    let both = |(phi, side): (&str, &str)| Ok::<_, String>((reader.value(phi)?, reader.value(side)?));
    let identities = texts(job, "zero").map(|text| reader.value(text)).collect::<Result<Vec<_>, _>>()?;
    let rates = entries(job, "rates").map(named).collect::<Result<Vec<_>, _>>()?;
    let claims = pairs(job, "claims").map(both).collect::<Result<Vec<_>, _>>()?;
    let replaced = pairs(job, "replace").map(named).collect::<Result<Vec<_>, _>>()?;
    let derived = move || {
        let rate = |(phi, side): &(Ex, Ex)| rates.iter().fold(-side, |sum, (state, rate)| sum + phi.diff(state) * rate);
        let mut residuals: Vec<Ex> = identities.iter().cloned().chain(claims.iter().map(rate)).collect();
        // One after the other: the value of one symbol holds others that are replaced in turn.
        for (symbol, value) in &replaced {
            for residual in &mut residuals {
                *residual = residual.subs(symbol, value);
            }
        }
        residuals
    };
    let found = how.alone.then(&derived);
    let recipe = how.recipe.clone();
    Ok(Box::new(move || {
        let residuals = found.unwrap_or_else(derived);
        let proved = residuals.iter().all(|residual| vanishes(residual, &recipe));
        Box::new(move || if proved { Ok(()) } else { Err("finds no proof".to_owned()) })
    }))
}

fn poly(job: &Value, key: &str) -> Result<Poly, String> {
    let variables = usize::try_from(number(job, "variables")?).map_err(|error| error.to_string())?;
    let term = |(coefficient, exponents)| (exponents, Ratio::from_integer(BigInt::from(coefficient)));
    Poly::from_terms(variables, terms(&job[key]).into_iter().map(term).collect()).ok_or_else(|| "terms".to_owned())
}

fn product(job: &Value) -> Result<Work, String> {
    let (a, b) = if job["base"].is_array() {
        let power = u32::try_from(number(job, "power")?).map_err(|error| error.to_string())?;
        let a = poly(job, "base")?.pow(power);
        let b = a.add(&Poly::from_int(3, 1));
        (a, b)
    } else {
        (poly(job, "a")?, poly(job, "b")?)
    };
    let (count, sum) = (number(job, "terms")?, job["sum"].as_str().map(str::to_owned));
    Ok(Box::new(move || {
        let product = a.mul(&b);
        Box::new(move || {
            let total: Ratio<BigInt> = product.terms().map(|(_, coefficient)| coefficient).sum();
            let right =
                u64::try_from(product.num_terms()) == Ok(count) && Some(total.to_string().as_str()) == sum.as_deref();
            if right { Ok(()) } else { Err("WRONG".to_owned()) }
        })
    }))
}

fn gcd(job: &Value) -> Result<Work, String> {
    let (a, b, known) = (poly(job, "a")?, poly(job, "b")?, poly(job, "gcd")?);
    Ok(Box::new(move || {
        let found = Poly::gcd(&a, &b);
        Box::new(move || if found == known || found == known.neg() { Ok(()) } else { Err("WRONG".to_owned()) })
    }))
}
