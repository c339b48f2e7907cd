//! Embedding in which each path is a straight line between its targets.
//!
//! Each region between the paths is mapped to a triangle, so its outline is convex, and positive weights give positive
//! faces (Tutte 1963; Floater 2003 if vertices of the outline are collinear).

use super::subdivision::{Role, Subdivision};
use super::target_graph::TargetGraph;
use crate::linalg::Kind;
use crate::linear::FreeSystem;
use crate::linear::fixed_solve::FixedSolve;
use crate::linear::system::Site;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, Embedding, PinPositions, SolveError};
use crate::weights::equations::uniform;
use crate::weights::plane_weights::mean_value_in_plane;

/// Weights that determine the free vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weights {
    /// Mean-value weights of the cells at their present positions, which preserve their angles as far as possible.
    MeanValue,
    /// Equal weights.
    Uniform,
}

/// Positions of all vertices that are not free. Path vertices divide their line in proportion to the previous lengths
/// of its parts, made more equal so that no part is too small.
pub(super) fn held_places(cells: &Subdivision, graph: &TargetGraph, lines: &[Vec<u32>]) -> PinPositions {
    let place = |v: u32| cells.places[v as usize];
    let mut held = PinPositions::new();
    for (line, ends) in lines.iter().zip(&graph.edges) {
        let [from, to] = ends.map(|end| graph.points[end as usize]);
        let lengths: Vec<f64> = line.windows(2).map(|pair| place(pair[0]).distance(place(pair[1]))).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let total = 2.0 * mean * lengths.len() as f64;
        let mut length = 0.0;
        for (&v, part) in line[1..].iter().zip(&lengths) {
            length += part + mean;
            held.insert(VertexId::new(v), from.lerp(to, length / total));
        }
    }
    // Ends come last, so that they have the exact bits of their targets.
    for (line, ends) in lines.iter().zip(&graph.edges) {
        for (v, end) in [(line[0], ends[0]), (line[line.len() - 1], ends[1])] {
            held.insert(VertexId::new(v), graph.points[end as usize]);
        }
    }
    held
}

/// Solves for all vertices of the triangulated cells. `mesh` is the mesh of these triangles.
pub(super) fn straightened(
    mesh: &DiskMesh,
    cells: &Subdivision,
    held: &PinPositions,
    weights: Weights,
    control: Control<'_>,
) -> Result<Embedding, SolveError> {
    let system = FreeSystem::new(mesh, |v| cells.roles[v.index()] != Role::Free, control)?;
    let (equations, kind) = match weights {
        Weights::MeanValue => (mean_value_in_plane(mesh, &cells.places.clone().into(), control)?, Kind::General),
        Weights::Uniform => (uniform(mesh), Kind::Hermitian),
    };
    let site = Site { mesh, system: &system };
    Ok(FixedSolve::new(site, equations, &system.analysis(kind, control)?, control)?.solve(site, held, control)?.0)
}
