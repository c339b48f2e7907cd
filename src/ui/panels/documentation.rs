//! Documentation window: the pages of the book at the right; their list, or what a search found, at the left.

use eframe::egui::{self, Align2, FontFamily, FontId, Id, Role, ScrollArea, TextStyle};
use egui_commonmark::CommonMarkViewer;

use crate::ui::documentation::{BookAnchor, PAGES, PageBlock, TITLES, find_sections};
use crate::ui::state::DocumentationView;
use crate::ui::{Control, Editor, theme_of};

/// Groups of the list, each with its first page.
const GROUPS: [(&str, &str); 3] =
    [("First steps", "introduction.md"), ("Reference", "window.md"), ("How it works", "how/paper.md")];

/// Size of the window, points.
const SIZE: [f32; 2] = [920.0, 640.0];

/// Share of the window for the list, and its limits, points.
const LIST: (f32, [f32; 2]) = (0.28, [150.0, 240.0]);

/// Size of the largest headings, points.
const HEADING: f32 = 21.0;

/// Shows the window if it is open.
pub(super) fn documentation(context: &egui::Context, editor: &mut Editor) {
    let Some(view) = &mut editor.layout.help.documentation else { return };
    let mut is_open = true;
    let room = context.content_rect().size() - egui::Vec2::new(48.0, 80.0);
    let window = egui::Window::new("Documentation").open(&mut is_open).collapsible(false);
    let window = window.default_size(room.min(SIZE.into())).max_size(room).pivot(Align2::CENTER_CENTER);
    window.default_pos(context.content_rect().center()).show(context, |ui| {
        let (share, [least, most]) = LIST;
        let width = (share * ui.available_width()).clamp(least, most);
        egui::Panel::left("documentation list").exact_size(width).resizable(false).show(ui, |ui| list(ui, view));
        egui::CentralPanel::default().show(ui, |ui| page(ui, view));
    });
    if !is_open {
        editor.layout.help.documentation = None;
    }
}

/// Search field, and the pages or the sections found.
fn list(ui: &mut egui::Ui, view: &mut DocumentationView) {
    let field = egui::TextEdit::singleline(&mut view.query).hint_text("Find").desired_width(f32::INFINITY);
    let field = ui.add(field).named(Role::SearchInput, "Find in the documentation");
    if !std::mem::replace(&mut view.has_focus, true) {
        field.request_focus();
    }
    if field.changed() {
        view.found = find_sections(&view.query);
    }
    ui.add_space(4.0);
    let is_search = !view.query.trim().is_empty();
    let mut goal = None;
    ScrollArea::vertical().id_salt("list").auto_shrink(false).show(ui, |ui| {
        if is_search && view.found.is_empty() {
            ui.label("No section has all these words.");
        }
        for section in view.found.iter().filter(|_| is_search) {
            let name = format!("{}: {}", TITLES[section.anchor.page], section.title);
            if ui.selectable_label(false, name).clicked() {
                goal = Some(section.anchor.clone());
            }
        }
        for (page, title) in TITLES.iter().enumerate().filter(|_| !is_search) {
            if let Some((group, _)) = GROUPS.iter().find(|(_, first)| *first == PAGES[page].path) {
                ui.add_space(4.0);
                ui.strong(*group);
            }
            if ui.selectable_label(view.page_number() == page, title).clicked() {
                goal = Some(BookAnchor { page, heading: None });
            }
        }
    });
    if let Some(goal) = goal {
        view.go_to(goal);
    }
}

/// Page, from the heading that was asked for.
fn page(ui: &mut egui::Ui, view: &mut DocumentationView) {
    if view.can_go_back() && ui.button("Back").on_hover_text("Return to the page before").clicked() {
        view.go_back();
    }
    let id = Id::unique("documentation page").with(view.page_number());
    let mut area = ScrollArea::vertical().id_salt(id).auto_shrink(false);
    match view.take_goal() {
        Some(BookAnchor { heading: Some(heading), .. }) => {
            for number in 0..view.shown.blocks.len() {
                view.cache.scroll_to_heading(&id.with(number), Some(heading.clone()));
            }
        }
        Some(BookAnchor { heading: None, .. }) => area = area.vertical_scroll_offset(0.0),
        None => {}
    }
    let mut clicked = None;
    area.show(ui, |ui| {
        // A jump to a section must not race through the page.
        ui.style_mut().scroll_animation = egui::style::ScrollAnimation::none();
        // Without it, links have the colour of links.
        ui.visuals_mut().override_text_color = None;
        ui.visuals_mut().widgets.noninteractive.fg_stroke.color = theme_of(ui).text;
        ui.style_mut().text_styles.insert(TextStyle::Heading, FontId::new(HEADING, FontFamily::Proportional));
        for (number, block) in view.shown.blocks.iter().enumerate() {
            match block {
                PageBlock::Text(text) => {
                    // Each block numbers its tables on its own.
                    ui.push_id(id.with(number), |ui| {
                        let viewer = CommonMarkViewer::new().enable_scroll_to_heading(true);
                        viewer.show_with_id(id.with(number), ui, &mut view.cache, text);
                    });
                    // The next block resets the links.
                    let is_clicked = |(link, _): &&(String, BookAnchor)| view.cache.get_link_hook(link) == Some(true);
                    clicked = clicked.or(view.shown.links.iter().find(is_clicked));
                }
                PageBlock::Code(lines) => code(ui, lines),
            }
        }
    });
    if let Some((_, goal)) = clicked.cloned() {
        view.go_to(goal);
    }
}

/// Lines of code, which can be selected and copied.
fn code(ui: &mut egui::Ui, lines: &str) {
    let fill = ui.visuals().code_bg_color;
    egui::Frame::new().fill(fill).corner_radius(4).inner_margin(8).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.add(egui::Label::new(egui::RichText::new(lines).monospace()).wrap().selectable(true));
    });
    ui.add_space(8.0);
}
