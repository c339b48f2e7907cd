//! New vertices removed after clearance is made for it, and the path tree that needs few.

use freebound_core::bijective::{Matched, matched, simplified, with_clearance};
use freebound_core::flatten::Flattener;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, hard_pins};
use freebound_core::verify::{is_one_to_one, verdict};
use glam::DVec2;

use freebound_testkit::{Random, disk, grid};

/// Flat sheet, and the positions of its vertices.
fn sheet(columns: u32, rows: u32) -> (DiskMesh, Embedding) {
    let mesh = disk(grid(columns, rows));
    let flat = mesh.vertices().map(|v| mesh.position(v).truncate()).collect();
    (mesh, flat)
}

/// Meets pins with new vertices, then removes the unneeded ones.
fn bare(mesh: &DiskMesh, flat: &Embedding, pins: &Pins) -> Matched {
    simplified(mesh, matched(mesh, flat, pins, Control::unattended()).unwrap(), Control::unattended()).unwrap()
}

/// Makes clearance, and checks all required properties: pins exactly met, one-to-one, new vertices on old edges,
/// unchanged surface.
fn roomy(mesh: &DiskMesh, before: &Matched, pins: &Pins) -> Matched {
    let after = with_clearance(mesh, before.clone(), pins, Control::unattended()).unwrap();
    let fine = after.refinement.disk();
    assert!(is_one_to_one(fine, &after.embedding) && verdict(fine, &after.embedding).planar);
    for (v, pin) in pins {
        assert_eq!(after.embedding[v].to_array().map(f64::to_bits), pin.target.to_array().map(f64::to_bits));
    }
    let old = mesh.vertex_count();
    assert_eq!(fine.mesh().positions[..old], mesh.mesh().positions[..]);
    for (new, position) in after.refinement.new_vertices().iter().zip(&fine.mesh().positions[old..]) {
        assert!(before.refinement.new_vertices().contains(new), "none is added");
        let [a, b] = new.edge.map(|v| mesh.position(v));
        assert_eq!(a.lerp(b, new.at), *position);
    }
    assert!((fine.mesh().area() - mesh.mesh().area()).abs() <= 1e-12 * mesh.mesh().area());
    after
}

#[test]
fn two_pins_that_change_places_with_room_around_need_no_new_vertex() {
    // A half turn of the inside meets both pins; the boundary stays and nothing blocks.
    let (mesh, flat) = sheet(10, 10);
    let pins = hard_pins([(48, 72), (72, 48)].map(|(v, at)| (VertexId::new(v), flat[at])));
    let before = bare(&mesh, &flat, &pins);
    let after = roomy(&mesh, &before, &pins);
    let count = |found: &Matched| found.refinement.new_vertices().len();
    assert!(count(&after) < count(&before), "{} {}", count(&after), count(&before));
    let mut run = Flattener::new(Settings::new(Method::Matchmaker, Family::default()), pins);
    let mut last = None;
    run.finish(&mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    let last = last.unwrap();
    assert!(last.verdict.planar && last.unmet().is_empty());
    assert_eq!(last.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices().len()), 0);
}

#[test]
fn room_is_made_beside_pins_that_hold_a_crossing_boundary() {
    // No move unfolds faces between pins alone, so they keep the new vertices they need.
    for (columns, rows) in [(5, 4), (7, 7), (12, 3)] {
        let (mesh, flat) = sheet(columns, rows);
        let boundary = mesh.boundary_loop();
        let turn = |k: usize| std::f64::consts::TAU * (k as f64 + 0.37) / boundary.len() as f64;
        let eight = |k: usize| DVec2::new(turn(k).cos(), turn(k).sin() * turn(k).cos());
        let pins = hard_pins(boundary.iter().enumerate().map(|(k, &v)| (v, eight(k))));
        let before = bare(&mesh, &flat, &pins);
        let after = roomy(&mesh, &before, &pins);
        let count = |found: &Matched| found.refinement.new_vertices().len();
        // The pinned boundary crosses itself, so some boundary edge must bend.
        assert!(0 < count(&after) && count(&after) < count(&before), "{} {}", count(&before), count(&after));
    }
}

#[test]
fn room_is_made_the_same_way_whatever_runs_beside_it() {
    let (mesh, flat) = sheet(8, 6);
    let pins = hard_pins([(20, 41), (41, 33), (33, 20)].map(|(v, at)| (VertexId::new(v), flat[at])));
    let before = bare(&mesh, &flat, &pins);
    let once = with_clearance(&mesh, before.clone(), &pins, Control::unattended()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let again = pool.install(|| with_clearance(&mesh, before, &pins, Control::unattended())).unwrap();
    assert_eq!(once.refinement.new_vertices(), again.refinement.new_vertices());
    assert_eq!(once.embedding, again.embedding);
}

#[test]
fn paths_are_laid_in_the_order_that_needs_few_new_vertices() {
    // Count when this test was written; more would be a regression.
    const NEEDED: usize = 730;
    let mut all = 0;
    for seed in 1..=6 {
        let (mesh, flat) = sheet(12, 12);
        let mut random = Random(seed);
        let mut vertices: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect();
        for i in 0..8 {
            let rest = u32::try_from(vertices.len() - i).unwrap();
            vertices.swap(i, i + random.below(rest) as usize);
        }
        vertices.truncate(8);
        // A single cycle through all of them.
        let targets: Vec<DVec2> = vertices.iter().cycle().skip(1).take(8).map(|v| flat[v.index()]).collect();
        let pins = hard_pins(vertices.into_iter().zip(targets));
        let found = matched(&mesh, &flat, &pins, Control::unattended()).unwrap();
        assert!(is_one_to_one(found.refinement.disk(), &found.embedding));
        all += found.refinement.new_vertices().len();
    }
    assert!(all <= NEEDED, "{all}");
}
