//! Lengths of a disk: their unit, their mollification if faces have no area, and the rest shapes of faces.
//!
//! # Equation
//!
//! A triangle without area breaks weights and energies, which divide by its area. If a mesh has such triangles, all
//! lengths grow by the smallest ε that leaves each triangle inequality a margin δ:
//!
//! ```text
//! l(a, b) = |x_a − x_b| + ε        ε = max over all triangles and their sides of  δ + longest − the two others, or 0
//! ```
//!
//! Then any three vertices, not only those of faces, form a triangle with an area: its two shorter sides exceed the
//! longest by ε at least.
//!
//! Source: N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020, §4.5. δ is 10⁻⁵ of the mean length
//! of a side. A mesh whose faces all have an area keeps its lengths to the last bit.

use glam::{DVec2, DVec3};

use super::{DiskMesh, FaceId, TriMesh, VertexId};

/// Margin δ, relative to the mean length of a side.
const MARGIN: f64 = 1e-5;

/// Smallest ratio of height to longest side of a rest shape.
pub(crate) const THINNEST: f64 = 1e-4;

/// Conversion of positions to lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// Length of one unit of the positions.
    pub(super) unit: f64,
    /// Mollification ε, in units of `unit`.
    pub(super) mollification: f64,
}

impl Default for Measure {
    fn default() -> Self {
        Self { unit: 1.0, mollification: 0.0 }
    }
}

impl DiskMesh {
    /// Length of one unit of the positions, a power of two. Default: 1. Extremely large and small meshes are scaled to
    /// the middle of the range of numbers.
    pub fn unit(&self) -> f64 {
        self.measure().unit
    }

    /// Mollification ε added to every length, in units of [`unit`](Self::unit); 0 if all faces have an area.
    pub fn mollification(&self) -> f64 {
        self.measure().mollification
    }

    /// Distance of two vertices for equations and energies, in units of [`unit`](Self::unit), mollified if needed.
    pub fn length(&self, [a, b]: [VertexId; 2]) -> f64 {
        self.position(a).distance(self.position(b)) + self.mollification()
    }

    /// Triangle of three vertices for equations and energies, in units of [`unit`](Self::unit): its shape in space, or
    /// a triangle with the mollified side lengths.
    pub fn shape(&self, corners: [VertexId; 3]) -> [DVec3; 3] {
        let corners = corners.map(|v| self.position(v));
        if self.mollification() > 0.0 { mollified(corners, self.mollification()) } else { corners }
    }

    /// Rest shape of three vertices: their triangle laid out in the plane, times `scale`, with a height of at least
    /// [`THINNEST`] of its longest side. Energies and distortion compare images with it.
    ///
    /// The image of a needle opens and closes with any move of its neighbours. Measured by its own height, it would
    /// outweigh all other faces.
    pub(crate) fn rest_shape(&self, corners: [VertexId; 3], scale: f64) -> [DVec2; 3] {
        with_least_height(laid_flat(self.shape(corners).map(|x| scale * x)))
    }
}

/// Mollification ε of a mesh that has faces without area.
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

/// Triangle with sides longer by `by`.
fn mollified(corners: [DVec3; 3], by: f64) -> [DVec3; 3] {
    triangle_of_sides(side_lengths(corners).map(|length| length + by))
}

/// Triangle from the lengths of the sides that leave each corner. Its first corner lies at the origin and its first
/// side along the x-axis; it is counter-clockwise seen from above. The area is 0 if no such triangle exists.
pub(crate) fn triangle_of_sides([first, opposite, last]: [f64; 3]) -> [DVec3; 3] {
    let along = (first * first + (last - opposite) * (last + opposite)) / (2.0 * first);
    let height = 2.0 * area([first, opposite, last]) / first;
    [DVec3::ZERO, DVec3::new(first, 0.0, 0.0), DVec3::new(along, height, 0.0)]
}

/// Area of a triangle from its sides, in an order of operations without cancellation (W. Kahan, "Miscalculating area
/// and angles of a needle-like triangle", 2014).
fn area(mut sides: [f64; 3]) -> f64 {
    sides.sort_by(f64::total_cmp);
    let [c, b, a] = sides;
    0.25 * ((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))).max(0.0).sqrt()
}

/// Lays out a triangle of space in the plane, its first side along the x-axis.
pub(crate) fn laid_flat([a, b, c]: [DVec3; 3]) -> [DVec2; 3] {
    let (first, second) = (b - a, c - a);
    let length = first.length();
    if length == 0.0 {
        return [DVec2::ZERO, DVec2::ZERO, DVec2::new(second.length(), 0.0)];
    }
    let along = first.dot(second) / length;
    [DVec2::ZERO, DVec2::new(length, 0.0), DVec2::new(along, first.cross(second).length() / length)]
}

/// Triangle with its height over the longest side raised to [`THINNEST`] of that side, if it is lower and not 0.
fn with_least_height(corners: [DVec2; 3]) -> [DVec2; 3] {
    let side = |k: usize| corners[(k + 1) % 3] - corners[k];
    let is_longer = |k: usize, than: usize| side(k).length_squared() > side(than).length_squared();
    let longest = (1..3).fold(0, |longest, k| if is_longer(k, longest) { k } else { longest });
    let double_area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
    let lack = THINNEST - double_area / side(longest).length_squared();
    let mut raised = corners;
    if double_area > 0.0 && lack > 0.0 {
        raised[(longest + 2) % 3] += lack * side(longest).perp();
    }
    raised
}
