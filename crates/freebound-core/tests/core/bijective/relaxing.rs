//! Relaxation ends by itself, and if it fails, the maps proved before it stay.

use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pin, Pins, Settings, Stage, hard_pins,
};
use freebound_core::verify::distortion;
use glam::{DVec2, DVec3};

use freebound_testkit::surfaces::bump;
use freebound_testkit::{assert_message, disk, grid, rolled_strip, shaped};

fn steps(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = Flattener::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step));
    (steps, ending.expect("what is proved is a result"))
}

/// Fan of four triangles with targets for all vertices. Their slit is so narrow that a triangulation of the outside,
/// which treats tiny numbers as zero, sees its sides cross.
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
    let mut notes = Vec::new();
    for method in [Method::Auto, Method::Natural, Method::Lscm, Method::Iterate] {
        let settings = Settings { relax_rounds: Some(3), ..Settings::new(method.clone(), Family::Conformal) };
        let (steps, ending) = steps(&mesh, settings, &pins);
        let last = steps.last().expect("a step");
        assert_eq!((ending, steps.len()), (Ending::Planar, 2), "{method:?}: a failure ends the relaxing");
        assert!(last.verdict.planar && last.unmet().is_empty(), "{method:?}: {}", last.verdict.summary());
        assert_eq!(last.candidate.solution.embedding, steps[0].candidate.solution.embedding);
        assert_eq!(last.candidate.stage, Stage::Relax, "{method:?}");
        notes.push(last.candidate.note.clone().expect("it is said"));
    }
    assert_message("relaxing-fails", &notes.join("\n"));
}

#[test]
fn relaxing_that_goes_round_in_circles_ends_by_itself() {
    // Two inner pins are so near that the face between them reaches the least determinant of ordinary rounds. It
    // gets past that with the steep rounds, and back.
    let near = DVec2::splat(0.5) + DVec2::new(2.15e-4, 1.075e-4);
    let corners = [(0, DVec2::ZERO), (6, DVec2::X), (48, DVec2::ONE), (42, DVec2::Y)];
    let pins = corners.into_iter().chain([(24, DVec2::splat(0.5)), (32, near)]);
    let pins = hard_pins(pins.map(|(v, target)| (VertexId::new(v), target)));
    let settings = Settings { relax_rounds: Some(1000), new_vertices: false, ..Settings::default() };
    let (steps, ending) = steps(&disk(grid(6, 6)), settings, &pins);
    let rounds = || steps.iter().filter(|step| step.candidate.stage == Stage::Relax);
    let is_steep = |step: &&Step| step.candidate.progress.expect("numbers").least_determinant < 1e-3;
    assert!(rounds().filter(is_steep).count() >= 5 && rounds().any(|step| !is_steep(&step)), "it alternates");
    assert!(rounds().count() < 40, "{} rounds", rounds().count());
    assert!(
        ending == Ending::Planar
            && steps.iter().all(|step| step.candidate.stage != Stage::Relax || step.verdict.planar)
    );
}

#[test]
fn weighted_constraints_do_not_keep_relaxing_from_going_on() {
    let mesh = disk(bump(12));
    let target = |v: u32| mesh.position(VertexId::new(v)).truncate();
    let shifted = |v: u32, x: f64| target(v) + DVec2::new(x, 0.0);
    let mut pins = hard_pins([(0, 0.0), (12, 0.3), (156, -0.2)].map(|(v, x)| (VertexId::new(v), shifted(v, x))));
    pins.insert(VertexId::new(84), Pin::weighted(shifted(84, 0.2), 0.1));
    for method in [Method::Auto, Method::Continuation] {
        let settings = Settings { relax_rounds: Some(20), ..Settings::new(method.clone(), Family::Conformal) };
        let (steps, ending) = steps(&mesh, settings, &pins);
        let rounds: Vec<&Step> = steps.iter().filter(|step| step.candidate.stage == Stage::Relax).collect();
        assert!(ending == Ending::Planar && !rounds.is_empty(), "{method:?}");
        assert!(
            rounds.iter().any(|step| step.max_move.is_some_and(|length| length > 0.0)),
            "{method:?}: nothing moves"
        );
        // A round that would fold gives the embedding before it, without an outside.
        assert!(rounds.iter().all(|step| step.candidate.outside.is_some()), "{method:?}");
    }
}

/// Rate at which the mean symmetric Dirichlet energy at equal total areas falls, by differences. All free vertices
/// move at once along the gradient of length 1.
fn steepness(mesh: &DiskMesh, embedding: &Embedding, pins: &Pins) -> f64 {
    const STEP: f64 = 1e-5;
    let energy = |vertex: VertexId, by: DVec2| {
        let mut moved = embedding.clone();
        moved[vertex] += by;
        distortion(mesh, &moved).summary.symmetric_dirichlet.mean
    };
    let slope = |vertex, along: DVec2| (energy(vertex, STEP * along) - energy(vertex, -STEP * along)) / (2.0 * STEP);
    let free = mesh.vertices().filter(|vertex| !pins.contains_key(vertex));
    free.map(|vertex| slope(vertex, DVec2::X).powi(2) + slope(vertex, DVec2::Y).powi(2)).sum::<f64>().sqrt()
}

/// Energies of rounds of relaxing that start with the boundary on a circle.
fn energies_from_circle(mesh: &DiskMesh, rounds: usize) -> Vec<f64> {
    let method = Method::Convex(BoundaryShape::Circle);
    let settings = Settings { relax_rounds: Some(rounds), ..Settings::new(method, Family::MeanValue) };
    let (steps, ending) = steps(mesh, settings, &Pins::new());
    assert!(ending == Ending::Planar && steps.iter().all(|step| step.verdict.planar), "{ending:?}");
    steps.iter().filter_map(|step| step.candidate.progress).map(|progress| progress.energy).collect()
}

