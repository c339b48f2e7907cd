//! Cutting of a surface along seams: listed edges, and edges whose two sides have different texture coordinates.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::sides::{Sides, ascending};
use super::{Repair, Repaired};
use crate::mesh::union::DisjointSets;
use crate::mesh::{PolygonMesh, VertexId};

/// Seams along which a surface is cut, beyond the cuts that make disks.
#[derive(Clone, Debug, Default)]
pub struct Seams {
    /// True to cut along the seams of the file's texture coordinates, if all corners have coordinates.
    pub of_texture: bool,
    /// Listed edges by the file's vertices, the smaller number first.
    edges: Arc<BTreeSet<[VertexId; 2]>>,
    /// Edges that an automatic cut opens, by the file's vertices, the smaller number first.
    automatic: Arc<BTreeSet<[VertexId; 2]>>,
    /// Bound on the mean symmetric Dirichlet energy for which the automatic seams were found.
    bound: Option<f64>,
    /// Cost of automatic seams relative to their length, by the file's vertices, the smaller number first. Default: 1.
    costs: Arc<BTreeMap<[VertexId; 2], f64>>,
}

impl PartialEq for Seams {
    fn eq(&self, other: &Self) -> bool {
        // Lists are often shared, and long.
        fn are_equal<T: PartialEq>(a: &Arc<T>, b: &Arc<T>) -> bool {
            Arc::ptr_eq(a, b) || a == b
        }
        self.of_texture == other.of_texture
            && self.bound == other.bound
            && are_equal(&self.edges, &other.edges)
            && are_equal(&self.automatic, &other.automatic)
            && are_equal(&self.costs, &other.costs)
    }
}

impl Seams {
    /// Cost of an edge that automatic seams avoid: they cross it only if no other cut makes a disk, or if the detour
    /// is a thousand times longer.
    pub const AVOIDED: f64 = 1000.0;

    /// Range of the cost of an edge.
    pub const COSTS: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

    /// Listed edges by the file's vertices, the smaller number first.
    pub fn edges(&self) -> &BTreeSet<[VertexId; 2]> {
        &self.edges
    }

    /// Edges that an automatic cut opens, by the file's vertices, the smaller number first.
    pub fn automatic(&self) -> &BTreeSet<[VertexId; 2]> {
        &self.automatic
    }

    /// Bound on the mean symmetric Dirichlet energy for which the automatic seams were found. `None` if there was no
    /// search.
    pub fn bound(&self) -> Option<f64> {
        self.bound
    }

    /// Replaces the edges that an automatic cut opens. `bound` is the bound on the mean symmetric Dirichlet energy for
    /// which they were found.
    #[must_use = "the seams themselves stay as they are"]
    pub fn with_automatic(&self, edges: impl IntoIterator<Item = [VertexId; 2]>, bound: f64) -> Self {
        Self { automatic: Arc::new(edges.into_iter().map(ascending).collect()), bound: Some(bound), ..self.clone() }
    }

    /// Removes the edges of an automatic cut.
    #[must_use = "the seams themselves stay as they are"]
    pub fn without_automatic(&self) -> Self {
        Self { automatic: Arc::default(), bound: None, ..self.clone() }
    }

    /// Seams with the bound of others.
    pub(super) fn bound_as(&self, other: &Self) -> Self {
        Self { bound: other.bound, ..self.clone() }
    }

    /// Seams that list the automatic edges too.
    #[must_use = "the seams themselves stay as they are"]
    pub fn all_listed(&self) -> Self {
        self.with(self.automatic.iter().copied()).without_automatic()
    }

    /// Costs of automatic seams relative to their length, by the file's vertices, the smaller number first. An edge
    /// that is not listed costs 1.
    pub fn costs(&self) -> &BTreeMap<[VertexId; 2], f64> {
        &self.costs
    }

    /// Sets the cost of edges. A cost of 1 removes the entry; others are clamped to [`COSTS`](Self::COSTS).
    #[must_use = "the seams themselves stay as they are"]
    pub fn with_costs(&self, costs: impl IntoIterator<Item = ([VertexId; 2], f64)>) -> Self {
        let mut all = BTreeMap::clone(&self.costs);
        for (edge, cost) in costs {
            let cost = cost.clamp(*Self::COSTS.start(), *Self::COSTS.end());
            if cost.to_bits() == 1.0_f64.to_bits() || cost.is_nan() {
                all.remove(&ascending(edge));
            } else {
                all.insert(ascending(edge), cost);
            }
        }
        Self { costs: Arc::new(all), ..self.clone() }
    }

    /// Adds edges to the list. Their ends may be in any order; edges with equal ends are ignored.
    #[must_use = "the seams themselves stay as they are"]
    pub fn with(&self, edges: impl IntoIterator<Item = [VertexId; 2]>) -> Self {
        let fresh = edges.into_iter().filter(|[a, b]| a != b).map(ascending);
        Self { edges: Arc::new(self.edges.iter().copied().chain(fresh).collect()), ..self.clone() }
    }

