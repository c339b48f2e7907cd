//! All charts on the page: selecting, moving, turning, scaling, aligning, stacking, locking and packing them.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use freebound::session::{ChartPage, LockState};
use freebound::ui::{Editor, GestureKind, PageRequest, Request, Snap};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_testkit::{Random, assert_message, shaped};
use glam::{DVec2, DVec3, Vec2Swizzles as _};

use crate::charts::{until_laid_out, with_sheets};
use crate::harness::{MESH_VIEW, PLANE_VIEW, Pill, Window};

fn page(window: &Window) -> &ChartPage {
    window.editor().session.page().expect("the page is shown")
}

fn selected(window: &Window) -> Vec<usize> {
    window.editor().plane.page.selected().iter().copied().collect()
}

/// Edits in the history of a mesh that was opened: its automatic seams.
const OPENED: usize = 1;

fn bounds(window: &Window, chart: usize) -> Bounds {
    page(window).bounds_of(chart)
}

/// Point of the window at a point of the page's plane.
pub(crate) fn spot(window: &Window, at: DVec2) -> Pos2 {
    let pane = window.editor().plane.page.pane;
    let [x, y] = pane.camera().expect("shown").pane_from_embedding(at, pane.size()).as_vec2().to_array();
    window.plane_view().min + egui::vec2(x, y)
}

pub(crate) fn middle(window: &Window, chart: usize) -> Pos2 {
    spot(window, bounds(window, chart).middle())
}

/// Waits until moves have ended and the layout is proved.
#[track_caller]
pub(crate) fn until_proved(window: &mut Window) {
    let start = Instant::now();
    let is_open = |editor: &Editor| {
        editor.session.is_moving_charts() || editor.session.page().is_none_or(|page| page.is_planar.is_none())
    };
    window.settle();
    until_laid_out(window);
    while is_open(window.editor()) {
        assert!(start.elapsed() < Duration::from_mins(1), "{:?}", window.words());
        std::thread::sleep(Duration::from_millis(1));
        window.step();
    }
    window.settle();
}

/// Waits for a state of the editor.
#[track_caller]
pub(crate) fn until(window: &mut Window, is_there: impl Fn(&Editor) -> bool) {
    let start = Instant::now();
    while !is_there(window.editor()) {
        assert!(start.elapsed() < Duration::from_mins(1), "{:?}", window.words());
        std::thread::sleep(Duration::from_millis(1));
        window.step();
    }
}

/// Drags from one point to another in some frames.
fn drag(window: &mut Window, from: Pos2, to: Pos2, modifiers: Modifiers) {
    window.begin_drag(from, from + (to - from) / 2.0, modifiers);
    window.harness.hover_at(to);
    window.step();
    window.end_drag(to);
    until_proved(window);
}

/// Pixels of the page's picture from one place of a chart to another.
fn pixels(window: &Window, from: DVec2, to: DVec2) -> DVec2 {
    let [width, height] = window.editor().session.packing().picture.map(f64::from);
    (to - from) * DVec2::new(width / page(window).aspect, height)
}

#[test]
fn a_mesh_of_several_charts_opens_with_all_of_them_on_the_page() {
    let window = with_sheets();
    assert!(window.editor().shows_page() && window.shows("Layout"));
    assert_eq!(page(&window).charts.len(), 3);
    assert_eq!(window.pill(), Pill::Proved);
    assert_message("page-window-verdict", &window.verdict());
}

#[test]
fn charts_are_selected_on_the_page_in_the_list_and_all_at_once() {
    let mut window = with_sheets();
    let at = middle(&window, 0);
    window.click_at(at, Modifiers::NONE);
    assert_eq!(selected(&window), [0]);
    let at = middle(&window, 2);
    window.click_at(at, Modifiers::SHIFT);
    assert_eq!(selected(&window), [0, 2]);
    window.click_at(at, Modifiers::SHIFT);
    assert_eq!(selected(&window), [0]);
    window.press(Modifiers::COMMAND, Key::I);
    assert_eq!(selected(&window), [1, 2]);
    window.press(Modifiers::COMMAND, Key::A);
    assert_eq!(selected(&window), [0, 1, 2]);
    window.key(Key::Escape);
    assert!(selected(&window).is_empty());
    let row = window.name_of(Role::Button, "Chart 1, ");
    window.click(&row);
    assert_eq!(selected(&window), [1]);
    window.key(Key::PageDown);
    assert_eq!(selected(&window), [2]);
    assert_eq!(window.editor().session.history().depth(), OPENED, "a selection is no edit");
}

