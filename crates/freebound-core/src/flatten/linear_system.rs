//! Linear system of a step, as numbers: for a check with another solver, or for a study of the matrix.
//!
//! The row of a vertex v is its equation `Σ a_h (z_head(h) − z_v) = 0` over the links h that leave v (paper §3.2). Terms
//! of vertices with a known position are moved to the right-hand side, so their sign changes there. A soft pin adds the
//! row `w z_v = w t`.
//!
//! If the equations of hard pins are kept, or there are soft pins, the system has more rows than unknowns, and the step
//! minimises ‖A z − b‖.

use std::collections::BTreeMap;

use num_complex::Complex;

use super::Step;
use crate::mesh::{DiskMesh, HalfedgeId, VertexId};
use crate::problem::{Control, Embedding, Family, PinKind, Pins, SolveError, Stage};
use crate::weights::equations::{self, Equations, mean_edge_length};
use crate::weights::plane_weights::{mean_edge_length_in_plane, natural_in_plane};
use crate::weights::shape_preserving::shape_preserving;

/// Largest accepted ‖A z − b‖ of a step, or of its gradient, relative to the terms.
const MOST_RESIDUAL: f64 = 1e-6;

/// Row of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemRow {
    /// Equation of a vertex.
    Equation(VertexId),
    /// Soft pin of a vertex.
    SoftPin(VertexId),
}

/// Entry of a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemEntry {
    /// Row, from 0.
    pub row: usize,
    /// Column, from 0.
    pub column: usize,
    /// Value.
    pub value: Complex<f64>,
}

/// Linear system A z = b, with a position as a complex number u + iv.
#[derive(Clone, Debug, PartialEq)]
pub struct StepSystem {
    /// Vertices of the columns.
    pub unknowns: Vec<VertexId>,
    /// Rows of the matrix.
    pub rows: Vec<SystemRow>,
    /// Entries, row by row, columns ascending.
    pub entries: Vec<SystemEntry>,
    /// Right-hand side.
    pub right_side: Vec<Complex<f64>>,
    /// Vertices with a known position, which have no column.
    pub known: Vec<VertexId>,
    /// True if a coefficient has an imaginary part, so that u and v depend on each other.
    pub is_coupled: bool,
}

/// Reason why a step has no linear system to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoLinearSystem {
    /// The stage solves no linear system for positions, or an eigenproblem.
    #[error("this step solves no linear system: show one of Natural, Iterate or Convex boundary")]
    OtherStage,
    /// The weights come from a step that is no longer in memory.
    #[error("the step before, with its weights, is no longer in memory: solve again")]
    StepBeforeMissing,
    /// The step was changed after its solve.
    #[error("this step was changed after its linear solve: show another step")]
    Changed,
    /// The weights cannot be computed.
    #[error("the weights of this step cannot be computed again: show another step")]
    NoWeights,
}

/// Assembles the linear system that a step on `mesh` solved. `before` is the embedding of the step before.
///
/// # Errors
///
/// [`NoLinearSystem`] with the reason.
pub fn linear_system_of_step(
    mesh: &DiskMesh,
    step: &Step,
    before: Option<&Embedding>,
) -> Result<StepSystem, NoLinearSystem> {
    let candidate = &step.candidate;
    let linear = candidate.solution.linear.filter(|_| candidate.refinement.is_none() && !step.is_spectral());
    let linear = linear.ok_or(NoLinearSystem::OtherStage)?;
    let found = match &candidate.stage {
        Stage::Iterate => {
            let before = before.ok_or(NoLinearSystem::StepBeforeMissing)?;
            natural_in_plane(mesh, before, Control::unattended())
        }
        stage => equations_on_surface(mesh, stage, candidate.family).ok_or(NoLinearSystem::OtherStage)?,
    };
    let weights = found.map_err(|_| NoLinearSystem::NoWeights)?;
    let unit = match (&candidate.stage, before) {
        (Stage::Iterate, Some(before)) => mean_edge_length_in_plane(mesh, before),
        _ => mean_edge_length(mesh).powf(1.0 - power_of(&candidate.stage, candidate.family)),
    };
    let parts = Parts {
        mesh,
        weights: &weights,
        pins: &candidate.solution.pins,
        embedding: &candidate.solution.embedding,
        keeps_equations: linear.keeps_equations,
        unit,
    };
    let system = parts.assemble();
    if system.misfit(&candidate.solution.embedding) > MOST_RESIDUAL {
        return Err(NoLinearSystem::Changed);
    }
    Ok(system)
}

/// Power of the offsets of a stage with a free boundary.
fn power_of(stage: &Stage, family: Family) -> f64 {
    match stage {
        Stage::Levy | Stage::Lscm => Family::CONFORMAL_POWER,
        _ => family.power().unwrap_or(Family::CONFORMAL_POWER),
    }
}

