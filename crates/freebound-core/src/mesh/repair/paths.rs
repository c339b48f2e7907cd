//! Shortest paths along edges, for seams that a person draws from vertex to vertex of a file.
//!
//! # Measure
//!
//! ```text
//! cost = length · (1 − s · (1 − CREASED_SEAM) · min(1, θ / SHARP))
//! ```
//!
//! with θ the angle between the normals of the edge's faces, and s the share of creases from 0, where length alone counts, to 1,
//! where a path takes a detour of up to 1 / `CREASED_SEAM` of its length to stay on sharp edges. It is linear in the angle, so that a
//! rounded edge, whose crease is spread over a few rows of faces, still leads a path along it. A boundary edge, and one beside a
//! face without area, has no crease.
//!
//! A tree of paths from one vertex (Dijkstra 1959) takes the time, once; a path in it is then only followed back.

use std::sync::Arc;

use super::sides::Sides;
use super::ways::{Measure, Reach, Ways};
use super::{Repaired, Repairs};
use crate::mesh::{PolygonMesh, VertexId};

/// The edges of a mesh that is repaired, and not cut: vertices of the file in one place are one, where the repair joins them.
#[derive(Debug)]
pub struct EdgePaths {
    ways: Ways,
    /// The ends of each edge as the file's faces have them.
    in_file: Vec<[VertexId; 2]>,
    /// Vertices of the file with those that the repair made of them under other numbers, in the file's order.
    renamed: Vec<[VertexId; 2]>,
}

impl EdgePaths {
    /// Prepares paths on a file's faces. There are none where a face has fewer than three corners, or one without a vertex.
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

    /// The vertices that a vertex of the file has become.
    fn vertices_of(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let from = self.renamed.partition_point(|[of, _]| *of < vertex);
        let renamed = self.renamed[from..].iter().take_while(move |[of, _]| *of == vertex).map(|[_, now]| *now);
        std::iter::once(vertex).chain(renamed).filter(|vertex| vertex.index() < self.ways.vertex_count())
    }
}

/// The shortest paths from one vertex to all others.
#[derive(Debug)]
pub struct PathTree {
    paths: Arc<EdgePaths>,
    reach: Reach,
}

impl PathTree {
    /// Finds the paths from a vertex of the file. `creases` is the share s of the measure, from 0 to 1.
    pub fn new(paths: &Arc<EdgePaths>, from: VertexId, creases: f64) -> Self {
        let reach = paths.ways.reach(paths.vertices_of(from), Measure::Blend(creases.clamp(0.0, 1.0)));
        Self { paths: Arc::clone(paths), reach }
    }

    /// The edges of the shortest path to a vertex of the file, from there back: vertices of the file. None where no path
    /// leads there.
    pub fn path_to(&self, vertex: VertexId) -> Option<Vec<[VertexId; 2]>> {
        let far = |vertex: VertexId| self.reach.far[vertex.index()];
        let there = self.paths.vertices_of(vertex).min_by(|a, b| far(*a).total_cmp(&far(*b)))?;
        let edges = self.reach.way_to(there, &self.paths.ways);
        far(there).is_finite().then(|| edges.map(|edge| self.paths.in_file[edge as usize]).collect())
    }
}
