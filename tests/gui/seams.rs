//! Seam tool: seams drawn by clicks from vertex to vertex, erased, undone.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use freebound::ui::{Tool, sentence};
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_io::LabelError;
use glam::DVec3;

use crate::harness::Window;
use freebound_testkit::{assert_message, tetrahedron, tube};

pub(crate) const AROUND: u32 = 12;
pub(crate) const ALONG: u32 = 6;

/// Upright barrel without lid and bottom; vertex `row · AROUND + k`.
fn barrel() -> TriMesh {
    let TriMesh { mut positions, mut triangles, .. } = tube(AROUND, ALONG);
    positions.pop();
    triangles.truncate(triangles.len() - AROUND as usize);
    let positions = positions.into_iter().map(|p| DVec3::new(p.x, p.z, -p.y)).collect();
    TriMesh { positions, triangles, polygon_of: None }
}

pub(crate) fn at(k: u32, row: u32) -> VertexId {
    VertexId::new(row * AROUND + k)
}

/// Column of the barrel that is visible from bottom to top.
pub(crate) fn front(window: &Window) -> u32 {
    let scene = window.editor().mesh_scene().expect("a mesh shows");
    let eye = window.editor().mesh.pane.camera().expect("a mesh shows").eye();
    let shows = |k: &u32| (0..=ALONG).all(|row| scene.picker.is_visible(at(*k, row), eye));
    // The middle one is seen from the front.
    let all: Vec<u32> = (0..AROUND).filter(shows).collect();
    all[all.len() / 2]
}

pub(crate) fn window() -> Window {
    let mut window = Window::with_mesh("barrel.obj", &barrel());
    // Without the automatic seams that the mesh opens with.
    window.press(Modifiers::COMMAND, Key::Z);
    window.key(Key::X);
    assert_eq!(window.editor().tools.tool(), Tool::Seam);
    window
}

/// Position of a vertex of the file on the screen.
pub(crate) fn place(window: &Window, vertex: VertexId) -> Pos2 {
    let position = window.editor().session.model().expect("open").source.polygons.positions[vertex.index()];
    let camera = window.editor().mesh.pane.camera().expect("a mesh shows");
    let size = window.editor().mesh.pane.size();
    let point = camera.pane_from_world(position, size).expect("before the eye");
    #[expect(clippy::cast_possible_truncation, reason = "points of the screen are f32")]
    let offset = egui::vec2(point.x as f32, point.y as f32);
    window.mesh_view().min + offset
}

pub(crate) fn click(window: &mut Window, vertex: VertexId, modifiers: Modifiers) {
    let place = place(window, vertex);
    window.click_at(place, modifiers);
    // Prevents a double click.
    window.frame_after(1.0, []);
}

pub(crate) fn seams(window: &Window) -> Vec<[u32; 2]> {
    window.editor().session.seams().edges().iter().map(|edge| edge.map(VertexId::number)).collect()
}

/// Edges of a column between two rows.
pub(crate) fn column(k: u32, rows: std::ops::Range<u32>) -> Vec<[u32; 2]> {
    rows.map(|row| [at(k, row), at(k, row + 1)].map(VertexId::number)).collect()
}

pub(crate) fn last(window: &Window) -> Option<VertexId> {
    window.editor().tools.seam.last()
}

/// True if the hint for a click has this number of edges, and this vertex.
pub(crate) fn hints_at(window: &Window, edges: u32, vertex: VertexId) -> bool {
    let hint = window.text_with("Click");
    let has = |wanted: String| hint.split([' ', '.']).any(|word| word == wanted);
    has(edges.to_string()) && has(vertex.to_string())
}

/// Text about the side of a seam that a vertex of the file is on, if one shows.
pub(crate) fn side_of(window: &Window, vertex: VertexId) -> Option<String> {
    let start = format!("{vertex} ");
    window.words().into_iter().find(|words| words.starts_with(&start) && words.contains(" side "))
}

#[test]
fn two_clicks_cut_a_barrel_open_and_undo_closes_it() {
    let mut window = window();
    let k = front(&window);
    let vertex_count = |window: &Window| window.editor().session.model().expect("open").vertex_count();
    let (whole, camera) = (vertex_count(&window), window.editor().mesh.pane.camera());
    assert_message("seams-window-hint-at-first", &window.text_with("Click"));
    click(&mut window, at(k, 0), Modifiers::NONE);
    assert!(seams(&window).is_empty(), "it only begins");
    window.harness.hover_at(place(&window, at(k, ALONG)));
    window.settle();
    assert!(hints_at(&window, ALONG, at(k, ALONG)), "{:?}", window.words());
    assert_message("seams-window-hint-that-cuts", &window.text_with("Click"));
    let preview = [place(&window, at(k, 2)), place(&window, at(k, 3))];
    let is_preview = |line: &[Pos2; 2]| preview.iter().all(|end| line.iter().any(|point| point.distance(*end) < 1.0));
    assert!(window.lines().iter().any(is_preview), "the path shows before it is cut");
    click(&mut window, at(k, ALONG), Modifiers::NONE);
    assert_eq!(seams(&window), column(k, 0..ALONG));
    assert!(window.is_proved(), "{}", window.verdict());
    assert_eq!(vertex_count(&window), whole + ALONG as usize + 1, "the vertices of the seam are there twice");
    assert_eq!(window.editor().mesh.pane.camera(), camera, "nothing moves in space");
    assert_eq!((window.editor().tools.tool(), last(&window)), (Tool::Seam, Some(at(k, ALONG))), "it can go on");
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(seams(&window).is_empty() && window.is_proved());
    assert_eq!((vertex_count(&window), last(&window)), (whole, Some(at(k, 0))), "it goes on from there again");
    window.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(seams(&window), column(k, 0..ALONG));
}

