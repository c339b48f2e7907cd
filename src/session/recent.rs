//! The files opened last, kept between runs.

use std::path::{Path, PathBuf};

use super::recovery::system_folder;
use freebound_io::write_atomically;

/// How many are remembered.
const CAPACITY: usize = 10;

/// Files opened last, newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecentFiles {
    paths: Vec<PathBuf>,
    store: Option<PathBuf>,
}

impl RecentFiles {
    /// Reads the list that a run before left in `store`. A missing or broken list is an empty one.
    pub fn load(store: PathBuf) -> Self {
        let text = std::fs::read_to_string(&store).unwrap_or_default();
        let paths: Vec<PathBuf> = serde_json::from_str(&text).unwrap_or_default();
        Self { paths, store: Some(store) }
    }

    /// Where the list is kept on this system, `None` where it has no place for settings.
    pub fn default_store() -> Option<PathBuf> {
        Some(system_folder(["XDG_CONFIG_HOME", "APPDATA"], ".config")?.join("recent.json"))
    }

    /// The files, newest first.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// Puts a file first and writes the list. A list that cannot be written is no reason to disturb anybody.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.paths.retain(|known| *known != path);
        self.paths.insert(0, path);
        self.paths.truncate(CAPACITY);
        self.store();
    }

    /// Forgets all files.
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
