//! Formats of mesh files, recognised by a file's first bytes, or else by its extension.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::ReadError;
use super::stl::is_binary_stl;
use crate::obj::{Lines, split_mark, words};

/// Supported format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Gltf,
    Obj,
    Off,
    Ply,
    StlText,
    StlBinary,
}

impl Format {
    /// Format of a file with these first bytes and this extension.
    ///
    /// # Errors
    ///
    /// If the format is known but not supported, or unknown and not text.
    pub(super) fn of(head: &[u8], extension: Option<&str>) -> Result<Self, ReadError> {
        if let Some(format) = Self::of_beginning(head)? {
            return Ok(format);
        }
        match extension {
            Some("gltf" | "glb") => Ok(Self::Gltf),
            Some("off" | "coff" | "noff") => Ok(Self::Off),
            Some("ply") => Ok(Self::Ply),
            Some("stl") if head.contains(&0) => Ok(Self::StlBinary),
            Some("stl") => Ok(Self::StlText),
            Some(other) => match format_not_read(other) {
                Some(name) => Err(ReadError::NotReadYet(name)),
                None => Self::obj(head),
            },
            None => Self::obj(head),
        }
    }

    /// Format of a file without any other sign: OBJ, if it is text.
    fn obj(head: &[u8]) -> Result<Self, ReadError> {
        if head.contains(&0) { Err(ReadError::NotText) } else { Ok(Self::Obj) }
    }

    fn of_beginning(head: &[u8]) -> Result<Option<Self>, ReadError> {
        if let Some((_, name)) = MARKS.iter().find(|(mark, _)| head.starts_with(mark)) {
            return Err(ReadError::NotReadYet(name));
        }
        if begins_gltf(head) {
            return Ok(Some(Self::Gltf));
        }
        let text = split_mark(head).1;
        let word = Lines::of(text).find_map(|line| words(&line.whole[..line.length]).next()).unwrap_or_default();
        Ok(match word {
            b"ply" => Some(Self::Ply),
            b"solid" if !head.contains(&0) => Some(Self::StlText),
            _ if head.contains(&0) && is_binary_stl(head) => Some(Self::StlBinary),
            _ if is_off(word) => Some(Self::Off),
            _ => match word_of_format(word) {
                Some(name) => return Err(ReadError::NotReadYet(name)),
                None => None,
            },
        })
    }
}

/// Number of bytes that tell glTF from a picture.
const HEAD_OF_GLTF: u64 = 64;

/// True for a glTF file, by its first bytes. False if it cannot be read.
pub(crate) fn is_gltf(path: &Path) -> bool {
    let mut head = Vec::new();
    // Only regular files are opened: reading a pipe could block for ever.
    let file = File::open(path).ok().filter(|_| path.is_file());
    let read = file.and_then(|file| file.take(HEAD_OF_GLTF).read_to_end(&mut head).ok());
    read.is_some() && begins_gltf(&head)
}

fn begins_gltf(head: &[u8]) -> bool {
    head.starts_with(b"glTF") || split_mark(head).1.trim_ascii_start().starts_with(b"{")
}

/// First bytes of unsupported files.
const MARKS: [(&[u8], &str); 5] = [
    (b"Kaydara FBX Binary", "FBX"),
    (b"BLENDER", "Blender"),
    (b"PXR-USDC", "USD"),
    (b"\xFF\xFE", "UTF-16 text"),
    (b"\xFE\xFF", "UTF-16 text"),
];

/// True if a word begins an OFF file: `OFF`, with prefix letters for further vertex data. Some programs write the
/// first count directly after it.
fn is_off(word: &[u8]) -> bool {
    let Some(at) = word.windows(3).position(|three| three == b"OFF") else { return false };
    word[..at].iter().all(|byte| b"STCNn4".contains(byte)) && word[at + 3..].iter().all(u8::is_ascii_digit)
}

/// Name of an unsupported format, by its extension in lower case.
fn format_not_read(extension: &str) -> Option<&'static str> {
    Some(match extension {
        "3ds" | "max" => "3ds Max",
        "3mf" => "3MF",
        "abc" => "Alembic",
        "blend" => "Blender",
        "dae" => "COLLADA",
        "dxf" => "DXF",
        "fbx" => "FBX",
        "iges" | "igs" => "IGES",
        "ma" | "mb" => "Maya",
        "msh" => "Gmsh",
        "step" | "stp" => "STEP",
        "usd" | "usda" | "usdc" | "usdz" => "USD",
        "vtk" | "vtp" | "vtu" => "VTK",
        "wrl" | "x3d" => "VRML",
        _ => return None,
    })
}

/// Name of an unsupported format, by the first word of a text.
fn word_of_format(word: &[u8]) -> Option<&'static str> {
    Some(match word {
        b";" => "FBX",
        b"<?xml" => "XML",
        b"$MeshFormat" => "Gmsh",
        _ => return None,
    })
}
