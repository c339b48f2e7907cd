//! The picture that is mapped on the mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::examples::Example;
use crate::geom::Picture;
use crate::io::{FileStamp, PictureError, read_picture};

/// A picture with where it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// What to call it: the file's name, or a word for the built-in one.
    pub name: String,
    /// The file it came from; none where it belongs to the built-in mesh.
    pub path: Option<PathBuf>,
    /// The state of that file when it was read, where a project is to know it again.
    pub stamp: Option<FileStamp>,
    /// Its pixels.
    pub pixels: Arc<Picture>,
}

impl PictureFile {
    /// Reads a PNG or JPEG file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or that is no such picture.
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let pixels = Arc::new(read_picture(path)?);
        let stamp = FileStamp::read(path).ok();
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self { name, path: Some(path.to_owned()), stamp, pixels })
    }

    /// The picture that belongs to a built-in mesh.
    pub fn of_example(example: Example) -> Option<Self> {
        let pixels = Arc::new(example.picture()?);
        Some(Self { name: "portrait".to_owned(), path: None, stamp: None, pixels })
    }

    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.pixels.width) / f64::from(self.pixels.height)
    }
}
