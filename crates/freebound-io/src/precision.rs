//! Precision of the written coordinates, and the verdict on the rounded map.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::Serialize;

use super::{Output, OutputKind, verdict_as_in_file};
use freebound_core::pipeline::{prove_atlas, restack};
use freebound_core::problem::{Labels, NamedOption};
use freebound_core::verify::{Rounded, RoundingGrid, Verdict, rounded, verdict};

/// Number of bits of a texture coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits, which most programs read.
    F32,
}

impl Precision {
    /// Grid of the numbers that a file of this kind holds. `None` for 64 bits.
    pub(crate) fn grid_of(self, kind: OutputKind) -> Option<RoundingGrid> {
        match (kind, self) {
            (OutputKind::Glb, _) => Some(RoundingGrid::TurnedOver),
            (_, Self::F32) => Some(RoundingGrid::Upright),
            (_, Self::F64) => None,
        }
    }
}

impl NamedOption for Precision {
    const ALL: &'static [Self] = &[Self::F64, Self::F32];

    fn labels(&self) -> Labels {
        match self {
            Self::F64 => Labels::new("f64", "64 bits").about("64 bits"),
            Self::F32 => Labels::new("f32", "32 bits").about("32 bits, as most programs read them"),
        }
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
    /// Rounds the coordinates to the numbers that a file of this kind holds, and verifies them again. Files of 32-bit
    /// numbers ignore a request for 64 bits. If rounding folds a face, vertices that no pin holds exactly are moved
    /// by a few units in the last place.
    pub fn round_to(&mut self, precision: Precision, kind: OutputKind) {
        let Some(grid) = precision.grid_of(kind) else {
            self.report.precision = Some(Precision::F64);
            return;
        };
        let was_planar = self.is_planar();
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
        self.report.precision = Some(Precision::F32);
        self.report.rounding = Some(RoundingReport { moved, folded: was_planar && !self.is_planar() });
    }
}
