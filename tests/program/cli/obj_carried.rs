//! OBJ files survive a round trip: only `vt` lines and the middle indices of faces differ.

use std::collections::BTreeMap;

use freebound_core::mesh::{DiskMesh, NewVertex, Refinement, VertexId};
use freebound_io::{MeshFile, NO_TEXTURE, Texture, read_mesh, read_stream, write_obj};
use glam::{DVec2, DVec3};

use super::program::Program;
use freebound_testkit::files::read;
use freebound_testkit::{assert_message, corpus_test, manifest};
use serde_json::json;

pub(crate) fn written(mesh: &MeshFile, texture: &Texture) -> String {
    let mut bytes = Vec::new();
    write_obj(&mut bytes, mesh, texture).expect("memory takes all");
    String::from_utf8(bytes).expect("the texts of these tests are UTF-8")
}

/// Distinct coordinates for all corners, in an order different from that of the corners.
pub(crate) fn by_corner(mesh: &MeshFile) -> Texture {
    let count = u32::try_from(mesh.polygons.corners.len()).expect("few");
    let coordinates = (0..count).map(|k| DVec2::new(f64::from(k) / 7.0, -f64::from(k).powi(2))).collect();
    Texture { coordinates, corners: (0..count).rev().collect() }
}

/// Unchanged part of a text: all lines except texture coordinates, with the middle indices of faces removed.
/// Independent of the writer: lines are parsed byte by byte.
pub(crate) fn unchanged(text: &str) -> String {
    let mut rest = text;
    let mut kept = String::new();
    while !rest.is_empty() {
        let mut length = 0;
        loop {
            let end = rest[length..].find('\n').map_or(rest.len(), |at| length + at + 1);
            let line = rest[length..end].trim_end_matches(['\r', '\n']);
            length = end;
            if !line.ends_with('\\') || line.contains('#') || length == rest.len() {
                break;
            }
        }
        let line;
        (line, rest) = rest.split_at(length);
        match line.trim_start_matches('\u{feff}').split_whitespace().next() {
            Some("vt") => {}
            Some("f") => kept += &without_middle(line),
            _ => kept += line,
        }
    }
    kept
}

/// Line of a face without the indices of texture coordinates: `1/2/3` and `1//3` become `1//3`, `1/2` and `1` become
/// `1`.
fn without_middle(line: &str) -> String {
    let (corners, comment) = line.split_at(line.find('#').unwrap_or(line.len()));
    let mut kept = String::new();
    let mut slashes = 0;
    let mut word = String::new();
    for c in corners.chars().chain(['\n']) {
        if c.is_whitespace() || c == '\\' {
            kept += word.trim_end_matches('/');
            word.clear();
            slashes = 0;
            kept.push(c);
        } else if c == '/' {
            slashes += 1;
            word += if slashes == 1 { "//" } else { "" };
        } else if slashes != 1 {
            word.push(c);
        }
    }
    kept.pop();
    kept + comment
}

/// Writes a mesh with these coordinates; asserts that nothing else changed, and that it reads back correctly.
fn assert_carried(text: &str, texture: &Texture) -> String {
    let mesh = read(text);
    let out = written(&mesh, texture);
    assert_eq!(unchanged(&out), unchanged(text), "{out}");
    let again = read_stream(out.as_bytes()).unwrap_or_else(|error| panic!("{error}: {out}"));
    assert_eq!(again.polygons, mesh.polygons, "{out}");
    assert_eq!(again.statements, mesh.statements);
    let expected = (!texture.coordinates.is_empty()).then_some(texture);
    assert_eq!(again.texture.as_ref(), expected, "{out}");
    out
}

/// Example of everything that a file may contain.
const RICH: &str = "\u{feff}# Made by hand, 100 % \u{e9}\r\n\
    mtllib  a b.mtl\r\n\
    o first\r\n\
    v 0 0 0 0.5 0.25 1\r\nv 1.000 0 -0 1 0 0\r\nv\t1 1e0 0 0 1 0   \r\nv 0 1. +0 0 0 1\r\n\
    vt 0.5 0.5\r\n# between\r\nvt 0 0 0\r\n\
    vn 0 0 1\r\nvn 0 0.6 0.8\r\n\r\n\
    g left right\r\ns 1\r\nusemtl skin\r\n\
    f 1/1/1 2/2/1 3//2   4/1/2 # a quad\r\n\
    l 1 2 3\r\np -1\r\nvp 0.5\r\n\
    o second\r\ncstype bezier\r\n\
    v 2 0 0\r\nv 2 1 0\r\nvt 9 9\r\n\
    f -2 -1 -4/-1\r\n  f 2//1 5//2 \\\r\n  3//1\r\n\
    s off\r\n#end\\";

