//! Importing and exporting files through the window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::session::{Action, SaveRequest, Severity};
use freebound_core::geom::Picture;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Fit;
use freebound_io::{LengthUnit, OutputKind, PatternPaper, PictureFile, read_mesh};

use crate::harness::{SIZE, Window, sheet, write_obj};
use crate::pictures::open_picture;
use freebound_testkit::assert_message;

pub(crate) fn window() -> Window {
    Window::with_mesh("sheet.obj", &sheet(6, 0.3))
}

pub(crate) fn ask_where_to_save(window: &mut Window) {
    window.menu(&["File", "Export", "Mesh with texture coordinates…"]);
}

pub(crate) fn name(window: &Window) -> String {
    window.editor().session.model().map(|model| model.name.clone()).unwrap_or_default()
}

#[test]
fn a_mesh_is_opened_through_the_dialog() {
    let mut window = window();
    write_obj(&window.path("second.obj"), &sheet(4, 0.0));
    std::fs::write(window.path("notes.txt"), "no mesh").unwrap();
    window.press(Modifiers::COMMAND, Key::O);
    assert!(window.editor().files.dialogs.is_open());
    assert!(window.has_button("second.obj") && window.has_button("sheet.obj"));
    assert!(!window.has_button("notes.txt"), "only meshes are listed");
    window.click("second.obj");
    window.click("Open");
    assert_eq!(name(&window), "second.obj");
    assert!(!window.editor().files.dialogs.is_open());
}

#[test]
fn a_name_can_be_typed_into_the_dialog() {
    let mut window = window();
    write_obj(&window.path("second.obj"), &sheet(4, 0.0));
    window.press(Modifiers::COMMAND, Key::O);
    window.fill_in(Role::TextInput, "Name", "second.obj");
    window.key(Key::Enter);
    assert_eq!(name(&window), "second.obj");
}

#[test]
fn the_dialog_walks_through_folders() {
    let mut window = window();
    std::fs::create_dir(window.path("deep")).unwrap();
    write_obj(&window.path("deep/third.obj"), &sheet(4, 0.0));
    window.press(Modifiers::COMMAND, Key::O);
    window.click("deep/");
    assert!(window.has_button("sheet.obj") && !window.has_button("third.obj"), "one click only selects");
    window.click("Open");
    assert!(window.has_button("third.obj"));
    window.click("Up");
    assert!(window.has_button("sheet.obj"));
    double_click(&mut window, "deep/");
    assert!(window.has_button("third.obj"));
    window.click(&format!("Go to {}", folder_of(&window)));
    assert!(window.has_button("sheet.obj"));
    double_click(&mut window, "deep/");
    double_click(&mut window, "third.obj");
    assert_eq!(name(&window), "third.obj");
}

/// Folder of the window's files, as the dialog names it.
fn folder_of(window: &Window) -> String {
    window.path("").canonicalize().expect("a folder").display().to_string()
}

fn row(window: &Window, name: &str) -> egui::Rect {
    window.rect(Role::Button, name)
}

fn double_click(window: &mut Window, name: &str) {
    // Long after the click before.
    window.frame_after(0.5, []);
    let at = row(window, name).center();
    window.double_click_at(at);
}

/// Names of the files and folders that the dialog lists, from top to bottom.
fn listed(window: &Window) -> Vec<String> {
    let is_row = |name: &str| name.ends_with('/') || name.contains('.');
    let mut rows: Vec<(Role, String, egui::Rect)> = window.controls();
    rows.retain(|(role, name, rect)| {
        *role == Role::Button && is_row(name) && !name.contains(' ') && rect.width() > 300.0
    });
    rows.sort_by(|a, b| a.2.top().total_cmp(&b.2.top()));
    rows.into_iter().map(|(_, name, _)| name).collect()
}