#[test]
fn a_box_adds_the_charts_that_it_meets() {
    let mut window = with_sheets();
    let Bounds { low, high } = bounds(&window, 1);
    let out = 0.02 * DVec2::ONE;
    let (from, to) = (spot(&window, low - out), spot(&window, high + out));
    drag(&mut window, from, to, Modifiers::COMMAND);
    assert!(selected(&window).contains(&1));
    assert_eq!(window.editor().session.history().depth(), OPENED);
}

#[test]
fn a_lasso_adds_the_charts_that_it_meets() {
    let mut window = with_sheets();
    let corner = spot(&window, page(&window).charts[2].coordinates[0]);
    let around = [[-9.0, 0.0], [0.0, -9.0], [9.0, 0.0], [0.0, 9.0]].map(|[x, y]| corner + egui::vec2(x, y));
    window.begin_drag(around[0], around[1], Modifiers::COMMAND | Modifiers::ALT);
    for at in around {
        window.harness.hover_at(at);
        window.step();
    }
    window.end_drag(around[3]);
    window.settle();
    let met = (0..3).filter(|&chart| {
        let outline = window.editor().session.page().expect("a page").charts[chart].coordinates.clone();
        outline.iter().any(|uv| {
            let away = (spot(&window, *uv) - corner).abs();
            away.x + away.y < 9.0
        })
    });
    assert_eq!(selected(&window), met.collect::<Vec<_>>());
    assert!(!selected(&window).is_empty());
}

#[test]
fn tools_of_the_bar_move_and_scale_charts_from_where_the_pointer_comes_over_the_page() {
    let mut window = with_sheets();
    window.editor_mut().handle(PageRequest::Pick { chart: Some(0), adds: false }.into());
    window.settle();
    // From far, there is room beside the page.
    let (unit, phase) = (egui::MouseWheelUnit::Line, egui::TouchPhase::Move);
    let (delta, modifiers, source) = (egui::vec2(0.0, -12.0), Modifiers::NONE, egui::MouseWheelSource::Wheel);
    window.harness.hover_at(window.plane_view().center());
    window.step();
    window.harness.event(egui::Event::MouseWheel { unit, delta, phase, source, modifiers });
    window.settle();
    let before = bounds(&window, 0);
    let pivot = spot(&window, before.middle());
    let corner = |window: &Window| spot(window, page(window).charts[0].coordinates[0]);
    let click = |window: &mut Window, kind: GestureKind, from: Pos2, to: Pos2| {
        let tool = window.rect(Role::Button, kind.about()).center();
        window.click_at(tool, Modifiers::NONE);
        for at in [from, to] {
            window.harness.hover_at(at);
            window.step();
        }
        window.click_at(to, Modifiers::NONE);
        until_proved(window);
    };
    let (start, from) = (pivot + egui::vec2(0.0, 60.0), corner(&window));
    let way = spot(&window, before.middle() - DVec2::X) - pivot;
    assert!(window.plane_view().contains(start + way), "{start:?} {way:?}");
    click(&mut window, GestureKind::Move, start, start + way);
    let by = corner(&window) - from;
    assert!((by - way).length() < 2.0, "{by:?} {way:?}");
    // Half the distance from the centre is half the size.
    let pivot = pivot + way;
    let arm = corner(&window) - pivot;
    click(&mut window, GestureKind::Scale, pivot + egui::vec2(0.0, 60.0), pivot + egui::vec2(0.0, 30.0));
    let scaled = corner(&window) - pivot;
    assert!((scaled - 0.5 * arm).length() < 2.0, "{scaled:?} {arm:?}");
}

#[test]
fn a_stroke_adds_the_charts_that_it_crosses_far_from_their_outlines() {
    let mut window = with_sheets();
    let (from, to) = (middle(&window, 0), middle(&window, 2));
    drag(&mut window, from, to, Modifiers::COMMAND | Modifiers::SHIFT);
    assert!(selected(&window).contains(&0) && selected(&window).contains(&2), "{:?}", selected(&window));
    assert_eq!(window.editor().session.history().depth(), OPENED);
}

