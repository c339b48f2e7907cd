//! Constrained flattening: for any targets it ends planar with all hard pins met. Every step of continuation and
//! relaxation is planar, and a cancelled run continues from its last step.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use freebound_core::flatten::{Ending, Flattener, Options, SolverCache, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Phase, Pin, Pins, Settings, SolveError, Stage};
use freebound_testkit::BuiltIn;
use glam::DVec2;
use proptest::prelude::*;

use crate::linear::shapes::finger;
use freebound_testkit::surfaces::irregular_cube;
use freebound_testkit::{Random, assert_message, grid, shaped};

/// Returns all steps of a run, and its ending.
fn steps_of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Result<(Vec<Step>, Ending), SolveError> {
    let mut steps = Vec::new();
    let ending = Flattener::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step))?;
    Ok((steps, ending))
}

fn one_to_one(method: Method) -> Settings {
    Settings::new(method, Family::default())
}

/// Small disk of one of three kinds.
fn small_disk(kind: u32, random: &mut Random) -> DiskMesh {
    match kind % 3 {
        0 => DiskMesh::try_from(grid(2 + random.below(4), 2 + random.below(4))).unwrap(),
        1 => irregular_cube(3, random),
        _ => finger(4, 6, random),
    }
}

/// Pins at random points of the unit square; every fourth is soft.
fn random_pins(mesh: &DiskMesh, count: u32, random: &mut Random) -> Pins {
    let vertex_count = u32::try_from(mesh.vertex_count()).unwrap();
    let mut pins = Pins::new();
    for k in 0..count {
        let target = DVec2::new(random.unit(), random.unit());
        let pin = if k % 4 == 3 { Pin::weighted(target, 1.0) } else { Pin::hard(target) };
        pins.insert(VertexId::new(random.below(vertex_count)), pin);
    }
    pins
}

/// Pins four vertices of the dome to a right-angle turn about the middle, and four of its boundary in place.
fn swirl() -> (DiskMesh, Pins) {
    let mesh = DiskMesh::try_from(BuiltIn::Dome.mesh()).unwrap();
    let (steps, _) = steps_of(&mesh, Settings::default(), &Pins::new()).unwrap();
    let flat = &steps.last().unwrap().candidate.solution.embedding;
    let boundary = mesh.boundary_loop();
    let middle = boundary.iter().map(|v| flat[v.index()]).sum::<DVec2>() / boundary.len() as f64;
    let radius = boundary.iter().map(|v| flat[v.index()].distance(middle)).fold(f64::INFINITY, f64::min);
    let nearest = |z: DVec2| {
        mesh.vertices().min_by(|a, b| flat[a.index()].distance(z).total_cmp(&flat[b.index()].distance(z))).unwrap()
    };
    let inner = (0..4).map(|k| nearest(middle + 0.35 * radius * DVec2::from_angle(f64::from(k) * 1.57)));
    let turned = inner.map(|v| (v, Pin::hard(middle + (flat[v.index()] - middle).perp())));
    let outer = (0..4).map(|k| boundary[k * boundary.len() / 4]);
    let pins = turned.chain(outer.map(|v| (v, Pin::hard(flat[v.index()])))).collect();
    (mesh, pins)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn every_set_of_constraints_ends_planar_with_the_exact_ones_met(kind in 0_u32..3, count in 1_u32..24, seed in 1_u32..) {
        let mut random = Random(seed.into());
        let mesh = small_disk(kind, &mut random);
        let pins = random_pins(&mesh, count, &mut random);
        let (steps, ending) = steps_of(&mesh, Settings::default(), &pins).unwrap();
        let last = steps.last().unwrap();
        prop_assert_eq!(ending, Ending::Planar);
        prop_assert!(last.verdict.planar && !last.verdict.mirrored && last.unmet().is_empty());
        for (v, pin) in pins.iter().filter(|(_, pin)| pin.kind.is_hard()) {
            prop_assert_eq!(last.candidate.solution.embedding[v], pin.target);
        }
        let is_planar = |step: &Step| step.verdict.planar || !step.candidate.stage.is_one_to_one();
        prop_assert!(steps.iter().all(is_planar));
    }
}

