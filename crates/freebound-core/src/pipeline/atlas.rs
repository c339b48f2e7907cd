//! Layout of several solved charts: placed beside each other and proved together.
//!
//! A chart with pins stays at its pins. All other charts are packed into the unit square. If a chart has pins, that
//! square lies to its right. Packed charts share one density, in pixels per unit of length on the surface, times the
//! size that the user gives to each chart. Charts are packed by their shapes, in any rotation unless options forbid
//! it. Rounding can fold a turned chart; then charts are packed again with exact quarter turns. Charts that started
//! from the layout of their file may stay there instead ([`Arrangement::AsGiven`]).

use glam::DVec2;

use super::{
    Fit, LaidChart, Outcome, PackingSummary, PinsSummary, Placement, PreparedMesh, pins_summary, prove_atlas, upright,
};
use crate::flatten::true_area_factor;
use crate::geom::{
    Bounds, ChartShape, Packing, PackingOptions, Rotations, double_area, is_simple, pack, turning_number,
};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::parallel::prelude::*;
use crate::problem::Embedding;
use crate::verify::{AtlasVerdict, DistortionSummary, distortion, verdict};

/// Least extent of a packed chart without area, relative to the root of the area of all charts: about a pixel of the picture.
const LEAST_EXTENT: f64 = 1e-3;

/// Root of a chart's area, relative to that of all charts, at which the chart counts as one without area.
const NO_AREA: f64 = 1e-9;

/// Placement of charts without pins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// Packed into the unit square.
    #[default]
    Packed,
    /// Kept at the layout that they started from. If a chart has another start or size, or charts overlap there, the
    /// charts without pins are packed.
    AsGiven,
}

/// A solved chart.
#[derive(Clone, Copy, Debug)]
pub struct SolvedChart<'a> {
    /// The chart.
    pub chart: &'a PreparedMesh,
    /// Step to lay out.
    pub outcome: &'a Outcome,
    /// Size relative to the other packed charts. Default: 1.
    pub size: f64,
}

/// Summary of one chart of an atlas. Vertices have their numbers in the whole repaired mesh.
#[derive(Clone, Debug)]
pub struct ChartSummary {
    /// First face of the chart, by the number of its polygon in the input.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Pins and their errors.
    pub pins: PinsSummary,
    /// True if the boundary was laid on a convex shape or bent to one.
    pub has_convex_boundary: bool,
    /// Placement of the coordinates.
    pub placement: Placement,
    /// Distortion at the final coordinates.
    pub distortion: DistortionSummary,
    /// Average number of pixels of the picture per unit of length on the surface.
    pub density: f64,
    /// Number of vertices added to the mesh.
    pub new_vertices: usize,
}

/// Charts laid out beside each other and proved together.
#[derive(Debug)]
pub struct Atlas<'a> {
    /// Charts with their final coordinates, in the order of the input.
    pub charts: Vec<LaidChart<'a>>,
    /// Summary of each chart.
    pub summaries: Vec<ChartSummary>,
    /// Exact verdict on all charts together.
    pub verdict: AtlasVerdict,
    /// Packing. Absent if no chart was packed.
    pub packing: Option<PackingSummary>,
    /// Width over height of the picture that the coordinates are for.
    pub aspect: f64,
    /// Edges of the whole mesh that are split by new vertices, by their ends.
    pub split_edges: Vec<[VertexId; 2]>,
    /// Polygons that were cut into triangles, by their numbers in the input.
    pub cut_polygons: Vec<FaceId>,
}

/// Lays out charts and proves each of them and the whole. `charts` are all charts of one mesh, in order.
///
/// # Panics
///
/// If `charts` is empty, a chart has no disk, or a chart does not belong to a mesh of several charts.
pub fn atlas<'a>(charts: &[SolvedChart<'a>], options: PackingOptions, arrangement: Arrangement) -> Atlas<'a> {
    let is_placed =
        |chart: &SolvedChart<'_>| chart.is_held() || (chart.outcome.step.lies_as_given && chart.has_usual_size());
    if arrangement == Arrangement::AsGiven && charts.iter().all(is_placed) {
        let laid = charts.par_iter().map(SolvedChart::in_place).collect();
        let in_place = output(charts, laid, None, options);
        if in_place.verdict.overlapping_faces.is_empty() {
            return in_place;
        }
    }
    packed(charts, options)
}

