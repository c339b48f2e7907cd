//! Faces of a mesh, cut into cells by paths.
//!
//! A path runs along edges of the mesh, its *old* edges, or crosses them at new points and the faces between them in
//! straight *chords*. A new point has one chord on either side of its edge, so no cell has more than one piece of an
//! old edge. Each cell is a convex polygon of at most six corners, and every triangulation of it has positive
//! triangles.
//!
//! Halfedges are those of [`DiskMesh`]; the outer face is a cell as well.

use std::ops::{Index, IndexMut};

use glam::DVec2;

use crate::mesh::{DiskMesh, FaceId, VertexId};

/// Marks the absence of a path, an old edge or a face.
pub(super) const NONE: u32 = u32::MAX;

/// Role of a vertex for the paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// On no path.
    Free,
    /// End of paths: a vertex of the target graph.
    End(u32),
    /// Interior of a path: an edge of the target graph.
    Within(u32),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Halfedge {
    pub(super) next: u32,
    pub(super) previous: u32,
    pub(super) twin: u32,
    pub(super) tail: u32,
    /// Old edge that contains the halfedge; [`NONE`] for a chord.
    old_edge: u32,
    /// Old face in which, or at which, the halfedge lies; [`NONE`] outside.
    pub(super) face: u32,
    /// Path along the halfedge, or [`NONE`].
    pub(super) path: u32,
}

#[derive(Debug)]
pub(super) struct Subdivision {
    halfedges: Vec<Halfedge>,
    /// Halfedge that leaves each vertex.
    outgoing: Vec<u32>,
    /// Role of each vertex.
    pub(super) roles: Vec<Role>,
    /// Position of each vertex in the plane. Points on an edge are spread evenly.
    pub(super) places: Vec<DVec2>,
    /// Old edge of each vertex beyond the old ones.
    edge_of_point: Vec<u32>,
    /// Ends of the old edges.
    ends: Vec<[u32; 2]>,
    /// New points on each old edge, from its first end.
    pub(super) points: Vec<Vec<u32>>,
}

impl Index<u32> for Subdivision {
    type Output = Halfedge;

    fn index(&self, h: u32) -> &Halfedge {
        &self.halfedges[h as usize]
    }
}

impl IndexMut<u32> for Subdivision {
    fn index_mut(&mut self, h: u32) -> &mut Halfedge {
        &mut self.halfedges[h as usize]
    }
}

impl Subdivision {
    /// Faces of a mesh in the plane, without paths.
    pub(super) fn new(mesh: &DiskMesh, places: &[DVec2]) -> Self {
        let mut outgoing = vec![NONE; mesh.vertex_count()];
        for h in mesh.halfedges() {
            outgoing[mesh.tail(h).index()] = h.number();
        }
        let halfedge = |h| Halfedge {
            next: mesh.next(h).number(),
            previous: mesh.previous(h).number(),
            twin: mesh.twin(h).number(),
            tail: mesh.tail(h).number(),
            old_edge: mesh.edge_of(h).number(),
            face: mesh.face_of(h).map_or(NONE, FaceId::number),
            path: NONE,
        };
        Self {
            halfedges: mesh.halfedges().map(halfedge).collect(),
            outgoing,
            roles: vec![Role::Free; mesh.vertex_count()],
            places: places.to_vec(),
            edge_of_point: Vec::new(),
            ends: mesh.edges().map(|e| mesh.ends(e).map(VertexId::number)).collect(),
            points: vec![Vec::new(); mesh.edge_count()],
        }
    }

    pub(super) fn halfedge_count(&self) -> usize {
        self.halfedges.len()
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.places.len()
    }

    pub(super) fn old_vertex_count(&self) -> usize {
        self.vertex_count() - self.edge_of_point.len()
    }

    /// Number of points that the paths added to old edges.
    pub(super) fn point_count(&self) -> usize {
        self.edge_of_point.len()
    }

    pub(super) fn head(&self, h: u32) -> u32 {
        self[self[h].twin].tail
    }

    pub(super) fn path(&self, h: u32) -> Option<u32> {
        let path = self[h].path;
        (path != NONE).then_some(path)
    }

