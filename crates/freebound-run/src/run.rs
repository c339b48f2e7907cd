//! All charts of a mesh, from their problems to a finished output.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::fmt::Display;
use std::io;
use std::time::Instant;

use rayon::prelude::*;

use super::{Model, RequestFault, SolvedModel, finished_atlas};
use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{Diagnosis, DiskMesh};
use freebound_core::pipeline::{Fit, PipelineOptions, Problem, SolvedProblem, Surface};
use freebound_core::problem::{Control, Embedding, SolveError};
use freebound_io::{LayoutError, Output, SeamsReport, StepReport};

/// Flattening of a prepared mesh, of one chart or several.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Options. Targets use the vertex numbers of the mesh, also with several charts.
    pub options: PipelineOptions,
    /// Size of the texture coordinates.
    pub fit: Fit,
    /// Numbers of the charts that stay where the layout to start from has them.
    pub locked: BTreeSet<usize>,
    /// True if all files that are written keep the materials of the source. Charts of different materials may then
    /// overlap, because each material has a picture of its own.
    pub keeps_materials: bool,
}

/// Reason why a run has no result. `E` is the error of its observer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError<E: Display = Infallible> {
    /// The mesh, or a chart of it, is not a disk.
    #[error("the mesh cannot be flattened\n{0}")]
    NotADisk(Box<Diagnosis>),
    /// The layout to start from is missing or torn.
    #[error("{0}")]
    Layout(LayoutError),
    /// The solver found no map, or was cancelled. Vertices are numbered as in the file.
    #[error("{0}")]
    Solve(SolveError),
    /// An option does not fit the mesh.
    #[error("{0}")]
    Request(RequestFault),
    /// Packed charts cannot be scaled to the area of the surface.
    #[error("{0}")]
    TrueSize(io::Error),
    /// The observer of the steps has stopped the run.
    #[error("{0}")]
    Observer(E),
}

impl<E: Display> From<SolveError> for RunError<E> {
    fn from(error: SolveError) -> Self {
        Self::Solve(error)
    }
}

impl RunError {
    /// Error of a run with an observer that fails.
    pub fn with_observer<E: Display>(self) -> RunError<E> {
        match self {
            Self::NotADisk(diagnosis) => RunError::NotADisk(diagnosis),
            Self::Layout(error) => RunError::Layout(error),
            Self::Solve(error) => RunError::Solve(error),
            Self::Request(fault) => RunError::Request(fault),
            Self::TrueSize(error) => RunError::TrueSize(error),
            Self::Observer(never) => match never {},
        }
    }
}

/// Chart with its problem.
#[derive(Debug)]
pub struct ChartProblem {
    /// The chart, or the mesh if it has only one.
    pub model: Model,
    /// Problem of the chart.
    pub problem: Problem,
}

/// Chart at the end of its run.
#[derive(Debug)]
pub struct ChartRun {
    /// The chart, or the mesh if it has only one.
    pub model: Model,
    /// Last step.
    pub solved: SolvedProblem,
    /// Report on each step.
    pub records: Vec<StepReport>,
    /// Texture coordinates where the chart stays. Default: the chart is packed.
    locked: Option<Embedding>,
}

impl Run {
    /// True if the charts of a mesh are laid out together: there are several, or a density is given.
    pub fn is_packed(&self, model: &Model) -> bool {
        model.prepared.chart.is_some() || self.options.packing.density.is_some()
    }

    /// Charts of a mesh with their problems.
    pub fn problems(&self, model: &Model) -> Vec<ChartProblem> {
        if !self.is_packed(model) {
            return vec![ChartProblem { model: model.clone(), problem: self.options.problem() }];
        }
        let models: Vec<Model> = (0..model.chart_count()).into_par_iter().map(|chart| model.of_chart(chart)).collect();
        let problems = self.options.problems(&models.iter().map(|model| &model.prepared).collect::<Vec<_>>());
        models.into_iter().zip(problems).map(|(model, problem)| ChartProblem { model, problem }).collect()
    }

