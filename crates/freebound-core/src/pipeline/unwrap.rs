//! Unwrapping of any mesh to a proved atlas: repair, cut, flatten, pack.

use glam::DVec2;

use crate::mesh::{Diagnosis, DiskMesh, Done, PolygonMesh, TriMesh, VertexId, parts};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};
use crate::verify::{AtlasVerdict, atlas_verdict};

use super::{
    AutomaticSeams, ChartSummary, Fit, LaidChart, MeshToCut, PipelineOptions, PreparedMesh, Problem, SolvedChart,
    SolvedProblem, Surface, atlas, prove_atlas,
};
use crate::cutting::SeamOptions;
use crate::flatten::Flattener;

/// Corner of a face that has no texture coordinate, because its part was left out.
pub const NO_COORDINATE: u32 = u32::MAX;

/// Texture coordinates of a mesh, proved one-to-one.
#[derive(Clone, Debug)]
pub struct Unwrapped {
    /// Texture coordinates, v up. Vertices on seams have several.
    pub coordinates: Embedding,
    /// Index into `coordinates` of each corner of the input, in the order of its faces. [`NO_COORDINATE`] if a corner
    /// has none.
    pub corners: Vec<u32>,
    /// Exact verdict on all charts together.
    pub verdict: AtlasVerdict,
    /// Summary of each chart.
    pub charts: Vec<ChartSummary>,
    /// Repairs and cuts that were made, in order.
    pub repairs: Vec<Done>,
}

/// Reason why [`unwrap`] has no result.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UnwrapError {
    /// The mesh is not a surface that repairs and cuts could make flat.
    #[error("{0}")]
    NotASurface(Box<Diagnosis>),
    /// A chart could not be flattened.
    #[error("chart {chart}: {error}")]
    Solve {
        /// Number of the chart, from 0.
        chart: usize,
        /// Reason.
        error: SolveError,
    },
    /// The map is not one-to-one, or a hard pin is not at its target.
    #[error("the map is not planar or misses a pin: {}", .0.verdict.summary())]
    NotPlanar(Box<Unwrapped>),
}

impl PipelineOptions {
    /// Options for any mesh: all repairs are allowed. Surfaces that are no disks are cut open along short seams, with
    /// an energy of at most [`SeamOptions::DISTORTION`].
    pub fn for_any_mesh() -> Self {
        let options = Self::default();
        let distortion = Some(SeamOptions::DISTORTION);
        Self { preparation: options.preparation.with_all_repairs(), distortion, ..options }
    }
}

/// Unwraps any mesh: repairs and cuts it as the options allow, flattens every chart, packs the charts into the unit
/// square and proves the whole. A mesh of one chart is packed if the options give a density. Edges are never split: the
/// mesh gets no new vertices from a method.
///
/// # Errors
///
/// [`UnwrapError`] if the mesh cannot be made flat, a chart cannot be solved, or the result is not proved planar with
/// its hard pins met.
///
/// # Example
///
/// ```
/// use freebound_core::mesh::PolygonMesh;
/// use freebound_core::{PipelineOptions, unwrap};
///
/// // A closed tetrahedron.
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
/// let mesh = PolygonMesh::from_arrays(&positions, &faces);
/// let unwrapped = unwrap(&mesh, &PipelineOptions::for_any_mesh())?;
/// assert!(unwrapped.verdict.planar);
/// assert_eq!(unwrapped.corners.len(), 12);
/// # Ok::<(), freebound_core::UnwrapError>(())
/// ```
pub fn unwrap(mesh: &PolygonMesh, options: &PipelineOptions) -> Result<Unwrapped, UnwrapError> {
    unwrap_with(mesh, options, Control::unattended())
}

/// [`unwrap`] with progress and cancellation.
///
/// # Errors
///
/// Errors of [`unwrap`]. Cancellation is [`UnwrapError::Solve`] with [`SolveError::Cancelled`].
pub fn unwrap_with(
    mesh: &PolygonMesh,
    options: &PipelineOptions,
    control: Control<'_>,
) -> Result<Unwrapped, UnwrapError> {
    let mut options = options.clone();
    options.settings.new_vertices = false;
    let turned = options.preparation.faces_turned.then(|| mesh.turned());
    let mesh = turned.as_ref().unwrap_or(mesh);
    let form = &options.preparation;
    let find = |bound| {
        let visibility = options.seam_visibility.unwrap_or(SeamOptions::VISIBILITY);
        let seam_options = SeamOptions { most_charts: options.most_charts, visibility, ..SeamOptions::new(bound) };
        AutomaticSeams::find(MeshToCut { mesh, labels: None, form }, seam_options, control, &|_| {})
    };
    let seams = options.distortion.filter(|_| form.cut).map(find).transpose();
    let seams = seams.map_err(|error| UnwrapError::Solve { chart: 0, error })?;
    let seams = seams.as_ref();
    let prepared = PreparedMesh::new(mesh, None, seams.map_or(form, |seams| &seams.form).clone());
    if let Surface::Faulty(_, diagnosis) = &prepared.surface {
        return Err(UnwrapError::NotASurface(Box::new(diagnosis.as_ref().clone())));
    }
    let unwrapped = match &prepared.chart {
        Some(_) => unwrap_charts(mesh, &prepared, seams, &options, control)?,
        None => unwrap_disk(mesh, &prepared, seams, &options, control)?,
    };
    let has_met_pins = unwrapped.charts.iter().all(|chart| chart.pins.unmet.is_empty());
    if unwrapped.verdict.planar && has_met_pins {
        Ok(unwrapped)
    } else {
        Err(UnwrapError::NotPlanar(Box::new(unwrapped)))
    }
}

