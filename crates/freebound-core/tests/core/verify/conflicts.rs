//! Constraints that conflict with each other, in constructed cases.

use std::time::{Duration, Instant};

use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::problem::{Pin, Pins, hard_pins};
use freebound_core::verify::{CONFLICTS_LISTED, Conflict, conflicts};
use glam::DVec2;

use freebound_testkit::{assert_message, disk, fan, grid};

/// Hard pins on vertices of a mesh.
fn pinned(places: &[(u32, [f64; 2])]) -> Pins {
    hard_pins(places.iter().map(|&(v, target)| (VertexId::new(v), DVec2::from(target))))
}

/// Two squares side by side: vertices 0 1 2 below and 3 4 5 above; faces (0 1 4), (0 4 3), (1 2 5), (1 5 4).
fn two_squares() -> DiskMesh {
    DiskMesh::try_from(grid(2, 1)).unwrap()
}

fn turned(face: u32, vertices: [u32; 3]) -> Conflict {
    Conflict::TurnedFace { face: FaceId::new(face), vertices: vertices.map(VertexId::new) }
}

fn crossing(edges: [[u32; 2]; 2]) -> Conflict {
    Conflict::CrossingEdges { edges: edges.map(|ends| ends.map(VertexId::new)) }
}

fn near(vertices: [u32; 2]) -> Conflict {
    Conflict::NearCoincidentTargets { vertices: vertices.map(VertexId::new) }
}

#[test]
fn targets_where_the_vertices_lie_do_not_conflict() {
    let mesh = DiskMesh::try_from(grid(6, 5)).unwrap();
    let pins = hard_pins(mesh.vertices().map(|v| (v, mesh.position(v).truncate())));
    assert_eq!(conflicts(&mesh, &pins), []);
    assert_eq!(conflicts(&mesh, &Pins::new()), []);
}

#[test]
fn a_face_that_would_be_turned_over_or_flat_is_named() {
    let mesh = two_squares();
    for top in [-1.0, 0.0] {
        let pins = pinned(&[(0, [0.0, 0.0]), (1, [1.0, 0.0]), (4, [2.0, top])]);
        let found = conflicts(&mesh, &pins);
        assert_eq!(found[0], turned(0, [0, 1, 4]), "{top}");
        assert_eq!(found[0].vertices(), [0, 1, 4].map(VertexId::new));
        assert!(found[0].needs_new_vertices());
    }
    assert_message("conflicts-turned-face", &turned(0, [0, 1, 4]).words());
}

#[test]
fn a_pin_that_only_pulls_conflicts_with_nothing() {
    let mut pins = pinned(&[(0, [0.0, 0.0]), (1, [1.0, 0.0]), (4, [1.0, -1.0])]);
    pins.insert(VertexId::new(4), Pin::weighted(DVec2::new(1.0, -1.0), 1e6));
    assert_eq!(conflicts(&two_squares(), &pins), []);
}

#[test]
fn edges_that_would_cross_or_touch_are_named_once() {
    let mesh = two_squares();
    // Edges 0–3 and 2–5, which share no end.
    for (there, meets) in [([1.0, 2.0], false), ([0.0, 1.0], true), ([-0.5, 1.0], true), ([0.5, 1.0], false)] {
        let pins = pinned(&[(0, [0.0, 0.0]), (3, [0.0, 2.0]), (2, [1.0, 1.0]), (5, there)]);
        let expected = if meets { vec![crossing([[0, 3], [2, 5]])] } else { Vec::new() };
        assert_eq!(conflicts(&mesh, &pins), expected, "{there:?}");
    }
    assert_message("conflicts-crossing-edges", &crossing([[0, 3], [2, 5]]).words());
    assert_eq!(crossing([[0, 3], [3, 5]]).vertices(), [0, 3, 5].map(VertexId::new));
}

