//! Placing: an embedding that is proved is brought to where it is asked for, and no face folds on the way.
//!
//! A similarity in 64 bits rounds, and rounding folds what is fine. Each wish therefore has several *ways*, tried in turn
//! until one is proved: as wished; upright only up to a multiple of 90°; by a power of two, which rounds nothing; by a shift that is a multiple of the largest
//! coordinate's last digit, which rounds that one not at all. Where none will do, the embedding stays where it lies: what
//! is proved is never given up for a place.

use glam::DVec2;

use super::upright::Turns;
use crate::geom::{Bounds, Similarity, double_area, power_of_two_near};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::problem::{Control, Embedding, GaugeSize, Pins, SolveError};
use crate::weights::equations::length_scale;

/// What the rounding of a turn adds to a length at most, as a share of it.
const TURN_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What is wanted of an embedding's place.
#[derive(Debug)]
pub(crate) struct Placing {
    /// Ways to it, the best first.
    ways: Vec<Similarity>,
    /// Vertices that end on these places to the last bit.
    anchors: Vec<(VertexId, DVec2)>,
}

/// An embedding in its place.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) embedding: Embedding,
    /// The way that it took; none where each would have folded it, and it lies as before.
    pub(crate) way: Option<Similarity>,
    /// Whether that was the first.
    pub(crate) is_as_wished: bool,
}

impl Placing {
    /// To where up to two pins want an embedding; at the size asked for, and turned, where they do not say. None where two
    /// pins have fallen together, and no similarity takes them to their targets.
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
                // The quotient wanted / is of complex numbers.
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

    /// To where an embedding fits pins best, in the sum of squares; the targets are not met by that.
    pub(crate) fn fitting(embedding: &Embedding, pins: &Pins) -> Self {
        let pairs: Vec<[DVec2; 2]> = pins.iter().map(|(v, pin)| [embedding[v], pin.target]).collect();
        let shift = pairs.iter().map(|[is, wanted]| *wanted - *is).sum::<DVec2>() / pairs.len().max(1) as f64;
        let alike = rounding_alike(shift, extent_of(embedding));
        let shifts = [shift, alike].map(|shift| scaled(1.0, DVec2::ZERO, shift));
        Self { ways: Similarity::fitting(&pairs).into_iter().chain(shifts).collect(), anchors: Vec::new() }
    }

    /// The first of two embeddings over the second, as large and turned as that is; a pin moves it from there onto its target.
    /// What counts is the surface alone: no vertices of no face, of what fills holes, or that the second does not have.
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

    /// The embedding in the place that is wished for.
    pub(crate) fn as_wished(&self, embedding: &Embedding) -> Embedding {
        self.along(&self.ways[0], embedding)
    }

    /// The embedding by the first way that a proof `holds` on. One that does not hold as it lies goes as wished.
    ///
    /// # Errors
    ///
    /// Those of the proof.
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

/// What pins do not say of an embedding's place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Free {
    pub(crate) size: GaugeSize,
    pub(crate) turns: Turns,
}

/// What is to be placed, what of its place is free, and who may stop it.
#[derive(Clone, Copy)]
pub(crate) struct Placement<'a> {
    pub(crate) mesh: &'a DiskMesh,
    pub(crate) embedding: &'a Embedding,
    pub(crate) free: Free,
    pub(crate) control: Control<'a>,
}

impl Placement<'_> {
    /// Ways to stand upright at a size, one point moved onto another, the best first.
    fn upright_ways(self, [from, to]: [DVec2; 2]) -> Result<Vec<Similarity>, SolveError> {
        let Free { size, turns } = self.free;
        let [factor, power] = with_power_of_two(self.factor_of(size)?, f64::round);
        let ways = [(factor, turns.wished), (factor, turns.quarter), (power, turns.quarter)];
        Ok(ways.map(|(factor, turn)| Similarity::new(factor * turn, from, to)).into())
    }

    /// The factor that gives an embedding the size asked for; 1 where it has no finite extent.
    fn factor_of(self, size: GaugeSize) -> Result<f64, SolveError> {
        let factor = match size {
            GaugeSize::TrueArea => area_factor(self.mesh, self.embedding, self.control)?,
            GaugeSize::Within(into) => (into.size() / self.embedding.bounds().size()).min_element(),
        };
        Ok(usable_factor(factor))
    }
}