fn unwrap_disk(
    mesh: &PolygonMesh,
    prepared: &PreparedMesh,
    seams: Option<&AutomaticSeams>,
    options: &PipelineOptions,
    control: Control<'_>,
) -> Result<Unwrapped, UnwrapError> {
    let disk = prepared.disk().expect("faulty surfaces were refused");
    let map = seams.and_then(|seams| prepared.map_of_corners(mesh, &seams.corners));
    let solved = solved_on(disk, options.problem(), map, control);
    let solved = solved.map_err(|error| UnwrapError::Solve { chart: 0, error })?;
    let (coordinates, placement, verdict) = solved.outcome.output(disk, Fit::Unit);
    let picture = DVec2::new(options.frame.aspect, 1.0) * f64::from(options.packing.picture[1]);
    let chart = SolvedChart::new(prepared, &solved.outcome);
    let (laid, summary) = if options.packing.density.is_some() {
        let mut packed = atlas(&[chart], options.packing, options.arrangement);
        (packed.charts.remove(0), packed.summaries.remove(0))
    } else {
        let (summary, held) = (chart.summary(&coordinates, picture, placement), solved.outcome.held());
        let laid = LaidChart::only(disk, coordinates, verdict, held);
        (laid, summary)
    };
    let number = |vertex: Option<VertexId>| vertex.map_or(NO_COORDINATE, VertexId::number);
    let corners = match &prepared.repaired {
        Some(repaired) => repaired.vertices_at_corners(mesh).into_iter().map(number).collect(),
        None => mesh.corners.iter().map(|&vertex| vertex.number()).collect(),
    };
    let verdict = prove_atlas(std::slice::from_ref(&laid));
    Ok(Unwrapped { coordinates: laid.coordinates, corners, verdict, charts: vec![summary], repairs: done(prepared) })
}

fn unwrap_charts(
    mesh: &PolygonMesh,
    prepared: &PreparedMesh,
    seams: Option<&AutomaticSeams>,
    options: &PipelineOptions,
    control: Control<'_>,
) -> Result<Unwrapped, UnwrapError> {
    let charts: Vec<PreparedMesh> =
        (0..prepared.chart_count()).into_par_iter().map(|chart| prepared.of_chart(chart)).collect();
    let problems = options.problems(&charts.iter().collect::<Vec<_>>());
    let solve = |(chart, (prepared, problem)): (usize, (&PreparedMesh, super::Problem))| {
        let Surface::Disk(disk) = &prepared.surface else {
            return Err(UnwrapError::NotASurface(Box::default()));
        };
        let map = seams.and_then(|seams| prepared.map_of_corners(mesh, &seams.corners));
        solved_on(disk, problem, map, control).map_err(|error| UnwrapError::Solve { chart, error })
    };
    let work: Vec<_> = charts.iter().zip(problems).enumerate().collect();
    let solved: Vec<Result<_, UnwrapError>> = work.into_par_iter().map(solve).collect();
    // In the order of the charts: the first failure in time would depend on the threads.
    let solved = solved.into_iter().collect::<Result<Vec<_>, _>>()?;
    let to_lay: Vec<SolvedChart<'_>> =
        charts.iter().zip(&solved).map(|(chart, solved)| options.solved_chart(chart, &solved.outcome)).collect();
    let laid = atlas(&to_lay, options.packing, options.arrangement);
    let whole = prepared.whole_repaired().expect("several charts come of a repaired mesh");
    let mut numbers = vec![NO_COORDINATE; whole.polygons().positions.len()];
    let mut coordinates = Vec::new();
    for chart in &laid.charts {
        for (vertex, &uv) in chart.vertex_of.unwrap_or_default().iter().zip(&chart.coordinates) {
            numbers[vertex.index()] = VertexId::from_index(coordinates.len()).number();
            coordinates.push(uv);
        }
    }
    let number = |vertex: Option<VertexId>| vertex.map_or(NO_COORDINATE, |vertex| numbers[vertex.index()]);
    let corners = whole.vertices_at_corners(mesh).into_iter().map(number).collect();
    let (verdict, charts) = (laid.verdict, laid.summaries);
    Ok(Unwrapped { coordinates: coordinates.into(), corners, verdict, charts, repairs: done(prepared) })
}

/// Solution of a disk or chart, from the map of its automatic seams if there is one.
fn solved_on(
    disk: &DiskMesh,
    problem: Problem,
    map: Option<Embedding>,
    control: Control<'_>,
) -> Result<SolvedProblem, SolveError> {
    let options = problem.options_with_map(map);
    problem.solve(disk, Flattener::with_options(options), control, |_| Ok(()))
}

fn done(prepared: &PreparedMesh) -> Vec<Done> {
    prepared.whole_repaired().map(|repaired| repaired.done().to_vec()).unwrap_or_default()
}

/// Decides exactly if a given layout is one-to-one. `coordinates` has one texture coordinate per vertex of `mesh`, v
/// up. A layout with seams needs a mesh that is cut along them, with one vertex per coordinate.
///
/// # Errors
///
/// Faults of a part that is not an oriented surface with a boundary.
///
/// # Panics
///
/// If the numbers of coordinates and vertices differ.
pub fn verify(mesh: &TriMesh, coordinates: &Embedding) -> Result<AtlasVerdict, Box<Diagnosis>> {
    assert_eq!(coordinates.len(), mesh.vertex_count(), "a coordinate for every vertex");
    Ok(atlas_verdict(&parts(mesh)?, coordinates).as_in_file(mesh))
}
