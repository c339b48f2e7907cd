//! Angle based flattening: the angles of all faces are solved for, and the plane is laid out from them.
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
//! Angles that meet these conditions are those of a layout in the plane, with every face positive: the third condition, the
//! *wheel*, says that going once around v by the law of sines comes back to the length of the edge where it began. The
//! source has it as the product of the sines; in logarithms it holds for the same angles, and depends on them evenly
//! however many faces a vertex has. φ are the angles on the surface, scaled around each inner vertex to a sum of 2π.
//!
//! The two systems of a Newton step are the two methods:
//!
//! ```text
//! ⎡ W  Jᵀ ⎤ ⎡ δ  ⎤   ⎡ −∇E ⎤     abf:    all of it, angles and multipliers
//! ⎣ J  0  ⎦ ⎣ λ⁺ ⎦ = ⎣ −c  ⎦     abf++:  W is diagonal: angles, then faces' multipliers eliminated, two unknowns per
//!                                        inner vertex remain, positive definite
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | [`angle_based`]: from a disk to an embedding |
//! | `net.rs` | inner vertices, angles on the surface, the conditions around vertices |
//! | `newton.rs` | the way to the least energy: steps, their lengths, the end |
//! | `reduced.rs` | a step of abf++ |
//! | `full.rs`, `pairs.rs` | a step of abf; the angles that its multipliers are eliminated with |
//! | `layout.rs` | from angles to the plane, by least squares |
//!
//! # Symbols
//!
//! | source | code          | meaning                                              | unit    |
//! |--------|---------------|------------------------------------------------------|---------|
//! | α      | `angles`      | angles in the plane, three per face                  | radians |
//! | φ      | `targets`     | angles on the surface, scaled                        | radians |
//! | λ      | `multipliers` | of sum and wheel, per inner vertex                   | none    |
//! | c      | `gaps`        | what is left of sum and wheel, per inner vertex      | radians, none |
//! | W      | `curvatures`  | diagonal of the Lagrangian's Hessian, kept positive  | 1/radian² |
//!
//! Source: A. Sheffer, E. de Sturler, "Parameterization of Faceted Surfaces for Meshing using Angle-Based Flattening", 2001;
//! A. Sheffer, B. Lévy, M. Mogilnitsky, A. Bogomyakov, "ABF++: Fast and Robust Angle Based Flattening", 2005.

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

/// Which linear system a Newton step solves. Both have the same solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleSystem {
    /// Of angles and multipliers together (Sheffer, de Sturler 2001).
    Full,
    /// Of the multipliers of inner vertices, all others eliminated (Sheffer et al. 2005).
    Reduced,
}

/// An embedding by its angles.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleMap {
    /// The embedding that fits the angles best in the least-squares sense, and the numbers of its solve. The convergence is
    /// that of the angles: Newton steps, and the largest of the conditions that is left.
    pub solution: Solution,
    /// The angles of each face at its corners, in radians.
    pub angles: Vec<[f64; 3]>,
    /// Σ w (α − φ)².
    pub energy: f64,
    /// Weight κ of the barrier that the energy is the least with, 0 without one.
    pub barrier: f64,
    /// Angles that the barrier keeps from 0, where the least energy has them there.
    pub held: usize,
}

/// Computes the angles of least energy and lays them out. Polygons count as the triangles that they are cut into.
///
/// # Errors
///
/// Faces whose angles are no numbers, a singular system, a layout whose residual refinement cannot bring down, or the
/// caller's wish to stop.
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
    // Newton's steps, each with a factorization.
    solution.seconds.solve += seconds - analyzed;
    solution.convergence = Some(found.convergence);
    Ok(AngleMap { solution, angles: found.angles, energy: found.energy, barrier: found.barrier, held: found.held })
}
