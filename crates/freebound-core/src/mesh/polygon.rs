//! Polygons over shared vertices: a mesh as given by a file.

use std::collections::HashMap;

use glam::DVec3;

use super::triangulate::triangulate;
use super::{TriMesh, VertexId};

/// A list of polygons over shared vertices. Polygons stay whole, so that a file can be written back as it was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    /// Position of each vertex, mesh units.
    pub positions: Vec<DVec3>,
    /// Corners of all polygons, one after the other.
    pub corners: Vec<VertexId>,
    /// Start of each polygon's corners, and the end of the last; `None` if every polygon is a triangle.
    pub starts: Option<Vec<u32>>,
}

impl PolygonMesh {
    /// Builds a mesh from positions and the vertex numbers of each face, counter-clockwise seen from outside.
    ///
    /// # Panics
    ///
    /// If the faces have 2^32 corners or more.
    pub fn from_arrays(positions: &[[f64; 3]], faces: &[impl AsRef<[u32]>]) -> Self {
        let positions = positions.iter().copied().map(DVec3::from).collect();
        let corners = faces.iter().flat_map(|face| face.as_ref().iter().map(|&vertex| VertexId::new(vertex))).collect();
        let ends = faces.iter().scan(0, |end, face| {
            *end += u32::try_from(face.as_ref().len()).expect("fewer than 2^32 corners");
            Some(*end)
        });
        Self { positions, corners, starts: Some(std::iter::once(0).chain(ends).collect()) }
    }

    /// Number of polygons.
    pub fn face_count(&self) -> usize {
        self.starts.as_ref().map_or(self.corners.len() / 3, |starts| starts.len().saturating_sub(1))
    }

    /// Range of a polygon's corners in `corners`.
    pub fn corner_range(&self, polygon: usize) -> std::ops::Range<usize> {
        match &self.starts {
            None => 3 * polygon..3 * polygon + 3,
            Some(starts) => starts[polygon] as usize..starts[polygon + 1] as usize,
        }
    }

    /// Corners of one polygon, in file order.
    pub fn face(&self, polygon: usize) -> &[VertexId] {
        &self.corners[self.corner_range(polygon)]
    }

    /// Normal of a polygon, of length 1; zero if it has no area.
    pub(crate) fn face_normal(&self, polygon: usize) -> DVec3 {
        let corners = self.face(polygon);
        let origin = self.positions[corners[0].index()];
        let from_origin = |v: VertexId| self.positions[v.index()] - origin;
        let pairs = corners.windows(2);
        pairs.map(|pair| from_origin(pair[0]).cross(from_origin(pair[1]))).sum::<DVec3>().normalize_or_zero()
    }

    /// Returns the mesh with every polygon reversed, starting at its first corner as before.
    #[must_use = "the mesh itself stays as it is"]
    pub fn turned(&self) -> Self {
        let corners = self.turned_at_corners(&self.corners);
        Self { positions: self.positions.clone(), corners, starts: self.starts.clone() }
    }

    /// Reorders per-corner values to the corners of the [`turned`](Self::turned) mesh.
    pub fn turned_at_corners<T: Copy>(&self, at_corners: &[T]) -> Vec<T> {
        let mut turned = at_corners.to_vec();
        for face in 0..self.face_count() {
            let mut range = self.corner_range(face);
            range.start = (range.start + 1).min(range.end);
            turned[range].reverse();
        }
        turned
    }

    /// Cuts every polygon into triangles, in file order; polygons with fewer than three corners vanish. Corners beyond
    /// the last vertex are kept, so that the diagnosis can report them.
    pub fn triangulate(&self) -> TriMesh {
        let (places, polygon_of) = self.triangle_places();
        let triangles = places.iter().map(|triangle| triangle.map(|place| self.corners[place as usize])).collect();
        TriMesh { positions: self.positions.clone(), triangles, polygon_of }
    }

    /// True for each vertex at which exactly two polygons meet that share both of its edges.
    fn bare_vertices(&self) -> Vec<bool> {
        // Per vertex: its neighbours in the first polygon there, and the number of polygons there.
        let mut meeting = vec![([VertexId::default(); 2], 0_u32); self.positions.len()];
        let count = self.positions.len();
        let mut are_bare = vec![false; count];
        for polygon in 0..self.face_count() {
            let face = self.face(polygon);
            for (at, corner) in face.iter().enumerate().filter(|(_, corner)| corner.index() < count) {
                let (before, after) = (face[(at + face.len() - 1) % face.len()], face[(at + 1) % face.len()]);
                let (first, polygons) = &mut meeting[corner.index()];
                *polygons += 1;
                are_bare[corner.index()] = *polygons == 2 && *first == [after, before];
                if *polygons == 1 {
                    *first = [before, after];
                }
            }
        }
        are_bare
    }

