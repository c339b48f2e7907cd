//! New places for the charts of a given layout.

use std::collections::BTreeSet;
use std::path::PathBuf;

use freebound_core::mesh::FaceId;
use freebound_core::pipeline::{ChartSizes, LockedCharts, RepackError, RepackOptions, Repacked};
use freebound_core::problem::Control;
use freebound_io::WriteError;
use freebound_io::{FaultReport, LayoutPacking, LayoutToPackError, Materials, OutputKind, RepackedFile, Report};
use freebound_run::Model;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

use super::job::{in_pool, interruptible};
use super::layout::{kind_of, precision_of};
use super::mesh::{self, Mesh};
use super::options::{Options, of_json};
use super::{arrays, errors};

/// Layout with new places for its charts.
#[pyclass(frozen, module = "freebound", name = "_Packed")]
pub(crate) struct Packed {
    model: Model,
    repacked: Repacked,
    report: Report,
}

impl Packed {
    fn file(&self) -> RepackedFile<'_> {
        RepackedFile {
            source: &self.model.source,
            source_path: self.model.path.as_deref(),
            materials: Materials::Stay,
            repacked: self.repacked.clone(),
            report: self.report.clone(),
        }
    }
}

#[pymethods]
impl Packed {
    #[getter]
    fn corner_uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        mesh::corner_uv(py, &self.repacked.coordinates, &self.repacked.corners)
    }

    /// Chart of each face, −1 for faces without a triangle.
    #[getter]
    fn chart<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let mut chart_of = vec![None; self.model.source.polygons.face_count()];
        for (face, chart) in self.repacked.chart_of_triangles() {
            chart_of[face as usize] = Some(chart);
        }
        of_charts(py, chart_of)
    }

    #[getter]
    fn planar(&self) -> bool {
        self.repacked.is_planar()
    }

    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        errors::to_python(py, &self.report)
    }

    /// Writes a file of the kind that its extension names. Returns the files written, and if the written numbers are
    /// planar.
    #[pyo3(signature = (path, precision=None))]
    fn write(&self, py: Python<'_>, path: PathBuf, precision: Option<&str>) -> PyResult<(Vec<PathBuf>, bool)> {
        let precision = precision.map(|name| precision_of(py, name)).transpose()?;
        let kind = kind_of(py, &path, &[OutputKind::Obj, OutputKind::Ply, OutputKind::Glb, OutputKind::Svg])?;
        let mut file = self.file();
        let write = || -> Result<_, WriteError> {
            file.round_to(precision, if kind.is_mesh() { kind } else { OutputKind::Obj });
            let files = file.write(kind, &path)?;
            Ok((files, file.repacked.is_planar()))
        };
        let written = py.detach(|| in_pool(0, write)).map_err(PyRuntimeError::new_err)?;
        written.map_err(|error| PyOSError::new_err(error.to_string()))
    }
}

/// Chart of each face of a given layout, −1 for faces without a triangle.
#[pyfunction]
pub(crate) fn charts<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let model = mesh.model();
    let found = py.detach(|| model.source.layout_charts());
    found.map(|charts| of_charts(py, charts)).map_err(|error| of_layout(py, &error))
}

/// Numbers of charts, −1 for none.
fn of_charts(py: Python<'_>, charts: Vec<Option<usize>>) -> Bound<'_, PyArray1<i64>> {
    let number = |chart: Option<usize>| chart.and_then(|chart| i64::try_from(chart).ok()).unwrap_or(-1);
    arrays::list(py, charts.into_iter().map(number).collect())
}

/// Error of a layout that cannot be packed.
fn of_layout(py: Python<'_>, error: &LayoutToPackError) -> PyErr {
    match error {
        LayoutToPackError::Texture(error) => errors::input_error(py, error, &FaultReport::of_texture(error)),
        LayoutToPackError::Repack(RepackError::Cancelled) => errors::cancelled(py),
        LayoutToPackError::Repack(RepackError::NoSuchFace { face, .. }) => no_face(py, face.number().into()),
        _ => errors::input_error(py, error, &[]),
    }
}

fn no_face(py: Python<'_>, face: i64) -> PyErr {
    errors::option_error(py, format!("lock: there is no face {face}"))
}

/// Rules for the charts of a given layout.
#[derive(FromPyObject)]
pub(crate) struct ChartRules<'py> {
    /// Faces whose charts stay in place.
    #[pyo3(item)]
    locked: Option<PyReadonlyArray1<'py, i64>>,
    #[pyo3(item)]
    keeps_sizes: bool,
    /// Width over height of the picture of the given layout.
    #[pyo3(item)]
    aspect: Option<f64>,
}

/// Packs the charts of a mesh. `options` is a JSON object; the packing ends if `stop` returns true.
#[pyfunction]
#[pyo3(signature = (mesh, options, rules, stop=None))]
pub(crate) fn pack(
    py: Python<'_>,
    mesh: &Mesh,
    options: &str,
    rules: ChartRules<'_>,
    stop: Option<&Bound<'_, PyAny>>,
) -> PyResult<Packed> {
    let options: Options = of_json(py, options)?;
    let (packing, precision) = options.packing_and_precision(py)?;
    let threads = options.threads.map_or(0, usize::from);
    let [width, height] = packing.picture.map(f64::from);
    let ChartRules { locked, keeps_sizes, aspect } = rules;
    if aspect.is_some_and(|aspect| !(aspect.is_normal() && aspect > 0.0)) {
        return Err(errors::option_error(py, "aspect: pass width over height, above 0"));
    }
    let locked = match &locked {
        Some(faces) => faces.as_slice()?,
        None => &[],
    };
    let faces = locked.iter().map(|&face| u32::try_from(face).map(FaceId::new).map_err(|_| no_face(py, face)));
    let faces = faces.collect::<PyResult<BTreeSet<FaceId>>>()?;
    let sizes = if keeps_sizes { ChartSizes::AsGiven } else { ChartSizes::EqualDensity };
    let options = RepackOptions { packing, sizes, locked: LockedCharts::WithFaces(faces) };
    let packing = LayoutPacking { options, aspect: aspect.unwrap_or(width / height) };
    let model = mesh.model();
    let work = |control: Control<'_>| {
        let mut file = RepackedFile::new(&model.source, model.path_words(), &packing, control)?;
        if precision.is_some() {
            file.round_to(precision, OutputKind::Obj);
        }
        Ok((file.repacked, file.report))
    };
    match interruptible(py, threads, stop, work)? {
        Ok((repacked, report)) => Ok(Packed { model, repacked, report }),
        Err(error) => Err(of_layout(py, &error)),
    }
}
