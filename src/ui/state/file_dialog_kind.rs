//! Kinds of file dialogs: title, names and extensions.

use std::path::Path;
use std::slice;

use super::comparison::ComparisonExport;
use super::pane::Pane;
use super::timeline_view::CurvesExport;
use freebound_core::pipeline::Fit;
use freebound_io::{OutputKind, PatternFormat};

/// Kinds of file dialogs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileDialogKind {
    /// Mesh or project to open, or picture for the open mesh.
    Open,
    OpenPicture,
    /// Mesh of a project that is not at its place any more.
    LocateMesh,
    /// Picture of a project that is not at its place any more.
    LocatePicture,
    /// Table of numbers that colours the faces.
    OpenTable,
    /// Picture that the checker repeats.
    OpenChecker,
    /// Mesh whose layout is copied to the open mesh.
    CopyLayout,
    ImportConstraints,
    ExportConstraints,
    ImportSeams,
    ExportSeams,
    SaveProject,
    /// Export of the flattening in a format. Default size: the size chosen in the editor.
    Export(OutputKind, Option<Fit>),
    /// Layout as a flat mesh.
    FlatMesh,
    /// Cutting pattern.
    Pattern,
    /// Picture of the file's layout, drawn for the layout on the screen.
    Baked,
    /// Picture of a pane.
    PanePicture(Pane),
    /// Export of the method comparison.
    Comparison(ComparisonExport),
    /// Export of the curves of the steps.
    Curves(CurvesExport),
    /// Linear system of the step on the screen.
    LinearSystem,
    /// Pictures of all steps, one numbered file each.
    StepPictures,
}

/// Texts and extensions of a dialog.
pub(in crate::ui) struct DialogForm {
    /// Title. Its first word labels the button.
    pub(in crate::ui) title: &'static str,
    /// Name of the kind of files.
    pub(in crate::ui) files: &'static str,
    /// Extensions. A name without extension gets the first.
    pub(in crate::ui) extensions: &'static [&'static str],
    /// Ending of a suggested name.
    pub(in crate::ui) ending: &'static str,
}

impl DialogForm {
    /// True if a path has an extension of the dialog.
    pub(in crate::ui) fn fits(&self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        self.extensions.contains(&extension.as_str())
    }
}

/// Extensions of meshes.
pub(in crate::ui) const MESHES: &[&str] = &["obj", "ply", "stl", "off", "glb", "gltf"];

/// Extensions of pictures that can be read.
const PICTURES: &[&str] = &["png", "jpg", "jpeg"];

/// Extensions of other pictures, which are told apart from meshes to be refused as pictures.
const OTHER_PICTURES: &[&str] = &["bmp", "gif", "webp", "tif", "tiff", "tga", "exr", "hdr", "psd", "heic", "avif"];

/// True if a file is a picture, by the extension of its name.
pub(crate) fn is_picture(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    PICTURES.iter().chain(OTHER_PICTURES).any(|other| extension.eq_ignore_ascii_case(other))
}

/// Extensions of meshes, projects and pictures.
const OPENED: &[&str] = &["obj", "ply", "stl", "off", "glb", "gltf", "freebound", "png", "jpg", "jpeg"];

