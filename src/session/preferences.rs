//! State of the window, kept between runs beside the recovery copies.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::recovery::state_folder;
use freebound_io::write_atomically;

/// State of the window. Missing values, and all values of an invalid file, are the defaults of the first start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// True for a dark theme. Default: the theme of the system.
    pub dark: Option<bool>,
    /// True if the wireframe is shown.
    pub wireframe: bool,
    /// Name of the shading in the mesh pane.
    pub mesh_shading: Option<String>,
    /// Name of the shading in the embedding pane.
    pub plane_shading: Option<String>,
    /// Width of the panels on the right, points.
    pub panel_width: Option<f32>,
    /// Width and height of the window, points.
    pub window_size: Option<[f32; 2]>,
    /// True if the program starts without the welcome.
    pub no_welcome: bool,
    /// Folders that the file dialog offers.
    pub folders: KeptFolders,
    /// Changed keys, by the keys that they replace.
    pub keys: BTreeMap<String, String>,
    /// Names of the commands chosen last in the command palette, newest first.
    pub recent_commands: Vec<String>,
    /// Checker over the plane.
    pub checker: KeptChecker,
}

/// Checker over the plane.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptChecker {
    /// Name of its squares.
    pub style: String,
    /// Number of squares along the page, if the user has chosen it.
    pub squares: Option<u32>,
    /// Picture that the user chose.
    pub picture: Option<PathBuf>,
}

/// Greatest number of recent folders.
const MOST_FOLDERS: usize = 8;

/// Folders that the file dialog offers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptFolders {
    /// Folders of the files chosen last, newest first.
    pub recent: Vec<PathBuf>,
    /// Folders that the user pinned, oldest first.
    pub pinned: Vec<PathBuf>,
}

impl KeptFolders {
    /// Puts a folder first among the recent ones.
    pub fn remember(&mut self, folder: &Path) {
        self.recent.retain(|other| other != folder);
        self.recent.insert(0, folder.to_owned());
        self.recent.truncate(MOST_FOLDERS);
    }

    /// Pins a folder, or unpins it.
    pub fn toggle_pin(&mut self, folder: &Path) {
        if self.pinned.iter().any(|other| other == folder) {
            self.pinned.retain(|other| other != folder);
        } else {
            self.pinned.push(folder.to_owned());
        }
    }
}

impl Preferences {
    /// Reads the stored preferences. A missing or broken file gives the defaults.
    pub fn load(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Writes the preferences atomically. Failures are ignored.
    pub fn store(&self, path: &Path) {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).ok();
        }
        write_atomically(path, |out| serde_json::to_writer(out, self).map_err(Into::into)).ok();
    }

    /// Path of the preferences on this system. `None` if the system has no folder for them.
    pub fn default_store() -> Option<PathBuf> {
        Some(state_folder()?.join("window.json"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_file_and_numbers_of_another_kind_are_the_first_start() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep/window.json");
        assert_eq!(Preferences::load(&path), Preferences::default());
        let left = Preferences { dark: Some(true), panel_width: Some(300.0), ..Preferences::default() };
        left.store(&path);
        assert_eq!(Preferences::load(&path), left);
        for text in ["", "{", "[1]", "{\"panel_width\": \"wide\"}", "null"] {
            std::fs::write(&path, text).expect("written");
            assert_eq!(Preferences::load(&path), Preferences::default(), "{text}");
        }
        std::fs::write(&path, "{\"dark\": true, \"of another version\": 1}").expect("written");
        assert_eq!(Preferences::load(&path).dark, Some(true));
    }
}
