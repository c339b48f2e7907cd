//! Layout of the window at its least size: bars of the panes, row of the timeline, curves, and table of pins.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Rect, Vec2};
use egui_kittest::Node;
use egui_kittest::kittest::NodeT as _;
use freebound::app::LaunchFile;
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::{Request, ShadingMode, Tab, Tool};
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::problem::{Family, Method, Settings};
use freebound_io::StepReport;
use glam::{DVec2, DVec3};

use crate::harness::{SIZE, Window, sheet};

const LEAST: Vec2 = Vec2::new(640.0, 420.0);

/// Labelled elements in a part of the window, with their bounds: controls, and labels beside them.
fn things_in(window: &Window, part: Rect) -> Vec<(String, Rect)> {
    let has_words = |node: &Node<'_>| {
        let role = node.accesskit_node().role();
        matches!(role, Role::Button | Role::ComboBox | Role::Label | Role::SpinButton | Role::Slider)
    };
    let words = |node: &Node<'_>| {
        let node = node.accesskit_node();
        node.label().or_else(|| node.value()).unwrap_or_default()
    };
    let nodes = window.harness.root().children_recursive().filter(has_words);
    let things = nodes.map(|node| (words(&node), node.rect()));
    things.filter(|(words, rect)| !words.is_empty() && part.contains(rect.center())).collect()
}

/// Asserts that elements in a part of the window neither overlap nor extend beyond it.
fn assert_apart(window: &Window, part: Rect, what: &str) {
    let things = things_in(window, part);
    assert!(!things.is_empty(), "{what}: nothing lies in {part:?}");
    for (i, (words, rect)) in things.iter().enumerate() {
        let is_inside = rect.left() >= part.left() - 0.5 && rect.right() <= part.right() + 0.5;
        assert!(is_inside, "{what}: {words:?} at {rect:?} reaches out of {part:?}");
        for (other, place) in &things[i + 1..] {
            let common = rect.intersect(*place);
            assert!(common.width() <= 0.5 || common.height() <= 0.5, "{what}: {words:?} over {other:?} at {common:?}");
        }
    }
}

