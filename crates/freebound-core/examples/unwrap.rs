//! Unwraps a closed mesh given as two arrays, and prints the verdict and the texture coordinates of each face's corners.

use freebound_core::mesh::PolygonMesh;
use freebound_core::{PipelineOptions, unwrap};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A cube of six squares: the bits of a vertex's number are its coordinates.
    let positions = [0_u32, 1, 2, 3, 4, 5, 6, 7].map(|v| [v & 1, v >> 1 & 1, v >> 2].map(f64::from));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let unwrapped = unwrap(&PolygonMesh::from_arrays(&positions, &faces), &PipelineOptions::for_any_mesh())?;
    println!("{}", unwrapped.verdict.summary());
    for (face, corners) in unwrapped.corners.chunks(4).enumerate() {
        let of_corner = |&corner: &u32| unwrapped.coordinates.get(corner as usize).map(|uv| [uv.x, uv.y]);
        println!("face {face}: {:?}", corners.iter().map(of_corner).collect::<Vec<_>>());
    }
    Ok(())
}
