//! Flattens a mesh given as two arrays, with two pins, and prints the verdict and the coordinates.

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::{Options, flatten};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.7]];
    let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let mesh = DiskMesh::try_from(TriMesh::from_arrays(&positions, &triangles))?;
    let step = flatten(&mesh, &Options::default().pinned(0, [0.0, 0.0]).pinned(2, [1.0, 1.0]))?;
    println!("{}", step.verdict.summary());
    for (vertex, z) in step.candidate.solution.embedding.iter().enumerate() {
        println!("{vertex}: {} {}", z.x, z.y);
    }
    Ok(())
}