impl FileDialogKind {
    pub(in crate::ui) fn form(self) -> DialogForm {
        let (title, files, extensions, ending): (_, _, &[&str], _) = match self {
            Self::Open => ("Open a mesh, a project or a picture", "Meshes, projects and pictures", OPENED, ""),
            Self::OpenPicture => ("Open a picture", "Pictures", PICTURES, ""),
            Self::LocateMesh => ("Locate the mesh of the project", "Meshes", MESHES, ""),
            Self::LocatePicture => ("Locate the picture of the project", "Pictures", PICTURES, ""),
            Self::OpenTable => ("Open a table of numbers", "Tables", &["csv", "tsv", "txt"], ""),
            Self::OpenChecker => ("Open a picture for the checker", "Pictures", PICTURES, ""),
            Self::CopyLayout => ("Copy the layout of another mesh", "Meshes", MESHES, ""),
            Self::ImportConstraints => (
                "Import constraints or landmarks",
                "Constraints, landmarks, projects",
                &["txt", "pts", "freebound"],
                "",
            ),
            Self::ExportConstraints => {
                ("Export the constraints", "Constraints, landmarks", &["txt", "pts"], "-constraints.txt")
            }
            Self::ImportSeams => ("Import seams", "Edges", &["edges", "txt"], ""),
            Self::ExportSeams => ("Export the seams", "Edges", &["edges", "txt"], ".edges"),
            Self::SaveProject => ("Save the project", "Freebound project", &["freebound"], ".freebound"),
            Self::Export(kind, _) => {
                let format = kind.format();
                (format.title, format.name, slice::from_ref(&format.extension), format.ending)
            }
            Self::FlatMesh => {
                ("Export the flat mesh", "OBJ, PLY or GLB mesh", &["obj", "ply", "glb"], "-flat-mesh.obj")
            }
            Self::Pattern => {
                ("Export the cutting pattern", "PDF, SVG or DXF drawing", PatternFormat::EXTENSIONS, "-pattern.pdf")
            }
            Self::Baked => ("Export the picture for this layout", "PNG picture", &["png"], "-texture.png"),
            Self::PanePicture(Pane::Mesh) => ("Export a picture of the pane", "PNG picture", &["png"], "-mesh.png"),
            Self::PanePicture(Pane::Plane) => {
                ("Export a picture of the pane", "PNG picture", &["png"], "-embedding.png")
            }
            Self::Curves(CurvesExport::Table) => ("Export the curves as a table", "CSV table", &["csv"], "-curves.csv"),
            Self::Curves(CurvesExport::Svg) => {
                ("Export a drawing of the curves", "SVG drawing", &["svg"], "-curves.svg")
            }
            Self::Curves(CurvesExport::Pdf) => {
                ("Export a document of the curves", "PDF document", &["pdf"], "-curves.pdf")
            }
            Self::Comparison(export) => return Self::form_of_comparison(export),
            Self::LinearSystem => {
                ("Export the linear system of the step", "Matrix Market file", &["mtx"], "-matrix.mtx")
            }
            Self::StepPictures => {
                ("Export pictures of all steps", "PNG, SVG or PDF files", &["png", "svg", "pdf"], "-step.png")
            }
        };
        DialogForm { title, files, extensions, ending }
    }

    fn form_of_comparison(export: ComparisonExport) -> DialogForm {
        let (title, files, extensions, ending): (_, _, &[&str], _) = match export {
            ComparisonExport::Picture => {
                ("Export a picture of the comparison", "PNG picture", &["png"], "-comparison.png")
            }
            ComparisonExport::Drawing => {
                ("Export a drawing of the comparison", "SVG drawing", &["svg"], "-comparison.svg")
            }
            ComparisonExport::Document => {
                ("Export a document of the comparison", "PDF document", &["pdf"], "-comparison.pdf")
            }
            ComparisonExport::Table => ("Export the table of the comparison", "CSV table", &["csv"], "-comparison.csv"),
            ComparisonExport::Steps => {
                ("Export the steps of the comparison", "CSV table", &["csv"], "-comparison-steps.csv")
            }
            ComparisonExport::Morph => {
                ("Export the morph as an animated picture", "Animated PNG", &["png", "apng"], "-morph.png")
            }
        };
        DialogForm { title, files, extensions, ending }
    }

    /// True if the dialog exports steps, or curves of their numbers.
    pub(in crate::ui) const fn is_of_steps(self) -> bool {
        matches!(self, Self::Curves(_) | Self::StepPictures | Self::LinearSystem)
    }

    /// True if the dialog asks for an existing file.
    pub(in crate::ui) const fn is_reading(self) -> bool {
        matches!(
            self,
            Self::Open
                | Self::OpenPicture
                | Self::LocateMesh
                | Self::LocatePicture
                | Self::OpenTable
                | Self::OpenChecker
                | Self::CopyLayout
                | Self::ImportConstraints
                | Self::ImportSeams
        )
    }

