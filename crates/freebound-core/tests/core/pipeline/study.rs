//! The iteration on random trials (paper §7): trials, runs, and their summary.

use std::collections::{BTreeMap, BTreeSet};

use freebound_core::flatten::solve_once;
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::study::{
    Defects, Limits, Patience, Record, Studied, Study, StudySubject, SystemForm, Trial, TrialOutcome, run, summary,
};
use freebound_core::problem::{Control, Family, Method, NamedOption as _, Pins, Settings, Treatment};
use freebound_io::study_plots;

use freebound_testkit::surfaces::irregular_cube;
use freebound_testkit::{Random, assert_message, bumpy_cap_of, disk, fan};

/// Residual due to rounding: equations have no unit, and their coefficients are near 1.
const ROUNDING: f64 = 1e-9;

const LIMITS: Limits = Limits { max_steps: 60, patience: Patience::OfMethod };

const STUDY: Study = Study { runs: 40, seed: 7, limits: LIMITS };

fn subject(mesh: &DiskMesh) -> StudySubject<'_> {
    StudySubject::new(mesh, Control::unattended()).expect("nobody cancels")
}

fn records(mesh: &DiskMesh, study: Study) -> Vec<Record> {
    study.records(&subject(mesh), Control::unattended(), || {}).expect("nobody cancels")
}

#[test]
fn the_same_runs_come_from_any_number_of_threads() {
    let mesh = irregular_cube(3, &mut Random(3));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| records(&mesh, STUDY))
    };
    let alone = on(1);
    assert_eq!(alone.len(), 40);
    assert!(alone == on(3));
    assert!(alone.iter().map(|record| record.trial.number).eq(0..40));
    // The runs of a shorter study are the first of a longer one; another seed gives other runs.
    assert!(records(&mesh, Study { runs: 9, ..STUDY }) == alone[..9]);
    let other = records(&mesh, Study { runs: 9, seed: 8, ..STUDY });
    assert!(other.iter().zip(&alone).all(|(a, b)| a.trial.pins != b.trial.pins));
}

#[test]
fn trials_have_all_kinds_of_pins_families_and_treatments() {
    let mesh = disk(bumpy_cap_of(120, 1));
    let subject = subject(&mesh);
    let trials: Vec<Trial> = (0..600).map(|number| Trial::draw(&subject, 1, number)).collect();
    let mut kinds = BTreeSet::new();
    for trial in &trials {
        let inside = trial.pins.keys().filter(|vertex| mesh.boundary_place(**vertex).is_none()).count();
        let place = match inside {
            0 => "boundary",
            count if count == trial.pins.len() => "inside",
            _ => "mixed",
        };
        let is_pair = trial.displacement.is_none();
        kinds.insert((is_pair, place, trial.family.name(), trial.treatment.name()));
        assert!(trial.pins.values().all(|pin| pin.kind.is_hard() && pin.target.is_finite()));
        let Some(displacement) = trial.displacement else {
            assert_eq!(trial.pins.len(), 2);
            continue;
        };
        assert!((3..=12).contains(&trial.pins.len()));
        assert!((0.003..0.51).contains(&displacement));
    }
    assert_eq!(kinds.len(), 2 * 3 * 3 * 3, "{kinds:?}");
    let pairs = trials.iter().filter(|trial| trial.displacement.is_none()).count();
    assert!((240..=360).contains(&pairs), "{pairs} of 600 are pairs");
}

#[test]
fn small_displacements_leave_targets_near_the_natural_embedding() {
    let mesh = disk(bumpy_cap_of(120, 1));
    let subject = subject(&mesh);
    let natural =
        solve_once(&mesh, &Settings::new(Method::Natural, Family::Conformal), &Pins::new(), Control::unattended())
            .unwrap()
            .embedding;
    let diameter = natural.bounds().diameter();
    let middle = natural.bounds().middle();
    let mut farthest = 0.0_f64;
    for trial in (0..300).map(|number| Trial::draw(&subject, 5, number)) {
        let Some(displacement) = trial.displacement else { continue };
        for (vertex, pin) in &trial.pins {
            let off = pin.target.distance((natural[vertex] - middle) / diameter) / displacement;
            assert!(off <= 1.0 + 1e-12, "{off}");
            farthest = farthest.max(off);
        }
    }
    assert!(farthest > 0.95, "the whole disk is drawn from: {farthest}");
}

#[test]
fn a_mesh_of_one_interior_vertex_has_trials_too() {
    let mesh = disk(fan(3));
    for record in records(&mesh, Study { runs: 40, ..STUDY }) {
        assert!((2..=4).contains(&record.trial.pins.len()), "{record:?}");
        assert!(record.pin_distance > 0.0 && record.pin_distance <= 1.0);
    }
}

/// Theorem 2 of the paper: a map with turning number 1 that meets all its own mean-value equations has no flipped
/// face. Conversely, a planar embedding meets them.
#[test]
fn planar_ends_meet_all_their_equations_and_folded_ones_do_not() {
    let mut random = Random(11);
    let [mut planar, mut folded] = [0, 0];
    for cells in [3, 4] {
        let mesh = irregular_cube(cells, &mut random);
        for record in records(&mesh, Study { runs: 80, ..STUDY }) {
            let (Some(last), Some(rest)) = (record.last, record.rest) else { continue };
            if record.outcome == TrialOutcome::Planar {
                planar += 1;
                assert!(rest.free_residual.max(rest.pinned_residual) <= ROUNDING, "{record:?}");
                assert_eq!((last.flips, last.crossings), (0, 0));
            } else if last.turning_number == Some(1) && last.flips > 0 {
                // Without a flipped face it may meet them and overlap itself: see the counterexamples.
                folded += 1;
                assert!(rest.free_residual.max(rest.pinned_residual) > ROUNDING, "{record:?}");
            }
        }
    }
    assert!(planar > 20 && folded > 5, "{planar} planar, {folded} folded");
}

