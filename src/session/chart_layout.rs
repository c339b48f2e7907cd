//! Layout of several charts on the page: packing options, and the charts that the user sized, placed, locked or stacked.

use std::collections::BTreeMap;
use std::sync::Arc;

use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{Charts, FaceId};
use freebound_core::problem::Embedding;

/// Layout of several charts on the page. Charts are named by their first faces in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChartLayout {
    /// Packing options. If there is a picture, its size replaces the size in the options.
    pub packing: PackingOptions,
    /// Sizes of charts relative to the others. Default: 1. Sizes outside [`PackingOptions::SIZES`] are clamped.
    pub sizes: BTreeMap<FaceId, f64>,
    /// Places of locked charts. They cannot be moved and are not packed.
    pub locked: BTreeMap<FaceId, ChartPlace>,
    /// Places of charts that stay until they are moved or packed. The first move places all charts, so that no other
    /// chart moves by itself.
    pub placed: BTreeMap<FaceId, ChartPlace>,
    /// Chart whose place each stacked chart shares.
    pub stacked: BTreeMap<FaceId, FaceId>,
}

/// Distance from 1 up to which a size is the default size. A size that is scaled there and back differs by rounding.
const SAME_SIZE: f64 = 1e-9;

/// Texture coordinates of the vertices of a chart, v up.
#[derive(Clone, Debug)]
pub struct ChartPlace(pub Arc<Embedding>);

impl PartialEq for ChartPlace {
    fn eq(&self, other: &Self) -> bool {
        // Most places are shared, and a place can have a million vertices.
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl ChartLayout {
    /// Size of a chart relative to the others.
    pub fn size_of(&self, charts: &Charts, number: usize) -> f64 {
        self.sizes.get(&charts.first_face(number)).copied().unwrap_or(1.0)
    }

    /// Sets the size of a chart relative to the others, clamped to [`PackingOptions::SIZES`].
    pub(super) fn set_size(&mut self, chart: FaceId, size: f64) {
        let size = size.clamp(*PackingOptions::SIZES.start(), *PackingOptions::SIZES.end());
        if (size - 1.0).abs() <= SAME_SIZE {
            self.sizes.remove(&chart);
        } else {
            self.sizes.insert(chart, size);
        }
    }

    /// Place where a chart is locked. A place with another number of vertices does not count.
    pub(super) fn lock_of(&self, charts: &Charts, number: usize) -> Option<&Arc<Embedding>> {
        place_in(&self.locked, charts, number)
    }

    /// Place where a chart stays, locked or not. A place with another number of vertices does not count.
    pub(super) fn place_of(&self, charts: &Charts, number: usize) -> Option<&Arc<Embedding>> {
        self.lock_of(charts, number).or_else(|| place_in(&self.placed, charts, number))
    }

    /// Chart whose place a chart shares by choice.
    pub(super) fn stacked_on(&self, charts: &Charts, number: usize) -> Option<usize> {
        let on = self.stacked.get(&charts.first_face(number))?;
        (0..charts.count()).find(|&other| charts.first_face(other) == *on)
    }

    /// Layout without places, which belong to another orientation of the faces.
    pub(super) fn without_places(&self) -> Self {
        Self { locked: BTreeMap::new(), placed: BTreeMap::new(), ..self.clone() }
    }
}

fn place_in<'a>(
    places: &'a BTreeMap<FaceId, ChartPlace>,
    charts: &Charts,
    number: usize,
) -> Option<&'a Arc<Embedding>> {
    let ChartPlace(place) = places.get(&charts.first_face(number))?;
    (place.len() == charts.vertex_count(number)).then_some(place)
}
