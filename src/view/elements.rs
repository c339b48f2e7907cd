//! Elements of a mesh: sets of vertices, edges or faces, what follows from a set, and the element under a point.
//!
//! A face is a polygon with all of its triangles. Diagonals, which cut polygons into triangles, are no edges.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use glam::DVec2;

use super::{EdgeLoops, VertexSets};
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};

/// Edge by its ends, the smaller number first.
pub type MeshEdge = [VertexId; 2];

/// Edge with the smaller number first.
pub(super) fn ascending([a, b]: [VertexId; 2]) -> MeshEdge {
    [a.min(b), a.max(b)]
}

/// Kinds of elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ElementKind {
    /// Vertices.
    #[default]
    Vertices,
    /// Edges.
    Edges,
    /// Faces.
    Faces,
}

/// Element of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshElement {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(MeshEdge),
    /// A face, by its first triangle.
    Face(FaceId),
}

/// Set of elements of one kind, with their vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ElementSet {
    kind: ElementKind,
    /// The vertices, or those of the edges or faces.
    vertices: BTreeSet<VertexId>,
    /// The edges. Empty for another kind.
    edges: BTreeSet<MeshEdge>,
    /// All triangles of the faces. Empty for another kind.
    faces: BTreeSet<FaceId>,
}

impl ElementSet {
    /// Set of vertices.
    pub fn of_vertices(vertices: impl IntoIterator<Item = VertexId>) -> Self {
        Self { vertices: vertices.into_iter().collect(), ..Self::default() }
    }

    fn of_edges(edges: BTreeSet<MeshEdge>) -> Self {
        let vertices = edges.iter().flatten().copied().collect();
        Self { kind: ElementKind::Edges, vertices, edges, faces: BTreeSet::new() }
    }

    /// Kind of the elements.
    pub fn kind(&self) -> ElementKind {
        self.kind
    }

    /// Vertices of the elements.
    pub fn vertices(&self) -> &BTreeSet<VertexId> {
        &self.vertices
    }

    /// Edges. Empty for another kind.
    pub fn edges(&self) -> &BTreeSet<MeshEdge> {
        &self.edges
    }

    /// All triangles of the faces. Empty for another kind.
    pub fn faces(&self) -> &BTreeSet<FaceId> {
        &self.faces
    }

    /// True without elements.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// Vertices of the elements, as a set of vertices.
    #[must_use = "the set itself is used up"]
    pub fn into_vertices(self) -> Self {
        Self { vertices: self.vertices, ..Self::default() }
    }

    /// Adds vertices to their set. Edges and faces become their vertices.
    pub fn add_vertices(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        let mut all = std::mem::take(self).into_vertices();
        all.vertices.extend(vertices);
        *self = all;
    }

    /// Adds a vertex, or removes it. Edges and faces become their vertices.
    pub fn toggle_vertex(&mut self, vertex: VertexId) {
        let mut all = std::mem::take(self).into_vertices();
        if !all.vertices.remove(&vertex) {
            all.vertices.insert(vertex);
        }
        *self = all;
    }
}

/// Disk within a mesh of several.
#[derive(Clone, Copy, Debug)]
pub struct MeshPart<'a> {
    /// The disk.
    pub disk: &'a DiskMesh,
    /// Number of the disk's first vertex in the mesh.
    pub first_vertex: usize,
    /// Number of the disk's first triangle in the mesh.
    pub first_face: usize,
}

/// Mesh whose elements are selected.
#[derive(Clone, Debug)]
pub struct ElementMesh<'a> {
    sets: VertexSets<'a>,
    /// Disks of the mesh, in the order of its triangles. Empty for a mesh that is no disk: its faces are triangles.
    parts: Vec<MeshPart<'a>>,
}

/// Faces and edges.
impl<'a> ElementMesh<'a> {
    /// Mesh with its disks.
    pub fn new(sets: VertexSets<'a>, parts: Vec<MeshPart<'a>>) -> Self {
        Self { sets, parts }
    }

    /// Corners of a triangle, if there is one of this number.
    pub fn triangle(&self, face: FaceId) -> Option<[VertexId; 3]> {
        self.sets.triangles.get(face.index()).copied()
    }

    /// Triangles of the face with a triangle. Sets `corners` to the corners of the face.
    fn face(&self, triangle: usize, corners: &mut Vec<VertexId>) -> Range<usize> {
        corners.clear();
        let place = self.parts.partition_point(|part| part.first_face <= triangle);
        let part = place.checked_sub(1).map(|place| self.parts[place]);
        let polygon =
            part.and_then(|part| Some((part, part.disk.polygon_of(FaceId::from_index(triangle - part.first_face))?)));
        let Some((part, polygon)) = polygon else {
            corners.extend(self.sets.triangles[triangle]);
            return triangle..triangle + 1;
        };
        corners.extend(polygon.corners.iter().map(|v| VertexId::from_index(part.first_vertex + v.index())));
        let first = part.first_face + polygon.first_face.index();
        first..first + polygon.faces().len()
    }

