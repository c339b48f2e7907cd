//! Meshes from arrays and from files, and the check of their texture coordinates.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::problem::Control;
use freebound_core::verify::{LayoutOptions, PixelGap};
use freebound_io::{
    FaultElements, FaultReport, JudgeError, MeshFile, NO_TEXTURE, ReadOptions, Texture, read_mesh_with,
};
use freebound_run::Model;
use glam::{DVec2, DVec3};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use serde::Deserialize;

use super::job::{in_pool, interruptible};
use super::options::of_json;
use super::{arrays, errors};

/// Mesh with the other contents of its file, if it came from one.
#[pyclass(frozen, module = "freebound")]
pub(crate) struct Mesh {
    pub(crate) file: Arc<MeshFile>,
    path: Option<PathBuf>,
}

impl Mesh {
    /// Mesh for a run, not prepared yet.
    pub(crate) fn model(&self) -> Model {
        match &self.path {
            Some(path) => Model::of_file(path, Arc::clone(&self.file)),
            None => Model::in_memory("mesh in memory", Arc::clone(&self.file)),
        }
    }
}

#[pymethods]
impl Mesh {
    /// Mesh from arrays: positions (n, 3); the vertex of each corner; the starts of the faces, or None for triangles;
    /// texture coordinates of the corners, or None.
    #[new]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        corners: PyReadonlyArray1<'_, i64>,
        starts: Option<PyReadonlyArray1<'_, i64>>,
        corner_uv: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Self> {
        let rows = vertices.as_array();
        if rows.shape()[1] != 3 {
            return Err(errors::option_error(py, "vertices: pass an array of shape (n, 3)"));
        }
        let positions: Vec<DVec3> = rows.rows().into_iter().map(|row| DVec3::new(row[0], row[1], row[2])).collect();
        let starts = starts.map(|starts| starts_of(py, starts.as_slice()?, corners.len()?)).transpose()?;
        let corners = vertices_of(py, corners.as_slice()?, positions.len(), starts.as_deref())?;
        let infinite = (0..).zip(&positions).filter(|(_, position)| !position.is_finite());
        let infinite: Vec<VertexId> = infinite.map(|(vertex, _)| VertexId::new(vertex)).collect();
        if !infinite.is_empty() {
            let message = format!("{} vertices have positions that are not finite", infinite.len());
            return Err(refused(py, "not-finite", message, FaultElements::Vertices(infinite)));
        }
        let texture = corner_uv.map(|uv| texture_of(py, &uv, corners.len())).transpose()?;
        let polygons = PolygonMesh { positions, corners, starts };
        Ok(Self { file: Arc::new(MeshFile { texture, ..MeshFile::from(polygons) }), path: None })
    }

    /// Reads a mesh file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = || read_mesh_with(&path, ReadOptions::default(), &mut |_| ControlFlow::Continue(()));
        let file = py.detach(|| in_pool(0, read)).map_err(PyRuntimeError::new_err)?;
        let file = file.map_err(|error| errors::of_read(py, &path.display().to_string(), &error))?;
        Ok(Self { file: Arc::new(file), path: Some(path) })
    }

    /// The mesh with other texture coordinates of its corners.
    fn with_uv(&self, py: Python<'_>, corner_uv: PyReadonlyArray2<'_, f64>) -> PyResult<Self> {
        let texture = Some(texture_of(py, &corner_uv, self.file.polygons.corners.len())?);
        let file = Arc::new(MeshFile { texture, ..self.file.as_ref().clone() });
        Ok(Self { file, path: self.path.clone() })
    }

    /// Path of the file, or None.
    #[getter]
    pub(crate) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Positions, shape (n, 3).
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::positions(py, &self.file.polygons.positions)
    }

    /// Vertex of each corner of each face.
    #[getter]
    fn corners<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        arrays::list(py, self.file.polygons.corners.iter().map(|vertex| vertex.number().into()).collect())
    }

    /// Start of each face in the list of corners, and the end of the last; None for triangles.
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<i64>>> {
        starts(py, &self.file.polygons)
    }

    /// Texture coordinates of the corners, shape (c, 2), NaN at corners without; None if the mesh has none.
    #[getter]
    fn corner_uv<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.file.texture.as_ref().map(|texture| corner_uv(py, &texture.coordinates, &texture.corners)).transpose()
    }

    /// True if the mesh has texture coordinates.
    #[getter]
    fn has_uv(&self) -> bool {
        self.file.texture.is_some()
    }

    /// Number of faces.
    #[getter]
    fn face_count(&self) -> usize {
        self.file.polygons.face_count()
    }

    /// Remarks of the reader.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.file.warnings.iter().map(ToString::to_string).collect()
    }
}

/// Starts of polygons; None for triangles.
pub(crate) fn starts<'py>(py: Python<'py>, polygons: &PolygonMesh) -> Option<Bound<'py, PyArray1<i64>>> {
    let starts = polygons.starts.as_ref()?;
    Some(arrays::list(py, starts.iter().map(|&start| start.into()).collect()))
}

