//! Layout of one mesh on another mesh of the surface, such as another level of detail.
//!
//! 1. Every face of the new mesh finds the nearest triangle of the old surface to its centre. The face lies on the chart
//!    of that triangle.
//! 2. Every vertex finds its nearest point of the old surface. A face at the vertex searches for a point as near, from
//!    its own triangle through the chart, near the vertex. If it finds none, a seam lies between, and the face takes the
//!    nearest point on its own side of the seam.
//! 3. Faces that take one place of the layout share one texture coordinate. Between the others the new layout has a seam.
//!
//! The copy of a layout onto its own mesh is the layout, bit for bit. A copy proves nothing: judge it by
//! [`layout_verdict_with`](crate::verify::layout_verdict_with).

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use glam::{DVec2, DVec3};

use super::{NO_COORDINATE, SurfaceSearch};
use crate::geom::double_area;
use crate::mesh::{EdgeTable, NearestPoint, PolygonMesh, TriMesh, nearest_point, point_at};
use crate::problem::{Control, Embedding, SolveError};

/// Radius of the ball around a vertex in which triangles count as connected, relative to the distance from the vertex
/// to the point of the face's centre. A larger ball reaches around the chart to the other side of a seam.
const BALL: f64 = 1.2;

/// Share of its way beyond a seam that a vertex is placed beyond the chart. With none, vertices behind each other would
/// get one place; with all, charts would overlap.
const OVERSHOOT: f64 = 0.125;

/// Distance up to which two points have one place, relative to the size of the surface or of the layout. Covers rounding.
const SAME_PLACE: f64 = 1e-9;

/// Distance up to which nearest points of one vertex may be one place, relative to the size of the surface.
const BESIDE: f64 = 1e-4;

/// Largest stretch of a layout between two such points, relative to the mean scale of their triangles.
const STRETCH: f64 = 4.0;

/// No triangle across a side.
const NONE: u32 = u32::MAX;

/// Layout on a surface.
#[derive(Clone, Copy, Debug)]
pub struct LayoutSurface<'a> {
    /// Triangles, with one vertex per texture coordinate.
    pub mesh: &'a TriMesh,
    /// Texture coordinate of each vertex.
    pub coordinates: &'a Embedding,
}

impl LayoutSurface<'_> {
    /// Texture coordinate in the plane of a triangle, for the barycentric weights of its corners.
    pub fn at(&self, triangle: u32, weights: [f64; 3]) -> DVec2 {
        let [a, b, c] = self.mesh.triangles[triangle as usize].map(|vertex| self.coordinates[vertex]);
        a * weights[0] + b * weights[1] + c * weights[2]
    }
}

/// Copied layout, with the distances between the two surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct CopiedLayout {
    /// Texture coordinates.
    pub coordinates: Vec<DVec2>,
    /// Index of the coordinate of each corner of the new mesh. [`NO_COORDINATE`] at vertices that are not finite.
    pub corners: Vec<u32>,
    /// Largest distance of a used vertex to the old surface, mesh units.
    pub largest_distance: f64,
    /// Mean distance of the used vertices to the old surface, mesh units.
    pub mean_distance: f64,
    /// Diagonal of the box around the old surface, mesh units.
    pub diagonal: f64,
}

/// Reason why a layout cannot be copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CopyLayoutError {
    /// The old layout has no triangle.
    #[error("the layout to copy has no triangles")]
    NoTriangles,
    /// The caller cancelled.
    #[error("the copy was cancelled")]
    Cancelled,
}

impl From<SolveError> for CopyLayoutError {
    /// A copy solves nothing: cancelling is its only way to fail.
    fn from(_: SolveError) -> Self {
        Self::Cancelled
    }
}

/// Copies a layout onto another mesh, by nearest points. Time: O(n log n) for two meshes of n faces.
///
/// # Errors
///
/// [`CopyLayoutError`] if the layout has no triangle, or the caller cancels.
pub fn copy_layout(
    layout: LayoutSurface<'_>,
    mesh: &PolygonMesh,
    control: Control<'_>,
) -> Result<CopiedLayout, CopyLayoutError> {
    let search = SurfaceSearch::new(layout.mesh);
    control.go_on()?;
    let across = triangles_across(layout.mesh);
    let sense = search.sense(mesh.face_count(), |face| (centre_of(mesh, face), area_of(mesh, face)));
    let normals = control.each(mesh.face_count(), |face| sense * normal_of(mesh, face))?;
    let near_face = |face: usize| search.nearest(centre_of(mesh, face), normals[face], None);
    let of_faces = control.each(mesh.face_count(), near_face)?;
    if search.diagonal() == 0.0 || of_faces.iter().all(Option::is_none) {
        return Err(CopyLayoutError::NoTriangles);
    }
    let uses = Uses::of(mesh);
    let extent = layout.coordinates.bounds().size().max_element();
    let copy = LayoutCopy { layout, mesh, search, across, normals, of_faces, uses, extent };
    let at_vertices = control.each(mesh.positions.len(), |vertex| copy.at_vertex(vertex))?;
    Ok(copy.joined(&at_vertices))
}

