//! Surface to be cut: one connected part, its edges with lengths and costs, and its boundary loops.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::mesh::union::DisjointSets;
use crate::mesh::{Chart, DiskMesh, FaceId, Repaired, Seams, VertexId};
use crate::problem::SolveError;

/// Length of a boundary loop, relative to √area, below which a cut need not reach the loop: it is filled as a hole.
const SMALL_LOOP: f64 = 0.3;

/// Edge of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    pub(super) length: f64,
    /// Length times the factor of a seam here; 0 on the boundary.
    pub(super) cost: f64,
    pub(super) is_boundary: bool,
}

/// Cost of a seam for each edge of a part, in the order of its edge table.
#[derive(Clone, Debug)]
pub(crate) struct EdgeCosts {
    /// Cost relative to the length.
    relative: Vec<f64>,
    /// True for each edge that seams avoid.
    is_avoided: Vec<bool>,
}

impl EdgeCosts {
    /// Costs that were stated, for each edge.
    pub(crate) fn new(stated: Vec<f64>) -> Self {
        let is_avoided = stated.iter().map(|&cost| cost >= Seams::AVOIDED).collect();
        Self { relative: stated, is_avoided }
    }

    /// Multiplies the costs by factors of the surface's shape, one for each edge.
    pub(crate) fn multiply(&mut self, shape: &[f64]) {
        self.relative.iter_mut().zip(shape).for_each(|(cost, factor)| *cost *= factor);
    }
}

/// Part of a mesh: connected, oriented, each edge with at most two faces.
#[derive(Debug)]
pub(crate) struct CutSurface<'a> {
    part: &'a Repaired,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Edges of the polygons, in the order of their edge table. Diagonals of polygons are no edges.
    pub(super) edges: Vec<Edge>,
    /// Edges at each vertex, vertex by vertex.
    at: Vec<u32>,
    /// Start of each vertex's edges in `at`, and the end of the last.
    starts: Vec<u32>,
    /// Boundary loop of each vertex, if it lies on one.
    pub(super) loop_of: Vec<Option<u32>>,
    /// True for each boundary loop that a cut has to reach.
    pub(super) is_required: Vec<bool>,
    /// True for each vertex inside a region that seams avoid: each of its edges costs [`Seams::AVOIDED`] or more.
    pub(super) is_avoided: Vec<bool>,
    pub(super) area: f64,
}

impl<'a> CutSurface<'a> {
    /// Takes a repaired mesh of one part.
    pub(crate) fn new(part: &'a Repaired, costs: &EdgeCosts) -> Self {
        let polygons = part.polygons();
        let mesh = polygons.triangulate();
        let triangles = mesh.triangles.iter().map(|face| face.map(VertexId::number)).collect();
        let position = |v: u32| polygons.positions[v as usize];
        let edges: Vec<Edge> = part
            .edges_with_sides()
            .into_iter()
            .zip(&costs.relative)
            .map(|((ends, side_count), factor)| {
                let ends = ends.map(VertexId::number);
                let length = position(ends[0]).distance(position(ends[1]));
                let is_boundary = side_count == 1;
                // A boundary is open already.
                let cost = if is_boundary { 0.0 } else { length * factor };
                Edge { ends, length, cost, is_boundary }
            })
            .collect();
        let (at, starts) = by_vertex(&edges, polygons.positions.len());
        let area = mesh.area();
        let mut surface = Self {
            part,
            triangles,
            edges,
            at,
            starts,
            loop_of: Vec::new(),
            is_required: Vec::new(),
            is_avoided: Vec::new(),
            area,
        };
        let is_avoided = |v: u32| {
            let edges = surface.at(v);
            !edges.is_empty() && edges.iter().all(|&edge| costs.is_avoided[edge as usize])
        };
        surface.is_avoided = (0..).take(surface.vertex_count()).map(is_avoided).collect();
        surface.find_loops();
        surface
    }

