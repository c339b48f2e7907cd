//! A closed head from opening to export: the required user actions.

use std::fs::File;

use freebound::session::Action;
use freebound_core::mesh::{DiskMesh, PolygonMesh, Seams, VertexId};
use freebound_core::verify::verdict;
use freebound_io::{MeshFile, Texture, read_mesh, write_obj};

use crate::harness::Window;
use freebound_testkit::head;

/// Sides of all faces.
fn edges_of(mesh: &PolygonMesh) -> impl Iterator<Item = [VertexId; 2]> {
    let side = |corners: &[VertexId], k: usize| [corners[k], corners[(k + 1) % corners.len()]];
    (0..mesh.face_count()).flat_map(move |face| {
        let corners = mesh.face(face);
        (0..corners.len()).map(move |k| side(corners, k))
    })
}

#[test]
fn a_closed_head_of_ten_thousand_quads_is_exported_by_two_clicks_and_a_painted_face_has_no_seam() {
    let folder = tempfile::tempdir().expect("a folder for files");
    let path = folder.path().join("head.obj");
    let mesh = MeshFile { polygons: head(41), ..MeshFile::default() };
    write_obj(&mut File::create(&path).expect("created"), &mesh, &Texture::default()).expect("written");
    let mut window = Window::with_file(&path);
    let is_of_face = |at: glam::DVec3| at.z > 0.45 && at.x.abs() < 0.5 && at.y.abs() < 0.6;
    let is_painted = |edge: &[VertexId; 2]| edge.iter().any(|end| is_of_face(mesh.polygons.positions[end.index()]));
    let edges: Vec<[VertexId; 2]> = edges_of(&mesh.polygons).filter(is_painted).collect();
    window.editor_mut().session.handle(Action::PaintSeams { edges, cost: Seams::AVOIDED });
    window.settle();
    for name in ["Export the mesh", "Save"] {
        window.click(name);
    }
    assert!(window.is_proved(), "{}", window.verdict());
    let written = read_mesh(&folder.path().join("head-flat.obj")).expect("a mesh");
    assert_eq!(written.polygons, mesh.polygons, "its quads are whole");
    let texture = written.texture_mesh().expect("every corner has a place");
    let disk = DiskMesh::try_from(texture.mesh.clone()).expect("one chart");
    let proof = verdict(&disk, &texture.embedding);
    assert!(proof.planar && proof.planar_in_f32, "{}", proof.summary());
    let across = disk.boundary_loop().iter().filter(|&&vertex| is_of_face(disk.position(vertex))).count();
    assert_eq!(across, 0, "of {} vertices of the cut", disk.boundary_loop().len());
}
