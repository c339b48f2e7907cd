//! Distortion against closed forms.

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::Embedding;
use freebound_core::verify::{Distortion, DistortionSummary, FaceDistortion, distortion};
use glam::{DMat2, DVec2, DVec3};

use freebound_testkit::{disk, shaped};

/// Relative tolerance: sums over a few hundred faces of numbers that are exact to a few units in the last place.
const TOLERANCE: f64 = 1e-12;

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance * expected.abs(), "{value} is not {expected}");
}

/// Grid of n × n squares, two triangles each, with `place` mapping the unit square to space.
fn grid(n: u32, place: impl Fn(DVec2) -> DVec3) -> DiskMesh {
    disk(shaped(n, n, |x, y| place(DVec2::new(x, y) / f64::from(n))))
}

/// Vertices of the grid in the unit square, moved by `place`.
fn flat(n: u32, place: impl Fn(DVec2) -> DVec2) -> Embedding {
    freebound_testkit::grid(n, n).positions.iter().map(|x| place(x.truncate() / f64::from(n))).collect()
}

/// Tilted square of side 3 in space.
fn tilted(p: DVec2) -> DVec3 {
    DVec3::new(2.0, -1.0, 2.0) * p.x + DVec3::new(2.0, 2.0, -1.0) * p.y + DVec3::splat(5.0)
}

/// Asserts the values of every face and of the summary under a linear map with these singular values, whose product
/// is 1.
fn assert_uniform(found: &Distortion, greater: f64, lesser: f64) {
    let stretch_l2 = f64::midpoint(greater.powi(-2), lesser.powi(-2)).sqrt();
    for face in &found.faces {
        assert_near(face.angle, greater / lesser, TOLERANCE);
        assert_near(face.area, 1.0, TOLERANCE);
        assert_near(face.stretch_l2, stretch_l2, TOLERANCE);
        assert_near(face.stretch_linf, 1.0 / lesser, TOLERANCE);
    }
    let summary = found.summary;
    for value in [summary.angle.mean, summary.angle.p99, summary.angle.max] {
        assert_near(value, greater / lesser, TOLERANCE);
    }
    for value in [summary.area.mean, summary.area.p99, summary.area.max] {
        assert_near(value, 1.0, TOLERANCE);
    }
    assert_near(summary.stretch_l2, stretch_l2, TOLERANCE);
    assert_near(summary.stretch_linf, 1.0 / lesser, TOLERANCE);
}

#[test]
fn an_isometry_has_no_distortion() {
    let turned = DMat2::from_angle(0.7);
    assert_uniform(&distortion(&grid(5, tilted), &flat(5, |p| turned * p * 3.0)), 1.0, 1.0);
}

#[test]
fn neither_size_nor_place_nor_a_mirror_counts() {
    let mesh = grid(5, tilted);
    for scale in [1e-300, 1e-9, 1.0, 1e9, 1e300] {
        assert_uniform(&distortion(&mesh, &flat(5, |p| DVec2::new(-p.y, -p.x) * scale)), 1.0, 1.0);
    }
    let small = grid(5, |p| tilted(p) * 1e-200);
    assert_uniform(&distortion(&small, &flat(5, |p| p + DVec2::splat(9.0))), 1.0, 1.0);
}

#[test]
fn a_stretch_by_known_factors_is_measured() {
    // Singular values 4 and 1/9, in skew directions; at equal areas 6 and 1/6.
    let map = DMat2::from_angle(0.3) * DMat2::from_diagonal(DVec2::new(4.0, 1.0 / 9.0)) * DMat2::from_angle(-1.1);
    assert_uniform(&distortion(&grid(7, tilted), &flat(7, |p| map * p)), 6.0, 1.0 / 6.0);
}

#[test]
fn a_shear_has_the_golden_ratio() {
    // (1 1; 0 1) has the singular values φ and 1/φ.
    let golden = f64::midpoint(1.0, 5_f64.sqrt());
    let found = distortion(&grid(3, tilted), &flat(3, |p| DVec2::new(p.x + p.y, p.y)));
    assert_uniform(&found, golden, 1.0 / golden);
}

