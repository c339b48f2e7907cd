//! Flattens a mesh with several families of weights, and compares angles and areas.

use freebound_core::mesh::{DiskMesh, TriMesh};
use freebound_core::problem::{Family, Method, Settings};
use freebound_core::verify::distortion;
use freebound_core::{Options, flatten};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A wavy sheet of 20 by 20 squares.
    let height = |x: f64, y: f64| 0.2 * (5.0 * x).sin() * (4.0 * y).cos();
    let grid = (0..441_u32).map(|v| [f64::from(v % 21) / 20.0, f64::from(v / 21) / 20.0]);
    let positions: Vec<[f64; 3]> = grid.map(|[x, y]| [x, y, height(x, y)]).collect();
    let squares = (0..20_u32).flat_map(|y| (0..20_u32).map(move |x| 21 * y + x));
    let triangles: Vec<[u32; 3]> = squares.flat_map(|v| [[v, v + 1, v + 22], [v, v + 22, v + 21]]).collect();
    let mesh = DiskMesh::try_from(TriMesh::from_arrays(&positions, &triangles))?;

    for family in [Family::Conformal, Family::MeanValue, Family::Power(0.5)] {
        let options = Options { settings: Settings::new(Method::Natural, family), ..Options::default() };
        let step = flatten(&mesh, &options)?;
        let summary = distortion(&mesh, &step.candidate.solution.embedding).summary;
        println!("{family}: angle {:.3}, area {:.3}", summary.angle.mean, summary.area.mean);
    }
    Ok(())
}
