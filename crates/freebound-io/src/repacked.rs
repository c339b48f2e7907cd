//! Layouts with new places for their charts, ready to be written.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::file_data::FileData;
use super::finite::check_finite;
use super::obj::Materials;
use super::svg::{LayoutDrawing, write_layout_svg};
use super::textured_file::TexturedFile;
use super::{
    MeshFile, MeshReport, NO_TEXTURE, OutputKind, Precision, Report, RoundingReport, Seconds, Texture, TextureError,
    WriteError, write_atomically, write_to_standard_output,
};
use freebound_core::geom::{Orientation, orientation};
use freebound_core::mesh::{EdgeTable, FaceId};
use freebound_core::pipeline::{
    GivenLayout, NO_COORDINATE, RepackError, RepackOptions, Repacked, charts_of_layout, repack_with,
};
use freebound_core::problem::Control;

/// Layout of a file with new places for its charts.
#[derive(Debug)]
pub struct RepackedFile<'a> {
    /// Contents of the file as read.
    pub source: &'a MeshFile,
    /// File of the mesh; `None` for a stream.
    pub source_path: Option<&'a Path>,
    /// Treatment of its material libraries.
    pub materials: Materials,
    /// The layout.
    pub repacked: Repacked,
    /// Report of the run.
    pub report: Report,
}

/// Reason why the layout of a file cannot be packed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LayoutToPackError {
    /// The texture coordinates are incomplete.
    #[error("{0}")]
    Texture(#[from] TextureError),
    /// The layout cannot be packed.
    #[error("{0}")]
    Repack(#[from] RepackError),
}

/// Rules for packing the layout of a file.
#[derive(Clone, Debug)]
pub struct LayoutPacking {
    /// Picture, sizes and locked charts.
    pub options: RepackOptions,
    /// Width over height of the picture of the given layout.
    pub aspect: f64,
}

impl MeshFile {
    /// Chart of each face in the layout of the file, in the order of their first faces. `None` for faces without a
    /// triangle.
    ///
    /// # Errors
    ///
    /// [`LayoutToPackError`] if faces have no usable texture coordinates.
    pub fn layout_charts(&self) -> Result<Vec<Option<usize>>, LayoutToPackError> {
        Ok(charts_of_layout(self.given_layout(1.0)?)?)
    }

    /// Layout of the file for a picture of this aspect.
    fn given_layout(&self, aspect: f64) -> Result<GivenLayout<'_>, TextureError> {
        let texture = self.complete_texture()?;
        Ok(GivenLayout { mesh: &self.polygons, coordinates: &texture.coordinates, corners: &texture.corners, aspect })
    }
}

impl<'a> RepackedFile<'a> {
    /// Packs the charts of a file. `name` is the name of the mesh in the report.
    ///
    /// # Errors
    ///
    /// [`LayoutToPackError`] if faces have no usable texture coordinates, a locked chart does not exist, or the caller
    /// cancels.
    pub fn new(
        source: &'a MeshFile,
        name: String,
        packing: &LayoutPacking,
        control: Control<'_>,
    ) -> Result<Self, LayoutToPackError> {
        let start = Instant::now();
        let repacked = repack_with(source.given_layout(packing.aspect)?, &packing.options, control)?;
        let edges = EdgeTable::new(repacked.mesh.vertex_count(), &repacked.mesh.triangles);
        let boundary_vertices = edges.edges().filter(|sides| sides.len() == 1).count();
        let (vertices, faces) = (source.polygons.positions.len(), repacked.mesh.face_count());
        let warnings = source.warnings.clone();
        let mesh = MeshReport { path: name, vertices, faces, boundary_vertices, warnings, ..MeshReport::default() };
        let verify = start.elapsed().as_secs_f64();
        let seconds = Seconds { verify, ..Seconds::default() };
        let report = Report { packing: Some(repacked.packing), seconds, ..Report::of_mesh(mesh) };
        let mut file = Self { source, source_path: None, materials: Materials::default(), repacked, report };
        file.report_layout();
        Ok(file)
    }

    /// Copies charts and verdict to the report.
    fn report_layout(&mut self) {
        self.report.packed_charts = self.repacked.charts.clone();
        self.report.atlas = self.repacked.verdict.as_ref().ok().cloned();
    }

