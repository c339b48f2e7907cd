//! Nearest point of a surface that faces a direction.

use glam::DVec3;

use crate::geom::SpaceBounds;
use crate::mesh::{FaceId, NearestPoint, TriMesh, TriangleTree, nearest_point};

/// Additional distance up to which a triangle that faces the direction is preferred to a nearer one that does not,
/// relative to the diagonal of the surface's box. Keeps the two sides of a thin wall apart.
const SLACK: f64 = 0.01;

/// Distance beyond a known triangle up to which others are searched, relative to the diagonal. Covers rounding.
const ROUNDING: f64 = 1e-9;

/// Largest number of points that decide whether another surface is inside out.
const JUDGES: usize = 4096;

/// Excess of the area that disagrees over the area that agrees, relative to both, above which a surface is inside out.
const CLEAR: f64 = 0.5;

/// Search for nearest points of a surface.
#[derive(Clone, Debug)]
pub struct SurfaceSearch<'a> {
    mesh: &'a TriMesh,
    tree: TriangleTree,
    /// Normal of each triangle, of length 1; zero if it has no area.
    normals: Vec<DVec3>,
    /// Diagonal of the box around the surface.
    diagonal: f64,
}

impl<'a> SurfaceSearch<'a> {
    /// Prepares the search in O(n log n).
    pub fn new(mesh: &'a TriMesh) -> Self {
        let faces = || (0..mesh.face_count()).map(FaceId::from_index);
        let corners: Vec<[DVec3; 3]> = faces().map(|face| mesh.corners(face)).collect();
        let diagonal = SpaceBounds::of(corners.iter().flatten().copied()).diagonal();
        let normals = faces().map(|face| mesh.double_area_vector(face).normalize_or_zero()).collect();
        Self { mesh, tree: TriangleTree::new(&corners), normals, diagonal }
    }

    /// Diagonal of the box around the surface.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// Positions of a triangle's corners.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.corners(FaceId::new(triangle))
    }

    /// 1 if another surface has its outside where this surface has it, or -1 if it is inside out.
    ///
    /// `oriented` gives a point of each face of the other surface, and its area vector. The surface counts as inside out
    /// only if most of the area of some faces, spread evenly among the `count` faces, disagrees with the nearest
    /// triangles: near a thin wall, faces of another level of detail may lie nearer to its other side.
    pub fn sense(&self, count: usize, oriented: impl Fn(usize) -> (DVec3, DVec3)) -> f64 {
        let agreement = |face: usize| {
            let (point, area) = oriented(face);
            let found = self.nearest(point, DVec3::ZERO, None)?;
            let dot = self.normals[found.triangle as usize].dot(area);
            dot.is_finite().then_some(dot)
        };
        let step = count.div_ceil(JUDGES).max(1);
        let (mut total, mut whole) = (0.0, 0.0);
        for dot in (0..count).step_by(step).filter_map(agreement) {
            (total, whole) = (total + dot, whole + dot.abs());
        }
        if total < -CLEAR * whole { -1.0 } else { 1.0 }
    }

    /// Nearest point of the surface. `None` if the surface has no triangle, or the point is not finite.
    ///
    /// A triangle that faces `direction` is preferred unless it is farther by more than 1 % of the surface's diagonal.
    /// A zero direction is faced by all triangles. `near` is a triangle likely to be close, which saves time.
    pub fn nearest(&self, point: DVec3, direction: DVec3, near: Option<u32>) -> Option<NearestPoint> {
        if !point.is_finite() {
            return None;
        }
        let near = near.map(|near| nearest_point(point, self.corners(near), near));
        // Distances to boxes and to triangles round differently, so the limit is a little farther.
        let limit =
            near.map_or(f64::INFINITY, |near| (near.distance_squared.sqrt() + ROUNDING * self.diagonal).powi(2));
        let corners = |triangle: u32| self.corners(triangle);
        let any = self.tree.nearest(point, limit, corners, |_| true).or(near)?;
        let faces = |triangle: u32| self.normals[triangle as usize].dot(direction) >= 0.0;
        if faces(any.triangle) {
            return Some(any);
        }
        let limit = (any.distance_squared.sqrt() + SLACK * self.diagonal).powi(2);
        self.tree.nearest(point, limit, corners, faces).or(Some(any))
    }
}
