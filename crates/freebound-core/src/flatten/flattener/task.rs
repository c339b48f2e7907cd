//! The request: settings and pins.

use std::sync::Arc;

use super::Candidate;
use crate::flatten::placing::{Free, Placement, Placing};
use crate::flatten::upright::Turns;
use crate::geom::{Bounds, Similarity};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::Scaffold;
use crate::problem::pins::GAUGE_PINS;
use crate::problem::units::Units;
use crate::problem::{
    BoundaryShape, Control, Embedding, Method, NamedOption as _, Pin, Pins, Settings, SolveError, check_pins,
    fixed_pins, gauge_pins,
};
use crate::verify::{Conflict, UvFrame, conflicts};

/// Relative error bound of numbers in 32 bits, also for targets that lie about the origin.
const ROUNDING_IN_32_BITS: f64 = 1e-6;

#[derive(Debug)]
pub(super) struct Task {
    pub(super) settings: Settings,
    pub(super) pins: Pins,
    /// Output frame in which embeddings are proved.
    pub(super) frame: Arc<UvFrame>,
    /// Layout to start from, one position per vertex.
    pub(super) start: Option<Arc<Embedding>>,
    /// True if the layout leaves position, rotation and size open.
    pub(super) start_is_free: bool,
}

impl Task {
    /// Task with these pins, or without pins if the method does not use them.
    pub(super) fn new(settings: Settings, pins: Pins, frame: Arc<UvFrame>) -> Self {
        let pins = if settings.method.uses_pins() { pins } else { Pins::new() };
        Self { settings, pins, frame, start: None, start_is_free: false }
    }

    /// Units of the solves. Placement, and pictures that are not square, round the written numbers. In these cases the
    /// origin stays fixed, so that stages prove the written numbers.
    pub(super) fn units(&self) -> Units {
        let units = Units::of(&self.pins, self.settings.size);
        if self.is_constrained() && self.frame.is_plain() { units } else { units.about_origin() }
    }

    /// Task in units of the solves. If these differ from the plane's own, stages prove the numbers that they solve
    /// for, and every step is proved again as written.
    pub(super) fn in_units(&self, units: &Units) -> Self {
        let frame = if units.is_plane() { Arc::clone(&self.frame) } else { Arc::default() };
        let in_units = |start: &Arc<Embedding>| {
            if units.is_plane() { Arc::clone(start) } else { Arc::new(units.embedding(start)) }
        };
        let start = self.start.as_ref().map(in_units);
        let (settings, pins) = (units.settings(self.settings.clone()), units.pins(&self.pins));
        Self { settings, pins, frame, start, start_is_free: self.start_is_free }
    }

    /// True if the pins are constraints. Up to two hard pins only fix the similarity.
    pub(super) fn is_constrained(&self) -> bool {
        self.settings.are_constraints(&self.pins)
    }

    pub(super) fn has_open_gauge(&self) -> bool {
        self.pins.len() < GAUGE_PINS
    }

    /// True if the layout to start from meets all constraints, and all pins are hard.
    pub(super) fn is_met_by_start(&self) -> bool {
        let Some(start) = self.start.as_ref().filter(|_| self.is_constrained()) else { return false };
        let is_met = |(vertex, pin): (&VertexId, &Pin)| {
            self.settings.is_hard(pin.kind) && start.get(vertex.index()) == Some(&pin.target)
        };
        self.pins.iter().all(is_met)
    }

    /// True if the method continues and the initial layout lies on at least two of the constraints, up to rounding to
    /// 32 bits. These constraints then hold the layout in place.
    pub(super) fn is_held_by_start(&self) -> bool {
        let Some(start) = self.start.as_ref().filter(|_| self.continues()) else { return false };
        let near = ROUNDING_IN_32_BITS * Bounds::of(self.pins.values().map(|pin| pin.target)).size().max_element();
        let lies_on = |(vertex, pin): &(&VertexId, &Pin)| {
            start.get(vertex.index()).is_some_and(|z| z.distance(pin.target) <= near)
        };
        self.pins.iter().filter(lies_on).count() >= GAUGE_PINS
    }

    /// True if the method continues from an embedding to the constraints, and there are constraints.
    pub(super) fn continues(&self) -> bool {
        self.settings.continues(&self.pins)
    }

    pub(super) fn held(&self) -> Pins {
        self.settings.held(&self.pins)
    }

    /// True if new vertices are added when the constraints cannot be met otherwise.
    pub(super) fn adds_vertices(&self) -> bool {
        self.settings.method == Method::Auto && self.settings.new_vertices
    }

    /// True if polygons that cannot be convex are cut into triangles. Stage 5 as a method also permits new vertices.
    pub(super) fn cuts_polygons(&self) -> bool {
        self.adds_vertices() || self.settings.method == Method::Matchmaker
    }

    /// Checks the conditions that the first stage does not check.
    pub(super) fn check(&self, mesh: &DiskMesh) -> Result<(), SolveError> {
        match &self.settings.method {
            method if self.is_constrained() && !method.takes_constraints() => {
                Err(SolveError::TooManyPins { method: method.labels().title, count: self.pins.len(), most: GAUGE_PINS })
            }
            method if method.only_places_pins() => check_pins(mesh, &self.pins),
            Method::Auto if self.is_constrained() => check_distances(mesh, &self.held()),
            method if method.is_one_to_one() => {
                check_pins(mesh, &self.held())?;
                check_distances(mesh, &self.held())
            }
            _ => Ok(()),
        }
    }