#[test]
fn a_seam_goes_on_from_click_to_click_until_enter_a_second_click_or_escape_ends_it() {
    let mut window = window();
    let k = front(&window);
    for row in [0, 2, 4] {
        click(&mut window, at(k, row), Modifiers::NONE);
    }
    assert_eq!(seams(&window), column(k, 0..4));
    window.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(seams(&window), column(k, 0..2), "each click is an edit of its own");
    window.key(Key::Enter);
    assert_eq!(last(&window), None);
    click(&mut window, at(k, 5), Modifiers::NONE);
    assert_eq!(seams(&window), column(k, 0..2), "another one begins there");
    click(&mut window, at(k, 5), Modifiers::NONE);
    assert_eq!(last(&window), None, "a second click on the same vertex ends it");
    click(&mut window, at(k, 5), Modifiers::NONE);
    window.key(Key::Escape);
    assert_eq!((window.editor().tools.tool(), last(&window)), (Tool::Seam, None));
    window.key(Key::Escape);
    assert_eq!(window.editor().tools.tool(), Tool::Select);
}

#[test]
fn clicks_that_come_before_the_paths_are_found_count() {
    let mut window = window();
    let k = front(&window);
    let places = [0, 3, ALONG].map(|row| place(&window, at(k, row)));
    for at in places {
        window.harness.hover_at(at);
        for pressed in [true, false] {
            let button = egui::PointerButton::Primary;
            let event = egui::Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE };
            window.harness.event(event);
        }
        window.frame_after(1.0, []);
    }
    window.settle();
    assert_eq!(seams(&window), column(k, 0..ALONG));
}

#[test]
fn shift_takes_a_stretch_away_or_what_lies_between_two_clicks() {
    let mut window = window();
    let k = front(&window);
    for row in [0, ALONG] {
        click(&mut window, at(k, row), Modifiers::NONE);
    }
    window.key(Key::Enter);
    click(&mut window, at(k, 2), Modifiers::NONE);
    window.frame_after(0.1, [egui::Event::ModifiersChanged(Modifiers::SHIFT)]);
    click(&mut window, at(k, 4), Modifiers::SHIFT);
    assert_eq!(seams(&window), [column(k, 0..2), column(k, 4..ALONG)].concat());
    window.key(Key::Enter);
    click(&mut window, at(k, 5), Modifiers::SHIFT);
    assert_eq!(seams(&window), column(k, 0..2), "without a beginning all of the stretch goes");
    window.click("Erase");
    assert_message("seams-window-hint-that-erases", &window.text_with("Click"));
    click(&mut window, at(k, 1), Modifiers::NONE);
    assert!(seams(&window).is_empty());
    assert!(!window.is_enabled("Clear seams"));
    window.press(Modifiers::COMMAND, Key::Z);
    window.click("Clear seams");
    assert!(seams(&window).is_empty() && window.is_proved());
}

#[test]
fn a_seam_leads_from_chart_to_chart() {
    let mut window = window();
    let k = front(&window);
    // Around the barrel, which splits it into an upper and a lower chart.
    for step in [0, 4, 8, 12] {
        let around = at((k + step) % AROUND, 3);
        window
            .editor_mut()
            .handle(freebound::ui::Request::ClickSeam(freebound::ui::SeamClick { vertex: around, erases: false }));
        window.settle();
    }
    assert_eq!(seams(&window).len(), AROUND as usize);
    assert_eq!(window.editor().session.charts().map(|charts| charts.count()), Some(2));
    window.key(Key::Enter);
    let chart = window.editor().session.chart_on_screen();
    for row in [1, 5] {
        click(&mut window, at(k, row), Modifiers::NONE);
    }
    assert_eq!(window.editor().session.chart_on_screen(), chart, "a click cuts, and does not change the chart");
    assert_eq!(seams(&window).len(), AROUND as usize + 4);
}

