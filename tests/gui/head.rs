//! A closed head from opening to export: the required user actions.

use std::fs::File;

use freebound_core::mesh::DiskMesh;
use freebound_core::verify::verdict;
use freebound_io::{MeshFile, Texture, read_mesh, write_obj};

use crate::harness::Window;
use freebound_testkit::head;

#[test]
fn a_closed_head_of_ten_thousand_quads_takes_three_clicks() {
    let folder = tempfile::tempdir().expect("a folder for files");
    let path = folder.path().join("head.obj");
    let mesh = MeshFile { polygons: head(41), ..MeshFile::default() };
    write_obj(&mut File::create(&path).expect("created"), &mesh, &Texture::default()).expect("written");
    let mut window = Window::with_file(&path);
    for name in ["Repair all", "Export the mesh", "Save"] {
        window.click(name);
    }
    assert!(window.is_proved(), "{}", window.verdict());
    let written = read_mesh(&folder.path().join("head-flat.obj")).expect("a mesh");
    assert_eq!(written.polygons, mesh.polygons, "its quads are whole");
    let texture = written.texture_mesh().expect("every corner has a place");
    let disk = DiskMesh::try_from(texture.mesh.clone()).expect("one chart");
    let proof = verdict(&disk, &texture.embedding);
    assert!(proof.planar && proof.planar_in_f32, "{}", proof.summary());
    let is_of_face = |at: glam::DVec3| at.z > 0.45 && at.x.abs() < 0.5 && at.y.abs() < 0.6;
    let across = disk.boundary_loop().iter().filter(|&&vertex| is_of_face(disk.position(vertex))).count();
    assert_eq!(across, 0, "of {} vertices of the cut", disk.boundary_loop().len());
}
