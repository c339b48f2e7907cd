//! Pins: what the user prescribes, and the gauge pins that stand in where that is too little (paper §3.3).

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::SolveError;
use crate::mesh::{DiskMesh, VertexId};

/// Positions of vertices. Ordered, so that solves are repeatable.
pub type PinPositions = BTreeMap<VertexId, DVec2>;

/// Pinned vertices with their targets.
pub type Pins = BTreeMap<VertexId, Pin>;

/// Fewest pins that fix the similarity of a free boundary, and the most that are no constraints.
pub(crate) const GAUGE_PINS: usize = 2;

/// A vertex's prescribed position, and how it is held there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Where the vertex is to be.
    pub target: DVec2,
    /// How it is held.
    pub kind: PinKind,
}

/// How a pin holds its vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinKind {
    /// Exactly; it was fixed where it lay.
    Fixed,
    /// Exactly; it is a constraint.
    Hard,
    /// By a spring: `weight · (z − target)` is one more equation among those of the vertices (paper §6).
    Soft(f64),
}

impl PinKind {
    /// Whether the target is met to the last bit.
    pub const fn is_hard(self) -> bool {
        !matches!(self, Self::Soft(_))
    }

    /// True if a vertex held in this way is held alike in another: both to the last bit, or with the same weight.
    pub fn is_like(self, other: Self) -> bool {
        self == other || (self.is_hard() && other.is_hard())
    }

    /// The weight, where it is not a positive number.
    pub fn invalid_weight(self) -> Option<f64> {
        match self {
            Self::Soft(weight) if !(weight.is_finite() && weight > 0.0) => Some(weight),
            _ => None,
        }
    }
}

impl Pin {
    /// The weight of a constraint that nobody weighed: medium, between what the mesh wants and what the pins want.
    pub const DEFAULT_WEIGHT: f64 = 1.0;

    /// The least weight that counts: lighter pins pull as this one does, which hardly moves anything.
    pub(crate) const LEAST_WEIGHT: f64 = 1e-12;

    /// The greatest weight that counts: heavier pins pull as this one does, to within rounding of their targets.
    pub(crate) const GREATEST_WEIGHT: f64 = 1e12;

    /// A constraint that is met exactly.
    pub const fn hard(target: DVec2) -> Self {
        Self { target, kind: PinKind::Hard }
    }

    /// A vertex that stays where it is.
    pub const fn fixed(target: DVec2) -> Self {
        Self { target, kind: PinKind::Fixed }
    }

    /// A constraint that pulls with a weight.
    pub const fn weighted(target: DVec2, weight: f64) -> Self {
        Self { target, kind: PinKind::Soft(weight) }
    }
}

/// Whether two sets of pins differ in their targets alone: the same vertices, held in the same way.
pub fn are_held_alike(a: &Pins, b: &Pins) -> bool {
    let alike = |((v, p), (w, q)): ((&VertexId, &Pin), (&VertexId, &Pin))| v == w && p.kind.is_like(q.kind);
    a.len() == b.len() && a.iter().zip(b).all(alike)
}

pub(crate) fn targets_of(pins: &Pins) -> PinPositions {
    pins.iter().map(|(&vertex, pin)| (vertex, pin.target)).collect()
}

/// Pins that hold vertices exactly, as constraints do.
pub fn hard_pins(places: impl IntoIterator<Item = (VertexId, DVec2)>) -> Pins {
    places.into_iter().map(|(vertex, target)| (vertex, Pin::hard(target))).collect()
}

/// Pins that hold vertices where they lie.
pub fn fixed_pins(places: impl IntoIterator<Item = (VertexId, DVec2)>) -> Pins {
    places.into_iter().map(|(vertex, target)| (vertex, Pin::fixed(target))).collect()
}

/// Targets of exact pins: no two may have the same.
#[derive(Clone, Debug, Default)]
pub struct TakenTargets(BTreeMap<[u64; 2], VertexId>);

impl TakenTargets {
    /// Takes a vertex's target, if it is held exactly. Returns the vertex that has it already, if there is one.
    pub fn take(&mut self, vertex: VertexId, target: DVec2, kind: PinKind) -> Option<VertexId> {
        // Adding zero makes one bit pattern of the two zeros.
        let bits = (target + 0.0).to_array().map(f64::to_bits);
        kind.is_hard().then(|| self.0.insert(bits, vertex)).flatten()
    }
}

