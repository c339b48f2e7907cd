//! Congruence of surfaces: an isomorphism of their faces under which corresponding lengths agree.
//!
//! Polygons of a file stay whole, so their cuts into triangles do not matter. Lengths are measured along the edges of
//! all faces, and across each polygon from every corner to the next but one. An isomorphism of connected surfaces is
//! fixed by the images of one halfedge: faces are walked from there. Candidates are the edges of the outer boundary
//! loop whose whole loop agrees.

use glam::{DVec2, DVec3};

use super::{Polygon, VertexId};

/// Largest difference of two corresponding lengths, relative to the longer one.
const OF_LENGTH: f64 = 1e-4;

/// Further difference of two corresponding lengths, relative to the root of the surface's area.
const OF_SIZE: f64 = 2e-5;

/// Largest difference of total areas and of total boundary lengths, relative to the larger one.
const OF_TOTAL: f64 = 2e-4;

/// Most halfedges visited by all walks between two surfaces, relative to their number of halfedges.
const MOST_VISITED: usize = 100;

/// Marks a halfedge on the boundary, and vertices or halfedges that have no image yet.
const NONE: u32 = u32::MAX;

/// A connected surface of polygons, with its halfedges and its lengths. Its boundary has an outer loop.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredSurface {
    vertex_count: usize,
    /// First halfedge of each face, and the end of the last.
    starts: Vec<u32>,
    /// Face of each halfedge.
    face: Vec<u32>,
    /// Vertex at which each halfedge begins.
    tail: Vec<u32>,
    /// Other halfedge of the edge, or [`NONE`] on the boundary.
    twin: Vec<u32>,
    lengths: Vec<Lengths>,
    /// Number of faces at each vertex.
    degree: Vec<u32>,
    /// Halfedges along the outer boundary loop, in order.
    rim: Vec<u32>,
    boundary_length: f64,
    area: f64,
}

/// Lengths at a halfedge: of the edge, and across the polygon to the next corner but one. Each in space and in a map.
#[derive(Clone, Copy, Debug, Default)]
struct Lengths {
    edge: [f64; 2],
    across: [f64; 2],
}

/// Faces of a surface, to be measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceFaces<'a> {
    /// Triangles, those of each polygon in a row.
    pub(crate) triangles: &'a [[VertexId; 3]],
    /// Vertices of the outer boundary loop, in the direction of the faces.
    pub(crate) outer: &'a [VertexId],
    /// Area of the surface.
    pub(crate) area: f64,
}

/// Isomorphism between two congruent surfaces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Isomorphism {
    /// Vertex of the other surface for each vertex; `None` for vertices of no face.
    pub(crate) vertex_of: Vec<Option<VertexId>>,
    /// True if the isomorphism reverses orientation.
    pub(crate) mirrored: bool,
}

/// Numbers that are equal for all isomorphic surfaces.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SurfaceKey {
    faces: usize,
    vertices: usize,
    halfedges: usize,
    rim: usize,
    /// Numbers of faces by their numbers of corners, ascending.
    corners: Vec<[u32; 2]>,
    /// Numbers of vertices by their numbers of faces, ascending.
    degrees: Vec<[u32; 2]>,
}

