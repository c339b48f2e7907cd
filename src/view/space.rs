//! Extents, and the transform to the unit space of the GPU.
//!
//! Coordinates of a mesh far from its origin, or of any size between 1e-6 and 1e6 units, lose digits when rounded to
//! f32. They are centred and scaled in f64 first.

use glam::{DMat4, DVec2, DVec3, Vec3};

use freebound_core::geom::Bounds;

/// Width of a detail view around points, as a multiple of their extent.
const PART_MARGIN: f64 = 7.0;
/// Least reach of a detail view: the radius of the sphere, or the extent of the box, divided by this number.
const LEAST_PART: f64 = 12.0;

/// Sphere that contains all vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre, world units.
    pub center: DVec3,
    /// Radius, world units, always positive.
    pub radius: f64,
}

impl Sphere {
    /// Sphere about the centre of the bounding box that reaches the farthest position.
    ///
    /// Positions that are not finite are left out. The radius is 1 if there are no positions, or all coincide.
    pub fn around(positions: &[DVec3]) -> Self {
        let finite = || positions.iter().filter(|p| p.is_finite());
        let low = finite().fold(DVec3::INFINITY, |low, &p| low.min(p));
        let high = finite().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p));
        if low.x > high.x {
            return Self { center: DVec3::ZERO, radius: 1.0 };
        }
        let center = low.midpoint(high);
        let radius = finite().map(|p| p.distance(center)).fold(0.0, f64::max);
        Self { center, radius: if radius > 0.0 && radius.is_finite() { radius } else { 1.0 } }
    }

    /// Sphere for a detail view of a few points, no larger than this sphere.
    #[must_use]
    pub fn part_around(self, points: &[DVec3]) -> Self {
        let center = Self::around(points).center;
        // `around` makes up a radius for a single point, so the radius is computed from the points here.
        let radius = points.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
        Self { center, radius: (radius * PART_MARGIN).max(self.radius / LEAST_PART).min(self.radius) }
    }

    /// Maps a world point to the unit space in which this sphere is the unit sphere, in f32 for the GPU.
    pub fn unit_from_world(self, position_in_world: DVec3) -> Vec3 {
        ((position_in_world - self.center) / self.radius).as_vec3()
    }

    /// Transform from unit space to the world.
    pub fn world_from_unit(self) -> DMat4 {
        DMat4::from_translation(self.center) * DMat4::from_scale(DVec3::splat(self.radius))
    }
}

/// Bounding box of points. Points that are not finite are left out; without points it is the unit square.
pub fn bounds_of(points: &[DVec2]) -> Bounds {
    let found = Bounds::of(points.iter().copied().filter(|p| p.is_finite()));
    if found.low.x > found.high.x { Bounds::UNIT } else { found }
}

/// Box for a detail view of a few points within the box `all`.
pub fn part_around(points: &[DVec2], all: Bounds) -> Bounds {
    let tight = bounds_of(points);
    let reach = tight.size().max_element();
    let half = (reach * PART_MARGIN / 2.0).max(all.extent() / LEAST_PART).min(all.extent());
    Bounds { low: tight.middle() - half, high: tight.middle() + half }
}

/// Position and scale of an embedding's unit space in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitPlane {
    /// Point of the plane at the origin of unit space.
    pub center: DVec2,
    /// Embedding units per unit of unit space.
    pub embedding_per_unit: f64,
}

impl UnitPlane {
    /// Unit space in which the longer side of this box has length 2.
    pub fn of(bounds: Bounds) -> Self {
        Self { center: bounds.middle(), embedding_per_unit: bounds.extent() / 2.0 }
    }

    /// Maps a point of the plane to unit space.
    pub fn unit_from_embedding(self, point: DVec2) -> DVec2 {
        (point - self.center) / self.embedding_per_unit
    }

    /// Point of the plane at a point of unit space.
    pub fn embedding_from_unit(self, point: DVec2) -> DVec2 {
        self.center + point * self.embedding_per_unit
    }
}

/// Splits a point into the sum of two f32 points, together about 48 bits: high parts first, then low parts.
///
/// Embeddings of meshes with a small boundary squeeze triangles over more than ten decades of length. A single f32
/// would show them as one point at any zoom.
pub(crate) fn split_point(point: DVec2) -> [f32; 4] {
    let high = point.as_vec2();
    let low = (point - high.as_dvec2()).as_vec2();
    [high.x, high.y, low.x, low.y]
}
