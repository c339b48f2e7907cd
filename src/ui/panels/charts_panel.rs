//! Tab of the charts, for a mesh with several: their layout, a list with the worst first, and packing options.

use std::collections::BTreeSet;

use eframe::egui::{self, Color32, DragValue, Pos2, Rect, RichText, Role, Sense, Stroke, Vec2, WidgetInfo};
use glam::DVec2;

use super::menu::grouped;
use super::seams_section::seams_section;
use super::surface::charts_row;
use crate::session::{Action, AtlasView, ChartState, LockState, Session};
use crate::ui::round_joins::closed_line;
use crate::ui::theme::{HOVERED, SELECTED};
use crate::ui::{
    Alignment, Axis, Control, Editor, GestureKind, Offer, PageRequest, Request, Snap, counted, five_digits, icons,
    keys_of, list, option_list, pairs, remark, sentence, theme_of, tip_with_keys,
};
use freebound_core::geom::{Bounds, FIRST_UDIM_TILE, PackingOptions, corner_of_tile};
use freebound_core::mesh::Charts;
use freebound_core::pipeline::{PackingSummary, StackedOn};

/// Height of a row of the list, points: two lines.
const ROW: f32 = 38.0;

/// Rows of the list that are visible at once, at least.
const LEAST_ROWS: f32 = 3.0;

/// Width of the button at the left of a row, points.
const LOCK: f32 = 22.0;

/// Range of a fixed density, pixels per unit of length.
const DENSITIES: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

/// Row of a chart in the list.
struct Row {
    chart: usize,
    faces: usize,
    state: ChartState,
    lock: LockState,
    place: Option<RowPlace>,
    /// Name in the file.
    title: Option<String>,
}

/// Place of a chart in the layout of all charts.
struct RowPlace {
    /// Pixels of the picture per unit of length.
    density: f64,
    tile: Option<u32>,
    stacked: Option<StackedOn>,
}

impl RowPlace {
    /// Density, tile and stack in a few words.
    fn words(&self) -> String {
        let tile = self.tile.map(|tile| format!(", tile {tile}"));
        let on = self.stacked.map(|StackedOn { chart, mirrored }| {
            format!(", {} chart {chart}", if mirrored { "mirrored on" } else { "on" })
        });
        format!("{} px per unit{}{}", five_digits(self.density), tile.unwrap_or_default(), on.unwrap_or_default())
    }
}

impl Row {
    /// Row of a chart, with the layout of all charts if there is one.
    fn new(session: &Session, charts: &Charts, chart: usize, atlas: Option<&AtlasView>) -> Self {
        let place = atlas.map(|atlas| RowPlace {
            density: atlas.densities[chart],
            tile: atlas.tiles[chart],
            stacked: atlas.stacked[chart],
        });
        let (faces, state) = (charts.faces(chart).len(), session.chart_state(chart));
        let title = session.chart_name(chart).map(str::to_owned);
        Self { chart, faces, state, lock: session.lock_state_in(chart, atlas), place, title }
    }

    /// Name for tooltips and screen readers.
    fn name(&self, words: &str, place: &str) -> String {
        let place = if place.is_empty() { String::new() } else { format!(", {place}") };
        let locked = if self.lock == LockState::Locked { ", locked" } else { "" };
        let title = self.title.as_ref().map(|title| format!(", {title}")).unwrap_or_default();
        let faces = counted(self.faces, "face", "faces");
        format!("Chart {}{title}, {faces}, {words}{place}{locked}", self.chart)
    }

