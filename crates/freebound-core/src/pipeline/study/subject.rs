//! Mesh of a study: candidate vertices for pins, and the counts that convergence may depend on.

use glam::{DVec2, DVec3};

use crate::flatten::solve_once;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Family, Method, Pins, Settings, SolveError};

/// A studied mesh.
#[derive(Debug)]
pub struct StudySubject<'a> {
    /// The mesh.
    pub mesh: &'a DiskMesh,
    /// Counts that convergence may depend on.
    pub form: SystemForm,
    /// Boundary vertices, in order along the boundary.
    pub(super) boundary: Vec<VertexId>,
    /// Interior vertices, by number.
    pub(super) inside: Vec<VertexId>,
    /// Natural embedding by conformal weights, in a box with a diagonal of 1. Targets lie around its positions.
    /// Absent if the solve failed: trials then have no constraints.
    pub(super) natural: Option<Embedding>,
    /// Diagonal of the bounding box in space, in units of the positions.
    pub(super) diagonal: f64,
}

/// Counts of a mesh that convergence may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SystemForm {
    /// Number of vertices that belong to faces, without virtual ones.
    pub vertices: usize,
    /// Number of faces, without virtual ones.
    pub faces: usize,
    /// Number of boundary vertices.
    pub boundary: usize,
    /// Number of interior edges between two boundary vertices.
    pub dividing_edges: usize,
    /// Number of triangles with two or three boundary edges.
    pub ears: usize,
}

impl<'a> StudySubject<'a> {
    /// Prepares a mesh: solves for its natural embedding once.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] if the caller cancels.
    pub fn new(mesh: &'a DiskMesh, control: Control<'_>) -> Result<Self, SolveError> {
        let settings = Settings::new(Method::Natural, Family::Conformal);
        let natural = match solve_once(mesh, &settings, &Pins::new(), control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            solved => solved.ok().map(|solution| in_unit_box(&solution.embedding)),
        };
        let used = || mesh.vertices().filter(|&vertex| mesh.is_used(vertex) && !mesh.is_virtual_vertex(vertex));
        let box_of = used()
            .map(|vertex| mesh.position(vertex))
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], point| [low.min(point), high.max(point)]);
        Ok(Self {
            mesh,
            form: SystemForm {
                vertices: used().count(),
                faces: mesh.real_faces().count(),
                boundary: mesh.boundary_loop().len(),
                dividing_edges: mesh.dividing_edges().len(),
                ears: mesh.ears().len(),
            },
            boundary: mesh.boundary_loop().to_vec(),
            inside: used().filter(|&vertex| mesh.boundary_place(vertex).is_none()).collect(),
            natural,
            diagonal: box_of[0].distance(box_of[1]),
        })
    }

    /// Distance of two vertices in space, as a share of the diagonal of the mesh's bounding box.
    pub(super) fn distance(&self, a: VertexId, b: VertexId) -> f64 {
        self.mesh.position(a).distance(self.mesh.position(b)) / self.diagonal
    }
}

/// Embedding centred at the origin, in a box with a diagonal of 1.
fn in_unit_box(embedding: &Embedding) -> Embedding {
    let bounds = embedding.bounds();
    let (middle, diameter) = (bounds.middle(), bounds.diameter());
    embedding.iter().map(|&place: &DVec2| (place - middle) / diameter).collect()
}
