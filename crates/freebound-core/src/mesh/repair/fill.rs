//! Filling of holes with virtual faces, so that each part of the surface is a disk while it is flattened.
//!
//! # Method
//!
//! The longest boundary loop of each part, by the lengths of its edges, is the outer one; all other loops are holes.
//! Each hole gets the first of three fillings that fits:
//!
//! * A fan around a new vertex at the centre of the loop, if the loop is star-shaped from there in its best-fit plane.
//! * A triangulation of the loop as a polygon, if all its triangles have an area and none of its diagonals is an edge
//!   of the surface. A planar hole keeps its shape.
//! * A fan around a new vertex above the plane, so that its triangles have an area even if the loop is a slit.
//!
//! A part with handles or with one side only is not filled, because filling does not make it a disk. Such a part is
//! cut, and its holes are parts of the boundary.

use std::collections::HashSet;

use glam::DVec3;

use super::charts::parts_of;
use super::sides::{Sides, ascending};
use super::{Repair, Repaired};
use crate::mesh::polygons::newell_normal;
use crate::mesh::triangulate::triangulate;
use crate::mesh::{FIRST_HOLE, Part, TriMesh, VertexId, parts};

/// Smallest area relative to the squared longest side of a triangle, or to the squared length of a loop. Anything
/// smaller counts as zero.
const THINNEST: f64 = 1e-6;

/// Virtual vertices and faces that fill the holes of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Filling {
    /// New vertices, numbered after the vertices of the surface.
    centres: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    /// Hole of each triangle, counted from 0.
    hole_of: Vec<u32>,
}

impl Repaired {
    /// Fills all holes if that is allowed and makes every part a disk. A mesh with several parts is only noted here;
    /// each part is filled when it is extracted.
    #[must_use]
    pub(super) fn fill_holes(mut self) -> Self {
        let loops = self.inner_loops();
        self.note(Repair::FillHoles, loops.len());
        if self.is_sound() && parts_of(&self.polygons, &Sides::new(&self.polygons)).len() == 1 {
            self.filled()
        } else {
            self
        }
    }

    /// Fills the holes of a mesh with one part.
    #[must_use]
    pub(super) fn filled(mut self) -> Self {
        let holes = self.inner_loops();
        if !holes.is_empty() {
            self.filling = Filling::of(&self.polygons.triangulate(), &holes);
        }
        self
    }

    /// Loops to fill, reversed so that the surface lies to their right. Empty if holes are not filled, or filling
    /// makes no disks.
    fn inner_loops(&self) -> Vec<Vec<VertexId>> {
        if !self.fills || !self.is_sound() {
            return Vec::new();
        }
        let mesh = self.polygons.triangulate();
        let parts = parts(&mesh).unwrap_or_default();
        let of_part = |part: &Part| {
            let number = |vertex: &VertexId| part.vertex_of()[vertex.index()];
            let loops = part.loops().iter().map(|of| of.iter().rev().map(number).collect()).collect();
            all_but_the_longest(&mesh, loops)
        };
        parts.iter().flat_map(of_part).collect()
    }
}

/// All loops but the longest, in the order of their lowest vertices.
fn all_but_the_longest(mesh: &TriMesh, mut loops: Vec<Vec<VertexId>>) -> Vec<Vec<VertexId>> {
    let length = |of: &[VertexId]| -> f64 {
        sides(of).map(|ends| ends.map(|v| mesh.positions[v.index()])).map(|[a, b]| a.distance(b)).sum()
    };
    loops.sort_by_key(|of| of.iter().min().copied());
    let lengths: Vec<f64> = loops.iter().map(|of| length(of)).collect();
    let longest = (0..loops.len()).fold(0, |best, at| if lengths[at] > lengths[best] { at } else { best });
    loops.remove(longest);
    loops
}

impl Filling {
    fn of(mesh: &TriMesh, holes: &[Vec<VertexId>]) -> Self {
        let mut filling = Self::default();
        let edges = edges_across(mesh, holes);
        for (number, rim) in (0..).zip(holes) {
            let points: Vec<DVec3> = rim.iter().map(|v| mesh.positions[v.index()]).collect();
            let chosen = Fan::flat(&points)
                .map(Patch::Fan)
                .or_else(|| chords(rim, &points, &edges).map(Patch::Chords))
                .unwrap_or_else(|| Patch::Fan(Fan::raised(&points)));
            match chosen {
                Patch::Chords(triangles) => filling.triangles.extend(triangles),
                Patch::Fan(Fan { centre }) => {
                    let middle = VertexId::from_index(mesh.vertex_count() + filling.centres.len());
                    filling.centres.push(centre);
                    filling.triangles.extend(sides(rim).map(|[a, b]| [a, b, middle]));
                }
            }
            filling.hole_of.resize(filling.triangles.len(), number);
        }
        filling
    }