    /// Tooltip of the row's lock.
    fn lock_tip(&self) -> String {
        match (self.lock, self.place.as_ref().and_then(|place| place.stacked)) {
            (LockState::Locked, _) => "Unlock this chart, so that it is packed with the others".to_owned(),
            (LockState::Open, _) => "Lock this chart: the others are packed around it".to_owned(),
            (LockState::Pinned, _) => "This chart has pins, which hold it already".to_owned(),
            (LockState::Stacked, Some(on)) => {
                format!("This chart is stacked on chart {}: unstack it to lock it alone", on.chart)
            }
            (LockState::Stacked | LockState::NoPlace, _) => {
                "A chart can be locked once all charts are packed".to_owned()
            }
        }
    }

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

/// Tab of the charts. The list of charts ends at the lower edge of the panel if it has room above.
pub(super) fn charts_panel(ui: &mut egui::Ui, editor: &Editor, panel: egui::Rect, requests: &mut Vec<Request>) {
    let session = &editor.session;
    seams_section(ui, editor, requests);
    pairs(ui, "charts", [12.0, 4.0], |ui| charts_row(ui, session, requests));
    let Some(charts) = session.charts() else { return };
    ui.separator();
    let atlas = session.atlas().or(session.newest_atlas().filter(|atlas| atlas.densities.len() == charts.count()));
    let mut rows: Vec<Row> = (0..charts.count()).map(|chart| Row::new(session, charts, chart, atlas)).collect();
    rows.sort_by(|a, b| b.weight().total_cmp(&a.weight()).then(a.chart.cmp(&b.chart)));
    if !editor.shows_page() {
        let side = ui.available_width().min(panel.height() * 0.19).max(80.0);
        layout(ui, session, side, requests);
    }
    verdict(ui, session, &rows);
    let options = egui::CollapsingHeader::new("Packing options").default_open(false);
    options.show(ui, |ui| packing(ui, session, requests));
    arrange(ui, editor, requests);
    size(ui, editor, requests);
    ui.separator();
    rows_of(ui, editor, &rows, panel.bottom(), requests);
}

/// Draws all charts at their places in the picture. A click on a chart shows it.
fn layout(ui: &mut egui::Ui, session: &Session, side: f32, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), side), Sense::click());
    let response = response.named(Role::Image, "Layout of all charts in the picture");
    let painter = ui.painter_at(rect);
    let Some(AtlasView { outlines, tiles, stacked, .. }) = session.atlas() else {
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
    frames(&painter, &place, tiles, theme.weak_text);
    let shown = session.chart_on_screen();
    let under = response.hover_pos().and_then(|at| place.chart_at(outlines, at));
    for (chart, outline) in outlines.iter().enumerate() {
        let is_marked = Some(chart) == shown || Some(chart) == under;
        let colour = if Some(chart) == shown { theme.accent } else { theme.text };
        let stroke = Stroke::new(if is_marked { 2.0 } else { 1.0 }, colour);
        let corners: Vec<egui::Pos2> = outline.iter().map(|&at| place.of(at)).collect();
        closed_line(&painter, &corners, stroke);
    }
    if let Some(chart) = under {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        let on_it = stacked.iter().flatten().filter(|on| on.chart == chart).count();
        let stack = if on_it > 0 { format!(", with {on_it} stacked on it") } else { String::new() };
        let tip = format!("Chart {chart}{stack}: click to work on it");
        response.on_hover_text_at_pointer(tip).asks(Action::ShowChart(chart), requests);
    }
}

/// Draws the frames of all tiles with charts, and their UDIM numbers if there are several.
fn frames(painter: &egui::Painter, place: &Place, tiles: &[Option<u32>], colour: Color32) {
    let tiles: BTreeSet<u32> = tiles.iter().flatten().copied().chain([FIRST_UDIM_TILE]).collect();
    for &tile in &tiles {
        let low = corner_of_tile((tile - FIRST_UDIM_TILE) as usize);
        let rect = place.rect_of(Bounds { low, high: low + 1.0 });
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, colour), egui::StrokeKind::Inside);
        if tiles.len() > 1 {
            let at = rect.left_bottom() + Vec2::new(3.0, -2.0);
            let font = egui::FontId::proportional(10.0);
            painter.text(at, egui::Align2::LEFT_BOTTOM, tile.to_string(), font, colour);
        }
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
        let all = Bounds { low: all.low.floor(), high: all.high.ceil() };
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
        None if rows.iter().all(|row| matches!(row.state, ChartState::Solved(_))) => {
            ui.label("Packing…");
        }
        None => {
            ui.label(counted(rows.len(), "chart", "charts"));
        }
    }
    if let Some(packing) = session.atlas().and_then(|atlas| atlas.packing) {
        let words = remark(ui, packing_words(&packing, session.packing().picture));
        words.on_hover_text(if session.has_placed_charts() {
            "Charts stay where they lie until they are packed"
        } else {
            "The packing is up to date: charts are packed again after every change, until one is moved"
        });
    }
}

