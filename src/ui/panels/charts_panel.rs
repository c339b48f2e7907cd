//! Tab of the charts, for a mesh with several: their layout, a list with the worst first, and packing options.

use eframe::egui::{self, Color32, DragValue, Pos2, Rect, RichText, Role, Sense, Stroke, Vec2, WidgetInfo};
use glam::DVec2;

use super::menu::grouped;
use super::seams_section::seams_section;
use super::surface::charts_row;
use crate::session::{Action, AtlasView, ChartState, Session};
use crate::ui::{Control, Editor, Request, counted, keys_of, pairs, remark, sentence, theme_of};
use freebound_core::geom::{Bounds, PackingOptions, Rotations};
use freebound_core::problem::NamedOption;

/// Height of a row of the list, points.
const ROW: f32 = 22.0;

/// Row of a chart in the list.
struct Row {
    chart: usize,
    faces: usize,
    state: ChartState,
}

impl Row {
    /// Sort key: failed charts first, then charts that are not planar, then by decreasing distortion. Charts being
    /// solved come last.
    fn weight(&self) -> f64 {
        match &self.state {
            ChartState::Failed => f64::INFINITY,
            ChartState::Solved(outcome) if !outcome.step.verdict.planar => f64::MAX,
            ChartState::Solved(outcome) => outcome.distortion.summary.symmetric_dirichlet.mean,
            ChartState::Solving => f64::NEG_INFINITY,
        }
    }

    /// Description of the chart's state.
    fn words(&self) -> String {
        match &self.state {
            ChartState::Failed => "no embedding found".to_owned(),
            ChartState::Solving => "solving…".to_owned(),
            ChartState::Solved(outcome) if !outcome.step.verdict.planar => outcome.step.verdict.summary(),
            ChartState::Solved(outcome) => {
                format!("planar, energy {:.2}", outcome.distortion.summary.symmetric_dirichlet.mean)
            }
        }
    }
}

pub(super) fn charts_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let session = &editor.session;
    seams_section(ui, editor, requests);
    pairs(ui, "charts", [12.0, 4.0], |ui| charts_row(ui, session, requests));
    let Some(charts) = session.charts() else { return };
    ui.separator();
    let mut rows: Vec<Row> = (0..charts.count())
        .map(|chart| Row { chart, faces: charts.faces(chart).len(), state: session.chart_state(chart) })
        .collect();
    rows.sort_by(|a, b| b.weight().total_cmp(&a.weight()).then(a.chart.cmp(&b.chart)));
    let side = ui.available_width().min(ui.available_height() * 0.45).max(80.0);
    layout(ui, session, side, requests);
    verdict(ui, session, &rows);
    packing(ui, session, requests);
    size(ui, session, requests);
    ui.separator();
    list(ui, session, &rows, requests);
}

/// Draws all charts at their places in the picture. A click on a chart shows it.
fn layout(ui: &mut egui::Ui, session: &Session, side: f32, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), side), Sense::click());
    let response = response.named(Role::Image, "Layout of all charts in the picture");
    let painter = ui.painter_at(rect);
    let Some(AtlasView { outlines, .. }) = session.atlas() else {
        let words = "The layout appears here when all charts are solved";
        painter.text(
            rect.center(),
            egui::Align2::CENTER_CENTER,
            words,
            egui::FontId::proportional(12.0),
            theme.weak_text,
        );
        return;
    };
    let place = Place::new(rect, outlines, session.packing());
    painter.rect_stroke(place.rect_of(Bounds::UNIT), 0.0, Stroke::new(1.0, theme.weak_text), egui::StrokeKind::Outside);
    let shown = session.chart_on_screen();
    let under = response.hover_pos().and_then(|at| place.chart_at(outlines, at));
    for (chart, outline) in outlines.iter().enumerate() {
        let is_marked = Some(chart) == shown || Some(chart) == under;
        let colour = if Some(chart) == shown { theme.accent } else { theme.text };
        let stroke = Stroke::new(if is_marked { 2.0 } else { 1.0 }, colour);
        // Joined lines would have long spikes at the tips of seams.
        for (&from, &to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            painter.line_segment([place.of(from), place.of(to)], stroke);
        }
    }
    if let Some(chart) = under {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        let tip = format!("Chart {chart}: click to work on it");
        response.on_hover_text_at_pointer(tip).asks(Action::ShowChart(chart), requests);
    }
}

/// Map from texture coordinates to the panel.
struct Place {
    rect: Rect,
    low: DVec2,
    points_per_unit: DVec2,
}

