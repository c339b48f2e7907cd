//! Hostile numbers: results do not depend on scale, offset or order of magnitude, failures are named errors, and no
//! NaN is output.

use std::time::{Duration, Instant};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::{PictureFrame, VAxis};
use freebound_core::mesh::{DiskMesh, PolygonMesh, TriMesh, VertexId};
use freebound_core::pipeline::{Target, Targets, pins_in_plane};
use freebound_core::problem::{
    Control, Embedding, Family, GaugeSize, Method, NamedOption as _, Pin, PinKind, Pins, Settings, SolveError,
    hard_pins,
};
use freebound_core::verify::verdict;
use freebound_core::weights::equations::barycentric;
use freebound_io::{MeshFile, PinNotes, Texture, write_constraints, write_obj};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use serde_json::Value;

use super::program::{Program, argument, obj_text};
use freebound_testkit::{corpus_entry, corpus_test, disk, grid};

/// Time limit: a longer run on a dozen faces hangs, even on a busy machine.
const HANG: Duration = Duration::from_secs(30);

/// Methods that take pins as constraints.
const CONSTRAINED: [Method; 7] = [
    Method::Natural,
    Method::Lscm,
    Method::Levy,
    Method::Iterate,
    Method::Continuation,
    Method::Matchmaker,
    Method::Auto,
];

/// Bumpy sheet of 4 × 3 squares.
fn sheet() -> TriMesh {
    let mut mesh = grid(4, 3);
    for p in &mut mesh.positions {
        p.z = 0.5 * (1.3 * p.x).sin() * (0.9 * p.y).cos();
    }
    mesh
}

fn moved(mut mesh: TriMesh, place: impl Fn(DVec3) -> DVec3) -> TriMesh {
    mesh.positions.iter_mut().for_each(|p| *p = place(*p));
    mesh
}

/// Corners of the sheet with their targets, a trapezium in the unit square.
fn corners() -> [(VertexId, DVec2); 4] {
    let place = |v, x, y| (VertexId::new(v), DVec2::new(x, y));
    [place(0, 0.125, 0.0), place(4, 1.0, 0.25), place(19, 0.875, 0.75), place(15, 0.1, 0.7)]
}

fn steps_of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Result<Vec<Step>, SolveError> {
    let mut steps = Vec::new();
    Flattener::new(settings, pins.clone()).finish(mesh, Control::unattended(), |step| steps.push(step))?;
    Ok(steps)
}

fn last_of(mesh: &DiskMesh, method: &Method, pins: &Pins) -> Step {
    let steps = steps_of(mesh, Settings::new(method.clone(), Family::default()), pins);
    steps.unwrap_or_else(|error| panic!("{}: {error}", method.name())).pop().unwrap()
}

#[test]
fn targets_far_from_the_origin_are_no_matter() {
    let mesh = disk(sheet());
    // A power of two, so that all targets keep their digits.
    let far = DVec2::new(131_072.0, -262_144.0);
    let near = hard_pins(corners().map(|(v, z)| (v, (z * 1024.0).round() / 1024.0)));
    let pins = near.iter().map(|(&v, pin)| (v, Pin::hard(pin.target + far))).collect();
    for method in CONSTRAINED {
        let [here, there] = [&near, &pins].map(|pins| last_of(&mesh, &method, pins));
        assert!(there.unmet().is_empty(), "{}", method.name());
        assert_eq!(here.candidate.stage, there.candidate.stage, "{}: another rung", method.name());
        let off = here.candidate.solution.embedding.iter().zip(&there.candidate.solution.embedding);
        let off = off.map(|(a, b)| (*a + far - *b).abs().max_element()).fold(0.0, f64::max);
        // The spacing of numbers there is 2⁻³⁴; a solution near 0 is rounded to it once.
        assert!(off <= 2_f64.powi(-33), "{}: off by {off:e}", method.name());
    }
}

