//! Stacks: charts with congruent surfaces that share one place in the picture.
//!
//! The first chart of a stack is its *representative*. Every other chart of the stack takes the texture coordinates of
//! the representative bit for bit, along an isomorphism of their faces. Surfaces decide about congruence, and a map
//! only if one is given.

use std::collections::BTreeSet;

use super::StackedOn;
use crate::geom::Stacking;
use crate::mesh::{MeasuredSurface, SurfaceKey, VertexId};
use crate::parallel::prelude::*;
use crate::problem::Embedding;

/// Chart that lies on the representative of its stack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StackedChart {
    /// The representative.
    pub on: StackedOn,
    /// Vertex of the representative for each vertex of the chart. `None` for vertices of no face of the surface.
    pub vertex_of: Vec<Option<VertexId>>,
}

impl StackedChart {
    /// Coordinates of the chart from those of its representative. Vertices of no face get the first one.
    ///
    /// # Panics
    ///
    /// If the representative lacks a vertex.
    pub fn coordinates(&self, of_representative: &Embedding) -> Embedding {
        let first = of_representative[VertexId::new(0)];
        self.vertex_of.iter().map(|vertex| vertex.map_or(first, |vertex| of_representative[vertex])).collect()
    }
}

/// Chart that may share its place.
pub(super) struct Stackable {
    pub(super) surface: MeasuredSurface,
    /// Size of the chart relative to others. Only charts of equal size share a place.
    pub(super) size: f64,
    /// Tile in which the chart must lie. Only charts of equal tile share a place.
    pub(super) tile: Option<u32>,
}

/// Place of a class of charts in the order of their keys. Areas are not negative, so their bits ascend as they do.
type ClassKey = (SurfaceKey, Option<u32>, u64, u64, usize);

/// Charts that lie on another, by chart. Charts without an entry have a place of their own. `None` in `charts` stands
/// for a chart that may not be stacked.
pub(super) fn stacks(charts: &[Option<Stackable>], stacking: Stacking) -> Vec<Option<StackedChart>> {
    let may_mirror = match stacking {
        Stacking::None => return vec![None; charts.len()],
        Stacking::Congruent => false,
        Stacking::Mirrored => true,
    };
    let keys: Vec<Option<SurfaceKey>> =
        charts.par_iter().map(|chart| chart.as_ref().map(|chart| chart.surface.key())).collect();
    let mut representatives: BTreeSet<ClassKey> = BTreeSet::new();
    let mut stacked = vec![None; charts.len()];
    for (number, (chart, key)) in charts.iter().zip(keys).enumerate() {
        let (Some(chart), Some(key)) = (chart, key) else { continue };
        let of = |area: f64, number: usize| (key.clone(), chart.tile, chart.size.to_bits(), area.to_bits(), number);
        let [low, high] = chart.surface.areas();
        let near = representatives.range(of(low, 0)..=of(high, usize::MAX)).map(|(.., number)| *number);
        let mut near: Vec<usize> = near.collect();
        near.sort_unstable();
        let on = |on: usize| {
            let found = chart.surface.congruence(&charts[on].as_ref()?.surface, may_mirror)?;
            Some(StackedChart { on: StackedOn { chart: on, mirrored: found.mirrored }, vertex_of: found.vertex_of })
        };
        stacked[number] = near.into_iter().find_map(on);
        if stacked[number].is_none() {
            representatives.insert(of(chart.surface.area(), number));
        }
    }
    stacked
}
