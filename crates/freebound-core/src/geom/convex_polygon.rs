//! Convex polygons that a user gives as a boundary: reading and checks.
//!
//! Text form: corners separated by semicolons or line ends, each of two numbers separated by a space or a comma. Text from
//! a `#` to the end of its line is a comment. Corners run counter-clockwise, and each turns left in exact arithmetic.

use std::fmt;
use std::sync::Arc;

use glam::DVec2;

use super::{Bounds, Orientation, orientation, turning_number};

/// The most corners.
const MOST_CORNERS: usize = 10_000;

/// The greatest coordinate, and the least extent of all: beyond these, lengths run out of range.
const GREATEST: f64 = 1e100;
const LEAST_EXTENT: f64 = 1e-100;

/// A strictly convex polygon with counter-clockwise corners. Cheap to clone. Polygons with equal corners are equal.
#[derive(Clone, Debug)]
pub struct ConvexPolygon(Corners);

/// Storage of the corners.
#[derive(Clone, Debug)]
enum Corners {
    /// Corners of a polygon that is part of the program.
    Static(&'static [DVec2]),
    /// Corners of a polygon that was read, shared by its copies.
    Shared(Arc<[DVec2]>),
}

/// Why a text or a list of corners is no convex polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonFault {
    /// A corner that is not two numbers.
    #[error("line {line}: \"{text}\" is no point: write two numbers, x y")]
    NotAPoint {
        /// The line, from 1.
        line: usize,
        /// What stands there.
        text: String,
    },
    /// Coordinates beyond the range in which lengths can be told.
    #[error("corner {corner} lies beyond the range of numbers that lengths can be told of, or all lie in one place")]
    OutOfRange {
        /// The corner, from 1.
        corner: usize,
    },
    /// Too few corners for an area.
    #[error("a polygon has 3 corners or more, found {found}")]
    TooFewCorners {
        /// How many there are.
        found: usize,
    },
    /// More corners than are taken.
    #[error("a polygon has {most} corners at most, found {found}")]
    TooManyCorners {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// All corners turn right.
    #[error("its corners run clockwise: write them the other way around")]
    Clockwise,
    /// A corner that does not turn left.
    #[error("corner {corner}, at {x} {y}, does not turn left: the polygon has to be convex, without straight corners")]
    NotConvex {
        /// The corner, from 1.
        corner: usize,
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
    },
    /// Every corner turns left, but more than once around.
    #[error("it winds {turns} times around: a convex polygon does so once")]
    WindsAround {
        /// How often.
        turns: i64,
    },
}

impl ConvexPolygon {
    /// A regular hexagon, where nobody says which polygon it is to be.
    pub const HEXAGON: Self = Self(Corners::Static(&[
        DVec2::new(1.0, 0.0),
        DVec2::new(0.5, 0.866_025_403_784_438_6),
        DVec2::new(-0.5, 0.866_025_403_784_438_6),
        DVec2::new(-1.0, 0.0),
        DVec2::new(-0.5, -0.866_025_403_784_438_6),
        DVec2::new(0.5, -0.866_025_403_784_438_6),
    ]));

    /// Takes corners that make a convex polygon, counter-clockwise.
    ///
    /// # Errors
    ///
    /// What is wrong with them.
    pub fn new(corners: &[DVec2]) -> Result<Self, PolygonFault> {
        check(corners)?;
        // A negative zero is zero.
        let corners = corners.iter().map(|&corner| corner + DVec2::ZERO).collect();
        Ok(Self(Corners::Shared(corners)))
    }

    /// Reads corners.
    ///
    /// # Errors
    ///
    /// A line that is no point, or what is wrong with the corners.
    pub fn parse(text: &str) -> Result<Self, PolygonFault> {
        Self::new(&corners_in(text)?)
    }

    /// What is wrong with a text, if anything, while it is only being typed: nothing is kept of it.
    pub fn fault_in(text: &str) -> Option<PolygonFault> {
        corners_in(text).and_then(|corners| check(&corners)).err()
    }

    /// The corners, counter-clockwise.
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

/// The corners as they are read.
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
