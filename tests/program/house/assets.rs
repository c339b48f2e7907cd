//! The files of `assets/` are up to date with their makers, and the makers are correct.

use freebound::examples::{Example, ExampleFiles, Landmark};
use freebound_core::mesh::{PolygonMesh, TriMesh};
use freebound_io::read_stream;
use glam::DVec2;
use robust::{incircle, orient2d};

use freebound_testkit::{
    BuiltIn, PORTRAIT_SIZE, PlacedLandmark, Random, bumpy_ball, bumpy_cap_of, coord, disk, landmarks,
    picture_from_sculpture, plane, portrait, scan, sculpture_from_plane, table, triangulate,
};

/// Remedy if a file differs.
const REMEDY: &str = "cargo run --release --example assets writes the files anew";

fn bits(mesh: &TriMesh) -> Vec<[u64; 3]> {
    mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "sines differ by the last bit between systems")]
fn the_files_of_the_meshes_are_what_their_makers_make() {
    assert_eq!(Example::ALL.map(Example::name), BuiltIn::ALL.map(BuiltIn::name));
    for (example, made) in Example::ALL.into_iter().zip(BuiltIn::ALL) {
        let (made, read) = (made.mesh(), example.mesh());
        assert_eq!(bits(&made), bits(&read), "{}: {REMEDY}", example.name());
        assert_eq!(made, read, "{}: {REMEDY}", example.name());
    }
    let read = Example::Face.landmarks().into_iter();
    let read: Vec<_> = read.map(|Landmark { name, vertex, target }| PlacedLandmark { name, vertex, target }).collect();
    assert_eq!(landmarks(), read, "{REMEDY}");
}

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "sines differ by the last bit between systems")]
fn the_files_of_the_tutorials_are_what_their_makers_make() {
    for (name, made) in [("ball", bumpy_ball()), ("scan", scan()), ("table", table())] {
        let example = ExampleFiles::ALL.into_iter().find(|example| example.name == name).expect("an example");
        let (_, bytes) = example.files[0];
        let read = read_stream(bytes).expect("readable").polygons;
        let faces =
            |mesh: &PolygonMesh| (0..mesh.face_count()).map(|face| mesh.face(face).to_vec()).collect::<Vec<_>>();
        assert!(made.positions == read.positions && faces(&made) == faces(&read), "{name}: {REMEDY}");
    }
}

#[test]
#[cfg_attr(not(all(target_os = "linux", target_env = "gnu")), ignore = "sines differ by the last bit between systems")]
fn the_file_of_the_portrait_is_what_its_maker_makes() {
    assert!(Some(portrait(PORTRAIT_SIZE)) == Example::Face.picture(), "{REMEDY}");
}

#[test]
fn bumpy_caps_of_other_sizes_are_disks_with_about_so_many_vertices() {
    for vertices in [200, 800] {
        let caps = [1, 2].map(|seed| bumpy_cap_of(vertices, seed));
        assert_ne!(caps[0].positions, caps[1].positions, "each seed has its own");
        for cap in caps {
            let count = disk(cap).vertex_count();
            assert!((count as f64 / vertices as f64 - 1.0).abs() < 0.1, "{count} and not {vertices}");
        }
    }
}

#[test]
fn the_random_numbers_are_those_of_splitmix64() {
    // First outputs for seed 0 of the generator's published reference code.
    let mut random = Random(0);
    assert_eq!([random.bits(), random.bits()], [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4]);
}

#[test]
fn no_circumcircle_holds_a_point_and_the_square_is_covered() {
    let mut random = Random(7);
    let mut points: Vec<DVec2> = (0..150).map(|_| DVec2::new(random.unit(), random.unit())).collect();
    points.extend([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y)));
    let triangles = triangulate(&points);
    let mut area = 0.0;
    for t in &triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        area += (b - a).perp_dot(c - a) / 2.0;
        assert!(orient2d(coord(a), coord(b), coord(c)) > 0.0);
        assert!(points.iter().all(|&p| incircle(coord(a), coord(b), coord(c), coord(p)) <= 0.0));
    }
    // Every triangulation of n points, h of them on the hull, has 2n − 2 − h triangles.
    assert_eq!(triangles.len(), 2 * points.len() - 2 - 4);
    assert!((area - 1.0).abs() < 1e-12);
}

#[test]
fn the_place_of_a_feature_in_the_portrait_leads_back_to_it() {
    for (x, y) in [(0.437, 0.137), (-0.153, 0.113), (0.0, -0.92), (-0.26, -0.57), (0.3, 1.1)] {
        let uv = picture_from_sculpture(DVec2::new(x, y));
        let pixel = DVec2::new(uv.x, 1.0 - uv.y) * 512.0;
        let back = sculpture_from_plane(plane(512, pixel));
        assert!(back.distance(DVec2::new(x, y)) < 1e-9, "{back}");
    }
}
