//! The picture that an OBJ file's materials name.

use std::fs;
use std::path::Path;

use freebound::io::{material_picture, read_obj};
use tempfile::TempDir;

/// A folder with these files, whose contents do not matter where they are empty.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// The picture of an OBJ text in a folder, relative to it.
fn picture_in(folder: &Path, statements: &str) -> Option<String> {
    let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n{statements}");
    let mesh = read_obj(text.as_bytes()).unwrap();
    let picture = material_picture(&mesh, &folder.join("mesh.obj"))?;
    Some(picture.strip_prefix(folder).unwrap().to_str().unwrap().to_owned())
}

const ONE_FACE: &str = "mtllib m.mtl\nusemtl skin\nf 1 2 3\n";

#[test]
fn a_picture_is_found_beside_the_library_that_names_it() {
    let folder = folder(&[("looks/m.mtl", "newmtl skin\nmap_Kd a picture.png\n"), ("looks/a picture.png", "")]);
    let text = ONE_FACE.replace("m.mtl", "looks/m.mtl");
    assert_eq!(picture_in(folder.path(), &text).unwrap(), "looks/a picture.png");
}

#[test]
fn the_material_on_most_faces_wins() {
    let library = "newmtl bone\nmap_Kd bone.png\nnewmtl skin\nmap_Kd skin.png\nnewmtl bare\n";
    let folder = folder(&[("m.mtl", library)]);
    let text =
        "mtllib m.mtl\nusemtl bone\nf 1 2 3\nusemtl skin\nf 2 3 4\nf 1 2 4\nusemtl bare\nf 1 2 3\nf 1 3 4\nf 1 2 4\n";
    assert_eq!(picture_in(folder.path(), text).unwrap(), "skin.png");
    let text = "mtllib m.mtl\nusemtl skin\nf 1 2 3\nusemtl bone\nf 2 3 4\nusemtl skin\nusemtl bone\nf 1 2 4\n";
    assert_eq!(picture_in(folder.path(), text).unwrap(), "bone.png");
}

#[test]
fn paths_of_other_systems_are_understood() {
    let cases = [
        ("textures\\skin.png", "textures/skin.png"),
        ("C:\\work\\skin.png", "skin.png"),
        ("/home/somebody/skin.png", "skin.png"),
        ("-s 1 1 1 -clamp on textures/skin.png", "textures/skin.png"),
    ];
    for (name, found) in cases {
        let library = format!("newmtl skin\r\nmap_Kd {name}\r\n");
        let folder = folder(&[("m.mtl", &library), ("textures/skin.png", ""), ("skin.png", "")]);
        assert_eq!(picture_in(folder.path(), ONE_FACE).unwrap(), found, "{name}");
    }
}

#[test]
fn a_picture_that_is_missing_is_still_named() {
    let folder = folder(&[("m.mtl", "newmtl skin\nmap_Kd gone.png\n")]);
    assert_eq!(picture_in(folder.path(), ONE_FACE).unwrap(), "gone.png");
}

#[test]
fn without_a_material_in_use_there_is_no_picture() {
    let folder = folder(&[("m.mtl", "newmtl skin\nmap_Kd skin.png\n"), ("skin.png", "")]);
    for text in ["f 1 2 3\n", "mtllib m.mtl\nf 1 2 3\n", "mtllib gone.mtl\nusemtl skin\nf 1 2 3\n"] {
        assert_eq!(picture_in(folder.path(), text), None, "{text}");
    }
    let text = "mtllib m.mtl\nusemtl other\nf 1 2 3\n";
    assert_eq!(picture_in(folder.path(), text), None, "a material that no library has");
}
