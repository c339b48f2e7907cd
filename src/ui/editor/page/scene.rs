//! Data for drawing and picking all charts on the page, made off the UI thread.

use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::session::{ChartPage, Model, PageChart};
use crate::ui::editor::colour_table::ShownColumn;
use crate::ui::editor::in_file::vertices_in_file;
use crate::ui::editor::paint::{Legend, column_paint};
use crate::ui::state::ShadingMode;
use crate::view::{
    EdgeList, ElementMesh, FacePaint, MeshArrays, MeshPart, PlaneArrays, Quantity, Ray, Sphere, SurfacePicker,
    VertexSets,
};
use freebound_core::geom::{Bounds, winding_number};
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::FaceDistortion;

/// Inputs of a scene: revisions of the page and of the mesh on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PageKey {
    pub(super) page: u64,
    pub(super) model: u64,
}

/// Space of a mesh scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageSpace {
    /// Length of the file's unit: positions are divided by it.
    pub(super) unit: f64,
    pub(super) sphere: Sphere,
}

/// All charts on the page. Vertices and faces of each chart follow those of the chart before.
#[derive(Clone, Debug)]
pub(in crate::ui) struct PageScene {
    pub(super) key: PageKey,
    pub(in crate::ui) mesh: Arc<MeshArrays>,
    pub(in crate::ui) plane: Arc<PlaneArrays>,
    pub(in crate::ui) spans: Arc<Vec<ChartSpan>>,
    /// Outlines and rims of holes of all charts.
    pub(in crate::ui) outlines: Arc<EdgeList>,
    /// Bounds of the outer loop of each chart in the page's plane.
    bounds: Vec<Bounds>,
    /// Position of each vertex in the page's plane.
    pub(super) places: Arc<Vec<DVec2>>,
    pub(super) picker: Arc<SurfacePicker>,
    /// Charts and their steps, for colours.
    pub(super) charts: Vec<PageChart>,
    /// Width over height of the page.
    pub(in crate::ui) aspect: f64,
}

/// Vertices and faces of a chart in a scene.
#[derive(Clone, Debug)]
pub(in crate::ui) struct ChartSpan {
    pub(super) vertices: Range<usize>,
    pub(super) faces: Range<usize>,
    /// Outer loop, and the rims of holes.
    loops: Vec<Vec<VertexId>>,
}

impl ChartSpan {
    fn moved_by(&self, count: usize, faces: usize) -> Self {
        let by = |range: &Range<usize>, by: usize| range.start + by..range.end + by;
        let moved = |rim: &Vec<VertexId>| rim.iter().map(|v| VertexId::from_index(v.index() + count)).collect();
        let loops = self.loops.iter().map(moved).collect();
        Self { vertices: by(&self.vertices, count), faces: by(&self.faces, faces), loops }
    }

    fn of(chart: &PageChart) -> Self {
        let mesh = chart.mesh();
        let rims = mesh.mesh().holes().into_iter().map(|hole| hole.rim);
        let loops = std::iter::once(mesh.boundary_loop().to_vec()).chain(rims).collect();
        Self { vertices: 0..mesh.vertex_count(), faces: 0..mesh.mesh().real_face_count(), loops }
    }
}

impl PageScene {
    /// Scene of a page in the space of a mesh scene. Reuses the mesh of a scene with the same steps.
    pub(super) fn new(key: PageKey, page: &ChartPage, space: PageSpace, before: Option<&Self>) -> Self {
        let is_same = |(a, b): (&PageChart, &PageChart)| Arc::ptr_eq(&a.outcome, &b.outcome);
        let before = before.filter(|before| {
            before.key.model == key.model
                && before.charts.len() == page.charts.len()
                && before.charts.iter().zip(&page.charts).all(is_same)
        });
        let plane = DVec2::new(page.aspect, 1.0);
        let uv = page.charts.iter().flat_map(|chart| chart.coordinates.iter());
        let places: Vec<DVec2> = uv.map(|uv| *uv * plane).collect();
        let (mesh, picker, spans, outlines) = match before {
            Some(Self { mesh, picker, spans, outlines, .. }) => {
                (Arc::clone(mesh), Arc::clone(picker), Arc::clone(spans), Arc::clone(outlines))
            }
            None => meshes(&page.charts, space),
        };
        let at = |vertex: &VertexId| places[vertex.index()];
        let outer = |span: &ChartSpan| Bounds::of(span.loops[0].iter().map(at).filter(|at| at.is_finite()));
        Self {
            key,
            bounds: spans.iter().map(outer).collect(),
            plane: Arc::new(PlaneArrays::new(&places, &mesh.triangles)),
            mesh,
            spans,
            outlines,
            places: Arc::new(places),
            picker,
            charts: page.charts.clone(),
            aspect: page.aspect,
        }
    }

