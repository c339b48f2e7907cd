//! Layouts of other meshes, copied to the open mesh as one edit.

use std::path::PathBuf;

use freebound::session::{Action, SaveRequest, Session};
use freebound_core::mesh::TriMesh;
use freebound_core::pipeline::Fit;
use freebound_io::{MeshFile, OutputKind, read_mesh};
use freebound_testkit::many_parts::ball;
use freebound_testkit::{assert_message, sheet, write_obj};
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
