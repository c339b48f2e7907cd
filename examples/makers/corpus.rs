//! Where meshes of others lie, which are no part of the project.

use std::path::{Path, PathBuf};

/// The folder of test meshes, where there is one. Says so where there is none.
pub(crate) fn corpus() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    if folder.join("manifest.csv").is_file() {
        return Some(folder);
    }
    println!("nothing to do: there is no corpus at {}", folder.display());
    None
}