    /// Polygons of four or more corners that lie on an earlier polygon, corner on corner, in either direction. Each has the
    /// first such polygon. They are cut along its diagonals, so that both have equal triangles.
    fn repeats(&self) -> HashMap<u32, u32> {
        // A sum does not depend on the order. The multipliers spread numbers over all bits (D. E. Knuth).
        let spread = |sum: u64, x: u64| (sum ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31);
        let of_corner = |vertex: VertexId| Some(self.place_of(vertex)?.into_iter().fold(0, spread));
        let key = |polygon: usize| {
            let face = Some(self.face(polygon)).filter(|face| face.len() > 3)?;
            face.iter().try_fold(0_u64, |sum, &vertex| Some(sum.wrapping_add(of_corner(vertex)?)))
        };
        let mut keys: Vec<(u64, u32)> =
            (0..).zip(0..self.face_count()).filter_map(|(number, polygon)| Some((key(polygon)?, number))).collect();
        keys.sort_unstable();
        let alike = keys.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1);
        let repeat = |group: &[(u64, u32)]| {
            let first = group[0].1;
            group[1..].iter().map(|&(_, polygon)| (polygon, first)).collect::<Vec<_>>()
        };
        let are_equal = |&(polygon, first): &(u32, u32)| self.walk_between(polygon as usize, first as usize).is_some();
        alike.flat_map(repeat).filter(are_equal).collect()
    }

    /// Key of a vertex's position. `None` if the vertex is missing.
    fn place_of(&self, vertex: VertexId) -> Option<[u64; 3]> {
        self.positions.get(vertex.index()).copied().map(place_key)
    }

    /// Walk around a polygon along another, by the places of their corners. `None` if the corners differ, or two of them
    /// lie in one place.
    fn walk_between(&self, polygon: usize, other: usize) -> Option<Walk> {
        let places =
            |polygon: usize| self.face(polygon).iter().map(|&vertex| self.place_of(vertex)).collect::<Option<Vec<_>>>();
        let (own, other) = (places(polygon)?, places(other)?);
        let mut sorted = own.clone();
        sorted.sort_unstable();
        let is_simple = sorted.windows(2).all(|pair| pair[0] != pair[1]);
        Walk::between(&own, &other).filter(|_| is_simple)
    }

    /// Replaces the corners of `earlier` in triangles by those of a polygon that repeats it.
    fn take_over(&self, polygon: usize, earlier: usize, triangles: &mut [[u32; 3]]) {
        let walk = self.walk_between(polygon, earlier).expect("the polygon repeats the earlier one");
        let (own, other) = (self.corner_range(polygon), self.corner_range(earlier));
        for triangle in triangles {
            for place in triangle.iter_mut() {
                let corner = own.start + walk.place(*place as usize - other.start, own.len());
                *place = u32::try_from(corner).expect("a corner fits");
            }
            if walk.runs_against {
                triangle.swap(1, 2);
            }
        }
    }

    /// Triangles as indices into `corners`, and the polygon of each triangle unless every polygon is a triangle.
    ///
    /// # Panics
    ///
    /// If the mesh has 2^32 corners or more.
    pub fn triangle_places(&self) -> (Vec<[u32; 3]>, Option<Vec<u32>>) {
        let Some(starts) = &self.starts else {
            let count = u32::try_from(self.corners.len() / 3).expect("a mesh has fewer than 2^32 corners");
            return ((0..count).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(), None);
        };
        let mut places = Vec::with_capacity(self.corners.len());
        let mut polygon_of = Vec::with_capacity(self.corners.len());
        let mut points = Vec::new();
        let are_bare = self.bare_vertices();
        let repeats = self.repeats();
        // First triangle of each polygon.
        let mut first = Vec::with_capacity(starts.len());
        for (polygon, bounds) in (0..).zip(starts.windows(2)) {
            first.push(places.len());
            if let Some(&earlier) = repeats.get(&polygon) {
                let like = first[earlier as usize]..first[earlier as usize + 1];
                places.extend_from_within(like.clone());
                self.take_over(polygon as usize, earlier as usize, &mut places[first[polygon as usize]..]);
                polygon_of.resize(places.len(), polygon);
                continue;
            }
            points.clear();
            let corners = &self.corners[bounds[0] as usize..bounds[1] as usize];
            points.extend(corners.iter().map(|v| self.positions.get(v.index()).copied().unwrap_or(DVec3::NAN)));
            let is_bare = |corner: usize| are_bare.get(corners[corner].index()) == Some(&true);
            triangulate(&points, is_bare, |triangle| {
                let place = |corner| bounds[0] + u32::try_from(corner).expect("a corner fits");
                places.push(triangle.map(place));
                polygon_of.push(polygon);
            });
        }
        (places, Some(polygon_of))
    }
}

/// Walk around a cycle that meets the members of another cycle in their order.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    /// Place of the other cycle's first member.
    begin: usize,
    /// True if the walk runs backwards.
    pub(super) runs_against: bool,
}

impl Walk {
    /// Walk around `own`, whose members differ, along `other`. `None` if the cycles differ.
    pub(super) fn between<T: PartialEq>(own: &[T], other: &[T]) -> Option<Self> {
        let count = own.len();
        let begin = own.iter().position(|member| other.first() == Some(member)).filter(|_| count == other.len())?;
        let walks = [false, true].map(|runs_against| Self { begin, runs_against });
        walks.into_iter().find(|walk| (0..count).all(|k| own[walk.place(k, count)] == other[k]))
    }

    /// Place on a cycle of `count` members after `k` steps.
    fn place(self, k: usize, count: usize) -> usize {
        let steps = if self.runs_against { count - k % count } else { k };
        (self.begin + steps) % count
    }
}

/// Key for the equality of positions: their bits, except that −0 equals 0.
pub(crate) fn place_key(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

impl From<&TriMesh> for PolygonMesh {
    fn from(mesh: &TriMesh) -> Self {
        Self { positions: mesh.positions.clone(), corners: mesh.triangles.concat(), starts: None }
    }
}
