//! Recently opened files, kept between runs.

use std::path::{Path, PathBuf};

use super::recovery::system_folder;
use freebound_io::write_atomically;

/// Maximum number of remembered files.
const CAPACITY: usize = 10;

/// Recently opened files, newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecentFiles {
    paths: Vec<PathBuf>,
    store: Option<PathBuf>,
}

impl RecentFiles {
    /// Reads the list stored in `store`. A missing or broken list is empty.
    pub fn load(store: PathBuf) -> Self {
        let text = std::fs::read_to_string(&store).unwrap_or_default();
        let paths: Vec<PathBuf> = serde_json::from_str(&text).unwrap_or_default();
        Self { paths, store: Some(store) }
    }

    /// Path of the list on this system. `None` if the system has no folder for settings.
    pub fn default_store() -> Option<PathBuf> {
        Some(system_folder(["XDG_CONFIG_HOME", "APPDATA"], ".config")?.join("recent.json"))
    }

    /// Files, newest first.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// Moves a file to the front and writes the list. Failures of writing are ignored.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.paths.retain(|known| *known != path);
        self.paths.insert(0, path);
        self.paths.truncate(CAPACITY);
        self.store();
    }

    /// Clears the list.
    pub fn clear(&mut self) {
        self.paths.clear();
        self.store();
    }

    fn store(&self) {
        let Some(store) = &self.store else { return };
        if let Some(folder) = store.parent() {
            std::fs::create_dir_all(folder).ok();
        }
        write_atomically(store, |out| serde_json::to_writer(out, &self.paths).map_err(Into::into)).ok();
    }
}
