//! What files are asked for, and what such files are called.

use std::path::Path;

use crate::session::OutputFit;
use crate::ui::Pane;

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A mesh or a project to open.
    Open,
    /// A picture to map on the mesh.
    OpenPicture,
    /// Constraints to take over.
    ImportConstraints,
    /// Where to write the constraints.
    ExportConstraints,
    /// Where to save the project.
    SaveProject,
    /// Where to save the mesh with texture coordinates.
    Save,
    /// Where to write a drawing of the layout, of this size.
    Drawing(OutputFit),
    /// Where to write mesh and layout side by side.
    Overview,
    /// Where to write what a pane shows.
    PanePicture(Pane),
    /// Where to write the report.
    Report,
}

/// Files of one type.
#[derive(Clone, Copy)]
pub(in crate::ui) struct FileType {
    /// What they are called.
    pub(in crate::ui) name: &'static str,
    /// How their names end, the first one where a name has no ending.
    pub(in crate::ui) extensions: &'static [&'static str],
}

const OPENED: FileType = FileType { name: "Meshes and projects", extensions: &["obj", "freebound"] };
const PICTURES: FileType = FileType { name: "Pictures", extensions: &["png", "jpg", "jpeg"] };
const CONSTRAINTS: FileType = FileType { name: "Constraints", extensions: &["txt"] };
const PROJECT: FileType = FileType { name: "Freebound project", extensions: &["freebound"] };
const OBJ: FileType = FileType { name: "OBJ mesh", extensions: &["obj"] };
const SVG: FileType = FileType { name: "SVG drawing", extensions: &["svg"] };
const PNG: FileType = FileType { name: "PNG picture", extensions: &["png"] };
const JSON: FileType = FileType { name: "JSON report", extensions: &["json"] };

impl FileType {
    /// Whether a name ends as those of such files do.
    pub(in crate::ui) fn fits(self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        self.extensions.contains(&extension.as_str())
    }
}

/// The dialog of a purpose.
pub(in crate::ui) struct DialogForm {
    pub(in crate::ui) title: &'static str,
    /// What its button says.
    pub(in crate::ui) button: &'static str,
    pub(in crate::ui) files: FileType,
    /// The end of a suggested name.
    pub(in crate::ui) ending: &'static str,
}

impl Purpose {
    /// The dialog that asks for the file.
    pub(in crate::ui) const fn form(self) -> DialogForm {
        let (title, button, files, ending) = match self {
            Self::Open => ("Open a mesh or a project", "Open", OPENED, ""),
            Self::OpenPicture => ("Open a picture", "Open", PICTURES, ""),
            Self::ImportConstraints => ("Import constraints", "Import", CONSTRAINTS, ""),
            Self::ExportConstraints => ("Export the constraints", "Export", CONSTRAINTS, "-constraints.txt"),
            Self::SaveProject => ("Save the project", "Save", PROJECT, ".freebound"),
            Self::Save => ("Save the mesh with texture coordinates", "Save", OBJ, "-flat.obj"),
            Self::Drawing(_) => ("Export a drawing of the layout", "Export", SVG, "-flat.svg"),
            Self::Overview => ("Export a picture of mesh and layout", "Export", PNG, "-flat.png"),
            Self::PanePicture(Pane::Mesh) => ("Export a picture of the pane", "Export", PNG, "-mesh.png"),
            Self::PanePicture(Pane::Plane) => ("Export a picture of the pane", "Export", PNG, "-embedding.png"),
            Self::Report => ("Export the report", "Export", JSON, "-report.json"),
        };
        DialogForm { title, button, files, ending }
    }

    /// Whether a file is asked for that is there already.
    pub(in crate::ui) const fn is_reading(self) -> bool {
        matches!(self, Self::Open | Self::OpenPicture | Self::ImportConstraints)
    }

    /// Whether a name will do: what is written has the extension that says so.
    pub(in crate::ui) fn takes(self, path: &Path) -> bool {
        let is_free = self.is_reading() || matches!(self, Self::Save | Self::ExportConstraints);
        is_free || self.form().files.fits(path)
    }
}
