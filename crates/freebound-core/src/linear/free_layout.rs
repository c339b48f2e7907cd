//! System of a free boundary before it is factored: vertices that the factors leave out, terms of the pins, values.

use std::collections::BTreeMap;
use std::time::Instant;

use nalgebra_sparse::CscMatrix;
use num_complex::Complex;

use super::least_squares::{Remainder, Spring};
use super::many_pins::ManyPins;
use super::system::{FreeSystem, Site};
use crate::linalg::{Analysis, Kind};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::pins::GAUGE_PINS;
use crate::problem::{Control, Phase, PinKind, Pins, SolveError, Treatment, farthest_pair};
use crate::weights::equations::Equations;

/// Number of pins for least squares above which the sparse system is used. An estimate: at a thousand pins the dense
/// system takes many times as long.
const FEW: usize = 64;

/// Treatment of the equations of pins, and the choice of equations left out beside them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Way {
    pub(crate) treatment: Treatment,
    /// Two vertices whose equations depend on the others, if known: least squares leaves them out, too.
    pub(crate) gauge: Option<[VertexId; 2]>,
}

impl Way {
    /// True if the equations of these pins are kept. A single hard pin does not fix the similarity: without its
    /// equation, the remaining system would still be singular.
    pub(crate) fn keeps_equations(self, pins: &Pins) -> bool {
        let exact = pins.values().filter(|pin| pin.kind.is_hard()).count();
        self.treatment != Treatment::Eliminate || exact < GAUGE_PINS
    }
}

/// Layout of pins in a system.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    /// Vertices without an unknown in the factors, ascending. All pins and a gauge if all equations are kept and
    /// pins are few, otherwise the hard pins.
    pub(crate) left_out: Vec<VertexId>,
    /// True if the equations of `left_out` are kept beside the factors; otherwise these vertices are pins,
    /// eliminated.
    pub(crate) keeps_equations: bool,
    /// True if least squares has too many pins to treat them one by one.
    pub(crate) has_many: bool,
    pub(crate) holds: BTreeMap<VertexId, PinKind>,
}

impl Layout {
    /// Lays out a system.
    fn new(mesh: &DiskMesh, pins: &Pins, way: Way) -> Self {
        let holds: BTreeMap<VertexId, PinKind> = pins.iter().map(|(&v, pin)| (v, pin.kind)).collect();
        let exact = pins.iter().filter(|(_, pin)| pin.kind.is_hard());
        let mut left_out: Vec<VertexId> = exact.map(|(&v, _)| v).collect();
        let keeps_equations = way.keeps_equations(pins);
        let springs = pins.len() - left_out.len();
        let has_many = springs + if keeps_equations { pins.len() } else { 0 } > FEW;
        if keeps_equations && !has_many {
            left_out = pins.keys().copied().collect();
            // With a single pin the equations still depend on each other: the equations of any vertices will do at
            // first.
            let to_begin_with = (left_out.len() < GAUGE_PINS).then(|| farthest_pair(mesh));
            left_out.extend(way.gauge.or(to_begin_with).into_iter().flatten());
            left_out.sort_unstable();
            left_out.dedup();
        }
        Self { left_out, keeps_equations, has_many, holds }
    }

    fn system(&self, mesh: &DiskMesh, control: Control<'_>) -> Result<FreeSystem, SolveError> {
        FreeSystem::new(mesh, |v| self.left_out.binary_search(&v).is_ok(), control)
    }

    /// Orders and analyses the system that is factored.
    fn analysis(&self, site: Site<'_>, kind: Kind, control: Control<'_>) -> Result<Analysis, SolveError> {
        match self.rest(1.0).filter(|_| self.has_many) {
            Some(rest) => ManyPins::new(site, rest).analysis(site, control),
            None => site.system.analysis(kind, control),
        }
    }

