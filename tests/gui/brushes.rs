//! The brush tool in the embedding pane.

use std::sync::Arc;

use eframe::egui::{Key, Modifiers, Pos2, Vec2};
use freebound::examples::Example;
use freebound::session::{Action, LockState, PageStroke};
use freebound::ui::{Editor, Tool};
use freebound::view::PlaneArrays;
use freebound_core::bijective::BrushKind;
use freebound_core::mesh::VertexId;
use freebound_core::problem::Embedding;

use crate::charts::{beside_each_other, until_laid_out, with_sheets};
use crate::harness::{Pill, Window, sheet};
use crate::page;
use crate::presses::button;

/// Window with a planar map and the brush tool.
fn window() -> Window {
    let mut window = Window::with_example(Example::Dome);
    window.key(Key::B);
    assert_eq!(window.editor().tools.tool(), Tool::Brush);
    window
}

/// Middle of the map on the screen.
fn middle(window: &Window) -> Pos2 {
    window.place_in_plane(window.embedding().bounds().middle())
}

fn can_undo(window: &Window) -> bool {
    window.editor().session.history().can_undo()
}

#[test]
fn a_drag_with_each_brush_is_one_edit_of_the_map_and_keeps_the_camera() {
    let mut window = window();
    let before = window.embedding();
    let camera = window.editor().plane.pane.camera();
    for (name, kind) in [
        ("Relax", BrushKind::Relax),
        ("Grab", BrushKind::Grab),
        ("Pinch", BrushKind::Pinch),
        ("Texels", BrushKind::Texels),
    ] {
        window.click(&format!("{name} brush"));
        assert_eq!(window.editor().tools.brush.kind, kind);
        let from = middle(&window);
        assert!(!can_undo(&window), "a click on the bar is no stroke");
        window.drag(from, from + Vec2::new(30.0, 12.0), Modifiers::NONE);
        assert!(window.embedding() != before, "{name}");
        assert_eq!(window.editor().session.history().depth(), 1, "{name}");
        assert!(window.is_proved(), "{name}: {}", window.verdict());
        assert_eq!(window.editor().plane.pane.camera(), camera);
        window.press(Modifiers::COMMAND, Key::Z);
        assert!(window.embedding() == before, "{name} {}", window.editor().session.history().depth());
        assert!(!can_undo(&window), "{name}");
    }
}

#[test]
fn the_run_after_a_stroke_shows_in_the_frame_in_which_it_begins() {
    let mut window = window();
    window.click("Grab brush");
    let from = middle(&window);
    window.begin_drag(from, from + Vec2::new(30.0, 12.0), Modifiers::NONE);
    let mut has_run = false;
    window.harness.event(button(from + Vec2::new(30.0, 12.0), false, Modifiers::NONE));
    // The stroke begins the run once its last frame is there.
    for _ in 0..5000 {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.step();
        let is_running = window.editor().session.is_running();
        has_run |= is_running;
        assert_eq!(window.has_button("Pause"), is_running);
        if has_run && !is_running {
            return;
        }
    }
    panic!("no run begins, or it does not end: {has_run}");
}

#[test]
fn control_inverts_a_pinch() {
    let area_near_the_middle = |modifiers: Modifiers| {
        let mut window = window();
        window.click("Pinch brush");
        let at = middle(&window);
        let flat = window.embedding();
        let centre = flat.bounds().middle();
        let nearest = (0..flat.len()).min_by(|&a, &b| flat[a].distance(centre).total_cmp(&flat[b].distance(centre)));
        let vertex = nearest.expect("vertices");
        let mesh = Example::Dome.mesh();
        let neighbours: Vec<usize> = mesh
            .triangles
            .iter()
            .map(|corners| corners.map(VertexId::index))
            .filter(|corners| corners.contains(&vertex))
            .flatten()
            .collect();
        window.drag(at, at + Vec2::new(1.0, 0.0), modifiers);
        let after = window.embedding();
        neighbours.iter().map(|&other| after[other].distance(after[vertex])).sum::<f64>()
    };
    let [pinched, spread] = [Modifiers::NONE, Modifiers::COMMAND].map(area_near_the_middle);
    assert!(pinched < spread, "{pinched} {spread}");
}

