//! Times of the sparse factorizations on jittered grids with random diagonals: `cargo bench --bench linalg -- 100000`.
//!
//! The Cholesky factorization of the conformal system and the LU of the mean-value system of one mesh have the same
//! pattern and the same order, so that their times and memory compare.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use freebound::linalg::{Analysis, Kind};
use nalgebra_sparse::{CooMatrix, CscMatrix};
use num_complex::Complex;

type C = Complex<f64>;

/// Factorizations timed for each line; the fastest counts.
const ROUNDS: usize = 3;

struct Mesh {
    points: Vec<C>,
    faces: Vec<[usize; 3]>,
}

/// A grid of about `count` vertices, each moved by up to a fifth of a cell, every cell cut by a random diagonal.
fn jittered_grid(count: usize) -> Mesh {
    let side = count.isqrt();
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut points = Vec::with_capacity(side * side);
    let mut faces = Vec::new();
    for row in 0..side {
        for column in 0..side {
            points.push(C::new(column as f64 + 0.4 * random() - 0.2, row as f64 + 0.4 * random() - 0.2));
        }
    }
    for row in 0..side - 1 {
        for column in 0..side - 1 {
            let a = row * side + column;
            let (b, c, d) = (a + 1, a + side + 1, a + side);
            let cut = if random() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            faces.extend(cut);
        }
    }
    Mesh { points, faces }
}

enum Family {
    Conformal,
    MeanValue,
}

/// The natural-boundary system with the first and last vertex pinned, and its right-hand side.
fn system(mesh: &Mesh, family: &Family) -> (CscMatrix<C>, Vec<C>) {
    let last = mesh.points.len() - 1;
    let n = mesh.points.len() - 2;
    let mut entries = CooMatrix::new(n, n);
    let mut rhs = vec![C::new(0.0, 0.0); n];
    for face in &mesh.faces {
        for k in 0..3 {
            let corner = [face[k], face[(k + 1) % 3], face[(k + 2) % 3]];
            let [z0, z1, z2] = corner.map(|v| mesh.points[v]);
            let (e1, e2) = (z1 - z0, z2 - z0);
            let (r1, r2) = (e1.norm(), e2.norm());
            let (dot, cross) = (e1.re * e2.re + e1.im * e2.im, e1.re * e2.im - e1.im * e2.re);
            let (a1, a2) = match family {
                Family::MeanValue => {
                    let tan_half = cross / (r1 * r2 + dot);
                    (C::new(tan_half, -1.0) / r1, C::new(tan_half, 1.0) / r2)
                }
                Family::Conformal => (C::new((r2 * r2 - dot) / cross, -1.0), C::new((r1 * r1 - dot) / cross, 1.0)),
            };
            if corner[0] == 0 || corner[0] == last {
                continue;
            }
            for (vertex, value) in [(corner[0], -a1 - a2), (corner[1], a1), (corner[2], a2)] {
                if vertex == 0 || vertex == last {
                    rhs[corner[0] - 1] -= value * mesh.points[vertex];
                } else {
                    entries.push(corner[0] - 1, vertex - 1, value);
                }
            }
        }
    }
    (CscMatrix::from(&entries), rhs)
}

/// Seconds of processor time that this process has used, on Linux; on a machine with other work to do it says more.
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let field = |index: usize| stat.split(' ').nth(index).and_then(|text| text.parse::<f64>().ok()).unwrap_or(0.0);
    (field(13) + field(14)) / 100.0
}

fn time<R>(run: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = run();
    (start.elapsed().as_secs_f64(), result)
}

fn measure(mesh: &Mesh, kind: Kind, family: &Family) -> (f64, usize) {
    let (matrix, rhs) = system(mesh, family);
    let cancel = AtomicBool::new(false);
    let (analysis_seconds, analysis) = time(|| Analysis::new(kind, matrix.pattern()).expect("a symmetric pattern"));
    let mut fastest = f64::INFINITY;
    let (mut earlier, mut processor) = (Vec::new(), f64::INFINITY);
    for _ in 1..ROUNDS {
        let before = processor_seconds();
        let (seconds, factor) = time(|| analysis.factor(&matrix, &cancel).expect("regular"));
        processor = processor.min(processor_seconds() - before);
        fastest = fastest.min(seconds);
        earlier = factor.solve(&matrix, &rhs).expect("good").x;
    }
    let (seconds, factor) = time(|| analysis.factor(&matrix, &cancel).expect("regular"));
    fastest = fastest.min(seconds);
    let (solve_seconds, solved) = time(|| factor.solve(&matrix, &rhs).expect("good"));
    assert!(solved.x == earlier, "two factorizations of one matrix differ");
    let many: Vec<C> = rhs.iter().copied().cycle().take(8 * rhs.len()).collect();
    let (many_seconds, adjoint) = time(|| factor.solve_adjoint_many(&matrix, &many).expect("good"));
    let inner = &mesh.points[1..mesh.points.len() - 1];
    let deviation = solved.x.iter().zip(inner).map(|(x, z)| (x - z).norm()).fold(0.0, f64::max);
    let stats = factor.stats();
    println!(
        "{kind:?} n={} analysis {analysis_seconds:.3} s, factor {fastest:.3} s ({processor:.2} s of processor), solve {solve_seconds:.3} s, eight adjoint {many_seconds:.3} s ({} steps, {:.1e}), residual {:.1e}, \
         {} steps, deviation {deviation:.1e}, replaced {}, factors {:.1} MB, peak {:.1} MB",
        matrix.nrows(),
        adjoint.refinement_steps,
        adjoint.residual,
        solved.residual,
        solved.refinement_steps,
        stats.replaced_pivots,
        stats.factor_bytes as f64 / 1e6,
        stats.peak_bytes as f64 / 1e6,
    );
    (fastest, stats.factor_bytes)
}

fn main() {
    let sizes: Vec<usize> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![100_000] } else { sizes };
    for n in sizes {
        let mesh = jittered_grid(n);
        let (llt_seconds, llt_bytes) = measure(&mesh, Kind::Hermitian, &Family::Conformal);
        let (lu_seconds, lu_bytes) = measure(&mesh, Kind::General, &Family::MeanValue);
        println!("LU / LLT: time {:.2}, factors {:.2}", lu_seconds / llt_seconds, lu_bytes as f64 / llt_bytes as f64);
    }
}
