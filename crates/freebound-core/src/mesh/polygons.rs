//! The polygons that a disk's triangles are cut from, and their diagonals beyond those of the cut.
//!
//! A corner is *convex in space* where it turns left by a clear angle, seen along the polygon's normal. In the plane it
//! has to turn left too: then every way to cut the polygon there gives positive triangles. Where all corners are convex
//! in space and they are few, the polygon is *averaged*: weights are the mean over its fans, and each of its diagonals is
//! a link of the equations.

use glam::DVec3;

use super::{FaceId, TriMesh, VertexId};

/// A corner that deviates from straight by a smaller angle, in radians, counts as straight: it may turn either way.
const STRAIGHT: f64 = 1e-4;

/// The most corners of a polygon whose fans are averaged; it has a quarter as many triangles in them as its square.
const MOST_AVERAGED: usize = 16;

/// All polygons with more than three corners.
#[derive(Clone, Debug, Default)]
pub(super) struct Polygons {
    corners: Vec<VertexId>,
    /// For each corner whether it is convex in space.
    are_convex: Vec<bool>,
    /// Where each polygon's corners begin, and the end of the last.
    starts: Vec<u32>,
    first_faces: Vec<FaceId>,
}

/// A polygon with more than three corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polygon<'a> {
    /// Its corners, counter-clockwise.
    pub corners: &'a [VertexId],
    /// For each corner whether it is convex in space, by a clear angle.
    pub are_convex: &'a [bool],
    /// The first of its triangles; the others follow.
    pub first_face: FaceId,
}

impl<'a> Polygon<'a> {
    /// Its triangles.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        let first = self.first_face.index();
        (first..first + self.corners.len() - 2).map(FaceId::from_index)
    }

    /// Whether weights are the mean over its fans.
    pub fn is_averaged(&self) -> bool {
        self.corners.len() <= MOST_AVERAGED && self.are_convex.iter().all(|&is_convex| is_convex)
    }

    /// The triangles at its corners: before, at and after each.
    pub fn ears(&self) -> impl ExactSizeIterator<Item = [VertexId; 3]> + use<'a> {
        let (corners, count) = (self.corners, self.corners.len());
        (0..count).map(move |at| [corners[(at + count - 1) % count], corners[at], corners[(at + 1) % count]])
    }

    /// The triangles at corners that are convex in space.
    pub fn convex_ears(&self) -> impl Iterator<Item = [VertexId; 3]> + use<'a> {
        self.ears().zip(self.are_convex).filter_map(|(ear, &is_convex)| is_convex.then_some(ear))
    }
}

impl Polygons {
    /// Finds the polygons whose triangles follow each other in a mesh.
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

    /// Lets go of the polygons that `is_whole` denies: from then on they are but triangles.
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

    /// The one that a face is cut from.
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

/// Newell's normal; its length is twice the area of the polygon's shadow.
pub(super) fn newell_normal(points: &[DVec3]) -> DVec3 {
    let origin = points[0];
    let next = points.iter().skip(1);
    points.iter().zip(next).map(|(&a, &b)| (a - origin).cross(b - origin)).sum()
}

/// The corners around triangles that make a polygon without a vertex inside; `None` where they do not.
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

/// The sides of triangles that no other one of them shares, ascending.
pub(super) fn outer_sides(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let mut sides: Vec<[VertexId; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    sides.sort_unstable();
    let is_outer = |&[a, b]: &[VertexId; 2]| sides.binary_search(&[b, a]).is_err();
    sides.iter().copied().filter(is_outer).collect()
}
