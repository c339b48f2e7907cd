//! Window as a whole: opening, names, and layout at all sizes.

use std::collections::BTreeSet;

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::ui::{BINDINGS, Pane, ShadingMode, Tab};
use freebound_core::pipeline::Target;
use freebound_core::problem::{Method, NamedOption as _};
use glam::DVec2;

use crate::charts::with_sheets;
use crate::harness::{MESH_VIEW, PLANE_VIEW, SIZE, Window, sheet};

#[test]
fn the_built_in_face_opens_with_its_verdict_on_the_screen() {
    let window = Window::start(SIZE, LaunchFile::default());
    let model = window.editor().session.model().expect("something is open");
    assert_eq!(model.name, Example::Face.title());
    let words = window.verdict();
    assert_eq!(window.is_proved(), window.outcome().step.verdict.planar);
    assert!(window.shows(&words));
}

#[test]
fn the_name_and_the_size_of_what_is_open_show() {
    let window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert!(window.shows("sheet.obj"), "{:?}", window.words());
    assert!(window.shows("49 v") && window.shows("72 f"), "{:?}", window.words());
}

/// State of the window, with the function that brings it there from the start.
type State = (&'static str, fn(&mut Window));

/// States that a user can reach.
const STATES: [State; 30] = [
    ("at the start", |_| ()),
    ("the File menu", |window| window.click("File")),
    ("the list of recent files", |window| window.menu(&["File", "Recent"])),
    ("the examples", |window| window.menu(&["File", "Examples"])),
    ("the sizes in files", |window| window.menu(&["File", "Size in files"])),
    ("the Edit menu", |window| window.click("Edit")),
    ("the View menu", |window| window.click("View")),
    ("the shadings", |window| window.menu(&["View", "Shading of the mesh"])),
    ("the themes", |window| window.menu(&["View", "Theme"])),
    ("the Solve menu", |window| window.click("Solve")),
    ("the Help menu", |window| window.click("Help")),
    ("hull and pockets", |window| window.key(Key::H)),
    ("a magnifier", crate::defects::fold_any),
    ("the Pins tab", |window| window.click("Pins")),
    ("the Pins tab with pins", |window| {
        window.click("Pins");
        fix(window, &[3, 9]);
    }),
    ("the Defects tab", |window| window.click("Defects")),
    ("the Vertex tab", |window| {
        window.click("Vertex");
        window.editor_mut().selection.add([freebound_core::mesh::VertexId::new(3)]);
        window.settle();
    }),
    ("a list of methods", |window| window.open_list("Method")),
    ("a list of weights", |window| window.open_list("Weights")),
    ("a list of shadings", |window| window.open_list("Shading of the mesh")),
    ("a run of steps", steps),
    ("the stop conditions", |window| window.click("Stop conditions")),
    ("the numbers of a step", |window| {
        steps(window);
        let name = window.name_of(Role::Button, "Step 3: ");
        window.harness.get_by_role_and_label(Role::Button, &name).hover();
        window.settle();
    }),
    ("what few need of a method", |window| {
        window.harness.get_by_label("More").click();
        window.settle();
    }),
    ("the keys", |window| window.key(Key::F1)),
    ("go to", |window| window.key(Key::G)),
    ("what can be exported", |window| window.press(Modifiers::COMMAND, Key::E)),
    ("a file dialog", |window| window.press(Modifiers::COMMAND, Key::O)),
    ("constraints in the pins panel", |window| {
        constraints(window);
        window.click("Pins");
    }),
    ("the question about unsaved work", |window| {
        fix(window, &[0, 24]);
        window.press(Modifiers::COMMAND, Key::Q);
    }),
];

fn steps(window: &mut Window) {
    for _ in 0..3 {
        window.key(Key::Space);
    }
}

/// Several constraints of all kinds, all selected.
fn constraints(window: &mut Window) {
    fix(window, &[0]);
    for (vertex, pin) in [
        (4, Target::hard(DVec2::new(1.0, 0.0))),
        (20, Target::weighted(DVec2::new(0.0, 1.0), 2.0)),
        (24, Target::weighted(DVec2::ONE, 0.5)),
    ] {
        let vertex = freebound_core::mesh::VertexId::new(vertex);
        window.editor_mut().session.handle(freebound::session::Action::Place { vertex, target: pin });
    }
    window.editor_mut().selection.select([0, 4, 20, 24].map(freebound_core::mesh::VertexId::new));
    window.settle();
}

fn fix(window: &mut Window, vertices: &[u32]) {
    let vertices = vertices.iter().map(|&v| freebound_core::mesh::VertexId::new(v)).collect();
    window.editor_mut().session.handle(freebound::session::Action::Fix(vertices));
    window.settle();
}

#[test]
fn every_control_has_a_name_in_every_state() {
    for (state, bring) in STATES {
        let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
        bring(&mut window);
        assert_eq!(window.harness.unnamed_widgets(), Vec::<String>::new(), "{state}");
        let controls = window.controls().into_iter();
        // Labels are their own names; scroll bars and title bars belong to their parents.
        let controls = controls.filter(|(role, ..)| !matches!(role, Role::Label | Role::ScrollBar | Role::Unknown));
        let nameless: Vec<_> = controls.filter(|(_, name, _)| name.trim().is_empty()).collect();
        assert!(nameless.is_empty(), "{state}: {nameless:?}");
    }
}

#[test]
fn no_two_controls_of_a_state_have_the_same_role_and_name() {
    for (state, bring) in STATES {
        let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
        bring(&mut window);
        let controls = window.controls();
        for (i, (role, name, _)) in controls.iter().enumerate() {
            let twice = controls[i + 1..].iter().any(|(other, same, _)| role == other && name == same);
            // "Solve" is both a menu and a button; both solve.
            let allowed = ["Solve", "Panels", ""].contains(&name.as_str());
            let allowed = allowed || *role == Role::Label;
            assert!(!twice || allowed, "{state}: {role:?} {name:?}");
        }
    }
}

#[test]
fn each_menu_has_its_entries() {
    let menus: [(&[&str], &[&str]); 12] = [
        (
            &["File"],
            &["Open…", "Save project", "Save project as…", "Open picture…", "Import constraints…", "Export", "Quit"],
        ),
        (&["File", "Examples"], &["Face", "Open cube", "Flat L", "Dome", "Bumpy cap", "Spiral strip"]),
        (&["File", "Size in files"], &["Fit into the unit square", "True scale: the mesh's own area"]),
        (&["Edit", "Tools"], &["Select vertices", "Fix vertices", "Constrain vertices", "Draw seams", "Brush the map"]),
        (
            &["Edit"],
            &[
                "Undo",
                "Redo",
                "Fix the selection",
                "Free the selected pins",
                "Mirror the targets",
                "Fit the targets to the mesh",
                "Reverse the faces",
            ],
        ),
        (
            &["View"],
            &["Wireframe", "Panels", "Frame the selection, or all", "Go to…", "Next defect", "Previous defect"],
        ),
        (&["View", "Show"], &["Hull and pockets", "Magnifier", "Curves of the steps", "Animate changes of step"]),
        (
            &["View", "Shading of the mesh"],
            &["Plain", "Checker", "Picture", "Angle distortion", "Area distortion", "Stretch", "Move"],
        ),
        (
            &["View", "Shading of the embedding"],
            &["Plain", "Checker", "Picture", "Angle distortion", "Area distortion", "Stretch", "Move", "See-through"],
        ),
        (&["View", "Theme"], &["System", "Light", "Dark"]),
        (
            &["Solve"],
            &[
                "Take one step",
                "Start the run",
                "Play all steps",
                "Solve from scratch",
                "Stop the work",
                "Method and weights",
            ],
        ),
        (&["Help"], &["All keys"]),
    ];
    for (path, entries) in menus {
        let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
        window.menu(path);
        for entry in entries {
            assert!(window.has_button(entry), "{path:?} ▸ {entry}");
        }
    }
}

#[test]
fn entries_that_can_do_nothing_are_grey() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.click("Edit");
    for entry in ["Undo", "Redo", "Fix the selection", "Free the selected pins", "Free all pins"] {
        assert!(!window.is_enabled(entry), "{entry}");
    }
    window.key(Key::Escape);
    window.click("View");
    assert!(!window.is_enabled("Next defect") && !window.is_enabled("Previous defect"));
}

