//! Drawing of the file dialog inside the window.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use eframe::egui::{
    self, Align, Button, Id, Key, Layout, Modifiers, Rect, RichText, Role, Sense, Ui, Vec2, WidgetInfo,
};

use super::browser::{Browser, DialogAnswer};
use super::listing::{Entry, ListColumn, date_words, size_words};
use crate::session::KeptFolders;
use crate::ui::theme::{HOVERED, SELECTED};
use crate::ui::{Control, accented, accented_if, icons, remark, theme_of};

/// Height of a row, points.
const ROW: f32 = 22.0;

/// Greatest size of the dialog, points.
const LARGEST: Vec2 = Vec2::new(780.0, 560.0);

/// Room that the window leaves around the dialog, points.
const MARGIN: Vec2 = Vec2::new(40.0, 36.0);

/// Room under the list for name, remark and buttons, points.
const BELOW: f32 = 70.0;

/// Widths of the columns beside the name, points, and least widths of the list that shows them.
const SIZE: f32 = 70.0;
const DATE: f32 = 90.0;
const KIND: f32 = 96.0;
const SHOWS_DATE: f32 = 340.0;
const SHOWS_KIND: f32 = 450.0;

/// Distance of a number from the next column, points.
const GAP: f32 = 18.0;

/// Width of the folders at the left, as a share of the dialog.
const PLACES: f32 = 0.22;

/// Field that narrows the list.
fn filter_id() -> Id {
    Id::unique("filter of the file dialog")
}

/// Field of the name.
fn name_id() -> Id {
    Id::unique("name in the file dialog")
}

/// Place of each column in a row.
struct Cells {
    name: Rect,
    size: Rect,
    date: Option<Rect>,
    kind: Option<Rect>,
}

impl Cells {
    fn of(row: Rect) -> Self {
        let mut rest = row.shrink2(Vec2::new(6.0, 0.0));
        let mut take = |width: f32, from: f32| {
            (row.width() >= from).then(|| {
                let (left, right) = rest.split_left_right_at_x(rest.right() - width);
                rest = left;
                right
            })
        };
        let kind = take(KIND, SHOWS_KIND);
        let date = take(DATE, SHOWS_DATE);
        let size = take(SIZE, 0.0).unwrap_or(row);
        Self { name: rest, size, date, kind }
    }

    fn of_column(&self, column: ListColumn) -> Option<Rect> {
        match column {
            ListColumn::Name => Some(self.name),
            ListColumn::Size => Some(self.size),
            ListColumn::Date => self.date,
            ListColumn::Kind => self.kind,
        }
    }
}

impl Browser {
    /// Shows the dialog. Returns the answer once there is one.
    pub(super) fn show(&mut self, context: &egui::Context, folders: &mut KeptFolders) -> Option<DialogAnswer> {
        let form = self.form();
        self.listing.poll(&form);
        self.take_keys(context);
        let size = (context.content_rect().size() - MARGIN).min(LARGEST);
        egui::Modal::new(Id::unique("file dialog")).show(context, |ui| {
            ui.set_min_size(size - Vec2::splat(12.0));
            ui.set_max_size(size - Vec2::splat(12.0));
            self.contents(ui, folders);
        });
        self.answer.take()
    }

    /// Keys of the list: arrows, Enter, and the way up. A text or a button with the focus keeps what it needs. Letters go
    /// to the filter of a dialog that opens, and to the name of one that saves.
    fn take_keys(&mut self, context: &egui::Context) {
        let focused = context.memory(egui::Memory::focused);
        let is_ours = focused.is_none_or(|id| id == filter_id() || id == name_id());
        let field = if self.kind.is_reading() { filter_id() } else { name_id() };
        let has_no_text = focused.is_none() && self.kind.is_reading();
        let is_empty = has_no_text || (focused == Some(filter_id()) && self.listing.filter.is_empty());
        let pressed = |key| context.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let mut goes_up = context.input_mut(|input| input.consume_key(Modifiers::ALT, Key::ArrowUp));
        goes_up |= is_empty && pressed(Key::Backspace);
        if goes_up {
            self.go_up();
        }
        if !is_ours {
            return;
        }
        for (key, by) in [(Key::ArrowDown, 1), (Key::ArrowUp, -1), (Key::PageDown, 10), (Key::PageUp, -10)] {
            let count = context.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
            (0..count).for_each(|_| self.step(by));
        }
        if self.overwrite.is_none() && pressed(Key::Enter) {
            if focused == Some(name_id()) { self.confirm() } else { self.open_selected() }
        }
        let types = context.input(|input| input.events.iter().any(|event| matches!(event, egui::Event::Text(_))));
        if focused.is_none() && types {
            context.memory_mut(|memory| memory.request_focus(field));
        }
    }

