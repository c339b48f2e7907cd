//! Energy of one triangle: its value against its derivatives.

use freebound_core::nonlinear::foldover_energy::{Element, Energy, Stiffness};
use glam::DVec2;

fn element() -> Element {
    Element::new(
        [0, 1, 2],
        [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(0.4, 1.5)],
        Stiffness { weight: 0.7, thinnest: 1e-6 },
    )
}

const PLACES: [[DVec2; 3]; 3] = [
    [DVec2::new(0.1, 0.2), DVec2::new(1.7, -0.3), DVec2::new(0.9, 1.2)],
    [DVec2::new(0.1, 0.2), DVec2::new(1.7, 0.3), DVec2::new(0.9, -1.2)],
    [DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(2.0, 1e-3)],
];

/// Moves one coordinate.
fn moved(mut z: [DVec2; 3], coordinate: usize, by: f64) -> [DVec2; 3] {
    z[coordinate / 2][coordinate % 2] += by;
    z
}

const FREE: Energy = Energy::Foldover(0.0);
const SIZED: Energy = Energy::AtSize { size: 1.3, pressure: -0.6 };

#[test]
fn a_triangle_at_rest_has_the_least_energy() {
    let rest = [DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(0.4, 1.5)];
    let turned = rest.map(|z| DVec2::from_angle(1.0).rotate(z) + DVec2::new(3.0, 4.0));
    let element = element();
    assert!((element.determinant(rest) - 1.0).abs() < 1e-14);
    for energy in [FREE, Energy::SymmetricDirichlet] {
        assert!((element.energy(rest, energy) - 2.0 * 0.7).abs() < 1e-13);
        assert!((element.energy(turned, energy) - 2.0 * 0.7).abs() < 1e-13);
        assert!(element.model(rest, energy).gradient.iter().all(|g| g.abs() < 1e-13));
    }
}

#[test]
fn the_gradient_is_that_of_the_energy() {
    let energies = [FREE, Energy::Foldover(0.3), Energy::Foldover(0.01), Energy::SymmetricDirichlet];
    let unfolded = [(PLACES[0], energies[3]), (PLACES[0], SIZED)];
    for (z, energy) in PLACES.into_iter().zip(energies).chain(unfolded) {
        for (i, derivative) in element().model(z, energy).gradient.iter().enumerate() {
            let [after, before] = [1e-6, -1e-6].map(|h| element().energy(moved(z, i, h), energy));
            let difference = (after - before) / 2e-6;
            assert!((difference - derivative).abs() < 1e-6 * (1.0 + derivative.abs()), "{difference} {derivative}");
        }
    }
}

#[test]
fn the_hessian_is_that_of_the_energy_where_it_is_convex() {
    // Near the rest shape, where nothing had to be made positive.
    let z = [DVec2::new(0.01, 0.0), DVec2::new(2.02, 0.1), DVec2::new(0.4, 1.53)];
    for energy in [FREE, Energy::SymmetricDirichlet, Energy::AtSize { size: 1.02, pressure: 0.05 }] {
        let model = element().model(z, energy);
        for i in 0..6 {
            let [after, before] = [1e-5, -1e-5].map(|h| element().model(moved(z, i, h), energy).gradient);
            for j in 0..6 {
                let difference = (after[j] - before[j]) / 2e-5;
                assert!((difference - model.hessian[i][j]).abs() < 1e-6, "{i} {j}: {difference}");
            }
        }
    }
}

#[test]
fn the_longest_step_ends_where_the_triangle_has_no_area() {
    let z = PLACES[0];
    for direction in PLACES {
        let step = Element::longest_step(z, direction);
        if step.is_finite() {
            let end = [0, 1, 2].map(|k| z[k] + step * direction[k]);
            assert!((end[1] - end[0]).perp_dot(end[2] - end[0]).abs() < 1e-12);
        }
    }
}

#[test]
fn folded_triangles_have_infinite_energy_behind_a_barrier_and_a_finite_one_without() {
    assert!(element().energy(PLACES[1], FREE).is_infinite());
    assert!(element().energy(PLACES[1], Energy::SymmetricDirichlet).is_infinite());
    assert!(element().energy(PLACES[1], Energy::Foldover(1e-6)).is_finite());
}