    fn find_loops(&mut self) {
        let mut sets = DisjointSets::new(self.vertex_count());
        let boundary = || self.edges.iter().filter(|edge| edge.is_boundary);
        for edge in boundary() {
            sets.join(edge.ends[0], edge.ends[1]);
        }
        let mut loop_of = vec![None; self.vertex_count()];
        let (mut of_root, mut lengths) = (vec![None; self.vertex_count()], Vec::new());
        for edge in boundary() {
            let root = sets.find(edge.ends[0]) as usize;
            let number = *of_root[root].get_or_insert_with(|| {
                lengths.push(0.0);
                u32::try_from(lengths.len() - 1).expect("loops fit")
            });
            lengths[number as usize] += edge.length;
            edge.ends.iter().for_each(|&v| loop_of[v as usize] = Some(number));
        }
        let is_long = |length: &f64| !self.part.fills_holes() || *length >= SMALL_LOOP * self.area.sqrt();
        self.is_required = lengths.iter().map(is_long).collect();
        self.loop_of = loop_of;
    }

    /// True if a vertex lies on a boundary loop that a cut has to reach.
    pub(super) fn is_on_required_loop(&self, vertex: u32) -> bool {
        self.loop_of[vertex as usize].is_some_and(|of| self.is_required[of as usize])
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn position(&self, vertex: u32) -> glam::DVec3 {
        self.part.polygons().positions[vertex as usize]
    }

    /// Edges at a vertex.
    pub(super) fn at(&self, vertex: u32) -> &[u32] {
        &self.at[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }

    /// End of an edge other than `vertex`.
    pub(super) fn other_end(&self, edge: u32, vertex: u32) -> u32 {
        let [a, b] = self.edges[edge as usize].ends;
        if a == vertex { b } else { a }
    }

    /// Edges between two faces, with the faces. Faces have the numbers of the polygons; a hole that is filled counts
    /// as a face, numbered after the others.
    pub(super) fn faces_beside(&self) -> Vec<(u32, [u32; 2])> {
        let face_count = u32::try_from(self.part.polygons().face_count()).expect("faces fit");
        let beside = |(number, faces): (u32, Vec<u32>)| match faces[..] {
            [a, b] => Some((number, [a, b])),
            [a] => {
                let of = self.loop_of[self.edges[number as usize].ends[0] as usize]?;
                (!self.is_required[of as usize]).then_some((number, [a, face_count + of]))
            }
            _ => None,
        };
        (0..).zip(self.part.faces_of_edges()).filter_map(beside).collect()
    }

    /// Length of the edges that are seams.
    pub(super) fn length_of(&self, is_seam: &[bool]) -> f64 {
        self.seams(is_seam).map(|edge| edge.length).sum()
    }

    /// Cost of the edges that are seams.
    pub(super) fn cost_of(&self, is_seam: &[bool]) -> f64 {
        self.seams(is_seam).map(|edge| edge.cost).sum()
    }

    fn seams<'b>(&'b self, is_seam: &'b [bool]) -> impl Iterator<Item = &'b Edge> {
        self.edges.iter().zip(is_seam).filter(|(_, is_seam)| **is_seam).map(|(edge, _)| edge)
    }

    /// True for each edge whose faces have normals that differ by `degrees` or more.
    pub(super) fn sharp_edges(&self, degrees: f64) -> Vec<bool> {
        let polygons = self.part.polygons();
        let normal = |face: u32| polygons.face_normal(face as usize);
        let most = degrees.to_radians().cos();
        let is_sharp = |faces: &Vec<u32>| matches!(faces[..], [a, b] if normal(a).dot(normal(b)) <= most);
        self.part.faces_of_edges().iter().map(is_sharp).collect()
    }

    /// True for each vertex of a sharp edge.
    pub(super) fn on_sharp_edges(&self, degrees: f64) -> Vec<bool> {
        let mut is_on = vec![false; self.vertex_count()];
        let sharp = self.edges.iter().zip(self.sharp_edges(degrees)).filter(|(_, is_sharp)| *is_sharp);
        sharp.flat_map(|(edge, _)| edge.ends).for_each(|end| is_on[end as usize] = true);
        is_on
    }

    /// Genus: the number of handles.
    pub(super) fn genus(&self) -> usize {
        let used = (0..self.vertex_count()).filter(|&v| self.starts[v] < self.starts[v + 1]).count();
        let faces = self.part.polygons().face_count();
        (2 + self.edges.len()).saturating_sub(self.is_required.len() + used + faces) / 2
    }

    /// True if the surface is a disk once its small holes are filled.
    pub(super) fn is_disk(&self) -> bool {
        self.genus() == 0 && self.is_required.iter().filter(|is_required| **is_required).count() == 1
    }

    /// The surface opened along seams, with small holes filled.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotPlanar`] if a chart is no disk.
    pub(super) fn opened(&self, is_seam: &[bool]) -> Result<Opened, SolveError> {
        let opened = self.part.opened_along(is_seam);
        let corners = opened.polygons().corners.clone();
        let charts = opened.separate_charts().into_iter().map(|(chart, faces)| OpenedChart::new(chart, &faces));
        let vertex_count = opened.polygons().positions.len();
        Ok(Opened { charts: charts.collect::<Result<_, _>>()?, corners, vertex_count })
    }

    /// Part of the mesh that is cut.
    pub(super) fn part(&self) -> &Repaired {
        self.part
    }

    /// Cheapest paths from the given vertices to all others. Whenever a goal is reached, `take` gets the path to it,
    /// listed backwards; the path's vertices become starts. The search ends if `take` returns false.
    pub(super) fn paths_through(
        &self,
        from: &[u32],
        is_goal: impl Fn(u32) -> bool,
        mut take: impl FnMut(u32, Vec<u32>) -> bool,
    ) -> Paths {
        let mut far = vec![f64::INFINITY; self.vertex_count()];
        let mut back = vec![u32::MAX; self.vertex_count()];
        let mut is_start = vec![false; self.vertex_count()];
        let mut queue = Queue::new();
        for &vertex in from {
            is_start[vertex as usize] = true;
            far[vertex as usize] = 0.0;
            queue.push(Reverse((0, vertex)));
        }
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            if bits != far[vertex as usize].to_bits() {
                continue;
            }
            if !is_start[vertex as usize] && is_goal(vertex) {
                let path = path_back(&back, self, vertex);
                for &end in path.iter().flat_map(|&edge| &self.edges[edge as usize].ends) {
                    is_start[end as usize] = true;
                    if far[end as usize] > 0.0 {
                        (far[end as usize], back[end as usize]) = (0.0, u32::MAX);
                        queue.push(Reverse((0, end)));
                    }
                }
                if !take(vertex, path) {
                    break;
                }
                // It is in the queue again as a start, unless it was at distance 0.
                if bits > 0 {
                    continue;
                }
            }
            for &edge in self.at(vertex) {
                let (to, there) = (self.other_end(edge, vertex), f64::from_bits(bits) + self.edges[edge as usize].cost);
                if there < far[to as usize] {
                    (far[to as usize], back[to as usize]) = (there, edge);
                    queue.push(Reverse((there.to_bits(), to)));
                }
            }
        }
        Paths { far, back }
    }

    /// Cheapest paths from the given vertices to all others.
    pub(super) fn paths(&self, from: &[u32]) -> Paths {
        self.paths_through(from, |_| false, |_, _| true)
    }

    /// Edges of the cheapest path from some vertices to the nearest goal.
    pub(super) fn path(&self, from: &[u32], is_goal: impl Fn(u32) -> bool) -> Option<Vec<u32>> {
        let mut found = None;
        self.paths_through(from, is_goal, |_, path| {
            found = Some(path);
            false
        });
        found
    }
}

/// Part opened along seams.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) charts: Vec<OpenedChart>,
    /// Vertex at each corner of the part.
    pub(super) corners: Vec<VertexId>,
    /// Number of vertices.
    pub(super) vertex_count: usize,
}

