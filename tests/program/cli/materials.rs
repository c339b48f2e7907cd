//! Picture named by an OBJ file's materials.

use std::fs;
use std::path::Path;

use freebound_io::{material_picture, read_mesh, read_stream};
use tempfile::TempDir;

use super::program::Program;
use super::report_schema::TENT;

/// Folder with these files; empty texts stand for arbitrary contents.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// Picture of an OBJ text in a folder, relative to the folder.
fn picture_in(folder: &Path, statements: &str) -> Option<String> {
    let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n{statements}");
    let mesh = read_stream(text.as_bytes()).unwrap();
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

/// Program folder with a mesh, its material library and its pictures in a subfolder.
fn with_materials() -> Program {
    let program = Program::new();
    fs::create_dir_all(program.path("in/looks")).unwrap();
    fs::create_dir(program.path("out")).unwrap();
    program.write("in/mesh.obj", &format!("mtllib looks/m.mtl gone.mtl\nusemtl skin\n{TENT}"));
    let library =
        "# looks\r\nnewmtl skin\r\nKd 1 1 1\r\nmap_Kd -s 1 1 1 the skin.png\r\nbump bump\r\nmap_d gone.png\r\n";
    program.write("in/looks/m.mtl", library);
    program.write("in/looks/the skin.png", "pixels of the skin");
    program.write("in/looks/bump", "pixels of the bumps");
    program
}

/// Contents of the picture that a written mesh shows; tobj must find its library too.
fn picture_shown(program: &Program, mesh: &str) -> String {
    let path = program.path(mesh);
    let (models, materials) = tobj::load_obj(&path, &tobj::LoadOptions::default()).expect("tobj reads it");
    let materials = materials.expect("tobj finds the libraries");
    assert_eq!(materials[models[0].mesh.material_id.expect("a material in use")].name, "skin");
    fs::read_to_string(material_picture(&read_mesh(&path).unwrap(), &path).expect("a picture")).expect("it is there")
}

fn listing(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_mesh_in_another_folder_names_its_library_from_there() {
    let program = with_materials();
    // A missing library keeps its name, on a separate line; tobj would stop at it.
    program.write("in/gone.mtl", "");
    program.run(&["flatten", "in/mesh.obj", "-o", "out/flat.obj"]).expect(0);
    let text = fs::read_to_string(program.path("out/flat.obj")).unwrap();
    assert!(text.starts_with("mtllib ../in/looks/m.mtl\nmtllib ../in/gone.mtl\nusemtl skin\n"), "{text}");
    assert_eq!(picture_shown(&program, "out/flat.obj"), "pixels of the skin");
    assert_eq!(listing(&program.path("out")), ["flat.obj"]);
}

#[test]
fn in_the_same_folder_and_where_nothing_is_found_the_line_stays() {
    let program = with_materials();
    let line = "mtllib looks/m.mtl gone.mtl\n";
    program.run(&["flatten", "in/mesh.obj", "-o", "in/flat.obj"]).expect(0);
    assert!(fs::read_to_string(program.path("in/flat.obj")).unwrap().contains(line));
    fs::remove_file(program.path("in/looks/m.mtl")).unwrap();
    program.run(&["flatten", "in/mesh.obj", "-o", "out/flat.obj"]).expect(0);
    assert!(fs::read_to_string(program.path("out/flat.obj")).unwrap().contains(line));
}

#[test]
fn copied_materials_need_the_old_folder_no_more() {
    let program = with_materials();
    program.write("in/gone.mtl", "");
    let arguments = ["flatten", "in/mesh.obj", "--copy-materials", "-o", "out/flat.obj"];
    program.run(&arguments).expect(0);
    let files = ["bump", "flat.obj", "gone.mtl", "m.mtl", "the_skin.png"];
    assert_eq!(listing(&program.path("out")), files);
    let library = fs::read_to_string(program.path("out/m.mtl")).unwrap();
    assert!(library.contains("map_Kd -s 1 1 1 the_skin.png\r\nbump bump\r\nmap_d gone.png\r\n"), "{library}");
    program.run(&arguments).expect(0);
    assert_eq!(listing(&program.path("out")), files, "a second run finds its own files");
    fs::remove_dir_all(program.path("in")).unwrap();
    assert_eq!(picture_shown(&program, "out/flat.obj"), "pixels of the skin");
}

#[test]
fn copied_materials_never_replace_files_of_others() {
    let program = with_materials();
    program.write("in/gone.mtl", "");
    let others = ["m.mtl", "the_skin.png", "bump"].map(|name| format!("out/{name}"));
    for name in &others {
        program.write(name, "another's");
    }
    program.run(&["flatten", "in/mesh.obj", "--copy-materials", "-o", "out/flat.obj"]).expect(0);
    for name in &others {
        assert_eq!(fs::read_to_string(program.path(name)).unwrap(), "another's", "{name}");
    }
    assert_eq!(picture_shown(&program, "out/flat.obj"), "pixels of the skin");
    let names =
        ["bump", "flat-bump", "flat-m.mtl", "flat-the_skin.png", "flat.obj", "gone.mtl", "m.mtl", "the_skin.png"];
    assert_eq!(listing(&program.path("out")), names);
}

#[test]
fn copying_materials_needs_a_place_and_does_not_go_with_a_picture() {
    let program = with_materials();
    for options in [
        &["--copy-materials"][..],
        &["--copy-materials", "-o", "-"],
        &["--copy-materials", "-o", "out/flat.obj", "--picture", "x.png"],
    ] {
        program.run(&[&["flatten", "in/mesh.obj"], options].concat()).expect(2);
    }
    assert_eq!(listing(&program.path("out")), Vec::<String>::new());
}

/// On Linux a process's memory is a file that nobody can read from its beginning.
#[cfg(target_os = "linux")]
#[test]
fn a_file_to_be_copied_that_cannot_be_read_is_unusable_input() {
    for file in ["in/looks/m.mtl", "in/looks/the skin.png"] {
        let program = with_materials();
        fs::remove_file(program.path(file)).unwrap();
        std::os::unix::fs::symlink("/proc/self/mem", program.path(file)).unwrap();
        let arguments = ["flatten", "in/mesh.obj", "--copy-materials", "-o", "out/flat.obj", "--report", "out/r.json"];
        let run = program.run(&arguments).expect(3);
        assert!(run.stderr.contains(&format!("{file}: ")), "{}", run.stderr);
        assert_eq!(listing(&program.path("out")), ["r.json"]);
        assert!(fs::read_to_string(program.path("out/r.json")).unwrap().contains("\"unreadable\""));
    }
}
