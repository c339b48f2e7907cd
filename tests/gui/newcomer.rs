//! Run of a newcomer: from the start to an exported, packed and proved layout in four clicks. The files that are written
//! are read back and judged, with an energy of the test's own.

use std::fmt::Write as _;

use eframe::egui::accesskit::Role;
use freebound::app::LaunchFile;
use freebound::session::{Action, SaveRequest};
use freebound_core::mesh::{PolygonMesh, TriMesh, VertexId};
use freebound_core::pipeline::Fit;
use freebound_core::problem::{Control, Embedding};
use freebound_core::verify::LayoutOptions;
use freebound_io::{MeshFile, OutputKind, read_mesh};
use freebound_testkit::solids::prism;
use freebound_testkit::{Random, bumpy_ball, head, quad_sheet, scan};
use glam::{DMat2, DVec2, DVec3};

use crate::harness::{SIZE, Window};

/// Greatest energy of a chart that serves.
const SERVES: f64 = 4.5;

/// OBJ text of parts that do not touch.
fn obj(parts: &[PolygonMesh]) -> String {
    let (mut text, mut first) = (String::new(), 1);
    for part in parts {
        for p in &part.positions {
            writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z).expect("memory");
        }
        for face in 0..part.face_count() {
            let corners: Vec<String> = part.face(face).iter().map(|v| (first + v.index()).to_string()).collect();
            writeln!(text, "f {}", corners.join(" ")).expect("memory");
        }
        first += part.positions.len();
    }
    text
}

fn moved(part: PolygonMesh, by: DVec3) -> PolygonMesh {
    let positions = part.positions.iter().map(|p| *p + by).collect();
    PolygonMesh { positions, ..part }
}

/// Head of quads with an open neck, and two bent sheets as eyes.
fn head_with_eyes() -> String {
    let mut skull = head(12);
    let low = skull.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let height = |face: usize| skull.face(face).iter().map(|v| skull.positions[v.index()].y).sum::<f64>() / 4.0;
    let kept: Vec<usize> = (0..skull.face_count()).filter(|&face| height(face) > 0.8 * low).collect();
    let corners: Vec<VertexId> = kept.iter().flat_map(|&face| skull.face(face).to_vec()).collect();
    skull.starts = Some((0..=kept.len()).map(|face| u32::try_from(4 * face).expect("a small head")).collect());
    skull.corners = corners;
    let eye = |x: f64| moved(quad_sheet(4, 4, 0.1, &mut Random(5)), DVec3::new(x, 0.0, 9.0));
    obj(&[skull, eye(-3.0), eye(3.0)])
}

/// Boards and legs: 35 closed boxes.
fn furniture() -> String {
    let side = |k: u32, step: u32| 0.2 + f64::from(k * step % 7) / 5.0;
    let board = |k: u32| {
        let [x, y] = [side(k, 3), side(k, 5)];
        let base = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]].map(DVec2::from);
        moved(prism(&base, side(k, 2)), DVec3::new(f64::from(k % 7) * 3.0, f64::from(k / 7) * 3.0, 0.0))
    };
    obj(&(0..35).map(board).collect::<Vec<_>>())
}

/// Opens the only model of a folder and exports it: four clicks. Returns the exported file.
fn four_clicks(model: &str) -> MeshFile {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.obj");
    std::fs::write(&path, model).expect("written");
    let preferences = folder.path().join("window.json");
    // The dialog opens in the folder that was used last.
    let kept = serde_json::json!({ "folders": { "recent": [folder.path()], "pinned": [] } });
    std::fs::write(&preferences, kept.to_string()).expect("written");
    let start = LaunchFile { preferences: Some(preferences), dialogs_inside: true, ..LaunchFile::default() };
    let mut window = Window::start(SIZE, start);
    window.click("Open a model…");
    window.frame_after(0.5, []);
    let row = window.rect(Role::Button, "model.obj").center();
    window.double_click_at(row);
    window.settle();
    assert!(window.is_proved(), "{}", window.verdict());
    window.click("Export the mesh");
    let before = files(folder.path());
    window.click("Save");
    window.settle();
    let written: Vec<_> = files(folder.path()).into_iter().filter(|file| !before.contains(file)).collect();
    let [written] = &written[..] else { panic!("{written:?} {:?}", window.words()) };
    read_mesh(written).expect("a mesh")
}

