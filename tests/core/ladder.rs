//! The ladder (`auto`): it ends planar on every disk, whatever the first rung was given.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use freebound::examples::Example;
use freebound::mesh::{DiskMesh, TriMesh, VertexId};
use freebound::solver::{
    Choice as _, Control, Embedding, Ending, Family, Ladder, Method, Phase, Pin, Pins, Settings, SolveError, Step,
    hard_pins, verdict,
};
use glam::DVec2;

use crate::common::corpus_disks;
use crate::makers::{Random, disk};
use crate::shapes::{finger, interior_pair};

const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

fn steps_of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Vec<Step> {
    let mut steps = Vec::new();
    Ladder::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

/// Pins on two vertices, at their distance in space.
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

#[test]
fn auto_ends_planar_on_every_disk_of_the_corpus() {
    for entry in corpus_disks() {
        let mesh = entry.disk();
        let steps = steps_of(&mesh, Settings::default(), &Pins::new());
        let last = steps.last().unwrap();
        println!("{}: {} steps, {}", entry.file, steps.len(), last.rung.name());
        assert!(last.verdict.planar, "{}: {}", entry.file, last.verdict.summary());
        assert!(!last.verdict.mirrored);
    }
}

#[test]
fn auto_ends_planar_from_any_two_pins_and_any_family() {
    let mut random = Random(0xadd);
    let corpus = corpus_disks();
    let small = corpus.iter().map(|entry| (entry.file.clone(), entry.disk())).filter(|(_, m)| m.face_count() < 6_000);
    let built_in = Example::ALL.map(|example| (example.name().to_owned(), disk(example.mesh())));
    for (name, mesh) in built_in.into_iter().chain(small) {
        for pair in [boundary_pair(&mesh, &mut random), interior_pair(&mesh, &mut random)] {
            let pins = pins_on(&mesh, pair);
            for family in FAMILIES {
                let steps = steps_of(&mesh, Settings::new(Method::Auto, family), &pins);
                let last = steps.last().unwrap();
                assert!(last.verdict.planar, "{name}, {family}, pins {pair:?}: {}", last.verdict.summary());
                assert!(verdict(&mesh, &last.solution.embedding).planar);
                for (v, target) in &pins {
                    assert_eq!(last.solution.embedding[v], target.target, "{name}: pins are met to the last bit");
                }
            }
        }
    }
}

#[test]
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

#[test]
fn a_free_boundary_is_looked_for_before_one_is_bent() {
    let Some(entry) = corpus_disks().into_iter().find(|entry| entry.file == "bunny_disk.obj") else { return };
    let mesh = entry.disk();
    let mut random = Random(94);
    let loops = |steps: &Vec<Step>| !steps[0].has_simple_boundary();
    let mut tries = (0..20).map(|_| pins_on(&mesh, boundary_pair(&mesh, &mut random)));
    let steps = tries
        .find_map(|pins| Some(steps_of(&mesh, Settings::new(Method::Auto, Family::Wachspress), &pins)).filter(loops))
        .expect("for some pins these weights cross the boundary");
    let last = steps.last().unwrap();
    assert!(last.verdict.planar && !last.has_convex_boundary());
    assert!(steps.iter().any(|step| step.note.as_ref().is_some_and(|note| note.contains("started again"))));
}

#[test]
fn a_singular_first_rung_is_noted_and_stepped_over() {
    let Some(entry) = corpus_disks().into_iter().find(|entry| entry.file == "maze.obj") else { return };
    let mesh = entry.disk();
    let alone = Ladder::new(Settings::new(Method::Natural, Family::Wachspress), Pins::new()).finish(
        &mesh,
        Control::unattended(),
        |_| (),
    );
    assert!(matches!(alone, Err(SolveError::Singular { .. })), "{alone:?}");
    let steps = steps_of(&mesh, Settings::new(Method::Auto, Family::Wachspress), &Pins::new());
    let note = steps[0].note.clone().unwrap_or_default();
    assert!(note.contains("singular") && note.contains("started again"), "{note}");
    assert!(steps.last().unwrap().verdict.planar);
}

#[test]
fn what_the_user_got_wrong_is_an_error_and_no_rung_hides_it() {
    let mesh = disk(Example::Dome.mesh());
    let twice = hard_pins([(VertexId::new(1), DVec2::ONE), (VertexId::new(2), DVec2::ONE)]);
    let outcome = Ladder::new(Settings::default(), twice).step(&mesh, Control::unattended());
    assert!(matches!(outcome, Err(SolveError::CoincidentPins { .. })));
    let uniform =
        Ladder::new(Settings::new(Method::Auto, Family::Uniform), Pins::new()).step(&mesh, Control::unattended());
    assert!(matches!(uniform, Err(SolveError::FamilyNotApplicable { .. })));
}

#[test]
fn constraints_are_iterated_on_and_then_met_one_to_one_but_no_boundary_is_bent_for_them() {
    let mesh = disk(Example::Dome.mesh());
    let mut pins = Pins::new();
    let boundary = mesh.boundary_loop();
    for k in 0..5 {
        // Five places of a pentagram: a natural boundary has to cross itself.
        let v = boundary[k * boundary.len() / 5];
        pins.insert(v, Pin::hard(DVec2::from_angle(2.0 * std::f64::consts::TAU * k as f64 / 5.0) * 10.0));
    }
    let mut run = Ladder::new(Settings { max_steps: Some(4), ..Settings::default() }, pins.clone());
    let mut steps = Vec::new();
    let ending = run.finish(&mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    assert_eq!(ending, Ending::Planar);
    let rungs: Vec<Method> = steps.iter().map(|step| step.rung).collect();
    let tried = steps.iter().position(Step::is_of_planar_start).unwrap();
    assert!(rungs[0] == Method::Natural && tried > 1 && rungs[1..tried].iter().all(|&rung| rung == Method::Iterate));
    assert!(!rungs.contains(&Method::VirtualBoundary));
    let is_met = |step: &Step| pins.iter().all(|(v, at)| step.solution.embedding[v] == at.target);
    assert!(steps[..tried].iter().all(is_met) && steps.last().is_some_and(|step| step.verdict.planar && is_met(step)));
}

/// A run whose every step is first cancelled at each of its phases in turn, then let through.
fn disturbed(mesh: &DiskMesh, mut run: Ladder) -> Vec<Step> {
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

#[test]
fn a_step_that_is_cancelled_leaves_the_run_as_it_was() {
    let cube = disk(Example::Cube.mesh());
    let pins = pins_on(&cube, interior_pair(&cube, &mut Random(3)));
    let mut cases = vec![(cube, Settings::new(Method::Auto, Family::Wachspress), pins)];
    // Runs that start again, and one that bends the boundary.
    for (file, family) in [("maze.obj", Family::MeanValue), ("cow_seamster.obj", Family::MeanValue)] {
        if let Some(entry) = corpus_disks().into_iter().find(|entry| entry.file == file) {
            cases.push((
                entry.disk(),
                Settings { max_steps: Some(2), ..Settings::new(Method::Auto, family) },
                Pins::new(),
            ));
        }
    }
    for (mesh, settings, pins) in cases {
        let undisturbed = steps_of(&mesh, settings, &pins);
        let found = disturbed(&mesh, Ladder::new(settings, pins));
        let told = |steps: &[Step]| -> Vec<(usize, Method, Option<String>, Embedding)> {
            let told = |s: &Step| (s.bent_vertices, s.rung, s.note.clone(), s.solution.embedding.clone());
            steps.iter().map(told).collect()
        };
        assert!(told(&found) == told(&undisturbed), "{} faces", mesh.face_count());
    }
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let mesh = disk(Example::Cube.mesh());
    let settings = Settings::new(Method::Auto, Family::MeanValue);
    let bits = || -> Vec<Embedding> {
        steps_of(&mesh, settings, &Pins::new()).into_iter().map(|step| step.candidate.solution.embedding).collect()
    };
    assert_eq!(bits(), bits());
}

#[test]
fn a_virtual_boundary_refuses_constraints_and_says_what_to_choose() {
    let mesh = disk(Example::Face.mesh());
    let boundary = mesh.boundary_loop();
    let pins = hard_pins((0..3).map(|k| (boundary[7 * k], DVec2::from_angle(k as f64))));
    let outcome =
        Ladder::new(Settings::new(Method::VirtualBoundary, Family::Conformal), pins).step(&mesh, Control::unattended());
    assert_eq!(outcome.err(), Some(SolveError::TooManyPins { method: "virtual-boundary", count: 3, most: 2 }));
}

#[test]
fn every_ladder_ends_however_far_apart_the_numbers_are() {
    // Faces squeezed far beyond what 64 bits can tell apart, and a similarity that takes them farther still.
    let mesh = finger(120, 8, &mut Random(2));
    let boundary = mesh.boundary_loop();
    let far = hard_pins([(boundary[0], DVec2::ZERO), (boundary[4], DVec2::new(1e61, 0.0))]);
    for (pins, limit) in [(Pins::new(), 200), (far, 200)] {
        let mut run = Ladder::new(Settings { max_steps: Some(5), ..Settings::default() }, pins);
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
    let fan = crate::makers::fan(3);
    let triangle = TriMesh::new(fan.positions[1..].to_vec(), &[[0, 1, 2]]);
    let strip = crate::makers::grid(6, 1);
    for mesh in [triangle, fan, strip] {
        let mesh = DiskMesh::try_from(mesh).unwrap();
        for family in FAMILIES {
            let mut run = Ladder::new(Settings::new(Method::Auto, family), Pins::new());
            let mut planar = false;
            run.finish(&mesh, Control::unattended(), |step| planar = step.verdict.planar).unwrap();
            assert!(planar, "{} faces, {family}", mesh.face_count());
        }
    }
}

#[test]
fn every_method_can_be_taken_on_by_hand() {
    let mesh = disk(Example::Cube.mesh());
    let convex = Method::Convex(freebound::solver::BoundaryShape::Circle);
    for method in [convex, Method::Lscm, Method::Levy, Method::Natural, Method::VirtualBoundary] {
        let mut run = Ladder::new(Settings::new(method, Family::MeanValue), Pins::new());
        run.finish(&mesh, Control::unattended(), |_| ()).unwrap();
        let further = run.step(&mesh, Control::unattended()).unwrap();
        assert_eq!(further.rung, Method::Iterate, "after {method:?}");
    }
}

#[test]
fn a_proof_that_is_stopped_is_all_that_the_next_step_has_to_do() {
    let mesh = disk(Example::Cube.mesh());
    let settings = Settings::new(Method::Natural, Family::Conformal);
    let whole = Ladder::new(settings, Pins::new()).step(&mesh, Control::unattended()).unwrap();
    let (flag, mut run) = (AtomicBool::new(false), Ladder::new(settings, Pins::new()));
    let raise = |phase| flag.store(phase == Phase::Verify, Ordering::Relaxed);
    assert_eq!(run.step(&mesh, Control::new(&flag, &raise)).unwrap_err(), SolveError::Cancelled);
    assert_eq!((run.step_count(), run.ending()), (0, None));
    let phases = std::sync::Mutex::new(Vec::new());
    let listen = |phase| phases.lock().unwrap().push(phase);
    let step = run.step(&mesh, Control::new(&AtomicBool::new(false), &listen)).unwrap();
    assert_eq!(phases.into_inner().unwrap(), [Phase::Verify]);
    assert_eq!(step.verdict, whole.verdict);
    let bits = |step: &Step| -> Vec<[u64; 2]> {
        step.solution.embedding.iter().map(|z| z.to_array().map(f64::to_bits)).collect()
    };
    assert_eq!(bits(&step), bits(&whole));
}
