//! Rounding to the precision of a file, and the verdict on the rounded map.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::Serialize;

use super::{Output, OutputKind, Precision, verdict_as_in_file};
use freebound_core::pipeline::{LaidChart, prove_atlas, restack};
use freebound_core::verify::{Rounded, RoundingGrid, Verdict, rounded, verdict};

impl OutputKind {
    /// Precision that is usual for files of this kind: 64 bits for OBJ, 32 bits for PLY and GLB.
    pub fn usual_precision(self) -> Precision {
        if matches!(self, Self::Ply | Self::Glb) { Precision::F32 } else { Precision::F64 }
    }

    /// Grid of the numbers in files of this kind. `None` for 64 bits.
    pub(crate) fn grid(self, precision: Option<Precision>) -> Option<RoundingGrid> {
        match (self, precision.unwrap_or_else(|| self.usual_precision())) {
            (Self::Glb, _) => Some(RoundingGrid::TurnedOver),
            (_, Precision::F32) => Some(RoundingGrid::Upright),
            (_, Precision::F64) => None,
        }
    }

    /// True if coordinates that 32 bits would fold are written in 64 bits.
    pub(crate) fn has_choice(self, precision: Option<Precision>) -> bool {
        precision.is_none() && self.grid(Some(Precision::F64)).is_none()
    }
}

/// Effect of rounding on the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RoundingReport {
    /// Vertices moved away from their nearest 32-bit coordinates, because these would fold a face.
    pub moved: usize,
    /// True if the map was planar before rounding and is not after.
    pub folded: bool,
}

impl Output<'_> {
    /// Rounds the coordinates to the numbers that a file of this kind holds, and verifies them again. Default: the usual
    /// precision of the kind, or 64 bits if these fold the map and the kind has them. GLB files ignore a request for 64
    /// bits. If rounding folds a face, vertices that no pin holds exactly are moved by a few units in the last place.
    pub fn round_to(&mut self, precision: Option<Precision>, kind: OutputKind) {
        let Some(grid) = kind.grid(precision) else {
            self.report.precision = Some(Precision::F64);
            return;
        };
        let was_planar = self.is_planar();
        let has_choice = was_planar && kind.has_choice(precision);
        let exact = |chart: &LaidChart<'_>| (chart.coordinates.clone(), chart.verdict.clone());
        let exact: Option<Vec<_>> = has_choice.then(|| self.charts.iter().map(exact).collect());
        let verdicts = (self.report.atlas.clone(), self.report.verdict.clone());
        let moved = self.round(grid);
        let folded = was_planar && !self.is_planar();
        if let Some(exact) = exact.filter(|_| folded) {
            for (chart, (coordinates, verdict)) in self.charts.iter_mut().zip(exact) {
                chart.coordinates = coordinates;
                chart.verdict = verdict;
            }
            (self.report.atlas, self.report.verdict) = verdicts;
            self.report.precision = Some(Precision::F64);
            return;
        }
        self.report.precision = Some(Precision::F32);
        self.report.rounding = Some(RoundingReport { moved, folded });
    }

    /// Rounds to a grid and verifies again. Returns the number of vertices moved away from the nearest numbers.
    fn round(&mut self, grid: RoundingGrid) -> usize {
        let apart = self.charts.par_iter_mut().filter(|chart| chart.stacked.is_none());
        let moved = apart.map(|chart| {
            let held: BTreeSet<_> = chart.held.iter().copied().collect();
            let Rounded { embedding, moved } = rounded(chart.mesh, &chart.coordinates, grid, &held);
            let of_file = verdict(chart.mesh, &embedding);
            // The coordinates are 32-bit numbers already.
            chart.verdict = Verdict { planar_in_f32: of_file.planar, ..of_file };
            chart.coordinates = embedding;
            moved
        });
        let moved = moved.sum();
        restack(&mut self.charts);
        if let Some(atlas) = &mut self.report.atlas {
            *atlas = prove_atlas(&self.charts);
            atlas.planar_in_f32 = atlas.planar;
        } else if let [chart] = &self.charts[..] {
            self.report.verdict = Some(verdict_as_in_file(&chart.verdict, chart.mesh.mesh()));
        }
        moved
    }
}
