//! Circles of a graph: its strongly connected parts of more than one node.

use std::collections::{BTreeMap, BTreeSet};

/// The circles, each ascending, by their first node.
pub(super) fn circles(nodes: usize, arrows: &BTreeSet<(usize, usize)>) -> Vec<Vec<usize>> {
    let reached: Vec<BTreeSet<usize>> = (0..nodes).map(|node| reached(node, arrows)).collect();
    let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for node in 0..nodes {
        let first = reached[node].iter().copied().find(|other| reached[*other].contains(&node));
        if let Some(first) = first.filter(|first| *first <= node) {
            parts.entry(first).or_default().push(node);
        }
    }
    parts.into_values().filter(|part| part.len() > 1).collect()
}

/// The nodes to which arrows lead.
fn reached(from: usize, arrows: &BTreeSet<(usize, usize)>) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(node) = open.pop() {
        for (_, next) in arrows.range((node, 0)..=(node, usize::MAX)) {
            if found.insert(*next) {
                open.push(*next);
            }
        }
    }
    found
}
