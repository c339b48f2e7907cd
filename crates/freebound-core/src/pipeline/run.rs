//! Run of one chart, from its problem to its last step.

use super::{Outcome, Problem};
use crate::flatten::{Ending, Flattener, Step};
use crate::mesh::DiskMesh;
use crate::problem::{Control, Embedding, Method, SolveError};

/// A solved problem.
#[derive(Clone, Debug)]
pub struct SolvedProblem {
    /// Last step. If a later stage failed, the last valid step that includes the constraints. If method auto without
    /// targets ends without a planar map, the step with the fewest faults.
    pub outcome: Outcome,
    /// Reason of the end. An error if a later stage failed after valid steps.
    pub ending: Result<Ending, SolveError>,
}

/// Faults of a step, the worst first: not planar, not one-to-one, and the number of defects.
fn faults(step: &Step) -> (bool, bool, usize) {
    let verdict = &step.verdict;
    let defects = [
        verdict.flipped_faces.len(),
        verdict.concave_polygons.len(),
        verdict.boundary_crossings.len(),
        verdict.crossed_holes.len(),
    ];
    (!verdict.planar, !verdict.is_one_to_one(), defects.iter().sum())
}

impl Problem {
    /// Takes all steps of the method on a disk and passes each step to `observe`.
    ///
    /// # Errors
    ///
    /// [`SolveError`] if no step could be taken or the caller cancelled, and the errors of `observe`.
    pub fn solve<E: From<SolveError>>(
        self,
        mesh: &DiskMesh,
        mut flattener: Flattener,
        control: Control<'_>,
        mut observe: impl FnMut(&Step) -> Result<(), E>,
    ) -> Result<SolvedProblem, E> {
        // Only auto chooses among its steps.
        let looks_for_best = self.settings.method == Method::Auto && self.targets.is_empty();
        let mut kept: Option<Step> = None;
        loop {
            let step = match flattener.step(mesh, control) {
                Ok(step) => step,
                Err(SolveError::Cancelled) => return Err(SolveError::Cancelled.into()),
                // Steps before a failed stage are valid.
                Err(error) => {
                    let Some(before) = kept else { return Err(error.into()) };
                    return Ok(SolvedProblem { outcome: Outcome::new(mesh, self, before), ending: Err(error) });
                }
            };
            observe(&step)?;
            let is_worse = |kept: &Step| looks_for_best && faults(&step) > faults(kept);
            if let Some(ending) = flattener.ending() {
                let best = kept.take_if(|kept| is_worse(kept)).unwrap_or(step);
                return Ok(SolvedProblem { outcome: Outcome::new(mesh, self, best), ending: Ok(ending) });
            }
            if !step.is_of_planar_start() && !kept.as_ref().is_some_and(is_worse) {
                kept = Some(step);
            }
        }
    }

    /// Takes all steps of the method on a disk, from a layout if one is given: one texture coordinate per vertex, v
    /// up.
    ///
    /// # Errors
    ///
    /// [`SolveError`] if no step could be taken or the caller cancelled.
    pub fn solve_on(
        self,
        mesh: &DiskMesh,
        layout: Option<&Embedding>,
        control: Control<'_>,
    ) -> Result<SolvedProblem, SolveError> {
        let options = layout.map_or_else(|| self.options(), |layout| self.options_from(layout));
        let flattener = Flattener::with_options(options);
        self.solve(mesh, flattener, control, |_| Ok(()))
    }
}
