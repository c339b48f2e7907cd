//! Stage 5: new vertices, followed by the removal of those that a relaxed embedding does not need.

use std::sync::Arc;
use std::time::Instant;

use super::stage::{RunStage, StageFailure, StageInput, StepState};
use super::task::Task;
use super::{Candidate, Ending, Step};
use crate::bijective::matchmaker::{Matched, matched, simplified, with_clearance};
use crate::bijective::relaxing::Relaxing;
use crate::mesh::{DiskMesh, Refinement};
use crate::problem::{Control, SolveError, Stage};

/// Most rounds of relaxing before each removal of new vertices.
const ROUNDS_BEFORE_REMOVAL: usize = 10;
/// Most removals of new vertices.
const REMOVALS: usize = 12;

/// Least share of new vertices removed by a removal that is followed by another.
const WORTHWHILE: f64 = 0.05;

/// Rounds of relaxing after the paths were made straight.
const ROUNDS_AFTER_MATCHMAKER: usize = 30;

/// Rounds of relaxing of a tangle. There a round takes seconds and hardly improves the embedding: paths wind around
/// each other, and so does the map.
const ROUNDS_OF_TANGLE: usize = 1;

/// Least number of new vertices of a tangle.
const NEW_VERTICES_OF_TANGLE: usize = 20_000;
/// Least ratio of new vertices to mesh vertices of a tangle.
const NEW_PER_OLD_OF_TANGLE: usize = 4;

#[derive(Debug, Default)]
pub(super) struct Match {
    stage: MatchmakerPhase,
}

#[derive(Debug, Default)]
enum MatchmakerPhase {
    #[default]
    Begin,
    /// The constraints are met with new vertices, some of which may be removable once the embedding has relaxed.
    Refined { found: Box<Matched>, looks_left: usize },
    /// No further step.
    End,
}

impl RunStage for Match {
    fn step(&mut self, from: StageInput<'_>, control: Control<'_>) -> Result<Candidate, StageFailure> {
        let StageInput { task, mesh, latest } = from;
        let (began, held, frame) = (Instant::now(), task.held(), &*task.frame);
        // Collinearity and folds are tested in the written numbers.
        let bare = |written: Matched| -> Result<Matched, SolveError> {
            let Matched { refinement, embedding } = simplified(mesh, written, control)?;
            let embedding = if frame.is_plain() { embedding } else { frame.in_plane(&embedding, &held) };
            Ok(Matched { refinement, embedding })
        };
        let (found, looks_left) = match &self.stage {
            MatchmakerPhase::Begin => {
                let latest = latest.ok_or(SolveError::NotPlanar)?;
                let start = latest.onward.as_ref().unwrap_or(&latest.embedding);
                let pins = frame.written_pins(&held);
                let found = bare(matched(mesh, &frame.written(start), &pins, control)?)?;
                let looks = if is_tangle(&found.refinement) { 0 } else { REMOVALS };
                (found, looks)
            }
            MatchmakerPhase::Refined { found: before, looks_left } => {
                let Matched { refinement, embedding } = relaxed(before, task, control)?;
                let bare = bare(Matched { embedding: frame.written(&embedding).into_owned(), refinement })?;
                let found = with_clearance_on_frame(mesh, bare, task, control)?;
                let count = before.refinement.new_vertices().len();
                let taken_out = count - found.refinement.new_vertices().len();
                let is_worthwhile = taken_out as f64 > WORTHWHILE * count as f64;
                (found, if is_worthwhile { looks_left - 1 } else { 0 })
            }
            MatchmakerPhase::End => return Err(SolveError::Unmet.into()),
        };
        let candidate = Candidate::one_to_one(Stage::Matchmaker, found.embedding.clone(), &held).since(began);
        let count = found.refinement.new_vertices().len();
        let tangled = || format!("paths wind around each other, with {count} new vertices: barely relaxed");
        let note = is_tangle(&found.refinement).then(tangled);
        let refinement = Some(Arc::clone(&found.refinement));
        self.stage = if looks_left > 0 {
            MatchmakerPhase::Refined { found: Box::new(found), looks_left }
        } else {
            MatchmakerPhase::End
        };
        Ok(Candidate { refinement, note, ..candidate })
    }

    fn has_more(&self, _: &Task, _: Option<&StepState>) -> bool {
        !matches!(self.stage, MatchmakerPhase::End)
    }

    fn improves(&self) -> bool {
        matches!(self.stage, MatchmakerPhase::Refined { .. })
    }

    fn relax_rounds_after(&self, _: &Task, step: &Step) -> usize {
        let is_of_tangle = step.candidate.refinement.as_deref().is_some_and(is_tangle);
        if is_of_tangle { ROUNDS_OF_TANGLE } else { ROUNDS_AFTER_MATCHMAKER }
    }

    fn ending(&self, _: &Task) -> Ending {
        Ending::Unmet
    }
}

/// True if new vertices outnumber those of the mesh so far that all work on them takes minutes and gains little.
pub(super) fn is_tangle(refinement: &Refinement) -> bool {
    let least = NEW_VERTICES_OF_TANGLE.max(NEW_PER_OLD_OF_TANGLE * refinement.old_vertex_count());
    refinement.new_vertices().len() > least
}

/// Result with its embedding relaxed.
fn relaxed(found: &Matched, task: &Task, control: Control<'_>) -> Result<Matched, SolveError> {
    let disk: &DiskMesh = found.refinement.disk();
    let frame = Arc::clone(&task.frame);
    let mut relaxing = Relaxing::new(disk, found.embedding.clone(), &task.held()).with_output_frame(frame);
    let mut embedding = found.embedding.clone();
    for _ in 0..ROUNDS_BEFORE_REMOVAL {
        embedding = relaxing.round(disk, control)?.embedding;
        if relaxing.has_converged {
            break;
        }
    }
    Ok(Matched { refinement: Arc::clone(&found.refinement), embedding })
}

/// Result without the new vertices that can be removed with clearance, if that is one-to-one in the written numbers;
/// otherwise `bare`.
fn with_clearance_on_frame(
    mesh: &DiskMesh,
    bare: Matched,
    task: &Task,
    control: Control<'_>,
) -> Result<Matched, SolveError> {
    let found = with_clearance(mesh, bare.clone(), &task.held(), control)?;
    let is_sound = task.frame.is_one_to_one(found.refinement.disk(), &found.embedding);
    Ok(if is_sound { found } else { bare })
}
