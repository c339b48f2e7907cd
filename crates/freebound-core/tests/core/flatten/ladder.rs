//! The automatic strategy (`auto`) ends planar on every disk, whatever the input of its first stage.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, Phase, Pin, Pins, Settings, SolveError, Stage, hard_pins,
};
use freebound_core::verify::verdict;
use freebound_testkit::BuiltIn;
use glam::DVec2;

use crate::linear::shapes::{finger, interior_pair};
use freebound_testkit::{Entry, Random, corpus_disks, corpus_entry, corpus_test, data_disks, disk};

const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

fn steps_of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Vec<Step> {
    let mut steps = Vec::new();
    Flattener::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

/// Pins two vertices at their distance in space.
fn pins_on(mesh: &DiskMesh, [a, b]: [VertexId; 2]) -> Pins {
    hard_pins([(a, DVec2::ZERO), (b, DVec2::new(mesh.position(a).distance(mesh.position(b)), 0.0))])
}

fn boundary_pair(mesh: &DiskMesh, random: &mut Random) -> [VertexId; 2] {
    let boundary = mesh.boundary_loop();
    let count = u32::try_from(boundary.len()).unwrap();
    let first = random.below(count);
    let second = (first + 1 + random.below(count - 1)) % count;
    [first, second].map(|place| boundary[place as usize])
}

fn assert_auto_ends_planar_on_every_disk(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        let steps = steps_of(&mesh, Settings::default(), &Pins::new());
        let last = steps.last().unwrap();
        println!("{}: {} steps, {}", entry.file, steps.len(), last.candidate.stage.name());
        assert!(last.verdict.planar, "{}: {}", entry.file, last.verdict.summary());
        assert!(!last.verdict.mirrored);
    }
}

#[test]
fn auto_ends_planar_on_every_disk_of_tests_data() {
    assert_auto_ends_planar_on_every_disk(data_disks());
}

corpus_test! {
    fn auto_ends_planar_on_every_disk_of_the_corpus() {
        assert_auto_ends_planar_on_every_disk(corpus_disks());
    }
}

fn assert_auto_ends_planar_from_any_two_pins_and_any_family(meshes: Vec<(String, DiskMesh)>) {
    let mut random = Random(0xadd);
    for (name, mesh) in meshes {
        for pair in [boundary_pair(&mesh, &mut random), interior_pair(&mesh, &mut random)] {
            let pins = pins_on(&mesh, pair);
            for family in FAMILIES {
                let steps = steps_of(&mesh, Settings::new(Method::Auto, family), &pins);
                let last = steps.last().unwrap();
                assert!(last.verdict.planar, "{name}, {family}, pins {pair:?}: {}", last.verdict.summary());
                assert!(verdict(&mesh, &last.candidate.solution.embedding).planar);
                for (v, target) in &pins {
                    assert_eq!(
                        last.candidate.solution.embedding[v], target.target,
                        "{name}: pins are met to the last bit"
                    );
                }
            }
        }
    }
}

#[test]
fn auto_ends_planar_from_any_two_pins_and_any_family() {
    let built_in = BuiltIn::ALL.map(|example| (example.name().to_owned(), disk(example.mesh())));
    assert_auto_ends_planar_from_any_two_pins_and_any_family(built_in.into());
}

corpus_test! {
    fn auto_ends_planar_from_any_two_pins_and_any_family_in_the_corpus() {
        let disks = corpus_disks();
        let small = disks.iter().map(Entry::named_disk).filter(|(_, mesh)| mesh.face_count() < 6_000);
        assert_auto_ends_planar_from_any_two_pins_and_any_family(small.collect());
    }
}

corpus_test! {
    #[ignore = "1200 runs take minutes: `cargo bench --bench ladder` prints their table"]
    fn auto_ends_planar_in_all_twelve_hundred_runs() {
        let mut random = Random(0xadd2);
        for entry in corpus_disks() {
            let mesh = entry.disk();
            for _ in 0..20 {
                let pins = pins_on(&mesh, boundary_pair(&mesh, &mut random));
                for family in FAMILIES {
                    let steps = steps_of(&mesh, Settings::new(Method::Auto, family), &pins);
                    let last = steps.last().unwrap();
                    assert!(last.verdict.planar, "{}, {family}, {pins:?}: {}", entry.file, last.verdict.summary());
                }
            }
        }
    }
}

/// True for a natural boundary with the default weights.
fn is_natural_by_default_weights(step: &Step) -> bool {
    step.candidate.stage == Stage::Natural && step.candidate.family == Family::default()
}

corpus_test! {
    fn a_free_boundary_is_looked_for_before_one_is_bent() {
        let mesh = corpus_entry("bunny_disk.obj").disk();
        let mut random = Random(94);
        let loops = |steps: &Vec<Step>| !steps[0].has_simple_boundary();
        let mut tries = (0..20).map(|_| pins_on(&mesh, boundary_pair(&mesh, &mut random)));
        let steps = tries
            .find_map(|pins| {
                Some(steps_of(&mesh, Settings::new(Method::Auto, Family::Wachspress), &pins)).filter(loops)
            })
            .expect("for some pins these weights cross the boundary");
        let last = steps.last().unwrap();
        assert!(last.verdict.planar && !last.candidate.has_convex_boundary());
        assert!(steps.iter().any(is_natural_by_default_weights));
    }
}

