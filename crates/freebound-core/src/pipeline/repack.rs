//! New places for the charts of a given layout, without flattening.
//!
//! A *chart* is a connected piece of the mesh in texture space: faces that share an edge with both of its texture
//! coordinates. Every chart keeps its shape up to a similarity. By default all charts get one density. A chart that is
//! one-to-one is packed by its outline, any other by the triangles that it covers. Only the layout matters: the surface
//! may be closed, or not manifold.

use std::collections::{BTreeSet, HashMap};

use glam::DVec2;

use super::atlas::{Piece, pack_pieces};
use super::given_charts::{GivenChart, GivenCharts};
use super::laid_chart::stacked_parts;
use super::stacks::{Stackable, stacks};
use super::{PackingSummary, StackedChart, StackedOn};
use crate::geom::{Packing, PackingOptions, Rotations, Stacking};
use crate::mesh::{Diagnosis, FaceId, PolygonMesh, TriMesh, VertexId, parts};
use crate::parallel::prelude::*;
use crate::problem::Embedding;
use crate::verify::{AtlasVerdict, ChartRelations, RoundingGrid, stacked_atlas_verdict};

/// Greatest extent of a chart that is scaled to the area of its surface, relative to the root of that area. Charts that
/// are thinner in the layout keep the scale of the whole layout: they have hardly an area there.
const MOST_EXTENT: f64 = 1e3;

/// Layout of a mesh: texture coordinates at the corners of its faces.
#[derive(Clone, Copy, Debug)]
pub struct GivenLayout<'a> {
    /// The mesh.
    pub mesh: &'a PolygonMesh,
    /// Texture coordinates, v up.
    pub coordinates: &'a [DVec2],
    /// Index into `coordinates` of each corner of the mesh, in the order of its faces.
    /// [`NO_COORDINATE`](super::NO_COORDINATE) if a corner has none.
    pub corners: &'a [u32],
    /// Width over height of the picture of the layout.
    pub aspect: f64,
}

/// Sizes of packed charts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChartSizes {
    /// All charts have one density: their area in the picture over the area of their surface.
    #[default]
    EqualDensity,
    /// Charts keep their sizes in the layout relative to each other.
    AsGiven,
}

/// Reason why a layout cannot be packed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RepackError {
    /// The mesh has no faces.
    #[error("the mesh has no faces")]
    NoFaces,
    /// These faces have corners without texture coordinates.
    #[error("{} faces have corners without texture coordinates, the first is face {}", .0.len(), .0[0].number())]
    Missing(Vec<FaceId>),
    /// These faces have corners at infinite coordinates or at ones that are not numbers.
    #[error("{} faces have texture coordinates that are not finite, the first is face {}", .0.len(), .0[0].number())]
    NotFinite(Vec<FaceId>),
}

/// Chart at its new place.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RepackedChart {
    /// First face of the chart, by its number in the mesh.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Average number of pixels of the picture per unit of length on the surface. 0 for a surface without area.
    pub density: f64,
    /// True if the chart was one-to-one in the given layout.
    pub was_planar: bool,
    /// Place on another chart. Absent for a chart with a place of its own.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub stacked: Option<StackedOn>,
}

/// Layout with new places for its charts.
#[derive(Clone, Debug)]
pub struct Repacked {
    /// Texture coordinates, v up.
    pub coordinates: Embedding,
    /// Index into `coordinates` of each corner of the input, in the order of its faces.
    /// [`NO_COORDINATE`](super::NO_COORDINATE) for corners of faces without a triangle.
    pub corners: Vec<u32>,
    /// Triangles over the coordinates, at their positions in space, those of each chart in a row. Polygons are numbered
    /// as in the input.
    pub mesh: TriMesh,
    /// Charts in the order of their first faces.
    pub charts: Vec<RepackedChart>,
    /// Size of the picture, gap and covered share.
    pub packing: PackingSummary,
    /// Exact verdict on all charts together, with faces numbered as in the input. Faults if a chart is no surface with a
    /// boundary, so that it cannot be one-to-one.
    pub verdict: Result<AtlasVerdict, Box<Diagnosis>>,
}