#[test]
fn continuation_turns_the_inside_while_the_boundary_stays_and_needs_no_new_vertices() {
    let (mesh, pins) = swirl();
    let (steps, ending) = steps_of(&mesh, one_to_one(Method::Continuation), &pins).unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(steps.iter().all(|step| step.verdict.planar && step.candidate.refinement.is_none()));
    let steps: Vec<Step> = steps.into_iter().filter(|step| !step.is_of_planar_start()).collect();
    let left: Vec<f64> = steps.iter().map(|step| step.candidate.progress.unwrap().distance_left).collect();
    assert!(left[0] > 0.0 && left.last() == Some(&0.0) && left.is_sorted_by(|a, b| a >= b), "{left:?}");
    assert!(steps.iter().all(|step| step.candidate.progress.unwrap().least_determinant > 0.0));
}

#[test]
fn relaxing_lowers_the_energy_round_by_round_and_moves_no_exact_pin() {
    let (mesh, pins) = swirl();
    let settings = Settings { relax_rounds: Some(8), ..one_to_one(Method::Continuation) };
    let (steps, _) = steps_of(&mesh, settings, &pins).unwrap();
    let arrived = steps.iter().rposition(|step| step.candidate.stage == Stage::Continuation).unwrap();
    assert!(steps.len() > arrived + 1);
    let energies: Vec<f64> = steps[arrived..].iter().map(|step| step.candidate.progress.unwrap().energy).collect();
    assert!(energies.is_sorted_by(|a, b| a >= b) && energies.last() < energies.first(), "{energies:?}");
    assert!(steps[arrived..].iter().all(|step| step.unmet().is_empty() && step.verdict.planar));
}

#[test]
fn a_weighted_constraint_pulls_the_nearer_the_heavier_it_is() {
    let mesh = DiskMesh::try_from(BuiltIn::Dome.mesh()).unwrap();
    let (_, pins) = swirl();
    let weighed = |weight: f64| -> f64 {
        let some = pins.iter().enumerate();
        let pins: Pins =
            some.map(|(k, (&v, pin))| (v, if k == 0 { Pin::weighted(pin.target, weight) } else { *pin })).collect();
        let settings = Settings { relax_rounds: Some(20), ..one_to_one(Method::Continuation) };
        let (steps, ending) = steps_of(&mesh, settings, &pins).unwrap();
        assert_eq!(ending, Ending::Planar);
        let (v, pin) = pins.iter().find(|(_, pin)| !pin.kind.is_hard()).unwrap();
        steps.last().unwrap().candidate.solution.embedding[v].distance(pin.target)
    };
    let distances = [1e-3, 1.0, 100.0].map(weighed);
    assert!(distances.is_sorted_by(|a, b| a > b), "{distances:?}");
    assert!(distances[2] < 0.01 * distances[0], "{distances:?}");
}

#[test]
fn a_step_that_is_cancelled_anywhere_leaves_the_way_as_it_was() {
    let (mesh, pins) = swirl();
    let (whole, _) = steps_of(&mesh, one_to_one(Method::Continuation), &pins).unwrap();
    let mut run = Flattener::new(one_to_one(Method::Continuation), pins);
    let mut steps: Vec<Step> = Vec::new();
    for allowed in 0.. {
        if run.ending().is_some() {
            break;
        }
        let (flag, phases) = (AtomicBool::new(false), AtomicUsize::new(0));
        let report = |_: Phase| {
            if phases.fetch_add(1, Ordering::Relaxed) == allowed % 5 {
                flag.store(true, Ordering::Relaxed);
            }
        };
        match run.step(&mesh, Control::new(&flag, &report)) {
            Ok(step) => steps.push(step),
            Err(error) => {
                assert_eq!(error, SolveError::Cancelled);
                steps.push(run.step(&mesh, Control::unattended()).unwrap());
            }
        }
    }
    assert!(steps.iter().all(|step| step.verdict.planar) && steps.last().unwrap().unmet().is_empty());
    assert!(whole.last().unwrap().unmet().is_empty());
}

/// Remark on a step that contains a word.
fn remark_with<'a>(step: &'a Step, word: &str) -> &'a str {
    let note = step.candidate.note.as_deref().unwrap_or_default();
    note.split("; ").find(|remark| remark.contains(word)).expect("it is said")
}

