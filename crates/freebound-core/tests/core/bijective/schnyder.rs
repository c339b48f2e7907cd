//! Schnyder's grid drawing: planar on every disk, in integers no larger than the number of vertices.

use freebound_core::bijective::schnyder;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Method, Pins, SolveError, Stage, hard_pins};
use freebound_core::verify::verdict;
use glam::DVec2;

use freebound_testkit::{
    Entry, Random, corpus_test, data_triangle_disks, disk, fan, grid, hand, manifest, stacked, steps, tube,
};

/// Asserts that every face is positive, the boundary simple, and all vertices on the grid of the theorem.
fn assert_drawn(name: &str, mesh: &DiskMesh) {
    let embedding = schnyder(mesh);
    let found = verdict(mesh, &embedding);
    assert!(found.planar && !found.mirrored, "{name}: {}", found.summary());
    // The apex makes n + 1 vertices, hence a grid of n − 1.
    let most = (mesh.vertex_count() - 1) as f64;
    for z in embedding.iter().flat_map(|z| [z.x, z.y]) {
        assert!(z == z.trunc() && (0.0..=most).contains(&z), "{name}: {z} is not on the grid up to {most}");
    }
}

#[test]
fn the_smallest_disks_lie_on_the_grid() {
    assert_drawn("a triangle", &disk(stacked(3, 1, &mut Random(0))));
    for sides in 3..8 {
        assert_drawn("a fan", &disk(fan(sides)));
    }
}

#[test]
fn dividing_edges_and_ears_are_no_matter() {
    for (columns, rows) in [(1, 1), (1, 9), (2, 2), (7, 5)] {
        assert_drawn("a grid", &disk(grid(columns, rows)));
    }
}

#[test]
fn random_stacked_triangulations_lie_on_the_grid_however_deep() {
    let mut random = Random(11);
    for newest in [1, 2, 3, 10, 1000] {
        for count in [4, 5, 6, 13, 43, 200, 1500] {
            assert_drawn(&format!("{count} vertices, {newest}"), &disk(stacked(count, newest, &mut random)));
        }
    }
}

#[test]
fn tubes_and_hands_lie_on_the_grid() {
    for (around, along) in [(3, 46), (5, 80), (12, 140)] {
        assert_drawn(&format!("a tube of {around} x {along}"), &disk(tube(around, along)));
    }
    assert_drawn("a hand", &disk(hand(40)));
}

fn assert_every_disk_lies_on_the_grid(disks: Vec<Entry>) {
    for entry in disks {
        assert_drawn(&entry.file, &entry.disk());
    }
}

#[test]
fn every_disk_of_triangles_of_tests_data_lies_on_the_grid() {
    assert_every_disk_lies_on_the_grid(data_triangle_disks());
}

corpus_test! {
    fn every_disk_of_the_corpus_lies_on_the_grid() {
        let disks = manifest().into_iter().filter(|entry| entry.text("role") == "disk");
        assert_every_disk_lies_on_the_grid(disks.collect());
    }
}

#[test]
fn as_a_method_it_is_drawn_then_relaxed_and_every_step_is_proved() {
    let steps = steps(&disk(tube(5, 30)), Method::Schnyder, Pins::new()).unwrap();
    assert!(steps.iter().all(|step| step.verdict.planar && !step.verdict.mirrored));
    let stages: Vec<Stage> = steps.iter().map(|step| step.candidate.stage.clone()).collect();
    assert_eq!(stages[0], Stage::Schnyder);
    assert!(stages.len() > 1 && stages[1..].iter().all(|stage| *stage == Stage::Relax), "{stages:?}");
    let energies: Vec<f64> = steps.iter().filter_map(|step| Some(step.candidate.progress?.energy)).collect();
    assert!(energies.last() < energies.first(), "{energies:?}");
}

#[test]
fn two_pins_are_met_to_the_last_bit_and_three_are_refused() {
    let mesh = disk(tube(4, 12));
    let targets = [(0, [0.25, 0.5]), (9, [-3.0, 0.125]), (30, [1.0, 1.0])];
    let pins = |count: usize| hard_pins(targets[..count].iter().map(|&(v, at)| (VertexId::new(v), DVec2::from(at))));
    for step in steps(&mesh, Method::Schnyder, pins(2)).unwrap() {
        assert!(step.verdict.planar, "{}", step.verdict.summary());
        for (vertex, target) in &targets[..2] {
            assert_eq!(step.candidate.solution.embedding[*vertex as usize], DVec2::from(*target));
        }
    }
    assert_eq!(
        steps(&mesh, Method::Schnyder, pins(3)).err(),
        Some(SolveError::TooManyPins { method: "Schnyder's grid", count: 3, most: 2 })
    );
}

#[test]
fn auto_ends_planar_on_disks_that_defeat_every_linear_solve() {
    let mut random = Random(3);
    let mut meshes: Vec<(String, DiskMesh)> =
        [40, 43, 53, 120, 300].map(|n| (format!("stacked {n}"), disk(stacked(n, 3, &mut random)))).into();
    meshes.push(("a tube of 3 x 46".into(), disk(tube(3, 46))));
    meshes.push(("a hand".into(), disk(hand(30))));
    for (name, mesh) in meshes {
        let steps = steps(&mesh, Method::Auto, Pins::new()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let step = steps.last().expect("a ladder gives steps");
        assert!(step.verdict.planar, "{name}: {}", step.verdict.summary());
    }
}
