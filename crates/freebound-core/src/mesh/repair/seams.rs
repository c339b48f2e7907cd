//! Cutting of a surface along seams: listed edges, and edges whose two sides have different texture coordinates.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::sides::{Sides, ascending};
use super::{Repair, Repaired};
use crate::mesh::union::DisjointSets;
use crate::mesh::{PolygonMesh, VertexId};

/// Seams along which a surface is cut, beyond the cuts that make disks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Seams {
    /// True to cut along the seams of the file's texture coordinates, if all corners have coordinates.
    pub of_texture: bool,
    /// Listed edges by the file's vertices, the smaller number first.
    edges: Arc<BTreeSet<[VertexId; 2]>>,
    /// Edges that an automatic cut opens, by the file's vertices, the smaller number first.
    automatic: Arc<BTreeSet<[VertexId; 2]>>,
}

impl Seams {
    /// Listed edges by the file's vertices, the smaller number first.
    pub fn edges(&self) -> &BTreeSet<[VertexId; 2]> {
        &self.edges
    }

    /// Edges that an automatic cut opens, by the file's vertices, the smaller number first.
    pub fn automatic(&self) -> &BTreeSet<[VertexId; 2]> {
        &self.automatic
    }

    /// Replaces the edges that an automatic cut opens.
    #[must_use = "the seams themselves stay as they are"]
    pub fn with_automatic(&self, edges: impl IntoIterator<Item = [VertexId; 2]>) -> Self {
        Self { automatic: Arc::new(edges.into_iter().map(ascending).collect()), ..self.clone() }
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
