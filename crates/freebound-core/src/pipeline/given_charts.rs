//! Charts of a given layout: connected pieces of a mesh in texture space.

use std::collections::HashMap;

use glam::DVec2;

use super::atlas::{outline_of_loops, triangles_of};
use super::{GivenLayout, NO_COORDINATE, RepackError};
use crate::geom::{ChartShape, double_area, point_key, turning_number};
use crate::mesh::union::DisjointSets;
use crate::mesh::{EdgeTable, FaceId, MeasuredSurface, Part, SurfaceFaces, TriMesh, VertexId, parts};
use crate::parallel::prelude::*;
use crate::problem::Embedding;
use crate::verify::atlas_verdict;

/// All charts of a layout. Vertices are numbered by charts, those of each chart in a row.
pub(super) struct GivenCharts {
    pub(super) charts: Vec<GivenChart>,
    /// Vertex of each corner of the mesh, or [`NO_COORDINATE`] at faces without a triangle.
    pub(super) corners: Vec<u32>,
}

/// Chart of a given layout.
pub(super) struct GivenChart {
    /// Triangles over the chart's own vertices, at their positions in space. Polygons are numbered as in the input.
    pub(super) mesh: TriMesh,
    /// Position of each vertex in the plane: texture coordinates, u times the aspect of the picture.
    pub(super) plane: Embedding,
    /// Area of the surface.
    pub(super) area: f64,
    /// Sum of the areas of all triangles in the plane.
    pub(super) area_in_plane: f64,
    /// True if the chart is one-to-one, possibly as a mirror image.
    pub(super) is_planar: bool,
    /// Surface of the chart, as seen in the plane, if it is one-to-one.
    seen: Option<Part>,
}

/// Corners of a mesh that share a vertex and a coordinate, as one number each.
struct TextureVertices {
    /// Texture vertex of each corner.
    of_corner: Vec<VertexId>,
    count: usize,
}

/// Triangles of a layout.
struct TextureTriangles {
    vertices: TextureVertices,
    /// Places of the corners in the list of all corners.
    places: Vec<[u32; 3]>,
    /// Polygon of each triangle, if there are others than triangles.
    polygon_of: Option<Vec<u32>>,
}

/// Chart of each face of a layout, in the order of their first faces. `None` for faces without a triangle.
///
/// # Errors
///
/// [`RepackError`] if the mesh has no triangle, or faces have no usable texture coordinates.
///
/// # Panics
///
/// If `corners` has another length than the corners of the mesh, or an index is out of range.
pub fn charts_of_layout(layout: GivenLayout<'_>) -> Result<Vec<Option<usize>>, RepackError> {
    Ok(TextureTriangles::of(layout)?.charts(layout.mesh.face_count()))
}

impl GivenCharts {
    pub(super) fn of(layout: GivenLayout<'_>) -> Result<Self, RepackError> {
        let mesh = layout.mesh;
        let triangles = TextureTriangles::of(layout)?;
        let chart_of = triangles.charts(mesh.face_count());
        let count = chart_of.iter().flatten().max().map_or(0, |last| last + 1);
        let mut drafts: Vec<Draft> = (0..count).map(|_| Draft::default()).collect();
        let mut own = vec![NO_COORDINATE; mesh.corners.len()];
        for (face, chart) in chart_of.iter().enumerate().filter_map(|(face, chart)| Some((face, (*chart)?))) {
            for place in mesh.corner_range(face) {
                own[place] = drafts[chart].vertex(layout, triangles.vertices.of_corner[place], place);
            }
        }
        for (face, triangle) in triangles.places.iter().enumerate() {
            let number = triangles.polygon(face);
            let corners = triangle.map(|place| VertexId::new(own[place as usize]));
            drafts[chart_of[number].expect("a face with a triangle has a chart")].push(number, corners);
        }
        let starts: Vec<usize> = drafts
            .iter()
            .scan(0, |next, draft| {
                let start = *next;
                *next += draft.mesh.positions.len();
                Some(start)
            })
            .collect();
        for (face, chart) in chart_of.iter().enumerate().filter_map(|(face, chart)| Some((face, (*chart)?))) {
            for place in mesh.corner_range(face) {
                own[place] += u32::try_from(starts[chart]).expect("no more vertices than corners");
            }
        }
        let charts = drafts.into_par_iter().map(|draft| GivenChart::new(draft.mesh, draft.plane.into())).collect();
        Ok(Self { charts, corners: own })
    }
}

/// Chart that is being collected.
#[derive(Default)]
struct Draft {
    mesh: TriMesh,
    plane: Vec<DVec2>,
    number_of: HashMap<VertexId, u32>,
}

