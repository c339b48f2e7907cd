//! Charts as pieces of a packing, around charts that stay in place.

use std::collections::BTreeSet;

use glam::DVec2;

use super::PackingSummary;
use crate::geom::{
    Bounds, ChartShape, FIRST_UDIM_TILE, Packing, PackingInput, PackingOptions, Rotations, corner_of_tile, pack,
};
use crate::problem::{Control, Embedding, SolveError};

/// Number of rows of tiles that have UDIM numbers of four digits.
const MOST_UDIM_ROWS: f64 = 899.0;

/// Chart at the area of its surface times the square of its size.
pub(super) struct Piece {
    /// Factor that scales the embedding.
    pub(super) factor: f64,
    pub(super) shape: ChartShape,
    /// Area that the chart covers, at its size.
    pub(super) area: f64,
}

impl Piece {
    /// Texture coordinates of an embedding as packed piece `k`.
    pub(super) fn laid(&self, embedding: &Embedding, packed: &PackedPieces, k: usize) -> Embedding {
        let PackedPieces { packing, beside, .. } = packed;
        let place = packing.places[k];
        let corner = corner_of_tile(place.tile as usize) + DVec2::new(*beside, 0.0);
        let coordinate =
            |&z: &DVec2| place.position(z * self.factor, packing.scale) / packing.picture.as_dvec2() + corner;
        embedding.iter().map(coordinate).collect()
    }
}

/// Pieces that are packed around shapes that stay, or beside them if they leave no room.
#[derive(Clone, Copy)]
pub(super) struct PiecesToPack<'a> {
    pub(super) pieces: &'a [&'a Piece],
    /// Tile of each piece, or an empty list; see [`PackingInput`].
    pub(super) tiles: &'a [Option<u32>],
    /// Shapes that stay. Without any, the pieces are packed beside the charts that stay.
    pub(super) fixed: &'a [ChartShape],
    /// Whole u at which the first tile begins if the pieces are packed beside.
    pub(super) beside: f64,
    pub(super) control: Control<'a>,
}

/// Packed pieces.
pub(super) struct PackedPieces {
    pub(super) packing: Packing,
    /// Whole u at which the first tile begins.
    beside: f64,
    /// True if the pieces are packed around shapes that stay.
    pub(super) is_around: bool,
}

/// Chart that stays where it is.
#[derive(Clone, Copy)]
pub(super) struct StayingChart<'a> {
    pub(super) coordinates: &'a Embedding,
    /// Area on the picture, pixels.
    pub(super) pixels: f64,
    /// Area of the surface, at the size of the chart.
    pub(super) area: f64,
}

impl PackedPieces {
    /// True if the shapes that stay leave no room for the pieces.
    fn has_no_room(&self) -> bool {
        self.is_around && self.packing.scale == 0.0
    }

    /// Summary of a packing. `area` is that of the pieces. The charts that stay count if the pieces lie around them.
    /// Without a piece the density is theirs.
    pub(super) fn summary(&self, options: PackingOptions, area: f64, staying: &[StayingChart<'_>]) -> PackingSummary {
        let staying = if self.is_around { staying } else { &[] };
        let packing = &self.packing;
        let covered = area * packing.scale.powi(2) + staying.iter().map(|chart| chart.pixels).sum::<f64>();
        let tiles_of_others = staying.iter().filter_map(|chart| Some(udim_tile(chart.coordinates)? - FIRST_UDIM_TILE));
        let tiles: BTreeSet<u32> = tiles_of_others.chain(packing.places.iter().map(|place| place.tile)).collect();
        let summary = PackingSummary::new(packing, options, tiles.len().max(1), covered);
        if !packing.places.is_empty() {
            return summary;
        }
        let density = density_of(staying).unwrap_or(0.0);
        PackingSummary { density, wanted_density: None, ..summary }
    }
}

impl PiecesToPack<'_> {
    /// Packs the pieces. `fixed_density` is the density of the charts that stay on a picture: pixels per unit of length
    /// on the surface. The pieces get no more. If `has_folds` is true because rounding folds a turned chart, pieces are
    /// turned by quarters.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(super) fn pack(
        self,
        options: PackingOptions,
        fixed_density: &dyn Fn(DVec2) -> Option<f64>,
        has_folds: &dyn Fn(&PackedPieces) -> bool,
    ) -> Result<PackedPieces, SolveError> {
        let mut found = self.packed(!self.fixed.is_empty(), options)?;
        if found.has_no_room() {
            found = self.packed(false, options)?;
        }
        let (is_around, picture) = (found.is_around, found.packing.picture);
        let mut used = options;
        if is_around
            && options.density.is_none()
            && let Some(density) = fixed_density(picture.as_dvec2())
            && density < found.packing.scale
        {
            let even = PackingOptions { density: Some(density), ..options };
            let evened = self.packed(is_around, even)?;
            if evened.packing.picture == picture && evened.packing.scale > 0.0 {
                (found, used) = (evened, even);
            }
        }
        if options.rotations == Rotations::Free && has_folds(&found) {
            let quarter = |options| PackingOptions { rotations: Rotations::Quarter, ..options };
            found = self.packed(is_around, quarter(used))?;
            if found.packing.picture != picture {
                found = self.packed(is_around, quarter(options))?;
            }
            if found.has_no_room() {
                found = self.packed(false, quarter(options))?;
            }
        }
        Ok(found)
    }

    fn packed(self, is_around: bool, options: PackingOptions) -> Result<PackedPieces, SolveError> {
        let shapes: Vec<ChartShape> = self.pieces.iter().map(|piece| piece.shape.clone()).collect();
        let fixed = if is_around { self.fixed } else { &[] };
        let input = PackingInput { shapes: &shapes, tiles: self.tiles, fixed };
        let is_cancelled = || self.control.go_on().is_err();
        let packing = pack(input, options, &is_cancelled).ok_or(SolveError::Cancelled)?;
        Ok(PackedPieces { packing, beside: if is_around { 0.0 } else { self.beside }, is_around })
    }
}

/// UDIM number of the tile that holds the centre of the box of coordinates. `None` if it has no number.
pub(super) fn udim_tile(coordinates: &Embedding) -> Option<u32> {
    let Bounds { low, high } = coordinates.bounds();
    let [column, row] = ((low + high) / 2.0).floor().to_array();
    let is_numbered = (0.0..10.0).contains(&column) && (0.0..MOST_UDIM_ROWS).contains(&row);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers")]
    is_numbered.then(|| FIRST_UDIM_TILE + column as u32 + 10 * row as u32)
}

/// Density of charts: pixels per unit of length on the surface. `None` if there is no chart with area.
pub(super) fn density_of(charts: &[StayingChart<'_>]) -> Option<f64> {
    let [pixels, area] = charts.iter().fold([0.0; 2], |sum, chart| [sum[0] + chart.pixels, sum[1] + chart.area]);
    Some((pixels / area).sqrt()).filter(|density| density.is_finite() && *density > 0.0)
}

/// Whole u at which packed charts begin: to the right of the charts that stay, or 0 if there are none.
pub(super) fn first_column_beside<'a>(laid: impl Iterator<Item = &'a Embedding>) -> f64 {
    let held = laid.map(Embedding::bounds).fold(Bounds::EMPTY, Bounds::union);
    if held.high.x.is_finite() { held.high.x.max(1.0).ceil() } else { 0.0 }
}
