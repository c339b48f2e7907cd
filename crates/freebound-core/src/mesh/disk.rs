//! A mesh proved to be a disk, with index halfedges.
//!
//! Halfedge `3 f + k` is side `k` of triangle `f`. The outer sides of the boundary edges follow, in the order of the
//! boundary loop. So every edge has exactly two halfedges, and every halfedge has a twin.
//!
//! A *link* is an index of a coefficient of the equations. Halfedges are the first links; polygon diagonals that are
//! not sides of triangles follow, in both directions.

use glam::DVec3;

use super::diagonals::Diagonals;
use super::edges::{EdgeTable, first_of_fans, number_edges, side_ends};
use super::measure::Measure;
use super::polygons::{Polygon, Polygons};
use super::{EdgeId, FaceId, HalfedgeId, TriMesh, VertexId};

/// A connected, consistently oriented 2-manifold with one boundary loop and Euler characteristic 1, verified by the
/// diagnosis.
#[derive(Clone, Debug)]
pub struct DiskMesh {
    mesh: TriMesh,
    measure: Measure,
    twin: Vec<u32>,
    edge: Vec<u32>,
    halfedge_of_edge: Vec<u32>,
    /// An outgoing halfedge per vertex; at a boundary vertex, the first halfedge of its fan.
    halfedge_of_vertex: Vec<u32>,
    boundary_loop: Vec<VertexId>,
    /// Position in the boundary loop; `u32::MAX` for interior vertices.
    boundary_place: Vec<u32>,
    dividing_edges: Vec<[VertexId; 2]>,
    ears: Vec<FaceId>,
    polygons: Polygons,
    diagonals: Diagonals,
}

impl DiskMesh {
    /// Joins the halfedges of a mesh that the diagnosis found to be a disk. Unreferenced vertices move to the first
    /// boundary vertex, so that they do not enlarge the bounding box.
    pub(super) fn join(
        mut mesh: TriMesh,
        table: &EdgeTable,
        dividing_edges: Vec<[VertexId; 2]>,
        ears: Vec<FaceId>,
    ) -> Self {
        let side_count = 3 * mesh.face_count();
        let mut twin = vec![u32::MAX; side_count];
        let mut outer_of_tail = vec![u32::MAX; mesh.vertex_count()];
        let mut boundary_count = 0;
        for sides in table.edges() {
            if let &[a, b] = sides {
                twin[a as usize] = b;
                twin[b as usize] = a;
            } else {
                let (tail, _) = side_ends(&mesh.triangles, sides[0]);
                outer_of_tail[tail.index()] = sides[0];
                boundary_count += 1;
            }
        }
        let first = twin.iter().position(|&t| t == u32::MAX).expect("a disk has a boundary");
        let mut boundary_loop = Vec::with_capacity(boundary_count);
        let mut boundary_place = vec![u32::MAX; mesh.vertex_count()];
        let mut side = u32::try_from(first).expect("a side fits");
        for place in 0..u32::try_from(boundary_count).expect("a boundary fits") {
            let (tail, head) = side_ends(&mesh.triangles, side);
            boundary_loop.push(tail);
            boundary_place[tail.index()] = place;
            twin[side as usize] = u32::try_from(twin.len()).expect("a halfedge fits");
            twin.push(side);
            side = outer_of_tail[head.index()];
        }
        let ((edge, halfedge_of_edge), halfedge_of_vertex) =
            crate::parallel::join(|| number_edges(&twin), || first_of_fans(&mesh.triangles, &outer_of_tail));
        let first = mesh.positions[boundary_loop[0].index()];
        for (position, &side) in mesh.positions.iter_mut().zip(&halfedge_of_vertex) {
            if side == u32::MAX {
                *position = first;
            }
        }
        let polygons = Polygons::of(&mesh);
        let disk = Self {
            mesh,
            measure: Measure::default(),
            twin,
            edge,
            halfedge_of_edge,
            halfedge_of_vertex,
            boundary_loop,
            boundary_place,
            dividing_edges,
            ears,
            polygons: Polygons::default(),
            diagonals: Diagonals::default(),
        };
        disk.with_polygons(polygons)
    }

    fn with_polygons(self, polygons: Polygons) -> Self {
        let diagonals = Diagonals::of(&self, &polygons);
        Self { polygons, diagonals, ..self }
    }

