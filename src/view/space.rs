//! Extents, and the move into the unit space that the GPU works in.
//!
//! A mesh far from its origin, or of any size between 1e-6 and 1e6 units, loses its digits when its coordinates are
//! rounded to f32. So they are centred and scaled in f64 first.

use glam::{DMat4, DVec2, DVec3, Vec3};

use freebound_core::geom::Bounds;

/// Half the width of the part that is shown around points, in lengths of what they span.
const PART_MARGIN: f64 = 7.0;
/// A single point is shown with this part of the whole around it.
const LEAST_PART: f64 = 12.0;

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

    /// A ball around a few points with some of this one around.
    #[must_use]
    pub fn part_around(self, points: &[DVec3]) -> Self {
        let center = Self::around(points).center;
        // The ball of a single point has a made-up size, so the points are asked.
        let radius = points.iter().map(|point| point.distance(center)).fold(0.0, f64::max);
        Self { center, radius: (radius * PART_MARGIN).max(self.radius / LEAST_PART).min(self.radius) }
    }

    /// A world point as the GPU holds it, in the unit space where this is the unit ball.
    pub fn unit_from_world(self, position_in_world: DVec3) -> Vec3 {
        ((position_in_world - self.center) / self.radius).as_vec3()
    }

    /// The transform from that space to the world.
    pub fn world_from_unit(self) -> DMat4 {
        DMat4::from_translation(self.center) * DMat4::from_scale(DVec3::splat(self.radius))
    }
}

/// The smallest box around points. Points that are not finite are left out; without points it is the unit square.
pub fn bounds_of(points: &[DVec2]) -> Bounds {
    let found = Bounds::of(points.iter().copied().filter(|p| p.is_finite()));
    if found.low.x > found.high.x { Bounds::UNIT } else { found }
}

/// A box around a few points with some of `all` around.
pub fn part_around(points: &[DVec2], all: Bounds) -> Bounds {
    let tight = bounds_of(points);
    let reach = tight.size().max_element();
    let half = (reach * PART_MARGIN / 2.0).max(all.extent() / LEAST_PART).min(all.extent());
    Bounds { low: tight.middle() - half, high: tight.middle() + half }
}

/// Where the unit space of an embedding lies in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitPlane {
    /// The point of the plane that is the origin of unit space.
    pub center: DVec2,
    /// Embedding units per unit of unit space.
    pub embedding_per_unit: f64,
}

impl UnitPlane {
    /// The frame in which the longer side of this box has length 2.
    pub fn of(bounds: Bounds) -> Self {
        Self { center: bounds.middle(), embedding_per_unit: bounds.extent() / 2.0 }
    }

    /// A point of the plane in unit space.
    pub fn unit_from_embedding(self, point: DVec2) -> DVec2 {
        (point - self.center) / self.embedding_per_unit
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
