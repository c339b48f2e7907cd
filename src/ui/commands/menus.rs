//! Menus of the bar.

use eframe::egui::ThemePreference;

use super::{ALWAYS, Mark, MenuBuilder, MenuCommand, unless, when};
use crate::examples::Example;
use crate::session::{Action, LockState};
use crate::ui::state::{
    Axis, BAKED, COPY_COMMAND, COPY_LAYOUT, CheckerRequest, CheckerStyle, EXPORTS, ExportOptions, FileDialogKind,
    GestureKind, NO_LAYOUT_PICTURE, NO_MAP, PATTERN, PageRequest, Pane, Request, SQUARES, SeamRule, SelectBy,
    SelectionKind, ShadingMode, StepTarget, Tab, Tool,
};
use freebound_core::pipeline::Fit;

/// Reasons why entries are disabled.
const NO_MESH: &str = "Open a mesh first";
const NO_DISK: &str = "Open a mesh that can be flattened first";
const NO_PINS: &str = "Place a pin first";
const NO_SEAMS: &str = "There are no seams";
const NO_CHARTS: &str = "The mesh has a single chart";
const NO_ELEMENT: &str = "Select edges or faces first";
const NO_CHART: &str = "Select charts of the page that are not locked first";

/// Entry that cuts along the selection, and its description.
const CUT_SELECTION: [&str; 2] =
    ["Cut along the selection", "Cut along the selected edges, or around the selected faces"];

/// Entry that closes seams along the selection, and its description.
const JOIN_SELECTION: [&str; 2] = ["Join along the selection", "Close the seams along the selected edges"];

/// Entry that colours faces by a table, and its description.
const COLOUR_BY_COLUMN: [&str; 2] =
    ["Colour by column…", "Colour the faces by a CSV or TSV file with a row for each vertex or face"];

