//! Numbers of a one-to-one embedding on its way.

/// Numbers of a one-to-one embedding on its way through continuation or relaxing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Mean over the surface of the symmetric Dirichlet energy |J|² + |J⁻¹|²: 4 where nothing is distorted.
    pub energy: f64,
    /// Smallest determinant of a face's map, at equal total areas.
    pub least_determinant: f64,
    /// Largest distance of an exact pin from its target, in the plane.
    pub distance_left: f64,
}
