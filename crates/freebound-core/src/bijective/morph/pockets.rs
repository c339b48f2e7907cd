//! Pockets between a simple polygon and its hull, in layers.
//!
//! A pocket is a polygon between a side of the hull and the boundary. Its triangles form a tree with its root on the
//! side of the hull. Each triangle has an outer side and an *apex*, a corner of no triangle nearer to the hull. Apexes
//! at equal distance from the root form a layer. If all nearer layers are removed, each apex of a layer lies behind a
//! single triangle.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::geom::{convex_hull, outside_triangles};

/// Place of the boundary between two others, the ends: the first precedes it in the loop, the second follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Apex {
    pub(super) place: usize,
    pub(super) ends: [usize; 2],
}

/// Pockets of a simple polygon, counter-clockwise. All numbers are places in its loop.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Pockets {
    /// Corners of the hull, in loop order.
    pub(super) corners: Vec<usize>,
    /// Places within sides of the hull, between the ends of the side.
    pub(super) within_sides: Vec<Apex>,
    /// Apexes of the triangles between the ends of their outer sides, those next to the hull first.
    pub(super) layers: Vec<Vec<Apex>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Pockets {
    /// Pockets of a polygon. `None` if it is not simple.
    pub(super) fn of(polygon: &[DVec2]) -> Option<Self> {
        let triangles = outside_triangles(polygon, &[])?;
        let layers = layers(&triangles, polygon.len())?;
        let mut corners = convex_hull(polygon);
        corners.sort_unstable();
        let within: BTreeSet<usize> = layers.iter().flatten().map(|apex| apex.place).collect();
        let within_sides = (0..polygon.len())
            .filter(|place| corners.binary_search(place).is_err() && !within.contains(place))
            .map(|place| {
                let next = corners.partition_point(|&corner| corner < place);
                let before = corners[(next + corners.len() - 1) % corners.len()];
                Apex { place, ends: [before, corners[next % corners.len()]] }
            });
        Some(Self { within_sides: within_sides.collect(), corners, layers, triangles })
    }
}

/// Apexes of the triangles, from the hull inward. `None` if a place is the apex of two triangles.
fn layers(triangles: &[[u32; 3]], count: usize) -> Option<Vec<Vec<Apex>>> {
    let sides = |t: usize| {
        let [a, b, c] = triangles[t].map(|corner| corner as usize);
        [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
    };
    let is_of_loop = |[a, b]: [usize; 2]| b - a == 1 || b - a == count - 1;
    let mut beside: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for t in 0..triangles.len() {
        for side in sides(t).into_iter().filter(|&side| !is_of_loop(side)) {
            beside.entry(side).or_default().push(t);
        }
    }
    let mut is_done = vec![false; triangles.len()];
    let mut is_apex = vec![false; count];
    let mut outer: Vec<[usize; 2]> = beside.iter().filter(|(_, at)| at.len() == 1).map(|(&side, _)| side).collect();
    let mut layers = Vec::new();
    while !outer.is_empty() {
        let (mut layer, mut next) = (Vec::new(), Vec::new());
        for side in outer {
            let Some(&t) = beside[&side].iter().find(|&&t| !is_done[t]) else { continue };
            is_done[t] = true;
            let place = triangles[t].map(|corner| corner as usize).into_iter().find(|corner| !side.contains(corner))?;
            if std::mem::replace(&mut is_apex[place], true) {
                return None;
            }
            layer.push(between(place, side, count));
            next.extend(sides(t).into_iter().filter(|&other| other != side && !is_of_loop(other)));
        }
        layers.push(layer);
        outer = next;
    }
    Some(layers.into_iter().filter(|layer: &Vec<Apex>| !layer.is_empty()).collect())
}

/// Place with the ends of a side; the end that precedes it in the loop comes first.
fn between(place: usize, [a, b]: [usize; 2], count: usize) -> Apex {
    let behind = |end: usize| (end + count - place) % count;
    // In loop order from the place, the second end is met first.
    let ends = if behind(b) < behind(a) { [a, b] } else { [b, a] };
    Apex { place, ends }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(all: &[[i32; 2]]) -> Vec<DVec2> {
        all.iter().map(|&[x, y]| DVec2::new(x.into(), y.into())).collect()
    }

    #[test]
    fn a_square_has_no_pockets_and_what_lies_within_its_sides_lies_between_corners() {
        let found = Pockets::of(&points(&[[0, 1], [0, 0], [2, 0], [4, 0], [4, 4], [0, 4]])).expect("simple");
        assert_eq!((found.corners, found.layers), (vec![1, 3, 4, 5], vec![]));
        assert_eq!(found.within_sides, [Apex { place: 0, ends: [5, 1] }, Apex { place: 2, ends: [1, 3] }]);
    }

    #[test]
    fn every_place_that_is_not_on_the_hull_is_an_apex_between_places_nearer_to_the_hull() {
        let comb = points(&[[0, 0], [9, 0], [9, 5], [7, 1], [6, 2], [5, 5], [3, 1], [1, 4], [0, 5]]);
        let found = Pockets::of(&comb).expect("simple");
        assert_eq!(found.corners, [0, 1, 2, 8]);
        let mut nearer: BTreeSet<usize> = found.corners.iter().copied().collect();
        nearer.extend(found.within_sides.iter().map(|apex| apex.place));
        for layer in &found.layers {
            for apex in layer {
                assert!(apex.ends.iter().all(|end| nearer.contains(end)), "{apex:?}");
                let [a, b] = apex.ends.map(|end| (end + comb.len() - apex.place) % comb.len());
                assert!(b < a, "{apex:?}: the loop goes from the first end over the apex to the second");
            }
            nearer.extend(layer.iter().map(|apex| apex.place));
        }
        assert_eq!(nearer.len(), comb.len());
        let apexes: usize = found.layers.iter().map(Vec::len).sum();
        assert_eq!(apexes, found.triangles.len());
    }
}
