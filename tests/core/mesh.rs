//! The diagnosis and the disk that it lets through.

use std::collections::{BTreeMap, BTreeSet};

use freebound::mesh::{DiskMesh, Elements, Fault, HalfedgeId, TriMesh, VertexId, diagnose};
use glam::DVec3;

use crate::common::{Random, corpus_disks, fan, grid, tetrahedron};

#[test]
fn the_disks_of_the_corpus_are_disks_with_the_counts_of_the_manifest() {
    for entry in corpus_disks() {
        let diagnosis = diagnose(&entry.mesh());
        assert!(diagnosis.is_disk(), "{}: {diagnosis}", entry.file);
        let found = [
            ("V", diagnosis.vertex_count),
            ("F", diagnosis.face_count),
            ("boundary_loops", diagnosis.boundary_loop_count),
            ("boundary_edges", diagnosis.boundary_edge_count),
            ("components", diagnosis.component_count),
            ("chords", diagnosis.dividing_edges.len()),
            ("ears", diagnosis.ears.len()),
        ];
        for (column, count) in found {
            assert_eq!(entry.number(column), i64::try_from(count).ok(), "{} {column}", entry.file);
        }
        assert_eq!((entry.number("chi"), entry.number("genus")), (Some(diagnosis.euler), Some(0)), "{}", entry.file);
    }
}

#[test]
fn halfedges_of_the_corpus_fit_together() {
    for entry in corpus_disks() {
        check_halfedges(&entry.disk(), &entry.file);
    }
}

#[test]
fn halfedges_of_small_disks_fit_together() {
    let triangle = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]);
    for (name, mesh) in [("triangle", triangle), ("fan", fan(3)), ("grid", grid(3, 2))] {
        check_halfedges(&DiskMesh::try_from(mesh).expect("it is a disk"), name);
    }
}

fn check_halfedges(disk: &DiskMesh, name: &str) {
    assert_eq!(disk.vertex_count() + disk.face_count(), disk.edge_count() + 1, "{name}: Euler number");
    for h in disk.halfedges() {
        let twin = disk.twin(h);
        assert_eq!((disk.twin(twin), disk.edge_of(twin)), (h, disk.edge_of(h)), "{name} {h}");
        assert_eq!((disk.tail(h), disk.head(h)), (disk.head(twin), disk.tail(twin)), "{name} {h}");
        assert_eq!(disk.tail(disk.next(h)), disk.head(h), "{name} {h}");
        assert_eq!(disk.previous(disk.next(h)), h, "{name} {h}");
        assert_eq!(disk.is_outer(disk.next(h)), disk.is_outer(h), "{name} {h}");
        if let Some(face) = disk.face_of(h) {
            assert_eq!(disk.next(disk.next(disk.next(h))), h, "{name} {h}");
            assert!(disk.face(face).contains(&disk.tail(h)), "{name} {h}");
        }
    }
    for edge in disk.edges() {
        let h = disk.halfedge(edge);
        assert_eq!((disk.edge_of(h), disk.is_outer(h)), (edge, false), "{name} {edge}");
        assert_eq!(disk.ends(edge), [disk.tail(h), disk.head(h)], "{name} {edge}");
    }
    check_fans(disk, name);
    check_boundary(disk, name);
}

/// Every halfedge is in the fan of its tail, and each follows the one before it counter-clockwise.
fn check_fans(disk: &DiskMesh, name: &str) {
    let mut seen = 0;
    for v in disk.vertices() {
        let fan: Vec<HalfedgeId> = disk.outgoing(v).collect();
        seen += fan.len();
        assert!(fan.iter().all(|&h| disk.tail(h) == v), "{name} {v}");
        assert_eq!(fan.iter().collect::<BTreeSet<_>>().len(), fan.len(), "{name} {v}");
        // Counter-clockwise: the third corner of each face is the head of the halfedge that follows.
        for pair in fan.windows(2) {
            assert_eq!(disk.head(disk.next(pair[0])), disk.head(pair[1]), "{name} {v}");
        }
        let last = fan[fan.len() - 1];
        assert_eq!(disk.is_outer(last), disk.boundary_place(v).is_some(), "{name} {v}");
        if disk.boundary_place(v).is_some() {
            assert!(disk.is_outer(disk.twin(fan[0])), "{name} {v} begins at the boundary");
        }
    }
    assert_eq!(seen, disk.halfedge_count(), "{name}");
}

/// The loop runs along the boundary edges with the surface to its left.
fn check_boundary(disk: &DiskMesh, name: &str) {
    let boundary = disk.boundary_loop();
    let outer_count = disk.halfedges().filter(|&h| disk.is_outer(h)).count();
    assert_eq!(outer_count, boundary.len(), "{name}");
    for (place, &v) in boundary.iter().enumerate() {
        let next = boundary[(place + 1) % boundary.len()];
        assert_eq!(disk.boundary_place(v), Some(place), "{name}");
        let edge = disk.boundary_edge(place);
        let inside = disk.halfedge(edge);
        assert!(disk.is_boundary_edge(edge) && disk.face_of(inside).is_some(), "{name} {edge}");
        assert_eq!((disk.tail(inside), disk.head(inside)), (v, next), "{name} {edge}");
    }
    assert_eq!(disk.edges().filter(|&e| disk.is_boundary_edge(e)).count(), boundary.len(), "{name}");
}

