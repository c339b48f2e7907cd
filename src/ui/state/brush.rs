//! The brush of the brush tool: its kind, size and strength.

use freebound_core::bijective::{Brush, BrushKind};

/// Brush as the user chose it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushChoice {
    /// Kind of the brush.
    pub kind: BrushKind,
    /// Radius, points of the screen.
    pub radius: f32,
    /// Strength, 0 to 1.
    pub strength: f64,
}

impl Default for BrushChoice {
    fn default() -> Self {
        Self { kind: BrushKind::Relax, radius: 60.0, strength: 0.5 }
    }
}

impl BrushChoice {
    /// Radii that can be chosen, points.
    pub const RADII: std::ops::RangeInclusive<f32> = 8.0..=400.0;

    /// Factor between two radii of the keys and the wheel.
    const STEP: f32 = 1.15;

    /// Brush with a radius that is larger by some steps, or smaller.
    #[must_use]
    pub fn resized(self, steps: f32) -> Self {
        let radius = self.radius * Self::STEP.powf(steps);
        Self { radius: radius.clamp(*Self::RADII.start(), *Self::RADII.end()), ..self }
    }

    /// Brush in the plane, where a point of the screen has a size. `inverts` turns pinch and texels round.
    pub(in crate::ui) fn in_plane(self, point: f64, inverts: bool) -> Brush {
        let sign = if inverts && self.kind.has_inverse() { -1.0 } else { 1.0 };
        Brush { kind: self.kind, radius: f64::from(self.radius) * point, strength: sign * self.strength }
    }
}

/// Name of a kind, and its description for tooltips.
pub(in crate::ui) const fn brush_words(kind: BrushKind) -> [&'static str; 2] {
    match kind {
        BrushKind::Relax => ["Relax", "Lowers the distortion under the brush"],
        BrushKind::Grab => ["Grab", "Moves the piece under the brush with the pointer; its surroundings follow"],
        BrushKind::Pinch => ["Pinch", "Pulls vertices to the pointer; with Ctrl it pushes them away"],
        BrushKind::Smooth => ["Smooth", "Smooths the outline of the map under the brush"],
        BrushKind::Texels => ["Texels", "Gives faces more pixels of the picture; with Ctrl fewer"],
    }
}
