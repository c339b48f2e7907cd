//! Vertices have different numbers on charts, and after cuts, than in the file. Clicks, texts and the selection use
//! the file's numbers.

use eframe::egui;
use egui::{Key, Modifiers};
use freebound::session::Action;
use freebound::ui::{Request, SeamClick, Tool};
use freebound_core::mesh::{Seams, VertexId};

use crate::charts::with_sheets;
use crate::harness::{Window, sheet, write_obj};
use crate::seams::{AROUND, at, column, front, hints_at, last, seams, side_of, window};
use freebound_testkit::assert_message;

/// Cuts the barrel around its middle row into an upper and a lower chart.
fn cut_around(window: &mut Window) {
    let around = |k: u32| [at(k, 3), at((k + 1) % AROUND, 3)];
    let seams = Seams::default().with((0..AROUND).map(around));
    window.editor_mut().handle(Action::SetSeams(seams).into());
    window.settle();
}

fn show_chart(window: &mut Window, chart: usize) {
    window.editor_mut().handle(Action::ShowChart(chart).into());
    window.settle();
    assert_eq!(window.editor().session.chart_on_screen(), Some(chart));
}

/// Shown vertices that coincide with a vertex of the file.
fn on_screen(window: &Window, of_file: VertexId) -> Vec<VertexId> {
    let scene = window.editor().mesh_scene().expect("a mesh shows");
    let source = &window.editor().session.model().expect("open").source.polygons;
    let unit = window.editor().session.model().and_then(|model| model.disk()).map_or(1.0, |disk| disk.unit());
    let is_there = |&vertex: &VertexId| {
        let position = scene.mesh().positions[vertex.index()] * unit;
        position.distance(source.positions[of_file.index()]) < 1e-9
    };
    (0..scene.mesh().vertex_count()).map(VertexId::from_index).filter(is_there).collect()
}

fn selected(window: &Window) -> Vec<VertexId> {
    window.editor().selection.vertices().iter().copied().collect()
}

#[test]
fn a_click_in_the_layout_of_a_later_chart_begins_the_seam_at_its_own_vertex_of_the_file() {
    let mut window = with_sheets();
    assert_eq!(window.editor().session.chart_on_screen(), Some(2));
    window.key(Key::X);
    let own = 33;
    let place = window.place_in_plane(window.embedding()[VertexId::new(own)]);
    window.click_at(place, Modifiers::NONE);
    // The charts before it have 25 and 49 vertices.
    assert_eq!(last(&window), Some(VertexId::new(25 + 49 + own)));
}

#[test]
fn a_vertex_on_the_seam_of_any_chart_says_that_it_is_and_others_do_not() {
    let mut window = window();
    cut_around(&mut window);
    for chart in [0, 1] {
        show_chart(&mut window, chart);
        window.click("Vertex");
        for row in [3, 2 + 2 * u32::try_from(chart).expect("few")] {
            let here = on_screen(&window, at(5, row));
            assert_eq!(here.len(), 1, "row {row} of chart {chart}");
            window.editor_mut().selection.select(here);
            window.settle();
            let is_said = [side_of(&window, at(5, row)).is_some(), window.shows(" side ")];
            assert_eq!(is_said, [row == 3; 2], "row {row} of chart {chart}: {:?}", window.words());
        }
    }
}

#[test]
fn the_selection_stays_where_it_is_when_the_mesh_is_cut_otherwise() {
    let mut window = window();
    cut_around(&mut window);
    show_chart(&mut window, 1);
    let here = on_screen(&window, at(5, 5));
    assert_ne!(here, [at(5, 5)], "a chart has numbers of its own");
    window.editor_mut().selection.select(here);
    window.editor_mut().handle(Action::SetSeams(Seams::default()).into());
    window.settle();
    assert_eq!(window.editor().session.chart_on_screen(), None);
    assert_eq!(selected(&window), [at(5, 5)]);
    // If cut through, it appears twice; if sewn up, once again.
    let k = 5;
    let through = (0..6).map(|row| [at(k, row), at(k, row + 1)]);
    window.editor_mut().handle(Action::SetSeams(Seams::default().with(through)).into());
    window.settle();
    assert_eq!(seams(&window), column(k, 0..6));
    assert_eq!(selected(&window), on_screen(&window, at(k, 5)));
    assert_eq!(selected(&window).len(), 2);
    window.editor_mut().handle(Action::SetSeams(Seams::default()).into());
    window.settle();
    assert_eq!(selected(&window), [at(k, 5)]);
}

#[test]
fn the_selection_does_not_go_over_to_the_chart_across_the_seam() {
    let mut window = window();
    cut_around(&mut window);
    show_chart(&mut window, 1);
    let here = on_screen(&window, at(5, 3));
    window.editor_mut().selection.select(here);
    show_chart(&mut window, 0);
    assert!(selected(&window).is_empty());
}

#[test]
fn a_seam_that_was_begun_at_once_is_ended_when_another_file_opens() {
    let mut window = Window::with_mesh("large.obj", &sheet(60, 0.3));
    let small = window.path("small.obj");
    write_obj(&small, &sheet(3, 0.3));
    window.editor_mut().handle(Request::SetTool(Tool::Seam));
    let click = SeamClick { vertex: VertexId::new(1), erases: false };
    window.editor_mut().handle(Request::ClickSeam(click));
    assert_eq!(last(&window), Some(VertexId::new(1)));
    window.open(&small);
    assert_eq!((window.editor().tools.tool(), last(&window)), (Tool::Seam, None));
}

#[test]
fn what_a_click_would_cut_follows_the_pointer_and_shift_and_undo() {
    let mut window = window();
    let k = front(&window);
    crate::seams::click(&mut window, at(k, 0), Modifiers::NONE);
    crate::seams::click(&mut window, at(k, 4), Modifiers::NONE);
    window.harness.hover_at(crate::seams::place(&window, at(k, 6)));
    window.settle();
    assert!(hints_at(&window, 2, at(k, 6)), "{:?}", window.words());
    window.frame([egui::Event::ModifiersChanged(Modifiers::SHIFT)]);
    assert_message("seam-numbers-window-no-seam-there", &window.text_with("No "));
    window.harness.hover_at(crate::seams::place(&window, at(k, 2)));
    window.step();
    window.step();
    assert_message("seam-numbers-window-hint-that-erases", &window.text_with("Click"));
    window.frame([egui::Event::ModifiersChanged(Modifiers::NONE)]);
    window.press(Modifiers::COMMAND, Key::Z);
    window.settle();
    assert!(hints_at(&window, 2, at(k, 2)), "{:?}", window.words());
}