corpus_test! {
    fn a_singular_first_rung_is_noted_and_stepped_over() {
        let mesh = corpus_entry("maze.obj").disk();
        let alone = Flattener::new(Settings::new(Method::Natural, Family::Wachspress), Pins::new()).finish(
            &mesh,
            Control::unattended(),
            |_| (),
        );
        assert!(matches!(alone, Err(SolveError::Singular { .. })), "{alone:?}");
        let steps = steps_of(&mesh, Settings::new(Method::Auto, Family::Wachspress), &Pins::new());
        assert!(is_natural_by_default_weights(&steps[0]) && steps[0].candidate.note.is_some());
        assert!(steps.last().unwrap().verdict.planar);
    }
}

#[test]
fn what_the_user_got_wrong_is_an_error_and_no_rung_hides_it() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let twice = hard_pins([(VertexId::new(1), DVec2::ONE), (VertexId::new(2), DVec2::ONE)]);
    let outcome = Flattener::new(Settings::default(), twice).step(&mesh, Control::unattended());
    assert!(matches!(outcome, Err(SolveError::CoincidentPins { .. })));
    let uniform =
        Flattener::new(Settings::new(Method::Auto, Family::Uniform), Pins::new()).step(&mesh, Control::unattended());
    assert!(matches!(uniform, Err(SolveError::FamilyNotApplicable { .. })));
}

#[test]
fn constraints_are_iterated_on_and_then_met_one_to_one_but_no_boundary_is_bent_for_them() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let mut pins = Pins::new();
    let boundary = mesh.boundary_loop();
    for k in 0..5 {
        // Five points of a pentagram: a natural boundary must cross itself.
        let v = boundary[k * boundary.len() / 5];
        pins.insert(v, Pin::hard(DVec2::from_angle(2.0 * std::f64::consts::TAU * k as f64 / 5.0) * 10.0));
    }
    let mut run = Flattener::new(Settings { max_steps: Some(4), ..Settings::default() }, pins.clone());
    let mut steps = Vec::new();
    let ending = run.finish(&mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    assert_eq!(ending, Ending::Planar);
    let stages: Vec<Stage> = steps.iter().map(|step| step.candidate.stage.clone()).collect();
    let tried = steps.iter().position(Step::is_of_planar_start).unwrap();
    assert!(stages[0] == Stage::Natural && tried > 1 && stages[1..tried].iter().all(|stage| *stage == Stage::Iterate));
    assert!(!stages.contains(&Stage::VirtualBoundary));
    let is_met = |step: &Step| pins.iter().all(|(v, at)| step.candidate.solution.embedding[v] == at.target);
    assert!(steps[..tried].iter().all(is_met) && steps.last().is_some_and(|step| step.verdict.planar && is_met(step)));
}

/// Cancels every step at each of its phases in turn, then lets it finish.
fn disturbed(mesh: &DiskMesh, mut run: Flattener) -> Vec<Step> {
    let (mut found, mut allowed, mut cancelled): (Vec<Step>, _, _) = (Vec::new(), 0, 0);
    while run.ending().is_none() {
        let (flag, phases) = (AtomicBool::new(false), AtomicUsize::new(0));
        let report = |_: Phase| {
            if phases.fetch_add(1, Ordering::Relaxed) == allowed {
                flag.store(true, Ordering::Relaxed);
            }
        };
        match run.step(mesh, Control::new(&flag, &report)) {
            Ok(step) => {
                found.push(step);
                allowed = 0;
            }
            Err(error) => {
                assert_eq!(error, SolveError::Cancelled);
                (allowed, cancelled) = (allowed + 1, cancelled + 1);
            }
        }
    }
    assert!(cancelled > found.len(), "most steps were cancelled more than once");
    found
}

fn assert_cancelled_steps_leave_the_run_as_it_was(mesh: &DiskMesh, settings: Settings, pins: &Pins) {
    let undisturbed = steps_of(mesh, settings.clone(), pins);
    let found = disturbed(mesh, Flattener::new(settings, pins.clone()));
    let told = |steps: &[Step]| -> Vec<(usize, Stage, Option<String>, Embedding)> {
        let told = |s: &Step| {
            let c = &s.candidate;
            (c.bent_vertices, c.stage.clone(), c.note.clone(), c.solution.embedding.clone())
        };
        steps.iter().map(told).collect()
    };
    assert!(told(&found) == told(&undisturbed), "{} faces", mesh.face_count());
}

#[test]
fn a_step_that_is_cancelled_leaves_the_run_as_it_was() {
    let cube = disk(BuiltIn::Cube.mesh());
    let pins = pins_on(&cube, interior_pair(&cube, &mut Random(3)));
    assert_cancelled_steps_leave_the_run_as_it_was(&cube, Settings::new(Method::Auto, Family::Wachspress), &pins);
}

