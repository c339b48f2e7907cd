//! Figures 3 and 4: the cube with one boundary, and its free-boundary embeddings.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::pairs::{PAIRS, PinPair, WEIGHTS, settings};
use super::{Figure, Numbers, Row};
use crate::io::figure::{Panel, PlaneDrawing, Sheet, SpaceDrawing, Window, zones_of};
use crate::io::raster::View;
use crate::mesh::DiskMesh;
use crate::solver::{Control, Ladder, Pins, SolveError, Step, fixed_pins};

/// Insets that a panel has room for.
const INSETS: usize = 2;

/// Where the cube is seen from: from above, and from below into its opening.
const VIEWS: [View; 2] =
    [View { eye: DVec3::new(0.75, 0.65, 1.3), up: DVec3::Y }, View { eye: DVec3::new(0.75, -0.75, 1.3), up: DVec3::Y }];

/// The cube from two sides.
pub(super) fn figure_3(mesh: &Arc<DiskMesh>) -> Figure {
    let words = ["(a) from above", "(b) from below, into the opening"];
    let panel = |(view, words): (View, &str)| {
        Panel::space(vec![words.to_owned()], SpaceDrawing { mesh: Arc::clone(mesh), view })
    };
    let panels = VIEWS.into_iter().zip(words).map(panel).collect();
    let rows = ('a'..)
        .zip(words)
        .map(|(panel, words)| Row { panel, shows: format!("cube {}", &words[4..]).replace(',', ""), numbers: None })
        .collect();
    let caption = format!(
        "Figure 3. A cube with one boundary, drawn thick: {} vertices, {} faces, {} vertices on the boundary.",
        mesh.vertex_count(),
        mesh.face_count(),
        mesh.boundary_loop().len()
    );
    Figure { number: 3, sheet: Sheet { columns: 2, panels, caption }, rows }
}

/// The free-boundary embedding of the cube with one of the weights and a pair of vertices pinned at their distance.
pub(super) fn embedding(
    mesh: &DiskMesh,
    (pair, weights): (&PinPair, usize),
    control: Control<'_>,
) -> Result<Step, SolveError> {
    Ladder::new(settings(weights), pins_of(mesh, pair)).step(mesh, control)
}

/// A pair of vertices on the x-axis, as far apart as in space.
pub(super) fn pins_of(mesh: &DiskMesh, pair: &PinPair) -> Pins {
    let [a, b] = pair.vertices;
    let distance = mesh.position(a).distance(mesh.position(b));
    fixed_pins([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))])
}

/// An embedding with its flipped faces and pins.
pub(super) fn drawing_of(mesh: &Arc<DiskMesh>, step: &Step) -> PlaneDrawing {
    PlaneDrawing {
        flipped: step.verdict.flipped_faces.clone(),
        pins: step.solution.pins.keys().copied().collect(),
        ..PlaneDrawing::new(mesh, step.solution.embedding.clone())
    }
}

/// How many faces are flipped, in words.
pub(super) fn flips_in_words(step: &Step) -> String {
    match step.verdict.flipped_faces.len() {
        0 => "no flipped face".to_owned(),
        1 => "1 flipped face".to_owned(),
        count => format!("{count} flipped faces"),
    }
}

/// Three weights, two pairs of pinned vertices.
pub(super) fn figure_4(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    let cells = PAIRS.iter().flat_map(|pair| (0..WEIGHTS.len()).map(move |weights| (pair, weights)));
    for (letter, (pair, weights)) in ('a'..).zip(cells) {
        let step = embedding(mesh, (pair, weights), control)?;
        let name = WEIGHTS[weights].0;
        let zones = zones_of(mesh, &step.solution.embedding, &step.verdict.flipped_faces);
        let window = |zone: &Vec<_>| Window::on_faces(mesh, &step.solution.embedding, zone);
        let insets = zones.iter().take(INSETS).map(window).collect();
        let words = vec![format!("({letter}) {name}: {}", flips_in_words(&step))];
        panels.push(Panel::plane(words, PlaneDrawing { insets, ..drawing_of(mesh, &step) }));
        let [a, b] = pair.vertices;
        let shows = format!("{name}; pins {a} and {b}");
        rows.push(Row { panel: letter, shows, numbers: Some(Numbers::of(&step)) });
    }
    let caption = "Figure 4. Free-boundary embeddings of the cube of figure 3 with mean-value weights (left), Lévy's \
                   weights (middle) and conformal weights (right). Red faces are flipped, so that the embedding is not \
                   planar; the small images magnify where they lie. Squares mark the two pinned vertices, another pair \
                   in each row."
        .to_owned();
    Ok(Figure { number: 4, sheet: Sheet { columns: 3, panels, caption }, rows })
}
