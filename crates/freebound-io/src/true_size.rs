//! Charts at the true size of the surface: a unit of the layout is a unit of the mesh.

use std::io;

use freebound_core::flatten::true_area_factor;
use freebound_core::pipeline::LaidChart;
use freebound_core::problem::Embedding;

/// Relative difference between scales that counts as none.
const SAME_SCALE: f64 = 1e-3;

/// Share of the whole area below which the scale of a chart is not compared: rounding to 32 bits changes it.
const TINY: f64 = 1e-6;

/// Scales embeddings of charts to the area of their surfaces, all by one factor.
///
/// # Errors
///
/// If the scales of the charts differ.
pub(crate) fn scale_to_true_size(charts: &[LaidChart<'_>], embeddings: &mut [Embedding]) -> io::Result<()> {
    let factor = true_factor(charts, embeddings)?;
    for z in embeddings.iter_mut().flat_map(|embedding| embedding.iter_mut()) {
        *z *= factor;
    }
    Ok(())
}

fn true_factor(charts: &[LaidChart<'_>], embeddings: &[Embedding]) -> io::Result<f64> {
    // Extremely large and small meshes have a unit of their own. Ratios of units neither overflow nor underflow.
    let unit = charts.iter().map(|chart| chart.mesh.unit()).fold(0.0, f64::max);
    let area = |chart: &LaidChart<'_>| chart.mesh.area() * (chart.mesh.unit() / unit).powi(2);
    let whole: f64 = charts.iter().map(area).sum();
    let charts = charts.iter().zip(embeddings).filter(|(chart, _)| area(chart) > TINY * whole);
    let factors: Vec<f64> =
        charts.map(|(chart, embedding)| true_area_factor(chart.mesh, embedding) * chart.mesh.unit()).collect();
    let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = factors.iter().copied().fold(0.0, f64::max);
    if most > least * (1.0 + SAME_SCALE) {
        let text =
            format!("the scales of the charts differ by up to a factor of {:.4}: no size fits all", most / least);
        return Err(io::Error::new(io::ErrorKind::InvalidData, text));
    }
    Ok(if most.is_finite() && most > 0.0 { most } else { 1.0 })
}
