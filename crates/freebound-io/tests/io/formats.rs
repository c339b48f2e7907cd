//! Reading OFF, STL and PLY files: each gives an equal mesh, and each fault is named.

use std::fmt::Write as _;
use std::fs;
use std::time::{Duration, Instant};

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_io::{MeshFile, ParseFaultKind, ReadError, TextureError, read_mesh, read_stream};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

use crate::obj::{assert_faults, bad_number, out_of_range, place_and_kind, too_many, unexpected};
use freebound_testkit::ply::{Encoding, PlyMaker};
use freebound_testkit::{Random, grid, quad_sheet};

fn read(bytes: &[u8]) -> MeshFile {
    read_stream(bytes).unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(bytes)))
}

fn fault(bytes: &[u8]) -> ReadError {
    let start = Instant::now();
    let error = read_stream(bytes).expect_err("it is wrong");
    assert!(start.elapsed() < Duration::from_millis(200), "{error}: {:?}", start.elapsed());
    error
}

/// Quads and triangles at positions that need all digits of 64-bit numbers.
fn quads() -> PolygonMesh {
    let mut mesh = quad_sheet(4, 3, 0.2, &mut Random(5));
    let [a, b] = [0, 1].map(VertexId::new);
    let above = VertexId::from_index(mesh.positions.len());
    mesh.positions.push(DVec3::new(0.1, -1.0 / 3.0, 1e-17));
    mesh.corners.extend([b, a, above]);
    let end = u32::try_from(mesh.corners.len()).expect("few");
    mesh.starts.get_or_insert_default().push(end);
    mesh
}

fn off_text(mesh: &PolygonMesh, head: &str, behind_vertex: &str, behind_face: &str) -> String {
    let mut text = format!("{head}\n# counts\n{} {} 0\n\n", mesh.positions.len(), mesh.face_count());
    for p in &mesh.positions {
        writeln!(text, "{:?} {:?} {:?}{behind_vertex}", p.x, p.y, p.z).expect("memory");
    }
    for face in 0..mesh.face_count() {
        let corners = mesh.face(face);
        write!(text, "{} ", corners.len()).expect("memory");
        for v in corners {
            write!(text, " {}", v.number()).expect("memory");
        }
        writeln!(text, "{behind_face}").expect("memory");
    }
    text
}

#[test]
fn off_files_are_read_whatever_else_stands_on_their_lines() {
    let mesh = quads();
    for (head, behind_vertex, behind_face) in [
        ("OFF", "", ""),
        ("# made by hand\nOFF", " # here", " 255 0 0"),
        ("COFF", " 255 0 0 255", "   0.5 0.5 0.5 1"),
        ("NOFF", " 0 0 1", ""),
        ("STOFF", " 0.5 0.5", ""),
        ("CNOFF", " 0 0 1 1 1 1 1\r", "\r"),
    ] {
        let text = off_text(&mesh, head, behind_vertex, behind_face);
        assert_eq!(read(text.as_bytes()).polygons, mesh, "{head}");
    }
    // Form in some collections.
    let attached = off_text(&mesh, "OFF", "", "").replace("OFF\n# counts\n", "OFF");
    assert_eq!(read(attached.as_bytes()).polygons, mesh);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("headless.off");
    fs::write(&path, off_text(&mesh, "", "", "")).expect("written");
    assert_eq!(read_mesh(&path).expect("it is right").polygons, mesh, "told by its name");
}

