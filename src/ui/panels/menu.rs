//! The bar at the top: menus, what is open, and the verdict.

use eframe::egui;
use egui::{Button, RichText, Role, WidgetInfo};

use super::exports::EXPORTS;
use super::verdict_pill::verdict_pill;
use crate::examples::Example;
use crate::session::{Action, OutputFit};
use crate::ui::theme::theme_of;
use crate::ui::{Editor, Purpose, Request, Shading, StepTarget, Tab, Tool, keys_of};

/// Shows the bar.
pub(in crate::ui) fn top_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let bar = ui.max_rect();
    ui.horizontal_centered(|ui| {
        let menus = egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| file_menu(ui, editor, requests));
            ui.menu_button("Edit", |ui| edit_menu(ui, editor, requests));
            ui.menu_button("View", |ui| view_menu(ui, editor, requests));
            ui.menu_button("Solve", |ui| solve_menu(ui, editor, requests));
            let help = ui.menu_button("Help", |ui| item(ui, true, "All keys", Request::ToggleKeys, requests));
            help.response.rect.right()
        });
        let right = ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let panels = ui.selectable_label(editor.layout.panels_shown(), "Panels");
            if panels.on_hover_text("Show or hide the panels at the right").clicked() {
                requests.push(Request::TogglePanels);
            }
            verdict_pill(ui, editor, requests);
            ui.min_rect().left()
        });
        title_between(ui, bar, menus.inner..=right.inner, &title(editor));
    });
}

/// What is open, in the middle of the bar as far as menus and verdict leave room.
fn title_between(ui: &egui::Ui, bar: egui::Rect, room: std::ops::RangeInclusive<f32>, words: &str) {
    let text = egui::WidgetText::from(RichText::new(words).color(theme_of(ui).weak_text));
    let width = room.end() - room.start() - 24.0;
    if width < 40.0 {
        return;
    }
    let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), width, egui::TextStyle::Body);
    let half = galley.size() / 2.0;
    let middle = bar
        .center()
        .x
        .clamp(room.start() + 12.0 + half.x, (room.end() - 12.0 - half.x).max(room.start() + 12.0 + half.x));
    let place = egui::Rect::from_center_size(egui::pos2(middle, bar.center().y), galley.size());
    let response = ui.interact(place, ui.scope_id().with("title"), egui::Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
    ui.painter().galley(egui::pos2(middle - half.x, bar.center().y - half.y), galley, theme_of(ui).weak_text);
}

/// A menu entry with its shortcut.
fn item(ui: &mut egui::Ui, enabled: bool, words: &str, request: Request, requests: &mut Vec<Request>) {
    let keys = keys_of(ui.ctx(), &request);
    if ui.add_enabled(enabled, Button::new(words).shortcut_text(keys)).clicked() {
        requests.push(request);
        ui.close();
    }
}

/// A menu entry that is on or off.
fn choice(ui: &mut egui::Ui, on: bool, words: &str, request: Request, requests: &mut Vec<Request>) {
    let keys = keys_of(ui.ctx(), &request);
    if ui.add(Button::selectable(on, words).shortcut_text(keys)).clicked() {
        requests.push(request);
        ui.close();
    }
}

fn file_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    item(ui, true, "Open…", Request::Ask(Purpose::Open), requests);
    ui.menu_button("Recent", |ui| {
        let paths = editor.session.recent().paths();
        for path in paths {
            let open = Request::Do(Action::Open(path.clone()));
            item(ui, true, &path.display().to_string(), open, requests);
        }
        if paths.is_empty() {
            ui.weak("No files yet");
        } else {
            ui.separator();
            item(ui, true, "Forget these", Request::Do(Action::ClearRecent), requests);
        }
    });
    ui.menu_button("Examples", |ui| {
        for example in Example::ALL {
            let button = ui.button(example.title()).on_hover_text(example.about());
            if button.clicked() {
                requests.push(Request::Do(Action::OpenExample(example)));
                ui.close();
            }
        }
    });
    ui.separator();
    let has_model = editor.session.model().is_some();
    item(ui, has_model, "Save project", Request::SaveProject, requests);
    item(ui, has_model, "Save project as…", Request::Ask(Purpose::SaveProject), requests);
    ui.separator();
    picture_entries(ui, editor, requests);
    ui.separator();
    let solved = editor.session.outcome().is_some();
    ui.menu_button("Export", |ui| {
        for (purpose, words, about) in EXPORTS {
            let button = ui.add_enabled(solved, Button::new(words)).on_hover_text(about);
            if button.clicked() {
                requests.push(Request::Ask(purpose));
                ui.close();
            }
        }
    });
    ui.menu_button("Size in files", |ui| {
        let fits =
            [(OutputFit::Unit, "Fit into the unit square"), (OutputFit::True, "True scale: the mesh's own area")];
        for (fit, words) in fits {
            choice(ui, editor.fit == fit, words, Request::SetFit(fit), requests);
        }
        ui.separator();
        ui.weak("With pins, coordinates stay as they are.");
    });
    ui.separator();
    item(ui, true, "Quit", Request::Quit, requests);
}

/// Picture and constraints come from files and go to files.
fn picture_entries(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let has_disk = editor.session.model().is_some_and(|model| model.disk().is_some());
    let has_pins = !editor.session.document().pins.is_empty();
    item(ui, has_disk, "Open picture…", Request::Ask(Purpose::OpenPicture), requests);
    item(ui, editor.has_picture(), "Remove picture", Request::Do(Action::RemovePicture), requests);
    item(ui, has_disk, "Import constraints…", Request::Ask(Purpose::ImportConstraints), requests);
    item(ui, has_pins, "Export constraints…", Request::Ask(Purpose::ExportConstraints), requests);
}

