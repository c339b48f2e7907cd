//! Triangles of the plane whose insides meet.

use glam::DVec2;

use super::{Bounds, BoxTree, Orientation, orientation, place_along_curve};
use crate::parallel::prelude::*;

/// Triangles that are compared before the number of pairs is looked at.
const TRIANGLES_PER_ROUND: usize = 1 << 14;

/// Pairs of triangles whose insides meet, each with its lower number first, ascending; at most `most`. Triangles are
/// counter-clockwise. Only pairs for which `counts` is true are found. Exact.
pub(crate) fn overlaps(
    triangles: &[[DVec2; 3]],
    counts: impl Fn(usize, usize) -> bool + Sync,
    most: usize,
) -> Vec<[usize; 2]> {
    let bounds: Vec<Bounds> = triangles.iter().map(|corners| Bounds::of(*corners)).collect();
    let whole = bounds.iter().fold(Bounds::EMPTY, |whole, own| whole.union(*own));
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by_cached_key(|&triangle| (place_along_curve(whole, bounds[triangle].middle()), triangle));
    let tree = BoxTree::new(order.iter().map(|&triangle| bounds[triangle]));
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for begin in (0..order.len()).step_by(TRIANGLES_PER_ROUND) {
        let round = begin..(begin + TRIANGLES_PER_ROUND).min(order.len());
        let of_place = |place: usize| {
            let own = order[place];
            let others = tree.later(place).map(|other| order[other]);
            let over = others.filter(|&other| counts(own, other) && lie_over(triangles[own], triangles[other]));
            over.map(|other| [own.min(other), own.max(other)]).take(most).collect::<Vec<_>>()
        };
        pairs.par_extend(round.into_par_iter().flat_map_iter(of_place));
        if pairs.len() >= most {
            break;
        }
    }
    pairs.sort_unstable();
    pairs.truncate(most);
    pairs
}

/// True if the insides of two triangles meet.
fn lie_over(a: [DVec2; 3], b: [DVec2; 3]) -> bool {
    !has_beside(a, b) && !has_beside(b, a)
}

/// True if a side of the first triangle has the other triangle on its outer side or on its line.
fn has_beside([a, b, c]: [DVec2; 3], other: [DVec2; 3]) -> bool {
    let is_inward = |[from, to]: [DVec2; 2], z: DVec2| orientation(from, to, z) == Some(Orientation::CounterClockwise);
    [[a, b], [b, c], [c, a]].into_iter().any(|side| !other.iter().any(|&z| is_inward(side, z)))
}
