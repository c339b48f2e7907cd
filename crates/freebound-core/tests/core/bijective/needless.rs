//! Unneeded new vertices are removed again; needed ones stay.

use freebound_core::bijective::{Matched, matched, simplified};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Pin, Pins, SolveError};
use freebound_core::verify::verdict;
use glam::DVec2;

/// Flat square of 2·n² triangles, and the positions of its vertices.
fn square(n: u32) -> (DiskMesh, Embedding) {
    let stride = n + 1;
    let flat: Embedding =
        (0..stride * stride).map(|v| DVec2::new(f64::from(v % stride), f64::from(v / stride))).collect();
    let cell = |v: u32| [[v, v + 1, v + stride + 1], [v, v + stride + 1, v + stride]];
    let triangles: Vec<[u32; 3]> = (0..n * n).flat_map(|k| cell(k / n * stride + k % n)).collect();
    let positions = flat.iter().map(|z| z.extend(0.0)).collect();
    (DiskMesh::of_topology(TriMesh::new(positions, &triangles)).unwrap(), flat)
}

fn pins(pairs: &[(u32, DVec2)]) -> Pins {
    pairs.iter().map(|&(v, target)| (VertexId::new(v), Pin::hard(target))).collect()
}

#[test]
fn new_vertices_are_all_needless_where_the_map_is_flat() {
    let (mesh, flat) = square(6);
    // Pins of two corners and of two inner vertices swap places.
    let pins = pins(&[(0, flat[48]), (48, flat[0]), (16, flat[32]), (32, flat[16])]);
    let matched = matched(&mesh, &flat, &pins, Control::unattended()).unwrap();
    assert!(matched.refinement.new_vertices().len() > 10);
    // If all vertices keep their positions on the flat surface, no new vertex is needed.
    let positions = &matched.refinement.disk().mesh().positions;
    let embedding: Embedding = positions.iter().map(|x| x.truncate()).collect();
    let bare = simplified(&mesh, Matched { embedding, ..matched }, Control::unattended()).unwrap();
    assert_eq!(bare.refinement.new_vertices(), []);
    assert_eq!(bare.refinement.disk().face_count(), mesh.face_count());
    assert_eq!(bare.embedding, flat);
}

#[test]
fn new_vertices_that_are_needed_stay() {
    let (mesh, flat) = square(4);
    let pins = pins(&[(6, flat[18]), (18, flat[6]), (0, flat[0]), (24, flat[24])]);
    let matched = matched(&mesh, &flat, &pins, Control::unattended()).unwrap();
    let before = matched.refinement.new_vertices().len();
    let bare = simplified(&mesh, matched, Control::unattended()).unwrap();
    let after = bare.refinement.new_vertices().len();
    assert!(0 < after && after < before, "{before} {after}");
    assert!(verdict(bare.refinement.disk(), &bare.embedding).planar);
}

#[test]
fn targets_that_coincide_are_refused() {
    let (mesh, flat) = square(2);
    let pins = pins(&[(0, flat[4]), (4, flat[4])]);
    assert_eq!(matched(&mesh, &flat, &pins, Control::unattended()).unwrap_err(), SolveError::TooFine);
}
