//! Random walk through the window: keys, clicks, drags and turns of the wheel, several per frame, in frames of one
//! to five hundred milliseconds. After every frame the window's texts are compared with its drawing. After every
//! frame without presses they are also compared with the session. `FREEBOUND_WALK_SEED` sets the seed, and
//! `FREEBOUND_WALK` the number of actions.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use egui::accesskit::{Role, Toggled};
use egui::{Event, Key, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::kittest::{AccessKitNode, NodeT, Queryable};
use freebound::session::{Action, Status};
use freebound::ui::{BINDINGS, Pane, Tab};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Embedding, Settings};
use freebound_core::verify::{Verdict, verdict};

use crate::harness::{Pill, Window, sheet};
use crate::presses::{button, click, key};
use freebound_testkit::Random;

/// Number of actions in a regular test run.
const ACTIONS: u32 = 300;

/// Greatest number of walks until the pill has said everything.
const MOST_WALKS: u64 = 6;

/// True for the keys of the command palette, which runs any command, and of cuts, which make charts: these have a walk of
/// their own.
fn leaves_the_sheet(shortcut: egui::KeyboardShortcut) -> bool {
    let egui::KeyboardShortcut { logical_key, modifiers } = shortcut;
    logical_key == Key::P && modifiers.command || logical_key == Key::X && modifiers.shift
}

/// Lengths of frames, seconds.
const FRAMES: [f64; 8] = [0.001, 0.005, 0.016, 0.016, 0.016, 0.05, 0.2, 0.5];

/// Keys that open files or leave the window.
const LEFT_OUT: [Key; 5] = [Key::O, Key::S, Key::E, Key::Q, Key::F10];

/// Buttons that open files, leave the window, or open another mesh.
const NOT_CLICKED: [&str; 12] = [
    "File",
    "Help",
    "Import",
    "Export",
    "Copy",
    "Solve ",
    "Open",
    "Recent",
    "Examples",
    "Save",
    "Quit",
    "Show in folder",
];

struct Walk {
    window: Window,
    random: Random,
    /// Pending end of a drag.
    held: Option<Event>,
    /// Latest actions, for the failure message.
    done: Vec<String>,
    /// Topics of the pill's texts so far.
    said: BTreeSet<Said>,
}

/// Topic of a text of the pill.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Said {
    Planar,
    Defects,
    Movement,
    Preview,
}

impl Said {
    fn of(window: &Window) -> Option<Self> {
        pill(window)?;
        let editor = window.editor();
        let is_preview = matches!(editor.session.status(), Status::Preview(_));
        match window.pill() {
            Pill::Proved | Pill::Unmet => Some(Self::Planar),
            Pill::Bad => Some(Self::Defects),
            Pill::AtWork => editor.plane.is_moving(&editor.session).then_some(Self::Movement),
            Pill::Stale => is_preview.then_some(Self::Preview),
        }
    }
}

impl Walk {
    fn new(seed: u64) -> Self {
        let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
        // Starts with folds to jump to.
        crate::defects::fold(&mut window);
        Self { window, random: Random(seed), held: None, done: Vec::new(), said: BTreeSet::new() }
    }

    fn one_of<T: Clone>(&mut self, list: &[T]) -> T {
        list[self.random.index(list.len())].clone()
    }

    fn place_in(&mut self, rect: Rect) -> Pos2 {
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
        let [x, y] = [self.random.unit(), self.random.unit()].map(|share| share as f32);
        rect.min + Vec2::new(x, y) * rect.size()
    }

    fn say(&mut self, words: String) {
        self.done.push(words);
        if self.done.len() > 30 {
            self.done.remove(0);
        }
    }

    /// Key of a binding, sometimes with another modifier or repeated.
    fn keys(&mut self) -> Vec<Event> {
        let bound: Vec<_> = BINDINGS
            .iter()
            .map(|b| b.shortcut)
            .filter(|s| !LEFT_OUT.contains(&s.logical_key) && !leaves_the_sheet(*s))
            .collect();
        let shortcut = self.one_of(&bound);
        let other = self.one_of(&[Modifiers::NONE, Modifiers::NONE, Modifiers::NONE, Modifiers::ALT, Modifiers::SHIFT]);
        let changed = egui::KeyboardShortcut::new(shortcut.modifiers | other, shortcut.logical_key);
        let other = if leaves_the_sheet(changed) { Modifiers::NONE } else { other };
        let times = self.one_of(&[1, 1, 1, 2, 4]);
        self.say(format!("{times} × {:?} with {:?}", shortcut.logical_key, shortcut.modifiers | other));
        let presses = key(shortcut.logical_key, shortcut.modifiers | other);
        presses.iter().cycle().take(2 * times).cloned().collect()
    }

