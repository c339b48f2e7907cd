//! A proved step with its distortion, and its final coordinates.

use glam::DVec2;

use super::{Fit, PinsSummary, Placement, Problem, SoftPinSummary, Target};
use crate::flatten::{Candidate, Step, to_unit_box, to_unit_square, to_unit_square_by_power_of_two, true_area_factor};
use crate::geom::{Similarity, VAxis};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::{Embedding, GaugeSize, PinKind, Pins, Treatment};
use crate::verify::{Distortion, Verdict, distortion, verdict};

/// A step of a run with all data that the screen and files show.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Settings, frame and targets of the run.
    pub problem: Problem,
    /// Embedding, verdict and numbers of the solve.
    pub step: Step,
    /// Distortion of the faces.
    pub distortion: Distortion,
}

impl Outcome {
    /// Measures the distortion of a step on `mesh`, the mesh as given.
    pub fn new(mesh: &DiskMesh, problem: Problem, step: Step) -> Self {
        let distortion = distortion(step.candidate.mesh(mesh), &step.candidate.solution.embedding);
        Self { problem, step, distortion }
    }

    /// Map that was made for a problem before, proved again and otherwise unchanged: one position per vertex, in the
    /// plane. `None` unless the map is planar, upright, and meets all hard pins. Only such a map can be continued as if
    /// its flattener still ran.
    pub fn of_saved_map(mesh: &DiskMesh, problem: Problem, embedding: Embedding) -> Option<Self> {
        if embedding.len() != mesh.vertex_count() || !embedding.iter().all(|z| z.is_finite()) {
            return None;
        }
        let pins =
            if problem.settings.method.uses_pins() { problem.settings.held(&problem.pins()) } else { Pins::new() };
        let step = Step::of_saved_map(mesh, embedding, &pins, &problem.output_frame());
        let outcome = Self::new(mesh, problem, step);
        outcome.can_be_saved().then_some(outcome)
    }

    /// Map that the user shaped, as the first step of a run, see [`Problem::shaped`]. Up to two hard pins move, turn and
    /// scale it. `None` if there is none, or it does not meet the hard pins and stay planar.
    pub fn of_shaped_map(mesh: &DiskMesh, problem: &Problem) -> Option<Self> {
        let shaped = &problem.shaped.as_ref()?.0;
        let pins = problem.settings.held(&problem.pins());
        let hard: Vec<(VertexId, DVec2)> =
            pins.iter().filter(|(_, pin)| pin.kind.is_hard()).map(|(&vertex, pin)| (vertex, pin.target)).collect();
        if shaped.len() != mesh.vertex_count() || problem.shaped_map_meets_pins() {
            return Self::of_saved_map(mesh, problem.clone(), shaped.as_ref().clone());
        }
        let moved_to = match hard.as_slice() {
            [(a, to)] => Similarity::new(DVec2::X, shaped[*a], *to),
            [(a, to_a), (b, to_b)] => Similarity::fitting(&[[shaped[*a], *to_a], [shaped[*b], *to_b]])?,
            _ => return None,
        };
        let mut embedding: Embedding = shaped.iter().map(|&z| moved_to.apply(z)).collect();
        for (vertex, target) in hard {
            embedding[vertex] = target;
        }
        Self::of_saved_map(mesh, problem.clone(), embedding)
    }

    /// True if a project can keep the map of this outcome: it is planar, upright, meets all hard pins, and has no new
    /// vertices.
    pub fn can_be_saved(&self) -> bool {
        let Step { candidate, verdict, .. } = &self.step;
        let is_whole = candidate.refinement.is_none() && !self.step.is_of_planar_start();
        is_whole && verdict.planar && !verdict.mirrored && self.step.unmet().is_empty()
    }

    /// Memory of the outcome in bytes. Excludes the factors of a linear solve, which are kept once for the next
    /// solve. Excludes the refined mesh, which is kept once for all steps on it.
    pub fn bytes(&self) -> usize {
        let Step { candidate, verdict, outside_hull, .. } = &self.step;
        let Candidate { solution, virtual_boundary, outside, .. } = candidate;
        let pin_count = self.problem.targets.len() + solution.pins.len();
        let stages = virtual_boundary.as_ref().map_or(0, |stages| {
            size_of_val(&*stages.before)
                + size_of_val(&*stages.solved)
                + size_of_val(&*stages.hull)
                + size_of_val(&*stages.pockets)
        });
        let outside =
            outside.as_ref().map_or(0, |outside| size_of_val(&*outside.frame) + size_of_val(&*outside.triangles));
        size_of::<Self>()
            + size_of_val(&*solution.embedding)
            + size_of_val(&*self.distortion.faces)
            + size_of_val(&*verdict.flipped_faces)
            + size_of_val(&*verdict.concave_polygons)
            + size_of_val(&*verdict.boundary_crossings)
            + size_of_val(&*verdict.overwound_vertices)
            + size_of_val(&**outside_hull)
            + pin_count * size_of::<(VertexId, DVec2)>()
            + stages
            + outside
    }

