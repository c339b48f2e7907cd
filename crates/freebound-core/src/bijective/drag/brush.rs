//! Strokes of brushes on a planar embedding. Every frame is proved, as in a drag of pins.
//!
//! A *dab* is one application of a brush at a point. It moves the vertices within the brush's radius, and holds all
//! others. Hard pins stay. A boundary vertex moves as long as the boundary stays simple.
//!
//! | brush | dab |
//! |---|---|
//! | grab | the inner half moves with the pointer from the start; the rest of the circle follows like rubber |
//! | relax | a Newton step on the symmetric Dirichlet energy against the surface, scaled to the map's area |
//! | pinch | the inner half shrinks about the centre (or grows); the rest of the circle follows like rubber |
//! | smooth | boundary vertices move towards the middle of their neighbours; the circle follows like rubber |
//! | texels | a Newton step on the energy against the present map, whose triangles are scaled up (or down) |
//!
//! Falloff of relative distance t from the centre: w(t) = (1 − t²)² for t < 1, and 0 beyond.

use glam::DVec2;

use super::blocker::Blocker;
use super::patch::{FaceRest, Ground, Patch};
use super::proof::{InF32, verdict_of_planar};
use super::scaffold::LocalScaffold;
use super::{ADVANCES, Advance, DragSolver, DragTarget, HALVINGS, REST};
use crate::geom::double_area;
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::energy_problem::{Limits, Unfolding};
use crate::nonlinear::foldover_energy::Energy;
use crate::problem::{Control, Embedding, Pins, SolveError, hard_pins};
use crate::verify::Verdict;
use crate::weights::equations::length_scale;

/// Largest number of vertices that a dab moves. The circle shrinks to them.
const MOST_BRUSHED: usize = 3000;

/// Radius of the inner part of the circle, relative to the radius.
const INNER: f64 = 0.5;
/// Radius of the region that gives way to more texels, relative to the radius.
const WIDE: f64 = 2.0;

/// Relative shrinkage of the inner part by a dab at full strength.
const PINCH: f64 = 0.08;
/// Relative growth of triangles by a dab at full strength.
const GROWTH: f64 = 0.08;

/// Distance of dabs along the way of the pointer, relative to the radius.
const SPACING: f64 = 0.5;
/// Most dabs of a frame.
const MOST_DABS: usize = 4;

/// Kind of a brush.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrushKind {
    /// Moves a piece of the map with the pointer.
    Grab,
    /// Lowers the distortion.
    Relax,
    /// Pulls vertices to the pointer. Negative strength pushes them away.
    Pinch,
    /// Smooths the boundary.
    Smooth,
    /// Gives faces more area in the map. Negative strength gives them less.
    Texels,
}

impl BrushKind {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Grab, Self::Relax, Self::Pinch, Self::Smooth, Self::Texels];

    /// True if a negative strength inverts the brush.
    pub const fn has_inverse(self) -> bool {
        matches!(self, Self::Pinch | Self::Texels)
    }
}

/// Brush with its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Kind of the brush.
    pub kind: BrushKind,
    /// Radius in the plane of the embedding.
    pub radius: f64,
    /// Strength of a dab, 0 to 1. Kinds with an inverse take −1 to 1. A grab has no strength.
    pub strength: f64,
}

/// Result of one frame of a stroke.
#[derive(Clone, Debug)]
pub struct BrushFrame {
    /// Radius that was used. Smaller than that of the brush if too many vertices lie within it.
    pub radius: f64,
    /// Object that a grab cannot pass.
    pub obstacle: Option<Blocker>,
    /// True if nothing moves any more while the pointer stays.
    pub is_at_rest: bool,
    /// Verdict on the embedding as written, equal to [`verdict`](crate::verify::verdict) but proved from the moved
    /// region.
    pub verdict: Verdict,
}

/// Stroke of a brush on a planar embedding.
#[derive(Debug)]
pub struct BrushSolver {
    solver: DragSolver,
    brush: Brush,
    /// Pins of the map.
    target: DragTarget,
    /// Pointer at the start of the stroke, and at the latest frame.
    start: DVec2,
    last: DVec2,
    /// Factor from lengths of the surface to lengths of the map, by their areas.
    surface_scale: f64,
    /// Grab in progress.
    grip: Option<Grip>,
    moved: Vec<VertexId>,
    is_moved: Vec<bool>,
}

/// Vertices within a circle, nearest first, and the radius that holds them.
#[derive(Debug)]
struct Circle {
    vertices: Vec<VertexId>,
    centre: DVec2,
    radius: f64,
}