    /// Click on a visible control, or somewhere in a pane.
    fn click(&mut self) -> Vec<Event> {
        let modifiers = self.one_of(&[Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND]);
        let roles = [Role::Button, Role::CheckBox, Role::ComboBox, Role::Link];
        let controls: Vec<(String, Rect)> = (self.window.controls().into_iter())
            .filter(|(role, name, _)| roles.contains(role) && !NOT_CLICKED.iter().any(|not| name.starts_with(not)))
            .map(|(_, name, rect)| (name, rect))
            .collect();
        let in_control = self.random.below(2) == 0 && !controls.is_empty();
        let (name, rect) = if in_control { self.one_of(&controls) } else { self.pane() };
        let at = if in_control { rect.center() } else { self.place_in(rect) };
        self.say(format!("click on {name} at {at} with {modifiers:?}"));
        click(at, modifiers)
    }

    fn pane(&mut self) -> (String, Rect) {
        let view = |pane: &str| {
            let node = self.window.harness.query_by_role_and_label(Role::Image, pane)?;
            Some((pane.to_owned(), node.rect()))
        };
        let panes: Vec<_> =
            [crate::harness::MESH_VIEW, crate::harness::PLANE_VIEW].into_iter().filter_map(view).collect();
        // A comparison may replace both panes.
        let whole = ("the window".to_owned(), self.window.harness.ctx.content_rect());
        if panes.is_empty() { whole } else { self.one_of(&panes) }
    }

    /// Drag in a pane, usually of a pin.
    fn drag(&mut self) -> Vec<Event> {
        let pins: Vec<Pos2> = (self.window.harness.query_all_by_role(Role::Button))
            .filter(|node| node.accesskit_node().label().is_some_and(|name| name.to_lowercase().contains("pin v")))
            .map(|node| node.rect().center())
            .collect();
        let (_, pane) = self.pane();
        let from = if pins.is_empty() || self.random.below(4) == 0 { self.place_in(pane) } else { self.one_of(&pins) };
        let to = self.place_in(pane.shrink(20.0));
        let modifiers = self.one_of(&[Modifiers::NONE, Modifiers::NONE, Modifiers::COMMAND]);
        self.say(format!("drag from {from} to {to} with {modifiers:?}"));
        let middle = from + (to - from) / 2.0;
        let moves = [middle, to].map(Event::PointerMoved);
        self.held = Some(button(to, false, modifiers));
        [vec![Event::PointerMoved(from), button(from, true, modifiers)], moves.to_vec()].concat()
    }

    fn wheel(&mut self) -> Vec<Event> {
        let (_, pane) = self.pane();
        let at = self.place_in(pane);
        let delta = Vec2::new(0.0, self.one_of(&[-2.0, -1.0, 1.0, 2.0]));
        self.say(format!("wheel by {} at {at}", delta.y));
        let (unit, phase) = (egui::MouseWheelUnit::Line, egui::TouchPhase::Move);
        let source = egui::MouseWheelSource::Wheel;
        let turn = Event::MouseWheel { unit, delta, phase, source, modifiers: Modifiers::NONE };
        vec![Event::PointerMoved(at), turn]
    }

    fn action(&mut self) -> Vec<Event> {
        // Keys and the wheel may occur during a drag, other presses not.
        let end = self.held.take_if(|_| self.random.below(3) > 0).into_iter();
        let more = match self.random.below(10) {
            7.. if self.held.is_none() => self.drag(),
            4..7 if self.held.is_none() => self.click(),
            0..7 => self.keys(),
            _ => self.wheel(),
        };
        end.chain(more).collect()
    }

    /// Runs a frame with the events, and checks it.
    fn show(&mut self, events: Vec<Event>) {
        let is_quiet = events.is_empty() && !self.window.editor().gpu.has_presses_waiting();
        let seconds = self.one_of(&FRAMES);
        self.window.frame_after(seconds, events);
        let found = disagreements(&self.window, is_quiet);
        assert!(found.is_empty(), "{found:#?}\nafter {:#?}", self.done);
        self.said.extend(Said::of(&self.window));
    }

