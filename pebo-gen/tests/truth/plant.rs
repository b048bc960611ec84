//! A model file for evaluation in floating point: its own formulas, read by [`super::formula`].

use std::collections::BTreeMap;

use pebo_gen::model::Model;
use pebo_gen::source::{Source, Span};

use super::draw::Draw;
use super::formula::{Comparison, Formula, Values};

/// A plant as written.
pub(crate) struct Plant {
    pub(crate) y: Vec<String>,
    pub(crate) phi: Vec<Formula>,
    pub(crate) rates: BTreeMap<String, Formula>,
    pub(crate) periods: BTreeMap<String, Formula>,
    free: Vec<String>,
    parameters: Vec<(String, Option<f64>)>,
    define: Vec<(String, Formula)>,
    assume: Vec<Comparison>,
    identities: Vec<Formula>,
}

/// Steps of Newton's method toward an identity.
const STEPS: usize = 30;

impl Plant {
    /// The plant of a model that was read; none of one that is written by class.
    pub(crate) fn read(source: &Source, model: &Model) -> Option<Self> {
        if model.class.is_some() {
            return None;
        }
        let text = |span: Span| &source.text()[span.range()];
        let formula = |formula: &pebo_gen::model::Formula| Formula::read(text(formula.span));
        let names = |list: &[pebo_gen::model::Spanned<String>]| list.iter().map(|name| name.value.clone()).collect();
        let entries = |list: &[pebo_gen::model::Entry<pebo_gen::model::Formula>]| {
            list.iter().map(|entry| (entry.name.value.clone(), formula(&entry.value))).collect::<Vec<_>>()
        };
        let (x, y): (Vec<String>, Vec<String>) = (names(&model.x), names(&model.y));
        let (u, w): (Vec<String>, Vec<String>) = (names(&model.u), names(&model.w));
        let number = |span: Span| text(span).trim_matches(['"', '\'']).parse::<f64>().expect("a number");
        Some(Self {
            free: [&x, &y, &u, &w].into_iter().flatten().cloned().collect(),
            rates: entries(&model.f_x).into_iter().chain(entries(&model.f_y)).collect(),
            phi: model.phi.iter().map(formula).collect(),
            periods: entries(&model.angles).into_iter().collect(),
            parameters: model
                .parameters
                .iter()
                .map(|entry| (entry.name.value.clone(), entry.value.as_ref().map(|value| number(value.span))))
                .collect(),
            define: entries(&model.define),
            assume: model.assume.iter().map(|comparison| Comparison::read(text(comparison.span))).collect(),
            identities: model.identities.iter().map(formula).collect(),
            y,
        })
    }

    /// A point of the domain, with the rates of the states and outputs as slopes; none if the draw falls outside.
    ///
    /// Given parameters keep their sign; zero remains zero.
    pub(crate) fn point(&self, draw: &mut Draw) -> Option<Values> {
        let mut values = Values::new();
        for (name, given) in &self.parameters {
            let value = match given {
                Some(value) if draw.one_in(2) => *value,
                Some(value) => value * (0.25 + 2.0 * draw.unit()),
                None => draw.value(),
            };
            values.insert(name.clone(), (value, 0.0));
        }
        let mut last = 0.0;
        for name in &self.free {
            // Now and then two signals are equal, to detect divisions by their difference.
            let value = if draw.one_in(8) { last } else { draw.value() };
            last = value;
            values.insert(name.clone(), (value, 0.0));
        }
        if !self.onto_identities(&mut values, draw) {
            return None;
        }
        self.settle(&mut values);
        if !self.assume.iter().all(|comparison| comparison.holds(&values)) || !self.is_regular(&values) {
            return None;
        }
        let rates: Vec<(String, f64)> =
            self.rates.iter().map(|(name, rate)| (name.clone(), rate.at(&values).value)).collect();
        for (name, rate) in rates {
            values.entry(name).and_modify(|entry| entry.1 = rate);
        }
        self.settle(&mut values);
        Some(values)
    }

    /// The assumptions on the given values alone hold.
    pub(crate) fn admits(&self, values: &Values) -> bool {
        let known = |comparison: &&Comparison| comparison.names().iter().all(|name| values.contains_key(name));
        self.assume.iter().filter(known).all(|comparison| comparison.holds(values))
    }

    /// The definitions at the other values, in whatever order they stand.
    fn settle(&self, values: &mut Values) {
        for (name, _) in &self.define {
            values.remove(name);
        }
        for _ in 0..self.define.len() {
            for (name, formula) in &self.define {
                if !values.contains_key(name) && formula.names().iter().all(|n| values.contains_key(n)) {
                    let value = formula.at(values);
                    values.insert(name.clone(), (value.value, value.slope));
                }
            }
        }
    }

    /// Moves one name of each identity until it holds; not if there is none that does it.
    fn onto_identities(&self, values: &mut Values, draw: &mut Draw) -> bool {
        for identity in &self.identities {
            let names: Vec<String> = identity.names().into_iter().filter(|name| self.free.contains(name)).collect();
            let Some(name) = names.get(draw.below(names.len().max(1))) else { return false };
            for _ in 0..STEPS {
                let at = values[name].0;
                values.insert(name.clone(), (at, 1.0));
                let miss = identity.at(values);
                values.insert(name.clone(), (at - miss.value / miss.slope, 0.0));
            }
            self.settle(values);
            let miss = identity.at(values);
            if !values[name].0.is_finite() || miss.value.abs() > 1e-12 * miss.size.max(1.0) {
                return false;
            }
        }
        // The last change may have left an earlier identity.
        self.identities.iter().all(|identity| {
            let miss = identity.at(values);
            miss.value.abs() <= 1e-9 * miss.size.max(1.0)
        })
    }

    /// The plant's formulas and the transform have values and derivatives there.
    fn is_regular(&self, values: &Values) -> bool {
        let formulas = || self.rates.values().chain(&self.phi);
        self.free.iter().all(|name| {
            let mut moved = values.clone();
            moved.entry(name.clone()).and_modify(|entry| entry.1 = 1.0);
            self.settle(&mut moved);
            formulas().all(|formula| {
                let found = formula.at(&moved);
                // Near the limits of floating point nothing is asserted.
                found.value.is_finite() && found.slope.is_finite() && found.size < 1e12
            })
        })
    }
}