fn from_cache(pins: Pins, cache: &SolverCache) -> Flattener {
    let settings = one_to_one(Method::Continuation);
    Flattener::with_options(Options { settings, pins, cache: Some(cache.clone()), ..Options::default() })
}

#[test]
fn the_planar_start_is_among_the_steps_and_serves_other_targets_on_the_mesh() {
    let (mesh, pins) = swirl();
    let (steps, _) = steps_of(&mesh, one_to_one(Method::Continuation), &pins).unwrap();
    let fitted = steps.iter().position(|step| step.candidate.planar_start.is_some()).unwrap();
    assert!(fitted > 0 && steps[fitted].candidate.stage == Stage::Continuation);
    assert!(steps[..fitted].iter().all(|step| step.is_of_planar_start() && !step.unmet().is_empty()));
    assert!(steps[fitted - 1].verdict.planar, "no end, as the constraints are not met");
    assert_message("continuation-constraints-ignored", remark_with(&steps[0], "ignored"));
    let kept = SolverCache { planar_start: steps[fitted].candidate.planar_start.clone(), prepared: None };
    let mut run = from_cache(pins, &kept);
    let mut shorter: Vec<Step> = Vec::new();
    run.finish(&mesh, Control::unattended(), |step| shorter.push(step)).unwrap();
    assert_eq!(shorter.len(), steps.len() - fitted);
    let is_same = |(a, b): (&Step, &Step)| a.candidate.solution.embedding == b.candidate.solution.embedding;
    assert!(shorter.iter().zip(&steps[fitted..]).all(is_same));
}

#[test]
fn a_ladder_without_constraints_finds_the_planar_start_of_those_with_some_to_the_last_bit() {
    let of = |example: BuiltIn| DiskMesh::try_from(example.mesh()).unwrap();
    let mut random = Random(5);
    let fingers = [4, 12].map(|rings| finger(rings, 6, &mut random));
    let meshes = fingers.into_iter().chain([of(BuiltIn::Dome), of(BuiltIn::Spiral), irregular_cube(3, &mut random)]);
    let mut is_followed = false;
    for mesh in &meshes.collect::<Vec<_>>() {
        let (alone, _) = steps_of(mesh, Settings::default(), &Pins::new()).unwrap();
        let found: Vec<&Step> = alone.iter().filter(|step| step.candidate.planar_start.is_some()).collect();
        assert_eq!(found.len(), 1, "found once");
        is_followed |= found[0].index + 1 < alone.len();
        let boundary = mesh.boundary_loop();
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].into_iter().enumerate();
        let pins: Pins = corners.map(|(k, at)| (boundary[k * boundary.len() / 4], Pin::hard(at))).collect();
        let fitted = |kept: &SolverCache| {
            let mut run = from_cache(pins.clone(), kept);
            let mut steps = std::iter::repeat_with(|| run.step(mesh, Control::unattended()).unwrap());
            let step = steps.by_ref().find(|step| step.candidate.planar_start.is_some()).unwrap();
            (step.index, step.candidate.solution.embedding.clone())
        };
        let kept = SolverCache { planar_start: found[0].candidate.planar_start.clone(), prepared: None };
        let [(at_once, with_it), (later, from_scratch)] = [&kept, &SolverCache::default()].map(fitted);
        assert!(at_once == 0 && later > 0 && with_it == from_scratch);
    }
    assert!(is_followed, "where only energy is lowered the start is before the end");
}

