//! Names that are nearly right, and texts quoted in messages.

/// Longer names are not compared: nobody misspells them, and hostile input may be full of them.
const LONGEST: usize = 48;

/// The candidate nearest to `name`, if one is near enough to be a slip of the pen.
///
/// Near enough is one edit (insertion, deletion, replacement, exchange of neighbours) per three
/// characters, at least one; a difference in case alone counts as one edit. Of equals, the first
/// wins.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST {
        return None;
    }
    let allowed = (name.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST && *candidate != name)
        .map(|candidate| (distance(name, candidate), candidate))
        // Two one-letter names differ by one edit and have nothing to do with each other.
        .filter(|(edits, candidate)| *edits <= allowed && *edits < candidate.chars().count().max(2))
        .filter(|(_, candidate)| candidate.len() > 1 || candidate.eq_ignore_ascii_case(name) || name.len() > 1)
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

/// A count and its noun, whose plural takes an `s`.
pub fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// Edit distance with exchanges of neighbours (optimal string alignment).
fn distance(left: &str, right: &str) -> usize {
    if left.eq_ignore_ascii_case(right) {
        return usize::from(left != right);
    }
    let (left, right): (Vec<char>, Vec<char>) = (left.chars().collect(), right.chars().collect());
    let mut rows = vec![(0..=right.len()).collect::<Vec<usize>>()];
    for (i, a) in left.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, b) in right.iter().enumerate() {
            let mut edits = (rows[i][j] + usize::from(a != b)).min(rows[i][j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *a == right[j - 1] && left[i - 1] == *b {
                edits = edits.min(rows[i - 1][j - 1] + 1);
            }
            row.push(edits);
        }
        rows.push(row);
    }
    rows[left.len()][right.len()]
}

/// A text of the author's for use inside a message: in backticks, on one line, cut when long.
pub fn quoted(text: &str) -> String {
    let mut printed: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    printed = printed.replace("\\'", "'").replace("\\\"", "\"");
    if text.chars().nth(LONGEST).is_some() {
        printed.push('…');
    }
    format!("`{printed}`")
}

/// Names in a row for use inside a message: quoted, with commas, the first three dozen of them.
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let mut printed: Vec<String> = names.by_ref().take(36).map(quoted).collect();
    if names.next().is_some() {
        printed.push("…".to_owned());
    }
    printed.join(", ")
}