type Found = Result<Equations<Complex<f64>>, SolveError>;

/// Equations of a stage with weights from the surface. `None` for other stages.
fn equations_on_surface(mesh: &DiskMesh, stage: &Stage, family: Family) -> Option<Found> {
    let control = Control::unattended();
    let power = power_of(stage, family);
    Some(match stage {
        Stage::Natural => equations::natural(mesh, power, control),
        Stage::Levy => equations::levy(mesh, control),
        Stage::Lscm => equations::lscm(mesh, control),
        Stage::Convex(_) => match family {
            Family::Uniform => Ok(equations::uniform(mesh).to_complex()),
            Family::ShapePreserving => Ok(shape_preserving(mesh).to_complex()),
            _ => equations::barycentric(mesh, power, control).map(|of| of.to_complex()),
        },
        _ => return None,
    })
}

/// Parts that a system is assembled from.
struct Parts<'a> {
    mesh: &'a DiskMesh,
    weights: &'a Equations<Complex<f64>>,
    pins: &'a Pins,
    embedding: &'a Embedding,
    /// True if the equations of hard pins have rows.
    keeps_equations: bool,
    /// Factor of the weights of soft pins.
    unit: f64,
}

impl Parts<'_> {
    fn assemble(&self) -> StepSystem {
        let mesh = self.mesh;
        let is_known = |v: &VertexId| self.pins.get(v).is_some_and(|pin| pin.kind.is_hard());
        let (known, unknowns): (Vec<_>, Vec<_>) = mesh.vertices().filter(|&v| mesh.is_used(v)).partition(is_known);
        let columns: BTreeMap<VertexId, usize> = unknowns.iter().enumerate().map(|(column, &v)| (v, column)).collect();
        let mut system = StepSystem {
            rows: Vec::new(),
            entries: Vec::new(),
            right_side: Vec::new(),
            is_coupled: self.weights.coefficients.iter().any(|a| a.im.abs() > 0.0),
            unknowns,
            known,
        };
        let has_row = |v: &VertexId| mesh.is_used(*v) && (self.keeps_equations || columns.contains_key(v));
        for vertex in mesh.vertices().filter(has_row) {
            let mut row = BTreeMap::from([(vertex, Complex::ZERO)]);
            for link in mesh.links_from(vertex) {
                let a = self.weights.coefficients[HalfedgeId::index(link)];
                *row.entry(mesh.head(link)).or_default() += a;
                *row.entry(vertex).or_default() -= a;
            }
            let mut right_side = Complex::ZERO;
            for (other, value) in row {
                match columns.get(&other) {
                    Some(&column) => system.entries.push(SystemEntry { row: system.rows.len(), column, value }),
                    None => right_side -= value * complex(self.embedding[other]),
                }
            }
            system.rows.push(SystemRow::Equation(vertex));
            system.right_side.push(right_side);
        }
        for (&vertex, pin) in self.pins {
            if let (PinKind::Soft(weight), Some(&column)) = (pin.kind, columns.get(&vertex)) {
                let value = Complex::new(weight / self.unit, 0.0);
                system.entries.push(SystemEntry { row: system.rows.len(), column, value });
                system.rows.push(SystemRow::SoftPin(vertex));
                system.right_side.push(value * complex(pin.target));
            }
        }
        system
    }
}

impl StepSystem {
    /// True if there are as many rows as unknowns.
    pub fn is_square(&self) -> bool {
        self.rows.len() == self.unknowns.len()
    }

    /// Distance of an embedding from the solution: the residual, or its gradient if there are more rows than unknowns,
    /// relative to the sizes of the terms.
    fn misfit(&self, embedding: &Embedding) -> f64 {
        let mut residuals: Vec<Complex<f64>> = self.right_side.iter().map(|b| -b).collect();
        let mut sizes: Vec<f64> = self.right_side.iter().map(|b| b.norm()).collect();
        for &SystemEntry { row, column, value } in &self.entries {
            let term = value * complex(embedding[self.unknowns[column]]);
            residuals[row] += term;
            sizes[row] += term.norm();
        }
        if !self.is_square() {
            let mut gradient = vec![(Complex::ZERO, 0.0); self.unknowns.len()];
            for &SystemEntry { row, column, value } in &self.entries {
                gradient[column].0 += value.conj() * residuals[row];
                gradient[column].1 += value.norm() * sizes[row];
            }
            (residuals, sizes) = gradient.into_iter().unzip();
        }
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>();
        let (misfit, whole) = (square(&mut residuals.iter().map(|z| z.norm())), square(&mut sizes.iter().copied()));
        if whole > 0.0 { (misfit / whole).sqrt() } else { 0.0 }
    }
}

fn complex(z: glam::DVec2) -> Complex<f64> {
    Complex::new(z.x, z.y)
}