#[test]
fn targets_of_any_order_of_magnitude_give_the_same_map_to_the_last_bit() {
    let mesh = disk(sheet());
    // Without relaxation, which continues if a map is not planar in 32 bits: those end at 2^±149.
    let last_of = |mesh: &DiskMesh, method: Method, pins: &Pins| {
        let settings = Settings { relax_rounds: Some(0), ..Settings::new(method, Family::default()) };
        steps_of(mesh, settings, pins).unwrap().pop().unwrap()
    };
    for method in CONSTRAINED {
        let near = last_of(&mesh, method.clone(), &hard_pins(corners()));
        for exponent in [-900, -540, 532, 900] {
            let scale = 2_f64.powi(exponent);
            let far = last_of(&mesh, method.clone(), &hard_pins(corners().map(|(v, z)| (v, z * scale))));
            let back: Embedding = far.candidate.solution.embedding.iter().map(|z| *z / scale).collect();
            assert_eq!(back, near.candidate.solution.embedding, "{} at 2^{exponent}", method.name());
            assert!(
                far.unmet().is_empty() && far.verdict.planar == near.verdict.planar,
                "{} at 2^{exponent}",
                method.name()
            );
        }
    }
}

#[test]
fn meshes_of_any_order_of_magnitude_give_the_same_map_to_the_last_bit() {
    let near = disk(sheet());
    for exponent in [-1030, -990, -531, 530, 1015] {
        // Split into two factors, since a single power may be out of range.
        let half = 2_f64.powi(exponent / 2);
        let rest = 2_f64.powi(exponent - exponent / 2);
        let far = disk(moved(sheet(), |p| (64.0 * p).round() / 64.0 * half * rest));
        let near = disk(moved(near.mesh().clone(), |p| (64.0 * p).round() / 64.0));
        assert_eq!(far.position(VertexId::new(7)) * far.unit(), near.position(VertexId::new(7)) * half * rest);
        for method in CONSTRAINED {
            let pins = hard_pins(corners());
            let [a, b] = [&near, &far].map(|mesh| last_of(mesh, &method, &pins));
            assert_eq!(
                a.candidate.solution.embedding,
                b.candidate.solution.embedding,
                "{} at 2^{exponent}",
                method.name()
            );
        }
    }
}

#[test]
fn targets_at_the_end_of_the_range_of_numbers_are_met() {
    let mesh = disk(sheet());
    for scale in [1e160, 1e200, 1e300, 1e-300] {
        let pins = hard_pins(corners().map(|(v, z)| (v, (z - 0.4) * scale)));
        for method in CONSTRAINED {
            let start = Instant::now();
            let step = last_of(&mesh, &method, &pins);
            assert!(start.elapsed() < HANG, "{} at {scale:e}", method.name());
            assert!(step.unmet().is_empty(), "{} at {scale:e}", method.name());
        }
    }
}

#[test]
fn weights_of_any_order_of_magnitude_pull_as_far_as_weights_can() {
    let mesh = disk(sheet());
    let [a, b, c, d] = corners();
    let at = |weight| {
        let pin = |(v, z)| (v, Pin::weighted(z, weight));
        let step =
            last_of(&mesh, &Method::Natural, &[(a.0, Pin::hard(a.1)), (b.0, Pin::hard(b.1)), pin(c), pin(d)].into());
        [c, d].map(|(v, z)| step.candidate.solution.embedding[v].distance(z)).into_iter().fold(0.0, f64::max)
    };
    let free = at(1e-9);
    for weight in [1e-300, 1e-160, 1e-30] {
        assert!((at(weight) - free).abs() < 1e-9 * free, "{weight:e}");
    }
    for weight in [1e30, 1e160, 1e300] {
        assert!(at(weight) < 1e-9, "{weight:e}: {:e}", at(weight));
    }
}

#[test]
fn positions_far_from_the_origin_keep_all_their_digits() {
    let flat = |offset: f64| disk(moved(grid(9, 7), |p| p + offset * DVec3::new(1.0, -1.0, 1.0)));
    for power in [Family::CONFORMAL_POWER, 0.0, 2.0, 0.5] {
        let [near, far] =
            [flat(0.0), flat(2_f64.powi(40))].map(|mesh| barycentric(&mesh, power, Control::unattended()).unwrap());
        assert_eq!(near, far, "power {power}");
    }
}