#[test]
fn edges_that_fold_onto_each_other_from_a_shared_end_are_named() {
    // Spokes of a wheel, two of them not adjacent.
    let mesh = DiskMesh::try_from(fan(6)).unwrap();
    let at = |third: [f64; 2]| pinned(&[(0, [0.0, 0.0]), (1, [1.0, 0.5]), (3, third)]);
    assert_eq!(conflicts(&mesh, &at([2.0, 1.0])), [crossing([[0, 1], [0, 3]])]);
    assert_eq!(conflicts(&mesh, &at([-2.0, -1.0])), []);
    assert_eq!(conflicts(&mesh, &at([2.0, 1.0_f64.next_up()])), []);
}

#[test]
fn targets_too_near_to_each_other_are_named_whatever_their_size() {
    let mesh = DiskMesh::try_from(grid(6, 5)).unwrap();
    for size in [1.0, 1e-200, 1e200] {
        let at = |gap: f64| pinned(&[(0, [0.0, 0.0]), (6, [size, 0.0]), (20, [size, gap * size])]);
        let found = conflicts(&mesh, &at(0.9e-9));
        assert_eq!(found, [near([6, 20])], "{size:e}");
        assert!(!found[0].needs_new_vertices());
        assert_eq!(conflicts(&mesh, &at(1.1e-9)), [], "{size:e}");
    }
    assert_eq!(conflicts(&mesh, &pinned(&[(3, [5.0, 5.0]), (20, [5.0, 5.0])])), [near([3, 20])]);
}

#[test]
fn near_targets_are_found_across_the_grid_s_cells() {
    let mesh = DiskMesh::try_from(grid(6, 5)).unwrap();
    for k in 0..40 {
        let x = 0.3 + 1e-10 * f64::from(k);
        for (dx, dy) in [(5e-10, 5e-10), (-5e-10, 5e-10), (5e-10, -5e-10), (-5e-10, -5e-10)] {
            let pins = pinned(&[(0, [0.0, 0.0]), (6, [1.0, 1.0]), (20, [x, x]), (22, [x + dx, x + dy])]);
            assert_eq!(conflicts(&mesh, &pins), [near([20, 22])], "{k} {dx} {dy}");
        }
    }
}

#[test]
fn of_a_mesh_with_every_vertex_astray_only_so_many_are_listed() {
    let mesh = DiskMesh::try_from(grid(60, 60)).unwrap();
    let count = u64::try_from(mesh.vertex_count()).unwrap();
    // A permutation that moves neighbours far apart.
    let place = |v: VertexId| {
        mesh.position(VertexId::from_index(usize::try_from(u64::from(v.number()) * 1009 % count).unwrap()))
    };
    let found = conflicts(&mesh, &hard_pins(mesh.vertices().map(|v| (v, place(v).truncate()))));
    let crossings = found.iter().filter(|conflict| matches!(conflict, Conflict::CrossingEdges { .. })).count();
    assert_eq!(crossings, CONFLICTS_LISTED);
}

#[test]
fn edges_one_above_the_other_are_looked_through_in_good_time() {
    let stages = 20_000;
    let mesh = disk(grid(1, stages));
    // A strip of squares so wide that its cross edges overlap along x.
    let wide = |v: VertexId| mesh.position(v).truncate() * DVec2::new(1e4, 1.0);
    let targets = mesh.vertices().map(|v| (v, Pin::hard(wide(v))));
    let start = Instant::now();
    assert_eq!(conflicts(&mesh, &targets.clone().collect()), []);
    assert!(start.elapsed() < Duration::from_mins(1), "{:?}", start.elapsed());
    // A cross edge laid over the next three.
    let pins: Pins = targets
        .map(|(v, pin)| if v.index() == 1001 { (v, Pin::hard(wide(v) + 3.5 * DVec2::Y)) } else { (v, pin) })
        .collect();
    let found = conflicts(&mesh, &pins);
    assert!(found.iter().any(|conflict| matches!(conflict, Conflict::CrossingEdges { .. })), "{found:?}");
    assert!(found.iter().all(|conflict| conflict.vertices().contains(&VertexId::new(1001))), "{found:?}");
}
