//! Placing never folds, and `auto` continues until the map is usable: on disks so deep that all rounding matters.

use freebound_core::bijective::schnyder;
use freebound_core::flatten::{Ending, FlattenError, Options, Step, flatten};
use freebound_core::geom::{Bounds, PictureFrame, VAxis};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::{Fit, Outcome, Problem, Target, Targets};
use freebound_core::problem::{Control, GaugeSize, Method, Settings, Stage};
use freebound_core::verify::{is_planar, verdict};
use glam::DVec2;
use proptest::prelude::*;

use freebound_testkit::{Random, assert_message, disk, fan, grid, hand, stacked, tube};

/// Aspect ratios from a tall picture to a wide one.
const ASPECTS: [f64; 7] = [1.0 / 9.0, 0.3, 0.7, 1.0, 1.1, 16.0 / 9.0, 16.0];

/// Flattening for a picture, by `auto`.
fn on_picture(aspect: f64, targets: Targets) -> Problem {
    let frame = PictureFrame { aspect, v_axis: VAxis::Up };
    let [low, high] = frame.corners();
    let settings = Settings { size: GaugeSize::Within(Bounds { low, high }), ..Settings::default() };
    Problem { settings, frame, targets, shaped: None }
}

fn steps_of(mesh: &DiskMesh, problem: &Problem) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = problem.flattener().finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    (steps, ending)
}

/// Asserts that the last step is planar as written, in 64 bits and in 32, with every pin met. Returns the steps.
fn assert_proved(name: &str, mesh: &DiskMesh, problem: &Problem) -> Vec<Step> {
    let (steps, ending) = steps_of(mesh, problem);
    let last = steps.last().expect("a ladder gives steps");
    assert_eq!(ending, Ending::Planar, "{name}: {}, {:?}", last.verdict.summary(), last.candidate.note);
    let outcome = Outcome::new(mesh, problem.clone(), last.clone());
    let (coordinates, _, found) = outcome.output(mesh, Fit::Unit);
    assert_eq!(found, verdict(last.candidate.mesh(mesh), &coordinates), "{name}");
    assert!(found.planar && !found.mirrored, "{name}: {}", found.summary());
    assert!(found.planar_in_f32, "{name}, {} steps, {:?}", steps.len(), last.candidate.note);
    for (&vertex, target) in &problem.targets {
        assert_eq!(coordinates[vertex], target.uv, "{name}: pins have their own numbers");
    }
    steps
}

/// Targets of `count` vertices, spread over the mesh and over the picture.
fn targets_on(mesh: &DiskMesh, count: usize, random: &mut Random) -> Targets {
    let vertex = |k: usize| VertexId::from_index(k * mesh.vertex_count() / count);
    (0..count).map(|k| (vertex(k), Target::hard(DVec2::new(random.unit(), random.unit())))).collect()
}

#[test]
fn a_tube_is_planar_on_every_picture_and_with_one_pin_or_two() {
    let mesh = disk(tube(3, 20));
    let mut random = Random(5);
    for aspect in ASPECTS {
        for count in 0..=2 {
            let targets = if count == 0 { Targets::new() } else { targets_on(&mesh, count, &mut random) };
            assert_proved(&format!("aspect {aspect}, {count} pins"), &mesh, &on_picture(aspect, targets));
        }
    }
}

#[test]
fn a_pin_at_a_tenth_and_a_pin_far_away_keep_a_deep_disk_planar() {
    let mesh = disk(stacked(53, 3, &mut Random(11)));
    for (at, is_near) in [([0.1, 0.1], true), ([1e9, -7e8], false)] {
        let targets: Targets = [(VertexId::new(0), Target::hard(DVec2::from(at)))].into();
        let problem = Problem { targets, ..Problem::default() };
        let (steps, ending) = steps_of(&mesh, &problem);
        let last = steps.last().unwrap();
        assert_eq!(ending, Ending::Planar);
        assert_eq!(last.candidate.solution.embedding[0], DVec2::from(at));
        assert!(is_planar(&mesh, &last.candidate.solution.embedding));
        // At this distance 32 bits have no digits left for a disk of this size.
        assert_eq!(last.verdict.planar_in_f32, is_near);
    }
}

