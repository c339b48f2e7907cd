//! Charts at the true size of the surface: a unit of the layout is a unit of the mesh.

use std::io;

use glam::DVec2;
use rayon::prelude::*;

use super::Output;
use freebound_core::flatten::true_area_factor;
use freebound_core::pipeline::{LaidChart, Placement, prove_atlas};
use freebound_core::problem::Embedding;
use freebound_core::verify::verdict;

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
    let whole: f64 = charts.iter().map(|chart| chart.mesh.area()).sum();
    let charts = charts.iter().zip(embeddings).filter(|(chart, _)| chart.mesh.area() > TINY * whole);
    let factors: Vec<f64> = charts.map(|(chart, embedding)| true_area_factor(chart.mesh, embedding)).collect();
    let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
    let most = factors.iter().copied().fold(0.0, f64::max);
    if most > least * (1.0 + SAME_SCALE) {
        let text =
            format!("the scales of the charts differ by up to a factor of {:.4}: no size fits all", most / least);
        return Err(io::Error::new(io::ErrorKind::InvalidData, text));
    }
    Ok(if most.is_finite() && most > 0.0 { most } else { 1.0 })
}

impl Output<'_> {
    /// Scales packed charts to the area of the surface, and verifies them again. They keep their arrangement, which
    /// fills more or less than the unit square.
    ///
    /// # Errors
    ///
    /// If the scales of the charts differ.
    pub fn scale_to_true_size(&mut self) -> io::Result<()> {
        let plane = DVec2::new(self.aspect, 1.0);
        let laid = |chart: &LaidChart<'_>| chart.coordinates.iter().map(|uv| uv * plane).collect();
        let mut embeddings: Vec<Embedding> = self.charts.iter().map(laid).collect();
        scale_to_true_size(&self.charts, &mut embeddings)?;
        self.charts.par_iter_mut().zip(embeddings).for_each(|(chart, embedding)| {
            chart.verdict = verdict(chart.mesh, &embedding);
            chart.coordinates = embedding;
        });
        self.aspect = 1.0;
        self.report.packing = None;
        self.report.atlas = Some(prove_atlas(&self.charts));
        for chart in &mut self.report.charts {
            (chart.placement, chart.density, chart.tile) = (Placement::True, 1.0, None);
        }
        Ok(())
    }
}