#[test]
fn a_planar_start_is_not_relaxed_before_the_constraints_are_met() {
    // A saddle whose free boundary crosses itself, so that some boundary vertices are bent to a circle.
    let mesh = DiskMesh::try_from(shaped(23, 23, |x, y| {
        let z = DVec2::new(x, y) / 11.5 - DVec2::ONE;
        z.extend(1.2 * z.length() * (3.0 * z.to_angle()).cos())
    }));
    let mesh = mesh.unwrap();
    let boundary = mesh.boundary_loop();
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].into_iter().enumerate();
    let pins: Pins = corners.map(|(k, at)| (boundary[k * boundary.len() / 4], Pin::hard(at))).collect();
    let (steps, ending) = steps_of(&mesh, Settings::default(), &pins).unwrap();
    let starts: Vec<&Step> = steps.iter().filter(|step| step.is_of_planar_start()).collect();
    let last = starts.last().expect("constraints are first ignored");
    assert!(last.verdict.planar && last.candidate.bent_vertices > 0, "{:?}", last.candidate.stage);
    assert!(starts.iter().all(|step| step.candidate.stage != Stage::Relax));
    let end = steps.last().unwrap();
    assert_eq!((ending, end.candidate.stage.clone()), (Ending::Planar, Stage::Relax));
    assert!(end.unmet().is_empty());
}

#[test]
fn a_ladder_goes_on_from_an_embedding_that_is_one_to_one_and_begins_afresh_where_it_is_not() {
    let (mesh, mut pins) = swirl();
    let (steps, _) = steps_of(&mesh, Settings::default(), &pins).unwrap();
    let before = &steps.last().unwrap().candidate.solution.embedding;
    let inner = *pins.keys().find(|v| mesh.boundary_place(**v).is_none()).unwrap();
    let way = 0.1 * before.bounds().extent() * DVec2::X;
    pins.insert(inner, Pin::hard(before[inner] + way));
    let run = |from: &Embedding| {
        let mut steps: Vec<Step> = Vec::new();
        let mut run = Flattener::new(Settings::default(), pins.clone()).continue_from(from);
        let ending = run.finish(&mesh, Control::unattended(), |step| steps.push(step)).unwrap();
        assert_eq!((ending, steps.last().unwrap().unmet()), (Ending::Planar, Vec::new()));
        steps
    };
    let on = run(before);
    assert!(on.iter().all(|step| step.verdict.planar && !step.is_of_planar_start()));
    assert_eq!(on[0].candidate.stage, Stage::Continuation);
    assert!(on[0].max_move.unwrap() < 3.0 * way.length(), "{:?}", on[0].max_move);
    let mut folded = before.clone();
    folded[inner] += 10.0 * way;
    let mut said = Vec::new();
    for bad in [folded, Embedding::default()] {
        let from_scratch = run(&bad);
        assert!(from_scratch[0].candidate.stage != Stage::Continuation && !from_scratch[0].is_continued);
        said.push(remark_with(&from_scratch[0], "restarted").to_owned());
    }
    assert_message("continuation-from-scratch", &said.join("\n"));
    // Two pins only fix position, size and rotation, and other methods do not use continuation.
    let two: Pins = pins.iter().take(2).map(|(&v, pin)| (v, *pin)).collect();
    for (settings, pins) in [(Settings::default(), two), (one_to_one(Method::Natural), pins.clone())] {
        let step = Flattener::new(settings, pins).continue_from(before).step(&mesh, Control::unattended()).unwrap();
        assert_eq!(step.candidate.stage, Stage::Natural);
    }
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let (mesh, pins) = swirl();
    let [a, b] = [(); 2].map(|()| steps_of(&mesh, Settings::default(), &pins).unwrap().0);
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(&b).all(|(a, b)| a.candidate.solution.embedding == b.candidate.solution.embedding));
}

#[test]
fn without_leave_for_new_vertices_what_cannot_be_met_is_named_and_the_rest_is_planar() {
    let mesh = DiskMesh::try_from(grid(4, 4)).unwrap();
    let face = mesh.face(mesh.faces().nth(12).unwrap());
    let corners = face.map(|v| mesh.position(v).truncate());
    let turned = [(face[0], corners[1]), (face[1], corners[0]), (face[2], corners[2])];
    let pins: Pins = turned.into_iter().map(|(v, target)| (v, Pin::hard(target))).collect();
    let mut run = Flattener::new(Settings { new_vertices: false, ..Settings::default() }, pins.clone());
    let mut last = None;
    let error = run.finish(&mesh, Control::unattended(), |step| last = Some(step)).unwrap_err();
    assert_eq!(error, SolveError::Unmet);
    assert_eq!(run.ending(), Some(Ending::Unmet));
    let last = last.unwrap();
    assert!(last.verdict.planar && !last.unmet().is_empty() && last.candidate.refinement.is_none());
    let (steps, ending) = steps_of(&mesh, Settings::default(), &pins).unwrap();
    assert_eq!((ending, steps.last().unwrap().unmet()), (Ending::Planar, Vec::new()));
    assert!(steps.last().unwrap().candidate.refinement.is_some());
}

