//! Prepared method for one mesh and one set of pinned vertices: equations, matrix and factors.
//!
//! New targets for the prepared pins then cost one substitution, which is fast enough for a pin that follows the
//! pointer.

use std::time::Instant;

use glam::DVec2;

use super::placing::complete_gauge;
use super::tutte::tutte;
use crate::bijective::{Padded, schnyder};
use crate::linalg::{Analysis, Kind};
use crate::linear::convex::convex_boundary;
use crate::linear::fixed_solve::FixedSolve;
use crate::linear::free_gauge::FreeProblem;
use crate::linear::free_solve::FreeSolve;
use crate::linear::spectral::spectral;
use crate::linear::spectral_gauge::{SpectralGauge, spectral_gauge};
use crate::linear::system::{FreeSystem, Site};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::angles::{AngleSystem, angle_based};
use crate::problem::pins::{
    GAUGE_PINS, PinPositions, Pins, are_held_alike, check_pins, fixed_pins, gauge_pins, targets_of,
};
use crate::problem::units::Units;
use crate::problem::{
    Control, Embedding, Family, Method, NamedOption as _, Phase, PhaseSeconds, Settings, Solution, SolveError,
};
use crate::weights::equations;
use crate::weights::equations::Equations;
use crate::weights::shape_preserving::shape_preserving;

/// Data of a solve that do not depend on the targets of the pins.
#[derive(Debug)]
pub struct Prepared {
    settings: Settings,
    /// Pins for which this was prepared, for [`Prepared::serves`].
    asked: Pins,
    /// Gauge pins or the convex boundary, if the solver places vertices by itself.
    own_places: Option<PinPositions>,
    system: FreeSystem,
    values: Values,
    seconds: PhaseSeconds,
}

#[derive(Debug)]
enum Values {
    /// Free boundary, which couples x and y: one complex unknown per vertex.
    Free(Box<FreeSolve>),
    /// Prescribed boundary without coupling: one real matrix, two right-hand sides.
    Fixed(Box<FixedSolve>),
}

/// Solves once for an embedding, by a linear method or by the first stage of another method. For SLIM that stage is
/// Tutte's map. Nothing is proved: [`flatten`](super::flatten) continues until the embedding is proved.
///
/// # Errors
///
/// See [`Prepared::new`] and [`Prepared::solve`].
pub fn solve_once(
    mesh: &DiskMesh,
    settings: &Settings,
    pins: &Pins,
    control: Control<'_>,
) -> Result<Solution, SolveError> {
    let method = &settings.method;
    if !method.only_places_pins() {
        return Prepared::new(mesh, settings, pins, control)?.solve(mesh, pins, control);
    }
    check_pins(mesh, pins)?;
    if settings.are_constraints(pins) {
        return Err(SolveError::TooManyPins { method: method.labels().title, count: pins.len(), most: GAUGE_PINS });
    }
    let mut solution = own_solution(mesh, settings, control)?;
    complete_gauge(mesh, &mut solution.embedding, pins, settings.size);
    Ok(solution)
}

/// Solution of a method whose shape does not depend on pins, so that there are no factors to reuse.
fn own_solution(mesh: &DiskMesh, settings: &Settings, control: Control<'_>) -> Result<Solution, SolveError> {
    match &settings.method {
        Method::Lee(_) => Ok(Padded::new(mesh, settings.layers).solve(settings, control)?.0),
        Method::Slim => Ok(tutte(mesh, control)?.0),
        Method::Schnyder => Ok(Solution { embedding: schnyder(mesh), gauge_completed: true, ..Solution::default() }),
        Method::Spectral => Ok(spectral(mesh, control)?.solution),
        Method::Abf => Ok(angle_based(mesh, AngleSystem::Full, control)?.solution),
        Method::AbfPlusPlus => Ok(angle_based(mesh, AngleSystem::Reduced, control)?.solution),
        other => Err(SolveError::NoLinearSolve { method: other.labels().title }),
    }
}