impl Place {
    fn new(rect: Rect, outlines: &[Vec<DVec2>], packing: PackingOptions) -> Self {
        let all = Bounds::of(outlines.iter().flatten().copied().filter(|uv| uv.is_finite())).union(Bounds::UNIT);
        let [width, height] = packing.picture.map(f64::from);
        let aspect = DVec2::new(width / height, 1.0);
        let size = DVec2::new(rect.width().into(), rect.height().into()) - 2.0;
        let scale = (size / (all.size() * aspect)).min_element();
        Self { rect, low: all.low, points_per_unit: aspect * scale }
    }

    fn of(&self, uv: DVec2) -> Pos2 {
        let at = ((uv - self.low) * self.points_per_unit).as_vec2();
        Pos2::new(self.rect.left() + 1.0 + at.x, self.rect.bottom() - 1.0 - at.y)
    }

    fn rect_of(&self, bounds: Bounds) -> Rect {
        Rect::from_two_pos(self.of(bounds.low), self.of(bounds.high))
    }

    /// Chart that contains a point.
    fn chart_at(&self, outlines: &[Vec<DVec2>], at: Pos2) -> Option<usize> {
        let offset = [at.x - self.rect.left() - 1.0, self.rect.bottom() - 1.0 - at.y].map(f64::from);
        let uv = self.low + DVec2::from_array(offset) / self.points_per_unit;
        let winds =
            |outline: &Vec<DVec2>| freebound_core::geom::winding_number(outline, uv).is_some_and(|winds| winds != 0);
        outlines.iter().position(winds)
    }
}

/// Verdict on the whole atlas.
fn verdict(ui: &mut egui::Ui, session: &Session, rows: &[Row]) {
    let theme = theme_of(ui);
    let waiting = rows.iter().filter(|row| matches!(row.state, ChartState::Solving)).count();
    match session.atlas() {
        Some(AtlasView { verdict, .. }) if verdict.planar => {
            let holds = if verdict.planar_in_f32 { "Planar in 32 bits" } else { "Not planar in 32 bits" };
            ui.colored_label(theme.planar, sentence(&verdict.summary())).on_hover_text(holds);
        }
        Some(AtlasView { verdict, .. }) => {
            ui.colored_label(theme.flipped, sentence(&verdict.summary()));
        }
        None if waiting > 0 => {
            ui.label(format!("{} of {} charts solved", rows.len() - waiting, rows.len()));
        }
        None => {
            ui.label(counted(rows.len(), "chart", "charts"));
        }
    }
    if let Some(packing) = session.atlas().and_then(|atlas| atlas.packing) {
        let percent = 100.0 * packing.covered;
        remark(ui, format!("{percent:.0} % covered, {:.4} pixels per unit of length", packing.density));
    }
}

/// Fields for the size of the picture that charts are packed into, and the gap between charts. An edit applies when
/// the drag or the typing ends.
fn packing(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let kept = ui.scope_id().with("packing");
    let before = session.packing();
    let mut options: PackingOptions = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let has_picture = session.document().picture.is_some();
    let mut has_ended = false;
    ui.horizontal_wrapped(|ui| {
        ui.label("Picture");
        let tip =
            if has_picture { "The size of the open picture" } else { "Size in pixels that the charts are packed into" };
        let mut side = |ui: &mut egui::Ui, pixels: &mut u32, name: &str| {
            let value = DragValue::new(pixels).range(1..=PackingOptions::LONGEST_SIDE);
            let field = ui.add_enabled(!has_picture, value).named(Role::SpinButton, name);
            has_ended |= field.has_ended();
            field.on_hover_text(tip).on_disabled_hover_text(tip);
        };
        let [width, height] = &mut options.picture;
        side(ui, width, "Width of the picture in pixels");
        ui.label("×");
        side(ui, height, "Height of the picture in pixels");
        ui.label("px");
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Gap");
        let value = DragValue::new(&mut options.gap).range(0..=PackingOptions::WIDEST_GAP);
        let field = ui.add(value).named(Role::SpinButton, "Gap between charts in pixels");
        has_ended |= field.has_ended();
        field.on_hover_text("Minimum distance between charts, in pixels of the picture");
        ui.label("px");
        ui.label("Rotation");
        let rotations = crate::ui::list(ui, "Rotation of charts", 72.0, options.rotations.labels().title, |ui| {
            for &rotations in Rotations::ALL {
                let label = ui.selectable_label(options.rotations == rotations, rotations.labels().title);
                if label.on_hover_text(rotations.labels().tip()).clicked() && options.rotations != rotations {
                    options.rotations = rotations;
                    has_ended = true;
                }
            }
        });
        rotations.on_hover_text("Rotations of packed charts");
    });
    if has_ended {
        ui.data_mut(|data| data.remove::<PackingOptions>(kept));
        if options != before {
            // The size of the open picture is no setting of the user.
            let picture = if has_picture { session.document().packing.picture } else { options.picture };
            requests.push(Action::SetPacking(PackingOptions { picture, ..options }).into());
        }
    } else if options == before {
        ui.data_mut(|data| data.remove::<PackingOptions>(kept));
    } else {
        ui.data_mut(|data| data.insert_temp(kept, options));
    }
}

