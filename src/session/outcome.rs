//! A step with its proof: what the screen shows and what files say. And the problem that it solves.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::Model;
use crate::geom::{PictureFrame, VAxis};
use crate::io::{
    LayoutError, Materials, MeshReport, Output, OutputChart, OutputFit, PinsReport, Placement, Report, Seconds,
    ShapeReport, StepReport, Target, Targets, WeightedPinReport, pins_in_plane, verdict_as_in_file,
};
use crate::mesh::{DiskMesh, VertexId};
use crate::solver::{
    Candidate, Distortion, Embedding, GaugeSize, Hold, Ladder, Pins, Settings, Sheet, Start, Step, Treatment, Verdict,
    are_held_alike, distortion, to_unit_box, to_unit_square, to_unit_square_by_power_of_two, true_area_factor, verdict,
};

/// What a run is to solve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// Method and weights.
    pub settings: Settings,
    /// How texture coordinates lie in the plane of the embedding.
    pub frame: PictureFrame,
    /// The targets of the user's pins.
    pub targets: Targets,
}

impl Problem {
    /// The pins in the plane.
    pub fn pins(&self) -> Pins {
        pins_in_plane(&self.targets, self.frame)
    }

    /// The steps that solve it on a mesh or chart, from the layout of its file on where that is wanted.
    ///
    /// # Errors
    ///
    /// [`LayoutError`] where it is wanted and is not there.
    pub fn ladder_on(&self, model: &Model) -> Result<Ladder, LayoutError> {
        Ok(match self.settings.start {
            Start::File => self.ladder().starting_from(Arc::new(self.in_plane(&model.layout()?))),
            Start::Afresh => self.ladder(),
        })
    }

    /// The layout of a file, where v runs up, in the plane.
    fn in_plane(&self, layout: &Embedding) -> Embedding {
        let upright = upright(layout, self.frame.v_axis);
        upright.as_ref().unwrap_or(layout).iter().map(|&uv| self.frame.plane_from_uv(uv)).collect()
    }

    /// The steps that solve it, each proved in the numbers that are written of it.
    pub fn ladder(&self) -> Ladder {
        Ladder::new(self.settings, self.pins()).written_on(self.sheet())
    }

    /// How embeddings are written.
    pub(super) fn sheet(&self) -> Sheet {
        let is_exact = |target: &Target| self.settings.is_exact(target.hold);
        let exact = self.targets.iter().filter(|(_, target)| is_exact(target));
        Sheet::new(self.frame, exact.map(|(&vertex, target)| (vertex, target.uv)).collect())
    }

    /// Whether another problem differs in its targets alone: the same vertices, held in the same way.
    pub(super) fn differs_in_targets_alone(&self, other: &Self) -> bool {
        let is_alike = self.settings.amounts_to(&other.settings) && self.frame == other.frame;
        is_alike && are_held_alike(&self.pins(), &other.pins())
    }

    /// Whether another problem is solved by the same steps. A convex boundary takes no pins.
    pub(super) fn has_steps_of(&self, other: &Self) -> bool {
        let has_targets = !self.settings.method.uses_pins() || self.targets == other.targets;
        has_targets && self.settings == other.settings && self.frame == other.frame
    }
}

/// A step of a run with everything the screen and files show of it.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was asked for.
    pub problem: Problem,
    /// The embedding, its verdict and its numbers.
    pub step: Step,
    /// How faces are distorted.
    pub distortion: Distortion,
}

impl Outcome {
    /// Measures the distortion of a step on `mesh`, the mesh as given.
    pub fn new(mesh: &DiskMesh, problem: Problem, step: Step) -> Self {
        let distortion = distortion(step.mesh(mesh), &step.solution.embedding);
        Self { problem, step, distortion }
    }

    /// Bytes of memory that it takes. The factors of a linear solve are kept once, for the next solve, and a mesh with
    /// new vertices once for all steps on it: both are left out.
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

    /// How many vertices its mesh has beyond those of the mesh as given.
    pub fn new_vertex_count(&self) -> usize {
        self.step.refinement.as_ref().map_or(0, |refinement| refinement.new_vertices_of_surface().count())
    }

