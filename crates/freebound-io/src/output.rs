//! Files that a finished flattening is written to, by their kind.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::charts::{TexturedMesh, textured};
use super::file_data::FileData;
use super::finite::check_finite;
use super::gltf::{Shading, write_glb_with};
use super::obj::{copy_materials, material_picture, relocated, write_obj_with};
use super::ply::write_ply;
use super::raster::{Canvas, Colour, RasterPaint, View, colours, mesh_picture, plane_picture, write_png};
use super::report::{Report, write_report};
use super::svg::write_svg;
use super::true_size::scale_to_true_size;
use super::{Materials, MeshFile, PictureFile, WriteError, write_atomically, write_to_standard_output};
use freebound_core::geom::Picture;
use freebound_core::mesh::{DiskMesh, FaceId, Repaired, VertexId};
use freebound_core::pipeline::{Fit, JoinedCharts, LaidChart, Placement, joined, prove_atlas};
use freebound_core::problem::Embedding;
use freebound_core::verify::{AtlasVerdict, Verdict, verdict};

/// Width and height of each half of a picture, pixels.
const PICTURE_SIZE: u32 = 900;

/// Number of checker fields across the layout.
const CHECKER_FIELDS: f64 = 40.0;

/// Path of a file without a name, which counts as one in the current folder.
const NAMELESS: &str = "-";

/// Kind of a file that can be written. [`format`](Self::format) describes each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// The mesh with its embedding as texture coordinates.
    Obj,
    /// The mesh with texture coordinates as a PLY file.
    Ply,
    /// The mesh with texture coordinates as a binary glTF file.
    Glb,
    /// A drawing of the layout.
    Svg,
    /// Mesh and layout side by side.
    Png,
    /// The report.
    Json,
}

/// Description of a kind of file for the command line and the window.
#[derive(Debug)]
pub struct Format {
    /// Name of the kind.
    pub name: &'static str,
    /// Extension of the file name.
    pub extension: &'static str,
    /// End of a suggested file name, with the extension.
    pub ending: &'static str,
    /// Title of a save dialog, verb first.
    pub title: &'static str,
    write: fn(&Output<'_>, &Path, &mut BufWriter<File>) -> io::Result<()>,
}

/// The formats, in the order of [`OutputKind`].
static FORMATS: [Format; 6] = [
    Format {
        name: "OBJ mesh",
        extension: "obj",
        ending: "-flat.obj",
        title: "Save the mesh with texture coordinates",
        write: |output, path, out| {
            let TexturedMesh { mesh, texture, .. } = output.textured();
            write_obj_with(out, &mesh, &relocated(&mesh, output.source_place(), path), &texture)
        },
    },
    Format {
        name: "PLY mesh",
        extension: "ply",
        ending: "-flat.ply",
        title: "Save the mesh with texture coordinates as PLY",
        write: |output, _, out| {
            let TexturedMesh { mesh, texture, .. } = output.textured();
            write_ply(out, &mesh, &texture, output.report.precision.unwrap_or_default())
        },
    },
    Format {
        name: "GLB mesh",
        extension: "glb",
        ending: "-flat.glb",
        title: "Save the mesh with texture coordinates as GLB",
        write: |output, _, out| {
            let TexturedMesh { mesh, texture, .. } = output.textured();
            // The picture of a material comes with the other materials.
            let is_of_material = |picture: &&PictureFile| {
                let of_material = output.source_path.and_then(|path| material_picture(&mesh, path));
                of_material.is_some() && picture.path == of_material
            };
            let shading = match output.picture.filter(|picture| !is_of_material(picture)) {
                Some(picture) => Some(Shading::of_picture(picture, &mesh)?),
                None => Shading::of_obj(&mesh, output.source_path),
            };
            write_glb_with(out, &mesh, &texture, shading.as_ref())
        },
    },
    Format {
        name: "SVG drawing",
        extension: "svg",
        ending: "-flat.svg",
        title: "Export a drawing of the layout",
        write: |output, _, out| write_svg(out, &output.charts, output.aspect, output.svg_fit),
    },
    Format {
        name: "PNG picture",
        extension: "png",
        ending: "-flat.png",
        title: "Export a picture of mesh and layout",
        write: |output, _, out| write_png(&output.picture(), out),
    },
    Format {
        name: "JSON report",
        extension: "json",
        ending: "-report.json",
        title: "Export the report",
        write: |output, _, out| write_report(out, &output.report),
    },
];

/// Extensions of all formats, for a message.
pub const EXTENSIONS: &str = ".svg, .png, .json, .ply, .glb or .obj";

impl OutputKind {
    /// Kind of a mesh file, by the extension of its name. Default: OBJ.
    pub fn of_mesh(path: &Path) -> Self {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "ply" => Self::Ply,
            "glb" => Self::Glb,
            _ => Self::Obj,
        }
    }

