//! Layout of angles in the plane: the embedding whose faces have the given angles, or angles nearest to them.
//!
//! # Equation
//!
//! A face with angles α has the shape of a triangle with sides sin α. The least-squares conformal map of faces with
//! these shapes, joined at edges, is the source's system of equations
//!
//! ```text
//! z₂ − z₀ = (sin α₁ / sin α₂) e^{iα₀} (z₁ − z₀)         per face, weighted so that all three corners count equally
//! ```
//!
//! in least squares. Its normal equations are the natural boundary equations with cot α of the solved angles in place
//! of the surface's angles. They are Hermitian, n × n, and exact if the angles meet their conditions. Two pins fix the
//! similarity; in the exact case their choice does not matter.
//!
//! Source: A. Sheffer, B. Lévy, M. Mogilnitsky, A. Bogomyakov, "ABF++", 2005, §4.2, after B. Lévy, S. Petitjean, N.
//! Ray, J. Maillot, "Least squares conformal maps", 2002.

use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use crate::linalg::Kind;
use crate::linear::free_layout::{Numbers, Unanalysed, Way};
use crate::linear::free_solve::{FreeSolve, SolveStart};
use crate::linear::system::Site;
use crate::mesh::{DiskMesh, HalfedgeId};
use crate::problem::pins::{fixed_pins, gauge_pins};
use crate::problem::{Control, Embedding, Phase, PhaseSeconds, Solution, SolveError, Treatment};
use crate::weights::corner_weights::bounded;
use crate::weights::equations::Equations;

/// Largest number of solves, each starting from the previous result. Thin faces have large cotangents, and residuals
/// are more accurate when measured on edges than on positions.
const SOLVES: usize = 3;

/// Lays out faces with the given angles. The gauge pins have their default targets.
pub(super) fn laid_out(mesh: &DiskMesh, angles: &[[f64; 3]], control: Control<'_>) -> Result<Solution, SolveError> {
    control.enter(Phase::Assemble)?;
    let start = Instant::now();
    let equations = equations_of(mesh, angles);
    let targets = gauge_pins(mesh);
    let mut seconds = PhaseSeconds { assemble: start.elapsed().as_secs_f64(), ..PhaseSeconds::default() };
    let way = Way { treatment: Treatment::Eliminate, gauge: None };
    let pins = fixed_pins(targets.clone());
    let laid_out = Unanalysed::new(mesh, &pins, way, Kind::Hermitian, control)?.analysed_now(mesh, control)?;
    seconds.analyze = laid_out.seconds;
    let solve = FreeSolve::new(mesh, &laid_out, Numbers { equations, matrix: None, unit: 1.0 }, &mut seconds, control)?;
    let site = Site { mesh, system: &laid_out.system };
    control.enter(Phase::Solve)?;
    let start = Instant::now();
    let mut embedding = Embedding::from(vec![DVec2::ZERO; mesh.vertex_count()]);
    for (&vertex, &target) in &targets {
        embedding[vertex] = target;
    }
    let mut residual = f64::INFINITY;
    for _ in 0..SOLVES {
        let start = SolveStart { embedding: &embedding, residuals: &solve.residuals(mesh, &embedding, control)? };
        let (nearer, left) = solve.solve_from(site, start, &targets, control)?;
        if left >= residual || left.is_nan() {
            break;
        }
        (embedding, residual) = (nearer, left);
    }
    let linear = Some(solve.numbers(mesh, &embedding, residual, control)?);
    seconds.solve = start.elapsed().as_secs_f64();
    let pins = fixed_pins(targets);
    Ok(Solution { embedding, pins, gauge_completed: true, linear, convergence: None, seconds })
}

/// Natural boundary equations with cotangents of the given angles in place of those of the surface.
fn equations_of(mesh: &DiskMesh, angles: &[[f64; 3]]) -> Equations<Complex<f64>> {
    let mut coefficients = vec![Complex::ZERO; mesh.link_count()];
    let mut bounded_corners = 0;
    for (face, angles) in angles.iter().enumerate() {
        for (k, angle) in angles.iter().enumerate() {
            let (cotangent, was_bounded) = bounded(angle.tan().recip());
            bounded_corners += usize::from(was_bounded);
            let opposite = HalfedgeId::from_index(3 * face + (k + 1) % 3);
            for side in [opposite, mesh.twin(opposite)] {
                coefficients[side.index()] += cotangent;
            }
        }
    }
    let mut equations = Equations { coefficients, bounded_corners };
    equations.add_boundary_terms(mesh, |_| 1.0);
    equations
}