#[test]
fn a_dragged_chart_follows_the_pointer_in_one_edit_and_all_frames_are_proved() {
    let mut window = with_sheets();
    let before: Vec<Bounds> = (0..3).map(|chart| bounds(&window, chart)).collect();
    let from = middle(&window, 0);
    let to = spot(&window, before[0].middle() + DVec2::new(-1.0, 0.0));
    window.begin_drag(from, from + egui::vec2(-8.0, 0.0), Modifiers::NONE);
    for step in 1..12_u8 {
        window.harness.hover_at(from + (to - from) * f32::from(step) / 11.0);
        window.step();
        assert_eq!(window.pill(), Pill::Proved);
    }
    window.end_drag(to);
    until_proved(&mut window);
    assert_eq!(selected(&window), [0]);
    let by = bounds(&window, 0).low - before[0].low;
    assert!((by - DVec2::new(-1.0, 0.0)).length() < 0.02, "{by}");
    assert_eq!([bounds(&window, 1), bounds(&window, 2)], [before[1], before[2]]);
    window.press(Modifiers::COMMAND, Key::Z);
    until_proved(&mut window);
    assert_eq!(bounds(&window, 0), before[0]);
}

#[test]
fn a_chart_that_is_dragged_over_another_stays_apart_unless_alt_is_held() {
    let mut window = with_sheets();
    let (from, to) = (middle(&window, 0), middle(&window, 2));
    let before = bounds(&window, 0);
    drag(&mut window, from, to, Modifiers::NONE);
    assert_eq!((window.pill(), page(&window).is_planar), (Pill::Proved, Some(true)));
    let from = middle(&window, 0);
    drag(&mut window, from, to, Modifiers::ALT);
    assert_eq!((window.pill(), page(&window).is_planar), (Pill::Bad, Some(false)));
    assert_ne!(bounds(&window, 0), before);
    // The verdict selects the charts that overlap.
    window.key(Key::Escape);
    window.click(&format!("Verdict: {}", window.verdict()));
    assert_eq!(selected(&window), [0, 2]);
    window.click("Pack all");
    until_proved(&mut window);
    assert_eq!(page(&window).is_planar, Some(true));
}

#[test]
fn letters_start_gestures_that_take_typed_numbers_and_axes() {
    let mut window = with_sheets();
    let at = middle(&window, 1);
    window.click_at(at, Modifiers::NONE);
    let before = bounds(&window, 1);
    for key in [Key::G, Key::Y, Key::Num4, Key::Num0, Key::Num9, Key::Num6, Key::Enter] {
        window.key_now(key);
    }
    until_proved(&mut window);
    let by = pixels(&window, before.low, bounds(&window, 1).low);
    assert!((by - DVec2::new(0.0, 4096.0)).length() < 1e-6, "{by}");
    let before = bounds(&window, 1);
    for key in [Key::S, Key::Num0, Key::Period, Key::Num5, Key::Enter] {
        window.key_now(key);
    }
    until_proved(&mut window);
    let after = bounds(&window, 1);
    assert!((after.size() - 0.5 * before.size()).length() < 1e-9);
    assert!((after.middle() - before.middle()).length() < 1e-9);
    for key in [Key::R, Key::Num9, Key::Num0, Key::Enter] {
        window.key_now(key);
    }
    until_proved(&mut window);
    assert!((bounds(&window, 1).size() - after.size().yx()).length() < 1e-9);
    assert_eq!(window.editor().session.history().depth(), OPENED + 3);
    for key in [Key::G, Key::Num5, Key::Escape] {
        window.key_now(key);
    }
    until_proved(&mut window);
    assert_eq!((window.editor().session.history().depth(), selected(&window)), (OPENED + 3, vec![1]));
}

#[test]
fn arrows_move_the_selected_charts_by_pixels() {
    let mut window = with_sheets();
    window.press(Modifiers::COMMAND, Key::A);
    let before = bounds(&window, 0).low;
    window.key(Key::ArrowRight);
    until_proved(&mut window);
    window.press(Modifiers::SHIFT, Key::ArrowUp);
    until_proved(&mut window);
    let by = pixels(&window, before, bounds(&window, 0).low);
    assert!((by - DVec2::new(1.0, 10.0)).length() < 1e-6, "{by}");
}

