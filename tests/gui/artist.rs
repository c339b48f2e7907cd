//! Typical work of an artist: landmarks over a photo from opening to export, kinds of pins, context menus, and the
//! direction of v.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Modifiers, PointerButton, Pos2};
use freebound::examples::Example;
use freebound::session::Action;
use freebound::ui::{Half, Request, ShadingMode, Tab, Tool};
use freebound_core::geom::VAxis;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::PinKind;
use freebound_io::read_mesh;
use glam::DVec2;

use crate::constraints::{corners, pins, place};
use crate::harness::{Window, sheet};
use crate::pictures::open_picture;
use freebound_testkit::assert_message;

/// Largest number of clicks from a mesh and a photo to the file.
const MOST_CLICKS: usize = 20;

/// User with only a mouse, with a count of clicks.
struct Artist {
    window: Window,
    clicks: usize,
}

impl Artist {
    fn click(&mut self, name: &str) {
        self.clicks += 1;
        self.window.click(name);
    }

    fn click_at(&mut self, at: Pos2) {
        self.clicks += 1;
        self.window.click_at(at, Modifiers::NONE);
    }
}

#[test]
fn six_landmarks_over_a_photo_take_no_key_and_no_change_of_shading() {
    let mut artist = Artist { window: Window::with_mesh("sheet.obj", &sheet(8, 0.2)), clicks: 0 };
    let photo = artist.window.path("portrait.png");
    let file = std::fs::File::create(&photo).expect("a folder for files");
    freebound_io::raster::write_png(&Example::Face.picture().expect("it has one"), file).expect("written");
    artist.window.harness.input_mut().dropped_files.push(crate::dialogs::dropped(photo));
    artist.window.settle();
    artist.click("Constrain: choose the position of a vertex");
    for (count, vertex) in (1..).zip([20, 24, 38, 42, 56, 60].map(VertexId::new)) {
        assert_eq!(artist.window.shadings(), [ShadingMode::Plain, ShadingMode::SeeThrough]);
        artist.click_at(artist.window.place_on_mesh(vertex));
        assert_eq!(artist.window.editor().tools.pair(), Some(Half::Vertex(vertex)));
        let (column, row) = (f64::from(vertex.number() % 9), f64::from(vertex.number() / 9));
        let target = DVec2::new(0.2 + 0.07 * column, 0.25 + 0.06 * row + 0.01 * column);
        let frame = artist.window.editor().session.document().frame();
        artist.click_at(artist.window.place_in_plane(frame.plane_from_uv(target)));
        assert_eq!(pins(&artist.window).len(), count, "{vertex}");
        let placed = pins(&artist.window)[&vertex].uv;
        assert!(placed.distance(target) < 0.01, "{vertex}: {placed}");
    }
    for name in ["File", "Export", "Mesh with texture coordinates…", "Save"] {
        artist.click(name);
    }
    assert!(artist.clicks <= MOST_CLICKS, "{} clicks", artist.clicks);
    assert!(artist.window.is_proved(), "{}", artist.window.verdict());
    let written = read_mesh(&artist.window.path("sheet-flat.obj")).expect("a mesh");
    assert!(written.texture.is_some());
}

#[test]
fn an_embedding_over_a_photo_stands_upright_at_once() {
    let mut window = Window::with_example(Example::Face);
    open_picture(&mut window);
    let height = |name: &str| {
        let landmark = Example::Face.landmarks().into_iter().find(|landmark| landmark.name == name).expect(name);
        window.place_in_plane(window.embedding()[landmark.vertex]).y
    };
    assert!(height("bridge of the nose") < height("tip of the nose"), "the screen's y runs down");
    assert!(height("tip of the nose") < height("lower lip"));
}

#[test]
fn the_cell_of_an_exact_pin_is_a_menu_of_weights() {
    let mut window = crate::constraints::window();
    corners(&mut window);
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    window.click("State of pin v40: hard");
    window.click("Weight 10");
    assert_eq!(pins(&window)[&VertexId::new(40)].kind, PinKind::Soft(10.0));
    assert_eq!(pins(&window)[&VertexId::new(0)].kind, PinKind::Hard, "the others stay");
}

/// Clicks with the right button.
fn click_right(window: &mut Window, at: Pos2) {
    window.harness.hover_at(at);
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        window.harness.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
    }
    window.settle();
}