fn packed<'a>(charts: &[SolvedChart<'a>], options: PackingOptions) -> Atlas<'a> {
    let mut laid: Vec<Option<Embedding>> =
        charts.iter().map(|chart| chart.is_held().then(|| chart.in_place())).collect();
    let beside = first_column_beside(&laid);
    let free: Vec<usize> = (0..charts.len()).filter(|&chart| laid[chart].is_none()).collect();
    let mut pieces: Vec<Piece> = free.par_iter().map(|&chart| Piece::new(&charts[chart])).collect();
    let total = pieces.iter().map(|piece| piece.area).sum::<f64>().sqrt();
    for (piece, &chart) in pieces.iter_mut().zip(&free) {
        if piece.area.sqrt() <= NO_AREA * total && total.is_finite() {
            piece.grow_to(LEAST_EXTENT * total, &charts[chart]);
        }
    }
    let mut packing = pack_pieces(&pieces, options);
    let place = |packing: &Packing, k: usize| pieces[k].laid(&charts[free[k]], packing, k, beside);
    let is_folded = |(k, &chart): (usize, &usize)| {
        let solved = &charts[chart];
        let proved =
            |coordinates: &Embedding| verdict(solved.outcome.step.candidate.mesh(solved.disk()), coordinates).planar;
        solved.outcome.step.verdict.planar && !proved(&place(&packing, k))
    };
    if options.rotations == Rotations::Free && free.par_iter().enumerate().any(is_folded) {
        packing = pack_pieces(&pieces, PackingOptions { rotations: Rotations::Quarter, ..options });
    }
    for (k, &chart) in free.iter().enumerate() {
        laid[chart] = Some(place(&packing, k));
    }
    let covered = pieces.iter().map(|piece| piece.area).sum::<f64>() * packing.scale.powi(2);
    let pixels = f64::from(packing.picture.x) * f64::from(packing.picture.y);
    let density = packing.scale;
    let packing =
        PackingSummary { picture: packing.picture.to_array(), gap: options.gap, density, covered: covered / pixels };
    let coordinates = laid.into_iter().flatten().collect();
    output(charts, coordinates, (!free.is_empty()).then_some(packing), options)
}

/// Whole u at which packed charts begin: to the right of the charts with pins, or 0 if there are none.
fn first_column_beside(laid: &[Option<Embedding>]) -> f64 {
    let held = laid.iter().flatten().map(Embedding::bounds).fold(Bounds::EMPTY, Bounds::union);
    if held.high.x.is_finite() { held.high.x.max(1.0).ceil() } else { 0.0 }
}

fn pack_pieces(pieces: &[Piece], options: PackingOptions) -> Packing {
    let shapes: Vec<ChartShape> = pieces.iter().map(|piece| piece.shape.clone()).collect();
    pack(&shapes, options, &|| false).expect("a packing that nobody cancels")
}

/// Chart at the area of its surface times the square of its size.
struct Piece {
    /// Factor that scales the embedding.
    factor: f64,
    shape: ChartShape,
    /// Area that the chart covers, at its size.
    area: f64,
}

impl Piece {
    fn new(chart: &SolvedChart<'_>) -> Self {
        let step = &chart.outcome.step;
        let (mesh, embedding) = (step.candidate.mesh(chart.disk()), &step.candidate.solution.embedding);
        let factor = true_area_factor(mesh, embedding) * chart.disk().unit();
        let factor = if factor.is_finite() { factor } else { 1.0 } * chart.size();
        let area = chart.area() * chart.size().powi(2);
        Self { factor, shape: Self::shape(chart, factor), area }
    }

    /// Scales a piece without area up, so that its box has a least extent: otherwise rounding would fold its faces.
    fn grow_to(&mut self, least: f64, chart: &SolvedChart<'_>) {
        let extent = Bounds::of(self.shape.vertices()).size().max_element();
        if extent >= least || least == 0.0 {
            return;
        }
        let unscaled = chart.outcome.step.candidate.solution.embedding.bounds().size().max_element();
        if unscaled > 0.0 && unscaled.is_finite() {
            self.factor = least / unscaled;
            self.shape = Self::shape(chart, self.factor);
        }
    }