#[test]
fn faults_of_off_files_are_named_with_their_lines() {
    let cases = [
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6", out_of_range("vertex", 3, 3)),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6", out_of_range("vertex", -1, 3)),
        ("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 4", ParseFaultKind::TooFewNumbers { found: 2, needed: 3 }),
        ("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "line 4", ParseFaultKind::NotFinite),
        ("OFF\n3 1 0\n0 0 0\n1 1 0\n0 1 0\n3 0 1\n", "line 6", ParseFaultKind::TooFewNumbers { found: 2, needed: 3 }),
        ("OFF\n3 1 0\n0 0 0\n1 1 0\n0 1 0\n2 0 1\n", "line 6", ParseFaultKind::TooFewCorners(2)),
        ("OFF\n3 1 0\n0 0 0\n1 1 0\n", "line 5", ParseFaultKind::EndsEarly),
        ("OFF\n3000000000 1 0\n0 0 0\n", "line 2", too_many("vertex", 3_000_000_000)),
        ("OFF\n3 18446744073709551615 0\n", "line 2", bad_number("18446744073709551615")),
        ("OFF\n3 -4 0\n", "line 2", bad_number("-4")),
        ("OFF\n", "line 2", ParseFaultKind::EndsEarly),
    ];
    assert_faults("formats-faults-of-off", cases.map(|(text, place, kind)| (fault(text.as_bytes()), place, kind)));
    assert!(matches!(fault(b"OFF\n0 0 0\n"), ReadError::NoFaces { vertices: 0 }));
}