    /// Takes all steps of all charts, which are solved in parallel. `observe` receives each step; several threads may
    /// call it at once.
    ///
    /// # Errors
    ///
    /// [`RunError`] of the first chart that has one, in the order of the charts.
    pub fn solve<E: Display + Send>(
        &self,
        charts: Vec<ChartProblem>,
        control: Control<'_>,
        observe: impl Fn(&DiskMesh, &Step) -> Result<(), E> + Sync,
    ) -> Result<SolvedRun, RunError<E>> {
        let first = charts.first();
        let is_packed = first.is_some_and(|first| self.is_packed(&first.model));
        let solve = |(number, ChartProblem { model, problem }): (usize, ChartProblem)| {
            let locked = self.locked.contains(&number).then(|| model.layout()).transpose().map_err(RunError::Layout)?;
            let (solved, records) = solved_chart(&model, problem, control, &observe)?;
            Ok(ChartRun { model, solved, records, locked })
        };
        let solved: Vec<Result<ChartRun, RunError<E>>> = if is_packed {
            charts.into_par_iter().enumerate().map(solve).collect()
        } else {
            charts.into_iter().enumerate().map(solve).collect()
        };
        // The first failure in the order of the charts is independent of the threads.
        let charts = solved.into_iter().collect::<Result<_, _>>()?;
        Ok(SolvedRun { charts, is_packed })
    }
}

/// Mesh whose charts are solved.
#[derive(Debug)]
pub struct SolvedRun {
    /// The charts, in order.
    pub charts: Vec<ChartRun>,
    is_packed: bool,
}

impl SolvedRun {
    /// Lays out the charts, proves them, and reports the run. Times of reading and writing are left at 0.
    ///
    /// # Errors
    ///
    /// If charts are to be scaled to the area of the surface and have different scales.
    pub fn output(&self, run: &Run) -> io::Result<Output<'_>> {
        let before = Instant::now();
        let mut output = match &self.charts[..] {
            [ChartRun { model, solved, records, .. }] if !self.is_packed => {
                model.finished(&solved.outcome, records.clone(), run.fit)
            }
            charts => {
                let solved: Vec<SolvedModel<'_>> = charts.iter().map(|chart| chart.to_lay(run)).collect();
                let mut output = finished_atlas(&solved, run.options.packing, run.options.arrangement);
                if run.fit == Fit::True {
                    output.scale_to_true_size()?;
                }
                output.report.seconds.verify = before.elapsed().as_secs_f64();
                output
            }
        };
        let seams = self.charts[0].model.automatic_seams();
        output.report.seams = seams.map(SeamsReport::of);
        output.report.seconds.cut = seams.map_or(0.0, |seams| seams.seconds);
        Ok(output)
    }
}

impl ChartRun {
    /// Mesh of the last step: the chart, or its refinement.
    pub(super) fn mesh(&self) -> &DiskMesh {
        let disk = self.model.prepared.disk().expect("only a disk is solved");
        self.solved.outcome.step.candidate.mesh(disk)
    }

    fn to_lay(&self, run: &Run) -> SolvedModel<'_> {
        let of = self.model.prepared.chart.as_ref();
        SolvedModel {
            model: &self.model,
            outcome: &self.solved.outcome,
            steps: &self.records,
            size: of.map_or(1.0, |of| run.options.size_of(&of.charts, of.number)),
            tile: of.and_then(|of| run.options.tile_of(&of.charts, of.number)),
            locked: self.locked.as_ref(),
            stacked_on: None,
            keeps_materials: run.keeps_materials,
        }
    }
}

/// Error within the steps of one chart.
enum Stop<E> {
    Solve(SolveError),
    Observer(E),
}

impl<E> From<SolveError> for Stop<E> {
    fn from(error: SolveError) -> Self {
        Self::Solve(error)
    }
}

/// Takes all steps of the method on one chart.
fn solved_chart<E: Display>(
    model: &Model,
    problem: Problem,
    control: Control<'_>,
    observe: impl Fn(&DiskMesh, &Step) -> Result<(), E>,
) -> Result<(SolvedProblem, Vec<StepReport>), RunError<E>> {
    let mesh = match &model.prepared.surface {
        Surface::Disk(disk) => disk,
        Surface::Faulty(_, diagnosis) => return Err(RunError::NotADisk(Box::new(diagnosis.as_ref().clone()))),
    };
    let options = model.flattener_options(&problem).map_err(RunError::Layout)?;
    let mut records = Vec::new();
    let solved = problem.solve(mesh, Flattener::with_options(options), control, |step| {
        records.push(StepReport::of(step));
        observe(mesh, step).map_err(Stop::Observer)
    });
    match solved {
        Ok(solved) => Ok((solved, records)),
        Err(Stop::Solve(error)) => Err(RunError::Solve(error.renumbered(|vertex| model.vertex_in_file(vertex)))),
        Err(Stop::Observer(error)) => Err(RunError::Observer(error)),
    }
}
