//! Pictures in: PNG and JPEG.

use std::fs;
use std::io::{BufRead, Cursor, Read as _, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::ImageReader;

use super::FileStamp;
use super::gltf::pictures::picture_in;
use freebound_core::geom::Picture;

/// Number of bytes that tell glTF from a picture.
const HEAD: u64 = 64;

/// Failure to read a picture.
#[derive(Debug, thiserror::Error)]
#[error("{}: the picture cannot be read: {reason}", path.display())]
pub struct PictureError {
    /// The file.
    pub path: PathBuf,
    /// Cause of the failure.
    pub reason: String,
}

/// Picture with its origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// Display name: the file name, or a word for the built-in picture.
    pub name: String,
    /// File of the picture; `None` for the picture of the built-in mesh.
    pub path: Option<PathBuf>,
    /// State of the file when it was read, for comparison with a later state.
    pub stamp: Option<FileStamp>,
    /// Pixels of the picture.
    pub pixels: Arc<Picture>,
}

impl PictureFile {
    /// Reads a PNG or JPEG file, whatever its extension, or the picture that most triangles of a glTF file show.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or is neither PNG nor JPEG, or a glTF file without such a picture.
    pub fn read(path: &Path) -> Result<Self, PictureError> {
        let pixels = if is_gltf(path) {
            let folder = path.parent().unwrap_or(Path::new(""));
            let bytes = fs::read(path).map_err(|error| error.to_string());
            bytes.and_then(|bytes| picture_in(bytes, folder)).and_then(|bytes| decode_picture(&bytes))
        } else {
            ImageReader::open(path).map_err(|error| error.to_string()).and_then(decode)
        };
        let pixels = pixels.map_err(|reason| PictureError { path: path.to_owned(), reason })?;
        let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
        Ok(Self { name, path: Some(path.to_owned()), stamp: FileStamp::read(path).ok(), pixels: Arc::new(pixels) })
    }

    /// File with this picture alone. `None` for the built-in picture, and for one within a glTF file.
    pub(crate) fn own_file(&self) -> Option<&Path> {
        self.path.as_deref().filter(|path| !is_gltf(path))
    }

    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.pixels.width) / f64::from(self.pixels.height)
    }
}

/// True for a glTF file, by its first bytes, as meshes are recognised.
fn is_gltf(path: &Path) -> bool {
    let mut head = Vec::new();
    // Only regular files are opened: reading a pipe could block for ever.
    let file = fs::File::open(path).ok().filter(|_| path.is_file());
    let read = file.and_then(|file| file.take(HEAD).read_to_end(&mut head).ok());
    read.is_some() && (head.starts_with(b"glTF") || head.trim_ascii_start().starts_with(b"{"))
}

/// Decodes the bytes of a PNG or JPEG file.
///
/// # Errors
///
/// Bytes that are neither PNG nor JPEG; the reason as text.
pub fn decode_picture(bytes: &[u8]) -> Result<Picture, String> {
    decode(ImageReader::new(Cursor::new(bytes)))
}

fn decode(reader: ImageReader<impl BufRead + Seek>) -> Result<Picture, String> {
    let reader = reader.with_guessed_format().map_err(|error| error.to_string())?;
    let decoded = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
    let (width, height) = decoded.dimensions();
    if width == 0 || height == 0 {
        return Err("it has no pixels".to_owned());
    }
    Ok(Picture { width, height, pixels: decoded.into_raw() })
}
