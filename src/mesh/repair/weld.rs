//! Vertices that lie near each other become one.
//!
//! Vertices are taken in the order of their numbers. One that lies within the distance of an earlier one that stands for
//! others joins the nearest of these, the one with the lowest number where several are as near; or else it stands for
//! others itself. So no vertex moves by more than the distance: a row of vertices, each near the next, does not collapse
//! into its first as the sets of all near pairs would.
//!
//! Those that stand for others lie in cells of a grid, at least as wide as the distance. They are farther apart than the
//! distance, so that a cell holds few of them, and time grows with the number of vertices alone.

use std::collections::HashMap;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Repair, Repaired};
use crate::mesh::{PolygonMesh, VertexId};

/// A cell is wider than the distance by this factor at least: rounding does not put near vertices two cells apart.
const MARGIN: f64 = 1.01;

/// The most cells along the longest side of the box around all vertices: numbers of cells are exact to a small part of one.
const MOST_CELLS: f64 = (1_u64 << 40) as f64;

/// The neighbours of a cell along one axis, and the cell.
const STEPS: [i64; 3] = [-1, 0, 1];

/// The vertices of faces that [`WeldDistance`] would join with others, each with the one that stands for it. Ascending.
pub fn near_vertices(polygons: &PolygonMesh, distance: WeldDistance) -> Vec<[VertexId; 2]> {
    let count = polygons.positions.len();
    let mut used = vec![false; count];
    polygons.corners.iter().filter(|corner| corner.index() < count).for_each(|corner| used[corner.index()] = true);
    let is_looked_at = |&vertex: &VertexId| used[vertex.index()] && polygons.positions[vertex.index()].is_finite();
    let vertices: Vec<VertexId> = (0..used.len()).map(VertexId::from_index).filter(is_looked_at).collect();
    let mut grid = Grid::new(polygons, &vertices, distance.get());
    vertices.into_iter().filter_map(|vertex| grid.join(vertex).map(|to| [vertex, to])).collect()
}

/// The greatest distance of vertices that become one, in the mesh's units: finite, and 0 or more.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct WeldDistance(f64);

impl WeldDistance {
    /// A distance; none where the number is none.
    pub fn new(distance: f64) -> Option<Self> {
        (distance.is_finite() && distance >= 0.0).then_some(Self(distance.abs()))
    }

    /// The distance, in the mesh's units.
    pub const fn get(self) -> f64 {
        self.0
    }
}

// It is never NaN.
impl Eq for WeldDistance {}

impl TryFrom<f64> for WeldDistance {
    type Error = &'static str;

    fn try_from(distance: f64) -> Result<Self, Self::Error> {
        Self::new(distance).ok_or("a distance is finite, and 0 or more")
    }
}

impl From<WeldDistance> for f64 {
    fn from(distance: WeldDistance) -> Self {
        distance.0
    }
}

/// Vertices that stand for others, by cells.
struct Grid<'a> {
    positions: &'a [DVec3],
    low: DVec3,
    /// Width of a cell, a power of two: dividing by it rounds nothing.
    width: f64,
    /// The distance in cells.
    reach: f64,
    cells: HashMap<[i64; 3], Vec<VertexId>>,
}

impl<'a> Grid<'a> {
    fn new(polygons: &'a PolygonMesh, vertices: &[VertexId], distance: f64) -> Self {
        let positions = &polygons.positions[..];
        let places = || vertices.iter().map(|vertex| positions[vertex.index()]);
        let (low, high) = (places().fold(DVec3::MAX, DVec3::min), places().fold(DVec3::MIN, DVec3::max));
        let longest = (high / 2.0 - low / 2.0).max_element().max(0.0) * 2.0;
        let least = (distance * MARGIN).max(longest / MOST_CELLS).clamp(f64::MIN_POSITIVE, f64::MAX / 4.0);
        let width = least.log2().ceil().exp2();
        Self { positions, low, width, reach: distance / width, cells: HashMap::new() }
    }

    /// How many cells wide a place and a vertex lie apart.
    fn in_cells(&self, place: DVec3, vertex: VertexId) -> f64 {
        ((place - self.positions[vertex.index()]) / self.width).length()
    }

    /// The vertex that one joins. Where there is none, it stands for others from now on.
    fn join(&mut self, vertex: VertexId) -> Option<VertexId> {
        let place = self.positions[vertex.index()];
        // Halves, for the difference of the greatest numbers has none.
        let own = ((place / 2.0 - self.low / 2.0) / (self.width / 2.0)).floor().as_i64vec3().to_array();
        let around = STEPS.iter().flat_map(|x| STEPS.iter().flat_map(move |y| STEPS.iter().map(move |z| [x, y, z])));
        let near = around.filter_map(|step| self.cells.get(&[0, 1, 2].map(|axis| own[axis] + step[axis])));
        let near = near.flatten().map(|&other| (self.in_cells(place, other), other));
        let nearest = near.filter(|&(far, _)| far <= self.reach);
        let nearest = nearest.min_by(|(a, v), (b, w)| a.total_cmp(b).then(v.cmp(w)));
        if nearest.is_none() {
            self.cells.entry(own).or_default().push(vertex);
        }
        nearest.map(|(_, other)| other)
    }
}

impl Repaired {
    /// Joins vertices of faces that lie within a distance, whatever parts they are of. The one with the lowest number stands
    /// for the others, in its place.
    pub(super) fn weld_within(&mut self, distance: WeldDistance) {
        let near = near_vertices(&self.polygons, distance);
        self.joined.extend(near.iter().map(|&[vertex, to]| (vertex, to)));
        for corner in &mut self.polygons.corners {
            *corner = self.joined.get(corner).copied().unwrap_or(*corner);
        }
        self.note(Repair::WeldVertices, near.len());
    }
}
