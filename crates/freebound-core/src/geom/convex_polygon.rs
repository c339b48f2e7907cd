//! Convex polygons given by the user as a boundary: parsing and checks.
//!
//! Text form: corners separated by semicolons or line ends. Each corner is two numbers separated by a space or a
//! comma. Text from a `#` to the end of its line is a comment. Corners run counter-clockwise, and each turns left in
//! exact arithmetic.

use std::fmt;
use std::sync::Arc;

use glam::DVec2;

use super::{Bounds, Orientation, orientation, turning_number};

/// Largest number of corners of a polygon.
const MOST_CORNERS: usize = 10_000;

/// Largest magnitude of a coordinate. Lengths of larger polygons overflow.
const GREATEST: f64 = 1e100;

/// Smallest extent of a polygon. Lengths in smaller polygons underflow.
const LEAST_EXTENT: f64 = 1e-100;

/// Strictly convex polygon with counter-clockwise corners. Cheap to clone. Polygons with equal corners are equal.
#[derive(Clone, Debug)]
pub struct ConvexPolygon(Corners);

/// Storage of the corners.
#[derive(Clone, Debug)]
enum Corners {
    /// Corners of a polygon built into the program.
    Static(&'static [DVec2]),
    /// Corners of a parsed polygon, shared by its clones.
    Shared(Arc<[DVec2]>),
}

/// Reason for which a text or a list of corners is no convex polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonFault {
    /// A corner that is not two numbers.
    #[error("line {line}: \"{text}\" is not a point: write two numbers, x y")]
    NotAPoint {
        /// Line number, from 1.
        line: usize,
        /// Text of the corner.
        text: String,
    },
    /// Coordinates or an extent outside of the range in which lengths can be computed.
    #[error("corner {corner} is beyond the range of lengths, or all corners coincide")]
    OutOfRange {
        /// Number of the corner, from 1.
        corner: usize,
    },
    /// Fewer than 3 corners.
    #[error("a polygon needs at least 3 corners, found {found}")]
    TooFewCorners {
        /// Number of corners given.
        found: usize,
    },
    /// More corners than the limit.
    #[error("a polygon has at most {most} corners, found {found}")]
    TooManyCorners {
        /// Number of corners given.
        found: usize,
        /// Largest number of corners.
        most: usize,
    },
    /// Corners that all turn right.
    #[error("the corners run clockwise: reverse their order")]
    Clockwise,
    /// Corner that does not turn left.
    #[error("corner {corner}, at {x} {y}, does not turn left: make the polygon strictly convex")]
    NotConvex {
        /// Number of the corner, from 1.
        corner: usize,
        /// Coordinate x of the corner.
        x: f64,
        /// Coordinate y of the corner.
        y: f64,
    },
    /// Corners that all turn left, but wind more than once around.
    #[error("the polygon winds {turns} times around: make it convex, with one turn")]
    WindsAround {
        /// Turning number of the polygon.
        turns: i64,
    },
}

impl ConvexPolygon {
    /// Regular hexagon, the default polygon.
    pub const HEXAGON: Self = Self(Corners::Static(&[
        DVec2::new(1.0, 0.0),
        DVec2::new(0.5, 0.866_025_403_784_438_6),
        DVec2::new(-0.5, 0.866_025_403_784_438_6),
        DVec2::new(-1.0, 0.0),
        DVec2::new(-0.5, -0.866_025_403_784_438_6),
        DVec2::new(0.5, -0.866_025_403_784_438_6),
    ]));

    /// Creates a polygon from counter-clockwise corners.
    ///
    /// # Errors
    ///
    /// Returns the first [`PolygonFault`] of the corners.
    pub fn new(corners: &[DVec2]) -> Result<Self, PolygonFault> {
        check(corners)?;
        // Adding zero turns a negative zero into a positive zero.
        let corners = corners.iter().map(|&corner| corner + DVec2::ZERO).collect();
        Ok(Self(Corners::Shared(corners)))
    }

    /// Parses a polygon from its text form.
    ///
    /// # Errors
    ///
    /// Returns a [`PolygonFault`] for text that is no point, and for corners that make no convex polygon.
    pub fn parse(text: &str) -> Result<Self, PolygonFault> {
        Self::new(&corners_in(text)?)
    }

    /// First fault of a text that is still being typed, if any. Creates no polygon.
    pub fn fault_in(text: &str) -> Option<PolygonFault> {
        corners_in(text).and_then(|corners| check(&corners)).err()
    }

    /// Corners, counter-clockwise.
    pub fn corners(&self) -> &[DVec2] {
        match &self.0 {
            Corners::Static(corners) => corners,
            Corners::Shared(corners) => corners,
        }
    }
}

impl PartialEq for ConvexPolygon {
    fn eq(&self, other: &Self) -> bool {
        self.corners() == other.corners()
    }
}

impl Eq for ConvexPolygon {}

/// Writes the corners in the text form that [`ConvexPolygon::parse`] reads.
impl fmt::Display for ConvexPolygon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let corners: Vec<String> = self.corners().iter().map(|corner| format!("{} {}", corner.x, corner.y)).collect();
        f.write_str(&corners.join("; "))
    }
}

fn corners_in(text: &str) -> Result<Vec<DVec2>, PolygonFault> {
    let mut corners = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.split('#').next().unwrap_or_default();
        for part in content.split(';').map(str::trim).filter(|part| !part.is_empty()) {
            let not_a_point = || PolygonFault::NotAPoint { line, text: part.to_owned() };
            corners.push(point(part).ok_or_else(not_a_point)?);
        }
    }
    Ok(corners)
}

fn point(text: &str) -> Option<DVec2> {
    let numbers = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    let numbers: Vec<f64> = numbers.map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let &[x, y] = numbers.as_slice() else { return None };
    Some(DVec2::new(x, y)).filter(|point| point.is_finite())
}

fn check(corners: &[DVec2]) -> Result<(), PolygonFault> {
    let count = corners.len();
    if count < 3 {
        return Err(PolygonFault::TooFewCorners { found: count });
    }
    if count > MOST_CORNERS {
        return Err(PolygonFault::TooManyCorners { found: count, most: MOST_CORNERS });
    }
    // A comparison with NaN is false.
    let is_near = |corner: &DVec2| corner.abs().max_element() <= GREATEST && corner.is_finite();
    if let Some(place) = corners.iter().position(|corner| !is_near(corner)) {
        return Err(PolygonFault::OutOfRange { corner: place + 1 });
    }
    if Bounds::of(corners.iter().copied()).size().max_element() < LEAST_EXTENT {
        return Err(PolygonFault::OutOfRange { corner: 1 });
    }
    let turn = |k: usize| {
        let [a, b, c] = [corners[(k + count - 1) % count], corners[k], corners[(k + 1) % count]];
        orientation(a, b, c)
    };
    if (0..count).all(|k| turn(k) == Some(Orientation::Clockwise)) {
        return Err(PolygonFault::Clockwise);
    }
    if let Some(k) = (0..count).find(|&k| turn(k) != Some(Orientation::CounterClockwise)) {
        return Err(PolygonFault::NotConvex { corner: k + 1, x: corners[k].x, y: corners[k].y });
    }
    match turning_number(corners) {
        Some(1) => Ok(()),
        turns => Err(PolygonFault::WindsAround { turns: turns.unwrap_or_default() }),
    }
}
