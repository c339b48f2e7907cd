//! Cutting of each part of a surface along edges until it is a disk.
//!
//! # Method
//!
//! A tree of shortest paths reaches all vertices. Its roots are all boundary vertices or, for a closed surface, one
//! vertex. A tree of faces, across edges that are not in the first tree, reaches all faces. Each edge in neither tree
//! closes a loop, or a path from boundary to boundary, with the shortest paths from its ends. There are 2g + b − 1
//! such edges for genus g and b boundary loops. Cutting the surface along all these paths leaves a disk: the tree of
//! faces, unfolded. The tree of faces takes edges with the longest loops first, so that the shortest loops remain to
//! be cut. A one-sided surface is cut by this method too; its faces are flipped afterwards if they clash.
//!
//! On a sphere no edge remains. A sphere is cut along a tree of shortest paths between far points.
//!
//! Source: J. Erickson, K. Whittlesey, "Greedy optimal homotopy and homology generators", 2005. The far points follow
//! A. Sheffer, "Spanning tree seams for reducing parameterization distortion of triangulated surfaces", 2002.

use super::charts::{Compact, compact, parts_of};
use super::sides::Sides;
use super::ways::{Measure, Reach, Ways};
use super::{Repair, Repaired};
use crate::mesh::union::DisjointSets;
use crate::mesh::{VertexId, parts};

/// Smallest distance from a sphere's cut at which a point is added, relative to the distance of the first two points.
const FAR: f64 = 0.5;

/// Largest number of points of a sphere's cut.
const MOST_POINTS: usize = 8;

/// Returns the mesh cut open, part by part. Parts that are disks, or become disks when their holes are filled, stay
/// unchanged.
pub(super) fn cut_open(whole: &Repaired) -> Repaired {
    let mut cut = whole.clone();
    if !whole.has_faces() {
        return cut;
    }
    let sides = Sides::new(&whole.polygons);
    let mut is_open = vec![false; whole.polygons.corners.len()];
    let count = parts_of(&whole.polygons, &sides)
        .into_iter()
        .map(|faces| compact(&whole.polygons, &faces))
        .filter(|part| !(whole.fills && is_filled(part)))
        .map(|part| open_part(&part, &mut is_open))
        .sum();
    if count == 0 {
        return cut;
    }
    let fans = sides.fans(|on| on.len() == 2 && !is_open[on[0] as usize]);
    cut.split_into(fans);
    cut.note(Repair::Cut, count);
    cut.turn_faces_that_were(&sides.one_sided());
    cut
}

/// True if a part is a disk once its holes are filled.
fn is_filled(part: &Compact) -> bool {
    parts(&part.polygons.triangulate()).is_ok_and(|found| found.len() == 1)
}

/// Opens the sides of the whole mesh along which a part is cut, and returns the number of cut edges. Returns 0 for a
/// part that has an edge with three or more faces.
fn open_part(part: &Compact, is_open: &mut [bool]) -> usize {
    let sides = Sides::new(&part.polygons);
    if sides.table.edges().any(|on| on.len() > 2) {
        return 0;
    }
    let seam = Surface { sides: &sides, ways: &Ways::new(&part.polygons, &sides) }.seam();
    for (on, _) in sides.table.edges().zip(&seam).filter(|(_, is_open)| **is_open) {
        for &side in on {
            is_open[part.corner_of[side as usize] as usize] = true;
        }
    }
    seam.iter().filter(|is_open| **is_open).count()
}

struct Surface<'a> {
    sides: &'a Sides<'a>,
    ways: &'a Ways,
}