    /// Vertices and pins for least squares, if any. For `unit` see [`Numbers`].
    pub(crate) fn rest(&self, unit: f64) -> Option<Remainder> {
        let spring = |(&vertex, kind): (&VertexId, &PinKind)| match kind {
            PinKind::Fixed | PinKind::Hard => None,
            PinKind::Soft(weight) => Some(Spring { vertex, compliance: (unit / weight).powi(2) }),
        };
        let springs: Vec<Spring> = self.holds.iter().filter_map(spring).collect();
        let left_out = if self.keeps_equations { self.left_out.clone() } else { Vec::new() };
        let can_move = |v: &VertexId| !self.holds.get(v).is_some_and(|kind| kind.is_hard());
        let movers = left_out.iter().copied().filter(can_move).collect();
        (self.keeps_equations || !springs.is_empty()).then_some(Remainder { left_out, movers, springs })
    }
}

/// Values of a system.
pub(crate) struct Numbers {
    pub(crate) equations: Equations<Complex<f64>>,
    /// Matrix of the equations, if it is already assembled.
    pub(crate) matrix: Option<CscMatrix<Complex<f64>>>,
    /// Factor that scales the rows to a geometry with mean edge length 1.
    pub(crate) unit: f64,
}

/// System with its layout, not yet analysed.
#[derive(Debug)]
pub(crate) struct Unanalysed {
    way: Way,
    layout: Layout,
    system: FreeSystem,
    /// Known properties of the matrix.
    kind: Kind,
}

/// System with its layout and its analysis.
#[derive(Debug)]
pub(crate) struct LaidOut {
    pub(crate) way: Way,
    pub(crate) layout: Layout,
    pub(crate) system: FreeSystem,
    /// Known properties of the matrix.
    pub(crate) kind: Kind,
    pub(crate) analysis: Analysis,
    /// Seconds of the analysis.
    pub(crate) seconds: f64,
}

impl Unanalysed {
    pub(crate) fn new(
        mesh: &DiskMesh,
        pins: &Pins,
        way: Way,
        kind: Kind,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let layout = Layout::new(mesh, pins, way);
        let system = layout.system(mesh, control)?;
        Ok(Self { way, layout, system, kind })
    }

    /// Values of equations for the factors. Includes the matrix if pins have no rows in it: that matrix does not
    /// need the analysis.
    pub(crate) fn numbers(
        &self,
        mesh: &DiskMesh,
        equations: Equations<Complex<f64>>,
        control: Control<'_>,
    ) -> Result<Numbers, SolveError> {
        let made = || self.system.negated_matrix(mesh, &equations, control);
        let matrix = (!self.layout.has_many).then(made).transpose()?;
        Ok(Numbers { equations, matrix, unit: 1.0 })
    }

    /// Orders and analyses the system. Returns the analysis and its seconds.
    pub(crate) fn analysis(&self, mesh: &DiskMesh, control: Control<'_>) -> Result<(Analysis, f64), SolveError> {
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let analysis = self.layout.analysis(Site { mesh, system: &self.system }, self.kind, control)?;
        Ok((analysis, start.elapsed().as_secs_f64()))
    }

    /// Adds the results of [`analysis`](Self::analysis).
    pub(crate) fn analysed(self, analysis: Analysis, seconds: f64) -> LaidOut {
        let Self { way, layout, system, kind } = self;
        LaidOut { way, layout, system, kind, analysis, seconds }
    }

    /// Orders and analyses the system at once.
    pub(crate) fn analysed_now(self, mesh: &DiskMesh, control: Control<'_>) -> Result<LaidOut, SolveError> {
        let (analysis, seconds) = self.analysis(mesh, control)?;
        Ok(self.analysed(analysis, seconds))
    }

    /// True if there are soft pins.
    pub(crate) fn has_springs(&self) -> bool {
        self.layout.holds.values().any(|kind| !kind.is_hard())
    }
}

impl LaidOut {
    /// True if all equations are kept and their dependence was not examined yet. False for conformal equations,
    /// which depend on each other all over the mesh.
    pub(crate) fn may_want_gauge(&self) -> bool {
        self.way.gauge.is_none() && self.layout.keeps_equations && self.kind == Kind::General
    }
}
