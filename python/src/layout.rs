//! Finished layouts.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use freebound_core::problem::NamedOption as _;
use freebound_io::{OutputKind, Precision};
use freebound_run::{MeshLayout, TriangleOfFace};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use super::job::in_pool;
use super::{arrays, errors, mesh};

/// Texture coordinates of a mesh, with their proof. All arrays are read-only and own their memory.
#[pyclass(frozen, module = "freebound", name = "_Layout", subclass)]
pub(crate) struct Layout {
    pub(crate) inner: Arc<MeshLayout>,
    report: PyOnceLock<Py<PyAny>>,
}

impl Layout {
    pub(crate) fn of(inner: Arc<MeshLayout>) -> Self {
        Self { inner, report: PyOnceLock::new() }
    }

    pub(crate) fn is_fine(&self) -> bool {
        self.inner.is_fine()
    }

    /// Triangles of the proof. The first call computes them, in a pool of its own.
    fn triangles(&self, py: Python<'_>) -> PyResult<&[TriangleOfFace]> {
        py.detach(|| in_pool(0, || self.inner.triangles())).map_err(PyRuntimeError::new_err)
    }

    /// Reason why the layout is not what was asked for.
    pub(crate) fn shortfall(&self) -> String {
        if !self.inner.is_planar() {
            return format!("the layout is not proved planar: {}", self.inner.summary());
        }
        match &self.inner.report.unmet_pins()[..] {
            [] => "the charts do not have the density that was asked for".to_owned(),
            pins => {
                let vertices: Vec<String> = pins.iter().map(ToString::to_string).collect();
                format!("the layout is planar, but pins are not met: {}", vertices.join(", "))
            }
        }
    }
}

#[pymethods]
impl Layout {
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::positions(py, &self.inner.mesh.polygons.positions)
    }

    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::points(py, &self.inner.texture.coordinates)
    }

    /// Index of the coordinate of each corner, −1 at corners without.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        arrays::list(py, self.inner.texture.corners.iter().copied().map(arrays::number).collect())
    }

    /// Vertex of each corner.
    #[getter]
    fn vertex_corners<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        arrays::list(py, self.inner.mesh.polygons.corners.iter().map(|vertex| vertex.number().into()).collect())
    }

    /// Start of each face in the list of corners, and the end of the last; None for triangles.
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<i64>>> {
        mesh::starts(py, &self.inner.mesh.polygons)
    }

    #[getter]
    fn corner_uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        mesh::corner_uv(py, &self.inner.texture.coordinates, &self.inner.texture.corners)
    }

    #[getter]
    fn source<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let mut source = vec![-1; self.inner.texture.coordinates.len()];
        let corners = self.inner.texture.corners.iter().zip(&self.inner.mesh.polygons.corners);
        for (&number, vertex) in corners {
            if let Some(source) = source.get_mut(number as usize) {
                *source = vertex.number().into();
            }
        }
        arrays::list(py, source)
    }

    #[getter]
    fn new_vertex_edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        arrays::table(py, self.inner.new_vertices.iter().map(|new| new.edge.map(|vertex| vertex.number().into())))
    }

    #[getter]
    fn new_vertex_at<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        arrays::list(py, self.inner.new_vertices.iter().map(|new| new.at).collect())
    }

    #[getter]
    fn face_of<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let faces = match &self.inner.face_of {
            Some(faces) => faces.iter().map(|&face| face.into()).collect(),
            None => (0..).take(self.inner.mesh.polygons.face_count()).collect(),
        };
        arrays::list(py, faces)
    }

    #[getter]
    fn chart<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        arrays::list(py, self.inner.chart_of_face.iter().copied().map(arrays::number).collect())
    }

    #[getter]
    fn cut_edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let edges = py.detach(|| self.inner.cut_edges());
        arrays::table(py, edges.into_iter().map(|edge| edge.map(|vertex| vertex.number().into())))
    }

    #[getter]
    fn triangle_face<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        Ok(arrays::list(py, self.triangles(py)?.iter().map(|triangle| triangle.face.into()).collect()))
    }

    #[getter]
    fn singular_values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let values = self.triangles(py)?.iter().map(|triangle| triangle.singular_values().unwrap_or([f64::NAN; 2]));
        arrays::table(py, values)
    }

    /// Area of each triangle on the surface; 0 if its face is not flattened.
    #[getter]
    fn triangle_area<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(arrays::list(py, self.triangles(py)?.iter().map(|triangle| triangle.area).collect()))
    }

    /// Symmetric Dirichlet energy of each triangle; NaN if its face is not flattened.
    #[getter]
    fn triangle_energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let energy = |triangle: &TriangleOfFace| {
            triangle.distortion.map_or(f64::NAN, |distortion| distortion.symmetric_dirichlet())
        };
        Ok(arrays::list(py, self.triangles(py)?.iter().map(energy).collect()))
    }

    #[getter]
    fn planar(&self) -> bool {
        self.inner.is_planar()
    }

    #[getter]
    fn unmet_pins(&self) -> Vec<u32> {
        self.inner.report.unmet_pins().iter().map(|vertex| vertex.number()).collect()
    }

    #[getter]
    fn summary(&self) -> &str {
        self.inner.summary()
    }

    /// Report of the run, as the program writes it.
    #[getter]
    fn report(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = self.report.get_or_try_init(py, || errors::to_python(py, &self.inner.report).map(Bound::unbind))?;
        Ok(made.clone_ref(py))
    }

    /// Writes a file of the kind that its extension names. Returns the files written, if the written numbers are planar,
    /// and the verdict on them.
    #[pyo3(signature = (path, precision=None))]
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        precision: Option<String>,
    ) -> PyResult<(Vec<PathBuf>, bool, String)> {
        let precision = precision.map(|name| precision_of(py, &name)).transpose()?;
        let kind = kind_of(py, &path, &KINDS)?;
        let write = || self.inner.write(&path, kind, precision);
        let written = py.detach(|| in_pool(0, write)).map_err(PyRuntimeError::new_err)?;
        let written = written.map_err(|error| PyOSError::new_err(error.to_string()))?;
        Ok((written.files, written.planar, written.summary))
    }
}

/// Kinds of files that a layout can be written to.
const KINDS: [OutputKind; 6] =
    [OutputKind::Obj, OutputKind::Ply, OutputKind::Glb, OutputKind::Svg, OutputKind::Png, OutputKind::Json];

/// Kind of file that an extension names, one of `kinds`.
pub(crate) fn kind_of(py: Python<'_>, path: &Path, kinds: &[OutputKind]) -> PyResult<OutputKind> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let is_named = |kind: &&OutputKind| extension_of(**kind) == extension;
    kinds.iter().find(is_named).copied().ok_or_else(|| {
        let names: Vec<String> = kinds.iter().map(|&kind| format!(".{}", extension_of(kind))).collect();
        let (last, others) = names.split_last().expect("there are kinds");
        errors::option_error(py, format!("{}: end the name in {} or {last}", path.display(), others.join(", ")))
    })
}

fn extension_of(kind: OutputKind) -> &'static str {
    match kind {
        OutputKind::Obj => "obj",
        OutputKind::Ply => "ply",
        OutputKind::Glb => "glb",
        OutputKind::Svg => "svg",
        OutputKind::Png => "png",
        OutputKind::Json => "json",
    }
}

/// Precision of this name.
pub(crate) fn precision_of(py: Python<'_>, name: &str) -> PyResult<Precision> {
    let wrong = || errors::option_error(py, format!("precision: choose one of {}", Precision::names()));
    Precision::named(name).ok_or_else(wrong)
}
