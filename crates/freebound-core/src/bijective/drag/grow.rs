//! Growth of the neighbourhood of dragged pins with the distance that they move.

use glam::DVec2;

use super::patch::{FaceRest, Ground, Patch};
use super::scaffold::LocalScaffold;
use super::{DragSolver, DragTarget, GROWTH, MOST_VERTICES};
use crate::geom::double_area;
use crate::mesh::DiskMesh;
use crate::nonlinear::rest_shape::mean_edge_length;
use crate::problem::{Embedding, Pins};

/// Largest distance of a pin from its start, relative to the radius of the neighbourhood; beyond it the neighbourhood
/// grows.
const WAY_SHARE: f64 = 0.25;

/// Sizes of the embedding at the start of the drag.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Twice the area of the faces.
    pub(super) double_area: f64,
    /// Edge of an equilateral triangle with the area of the mean face.
    pub(super) mean_edge: f64,
    /// Stiffness of a spring of weight 1.
    pub(super) spring_unit: f64,
}

impl DragSolver {
    /// Grows the neighbourhood to its required size. Returns true if the drag can move vertices.
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

    /// Triangulates the present outside again, with clearance for the targets. If that fails, an existing outside is
    /// kept.
    pub(super) fn triangulate_around(&mut self, mesh: &DiskMesh, aim: &DragTarget) {
        let targets = self.dragged.iter().filter_map(|v| Some(aim.pins.get(v)?.target));
        let around = LocalScaffold::new(mesh, &self.embedding, targets, &self.sheet);
        if around.is_none() && self.patch.is_some() {
            return;
        }
        // The free vertices are equal if there was an outside before: the elimination order is reused.
        let similar = self.patch.take().filter(|_| self.around.is_some());
        self.around = around.or(self.around.take());
        self.make_patch(mesh, similar.as_ref());
    }

    fn make_patch(&mut self, mesh: &DiskMesh, similar: Option<&Patch>) {
        let nearest = self.reach.nearest(mesh, &self.begin, self.wanted);
        let ground = Ground {
            mesh,
            begin: &self.begin,
            rest: FaceRest::Begin,
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
    /// Sizes of an embedding. `None` if a number is zero, subnormal or not finite.
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
