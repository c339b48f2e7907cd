//! Side of the picture with v = 0.

use std::collections::BTreeMap;

use glam::DVec2;

use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};

/// Last reversal of the targets' v, by chart and vertex: the value before and after. 1 − v rounds and so cannot always
/// be inverted. A second reversal restores the stored value bit for bit.
#[derive(Debug, Default)]
pub(super) struct TurnedV(BTreeMap<(usize, VertexId), [f64; 2]>);

impl TurnedV {
    fn turned(&self, chart: usize, vertex: VertexId, v: f64) -> f64 {
        match self.0.get(&(chart, vertex)) {
            Some([before, after]) if after.to_bits() == v.to_bits() => *before,
            _ => 1.0 - v,
        }
    }

    /// Targets of a chart with reversed v. `into` stores the reversal.
    pub(super) fn targets(&self, chart: usize, targets: &Targets, into: &mut Self) -> Targets {
        let turned = |(&vertex, target): (&VertexId, &Target)| {
            let v = self.turned(chart, vertex, target.uv.y);
            into.0.insert((chart, vertex), [target.uv.y, v]);
            (vertex, Target { uv: DVec2::new(target.uv.x, v), ..*target })
        };
        targets.iter().map(turned).collect()
    }
}