#[test]
fn a_double_click_shows_a_chart_alone_and_escape_returns_to_the_page() {
    let mut window = with_sheets();
    let at = middle(&window, 1);
    window.double_click_at(at);
    assert!(!window.editor().shows_page());
    assert_eq!(window.editor().session.chart_on_screen(), Some(1));
    window.key(Key::Escape);
    assert!(window.editor().shows_page());
    window.key(Key::P);
    assert!(!window.editor().shows_page(), "pins belong to a chart alone");
    window.key(Key::V);
    assert!(window.editor().shows_page());
    window.click("Chart 1");
    assert!(!window.editor().shows_page());
    window.click("All charts");
    assert!(window.editor().shows_page());
}

#[test]
fn f_frames_the_selected_charts_in_both_panes() {
    let mut window = with_sheets();
    let cameras = |window: &Window| (window.editor().plane.page.pane.camera(), window.editor().mesh.pane.camera());
    let before = cameras(&window);
    let at = middle(&window, 0);
    window.click_at(at, Modifiers::NONE);
    window.key(Key::F);
    let near = cameras(&window);
    assert!(near.0 != before.0 && near.1 != before.1);
    window.key(Key::Escape);
    window.key(Key::F);
    assert_eq!(cameras(&window).0, before.0);
}

#[test]
fn menus_align_distribute_and_mirror_the_selected_charts() {
    let mut window = with_sheets();
    // Far apart, so that nothing keeps them back.
    for (chart, by) in [(0, DVec2::new(-5.0, 0.0)), (1, DVec2::new(4.0, 6.0)), (2, DVec2::new(11.0, -7.0))] {
        let moves = vec![(chart, glam::DAffine2::from_translation(by))];
        window.editor_mut().session.handle(freebound::session::Action::MoveCharts { moves, insists: false });
        window.editor_mut().session.handle(freebound::session::Action::EndMove);
        until_proved(&mut window);
    }
    window.press(Modifiers::COMMAND, Key::A);
    window.menu(&["Align", "Distribute across"]);
    until_proved(&mut window);
    let across = |window: &Window| [0, 1, 2].map(|chart| bounds(window, chart));
    let [a, b, c] = across(&window);
    assert!(((b.low.x - a.high.x) - (c.low.x - b.high.x)).abs() < 1e-9);
    window.menu(&["Align", "Top"]);
    until_proved(&mut window);
    let [a, b, c] = across(&window).map(|bounds| bounds.high.y);
    assert!((a - b).abs() < 1e-9 && (b - c).abs() < 1e-9);
    let before = across(&window);
    window.menu(&["Move", "Mirror left to right"]);
    until_proved(&mut window);
    assert_eq!(page(&window).is_planar, Some(true));
    for (before, after) in before.into_iter().zip(across(&window)) {
        assert!((before.middle() - after.middle()).length() < 1e-9);
    }
}

#[test]
fn charts_snap_to_pixels_if_the_user_wants_it() {
    let mut window = with_sheets();
    window.choose("Snapping of moved charts", "Snap to pixels");
    assert_eq!(window.editor().plane.page.snap(), Snap::Pixels);
    let from = middle(&window, 0);
    let to = spot(&window, bounds(&window, 0).middle() + DVec2::new(-0.7, 0.123));
    drag(&mut window, from, to, Modifiers::NONE);
    let low = pixels(&window, DVec2::ZERO, bounds(&window, 0).low);
    assert!((low - low.round()).length() < 1e-6, "{low}");
}

/// Two sheets that are mirror images of each other, and three others.
fn with_parts() -> Window {
    let chiral = shaped(4, 3, |x, y| DVec3::new(x + 0.1 * y * y, y, 0.05 * x * x * y));
    let mut mirrored = chiral.clone();
    mirrored.positions.iter_mut().for_each(|position| position.x = 20.0 - position.x);
    mirrored.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let others = [3, 4, 5].map(|rows| shaped(rows, rows, |x, y| DVec3::new(x, y, 0.1 * x * y)));
    let mut whole = TriMesh::default();
    for part in [chiral, mirrored].into_iter().chain(others) {
        let offset = whole.positions.len();
        whole.positions.extend(part.positions.iter().map(|&at| at + 7.0 * offset as f64 * DVec3::Y));
        let moved = |vertex: VertexId| VertexId::from_index(offset + vertex.index());
        whole.triangles.extend(part.triangles.iter().map(|corners| corners.map(moved)));
    }
    let mut window = Window::with_mesh("parts.obj", &whole);
    until_proved(&mut window);
    window
}

