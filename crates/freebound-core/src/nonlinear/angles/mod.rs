//! Angle based flattening: solves for the angles of all faces, then lays out the plane from them.
//!
//! # Equation
//!
//! ```text
//! min  Σ_i w_i (α_i − φ_i)²,   w_i = 1/φ_i²                     over all corners i of all faces, so that
//!      α_t1 + α_t2 + α_t3 = π                                   in every face t
//!      Σ α_i = 2π                                               around every inner vertex v
//!      Σ ln sin α_next − Σ ln sin α_previous = 0                around every inner vertex v
//! ```
//!
//! Angles that meet these conditions belong to a layout in the plane whose faces are all positive. The third condition
//! is the *wheel*: walking once around v by the law of sines returns to the length of the first edge. The source
//! states it as a product of sines. The logarithmic form is equivalent, and depends on each angle evenly for any
//! number of faces at a vertex. φ are the angles on the surface, scaled around each inner vertex to a sum of 2π.
//!
//! The two systems of a Newton step are the two methods:
//!
//! ```text
//! ⎡ W  Jᵀ ⎤ ⎡ δ  ⎤   ⎡ −∇E ⎤     abf:    the whole system, angles and multipliers
//! ⎣ J  0  ⎦ ⎣ λ⁺ ⎦ = ⎣ −c  ⎦     abf++:  W is diagonal: angles, then faces' multipliers eliminated, two unknowns per
//!                                        inner vertex remain, positive definite
//! ```
//!
//! | file | contents |
//! |---|---|
//! | `mod.rs` | [`angle_based`]: from a disk to an embedding |
//! | `net.rs` | inner vertices, angles on the surface, conditions around vertices |
//! | `newton.rs` | Newton iteration: steps, step lengths, stop criteria |
//! | `reduced.rs` | a step of ABF++ |
//! | `full.rs`, `pairs.rs` | a step of ABF; the angles that its multipliers are eliminated with |
//! | `layout.rs` | from angles to the plane, by least squares |
//!
//! # Symbols
//!
//! | source | code          | meaning                                              | unit    |
//! |--------|---------------|------------------------------------------------------|---------|
//! | α      | `angles`      | angles in the plane, three per face                  | radians |
//! | φ      | `targets`     | angles on the surface, scaled                        | radians |
//! | λ      | `multipliers` | of sum and wheel, per inner vertex                   | none    |
//! | c      | `gaps`        | residuals of sum and wheel, per inner vertex         | radians, none |
//! | W      | `curvatures`  | diagonal of the Lagrangian's Hessian, kept positive  | 1/radian² |
//!
//! Source: A. Sheffer, E. de Sturler, "Parameterization of Faceted Surfaces for Meshing using Angle-Based Flattening",
//! 2001; A. Sheffer, B. Lévy, M. Mogilnitsky, A. Bogomyakov, "ABF++: Fast and Robust Angle Based Flattening", 2005.

mod full;
mod layout;
mod net;
mod newton;
mod pairs;
mod reduced;

use std::time::Instant;

use self::net::Net;
use self::newton::Newton;
use crate::mesh::DiskMesh;
use crate::problem::{Control, Phase, Solution, SolveError};

/// Linear system of a Newton step. Both variants have one and the same solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleSystem {
    /// Angles and multipliers together (Sheffer, de Sturler 2001).
    Full,
    /// Multipliers of inner vertices, with all other unknowns eliminated (Sheffer et al. 2005).
    Reduced,
}

/// An embedding computed from angles.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleMap {
    /// Least-squares fit of an embedding to the angles, with the numbers of its solve. The convergence describes the
    /// angles: Newton steps, and the largest residual of the conditions.
    pub solution: Solution,
    /// Angles of each face at its corners, in radians.
    pub angles: Vec<[f64; 3]>,
    /// Energy Σ w (α − φ)².
    pub energy: f64,
    /// Weight κ of the barrier with which the energy was minimised; 0 without a barrier.
    pub barrier: f64,
    /// Number of angles that the barrier keeps from 0 and that would vanish at the minimum of the energy.
    pub held: usize,
}

/// Computes the angles of least energy and lays them out. Polygons count as the triangles they are cut into.
///
/// # Errors
///
/// Fails if angles are not finite, a system is singular, or refinement cannot reduce the residual of the layout. Also
/// fails if the caller cancels.
pub fn angle_based(mesh: &DiskMesh, system: AngleSystem, control: Control<'_>) -> Result<AngleMap, SolveError> {
    control.enter(Phase::Assemble)?;
    let start = Instant::now();
    let net = Net::new(mesh)?;
    let assembled = start.elapsed().as_secs_f64();
    control.enter(Phase::Analyze)?;
    let newton = Newton::new(&net, system, control)?;
    let analyzed = start.elapsed().as_secs_f64();
    let found = newton.run(control)?;
    let seconds = start.elapsed().as_secs_f64();
    let mut solution = layout::laid_out(mesh, &found.angles, control)?;
    solution.seconds.assemble += assembled;
    solution.seconds.analyze += analyzed - assembled;
    // Time of all Newton steps, each with a factorization.
    solution.seconds.solve += seconds - analyzed;
    solution.convergence = Some(found.convergence);
    Ok(AngleMap { solution, angles: found.angles, energy: found.energy, barrier: found.barrier, held: found.held })
}