/// Chart of an opened part.
#[derive(Debug)]
pub(super) struct OpenedChart {
    /// Triangles of the chart, and those that fill its holes.
    pub(super) disk: DiskMesh,
    /// Disk with its polygons.
    pub(super) polygons: DiskMesh,
    /// Vertex of the opened part for each vertex of the chart. Vertices in holes have none and come last.
    pub(super) vertex_of: Vec<VertexId>,
    /// Face of the part for each triangle. Triangles in holes have none and come last.
    pub(super) face_of: Vec<u32>,
}

impl OpenedChart {
    /// Takes a chart, and its faces by their numbers in the part.
    fn new(Chart { repaired, vertex_of }: Chart, faces: &[u32]) -> Result<Self, SolveError> {
        let triangles = repaired.polygons().triangulate();
        let face_of = (0..triangles.face_count())
            .map(|triangle| faces[triangles.polygon(FaceId::from_index(triangle)) as usize])
            .collect();
        let polygons = DiskMesh::try_from(repaired.triangulate()).map_err(|_| SolveError::NotPlanar)?;
        Ok(Self { disk: polygons.without_polygons(), polygons, vertex_of, face_of })
    }
}

/// Working memory of searches that stay near their start.
#[derive(Debug)]
pub(super) struct Nearby {
    far: Vec<f64>,
    back: Vec<u32>,
    reached: Vec<u32>,
}