#[test]
fn escape_during_a_stroke_restores_the_map_and_then_puts_the_brush_away() {
    let mut window = window();
    window.click("Grab brush");
    let before = window.embedding();
    let from = middle(&window);
    window.begin_drag(from, from + Vec2::new(40.0, 0.0), Modifiers::NONE);
    assert!(window.editor().session.is_brushing());
    window.harness.key_press(Key::Escape);
    window.step();
    assert!(!window.editor().session.is_brushing());
    window.end_drag(from);
    assert!(window.embedding() == before);
    assert!(!can_undo(&window));
    window.key(Key::Escape);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
}

#[test]
fn keys_resize_the_brush_and_a_click_beside_the_map_changes_nothing() {
    let mut window = window();
    let radius = |window: &Window| window.editor().tools.brush.radius;
    let before = radius(&window);
    window.key(Key::CloseBracket);
    assert!(radius(&window) > before);
    window.key(Key::OpenBracket);
    window.key(Key::OpenBracket);
    assert!(radius(&window) < before);
    let beside = window.plane_view().right_bottom() - Vec2::new(12.0, 12.0);
    let map = window.embedding();
    window.click_at(beside, Modifiers::NONE);
    assert!(window.embedding() == map);
    assert!(!can_undo(&window));
}

/// Window with several charts on the page and the brush tool.
fn page_window() -> Window {
    let mut window = with_sheets();
    window.key(Key::B);
    assert!(window.editor().shows_page(), "the brush works on the page");
    window
}

/// Presses a key that resizes the brush some times.
fn resize(window: &mut Window, key: Key, times: usize) {
    for _ in 0..times {
        window.key(key);
    }
}

/// Coordinates of a chart of the page.
fn on_page(window: &Window, chart: usize) -> Arc<Embedding> {
    Arc::clone(&window.editor().session.page().expect("a page").charts[chart].coordinates)
}

/// Corners of the triangles of a chart that the pane draws.
fn drawn(window: &Window) -> Arc<PlaneArrays> {
    Arc::clone(window.editor().plane.page.plane().expect("a page"))
}

#[test]
fn a_stroke_on_the_page_shapes_the_chart_under_it_and_leaves_all_others_where_they_lie() {
    let mut window = page_window();
    let depth = window.editor().session.history().depth();
    let shown = window.editor().session.chart_on_screen();
    let camera = window.editor().plane.page.pane.camera();
    for chart in 0..3 {
        window.click("Grab brush");
        let before: Vec<_> = (0..3).map(|chart| on_page(&window, chart)).collect();
        let from = page::middle(&window, chart);
        let first = drawn(&window);
        window.begin_drag(from, from + Vec2::new(9.0, 3.0), Modifiers::NONE);
        let stroke = window.editor().session.page_stroke().expect("a stroke");
        assert_eq!(stroke.chart(), chart);
        page::until(&mut window, |editor| editor.session.page_stroke().is_some_and(|s| s.coordinates().is_some()));
        window.step();
        assert!(!Arc::ptr_eq(&first, &drawn(&window)), "the page shows the stroke");
        assert_eq!(window.pill(), Pill::Proved);
        window.end_drag(from + Vec2::new(9.0, 3.0));
        page::until_proved(&mut window);
        let after: Vec<_> = (0..3).map(|chart| on_page(&window, chart)).collect();
        for other in 0..3 {
            assert_eq!(*before[other] == *after[other], other != chart, "chart {other} after a stroke on {chart}");
        }
        assert_eq!(window.pill(), Pill::Proved);
        assert!(window.editor().session.newest_atlas().expect("a layout").verdict.planar);
        assert_eq!(window.editor().session.history().depth(), depth + 1, "one edit");
        assert!(window.editor().shows_page());
        assert_eq!(window.editor().session.chart_on_screen(), shown);
        assert_eq!(window.editor().plane.page.pane.camera(), camera);
        window.press(Modifiers::COMMAND, Key::Z);
        page::until_proved(&mut window);
        assert_eq!(window.editor().session.history().depth(), depth);
        for (chart, before) in before.iter().enumerate() {
            assert_eq!(**before, *on_page(&window, chart), "undone");
        }
    }
}

