//! The paths straightened: an embedding in which each is a straight line between its targets.
//!
//! The regions between the paths are mapped into triangles, so every one of them has a convex outline, and positive
//! weights give positive faces (Tutte 1963; Floater 2003 where vertices of the outline lie on one line).

use glam::DVec2;

use super::subdivision::{Role, Subdivision};
use super::target_graph::TargetGraph;
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, VertexId};
use crate::solver::equations::Equations;
use crate::solver::free_solve::in_vertices;
use crate::solver::plane_weights::mean_value_in_plane;
use crate::solver::{Control, Embedding, FreeSystem, PinPositions, SolveError};

/// What the free vertices are drawn by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weights {
    /// Mean values of the cells as they lay before: the angles of the start, as far as can be.
    MeanValue,
    /// All the same.
    Uniform,
}

/// Places of all vertices that are not free: path vertices share their line in proportion to the lengths that the parts
/// had, made a little more equal, so that none is too small.
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
    // The ends last, so that they are where they are to be to the last bit.
    for (line, ends) in lines.iter().zip(&graph.edges) {
        for (v, end) in [(line[0], ends[0]), (line[line.len() - 1], ends[1])] {
            held.insert(VertexId::new(v), graph.points[end as usize]);
        }
    }
    held
}

/// Places all vertices of the triangulated cells, which are `mesh`.
pub(super) fn straightened(
    mesh: &DiskMesh,
    cells: &Subdivision,
    held: &PinPositions,
    weights: Weights,
    control: Control<'_>,
) -> Result<Embedding, SolveError> {
    let start = Embedding::from(cells.places.clone());
    let mut places = start.clone();
    for (&v, &place) in held {
        places[v] = place;
    }
    let system = FreeSystem::new(mesh, |v| cells.roles[v.index()] != Role::Free);
    if system.free().is_empty() {
        return Ok(places);
    }
    let (equations, kind) = match weights {
        Weights::MeanValue => (mean_value_in_plane(mesh, &start), Kind::General),
        Weights::Uniform => {
            let coefficients = vec![1.0; mesh.halfedge_count()];
            (Equations { coefficients, bounded_corners: 0 }, Kind::Hermitian)
        }
    };
    let matrix = system.negated_matrix(mesh, &equations);
    let named = |error| in_vertices(error, system.free());
    let factor = Analysis::new(kind, system.pattern())
        .and_then(|analysis| analysis.factor(&matrix, control.cancel()))
        .map_err(named)?;
    let terms: Vec<DVec2> = system.pinned_terms(mesh, &equations, held);
    let both: Vec<f64> = terms.iter().map(|z| z.x).chain(terms.iter().map(|z| z.y)).collect();
    let solved = factor.solve_many(&matrix, &both).map_err(named)?;
    let (x, y) = solved.x.split_at(terms.len());
    for (&v, (&x, &y)) in system.free().iter().zip(x.iter().zip(y)) {
        places[v] = DVec2::new(x, y);
    }
    Ok(places)
}