impl Prepared {
    /// Computes weights, matrix and factors for the vertices in `pins`.
    ///
    /// # Errors
    ///
    /// If the method does not start with a linear solve for positions, pins are invalid, the family does not fit the
    /// method, weights are degenerate, the matrix is singular, or the caller cancels.
    pub fn new(mesh: &DiskMesh, settings: &Settings, pins: &Pins, control: Control<'_>) -> Result<Self, SolveError> {
        settings.family().check_for(&settings.method)?;
        let method = &settings.method;
        if !method.begins_with_pins_held() && !matches!(method, Method::Convex(_) | Method::Stretch(_)) {
            return Err(SolveError::NoLinearSolve { method: method.labels().title });
        }
        let pins = if settings.method.uses_pins() { pins } else { &Pins::new() };
        check_pins(mesh, pins)?;
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let mut own_places = match &settings.method {
            Method::Convex(shape) | Method::Stretch(shape) => Some(convex_boundary(mesh, shape, settings.spacing)?),
            _ if pins.len() < GAUGE_PINS => Some(gauge_pins(mesh)),
            _ => None,
        };
        let asked = settings.held(pins);
        let pins = own_places.clone().map_or_else(|| asked.clone(), fixed_pins);
        let mut seconds = PhaseSeconds::default();
        let (system, values) = match &settings.method {
            Method::Convex(_) | Method::Stretch(_) => {
                let system = FreeSystem::new(mesh, |v| pins.contains_key(&v), control)?;
                let family = if settings.method.uses_family() { settings.family() } else { Family::MeanValue };
                let equations = convex_equations(mesh, family, control)?;
                let is_symmetric = matches!(family, Family::Conformal | Family::Uniform);
                seconds.assemble = start.elapsed().as_secs_f64();
                let kind = if is_symmetric { Kind::Hermitian } else { Kind::General };
                let analysis = analyze(|| system.analysis(kind, control), &mut seconds, control)?;
                control.enter(Phase::Factor)?;
                let start = Instant::now();
                let fixed = FixedSolve::new(Site { mesh, system: &system }, equations, &analysis, control)?;
                seconds.factor = start.elapsed().as_secs_f64();
                (system, Values::Fixed(Box::new(fixed)))
            }
            _ => {
                seconds.assemble = start.elapsed().as_secs_f64();
                let problem = FreeProblem { mesh, settings, asked: &asked };
                let ready = problem.prepare(own_places.take(), &mut seconds, control)?;
                own_places = ready.own_places;
                (ready.system, Values::Free(Box::new(ready.solve)))
            }
        };
        Ok(Self { settings: settings.clone(), asked, own_places, system, values, seconds })
    }

    /// True if this preparation fits the settings and pins. Targets of the pins may differ.
    pub fn serves(&self, settings: &Settings, pins: &Pins) -> bool {
        let alike = || are_held_alike(&self.asked, &settings.held(pins));
        self.settings == *settings && (!settings.method.uses_pins() || alike())
    }

    /// Moves of all vertices when the targets of the pins in `moved` move by (1, 0).
    ///
    /// The embedding is complex-linear in the targets: a move by δ adds δ times these moves, as complex numbers. With
    /// a convex boundary, pins move nothing.
    ///
    /// # Errors
    ///
    /// If refinement cannot reduce the residual.
    ///
    /// # Panics
    ///
    /// If a vertex in `moved` is not pinned, unless the boundary is convex.
    pub fn column(&self, mesh: &DiskMesh, moved: &[VertexId]) -> Result<Vec<DVec2>, SolveError> {
        let Values::Free(free) = &self.values else { return Ok(vec![DVec2::ZERO; mesh.vertex_count()]) };
        assert!(moved.iter().all(|vertex| self.asked.contains_key(vertex)), "only pins have columns");
        if self.own_places.is_some() {
            // A single pin moves all vertices.
            return Ok(vec![DVec2::X; mesh.vertex_count()]);
        }
        let target = |v: VertexId| if moved.contains(&v) { DVec2::X } else { DVec2::ZERO };
        let targets: PinPositions = self.asked.keys().map(|&v| (v, target(v))).collect();
        let (mut column, _) = free.solve(Site { mesh, system: &self.system }, &targets, Control::unattended())?;
        column.gather_unused(mesh);
        Ok(column.into_inner())
    }

