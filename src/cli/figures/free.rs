//! Figure 1: a flat mesh with a convex boundary. Figures 3 and 4: a cube with one boundary loop, and its free-boundary
//! embeddings.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::pairs::{PAIRS, PinPair, WEIGHTS, settings};
use super::{Figure, flips_in_words};
use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, SolveError, fixed_pins,
};
use freebound_core::verify::verdict;
use freebound_io::figure::{Drawing, OutsideShade, PlaneDrawing, Pockets, SpaceDrawing};
use freebound_io::raster::View;

/// Maximum number of insets in a panel.
const INSETS: usize = 2;

/// Views of the cube: from above, and from below into its opening.
const VIEWS: [(&str, View); 2] = [
    ("from above", View { eye: DVec3::new(0.75, 0.65, 1.3), up: DVec3::Y }),
    ("from below, into the opening", View { eye: DVec3::new(0.75, -0.75, 1.3), up: DVec3::Y }),
];

/// Draws a flat mesh, its embedding by Tutte's method, and its embedding with Lee's padding.
pub(super) fn figure_1(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 1. Embedding of a flat mesh. The mesh (a) is already a planar embedding, but a convex \
                   boundary (b) distorts it. Layers of virtual triangles (c, green) with the outermost ring on a \
                   circle leave the boundary some freedom and are removed afterwards. The mesh is still distorted.";
    let mut figure = Figure::new(1, 3, caption);
    let input: Embedding = mesh.mesh().positions.iter().copied().map(DVec3::truncate).collect();
    let of_input = verdict(mesh, &input);
    let flat = Drawing::Plane(PlaneDrawing::new(mesh, input));
    figure.panel("the flat mesh", flat).showing("flat mesh").measure_verdict(&of_input, 0);
    let settings = Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform);
    let step = Flattener::new(settings, Pins::new()).step(mesh, control)?;
    let tutte = PlaneDrawing { pins: Vec::new(), ..PlaneDrawing::of_step(mesh, &step) };
    let words = "Tutte: convex boundary, uniform weights";
    figure.panel(words, Drawing::Plane(tutte)).showing("Tutte").measure(&step);
    let settings = Settings::new(Method::Lee(BoundaryShape::Circle), Family::Uniform);
    let step = Flattener::new(settings.clone(), Pins::new()).step(mesh, control)?;
    let words = format!("Lee et al.: {} virtual layers, uniform weights", settings.layers);
    figure.panel(&words, Drawing::Plane(with_padding(mesh, &step))).showing("Lee et al.").measure(&step);
    Ok(figure)
}

/// Drawing of a step of Lee's method, with the virtual layers that were removed.
fn with_padding(mesh: &Arc<DiskMesh>, step: &Step) -> PlaneDrawing {
    let drawing = PlaneDrawing { pins: Vec::new(), ..PlaneDrawing::of_step(mesh, step) };
    let Some(padding) = step.candidate.outside.as_deref() else { return drawing };
    let embedding: Embedding = drawing.embedding.iter().chain(&padding.frame).copied().collect();
    let outermost = embedding.len() - mesh.boundary_loop().len()..embedding.len();
    let outside = OutsideShade {
        hull: outermost.map(VertexId::from_index).collect(),
        pockets: padding.triangles.clone(),
        style: Pockets::Triangulated,
    };
    PlaneDrawing { embedding, outside: Some(outside), ..drawing }
}

/// Draws the cube from two sides.
pub(super) fn figure_3(mesh: &Arc<DiskMesh>) -> Figure {
    let caption = format!(
        "Figure 3. A cube with one boundary, drawn thick: {} vertices, {} faces, {} vertices on the boundary.",
        mesh.vertex_count(),
        mesh.face_count(),
        mesh.boundary_loop().len()
    );
    let mut figure = Figure::new(3, 2, caption);
    for (words, view) in VIEWS {
        let drawing = Drawing::Space(SpaceDrawing { mesh: Arc::clone(mesh), view });
        figure.panel(words, drawing).showing(&format!("cube {}", words.replace(',', "")));
    }
    figure
}

/// Embedding of figure 4: a pair of vertices pinned at their distance, and the index of the weights in [`WEIGHTS`].
#[derive(Clone, Copy)]
pub(super) struct FreeEmbedding {
    pub(super) pair: PinPair,
    pub(super) weights: usize,
}

impl FreeEmbedding {
    /// Pins the pair on the x-axis, at its distance in space.
    pub(super) fn pins(self, mesh: &DiskMesh) -> Pins {
        let [a, b] = self.pair.vertices;
        let distance = mesh.position(a).distance(mesh.position(b));
        fixed_pins([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))])
    }

    pub(super) fn solve(self, mesh: &DiskMesh, control: Control<'_>) -> Result<Step, SolveError> {
        Flattener::new(settings(self.weights), self.pins(mesh)).step(mesh, control)
    }
}

/// Draws embeddings with three kinds of weights and two pairs of pinned vertices.
pub(super) fn figure_4(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 4. Free-boundary embeddings of the cube of figure 3 with mean-value weights (left), Lévy's \
                   weights (middle) and conformal weights (right). Red faces are flipped, so that the embedding is not \
                   planar; the small images magnify where they lie. Squares mark the two pinned vertices, another pair \
                   in each row.";
    let mut figure = Figure::new(4, 3, caption);
    for pair in PAIRS {
        for (weights, (name, ..)) in WEIGHTS.iter().enumerate() {
            let step = FreeEmbedding { pair, weights }.solve(mesh, control)?;
            let drawing = Drawing::Plane(PlaneDrawing::of_step(mesh, &step).with_insets(INSETS));
            let [a, b] = pair.vertices;
            let row = figure.panel(&format!("{name}: {}", flips_in_words(&step)), drawing);
            row.showing(&format!("{name}; pins {a} and {b}")).measure(&step);
        }
    }
    Ok(figure)
}
