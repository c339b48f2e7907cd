//! Welding of vertices that lie near each other.
//!
//! Vertices are visited in the order of their numbers. Some become *representatives*. A vertex within the distance of
//! a representative joins the nearest one; at a tie, the one with the lowest number. Any other vertex becomes a
//! representative itself. So no vertex moves by more than the distance: a row of vertices, each near the next, does
//! not collapse into its first vertex. Joining all near pairs would collapse it.
//!
//! Representatives are stored in the cells of a grid, each slightly wider than the distance. They are farther apart
//! than the distance, so a cell holds few of them. Time is linear in the number of vertices.

use std::collections::HashMap;
use std::ops::RangeInclusive;

use glam::DVec3;

use super::{Repair, Repaired, WeldDistance};
use crate::mesh::{PolygonMesh, VertexId};

/// Smallest ratio of cell width to distance, so that rounding does not put near vertices two cells apart.
const MARGIN: f64 = 1.01;

/// Cell number from which adjacent floats are farther apart than the distance: near coordinates are equal there.
const LAST_CELL: f64 = (1_u64 << 53) as f64;

/// Largest width of a cell.
const WIDEST: f64 = f64::from_bits(2046 << 52);

/// Returns the vertices of faces that a weld within `distance` joins with others, each with its representative.
/// Ascending.
pub fn near_vertices(polygons: &PolygonMesh, distance: WeldDistance) -> Vec<[VertexId; 2]> {
    let count = polygons.positions.len();
    let mut used = vec![false; count];
    polygons.corners.iter().filter(|corner| corner.index() < count).for_each(|corner| used[corner.index()] = true);
    let is_looked_at = |&vertex: &VertexId| used[vertex.index()] && polygons.positions[vertex.index()].is_finite();
    let vertices: Vec<VertexId> = (0..used.len()).map(VertexId::from_index).filter(is_looked_at).collect();
    let mut grid = Grid::new(&polygons.positions, distance.get());
    vertices.into_iter().filter_map(|vertex| grid.join(vertex).map(|to| [vertex, to])).collect()
}

/// Representatives by grid cell.
struct Grid<'a> {
    positions: &'a [DVec3],
    /// Width of a cell, a power of two: dividing by it rounds nothing.
    width: f64,
    /// Welding distance, in cell widths.
    reach: f64,
    cells: HashMap<[i64; 3], Vec<VertexId>>,
}

impl<'a> Grid<'a> {
    fn new(positions: &'a [DVec3], distance: f64) -> Self {
        let width = (distance * MARGIN).clamp(f64::MIN_POSITIVE, WIDEST).log2().ceil().exp2();
        Self { positions, width, reach: distance / width, cells: HashMap::new() }
    }

    /// Number of the cell of a coordinate along an axis, and the range of cells that can hold near coordinates.
    fn cells_near(&self, place: f64) -> (i64, RangeInclusive<i64>) {
        let cell = (place / self.width).floor();
        if cell.abs() < LAST_CELL {
            #[expect(clippy::cast_possible_truncation, reason = "a whole number below that of the last cell")]
            let cell = cell as i64;
            (cell, cell - 1..=cell + 1)
        } else {
            // Such a coordinate has a cell to itself. Any other coordinate with this cell number is too far away.
            let cell = place.to_bits().cast_signed();
            (cell, cell..=cell)
        }
    }

    /// Distance from a point to a vertex, in cell widths.
    fn in_cells(&self, place: DVec3, vertex: VertexId) -> f64 {
        ((place - self.positions[vertex.index()]) / self.width).length()
    }

    /// Returns the representative that a vertex joins. If there is none, the vertex becomes a representative.
    fn join(&mut self, vertex: VertexId) -> Option<VertexId> {
        let place = self.positions[vertex.index()];
        let [(x, near_x), (y, near_y), (z, near_z)] = place.to_array().map(|place| self.cells_near(place));
        let columns = near_x.flat_map(|x| near_y.clone().map(move |y| [x, y]));
        let around = columns.flat_map(|[x, y]| near_z.clone().map(move |z| [x, y, z]));
        let near = around.filter_map(|cell| self.cells.get(&cell));
        let near = near.flatten().map(|&other| (self.in_cells(place, other), other));
        let nearest = near.filter(|&(far, _)| far <= self.reach);
        let nearest = nearest.min_by(|(a, v), (b, w)| a.total_cmp(b).then(v.cmp(w)));
        if nearest.is_none() {
            self.cells.entry([x, y, z]).or_default().push(vertex);
        }
        nearest.map(|(_, other)| other)
    }
}

impl Repaired {
    /// Joins vertices of faces within a distance, of any parts. The representative, the lowest number of its group,
    /// keeps its position.
    pub(super) fn weld_within(&mut self, distance: WeldDistance) {
        let near = near_vertices(&self.polygons, distance);
        self.joined.extend(near.iter().map(|&[vertex, to]| (vertex, to)));
        for corner in &mut self.polygons.corners {
            *corner = self.joined.get(corner).copied().unwrap_or(*corner);
        }
        self.note(Repair::WeldVertices, near.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_holds_few_vertices_however_far_away_another_one_lies() {
        let place = |k: u32| DVec3::new(f64::from(k % 40), f64::from(k / 40), 0.0) / 40.0;
        for far in [1.0, 1e13, 1e40, 1e300] {
            let positions: Vec<DVec3> = (0..1600).map(place).chain([DVec3::X * far]).collect();
            for distance in [0.0, 1e-300, 1e-9, 0.01, 0.024] {
                let mut grid = Grid::new(&positions, distance);
                for vertex in 0..positions.len() {
                    grid.join(VertexId::from_index(vertex));
                }
                let most = grid.cells.values().map(Vec::len).max();
                assert!(most <= Some(9), "{most:?} in a cell, the farthest at {far}, within {distance}");
            }
        }
    }
}