impl Draft {
    /// Number of a texture vertex in the chart.
    fn vertex(&mut self, layout: GivenLayout<'_>, vertex: VertexId, place: usize) -> u32 {
        let next = u32::try_from(self.plane.len()).expect("no more vertices than corners");
        *self.number_of.entry(vertex).or_insert_with(|| {
            self.mesh.positions.push(layout.mesh.positions[layout.mesh.corners[place].index()]);
            self.plane.push(layout.coordinate(place) * DVec2::new(layout.aspect, 1.0));
            next
        })
    }

    fn push(&mut self, polygon: usize, corners: [VertexId; 3]) {
        self.mesh.triangles.push(corners);
        self.mesh.polygon_of.get_or_insert_default().push(FaceId::from_index(polygon).number());
    }
}

impl GivenLayout<'_> {
    /// Coordinate of a corner.
    pub(super) fn coordinate(&self, place: usize) -> DVec2 {
        self.coordinates[self.corners[place] as usize]
    }
}

/// Refuses faces with corners that have no coordinates, or none that are finite.
fn refuse_unusable(layout: GivenLayout<'_>) -> Result<(), RepackError> {
    assert_eq!(layout.corners.len(), layout.mesh.corners.len(), "a coordinate for every corner");
    let faces_with = |is_fault: &dyn Fn(usize) -> bool| {
        let faces = (0..layout.mesh.face_count()).filter(|&face| layout.mesh.corner_range(face).any(is_fault));
        faces.map(FaceId::from_index).collect::<Vec<_>>()
    };
    let missing = faces_with(&|place| layout.corners[place] == NO_COORDINATE);
    if !missing.is_empty() {
        return Err(RepackError::Missing(missing));
    }
    let infinite = faces_with(&|place| !layout.coordinate(place).is_finite());
    if infinite.is_empty() { Ok(()) } else { Err(RepackError::NotFinite(infinite)) }
}

impl TextureVertices {
    /// Coordinates are equal if their bits are, except that −0 equals 0.
    fn of(layout: GivenLayout<'_>) -> Self {
        let mut numbers: HashMap<(VertexId, [u64; 2]), usize> = HashMap::new();
        let number = |(place, &vertex): (usize, &VertexId)| {
            let bits = point_key(layout.coordinate(place));
            let next = numbers.len();
            VertexId::from_index(*numbers.entry((vertex, bits)).or_insert(next))
        };
        let of_corner = layout.mesh.corners.iter().enumerate().map(number).collect();
        Self { of_corner, count: numbers.len() }
    }
}

impl TextureTriangles {
    fn of(layout: GivenLayout<'_>) -> Result<Self, RepackError> {
        refuse_unusable(layout)?;
        let (places, polygon_of) = layout.mesh.triangle_places();
        if places.is_empty() {
            return Err(RepackError::NoFaces);
        }
        Ok(Self { vertices: TextureVertices::of(layout), places, polygon_of })
    }

    /// Polygon of a triangle.
    fn polygon(&self, face: usize) -> usize {
        self.polygon_of.as_ref().map_or(face, |of| of[face] as usize)
    }

    /// Chart of each polygon, in the order of first faces. `None` for polygons without a triangle.
    fn charts(&self, polygon_count: usize) -> Vec<Option<usize>> {
        let vertex = |place: u32| self.vertices.of_corner[place as usize];
        let triangles: Vec<[VertexId; 3]> = self.places.iter().map(|triangle| triangle.map(vertex)).collect();
        let number = |face: usize| u32::try_from(self.polygon(face)).expect("no more faces than corners");
        let mut sets = DisjointSets::new(polygon_count);
        for sides in EdgeTable::new(self.vertices.count, &triangles).edges() {
            sides.windows(2).for_each(|pair| {
                sets.join(number(pair[0] as usize / 3), number(pair[1] as usize / 3));
            });
        }
        let (mut chart_of, mut chart_of_root) = (vec![None; polygon_count], HashMap::new());
        for face in 0..triangles.len() {
            let next = chart_of_root.len();
            chart_of[self.polygon(face)] = Some(*chart_of_root.entry(sets.find(number(face))).or_insert(next));
        }
        chart_of
    }
}

impl GivenChart {
    fn new(mesh: TriMesh, plane: Embedding) -> Self {
        let seen = seen_in_plane(&mesh, &plane);
        let doubled = |face: &[VertexId; 3]| double_area(face.map(|vertex| plane[vertex])).abs();
        let area_in_plane = mesh.triangles.iter().map(doubled).sum::<f64>() / 2.0;
        Self { area: mesh.area(), area_in_plane, is_planar: seen.is_some(), seen, mesh, plane }
    }

    /// Polygons of the chart, by their numbers in the input.
    pub(super) fn polygons(&self) -> impl Iterator<Item = FaceId> {
        (0..self.mesh.face_count()).map(|face| FaceId::new(self.mesh.polygon(FaceId::from_index(face))))
    }

    pub(super) fn first_face(&self) -> FaceId {
        FaceId::new(self.mesh.polygon(FaceId::new(0)))
    }

