//! Triangles of one round of collapses, with those of the outside, and the neighbours of each vertex.

use glam::DVec2;

use crate::geom::outside_triangles;
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::{FRAME_POINTS, frame_around};

/// Criterion for the validity of a surface while vertices are removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guide {
    /// Planar embedding: triangles stay positive, including those of the outside.
    Plane,
    /// Surface alone: no edge is doubled.
    Space,
}

/// Surface, in the plane with its outside up to a frame. Vertices have their numbers in the input mesh; points of the
/// frame follow.
pub(super) struct Surface<'a> {
    pub(super) mesh: &'a DiskMesh,
    pub(super) guide: Guide,
    /// Positions in the plane. Meaningless for [`Guide::Space`].
    pub(super) points: Vec<DVec2>,
    /// Triangles of the surface. Virtual ones, which fill holes, come last.
    pub(super) inner: Vec<[u32; 3]>,
    /// Boundary, counter-clockwise.
    pub(super) boundary: Vec<u32>,
    /// Triangles of the outside. Empty if it cannot be triangulated.
    outer: Vec<[u32; 3]>,
    stars: Stars,
}

/// Triangles of each vertex, inner ones first.
#[derive(Default)]
struct Stars {
    starts: Vec<u32>,
    faces: Vec<u32>,
}

/// Neighbours of a vertex, counter-clockwise. At a boundary vertex the first is the next vertex of the boundary, and
/// those of the outside come last. For [`Guide::Space`] there is no outside, and the last is the previous boundary
/// vertex.
#[derive(Default)]
pub(super) struct Ring {
    pub(super) vertices: Vec<u32>,
    /// Number of its triangles that belong to the surface.
    pub(super) inner: usize,
    /// Sides opposite the vertex, in any order, those of the surface first.
    sides: Vec<[u32; 2]>,
}

impl Ring {
    pub(super) fn len(&self) -> usize {
        self.vertices.len()
    }

    /// True if the ring belongs to a boundary vertex.
    pub(super) fn is_of_boundary(&self) -> bool {
        self.inner < self.len()
    }

    /// Neighbour at a place, counted cyclically.
    pub(super) fn at(&self, place: usize) -> u32 {
        self.vertices[place % self.len()]
    }
}

impl<'a> Surface<'a> {
    /// Faces of a mesh in an embedding.
    pub(super) fn new(mesh: &'a DiskMesh, embedding: &[DVec2]) -> Self {
        let inner = mesh.faces().map(|face| mesh.face(face).map(VertexId::number)).collect();
        let boundary: Vec<u32> = mesh.boundary_loop().iter().map(|v| v.number()).collect();
        let mut points = embedding.to_vec();
        points.extend(frame_around(boundary.iter().map(|&v| embedding[v as usize]), FRAME_POINTS));
        Self { mesh, guide: Guide::Plane, points, inner, boundary, outer: Vec::new(), stars: Stars::default() }
    }

    /// Faces of a mesh without an embedding.
    pub(super) fn alone(mesh: &'a DiskMesh) -> Self {
        let nowhere = vec![DVec2::ZERO; mesh.vertex_count()];
        Self { guide: Guide::Space, points: nowhere.clone(), ..Self::new(mesh, &nowhere) }
    }

    /// Number of vertices of the input mesh. Higher numbers are points of the frame.
    pub(super) fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }

    /// Triangulates the outside, and finds the triangles at each vertex.
    pub(super) fn look_around(&mut self) {
        if self.guide == Guide::Plane {
            self.outer = self.outside();
        }
        self.stars = Stars::of(&self.inner, &self.outer, self.points.len());
    }

    fn outside(&self) -> Vec<[u32; 3]> {
        let polygon: Vec<DVec2> = self.boundary.iter().map(|&v| self.points[v as usize]).collect();
        let frame = &self.points[self.vertex_count()..];
        let (first, count) = (number(self.vertex_count()), number(polygon.len()));
        let vertex =
            |corner: u32| self.boundary.get(corner as usize).copied().unwrap_or_else(|| first + corner - count);
        let outer = outside_triangles(&polygon, frame).unwrap_or_default();
        outer.into_iter().map(|corners| corners.map(vertex)).collect()
    }

    /// True if an edge joins two vertices.
    pub(super) fn are_joined(&self, v: u32, u: u32) -> bool {
        self.stars.of_vertex(v).iter().any(|&face| self.inner[face as usize].contains(&u))
    }

    /// Finds the neighbours of a vertex. Returns true if they form a closed ring, or, at a boundary vertex with
    /// [`Guide::Space`], a single fan.
    pub(super) fn find_ring(&self, v: u32, ring: &mut Ring) -> bool {
        ring.sides.clear();
        ring.vertices.clear();
        ring.inner = 0;
        for &face in self.stars.of_vertex(v) {
            let outer = (face as usize).checked_sub(self.inner.len());
            let [a, b, c] = outer.map_or_else(|| self.inner[face as usize], |face| self.outer[face]);
            ring.inner += usize::from(outer.is_none());
            ring.sides.push(if a == v {
                [b, c]
            } else if b == v {
                [c, a]
            } else {
                [a, b]
            });
        }
        let (inner, all) = (&ring.sides[..ring.inner], &ring.sides);
        let begins = |&&[from, _]: &&[u32; 2]| inner.iter().all(|[_, to]| *to != from);
        let Some(&[first, mut to]) = inner.iter().find(begins).or(inner.first()) else { return false };
        ring.vertices.push(first);
        if self.guide == Guide::Space && inner.iter().all(|[_, to]| *to != first) {
            ring.vertices.push(to);
            while let Some(&[_, next]) = inner.iter().find(|[from, _]| *from == to) {
                if ring.vertices.len() > ring.inner {
                    return false;
                }
                to = next;
                ring.vertices.push(to);
            }
            return ring.vertices.len() == ring.inner + 1;
        }
        while to != first && ring.vertices.len() < all.len() {
            ring.vertices.push(to);
            // Sides of the surface come first and are consecutive.
            let Some(&[_, next]) = all.iter().find(|[from, _]| *from == to) else { return false };
            to = next;
        }
        to == first && ring.vertices.len() == all.len()
    }
}

impl Stars {
    fn of(inner: &[[u32; 3]], outer: &[[u32; 3]], count: usize) -> Self {
        let mut starts = vec![0_u32; count + 1];
        let corners = || inner.iter().chain(outer).flatten().map(|&v| v as usize);
        corners().for_each(|v| starts[v + 1] += 1);
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut faces = vec![0_u32; starts[count] as usize];
        for (at, v) in corners().enumerate() {
            faces[next[v] as usize] = number(at / 3);
            next[v] += 1;
        }
        Self { starts, faces }
    }

    fn of_vertex(&self, v: u32) -> &[u32] {
        &self.faces[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }
}

fn number(count: usize) -> u32 {
    u32::try_from(count).expect("corners of a mesh are counted in 32 bits")
}