#[test]
fn everything_but_texture_coordinates_comes_back_byte_for_byte() {
    let mesh = read(RICH);
    let out = assert_carried(RICH, &by_corner(&mesh));
    assert!(out.contains("f 1/10/1 2/9/1 3/8/2   4/7/2 # a quad\r\n"), "{out}");
    assert!(out.contains("f -2/-5 -1/-6 -4/-7\r\n  f 2/3/1 5/2/2 \\\r\n  3/1/1\r\n"), "{out}");
    let first = out.find("vt ").expect("texture coordinates");
    assert!(out[..first].ends_with("+0 0 0 1\r\n"), "they stand where the first stood");
    assert_eq!(out.matches("vt ").count(), 10);
    assert_eq!(out.matches("\r\n").count(), out.matches('\n').count(), "lines end as in the file");
}

#[test]
fn texture_coordinates_stand_before_the_first_face_where_there_were_none() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nf 1 2 3\nv 1 1 0\nf 2 4 3";
    let out = assert_carried(text, &by_corner(&read(text)));
    assert!(out.contains("g a\nvt 0.0 -0.0\n"), "{out}");
    assert!(out.ends_with("vt 0.7142857142857143 -25.0\nf 1/6 2/5 3/4\nv 1 1 0\nf 2/3 4/2 3/1"), "{out}");
    let late = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nvt 1 1\nf 3/1 2/1 1/1\n";
    let out = assert_carried(late, &by_corner(&read(late)));
    assert!(out.find("vt").expect("some") < out.find("f 1").expect("a face"), "{out}");
}

#[test]
fn a_face_with_a_corner_that_has_none_is_written_without_texture_coordinates() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nf 1/1/1 2//1 3//1\nf 2/1 4 3\nvt 0 0\n";
    let mut texture = by_corner(&read(text));
    texture.corners = vec![NO_TEXTURE, 1, 2, 3, 4, 5];
    let out = written(&read(text), &texture);
    assert!(out.contains("f 1//1 2//1 3//1\nf 2/4 4/5 3/6\n"), "{out}");
    assert_eq!(unchanged(&out), unchanged(text));
    assert!(assert_carried(text, &Texture::default()).ends_with("f 1//1 2//1 3//1\nf 2 4 3\n"));
}

#[test]
fn lines_name_the_texture_coordinates_of_corners_at_their_vertices() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nvt 0 0\nvt 1 1\nf 1 2 3\nl 1/1 2/2 4/1\nl -4/-1 -3/-2\nl 1 2\n";
    let texture = Texture { coordinates: vec![DVec2::ZERO; 3], corners: vec![2, 1, 0] };
    let out = written(&read(text), &texture);
    assert!(out.ends_with("f 1/3 2/2 3/1\nl 1/3 2/2 4\nl -4/-1 -3/-2\nl 1 2\n"), "{out}");
}

#[test]
fn faces_that_are_turned_keep_their_line_and_their_normals() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n\
        f  1//1 2//2\t3//3 4//1 # one\nf 1 \\\n 2 1 3\nf -1/ -2/ -3/\n";
    let turned = read(text).turned();
    let out = written(&turned, &by_corner(&turned));
    assert!(
        out.ends_with("f  1/11/1 4/10/1\t3/9/3 2/8/2 # one\nf 1/7 \\\n 3/6 1/5 2/4\nf -1/-9 -3/-10 -2/-11\n"),
        "{out}"
    );
    assert_eq!(read(&out).polygons, turned.polygons);
    assert_eq!(read(&out).texture, Some(by_corner(&turned)));
}

/// Disk of two quads and a triangle, in a file with normals, colours, and relative indices.
const TWO_QUADS: &str = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n\
    vn 0 0 1\nvn 0 0.6 0.8\nvn 0.6 0 0.8\nvt 1 1\no a\nv 2 0 0 1 1 1\nv 2 1 0 0 0 0\nv 1.5 2 0\n\
    usemtl skin\n  f 1/1/1 2/1/2 3/1/3 4/1/1 # left\r\nl -1 -2\n# here\n\
    f -6/-1/2 -3/-1/1 -2/-1/1 -5/-1/3\nf 3//1 6//1 7//1\np 1\n";

