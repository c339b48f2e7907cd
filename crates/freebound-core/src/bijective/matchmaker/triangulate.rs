//! Triangulation of the cells such that straightened paths collapse no triangle.
//!
//! No edge within a region between paths may join two vertices of one path: once the path is straight, the edge would
//! lie on it (Floater 2003, "One-to-one piecewise linear mappings over triangulations"). A piece of an old edge that
//! does so gets one more vertex in its middle, on no path. A cell is cut such that no diagonal does so. If that is
//! impossible, one more vertex helps as well.

use std::collections::BTreeMap;

use super::subdivision::{NONE, Role, Subdivision};
use super::target_graph::TargetGraph;
use crate::mesh::{DiskMesh, FaceId, HalfedgeId};

/// Triangles by the old face that contains them. Uncut faces have no entry.
pub(super) type Parts = BTreeMap<FaceId, Vec<[u32; 3]>>;

/// True if an edge between two vertices would lie on a path once the path is straight.
fn joins_one_path(graph: &TargetGraph, [a, b]: [Role; 2]) -> bool {
    match (a, b) {
        (Role::Within(one), Role::Within(other)) => one == other,
        (Role::Within(path), Role::End(end)) | (Role::End(end), Role::Within(path)) => {
            graph.edges[path as usize].contains(&end)
        }
        (Role::End(a), Role::End(b)) => graph.edge_between(a, b).is_some(),
        (Role::Free, _) | (_, Role::Free) => false,
    }
}

/// Splits, in the middle, every piece of an edge that joins two vertices of one path but does not belong to the path.
pub(super) fn split_collapsing_edges(cells: &mut Subdivision, graph: &TargetGraph) {
    let first_of_each: Vec<u32> = (0..).take(cells.halfedge_count()).filter(|&h| h < cells[h].twin).collect();
    for h in first_of_each {
        let roles = [cells[h].tail, cells.head(h)].map(|v| cells.roles[v as usize]);
        if cells.path(h).is_none() && joins_one_path(graph, roles) {
            cells.split_edge(h, Role::Free);
        }
    }
}

pub(super) fn triangulate(cells: &mut Subdivision, graph: &TargetGraph, mesh: &DiskMesh) -> Parts {
    let mut of_cell: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
    // First halfedge of every cell within the frame.
    let is_first = |h: &u32| cells[*h].face != NONE && cells.cell(*h).all(|other| other >= *h);
    let mut waiting: Vec<u32> = (0..).take(cells.halfedge_count()).filter(is_first).collect();
    while let Some(h) = waiting.pop() {
        let first = cells.cell(h).min().unwrap_or(h);
        if let Some(triangles) = cut(cells, graph, mesh, first) {
            of_cell.insert(first, triangles);
            continue;
        }
        let piece = cells.cell(first).find(|&side| cells.path(side).is_none());
        let piece = piece.expect("a cell of more than three sides has one without a path");
        cells.split_edge(piece, Role::Free);
        waiting.push(first);
        waiting.push(cells[piece].twin);
    }
    let mut parts = Parts::new();
    for (first, triangles) in of_cell {
        let face = FaceId::new(cells[first].face);
        parts.entry(face).or_default().extend(triangles);
    }
    let old = u32::try_from(cells.old_vertex_count()).expect("vertices fit");
    parts.retain(|_, triangles| triangles.len() > 1 || triangles[0].iter().any(|&v| v >= old));
    parts
}

/// Triangulation of a cell with the shortest diagonals, none of them collapsing. `None` if there is none.
fn cut(cells: &Subdivision, graph: &TargetGraph, mesh: &DiskMesh, first: u32) -> Option<Vec<[u32; 3]>> {
    let corners: Vec<u32> = cells.cell(first).map(|h| cells[h].tail).collect();
    if let &[a, b, c] = corners.as_slice() {
        return Some(vec![[a, b, c]]);
    }
    let sides = sides_of_corners(cells, mesh, FaceId::new(cells[first].face), &corners);
    let place = |i: usize| cells.places[corners[i] as usize];
    let length = |i: usize, j: usize| {
        if j == i + 1 || (i == 0 && j + 1 == corners.len()) {
            return 0.0;
        }
        let roles = [corners[i], corners[j]].map(|v| cells.roles[v as usize]);
        if joins_one_path(graph, roles) { f64::INFINITY } else { place(i).distance_squared(place(j)) }
    };
    let is_flat = |i: usize, j: usize, k: usize| sides[i] & sides[j] & sides[k] != 0;
    shortest_triangulation(corners.len(), length, is_flat)
        .map(|triangles| triangles.into_iter().map(|t| t.map(|i| corners[i])).collect())
}

/// Sides of the face that each corner of a cell lies on, as bits.
fn sides_of_corners(cells: &Subdivision, mesh: &DiskMesh, face: FaceId, corners: &[u32]) -> Vec<u8> {
    let sides = [0, 1, 2].map(|k| HalfedgeId::from_index(3 * face.index() + k));
    let is_on = |v: u32, k: usize| match cells.edge_of_point(v) {
        Some(edge) => mesh.edge_of(sides[k]).number() == edge,
        None => mesh.tail(sides[k]).number() == v || mesh.head(sides[k]).number() == v,
    };
    corners.iter().map(|&v| (0..3).map(|k| u8::from(is_on(v, k)) << k).sum()).collect()
}

/// Triangulation of a convex polygon with the least finite sum of lengths and no bad triangle, by dynamic programming.
pub(super) fn shortest_triangulation(
    count: usize,
    length: impl Fn(usize, usize) -> f64,
    is_bad: impl Fn(usize, usize, usize) -> bool,
) -> Option<Vec<[usize; 3]>> {
    let at = |from: usize, to: usize| from * count + to;
    let mut cost = vec![0.0; count * count];
    let mut middle = vec![0; count * count];
    for span in 2..count {
        for from in 0..count - span {
            let to = from + span;
            let (mut best, mut best_middle) = (f64::INFINITY, from + 1);
            for k in from + 1..to {
                let sum = cost[at(from, k)] + cost[at(k, to)];
                if sum < best && !is_bad(from, k, to) {
                    (best, best_middle) = (sum, k);
                }
            }
            cost[at(from, to)] = best + length(from, to);
            middle[at(from, to)] = best_middle;
        }
    }
    if cost[at(0, count - 1)].is_infinite() {
        return None;
    }
    let (mut triangles, mut open) = (Vec::new(), vec![(0, count - 1)]);
    while let Some((from, to)) = open.pop() {
        if to > from + 1 {
            let k = middle[at(from, to)];
            triangles.push([from, k, to]);
            open.extend([(from, k), (k, to)]);
        }
    }
    Some(triangles)
}