impl Surface<'_> {
    /// True for each edge that is to be cut.
    fn seam(&self) -> Vec<bool> {
        let boundary = self.boundary_vertices();
        let tree = self.ways.reach(self.roots(&boundary), Measure::Cost);
        let left = self.left_over(&tree);
        let mut seam = vec![false; self.ways.edges().len()];
        for edge in left {
            seam[edge as usize] = true;
            for end in self.ways.edges()[edge as usize].ends {
                open(&mut seam, tree.way_to(end, self.ways));
            }
        }
        if !seam.contains(&true) && !boundary.contains(&true) {
            self.open_sphere(&mut seam);
        }
        self.prune(&mut seam, &boundary);
        seam
    }

    fn boundary_vertices(&self) -> Vec<bool> {
        let mut is_boundary = vec![false; self.ways.vertex_count()];
        for on in self.sides.table.edges().filter(|on| on.len() == 1) {
            self.sides.ends(on[0]).into_iter().for_each(|v| is_boundary[v.index()] = true);
        }
        is_boundary
    }

    /// Roots of the shortest paths: all boundary vertices or, on a closed surface, an end of the cheapest edge.
    fn roots(&self, boundary: &[bool]) -> impl Iterator<Item = VertexId> + use<> {
        let mut roots: Vec<VertexId> = (0..boundary.len()).filter(|&v| boundary[v]).map(VertexId::from_index).collect();
        if roots.is_empty() {
            let cheapest = self.ways.edges().iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
            roots.extend(cheapest.map(|edge| edge.ends[0]));
        }
        roots.into_iter()
    }

    /// Edges in neither the tree of paths nor the tree of faces.
    fn left_over(&self, tree: &Reach) -> Vec<u32> {
        let mut is_of_tree = vec![false; self.ways.edges().len()];
        tree.back.iter().flatten().for_each(|&edge| is_of_tree[edge as usize] = true);
        let loop_cost = |edge: u32| {
            let edge = self.ways.edges()[edge as usize];
            edge.cost + edge.ends.iter().map(|v| tree.far[v.index()]).sum::<f64>()
        };
        let inner = (0_u32..).zip(self.sides.table.edges()).filter(|(_, on)| on.len() == 2);
        let mut edges: Vec<(u32, [u32; 2])> = inner
            .filter(|(edge, _)| !is_of_tree[*edge as usize])
            .map(|(edge, on)| (edge, [0, 1].map(|k| self.sides.face[on[k] as usize])))
            .collect();
        edges.sort_by(|(a, _), (b, _)| loop_cost(*b).total_cmp(&loop_cost(*a)).then(a.cmp(b)));
        let mut faces = DisjointSets::new(self.sides.face.last().map_or(0, |&last| last as usize + 1));
        edges.into_iter().filter(|(_, [a, b])| !faces.join(*a, *b)).map(|(edge, _)| edge).collect()
    }

    /// Opens a tree of paths between far points of a sphere.
    fn open_sphere(&self, seam: &mut [bool]) {
        let start = self.ways.edges()[0].ends[0];
        let [by_length, by_cost] = self.reaches(&[start]);
        let first = by_length.farthest(&by_cost);
        let [by_length, by_cost] = self.reaches(&[first]);
        let second = by_length.farthest(&by_cost);
        let size = by_length.far[second.index()];
        open(seam, by_cost.way_to(second, self.ways));
        for _ in 2..MOST_POINTS {
            let [by_length, by_cost] = self.reaches(&self.vertices_of(seam));
            let next = by_length.farthest(&by_cost);
            // A cut of one edge would leave a boundary with two vertices.
            let is_cut = seam.iter().filter(|is_open| **is_open).count() > 1;
            if is_cut && by_length.far[next.index()] <= FAR * size {
                break;
            }
            open(seam, by_cost.way_to(next, self.ways));
        }
    }

    /// Distances of all vertices from the given vertices, by length and by cost.
    fn reaches(&self, from: &[VertexId]) -> [Reach; 2] {
        [Measure::Length, Measure::Cost].map(|by| self.ways.reach(from.iter().copied(), by))
    }

    fn vertices_of(&self, seam: &[bool]) -> Vec<VertexId> {
        let open = self.ways.edges().iter().zip(seam).filter(|(_, is_open)| **is_open);
        open.flat_map(|(edge, _)| edge.ends).collect()
    }

    /// Removes dangling ends of the cut that lie on no boundary, unless nothing else would remain.
    fn prune(&self, seam: &mut [bool], boundary: &[bool]) {
        let degree = |seam: &[bool], v: VertexId| self.ways.at(v).iter().filter(|&&edge| seam[edge as usize]).count();
        let has_core = boundary.contains(&true) || self.has_loop(seam);
        if !has_core {
            return;
        }
        let is_end = |seam: &[bool], v: VertexId| !boundary[v.index()] && degree(seam, v) == 1;
        let mut ends: Vec<VertexId> = self.vertices_of(seam).into_iter().filter(|&v| is_end(seam, v)).collect();
        while let Some(vertex) = ends.pop() {
            let Some(&edge) = self.ways.at(vertex).iter().find(|&&edge| seam[edge as usize]) else { continue };
            seam[edge as usize] = false;
            let other = self.ways.other_end(edge, vertex);
            if is_end(seam, other) {
                ends.push(other);
            }
        }
    }

    /// True if the cut contains a loop.
    fn has_loop(&self, seam: &[bool]) -> bool {
        let mut sets = DisjointSets::new(self.ways.vertex_count());
        let open = self.ways.edges().iter().zip(seam).filter(|(_, is_open)| **is_open);
        open.map(|(edge, _)| edge.ends).any(|[a, b]| !sets.join(a.number(), b.number()))
    }
}

/// Opens a path towards the root of a tree, up to the first open edge: from there on it is open already.
fn open(seam: &mut [bool], way: impl Iterator<Item = u32>) {
    for edge in way {
        if std::mem::replace(&mut seam[edge as usize], true) {
            return;
        }
    }
}
