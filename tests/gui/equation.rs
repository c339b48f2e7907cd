//! Equation of the selected vertex, in the panel and in the embedding's pane.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::Tab;
use freebound_core::flatten::equation_of_step;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{Method, NoEquation, Settings, Stage};

use crate::harness::{Window, sheet};
use freebound_testkit::assert_message;

/// Vertex in the middle of the sheet's lower side, and an inner vertex.
const ON_BOUNDARY: VertexId = VertexId::new(3);
const INSIDE: VertexId = VertexId::new(24);

/// Sheet flattened by one linear solve, with the panel of a vertex open.
fn window(vertex: VertexId) -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.choose("Method", "Natural boundary");
    select(&mut window, vertex);
    window
}

fn select(window: &mut Window, vertex: VertexId) {
    window.editor_mut().layout.show_tab(Tab::Vertex);
    window.editor_mut().selection.select([vertex]);
    window.settle();
}

/// Neighbours in the table.
fn links(window: &Window) -> Vec<String> {
    let links = window.harness.query_all_by_role(Role::Link);
    links.filter_map(|link| link.accesskit_node().label()).collect()
}

/// Number of line ends near `place`.
fn line_ends_at(window: &Window, place: Pos2) -> usize {
    window.lines().iter().flatten().filter(|end| end.distance(place) < 1.0).count()
}

#[test]
fn the_table_has_each_neighbour_with_shares_that_sum_to_one() {
    let window = window(ON_BOUNDARY);
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    let neighbours: Vec<String> = disk.outgoing(ON_BOUNDARY).map(|h| disk.head(h).to_string()).collect();
    assert_eq!(links(&window), neighbours);
    let outcome = window.outcome();
    let (equation, _) = equation_of_step(&disk, &outcome.step, None, ON_BOUNDARY).expect("linear");
    for term in &equation.terms {
        assert!(window.shows(&format!("{:.3}", term.share)), "{} in {:?}", term.share, window.words());
    }
    assert!(window.shows("eq. 3") && window.shows("Offset"));
    assert!(!window.shows("Not "));
}

#[test]
fn an_interior_vertex_has_no_offset() {
    let mut window = window(INSIDE);
    assert!(window.shows("eq. 2") && window.shows("Barycentre") && !window.shows("Offset"));
    select(&mut window, ON_BOUNDARY);
    assert!(window.shows("Offset"));
}

#[test]
fn a_click_on_a_neighbour_goes_on_to_it() {
    let mut window = window(INSIDE);
    let first = links(&window)[0].clone();
    window.harness.get_by_role_and_label(Role::Link, &first).click();
    window.settle();
    let selected: Vec<String> = window.editor().selection.vertices().iter().map(ToString::to_string).collect();
    assert_eq!(selected, [first]);
}

#[test]
fn the_offset_is_an_arrow_from_the_barycentre_to_the_vertex() {
    let mut window = window(ON_BOUNDARY);
    let outcome = window.outcome();
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    let (equation, _) = equation_of_step(&disk, &outcome.step, None, ON_BOUNDARY).expect("linear");
    let barycentre = window.place_in_plane(equation.barycentre);
    let vertex = window.place_in_plane(window.embedding()[ON_BOUNDARY.index()]);
    assert!(barycentre.distance(vertex) > 5.0, "to be seen");
    // Each line is drawn twice, the wider one below for contrast.
    assert_eq!(line_ends_at(&window, barycentre), 2, "the arrow begins");
    assert!(line_ends_at(&window, vertex) >= equation.terms.len(), "spokes");
    let met = window.place_in_plane(equation.barycentre + equation.offset_vector.expect("on the boundary"));
    assert!(met.distance(vertex) < 0.5, "it ends at the vertex");
    window.click("Method");
    assert_eq!(line_ends_at(&window, barycentre), 0, "only while its panel is open");
}

#[test]
fn a_pinned_vertex_need_not_meet_its_equation() {
    let mut window = window(ON_BOUNDARY);
    let pins = [0, 6, 42, 48].map(VertexId::new).into_iter().chain([INSIDE]).collect();
    window.editor_mut().session.handle(Action::Fix(pins));
    let target = window.embedding()[INSIDE.index()] + 0.1;
    window.editor_mut().session.handle(Action::MovePin { vertex: INSIDE, target });
    window.editor_mut().session.handle(Action::EndGesture);
    window.settle();
    select(&mut window, INSIDE);
    assert_message("equation-window-pinned-vertex", &window.text_with("pinned"));
}

#[test]
fn a_vertex_without_an_equation_says_why() {
    let mut window = window(ON_BOUNDARY);
    for (method, reason) in [("Convex boundary", NoEquation::Prescribed), ("Lévy, summed", NoEquation::OfTriangles)] {
        window.click("Method");
        window.choose("Method", method);
        select(&mut window, ON_BOUNDARY);
        assert!(window.shows(reason.words()), "{:?}", window.words());
        assert!(links(&window).is_empty());
    }
}

#[test]
fn an_iteration_s_weights_are_those_of_the_step_before() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    let settings = Settings { method: Method::Iterate, ..Settings::default() };
    window.editor_mut().session.handle(Action::SetSettings(settings));
    window.settle();
    window.key(Key::Space);
    assert_eq!(window.outcome().step.candidate.stage, Stage::Iterate);
    select(&mut window, INSIDE);
    assert!(window.shows("(§4)"), "{:?}", window.words());
    assert!(!window.shows("Not "), "{:?}", window.words());
}

#[test]
fn a_vertex_in_a_pocket_has_virtual_or_boundary_neighbours_as_well() {
    let mut window = Window::with_example(Example::Face);
    window.choose("Method", "Virtual boundary");
    let outcome = window.outcome();
    let stages = outcome.step.candidate.virtual_boundary.as_ref().expect("the face bends");
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    let vertex = *disk.boundary_loop().iter().find(|v| !stages.hull.contains(v)).expect("in a pocket");
    select(&mut window, vertex);
    assert!(window.shows("(§5)"));
    assert!(links(&window).len() > disk.outgoing(vertex).count(), "the pocket's edges count");
    assert!(!window.shows("Not "), "{:?}", window.words());
    select(&mut window, stages.hull[0]);
    assert!(window.shows(NoEquation::Prescribed.words()));
}