corpus_test! {
    fn a_single_method_that_fails_ends_with_4_a_reason_and_a_hint_and_writes_nothing() {
        let entry = corpus_entry("maze.obj");
        let program = Program::new();
        let method = [
            "--method",
            "natural",
            "--family",
            "mean-value",
            "--treatment",
            "eliminate",
            "--pin",
            "0:0,0",
            "--pin",
            "1:1,0",
        ];
        let outputs = ["-o", "out.obj", "--svg", "out.svg", "--steps", "steps", "--report", "report.json"];
        let run = program.run(&[&["flatten", argument(&entry.path)], &method[..], &outputs].concat()).expect(4);
        let report: Value = serde_json::from_slice(&std::fs::read(program.path("report.json")).unwrap()).unwrap();
        let [kind, reason, hint] = ["kind", "message", "remedy"].map(|key| report["error"][key].as_str().unwrap());
        assert!(["singular", "residual-too-large"].contains(&kind), "{kind}");
        assert!(hint.contains("--method auto"), "{hint}");
        assert!(run.stderr.contains(reason) && run.stderr.contains(hint), "{}", run.stderr);
        assert!(report.get("verdict").is_none());
        assert!(
            !program.files().iter().any(|name| name.starts_with("out.") || name == "steps"),
            "{:?}",
            program.files()
        );
    }
}

#[test]
fn no_writer_lets_a_nan_or_an_infinity_pass() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mesh = sheet();
        let mut embedding: Embedding = mesh.positions.iter().map(|p| p.truncate()).collect();
        embedding[3].y = bad;
        let file = MeshFile::from(&mesh);
        let mut text = Vec::new();
        assert!(write_obj(&mut text, &file, &Texture::per_vertex(&file.polygons, &embedding)).is_err());
        let target = Target::hard(DVec2::new(0.0, bad));
        assert!(write_constraints(&mut text, &Targets::from([(VertexId::new(0), target)]), &PinNotes::new()).is_err());
        assert!(text.is_empty(), "nothing was written before");
        assert_eq!(embedding.check_finite(), Err(SolveError::OutOfRange { vertex: VertexId::new(3) }));
    }
}

/// Number of any order of magnitude.
fn any_number() -> impl Strategy<Value = f64> {
    let magnitude = prop_oneof![3 => -3..3_i32, 1 => -307..308_i32];
    (prop_oneof![Just(1.0), Just(-1.0)], 1.0..9.9_f64, magnitude)
        .prop_map(|(sign, digits, e)| sign * digits * 10_f64.powi(e))
}

/// Pin with a target around a common middle, and any weight.
fn any_pin() -> impl Strategy<Value = (u32, DVec2, Option<f64>)> {
    let weight = prop_oneof![2 => Just(None), 1 => any_number().prop_map(|w| Some(w.abs()))];
    (0..20_u32, -1.0..1.0_f64, -1.0..1.0_f64, weight).prop_map(|(v, x, y, weight)| (v, DVec2::new(x, y), weight))
}

fn any_method() -> impl Strategy<Value = Method> {
    prop::sample::select(Method::ALL.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        cases: 250,
        rng_seed: proptest::test_runner::RngSeed::Fixed(12),
        ..ProptestConfig::default()
    })]
    #[test]
    fn whatever_the_numbers_a_run_ends_soon_with_finite_exact_and_true_steps_or_a_named_failure(
        (method, size) in (any_method(), any_number()),
        pins in prop::collection::vec(any_pin(), 0..6),
        (scale, middle) in (any_number(), prop_oneof![2 => Just(0.0), 1 => any_number()]),
        aspect in prop_oneof![2 => Just(1.0), 1 => any_number()],
    ) {
        let mesh = moved(sheet(), |p| p * size.abs() / 16.0);
        let Ok(mesh) = DiskMesh::try_from(mesh) else { return Ok(()) };
        let frame = PictureFrame { aspect: aspect.abs(), v_axis: VAxis::Up };
        let target = |(v, z, weight): (u32, DVec2, Option<f64>)| {
            (VertexId::new(v), Target { uv: z * scale + middle, kind: weight.map_or(PinKind::Hard, PinKind::Soft) })
        };
        let targets: Targets = pins.into_iter().map(target).collect();
        let pins = pins_in_plane(&targets, frame);
        let [low, high] = frame.corners();
        let size = if aspect == 1.0 { GaugeSize::TrueArea } else { GaugeSize::Within(freebound_core::geom::Bounds { low, high }) };
        let settings = Settings { size, ..Settings::new(method.clone(), Family::default()) };
        let start = Instant::now();
        let steps = steps_of(&mesh, settings, &pins);
        prop_assert!(start.elapsed() < HANG, "{:?}", start.elapsed());
        let Ok(steps) = steps else { return Ok(()) };
        for step in &steps {
            prop_assert!(step.candidate.solution.embedding.check_finite().is_ok());
            prop_assert_eq!(&verdict(step.candidate.mesh(&mesh), &step.candidate.solution.embedding), &step.verdict);
        }
        let last = steps.last().unwrap();
        if method.uses_pins() && last.unmet().is_empty() {
            for (v, pin) in pins.iter().filter(|(_, pin)| pin.kind.is_hard()) {
                prop_assert_eq!(last.candidate.solution.embedding[v], pin.target);
            }
        }
    }
}

