//! Placement of a proved embedding at the requested position, without folding a face.
//!
//! A similarity in 64 bits rounds, and rounding folds thin faces. Each request therefore has several *ways*, tried in
//! order until one is proved: as requested; rotated by a multiple of 90° only; scaled by a power of two, which rounds
//! nothing; moved by a multiple of the last digit of the largest coordinate, which does not round that coordinate. If
//! all fail, the embedding stays where it is: a proof is never given up for a position.

use glam::DVec2;

use super::upright::Turns;
use crate::geom::{Bounds, Similarity, double_area, power_of_two_near};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::problem::{Control, Embedding, GaugeSize, Pins, SolveError};
use crate::weights::equations::length_scale;

/// Bound for the relative rounding error of a length under a rotation.
const TURN_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Requested placement of an embedding.
#[derive(Debug)]
pub(crate) struct Placing {
    /// Similarities that achieve it, the best first.
    ways: Vec<Similarity>,
    /// Vertices that end on these points to the last bit.
    anchors: Vec<(VertexId, DVec2)>,
}

/// Embedding after its placement.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) embedding: Embedding,
    /// Similarity that was applied. `None` if each would fold the embedding, which then stays.
    pub(crate) way: Option<Similarity>,
    /// True if the first similarity was applied.
    pub(crate) is_as_wished: bool,
}

impl Placing {
    /// Placement for up to two pins. Scale and rotation that the pins leave open follow `of.free`. `None` if two
    /// pinned vertices coincide, so that no similarity takes them to their targets.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(crate) fn of_gauge(of: Placement<'_>, pins: &Pins) -> Result<Option<Self>, SolveError> {
        let anchors: Vec<(VertexId, DVec2)> = pins.iter().map(|(&vertex, pin)| (vertex, pin.target)).take(2).collect();
        let Placement { embedding, free: Free { size, turns }, .. } = of;
        let ways = match (&anchors[..], size) {
            (&[(first, a), (second, b)], _) => {
                let (is, wanted) = (embedding[second] - embedding[first], b - a);
                // Quotient wanted / is of complex numbers.
                let turn = DVec2::new(is.dot(wanted), is.perp_dot(wanted)) / is.length_squared();
                if !turn.is_finite() || turn == DVec2::ZERO {
                    return Ok(None);
                }
                let [from, to] = [embedding[first].midpoint(embedding[second]), a.midpoint(b)];
                [[embedding[first], a], [embedding[second], b], [from, to]]
                    .map(|[from, to]| Similarity::new(turn, from, to))
                    .into()
            }
            (&[(vertex, target)], _) => of.upright_ways([embedding[vertex], target])?,
            (_, GaugeSize::TrueArea) => of.upright_ways([DVec2::ZERO; 2])?,
            (_, GaugeSize::Within(into)) => {
                let mut ways = within(embedding, into, turns.wished);
                if turns.wished != turns.quarter {
                    ways.truncate(1);
                    ways.extend(within(embedding, into, turns.quarter));
                }
                ways
            }
        };
        Ok(Some(Self { ways, anchors }))
    }

    /// Placement that fits the pins best, in the sum of squares. Targets are not met exactly.
    pub(crate) fn fitting(embedding: &Embedding, pins: &Pins) -> Self {
        let pairs: Vec<[DVec2; 2]> = pins.iter().map(|(v, pin)| [embedding[v], pin.target]).collect();
        let shift = pairs.iter().map(|[is, wanted]| *wanted - *is).sum::<DVec2>() / pairs.len().max(1) as f64;
        let alike = rounding_alike(shift, extent_of(embedding));
        let shifts = [shift, alike].map(|shift| scaled(1.0, DVec2::ZERO, shift));
        Self { ways: Similarity::fitting(&pairs).into_iter().chain(shifts).collect(), anchors: Vec::new() }
    }

    /// Placement of the first embedding over the second, with the scale and rotation of the second. A pin then moves
    /// it onto the pin's target. Only the surface counts: unreferenced vertices, vertices that fill holes, and
    /// vertices that the second embedding lacks are ignored.
    pub(crate) fn over(mesh: &DiskMesh, [embedding, other]: [&Embedding; 2], pins: &Pins) -> Self {
        let is_of_surface = |vertex: &VertexId| mesh.is_used(*vertex) && !mesh.is_virtual_vertex(*vertex);
        let pair = |vertex: VertexId| Some([embedding[vertex], *other.get(vertex.index())?]);
        let pairs: Vec<[DVec2; 2]> = mesh.vertices().filter(is_of_surface).filter_map(pair).collect();
        let stays = Similarity::new(DVec2::X, DVec2::ZERO, DVec2::ZERO);
        let over = Similarity::laying_over(&pairs).unwrap_or(stays);
        match pins.iter().next() {
            Some((&vertex, pin)) => {
                let ways = [over, stays].map(|way| way.moved([embedding[vertex], pin.target]));
                Self { ways: ways.into(), anchors: vec![(vertex, pin.target)] }
            }
            None => Self { ways: vec![over, stays], anchors: Vec::new() },
        }
    }

    /// Embedding in the requested placement.
    pub(crate) fn as_wished(&self, embedding: &Embedding) -> Embedding {
        self.along(&self.ways[0], embedding)
    }

    /// Embedding under the first similarity for which `holds` is true. If `holds` is false without a placement, the
    /// first similarity is applied.
    ///
    /// # Errors
    ///
    /// Errors of `holds`.
    pub(crate) fn best<E>(
        &self,
        embedding: &Embedding,
        holds: impl Fn(&Embedding) -> Result<bool, E>,
    ) -> Result<Placed, E> {
        let wished = self.as_wished(embedding);
        if holds(&wished)? || !holds(embedding)? {
            return Ok(Placed { embedding: wished, way: Some(self.ways[0]), is_as_wished: true });
        }
        for way in &self.ways[1..] {
            let placed = self.along(way, embedding);
            if holds(&placed)? {
                return Ok(Placed { embedding: placed, way: Some(*way), is_as_wished: false });
            }
        }
        Ok(Placed { embedding: embedding.clone(), way: None, is_as_wished: false })
    }

    fn along(&self, way: &Similarity, embedding: &Embedding) -> Embedding {
        let mut placed: Embedding = embedding.iter().map(|&z| way.apply(z)).collect();
        for &(vertex, target) in &self.anchors {
            placed[vertex] = target;
        }
        placed
    }
}

