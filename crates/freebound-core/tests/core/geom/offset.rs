//! Offsets of regions, and their poles.

use freebound_core::geom::{OffsetJoins, OffsetOptions, distance_to_loop, is_simple, offset_outward, pole};
use glam::DVec2;

fn options(distance: f64, joins: OffsetJoins) -> OffsetOptions {
    OffsetOptions { distance, joins, tolerance: 1e-3 }
}

fn area(line: &[DVec2]) -> f64 {
    (0..line.len()).map(|k| line[k].perp_dot(line[(k + 1) % line.len()])).sum::<f64>() / 2.0
}

fn square() -> Vec<DVec2> {
    [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from).to_vec()
}

/// Star with deep dents, whose allowance fills their ends.
fn star() -> Vec<DVec2> {
    let tip = |k: u32| DVec2::from_angle(f64::from(k) * std::f64::consts::PI / 9.0 + 0.1);
    (0..18).map(|k| tip(k) * if k % 2 == 0 { 5.0 } else { 1.5 }).collect()
}

#[test]
fn mitred_and_round_squares_have_their_known_areas() {
    let mitred = offset_outward(&[square()], options(1.0, OffsetJoins::Mitre)).expect("an offset");
    assert!((area(&mitred[0]) - 36.0).abs() < 1e-9);
    let round = offset_outward(&[square()], options(1.0, OffsetJoins::Round)).expect("an offset");
    let exact = 16.0 + 16.0 + std::f64::consts::PI;
    assert!((area(&round[0]) - exact).abs() < 0.01, "{}", area(&round[0]));
}

#[test]
fn every_vertex_of_a_round_offset_has_the_distance_of_the_offset() {
    for distance in [0.05, 0.3, 0.7, 2.0, 20.0] {
        let found = offset_outward(&[star()], options(distance, OffsetJoins::Round)).expect("an offset");
        for line in &found {
            assert!(is_simple(line));
            for &point in line {
                let near = distance_to_loop(&star(), point);
                assert!((near - distance).abs() < 2e-3 + 1e-6 * distance, "{near} and {distance}");
            }
        }
        assert!(area(&found[0]) > area(&star()));
    }
}

#[test]
fn a_hole_shrinks_until_it_is_gone_and_a_slot_closes() {
    let hole: Vec<DVec2> = [(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)].map(DVec2::from).to_vec();
    let found = offset_outward(&[square(), hole.clone()], options(0.5, OffsetJoins::Mitre)).expect("an offset");
    let areas: Vec<f64> = found.iter().map(|line| area(line)).collect();
    assert_eq!(areas.len(), 2);
    assert!((areas[0] - 25.0).abs() < 1e-9 && (areas[1] + 1.0).abs() < 1e-9, "{areas:?}");
    assert_eq!(offset_outward(&[square(), hole], options(1.1, OffsetJoins::Mitre)).expect("an offset").len(), 1);
}

#[test]
fn lines_without_a_region_have_no_offset() {
    assert!(offset_outward(&[vec![DVec2::ZERO, DVec2::X]], options(1.0, OffsetJoins::Round)).is_none());
    assert!(offset_outward(&[square()], options(f64::NAN, OffsetJoins::Round)).is_none());
}

#[test]
fn the_pole_of_a_square_is_its_centre_and_a_hole_repels_it() {
    let found = pole(&[square()]).expect("a pole");
    assert!(found.at.distance(DVec2::splat(2.0)) < 0.05 && (found.distance - 2.0).abs() < 0.05);
    let hole: Vec<DVec2> = [(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)].map(DVec2::from).to_vec();
    let found = pole(&[square(), hole]).expect("a pole");
    assert!(found.distance > 0.4 && found.distance < 0.6, "{found:?}");
}
