//! Sets `cfg(corpus)` if the test corpus is there, so that tests over it are ignored, and counted, if it is missing.
//!
//! The corpus is in `../shared/corpus`, beside the workspace, or in the folder that `FREEBOUND_CORPUS` names. A
//! corpus added after the first build is detected only if that variable changes or this file is touched. Watching a
//! missing file would rebuild the crate every time.

use std::env;
use std::path::{self, Path, PathBuf};

fn main() {
    println!("cargo::rustc-check-cfg=cfg(corpus)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=FREEBOUND_CORPUS");
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus");
    let folder = env::var_os("FREEBOUND_CORPUS").map_or_else(beside, PathBuf::from);
    let folder = path::absolute(&folder).expect("a path");
    let manifest = folder.join("manifest.csv");
    println!("cargo::rustc-env=FREEBOUND_CORPUS_FOLDER={}", folder.display());
    if manifest.is_file() {
        println!("cargo::rerun-if-changed={}", manifest.display());
        println!("cargo::rustc-cfg=corpus");
    }
}