    /// Removes edges from the list.
    #[must_use = "the seams themselves stay as they are"]
    pub fn without(&self, edges: impl IntoIterator<Item = [VertexId; 2]>) -> Self {
        let gone: BTreeSet<[VertexId; 2]> = edges.into_iter().map(ascending).collect();
        Self { edges: Arc::new(self.edges.difference(&gone).copied().collect()), ..self.clone() }
    }

    /// Listed edges that no face of a mesh has, ascending.
    pub fn missing_in(&self, mesh: &PolygonMesh) -> Vec<[VertexId; 2]> {
        let mut missing = BTreeSet::clone(&self.edges);
        for face in (0..mesh.face_count()).take_while(|_| !self.edges.is_empty()) {
            let corners = mesh.face(face);
            for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                missing.remove(&ascending([a, b]));
            }
        }
        missing.into_iter().collect()
    }

    /// Replaces all costs by those of other seams.
    #[must_use = "the seams themselves stay as they are"]
    pub fn with_costs_of(&self, other: &Self) -> Self {
        Self { costs: Arc::clone(&other.costs), ..self.clone() }
    }

    /// Removes all costs.
    #[must_use = "the seams themselves stay as they are"]
    pub fn without_costs(&self) -> Self {
        Self { costs: Arc::default(), ..self.clone() }
    }

    /// True if no edge has a cost and there are no seams.
    pub fn is_default(&self) -> bool {
        self.is_empty() && self.bound.is_none() && self.costs.is_empty()
    }

    /// True if there are no seams.
    pub fn is_empty(&self) -> bool {
        !self.of_texture && self.edges.is_empty() && self.automatic.is_empty()
    }
}

impl Repaired {
    /// Cuts each edge that is listed or automatic, or whose faces have different labels at its ends.
    ///
    /// `labels` has one label per corner of the given mesh `source`. If several edges became one, any of them being
    /// listed is enough. A vertex stays whole if a seam ends there inside the surface, so a seam with a single edge
    /// opens nothing. Faces of a formerly one-sided surface are flipped if it has two sides now.
    pub(super) fn cut_along(&mut self, seams: &Seams, labels: Option<&[u32]>, source: &PolygonMesh) {
        if !self.is_sound() || (labels.is_none() && seams.edges.is_empty() && seams.automatic.is_empty()) {
            return;
        }
        let sides = Sides::new(&self.polygons);
        let of = |corner: u32| self.corner_of[corner as usize] as usize;
        let is_listed = |side: u32| seams.edges.contains(&sides.edge_in_file(self, source, side));
        let across =
            |on: &[u32]| -> Vec<[u32; 2]> { on.windows(2).flat_map(|pair| sides.across(pair[0], pair[1])).collect() };
        let is_alike =
            |on: &[u32]| labels.is_none_or(|labels| across(on).iter().all(|[a, b]| labels[of(*a)] == labels[of(*b)]));
        let is_automatic = |side: u32| seams.automatic.contains(&sides.edge_in_file(self, source, side));
        let is_wished = |on: &[u32]| !is_alike(on) || on.iter().any(|&side| is_listed(side));
        let is_whole = |on: &[u32]| on.len() == 1 || !(is_wished(on) || on.iter().any(|&side| is_automatic(side)));
        // The sides of each seam, and true if it was wished.
        let seam: Vec<(Vec<[u32; 2]>, bool)> =
            sides.table.edges().filter(|on| !is_whole(on)).map(|on| (across(on), is_wished(on))).collect();
        if !seam.is_empty() {
            let fans = self.with_touching(sides.fans(is_whole), &sides);
            let is_one_sided = sides.one_sided();
            self.split_into(fans);
            let corners = &self.polygons.corners;
            let is_open =
                |across: &Vec<[u32; 2]>| across.iter().any(|[a, b]| corners[*a as usize] != corners[*b as usize]);
            let count = |wished: bool| seam.iter().filter(|(across, is)| *is == wished && is_open(across)).count();
            let [wished, automatic] = [count(true), count(false)];
            self.note(Repair::CutSeams, wished);
            self.note(Repair::Cut, automatic);
            self.turn_faces_that_were(&is_one_sided);
        }
    }

    /// Joins fans that met only at a vertex before any cut, so that the cut does not split that vertex.
    fn with_touching(&self, mut fans: DisjointSets, sides: &Sides<'_>) -> DisjointSets {
        let mut first = vec![None; self.polygons.positions.len()];
        for corner in sides.fans(|_| true).roots() {
            let vertex = self.polygons.corners[corner as usize];
            fans.join(corner, *first[vertex.index()].get_or_insert(corner));
        }
        fans
    }
}
