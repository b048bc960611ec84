//! Text of the emitted documentation: names as code, lines of a bounded length.
//!
//! In: sentences, of ours and of the model's author. Out: lines that Markdown reads as they were meant.

/// A text as prose: one line, names as code, nothing that Markdown or rustdoc would read.
pub(in crate::emit) fn prose(text: &str) -> String {
    let words = text.split_whitespace().map(|word| {
        let camel = word.chars().zip(word.chars().skip(1)).any(|(a, b)| a.is_lowercase() && b.is_uppercase());
        let special = word.contains(['_', '[', ']', '<', '>', '*', '`', '|', '\\', '#', '&', '~', '$']);
        if camel || special || word.contains("::") { format!("`{}`", word.replace('`', "'")) } else { word.to_owned() }
    });
    words.collect::<Vec<String>>().join(" ")
}

/// A text as prose that ends as a sentence does.
pub(in crate::emit) fn sentence(text: &str) -> String {
    let prose = prose(text);
    if prose.ends_with(['.', '!', '?']) { prose } else { format!("{prose}.") }
}

/// The lines with those that are too long wrapped at words. Blocks of code and tables stay as they are.
pub(in crate::emit) fn wrapped(lines: Vec<String>, width: usize) -> Vec<String> {
    let mut in_code = false;
    let mut found = Vec::new();
    for line in lines {
        let fence = line.starts_with("```");
        in_code ^= fence;
        if in_code || fence || line.starts_with('|') || length(&line) <= width {
            found.push(line);
        } else {
            wrap(&line, width, &mut found);
        }
    }
    found
}

/// One line as several; those of an item of a list go on below its text.
fn wrap(line: &str, width: usize, found: &mut Vec<String>) {
    let text = line.trim_start();
    let margin = line.len() - text.len() + if text.starts_with("- ") { 2 } else { 0 };
    let mut current = String::from(&line[..line.len() - text.len()]);
    let mut is_empty = true;
    for word in words(text, width.saturating_sub(margin)) {
        if !is_empty && length(&current) + 1 + length(word) > width {
            found.push(std::mem::replace(&mut current, " ".repeat(margin)));
            is_empty = true;
        }
        if !is_empty {
            current.push(' ');
        }
        current.push_str(word);
        is_empty = false;
    }
    found.push(current);
}

/// The pieces between which a line may end: words, and code as a whole if it fits into a line.
fn words(text: &str, width: usize) -> impl Iterator<Item = &str> {
    pieces(text, true).into_iter().flat_map(
        move |piece| {
            if length(piece) <= width { vec![piece] } else { pieces(piece, false) }
        },
    )
}

/// The text cut at spaces, outside of code if that is kept whole. No piece begins as Markdown's lists, quotes, headings
/// and tables do.
fn pieces(text: &str, whole_code: bool) -> Vec<&str> {
    let (mut pieces, mut start, mut in_code) = (Vec::new(), 0, false);
    for (place, letter) in text.char_indices() {
        in_code ^= letter == '`';
        if letter != ' ' || (whole_code && in_code) {
            continue;
        }
        let marks = |next: char| "-+*=<>#|!/~".contains(next) || next.is_ascii_digit();
        if !text[place + 1..].starts_with(marks) {
            pieces.push(&text[start..place]);
            start = place + 1;
        }
    }
    pieces.push(&text[start..]);
    pieces
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// The heading of a section.
pub(in crate::emit) fn section(title: &str) -> Vec<String> {
    vec![String::new(), format!("# {title}"), String::new()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_wrapped_at_words_and_code_is_kept_together() {
        let wrap = |line: &str| wrapped(vec![line.to_owned()], 20);
        assert_eq!(wrap("short"), ["short"]);
        assert_eq!(wrap("one two three four five"), ["one two three four", "five"]);
        assert_eq!(wrap("- an item with a longer text"), ["- an item with a", "  longer text"]);
        assert_eq!(wrap("  its second line, too long"), ["  its second line,", "  too long"]);
        assert_eq!(wrap("only while `a = b + c` holds"), ["only while", "`a = b + c` holds"]);
    }

    #[test]
    fn code_longer_than_a_line_is_broken_behind_an_operator() {
        let long = wrapped(vec!["where `alpha + beta - gamma*delta != 0`".to_owned()], 20);
        assert_eq!(long, ["where `alpha +", "beta -", "gamma*delta != 0`"]);
    }

    #[test]
    fn blocks_and_tables_stay_as_they_are() {
        let lines = ["```text", "a = b + c + d + e + f + g + h", "```", "| a function | of which nothing is wrapped |"];
        assert_eq!(wrapped(lines.map(str::to_owned).to_vec(), 20), lines);
    }
}
