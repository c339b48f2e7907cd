//! Figures 5 and 6: embeddings of figure 4 repaired by the iteration and by the virtual boundary.

use std::sync::Arc;

use super::free::{drawing_of, embedding, flips_in_words, pins_of};
use super::pairs::{PinPair, TOP_AND_BOUNDARY, settings};
use super::{Figure, Numbers, Row};
use crate::io::figure::{Outside, Panel, PlaneDrawing, Pockets, Sheet, Window, zones_of};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::solver::{Control, Ladder, Method, Settings, SolveError, Step, VirtualBoundary};

/// What figures 5 and 6 begin with, by its letter in figure 4 and its place among the weights.
const INPUTS: [(char, usize); 2] = [('a', 0), ('b', 1)];

/// An embedding, its repair, and the flipped faces that zooms show.
struct Repair {
    input: Step,
    output: Step,
    zone: Vec<FaceId>,
}

impl Repair {
    /// Repairs an embedding of the cube by a method that goes on from it.
    fn by(
        method: Method,
        (mesh, pair, weights): (&DiskMesh, &PinPair, usize),
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let input = embedding(mesh, (pair, weights), control)?;
        let settings = Settings { method, ..settings(weights) };
        let mut run = Ladder::new(settings, pins_of(mesh, pair)).after(&input);
        let mut output = input.clone();
        run.finish(mesh, control, |step| output = step)?;
        let zones = zones_of(mesh, &input.solution.embedding, &input.verdict.flipped_faces);
        let zone = zones.into_iter().next().unwrap_or_default();
        Ok(Self { input, output, zone })
    }

    /// The input, with a frame around what the zooms show.
    fn whole(&self, mesh: &Arc<DiskMesh>) -> PlaneDrawing {
        let framed = Window::on_faces(mesh, &self.input.solution.embedding, &self.zone);
        PlaneDrawing { framed: Some(framed), ..drawing_of(mesh, &self.input) }
    }

    /// The faces that were flipped, in the input or in the output.
    fn zoom(&self, mesh: &Arc<DiskMesh>, step: &Step) -> PlaneDrawing {
        let mended = if step.verdict.planar { self.input.verdict.flipped_faces.clone() } else { Vec::new() };
        let window = Window::on_faces(mesh, &step.solution.embedding, &self.zone);
        PlaneDrawing { mended, window: Some(window), ..drawing_of(mesh, step) }
    }

    /// How many of the flipped faces the zooms show.
    fn shown_in_words(&self) -> String {
        let all = self.input.verdict.flipped_faces.len();
        if self.zone.len() == all { String::new() } else { format!(" ({} of the {all})", self.zone.len()) }
    }
}

/// Panels and lines of the table as they come.
#[derive(Default)]
struct Panels {
    panels: Vec<Panel>,
    rows: Vec<Row>,
}

impl Panels {
    fn push(&mut self, words: &str, drawing: PlaneDrawing, step: &Step) {
        let letter = ('a'..='z').nth(self.panels.len()).expect("a figure has few panels");
        self.panels.push(Panel::plane(vec![format!("({letter}) {words}")], drawing));
        let shows = words.replace(',', ";");
        self.rows.push(Row { panel: letter, shows, numbers: Some(Numbers::of(step)) });
    }

    fn figure(self, number: u32, caption: &str) -> Figure {
        let sheet = Sheet { columns: 3, panels: self.panels, caption: caption.to_owned() };
        Figure { number, sheet, rows: self.rows }
    }
}

/// The iteration.
pub(super) fn figure_5(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let mut panels = Panels::default();
    for (letter, weights) in INPUTS {
        let repair = Repair::by(Method::Iterate, (mesh, &TOP_AND_BOUNDARY, weights), control)?;
        let input = format!("input, figure 4 ({letter}): {}", flips_in_words(&repair.input));
        panels.push(&input, repair.whole(mesh), &repair.input);
        let count = repair.output.index - repair.input.index;
        let steps = if count == 1 { "iteration" } else { "iterations" };
        let after = format!("the same faces after {count} {steps}");
        panels.push(&after, repair.zoom(mesh, &repair.output), &repair.output);
        let before = format!("the flipped faces of the input{}", repair.shown_in_words());
        panels.push(&before, repair.zoom(mesh, &repair.input), &repair.input);
    }
    let caption = "Figure 5. The iterative method: (a), (d) the input, taken from figure 4 (a) and (b); (b), (e) the \
                   repaired region; (c), (f) the same region before, not planar. Faces that were flipped are red before \
                   and yellow after. Squares are pinned vertices.";
    Ok(panels.figure(5, caption))
}

/// The virtual boundary.
pub(super) fn figure_6(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let (letter, weights) = INPUTS[1];
    let repair = Repair::by(Method::VirtualBoundary, (mesh, &TOP_AND_BOUNDARY, weights), control)?;
    let mut panels = Panels::default();
    let input = format!("input, figure 4 ({letter}): {}", flips_in_words(&repair.input));
    panels.push(&input, repair.whole(mesh), &repair.input);
    if let Some(stages) = repair.output.virtual_boundary.as_deref() {
        let with = |style| with_outside(drawing_of(mesh, &repair.input), stages, style);
        let pocket = largest_pocket(stages);
        let window = Some(Window::on_triangles(&stages.before, &pocket));
        let whole = PlaneDrawing { framed: window, ..with(Pockets::Filled) };
        panels.push("the convex hull and the pockets", whole, &repair.input);
        let words = format!("a pocket in {} triangles", pocket.len());
        panels.push(&words, PlaneDrawing { window, ..with(Pockets::Triangulated) }, &repair.input);
    }
    panels.push("the result", drawing_of(mesh, &repair.output), &repair.output);
    let before = format!("the flipped faces of the input{}", repair.shown_in_words());
    panels.push(&before, repair.zoom(mesh, &repair.input), &repair.input);
    panels.push("the same faces in the result", repair.zoom(mesh, &repair.output), &repair.output);
    let caption = "Figure 6. The virtual boundary method: (a) the input, taken from figure 4 (b); (b) its convex hull \
                   (red) and the pockets between (green); (c) the largest pocket, triangulated; (d) the result; (e) the flipped \
                   faces of the input; (f) the same faces in the planar output, yellow.";
    Ok(panels.figure(6, caption))
}

/// The pocket of the largest area: triangles that hang together by their corners.
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
        let corners = group.iter().map(|t| t.map(|v| stages.before[v.index()]));
        corners.map(|[a, b, c]| (b - a).perp_dot(c - a)).sum()
    };
    groups.into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or_default()
}

/// An embedding with its hull and pockets.
fn with_outside(drawing: PlaneDrawing, stages: &VirtualBoundary, style: Pockets) -> PlaneDrawing {
    let outside = Outside { hull: stages.hull.clone(), pockets: stages.pockets.clone(), style };
    PlaneDrawing { places: stages.before.clone(), outside: Some(outside), ..drawing }
}
