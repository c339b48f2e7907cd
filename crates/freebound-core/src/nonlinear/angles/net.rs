//! Inner vertices of a disk, angles of its faces, and the conditions that link them.
//!
//! Corner k of a face has its angle at index k. Seen from that corner, the face's next corner is k + 1 and its
//! previous corner is k + 2, both modulo 3. The wheel around the corner's vertex uses these two angles.

use std::f64::consts::{PI, TAU};

use crate::parallel::prelude::*;

use crate::linear::block_pattern::HELD;
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::problem::{Control, SolveError};

/// Smallest angle on the surface, radians. Below it, 64 bits hold no more than its order of magnitude.
const LEAST_ANGLE: f64 = 1e-14;

/// A disk with its angles and conditions.
#[derive(Debug)]
pub(super) struct Net<'a> {
    pub(super) mesh: &'a DiskMesh,
    /// Inner vertices, ascending.
    pub(super) inner: Vec<VertexId>,
    /// Index of each corner of a face among the inner vertices; [`HELD`] on the boundary.
    pub(super) corners: Vec<[u32; 3]>,
    /// Angles on the surface, scaled to 2π around inner vertices.
    pub(super) targets: Vec<[f64; 3]>,
}

impl<'a> Net<'a> {
    pub(super) fn new(mesh: &'a DiskMesh) -> Result<Self, SolveError> {
        let is_inner = |v: &VertexId| mesh.is_used(*v) && mesh.boundary_place(*v).is_none();
        let inner: Vec<VertexId> = mesh.vertices().filter(is_inner).collect();
        let mut places = vec![HELD; mesh.vertex_count()];
        for (place, vertex) in (0..).zip(&inner) {
            places[vertex.index()] = place;
        }
        let corners = mesh.faces().map(|face| mesh.face(face).map(|v| places[v.index()])).collect();
        let mut net = Self { mesh, inner, corners, targets: angles_on_surface(mesh)? };
        let sums = net.around(|angles, k| angles[k], &net.targets);
        for (corners, angles) in net.corners.iter().zip(&mut net.targets) {
            for (&place, angle) in corners.iter().zip(angles).filter(|(place, _)| **place != HELD) {
                *angle *= TAU / sums[place as usize];
            }
        }
        Ok(net)
    }

    /// Sums a number per corner around each inner vertex.
    fn around(&self, of_corner: impl Fn(&[f64; 3], usize) -> f64, angles: &[[f64; 3]]) -> Vec<f64> {
        let mut sums = vec![0.0; self.inner.len()];
        for (corners, angles) in self.corners.iter().zip(angles) {
            for (k, &place) in corners.iter().enumerate().filter(|(_, place)| **place != HELD) {
                sums[place as usize] += of_corner(angles, k);
            }
        }
        sums
    }

    /// Initial angles: the targets, scaled to a sum of π in each face. So every angle is below π.
    pub(super) fn first_angles(&self) -> Vec<[f64; 3]> {
        let scaled = |angles: &[f64; 3]| angles.map(|angle| angle * PI / angles.iter().sum::<f64>());
        self.targets.iter().map(scaled).collect()
    }

    /// Residuals of the conditions around each inner vertex: the angle sum minus 2π, and the wheel.
    pub(super) fn gaps(&self, angles: &[[f64; 3]], control: Control<'_>) -> Result<Vec<[f64; 2]>, SolveError> {
        let logarithms = control.each(angles.len(), |face| angles[face].map(|angle| angle.sin().ln()))?;
        let mut gaps = vec![[-TAU, 0.0]; self.inner.len()];
        for run in control.runs(angles.len()) {
            for face in run? {
                let (angles, logarithms): (_, [f64; 3]) = (angles[face], logarithms[face]);
                for (k, &place) in self.corners[face].iter().enumerate().filter(|(_, place)| **place != HELD) {
                    let [sum, wheel] = &mut gaps[place as usize];
                    *sum += angles[k];
                    *wheel += logarithms[(k + 1) % 3] - logarithms[(k + 2) % 3];
                }
            }
        }
        Ok(gaps)
    }
}

/// Residual of each face: its angle sum minus π.
pub(super) fn face_gaps(angles: &[[f64; 3]]) -> Vec<f64> {
    angles.iter().map(|[a, b, c]| (a + b + c) - PI).collect()
}

/// Angles of the faces in space, or of their mollified shapes.
fn angles_on_surface(mesh: &DiskMesh) -> Result<Vec<[f64; 3]>, SolveError> {
    let of_face = |face: usize| {
        let face = FaceId::from_index(face);
        let x = mesh.shape(mesh.face(face));
        let angles = [0, 1, 2].map(|k| {
            let (next, previous) = (x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]);
            next.cross(previous).length().atan2(next.dot(previous)).max(LEAST_ANGLE)
        });
        if angles.iter().all(|angle| angle.is_finite()) { Ok(angles) } else { Err(SolveError::NotFinite { face }) }
    };
    (0..mesh.face_count()).into_par_iter().map(of_face).collect()
}