#[test]
fn the_symmetric_energy_adds_squares_of_singular_values_and_of_their_inverses() {
    let of = |summary: DistortionSummary| summary.symmetric_dirichlet.mean;
    assert_near(of(distortion(&grid(5, tilted), &flat(5, |p| p * 7.0)).summary), 4.0, TOLERANCE);
    // Singular values 6 and 1/6 at equal areas, in skew directions.
    let map = DMat2::from_angle(0.3) * DMat2::from_diagonal(DVec2::new(4.0, 1.0 / 9.0)) * DMat2::from_angle(-1.1);
    let squares = 36.0 + 1.0 / 36.0;
    assert_near(of(distortion(&grid(7, tilted), &flat(7, |p| map * p)).summary), 2.0 * squares, TOLERANCE);
    // Two thirds of the surface are stretched to four times their width; squared lengths are multiplied by 1/3.
    let stretched = |x: f64| if x <= 1.0 { x } else { 1.0 + 4.0 * (x - 1.0) };
    let mesh = grid(3, |p| DVec3::new(3.0 * p.x, p.y, 0.0));
    let found = distortion(&mesh, &flat(3, |p| DVec2::new(stretched((3.0 * p.x).round()), p.y))).summary;
    let [left, right] = [1.0, 16.0_f64].map(|wide| (wide + 1.0) / 3.0 + 3.0 * (1.0 / wide + 1.0));
    assert_near(of(found), (left + 2.0 * right) / 3.0, TOLERANCE);
}

#[test]
fn sums_are_weighted_by_area_on_the_surface() {
    // The left third keeps its shape, the rest is stretched to four times its width; total 3 → 9 times the column.
    let stretched = |x: f64| if x <= 1.0 { x } else { 1.0 + 4.0 * (x - 1.0) };
    let mesh = grid(3, |p| DVec3::new(3.0 * p.x, p.y, 0.0));
    let summary = distortion(&mesh, &flat(3, |p| DVec2::new(stretched((3.0 * p.x).round()), p.y))).summary;
    assert_near(summary.angle.mean, (1.0 + 4.0 + 4.0) / 3.0, TOLERANCE);
    assert_near(summary.angle.p99, 4.0, TOLERANCE);
    // Squared lengths in the plane are multiplied by 3/9: areas by 1/3 on the left, 4/3 on the right.
    assert_near(summary.area.mean, (3.0 + 4.0 / 3.0 + 4.0 / 3.0) / 3.0, TOLERANCE);
    assert_near(summary.area.max, 3.0, TOLERANCE);
    // L² of a face is 3 · (1/σ₁² + 1/σ₂²)/2 with σ = 1, 1 and 4, 1.
    assert_near(summary.stretch_l2, ((3.0 + 2.0 * 3.0 * (1.0 + 1.0 / 16.0) / 2.0) / 3.0_f64).sqrt(), TOLERANCE);
    assert_near(summary.stretch_linf, 3_f64.sqrt(), TOLERANCE);
}

#[test]
fn the_percentile_leaves_out_one_hundredth_of_the_surface() {
    // A row of 300 squares with the first few widened by a factor of two; three are a hundredth of them.
    let row = |wide: usize| {
        let count = 300;
        let mut x = 0.0;
        let mut embedding = Vec::new();
        for i in 0..=count {
            embedding.extend([DVec2::new(x, 0.0), DVec2::new(x, 1.0)]);
            x += if i < wide { 2.0 } else { 1.0 };
        }
        let positions = (0..=count).flat_map(|i| [0.0, 1.0].map(|y| DVec3::new(i as f64, y, 0.0))).collect();
        let square = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
        let mesh = TriMesh::new(positions, &(0..300).flat_map(square).collect::<Vec<_>>());
        distortion(&DiskMesh::try_from(mesh).expect("a row is a disk"), &embedding.into()).summary.angle
    };
    assert_near(row(2).p99, 1.0, TOLERANCE);
    assert_near(row(4).p99, 2.0, TOLERANCE);
    assert_near(row(2).max, 2.0, TOLERANCE);
    assert_near(row(2).mean, 302.0 / 300.0, TOLERANCE);
}

