//! Documentation window: the pages of the book at the right; their list, or what a search found, at the left.

use eframe::egui::{self, Align, Align2, FontFamily, FontId, Id, Layout, Role, ScrollArea, TextStyle};
use egui_commonmark::{CommonMarkCache, CommonMarkViewer};

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

/// Gap between the columns of a table, and width of a letter, points.
const COLUMN_GAP: f32 = 12.0;
const LETTER: f32 = 6.8;

/// Least width of a column, points.
const LEAST_COLUMN: f32 = 40.0;

/// Least size of the window, points.
const LEAST_SIZE: [f32; 2] = [440.0, 200.0];

/// Size of the largest headings, points.
const HEADING: f32 = 21.0;

/// Shows the window if it is open.
pub(super) fn documentation(context: &egui::Context, editor: &mut Editor) {
    let Some(view) = &mut editor.layout.help.documentation else { return };
    let mut is_open = true;
    let room = context.content_rect().size() - egui::Vec2::new(48.0, 80.0);
    let window = egui::Window::new("Documentation").open(&mut is_open).collapsible(false);
    let window = window
        .default_size(room.min(SIZE.into()))
        .max_size(room)
        .min_size(room.min(LEAST_SIZE.into()))
        .pivot(Align2::CENTER_CENTER);
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
    let mut clicked: Option<BookAnchor> = None;
    area.show(ui, |ui| {
        // A jump to a section must not race through the page.
        ui.style_mut().scroll_animation = egui::style::ScrollAnimation::none();
        // Without it, links have the colour of links.
        ui.visuals_mut().override_text_color = None;
        ui.visuals_mut().widgets.noninteractive.fg_stroke.color = theme_of(ui).text;
        ui.style_mut().text_styles.insert(TextStyle::Heading, FontId::new(HEADING, FontFamily::Proportional));
        let mut written = Written { links: &view.shown.links, cache: &mut view.cache, clicked: None };
        for (number, block) in view.shown.blocks.iter().enumerate() {
            match block {
                PageBlock::Text(text) => written.text(ui, id.with(number), text),
                PageBlock::Code(lines) => code(ui, lines),
                PageBlock::Table(rows) => table(ui, id.with(number), rows, &mut written),
            }
        }
        clicked = written.clicked;
    });
    if let Some(goal) = clicked {
        view.go_to(goal);
    }
}

/// Writer of Markdown texts, with the link that was clicked.
struct Written<'a> {
    links: &'a [(String, BookAnchor)],
    cache: &'a mut CommonMarkCache,
    clicked: Option<BookAnchor>,
}

impl Written<'_> {
    fn text(&mut self, ui: &mut egui::Ui, id: Id, text: &str) {
        ui.push_id(id, |ui| {
            let viewer = CommonMarkViewer::new().enable_scroll_to_heading(true);
            viewer.show_with_id(id, ui, self.cache, text);
        });
        // The next text resets the links.
        let is_clicked = |(link, _): &&(String, BookAnchor)| self.cache.get_link_hook(link) == Some(true);
        let clicked = self.links.iter().find(is_clicked).map(|(_, goal)| goal.clone());
        self.clicked = clicked.or(self.clicked.take());
    }
}

/// Table with columns that share the width, and cells that wrap.
fn table(ui: &mut egui::Ui, id: Id, rows: &[Vec<String>], written: &mut Written<'_>) {
    let widths = column_widths(rows, ui.available_width());
    for (number, row) in rows.iter().enumerate() {
        let fill = if number % 2 == 1 { ui.visuals().faint_bg_color } else { egui::Color32::TRANSPARENT };
        egui::Frame::new().fill(fill).inner_margin(egui::Margin::symmetric(0, 3)).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = COLUMN_GAP;
                for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
                    let head = format!("**{cell}**");
                    let text = if number == 0 && !cell.is_empty() { &head } else { cell };
                    ui.allocate_ui_with_layout(egui::vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
                        ui.set_width(width);
                        written.text(ui, id.with((number, column)), text);
                    });
                }
            });
        });
    }
    ui.add_space(8.0);
}

/// Widths of the columns of a table: as wide as their texts, or less for the widest ones if there is too little room.
fn column_widths(rows: &[Vec<String>], room: f32) -> Vec<f32> {
    let count = rows.first().map_or(0, Vec::len);
    let of_column = |column: usize| rows.iter().filter_map(move |row| row.get(column));
    let longest = |column: usize| of_column(column).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let wanted: Vec<f32> = (0..count).map(|column| LETTER * longest(column) as f32 + COLUMN_GAP).collect();
    let mut left = room - COLUMN_GAP * count.saturating_sub(1) as f32;
    let mut widths = vec![0.0; count];
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    for (place, column) in order.into_iter().enumerate() {
        // Narrow columns come first. What they do not need goes to the others.
        widths[column] = wanted[column].min((left / (count - place) as f32).max(LEAST_COLUMN));
        left -= widths[column];
    }
    widths
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_share_any_room_and_are_never_without_width() {
        let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>();
        let long = "a cell with many words that wrap in several lines";
        for rows in [vec![row(&["a", long])], vec![row(&["", "b", long, long]), row(&[long, "", "c", "d"])]] {
            let count = rows[0].len() as f32;
            for room in 0..1000 {
                let room = room as f32;
                let widths = column_widths(&rows, room);
                let sum: f32 = widths.iter().sum::<f32>() + COLUMN_GAP * (count - 1.0);
                assert!(widths.iter().all(|width| *width > 0.0), "{room}: {widths:?}");
                let least = count * LEAST_COLUMN + COLUMN_GAP * (count - 1.0);
                assert!(sum <= room.max(least) + 0.01, "{room}: {widths:?}");
            }
        }
    }
}
