//! Repair of faults that keep a mesh from being a disk, with the origin of each corner.
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | a mesh with completed repairs |
//! | `kinds.rs` | names of the repairs, and sets of them |
//! | `form.rs` | preparation settings of a file's faces |
//! | `sides.rs` | sides of polygons by edge, and their edges in the file |
//! | `leave_out.rs` | removal of repeated corners and degenerate faces, and treatment of duplicate faces |
//! | `weld.rs` | welding of near vertices |
//! | `join.rs` | joining of coincident vertices, splitting of vertices at touching fans, flipping of faces |
//! | `kept.rs` | parts to keep, and parts to leave out |
//! | `fill.rs` | filling of holes with virtual faces |
//! | `cut.rs` | cutting of a surface until each part is a disk |
//! | `seams.rs` | cutting of a surface along given seams |
//! | `borders.rs` | edges that seams usually follow: creases, and borders between faces of two kinds |
//! | `stretches.rs` | seams as lines between their ends and junctions |
//! | `open.rs` | connected parts, and a part opened along seams |
//! | `charts.rs` | parts of a mesh that are disks |
//! | `paths.rs` | shortest paths along edges, for seams that the user draws |
//! | `ways.rs` | shortest paths along edges, and the cost of cutting an edge |
//!
//! A repair changes connectivity alone. Every position stays, and old vertices keep their numbers. New vertices lie at
//! the position of an old vertex and are numbered after all old ones. The source file never changes, except for its
//! texture coordinates, which [`Repaired::corner_of`] maps back to it.

mod borders;
mod charts;
mod cut;
mod fill;
mod form;
mod join;
mod kept;
mod kinds;
mod leave_out;
mod open;
mod paths;
mod seams;
mod sides;
mod stretches;
mod ways;
mod weld;

use std::collections::HashMap;

use fill::Filling;

use super::{PolygonMesh, TriMesh, VertexId, diagnose};

pub use borders::{borders, creases, splits};
pub use charts::{Chart, Charts};
pub use form::{HoleTreatment, Preparation};
pub use kept::PartFaces;
pub use kinds::{Done, Repair, Repairs, WeldDistance};
pub use paths::{EdgePaths, PathTree};
pub use seams::Seams;
pub use weld::near_vertices;

/// A mesh with completed repairs, and the origin of each of its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    polygons: PolygonMesh,
    /// Corner of the given mesh for each corner.
    corner_of: Vec<u32>,
    /// Face of the given mesh for each face.
    face_of: Vec<u32>,
    /// Removed corners of the given mesh, each with its replacement; a replacement may itself be removed later.
    stand_ins: Vec<[u32; 2]>,
    /// Vertices that were joined with others, each with the vertex that replaces it.
    joined: HashMap<VertexId, VertexId>,
    /// True if holes are filled while the mesh is flattened.
    fills: bool,
    /// Filling of the holes if the mesh has one part. Positions beyond those of the polygons belong to the filling.
    filling: Filling,
    /// Faces of the parts that were left out, by their numbers in the given mesh.
    left_out: Vec<u32>,
    /// Faces without area that were removed, by their numbers in the given mesh.
    degenerate: Vec<u32>,
    /// True if the last of several repeated corners of a face is kept instead of the first: the given mesh was
    /// reversed.
    keeps_last: bool,
    done: Vec<Done>,
}

impl Repaired {
    /// Applies the allowed repairs to a mesh. [`done`](Self::done) is empty if the mesh needs none of them.
    pub fn new(source: &PolygonMesh, repairs: Repairs) -> Self {
        let mut repaired = Self::of(source);
        if !repaired.is_sound() {
            return repaired;
        }
        repaired.leave_out(repairs);
        if let Some(distance) = repairs.weld_distance() {
            repaired.weld_within(distance);
        }
        if repairs.allows(Repair::WeldVertices) {
            repaired.weld();
        }
        repaired.leave_out_joined(source, repairs);
        if repairs.allows(Repair::SplitEdges) {
            repaired.split_edges();
        }
        if repairs.allows(Repair::TurnFaces) {
            repaired.turn_faces();
        }
        if repairs.allows(Repair::SplitVertices) {
            repaired.split_vertices();
        }
        repaired
    }

    /// The given mesh without any repair.
    fn of(source: &PolygonMesh) -> Self {
        let count = |count: usize| u32::try_from(count).expect("a mesh has fewer than 2^32 corners");
        Self {
            polygons: source.clone(),
            corner_of: (0..count(source.corners.len())).collect(),
            face_of: (0..count(source.face_count())).collect(),
            stand_ins: Vec::new(),
            joined: HashMap::new(),
            fills: false,
            filling: Filling::default(),
            left_out: Vec::new(),
            degenerate: Vec::new(),
            keeps_last: false,
            done: Vec::new(),
        }
    }

    /// True if every corner has a vertex. If vertices are missing, nothing else can be repaired.
    fn is_sound(&self) -> bool {
        let count = self.polygons.positions.len();
        self.polygons.corners.iter().all(|corner| corner.index() < count)
    }

    /// True if every corner has a vertex, and every face has three or more corners.
    pub(crate) fn has_faces(&self) -> bool {
        let is_face = |face: usize| self.polygons.corner_range(face).len() >= 3;
        self.is_sound() && (0..self.polygons.face_count()).all(is_face)
    }

    /// Cuts each part of the surface open until it is a disk; skips parts with an edge of three or more faces. Returns
    /// the mesh unchanged if all parts are disks already, or if the cut does not make disks of all parts.
    #[must_use]
    pub fn cut_to_disks(self) -> Self {
        let cut = cut::cut_open(&self);
        if cut.flattens() { cut } else { self }
    }