impl Circle {
    /// Used vertices within a radius, at most [`MOST_BRUSHED`]. On a coarse mesh the nearest vertex, if it is within
    /// `least`.
    fn new(mesh: &DiskMesh, embedding: &Embedding, centre: DVec2, [radius, least]: [f64; 2]) -> Self {
        let reach = radius.max(least);
        let at = |v: VertexId| (embedding[v].distance(centre), v);
        let is_near = |(distance, v): &(f64, VertexId)| *distance < reach && mesh.is_used(*v);
        let mut near: Vec<(f64, VertexId)> = mesh.vertices().map(at).filter(is_near).collect();
        let order = |a: &(f64, VertexId), b: &(f64, VertexId)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if near.len() > MOST_BRUSHED {
            // The circle may hold all of a large mesh: only the vertices that a dab moves are sorted.
            near.select_nth_unstable_by(MOST_BRUSHED, order);
            near.truncate(MOST_BRUSHED + 1);
        }
        near.sort_unstable_by(order);
        let within = near.partition_point(|(distance, _)| *distance < radius).max(1);
        near.truncate(within);
        let next = near.get(MOST_BRUSHED).map_or(radius, |(distance, _)| *distance);
        near.truncate(MOST_BRUSHED);
        Self { vertices: near.into_iter().map(|(_, v)| v).collect(), centre, radius: next.min(radius) }
    }

    /// Vertices in the inner part that are not pinned hard; at least the nearest one.
    fn inner(&self, embedding: &Embedding, pins: &Pins) -> Vec<VertexId> {
        let is_free = |v: &&VertexId| pins.get(v).is_none_or(|pin| !pin.kind.is_hard());
        let is_inner = |v: &VertexId| embedding[*v].distance(self.centre) <= INNER * self.radius;
        let mut free = self.vertices.iter().filter(is_free).copied().peekable();
        let first = free.peek().copied();
        let inner: Vec<VertexId> = free.take_while(is_inner).collect();
        if inner.is_empty() { first.into_iter().collect() } else { inner }
    }
}

/// Circle of a grab, and the vertices that it moves with the pointer.
#[derive(Debug)]
struct Grip {
    circle: Circle,
    inner: Vec<VertexId>,
}

/// Weight of a relative distance from the centre.
fn falloff(distance: f64) -> f64 {
    (1.0 - distance * distance).max(0.0).powi(2)
}

impl BrushSolver {
    /// Starts a stroke at a point of the plane, on an embedding made for `target`.
    ///
    /// The embedding as written must be planar, with positive orientation, including the filling of holes. `None`
    /// otherwise. `None` also if `embedding` does not have one position per vertex, a number is not finite, the radius
    /// is not positive, or a size of the embedding overflows or vanishes.
    pub fn new(mesh: &DiskMesh, embedding: Embedding, target: DragTarget, brush: Brush, at: DVec2) -> Option<Self> {
        let Brush { kind, radius, strength } = brush;
        let is_valid = radius > 0.0 && radius.is_finite() && strength.is_finite() && at.is_finite();
        if !is_valid || embedding.len() != mesh.vertex_count() {
            return None;
        }
        let least = if kind.has_inverse() { -1.0 } else { 0.0 };
        let brush = Brush { strength: strength.clamp(least, 1.0), ..brush };
        let solver = DragSolver::new(mesh, embedding, &[], target.clone())?;
        let grip = (kind == BrushKind::Grab).then(|| {
            let circle = Circle::new(mesh, &solver.begin, at, [radius, solver.scale.mean_edge]);
            let inner = circle.inner(&solver.begin, &target.pins);
            Grip { circle, inner }
        });
        let surface_scale = surface_scale(mesh, solver.scale.double_area);
        let (moved, is_moved) = (Vec::new(), vec![false; mesh.vertex_count()]);
        let stroke = Self { solver, brush, target, start: at, last: at, surface_scale, grip, moved, is_moved };
        surface_scale.is_normal().then_some(stroke)
    }

    /// Embedding of the latest frame.
    pub fn embedding(&self) -> &Embedding {
        &self.solver.embedding
    }

    /// Vertices that may have moved since the stroke began. All other vertices are where they were.
    pub fn moved(&self) -> &[VertexId] {
        &self.moved
    }