#[test]
fn a_click_that_enters_a_folder_never_chooses_a_file_in_it() {
    let mut window = window();
    std::fs::create_dir(window.path("deep")).unwrap();
    write_obj(&window.path("deep/third.obj"), &sheet(4, 0.0));
    window.press(Modifiers::COMMAND, Key::O);
    let at = row(&window, "deep/").center();
    window.harness.hover_at(at);
    window.step();
    // Four clicks in quick succession: the second enters the folder, where a file appears under the pointer.
    for pressed in [true, false, true, false, true, false, true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, Modifiers::NONE);
        window.frame_after(0.02, [egui::Event::PointerButton { pos: at, button, pressed, modifiers }]);
        while window.editor().files.dialogs.is_listing() {
            std::thread::sleep(std::time::Duration::from_millis(1));
            window.frame_after(0.0, []);
        }
    }
    window.settle();
    assert_eq!(listed(&window), ["third.obj"]);
    assert!(row(&window, "third.obj").contains(at), "the file lies where the folder was");
    assert!(window.editor().files.dialogs.is_open() && !window.is_enabled("Open"), "nothing is selected");
    assert_eq!(name(&window), "sheet.obj");
}

#[test]
fn two_clicks_on_two_files_only_select() {
    let mut window = window();
    write_obj(&window.path("second.obj"), &sheet(4, 0.0));
    window.press(Modifiers::COMMAND, Key::O);
    for name in ["second.obj", "sheet.obj"] {
        let pos = row(&window, name).center();
        window.harness.hover_at(pos);
        for pressed in [true, false] {
            let (button, modifiers) = (egui::PointerButton::Primary, Modifiers::NONE);
            window.frame_after(0.02, [egui::Event::PointerButton { pos, button, pressed, modifiers }]);
        }
    }
    window.settle();
    assert!(window.editor().files.dialogs.is_open());
    window.click("Open");
    assert_eq!(name(&window), "sheet.obj");
}

#[test]
fn keys_walk_through_the_dialog() {
    let mut window = window();
    for (folder, file) in [("alpha", "one.obj"), ("beta", "two.obj")] {
        std::fs::create_dir(window.path(folder)).unwrap();
        write_obj(&window.path(&format!("{folder}/{file}")), &sheet(4, 0.0));
    }
    window.press(Modifiers::COMMAND, Key::O);
    assert_eq!(listed(&window), ["alpha/", "beta/", "sheet.obj"]);
    window.key(Key::ArrowDown);
    window.key(Key::ArrowDown);
    window.key(Key::Enter);
    assert_eq!(listed(&window), ["two.obj"]);
    window.key(Key::Backspace);
    assert_eq!(listed(&window), ["alpha/", "beta/", "sheet.obj"]);
    // The folder that was left is selected.
    window.key(Key::ArrowUp);
    window.key(Key::Enter);
    assert_eq!(listed(&window), ["one.obj"]);
    window.press(Modifiers::ALT, Key::ArrowUp);
    window.type_text("two");
    window.settle();
    assert_eq!(listed(&window), Vec::<String>::new());
    window.key(Key::Backspace);
    window.key(Key::Backspace);
    window.key(Key::Backspace);
    window.type_text("sh ee");
    window.settle();
    assert_eq!(listed(&window), ["sheet.obj"], "every word narrows the list");
    let before = window.editor().session.opening_revision();
    window.key(Key::ArrowDown);
    window.key(Key::Enter);
    assert_eq!(window.editor().session.opening_revision(), before + 1);
    assert!(!window.editor().files.dialogs.is_open());
}

#[test]
fn keys_of_the_window_rest_while_the_dialog_is_open() {
    let mut window = window();
    window.editor_mut().session.handle(Action::Fix([0, 24, 48].map(VertexId::new).to_vec()));
    window.settle();
    window.editor_mut().selection.add([VertexId::new(24)]);
    ask_where_to_save(&mut window);
    let at = row(&window, "sheet.obj").center();
    window.click_at(at, Modifiers::NONE);
    for key in [Key::Delete, Key::Backspace, Key::ArrowLeft, Key::W] {
        window.key(key);
    }
    assert_eq!(window.editor().session.document().targets.len(), 3);
    assert!(!window.editor().pane_shading.wireframe);
}

