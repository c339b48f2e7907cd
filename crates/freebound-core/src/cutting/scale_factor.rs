//! Logarithm of the scale factor of the conformal map that is flat apart from the cut.
//!
//! ```text
//! L u = K off the cut,   u = 0 on the cut
//! ```
//!
//! L is the cotangent Laplacian, positive semidefinite, and K the angle defect. The map scales lengths by e^u. Free
//! edges of the cut are isometric. The distortion of a conformal map is the variation of u:
//!
//! ```text
//! mean of |J|² + |J⁻¹|²  =  mean of 4 cosh 2(u − ū)  ≈  4 + 8 Var(u)
//! ```
//!
//! A small hole counts as one vertex, with the curvature that its flat filling would have.
//!
//! Source: M. Ben-Chen, C. Gotsman, G. Bunin, "Conformal Flattening by Curvature Prescription and Metric Scaling",
//! 2008; the isometric boundary follows R. Sawhney, K. Crane, "Boundary First Flattening", 2017.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

use nalgebra_sparse::{CooMatrix, CscMatrix};

use super::surface::CutSurface;
use crate::linalg::{Analysis, Factor, Kind, LinalgError};
use crate::mesh::triangle_of_sides;

/// Least slack of the triangle inequality, relative to the mean edge length (Sharp and Crane 2020, mollification).
const SLACK: f64 = 1e-4;

/// Laplacian and curvature of a surface.
#[derive(Debug)]
pub(super) struct ConformalSystem {
    /// Node of each vertex: small holes are one node.
    pub(super) node_of: Vec<u32>,
    /// A vertex of each node.
    pub(super) vertex_of: Vec<u32>,
    laplacian: CscMatrix<f64>,
    curvature: Vec<f64>,
    /// Area at each node, a third of each triangle.
    area: Vec<f64>,
    analysis: Analysis,
}

/// Scale factors for one cut.
#[derive(Debug)]
pub(super) struct ScaleFactors {
    /// Logarithm of the scale factor at each node.
    pub(super) u: Vec<f64>,
    is_fixed: Vec<bool>,
    factor: Factor<f64>,
}

impl ConformalSystem {
    pub(super) fn new(surface: &CutSurface<'_>, cancel: &AtomicBool) -> Result<Self, LinalgError> {
        let (node_of, vertex_of) = nodes(surface);
        let shapes = mollified(surface);
        let count = vertex_of.len();
        let (mut curvature, mut area) = (vec![TAU; count], vec![0.0; count]);
        let mut entries = CooMatrix::new(count, count);
        for (corners, &sides) in surface.triangles.iter().zip(&shapes) {
            let [a, b, c] = triangle_of_sides(sides);
            let double_area = (b - a).cross(c - a).length();
            let points = [a, b, c];
            for k in 0..3 {
                let [at, next, before] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| points[k]);
                let (along, other) = (next - at, before - at);
                let [node, first, second] =
                    [k, (k + 1) % 3, (k + 2) % 3].map(|k| node_of[corners[k] as usize] as usize);
                curvature[node] -= double_area.atan2(along.dot(other));
                area[node] += double_area / 6.0;
                let weight = 0.5 * along.dot(other) / double_area;
                if first != second {
                    for [row, column] in [[first, second], [second, first]] {
                        entries.push(row, row, weight);
                        entries.push(row, column, -weight);
                    }
                }
            }
        }
        for (vertex, number) in surface.loop_of.iter().enumerate().filter_map(|(v, of)| of.map(|of| (v, of))) {
            // A vertex of the boundary has the defect π − θ. Those of a small hole sum to that of its node.
            let is_small = !surface.is_required[number as usize];
            curvature[node_of[vertex] as usize] += if is_small { PI } else { -PI };
        }
        let laplacian = CscMatrix::from(&entries);
        let analysis = Analysis::new(Kind::Hermitian, laplacian.pattern(), cancel)?;
        Ok(Self { node_of, vertex_of, laplacian, curvature, area, analysis })
    }

    /// Scale factors that are 1 at fixed nodes. At least one node must be fixed.
    pub(super) fn solve(&self, is_fixed: Vec<bool>, cancel: &AtomicBool) -> Result<ScaleFactors, LinalgError> {
        let mut matrix = self.laplacian.clone();
        for (row, column, value) in matrix.triplet_iter_mut() {
            if is_fixed[row] || is_fixed[column] {
                *value = f64::from(u8::from(row == column));
            }
        }
        let factor = self.analysis.factor(&matrix, cancel)?;
        let rhs: Vec<f64> =
            self.curvature.iter().zip(&is_fixed).map(|(k, &is_fixed)| if is_fixed { 0.0 } else { *k }).collect();
        let u = factor.substitute(&rhs, cancel)?;
        Ok(ScaleFactors { u, is_fixed, factor })
    }

    /// Nodes whose angle defect is larger than `least`, radians.
    pub(super) fn curved_nodes(&self, least: f64) -> impl Iterator<Item = usize> {
        self.curvature.iter().enumerate().filter(move |(_, defect)| defect.abs() > least).map(|(node, _)| node)
    }

    /// Replaces the curvature by its difference from an even distribution over the surface, of the same total.
    pub(super) fn evened(&self) -> Vec<f64> {
        let total: f64 = self.curvature.iter().sum();
        let area: f64 = self.area.iter().sum();
        self.curvature.iter().zip(&self.area).map(|(k, a)| k - total * a / area).collect()
    }

    /// Variance of numbers at nodes, by area.
    pub(super) fn variance(&self, u: &[f64]) -> f64 {
        let area: f64 = self.area.iter().sum();
        let mean = self.area.iter().zip(u).map(|(a, u)| a * u).sum::<f64>() / area;
        self.area.iter().zip(u).map(|(a, u)| a * (u - mean) * (u - mean)).sum::<f64>() / area
    }

    pub(super) fn node_count(&self) -> usize {
        self.vertex_of.len()
    }
}