#[test]
fn a_stroke_moves_only_the_vertices_under_the_brush_on_the_page() {
    let mut window = page_window();
    window.click("Grab brush");
    resize(&mut window, Key::OpenBracket, 8);
    let before = on_page(&window, 0);
    let from = page::middle(&window, 0);
    window.drag(from, from + Vec2::new(6.0, 2.0), Modifiers::NONE);
    page::until_proved(&mut window);
    let after = on_page(&window, 0);
    let moved = before.iter().zip(after.iter()).filter(|(a, b)| a != b).count();
    assert!(moved > 0 && moved < before.len(), "{moved} of {}", before.len());
}

#[test]
fn a_chart_that_a_brush_moves_stops_before_another_unless_alt_is_held() {
    for (modifiers, may_overlap) in [(Modifiers::NONE, false), (Modifiers::ALT, true)] {
        let mut window = page_window();
        window.click("Grab brush");
        let (from, to) = (page::middle(&window, 0), page::middle(&window, 1));
        let before = on_page(&window, 0);
        resize(&mut window, Key::CloseBracket, 16);
        window.begin_drag(from, from.lerp(to, 0.005), modifiers);
        page::until(&mut window, |editor| editor.session.page_stroke().is_some_and(|s| s.coordinates().is_some()));
        window.harness.hover_at(to);
        let is_there = |editor: &Editor| {
            let stroke = editor.session.page_stroke();
            let overlaps = |stroke: &PageStroke| stroke.verdict().is_some_and(|verdict| !verdict.is_planar());
            stroke.is_some_and(|stroke| if may_overlap { overlaps(stroke) } else { stroke.kept_back().is_some() })
        };
        page::until(&mut window, is_there);
        window.step();
        assert_eq!(window.pill(), if may_overlap { Pill::Bad } else { Pill::Proved });
        window.end_drag(to);
        page::until_proved(&mut window);
        let atlas = window.editor().session.newest_atlas().expect("a layout");
        assert_eq!(atlas.verdict.planar, !may_overlap);
        assert_ne!(before, on_page(&window, 0), "the chart stops on its way");
    }
}

#[test]
fn escape_drops_a_stroke_on_the_page_and_a_gesture_puts_the_brush_away() {
    let mut window = page_window();
    window.click("Grab brush");
    let before = on_page(&window, 0);
    let from = page::middle(&window, 0);
    window.begin_drag(from, from + Vec2::new(12.0, 0.0), Modifiers::NONE);
    page::until(&mut window, |editor| editor.session.page_stroke().is_some_and(|s| s.coordinates().is_some()));
    window.harness.key_press(Key::Escape);
    window.step();
    window.end_drag(from);
    page::until_proved(&mut window);
    assert_eq!(*before, *on_page(&window, 0));
    assert!(!window.editor().session.is_brushing());
    assert_eq!(window.editor().tools.tool(), Tool::Brush);
    window.press(Modifiers::COMMAND, Key::A);
    window.key(Key::G);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
}

