//! LU on the system that it was made for: the mean-value equations with a natural boundary. The disk is squeezed
//! into its middle over many decades.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use freebound_core::linalg::{Analysis, Factor, Kind};
use nalgebra_sparse::{CooMatrix, CscMatrix};
use num_complex::Complex;

type C = Complex<f64>;

/// Disk of rings of vertices around a middle vertex, the last ring the widest. Each ring is `ratio` times as wide as
/// the next; alternate rings are rotated by half a step.
struct Disk {
    points: Vec<C>,
    faces: Vec<[usize; 3]>,
}

const SECTORS: usize = 12;

fn disk(rings: usize, ratio: f64) -> Disk {
    let mut points = vec![C::new(0.0, 0.0)];
    let mut faces = Vec::new();
    for ring in 0..rings {
        let radius = ratio.powi(i32::try_from(rings - 1 - ring).expect("few rings"));
        for sector in 0..SECTORS {
            let turn = (sector as f64 + 0.5 * (ring % 2) as f64) / SECTORS as f64;
            points.push(C::from_polar(radius, TAU * turn));
        }
        let vertex = |ring: usize, sector: usize| 1 + ring * SECTORS + sector % SECTORS;
        for sector in 0..SECTORS {
            let (a, b) = (vertex(ring, sector), vertex(ring, sector + 1));
            if ring == 0 {
                faces.push([0, a, b]);
                continue;
            }
            // A vertex of an odd ring is between the inner ring's vertices with its own number and the next. A
            // vertex of an even ring is between the previous number and its own.
            let first = sector + SECTORS - usize::from(ring % 2 == 0);
            let (c, d) = (vertex(ring - 1, first), vertex(ring - 1, first + 1));
            faces.push([c, a, d]);
            faces.push([d, a, b]);
        }
    }
    Disk { points, faces }
}

/// Mean-value equations (paper, eqs. 1 to 3 with d = 1) of all vertices except the first and the middle one of the
/// outer ring, which are pinned in place; and the positions of the free vertices.
fn system(disk: &Disk) -> (CscMatrix<C>, Vec<C>, Vec<C>) {
    let count = disk.points.len();
    let pins = [count - SECTORS, count - SECTORS / 2];
    let free: Vec<usize> = (0..count).filter(|vertex| !pins.contains(vertex)).collect();
    let row_of = |vertex: usize| free.binary_search(&vertex);
    let mut entries = CooMatrix::new(free.len(), free.len());
    let mut rhs = vec![C::new(0.0, 0.0); free.len()];
    for face in &disk.faces {
        for k in 0..3 {
            let corner = [face[k], face[(k + 1) % 3], face[(k + 2) % 3]];
            let Ok(row) = row_of(corner[0]) else { continue };
            let [z0, z1, z2] = corner.map(|vertex| disk.points[vertex]);
            let (e1, e2) = (z1 - z0, z2 - z0);
            let (r1, r2) = (e1.norm(), e2.norm());
            let product = e1.conj() * e2;
            assert!(product.im > 0.0, "face {face:?} is flipped");
            let tan_half = product.im / (r1 * r2 + product.re);
            let (a1, a2) = (C::new(tan_half, -1.0) / r1, C::new(tan_half, 1.0) / r2);
            for (vertex, value) in [(corner[0], -a1 - a2), (corner[1], a1), (corner[2], a2)] {
                match row_of(vertex) {
                    Ok(column) => entries.push(row, column, value),
                    Err(_) => rhs[row] -= value * disk.points[vertex],
                }
            }
        }
    }
    let exact = free.iter().map(|&vertex| disk.points[vertex]).collect();
    (CscMatrix::from(&entries), rhs, exact)
}

fn factored(matrix: &CscMatrix<C>) -> Factor<C> {
    let analysis = Analysis::new(Kind::General, matrix.pattern(), &AtomicBool::new(false)).expect("symmetric");
    analysis.factor(matrix, &AtomicBool::new(false)).expect("regular")
}

#[test]
fn a_disk_squeezed_over_twenty_decades_of_area_comes_back() {
    // Radii range from 1 to 0.6⁴⁶ = 6e-11; areas and squared row sizes span 20 decades.
    let (matrix, rhs, exact) = system(&disk(47, 0.6));
    let factor = factored(&matrix);
    assert_eq!(factor.stats().replaced_pivots, 0);
    let solved = factor.solve(&matrix, &rhs, &AtomicBool::new(false)).expect("regular");
    assert!(solved.scaled_residual < 1e-14, "{}", solved.scaled_residual);
    assert!(solved.residual < 1e-12, "{}", solved.residual);
    let worst = solved.x.iter().zip(&exact).map(|(x, z)| (x - z).norm()).fold(0.0, f64::max);
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn the_adjoint_of_the_squeezed_system_is_solved_too() {
    let (matrix, rhs, _) = system(&disk(47, 0.6));
    let solved = factored(&matrix).solve_adjoint(&matrix, &rhs, &AtomicBool::new(false)).expect("regular");
    assert!(solved.residual < 1e-12, "{}", solved.residual);
}
