//! Axis-aligned boxes in the plane.

use glam::DVec2;

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
