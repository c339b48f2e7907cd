//! Mesh over a file's texture coordinates.

use freebound_core::mesh::VertexId;
use freebound_io::{NO_TEXTURE, TextureError};
use glam::{DVec2, DVec3};

use crate::obj::ELEMENTS;
use freebound_testkit::files::read;

#[test]
fn texture_vertices_are_cut_at_seams_and_joined_elsewhere() {
    // A square whose diagonal is a seam at vertex 3 only; vertex 1 has one coordinate listed twice, once as −0.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt -0 0\nvt 5 5\nvt 0 1\n\
        f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n";
    let texture = read(text).texture_mesh().expect("it is complete");
    assert_eq!(texture.vertex_of, [0, 1, 2, 2, 3].map(VertexId::new));
    let expected = [[0., 0.], [1., 0.], [1., 1.], [5., 5.], [0., 1.]].map(DVec2::from);
    assert_eq!(*texture.embedding, expected);
    assert_eq!(texture.mesh.triangles, [[0, 1, 2], [0, 3, 4]].map(|t| t.map(VertexId::new)));
    assert_eq!(texture.mesh.positions[3], DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn copies_of_coordinates_per_corner_make_no_seams() {
    // Many programs write a `vt` line for every corner, in any order.
    let mut text = ELEMENTS.replace("vt 0 0\nvt 1 0\nvt 1 1\n", "");
    text.push_str("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 0\nvt 1 1\nvt 0 1\n");
    let mesh = read(&format!("{text}f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n"));
    let texture = mesh.texture_mesh().expect("it is complete");
    assert_eq!(texture.mesh, mesh.polygons.triangulate());
    assert_eq!(*texture.embedding, [[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(DVec2::from));
}

#[test]
fn polygons_of_a_texture_mesh_are_cut_as_those_of_the_surface() {
    let mesh = read(&format!("{ELEMENTS}vt 0 1\nf 1/1 2/2 3/3 4/4\n"));
    assert_eq!(mesh.texture_mesh().expect("it is complete").mesh, mesh.polygons.triangulate());
}

#[test]
fn faces_without_texture_coordinates_are_named() {
    let partial = read(&format!("{ELEMENTS}f 1 2 3\nf 1/1 2/2 3/3\nf 1/1 3 4/2\n"));
    assert_eq!(
        partial.texture.as_ref().expect("one face has them").corners[..4],
        [NO_TEXTURE, NO_TEXTURE, NO_TEXTURE, 0]
    );
    assert_eq!(partial.texture_mesh(), Err(TextureError::Missing(vec![0, 2])));
    assert_eq!(read(&format!("{ELEMENTS}f 1 2 3\n")).texture_mesh(), Err(TextureError::None));
}
