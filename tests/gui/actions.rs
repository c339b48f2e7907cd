//! Actions of tests on a window, and observations through its accessibility tree and its painted shapes.

use eframe::egui;
use egui::accesskit::{Action as Offer, Role};
use egui::{Color32, Key, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT, Queryable};
use freebound::ui::{Pane, Request, ShadingMode, theme};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Surface;
use glam::DVec2;

use crate::harness::Window;

/// Name of the mesh's drawing surface.
pub(crate) const MESH_VIEW: &str = "3D view of the mesh";

/// Name of the embedding's drawing surface.
pub(crate) const PLANE_VIEW: &str = "Embedding in the plane";

/// Kind of the verdict in the pill, by the colour of its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pill {
    /// Planar and proved.
    Proved,
    /// Planar, with constraints that are not met.
    Unmet,
    /// Defects of the embedding, or faults of the mesh.
    Bad,
    /// Preview, or a step that is not up to date.
    Stale,
    /// Work in progress, or a movement to another step.
    AtWork,
}

impl Pill {
    /// Kind with a colour of one of the two themes.
    fn of(colour: Color32) -> Option<Self> {
        let kinds = |theme: &theme::Theme| {
            [
                (theme.planar, Self::Proved),
                (theme.unmet, Self::Unmet),
                (theme.flipped, Self::Bad),
                (theme.stale, Self::Stale),
                (theme.weak_text, Self::AtWork),
            ]
        };
        let all = [kinds(&theme::LIGHT), kinds(&theme::DARK)].concat();
        all.into_iter().find(|(of, _)| *of == colour).map(|(_, kind)| kind)
    }
}

