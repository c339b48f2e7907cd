//! The neighbourhood of dragged pins, made as large as their way wants it.

use glam::DVec2;

use super::patch::{Ground, Patch};
use super::scaffold::LocalScaffold;
use super::{DragSolver, DragTarget, GROWTH, MOST_VERTICES};
use crate::geom::double_area;
use crate::mesh::DiskMesh;
use crate::nonlinear::rest_shape::mean_edge_length;
use crate::problem::{Embedding, Pins};

/// The pins' way is at most such a share of the neighbourhood's radius; otherwise it grows.
const WAY_SHARE: f64 = 0.25;

/// Sizes of the sheet when the drag began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Twice the area of the faces.
    pub(super) double_area: f64,
    /// The side of regular triangles of the same area as the mean face.
    pub(super) mean_edge: f64,
    /// The stiffness of a spring of weight 1.
    pub(super) spring_unit: f64,
}

impl DragSolver {
    /// Makes the neighbourhood as large as it is to be. Returns whether there is one.
    pub(super) fn prepare(&mut self, mesh: &DiskMesh, aim: &DragTarget) -> bool {
        let targets = || self.dragged.iter().filter_map(|v| Some((*v, aim.pins.get(v)?.target)));
        if !targets().all(|(_, target)| target.is_finite()) {
            return false;
        }
        let way = targets().map(|(v, target)| target.distance(self.begin[v])).fold(0.0, f64::max);
        let from: Vec<DVec2> = self.dragged.iter().map(|v| self.begin[v]).collect();
        loop {
            let nearest = self.reach.nearest(mesh, &self.begin, self.wanted);
            let farthest = nearest.last().map_or(DVec2::ZERO, |v| self.begin[v]);
            let radius = from.iter().map(|z| z.distance(farthest)).fold(f64::INFINITY, f64::min);
            let is_all = nearest.len() < self.wanted;
            if is_all || self.wanted >= MOST_VERTICES || way <= WAY_SHARE * radius {
                break;
            }
            self.wanted = (GROWTH * self.wanted).min(MOST_VERTICES);
        }
        let nearest = self.reach.nearest(mesh, &self.begin, self.wanted);
        let is_at_boundary = nearest.iter().any(|&v| mesh.boundary_place(v).is_some());
        let has_room = |around: &LocalScaffold| targets().all(|(_, target)| around.has_room_for(target));
        let has_around = self.around.as_ref().is_some_and(has_room);
        let is_large_enough = self.patch.as_ref().is_some_and(|patch| patch.nearest_count() == nearest.len());
        if is_at_boundary && !has_around {
            self.triangulate_around(mesh, aim);
        } else if !is_large_enough {
            self.make_patch(mesh, None);
        }
        self.patch.is_some()
    }

    /// Triangulates the outside as it lies now, with room for the targets. Where it cannot be, it stays as it is.
    pub(super) fn triangulate_around(&mut self, mesh: &DiskMesh, aim: &DragTarget) {
        let targets = self.dragged.iter().filter_map(|v| Some(aim.pins.get(v)?.target));
        let around = LocalScaffold::new(mesh, &self.embedding, targets, &self.sheet);
        if around.is_none() && self.patch.is_some() {
            return;
        }
        // With the outside as without it, the same vertices are free: their order of elimination is kept.
        let similar = self.patch.take().filter(|_| self.around.is_some());
        self.around = around.or(self.around.take());
        self.make_patch(mesh, similar.as_ref());
    }

    fn make_patch(&mut self, mesh: &DiskMesh, similar: Option<&Patch>) {
        let nearest = self.reach.nearest(mesh, &self.begin, self.wanted);
        let ground = Ground {
            mesh,
            begin: &self.begin,
            embedding: &self.embedding,
            pins: &self.pins,
            dragged: &self.dragged,
            around: self.around.as_ref(),
            double_area: self.scale.double_area,
            spring_unit: self.scale.spring_unit,
        };
        let similar = similar.filter(|similar| similar.nearest_count() == nearest.len());
        self.patch = Patch::new(&ground, nearest, similar).ok();
    }
}

impl Scale {
    /// `None` where numbers are too large or too small to tell.
    pub(super) fn of(mesh: &DiskMesh, embedding: &Embedding, pins: &Pins) -> Option<Self> {
        let double_area: f64 = mesh.real_faces().map(|face| double_area(embedding.corners(mesh, face))).sum();
        let mean_edge = (2.0 * double_area / (3.0_f64.sqrt() * mesh.mesh().real_face_count() as f64)).sqrt();
        let is_pulled = pins.values().any(|pin| !pin.kind.is_hard());
        let edge = if is_pulled { mean_edge_length(mesh, embedding) } else { mean_edge };
        let spring_unit = 1.0 / (edge * edge * mesh.used_vertex_count() as f64);
        let all = [double_area, mean_edge, spring_unit];
        all.iter().all(|number| number.is_normal()).then_some(Self { double_area, mean_edge, spring_unit })
    }
}