/// Covered share, density, number of tiles, and the picture if it was doubled.
fn packing_words(packing: &PackingSummary, asked: [u32; 2]) -> String {
    let PackingSummary { picture, density, tiles, covered, .. } = *packing;
    let percent = 100.0 * covered;
    let tiles = if tiles > 1 { format!(" of {tiles} tiles") } else { String::new() };
    let [width, height] = picture;
    let doubled = if picture == asked { String::new() } else { format!("; doubled to {width} × {height} px") };
    let unmet = if packing.unmet_density().is_some() { "; the fixed density does not fit" } else { "" };
    format!("{percent:.0} % covered{tiles}, {} px per unit{doubled}{unmet}", five_digits(density))
}

/// Fields for the packing of charts. An edit applies when the drag or the typing ends.
fn packing(ui: &mut egui::Ui, session: &Session, requests: &mut Vec<Request>) {
    let kept = ui.scope_id().with("packing");
    let before = session.packing();
    let mut options: PackingOptions = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let has_picture = session.document().picture.is_some();
    let found = session.atlas().and_then(|atlas| atlas.packing).map(|packing| packing.density);
    let ended = [
        picture_fields(ui, &mut options.picture, has_picture),
        gap_and_rotations(ui, &mut options),
        stack_and_tiles(ui, &mut options),
        density_field(ui, &mut options.density, found),
    ];
    if ended.contains(&true) {
        ui.data_mut(|data| data.remove::<PackingOptions>(kept));
        if options != before {
            // The size of the open picture is no setting of the user.
            let picture = if has_picture { session.document().layout.packing.picture } else { options.picture };
            requests.push(Action::SetPacking(PackingOptions { picture, ..options }).into());
        }
    } else if options == before {
        ui.data_mut(|data| data.remove::<PackingOptions>(kept));
    } else {
        ui.data_mut(|data| data.insert_temp(kept, options));
    }
}

/// Fields for the size of the picture that charts are packed into. True if an edit has ended.
fn picture_fields(ui: &mut egui::Ui, [width, height]: &mut [u32; 2], has_picture: bool) -> bool {
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
        side(ui, width, "Width of the picture in pixels");
        ui.label("×");
        side(ui, height, "Height of the picture in pixels");
        ui.label("px");
    });
    has_ended
}

/// Field for the gap between charts, and list of their rotations. True if an edit has ended.
fn gap_and_rotations(ui: &mut egui::Ui, options: &mut PackingOptions) -> bool {
    let mut has_ended = false;
    ui.horizontal_wrapped(|ui| {
        ui.label("Gap");
        let value = DragValue::new(&mut options.gap).range(0..=PackingOptions::WIDEST_GAP);
        let field = ui.add(value).named(Role::SpinButton, "Gap between charts in pixels");
        has_ended |= field.has_ended();
        field.on_hover_text("Minimum distance between charts, in pixels of the picture");
        ui.label("px");
        ui.label("Rotation");
        has_ended |= option_list(ui, "Rotation of charts", "Rotations of packed charts", &mut options.rotations);
    });
    has_ended
}

/// List of charts that share a place, and field for the number of tiles. True if an edit has ended.
fn stack_and_tiles(ui: &mut egui::Ui, options: &mut PackingOptions) -> bool {
    let mut has_ended = false;
    ui.horizontal_wrapped(|ui| {
        ui.label("Stack");
        let tip = "Charts with congruent surfaces that share one place in the picture";
        has_ended |= option_list(ui, "Stacking of charts", tip, &mut options.stack);
        ui.label("Tiles");
        let value = DragValue::new(&mut options.tiles).range(1..=PackingOptions::MOST_TILES).speed(0.05);
        let field = ui.add(value).named(Role::SpinButton, "Largest number of tiles");
        has_ended |= field.has_ended();
        field.on_hover_text("Largest number of tiles (UDIM), each a picture of its own");
    });
    has_ended
}