impl MeasuredSurface {
    /// Measures a surface. `polygons` are its faces with more than three corners. `map` has a position in the plane for
    /// each vertex, whose lengths must agree, too. `None` if an edge has more than two faces, or the outer loop is not
    /// a boundary loop of the faces.
    pub(crate) fn new<'a>(
        positions: &[DVec3],
        faces: SurfaceFaces<'_>,
        polygons: impl Iterator<Item = Polygon<'a>>,
        map: Option<&[DVec2]>,
    ) -> Option<Self> {
        let mut surface = Self::of_faces(positions.len(), faces, polygons);
        surface.join_twins()?;
        surface.measure(positions, map);
        surface.rim = surface.rim_of(faces.outer)?;
        Some(surface)
    }

    fn of_faces<'a>(vertex_count: usize, faces: SurfaceFaces<'_>, polygons: impl Iterator<Item = Polygon<'a>>) -> Self {
        let (mut starts, mut tail, mut face) = (vec![0], Vec::new(), Vec::new());
        let mut push = |corners: &[VertexId]| {
            face.extend(std::iter::repeat_n(number(starts.len() - 1), corners.len()));
            tail.extend(corners.iter().map(|vertex| vertex.number()));
            starts.push(number(tail.len()));
        };
        let (mut polygons, mut at) = (polygons.peekable(), 0);
        while at < faces.triangles.len() {
            if let Some(polygon) = polygons.next_if(|polygon| polygon.first_face.index() == at) {
                push(polygon.corners);
                at += polygon.corners.len() - 2;
            } else {
                push(&faces.triangles[at]);
                at += 1;
            }
        }
        let mut degree = vec![0; vertex_count];
        for &vertex in &tail {
            degree[vertex as usize] += 1;
        }
        let (twin, lengths) = (vec![NONE; tail.len()], Vec::new());
        let (rim, boundary_length, area) = (Vec::new(), 0.0, faces.area);
        Self { vertex_count, starts, face, tail, twin, lengths, degree, rim, boundary_length, area }
    }

    /// Joins the two halfedges of each edge. `None` if an edge has more than two, or two in one direction.
    fn join_twins(&mut self) -> Option<()> {
        let count = number(self.tail.len());
        let ends = |h: u32| [self.tail[h as usize], self.tail[self.next(h) as usize]];
        let mut sides: Vec<([u32; 2], u32)> = (0..count)
            .map(|h| {
                let mut ends = ends(h);
                ends.sort_unstable();
                (ends, h)
            })
            .collect();
        sides.sort_unstable();
        let mut twin = vec![NONE; self.tail.len()];
        for edge in sides.chunk_by(|a, b| a.0 == b.0) {
            match *edge {
                [_] => {}
                [(_, a), (_, b)] if ends(a)[0] == ends(b)[1] => {
                    twin[a as usize] = b;
                    twin[b as usize] = a;
                }
                _ => return None,
            }
        }
        self.twin = twin;
        Some(())
    }

    fn measure(&mut self, positions: &[DVec3], map: Option<&[DVec2]>) {
        let distance = |a: u32, b: u32| {
            let [a, b] = [a, b].map(|h| self.tail[h as usize] as usize);
            [positions[a].distance(positions[b]), map.map_or(0.0, |map| map[a].distance(map[b]))]
        };
        let lengths = |h: u32| {
            let next = self.next(h);
            let is_polygon = self.corner_count(self.face[h as usize]) > 3;
            let across = if is_polygon { distance(h, self.next(next)) } else { [0.0; 2] };
            Lengths { edge: distance(h, next), across }
        };
        self.lengths = (0..number(self.tail.len())).map(lengths).collect();
        let on_boundary = self.lengths.iter().zip(&self.twin).filter(|(_, twin)| **twin == NONE);
        self.boundary_length = on_boundary.map(|(lengths, _)| lengths.edge[0]).sum();
    }

    /// Halfedges along a loop of vertices. `None` if they are not boundary halfedges of the faces.
    fn rim_of(&self, outer: &[VertexId]) -> Option<Vec<u32>> {
        let mut from = vec![NONE; self.vertex_count];
        for h in (0..number(self.tail.len())).filter(|&h| self.twin[h as usize] == NONE) {
            from[self.tail[h as usize] as usize] = h;
        }
        let rim: Vec<u32> = outer.iter().map(|vertex| from[vertex.index()]).collect();
        let ends = outer.iter().cycle().skip(1);
        let runs_on = |(&h, end): (&u32, &VertexId)| h != NONE && self.tail[self.next(h) as usize] == end.number();
        (!rim.is_empty() && rim.iter().zip(ends).all(runs_on)).then_some(rim)
    }

    fn corner_count(&self, face: u32) -> u32 {
        self.starts[face as usize + 1] - self.starts[face as usize]
    }

    fn next(&self, h: u32) -> u32 {
        let face = self.face[h as usize] as usize;
        if h + 1 == self.starts[face + 1] { self.starts[face] } else { h + 1 }
    }

    fn previous(&self, h: u32) -> u32 {
        let face = self.face[h as usize] as usize;
        if h == self.starts[face] { self.starts[face + 1] - 1 } else { h - 1 }
    }

    /// Numbers that isomorphic surfaces have in common.
    pub(crate) fn key(&self) -> SurfaceKey {
        let faces = self.starts.len() - 1;
        SurfaceKey {
            faces,
            vertices: self.degree.iter().filter(|&&degree| degree > 0).count(),
            halfedges: self.tail.len(),
            rim: self.rim.len(),
            corners: counts((0..number(faces)).map(|face| self.corner_count(face))),
            degrees: counts(self.degree.iter().copied()),
        }
    }

    /// Range of the areas of congruent surfaces.
    pub(crate) fn areas(&self) -> [f64; 2] {
        [self.area * (1.0 - OF_TOTAL), self.area / (1.0 - OF_TOTAL)]
    }

    /// Area of the surface.
    pub(crate) fn area(&self) -> f64 {
        self.area
    }

    /// Isomorphism to a congruent surface. An isomorphism that keeps orientation comes first; with `may_mirror` one that
    /// reverses it is the second choice. Among several the first along the other surface's outer loop is returned.
    pub(crate) fn congruence(&self, other: &Self, may_mirror: bool) -> Option<Isomorphism> {
        let are_alike = |a: f64, b: f64| (a - b).abs() <= OF_TOTAL * a.max(b);
        if !are_alike(self.area, other.area) || !are_alike(self.boundary_length, other.boundary_length) {
            return None;
        }
        let budget = MOST_VISITED.saturating_mul(self.tail.len());
        [false, true].into_iter().filter(|&mirrored| may_mirror || !mirrored).find_map(|mirrored| {
            let mut walk =
                Walk { from: self, to: other, mirrored, image: Vec::new(), vertex_of: Vec::new(), left: budget };
            (0..other.rim.len()).find_map(|shift| walk.along_rim(shift))
        })
    }
}

