//! A method made ready for one mesh and one set of pinned vertices: equations, matrix and factors.
//!
//! New targets for the same pinned vertices then cost one substitution. That is what makes a pin follow the pointer.

use std::collections::BTreeMap;
use std::time::Instant;

use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::convex::convex_boundary;
use super::equations::{self, Equations};
use super::pins::{Pins, check_pins, gauge_pins};
use super::scale::to_true_area;
use super::shape_preserving::shape_preserving;
use super::system::FreeSystem;
use super::{BoundaryShape, Control, Family, Method, Phase, PhaseSeconds, Settings, Solution, SolveError};
use crate::linalg::{Analysis, Factor, FactorStats, Kind, LinalgError, Scalar};
use crate::mesh::{DiskMesh, VertexId};

/// Fewest pins that fix the similarity of a free boundary.
const PINS_NEEDED: usize = 2;

/// Everything about a solve that does not depend on where the pins are to go.
pub struct Prepared {
    settings: Settings,
    /// The pinned vertices as the user gave them: whether this preparation fits is asked of these.
    asked: Vec<VertexId>,
    /// Gauge pins or the convex boundary, where the solver places vertices by itself.
    own_pins: Option<Pins>,
    system: FreeSystem,
    values: Values,
    seconds: PhaseSeconds,
}

impl std::fmt::Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Prepared").field("settings", &self.settings).field("asked", &self.asked).finish_non_exhaustive()
    }
}

/// Equations, matrix and factors over one of the two scalars.
struct Factored<T: Scalar> {
    equations: Equations<T>,
    matrix: CscMatrix<T>,
    factor: Factor<T>,
}

impl<T: Scalar> Factored<T> {
    /// The numbers of the matrix, and the equations' residual as `residual` measures it.
    fn told(&self, residual: impl Fn(&Equations<T>) -> f64) -> (FactorStats, usize, f64) {
        (self.factor.stats(), self.equations.bounded_corners, residual(&self.equations))
    }
}

enum Values {
    /// A free boundary couples x and y: one complex unknown per vertex.
    Free(Factored<Complex<f64>>),
    /// A prescribed boundary does not: one real matrix, two right-hand sides.
    Prescribed(Factored<f64>),
}

/// Solves for an embedding.
///
/// # Errors
///
/// See [`Prepared::new`] and [`Prepared::solve`].
pub fn flatten(
    mesh: &DiskMesh,
    settings: &Settings,
    pins: &Pins,
    control: Control<'_>,
) -> Result<Solution, SolveError> {
    Prepared::new(mesh, settings, pins, control)?.solve(mesh, pins, control)
}

impl Prepared {
    /// Computes weights, matrix and factors for the vertices that `pins` holds.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, a family that does not go with the method, degenerate weights, a singular matrix, or the
    /// caller's wish to stop.
    pub fn new(mesh: &DiskMesh, settings: &Settings, pins: &Pins, control: Control<'_>) -> Result<Self, SolveError> {
        check_family(settings)?;
        let pins = if settings.method.uses_pins() { pins } else { &Pins::new() };
        check_pins(mesh, pins)?;
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let own_pins = match settings.method {
            Method::Convex(shape) => Some(convex_boundary(mesh, shape)?),
            _ if pins.len() < PINS_NEEDED => Some(gauge_pins(mesh)),
            _ => None,
        };
        let system = FreeSystem::new(mesh, |v| own_pins.as_ref().unwrap_or(pins).contains_key(&v));
        let mut seconds = PhaseSeconds::default();
        let values = match settings.method {
            Method::Convex(_) => {
                let equations = convex_equations(mesh, settings.family)?;
                let symmetric = matches!(settings.family, Family::Conformal | Family::Uniform);
                seconds.assemble = start.elapsed().as_secs_f64();
                Values::Prescribed(factor((mesh, &system), equations, kind(symmetric), &mut seconds, control)?)
            }
            method => {
                let equations = match method {
                    Method::Levy => equations::levy(mesh)?,
                    Method::Lscm => equations::lscm(mesh)?,
                    _ => equations::natural(mesh, settings.family.power().unwrap_or(Family::CONFORMAL_POWER))?,
                };
                let hermitian = match method {
                    Method::Lscm => true,
                    Method::Levy => false,
                    _ => settings.family.power() == Some(Family::CONFORMAL_POWER),
                };
                seconds.assemble = start.elapsed().as_secs_f64();
                Values::Free(factor((mesh, &system), equations, kind(hermitian), &mut seconds, control)?)
            }
        };
        let asked = pins.keys().copied().collect();
        Ok(Self { settings: *settings, asked, own_pins, system, values, seconds })
    }

