//! A free boundary made ready: its equations, and which two of them are left out.
//!
//! Up to two pins only fix the similarity, and their equations are dropped (paper §3.3). Two equations say nothing that the
//! others do not say, so on a surface that unrolls any two may go, in exact arithmetic. In 64 bits only those may that
//! depend on the others: on regular grids and in corridors those of the usual pins do not (`left_kernel.rs`). There
//!
//! * gauge pins, which the solver chooses by itself, go to vertices whose equations do depend on the others. The answer is moved to
//!   where it belongs by a similarity anyway;
//! * with two pins of the user's all equations are kept (least squares), unless their treatment was asked for;
//! * where all equations are kept, the factors leave out two more.
//!
//! Other surfaces have no second equation to spare, and each choice has an answer of its own. So the usual pins stay
//! wherever they do: nothing is factored twice there.

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

/// Gauges that are tried before the last one is taken as it is. The second has always done.
const MOST_GAUGES: usize = 4;

/// A solve with a free boundary.
#[derive(Clone, Copy)]
pub(crate) struct FreeProblem<'a> {
    pub(crate) mesh: &'a DiskMesh,
    pub(crate) settings: &'a Settings,
    /// The user's pins, as they are held.
    pub(crate) asked: &'a Pins,
}

/// The same, factored.
pub(crate) struct FreeReady {
    pub(crate) system: FreeSystem,
    pub(crate) solve: FreeSolve,
    /// The gauge pins, where the solver has its own.
    pub(crate) own_places: Option<PinPositions>,
}

/// A try: the gauge pins, and what is left out beside them.
struct Try {
    own_places: Option<PinPositions>,
    way: Way,
}

impl FreeProblem<'_> {
    /// Factors the system, with these gauge pins if the solver is to have its own: they move where they have to.
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
            // The same again would end as this did.
            let is_new =
                |gauge: &[VertexId; 2]| !choice.own_places.as_ref().is_some_and(|places| is_at(places, *gauge));
            let Some(gauge) = gauge.filter(is_new) else { return outcome.map_err(SolveError::from) };
            choice = self.with_gauge(choice, gauge);
        }
        self.factored(&choice, seconds, control).map_err(SolveError::from)
    }

    /// Whether it is the solver's choice which equations are left out, and another one could be made.
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

    /// Gauge pins at two vertices, as far apart as in space. Their size does not matter, but may not be nothing.
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
        // What the equations are does not matter to the order.
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

    /// The power p of the offsets d = rᵖ. Lévy's equations and those of least squares are free of scale, as conformal ones are.
    fn power(self) -> f64 {
        match self.settings.method {
            Method::Levy | Method::Lscm => Family::CONFORMAL_POWER,
            _ => self.settings.family().power().unwrap_or(Family::CONFORMAL_POWER),
        }
    }

    /// The equations of a free boundary.
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