    /// Bounds of the page: width and height of the first tile.
    pub(in crate::ui) fn page_box(&self) -> Bounds {
        Bounds { low: DVec2::ZERO, high: DVec2::new(self.aspect, 1.0) }
    }

    /// Bounds of the page and of all charts in the plane.
    pub(super) fn whole(&self) -> Bounds {
        self.page_box().union(self.plane.bounds)
    }

    /// Bounds of charts in the plane.
    pub(in crate::ui) fn bounds_of(&self, charts: impl IntoIterator<Item = usize>) -> Bounds {
        let there = charts.into_iter().filter_map(|chart| self.bounds.get(chart));
        there.fold(Bounds::EMPTY, |all, own| all.union(*own))
    }

    /// Points of charts in space.
    pub(in crate::ui) fn points_of(&self, charts: impl IntoIterator<Item = usize>) -> Vec<DVec3> {
        let spans = charts.into_iter().filter_map(|chart| self.spans.get(chart));
        let points = spans.flat_map(|span| &self.mesh.points[span.vertices.clone()]);
        let Sphere { center, radius } = self.mesh.frame;
        points.map(|&[x, y, z]| center + radius * DVec3::new(x.into(), y.into(), z.into())).collect()
    }

    /// Elements of all charts.
    pub(in crate::ui) fn elements(&self) -> ElementMesh<'_> {
        let sets = VertexSets { positions: self.picker.positions(), triangles: &self.mesh.triangles };
        let parts = self.charts.iter().zip(self.spans.iter()).map(|(chart, span)| MeshPart {
            disk: chart.mesh(),
            first_vertex: span.vertices.start,
            first_face: span.faces.start,
        });
        ElementMesh::new(sets, parts.collect())
    }

    /// Chart of a vertex, and the vertex on that chart.
    pub(in crate::ui) fn on_chart(&self, vertex: VertexId) -> Option<(usize, VertexId)> {
        let chart = self.spans.partition_point(|span| span.vertices.end <= vertex.index());
        let span = self.spans.get(chart)?;
        Some((chart, VertexId::from_index(vertex.index() - span.vertices.start)))
    }

    /// Vertex of the page for a vertex of a chart.
    pub(in crate::ui) fn of_chart(&self, chart: usize, vertex: VertexId) -> Option<VertexId> {
        let span = self.spans.get(chart).filter(|span| vertex.index() < span.vertices.len())?;
        Some(VertexId::from_index(span.vertices.start + vertex.index()))
    }

    /// Ends of the edge that a new vertex splits, on the page. `None` for a vertex that the file has.
    pub(super) fn split_edge(&self, vertex: VertexId) -> Option<[VertexId; 2]> {
        let (chart, own) = self.on_chart(vertex)?;
        let refinement = self.charts[chart].outcome.step.candidate.refinement.as_ref()?;
        let new = refinement.new_vertices().get(own.index().checked_sub(refinement.old_vertex_count())?)?;
        let [a, b] = new.edge.map(|end| self.of_chart(chart, end));
        Some([a?, b?])
    }

    /// Chart of a triangle.
    pub(in crate::ui) fn chart_of_face(&self, face: FaceId) -> Option<usize> {
        let chart = self.spans.partition_point(|span| span.faces.end <= face.index());
        (chart < self.spans.len()).then_some(chart)
    }

    /// Chart of a triangle, and the number in files of its face.
    pub(in crate::ui) fn face_number(&self, face: FaceId) -> Option<(usize, FaceId)> {
        let chart = self.chart_of_face(face)?;
        let local = FaceId::from_index(face.index() - self.spans[chart].faces.start);
        Some((chart, FaceId::new(self.charts[chart].mesh().mesh().polygon(local))))
    }

    /// Model of a chart.
    pub(in crate::ui) fn model_of(&self, chart: usize) -> Option<&Model> {
        self.charts.get(chart).map(|chart| chart.model.as_ref())
    }

    /// Position of a vertex in the plane.
    pub(in crate::ui) fn place_of(&self, vertex: VertexId) -> Option<DVec2> {
        self.places.get(vertex.index()).copied()
    }

    /// Positions of all vertices in the plane.
    pub(in crate::ui) fn places(&self) -> &[DVec2] {
        &self.places
    }

    /// Positions of vertices in space.
    pub(in crate::ui) fn positions_of<'a>(&'a self, vertices: impl IntoIterator<Item = &'a VertexId>) -> Vec<DVec3> {
        vertices.into_iter().filter_map(|vertex| self.picker.positions().get(vertex.index()).copied()).collect()
    }

    /// True if both scenes are of one file.
    pub(super) fn is_of_file_of(&self, other: &Self) -> bool {
        let source = |scene: &Self| Some(Arc::clone(&scene.charts.first()?.model.source));
        source(self).zip(source(other)).is_some_and(|(own, others)| Arc::ptr_eq(&own, &others))
    }

    /// True if the mesh is cut into the charts of another scene.
    pub(super) fn is_cut_like(&self, other: &Self) -> bool {
        let charts = |scene: &Self| Some(Arc::clone(&scene.charts.first()?.model.prepared.chart.as_ref()?.charts));
        charts(self).zip(charts(other)).is_some_and(|(own, others)| Arc::ptr_eq(&own, &others))
    }

    /// True if all charts have as many vertices and faces as on another scene.
    pub(super) fn has_numbers_of(&self, other: &Self) -> bool {
        let numbers = |span: &ChartSpan| (span.vertices.clone(), span.faces.clone());
        self.spans.iter().map(numbers).eq(other.spans.iter().map(numbers))
    }

    /// Positions of a loop's vertices in the plane.
    fn rim<'a>(&'a self, rim: &'a [VertexId]) -> impl Iterator<Item = DVec2> + 'a {
        rim.iter().map(|vertex| self.places[vertex.index()])
    }

    /// Outlines of a chart in the plane.
    pub(in crate::ui) fn outlines_of(&self, chart: usize) -> impl Iterator<Item = Vec<DVec2>> + '_ {
        let span = self.spans.get(chart).into_iter();
        span.flat_map(|span| &span.loops).map(|rim| self.rim(rim).collect())
    }

    /// Outlines of charts, as edges.
    pub(super) fn edges_of<'a>(&'a self, charts: impl IntoIterator<Item = &'a usize>) -> EdgeList {
        let spans = charts.into_iter().filter_map(|&chart| self.spans.get(chart));
        EdgeList::closed_loops(spans.flat_map(|span| &span.loops).map(Vec::as_slice))
    }

    /// Chart that covers a point of the plane. Of charts that overlap, the smallest.
    pub(in crate::ui) fn chart_at(&self, point: DVec2) -> Option<usize> {
        let covers = |rim: &[VertexId]| {
            let outline: Vec<DVec2> = self.rim(rim).collect();
            winding_number(&outline, point).is_none_or(|winds| winds != 0)
        };
        let is_under = |&chart: &usize| {
            self.bounds[chart].contains(point) && {
                let loops = &self.spans[chart].loops;
                loops.first().is_some_and(|outer| covers(outer)) && !loops[1..].iter().any(|rim| covers(rim))
            }
        };
        let size = |chart: &usize| self.bounds[*chart].diameter();
        let is_own = |chart: &usize| self.charts[*chart].stacked.is_none();
        let under = (0..self.spans.len()).filter(is_own).filter(is_under);
        under.min_by(|a, b| size(a).total_cmp(&size(b)))
    }

    /// Chart that covers a point of the plane, or else the chart with the nearest vertex of an outline within a distance.
    pub(in crate::ui) fn chart_near(&self, point: DVec2, distance: f64) -> Option<usize> {
        let is_own = |chart: &usize| self.charts[*chart].stacked.is_none();
        let within = |chart: &usize| {
            let Bounds { low, high } = self.bounds[*chart];
            Bounds { low: low - distance, high: high + distance }.contains(point)
        };
        let away = |chart: usize| {
            let outline = self.outlines_of(chart).flatten();
            (outline.map(|at| at.distance(point)).fold(f64::INFINITY, f64::min), chart)
        };
        let nearest = || {
            let near = (0..self.spans.len()).filter(is_own).filter(within).map(away);
            let least = near.min_by(|(a, _), (b, _)| a.total_cmp(b));
            least.filter(|(away, _)| *away <= distance).map(|(_, chart)| chart)
        };
        self.chart_at(point).or_else(nearest)
    }

    /// Charts with a point of their outlines at a place that counts. `is_inside` decides about places.
    pub(in crate::ui) fn charts_within(&self, is_inside: impl Fn(DVec2) -> bool) -> Vec<usize> {
        let is_within = |&chart: &usize| self.outlines_of(chart).flatten().any(&is_inside);
        (0..self.spans.len()).filter(is_within).collect()
    }

    /// Picking on the surface of all charts.
    pub(in crate::ui) fn surface_picker(&self) -> &SurfacePicker {
        &self.picker
    }

    /// Point of the surface that a ray meets first.
    pub(in crate::ui) fn picker_hit(&self, ray: Ray) -> Option<DVec3> {
        self.picker.hit(ray).map(|hit| hit.point)
    }

    /// True if a vertex of a chart is seen from the eye at a place that counts. Without an eye, hidden vertices count,
    /// too. `is_inside` decides about places.
    pub(in crate::ui) fn has_vertex_within(
        &self,
        chart: usize,
        eye: Option<DVec3>,
        is_inside: impl Fn(DVec3) -> bool,
    ) -> bool {
        let vertices = self.spans.get(chart).into_iter().flat_map(|span| span.vertices.clone());
        let mut vertices = vertices.map(VertexId::from_index).zip(self.points_of([chart]));
        vertices.any(|(vertex, at)| is_inside(at) && eye.is_none_or(|eye| self.picker.is_visible(vertex, eye)))
    }

    /// Chart that a ray meets first.
    pub(in crate::ui) fn chart_hit(&self, ray: Ray) -> Option<usize> {
        self.picker.hit(ray).and_then(|hit| self.chart_of_face(hit.face))
    }

    /// Arrays of the plane with charts at other texture coordinates.
    pub(super) fn moved(&self, charts: &[(usize, Arc<Embedding>)]) -> PlaneArrays {
        let plane = DVec2::new(self.aspect, 1.0);
        let mut places = self.places.to_vec();
        for (chart, coordinates) in charts {
            if let Some(span) = self.spans.get(*chart) {
                places[span.vertices.clone()].iter_mut().zip(coordinates.iter()).for_each(|(at, uv)| *at = *uv * plane);
            }
        }
        PlaneArrays::in_frame(&places, &self.mesh.triangles, self.plane.frame)
    }

    /// Colours of all faces by a column of a table, with their legend.
    pub(super) fn paint_by_column(&self, column: ShownColumn<'_>) -> (FacePaint, Option<Legend>) {
        // All charts belong to one file.
        let in_file = self.charts.first().and_then(|chart| vertices_in_file(&chart.model));
        let of_chart = |chart: &PageChart| column.values_on(chart.mesh().mesh(), &chart.model, in_file.as_deref());
        let values: Vec<f64> = self.charts.iter().flat_map(of_chart).collect();
        let (paint, legend) = column_paint(&values, &self.flipped());
        (paint, Some(legend))
    }

    /// Distortion of the triangles of each chart.
    pub(in crate::ui) fn distortion(&self) -> Vec<&[FaceDistortion]> {
        self.charts.iter().map(|chart| chart.outcome.distortion.faces.as_slice()).collect()
    }

    /// Flipped faces of all charts.
    fn flipped(&self) -> Vec<FaceId> {
        self.charts.iter().zip(self.spans.iter()).flat_map(|(chart, span)| flipped_faces(chart, span)).collect()
    }

    /// Colours of all faces, with a legend if the shading shows numbers. Areas and stretches are relative to the mean
    /// scale of the page, so that charts of different density differ in colour.
    pub(super) fn paint(&self, shading: ShadingMode) -> (FacePaint, Option<Legend>) {
        let flipped = self.flipped();
        let Some(quantity) = shading.quantity() else {
            return (FacePaint::plain(self.mesh.triangles.len(), &flipped), None);
        };
        let areas: Vec<[f64; 2]> = self.charts.iter().map(|chart| areas_of(chart, self.aspect)).collect();
        let [in_plane, on_surface] = areas.iter().fold([0.0; 2], |sum, [a, b]| [sum[0] + a, sum[1] + b]);
        let values = self.charts.iter().zip(&areas).flat_map(|(chart, [own_plane, own_surface])| {
            let factor = (own_plane / own_surface) / (in_plane / on_surface);
            let factor = if factor.is_finite() && factor > 0.0 { factor } else { 1.0 };
            quantity.values(&chart.outcome.distortion).into_iter().map(move |value| match quantity {
                Quantity::Angle => value,
                Quantity::Area => value + factor.log2(),
                Quantity::Stretch => value * factor.sqrt(),
            })
        });
        let values: Vec<f64> = values.collect();
        let range = quantity.scale().robust_range(&values);
        let paint = FacePaint::by_value(&values, quantity.scale(), range, &flipped);
        (paint, Some(Legend::new(quantity.scale(), range, &values)))
    }
}

