//! Run of the mean-value iteration on one trial, and its record.

use num_complex::Complex;

use super::{Limits, Patience, StudySubject, Trial};
use crate::flatten::{Ending, Flattener, Step};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Control, SolveError};
use crate::verify::distortion;
use crate::weights::plane_weights::residuals_in_plane;

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TrialOutcome {
    /// Proved planar.
    Planar,
    /// The iteration no longer improved and hardly moved, or it cycled.
    Stalled,
    /// The step limit was reached.
    Limit,
    /// A step failed. Holds the name of the error.
    Failed(String),
}

impl TrialOutcome {
    /// Name in tables.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Stalled => "stalled",
            Self::Limit => "limit",
            Self::Failed(_) => "failed",
        }
    }

    /// Name of the error of a failed run; otherwise empty.
    pub fn reason(&self) -> &str {
        if let Self::Failed(reason) = self { reason } else { "" }
    }

    /// Outcome with this name. `reason` is the error of a failed run.
    pub fn named(name: &str, reason: &str) -> Option<Self> {
        let all = [Self::Planar, Self::Stalled, Self::Limit, Self::Failed(reason.to_owned())];
        all.into_iter().find(|outcome| outcome.name() == name)
    }
}

/// Numbers of the defects in a verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// Flipped faces.
    pub flips: usize,
    /// Listed boundary crossings.
    pub crossings: usize,
    /// Overwound vertices: their faces wind around them twice or more.
    pub overwound: usize,
    /// Turning number of the boundary, if it is defined.
    pub turning_number: Option<i64>,
    /// True if the map is a mirror image.
    pub mirrored: bool,
}

impl Defects {
    fn of(step: &Step) -> Self {
        let verdict = &step.verdict;
        Self {
            flips: verdict.flipped_faces.len(),
            crossings: verdict.boundary_crossings.len(),
            overwound: verdict.overwound_vertices.len(),
            turning_number: verdict.turning_number,
            mirrored: verdict.mirrored,
        }
    }
}

/// Distance of an iteration from a fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopReason {
    /// Largest move of a vertex in the last step, as a share of the embedding's diameter. Absent if no step followed
    /// the first map.
    pub last_move: Option<f64>,
    /// Largest residual of the mean-value equations of the last embedding at free vertices, dimensionless.
    pub free_residual: f64,
    /// Largest residual of the mean-value equations of the last embedding at pinned vertices, dimensionless.
    /// Treatments drop or weaken these equations first.
    pub pinned_residual: f64,
}

/// A run and its results.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Trial of the run.
    pub trial: Trial,
    /// Number of pins on interior vertices.
    pub pins_inside: usize,
    /// Least distance of two pinned vertices in space, as a share of the diagonal of the mesh's bounding box.
    pub pin_distance: f64,
    /// Outcome of the run.
    pub outcome: TrialOutcome,
    /// Number of mean-value iterations until the end of the run.
    pub steps: usize,
    /// Defects of the first map, if there is one.
    pub first: Option<Defects>,
    /// Mean angle distortion σ₁/σ₂ of the first map. Infinite if a face is flat.
    pub distortion: f64,
    /// Defects of the last map, if there is one.
    pub last: Option<Defects>,
    /// Distance of the last map from a fixed point.
    pub rest: Option<StopReason>,
}

impl Record {
    /// True if the first map is already planar.
    pub fn is_planar_at_once(&self) -> bool {
        self.outcome == TrialOutcome::Planar && self.steps == 0
    }
}

/// Runs a trial to its end: planar, stalled, at the limit, or failed.
///
/// # Errors
///
/// [`SolveError::Cancelled`] if the caller cancels. All other errors are outcomes.
pub fn run(
    subject: &StudySubject<'_>,
    trial: Trial,
    limits: Limits,
    control: Control<'_>,
) -> Result<Record, SolveError> {
    let mesh = subject.mesh;
    let mut ladder = Flattener::new(trial.settings(limits.max_steps), trial.pins.clone());
    let (mut first, mut last) = (None, None);
    let mut angle = f64::INFINITY;
    let mut take = |step: Step| {
        if first.is_none() {
            first = Some(Defects::of(&step));
            angle = distortion(mesh, &step.candidate.solution.embedding).summary.angle.mean;
        }
        let ends = step.verdict.planar || step.index >= limits.max_steps;
        last = Some(step);
        ends
    };
    let mut ending = ladder.finish(mesh, control, |step| _ = take(step));
    while limits.patience == Patience::ToTheLimit && ending == Ok(Ending::Stalled) {
        ending = match ladder.step(mesh, control).map(&mut take) {
            Ok(is_end) => Ok(if is_end { Ending::Limit } else { Ending::Stalled }),
            Err(error) => Err(error),
        };
    }
    let outcome = match ending {
        Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
        Err(error) => TrialOutcome::Failed(error.name().to_owned()),
        Ok(_) if last.as_ref().is_some_and(|step: &Step| step.verdict.planar) => TrialOutcome::Planar,
        Ok(Ending::Limit) => TrialOutcome::Limit,
        Ok(_) => TrialOutcome::Stalled,
    };
    Ok(Record {
        pins_inside: trial.pins.keys().filter(|&&vertex| mesh.boundary_place(vertex).is_none()).count(),
        pin_distance: least_distance(subject, &trial),
        outcome,
        steps: last.as_ref().map_or(0, |step| step.index),
        first,
        distortion: angle,
        last: last.as_ref().map(Defects::of),
        rest: last.as_ref().map(|step| rest_of(mesh, step, &trial)),
        trial,
    })
}

fn least_distance(subject: &StudySubject<'_>, trial: &Trial) -> f64 {
    let vertices: Vec<VertexId> = trial.pins.keys().copied().collect();
    let pairs = vertices.iter().enumerate().flat_map(|(k, &a)| vertices[..k].iter().map(move |&b| [a, b]));
    pairs.map(|[a, b]| subject.distance(a, b)).fold(f64::INFINITY, f64::min)
}

fn rest_of(mesh: &DiskMesh, step: &Step, trial: &Trial) -> StopReason {
    let embedding = &step.candidate.solution.embedding;
    let (mut free_residual, mut pinned_residual) = (0.0_f64, 0.0_f64);
    let residuals = residuals_in_plane(mesh, embedding, Control::unattended()).expect("nobody stops it");
    for (vertex, residual) in mesh.vertices().zip(residuals) {
        let side = if trial.pins.contains_key(&vertex) { &mut pinned_residual } else { &mut free_residual };
        *side = side.max(Complex::norm(residual));
    }
    let diameter = embedding.bounds().diameter();
    StopReason { last_move: step.max_move.map(|length| length / diameter), free_residual, pinned_residual }
}
