//! Every file of `corpus/bad` and its reported faults. Numbers are those of the corpus's manifest if it has any.

use freebound_core::mesh::{Fault, diagnose};
use freebound_io::{ReadError, read_mesh};

use freebound_testkit::{corpus_test, manifest};

/// File, and expected faults with the number of their elements; empty if the file is usable.
const EXPECTED: [(&str, &[(&str, usize)]); 14] = [
    ("closed_fish.obj", &[("closed", 1)]),
    ("nonmanifold_ArtDemo.obj", &[("non-manifold-edges", 99), ("several-boundary-loops", 10)]),
    // Two of the six components are closed, two have one loop and two have two.
    ("multicomp.obj", &[("several-components", 6), ("closed", 2), ("several-boundary-loops", 4), ("handles", 3)]),
    ("holes_plane.obj", &[("several-boundary-loops", 27)]),
    ("degenerate_capsule.obj", &[("zero-area", 200)]),
    ("moebius.obj", &[("non-orientable", 4)]),
    ("torus_one_hole.obj", &[("handles", 1)]),
    // The colours are NaN; the positions are not.
    ("raw_nancolor.obj", &[("closed", 1)]),
    ("raw_negative_indices.obj", &[("closed", 1)]),
    ("raw_empty.obj", &[("the file has no faces", 0)]),
    ("raw_notenoughindices.obj", &[("line 9: a face has 2 corners, but three are needed", 1)]),
    ("raw_polygonfaces.obj", &[]),
    // The triangle between the two tetrahedra is listed twice, once from either side.
    ("raw_joined_tetrahedra.obj", &[("duplicate-faces", 1), ("non-manifold-edges", 3), ("closed", 1)]),
    ("raw_corrupted_invalid_double.off", &[("line 4: \"X0.425325\" is not a number", 1)]),
];

/// Faults of a file, each with the number of its elements.
fn faults_of(path: &std::path::Path) -> Vec<(String, usize)> {
    match read_mesh(path) {
        Ok(mesh) => {
            let diagnosis = diagnose(&mesh.polygons.triangulate());
            let count = |fault: &Fault| match fault {
                Fault::Handles { genus, .. } => *genus,
                _ => fault.elements().count(),
            };
            diagnosis.faults.iter().map(|fault| (fault.name().to_owned(), count(fault))).collect()
        }
        Err(ReadError::Parse { faults, .. }) => faults.iter().map(|fault| (fault.to_string(), faults.len())).collect(),
        Err(error) => vec![(error.to_string(), 0)],
    }
}

corpus_test! {
    fn every_bad_file_gets_the_faults_of_the_table_and_no_others() {
        for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
            let name = entry.file.trim_start_matches("bad/");
            let (_, expected) = EXPECTED.iter().find(|(file, _)| *file == name).expect("the table has every bad file");
            let expected: Vec<(String, usize)> = expected.iter().map(|&(fault, n)| (fault.to_owned(), n)).collect();
            assert_eq!(faults_of(&entry.path), expected, "{name}");
        }
    }
}

corpus_test! {
    fn the_counts_of_bad_meshes_are_those_of_the_manifest() {
        for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
            let Ok(mesh) = read_mesh(&entry.path) else { continue };
            let diagnosis = diagnose(&mesh.polygons.triangulate());
            let number = |count: usize| i64::try_from(count).ok();
            let count_of = |name: &str| {
                let fault = diagnosis.faults.iter().find(|fault| fault.name() == name);
                number(fault.map_or(0, |fault| fault.elements().count()))
            };
            // The manifest counts the duplicate face of the tetrahedra, which the diagnosis sets aside.
            let set_aside = count_of("duplicate-faces").unwrap_or(0);
            let found = [
                ("V", number(diagnosis.vertex_count)),
                ("F", number(diagnosis.face_count)),
                ("chi", Some(diagnosis.euler + set_aside)),
                ("boundary_edges", number(diagnosis.boundary_edge_count)),
                ("boundary_loops", number(diagnosis.boundary_loop_count)),
                ("components", number(diagnosis.component_count)),
                ("genus", diagnosis.genus.and_then(number)),
                ("nonmanifold_edges", count_of("non-manifold-edges")),
                ("nonmanifold_vertices", count_of("non-manifold-vertices")),
                ("inconsistent_edges", count_of("non-orientable")),
                ("zero_area_faces", count_of("zero-area")),
                ("unreferenced_vertices", count_of("unreferenced-vertices")),
            ];
            for (column, count) in found {
                assert_eq!(entry.number(column), count, "{} {column}", entry.file);
            }
        }
    }
}
