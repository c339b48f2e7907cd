//! Small drawings for tools and verdicts.

use eframe::egui::{self, Color32, Pos2, Rect, Shape, Stroke};

use super::state::{GestureKind, Tool};
use super::theme::Theme;
use freebound_io::Direction;

/// Points given on a grid of 24 × 24.
fn on_grid(rect: Rect, points: &[(f32, f32)]) -> Vec<Pos2> {
    let scale = rect.width() / 24.0;
    points.iter().map(|&(x, y)| rect.min + egui::vec2(x, y) * scale).collect()
}

/// Draws the icon of a tool into a square. Icons: a mouse arrow, a drawing pin, a dot joined with a diamond, a path
/// with stitches, a brush.
pub(super) fn tool(painter: &egui::Painter, rect: Rect, tool: Tool, colour: Color32) {
    let stroke = Stroke::new(1.6, colour);
    let outline: &[(f32, f32)] = match tool {
        Tool::Select => {
            &[(8.0, 5.0), (8.0, 17.5), (11.2, 14.6), (13.4, 19.4), (15.4, 18.5), (13.2, 13.8), (17.4, 13.4)]
        }
        Tool::Fix => &[(9.0, 5.0), (15.0, 5.0), (14.2, 11.0), (16.6, 13.6), (7.4, 13.6), (9.8, 11.0)],
        Tool::Constrain => &[(16.5, 4.5), (20.0, 8.0), (16.5, 11.5), (13.0, 8.0)],
        Tool::Seam => &[],
        Tool::Brush => &[(10.5, 12.0), (13.5, 14.5), (11.0, 18.0), (6.0, 19.5), (7.5, 15.0)],
    };
    painter.add(Shape::closed_line(on_grid(rect, outline), stroke));
    let line: &[(f32, f32)] = match tool {
        Tool::Select => &[],
        Tool::Fix => &[(12.0, 13.6), (12.0, 19.5)],
        Tool::Constrain => &[(7.5, 16.5), (14.2, 10.0)],
        Tool::Seam => &[(5.0, 19.0), (9.0, 14.5), (15.0, 9.5), (19.0, 5.0)],
        Tool::Brush => &[(12.0, 13.2), (19.5, 4.5)],
    };
    let line = on_grid(rect, line);
    if tool == Tool::Constrain {
        painter.circle_filled(line[0], 2.8 * rect.width() / 24.0, colour);
    }
    painter.add(Shape::line(line, stroke));
    if tool == Tool::Seam {
        for stitch in [[(4.6, 14.2), (9.4, 19.4)], [(9.6, 9.4), (14.4, 14.6)], [(14.6, 4.6), (19.4, 9.8)]] {
            painter.add(Shape::line(on_grid(rect, &stitch), stroke));
        }
    }
}

/// Draws the icon of a move of charts into a square. Icons: a cross of arrows, a round arrow, an arrow between two
/// squares.
pub(super) fn gesture(painter: &egui::Painter, rect: Rect, kind: GestureKind, colour: Color32) {
    let stroke = Stroke::new(1.6, colour);
    let line = |points: &[(f32, f32)]| painter.add(Shape::line(on_grid(rect, points), stroke));
    match kind {
        GestureKind::Move => {
            line(&[(12.0, 4.0), (12.0, 20.0)]);
            line(&[(4.0, 12.0), (20.0, 12.0)]);
            for head in [
                [(9.5, 6.5), (12.0, 4.0), (14.5, 6.5)],
                [(9.5, 17.5), (12.0, 20.0), (14.5, 17.5)],
                [(6.5, 9.5), (4.0, 12.0), (6.5, 14.5)],
                [(17.5, 9.5), (20.0, 12.0), (17.5, 14.5)],
            ] {
                line(&head);
            }
        }
        GestureKind::Turn => {
            let point = |step: u8| {
                let angle = (f32::from(step) * 15.0 - 60.0).to_radians();
                (12.0 + 7.5 * angle.cos(), 12.0 + 7.5 * angle.sin())
            };
            line(&(0..=18).map(point).collect::<Vec<_>>());
            line(&[(15.0, 2.5), (15.75, 5.5), (19.0, 5.0)].map(|(x, y)| (x - 0.3, y)));
        }
        GestureKind::Scale => {
            line(&[(4.5, 11.0), (4.5, 19.5), (13.0, 19.5), (13.0, 11.0), (4.5, 11.0)]);
            line(&[(9.0, 4.5), (19.5, 4.5), (19.5, 15.0)]);
            line(&[(13.0, 11.0), (17.5, 6.5)]);
            line(&[(14.0, 6.5), (17.5, 6.5), (17.5, 10.0)]);
        }
    }
}

