//! Layout of several solved charts: placed beside each other and proved together.
//!
//! A chart with pins stays at its pins, and a locked chart at given coordinates. A chart with one pin takes the scale of
//! the charts with more, or its size and turn at given coordinates. All other charts are packed into the unit square, or into
//! several squares (tiles), around those that stay. If a chart with pins reaches beyond the square, or those that stay
//! leave no room, the others lie to their right. Packed charts share one density, in pixels per unit of length on the
//! surface, times the size that the user gives to each chart. Charts are packed by their shapes, in any rotation unless
//! options forbid it. Rounding can fold a turned chart; then charts are packed again with exact quarter turns. Charts
//! that started from the layout of their file may stay there instead ([`Arrangement::AsGiven`]). Charts with congruent
//! surfaces may share a place ([`Stacking`]).

use std::collections::BTreeSet;

use glam::DVec2;

use super::pieces::{PackedPieces, Piece, PiecesToPack, StayingChart, density_of, first_column_beside, udim_tile};
use super::stacks::{Stackable, stacks};
use super::{
    Fit, LaidChart, Outcome, PackingSummary, PinsSummary, Placement, PreparedMesh, StackedChart, StackedOn,
    pins_summary, prove_atlas, upright,
};
use crate::flatten::true_area_factor;
use crate::geom::{Bounds, ChartShape, PackingOptions, Similarity, Stacking, double_area, is_simple, turning_number};
use crate::mesh::{DiskMesh, FaceId, MeasuredSurface, SurfaceFaces, VertexId};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding};
use crate::verify::{AtlasVerdict, DistortionSummary, distortion, verdict};

/// Least extent of a packed chart without area, relative to the root of the area of all charts: about a pixel of the picture.
const LEAST_EXTENT: f64 = 1e-3;

/// Root of a chart's area, relative to that of all charts, at which the chart counts as one without area.
const NO_AREA: f64 = 1e-9;

/// Distance from given coordinates, relative to their extent, up to which a locked chart takes their numbers.
const AGREEMENT: f64 = 1e-9;

/// Placement of charts without pins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// Packed into the unit square.
    #[default]
    Packed,
    /// Kept at the layout that they started from. If a chart has another start or size, charts overlap there, or charts
    /// may be stacked, the charts without pins are packed.
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
    /// Tile in which the chart must be packed, below the number of tiles of the options. Default: any.
    pub tile: Option<u32>,
    /// Texture coordinates of each vertex of the chart's mesh, v up. The chart stays there, up to the nearest
    /// similarity, and the others are packed around it. Pins have precedence; a single pin moves the chart there.
    /// Default: the chart is packed.
    pub locked: Option<&'a Embedding>,
    /// Number of the chart whose place this chart shares, whatever [`PackingOptions::stack`] is. Both surfaces have to
    /// be congruent or mirror images, their maps planar and without new vertices. Pins have precedence. Default: a
    /// place of its own.
    pub stacked_on: Option<usize>,
    /// Group of the chart, such as its material, which has a picture of its own. Charts that stay at the layout of
    /// their file may overlap charts of other groups there. Default: none.
    pub group: Option<u32>,
}

/// Summary of one chart of an atlas. Vertices have their numbers in the whole repaired mesh.
#[derive(Clone, Debug)]
pub struct ChartSummary {
    /// First face of the chart, by the number of its polygon in the input.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Index of the step.
    pub step: usize,
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
    /// UDIM number of the tile that holds the centre of the chart's box: 1001 + column + 10 · row. Absent left of and
    /// below the first tile, and beyond the tenth column.
    pub tile: Option<u32>,
    /// Number of vertices added to the mesh.
    pub new_vertices: usize,
    /// Place on another chart. Absent for a chart with a place of its own.
    pub stacked: Option<StackedOn>,
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

/// Lays out charts and proves each of them and the whole. `charts` are all charts of one mesh, in order; a mesh of one
/// chart is laid out too.
///
/// # Panics
///
/// If `charts` is empty or a chart has no disk.
pub fn atlas<'a>(charts: &[SolvedChart<'a>], options: PackingOptions, arrangement: Arrangement) -> Atlas<'a> {
    let is_placed = |chart: &SolvedChart<'_>| {
        chart.is_held() || chart.is_locked() || (chart.outcome.step.lies_as_given && chart.has_usual_size())
    };
    let is_stacked = options.stack != Stacking::None || charts.iter().any(|chart| chart.stacked_on.is_some());
    let is_as_given = arrangement == Arrangement::AsGiven && !is_stacked;
    if is_as_given && charts.iter().all(is_placed) {
        let laid = charts.par_iter().map(|chart| chart.kept(options).unwrap_or_else(|| chart.in_place())).collect();
        let in_place = output(charts, laid, vec![None; charts.len()], None, options);
        if in_place.verdict.overlapping_faces.is_empty() {
            return in_place;
        }
    }
    packed(charts, options)
}