#[test]
fn a_vertex_has_a_menu_on_the_mesh() {
    let mut window = crate::constraints::window();
    let vertex = window.vertex_in_the_middle();
    let at = window.place_on_mesh(vertex);
    click_right(&mut window, at);
    window.click("Fix at its current position");
    assert_eq!(pins(&window)[&vertex].kind, PinKind::Fixed);
    click_right(&mut window, at);
    window.click("Choose another position");
    assert_eq!(window.editor().tools.tool(), Tool::Constrain);
    assert_eq!(window.editor().tools.pair(), Some(Half::Vertex(vertex)));
}

#[test]
fn a_pin_has_a_menu_in_the_embedding_and_in_its_row() {
    let mut window = crate::constraints::window();
    corners(&mut window);
    let at = window.rect(Role::Button, "Constraint v40").center();
    click_right(&mut window, at);
    window.click("Free");
    assert!(!pins(&window).contains_key(&VertexId::new(40)));
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    let at = window.rect(Role::Button, "v80").center();
    click_right(&mut window, at);
    window.click("Weight 0.1");
    assert_eq!(pins(&window)[&VertexId::new(80)].kind, PinKind::Soft(0.1));
}

#[test]
fn v_down_leaves_pins_and_picture_where_they_are_on_the_screen() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.0));
    open_picture(&mut window);
    place(&mut window, &[(24, Target::hard(DVec2::new(0.25, 0.75))), (0, Target::weighted(DVec2::new(0.1, 0.2), 3.0))]);
    let on_screen = |window: &Window| {
        let corners = window.editor().session.document().frame().corners().map(|corner| window.place_in_plane(corner));
        let pins = [24, 0].map(|v| window.rect(Role::Button, &format!("Constraint v{v}")).center());
        let sheet = [24, 40].map(|v| window.place_in_plane(window.embedding()[v]));
        [corners, pins, sheet].concat()
    };
    let before = on_screen(&window);
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    for (button, axis, v) in [("v down", VAxis::Down, 0.25), ("v up", VAxis::Up, 0.75)] {
        window.click(button);
        assert_eq!(window.editor().session.document().v_axis, axis);
        assert_eq!(pins(&window)[&VertexId::new(24)].uv, DVec2::new(0.25, v));
        assert_eq!(pins(&window)[&VertexId::new(0)].kind, PinKind::Soft(3.0));
        for (a, b) in before.iter().zip(on_screen(&window)) {
            assert!(a.distance(b) < 1.0, "{button}: {a} {b}");
        }
    }
    window.editor_mut().session.handle(Action::Undo);
    window.settle();
    assert_eq!(window.editor().session.document().v_axis, VAxis::Down, "one undo step");
    assert_eq!(pins(&window)[&VertexId::new(24)].uv, DVec2::new(0.25, 0.25));
}

#[test]
fn the_share_of_faces_outside_the_picture_is_said() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.0));
    open_picture(&mut window);
    window.editor_mut().handle(Request::ShowTab(Tab::Pins));
    window.settle();
    assert!(!window.shows("outside"), "it is made to lie on it");
    // The left half of the sheet is outside the picture: 36 of 72 faces.
    let at = |u: f64, v: f64| Target::hard(DVec2::new(u, v));
    place(&mut window, &[(0, at(-0.25, 0.0)), (6, at(0.25, 0.0)), (42, at(-0.25, 1.0)), (48, at(0.25, 1.0))]);
    let share = window.text_with("outside");
    assert!(share.starts_with("50.0 %"), "{share}");
    assert_message("artist-window-faces-outside-the-picture", &share);
}

#[test]
fn a_selected_vertex_that_the_mesh_hides_shows_through_it() {
    let mut window = Window::with_example(Example::BumpyCap);
    let hidden = {
        let editor = window.editor();
        let scene = editor.mesh_scene().expect("a mesh");
        let eye = editor.mesh.pane.camera().expect("a mesh").eye();
        let vertices = (0..scene.mesh().vertex_count()).map(VertexId::from_index);
        let far = vertices.filter(|&v| !scene.picker.is_visible(v, eye));
        let distance = |v: &VertexId| scene.mesh().positions[v.index()].distance(eye);
        far.max_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a back")
    };
    window.editor_mut().handle(Request::Select(vec![hidden]));
    window.settle();
    let editor = window.editor();
    let eye = editor.mesh.pane.camera().expect("a mesh").eye();
    assert!(!editor.mesh_scene().expect("a mesh").picker.is_visible(hidden, eye));
    assert!(window.has_ring_at(window.place_on_mesh(hidden)));
}
