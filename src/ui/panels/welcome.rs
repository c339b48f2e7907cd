//! Welcome at a start without a file: purpose of the program, three ways to begin, and recent files.

use std::path::Path;

use eframe::egui::{self, Align, Align2, Layout, Response, RichText, Role, Sense, Vec2};

use crate::examples::Example;
use crate::session::Action;
use crate::ui::theme::HOVERED;
use crate::ui::{Control, Editor, FileDialogKind, Request, close_button, keys_of, theme_of};

/// Greatest width of the welcome, points.
const WIDTH: f32 = 580.0;

/// Height of a way to begin, points.
const CARD: f32 = 76.0;

/// Most recent files that are listed.
const RECENT: usize = 4;

/// Way to begin: its title, what it does, and its requests.
struct Beginning {
    title: &'static str,
    about: &'static str,
    requests: Vec<Request>,
}

fn beginnings() -> [Beginning; 3] {
    [
        Beginning {
            title: "Open a model…",
            about: "Opens unwrapped, with its map proved and packed",
            requests: vec![Request::Ask(FileDialogKind::Open)],
        },
        Beginning {
            title: "A photo on a face",
            about: "Built-in face and portrait, with a guided tour",
            requests: vec![Action::OpenExample(Example::Face).into(), Request::StartTour],
        },
        Beginning {
            title: "The paper's cube",
            about: "Watch a method flatten it, step by step",
            requests: vec![Action::OpenExample(Example::Cube).into()],
        },
    ]
}

/// Shows the welcome over the panes, until a way to begin is chosen or it is closed.
pub(in crate::ui) fn welcome(context: &egui::Context, editor: &mut Editor, requests: &mut Vec<Request>) {
    let opening = editor.session.model().map(|_| editor.session.opening_revision());
    let is_covered = editor.files.dialogs.is_open() || editor.layout.help.is_reading();
    if !editor.layout.welcome.is_shown_at(opening) || is_covered {
        return;
    }
    let editor = &*editor;
    let area = egui::Area::new(egui::Id::unique("welcome")).order(egui::Order::Foreground).movable(false);
    let shown = area.anchor(Align2::CENTER_CENTER, Vec2::ZERO).show(context, |ui| {
        egui::Frame::popup(ui.style()).fill(theme_of(ui).panel).inner_margin(20).show(ui, |ui| {
            ui.set_width(WIDTH.min(context.content_rect().width() - 80.0));
            contents(ui, editor, requests);
        });
    });
    if shown.response.clicked_elsewhere() {
        requests.push(Request::ToggleWelcome);
    }
}

fn contents(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("Freebound").size(20.0).strong());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let (square, _) = ui.allocate_exact_size(Vec2::splat(20.0), Sense::hover());
            let names = ["Close the welcome", "Close (Esc). Help has it again"];
            close_button(ui, ui.scope_id().with("close"), square, names).asks(Request::ToggleWelcome, requests);
        });
    });
    ui.label("Flattens a mesh into the plane without overlaps, and proves it.");
    ui.add_space(12.0);
    ways(ui, requests);
    recent(ui, editor, requests);
    ui.add_space(12.0);
    let mut at_start = editor.layout.welcome.at_start;
    let tip = "Show this welcome if the program starts without a file";
    ui.checkbox(&mut at_start, "Show at start").on_hover_text(tip).asks(Request::ToggleWelcomeAtStart, requests);
}

/// Ways to begin, side by side if there is room.
fn ways(ui: &mut egui::Ui, requests: &mut Vec<Request>) {
    let beginnings = beginnings();
    let gap = 8.0;
    let all = ui.available_width();
    let columns = if all < 420.0 { 1.0 } else { beginnings.len() as f32 };
    let size = Vec2::new((all - gap * (columns - 1.0)) / columns, if columns > 1.0 { CARD } else { CARD * 0.7 });
    let cards = |ui: &mut egui::Ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(gap);
        for (place, beginning) in beginnings.into_iter().enumerate() {
            let response = card(ui, size, &beginning, place == 0);
            // The card says what it does.
            let keys = beginning.requests.first().map(|request| keys_of(ui.ctx(), request)).unwrap_or_default();
            let response = if keys.is_empty() { response } else { response.on_hover_text(keys) };
            if response.clicked() {
                requests.push(Request::ToggleWelcome);
                requests.extend(beginning.requests);
            }
        }
    };
    if columns > 1.0 {
        ui.horizontal(cards)
    } else {
        ui.vertical(cards)
    };
}

fn card(ui: &mut egui::Ui, size: Vec2, beginning: &Beginning, is_primary: bool) -> Response {
    let theme = theme_of(ui);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let edge = if is_primary || response.has_focus() { theme.accent } else { theme.separator };
    if response.hovered() {
        ui.painter().rect_filled(rect, 6.0, theme.accent.gamma_multiply(HOVERED));
    }
    ui.painter().rect_stroke(rect, 6.0, egui::Stroke::new(1.5, edge), egui::StrokeKind::Inside);
    let inside = egui::UiBuilder::new().max_rect(rect.shrink(12.0)).layout(Layout::top_down(Align::Min));
    let mut inner = ui.new_child(inside);
    inner.spacing_mut().item_spacing.y = 4.0;
    let strong = RichText::new(beginning.title).strong();
    inner.add(egui::Label::new(strong).selectable(false).truncate());
    inner.add(egui::Label::new(RichText::new(beginning.about).color(theme.weak_text)).selectable(false).wrap());
    response.named(Role::Button, beginning.title)
}

/// Files opened last, if they still exist.
fn recent(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let paths = editor.session.recent().paths();
    if paths.is_empty() {
        return;
    }
    ui.add_space(12.0);
    ui.strong("Recent");
    for path in paths.iter().take(RECENT) {
        let name = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let folder = path.parent().map(Path::display).map(|folder| folder.to_string()).unwrap_or_default();
        ui.horizontal(|ui| {
            let file = name(path.file_name());
            let button = ui.add(egui::Button::new(RichText::new(&file).color(theme_of(ui).accent)).frame(false));
            let button = button.named(Role::Button, &format!("Open {file}"));
            if button.on_hover_text(format!("Open {}", path.display())).clicked() {
                requests.extend([Request::ToggleWelcome, Action::Open(path.clone()).into()]);
            }
            ui.add(egui::Label::new(RichText::new(folder).color(theme_of(ui).weak_text)).truncate());
        });
    }
}
