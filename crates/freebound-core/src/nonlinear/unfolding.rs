//! Local map of a surface of little curvature: without folds and of low distortion, but it may overlap itself.
//!
//! 1. Faces are unfolded into the plane one after another, over the shortest paths from the largest face. This gives a
//!    rotation R of each face.
//! 2. Positions minimise Σ A |J − R|², with J the map of a face from its shape in space. Then rotations are those
//!    nearest to J, and so on (L. Liu et al., "A local/global approach to mesh parameterization", 2008).
//! 3. Newton steps on the foldover energy unfold faces that are folded, and lower the symmetric Dirichlet energy.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use super::energy_problem::{Limits, Unfolding};
use super::foldover_energy::{Energy, conjugate};
use super::slim::Slim;
use crate::mesh::{DiskMesh, FaceId, HalfedgeId};
use crate::problem::{Control, SolveError};

/// Rounds of nearest rotations.
const RIGID_ROUNDS: usize = 10;

/// Most Newton steps.
const STEPS: usize = 100;

/// Relative gain of a Newton step that is followed by another.
const GAIN: f64 = 1e-3;

impl Slim {
    /// Map without folds and of low distortion. `None` if folds remain.
    ///
    /// # Errors
    ///
    /// Fails if a system cannot be factored or the caller cancels.
    pub(crate) fn unfolding(mesh: &DiskMesh, control: Control<'_>) -> Result<Option<Self>, SolveError> {
        let mut map = Self::at_origin(mesh, mesh.mesh().real_face_count(), control)?;
        let rotations = map.rotations(mesh);
        map.problem.rigid_step(&mut map.z, |element, _| rotations[element], control)?;
        for _ in 0..RIGID_ROUNDS {
            let z = map.z.clone();
            map.problem.rigid_step(
                &mut map.z,
                |_, element| {
                    let (alpha, _) = element.derivatives(element.corners.map(|corner| z[corner as usize]));
                    alpha.try_normalize().unwrap_or(DVec2::X)
                },
                control,
            )?;
        }
        let limits = Limits {
            steps: STEPS,
            unfolded: Energy::SymmetricDirichlet,
            unfolding: Unfolding::Freely,
            tolerance: GAIN,
        };
        let descent = map.problem.descend(&mut map.z, limits, None, control)?;
        Ok((descent.least_determinant > 0.0).then_some(map))
    }

    /// Rotation of each face, unfolded over the shortest path from the largest face.
    fn rotations(&self, mesh: &DiskMesh) -> Vec<DVec2> {
        let shape = |face: usize| mesh.rest_shape(mesh.face(FaceId::from_index(face)), self.scale);
        let shapes: Vec<[DVec2; 3]> = (0..mesh.mesh().real_face_count()).map(shape).collect();
        let middle =
            |face: usize| mesh.face(FaceId::from_index(face)).map(|v| mesh.position(v)).iter().sum::<DVec3>() / 3.0;
        let area = |face: FaceId| mesh.mesh().double_area_vector(face).length();
        let largest = mesh.real_faces().max_by(|&a, &b| area(a).total_cmp(&area(b)).then(b.cmp(&a)));
        let mut rotations = vec![DVec2::X; shapes.len()];
        let mut far = vec![f64::INFINITY; shapes.len()];
        let Some(first) = largest else { return rotations };
        far[first.index()] = 0.0;
        let mut queue = BinaryHeap::from([Reverse((0, first))]);
        // The halfedges of a face are numbered from three times its number, in the order of its corners.
        let along = |halfedge: HalfedgeId| {
            let (shape, place) = (shapes[halfedge.index() / 3], halfedge.index() % 3);
            shape[(place + 1) % 3] - shape[place]
        };
        while let Some(Reverse((bits, face))) = queue.pop() {
            if bits != far[face.index()].to_bits() {
                continue;
            }
            for halfedge in (3 * face.index()..3 * face.index() + 3).map(HalfedgeId::from_index) {
                let twin = mesh.twin(halfedge);
                let Some(other) = mesh.face_of(twin).filter(|other| other.index() < shapes.len()) else { continue };
                let there = f64::from_bits(bits) + middle(face.index()).distance(middle(other.index()));
                if there < far[other.index()] {
                    far[other.index()] = there;
                    let here = rotations[face.index()].rotate(along(halfedge));
                    let turn = here.rotate(conjugate(-along(twin)));
                    rotations[other.index()] = turn.try_normalize().unwrap_or(rotations[face.index()]);
                    queue.push(Reverse((there.to_bits(), other)));
                }
            }
        }
        rotations
    }
}