impl Repacked {
    /// Width over height of the picture.
    pub fn aspect(&self) -> f64 {
        let [width, height] = self.packing.picture.map(f64::from);
        width / height
    }

    /// True if the layout is proved one-to-one.
    pub fn is_planar(&self) -> bool {
        self.verdict.as_ref().is_ok_and(|verdict| verdict.planar)
    }

    /// Rounds all coordinates to the numbers of a file, and proves them again.
    pub fn round_to(&mut self, grid: RoundingGrid) {
        self.coordinates = self.coordinates.iter().map(|&z| grid.nearest(z)).collect();
        self.prove();
        if let Ok(verdict) = &mut self.verdict {
            verdict.planar_in_f32 = verdict.planar;
        }
    }

    fn prove(&mut self) {
        // Without redundant faces, which repairs leave in a file, as a second try.
        self.verdict = self.proved(&self.mesh).or_else(|_| {
            let mesh = self.mesh.clone().without_repeats().without_collapsed(&self.coordinates);
            self.proved(&mesh)
        });
    }

    fn proved(&self, mesh: &TriMesh) -> Result<AtlasVerdict, Box<Diagnosis>> {
        let parts = parts(mesh)?;
        let mut first = 0;
        let mut chart_of_polygon = HashMap::new();
        for (number, chart) in self.charts.iter().enumerate() {
            let faces = (first..first + chart.faces).map(FaceId::from_index);
            chart_of_polygon.extend(faces.map(|face| (self.mesh.polygon(face), number)));
            first += chart.faces;
        }
        let on = |chart: usize| Some(self.charts[chart].stacked?.chart);
        let stacked_on = stacked_parts(&parts, |face| chart_of_polygon[&mesh.polygon(face)], on);
        let relations = ChartRelations { stacked_on, ..ChartRelations::default() };
        Ok(stacked_atlas_verdict(&parts, &self.coordinates, &relations).as_in_file(mesh))
    }
}

/// Packs the charts of a layout again, into the picture of `options`, or into several tiles.
///
/// # Errors
///
/// [`RepackError`] if faces have no usable texture coordinates.
///
/// # Panics
///
/// If `corners` has another length than the corners of the mesh, or an index is out of range.
pub fn repack(layout: GivenLayout<'_>, sizes: ChartSizes, options: PackingOptions) -> Result<Repacked, RepackError> {
    let given = GivenCharts::of(layout)?;
    let pieces: Vec<Piece> = pieces_of(&given.charts, sizes);
    let stacked = stacked_charts(&given.charts, &pieces, options.stack);
    let free: Vec<usize> = (0..pieces.len()).filter(|&chart| stacked[chart].is_none()).collect();
    let packed = packed_upright(&given.charts, &pieces, &free, options);
    let mut laid: Vec<Option<Embedding>> = vec![None; pieces.len()];
    for (k, &chart) in free.iter().enumerate() {
        laid[chart] = Some(pieces[chart].laid(&given.charts[chart].plane, &packed, k, 0.0));
    }
    for (chart, on) in stacked.iter().enumerate().filter_map(|(chart, on)| Some((chart, on.as_ref()?))) {
        laid[chart] = laid[on.on.chart].as_ref().map(|representative| on.coordinates(representative));
    }
    let laid: Vec<Embedding> = laid.into_iter().flatten().collect();
    Ok(given.repacked(&laid, &stacked, summary_of(&pieces, &free, &packed, options)))
}

/// Packing of the free charts. If rounding folds a turned chart, quarter turns are used instead.
fn packed_upright(charts: &[GivenChart], pieces: &[Piece], free: &[usize], options: PackingOptions) -> Packing {
    let own: Vec<&Piece> = free.iter().map(|&chart| &pieces[chart]).collect();
    let packing = pack_pieces(own.iter().copied(), options);
    let is_folded = |(k, &chart): (usize, &usize)| {
        charts[chart].is_planar && !charts[chart].is_planar_at(&own[k].laid(&charts[chart].plane, &packing, k, 0.0))
    };
    if options.rotations == Rotations::Free && free.par_iter().enumerate().any(is_folded) {
        return pack_pieces(own.iter().copied(), PackingOptions { rotations: Rotations::Quarter, ..options });
    }
    packing
}