/// Mesh with a new vertex, number 7, on the edge between the quads, a quarter of the way up.
fn refined(file: &MeshFile) -> MeshFile {
    let disk = DiskMesh::try_from(file.polygons.triangulate()).expect("a disk");
    let [a, b] = [1, 2].map(VertexId::new);
    let new = VertexId::from_index(disk.vertex_count());
    let mut parts = BTreeMap::new();
    for face in disk.faces() {
        let corners = disk.face(face);
        if let Some(k) = (0..3).find(|&k| [a, b].contains(&corners[k]) && [a, b].contains(&corners[(k + 1) % 3])) {
            let [from, to, apex] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
            parts.insert(face, vec![[from, new, apex], [new, to, apex]]);
        }
    }
    assert_eq!(parts.len(), 2, "an edge between two faces");
    let refinement = Refinement::new(&disk, vec![NewVertex { edge: [a, b], at: 0.25 }], &parts).expect("a disk");
    freebound_io::Refined::new(file, None, &refinement).mesh
}

/// Corners of a file as read by tobj: position and normal.
fn corners_by_tobj(text: &str) -> Vec<[[f32; 3]; 2]> {
    let no_materials = |_: &std::path::Path| tobj::MTLLoadResult::Err(tobj::LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut text.as_bytes(), &tobj::LoadOptions::default(), no_materials).expect("it is right");
    let of_model = |model: &tobj::Model| -> Vec<[[f32; 3]; 2]> {
        let mesh = &model.mesh;
        let three = |list: &[f32], at: u32| [0, 1, 2].map(|k| list[3 * at as usize + k]);
        mesh.indices
            .iter()
            .zip(&mesh.normal_indices)
            .map(|(&v, &n)| [three(&mesh.positions, v), three(&mesh.normals, n)])
            .collect()
    };
    models.iter().flat_map(of_model).collect()
}

#[test]
fn only_faces_with_split_edges_become_triangles_in_their_place() {
    let file = read(TWO_QUADS);
    let refined = refined(&file);
    let out = written(&refined, &by_corner(&refined));
    // Unsplit faces and everything else are preserved.
    for kept in ["usemtl skin\n", "# here\n", "p 1\n", "o a\nv 2 0 0 1 1 1\nv 2 1 0 0 0 0\nv 1.5 2 0\n"] {
        assert!(out.contains(kept), "{kept}{out}");
    }
    // A quarter of the way from (0, 1, 0) to (0, 0, 1) in colour; relative indices reach one vertex further back.
    assert!(out.contains("v 1.5 2 0\nv 1.0 0.25 0.0 0.0 0.75 0.25\n"), "{out}");
    assert!(out.contains("\nl -2 -3\n"), "{out}");
    let normal = DVec3::new(0.0, 0.6, 0.8).lerp(DVec3::new(0.6, 0.0, 0.8), 0.25).normalize_or_zero();
    assert!(out.contains(&format!("vn 0.6 0 0.8\nvn {:?} {:?} {:?}\n", normal.x, normal.y, normal.z)), "{out}");
    assert_eq!(out.matches("vn ").count(), 4, "both faces have the same normals there");
    let again = read(&out);
    assert_eq!(again.polygons, refined.polygons);
    assert_eq!(again.texture, Some(by_corner(&refined)));
    let faces: Vec<&str> = out.lines().filter(|line| line.trim_start().starts_with('f')).collect();
    assert_eq!(faces.len(), 7, "three triangles for each quad");
    assert!(faces[..3].iter().all(|face| face.starts_with("  f ")) && faces[2].ends_with(" # left"), "{faces:?}");
    assert!(faces[3..6].iter().all(|face| face.starts_with("f -") && !face.contains(" 8")), "{faces:?}");
    assert!(faces[6].starts_with("f 3/") && faces[6].matches("/1").count() >= 3, "{faces:?}");
}

