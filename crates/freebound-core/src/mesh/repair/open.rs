//! Connected parts of a repaired mesh, and a part opened along seams.

use super::Repaired;
use super::charts::{Chart, parts_of};
use super::sides::Sides;
use crate::mesh::{PolygonMesh, VertexId};

impl Repaired {
    /// Edge-connected parts, each with its own vertices, in the order of their first faces.
    pub(crate) fn separate_parts(&self) -> Vec<Self> {
        let faces = parts_of(&self.polygons, &Sides::new(&self.polygons));
        faces.iter().map(|faces| self.of_faces(faces).repaired).collect()
    }

    /// Ends of each edge, and its number of sides, in the order of the edge table.
    pub(crate) fn edges_with_sides(&self) -> Vec<([VertexId; 2], usize)> {
        let sides = Sides::new(&self.polygons);
        sides.table.edges().map(|on| (sides.ends(on[0]), on.len())).collect()
    }

    /// Faces at each edge, in the order of the edge table.
    pub(crate) fn faces_of_edges(&self) -> Vec<Vec<u32>> {
        let sides = Sides::new(&self.polygons);
        sides.table.edges().map(|on| on.iter().map(|&side| sides.face[side as usize]).collect()).collect()
    }

    /// True if holes are filled while the mesh is flattened.
    pub(crate) fn fills_holes(&self) -> bool {
        self.fills
    }

    /// Ends of the seams in the given mesh `source`. `is_seam` has a value per edge, in the order of the edge table.
    pub(crate) fn seams_in(&self, source: &PolygonMesh, is_seam: &[bool]) -> Vec<[VertexId; 2]> {
        let sides = Sides::new(&self.polygons);
        let seams = sides.table.edges().zip(is_seam).filter(|(_, is_seam)| **is_seam);
        seams.map(|(on, _)| sides.edge_in_file(self, source, on[0])).collect()
    }

    /// Value of each edge, in the order of the edge table, by its ends in the given mesh `source`.
    pub(crate) fn by_edge_in<T>(&self, source: &PolygonMesh, value: impl Fn([VertexId; 2]) -> T) -> Vec<T> {
        let sides = Sides::new(&self.polygons);
        sides.table.edges().map(|on| value(sides.edge_in_file(self, source, on[0]))).collect()
    }

    /// True if each edge has at most two sides, which run in opposite directions.
    pub(crate) fn is_oriented(&self) -> bool {
        let sides = Sides::new(&self.polygons);
        let mut edges = sides.table.edges();
        self.has_faces()
            && edges.all(|on| on.len() == 1 || (on.len() == 2 && sides.ends(on[0])[0] == sides.ends(on[1])[1]))
    }

    /// The mesh opened along seams. `is_seam` has a value per edge, in the order of the edge table.
    pub(crate) fn opened_along(&self, is_seam: &[bool]) -> Self {
        let sides = Sides::new(&self.polygons);
        let mut is_open = vec![false; self.polygons.corners.len()];
        for (on, &is_seam) in sides.table.edges().zip(is_seam) {
            is_open[on[0] as usize] = is_seam;
        }
        let fans = sides.fans(|on| on.len() == 2 && !is_open[on[0] as usize]);
        let mut opened = self.clone();
        opened.split_into(fans);
        opened
    }

    /// Edge-connected parts as charts, with holes filled if allowed, each with its faces.
    pub(crate) fn separate_charts(&self) -> Vec<(Chart, Vec<u32>)> {
        let chart = |faces: Vec<u32>| {
            let Chart { repaired, vertex_of } = self.of_faces(&faces);
            (Chart { repaired: repaired.filled(), vertex_of }, faces)
        };
        parts_of(&self.polygons, &Sides::new(&self.polygons)).into_iter().map(chart).collect()
    }
}
