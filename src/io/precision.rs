//! The bits of the numbers that are written, and the proof of these numbers.

use std::collections::BTreeSet;

use clap::ValueEnum;
use rayon::prelude::*;
use serde::Serialize;

use super::{Output, OutputKind, proved_together, verdict_as_in_file};
use crate::solver::{Grid, Rounded, Verdict, rounded, verdict};

/// How many bits the numbers of texture coordinates have. Its words are those of the command line's help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 64 bits
    #[default]
    F64,
    /// 32 bits, as most programs read them
    F32,
}

/// What rounding did to coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RoundingReport {
    /// Vertices that are not at the nearest numbers, because these fold a face.
    pub moved: usize,
    /// What was planar before is so no more.
    pub folded: bool,
}

impl Output<'_> {
    /// Rounds the coordinates to what a file of this kind holds, and proves them again. Files that hold 32 bits get no more.
    /// Where rounding folds a face, vertices that are not pinned are moved by a few units of the last place.
    pub fn round_to(&mut self, precision: Precision, kind: OutputKind) {
        let grid = match (kind, precision) {
            (OutputKind::Glb, _) => Grid::TurnedOver,
            (_, Precision::F32) => Grid::Upright,
            (_, Precision::F64) => {
                self.report.precision = Some(Precision::F64);
                return;
            }
        };
        let was_planar = self.is_planar();
        let moved = self.charts.par_iter_mut().map(|chart| {
            let held: BTreeSet<_> = chart.held.iter().copied().collect();
            let Rounded { embedding, moved } = rounded(chart.mesh, &chart.coordinates, grid, &held);
            let of_file = verdict(chart.mesh, &embedding);
            // They are numbers of 32 bits.
            chart.verdict = Verdict { holds_in_f32: of_file.planar, ..of_file };
            chart.coordinates = embedding;
            moved
        });
        let moved = moved.sum();
        if let Some(atlas) = &mut self.report.atlas {
            *atlas = proved_together(&self.charts);
            atlas.holds_in_f32 = atlas.planar;
        } else if let [chart] = &self.charts[..] {
            self.report.verdict = Some(verdict_as_in_file(&chart.verdict, chart.mesh.mesh()));
        }
        self.report.precision = Some(Precision::F32);
        self.report.rounding = Some(RoundingReport { moved, folded: was_planar && !self.is_planar() });
    }
}