/// Draws the icon for packing into a square: charts that fill a page.
pub(super) fn pack(painter: &egui::Painter, rect: Rect, colour: Color32) {
    let stroke = Stroke::new(1.6, colour);
    for [left, top, right, bottom] in [[4.5, 4.5, 12.5, 10.5], [4.5, 13.5, 12.5, 19.5], [15.5, 4.5, 19.5, 19.5]] {
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        painter.add(Shape::closed_line(on_grid(rect, &corners), stroke));
    }
}

/// Sign of a verdict. Good, bad and doubtful signs differ in shape, so that colour is never the only difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    /// A check mark.
    Good,
    /// A cross.
    Bad,
    /// Triangle with a stroke: something is not up to date, or may be unintended.
    Warning,
    /// Triangle with a stroke in another colour: a planar embedding misses constraints.
    Unmet,
    /// A ring of dots.
    Working,
    /// Arrow: the embedding glides to another step.
    Moving,
}

impl Sign {
    /// Colour of the sign and of the words beside it.
    pub(super) fn colour(self, theme: &Theme) -> Color32 {
        match self {
            Self::Good => theme.planar,
            Self::Bad => theme.flipped,
            Self::Warning => theme.stale,
            Self::Unmet => theme.unmet,
            Self::Working | Self::Moving => theme.weak_text,
        }
    }
}

/// Arrow head of a sorted column: up for ascending numbers, down for descending ones.
pub(super) fn order(painter: &egui::Painter, rect: Rect, direction: Direction, colour: Color32) {
    let points = match direction {
        Direction::Up => [(3.0, 18.0), (21.0, 18.0), (12.0, 5.0)],
        Direction::Down => [(3.0, 6.0), (21.0, 6.0), (12.0, 19.0)],
    };
    painter.add(Shape::convex_polygon(on_grid(rect, &points), colour, Stroke::NONE));
}

/// Padlock, closed or open.
pub(super) fn lock(painter: &egui::Painter, rect: Rect, is_closed: bool, colour: Color32) {
    let body = on_grid(rect, &[(5.0, 11.0), (19.0, 11.0), (19.0, 21.0), (5.0, 21.0)]);
    let fill = if is_closed { colour } else { Color32::TRANSPARENT };
    painter.add(Shape::convex_polygon(body, fill, Stroke::new(1.4, colour)));
    let shackle: &[(f32, f32)] = if is_closed {
        &[(8.0, 11.0), (8.0, 7.0), (10.0, 4.0), (14.0, 4.0), (16.0, 7.0), (16.0, 11.0)]
    } else {
        &[(8.0, 11.0), (8.0, 5.0), (10.0, 2.0), (14.0, 2.0), (16.0, 5.0), (16.0, 7.0)]
    };
    painter.add(Shape::line(on_grid(rect, shackle), Stroke::new(1.4, colour)));
}

/// Check mark.
pub(super) fn check(painter: &egui::Painter, rect: Rect, colour: Color32) {
    let points = on_grid(rect, &[(4.0, 13.0), (10.0, 19.0), (20.0, 5.0)]);
    painter.add(Shape::line(points, Stroke::new(1.8, colour)));
}

