//! A model file by class with another transform: a frame T, or the factors T1 and T2.
//!
//! In: the lines, and the matrices of the transform. Out: the lines with these among the keys of the class; all else is
//! as it was.

use std::ops::Range;

use pebo_design::model::Class;
use pebo_design::search::Block;

/// The class has a transform of its author's.
pub(super) fn is_given(class: &Class) -> bool {
    match class {
        Class::Lti(lti) => lti.t1.is_some(),
        Class::Mechanical(mechanical) => mechanical.t.is_some(),
        Class::Electromechanical(_) => false,
    }
}

/// Writes the blocks among the lines of the class's key: into its braces, or as lines of their own.
pub(super) fn insert(lines: &mut [String], section: Range<usize>, blocks: &[Block]) -> Option<()> {
    let texts = blocks.iter().map(|(key, rows)| {
        let row = |row: &Vec<String>| format!("[{}]", row.iter().map(|e| quoted(e)).collect::<Vec<_>>().join(", "));
        format!("{key}: [{}]", rows.iter().map(row).collect::<Vec<_>>().join(", "))
    });
    let texts: Vec<String> = texts.collect();
    let content = |line: &String| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    if let Some((line, place)) = end_of_braces(&lines[section.clone()]) {
        lines[section.start + line].insert_str(place, &format!(", {}", texts.join(", ")));
        return Some(());
    }
    let first = (section.start + 1..section.end).find(|index| content(&lines[*index]))?;
    let depth = |line: &String| line.len() - line.trim_start().len();
    let indent = depth(&lines[first]);
    // The lines of blocks that are there already.
    let mut old = false;
    for line in &mut lines[first..section.end] {
        if content(line) && depth(line) <= indent {
            old = blocks.iter().any(|(key, _)| line.trim_start().starts_with(&format!("{key}:")));
        }
        if old && content(line) {
            line.clear();
        }
    }
    let last = (first..section.end).rev().find(|index| content(&lines[*index]))?;
    let written = texts.iter().map(|text| format!("{}{text}\n", " ".repeat(indent)));
    lines[last].push_str(&written.collect::<String>());
    Some(())
}

/// The end, as line and column, of braces that begin on the first line; none if there are none.
fn end_of_braces(lines: &[String]) -> Option<(usize, usize)> {
    let (mut depth, mut within) = (0, None);
    for (index, line) in lines.iter().enumerate() {
        let mut before = ' ';
        for (place, c) in line.char_indices() {
            match c {
                _ if within.is_some() => within = within.filter(|mark| *mark != c),
                '"' | '\'' if depth > 0 => within = Some(c),
                '#' if before.is_whitespace() => break,
                '{' => depth += 1,
                '}' if depth == 1 => return Some((index, place)),
                '}' => depth -= 1,
                _ => {}
            }
            before = c;
        }
        if depth == 0 {
            return None;
        }
    }
    None
}

/// A formula as an entry of a list in brackets: in quotes unless it is plain.
pub(super) fn quoted(formula: &str) -> String {
    let plain = formula.starts_with(|c: char| c.is_ascii_alphanumeric())
        && formula.chars().all(|c| c.is_ascii_alphanumeric() || "_+-*/^() .".contains(c));
    if plain { formula.to_owned() } else { format!("\"{formula}\"") }
}