fn summary_of(pieces: &[Piece], free: &[usize], packing: &Packing, options: PackingOptions) -> PackingSummary {
    let covered = free.iter().map(|&chart| pieces[chart].area).sum::<f64>() * packing.scale.powi(2);
    let tiles: BTreeSet<u32> = packing.places.iter().map(|place| place.tile).collect();
    PackingSummary::new(packing, options, tiles.len(), covered)
}

/// Charts scaled to the lengths of the surface: each by itself, or all by one factor.
fn pieces_of(charts: &[GivenChart], sizes: ChartSizes) -> Vec<Piece> {
    let total = |area: fn(&GivenChart) -> f64| charts.iter().map(area).sum::<f64>();
    let of_whole = (total(|chart| chart.area) / total(|chart| chart.area_in_plane)).sqrt();
    let of_whole = if of_whole.is_normal() { of_whole } else { 1.0 };
    let piece = |chart: &GivenChart| {
        let own = (chart.area / chart.area_in_plane).sqrt();
        let is_usable = own.is_normal() && chart.extent() * own <= MOST_EXTENT * chart.area.sqrt();
        let factor = if sizes == ChartSizes::EqualDensity && is_usable { own } else { of_whole };
        Piece { factor, shape: chart.shape(factor), area: chart.area_in_plane * factor * factor }
    };
    charts.par_iter().map(piece).collect()
}

fn stacked_charts(charts: &[GivenChart], pieces: &[Piece], stacking: Stacking) -> Vec<Option<StackedChart>> {
    if stacking == Stacking::None {
        return vec![None; charts.len()];
    }
    let stackable = |(chart, piece): (&GivenChart, &Piece)| {
        let surface = chart.measured(piece.factor)?;
        Some(Stackable { surface, size: 1.0, tile: None })
    };
    let found = stacks(&charts.par_iter().zip(pieces).map(stackable).collect::<Vec<_>>(), stacking);
    let in_charts = |(chart, stacked): (usize, Option<StackedChart>)| {
        let StackedChart { on, vertex_of } = stacked?;
        Some(StackedChart { on, vertex_of: charts[chart].in_chart(&charts[on.chart], &vertex_of) })
    };
    found.into_iter().enumerate().map(in_charts).collect()
}

impl GivenCharts {
    /// Result for the coordinates of each chart.
    fn repacked(self, laid: &[Embedding], stacked: &[Option<StackedChart>], packing: PackingSummary) -> Repacked {
        let picture = DVec2::from(packing.picture.map(f64::from));
        let chart = |((chart, laid), stacked): ((&GivenChart, &Embedding), &Option<StackedChart>)| RepackedChart {
            first_face: chart.first_face(),
            faces: chart.mesh.face_count(),
            density: chart.density(laid, picture),
            was_planar: chart.is_planar,
            stacked: stacked.as_ref().map(|stacked| stacked.on),
        };
        let charts: Vec<RepackedChart> = self.charts.iter().zip(laid).zip(stacked).map(chart).collect();
        let mut mesh = TriMesh { polygon_of: Some(Vec::new()), ..TriMesh::default() };
        for chart in &self.charts {
            let first = mesh.positions.len();
            let moved = |vertex: VertexId| VertexId::from_index(first + vertex.index());
            mesh.positions.extend_from_slice(&chart.mesh.positions);
            mesh.triangles.extend(chart.mesh.triangles.iter().map(|corners| corners.map(moved)));
            mesh.polygon_of.get_or_insert_default().extend(chart.mesh.polygon_of.iter().flatten());
        }
        let coordinates = laid.iter().flat_map(|laid| laid.iter().copied()).collect();
        let verdict = Err(Box::default());
        let mut repacked = Repacked { coordinates, corners: self.corners, mesh, charts, packing, verdict };
        repacked.prove();
        repacked
    }
}
