//! Bar at the top: menus, name of the document, and the verdict.

use eframe::egui::{self, Button, RichText, Role, ThemePreference, WidgetInfo};

use super::advice::advice;
use super::floating::EXPORTS;
use super::quality::quality;
use super::verdict_pill::verdict_pill;
use crate::examples::Example;
use crate::session::{Action, LockState};
use crate::ui::{
    Axis, Control, Editor, FileDialogKind, GestureKind, PageRequest, Pane, Request, SeamRule, ShadingMode, StepTarget,
    Tab, Tool, icons, keys_of, theme_of,
};
use freebound_core::pipeline::Fit;
use freebound_io::OutputKind;

/// Indentation of a menu entry that may have a check mark.
const ROOM_FOR_MARK: &str = "      ";

pub(in crate::ui) fn top_bar(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let asked = editor.layout.menu_asked.take();
    let editor = &*editor;
    let bar = ui.max_rect();
    ui.horizontal_centered(|ui| {
        let menus = egui::MenuBar::new().ui(ui, |ui| {
            let mut menu = Menu { ui, editor, requests };
            let help_menu = |menu: &mut Menu<'_>| {
                menu.item(true, "All keys", Request::ToggleKeys);
                menu.item(true, "Guided tour", Request::StartTour);
                menu.item(true, "Welcome", Request::ToggleWelcome);
            };
            let responses = [
                menu.part("File", file_menu),
                menu.part("Edit", edit_menu),
                menu.part("View", view_menu),
                menu.part("Solve", solve_menu),
                menu.part("Help", help_menu),
            ];
            if let Some(response) = asked.and_then(|place| responses.get(place)) {
                // Focus the title of the menu, so that the arrow keys lead into the menu.
                response.request_focus();
                response.ctx.request_repaint();
                egui::Popup::open_id(&response.ctx, egui::Popup::default_response_id(response));
            }
            responses[4].rect.right()
        });
        let right = ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let panels = ui.selectable_label(editor.layout.panels_shown(), "Panels");
            panels.on_hover_text("Show or hide the panels at the right").asks(Request::TogglePanels, requests);
            export_button(ui, editor, requests);
            verdict_pill(ui, editor, requests);
            quality(ui, editor, requests);
            advice(ui, editor, requests);
            ui.min_rect().left()
        });
        title_between(ui, bar, menus.inner..=right.inner, &title(editor));
    });
}

/// Button that writes the mesh with its texture coordinates, in the format of its file. Hidden in a narrow window.
fn export_button(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if editor.layout.is_narrow() {
        return;
    }
    let path = editor.session.model().and_then(|model| model.path.as_deref());
    let kind = path.map_or(OutputKind::Obj, OutputKind::of_mesh);
    let button = ui.add_enabled(editor.session.outcome().is_some(), Button::new("Export"));
    let keys = keys_of(ui.ctx(), &Request::ToggleExports);
    let tip = format!("Write the mesh with its texture coordinates ({keys} lists all exports)");
    let button = button.named(egui::Role::Button, "Export the mesh").on_hover_text(tip);
    button.asks(Request::Ask(FileDialogKind::Export(kind, None)), requests);
}

/// Name of the document, in the middle of the bar if menus and verdict leave room.
fn title_between(ui: &egui::Ui, bar: egui::Rect, room: std::ops::RangeInclusive<f32>, words: &str) {
    let text = egui::WidgetText::from(RichText::new(words).color(theme_of(ui).weak_text));
    let width = room.end() - room.start() - 24.0;
    if width < 40.0 {
        return;
    }
    let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), width, egui::TextStyle::Body);
    let half = galley.size() / 2.0;
    let leftmost = room.start() + 12.0 + half.x;
    let middle = bar.center().x.clamp(leftmost, (room.end() - 12.0 - half.x).max(leftmost));
    let place = egui::Rect::from_center_size(egui::pos2(middle, bar.center().y), galley.size());
    let response = ui.interact(place, ui.scope_id().with("title"), egui::Sense::hover());
    response.named(Role::Label, words);
    ui.painter().galley(egui::pos2(middle - half.x, bar.center().y - half.y), galley, theme_of(ui).weak_text);
}

/// Builder of a menu, or of the menu bar.
struct Menu<'a> {
    ui: &'a mut egui::Ui,
    editor: &'a Editor,
    requests: &'a mut Vec<Request>,
}

