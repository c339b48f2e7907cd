//! Where v = 0 is on the picture.

use std::collections::BTreeMap;

use glam::DVec2;

use super::{Command, Session};
use crate::geom::VAxis;
use crate::io::Target;
use crate::mesh::VertexId;

/// How the targets' v were turned around last, each as it was before and after. 1 − v rounds, and so does not always come
/// back: turned around again, a number that is known from before is that number to the last bit.
#[derive(Debug, Default)]
pub(super) struct TurnedV(BTreeMap<VertexId, [f64; 2]>);

impl TurnedV {
    fn turned(&self, vertex: VertexId, v: f64) -> f64 {
        match self.0.get(&vertex) {
            Some([before, after]) if after.to_bits() == v.to_bits() => *before,
            _ => 1.0 - v,
        }
    }
}

impl Session {
    /// Chooses where v = 0 is. The targets keep their places on the picture; chosen back, they are as they were.
    pub(super) fn set_v_axis(&mut self, v_axis: VAxis) {
        if v_axis == self.document.v_axis {
            return;
        }
        let mut turned = BTreeMap::new();
        let mut commands = vec![Command::SetVAxis(v_axis)];
        for (&vertex, target) in &self.document.targets {
            let v = self.turned_v.turned(vertex, target.uv.y);
            turned.insert(vertex, [target.uv.y, v]);
            let target = Target { uv: DVec2::new(target.uv.x, v), ..*target };
            commands.push(Command::SetPin { vertex, target: Some(target) });
        }
        self.turned_v = TurnedV(turned);
        self.edit(commands);
    }
}
