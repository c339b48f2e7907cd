//! Smallest known meshes on which the mean-value iteration does not end planar, each of a different kind.
//!
//! Found by `freebound study --past-stall --max-steps 200` on pyramids and rough sheets of this file's makers;
//! book/src/convergence.md discusses them. Theorem 2 of the paper restricts the limits: a map with turning number 1 that
//! meets all its own mean-value equations has no flipped face.

use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::study::{Limits, Patience, Record, StudySubject, Trial, TrialOutcome, run};
use freebound_core::problem::{Control, Family, Treatment, hard_pins};
use glam::DVec2;

use freebound_testkit::{Random, disk, fan, grid};

/// Grid of `columns` × `rows` squares, each vertex at a random height below `height`.
fn rough(columns: u32, rows: u32, height: f64, seed: u64) -> DiskMesh {
    let mut mesh = grid(columns, rows);
    let mut random = Random(seed);
    for p in &mut mesh.positions {
        p.z = height * random.unit();
    }
    disk(mesh)
}

/// Pyramid over a regular polygon, its apex vertex 0 at a height, its corners at random heights below `ragged`.
fn pyramid(sides: u32, height: f64, ragged: f64, seed: u64) -> DiskMesh {
    let mut mesh = fan(sides);
    let mut random = Random(seed);
    for p in &mut mesh.positions[1..] {
        p.z = ragged * random.unit();
    }
    mesh.positions[0].z = height;
    disk(mesh)
}

/// Runs the iteration with the first vertex pinned at the origin and the second at (1, 0). A planar map can always
/// meet two pins. A stall does not end it before its 200 steps.
fn iterated(mesh: &DiskMesh, family: Family, treatment: Treatment, [first, second]: [u32; 2]) -> Record {
    let pins = hard_pins([(VertexId::new(first), DVec2::ZERO), (VertexId::new(second), DVec2::X)]);
    let trial = Trial { number: 0, family, treatment, pins, displacement: None };
    let limits = Limits { max_steps: 200, patience: Patience::ToTheLimit };
    let subject = StudySubject::new(mesh, Control::unattended()).expect("nobody cancels");
    run(&subject, trial, limits, Control::unattended()).expect("nobody cancels")
}

/// Move relative to the diameter that is due to rounding.
const AT_REST: f64 = 1e-9;

/// The smallest disk with an inner vertex.
#[test]
fn on_a_tetrahedron_least_squares_come_to_rest_where_two_faces_of_three_are_flipped() {
    let mesh = pyramid(3, 2.0, 0.0, 0);
    let record = iterated(&mesh, Family::Conformal, Treatment::LeastSquares, [2, 0]);
    let (first, last, rest) = (record.first.unwrap(), record.last.unwrap(), record.rest.unwrap());
    assert_eq!((first.flips, first.crossings, first.turning_number), (1, 0, Some(1)));
    assert_eq!((&record.outcome, record.steps), (&TrialOutcome::Limit, 200));
    assert_eq!((last.flips, last.turning_number), (2, Some(-1)));
    // Equations that cannot all be met are met in the least-squares sense: a limit, but no solution.
    assert!(rest.last_move.unwrap() <= AT_REST && rest.free_residual > 1.0, "{rest:?}");
    // With both pins on the boundary the first map is planar.
    assert!(iterated(&mesh, Family::Conformal, Treatment::LeastSquares, [2, 1]).is_planar_at_once());
}

#[test]
fn without_the_equations_of_pins_a_tetrahedron_keeps_a_flipped_face_that_it_never_has_with_them() {
    let mesh = pyramid(3, 1.0, 1.0, 3);
    let record = iterated(&mesh, Family::Wachspress, Treatment::Eliminate, [3, 0]);
    let (last, rest) = (record.last.unwrap(), record.rest.unwrap());
    assert_eq!((&record.outcome, last.flips, last.turning_number), (&TrialOutcome::Limit, 1, Some(1)));
    assert!(rest.last_move.unwrap() <= AT_REST, "{rest:?}");
    // All remaining equations are met; the dropped ones are not.
    assert!(rest.free_residual <= 1e-9 && rest.pinned_residual > 1.0, "{rest:?}");
    assert!(iterated(&mesh, Family::Wachspress, Treatment::LeastSquares, [3, 0]).is_planar_at_once());
}

#[test]
fn a_pyramid_that_winds_twice_around_its_apex_meets_all_its_equations_and_stays() {
    let mesh = pyramid(6, 2.0, 0.0, 0);
    let record = iterated(&mesh, Family::Wachspress, Treatment::LeastSquares, [5, 4]);
    let (first, last, rest) = (record.first.unwrap(), record.last.unwrap(), record.rest.unwrap());
    assert_eq!(record.outcome, TrialOutcome::Limit);
    assert_eq!((last.flips, last.overwound, last.turning_number), (0, 1, Some(2)));
    assert_eq!(first, last);
    assert_eq!((rest.free_residual, rest.pinned_residual, rest.last_move), (0.0, 0.0, Some(0.0)));
}

/// Turning number 1, no flipped face, all equations met: locally planar by Theorem 2, but not one-to-one.
#[test]
fn a_sheet_whose_boundary_crosses_itself_without_a_flipped_face_stays_as_it_is() {
    let mesh = rough(4, 4, 3.0, 5);
    let record = iterated(&mesh, Family::MeanValue, Treatment::LeastSquares, [24, 14]);
    let (first, last, rest) = (record.first.unwrap(), record.last.unwrap(), record.rest.unwrap());
    assert_eq!(record.outcome, TrialOutcome::Limit);
    assert_eq!((last.flips, last.overwound, last.crossings, last.turning_number), (0, 0, 2, Some(1)));
    assert_eq!(first, last);
    assert_eq!((rest.free_residual, rest.pinned_residual, rest.last_move), (0.0, 0.0, Some(0.0)));
}

#[test]
fn both_pins_on_the_boundary_do_not_help_where_their_equations_are_dropped() {
    let mesh = pyramid(6, 5.0, 2.0, 4);
    let record = iterated(&mesh, Family::MeanValue, Treatment::Eliminate, [6, 2]);
    let (first, last) = (record.first.unwrap(), record.last.unwrap());
    assert_eq!((first.flips, first.crossings, first.turning_number), (1, 0, Some(1)));
    assert_eq!((&record.outcome, last.flips, last.crossings), (&TrialOutcome::Limit, 1, 0));
}
