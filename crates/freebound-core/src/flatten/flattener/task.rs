//! What is asked for: settings and pins.

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

/// Numbers in 32 bits are off by less than this share of their size, and so are targets that lie about the origin.
const ROUNDING_IN_32_BITS: f64 = 1e-6;

#[derive(Debug)]
pub(super) struct Task {
    pub(super) settings: Settings,
    pub(super) pins: Pins,
    /// How embeddings are written: what is proved.
    pub(super) frame: Arc<UvFrame>,
    /// The layout to start from, one position per vertex.
    pub(super) start: Option<Arc<Embedding>>,
}

impl Task {
    /// Pins count only where the method uses them.
    pub(super) fn new(settings: Settings, pins: Pins, frame: Arc<UvFrame>) -> Self {
        let pins = if settings.method.uses_pins() { pins } else { Pins::new() };
        Self { settings, pins, frame, start: None }
    }

    /// The units of its solves. Placing and pictures that are not square round in the numbers that are written: there the
    /// origin stays, so that stages prove these.
    pub(super) fn units(&self) -> Units {
        let units = Units::of(&self.pins, self.settings.size);
        if self.is_constrained() && self.frame.is_plain() { units } else { units.about_origin() }
    }

    /// The same in units of a solve. Where these are not the plane's own, stages prove what they solve, and what is written
    /// is proved of every step.
    pub(super) fn in_units(&self, units: &Units) -> Self {
        let frame = if units.is_plane() { Arc::clone(&self.frame) } else { Arc::default() };
        let in_units = |start: &Arc<Embedding>| {
            if units.is_plane() { Arc::clone(start) } else { Arc::new(units.embedding(start)) }
        };
        let start = self.start.as_ref().map(in_units);
        Self { settings: units.settings(self.settings.clone()), pins: units.pins(&self.pins), frame, start }
    }

    /// Whether the pins are constraints: up to two exact ones only fix the similarity.
    pub(super) fn is_constrained(&self) -> bool {
        self.settings.are_constraints(&self.pins)
    }

    pub(super) fn has_open_gauge(&self) -> bool {
        self.pins.len() < GAUGE_PINS
    }

    /// Whether the layout to start from meets all constraints, and none pulls.
    pub(super) fn is_met_by_start(&self) -> bool {
        let Some(start) = self.start.as_ref().filter(|_| self.is_constrained()) else { return false };
        let is_met = |(vertex, pin): (&VertexId, &Pin)| {
            self.settings.is_hard(pin.kind) && start.get(vertex.index()) == Some(&pin.target)
        };
        self.pins.iter().all(is_met)
    }

    /// Whether the method continues, and the layout to start from lies on two of the constraints, but for rounding to 32
    /// bits: they hold it where it is.
    pub(super) fn is_held_by_start(&self) -> bool {
        let Some(start) = self.start.as_ref().filter(|_| self.continues()) else { return false };
        let near = ROUNDING_IN_32_BITS * Bounds::of(self.pins.values().map(|pin| pin.target)).size().max_element();
        let lies_on = |(vertex, pin): &(&VertexId, &Pin)| {
            start.get(vertex.index()).is_some_and(|z| z.distance(pin.target) <= near)
        };
        self.pins.iter().filter(lies_on).count() >= GAUGE_PINS
    }

    /// Whether the method continues from an embedding to the constraints, and there are some.
    pub(super) fn continues(&self) -> bool {
        self.settings.continues(&self.pins)
    }

    pub(super) fn held(&self) -> Pins {
        self.settings.held(&self.pins)
    }

    /// Whether new vertices are made where the constraints cannot be met otherwise.
    pub(super) fn adds_vertices(&self) -> bool {
        self.settings.method == Method::Auto && self.settings.new_vertices
    }

    /// Whether polygons that cannot be convex are cut into triangles: stage 5 by itself is asked for new vertices, too.
    pub(super) fn cuts_polygons(&self) -> bool {
        self.adds_vertices() || self.settings.method == Method::Matchmaker
    }

    /// Checks what the first stage does not.
    pub(super) fn check(&self, mesh: &DiskMesh) -> Result<(), SolveError> {
        match &self.settings.method {
            method if self.is_constrained() && !method.takes_constraints() => {
                Err(SolveError::TooManyPins { method: method.name(), count: self.pins.len(), most: GAUGE_PINS })
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

    /// Moves a candidate to where up to two pins, or none, want it, without a fold. Constraints hold it where it is.
    /// Returns a note where it could not be moved.
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
        if self.pins.is_empty() && self.is_start(mesh, embedding) {
            candidate.solution.pins = gauge_in(mesh, embedding);
            return Ok(None);
        }
        let Some(placing) = self.placing(mesh, candidate, control)? else {
            candidate.solution.pins = gauge_in(mesh, embedding);
            let note = "the pinned vertices fell together, and no similarity takes them to their targets";
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
        Ok(placed.way.is_none().then(|| "not yet moved to its place, whose numbers would fold it".to_owned()))
    }

    /// Whether an embedding is the layout that it started from, to the last bit; vertices of no face may lie anywhere.
    fn is_start(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        self.start.as_deref().is_some_and(|start| {
            let mut used = mesh.vertices().filter(|&vertex| mesh.is_used(vertex));
            start.len() == embedding.len() && used.all(|vertex| start[vertex] == embedding[vertex])
        })
    }

    /// To where up to two pins want a candidate; where they leave that open, to where the layout lies that it started from.
    fn placing(
        &self,
        mesh: &DiskMesh,
        candidate: &Candidate,
        control: Control<'_>,
    ) -> Result<Option<Placing>, SolveError> {
        let embedding = &candidate.solution.embedding;
        match &self.start {
            Some(start) if self.has_open_gauge() => Ok(Some(Placing::over(mesh, [embedding, start], &self.pins))),
            _ => {
                let free = Free { size: self.settings.size, turns: self.turns(mesh, candidate, control)? };
                Placing::of_gauge(Placement { mesh, embedding, free, control }, &self.pins)
            }
        }
    }

    /// How a candidate is turned where pins leave it free: upright; the sides of a square stay level, and a polygon of the
    /// user's as it is.
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

    /// Whether all pins that are to be met exactly lie on their targets.
    pub(super) fn are_met(&self, embedding: &Embedding) -> bool {
        let mut exact = self.pins.iter().filter(|(_, pin)| self.settings.is_hard(pin.kind));
        exact.all(|(vertex, pin)| embedding[vertex] == pin.target)
    }
}

/// The default gauge pins where they lie in an embedding.
pub(super) fn gauge_in(mesh: &DiskMesh, embedding: &Embedding) -> Pins {
    fixed_pins(gauge_pins(mesh).into_keys().map(|v| (v, embedding[v])))
}

fn moved(outside: &Scaffold, way: Similarity) -> Scaffold {
    let frame = outside.frame.iter().map(|&z| way.apply(z)).collect();
    Scaffold { frame, triangles: outside.triangles.clone() }
}

/// Checks that no two exact targets are so near that numbers between them run out.
fn check_distances(mesh: &DiskMesh, pins: &Pins) -> Result<(), SolveError> {
    for conflict in conflicts(mesh, pins) {
        if let Conflict::NearCoincidentTargets { vertices: [first, second] } = conflict {
            return Err(SolveError::TargetsTooNear { first, second });
        }
    }
    Ok(())
}
