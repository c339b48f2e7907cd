//! The picture that is mapped on the mesh.

use std::path::PathBuf;
use std::sync::Arc;

use crate::geom::Picture;

/// A picture with where it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// What to call it: file name, or title of the built-in one.
    pub name: String,
    /// The file it came from.
    pub path: Option<PathBuf>,
    /// Its pixels.
    pub pixels: Arc<Picture>,
}

impl PictureFile {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.pixels.width) / f64::from(self.pixels.height)
    }
}
