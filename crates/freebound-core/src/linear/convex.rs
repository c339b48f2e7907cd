//! Convex boundary: the boundary loop placed on a convex shape (Tutte 1963, Floater 1997).
//!
//! Distances along the shape are proportional to the edge lengths in space, or equal. If the shape has corners, some
//! vertices of the loop lie on them: the vertices nearest to the shares of the corners in the whole length. On the
//! hull of the projected boundary, the corners are projections of vertices, which lie on them. The vertices between
//! two corners lie along the side in order, spaced by their lengths or evenly.
//!
//! If an inner edge joins two vertices of one side, the faces beyond that edge have no area. The theorem requires a
//! strictly convex shape for such meshes, for instance the circle.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::hull_corners::hull_corners;
use crate::mesh::DiskMesh;
use crate::problem::{BoundaryShape, PinPositions, SolveError, Spacing};

/// Corners of the unit square.
const SQUARE: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];

/// Vertex of the loop that lies on a corner of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    /// Index in the loop.
    pub(crate) place: usize,
    /// Position of the corner.
    pub(crate) at: DVec2,
}

/// Places the boundary loop on a shape. The shape alone determines the size.
///
/// # Errors
///
/// [`SolveError::BoundaryTooShort`] if the shape has more corners than the boundary has vertices,
/// [`SolveError::NoHull`] if the projected boundary has no usable hull.
pub fn convex_boundary(mesh: &DiskMesh, shape: &BoundaryShape, spacing: Spacing) -> Result<PinPositions, SolveError> {
    let places = on_shape(mesh, &boundary_lengths(mesh), shape, spacing)?;
    Ok(mesh.boundary_loop().iter().copied().zip(places).collect())
}

/// Length of each edge of the loop, from its vertex to the next.
pub(crate) fn boundary_lengths(mesh: &DiskMesh) -> Vec<f64> {
    let boundary = mesh.boundary_loop();
    boundary.iter().zip(boundary.iter().cycle().skip(1)).map(|(&a, &b)| mesh.length([a, b])).collect()
}

/// Positions on a shape for a loop with the given edge lengths and the vertices of the boundary.
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

/// Share of the length of a loop before each of its vertices, from 0 towards 1.
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

/// Assigns corners to vertices: the first corner to the first vertex of the loop, each other corner to the vertex
/// nearest to its share of the outline.
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

/// Positions of all vertices of the loop, interpolated along the side between consecutive corners. Corners are given
/// in the order of the loop.
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