    /// True for a mesh with texture coordinates.
    pub const fn is_mesh(self) -> bool {
        matches!(self, Self::Obj | Self::Ply | Self::Glb)
    }

    /// Entry in the table of formats.
    pub fn format(self) -> &'static Format {
        &FORMATS[self as usize]
    }
}

/// Embedding of a mesh with its verdict.
#[derive(Clone, Copy, Debug)]
pub struct ProvedEmbedding<'a> {
    /// The mesh.
    pub mesh: &'a DiskMesh,
    /// Embedding or texture coordinates.
    pub embedding: &'a Embedding,
    /// The verdict.
    pub verdict: &'a Verdict,
}

impl ProvedEmbedding<'_> {
    /// Picture of the embedding. Faces that the verdict lists as flipped are red.
    pub fn picture(&self, canvas: &Canvas) -> Picture {
        layout_picture(self.embedding, self.mesh.mesh().real_triangles(), &self.verdict.flipped_faces, canvas)
    }
}

fn layout_picture(embedding: &Embedding, triangles: &[[VertexId; 3]], flipped: &[FaceId], canvas: &Canvas) -> Picture {
    let mut paint: Vec<Colour> = vec![colours::CLAY; triangles.len()];
    for face in flipped {
        paint[face.index()] = colours::FLIPPED;
    }
    plane_picture(embedding, triangles, canvas, RasterPaint::Faces(&paint))
}

/// Finished flattening, verified as it is written, with everything that the files contain.
#[derive(Debug)]
pub struct Output<'a> {
    /// Contents of the file as read.
    pub source: &'a MeshFile,
    /// File of the mesh; `None` for a stream or a built-in mesh.
    pub source_path: Option<&'a Path>,
    /// Treatment of its material libraries.
    pub materials: Materials,
    /// Repairs of the file's mesh, if there are any.
    pub repaired: Option<&'a Repaired>,
    /// Charts of the mesh, one or more.
    pub charts: Vec<LaidChart<'a>>,
    /// Report of the run.
    pub report: Report,
    /// Picture, if there is one. It is written beside an OBJ file, and drawn on the mesh in a PNG file.
    pub picture: Option<&'a PictureFile>,
    /// Width over height of the picture of the coordinates; 1 without a picture.
    pub aspect: f64,
    /// Size of the SVG drawing.
    pub svg_fit: Fit,
}

