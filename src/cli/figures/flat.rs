//! Figure 1: what a convex boundary makes of a flat mesh.

use std::sync::Arc;

use glam::DVec3;

use super::Figure;
use crate::io::figure::{Drawing, PlaneDrawing};
use crate::mesh::DiskMesh;
use crate::solver::{BoundaryShape, Control, Embedding, Family, Ladder, Method, Pins, Settings, SolveError, verdict};

/// A flat mesh, and its embedding by Tutte's method. The paper's panel (c), the padding of Lee et al., is not made yet.
pub(super) fn figure_1(mesh: &Arc<DiskMesh>, control: Control<'_>) -> Result<Figure, SolveError> {
    let caption = "Figure 1. Embedding of a flat mesh. A convex boundary distorts what needed no distortion at all: the \
                   mesh itself, (a), is a planar embedding.";
    let mut figure = Figure::new(1, 2, caption);
    let input: Embedding = mesh.mesh().positions.iter().copied().map(DVec3::truncate).collect();
    let of_input = verdict(mesh, &input);
    let flat = Drawing::Plane(PlaneDrawing::new(mesh, input));
    figure.panel("the flat mesh", flat).showing("flat mesh").measure_verdict(&of_input, 0);
    let settings = Settings::new(Method::Convex(BoundaryShape::Circle), Family::Uniform);
    let step = Ladder::new(settings, Pins::new()).step(mesh, control)?;
    let tutte = PlaneDrawing { pins: Vec::new(), ..PlaneDrawing::of_step(mesh, &step) };
    let words = "Tutte: convex boundary, uniform weights";
    figure.panel(words, Drawing::Plane(tutte)).showing("Tutte").measure(&step);
    Ok(figure)
}
