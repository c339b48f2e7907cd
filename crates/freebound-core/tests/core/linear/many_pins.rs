//! Many pins: sparse least squares against dense least squares, and against the algorithm for few pins.

use std::time::{Duration, Instant};

use freebound_core::flatten::solve_once;
use freebound_core::linear::Iteration;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, Pin, Pins, Settings, Solution, SolveError, Treatment,
};
use glam::DVec2;

use super::weighted::{apart, dense_equations, mixed};
use freebound_testkit::surfaces::{bump, irregular_cube};
use freebound_testkit::{Random, disk, grid};

/// Largest difference between two algorithms, relative to the diameter of the solution.
const AGREE: f64 = 1e-9;

const FAMILIES: [Family; 4] = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.5)];

fn solve(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> Solution {
    solve_once(mesh, settings, pins, Control::unattended()).unwrap()
}

/// Pins every `step`th vertex with `pin`, which gets the target and a count.
fn each(mesh: &DiskMesh, step: usize, pin: impl Fn(DVec2, usize) -> Pin) -> Pins {
    let mut random = Random(17);
    let target = |v: VertexId| mesh.position(v).truncate() + 0.4 * DVec2::new(random.unit(), random.unit());
    let vertices: Vec<VertexId> = mesh.vertices().step_by(step).collect();
    let targets: Vec<DVec2> = vertices.iter().copied().map(target).collect();
    let place = |(count, (&v, &target)): (usize, (&VertexId, &DVec2))| (v, pin(target, count));
    vertices.iter().zip(&targets).enumerate().map(place).collect()
}

#[test]
fn many_pins_of_any_kind_agree_with_dense_least_squares() {
    let mesh = disk(bump(17));
    let mut random = Random(7);
    let weight = |random: &mut Random| 10_f64.powf(4.0 * random.unit() - 2.0);
    let exact = each(&mesh, 2, |target, _| Pin::hard(target));
    let pulled = each(&mesh, 2, |target, count| Pin::weighted(target, 0.1 + (count % 7) as f64));
    let both = mixed(200, weight, &mesh, &mut random);
    for family in FAMILIES {
        for treatment in [Treatment::LeastSquares, Treatment::Eliminate] {
            for pins in [&exact, &pulled, &both] {
                let settings = Settings { treatment: Some(treatment), ..Settings::new(Method::Natural, family) };
                let count_exact = pins.values().filter(|pin| pin.kind.is_hard()).count();
                let is_eliminated = |v| {
                    treatment == Treatment::Eliminate
                        && count_exact > 1
                        && pins.get(&v).is_some_and(|pin: &Pin| pin.kind.is_hard())
                };
                let dense = dense_equations(&mesh, &settings, is_eliminated).solve(mesh.vertex_count(), pins);
                let error = apart(&dense, &solve(&mesh, &settings, pins).embedding);
                assert!(error <= AGREE, "{family} {treatment:?} {} pins: {error:.1e}", pins.len());
            }
        }
    }
}

/// A vertex pinned to its position at the minimum changes nothing. Asserts that a solve with few pins agrees with
/// one that also pins many further vertices at the first solve's positions.
fn assert_further_pins_change_nothing(mesh: &DiskMesh, settings: &Settings, few: &Pins, further: &Pins) {
    let Solution { embedding, .. } = solve(mesh, settings, few);
    let at_rest = |(&v, pin): (&VertexId, &Pin)| (v, Pin { target: embedding[v], ..*pin });
    let many: Pins = further.iter().map(at_rest).chain(few.iter().map(|(&v, &pin)| (v, pin))).collect();
    let again = solve(mesh, settings, &many);
    let error = apart(&embedding, &again.embedding);
    assert!(error <= AGREE, "{} {} of {} pins: {error:.1e}", settings.family(), many.len(), mesh.vertex_count());
    for (v, pin) in many.iter().filter(|(_, pin)| pin.kind.is_hard()) {
        assert_eq!(again.embedding[v].to_array().map(f64::to_bits), pin.target.to_array().map(f64::to_bits));
    }
}

#[test]
fn few_pins_and_many_where_they_leave_the_vertices_give_the_same() {
    let mut random = Random(29);
    let meshes = [disk(bump(25)), irregular_cube(7, &mut random), disk(grid(30, 9))];
    for mesh in &meshes {
        let few = mixed(12, |random| 0.1 + 3.0 * random.unit(), mesh, &mut random);
        for family in [Family::Conformal, Family::MeanValue] {
            let settings =
                Settings { treatment: Some(Treatment::LeastSquares), ..Settings::new(Method::Natural, family) };
            for step in [1, 2, 5] {
                let exact = each(mesh, step, |target, _| Pin::hard(target));
                assert_further_pins_change_nothing(mesh, &settings, &few, &exact);
                let pulled = each(mesh, step, |target, _| Pin::weighted(target, 2.0));
                assert_further_pins_change_nothing(mesh, &settings, &few, &pulled);
                // On one side alone, so that the rest is far from any pin.
                let half = exact.into_iter().filter(|(v, _)| v.index() < mesh.vertex_count() / 2).collect();
                assert_further_pins_change_nothing(mesh, &settings, &few, &half);
            }
        }
    }
}

#[test]
fn a_step_of_the_iteration_with_many_pins_agrees_with_one_with_few() {
    let mesh = disk(bump(21));
    let mut random = Random(31);
    let few = mixed(10, |random| 0.1 + 3.0 * random.unit(), &mesh, &mut random);
    let start = solve(&mesh, &Settings::default(), &few).embedding;
    let step = |pins: &Pins, start: &Embedding| {
        let mut iteration = Iteration::new(&mesh, start, pins, Treatment::LeastSquares, Control::unattended()).unwrap();
        iteration.step(&mesh, start, Control::unattended()).unwrap().embedding
    };
    let found = step(&few, &start);
    // Soft pins may lie away from the start of the step.
    let pulled = each(&mesh, 2, |target, _| Pin::weighted(target, 1.5));
    let at_rest = pulled.iter().map(|(&v, pin)| (v, Pin { target: found[v], ..*pin }));
    let many = at_rest.chain(few.iter().map(|(&v, &pin)| (v, pin))).collect();
    let error = apart(&found, &step(&many, &start));
    assert!(error <= AGREE, "{error:.1e}");
}

#[test]
fn very_heavy_weights_are_as_good_as_exact_and_very_light_ones_as_none() {
    let mesh = disk(bump(15));
    let settings = Settings { treatment: Some(Treatment::LeastSquares), ..Settings::default() };
    let exact = each(&mesh, 2, |target, _| Pin::hard(target));
    let reference = solve(&mesh, &settings, &exact).embedding;
    for weight in [1e9, 1e80, 1e160] {
        let heavy = each(&mesh, 2, |target, _| Pin::weighted(target, weight));
        let error = apart(&reference, &solve(&mesh, &settings, &heavy).embedding);
        assert!(error <= AGREE, "weight {weight:e}: {error:.1e}");
    }
    for weight in [1e-9, 1e-160] {
        let light = each(
            &mesh,
            1,
            |target, count| {
                if count % 3 == 0 { Pin::hard(target) } else { Pin::weighted(target, weight) }
            },
        );
        let alone: Pins = light.iter().filter(|(_, pin)| pin.kind.is_hard()).map(|(&v, &pin)| (v, pin)).collect();
        let [with, without] = [&light, &alone].map(|pins| solve(&mesh, &settings, pins).embedding);
        let error = apart(&with, &without);
        assert!(error <= AGREE, "weight {weight:e}: {error:.1e}");
    }
}

#[test]
fn all_vertices_pinned_is_a_copy() {
    let mesh = disk(grid(120, 120));
    for family in FAMILIES {
        let settings = Settings { treatment: Some(Treatment::LeastSquares), ..Settings::new(Method::Natural, family) };
        let pins = each(&mesh, 1, |target, _| Pin::hard(target));
        let start = Instant::now();
        let found = solve(&mesh, &settings, &pins).embedding;
        assert!(found.iter().copied().eq(pins.values().map(|pin| pin.target)));
        assert!(start.elapsed() < Duration::from_mins(1), "{family}: {:?}", start.elapsed());
    }
}

#[test]
fn thousands_of_pins_are_solved_for_in_good_time_and_stop_when_asked() {
    let mesh = disk(bump(100));
    let settings = Settings { treatment: Some(Treatment::LeastSquares), ..Settings::default() };
    let pins = each(&mesh, 3, |target, _| Pin::hard(target));
    let start = Instant::now();
    solve(&mesh, &settings, &pins);
    // Handled one by one, these would take minutes.
    assert!(start.elapsed() < Duration::from_mins(2), "{:?}", start.elapsed());
    let cancel = std::sync::atomic::AtomicBool::new(false);
    let raise =
        |phase| cancel.store(phase == freebound_core::problem::Phase::Factor, std::sync::atomic::Ordering::Relaxed);
    let stopped = solve_once(&mesh, &settings, &pins, Control::new(&cancel, &raise));
    assert_eq!(stopped, Err(SolveError::Cancelled));
}
