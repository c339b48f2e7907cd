//! Layout of one file on the mesh of another file, judged and ready to be written.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::obj::Materials;
use super::textured_file::TexturedFile;
use super::{
    FileData, JudgeError, LayoutError, MeshFile, MeshReport, OutputKind, Precision, Registration, Report, Seconds,
    Texture, TextureError, TransferReport, WriteError,
};
use freebound_core::geom::SpaceBounds;
use freebound_core::pipeline::{CopyLayoutError, LayoutSurface, copy_layout};
use freebound_core::problem::Control;
use freebound_core::verify::{LayoutOptions, LayoutVerdict, RoundingGrid};

/// Layout of one file on the mesh of another.
#[derive(Debug)]
pub struct TransferredFile<'a> {
    /// Mesh with its new texture coordinates.
    mesh: MeshFile,
    /// File of the mesh; `None` for a stream.
    pub source_path: Option<&'a Path>,
    /// Treatment of its material libraries.
    pub materials: Materials,
    /// Report of the run, with the verdict on the layout.
    pub report: Report,
}

/// Choices of a copied layout.
#[derive(Clone, Copy, Debug)]
pub struct TransferOptions {
    /// Place of the surface with the layout beside the other mesh.
    pub registration: Registration,
    /// File that will be written.
    pub form: FileForm,
}

/// Kind of a file and the precision of its coordinates.
#[derive(Clone, Copy, Debug)]
pub struct FileForm {
    /// Kind of the file.
    pub kind: OutputKind,
    /// Precision of the coordinates. Default: the usual precision of the kind, or 64 bits if 32 bits fold the layout and
    /// the kind has 64.
    pub precision: Option<Precision>,
}

/// Reason why a layout cannot be copied from a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// The file of the layout has no usable texture coordinates.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The mesh has no faces.
    #[error("the mesh has no faces")]
    NoFaces,
    /// The layout has no triangles.
    #[error(transparent)]
    Copy(CopyLayoutError),
    /// The caller cancelled.
    #[error("the copy was cancelled")]
    Cancelled,
}

impl TransferredFile<'_> {
    /// Copies the layout of a file onto a mesh. The report has no name of the mesh.
    ///
    /// If both files have equal faces, coordinates are copied corner by corner. Otherwise nearest points are used.
    /// Coordinates are rounded to the numbers that a file of the kind holds.
    ///
    /// # Errors
    ///
    /// [`TransferError`] if the layout or the mesh is unusable, or if the caller cancels.
    pub fn new(
        layout: &MeshFile,
        mesh: &MeshFile,
        TransferOptions { registration, form }: TransferOptions,
        control: Control<'_>,
    ) -> Result<Self, TransferError> {
        let start = Instant::now();
        let (texture, transfer) = copied_texture(layout, mesh, registration, control)?;
        let copy = MeshFile { texture: Some(texture), ..mesh.clone() };
        let mut file = Self::of_copy(copy, transfer, form, control)?;
        file.report.seconds.verify = start.elapsed().as_secs_f64();
        Ok(file)
    }

    /// Judges a mesh that a layout was copied to, and rounds its coordinates to the numbers that a file of the kind
    /// holds. The report has no name of the mesh.
    ///
    /// # Errors
    ///
    /// [`TransferError`] if the mesh has no layout, or if the caller cancels.
    pub fn of_copy(
        copy: MeshFile,
        transfer: TransferReport,
        FileForm { kind, precision }: FileForm,
        control: Control<'_>,
    ) -> Result<Self, TransferError> {
        let start = Instant::now();
        let (mesh, verdict, precision) = rounded(copy, kind, precision, control)?;
        let (vertices, faces) = (mesh.polygons.positions.len(), verdict.triangles);
        let described = MeshReport { vertices, faces, warnings: mesh.warnings.clone(), ..MeshReport::default() };
        let verify = start.elapsed().as_secs_f64();
        let seconds = Seconds { verify, ..Seconds::default() };
        let (layout, transfer, precision) = (Some(verdict), Some(transfer), Some(precision));
        let report = Report { precision, layout, transfer, seconds, ..Report::of_mesh(described) };
        Ok(Self { mesh, source_path: None, materials: Materials::default(), report })
    }

    /// True if the layout is proved planar.
    pub fn is_planar(&self) -> bool {
        self.report.layout.as_ref().is_some_and(|verdict| verdict.planar)
    }

    /// Data of the source that a mesh file of this kind does not hold.
    pub fn not_kept_in(&self, kind: OutputKind) -> Vec<FileData> {
        self.mesh.not_kept_in(kind, || self.texture().clone())
    }

    /// Writes the mesh atomically. Copied material libraries are written first. Returns the files written, `path` first.
    ///
    /// # Errors
    ///
    /// If the file cannot be written; the error names the file.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        self.file().write(kind, path)
    }

    /// Writes the mesh to standard output.
    ///
    /// # Errors
    ///
    /// If standard output cannot be written.
    pub fn write_to_standard_output(&self, kind: OutputKind) -> Result<(), WriteError> {
        self.file().write_to_standard_output(kind)
    }

    fn texture(&self) -> &Texture {
        self.mesh.texture.as_ref().expect("the layout was copied")
    }

    fn file(&self) -> TexturedFile<'_> {
        TexturedFile {
            source: &self.mesh,
            source_path: self.source_path,
            materials: self.materials,
            texture: self.texture(),
            precision: self.report.precision.unwrap_or_default(),
        }
    }
}

