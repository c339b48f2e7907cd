//! The bar at the top: menus, what is open, and the verdict.

use eframe::egui;
use egui::{Button, RichText, Role, WidgetInfo};

use super::theme::theme_of;
use super::{Editor, Request, Shading, Tab, Tool, keys_of};
use crate::examples::Example;
use crate::session::{Action, Busy, OutputFit, Surface};

/// Shows the bar.
pub(super) fn top_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.horizontal_centered(|ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| file_menu(ui, editor, requests));
            ui.menu_button("Edit", |ui| edit_menu(ui, editor, requests));
            ui.menu_button("View", |ui| view_menu(ui, editor, requests));
            ui.menu_button("Solve", |ui| solve_menu(ui, editor, requests));
            ui.menu_button("Help", |ui| item(ui, true, "All keys", Request::ToggleKeys, requests));
        });
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            verdict_pill(ui, editor, requests);
            ui.with_layout(
                egui::Layout::left_to_right(egui::Align::Center).with_main_align(egui::Align::Center),
                |ui| {
                    ui.add(egui::Label::new(RichText::new(title(editor)).color(theme_of(ui).weak_text)).truncate());
                },
            );
        });
    });
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
    item(ui, true, "Open…", Request::AskOpen, requests);
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
    let solved = editor.session.outcome().is_some();
    item(ui, solved, "Save with texture coordinates…", Request::AskSave, requests);
    item(ui, solved, "Export drawing or report…", Request::AskExport, requests);
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

fn edit_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let history = editor.session.history();
    item(ui, history.can_undo(), "Undo", Request::Do(Action::Undo), requests);
    item(ui, history.can_redo(), "Redo", Request::Do(Action::Redo), requests);
    ui.separator();
    choice(ui, editor.tool == Tool::Select, "Select vertices", Request::SetTool(Tool::Select), requests);
    choice(ui, editor.tool == Tool::Fix, "Fix vertices", Request::SetTool(Tool::Fix), requests);
    ui.separator();
    let fixable = !editor.selection.is_empty() && editor.session.outcome().is_some();
    let fix = Request::Do(Action::Fix(editor.selection.iter().copied().collect()));
    item(ui, fixable, "Fix the selection", fix, requests);
    item(ui, editor.selected_pins() > 0, "Free the selected pins", Request::UnpinSelected, requests);
    let pinned = !editor.session.document().pins.is_empty();
    item(ui, pinned, "Free all pins", Request::Do(Action::UnpinAll), requests);
}

fn view_menu(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    for shading in Shading::ALL {
        choice(ui, editor.shading == shading, shading.title(), Request::SetShading(shading), requests);
    }
    ui.separator();
    choice(ui, editor.wireframe, "Wireframe", Request::ToggleWireframe, requests);
    choice(ui, editor.panels_shown, "Panels", Request::TogglePanels, requests);
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
    item(ui, disk, "Solve again", Request::Do(Action::Solve), requests);
    item(ui, editor.session.busy().is_some(), "Cancel", Request::Do(Action::Cancel), requests);
    ui.separator();
    item(ui, true, "Method and weights", Request::ShowTab(Tab::Method), requests);
}

/// What is open: name, vertices, faces.
fn title(editor: &Editor) -> String {
    let Some(model) = editor.session.model() else { return "Freebound".to_owned() };
    let mesh = model.mesh();
    format!("{} · {} v · {} f", model.name, grouped(mesh.vertex_count()), grouped(mesh.face_count()))
}

/// A count with its thousands set apart by thin spaces.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut words = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            words.push('\u{2009}');
        }
        words.push(digit);
    }
    words
}

/// The truth at one glance: proved, wrong and how, being solved, or not up to date.
fn verdict_pill(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let theme = theme_of(ui);
    if let Some(busy) = editor.busy_for_long() {
        if ui.small_button("✖").on_hover_text("Stop").labelled("Stop the work in the background").clicked() {
            requests.push(Request::Do(Action::Cancel));
        }
        let words = match busy {
            Busy::Loading => "opening…".to_owned(),
            Busy::Solving(phase) => format!("solving… {}", phase.map_or("", crate::solver::Phase::words)),
            Busy::Saving => "saving…".to_owned(),
        };
        ui.label(RichText::new(words).color(theme.weak_text));
        ui.add(egui::Spinner::new().size(12.0));
        return;
    }
    let session = &editor.session;
    let (colour, words, tip) = match (session.model().map(|model| &model.surface), session.outcome()) {
        (None, _) => return,
        (Some(Surface::Faulty(_, diagnosis)), _) => {
            let count = diagnosis.faults.len();
            let words = if count == 1 { "✖ 1 fault".to_owned() } else { format!("✖ {count} faults") };
            (theme.flipped, words, "The bars over the mesh say what is wrong and what to do")
        }
        (Some(_), Some(outcome)) if session.is_current() => {
            if outcome.verdict.planar {
                (theme.planar, "✔ Planar: proved".to_owned(), "Exact arithmetic shows that no two faces overlap")
            } else {
                let keys = "Click for the next defect (D)";
                (theme.flipped, format!("✖ {}", outcome.verdict.summary()), keys)
            }
        }
        (Some(_), Some(_)) if session.busy().is_some() => {
            (theme.stale, "◌ following…".to_owned(), "The solve is on its way")
        }
        (Some(_), _) if session.busy().is_some() => {
            (theme.weak_text, "◌ solving…".to_owned(), "The solve is on its way")
        }
        (Some(_), _) => {
            (theme.stale, "⚠ not solved".to_owned(), "The embedding does not belong to these settings and pins")
        }
    };
    let button =
        Button::new(RichText::new(&words).color(colour).strong()).fill(colour.gamma_multiply(0.12)).corner_radius(10);
    let response = ui.add(button).on_hover_text(tip);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Verdict: {words}")));
    if response.clicked() {
        requests.push(if editor.has_defects() { Request::StepDefect(1) } else { Request::ShowTab(Tab::Defects) });
    }
}

/// Naming a control that shows only a sign.
trait Labelled {
    fn labelled(self, name: &str) -> Self;
}

impl Labelled for egui::Response {
    fn labelled(self, name: &str) -> Self {
        self.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
        self
    }
}
