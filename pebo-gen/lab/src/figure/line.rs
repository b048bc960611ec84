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

/// The parts of a line of points that lie between two heights, the upper one first: it ends where it crosses one.
pub(super) fn within(points: &[(f64, f64)], [top, bottom]: [f64; 2]) -> Vec<Vec<(f64, f64)>> {
    let is_inside = |point: &(f64, f64)| (top..=bottom).contains(&point.1);
    let mut parts = Vec::new();
    let mut part: Vec<(f64, f64)> = points.first().filter(|point| is_inside(point)).copied().into_iter().collect();
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let crossing = |height: f64| {
            let share = (height - from.1) / (to.1 - from.1);
            (0.0..=1.0).contains(&share).then_some((share, (from.0 + share * (to.0 - from.0), height)))
        };
        if !is_inside(&from) || !is_inside(&to) {
            let mut crossings: Vec<_> = [top, bottom].into_iter().filter_map(crossing).collect();
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            part.extend(crossings.into_iter().map(|(_, point)| point));
        }
        if is_inside(&to) {
            part.push(to);
        } else if !part.is_empty() {
            parts.push(std::mem::take(&mut part));
        }
    }
    parts.extend(Some(part).filter(|part| !part.is_empty()));
    parts
}

#[cfg(test)]
mod tests {
    use super::within;

    #[test]
    fn a_line_ends_where_it_leaves_the_frame() {
        let frame = [0.0, 10.0];
        let inside = [(0.0, 1.0), (1.0, 9.0)];
        assert_eq!(within(&inside, frame), [inside]);
        // Out above, through below and back.
        assert_eq!(
            within(&[(0.0, 5.0), (1.0, -5.0), (2.0, 15.0), (3.0, 5.0)], frame),
            [vec![(0.0, 5.0), (0.5, 0.0)], vec![(1.25, 0.0), (1.75, 10.0)], vec![(2.5, 10.0), (3.0, 5.0)]]
        );
        assert!(within(&[(0.0, 11.0), (1.0, 12.0)], frame).is_empty() && within(&[], frame).is_empty());
        assert_eq!(within(&[(0.0, 3.0)], frame), [[(0.0, 3.0)]]);
    }
}