/// Texture coordinates of one file for the corners of another. If both files have equal faces, they are copied corner
/// by corner. Otherwise nearest points are used.
///
/// # Errors
///
/// [`TransferError`] if the layout or the mesh is unusable, or if the caller cancels.
pub fn copied_texture(
    layout: &MeshFile,
    mesh: &MeshFile,
    registration: Registration,
    control: Control<'_>,
) -> Result<(Texture, TransferReport), TransferError> {
    if mesh.polygons.face_count() == 0 {
        return Err(TransferError::NoFaces);
    }
    let are_equal = layout.polygons.corners == mesh.polygons.corners && layout.polygons.starts == mesh.polygons.starts;
    if are_equal {
        return match mesh.texture_of(layout) {
            Ok(texture) => Ok((texture, TransferReport::Corners)),
            Err(LayoutError::Texture(error)) => Err(error.into()),
            Err(_) => unreachable!("files with equal faces have equal corners"),
        };
    }
    // Faces without coordinates are left out: other faces may lie near enough.
    let (surface, _) = layout.partial_texture_mesh()?;
    let used = || mesh.polygons.corners.iter().map(|vertex| mesh.polygons.positions[vertex.index()]);
    let fitted = registration.applied(&surface.mesh, used());
    let surface = LayoutSurface { mesh: &fitted, coordinates: &surface.embedding };
    let copied = copy_layout(surface, &mesh.polygons, control).map_err(|error| match error {
        CopyLayoutError::Cancelled => TransferError::Cancelled,
        error => TransferError::Copy(error),
    })?;
    let report = TransferReport::NearestPoints {
        largest_distance: copied.largest_distance,
        mean_distance: copied.mean_distance,
        diagonal: copied.diagonal,
        mesh_diagonal: SpaceBounds::of(used()).diagonal(),
    };
    Ok((Texture { coordinates: copied.coordinates, corners: copied.corners }, report))
}

/// Mesh with its coordinates in the precision of a file, with the verdict on them.
fn rounded(
    exact: MeshFile,
    kind: OutputKind,
    precision: Option<Precision>,
    control: Control<'_>,
) -> Result<(MeshFile, LayoutVerdict, Precision), TransferError> {
    let Some(grid) = kind.grid(precision) else {
        let verdict = verdict_on(&exact, control)?;
        return Ok((exact, verdict, Precision::F64));
    };
    let rounded = on_grid(&exact, grid);
    let verdict = judged(&rounded, control)?;
    if !verdict.planar && kind.has_choice(precision) {
        let of_exact = verdict_on(&exact, control)?;
        if of_exact.planar {
            return Ok((exact, LayoutVerdict { planar_in_f32: false, ..of_exact }, Precision::F64));
        }
    }
    let verdict = LayoutVerdict { planar_in_f32: verdict.planar, ..verdict };
    Ok((rounded, verdict, Precision::F32))
}

/// Mesh with its coordinates rounded to a grid.
fn on_grid(exact: &MeshFile, grid: RoundingGrid) -> MeshFile {
    let mut rounded = exact.clone();
    for coordinate in rounded.texture.iter_mut().flat_map(|texture| &mut texture.coordinates) {
        *coordinate = grid.nearest(*coordinate);
    }
    rounded
}

/// Verdict on coordinates in 64 bits. Those on a mesh that was read from glTF come from another file: they are not yet
/// rounded, as those of glTF are.
fn verdict_on(exact: &MeshFile, control: Control<'_>) -> Result<LayoutVerdict, TransferError> {
    let verdict = judged(exact, control)?;
    if !(exact.is_turned_over() && verdict.planar) {
        return Ok(verdict);
    }
    let rounded = judged(&on_grid(exact, RoundingGrid::Upright), control)?;
    Ok(LayoutVerdict { planar_in_f32: rounded.planar, ..verdict })
}

fn judged(mesh: &MeshFile, control: Control<'_>) -> Result<LayoutVerdict, TransferError> {
    match mesh.judged_layout(LayoutOptions::default(), false, control) {
        Ok(judged) => Ok(judged.verdict),
        Err(JudgeError::Texture(error)) => Err(error.into()),
        Err(JudgeError::Cancelled) => Err(TransferError::Cancelled),
    }
}
