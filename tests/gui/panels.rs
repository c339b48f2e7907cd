//! Panels at the right: method and weights, pins, the selected vertex.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::examples::Example;
use freebound::session::{Action, Status};
use freebound::ui::{Measure, Request, Tab, sentence};
use freebound_core::geom::ConvexPolygon;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{BoundaryShape, Family, Method, Settings, Spacing};
use freebound_io::PinName;
use glam::DVec2;

use crate::harness::{Pill, SIZE, Window, sheet};
use freebound_testkit::assert_message;

fn settings(window: &Window) -> Settings {
    window.editor().session.document().settings.clone()
}

/// Asserts that the panel shows the numbers of the distortion.
fn assert_numbers_show(window: &Window) {
    let summary = window.outcome().distortion.summary;
    for value in [summary.angle.mean, summary.area.max, summary.stretch_l2] {
        let words = format!("{value:.3}");
        assert!(window.shows(&words), "{words} in {:?}", window.words());
    }
}

#[test]
fn each_method_solves_when_it_is_chosen() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.5));
    let mut seen = Vec::new();
    for (title, method) in [
        ("Convex boundary", Method::Convex(BoundaryShape::Circle)),
        ("Lévy, summed", Method::Levy),
        ("Natural boundary", Method::Natural),
        ("Least-squares conformal", Method::Lscm),
    ] {
        window.choose("Method", title);
        assert_eq!(settings(&window).method, method);
        assert_eq!(window.outcome().problem.settings.method, method, "solved");
        assert_numbers_show(&window);
        seen.push(window.embedding());
    }
    assert_ne!(seen[0], seen[1]);
    assert_ne!(seen[1], seen[2]);
}

#[test]
fn each_family_solves_when_it_is_chosen() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(8, 0.5));
    let mut before = window.embedding();
    for (title, family) in
        [("Mean value", Family::MeanValue), ("Wachspress", Family::Wachspress), ("Conformal", Family::Conformal)]
    {
        window.choose("Weights", title);
        assert_eq!(window.outcome().problem.settings.family(), family);
        assert_numbers_show(&window);
        assert_ne!(window.embedding(), before);
        before = window.embedding();
    }
}

#[test]
fn other_weights_change_the_verdict_s_words() {
    let mut window = Window::with_example(Example::Dome);
    window.choose("Method", "Natural boundary");
    assert!(window.is_proved(), "{}", window.verdict());
    window.choose("Weights", "Wachspress");
    let count = window.outcome().step.verdict.flipped_faces.len();
    assert!(count > 0, "Wachspress weights fold a face of the dome");
    assert_eq!((window.pill(), window.numbers_of_verdict()[0]), (Pill::Bad, count), "{}", window.verdict());
    assert_message("panels-window-verdict-of-flipped-faces", &window.verdict());
    assert!(window.has_button(&format!("Defects {}", window.editor().defect_count())));
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn uniform_and_shape_preserving_weights_are_offered_for_a_convex_boundary_only() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.open_list("Weights");
    assert!(!window.has_button("Uniform") && !window.has_button("Shape-preserving"));
    window.key(Key::Escape);
    window.choose("Method", "Convex boundary");
    window.choose("Weights", "Uniform");
    assert_eq!(window.outcome().problem.settings.family(), Family::Uniform);
    window.choose("Weights", "Shape-preserving");
    assert_eq!(window.outcome().problem.settings.family(), Family::ShapePreserving);
    assert!(window.is_proved(), "{}", window.verdict());
    window.choose("Method", "Natural boundary");
    let settings = window.outcome().problem.settings.clone();
    assert_eq!(settings, Settings { method: Method::Natural, ..Settings::default() });
    assert_eq!(settings.family(), Family::Conformal);
}

#[test]
fn the_convex_boundary_can_be_a_square() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Convex boundary");
    let on_circle = window.embedding();
    window.choose("Shape of the boundary", "Square");
    assert_eq!(settings(&window).method, Method::Convex(BoundaryShape::Square));
    assert_ne!(window.embedding(), on_circle);
    window.choose("Shape of the boundary", "Circle");
    assert_eq!(window.embedding(), on_circle);
    window.choose("Shape of the boundary", "Hull");
    assert_eq!(settings(&window).method, Method::Convex(BoundaryShape::Hull));
    window.click("Even");
    assert_eq!(settings(&window).spacing, Spacing::Even);
    assert_eq!(window.outcome().problem.settings, settings(&window), "solved");
}

