//! Formats that are not read, told by a file's name or by its beginning, so that a message can name them.

use super::ReadError;
use super::line::words;

/// The format of a file that is not read, by its extension in lower case.
pub(super) fn format_of_extension(extension: &str) -> Option<&'static str> {
    Some(match extension {
        "3ds" | "max" => "3ds Max",
        "3mf" => "3MF",
        "abc" => "Alembic",
        "blend" => "Blender",
        "dae" => "COLLADA",
        "dxf" => "DXF",
        "fbx" => "FBX",
        "gltf" | "glb" => "glTF",
        "iges" | "igs" => "IGES",
        "ma" | "mb" => "Maya",
        "msh" => "Gmsh",
        "off" => "OFF",
        "ply" => "PLY",
        "stl" => "STL",
        "step" | "stp" => "STEP",
        "usd" | "usda" | "usdc" | "usdz" => "USD",
        "vtk" | "vtp" | "vtu" => "VTK",
        "wrl" | "x3d" => "VRML",
        _ => return None,
    })
}

/// What the first word of a text says about its format.
pub(super) fn format_of_word(word: &[u8]) -> Option<&'static str> {
    Some(match word {
        b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF" | b"4OFF" | b"nOFF" => "OFF",
        b"ply" => "PLY",
        b"solid" => "STL",
        b";" => "FBX",
        b"<?xml" => "XML",
        b"$MeshFormat" => "Gmsh",
        b"{" => "glTF",
        _ => return None,
    })
}

/// What a file with a zero byte is, going by its beginning where this is all that was read: the zero byte stands behind
/// `read_before` bytes.
pub(super) fn not_text(head: &[u8], read_before: usize) -> ReadError {
    const MARKS: [(&[u8], &str); 6] = [
        (b"glTF", "glTF"),
        (b"Kaydara FBX Binary", "FBX"),
        (b"BLENDER", "Blender"),
        (b"PXR-USDC", "USD"),
        (b"\xFF\xFE", "UTF-16 text"),
        (b"\xFE\xFF", "UTF-16 text"),
    ];
    let mark = MARKS.iter().find(|(mark, _)| head.starts_with(mark)).map(|&(_, format)| format);
    let first_line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let of_word = || words(first_line).next().and_then(format_of_word);
    let format = if read_before > 0 { None } else { mark.or_else(of_word) };
    format.map_or(ReadError::NotText, ReadError::NotReadYet)
}
