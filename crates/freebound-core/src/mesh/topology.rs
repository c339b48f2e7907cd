//! Topology of any triangle mesh: edges, fans, components and boundary loops.
//!
//! The only requirement is that every face has three different, existing vertices.
//!
//! A *fan* is a set of corners at one vertex that are connected across edges. Corners are numbered like the sides that
//! leave them: `3 f + k`. A vertex of a manifold has one fan; a vertex with more fans could be split into one vertex
//! per fan. Components, loops and genus are counted after such a split: a *component* is connected across edges.

use super::edges::{EdgeTable, side_ends};
use super::union::DisjointSets;
use super::{FaceId, VertexId};

/// Boundary loop: its vertices in order, and its component.
#[derive(Debug)]
pub(super) struct Loop {
    pub(super) vertices: Vec<VertexId>,
    pub(super) component: usize,
    first_side: u32,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Component {
    pub(super) first_face: FaceId,
    pub(super) faces: usize,
    pub(super) loops: usize,
    edges: usize,
    fans: usize,
}

impl Component {
    /// Number of handles, if the component is an orientable 2-manifold once its vertices are split.
    pub(super) fn genus(&self) -> usize {
        (2 + self.edges).saturating_sub(self.loops + self.fans + self.faces) / 2
    }
}

#[derive(Debug, Default)]
pub(super) struct Topology {
    pub(super) table: EdgeTable,
    /// Sides without a partner.
    pub(super) boundary: Vec<u32>,
    /// Pairs of sides that run along their edge in one direction.
    pub(super) clashes: Vec<[u32; 2]>,
    /// Ends of the edges with three or more faces.
    pub(super) crowded_edges: Vec<[VertexId; 2]>,
    pub(super) split_vertices: Vec<VertexId>,
    pub(super) unreferenced: Vec<VertexId>,
    pub(super) components: Vec<Component>,
    pub(super) loops: Vec<Loop>,
    pub(super) referenced_count: usize,
}

impl Topology {
    pub(super) fn explore(table: EdgeTable, vertex_count: usize, triangles: &[[VertexId; 3]]) -> Self {
        let mut fans = Fans::new(vertex_count, triangles);
        let mut topology = Self::default();
        let look_at_edges = || {
            for sides in table.edges() {
                let (tail, head) = side_ends(triangles, sides[0]);
                match *sides {
                    [side] => topology.boundary.push(side),
                    [a, b] if tail == side_ends(triangles, b).0 => topology.clashes.push([a, b]),
                    [_, _] => {}
                    _ => topology.crowded_edges.push([tail.min(head), tail.max(head)]),
                }
                for pair in sides.windows(2) {
                    fans.join_across(pair[0], pair[1]);
                }
            }
        };
        let ((), labels) = crate::parallel::join(look_at_edges, || label_faces(&table, triangles.len()));
        topology.table = table;
        for (v, &fan_count) in fans.count.iter().enumerate() {
            match fan_count {
                0 => topology.unreferenced.push(VertexId::from_index(v)),
                1 => {}
                _ => topology.split_vertices.push(VertexId::from_index(v)),
            }
        }
        topology.referenced_count = vertex_count - topology.unreferenced.len();
        topology.find_components(&labels, triangles, &mut fans);
        topology
    }