#[test]
fn a_closed_figure_flattens_once_a_seam_opens_it() {
    let mut window = Window::with_faulty("closed.obj", &tetrahedron());
    window.key(Key::X);
    for (vertex, erases) in [(0, false), (1, false), (2, false)] {
        let vertex = VertexId::new(vertex);
        window.editor_mut().handle(freebound::ui::Request::ClickSeam(freebound::ui::SeamClick { vertex, erases }));
        window.settle();
    }
    assert_eq!(seams(&window), [[0, 1], [1, 2]]);
    assert!(window.is_proved(), "{}", window.verdict());
}

#[test]
fn the_measure_of_paths_is_chosen_by_a_slider() {
    let mut window = window();
    let slider = |window: &Window| window.harness.query_by_role_and_label(Role::Slider, "Course of paths").is_some();
    assert!(slider(&window));
    assert_eq!(window.editor().tools.seam.creases(), 0.5);
    window.harness.get_by_role_and_label(Role::Slider, "Course of paths").focus();
    window.step();
    window.key(Key::ArrowRight);
    assert!(window.editor().tools.seam.creases() > 0.5);
    window.key(Key::V);
    assert!(!slider(&window), "the strip is the tool's");
}

#[test]
fn a_click_beside_a_seam_pins_the_side_under_the_pointer_and_its_pin_says_which_that_is() {
    let mut window = window();
    let k = front(&window);
    for row in [0, ALONG] {
        click(&mut window, at(k, row), Modifiers::NONE);
    }
    window.key(Key::P);
    let on_seam = place(&window, at(k, 3));
    let (mut pinned, mut sides) = (Vec::new(), Vec::new());
    for side in [k + AROUND - 1, k + 1] {
        let beside = place(&window, at(side % AROUND, 3));
        let towards = (beside - on_seam).normalized() * 4.0;
        window.click_at(on_seam + towards, Modifiers::NONE);
        let targets = &window.editor().session.document().targets;
        let fresh: Vec<VertexId> = targets.keys().copied().filter(|vertex| !pinned.contains(vertex)).collect();
        assert_eq!(fresh.len(), 1, "another vertex than that of the other side");
        pinned.extend(&fresh);
        // A face at the pinned vertex contains the vertex beside it.
        let outcome_mesh = window.editor().mesh_scene().expect("a mesh shows").mesh();
        let position =
            window.editor().session.model().expect("open").source.polygons.positions[at(side % AROUND, 3).index()];
        let reaches = |triangle: &&[VertexId; 3]| {
            triangle.contains(&fresh[0]) && triangle.iter().any(|v| outcome_mesh.positions[v.index()] == position)
        };
        assert!(outcome_mesh.triangles.iter().any(|triangle| reaches(&triangle)), "{} beside {side}", fresh[0]);
        window.click("Vertex");
        sides.push(side_of(&window, at(k, 3)).expect("the panel names the side"));
    }
    assert_ne!(sides[0], sides[1]);
    assert_message("seams-window-sides-of-a-seam", &sides.join("\n"));
}

/// Cube of twelve triangles.
pub(crate) fn cube() -> TriMesh {
    let positions = (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriMesh::new(positions, &triangles)
}

#[test]
fn a_box_is_cut_along_its_sharp_edges_by_one_click_and_says_where_there_are_no_materials() {
    let mut window = Window::with_mesh("box.obj", &cube());
    window.key(Key::X);
    let charts = |window: &Window| window.editor().session.charts().map(|charts| charts.count());
    window.menu(&["Cut along", "Borders of materials"]);
    let refusal = sentence(&LabelError::NoMaterials.to_string());
    assert!(seams(&window).is_empty() && window.shows(&refusal), "{:?}", window.words());
    window.click("Sharp edges");
    assert_eq!((seams(&window).len(), charts(&window)), (12, Some(6)));
    assert!(window.is_proved(), "{}", window.verdict());
    assert!(window.shows("12 edges"), "{:?}", window.words());
    window.press(Modifiers::COMMAND, Key::Z);
    assert!(seams(&window).is_empty());
    window.key(Key::V);
    window.menu(&["Edit", "Seams", "Cut along sharp edges: 60° or more"]);
    assert_eq!((seams(&window).len(), charts(&window)), (12, Some(6)));
    // The entry activates the tool, whose strip has a button with an equal name.
    window.key(Key::V);
    window.menu(&["Edit", "Seams", "Clear seams"]);
    assert!(seams(&window).is_empty());
}

#[test]
fn seams_are_read_from_a_file_and_written_to_one() {
    let mut window = window();
    std::fs::write(window.path("cut.edges"), "# the first column\n0 12\n12 24\n").expect("written");
    window.menu(&["Edit", "Seams", "Import seams…"]);
    window.fill_in(Role::TextInput, "Name", "cut.edges");
    window.key(Key::Enter);
    assert_eq!(seams(&window), column(0, 0..2));
    window.menu(&["Cut along", "Export seams…"]);
    window.fill_in(Role::TextInput, "Name", "again");
    window.key(Key::Enter);
    let written = std::fs::read_to_string(window.path("again.edges")).expect("written under the name of such files");
    let edges: Vec<&str> = written.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(edges, ["0 12", "12 24"]);
}
