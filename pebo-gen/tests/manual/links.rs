//! Links between pages, and to their headings.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use super::page::{Page, files, root};

/// The targets of a page's links: files, headings, addresses.
fn links(text: &str) -> Vec<String> {
    let events = Parser::new_ext(text, Options::ENABLE_TABLES);
    let links = events.filter_map(|event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => Some(dest_url.to_string()),
        _ => None,
    });
    links.collect()
}

/// The files of the images that a page shows.
pub(super) fn images(page: &Page) -> Vec<PathBuf> {
    let events = Parser::new_ext(&page.text, Options::ENABLE_TABLES);
    let images = events.filter_map(|event| match event {
        Event::Start(Tag::Image { dest_url, .. }) => Some(page.path.with_file_name(dest_url.as_ref())),
        _ => None,
    });
    images.collect()
}

/// The commands on a model file that stand within its sentences.
pub(super) fn commands_in_sentences(page: &Page) -> Vec<String> {
    let events = Parser::new_ext(&page.text, Options::ENABLE_TABLES);
    let codes = events.filter_map(|event| if let Event::Code(code) = event { Some(code.to_string()) } else { None });
    codes.filter(|code| code.starts_with("pebo-gen ") && code.contains(".yaml")).collect()
}

/// The names by which its headings can be linked to, as code hosts and mdBook make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut heading: Option<String> = None;
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::Text(part) | Event::Code(part) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&part);
                }
            }
            Event::End(TagEnd::Heading(_)) => {
                let name = anchor(&heading.take().unwrap_or_default());
                let mut numbered = name.clone();
                let mut count = 0;
                while !found.insert(numbered.clone()) {
                    count += 1;
                    numbered = format!("{name}-{count}");
                }
            }
            _ => {}
        }
    }
    found
}

/// Letters in lower case, digits, `-` and `_`; a hyphen for a space.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>();
    kept.replace(' ', "-")
}

/// The broken links of a page at a path.
fn broken(path: &Path, text: &str) -> String {
    let mut wrong = String::new();
    for link in links(text) {
        // The web is not tested by this project.
        if link.starts_with("http://") || link.starts_with("https://") {
            continue;
        }
        let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
        let target = if file.is_empty() { path.to_owned() } else { path.with_file_name(file) };
        if !target.exists() {
            writeln!(wrong, "{}: no file for {link}", path.display()).expect("a string");
        } else if !heading.is_empty() && !anchors(&Page::read(target).text).contains(heading) {
            writeln!(wrong, "{}: no heading for {link}", path.display()).expect("a string");
        }
    }
    wrong
}

#[test]
fn every_link_leads_somewhere() {
    let pages = files(&root(), "md").into_iter().map(Page::read);
    let wrong: String = pages.map(|page| broken(&page.path, &page.text)).collect();
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_wrong_link_is_found() {
    let readme = root().join("README.md");
    let text = "# A `b` c-d, e\n\n[1](#a-b-c-d-e) [2](docs/architecture.md#crates-and-layers) [3](https://docs.rs)\n";
    assert_eq!(broken(&readme, &text.replace("[1](#a-b-c-d-e)", "")), "");
    let wrong = broken(&readme, "[1](docs/none.md) [2](docs/architecture.md#none) ![3](none.svg)\n");
    assert_eq!(wrong.lines().count(), 3, "{wrong}");
    assert!(anchors(text).contains("a-b-c-d-e"));
    assert_eq!(anchors("# a\n## a\n").into_iter().collect::<Vec<_>>(), ["a", "a-1"]);
}