#[test]
fn a_polygon_s_corners_are_typed_and_refused_with_the_reason() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Stretch minimising");
    window.choose("Shape of the boundary", "Polygon");
    let hexagon = Method::Stretch(BoundaryShape::Polygon(ConvexPolygon::HEXAGON));
    assert_eq!(settings(&window).method, hexagon);
    window.fill_in(Role::TextInput, "Corners of the polygon", "0 0; 3 0; 3 2; 0 2");
    window.key(Key::Enter);
    let rectangle = ConvexPolygon::parse("0 0; 3 0; 3 2; 0 2").expect("convex");
    assert_eq!(settings(&window).method, Method::Stretch(BoundaryShape::Polygon(rectangle.clone())));
    assert_eq!(window.outcome().problem.settings, settings(&window), "solved");
    window.fill_in(Role::TextInput, "Corners of the polygon", "0 0; 0 1; 1 0");
    window.key(Key::Enter);
    assert_eq!(settings(&window).method, Method::Stretch(BoundaryShape::Polygon(rectangle)), "not taken");
    assert_message("panels-window-polygon-is-clockwise", &window.text_with("clockwise"));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&window).method, hexagon, "one step of undo");
}

#[test]
fn lee_s_layers_are_a_number_of_the_method_s_tab() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Lee's virtual boundary");
    assert_eq!(settings(&window).family(), Family::MeanValue, "positive, so that it is planar");
    assert!(window.is_proved(), "{}", window.verdict());
    window.harness.get_by_label("More").click();
    window.settle();
    let before = window.embedding();
    window.fill_in(Role::SpinButton, "Layers", "4");
    window.key(Key::Enter);
    assert_eq!(settings(&window).layers, 4);
    assert_ne!(window.embedding(), before);
    window.choose("Method", "SLIM");
    assert_eq!((settings(&window).max_steps(), settings(&window).family()), (20, Family::Conformal));
    window.choose("Method", "Natural boundary");
    assert_eq!(settings(&window).max_steps(), Settings::MAX_STEPS);
}

#[test]
fn the_power_slider_solves_and_is_one_undo_step() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Weights", "Power");
    let before = settings(&window);
    let slider = window.rect(Role::Slider, "Power of the weights");
    let at = |share: f32| slider.left_center() + egui::vec2(8.0 + share * (slider.width() - 70.0), 0.0);
    window.drag(at(0.9), at(0.2), Modifiers::NONE);
    let Family::Power(power) = settings(&window).family() else { panic!("{:?}", settings(&window)) };
    assert!((-1.0..0.0).contains(&power), "{power}");
    assert_eq!(window.outcome().problem.settings, settings(&window));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(settings(&window), before);
}

#[test]
fn a_power_can_be_typed_beyond_the_slider_s_ends() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Weights", "Power");
    window.fill_in(Role::SpinButton, "Power of the weights", "1.5");
    window.key(Key::Enter);
    assert_eq!(window.outcome().problem.settings.family(), Family::Power(1.5));
}

#[test]
fn one_list_chooses_the_weights_and_a_power_alone_has_a_slider() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let has_slider =
        |window: &Window| window.harness.query_by_role_and_label(Role::Slider, "Power of the weights").is_some();
    for title in ["Wachspress", "Mean value", "Conformal"] {
        window.choose("Weights", title);
        assert!(!has_slider(&window) && !window.has_button(title), "{title} is said once");
    }
    let before = window.embedding();
    window.choose("Weights", "Power");
    assert_eq!(settings(&window).family(), Family::Power(1.0), "a power begins as the family before it");
    assert!(has_slider(&window));
    assert_eq!(window.embedding(), before);
}

fn pin(window: &mut Window, vertices: &[u32]) {
    window.editor_mut().session.handle(Action::Fix(vertices.iter().map(|&v| VertexId::new(v)).collect()));
    window.settle();
    window.click("Pins");
}

#[test]
fn typed_coordinates_move_a_pin_and_only_it() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 24, 48]);
    let before = window.editor().session.document().clone();
    window.fill_in(Role::SpinButton, "u of pin v24", "0.625");
    window.key(Key::Enter);
    let mut expected = before.targets.clone();
    expected.get_mut(&VertexId::new(24)).expect("pinned").uv.x = 0.625;
    assert_eq!(window.editor().session.document().targets, expected);
    assert_eq!(window.embedding()[24], expected[&VertexId::new(24)].uv);
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.editor().session.document(), before, "one undo step");
}

