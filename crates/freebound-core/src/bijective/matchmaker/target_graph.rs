//! Graph that the paths match: a triangulation of the targets and of the frame's corners around them.
//!
//! The graph grows with the paths. Edges with short paths come first, and the final triangulation contains all of
//! them.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::{Orientation, constrained_triangles, delaunay_triangles, folds_back, orientation, segments_meet};

/// Plane graph of straight edges. Its vertices are the targets, followed by the corners of the frame.
#[derive(Clone, Debug)]
pub(super) struct TargetGraph {
    pub(super) points: Vec<DVec2>,
    /// Ends of each edge.
    pub(super) edges: Vec<[u32; 2]>,
    number_of_edge: BTreeMap<[u32; 2], u32>,
    /// Other ends of the edges at each vertex, counter-clockwise.
    neighbours: Vec<Vec<u32>>,
}

impl TargetGraph {
    /// Targets and frame without edges.
    pub(super) fn new(targets: &[DVec2], frame: &[DVec2]) -> Self {
        let points: Vec<DVec2> = targets.iter().chain(frame).copied().collect();
        let neighbours = vec![Vec::new(); points.len()];
        Self { points, edges: Vec::new(), number_of_edge: BTreeMap::new(), neighbours }
    }

    pub(super) fn edge_between(&self, a: u32, b: u32) -> Option<u32> {
        self.number_of_edge.get(&[a.min(b), a.max(b)]).copied()
    }

    /// Adds an edge. Returns its number.
    pub(super) fn add(&mut self, [a, b]: [u32; 2]) -> u32 {
        let number = u32::try_from(self.edges.len()).expect("edges fit");
        self.edges.push([a, b]);
        self.number_of_edge.insert([a.min(b), a.max(b)], number);
        for [from, to] in [[a, b], [b, a]] {
            let place = self.place_around(from, to);
            self.neighbours[from as usize].insert(place, to);
        }
        number
    }

    /// Neighbours of a vertex before and after the direction to another vertex, counter-clockwise. `None` without
    /// neighbours.
    pub(super) fn beside(&self, from: u32, to: u32) -> Option<[u32; 2]> {
        let (around, place) = (&self.neighbours[from as usize], self.place_around(from, to));
        let before = around.get(place.wrapping_sub(1)).or_else(|| around.last())?;
        let after = around.get(place).or_else(|| around.first())?;
        Some([*before, *after])
    }

    fn place_around(&self, from: u32, to: u32) -> usize {
        let at = |v: u32| self.points[v as usize];
        self.neighbours[from as usize].partition_point(|&other| by_turn(at(from), at(other), at(to)) == Ordering::Less)
    }

    /// True if a further edge would cross an existing one, or pass through a vertex.
    pub(super) fn bars(&self, [a, b]: [u32; 2]) -> bool {
        let at = |v: u32| self.points[v as usize];
        let line = [at(a), at(b)];
        let meets = |&[c, d]: &[u32; 2]| match [[c, d], [d, c]].into_iter().find(|[end, _]| [a, b].contains(end)) {
            None => segments_meet(line, [at(c), at(d)]),
            Some([shared, other]) => folds_back(at(if shared == a { b } else { a }), at(shared), at(other)),
        };
        let is_on_line = |v: u32| ![a, b].contains(&v) && segments_meet(line, [at(v); 2]);
        self.edges.iter().any(meets) || (0..).take(self.points.len()).any(is_on_line)
    }

    /// Edges missing for a triangulation. `None` if targets coincide or are too close for one.
    pub(super) fn missing_edges(&self) -> Option<Vec<[u32; 2]>> {
        let triangles = constrained_triangles(&self.points, &self.edges)?;
        let is_positive = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|corner| self.points[corner as usize]);
            orientation(a, b, c) == Some(Orientation::CounterClockwise)
        };
        if !triangles.iter().all(is_positive) {
            return None;
        }
        Some(sides(&triangles).filter(|&[a, b]| self.edge_between(a, b).is_none()).collect())
    }
}

/// Edges between points that are close to each other: those of their Delaunay triangulation.
pub(super) fn near_pairs(points: &[DVec2]) -> Vec<[u32; 2]> {
    delaunay_triangles(points).map_or_else(Vec::new, |triangles| sides(&triangles).collect())
}

/// Sides of triangles, each once, the lower number first; ascending.
fn sides(triangles: &[[u32; 3]]) -> impl Iterator<Item = [u32; 2]> + use<> {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sides: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    sides.sort_unstable();
    sides.dedup();
    sides.into_iter()
}

/// Order of two directions from a centre, counter-clockwise from the x axis.
fn by_turn(centre: DVec2, a: DVec2, b: DVec2) -> Ordering {
    let is_below = |z: DVec2| z.y.total_cmp(&centre.y).then(z.x.total_cmp(&centre.x)).is_lt();
    is_below(a).cmp(&is_below(b)).then_with(|| match orientation(centre, a, b) {
        Some(Orientation::CounterClockwise) => Ordering::Less,
        Some(Orientation::Clockwise) => Ordering::Greater,
        _ => Ordering::Equal,
    })
}
