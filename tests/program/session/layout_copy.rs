//! Layouts of other meshes, copied to the open mesh as one edit.

use std::path::{Path, PathBuf};

use freebound::session::{Action, SaveRequest, Session};
use freebound_core::geom::{Bounds, VAxis};
use freebound_core::mesh::TriMesh;
use freebound_core::pipeline::Fit;
use freebound_io::{MeshFile, OutputKind, read_mesh, write_atomically, write_obj as write_textured};
use freebound_testkit::many_parts::ball;
use freebound_testkit::{assert_message, shaped, sheet, write_obj};
use glam::{DVec2, DVec3};
use tempfile::TempDir;

use super::basics::{session, settled};
use super::charts::until_laid_out;
use super::documents::{errors, words_of};

/// Folder with meshes and their layouts.
struct Meshes(TempDir);

impl Meshes {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, mesh: &TriMesh) -> PathBuf {
        write_obj(&self.path(name), mesh);
        self.path(name)
    }

    /// Unwraps a mesh and writes it with its layout.
    fn put_unwrapped(&self, name: &str, mesh: &TriMesh) -> PathBuf {
        let mut session = session();
        open(&mut session, self.put("plain.obj", mesh));
        save(&mut session, self.path(name));
        self.path(name)
    }
}

/// Waits for all charts on the page, if there are several.
fn ready(session: &mut Session) {
    if session.charts().is_some() {
        until_laid_out(session);
    }
}

fn open(session: &mut Session, path: PathBuf) {
    settled(session, Action::Open(path));
    ready(session);
    assert!(errors(session).is_empty(), "{:?}", session.messages());
}

fn save(session: &mut Session, path: PathBuf) {
    settled(session, Action::Save(SaveRequest { path, kind: OutputKind::Obj, fit: Fit::Unit }));
    assert!(errors(session).is_empty(), "{:?}", session.messages());
}

/// Texture coordinates at all corners.
fn at_corners(file: &MeshFile) -> Vec<DVec2> {
    let texture = file.texture.as_ref().expect("a layout");
    texture.corners.iter().map(|&corner| texture.coordinates[corner as usize]).collect()
}

fn distance(a: &MeshFile, b: &MeshFile) -> f64 {
    at_corners(a).iter().zip(at_corners(b)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
}

/// A ball that two runs of automatic seams cut into charts.
fn in_charts() -> TriMesh {
    let mut mesh = ball(20, 13);
    let count = u32::try_from(mesh.vertex_count()).expect("few");
    let second = ball(20, 13);
    let moved: Vec<DVec3> = second.positions.iter().map(|p| *p + 4.0 * DVec3::X).collect();
    mesh.positions.extend(moved);
    let turned = |t: &[freebound_core::mesh::VertexId; 3]| {
        t.map(|vertex| freebound_core::mesh::VertexId::new(vertex.number() + count))
    };
    mesh.triangles.extend(second.triangles.iter().map(turned));
    mesh
}

#[test]
fn a_layout_of_several_charts_is_copied_to_its_own_mesh_with_all_places_and_undone() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    let before = session.document().clone();
    settled(&mut session, Action::CopyLayout(with_layout.clone()));
    ready(&mut session);
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
    assert!(session.document().form.seams.automatic().is_empty());
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] = [with_layout, meshes.path("out.obj")].map(|path| read_mesh(&path).expect("a mesh"));
    assert!(distance(&given, &copied) < 1e-12, "{}", distance(&given, &copied));
    settled(&mut session, Action::Undo);
    assert_eq!(*session.document(), before);
}

#[test]
fn a_layout_is_copied_to_a_coarser_mesh_planar_near_its_places_and_saved_in_a_project() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &ball(32, 20));
    let mut session = session();
    open(&mut session, meshes.put("coarse.obj", &ball(18, 11)));
    settled(&mut session, Action::CopyLayout(with_layout));
    ready(&mut session);
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
    assert!(session.outcome().expect("a map").step.verdict.planar);
    save(&mut session, meshes.path("first.obj"));
    let project = meshes.path("copy.freebound");
    settled(&mut session, Action::SaveProject(project.clone()));
    let mut again = super::basics::session();
    open(&mut again, project);
    save(&mut again, meshes.path("second.obj"));
    let [first, second] = ["first.obj", "second.obj"].map(|name| read_mesh(&meshes.path(name)).expect("a mesh"));
    assert_eq!(at_corners(&first), at_corners(&second));
}