#[test]
fn looking_at_a_coordinate_changes_nothing() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 24, 48]);
    let before = window.editor().session.document().clone();
    for field in ["u of pin v24", "v of pin v24"] {
        window.harness.get_by_role_and_label(Role::SpinButton, field).click();
        window.settle();
        window.key(Key::Enter);
    }
    assert_eq!(*window.editor().session.document(), before);
}

#[test]
fn a_coordinate_that_is_no_number_changes_nothing() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 48]);
    let before = window.editor().session.document().clone();
    let name = "u of pin v48";
    let mut field = name.to_owned();
    for text in ["", "abc", "nan", "inf"] {
        window.fill_in(Role::SpinButton, &field, text);
        window.key(Key::Enter);
        assert_eq!(*window.editor().session.document(), before, "{text:?}");
        field = window.name_of(Role::SpinButton, name);
        assert!(text.is_empty() || (field != name && field.contains(text)), "{field}");
    }
}

#[test]
fn pins_are_freed_one_by_one_and_all_at_once() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 24, 48]);
    assert!(window.has_button("Pins 3"));
    window.click("Free pin v24");
    let pinned: Vec<u32> = window.editor().session.document().targets.keys().map(|v| v.number()).collect();
    assert_eq!(pinned, [0, 48]);
    window.click("Free all");
    assert!(window.editor().session.document().targets.is_empty());
    assert!(window.harness.query_by_role_and_label(Role::Button, "Pins").is_some(), "no count any more");
    window.menu(&["Edit", "Undo"]);
    assert_eq!(window.editor().session.document().targets.len(), 2);
    window.menu(&["Edit", "Redo"]);
    assert!(window.editor().session.document().targets.is_empty());
}

#[test]
fn delete_frees_the_selected_pins() {
    for key in [Key::Delete, Key::Backspace] {
        let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
        pin(&mut window, &[0, 24, 48]);
        window.click("v24");
        assert!(window.editor().selection.vertices().contains(&VertexId::new(24)));
        window.key(key);
        assert_eq!(window.editor().session.document().targets.len(), 2, "{key:?}");
    }
}

#[test]
fn two_pins_on_one_place_are_refused_with_both_named() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 48]);
    let place = window.editor().session.document().targets[&VertexId::new(0)].uv;
    window.editor_mut().session.handle(Action::MovePin { vertex: VertexId::new(48), target: place });
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    let message = &window.editor().session.messages()[0];
    assert!(message.text.contains("v0") && message.text.contains("v48"), "{}", message.text);
    assert!(window.shows(&sentence(&message.text)));
    assert!(matches!(window.editor().session.status(), Status::Stale), "{}", window.verdict());
    assert_eq!(window.pill(), Pill::Stale);
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(window.editor().session.messages().is_empty(), "mended");
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn the_vertex_tab_tells_of_the_selected_vertex_and_fixes_it() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.click("Vertex");
    assert_message("panels-window-no-vertex-selected", &window.text_with("Select "));
    window.editor_mut().selection.add([VertexId::new(24)]);
    window.settle();
    assert!(window.shows("v24") && window.shows("inside"));
    window.click("Fix");
    assert!(window.editor().session.document().targets.contains_key(&VertexId::new(24)));
    window.click("Free");
    assert!(window.editor().session.document().targets.is_empty());
}

#[test]
fn tabs_are_opened_and_panels_hidden() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    for tab in [Tab::Pins, Tab::Defects, Tab::Vertex, Tab::Method] {
        window.click_last(tab.title());
        assert_eq!(window.editor().layout.tab(), tab);
    }
    window.menu(&["View", "Panels"]);
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Method").is_none());
    window.menu(&["Solve", "Method and weights"]);
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Method").is_some());
}

#[test]
fn the_numbers_of_the_solve_unfold() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    assert!(!window.shows("Pivots"));
    window.harness.get_by_label("Numbers of the solve").click();
    window.settle();
    assert!(window.shows("Pivots"));
    assert_message("panels-window-row-of-a-number", &spoken(&window, "Pivots ").expect("a row with its number"));
    let place = window.harness.get_by_label("Numbers of the solve");
    assert!(!place.accesskit_node().is_hidden());
}

