//! From a mesh to a flattening: `cargo bench --bench flatten`, or `cargo bench --bench flatten -- solve phases`.
//!
//! | word | measurement |
//! |---|---|
//! | `solve` | the conformal natural boundary against a real Laplacian Cholesky and the real 2n×2n system |
//! | `phases` | every phase at growing sizes |
//! | `again` | factoring with a known symbolic analysis, and solving with known factors |
//! | `proof` | verdict and distortion |
//! | `reader` | reading and writing OBJ and PLY |
//! | `end` | the program itself as a child process: time and peak memory |
//! | `methods` | every method on one mesh: time, memory, and outcome |
//!
//! Default: all sections. Meshes are generated (`freebound_testkit`); files go into a temporary folder.

#[path = "../common/mod.rs"]
mod common;
mod end;
mod methods;
mod phases;
mod solve;

use freebound_core::mesh::DiskMesh;

use common::arguments;
use common::machine::print_machine;
use freebound_testkit::sheet_of_faces;

/// Mesh size that an editor must handle with ease.
const COMMON_FACES: usize = 100_000;

/// Mesh size that a program must handle at all.
const LARGE_FACES: usize = 1_000_000;

fn main() {
    type Section = (&'static str, fn());
    let sections: [Section; 7] = [
        ("solve", solve::against_laplacian),
        ("phases", phases::growth),
        ("again", solve::again),
        ("proof", phases::proof),
        ("reader", phases::reader),
        ("end", end::end_to_end),
        ("methods", methods::side_by_side),
    ];
    let wanted = arguments();
    print_machine();
    for (word, run) in sections {
        if wanted.is_empty() || wanted.iter().any(|argument| argument == word) {
            run();
        }
    }
}

fn disk_of_faces(faces: usize) -> DiskMesh {
    DiskMesh::try_from(sheet_of_faces(faces)).expect("a sheet is a disk")
}