    /// Calls `see` for each face with its triangles and its corners.
    fn visit(&self, mut see: impl FnMut(Range<usize>, &[VertexId])) {
        self.any_face(|triangles, corners| {
            see(triangles, corners);
            false
        });
    }

    /// True if a face counts, by its triangles and its corners. Stops at the first one.
    fn any_face(&self, mut counts: impl FnMut(Range<usize>, &[VertexId]) -> bool) -> bool {
        let (mut corners, mut triangle) = (Vec::new(), 0);
        while triangle < self.sets.triangles.len() {
            let triangles = self.face(triangle, &mut corners);
            triangle = triangles.end;
            if counts(triangles, &corners) {
                return true;
            }
        }
        false
    }

    /// Edges that count.
    fn edges_with(&self, is_wanted: impl Fn(MeshEdge) -> bool) -> BTreeSet<MeshEdge> {
        let mut edges = Vec::new();
        self.visit(|_, corners| edges.extend(sides(corners).filter(|&edge| is_wanted(edge))));
        edges.into_iter().collect()
    }

    /// Edges of the faces with one of these triangles.
    fn edges_of(&self, triangles: impl Fn(usize) -> bool) -> BTreeSet<MeshEdge> {
        let mut edges = Vec::new();
        self.visit(|mut own, corners| {
            if own.any(&triangles) {
                edges.extend(sides(corners));
            }
        });
        edges.into_iter().collect()
    }

    /// Set of the faces that count.
    fn faces_with(&self, is_wanted: impl Fn(Range<usize>, &[VertexId]) -> bool) -> ElementSet {
        let (mut faces, mut vertices) = (Vec::new(), Vec::new());
        self.visit(|triangles, corners| {
            if is_wanted(triangles.clone(), corners) {
                faces.extend(triangles.map(FaceId::from_index));
                vertices.extend_from_slice(corners);
            }
        });
        ElementSet {
            kind: ElementKind::Faces,
            vertices: vertices.into_iter().collect(),
            edges: BTreeSet::new(),
            faces: faces.into_iter().collect(),
        }
    }

    /// Vertices that count.
    pub fn vertices_where(&self, is_wanted: impl Fn(VertexId) -> bool) -> ElementSet {
        ElementSet::of_vertices(self.sets.all().into_iter().filter(|&vertex| is_wanted(vertex)))
    }

    /// Edges that count.
    pub fn edges_where(&self, is_wanted: impl Fn(MeshEdge) -> bool) -> ElementSet {
        ElementSet::of_edges(self.edges_with(is_wanted))
    }

    /// Faces with a triangle that counts.
    pub fn faces_where(&self, is_wanted: impl Fn(FaceId) -> bool) -> ElementSet {
        self.within_faces(ElementKind::Faces, |triangle| is_wanted(FaceId::from_index(triangle)))
    }

    /// Elements of a kind between vertices.
    fn between(&self, kind: ElementKind, is_in: &[bool]) -> ElementSet {
        let holds = |vertex: &VertexId| is_in[vertex.index()];
        match kind {
            ElementKind::Vertices => ElementSet::of_vertices(self.sets.all().into_iter().filter(holds)),
            ElementKind::Edges => ElementSet::of_edges(self.edges_with(|ends| ends.iter().all(holds))),
            ElementKind::Faces => self.faces_with(|_, corners| corners.iter().all(holds)),
        }
    }

    /// Elements of a kind in the faces with triangles that count.
    fn within_faces(&self, kind: ElementKind, triangles: impl Fn(usize) -> bool) -> ElementSet {
        match kind {
            ElementKind::Vertices => ElementSet::of_vertices(self.sets.corners_of(triangles)),
            ElementKind::Edges => ElementSet::of_edges(self.edges_of(triangles)),
            ElementKind::Faces => self.faces_with(|mut own, _| own.any(&triangles)),
        }
    }
}

/// Sides of a face, as edges.
fn sides(corners: &[VertexId]) -> impl Iterator<Item = MeshEdge> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&a, &b)| ascending([a, b]))
}

