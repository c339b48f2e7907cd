//! The files that a finished flattening is written to, by their kind.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use super::charts::textured;
use super::finite::check_finite;
use super::gltf::write_glb;
use super::obj::{copy_materials, relocated, write_obj_with};
use super::ply::write_ply;
use super::raster::{Canvas, Colour, RasterPaint, View, colours, mesh_picture, plane_picture, write_png};
use super::report::{Report, write_report};
use super::svg::write_svg;
use super::{Materials, MeshFile, PictureFile, Texture, WriteError, write_atomically, write_to_standard_output};
use freebound_core::geom::Picture;
use freebound_core::mesh::{DiskMesh, FaceId, Repaired, VertexId};
use freebound_core::pipeline::{Fit, JoinedCharts, LaidChart, joined};
use freebound_core::problem::Embedding;
use freebound_core::verify::{AtlasVerdict, Verdict};

/// Width and height of each half of a picture, pixels.
const PICTURE_SIZE: u32 = 900;

/// Fields of the checker across the layout.
const CHECKER_FIELDS: f64 = 40.0;

/// Stands for a file without a name: it belongs to the current folder.
const NAMELESS: &str = "-";

/// Kinds of files that can be written; [`format`](Self::format) says what is known of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// The mesh with its embedding as texture coordinates.
    Obj,
    /// The same as a PLY file.
    Ply,
    /// The same as a binary glTF file.
    Glb,
    /// A drawing of the layout.
    Svg,
    /// Mesh and layout side by side.
    Png,
    /// The report.
    Json,
}

/// What the command line and the window know of a kind of file.
#[derive(Debug)]
pub struct Format {
    /// What files of this kind are called.
    pub name: &'static str,
    /// Extension of the file name.
    pub extension: &'static str,
    /// End of a suggested file name.
    pub ending: &'static str,
    /// What a dialog asks for, its verb first.
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
            let (mesh, texture) = output.textured();
            write_obj_with(out, &mesh, &relocated(&mesh, output.source_place(), path), &texture)
        },
    },
    Format {
        name: "PLY mesh",
        extension: "ply",
        ending: "-flat.ply",
        title: "Save the mesh with texture coordinates as PLY",
        write: |output, _, out| {
            let (mesh, texture) = output.textured();
            write_ply(out, &mesh, &texture)
        },
    },
    Format {
        name: "GLB mesh",
        extension: "glb",
        ending: "-flat.glb",
        title: "Save the mesh with texture coordinates as GLB",
        write: |output, _, out| {
            let (mesh, texture) = output.textured();
            write_glb(out, &mesh, &texture)
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

/// The extensions of all formats, for a message.
pub const EXTENSIONS: &str = ".svg, .png, .json, .ply, .glb or .obj";

impl OutputKind {
    /// The kind of a mesh's file, by the ending of its name; OBJ where that says nothing.
    pub fn of_mesh(path: &Path) -> Self {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "ply" => Self::Ply,
            "glb" => Self::Glb,
            _ => Self::Obj,
        }
    }

    /// Whether it holds a mesh with its texture coordinates.
    pub const fn is_mesh(self) -> bool {
        matches!(self, Self::Obj | Self::Ply | Self::Glb)
    }

    /// Its row in the table of formats.
    pub fn format(self) -> &'static Format {
        &FORMATS[self as usize]
    }
}

/// An embedding of a mesh with the verdict on it.
#[derive(Clone, Copy, Debug)]
pub struct ProvedEmbedding<'a> {
    /// The mesh.
    pub mesh: &'a DiskMesh,
    /// The embedding, or texture coordinates.
    pub embedding: &'a Embedding,
    /// The verdict.
    pub verdict: &'a Verdict,
}

impl ProvedEmbedding<'_> {
    /// Its picture, with the faces red that the verdict calls flipped.
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

/// A finished flattening, proved as it is written, with everything that files say about it.
#[derive(Debug)]
pub struct Output<'a> {
    /// The file's contents as read.
    pub source: &'a MeshFile,
    /// The file that the mesh came from; none where that was a stream, or it is built in.
    pub source_path: Option<&'a Path>,
    /// What becomes of its material libraries.
    pub materials: Materials,
    /// The repairs of the file's mesh, where there are any.
    pub repaired: Option<&'a Repaired>,
    /// Its charts, one or more.
    pub charts: Vec<LaidChart<'a>>,
    /// Report of the run.
    pub report: Report,
    /// The picture, where there is one: it goes beside an OBJ file, and on the mesh in a PNG file.
    pub picture: Option<&'a PictureFile>,
    /// Width over height of the picture that the coordinates are for; 1 where there is none.
    pub aspect: f64,
    /// Size of a drawing.
    pub svg_fit: Fit,
}

impl Output<'_> {
    /// The mesh under its picture, or under a checker of its layout, seen from the side that most faces look to; beside
    /// it the layout. The layout lies in the plane, where angles are measured: texture coordinates of a picture that is
    /// not square are not square either.
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

    /// The verdict in lower-case words: that on all charts, where there are several.
    pub fn summary(&self) -> String {
        match (&self.report.atlas, &self.charts[..]) {
            (None, [chart]) => chart.verdict.summary(),
            (atlas, _) => atlas.as_ref().map(AtlasVerdict::summary).unwrap_or_default(),
        }
    }

    /// Whether what is written is proved one-to-one.
    pub fn is_planar(&self) -> bool {
        self.report
            .atlas
            .as_ref()
            .map_or_else(|| self.charts.iter().all(|chart| chart.verdict.planar), |atlas| atlas.planar)
    }

    /// Writes one file: aside first, then renamed, so that it is never half-written. An OBJ file with a picture comes
    /// with two more, its material and the picture, which are there before it is. Returns the files written, this one
    /// first.
    ///
    /// # Errors
    ///
    /// Where the file cannot be written, or coordinates are infinite or not numbers; the error names the file.
    pub fn write(&self, kind: OutputKind, path: &Path) -> Result<Vec<PathBuf>, WriteError> {
        self.check().map_err(|source| WriteError::writing(path, source))?;
        match (kind, self.picture, self.materials) {
            (OutputKind::Obj, Some(picture), _) => {
                let (mesh, texture) = self.textured();
                picture.write_beside(path, &mesh, &texture)
            }
            (OutputKind::Obj, None, Materials::Copied) => {
                let (mesh, texture) = self.textured();
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

    /// Writes to standard output. An OBJ file comes without its picture there, which has no place beside it, and names
    /// material libraries as from the current folder.
    ///
    /// # Errors
    ///
    /// Where standard output takes no more.
    pub fn write_to_standard_output(&self, kind: OutputKind) -> Result<(), WriteError> {
        write_to_standard_output(|out| {
            self.check()?;
            (kind.format().write)(self, Path::new(NAMELESS), out)
        })
    }

    /// Lets finite coordinates pass.
    fn check(&self) -> io::Result<()> {
        self.charts.iter().try_for_each(|chart| check_finite(&chart.coordinates))
    }

    /// Where the mesh came from.
    fn source_place(&self) -> &Path {
        self.source_path.unwrap_or(Path::new(NAMELESS))
    }

    /// The file's mesh, with the new vertices where there are any, and the coordinates as those of its corners.
    fn textured(&self) -> (Cow<'_, MeshFile>, Texture) {
        textured(&self.charts, self.source, self.repaired)
    }
}