#[test]
fn the_layout_of_a_single_chart_is_held_by_two_pins() {
    let meshes = Meshes::new();
    let mut first = session();
    open(&mut first, meshes.put("sheet.obj", &sheet(6, 0.3)));
    save(&mut first, meshes.path("uv.obj"));
    let mut session = session();
    open(&mut session, meshes.put("again.obj", &sheet(6, 0.3)));
    settled(&mut session, Action::CopyLayout(meshes.path("uv.obj")));
    assert_eq!(session.document().targets.len(), 2);
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] = ["uv.obj", "out.obj"].map(|name| read_mesh(&meshes.path(name)).expect("a mesh"));
    assert!(distance(&given, &copied) < 1e-12, "{}", distance(&given, &copied));
}

/// Writes a file again with other texture coordinates.
fn relaid(from: &Path, to: &Path, place: impl Fn(DVec2) -> DVec2) {
    let mut file = read_mesh(from).expect("a mesh");
    let texture = file.texture.as_mut().expect("a layout");
    texture.coordinates.iter_mut().for_each(|uv| *uv = place(*uv));
    let texture = texture.clone();
    write_atomically(to, |out| write_textured(out, &file, &texture)).expect("it can be written");
}

#[test]
fn mirrored_charts_are_turned_over_at_their_places() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mirrored = meshes.path("mirrored.obj");
    relaid(&with_layout, &mirrored, |uv| DVec2::new(1.0 - uv.x, uv.y));
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    settled(&mut session, Action::CopyLayout(mirrored.clone()));
    ready(&mut session);
    let message = session.messages().last().expect("a message");
    assert_message("copy-mirrored-layout", &words_of(message));
    save(&mut session, meshes.path("out.obj"));
    let boxes = |path: &Path| {
        let (charts, bounds) = charts_of(&read_mesh(path).expect("a mesh"));
        (charts, bounds.into_iter().flat_map(|of| [of.low, of.high]).collect::<Vec<DVec2>>())
    };
    let [(count, given), (copied_count, copied)] = [&mirrored, &meshes.path("out.obj")].map(|path| boxes(path));
    assert!(count > 1 && count == copied_count, "{count} {copied_count}");
    let apart = given.iter().zip(&copied).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-12, "{apart:e}");
}

/// Number of charts in a file, and their boxes.
fn charts_of(file: &MeshFile) -> (usize, Vec<Bounds>) {
    let of_faces = file.layout_charts().expect("a complete layout");
    let count = of_faces.iter().flatten().max().map_or(0, |last| last + 1);
    let mut bounds = vec![Bounds::EMPTY; count];
    let corners = at_corners(file);
    for (face, chart) in of_faces.iter().enumerate() {
        let of_face = Bounds::of(file.polygons.corner_range(face).map(|corner| corners[corner]));
        let chart = chart.expect("every face has a chart");
        bounds[chart] = bounds[chart].union(of_face);
    }
    (count, bounds)
}

#[test]
fn a_mesh_with_turned_faces_gets_the_layout_as_seen_from_its_other_side() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    settled(&mut session, Action::TurnFaces);
    ready(&mut session);
    settled(&mut session, Action::CopyLayout(with_layout.clone()));
    ready(&mut session);
    let message = session.messages().last().expect("a message");
    assert_message("copy-layout-of-equal-faces", &words_of(message));
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] =
        [with_layout, meshes.path("out.obj")].map(|path| charts_of(&read_mesh(&path).expect("a mesh")));
    assert_eq!(given.0, copied.0);
    let whole = |bounds: &[Bounds]| bounds.iter().copied().reduce(Bounds::union).expect("a chart");
    let [low, high] = [whole(&given.1).low.x, whole(&given.1).high.x];
    for (of, to) in given.1.iter().zip(&copied.1) {
        assert!((low + high - of.low.x - to.high.x).abs() < 1e-12 && (of.low.y - to.low.y).abs() < 1e-12);
    }
}

