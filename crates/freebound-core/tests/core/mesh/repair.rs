//! Repairs one by one, the source of every corner, and surfaces of all kinds cut open to disks.

use freebound_core::mesh::{DiskMesh, Fault, PolygonMesh, Repair, Repaired, Repairs, TriMesh, VertexId, diagnose};
use glam::DVec3;

use freebound_testkit::{Random, band, corpus_entry, corpus_test, disk, fan, grid, head, quad_sheet, tetrahedron};

/// Polygons over `vertex_count` scattered vertices.
fn polygons(vertex_count: u32, faces: &[&[u32]]) -> PolygonMesh {
    let mut random = Random(u64::from(vertex_count));
    let mut place = || DVec3::new(random.unit(), random.unit(), random.unit());
    let mut starts = vec![0];
    let mut corners = Vec::new();
    for face in faces {
        corners.extend(face.iter().map(|&v| VertexId::new(v)));
        starts.push(u32::try_from(corners.len()).expect("few"));
    }
    PolygonMesh { positions: (0..vertex_count).map(|_| place()).collect(), corners, starts: Some(starts) }
}

fn done(repaired: &Repaired) -> Vec<(Repair, usize)> {
    repaired.done().iter().map(|done| (done.repair, done.count)).collect()
}

fn faces(repaired: &Repaired) -> Vec<Vec<u32>> {
    let polygons = repaired.polygons();
    (0..polygons.face_count()).map(|face| polygons.face(face).iter().map(|v| v.number()).collect()).collect()
}

/// Asserts that positions stay, new vertices coincide with old ones, and each corner comes from a coinciding one of
/// its face.
fn assert_comes_from(source: &PolygonMesh, repaired: &Repaired) {
    let polygons = repaired.polygons();
    let old = source.positions.len();
    assert_eq!(polygons.positions[..old], source.positions);
    let places = |mesh: &PolygonMesh, corner: usize| mesh.positions[mesh.corners[corner].index()];
    let triangles = repaired.triangulate();
    for face in 0..polygons.face_count() {
        let corners: Vec<usize> = polygons.corner_range(face).map(|corner| repaired.corner_of(corner)).collect();
        let of = (0..source.face_count()).find(|&f| source.corner_range(f).contains(&corners[0])).expect("a face");
        assert!(corners.iter().all(|corner| source.corner_range(of).contains(corner)), "{corners:?} of face {of}");
        assert!(
            triangles.polygon_of.as_ref().is_some_and(|of_each| of_each.contains(&u32::try_from(of).expect("few")))
        );
    }
    for corner in 0..polygons.corners.len() {
        assert_eq!(places(polygons, corner), places(source, repaired.corner_of(corner)));
    }
    let of_vertex = repaired.vertices_of(source);
    for (vertex, of) in of_vertex.iter().enumerate() {
        assert_eq!(polygons.positions[vertex], source.positions[of.index()]);
    }
}

fn repaired(source: &PolygonMesh, repairs: Repairs) -> Repaired {
    let repaired = Repaired::new(source, repairs);
    assert_comes_from(source, &repaired);
    repaired
}

fn is_disk(repaired: &Repaired) -> bool {
    diagnose(&repaired.triangulate()).is_disk()
}

#[test]
fn nothing_is_done_to_a_disk() {
    let source = PolygonMesh::from(&grid(3, 2));
    for repairs in [Repairs::NONE, Repairs::SAFE, Repairs::ALL] {
        let repaired = repaired(&source, repairs);
        assert_eq!((done(&repaired), repaired.polygons()), (vec![], &source));
    }
}

#[test]
fn a_quad_that_names_a_vertex_twice_becomes_a_triangle() {
    let source = polygons(4, &[&[0, 1, 1, 2], &[2, 3, 0]]);
    let repaired = repaired(&source, Repairs::SAFE);
    assert_eq!(done(&repaired), [(Repair::DropRepeatedCorners, 1)]);
    assert_eq!(faces(&repaired), [[0, 1, 2], [2, 3, 0]]);
    assert!(is_disk(&repaired));
}

