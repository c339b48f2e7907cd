//! A convex boundary: the boundary loop laid on a convex shape (Tutte 1963, Floater 1997).
//!
//! Along the shape vertices lie as far apart as in space, in proportion, or evenly. Where the shape has corners, vertices
//! lie on these: those of the loop that come nearest to the corners' shares of the whole length, or, on the hull of the
//! boundary's projection, those whose projections the corners are. The vertices between two corners lie along the side,
//! one after another: by their lengths, or evenly.
//!
//! Where two vertices of one side are joined by an edge that is not of the boundary, no face beyond that edge has an area:
//! the theorem asks for a strictly convex shape there, such as the circle.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::hull_corners::hull_corners;
use crate::mesh::DiskMesh;
use crate::problem::{BoundaryShape, PinPositions, SolveError, Spacing};

/// The corners of the unit square.
const SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];

/// A vertex of the loop that lies on a corner of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// Its place in the loop.
    pub(crate) place: usize,
    /// Where it lies.
    pub(crate) at: DVec2,
}

/// Lays the boundary loop on a shape, whose size is that of the shape alone.
///
/// # Errors
///
/// [`SolveError::BoundaryTooShort`] where the shape has more corners than the boundary has vertices,
/// [`SolveError::NoHull`] where the boundary's projection has no hull to lie on.
pub fn convex_boundary(mesh: &DiskMesh, shape: &BoundaryShape, spacing: Spacing) -> Result<PinPositions, SolveError> {
    let places = on_shape(mesh, &boundary_lengths(mesh), shape, spacing)?;
    Ok(mesh.boundary_loop().iter().copied().zip(places).collect())
}

/// The length of each edge of the loop, from its vertex to the next.
pub(crate) fn boundary_lengths(mesh: &DiskMesh) -> Vec<f64> {
    let boundary = mesh.boundary_loop();
    boundary.iter().zip(boundary.iter().cycle().skip(1)).map(|(&a, &b)| mesh.length([a, b])).collect()
}

/// Places on a shape for a loop with as many vertices as the boundary, and with these lengths.
pub(crate) fn on_shape(
    mesh: &DiskMesh,
    lengths: &[f64],
    shape: &BoundaryShape,
    spacing: Spacing,
) -> Result<Vec<DVec2>, SolveError> {
    let count = lengths.len();
    let arcs = match spacing {
        Spacing::Chord => arcs(lengths),
        Spacing::Even => (0..count).map(|place| place as f64 / count as f64).collect(),
    };
    let corners = match shape {
        BoundaryShape::Circle => return Ok(arcs.iter().map(|&s| DVec2::from_angle(s * TAU)).collect()),
        BoundaryShape::Square => nearest_to_corners(&SQUARE, &arcs, "a square")?,
        BoundaryShape::Polygon(polygon) => nearest_to_corners(polygon.corners(), &arcs, "the polygon")?,
        BoundaryShape::Hull => {
            let boundary: Vec<DVec3> = mesh.boundary_loop().iter().map(|&v| mesh.position(v)).collect();
            hull_corners(&boundary).ok_or(SolveError::NoHull)?
        }
    };
    Ok(between(&corners, &arcs))
}

/// Share of a loop's length before each of its vertices, from 0 towards 1.
fn arcs(lengths: &[f64]) -> Vec<f64> {
    let total: f64 = lengths.iter().sum();
    let mut walked = 0.0;
    lengths
        .iter()
        .map(|length| {
            let here = walked / total;
            walked += length;
            here
        })
        .collect()
}

/// The first corner at the loop's first vertex, the others at those nearest to their shares of the outline.
fn nearest_to_corners(outline: &[DVec2], arcs: &[f64], shape: &'static str) -> Result<Vec<Corner>, SolveError> {
    let (count, needed) = (arcs.len(), outline.len());
    if count < needed {
        return Err(SolveError::BoundaryTooShort { shape, found: count, needed });
    }
    let sides: Vec<f64> =
        outline.iter().zip(outline.iter().cycle().skip(1)).map(|(corner, next)| corner.distance(*next)).collect();
    let perimeter: f64 = sides.iter().sum();
    let mut walked = sides[0];
    let mut corners = vec![Corner { place: 0, at: outline[0] }];
    for (side, &at) in outline.iter().enumerate().skip(1) {
        let wanted = walked / perimeter;
        walked += sides[side];
        let after = arcs.partition_point(|&s| s < wanted);
        let nearest = if after < count && arcs[after] - wanted < wanted - arcs[after - 1] { after } else { after - 1 };
        // Each side keeps at least one edge.
        let place = nearest.clamp(corners[side - 1].place + 1, count + side - needed);
        corners.push(Corner { place, at });
    }
    Ok(corners)
}

/// All vertices of the loop, those between two corners along the side: corners as they follow each other around the loop.
fn between(corners: &[Corner], arcs: &[f64]) -> Vec<DVec2> {
    let count = arcs.len();
    let arc = |place: usize| arcs[place % count] + (place / count) as f64;
    let mut places = vec![DVec2::ZERO; count];
    for (begin, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let end = if next.place > begin.place { next.place } else { next.place + count };
        let (from, to) = (arc(begin.place), arc(end));
        for place in begin.place..end {
            let along = if to > from { (arc(place) - from) / (to - from) } else { 0.0 };
            places[place % count] = begin.at.lerp(next.at, along);
        }
    }
    places
}