#[test]
fn a_layout_of_a_mesh_of_another_size_and_place_is_moved_to_the_open_mesh() {
    let meshes = Meshes::new();
    let mut large = ball(32, 20);
    large.positions.iter_mut().for_each(|p| *p = 16.0 * *p + DVec3::new(32.0, -4.0, 2.0));
    let with_layout = meshes.put_unwrapped("uv.obj", &large);
    let mut session = session();
    open(&mut session, meshes.put("small.obj", &ball(18, 11)));
    settled(&mut session, Action::CopyLayout(with_layout));
    ready(&mut session);
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
    assert!(session.outcome().expect("a map").step.verdict.planar);
    let message = session.messages().last().expect("a message");
    let words = words_of(message);
    let percent = words.split_whitespace().find(|word| word.parse::<f64>().is_ok()).expect("a distance").to_owned();
    assert_message("copy-moved-layout", &words.replace(&percent, "0.50"));
}

#[test]
fn a_locked_chart_takes_the_place_that_the_layout_gives_it() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    settled(&mut session, Action::LockCharts { charts: [0].into(), lock: true });
    assert!(!session.document().layout.locked.is_empty());
    settled(&mut session, Action::CopyLayout(with_layout.clone()));
    ready(&mut session);
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] = [with_layout, meshes.path("out.obj")].map(|path| read_mesh(&path).expect("a mesh"));
    assert!(distance(&given, &copied) < 1e-12, "{}", distance(&given, &copied));
}

#[test]
fn a_layout_is_copied_alike_with_v_down() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    settled(&mut session, Action::SetVAxis(VAxis::Down));
    settled(&mut session, Action::CopyLayout(with_layout.clone()));
    ready(&mut session);
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] = [with_layout, meshes.path("out.obj")].map(|path| read_mesh(&path).expect("a mesh"));
    assert!(distance(&given, &copied) < 1e-12, "{}", distance(&given, &copied));
}

#[test]
fn a_copy_that_is_cancelled_changes_nothing() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    let before = session.document().clone();
    session.handle(Action::CopyLayout(with_layout));
    settled(&mut session, Action::Cancel);
    assert_eq!(*session.document(), before);
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
}

#[test]
fn charts_that_would_fold_are_flattened_anew_along_the_seams_of_the_layout() {
    let meshes = Meshes::new();
    // The layout turns half of its faces over.
    let with_layout = meshes.put_unwrapped("uv.obj", &in_charts());
    let folded = meshes.path("folded.obj");
    relaid(&with_layout, &folded, |uv| DVec2::new((uv.x - 0.5).abs(), uv.y));
    let mut session = session();
    open(&mut session, meshes.put("mesh.obj", &in_charts()));
    settled(&mut session, Action::CopyLayout(folded));
    ready(&mut session);
    assert!(errors(&session).is_empty(), "{:?}", session.messages());
    save(&mut session, meshes.path("out.obj"));
    let [given, copied] = [with_layout, meshes.path("out.obj")].map(|path| read_mesh(&path).expect("a mesh"));
    assert_eq!(given.layout_charts().expect("charts"), copied.layout_charts().expect("charts"));
}

#[test]
fn the_layout_of_another_surface_is_refused() {
    let meshes = Meshes::new();
    let with_layout = meshes.put_unwrapped("uv.obj", &ball(12, 8));
    let mut session = session();
    // Thin and long, so that no box makes it like a ball.
    let tube = shaped(40, 6, |x, y| {
        let angle = std::f64::consts::TAU * x / 40.0;
        DVec3::new(0.01 * angle.cos(), 0.01 * angle.sin(), 30.0 * y)
    });
    open(&mut session, meshes.put("tube.obj", &tube));
    let before = session.document().clone();
    settled(&mut session, Action::CopyLayout(with_layout.clone()));
    let message = session.messages().last().expect("a message");
    assert_message(
        "copy-layout-of-another-surface",
        &words_of(message).replace(&with_layout.display().to_string(), "uv.obj"),
    );
    assert_eq!(*session.document(), before);
}

#[test]
fn a_file_without_a_layout_is_refused_and_nothing_changes() {
    let meshes = Meshes::new();
    let mut session = session();
    open(&mut session, meshes.put("sheet.obj", &sheet(4, 0.1)));
    let before = session.document().clone();
    let plain = meshes.put("plain.obj", &sheet(5, 0.1));
    settled(&mut session, Action::CopyLayout(plain.clone()));
    let message = session.messages().last().expect("a message");
    assert_message("copy-layout-of-none", &words_of(message).replace(&plain.display().to_string(), "plain.obj"));
    assert_eq!(*session.document(), before);
    settled(&mut session, Action::CopyLayout(meshes.path("nowhere.obj")));
    assert!(!errors(&session).is_empty());
    assert_eq!(*session.document(), before);
}
