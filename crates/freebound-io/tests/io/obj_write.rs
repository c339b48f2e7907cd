//! Writing OBJ files, atomically and bit for bit.

use std::fs;
use std::io::{self, Write};

use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_io::{MeshFile, Statement, Texture, read_mesh, read_stream, write_atomically, write_obj};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

use freebound_testkit::{assert_message, corpus_test, grid, manifest};

fn written(mesh: &MeshFile, texture: &Embedding) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_obj(&mut bytes, mesh, &Texture::per_vertex(&mesh.polygons, texture)).expect("memory takes all");
    bytes
}

fn bits(positions: &[DVec3]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

/// Any number except NaN, with all exponents equally likely, including −0, subnormal and huge numbers.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits).prop_filter("NaN has many spellings", |x| !x.is_nan()),
        -1e3..1e3_f64,
        (-1_000_000_i32..1_000_000).prop_map(|k| f64::from(k) / 1000.0),
        prop::sample::select(vec![
            0.0,
            -0.0,
            f64::MIN_POSITIVE,
            5e-324,
            -5e-324,
            f64::MAX,
            f64::MIN,
            1e16,
            1e15,
            1e-5,
            9.999e-6
        ]),
    ]
}

/// Meshes of polygons with arbitrary positions, texture coordinates and statements.
fn any_mesh() -> impl Strategy<Value = (MeshFile, Embedding)> {
    let points = prop::collection::vec((any_number(), any_number(), any_number(), any_number(), any_number()), 3..20);
    let polygons = prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 3..6), 1..12);
    let statements = prop::collection::vec((0_u32..14, "(o|g|usemtl|mtllib)( [a-zA-Z0-9.é]{1,5}){1,3}|s off"), 0..5);
    (points, polygons, statements).prop_map(|(points, polygons, mut statements)| {
        let mut mesh = PolygonMesh { starts: Some(vec![0]), ..PolygonMesh::default() };
        mesh.positions = points.iter().map(|&(x, y, z, ..)| DVec3::new(x, y, z)).collect();
        let starts = mesh.starts.as_mut().expect("just made");
        for polygon in &polygons {
            mesh.corners.extend(polygon.iter().map(|corner| VertexId::from_index(corner.index(points.len()))));
            starts.push(u32::try_from(mesh.corners.len()).expect("small"));
        }
        if polygons.iter().all(|polygon| polygon.len() == 3) {
            mesh.starts = None;
        }
        statements.sort_by_key(|&(face, _)| face);
        let face_count = u32::try_from(polygons.len()).expect("small");
        let statements = statements
            .into_iter()
            .map(|(face, text)| Statement { before_face: face.min(face_count), text: text.into_bytes() })
            .collect();
        let obj = MeshFile { polygons: mesh, statements, ..MeshFile::default() };
        (obj, points.iter().map(|&(.., u, v)| DVec2::new(u, v)).collect())
    })
}

