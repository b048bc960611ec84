//! Values as literals of Python, laid out as its users do.

/// The width that a line keeps to where it can be divided.
const WIDTH: usize = 120;

/// A literal.
pub(super) enum Literal {
    None,
    Truth(bool),
    Text(String),
    List(Vec<Literal>),
    Dict(Vec<(String, Literal)>),
}

impl Literal {
    /// A text.
    pub(super) fn text(text: &(impl ToString + ?Sized)) -> Self {
        Self::Text(text.to_string())
    }

    /// A list of texts.
    pub(super) fn texts<T: ToString>(texts: impl IntoIterator<Item = T>) -> Self {
        Self::List(texts.into_iter().map(|text| Self::text(&text)).collect())
    }

    /// A dictionary of texts.
    pub(super) fn named<N: ToString, T: ToString>(entries: impl IntoIterator<Item = (N, T)>) -> Self {
        Self::Dict(entries.into_iter().map(|(name, text)| (name.to_string(), Self::text(&text))).collect())
    }

    /// It has no entries.
    pub(super) fn is_empty(&self) -> bool {
        match self {
            Self::None => true,
            Self::Truth(_) | Self::Text(_) => false,
            Self::List(items) => items.is_empty(),
            Self::Dict(entries) => entries.is_empty(),
        }
    }

    /// The literal, whose first line begins in this column and whose others are indented by so much.
    pub(super) fn layout(&self, column: usize, indent: usize) -> String {
        let line = self.line();
        if column + line.len() < WIDTH {
            return line;
        }
        let inner = indent + 4;
        let margin = " ".repeat(inner);
        let each = |text: String| format!("{margin}{text},\n");
        match self {
            Self::None | Self::Truth(_) | Self::Text(_) => line,
            Self::List(items) => {
                let lines: String = items.iter().map(|item| each(item.layout(inner, inner))).collect();
                format!("[\n{lines}{}]", " ".repeat(indent))
            }
            Self::Dict(entries) => {
                let entry = |(name, value): &(String, Self)| {
                    let key = format!("{}: ", quoted(name));
                    each(format!("{key}{}", value.layout(inner + key.len(), inner)))
                };
                let lines: String = entries.iter().map(entry).collect();
                format!("{{\n{lines}{}}}", " ".repeat(indent))
            }
        }
    }

    fn line(&self) -> String {
        match self {
            Self::None => "None".to_owned(),
            Self::Truth(truth) => if *truth { "True" } else { "False" }.to_owned(),
            Self::Text(text) => quoted(text),
            Self::List(items) => format!("[{}]", items.iter().map(Self::line).collect::<Vec<_>>().join(", ")),
            Self::Dict(entries) => {
                let entry = |(name, value): &(String, Self)| format!("{}: {}", quoted(name), value.line());
                format!("{{{}}}", entries.iter().map(entry).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

/// A text in quotes, as JSON and Python both write it.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_one_line_and_what_does_not_has_a_line_for_each_part() {
        let short = Literal::named([("a", "1/\"b\""), ("c", "d\n")]);
        assert_eq!(short.layout(0, 0), r#"{"a": "1/\"b\"", "c": "d\n"}"#);
        let long = Literal::Dict(vec![
            ("first".to_owned(), Literal::texts(["x".repeat(60), "y".repeat(60)])),
            ("second".to_owned(), Literal::None),
        ]);
        let expected = format!(
            "{{\n    \"first\": [\n        \"{}\",\n        \"{}\",\n    ],\n    \"second\": None,\n}}",
            "x".repeat(60),
            "y".repeat(60)
        );
        assert_eq!(long.layout(0, 0), expected);
    }
}
