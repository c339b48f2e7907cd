//! Nearest point of the plane, by a balanced k-d tree in one array.
//!
//! A grid would be simpler, but embeddings squeeze parts of a mesh over ten decades: all of it would fall into a cell.

use glam::DVec2;

/// Points in the order of a balanced tree: the middle of a range is its root, its halves are the subtrees.
#[derive(Clone, Debug)]
pub(super) struct KdTree {
    points: Vec<DVec2>,
    numbers: Vec<u32>,
}

/// The nearest point of those that were looked at; before the first one, how far it may lie.
struct Nearest {
    place: Option<usize>,
    distance: f64,
}

impl KdTree {
    /// Takes O(n log n). Points that are not finite are left out.
    pub(super) fn new(points: &[DVec2]) -> Self {
        let mut entries: Vec<(DVec2, u32)> = points.iter().copied().zip(0..).filter(|(p, _)| p.is_finite()).collect();
        arrange(&mut entries, 0);
        Self { points: entries.iter().map(|e| e.0).collect(), numbers: entries.iter().map(|e| e.1).collect() }
    }

    /// Number and distance of the point nearest to `query`, no farther than `radius`.
    pub(super) fn nearest(&self, query: DVec2, radius: f64) -> Option<(u32, f64)> {
        let mut best = Nearest { place: None, distance: radius };
        self.search(0..self.points.len(), 0, query, &mut best);
        best.place.map(|place| (self.numbers[place], best.distance))
    }

    fn search(&self, range: std::ops::Range<usize>, axis: usize, query: DVec2, best: &mut Nearest) {
        if range.is_empty() {
            return;
        }
        let middle = range.start.midpoint(range.end);
        let distance = self.points[middle].distance(query);
        if distance <= best.distance && (best.place.is_none() || distance < best.distance) {
            *best = Nearest { place: Some(middle), distance };
        }
        let offset = query[axis] - self.points[middle][axis];
        let halves = [range.start..middle, middle + 1..range.end];
        let [near, far] = if offset < 0.0 { halves } else { [halves[1].clone(), halves[0].clone()] };
        self.search(near, 1 - axis, query, best);
        if offset.abs() <= best.distance {
            self.search(far, 1 - axis, query, best);
        }
    }
}

fn arrange(entries: &mut [(DVec2, u32)], axis: usize) {
    if entries.len() < 2 {
        return;
    }
    let middle = entries.len() / 2;
    entries.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (left, right) = entries.split_at_mut(middle);
    arrange(left, 1 - axis);
    arrange(&mut right[1..], 1 - axis);
}
