//! A mesh that is studied: where pins can be, and what of its form the convergence may depend on.

use glam::{DVec2, DVec3};

use crate::flatten::solve_once;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, Family, Method, Pins, Settings, SolveError};

/// A mesh that is studied.
#[derive(Debug)]
pub struct StudySubject<'a> {
    /// The mesh.
    pub mesh: &'a DiskMesh,
    /// What is known of its form.
    pub form: SystemForm,
    /// Vertices on the boundary, along it.
    pub(super) boundary: Vec<VertexId>,
    /// Vertices inside, by number.
    pub(super) inside: Vec<VertexId>,
    /// Its natural embedding by conformal weights, in a box with a diagonal of 1: targets lie around its places. None
    /// where it cannot be solved for: then there are no constraints.
    pub(super) natural: Option<Embedding>,
    /// The diagonal of the box around it in space, in units of its positions.
    pub(super) diagonal: f64,
}

/// What of a mesh's form the convergence may depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SystemForm {
    /// Vertices that belong to faces.
    pub vertices: usize,
    /// Faces.
    pub faces: usize,
    /// Vertices on the boundary.
    pub boundary: usize,
    /// Interior edges between two boundary vertices.
    pub dividing_edges: usize,
    /// Triangles with two boundary edges or three.
    pub ears: usize,
}

impl<'a> StudySubject<'a> {
    /// Makes a mesh ready: solves for its natural embedding once.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`] at the caller's wish to stop.
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

    /// Distance of two vertices in space, as a share of the diagonal of the mesh's box.
    pub(super) fn distance(&self, a: VertexId, b: VertexId) -> f64 {
        self.mesh.position(a).distance(self.mesh.position(b)) / self.diagonal
    }
}

/// The same around the origin, in a box with a diagonal of 1.
fn in_unit_box(embedding: &Embedding) -> Embedding {
    let bounds = embedding.bounds();
    let (middle, diameter) = (bounds.middle(), bounds.diameter());
    embedding.iter().map(|&place: &DVec2| (place - middle) / diameter).collect()
}