#[test]
fn the_list_is_sorted_by_a_click_on_a_head_and_shows_other_files_if_asked() {
    let mut window = window();
    std::fs::create_dir(window.path("deep")).unwrap();
    std::fs::write(window.path("a.obj"), "x".repeat(90_000)).unwrap();
    std::fs::write(window.path("b.ply"), "x").unwrap();
    std::fs::write(window.path("c.pdf"), "x".repeat(5_000_000)).unwrap();
    window.press(Modifiers::COMMAND, Key::O);
    assert_eq!(listed(&window), ["deep/", "a.obj", "b.ply", "sheet.obj"]);
    window.click("Sort by name");
    assert_eq!(listed(&window), ["deep/", "sheet.obj", "b.ply", "a.obj"]);
    window.click("Sort by size");
    assert_eq!(listed(&window), ["deep/", "b.ply", "sheet.obj", "a.obj"]);
    assert!(window.shows("90 kB") && window.shows("PLY mesh"), "{:?}", window.words());
    window.harness.get_by_role_and_label(Role::CheckBox, "All files").click();
    window.settle();
    assert_eq!(listed(&window), ["deep/", "b.ply", "sheet.obj", "a.obj", "c.pdf"]);
    assert!(window.shows("5.0 MB"));
    window.key(Key::Escape);
    window.press(Modifiers::COMMAND, Key::O);
    assert_eq!(listed(&window), ["deep/", "b.ply", "sheet.obj", "a.obj"], "the order stays, the switch does not");
}

#[test]
fn a_folder_without_matching_files_says_how_to_see_the_others() {
    let mut window = window();
    std::fs::create_dir(window.path("deep")).unwrap();
    std::fs::write(window.path("deep/notes.txt"), "x").unwrap();
    window.press(Modifiers::COMMAND, Key::O);
    double_click(&mut window, "deep/");
    assert!(window.shows("obj, ply") && listed(&window).is_empty(), "{:?}", window.words());
    window.click("Show all 1");
    assert_eq!(listed(&window), ["notes.txt"]);
    window.fill_in(Role::SearchInput, "Filter", "zebra");
    window.settle();
    window.click("Clear the filter");
    assert_eq!(listed(&window), ["notes.txt"]);
}

#[test]
fn folders_are_pinned_and_recent_ones_come_back_in_the_next_run() {
    let files = window();
    std::fs::create_dir(files.path("deep")).unwrap();
    write_obj(&files.path("deep/third.obj"), &sheet(4, 0.0));
    let start = || LaunchFile {
        file: Some(files.path("sheet.obj")),
        preferences: Some(files.path("window.json")),
        dialogs_inside: true,
        ..LaunchFile::default()
    };
    let mut first = Window::start(SIZE, start());
    first.press(Modifiers::COMMAND, Key::O);
    first.click("Pin this folder");
    double_click(&mut first, "deep/");
    double_click(&mut first, "third.obj");
    eframe::App::on_exit(first.harness.state_mut());
    let (pinned, recent) =
        (format!("Pinned folder {}", folder_of(&files)), format!("Recent folder {}/deep", folder_of(&files)));
    let mut second = Window::start(SIZE, start());
    second.press(Modifiers::COMMAND, Key::O);
    assert!(second.has_button(&pinned) && second.has_button("Unpin this folder"));
    second.click(&recent);
    assert_eq!(listed(&second), ["third.obj"]);
    second.click(&pinned);
    second.click("Unpin this folder");
    assert!(!second.has_button(&pinned) && second.has_button("sheet.obj"));
}