/// Switch and field for a fixed density. It starts at the density that was `found`. True if an edit has ended.
fn density_field(ui: &mut egui::Ui, density: &mut Option<f64>, found: Option<f64>) -> bool {
    let mut has_ended = false;
    ui.horizontal_wrapped(|ui| {
        let mut is_fixed = density.is_some();
        let start = found.filter(|found| found.is_finite() && *found > 0.0);
        let switch = ui.add_enabled(is_fixed || start.is_some(), egui::Checkbox::new(&mut is_fixed, "Fixed density"));
        let tip = "Pixels per unit of length stay, and the picture is doubled until the charts fit";
        if switch.on_hover_text(tip).on_disabled_hover_text("A density is known once all charts are packed").changed() {
            *density = if is_fixed { start } else { None };
            has_ended = true;
        }
        if let Some(density) = density {
            let speed = *density * 0.005;
            let value = DragValue::new(density).range(DENSITIES).speed(speed).max_decimals(4);
            let field = ui.add(value).named(Role::SpinButton, "Density in pixels per unit of length");
            has_ended |= field.has_ended();
            field.on_hover_text("Pixels of the picture per unit of length of the mesh");
            ui.label("px per unit");
        }
    });
    has_ended
}

/// Selected charts: menus that move, line up and stack them, and buttons that pack.
fn arrange(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if !editor.shows_page() {
        return;
    }
    let selected = editor.plane.page.selected().len();
    let can_move = !editor.movable_charts().is_empty();
    ui.horizontal_wrapped(|ui| {
        ui.add_enabled_ui(can_move, |ui| {
            ui.menu_button("Move", |ui| {
                for kind in GestureKind::ALL {
                    entry(ui, kind.title(), kind.about(), PageRequest::Begin(kind), requests);
                }
                ui.separator();
                for (axis, words) in Axis::BOTH.into_iter().zip(["Mirror left to right", "Mirror top to bottom"]) {
                    entry(ui, words, "Mirror each selected chart in place", PageRequest::Mirror(axis), requests);
                }
            });
            ui.menu_button("Align", |ui| {
                for alignment in Alignment::ALL {
                    let tip = "Line up the selected charts";
                    entry(ui, alignment.title(), tip, PageRequest::Align(alignment), requests);
                }
                ui.separator();
                for (axis, words) in Axis::BOTH.into_iter().zip(["Distribute across", "Distribute up"]) {
                    let tip = "Make the gaps between three or more selected charts equal";
                    entry(ui, words, tip, PageRequest::Distribute(axis), requests);
                }
            });
        });
        ui.add_enabled_ui(selected > 0, |ui| {
            ui.menu_button("Stack", |ui| {
                let tip =
                    "Lay the selected charts on the first of them: congruent surfaces or mirror images share a place";
                entry(ui, "Stack on the first", tip, PageRequest::Stack, requests);
                let tip = "Give the selected charts places of their own again, packed around the others";
                entry(ui, "Unstack", tip, PageRequest::Unstack, requests);
            });
        });
        snap_menu(ui, editor, requests);
    });
    ui.horizontal_wrapped(|ui| {
        let tip = "Pack the selected charts around all others, which stay";
        let pack = Offer::new("Pack selected", tip, PageRequest::Pack);
        pack.when(selected > 0).show(ui, requests);
        let tip = "Pack all charts that are not locked";
        let all = ui.add_enabled(editor.session.has_placed_charts(), egui::Button::new("Pack all").small());
        all.on_hover_text(tip)
            .on_disabled_hover_text("All charts are packed already")
            .asks(PageRequest::PackAll, requests);
        density_of_selection(ui, editor, requests);
    });
}

/// Entry of a menu on the selected charts.
fn entry(ui: &mut egui::Ui, words: &str, about: &str, request: PageRequest, requests: &mut Vec<Request>) {
    let tip = tip_with_keys(ui, about, &Request::Page(request.clone()));
    if ui.button(words).on_hover_text(tip).asks(request, requests) {
        ui.close();
    }
}

