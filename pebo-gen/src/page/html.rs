//! HTML that is well-formed by construction: an element is closed where its content ends, and text is escaped.

use pebo_cas::print::mathml::escaped;

/// A page under construction.
#[derive(Debug, Default)]
pub(super) struct Html {
    text: String,
}

/// The attributes of an element.
type Attributes<'a> = &'a [(&'a str, &'a str)];

impl Html {
    /// An element with lines in it.
    pub(super) fn block(&mut self, tag: &str, attributes: Attributes<'_>, content: impl FnOnce(&mut Self)) {
        self.open(tag, attributes);
        self.text.push('\n');
        content(self);
        self.text.extend(["</", tag, ">\n"]);
    }

    /// A section with its heading.
    pub(super) fn section(&mut self, id: &str, heading: &str, content: impl FnOnce(&mut Self)) {
        self.block("section", &[("id", id)], |html| {
            html.line("h2", &[], |html| html.text(heading));
            content(html);
        });
    }

    /// An element on a line of its own.
    pub(super) fn line(&mut self, tag: &str, attributes: Attributes<'_>, content: impl FnOnce(&mut Self)) {
        self.within(tag, attributes, content);
        self.text.push('\n');
    }

    /// An element within a line.
    pub(super) fn within(&mut self, tag: &str, attributes: Attributes<'_>, content: impl FnOnce(&mut Self)) {
        self.open(tag, attributes);
        content(self);
        self.text.extend(["</", tag, ">"]);
    }

    /// An element that has no content.
    pub(super) fn void(&mut self, tag: &str, attributes: Attributes<'_>) {
        self.open(tag, attributes);
        self.text.truncate(self.text.len() - 1);
        self.text.push_str("/>\n");
    }

    fn open(&mut self, tag: &str, attributes: Attributes<'_>) {
        self.text.extend(["<", tag]);
        for (name, value) in attributes {
            self.text.extend([" ", name, "=\"", &escaped(value), "\""]);
        }
        self.text.push('>');
    }

    /// A text.
    pub(super) fn text(&mut self, text: &str) {
        self.text.push_str(&escaped(text));
    }

    /// A text in which backticks mark code.
    pub(super) fn prose(&mut self, text: &str) {
        for (index, part) in text.split('`').enumerate() {
            if index % 2 == 0 { self.text(part) } else { self.within("code", &[], |html| html.text(part)) }
        }
    }

    /// A paragraph in which backticks mark code.
    pub(super) fn paragraph(&mut self, text: &str) {
        self.line("p", &[], |html| html.prose(text));
    }

    /// Sentences as a list.
    pub(super) fn list<T: AsRef<str>>(&mut self, sentences: &[T]) {
        if !sentences.is_empty() {
            self.block("ul", &[], |html| {
                for text in sentences {
                    html.line("li", &[], |html| html.prose(text.as_ref()));
                }
            });
        }
    }

    /// A formula within a line, of elements of `MathML`.
    pub(super) fn formula(&mut self, elements: &str) {
        self.within("math", &[], |html| html.markup(elements));
    }

    /// A formula on lines of its own, which scroll if they are wider than the page.
    pub(super) fn display(&mut self, elements: &str) {
        self.line("div", &[("class", "wide")], |html| {
            html.within("math", &[("displaystyle", "true")], |html| html.markup(elements));
        });
    }

    /// Code, which scrolls if it is wider than the page.
    pub(super) fn code(&mut self, text: &str) {
        // The parser drops a line's end behind the tag.
        self.line("pre", &[("tabindex", "0")], |html| html.within("code", &[], |html| html.text(text)));
    }

    /// A table of numbers whose first column names its rows; it scrolls if it is wider than the page.
    pub(super) fn table(&mut self, caption: &str, columns: &[&str], rows: &[Vec<String>]) {
        self.block("div", &[("class", "wide")], |html| {
            html.block("table", &[("class", "numbers")], |html| {
                html.line("caption", &[], |html| html.prose(caption));
                html.block("thead", &[], |html| {
                    html.line("tr", &[], |html| {
                        for name in columns {
                            html.within("th", &[("scope", "col")], |html| html.prose(name));
                        }
                    });
                });
                html.block("tbody", &[], |html| {
                    for row in rows {
                        html.line("tr", &[], |html| {
                            for (index, cell) in row.iter().enumerate() {
                                match index {
                                    0 => html.within("th", &[("scope", "row")], |html| html.prose(cell)),
                                    _ => html.within("td", &[], |html| html.prose(cell)),
                                }
                            }
                        });
                    }
                });
            });
        });
    }

    /// Content that a reader may unfold.
    pub(super) fn folded(&mut self, summary: &str, content: impl FnOnce(&mut Self)) {
        self.block("details", &[], |html| {
            html.line("summary", &[], |html| html.prose(summary));
            content(html);
        });
    }

    /// Elements that were made by a writer of this crate.
    pub(super) fn markup(&mut self, elements: &str) {
        self.text.push_str(elements);
    }

    /// The text of the page.
    pub(super) fn finish(self) -> String {
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::Html;

    #[test]
    fn what_is_no_markup_is_escaped() {
        let mut html = Html::default();
        html.line("p", &[("title", "\"a\" & 'b'")], |html| html.prose("</p><script>`a<b`\u{0}"));
        let expected =
            "<p title=\"&quot;a&quot; &amp; &#39;b&#39;\">&lt;/p&gt;&lt;script&gt;<code>a&lt;b</code>\u{fffd}</p>\n";
        assert_eq!(html.finish(), expected);
    }
}
