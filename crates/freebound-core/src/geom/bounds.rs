//! Axis-aligned boxes in the plane and in space.

use glam::{DVec2, DVec3};

/// Closed axis-aligned box. An empty box meets no other box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub low: DVec2,
    /// Upper right corner.
    pub high: DVec2,
}

impl Bounds {
    /// Empty box: the bounds of no points.
    pub const EMPTY: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };

    /// The unit square.
    pub const UNIT: Self = Self { low: DVec2::ZERO, high: DVec2::ONE };

    /// Smallest box around points.
    pub fn of(points: impl IntoIterator<Item = DVec2>) -> Self {
        let with = |Self { low, high }: Self, z| Self { low: low.min(z), high: high.max(z) };
        points.into_iter().fold(Self::EMPTY, with)
    }

    /// Box with a given lower left corner and size.
    pub fn at(low: DVec2, size: DVec2) -> Self {
        Self { low, high: low + size }
    }

    /// Smallest box around two boxes.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// True if a point lies in the box.
    pub fn contains(self, at: DVec2) -> bool {
        at.cmpge(self.low).all() && at.cmple(self.high).all()
    }

    /// True if two boxes have a point in common.
    pub fn meets(self, other: Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Width and height.
    pub fn size(self) -> DVec2 {
        self.high - self.low
    }

    /// Larger of width and height; 1 if the box is a single point, empty or infinite.
    pub fn extent(self) -> f64 {
        let extent = self.size().max_element();
        if extent > 0.0 && extent.is_finite() { extent } else { 1.0 }
    }

    /// Centre of the box.
    pub fn middle(self) -> DVec2 {
        self.low.midpoint(self.high)
    }

    /// Corners counter-clockwise from the lower left.
    pub fn corners(self) -> [DVec2; 4] {
        let Self { low, high } = self;
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
    }

    /// Length of the diagonal.
    pub fn diameter(self) -> f64 {
        self.low.distance(self.high)
    }
}

/// Closed axis-aligned box in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceBounds {
    /// Corner with the lowest coordinates.
    pub low: DVec3,
    /// Corner with the highest coordinates.
    pub high: DVec3,
}

impl SpaceBounds {
    /// Smallest box around the finite points. Without any, the box is empty: `low` is above `high`.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let empty = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        let with = |Self { low, high }: Self, p| Self { low: low.min(p), high: high.max(p) };
        points.into_iter().filter(|p| p.is_finite()).fold(empty, with)
    }

    /// True if the box has no point.
    pub fn is_empty(self) -> bool {
        self.low.cmpgt(self.high).any()
    }

    /// Distance between the two corners; 0 if the box is empty.
    pub fn diagonal(self) -> f64 {
        if self.is_empty() { 0.0 } else { self.low.distance(self.high) }
    }

    /// Centre of the box.
    pub fn middle(self) -> DVec3 {
        self.low.midpoint(self.high)
    }
}
