//! What follows where a one-to-one embedding keeps polygons that are concave: these are cut into triangles.
//!
//! A polygon cannot be convex where only two polygons meet at a vertex inside, or where exact pins hold its corners so.
//! Its triangles are positive: cut into them, it is no matter how other programs would cut it.

use std::sync::Arc;
use std::time::Instant;

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::mesh::Refinement;
use crate::solver::{Control, Method, SolveError};

/// The cut: one step after a step that has no other fault.
#[derive(Debug, Default)]
pub(super) struct Cut;

impl Rung for Cut {
    fn step(&mut self, Footing { mesh, latest, .. }: Footing<'_>, _: Control<'_>) -> Result<Candidate, Failure> {
        let began = Instant::now();
        let latest = latest.ok_or(SolveError::NotPlanar)?;
        let concave = &latest.concave_polygons;
        let refinement = match &latest.refinement {
            Some(refinement) => (**refinement).clone().without_polygons(concave),
            None => Refinement::of_cut_polygons(mesh, concave).map_err(|_| SolveError::NotPlanar)?,
        };
        let note = match concave.len() {
            1 => "1 polygon cannot be convex here: it is cut into triangles".to_owned(),
            count => format!("{count} polygons cannot be convex here: they are cut into triangles"),
        };
        let candidate = Candidate::one_to_one(Method::Cut, latest.embedding.clone(), &latest.pins).since(began);
        Ok(Candidate { refinement: Some(Arc::new(refinement)), note: Some(note), ..candidate })
    }

    fn has_more(&self, task: &Task, latest: Option<&Latest>) -> bool {
        task.cuts_polygons()
            && latest.is_some_and(|latest| latest.is_solved_but_for_polygons && !latest.concave_polygons.is_empty())
    }
}
