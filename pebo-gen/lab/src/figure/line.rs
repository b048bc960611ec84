//! Reduces a line with many points to one with few that looks the same.

/// An invisible distance: a fiftieth of a millimetre in print.
const UNSEEN: f64 = 0.06;

/// The points without those that lie on the line through the others (Douglas and Peucker 1973).
pub(super) fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut keep = vec![false; points.len()];
    if let (Some(first), Some(last)) = (keep.len().checked_sub(1).map(|_| 0), keep.len().checked_sub(1)) {
        keep[first] = true;
        keep[last] = true;
        let mut open = vec![(first, last)];
        while let Some((from, to)) = open.pop() {
            let inner = from + 1..to;
            let away = |at: &usize| distance(points[*at], points[from], points[to]);
            let Some(farthest) = inner.max_by(|a, b| away(a).total_cmp(&away(b))) else { continue };
            if away(&farthest) > UNSEEN {
                keep[farthest] = true;
                open.push((from, farthest));
                open.push((farthest, to));
            }
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// The distance of a point from the segment between two others.
fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (along, across) = (to.0 - from.0, to.1 - from.1);
    let length = along.hypot(across);
    let (dx, dy) = (point.0 - from.0, point.1 - from.1);
    if length == 0.0 {
        return dx.hypot(dy);
    }
    let part = ((dx * along + dy * across) / (length * length)).clamp(0.0, 1.0);
    (dx - part * along).hypot(dy - part * across)
}
