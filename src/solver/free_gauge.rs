//! A free boundary made ready: its equations, and which two of them are left out.
//!
//! Up to two pins only fix the similarity, and their equations are dropped (paper §3.3). Two equations say nothing that the
//! others do not say, so on a surface that unrolls any two may go, in exact arithmetic. In 64 bits only those may that
//! depend on the others: on regular grids and in corridors those of the usual pins do not (`left_kernel.rs`). There
//!
//! * gauge pins, which the solver chooses by itself, go to vertices whose equations do depend on the others. The answer is moved to
//!   where it belongs by a similarity anyway;
//! * with two pins of the user's all equations are kept (least squares), unless their treatment was asked for.
//!
//! Other surfaces have no second equation to spare, and each choice has an answer of its own. So the usual pins stay
//! wherever they do: nothing is factored twice there.

use std::collections::BTreeMap;
use std::time::Instant;

use glam::DVec2;
use num_complex::Complex;

use super::equations::{self, Equations, mean_edge_length};
use super::free_layout::Layout;
use super::free_solve::{FreeSolve, Setup};
use super::left_kernel::{gauge_of, gauge_or_farthest};
use super::pins::{GAUGE_PINS, PinPositions, Pins, farthest_pair, fixed_pins};
use super::prepared::analyze;
use super::system::{FreeSystem, Site};
use super::{Control, Family, Method, Phase, PhaseSeconds, Settings, SolveError, Treatment};
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, VertexId};

/// Gauges that are tried before the last one is taken as it is. The second has always done.
const MOST_GAUGES: usize = 4;

/// A solve with a free boundary.
#[derive(Clone, Copy)]
pub(super) struct FreeProblem<'a> {
    pub(super) mesh: &'a DiskMesh,
    pub(super) settings: &'a Settings,
    /// The user's pins, as they are held.
    pub(super) asked: &'a Pins,
}

/// The same, factored.
pub(super) struct FreeReady {
    pub(super) system: FreeSystem,
    pub(super) solve: FreeSolve,
    /// The gauge pins, where the solver has its own.
    pub(super) own_places: Option<PinPositions>,
}

/// What is left out, and what becomes of it.
struct Way {
    own_places: Option<PinPositions>,
    treatment: Treatment,
    /// Two vertices whose equations depend on the others, where they are known: least squares leaves them out beside the pins.
    gauge: Option<[VertexId; 2]>,
}

/// A system laid out and analysed.
struct LaidOut {
    layout: Layout,
    system: FreeSystem,
    kind: Kind,
    analysis: Analysis,
    analyze_seconds: f64,
}

