//! Meets hard constraints that the mesh cannot meet as it is: edges are split, and the new vertices are named.

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::{Options, flatten};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two fans side by side; the pins exchange the two inner vertices.
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 0.3],
        [1.5, 0.5, 0.3],
    ];
    let triangles = [[0, 1, 6], [1, 4, 6], [4, 5, 6], [5, 0, 6], [1, 2, 7], [2, 3, 7], [3, 4, 7], [4, 1, 7]];
    let mesh = DiskMesh::try_from(TriMesh::from_arrays(&positions, &triangles))?;
    let corners = [(0, [0.0, 0.0]), (2, [2.0, 0.0]), (3, [2.0, 1.0]), (5, [0.0, 1.0])];
    let exchanged = [(6, [1.5, 0.5]), (7, [0.5, 0.5])];
    let pins = corners.into_iter().chain(exchanged);
    let options = pins.fold(Options::default(), |options, (vertex, target)| options.pinned(vertex, target));

    let step = flatten(&mesh, &options)?;
    let refined = step.candidate.mesh(&mesh);
    println!("{}; {} new vertices", step.verdict.summary(), refined.vertex_count() - mesh.vertex_count());
    for vertex in [6_usize, 7] {
        println!("{vertex}: {}", step.candidate.solution.embedding.to_vec()[vertex]);
    }
    Ok(())
}
