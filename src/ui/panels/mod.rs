//! Everything around the panes: panels at the right, menus, tool bar, status bar.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the panel at the right with its tabs |
//! | `tool_bar.rs` | the tool bar at the left |
//! | `method_panel.rs`, `pins_panel.rs`, `defects_panel.rs`, `vertex_panel.rs` | one tab each |
//! | `hull_section.rs` | vertices outside the hull of their neighbours: in the tabs of defects and of the vertex |
//! | `boundary_rows.rs` | shape of the boundary: in the method tab |
//! | `charts_panel.rs` | tab of the charts of a mesh with several, and packing options |
//! | `diagnosis.rs` | faults of the mesh and their repairs: in the defects tab |
//! | `file_layout.rs` | findings about the layout of the file: in the defects tab |
//! | `parts.rs` | parts of a mesh, each kept or left out: in the defects tab |
//! | `welding.rs` | welding of vertices within a distance: in the defects tab |
//! | `surface.rs` | rows of tabs: charts and holes of the mesh, and the start of the map |
//! | `seams_section.rs` | unwrapping and the seams: in the tab of the charts |
//! | `compare_panel.rs` | numbers of two compared steps |
//! | `landmarks_section.rs` | landmarks that wait for a vertex: in the pins tab |
//! | `picture_panel.rs` | picture section of the pins tab |
//! | `equation_table.rs` | terms of a vertex's equation, as a table and in the embedding pane |
//! | `menu.rs`, `verdict_pill.rs` | the menu bar and the verdict in it |
//! | `quality.rs` | grade of the map, beside the verdict |
//! | `advice.rs` | next action, beside the verdict |
//! | `status.rs` | the status bar |
//! | `export_options.rs` | options of a cutting pattern, and of a picture drawn for the layout |
//! | `floating.rs` | "Go to", file dialog inside the window, exports, pictures of panes |
//! | `keys_window.rs` | list of keys and gestures; changes of keys |
//! | `palette.rs` | command palette |
//! | `documentation.rs` | documentation window |
//! | `about.rs` | About, and the messages of this run |
//! | `toast.rs` | success message, for a few seconds |
//! | `tour.rs` | card of the guided tour |
//! | `welcome.rs` | welcome at a start without a file |
//! | `large.rs` | the question before a large file is opened |
//! | `unsaved.rs` | the question about unsaved work, the window's title |

mod about;
mod advice;
mod boundary_rows;
mod charts_panel;
mod compare_panel;
mod defects_panel;
mod diagnosis;
mod documentation;
pub(super) mod equation_table;
mod export_options;
mod file_layout;
pub(super) mod floating;
mod hull_section;
mod keys_window;
mod landmarks_section;
mod large;
pub(super) mod menu;
pub(super) mod method_panel;
mod palette;
mod parts;
mod picture_panel;
mod pins_panel;
mod quality;
mod seams_section;
pub(super) mod status;
mod surface;
pub(super) mod toast;
mod tool_bar;
mod tour;
pub(super) mod unsaved;
mod verdict_pill;
mod vertex_panel;
pub(super) mod welcome;
mod welding;

use eframe::egui::text::LayoutJob;
use eframe::egui::{self, Align, FontSelection, RichText};

use super::{Control, Editor, Request, Tab};
pub(super) use tool_bar::{tool_bar, tool_bar_width};

/// Panel at the right: a row of tabs and the contents of the open tab.
pub(super) fn side_panel(ui: &mut egui::Ui, editor: &mut Editor, requests: &mut Vec<Request>) {
    let charts = editor.session.charts().map(|charts| charts.count());
    ui.horizontal_wrapped(|ui| {
        // Narrow buttons and small numbers, so that the fifth tab fits into the row.
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.spacing_mut().button_padding.x = 3.0;
        for tab in Tab::ALL {
            let count = match tab {
                Tab::Charts => charts.unwrap_or_default(),
                Tab::Pins => editor.session.document().targets.len(),
                Tab::Defects => editor.defect_count(),
                Tab::Method | Tab::Vertex => 0,
            };
            let mut words = LayoutJob::default();
            let mut append = |text: RichText| {
                text.append_to(&mut words, ui.style(), FontSelection::Default, Align::Center);
            };
            append(RichText::new(tab.title()));
            if count > 0 {
                append(RichText::new(format!(" {count}")).small());
            }
            ui.selectable_label(editor.layout.tab() == tab, words).asks(Request::ShowTab(tab), requests);
        }
    });
    ui.separator();
    match editor.layout.tab() {
        Tab::Method => scrolled(ui, |ui| method_panel::method_panel(ui, editor, requests)),
        Tab::Pins => pins_panel::pins_panel(ui, editor, requests),
        Tab::Defects => defects_panel::defects_panel(ui, editor, requests),
        Tab::Charts => {
            let panel = ui.max_rect();
            scrolled(ui, |ui| charts_panel::charts_panel(ui, editor, panel, requests));
        }
        Tab::Vertex => scrolled(ui, |ui| vertex_panel::vertex_panel(ui, editor, requests)),
    }
}

/// Scroll area for a tab that may be higher than the window.
fn scrolled(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, add);
}
