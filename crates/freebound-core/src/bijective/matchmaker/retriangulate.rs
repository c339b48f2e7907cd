//! Mesh and outside as triangles that can be exchanged, one fan for another.
//!
//! While every triangle up to the frame is positive, the map is one-to-one: neither faces nor the boundary overlap.

use std::collections::BTreeMap;

use glam::DVec2;

/// Source of a triangle of the outside.
pub(super) const OUTSIDE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Triangle {
    /// Corners, counter-clockwise.
    pub(super) corners: [u32; 3],
    /// Old face that contains the triangle, or [`OUTSIDE`].
    pub(super) source: u32,
}

#[derive(Debug)]
pub(super) struct Patchwork {
    /// All triangles ever added. Exchanged ones remain here, but no vertex lists them.
    triangles: Vec<Triangle>,
    /// Triangles at each vertex, ascending.
    at: Vec<Vec<u32>>,
    /// Position of each vertex.
    pub(super) places: Vec<DVec2>,
}

/// Region of one old face, or of the outside, that the triangles at a vertex cover. Corners are counter-clockwise,
/// without the vertex itself, starting after it on its edge and ending before it.
#[derive(Clone, Debug)]
pub(super) struct Hole {
    pub(super) source: u32,
    pub(super) triangles: Vec<u32>,
    pub(super) corners: Vec<u32>,
}

impl Patchwork {
    pub(super) fn new(places: Vec<DVec2>, triangles: Vec<Triangle>) -> Self {
        let mut at = vec![Vec::new(); places.len()];
        for (triangle, number) in triangles.iter().zip(0..) {
            triangle.corners.iter().for_each(|&v| at[v as usize].push(number));
        }
        Self { triangles, at, places }
    }

    pub(super) fn triangle(&self, number: u32) -> Triangle {
        self.triangles[number as usize]
    }

    /// Triangles at a vertex, ascending.
    pub(super) fn at(&self, vertex: u32) -> &[u32] {
        &self.at[vertex as usize]
    }

    /// All present triangles.
    pub(super) fn all(&self) -> impl Iterator<Item = Triangle> + '_ {
        let lives = |(number, triangle): &(u32, &Triangle)| self.at(triangle.corners[0]).contains(number);
        (0..).zip(&self.triangles).filter(lives).map(|(_, triangle)| *triangle)
    }

    /// Regions that the triangles at a vertex cover, by source.
    pub(super) fn holes(&self, vertex: u32) -> Vec<Hole> {
        let mut of_source: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &number in self.at(vertex) {
            of_source.entry(self.triangle(number).source).or_default().push(number);
        }
        let hole = |(source, triangles): (u32, Vec<u32>)| {
            let corners = self.link(vertex, &triangles);
            Hole { source, triangles, corners }
        };
        of_source.into_iter().map(hole).collect()
    }

    /// Vertices around a fan of triangles at a vertex, counter-clockwise.
    fn link(&self, vertex: u32, triangles: &[u32]) -> Vec<u32> {
        let side = |&number: &u32| {
            let t = self.triangle(number).corners;
            t.iter().position(|&v| v == vertex).map(|k| (t[(k + 1) % 3], t[(k + 2) % 3]))
        };
        let sides: BTreeMap<u32, u32> = triangles.iter().filter_map(side).collect();
        let first = sides.keys().find(|v| !sides.values().any(|w| w == *v)).copied();
        std::iter::successors(first, |v| sides.get(v).copied()).take(sides.len() + 1).collect()
    }

    /// Replaces triangles by others. Returns the numbers of the new ones.
    pub(super) fn exchange(&mut self, old: &[u32], new: impl IntoIterator<Item = Triangle>) -> Vec<u32> {
        for &number in old {
            for v in self.triangle(number).corners {
                self.at[v as usize].retain(|&other| other != number);
            }
        }
        let first = self.triangles.len();
        self.triangles.extend(new);
        let numbers: Vec<u32> = (first..self.triangles.len()).filter_map(|number| u32::try_from(number).ok()).collect();
        self.put_back(&numbers);
        numbers
    }

    /// Undoes the latest exchange.
    pub(super) fn undo(&mut self, old: &[u32], new: &[u32]) {
        self.exchange(new, []);
        self.triangles.truncate(self.triangles.len() - new.len());
        self.put_back(old);
    }

    fn put_back(&mut self, numbers: &[u32]) {
        for &number in numbers {
            for v in self.triangle(number).corners {
                let at = &mut self.at[v as usize];
                let place = at.partition_point(|&other| other < number);
                at.insert(place, number);
            }
        }
    }
}