/// Sets that follow from others.
impl ElementMesh<'_> {
    /// Elements of another kind: edges and faces lie between selected vertices, faces between selected edges.
    pub fn converted(&self, elements: &ElementSet, kind: ElementKind) -> ElementSet {
        match (elements.kind, kind) {
            (from, to) if from == to => elements.clone(),
            (_, ElementKind::Vertices) => elements.clone().into_vertices(),
            (ElementKind::Faces, _) => ElementSet::of_edges(self.edges_in(elements)),
            (ElementKind::Edges, _) => {
                self.faces_with(|_, corners| sides(corners).all(|edge| elements.edges.contains(&edge)))
            }
            (ElementKind::Vertices, _) => self.between(kind, &self.sets.marked(&elements.vertices)),
        }
    }

    /// Edges of elements: those between the vertices, the edges themselves, or the edges of the faces.
    pub fn edges_in(&self, elements: &ElementSet) -> BTreeSet<MeshEdge> {
        match elements.kind {
            ElementKind::Edges => elements.edges.clone(),
            ElementKind::Faces => self.edges_of(|triangle| elements.faces.contains(&FaceId::from_index(triangle))),
            ElementKind::Vertices if elements.vertices.len() < 2 => BTreeSet::new(),
            ElementKind::Vertices => self.between(ElementKind::Edges, &self.sets.marked(&elements.vertices)).edges,
        }
    }

    /// Edges along which elements are cut: edges between two faces; of faces, those at their border.
    pub fn edges_to_cut(&self, elements: &ElementSet) -> BTreeSet<MeshEdge> {
        let is_selected = |triangles: &Range<usize>| elements.faces.contains(&FaceId::from_index(triangles.start));
        // Numbers of faces at each edge: those that are not selected, and those that are.
        let mut counts: BTreeMap<MeshEdge, [usize; 2]> =
            self.edges_in(elements).into_iter().map(|e| (e, [0; 2])).collect();
        self.visit(|triangles, corners| {
            let place = usize::from(is_selected(&triangles));
            for edge in sides(corners) {
                if let Some(count) = counts.get_mut(&edge) {
                    count[place] += 1;
                }
            }
        });
        let is_cut = |counts: [usize; 2]| match elements.kind {
            ElementKind::Faces => counts == [1, 1],
            _ => counts[0] == 2,
        };
        counts.into_iter().filter(|(_, counts)| is_cut(*counts)).map(|(edge, _)| edge).collect()
    }

    /// All elements of a kind.
    pub fn all(&self, kind: ElementKind) -> ElementSet {
        self.within_faces(kind, |_| true)
    }

    /// Elements that are not in the set.
    pub fn inverted(&self, elements: &ElementSet) -> ElementSet {
        match elements.kind {
            ElementKind::Vertices => ElementSet::of_vertices(self.sets.inverted(&elements.vertices)),
            ElementKind::Edges => ElementSet::of_edges(self.edges_with(|edge| !elements.edges.contains(&edge))),
            ElementKind::Faces => {
                self.faces_with(|triangles, _| !elements.faces.contains(&FaceId::from_index(triangles.start)))
            }
        }
    }

    /// Elements with their neighbours: vertices of a common triangle, edges and faces with a common vertex.
    pub fn grown(&self, elements: &ElementSet) -> ElementSet {
        let is_in = self.sets.marked(&elements.vertices);
        let holds = |vertex: &VertexId| is_in[vertex.index()];
        match elements.kind {
            ElementKind::Vertices => ElementSet::of_vertices(self.sets.grown(&elements.vertices)),
            ElementKind::Edges => ElementSet::of_edges(self.edges_with(|ends| ends.iter().any(holds))),
            ElementKind::Faces => self.faces_with(|_, corners| corners.iter().any(holds)),
        }
    }

    /// Elements without those that have a neighbour outside the set.
    pub fn shrunk(&self, elements: &ElementSet) -> ElementSet {
        match elements.kind {
            ElementKind::Vertices => ElementSet::of_vertices(self.sets.shrunk(&elements.vertices)),
            _ => self.inverted(&self.grown(&self.inverted(elements))),
        }
    }

    /// Triangles that a search across faces starts from.
    fn start(&self, elements: &ElementSet) -> Vec<usize> {
        match elements.kind {
            ElementKind::Vertices => self.sets.faces_at(&elements.vertices),
            ElementKind::Faces => {
                let is_there = |&face: &usize| face < self.sets.triangles.len();
                elements.faces.iter().map(|face| face.index()).filter(is_there).collect()
            }
            ElementKind::Edges => {
                let mut start = Vec::new();
                self.visit(|triangles, corners| {
                    if sides(corners).any(|edge| elements.edges.contains(&edge)) {
                        start.extend(triangles);
                    }
                });
                start
            }
        }
    }

    /// Elements in the faces that are reached from a set without crossing an edge whose faces meet at this angle or more.
    pub fn up_to_sharp_edges(&self, elements: &ElementSet, degrees: f64) -> ElementSet {
        let is_reached = self.sets.faces_up_to_sharp_edges(self.start(elements), degrees);
        self.within_faces(elements.kind, |triangle| is_reached[triangle])
    }

    /// Elements in the faces that are connected with a set.
    pub fn connected(&self, elements: &ElementSet) -> ElementSet {
        self.up_to_sharp_edges(elements, f64::INFINITY)
    }

    /// Elements of a kind at the boundary: ends of edges with a single face, these edges, or their faces.
    pub fn boundary(&self, kind: ElementKind) -> ElementSet {
        let single = self.sets.single_sides();
        if kind == ElementKind::Faces {
            let mut is_there = vec![false; self.sets.triangles.len()];
            for side in single {
                is_there[side as usize / 3] = true;
            }
            return self.within_faces(kind, |triangle| is_there[triangle]);
        }
        let edges = ElementSet::of_edges(single.into_iter().map(|side| ascending(self.sets.ends(side))).collect());
        self.converted(&edges, kind)
    }

    /// Elements of a kind in the triangles with the greatest values that together have this share of the area.
    pub fn greatest(&self, kind: ElementKind, value: impl Fn(usize) -> f64, share: f64) -> ElementSet {
        let is_taken = self.sets.greatest_faces(value, share);
        self.within_faces(kind, |triangle| is_taken[triangle])
    }

    /// Elements of a kind whose vertices all count.
    pub fn inside(&self, kind: ElementKind, holds: impl Fn(VertexId) -> bool) -> ElementSet {
        let is_in: Vec<bool> = (0..self.sets.positions.len()).map(|v| holds(VertexId::from_index(v))).collect();
        self.between(kind, &is_in)
    }

    /// Edges that loops and rings start from: of faces, those between two of them.
    fn start_of_loops(&self, elements: &ElementSet) -> BTreeSet<MeshEdge> {
        if elements.kind != ElementKind::Faces {
            return self.edges_in(elements);
        }
        let (mut once, mut twice) = (BTreeSet::new(), BTreeSet::new());
        self.visit(|triangles, corners| {
            if elements.faces.contains(&FaceId::from_index(triangles.start)) {
                twice.extend(sides(corners).filter(|&edge| !once.insert(edge)));
            }
        });
        twice
    }

    /// True if loops start from the set. Stops at the first edge and visits the set alone, because menus ask in every
    /// frame.
    pub fn has_loops(&self, elements: &ElementSet) -> bool {
        match elements.kind {
            ElementKind::Edges => !elements.edges.is_empty(),
            ElementKind::Vertices => elements.vertices.iter().any(|&vertex| self.has_edge_within(vertex, elements)),
            ElementKind::Faces => elements.faces.iter().any(|&triangle| self.has_neighbour_within(triangle, elements)),
        }
    }

    /// True if an edge leads from a vertex to another one of a set.
    fn has_edge_within(&self, vertex: VertexId, elements: &ElementSet) -> bool {
        let place = self.parts.partition_point(|part| part.first_vertex <= vertex.index()).checked_sub(1);
        place.map(|place| &self.parts[place]).is_some_and(|part| {
            let is_in =
                |own: VertexId| elements.vertices.contains(&VertexId::from_index(part.first_vertex + own.index()));
            EdgeLoops(part.disk).leads_from(VertexId::from_index(vertex.index() - part.first_vertex), is_in)
        })
    }

    /// True if an edge lies between the face of a triangle and another face of a set.
    fn has_neighbour_within(&self, triangle: FaceId, elements: &ElementSet) -> bool {
        let place = self.parts.partition_point(|part| part.first_face <= triangle.index()).checked_sub(1);
        place.map(|place| &self.parts[place]).is_some_and(|part| {
            let is_in = |own: FaceId| elements.faces.contains(&FaceId::from_index(part.first_face + own.index()));
            EdgeLoops(part.disk).borders(FaceId::from_index(triangle.index() - part.first_face), is_in)
        })
    }

    /// Edge loops through the edges of a set, or the faces of the rings between its faces.
    pub fn loops(&self, elements: &ElementSet) -> ElementSet {
        match elements.kind {
            ElementKind::Faces => self.rings(elements),
            kind => self.of_loops(kind, self.in_parts(elements, |disk, edges| EdgeLoops(disk).loops(edges))),
        }
    }

    /// Edge rings of the edges of a set, or the faces of the rings.
    pub fn rings(&self, elements: &ElementSet) -> ElementSet {
        self.of_loops(elements.kind, self.in_parts(elements, |disk, edges| EdgeLoops(disk).rings(edges)))
    }

    fn of_loops(&self, kind: ElementKind, edges: BTreeSet<MeshEdge>) -> ElementSet {
        match kind {
            ElementKind::Vertices => ElementSet::of_edges(edges).into_vertices(),
            ElementKind::Edges => ElementSet::of_edges(edges),
            ElementKind::Faces => self.faces_with(|_, corners| sides(corners).any(|edge| edges.contains(&edge))),
        }
    }

    /// Edges that follow from those of a set within each disk.
    fn in_parts(
        &self,
        elements: &ElementSet,
        follow: impl Fn(&DiskMesh, &BTreeSet<MeshEdge>) -> BTreeSet<MeshEdge>,
    ) -> BTreeSet<MeshEdge> {
        let edges = self.start_of_loops(elements);
        let of_part = |part: &MeshPart<'_>| {
            let range = part.first_vertex..part.first_vertex + part.disk.vertex_count();
            let low = [VertexId::from_index(range.start), VertexId::new(0)];
            let own = edges.range(low..).copied().take_while(|[first, _]| first.index() < range.end);
            let by = part.first_vertex;
            let local = own.map(|ends| ends.map(|end| VertexId::from_index(end.index() - by))).collect();
            let found = follow(part.disk, &local);
            found.into_iter().map(|ends| ends.map(|end| VertexId::from_index(end.index() + by))).collect::<Vec<_>>()
        };
        self.parts.iter().flat_map(of_part).collect()
    }

    /// Union of a set and others of its kind.
    pub fn union(&self, elements: &ElementSet, other: &ElementSet) -> ElementSet {
        let other = self.converted(other, elements.kind);
        ElementSet {
            kind: elements.kind,
            vertices: &elements.vertices | &other.vertices,
            edges: &elements.edges | &other.edges,
            faces: &elements.faces | &other.faces,
        }
    }

    /// Set of elements of a kind. Those of another kind, and those that the mesh does not have, are left out.
    pub fn set_of(&self, kind: ElementKind, elements: impl IntoIterator<Item = MeshElement>) -> ElementSet {
        let (mut vertices, mut edges, mut faces) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
        let is_there = |vertex: VertexId| vertex.index() < self.sets.positions.len();
        for element in elements {
            match element {
                MeshElement::Vertex(vertex) if is_there(vertex) => drop(vertices.insert(vertex)),
                MeshElement::Edge(ends) if ends.into_iter().all(is_there) => drop(edges.insert(ascending(ends))),
                MeshElement::Vertex(_) | MeshElement::Edge(_) => {}
                MeshElement::Face(face) => drop(faces.insert(face.index())),
            }
        }
        match kind {
            ElementKind::Vertices => ElementSet::of_vertices(vertices),
            ElementKind::Edges => ElementSet::of_edges(edges),
            ElementKind::Faces if faces.is_empty() => ElementSet { kind, ..ElementSet::default() },
            ElementKind::Faces => self.within_faces(kind, |triangle| faces.contains(&triangle)),
        }
    }

    /// Set of one element.
    pub fn single(&self, element: MeshElement) -> ElementSet {
        let kind = match element {
            MeshElement::Vertex(_) => ElementKind::Vertices,
            MeshElement::Edge(_) => ElementKind::Edges,
            MeshElement::Face(_) => ElementKind::Faces,
        };
        self.set_of(kind, [element])
    }

    /// Set with an element, or without it if the set has it. The set becomes one of the element's kind.
    pub fn toggled(&self, elements: &ElementSet, element: MeshElement) -> ElementSet {
        let single = self.single(element);
        let before = self.converted(elements, single.kind);
        let has_it = match element {
            MeshElement::Vertex(vertex) => before.vertices.contains(&vertex),
            MeshElement::Edge(edge) => before.edges.contains(&ascending(edge)),
            MeshElement::Face(face) => before.faces.contains(&face),
        };
        if !has_it {
            return self.union(&before, &single);
        }
        match single.kind {
            ElementKind::Vertices => ElementSet::of_vertices(&before.vertices - &single.vertices),
            ElementKind::Edges => ElementSet::of_edges(&before.edges - &single.edges),
            ElementKind::Faces => {
                let left = &before.faces - &single.faces;
                self.within_faces(ElementKind::Faces, |triangle| left.contains(&FaceId::from_index(triangle)))
            }
        }
    }
}