    fn shape(chart: &SolvedChart<'_>, factor: f64) -> ChartShape {
        let step = &chart.outcome.step;
        let (mesh, embedding) = (step.candidate.mesh(chart.disk()), &step.candidate.solution.embedding);
        let at = |vertex: &VertexId| embedding[*vertex] * factor;
        if !embedding.iter().all(|z| (*z * factor).is_finite()) {
            return triangles(mesh, at);
        }
        if step.verdict.planar { outline(mesh, at) } else { triangles(mesh, at) }
    }

    /// Texture coordinates of the chart as packed piece `k`, shifted right by `beside`.
    fn laid(&self, chart: &SolvedChart<'_>, packing: &Packing, k: usize, beside: f64) -> Embedding {
        let place = packing.places[k];
        let coordinate = |&z: &DVec2| {
            place.position(z * self.factor, packing.scale) / packing.picture.as_dvec2() + DVec2::new(beside, 0.0)
        };
        chart.outcome.step.candidate.solution.embedding.iter().map(coordinate).collect()
    }
}

/// Shape between the boundary of a planar chart and its holes. A hole whose rim meets itself counts as filled.
fn outline(mesh: &DiskMesh, at: impl Fn(&VertexId) -> DVec2) -> ChartShape {
    let outer: Vec<DVec2> = mesh.boundary_loop().iter().map(&at).collect();
    let rims = mesh.mesh().holes().into_iter().map(|hole| hole.rim.iter().map(&at).collect::<Vec<DVec2>>());
    let winds_alike = |rim: &[DVec2]| turning_number(rim) == turning_number(&outer);
    let holes = rims.filter(|rim| is_simple(rim)).map(|mut rim| {
        if winds_alike(&rim) {
            rim.reverse();
        }
        rim
    });
    let holes: Vec<Vec<DVec2>> = holes.collect();
    ChartShape::new(std::iter::once(outer).chain(holes).collect())
}

/// Shape covered by the faces of a chart that may overlap itself. Faces that are not finite are left out.
fn triangles(mesh: &DiskMesh, at: impl Fn(&VertexId) -> DVec2) -> ChartShape {
    let faces = mesh.mesh().real_triangles().iter().map(|face| face.each_ref().map(&at));
    ChartShape::of_triangles(faces.filter(|corners| corners.iter().all(|corner| corner.is_finite())))
}