/// Binary STL file of triangles.
fn stl_bytes(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = b"solid, as some begin that are none".to_vec();
    bytes.resize(80, 0);
    bytes.extend(u32::try_from(triangles.len()).expect("few").to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn stl_text(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut text = "solid of words\n".to_owned();
    for triangle in triangles {
        text += " facet normal 0 0 1\n  outer loop\n";
        for [x, y, z] in triangle {
            writeln!(text, "   vertex {x:?} {y:e} {z:?}").expect("memory");
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid of words\n"
}

/// Corners of a mesh's triangles.
fn triangles(mesh: &PolygonMesh) -> Vec<[[f64; 3]; 3]> {
    let corner = |v: &VertexId| mesh.positions[v.index()].to_array();
    mesh.corners.chunks_exact(3).map(|t| [0, 1, 2].map(|k| corner(&t[k]))).collect()
}

#[test]
fn corners_of_stl_files_at_one_place_are_one_vertex() {
    let mut mesh = PolygonMesh::from(&grid(5, 4));
    for (k, p) in mesh.positions.iter_mut().enumerate() {
        p.z = f64::from(f32::sin(k as f32));
    }
    let corners = triangles(&mesh);
    let as_f32: Vec<[[f32; 3]; 3]> = corners.iter().map(|t| t.map(|p| DVec3::from(p).as_vec3().to_array())).collect();
    for read in [read(&stl_bytes(&as_f32)), read(stl_text(&corners).as_bytes())] {
        assert_eq!(read.polygons.positions.len(), mesh.positions.len());
        assert_eq!(triangles(&read.polygons), corners, "the corners stay where they were, in their order");
        let first_uses: Vec<u32> = read.polygons.corners.iter().map(|v| v.number()).collect();
        let mut highest = 0;
        for v in first_uses {
            assert!(v <= highest, "vertices are numbered by first use");
            highest = highest.max(v + 1);
        }
    }
}

#[test]
fn zero_and_minus_zero_are_one_place_and_the_next_number_is_another() {
    let next = f32::from_bits(1_f32.to_bits() + 1);
    let bytes =
        stl_bytes(&[[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[-0., 0., -0.], [0., 1., 0.], [next, 0., 0.]]]);
    let mesh = read(&bytes).polygons;
    assert_eq!(mesh.corners, [0, 1, 2, 0, 2, 3].map(VertexId::new));
}

#[test]
fn faults_of_stl_files_are_named_with_line_or_byte() {
    let good = [[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.]]];
    let text = stl_text(&good.map(|t| t.map(|p| p.map(f64::from))));
    let bytes = stl_bytes(&good);
    let mut many = bytes.clone();
    many[80..84].fill(255);
    let mut nowhere = bytes.clone();
    nowhere[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let folder = tempfile::tempdir().expect("a folder");
    let of_file = |bytes: &[u8]| {
        let path = folder.path().join("bad.stl");
        fs::write(&path, bytes).expect("written");
        read_mesh(&path).expect_err("it is wrong")
    };
    let of_text = |text: &str| fault(text.as_bytes());
    let without_corner = text.replacen("   vertex 0.0 1e0 0.0\n", "", 1);
    let cases = [
        (of_file(&bytes[..bytes.len() - 1]), "byte 80", too_many("triangle", 2)),
        (of_file(&many), "byte 80", too_many("triangle", u32::MAX.into())),
        (of_file(&nowhere), "byte 146", ParseFaultKind::NotFinite),
        (of_file(&bytes[..60]), "byte 60", ParseFaultKind::EndsEarly),
        (of_text(&text.replace("1.0 0e0", "x 0e0")), "line 5", bad_number("x")),
        (of_text(&text.replace("1.0 0e0", "inf 0e0")), "line 5", ParseFaultKind::NotFinite),
        (of_text(&without_corner), "line 6", unexpected("endloop")),
        (of_text(&text.replace("endsolid of words\n", "")), "line 16", ParseFaultKind::EndsEarly),
        (of_text(&text[..120]), "line 7", ParseFaultKind::EndsEarly),
    ];
    assert_faults("formats-faults-of-stl", cases);
    assert!(matches!(of_text("solid nothing\nendsolid nothing\n"), ReadError::NoFaces { vertices: 0 }));
}

#[test]
fn ply_files_of_all_encodings_are_one_mesh() {
    let mesh = quads();
    for encoding in Encoding::ALL {
        let maker = PlyMaker { encoding, ..PlyMaker::rich(&mesh) };
        let found = read(&maker.bytes());
        assert_eq!(found.polygons, mesh, "{encoding:?}");
        assert_eq!(found.texture, None);
        let plain = PlyMaker { encoding, ..PlyMaker::plain(&mesh) };
        assert_eq!(read(&plain.bytes()).polygons, mesh, "{encoding:?}");
    }
}

#[test]
fn ply_files_of_32_bits_are_these_numbers_and_all_kinds_of_indices_are_read() {
    let mesh = quads();
    for encoding in Encoding::ALL {
        for index in ["char", "uchar", "short", "ushort", "int", "uint", "int8", "uint16", "int32"] {
            let maker = PlyMaker { encoding, number: "float", index, corners: "vertex_index", ..PlyMaker::rich(&mesh) };
            let found = read(&maker.bytes()).polygons;
            assert_eq!(found.corners, mesh.corners, "{encoding:?} {index}");
            let near = |p: &DVec3| if encoding == Encoding::Text { *p } else { p.as_vec3().as_dvec3() };
            assert_eq!(found.positions, mesh.positions.iter().map(near).collect::<Vec<_>>());
        }
    }
}

#[test]
fn texture_coordinates_of_ply_files_are_those_of_vertices_or_of_corners() {
    let mesh = quads();
    let flat = |v: &VertexId| mesh.positions[v.index()].truncate();
    let expected: Vec<DVec2> = mesh.corners.iter().map(flat).collect();
    for encoding in Encoding::ALL {
        for names in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]] {
            let maker = PlyMaker { encoding, at_vertices: Some(names), ..PlyMaker::rich(&mesh) };
            let texture = read(&maker.bytes()).texture.expect("it has texture coordinates");
            let found: Vec<DVec2> = texture.corners.iter().map(|&at| texture.coordinates[at as usize]).collect();
            assert_eq!(found, expected, "{encoding:?} {names:?}");
        }
        let maker = PlyMaker { encoding, at_corners: Some(usize::MAX), ..PlyMaker::rich(&mesh) };
        let texture = read(&maker.bytes()).texture.expect("it has texture coordinates");
        let found: Vec<DVec2> = texture.corners.iter().map(|&at| texture.coordinates[at as usize]).collect();
        assert_eq!(found, expected, "{encoding:?}");
        let maker = PlyMaker { encoding, at_corners: Some(3), ..PlyMaker::rich(&mesh) };
        let partial = read(&maker.bytes()).texture_mesh();
        let without: Vec<u32> = (3..u32::try_from(mesh.face_count()).expect("few")).collect();
        assert_eq!(partial, Err(TextureError::Missing(without)), "the first three faces have some");
    }
}

/// PLY file of five vertices with one list of strips, in text or in binary form.
fn ply_of_strips(is_text: bool, indices: &[i32]) -> Vec<u8> {
    let points = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
    let encoding = if is_text { "ascii" } else { "binary_little_endian" };
    let head = format!(
        "ply\nformat {encoding} 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
         element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    );
    if is_text {
        let rows: Vec<String> = points.iter().map(|[x, y, z]| format!("{x} {y} {z}")).collect();
        let list: Vec<String> = indices.iter().map(ToString::to_string).collect();
        return format!("{head}{}\n{} {}\n", rows.join("\n"), indices.len(), list.join(" ")).into_bytes();
    }
    let count = i32::try_from(indices.len()).expect("few");
    let numbers = std::iter::once(&count).chain(indices).flat_map(|number| number.to_le_bytes());
    let rows = points.iter().flatten().flat_map(|number| number.to_le_bytes());
    head.bytes().chain(rows).chain(numbers).collect()
}

#[test]
fn strips_of_ply_files_are_triangles_of_one_orientation() {
    // Two triangles, the end of the strip, and a strip of three that is joined by a triangle without area.
    let indices = [0, 1, 2, 3, -1, 1, 4, 3, 3, 2];
    for is_text in [true, false] {
        let mesh = read(&ply_of_strips(is_text, &indices));
        let faces: Vec<Vec<u32>> = (0..mesh.polygons.face_count())
            .map(|f| mesh.polygons.face(f).iter().map(|v| v.number()).collect())
            .collect();
        assert_eq!(faces, [[0, 1, 2], [2, 1, 3], [1, 4, 3]]);
        let normal = |face: &Vec<u32>| {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.polygons.positions[face[k] as usize].truncate());
            (b - a).perp_dot(c - a)
        };
        assert!(faces.iter().all(|face| normal(face) > 0.0), "{faces:?}");
        // A writer makes a new file of faces, which every program reads.
        assert!(mesh.source.is_none());
        assert_eq!(place_and_kind(&fault(&ply_of_strips(is_text, &[0, 1, 5]))).1, out_of_range("vertex", 5, 5));
    }
    let none = fault(&ply_of_strips(true, &[0, 1, -1, 2, 3]));
    assert!(matches!(none, ReadError::NoFaces { vertices: 5 }), "{none}");
}

#[test]
fn what_a_ply_header_says_is_not_believed_without_the_bytes() {
    let head = |encoding: &str, rest: &str| format!("ply\nformat {encoding} 1.0\n{rest}end_header\n");
    let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 1\nproperty list uchar int vertex_indices\n";
    let triangle = "0 0 0\n1 0 0\n0 1 0\n";
    let both = head("ascii", &format!("{vertex}{face}"));
    let many = |encoding: &str, count: &str| head(encoding, &format!("{}{face}", vertex.replace('3', count)));
    let ending = |end: &str| both.clone() + triangle + end;
    let with_second = |second: &str| both.clone() + &triangle.replace("1 0 0", second) + "3 0 1 2";
    let cases = [
        (many("ascii", "4000000000") + triangle, "line 10", too_many("vertex", 4_000_000_000)),
        (many("ascii", "18446744073709551615"), "line 10", too_many("vertex", u64::MAX)),
        (many("binary_little_endian", "4000000000"), "byte 178", too_many("vertex", 4_000_000_000)),
        (ending("4000000000 0 1 2"), "line 13", too_many("list item", 4_000_000_000)),
        (ending("3 0 1"), "line 13", ParseFaultKind::EndsEarly),
        (ending("3 0 1 3"), "line 13", out_of_range("vertex", 3, 3)),
        (ending("3 0 1 -1"), "line 13", out_of_range("vertex", -1, 3)),
        (ending("3 0 1 1.5"), "line 13", bad_number("1.5")),
        (ending("2 0 1"), "line 13", ParseFaultKind::TooFewCorners(2)),
        (with_second("1 inf 0"), "line 11", ParseFaultKind::NotFinite),
        (with_second("1 x 0"), "line 11", bad_number("x")),
        (head("ascii", &vertex.replace("float z", "float w")) + triangle, "line 7", unexpected("element")),
        (
            head("ascii", &format!("{vertex}{}", face.replace("int v", "float v"))) + triangle,
            "line 9",
            unexpected("element"),
        ),
        (
            head("ascii", &format!("{vertex}property list uchar int vertex_indices\n")) + triangle,
            "line 8",
            unexpected("property"),
        ),
        (head("middle_endian", vertex), "line 2", unexpected("middle_endian")),
        (head("ascii", "property float x\n"), "line 3", unexpected("x")),
        (head("ascii", "element vertex many\n"), "line 3", bad_number("many")),
        (head("ascii", "element vertex 3\nproperty list float int x\n"), "line 4", unexpected("x")),
        (head("ascii", vertex).replace("end_header\n", ""), "line 6", ParseFaultKind::EndsEarly),
    ];
    assert_faults("formats-faults-of-ply", cases.map(|(text, place, kind)| (fault(text.as_bytes()), place, kind)));
    let odd = head("ascii", "element odd 18446744073709551615\n");
    assert!(matches!(fault(odd.as_bytes()), ReadError::NoFaces { vertices: 0 }));
}

#[test]
fn a_file_that_is_cut_short_anywhere_is_refused() {
    let mesh = quads();
    for encoding in Encoding::ALL {
        let bytes = PlyMaker { encoding, at_corners: Some(usize::MAX), ..PlyMaker::rich(&mesh) }.bytes();
        // The last number of a text may be shorter, and its line end may be missing.
        let last = if encoding == Encoding::Text { bytes.len() - 4 } else { bytes.len() };
        for length in 4..last {
            let error = read_stream(&bytes[..length]).expect_err("it is cut short");
            let is_named =
                matches!(error, ReadError::Parse { .. } | ReadError::Bytes { .. } | ReadError::NoFaces { .. });
            assert!(is_named, "{encoding:?} {length}: {error}");
        }
    }
}

proptest! {
    #[test]
    fn any_bytes_behind_a_true_beginning_are_read_or_refused(
        head in prop::sample::select(vec!["OFF\n", "solid\nfacet\n", "ply\n", "ply\nformat ascii 1.0\n"]),
        words in prop::collection::vec(prop::sample::select(vec![
            "element vertex 3\n", "element face 2\n", "property float x\n", "property double y\n", "property uchar z\n",
            "property list uchar int vertex_indices\n", "property list int float texcoord\n", "end_header\n", "3 ", "0 ", "1 ",
            "2 ", "-1 ", "nan ", "\n", "vertex ", "endloop ", "endsolid\n", "99999999999 ", "\0", "#",
        ]), 0..60),
    ) {
        if let Ok(mesh) = read_stream((head.to_owned() + &words.concat()).as_bytes()) {
            freebound_core::mesh::diagnose(&mesh.polygons.triangulate());
            drop(mesh.texture_mesh());
        }
    }

    #[test]
    fn a_byte_that_is_turned_over_in_a_ply_file_is_no_panic(at in any::<prop::sample::Index>(), byte in any::<u8>(), which in 0_usize..3) {
        let mesh = quads();
        let maker = PlyMaker { encoding: Encoding::ALL[which], at_corners: Some(2), ..PlyMaker::rich(&mesh) };
        let mut bytes = maker.bytes();
        let at = at.index(bytes.len());
        bytes[at] = byte;
        drop(read_stream(bytes.as_slice()));
    }
}

#[test]
fn the_beginning_of_a_file_tells_its_format_before_its_name_does() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = quads();
    let ply = PlyMaker::plain(&mesh).bytes();
    let off = off_text(&mesh, "OFF", "", "");
    for (name, bytes) in [("a.obj", ply.as_slice()), ("b.stl", off.as_bytes()), ("c.fbx", off.as_bytes()), ("d", &ply)]
    {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("written");
        assert_eq!(read_mesh(&path).expect("it is right").polygons, mesh, "{name}");
    }
}

#[test]
fn a_long_obj_file_is_never_taken_for_binary_stl() {
    let text = "# 0123456789\n".repeat(20_000) + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(read(text.as_bytes()).polygons.face_count(), 1);
}