/// Centre of a polygon: the mean of its corners.
fn centre_of(mesh: &PolygonMesh, face: usize) -> DVec3 {
    let corners = mesh.face(face);
    corners.iter().map(|vertex| mesh.positions[vertex.index()]).sum::<DVec3>() / corners.len().max(1) as f64
}

/// Area vector of a polygon, twice its area long.
fn area_of(mesh: &PolygonMesh, face: usize) -> DVec3 {
    let corners = mesh.face(face);
    let at = |corner: usize| mesh.positions[corners[corner].index()];
    (1..corners.len().max(2) - 1).map(|k| (at(k) - at(0)).cross(at(k + 1) - at(0))).sum()
}

/// Normal of a polygon; zero if it has no area.
fn normal_of(mesh: &PolygonMesh, face: usize) -> DVec3 {
    if mesh.corner_range(face).is_empty() { DVec3::ZERO } else { mesh.face_normal(face) }
}

/// Triangle across each side, within the chart. Edges with three triangles or more count as seams.
fn triangles_across(mesh: &TriMesh) -> Vec<[u32; 3]> {
    let mut across = vec![[NONE; 3]; mesh.face_count()];
    for sides in EdgeTable::new(mesh.vertex_count(), &mesh.triangles).edges() {
        if let &[a, b] = sides {
            across[a as usize / 3][a as usize % 3] = b / 3;
            across[b as usize / 3][b as usize % 3] = a / 3;
        }
    }
    across
}

/// Corners at each vertex.
struct Uses {
    places: Vec<u32>,
    /// Start of each vertex's corners in `places`, and the end of the last.
    starts: Vec<usize>,
    /// Polygon of each corner.
    face_of: Vec<u32>,
}

impl Uses {
    fn of(mesh: &PolygonMesh) -> Self {
        let mut face_of = vec![0; mesh.corners.len()];
        for (number, face) in (0..).zip(0..mesh.face_count()) {
            face_of[mesh.corner_range(face)].fill(number);
        }
        let mut starts = vec![0; mesh.positions.len() + 1];
        mesh.corners.iter().for_each(|vertex| starts[vertex.index() + 1] += 1);
        (0..mesh.positions.len()).for_each(|vertex| starts[vertex + 1] += starts[vertex]);
        let (mut next, mut places) = (starts.clone(), vec![0; mesh.corners.len()]);
        for (place, vertex) in (0..).zip(&mesh.corners) {
            places[next[vertex.index()]] = place;
            next[vertex.index()] += 1;
        }
        Self { places, starts, face_of }
    }

