//! Repairs: what keeps a mesh from being a disk, mended as far as it can be, and where each corner comes from.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | a mesh with some repairs done |
//! | `kinds.rs` | the repairs by name, and sets of them |
//! | `form.rs` | what is wanted of a file's faces |
//! | `sides.rs` | sides of polygons, which lie on one edge, and which edges of the file they are |
//! | `leave_out.rs` | repeated corners and duplicate faces left out |
//! | `weld.rs` | vertices near each other made one |
//! | `join.rs` | vertices in one place made one; one made several, where fans of faces only touch; faces turned over |
//! | `kept.rs` | parts that are wanted, and parts that are left out |
//! | `fill.rs` | holes filled with virtual faces |
//! | `cut.rs` | a surface cut open until it is a disk, or several |
//! | `seams.rs` | a surface cut along given seams |
//! | `borders.rs` | edges that seams follow as a rule: creases, and where faces of two kinds meet |
//! | `stretches.rs` | seams as lines, from where they end or meet to where they do again |
//! | `charts.rs` | the parts of a mesh, each a disk by itself |
//! | `paths.rs` | shortest paths along edges, for seams that a person draws |
//! | `ways.rs` | shortest ways along edges, and what an edge costs a cut |
//!
//! A repair changes connectivity alone: every position stays, and old vertices keep their numbers; new ones, which lie where
//! an old one does, follow. The file that the mesh came from is never changed but for its texture coordinates, which
//! [`Repaired::corner_of`] carries back.

mod borders;
mod charts;
mod cut;
mod fill;
mod form;
mod join;
mod kept;
mod kinds;
mod leave_out;
mod paths;
mod seams;
mod sides;
mod stretches;
mod ways;
mod weld;

use std::collections::HashMap;

use fill::Filling;

use super::{PolygonMesh, TriMesh, VertexId, diagnose};

pub use borders::{borders, creases};
pub use charts::{Chart, Charts};
pub use form::{HoleTreatment, Preparation};
pub use kept::PartFaces;
pub use kinds::{Done, Repair, Repairs, WeldDistance};
pub use paths::{EdgePaths, PathTree};
pub use seams::Seams;
pub use weld::near_vertices;

/// A mesh with repairs done, and where each part of it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    polygons: PolygonMesh,
    /// For each corner the corner of the mesh as given that it is.
    corner_of: Vec<u32>,
    /// For each face the face of the mesh as given that it is.
    face_of: Vec<u32>,
    /// Corners of the mesh as given that were left out, each with one that stands for it; that may be left out later.
    stand_ins: Vec<[u32; 2]>,
    /// Vertices that were joined with others, each with the one that stands for it.
    joined: HashMap<VertexId, VertexId>,
    /// Whether holes are filled while it is flattened.
    fills: bool,
    /// What fills them, where it is one part. Positions beyond those of the polygons are the filling's.
    filling: Filling,
    /// The faces of parts that were left out, by their numbers in the mesh as given.
    left_out: Vec<u32>,
    /// Whether the last of the corners of a face that repeat each other is kept, not the first: where the mesh as given was
    /// turned around.
    keeps_last: bool,
    done: Vec<Done>,
}

