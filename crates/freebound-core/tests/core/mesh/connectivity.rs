//! Disks of the corpus, and the consistency of their halfedges.

use std::collections::BTreeSet;

use freebound_core::mesh::{DiskMesh, HalfedgeId, TriMesh, VertexId, diagnose};
use glam::DVec3;

use freebound_testkit::{Entry, corpus_disks, corpus_test, data_disks, fan, grid};

corpus_test! {
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
            assert_eq!(
                (entry.number("chi"), entry.number("genus")),
                (Some(diagnosis.euler), Some(0)),
                "{}",
                entry.file
            );
        }
    }
}

fn assert_halfedges_fit_together(disks: Vec<Entry>) {
    for entry in disks {
        check_halfedges(&entry.disk(), &entry.file);
    }
}

#[test]
fn halfedges_of_tests_data_fit_together() {
    assert_halfedges_fit_together(data_disks());
}

corpus_test! {
    fn halfedges_of_the_corpus_fit_together() {
        assert_halfedges_fit_together(corpus_disks());
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

/// Asserts that every halfedge is in the fan of its tail, and that fans run counter-clockwise.
fn check_fans(disk: &DiskMesh, name: &str) {
    let mut seen = 0;
    for v in disk.vertices() {
        let fan: Vec<HalfedgeId> = disk.outgoing(v).collect();
        seen += fan.len();
        assert!(fan.iter().all(|&h| disk.tail(h) == v), "{name} {v}");
        assert_eq!(fan.iter().collect::<BTreeSet<_>>().len(), fan.len(), "{name} {v}");
        // Counter-clockwise: the third corner of each face is the head of the next halfedge.
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

/// Asserts that the loop runs along the boundary edges with the surface to its left.
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
    // Diagonals cut off only two of the four outer corners of the first and last square.
    let disk = DiskMesh::try_from(grid(2, 1)).expect("a grid is a disk");
    let ends: Vec<[u32; 2]> = disk.dividing_edges().iter().map(|e| e.map(VertexId::number)).collect();
    assert_eq!(ends, [[0, 4], [1, 4], [1, 5]]);
    assert_eq!(disk.ears().iter().map(|f| f.number()).collect::<Vec<_>>(), [1, 2]);
}