#[test]
fn the_boundary_of_a_flat_grid_runs_counter_clockwise() {
    let disk = DiskMesh::try_from(grid(4, 3)).expect("a grid is a disk");
    let points: Vec<DVec3> = disk.boundary_loop().iter().map(|&v| disk.position(v)).collect();
    let next = points.iter().cycle().skip(1);
    let double_area: f64 = points.iter().zip(next).map(|(a, b)| a.truncate().perp_dot(b.truncate())).sum();
    assert!((double_area - 24.0).abs() < 1e-12, "{double_area}");
}

#[test]
fn a_disk_keeps_its_dividing_edges_and_ears() {
    // The outer corners of the first and last square are cut off by a diagonal only at two of the four.
    let disk = DiskMesh::try_from(grid(2, 1)).expect("a grid is a disk");
    let ends: Vec<[u32; 2]> = disk.dividing_edges().iter().map(|e| e.map(VertexId::number)).collect();
    assert_eq!(ends, [[0, 4], [1, 4], [1, 5]]);
    assert_eq!(disk.ears().iter().map(|f| f.number()).collect::<Vec<_>>(), [1, 2]);
}

/// Names of the faults of a mesh.
fn names(mesh: &TriMesh) -> Vec<&'static str> {
    diagnose(mesh).faults.iter().map(Fault::name).collect()
}

/// A band of squares around a ring of `length`, joined with its beginning straight or twisted.
fn band(length: u32, twisted: u32) -> TriMesh {
    let at = |k: u32, side: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(length);
        let tilt = angle / 2.0 * f64::from(twisted);
        let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
        out * 3.0 + (out * tilt.cos() + DVec3::Z * tilt.sin()) * (f64::from(side) - 0.5)
    };
    let positions = (0..length).flat_map(|k| [at(k, 0), at(k, 1)]).collect();
    let squares = (0..length).flat_map(|k| {
        let [a, b] = [2 * k, 2 * k + 1];
        let [mut c, mut d] = [2 * ((k + 1) % length), 2 * ((k + 1) % length) + 1];
        if k + 1 == length && twisted == 1 {
            std::mem::swap(&mut c, &mut d);
        }
        [[a, b, d], [a, d, c]]
    });
    TriMesh::new(positions, &squares.collect::<Vec<_>>())
}

/// A closed torus of 5 × 5 squares.
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
    faces.iter().for_each(|&f| mesh.triangles[f].swap(1, 2));
    mesh
}

fn moved(mut mesh: TriMesh, vertex: usize, to: [f64; 3]) -> TriMesh {
    mesh.positions[vertex] = to.into();
    mesh
}

/// The grid with one more vertex, on top of its first.
fn and_vertex(mut mesh: TriMesh) -> TriMesh {
    mesh.positions.push(DVec3::Z);
    mesh
}

#[test]
fn each_fault_is_named_with_its_elements_and_nothing_else() {
    let nan = [0.0, f64::NAN, 0.0];
    // Seven of nine squares: the middle is a hole, and without the last two of its neighbours meet at vertex 10 only.
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
        assert!(DiskMesh::try_from(mesh).is_err_and(|error| *error == diagnosis), "{name}");
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
fn faces_are_named_as_the_file_counts_them() {
    // Two quads and a triangle, the triangle without area: face 2 of the file, triangle 4 of the mesh.
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
        let mended = turned(mesh, &to_turn.iter().map(|f| f.index()).collect::<Vec<_>>());
        assert!(diagnose(&mended).is_disk());
    }
}

#[test]
fn random_soups_get_the_verdict_of_a_naive_oracle() {
    let mut random = Random(1);
    let mut disk_count = 0;
    for case in 0..30_000 {
        let mesh = random_mesh(&mut random);
        let expected = is_disk_by_definition(&mesh);
        let diagnosis = diagnose(&mesh);
        assert_eq!(diagnosis.is_disk(), expected, "case {case}: {:?}\n{diagnosis}", mesh.triangles);
        assert_eq!(DiskMesh::try_from(mesh).is_ok(), expected, "case {case}");
        disk_count += usize::from(expected);
    }
    assert!((2_000..28_000).contains(&disk_count), "both verdicts occur: {disk_count}");
}

