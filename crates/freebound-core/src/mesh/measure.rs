//! How a disk is measured: in which unit, and by lengths a little longer than in space where faces have no area.
//!
//! # Equation
//!
//! A triangle without area breaks weights and energies, which divide by its area. Where a mesh has any, all lengths are
//! taken longer by the least ε that leaves each triangle inequality a margin δ:
//!
//! ```text
//! l(a, b) = |x_a − x_b| + ε        ε = max over all triangles and their sides of  δ + longest − the two others, or 0
//! ```
//!
//! Then any three vertices, not only those of faces, make a triangle with an area: its two shorter sides exceed the
//! longest by ε at least.
//!
//! Source: N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020, §4.5. δ is a hundred thousandth of the
//! mean length of a side. A mesh whose faces all have an area keeps its lengths to the last bit.

use glam::DVec3;

use super::{DiskMesh, FaceId, TriMesh, VertexId};

/// The margin δ, by the mean length of a side.
const MARGIN: f64 = 1e-5;

/// How the positions of a disk become lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// The length that positions are in units of.
    pub(super) unit: f64,
    /// ε, in these units.
    pub(super) mollification: f64,
}

impl Default for Measure {
    fn default() -> Self {
        Self { unit: 1.0, mollification: 0.0 }
    }
}

impl DiskMesh {
    /// The length that positions are in units of: a power of two, 1 but for meshes of the largest and smallest sizes,
    /// which are brought to the middle of the range of numbers.
    pub fn unit(&self) -> f64 {
        self.measure().unit
    }

    /// By how much every length is taken longer than in space, ε in units of [`unit`](Self::unit): 0 where all faces have
    /// an area.
    pub fn mollification(&self) -> f64 {
        self.measure().mollification
    }

    /// The distance of two vertices that equations and energies take, in units of [`unit`](Self::unit).
    pub fn length(&self, [a, b]: [VertexId; 2]) -> f64 {
        self.position(a).distance(self.position(b)) + self.mollification()
    }

    /// The triangle of three vertices that equations and energies take, in units of [`unit`](Self::unit): as it lies in
    /// space, or another one of mollified lengths.
    pub fn shape(&self, corners: [VertexId; 3]) -> [DVec3; 3] {
        let corners = corners.map(|v| self.position(v));
        if self.mollification() > 0.0 { mollified(corners, self.mollification()) } else { corners }
    }
}

/// ε for a mesh that has faces without area.
pub(super) fn least_mollification(mesh: &TriMesh) -> f64 {
    let sides = |face: usize| side_lengths(mesh.corners(FaceId::from_index(face)));
    let total: f64 = (0..mesh.face_count()).flat_map(sides).sum();
    let margin = MARGIN * total / (3 * mesh.face_count()) as f64;
    let lacks = |face: usize| {
        let [a, b, c] = sides(face);
        margin + (a - b - c).max(b - c - a).max(c - a - b)
    };
    (0..mesh.face_count()).map(lacks).fold(0.0, f64::max)
}

/// Lengths of the sides that leave each corner.
fn side_lengths([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [a.distance(b), b.distance(c), c.distance(a)]
}

/// A triangle whose sides are longer by so much.
fn mollified(corners: [DVec3; 3], by: f64) -> [DVec3; 3] {
    triangle_of_sides(side_lengths(corners).map(|length| length + by))
}

/// A triangle by the lengths of the sides that leave each corner, laid with its first corner at the origin and its first
/// side along the x-axis, counter-clockwise seen from above. Without an area where there is no such triangle.
pub(crate) fn triangle_of_sides([first, opposite, last]: [f64; 3]) -> [DVec3; 3] {
    let along = (first * first + (last - opposite) * (last + opposite)) / (2.0 * first);
    let height = 2.0 * area([first, opposite, last]) / first;
    [DVec3::ZERO, DVec3::new(first, 0.0, 0.0), DVec3::new(along, height, 0.0)]
}

/// Area of a triangle by its sides, in the order of operations in which nothing cancels (W. Kahan, "Miscalculating area and
/// angles of a needle-like triangle", 2014).
fn area(mut sides: [f64; 3]) -> f64 {
    sides.sort_by(f64::total_cmp);
    let [c, b, a] = sides;
    0.25 * ((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))).max(0.0).sqrt()
}