#[test]
fn a_folder_of_twenty_thousand_files_is_listed_and_drawn_fast() {
    let mut window = window();
    std::fs::create_dir(window.path("many")).unwrap();
    for i in 0..20_000 {
        std::fs::File::create(window.path(&format!("many/file{i:05}.obj"))).unwrap();
    }
    window.press(Modifiers::COMMAND, Key::O);
    double_click(&mut window, "many/");
    let rows = listed(&window);
    assert!(rows[0] == "file00000.obj" && rows.len() < 60, "{} rows are drawn", rows.len());
    window.fill_in(Role::SearchInput, "Filter", "19999");
    let slowest = (0..5).map(|_| {
        let start = std::time::Instant::now();
        window.step();
        start.elapsed()
    });
    assert!(slowest.max().expect("five frames") < std::time::Duration::from_millis(500));
    assert_eq!(listed(&window), ["file19999.obj"]);
}

#[test]
fn the_dialog_fits_into_the_smallest_window() {
    let files = window();
    let start = LaunchFile { file: Some(files.path("sheet.obj")), dialogs_inside: true, ..LaunchFile::default() };
    let small = egui::vec2(640.0, 420.0);
    let mut window = Window::start(small, start);
    for save in [false, true] {
        if save {
            window.press(Modifiers::COMMAND, Key::S);
        } else {
            window.press(Modifiers::COMMAND, Key::O);
        }
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, small);
        for button in ["Up", "Cancel", "Sort by name", if save { "Save" } else { "Open" }] {
            assert!(screen.contains_rect(window.rect(Role::Button, button)), "{button}");
        }
        window.key(Key::Escape);
    }
}

#[test]
fn a_dialog_is_left_by_cancel_or_escape() {
    let mut window = window();
    window.press(Modifiers::COMMAND, Key::O);
    window.click("Cancel");
    assert!(!window.editor().files.dialogs.is_open());
    ask_where_to_save(&mut window);
    window.key(Key::Escape);
    assert!(!window.editor().files.dialogs.is_open());
    ask_where_to_save(&mut window);
    window.harness.get_by_role_and_label(Role::TextInput, "Name").click();
    window.step();
    window.key(Key::Escape);
    assert!(!window.editor().files.dialogs.is_open(), "from its text field too");
    assert!(!window.path("sheet-flat.obj").exists());
}

#[test]
fn the_mesh_is_saved_with_texture_coordinates() {
    let mut window = window();
    ask_where_to_save(&mut window);
    window.click("Save");
    let path = window.path("sheet-flat.obj");
    let saved = read_mesh(&path).expect("a mesh");
    assert_eq!(saved.polygons.triangulate().triangles, window.editor().session.model().unwrap().mesh().triangles);
    assert_eq!(std::fs::read_to_string(&path).unwrap().lines().filter(|line| line.starts_with("vt ")).count(), 49);
    let message = &window.editor().session.messages()[0];
    assert_eq!(message.severity, Severity::Note);
    assert!(matches!(&message.files[..], [file] if file.ends_with("sheet-flat.obj")), "{:?}", message.files);
    assert!(window.shows("sheet-flat.obj"));
    assert_message("dialogs-window-wrote-a-file", &message.text);
}

#[test]
fn a_file_that_is_there_is_replaced_only_by_that_word() {
    let mut window = window();
    std::fs::write(window.path("sheet-flat.obj"), "precious").unwrap();
    ask_where_to_save(&mut window);
    for _ in 0..3 {
        window.key(Key::Enter);
        let content = std::fs::read_to_string(window.path("sheet-flat.obj")).unwrap();
        assert_eq!(content, "precious", "Enter is not enough");
    }
    assert!(window.has_button("Replace") && !window.has_button("Save"));
    window.key(Key::Escape);
    assert!(window.has_button("Save") && !window.has_button("Replace"), "Esc leaves the question alone");
    window.click("Save");
    assert_eq!(std::fs::read_to_string(window.path("sheet-flat.obj")).unwrap(), "precious");
    window.click("Replace");
    assert!(read_mesh(&window.path("sheet-flat.obj")).is_ok());
}

