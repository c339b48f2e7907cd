//! Proves a layout, whoever made it, and names what is wrong with another.

use freebound_core::mesh::TriMesh;
use freebound_core::problem::Embedding;
use freebound_core::verify;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.7]];
    let mesh = TriMesh::from_arrays(&positions, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for apex in [[0.5, 0.5], [1.5, 0.5]] {
        let uv: Embedding = corners.into_iter().chain([apex]).map(Into::into).collect();
        let verdict = verify(&mesh, &uv)?;
        println!("apex at {apex:?}: {}", verdict.summary());
    }
    Ok(())
}
