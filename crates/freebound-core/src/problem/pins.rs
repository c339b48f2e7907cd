//! Pins that the user prescribes, and gauge pins that stand in if there are too few (paper §3.3).

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::SolveError;
use crate::mesh::{DiskMesh, VertexId};

/// Positions of vertices. Ordered, so that solves are repeatable.
pub type PinPositions = BTreeMap<VertexId, DVec2>;

/// Pinned vertices with their targets.
pub type Pins = BTreeMap<VertexId, Pin>;

/// Least number of pins that fix the similarity of a free boundary. Also the largest number of hard pins that are no
/// constraints.
pub(crate) const GAUGE_PINS: usize = 2;

/// Prescribed position of a vertex, and the kind of its pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Target position.
    pub target: DVec2,
    /// Kind of the pin.
    pub kind: PinKind,
}

/// Kind of a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinKind {
    /// Met exactly: the vertex was fixed where it lay.
    Fixed,
    /// Met exactly: a constraint.
    Hard,
    /// Met by a spring: `weight · (z − target)` is one more equation beside those of the vertices (paper §6).
    Soft(f64),
}

impl PinKind {
    /// True if the target is met to the last bit.
    pub const fn is_hard(self) -> bool {
        !matches!(self, Self::Soft(_))
    }

    /// True if both kinds hold a vertex alike: both to the last bit, or with equal weights.
    pub fn is_like(self, other: Self) -> bool {
        self == other || (self.is_hard() && other.is_hard())
    }

    /// Weight of a soft pin, if it is not a positive number.
    pub fn invalid_weight(self) -> Option<f64> {
        match self {
            Self::Soft(weight) if !(weight.is_finite() && weight > 0.0) => Some(weight),
            _ => None,
        }
    }
}

impl Pin {
    /// Default weight of a soft constraint: a balance between the mesh and the pins.
    pub const DEFAULT_WEIGHT: f64 = 1.0;

    /// Least weight. Lighter pins are clamped to it, which hardly moves anything.
    pub(crate) const LEAST_WEIGHT: f64 = 1e-12;

    /// Greatest weight. Heavier pins are clamped to it, which meets their targets to within rounding.
    pub(crate) const GREATEST_WEIGHT: f64 = 1e12;

    /// Hard pin: a constraint that is met exactly.
    pub const fn hard(target: DVec2) -> Self {
        Self { target, kind: PinKind::Hard }
    }

    /// Fixed pin: a vertex that stays where it is.
    pub const fn fixed(target: DVec2) -> Self {
        Self { target, kind: PinKind::Fixed }
    }

    /// Soft pin: a constraint that pulls with a weight.
    pub const fn weighted(target: DVec2, weight: f64) -> Self {
        Self { target, kind: PinKind::Soft(weight) }
    }
}

/// True if two sets of pins differ at most in targets: equal vertices, held alike.
pub fn are_held_alike(a: &Pins, b: &Pins) -> bool {
    let alike = |((v, p), (w, q)): ((&VertexId, &Pin), (&VertexId, &Pin))| v == w && p.kind.is_like(q.kind);
    a.len() == b.len() && a.iter().zip(b).all(alike)
}

pub(crate) fn targets_of(pins: &Pins) -> PinPositions {
    pins.iter().map(|(&vertex, pin)| (vertex, pin.target)).collect()
}

/// Hard pins on vertices at these positions.
pub fn hard_pins(places: impl IntoIterator<Item = (VertexId, DVec2)>) -> Pins {
    places.into_iter().map(|(vertex, target)| (vertex, Pin::hard(target))).collect()
}

/// Fixed pins on vertices at these positions.
pub fn fixed_pins(places: impl IntoIterator<Item = (VertexId, DVec2)>) -> Pins {
    places.into_iter().map(|(vertex, target)| (vertex, Pin::fixed(target))).collect()
}

/// Targets of hard pins, to find two pins with one target.
#[derive(Clone, Debug, Default)]
pub struct TakenTargets(BTreeMap<[u64; 2], VertexId>);

impl TakenTargets {
    /// Registers the target of a hard pin. Returns the vertex that already has this target, if there is one.
    pub fn take(&mut self, vertex: VertexId, target: DVec2, kind: PinKind) -> Option<VertexId> {
        // Adding zero turns −0 into 0.
        let bits = (target + 0.0).to_array().map(f64::to_bits);
        kind.is_hard().then(|| self.0.insert(bits, vertex)).flatten()
    }
}

/// Checks that every pin can be met and that no two hard pins have one target.
///
/// # Errors
///
/// Error of the first invalid pin, in the order of vertices.
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

/// The default gauge: the farthest pair of boundary vertices, placed on the x-axis at their distance in space. The
/// vertex with the lower id is at the origin.
pub fn gauge_pins(mesh: &DiskMesh) -> PinPositions {
    let [a, b] = farthest_pair(mesh);
    let distance = mesh.position(a).distance(mesh.position(b));
    BTreeMap::from([(a.min(b), DVec2::ZERO), (a.max(b), DVec2::new(distance, 0.0))])
}

/// Pair of boundary vertices farthest apart in space. Pairs of boxes are compared, largest bound first. A pair is
/// dropped if its bound does not exceed the best distance so far: near linear even on a circle.
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

/// Largest number of points in a leaf.
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

    /// Upper bound of the squared distance between points of two boxes.
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