impl Repaired {
    /// Repairs a mesh as far as is allowed. Where nothing is to be done, [`done`](Self::done) is empty.
    pub fn new(source: &PolygonMesh, repairs: Repairs) -> Self {
        let mut repaired = Self::of(source);
        if !repaired.is_sound() {
            return repaired;
        }
        repaired.leave_out(repairs);
        if let Some(distance) = repairs.weld_distance() {
            repaired.weld_within(distance);
            repaired.leave_out_joined(source);
        }
        if repairs.allows(Repair::WeldVertices) {
            repaired.weld();
            repaired.leave_out_joined(source);
        }
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

    /// The mesh as given.
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
            keeps_last: false,
            done: Vec::new(),
        }
    }

    /// Whether every corner has a vertex: where some are missing, nothing can be known of the rest.
    fn is_sound(&self) -> bool {
        let count = self.polygons.positions.len();
        self.polygons.corners.iter().all(|corner| corner.index() < count)
    }

    /// Whether every corner has a vertex, and every face three corners or more.
    fn has_faces(&self) -> bool {
        let is_face = |face: usize| self.polygons.corner_range(face).len() >= 3;
        self.is_sound() && (0..self.polygons.face_count()).all(is_face)
    }

    /// Cuts each part of the surface open until it is a disk: for parts without crowded edges. Nothing where all are disks
    /// already, or cutting makes none of one.
    #[must_use]
    pub fn cut_to_disks(self) -> Self {
        let cut = cut::cut_open(&self);
        if cut.flattens() { cut } else { self }
    }

    /// The same repairs of the mesh as given, `source`, with every face turned around.
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

    /// What was done, in order.
    pub fn done(&self) -> &[Done] {
        &self.done
    }

    /// Positions and faces; of holes nothing but that they are there.
    pub fn polygons(&self) -> &PolygonMesh {
        &self.polygons
    }

    /// The corner of the mesh as given that a corner is.
    pub fn corner_of(&self, corner: usize) -> usize {
        self.corner_of[corner] as usize
    }

    /// The vertex at each corner of the mesh as given; at corners that were left out that of the corner that stands for
    /// them, or any in their place. None where there is none in their place, and in parts that were left out.
    pub fn vertices_at_corners(&self, source: &PolygonMesh) -> Vec<Option<VertexId>> {
        let mut vertices = vec![None; source.corners.len()];
        let mut in_place = vec![None; source.positions.len()];
        for (&corner, &of) in self.polygons.corners.iter().zip(&self.corner_of) {
            vertices[of as usize] = Some(corner);
            in_place[source.corners[of as usize].index()].get_or_insert(corner);
        }
        for &[left_out, stand_in] in self.stand_ins.iter().rev() {
            vertices[left_out as usize] = vertices[stand_in as usize];
        }
        for (vertex, of) in vertices.iter_mut().zip(&source.corners).filter(|(vertex, _)| vertex.is_none()) {
            let stands_for = self.joined.get(of).unwrap_or(of);
            *vertex = [of, stands_for].iter().find_map(|of| in_place.get(of.index()).copied().flatten());
        }
        for &face in &self.left_out {
            vertices[source.corner_range(face as usize)].fill(None);
        }
        vertices
    }

    /// The vertex that stands for one of the mesh as given that was joined with others.
    pub fn stands_for(&self, vertex: VertexId) -> Option<VertexId> {
        self.joined.get(&vertex).copied()
    }

    /// The vertex of the mesh as given in whose place each vertex lies: an old one itself.
    pub fn vertices_of(&self, source: &PolygonMesh) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = (0..self.polygons.positions.len()).map(VertexId::from_index).collect();
        let corners = self.polygons.corners.iter().zip(&self.corner_of);
        for (corner, &of) in corners.filter(|(corner, _)| corner.index() >= source.positions.len()) {
            let of = source.corners[of as usize];
            vertices[corner.index()] = self.joined.get(&of).copied().unwrap_or(of);
        }
        vertices
    }

    /// Its faces as triangles, numbered as in the file. Those that fill holes follow, numbered from
    /// [`FIRST_HOLE`](super::FIRST_HOLE) on, and so do the vertices that only these have.
    pub fn triangulate(&self) -> TriMesh {
        let TriMesh { positions, triangles, polygon_of } = self.polygons.triangulate();
        let of_triangle = |face: usize| self.face_of[polygon_of.as_ref().map_or(face, |of| of[face] as usize)];
        let polygon_of = Some((0..triangles.len()).map(of_triangle).collect());
        self.filling.appended_to(TriMesh { positions, triangles, polygon_of })
    }

    /// Notes what was done, where it was.
    fn note(&mut self, repair: Repair, count: usize) {
        if count == 0 {
            return;
        }
        match self.done.iter_mut().find(|done| done.repair == repair) {
            Some(done) => done.count += count,
            None => self.done.push(Done { repair, count }),
        }
    }

    /// Whether nothing keeps it from being a disk, or several.
    pub fn flattens(&self) -> bool {
        diagnose(&self.triangulate()).is_disk() || charts::disks_of(self).is_some()
    }
}
