//! Tiles of charts: any of a number of tiles, or one tile for each material or group.

use std::collections::{BTreeMap, HashMap};

use super::error::CommandError;
use super::typed::TileRule;
use crate::session::Model;
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{DiskMesh, FaceId};

/// Tiles for the charts of a mesh.
#[derive(Debug, Default)]
pub(super) struct ChartTiles {
    /// Number of tiles.
    pub(super) count: u32,
    /// Tile of each chart that must lie in a certain one, by the first face of the chart.
    pub(super) of_chart: BTreeMap<FaceId, u32>,
}

impl ChartTiles {
    /// Tiles by a rule.
    ///
    /// # Errors
    ///
    /// If the file has no materials or groups, or more than there can be tiles.
    pub(super) fn new(rule: Option<TileRule>, model: &Model) -> Result<Self, CommandError> {
        let (option, labels) = match rule {
            None => return Ok(Self { count: 1, ..Self::default() }),
            Some(TileRule::UpTo(count)) => return Ok(Self { count, ..Self::default() }),
            Some(TileRule::Materials) => ("materials", model.source.material_labels()),
            Some(TileRule::Groups) => ("groups", model.source.group_labels()),
        };
        let refused =
            |why: String| CommandError::Usage(format!("{}: {why}: remove --tiles {option}", model.path_words()));
        let (tiles, count) = in_order_of_use(&labels.map_err(|error| refused(error.to_string()))?);
        if count > PackingOptions::MOST_TILES {
            return Err(refused(format!("{count} {option}, more than {} tiles", PackingOptions::MOST_TILES)));
        }
        Ok(Self { count, of_chart: of_charts(model, &tiles) })
    }
}

/// Labels numbered from 0 in the order of their first faces, and their number.
fn in_order_of_use(labels: &[u32]) -> (Vec<u32>, u32) {
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let mut number = |label: &u32| {
        let next = u32::try_from(numbers.len()).expect("fewer labels than 2^32");
        *numbers.entry(*label).or_insert(next)
    };
    let numbered = labels.iter().map(&mut number).collect();
    (numbered, u32::try_from(numbers.len()).expect("fewer labels than 2^32"))
}

/// Tile of each chart. `tiles` has the tile of each face of the file.
fn of_charts(model: &Model, tiles: &[u32]) -> BTreeMap<FaceId, u32> {
    let Some(of) = &model.prepared.chart else { return BTreeMap::new() };
    let of_chart = |number: usize| {
        let chart = model.of_chart(number);
        Some((of.charts.first_face(number), tile_of_most_area(chart.disk()?, tiles)?))
    };
    (0..of.charts.count()).filter_map(of_chart).collect()
}

/// Tile of the largest share of a chart's area; the first one of several.
fn tile_of_most_area(disk: &DiskMesh, tiles: &[u32]) -> Option<u32> {
    let mesh = disk.mesh();
    let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
    for face in disk.real_faces() {
        if let Some(&tile) = tiles.get(mesh.polygon(face) as usize) {
            *areas.entry(tile).or_default() += mesh.double_area_vector(face).length();
        }
    }
    areas.into_iter().reduce(|best, other| if other.1 > best.1 { other } else { best }).map(|(tile, _)| tile)
}