#[test]
fn drawings_pictures_and_reports_are_exported() {
    for (entry, file, begin) in [
        ("Layout in the unit square…", "sheet-flat.svg", b"<svg".as_slice()),
        ("Layout at true scale…", "sheet-flat.svg", b"<svg"),
        ("Mesh and layout side by side…", "sheet-flat.png", b"\x89PNG"),
        ("Report…", "sheet-report.json", b"{"),
        ("Layout as a flat mesh…", "sheet-flat-mesh.obj", b"v "),
    ] {
        let mut window = window();
        window.menu(&["File", "Export", entry]);
        window.click("Export");
        let bytes = std::fs::read(window.path(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        let found = bytes.windows(begin.len()).take(200).any(|part| part == begin);
        assert!(found, "{file} begins as such files do");
    }
}

#[test]
fn a_cutting_pattern_is_exported_with_the_options_of_its_window() {
    let mut window = window();
    window.menu(&["File", "Export", "Cutting pattern…"]);
    window.choose("Unit of the mesh", "Metre");
    window.choose("Paper", "A4");
    window.key(Key::Escape);
    assert_eq!(window.editor().files.options_shown, None);
    window.press(Modifiers::COMMAND, Key::E);
    window.click("Cutting pattern…");
    let options = window.editor().files.pattern;
    assert_eq!((options.unit, options.paper), (LengthUnit::Metre, PatternPaper::A4), "options stay");
    window.click("Export: Cutting pattern…");
    window.click("Export");
    let bytes = std::fs::read(window.path("sheet-pattern.pdf")).expect("written");
    let pages = bytes.windows(11).filter(|part| part == b"/Type /Page").count();
    assert!(bytes.starts_with(b"%PDF") && pages > 4, "metres on A4 take many pages: {pages}");
}

#[test]
fn the_layout_of_another_mesh_is_copied_through_the_menu_and_undone() {
    let mut window = window();
    let request = SaveRequest { path: window.path("uv.obj"), kind: OutputKind::Obj, fit: Fit::Unit };
    window.editor_mut().session.handle(Action::Save(request));
    window.settle();
    let before = window.editor().session.document().clone();
    window.menu(&["Edit", "Seams", "Copy the layout of another mesh…"]);
    window.click("uv.obj");
    window.click("Copy");
    window.settle();
    assert!(window.editor().session.document().shaped.is_some());
    assert_eq!(window.editor().session.document().targets.len(), 2, "two pins hold the only chart");
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.editor().session.document(), before);
}

#[test]
fn the_picture_of_the_files_layout_is_drawn_for_the_layout_on_the_screen() {
    let folder = tempfile::tempdir().expect("a folder");
    // A square whose own layout shows the left half of the picture.
    let path = folder.path().join("square.obj");
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.25 0.5\n\
                f 1/1 2/2 5/5\nf 2/2 3/3 5/5\nf 3/3 4/4 5/5\nf 4/4 1/1 5/5\n";
    std::fs::write(&path, text).expect("written");
    let mut window = Window::with_file(&path);
    window.settle();
    window.menu(&["File", "Export"]);
    assert!(!window.editor().session.can_bake(), "there is no picture yet");
    window.key(Key::Escape);
    window.key(Key::Escape);
    open_picture(&mut window);
    window.editor_mut().session.handle(Action::Unwrap(None));
    window.settle();
    window.menu(&["File", "Export", "Picture for this layout…"]);
    window.choose("Size in pixels", "512 × 512");
    window.click("Export: Picture for this layout…");
    window.click("Export");
    window.settle();
    let written: Vec<_> = std::fs::read_dir(folder.path()).expect("a folder").filter_map(Result::ok).collect();
    let path = written.iter().map(std::fs::DirEntry::path).find(|path| path.extension() == Some("png".as_ref()));
    let picture = PictureFile::read(&path.expect("a picture is written")).expect("it can be read").pixels;
    assert_eq!([picture.width, picture.height], [512, 512]);
    let colours = picture.pixels.as_chunks::<4>().0;
    let has = |colour: [u8; 4]| colours.contains(&colour);
    assert!(has([250, 20, 20, 255]) && has([20, 20, 250, 255]), "the left half is on the square");
    assert!(!has([20, 250, 20, 255]) && !has([250, 250, 20, 255]), "the right half is not");
}

#[test]
fn a_project_without_its_mesh_opens_with_the_mesh_that_the_user_locates() {
    let mut window = window();
    let project = window.path("work.freebound");
    window.editor_mut().session.handle(Action::SaveProject(project.clone()));
    window.settle();
    let moved = tempfile::tempdir().expect("a folder");
    let mesh = moved.path().join("moved.obj");
    std::fs::rename(window.path("sheet.obj"), &mesh).expect("moved");
    window.open(&project);
    assert!(window.has_button("Locate…"), "{:?}", window.words());
    window.click("Locate…");
    window.fill_in(Role::TextInput, "Name", &mesh.display().to_string());
    window.key(Key::Enter);
    assert_eq!(window.editor().session.model().expect("open").path.as_ref(), Some(&mesh));
    assert!(!window.has_button("Locate…"));
}

#[test]
fn the_list_of_exports_has_the_same_entries_as_the_menu() {
    let mut window = window();
    window.press(Modifiers::COMMAND, Key::E);
    assert!(window.has_button("Picture of the mesh's pane…") && window.has_button("Layout at true scale…"));
    window.click("Report…");
    assert!(window.editor().files.dialogs.is_open() && !window.editor().layout.exports_shown);
    window.click("Export");
    assert!(window.path("sheet-report.json").exists());
}

#[test]
fn a_name_of_another_kind_is_refused_with_a_remedy() {
    let mut window = window();
    window.menu(&["File", "Export", "Layout in the unit square…"]);
    window.fill_in(Role::TextInput, "Name", "drawing.pdf");
    window.click("Export");
    assert!(!window.path("drawing.pdf").exists());
    let message = &window.editor().session.messages()[0];
    assert_eq!(message.severity, Severity::Error);
    assert!(message.remedy.as_ref().expect("a remedy").contains(".svg"));
    assert!(window.shows("drawing.pdf") && window.shows(".svg"));
}

#[test]
fn letters_after_a_click_on_a_file_go_to_the_name_of_a_dialog_that_saves() {
    let mut window = window();
    ask_where_to_save(&mut window);
    let name = |window: &Window| {
        window.harness.get_by_role_and_label(Role::TextInput, "Name").accesskit_node().value().unwrap_or_default()
    };
    window.click("sheet.obj");
    let before = name(&window);
    window.type_text("xy");
    window.settle();
    assert_eq!(before, "sheet.obj");
    assert!(name(&window).contains('y') && window.has_button("sheet.obj"), "{}", name(&window));
}

#[test]
fn a_file_that_cannot_be_written_says_so() {
    let mut window = window();
    ask_where_to_save(&mut window);
    window.fill_in(Role::TextInput, "Name", "missing/deep.obj");
    window.click("Save");
    let message = &window.editor().session.messages()[0];
    assert_eq!(message.severity, Severity::Error);
    assert!(message.text.contains("deep.obj"), "{}", message.text);
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// File that the system drops on the window.
pub(crate) fn dropped(path: PathBuf) -> Arc<dyn egui::DroppedFile + Send + Sync> {
    Arc::new(Dropped(path))
}

#[test]
fn a_file_dropped_on_the_window_opens() {
    let mut window = window();
    write_obj(&window.path("dropped.obj"), &sheet(4, 0.0));
    let file = Dropped(window.path("dropped.obj"));
    window.harness.input_mut().dropped_files.push(Arc::new(file));
    window.settle();
    assert_eq!(name(&window), "dropped.obj");
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn files_dropped_together_are_sorted_by_their_kinds_and_a_second_mesh_is_named() {
    let mut window = window();
    for name in ["b.obj", "a.obj"] {
        write_obj(&window.path(name), &sheet(4, 0.0));
    }
    std::fs::write(window.path("a.txt"), "0 0.25 0.5\n24 0.75 0.5\n").expect("written");
    std::fs::write(window.path("a.mtl"), "newmtl skin\n").expect("written");
    let picture = std::fs::File::create(window.path("a.png")).expect("a file");
    freebound_io::raster::write_png(&Picture { width: 2, height: 1, pixels: vec![255; 8] }, picture).expect("written");
    let names = ["a.txt", "a.png", "a.mtl", "a.obj", "b.obj"];
    let files = names.map(|name| dropped(window.path(name)));
    window.harness.input_mut().dropped_files.extend(files);
    window.settle();
    assert_eq!(name(&window), "a.obj");
    assert!(window.editor().has_picture());
    assert_eq!(window.editor().session.document().targets.len(), 2);
    let said: Vec<&str> = window.editor().session.messages().iter().map(|message| &*message.text).collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert_message("dialogs-window-one-mesh-at-a-time", said[0]);
    // Files queued after a mesh that fails to open are not applied to another mesh.
    std::fs::write(window.path("broken.obj"), "f 1 2 3\n").expect("written");
    let files = ["broken.obj", "a.txt"].map(|name| dropped(window.path(name)));
    window.harness.input_mut().dropped_files.extend(files);
    window.settle();
    window.open(&window.path("b.obj"));
    assert!(window.editor().session.document().targets.is_empty());
}

#[test]
fn what_belongs_to_a_mesh_that_was_not_dropped_with_it_is_said_to_be_no_mesh() {
    let mut window = window();
    for name in ["a.mtl", "a.bin"] {
        std::fs::write(window.path(name), "newmtl skin\n").expect("written");
    }
    let files = ["a.mtl", "a.bin"].map(|name| dropped(window.path(name)));
    window.harness.input_mut().dropped_files.extend(files);
    window.settle();
    let said: Vec<&str> = window.editor().session.messages().iter().map(|message| &*message.text).collect();
    assert!(said.iter().any(|text| text.contains("a.mtl")), "{said:?}");
}

#[test]
fn a_dropped_file_of_edges_cuts_the_mesh() {
    let mut window = window();
    std::fs::write(window.path("cut.edges"), "0 1\n").expect("written");
    let file = dropped(window.path("cut.edges"));
    window.harness.input_mut().dropped_files.push(file);
    window.settle();
    let seams = window.editor().session.seams().edges().clone();
    assert_eq!(seams.into_iter().collect::<Vec<_>>(), [[VertexId::new(0), VertexId::new(1)]]);
    assert_eq!(name(&window), "sheet.obj");
}

#[test]
fn files_opened_last_are_kept_and_opened_again() {
    let first = window();
    let store = first.path("settings/recent.json");
    let file = first.path("sheet.obj");
    let start = || LaunchFile {
        file: Some(file.clone()),
        recent_store: Some(store.clone()),
        dialogs_inside: true,
        ..LaunchFile::default()
    };
    drop(Window::start(SIZE, start()));
    let mut again = Window::start(SIZE, LaunchFile { file: None, ..start() });
    assert_eq!(name(&again), Example::Face.title());
    again.menu(&["File", "Recent", &file.display().to_string()]);
    assert_eq!(name(&again), "sheet.obj");
    again.menu(&["File", "Recent", "Clear this list"]);
    assert!(again.editor().session.recent().paths().is_empty());
    again.menu(&["File", "Recent"]);
    assert_message("dialogs-window-no-recent-files", &again.text_with("yet"));
}

#[test]
fn a_recent_file_that_is_gone_says_so_and_changes_nothing() {
    let mut window = window();
    let gone = window.path("gone.obj");
    write_obj(&gone, &sheet(4, 0.0));
    window.open(&gone);
    std::fs::remove_file(&gone).unwrap();
    window.menu(&["File", "Examples", Example::Ell.title()]);
    window.menu(&["File", "Recent", &gone.display().to_string()]);
    assert_eq!(name(&window), Example::Ell.title());
    assert!(window.shows("gone.obj"));
    assert!(window.editor().session.messages()[0].remedy.is_some());
}