    /// Whether this preparation serves these settings and pinned vertices.
    pub fn serves(&self, settings: &Settings, pins: &Pins) -> bool {
        let same_vertices = || self.asked.iter().eq(pins.keys());
        self.settings == *settings && (!settings.method.uses_pins() || same_vertices())
    }

    /// Solves for the embedding that has the pins on their targets.
    ///
    /// Fewer than two pins leave a similarity open: none, and the gauge pins stand in; one, and that solution is moved
    /// onto the target. Either way the embedding has the area of the surface.
    ///
    /// # Errors
    ///
    /// Pins that cannot be, a residual that refinement cannot bring down, or the caller's wish to stop.
    pub fn solve(&self, mesh: &DiskMesh, pins: &Pins, control: Control<'_>) -> Result<Solution, SolveError> {
        let pins = if self.settings.method.uses_pins() { pins } else { &Pins::new() };
        check_pins(mesh, pins)?;
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let in_force = self.own_pins.as_ref().unwrap_or(pins);
        let (unknowns, residual) = match &self.values {
            Values::Free(factored) => self.solve_free(mesh, factored, in_force)?,
            Values::Prescribed(factored) => self.solve_prescribed(mesh, factored, in_force)?,
        };
        let mut embedding = vec![DVec2::ZERO; mesh.vertex_count()];
        for (vertex, position) in self.system.free().iter().zip(unknowns) {
            embedding[vertex.index()] = position;
        }
        for (vertex, target) in in_force {
            embedding[vertex.index()] = *target;
        }
        let mut pins_in_force = in_force.clone();
        if self.own_pins.is_some() {
            to_true_area(mesh, &mut embedding);
            if let Some((vertex, target)) = pins.first_key_value() {
                let shift = *target - embedding[vertex.index()];
                for z in &mut embedding {
                    *z += shift;
                }
                embedding[vertex.index()] = *target;
            }
            for (vertex, place) in &mut pins_in_force {
                *place = embedding[vertex.index()];
            }
        }
        let on_convex = |v: VertexId| matches!(self.settings.method, Method::Convex(_)) && in_force.contains_key(&v);
        let (stats, bounded_corners, equation_residual) = match &self.values {
            Values::Free(factored) => factored.told(|equations| equations.residual(mesh, &embedding, |_| true)),
            Values::Prescribed(factored) => {
                factored.told(|equations| equations.to_complex().residual(mesh, &embedding, |v| !on_convex(v)))
            }
        };
        Ok(Solution {
            embedding,
            pins: pins_in_force,
            gauge_completed: self.own_pins.is_some(),
            residual,
            equation_residual,
            replaced_pivots: stats.replaced_pivots,
            bounded_corners,
            factor_bytes: stats.factor_bytes,
            seconds: PhaseSeconds { solve: start.elapsed().as_secs_f64(), ..self.seconds },
        })
    }

