//! Every file of `corpus/bad` and its reported faults. Numbers are those of the corpus's manifest if it has any.

use freebound_core::mesh::{Fault, diagnose};
use freebound_io::{MeshFile, ParseFaultKind, ReadError, read_mesh};

use crate::obj::{bad_number, place_and_kind};
use freebound_testkit::{corpus_test, manifest};

/// File that is read, and expected faults with the number of their elements; empty if the file is usable.
const EXPECTED: [(&str, &[(&str, usize)]); 12] = [
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
    ("raw_polygonfaces.obj", &[]),
    // A face of two corners is left out with a warning.
    ("raw_notenoughindices.obj", &[]),
    // The triangle between the two tetrahedra is listed twice, once from either side.
    ("raw_joined_tetrahedra.obj", &[("duplicate-faces", 1), ("non-manifold-edges", 3), ("closed", 1)]),
];

/// Faults of a mesh, each with the number of its elements.
fn faults_of(mesh: &MeshFile) -> Vec<(&'static str, usize)> {
    let diagnosis = diagnose(&mesh.polygons.triangulate());
    let count = |fault: &Fault| match fault {
        Fault::Handles { genus, .. } => *genus,
        _ => fault.elements().count(),
    };
    diagnosis.faults.iter().map(|fault| (fault.name(), count(fault))).collect()
}

/// True if a file that is not read is refused for its reason.
fn is_expected(name: &str, error: &ReadError) -> bool {
    let is_at = |line: &str, kind: ParseFaultKind| place_and_kind(error) == (line.to_owned(), kind);
    match name {
        "raw_empty.obj" => matches!(error, ReadError::NoFaces { vertices: 0 }),
        "raw_corrupted_invalid_double.off" => is_at("line 4", bad_number("X0.425325")),
        _ => false,
    }
}

corpus_test! {
    fn every_bad_file_gets_the_faults_of_the_table_and_no_others() {
        for entry in manifest().iter().filter(|entry| entry.file.starts_with("bad/")) {
            let name = entry.file.trim_start_matches("bad/");
            match read_mesh(&entry.path) {
                Ok(mesh) => {
                    let (_, expected) = EXPECTED.iter().find(|(file, _)| *file == name).expect("the table has it");
                    assert_eq!(faults_of(&mesh), *expected, "{name}");
                }
                Err(error) => assert!(is_expected(name, &error), "{name}: {error}"),
            }
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