/// Bars over both panes, and the row of the timeline.
fn bars(window: &Window) -> [(Rect, &'static str); 3] {
    let over = |pane: Rect| Rect::from_min_max(egui::pos2(pane.left(), 31.0), egui::pos2(pane.right(), pane.top()));
    let row = window.rect(Role::Button, "Stop conditions").y_range().expand(4.0);
    let row = Rect::from_x_y_ranges(0.0..=window.plane_view().right(), row);
    [(over(window.mesh_view()), "mesh's bar"), (over(window.plane_view()), "embedding's bar"), (row, "timeline")]
}

/// Window of the least size, after a number of steps.
fn small(start: LaunchFile, steps: usize) -> Window {
    let mut window = Window::start(LEAST, start);
    window.editor_mut().pane_shading.glides = false;
    for _ in 0..steps {
        window.editor_mut().session.handle(Action::Step);
        window.settle();
    }
    window
}

#[test]
fn nothing_in_the_bars_of_the_least_window_is_cut_or_lies_over_another() {
    let mesh = Window::with_mesh("sheet.obj", &sheet(4, 0.5));
    let cube = Window::with_example(Example::Cube);
    let start = |file| LaunchFile { file: Some(file), dialogs_inside: true, ..LaunchFile::default() };
    for (name, start, steps) in [
        ("face", LaunchFile::default(), 1),
        ("cube", start(cube.path("cube.obj")), 1),
        ("many steps", start(mesh.path("sheet.obj")), 12),
    ] {
        let mut window = small(start, steps);
        for with_panels in [false, true] {
            if window.editor().layout.panels_shown() != with_panels {
                window.editor_mut().handle(Request::TogglePanels);
                window.settle();
            }
            for shading in [ShadingMode::Checker, ShadingMode::Angle] {
                window.shade(shading);
                window.settle();
                for (part, bar) in bars(&window) {
                    assert_apart(&window, part, &format!("{name}, panels {with_panels}, {shading:?}, {bar}"));
                }
                let menus = ["Shading of the mesh", "Shading of the embedding"];
                for menu in menus.map(|menu| window.rect(Role::ComboBox, menu)) {
                    assert!(menu.width() >= 90.0, "{name}: {menu:?} says a shading's name");
                }
            }
            let shown = window.editor().session.timeline().shown().expect("solved");
            let chip = things_in(&window, bars(&window)[2].0).into_iter();
            let chip = chip.filter(|(words, _)| words.starts_with(&format!("Step {shown}: "))).count();
            assert_eq!(chip, 1, "{name}, panels {with_panels}: the step on the screen is in sight");
        }
    }
}

#[test]
fn controls_of_the_comparison_lie_beside_each_other_in_the_least_window() {
    let mut window = small(LaunchFile::default(), 0);
    for with_panels in [true, false] {
        if window.editor().layout.panels_shown() != with_panels {
            window.editor_mut().handle(Request::TogglePanels);
        }
        if !window.has_button("Leave the comparison") {
            window.editor_mut().handle(Request::ToggleComparison);
        }
        window.settle();
        let below = window.rect(Role::Button, "Leave the comparison").bottom();
        let panels = if with_panels { window.editor().layout.panel_width() } else { 0.0 };
        let bar = Rect::from_min_max(egui::pos2(44.0, 31.0), egui::pos2(LEAST.x - panels, below + 4.0));
        let names: Vec<String> = things_in(&window, bar).into_iter().map(|(name, _)| name).collect();
        for name in ["Methods that are compared", "Colours of the comparison", "Table", "Morph", "Leave the comparison"]
        {
            assert!(names.iter().any(|other| other == name), "{name}: {names:?}");
        }
        assert_apart(&window, bar, &format!("comparison, panels {with_panels}"));
    }
}

#[test]
fn a_pane_that_a_person_made_narrow_keeps_its_bar_in_order() {
    let mut window = small(LaunchFile::default(), 0);
    window.editor_mut().handle(Request::ShowTab(Tab::Method));
    window.settle();
    let bar = window.rect(Role::Slider, "Width of the panes").center();
    window.drag(bar, bar - Vec2::new(120.0, 0.0), egui::Modifiers::NONE);
    assert!(window.mesh_view().width() < 60.0, "{:?}", window.mesh_view());
    for (part, bar) in bars(&window) {
        assert_apart(&window, part, bar);
    }
}

/// Texts painted in a part of the window.
fn words_in(window: &Window, part: Rect) -> Vec<String> {
    fn collect(shape: &egui::Shape, part: Rect, found: &mut Vec<String>) {
        match shape {
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, part, found)),
            egui::Shape::Text(text) if part.intersects(text.visual_bounding_rect()) => {
                found.push(text.galley.text().to_owned());
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    window.harness.output().shapes.iter().for_each(|shape| collect(&shape.shape, part, &mut found));
    found
}

/// Visible curves: names, and bounds of the plots.
fn curves(window: &Window) -> Vec<(String, Rect)> {
    let nodes = window.harness.root().children_recursive();
    let named = nodes.filter_map(|node| Some((node.accesskit_node().label()?, node.rect())));
    named.filter(|(name, _)| name.starts_with("Curve: ")).collect()
}

/// Folded sheet after three more steps, which do not unfold it since its pins cause the fold.
fn folded() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    crate::defects::fold(&mut window);
    for _ in 0..3 {
        window.key(Key::Space);
    }
    window
}

#[test]
fn the_values_at_the_ends_of_a_curve_lie_beside_it() {
    let window = folded();
    let curves = curves(&window);
    assert!(curves.len() >= 3, "{curves:?}");
    for (name, plot) in curves {
        // Its title ends where the plot begins.
        assert_eq!(words_in(&window, plot.shrink(3.0)), Vec::<String>::new(), "{name}");
        let beside = plot.shrink(3.0).with_min_x(plot.left() - 40.0).with_max_x(plot.left());
        assert!(!words_in(&window, beside).is_empty(), "{name} says its ends");
    }
}

#[test]
fn a_curve_whose_numbers_are_all_zero_is_named_in_the_menu_and_not_drawn() {
    let mut window = folded();
    let records = window.editor().session.timeline().records();
    let is_zero = |count: fn(&StepReport) -> usize| records.iter().all(|record| count(record) == 0);
    let counts = [
        ("Flipped", "flipped faces", is_zero(|record| record.flipped_faces)),
        ("Crossings", "pairs of boundary edges that cross", is_zero(|record| record.boundary_crossings)),
        ("Concave", "concave polygons", is_zero(|record| record.concave_polygons)),
        ("Overwound", "overwound vertices", is_zero(|record| record.overwound_vertices)),
    ];
    assert!(!counts[0].2 && counts[2].2, "a fold, but no polygons: {counts:?}");
    let names: Vec<String> = curves(&window).into_iter().map(|(name, _)| name).collect();
    window.click("Choice of curves");
    for (title, about, is_zero) in counts {
        assert!(!(is_zero && names.contains(&format!("Curve: {about}"))), "{title}: {names:?}");
        let start = format!("{title}: 0 ");
        assert_eq!(window.words().iter().any(|words| words.starts_with(&start)), is_zero, "{:?}", window.words());
    }
    assert!(names.contains(&"Curve: flipped faces".to_owned()), "{names:?}");
}

/// Strip of two rows with `count` vertices each.
fn strip(count: u32) -> TriMesh {
    let positions = (0..2 * count).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
    let square = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
    TriMesh::new(positions, &(0..count - 1).flat_map(square).collect::<Vec<_>>())
}

#[test]
fn the_columns_of_the_pins_never_touch() {
    let mesh = Window::with_mesh("strip.obj", &strip(1600));
    for size in [LEAST, SIZE] {
        let start = LaunchFile { file: Some(mesh.path("strip.obj")), dialogs_inside: true, ..LaunchFile::default() };
        let mut window = Window::start(size, start);
        let session = &mut window.editor_mut().session;
        session.handle(Action::SetSettings(Settings::new(Method::Lscm, Family::Conformal)));
        // Long numbers, negative ones, and contradicting targets.
        for (vertex, target) in [
            (3000, Target::hard(DVec2::new(-0.456_78, -12.345))),
            (3001, Target::hard(DVec2::new(-0.456_78 - 1e-11, -12.345))),
            (3003, Target::hard(DVec2::splat(100.0))),
            (3002, Target::weighted(DVec2::new(-123.456, -0.000_123), 12345.678)),
        ] {
            session.handle(Action::Place { vertex: VertexId::new(vertex), target });
        }
        window.editor_mut().handle(Request::ShowTab(Tab::Pins));
        window.settle();
        assert!(window.shows("conflict"), "{:?}", window.words());
        let panel = window.plane_view().right()..=size.x;
        for vertex in ["v3000", "v3001"].into_iter().chain(["v3002"].into_iter().filter(|_| size == SIZE)) {
            let row = window.rect(Role::Button, vertex).center().y;
            let mut cells = things_in(&window, Rect::from_x_y_ranges(panel.clone(), row - 4.0..=row + 4.0));
            cells.sort_by(|a, b| a.1.left().total_cmp(&b.1.left()));
            assert_eq!(cells.len(), 6, "{cells:?}");
            for pair in cells.windows(2) {
                let gap = pair[1].1.left() - pair[0].1.right();
                assert!(gap >= 6.0, "{size}: {gap} points between {:?} and {:?}", pair[0], pair[1]);
            }
            let last = cells.last().expect("cells").1.right();
            assert!(last <= size.x - 10.0, "{size}: {cells:?}");
        }
    }
}

#[test]
fn panes_keep_their_places_whatever_appears_beside_or_over_them() {
    let mut window = folded();
    let places = |window: &Window| [window.mesh_view(), window.plane_view()];
    let before = places(&window);
    for tab in Tab::ALL {
        window.editor_mut().handle(Request::ShowTab(tab));
        window.settle();
        assert_eq!(places(&window), before, "{tab:?}");
    }
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(3), VertexId::new(8)]));
    window.settle();
    for tool in Tool::ALL {
        window.editor_mut().handle(Request::SetTool(tool));
        window.settle();
        assert_eq!(places(&window), before, "{tool:?}");
    }
    let appearances = [
        ("a step", Request::Do(Action::Step)),
        ("a defect", Request::StepDefect(1)),
        ("the field to go to an element", Request::AskGoTo),
        ("the list of exports", Request::ToggleExports),
        ("a message", Request::Do(Action::ImportConstraints(window.path("missing.txt")))),
        ("the documentation", Request::ShowDocumentation(None)),
        ("the hull", Request::ToggleHull),
        ("a shading with a legend", Request::SetShading(ShadingMode::Angle)),
    ];
    for (what, request) in appearances {
        window.editor_mut().handle(request);
        window.settle();
        assert_eq!(places(&window), before, "{what}");
    }
}