    /// Performs some actions at once, split into frames at random.
    fn go_on(&mut self) {
        let count = self.one_of(&[1, 1, 2, 3]);
        let mut events: Vec<Event> = (0..count).flat_map(|_| self.action()).collect();
        while !events.is_empty() {
            let cut = 1 + self.random.index(events.len());
            let first: Vec<Event> = events.drain(..cut).collect();
            self.show(first);
        }
        for _ in 0..self.random.below(4) {
            std::thread::sleep(Duration::from_millis(self.random.below(4).into()));
            self.show(Vec::new());
        }
    }
}

/// Compares the window's texts with its drawing, and with the session if nothing has changed since.
fn disagreements(window: &Window, is_quiet: bool) -> Vec<String> {
    let mut found = Vec::new();
    let mut check = |agrees: bool, words: &dyn Fn() -> String| {
        if !agrees {
            found.push(words());
        }
    };
    let editor = window.editor();
    let plane = &editor.plane;
    let pill = pill(window);
    let drawn = plane.scene().map(|scene| &scene.outcome);
    let kind = pill.as_ref().map(|_| window.pill());
    if kind == Some(Pill::Proved) && editor.shows_preview() {
        // The drawn embedding under a dragged pin: its whole verdict equals the pill's.
        let disk = editor.session.model().and_then(|model| model.disk().cloned());
        let sheet = plane.drawn().filter(|_| !plane.is_easing());
        let is_so = disk.zip(sheet).is_some_and(|(disk, sheet)| {
            let embedding: Embedding = sheet.positions()[..disk.vertex_count()].iter().copied().collect();
            verdict(&disk, &embedding).planar
        });
        check(is_so, &|| format!("{pill:?} over a sheet under a pin that is not"));
    } else if let Some(pill) = pill.as_deref() {
        let at_rest = drawn.filter(|_| !plane.is_easing() && !editor.shows_preview());
        let verdict = at_rest.map(|outcome| &outcome.step.verdict);
        let is_proved = matches!(kind, Some(Pill::Proved | Pill::Unmet));
        check(!is_proved || verdict.is_some_and(|v| v.planar), &|| format!("{pill:?} over a sheet that is not planar"));
        let counts = kind == Some(Pill::Bad);
        let agrees = |v: &Verdict| window.numbers_of_verdict() == counts_of(v);
        check(!counts || verdict.is_some_and(agrees), &|| format!("{pill:?} over {verdict:?}"));
        let sheet = plane.drawn().filter(|sheet| !sheet.is_stage());
        let is_drawn = |outcome: &Arc<Outcome>| {
            let embedding = &outcome.step.candidate.solution.embedding;
            sheet.is_none_or(|sheet| sheet.positions()[..embedding.len()] == embedding[..])
        };
        let is_verdict = is_proved || counts;
        check(!is_verdict || at_rest.is_some_and(is_drawn), &|| format!("{pill:?} over a sheet on its way"));
    }
    if let (Some(outcome), Some(paint)) = (drawn, editor.pane_shading.paint(Pane::Plane)) {
        let flipped = &outcome.step.verdict.flipped_faces;
        check(paint.faces.flipped == *flipped, &|| format!("{:?} red, {flipped:?} flipped", paint.faces.flipped));
    }
    if let Some(place) = editor.selection.defect() {
        let count = editor.defect_count();
        check(place < count, &|| format!("defect {place} of {count}"));
    }
    let is_open = editor.layout.tab() == Tab::Defects && editor.layout.panels_shown();
    if let Some(outcome) = drawn.filter(|_| is_open && is_quiet) {
        let is_proof = |words: &String| words.starts_with("Planar") && words.ends_with("one-to-one");
        let says = window.words().iter().any(is_proof);
        check(says == outcome.step.verdict.planar, &|| "the Defects panel is of another sheet".to_owned());
        let start = format!("{} flipped ", outcome.step.verdict.flipped_faces.len());
        let is_count = |node: &AccessKitNode<'_>| {
            node.label().or_else(|| node.value()).is_some_and(|name| name.starts_with(&start))
        };
        let has_count = window.harness.query_all_by(is_count).next().is_some();
        check(says || has_count, &|| format!("the Defects panel has no number {start:?}"));
    }
    if is_quiet {
        found.extend(session_disagreements(window, pill.as_deref()));
    }
    found
}