#[test]
fn targets_that_nearly_coincide_are_an_error_that_names_them() {
    let mesh = DiskMesh::try_from(grid(4, 4)).unwrap();
    let places = [DVec2::ZERO, DVec2::new(1e-12, 0.0), DVec2::ONE];
    let pins: Pins = places.iter().enumerate().map(|(v, &z)| (VertexId::from_index(6 * v), Pin::hard(z))).collect();
    let error = steps_of(&mesh, one_to_one(Method::Continuation), &pins).unwrap_err();
    assert_eq!(error, SolveError::TargetsTooNear { first: VertexId::new(0), second: VertexId::new(6) });
}

#[test]
fn three_pinned_corners_on_a_line_are_met_by_new_vertices() {
    let mesh = DiskMesh::try_from(grid(3, 3)).unwrap();
    let face = mesh.face(mesh.faces().nth(8).unwrap());
    let pins: Pins = face.into_iter().zip([8.0, 10.0, 40.0]).map(|(v, x)| (v, Pin::hard(DVec2::new(x, 0.0)))).collect();
    let (steps, ending) = steps_of(&mesh, Settings::default(), &pins).unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(steps.last().unwrap().candidate.refinement.is_some() && steps.last().unwrap().unmet().is_empty());
}

#[test]
fn pins_that_no_continuation_reaches_do_not_keep_it_busy_for_ever() {
    let mesh = DiskMesh::try_from(grid(3, 3)).unwrap();
    let face = mesh.face(mesh.faces().nth(8).unwrap());
    let pins: Pins =
        face.into_iter().zip([30.0, 49.0, 45.0]).map(|(v, x)| (v, Pin::hard(DVec2::new(x, 0.0)))).collect();
    let mut last = None;
    let mut run = Flattener::new(one_to_one(Method::Continuation), pins);
    let error = run.finish(&mesh, Control::unattended(), |step| last = Some(step)).unwrap_err();
    assert_eq!(error, SolveError::Unmet);
    let last = last.unwrap();
    // The result does not keep what was crushed in vain.
    assert!(last.verdict.planar && last.candidate.progress.unwrap().energy < 100.0, "{:?}", last.candidate.progress);
}

#[test]
fn targets_far_from_the_origin_or_at_any_scale_are_met() {
    let (mesh, pins) = swirl();
    for (scale, offset) in [(1.0, 1e6), (1e-9, 0.0), (1e100, 0.0), (1e-100, 0.0)] {
        let moved = |pin: &Pin| Pin::hard(pin.target * scale + offset);
        let pins: Pins = pins.iter().map(|(&v, pin)| (v, moved(pin))).collect();
        let (steps, ending) = steps_of(&mesh, Settings::default(), &pins).unwrap();
        assert_eq!(ending, Ending::Planar, "{scale} {offset}");
        assert!(steps.last().unwrap().unmet().is_empty());
    }
}

#[test]
fn pins_that_are_in_each_others_way_pass_around_each_other() {
    let (mesh, _) = swirl();
    let (steps, _) = steps_of(&mesh, Settings::default(), &Pins::new()).unwrap();
    let flat = &steps.last().unwrap().candidate.solution.embedding;
    // Two neighbours around the middle swap places head-on; the four boundary pins stay.
    let (_, pins) = swirl();
    let inner: Vec<VertexId> = pins.keys().copied().filter(|&v| mesh.boundary_place(v).is_none()).collect();
    let mut pins: Pins = pins.into_iter().filter(|(v, _)| mesh.boundary_place(*v).is_some()).collect();
    pins.insert(inner[0], Pin::hard(flat[inner[2].index()]));
    pins.insert(inner[2], Pin::hard(flat[inner[0].index()]));
    let (steps, ending) = steps_of(&mesh, one_to_one(Method::Continuation), &pins).unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(steps.iter().all(|step| step.verdict.planar));
}
