//! Entry point: everything that a run needs, and its result as arrays.

use std::collections::{BTreeMap, BTreeSet};
use std::convert::Infallible;
use std::fmt::Display;

use super::layout::FinishedRun;
use super::{AutomaticCut, MeshLayout, Model, NoSuchPart, PartChoice, Run, RunError, SeamKind};
use freebound_core::flatten::Step;
use freebound_core::mesh::{DiskMesh, Preparation, Repairs, VertexId};
use freebound_core::pipeline::{Fit, PipelineOptions, Surface, Target, Targets};
use freebound_core::problem::{Control, Settings, SolveError};
use freebound_io::{LabelError, Precision, TextureError};

/// Run of a mesh from its preparation to its layout. Default: `flatten` of a disk, with safe repairs.
#[derive(Clone, Debug, Default)]
pub struct RunRequest {
    /// Repairs, seams, holes and parts of the mesh.
    pub preparation: Preparation,
    /// Kinds of edges that the mesh is cut along, too.
    pub seam_kinds: Vec<SeamKind>,
    /// Search for automatic seams. Default: none; the preparation may still cut along shortest paths.
    pub automatic_cut: Option<AutomaticCut>,
    /// Parts of the mesh that are flattened. Default: all.
    pub parts: Option<PartChoice>,
    /// Options of the solver and of the packing. Pins name vertices of the mesh.
    pub run: Run,
    /// Pins at corners of the mesh, by their index in the list of corners. A vertex on a seam has a place for each of its
    /// charts, and a corner names one of them.
    pub corner_pins: Vec<(usize, Target)>,
    /// Sizes of packed charts relative to the others, by the numbers of the charts. Default: 1.
    pub chart_sizes: BTreeMap<usize, f64>,
    /// True if every chart stays where the layout to start from has it, even if charts overlap there.
    pub locks_all_charts: bool,
    /// Rounds of relaxing if the settings name none, and a part has no map from the search for seams.
    pub usual_relax_rounds: Option<usize>,
    /// Precision in which coordinates are proved. Default: 64 bits.
    pub precision: Option<Precision>,
}

/// Option of a [`RunRequest`] that does not fit the mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RequestFault {
    /// A pinned vertex was joined with another vertex, which can be pinned instead.
    #[error("vertex {vertex} is pinned, but was joined with vertex {other}: pin {other}")]
    JoinedPin {
        /// Pinned vertex.
        vertex: VertexId,
        /// Vertex that it was joined with.
        other: VertexId,
    },
    /// A pinned corner belongs to a face that is left out, or does not exist.
    #[error("corner {0} cannot be pinned: its face is not flattened")]
    NoSuchCorner(usize),
    /// A vertex is pinned to two places, by itself or by corners of one chart.
    #[error("vertex {0} is pinned to two places: remove one of the pins")]
    PinnedTwice(VertexId),
    /// The size of a chart that is not packed.
    #[error("chart {chart} has a size, but {why}, so it is not packed")]
    IdleSize {
        /// Number of the chart.
        chart: usize,
        /// Reason why the chart is not packed.
        why: &'static str,
    },
    /// True size does not go with another option.
    #[error("fit true: {0}")]
    TrueSize(&'static str),
    /// A chart that a size or a lock names does not exist.
    #[error("there is no chart {chart}: the mesh has {count}, numbered from 0")]
    NoSuchChart {
        /// Number of the chart.
        chart: usize,
        /// Number of charts.
        count: usize,
    },
    /// A chosen part does not exist.
    #[error("{0}")]
    Part(NoSuchPart),
    /// The mesh has no materials or groups to cut along.
    #[error("{0}: remove the seams along them")]
    Labels(LabelError),
    /// The mesh is to be cut along texture coordinates that it does not have.
    #[error("{0}")]
    Texture(TextureError),
}

impl RunRequest {
    /// Rounds of relaxing of an unwrapped mesh that needed no seams.
    pub const UNWRAP_ROUNDS: usize = 40;

    /// Unwrapping of any mesh: all repairs are allowed. Surfaces that are no disks are cut along short seams with an
    /// energy of at most [`SeamOptions::DISTORTION`](freebound_core::cutting::SeamOptions::DISTORTION).
    pub fn unwrap() -> Self {
        let distortion = Some(freebound_core::cutting::SeamOptions::DISTORTION);
        Self {
            preparation: Preparation { repair: Repairs::ALL, cut: true, ..Preparation::default() },
            automatic_cut: Some(AutomaticCut { distortion, ..AutomaticCut::default() }),
            usual_relax_rounds: Some(Self::UNWRAP_ROUNDS),
            ..Self::default()
        }
    }

