//! Values with notations of their own.

use super::key::Shape;
use super::read::{Read, Reader};
use super::tree::{Content, Node};
use super::words::is_empty;
use crate::model::class::Matrix;
use crate::model::delay::Delay;
use crate::model::formula::Formula;
use crate::model::recording::Recording;
use crate::model::simulation::{Baseline, Equations, Kalman, Luenberger, Piece};
use crate::model::spanned::Entry;
use crate::source::{Code, Diagnostic};

/// A number for all names, or a map from names to numbers.
impl Read for Delay {
    const SHAPE: Shape = Shape::AllOrEach;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => Some(Self { all: Some(reader.number(text, node.span)?), each: Vec::new() }),
            Content::Map(_) => Some(Self { all: None, each: Vec::read(node, &Shape::Map(&Shape::Number), reader)? }),
            _ => reader.refuse(node, shape),
        }
    }
}

/// A formula, or a map from start times to formulas.
impl Read for Vec<Piece> {
    const SHAPE: Shape = Shape::Signal;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => {
                let formula = reader.formula(text, node.span);
                Some(vec![Piece { from: reader.number("0", node.span)?, formula }])
            }
            Content::Map(entries) => {
                let pieces = entries.iter().filter_map(|(key, node)| {
                    let from = reader.number(&key.text, key.span)?;
                    Some(Piece { from, formula: Formula::read(node, &Shape::Formula, reader)? })
                });
                Some(pieces.collect())
            }
            _ => reader.refuse(node, shape),
        }
    }
}

/// Baselines of the kinds that their names say.
impl Read for Vec<Entry<Baseline>> {
    const SHAPE: Shape = Shape::Kinds(Baseline::KEYS, &Equations::SHAPE);

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        let Content::Map(entries) = &node.content else { return reader.refuse(node, shape) };
        Some(reader.entries(entries, |name, node, reader| match name {
            Baseline::KALMAN => Kalman::read(node, &Kalman::SHAPE, reader).map(Baseline::Kalman),
            Baseline::EXTENDED => Kalman::read(node, &Kalman::SHAPE, reader).map(Baseline::Extended),
            Baseline::LUENBERGER => Luenberger::read(node, &Luenberger::SHAPE, reader).map(Baseline::Luenberger),
            _ => Equations::read(node, &Equations::SHAPE, reader).map(Baseline::Equations),
        }))
    }
}

/// Formulas for signals, and for the time of rows.
impl Read for Recording {
    const SHAPE: Shape = Shape::Kinds(Self::KEYS, &Shape::Formula);

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        let Content::Map(_) = &node.content else { return reader.refuse(node, shape) };
        Vec::read(node, &Shape::Map(&Shape::Formula), reader).map(Self::of)
    }
}

/// Rows of formulas, or a plain list, or a single one; the meaning of these depends on the size that is wanted.
impl Read for Matrix {
    const SHAPE: Shape = Shape::Matrix;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Scalar(text) => {
                Some(Self { span: node.span, depth: 0, rows: vec![vec![reader.formula(text, node.span)]] })
            }
            Content::List(items) => matrix(node, items, reader),
            _ => reader.refuse(node, shape),
        }
    }
}

/// A list of formulas, or a list of rows; all rows of one length.
fn matrix<'a>(node: &'a Node, items: &'a [Node], reader: &mut Reader<'a>) -> Option<Matrix> {
    if items.is_empty() || items.iter().any(is_empty) {
        reader.diagnostics.push(
            Diagnostic::error(Code::EmptyList, node.span, "a matrix has at least one entry")
                .help(format!("write for example `{}`", reader.example)),
        );
        return None;
    }
    let formulas = |items: &'a [Node], reader: &mut Reader<'a>| {
        items.iter().filter_map(|item| Formula::read(item, &Shape::Formula, reader)).collect::<Vec<_>>()
    };
    if !items.iter().any(|item| matches!(item.content, Content::List(_))) {
        return Some(Matrix { span: node.span, depth: 1, rows: vec![formulas(items, reader)] });
    }
    let mut rows: Vec<Vec<Formula>> = Vec::new();
    for item in items {
        let Content::List(entries) = &item.content else {
            return reader.refuse(item, &Shape::List(&Shape::Formula));
        };
        let first = rows.first().map_or(entries.len(), Vec::len);
        if entries.len() != first {
            let message = format!("a row of {} in a matrix with rows of {first}", entries.len());
            reader.diagnostics.push(
                Diagnostic::error(Code::WrongShape, item.span, message)
                    .help(format!("write {first} formulas in each row, as `{}`", reader.example)),
            );
            return None;
        }
        rows.push(formulas(entries, reader));
    }
    Some(Matrix { span: node.span, depth: 2, rows })
}
