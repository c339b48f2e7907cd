//! Layouts and pictures of one mesh on another mesh of the surface.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use freebound_core::geom::Picture;
use freebound_core::problem::Control;
use freebound_io::raster::write_png;
use freebound_io::{
    BakeOptions, BakedPicture, FaultReport, FileForm, Materials, MeshFile, OutputKind, PaintedSurface, PictureFile,
    Precision, Registration, Report, TextureError, TextureMesh, TransferError, TransferReport, TransferredFile,
    WriteError, copied_texture, material_picture, write_atomically,
};
use numpy::{PyArray2, PyArray3, PyArrayMethods as _, PyReadonlyArray3};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use serde::Deserialize;

use super::job::{in_pool, interruptible};
use super::layout::{kind_of, precision_of};
use super::mesh::{self, Mesh};
use super::options::of_json;
use super::{arrays, errors};

/// Layout of one mesh on another.
#[pyclass(frozen, module = "freebound", name = "_Transferred")]
pub(crate) struct Transferred {
    /// Mesh with its new texture coordinates.
    copy: MeshFile,
    path: Option<PathBuf>,
    transfer: TransferReport,
    report: Report,
    planar: bool,
}

impl Transferred {
    /// The layout as a file of a kind holds it.
    fn file(&self, kind: OutputKind, precision: Option<Precision>) -> Result<TransferredFile<'_>, TransferError> {
        let control = Control::unattended();
        let mut file =
            TransferredFile::of_copy(self.copy.clone(), self.transfer, FileForm { kind, precision }, control)?;
        (file.source_path, file.materials) = (self.path.as_deref(), Materials::Stay);
        Ok(file)
    }
}

#[pymethods]
impl Transferred {
    #[getter]
    fn corner_uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let texture = self.copy.texture.as_ref().ok_or_else(|| PyRuntimeError::new_err("there is no layout"))?;
        mesh::corner_uv(py, &texture.coordinates, &texture.corners)
    }

    #[getter]
    fn planar(&self) -> bool {
        self.planar
    }

    /// True if the two surfaces lie apart.
    #[getter]
    fn apart(&self) -> bool {
        self.transfer.is_apart()
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
        let kind = kind_of(py, &path, &[OutputKind::Obj, OutputKind::Ply, OutputKind::Glb])?;
        let write = || -> Result<_, Failure> {
            let file = self.file(kind, precision)?;
            Ok((file.write(kind, &path)?, file.is_planar()))
        };
        let written = py.detach(|| in_pool(0, write)).map_err(PyRuntimeError::new_err)?;
        written.map_err(|failure| match failure {
            Failure::Copy(error) => of_transfer(py, &error),
            Failure::Write(error) => PyOSError::new_err(error.to_string()),
        })
    }
}

/// Reason why a copied layout is not written.
enum Failure {
    Copy(TransferError),
    Write(WriteError),
}

impl From<TransferError> for Failure {
    fn from(error: TransferError) -> Self {
        Self::Copy(error)
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Write(error)
    }
}

/// Options of a copied layout.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TransferChoice {
    fit: bool,
    threads: Option<u16>,
}

/// Copies the layout of a mesh to another mesh. `options` is a JSON object; the copy ends if `stop` returns true.
#[pyfunction]
#[pyo3(signature = (layout, mesh, options, stop=None))]
pub(crate) fn transfer(
    py: Python<'_>,
    layout: &Mesh,
    mesh: &Mesh,
    options: &str,
    stop: Option<&Bound<'_, PyAny>>,
) -> PyResult<Transferred> {
    let options: TransferChoice = of_json(py, options)?;
    let model = mesh.model();
    let work = |control: Control<'_>| {
        let (texture, transfer) = copied_texture(&layout.file, &mesh.file, Registration::of(options.fit), control)?;
        let copy = MeshFile { texture: Some(texture), ..mesh.file.as_ref().clone() };
        let form = FileForm { kind: OutputKind::Obj, precision: Some(Precision::F64) };
        let file = TransferredFile::of_copy(copy.clone(), transfer, form, control)?;
        let (mut report, planar) = (file.report.clone(), file.is_planar());
        report.mesh.path = model.path_words();
        Ok(Transferred { copy, path: model.path.clone(), transfer, report, planar })
    };
    let copied = interruptible(py, options.threads.map_or(0, usize::from), stop, work)?;
    copied.map_err(|error: TransferError| of_transfer(py, &error))
}

fn of_transfer(py: Python<'_>, error: &TransferError) -> PyErr {
    match error {
        TransferError::Cancelled => errors::cancelled(py),
        TransferError::Texture(error) => errors::input_error(py, error, &FaultReport::of_texture(error)),
        _ => errors::input_error(py, error, &[]),
    }
}

