//! Pins of charts on the page: they are set where the vertices lie, and no chart moves.

use eframe::egui;
use egui::{Key, Modifiers};
use freebound::session::{Action, LockState, movement_about};
use freebound::ui::{PageRequest, PinMark, Request, Tab};
use freebound_core::geom::{PackingOptions, VAxis};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Problem;
use freebound_core::problem::{Embedding, PinKind};
use freebound_testkit::assert_message;
use glam::{DAffine2, DVec2};

use crate::charts::with_sheets;
use crate::harness::Window;
use crate::page::{middle, until_proved};

/// Distance up to which a chart has not moved: the pins of a chart are written and read again as texture coordinates.
const ROUNDING: f64 = 1e-12;

fn coordinates(window: &Window) -> Vec<Embedding> {
    let page = window.editor().session.page().expect("a page");
    page.charts.iter().map(|chart| Embedding::clone(&chart.coordinates)).collect()
}

/// Greatest distance between the places of vertices.
fn moved(before: &Embedding, after: &Embedding) -> f64 {
    assert_eq!(before.len(), after.len());
    before.iter().zip(after.iter()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// Pinned vertices of each chart.
fn pinned(window: &Window) -> Vec<Vec<usize>> {
    let session = &window.editor().session;
    let of = |chart| session.targets_of_chart(chart).map(|targets| targets.keys().map(|v| v.index()).collect());
    (0..3).map(|chart| of(chart).unwrap_or_default()).collect()
}

/// Selects vertices of charts by clicks on the page.
fn select(window: &mut Window, vertices: &[(usize, usize)]) {
    window.press(Modifiers::COMMAND, Key::Num1);
    window.key(Key::Escape);
    for &(chart, vertex) in vertices {
        let page = window.editor().session.page().expect("a page");
        let at = page.charts[chart].coordinates[vertex] * DVec2::new(page.aspect, 1.0);
        let spot = crate::page::spot(window, at);
        window.click_at(spot, Modifiers::SHIFT);
    }
    assert_eq!(window.editor().plane.page.elements().vertices().len(), vertices.len());
}

fn fix(window: &mut Window, vertices: &[(usize, usize)]) {
    select(window, vertices);
    window.menu(&["Edit", "Fix the selection"]);
    until_proved(window);
}

fn depth(window: &Window) -> usize {
    window.editor().session.history().depth()
}

#[test]
fn vertices_of_several_charts_are_pinned_where_they_lie_by_one_edit() {
    let mut window = with_sheets();
    let (before, edits) = (coordinates(&window), depth(&window));
    fix(&mut window, &[(0, 0), (0, 4), (0, 12), (2, 5)]);
    assert_eq!(pinned(&window), [vec![0, 4, 12], vec![], vec![5]]);
    assert_eq!(depth(&window), edits + 1);
    let after = coordinates(&window);
    assert_eq!(after[1], before[1], "a chart without new pins stays to the last bit");
    for chart in [0, 2] {
        assert!(moved(&before[chart], &after[chart]) < ROUNDING, "chart {chart}");
        assert_eq!(window.editor().session.lock_state(chart), LockState::Pinned);
    }
    let session = &window.editor().session;
    for (chart, vertex) in [(0, 4), (2, 5)] {
        let target = session.targets_of_chart(chart).expect("a chart")[&VertexId::new(vertex)];
        assert_eq!((target.uv, target.kind), (after[chart][vertex as usize], PinKind::Fixed));
    }
    assert!(session.atlas().expect("laid out").verdict.planar);
    let marks = window.editor().pins_on_page();
    assert_eq!(marks.len(), 4);
    assert!(marks.iter().all(|pin| pin.kind == PinMark::User(PinKind::Fixed) && !pin.is_unmet));
    window.press(Modifiers::COMMAND, Key::Z);
    until_proved(&mut window);
    assert_eq!((pinned(&window), coordinates(&window)), (vec![vec![]; 3], before));
    window.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    until_proved(&mut window);
    assert_eq!(coordinates(&window), after);
}

#[test]
fn pinned_vertices_stay_on_a_picture_with_v_down() {
    let mut window = with_sheets();
    window.editor_mut().session.handle(Action::SetVAxis(VAxis::Down));
    until_proved(&mut window);
    let before = coordinates(&window);
    fix(&mut window, &[(1, 0), (1, 6), (1, 24)]);
    assert_eq!(pinned(&window)[1], [0, 6, 24]);
    for (before, after) in before.iter().zip(coordinates(&window)) {
        assert!(moved(before, &after) < ROUNDING);
    }
}

#[test]
fn delete_frees_the_selected_pins_of_the_page_and_no_chart_moves() {
    let mut window = with_sheets();
    fix(&mut window, &[(0, 0), (0, 4), (2, 5), (2, 40)]);
    let before = coordinates(&window);
    select(&mut window, &[(0, 0), (0, 4), (0, 8), (2, 5)]);
    window.key(Key::Delete);
    until_proved(&mut window);
    assert_eq!(pinned(&window), [vec![], vec![], vec![40]]);
    for (before, after) in before.iter().zip(coordinates(&window)) {
        assert!(moved(before, &after) < ROUNDING);
    }
    let lock = |chart| window.editor().session.lock_state(chart);
    assert_eq!([0, 1, 2].map(lock), [LockState::Open, LockState::Open, LockState::Pinned]);
}

#[test]
fn the_pins_of_selected_charts_are_freed_and_all_pins_by_the_menu() {
    let mut window = with_sheets();
    fix(&mut window, &[(0, 0), (0, 4), (1, 3), (2, 5)]);
    window.press(Modifiers::COMMAND, Key::Num4);
    let at = middle(&window, 0);
    window.click_at(at, Modifiers::NONE);
    window.menu(&["Edit", "Free the selected pins"]);
    until_proved(&mut window);
    assert_eq!(pinned(&window), [vec![], vec![3], vec![5]]);
    window.menu(&["Edit", "Free all pins"]);
    until_proved(&mut window);
    assert_eq!(pinned(&window), vec![Vec::<usize>::new(); 3]);
}

#[test]
fn a_chart_that_lies_mirrored_keeps_its_vertices_free_and_says_why() {
    let mut window = with_sheets();
    let at = middle(&window, 1);
    window.click_at(at, Modifiers::NONE);
    let axis = freebound::ui::Axis::X;
    window.editor_mut().handle(PageRequest::Mirror(axis).into());
    until_proved(&mut window);
    let (before, edits) = (coordinates(&window), depth(&window));
    select(&mut window, &[(1, 0), (1, 24)]);
    window.editor_mut().handle(Request::FixSelection);
    until_proved(&mut window);
    assert_eq!((pinned(&window), depth(&window)), (vec![vec![]; 3], edits));
    assert_eq!(coordinates(&window), before);
    let message = window.editor().session.messages().last().expect("it is said");
    assert_message("page-pins-mirrored", &format!("{}\n{:?}", message.text, message.remedy));
}

#[test]
fn further_pins_keep_a_pinned_chart_at_its_place_with_v_down() {
    let mut window = with_sheets();
    window.editor_mut().session.handle(Action::SetVAxis(VAxis::Down));
    until_proved(&mut window);
    for chart in [1, 2] {
        fix(&mut window, &[(chart, 0), (chart, 6)]);
    }
    let before = coordinates(&window);
    for chart in [1, 2] {
        fix(&mut window, &[(chart, 20), (chart, 24)]);
    }
    for (before, after) in before.iter().zip(coordinates(&window)) {
        assert!(moved(before, &after) < ROUNDING);
    }
    let page = window.editor().session.page().expect("a page");
    let problems = page.charts.iter().map(|chart| &chart.outcome.problem).filter(|problem| !problem.targets.is_empty());
    assert!(problems.clone().count() == 2 && problems.into_iter().all(Problem::shaped_map_meets_pins));
}

#[test]
fn freeing_one_of_several_pins_changes_no_map() {
    for chart in [1, 2] {
        let mut window = with_sheets();
        fix(&mut window, &[(chart, 0), (chart, 6), (chart, 20), (chart, 24)]);
        let before = coordinates(&window);
        select(&mut window, &[(chart, 20)]);
        window.key(Key::Delete);
        until_proved(&mut window);
        assert_eq!(pinned(&window)[chart], [0, 6, 24]);
        for (before, after) in before.iter().zip(coordinates(&window)) {
            assert!(moved(before, &after) < ROUNDING);
        }
    }
}

#[test]
fn a_chart_with_one_pin_keeps_its_size_and_its_turn_in_a_saved_project() {
    let mut window = with_sheets();
    let at = middle(&window, 2);
    window.click_at(at, Modifiers::NONE);
    let turned = DAffine2::from_scale_angle_translation(DVec2::splat(0.5), 0.3, DVec2::ZERO);
    let by = movement_about(window.editor().session.page().expect("a page").bounds_of(2).middle(), turned);
    window.editor_mut().session.handle(Action::MoveCharts { moves: vec![(2, by)], insists: true });
    window.editor_mut().session.handle(Action::EndMove);
    until_proved(&mut window);
    fix(&mut window, &[(0, 0), (0, 4), (2, 5)]);
    let before = coordinates(&window);
    let project = window.path("pinned.freebound");
    window.editor_mut().session.handle(Action::SaveProject(project.clone()));
    window.settle();
    let mut again = Window::with_file(&project);
    until_proved(&mut again);
    assert_eq!(pinned(&again), pinned(&window));
    for (before, after) in before.iter().zip(coordinates(&again)) {
        assert!(moved(before, &after) < 1e-9, "{}", moved(before, &after));
    }
}

#[test]
fn vertices_on_a_page_of_another_shape_than_their_maps_are_not_pinned() {
    let mut window = with_sheets();
    let packing = PackingOptions { picture: [2048, 1024], ..window.editor().session.packing() };
    window.editor_mut().session.handle(Action::SetPacking(packing));
    until_proved(&mut window);
    window.key(Key::F);
    let edits = depth(&window);
    select(&mut window, &[(0, 0), (2, 5)]);
    window.editor_mut().handle(Request::FixSelection);
    until_proved(&mut window);
    assert_eq!((pinned(&window), depth(&window)), (vec![vec![]; 3], edits));
    let message = window.editor().session.messages().last().expect("it is said");
    assert_message("page-pins-other-shape", &format!("{}\n{:?}", message.text, message.remedy));
}

#[test]
fn the_pins_tab_tells_of_pins_on_other_charts_and_frees_all_of_the_page() {
    let mut window = with_sheets();
    fix(&mut window, &[(0, 0), (0, 4), (1, 3)]);
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    assert_message("page-pins-tab", &window.text_with("Pins of chart"));
    window.click("Free all");
    until_proved(&mut window);
    assert_eq!(pinned(&window), vec![Vec::<usize>::new(); 3]);
}
