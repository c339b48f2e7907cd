//! Closed lines with round joins. The joins of egui's closed lines are mitred: at a sharp corner they are long spikes.

use eframe::egui::{Painter, Pos2, Stroke};

/// Least width of a line whose joins show, points.
const JOINS_FROM: f32 = 1.5;

/// Draws a closed line with round joins.
pub(in crate::ui) fn closed_line(painter: &Painter, points: &[Pos2], stroke: Stroke) {
    for (&from, &to) in points.iter().zip(points.iter().cycle().skip(1)) {
        painter.line_segment([from, to], stroke);
        if stroke.width >= JOINS_FROM {
            painter.circle_filled(from, stroke.width / 2.0, stroke.color);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{self, Color32, pos2};

    use super::*;

    /// Distance from a point to a segment.
    fn distance(p: Pos2, [a, b]: [Pos2; 2]) -> f32 {
        let t = ((p - a).dot(b - a) / (b - a).length_sq()).clamp(0.0, 1.0);
        p.distance(a + t * (b - a))
    }

    #[test]
    fn a_line_with_sharp_corners_has_no_spike_and_no_gap() {
        let zigzag = [pos2(50.0, 50.0), pos2(150.0, 52.0), pos2(52.0, 54.0), pos2(150.0, 56.0), pos2(50.0, 90.0)];
        let width = 6.0;
        let context = egui::Context::default();
        // The corners of a disc that is drawn as a picture lie off the disc.
        context.tessellation_options_mut(|options| options.prerasterized_discs = false);
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            closed_line(ui.painter(), &zigzag, Stroke::new(width, Color32::RED));
        });
        // Nothing is drawn on a screen.
        output.textures_delta.clear();
        let ends: Vec<[Pos2; 2]> = (0..zigzag.len()).map(|k| [zigzag[k], zigzag[(k + 1) % zigzag.len()]]).collect();
        let meshes = context.tessellate(output.shapes, 1.0);
        let vertices: Vec<Pos2> = meshes
            .iter()
            .filter_map(|clipped| match &clipped.primitive {
                egui::epaint::Primitive::Mesh(mesh) => Some(mesh),
                egui::epaint::Primitive::Callback(_) => None,
            })
            .flat_map(|mesh| mesh.vertices.iter().filter(|v| v.color.r() > 0).map(|v| v.pos))
            .collect();
        assert!(!vertices.is_empty());
        for &vertex in &vertices {
            let nearest = ends.iter().map(|&segment| distance(vertex, segment)).fold(f32::INFINITY, f32::min);
            assert!(nearest <= width / 2.0 + 1.0, "{vertex:?} is {nearest} points off the line");
        }
        // The outside of each corner is covered as far as the line is wide.
        for (k, &corner) in zigzag.iter().enumerate() {
            let [before, after] = [zigzag[(k + 4) % 5], zigzag[(k + 1) % 5]].map(|other| (corner - other).normalized());
            let tip = corner + (before + after).normalized() * (width / 2.0);
            let nearest = vertices.iter().map(|vertex| vertex.distance(tip)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 1.0, "{corner:?}: {nearest}");
        }
    }
}