    /// Polygons with more than three corners that the triangles are cut from.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = Polygon<'_>> + Clone {
        self.polygons.iter()
    }

    /// Polygon with more than three corners that a face is cut from, if any.
    pub fn polygon_of(&self, face: FaceId) -> Option<Polygon<'_>> {
        self.polygons.with(face)
    }

    /// Returns the surface with its polygons forgotten: triangles alone.
    #[must_use]
    pub fn without_polygons(&self) -> Self {
        self.clone().with_polygons_where(|_, _| false)
    }

    /// Returns the surface without the polygons for which `is_whole` is false: only their triangles remain.
    #[must_use]
    pub(super) fn with_polygons_where(mut self, is_whole: impl Fn(&Polygon<'_>, &TriMesh) -> bool) -> Self {
        let mut polygons = std::mem::take(&mut self.polygons);
        polygons.retain(|polygon| is_whole(polygon, &self.mesh));
        self.with_polygons(polygons)
    }

    /// Interior edges between two boundary vertices, by their ends. The theorems on planarity do not cover them.
    pub fn dividing_edges(&self) -> &[[VertexId; 2]] {
        &self.dividing_edges
    }

    /// Triangles with two or three boundary edges.
    pub fn ears(&self) -> &[FaceId] {
        &self.ears
    }

    /// Area of the surface without the filling of holes, in squared units of the mesh file.
    pub fn area(&self) -> f64 {
        let areas = self.real_faces().map(|face| self.mesh.double_area_vector(face).length() / 2.0);
        areas.sum::<f64>() * self.unit().powi(2)
    }

    /// Replaces the unit and the mollification.
    pub(super) fn measured_by(self, measure: Measure) -> Self {
        Self { measure, ..self }
    }

    /// Unit and mollification of the lengths.
    pub(super) fn measure(&self) -> Measure {
        self.measure
    }

    /// Positions and triangles.
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Position of a vertex, in units of [`unit`](Self::unit).
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.mesh.positions[vertex.index()]
    }

    /// Corners of a face, counter-clockwise.
    pub fn face(&self, face: FaceId) -> [VertexId; 3] {
        self.mesh.triangles[face.index()]
    }

    /// True if a vertex belongs to a face. An unreferenced vertex has a number and nothing else.
    pub fn is_used(&self, vertex: VertexId) -> bool {
        self.halfedge_of_vertex.get(vertex.index()).is_some_and(|&side| side != u32::MAX)
    }

    /// Number of vertices that belong to faces.
    pub fn used_vertex_count(&self) -> usize {
        // Euler characteristic of a disk: vertices − edges + faces = 1.
        1 + self.edge_count() - self.face_count()
    }

    /// Number of vertices, unreferenced vertices included.
    pub fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.mesh.face_count()
    }

    /// Number of undirected edges.
    pub fn edge_count(&self) -> usize {
        self.halfedge_of_edge.len()
    }

    /// Number of halfedges, the outer sides of the boundary included: twice the number of edges.
    pub fn halfedge_count(&self) -> usize {
        self.twin.len()
    }

    /// All vertices, unreferenced vertices included.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexId> + Clone + use<> {
        (0..self.vertex_count()).map(VertexId::from_index)
    }

    /// All faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<> {
        (0..self.face_count()).map(FaceId::from_index)
    }

    /// All undirected edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + Clone + use<> {
        (0..self.edge_count()).map(EdgeId::from_index)
    }

    /// Number of links: the halfedges, and the polygon diagonals in both directions.
    pub fn link_count(&self) -> usize {
        self.twin.len() + self.diagonals.link_count()
    }

    /// All links, halfedges first.
    pub fn links(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + Clone + use<> {
        (0..self.link_count()).map(HalfedgeId::from_index)
    }

    /// Links that leave a vertex: its halfedges in the order of [`outgoing`](Self::outgoing), then its diagonals.
    pub fn links_from(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let number = |&link: &u32| HalfedgeId::from_index(self.twin.len() + link as usize);
        self.outgoing(vertex).chain(self.diagonals.from(vertex).iter().map(number))
    }

    /// All halfedges.
    pub fn halfedges(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + Clone + use<> {
        (0..self.halfedge_count()).map(HalfedgeId::from_index)
    }

    /// Vertex that a link leaves.
    pub fn tail(&self, link: HalfedgeId) -> VertexId {
        self.link_ends(link)[0]
    }

    /// Vertex that a link points to.
    pub fn head(&self, link: HalfedgeId) -> VertexId {
        self.link_ends(link)[1]
    }

    fn link_ends(&self, link: HalfedgeId) -> [VertexId; 2] {
        let inner = |side: u32| <[VertexId; 2]>::from(side_ends(&self.mesh.triangles, side));
        match self.twin.get(link.index()) {
            None => self.diagonals.ends(link.index() - self.twin.len()),
            Some(&twin) if self.is_outer(link) => {
                let [head, tail] = inner(twin);
                [tail, head]
            }
            Some(_) => inner(link.number()),
        }
    }

    /// Opposite direction of an edge or diagonal.
    pub fn twin(&self, link: HalfedgeId) -> HalfedgeId {
        let count = self.twin.len();
        match self.twin.get(link.index()) {
            Some(&twin) => HalfedgeId::new(twin),
            None => HalfedgeId::from_index(count + ((link.index() - count) ^ 1)),
        }
    }

    /// Next halfedge around the face or, for outer halfedges, along the boundary.
    pub fn next(&self, halfedge: HalfedgeId) -> HalfedgeId {
        self.turn(halfedge, 1)
    }

    /// Previous halfedge around the face or, for outer halfedges, along the boundary.
    pub fn previous(&self, halfedge: HalfedgeId) -> HalfedgeId {
        self.turn(halfedge, 2)
    }

    fn turn(&self, halfedge: HalfedgeId, by: usize) -> HalfedgeId {
        let h = halfedge.index();
        let inner = 3 * self.face_count();
        if h < inner {
            return HalfedgeId::from_index(h - h % 3 + (h + by) % 3);
        }
        // Outer halfedges run against the loop: the next outer side is the previous side in the loop.
        let count = self.boundary_loop.len();
        let step = if by == 1 { count - 1 } else { 1 };
        HalfedgeId::from_index(inner + (h - inner + step) % count)
    }

    /// True if a halfedge lies outside the surface, along its boundary.
    pub fn is_outer(&self, halfedge: HalfedgeId) -> bool {
        halfedge.index() >= 3 * self.face_count()
    }

    /// Face to the left of a halfedge; `None` for outer halfedges.
    pub fn face_of(&self, halfedge: HalfedgeId) -> Option<FaceId> {
        (!self.is_outer(halfedge)).then(|| FaceId::from_index(halfedge.index() / 3))
    }

    /// Edge of a halfedge.
    pub fn edge_of(&self, halfedge: HalfedgeId) -> EdgeId {
        EdgeId::new(self.edge[halfedge.index()])
    }

    /// First halfedge of an edge, inside the surface.
    pub fn halfedge(&self, edge: EdgeId) -> HalfedgeId {
        HalfedgeId::new(self.halfedge_of_edge[edge.index()])
    }

    /// Ends of an edge, in the direction of its first halfedge.
    pub fn ends(&self, edge: EdgeId) -> [VertexId; 2] {
        let h = self.halfedge(edge);
        [self.tail(h), self.head(h)]
    }

    /// True if an edge lies on the boundary.
    pub fn is_boundary_edge(&self, edge: EdgeId) -> bool {
        self.is_outer(self.twin(self.halfedge(edge)))
    }

    /// Vertices of the boundary, counter-clockwise: the surface lies to the left.
    pub fn boundary_loop(&self) -> &[VertexId] {
        &self.boundary_loop
    }

    /// Edge from position `place` of the boundary loop to the next position.
    pub fn boundary_edge(&self, place: usize) -> EdgeId {
        self.edge_of(HalfedgeId::from_index(3 * self.face_count() + place))
    }

    /// Position of a vertex in the boundary loop; `None` for interior vertices.
    pub fn boundary_place(&self, vertex: VertexId) -> Option<usize> {
        let place = self.boundary_place[vertex.index()];
        (place != u32::MAX).then_some(place as usize)
    }

    /// Outgoing halfedges of a vertex, counter-clockwise. At a boundary vertex the fan begins at the boundary and ends
    /// with the outer halfedge. An unreferenced vertex has none.
    pub fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let first = HalfedgeId::new(self.halfedge_of_vertex[vertex.index()]);
        let mut at = self.is_used(vertex).then_some(first);
        std::iter::from_fn(move || {
            let here = at?;
            at = (!self.is_outer(here)).then(|| self.twin(self.previous(here))).filter(|&h| h != first);
            Some(here)
        })
    }
}