fn files(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

/// Chart of each triangle, as the smallest vertex that it is connected with.
fn charts(mesh: &TriMesh) -> Vec<usize> {
    let mut chart: Vec<usize> = (0..mesh.positions.len()).collect();
    loop {
        let before = chart.clone();
        for corners in &mesh.triangles {
            let least = corners.iter().map(|v| chart[v.index()]).min().expect("three corners");
            for v in corners {
                chart[v.index()] = least;
            }
        }
        if chart == before {
            return mesh.triangles.iter().map(|corners| chart[corners[0].index()]).collect();
        }
    }
}

/// Greatest mean symmetric Dirichlet energy of a chart, each at equal areas in space and in the plane.
fn worst_energy(mesh: &TriMesh, uv: &Embedding) -> f64 {
    let chart_of = charts(mesh);
    let mut names = chart_of.clone();
    names.sort_unstable();
    names.dedup();
    let energy_of = |chart: usize| {
        let faces = || mesh.triangles.iter().zip(&chart_of).filter(move |&(_, &of)| of == chart).map(|(t, _)| *t);
        let jacobians: Vec<(f64, DMat2)> = faces().map(|corners| jacobian(mesh, uv, corners)).collect();
        let area: f64 = jacobians.iter().map(|(area, _)| area).sum();
        let in_plane: f64 = jacobians.iter().map(|(area, map)| area * map.determinant().abs()).sum();
        let scale = (area / in_plane).sqrt();
        let energy = |map: DMat2| {
            let [map, inverse] = [map * scale, (map * scale).inverse()];
            [map, inverse].iter().map(|m| m.x_axis.length_squared() + m.y_axis.length_squared()).sum::<f64>()
        };
        jacobians.iter().map(|(share, map)| share * energy(*map)).sum::<f64>() / area
    };
    names.into_iter().map(energy_of).fold(0.0, f64::max)
}

/// Area of a face in space, and its map to the plane in an orthonormal frame of the face.
fn jacobian(mesh: &TriMesh, uv: &Embedding, corners: [VertexId; 3]) -> (f64, DMat2) {
    let edges = |at: [DVec3; 3]| [at[1] - at[0], at[2] - at[0]];
    let [along, across] = edges(corners.map(|v| mesh.positions[v.index()]));
    let x = along / along.length();
    let up = along.cross(across).cross(along);
    let y = up / up.length();
    let in_space = DMat2::from_cols(DVec2::new(along.dot(x), 0.0), DVec2::new(across.dot(x), across.dot(y)));
    let [along, across] = edges(corners.map(|v| uv[v].extend(0.0)));
    (in_space.determinant() / 2.0, DMat2::from_cols(along.truncate(), across.truncate()) * in_space.inverse())
}

#[track_caller]
fn serves(model: &str) {
    let file = four_clicks(model);
    let judged = file.judged_layout(LayoutOptions::default(), true, Control::unattended()).expect("has a layout");
    assert!(judged.verdict.planar && judged.verdict.planar_in_f32, "{:?}", judged.verdict.findings);
    let uv = &judged.texture.embedding;
    let inside = |point: &DVec2| point.cmpge(DVec2::ZERO).all() && point.cmple(DVec2::ONE).all();
    assert!(uv.iter().all(inside), "packed into the unit square");
    let worst = worst_energy(&judged.texture.mesh, uv);
    assert!((4.0..SERVES).contains(&worst), "{worst}");
}

#[test]
fn all_exports_that_wait_for_their_charts_are_written_at_last() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.obj");
    std::fs::write(&path, furniture()).expect("written");
    let mut window = Window::with_file(&path);
    let written = ["a.obj", "b.svg"].map(|name| folder.path().join(name));
    for (path, kind) in written.iter().zip([OutputKind::Obj, OutputKind::Svg]) {
        let request = SaveRequest { path: path.clone(), kind, fit: Fit::default() };
        window.editor_mut().session.handle(Action::Save(request));
    }
    window.settle();
    assert!(written.iter().all(|path| path.exists()), "{:?}", window.words());
    // An export that cannot be written any more is told.
    window.open(&path);
    let lost = folder.path().join("lost.obj");
    let request = SaveRequest { path: lost.clone(), kind: OutputKind::Obj, fit: Fit::default() };
    let session = &mut window.editor_mut().session;
    let waits = session.solved_count()[0] < session.solved_count()[1];
    session.handle(Action::Save(request));
    session.handle(Action::Cancel);
    window.settle();
    let is_told = window.words().iter().any(|words| words.contains("lost.obj"));
    assert!(if waits { is_told && !lost.exists() } else { lost.exists() }, "{:?}", window.words());
}

#[test]
fn four_clicks_lead_from_a_closed_model_to_a_layout_that_serves() {
    serves(&obj(&[bumpy_ball()]));
}

#[test]
fn four_clicks_lead_from_a_head_of_quads_with_eyes_to_a_layout_that_serves() {
    serves(&head_with_eyes());
}

#[test]
fn four_clicks_lead_from_furniture_of_35_parts_to_a_layout_that_serves() {
    serves(&furniture());
}

#[test]
fn four_clicks_lead_from_a_scan_with_holes_to_a_layout_that_serves() {
    serves(&obj(&[scan()]));
}

#[test]
fn the_energy_of_the_test_is_4_for_an_unfolded_quad_and_known_for_a_stretched_one() {
    let mesh = TriMesh::new(
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(|[x, y]| DVec3::new(x, y, 0.0)).into(),
        &[[0, 1, 2], [0, 2, 3]],
    );
    let flat = |stretch: DVec2| mesh.positions.iter().map(|p| p.truncate() * stretch).collect::<Embedding>();
    assert!((worst_energy(&mesh, &flat(DVec2::splat(0.3))) - 4.0).abs() < 1e-12);
    // Singular values √2 and 1/√2 at equal areas: 2 + 1/2 + 1/2 + 2.
    assert!((worst_energy(&mesh, &flat(DVec2::new(2.0, 1.0))) - 5.0).abs() < 1e-12);
}