    fn find_components(&mut self, labels: &[u32], triangles: &[[VertexId; 3]], fans: &mut Fans<'_>) {
        let label = |side: u32| labels[side as usize / 3] as usize;
        for (f, &label) in labels.iter().enumerate() {
            if label as usize == self.components.len() {
                self.components.push(Component { first_face: FaceId::from_index(f), ..Component::default() });
            }
            self.components[label as usize].faces += 1;
        }
        for sides in self.table.edges() {
            self.components[label(sides[0])].edges += 1;
        }
        for corner in fans.sets.roots() {
            self.components[label(corner)].fans += 1;
        }
        self.loops = walk_boundary(&self.boundary, triangles, fans);
        for boundary_loop in &mut self.loops {
            boundary_loop.component = label(boundary_loop.first_side);
            self.components[boundary_loop.component].loops += 1;
        }
    }
}

/// Numbers the components in the order of their first faces. Returns one label per face.
fn label_faces(table: &EdgeTable, face_count: usize) -> Vec<u32> {
    let mut sets = DisjointSets::new(face_count);
    for sides in table.edges() {
        for pair in sides.windows(2) {
            sets.join(pair[0] / 3, pair[1] / 3);
        }
    }
    let mut labels = Vec::with_capacity(face_count);
    let mut next = 0;
    for face in 0..u32::try_from(face_count).expect("faces fit") {
        let root = sets.find(face);
        // The root is the lowest face of its set, so it comes first.
        labels.push(if root == face { next } else { labels[root as usize] });
        next += u32::from(root == face);
    }
    labels
}

/// Corners connected across edges, and the number of fans of each vertex.
struct Fans<'a> {
    triangles: &'a [[VertexId; 3]],
    sets: DisjointSets,
    count: Vec<u32>,
}

impl<'a> Fans<'a> {
    fn new(vertex_count: usize, triangles: &'a [[VertexId; 3]]) -> Self {
        let mut count = vec![0; vertex_count];
        for corner in triangles.iter().flatten() {
            count[corner.index()] += 1;
        }
        Self { triangles, sets: DisjointSets::new(3 * triangles.len()), count }
    }

    /// Joins the corners at both ends of an edge that two sides share.
    fn join_across(&mut self, a: u32, b: u32) {
        let (tail_a, tail_b) = (side_ends(self.triangles, a).0, side_ends(self.triangles, b).0);
        let (same, other) = if tail_a == tail_b { (b, head_corner(b)) } else { (head_corner(b), b) };
        for (x, y) in [(a, same), (head_corner(a), other)] {
            if self.sets.join(x, y) {
                self.count[side_ends(self.triangles, x).0.index()] -= 1;
            }
        }
    }
}

fn head_corner(side: u32) -> u32 {
    side - side % 3 + (side + 1) % 3
}

/// Walks the boundary edges from fan to fan. On a manifold each walk is a loop; elsewhere it is a connected part of
/// the boundary.
fn walk_boundary(boundary: &[u32], triangles: &[[VertexId; 3]], fans: &mut Fans<'_>) -> Vec<Loop> {
    let ends: Vec<[u32; 2]> =
        boundary.iter().map(|&side| [side, head_corner(side)].map(|corner| fans.sets.find(corner))).collect();
    // Boundary edges by the fans at their ends.
    let mut at_fan: Vec<(u32, usize)> =
        ends.iter().enumerate().flat_map(|(edge, pair)| pair.map(|fan| (fan, edge))).collect();
    at_fan.sort_unstable();
    let mut seen = vec![false; boundary.len()];
    // Indexed by the first entry of a fan in `at_fan`: true once its edges are on the stack.
    let mut expanded = vec![false; at_fan.len()];
    let mut loops = Vec::new();
    for start in 0..boundary.len() {
        let mut vertices = Vec::new();
        // Next edge to visit, and the fan from which the walk arrives.
        let mut stack = vec![(start, ends[start][0])];
        while let Some((edge, entry)) = stack.pop() {
            if std::mem::replace(&mut seen[edge], true) {
                continue;
            }
            vertices.push(side_ends(triangles, entry).0);
            let [tail, head] = ends[edge];
            for fan in if entry == tail { [tail, head] } else { [head, tail] } {
                let first = at_fan.partition_point(|&(other, _)| other < fan);
                if std::mem::replace(&mut expanded[first], true) {
                    continue;
                }
                let here = at_fan[first..].iter().take_while(|&&(other, _)| other == fan);
                stack.extend(here.filter(|&&(_, next)| !seen[next]).map(|&(_, next)| (next, fan)));
            }
        }
        if !vertices.is_empty() {
            loops.push(Loop { vertices, component: 0, first_side: boundary[start] });
        }
    }
    loops
}
