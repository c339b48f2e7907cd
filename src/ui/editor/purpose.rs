//! What files are asked for, and what such files are called.

use std::path::{Path, PathBuf};
use std::slice;
use std::sync::mpsc::Receiver;

use crate::geom::Picture;
use crate::io::{OutputFit, OutputKind};
use crate::ui::{Dialogs, Pane, Unsaved};

/// Files that are asked for, or about to be written.
#[derive(Debug, Default)]
pub struct Files {
    pub dialogs: Dialogs,
    pub unsaved: Unsaved,
    /// Size of coordinates in files.
    pub fit: OutputFit,
    /// A picture of a pane that was asked for, and where to write it.
    pub(in crate::ui) shot: Option<(PathBuf, Receiver<Picture>)>,
}

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A mesh or a project to open.
    Open,
    OpenPicture,
    ImportConstraints,
    ExportConstraints,
    ImportSeams,
    ExportSeams,
    SaveProject,
    /// Where to write the flattening in a format, at a size of its own or at that of the editor.
    Export(OutputKind, Option<OutputFit>),
    /// Where to write what a pane shows.
    PanePicture(Pane),
    /// Where to write what methods that are compared have come to.
    Comparison(ComparisonExport),
}

/// What can be written of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonExport {
    /// The embeddings side by side.
    Picture,
    /// The table.
    Table,
    /// Every step of every method.
    Steps,
    /// The morph that shows.
    Morph,
}

impl ComparisonExport {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Picture, Self::Table, Self::Steps, Self::Morph];

    /// Its entry in menus, and what it is.
    pub(in crate::ui) const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Picture => ["Picture…", "PNG, drawn anew: the embeddings at one scale, with their numbers"],
            Self::Table => ["Table…", "CSV, a line for each method"],
            Self::Steps => ["Steps…", "CSV, every step of every method with its seconds, energy and stretch"],
            Self::Morph => ["Animated picture…", "APNG, drawn anew: the morph that shows, there and back"],
        }
    }
}

/// The dialog of a purpose.
pub(in crate::ui) struct DialogForm {
    /// Its first word is that of the button.
    pub(in crate::ui) title: &'static str,
    /// What such files are called.
    pub(in crate::ui) files: &'static str,
    /// How their names end, the first one where a name has no ending.
    pub(in crate::ui) extensions: &'static [&'static str],
    /// The end of a suggested name.
    pub(in crate::ui) ending: &'static str,
}

impl DialogForm {
    /// Whether a name ends as those of such files do.
    pub(in crate::ui) fn fits(&self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        self.extensions.contains(&extension.as_str())
    }
}

/// How the names of meshes and projects end.
const OPENED: &[&str] = &["obj", "ply", "stl", "off", "glb", "gltf", "freebound"];

impl Purpose {
    pub(in crate::ui) fn form(self) -> DialogForm {
        let (title, files, extensions, ending): (_, _, &[&str], _) = match self {
            Self::Open => ("Open a mesh or a project", "Meshes and projects", OPENED, ""),
            Self::OpenPicture => ("Open a picture", "Pictures", &["png", "jpg", "jpeg"], ""),
            Self::ImportConstraints => ("Import constraints", "Constraints", &["txt"], ""),
            Self::ExportConstraints => ("Export the constraints", "Constraints", &["txt"], "-constraints.txt"),
            Self::ImportSeams => ("Import seams", "Edges", &["edges", "txt"], ""),
            Self::ExportSeams => ("Export the seams", "Edges", &["edges", "txt"], ".edges"),
            Self::SaveProject => ("Save the project", "Freebound project", &["freebound"], ".freebound"),
            Self::Export(kind, _) => {
                let format = kind.format();
                (format.title, format.name, slice::from_ref(&format.extension), format.ending)
            }
            Self::PanePicture(Pane::Mesh) => ("Export a picture of the pane", "PNG picture", &["png"], "-mesh.png"),
            Self::PanePicture(Pane::Plane) => {
                ("Export a picture of the pane", "PNG picture", &["png"], "-embedding.png")
            }
            Self::Comparison(ComparisonExport::Picture) => {
                ("Export a picture of the comparison", "PNG picture", &["png"], "-comparison.png")
            }
            Self::Comparison(ComparisonExport::Table) => {
                ("Export the table of the comparison", "CSV table", &["csv"], "-comparison.csv")
            }
            Self::Comparison(ComparisonExport::Steps) => {
                ("Export the steps of the comparison", "CSV table", &["csv"], "-comparison-steps.csv")
            }
            Self::Comparison(ComparisonExport::Morph) => {
                ("Export the morph as an animated picture", "Animated PNG", &["png", "apng"], "-morph.png")
            }
        };
        DialogForm { title, files, extensions, ending }
    }

    /// Whether a file is asked for that is there already.
    pub(in crate::ui) const fn is_reading(self) -> bool {
        matches!(self, Self::Open | Self::OpenPicture | Self::ImportConstraints | Self::ImportSeams)
    }

    /// Whether a name will do: what is written has the extension that says so.
    pub(in crate::ui) fn takes(self, path: &Path) -> bool {
        let takes_any = matches!(self, Self::Export(OutputKind::Obj, _) | Self::ExportConstraints | Self::ExportSeams);
        let is_free = self.is_reading() || takes_any;
        is_free || self.form().fits(path)
    }
}