/// Checks that every pin can be met and that no two exact ones have one target.
///
/// # Errors
///
/// The first pin at fault, by vertex.
pub fn check_pins(mesh: &DiskMesh, pins: &Pins) -> Result<(), SolveError> {
    let mut taken = TakenTargets::default();
    for (&vertex, pin) in pins {
        if vertex.index() >= mesh.vertex_count() || mesh.is_virtual_vertex(vertex) {
            return Err(SolveError::NoSuchVertex { vertex, count: mesh.real_vertex_count() });
        }
        if !mesh.is_used(vertex) {
            return Err(SolveError::UnusedVertex { vertex });
        }
        if !pin.target.is_finite() {
            return Err(SolveError::TargetNotFinite { vertex });
        }
        if let Some(weight) = pin.kind.invalid_weight() {
            return Err(SolveError::WeightNotPositive { vertex, weight });
        }
        if let Some(first) = taken.take(vertex, pin.target, pin.kind) {
            return Err(SolveError::CoincidentPins { first, second: vertex });
        }
    }
    Ok(())
}

/// The default gauge: the farthest pair of boundary vertices on the x-axis, the lower id at the origin, at their
/// distance in space.
pub fn gauge_pins(mesh: &DiskMesh) -> PinPositions {
    let [a, b] = farthest_pair(mesh);
    let distance = mesh.position(a).distance(mesh.position(b));
    BTreeMap::from([(a.min(b), DVec2::ZERO), (a.max(b), DVec2::new(distance, 0.0))])
}

/// The two boundary vertices farthest apart in space. Pairs of boxes are compared, largest bound first, and dropped
/// where they cannot hold a longer distance than the best one found: near linear even on a circle.
pub fn farthest_pair(mesh: &DiskMesh) -> [VertexId; 2] {
    let mut ids: Vec<VertexId> = mesh.boundary_loop().to_vec();
    ids.sort_unstable();
    let points: Vec<DVec3> = ids.iter().map(|&v| mesh.position(v)).collect();
    let mut order: Vec<u32> = (0..).take(ids.len()).collect();
    let tree = BoxTree::over(&points, &mut order, 0);
    let mut search = FarthestSearch { points: &points, order: &order, best: (-1.0, [0, 0]) };
    search.descend(&tree, &tree);
    let (_, [a, b]) = search.best;
    [ids[a as usize], ids[b as usize]]
}

/// Points in a leaf.
const LEAF: usize = 8;

/// A binary tree of boxes over a range of `order`.
struct BoxTree {
    low: DVec3,
    high: DVec3,
    range: std::ops::Range<usize>,
    halves: Option<Box<[BoxTree; 2]>>,
}

impl BoxTree {
    fn over(points: &[DVec3], order: &mut [u32], begin: usize) -> Self {
        let at = |i: u32| points[i as usize];
        let (low, high) = order
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &i| (low.min(at(i)), high.max(at(i))));
        let range = begin..begin + order.len();
        if order.len() <= LEAF {
            return Self { low, high, range, halves: None };
        }
        let axis = (high - low).max_position();
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&i, &j| at(i)[axis].total_cmp(&at(j)[axis]).then(i.cmp(&j)));
        let (left, right) = order.split_at_mut(middle);
        let halves = [Self::over(points, left, begin), Self::over(points, right, begin + middle)];
        Self { low, high, range, halves: Some(Box::new(halves)) }
    }

    /// No point of this box is farther from a point of the other than this.
    fn farthest_bound(&self, other: &Self) -> f64 {
        (self.high - other.low).abs().max((other.high - self.low).abs()).length_squared()
    }
}

struct FarthestSearch<'a> {
    points: &'a [DVec3],
    order: &'a [u32],
    best: (f64, [u32; 2]),
}

impl FarthestSearch<'_> {
    fn descend(&mut self, a: &BoxTree, b: &BoxTree) {
        if a.farthest_bound(b) <= self.best.0 {
            return;
        }
        let splits_first = a.halves.is_some() && (b.halves.is_none() || a.range.len() >= b.range.len());
        let (split, other) = if splits_first { (a, b) } else { (b, a) };
        let Some([first, second]) = split.halves.as_deref() else { return self.compare(a, b) };
        if first.farthest_bound(other) >= second.farthest_bound(other) {
            self.descend(first, other);
            self.descend(second, other);
        } else {
            self.descend(second, other);
            self.descend(first, other);
        }
    }

    fn compare(&mut self, a: &BoxTree, b: &BoxTree) {
        for &i in &self.order[a.range.clone()] {
            for &j in &self.order[b.range.clone()] {
                let squared = self.points[i as usize].distance_squared(self.points[j as usize]);
                if squared > self.best.0 && i != j {
                    self.best = (squared, [i.min(j), i.max(j)]);
                }
            }
        }
    }
}
