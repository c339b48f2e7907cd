//! Three-point weights (paper §3.1): rings balance, fans leave the boundary term, degenerate corners stay bounded.

use std::f64::consts::{PI, TAU};

use freebound_core::flatten::solve_once;
use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Control, Family, Method, Pins, Settings};
use freebound_core::weights::corner_weights::{Corner, CornerWeights, three_point_weights};
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// Tolerance of `Σ k (x − x₀)`, relative to the sum of the sizes of its terms.
const TOLERANCE: f64 = 1e-12;

/// Powers of conformal, mean-value and Wachspress weights, and two between them.
const POWERS: [f64; 5] = [1.0, 0.0, -1.0, 0.5, -0.5];

/// Neighbours of the origin, counter-clockwise, every gap between 0.18 and 2.7 rad.
fn closed_ring() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((1.0..3.0, 0.1..10.0), 5..12).prop_map(|spokes: Vec<(f64, f64)>| {
        let total: f64 = spokes.iter().map(|(gap, _)| gap).sum();
        let mut angle = 0.0;
        spokes
            .into_iter()
            .map(|(gap, radius)| {
                angle += gap / total * TAU;
                radius * DVec2::from_angle(angle)
            })
            .collect()
    })
}

fn power() -> impl Strategy<Value = f64> {
    prop::sample::select(POWERS.to_vec())
}

/// Corner at the origin of the triangle (0, a, b), in a tilted plane of space.
fn corner(a: DVec2, b: DVec2) -> Corner {
    let lift = |p: DVec2| DVec3::new(2.0, -1.0, 2.0) / 3.0 * p.x + DVec3::new(2.0, 2.0, -1.0) / 3.0 * p.y;
    Corner::at([DVec3::ZERO, lift(a), lift(b)])
}

/// Corner with this angle between edges of these lengths, exact if sine and cosine are.
fn corner_of_angle(sin: f64, cos: f64, [r, s]: [f64; 2]) -> Corner {
    let dot = r * s * cos;
    Corner { radii: [r, s], cross: r * s * sin, dot, far_dots: [r * r - dot, s * s - dot] }
}