#[test]
fn a_rolled_up_strip_unrolls_from_a_disk_in_one_round() {
    // The boundary turns inward and outward on the way. A triangulated outside that must not fold forbids that, and
    // the first round ends at 88.
    let energies = energies_from_circle(&disk(rolled_strip(18)), 1);
    assert!(energies[0] < 5.0, "{energies:?}");
}

#[test]
fn a_rolled_up_strip_ends_isometric() {
    // Rounds that make small steps count as converged at 4.048.
    let energies = energies_from_circle(&disk(rolled_strip(10)), 30);
    assert!(energies.last().is_some_and(|&energy| energy < 4.005), "{energies:?}");
}

#[test]
fn a_rounds_energy_is_the_mean_of_the_report_even_with_needles() {
    // Every fourth row of faces is 10⁻⁶ high. By their own shapes they double the mean energy of the report.
    let low = |y: f64| y - (y / 4.0).floor() * (1.0 - 1e-6);
    let mesh = disk(shaped(3, 12, |x, y| DVec3::new(x, low(y), 0.2 * (x * y).sin())));
    let settings = Settings { relax_rounds: Some(4), ..Settings::default() };
    let (steps, _) = steps(&mesh, settings, &Pins::new());
    let rounds = steps.iter().filter(|step| step.candidate.stage == Stage::Relax);
    let of_both = rounds.map(|step| {
        let reported = distortion(&mesh, &step.candidate.solution.embedding).summary.symmetric_dirichlet.mean;
        [step.candidate.progress.expect("numbers").energy, reported]
    });
    let of_both: Vec<[f64; 2]> = of_both.collect();
    assert!(!of_both.is_empty());
    assert!(of_both.iter().all(|[energy, reported]| (energy - reported).abs() < 1e-9 * reported), "{of_both:?}");
}

#[test]
fn auto_relaxes_a_map_of_low_energy_if_a_face_shrank_to_a_hundredth() {
    // The tip of a spike on a wide sheet: a small part of the surface, so that the mean stays low.
    let height = |x: f64, y: f64| 8.0 * (-0.25 * ((x - 16.0).powi(2) + (y - 16.0).powi(2))).exp();
    let mesh = disk(shaped(32, 32, |x, y| DVec3::new(x, y, height(x, y))));
    let (steps, _) = steps(&mesh, Settings::default(), &Pins::new());
    let of = |step: &Step| distortion(&mesh, &step.candidate.solution.embedding).summary;
    let (first, last) = (of(&steps[0]), of(steps.last().expect("a step")));
    assert!(steps[0].verdict.planar && first.symmetric_dirichlet.mean < 20.0, "{first:?}");
    assert!(first.area.max >= 100.0 && last.area.max < 100.0, "{} to {}", first.area.max, last.area.max);
}

#[test]
fn relaxing_ends_where_the_energy_at_equal_areas_is_least() {
    // Four pins in the middle at a quarter of the scale of the four corner pins.
    let mesh = disk(bump(8));
    let held = [(0, 1.0), (8, 1.0), (72, 1.0), (80, 1.0), (30, 0.25), (32, 0.25), (48, 0.25), (50, 0.25)];
    let place = |v: u32| (mesh.position(VertexId::new(v)) - mesh.position(VertexId::new(40))).truncate();
    let pins = hard_pins(held.map(|(v, size)| (VertexId::new(v), size * place(v))));
    let settings = Settings { relax_rounds: Some(100), ..Settings::default() };
    let (steps, _) = steps(&mesh, settings, &pins);
    let rounds = steps.iter().filter(|step| step.candidate.stage == Stage::Relax);
    let slopes: Vec<f64> = rounds.map(|step| steepness(&mesh, &step.candidate.solution.embedding, &pins)).collect();
    // Rounds that keep their initial size stop at 0.175.
    assert!(slopes.iter().any(|&slope| slope > 0.1), "the test is to need the size: {slopes:?}");
    assert!(slopes.last().is_some_and(|&slope| slope < 0.02), "{slopes:?}");
}

#[test]
fn faces_whose_corners_are_all_pinned_do_not_keep_the_others_from_their_least_energy() {
    // Boundary pinned to a circle. Two corners of the grid are almost on the line between their neighbours, so their
    // faces are too steep from the start and stay so.
    let mesh = disk(bump(8));
    let boundary = mesh.boundary_loop();
    let count = boundary.len();
    let turn = |k: usize| DVec2::from_angle(std::f64::consts::TAU * (k % count) as f64 / count as f64);
    let is_ear = |k: usize| mesh.faces().filter(|&face| mesh.face(face).contains(&boundary[k])).count() == 1;
    let place = |k: usize| {
        let middle = 0.5 * (turn(k + count - 1) + turn(k + 1));
        if is_ear(k) { middle * (1.0 + 1e-5) } else { turn(k) }
    };
    assert_eq!((0..count).filter(|&k| is_ear(k)).count(), 2);
    let pins = hard_pins((0..count).map(|k| (boundary[k], place(k))));
    let settings = Settings { relax_rounds: Some(100), new_vertices: false, ..Settings::default() };
    let (steps, ending) = steps(&mesh, settings, &pins);
    let last = steps.last().expect("a step");
    assert!(ending == Ending::Planar && last.candidate.stage == Stage::Relax, "{ending:?}");
    assert!(last.candidate.progress.expect("numbers").least_determinant < 1e-3);
    let slope = steepness(&mesh, &last.candidate.solution.embedding, &pins);
    assert!(slope < 0.05, "{slope}");
}