impl Menu<'_> {
    /// Submenu.
    fn part(&mut self, words: &str, add: impl FnOnce(&mut Menu<'_>)) -> egui::Response {
        let (editor, requests) = (self.editor, &mut *self.requests);
        self.ui.menu_button(words, |ui| add(&mut Menu { ui, editor, requests })).response
    }

    /// Entry with its shortcut.
    fn item(&mut self, enabled: bool, words: &str, request: impl Into<Request>) {
        self.entry(enabled, Button::new(words), request);
    }

    /// Entry of a choice, highlighted if chosen.
    fn choice(&mut self, on: bool, words: &str, request: Request) {
        self.entry(true, Button::selectable(on, words), request);
    }

    /// Entry that toggles an option, with a check mark if on.
    fn switch(&mut self, on: bool, words: &str, request: Request) {
        let button = Button::new(format!("{ROOM_FOR_MARK}{words}")).shortcut_text(keys_of(self.ui.ctx(), &request));
        let response = self.ui.add(button);
        if on {
            let middle = response.rect.left_center() + egui::vec2(14.0, 0.0);
            let square = egui::Rect::from_center_size(middle, egui::Vec2::splat(11.0));
            icons::check(self.ui.painter(), square, theme_of(self.ui).text);
        }
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, words));
        if response.asks(request, self.requests) {
            self.ui.close();
        }
    }

    fn entry(&mut self, enabled: bool, button: Button<'_>, request: impl Into<Request>) {
        let request = request.into();
        let button = button.shortcut_text(keys_of(self.ui.ctx(), &request));
        self.add(enabled, button, request);
    }

    fn add(&mut self, enabled: bool, button: Button<'_>, request: Request) {
        if self.ui.add_enabled(enabled, button).asks(request, self.requests) {
            self.ui.close();
        }
    }

    /// Entry with a tooltip and without a shortcut.
    fn explained(&mut self, enabled: bool, [words, tip]: [&str; 2], request: impl Into<Request>) {
        let button = self.ui.add_enabled(enabled, Button::new(words)).on_hover_text(tip);
        if button.asks(request, self.requests) {
            self.ui.close();
        }
    }
}

fn file_menu(menu: &mut Menu<'_>) {
    let editor = menu.editor;
    menu.item(true, "Open…", Request::Ask(FileDialogKind::Open));
    menu.part("Recent", |menu| {
        let paths = editor.session.recent().paths();
        for path in paths {
            menu.item(true, &path.display().to_string(), Action::Open(path.clone()));
        }
        if paths.is_empty() {
            menu.ui.weak("No files yet");
        } else {
            menu.ui.separator();
            menu.item(true, "Clear this list", Action::ClearRecent);
        }
    });
    menu.part("Examples", |menu| {
        for example in Example::ALL {
            menu.explained(true, [example.title(), example.about()], Action::OpenExample(example));
        }
    });
    menu.ui.separator();
    let has_model = editor.session.model().is_some();
    menu.item(has_model, "Save project", Request::SaveProject);
    menu.item(has_model, "Save project as…", Request::Ask(FileDialogKind::SaveProject));
    menu.ui.separator();
    // Picture and constraints are read from and written to files.
    let has_disk = editor.has_disk();
    menu.item(has_disk, "Open picture…", Request::Ask(FileDialogKind::OpenPicture));
    menu.item(editor.has_picture(), "Remove picture", Action::RemovePicture);
    menu.item(has_disk, "Import constraints…", Request::Ask(FileDialogKind::ImportConstraints));
    let has_pins = !editor.session.document().targets.is_empty();
    menu.item(has_pins, "Export constraints…", Request::Ask(FileDialogKind::ExportConstraints));
    menu.ui.separator();
    menu.part("Export", |menu| {
        for (kind, words, about) in EXPORTS {
            menu.explained(editor.session.outcome().is_some(), [words, about], Request::Ask(kind));
        }
    });
    menu.part("Size in files", |menu| {
        let (unit, true_size) = (Fit::Unit, Fit::True);
        menu.choice(editor.files.fit == unit, "Fit into the unit square", Request::SetFit(unit));
        menu.choice(editor.files.fit == true_size, "True scale: the mesh's own area", Request::SetFit(true_size));
        menu.ui.separator();
        menu.ui.weak("With pins, coordinates are not scaled.");
    });
    menu.ui.separator();
    menu.item(true, "Quit", Request::Quit);
}

