//! Diagnosis: every fault alone, and all together.

use freebound_core::mesh::{DiskMesh, Elements, Fault, TriMesh, VertexId, diagnose};
use glam::DVec3;

use freebound_testkit::{Random, band, fan, grid, tetrahedron};

/// Names of the faults of a mesh.
fn names(mesh: &TriMesh) -> Vec<&'static str> {
    diagnose(mesh).faults.iter().map(Fault::name).collect()
}

/// Closed torus of 5 × 5 squares.
fn torus() -> TriMesh {
    let at = |x: u32, y: u32| (y % 5) * 5 + x % 5;
    let squares = (0..25).flat_map(|k| {
        let (x, y) = (k % 5, k / 5);
        [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
    });
    let triangles: Vec<[u32; 3]> = squares.collect();
    let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / 5.0;
    let point = |k: u32| {
        let (a, b) = (angle(k % 5), angle(k / 5));
        DVec3::new((3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin())
    };
    TriMesh::new((0..25).map(point).collect(), &triangles)
}

/// Two meshes in one, the second moved aside.
fn beside(mut a: TriMesh, b: &TriMesh) -> TriMesh {
    let offset = a.positions.len();
    a.positions.extend(b.positions.iter().map(|p| p + DVec3::X * 100.0));
    a.triangles.extend(b.triangles.iter().map(|t| t.map(|v| VertexId::from_index(v.index() + offset))));
    a
}

fn with_faces(mut mesh: TriMesh, faces: &[[u32; 3]]) -> TriMesh {
    mesh.triangles.extend(faces.iter().map(|f| f.map(VertexId::new)));
    mesh
}

fn turned(mut mesh: TriMesh, faces: &[usize]) -> TriMesh {
    for &f in faces {
        mesh.triangles[f].swap(1, 2);
    }
    mesh
}

fn moved(mut mesh: TriMesh, vertex: usize, to: [f64; 3]) -> TriMesh {
    mesh.positions[vertex] = to.into();
    mesh
}

/// Adds an unreferenced vertex to a mesh.
fn and_vertex(mut mesh: TriMesh) -> TriMesh {
    mesh.positions.push(DVec3::Z);
    mesh
}

#[test]
fn each_fault_is_named_with_its_elements_and_nothing_else() {
    let nan = [0.0, f64::NAN, 0.0];
    // Seven of nine squares: the middle is a hole, and two neighbours of the removed last square meet at vertex 10
    // only.
    let mut pinched = grid(3, 3);
    pinched.triangles = [&pinched.triangles[..8], &pinched.triangles[10..16]].concat();
    pinched.positions.pop();
    let cases: Vec<(&str, TriMesh, &str)> = vec![
        ("no-faces", TriMesh::new(vec![DVec3::ZERO], &[]), "Nothing"),
        ("missing-vertices", with_faces(grid(1, 1), &[[0, 1, 9]]), "faces [2]"),
        ("not-finite", moved(fan(4), 0, nan), "vertices [0]"),
        ("not-finite", moved(fan(4), 2, [f64::INFINITY, 0.0, 0.0]), "vertices [2]"),
        ("repeated-vertices", with_faces(grid(1, 1), &[[0, 1, 1]]), "faces [2]"),
        ("duplicate-faces", with_faces(grid(1, 1), &[[1, 3, 0], [3, 1, 0]]), "faces [2, 3]"),
        ("unreferenced-vertices", and_vertex(grid(1, 1)), "vertices [4]"),
        ("zero-area", moved(grid(1, 1), 1, [0.5, 0.5, 0.0]), "faces [0]"),
        ("non-manifold-edges", with_faces(and_vertex(grid(1, 1)), &[[0, 3, 4]]), "edges [0-3]"),
        ("non-manifold-vertices", pinched, "vertices [10]"),
        ("mixed-orientation", turned(grid(2, 2), &[3]), "faces [3]"),
        ("mixed-orientation", turned(grid(2, 1), &[0, 1, 2]), "faces [3]"),
        ("non-orientable", band(6, 1), "edges [0-1]"),
        ("several-components", beside(grid(1, 1), &grid(2, 1)), "faces [0, 2]"),
        ("closed", tetrahedron(), "faces [0]"),
        ("several-boundary-loops", band(6, 0), "loops [6, 6]"),
        ("handles", TriMesh { triangles: torus().triangles[1..].to_vec(), ..torus() }, "faces [0]"),
    ];
    for (name, mesh, elements) in cases {
        let diagnosis = diagnose(&mesh);
        assert_eq!(names(&mesh), [name], "{diagnosis}");
        let fault = &diagnosis.faults[0];
        assert_eq!(show(fault.elements()), elements, "{name}");
        assert!(!fault.message().is_empty() && !fault.remedy().is_empty());
        match DiskMesh::try_from(mesh) {
            Err(refused) => assert_eq!(*refused, diagnosis, "{name}"),
            Ok(_) => assert!(["zero-area", "unreferenced-vertices"].contains(&name), "{name} is taken for a disk"),
        }
    }
}

fn show(elements: Elements<'_>) -> String {
    match elements {
        Elements::Nothing => "Nothing".to_owned(),
        Elements::Vertices(v) => format!("vertices {:?}", v.iter().map(|v| v.number()).collect::<Vec<_>>()),
        Elements::Edges(e) => {
            let ends: Vec<String> = e.iter().map(|[a, b]| format!("{}-{}", a.number(), b.number())).collect();
            format!("edges [{}]", ends.join(", "))
        }
        Elements::Faces(f) => format!("faces {:?}", f.polygons),
        Elements::Loops(l) => format!("loops {:?}", l.iter().map(Vec::len).collect::<Vec<_>>()),
    }
}

#[test]
fn all_faults_of_a_mesh_are_named_at_once() {
    let mut mesh = beside(beside(turned(grid(2, 2), &[5]), &torus()), &band(6, 0));
    mesh = with_faces(mesh, &[[0, 0, 1], [0, 1, 4], [0, 1, 999]]);
    mesh.positions.extend([DVec3::ZERO, DVec3::NAN]);
    mesh.positions[1] = DVec3::new(0.5, 0.5, 0.0);
    let found = names(&mesh);
    let expected = [
        "not-finite",
        "missing-vertices",
        "repeated-vertices",
        "duplicate-faces",
        "zero-area",
        "unreferenced-vertices",
        "mixed-orientation",
        "several-components",
        "closed",
        "several-boundary-loops",
        "handles",
    ];
    assert_eq!(found, expected);
    assert_eq!(diagnose(&mesh).to_string().lines().count(), expected.len(), "one fault a line");
}

#[test]
fn boundary_loops_are_listed_in_order_along_the_boundary() {
    let diagnosis = diagnose(&band(7, 0));
    let Elements::Loops(loops) = diagnosis.faults[0].elements() else { panic!("{diagnosis}") };
    for vertices in loops {
        let steps: Vec<u32> = vertices
            .iter()
            .zip(vertices.iter().cycle().skip(1))
            .map(|(a, b)| a.number().abs_diff(b.number()))
            .collect();
        // Neighbours on one side of the band differ by 2, at the seam by 12.
        assert!(steps.iter().all(|&step| step == 2 || step == 12), "{vertices:?}");
    }
}

#[test]
fn a_book_of_many_pages_is_diagnosed_in_good_time() {
    let page_count = 20_000;
    let page = |k: u32| DVec3::new(f64::from(k + 1), f64::from(k % 101), 1.0);
    let positions = [DVec3::ZERO, DVec3::Z].into_iter().chain((0..page_count).map(page)).collect();
    let pages: Vec<[u32; 3]> = (0..page_count).map(|k| [0, 1, k + 2]).collect();
    let diagnosis = diagnose(&TriMesh::new(positions, &pages));
    assert_eq!(diagnosis.faults[0].name(), "non-manifold-edges");
    assert_eq!((diagnosis.boundary_edge_count, diagnosis.boundary_loop_count), (40_000, 1));
}

#[test]
fn faces_are_named_as_the_file_counts_them() {
    // Two quads and a triangle without area: face 2 of the file, triangle 4 of the mesh.
    let mut mesh = with_faces(grid(2, 1), &[[2, 5, 6]]);
    mesh.positions.push(DVec3::new(2.0, 2.0, 0.0));
    mesh.polygon_of = Some(vec![0, 0, 1, 1, 2]);
    let diagnosis = diagnose(&mesh);
    let Elements::Faces(faces) = diagnosis.faults[0].elements() else { panic!("{diagnosis}") };
    assert_eq!((faces.polygons.as_slice(), faces.triangles[0].number()), (&[2][..], 4));
    assert!(diagnosis.faults[0].message().ends_with(": 2"), "{diagnosis}");
}

#[test]
fn turning_the_named_faces_over_mends_a_mixed_mesh() {
    let mut random = Random(5);
    for _ in 0..50 {
        let faces: Vec<usize> = (0..24).filter(|_| random.below(3) == 0).collect();
        let mesh = turned(grid(4, 3), &faces);
        let diagnosis = diagnose(&mesh);
        let to_turn = match diagnosis.faults.as_slice() {
            [] => continue,
            [Fault::MixedOrientation { faces, .. }] => faces.triangles.clone(),
            _ => panic!("{diagnosis}"),
        };
        assert!(to_turn.len() <= 12);
        let with_all_repairs = turned(mesh, &to_turn.iter().map(|f| f.index()).collect::<Vec<_>>());
        assert!(diagnose(&with_all_repairs).is_disk());
    }
}

/// True if the diagnosis reports that a single triangle has no area.
fn has_zero_area(corners: [DVec3; 3]) -> bool {
    names(&TriMesh::new(corners.to_vec(), &[[0, 1, 2]])).contains(&"zero-area")
}

/// Triangle with base 1 and height `height`, moved by `at` and scaled.
fn triangle(height: f64, at: f64, scale: f64) -> [DVec3; 3] {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]].map(|p| (DVec3::from(p) + at) * scale)
}