    /// Longer side of the chart's box in the plane.
    pub(super) fn extent(&self) -> f64 {
        self.plane.bounds().size().max_element()
    }

    /// Shape in the plane, scaled: the outline of a chart that is one-to-one, the triangles of any other.
    pub(super) fn shape(&self, factor: DVec2) -> ChartShape {
        let at = |vertex: &VertexId| self.plane[*vertex] * factor;
        let Some(seen) = &self.seen else { return triangles_of(&self.mesh.triangles, at) };
        let in_plane = |vertices: &Vec<VertexId>| -> Vec<DVec2> {
            vertices.iter().map(|vertex| self.plane[seen.vertex_of()[vertex.index()]]).collect()
        };
        let given: Vec<Vec<DVec2>> = seen.loops().iter().map(in_plane).collect();
        let outer = given.iter().position(|points| turning_number(points) == Some(1));
        let scaled = |points: Vec<DVec2>| points.into_iter().map(|point| point * factor).collect();
        let mut loops: Vec<Vec<DVec2>> = given.into_iter().map(scaled).collect();
        let outer = loops.swap_remove(outer.expect("a chart that is one-to-one has an outer loop"));
        outline_of_loops(outer, loops)
    }

    /// Surface and plane of a chart that is one-to-one, as seen in the plane, to be compared with others. `None` for a
    /// chart that meets itself at a vertex.
    pub(super) fn measured(&self, factor: f64) -> Option<MeasuredSurface> {
        let seen = self.seen.as_ref().filter(|seen| seen.vertex_of().len() == self.mesh.vertex_count())?;
        let plane: Vec<DVec2> = seen.vertex_of().iter().map(|&vertex| self.plane[vertex] * factor).collect();
        let is_outer = |vertices: &&Vec<VertexId>| {
            turning_number(&vertices.iter().map(|vertex| plane[vertex.index()]).collect::<Vec<_>>()) == Some(1)
        };
        let outer = seen.loops().iter().find(is_outer)?;
        let faces = SurfaceFaces { triangles: &seen.mesh().triangles, outer, area: self.area };
        MeasuredSurface::new(&seen.mesh().positions, faces, seen.polygons(), Some(&plane))
    }

    /// Vertices of another chart for the vertices of this one, from those of the measured surfaces.
    pub(super) fn in_chart(&self, other: &Self, measured: &[Option<VertexId>]) -> Vec<Option<VertexId>> {
        let mut vertex_of = vec![None; self.mesh.vertex_count()];
        if let (Some(own), Some(other)) = (&self.seen, &other.seen) {
            for (vertex, image) in own.vertex_of().iter().zip(measured) {
                vertex_of[vertex.index()] = image.map(|image| other.vertex_of()[image.index()]);
            }
        }
        vertex_of
    }

    /// True if the chart is one-to-one at other coordinates.
    pub(super) fn is_planar_at(&self, coordinates: &Embedding) -> bool {
        let proved = |mesh: &TriMesh| parts(mesh).is_ok_and(|parts| atlas_verdict(&parts, coordinates).planar);
        proved(&self.mesh) || proved(&self.mesh.clone().without_repeats().without_collapsed(&self.plane))
    }

    /// Area that the triangles have at texture coordinates on a picture, in pixels.
    pub(super) fn area_at(&self, coordinates: &Embedding, picture: DVec2) -> f64 {
        let doubled = |face: &[VertexId; 3]| double_area(face.map(|vertex| coordinates[vertex] * picture)).abs();
        self.mesh.triangles.iter().map(doubled).sum::<f64>() / 2.0
    }

    /// Average number of pixels of a picture per unit of length on the surface. 0 for a surface without area.
    pub(super) fn density(&self, coordinates: &Embedding, picture: DVec2) -> f64 {
        let density = (self.area_at(coordinates, picture) / self.area).sqrt();
        if density.is_finite() { density } else { 0.0 }
    }
}

/// Surface as seen in the plane, counter-clockwise there, if it is one part and one-to-one.
fn seen_in_plane(mesh: &TriMesh, plane: &Embedding) -> Option<Part> {
    let part_of = |mesh: &TriMesh| {
        let mut parts = parts(mesh).ok()?;
        let verdict = atlas_verdict(&parts, plane);
        let is_mirrored = verdict.charts[0].mirrored;
        (parts.len() == 1 && verdict.planar).then(|| (parts.remove(0), is_mirrored))
    };
    // Without redundant faces, which repairs leave in a file, as a second try.
    let reduced = || mesh.clone().without_repeats().without_collapsed(plane);
    let (part, is_mirrored) = part_of(mesh).or_else(|| part_of(&reduced()))?;
    if !is_mirrored {
        return Some(part);
    }
    let turned = |&[a, b, c]: &[VertexId; 3]| [a, c, b];
    let triangles = reduced().triangles.iter().map(turned).collect();
    part_of(&TriMesh { triangles, ..reduced() }).map(|(part, _)| part)
}
