//! Prepared system of a free boundary: its equations, and the choice of the two that are left out.
//!
//! A problem with up to two pins only fixes the similarity, and drops their equations (paper §3.3). Two equations
//! are redundant on a surface that unrolls, so in exact arithmetic any two may be dropped. In 64 bits the dropped
//! equations must clearly depend on the others. On regular grids and in corridors the equations of the usual pins do
//! not (`left_kernel.rs`). On such meshes
//!
//! * gauge pins, chosen by the solver, move to vertices whose equations do depend on the others. A similarity places
//!   the result afterwards in any case;
//! * with two pins of the user, all equations are kept (least squares), unless the user set a treatment;
//! * if all equations are kept, the factors leave out two more.
//!
//! Other surfaces have no second redundant equation, and each choice has a different solution. So the usual pins are
//! kept wherever they work, and such systems are factored only once.

use std::collections::BTreeMap;
use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use super::free_layout::{Unanalysed, Way};
use super::free_solve::{FreeSolve, Unsolved};
use super::left_kernel::gauge_of;
use super::system::{FreeSystem, Site};
use crate::linalg::Kind;
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::pins::{GAUGE_PINS, PinPositions, Pins, farthest_pair, fixed_pins};
use crate::problem::{Control, Family, Method, PhaseSeconds, Settings, SolveError, Stage, Treatment};
use crate::weights::equations;
use crate::weights::equations::{Equations, mean_edge_length};

/// Number of gauges tried before the last is accepted. The second has always sufficed.
const MOST_GAUGES: usize = 4;

/// Problem of a solve with a free boundary.
#[derive(Clone, Copy)]
pub(crate) struct FreeProblem<'a> {
    pub(crate) mesh: &'a DiskMesh,
    pub(crate) settings: &'a Settings,
    /// Pins of the user with their kinds.
    pub(crate) asked: &'a Pins,
}

/// Factored system of a [`FreeProblem`].
pub(crate) struct FreeReady {
    pub(crate) system: FreeSystem,
    pub(crate) solve: FreeSolve,
    /// Gauge pins, if the solver chose them.
    pub(crate) own_places: Option<PinPositions>,
}

/// Choice of gauge pins and of the equations left out beside them.
struct Try {
    own_places: Option<PinPositions>,
    way: Way,
}

impl FreeProblem<'_> {
    /// Factors the system. `own_places` holds gauge pins if the solver chooses them; they move if necessary.
    pub(crate) fn prepare(
        self,
        own_places: Option<PinPositions>,
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<FreeReady, SolveError> {
        let treatment = self.settings.treatment_on(&Stage::Natural, self.asked.len());
        let mut choice = Try { own_places, way: Way { treatment, gauge: None } };
        for _ in 1..MOST_GAUGES {
            let outcome = self.factored(&choice, seconds, control);
            if !self.can_change(&choice) {
                return outcome.map_err(SolveError::from);
            }
            let gauge = match &outcome {
                Ok(FreeReady { system, solve, .. }) => solve.better_gauge(Site { mesh: self.mesh, system }, control)?,
                Err(Unsolved::WithoutGauge(Some(gauge))) => Some(*gauge),
                Err(Unsolved::WithoutGauge(None) | Unsolved::Error(SolveError::Singular { .. })) => {
                    Some(gauge_of(self.mesh, &self.equations(control)?, control)?)
                }
                Err(Unsolved::Error(_)) => None,
            };
            // Repeating a choice would give an identical outcome.
            let is_new =
                |gauge: &[VertexId; 2]| !choice.own_places.as_ref().is_some_and(|places| is_at(places, *gauge));
            let Some(gauge) = gauge.filter(is_new) else { return outcome.map_err(SolveError::from) };
            choice = self.with_gauge(choice, gauge);
        }
        self.factored(&choice, seconds, control).map_err(SolveError::from)
    }

    /// True if the solver may choose the equations that are left out, and another choice is possible.
    fn can_change(self, Try { own_places, way }: &Try) -> bool {
        if self.is_hermitian() || way.gauge.is_some() {
            return false;
        }
        let are_only_held = self.asked.len() == GAUGE_PINS && self.asked.values().all(|pin| pin.kind.is_hard());
        let may_keep_equations = self.settings.treatment.is_none() && are_only_held;
        own_places.is_some() || may_keep_equations || way.keeps_equations(self.asked)
    }

    fn with_gauge(self, Try { own_places, way }: Try, gauge: [VertexId; 2]) -> Try {
        if own_places.is_some() && way.treatment == Treatment::Eliminate {
            return Try { own_places: Some(self.places(gauge)), way };
        }
        Try { own_places, way: Way { treatment: Treatment::LeastSquares, gauge: Some(gauge) } }
    }

    /// Gauge pins at two vertices, with their distance in space. Any positive distance works; if theirs is zero, the
    /// distance of the farthest pair of the boundary is used.
    fn places(self, gauge: [VertexId; 2]) -> PinPositions {
        let apart = |[a, b]: [VertexId; 2]| self.mesh.position(a).distance(self.mesh.position(b));
        let distance =
            Some(apart(gauge)).filter(|apart| *apart > 0.0).unwrap_or_else(|| apart(farthest_pair(self.mesh)));
        let [a, b] = gauge;
        BTreeMap::from([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))])
    }

    fn factored(self, choice: &Try, seconds: &mut PhaseSeconds, control: Control<'_>) -> Result<FreeReady, Unsolved> {
        let (mesh, start) = (self.mesh, Instant::now());
        let kind = if self.is_hermitian() { Kind::Hermitian } else { Kind::General };
        let pins = choice.own_places.clone().map_or_else(|| self.asked.clone(), fixed_pins);
        let laid_out = Unanalysed::new(mesh, &pins, choice.way, kind, control)?;
        // The order does not depend on the values of the equations.
        let numbers = || laid_out.numbers(mesh, self.equations(control)?, control);
        let (numbers, analysis) = crate::parallel::join(numbers, || laid_out.analysis(mesh, control));
        let (mut numbers, (analysis, analysis_seconds)) = (numbers?, analysis?);
        if laid_out.has_springs() {
            numbers.unit = mean_edge_length(mesh).powf(1.0 - self.power());
        }
        let laid_out = laid_out.analysed(analysis, analysis_seconds);
        seconds.analyze += laid_out.seconds;
        seconds.assemble += start.elapsed().as_secs_f64() - laid_out.seconds;
        let solve = FreeSolve::new(mesh, &laid_out, numbers, seconds, control)?;
        Ok(FreeReady { system: laid_out.system, solve, own_places: choice.own_places.clone() })
    }

    fn is_hermitian(self) -> bool {
        self.settings.method != Method::Levy && self.power() == Family::CONFORMAL_POWER
    }

    /// Power p of the offsets d = rᵖ. Lévy's equations and those of least squares (LSCM) are scale-free, like
    /// conformal ones.
    fn power(self) -> f64 {
        match self.settings.method {
            Method::Levy | Method::Lscm => Family::CONFORMAL_POWER,
            _ => self.settings.family().power().unwrap_or(Family::CONFORMAL_POWER),
        }
    }

    /// Equations of a free boundary.
    fn equations(self, control: Control<'_>) -> Result<Equations<Complex<f64>>, SolveError> {
        match self.settings.method {
            Method::Levy => equations::levy(self.mesh, control),
            Method::Lscm => equations::lscm(self.mesh, control),
            _ => equations::natural(self.mesh, self.power(), control),
        }
    }
}

fn is_at(places: &PinPositions, gauge: [VertexId; 2]) -> bool {
    gauge.iter().all(|vertex| places.contains_key(vertex))
}