/// Degrees of freedom of a placement that pins leave open.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Free {
    pub(crate) size: GaugeSize,
    pub(crate) turns: Turns,
}

/// Embedding to place, with its free parameters and the control of cancellation.
#[derive(Clone, Copy)]
pub(crate) struct Placement<'a> {
    pub(crate) mesh: &'a DiskMesh,
    pub(crate) embedding: &'a Embedding,
    pub(crate) free: Free,
    pub(crate) control: Control<'a>,
}

impl Placement<'_> {
    /// Similarities that rotate an embedding upright at a size and move one point onto another, the best first.
    fn upright_ways(self, [from, to]: [DVec2; 2]) -> Result<Vec<Similarity>, SolveError> {
        let Free { size, turns } = self.free;
        let [factor, power] = with_power_of_two(self.factor_of(size)?, f64::round);
        let ways = [(factor, turns.wished), (factor, turns.quarter), (power, turns.quarter)];
        Ok(ways.map(|(factor, turn)| Similarity::new(factor * turn, from, to)).into())
    }

    /// Factor that gives an embedding the requested size. 1 if the embedding has no finite extent.
    fn factor_of(self, size: GaugeSize) -> Result<f64, SolveError> {
        let factor = match size {
            GaugeSize::TrueArea => area_factor(self.mesh, self.embedding, self.control)?,
            GaugeSize::Within(into) => (into.size() / self.embedding.bounds().size()).min_element(),
        };
        Ok(usable_factor(factor))
    }
}

/// Similarities that centre a rotated embedding in a box, as large as fits, the best first.
fn within(embedding: &Embedding, into: Bounds, turn: DVec2) -> Vec<Similarity> {
    let turned = Bounds::of(embedding.iter().map(|&z| turn.rotate(z)));
    let fitting = usable_factor((into.size() / turned.size()).min_element());
    // The rounding of the rotation must not exceed the box.
    let fitting = if turn == DVec2::X { fitting } else { fitting * (1.0 - TURN_ROUNDING) };
    let [factor, power] = with_power_of_two(fitting, f64::floor);
    let (from, to) = (DVec2::new(turn.x, -turn.y).rotate(turned.middle()), into.middle());
    let shift = rounding_alike(to - power * turned.middle(), power * extent_of(embedding));
    let [by_factor, by_power] = [factor, power].map(|factor| factor * turn);
    vec![
        Similarity::new(by_factor, from, to),
        Similarity::new(by_power, from, to),
        Similarity::new(by_power, DVec2::ZERO, shift),
        Similarity::new(by_power, DVec2::ZERO, DVec2::ZERO),
    ]
}