/// Arguments, the accepted exit statuses, and the message.
const RUNS: [(&[&str], &[i32]); 16] = [
    (&["--pin", "0:1e200,0", "--pin", "4:2e200,0", "--pin", "19:2e200,1e200"], &[0]),
    (&["--pin", "0:1e300,0", "--pin", "4:-1e300,0", "--pin", "19:0,1e300", "--method", "natural"], &[0, 4]),
    (&["--pin", "0:1e308,1e308", "--pin", "4:-1e308,0", "--pin", "19:0,-1e308"], &[0, 4]),
    (&["--pin", "0:1e160,0", "--pin", "4:2e160,0", "--pin", "19:2e160,1e160", "--method", "matchmaker"], &[0]),
    (&["--pin", "0:1e-310,0", "--pin", "4:2e-310,0", "--pin", "19:2e-310,1e-310"], &[0, 4]),
    (&["--pin", "0:1e300,1e300"], &[0, 4]),
    (&["--pin", "0:0,0", "--pin", "4:1,0", "--pin", "19:1,1:1e-160", "--method", "natural"], &[0]),
    (&["--pin", "0:0,0", "--pin", "4:1,0", "--pin", "19:1,1:1e300", "--method", "natural"], &[0]),
    (&["--pin", "0:0,0:1e-160", "--pin", "4:1,0:1e300", "--pin", "19:1,1:1e300"], &[0]),
    (&["--aspect", "1e300:1"], &[0, 4]),
    (&["--aspect", "1:1e300"], &[0, 4]),
    (&["--aspect", "1:1e300", "--pin", "0:1e200,0", "--pin", "4:1e300,1"], &[0, 4]),
    // Out of the range of numbers in the plane: an invalid pin.
    (&["--aspect", "1e300:1", "--pin", "0:1e200,0", "--pin", "4:1,1"], &[2]),
    (&["--pin", "0:1e200,0", "--pin", "4:0,0", "--method", "virtual-boundary"], &[0, 4]),
    (&["--pin", "0:1e200,0", "--pin", "4:0,0", "--method", "schnyder"], &[0, 4]),
    (&["--method", "convex", "--fit", "true"], &[0]),
];

#[test]
fn the_program_ends_as_it_says_and_writes_numbers_alone() {
    for size in [1.0, 1e-300, 1e300] {
        let text = obj_text(&PolygonMesh::from(&moved(sheet(), |p| p * size)));
        for (arguments, statuses) in RUNS {
            let program = Program::new();
            program.write("in.obj", &text);
            let outputs = ["-o", "out.obj", "--svg", "out.svg", "--steps", "steps", "--report", "out.json"];
            let start = Instant::now();
            let run = program.run(&[&["flatten", "in.obj"], arguments, &outputs].concat());
            assert!(start.elapsed() < HANG, "{arguments:?}");
            let status = run.status.unwrap();
            assert!(statuses.contains(&status), "{arguments:?} on {size:e}: {run:#?}");
            for name in ["out.obj", "out.svg", "steps/steps.csv", "steps/step-000-natural.svg"] {
                let written = std::fs::read_to_string(program.path(name)).unwrap_or_default().to_lowercase();
                let number = |word: &str| word == "nan" || word == "inf" || word == "-inf";
                let words = written.split(|c: char| !(c.is_alphanumeric() || c == '-'));
                assert!(!words.into_iter().any(number), "{arguments:?} on {size:e}: {name}");
            }
            if status == 0 {
                let report = std::fs::read(program.path("out.json")).unwrap();
                let report: Value = serde_json::from_slice(&report).unwrap();
                assert_eq!(report["verdict"]["planar"], true, "{arguments:?}: {report}");
                program.run(&["check", "out.obj"]).expect(0);
            }
        }
    }
}
