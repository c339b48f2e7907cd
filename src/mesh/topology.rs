//! How the faces of any triangle mesh hang together: edges, fans, components and boundary loops.
//!
//! Nothing is asked of the mesh but that every face has three different, existing vertices.
//!
//! A *fan* is a set of corners at one vertex that are joined across edges. Corners are numbered like the sides that
//! leave them: `3 f + k`. A vertex of a manifold has one fan; a vertex with more could be split into one vertex per
//! fan, and the genus is counted as if it were.

use super::edges::{EdgeTable, side_ends};
use super::union::DisjointSets;
use super::{FaceId, VertexId};

/// No label.
const NONE: u32 = u32::MAX;

/// One boundary loop: its vertices in order, and the component it belongs to.
#[derive(Debug)]
pub(super) struct Loop {
    pub(super) vertices: Vec<VertexId>,
    pub(super) component: usize,
}

/// One component, counted as if vertices with several fans were split.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Component {
    pub(super) first_face: FaceId,
    pub(super) faces: usize,
    pub(super) loops: usize,
    edges: usize,
    fans: usize,
    /// Pieces that are left when vertices with several fans are split.
    parts: usize,
}

impl Component {
    /// Number of handles, provided that the component is an orientable 2-manifold once its vertices are split.
    pub(super) fn genus(&self) -> usize {
        (2 * self.parts + self.edges).saturating_sub(self.loops + self.fans + self.faces) / 2
    }
}

/// Everything that the edge table says about a mesh.
#[derive(Debug)]
pub(super) struct Topology {
    pub(super) table: EdgeTable,
    /// Sides without a partner.
    pub(super) boundary: Vec<u32>,
    /// Pairs of sides that run along their edge in the same direction.
    pub(super) clashes: Vec<[u32; 2]>,
    /// Ends of the edges with three faces or more.
    pub(super) crowded_edges: Vec<[VertexId; 2]>,
    /// Vertices with more than one fan.
    pub(super) split_vertices: Vec<VertexId>,
    /// Vertices of no face.
    pub(super) unreferenced: Vec<VertexId>,
    pub(super) components: Vec<Component>,
    pub(super) loops: Vec<Loop>,
    pub(super) referenced_count: usize,
}

impl Topology {
    /// Explores the mesh that `table` was made from.
    pub(super) fn explore(table: EdgeTable, vertex_count: usize, triangles: &[[VertexId; 3]]) -> Self {
        let mut fans = Fans::new(vertex_count, triangles);
        let mut topology = Self {
            table,
            boundary: Vec::new(),
            clashes: Vec::new(),
            crowded_edges: Vec::new(),
            split_vertices: Vec::new(),
            unreferenced: Vec::new(),
            components: Vec::new(),
            loops: Vec::new(),
            referenced_count: 0,
        };
        for sides in topology.table.edges() {
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
        for (v, &fan_count) in fans.count.iter().enumerate() {
            match fan_count {
                0 => topology.unreferenced.push(VertexId::from_index(v)),
                1 => {}
                _ => topology.split_vertices.push(VertexId::from_index(v)),
            }
        }
        topology.referenced_count = vertex_count - topology.unreferenced.len();
        topology.find_components(triangles, &mut fans);
        topology
    }

    fn find_components(&mut self, triangles: &[[VertexId; 3]], fans: &mut Fans<'_>) {
        let labels = label_vertices(fans.count.len(), triangles);
        let component_count = labels.iter().filter(|&&label| label != NONE).max().map_or(0, |&top| top as usize + 1);
        self.components = vec![Component::default(); component_count];
        let label = |v: VertexId| labels[v.index()] as usize;
        for (f, triangle) in triangles.iter().enumerate() {
            let component = &mut self.components[label(triangle[0])];
            if component.faces == 0 {
                component.first_face = FaceId::from_index(f);
            }
            component.faces += 1;
        }
        for sides in self.table.edges() {
            self.components[label(side_ends(triangles, sides[0]).0)].edges += 1;
        }
        for (&count, &label) in fans.count.iter().zip(&labels) {
            if label != NONE {
                self.components[label as usize].fans += count as usize;
            }
        }
        if self.split_vertices.is_empty() {
            self.components.iter_mut().for_each(|component| component.parts = 1);
        } else {
            for corner in fans.parts() {
                self.components[label(side_ends(triangles, corner).0)].parts += 1;
            }
        }
        self.loops = walk_boundary(&self.boundary, triangles, fans);
        for boundary_loop in &mut self.loops {
            boundary_loop.component = label(boundary_loop.vertices[0]);
            self.components[boundary_loop.component].loops += 1;
        }
    }
}

/// Numbers the components by their first face; one label per vertex.
fn label_vertices(vertex_count: usize, triangles: &[[VertexId; 3]]) -> Vec<u32> {
    let mut sets = DisjointSets::new(vertex_count);
    for &[a, b, c] in triangles {
        sets.join(a.number(), b.number());
        sets.join(b.number(), c.number());
    }
    let mut labels = vec![NONE; vertex_count];
    let mut next = 0;
    for corner in triangles.iter().flatten() {
        if labels[corner.index()] != NONE {
            continue;
        }
        let root = sets.find(corner.number()) as usize;
        if labels[root] == NONE {
            labels[root] = next;
            next += 1;
        }
        labels[corner.index()] = labels[root];
    }
    labels
}

/// Corners that are joined across edges, and how many fans each vertex has.
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