fn edit_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let history = editor.session.history();
    item(ui, history.can_undo(), "Undo", Request::Do(Action::Undo), requests);
    item(ui, history.can_redo(), "Redo", Request::Do(Action::Redo), requests);
    ui.separator();
    choice(ui, editor.tool == Tool::Select, "Select vertices", Request::SetTool(Tool::Select), requests);
    choice(ui, editor.tool == Tool::Fix, "Fix vertices", Request::SetTool(Tool::Fix), requests);
    let constrains = editor.tool == Tool::Constrain;
    choice(ui, constrains, "Constrain vertices", Request::SetTool(Tool::Constrain), requests);
    ui.separator();
    let fixable = !editor.selection.is_empty() && editor.session.outcome().is_some();
    let fix = Request::Do(Action::Fix(editor.selection.iter().copied().collect()));
    item(ui, fixable, "Fix the selection", fix, requests);
    item(ui, editor.selected_pins() > 0, "Free the selected pins", Request::UnpinSelected, requests);
    let pinned = !editor.session.document().pins.is_empty();
    item(ui, pinned, "Free all pins", Request::Do(Action::UnpinAll), requests);
    ui.separator();
    item(ui, pinned, "Mirror the targets", Request::Do(Action::MirrorTargets), requests);
    let several = editor.session.document().pins.len() > 1;
    item(ui, several, "Fit the targets to the mesh", Request::Do(Action::FitTargets), requests);
    let has_model = editor.session.model().is_some();
    item(ui, has_model, "Turn the faces around", Request::Do(Action::TurnFaces), requests);
}

fn view_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.menu_button("Shading", |ui| {
        for shading in Shading::ALL {
            choice(ui, editor.look.shading == shading, shading.title(), Request::SetShading(shading), requests);
        }
    });
    choice(ui, editor.look.wireframe, "Wireframe", Request::ToggleWireframe, requests);
    choice(ui, editor.look.is_sharp(), "Sharp pixels", Request::ToggleSharp, requests);
    choice(ui, editor.hull.shown, "Hull and pockets", Request::ToggleHull, requests);
    choice(ui, editor.look.magnifier, "Magnifier", Request::ToggleMagnifier, requests);
    choice(ui, editor.ease.wanted, "Glide from step to step", Request::ToggleEase, requests);
    choice(ui, editor.layout.panels_shown(), "Panels", Request::TogglePanels, requests);
    choice(ui, editor.timeline.curves_shown(), "Curves of the steps", Request::ToggleCurves, requests);
    ui.separator();
    item(ui, true, "Frame the selection, or all", Request::Frame, requests);
    item(ui, true, "Go to…", Request::AskGoTo, requests);
    let defects = editor.has_defects();
    item(ui, defects, "Next defect", Request::StepDefect(1), requests);
    item(ui, defects, "Previous defect", Request::StepDefect(-1), requests);
    ui.separator();
    ui.menu_button("Theme", |ui| {
        let now = ui.ctx().options(|options| options.theme_preference);
        let themes = [
            (egui::ThemePreference::System, "As the system"),
            (egui::ThemePreference::Light, "Light"),
            (egui::ThemePreference::Dark, "Dark"),
        ];
        for (theme, words) in themes {
            choice(ui, now == theme, words, Request::SetTheme(theme), requests);
        }
    });
}

fn solve_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let disk = editor.session.model().is_some_and(|model| model.disk().is_some());
    let session = &editor.session;
    let timeline = session.timeline();
    let shown = timeline.shown();
    item(ui, disk, "Take one step", Request::Do(Action::Step), requests);
    let (run, can_run) = if session.is_running() { ("Pause the run", true) } else { ("Run on", session.can_run()) };
    item(ui, can_run, run, Request::RunOrPause, requests);
    item(ui, session.can_relax(), "Relax", Request::Do(Action::Relax), requests);
    ui.separator();
    let has_previous = shown.and_then(|shown| timeline.previous_kept(shown)).is_some();
    let has_next = shown.and_then(|shown| timeline.next_kept(shown)).is_some();
    item(ui, has_previous, "First step", Request::GoToStep(StepTarget::First), requests);
    item(ui, has_previous, "Previous step", Request::GoToStep(StepTarget::Previous), requests);
    item(ui, has_next, "Next step", Request::GoToStep(StepTarget::Next), requests);
    item(ui, has_next, "Last step", Request::GoToStep(StepTarget::Last), requests);
    let play = if editor.timeline.playing_since.is_some() { "Stop the play" } else { "Play all steps" };
    item(ui, has_previous || has_next, play, Request::TogglePlay, requests);
    ui.separator();
    item(ui, disk, "Solve again", Request::Do(Action::Solve), requests);
    item(ui, editor.session.busy().is_some(), "Cancel", Request::Do(Action::Cancel), requests);
    ui.separator();
    item(ui, true, "Method and weights", Request::ShowTab(Tab::Method), requests);
}

/// What is open: name, vertices, faces.
fn title(editor: &Editor) -> String {
    let Some(model) = editor.session.model() else { return "Freebound".to_owned() };
    let mesh = model.mesh();
    let mark = if editor.session.has_unsaved_work() { "• " } else { "" };
    format!("{mark}{} · {} v · {} f", editor.document_name(), grouped(mesh.vertex_count()), grouped(mesh.face_count()))
}

/// A count with its thousands set apart by spaces.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut words = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            words.push(' ');
        }
        words.push(digit);
    }
    words
}
