//! Holes are filled with virtual faces, so that each part of the surface is a disk while it is flattened.
//!
//! # Method
//!
//! Of each part the longest boundary loop, by the lengths of its edges, is the outer one; all others are around holes. Of three ways to fill
//! a hole the first is taken that serves:
//!
//! * A fan around a new vertex in the middle of the loop, where the loop is seen from there, in its best plane, as a whole.
//! * The triangles of the loop as a polygon, where these have an area and no edge that the surface has: what lies in a plane keeps its shape.
//! * A fan around a new vertex that is raised from the plane, so that its triangles have an area even where the loop is
//!   a slit.
//!
//! Nothing is filled where a part would be no disk for that: where it has handles, or one side only. Such a part is cut with its holes
//! as parts of the boundary.

use std::collections::HashSet;

use glam::DVec3;

use super::charts::parts_of;
use super::sides::{Sides, ascending};
use super::{Repair, Repaired};
use crate::mesh::polygons::newell_normal;
use crate::mesh::triangulate::triangulate;
use crate::mesh::{FIRST_HOLE, Part, TriMesh, VertexId, parts};

/// A triangle, or a loop, whose area is a smaller share of its longest side's square, or its length's, has none.
const THINNEST: f64 = 1e-6;

/// What fills the holes of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Filling {
    /// New vertices, numbered after those of the surface.
    centres: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    /// For each triangle the hole, counted from 0.
    hole_of: Vec<u32>,
}

impl Repaired {
    /// Fills all holes where that is wanted and makes disks of all parts. Where there are several, each is filled when it
    /// is taken for itself.
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

    /// Fills the holes of one part.
    #[must_use]
    pub(super) fn filled(mut self) -> Self {
        let holes = self.inner_loops();
        if !holes.is_empty() {
            self.filling = Filling::of(&self.polygons.triangulate(), &holes);
        }
        self
    }

    /// The loops to fill, each turned around so that the surface lies to its right; none where they are to stay, or filling
    /// them makes no disks.
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

/// All loops but the longest, those with the lowest vertices first.
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

    /// Runs around the other way.
    pub(super) fn turn(&mut self) {
        self.triangles.iter_mut().for_each(|corners| corners[1..].reverse());
    }

    /// A surface with its holes filled.
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
    /// Around the middle of a loop, where all its triangles lie the same way up.
    fn flat(points: &[DVec3]) -> Option<Self> {
        let centre = mean(points);
        let normal = newell_normal(points).try_normalize()?;
        sides(points).all(|[a, b]| has_area([a, b, centre], normal)).then_some(Self { centre })
    }

    /// Above the middle of a loop, by the mean length of its edges.
    fn raised(points: &[DVec3]) -> Self {
        let length: f64 = sides(points).map(|[a, b]| a.distance(b)).sum();
        let normal = newell_normal(points);
        let longest = sides(points).map(|[a, b]| b - a).fold(DVec3::ZERO, |longest, side| {
            if side.length_squared() > longest.length_squared() { side } else { longest }
        });
        // What a slit has for a normal is its rounding.
        let is_slit = normal.length() <= THINNEST * length * length;
        let upward = if is_slit { longest.any_orthogonal_vector() } else { normal };
        Self { centre: mean(points) + upward.normalize_or_zero() * (length / points.len() as f64) }
    }
}

/// The triangles of a loop as a polygon, where these serve.
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

/// The edges of a surface that join vertices around holes, the lower end first.
fn edges_across(mesh: &TriMesh, holes: &[Vec<VertexId>]) -> HashSet<[VertexId; 2]> {
    let mut is_on_rim = vec![false; mesh.vertex_count()];
    holes.iter().flatten().for_each(|v| is_on_rim[v.index()] = true);
    let all = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    all.filter(|ends| ends.iter().all(|v| is_on_rim[v.index()])).map(ascending).collect()
}

/// Whether a triangle runs around its normal, and is no needle.
fn has_area([a, b, c]: [DVec3; 3], normal: DVec3) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).dot(normal) > THINNEST * longest
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// The sides of a closed chain.
fn sides<T: Copy>(chain: &[T]) -> impl Iterator<Item = [T; 2]> {
    chain.iter().zip(chain.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}