    /// Number of vertices added to the mesh as given.
    pub fn new_vertex_count(&self) -> usize {
        self.step.candidate.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices_of_surface().count())
    }

    /// Final texture coordinates, their placement, and the verdict on them for the mesh of the step. `mesh` is the
    /// mesh as given.
    ///
    /// The user's pins keep their positions; a hard pin that is met keeps the exact numbers of its target. Without
    /// pins, `fit` decides the size.
    ///
    /// Scaling to the unit square rounds. If rounding breaks planarity in 64 or 32 bits, a power of two replaces the
    /// scale, which rounds less. If planarity still breaks, the embedding is scaled by a power of two and not moved,
    /// which rounds nothing.
    pub fn output(&self, mesh: &DiskMesh, fit: Fit) -> (Embedding, Placement, Verdict) {
        type Way = (fn(&mut Embedding), Placement);
        let (embedding, mesh) = (&self.step.candidate.solution.embedding, self.step.candidate.mesh(mesh));
        if self.targets_in_use().next().is_some() {
            return self.as_it_lies(mesh, Placement::Pins);
        }
        if self.step.lies_as_given && fit == Fit::Unit {
            return self.as_it_lies(mesh, Placement::File);
        }
        if self.problem.settings.size != GaugeSize::TrueArea {
            return self.as_it_lies(mesh, Placement::Picture);
        }
        if fit == Fit::True {
            return self.at_true_size(mesh);
        }
        let placed = |place: fn(&mut Embedding), name| {
            let mut coordinates = embedding.clone();
            place(&mut coordinates);
            let verdict = verdict(mesh, &coordinates);
            (coordinates, name, verdict)
        };
        // Required: all that the step proved in 64 and 32 bits. The last transform rounds in neither.
        let holds = |verdict: &Verdict| {
            let Verdict { planar, planar_in_f32, .. } = self.step.verdict;
            (verdict.planar || !planar) && (verdict.planar_in_f32 || !planar_in_f32)
        };
        let first = placed(to_unit_square, Placement::Unit);
        if holds(&first.2) {
            return first;
        }
        let others: [Way; 2] = [(to_unit_square_by_power_of_two, Placement::Unit), (to_unit_box, Placement::Unmoved)];
        let rescued = others.into_iter().map(|(place, name)| placed(place, name)).find(|found| holds(&found.2));
        rescued.unwrap_or(first)
    }

    /// Embedding scaled to the area of the surface in its file, and its verdict. `mesh` is the mesh of the step.
    fn at_true_size(&self, mesh: &DiskMesh) -> (Embedding, Placement, Verdict) {
        let embedding = &self.step.candidate.solution.embedding;
        let unit = mesh.unit() * if self.step.lies_as_given { true_area_factor(mesh, embedding) } else { 1.0 };
        if unit.to_bits() == 1.0_f64.to_bits() {
            return (embedding.clone(), Placement::True, self.step.verdict.clone());
        }
        let coordinates: Embedding = embedding.iter().map(|&z| z * unit).collect();
        let verdict = verdict(mesh, &coordinates);
        (coordinates, Placement::True, verdict)
    }

    /// Texture coordinates of the embedding without a transform, met hard pins at the numbers of their targets, and
    /// the verdict on the coordinates in the plane. `mesh` is the mesh of the step.
    fn as_it_lies(&self, mesh: &DiskMesh, placement: Placement) -> (Embedding, Placement, Verdict) {
        let embedding = &self.step.candidate.solution.embedding;
        let mut coordinates: Embedding = embedding.iter().map(|&z| self.problem.frame.uv_from_plane(z)).collect();
        let settings = &self.problem.settings;
        for (vertex, target, error) in self.pin_errors().filter(|(_, target, _)| settings.is_hard(target.kind)) {
            // A step before the constraints are met has not reached all targets.
            if error == 0.0 {
                coordinates[vertex.index()] = target.uv;
            }
        }
        let upright: Embedding = match self.problem.frame.v_axis {
            VAxis::Up => coordinates.clone(),
            VAxis::Down => coordinates.iter().map(|uv| DVec2::new(uv.x, -uv.y)).collect(),
        };
        let same = upright == *embedding;
        let verdict = if same { self.step.verdict.clone() } else { verdict(mesh, &upright) };
        (coordinates, placement, verdict)
    }

    /// Distance of each of the user's pinned vertices from its target, in texture coordinates. The distance is 0 if
    /// the vertex is at its target in the plane, whatever the conversion rounds.
    pub fn pin_errors(&self) -> impl Iterator<Item = (VertexId, &Target, f64)> {
        let (embedding, frame) = (&self.step.candidate.solution.embedding, self.problem.frame);
        self.targets_in_use().map(move |(&vertex, target)| {
            let z = embedding[vertex];
            let is_met = z == frame.plane_from_uv(target.uv);
            let error = if is_met { 0.0 } else { frame.uv_from_plane(z).distance(target.uv) };
            (vertex, target, error)
        })
    }

    /// True if the user's pins place the embedding.
    pub fn is_held(&self) -> bool {
        self.targets_in_use().next().is_some()
    }

    /// Targets of the user's pins. Empty if the method does not use pins.
    pub fn targets_in_use(&self) -> impl Iterator<Item = (&VertexId, &Target)> {
        self.problem.targets.iter().filter(|_| self.problem.settings.method.uses_pins())
    }

    /// Vertices with hard pins.
    pub fn held(&self) -> Vec<VertexId> {
        let settings = &self.problem.settings;
        self.targets_in_use().filter(|(_, target)| settings.is_hard(target.kind)).map(|(&vertex, _)| vertex).collect()
    }
}