corpus_test! {
    fn a_cancelled_step_leaves_runs_that_start_again_and_bend_the_boundary_as_they_were() {
        for file in ["maze.obj", "cow_seamster.obj"] {
            let settings = Settings { max_steps: Some(2), ..Settings::new(Method::Auto, Family::MeanValue) };
            assert_cancelled_steps_leave_the_run_as_it_was(&corpus_entry(file).disk(), settings, &Pins::new());
        }
    }
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let settings = Settings::new(Method::Auto, Family::MeanValue);
    let bits = || -> Vec<Embedding> {
        steps_of(&mesh, settings.clone(), &Pins::new())
            .into_iter()
            .map(|step| step.candidate.solution.embedding)
            .collect()
    };
    assert_eq!(bits(), bits());
}

#[test]
fn a_virtual_boundary_refuses_constraints_and_says_what_to_choose() {
    let mesh = disk(BuiltIn::Face.mesh());
    let boundary = mesh.boundary_loop();
    let pins = hard_pins((0..3).map(|k| (boundary[7 * k], DVec2::from_angle(k as f64))));
    let outcome = Flattener::new(Settings::new(Method::VirtualBoundary, Family::Conformal), pins)
        .step(&mesh, Control::unattended());
    assert_eq!(outcome.err(), Some(SolveError::TooManyPins { method: "Virtual boundary", count: 3, most: 2 }));
}

#[test]
fn every_ladder_ends_however_far_apart_the_numbers_are() {
    // Faces squeezed far beyond 64-bit precision, and a similarity that worsens it.
    let mesh = finger(120, 8, &mut Random(2));
    let boundary = mesh.boundary_loop();
    let far = hard_pins([(boundary[0], DVec2::ZERO), (boundary[4], DVec2::new(1e61, 0.0))]);
    for (pins, limit) in [(Pins::new(), 200), (far, 200)] {
        let mut run = Flattener::new(Settings { max_steps: Some(5), ..Settings::default() }, pins);
        let mut taken = 0;
        while run.ending().is_none() && taken < limit {
            taken += 1;
            if let Err(error) = run.step(&mesh, Control::unattended()) {
                println!("{error}");
                break;
            }
        }
        assert!(taken < limit, "it ends: {:?} after {taken}", run.ending());
    }
}

#[test]
fn small_disks_and_disks_without_inner_vertices_end_planar_too() {
    let fan = freebound_testkit::fan(3);
    let triangle = TriMesh::new(fan.positions[1..].to_vec(), &[[0, 1, 2]]);
    let strip = freebound_testkit::grid(6, 1);
    for mesh in [triangle, fan, strip] {
        let mesh = DiskMesh::try_from(mesh).unwrap();
        for family in FAMILIES {
            let mut run = Flattener::new(Settings::new(Method::Auto, family), Pins::new());
            let mut planar = false;
            run.finish(&mesh, Control::unattended(), |step| planar = step.verdict.planar).unwrap();
            assert!(planar, "{} faces, {family}", mesh.face_count());
        }
    }
}

#[test]
fn every_method_can_be_taken_on_by_hand() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let convex = Method::Convex(freebound_core::problem::BoundaryShape::Circle);
    for method in [convex, Method::Lscm, Method::Levy, Method::Natural, Method::VirtualBoundary] {
        let mut run = Flattener::new(Settings::new(method.clone(), Family::MeanValue), Pins::new());
        run.finish(&mesh, Control::unattended(), |_| ()).unwrap();
        let further = run.step(&mesh, Control::unattended()).unwrap();
        assert_eq!(further.candidate.stage, Stage::Iterate, "after {method:?}");
    }
}

#[test]
fn a_proof_that_is_stopped_is_all_that_the_next_step_has_to_do() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let settings = Settings::new(Method::Natural, Family::Conformal);
    let whole = Flattener::new(settings.clone(), Pins::new()).step(&mesh, Control::unattended()).unwrap();
    let (flag, mut run) = (AtomicBool::new(false), Flattener::new(settings, Pins::new()));
    let raise = |phase| flag.store(phase == Phase::Verify, Ordering::Relaxed);
    assert_eq!(run.step(&mesh, Control::new(&flag, &raise)).unwrap_err(), SolveError::Cancelled);
    assert_eq!((run.step_count(), run.ending()), (0, None));
    let phases = std::sync::Mutex::new(Vec::new());
    let listen = |phase| phases.lock().unwrap().push(phase);
    let step = run.step(&mesh, Control::new(&AtomicBool::new(false), &listen)).unwrap();
    assert_eq!(phases.into_inner().unwrap(), [Phase::Verify]);
    assert_eq!(step.verdict, whole.verdict);
    let bits = |step: &Step| -> Vec<[u64; 2]> {
        step.candidate.solution.embedding.iter().map(|z| z.to_array().map(f64::to_bits)).collect()
    };
    assert_eq!(bits(&step), bits(&whole));
}