/// Texture coordinates of corners, by their numbers in a list. NaN at corners with a number beyond it.
pub(crate) fn corner_uv<'py>(
    py: Python<'py>,
    coordinates: &[DVec2],
    corners: &[u32],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let at = |&number: &u32| coordinates.get(number as usize).map_or([f64::NAN; 2], DVec2::to_array);
    arrays::table(py, corners.iter().map(at))
}

fn refused(py: Python<'_>, kind: &'static str, message: String, elements: FaultElements) -> PyErr {
    let fault = FaultReport { kind, message: message.clone(), remedy: None, elements: Some(elements) };
    errors::input_error(py, message, &[fault])
}

/// Starts of faces, checked.
fn starts_of(py: Python<'_>, starts: &[i64], corner_count: usize) -> PyResult<Vec<u32>> {
    let end = i64::try_from(corner_count).unwrap_or(i64::MAX);
    let is_closed = starts.first() == Some(&0) && starts.last() == Some(&end);
    if !is_closed || end > i64::from(u32::MAX) {
        let message = "faces: offsets begin with 0 and end with the number of corners, below 2^32";
        return Err(errors::option_error(py, message));
    }
    let short = (0..).zip(starts.windows(2)).filter(|(_, pair)| pair[1].saturating_sub(pair[0]) < 3);
    let short: Vec<u32> = short.map(|(face, _)| face).collect();
    if !short.is_empty() {
        let message = format!("{} faces have fewer than 3 corners", short.len());
        return Err(refused(py, "too-few-corners", message, FaultElements::Faces(short)));
    }
    Ok(starts.iter().map(|&start| u32::try_from(start).unwrap_or(u32::MAX)).collect())
}

/// Vertices of corners, checked.
fn vertices_of(py: Python<'_>, corners: &[i64], count: usize, starts: Option<&[u32]>) -> PyResult<Vec<VertexId>> {
    let number = |&corner: &i64| u32::try_from(corner).ok().filter(|&vertex| (vertex as usize) < count);
    let vertices: Option<Vec<VertexId>> = corners.iter().map(|corner| number(corner).map(VertexId::new)).collect();
    if let Some(vertices) = vertices {
        return Ok(vertices);
    }
    let face_of = |at: usize| match starts {
        Some(starts) => starts.partition_point(|&start| start as usize <= at) - 1,
        None => at / 3,
    };
    let wrong = corners.iter().enumerate().filter(|(_, corner)| number(corner).is_none());
    let mut faces: Vec<u32> = wrong.map(|(at, _)| u32::try_from(face_of(at)).unwrap_or(u32::MAX)).collect();
    faces.dedup();
    let message = format!("{} faces name vertices that are not there: there are {count}, from 0", faces.len());
    Err(refused(py, "no-such-vertex", message, FaultElements::Faces(faces)))
}

/// Texture with a coordinate for each corner. Corners at which a number is NaN have none.
fn texture_of(py: Python<'_>, uv: &PyReadonlyArray2<'_, f64>, corner_count: usize) -> PyResult<Texture> {
    let rows = uv.as_array();
    if rows.shape() != [corner_count, 2] {
        let message = format!("corner_uv: pass an array of shape ({corner_count}, 2), a row for each corner");
        return Err(errors::option_error(py, message));
    }
    let mut texture = Texture::default();
    for row in rows.rows() {
        let at = DVec2::new(row[0], row[1]);
        let number = u32::try_from(texture.coordinates.len()).unwrap_or(NO_TEXTURE);
        texture.corners.push(if at.is_nan() { NO_TEXTURE } else { number });
        if !at.is_nan() {
            texture.coordinates.push(at);
        }
    }
    Ok(texture)
}

/// Options of a check.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckOptions {
    stacked: bool,
    gap: Option<f64>,
    size: Option<[u32; 2]>,
    scale_ratio: Option<f64>,
    listed: Option<usize>,
}

impl CheckOptions {
    fn of_layout(&self) -> LayoutOptions {
        let usual = LayoutOptions::default();
        let [width, height] = self.size.unwrap_or(PackingOptions::default().picture).map(f64::from);
        LayoutOptions {
            accepts_stacks: self.stacked,
            gap: self.gap.map(|least| PixelGap { least, picture: DVec2::new(width, height) }),
            scale_ratio: self.scale_ratio.unwrap_or(usual.scale_ratio),
            listed: self.listed.unwrap_or(usual.listed),
        }
    }
}

/// Judges the texture coordinates of a mesh, and returns the verdict as a dictionary. `options` is a JSON object; the
/// check ends if `stop` returns true.
#[pyfunction]
#[pyo3(signature = (mesh, options, stop=None))]
pub(crate) fn check<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    options: &str,
    stop: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: CheckOptions = of_json(py, options)?;
    let judge = |control: Control<'_>| mesh.file.judged_layout(options.of_layout(), false, control);
    match interruptible(py, 0, stop, judge)? {
        Ok(judged) => errors::to_python(py, &judged.verdict),
        Err(JudgeError::Texture(error)) => Err(errors::input_error(py, &error, &FaultReport::of_texture(&error))),
        Err(JudgeError::Cancelled) => Err(errors::cancelled(py)),
    }
}