#[test]
fn each_example_opens_from_the_menu() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    for example in Example::ALL {
        window.menu(&["File", "Examples", example.title()]);
        assert_eq!(window.editor().session.model().expect("open").name, example.title());
        assert!(window.editor().session.is_current(), "{}", example.title());
    }
}

#[test]
fn each_shading_of_the_view_menu_is_put_on() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    for shading in ShadingMode::ALL.into_iter().filter(|shading| shading.is_for(Pane::Mesh)) {
        let before = window.shadings();
        window.menu(&["View", "Shading of the mesh", shading.title()]);
        assert_eq!(window.shadings(), [shading, before[1]]);
        window.menu(&["View", "Shading of the embedding", shading.title()]);
        assert_eq!(window.shadings(), [shading; 2]);
        let legend = window.editor().pane_shading.paint(Pane::Mesh).expect("painted").legend.is_some();
        // At the first step nothing has moved.
        let is_bare =
            matches!(shading, ShadingMode::Plain | ShadingMode::Checker | ShadingMode::Picture | ShadingMode::Move);
        assert_eq!(legend, !is_bare, "{shading:?}");
    }
    window.choose("Shading of the mesh", "Stretch");
    assert_eq!(window.shadings(), [ShadingMode::Stretch, ShadingMode::Move]);
    window.click("Wire");
    assert!(window.editor().pane_shading.wireframe);
    window.menu(&["View", "Wireframe"]);
    assert!(!window.editor().pane_shading.wireframe);
}

