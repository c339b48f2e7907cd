//! Equation of one vertex in a step. The stage of the step determines its family and the embedding of its weights.

use super::Step;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Embedding, Family, NoEquation, Stage, WeightSource};
use crate::weights::VertexEquation;
use crate::weights::vertex_equation::{Fan, in_plane, on_surface};

/// Equation of a vertex in a step, with the source of its weights. `before` is the embedding of the previous step.
///
/// # Errors
///
/// [`NoEquation`] with the reason why the vertex has no equation.
pub fn equation_of_step(
    mesh: &DiskMesh,
    step: &Step,
    before: Option<&Embedding>,
    vertex: VertexId,
) -> Result<(VertexEquation, WeightSource), NoEquation> {
    let embedding = &step.candidate.solution.embedding;
    let source = step.candidate.stage.weight_source()?;
    match step.candidate.stage {
        Stage::Convex(_) if mesh.boundary_place(vertex).is_some() => return Err(NoEquation::Prescribed),
        Stage::Lee(_) if mesh.boundary_place(vertex).is_some() => return Err(NoEquation::Peeled),
        _ if step.is_spectral() && mesh.boundary_place(vertex).is_some() => return Err(NoEquation::OfEigenvector),
        _ => {}
    }
    match (source, &step.candidate.virtual_boundary) {
        (WeightSource::StepBefore, _) => {
            let before = before.ok_or(NoEquation::StepBeforeMissing)?;
            Ok((in_plane(mesh, &Fan::of_mesh(mesh, vertex), before, embedding), source))
        }
        (WeightSource::Extended, Some(stages)) if stages.hull.contains(&vertex) => Err(NoEquation::Prescribed),
        (WeightSource::Extended, Some(stages)) if !stages.weights_of_before => Err(NoEquation::OtherWeights),
        (WeightSource::Extended, Some(stages)) => {
            let fan = Fan::of_extended(mesh, &stages.pockets, vertex);
            Ok((in_plane(mesh, &fan, &stages.before, &stages.solved), source))
        }
        // Without recorded steps of §5, the virtual boundary solved the natural equations with part of the boundary
        // pinned.
        (WeightSource::Surface | WeightSource::Extended, _) => {
            let family = if step.candidate.stage.uses_family() { step.candidate.family } else { Family::Conformal };
            Ok((on_surface(mesh, family, embedding, vertex), WeightSource::Surface))
        }
    }
}