/// Walk over two surfaces at once.
struct Walk<'a> {
    from: &'a MeasuredSurface,
    to: &'a MeasuredSurface,
    mirrored: bool,
    /// Image of each halfedge.
    image: Vec<u32>,
    /// Image of each vertex.
    vertex_of: Vec<u32>,
    /// Number of halfedges that may still be visited.
    left: usize,
}

impl Walk<'_> {
    /// Isomorphism that takes the first halfedge of the outer loop to halfedge `shift` of the other's.
    fn along_rim(&mut self, shift: usize) -> Option<Isomorphism> {
        let count = self.from.rim.len();
        if count != self.to.rim.len() || !(0..count).all(|k| self.agrees(self.from.rim[k], self.on_rim(shift, k))) {
            return None;
        }
        self.image = vec![NONE; self.from.tail.len()];
        self.vertex_of = vec![NONE; self.from.vertex_count];
        let mut open = vec![[self.from.rim[0], self.on_rim(shift, 0)]];
        while let Some([h, g]) = open.pop() {
            match self.image[h as usize] {
                NONE => self.walk_face([h, g], &mut open)?,
                image if image == g => {}
                _ => return None,
            }
        }
        self.isomorphism()
    }

    /// Halfedge of the other rim that belongs to halfedge `k` of the own one.
    fn on_rim(&self, shift: usize, k: usize) -> u32 {
        let count = self.to.rim.len();
        self.to.rim[if self.mirrored { (shift + count - k) % count } else { (shift + k) % count }]
    }

    /// Maps a face with all its corners, and leaves its neighbours to be visited.
    fn walk_face(&mut self, [start, image]: [u32; 2], open: &mut Vec<[u32; 2]>) -> Option<()> {
        let (mut h, mut g) = (start, image);
        let corners = self.from.corner_count(self.from.face[h as usize]);
        self.left = self.left.checked_sub(corners as usize)?;
        if corners != self.to.corner_count(self.to.face[g as usize]) {
            return None;
        }
        for _ in 0..corners {
            let vertex = self.to.tail[self.tail_of_image(g) as usize];
            let known = &mut self.vertex_of[self.from.tail[h as usize] as usize];
            if *known != NONE && *known != vertex {
                return None;
            }
            *known = vertex;
            self.image[h as usize] = g;
            if !self.agrees(h, g) {
                return None;
            }
            match [self.from.twin[h as usize], self.to.twin[g as usize]] {
                [NONE, NONE] => {}
                [NONE, _] | [_, NONE] => return None,
                twins => open.push(twins),
            }
            h = self.from.next(h);
            g = if self.mirrored { self.to.previous(g) } else { self.to.next(g) };
        }
        Some(())
    }

    /// Halfedge that begins at the image of the tail of the halfedge with image `g`.
    fn tail_of_image(&self, g: u32) -> u32 {
        if self.mirrored { self.to.next(g) } else { g }
    }

    /// True if the lengths at two halfedges and the degrees of their tails agree.
    fn agrees(&self, h: u32, g: u32) -> bool {
        let across = if self.mirrored { self.to.previous(g) } else { g };
        let (own, other) = (self.from.lengths[h as usize], self.to.lengths[g as usize]);
        let size = self.from.area.sqrt();
        let are_alike = |(a, b): (f64, f64)| (a - b).abs() <= OF_LENGTH * a.max(b) + OF_SIZE * size;
        let edges = own.edge.into_iter().zip(other.edge);
        let diagonals = own.across.into_iter().zip(self.to.lengths[across as usize].across);
        let tails = [self.from.tail[h as usize], self.to.tail[self.tail_of_image(g) as usize]];
        self.from.degree[tails[0] as usize] == self.to.degree[tails[1] as usize]
            && edges.chain(diagonals).all(are_alike)
    }

    /// The isomorphism, if every halfedge has an image and no two vertices share one.
    fn isomorphism(&self) -> Option<Isomorphism> {
        let mut is_taken = vec![false; self.to.vertex_count];
        let mut takes = |vertex: u32| !std::mem::replace(&mut is_taken[vertex as usize], true);
        let are_distinct = self.vertex_of.iter().filter(|&&vertex| vertex != NONE).all(|&vertex| takes(vertex));
        let is_whole = self.image.iter().all(|&image| image != NONE) && are_distinct;
        let vertex = |&vertex: &u32| (vertex != NONE).then(|| VertexId::new(vertex));
        let vertex_of = || self.vertex_of.iter().map(vertex).collect();
        is_whole.then(|| Isomorphism { vertex_of: vertex_of(), mirrored: self.mirrored })
    }
}

/// Distinct values with their numbers of occurrences, ascending.
fn counts(values: impl Iterator<Item = u32>) -> Vec<[u32; 2]> {
    let mut values: Vec<u32> = values.collect();
    values.sort_unstable();
    values.chunk_by(|a, b| a == b).map(|run| [run[0], number(run.len())]).collect()
}

fn number(count: usize) -> u32 {
    u32::try_from(count).expect("a mesh has fewer than 2^32 corners")
}