#[test]
fn the_stereographic_map_of_an_octant_keeps_angles_and_scales_as_it_should() {
    // From the south pole onto the plane through the north pole: conformal, lengths multiplied by 2/(1 + cos θ).
    let n = 64;
    let octant = |p: DVec2| {
        let (theta, phi) = ((0.1 + 0.9 * p.x) * std::f64::consts::FRAC_PI_2, p.y * std::f64::consts::FRAC_PI_2);
        DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    let mesh = grid(n, octant);
    let map = |p: DVec3| DVec2::new(p.x, p.y) * 2.0 / (1.0 + p.z);
    let embedding: Embedding = mesh.mesh().positions.iter().copied().map(map).collect();
    let found = distortion(&mesh, &embedding);
    // A chord of 1/64 of a quarter turn departs from its arc, and the scale changes along it, by about 1/64.
    let chord = 0.03;
    assert!(found.summary.angle.max < 1.0 + chord, "{}", found.summary.angle.max);
    let centre = |face| mesh.face(face).iter().map(|&v| mesh.position(v)).sum::<DVec3>() / 3.0;
    let scale_at = |z: f64| (2.0 / (1.0 + z)).powi(2);
    // Areas from θ₀ to π/2 by integration: the plane's annulus 4 tan²(θ/2), the sphere's zone 2 cos θ₀.
    let first = 0.1 * std::f64::consts::FRAC_PI_2;
    let ratio = 4.0 * (1.0 - (first / 2.0).tan().powi(2)) / (2.0 * first.cos());
    for face in mesh.faces() {
        assert_near(found.faces[face.index()].area, scale_at(centre(face).z) / ratio, chord);
    }
    // The scale is 2 at the equator and least at the upper edge, where the stretch from plane to sphere is greatest.
    assert_near(found.summary.stretch_linf, ratio.sqrt() * f64::midpoint(1.0, first.cos()), chord);
}

#[test]
fn a_collapsed_face_is_infinite_and_json_shows_null() {
    let mut embedding = flat(1, |p| p);
    embedding[3] = DVec2::new(0.5, 0.0);
    let found = distortion(&grid(1, tilted), &embedding);
    assert_eq!(found.faces[0].area.to_bits(), 0.0_f64.to_bits());
    assert!(found.faces[0].angle.is_infinite() && found.faces[1].angle.is_finite());
    let json = serde_json::to_string(&found.summary).unwrap();
    let nulls = "{\"mean\":null,\"p99\":null,\"max\":null}";
    let sums = "\"stretch_l2\":null,\"stretch_linf\":null,\"symmetric_dirichlet\":{\"mean\":null}";
    assert_eq!(json, format!("{{\"angle\":{nulls},\"area\":{nulls},{sums}}}"));
}

#[test]
fn nothing_is_ever_nan() {
    let spoilt = [DVec2::NAN, DVec2::INFINITY, DVec2::splat(f64::MAX), DVec2::splat(-f64::MAX), DVec2::splat(5e-324)];
    let mesh = grid(2, tilted);
    let mut embeddings: Vec<Embedding> = spoilt.iter().map(|&value| vec![value; 9].into()).collect();
    for value in spoilt {
        let mut embedding = flat(2, |p| p);
        embedding[4] = value;
        embeddings.push(embedding);
    }
    for embedding in embeddings {
        let Distortion { faces, summary } = distortion(&mesh, &embedding);
        let sums = [summary.angle, summary.area].map(|spread| [spread.mean, spread.p99, spread.max]).concat();
        let values = faces.iter().flat_map(|face| [face.angle, face.area, face.stretch_l2, face.stretch_linf]);
        let energies = faces.iter().map(FaceDistortion::symmetric_dirichlet).chain([summary.symmetric_dirichlet.mean]);
        let stretches = [summary.stretch_l2, summary.stretch_linf];
        let all: Vec<f64> = values.chain(sums).chain(stretches).chain(energies).collect();
        assert!(all.iter().all(|value| !value.is_nan()), "{embedding:?}: {all:?}");
    }
}