    /// The texture coordinates that go into a file, where they lie, and the verdict on them, which is that on the mesh
    /// of the step. The user's pins keep their places, exact ones that are met to the last bit; without any, `fit`
    /// decides the size. `mesh` is the mesh as given.
    ///
    /// Moving to the unit square rounds. Where that breaks what was planar, or held in 32 bits, the scale is a power of two, so that less
    /// is rounded, and then nothing is moved, so that nothing is.
    pub fn output(&self, mesh: &DiskMesh, fit: OutputFit) -> (Embedding, Placement, Verdict) {
        type Way = (fn(&mut Embedding), Placement);
        let (embedding, mesh) = (&self.step.solution.embedding, self.step.mesh(mesh));
        if self.targets_in_use().next().is_some() {
            return self.as_it_lies(mesh, Placement::Pins);
        }
        if self.step.lies_as_given && fit == OutputFit::Unit {
            return self.as_it_lies(mesh, Placement::File);
        }
        if self.problem.settings.size != GaugeSize::TrueArea {
            return self.as_it_lies(mesh, Placement::Picture);
        }
        if fit == OutputFit::True {
            return self.at_true_size(mesh);
        }
        let placed = |place: fn(&mut Embedding), name| {
            let mut coordinates = embedding.clone();
            place(&mut coordinates);
            let verdict = verdict(mesh, &coordinates);
            (coordinates, name, verdict)
        };
        // As much as is proved where it lies: the last way rounds nothing, neither in 64 bits nor in 32.
        let holds = |verdict: &Verdict| {
            let Verdict { planar, holds_in_f32, .. } = self.step.verdict;
            (verdict.planar || !planar) && (verdict.holds_in_f32 || !holds_in_f32)
        };
        let first = placed(to_unit_square, Placement::Unit);
        if holds(&first.2) {
            return first;
        }
        let others: [Way; 2] = [(to_unit_square_by_power_of_two, Placement::Unit), (to_unit_box, Placement::Unmoved)];
        let rescued = others.into_iter().map(|(place, name)| placed(place, name)).find(|found| holds(&found.2));
        rescued.unwrap_or(first)
    }

    /// The embedding as large as the surface in its file, and the verdict on it. `mesh` is the step's own.
    fn at_true_size(&self, mesh: &DiskMesh) -> (Embedding, Placement, Verdict) {
        let embedding = &self.step.solution.embedding;
        let unit = mesh.unit() * if self.step.lies_as_given { true_area_factor(mesh, embedding) } else { 1.0 };
        if unit.to_bits() == 1.0_f64.to_bits() {
            return (embedding.clone(), Placement::True, self.step.verdict.clone());
        }
        let coordinates: Embedding = embedding.iter().map(|&z| z * unit).collect();
        let verdict = verdict(mesh, &coordinates);
        (coordinates, Placement::True, verdict)
    }