impl<'a> SolvedChart<'a> {
    /// Chart with final coordinates and their verdict.
    fn laid(&self, coordinates: Embedding) -> LaidChart<'a> {
        let step = &self.outcome.step;
        let mesh = step.candidate.mesh(self.chart.disk().expect("only a disk has an outcome"));
        let verdict = verdict(mesh, &coordinates);
        let of = self.chart.chart.as_ref().expect("one chart of several");
        let vertex_of = Some(&of.chart.vertex_of[..]);
        let (refinement, held) = (step.candidate.refinement.as_deref(), self.outcome.held());
        LaidChart { mesh, refinement, vertex_of, coordinates, verdict, held }
    }

    fn disk(&self) -> &'a DiskMesh {
        self.chart.disk().expect("only a disk has an outcome")
    }

    /// Size relative to other packed charts, clamped to [`PackingOptions::SIZES`].
    fn size(&self) -> f64 {
        self.size.clamp(*PackingOptions::SIZES.start(), *PackingOptions::SIZES.end())
    }

    /// Area of the surface, in squared units of the mesh.
    fn area(&self) -> f64 {
        let (disk, mesh) = (self.disk(), self.disk().mesh());
        let areas = disk.real_faces().map(|face| mesh.double_area_vector(face).length() / 2.0);
        areas.sum::<f64>() * disk.unit().powi(2)
    }

    /// Average number of pixels of a picture per unit of length on the surface.
    fn density(&self, coordinates: &Embedding, picture: DVec2) -> f64 {
        let mesh = self.outcome.step.candidate.mesh(self.disk());
        let doubled = |face: FaceId| {
            double_area(mesh.mesh().triangles[face.index()].map(|vertex| coordinates[vertex] * picture)).abs()
        };
        (mesh.real_faces().map(doubled).sum::<f64>() / 2.0 / self.area()).sqrt()
    }

    /// True if the chart has the default size.
    fn has_usual_size(&self) -> bool {
        self.size.to_bits() == 1.0_f64.to_bits()
    }

    /// True if pins place the chart.
    fn is_held(&self) -> bool {
        self.outcome.targets_in_use().next().is_some()
    }

    /// Coordinates placed by the chart's pins or by the given layout, v up.
    fn in_place(&self) -> Embedding {
        let (coordinates, ..) = self.outcome.output(self.disk(), Fit::Unit);
        upright(&coordinates, self.outcome.problem.frame.v_axis).unwrap_or(coordinates)
    }

    /// Edges split by new vertices, each by its sorted ends in the numbering of the repaired mesh.
    fn split_edges(&self) -> Vec<[VertexId; 2]> {
        let edges =
            self.outcome.step.candidate.refinement.as_ref().map(|refinement| refinement.split_edges_of_surface());
        let in_file = |edge: [VertexId; 2]| {
            let mut ends = edge.map(|vertex| self.chart.vertex_in_file(vertex));
            ends.sort_unstable();
            ends
        };
        edges.into_iter().flatten().map(in_file).collect()
    }

    /// Polygons that are written as triangles.
    fn cut_polygons(&self) -> Vec<FaceId> {
        let refinement = self.outcome.step.candidate.refinement.as_ref();
        refinement.map(|refinement| refinement.cut_polygons(self.disk())).unwrap_or_default()
    }

    /// Summary for these coordinates and a picture of this size in pixels.
    pub(super) fn summary(&self, coordinates: &Embedding, picture: DVec2, placement: Placement) -> ChartSummary {
        let step = &self.outcome.step;
        let mesh = step.candidate.mesh(self.disk());
        let is_in_place = placement != Placement::Packed;
        let on_picture = || coordinates.iter().map(|uv| *uv * DVec2::new(picture.x / picture.y, 1.0)).collect();
        let summary =
            if is_in_place { self.outcome.distortion.summary } else { distortion(mesh, &on_picture()).summary };
        // Targets use the v axis of the document.
        let in_document = upright(coordinates, self.outcome.problem.frame.v_axis).filter(|_| is_in_place);
        let pins = pins_summary(self.outcome, in_document.as_ref().unwrap_or(coordinates));
        let pins = pins.renumbered(|vertex| self.chart.vertex_in_file(vertex));
        ChartSummary {
            first_face: FaceId::new(mesh.mesh().polygon(FaceId::new(0))),
            faces: mesh.mesh().real_face_count(),
            pins,
            has_convex_boundary: step.candidate.has_convex_boundary(),
            placement,
            distortion: summary,
            density: self.density(coordinates, picture),
            new_vertices: self.outcome.new_vertex_count(),
        }
    }
}

fn in_order<T: Ord>(list: impl Iterator<Item = T>) -> Vec<T> {
    let mut all: Vec<T> = list.collect();
    all.sort_unstable();
    all
}

fn output<'a>(
    charts: &[SolvedChart<'a>],
    coordinates: Vec<Embedding>,
    packing: Option<PackingSummary>,
    options: PackingOptions,
) -> Atlas<'a> {
    let of_frame = charts[0].outcome.problem.frame.aspect;
    let aspect = packing
        .map_or(of_frame, |PackingSummary { picture: [width, height], .. }| f64::from(width) / f64::from(height));
    let [_, height] = packing.map_or(options.picture, |packing| packing.picture).map(f64::from);
    let picture = DVec2::new(aspect, 1.0) * height;
    let placement = |chart: &SolvedChart<'_>| match packing {
        _ if chart.is_held() => Placement::Pins,
        Some(_) => Placement::Packed,
        None => Placement::File,
    };
    let summary = |(chart, laid): (&SolvedChart<'_>, &Embedding)| chart.summary(laid, picture, placement(chart));
    let summaries = charts.par_iter().zip(&coordinates).map(summary).collect();
    let laid = |(chart, coordinates): (&SolvedChart<'a>, Embedding)| chart.laid(coordinates);
    let laid: Vec<LaidChart<'a>> = charts.par_iter().zip(coordinates).map(laid).collect();
    Atlas {
        verdict: prove_atlas(&laid),
        charts: laid,
        summaries,
        packing,
        aspect,
        split_edges: in_order(charts.iter().flat_map(SolvedChart::split_edges)),
        cut_polygons: in_order(charts.iter().flat_map(SolvedChart::cut_polygons)),
    }
}