#[test]
fn another_reader_finds_new_vertices_with_the_normals_between() {
    // tobj takes comments after a face for corners, and lines for faces. It requires colours at all vertices or at
    // none.
    let text = TWO_QUADS.replace(" # left", "").replace("l -1 -2\n", "").replace("v 1.5 2 0\n", "v 1.5 2 0 0 0 0\n");
    let refined = refined(&read(&text));
    let found = corners_by_tobj(&written(&refined, &by_corner(&refined)));
    let normal = DVec3::new(0.0, 0.6, 0.8).lerp(DVec3::new(0.6, 0.0, 0.8), 0.25).normalize_or_zero().as_vec3();
    let new: Vec<_> = found.iter().filter(|[position, _]| *position == [1.0, 0.25, 0.0]).collect();
    assert_eq!(new.len(), 4);
    for [_, n] in new {
        assert!((glam::Vec3::from(*n) - normal).length() < 1e-6, "{n:?} {normal}");
    }
    for ([position, _], corner) in found.iter().zip(&refined.polygons.corners) {
        assert_eq!(*position, refined.polygons.positions[corner.index()].as_vec3().to_array());
    }
}

#[test]
fn faces_that_a_mesh_has_no_more_are_left_out_with_their_line_only() {
    let mut mesh = read(TWO_QUADS);
    mesh = refined(&mesh);
    let count = mesh.polygons.face_count();
    let starts =
        mesh.polygons.starts.get_or_insert_with(|| (0..=count).map(|face| 3 * u32::try_from(face).unwrap()).collect());
    starts.truncate(count);
    mesh.polygons.corners.truncate(*starts.last().unwrap() as usize);
    let out = written(&mesh, &by_corner(&mesh));
    assert!(!out.contains("f 3/") && out.ends_with("\np 1\n"), "{out}");
    assert_eq!(read(&out).polygons.corners, mesh.polygons.corners);
}

corpus_test! {
    fn the_corpus_comes_back_as_it_went() {
        let mut compared = 0;
        for entry in manifest() {
            let (Ok(mesh), Ok(text)) = (read_mesh(&entry.path), std::fs::read_to_string(&entry.path)) else { continue };
            let out = written(&mesh, &by_corner(&mesh));
            assert!(unchanged(&out) == unchanged(&text), "{}", entry.file);
            compared += 1;
        }
        assert!(compared > 30, "{compared}");
    }
}

#[test]
fn the_program_gives_the_file_back_and_changes_only_the_lines_of_materials_that_move() {
    let program = Program::new();
    program.write("skin.mtl", "newmtl skin\n");
    let text = RICH
        .replace("a b.mtl", "skin.mtl # and more")
        .replace("f -2 -1 -4/-1\r\n  f 2//1 5//2 \\\r\n  3//1", "f 2 -2 -1 3");
    program.write("in.obj", &text);
    program.run(&["flatten", "in.obj", "-o", "out.obj"]).expect(0);
    let out = |name: &str| std::fs::read_to_string(program.path(name)).expect("it was written");
    assert_eq!(unchanged(&out("out.obj")), unchanged(&text));
    std::fs::create_dir(program.path("deep")).expect("a folder");
    program.run(&["flatten", "in.obj", "-o", "deep/out.obj"]).expect(0);
    let moved = text.replace("mtllib  skin.mtl # and more", "mtllib ../skin.mtl");
    assert_eq!(unchanged(&out("deep/out.obj")), unchanged(&moved));
}

#[test]
fn faces_of_two_corners_stay_in_the_file_and_are_named_with_texture_indices_of_nothing() {
    let program = Program::new();
    program.write("in.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2\nf 1/5 2/5 3/5\nf 1 3 4\nf 4/9 1/9\n");
    let run = program.run(&["flatten", "in.obj", "-o", "out.obj", "--report", "-"]).expect(0);
    let warnings = json!([
        {"kind": "faces-of-few-corners", "count": 2, "line": 5},
        {"kind": "missing-texture-coordinates", "count": 3, "line": 6},
    ]);
    assert_eq!(run.json()["mesh"]["warnings"], warnings);
    let printed = program.run(&["flatten", "in.obj"]).expect(0).stdout;
    assert_message("obj-carried-left-out", printed.lines().nth(1).expect("a line about the file"));
    // The lines stay, and those with indices of coordinates get the new ones.
    let written = std::fs::read_to_string(program.path("out.obj")).expect("written");
    let faces: Vec<&str> = written.lines().filter(|line| line.starts_with('f')).collect();
    assert_eq!(faces, ["f 1 2", "f 1/1 2/2 3/3", "f 1/1 3/3 4/4", "f 4/4 1/1"]);
    // What was written is planar for every other reader, too.
    let check = program.run(&["check", "out.obj", "--report", "-"]).expect(0).json();
    assert_eq!(check["mesh"]["warnings"], json!([{"kind": "faces-of-few-corners", "count": 2, "line": 9}]));
}