fn packed<'a>(charts: &[SolvedChart<'a>], options: PackingOptions) -> Atlas<'a> {
    let mut laid = kept(charts, options);
    let stacked = stacked_charts(charts, options.stack);
    for (laid, _) in laid.iter_mut().zip(&stacked).filter(|(_, stacked)| stacked.is_some()) {
        *laid = None;
    }
    let plan = PackingPlan::new(charts, &laid, &stacked, options);
    let packing = plan.pack(&laid, options);
    let summary = plan.summary(&packing, &laid, options);
    for (k, &chart) in plan.free.iter().enumerate() {
        laid[chart] = Some(plan.laid(&packing, k));
    }
    for (chart, on) in stacked.iter().enumerate().filter_map(|(chart, on)| Some((chart, on.as_ref()?))) {
        laid[chart] = laid[on.on.chart].as_ref().map(|representative| on.coordinates(representative));
    }
    let coordinates = laid.into_iter().flatten().collect();
    output(charts, coordinates, stacked, (!plan.free.is_empty()).then_some(summary), options)
}

/// Coordinates of the charts that stay. A chart with one pin is scaled about it, so that its scale is that of the charts
/// with more pins. One with given coordinates keeps the size and turn that it has there.
fn kept(charts: &[SolvedChart<'_>], options: PackingOptions) -> Vec<Option<Embedding>> {
    let mut laid: Vec<Option<Embedding>> = charts.par_iter().map(|chart| chart.kept(options)).collect();
    let plane = DVec2::new(charts[0].outcome.problem.frame.aspect, 1.0);
    let pins = |chart: &SolvedChart<'_>| chart.outcome.targets_in_use().take(2).count();
    let with_one = charts.par_iter().zip(&mut laid).filter(|(chart, _)| pins(chart) == 1);
    with_one.for_each(|(chart, laid)| {
        if let Some(there) = chart.at_pin_over_place(options) {
            *laid = Some(there);
        }
    });
    let areas = charts.iter().zip(&laid).filter(|(chart, _)| pins(chart) > 1);
    let areas = areas.filter_map(|(chart, laid)| Some([chart.area_on(laid.as_ref()?, plane), chart.disk().area()]));
    let [in_plane, on_surface] = areas.fold([0.0; 2], |sum, [a, b]| [sum[0] + a, sum[1] + b]);
    let scale = (in_plane / on_surface).sqrt();
    if !(scale.is_finite() && scale > 0.0) {
        return laid;
    }
    let is_sized = |chart: &SolvedChart<'_>| pins(chart) == 1 && chart.locked.is_none();
    let with_one = charts.par_iter().zip(&mut laid).filter(|(chart, _)| is_sized(chart));
    with_one.for_each(|(chart, laid)| {
        let Some(coordinates) = laid else { return };
        let own = (chart.area_on(coordinates, plane) / chart.disk().area()).sqrt();
        let pinned = chart.outcome.targets_in_use().next().map(|(&vertex, _)| coordinates[vertex]);
        let (factor, pin) = (scale / own, pinned.unwrap_or_default());
        let scaled: Embedding = coordinates.iter().map(|&z| (z - pin) * factor + pin).collect();
        let is_planar = |at: &Embedding| verdict(chart.outcome.step.candidate.mesh(chart.disk()), at).planar;
        if factor.is_finite() && (is_planar(&scaled) || !is_planar(coordinates)) {
            *coordinates = scaled;
        }
    });
    laid
}

fn stacked_charts(charts: &[SolvedChart<'_>], stacking: Stacking) -> Vec<Option<StackedChart>> {
    let by_choice: Vec<Option<StackedChart>> = charts.par_iter().map(|chart| chart.stacked_by_choice(charts)).collect();
    if stacking == Stacking::None {
        return by_choice;
    }
    let chosen: BTreeSet<usize> = by_choice.iter().flatten().map(|stacked| stacked.on.chart).collect();
    let stackable = |(number, chart): (usize, &SolvedChart<'_>)| {
        let is_free = by_choice[number].is_none() && !chosen.contains(&number);
        chart.stackable().filter(|_| is_free)
    };
    let by_shape = stacks(&charts.par_iter().enumerate().map(stackable).collect::<Vec<_>>(), stacking);
    by_choice.into_iter().zip(by_shape).map(|(by_choice, by_shape)| by_choice.or(by_shape)).collect()
}

/// Charts that are packed, and those that stay where they are.
struct PackingPlan<'a, 'b> {
    charts: &'b [SolvedChart<'a>],
    /// Numbers of the charts that are packed.
    free: Vec<usize>,
    /// Charts that are packed, at their size.
    pieces: Vec<Piece>,
    /// Shapes of the charts that the others are packed around. Empty if they are packed beside them.
    fixed: Vec<ChartShape>,
    /// Whole u at which the first tile begins if charts are packed beside those that stay.
    beside: f64,
}

impl<'a, 'b> PackingPlan<'a, 'b> {
    /// Charts of a mesh. `laid` has the coordinates of those that stay, and `stacked` those that lie on another. The
    /// rest is packed around those that stay if some are locked or there are several tiles.
    fn new(
        charts: &'b [SolvedChart<'a>],
        laid: &[Option<Embedding>],
        stacked: &[Option<StackedChart>],
        options: PackingOptions,
    ) -> Self {
        let is_free = |chart: &usize| laid[*chart].is_none() && stacked[*chart].is_none();
        let free: Vec<usize> = (0..charts.len()).filter(is_free).collect();
        let mut pieces: Vec<Piece> = free.par_iter().map(|&chart| Piece::new(&charts[chart])).collect();
        let total = pieces.iter().map(|piece| piece.area).sum::<f64>().sqrt();
        for (piece, &chart) in pieces.iter_mut().zip(&free) {
            if piece.area.sqrt() <= NO_AREA * total && total.is_finite() {
                piece.grow_to(LEAST_EXTENT * total, &charts[chart]);
            }
        }
        let is_inside = |laid: &Embedding| Bounds::of(laid.iter().copied()).union(Bounds::UNIT) == Bounds::UNIT;
        let beside = first_column_beside(laid.iter().flatten());
        let leave_the_square = options.tiles <= 1 && !charts.iter().any(SolvedChart::is_locked);
        if leave_the_square && !laid.iter().flatten().all(is_inside) {
            return Self { charts, free, pieces, fixed: Vec::new(), beside };
        }
        let fixed = charts.par_iter().zip(laid).filter_map(|(chart, laid)| Some(chart.fixed_shape(laid.as_ref()?)));
        Self { charts, free, pieces, fixed: fixed.collect(), beside }
    }

    /// Packs the charts. `laid` has the coordinates of those that stay.
    fn pack(&self, laid: &[Option<Embedding>], options: PackingOptions) -> PackedPieces {
        let tiles: Vec<Option<u32>> = self.free.iter().map(|&chart| self.charts[chart].tile).collect();
        let pieces = self.pieces.iter().collect::<Vec<_>>();
        let control = Control::unattended();
        let pieces = PiecesToPack { pieces: &pieces, tiles: &tiles, fixed: &self.fixed, beside: self.beside, control };
        let density_of_fixed = |picture| self.density_of_fixed(laid, picture);
        pieces.pack(options, &density_of_fixed, &|packing| self.has_folds(packing)).expect("nothing cancels it")
    }

    /// Density of the charts that stay on a picture: pixels per unit of length on the surface. `None` if no chart stays.
    fn density_of_fixed(&self, laid: &[Option<Embedding>], on_picture: DVec2) -> Option<f64> {
        density_of(&self.staying(laid, on_picture))
    }

    /// Texture coordinates of packed chart `k`.
    fn laid(&self, packing: &PackedPieces, k: usize) -> Embedding {
        self.pieces[k].laid(self.charts[self.free[k]].embedding(), packing, k)
    }

    /// True if rounding folds a packed chart.
    fn has_folds(&self, packing: &PackedPieces) -> bool {
        let is_folded = |(k, &chart): (usize, &usize)| {
            let solved = &self.charts[chart];
            let proved = |coordinates: &Embedding| {
                verdict(solved.outcome.step.candidate.mesh(solved.disk()), coordinates).planar
            };
            solved.outcome.step.verdict.planar && !proved(&self.laid(packing, k))
        };
        self.free.par_iter().enumerate().any(is_folded)
    }

    /// Charts that stay on a picture. `laid` has their coordinates.
    fn staying<'l>(&self, laid: &'l [Option<Embedding>], picture: DVec2) -> Vec<StayingChart<'l>> {
        let staying = |(chart, laid): (&SolvedChart<'_>, &'l Option<Embedding>)| {
            let coordinates = laid.as_ref()?;
            let area = chart.size.powi(2) * chart.disk().area();
            Some(StayingChart { coordinates, pixels: chart.area_on(coordinates, picture), area })
        };
        self.charts.iter().zip(laid).filter_map(staying).collect()
    }

    /// Summary of a packing. `laid` has the coordinates of the charts that stay.
    fn summary(&self, packed: &PackedPieces, laid: &[Option<Embedding>], options: PackingOptions) -> PackingSummary {
        let area = self.pieces.iter().map(|piece| piece.area).sum();
        packed.summary(options, area, &self.staying(laid, packed.packing.picture.as_dvec2()))
    }
}

