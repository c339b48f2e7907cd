//! What files are asked for, and what such files are called.

use std::path::Path;

use crate::io::OutputKind;
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

impl Purpose {
    pub(in crate::ui) const fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a mesh or a project",
            Self::OpenPicture => "Open a picture",
            Self::ImportConstraints => "Import constraints",
            Self::ExportConstraints => "Export the constraints",
            Self::SaveProject => "Save the project",
            Self::Save => "Save the mesh with texture coordinates",
            Self::Drawing(_) => "Export a drawing of the layout",
            Self::Overview => "Export a picture of mesh and layout",
            Self::PanePicture(_) => "Export a picture of the pane",
            Self::Report => "Export the report",
        }
    }

    pub(in crate::ui) const fn button(self) -> &'static str {
        match self {
            Self::Open | Self::OpenPicture => "Open",
            Self::ImportConstraints => "Import",
            Self::Save | Self::SaveProject => "Save",
            _ => "Export",
        }
    }

    /// What such files are called.
    pub(in crate::ui) const fn files(self) -> &'static str {
        match self {
            Self::Open => "Meshes and projects",
            Self::OpenPicture => "Pictures",
            Self::ImportConstraints | Self::ExportConstraints => "Constraints",
            Self::SaveProject => "Freebound project",
            Self::Save => "OBJ mesh",
            Self::Drawing(_) => "SVG drawing",
            Self::Overview | Self::PanePicture(_) => "PNG picture",
            Self::Report => "JSON report",
        }
    }

    pub(in crate::ui) const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Open => &["obj", "freebound"],
            Self::OpenPicture => &["png", "jpg", "jpeg"],
            Self::ImportConstraints | Self::ExportConstraints => &["txt"],
            Self::SaveProject => &["freebound"],
            Self::Save => &["obj"],
            Self::Drawing(_) => &["svg"],
            Self::Overview | Self::PanePicture(_) => &["png"],
            Self::Report => &["json"],
        }
    }

    /// Whether a file is asked for that is there already.
    pub(in crate::ui) const fn is_reading(self) -> bool {
        matches!(self, Self::Open | Self::OpenPicture | Self::ImportConstraints)
    }

    /// Whether a name will do: what is written has the extension that says so.
    pub(in crate::ui) fn takes(self, path: &Path) -> bool {
        let is_free = self.is_reading() || matches!(self, Self::Save | Self::ExportConstraints);
        is_free || has_extension(path, self.extensions())
    }

    /// The end of a suggested name.
    pub(super) const fn ending(self) -> &'static str {
        match self {
            Self::SaveProject => ".freebound",
            Self::ExportConstraints => "-constraints.txt",
            Self::Drawing(_) => "-flat.svg",
            Self::Overview => "-flat.png",
            Self::PanePicture(Pane::Mesh) => "-mesh.png",
            Self::PanePicture(Pane::Plane) => "-embedding.png",
            Self::Report => "-report.json",
            Self::Open | Self::OpenPicture | Self::ImportConstraints | Self::Save => "-flat.obj",
        }
    }
}

/// Whether a name ends in one of these.
pub(in crate::ui) fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    extensions.contains(&extension.as_str())
}

/// The kind of file that a purpose asks for, where the session makes it.
pub(super) const fn kind_of(purpose: Purpose) -> Option<OutputKind> {
    match purpose {
        Purpose::Save => Some(OutputKind::Obj),
        Purpose::Drawing(_) => Some(OutputKind::Svg),
        Purpose::Overview => Some(OutputKind::Png),
        Purpose::Report => Some(OutputKind::Json),
        _ => None,
    }
}
