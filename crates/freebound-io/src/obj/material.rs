//! Pictures that a mesh's materials name.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::gltf::files_beside;
use crate::gltf::pictures::pictures_of;
use crate::mesh_file::{MeshFile, Statement};

/// Keywords of lines that name pictures, in addition to those that begin with `map_`.
const PICTURE_KEYWORDS: [&str; 5] = ["bump", "decal", "disp", "norm", "refl"];

/// Picture on most faces, see [`material_pictures`].
pub fn material_picture(mesh: &MeshFile, path: &Path) -> Option<PathBuf> {
    material_pictures(mesh, path).into_iter().next()
}

/// Files of the pictures that the materials of an OBJ or glTF file at `path` show, the picture on most faces first. The
/// files may be missing. A picture within a glTF file counts as that file.
///
/// A missing or broken material library does not affect the others.
pub fn material_pictures(mesh: &MeshFile, path: &Path) -> Vec<PathBuf> {
    let within = pictures_of(mesh, path);
    if !within.is_empty() {
        return within;
    }
    let looks = obj_materials(mesh, Some(path));
    let mut faces_with: BTreeMap<&Path, usize> = BTreeMap::new();
    for (material, faces) in faces_by_material(mesh) {
        if let Some(picture) = looks.get(&material).and_then(|look| look.picture.as_deref()) {
            *faces_with.entry(picture).or_default() += faces;
        }
    }
    let mut pictures: Vec<(&Path, usize)> = faces_with.into_iter().collect();
    // The picture with the first name wins a tie.
    pictures.sort_by_key(|&(_, faces)| Reverse(faces));
    pictures.into_iter().map(|(picture, _)| picture.to_owned()).collect()
}

/// Look of a material.
#[derive(Clone, Debug)]
pub(crate) struct Look {
    /// Red, green, blue and opacity, from 0 to 1.
    pub(crate) colour: [f32; 4],
    /// File of its picture, which may be missing.
    pub(crate) picture: Option<PathBuf>,
}

impl Default for Look {
    fn default() -> Self {
        Self { colour: [1.0; 4], picture: None }
    }
}

/// Materials in the libraries of an OBJ file, by name. The first of several with one name counts. Empty without a path.
pub(crate) fn obj_materials(mesh: &MeshFile, path: Option<&Path>) -> BTreeMap<String, Look> {
    let mut looks = BTreeMap::new();
    let Some(path) = path else { return looks };
    for library in libraries(mesh, path.parent().unwrap_or(Path::new(""))) {
        let mut name = None;
        let mut look = Look::default();
        for line in text_of(&library).lines() {
            let (keyword, argument) = line.trim().split_once(char::is_whitespace).unwrap_or_default();
            if keyword == "newmtl" {
                put(&mut looks, name.replace(argument.trim().to_owned()), std::mem::take(&mut look));
            } else {
                look.take(keyword, argument.trim(), library.parent().unwrap_or(Path::new("")));
            }
        }
        put(&mut looks, name, look);
    }
    looks
}

fn put(looks: &mut BTreeMap<String, Look>, name: Option<String>, look: Look) {
    if let Some(name) = name {
        looks.entry(name).or_insert(look);
    }
}

/// Text of a library; empty if it cannot be read. Only regular files are opened: reading a pipe could block for ever.
fn text_of(library: &Path) -> String {
    let bytes = if library.is_file() { fs::read(library).unwrap_or_default() } else { Vec::new() };
    String::from_utf8_lossy(&bytes).into_owned()
}

impl Look {
    /// Takes over a line of a library. Lines of other kinds, and those that are not understood, change nothing.
    fn take(&mut self, keyword: &str, argument: &str, folder: &Path) {
        let number = |word: &str| word.parse().ok().filter(|share| (0.0..=1.0).contains(share));
        let shares: Vec<f32> = argument.split_whitespace().map_while(number).collect();
        match (keyword, shares.as_slice()) {
            ("Kd", &[red, green, blue, ..]) => self.colour[..3].copy_from_slice(&[red, green, blue]),
            // One number is a shade of grey.
            ("Kd", &[grey, ..]) => self.colour[..3].fill(grey),
            ("d", &[opacity, ..]) => self.colour[3] = opacity,
            ("Tr", &[transparency, ..]) => self.colour[3] = 1.0 - transparency,
            ("map_Kd", _) => self.picture = Some(picture_of(argument, folder)),
            _ => {}
        }
    }
}