#[test]
fn the_theme_of_the_menu_is_put_on() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    for (name, dark) in [("Light", false), ("Dark", true)] {
        window.menu(&["View", "Theme", name]);
        assert_eq!(window.harness.ctx.global_style().visuals.dark_mode, dark, "{name}");
    }
}

#[test]
fn the_list_of_keys_has_them_all() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.menu(&["Help", "All keys"]);
    for binding in BINDINGS {
        let named = window.harness.ctx.format_shortcut(&binding.shortcut);
        let keys = named.replace("OpenBracket", "[").replace("CloseBracket", "]");
        // Entries that are scrolled out of sight exist nevertheless.
        for words in [binding.about, &keys] {
            assert!(window.harness.query_all_by_label(words).next().is_some(), "{words}");
        }
    }
    window.key(Key::Escape);
    assert!(!window.editor().layout.keys_shown);
}

#[test]
fn a_pane_in_full_size_has_the_window_to_itself() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    let half = window.mesh_view().width();
    window.click("Show this pane alone: Mesh");
    assert!(window.mesh_view().width() > 1.9 * half);
    assert!(window.harness.query_by_role_and_label(Role::Image, PLANE_VIEW).is_none());
    window.click("Show both panes: Mesh");
    window.click("Show this pane alone: Embedding");
    assert!(window.plane_view().width() > 1.9 * half);
    assert!(window.harness.query_by_role_and_label(Role::Image, MESH_VIEW).is_none());
    window.click("Show both panes: Embedding");
    assert!((window.mesh_view().width() - half).abs() < 1.0);
}

#[test]
fn the_splitter_moves_the_border_of_the_panes() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    let before = window.mesh_view().width();
    let bar = window.rect(Role::Slider, "Width of the panes").center();
    window.drag(bar, bar + Vec2::new(-100.0, 0.0), Modifiers::NONE);
    assert!((window.mesh_view().width() - (before - 100.0)).abs() < 2.0);
}

#[test]
fn both_panes_are_framed_when_a_mesh_opens() {
    let window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let inside = |view: Rect, places: Vec<egui::Pos2>| {
        let spread = places.iter().fold(Rect::NOTHING, |rect, &at| rect.union(Rect::from_min_max(at, at)));
        assert!(view.contains_rect(spread), "{spread:?} in {view:?}");
        assert!(spread.width() > 0.5 * view.width() || spread.height() > 0.5 * view.height(), "{spread:?} in {view:?}");
    };
    let vertices = (0..49).map(freebound_core::mesh::VertexId::new);
    inside(window.mesh_view(), vertices.map(|vertex| window.place_on_mesh(vertex)).collect());
    inside(window.plane_view(), window.embedding().iter().map(|z| window.place_in_plane(*z)).collect());
}

/// Window sizes from the least to a large screen's.
const SIZES: [Vec2; 3] = [Vec2::new(640.0, 420.0), SIZE, Vec2::new(2000.0, 1200.0)];

#[test]
fn the_window_fits_into_every_size() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    for size in SIZES {
        for (state, bring) in STATES {
            let mut window = Window::start(
                size,
                LaunchFile { file: Some(mesh.path("sheet.obj")), dialogs_inside: true, ..LaunchFile::default() },
            );
            window.editor_mut().handle(freebound::ui::Request::ShowTab(Tab::Method));
            window.settle();
            bring(&mut window);
            let all = Rect::from_min_size(egui::Pos2::ZERO, size).expand(0.5);
            for (role, name, rect) in window.controls() {
                let across = all.x_range().contains(rect.left()) && all.x_range().contains(rect.right());
                let fits = all.contains_rect(rect) || (across && is_scrolled(role, &name));
                assert!(fits, "{state} at {size}: {role:?} {name:?} lies at {rect:?}");
            }
        }
    }
}