    /// Repairs of the given mesh `source`, transferred to the mesh with every face reversed.
    fn turned(mut self, source: &PolygonMesh) -> Self {
        let mut place: Vec<u32> = (0..).take(source.corners.len()).collect();
        for face in 0..source.face_count() {
            let range = source.corner_range(face);
            place[range.start + 1..range.end].reverse();
        }
        self.polygons = self.polygons.turned();
        for face in 0..self.polygons.face_count() {
            let range = self.polygons.corner_range(face);
            self.corner_of[range.start + 1..range.end].reverse();
        }
        self.corner_of.iter_mut().for_each(|corner| *corner = place[*corner as usize]);
        self.stand_ins.iter_mut().flatten().for_each(|corner| *corner = place[*corner as usize]);
        self.filling.turn();
        self.keeps_last = !self.keeps_last;
        self
    }

    /// Completed repairs, in order.
    pub fn done(&self) -> &[Done] {
        &self.done
    }

    /// Positions and faces, without the filling of holes.
    pub fn polygons(&self) -> &PolygonMesh {
        &self.polygons
    }

    /// Face of the given mesh for a face of the repaired mesh; `None` without such a face.
    pub fn face_in_file(&self, face: u32) -> Option<super::FaceId> {
        self.face_of.get(face as usize).copied().map(super::FaceId::new)
    }

    /// Corner of the given mesh for a corner of the repaired mesh.
    pub fn corner_of(&self, corner: usize) -> usize {
        self.corner_of[corner] as usize
    }

    /// Vertex at each corner of the given mesh, whose place in the map the corner takes. A removed corner takes the
    /// place of its replacement. All corners of a removed face take one place: the face covers nothing. `None` in parts
    /// that were left out, and in removed faces whose vertices have no place.
    pub fn vertices_at_corners(&self, source: &PolygonMesh) -> Vec<Option<VertexId>> {
        let mut vertices = vec![None; source.corners.len()];
        let mut in_place = vec![None; source.positions.len()];
        for (&corner, &of) in self.polygons.corners.iter().zip(&self.corner_of) {
            vertices[of as usize] = Some(corner);
            in_place[source.corners[of as usize].index()].get_or_insert(corner);
        }
        let place_of = |vertex: &VertexId| {
            let stands_for = self.joined.get(vertex).unwrap_or(vertex);
            [vertex, stands_for].iter().find_map(|of| in_place.get(of.index()).copied().flatten())
        };
        for &face in &self.degenerate {
            let range = source.corner_range(face as usize);
            let place = source.corners[range.clone()].iter().find_map(place_of);
            vertices[range].fill(place);
        }
        // A face may be stacked on one that was removed later.
        for &[left_out, stand_in] in self.stand_ins.iter().rev() {
            vertices[left_out as usize] = vertices[stand_in as usize];
        }
        vertices
    }

    /// Faces of the given mesh that were removed because they have no area, ascending. They take one point of the map.
    pub fn degenerate_faces(&self) -> &[u32] {
        &self.degenerate
    }

    /// Number of vertices at the position of a vertex of another part, with which they are not joined. Vertices that a
    /// repair or a cut has split count as one.
    pub fn touching_vertices(&self, source: &PolygonMesh) -> usize {
        let vertices = self.vertices_of(source);
        let TriMesh { mut triangles, .. } = self.polygons.triangulate();
        triangles.iter_mut().flatten().for_each(|vertex| *vertex = vertices[vertex.index()]);
        let positions = source.positions.clone();
        let mesh = TriMesh { positions, triangles, polygon_of: None };
        super::coincident::coincident_vertices(&mesh, &mesh.triangles).len()
    }

    /// Vertex that replaces a joined vertex of the given mesh; `None` if the vertex was not joined.
    pub fn stands_for(&self, vertex: VertexId) -> Option<VertexId> {
        self.joined.get(&vertex).copied()
    }

    /// Vertex of the given mesh at the position of each vertex; an old vertex maps to itself.
    pub fn vertices_of(&self, source: &PolygonMesh) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = (0..self.polygons.positions.len()).map(VertexId::from_index).collect();
        let corners = self.polygons.corners.iter().zip(&self.corner_of);
        for (corner, &of) in corners.filter(|(corner, _)| corner.index() >= source.positions.len()) {
            let of = source.corners[of as usize];
            vertices[corner.index()] = self.joined.get(&of).copied().unwrap_or(of);
        }
        vertices
    }

    /// Triangles of the faces, numbered as in the file. Triangles that fill holes follow, numbered from
    /// [`FIRST_HOLE`](super::FIRST_HOLE), and their own vertices follow the others.
    pub fn triangulate(&self) -> TriMesh {
        let TriMesh { positions, triangles, polygon_of } = self.polygons.triangulate();
        let of_triangle = |face: usize| self.face_of[polygon_of.as_ref().map_or(face, |of| of[face] as usize)];
        let polygon_of = Some((0..triangles.len()).map(of_triangle).collect());
        self.filling.appended_to(TriMesh { positions, triangles, polygon_of })
    }

    /// Records a completed repair. Does nothing if the count is 0.
    fn note(&mut self, repair: Repair, count: usize) {
        if count == 0 {
            return;
        }
        match self.done.iter_mut().find(|done| done.repair == repair) {
            Some(done) => done.count += count,
            None => self.done.push(Done { repair, count }),
        }
    }

    /// True if the mesh is a disk, or all its parts are disks.
    pub fn flattens(&self) -> bool {
        diagnose(&self.triangulate()).is_disk() || charts::disks_of(self).is_some()
    }
}
