//! Where v = 0 is on the picture.

use std::collections::BTreeMap;

use glam::DVec2;

use super::{ChartEdits, Command, Session};
use crate::geom::VAxis;
use crate::io::{Target, Targets};
use crate::mesh::VertexId;

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
    fn targets(&self, chart: usize, targets: &Targets, into: &mut Self) -> Targets {
        let turned = |(&vertex, target): (&VertexId, &Target)| {
            let v = self.turned(chart, vertex, target.uv.y);
            into.0.insert((chart, vertex), [target.uv.y, v]);
            (vertex, Target { uv: DVec2::new(target.uv.x, v), ..*target })
        };
        targets.iter().map(turned).collect()
    }
}

impl Session {
    /// Chooses where v = 0 is. The targets keep their places on the picture; chosen back, they are as they were.
    pub(super) fn set_v_axis(&mut self, v_axis: VAxis) {
        if v_axis == self.document.v_axis {
            return;
        }
        let mut into = TurnedV::default();
        let shown = self.charts().map_or(0, |charts| charts.pick(self.document.chart));
        let here = self.turned_v.targets(shown, &self.document.targets, &mut into);
        let mut commands = vec![Command::SetVAxis(v_axis)];
        commands.extend(here.into_iter().map(|(vertex, target)| Command::SetPin { vertex, target: Some(target) }));
        for (&chart, edits) in &self.document.elsewhere {
            let targets = self.turned_v.targets(chart, &edits.targets, &mut into);
            commands.push(Command::SetElsewhere { chart, edits: ChartEdits { targets, ..edits.clone() } });
        }
        self.turned_v = into;
        self.edit(commands);
    }
}