impl Output<'_> {
    /// Mesh and layout side by side. The mesh shows its picture, or a checker of its layout, seen from the side that
    /// most of its area faces. The layout is drawn in the plane, in which angles are measured: texture coordinates
    /// are scaled by the aspect of the picture.
    fn picture(&self) -> Picture {
        let JoinedCharts { mesh, coordinates, flipped } = joined(&self.charts);
        let eye = (0..mesh.face_count()).map(|face| mesh.double_area_vector(FaceId::from_index(face))).sum();
        let view = View { eye, up: if eye.cross(DVec3::Y) == DVec3::ZERO { DVec3::Z } else { DVec3::Y } };
        let scale = DVec2::new(self.aspect, 1.0);
        let layout: Embedding = coordinates.iter().map(|uv| *uv * scale).collect();
        let extent = layout.iter().fold(0.0_f64, |m, z| m.max((*z - layout[0]).abs().max_element()));
        let paint = match self.picture {
            Some(picture) => RasterPaint::Picture { coordinates: &coordinates, picture: &picture.pixels },
            None => RasterPaint::Checker { coordinates: &layout, size: extent / CHECKER_FIELDS },
        };
        let clay = Canvas::clay(PICTURE_SIZE, PICTURE_SIZE);
        let before = mesh_picture(&mesh.positions, &mesh.triangles, &view, &clay, paint);
        let drawing = Canvas::drawing(PICTURE_SIZE, PICTURE_SIZE);
        before.beside(&layout_picture(&layout, &mesh.triangles, &flipped, &drawing))
    }

    /// Verdict in lower-case words, for all charts together if there are several.
    pub fn summary(&self) -> String {
        match (&self.report.atlas, &self.charts[..]) {
            (None, [chart]) => chart.verdict.summary(),
            (atlas, _) => atlas.as_ref().map(AtlasVerdict::summary).unwrap_or_default(),
        }
    }

    /// True if the written map is proved one-to-one.
    pub fn is_planar(&self) -> bool {
        self.report
            .atlas
            .as_ref()
            .map_or_else(|| self.charts.iter().all(|chart| chart.verdict.planar), |atlas| atlas.planar)
    }

    /// Data of the source that a mesh file of this kind does not hold.
    pub fn not_kept_in(&self, kind: OutputKind) -> Vec<FileData> {
        if !kind.is_mesh() {
            return Vec::new();
        }
        let found = self.source.not_kept_in(kind, || self.textured().texture);
        // The picture takes the place of the materials.
        let has_material = self.picture.is_some() && kind != OutputKind::Ply;
        found.into_iter().filter(|&data| data != FileData::Materials || !has_material).collect()
    }

    /// Scales packed charts to the area of the surface, and verifies them again. They keep their arrangement, which
    /// fills more or less than the unit square.
    ///
    /// # Errors
    ///
    /// If the scales of the charts differ.
    pub fn scale_to_true_size(&mut self) -> io::Result<()> {
        let plane = DVec2::new(self.aspect, 1.0);
        let laid = |chart: &LaidChart<'_>| chart.coordinates.iter().map(|uv| uv * plane).collect();
        let mut embeddings: Vec<Embedding> = self.charts.iter().map(laid).collect();
        scale_to_true_size(&self.charts, &mut embeddings)?;
        self.charts.par_iter_mut().zip(embeddings).for_each(|(chart, embedding)| {
            chart.verdict = verdict(chart.mesh, &embedding);
            chart.coordinates = embedding;
        });
        self.aspect = 1.0;
        self.report.packing = None;
        self.report.atlas = Some(prove_atlas(&self.charts));
        for chart in &mut self.report.charts {
            (chart.placement, chart.density, chart.tile) = (Placement::True, 1.0, None);
        }
        Ok(())
    }

    /// Writes one file atomically. An OBJ file with a picture comes with two more, its material and the picture,
    /// which are written first. Copied material libraries are written first, too. Returns the files written, `path`
    /// first.
    ///
    /// # Errors
    ///
    /// If the file cannot be written, or coordinates are infinite or not numbers; the error names the file.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        self.check().map_err(|source| WriteError::writing(path, source))?;
        match (kind, self.picture, self.materials) {
            (OutputKind::Obj, Some(picture), _) => {
                let TexturedMesh { mesh, texture, .. } = self.textured();
                picture.write_beside(path, &mesh, &texture)
            }
            (OutputKind::Obj, None, Materials::Copied) => {
                let TexturedMesh { mesh, texture, .. } = self.textured();
                let (edits, copies) = copy_materials(&mesh, self.source_place(), path)?;
                write_atomically(path, |out| write_obj_with(out, &mesh, &edits, &texture))?;
                Ok(std::iter::once(path.to_owned()).chain(copies).collect())
            }
            _ => {
                write_atomically(path, |out| (kind.format().write)(self, path, out))?;
                Ok(vec![path.to_owned()])
            }
        }
    }

    /// Writes to standard output. An OBJ file is written without its picture, which needs a file beside it. Material
    /// libraries are named relative to the current folder.
    ///
    /// # Errors
    ///
    /// If standard output cannot be written, or coordinates are infinite or not numbers.
    pub fn write_to_standard_output(&self, kind: OutputKind) -> Result<(), WriteError> {
        write_to_standard_output(|out| {
            self.check()?;
            (kind.format().write)(self, Path::new(NAMELESS), out)
        })
    }

    /// Accepts finite coordinates only.
    fn check(&self) -> io::Result<()> {
        self.charts.iter().try_for_each(|chart| check_finite(&chart.coordinates))
    }

    /// Path of the source, or [`NAMELESS`].
    fn source_place(&self) -> &Path {
        self.source_path.unwrap_or(Path::new(NAMELESS))
    }

    /// Mesh of the file, with the new vertices if there are any, and its coordinates per corner.
    pub fn textured(&self) -> TexturedMesh<'_> {
        textured(&self.charts, self.source, self.repaired)
    }
}
