//! A system of a free boundary before it is factored: which vertices the factors leave out, what the pins add, its numbers.

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

/// With more pins than this that least squares has to treat, their rows go sparse. An estimate: at a thousand the dense
/// way takes many times as long.
const FEW: usize = 64;

/// What becomes of the equations of pins, and whether others are left out beside them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Way {
    pub(crate) treatment: Treatment,
    /// Two vertices whose equations depend on the others, where they are known: least squares leaves them out, too.
    pub(crate) gauge: Option<[VertexId; 2]>,
}

impl Way {
    /// Whether the equations of these pins are kept. One exact pin alone does not fix the similarity: the rest without its
    /// equation would still be singular.
    pub(crate) fn keeps_equations(self, pins: &Pins) -> bool {
        let exact = pins.values().filter(|pin| pin.kind.is_hard()).count();
        self.treatment != Treatment::Eliminate || exact < GAUGE_PINS
    }
}

/// How pins enter a system.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    /// The vertices without unknown in the factors, ascending: all pins and a gauge where all equations are kept and pins
    /// are few, otherwise the exact pins.
    pub(crate) left_out: Vec<VertexId>,
    /// Whether the equations of those are kept beside the factors; otherwise they are pins, eliminated.
    pub(crate) keeps_equations: bool,
    /// Whether least squares has too many pins to treat them one by one.
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
            // With one pin the equations still depend on each other: those of any vertices will do to begin with.
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

    /// What least squares has to treat, if anything. For `unit` see [`Numbers`].
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

/// The numbers of a system.
pub(crate) struct Numbers {
    pub(crate) equations: Equations<Complex<f64>>,
    /// Their matrix, where it is there already.
    pub(crate) matrix: Option<CscMatrix<Complex<f64>>>,
    /// What the rows are to be multiplied by so that they are those of a geometry whose edges have length 1 on average.
    pub(crate) unit: f64,
}

/// A system laid out.
#[derive(Debug)]
pub(crate) struct Unanalysed {
    way: Way,
    layout: Layout,
    system: FreeSystem,
    /// What is known of its matrix.
    kind: Kind,
}

/// The same, analysed.
#[derive(Debug)]
pub(crate) struct LaidOut {
    pub(crate) way: Way,
    pub(crate) layout: Layout,
    pub(crate) system: FreeSystem,
    /// What is known of its matrix.
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

    /// The numbers of equations for its factors; with the matrix, which does not wait for the analysis, where pins have no rows in
    /// it.
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

    /// Orders and analyses it. Returns also the seconds that took.
    pub(crate) fn analysis(&self, mesh: &DiskMesh, control: Control<'_>) -> Result<(Analysis, f64), SolveError> {
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let analysis = self.layout.analysis(Site { mesh, system: &self.system }, self.kind, control)?;
        Ok((analysis, start.elapsed().as_secs_f64()))
    }

    /// With what [`analysis`](Self::analysis) returned.
    pub(crate) fn analysed(self, analysis: Analysis, seconds: f64) -> LaidOut {
        let Self { way, layout, system, kind } = self;
        LaidOut { way, layout, system, kind, analysis, seconds }
    }

    /// Orders and analyses it here and now.
    pub(crate) fn analysed_now(self, mesh: &DiskMesh, control: Control<'_>) -> Result<LaidOut, SolveError> {
        let (analysis, seconds) = self.analysis(mesh, control)?;
        Ok(self.analysed(analysis, seconds))
    }

    /// Whether pins pull by a weight.
    pub(crate) fn has_springs(&self) -> bool {
        self.layout.holds.values().any(|kind| !kind.is_hard())
    }
}

impl LaidOut {
    /// Whether all equations are kept, and it was not looked at yet where they depend on each other. Conformal ones do so all
    /// over the mesh.
    pub(crate) fn may_want_gauge(&self) -> bool {
        self.way.gauge.is_none() && self.layout.keeps_equations && self.kind == Kind::General
    }
}