    /// Reverses the orientation of the triangles.
    pub(super) fn turn(&mut self) {
        self.triangles.iter_mut().for_each(|corners| corners[1..].reverse());
    }

    /// Appends the virtual vertices and triangles to a surface.
    pub(super) fn appended_to(&self, mut mesh: TriMesh) -> TriMesh {
        mesh.positions.extend(&self.centres);
        mesh.triangles.extend(&self.triangles);
        if let Some(polygon_of) = &mut mesh.polygon_of {
            polygon_of.extend(self.hole_of.iter().map(|hole| FIRST_HOLE + hole));
        }
        mesh
    }
}

enum Patch {
    Fan(Fan),
    Chords(Vec<[VertexId; 3]>),
}

struct Fan {
    centre: DVec3,
}

impl Fan {
    /// Fan around the mean of a loop's vertices, if all its triangles are positive in the loop's best-fit plane.
    fn flat(points: &[DVec3]) -> Option<Self> {
        let centre = mean(points);
        let normal = newell_normal(points).try_normalize()?;
        sides(points).all(|[a, b]| has_area([a, b, centre], normal)).then_some(Self { centre })
    }

    /// Fan around a vertex above the mean of a loop's vertices, raised by the mean length of its edges.
    fn raised(points: &[DVec3]) -> Self {
        let length: f64 = sides(points).map(|[a, b]| a.distance(b)).sum();
        let normal = newell_normal(points);
        let longest = sides(points).map(|[a, b]| b - a).fold(DVec3::ZERO, |longest, side| {
            if side.length_squared() > longest.length_squared() { side } else { longest }
        });
        // The normal of a slit is rounding noise.
        let is_slit = normal.length() <= THINNEST * length * length;
        let upward = if is_slit { longest.any_orthogonal_vector() } else { normal };
        Self { centre: mean(points) + upward.normalize_or_zero() * (length / points.len() as f64) }
    }
}

/// Triangles of a loop as a polygon, if they all have an area and their diagonals are no edges of the surface.
fn chords(rim: &[VertexId], points: &[DVec3], edges: &HashSet<[VertexId; 2]>) -> Option<Vec<[VertexId; 3]>> {
    let normal = newell_normal(points).try_normalize()?;
    let mut places = Vec::with_capacity(rim.len() - 2);
    triangulate(points, |_| false, |triangle| places.push(triangle));
    let is_side = |[a, b]: [usize; 2]| (a + 1) % rim.len() == b || (b + 1) % rim.len() == a;
    let is_free = |[a, b]: [usize; 2]| is_side([a, b]) || !edges.contains(&ascending([rim[a], rim[b]]));
    let serves = |&[a, b, c]: &[usize; 3]| {
        has_area([a, b, c].map(|at| points[at]), normal) && [[a, b], [b, c], [c, a]].into_iter().all(is_free)
    };
    places.iter().all(serves).then(|| places.iter().map(|triangle| triangle.map(|at| rim[at])).collect())
}

/// Edges of a surface between vertices around holes, the lower end first.
fn edges_across(mesh: &TriMesh, holes: &[Vec<VertexId>]) -> HashSet<[VertexId; 2]> {
    let mut is_on_rim = vec![false; mesh.vertex_count()];
    holes.iter().flatten().for_each(|v| is_on_rim[v.index()] = true);
    let all = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    all.filter(|ends| ends.iter().all(|v| is_on_rim[v.index()])).map(ascending).collect()
}

/// True if a triangle is counter-clockwise about its normal and is not a needle.
fn has_area([a, b, c]: [DVec3; 3], normal: DVec3) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).dot(normal) > THINNEST * longest
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// Sides of a closed chain.
fn sides<T: Copy>(chain: &[T]) -> impl Iterator<Item = [T; 2]> {
    chain.iter().zip(chain.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}
