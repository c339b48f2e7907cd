//! Figures 5 and 6: embeddings of figure 4 repaired by the iteration and by the virtual boundary.

use std::sync::Arc;

use super::free::FreeEmbedding;
use super::pairs::{TOP_AND_BOUNDARY, settings};
use super::{Figure, flips_in_words, iterations_in_words};
use freebound_core::bijective::VirtualBoundary;
use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::double_area;
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::problem::{Control, Method, Settings, SolveError};
use freebound_io::figure::{Drawing, OutsideShade, PlaneDrawing, Pockets, Window, zones_of};

/// Inputs of figures 5 and 6, with their letters in figure 4.
const INPUTS: [(char, FreeEmbedding); 2] = [
    ('a', FreeEmbedding { pair: TOP_AND_BOUNDARY, weights: 0 }),
    ('b', FreeEmbedding { pair: TOP_AND_BOUNDARY, weights: 1 }),
];

/// Embedding, its repair, and the flipped faces that the zooms show.
struct Repair<'a> {
    mesh: &'a Arc<DiskMesh>,
    input: Step,
    output: Step,
    zone: Vec<FaceId>,
}

impl<'a> Repair<'a> {
    /// Repairs an embedding of the cube by a method that continues from it.
    fn of(
        free: FreeEmbedding,
        method: Method,
        mesh: &'a Arc<DiskMesh>,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let input = free.solve(mesh, control)?;
        let settings = Settings { method, ..settings(free.weights) };
        let mut run = Flattener::new(settings, free.pins(mesh)).after(&input);
        let mut output = input.clone();
        run.finish(mesh, control, |step| output = step)?;
        let zones = zones_of(mesh, &input.candidate.solution.embedding, &input.verdict.flipped_faces);
        let zone = zones.into_iter().next().unwrap_or_default();
        Ok(Self { mesh, input, output, zone })
    }

    /// Input, with a frame around the zoomed region.
    fn whole(&self) -> PlaneDrawing {
        let framed = Window::on_faces(self.mesh, &self.input.candidate.solution.embedding, &self.zone);
        PlaneDrawing { framed: Some(framed), ..PlaneDrawing::of_step(self.mesh, &self.input) }
    }

    /// Adds a panel with the input.
    fn show_input(&self, figure: &mut Figure, letter: char) {
        let words = format!("input, figure 4 ({letter}): {}", flips_in_words(&self.input));
        figure.panel(&words, Drawing::Plane(self.whole())).measure(&self.input);
    }

    /// Adds a panel with the flipped faces in the input.
    fn show_flips(&self, figure: &mut Figure) {
        let all = self.input.verdict.flipped_faces.len();
        let count = if self.zone.len() == all { String::new() } else { format!(" ({} of the {all})", self.zone.len()) };
        self.show_zoom(figure, &format!("the flipped faces of the input{count}"), &self.input);
    }

    /// Adds a panel with the zoomed region in the input or the output.
    fn show_zoom(&self, figure: &mut Figure, words: &str, step: &Step) {
        let with_all_repairs = if step.verdict.planar { self.input.verdict.flipped_faces.clone() } else { Vec::new() };
        let window = Window::on_faces(self.mesh, &step.candidate.solution.embedding, &self.zone);
        let drawing = PlaneDrawing { with_all_repairs, window: Some(window), ..PlaneDrawing::of_step(self.mesh, step) };
        figure.panel(words, Drawing::Plane(drawing)).measure(step);
    }
}

/// Draws the steps of the iteration.
pub(super) fn figure_5(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 5. The iterative method: (a), (d) the input, taken from figure 4 (a) and (b); (b), (e) the \
                   repaired region; (c), (f) the same region before, not planar. Faces that were flipped are red before \
                   and yellow after. Squares are pinned vertices.";
    let mut figure = Figure::new(5, 3, caption);
    for (letter, free) in INPUTS {
        let repair = Repair::of(free, Method::Iterate, mesh, control)?;
        repair.show_input(&mut figure, letter);
        let iterations = iterations_in_words(repair.output.index - repair.input.index);
        repair.show_zoom(&mut figure, &format!("the same faces after {iterations}"), &repair.output);
        repair.show_flips(&mut figure);
    }
    Ok(figure)
}

/// Draws the steps of the virtual boundary method.
pub(super) fn figure_6(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 6. The virtual boundary method: (a) the input, taken from figure 4 (b); (b) its convex hull \
                   (red) and the pockets between (green); (c) the largest pocket, triangulated; (d) the result; (e) the flipped \
                   faces of the input; (f) the same faces in the planar output, yellow.";
    let mut figure = Figure::new(6, 3, caption);
    let (letter, free) = INPUTS[1];
    let repair = Repair::of(free, Method::VirtualBoundary, mesh, control)?;
    repair.show_input(&mut figure, letter);
    if let Some(stages) = repair.output.candidate.virtual_boundary.as_deref() {
        let with = |style| with_outside(PlaneDrawing::of_step(mesh, &repair.input), stages, style);
        let pocket = largest_pocket(stages);
        let window = Some(Window::on_triangles(&stages.before, &pocket));
        let whole = Drawing::Plane(PlaneDrawing { framed: window, ..with(Pockets::Filled) });
        figure.panel("the convex hull and the pockets", whole).measure(&repair.input);
        let words = format!("a pocket in {} triangles", pocket.len());
        let near = Drawing::Plane(PlaneDrawing { window, ..with(Pockets::Triangulated) });
        figure.panel(&words, near).measure(&repair.input);
    }
    let result = Drawing::Plane(PlaneDrawing::of_step(mesh, &repair.output));
    figure.panel("the result", result).measure(&repair.output);
    repair.show_flips(&mut figure);
    repair.show_zoom(&mut figure, "the same faces in the result", &repair.output);
    Ok(figure)
}

/// Pocket with the largest area. Triangles belong to one pocket if they are connected by corners.
fn largest_pocket(stages: &VirtualBoundary) -> Vec<[VertexId; 3]> {
    let mut groups: Vec<Vec<[VertexId; 3]>> = Vec::new();
    for &triangle in &stages.pockets {
        let touches = |group: &Vec<[VertexId; 3]>| group.iter().flatten().any(|v| triangle.contains(v));
        let (near, mut far): (Vec<_>, Vec<_>) = groups.into_iter().partition(touches);
        let mut joined: Vec<[VertexId; 3]> = near.into_iter().flatten().collect();
        joined.push(triangle);
        far.push(joined);
        groups = far;
    }
    let area = |group: &Vec<[VertexId; 3]>| -> f64 {
        group.iter().map(|t| double_area(t.map(|v| stages.before[v.index()]))).sum()
    };
    groups.into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or_default()
}

/// Adds the hull and the pockets to a drawing.
fn with_outside(drawing: PlaneDrawing, stages: &VirtualBoundary, style: Pockets) -> PlaneDrawing {
    let outside = OutsideShade { hull: stages.hull.clone(), pockets: stages.pockets.clone(), style };
    PlaneDrawing { embedding: stages.before.clone(), outside: Some(outside), ..drawing }
}