    /// The texture coordinates of the embedding where it lies, the user's pins on their own numbers, and the verdict on
    /// them in the plane. `mesh` is the step's own.
    fn as_it_lies(&self, mesh: &DiskMesh, placement: Placement) -> (Embedding, Placement, Verdict) {
        let embedding = &self.step.solution.embedding;
        let mut coordinates: Embedding = embedding.iter().map(|&z| self.problem.frame.uv_from_plane(z)).collect();
        let settings = &self.problem.settings;
        for (vertex, target, error) in self.pin_errors().filter(|(_, target, _)| settings.is_exact(target.hold)) {
            // A step on the way to the constraints has not met them yet.
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

    /// Distance of each of the user's pinned vertices from its target, in texture coordinates; 0 for exact ones, whose
    /// numbers are those given.
    pub fn pin_errors(&self) -> impl Iterator<Item = (VertexId, &Target, f64)> {
        let (embedding, frame) = (&self.step.solution.embedding, self.problem.frame);
        self.targets_in_use().map(move |(&vertex, target)| {
            let z = embedding[vertex];
            let is_met = z == frame.plane_from_uv(target.uv);
            let error = if is_met { 0.0 } else { frame.uv_from_plane(z).distance(target.uv) };
            (vertex, target, error)
        })
    }

    /// Whether pins of the user's hold the embedding where it lies.
    pub fn is_held(&self) -> bool {
        self.targets_in_use().next().is_some()
    }

    /// The targets of the user's pins, where the method takes any.
    pub(super) fn targets_in_use(&self) -> impl Iterator<Item = (&VertexId, &Target)> {
        self.problem.targets.iter().filter(|_| self.problem.settings.method.uses_pins())
    }

    /// Vertices that pins hold exactly.
    pub(super) fn held(&self) -> Vec<VertexId> {
        let settings = &self.problem.settings;
        self.targets_in_use().filter(|(_, target)| settings.is_exact(target.hold)).map(|(&vertex, _)| vertex).collect()
    }

    /// Takes the embedding to its final size, and proves and measures it there. `model` is the mesh as it was opened.
    ///
    /// # Panics
    ///
    /// If the outcome is of another mesh, and the model no disk.
    pub fn finished<'a>(&'a self, model: &'a Model, steps: Vec<StepReport>, fit: OutputFit) -> Output<'a> {
        let start = Instant::now();
        let given = model.disk().expect("only a disk has an outcome");
        let (Problem { settings, frame, .. }, step) = (&self.problem, &self.step);
        let (coordinates, placement, of_coordinates) = self.output(given, fit);
        let mesh = step.mesh(given);
        let is_on_picture = matches!(placement, Placement::Pins | Placement::Picture | Placement::File);
        let is_as_solved = is_on_picture || coordinates == step.solution.embedding;
        let summary = if is_as_solved { self.distortion.summary } else { distortion(mesh, &coordinates).summary };
        let pins = pins_report(self, &coordinates);
        let (coordinates, verdict) = match upright(&coordinates, frame.v_axis).filter(|_| is_on_picture) {
            Some(upright) => {
                let of_file = verdict(mesh, &upright);
                (upright, of_file)
            }
            None => (coordinates, of_coordinates),
        };
        let solve = steps.iter().map(|step| step.seconds).sum();
        let verify = step.verify_seconds + start.elapsed().as_secs_f64();
        let repairs = model.repaired.as_ref().map(|repaired| repaired.done().to_vec()).unwrap_or_default();
        let report = Report {
            method: Some(settings.method),
            family: settings.method.uses_family().then_some(settings.family()),
            start: model.start_words(settings),
            pins: Some(pins),
            boundary: Some(if step.has_convex_boundary() { "convex" } else { "free" }),
            shape: ShapeReport::of(settings),
            placement: Some(placement),
            steps,
            verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
            distortion: Some(summary),
            new_vertices: self.new_vertex_count(),
            split_edges: step.refinement.as_ref().map(|r| r.split_edges_of_surface()).unwrap_or_default(),
            cut_polygons: step.refinement.as_ref().map(|r| r.cut_polygons(given)).unwrap_or_default(),
            seconds: Seconds { solve, verify, total: solve + verify, ..Seconds::default() },
            ..Report::of_mesh(MeshReport { repairs, ..MeshReport::new(model.path_words(), given) })
        };
        Output {
            source: &model.source,
            source_path: model.path.as_deref(),
            materials: Materials::default(),
            repaired: model.repaired.as_deref(),
            charts: vec![OutputChart {
                mesh,
                refinement: step.refinement.as_deref(),
                vertex_of: None,
                coordinates,
                verdict,
                held: self.held(),
            }],
            report,
            picture: None,
            aspect: if is_on_picture { frame.aspect } else { 1.0 },
            svg_fit: fit,
        }
    }
}

/// The coordinates as files have them, where v runs down in the document: there it runs up, which rounds.
pub(super) fn upright(coordinates: &Embedding, v_axis: VAxis) -> Option<Embedding> {
    let turned = || coordinates.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
    (v_axis == VAxis::Down).then(turned)
}

/// What became of the user's pins. Those that are to be met exactly have their own numbers in `coordinates`, whatever
/// was solved: for them the solver's places count too.
pub(super) fn pins_report(outcome: &Outcome, coordinates: &Embedding) -> PinsReport {
    let settings = &outcome.problem.settings;
    let (mut max_hard_error, mut max_weighted_error) = (None::<f64>, None::<f64>);
    let (mut weighted, mut unmet) = (Vec::new(), Vec::new());
    let targets = &outcome.problem.targets;
    for (&vertex, target) in targets.iter().filter(|_| settings.method.uses_pins()) {
        let written = coordinates[vertex.index()].distance(target.uv);
        let (largest, error) = match settings.hold_of(target.hold) {
            Hold::Weighted(weight) => {
                weighted.push(WeightedPinReport { vertex, weight, error: written });
                (&mut max_weighted_error, written)
            }
            Hold::Fixed | Hold::Hard => {
                let error = written.max(solver_error(outcome, vertex, target.uv));
                if error != 0.0 {
                    unmet.push(vertex);
                }
                (&mut max_hard_error, error)
            }
        };
        *largest = Some(largest.unwrap_or(0.0).max(error));
    }
    let treatment = match settings.treatment_on(outcome.step.rung, targets.len()) {
        Treatment::Eliminate if outcome.step.solution.linear.is_some_and(|solved| solved.keeps_equations) => {
            Treatment::LeastSquares
        }
        usual => usual,
    };
    PinsReport {
        treatment,
        count: targets.len(),
        max_error: max_hard_error.unwrap_or(0.0).max(max_weighted_error.unwrap_or(0.0)),
        max_hard_error,
        max_weighted_error,
        unmet,
        weighted,
    }
}

/// Distance of a pinned vertex from its target as solved for, in texture coordinates. Compared in the plane, so that it
/// is 0 where the solver met the target to the last bit, and only there.
fn solver_error(outcome: &Outcome, vertex: VertexId, target: DVec2) -> f64 {
    let frame = outcome.problem.frame;
    let off = outcome.step.solution.embedding[vertex] - frame.plane_from_uv(target);
    // The frame has no offset: it takes differences to differences.
    frame.uv_from_plane(off).length()
}
