//! The bar at the top: menus, what is open, and the verdict.

use eframe::egui;
use egui::{Button, RichText, Role, WidgetInfo};

use super::exports::EXPORTS;
use super::icons::{self, Sign};
use super::theme::{Theme, theme_of};
use super::{Editor, Purpose, Request, Shading, StepTarget, Tab, Tool, keys_of};
use crate::examples::Example;
use crate::session::{Action, Busy, OutputFit, Surface};
use crate::solver::{Phase, Verdict};

/// Shows the bar.
pub(super) fn top_bar(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
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
            let panels = ui.selectable_label(editor.panels_shown(), "Panels");
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
            choice(ui, editor.shading == shading, shading.title(), Request::SetShading(shading), requests);
        }
    });
    choice(ui, editor.wireframe, "Wireframe", Request::ToggleWireframe, requests);
    let is_sharp = editor.picture.sampling == crate::render::Sampling::Sharp;
    choice(ui, is_sharp, "Sharp pixels", Request::ToggleSharp, requests);
    choice(ui, editor.hull.shown, "Hull and pockets", Request::ToggleHull, requests);
    choice(ui, editor.magnifier, "Magnifier", Request::ToggleMagnifier, requests);
    choice(ui, editor.ease.wanted, "Glide from step to step", Request::ToggleEase, requests);
    choice(ui, editor.panels_shown(), "Panels", Request::TogglePanels, requests);
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

/// What the pill says.
struct Pill {
    sign: Sign,
    colour: egui::Color32,
    words: String,
    tip: &'static str,
}

/// The truth at one glance: proved, wrong and how, being solved, or not up to date.
fn verdict_pill(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    if let Some(busy) = editor.busy_for_long() {
        if ui.small_button("Stop").on_hover_text("Stop the work in the background").clicked() {
            requests.push(Request::Do(Action::Cancel));
        }
        let words = match busy {
            Busy::Loading => "opening…".to_owned(),
            Busy::Solving(None | Some(Phase::Solve)) => "solving…".to_owned(),
            Busy::Solving(Some(phase)) => format!("solving… {}", phase.words()),
            Busy::Saving => "saving…".to_owned(),
        };
        ui.label(RichText::new(words).color(theme_of(ui).weak_text));
        ui.add(egui::Spinner::new().size(12.0));
        return;
    }
    let Some(pill) = pill(theme_of(ui), editor) else { return };
    if show_pill(ui, &pill).clicked() {
        requests.push(if editor.has_defects() { Request::StepDefect(1) } else { Request::ShowTab(Tab::Defects) });
    }
}

fn pill(theme: &Theme, editor: &Editor) -> Option<Pill> {
    let session = &editor.session;
    let model = session.model()?;
    if let Surface::Faulty(_, diagnosis) = &model.surface {
        let count = diagnosis.faults.len();
        let words = if count == 1 { "1 fault".to_owned() } else { format!("{count} faults") };
        let tip = "The bars over the mesh say what is wrong and what to do";
        return Some(Pill { sign: Sign::Bad, colour: theme.flipped, words, tip });
    }
    if session.is_preview() || session.preview().is_some() {
        let tip = "The first, linear step. What repairs it follows when the pointer rests or lets go";
        let words = preview_words(editor);
        return Some(Pill { sign: Sign::Warning, colour: theme.stale, words, tip });
    }
    let more_to_come = session.is_running() && session.timeline().records().len() <= 1;
    if more_to_come || (session.busy().is_some() && !session.is_current()) {
        let words = if session.outcome().is_some() && !more_to_come { "following…" } else { "solving…" };
        let tip = "The solve is on its way";
        return Some(Pill { sign: Sign::Working, colour: theme.weak_text, words: words.to_owned(), tip });
    }
    let Some(outcome) = session.outcome().filter(|_| session.is_current()) else {
        let tip = "The embedding does not belong to these settings and pins: press Solve";
        return Some(Pill { sign: Sign::Warning, colour: theme.stale, words: "not solved".to_owned(), tip });
    };
    Some(if outcome.step.verdict.planar {
        let tip = "Exact arithmetic shows that no two faces overlap";
        Pill { sign: Sign::Good, colour: theme.planar, words: "Planar: proved".to_owned(), tip }
    } else {
        let tip = "Not planar. Click for the next defect (D)";
        Pill { sign: Sign::Bad, colour: theme.flipped, words: short_verdict(&outcome.step.verdict), tip }
    })
}

/// What follows a drag, and what is known of it.
fn preview_words(editor: &Editor) -> String {
    let known = match editor.session.preview().map(crate::session::Preview::verdict) {
        None => return "preview, not repaired".to_owned(),
        Some(None) => "checking…".to_owned(),
        Some(Some(verdict)) if verdict.planar => "planar".to_owned(),
        Some(Some(verdict)) => short_verdict(verdict),
    };
    format!("preview, not repaired · {known}")
}

/// The verdict in the fewest words.
fn short_verdict(verdict: &Verdict) -> String {
    let counts = [
        (verdict.flipped_faces.len(), "flipped"),
        (verdict.boundary_crossings.len() + verdict.unlisted_crossings, "crossing"),
        (verdict.overwound_vertices.len(), "overwound"),
    ];
    let words = counts.iter().filter(|(count, _)| *count > 0).map(|(count, words)| {
        let plural = if *words == "crossing" && *count > 1 { "s" } else { "" };
        format!("{count} {words}{plural}")
    });
    words.collect::<Vec<_>>().join(" · ")
}

fn show_pill(ui: &mut egui::Ui, pill: &Pill) -> egui::Response {
    let text = egui::WidgetText::from(RichText::new(&pill.words).color(pill.colour).strong());
    let galley = text.into_galley(ui, None, f32::INFINITY, egui::TextStyle::Body);
    let size = galley.size() + egui::vec2(20.0 + SIGN + 6.0, 6.0);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    let strength = if response.hovered() { 0.24 } else { 0.13 };
    ui.painter().rect_filled(rect, rect.height() / 2.0, pill.colour.gamma_multiply(strength));
    if response.has_focus() {
        let stroke = egui::Stroke::new(1.0, pill.colour);
        ui.painter().rect_stroke(rect, rect.height() / 2.0, stroke, egui::StrokeKind::Inside);
    }
    let square =
        egui::Rect::from_center_size(rect.left_center() + egui::vec2(10.0 + SIGN / 2.0, 0.0), egui::Vec2::splat(SIGN));
    icons::sign(ui.painter(), square, pill.sign, pill.colour);
    let at = egui::pos2(square.right() + 6.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, pill.colour);
    let name = format!("Verdict: {}", pill.words);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    response.on_hover_text(pill.tip)
}

/// Side of the sign in the pill, points.
const SIGN: f32 = 11.0;
