//! Pictures in: PNG and JPEG.

use std::io::{BufRead, Cursor, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::ImageReader;

use super::FileStamp;
use super::gltf::pictures::picture_within;
use super::mesh_file::{MeshFile, is_gltf, read_mesh};
use freebound_core::geom::Picture;

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
            let mesh = read_mesh(path).map_err(|error| error.to_string());
            mesh.and_then(|mesh| decode_within(&mesh, path))
        } else {
            ImageReader::open(path).map_err(|error| error.to_string()).and_then(decode)
        };
        Self::of(path, pixels)
    }

    /// Reads a picture like [`read`](Self::read), with the mesh that was read from `mesh_path` at hand: if the picture
    /// is within the same file, that file is not read again.
    ///
    /// # Errors
    ///
    /// The errors of [`read`](Self::read).
    pub fn read_for(mesh: &MeshFile, mesh_path: &Path, path: &Path) -> Result<Self, PictureError> {
        if mesh_path == path { Self::of(path, decode_within(mesh, path)) } else { Self::read(path) }
    }

    fn of(path: &Path, pixels: Result<Picture, String>) -> Result<Self, PictureError> {
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

/// Picture that most triangles of a mesh from a glTF file show.
fn decode_within(mesh: &MeshFile, path: &Path) -> Result<Picture, String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    picture_within(mesh, folder).and_then(|bytes| decode_picture(&bytes))
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