impl Window {
    /// Presses keys together with modifiers.
    pub(crate) fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.settle();
    }

    /// Presses a key without modifiers.
    pub(crate) fn key(&mut self, key: Key) {
        self.press(Modifiers::NONE, key);
    }

    /// Presses a key without modifiers, and does not wait for the effects.
    pub(crate) fn key_now(&mut self, key: Key) {
        self.harness.key_press(key);
        self.step();
    }

    /// Types text like a keyboard: each letter is a key and a text.
    pub(crate) fn type_text(&mut self, text: &str) {
        for letter in text.chars() {
            if let Some(key) = Key::from_name(&letter.to_ascii_uppercase().to_string()) {
                self.harness.key_down(key);
                self.harness.event(egui::Event::Text(letter.to_string()));
                self.harness.key_up(key);
            } else {
                self.harness.event(egui::Event::Text(letter.to_string()));
            }
        }
        self.step();
    }

    /// Returns the button, menu, entry or tab with this name. Menu entries have their keys after their name.
    fn button(&self, name: &str) -> Option<Node<'_>> {
        let with_keys = format!("{name} ");
        let named = |wanted: &dyn Fn(&str) -> bool| {
            let mut buttons = self.harness.query_all_by_role(Role::Button);
            buttons.find(|node| node.accesskit_node().label().is_some_and(|label| wanted(&label)))
        };
        named(&|label| label == name).or_else(|| named(&|label| label.starts_with(&with_keys)))
    }

    /// Clicks a button, menu, entry or tab.
    pub(crate) fn click(&mut self, name: &str) {
        let Some(button) = self.button(name) else { panic!("no button is called {name:?}: {:?}", self.words()) };
        button.click();
        self.settle();
    }

    /// Clicks the last of several buttons with one name.
    pub(crate) fn click_last(&mut self, name: &str) {
        self.harness.get_all_by_role_and_label(Role::Button, name).last().expect("a button").click();
        self.settle();
    }

    /// Clicks through menus.
    pub(crate) fn menu(&mut self, names: &[&str]) {
        for name in names {
            self.click(name);
        }
    }

    /// Opens a drop-down list.
    pub(crate) fn open_list(&mut self, list: &str) {
        self.harness.get_by_role_and_label(Role::ComboBox, list).click();
        self.settle();
    }

    /// Chooses from a drop-down list.
    pub(crate) fn choose(&mut self, list: &str, entry: &str) {
        let places = |window: &Self| -> Vec<Rect> {
            window.harness.query_all_by_role_and_label(Role::Button, entry).map(|node| node.rect()).collect()
        };
        let before = places(self);
        self.open_list(list);
        let now = self.harness.query_all_by_role_and_label(Role::Button, entry);
        let mut new = now.filter(|node| !before.contains(&node.rect()));
        new.next().expect("an entry that the list has brought").click();
        drop(new);
        self.settle();
    }

    pub(crate) fn has_button(&self, name: &str) -> bool {
        self.button(name).is_some()
    }

    pub(crate) fn is_enabled(&self, name: &str) -> bool {
        !self.button(name).expect("a button of that name").accesskit_node().is_disabled()
    }

    /// Clicks a text field and replaces its text.
    pub(crate) fn fill_in(&mut self, role: Role, name: &str, text: &str) {
        self.harness.get_by_role_and_label(role, name).click();
        self.step();
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.step();
        self.type_text(text);
    }

    /// Bounds of a control.
    pub(crate) fn rect(&self, role: Role, name: &str) -> Rect {
        self.harness.get_by_role_and_label(role, name).rect()
    }

    pub(crate) fn mesh_view(&self) -> Rect {
        self.rect(Role::Image, MESH_VIEW)
    }

    pub(crate) fn plane_view(&self) -> Rect {
        self.rect(Role::Image, PLANE_VIEW)
    }

    /// Name of the first control with a role that begins with `start`.
    pub(crate) fn name_of(&self, role: Role, start: &str) -> String {
        let mut nodes = self.harness.query_all_by_role(role);
        let name = nodes.find_map(|node| node.accesskit_node().label().filter(|label| label.starts_with(start)));
        name.unwrap_or_else(|| panic!("no name begins with {start:?}: {:?}", self.words()))
    }

    /// Button of the verdict, if it shows.
    fn pill_button(&self) -> Option<Node<'_>> {
        self.harness.query_by(|node| node.label().is_some_and(|label| label.starts_with("Verdict: ")))
    }

    /// Text of the verdict's pill.
    pub(crate) fn verdict(&self) -> String {
        let label = self.pill_button().and_then(|pill| pill.accesskit_node().label()).expect("the verdict shows");
        label.trim_start_matches("Verdict: ").to_owned()
    }

    /// Numbers in the text of the verdict's pill.
    pub(crate) fn numbers_of_verdict(&self) -> Vec<usize> {
        self.verdict().split(' ').filter_map(|word| word.parse().ok()).collect()
    }

    /// Kind of the verdict's pill.
    pub(crate) fn pill(&self) -> Pill {
        let place = self.pill_button().expect("the verdict shows").rect();
        let kind = |shape: &egui::Shape| match shape {
            egui::Shape::Text(text) if place.contains(text.pos) => Pill::of(text.fallback_color),
            _ => None,
        };
        let mut shapes = self.harness.output().shapes.iter();
        shapes.find_map(|shape| kind(&shape.shape)).expect("its words have a colour of the theme")
    }

    /// True if the pill has the colour of an embedding proved planar, with all constraints met, and no pin is dragged.
    pub(crate) fn is_proved(&self) -> bool {
        self.pill() == Pill::Proved && !self.editor().shows_preview()
    }

    /// True if the mesh cannot be flattened, and the pill has the number of its faults.
    pub(crate) fn is_faulty(&self) -> bool {
        let Some(model) = self.editor().session.model() else { return false };
        let Surface::Faulty(_, diagnosis) = &model.prepared.surface else { return false };
        self.pill() == Pill::Bad && self.numbers_of_verdict() == [diagnosis.faults.len()]
    }

    /// All texts painted in the last frame.
    pub(crate) fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        for shape in &self.harness.output().shapes {
            collect_words(&shape.shape, &mut words);
        }
        words
    }

    /// True if a text painted in the last frame contains `words`.
    pub(crate) fn shows(&self, words: &str) -> bool {
        self.words().iter().any(|painted| painted.contains(words))
    }

    /// First text painted in the last frame that contains `word`.
    pub(crate) fn text_with(&self, word: &str) -> String {
        let words = self.words();
        let found = words.iter().find(|painted| painted.contains(word));
        found.unwrap_or_else(|| panic!("no text has {word:?}: {words:?}")).clone()
    }

    /// True if the last frame painted a ring around `place`.
    pub(crate) fn has_ring_at(&self, place: Pos2) -> bool {
        let is_ring = |shape: &egui::Shape| match shape {
            egui::Shape::Circle(circle) => circle.center.distance(place) < 1.0 && circle.stroke.width > 0.0,
            _ => false,
        };
        self.harness.output().shapes.iter().any(|shape| is_ring(&shape.shape))
    }

    /// Ends of all straight lines painted in the last frame.
    pub(crate) fn lines(&self) -> Vec<[Pos2; 2]> {
        let line = |shape: &egui::Shape| match shape {
            egui::Shape::LineSegment { points, .. } => Some(*points),
            _ => None,
        };
        self.harness.output().shapes.iter().filter_map(|shape| line(&shape.shape)).collect()
    }

    /// True if the last frame painted a frame tightly around a part of the window.
    pub(crate) fn has_frame_around(&self, part: Rect) -> bool {
        let is_frame = |shape: &egui::Shape| match shape {
            egui::Shape::Rect(shape) => {
                let room = shape.rect.size() - part.size();
                shape.stroke.width > 0.0
                    && shape.rect.expand(1.0).contains_rect(part)
                    && room.max_elem() < part.size().max_elem() + 20.0
            }
            _ => false,
        };
        self.harness.output().shapes.iter().any(|shape| is_frame(&shape.shape))
    }

    /// Position of a vertex on the screen, in the mesh's pane.
    pub(crate) fn place_on_mesh(&self, vertex: VertexId) -> Pos2 {
        let editor = self.editor();
        let scene = editor.mesh_scene().expect("a mesh shows");
        let position = scene.mesh().positions[vertex.index()];
        let camera = editor.mesh.pane.camera().expect("a mesh shows");
        on_screen(self.mesh_view(), camera.pane_from_world(position, editor.mesh.pane.size()).expect("before the eye"))
    }

    /// Position of a point of the embedding on the screen.
    pub(crate) fn place_in_plane(&self, point: DVec2) -> Pos2 {
        let camera = self.editor().plane.pane.camera().expect("an embedding shows");
        on_screen(self.plane_view(), camera.pane_from_embedding(point, self.editor().plane.pane.size()))
    }

    /// Clearly visible vertex near the middle of the mesh's pane.
    pub(crate) fn vertex_in_the_middle(&self) -> VertexId {
        let editor = self.editor();
        let scene = editor.mesh_scene().expect("a mesh shows");
        let camera = editor.mesh.pane.camera().expect("a mesh shows");
        let size = editor.mesh.pane.size();
        let mut best = (f64::INFINITY, VertexId::new(0));
        for (i, position) in scene.mesh().positions.iter().enumerate() {
            let vertex = VertexId::from_index(i);
            let Some(at) = camera.pane_from_world(*position, size) else { continue };
            let distance = at.distance(size / 2.0);
            if distance < best.0 && scene.picker.is_visible(vertex, camera.eye()) {
                best = (distance, vertex);
            }
        }
        best.1
    }

    /// Sets the shading of both panes.
    pub(crate) fn shade(&mut self, shading: ShadingMode) {
        for pane in [Pane::Mesh, Pane::Plane] {
            self.editor_mut().handle(Request::SetPaneShading(pane, shading));
        }
    }

    /// Shadings of the mesh's pane and of the embedding's pane.
    pub(crate) fn shadings(&self) -> [ShadingMode; 2] {
        [Pane::Mesh, Pane::Plane].map(|pane| self.editor().shading(pane))
    }

    /// Clicks a point of the window.
    pub(crate) fn click_at(&mut self, at: Pos2, modifiers: Modifiers) {
        self.harness.hover_at(at);
        self.harness.event(egui::Event::ModifiersChanged(modifiers));
        for pressed in [true, false] {
            self.harness.event(left_button(at, pressed, modifiers));
        }
        self.harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        self.settle();
    }

    /// Clicks a point of the window twice.
    pub(crate) fn double_click_at(&mut self, at: Pos2) {
        self.harness.hover_at(at);
        self.step();
        for pressed in [true, false, true, false] {
            let (button, modifiers) = (egui::PointerButton::Primary, Modifiers::NONE);
            self.frame_after(0.02, [egui::Event::PointerButton { pos: at, button, pressed, modifiers }]);
        }
        self.settle();
    }

    /// Presses at `from` and moves to `to` in steps, without releasing.
    pub(crate) fn begin_drag(&mut self, from: Pos2, to: Pos2, modifiers: Modifiers) {
        self.harness.hover_at(from);
        self.harness.event(egui::Event::ModifiersChanged(modifiers));
        self.harness.event(left_button(from, true, modifiers));
        for i in 1..=8_u8 {
            self.harness.hover_at(from + (to - from) * (f32::from(i) / 8.0));
        }
        self.step();
    }

    /// Releases the button.
    pub(crate) fn end_drag(&mut self, at: Pos2) {
        self.harness.event(left_button(at, false, Modifiers::NONE));
        self.harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        self.settle();
    }

    pub(crate) fn drag(&mut self, from: Pos2, to: Pos2, modifiers: Modifiers) {
        self.begin_drag(from, to, modifiers);
        self.end_drag(to);
    }

    /// Visible nodes that accept actions, with role, name and bounds.
    pub(crate) fn controls(&self) -> Vec<(Role, String, Rect)> {
        let nodes = self.harness.root().children_recursive();
        let acts = [Offer::Click, Offer::SetValue, Offer::Increment, Offer::Expand];
        let controls = nodes.filter(|node| {
            let node = node.accesskit_node();
            acts.iter().any(|action| node.data().supports_action(*action)) && !node.is_hidden()
        });
        controls
            .map(|node| {
                let words = node.accesskit_node();
                let name = words.label().or_else(|| words.value()).unwrap_or_default();
                (words.role(), name, node.rect())
            })
            .collect()
    }
}

fn left_button(pos: Pos2, pressed: bool, modifiers: Modifiers) -> egui::Event {
    egui::Event::PointerButton { pos, button: egui::PointerButton::Primary, pressed, modifiers }
}

fn collect_words(shape: &egui::Shape, words: &mut Vec<String>) {
    match shape {
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect_words(shape, words)),
        egui::Shape::Text(text) => words.push(text.galley.text().to_owned()),
        _ => {}
    }
}

#[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
fn on_screen(rect: Rect, point: DVec2) -> Pos2 {
    rect.min + Vec2::new(point.x as f32, point.y as f32)
}