/// Field for the relative size of the chart on the screen, and its pixel density. An edit applies when the drag or
/// the typing ends.
fn size(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let Some(chart) = session.chart_on_screen() else { return };
    let kept = ui.scope_id().with(("size", chart));
    let before = session.sizes().get(chart).copied().unwrap_or(1.0);
    let mut size: f64 = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let is_held = !session.document().targets.is_empty();
    let tip = if is_held {
        "This chart has pins, so it is not packed"
    } else {
        "Size of this chart in the layout, relative to the others"
    };
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("Chart {chart}"));
        let value = DragValue::new(&mut size).range(PackingOptions::SIZES).speed(0.01).max_decimals(2).suffix("×");
        let field = ui.add_enabled(!is_held, value).named(Role::SpinButton, "Size of the chart on the screen");
        let field = field.on_hover_text(tip).on_disabled_hover_text(tip);
        if let Some(density) = session.atlas().and_then(|atlas| atlas.densities.get(chart)) {
            remark(ui, format!("{density:.4} pixels per unit of length"));
        }
        if field.has_ended() {
            ui.data_mut(|data| data.remove::<f64>(kept));
            if size.to_bits() != before.to_bits() {
                requests.push(Action::SetChartSize { chart, size }.into());
            }
        } else if size.to_bits() == before.to_bits() {
            ui.data_mut(|data| data.remove::<f64>(kept));
        } else {
            ui.data_mut(|data| data.insert_temp(kept, size));
        }
    });
}

/// List of the charts, the worst first.
fn list(ui: &mut egui::Ui, session: &Session, rows: &[Row], requests: &mut Vec<Request>) {
    let keys = [-1, 1].map(|by| keys_of(ui.ctx(), &Request::StepChart(by)));
    remark(ui, format!("Click a chart to work on it ({} and {})", keys[0], keys[1]));
    let shown = session.chart_on_screen();
    egui::ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, rows.len(), |ui, range| {
        for row in &rows[range] {
            row_of(ui, row, shown == Some(row.chart), requests);
        }
    });
}

fn row_of(ui: &mut egui::Ui, row: &Row, is_shown: bool, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::click());
    let faces = format!("{} f", grouped(row.faces));
    let words = row.words();
    let name = format!("Chart {}, {}, {words}", row.chart, counted(row.faces, "face", "faces"));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &name));
    if is_shown || response.hovered() || response.has_focus() {
        let share = if is_shown { 0.22 } else { 0.10 };
        ui.painter().rect_filled(rect, 3.0, theme.accent.gamma_multiply(share));
    }
    let colour: Color32 = match &row.state {
        ChartState::Failed => theme.flipped,
        ChartState::Solved(outcome) if !outcome.step.verdict.planar => theme.flipped,
        ChartState::Solved(_) => theme.planar,
        ChartState::Solving => theme.weak_text,
    };
    let inner = rect.shrink2(Vec2::new(4.0, 0.0));
    let line = format!("Chart {}  {faces}", row.chart);
    let galley = |ui: &egui::Ui, words: &str, colour| {
        let job = RichText::new(words).color(colour);
        egui::WidgetText::from(job).into_galley(
            ui,
            Some(egui::TextWrapMode::Truncate),
            inner.width(),
            egui::TextStyle::Body,
        )
    };
    let left = galley(ui, &line, theme.text);
    let right = galley(ui, &words, colour);
    let middle = |height: f32| inner.center().y - height / 2.0;
    let start =
        Pos2::new((inner.right() - right.size().x).max(inner.left() + left.size().x + 8.0), middle(right.size().y));
    let painter = ui.painter_at(inner);
    painter.galley(Pos2::new(inner.left(), middle(left.size().y)), left, theme.text);
    painter.galley(start, right, colour);
    response.on_hover_text(name).asks(Action::ShowChart(row.chart), requests);
}