#[test]
fn a_pinned_vertex_lies_on_its_pin_under_every_method() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    pin(&mut window, &[0, 48]);
    let target = DVec2::new(-0.25, 0.125);
    window.editor_mut().session.handle(Action::MovePin { vertex: VertexId::new(0), target });
    window.settle();
    window.click("Method");
    for title in ["Lévy, summed", "Least-squares conformal", "Natural boundary"] {
        window.choose("Method", title);
        assert_eq!(window.embedding()[0], target, "{title}");
    }
}

/// True if a node has exactly this accessibility label.
fn has_label(window: &Window, words: &str) -> bool {
    window.harness.query_all_by_label(words).next().is_some()
}

#[test]
fn every_row_of_numbers_says_its_name() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let summary = window.outcome().distortion.summary;
    for (name, value) in [("Angle", summary.angle.mean), ("Area", summary.area.p99), ("Stretch", summary.stretch_l2)] {
        assert!(has_label(&window, &format!("{name}: {value:.3}")), "{name}");
    }
    window.editor_mut().selection.add([VertexId::new(24)]);
    window.click("Vertex");
    assert!(has_label(&window, "Valence: 6") && has_label(&window, "Location: inside"));
    for name in ["x: ", "u: ", "Angles ", "Residual: ", "Barycentre: ", "Equation "] {
        assert!(spoken(&window, name).is_some(), "{name}");
    }
}

/// Row of a number whose name begins with `name`: name and number.
fn row<'a>(window: &'a Window, name: &str) -> Option<egui_kittest::Node<'a>> {
    let is_row = |node: &egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        node.label().or_else(|| node.value()).is_some_and(|words| words.starts_with(name) && words.contains(": "))
    };
    window.harness.root().children_recursive().find(is_row)
}

/// Words of the row of a number, for screen readers.
fn spoken(window: &Window, name: &str) -> Option<String> {
    let node = row(window, name)?.accesskit_node();
    node.label().or_else(|| node.value())
}

#[test]
fn numbers_lie_under_each_other_at_the_right() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.harness.get_by_label("Numbers of the solve").click();
    window.settle();
    let edges = ["Residual: ", "Assembly: ", "Pivots "].map(|name| row(&window, name).expect("a row").rect().right());
    assert!((edges[0] - edges[1]).abs() < 1.0 && (edges[1] - edges[2]).abs() < 1.0, "{edges:?}");
}

#[test]
fn the_panel_keeps_its_width_whatever_it_shows() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let edge = window.plane_view().right();
    window.editor_mut().selection.add([VertexId::new(24)]);
    for tab in [Tab::Pins, Tab::Defects, Tab::Vertex, Tab::Method] {
        window.click_last(tab.title());
        assert!((window.plane_view().right() - edge).abs() < 0.5, "{tab:?}");
    }
    window.choose("Method", "Convex boundary");
    assert!((window.plane_view().right() - edge).abs() < 0.5);
}

#[test]
fn measures_explain_themselves_under_the_pointer() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    for (name, measure) in [("Angle", Measure::Angle), ("Area", Measure::Area), ("Weights", Measure::Weights)] {
        let label = window.harness.query_all_by_role_and_label(Role::Label, name).next().expect("a label").rect();
        window.harness.hover_at(label.center());
        for _ in 0..60 {
            window.step();
        }
        assert!(window.shows(measure.tip()), "{name}: {:?}", window.words());
    }
}

#[test]
fn every_column_of_named_pins_fits_into_the_panel() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let vertices = [10, 24, 33].map(VertexId::new);
    for (vertex, name) in vertices.into_iter().zip(["left eye, outer corner", "a", &"long ".repeat(11)]) {
        let target = Target::hard(DVec2::new(0.1 * vertex.index() as f64, 0.5));
        let name = PinName::new(name).ok();
        window.editor_mut().session.handle(Action::Place { vertex, target });
        window.editor_mut().session.handle(Action::NamePin { vertex, name });
    }
    window.settle();
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    for vertex in vertices {
        let free = window.rect(Role::Button, &format!("Free pin {vertex}"));
        assert!(free.right() < SIZE.x && free.left() > window.plane_view().right(), "{vertex}: {free}");
    }
}