#[test]
fn vertices_of_turned_mirrored_and_locked_charts_follow_the_pointer() {
    let by = Vec2::new(14.0, 6.0);
    for name in ["turned", "mirrored", "locked"] {
        let mut window = with_sheets();
        let at = page::middle(&window, 0);
        window.click_at(at, Modifiers::NONE);
        match name {
            "mirrored" => window.menu(&["Move", "Mirror left to right"]),
            "locked" => window.key(Key::L),
            _ => {
                for key in [Key::R, Key::Num3, Key::Num0, Key::Enter] {
                    window.key(key);
                }
            }
        }
        page::until_proved(&mut window);
        window.key(Key::B);
        window.click("Grab brush");
        let from = page::middle(&window, 0);
        let before = on_page(&window, 0);
        let depth = window.editor().session.history().depth();
        window.drag(from, from + by, Modifiers::NONE);
        page::until_proved(&mut window);
        assert_eq!(window.editor().session.history().depth(), depth + 1, "{name}");
        let after = on_page(&window, 0);
        let aspect = window.editor().session.page().expect("a page").aspect;
        let moved = |vertex: usize| (after[vertex] - before[vertex]) * glam::DVec2::new(aspect, 1.0);
        let most = (0..before.len()).map(moved).max_by(|a, b| a.length().total_cmp(&b.length())).expect("vertices");
        let scale = window.editor().plane.page.pane.camera().expect("shown").points_per_unit();
        let expected = glam::DVec2::new(by.x.into(), -f64::from(by.y)) / scale;
        assert!(most.distance(expected) < 0.25 * expected.length(), "{name}: {most} {expected}");
        assert_eq!(window.pill(), Pill::Proved, "{name}");
        let is_locked = window.editor().session.lock_state(0) == LockState::Locked;
        assert_eq!(is_locked, name == "locked", "{name}");
        let area = signed_area(&window, &after);
        assert_eq!(area < 0.0, name == "mirrored", "{name}: {area}");
    }
}

/// Signed area of chart 0 at these coordinates.
fn signed_area(window: &Window, at: &Embedding) -> f64 {
    let page = window.editor().session.page().expect("a page");
    let triangles = page.charts[0].mesh().mesh().real_triangles().iter();
    triangles.map(|&[a, b, c]| (at[b] - at[a]).perp_dot(at[c] - at[a]) / 2.0).sum()
}

#[test]
fn a_brushed_chart_with_a_hole_stays_where_it_lies_or_is_locked() {
    let mut holed = sheet(6, 0.1);
    let middle = VertexId::new(24);
    holed.triangles.retain(|corners| !corners.contains(&middle));
    let mesh = beside_each_other([holed, sheet(4, 0.1)]);
    for locks in [false, true] {
        let mut window = Window::with_mesh("holed.obj", &mesh);
        until_laid_out(&mut window);
        let chart = (0..2).find(|&chart| on_page(&window, chart).len() > 40).expect("the holed one");
        let at = page::middle(&window, chart) + Vec2::new(0.0, 40.0);
        window.click_at(at, Modifiers::NONE);
        if locks {
            window.key(Key::L);
        }
        page::until_proved(&mut window);
        window.key(Key::B);
        window.click("Grab brush");
        resize(&mut window, Key::OpenBracket, 6);
        let before = on_page(&window, chart);
        window.drag(at, at + Vec2::new(5.0, 2.0), Modifiers::NONE);
        page::until_proved(&mut window);
        let after = on_page(&window, chart);
        let stayed = before.iter().zip(after.iter()).filter(|(a, b)| a == b).count();
        assert!(stayed < before.len() && stayed > 0, "{stayed} of {} stayed", before.len());
        let is_locked = window.editor().session.lock_state(chart) == LockState::Locked;
        assert_eq!(is_locked, locks);
    }
}

#[test]
fn a_stroke_goes_on_where_a_neighbour_keeps_it_back() {
    let mut window = page_window();
    window.click("Texels brush");
    resize(&mut window, Key::OpenBracket, 4);
    let (inside, other) = (page::middle(&window, 0), page::middle(&window, 1));
    // The point of the outline that is nearest to another chart.
    let aspect = window.editor().session.page().expect("a page").aspect;
    let spots = on_page(&window, 0).iter().map(|uv| page::spot(&window, *uv * glam::DVec2::new(aspect, 1.0))).collect();
    let nearest = |spots: Vec<Pos2>| spots.into_iter().min_by(|a, b| a.distance(other).total_cmp(&b.distance(other)));
    let at = nearest(spots).expect("vertices");
    window.begin_drag(at, at + Vec2::new(0.5, 0.0), Modifiers::NONE);
    page::until(&mut window, |editor| editor.session.page_stroke().is_some_and(|stroke| stroke.kept_back().is_some()));
    let kept = |window: &Window| window.editor().session.page_stroke().and_then(|stroke| stroke.coordinates()).cloned();
    let before = kept(&window);
    // In the inside, the brush moves no part of the outline.
    let start = std::time::Instant::now();
    while kept(&window) == before && start.elapsed() < std::time::Duration::from_secs(20) {
        window.harness.hover_at(inside);
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.step();
    }
    assert_ne!(kept(&window), before, "frames are accepted again");
    window.end_drag(at);
    page::until_proved(&mut window);
    assert!(window.editor().session.newest_atlas().expect("a layout").verdict.planar);
}