/// Elements under a point.
impl ElementMesh<'_> {
    /// Element of a kind at a triangle: its face, or the side or corner that is nearest by `distance`, within a radius.
    /// `distance` is between the point and the segment of two vertices.
    pub fn element_at(
        &self,
        kind: ElementKind,
        triangle: usize,
        radius: f64,
        distance: impl Fn(MeshEdge) -> f64,
    ) -> Option<MeshElement> {
        let mut corners = Vec::new();
        let triangles = self.face(triangle, &mut corners);
        let nearest = |candidates: Vec<MeshEdge>| {
            let away = candidates.into_iter().map(|ends| (distance(ends), ends));
            let least = away.min_by(|a, b| a.0.total_cmp(&b.0));
            least.filter(|(away, _)| *away <= radius).map(|(_, ends)| ends)
        };
        match kind {
            ElementKind::Faces => Some(MeshElement::Face(FaceId::from_index(triangles.start))),
            ElementKind::Edges => nearest(sides(&corners).collect()).map(MeshElement::Edge),
            ElementKind::Vertices => nearest(corners.iter().map(|&corner| [corner; 2]).collect())
                .map(|[vertex, _]| MeshElement::Vertex(vertex)),
        }
    }

    /// Element of a kind at a point of the plane: the face that covers the point, or the nearest edge or vertex within a
    /// radius. `places` are the positions of all vertices.
    pub fn element_in_plane(&self, kind: ElementKind, places: &[DVec2], at: DVec2, radius: f64) -> Option<MeshElement> {
        let reach = if kind == ElementKind::Faces { 0.0 } else { radius };
        let away = |[a, b]: MeshEdge| distance_to_segment(at, [places[a.index()], places[b.index()]]);
        let mut best: Option<(f64, MeshElement)> = None;
        for (number, corners) in self.sets.triangles.iter().enumerate() {
            let ends = corners.map(|corner| places[corner.index()]);
            let [low, high] = [ends[0].min(ends[1]).min(ends[2]) - reach, ends[0].max(ends[1]).max(ends[2]) + reach];
            if !(low.cmple(at).all() && at.cmple(high).all()) || kind == ElementKind::Faces && !covers(ends, at) {
                continue;
            }
            let Some(element) = self.element_at(kind, number, radius, away) else { continue };
            let distance = match element {
                MeshElement::Vertex(vertex) => away([vertex; 2]),
                MeshElement::Edge(edge) => away(edge),
                MeshElement::Face(_) => return Some(element),
            };
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, element));
            }
        }
        best.map(|(_, element)| element)
    }

    /// Outline of an element: its segments; none for a vertex.
    pub fn outline(&self, element: MeshElement) -> Vec<MeshEdge> {
        match element {
            MeshElement::Edge(edge) => vec![edge],
            MeshElement::Face(face) if face.index() < self.sets.triangles.len() => {
                let mut corners = Vec::new();
                self.face(face.index(), &mut corners);
                sides(&corners).collect()
            }
            MeshElement::Vertex(_) | MeshElement::Face(_) => Vec::new(),
        }
    }
}