/// A small mesh that may be anything: a disk with a few changes, or a soup.
fn random_mesh(random: &mut Random) -> TriMesh {
    let mut mesh = match random.below(6) {
        0 => fan(3 + random.below(4)),
        1 => tetrahedron(),
        2 => band(3 + random.below(3), random.below(2)),
        3 => TriMesh::new(vec![DVec3::ZERO; 3 + random.below(4) as usize], &[]),
        _ => grid(1 + random.below(3), 1 + random.below(2)),
    };
    // Small integers: the oracle decides collinearity without rounding.
    let coordinate = |random: &mut Random| f64::from(random.below(41)) - 20.0;
    for p in &mut mesh.positions {
        *p = DVec3::new(coordinate(random), coordinate(random), coordinate(random));
    }
    if random.below(50) == 0 {
        mesh.positions[0].z = f64::NEG_INFINITY;
    }
    for _ in 0..random.below(4) {
        let vertex_count = u32::try_from(mesh.vertex_count()).expect("small");
        // Now and then one beyond the last.
        let vertex = |random: &mut Random| {
            let beyond = u32::from(random.below(40) == 0);
            VertexId::new(random.below(vertex_count + beyond))
        };
        let face = random.below(u32::try_from(mesh.face_count()).expect("small").max(1)) as usize;
        match random.below(6) {
            0 if !mesh.triangles.is_empty() => drop(mesh.triangles.remove(face)),
            1 if !mesh.triangles.is_empty() => mesh.triangles[face].swap(0, 1),
            2 if !mesh.triangles.is_empty() => mesh.triangles.push(mesh.triangles[face]),
            3 if !mesh.triangles.is_empty() => mesh.triangles[face][random.below(3) as usize] = vertex(random),
            4 if !mesh.triangles.is_empty() => drop(mesh.triangles.pop()),
            _ => mesh.triangles.push([vertex(random), vertex(random), vertex(random)]),
        }
    }
    mesh
}

/// The definition of a disk, written down with sets and walks.
fn is_disk_by_definition(mesh: &TriMesh) -> bool {
    let faces: Vec<[usize; 3]> = mesh.triangles.iter().map(|t| t.map(VertexId::index)).collect();
    let in_range = faces.iter().flatten().all(|&v| v < mesh.vertex_count());
    if faces.is_empty() || !in_range || !mesh.positions.iter().all(|p| p.is_finite()) {
        return false;
    }
    let corners = |f: &[usize; 3]| f.map(|v| mesh.positions[v]);
    let has_area = |f: &[usize; 3]| {
        let [a, b, c] = corners(f);
        (b - a).cross(c - a) != DVec3::ZERO
    };
    if !faces.iter().all(has_area) {
        return false;
    }
    // Each directed edge once: manifold edges, one orientation. Also excludes repeated vertices and duplicates.
    let mut directed = BTreeMap::new();
    for f in &faces {
        for k in 0..3 {
            if f[k] == f[(k + 1) % 3] || directed.insert((f[k], f[(k + 1) % 3]), f[(k + 2) % 3]).is_some() {
                return false;
            }
        }
    }
    let sets: BTreeSet<BTreeSet<usize>> = faces.iter().map(|f| f.iter().copied().collect()).collect();
    let edge_count = directed.keys().filter(|&&(a, b)| a < b || !directed.contains_key(&(b, a))).count();
    let euler = mesh.vertex_count() + faces.len() == edge_count + 1;
    sets.len() == faces.len()
        && euler
        && (0..mesh.vertex_count()).all(|v| link_is_one_chain(v, &faces))
        && boundary_is_one_loop(&directed)
        && reaches_all(&faces, mesh.vertex_count())
}

/// The edges opposite to a vertex make one path or one cycle.
fn link_is_one_chain(vertex: usize, faces: &[[usize; 3]]) -> bool {
    let mut next = BTreeMap::new();
    for f in faces {
        if let Some(k) = f.iter().position(|&v| v == vertex) {
            next.insert(f[(k + 1) % 3], f[(k + 2) % 3]);
        }
    }
    let ends: BTreeSet<usize> = next.values().copied().collect();
    let Some(start) = next.keys().find(|v| !ends.contains(v)).or_else(|| next.keys().next()).copied() else {
        return false;
    };
    let mut at = start;
    let mut length = 0;
    while let Some(&to) = next.get(&at) {
        length += 1;
        at = to;
        if at == start || length > next.len() {
            break;
        }
    }
    length == next.len()
}

fn boundary_is_one_loop(directed: &BTreeMap<(usize, usize), usize>) -> bool {
    let next: BTreeMap<usize, usize> =
        directed.keys().filter(|&&(a, b)| !directed.contains_key(&(b, a))).copied().collect();
    let Some((&start, &first)) = next.iter().next() else { return false };
    let mut at = first;
    let mut length = 1;
    while at != start && length <= next.len() {
        let Some(&to) = next.get(&at) else { return false };
        at = to;
        length += 1;
    }
    length == next.len()
}

fn reaches_all(faces: &[[usize; 3]], vertex_count: usize) -> bool {
    let mut reached = BTreeSet::from([faces[0][0]]);
    for _ in 0..vertex_count {
        for f in faces {
            if f.iter().any(|v| reached.contains(v)) {
                reached.extend(f);
            }
        }
    }
    reached.len() == vertex_count
}
