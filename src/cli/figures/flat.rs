//! Figure 1: what a convex boundary makes of a flat mesh.

use std::sync::Arc;

use glam::DVec3;

use super::{Figure, Numbers, Row};
use crate::io::figure::{Panel, PlaneDrawing, Sheet};
use crate::mesh::DiskMesh;
use crate::solver::{BoundaryShape, Control, Embedding, Family, Ladder, Method, Pins, Settings, SolveError, verdict};

/// A flat mesh, and its embedding by Tutte's method. The paper's panel (c), the padding of Lee et al., is not made yet.
pub(super) fn figure_1(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let input: Embedding = mesh.mesh().positions.iter().copied().map(DVec3::truncate).collect();
    let of_input = verdict(mesh, &input);
    let settings = Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform);
    let step = Ladder::new(settings, Pins::new()).step(mesh, control)?;
    let input_numbers = Numbers {
        flips: of_input.flipped_faces.len(),
        crossings: of_input.crossing_count(),
        turning_number: of_input.turning_number,
        steps: 0,
    };
    let tutte = PlaneDrawing {
        flipped: step.verdict.flipped_faces.clone(),
        ..PlaneDrawing::new(mesh, step.solution.embedding.clone())
    };
    let panels = vec![
        Panel::plane(vec!["(a) the flat mesh".to_owned()], PlaneDrawing::new(mesh, input)),
        Panel::plane(vec!["(b) Tutte: convex boundary, uniform weights".to_owned()], tutte),
    ];
    let rows = vec![
        Row { panel: 'a', shows: "flat mesh".to_owned(), numbers: Some(input_numbers) },
        Row { panel: 'b', shows: "Tutte".to_owned(), numbers: Some(Numbers::of(&step)) },
    ];
    let caption =
        "Figure 1. Embedding of a flat mesh. A convex boundary distorts what needed no distortion at all: the \
                   mesh itself, (a), is a planar embedding."
            .to_owned();
    Ok(Figure { number: 1, sheet: Sheet { columns: 2, panels, caption }, rows })
}
