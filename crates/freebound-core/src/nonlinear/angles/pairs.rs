//! Angles that the multipliers of ABF are eliminated with.
//!
//! A multiplier has no curvature. Its pivot comes from an angle that its condition depends on and that is eliminated
//! right before it. All these angles must differ. A face has three angles and at most three multipliers: its own, and
//! two for a vertex that chooses the face. So it is enough that vertices choose different faces.
//!
//! They do. From each inner vertex v an edge leads one step nearer to the boundary, and v chooses the face to its
//! left. Suppose that both a and b choose a face (a, b, c). Then b is a step nearer than a, and c a step nearer than
//! b. But a and c are neighbours, and cannot lie two steps apart.

use std::collections::VecDeque;

use super::net::Net;
use crate::mesh::VertexId;

/// Paired angles by their numbers, 3 · face + corner.
#[derive(Debug)]
pub(super) struct Pairs {
    /// Angle of each face's multiplier.
    pub(super) of_faces: Vec<usize>,
    /// Angles of each inner vertex, for its sum and for its wheel.
    pub(super) of_vertices: Vec<[usize; 2]>,
}

impl Pairs {
    pub(super) fn new(net: &Net<'_>) -> Self {
        let widest = |angles: &[f64; 3]| {
            if angles[0] >= angles[1].max(angles[2]) { 0 } else { 1 + usize::from(angles[2] > angles[1]) }
        };
        let mut of_faces: Vec<usize> =
            net.targets.iter().enumerate().map(|(face, angles)| 3 * face + widest(angles)).collect();
        let steps = steps_to_boundary(net);
        let mut of_vertices = Vec::with_capacity(net.inner.len());
        for &vertex in &net.inner {
            let is_nearer = |&h: &_| steps[net.mesh.head(h).index()] < steps[vertex.index()];
            let nearer = net.mesh.outgoing(vertex).find(is_nearer).expect("the boundary is some steps away");
            // An inner halfedge leaves the corner with its own number.
            let (face, corner) = (nearer.index() / 3, nearer.index() % 3);
            let [after, before] = [(corner + 1) % 3, (corner + 2) % 3];
            // The wheel hardly depends on an angle near π/2.
            let says_much = |k: usize| net.targets[face][k] * net.targets[face][k].tan().recip().abs();
            let [own, other] = if says_much(after) >= says_much(before) { [after, before] } else { [before, after] };
            of_vertices.push([corner, own].map(|k| 3 * face + k));
            of_faces[face] = 3 * face + other;
        }
        Self { of_faces, of_vertices }
    }
}

/// Number of edges from each vertex to the boundary.
fn steps_to_boundary(net: &Net<'_>) -> Vec<u32> {
    let mut steps = vec![u32::MAX; net.mesh.vertex_count()];
    let mut queue: VecDeque<VertexId> = net.mesh.boundary_loop().iter().copied().collect();
    for vertex in &queue {
        steps[vertex.index()] = 0;
    }
    while let Some(vertex) = queue.pop_front() {
        for head in net.mesh.outgoing(vertex).map(|h| net.mesh.head(h)) {
            if steps[head.index()] == u32::MAX {
                steps[head.index()] = steps[vertex.index()] + 1;
                queue.push_back(head);
            }
        }
    }
    steps
}
