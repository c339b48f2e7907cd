//! A convex boundary: the boundary loop laid on a circle or a square (Tutte 1963, Floater 1997).

use std::f64::consts::TAU;

use glam::DVec2;

use super::{BoundaryShape, PinPositions, SolveError};
use crate::mesh::DiskMesh;

/// Lays the boundary loop on a shape of unit area-like size, in proportion to its edge lengths.
///
/// # Errors
///
/// [`SolveError::BoundaryTooShort`] for a square with fewer than four boundary vertices.
pub fn convex_boundary(mesh: &DiskMesh, shape: BoundaryShape) -> Result<PinPositions, SolveError> {
    let arcs = boundary_arcs(mesh);
    let places = match shape {
        BoundaryShape::Circle => arcs.iter().map(|&s| DVec2::from_angle(s * TAU)).collect(),
        BoundaryShape::Square => on_square(&arcs)?,
    };
    Ok(mesh.boundary_loop().iter().copied().zip(places).collect())
}

/// Share of the boundary's length before each vertex of the loop, from 0 towards 1.
fn boundary_arcs(mesh: &DiskMesh) -> Vec<f64> {
    let boundary = mesh.boundary_loop();
    let lengths: Vec<f64> =
        boundary.iter().zip(boundary.iter().cycle().skip(1)).map(|(&a, &b)| mesh.length([a, b])).collect();
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

/// Corners of the square at the vertices nearest to the quarters of the boundary, sides filled in proportion.
fn on_square(arcs: &[f64]) -> Result<Vec<DVec2>, SolveError> {
    let count = arcs.len();
    if count < 4 {
        return Err(SolveError::BoundaryTooShort { found: count, needed: 4 });
    }
    let mut corners = [0; 4];
    for side in 1..4 {
        let wanted = side as f64 / 4.0;
        let after = arcs.partition_point(|&s| s < wanted);
        let nearest = if after < count && arcs[after] - wanted < wanted - arcs[after - 1] { after } else { after - 1 };
        // Each side keeps at least one edge.
        corners[side] = nearest.clamp(corners[side - 1] + 1, count + side - 4);
    }
    let outline = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y, DVec2::ZERO];
    let mut places = Vec::with_capacity(count);
    for side in 0..4 {
        let (begin, end) = (corners[side], corners.get(side + 1).copied().unwrap_or(count));
        let (from, to) = (arcs[begin], arcs.get(end).copied().unwrap_or(1.0));
        for &s in &arcs[begin..end] {
            let along = if to > from { (s - from) / (to - from) } else { 0.0 };
            places.push(outline[side].lerp(outline[side + 1], along));
        }
    }
    Ok(places)
}