/// Ways into the middle of a box as large as it holds an embedding that is turned, the best first.
fn within(embedding: &Embedding, into: Bounds, turn: DVec2) -> Vec<Similarity> {
    let turned = Bounds::of(embedding.iter().map(|&z| turn.rotate(z)));
    let fitting = usable_factor((into.size() / turned.size()).min_element());
    // The rounding of a turn must not reach out of the box.
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

/// Moves an embedding to where fewer than two pins want it, without a turn and without a proof.
pub(crate) fn complete_gauge(mesh: &DiskMesh, embedding: &mut Embedding, pins: &Pins, size: GaugeSize) {
    let free = Free { size, turns: Turns::NONE };
    let placement = Placement { mesh, embedding, free, control: Control::unattended() };
    if let Ok(Some(placing)) = Placing::of_gauge(placement, pins) {
        *embedding = placing.as_wished(embedding);
    }
}

/// Multiplies by a factor and moves one point onto another.
fn scaled(factor: f64, from: DVec2, to: DVec2) -> Similarity {
    Similarity::new(DVec2::new(factor, 0.0), from, to)
}

/// A factor, and the power of two next to it.
fn with_power_of_two(factor: f64, next: fn(f64) -> f64) -> [f64; 2] {
    [factor, next(factor.log2()).exp2()]
}

/// A shift changed to a multiple of the last digit of numbers as large as `extent`, so that these round to themselves.
fn rounding_alike(shift: DVec2, extent: f64) -> DVec2 {
    let digit = extent.next_up() - extent;
    if digit.is_finite() && digit > 0.0 { (shift / digit).round() * digit } else { shift }
}

fn usable_factor(factor: f64) -> f64 {
    if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
}

/// The factor to the total area of the surface, holes left out, in the mesh's unit. Both areas are summed at a size near 1, so that no square of a length
/// overflows or vanishes.
pub fn true_area_factor(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    // Nobody stops it.
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
    // Summed in one order, for any number of threads.
    let surface: f64 = control.each(count, surface)?.iter().sum();
    let flat: f64 = control.each(count, flat)?.iter().sum();
    Ok((surface / flat).sqrt() * (in_plane / in_space))
}

/// Scales an embedding about the origin to the total area of the surface; one without a finite area stays as it is.
pub fn to_true_area(mesh: &DiskMesh, embedding: &mut Embedding) {
    let factor = usable_factor(true_area_factor(mesh, embedding));
    for z in embedding.iter_mut() {
        *z *= factor;
    }
}

/// Largest coordinate by amount.
fn extent_of(embedding: &Embedding) -> f64 {
    embedding.iter().fold(0.0, |m, z| m.max(z.abs().max_element()))
}

/// As [`to_unit_square`], but scaled by a power of two alone: the one rounding is that of the move.
pub fn to_unit_square_by_power_of_two(embedding: &mut Embedding) {
    let Bounds { low, .. } = embedding.bounds();
    for z in embedding.iter_mut() {
        *z -= low;
    }
    to_unit_box(embedding);
}

/// Scales an embedding about the origin by a power of two, so that no coordinate lies beyond −1 or 1. No digit is lost
/// unless a coordinate is too small for 64 bits afterwards.
pub fn to_unit_box(embedding: &mut Embedding) {
    let extent = extent_of(embedding);
    if extent.is_finite() && extent > 0.0 {
        let factor = (-extent.log2().ceil()).exp2();
        for z in embedding.iter_mut() {
            *z *= factor;
        }
    }
}

/// Moves and scales an embedding uniformly to fill the unit square's width or height from the origin on; one without a
/// finite extent stays as it is.
pub fn to_unit_square(embedding: &mut Embedding) {
    let bounds = embedding.bounds();
    let extent = bounds.size().max_element();
    if extent.is_finite() && extent > 0.0 {
        for z in embedding.iter_mut() {
            *z = (*z - bounds.low) / extent;
        }
    }
}
