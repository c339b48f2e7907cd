//! `-` as a file: the mesh from standard input, a result to standard output.

use std::io::stdin;
use std::path::Path;

use super::Failure;
use super::progress::is_interrupted;
use crate::session::Model;

/// What a mesh from standard input is called.
const STANDARD_INPUT: &str = "standard input";

/// Whether a path stands for standard input or output.
pub(super) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// What a mesh is called in messages.
pub(super) fn name_of_input(path: &Path) -> String {
    if is_standard(path) { STANDARD_INPUT.to_owned() } else { path.display().to_string() }
}

/// Reads a mesh from a file or from standard input.
pub(super) fn read_model(path: &Path) -> Result<Model, Failure> {
    let read = if is_standard(path) {
        Model::read_stream(STANDARD_INPUT, stdin().lock(), &is_interrupted)
    } else {
        Model::read_until(path, &is_interrupted)
    };
    read.map_err(|error| Failure::Read { path: name_of_input(path), error })
}