#[test]
fn what_is_on_one_line_as_written_is_not_taken_for_planar() {
    // Three corners of a face on a slanted line of the picture; with this aspect they turn left in the plane.
    let mesh = disk(fan(6));
    let line = [DVec2::new(0.1, 0.1), DVec2::new(0.2, 0.2), DVec2::new(0.3, 0.3)];
    let face = mesh.face(freebound_core::mesh::FaceId::new(0));
    let turns_left = |aspect: f64| {
        let frame = PictureFrame { aspect, v_axis: VAxis::Up };
        let [a, b, c] = line.map(|uv| frame.plane_from_uv(uv));
        (b - a).perp_dot(c - a) != 0.0
    };
    let aspect = (1..1000).map(|k| 1.0 + f64::from(k) / 997.0).find(|&aspect| turns_left(aspect)).expect("some does");
    let targets: Targets = face.into_iter().zip(line.map(Target::hard)).collect();
    let problem = on_picture(aspect, targets);
    let (steps, _) = steps_of(&mesh, &problem);
    let last = steps.last().unwrap();
    let (.., written) = Outcome::new(&mesh, problem, last.clone()).output(&mesh, Fit::Unit);
    assert_eq!(last.verdict.planar, written.planar, "the ladder decides by what is written");
    assert!(written.planar, "{}, {:?}", written.summary(), last.candidate.note);
}

#[test]
fn a_finer_and_finer_finger_holds_in_32_bits_and_keeps_its_natural_step() {
    for along in [6, 14, 24] {
        let mesh = disk(tube(12, along));
        let steps = assert_proved(&format!("a finger of {along} rings"), &mesh, &Problem::default());
        let natural = &steps[0];
        assert_eq!(natural.candidate.stage, Stage::Natural);
        let goes_on = steps.len() > 1;
        let relaxes = |step: &Step| step.candidate.stage == Stage::Relax && step.candidate.note.is_some();
        let is_relaxed = steps.iter().any(relaxes);
        assert_eq!(goes_on, is_relaxed || !natural.verdict.planar, "{along} rings, {} steps", steps.len());
    }
}

#[test]
fn auto_relaxes_a_map_that_serves_nobody_and_not_where_the_user_says_no() {
    let mesh = disk(tube(12, 14));
    let (steps, _) = steps_of(&mesh, &Problem::default());
    let energy = |step: &Step| step.candidate.progress.expect("an energy").energy;
    assert!(energy(&steps[0]) > 20.0 && energy(steps.last().unwrap()) < energy(&steps[0]));
    let settings = Settings { relax_rounds: Some(0), ..Settings::default() };
    let (alone, _) = steps_of(&mesh, &Problem { settings, ..Problem::default() });
    assert_eq!(alone.len(), 1);
    assert_eq!(alone[0].candidate.solution.embedding, steps[0].candidate.solution.embedding);
    // A flat sheet needs none.
    assert_eq!(steps_of(&disk(grid(6, 4)), &Problem::default()).0.len(), 1);
}

#[test]
fn deep_disks_are_planar_with_eight_pins() {
    let mut random = Random(8);
    for (name, mesh, aspect) in [("stacked", stacked(43, 3, &mut Random(2)), 0.3), ("a hand", hand(2), 16.0 / 9.0)] {
        let mesh = disk(mesh);
        let targets = targets_on(&mesh, 8, &mut random);
        assert_proved(&format!("{name}, aspect {aspect}"), &mesh, &on_picture(aspect, targets));
    }
}

