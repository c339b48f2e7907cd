//! Faces to flip for a consistent orientation, if there is one.
//!
//! Two faces that share an edge agree if they run along it in opposite directions. Agreement is propagated across
//! edges with exactly two faces. A contradiction around a closed chain of faces makes the patch one-sided, like a
//! Möbius strip.

use super::edges::side_ends;
use super::topology::Topology;
use super::union::ParitySets;
use super::{FaceId, VertexId};

#[derive(Debug, Default)]
pub(super) struct Orientation {
    /// Edges with a clash in orientable patches.
    pub(super) mixed_edges: Vec<[VertexId; 2]>,
    /// Faces to flip in orientable patches: the smaller side of each patch.
    pub(super) turn: Vec<FaceId>,
    /// Edges with a clash in patches that cannot be oriented.
    pub(super) one_sided_edges: Vec<[VertexId; 2]>,
}

impl Orientation {
    /// Examines every patch that has a clash.
    pub(super) fn inspect(topology: &Topology, triangles: &[[VertexId; 3]]) -> Self {
        let mut found = Self::default();
        if topology.clashes.is_empty() {
            return found;
        }
        let mut sets = ParitySets::new(triangles.len());
        let mut contradictions = Vec::new();
        for sides in topology.table.edges() {
            let &[a, b] = sides else { continue };
            let clash = side_ends(triangles, a).0 == side_ends(triangles, b).0;
            if sets.relate(a / 3, b / 3, clash) {
                contradictions.push(a / 3);
            }
        }
        let mut one_sided = vec![false; triangles.len()];
        for face in contradictions {
            one_sided[sets.find(face).0 as usize] = true;
        }
        for &[a, _] in &topology.clashes {
            let (tail, head) = side_ends(triangles, a);
            let edges = if one_sided[sets.find(a / 3).0 as usize] {
                &mut found.one_sided_edges
            } else {
                &mut found.mixed_edges
            };
            edges.push([tail.min(head), tail.max(head)]);
        }
        found.turn = fewer_side(&mut sets, &one_sided);
        found
    }
}

/// Faces of the smaller parity class of each two-sided patch; at a tie, the class without its first face.
fn fewer_side(sets: &mut ParitySets, one_sided: &[bool]) -> Vec<FaceId> {
    let faces = 0..u32::try_from(one_sided.len()).expect("faces fit");
    let mut sizes = vec![[0_u32; 2]; one_sided.len()];
    for face in faces.clone() {
        let (root, odd) = sets.find(face);
        sizes[root as usize][usize::from(odd)] += 1;
    }
    let to_turn = |face: &u32| {
        let (root, odd) = sets.find(*face);
        let [even_count, odd_count] = sizes[root as usize];
        // The first face is the root, because the lower root represents both sets after a join.
        !one_sided[root as usize] && if odd { odd_count <= even_count } else { even_count < odd_count }
    };
    faces.filter(to_turn).map(FaceId::new).collect()
}
