//! Schnyder's grid drawing: a planar embedding of any disk in small whole numbers, exact by theorem.
//!
//! W. Schnyder, "Embedding planar graphs on the grid" (1990): the vertices of a triangulation of the sphere can be laid
//! on the points of an (n − 2) × (n − 2) grid so that all edges, drawn straight, keep apart. A cone over the boundary
//! makes such a triangulation of a disk, whatever the disk is; the cone is taken away again. Whole numbers of that size
//! are exact in 64 bits, and in 32 as well.
//!
//! The vertices come in *canonical order* (de Fraysseix, Pach, Pollack 1990): taken away one by one from the outside, so
//! that what remains is bounded by a simple contour. Each vertex then has an edge to the left and one to the right of the
//! contour below it, and one to the vertex above that covered it: three trees, and three paths from each vertex to their
//! roots. The grid's coordinates of a vertex count the vertices between these paths. All of it takes linear time.

use std::collections::VecDeque;

use glam::DVec2;

use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// A planar embedding with whole numbers for coordinates, from 0 to the number of vertices. Every face is positive and
/// the boundary simple: by theorem, without rounding.
pub fn schnyder(mesh: &DiskMesh) -> Embedding {
    Wood::new(mesh).on_grid()
}

/// No parent: a root.
const NONE: usize = usize::MAX;

/// Three trees over the vertices of the mesh and the apex of the cone over its boundary, which comes last. Their roots
/// are the first boundary edge's ends and the apex.
#[derive(Debug)]
struct Wood {
    /// Per tree, the parent of each vertex.
    parents: [Vec<usize>; 3],
    /// The vertices that are no roots, in the order in which they are taken away from the outside.
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

    /// Vertices of a tree but its root, each after its parent.
    fn down(&self, tree: usize) -> Box<dyn DoubleEndedIterator<Item = usize> + '_> {
        let peeled = self.peeled.iter().copied();
        if tree == 2 { Box::new(peeled) } else { Box::new(peeled.rev()) }
    }

    /// How many vertices of a tree lie below each vertex, itself included.
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

    /// A coordinate of every vertex but the roots: the vertices between the paths along the two other trees, without
    /// those of the path along the tree before.
    fn coordinate(&self, tree: usize) -> Vec<i64> {
        let (after, before) = ((tree + 1) % 3, (tree + 2) % 3);
        let sizes = self.subtree_sizes(tree);
        // The other trees' roots, where the paths end, have no children in this tree: they count as one vertex.
        let left = self.path_sums(after, |vertex| sizes[vertex]);
        let right = self.path_sums(before, |vertex| sizes[vertex] - 1);
        (0..sizes.len()).map(|vertex| left[vertex] + right[vertex] - sizes[vertex]).collect()
    }

    /// The embedding without the apex.
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

/// The outline of what has not been taken away yet: a path from the first root to the second.
#[derive(Debug)]
struct Contour {
    left: Vec<usize>,
    right: Vec<usize>,
    state: Vec<State>,
    /// Edges between vertices of the contour that are not neighbours on it, per vertex.
    chords: Vec<u32>,
    /// Vertices that had no chord when they were put here.
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
    /// The whole boundary, from its first vertex backwards to its second.
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

    /// Puts a vertex, joined already, on the contour and counts its chords.
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

    /// Takes a vertex away. Returns it with its neighbours of the new contour, from left to right.
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

    /// A chord between two vertices that have become neighbours on the contour.
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

/// Neighbours of a vertex, counter-clockwise; at a boundary vertex from the next one of the loop to the one before.
fn neighbours(mesh: &DiskMesh, vertex: usize) -> impl Iterator<Item = usize> + '_ {
    mesh.outgoing(VertexId::from_index(vertex)).map(|halfedge| mesh.head(halfedge).index())
}
