//! Seam under the pointer: the stretch through the vertex under the pointer, with both of its sides.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::scene::MeshScene;
use crate::ui::state::Edge;
use freebound_core::mesh::VertexId;

/// Sides of the seam under the pointer.
#[derive(Debug, Default)]
pub struct SeamHover {
    /// Revision of the mesh, and the vertex of the file under the pointer.
    key: Option<(u64, VertexId)>,
    sides: Vec<Edge>,
}

impl SeamHover {
    /// Sides of the seam under the pointer, by vertices of the scene. Empty if no seam is there.
    pub fn sides(&self) -> &[Edge] {
        &self.sides
    }

    /// Updates the seam for the vertex under the pointer.
    pub(super) fn refresh(&mut self, scene: Option<&Arc<MeshScene>>, vertex: Option<VertexId>) {
        let found = scene.zip(vertex).and_then(|(scene, vertex)| Some((scene, scene.in_file.vertex(vertex)?)));
        let key = found.map(|(scene, vertex)| (scene.model_revision, vertex));
        if self.key != key {
            self.key = key;
            self.sides = found.map(|(scene, vertex)| sides(scene, vertex)).unwrap_or_default();
        }
    }
}

/// Sides of the stretches of seams through a vertex of the file.
fn sides(scene: &MeshScene, vertex: VertexId) -> Vec<Edge> {
    if !scene.in_file.is_several(vertex) {
        return Vec::new();
    }
    let seams = scene.model.prepared.form.seams.all_listed();
    let stretches: BTreeSet<Edge> = seams.stretches_through(vertex).into_iter().collect();
    let is_of_stretch = |side: &&Edge| match side.map(|end| scene.in_file.vertex(end)) {
        [Some(a), Some(b)] => stretches.contains(&[a.min(b), a.max(b)]),
        _ => false,
    };
    scene.seams.ends.iter().filter(is_of_stretch).copied().collect()
}