impl FreeProblem<'_> {
    /// Factors the system, with these gauge pins if the solver is to have its own: they move where they have to.
    pub(super) fn prepare(
        self,
        own_places: Option<PinPositions>,
        seconds: &mut PhaseSeconds,
        control: Control<'_>,
    ) -> Result<FreeReady, SolveError> {
        let treatment = self.settings.treatment_on(Method::Natural, self.asked.len());
        let mut way = Way { own_places, treatment, gauge: None };
        for _ in 1..MOST_GAUGES {
            let outcome = self.factored(&way, seconds, control);
            if !self.can_change(&way) {
                return outcome;
            }
            let gauge = match &outcome {
                Ok(FreeReady { system, solve, .. }) => solve.better_gauge(Site { mesh: self.mesh, system }, control)?,
                Err(SolveError::Singular { .. }) => self.gauge_in_kernel(control)?,
                Err(_) => None,
            };
            // The same again would end as this did.
            let is_new = |gauge: &[VertexId; 2]| !way.own_places.as_ref().is_some_and(|places| is_at(places, *gauge));
            let Some(gauge) = gauge.filter(is_new) else { return outcome };
            way = self.with_gauge(way, gauge);
        }
        self.factored(&way, seconds, control)
    }

    /// Whether it is the solver's choice which equations are left out.
    fn can_change(self, way: &Way) -> bool {
        let are_only_held = || self.asked.len() == GAUGE_PINS && self.asked.values().all(|pin| pin.hold.is_exact());
        let is_free = way.own_places.is_some() || (self.settings.treatment.is_none() && are_only_held());
        way.treatment == Treatment::Eliminate && is_free && !self.is_hermitian()
    }

    fn with_gauge(self, way: Way, gauge: [VertexId; 2]) -> Way {
        if way.own_places.is_none() {
            return Way { treatment: Treatment::LeastSquares, gauge: Some(gauge), ..way };
        }
        Way { own_places: Some(self.places(gauge)), ..way }
    }

    /// Gauge pins at two vertices, as far apart as in space. Their size does not matter, but may not be nothing.
    fn places(self, gauge: [VertexId; 2]) -> PinPositions {
        let apart = |[a, b]: [VertexId; 2]| self.mesh.position(a).distance(self.mesh.position(b));
        let distance =
            Some(apart(gauge)).filter(|apart| *apart > 0.0).unwrap_or_else(|| apart(farthest_pair(self.mesh)));
        let [a, b] = gauge;
        BTreeMap::from([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))])
    }

    /// Two vertices whose equations depend on the others, found without a factor that leaves out any; none where they
    /// cannot be found.
    fn gauge_in_kernel(self, control: Control<'_>) -> Result<Option<[VertexId; 2]>, SolveError> {
        control.enter(Phase::Factor)?;
        match gauge_of(self.mesh, &self.equations(control)?, control) {
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            other => Ok(other.ok()),
        }
    }

    fn factored(self, way: &Way, seconds: &mut PhaseSeconds, control: Control<'_>) -> Result<FreeReady, SolveError> {
        let (mesh, start) = (self.mesh, Instant::now());
        let (equations, laid_out) = if self.is_hermitian() {
            // Conformal equations depend on each other all over the mesh: those of any pins will do, and what they are does
            // not matter to the order.
            let gauge = |pinned: &[VertexId]| {
                Ok(if pinned.len() >= GAUGE_PINS { Vec::new() } else { farthest_pair(mesh).to_vec() })
            };
            rayon::join(|| self.equations(control), || self.laid_out(way, gauge, control))
        } else {
            let equations = self.equations(control)?;
            let gauge = |_: &[VertexId]| match way.gauge {
                Some(two) => Ok(two.to_vec()),
                None => gauge_or_farthest(mesh, &equations, control),
            };
            let laid_out = self.laid_out(way, gauge, control);
            (Ok(equations), laid_out)
        };
        let equations = equations?;
        let LaidOut { layout, system, kind, analysis, analyze_seconds } = laid_out?;
        seconds.analyze += analyze_seconds;
        seconds.assemble += start.elapsed().as_secs_f64() - analyze_seconds;
        let site = Site { mesh, system: &system };
        let unit = if layout.has_springs() { mean_edge_length(mesh).powf(1.0 - self.power()) } else { 1.0 };
        let setup = Setup { equations, unit, analysis: &analysis, layout: &layout, kind };
        let solve = FreeSolve::new(site, setup, seconds, control)?;
        Ok(FreeReady { system, solve, own_places: way.own_places.clone() })
    }

    /// Lays the system out, and analyses it. For `gauge` see [`Layout::new`].
    fn laid_out(
        self,
        way: &Way,
        gauge: impl FnOnce(&[VertexId]) -> Result<Vec<VertexId>, SolveError>,
        control: Control<'_>,
    ) -> Result<LaidOut, SolveError> {
        let pins = way.own_places.clone().map_or_else(|| self.asked.clone(), fixed_pins);
        let layout = Layout::new(&pins, way.treatment, gauge)?;
        let system = layout.system(self.mesh, control)?;
        let kind = if self.is_hermitian() { Kind::Hermitian } else { Kind::General };
        let mut seconds = PhaseSeconds::default();
        let site = Site { mesh: self.mesh, system: &system };
        let analysis = analyze(|| layout.analysis(site, kind, control), &mut seconds, control)?;
        Ok(LaidOut { layout, system, kind, analysis, analyze_seconds: seconds.analyze })
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