/// Sum `Σ k (x − x₀)` over the corners between consecutive neighbours, and the sum of the sizes of all terms of eq.
/// (1).
fn weighted_sum(pairs: impl Iterator<Item = (DVec2, DVec2)>, power: f64) -> (DVec2, f64) {
    pairs.fold((DVec2::ZERO, 0.0), |(sum, size), (a, b)| {
        let [k1, k2] = three_point_weights(&corner(a, b), power).shares;
        let offsets = a.length().powf(power) + b.length().powf(power);
        (sum + k1 * a + k2 * b, size + (k1 * a).length() + (k2 * b).length() + offsets)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// An interior vertex is at the weighted mean of its neighbours: eq. (2).
    #[test]
    fn a_closed_ring_balances(ring in closed_ring(), power in power()) {
        let next = ring.iter().copied().cycle().skip(1);
        let (sum, size) = weighted_sum(ring.iter().copied().zip(next), power);
        prop_assert!(sum.length() <= TOLERANCE * size, "{sum} of {size}");
    }

    /// A boundary vertex is off that mean by the natural boundary term: eq. (3).
    #[test]
    fn an_open_fan_leaves_exactly_the_boundary_term(ring in closed_ring(), power in power()) {
        let (first, last) = (ring[0], ring[ring.len() - 1]);
        let (sum, size) = weighted_sum(ring.iter().copied().zip(ring[1..].iter().copied()), power);
        let offset = |x: DVec2| x * x.length().powf(power - 1.0);
        // i·(d_last û_last − d_first û_first) + Σ = 0
        let left = sum + (offset(last) - offset(first)).perp();
        prop_assert!(left.length() <= TOLERANCE * size, "{left} of {size}");
    }

    /// The weights equal the table in DESIGN §1, computed from the angle.
    #[test]
    fn a_corner_has_the_weights_of_the_formula(
        angle in 0.01..3.13, r1 in 0.1..10.0, r2 in 0.1..10.0, power in -2.0..2.0,
    ) {
        let (sin, cos) = f64::sin_cos(angle);
        let (d1, d2) = (f64::powf(r1, power), f64::powf(r2, power));
        let expected = [(d2 / sin - d1 * cos / sin) / r1, (d1 / sin - d2 * cos / sin) / r2];
        let sizes = [(d2 + d1) / sin / r1, (d1 + d2) / sin / r2];
        let place = |length: f64, turn: f64| DVec2::from_angle(turn) * length;
        let found = three_point_weights(&corner(place(r1, 0.3), place(r2, 0.3 + angle)), power);
        prop_assert!(!found.bounded);
        for k in 0..2 {
            let error = (found.shares[k] - expected[k]).abs();
            // The angle of the rounded corners is off by an ulp of the lengths, which a thin corner magnifies by
            // 1/sin α.
            prop_assert!(error <= TOLERANCE * sizes[k] / sin, "{:?} is not {expected:?}", found.shares);
        }
    }

    /// The closed forms for three powers agree with the general formula near them: no jump along the slider.
    #[test]
    fn the_slider_has_no_jumps(angle in 0.1..3.0, r1 in 0.1..10.0, r2 in 0.1..10.0) {
        let (sin, cos) = f64::sin_cos(angle);
        let corner = corner_of_angle(sin, cos, [r1, r2]);
        for power in [-1.0, 0.0, 1.0] {
            let here = three_point_weights(&corner, power).shares;
            let beside = three_point_weights(&corner, power + 1e-9).shares;
            for k in 0..2 {
                let size = (f64::powf(r1, power) + f64::powf(r2, power)) / sin / [r1, r2][k];
                prop_assert!((here[k] - beside[k]).abs() <= 1e-7 * size, "{here:?} beside {beside:?}");
            }
        }
    }

    /// The weight tan(α/2)/r has full relative precision for every angle that three points can form.
    #[test]
    fn mean_value_weights_are_positive_and_finite(decades in -15.0..0.0, r in 1e-3..1e3, s in 1e-3..1e3) {
        let small = PI / 2.0 * f64::powf(10.0, decades);
        let near_zero = corner_of_angle(small.sin(), small.cos(), [r, s]);
        let near_pi = corner_of_angle(small.sin(), -small.cos(), [r, s]);
        for (corner, tangent) in [(near_zero, (small / 2.0).tan()), (near_pi, 1.0 / (small / 2.0).tan())] {
            let CornerWeights { shares, bounded } = three_point_weights(&corner, 0.0);
            prop_assert!(shares.iter().all(|&w| w > 0.0 && w.is_finite()), "{shares:?}");
            if bounded {
                prop_assert!(tangent > 0.9e12);
            } else {
                prop_assert!((shares[0] * r / tangent - 1.0).abs() < 1e-13, "{shares:?}, tan {tangent}");
                prop_assert!((shares[1] * s / tangent - 1.0).abs() < 1e-13, "{shares:?}, tan {tangent}");
            }
        }
    }
}

#[test]
fn a_degenerate_corner_is_bounded_and_says_so() {
    let on_a_line = |a: f64, b: f64| Corner::at([DVec3::ZERO, DVec3::X * a, DVec3::X * b]);
    for (corner, angle) in [(on_a_line(1.0, 2.0), 0.0), (on_a_line(1.0, 1.0), 0.0), (on_a_line(1.0, -1.0), PI)] {
        for power in POWERS {
            let CornerWeights { shares, bounded } = three_point_weights(&corner, power);
            assert!(shares.iter().all(|w| w.is_finite()), "{corner:?}, power {power}: {shares:?}");
            // Mean-value weights of the angle 0 are 0, correctly, without bounding.
            assert_eq!(bounded, power != 0.0 || angle > 0.0, "{corner:?}, power {power}");
        }
    }
}

#[test]
fn an_ordinary_corner_is_not_bounded() {
    for power in POWERS {
        assert!(!three_point_weights(&corner(DVec2::X, DVec2::new(1e-5, 1.0)), power).bounded);
    }
}

/// Scaled surface that every method distorts.
fn bumpy(scale: f64) -> DiskMesh {
    let mesh = BuiltIn::Dome.mesh();
    let positions = mesh.positions.iter().map(|&p| p * scale).collect();
    DiskMesh::try_from(TriMesh { positions, ..mesh }).unwrap_or_else(|faults| panic!("scaled by {scale}: {faults}"))
}

/// Every method, with all powers.
pub(crate) fn free_methods() -> Vec<Settings> {
    let families = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.5), Family::Power(-0.5)];
    let natural = families.map(|family| Settings::new(Method::Natural, family));
    let others = [Method::Levy, Method::Lscm].map(|method| Settings { method, ..Settings::default() });
    [natural.as_slice(), &others].concat()
}

#[test]
fn a_scaled_mesh_has_the_same_embedding_scaled() {
    let mesh = bumpy(1.0);
    for settings in free_methods() {
        let flat = |mesh: &DiskMesh| {
            solve_once(mesh, &settings, &Pins::new(), Control::unattended())
                .unwrap_or_else(|error| panic!("{settings:?}: {error}"))
                .embedding
                .iter()
                .map(|&z| z * mesh.unit())
                .collect::<Vec<_>>()
        };
        let expected = flat(&mesh);
        let size = expected.iter().fold(0.0_f64, |m, z| m.max(z.length()));
        for scale in [1e-150, 1000.0, 1e150] {
            let worst =
                flat(&bumpy(scale)).iter().zip(&expected).map(|(z, e)| (*z / scale).distance(*e)).fold(0.0, f64::max);
            assert!(worst <= 1e-9 * size, "{settings:?}, scaled by {scale}: off by {:e}", worst / size);
        }
    }
}