    /// Rounds the coordinates to the numbers that a file of this kind holds, and proves them again. Default: the usual
    /// precision of the kind, or 64 bits if these fold the map and the kind has them.
    pub fn round_to(&mut self, precision: Option<Precision>, kind: OutputKind) {
        let Some(grid) = kind.grid(precision) else {
            self.report.precision = Some(Precision::F64);
            return;
        };
        let was_planar = self.repacked.is_planar();
        let exact = (was_planar && kind.has_choice(precision)).then(|| self.repacked.clone());
        self.repacked.round_to(grid);
        if let Some(exact) = exact.filter(|_| !self.repacked.is_planar()) {
            self.repacked = exact;
            self.report.precision = Some(Precision::F64);
            return;
        }
        self.report_layout();
        self.report.precision = Some(Precision::F32);
        self.report.rounding = Some(RoundingReport { moved: 0, folded: was_planar && !self.repacked.is_planar() });
    }

    /// Writes one file atomically: the mesh, or a drawing. Copied material libraries are written first. Returns the files
    /// written, `path` first.
    ///
    /// # Errors
    ///
    /// If the file cannot be written; the error names the file.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        if kind == OutputKind::Svg {
            check_finite(&self.repacked.coordinates).map_err(|source| WriteError::writing(path, source))?;
            write_atomically(path, |out| write_layout_svg(out, &self.drawing()))?;
            return Ok(vec![path.to_owned()]);
        }
        self.with_file(|file| file.write(kind, path))
    }

    /// Writes to standard output.
    ///
    /// # Errors
    ///
    /// If standard output cannot be written.
    pub fn write_to_standard_output(&self, kind: OutputKind) -> Result<(), WriteError> {
        if kind == OutputKind::Svg {
            return write_to_standard_output(|mut out| {
                check_finite(&self.repacked.coordinates)?;
                write_layout_svg(&mut out, &self.drawing())
            });
        }
        self.with_file(|file| file.write_to_standard_output(kind))
    }

    /// Calls `of` with the mesh file.
    fn with_file<T>(&self, of: impl FnOnce(TexturedFile<'_>) -> T) -> T {
        let precision = self.report.precision.unwrap_or_default();
        let Self { source, source_path, materials, .. } = *self;
        of(TexturedFile { source, source_path, materials, texture: &self.texture(), precision })
    }

    /// Data of the source that a mesh file of this kind does not hold.
    pub fn not_kept_in(&self, kind: OutputKind) -> Vec<FileData> {
        if kind.is_mesh() { self.source.not_kept_in(kind, || self.texture()) } else { Vec::new() }
    }

    fn texture(&self) -> Texture {
        let number = |&corner: &u32| if corner == NO_COORDINATE { NO_TEXTURE } else { corner };
        let corners = self.repacked.corners.iter().map(number).collect();
        Texture { coordinates: self.repacked.coordinates.to_vec(), corners }
    }

    fn drawing(&self) -> LayoutDrawing<'_> {
        let Repacked { mesh, coordinates, .. } = &self.repacked;
        LayoutDrawing { mesh, coordinates, flipped: self.flipped_faces(), aspect: self.repacked.aspect() }
    }

    /// Triangles that are not oriented as most triangles of their chart.
    fn flipped_faces(&self) -> Vec<FaceId> {
        let Repacked { mesh, coordinates, charts, .. } = &self.repacked;
        let turn = |face: &usize| {
            let [a, b, c] = mesh.triangles[*face].map(|vertex| coordinates[vertex]);
            orientation(a, b, c)
        };
        let (mut first, mut flipped) = (0, Vec::new());
        for chart in charts {
            let faces = || first..first + chart.faces;
            let turned = faces().filter(|face| turn(face) == Some(Orientation::Clockwise)).count();
            let usual = if 2 * turned > chart.faces { Orientation::Clockwise } else { Orientation::CounterClockwise };
            flipped.extend(faces().filter(|face| turn(face) != Some(usual)).map(FaceId::from_index));
            first += chart.faces;
        }
        flipped
    }
}
