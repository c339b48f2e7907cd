//! Extents, and the move into the unit space that the GPU works in.
//!
//! A mesh far from its origin, or of any size between 1e-6 and 1e6 units, loses its digits when its coordinates are
//! rounded to f32. So they are centred and scaled in f64 first.

use glam::{DMat4, DVec2, DVec3, Vec3};

/// A ball that holds all vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, world units.
    pub center: DVec3,
    /// Its radius, world units, always positive.
    pub radius: f64,
}

impl Sphere {
    /// The ball about the centre of the bounding box that reaches the farthest position.
    ///
    /// Positions that are not finite are left out. No positions, or all at one place, give radius 1.
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
}

/// An axis-parallel box of the embedding plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneBox {
    /// Lower left corner, embedding units.
    pub min: DVec2,
    /// Upper right corner, embedding units.
    pub max: DVec2,
}

impl PlaneBox {
    /// The unit square.
    pub const UNIT: Self = Self { min: DVec2::ZERO, max: DVec2::ONE };

    /// The smallest box around points. Points that are not finite are left out; without points it is the unit square.
    pub fn around(points: &[DVec2]) -> Self {
        let finite = || points.iter().filter(|p| p.is_finite());
        let min = finite().fold(DVec2::INFINITY, |low, &p| low.min(p));
        let max = finite().fold(DVec2::NEG_INFINITY, |high, &p| high.max(p));
        if min.x > max.x { Self::UNIT } else { Self { min, max } }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The point in the middle.
    pub fn center(self) -> DVec2 {
        self.min.midpoint(self.max)
    }

    /// Width and height.
    pub fn size(self) -> DVec2 {
        self.max - self.min
    }

    /// The longer of width and height; 1 where the box is a single point.
    pub fn extent(self) -> f64 {
        let extent = self.size().max_element();
        if extent > 0.0 && extent.is_finite() { extent } else { 1.0 }
    }
}

/// Where unit space lies in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitFrame {
    sphere: Sphere,
}

impl UnitFrame {
    /// The frame in which this ball is the unit ball.
    pub fn of(sphere: Sphere) -> Self {
        Self { sphere }
    }

    /// The ball that the unit ball is in the world.
    pub fn sphere(self) -> Sphere {
        self.sphere
    }

    /// A world point as the GPU holds it.
    pub fn unit_from_world(self, position_in_world: DVec3) -> Vec3 {
        ((position_in_world - self.sphere.center) / self.sphere.radius).as_vec3()
    }

    /// The transform from unit space to the world.
    pub fn world_from_unit(self) -> DMat4 {
        DMat4::from_translation(self.sphere.center) * DMat4::from_scale(DVec3::splat(self.sphere.radius))
    }
}

/// Where the unit space of an embedding lies in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitPlane {
    center: DVec2,
    half_extent: f64,
}

impl UnitPlane {
    /// The frame in which the longer side of this box has length 2.
    pub fn of(bounds: PlaneBox) -> Self {
        Self { center: bounds.center(), half_extent: bounds.extent() / 2.0 }
    }

    /// The point of the plane that is the origin of unit space.
    pub fn center(self) -> DVec2 {
        self.center
    }

    /// Embedding units per unit of unit space.
    pub fn embedding_per_unit(self) -> f64 {
        self.half_extent
    }

    /// A point of the plane in unit space.
    pub fn unit_from_embedding(self, point: DVec2) -> DVec2 {
        (point - self.center) / self.half_extent
    }
}

/// A point as the sum of two f32 points, together about 48 bits: high parts first, low parts after them.
///
/// Embeddings of meshes with a small boundary squeeze triangles over more than ten decades of length. One f32 would
/// show them as a single point however far one zooms in.
pub(crate) fn split_point(point: DVec2) -> [f32; 4] {
    let high = point.as_vec2();
    let low = (point - high.as_dvec2()).as_vec2();
    [high.x, high.y, low.x, low.y]
}
