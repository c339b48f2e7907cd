//! Outside of the embedding during a drag, with its triangles indexed by boundary vertex.

use glam::DVec2;

use super::proof::is_upright;
use crate::geom::{Bounds, double_area};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::{FRAME_POINTS, outside_of};
use crate::problem::Embedding;
use crate::verify::UvFrame;

/// Share of the distance from the middle of the frame to its side within which targets must lie.
const WITHIN: f64 = 0.9;

/// Outside up to a frame, as it was triangulated.
#[derive(Debug)]
pub(super) struct LocalScaffold {
    pub(super) frame: Vec<DVec2>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// Positions of the boundary loop at the triangulation.
    boundary: Vec<DVec2>,
    /// Start in `list` of the triangles at each place of the boundary loop; at the end, the length of `list`.
    starts: Vec<u32>,
    list: Vec<u32>,
    /// Twice the area of all triangles.
    pub(super) double_area: f64,
    /// True if all triangles are positive as written.
    pub(super) is_positive: bool,
    /// True if all triangles are positive as written in 32 bits.
    pub(super) is_positive_in_f32: bool,
}

impl LocalScaffold {
    /// Triangulates the outside of an embedding, with clearance for targets. `None` if it cannot be triangulated.
    pub(super) fn new(
        mesh: &DiskMesh,
        embedding: &Embedding,
        targets: impl Iterator<Item = DVec2>,
        sheet: &UvFrame,
    ) -> Option<Self> {
        let outside = outside_of(mesh, embedding, targets, FRAME_POINTS)?;
        let (frame, triangles) = (outside.frame, outside.triangles);
        let boundary = embedding.boundary(mesh);
        let places = |t: &[VertexId; 3]| t.map(|v| mesh_place(mesh, v));
        let mut starts = vec![0_u32; boundary.len() + 1];
        for place in triangles.iter().flat_map(places).flatten() {
            starts[place + 1] += 1;
        }
        for place in 0..boundary.len() {
            starts[place + 1] += starts[place];
        }
        let (mut next, mut list) = (starts.clone(), vec![0; starts[boundary.len()] as usize]);
        for (number, triangle) in (0..).zip(&triangles) {
            for place in places(triangle).into_iter().flatten() {
                list[next[place] as usize] = number;
                next[place] += 1;
            }
        }
        let mut around = Self {
            frame,
            triangles,
            boundary,
            starts,
            list,
            double_area: 0.0,
            is_positive: false,
            is_positive_in_f32: false,
        };
        around.measure(mesh, sheet);
        Some(around)
    }

    /// Computes the area, and tests if all triangles are positive as written.
    fn measure(&mut self, mesh: &DiskMesh, sheet: &UvFrame) {
        let rest = |t: &[VertexId; 3]| t.map(|v| self.at_rest(mesh, v));
        self.double_area = self.triangles.iter().map(|t| double_area(rest(t))).sum();
        let count = mesh.vertex_count();
        let written = |v: VertexId| sheet.written_place((v.index() < count).then_some(v), self.at_rest(mesh, v));
        let are_upright = |place: &dyn Fn(VertexId) -> DVec2| self.triangles.iter().all(|t| is_upright(t.map(place)));
        let in_f32 = |v: VertexId| written(v).as_vec2().as_dvec2();
        (self.is_positive, self.is_positive_in_f32) = (are_upright(&written), are_upright(&in_f32));
    }

    /// Numbers of the triangles at a boundary vertex.
    pub(super) fn at(&self, mesh: &DiskMesh, vertex: VertexId) -> &[u32] {
        let Some(place) = mesh.boundary_place(vertex) else { return &[] };
        &self.list[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// Position of a corner at the triangulation.
    pub(super) fn at_rest(&self, mesh: &DiskMesh, corner: VertexId) -> DVec2 {
        match mesh_place(mesh, corner) {
            Some(place) => self.boundary[place],
            None => self.frame[corner.index() - mesh.vertex_count()],
        }
    }

    /// True if a target lies well within the frame.
    pub(super) fn has_room_for(&self, target: DVec2) -> bool {
        let bounds = Bounds::of(self.frame.iter().copied());
        (target - bounds.middle()).abs().max_element() < WITHIN * 0.5 * bounds.size().min_element()
    }
}

fn mesh_place(mesh: &DiskMesh, corner: VertexId) -> Option<usize> {
    if corner.index() < mesh.vertex_count() { mesh.boundary_place(corner) } else { None }
}