    /// One corner of each piece that is left when vertices with several fans are split.
    fn parts(&self) -> Vec<u32> {
        let mut sets = self.sets.clone();
        let corner_count = u32::try_from(3 * self.triangles.len()).expect("sides fit");
        for corner in (0..corner_count).step_by(3) {
            sets.join(corner, corner + 1);
            sets.join(corner, corner + 2);
        }
        (0..corner_count).filter(|&corner| sets.find(corner) == corner).collect()
    }
}

/// The corner that a side runs to.
fn head_corner(side: u32) -> u32 {
    side - side % 3 + (side + 1) % 3
}

/// Follows the boundary edges from fan to fan. On a manifold every walk is one loop, in order; elsewhere it is one
/// connected part of the boundary.
fn walk_boundary(boundary: &[u32], triangles: &[[VertexId; 3]], fans: &mut Fans<'_>) -> Vec<Loop> {
    let mut ends: Vec<[u32; 2]> = Vec::with_capacity(boundary.len());
    for &side in boundary {
        ends.push([fans.sets.find(side), fans.sets.find(head_corner(side))]);
    }
    // Boundary edges by the fans at their ends.
    let mut at_fan: Vec<(u32, usize)> =
        ends.iter().enumerate().flat_map(|(edge, pair)| pair.map(|fan| (fan, edge))).collect();
    at_fan.sort_unstable();
    let mut seen = vec![false; boundary.len()];
    let mut loops = Vec::new();
    for start in 0..boundary.len() {
        let mut vertices = Vec::new();
        // Edge to visit next, and the fan that the walk comes from.
        let mut stack = vec![(start, ends[start][0])];
        while let Some((edge, entry)) = stack.pop() {
            if std::mem::replace(&mut seen[edge], true) {
                continue;
            }
            vertices.push(side_ends(triangles, entry).0);
            let [tail, head] = ends[edge];
            for fan in if entry == tail { [tail, head] } else { [head, tail] } {
                let first = at_fan.partition_point(|&(other, _)| other < fan);
                let here = at_fan[first..].iter().take_while(|&&(other, _)| other == fan);
                stack.extend(here.filter(|&&(_, next)| !seen[next]).map(|&(_, next)| (next, fan)));
            }
        }
        if !vertices.is_empty() {
            loops.push(Loop { vertices, component: 0 });
        }
    }
    loops
}
