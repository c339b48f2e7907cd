//! Similarities of the plane; the similarity that best fits pairs of points.

use glam::DVec2;

/// Ratio of the error of a reflection to that of a rotation below which pairs count as mirrored.
const MUCH_BETTER: f64 = 0.5;

/// Similarity z ↦ turn · (z − from) + to, in complex numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    turn: DVec2,
    from: DVec2,
    to: DVec2,
}

impl Similarity {
    /// Similarity that maps `from` to `to` and multiplies offsets from `from` by the complex number `turn`.
    pub fn new(turn: DVec2, from: DVec2, to: DVec2) -> Self {
        Self { turn, from, to }
    }

    /// Image of a point.
    pub fn apply(&self, z: DVec2) -> DVec2 {
        self.turn.rotate(z - self.from) + self.to
    }

    /// Factor by which the similarity multiplies lengths.
    pub fn factor(&self) -> f64 {
        self.turn.length()
    }

    /// Similarity without reflection that maps the first point of each pair nearest to the second, in least squares.
    /// `None` if there is none, or if it would map all points to one point.
    pub fn fitting(pairs: &[[DVec2; 2]]) -> Option<Self> {
        let [from, to] = middles(pairs);
        let (mut product, mut square) = (DVec2::ZERO, 0.0);
        for [a, b] in pairs.iter().map(|[a, b]| [*a - from, *b - to]) {
            // The conjugate of a, times b.
            product += DVec2::new(a.dot(b), a.perp_dot(b));
            square += a.length_squared();
        }
        let turn = product / square;
        (turn.is_finite() && turn != DVec2::ZERO).then_some(Self { turn, from, to })
    }

    /// Similarity without reflection that overlays the first points of the pairs on the second points. It gives both
    /// the same spread, the sum of squared distances from their centroid, and is the nearest with that spread.
    /// `None` if all first points or all second points coincide. Unlike [`Similarity::fitting`] it does not shrink
    /// points that fit badly.
    pub fn laying_over(pairs: &[[DVec2; 2]]) -> Option<Self> {
        let [from, to] = middles(pairs);
        let turn = Self::fitting(pairs).map_or(DVec2::X, |fitting| fitting.turn.normalize_or(DVec2::X));
        let spread = |k: usize, middle: DVec2| pairs.iter().map(|pair| pair[k].distance_squared(middle)).sum::<f64>();
        let factor = (spread(1, to) / spread(0, from)).sqrt();
        (factor.is_finite() && factor > 0.0).then_some(Self { turn: turn * factor, from, to })
    }

    /// Inverse similarity.
    #[must_use]
    pub fn inverse(self) -> Self {
        let back = DVec2::new(self.turn.x, -self.turn.y) / self.turn.length_squared();
        Self { turn: back, from: self.to, to: self.from }
    }

    /// Fraction of the similarity: of its angle (less than half a turn), of its factor as a power, and of its move.
    /// A share of 0 is the identity and a share of 1 is the similarity, up to rounding.
    #[must_use]
    pub fn part(self, share: f64) -> Self {
        let turn = DVec2::from_angle(share * self.turn.to_angle()) * self.turn.length().powf(share);
        Self { turn, from: self.from, to: self.from.lerp(self.to, share) }
    }

    /// Similarity with this rotation and scale that maps the first of two points to the second.
    #[must_use]
    pub fn moved(self, [from, to]: [DVec2; 2]) -> Self {
        Self { from, to, ..self }
    }

    /// Root mean square of the distances between the images of the first points and the second points of the pairs.
    pub fn error(&self, pairs: &[[DVec2; 2]]) -> f64 {
        let sum: f64 = pairs.iter().map(|[a, b]| self.apply(*a).distance_squared(*b)).sum();
        (sum / pairs.len() as f64).sqrt()
    }
}

/// Centroids of the first and of the second points of the pairs.
fn middles(pairs: &[[DVec2; 2]]) -> [DVec2; 2] {
    [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<DVec2>() / pairs.len() as f64)
}

/// True if a reflection maps the first point of each pair much nearer to the second than a rotation does.
pub fn look_mirrored(pairs: &[[DVec2; 2]]) -> bool {
    let mirrored: Vec<[DVec2; 2]> = pairs.iter().map(|[z, target]| [DVec2::new(-z.x, z.y), *target]).collect();
    Similarity::fitting(&mirrored).is_some_and(|best| best.error(&mirrored) < MUCH_BETTER * error_of(pairs))
}

/// Error of the best similarity without reflection; if none fits, error of mapping all points to one point.
fn error_of(pairs: &[[DVec2; 2]]) -> f64 {
    if let Some(best) = Similarity::fitting(pairs) {
        return best.error(pairs);
    }
    let middle = pairs.iter().map(|[_, target]| *target).sum::<DVec2>() / pairs.len() as f64;
    let squares: f64 = pairs.iter().map(|[_, target]| target.distance_squared(middle)).sum();
    (squares / pairs.len() as f64).sqrt()
}
