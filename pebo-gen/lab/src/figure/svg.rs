//! The elements of the drawing as SVG text.

use super::label::{Height, Label};
use super::page::TEXT;

/// A position or a size.
pub(super) type Point = (f64, f64);

/// The end of a text that is at its position.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Letters of an index, relative to those of the line.
const INDEX: f64 = 0.72;

/// A drawing, element after element.
#[derive(Debug)]
pub(super) struct Drawing {
    elements: String,
}

impl Drawing {
    pub(super) fn new() -> Self {
        Self { elements: String::new() }
    }

    /// The whole drawing, on white, so that it can be read on a dark page too.
    pub(super) fn finish(self, (width, height): Point, title: &str) -> String {
        let (width, height, title) = (number(width), number(height), escaped(title));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', \
             sans-serif\" font-size=\"{TEXT}\">\n<title>{title}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            self.elements
        )
    }

    pub(super) fn grid_line(&mut self, from: Point, to: Point) {
        let (x1, y1, x2, y2) = (number(from.0), number(from.1), number(to.0), number(to.1));
        self.push(&format!("<path d=\"M{x1} {y1}L{x2} {y2}\" stroke=\"#d9d9d9\" stroke-width=\"0.6\"/>"));
    }

    pub(super) fn frame(&mut self, (x, y): Point, (width, height): Point) {
        let (x, y, width, height) = (number(x), number(y), number(width), number(height));
        self.push(&format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#333\" \
             stroke-width=\"0.8\"/>"
        ));
    }

    /// A line in parts, with gaps between them; an empty dash pattern is a solid line.
    pub(super) fn line(&mut self, parts: &[Vec<Point>], (colour, dashes): (&str, &str)) {
        let mut path = String::new();
        for part in parts {
            for (index, (x, y)) in part.iter().enumerate() {
                let command = if index == 0 { 'M' } else { 'L' };
                path.push(command);
                path.push_str(&number(*x));
                path.push(' ');
                path.push_str(&number(*y));
            }
        }
        let dashes = if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") };
        self.push(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\" stroke-linejoin=\"round\"{dashes}/>"
        ));
    }

    /// The area within an edge, lightly filled so that lines below remain visible.
    pub(super) fn area(&mut self, edge: &[Point], colour: &str) {
        let mut path = String::new();
        for (index, (x, y)) in edge.iter().enumerate() {
            path.push(if index == 0 { 'M' } else { 'L' });
            path.push_str(&number(*x));
            path.push(' ');
            path.push_str(&number(*y));
        }
        if !path.is_empty() {
            self.push(&format!("<path d=\"{path}Z\" fill=\"{colour}\" fill-opacity=\"0.18\" stroke=\"none\"/>"));
        }
    }

    pub(super) fn label(&mut self, (x, y): Point, anchor: Anchor, size: f64, label: &Label) {
        // CairoSVG anchors each piece by itself, one over the other: the start of a label with several follows from its
        // width.
        let (x, anchor) = match anchor {
            Anchor::Middle if label.runs.len() > 1 => (x - width(label, size) / 2.0, Anchor::Start),
            Anchor::End if label.runs.len() > 1 => (x - width(label, size), Anchor::Start),
            anchor => (x, anchor),
        };
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let larger = if size > TEXT { format!(" font-size=\"{size}\"") } else { String::new() };
        let mut text = format!("<text x=\"{}\" y=\"{}\"{anchor}{larger}>", number(x), number(y));
        // `dy` moves all that follows: each piece undoes the one before.
        let mut before = Height::Line;
        // XML drops spaces at the ends of an element, and some readers others there too: they become distances.
        let mut distance = 0.0;
        for run in &label.runs {
            let inner = run.text.trim_matches(' ');
            distance += spaces(&run.text, run.text.trim_start_matches(' ')) * size;
            let mut attributes = String::new();
            if distance > 0.0 {
                attributes.push_str(&attribute("dx", distance));
            }
            distance = spaces(&run.text, run.text.trim_end_matches(' ')) * size;
            if run.height != before {
                attributes.push_str(&attribute("dy", (rise(before) - rise(run.height)) * size));
            }
            if run.height != Height::Line {
                attributes.push_str(&attribute("font-size", INDEX * size));
            }
            if run.italic {
                attributes.push_str(" font-style=\"italic\"");
            }
            before = run.height;
            let content = escaped(inner);
            if attributes.is_empty() {
                text.push_str(&content);
            } else {
                text.extend(["<tspan", &attributes, ">", &content, "</tspan>"]);
            }
        }
        text.push_str("</text>");
        self.push(&text);
    }

    fn push(&mut self, element: &str) {
        self.elements.push_str(element);
        self.elements.push('\n');
    }
}