#[test]
#[ignore = "minutes: `cargo test --release --test core -- --ignored deep_disks`"]
fn large_deep_disks_are_planar_on_every_picture_with_up_to_eight_pins() {
    let mut random = Random(3);
    let tubes = [(3, 46), (5, 80), (8, 60), (12, 140)].map(|(a, l)| (format!("tube {a} x {l}"), disk(tube(a, l))));
    let stacks = [43, 120, 500, 2000].map(|n| (format!("stacked {n}"), disk(stacked(n, 3, &mut random))));
    for (name, mesh) in tubes.into_iter().chain(stacks).chain([("a hand".to_owned(), disk(hand(40)))]) {
        for aspect in ASPECTS {
            for count in [0, 1, 2, 8] {
                let targets = if count == 0 { Targets::new() } else { targets_on(&mesh, count, &mut random) };
                assert_proved(&format!("{name}, aspect {aspect}, {count} pins"), &mesh, &on_picture(aspect, targets));
            }
        }
    }
}

#[test]
fn the_easy_call_gives_what_is_proved() {
    for mesh in [disk(tube(3, 12)), disk(stacked(43, 3, &mut Random(7)))] {
        let step = flatten(&mesh, &Options::default()).unwrap();
        assert!(
            is_planar(&mesh, &step.candidate.solution.embedding) && step.verdict.planar && step.verdict.planar_in_f32
        );
    }
}

#[test]
fn the_easy_call_names_why_nothing_is_proved() {
    let mesh = disk(tube(3, 46));
    let natural =
        Options { settings: Settings { method: Method::Natural, ..Settings::default() }, ..Options::default() };
    let error = flatten(&mesh, &natural).unwrap_err();
    assert!(matches!(&error, FlattenError::NotPlanar(step) if !step.verdict.planar), "{error}");
    assert_message("placing-not-planar", error.to_string().rsplit("; ").next().unwrap_or_default());
    // Three pins on one point.
    let pins = freebound_core::problem::hard_pins([0, 5, 9].map(|v| (VertexId::new(v), DVec2::ZERO)));
    assert!(matches!(flatten(&mesh, &Options { pins, ..Options::default() }), Err(FlattenError::Solve(_))));
}

#[test]
fn a_deep_disk_with_one_pin_holds_in_32_bits_far_along_a_wide_picture() {
    let mut random = Random(16_277_646_870_120_480_218);
    let mesh = disk(stacked(28, 4, &mut random));
    let targets = targets_on(&mesh, 1, &mut random);
    assert_proved("28 vertices, 1 pin", &mesh, &on_picture(13.068_502_586_554_89, targets));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10))]

    /// Any stacked triangulation, any picture, up to two pins.
    #[test]
    fn random_deep_disks_are_planar_wherever_they_are_placed(
        (count, newest, seed) in (5_usize..50, 1_usize..12, any::<u64>()),
        aspect in 0.11_f64..16.0,
        pins in 0_usize..3,
    ) {
        let mut random = Random(seed);
        let mesh = disk(stacked(count, newest, &mut random));
        let targets = if pins == 0 { Targets::new() } else { targets_on(&mesh, pins, &mut random) };
        assert_proved(&format!("{count} {newest} {seed}, {pins} pins"), &mesh, &on_picture(aspect, targets));
    }

    /// Any similarity of the grid drawing: the drawing is planar, hence so is its placed image.
    #[test]
    fn random_tubes_are_planar_wherever_they_are_placed(
        around in 3_u32..8,
        along in 1_u32..14,
        aspect in 0.11_f64..16.0,
        pins in 0_usize..3,
        seed in any::<u64>(),
    ) {
        let mesh = disk(tube(around, along));
        prop_assert!(is_planar(&mesh, &schnyder(&mesh)));
        let targets = if pins == 0 { Targets::new() } else { targets_on(&mesh, pins, &mut Random(seed)) };
        assert_proved(&format!("{around} x {along}, {pins} pins"), &mesh, &on_picture(aspect, targets));
    }
}