impl ScaleFactors {
    /// Scale factors once a node is fixed too.
    pub(super) fn with_fixed(&self, node: usize, cancel: &AtomicBool) -> Result<Vec<f64>, LinalgError> {
        let mut unit = vec![0.0; self.u.len()];
        unit[node] = 1.0;
        let column = self.factor.substitute(&unit, cancel)?;
        let share = self.u[node] / column[node];
        Ok(self.u.iter().zip(&column).map(|(u, c)| u - share * c).collect())
    }

    /// Solution for another right-hand side.
    pub(super) fn solved(&self, rhs: &[f64], cancel: &AtomicBool) -> Result<Vec<f64>, LinalgError> {
        let rhs: Vec<f64> =
            rhs.iter().zip(&self.is_fixed).map(|(k, &is_fixed)| if is_fixed { 0.0 } else { *k }).collect();
        self.factor.substitute(&rhs, cancel)
    }

    pub(super) fn is_fixed(&self, node: usize) -> bool {
        self.is_fixed[node]
    }
}

/// Node of each vertex, and a vertex of each node. The vertices of a small hole are one node.
fn nodes(surface: &CutSurface<'_>) -> (Vec<u32>, Vec<u32>) {
    let mut node_of_loop = vec![None; surface.is_required.len()];
    let mut vertex_of = Vec::new();
    let mut node_of = Vec::with_capacity(surface.vertex_count());
    for (vertex, of) in (0..).zip(&surface.loop_of) {
        let small = of.filter(|&of| !surface.is_required[of as usize]);
        let known = small.and_then(|of| node_of_loop[of as usize]);
        node_of.push(known.unwrap_or_else(|| {
            vertex_of.push(vertex);
            let node = u32::try_from(vertex_of.len() - 1).expect("nodes fit");
            if let Some(of) = small {
                node_of_loop[of as usize] = Some(node);
            }
            node
        }));
    }
    (node_of, vertex_of)
}

/// Lengths of the sides of each triangle, lengthened so far that each triangle has an area.
fn mollified(surface: &CutSurface<'_>) -> Vec<[f64; 3]> {
    let mut lengths: Vec<[f64; 3]> = surface
        .triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|v| surface.position(v));
            [a.distance(b), b.distance(c), c.distance(a)]
        })
        .collect();
    let mean = lengths.iter().flatten().sum::<f64>() / (3 * lengths.len()) as f64;
    let lack =
        |[a, b, c]: [f64; 3]| (SLACK * mean + a - b - c).max(SLACK * mean + b - c - a).max(SLACK * mean + c - a - b);
    let by = lengths.iter().map(|&sides| lack(sides)).fold(0.0, f64::max);
    lengths.iter_mut().flatten().for_each(|length| *length += by);
    lengths
}