    /// Moves a candidate to the position that up to two pins, or none, require, without a fold. Constraints hold it in
    /// place. Returns a note if it could not be moved.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(super) fn place(
        &self,
        mesh: &DiskMesh,
        candidate: &mut Candidate,
        control: Control<'_>,
    ) -> Result<Option<String>, SolveError> {
        let embedding = &candidate.solution.embedding;
        let is_open = self.has_open_gauge();
        if self.is_constrained() || (!is_open && self.are_met(embedding)) {
            return Ok(None);
        }
        candidate.solution.gauge_completed = is_open;
        if self.pins.is_empty() && self.lies_as_given() && self.is_start(mesh, embedding) {
            candidate.solution.pins = gauge_in(mesh, embedding);
            return Ok(None);
        }
        let Some(placing) = self.placing(mesh, candidate, control)? else {
            candidate.solution.pins = gauge_in(mesh, embedding);
            let note = "the pinned vertices coincide: no similarity moves them to their targets";
            return Ok(Some(note.to_owned()));
        };
        control.go_on()?;
        let is_planar = self.frame.is_planar(mesh, embedding);
        let holds = |embedding: &Embedding| {
            let frame = &self.frame;
            let holds =
                || if is_planar { frame.is_planar(mesh, embedding) } else { frame.is_one_to_one(mesh, embedding) };
            control.go_on().map(|()| holds())
        };
        let placed = placing.best(embedding, holds)?;
        let solution = &mut candidate.solution;
        solution.embedding = placed.embedding;
        if !is_open || placed.way.is_none() {
            solution.pins.clone_from(&self.pins);
        } else if solution.pins.is_empty() {
            solution.pins = gauge_in(mesh, &solution.embedding);
        } else {
            for (vertex, pin) in &mut solution.pins {
                pin.target = solution.embedding[vertex];
            }
        }
        if let (Some(way), Some(outside)) = (placed.way, &candidate.outside) {
            candidate.outside = Some(Arc::new(moved(outside, way)));
        }
        Ok(placed.way.is_none().then(|| "not yet moved to its place: rounding there would fold it".to_owned()))
    }

    /// True if the map has to stay at the place of the initial layout.
    pub(super) fn lies_as_given(&self) -> bool {
        self.start.is_some() && !self.start_is_free
    }

    /// True if an embedding equals the initial layout to the last bit. Unreferenced vertices are ignored.
    fn is_start(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        self.start.as_deref().is_some_and(|start| {
            let mut used = mesh.vertices().filter(|&vertex| mesh.is_used(vertex));
            start.len() == embedding.len() && used.all(|vertex| start[vertex] == embedding[vertex])
        })
    }

    /// Placement of a candidate for up to two pins. If they leave it open, the initial layout determines it.
    fn placing(
        &self,
        mesh: &DiskMesh,
        candidate: &Candidate,
        control: Control<'_>,
    ) -> Result<Option<Placing>, SolveError> {
        let embedding = &candidate.solution.embedding;
        match &self.start {
            Some(start) if self.has_open_gauge() && !self.start_is_free => {
                Ok(Some(Placing::over(mesh, [embedding, start], &self.pins)))
            }
            _ => {
                let free = Free { size: self.settings.size, turns: self.turns(mesh, candidate, control)? };
                Placing::of_gauge(Placement { mesh, embedding, free, control }, &self.pins)
            }
        }
    }

    /// Rotation of a candidate if pins leave it free: upright. The sides of a square stay level, and a polygon given
    /// by the user is not rotated.
    fn turns(&self, mesh: &DiskMesh, candidate: &Candidate, control: Control<'_>) -> Result<Turns, SolveError> {
        if !self.has_open_gauge() {
            return Ok(Turns::NONE);
        }
        let turns = Turns::upright(mesh, &candidate.solution.embedding, control)?;
        Ok(match candidate.stage.boundary_shape() {
            Some(BoundaryShape::Polygon(_)) => Turns::NONE,
            Some(BoundaryShape::Hull) => turns,
            _ if candidate.has_convex_boundary() => turns.by_quarters(),
            _ => turns,
        })
    }

    /// True if all hard pins lie on their targets.
    pub(super) fn are_met(&self, embedding: &Embedding) -> bool {
        let mut exact = self.pins.iter().filter(|(_, pin)| self.settings.is_hard(pin.kind));
        exact.all(|(vertex, pin)| embedding[vertex] == pin.target)
    }
}

/// Default gauge pins at their positions in an embedding.
pub(super) fn gauge_in(mesh: &DiskMesh, embedding: &Embedding) -> Pins {
    fixed_pins(gauge_pins(mesh).into_keys().map(|v| (v, embedding[v])))
}

fn moved(outside: &Scaffold, way: Similarity) -> Scaffold {
    let frame = outside.frame.iter().map(|&z| way.apply(z)).collect();
    Scaffold { frame, triangles: outside.triangles.clone() }
}

/// Checks that no two hard targets are so close that 64-bit numbers cannot separate them.
fn check_distances(mesh: &DiskMesh, pins: &Pins) -> Result<(), SolveError> {
    for conflict in conflicts(mesh, pins) {
        if let Conflict::NearCoincidentTargets { vertices: [first, second] } = conflict {
            return Err(SolveError::TargetsTooNear { first, second });
        }
    }
    Ok(())
}
