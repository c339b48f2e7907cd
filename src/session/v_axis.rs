//! Where v = 0 is on the picture.

use std::collections::BTreeMap;

use glam::DVec2;

use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};

/// How the targets' v were turned around last, by chart and vertex, each as it was before and after. 1 − v rounds, and so does not always come
/// back: turned around again, a number that is known from before is that number to the last bit.
#[derive(Debug, Default)]
pub(super) struct TurnedV(BTreeMap<(usize, VertexId), [f64; 2]>);

impl TurnedV {
    fn turned(&self, chart: usize, vertex: VertexId, v: f64) -> f64 {
        match self.0.get(&(chart, vertex)) {
            Some([before, after]) if after.to_bits() == v.to_bits() => *before,
            _ => 1.0 - v,
        }
    }

    /// The targets of a chart turned around, which `into` remembers.
    pub(super) fn targets(&self, chart: usize, targets: &Targets, into: &mut Self) -> Targets {
        let turned = |(&vertex, target): (&VertexId, &Target)| {
            let v = self.turned(chart, vertex, target.uv.y);
            into.0.insert((chart, vertex), [target.uv.y, v]);
            (vertex, Target { uv: DVec2::new(target.uv.x, v), ..*target })
        };
        targets.iter().map(turned).collect()
    }
}
