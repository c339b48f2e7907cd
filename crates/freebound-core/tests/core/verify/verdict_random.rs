//! Verdict against the rational oracle on 100,000 random small maps of disks: all fields, and one-to-one or not, in
//! 64 bits and in 32.

use freebound_core::mesh::{EdgeId, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{is_planar, verdict};
use glam::DVec2;

use super::verdict_cases::{Case, grid_case, nearly_planar_case, nudge};
use freebound_testkit::Random;
use freebound_testkit::oracle::{OracleVerdict, examine, sorted_pair};

/// Compares the verdict with the oracle; returns true if the map is planar.
fn assert_agreement(case: &Case) -> bool {
    let mesh = case.mesh();
    let verdict = verdict(&mesh, &case.embedding);
    let vertices_of = |edge: EdgeId| mesh.ends(edge).map(VertexId::number);
    let mut crossings: Vec<_> =
        verdict.boundary_crossings.iter().map(|&[e, f]| sorted_pair(vertices_of(e), vertices_of(f))).collect();
    crossings.sort_unstable();
    assert!(verdict.boundary_crossings.is_sorted());
    let ours = OracleVerdict {
        flipped_faces: verdict.flipped_faces.iter().map(|f| f.index()).collect(),
        boundary_crossings: crossings,
        overwound_vertices: verdict.overwound_vertices.iter().map(|v| v.number()).collect(),
        turning_number: verdict.turning_number,
        zero_area_faces: verdict.zero_area_faces,
        mirrored: verdict.mirrored,
        injective: verdict.planar,
    };
    assert_eq!(ours, examine(&case.triangles, &case.embedding), "{case:?}");
    assert_eq!(is_planar(&mesh, &case.embedding), verdict.planar, "{case:?}");
    assert_eq!(verdict.planar_in_f32, verdict.planar && is_injective_in_f32(case, verdict.mirrored), "{case:?}");
    verdict.planar
}

/// True if the oracle finds a map one-to-one after rounding its coordinates to 32 bits, with the given orientation.
fn is_injective_in_f32(case: &Case, mirrored: bool) -> bool {
    let rounded: Embedding = case.embedding.iter().map(|z| z.as_vec2().as_dvec2()).collect();
    let is_finite = rounded.iter().all(|z| z.is_finite());
    is_finite && {
        let answer = examine(&case.triangles, &rounded);
        answer.injective && answer.mirrored == mirrored
    }
}

/// Compares many cases and asserts that both answers occur often.
fn assert_agreement_on(count: usize, seed: u64, make: impl Fn(&mut Random) -> Case) {
    let mut random = Random(seed);
    let planar = (0..count).filter(|_| assert_agreement(&make(&mut random))).count();
    assert!(planar * 200 > count && planar * 3 < count * 2, "{planar} of {count} planar: the cases say little");
}

#[test]
fn the_verdict_agrees_with_the_oracle_on_small_grids() {
    assert_agreement_on(35_000, 1, grid_case);
}

#[test]
fn the_verdict_agrees_with_the_oracle_on_nearly_planar_maps() {
    assert_agreement_on(25_000, 2, nearly_planar_case);
}

#[test]
fn the_verdict_agrees_with_the_oracle_near_degenerate_cases() {
    assert_agreement_on(20_000, 3, |random| {
        let mut case = if random.index(2) == 0 { grid_case(random) } else { nearly_planar_case(random) };
        // Tenths are not exact, so collinear points rarely stay collinear; then some ulps more.
        case.embedding.iter_mut().for_each(|p| *p = *p * 0.1 + DVec2::splat(0.7));
        nudge(random, &mut case.embedding);
        case
    });
}

/// Compares cases with all coordinates scaled.
fn assert_agreement_at_scale(count: usize, seed: u64, scale: f64) {
    assert_agreement_on(count, seed, |random| {
        let mut case = if random.index(2) == 0 { grid_case(random) } else { nearly_planar_case(random) };
        case.embedding.iter_mut().for_each(|p| *p *= scale);
        nudge(random, &mut case.embedding);
        case
    });
}

#[test]
fn the_verdict_agrees_with_the_oracle_at_1e_minus_200() {
    assert_agreement_at_scale(5_000, 4, 1e-200);
}

#[test]
fn the_verdict_agrees_with_the_oracle_on_subnormal_numbers() {
    assert_agreement_at_scale(2_500, 5, 5e-324);
    assert_agreement_at_scale(2_500, 6, 1e-310);
}

#[test]
fn the_verdict_agrees_with_the_oracle_at_1e200_and_at_the_end_of_the_numbers() {
    assert_agreement_at_scale(4_000, 7, 1e200);
    assert_agreement_at_scale(1_000, 8, 1e307);
}

#[test]
fn the_verdict_agrees_with_the_oracle_at_the_ends_of_the_adaptive_range() {
    assert_agreement_at_scale(1_250, 9, 2_f64.powi(-400));
    assert_agreement_at_scale(1_250, 10, 2_f64.powi(399));
}

#[test]
fn the_verdict_agrees_with_the_oracle_where_scales_are_mixed() {
    assert_agreement_on(2_500, 11, |random| {
        let mut case = nearly_planar_case(random);
        // The map x ↦ x³ stretches and does not fold by itself; then coordinates near the axes become tiny.
        let tiny = [1.0, 1e-130, 1e-200, 1e-320][random.index(4)];
        for point in case.embedding.iter_mut() {
            for coordinate in [&mut point.x, &mut point.y] {
                if coordinate.abs() < 1.5 {
                    *coordinate *= tiny;
                }
            }
        }
        case
    });
}
