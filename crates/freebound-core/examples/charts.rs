//! Unwraps two closed boxes at once: six charts each, packed into one picture and proved together.

use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{PolygonMesh, Preparation, Repairs, Seams, creases};
use freebound_core::{PipelineOptions, unwrap};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const SIDES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let at = |v: u32, shift: f64| [f64::from(v & 1) + shift, f64::from(v >> 1 & 1), f64::from(v >> 2)];
    let positions: Vec<[f64; 3]> = (0..16).map(|v| at(v % 8, if v < 8 { 0.0 } else { 3.0 })).collect();
    let faces: Vec<[u32; 4]> = [0, 8].into_iter().flat_map(|first| SIDES.map(|side| side.map(|v| first + v))).collect();
    let mesh = PolygonMesh::from_arrays(&positions, &faces);

    // Cut along all edges whose faces meet at 60 degrees or more.
    let any = PipelineOptions::for_any_mesh();
    let seams = Seams::default().with(creases(&mesh, Repairs::ALL, 60.0));
    let options = PipelineOptions {
        preparation: Preparation { seams, ..any.preparation },
        packing: PackingOptions { picture: [512, 512], gap: 8, ..PackingOptions::default() },
        ..any
    };
    let unwrapped = unwrap(&mesh, &options)?;
    println!("{}", unwrapped.verdict.summary());
    for chart in &unwrapped.charts {
        println!("chart of face {}: {:.1} pixels per unit", chart.first_face, chart.density);
    }
    Ok(())
}