    /// True if the dialog accepts a path: its extension fits. Input files, OBJ files, constraints and seams accept
    /// any extension.
    pub(in crate::ui) fn takes(self, path: &Path) -> bool {
        let takes_any = matches!(self, Self::Export(OutputKind::Obj, _) | Self::ExportConstraints | Self::ExportSeams);
        let is_free = self.is_reading() || takes_any;
        is_free || self.form().fits(path)
    }
}

/// Entry that opens the options of a cutting pattern, and its description.
pub(in crate::ui) const PATTERN: [&str; 2] =
    ["Cutting pattern…", "PDF, SVG or DXF in true size, with seam allowance, notches and pages of paper"];

/// Entry that copies the layout of another mesh, and its description.
pub(in crate::ui) const COPY_LAYOUT: [&str; 2] = [
    "Copy the layout of another mesh…",
    "Seams and charts of another level of detail or version of this model, by nearest points, proved on this mesh",
];

/// Entry that opens the options of a picture drawn for the layout, and its description.
pub(in crate::ui) const BAKED: [&str; 2] =
    ["Picture for this layout…", "PNG: the picture of the file's own layout, drawn anew for the layout on the screen"];

/// Reason why no picture can be drawn for the layout.
pub(in crate::ui) const NO_MAP: &str = "There is nothing to export yet: open a mesh, or wait for its map";

/// Reason why no picture can be drawn for the layout.
pub(in crate::ui) const NO_LAYOUT_PICTURE: &str = "Open a mesh with texture coordinates and its picture first";

/// Export with a window of options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportOptions {
    /// Cutting pattern.
    Pattern,
    /// Picture drawn for the layout.
    Baked,
}

/// Entry that copies a command line, and its description.
pub(in crate::ui) const COPY_COMMAND: [&str; 2] =
    ["Copy as command line", "Copy the command that makes this map, with comments on what it does not express"];

/// All exports: dialog, menu entry and description.
pub(in crate::ui) const EXPORTS: [(FileDialogKind, &str, &str); 15] = {
    use FileDialogKind::{Curves, Export, FlatMesh, LinearSystem, PanePicture, StepPictures};
    use OutputKind::{Glb, Json, Obj, Ply, Png, Svg};
    let (unit, true_scale) = (Some(Fit::Unit), Some(Fit::True));
    let [table, svg, pdf] = CurvesExport::ALL;
    [
        (
            Export(Obj, None),
            "Mesh with texture coordinates…",
            "OBJ, with its material, and with the picture if there is one",
        ),
        (Export(Ply, None), "Mesh as PLY…", "PLY in 32 bits, with all data of an opened PLY file"),
        (Export(Glb, None), "Mesh as GLB…", "Binary glTF in 32 bits, with all data of an opened glTF file"),
        (Export(Svg, unit), "Layout in the unit square…", "SVG, positioned like texture coordinates"),
        (Export(Svg, true_scale), "Layout at true scale…", "SVG in the units of the mesh, for cutting out"),
        (FlatMesh, "Layout as a flat mesh…", "OBJ, PLY or GLB in the plane z = 0, in the units of the mesh"),
        (PanePicture(Pane::Mesh), "Picture of the mesh's pane…", "PNG, as shown in the pane"),
        (PanePicture(Pane::Plane), "Picture of the embedding's pane…", "PNG, as shown in the pane"),
        (Export(Png, None), "Mesh and layout side by side…", "PNG, redrawn for the file"),
        (Export(Json, None), "Report…", "JSON: method, steps, verdict, distortion"),
        (Curves(table), table.words()[0], table.words()[1]),
        (Curves(svg), svg.words()[0], svg.words()[1]),
        (Curves(pdf), pdf.words()[0], pdf.words()[1]),
        (
            StepPictures,
            "Pictures of all steps…",
            "Numbered PNG, SVG or PDF files, one for each step, all with one camera",
        ),
        (
            LinearSystem,
            "Linear system of this step…",
            "Matrix Market: the matrix, and the right-hand side in a second file",
        ),
    ]
};
