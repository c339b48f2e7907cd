//! Coordinates rounded to 32 bits, and moved by a few units in the last place if rounding folds a face.
//!
//! Rounding moves each vertex by at most half a unit. If a face folds, positions around its corners are tried, one
//! corner at a time. The first position with the fewest wrong faces and polygon corners around it is taken. The
//! search is bounded and deterministic, but need not succeed: the verdict on its result decides.

use std::collections::BTreeSet;

use glam::DVec2;

use super::verdict::sense_of_surface;
use crate::geom::{Orientation, orientation};
use crate::mesh::{DiskMesh, VertexId};
use crate::problem::Embedding;

/// Largest moves of corners in each sweep over the wrong faces, in units in the last place.
const REACH: [i32; 7] = [1, 1, 2, 2, 3, 4, 4];

/// Largest number of wrong triples. With more, the mesh is too fine for 32 bits and no move is tried.
const MOST_WRONG: usize = 1 << 14;

/// Grid of 32-bit numbers that coordinates are rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoundingGrid {
    /// Numbers for u and v.
    Upright,
    /// Numbers for u and 1 − v, as in files with v down. `1.0 - v` gives the file's number without rounding, up to
    /// 2⁵².
    TurnedOver,
}

impl RoundingGrid {
    /// Nearest point on the grid.
    pub fn nearest(self, z: DVec2) -> DVec2 {
        let y = match self {
            Self::Upright => in_32_bits(z.y),
            Self::TurnedOver => 1.0 - in_32_bits(1.0 - z.y),
        };
        DVec2::new(in_32_bits(z.x), y)
    }

    /// Units in the last place of the grid's numbers at a point.
    fn units(self, z: DVec2) -> DVec2 {
        let y = if self == Self::Upright { z.y } else { 1.0 - z.y };
        DVec2::new(unit(z.x), unit(y))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "to be rounded")]
fn in_32_bits(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Distance of a 32-bit number from the next one away from 0.
#[expect(clippy::cast_possible_truncation, reason = "to be rounded")]
fn unit(x: f64) -> f64 {
    let x = x.abs() as f32;
    f64::from(x.next_up()) - f64::from(x)
}

/// Coordinates rounded to 32 bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    /// Rounded coordinates.
    pub embedding: Embedding,
    /// Number of vertices that are not at the nearest numbers, because these fold a face.
    pub moved: usize,
}

/// Rounds an embedding to 32 bits. If it is planar and the nearest numbers fold it, vertices that are not `held` move
/// by a few units in the last place.
///
/// # Panics
///
/// If the embedding does not have one position per vertex.
pub fn rounded(mesh: &DiskMesh, embedding: &Embedding, grid: RoundingGrid, held: &BTreeSet<VertexId>) -> Rounded {
    let nearest: Embedding = embedding.iter().map(|&z| grid.nearest(z)).collect();
    let Some(upright) = sense_of_surface(mesh, embedding).filter(|_| sense_of_surface(mesh, &nearest).is_none()) else {
        return Rounded { embedding: nearest, moved: 0 };
    };
    let mut search = Search { mesh, exact: embedding, grid, held, upright, placed: nearest.clone() };
    for reach in REACH {
        let wrong = search.wrong_triples();
        if wrong.is_empty() || wrong.len() > MOST_WRONG {
            break;
        }
        for triple in &wrong {
            search.mend(triple, reach);
        }
    }
    let moved = nearest.iter().zip(search.placed.iter()).filter(|(before, after)| before != after).count();
    Rounded { embedding: search.placed, moved }
}

/// Three vertices that must turn as all faces do: the corners of a face, or a corner of a polygon with its
/// neighbours.
type Triple = [VertexId; 3];

struct Search<'a> {
    mesh: &'a DiskMesh,
    exact: &'a Embedding,
    grid: RoundingGrid,
    held: &'a BTreeSet<VertexId>,
    upright: Orientation,
    placed: Embedding,
}

/// Move of a vertex to another position.
#[derive(Clone, Copy)]
struct Move {
    vertex: VertexId,
    place: DVec2,
    /// Number of wrong triples that the move repairs.
    gain: usize,
}

impl Search<'_> {
    fn is_wrong(&self, triple: &Triple) -> bool {
        let [a, b, c] = triple.map(|vertex| self.placed[vertex]);
        orientation(a, b, c) != Some(self.upright)
    }

    /// All triples that turn the wrong way.
    fn wrong_triples(&self) -> Vec<Triple> {
        let faces = self.mesh.real_faces().map(|face| self.mesh.face(face));
        let ears = self.mesh.polygons().flat_map(|polygon| polygon.convex_ears().collect::<Vec<_>>());
        faces.chain(ears).filter(|triple| self.is_wrong(triple)).collect()
    }

    /// Triples of faces and polygons that contain a vertex.
    fn triples_at(&self, vertex: VertexId) -> Vec<Triple> {
        let mut found = Vec::new();
        let faces = self.mesh.outgoing(vertex).filter_map(|halfedge| self.mesh.face_of(halfedge));
        for face in faces.filter(|&face| !self.mesh.is_virtual(face)) {
            found.push(self.mesh.face(face));
            let ears = self.mesh.polygon_of(face).map(|polygon| polygon.convex_ears().collect::<Vec<_>>());
            found.extend(ears.into_iter().flatten());
        }
        found.sort_unstable();
        found.dedup();
        found.retain(|triple| triple.contains(&vertex));
        found
    }

    /// Moves the corner of a wrong triple that repairs most triples, if a move repairs any.
    fn mend(&mut self, triple: &Triple, reach: i32) {
        if !self.is_wrong(triple) {
            return;
        }
        let mut best: Option<Move> = None;
        for &vertex in triple.iter().filter(|vertex| !self.held.contains(vertex)) {
            let found = self.best_move(vertex, reach);
            best = best.into_iter().chain(found).reduce(|a, b| if b.gain > a.gain { b } else { a });
        }
        if let Some(Move { vertex, place, .. }) = best {
            self.placed[vertex] = place;
        }
    }

    /// Position around a vertex's exact position that repairs most triples, the nearest of several. `None` if no
    /// position is an improvement.
    fn best_move(&mut self, vertex: VertexId, reach: i32) -> Option<Move> {
        let triples = self.triples_at(vertex);
        let count = |search: &Self| triples.iter().filter(|triple| search.is_wrong(triple)).count();
        let before = self.placed[vertex];
        let now = count(self);
        let mut best: Option<Move> = None;
        for place in self.places(vertex, &triples, reach) {
            self.placed[vertex] = place;
            let gain = now.saturating_sub(count(self));
            if gain > best.map_or(0, |best| best.gain) {
                best = Some(Move { vertex, place, gain });
            }
        }
        self.placed[vertex] = before;
        best
    }

    /// Positions around a vertex's exact position, the nearest first, up to `reach` units away. The unit is the
    /// largest of the units at the vertices of `triples`.
    fn places(&self, vertex: VertexId, triples: &[Triple], reach: i32) -> Vec<DVec2> {
        let around = triples.as_flattened().iter().map(|&other| self.grid.units(self.placed[other]));
        let unit = around.fold(DVec2::ZERO, DVec2::max);
        let exact = self.exact[vertex];
        let offsets = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| DVec2::new(x.into(), y.into())));
        let mut places: Vec<DVec2> = offsets.map(|offset| self.grid.nearest(exact + offset * unit)).collect();
        places
            .sort_by(|a, b| ((*a - exact) / unit).length_squared().total_cmp(&((*b - exact) / unit).length_squared()));
        places
    }
}
