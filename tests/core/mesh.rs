//! The diagnosis and the disk that it lets through.

use freebound::mesh::diagnose;

use crate::common::corpus_disks;

#[test]
fn the_disks_of_the_corpus_are_disks_with_the_counts_of_the_manifest() {
    for entry in corpus_disks() {
        let diagnosis = diagnose(&entry.mesh());
        assert!(diagnosis.is_disk(), "{}: {diagnosis}", entry.file);
        let found = [
            ("V", diagnosis.vertex_count),
            ("F", diagnosis.face_count),
            ("boundary_loops", diagnosis.boundary_loop_count),
            ("boundary_edges", diagnosis.boundary_edge_count),
            ("components", diagnosis.component_count),
            ("chords", diagnosis.dividing_edges.len()),
            ("ears", diagnosis.ears.len()),
        ];
        for (column, count) in found {
            assert_eq!(entry.number(column), i64::try_from(count).ok(), "{} {column}", entry.file);
        }
        assert_eq!((entry.number("chi"), entry.number("genus")), (Some(diagnosis.euler), Some(0)), "{}", entry.file);
    }
}