fn edit_menu(menu: &mut Menu<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    menu.item(session.history().can_undo(), "Undo", Action::Undo);
    menu.item(session.history().can_redo(), "Redo", Action::Redo);
    menu.ui.separator();
    for tool in Tool::ALL {
        menu.choice(editor.tools.tool() == tool, tool.words()[1], Request::SetTool(tool));
    }
    menu.part("Seams", |menu| {
        let has_model = session.model().is_some();
        menu.item(session.can_unwrap(), "Unwrap: find short seams", Action::Unwrap(None));
        let degrees = editor.tools.seam.rules.degrees;
        let sharp = format!("Cut along sharp edges: {degrees:.0}° or more");
        menu.item(has_model, &sharp, Request::CutByRule(SeamRule::Sharp(degrees)));
        menu.item(has_model, "Cut along borders of materials", Request::CutByRule(SeamRule::Materials));
        menu.item(has_model, "Cut along borders of groups", Request::CutByRule(SeamRule::Groups));
        menu.ui.separator();
        let has_seams = !session.seams().edges().is_empty();
        menu.item(has_model, "Import seams…", Request::Ask(FileDialogKind::ImportSeams));
        let can_export = has_seams || !session.seams().automatic().is_empty();
        menu.item(can_export, "Export seams…", Request::Ask(FileDialogKind::ExportSeams));
        menu.ui.separator();
        menu.item(has_seams, "Clear seams", Request::ClearSeams);
    });
    menu.ui.separator();
    let fixable = !editor.selection.vertices().is_empty() && session.outcome().is_some();
    menu.item(fixable, "Fix the selection", Action::Fix(editor.selection.vertices().iter().copied().collect()));
    menu.item(editor.pins_selected().next().is_some(), "Free the selected pins", Request::UnpinSelected);
    let pin_count = session.document().targets.len();
    menu.item(pin_count > 0, "Free all pins", Action::UnpinAll);
    menu.ui.separator();
    menu.item(pin_count > 0, "Mirror the targets", Action::MirrorTargets);
    menu.item(pin_count > 1, "Fit the targets to the mesh", Action::FitTargets);
    menu.item(session.model().is_some(), "Reverse the faces", Action::TurnFaces);
}

fn view_menu(menu: &mut Menu<'_>) {
    let editor = menu.editor;
    for pane in Pane::BOTH {
        menu.part(&format!("Shading of the {}", pane.title().to_lowercase()), |menu| {
            for shading in ShadingMode::ALL.into_iter().filter(|shading| shading.is_for(pane)) {
                let button = Button::selectable(editor.shading(pane) == shading, shading.title());
                // Shortcuts shade the pane under the pointer; a menu entry names the pane.
                let keys = keys_of(menu.ui.ctx(), &Request::SetShading(shading));
                menu.add(true, button.shortcut_text(keys), Request::SetPaneShading(pane, shading));
            }
        });
    }
    menu.switch(editor.pane_shading.wireframe, "Wireframe", Request::ToggleWireframe);
    menu.switch(editor.pane_shading.is_sharp(), "Sharp pixels", Request::ToggleSharp);
    menu.switch(editor.plane.hull_shown(), "Hull and pockets", Request::ToggleHull);
    menu.switch(editor.pane_shading.magnifier, "Magnifier", Request::ToggleMagnifier);
    menu.switch(editor.pane_shading.glides, "Animate changes of step", Request::ToggleEase);
    menu.switch(editor.layout.panels_shown(), "Panels", Request::TogglePanels);
    menu.switch(editor.timeline.curves_shown(), "Curves of the steps", Request::ToggleCurves);
    menu.ui.separator();
    menu.item(true, "Frame the selection, or all", Request::Frame);
    menu.item(true, "Go to…", Request::AskGoTo);
    let has_defects = editor.defect_count() > 0;
    menu.item(has_defects, "Next defect", Request::StepDefect(1));
    menu.item(has_defects, "Previous defect", Request::StepDefect(-1));
    if editor.session.charts().is_some() {
        menu.item(true, "Next chart", Request::StepChart(1));
        menu.item(true, "Previous chart", Request::StepChart(-1));
        let states: Vec<LockState> =
            editor.charts_to_work_on().into_iter().map(|chart| editor.session.lock_state(chart)).collect();
        let can_lock = states.contains(&LockState::Open);
        let words = if can_lock || states.is_empty() { "Lock the charts" } else { "Unlock the charts" };
        menu.item(can_lock || states.contains(&LockState::Locked), words, Request::ToggleLock);
        menu.switch(editor.shows_page(), "All charts on the page", PageRequest::Toggle.into());
        page_menu(menu);
    }
    menu.ui.separator();
    menu.part("Theme", |menu| {
        use ThemePreference::{Dark, Light, System};
        let now = menu.ui.ctx().options(|options| options.theme_preference);
        for (theme, words) in [(System, "System"), (Light, "Light"), (Dark, "Dark")] {
            menu.choice(now == theme, words, Request::SetTheme(theme));
        }
    });
}