    fn solve_free(
        &self,
        mesh: &DiskMesh,
        factored: &Factored<Complex<f64>>,
        pins: &Pins,
    ) -> Result<(Vec<DVec2>, f64), SolveError> {
        let targets: BTreeMap<VertexId, Complex<f64>> =
            pins.iter().map(|(&v, t)| (v, Complex::new(t.x, t.y))).collect();
        let terms = self.system.pinned_terms(mesh, &factored.equations, &targets);
        let solved = factored.factor.solve(&factored.matrix, &terms).map_err(|error| self.named(error))?;
        Ok((solved.x.iter().map(|z| DVec2::new(z.re, z.im)).collect(), solved.residual))
    }

    fn solve_prescribed(
        &self,
        mesh: &DiskMesh,
        factored: &Factored<f64>,
        pins: &Pins,
    ) -> Result<(Vec<DVec2>, f64), SolveError> {
        let solve_axis = |axis: usize| {
            let targets: BTreeMap<VertexId, f64> = pins.iter().map(|(&v, t)| (v, t[axis])).collect();
            let terms = self.system.pinned_terms(mesh, &factored.equations, &targets);
            factored.factor.solve(&factored.matrix, &terms).map_err(|error| self.named(error))
        };
        let (x, y) = (solve_axis(0)?, solve_axis(1)?);
        let positions = x.x.iter().zip(&y.x).map(|(&x, &y)| DVec2::new(x, y)).collect();
        Ok((positions, x.residual.max(y.residual)))
    }

    fn named(&self, error: LinalgError) -> SolveError {
        in_vertices(error, self.system.free())
    }
}

fn kind(symmetric: bool) -> Kind {
    if symmetric { Kind::Hermitian } else { Kind::General }
}

fn check_family(settings: &Settings) -> Result<(), SolveError> {
    let convex = matches!(settings.method, Method::Convex(BoundaryShape::Circle | BoundaryShape::Square));
    if settings.method.uses_family() && settings.family.power().is_none() && !convex {
        return Err(SolveError::FamilyNotApplicable {
            method: settings.method.name(),
            family: settings.family.to_string(),
            remedy: "it needs a convex boundary (method convex)",
        });
    }
    Ok(())
}

fn convex_equations(mesh: &DiskMesh, family: Family) -> Result<Equations<f64>, SolveError> {
    match family {
        Family::Uniform => Ok(equations::uniform(mesh)),
        Family::ShapePreserving => Ok(shape_preserving(mesh)),
        three_point => equations::barycentric(mesh, three_point.power().unwrap_or(Family::CONFORMAL_POWER)),
    }
}

fn factor<T: Scalar>(
    (mesh, system): (&DiskMesh, &FreeSystem),
    equations: Equations<T>,
    kind: Kind,
    seconds: &mut PhaseSeconds,
    control: Control<'_>,
) -> Result<Factored<T>, SolveError> {
    let named = |error| in_vertices(error, system.free());
    let start = Instant::now();
    let matrix = system.negated_matrix(mesh, &equations);
    seconds.assemble += start.elapsed().as_secs_f64();
    control.enter(Phase::Analyze)?;
    let start = Instant::now();
    let analysis = Analysis::new(kind, system.pattern()).map_err(named)?;
    seconds.analyze = start.elapsed().as_secs_f64();
    control.enter(Phase::Factor)?;
    let start = Instant::now();
    let factor = analysis.factor(&matrix, control.cancel()).map_err(named)?;
    seconds.factor = start.elapsed().as_secs_f64();
    Ok(Factored { equations, matrix, factor })
}

/// Says a linear solver's error in terms of the mesh: its rows are the free vertices.
fn in_vertices(error: LinalgError, free: &[VertexId]) -> SolveError {
    match error {
        LinalgError::Cancelled => SolveError::Cancelled,
        LinalgError::ResidualTooLarge { residual, limit } => SolveError::ResidualTooLarge { residual, limit },
        LinalgError::Singular { row } | LinalgError::NotPositiveDefinite { row } | LinalgError::NotFinite { row } => {
            SolveError::Singular { vertex: free[row] }
        }
        other => SolveError::Linear { reason: other.to_string() },
    }
}