/// The artist's run of at most 15 actions: two mirrored charts are stacked, three are moved, one is locked, the rest is
/// packed, at a density of 512 pixels per unit everywhere.
#[test]
fn an_artist_stacks_moves_locks_and_packs_at_one_density_in_at_most_15_actions() {
    let mut window = with_parts();
    let mut actions = 0;
    let mut act = |window: &mut Window, action: &dyn Fn(&mut Window)| {
        action(window);
        until_proved(window);
        actions += 1;
    };
    // One density everywhere.
    act(&mut window, &|window| window.press(Modifiers::COMMAND, Key::A));
    let density = "Density of the selected charts, pixels per unit of length";
    act(&mut window, &|window| {
        window.fill_in(Role::SpinButton, density, "12");
        window.key(Key::Enter);
    });
    // The two mirrored charts share a place.
    act(&mut window, &|window| window.click_at(middle(window, 0), Modifiers::NONE));
    act(&mut window, &|window| window.click_at(middle(window, 1), Modifiers::SHIFT));
    act(&mut window, &|window| window.menu(&["Stack", "Stack on the first"]));
    // Three charts are moved.
    for (chart, x) in [(2, 1.5), (3, 2.5), (4, 3.5)] {
        act(&mut window, &|window| {
            let from = middle(window, chart);
            let to = spot(window, DVec2::new(x, 1.5));
            drag(window, from, to, Modifiers::NONE);
        });
    }
    // One is locked, the rest is packed.
    act(&mut window, &|window| window.key(Key::L));
    act(&mut window, &|window| window.click("Pack all"));
    assert!(actions <= 15, "{actions}");
    let session = &window.editor().session;
    assert_eq!(session.lock_state(4), LockState::Locked);
    let atlas = session.atlas().expect("laid out");
    assert!(atlas.verdict.planar && atlas.verdict.stacks == 1, "{}", atlas.verdict.summary());
    let densities = &atlas.densities;
    assert!(densities.iter().all(|density| (density / densities[0] - 1.0).abs() < 1e-6), "{densities:?}");
    let stack = page(&window).with_stacks(&BTreeSet::from([0]));
    assert_eq!(stack, BTreeSet::from([0, 1]));
}

#[test]
fn requests_to_the_page_do_nothing_without_a_page() {
    let mut window = Window::with_mesh("one.obj", &crate::harness::sheet(5, 0.3));
    let before = window.editor().session.document().clone();
    for request in [PageRequest::Pack, PageRequest::Stack, PageRequest::Open(None)] {
        window.editor_mut().handle(request.into());
        window.settle();
    }
    assert_eq!(*window.editor().session.document(), before);
    assert!(!window.editor().shows_page() && window.is_proved());
}

/// Number of actions of a walk in a regular test run.
const WALK: u64 = 200;

/// Keys of a walk, by their modifiers.
const WALK_KEYS: [(Modifiers, &[Key]); 9] = [
    (Modifiers::NONE, &[Key::G, Key::R, Key::S, Key::X, Key::Y, Key::Enter, Key::Escape, Key::L, Key::F]),
    (Modifiers::NONE, &[Key::Num1, Key::Num9, Key::Minus, Key::Period, Key::Backspace, Key::V, Key::P, Key::Tab]),
    (Modifiers::NONE, &[Key::ArrowLeft, Key::ArrowUp, Key::PageDown, Key::G, Key::G, Key::Enter]),
    (Modifiers::COMMAND, &[Key::A, Key::I, Key::Z, Key::Z]),
    (Modifiers::COMMAND.plus(Modifiers::SHIFT), &[Key::Z]),
    (Modifiers::SHIFT, &[Key::P, Key::C]),
    (Modifiers::NONE, &[Key::B, Key::B, Key::OpenBracket, Key::CloseBracket]),
    (Modifiers::COMMAND, &[Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::L, Key::OpenBracket, Key::CloseBracket]),
    (Modifiers::ALT, &[Key::L, Key::R, Key::Z]),
];

/// Brushes of a walk, by their buttons.
const BRUSHES: [&str; 5] = ["Relax brush", "Grab brush", "Pinch brush", "Smooth brush", "Texels brush"];

