//! Normals and colours that go from one format to another, to 32 bits, or 8 bits for colours of PLY files.

use std::collections::BTreeMap;

use freebound_core::mesh::{DiskMesh, FaceId, NewVertex, Refinement, VertexId};
use freebound_io::{MeshFile, OutputKind, Precision, Refined, Texture, read_stream, write_glb, write_obj, write_ply};
use glam::{DVec2, DVec3};

/// Two triangles with a sharp edge between them: its vertices have two normals each. Colours are in sRGB.
const ROOF: &str = "\
v 0 0 0 1 0 0\nv 1 0 1 0 1 0.5\nv 1 1 1 0.25 0.5 0.75\nv 2 0 0 1 1 1
vn -0.70710677 0 0.70710677\nvn 0.70710677 0 0.70710677
f 1//1 2//1 3//1\nf 2//2 4//2 -2//-1\n";

/// Normal and colour of a corner, as another reader finds them.
type Corner = ([f32; 3], [f32; 4]);

fn read(bytes: &[u8]) -> MeshFile {
    read_stream(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn flat(mesh: &MeshFile) -> Texture {
    let places = mesh.polygons.positions.iter().map(|p| DVec2::new(p.x / 3.0, p.y / 3.0 + 0.1)).collect();
    Texture::per_vertex(&mesh.polygons, &places)
}

fn written(mesh: &MeshFile, kind: OutputKind) -> Vec<u8> {
    let (mut bytes, texture) = (Vec::new(), flat(mesh));
    match kind {
        OutputKind::Glb => write_glb(&mut bytes, mesh, &texture),
        OutputKind::Ply => write_ply(&mut bytes, mesh, &texture, Precision::F32),
        _ => write_obj(&mut bytes, mesh, &texture),
    }
    .expect("memory takes all");
    bytes
}

/// Corners of a GLB file in the order of its triangles. Colours are linear.
fn corners_of_glb(glb: &[u8]) -> Vec<Corner> {
    let file = gltf::Gltf::from_slice(glb).expect("another reader takes it");
    let blob = file.blob.as_deref().expect("a binary chunk");
    let mut found = Vec::new();
    for primitive in file.meshes().flat_map(|mesh| mesh.primitives()) {
        let reader = primitive.reader(|_| Some(blob));
        let normals: Vec<[f32; 3]> = reader.read_normals().expect("normals").collect();
        let colours: Vec<[f32; 4]> = reader.read_colors(0).expect("colours").into_rgba_f32().collect();
        let indices = reader.read_indices().expect("indices").into_u32();
        found.extend(indices.map(|index| (normals[index as usize], colours[index as usize])));
    }
    found
}

fn linear(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

#[track_caller]
fn assert_near(found: &[f32], wanted: &[f64], within: f64) {
    let far = found.iter().zip(wanted).map(|(&a, b)| (f64::from(a) - b).abs()).fold(0.0, f64::max);
    assert!(far <= within, "{found:?} for {wanted:?}");
}

/// Lines of an OBJ text with this keyword, as numbers.
fn lines(text: &[u8], keyword: &str) -> Vec<Vec<f64>> {
    let text = std::str::from_utf8(text).expect("text");
    let of = text.lines().filter_map(|line| line.strip_prefix(keyword)?.strip_prefix(' '));
    of.map(|line| line.split_whitespace().map(|word| word.parse().expect("a number")).collect()).collect()
}

const COLOURS: [[f64; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.25, 0.5, 0.75], [1.0, 1.0, 1.0]];
const LEFT: [f64; 3] = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, std::f64::consts::FRAC_1_SQRT_2];
const RIGHT: [f64; 3] = [std::f64::consts::FRAC_1_SQRT_2, 0.0, std::f64::consts::FRAC_1_SQRT_2];

/// Vertex and normal of each corner of the roof.
const CORNERS: [(usize, [f64; 3]); 6] = [(0, LEFT), (1, LEFT), (2, LEFT), (1, RIGHT), (3, RIGHT), (2, RIGHT)];

#[track_caller]
fn assert_roof(glb: &[u8], within: f64) {
    let found = corners_of_glb(glb);
    assert_eq!(found.len(), CORNERS.len());
    for ((normal, colour), (vertex, wanted)) in found.iter().zip(CORNERS) {
        assert_near(normal, &wanted, 1e-6);
        let [r, g, b] = COLOURS[vertex].map(linear);
        assert_near(colour, &[r, g, b, 1.0], within);
    }
}

#[test]
fn normals_and_colours_of_an_obj_file_are_in_the_glb_file_and_come_back() {
    let glb = written(&read(ROOF.as_bytes()), OutputKind::Glb);
    assert_roof(&glb, 1e-6);
    let obj = written(&read(&glb), OutputKind::Obj);
    let text = std::str::from_utf8(&obj).expect("text");
    assert!(text.contains("f 1/1/1 2/2/1 3/3/1\nf 2/2/2 4/4/2 3/3/2\n"), "{text}");
    let normals = lines(&obj, "vn");
    assert_eq!(normals.len(), 2);
    for (line, colour) in lines(&obj, "v").iter().zip(COLOURS) {
        assert!(line[3..].iter().zip(colour).all(|(a, b)| (a - b).abs() < 1e-6), "{line:?} for {colour:?}");
    }
    assert_roof(&written(&read(&obj), OutputKind::Glb), 1e-6);
}

#[test]
fn colours_of_a_ply_file_have_eight_bits_and_normals_only_if_each_vertex_has_one() {
    let roof = read(ROOF.as_bytes());
    let ply = written(&roof, OutputKind::Ply);
    let head = String::from_utf8_lossy(&ply[..400]).into_owned();
    let properties = head.lines().filter_map(|line| line.strip_prefix("property ")?.rsplit(' ').next());
    let properties: Vec<&str> = properties.collect();
    assert!(properties.contains(&"red") && !properties.contains(&"nx"), "{head}");
    let smooth = ROOF.replace("//2 ", "//1 ").replace("//-1", "//1");
    let ply = written(&read(smooth.as_bytes()), OutputKind::Ply);
    let obj = written(&read(&ply), OutputKind::Obj);
    assert_eq!(lines(&obj, "vn").len(), 1, "{}", String::from_utf8_lossy(&obj));
    for (line, colour) in lines(&obj, "v").iter().zip(COLOURS) {
        assert!(line[3..].iter().zip(colour).all(|(a, b)| (a - b).abs() <= 0.5 / 255.0), "{line:?} for {colour:?}");
    }
    let found = corners_of_glb(&written(&read(&ply), OutputKind::Glb));
    for (normal, _) in found {
        assert_near(&normal, &LEFT, 1e-6);
    }
}

#[test]
fn corners_without_a_normal_get_that_of_their_face_and_colours_up_to_255_are_shares() {
    let text = "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 255\nv 0 0 1\nvn 0 0 1\nf 1//1 2 3\nf 1 4 2\n";
    let found = corners_of_glb(&written(&read(text.as_bytes()), OutputKind::Glb));
    assert_near(&found[1].0, &[0.0, 0.0, 1.0], 1e-6);
    assert_near(&found[4].0, &[0.0, 1.0, 0.0], 1e-6);
    assert_near(&found[0].1, &[1.0, 0.0, 0.0, 1.0], 1e-6);
    assert_near(&found[4].1, &[1.0; 4], 1e-6);
}

#[test]
fn faces_may_come_before_their_vertices_and_normals_and_a_share_may_be_a_little_above_one() {
    let (elements, faces) = ROOF.split_at(ROOF.find("f ").expect("faces"));
    let faces = faces.replace("-2//-1", "3//2");
    let glb = written(&read(format!("{faces}{elements}").as_bytes()), OutputKind::Glb);
    assert_roof(&glb, 1e-6);
    let bright = ROOF.replace("2 0 0 1 1 1", "2 0 0 1 1.02 1");
    let found = corners_of_glb(&written(&read(bright.as_bytes()), OutputKind::Glb));
    assert_near(&found[0].1, &[1.0, 0.0, 0.0, 1.0], 1e-6);
}

#[test]
fn normals_turn_with_the_node_of_a_mesh() {
    let mut maker = freebound_testkit::glb::GlbMaker::new();
    let position = maker.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
    #[expect(clippy::cast_possible_truncation, reason = "that is what the format holds")]
    let normal = maker.floats("VEC3", &LEFT.map(|x| x as f32).repeat(3));
    let attributes = serde_json::json!({"POSITION": position, "NORMAL": normal});
    maker.push("meshes", serde_json::json!({"primitives": [{"attributes": attributes}]}));
    maker.push("nodes", serde_json::json!({"mesh": 0, "scale": [2, 1, -1]}));
    let obj = written(&read(&maker.glb()), OutputKind::Obj);
    // The surface z = x becomes z = −x / 2. The mirror image turns the triangle over, and the normal stays outside.
    let normals = lines(&obj, "vn");
    let wanted = DVec3::new(-1.0, 0.0, -2.0) / 5.0_f64.sqrt();
    assert_eq!(normals.len(), 1);
    assert!(DVec3::from_slice(&normals[0]).distance(wanted) < 1e-6, "{normals:?}");
}

#[test]
fn a_file_without_normals_and_colours_gets_none() {
    let plain = read(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let glb = freebound_testkit::glb::json_of(&written(&plain, OutputKind::Glb));
    let attributes = glb["meshes"][0]["primitives"][0]["attributes"].as_object().expect("attributes");
    assert_eq!(attributes.keys().collect::<Vec<_>>(), ["POSITION", "TEXCOORD_0"]);
}

#[test]
fn a_new_vertex_has_values_between_those_of_its_edge_in_its_own_face() {
    let file = read(ROOF.as_bytes());
    let disk = DiskMesh::try_from(file.polygons.triangulate()).expect("a disk");
    let edge = [1, 2].map(VertexId::new);
    let new = VertexId::new(4);
    let [a, b, c, d] = [0, 1, 2, 3].map(VertexId::new);
    let parts = BTreeMap::from([
        (FaceId::new(0), vec![[a, b, new], [a, new, c]]),
        (FaceId::new(1), vec![[b, d, new], [new, d, c]]),
    ]);
    let refinement = Refinement::new(&disk, vec![NewVertex { edge, at: 0.25 }], &parts).expect("a disk");
    let refined = Refined::new(&file, None, &refinement).mesh;
    assert_eq!(refined.polygons.positions[4], DVec3::new(1.0, 0.25, 1.0));
    let found = corners_of_glb(&written(&refined, OutputKind::Glb));
    let between: Vec<f64> = (0..3).map(|k| linear(0.75 * COLOURS[1][k] + 0.25 * COLOURS[2][k])).collect();
    for (corner, normal) in [(2, LEFT), (4, LEFT), (8, RIGHT), (9, RIGHT)] {
        assert_near(&found[corner].0, &normal, 1e-6);
        assert_near(&found[corner].1[..3], &between, 1e-6);
    }
}