/// True if a control belongs to a list that scrolls.
fn is_scrolled(role: Role, name: &str) -> bool {
    let listed = name.ends_with('/')
        || name.starts_with("Change ")
        || name.contains(" pin v")
        || name.contains(" of pin ")
        || Method::ALL.iter().any(|method| method.labels().title == name)
        || std::path::Path::new(&name).extension().is_some_and(|e| e == "obj");
    let in_panel =
        ["Numbers of the solve", "Solve", "Relax", "Free", "Fix", "Free all", "Frame", "Copy", "More"].contains(&name);
    role == Role::Label || role == Role::ScrollBar || role == Role::Link || listed || in_panel
}

#[test]
fn what_is_below_the_window_s_edge_can_be_scrolled_to() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    let mut window =
        Window::start(SIZES[0], LaunchFile { file: Some(mesh.path("sheet.obj")), ..LaunchFile::default() });
    window.editor_mut().handle(freebound::ui::Request::ShowTab(Tab::Method));
    window.settle();
    window.harness.get_by_label("Numbers of the solve").scroll_to_me();
    window.settle();
    let bar = window.harness.get_by_label("Numbers of the solve").rect();
    assert!(bar.bottom() <= SIZES[0].y - 20.0, "{bar:?}");
}

#[test]
fn the_bar_at_the_top_does_not_overlap_itself() {
    for size in SIZES {
        let mesh = Window::with_mesh(
            "a mesh with a long name, longer than the bar at the top has room for.obj",
            &sheet(4, 0.3),
        );
        let file = mesh.editor().session.model().and_then(|model| model.path.clone());
        let window = Window::start(size, LaunchFile { file, ..LaunchFile::default() });
        let bar: Vec<_> = window.controls().into_iter().filter(|(.., rect)| rect.bottom() < 30.0).collect();
        assert!(bar.len() >= 6, "{bar:?}");
        for (i, (_, name, rect)) in bar.iter().enumerate() {
            for (_, other, place) in &bar[i + 1..] {
                let common = rect.intersect(*place);
                assert!(common.width() <= 0.5 || common.height() <= 0.5, "{name:?} over {other:?} at {size}");
            }
        }
    }
}

#[test]
fn quit_closes_the_window() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    window.press(Modifiers::COMMAND, Key::Q);
    assert!(window.editor().gpu.is_quitting());
}

#[test]
fn every_menu_fits_into_the_smallest_window_with_charts_on_the_page() {
    let mut window = with_sheets();
    let size = SIZES[0];
    window.harness.set_size(size);
    window.settle();
    let usual: BTreeSet<String> = window.controls().into_iter().map(|(_, name, _)| name).collect();
    let parts: [(&str, &[&str]); 4] = [
        ("File", &["Recent", "Examples", "Export", "Size in files"]),
        ("Edit", &["Tools", "Select", "Seams", "Arrange charts"]),
        (
            "View",
            &[
                "Shading of the mesh",
                "Shading of the embedding",
                "Checker and pixels",
                "Show",
                "Side panels",
                "Charts",
                "Theme",
            ],
        ),
        ("Solve", &[]),
    ];
    for (menu, parts) in parts {
        for part in std::iter::once(None).chain(parts.iter().map(Some)) {
            window.click(menu);
            if let Some(part) = part {
                window.click(part);
            }
            let opened = window.controls().into_iter().filter(|(_, name, _)| !usual.contains(name));
            let beyond: Vec<String> = opened
                .filter(|(.., rect)| rect.bottom() > size.y || rect.right() > size.x)
                .map(|(_, name, _)| name)
                .collect();
            assert!(beyond.is_empty(), "{menu} {part:?}: {beyond:?}");
            window.key(Key::Escape);
            window.key(Key::Escape);
        }
    }
}

#[test]
fn switches_of_the_view_menu_say_whether_they_are_on() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    let is_on = |window: &Window, name: &str| {
        let node = window.harness.get_by_role_and_label(Role::Button, name);
        node.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    window.click("View");
    assert!(!is_on(&window, "Wireframe"));
    window.click("Show");
    assert!(is_on(&window, "Magnifier"));
    window.key(Key::Escape);
    window.key(Key::Escape);
    window.menu(&["View", "Wireframe"]);
    window.click("View");
    assert!(is_on(&window, "Wireframe"));
}