impl Nearby {
    pub(super) fn new(surface: &CutSurface<'_>) -> Self {
        let count = surface.vertex_count();
        Self { far: vec![f64::INFINITY; count], back: vec![u32::MAX; count], reached: Vec::new() }
    }

    /// Edges of the cheapest path from some vertices to the nearest goal, if it costs at most `most`; listed
    /// backwards from the goal.
    pub(super) fn path(
        &mut self,
        surface: &CutSurface<'_>,
        from: &[u32],
        most: f64,
        is_goal: impl Fn(u32) -> bool,
    ) -> Option<Vec<u32>> {
        let mut queue = BinaryHeap::new();
        for &vertex in from {
            self.reach(vertex, 0.0, u32::MAX, &mut queue);
        }
        let mut path = None;
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            let here = f64::from_bits(bits);
            if bits != self.far[vertex as usize].to_bits() {
                continue;
            }
            if is_goal(vertex) {
                path = Some(path_back(&self.back, surface, vertex));
                break;
            }
            for &edge in surface.at(vertex) {
                let (to, there) = (surface.other_end(edge, vertex), here + surface.edges[edge as usize].cost);
                if there < self.far[to as usize] && there <= most {
                    self.reach(to, there, edge, &mut queue);
                }
            }
        }
        for vertex in self.reached.drain(..) {
            (self.far[vertex as usize], self.back[vertex as usize]) = (f64::INFINITY, u32::MAX);
        }
        path
    }

    fn reach(&mut self, vertex: u32, far: f64, back: u32, queue: &mut Queue) {
        if self.far[vertex as usize].is_infinite() {
            self.reached.push(vertex);
        }
        (self.far[vertex as usize], self.back[vertex as usize]) = (far, back);
        queue.push(Reverse((far.to_bits(), vertex)));
    }
}

/// Vertices by distance, the nearest first. Non-negative floats sort like their bit patterns.
type Queue = BinaryHeap<Reverse<(u64, u32)>>;

/// Edges of a path, listed backwards from its last vertex. `back` holds the last edge of the path to each vertex.
fn path_back(back: &[u32], surface: &CutSurface<'_>, vertex: u32) -> Vec<u32> {
    let (mut at, mut path) = (vertex, Vec::new());
    while back[at as usize] != u32::MAX {
        path.push(back[at as usize]);
        at = surface.other_end(back[at as usize], at);
    }
    path
}

/// Cheapest paths from a set of vertices.
#[derive(Debug)]
pub(super) struct Paths {
    /// Cost of the path to each vertex.
    pub(super) far: Vec<f64>,
    /// Last edge of the path to each vertex, or `u32::MAX`.
    back: Vec<u32>,
}

impl Paths {
    /// Last edge of the path to a vertex.
    pub(super) fn last_edge(&self, vertex: u32) -> Option<u32> {
        Some(self.back[vertex as usize]).filter(|&edge| edge != u32::MAX)
    }

    /// Edges of the path to a vertex, listed backwards from it.
    pub(super) fn to(&self, surface: &CutSurface<'_>, vertex: u32) -> Vec<u32> {
        path_back(&self.back, surface, vertex)
    }
}

/// Edges at each vertex, and the start of each vertex's edges.
fn by_vertex(edges: &[Edge], vertex_count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; vertex_count + 1];
    for &end in edges.iter().flat_map(|edge| &edge.ends) {
        starts[end as usize + 1] += 1;
    }
    for v in 1..starts.len() {
        starts[v] += starts[v - 1];
    }
    let mut cursor = starts.clone();
    let mut at = vec![0; 2 * edges.len()];
    for (number, edge) in (0..).zip(edges) {
        for &end in &edge.ends {
            at[cursor[end as usize] as usize] = number;
            cursor[end as usize] += 1;
        }
    }
    (at, starts)
}