#[test]
fn past_a_stall_a_run_goes_on_to_its_limit_and_takes_the_same_steps_before() {
    let mesh = irregular_cube(3, &mut Random(3));
    let subject = subject(&mesh);
    let limits = Limits { max_steps: 30, ..LIMITS };
    let patient = Limits { patience: Patience::ToTheLimit, ..limits };
    let mut stalls = 0;
    for record in records(&mesh, Study { runs: 24, limits, ..STUDY }) {
        let further = run(&subject, record.trial.clone(), patient, Control::unattended()).unwrap();
        assert!(further.outcome != TrialOutcome::Stalled);
        if record.outcome == TrialOutcome::Stalled {
            stalls += 1;
            assert!(further.steps > record.steps);
            assert!(further.outcome == TrialOutcome::Planar || further.steps == 30);
            assert_eq!(further.first, record.first);
        } else {
            assert!(further == record);
        }
    }
    assert!(stalls > 0);
}

/// Record of a trial with two pins and with counts only.
fn told(number: u64, outcome: TrialOutcome, steps: usize) -> Record {
    let turning_number = Some(if number == 3 { 2 } else { 1 });
    Record {
        trial: Trial {
            number,
            family: Family::Conformal,
            treatment: Treatment::Eliminate,
            pins: Pins::new(),
            displacement: None,
        },
        pins_inside: 0,
        pin_distance: number as f64,
        outcome,
        steps,
        first: Some(Defects { turning_number, ..Defects::default() }),
        distortion: 1.0 + number as f64,
        last: None,
        rest: None,
    }
}

#[test]
fn groups_count_what_was_planar_at_once_and_what_was_mended_and_how_fast() {
    let planar = |number, steps| told(number, TrialOutcome::Planar, steps);
    let records = vec![
        planar(0, 0),
        planar(1, 4),
        told(2, TrialOutcome::Stalled, 9),
        told(3, TrialOutcome::Failed("singular".into()), 0),
        planar(4, 2),
        planar(5, 30),
        told(6, TrialOutcome::Limit, 60),
        planar(7, 0),
    ];
    let studied = [Studied { mesh: "a.obj".into(), form: SystemForm::default(), limits: LIMITS, records }];
    let groups = summary(&studied);
    let all = &groups[0];
    assert_eq!((all.by, all.runs, all.at_once, all.with_all_repairs), ("all", 8, 2, 3));
    assert_eq!((all.median_steps, all.p90_steps), (Some(4), Some(30)));
    assert_eq!([all.share_planar(), all.share_at_once(), all.share_mended()], [0.625, 0.25, 0.5]);
    let of = |word: &str| {
        groups.iter().filter(|group| group.by.split([' ', ',']).any(|part| part == word)).collect::<Vec<_>>()
    };
    let quarters = of("distance");
    let names: Vec<&str> = quarters.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["0.000 to 1.000", "2.000 to 3.000", "4.000 to 5.000", "6.000 to 7.000"]);
    assert_eq!(quarters.iter().map(|group| group.with_all_repairs).collect::<Vec<_>>(), [1, 0, 2, 0]);
    let turning: Vec<(&str, usize)> = of("turning").iter().map(|group| (group.name.as_str(), group.runs)).collect();
    assert_eq!(turning, [("1", 7), ("another", 1)]);
    let dropped: Vec<[usize; 2]> = of("dropped").iter().map(|group| [group.runs, group.with_all_repairs]).collect();
    assert_eq!(dropped, [[5, 3], [1, 0]]);
    assert!(of("kept").is_empty() && of("displacement").is_empty());
    let last = groups.last().expect("groups");
    assert_eq!((last.by, last.name.as_str()), ("mesh", "a.obj"));
    let names: Vec<String> = groups.iter().map(|group| format!("{}: {}", group.by, group.name)).collect();
    assert_message("study-groups", &names.join("\n"));
}

/// A run whose first solve failed has no map to report.
#[test]
fn runs_without_a_first_map_are_in_no_group_of_first_maps_and_in_no_curve() {
    let with_all_repairs = told(0, TrialOutcome::Planar, 1);
    let stalled = told(1, TrialOutcome::Stalled, 5);
    let failed = Record { first: None, ..told(2, TrialOutcome::Failed("singular".into()), 0) };
    let of =
        |records: Vec<Record>| [Studied { mesh: "a.obj".into(), form: SystemForm::default(), limits: LIMITS, records }];
    let with_failed = of(vec![with_all_repairs.clone(), stalled.clone(), failed]);
    let groups = summary(&with_failed);
    assert_eq!(groups[0].runs, 3);
    let mut runs_of_first_maps: BTreeMap<&str, usize> = BTreeMap::new();
    for group in groups.iter().filter(|group| group.by.contains("map")) {
        *runs_of_first_maps.entry(group.by).or_default() += group.runs;
    }
    assert!(runs_of_first_maps.len() == 5 && runs_of_first_maps.values().all(|&runs| runs == 2), "{groups:?}");
    let curves = |studied: &[Studied]| {
        let mut svg = Vec::new();
        study_plots(studied).write_svg(&mut svg).unwrap();
        let svg = String::from_utf8(svg).unwrap();
        let is_curve = |line: &&str| line.contains("stroke-width=\"1.800\"");
        let curves: Vec<String> = svg.lines().filter(is_curve).map(str::to_owned).collect();
        assert!(!curves.is_empty());
        curves
    };
    assert!(curves(&with_failed) == curves(&of(vec![with_all_repairs.clone(), stalled])));
    assert!(curves(&with_failed) != curves(&of(vec![with_all_repairs])));
}