#[test]
fn faces_that_cannot_keep_three_corners_go() {
    let source = polygons(5, &[&[0, 1, 2], &[1, 1, 2], &[2, 0, 2, 0], &[0, 2, 3, 4]]);
    let repaired = repaired(&source, Repairs::SAFE);
    assert_eq!(done(&repaired), [(Repair::DropRepeatedCorners, 2)]);
    assert_eq!(faces(&repaired), [vec![0, 1, 2], vec![0, 2, 3, 4]]);
    assert_eq!(repaired.degenerate_faces(), [1, 2]);
    let vertices = repaired.vertices_at_corners(&source);
    for face in [1, 2] {
        let places = &vertices[source.corner_range(face)];
        assert!(places[0].is_some() && places.iter().all(|place| *place == places[0]), "face {face}: {places:?}");
    }
}

#[test]
fn a_side_that_runs_back_is_removed_and_a_hole_joined_by_an_edge_stays() {
    // The face runs from vertex 3 to 0 and back; the second face goes around a hole, joined by the edge 0-4.
    let source = polygons(9, &[&[3, 8, 7, 8, 3, 2, 1], &[0, 1, 2, 3, 0, 4, 7, 6, 5, 4]]);
    let repaired = repaired(&source, Repairs::SAFE);
    assert_eq!(done(&repaired)[0], (Repair::DropRepeatedCorners, 1));
    assert_eq!(faces(&repaired)[0], [3, 2, 1]);
    assert_eq!(faces(&repaired)[1].len(), 10);
    assert!(repaired.degenerate_faces().is_empty());
}

#[test]
fn no_safe_repair_removes_area() {
    let mut random = Random(7);
    for case in 0..400 {
        let (vertices, count) = (3 + random.below(5), 1 + random.below(9));
        let face: Vec<u32> = (0..count.max(3)).map(|_| random.below(vertices)).collect();
        // A second face keeps the mesh from being empty.
        let source = polygons(vertices + 3, &[&face, &[vertices, vertices + 1, vertices + 2]]);
        let repaired = Repaired::new(&source, Repairs::SAFE);
        let normal = |mesh: &PolygonMesh| -> DVec3 {
            let of = |face: usize| {
                let at = |k: usize| mesh.positions[mesh.face(face)[k % mesh.face(face).len()].index()];
                (0..mesh.face(face).len()).map(|k| at(k).cross(at(k + 1))).sum::<DVec3>()
            };
            (0..mesh.face_count()).map(of).sum()
        };
        let lost = (normal(&source) - normal(repaired.polygons())).length();
        assert!(lost < 1e-12, "case {case}: {face:?} loses {lost}");
    }
}

#[test]
fn a_face_that_is_there_again_is_separated_if_that_is_asked_for() {
    let source = polygons(4, &[&[0, 1, 2, 3], &[2, 1, 0, 3], &[3, 0, 1, 2]]);
    let repaired = repaired(&source, Repairs::SAFE.with(Repair::SeparateDuplicates));
    assert_eq!(done(&repaired), [(Repair::SeparateDuplicates, 2)]);
    assert_eq!(faces(&repaired), [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]]);
    let sources: Vec<u32> = repaired.vertices_of(&source).iter().map(|v| v.number()).collect();
    assert_eq!(sources, [0, 1, 2, 3, 2, 1, 0, 3, 3, 0, 1, 2]);
}

#[test]
fn a_face_that_is_there_again_is_stacked_however_it_runs() {
    let source = polygons(4, &[&[0, 1, 2, 3], &[2, 1, 0, 3], &[3, 0, 1, 2]]);
    for repairs in [Repairs::SAFE, Repairs::ALL] {
        let repaired = repaired(&source, repairs);
        assert_eq!(done(&repaired), [(Repair::StackDuplicates, 2)]);
        assert_eq!(faces(&repaired), [[0, 1, 2, 3]]);
        let vertices: Vec<u32> =
            repaired.vertices_at_corners(&source).iter().map(|v| v.expect("a place").number()).collect();
        assert_eq!(vertices, [0, 1, 2, 3, 2, 1, 0, 3, 3, 0, 1, 2]);
    }
}

