//! Polygons that a disk's triangles are cut from, with their diagonals beyond those of the triangulation.
//!
//! A corner is *convex in space* if it turns left by a clear angle, seen along the polygon's normal. In the plane it
//! must turn left too: then every triangulation of the polygon there has positive triangles. A polygon is *averaged*
//! if it has few corners, all of them convex in space. Its weights are the mean over its fans, and each of its
//! diagonals is a link of the equations.

use glam::DVec3;

use super::{FaceId, TriMesh, VertexId};

/// Largest deviation from straight, in radians, at which a corner counts as straight and may turn either way.
const STRAIGHT: f64 = 1e-4;

/// Largest number of corners of an averaged polygon. The fans of n corners hold n² − 3n different triangles.
const MOST_AVERAGED: usize = 16;

/// All polygons with more than three corners.
#[derive(Clone, Debug, Default)]
pub(super) struct Polygons {
    corners: Vec<VertexId>,
    /// True for each corner that is convex in space.
    are_convex: Vec<bool>,
    /// Start of each polygon's corners, and the end of the last polygon.
    starts: Vec<u32>,
    first_faces: Vec<FaceId>,
}

/// A polygon with more than three corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polygon<'a> {
    /// Corners of the polygon, counter-clockwise.
    pub corners: &'a [VertexId],
    /// True for each corner that is convex in space by a clear angle.
    pub are_convex: &'a [bool],
    /// First triangle of the polygon; its other triangles follow.
    pub first_face: FaceId,
}

impl<'a> Polygon<'a> {
    /// Triangles of the polygon.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        let first = self.first_face.index();
        (first..first + self.corners.len() - 2).map(FaceId::from_index)
    }

    /// True if the weights are the mean over the polygon's fans.
    pub fn is_averaged(&self) -> bool {
        self.corners.len() <= MOST_AVERAGED && self.are_convex.iter().all(|&is_convex| is_convex)
    }

    /// Triangle at each corner: the corner with its two neighbours.
    pub fn ears(&self) -> impl ExactSizeIterator<Item = [VertexId; 3]> + use<'a> {
        let (corners, count) = (self.corners, self.corners.len());
        (0..count).map(move |at| [corners[(at + count - 1) % count], corners[at], corners[(at + 1) % count]])
    }

    /// Triangles at the corners that are convex in space.
    pub fn convex_ears(&self) -> impl Iterator<Item = [VertexId; 3]> + use<'a> {
        self.ears().zip(self.are_convex).filter_map(|(ear, &is_convex)| is_convex.then_some(ear))
    }
}

impl Polygons {
    /// Finds the polygons of a mesh whose triangles are consecutive.
    pub(super) fn of(mesh: &TriMesh) -> Self {
        let mut found = Self { starts: vec![0], ..Self::default() };
        let Some(polygon_of) = &mesh.polygon_of else { return found };
        let mut face = 0;
        let real = &polygon_of[..mesh.real_face_count()];
        for run in real.chunk_by(|a, b| a == b) {
            let faces = &mesh.triangles[face..face + run.len()];
            if let Some(corners) = (run.len() > 1).then(|| outline(faces)).flatten() {
                found.push(mesh, &corners, FaceId::from_index(face));
            }
            face += run.len();
        }
        found
    }

    fn push(&mut self, mesh: &TriMesh, corners: &[VertexId], first_face: FaceId) {
        let points: Vec<DVec3> = corners.iter().map(|v| mesh.positions[v.index()]).collect();
        let count = points.len();
        let side = |at: usize| (points[(at + 1) % count] - points[at % count]).normalize_or_zero();
        let normal = newell_normal(&points).normalize_or_zero();
        self.are_convex.extend((0..count).map(|at| side(at + count - 1).cross(side(at)).dot(normal) > STRAIGHT));
        self.corners.extend_from_slice(corners);
        self.starts.push(u32::try_from(self.corners.len()).expect("a mesh has fewer than 2^32 corners"));
        self.first_faces.push(first_face);
    }

    /// Keeps only the polygons for which `is_whole` is true; of all others only the triangles remain.
    pub(super) fn retain(&mut self, is_whole: impl Fn(&Polygon<'_>) -> bool) {
        let mut kept = Self { starts: vec![0], ..Self::default() };
        for polygon in self.iter().filter(is_whole) {
            kept.corners.extend_from_slice(polygon.corners);
            kept.are_convex.extend_from_slice(polygon.are_convex);
            kept.starts.push(u32::try_from(kept.corners.len()).expect("fewer than before"));
            kept.first_faces.push(polygon.first_face);
        }
        *self = kept;
    }

    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = Polygon<'_>> + Clone {
        (0..self.first_faces.len()).map(|place| self.polygon(place))
    }

    /// Returns the polygon that a face is cut from.
    pub(super) fn with(&self, face: FaceId) -> Option<Polygon<'_>> {
        let place = self.first_faces.partition_point(|&first| first <= face).checked_sub(1)?;
        Some(self.polygon(place)).filter(|polygon| polygon.faces().any(|own| own == face))
    }

    fn polygon(&self, place: usize) -> Polygon<'_> {
        let range = self.starts[place] as usize..self.starts[place + 1] as usize;
        let (corners, are_convex) = (&self.corners[range.clone()], &self.are_convex[range]);
        Polygon { corners, are_convex, first_face: self.first_faces[place] }
    }
}

impl TriMesh {
    /// First triangles of the polygons with more than three corners for which `is_found` is true. The triangles of a
    /// polygon are consecutive.
    pub(crate) fn polygons_where(&self, is_found: impl Fn(&Polygon<'_>) -> bool) -> Vec<FaceId> {
        Polygons::of(self).iter().filter(is_found).map(|polygon| polygon.first_face).collect()
    }
}

/// Newell's normal; its length is twice the area of the polygon's projection along it.
pub(super) fn newell_normal(points: &[DVec3]) -> DVec3 {
    let origin = points[0];
    let next = points.iter().skip(1);
    points.iter().zip(next).map(|(&a, &b)| (a - origin).cross(b - origin)).sum()
}

/// Corners around triangles that form a polygon without interior vertices; `None` if they do not.
fn outline(triangles: &[[VertexId; 3]]) -> Option<Vec<VertexId>> {
    let outer = outer_sides(triangles);
    let mut corners = vec![triangles[0].into_iter().find(|&v| outer.iter().any(|side| side[0] == v))?];
    while corners.len() < outer.len() {
        let at = outer.binary_search_by_key(corners.last()?, |side| side[0]).ok()?;
        corners.push(outer[at][1]);
    }
    let is_closed = outer.len() == triangles.len() + 2 && outer.contains(&[*corners.last()?, corners[0]]);
    is_closed.then_some(corners)
}

/// Sides that belong to one of the triangles only, ascending.
pub(super) fn outer_sides(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let mut sides: Vec<[VertexId; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    sides.sort_unstable();
    let is_outer = |&[a, b]: &[VertexId; 2]| sides.binary_search(&[b, a]).is_err();
    sides.iter().copied().filter(is_outer).collect()
}
