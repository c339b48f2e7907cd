//! Relaxing comes to its end by itself, and what was proved before it stays where it fails.

use freebound::mesh::{DiskMesh, TriMesh, VertexId};
use freebound::solver::{Control, Ending, Family, Ladder, Method, Pin, Pins, Settings, Step, hard_pins};
use glam::{DVec2, DVec3};

use crate::makers::{disk, grid};
use crate::weighted::bump;

fn steps(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = Ladder::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step));
    (steps, ending.expect("what is proved is a result"))
}

/// A fan of four triangles and targets for all vertices, with a slit so narrow that a triangulation of the outside, which
/// takes what is nearest to zero as zero, sees its sides cross.
fn slit() -> (DiskMesh, Pins) {
    let slit_of = |[a, b, c]: [f64; 3]| [(b, 1.0), (c, -1.0), (2.0, 0.0), (1.0, 3.0), (-1.0, 3.0), (a, 0.0)];
    let positions = slit_of([-0.5, 0.0, 0.0]).map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    let triangles = (1..5).map(|k| [0, k, k + 1].map(VertexId::new)).collect();
    let targets = slit_of([16.8e-40, 15.84e-40, 19.2e-40]).map(|(x, y)| DVec2::new(x, y));
    (disk(TriMesh { positions, triangles, polygon_of: None }), hard_pins((0..).map(VertexId::new).zip(targets)))
}

#[test]
fn what_is_proved_stays_the_result_where_relaxing_fails() {
    let (mesh, pins) = slit();
    for method in [Method::Auto, Method::Natural, Method::Lscm, Method::Iterate] {
        let settings = Settings { relax_rounds: Some(3), ..Settings::new(method, Family::Conformal) };
        let (steps, ending) = steps(&mesh, settings, &pins);
        let last = steps.last().expect("a step");
        assert_eq!((ending, steps.len()), (Ending::Planar, 2), "{method:?}: a failure ends the relaxing");
        assert!(last.verdict.planar && last.unmet().is_empty(), "{method:?}: {}", last.verdict.summary());
        assert_eq!(last.solution.embedding, steps[0].solution.embedding);
        let note = last.note.as_deref().unwrap_or_default();
        assert!(note.contains("relaxing gave nothing"), "{method:?}: {note}");
    }
}

#[test]
fn relaxing_that_goes_round_in_circles_ends_by_itself() {
    // Two pins inside are so near that the face between them comes to the least determinant of ordinary rounds, leaves it
    // with the steep rounds, and comes back.
    let near = DVec2::splat(0.5) + DVec2::new(2.15e-4, 1.075e-4);
    let corners = [(0, DVec2::ZERO), (6, DVec2::X), (48, DVec2::ONE), (42, DVec2::Y)];
    let pins = corners.into_iter().chain([(24, DVec2::splat(0.5)), (32, near)]);
    let pins = hard_pins(pins.map(|(v, target)| (VertexId::new(v), target)));
    let settings = Settings { relax_rounds: Some(1000), new_vertices: false, ..Settings::default() };
    let (steps, ending) = steps(&disk(grid(6, 6)), settings, &pins);
    let rounds = || steps.iter().filter(|step| step.rung == Method::Relax);
    let is_steep = |step: &&Step| step.progress.expect("numbers").least_determinant < 1e-3;
    assert!(rounds().filter(is_steep).count() >= 5 && rounds().any(|step| !is_steep(&step)), "it alternates");
    assert!(rounds().count() < 40, "{} rounds", rounds().count());
    assert!(ending == Ending::Planar && steps.iter().all(|step| step.rung != Method::Relax || step.verdict.planar));
}

#[test]
fn weighted_constraints_do_not_keep_relaxing_from_going_on() {
    let mesh = disk(bump(12));
    let target = |v: u32| mesh.position(VertexId::new(v)).truncate();
    let shifted = |v: u32, x: f64| target(v) + DVec2::new(x, 0.0);
    let mut pins = hard_pins([(0, 0.0), (12, 0.3), (156, -0.2)].map(|(v, x)| (VertexId::new(v), shifted(v, x))));
    pins.insert(VertexId::new(84), Pin::weighted(shifted(84, 0.2), 0.1));
    for method in [Method::Auto, Method::Continuation] {
        let settings = Settings { relax_rounds: Some(20), ..Settings::new(method, Family::Conformal) };
        let (steps, ending) = steps(&mesh, settings, &pins);
        let rounds: Vec<&Step> = steps.iter().filter(|step| step.rung == Method::Relax).collect();
        assert!(ending == Ending::Planar && !rounds.is_empty(), "{method:?}");
        assert!(
            rounds.iter().any(|step| step.max_move.is_some_and(|length| length > 0.0)),
            "{method:?}: nothing moves"
        );
        assert!(!rounds.iter().any(|step| step.note.as_deref().is_some_and(|note| note.contains("would fold"))));
    }
}
