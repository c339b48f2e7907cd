//! Pictures in: PNG and JPEG.

use std::io::{BufRead, Cursor, Seek};
use std::path::{Path, PathBuf};

use image::ImageReader;

use crate::geom::Picture;

/// Why a file did not become a picture.
#[derive(Debug, thiserror::Error)]
#[error("cannot read the picture: {reason}: {}", path.display())]
pub struct PictureError {
    /// The file.
    pub path: PathBuf,
    /// What went wrong.
    pub reason: String,
}

/// Reads a PNG or JPEG file, whatever its name says.
///
/// # Errors
///
/// A file that cannot be read, or that is no such picture.
pub fn read_picture(path: &Path) -> Result<Picture, PictureError> {
    let failed = |reason: String| PictureError { path: path.to_owned(), reason };
    let reader = ImageReader::open(path).map_err(|error| failed(error.to_string()))?;
    decode(reader).map_err(failed)
}

/// Decodes the bytes of a PNG or JPEG file.
///
/// # Errors
///
/// Bytes that are no such picture; the reason in words.
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