/// True if a triangle of either orientation covers a point.
fn covers([a, b, c]: [DVec2; 3], at: DVec2) -> bool {
    let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(at - from));
    turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0)
}

/// Distance of a point from a segment, which may have no length.
pub fn distance_to_segment(at: DVec2, [start, end]: [DVec2; 2]) -> f64 {
    let way = end - start;
    let share = ((at - start).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    at.distance(if share.is_finite() { start + share * way } else { start })
}

#[cfg(test)]
mod tests {
    use super::*;
    use freebound_core::mesh::{PolygonMesh, TriMesh};
    use freebound_testkit::{disk, grid, shaped};
    use glam::DVec3;

    /// Number of quadrilaterals along a side.
    const SIDE: u32 = 4;

    fn v(x: u32, y: u32) -> VertexId {
        VertexId::new(y * (SIDE + 1) + x)
    }

    fn edge(a: VertexId, b: VertexId) -> MeshEdge {
        ascending([a, b])
    }

    fn square() -> DiskMesh {
        let positions: Vec<[f64; 3]> =
            (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| [f64::from(x), f64::from(y), 0.0])).collect();
        let corners = |i: u32| {
            let (x, y) = (i % SIDE, i / SIDE);
            [v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y + 1)].map(VertexId::number).to_vec()
        };
        let faces: Vec<Vec<u32>> = (0..SIDE * SIDE).map(corners).collect();
        disk(PolygonMesh::from_arrays(&positions, &faces).triangulate())
    }

    fn of(disk: &DiskMesh) -> ElementMesh<'_> {
        let sets = VertexSets { positions: &disk.mesh().positions, triangles: disk.mesh().real_triangles() };
        ElementMesh::new(sets, vec![MeshPart { disk, first_vertex: 0, first_face: 0 }])
    }

    fn triangles(mesh: &TriMesh) -> ElementMesh<'_> {
        ElementMesh::new(VertexSets { positions: &mesh.positions, triangles: &mesh.triangles }, Vec::new())
    }

    fn vertices(numbers: impl IntoIterator<Item = u32>) -> ElementSet {
        ElementSet::of_vertices(numbers.into_iter().map(VertexId::new))
    }

    /// Face at a column and a row.
    fn face(mesh: &ElementMesh<'_>, x: u32, y: u32) -> ElementSet {
        let corners = [v(x, y), v(x + 1, y), v(x + 1, y + 1), v(x, y + 1)];
        mesh.converted(&ElementSet::of_vertices(corners), ElementKind::Faces)
    }

    #[test]
    fn a_quadrilateral_is_one_face_with_four_edges() {
        let disk = square();
        let mesh = of(&disk);
        let face = face(&mesh, 1, 2);
        assert_eq!((face.faces().len(), face.vertices().len()), (2, 4), "two triangles");
        let edges = mesh.converted(&face, ElementKind::Edges);
        assert_eq!(edges.edges().len(), 4, "its diagonal is no edge");
        assert_eq!(mesh.converted(&edges, ElementKind::Faces), face);
        let count = |kind| mesh.all(kind);
        assert_eq!(count(ElementKind::Vertices).vertices().len(), 25);
        assert_eq!(count(ElementKind::Edges).edges().len(), 40);
        assert_eq!(count(ElementKind::Faces).faces().len(), 32);
    }

    #[test]
    fn sets_of_each_kind_grow_shrink_and_invert() {
        let disk = square();
        let mesh = of(&disk);
        let middle = face(&mesh, 1, 1);
        let grown = mesh.grown(&middle);
        assert_eq!(grown.faces().len(), 18, "nine faces of two triangles");
        let corner = [(0, 0), (1, 0), (0, 1)].map(|(x, y)| face(&mesh, x, y));
        let with_corner = corner.iter().fold(middle.clone(), |all, face| mesh.union(&all, face));
        assert_eq!(mesh.shrunk(&grown), with_corner, "faces at the corner have no neighbour outside");
        for kind in [ElementKind::Vertices, ElementKind::Edges, ElementKind::Faces] {
            let some = mesh.converted(&middle, kind);
            assert_eq!(mesh.inverted(&mesh.inverted(&some)), some, "{kind:?}");
            assert_eq!(mesh.connected(&some), mesh.all(kind), "{kind:?}");
            assert_eq!(mesh.shrunk(&mesh.all(kind)), mesh.all(kind), "{kind:?}");
        }
    }

    #[test]
    fn edges_are_cut_along_and_faces_around() {
        let disk = square();
        let mesh = of(&disk);
        let row = [v(0, 2), v(1, 2), v(2, 2)];
        let along = mesh.edges_to_cut(&ElementSet::of_vertices(row));
        assert_eq!(along, [edge(v(0, 2), v(1, 2)), edge(v(1, 2), v(2, 2))].into());
        let pair = mesh.union(&face(&mesh, 1, 1), &face(&mesh, 2, 1));
        assert_eq!(mesh.edges_to_cut(&pair).len(), 6, "not between them");
        let at_rim = mesh.edges_to_cut(&face(&mesh, 0, 0));
        assert_eq!(at_rim, [edge(v(1, 0), v(1, 1)), edge(v(0, 1), v(1, 1))].into(), "the boundary is open already");
        assert!(mesh.edges_to_cut(&mesh.boundary(ElementKind::Edges)).is_empty());
    }

    #[test]
    fn loops_and_rings_keep_their_kind() {
        let disk = square();
        let mesh = of(&disk);
        let one = mesh.single(MeshElement::Edge(edge(v(1, 2), v(2, 2))));
        let row = (0..SIDE).map(|x| edge(v(x, 2), v(x + 1, 2))).collect();
        assert_eq!(*mesh.loops(&one).edges(), row);
        let rungs = (0..=SIDE).map(|y| edge(v(1, y), v(2, y))).collect();
        assert_eq!(*mesh.rings(&one).edges(), rungs, "without the edges between the rungs");
        let pair = mesh.union(&face(&mesh, 1, 1), &face(&mesh, 1, 2));
        assert_eq!(mesh.loops(&pair).faces().len(), 8, "the column of both faces");
        assert!(!mesh.has_loops(&face(&mesh, 1, 1)) && mesh.has_loops(&pair));
    }

    #[test]
    fn sets_of_several_disks_stay_on_their_disk() {
        let disk = square();
        let single = disk.mesh();
        let (count, faces) = (single.vertex_count(), single.real_triangles().len());
        let moved = |vertex: VertexId| VertexId::from_index(count + vertex.index());
        let positions: Vec<DVec3> = single.positions.iter().chain(&single.positions).copied().collect();
        let second = single.real_triangles().iter().map(|corners| corners.map(moved));
        let triangles: Vec<[VertexId; 3]> = single.real_triangles().iter().copied().chain(second).collect();
        let parts = [(0, 0), (count, faces)];
        let parts = parts.map(|(first_vertex, first_face)| MeshPart { disk: &disk, first_vertex, first_face });
        let sets = VertexSets { positions: &positions, triangles: &triangles };
        let mesh = ElementMesh::new(sets, parts.to_vec());
        let one = mesh.single(MeshElement::Edge(edge(moved(v(1, 2)), moved(v(2, 2)))));
        let row = (0..SIDE).map(|x| edge(moved(v(x, 2)), moved(v(x + 1, 2)))).collect();
        assert_eq!(*mesh.loops(&one).edges(), row);
        assert_eq!(mesh.connected(&one).edges().len(), 40);
        assert_eq!(mesh.all(ElementKind::Faces).faces().len(), 2 * faces);
        let face = mesh.single(MeshElement::Face(FaceId::from_index(faces + 3)));
        assert_eq!(face.faces().iter().map(|face| face.index()).collect::<Vec<_>>(), [faces + 2, faces + 3]);
    }

    #[test]
    fn faces_beyond_the_mesh_reach_no_others() {
        let disk = square();
        let mesh = of(&disk);
        let all = mesh.all(ElementKind::Faces);
        let smaller = grid(2, 2);
        let other = triangles(&smaller);
        assert_eq!(other.connected(&all).faces().len(), 8, "those that both meshes have, and their chart");
        let beyond = mesh.faces_where(|face| face.index() >= 8);
        assert!(other.connected(&beyond).is_empty());
    }

    #[test]
    fn loops_start_from_edges_and_from_faces_beside_each_other() {
        let disk = square();
        let mesh = of(&disk);
        let has = |set: ElementSet| mesh.has_loops(&set);
        assert!(has(ElementSet::of_vertices([v(1, 1), v(2, 1)])));
        assert!(!has(ElementSet::of_vertices([v(1, 1), v(3, 3)])) && !has(ElementSet::of_vertices([v(1, 1)])));
        assert!(!has(ElementSet::of_vertices([v(1, 1), v(2, 2)])) && !has(ElementSet::of_vertices([v(2, 1), v(1, 2)])));
        assert!(!has(face(&mesh, 1, 1)), "its two triangles are one face");
        assert!(has(mesh.union(&face(&mesh, 1, 1), &face(&mesh, 2, 1))));
        assert!(!has(mesh.union(&face(&mesh, 1, 1), &face(&mesh, 3, 1))));
        assert!(!has(mesh.union(&face(&mesh, 1, 1), &face(&mesh, 2, 2))), "a common corner is no edge");
    }

    #[test]
    fn the_boundary_of_a_sheet_is_its_rim() {
        let sheet = grid(4, 3);
        let mesh = triangles(&sheet);
        let on_rim = |v: &VertexId| {
            let p = sheet.positions[v.index()];
            !((0.5..3.5).contains(&p.x) && (0.5..2.5).contains(&p.y))
        };
        let all = mesh.all(ElementKind::Vertices);
        let boundary = mesh.boundary(ElementKind::Vertices);
        assert_eq!(*boundary.vertices(), all.vertices().iter().copied().filter(on_rim).collect());
    }

    #[test]
    fn a_side_of_a_roof_ends_at_its_ridge() {
        let roof = shaped(8, 4, |x, y| DVec3::new(x, y, -(x - 4.0).abs()));
        let mesh = triangles(&roof);
        let side = mesh.up_to_sharp_edges(&vertices([20]), 60.0);
        assert_eq!(side.vertices().len(), 25);
        assert!(side.vertices().iter().all(|v| roof.positions[v.index()].x <= 4.0));
        let all = mesh.all(ElementKind::Vertices);
        assert_eq!(mesh.up_to_sharp_edges(&vertices([20]), 91.0), all);
        // A vertex of the ridge starts at the faces of both sides, three vertices at the face between them alone.
        assert_eq!(mesh.up_to_sharp_edges(&vertices([22]), 60.0), all);
        assert_eq!(mesh.up_to_sharp_edges(&ElementSet::of_vertices(roof.triangles[6]), 60.0), side);
        assert!(mesh.up_to_sharp_edges(&vertices([]), 60.0).is_empty());
        let face = mesh.single(MeshElement::Face(FaceId::new(6)));
        assert_eq!(mesh.up_to_sharp_edges(&face, 60.0).faces().len(), 32, "half of the roof");
    }

    #[test]
    fn the_faces_with_the_greatest_values_are_taken_up_to_their_share_of_the_area() {
        let sheet = grid(10, 10);
        let mesh = triangles(&sheet);
        let value = |face: usize| sheet.positions[sheet.triangles[face][0].index()].x;
        let greatest = |share| mesh.greatest(ElementKind::Vertices, value, share);
        let found = greatest(0.1);
        assert!(found.vertices().iter().all(|v| sheet.positions[v.index()].x >= 9.0) && found.vertices().len() == 22);
        assert_eq!(greatest(0.0).vertices().len(), 3, "one face at least");
        assert_eq!(greatest(1.0), mesh.all(ElementKind::Vertices));
    }

    #[test]
    fn the_element_under_a_point_of_the_plane_is_the_nearest_of_its_kind() {
        let disk = square();
        let mesh = of(&disk);
        let places: Vec<DVec2> = disk.mesh().positions.iter().map(|at| at.truncate()).collect();
        let under = |kind, x, y| mesh.element_in_plane(kind, &places, DVec2::new(x, y), 0.2);
        assert_eq!(under(ElementKind::Vertices, 1.1, 2.05), Some(MeshElement::Vertex(v(1, 2))));
        assert_eq!(under(ElementKind::Vertices, 1.5, 2.5), None);
        assert_eq!(under(ElementKind::Vertices, -0.1, 0.0), Some(MeshElement::Vertex(v(0, 0))), "beside the map");
        assert_eq!(under(ElementKind::Edges, 1.5, 2.1), Some(MeshElement::Edge(edge(v(1, 2), v(2, 2)))));
        assert_eq!(under(ElementKind::Edges, 1.5, 2.5), None, "on a diagonal");
        let face = under(ElementKind::Faces, 2.7, 3.4).map(|face| mesh.single(face));
        assert_eq!(face, Some(self::face(&mesh, 2, 3)));
        assert_eq!(under(ElementKind::Faces, 4.1, 3.4), None);
    }

    #[test]
    fn an_element_is_added_and_taken_away() {
        let disk = square();
        let mesh = of(&disk);
        for kind in [ElementKind::Vertices, ElementKind::Edges, ElementKind::Faces] {
            let all = mesh.all(kind);
            let element = match kind {
                ElementKind::Vertices => MeshElement::Vertex(v(1, 1)),
                ElementKind::Edges => MeshElement::Edge([v(2, 1), v(1, 1)]),
                ElementKind::Faces => MeshElement::Face(FaceId::new(9)),
            };
            let less = mesh.toggled(&all, element);
            assert_ne!(less, all, "{kind:?}");
            assert_eq!(mesh.toggled(&less, element), all, "{kind:?}");
            assert_eq!(mesh.toggled(&ElementSet::default(), element), mesh.single(element), "{kind:?}");
        }
    }
}
