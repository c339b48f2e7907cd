//! Findings about the layout of the file, in the defects tab.

use std::time::{Duration, Instant};

use freebound::session::LayoutCheckState;
use freebound_core::mesh::VertexId;
use freebound_core::verify::FindingCode;

use crate::harness::Window;

/// Two separate strips of two triangles. Face 1 is flipped, and face 2 lies on a line.
const STRIPS: &str = "\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0
vt 0 0\nvt 0.4 0\nvt 0.4 0.4\nvt 0.39 0.01\nvt 0.5 0.5\nvt 0.6 0.5\nvt 0.7 0.5\nvt 0.5 0.7
f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/5 6/6 7/7\nf 5/5 7/7 8/8\n";

fn until_checked(window: &mut Window) {
    let start = Instant::now();
    while matches!(window.editor().session.layout_check(), Some(LayoutCheckState::Open | LayoutCheckState::Running)) {
        assert!(start.elapsed() < Duration::from_mins(1), "{:?}", window.words());
        std::thread::sleep(Duration::from_millis(1));
        window.step();
    }
    window.settle();
}

#[test]
fn findings_about_the_layout_of_a_file_lead_to_their_faces_on_any_chart() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("strips.obj");
    std::fs::write(&path, STRIPS).expect("written");
    let mut window = Window::with_file(&path);
    window.settle();
    // A file that is opened is checked by itself.
    window.click("Defects");
    until_checked(&mut window);
    let Some(LayoutCheckState::Done(found)) = window.editor().session.layout_check() else { panic!("checked") };
    assert!(!found.planar, "{found:?}");
    let of = |code: FindingCode| found.findings.iter().find(|finding| finding.code == code).expect("found");
    for finding in &found.findings {
        assert!(window.words().iter().any(|words| words.contains(&finding.headline()[1..])), "{:?}", window.words());
    }
    let source = window.editor().session.model().expect("open").source.polygons.clone();
    let mut go = |code: FindingCode| {
        let faces = of(code).pairs.first().map_or_else(|| vec![of(code).faces[0]], |pair| pair.to_vec());
        let words = if of(code).count == 1 { "Show" } else { "Next" };
        window.click(&format!("{words} of {}", code.name().replace('-', " ")));
        window.settle();
        let scene = window.editor().mesh_scene().expect("a scene").clone();
        let selected = window.editor().selection.vertices().clone();
        let charts = window.editor().session.charts().expect("two charts").clone();
        assert_eq!(window.editor().session.chart_on_screen(), charts.chart_of_file_face(faces[0]), "{code:?}");
        let positions = &scene.mesh().positions;
        let of_first: Vec<VertexId> = source.face(faces[0].index()).to_vec();
        assert!(selected.len() >= 3, "{selected:?}");
        for vertex in of_first {
            let at = source.positions[vertex.index()];
            assert!(selected.iter().any(|on_screen| positions[on_screen.index()] == at), "{code:?}: {vertex} at {at}");
        }
        faces[0].index()
    };
    let flipped = go(FindingCode::Flipped);
    let line = go(FindingCode::Degenerate);
    assert_eq!([flipped, line], [1, 2], "faces of both charts");
    assert_eq!(go(FindingCode::Flipped), flipped, "and back");
}

#[test]
fn a_file_without_texture_coordinates_has_no_layout_to_check() {
    let mut window = Window::with_mesh("sheet.obj", &crate::harness::sheet(3, 0.2));
    window.click("Defects");
    assert!(!window.has_button("Check the layout of the file"), "{:?}", window.words());
    assert!(window.editor().session.layout_check().is_none());
}