    /// Computes one frame with the pointer at a point of the plane. A brush other than a grab is applied along the way
    /// of the pointer. If cancelled, the embedding is that of the last proved step.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn frame(&mut self, mesh: &DiskMesh, at: DVec2, control: Control<'_>) -> Result<BrushFrame, SolveError> {
        if !at.is_finite() {
            return Ok(self.at_rest());
        }
        if self.brush.kind == BrushKind::Grab {
            return self.grab(mesh, at, control);
        }
        let way = at - self.last;
        let wanted = way.length() / (SPACING * self.brush.radius);
        let count = (1..MOST_DABS).find(|&count| count as f64 >= wanted).unwrap_or(MOST_DABS);
        let (from, mut largest, mut radius) = (self.last, 0.0_f64, self.brush.radius);
        for dab in 1..=count {
            let centre = from + way * (dab as f64 / count as f64);
            let (circle, moved) = self.dab(mesh, centre, control)?;
            (largest, radius) = (largest.max(moved), radius.min(circle));
        }
        self.last = at;
        Ok(BrushFrame { radius, is_at_rest: largest <= REST * self.solver.scale.mean_edge, ..self.at_rest() })
    }

    /// Frame that moves nothing.
    fn at_rest(&self) -> BrushFrame {
        let verdict = verdict_of_planar(self.solver.in_f32 != InF32::Folded);
        BrushFrame { radius: self.brush.radius, obstacle: None, is_at_rest: true, verdict }
    }

    /// Moves the grabbed vertices with the pointer.
    fn grab(&mut self, mesh: &DiskMesh, at: DVec2, control: Control<'_>) -> Result<BrushFrame, SolveError> {
        let Some(grip) = self.grip.take() else { return Ok(self.at_rest()) };
        let frame = self.move_grip(mesh, &grip, at, control);
        self.grip = Some(grip);
        self.last = at;
        self.note_moved();
        frame
    }

    fn move_grip(
        &mut self,
        mesh: &DiskMesh,
        Grip { circle, inner }: &Grip,
        at: DVec2,
        control: Control<'_>,
    ) -> Result<BrushFrame, SolveError> {
        let by = at - self.start;
        let targets: Vec<(VertexId, DVec2)> = inner.iter().map(|&v| (v, self.solver.begin[v] + by)).collect();
        let aim = self.aim(&targets);
        if inner.is_empty() || (self.solver.patch.is_none() && !self.place(mesh, circle, &targets, FaceRest::Begin)) {
            return Ok(self.at_rest());
        }
        let (mut last, mut largest) = (Advance::default(), 0.0_f64);
        for _ in 0..ADVANCES {
            last = self.solver.advance(mesh, &aim, control)?;
            largest = largest.max(last.largest);
            last.obstacle = last.end.and_then(|end| self.solver.obstacle(mesh, end)).filter(|_| last.share < 1.0);
            if last.share >= 1.0 {
                break;
            }
            self.solver.settle(mesh, &aim, control)?;
            let is_outside = |end| self.solver.patch.as_ref().is_some_and(|patch| patch.is_outside(end));
            if last.end.is_some_and(is_outside) {
                self.solver.around = None;
                self.place(mesh, circle, &targets, FaceRest::Begin);
            }
        }
        let is_at_rest = largest <= REST * self.solver.scale.mean_edge;
        Ok(BrushFrame { radius: circle.radius, obstacle: last.obstacle, is_at_rest, ..self.at_rest() })
    }

    /// Applies the brush once. Returns the radius that was used, and the largest move.
    fn dab(&mut self, mesh: &DiskMesh, centre: DVec2, control: Control<'_>) -> Result<(f64, f64), SolveError> {
        let Brush { kind, radius, strength } = self.brush;
        let wide = if kind == BrushKind::Texels { WIDE } else { 1.0 };
        let reach = [wide * radius, self.solver.scale.mean_edge];
        let circle = Circle::new(mesh, &self.solver.embedding, centre, reach);
        let used = circle.radius / wide;
        let targets = self.targets(mesh, &circle);
        let factor = |z: DVec2| 1.0 + GROWTH * strength * falloff(z.distance(centre) / used);
        let rest = match kind {
            BrushKind::Relax => FaceRest::Surface(self.surface_scale),
            BrushKind::Texels => FaceRest::Scaled(&factor),
            _ => FaceRest::Begin,
        };
        if !self.place(mesh, &circle, &targets, rest) {
            return Ok((used, 0.0));
        }
        let advance = match kind {
            BrushKind::Relax => self.solver.lower(mesh, strength, control)?,
            BrushKind::Texels => self.solver.lower(mesh, 1.0, control)?,
            _ => self.solver.advance(mesh, &self.aim(&targets), control)?,
        };
        let is_outside = |end| self.solver.patch.as_ref().is_some_and(|patch| patch.is_outside(end));
        if advance.share < 1.0 && advance.end.is_none_or(is_outside) {
            // The next dab triangulates the outside again.
            self.solver.around = None;
        }
        self.note_moved();
        for &vertex in &circle.vertices {
            self.solver.begin[vertex] = self.solver.embedding[vertex];
        }
        Ok((used, advance.largest))
    }

    /// Vertices that a dab moves to prescribed positions.
    fn targets(&self, mesh: &DiskMesh, circle: &Circle) -> Vec<(VertexId, DVec2)> {
        let (embedding, pins) = (&self.solver.embedding, &self.target.pins);
        let strength = self.brush.strength;
        match self.brush.kind {
            BrushKind::Pinch => {
                let scale = 1.0 - PINCH * strength;
                let target = |v: VertexId| (v, circle.centre + scale * (embedding[v] - circle.centre));
                circle.inner(embedding, pins).into_iter().map(target).collect()
            }
            BrushKind::Smooth => {
                let (count, around) = (mesh.boundary_loop().len(), mesh.boundary_loop());
                let target = |&v: &VertexId| {
                    let place =
                        mesh.boundary_place(v).filter(|_| pins.get(&v).is_none_or(|pin| !pin.kind.is_hard()))?;
                    let [before, after] = [count - 1, 1].map(|by| embedding[around[(place + by) % count]]);
                    let share = 0.5 * strength * falloff(embedding[v].distance(circle.centre) / circle.radius);
                    Some((v, embedding[v].lerp(0.5 * (before + after), share)))
                };
                circle.vertices.iter().filter_map(target).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Pins of the map, and targets of a dab.
    fn aim(&self, targets: &[(VertexId, DVec2)]) -> DragTarget {
        let mut aim = self.target.clone();
        aim.pins.extend(hard_pins(targets.iter().copied()));
        aim
    }

    /// Places the solver on the vertices of a circle. Returns true if they can move.
    fn place(&mut self, mesh: &DiskMesh, circle: &Circle, targets: &[(VertexId, DVec2)], rest: FaceRest<'_>) -> bool {
        if self.brush.kind == BrushKind::Smooth && targets.is_empty() {
            return false;
        }
        let solver = &mut self.solver;
        solver.dragged = targets.iter().map(|(v, _)| *v).collect();
        solver.dragged.sort_unstable();
        solver.pins = self.target.pins.clone();
        solver.pins.extend(hard_pins(solver.dragged.iter().map(|&v| (v, solver.embedding[v]))));
        let is_at_boundary = circle.vertices.iter().any(|&v| mesh.boundary_place(v).is_some());
        let places = || targets.iter().map(|(_, z)| *z);
        let serves = |around: &LocalScaffold| around.is_positive && places().all(|z| around.has_room_for(z));
        if is_at_boundary && !solver.around.as_ref().is_some_and(serves) {
            solver.around = LocalScaffold::new(mesh, &solver.embedding, places(), &solver.sheet);
        }
        let ground = Ground {
            mesh,
            begin: &solver.begin,
            rest,
            embedding: &solver.embedding,
            pins: &solver.pins,
            dragged: &solver.dragged,
            around: solver.around.as_ref(),
            double_area: solver.scale.double_area,
            spring_unit: solver.scale.spring_unit,
        };
        solver.patch = Patch::new(&ground, &circle.vertices, None).ok().filter(|patch| !patch.moving().is_empty());
        solver.patch.is_some()
    }

    fn note_moved(&mut self) {
        let Some(patch) = &self.solver.patch else { return };
        for &vertex in patch.moving() {
            if !std::mem::replace(&mut self.is_moved[vertex.index()], true) {
                self.moved.push(vertex);
            }
        }
    }
}

impl DragSolver {
    /// Takes a share of a Newton step on the symmetric Dirichlet energy.
    fn lower(&mut self, mesh: &DiskMesh, share: f64, control: Control<'_>) -> Result<Advance, SolveError> {
        let Some(patch) = &self.patch else { return Ok(Advance::default()) };
        let before = patch.z().to_vec();
        let mut after = before.clone();
        let (unfolded, unfolding) = (Energy::SymmetricDirichlet, Unfolding::Freely);
        let limits = Limits { unfolded, steps: 1, unfolding, tolerance: 0.0 };
        match patch.problem().descend(&mut after, limits, None, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            // Rounding leaves no direction: the energy is as low as possible.
            Err(_) => return Ok(Advance { share: 1.0, ..Advance::default() }),
            Ok(_) => {}
        }
        let mut share = share;
        for halving in 0..=HALVINGS {
            let z: Vec<DVec2> = before.iter().zip(&after).map(|(a, b)| a.lerp(*b, share)).collect();
            let largest = z.iter().zip(&before).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let sheet = self.sheet.clone();
            if self.take(mesh, z, &sheet) {
                let taken = if halving == 0 { 1.0 } else { 0.5 };
                return Ok(Advance { share: taken, largest, ..Advance::default() });
            }
            share *= 0.5;
        }
        Ok(Advance::default())
    }
}

/// Factor from lengths of the surface to lengths of a map with this double area.
fn surface_scale(mesh: &DiskMesh, map_area: f64) -> f64 {
    let unit = length_scale(mesh);
    let area: f64 = mesh.real_faces().map(|face| double_area(mesh.rest_shape(mesh.face(face), unit))).sum();
    unit * (map_area / area).sqrt()
}