/// Sign of an entry of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileSign {
    Folder,
    /// A tetrahedron.
    Mesh,
    /// A mountain under the sun, in a frame.
    Picture,
    /// A sheet with the program's triangle.
    Project,
    /// A sheet with a folded corner.
    Other,
}

/// Draws the sign of an entry of a folder.
pub(super) fn file(painter: &egui::Painter, rect: Rect, sign: FileSign, colour: Color32) {
    let stroke = Stroke::new(1.3, colour);
    let closed = |points: &[(f32, f32)]| painter.add(Shape::closed_line(on_grid(rect, points), stroke));
    let line = |points: &[(f32, f32)]| painter.add(Shape::line(on_grid(rect, points), stroke));
    match sign {
        FileSign::Folder => {
            let outline = [(2.0, 5.0), (9.0, 5.0), (11.5, 8.0), (22.0, 8.0), (22.0, 20.0), (2.0, 20.0)];
            let fill = colour.gamma_multiply(0.35);
            painter.add(Shape::convex_polygon(
                on_grid(rect, &[(2.0, 8.0), (22.0, 8.0), (22.0, 20.0), (2.0, 20.0)]),
                fill,
                Stroke::NONE,
            ));
            closed(&outline);
        }
        FileSign::Mesh => {
            closed(&[(12.0, 2.0), (22.0, 17.0), (12.0, 22.0), (2.0, 17.0)]);
            line(&[(12.0, 2.0), (12.0, 22.0)]);
        }
        FileSign::Picture => {
            closed(&[(2.0, 4.0), (22.0, 4.0), (22.0, 20.0), (2.0, 20.0)]);
            line(&[(2.0, 18.0), (9.0, 10.0), (14.0, 16.0), (17.0, 13.0), (22.0, 18.0)]);
            painter.circle_filled(on_grid(rect, &[(16.5, 8.5)])[0], 1.4 * rect.width() / 16.0, colour);
        }
        FileSign::Project => {
            closed(&[(4.0, 2.0), (20.0, 2.0), (20.0, 22.0), (4.0, 22.0)]);
            closed(&[(12.0, 7.0), (17.0, 17.0), (7.0, 17.0)]);
        }
        FileSign::Other => {
            closed(&[(4.0, 2.0), (14.0, 2.0), (20.0, 8.0), (20.0, 22.0), (4.0, 22.0)]);
            line(&[(14.0, 2.0), (14.0, 8.0), (20.0, 8.0)]);
        }
    }
}

pub(super) fn sign(painter: &egui::Painter, rect: Rect, sign: Sign, theme: &Theme) {
    let colour = sign.colour(theme);
    let stroke = Stroke::new(1.8, colour);
    match sign {
        Sign::Good => {
            check(painter, rect, colour);
        }
        Sign::Bad => {
            painter.add(Shape::line(on_grid(rect, &[(5.0, 5.0), (19.0, 19.0)]), stroke));
            painter.add(Shape::line(on_grid(rect, &[(19.0, 5.0), (5.0, 19.0)]), stroke));
        }
        Sign::Warning | Sign::Unmet => {
            painter.add(Shape::closed_line(on_grid(rect, &[(12.0, 3.0), (22.0, 21.0), (2.0, 21.0)]), stroke));
            painter.add(Shape::line(on_grid(rect, &[(12.0, 9.0), (12.0, 15.0)]), stroke));
        }
        Sign::Moving => {
            painter.add(Shape::line(on_grid(rect, &[(2.0, 12.0), (21.0, 12.0)]), stroke));
            painter.add(Shape::line(on_grid(rect, &[(14.0, 5.0), (21.0, 12.0), (14.0, 19.0)]), stroke));
        }
        Sign::Working => {
            for i in 0..6_u8 {
                let direction = egui::Vec2::angled(f32::from(i) * std::f32::consts::TAU / 6.0);
                painter.circle_filled(rect.center() + direction * rect.width() * 0.36, 1.3, colour);
            }
        }
    }
}
