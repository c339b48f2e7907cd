//! Boxes in the plane, sides along the axes.

use glam::DVec2;

/// A closed box with sides along the axes; nothing meets an empty one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub low: DVec2,
    /// Upper right corner.
    pub high: DVec2,
}

impl Bounds {
    /// The box of no points.
    pub const EMPTY: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };

    /// The unit square.
    pub const UNIT: Self = Self { low: DVec2::ZERO, high: DVec2::ONE };

    /// The smallest box around points.
    pub fn of(points: impl IntoIterator<Item = DVec2>) -> Self {
        let with = |Self { low, high }: Self, z| Self { low: low.min(z), high: high.max(z) };
        points.into_iter().fold(Self::EMPTY, with)
    }

    /// The box of a size whose lower left corner is given.
    pub fn at(low: DVec2, size: DVec2) -> Self {
        Self { low, high: low + size }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether two boxes have a point in common.
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

    /// The longer of width and height; 1 where the box is a single point.
    pub fn extent(self) -> f64 {
        let extent = self.size().max_element();
        if extent > 0.0 && extent.is_finite() { extent } else { 1.0 }
    }

    /// The point in its middle.
    pub fn middle(self) -> DVec2 {
        self.low.midpoint(self.high)
    }

    /// Its corners: the lower left one, then along the x axis, around.
    pub fn corners(self) -> [DVec2; 4] {
        let Self { low, high } = self;
        [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
    }

    /// Length of its diagonal.
    pub fn diameter(self) -> f64 {
        self.low.distance(self.high)
    }
}