/// Entries on the charts of the page.
fn page_menu(menu: &mut Menu<'_>) {
    let editor = menu.editor;
    let can_move = editor.shows_page() && !editor.movable_charts().is_empty();
    let has_selected = editor.shows_page() && !editor.plane.page.selected().is_empty();
    menu.part("Charts", |menu| {
        menu.item(editor.shows_page(), "Select all", PageRequest::SelectAll);
        menu.item(editor.shows_page(), "Invert the selection", PageRequest::Invert);
        menu.item(has_selected, "Show one alone", PageRequest::Open(None));
        menu.ui.separator();
        for kind in GestureKind::ALL {
            menu.item(can_move, kind.title(), PageRequest::Begin(kind));
        }
        menu.item(can_move, "Mirror left to right", PageRequest::Mirror(Axis::X));
        menu.item(can_move, "Mirror top to bottom", PageRequest::Mirror(Axis::Y));
        menu.ui.separator();
        menu.item(has_selected, "Stack", PageRequest::Stack);
        menu.item(has_selected, "Unstack", PageRequest::Unstack);
        menu.item(editor.shows_page(), "Pack the selected charts, or all", PageRequest::Pack);
    });
}

fn solve_menu(menu: &mut Menu<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    menu.item(editor.has_disk(), "Take one step", Action::Step);
    let (run, can_run) =
        if session.is_running() { ("Pause the run", true) } else { ("Start the run", session.can_run()) };
    menu.item(can_run, run, Request::RunOrPause);
    menu.item(session.can_repair(), "Repair", Action::Repair);
    menu.item(session.can_relax(), "Relax", Action::Relax);
    menu.ui.separator();
    let [has_previous, has_next] = editor.steps_around();
    menu.item(has_previous, "First step", Request::GoToStep(StepTarget::First));
    menu.item(has_previous, "Previous step", Request::GoToStep(StepTarget::Previous));
    menu.item(has_next, "Next step", Request::GoToStep(StepTarget::Next));
    menu.item(has_next, "Last step", Request::GoToStep(StepTarget::Last));
    let play = if editor.timeline.playing_since.is_some() { "Stop playing" } else { "Play all steps" };
    menu.item(has_previous || has_next, play, Request::TogglePlay);
    menu.ui.separator();
    menu.item(editor.has_disk(), "Solve from scratch", Action::Solve);
    menu.item(session.busy().is_some(), "Cancel", Action::Cancel);
    menu.ui.separator();
    menu.item(true, "Method and weights", Request::ShowTab(Tab::Method));
    let is_comparing = editor.plane.comparison.is_shown();
    let words = if is_comparing { "Leave the comparison" } else { "Compare methods…" };
    menu.item(is_comparing || editor.has_disk(), words, Request::ToggleComparison);
}

/// Name of the document, and numbers of vertices and faces.
fn title(editor: &Editor) -> String {
    let Some(model) = editor.session.model() else { return "Freebound".to_owned() };
    let name = editor.marked_name();
    if let Some(charts) = editor.session.charts().filter(|_| editor.shows_page()) {
        let polygons = &model.source.polygons;
        let counts = [charts.count(), polygons.positions.len(), polygons.face_count()].map(grouped);
        return format!("{name} · {} charts · {} v · {} f", counts[0], counts[1], counts[2]);
    }
    let counts = [model.vertex_count(), model.mesh().real_face_count()].map(grouped);
    let chart = editor.session.chart_on_screen().map(|chart| format!(" · chart {chart}")).unwrap_or_default();
    format!("{name}{chart} · {} v · {} f", counts[0], counts[1])
}

/// Formats a count with its thousands separated by spaces.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let groups = digits.as_bytes().rchunks(3).rev();
    groups.map(String::from_utf8_lossy).collect::<Vec<_>>().join(" ")
}