/// Coordinates with v up, as files have them. `None` if v runs up already. The flip rounds.
pub fn upright(coordinates: &Embedding, v_axis: VAxis) -> Option<Embedding> {
    let turned = || coordinates.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
    (v_axis == VAxis::Down).then(turned)
}

/// Summary of the user's pins. `coordinates` holds the exact target of a hard pin, whatever was solved. So the error
/// of a hard pin also counts the position that the solver found.
pub fn pins_summary(outcome: &Outcome, coordinates: &Embedding) -> PinsSummary {
    let settings = &outcome.problem.settings;
    let (mut max_hard_error, mut max_soft_error) = (None::<f64>, None::<f64>);
    let (mut soft, mut unmet) = (Vec::new(), Vec::new());
    let targets = &outcome.problem.targets;
    for (&vertex, target) in targets.iter().filter(|_| settings.method.uses_pins()) {
        let written = coordinates[vertex.index()].distance(target.uv);
        let (largest, error) = match settings.kind_of(target.kind) {
            PinKind::Soft(weight) => {
                soft.push(SoftPinSummary { vertex, weight, error: written });
                (&mut max_soft_error, written)
            }
            PinKind::Fixed | PinKind::Hard => {
                let error = written.max(solver_error(outcome, vertex, target.uv));
                if error != 0.0 {
                    unmet.push(vertex);
                }
                (&mut max_hard_error, error)
            }
        };
        *largest = Some(largest.unwrap_or(0.0).max(error));
    }
    let treatment = match settings.treatment_on(&outcome.step.candidate.stage, targets.len()) {
        Treatment::Eliminate if outcome.step.candidate.solution.linear.is_some_and(|solved| solved.keeps_equations) => {
            Treatment::LeastSquares
        }
        usual => usual,
    };
    PinsSummary {
        treatment,
        count: targets.len(),
        max_error: max_hard_error.unwrap_or(0.0).max(max_soft_error.unwrap_or(0.0)),
        max_hard_error,
        max_soft_error,
        unmet,
        soft,
    }
}

/// Distance of a pinned vertex from its target in the solver's embedding, in texture coordinates. Compared in the
/// plane: the distance is 0 only if the solver met the target to the last bit.
fn solver_error(outcome: &Outcome, vertex: VertexId, target: DVec2) -> f64 {
    let frame = outcome.problem.frame;
    let off = outcome.step.candidate.solution.embedding[vertex] - frame.plane_from_uv(target);
    // The frame has no offset: it maps differences to differences.
    frame.uv_from_plane(off).length()
}