fn session_disagreements(window: &Window, pill: Option<&str>) -> Vec<String> {
    let mut found = Vec::new();
    let editor = window.editor();
    let (session, timeline) = (&editor.session, editor.session.timeline());
    let drawn = editor.plane.scene().map(|scene| scene.outcome_revision);
    if let Some(pill) = pill {
        let is_of_step = match window.pill() {
            Pill::Proved | Pill::Unmet => !editor.shows_preview(),
            Pill::Bad => true,
            Pill::Stale | Pill::AtWork => false,
        };
        let is_there = drawn == Some(session.outcome_revision()) && session.is_current();
        if is_of_step && !is_there {
            found.push(format!("{pill:?}, but the session is elsewhere"));
        }
        // The number of a movement is the step that it leads to.
        let to = window.numbers_of_verdict().last().copied();
        if window.pill() == Pill::AtWork && to.is_some() && to != timeline.shown() {
            found.push(format!("{pill:?}, and step {:?} is wanted", timeline.shown()));
        }
    }
    for node in window.harness.query_all_by_role(Role::Button) {
        let node = node.accesskit_node();
        let Some(name) = node.label().filter(|name| name.starts_with("Step ")) else { continue };
        let Some(index) = name[5..].split(':').next().and_then(|number| number.parse::<usize>().ok()) else { continue };
        let is_marked = node.toggled() == Some(Toggled::True);
        if is_marked != (timeline.shown() == Some(index)) {
            found.push(format!("chip {name:?} is marked: {is_marked}; shown is {:?}", timeline.shown()));
        }
        let Some(record) = timeline.records().get(index) else {
            found.push(format!("there is no step of chip {name:?}"));
            continue;
        };
        let defects = name.split(", ").nth(1).and_then(|state| state.split(' ').next()?.parse::<usize>().ok());
        if (defects.is_none(), defects.unwrap_or(0)) != (record.planar, record.defect_count()) {
            found.push(format!("chip {name:?} of a step with {} defects", record.defect_count()));
        }
    }
    // A resting pointer during a drag starts a run that the frame does not show yet. A comparison covers the
    // timeline.
    let is_known = editor.has_disk() && editor.tools.dragged().is_none() && !editor.plane.comparison.is_shown();
    if is_known && window.has_button("Pause") != session.is_running() {
        found.push(format!("Pause shows, and a run goes on: {}", session.is_running()));
    }
    found
}

fn pill(window: &Window) -> Option<String> {
    let pill = window.harness.query_by(|node| node.label().is_some_and(|label| label.starts_with("Verdict: ")))?;
    let label = pill.accesskit_node().label()?;
    Some(label.trim_start_matches("Verdict: ").to_owned())
}

/// Numbers of defects by kind, in the order of the pill, without zeros.
fn counts_of(verdict: &Verdict) -> Vec<usize> {
    let counts = [
        verdict.flipped_faces.len(),
        verdict.concave_polygons.len(),
        verdict.crossed_holes.len(),
        verdict.boundary_crossings.len(),
        verdict.overwound_vertices.len(),
    ];
    counts.into_iter().filter(|&count| count > 0).collect()
}

fn from_environment<T: std::str::FromStr>(name: &str, otherwise: T) -> T {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(otherwise)
}

/// Walks, and returns the topics of the pill's texts.
fn walk(seed: u64, actions: u32) -> BTreeSet<Said> {
    let mut walk = Walk::new(seed);
    for i in 0..actions {
        if i == actions / 2 {
            // From here on the automatic strategy repairs folds.
            walk.window.editor_mut().session.handle(Action::SetSettings(Settings::default()));
        }
        walk.go_on();
        if i % 50 == 49 {
            walk.done.push("time to come to rest".to_owned());
            walk.window.harness.input_mut().events.extend(walk.held.take());
            walk.window.harness.input_mut().events.extend(key(Key::Escape, Modifiers::NONE));
            walk.window.settle();
            let found = disagreements(&walk.window, true);
            assert!(found.is_empty(), "{found:#?}\nafter {:#?}", walk.done);
        }
    }
    println!("{actions} actions, slowest frame {:?}", walk.window.slowest);
    walk.said
}

#[test]
fn the_window_agrees_with_itself_whatever_is_pressed() {
    let (seed, actions) = (from_environment("FREEBOUND_WALK_SEED", 1), from_environment("FREEBOUND_WALK", ACTIONS));
    let wanted = [Said::Planar, Said::Defects, Said::Movement, Said::Preview];
    let mut said = BTreeSet::new();
    // What a walk meets depends on the speed of the machine, too: further walks meet the rest.
    for more in 0..MOST_WALKS {
        said.extend(walk(seed + more, actions));
        if wanted.iter().all(|topic| said.contains(topic)) {
            return;
        }
    }
    panic!("the pill said only {said:?} of {wanted:?}");
}