#[test]
fn the_second_sides_of_a_sheet_form_a_sheet() {
    let front = grid(4, 3);
    let mut both = front.clone();
    both.triangles.extend(front.triangles.iter().map(|&[a, b, c]| [a, c, b]));
    let source = PolygonMesh::from(&both);
    let repaired = repaired(&source, Repairs::SAFE.with(Repair::SeparateDuplicates));
    assert_eq!(done(&repaired), [(Repair::SeparateDuplicates, front.face_count())]);
    assert_eq!(repaired.polygons().positions.len(), 2 * front.vertex_count());
    let charts = freebound_core::mesh::Charts::of(repaired).expect("two sheets");
    let sizes: Vec<usize> = (0..charts.count()).map(|chart| charts.faces(chart).len()).collect();
    assert_eq!(sizes, [front.face_count(); 2]);
}

#[test]
fn fans_that_meet_in_a_vertex_get_one_each() {
    // Two parts of one surface, which meets itself at vertex 0 of its boundary.
    let source = polygons(6, &[&[0, 1, 2], &[1, 3, 2], &[3, 4, 2], &[4, 5, 2], &[4, 0, 5]]);
    assert!(!diagnose(&source.triangulate()).is_disk());
    let repaired = repaired(&source, Repairs::SAFE);
    assert_eq!(done(&repaired), [(Repair::SplitVertices, 1)]);
    assert_eq!(faces(&repaired)[4], [4, 6, 5]);
    assert!(is_disk(&repaired));
}

#[test]
fn soup_is_welded_and_turned_where_all_is_allowed() {
    let sheet = grid(4, 3);
    let mut random = Random(3);
    let positions: Vec<DVec3> = sheet.triangles.iter().flatten().map(|v| sheet.positions[v.index()]).collect();
    let mut corners: Vec<VertexId> = (0..positions.len()).map(VertexId::from_index).collect();
    for face in corners.chunks_mut(3).filter(|_| random.below(3) == 0) {
        face.reverse();
    }
    let source = PolygonMesh { positions, corners, starts: None };
    assert!(!is_disk(&repaired(&source, Repairs::SAFE)));
    let all = repaired(&source, Repairs::ALL);
    assert!(is_disk(&all));
    let used: std::collections::BTreeSet<VertexId> = all.polygons().corners.iter().copied().collect();
    assert_eq!(used.len(), sheet.vertex_count());
    assert_eq!(done(&all)[0], (Repair::WeldVertices, 72 - sheet.vertex_count()));
    assert_eq!(done(&all)[1].0, Repair::TurnFaces);
}

#[test]
fn an_edge_of_three_faces_is_split_where_all_is_allowed() {
    let source = polygons(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
    let all = repaired(&source, Repairs::ALL);
    assert_eq!(done(&all), [(Repair::SplitEdges, 1)]);
    assert_eq!(faces(&all), [[0, 1, 2], [5, 6, 3], [7, 8, 4]]);
}

#[test]
fn narrow_polygons_with_the_same_diagonal_are_taken_apart() {
    let mut with_same = 0;
    for seed in 0..100 {
        // Two polygons on both sides of a chain that hardly bends.
        let mut source = polygons(12, &[&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10], &[11, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0]]);
        let mut random = Random(seed);
        for (vertex, position) in source.positions.iter_mut().enumerate() {
            let across = match vertex {
                10 => 0.1,
                11 => -0.1,
                _ => 0.02 * random.unit(),
            };
            let along = if vertex < 10 { vertex as f64 } else { 5.0 };
            *position = DVec3::new(along, across, 0.2 * random.unit());
        }
        let is_crowded = |fault: &Fault| matches!(fault, Fault::NonManifoldEdges { .. });
        let is_met = diagnose(&source.triangulate()).faults.iter().any(is_crowded);
        with_same += usize::from(is_met);
        let repaired = repaired(&source, Repairs::ALL);
        assert!(!diagnose(&repaired.triangulate()).faults.iter().any(is_crowded), "seed {seed}");
        assert_eq!(repaired.polygons().face_count(), 2);
        assert_eq!(is_met, done(&repaired).iter().any(|(repair, _)| *repair == Repair::SplitEdges));
    }
    assert!(with_same > 5, "{with_same}");
}