    /// Old edge of a new point; `None` for an old vertex.
    pub(super) fn edge_of_point(&self, vertex: u32) -> Option<u32> {
        (vertex as usize).checked_sub(self.old_vertex_count()).map(|point| self.edge_of_point[point])
    }

    /// Number of new points on the old edge that contains a halfedge.
    pub(super) fn crowd(&self, h: u32) -> usize {
        match self[h].old_edge {
            NONE => 0,
            edge => self.points[edge as usize].len(),
        }
    }

    /// Next halfedge around the tail, counter-clockwise.
    pub(super) fn rotated(&self, h: u32) -> u32 {
        self[self[h].previous].twin
    }

    /// All halfedges that leave a vertex, counter-clockwise.
    pub(super) fn around(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.outgoing[vertex as usize];
        let mut at = Some(first);
        std::iter::from_fn(move || {
            let here = at?;
            at = Some(self.rotated(here)).filter(|&h| h != first);
            Some(here)
        })
    }

    /// Halfedges of a cell, starting with one of them.
    pub(super) fn cell(&self, h: u32) -> impl Iterator<Item = u32> + '_ {
        let mut at = Some(h);
        std::iter::from_fn(move || {
            let here = at?;
            at = Some(self[here].next).filter(|&next| next != h);
            Some(here)
        })
    }

    fn add_halfedge(&mut self, tail: u32, like: u32, old_edge: u32) -> u32 {
        let h = number(self.halfedge_count());
        let like = self[like];
        self.halfedges.push(Halfedge { next: NONE, previous: NONE, twin: NONE, tail, old_edge, ..like });
        h
    }

    fn join(&mut self, first: u32, second: u32) {
        self[first].next = second;
        self[second].previous = first;
    }

    fn pair(&mut self, one: u32, other: u32) {
        self[one].twin = other;
        self[other].twin = one;
    }

    /// Splits a piece of an old edge by a new point. The halfedge keeps its tail, and so does its twin.
    pub(super) fn split_edge(&mut self, h: u32, role: Role) -> u32 {
        let (twin, old_edge) = (self[h].twin, self[h].old_edge);
        let point = self.add_point(h, old_edge, role);
        let (ahead, back) = (self.add_halfedge(point, h, old_edge), self.add_halfedge(point, twin, old_edge));
        for (piece, rest) in [(h, ahead), (twin, back)] {
            let next = self[piece].next;
            self.join(rest, next);
            self.join(piece, rest);
        }
        self.pair(h, back);
        self.pair(twin, ahead);
        self.outgoing.push(ahead);
        point
    }

    /// Adds a point between the ends of a piece, and spreads all points of its old edge evenly.
    fn add_point(&mut self, h: u32, old_edge: u32, role: Role) -> u32 {
        let point = number(self.vertex_count());
        let [low, high] = self.ends[old_edge as usize];
        let ends = [self[h].tail, self.head(h)];
        let points = &mut self.points[old_edge as usize];
        // The point before the new one is an end of the piece, or the piece starts at the first end.
        let before = points.iter().position(|p| ends.contains(p));
        let at = match before {
            _ if ends.contains(&low) => 0,
            Some(place) => place + 1,
            None => points.len(),
        };
        points.insert(at, point);
        self.places.push(DVec2::ZERO);
        let parts = (points.len() + 1) as f64;
        for (place, &p) in points.iter().enumerate() {
            let share = (place + 1) as f64 / parts;
            self.places[p as usize] = self.places[low as usize].lerp(self.places[high as usize], share);
        }
        self.roles.push(role);
        self.edge_of_point.push(old_edge);
        point
    }

    /// Cuts a cell by a chord between the tails of two of its halfedges. Returns the chord from the first to the
    /// second.
    pub(super) fn split_cell(&mut self, from: u32, to: u32) -> u32 {
        let (chord, back) =
            (self.add_halfedge(self[from].tail, from, NONE), self.add_halfedge(self[to].tail, from, NONE));
        self[chord].path = NONE;
        self[back].path = NONE;
        let (before_from, before_to) = (self[from].previous, self[to].previous);
        self.join(before_from, chord);
        self.join(chord, to);
        self.join(before_to, back);
        self.join(back, from);
        self.pair(chord, back);
        chord
    }
}

fn number(index: usize) -> u32 {
    u32::try_from(index).expect("a subdivision has fewer than 2^32 elements")
}
