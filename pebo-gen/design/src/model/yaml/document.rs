//! A model file with formulas still as text, as serde decodes it.
//!
//! The types mirror the key tables of [`schema`](super::schema); a test decodes a file that has
//! every key. Sections without formulas are the model's own types.

use serde::Deserialize;

use crate::model::class::{Electromechanical, Lti, Mechanical};
use crate::model::delay::Delay;
use crate::model::formula::Decimal;
use crate::model::observer::Observer;
use crate::model::spanned::{Entry, Spanned};
use crate::model::written::{CascadeClass, RegressionForm, Scale};

/// A text with its span: a name, a title, a formula.
pub(super) type Text = Spanned<String>;

/// The file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Document {
    pub(super) model: Option<Text>,
    pub(super) title: Option<Text>,
    pub(super) reference: Option<Text>,
    pub(super) parameters: Vec<Entry<Option<Spanned<Decimal>>>>,
    pub(super) x: Vec<Text>,
    pub(super) y: Vec<Text>,
    pub(super) u: Vec<Text>,
    pub(super) w: Vec<Text>,
    pub(super) class: Option<Spanned<CascadeClass>>,
    pub(super) regression: Option<Spanned<RegressionForm>>,
    pub(super) define: Vec<Entry<Definition>>,
    pub(super) assume: Vec<Text>,
    pub(super) f_x: Vec<Entry<Text>>,
    pub(super) f_y: Vec<Entry<Text>>,
    pub(super) g_y: Vec<Entry<Text>>,
    pub(super) phi: Vec<Text>,
    pub(super) phi_left: Vec<Entry<Text>>,
    pub(super) identities: Vec<Text>,
    pub(super) known: Vec<Entry<Text>>,
    pub(super) angles: Vec<Entry<Text>>,
    pub(super) units: Vec<Entry<Text>>,
    pub(super) observer: Observer,
    pub(super) simulation: Option<Simulation>,
    pub(super) recording: Option<Vec<Entry<Text>>>,
    pub(super) lti: Option<Lti<Text>>,
    pub(super) mechanical: Option<Mechanical<Text>>,
    pub(super) electromechanical: Option<Electromechanical<Text>>,
}

/// A formula, or a table.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum Definition {
    Formula(Text),
    Table(Curve),
}

/// A table; what is missing has its diagnostic.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Curve {
    pub(super) table: Option<Text>,
    pub(super) points: Vec<Vec<Spanned<Decimal>>>,
    pub(super) interpolation: Option<Text>,
}

/// The section `simulation`.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Simulation {
    pub(super) duration: Option<Spanned<Decimal>>,
    pub(super) step: Option<Spanned<Decimal>>,
    pub(super) initial: Vec<Entry<Text>>,
    pub(super) signals: Vec<Entry<Vec<Piece>>>,
    pub(super) noise: Vec<Entry<Spanned<Decimal>>>,
    pub(super) bias: Vec<Entry<Spanned<Decimal>>>,
    pub(super) quantisation: Vec<Entry<Spanned<Decimal>>>,
    pub(super) delay: Delay,
    pub(super) jitter: Option<Spanned<Decimal>>,
    pub(super) dropped: Option<Spanned<Decimal>>,
    pub(super) every: Vec<Entry<Spanned<Decimal>>>,
    pub(super) plant: Vec<Entry<Vec<Piece>>>,
    pub(super) define: Vec<Entry<Text>>,
    pub(super) control: Vec<Entry<Text>>,
    pub(super) feedback: Option<Text>,
    pub(super) baselines: Vec<Entry<Baseline>>,
    pub(super) panels: Vec<Panel>,
}

/// A piece of a signal.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Piece {
    pub(super) from: Spanned<Decimal>,
    pub(super) formula: Text,
}

/// An entry of `baselines`: its name says which of the keys it may have.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Baseline {
    pub(super) state: Vec<Entry<Text>>,
    pub(super) initial: Vec<Entry<Text>>,
    pub(super) estimate: Vec<Entry<Text>>,
    pub(super) poles: Vec<Spanned<Decimal>>,
    pub(super) sensors: Vec<Entry<Spanned<Decimal>>>,
    pub(super) start: Vec<Entry<Spanned<Decimal>>>,
    pub(super) disturbance: Vec<Entry<Spanned<Decimal>>>,
}

/// An entry of `panels`.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Panel {
    pub(super) title: Option<Text>,
    pub(super) unit: Option<Text>,
    pub(super) curves: Vec<Text>,
    pub(super) scale: Option<Spanned<Scale>>,
}