fn flipped_faces<'a>(chart: &'a PageChart, span: &'a ChartSpan) -> impl Iterator<Item = FaceId> + 'a {
    let flipped = chart.outcome.step.verdict.flipped_faces.iter();
    flipped.map(|face| FaceId::from_index(span.faces.start + face.index()))
}

/// Area of a chart on the page, and on the surface.
fn areas_of(chart: &PageChart, aspect: f64) -> [f64; 2] {
    let mesh = chart.mesh();
    let plane = DVec2::new(aspect, 1.0);
    let corners = mesh.mesh().real_triangles().iter().map(|corners| corners.map(|v| chart.coordinates[v] * plane));
    let doubled: f64 = corners.map(|[a, b, c]| (b - a).perp_dot(c - a)).sum();
    [doubled.abs() / 2.0, chart.model.disk().map_or(0.0, |disk| disk.area())]
}

/// Meshes of all charts in one, their picker, their spans and their outlines.
fn meshes(
    charts: &[PageChart],
    PageSpace { unit, sphere }: PageSpace,
) -> (Arc<MeshArrays>, Arc<SurfacePicker>, Arc<Vec<ChartSpan>>, Arc<EdgeList>) {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let mut spans = Vec::new();
    for chart in charts {
        let (mesh, first) = (chart.mesh(), positions.len());
        let scale = chart.model.disk().map_or(1.0, |disk| disk.unit()) / unit;
        spans.push(ChartSpan::of(chart).moved_by(first, triangles.len()));
        positions.extend(mesh.mesh().positions.iter().map(|&at| at * scale));
        let moved = |vertex: VertexId| VertexId::from_index(first + vertex.index());
        triangles.extend(mesh.mesh().real_triangles().iter().map(|corners| corners.map(moved)));
    }
    let outlines = EdgeList::closed_loops(spans.iter().flat_map(|span: &ChartSpan| &span.loops).map(Vec::as_slice));
    let picker = SurfacePicker::new(&positions, &triangles);
    let mesh = MeshArrays::in_frame(&positions, &triangles, sphere);
    (Arc::new(mesh), Arc::new(picker), Arc::new(spans), Arc::new(outlines))
}
