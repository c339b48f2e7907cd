//! Progress of continuation and relaxing.

/// Progress of a one-to-one embedding through continuation or relaxing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Mean over the surface of the symmetric Dirichlet energy |J|² + |J⁻¹|². The least value is 4, without
    /// distortion.
    pub energy: f64,
    /// Smallest determinant of a face's map, at equal total areas.
    pub least_determinant: f64,
    /// Largest distance of a hard pin from its target, in the plane.
    pub distance_left: f64,
}
