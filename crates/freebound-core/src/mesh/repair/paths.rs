//! Shortest paths along edges, for seams that the user draws from vertex to vertex of a file.
//!
//! # Measure
//!
//! ```text
//! cost = length · (1 − s · (1 − CREASED_SEAM) · min(1, θ / SHARP))
//! ```
//!
//! θ is the angle between the normals of the edge's faces. The crease weight s runs from 0 to 1. At 0 length alone
//! counts; at 1 a path accepts a detour of up to 1 / `CREASED_SEAM` of its length to stay on sharp edges. The cost is
//! linear in the angle. So a rounded edge, whose crease is spread over a few rows of faces, still attracts a path. A
//! boundary edge, or an edge beside a face without area, has no crease.
//!
//! A tree of paths from one vertex (Dijkstra 1959) costs time once; reading a path from it is cheap.

use std::sync::Arc;

use super::sides::Sides;
use super::ways::{Measure, Reach, Ways};
use super::{Repaired, Repairs};
use crate::mesh::{PolygonMesh, VertexId};

/// Edges of a repaired, uncut mesh: coincident vertices of the file are one vertex if the repair joins them.
#[derive(Debug)]
pub struct EdgePaths {
    ways: Ways,
    /// Ends of each edge, by vertices of the file's faces.
    in_file: Vec<[VertexId; 2]>,
    /// Vertices of the file with their new numbers after the repair, in file order. Unchanged numbers are left out.
    renamed: Vec<[VertexId; 2]>,
}

impl EdgePaths {
    /// Prepares paths on a file's faces. There are no paths if a face has fewer than three corners, or a corner has no
    /// vertex.
    pub fn new(source: &PolygonMesh, repairs: Repairs) -> Self {
        let repaired = Repaired::new(source, repairs);
        let none = PolygonMesh::default();
        let polygons = if repaired.has_faces() { &repaired.polygons } else { &none };
        let sides = Sides::new(polygons);
        let at_corner = |corner: u32| source.corners[repaired.corner_of(corner as usize)];
        let in_file = sides.table.edges().map(|on| sides.edge_in_file(&repaired, source, on[0])).collect();
        let pairs = (0..).zip(&polygons.corners).map(|(corner, &vertex)| [at_corner(corner), vertex]);
        let mut renamed: Vec<[VertexId; 2]> = pairs.filter(|[of, vertex]| of != vertex).collect();
        renamed.sort_unstable();
        renamed.dedup();
        Self { ways: Ways::new(polygons, &sides), in_file, renamed }
    }

    /// Vertices of the repaired mesh that a vertex of the file has become.
    fn vertices_of(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let from = self.renamed.partition_point(|[of, _]| *of < vertex);
        let renamed = self.renamed[from..].iter().take_while(move |[of, _]| *of == vertex).map(|[_, now]| *now);
        std::iter::once(vertex).chain(renamed).filter(|vertex| vertex.index() < self.ways.vertex_count())
    }
}

/// Shortest paths from one vertex to all others.
#[derive(Debug)]
pub struct PathTree {
    paths: Arc<EdgePaths>,
    reach: Reach,
}

impl PathTree {
    /// Finds the shortest paths from a vertex of the file. `creases` is the weight s of the measure, clamped to 0..1.
    pub fn new(paths: &Arc<EdgePaths>, from: VertexId, creases: f64) -> Self {
        let reach = paths.ways.reach(paths.vertices_of(from), Measure::Blend(creases.clamp(0.0, 1.0)));
        Self { paths: Arc::clone(paths), reach }
    }

    /// Edges of the shortest path to a vertex of the file, listed backwards from it, by vertices of the file. `None`
    /// if no path leads there.
    pub fn path_to(&self, vertex: VertexId) -> Option<Vec<[VertexId; 2]>> {
        let far = |vertex: VertexId| self.reach.far[vertex.index()];
        let there = self.paths.vertices_of(vertex).min_by(|a, b| far(*a).total_cmp(&far(*b)))?;
        let edges = self.reach.way_to(there, &self.paths.ways);
        far(there).is_finite().then(|| edges.map(|edge| self.paths.in_file[edge as usize]).collect())
    }
}