/// Existing files that a mesh file at `path` refers to: for OBJ, its material libraries and the pictures that they
/// name; for glTF, its buffers and pictures.
pub fn material_files(mesh: &MeshFile, path: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for library in libraries(mesh, path.parent().unwrap_or(Path::new(""))) {
        let folder = library.parent().unwrap_or(Path::new(""));
        let pictures = text_of(&library)
            .lines()
            .filter_map(picture_argument)
            .map(|argument| picture_of(argument, folder))
            .collect::<Vec<_>>();
        found.extend(pictures);
        found.push(library);
    }
    found.extend(files_beside(mesh));
    found.retain(|file| file.is_file());
    found
}

/// Argument of a line of a material library that names a picture; `None` for other lines.
pub(super) fn picture_argument(line: &str) -> Option<&str> {
    let (keyword, argument) = line.trim().split_once(char::is_whitespace)?;
    let keyword = keyword.to_ascii_lowercase();
    let is_picture = keyword.starts_with("map_") || PICTURE_KEYWORDS.contains(&keyword.as_str());
    is_picture.then(|| argument.trim())
}

/// Material library that a mesh names; the file may be missing.
#[derive(Debug)]
pub(super) struct Library {
    pub(super) name: String,
    pub(super) path: PathBuf,
}

/// Paths of all material libraries of a mesh.
fn libraries(mesh: &MeshFile, folder: &Path) -> Vec<PathBuf> {
    let statements = mesh.statements.iter().filter(|statement| statement.keyword() == b"mtllib");
    statements.flat_map(|statement| libraries_of(statement, folder)).map(|library| library.path).collect()
}

/// Material libraries of a line. A line may name several libraries, but a name may also contain blanks.
pub(super) fn libraries_of(statement: &Statement, folder: &Path) -> Vec<Library> {
    let library = |name: &str| Library { name: name.to_owned(), path: place_of(name, folder) };
    let argument = statement.argument();
    // A comment may follow, but a name may also contain `#`.
    let names = if library(&argument).path.is_file() { &argument } else { before_comment(&argument) };
    let whole = library(names);
    if whole.path.is_file() { vec![whole] } else { names.split_whitespace().map(library).collect() }
}

fn before_comment(argument: &str) -> &str {
    argument.split_once(" #").map_or(argument, |(names, _)| names.trim_end())
}

/// Number of faces of each material. A material may be listed more than once.
fn faces_by_material(mesh: &MeshFile) -> Vec<(String, usize)> {
    let uses: Vec<_> = mesh.statements.iter().filter(|statement| statement.keyword() == b"usemtl").collect();
    let end = mesh.polygons.face_count();
    let ends = uses.iter().skip(1).map(|next| next.before_face as usize).chain([end]);
    let counted = uses.iter().zip(ends).map(|(statement, end)| {
        let faces = end.saturating_sub(statement.before_face as usize);
        (statement.argument().into_owned(), faces)
    });
    counted.collect()
}

/// Picture that a line of a library names.
#[derive(Debug)]
pub(super) struct NamedPicture {
    /// Start of its name in the argument of the line, bytes.
    pub(super) begin: usize,
    pub(super) path: PathBuf,
}

/// Picture in an argument without surrounding blanks: its longest suffix that is the name of a file.
pub(super) fn picture_within(argument: &str, folder: &Path) -> Option<NamedPicture> {
    let after_blank = |(at, blank): (usize, &str)| at + blank.len();
    let begins = std::iter::once(0).chain(argument.match_indices(char::is_whitespace).map(after_blank));
    let mut found = begins.map(|begin| NamedPicture { begin, path: place_of(&argument[begin..], folder) });
    found.find(|named| named.path.is_file())
}

/// File of a `map_Kd` line. Options such as `-s 1 1 1` may precede its name, and the name may contain blanks. So the
/// longest suffix of the line that is the name of a file counts.
fn picture_of(texture: &str, folder: &Path) -> PathBuf {
    let texture = texture.trim();
    let nowhere = || {
        // No such file: use the last word of a line with options, or else the whole line, for the message.
        let name = if texture.starts_with('-') { texture.rsplit(char::is_whitespace).next() } else { None };
        place_of(name.unwrap_or(texture), folder)
    };
    picture_within(texture, folder).map_or_else(nowhere, |found| found.path)
}

/// Path of a file that another file in this folder names. Backslashes separate folders, unless a file has exactly
/// this name. An absolute path of another machine is replaced by the file name in this folder.
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