impl Piece {
    fn new(chart: &SolvedChart<'_>) -> Self {
        let step = &chart.outcome.step;
        let (mesh, embedding) = (step.candidate.mesh(chart.disk()), &step.candidate.solution.embedding);
        let factor = true_area_factor(mesh, embedding) * chart.disk().unit();
        let factor = if factor.is_finite() { factor } else { 1.0 } * chart.size();
        let area = chart.disk().area() * chart.size().powi(2);
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
            return triangles_of(mesh.mesh().real_triangles(), at);
        }
        if step.verdict.planar { outline(mesh, at) } else { triangles_of(mesh.mesh().real_triangles(), at) }
    }
}

/// Shape between the boundary of a planar chart and its holes.
fn outline(mesh: &DiskMesh, at: impl Fn(&VertexId) -> DVec2) -> ChartShape {
    let outer: Vec<DVec2> = mesh.boundary_loop().iter().map(&at).collect();
    let rims = mesh.mesh().holes().into_iter().map(|hole| hole.rim.iter().map(&at).collect::<Vec<DVec2>>());
    outline_of_loops(outer, rims)
}

/// Shape between an outer loop and holes, of any directions. A hole whose rim meets itself counts as filled.
pub(super) fn outline_of_loops(outer: Vec<DVec2>, rims: impl IntoIterator<Item = Vec<DVec2>>) -> ChartShape {
    let winds_alike = |rim: &[DVec2]| turning_number(rim) == turning_number(&outer);
    let holes = rims.into_iter().filter(|rim| is_simple(rim)).map(|mut rim| {
        if winds_alike(&rim) {
            rim.reverse();
        }
        rim
    });
    let holes: Vec<Vec<DVec2>> = holes.collect();
    ChartShape::new(std::iter::once(outer).chain(holes).collect())
}