    /// Runs to the end.
    ///
    /// # Errors
    ///
    /// [`RunError`] if there is no layout. A layout that is not proved planar is no error here: see
    /// [`MeshLayout::is_fine`].
    pub fn run(&self, mesh: &Model) -> Result<MeshLayout, RunError> {
        self.run_with(mesh, Control::unattended(), |_, _| Ok::<(), Infallible>(()))
    }

    /// [`run`](Self::run) with progress and cancellation. `observe` receives each step of each chart; several threads may
    /// call it at once.
    ///
    /// # Errors
    ///
    /// Errors of [`run`](Self::run), and of `observe`.
    pub fn run_with<E: Display + Send>(
        &self,
        mesh: &Model,
        control: Control<'_>,
        observe: impl Fn(&DiskMesh, &Step) -> Result<(), E> + Sync,
    ) -> Result<MeshLayout, RunError<E>> {
        let model = self.prepared(mesh, control).map_err(RunError::with_observer)?;
        if let Surface::Faulty(_, diagnosis) = &model.prepared.surface {
            return Err(RunError::NotADisk(Box::new(diagnosis.as_ref().clone())));
        }
        let targets = self.targets_on(&model).map_err(RunError::with_observer)?;
        let run = self.run_on(&model, targets).map_err(RunError::Request)?;
        let solved = run.solve(run.problems(&model), control, observe)?;
        MeshLayout::new(FinishedRun { model, run, solved, precision: self.precision }).map_err(RunError::TrueSize)
    }

    /// Mesh in its preparation, cut along its seams.
    ///
    /// # Errors
    ///
    /// [`RunError::Request`] if the mesh lacks what an option needs, and [`RunError::Solve`] if the caller cancels.
    pub fn prepared(&self, mesh: &Model, control: Control<'_>) -> Result<Model, RunError> {
        let mut form = self.preparation.clone();
        if form.seams.of_texture {
            mesh.source.texture_labels().map_err(|error| RunError::Request(RequestFault::Texture(error)))?;
        }
        // Vertices that a repair joins count as joined.
        let uncut = mesh.asking_for(Preparation { repair: form.repair, ..Preparation::default() });
        for &kind in &self.seam_kinds {
            let edges = uncut.edges_of(kind).map_err(|error| RunError::Request(RequestFault::Labels(error)))?;
            form.seams = form.seams.with(edges);
        }
        let model = mesh.in_form(form);
        let model = match self.automatic_cut {
            Some(options) => model.cut_automatically(options, control, &|_| {})?,
            None => model,
        };
        match &self.parts {
            Some(parts) => model.with_parts(parts).map_err(|error| RunError::Request(RequestFault::Part(error))),
            None => Ok(model),
        }
    }

    /// Targets of all pins, by the vertices of the prepared mesh.
    ///
    /// # Errors
    ///
    /// Errors of [`Model::check_targets`], and [`RunError::Request`] for a corner without a vertex.
    pub fn targets_on(&self, model: &Model) -> Result<Targets, RunError> {
        let mut targets = self.run.options.targets.clone();
        model.check_targets(&targets)?;
        if self.corner_pins.is_empty() {
            return Ok(targets);
        }
        let polygons = &model.source.polygons;
        let at_corners = model.whole_repaired().map(|repaired| repaired.vertices_at_corners(polygons));
        let vertex_at = |corner: usize| match &at_corners {
            Some(vertices) => vertices.get(corner).copied().flatten(),
            None => polygons.corners.get(corner).copied(),
        };
        for &(corner, target) in &self.corner_pins {
            let vertex = vertex_at(corner).ok_or(RunError::Request(RequestFault::NoSuchCorner(corner)))?;
            // Several corners may name one place.
            if targets.insert(vertex, target).is_some_and(|before| before != target) {
                return Err(RunError::Request(RequestFault::PinnedTwice(model.vertex_in_file(vertex))));
            }
        }
        Ok(targets)
    }

