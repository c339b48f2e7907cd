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
use super::free_solve::{FreeSolve, Site, in_vertices};
use super::pins::{Pins, check_pins, gauge_pins};
use super::scale::complete_gauge;
use super::shape_preserving::shape_preserving;
use super::system::FreeSystem;
use super::{BoundaryShape, Control, Family, Method, Phase, PhaseSeconds, Settings, Solution, SolveError, Treatment};
use crate::linalg::{Analysis, Factor, Kind};
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
    /// The vertices that have no unknown.
    pinned: Vec<VertexId>,
    system: FreeSystem,
    values: Values,
    seconds: PhaseSeconds,
}

impl std::fmt::Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Prepared").field("settings", &self.settings).field("asked", &self.asked).finish_non_exhaustive()
    }
}

/// Equations, matrix and factors of a prescribed boundary.
struct Prescribed {
    equations: Equations<f64>,
    matrix: CscMatrix<f64>,
    factor: Factor<f64>,
}

enum Values {
    /// A free boundary couples x and y: one complex unknown per vertex.
    Free(FreeSolve),
    /// A prescribed boundary does not: one real matrix, two right-hand sides.
    Prescribed(Prescribed),
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
        let pinned: Vec<VertexId> = own_pins.as_ref().unwrap_or(pins).keys().copied().collect();
        let system = FreeSystem::new(mesh, |v| pinned.binary_search(&v).is_ok());
        let site = Site { mesh, system: &system, pinned: &pinned };
        let treatment = if own_pins.is_some() { Treatment::Eliminate } else { settings.treatment_of(pins.len()) };
        let mut seconds = PhaseSeconds::default();
        let values = match settings.method {
            Method::Convex(_) => {
                let equations = convex_equations(mesh, settings.family)?;
                let symmetric = matches!(settings.family, Family::Conformal | Family::Uniform);
                seconds.assemble = start.elapsed().as_secs_f64();
                Values::Prescribed(Prescribed::new(site, equations, symmetric, &mut seconds, control)?)
            }
            method => {
                let (equations, hermitian) = free_equations(mesh, method, settings.family)?;
                seconds.assemble = start.elapsed().as_secs_f64();
                let analysis = analyze(&system, hermitian, &mut seconds, control)?;
                Values::Free(FreeSolve::new(site, equations, (&analysis, treatment), &mut seconds, control)?)
            }
        };
        let asked = pins.keys().copied().collect();
        Ok(Self { settings: *settings, asked, pinned, own_pins, system, values, seconds })
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
        let site = Site { mesh, system: &self.system, pinned: &self.pinned };
        let (mut embedding, residual) = match &self.values {
            Values::Free(free) => free.solve(site, in_force)?,
            Values::Prescribed(prescribed) => prescribed.solve(site, in_force)?,
        };
        let mut pins_in_force = in_force.clone();
        if self.own_pins.is_some() {
            complete_gauge(mesh, &mut embedding, pins);
            for (vertex, place) in &mut pins_in_force {
                *place = embedding[vertex.index()];
            }
        }
        let (stats, bounded_corners, equation_residual) = match &self.values {
            Values::Free(free) => (free.stats(), free.bounded_corners(), free.equation_residual(mesh, &embedding)),
            Values::Prescribed(Prescribed { equations, factor, .. }) => {
                let left = equations.to_complex().residual(mesh, &embedding, |v| !in_force.contains_key(&v));
                (factor.stats(), equations.bounded_corners, left)
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
}

impl Prescribed {
    fn new(
        site: Site<'_>,
        equations: Equations<f64>,
        symmetric: bool,
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let analysis = analyze(site.system, symmetric, seconds, control)?;
        control.enter(Phase::Factor)?;
        let start = Instant::now();
        let matrix = site.system.negated_matrix(site.mesh, &equations);
        let named = |error| in_vertices(error, site.system.free());
        let factor = analysis.factor(&matrix, control.cancel()).map_err(named)?;
        seconds.factor = start.elapsed().as_secs_f64();
        Ok(Self { equations, matrix, factor })
    }

    /// Solves for x and y, which share the matrix.
    fn solve(&self, site: Site<'_>, pins: &Pins) -> Result<(Vec<DVec2>, f64), SolveError> {
        let terms = |axis: usize| {
            let targets: BTreeMap<VertexId, f64> = pins.iter().map(|(&v, t)| (v, t[axis])).collect();
            site.system.pinned_terms(site.mesh, &self.equations, &targets)
        };
        let both: Vec<f64> = terms(0).into_iter().chain(terms(1)).collect();
        let named = |error| in_vertices(error, site.system.free());
        let solved = self.factor.solve_many(&self.matrix, &both).map_err(named)?;
        let (x, y) = solved.x.split_at(site.system.free().len());
        let mut embedding = vec![DVec2::ZERO; site.mesh.vertex_count()];
        for (vertex, (&x, &y)) in site.system.free().iter().zip(x.iter().zip(y)) {
            embedding[vertex.index()] = DVec2::new(x, y);
        }
        for (vertex, target) in pins {
            embedding[vertex.index()] = *target;
        }
        Ok((embedding, solved.residual))
    }
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

/// The equations of a free boundary, and whether their matrix is Hermitian.
fn free_equations(
    mesh: &DiskMesh,
    method: Method,
    family: Family,
) -> Result<(Equations<Complex<f64>>, bool), SolveError> {
    let power = family.power().unwrap_or(Family::CONFORMAL_POWER);
    Ok(match method {
        Method::Levy => (equations::levy(mesh)?, false),
        Method::Lscm => (equations::lscm(mesh)?, true),
        _ => (equations::natural(mesh, power)?, power == Family::CONFORMAL_POWER),
    })
}

fn analyze(
    system: &FreeSystem,
    hermitian: bool,
    seconds: &mut PhaseSeconds,
    control: Control<'_>,
) -> Result<Analysis, SolveError> {
    control.enter(Phase::Analyze)?;
    let start = Instant::now();
    let kind = if hermitian { Kind::Hermitian } else { Kind::General };
    let analysis = Analysis::new(kind, system.pattern()).map_err(|error| in_vertices(error, system.free()))?;
    seconds.analyze = start.elapsed().as_secs_f64();
    Ok(analysis)
}
