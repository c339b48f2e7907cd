//! Parses any text as an edges file of a sheet of quads.
#![no_main]

use freebound_io::{parse_edges, write_edges};
use freebound_core::mesh::{PolygonMesh, VertexId};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let corners = (0..90).filter(|v| v % 10 < 9).flat_map(|v| [v, v + 1, v + 11, v + 10]);
    let mesh = PolygonMesh {
        positions: vec![Default::default(); 100],
        corners: corners.map(VertexId::new).collect(),
        starts: Some((0..=81).map(|face| 4 * face).collect()),
    };
    if let Ok(edges) = parse_edges(text, &mesh) {
        assert!(edges.iter().all(|[a, b]| matches!(a.number().abs_diff(b.number()), 1 | 10)));
        let mut written = Vec::new();
        write_edges(&mut written, edges.iter().copied()).expect("memory takes all");
        assert_eq!(parse_edges(std::str::from_utf8(&written).expect("text"), &mesh), Ok(edges));
    }
});