/// Picture that was drawn for another layout.
#[pyclass(frozen, module = "freebound", name = "_Baked")]
pub(crate) struct Baked {
    baked: BakedPicture,
}

#[pymethods]
impl Baked {
    /// Colours, row by row from the top, shape (height, width, 4).
    #[getter]
    fn pixels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        pixels(py, &self.baked.picture)
    }

    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        errors::to_python(py, &self.baked.report)
    }

    /// Writes the picture as PNG.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let written = py.detach(|| write_atomically(&path, |out| write_png(&self.baked.picture, out)));
        written.map_err(|error| PyOSError::new_err(error.to_string()))
    }
}

fn pixels<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let shape = [picture.height as usize, picture.width as usize, 4];
    arrays::list(py, picture.pixels.clone()).reshape(shape)
}

/// Colours of a PNG or JPEG file, or of the picture within a glTF file, shape (height, width, 4).
#[pyfunction]
pub(crate) fn read_picture(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray3<u8>>> {
    let read = py.detach(|| PictureFile::read(&path));
    let picture = read.map_err(|error| errors::input_error(py, error, &[]))?;
    pixels(py, &picture.pixels)
}

/// Colours of the picture that the materials of a mesh show on most faces, shape (height, width, 4), or None.
#[pyfunction]
pub(crate) fn picture_of<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Option<Bound<'py, PyArray3<u8>>>> {
    let path: Option<&Path> = mesh.path();
    let Some(path) = path else { return Ok(None) };
    let Some(picture) = material_picture(&mesh.file, path) else { return Ok(None) };
    let read = py.detach(|| PictureFile::read_for(&mesh.file, path, &picture));
    let picture = read.map_err(|error| errors::input_error(py, error, &[]))?;
    pixels(py, &picture.pixels).map(Some)
}

/// Largest margin, pixels.
const MOST_MARGIN: u32 = 1024;

/// Options of a baked picture.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BakeChoice {
    size: Option<[u32; 2]>,
    margin: u32,
    fit: bool,
    threads: Option<u16>,
}

/// Draws the picture of an old layout for a new layout. `picture` has the shape (height, width, 4); `options` is a JSON
/// object; the drawing ends if `stop` returns true.
#[pyfunction]
#[pyo3(signature = (old, new, picture, options, stop=None))]
pub(crate) fn bake(
    py: Python<'_>,
    old: &Mesh,
    new: &Mesh,
    picture: PyReadonlyArray3<'_, u8>,
    options: &str,
    stop: Option<&Bound<'_, PyAny>>,
) -> PyResult<Baked> {
    let options: BakeChoice = of_json(py, options)?;
    if options.margin > MOST_MARGIN {
        return Err(errors::option_error(py, format!("margin: pass 0 to {MOST_MARGIN} pixels")));
    }
    let picture = picture_from(py, &picture)?;
    let size = options.size.unwrap_or_else(|| BakeOptions::size_for(&picture));
    if !size.iter().all(|side| (1..=BakeOptions::LONGEST_SIDE).contains(side)) {
        let longest = BakeOptions::LONGEST_SIDE;
        return Err(errors::option_error(py, format!("size: pass width and height from 1 to {longest} pixels")));
    }
    let rules = BakeOptions { pixels: size, margin: options.margin, registration: Registration::of(options.fit) };
    let [old, new] = [layout_of(py, &old.file)?, layout_of(py, &new.file)?];
    let work = |control: Control<'_>| {
        let painted = PaintedSurface { layout: old.surface(), picture: &picture };
        freebound_io::bake(painted, new.surface(), rules, control)
    };
    match interruptible(py, options.threads.map_or(0, usize::from), stop, work)? {
        Ok(baked) => Ok(Baked { baked }),
        Err(error) => Err(errors::of_solve(py, &error)),
    }
}

fn layout_of(py: Python<'_>, file: &Arc<MeshFile>) -> PyResult<TextureMesh> {
    let layout = py.detach(|| file.partial_texture_mesh());
    let of_texture = |error: &TextureError| errors::input_error(py, error, &FaultReport::of_texture(error));
    layout.map(|(layout, _)| layout).map_err(|error| of_texture(&error))
}

fn picture_from(py: Python<'_>, pixels: &PyReadonlyArray3<'_, u8>) -> PyResult<Picture> {
    let rows = pixels.as_array();
    let &[height, width, 4] = rows.shape() else {
        return Err(errors::option_error(py, "picture: pass an array of shape (height, width, 4)"));
    };
    let side = |count: usize| u32::try_from(count).ok().filter(|&side| side > 0);
    match (side(width), side(height)) {
        (Some(width), Some(height)) => Ok(Picture { width, height, pixels: rows.iter().copied().collect() }),
        _ => Err(errors::option_error(py, "picture: it has no pixels")),
    }
}