proptest! {
    #[test]
    fn what_is_written_reads_back_bit_for_bit((mesh, texture) in any_mesh()) {
        let read = read_stream(written(&mesh, &texture).as_slice()).expect("it reads back");
        prop_assert_eq!(bits(&read.polygons.positions), bits(&mesh.polygons.positions));
        prop_assert_eq!(&read.polygons.corners, &mesh.polygons.corners);
        prop_assert_eq!(&read.polygons.starts, &mesh.polygons.starts);
        prop_assert_eq!(&read.statements, &mesh.statements);
        let found = read.texture.expect("it has texture");
        let coordinate_bits = |t: &[DVec2]| t.iter().map(|t| t.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        prop_assert_eq!(coordinate_bits(&found.coordinates), coordinate_bits(&texture));
        let vertices: Vec<u32> = mesh.polygons.corners.iter().map(|v| v.number()).collect();
        prop_assert_eq!(found.corners, vertices);
    }
}

corpus_test! {
    fn the_corpus_comes_back_from_the_writer() {
        for entry in manifest() {
            let Ok(mesh) = read_mesh(&entry.path) else { continue };
            let back = read_stream(written(&mesh, &Embedding::default()).as_slice()).expect("it reads back");
            assert_eq!(bits(&back.polygons.positions), bits(&mesh.polygons.positions), "{}", entry.file);
            assert_eq!(back.polygons, mesh.polygons, "{}", entry.file);
            assert_eq!(back.statements, mesh.statements, "{}", entry.file);
        }
    }
}

corpus_test! {
    fn a_published_map_goes_through_a_file_unchanged() {
        for entry in manifest().iter().filter(|entry| entry.text("role").contains("+uv")) {
            let name = entry.path.file_stem().expect("a name").to_string_lossy().into_owned();
            let map = entry.path.with_file_name(format!("constrained/{name}.publishedmap.txt"));
            let texture: Embedding = fs::read_to_string(map)
                .expect("the map is there")
                .lines()
                .filter(|line| !line.starts_with('#'))
                .map(|line| {
                    let numbers: Vec<f64> =
                        line.split_whitespace().map(|word| word.parse().expect("a number")).collect();
                    DVec2::new(numbers[1], numbers[2])
                })
                .collect();
            let mesh = entry.read();
            let back = read_stream(written(&mesh, &texture).as_slice()).expect("it reads back");
            let texture_mesh = back.texture_mesh().expect("it is complete");
            assert_eq!(texture_mesh.embedding, texture, "{name}");
            assert_eq!(texture_mesh.mesh, mesh.polygons.triangulate(), "{name}");
        }
    }
}

#[test]
fn a_mesh_looks_as_any_program_expects() {
    let mut mesh = MeshFile::from(&grid(1, 1));
    mesh.statements = vec![
        Statement { before_face: 0, text: b"usemtl skin".to_vec() },
        Statement { before_face: 1, text: b"g left".to_vec() },
    ];
    mesh.polygons.positions[3] = DVec3::new(-0.0, 1e-9, 2.5e20);
    let texture = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.1, 1.0 / 3.0]].map(DVec2::from).into_iter().collect();
    let expected = "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 0.0 1.0 0.0\nv -0.0 1e-9 2.5e20\n\
        vt 0.0 0.0\nvt 1.0 0.0\nvt 0.0 1.0\nvt 0.1 0.3333333333333333\n\
        usemtl skin\nf 1/1 2/2 4/4\ng left\nf 1/1 4/4 3/3\n";
    assert_eq!(String::from_utf8(written(&mesh, &texture)).expect("it is text"), expected);
}

/// File names in a folder.
fn listing(folder: &std::path::Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out.obj");
    write_atomically(&path, |out| out.write_all(b"first")).expect("written");
    let failed = write_atomically(&path, |out| {
        out.write_all(&vec![b'x'; 1 << 20])?;
        Err(io::Error::other("the solver tripped"))
    });
    let error = failed.expect_err("it failed");
    assert!(error.path == path && !error.is_of_input(), "{error}");
    assert_message("obj-write-failed", &error.to_string());
    assert_eq!(fs::read(&path).expect("it is there"), b"first");
    write_atomically(&path, |out| out.write_all(b"second")).expect("written");
    assert_eq!(fs::read(&path).expect("it is there"), b"second");
    assert_eq!(listing(folder.path()), ["out.obj"]);
}

#[test]
fn a_panic_while_writing_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out.obj");
    let panicked = std::panic::catch_unwind(|| write_atomically(&path, |_| panic!("on purpose")));
    assert!(panicked.is_err() && listing(folder.path()).is_empty());
}

#[test]
fn a_place_that_cannot_be_written_to_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    for path in [folder.path().join("missing/out.obj"), folder.path().to_owned()] {
        let error = write_atomically(&path, |out| out.write_all(b"x")).expect_err("it cannot be written");
        assert_eq!(error.path, path, "{error}");
    }
    assert!(listing(folder.path()).is_empty());
}

#[cfg(unix)]
#[test]
fn links_are_followed_devices_stay_and_permissions_are_kept() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
    fs::write(&file, "old").expect("written");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("changed");
    symlink(&file, &link).expect("linked");
    write_atomically(&link, |out| out.write_all(b"new")).expect("written");
    assert!(fs::symlink_metadata(&link).expect("it is there").is_symlink());
    assert_eq!(fs::read(&file).expect("it is there"), b"new");
    assert_eq!(fs::metadata(&file).expect("it is there").permissions().mode() & 0o777, 0o640);
    let device = std::path::Path::new("/dev/null");
    write_atomically(device, |out| out.write_all(b"gone")).expect("written");
    assert!(fs::metadata(device).expect("it is there").file_type().is_char_device());
}
