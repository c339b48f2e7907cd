//! New places for the charts of a given layout, without flattening.
//!
//! A *chart* is a connected piece of the mesh in texture space: faces that share an edge with both of its texture
//! coordinates. Every chart keeps its shape up to a similarity. By default all charts get one density. A chart that is
//! one-to-one is packed by its outline, any other by the triangles that it covers. Locked charts keep their place. Only
//! the layout matters: the surface may be closed, or not manifold.

use std::collections::{BTreeSet, HashMap};

use glam::DVec2;

use super::given_charts::{GivenChart, GivenCharts};
use super::laid_chart::stacked_parts;
use super::pieces::{PackedPieces, Piece, PiecesToPack, StayingChart, density_of, first_column_beside};
use super::stacks::{Stackable, stacks};
use super::{NO_COORDINATE, PackingSummary, StackedChart, StackedOn};
use crate::geom::{ChartShape, PackingOptions, Stacking};
use crate::mesh::{Diagnosis, FaceId, PolygonMesh, TriMesh, VertexId, parts};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};
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

/// Charts of a layout that stay in place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LockedCharts {
    /// Charts by their numbers, in the order of their first faces.
    Numbered(BTreeSet<usize>),
    /// Charts that have one of these faces.
    WithFaces(BTreeSet<FaceId>),
}

impl Default for LockedCharts {
    fn default() -> Self {
        Self::Numbered(BTreeSet::new())
    }
}

/// Rules for packing a layout.
#[derive(Clone, Debug, Default)]
pub struct RepackOptions {
    /// Picture, gap and rotations.
    pub packing: PackingOptions,
    /// Sizes of the charts.
    pub sizes: ChartSizes,
    /// Charts that keep their coordinates to the last bit; [`Repacked::round_to`] rounds them like all others. The others
    /// are packed around them, with no more pixels per unit of length, or to their right if they leave no room.
    pub locked: LockedCharts,
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
    /// A locked chart does not exist.
    #[error("there is no chart {chart} to lock: the layout has {count}, numbered from 0")]
    NoSuchChart {
        /// Number of the chart.
        chart: usize,
        /// Number of charts.
        count: usize,
    },
    /// A face of a locked chart does not exist.
    #[error("there is no face {face} to lock: the mesh has {count}, numbered from 0")]
    NoSuchFace {
        /// Number of the face.
        face: FaceId,
        /// Number of faces.
        count: usize,
    },
    /// The caller cancelled the packing.
    #[error("{}", SolveError::Cancelled)]
    Cancelled,
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

    /// Polygon of each triangle, by its number in the input, with its chart.
    pub fn chart_of_triangles(&self) -> impl Iterator<Item = (u32, usize)> {
        let charts = self.charts.iter().enumerate();
        let chart_of = charts.flat_map(|(number, chart)| std::iter::repeat_n(number, chart.faces));
        (0..self.mesh.face_count()).map(|face| self.mesh.polygon(FaceId::from_index(face))).zip(chart_of)
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
        let chart_of_polygon: HashMap<u32, usize> = self.chart_of_triangles().collect();
        let on = |chart: usize| Some(self.charts[chart].stacked?.chart);
        let stacked_on = stacked_parts(&parts, |face| chart_of_polygon[&mesh.polygon(face)], on);
        let relations = ChartRelations { stacked_on, ..ChartRelations::default() };
        Ok(stacked_atlas_verdict(&parts, &self.coordinates, &relations).as_in_file(mesh))
    }
}

/// Packs the charts of a layout again, into the picture of the options, or into several tiles.
///
/// # Errors
///
/// [`RepackError`] if faces have no usable texture coordinates, or if a locked chart does not exist.
///
/// # Panics
///
/// If `corners` has another length than the corners of the mesh, or an index is out of range.
pub fn repack(layout: GivenLayout<'_>, options: &RepackOptions) -> Result<Repacked, RepackError> {
    repack_with(layout, options, Control::unattended())
}

/// Packs the charts of a layout again, unless the caller cancels.
///
/// # Errors
///
/// Errors of [`repack`], and [`RepackError::Cancelled`].
///
/// # Panics
///
/// Panics of [`repack`].
pub fn repack_with(
    layout: GivenLayout<'_>,
    options: &RepackOptions,
    control: Control<'_>,
) -> Result<Repacked, RepackError> {
    let given = GivenCharts::of(layout)?;
    let pieces = pieces_of(&given.charts, options.sizes);
    let mut laid = given.locked(layout, &options.locked)?;
    let stacked = stacked_charts(&given.charts, &pieces, &laid, options.packing.stack);
    let free = (0..pieces.len()).filter(|&chart| laid[chart].is_none() && stacked[chart].is_none()).collect();
    let plan = RepackPlan { charts: &given.charts, pieces, free, locked: &laid };
    let packed = plan.packed(layout.aspect, options, control).map_err(|_| RepackError::Cancelled)?;
    let summary = plan.summary(&packed, options);
    let RepackPlan { pieces, free, .. } = plan;
    for (k, &chart) in free.iter().enumerate() {
        laid[chart] = Some(pieces[chart].laid(&given.charts[chart].plane, &packed, k));
    }
    for (chart, on) in stacked.iter().enumerate().filter_map(|(chart, on)| Some((chart, on.as_ref()?))) {
        laid[chart] = laid[on.on.chart].as_ref().map(|representative| on.coordinates(representative));
    }
    let laid: Vec<Embedding> = laid.into_iter().flatten().collect();
    control.go_on().map_err(|_| RepackError::Cancelled)?;
    Ok(given.repacked(&laid, &stacked, summary))
}

