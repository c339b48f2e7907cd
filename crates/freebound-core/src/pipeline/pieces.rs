//! Charts as pieces of a packing, around charts that stay in place.

use glam::DVec2;

use crate::geom::{Bounds, ChartShape, Packing, PackingInput, PackingOptions, Rotations, corner_of_tile, pack_beside};
use crate::problem::Embedding;

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
}

/// Packed pieces.
pub(super) struct PackedPieces {
    pub(super) packing: Packing,
    /// Whole u at which the first tile begins.
    beside: f64,
    /// True if the pieces are packed around shapes that stay.
    pub(super) is_around: bool,
}

impl PiecesToPack<'_> {
    /// Packs the pieces. `fixed_density` is the density of the charts that stay on a picture: pixels per unit of length
    /// on the surface. The pieces get no more. If `has_folds` is true because rounding folds a turned chart, pieces are
    /// turned by quarters.
    pub(super) fn pack(
        self,
        options: PackingOptions,
        fixed_density: &dyn Fn(DVec2) -> Option<f64>,
        has_folds: &dyn Fn(&PackedPieces) -> bool,
    ) -> PackedPieces {
        let mut found = self.packed(!self.fixed.is_empty(), options);
        if found.is_around && found.packing.scale == 0.0 {
            found = self.packed(false, options);
        }
        let (is_around, picture) = (found.is_around, found.packing.picture);
        let mut used = options;
        if is_around
            && options.density.is_none()
            && let Some(density) = fixed_density(picture.as_dvec2())
            && density < found.packing.scale
        {
            let even = PackingOptions { density: Some(density), ..options };
            let evened = self.packed(is_around, even);
            if evened.packing.picture == picture && evened.packing.scale > 0.0 {
                (found, used) = (evened, even);
            }
        }
        if options.rotations == Rotations::Free && has_folds(&found) {
            let quarter = |options| PackingOptions { rotations: Rotations::Quarter, ..options };
            found = self.packed(is_around, quarter(used));
            if found.packing.picture != picture {
                found = self.packed(is_around, quarter(options));
            }
        }
        found
    }

    fn packed(self, is_around: bool, options: PackingOptions) -> PackedPieces {
        let shapes: Vec<ChartShape> = self.pieces.iter().map(|piece| piece.shape.clone()).collect();
        let fixed = if is_around { self.fixed } else { &[] };
        let input = PackingInput { shapes: &shapes, tiles: self.tiles, fixed };
        let packing = pack_beside(input, options, &|| false).expect("a packing that nobody cancels");
        PackedPieces { packing, beside: if is_around { 0.0 } else { self.beside }, is_around }
    }
}

/// Density of charts: pixels per unit of length on the surface. `areas` has the area of each chart in pixels and on the
/// surface. `None` if there is no chart with area.
pub(super) fn density_of(areas: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    let [pixels, area] = areas.fold([0.0; 2], |sum, [pixels, area]| [sum[0] + pixels, sum[1] + area]);
    Some((pixels / area).sqrt()).filter(|density| density.is_finite() && *density > 0.0)
}

/// Whole u at which packed charts begin: to the right of the charts that stay, or 0 if there are none.
pub(super) fn first_column_beside<'a>(laid: impl Iterator<Item = &'a Embedding>) -> f64 {
    let held = laid.map(Embedding::bounds).fold(Bounds::EMPTY, Bounds::union);
    if held.high.x.is_finite() { held.high.x.max(1.0).ceil() } else { 0.0 }
}