    /// Solves for the embedding with the pins on their targets.
    ///
    /// Fewer than two pins leave a similarity open. Without pins, the gauge pins fix it; with conformal weights, method
    /// `auto` takes the spectral map instead. A single pin moves that solution onto its target. In both cases
    /// [`Settings::size`] determines the size; by default, the area of the surface.
    ///
    /// # Errors
    ///
    /// If pins are invalid, refinement cannot reduce the residual, or the caller cancels.
    pub fn solve(&self, mesh: &DiskMesh, pins: &Pins, control: Control<'_>) -> Result<Solution, SolveError> {
        let mut solution = self.solve_unplaced(mesh, pins, control)?;
        if solution.gauge_completed {
            let pins = if self.settings.method.uses_pins() { pins } else { &Pins::new() };
            complete_gauge(mesh, &mut solution.embedding, pins, self.settings.size);
            for (vertex, pin) in &mut solution.pins {
                pin.target = solution.embedding[vertex];
            }
        }
        Ok(solution)
    }

    /// Solves like [`Prepared::solve`], but keeps the solver's own positions if fewer than two pins fix the
    /// similarity.
    pub(crate) fn solve_unplaced(
        &self,
        mesh: &DiskMesh,
        pins: &Pins,
        control: Control<'_>,
    ) -> Result<Solution, SolveError> {
        let pins = if self.settings.method.uses_pins() { pins } else { &Pins::new() };
        check_pins(mesh, pins)?;
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let held = self.settings.held(pins);
        let units = if self.own_places.is_some() { Units::default() } else { Units::of(&held, self.settings.size) };
        let targets = self.own_places.clone().unwrap_or_else(|| targets_of(&units.pins(&held)));
        let site = Site { mesh, system: &self.system };
        let (mut embedding, mut residual) = match &self.values {
            Values::Free(free) => free.solve(site, &targets, control)?,
            Values::Fixed(fixed) => fixed.solve(site, &targets, control)?,
        };
        let spectral = self.without_gauge_pins(site, &embedding, control)?;
        let convergence = spectral.as_ref().map(|spectral| spectral.convergence);
        if let Some(spectral) = spectral {
            (embedding, residual) = (spectral.embedding, spectral.residual);
        }
        embedding.gather_unused(mesh);
        let linear = match &self.values {
            Values::Free(free) => free.numbers(mesh, &embedding, residual, control)?,
            Values::Fixed(fixed) => fixed.numbers(site, &embedding, residual, control)?,
        };
        let in_force = if convergence.is_some() {
            Pins::new()
        } else if self.own_places.is_some() {
            fixed_pins(targets.keys().map(|&vertex| (vertex, embedding[vertex])))
        } else {
            units.embedding_to_plane(&mut embedding, &held);
            held
        };
        Ok(Solution {
            embedding,
            pins: in_force,
            gauge_completed: self.own_places.is_some(),
            linear: Some(linear),
            convergence,
            seconds: PhaseSeconds { solve: start.elapsed().as_secs_f64(), ..self.seconds },
        })
    }

    /// Spectral map, in place of the map with gauge pins. `None` if the method or the user asks for pins.
    fn without_gauge_pins(
        &self,
        site: Site<'_>,
        embedding: &Embedding,
        control: Control<'_>,
    ) -> Result<Option<SpectralGauge>, SolveError> {
        let Values::Free(free) = &self.values else { return Ok(None) };
        let is_wanted = self.own_places.is_some() && self.settings.method == Method::Auto && free.has_spectral_gauge();
        if is_wanted { spectral_gauge(free, site, embedding, control) } else { Ok(None) }
    }
}

fn convex_equations(mesh: &DiskMesh, family: Family, control: Control<'_>) -> Result<Equations<f64>, SolveError> {
    match family {
        Family::Uniform => Ok(equations::uniform(mesh)),
        Family::ShapePreserving => Ok(shape_preserving(mesh)),
        three_point => equations::barycentric(mesh, three_point.power().unwrap_or(Family::CONFORMAL_POWER), control),
    }
}

/// Analyses a pattern. Adds the elapsed time to `seconds`.
pub(crate) fn analyze(
    analysis: impl FnOnce() -> Result<Analysis, SolveError>,
    seconds: &mut PhaseSeconds,
    control: Control<'_>,
) -> Result<Analysis, SolveError> {
    control.enter(Phase::Analyze)?;
    let start = Instant::now();
    let analysis = analysis()?;
    seconds.analyze += start.elapsed().as_secs_f64();
    Ok(analysis)
}