/// Charts to pack.
struct RepackPlan<'a> {
    charts: &'a [GivenChart],
    /// All charts, at their sizes.
    pieces: Vec<Piece>,
    /// Numbers of the charts that are packed at places of their own.
    free: Vec<usize>,
    /// Coordinates of the charts that stay.
    locked: &'a [Option<Embedding>],
}

impl RepackPlan<'_> {
    /// Packing of the free charts. `aspect` is that of the picture of the given layout.
    fn packed(&self, aspect: f64, options: &RepackOptions, control: Control<'_>) -> Result<PackedPieces, SolveError> {
        let pieces: Vec<&Piece> = self.free.iter().map(|&chart| &self.pieces[chart]).collect();
        let plane = DVec2::new(aspect, 1.0);
        let of_locked = self.charts.iter().zip(self.locked).filter(|(_, laid)| laid.is_some());
        let fixed: Vec<ChartShape> = of_locked.map(|(chart, _)| chart.shape(1.0 / plane)).collect();
        let beside = first_column_beside(self.locked.iter().flatten());
        let to_pack = PiecesToPack { pieces: &pieces, tiles: &[], fixed: &fixed, beside, control };
        let is_folded = |packed: &PackedPieces, (k, &chart): (usize, &usize)| {
            let given = &self.charts[chart];
            given.is_planar && !given.is_planar_at(&self.pieces[chart].laid(&given.plane, packed, k))
        };
        to_pack.pack(options.packing, &|picture| self.density_of_locked(picture, options.sizes), &|packed| {
            self.free.par_iter().enumerate().any(|chart| is_folded(packed, chart))
        })
    }

    /// Density of the charts that stay, at which the others match them. With given sizes all charts then keep their sizes.
    fn density_of_locked(&self, picture: DVec2, sizes: ChartSizes) -> Option<f64> {
        density_of(&self.staying(picture, sizes))
    }

    /// Charts that stay on a picture.
    fn staying(&self, picture: DVec2, sizes: ChartSizes) -> Vec<StayingChart<'_>> {
        let of_locked = self.charts.iter().zip(self.locked).zip(&self.pieces);
        let staying = of_locked.filter_map(|((chart, laid), piece)| {
            let coordinates = laid.as_ref()?;
            let area = if sizes == ChartSizes::AsGiven { piece.area } else { chart.area };
            Some(StayingChart { coordinates, pixels: chart.area_at(coordinates, picture), area })
        });
        staying.collect()
    }

    fn summary(&self, packed: &PackedPieces, options: &RepackOptions) -> PackingSummary {
        let area = self.free.iter().map(|&chart| self.pieces[chart].area).sum();
        let picture = packed.packing.picture.as_dvec2();
        // The density is that of the surface, whatever the sizes.
        packed.summary(options.packing, area, &self.staying(picture, ChartSizes::EqualDensity))
    }
}

/// Charts that lie on others. Those with coordinates in `laid` stay, and share no place.
fn stacked_charts(
    charts: &[GivenChart],
    pieces: &[Piece],
    laid: &[Option<Embedding>],
    stacking: Stacking,
) -> Vec<Option<StackedChart>> {
    if stacking == Stacking::None {
        return vec![None; charts.len()];
    }
    let stackable = |((chart, piece), laid): ((&GivenChart, &Piece), &Option<Embedding>)| {
        let surface = if laid.is_none() { chart.measured(piece.factor)? } else { return None };
        Some(Stackable { surface, size: 1.0, tile: None })
    };
    let found = stacks(&charts.par_iter().zip(pieces).zip(laid).map(stackable).collect::<Vec<_>>(), stacking);
    let in_charts = |(chart, stacked): (usize, Option<StackedChart>)| {
        let StackedChart { on, vertex_of } = stacked?;
        Some(StackedChart { on, vertex_of: charts[chart].in_chart(&charts[on.chart], &vertex_of) })
    };
    found.into_iter().enumerate().map(in_charts).collect()
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
        Piece { factor, shape: chart.shape(DVec2::splat(factor)), area: chart.area_in_plane * factor * factor }
    };
    charts.par_iter().map(piece).collect()
}

impl GivenCharts {
    /// Given coordinates of the locked charts.
    fn locked(&self, layout: GivenLayout<'_>, locked: &LockedCharts) -> Result<Vec<Option<Embedding>>, RepackError> {
        let count = self.charts.len();
        let is_locked: Vec<bool> = match locked {
            LockedCharts::Numbered(numbers) => {
                if let Some(&chart) = numbers.range(count..).next() {
                    return Err(RepackError::NoSuchChart { chart, count });
                }
                (0..count).map(|chart| numbers.contains(&chart)).collect()
            }
            LockedCharts::WithFaces(faces) => {
                let count = layout.mesh.face_count();
                if let Some(&face) = faces.range(FaceId::from_index(count)..).next() {
                    return Err(RepackError::NoSuchFace { face, count });
                }
                let has_one = |chart: &GivenChart| chart.polygons().any(|face| faces.contains(&face));
                self.charts.iter().map(has_one).collect()
            }
        };
        let mut coordinates = vec![DVec2::ZERO; self.charts.iter().map(|chart| chart.plane.len()).sum()];
        for (place, &vertex) in self.corners.iter().enumerate().filter(|(_, vertex)| **vertex != NO_COORDINATE) {
            coordinates[vertex as usize] = layout.coordinate(place);
        }
        let mut rest = &coordinates[..];
        let of_chart = |(chart, is_locked): (&GivenChart, bool)| {
            let (own, others) = rest.split_at(chart.plane.len());
            rest = others;
            is_locked.then(|| own.to_vec().into())
        };
        Ok(self.charts.iter().zip(is_locked).map(of_chart).collect())
    }

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