/// Closed surface of this genus: a row of `genus` tori of squares, joined at the rims of removed squares.
fn surface_of_genus(genus: u32) -> TriMesh {
    let (around, along) = (7, 9);
    let at = |part: u32, x: u32, y: u32| part * around * along + (y % along) * around + x % around;
    let mut rims = std::collections::BTreeMap::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for part in 0..genus {
        for k in 0..around * along {
            let [[a, b], [d, c]] = [0, 1].map(|up| [0, 1].map(|along| at(part, k % around + along, k / around + up)));
            if k == 0 && part > 0 {
                // The square faces the removed one of the previous torus.
                let other = [at(part - 1, 3, 4), at(part - 1, 4, 4), at(part - 1, 4, 5), at(part - 1, 3, 5)];
                rims.extend([a, d, c, b].into_iter().zip(other));
            } else if !(k == 4 * around + 3 && part + 1 < genus) {
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    for corner in triangles.iter_mut().flatten() {
        *corner = rims.get(corner).copied().unwrap_or(*corner);
    }
    let angle = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
    let place = |v: u32| {
        let (part, k) = (v / (around * along), v % (around * along));
        let (a, b) = (angle(k % around, around), angle(k / around, along));
        DVec3::new((3.0 + a.cos()) * b.cos() + 5.0 * f64::from(part), (3.0 + a.cos()) * b.sin(), a.sin())
    };
    TriMesh::new((0..genus * around * along).map(place).collect(), &triangles)
}

fn with_holes(mut mesh: TriMesh, holes: &[usize]) -> TriMesh {
    let mut number = 0;
    mesh.triangles.retain(|_| {
        number += 1;
        !holes.contains(&(number - 1))
    });
    mesh
}

/// Cuts a surface open and returns the number of cut edges.
fn assert_cut(name: &str, mesh: &TriMesh) -> usize {
    let source = PolygonMesh::from(mesh);
    let cut = repaired(&source, Repairs::ALL).cut_to_disks();
    assert_comes_from(&source, &cut);
    assert!(is_disk(&cut), "{name}: {}", diagnose(&cut.triangulate()));
    assert_eq!(cut.polygons().face_count(), mesh.face_count(), "{name}");
    let before = diagnose(mesh);
    let after = disk(cut.triangulate());
    let count = done(&cut).iter().find(|(repair, _)| *repair == Repair::Cut).map_or(0, |&(_, count)| count);
    // Both sides of a cut edge lie on the boundary afterwards.
    assert_eq!(after.boundary_loop().len(), before.boundary_edge_count + 2 * count, "{name}");
    count
}

#[test]
fn every_connected_surface_is_cut_to_a_disk() {
    assert_eq!(assert_cut("a disk", &grid(5, 4)), 0);
    assert_eq!(assert_cut("a tetrahedron", &tetrahedron()), 3);
    assert_eq!(assert_cut("a ring", &band(12, 0)), 1);
    assert_eq!(assert_cut("a Möbius strip", &band(13, 1)), 1);
    for genus in 1..5 {
        let closed = surface_of_genus(genus);
        assert_eq!(diagnose(&closed).genus, Some(genus as usize));
        assert_cut("a closed surface with handles", &closed);
        assert_cut("with one hole", &with_holes(closed.clone(), &[40]));
        assert_cut("with many holes", &with_holes(closed, &[3, 11, 40, 41, 63, 90]));
    }
}

#[test]
fn random_surfaces_are_cut_to_disks() {
    let mut random = Random(23);
    for case in 0..60 {
        let mut mesh = surface_of_genus(1 + random.below(3));
        let holes: Vec<usize> = (0..random.below(12)).map(|_| random.index(mesh.face_count())).collect();
        mesh = with_holes(mesh, &holes);
        for p in &mut mesh.positions {
            *p += DVec3::new(random.unit(), random.unit(), random.unit()) * 0.3;
        }
        assert_cut(&format!("case {case}"), &mesh);
    }
}

#[test]
fn polygons_are_cut_along_their_own_edges() {
    let mut random = Random(8);
    let mut sheet = quad_sheet(12, 6, 0.2, &mut random);
    // Rolled into a ring: the last column of vertices is the first.
    let columns = 13;
    for corner in &mut sheet.corners {
        if corner.number() % columns == columns - 1 {
            *corner = VertexId::new(corner.number() - (columns - 1));
        }
    }
    for (k, p) in sheet.positions.iter_mut().enumerate() {
        let turn = std::f64::consts::TAU * (k % columns as usize) as f64 / 12.0;
        *p = DVec3::new(turn.cos(), turn.sin(), p.y);
    }
    let cut = repaired(&sheet, Repairs::SAFE).cut_to_disks();
    assert_comes_from(&sheet, &cut);
    let disk = DiskMesh::try_from(cut.triangulate()).expect("a disk");
    assert_eq!(disk.polygons().count(), 72, "no quad is cut through");
    assert_eq!(done(&cut), [(Repair::Cut, 6)], "the shortest cut goes straight across");
}

#[test]
fn a_closed_head_is_cut_behind_its_face() {
    let head = head(20);
    let cut = repaired(&head, Repairs::SAFE).cut_to_disks();
    let disk = DiskMesh::try_from(cut.triangulate()).expect("a disk");
    assert_eq!(disk.polygons().count(), 6 * 20 * 20);
    let is_of_face = |at: DVec3| at.z > 0.45 && at.x.abs() < 0.5 && at.y.abs() < 0.6;
    let front = disk.boundary_loop().iter().filter(|&&v| is_of_face(disk.position(v))).count();
    assert_eq!(front, 0, "of {} vertices of the cut", disk.boundary_loop().len());
}

#[test]
fn several_parts_are_left_as_they_are() {
    let mut two = fan(5);
    let offset = two.positions.len();
    let other = fan(4);
    two.positions.extend(other.positions.iter().map(|p| *p + 9.0 * DVec3::X));
    two.triangles.extend(other.triangles.iter().map(|t| t.map(|v| VertexId::from_index(v.index() + offset))));
    let source = PolygonMesh::from(&two);
    let whole = repaired(&source, Repairs::ALL);
    assert_eq!(whole.clone().cut_to_disks(), whole);
}

corpus_test! {
    fn bad_files_of_one_part_become_disks() {
        let wanted = ["closed_fish", "degenerate_capsule", "holes_plane", "moebius", "torus_one_hole"];
        for entry in wanted.map(|name| corpus_entry(&format!("bad/{name}.obj"))) {
            let cut = Repaired::new(&entry.read().polygons, Repairs::ALL).cut_to_disks();
            assert!(is_disk(&cut), "{}: {}", entry.file, diagnose(&cut.triangulate()));
        }
    }
}

#[test]
fn repairs_are_the_same_after_they_were_written_and_read() {
    for bits in 0..1_u16 << Repair::CHOSEN.len() {
        let chosen = Repair::CHOSEN.into_iter().enumerate().filter(|(place, _)| bits >> place & 1 == 1);
        let repairs = chosen.clone().fold(Repairs::NONE, |repairs, (_, repair)| repairs.with(repair));
        assert!(Repair::CHOSEN.into_iter().enumerate().all(|(k, r)| repairs.allows(r) == (bits >> k & 1 == 1)));
        assert_eq!(repairs.to_string().parse(), Ok(repairs), "{repairs}");
        assert_eq!(serde_json::from_str::<Repairs>(&format!("\"{repairs}\"")).expect("a set"), repairs);
    }
    let names = [Repairs::NONE, Repairs::SAFE, Repairs::ALL, Repairs::SAFE.with(Repair::TurnFaces)];
    assert_eq!(names.map(|repairs| repairs.to_string()), ["none", "safe", "all", "safe,turn-faces"]);
    let fewer = Repairs::NONE.with(Repair::WeldVertices).with(Repair::SplitEdges);
    assert_eq!(fewer.to_string(), "weld-vertices,split-edges");
}