    /// Run of the prepared mesh.
    fn run_on(&self, model: &Model, targets: Targets) -> Result<Run, RequestFault> {
        let Run { options, locked, .. } = &self.run;
        let count = model.chart_count();
        let locked = if self.locks_all_charts { (0..count).collect() } else { locked.clone() };
        let mut numbers = self.chart_sizes.keys().chain(&locked);
        if let Some(&chart) = numbers.find(|&&chart| chart >= count) {
            return Err(RequestFault::NoSuchChart { chart, count });
        }
        self.check_sizes(model, &targets)?;
        self.check_true_size(model, &targets)?;
        let charts = model.prepared.chart.as_ref().map(|of| &of.charts);
        let sizes = self.chart_sizes.iter().filter_map(|(&chart, &size)| Some((charts?.first_face(chart), size)));
        let relax_rounds = options.settings.relax_rounds.or_else(|| model.usual_rounds(self.usual_relax_rounds));
        Ok(Run {
            options: PipelineOptions {
                preparation: model.prepared.form.clone(),
                sizes: sizes.collect(),
                settings: Settings { relax_rounds, ..options.settings.clone() },
                targets,
                ..options.clone()
            },
            locked,
            ..self.run.clone()
        })
    }

    /// Rejects sizes of charts that are not packed.
    fn check_sizes(&self, model: &Model, targets: &Targets) -> Result<(), RequestFault> {
        let charts = model.prepared.chart.as_ref().map(|of| &of.charts);
        let chart_of = |vertex: &VertexId| charts.and_then(|charts| charts.chart_of_vertex(*vertex));
        let pinned: BTreeSet<usize> = targets.keys().filter_map(chart_of).collect();
        for &chart in self.chart_sizes.keys() {
            let faults = [
                (charts.is_none(), "it is the only chart"),
                (pinned.contains(&chart), "it is pinned"),
                (self.locks_all_charts || self.run.locked.contains(&chart), "it is locked"),
            ];
            if let Some((_, why)) = faults.into_iter().find(|(is_so, _)| *is_so) {
                return Err(RequestFault::IdleSize { chart, why });
            }
        }
        Ok(())
    }

    /// Rejects true size if other options set the scale.
    fn check_true_size(&self, model: &Model, targets: &Targets) -> Result<(), RequestFault> {
        let Run { options, fit, locked, .. } = &self.run;
        let is_packed = self.run.is_packed(model);
        let has_own_scales =
            self.locks_all_charts || !(targets.is_empty() && self.chart_sizes.is_empty() && locked.is_empty());
        let faults = [
            (options.has_picture, "the map is scaled to a picture"),
            (is_packed && has_own_scales, "charts with pins, locks or sizes have scales of their own"),
            (options.packing.density.is_some(), "the density sets the size of the charts"),
            (is_packed && options.packing.tiles > 1, "tiles are unit squares"),
        ];
        let fault = faults.into_iter().find(|(is_so, _)| *is_so && *fit == Fit::True);
        fault.map_or(Ok(()), |(_, why)| Err(RequestFault::TrueSize(why)))
    }
}

impl Model {
    /// Rounds of relaxing that follow by default: `usual`, or none if the search for automatic seams has mapped every
    /// part.
    pub fn usual_rounds(&self, usual: Option<usize>) -> Option<usize> {
        let has_map = self.automatic_seams().is_some_and(|seams| seams.corners.iter().all(Option::is_some));
        usual.filter(|_| !has_map)
    }

    /// Rejects pins of vertices that were joined with others, and, if the mesh has several charts, of vertices without a
    /// chart.
    ///
    /// # Errors
    ///
    /// [`RunError::Request`] for a joined vertex, and [`RunError::Solve`] for a vertex without a chart.
    pub fn check_targets(&self, targets: &Targets) -> Result<(), RunError> {
        let joined = |&vertex: &VertexId| Some((vertex, self.whole_repaired()?.stands_for(vertex)?));
        if let Some((vertex, other)) = targets.keys().find_map(joined) {
            return Err(RunError::Request(RequestFault::JoinedPin { vertex, other }));
        }
        let Some(of) = &self.prepared.chart else { return Ok(()) };
        let count = self.vertex_count_in_file();
        match targets.keys().find(|&&vertex| of.charts.chart_of_vertex(vertex).is_none()) {
            Some(&vertex) if vertex.index() >= count => Err(SolveError::NoSuchVertex { vertex, count }.into()),
            Some(&vertex) => Err(SolveError::UnusedVertex { vertex }.into()),
            None => Ok(()),
        }
    }
}