#[test]
fn thirds_of_a_segment_are_collinear_at_every_scale() {
    let end = DVec3::new(0.7, -1.3, 2.9);
    for scale in [5e-324, 1e-310, 1e-200, 1e-30, 1.0, 1e30, 1e200, 1e308] {
        let points = [DVec3::ZERO, end / 3.0, end].map(|p| p * (scale / 3.0));
        assert!(has_zero_area(points), "{scale:e}");
    }
}

#[test]
fn thin_triangles_have_an_area_at_every_scale() {
    for scale in [1e-290, 1e-200, 1e-30, 1.0, 1e30, 1e200, 1e307] {
        assert!(!has_zero_area(triangle(1e-12, 0.0, scale)), "{scale:e}");
    }
}

#[test]
fn a_height_lost_in_the_rounding_of_large_coordinates_is_none() {
    assert!(has_zero_area(triangle(2e-16, 1.0, 1.0)));
    assert!(has_zero_area(triangle(1e-9, 1e8, 1.0)));
    assert!(!has_zero_area(triangle(1e-6, 1e8, 1.0)));
}

#[test]
fn coincident_corners_have_no_area() {
    let p = DVec3::new(0.1, 0.2, 0.3);
    assert!(has_zero_area([p, p, p * 2.0]) && has_zero_area([p, p, p]) && has_zero_area([DVec3::ZERO; 3]));
}