/// Shape covered by the faces of a chart that may overlap itself. Faces that are not finite are left out.
pub(super) fn triangles_of(triangles: &[[VertexId; 3]], at: impl Fn(&VertexId) -> DVec2) -> ChartShape {
    let faces = triangles.iter().map(|face| face.each_ref().map(&at));
    ChartShape::of_triangles(faces.filter(|corners| corners.iter().all(|corner| corner.is_finite())))
}

impl<'a> SolvedChart<'a> {
    /// Chart of default size that is packed into any tile.
    pub fn new(chart: &'a PreparedMesh, outcome: &'a Outcome) -> Self {
        Self { chart, outcome, size: 1.0, tile: None, locked: None, stacked_on: None, group: None }
    }

    /// True if the surfaces of both charts are congruent or mirror images, and both maps are planar and without new
    /// vertices. Then one chart can share the place of the other.
    pub fn is_congruent_to(&self, other: &Self) -> bool {
        let surfaces = self.measured_surface().zip(other.measured_surface());
        surfaces.is_some_and(|(own, other)| own.congruence(&other, true).is_some())
    }

    /// Chart with final coordinates and their verdict.
    fn laid(&self, coordinates: Embedding) -> LaidChart<'a> {
        let step = &self.outcome.step;
        let mesh = step.candidate.mesh(self.chart.disk().expect("only a disk has an outcome"));
        let verdict = verdict(mesh, &coordinates);
        let vertex_of = self.chart.chart.as_ref().map(|of| &of.chart.vertex_of[..]);
        let (refinement, held) = (step.candidate.refinement.as_deref(), self.outcome.held());
        LaidChart { mesh, refinement, vertex_of, coordinates, verdict, held, stacked: None, group: self.group }
    }

    /// Surface of the chart, if the chart may share its place: it is not locked, and has no pins, a planar map and no
    /// new vertices.
    fn stackable(&self) -> Option<Stackable> {
        if self.is_held() || self.is_locked() {
            return None;
        }
        Some(Stackable { surface: self.measured_surface()?, size: self.size(), tile: self.tile })
    }

    /// Place on the chart that the user chose, if there is one and it fits. A chart that is stacked itself carries no
    /// other.
    fn stacked_by_choice(&self, charts: &[Self]) -> Option<StackedChart> {
        let chart = self.stacked_on.filter(|_| !self.is_held())?;
        let on = charts.get(chart).filter(|on| on.stacked_on.is_none())?;
        let found = self.measured_surface()?.congruence(&on.measured_surface()?, true)?;
        Some(StackedChart { on: StackedOn { chart, mirrored: found.mirrored }, vertex_of: found.vertex_of })
    }

    /// Surface of the chart, if its map is planar and without new vertices.
    fn measured_surface(&self) -> Option<MeasuredSurface> {
        let step = &self.outcome.step;
        if !step.verdict.planar || step.candidate.refinement.is_some() {
            return None;
        }
        let disk = self.disk();
        let positions: Vec<_> = disk.mesh().positions.iter().map(|position| *position * disk.unit()).collect();
        let (triangles, outer) = (disk.mesh().real_triangles(), disk.boundary_loop());
        let faces = SurfaceFaces { triangles, outer, area: self.disk().area() };
        MeasuredSurface::new(&positions, faces, disk.polygons(), None)
    }

    /// Solution of the step to lay out.
    fn embedding(&self) -> &'a Embedding {
        &self.outcome.step.candidate.solution.embedding
    }

    fn disk(&self) -> &'a DiskMesh {
        self.chart.disk().expect("only a disk has an outcome")
    }

    /// Size relative to other packed charts, clamped to [`PackingOptions::SIZES`].
    fn size(&self) -> f64 {
        self.size.clamp(*PackingOptions::SIZES.start(), *PackingOptions::SIZES.end())
    }

    /// Average number of pixels of a picture per unit of length on the surface.
    fn density(&self, coordinates: &Embedding, picture: DVec2) -> f64 {
        (self.area_on(coordinates, picture) / self.disk().area()).sqrt()
    }

    /// Area of the chart on a picture, in pixels.
    fn area_on(&self, coordinates: &Embedding, picture: DVec2) -> f64 {
        let mesh = self.outcome.step.candidate.mesh(self.disk());
        let doubled = |face: FaceId| {
            double_area(mesh.mesh().triangles[face.index()].map(|vertex| coordinates[vertex] * picture)).abs()
        };
        mesh.real_faces().map(doubled).sum::<f64>() / 2.0
    }

    /// True if the chart has the default size.
    fn has_usual_size(&self) -> bool {
        self.size.to_bits() == 1.0_f64.to_bits()
    }

    /// True if pins place the chart.
    fn is_held(&self) -> bool {
        self.outcome.targets_in_use().next().is_some()
    }

    /// True if the chart is locked and no pins place it.
    fn is_locked(&self) -> bool {
        self.locked.is_some() && !self.is_held()
    }

    /// Coordinates of a chart that stays: on its pins, or where it is locked. `None` if the chart is packed.
    fn kept(&self, options: PackingOptions) -> Option<Embedding> {
        if self.is_held() { Some(self.in_place()) } else { self.locked.map(|given| self.laid_over(given, options)) }
    }

    /// Coordinates of a chart with one pin by the size and turn that it has at given ones, with its pin at its target.
    /// `None` without given coordinates, and if the chart lies mirrored there or would fold by rounding.
    fn at_pin_over_place(&self, options: PackingOptions) -> Option<Embedding> {
        let there = self.laid_over(self.locked?, options);
        let (&pin, _) = self.outcome.targets_in_use().next()?;
        let target = self.in_place()[pin];
        let by = target - there[pin];
        let mut moved: Embedding = there.iter().map(|&at| at + by).collect();
        moved[pin] = target;
        let verdict = verdict(self.outcome.step.candidate.mesh(self.disk()), &moved);
        (verdict.planar && !verdict.mirrored).then_some(moved)
    }

    /// Coordinates by the similarity of a plane that is nearest to given ones, mirrored if that is nearer. Given numbers
    /// are taken as they are if they agree with it. The given numbers are for the frame of the problem or for the picture
    /// that charts are packed into: the one in which they agree better.
    fn laid_over(&self, given: &Embedding, options: PackingOptions) -> Embedding {
        let [width, height] = options.picture.map(f64::from);
        let aspects = [self.outcome.problem.frame.aspect, width / height];
        let fits = aspects.into_iter().flat_map(|aspect| {
            let signed = [DVec2::new(aspect, 1.0), DVec2::new(-aspect, 1.0)];
            signed.map(|plane| self.fitted_in(plane, given))
        });
        let nearer = |best: (Embedding, f64), next: (Embedding, f64)| if next.1 < best.1 { next } else { best };
        fits.reduce(nearer).expect("a fit").0
    }

    /// Coordinates by the similarity that is nearest to given ones if they are multiplied by `plane`, and its largest
    /// distance from them, relative to their extent.
    fn fitted_in(&self, plane: DVec2, given: &Embedding) -> (Embedding, f64) {
        let candidate = &self.outcome.step.candidate;
        let (embedding, mesh) = (&candidate.solution.embedding, candidate.mesh(self.disk()));
        let virtual_vertices: BTreeSet<VertexId> = mesh.virtual_vertices().into_iter().collect();
        let is_given = |vertex: &VertexId| vertex.index() < given.len() && !virtual_vertices.contains(vertex);
        let pair = |vertex: VertexId| [embedding[vertex], given[vertex] * plane];
        let pairs: Vec<[DVec2; 2]> = mesh.vertices().filter(is_given).map(pair).collect();
        let Some(similarity) = Similarity::fitting(&pairs) else {
            let at = |vertex: usize| given.get(vertex).or(given.first()).copied().unwrap_or_default();
            return ((0..mesh.vertex_count()).map(at).collect(), f64::INFINITY);
        };
        let extent = Bounds::of(pairs.iter().map(|[_, to]| *to)).size().max_element();
        let distances = pairs.iter().map(|[from, to]| similarity.apply(*from).distance(*to));
        let distance = distances.fold(0.0, f64::max) / extent;
        let agrees = distance <= AGREEMENT;
        let laid = |vertex: VertexId| {
            if agrees && is_given(&vertex) { given[vertex] } else { similarity.apply(embedding[vertex]) / plane }
        };
        (mesh.vertices().map(laid).collect(), distance)
    }

    /// True if the chart is locked at its mirror image.
    fn is_mirrored(&self, coordinates: &Embedding) -> bool {
        let mesh = self.outcome.step.candidate.mesh(self.disk()).mesh();
        let doubled = |corners: &[VertexId; 3]| double_area(corners.map(|vertex| coordinates[vertex]));
        self.is_locked() && mesh.real_triangles().iter().map(doubled).sum::<f64>() < 0.0
    }

    /// Shape of the chart at coordinates that stay.
    fn fixed_shape(&self, coordinates: &Embedding) -> ChartShape {
        let mesh = self.outcome.step.candidate.mesh(self.disk());
        let at = |vertex: &VertexId| coordinates[*vertex];
        if verdict(mesh, coordinates).planar {
            outline(mesh, at)
        } else {
            triangles_of(mesh.mesh().real_triangles(), at)
        }
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
        // A locked chart keeps its coordinates even if the picture changes its shape.
        let is_measured = matches!(placement, Placement::Packed | Placement::Locked);
        let summary =
            if is_measured { distortion(mesh, &on_picture()).summary } else { self.outcome.distortion.summary };
        // Targets use the v axis of the document.
        let in_document = upright(coordinates, self.outcome.problem.frame.v_axis).filter(|_| is_in_place);
        let pins = pins_summary(self.outcome, in_document.as_ref().unwrap_or(coordinates));
        let pins = pins.renumbered(|vertex| self.chart.vertex_in_file(vertex));
        ChartSummary {
            first_face: FaceId::new(mesh.mesh().polygon(FaceId::new(0))),
            faces: mesh.mesh().real_face_count(),
            step: step.index,
            pins,
            has_convex_boundary: step.candidate.has_convex_boundary(),
            placement,
            distortion: summary,
            density: self.density(coordinates, picture),
            tile: udim_tile(coordinates),
            new_vertices: self.outcome.new_vertex_count(),
            stacked: None,
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
    stacked: Vec<Option<StackedChart>>,
    packing: Option<PackingSummary>,
    options: PackingOptions,
) -> Atlas<'a> {
    let [width, height] = options.picture.map(f64::from);
    let lies_on_page = charts.iter().any(SolvedChart::is_locked) && !charts.iter().any(SolvedChart::is_held);
    let of_frame = if lies_on_page { width / height } else { charts[0].outcome.problem.frame.aspect };
    let aspect = packing
        .map_or(of_frame, |PackingSummary { picture: [width, height], .. }| f64::from(width) / f64::from(height));
    let [_, height] = packing.map_or(options.picture, |packing| packing.picture).map(f64::from);
    let picture = DVec2::new(aspect, 1.0) * height;
    let placement = |chart: &SolvedChart<'_>| match packing {
        _ if chart.is_held() => Placement::Pins,
        _ if chart.is_locked() => Placement::Locked,
        Some(_) => Placement::Packed,
        None => Placement::File,
    };
    let summary = |((chart, laid), stacked): ((&SolvedChart<'_>, &Embedding), &Option<StackedChart>)| {
        let stacked = stacked.as_ref().map(|stacked| stacked.on);
        // The distortion of a mirror image is measured in the mirror.
        let is_mirrored = stacked.map_or_else(|| chart.is_mirrored(laid), |on| on.mirrored);
        let upright = is_mirrored.then(|| laid.iter().map(|z| DVec2::new(-z.x, z.y)).collect());
        let summary = chart.summary(upright.as_ref().unwrap_or(laid), picture, placement(chart));
        ChartSummary { stacked, tile: udim_tile(laid), ..summary }
    };
    let summaries = charts.par_iter().zip(&coordinates).zip(&stacked).map(summary).collect();
    let laid = |((chart, coordinates), stacked): ((&SolvedChart<'a>, Embedding), Option<StackedChart>)| LaidChart {
        stacked,
        ..chart.laid(coordinates)
    };
    let laid: Vec<LaidChart<'a>> = charts.par_iter().zip(coordinates).zip(stacked).map(laid).collect();
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
