//! Numbers of vertices and faces in texts: those of files, reports and the command line. A chart of several has
//! vertices of its own, whose numbers no text shows.

use super::Model;
use freebound_core::mesh::FaceId;
use freebound_core::problem::SolveError;

/// Error of a solve of a mesh or chart, with its vertices and faces as files number them.
pub(super) fn error_in_file(model: &Model, error: &SolveError) -> SolveError {
    let mesh = model.mesh();
    match error {
        SolveError::NotFinite { face } if face.index() < mesh.face_count() => {
            SolveError::NotFinite { face: FaceId::new(mesh.polygon(*face)) }
        }
        other => other.clone().renumbered(|vertex| model.vertex_in_file(vertex)),
    }
}
