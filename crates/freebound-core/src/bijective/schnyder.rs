//! Schnyder's grid drawing: a planar embedding of any disk in small whole numbers, exact by theorem.
//!
//! W. Schnyder, "Embedding planar graphs on the grid" (1990): the vertices of a triangulation of the sphere can be
//! placed on an (n − 2) × (n − 2) grid such that straight edges do not cross. A cone over the boundary turns any disk
//! into such a triangulation; the cone is removed afterwards. Whole numbers of that size are exact in 64 bits, and in
//! 32 bits as well.
//!
//! The vertices are processed in *canonical order* (de Fraysseix, Pach, Pollack 1990): they are removed one by one
//! from the outside, and a simple contour always bounds the remainder. Each vertex then has an edge to the left and an
//! edge to the right neighbour on the contour below it, and an edge to the vertex above that covered it. These edges
//! form three trees, which give three paths from each vertex to the roots. The grid coordinates of a vertex count the
//! vertices between its paths. The total time is linear.

use std::collections::VecDeque;

use glam::DVec2;

use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// Planar embedding with whole numbers from 0 to the number of vertices as coordinates. Every face is positive and the
/// boundary is simple: by theorem, without rounding.
pub fn schnyder(mesh: &DiskMesh) -> Embedding {
    Wood::new(mesh).on_grid()
}

/// Parent of a root.
const NONE: usize = usize::MAX;

/// Three trees over the vertices of the mesh and the apex of the cone, which comes last. Their roots are the ends of
/// the first boundary edge and the apex.
#[derive(Debug)]
struct Wood {
    /// Parent of each vertex, per tree.
    parents: [Vec<usize>; 3],
    /// Vertices other than the roots, in order of removal from the outside.
    peeled: Vec<usize>,
    roots: [usize; 3],
}

impl Wood {
    fn new(mesh: &DiskMesh) -> Self {
        let boundary = mesh.boundary_loop();
        let apex = mesh.vertex_count();
        let mut contour = Contour::new(mesh);
        let mut parents = [(); 3].map(|()| vec![NONE; apex + 1]);
        for vertex in &boundary[2..] {
            parents[2][vertex.index()] = apex;
        }
        let mut peeled = Vec::with_capacity(apex);
        while let Some((vertex, below)) = contour.peel(mesh) {
            let (&left, &right) = (below.first().expect("a left neighbour"), below.last().expect("a right neighbour"));
            (parents[0][vertex], parents[1][vertex]) = (left, right);
            for &covered in &below[1..below.len() - 1] {
                parents[2][covered] = vertex;
            }
            peeled.push(vertex);
        }
        Self { parents, peeled, roots: [boundary[0].index(), boundary[1].index(), apex] }
    }

    /// Vertices of a tree without its root, each after its parent.
    fn down(&self, tree: usize) -> Box<dyn DoubleEndedIterator<Item = usize> + '_> {
        let peeled = self.peeled.iter().copied();
        if tree == 2 { Box::new(peeled) } else { Box::new(peeled.rev()) }
    }

    /// Number of vertices in the subtree of each vertex, itself included.
    fn subtree_sizes(&self, tree: usize) -> Vec<i64> {
        let mut sizes = vec![1; self.parents[tree].len()];
        for vertex in self.down(tree).rev() {
            sizes[self.parents[tree][vertex]] += sizes[vertex];
        }
        sizes
    }

    /// Sum of a quantity over the path from each vertex to the root of a tree, both ends included.
    fn path_sums(&self, tree: usize, quantity: impl Fn(usize) -> i64) -> Vec<i64> {
        let mut sums: Vec<i64> = (0..self.parents[tree].len()).map(quantity).collect();
        for vertex in self.down(tree) {
            sums[vertex] += sums[self.parents[tree][vertex]];
        }
        sums
    }

    /// Coordinate of every vertex except the roots: number of vertices between its paths in the two other trees.
    /// Vertices on the path in the preceding tree do not count.
    fn coordinate(&self, tree: usize) -> Vec<i64> {
        let (after, before) = ((tree + 1) % 3, (tree + 2) % 3);
        let sizes = self.subtree_sizes(tree);
        // The paths end at the roots of the other trees. These have no children in this tree and count as one vertex.
        let left = self.path_sums(after, |vertex| sizes[vertex]);
        let right = self.path_sums(before, |vertex| sizes[vertex] - 1);
        (0..sizes.len()).map(|vertex| left[vertex] + right[vertex] - sizes[vertex]).collect()
    }

    /// Embedding without the apex.
    fn on_grid(&self) -> Embedding {
        let [mut x, mut y] = [0, 1].map(|tree| self.coordinate(tree));
        let far = i64::try_from(self.peeled.len() + 1).expect("a count of vertices fits");
        let [first, second, _] = self.roots;
        (x[first], y[first]) = (far, 1);
        (x[second], y[second]) = (0, far);
        let apex = self.roots[2];
        x.iter().zip(&y).take(apex).map(|(&x, &y)| DVec2::new(x as f64, y as f64)).collect()
    }
}