    fn at(&self, vertex: usize) -> &[u32] {
        &self.places[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

/// Copy in progress.
struct LayoutCopy<'a> {
    layout: LayoutSurface<'a>,
    mesh: &'a PolygonMesh,
    search: SurfaceSearch<'a>,
    across: Vec<[u32; 3]>,
    /// Normal of each face, towards the outside of the old surface.
    normals: Vec<DVec3>,
    /// Nearest point to the centre of each face.
    of_faces: Vec<Option<NearestPoint>>,
    uses: Uses,
    /// Longer side of the layout's box.
    extent: f64,
}

/// Coordinates at one vertex.
#[derive(Default)]
struct AtVertex {
    /// Points of the old surface, one for each side of the seams that pass here.
    sides: Vec<NearestPoint>,
    /// Side of each corner at the vertex.
    side_of: Vec<u32>,
    /// Distance to the old surface.
    distance: f64,
}

impl LayoutCopy<'_> {
    fn at_vertex(&self, vertex: usize) -> AtVertex {
        let places = self.uses.at(vertex);
        let face = |place: u32| self.uses.face_of[place as usize] as usize;
        let direction = places.iter().map(|&place| self.normals[face(place)]).sum();
        let position = self.mesh.positions[vertex];
        let first = places.first().and_then(|&place| self.of_faces[face(place)]).map(|near| near.triangle);
        let Some(nearest) = first.and_then(|near| self.search.nearest(position, direction, Some(near))) else {
            return AtVertex::default();
        };
        let mut found =
            AtVertex { sides: vec![nearest], side_of: Vec::new(), distance: nearest.distance_squared.sqrt() };
        for &place in places {
            let side = self.of_faces[face(place)].map_or(0, |near| self.side(near, position, &mut found.sides));
            found.side_of.push(side);
        }
        found
    }

    /// Side of a seam on which a face lies, seen from a vertex. `near` is the point nearest to the centre of the face. A
    /// new side is added. The first side has the nearest point of the whole surface.
    fn side(&self, near: NearestPoint, vertex: DVec3, sides: &mut Vec<NearestPoint>) -> u32 {
        let reached = self.in_space(&near).distance_squared(vertex);
        let radius = reached * BALL * BALL;
        let tolerance = SAME_PLACE * self.search.diagonal();
        let as_near = (sides[0].distance_squared.sqrt() + tolerance).powi(2);
        let (mut pending, mut seen, mut best) = (BinaryHeap::new(), HashSet::from([near.triangle]), near);
        best.distance_squared = f64::INFINITY;
        pending.push(Reverse((0, near.triangle)));
        while let Some(Reverse((_, triangle))) = pending.pop() {
            let point = nearest_point(vertex, self.search.corners(triangle), triangle);
            let order = point.distance_squared.total_cmp(&best.distance_squared);
            if order.then(triangle.cmp(&best.triangle)).is_lt() {
                best = point;
            }
            if best.distance_squared <= as_near {
                break;
            }
            for next in self.across[triangle as usize].into_iter().filter(|&next| next != NONE) {
                let distance = nearest_point(vertex, self.search.corners(next), next).distance_squared;
                if distance <= radius && seen.insert(next) {
                    // Distances are not negative: their bits have their order.
                    pending.push(Reverse((distance.to_bits(), next)));
                }
            }
        }
        let is_far = best.distance_squared > as_near;
        let is_same = |(number, side): (usize, &NearestPoint)| {
            self.is_same_place(side, &best) || (is_far && number > 0 && seen.contains(&side.triangle))
        };
        let side = sides.iter().enumerate().position(is_same).unwrap_or_else(|| {
            sides.push(best);
            sides.len() - 1
        });
        u32::try_from(side).expect("fewer sides than corners")
    }

    /// True if two points of the surface have one place in the layout. A vertex beside the surface, for example by the
    /// rounding of its file, may have nearest points on several triangles, which lie as close in the layout as in space.
    fn is_same_place(&self, a: &NearestPoint, b: &NearestPoint) -> bool {
        let [uv_a, uv_b] = [a, b].map(|point| self.inside(point));
        if uv_a == uv_b || uv_a.distance(uv_b) <= SAME_PLACE * self.extent {
            return true;
        }
        let apart = self.in_space(a).distance(self.in_space(b));
        let scale = self.scale(a.triangle).max(self.scale(b.triangle));
        apart <= BESIDE * self.search.diagonal() && uv_a.distance(uv_b) <= STRETCH * scale * apart
    }

    /// Position of a point of the old surface.
    fn in_space(&self, point: &NearestPoint) -> DVec3 {
        point_at(self.search.corners(point.triangle), point.weights)
    }

    /// Length in the layout for a length of the surface, in the mean over a triangle. 0 if it has no area.
    fn scale(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.search.corners(triangle);
        let in_layout = self.layout.mesh.triangles[triangle as usize].map(|vertex| self.layout.coordinates[vertex]);
        let scale = (double_area(in_layout).abs() / (b - a).cross(c - a).length()).sqrt();
        if scale.is_finite() { scale } else { 0.0 }
    }

    /// Texture coordinate of a point of the old surface.
    fn inside(&self, point: &NearestPoint) -> DVec2 {
        self.layout.at(point.triangle, point.weights)
    }

    /// Texture coordinate of a vertex for its nearest point. Beyond the edge of the chart, the coordinate lies a little
    /// beyond the edge.
    fn coordinate(&self, point: &NearestPoint, vertex: DVec3) -> DVec2 {
        let triangle = point.triangle as usize;
        let inside = self.inside(point);
        // Side k runs from corner k to the next one: the corner after both has no weight on it.
        let is_at_edge = (0..3).any(|k| point.weights[(k + 2) % 3] == 0.0 && self.across[triangle][k] == NONE);
        if !is_at_edge || point.distance_squared == 0.0 {
            return inside;
        }
        let [a, b, c] = self.search.corners(point.triangle);
        let normal = (b - a).cross(c - a);
        let share = |area: DVec3| area.dot(normal) / normal.length_squared();
        let (of_b, of_c) = (share((vertex - a).cross(c - a)), share((b - a).cross(vertex - a)));
        let beyond = inside.lerp(self.layout.at(point.triangle, [1.0 - of_b - of_c, of_b, of_c]), OVERSHOOT);
        if beyond.is_finite() { beyond } else { inside }
    }

    fn joined(&self, at_vertices: &[AtVertex]) -> CopiedLayout {
        let (mut coordinates, mut corners) = (Vec::new(), vec![NO_COORDINATE; self.mesh.corners.len()]);
        for (vertex, found) in at_vertices.iter().enumerate() {
            let first = u32::try_from(coordinates.len()).expect("no more coordinates than corners");
            let position = self.mesh.positions[vertex];
            // The nearest point of a vertex may belong to none of its faces.
            let mut numbers = vec![NO_COORDINATE; found.sides.len()];
            let mut next = first;
            for (&place, &side) in self.uses.at(vertex).iter().zip(&found.side_of) {
                let number = &mut numbers[side as usize];
                if *number == NO_COORDINATE {
                    *number = next;
                    next += 1;
                    coordinates.push(self.coordinate(&found.sides[side as usize], position));
                }
                corners[place as usize] = *number;
            }
        }
        let distances = || at_vertices.iter().filter(|found| !found.sides.is_empty()).map(|found| found.distance);
        CopiedLayout {
            coordinates,
            corners,
            largest_distance: distances().fold(0.0, f64::max),
            mean_distance: distances().sum::<f64>() / distances().count().max(1) as f64,
            diagonal: self.search.diagonal(),
        }
    }
}
