//! A model file with another transform.
//!
//! In: the text, and the plant with its transform. Out: the text with the components under `phi`, and without the left
//! inverse of another transform, or with the matrices of the transform under the key of its class; all else is as it
//! was. None where the result would not read as meant: the text is read again.

use pebo_design::analysis::AtEstimate;
use pebo_design::model::{Model, RegressionForm};
use pebo_design::plant::TransformOrigin;
use pebo_design::search::{self, Candidate};
use pebo_design::source::Source;

use super::framed::{self, quoted};

/// The text with this transform, and the form of its regression, where that is one that a given transform has to ask for.
pub(super) fn filled(source: &Source, model: &Model, candidate: &Candidate) -> Option<String> {
    let plant = &candidate.plant;
    // The author's own transform of the class is kept, and coils have none to write.
    let blocks = model.class.as_ref().and_then(|class| search::blocks(plant, class.name()));
    let written = blocks.is_none() || model.class.as_ref().is_some_and(framed::is_given);
    if plant.origin == TransformOrigin::Class && written {
        return Some(source.text().to_owned());
    }
    let mut lines: Vec<String> = source.text().split_inclusive('\n').map(str::to_owned).collect();
    if let Some(last) = lines.last_mut().filter(|last| !last.ends_with('\n')) {
        last.push('\n');
    }
    match &model.class {
        None => {
            let phi: Vec<String> = plant.transform().iter().map(|e| plant.arena.print(*e)).collect();
            with_components(&mut lines, &phi)?;
            if candidate.derivation.at_estimate() == Some(AtEstimate::Monotone) && model.regression_form.is_none() {
                let phi = section(&lines, "phi")?;
                lines.insert(phi.start, format!("regression: {}\n", RegressionForm::Monotone.name()));
            }
        }
        Some(class) => {
            let section = section(&lines, class.name())?;
            framed::insert(&mut lines, section, &blocks?)?;
        }
    }
    let text = lines.concat();
    let again = Model::parse(&Source::new(source.name(), text.as_str()).ok()?).ok()?;
    let components = if model.class.is_some() { 0 } else { plant.phi.len() };
    let same = again.phi.len() == components
        && again.class.as_ref().is_none_or(framed::is_given)
        && again.phi_left.is_empty()
        && (&again.name.value, again.declared().count(), again.f_x.len(), again.f_y.len())
            == (&model.name.value, model.declared().count(), model.f_x.len(), model.f_y.len());
    same.then_some(text)
}

/// Writes the components under `phi`, without the left inverse of another transform.
fn with_components(lines: &mut Vec<String>, phi: &[String]) -> Option<()> {
    let line = format!("phi: [{}]\n", phi.iter().map(|formula| quoted(formula)).collect::<Vec<_>>().join(", "));
    let old = section(lines, "phi");
    let place = match &old {
        Some(old) => old.start,
        // Behind the rates.
        None => ["f_x", "f_y", "g_y"].iter().filter_map(|key| Some(section(lines, key)?.end)).max()?,
    };
    if let Some(inverse) = section(lines, "phi_left") {
        lines[inverse].iter_mut().for_each(String::clear);
    }
    if let Some(old) = old {
        lines[old].iter_mut().for_each(String::clear);
    }
    lines.insert(place, line);
    Some(())
}

/// The lines of a key of the file, with those that are indented below it or continue a list.
fn section(lines: &[String], key: &str) -> Option<std::ops::Range<usize>> {
    let start = lines.iter().position(|line| line.strip_prefix(key).is_some_and(|rest| rest.starts_with(':')))?;
    let belongs = |line: &String| line.starts_with([' ', '\t', '-', ']', '}']);
    let mut end = start + 1;
    while lines.get(end).is_some_and(belongs) {
        end += 1;
    }
    Some(start..end)
}