/// Random walk over the page.
struct Walk {
    window: Window,
    random: Random,
    /// Latest actions, for the failure message.
    done: Vec<String>,
    overlaps: usize,
}

impl Walk {
    fn one_of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.random.index(list.len())]
    }

    fn view(&self, name: &str) -> Option<egui::Rect> {
        self.window.harness.query_by_role_and_label(Role::Image, name).map(|node| node.rect())
    }

    fn place_in(&mut self, rect: egui::Rect) -> Pos2 {
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
        let [x, y] = [self.random.unit(), self.random.unit()].map(|share| share as f32);
        rect.min + egui::vec2(x, y) * rect.size()
    }

    fn say(&mut self, words: String) {
        self.done.push(words);
        self.done.drain(..self.done.len().saturating_sub(12));
    }

    fn act(&mut self) {
        let names = if self.random.below(4) == 0 { [MESH_VIEW, PLANE_VIEW] } else { [PLANE_VIEW, MESH_VIEW] };
        // A pane in full size and the comparison hide a pane.
        let Some(rect) = names.into_iter().find_map(|name| self.view(name)) else {
            return self.window.key(Key::Escape);
        };
        let (from, to) = (self.place_in(rect), self.place_in(rect));
        match self.random.below(6) {
            5 if self.window.has_button(BRUSHES[0]) => {
                let brush = self.one_of(&BRUSHES);
                self.say(brush.to_owned());
                self.window.click(brush);
            }
            4 if self.random.below(2) == 0 => {
                self.say("Fix the selection".to_owned());
                self.window.editor_mut().handle(Request::FixSelection);
                self.window.step();
            }
            0 | 1 => {
                let (modifiers, keys) = self.one_of(&WALK_KEYS);
                let key = self.one_of(keys);
                self.say(format!("{key:?} with {modifiers:?}"));
                self.window.harness.key_press_modifiers(modifiers, key);
                self.window.step();
            }
            2 => {
                let modifiers = self.one_of(&[Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT]);
                self.say(format!("click at {from} with {modifiers:?}"));
                self.window.click_at(from, modifiers);
            }
            3 => self.drag(from, to),
            _ => {
                self.window.harness.hover_at(to);
                self.window.step();
            }
        }
    }

    /// Drags a chart if there is one on the screen, and sometimes gives up.
    fn drag(&mut self, from: Pos2, to: Pos2) {
        let shows_page = self.window.editor().shows_page() && self.view(PLANE_VIEW).is_some();
        let count = self.window.editor().session.page().filter(|_| shows_page).map_or(0, |page| page.charts.len());
        let from = if count > 0 { middle(&self.window, self.random.index(count)) } else { from };
        let stroke = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        let modifiers = self.one_of(&[Modifiers::NONE, Modifiers::NONE, Modifiers::ALT, Modifiers::COMMAND, stroke]);
        self.say(format!("drag from {from} to {to} with {modifiers:?}"));
        self.window.begin_drag(from, from + (to - from) / 2.0, modifiers);
        self.window.harness.hover_at(to);
        self.window.step();
        if self.random.below(4) == 0 {
            self.window.harness.key_press(Key::Escape);
            self.window.step();
        }
        self.window.end_drag(to);
    }

    /// Ends gestures, waits, and compares the words, the page and the layout in the written form.
    fn rest(&mut self) {
        self.window.harness.key_press(Key::Escape);
        until_proved(&mut self.window);
        let editor = self.window.editor();
        let layout = editor.session.atlas().expect("laid out");
        let charts = &page(&self.window).charts;
        assert_eq!(page(&self.window).is_planar, Some(layout.verdict.planar), "{:?}", self.done);
        let is_written = charts.iter().zip(&layout.coordinates).all(|(chart, at)| chart.coordinates == *at);
        assert!(is_written, "{:?}", self.done);
        if editor.shows_page() && editor.session.busy().is_none() {
            let expected = if layout.verdict.planar { Pill::Proved } else { Pill::Bad };
            assert_eq!(self.window.pill(), expected, "{}: {:?}", self.window.verdict(), self.done);
        }
        self.overlaps += usize::from(!layout.verdict.planar);
    }
}