#[test]
fn edits_in_the_middle_of_a_stroke_drop_it_or_wait() {
    let edits = [
        ("undo", Modifiers::COMMAND, Key::Z),
        ("redo", Modifiers::COMMAND | Modifiers::SHIFT, Key::Z),
        ("arrow", Modifiers::NONE, Key::ArrowRight),
    ];
    for (name, modifiers, key) in edits {
        let mut window = with_sheets();
        let at = page::middle(&window, 0);
        window.click_at(at, Modifiers::NONE);
        window.key(Key::B);
        window.click("Grab brush");
        // An edit that redo can return to.
        window.drag(at, at + Vec2::new(4.0, 0.0), Modifiers::NONE);
        page::until_proved(&mut window);
        window.press(Modifiers::COMMAND, Key::Z);
        page::until_proved(&mut window);
        let [before, other] = [0, 1].map(|chart| on_page(&window, chart));
        window.begin_drag(at, at + Vec2::new(9.0, 0.0), Modifiers::NONE);
        page::until(&mut window, |editor| editor.session.page_stroke().is_some_and(|s| s.coordinates().is_some()));
        window.harness.key_press_modifiers(modifiers, key);
        window.step();
        assert_eq!(window.editor().session.is_brushing(), name == "arrow", "{name}");
        window.end_drag(at + Vec2::new(9.0, 0.0));
        page::until_proved(&mut window);
        assert_eq!(on_page(&window, 1), other, "{name}");
        assert_eq!(on_page(&window, 0) == before, name == "undo", "{name}");
    }
}

#[test]
fn a_stroke_on_a_chart_alone_ends_when_another_chart_is_shown() {
    let mut window = with_sheets();
    window.press(Modifiers::NONE, Key::Y);
    window.key(Key::B);
    window.click("Grab brush");
    let before: Vec<_> = (0..3).map(|chart| on_page(&window, chart)).collect();
    let from = middle(&window);
    window.begin_drag(from, from + Vec2::new(10.0, 3.0), Modifiers::NONE);
    window.key(Key::PageDown);
    window.end_drag(from);
    window.settle();
    until_laid_out(&mut window);
    for (chart, before) in before.iter().enumerate() {
        assert_eq!(**before, *on_page(&window, chart), "chart {chart}");
    }
}

#[test]
fn undo_and_redo_of_a_stroke_restore_the_maps_of_a_chart_without_a_solve() {
    let mut window = with_sheets();
    let outcome = |window: &Window| Arc::clone(&window.editor().session.page().expect("a page").charts[1].outcome);
    // A map that solving from scratch would not give: it continues from the map before its pins.
    window.editor_mut().session.handle(Action::ShowChart(1));
    window.settle();
    window.editor_mut().session.handle(Action::Relax);
    window.settle();
    window.editor_mut().session.handle(Action::ShowChart(2));
    window.settle();
    page::until_proved(&mut window);
    window.key(Key::B);
    window.click("Grab brush");
    let before = outcome(&window);
    let at = page::middle(&window, 1);
    window.drag(at, at + Vec2::new(6.0, 2.0), Modifiers::NONE);
    page::until_proved(&mut window);
    let shaped = outcome(&window);
    assert!(!Arc::ptr_eq(&before, &shaped));
    for _ in 0..2 {
        window.press(Modifiers::COMMAND, Key::Z);
        page::until_proved(&mut window);
        assert!(Arc::ptr_eq(&before, &outcome(&window)), "undone");
        window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        page::until_proved(&mut window);
        assert!(Arc::ptr_eq(&shaped, &outcome(&window)), "done again");
    }
}