/// Contour of the vertices not yet removed: a path from the first root to the second.
#[derive(Debug)]
struct Contour {
    left: Vec<usize>,
    right: Vec<usize>,
    state: Vec<State>,
    /// Number of chords per vertex: edges to contour vertices that are not its neighbours on the contour.
    chords: Vec<u32>,
    /// Candidates for removal: vertices without a chord when they were added.
    free: VecDeque<usize>,
    ends: [usize; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Inside,
    OnContour,
    Peeled,
}

impl Contour {
    /// Whole boundary as a contour, from its first vertex backwards to its second.
    fn new(mesh: &DiskMesh) -> Self {
        let boundary: Vec<usize> = mesh.boundary_loop().iter().map(|v| v.index()).collect();
        let count = mesh.vertex_count();
        let mut contour = Self {
            left: vec![NONE; count],
            right: vec![NONE; count],
            state: vec![State::Inside; count],
            chords: vec![0; count],
            free: boundary[2..].iter().copied().collect(),
            ends: [boundary[0], boundary[1]],
        };
        for place in 1..boundary.len() {
            let (left, right) = (boundary[(place + 1) % boundary.len()], boundary[place]);
            contour.join(left, right);
        }
        for &vertex in &boundary {
            contour.enter(mesh, vertex);
        }
        contour
    }

    fn join(&mut self, left: usize, right: usize) {
        self.right[left] = right;
        self.left[right] = left;
    }

    /// Adds a vertex, already joined to its neighbours, to the contour and counts its chords.
    fn enter(&mut self, mesh: &DiskMesh, vertex: usize) {
        for other in neighbours(mesh, vertex) {
            let is_beside = [self.left[vertex], self.right[vertex]].contains(&other);
            let is_base = self.ends.contains(&vertex) && self.ends.contains(&other);
            if self.state[other] == State::OnContour && !is_beside && !is_base {
                self.chords[vertex] += 1;
                self.chords[other] += 1;
            }
        }
        self.state[vertex] = State::OnContour;
    }

    /// Removes a vertex. Returns it with its neighbours on the new contour, from left to right.
    fn peel(&mut self, mesh: &DiskMesh) -> Option<(usize, Vec<usize>)> {
        let vertex = loop {
            let vertex = self.free.pop_front()?;
            if self.state[vertex] == State::OnContour && self.chords[vertex] == 0 {
                break vertex;
            }
        };
        self.state[vertex] = State::Peeled;
        let left = self.left[vertex];
        let mut below: Vec<usize> = neighbours(mesh, vertex).filter(|&v| self.state[v] != State::Peeled).collect();
        let first = below.iter().position(|&v| v == left).expect("the left neighbour is one");
        below.rotate_left(first);
        for pair in below.windows(2) {
            self.join(pair[0], pair[1]);
        }
        let covered = &below[1..below.len() - 1];
        for &covered in covered {
            self.enter(mesh, covered);
        }
        if covered.is_empty() {
            self.lose_chord(&below);
        }
        let has_no_chord = |v: &usize| self.chords[*v] == 0;
        let free: Vec<usize> = covered.iter().copied().filter(has_no_chord).collect();
        self.free.extend(free);
        Some((vertex, below))
    }

    /// Drops the chord between two vertices that have become neighbours on the contour.
    fn lose_chord(&mut self, ends: &[usize]) {
        if ends.iter().all(|v| self.ends.contains(v)) {
            return;
        }
        for &end in ends {
            self.chords[end] -= 1;
            if self.chords[end] == 0 && !self.ends.contains(&end) {
                self.free.push_back(end);
            }
        }
    }
}

/// Neighbours of a vertex, counter-clockwise. At a boundary vertex they run from the next vertex of the loop to the
/// previous.
fn neighbours(mesh: &DiskMesh, vertex: usize) -> impl Iterator<Item = usize> + '_ {
    mesh.outgoing(VertexId::from_index(vertex)).map(|halfedge| mesh.head(halfedge).index())
}