/// Places an embedding for fewer than two pins, without a rotation and without a proof.
pub(crate) fn complete_gauge(mesh: &DiskMesh, embedding: &mut Embedding, pins: &Pins, size: GaugeSize) {
    let free = Free { size, turns: Turns::NONE };
    let placement = Placement { mesh, embedding, free, control: Control::unattended() };
    if let Ok(Some(placing)) = Placing::of_gauge(placement, pins) {
        *embedding = placing.as_wished(embedding);
    }
}

/// Scales by a factor and moves one point onto another.
fn scaled(factor: f64, from: DVec2, to: DVec2) -> Similarity {
    Similarity::new(DVec2::new(factor, 0.0), from, to)
}

/// Factor, with the power of two next to it.
fn with_power_of_two(factor: f64, next: fn(f64) -> f64) -> [f64; 2] {
    [factor, next(factor.log2()).exp2()]
}

/// Shift rounded to a multiple of the last digit of numbers as large as `extent`, so that such numbers do not round.
fn rounding_alike(shift: DVec2, extent: f64) -> DVec2 {
    let digit = extent.next_up() - extent;
    if digit.is_finite() && digit > 0.0 { (shift / digit).round() * digit } else { shift }
}

fn usable_factor(factor: f64) -> f64 {
    if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
}

/// Factor to the total area of the surface, without holes, in the mesh's unit. Both areas are summed at a size near 1,
/// so that no square of a length overflows or underflows.
pub fn true_area_factor(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    // Cancellation is impossible here.
    area_factor(mesh, embedding, Control::unattended()).unwrap_or(1.0)
}

fn area_factor(mesh: &DiskMesh, embedding: &Embedding, control: Control<'_>) -> Result<f64, SolveError> {
    let (in_space, in_plane) = (length_scale(mesh), power_of_two_near(embedding.bounds().size().max_element()).recip());
    let count = mesh.mesh().real_face_count();
    let surface = |face| {
        let [a, b, c] = mesh.mesh().corners(FaceId::from_index(face)).map(|x| x * in_space);
        (b - a).cross(c - a).length()
    };
    let flat = |face| double_area(mesh.face(FaceId::from_index(face)).map(|v| embedding[v] * in_plane)).abs();
    // The order of summation does not depend on the number of threads.
    let surface: f64 = control.each(count, surface)?.iter().sum();
    // A surface without area counts with the area of its mollified shape.
    let mollified = |face| {
        let [a, b, c] = mesh.shape(mesh.face(FaceId::from_index(face))).map(|x| x * in_space);
        (b - a).cross(c - a).length()
    };
    let surface = if surface > 0.0 { surface } else { control.each(count, mollified)?.iter().sum() };
    let flat: f64 = control.each(count, flat)?.iter().sum();
    Ok((surface / flat).sqrt() * (in_plane / in_space))
}

/// Scales an embedding about the origin to the total area of the surface. Unchanged if its area is not finite.
pub fn to_true_area(mesh: &DiskMesh, embedding: &mut Embedding) {
    let factor = usable_factor(true_area_factor(mesh, embedding));
    for z in embedding.iter_mut() {
        *z *= factor;
    }
}

/// Largest absolute coordinate.
fn extent_of(embedding: &Embedding) -> f64 {
    embedding.iter().fold(0.0, |m, z| m.max(z.abs().max_element()))
}

/// Moves an embedding to the origin and scales it by a power of two into the unit square. Only the move rounds.
pub fn to_unit_square_by_power_of_two(embedding: &mut Embedding) {
    let Bounds { low, .. } = embedding.bounds();
    for z in embedding.iter_mut() {
        *z -= low;
    }
    to_unit_box(embedding);
}

/// Scales an embedding about the origin by a power of two, so that all coordinates lie between −1 and 1. No digit is
/// lost unless a coordinate becomes too small for 64 bits.
pub fn to_unit_box(embedding: &mut Embedding) {
    let extent = extent_of(embedding);
    if extent.is_finite() && extent > 0.0 {
        let factor = (-extent.log2().ceil()).exp2();
        for z in embedding.iter_mut() {
            *z *= factor;
        }
    }
}

/// Moves and scales an embedding uniformly to fill the width or height of the unit square, starting at the origin.
/// Unchanged if its extent is not finite.
pub fn to_unit_square(embedding: &mut Embedding) {
    let bounds = embedding.bounds();
    let extent = bounds.size().max_element();
    if extent.is_finite() && extent > 0.0 {
        for z in embedding.iter_mut() {
            *z = (*z - bounds.low) / extent;
        }
    }
}