/// Menu of the places that moved charts snap to.
fn snap_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let now = editor.plane.page.snap();
    let menu = list(ui, "Snapping of moved charts", 110.0, now.title(), |ui| {
        for snap in Snap::ALL {
            ui.selectable_label(now == snap, snap.title()).asks(PageRequest::SetSnap(snap), requests);
        }
    });
    menu.on_hover_text("Places that moved charts snap to. Ctrl turns snapping on or off during a move");
}

/// Field that scales each selected chart in place to a density. It applies when the typing ends.
fn density_of_selection(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let Some(&first) = editor.plane.page.selected().first().filter(|_| !editor.movable_charts().is_empty()) else {
        return;
    };
    let found = editor.session.newest_atlas().and_then(|atlas| atlas.densities.get(first).copied());
    let Some(before) = found else { return };
    let kept = ui.scope_id().with(("density of the selection", first));
    let mut density: f64 = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let value =
        DragValue::new(&mut density).range(DENSITIES).speed(before * 0.005).max_decimals(2).suffix(" px per unit");
    let field = ui.add(value).named(Role::SpinButton, "Density of the selected charts, pixels per unit of length");
    let field = field.on_hover_text("Scale each selected chart in place to this number of pixels per unit of length");
    if field.has_ended() {
        ui.data_mut(|data| data.remove::<f64>(kept));
        if density.to_bits() != before.to_bits() {
            requests.push(PageRequest::SetDensity(density).into());
        }
    } else if density.to_bits() == before.to_bits() {
        ui.data_mut(|data| data.remove::<f64>(kept));
    } else {
        ui.data_mut(|data| data.insert_temp(kept, density));
    }
}

