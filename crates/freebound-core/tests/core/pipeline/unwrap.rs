//! Unwrapping in one call.

use freebound_core::geom::{PackingOptions, PictureFrame};
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::pipeline::Target;
use freebound_core::{PipelineOptions, UnwrapError, unwrap};
use glam::DVec2;

/// A square pyramid without its base, as a mesh of polygons.
fn pyramid() -> PolygonMesh {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.7]];
    PolygonMesh::from_arrays(&positions, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
}

#[test]
fn a_disk_is_unwrapped_as_one_chart_with_a_summary() {
    let unwrapped = unwrap(&pyramid(), &PipelineOptions::for_any_mesh()).expect("planar");
    assert_eq!(unwrapped.charts.len(), 1);
    assert_eq!(unwrapped.charts[0].faces, 4);
    assert!(unwrapped.charts[0].density > 0.0 && unwrapped.charts[0].pins.unmet.is_empty());
}

#[test]
fn pins_of_a_disk_that_no_map_without_new_vertices_meets_are_an_error() {
    // The apex lies on the wrong side of an edge whose both ends are pinned.
    let targets = [(0, [0.0, 0.0]), (1, [1.0, 0.0]), (4, [0.5, -0.5])];
    let target = |(vertex, uv): (u32, [f64; 2])| (VertexId::new(vertex), Target::hard(DVec2::from(uv)));
    let options = PipelineOptions {
        targets: targets.into_iter().map(target).collect(),
        frame: PictureFrame::default(),
        // Without a cut the pins stay on one side of the edge.
        distortion: None,
        ..PipelineOptions::for_any_mesh()
    };
    match unwrap(&pyramid(), &options) {
        Err(UnwrapError::NotPlanar(unwrapped)) => {
            assert!(unwrapped.verdict.planar && !unwrapped.charts[0].pins.unmet.is_empty(), "{unwrapped:?}");
        }
        other => panic!("three pins that turn a face over: {other:?}"),
    }
}

#[test]
fn a_disk_is_packed_at_a_density() {
    let packing = PackingOptions { density: Some(700.0), ..PackingOptions::default() };
    let options = PipelineOptions { packing, ..PipelineOptions::for_any_mesh() };
    let unwrapped = unwrap(&pyramid(), &options).expect("planar");
    let chart = &unwrapped.charts[0];
    assert!((chart.density / 700.0 - 1.0).abs() < 1e-9 && chart.tile == Some(1001), "{chart:?}");
    let largest = unwrapped.coordinates.iter().fold(0.0, |most: f64, uv| most.max(uv.max_element()));
    assert!(largest < 1.0, "{largest}");
}