/// Keys, clicks and drags at random. `FREEBOUND_WALK_SEED` sets the seed, and `FREEBOUND_WALK` the number of actions.
#[test]
fn the_page_agrees_with_the_layout_whatever_is_pressed() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (seed, actions) = (number("FREEBOUND_WALK_SEED").unwrap_or(3), number("FREEBOUND_WALK").unwrap_or(WALK));
    let mut walk = Walk { window: with_parts(), random: Random(seed), done: Vec::new(), overlaps: 0 };
    for action in 1..=actions {
        walk.act();
        let count = walk.window.editor().session.charts().map_or(0, |charts| charts.count());
        assert!(selected(&walk.window).iter().all(|&chart| chart < count), "{:?}", walk.done);
        let elements = walk.window.editor().plane.page.elements();
        assert!(elements.is_empty() || selected(&walk.window).is_empty(), "{:?}", walk.done);
        if action % 5 == 0 {
            walk.rest();
        }
    }
    let slowest = walk.window.slowest;
    println!("{actions} actions, {} rests with overlaps, slowest frame {slowest:?}", walk.overlaps);
}

/// Sheets beside each other, as parts of one mesh.
fn many_sheets(count: usize) -> TriMesh {
    let mut whole = TriMesh::default();
    for part in 0..count {
        let sheet = shaped(3, 3, |x, y| DVec3::new(x, y, 0.1 * x * y));
        let (first, by) = (whole.positions.len(), DVec3::new(4.0 * (part % 25) as f64, 4.0 * (part / 25) as f64, 0.0));
        whole.positions.extend(sheet.positions.iter().map(|&at| at + by));
        let moved = |vertex: VertexId| VertexId::from_index(first + vertex.index());
        whole.triangles.extend(sheet.triangles.iter().map(|corners| corners.map(moved)));
    }
    whole
}

#[test]
fn five_hundred_parts_are_selected_framed_moved_pinned_and_packed() {
    const PARTS: usize = 500;
    let mut window = Window::with_mesh("parts.obj", &many_sheets(PARTS));
    until_proved(&mut window);
    let mut slowest = Vec::new();
    let mut act = |window: &mut Window, name: &str, act: &dyn Fn(&mut Window)| {
        window.slowest = Duration::ZERO;
        act(window);
        until_proved(window);
        slowest.push(format!("{name}: {:?}", window.slowest));
    };
    act(&mut window, "select all", &|window| window.press(Modifiers::COMMAND, Key::A));
    assert_eq!(selected(&window).len(), PARTS);
    act(&mut window, "frame", &|window| window.key(Key::F));
    act(&mut window, "select one", &|window| window.click_at(middle(window, 77), Modifiers::NONE));
    assert_eq!(selected(&window), [77]);
    let before = bounds(&window, 77);
    act(&mut window, "move by a pixel", &|window| window.key(Key::ArrowLeft));
    assert_ne!(bounds(&window, 77).low, before.low);
    act(&mut window, "select faces", &|window| {
        window.press(Modifiers::COMMAND, Key::Num3);
        window.press(Modifiers::COMMAND, Key::A);
    });
    assert_eq!(window.editor().plane.page.elements().faces().len(), 18 * PARTS);
    act(&mut window, "pin", &|window| window.editor_mut().handle(Request::FixSelection));
    let pins = |window: &Window| window.editor().pins_on_page().len();
    assert_eq!(pins(&window), 16 * PARTS);
    act(&mut window, "free", &|window| window.key(Key::Delete));
    assert_eq!(pins(&window), 0);
    act(&mut window, "pack", &|window| window.editor_mut().handle(PageRequest::PackAll.into()));
    assert!(!window.editor().session.has_placed_charts() && window.is_proved());
    println!("slowest frames: {}", slowest.join(", "));
}

#[test]
fn a_moved_chart_is_unsaved_work_until_the_move_is_undone() {
    let mut window = with_sheets();
    until_proved(&mut window);
    assert!(!window.editor().session.has_unsaved_work(), "looking changes nothing");
    let at = middle(&window, 0);
    window.click_at(at, Modifiers::NONE);
    assert!(!window.editor().session.has_unsaved_work());
    drag(&mut window, at, at + egui::vec2(30.0, 10.0), Modifiers::ALT);
    assert!(window.editor().session.has_unsaved_work(), "a moved chart is a change");
    window.press(Modifiers::COMMAND, Key::Z);
    until_proved(&mut window);
    assert!(!window.editor().session.has_unsaved_work());
}