/// The rise of a piece above the line, in the size of the letters.
fn rise(height: Height) -> f64 {
    match height {
        Height::Line => 0.0,
        Height::Below => -0.22,
        Height::Above => 0.36,
    }
}

fn attribute(name: &str, value: f64) -> String {
    format!(" {name}=\"{}\"", number(value))
}

/// The width of a space in the size of the letters.
const SPACE: f64 = 0.28;

/// The width of the spaces by which a text is longer than its rest.
fn spaces(text: &str, rest: &str) -> f64 {
    (rest.len()..text.len()).fold(0.0, |width, _| width + SPACE)
}

/// The width of a label where it is drawn in the widest of the fonts that are asked for, `DejaVu Sans`: nothing is cut
/// or overlaps in any of them.
pub(super) fn width(label: &Label, size: f64) -> f64 {
    let em = |character: char| match character {
        '\u{302}' => 0.0,
        '\u{2009}' => 0.2,
        'i' | 'j' | 'l' | 'I' | 'î' | 'ĵ' | '\'' => 0.29,
        '.' | ',' | '·' | ' ' | ':' | ';' | '/' | '|' | '\\' | 'f' => 0.36,
        'r' | 't' | '(' | ')' | '[' | ']' | '!' | '-' | '²' | '³' => 0.42,
        'J' | '_' | '*' | '°' => 0.5,
        '+' | '−' | '=' | '<' | '>' | '~' | '^' | '#' | '×' | 'w' | 'ω' | 'M' => 0.87,
        'm' | 'W' | '%' | '@' => 1.03,
        'A'..='Z' | '&' => 0.8,
        // From Korean and Chinese on letters are as wide as high.
        '\u{1100}'.. => 1.0,
        _ => 0.65,
    };
    let run = |run: &crate::figure::label::Piece| {
        let scale = if run.height == Height::Line { size } else { INDEX * size };
        run.text.chars().map(em).sum::<f64>() * scale
    };
    label.runs.iter().map(run).sum()
}

/// A coordinate to the hundredth, without needless zeros.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A text without the characters that are special in XML, or that XML cannot hold.
fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => result.push_str("&amp;"),
            '<' => result.push_str("&lt;"),
            '>' => result.push_str("&gt;"),
            character if character.is_control() || matches!(character, '\u{fffe}' | '\u{ffff}') => result.push(' '),
            character => result.push(character),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The advances of `DejaVu Sans` from the space to the tilde, in hundredths of the size.
    const DEJAVU: [u8; 95] = [
        32, 40, 46, 84, 64, 95, 78, 27, 39, 39, 50, 84, 32, 36, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64, 64, 64, 34, 34,
        84, 84, 84, 53, 100, 68, 69, 70, 77, 63, 58, 77, 75, 29, 29, 66, 56, 86, 75, 79, 60, 79, 69, 63, 61, 73, 68,
        99, 69, 61, 69, 39, 34, 39, 84, 50, 50, 61, 63, 55, 63, 62, 35, 63, 63, 28, 28, 58, 28, 97, 63, 61, 63, 63, 41,
        52, 39, 63, 59, 82, 59, 59, 52, 64, 34, 64, 84,
    ];

    #[test]
    fn no_letter_is_wider_than_it_is_taken_to_be() {
        for (letter, advance) in (b' '..=b'~').map(char::from).zip(DEJAVU) {
            let taken = width(&Label::text(&letter.to_string()), 100.0);
            let real = f64::from(advance);
            // A third too wide at most but for a few, so that pages are not too wide either.
            assert!(real <= taken + 1e-9 && taken <= real * 1.33 + 20.0, "{letter}: {taken} for {real}");
        }
    }
}
