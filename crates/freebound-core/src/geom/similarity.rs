//! Similarities of the plane, and the one that fits pairs of points best.

use glam::DVec2;

/// A reflection fits much better where its error is less than this part of the rotation's.
const MUCH_BETTER: f64 = 0.5;

/// z ↦ turn · (z − from) + to, in complex numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    turn: DVec2,
    from: DVec2,
    to: DVec2,
}

impl Similarity {
    /// Multiplies what lies around `from` by `turn`, a complex number, and takes `from` to `to`.
    pub fn new(turn: DVec2, from: DVec2, to: DVec2) -> Self {
        Self { turn, from, to }
    }

    /// Where it takes a point.
    pub fn apply(&self, z: DVec2) -> DVec2 {
        self.turn.rotate(z - self.from) + self.to
    }

    /// The similarity without reflection that takes the first of each pair nearest to the second, in the sum of squares;
    /// `None` where there is none, or where it would take all to one place.
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

    /// The similarity without reflection that lays the first of each pair over the second: of all that make them spread as far
    /// as these do, in the sum of squares about their middle, the one that takes them nearest. `None` where either are in
    /// one place. Unlike the one that fits best it makes nothing small that fits badly.
    pub fn laying_over(pairs: &[[DVec2; 2]]) -> Option<Self> {
        let [from, to] = middles(pairs);
        let turn = Self::fitting(pairs).map_or(DVec2::X, |fitting| fitting.turn.normalize_or(DVec2::X));
        let spread = |k: usize, middle: DVec2| pairs.iter().map(|pair| pair[k].distance_squared(middle)).sum::<f64>();
        let factor = (spread(1, to) / spread(0, from)).sqrt();
        (factor.is_finite() && factor > 0.0).then_some(Self { turn: turn * factor, from, to })
    }

    /// The similarity back.
    #[must_use]
    pub fn inverse(self) -> Self {
        let back = DVec2::new(self.turn.x, -self.turn.y) / self.turn.length_squared();
        Self { turn: back, from: self.to, to: self.from }
    }

    /// A share of it: of its turn by less than half around, of its factor in powers, and of its move. 0 is none of it, 1 all, up to
    /// rounding.
    #[must_use]
    pub fn part(self, share: f64) -> Self {
        let turn = DVec2::from_angle(share * self.turn.to_angle()) * self.turn.length().powf(share);
        Self { turn, from: self.from, to: self.from.lerp(self.to, share) }
    }

    /// The same turn and size, with the first of two points taken to the second.
    #[must_use]
    pub fn moved(self, [from, to]: [DVec2; 2]) -> Self {
        Self { from, to, ..self }
    }

    /// Root of the mean squared distance that it leaves between pairs.
    pub fn error(&self, pairs: &[[DVec2; 2]]) -> f64 {
        let sum: f64 = pairs.iter().map(|[a, b]| self.apply(*a).distance_squared(*b)).sum();
        (sum / pairs.len() as f64).sqrt()
    }
}

/// The middle of the first of each pair, and that of the second.
fn middles(pairs: &[[DVec2; 2]]) -> [DVec2; 2] {
    [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<DVec2>() / pairs.len() as f64)
}

/// Whether a reflection takes the first of each pair much nearer to the second than a rotation does.
pub fn look_mirrored(pairs: &[[DVec2; 2]]) -> bool {
    let mirrored: Vec<[DVec2; 2]> = pairs.iter().map(|[z, target]| [DVec2::new(-z.x, z.y), *target]).collect();
    Similarity::fitting(&mirrored).is_some_and(|best| best.error(&mirrored) < MUCH_BETTER * error_of(pairs))
}

/// Error of the similarity without reflection that fits best; where none fits, of one point for all.
fn error_of(pairs: &[[DVec2; 2]]) -> f64 {
    if let Some(best) = Similarity::fitting(pairs) {
        return best.error(pairs);
    }
    let middle = pairs.iter().map(|[_, target]| *target).sum::<DVec2>() / pairs.len() as f64;
    let squares: f64 = pairs.iter().map(|[_, target]| target.distance_squared(middle)).sum();
    (squares / pairs.len() as f64).sqrt()
}