/// Function that fills a menu.
type Fill = fn(&mut MenuBuilder<'_>);

/// Menus of the bar: title and entries.
pub(in crate::ui) const MENUS: [(&str, Fill); 5] =
    [("File", file_menu), ("Edit", edit_menu), ("View", view_menu), ("Solve", solve_menu), ("Help", help_menu)];

fn help_menu(menu: &mut MenuBuilder<'_>) {
    menu.item(ALWAYS, "Documentation", Request::ShowDocumentation(None));
    menu.item(ALWAYS, "All keys", Request::ToggleKeys);
    menu.item(ALWAYS, "Guided tour", Request::StartTour);
    menu.item(ALWAYS, "Welcome", Request::ToggleWelcome);
    menu.item(ALWAYS, "Find a command…", Request::TogglePalette);
    menu.separator();
    menu.item(ALWAYS, "Messages of this run", Request::ToggleLog);
    menu.item(ALWAYS, "About Freebound", Request::ToggleAbout);
}

fn file_menu(menu: &mut MenuBuilder<'_>) {
    let editor = menu.editor;
    menu.item(ALWAYS, "Open…", Request::Ask(FileDialogKind::Open));
    menu.part("Recent", |menu| {
        let paths = editor.session.recent().paths();
        for path in paths {
            menu.item(ALWAYS, &path.display().to_string(), Action::Open(path.clone()));
        }
        if paths.is_empty() {
            menu.remark("No files yet");
        } else {
            menu.separator();
            menu.item(ALWAYS, "Clear this list", Action::ClearRecent);
        }
    });
    menu.part("Examples", |menu| {
        for example in Example::ALL {
            menu.explained(ALWAYS, [example.title(), example.about()], Action::OpenExample(example));
        }
    });
    menu.separator();
    let has_model = editor.session.model().is_some();
    menu.item(when(has_model, NO_MESH), "Save project", Request::SaveProject);
    menu.item(when(has_model, NO_MESH), "Save project as…", Request::Ask(FileDialogKind::SaveProject));
    menu.separator();
    // Picture and constraints are read from and written to files.
    let has_disk = editor.has_disk();
    menu.item(when(has_disk, NO_DISK), "Open picture…", Request::Ask(FileDialogKind::OpenPicture));
    menu.item(when(editor.has_picture(), "There is no picture"), "Remove picture", Action::RemovePicture);
    menu.explained(when(has_model, NO_MESH), COLOUR_BY_COLUMN, Request::Ask(FileDialogKind::OpenTable));
    menu.item(when(has_disk, NO_DISK), "Import constraints…", Request::Ask(FileDialogKind::ImportConstraints));
    let has_pins = !editor.session.document().targets.is_empty();
    menu.item(when(has_pins, NO_PINS), "Export constraints…", Request::Ask(FileDialogKind::ExportConstraints));
    menu.separator();
    let has_map = editor.session.outcome().is_some();
    menu.part("Export", |menu| {
        for (kind, words, about) in EXPORTS.into_iter().filter(|(kind, ..)| !kind.is_of_steps()) {
            menu.explained(when(has_map, NO_MAP), [words, about], Request::Ask(kind));
        }
        let baked = Request::ToggleOptions(ExportOptions::Baked);
        menu.explained(when(has_map && editor.session.can_bake(), NO_LAYOUT_PICTURE), BAKED, baked);
        menu.explained(when(has_map, NO_MAP), PATTERN, Request::ToggleOptions(ExportOptions::Pattern));
        menu.part("Steps and curves", |menu| {
            for (kind, words, about) in EXPORTS.into_iter().filter(|(kind, ..)| kind.is_of_steps()) {
                menu.explained(when(has_map, NO_MAP), [words, about], Request::Ask(kind));
            }
        });
        menu.separator();
        menu.explained(when(has_model, NO_MESH), COPY_COMMAND, Request::CopyCommandLine);
    });
    menu.part("Size in files", |menu| {
        let (unit, true_size) = (Fit::Unit, Fit::True);
        menu.choice(editor.files.fit == unit, "Fit into the unit square", Request::SetFit(unit));
        menu.choice(editor.files.fit == true_size, "True scale: the mesh's own area", Request::SetFit(true_size));
        menu.separator();
        menu.remark("With pins, coordinates are not scaled.");
    });
    menu.separator();
    menu.item(ALWAYS, "Quit", Request::Quit);
}

fn edit_menu(menu: &mut MenuBuilder<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    menu.item(when(session.history().can_undo(), "There is nothing to undo"), "Undo", Action::Undo);
    menu.item(when(session.history().can_redo(), "There is nothing to redo"), "Redo", Action::Redo);
    menu.separator();
    menu.part("Tools", |menu| {
        for tool in Tool::ALL {
            menu.choice(editor.tools.tool() == tool, tool.words()[2], Request::SetTool(tool));
        }
        menu.separator();
        menu.item(ALWAYS, "Make the brush larger", Request::ResizeBrush { grows: true });
        menu.item(ALWAYS, "Make the brush smaller", Request::ResizeBrush { grows: false });
    });
    menu.part("Select", select_menu);
    menu.part("Seams", seams_menu);
    if session.charts().is_some() {
        page_menu(menu);
    }
    menu.separator();
    menu.item(unless(editor.fix_hindrance()), "Fix the selection", Request::FixSelection);
    menu.item(unless(editor.unpin_hindrance()), "Free the selected pins", Request::UnpinSelected);
    menu.item(unless(editor.unpin_all_hindrance()), "Free all pins", Request::UnpinAll);
    let pin_count = session.document().targets.len();
    menu.separator();
    menu.item(when(pin_count > 0, NO_PINS), "Mirror the targets", Action::MirrorTargets);
    menu.item(when(pin_count > 1, "Place at least two pins first"), "Fit the targets to the mesh", Action::FitTargets);
    menu.item(when(session.model().is_some(), NO_MESH), "Reverse the faces", Action::TurnFaces);
}

/// Entries that select charts, vertices, edges or faces.
fn select_menu(menu: &mut MenuBuilder<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    menu.part("What clicks select", |menu| {
        let now = editor.selection_kind_shown();
        for kind in SelectionKind::ALL {
            let can_be = kind != SelectionKind::Charts || session.charts().is_some();
            let [words, about] = kind.words();
            let command = menu.command(when(can_be, NO_CHARTS), words, Request::SetSelectionKind(kind));
            menu.add(MenuCommand { mark: Mark::Choice(now == kind), ..command.has_tip(about) });
        }
    });
    for by in SelectBy::ALL {
        let allowed = when(editor.can_select_by(by), by.reason(editor.element_kind()));
        menu.explained(allowed, by.words(), Request::SelectBy(by));
    }
    menu.separator();
    menu.switch(editor.selection.through, "Through the mesh (X-ray)", Request::ToggleThrough);
}

/// Entries that cut the mesh along seams.
fn seams_menu(menu: &mut MenuBuilder<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    let has_model = session.model().is_some();
    menu.item(when(session.can_unwrap(), NO_MESH), "Unwrap: find short seams", Action::Unwrap(None));
    let degrees = editor.tools.seam.rules.degrees;
    let sharp = format!("Cut along sharp edges: {degrees:.0}° or more");
    menu.item(when(has_model, NO_MESH), &sharp, Request::CutByRule(SeamRule::Sharp(degrees)));
    menu.item(when(has_model, NO_MESH), "Cut along borders of materials", Request::CutByRule(SeamRule::Materials));
    menu.item(when(has_model, NO_MESH), "Cut along borders of groups", Request::CutByRule(SeamRule::Groups));
    let has_elements = !editor.selected_elements().is_empty();
    menu.explained(when(has_elements, NO_ELEMENT), CUT_SELECTION, Request::CutSelection);
    menu.explained(when(has_elements, NO_ELEMENT), JOIN_SELECTION, Request::JoinSelection);
    menu.separator();
    let has_seams = !session.seams().edges().is_empty();
    menu.explained(when(has_model, NO_MESH), COPY_LAYOUT, Request::Ask(FileDialogKind::CopyLayout));
    menu.item(when(has_model, NO_MESH), "Import seams…", Request::Ask(FileDialogKind::ImportSeams));
    let can_export = has_seams || !session.seams().automatic().is_empty();
    menu.item(when(can_export, NO_SEAMS), "Export seams…", Request::Ask(FileDialogKind::ExportSeams));
    menu.separator();
    menu.item(when(has_seams, NO_SEAMS), "Clear seams", Request::ClearSeams);
}

fn view_menu(menu: &mut MenuBuilder<'_>) {
    let editor = menu.editor;
    for pane in Pane::BOTH {
        menu.part(&format!("Shading of the {}", pane.title().to_lowercase()), |menu| {
            for shading in ShadingMode::ALL.into_iter().filter(|shading| shading.is_for(pane)) {
                let command = menu.command(ALWAYS, shading.title(), Request::SetPaneShading(pane, shading));
                let mark = Mark::Choice(editor.shading(pane) == shading);
                // Shortcuts shade the pane under the pointer; a menu entry names the pane.
                menu.add(MenuCommand { mark, ..command }.has_keys_of(Request::SetShading(shading)));
            }
            for (place, title) in editor.files.table.titles().enumerate() {
                let is_shown =
                    editor.shading(pane) == ShadingMode::Column && editor.files.table.chosen() == Some(place);
                menu.choice(is_shown, &format!("Column: {title}"), Request::ShowColumn(place));
            }
        });
    }
    checker_menu(menu);
    menu.switch(editor.pane_shading.wireframe, "Wireframe", Request::ToggleWireframe);
    menu.part("Show", |menu| {
        menu.switch(editor.plane.hull_shown(), "Hull and pockets", Request::ToggleHull);
        menu.switch(editor.pane_shading.magnifier, "Magnifier", Request::ToggleMagnifier);
        menu.switch(editor.timeline.curves_shown(), "Curves of the steps", Request::ToggleCurves);
        menu.switch(editor.pane_shading.glides, "Animate changes of step", Request::ToggleEase);
    });
    menu.part("Side panels", |menu| {
        menu.switch(editor.layout.panels_shown(), "Show the panels", Request::TogglePanels);
        menu.separator();
        for tab in Tab::ALL {
            menu.choice(editor.layout.shows(tab), tab.title(), Request::ShowTab(tab));
        }
    });
    menu.separator();
    menu.item(ALWAYS, "Frame the selection, or all", Request::Frame);
    menu.item(ALWAYS, "Go to…", Request::AskGoTo);
    let has_defects = editor.defect_count() > 0;
    menu.item(when(has_defects, "There are no defects"), "Next defect", Request::StepDefect(1));
    menu.item(when(has_defects, "There are no defects"), "Previous defect", Request::StepDefect(-1));
    if editor.session.charts().is_some() {
        let page = &editor.plane.page;
        let has_selected = editor.shows_page() && !(page.selected().is_empty() && page.elements().is_empty());
        menu.part("Charts", |menu| {
            menu.switch(editor.shows_page(), "All charts on the page", PageRequest::Toggle.into());
            menu.item(
                when(has_selected, "Select a chart of the page, or a part of it, first"),
                "Show one alone",
                PageRequest::Open(None),
            );
            menu.item(ALWAYS, "Next chart", Request::StepChart(1));
            menu.item(ALWAYS, "Previous chart", Request::StepChart(-1));
        });
    }
    menu.separator();
    menu.part("Theme", |menu| {
        use ThemePreference::{Dark, Light, System};
        let now = editor.gpu.context().options(|options| options.theme_preference);
        for (theme, words) in [(System, "System"), (Light, "Light"), (Dark, "Dark")] {
            menu.choice(now == theme, words, Request::SetTheme(theme));
        }
    });
}

/// Entries on the checker over the plane.
fn checker_menu(menu: &mut MenuBuilder<'_>) {
    let editor = menu.editor;
    let checker = &editor.pane_shading.checker;
    menu.part("Checker and pixels", |menu| {
        menu.switch(editor.pane_shading.is_sharp(), "Sharp pixels", Request::ToggleSharp);
        menu.separator();
        for style in CheckerStyle::ALL {
            let [words, tip] = style.words();
            let command = menu.command(ALWAYS, words, CheckerRequest::SetStyle(style)).has_tip(tip);
            menu.add(MenuCommand { mark: Mark::Choice(checker.style() == style), ..command });
        }
        menu.separator();
        let (shown, [least, most]) = (editor.squares_shown(), SQUARES);
        menu.item(when(shown < most, "There are no smaller squares"), "More squares", CheckerRequest::Finer);
        menu.item(when(shown > least, "There are no larger squares"), "Fewer squares", CheckerRequest::Coarser);
        menu.choice(checker.squares().is_none(), "Automatic squares", CheckerRequest::SetSquares(None).into());
    });
}

/// Entries on the charts of the page.
fn page_menu(menu: &mut MenuBuilder<'_>) {
    let editor = menu.editor;
    let can_move = editor.shows_page() && !editor.movable_charts().is_empty();
    let has_selected = editor.shows_page() && !editor.plane.page.selected().is_empty();
    let states: Vec<LockState> =
        editor.charts_to_work_on().into_iter().map(|chart| editor.session.lock_state(chart)).collect();
    let can_lock = states.contains(&LockState::Open);
    let can_change_lock = can_lock || states.contains(&LockState::Locked);
    let words = if can_lock || states.is_empty() { "Lock the charts" } else { "Unlock the charts" };
    menu.part("Arrange charts", |menu| {
        for kind in GestureKind::ALL {
            menu.item(when(can_move, NO_CHART), kind.title(), PageRequest::Begin(kind));
        }
        menu.item(when(can_move, NO_CHART), "Mirror left to right", PageRequest::Mirror(Axis::X));
        menu.item(when(can_move, NO_CHART), "Mirror top to bottom", PageRequest::Mirror(Axis::Y));
        menu.separator();
        menu.item(when(has_selected, NO_CHART), "Stack", PageRequest::Stack);
        menu.item(when(has_selected, NO_CHART), "Unstack", PageRequest::Unstack);
        menu.item(when(can_change_lock, NO_CHART), words, Request::ToggleLock);
        menu.item(editor.pack_hindrance().map_or(ALWAYS, Err), "Pack the selected charts, or all", PageRequest::Pack);
    });
}

fn solve_menu(menu: &mut MenuBuilder<'_>) {
    let (editor, session) = (menu.editor, &menu.editor.session);
    menu.item(when(editor.has_disk(), NO_DISK), "Take one step", Action::Step);
    let (run, can_run) =
        if session.is_running() { ("Pause the run", true) } else { ("Start the run", session.can_run()) };
    menu.item(when(can_run, "The method has no step left"), run, Request::RunOrPause);
    menu.item(when(session.can_repair(), "The map has no defect to repair"), "Repair", Action::Repair);
    menu.item(when(session.can_relax(), "Only a planar map can be relaxed"), "Relax", Action::Relax);
    menu.separator();
    let [has_previous, has_next] = editor.steps_around();
    menu.item(when(has_previous, "This is the first step"), "First step", Request::GoToStep(StepTarget::First));
    menu.item(when(has_previous, "This is the first step"), "Previous step", Request::GoToStep(StepTarget::Previous));
    menu.item(when(has_next, "This is the newest step"), "Next step", Request::GoToStep(StepTarget::Next));
    menu.item(when(has_next, "This is the newest step"), "Last step", Request::GoToStep(StepTarget::Last));
    let play = if editor.timeline.playing_since.is_some() { "Stop playing" } else { "Play all steps" };
    menu.item(when(has_previous || has_next, "There is only one step"), play, Request::TogglePlay);
    menu.separator();
    menu.item(when(editor.has_disk(), NO_DISK), "Solve from scratch", Action::Solve);
    menu.item(when(session.busy().is_some(), "No work is running"), "Stop the work", Action::Cancel);
    menu.separator();
    menu.item(ALWAYS, "Method and weights", Request::ShowTab(Tab::Method));
    let is_comparing = editor.plane.comparison.is_shown();
    let words = if is_comparing { "Leave the comparison" } else { "Compare methods…" };
    menu.item(when(is_comparing || editor.has_disk(), NO_DISK), words, Request::ToggleComparison);
}
