//! The picture that a mesh's materials name.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::ObjMesh;

/// Keywords of lines that name pictures, beside those that begin with `map_`.
const PICTURE_KEYWORDS: [&str; 5] = ["bump", "decal", "disp", "norm", "refl"];

/// The picture on most faces, as the materials of an OBJ file at `path` say. `None` where no material that is in use
/// names a picture. The picture itself need not be there.
///
/// Where one material library is missing or broken, the others still count.
pub fn material_picture(mesh: &ObjMesh, path: &Path) -> Option<PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut pictures: BTreeMap<String, PathBuf> = BTreeMap::new();
    for library in libraries(mesh, folder) {
        let Ok((materials, _)) = tobj::load_mtl(&library) else { continue };
        let folder = library.parent().unwrap_or(Path::new(""));
        for material in materials {
            if let Some(texture) = material.diffuse_texture {
                pictures.entry(material.name).or_insert_with(|| picture_of(&texture, folder));
            }
        }
    }
    let mut faces_with: BTreeMap<&Path, usize> = BTreeMap::new();
    for (material, faces) in faces_by_material(mesh) {
        if let Some(picture) = pictures.get(&material) {
            *faces_with.entry(picture).or_default() += faces;
        }
    }
    // The first of equals, going by their names.
    faces_with.into_iter().rev().max_by_key(|&(_, faces)| faces).map(|(picture, _)| picture.to_owned())
}

/// The material libraries of an OBJ file at `path`, and the pictures that they name, as far as they are there.
pub fn material_files(mesh: &ObjMesh, path: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for library in libraries(mesh, path.parent().unwrap_or(Path::new(""))) {
        let folder = library.parent().unwrap_or(Path::new(""));
        let text = fs::read(&library).unwrap_or_default();
        let pictures = String::from_utf8_lossy(&text)
            .lines()
            .filter_map(picture_argument)
            .map(|argument| picture_of(argument, folder))
            .collect::<Vec<_>>();
        found.extend(pictures);
        found.push(library);
    }
    found.retain(|file| file.is_file());
    found
}

/// What follows the keyword on a line of a material library that names a picture.
fn picture_argument(line: &str) -> Option<&str> {
    let (keyword, argument) = line.trim().split_once(char::is_whitespace)?;
    let keyword = keyword.to_ascii_lowercase();
    let is_picture = keyword.starts_with("map_") || PICTURE_KEYWORDS.contains(&keyword.as_str());
    is_picture.then(|| argument.trim())
}

/// The material libraries. A line may name several, but a name may also hold blanks.
fn libraries(mesh: &ObjMesh, folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for statement in mesh.statements.iter().filter(|statement| statement.keyword() == b"mtllib") {
        let names = statement.argument();
        let whole = place_of(&names, folder);
        if whole.is_file() {
            found.push(whole);
        } else {
            found.extend(names.split_whitespace().map(|name| place_of(name, folder)));
        }
    }
    found
}

/// How many faces each material is on. A material may come more than once.
fn faces_by_material(mesh: &ObjMesh) -> Vec<(String, usize)> {
    let uses: Vec<_> = mesh.statements.iter().filter(|statement| statement.keyword() == b"usemtl").collect();
    let end = mesh.polygons.face_count();
    let ends = uses.iter().skip(1).map(|next| next.before_face as usize).chain([end]);
    let counted = uses.iter().zip(ends).map(|(statement, end)| {
        let faces = end.saturating_sub(statement.before_face as usize);
        (statement.argument().into_owned(), faces)
    });
    counted.collect()
}

/// The file of a `map_Kd` line. Options such as `-s 1 1 1` may stand before its name, which may hold blanks: the
/// longest end of the line that is the name of a file.
fn picture_of(texture: &str, folder: &Path) -> PathBuf {
    let texture = texture.trim();
    let begins = std::iter::once(0).chain(texture.match_indices(char::is_whitespace).map(|(at, _)| at + 1));
    let places = begins.map(|begin| place_of(texture[begin..].trim_start(), folder));
    places.into_iter().find(|place| place.is_file()).unwrap_or_else(|| {
        // Nothing is there: for a message, the last word of a line with options, the whole line of one without.
        let name = if texture.starts_with('-') { texture.rsplit(char::is_whitespace).next() } else { None };
        place_of(name.unwrap_or(texture), folder)
    })
}

/// A file named in another file of this folder. Backslashes divide folders where no file's name holds them, and a
/// whole path of another machine is given up for a file of that name in this folder.
fn place_of(name: &str, folder: &Path) -> PathBuf {
    let name = name.trim().trim_matches('"');
    let verbatim = folder.join(name);
    if verbatim.is_file() {
        return verbatim;
    }
    let slashed = name.replace('\\', "/");
    let divided = folder.join(&slashed);
    let is_elsewhere = slashed.starts_with('/') || slashed.as_bytes().get(1) == Some(&b':');
    if is_elsewhere && !divided.is_file() {
        return folder.join(slashed.rsplit('/').next().unwrap_or(&slashed));
    }
    divided
}
