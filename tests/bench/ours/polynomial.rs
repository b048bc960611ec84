//! Jobs about polynomials: products with a known number of terms, and known divisors.

use pebo_cas::Integer;
use pebo_cas::poly::{Monomial, Poly, TooLarge, Work as Limit};
use serde_json::Value;

use crate::protocol::{Work, number, terms};

/// A product, checked by its number of terms and the sum of its coefficients.
pub(crate) fn product(job: &Value) -> Result<Work, String> {
    let (a, b) = if job["base"].is_array() {
        let power = u32::try_from(number(job, "power")?).map_err(|error| error.to_string())?;
        let a = poly(job, "base")?.pow(power, &Limit::new(u64::MAX)).map_err(too_large)?;
        let b = &a + &Poly::one();
        (a, b)
    } else {
        (poly(job, "a")?, poly(job, "b")?)
    };
    let known = known(job)?;
    Ok(Box::new(move || {
        let product = a.mul(&b, &Limit::new(u64::MAX));
        Box::new(move || checked(product, &known))
    }))
}

/// A power, checked like a product.
pub(crate) fn power(job: &Value) -> Result<Work, String> {
    let (a, known) = (poly(job, "a")?, known(job)?);
    let exponent = u32::try_from(number(job, "power")?).map_err(|error| error.to_string())?;
    Ok(Box::new(move || {
        let power = a.pow(exponent, &Limit::new(u64::MAX));
        Box::new(move || checked(power, &known))
    }))
}

/// The square-free parts of `a b^2 c^3`, which are known up to their signs.
pub(crate) fn square_free(job: &Value) -> Result<Work, String> {
    let a = poly(job, "a")?;
    let parts = job["parts"].as_array().map(Vec::as_slice).unwrap_or_default();
    let parts: Vec<Poly> = parts.iter().map(of_terms).collect::<Result<_, _>>()?;
    Ok(Box::new(move || {
        let found = a.square_free(&Limit::new(u64::MAX));
        Box::new(move || {
            let found = found.map_err(too_large)?.factors;
            let is_known = |(factor, times): &(Poly, u32)| {
                let part = usize::try_from(*times).ok().and_then(|times| parts.get(times.checked_sub(1)?));
                part.is_some_and(|part| part == factor || *factor == -part)
            };
            let right = found.len() == parts.len() && found.iter().all(is_known);
            if right { Ok(()) } else { Err("WRONG".to_owned()) }
        })
    }))
}

/// The number of terms and the sum of coefficients.
fn known(job: &Value) -> Result<(u64, Option<Integer>), String> {
    Ok((number(job, "terms")?, job["sum"].as_str().and_then(Integer::from_digits)))
}

fn checked(found: Result<Poly, TooLarge>, (count, sum): &(u64, Option<Integer>)) -> Result<(), String> {
    let found = found.map_err(too_large)?;
    let mut total = Integer::ZERO;
    for (_, coefficient) in found.terms() {
        total += coefficient;
    }
    let right = u64::try_from(found.term_count()) == Ok(*count) && Some(total) == *sum;
    if right { Ok(()) } else { Err("WRONG".to_owned()) }
}

/// A greatest common divisor, which is known up to its sign.
pub(crate) fn gcd(job: &Value) -> Result<Work, String> {
    let (a, b, known) = (poly(job, "a")?, poly(job, "b")?, poly(job, "gcd")?);
    Ok(Box::new(move || {
        let found = a.gcd(&b, &Limit::new(u64::MAX));
        Box::new(move || {
            let found = found.map_err(too_large)?;
            if found == known || found == -&known { Ok(()) } else { Err("WRONG".to_owned()) }
        })
    }))
}

fn poly(job: &Value, key: &str) -> Result<Poly, String> {
    of_terms(&job[key])
}

fn of_terms(list: &Value) -> Result<Poly, String> {
    let term = |(coefficient, exponents): (i64, Vec<u32>)| (Monomial::new((0..).zip(exponents)), coefficient.into());
    Poly::from_terms(terms(list).into_iter().map(term)).map_err(too_large)
}

fn too_large(error: TooLarge) -> String {
    error.to_string()
}