/// Field for the relative size of the chart on the screen, and its pixel density. An edit applies when the drag or
/// the typing ends.
fn size(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let session = &editor.session;
    let Some(chart) = editor.charts_to_work_on().first().copied().or(session.chart_on_screen()) else { return };
    let kept = ui.scope_id().with(("size", chart));
    let before = session.sizes().get(chart).copied().unwrap_or(1.0);
    let mut size: f64 = ui.data(|data| data.get_temp(kept)).unwrap_or(before);
    let lock = session.lock_state(chart);
    let is_held = matches!(lock, LockState::Pinned | LockState::Locked);
    let tip = if lock == LockState::Locked {
        "This chart is locked, so it is not packed"
    } else if is_held {
        "This chart has pins, so it is not packed"
    } else {
        "Size of this chart in the layout, relative to the others"
    };
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("Chart {chart}"));
        let value = DragValue::new(&mut size).range(PackingOptions::SIZES).speed(0.01).max_decimals(2).suffix("×");
        let field = ui.add_enabled(!is_held, value).named(Role::SpinButton, "Size of the chart on the screen");
        let field = field.on_hover_text(tip).on_disabled_hover_text(tip);
        if let Some(density) = session.newest_atlas().and_then(|atlas| atlas.densities.get(chart)) {
            remark(ui, format!("{} px per unit", five_digits(*density)));
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
fn rows_of(ui: &mut egui::Ui, editor: &Editor, rows: &[Row], bottom: f32, requests: &mut Vec<Request>) {
    let keys = [-1, 1].map(|by| keys_of(ui.ctx(), &Request::StepChart(by)));
    let lock = keys_of(ui.ctx(), &Request::ToggleLock);
    let shows_page = editor.shows_page();
    let words = if shows_page {
        "Worst first. Click selects, double click shows alone"
    } else {
        "Worst first. Click to work on a chart"
    };
    remark(ui, format!("{words} ({} and {}), {lock} locks", keys[0], keys[1]));
    let marked = editor.charts_to_work_on();
    let height = (bottom - ui.cursor().top()).max(LEAST_ROWS * ROW);
    let area = egui::ScrollArea::vertical().id_salt("list of charts").auto_shrink(false);
    let area = area.min_scrolled_height(height).max_height(height);
    area.show_rows(ui, ROW, rows.len(), |ui, range| {
        for row in &rows[range] {
            row_of(ui, row, (marked.contains(&row.chart), shows_page), requests);
        }
    });
}

/// Row of a chart. A row is marked if its chart is selected, or on the screen if the page is not shown.
fn row_of(ui: &mut egui::Ui, row: &Row, (is_shown, shows_page): (bool, bool), requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::click());
    let words = row.words();
    let place = row.place.as_ref().map(RowPlace::words).unwrap_or_default();
    let name = row.name(&words, &place);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &name));
    if is_shown || response.hovered() || response.has_focus() {
        let share = if is_shown { SELECTED } else { HOVERED };
        ui.painter().rect_filled(rect, 3.0, theme.accent.gamma_multiply(share));
    }
    let colour: Color32 = match &row.state {
        ChartState::Failed => theme.flipped,
        ChartState::Solved(outcome) if !outcome.step.verdict.planar => theme.flipped,
        ChartState::Solved(_) => theme.planar,
        ChartState::Solving => theme.weak_text,
    };
    let inner = Rect::from_min_max(rect.min + Vec2::new(LOCK + 4.0, 0.0), rect.max - Vec2::new(4.0, 0.0));
    let line = format!("Chart {}  {} f", row.chart, grouped(row.faces));
    let galley = |ui: &egui::Ui, words: &str, style: egui::TextStyle, colour| {
        let job = RichText::new(words).color(colour);
        egui::WidgetText::from(job).into_galley(ui, Some(egui::TextWrapMode::Truncate), inner.width(), style)
    };
    let below = [row.title.as_deref(), Some(place.as_str())].into_iter().flatten().filter(|words| !words.is_empty());
    let below = below.collect::<Vec<_>>().join(" · ");
    let left = galley(ui, &line, egui::TextStyle::Body, theme.text);
    let right = galley(ui, &words, egui::TextStyle::Body, colour);
    let below = galley(ui, &below, egui::TextStyle::Small, theme.weak_text);
    let top = inner.top() + 2.0;
    let start = Pos2::new((inner.right() - right.size().x).max(inner.left() + left.size().x + 8.0), top);
    let painter = ui.painter_at(inner);
    painter.galley(Pos2::new(inner.left(), top), left, theme.text);
    painter.galley(start, right, colour);
    painter.galley(Pos2::new(inner.left(), inner.bottom() - below.size().y - 3.0), below, theme.weak_text);
    let to_lock = Rect::from_min_size(rect.min, Vec2::new(LOCK, ROW));
    lock_button(ui, row, to_lock, requests);
    let response = response.on_hover_text(name);
    if !shows_page {
        response.asks(Action::ShowChart(row.chart), requests);
    } else if response.double_clicked() {
        requests.push(PageRequest::Open(Some(row.chart)).into());
    } else {
        let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
        response.asks(PageRequest::Pick { chart: Some(row.chart), adds }, requests);
    }
}

/// Padlock at the left of a row.
fn lock_button(ui: &egui::Ui, row: &Row, rect: Rect, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    let is_locked = row.lock == LockState::Locked;
    let can_change = matches!(row.lock, LockState::Open | LockState::Locked);
    let sense = if can_change { Sense::click() } else { Sense::hover() };
    let response = ui.interact(rect, ui.scope_id().with(("lock", row.chart)), sense);
    let name = format!("{} chart {}", if is_locked { "Unlock" } else { "Lock" }, row.chart);
    response.widget_info(|| WidgetInfo::selected(Role::Button, can_change, is_locked, &name));
    if can_change && (response.hovered() || response.has_focus()) {
        ui.painter().rect_filled(rect.shrink(2.0), 3.0, theme.accent.gamma_multiply(0.2));
    }
    let colour = match row.lock {
        LockState::Locked => theme.accent,
        LockState::Open => theme.text.gamma_multiply(0.6),
        _ => theme.weak_text.gamma_multiply(0.4),
    };
    icons::lock(ui.painter(), Rect::from_center_size(rect.center(), Vec2::splat(14.0)), is_locked, colour);
    let lock = Action::LockCharts { charts: [row.chart].into(), lock: !is_locked };
    response.on_hover_text(row.lock_tip()).asks(lock, requests);
}
