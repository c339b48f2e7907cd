//! Picking in the embedding's pane: the nearest point to the pointer, by a balanced k-d tree in one array.
//!
//! A grid would be simpler, but embeddings squeeze parts of a mesh over ten decades and would fill a single cell.

use glam::DVec2;

use super::{PICK_RADIUS, PlaneCamera, VertexPick};
use freebound_core::mesh::VertexId;

/// Picking in the embedding's pane. Built once per embedding. Points are stored in the order of a balanced tree: the
/// middle of a range is its root, its halves are the subtrees.
#[derive(Clone, Debug)]
pub struct PlanePicker {
    points: Vec<DVec2>,
    numbers: Vec<u32>,
}

/// Nearest point found so far; `distance` is the search radius until a point is found.
struct Nearest {
    place: Option<usize>,
    distance: f64,
}

impl PlanePicker {
    /// Prepares picking of the vertices of an embedding, in O(n log n). Points that are not finite are left out.
    pub fn new(embedding: &[DVec2]) -> Self {
        let mut entries: Vec<(DVec2, u32)> =
            embedding.iter().copied().zip(0..).filter(|(p, _)| p.is_finite()).collect();
        arrange(&mut entries, 0);
        Self { points: entries.iter().map(|e| e.0).collect(), numbers: entries.iter().map(|e| e.1).collect() }
    }

    /// Returns the vertex nearest to the pointer, within [`PICK_RADIUS`].
    pub fn nearest_vertex(&self, camera: &PlaneCamera, pane_size: DVec2, pointer: DVec2) -> Option<VertexPick> {
        let query = camera.embedding_from_pane(pointer, pane_size);
        let mut best = Nearest { place: None, distance: PICK_RADIUS / camera.points_per_unit() };
        self.search(0..self.points.len(), 0, query, &mut best);
        let vertex = VertexId::new(self.numbers[best.place?]);
        Some(VertexPick { vertex, distance_in_points: best.distance * camera.points_per_unit() })
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