    fn contents(&mut self, ui: &mut Ui, folders: &mut KeptFolders) {
        ui.horizontal(|ui| {
            ui.strong(self.form().title);
        });
        ui.horizontal(|ui| self.way_ui(ui, folders));
        ui.horizontal(|ui| self.filter_ui(ui));
        ui.add_space(2.0);
        let all = ui.available_rect_before_wrap();
        let all = all.with_max_y(all.bottom() - BELOW);
        let (left, right) = all.split_left_right_at_fraction(PLACES);
        ui.scope_builder(egui::UiBuilder::new().max_rect(left), |ui| self.places_ui(ui, folders));
        ui.scope_builder(egui::UiBuilder::new().max_rect(right.with_min_x(right.left() + 8.0)), |ui| {
            ui.set_clip_rect(right.intersect(ui.clip_rect()));
            self.list_ui(ui);
        });
        ui.advance_cursor_after_rect(all);
        ui.separator();
        if let Some(path) = self.overwrite.clone() {
            self.question_ui(ui, path);
        } else {
            ui.horizontal(|ui| self.name_ui(ui));
            self.buttons(ui);
        }
    }

    /// The way to the folder: Up, and a button for each folder above.
    fn way_ui(&mut self, ui: &mut Ui, folders: &mut KeptFolders) {
        let has_parent = self.folder.parent().is_some();
        let up = ui.add_enabled(has_parent, Button::new("Up"));
        if up.on_hover_text("Open the parent folder (Backspace, Alt+Up)").clicked() {
            self.go_up();
        }
        let is_pinned = folders.pinned.contains(&self.folder);
        let (words, tip) = if is_pinned {
            ("Unpin folder", "Remove this folder from the list at the left")
        } else {
            ("Pin folder", "Keep this folder in the list at the left")
        };
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let pin = ui.button(words).named(Role::Button, &words.replace("folder", "this folder"));
            if pin.on_hover_text(tip).clicked() {
                folders.toggle_pin(&self.folder);
            }
            let way = egui::ScrollArea::horizontal()
                .scroll_bar_visibility(egui::scroll_area::ScrollBarVisibility::AlwaysHidden)
                .stick_to_right(true);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                way.show(ui, |ui| ui.horizontal(|ui| self.crumbs(ui)));
            });
        });
    }

    fn crumbs(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.x = 2.0;
        let mut above: Vec<&Path> = self.folder.ancestors().collect();
        above.reverse();
        let mut wanted = None;
        for (place, folder) in above.iter().enumerate() {
            let name = folder
                .file_name()
                .map_or_else(|| folder.display().to_string(), |name| name.to_string_lossy().into_owned());
            if place > 1 {
                ui.weak("›");
            }
            let path = folder.display().to_string();
            let button = ui.add(Button::new(name).frame(false)).named(Role::Button, &format!("Go to {path}"));
            if button.on_hover_text(path).clicked() && *folder != self.folder {
                wanted = Some(folder.to_path_buf());
            }
        }
        if let Some(folder) = wanted {
            self.enter(folder);
        }
    }

    fn filter_ui(&mut self, ui: &mut Ui) {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let tip = "List files of all kinds, and hidden ones";
            let all = ui.checkbox(&mut self.listing.shows_all, "All files").on_hover_text(tip);
            let field = egui::TextEdit::singleline(&mut self.listing.filter)
                .id(filter_id())
                .hint_text("Filter: type words of the name")
                .desired_width(f32::INFINITY);
            let field = ui.add(field).named(Role::SearchInput, "Filter");
            if self.is_fresh && self.kind.is_reading() {
                field.request_focus();
            }
            if field.changed() || all.changed() {
                self.arrange();
            }
        });
    }

    /// Folders at the left: home, pinned, recent.
    fn places_ui(&mut self, ui: &mut Ui, folders: &KeptFolders) {
        let mut wanted = None;
        egui::ScrollArea::vertical().id_salt("places").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            if let Some(home) = std::env::home_dir().filter(|home| home.is_absolute()) {
                self.place_ui(ui, &home, "Home", &mut wanted);
            }
            for (title, kind, list) in
                [("Pinned", "Pinned folder", &folders.pinned), ("Recent", "Recent folder", &folders.recent)]
            {
                if !list.is_empty() {
                    ui.add_space(6.0);
                    remark(ui, title);
                }
                for folder in list {
                    self.place_ui(ui, folder, kind, &mut wanted);
                }
            }
        });
        if let Some(folder) = wanted {
            self.enter(folder);
        }
    }

    fn place_ui(&self, ui: &mut Ui, folder: &Path, kind: &str, wanted: &mut Option<PathBuf>) {
        let path = folder.display().to_string();
        let name = folder.file_name().map_or_else(|| path.clone(), |name| name.to_string_lossy().into_owned());
        let is_home = kind == "Home";
        let (shown, spoken) =
            if is_home { (kind.to_owned(), kind.to_owned()) } else { (name, format!("{kind} {path}")) };
        let is_here = folder == self.folder;
        let button = ui.add(Button::selectable(is_here, shown).truncate());
        if button.named(Role::Button, &spoken).on_hover_text(path).clicked() && !is_here {
            *wanted = Some(folder.to_owned());
        }
    }

    /// Heads of the columns, and the rows in sight.
    fn list_ui(&mut self, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.y = 0.0;
        let (head, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
        self.heads(ui, &Cells::of(head));
        let theme = theme_of(ui);
        ui.painter().hline(head.x_range(), head.bottom(), egui::Stroke::new(1.0, theme.separator));
        if self.listing.len() == 0 {
            return self.empty_ui(ui);
        }
        let rows = self.listing.len();
        let target = std::mem::take(&mut self.follows).then(|| self.selected.clone()).flatten();
        let target = target.and_then(|name| self.listing.row_of(&name));
        let mut clicked = None;
        let area = egui::ScrollArea::vertical().id_salt(&self.folder).auto_shrink(false);
        area.show_rows(ui, ROW, rows, |ui, range| {
            let top = ui.max_rect().top();
            if let Some(row) = target {
                let offset = (row as f32 - range.start as f32) * ROW;
                let place = Rect::from_min_size(egui::pos2(ui.max_rect().left(), top + offset), Vec2::new(1.0, ROW));
                ui.scroll_to_rect_animation(place, None, egui::style::ScrollAnimation::none());
            }
            let now = SystemTime::now();
            for row in range {
                if self.row_ui(ui, row, now) {
                    clicked = Some(row);
                }
            }
        });
        if let Some(row) = clicked {
            let time = ui.input(|input| input.time);
            let delay = ui.ctx().options(|options| options.input_options.max_double_click_delay);
            self.click(row, time, delay);
        }
    }

    fn heads(&mut self, ui: &mut Ui, cells: &Cells) {
        let theme = theme_of(ui);
        let order = self.listing.order;
        for column in ListColumn::ALL {
            let Some(rect) = cells.of_column(column) else { continue };
            let response = ui.interact(rect, ui.scope_id().with(column.title()), Sense::click());
            let colour = if response.hovered() || response.has_focus() { theme.text } else { theme.weak_text };
            let is_sorted = column == order.column;
            let (at, align) = match column {
                ListColumn::Size => (rect.right_center() - Vec2::new(GAP, 0.0), egui::Align2::RIGHT_CENTER),
                _ => (rect.left_center(), egui::Align2::LEFT_CENTER),
            };
            let text = ui.painter().text(at, align, column.title(), egui::TextStyle::Small.resolve(ui.style()), colour);
            if is_sorted {
                let middle = egui::pos2(text.right() + 9.0, rect.center().y);
                icons::order(ui.painter(), Rect::from_center_size(middle, Vec2::splat(7.0)), order.direction, colour);
            }
            let name = format!("Sort by {}", column.title().to_lowercase());
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_sorted, &name));
            if response.on_hover_text("Sort by this column; click again to reverse").clicked() {
                self.sort_by(column);
            }
        }
    }

    /// Row of the list. Returns true if it was clicked.
    fn row_ui(&self, ui: &mut Ui, row: usize, now: SystemTime) -> bool {
        // No focus of its own: the arrows move the selection.
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::CLICK);
        let Some(entry) = self.listing.row(row) else { return false };
        let is_selected = self.selected.as_ref() == Some(&entry.name);
        let theme = theme_of(ui);
        if is_selected || response.hovered() {
            let share = if is_selected { SELECTED } else { HOVERED };
            ui.painter().rect_filled(rect, 4.0, theme.accent.gamma_multiply(share));
        }
        let cells = Cells::of(rect);
        let square = Rect::from_center_size(cells.name.left_center() + Vec2::new(8.0, 0.0), Vec2::splat(15.0));
        let colour = if entry.is_folder() { theme.accent } else { theme.weak_text };
        icons::file(ui.painter(), square, entry.sign, colour);
        let name = spoken_name(entry);
        cell(ui, cells.name.with_min_x(cells.name.left() + 22.0), &name, theme.text);
        let modified = entry.modified.map(|modified| date_words(modified, now)).unwrap_or_default();
        let size = entry.size.map(size_words).unwrap_or_default();
        number(ui, cells.size, &size);
        cells.date.into_iter().for_each(|place| cell(ui, place, &modified, theme.weak_text));
        cells.kind.into_iter().for_each(|place| cell(ui, place, &entry.kind, theme.weak_text));
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_selected, &name));
        response.clicked()
    }

    /// Words in place of rows: the kinds of files listed, and the way to others.
    fn empty_ui(&mut self, ui: &mut Ui) {
        ui.add_space(8.0);
        let (unlisted, form) = (self.listing.unlisted, self.form());
        if self.listing.is_busy() {
            ui.weak("Listing…");
        } else if let Some(problem) = &self.listing.problem {
            ui.colored_label(theme_of(ui).flipped, problem);
        } else if unlisted.filtered > 0 {
            ui.weak(format!("No name contains “{}”.", self.listing.filter));
            if ui.button("Clear the filter").clicked() {
                self.listing.filter.clear();
                self.arrange();
            }
        } else if unlisted.of_other_kinds > 0 {
            let kinds = form.extensions.join(", ");
            ui.add(egui::Label::new(RichText::new(format!("{} are listed ({kinds}): none here.", form.files)).weak()));
            let count = unlisted.of_other_kinds;
            if ui.button(format!("Show all {count}")).on_hover_text("Switch on “All files”").clicked() {
                self.listing.shows_all = true;
                self.arrange();
            }
        } else {
            ui.weak("This folder is empty.");
        }
    }

    fn name_ui(&mut self, ui: &mut Ui) {
        let label = ui.label("Name");
        let field = egui::TextEdit::singleline(&mut self.name).id(name_id()).desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label.id);
        if self.is_fresh && !self.kind.is_reading() {
            field.request_focus();
        }
        self.is_fresh = false;
        if field.changed() {
            (self.selected, self.refusal) = (None, None);
        }
    }

    fn buttons(&mut self, ui: &mut Ui) {
        let words = self.form().title.split(' ').next().unwrap_or_default();
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if accented_if(ui, self.can_confirm(), words, theme_of(ui)).clicked() {
                self.confirm();
            }
            if ui.button("Cancel").on_hover_text("Close this dialog (Esc)").clicked() {
                self.answer = Some(DialogAnswer::Cancelled);
            }
            if let Some(refusal) = &self.refusal {
                let words = RichText::new(refusal).color(theme_of(ui).flipped);
                ui.add(egui::Label::new(words).truncate());
            }
        });
    }

    /// Question about a file that exists, in place of name and button.
    fn question_ui(&mut self, ui: &mut Ui, path: PathBuf) {
        let name = super::name_of(&path);
        ui.add(egui::Label::new(format!("{name} exists already. Replace it? Its content is lost.")).truncate());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.add(accented("Replace", theme_of(ui))).clicked() {
                self.choose(path);
            }
            if ui.button("Keep").on_hover_text("Keep the file and choose another name (Esc)").clicked() {
                self.leave_question();
            }
        });
    }
}

/// Name of an entry; a folder's ends with a slash.
fn spoken_name(entry: &Entry) -> String {
    if entry.is_folder() { format!("{}/", entry.name) } else { entry.name.clone() }
}

/// Number in a cell, at its right.
fn number(ui: &Ui, rect: Rect, words: &str) {
    let (font, colour) = (egui::TextStyle::Body.resolve(ui.style()), theme_of(ui).weak_text);
    ui.painter().text(rect.right_center() - Vec2::new(GAP, 0.0), egui::Align2::RIGHT_CENTER, words, font, colour);
}

/// Text in a cell, cut to its width.
fn cell(ui: &Ui, rect: Rect, words: &str, colour: egui::Color32) {
    let text = egui::WidgetText::from(RichText::new(words).color(colour));
    let width = rect.width() - 6.0;
    let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), width.max(8.0), egui::TextStyle::Body);
    let place = egui::pos2(rect.left(), rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(place, galley, colour);
}
