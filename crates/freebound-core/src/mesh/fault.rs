//! Faults that keep a mesh from being a disk, each with its elements and a remedy.

use std::fmt::{self, Display};

use super::{FaceId, TriMesh, VertexId};

/// Number of elements that a message lists before it only counts the rest.
const LISTED: usize = 5;

/// Triangles, and the faces of the file that contain them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceList {
    /// Triangles, ascending unless stated otherwise.
    pub triangles: Vec<FaceId>,
    /// Faces of the file in the order of the triangles, each once.
    pub polygons: Vec<u32>,
}

impl FaceList {
    pub(super) fn new(mesh: &TriMesh, triangles: Vec<FaceId>) -> Self {
        let mut polygons: Vec<u32> = triangles.iter().map(|&f| mesh.polygon(f)).collect();
        // Triangles of one polygon are consecutive.
        polygons.dedup();
        Self { triangles, polygons }
    }
}

/// Fault of a mesh. Every fault that is not harmless keeps the mesh from being a disk.
///
/// Faces are set aside first if they name a missing vertex, name a vertex twice, or repeat an earlier face. All other
/// faults describe the mesh without these faces.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// The mesh has no faces.
    NoFaces,
    /// Faces name vertices that do not exist.
    MissingVertices(FaceList),
    /// Positions are infinite or not numbers.
    NotFinite(Vec<VertexId>),
    /// Faces name a vertex twice.
    RepeatedVertices(FaceList),
    /// Faces have the three vertices of an earlier face.
    DuplicateFaces(FaceList),
    /// No face uses these vertices.
    UnreferencedVertices(Vec<VertexId>),
    /// Faces without area: their corners lie on one line up to the rounding of their coordinates. With `M` the largest
    /// absolute coordinate, the height over the longest edge is at most 4 ε M.
    ZeroArea(FaceList),
    /// Edges with three or more faces.
    NonManifoldEdges(Vec<[VertexId; 2]>),
    /// Vertices whose faces form more than one fan.
    NonManifoldVertices(Vec<VertexId>),
    /// Some faces have the opposite orientation; flipping them repairs the mesh.
    MixedOrientation {
        /// Edges that two faces traverse in one direction.
        edges: Vec<[VertexId; 2]>,
        /// Faces to flip.
        faces: FaceList,
    },
    /// The surface has one side only, like a Möbius strip. Lists the edges whose faces clash.
    NonOrientable(Vec<[VertexId; 2]>),
    /// Vertices of different components coincide: the components touch without being connected.
    CoincidentVertices(Vec<VertexId>),
    /// The faces are not connected across edges.
    SeveralComponents {
        /// The first face of each component.
        first_faces: FaceList,
        /// Number of triangles of each component.
        sizes: Vec<usize>,
    },
    /// Components without a boundary.
    Closed {
        /// First face of each closed component.
        first_faces: FaceList,
        /// Number of components of the mesh, closed or not.
        component_count: usize,
    },
    /// Components with more than one boundary loop. Lists their loops, the longest first.
    SeveralBoundaryLoops(Vec<Vec<VertexId>>),
    /// Components with handles.
    Handles {
        /// Number of handles in all.
        genus: usize,
        /// First face of each component with handles.
        first_faces: FaceList,
    },
}

/// The elements of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elements<'a> {
    /// The fault concerns the mesh as a whole.
    Nothing,
    /// Vertices.
    Vertices(&'a [VertexId]),
    /// Edges, by their two vertices.
    Edges(&'a [[VertexId; 2]]),
    /// Faces.
    Faces(&'a FaceList),
    /// Boundary loops, by their vertices.
    Loops(&'a [Vec<VertexId>]),
}

impl Elements<'_> {
    /// Number of elements; faces are counted as faces of the file.
    pub fn count(&self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::Vertices(v) => v.len(),
            Self::Edges(e) => e.len(),
            Self::Faces(f) => f.polygons.len(),
            Self::Loops(l) => l.len(),
        }
    }
}

impl Fault {
    /// True if the fault has elements or concerns the whole mesh. The diagnosis keeps no other faults.
    pub(super) fn is_present(&self) -> bool {
        match self.elements() {
            Elements::Nothing => true,
            Elements::Faces(faces) => !faces.triangles.is_empty(),
            elements => elements.count() > 0,
        }
    }

    /// True if the mesh can be flattened with this fault. Degenerate faces and unreferenced vertices do not change the
    /// surface.
    pub const fn is_harmless(&self) -> bool {
        matches!(self, Self::ZeroArea(_) | Self::UnreferencedVertices(_))
    }

    /// True if cutting the surface open repairs the fault.
    pub const fn is_cut_open(&self) -> bool {
        matches!(
            self,
            Self::Closed { .. } | Self::SeveralBoundaryLoops(_) | Self::Handles { .. } | Self::NonOrientable(_)
        )
    }

    /// True if the fault does not matter when each part of the surface is flattened by itself.
    pub const fn is_of_charts(&self) -> bool {
        matches!(self, Self::SeveralComponents { .. } | Self::CoincidentVertices(_))
    }

    /// A fixed lower-case name, for reports and tests.
    pub const fn name(&self) -> &'static str {
        self.words()[0]
    }

    /// Recommended action, in the imperative.
    pub const fn remedy(&self) -> &'static str {
        self.words()[1]
    }

    /// Name and remedy.
    const fn words(&self) -> [&'static str; 2] {
        match self {
            Self::NoFaces => ["no-faces", "export the surface with its faces"],
            Self::MissingVertices(_) => {
                ["missing-vertices", "export the file again: it is cut short or its indices are wrong"]
            }
            Self::NotFinite(_) => {
                ["not-finite", "give these vertices finite positions, or delete them with their faces"]
            }
            Self::RepeatedVertices(_) => ["repeated-vertices", "delete these faces"],
            Self::DuplicateFaces(_) => ["duplicate-faces", "delete these faces and keep the first of each"],
            Self::UnreferencedVertices(_) => ["unreferenced-vertices", "delete these vertices"],
            Self::ZeroArea(_) => {
                ["zero-area", "merge coincident vertices, or collapse the shortest edge of each of these faces"]
            }
            Self::NonManifoldEdges(_) => {
                ["non-manifold-edges", "delete or detach faces until each of these edges has two"]
            }
            Self::NonManifoldVertices(_) => {
                ["non-manifold-vertices", "split each of these vertices into one per fan of faces"]
            }
            Self::MixedOrientation { .. } => ["mixed-orientation", "turn these faces over"],
            Self::NonOrientable(_) => {
                ["non-orientable", "cut the surface along a chain of edges so that it has two sides"]
            }
            Self::CoincidentVertices(_) => {
                ["coincident-vertices", "merge coincident vertices if the components are meant to be one surface"]
            }
            Self::SeveralComponents { .. } => {
                ["several-components", "make each component a disk; each is flattened separately"]
            }
            Self::Closed { .. } => {
                ["closed", "cut the surface open along a chain of edges, or delete a part that is not needed"]
            }
            Self::SeveralBoundaryLoops(_) => {
                ["several-boundary-loops", "fill the holes, or cut the surface from one loop to another"]
            }
            Self::Handles { .. } => ["handles", "cut each handle open, and join the cuts to the boundary"],
        }
    }

    /// Elements of the fault.
    pub fn elements(&self) -> Elements<'_> {
        match self {
            Self::NoFaces => Elements::Nothing,
            Self::NotFinite(v)
            | Self::UnreferencedVertices(v)
            | Self::NonManifoldVertices(v)
            | Self::CoincidentVertices(v) => Elements::Vertices(v),
            Self::NonManifoldEdges(e) | Self::NonOrientable(e) => Elements::Edges(e),
            Self::MissingVertices(f)
            | Self::RepeatedVertices(f)
            | Self::DuplicateFaces(f)
            | Self::ZeroArea(f)
            | Self::Closed { first_faces: f, .. }
            | Self::MixedOrientation { faces: f, .. }
            | Self::SeveralComponents { first_faces: f, .. }
            | Self::Handles { first_faces: f, .. } => Elements::Faces(f),
            Self::SeveralBoundaryLoops(loops) => Elements::Loops(loops),
        }
    }

    /// Vertices of an element of the fault in `mesh`; empty if there is no such element.
    pub fn vertices_of(&self, element: usize, mesh: &TriMesh) -> Vec<VertexId> {
        let found = match self.elements() {
            Elements::Nothing => None,
            Elements::Vertices(vertices) => vertices.get(element).map(|&vertex| vec![vertex]),
            Elements::Edges(edges) => edges.get(element).map(|edge| edge.to_vec()),
            Elements::Faces(faces) => {
                let polygon = faces.polygons.get(element);
                let face = faces.triangles.iter().find(|&&face| Some(&mesh.polygon(face)) == polygon);
                face.map(|face| mesh.triangles[face.index()].to_vec())
            }
            Elements::Loops(loops) => loops.get(element).cloned(),
        };
        found.unwrap_or_default()
    }

    /// Description of the fault: its kind, its count and the first few elements, numbered from 0 in file order.
    pub fn message(&self) -> String {
        match self {
            Self::NoFaces => "the mesh has no faces".to_owned(),
            Self::MissingVertices(f) => faces("name a vertex that does not exist", "names", f),
            Self::NotFinite(v) => vertices("a position that is infinite or not a number", v),
            Self::RepeatedVertices(f) => faces("name a vertex twice", "names", f),
            Self::DuplicateFaces(f) => faces("have the same vertices as an earlier face", "has", f),
            Self::UnreferencedVertices(v) => vertices("no face", v),
            Self::ZeroArea(f) => faces("have no area", "has", f),
            Self::NonManifoldEdges(e) => edges("three or more faces", e),
            Self::NonManifoldVertices(v) => vertices("more than one fan of faces", v),
            Self::MixedOrientation { edges: e, faces: f } => format!(
                "{}; faces to turn over, the minority: {}",
                edges("two faces of opposite orientation", e),
                listed(&f.polygons)
            ),
            Self::NonOrientable(e) => {
                format!("the surface has only one side: {}", edges("two faces of opposite orientation", e))
            }
            Self::CoincidentVertices(v) => vertices("the position of a vertex of another component", v),
            Self::SeveralComponents { first_faces, sizes } => format!(
                "{} components (triangles in each: {}), with first faces {}",
                sizes.len(),
                listed(sizes),
                listed(&first_faces.polygons)
            ),
            Self::Closed { component_count: 1, .. } => "the surface is closed: it has no boundary".to_owned(),
            Self::Closed { first_faces: f, component_count } => {
                let count = f.triangles.len();
                format!("{count} of {component_count} components are closed: those of faces {}", listed(&f.polygons))
            }
            Self::SeveralBoundaryLoops(loops) => {
                let sizes: Vec<usize> = loops.iter().map(Vec::len).collect();
                let starts: Vec<VertexId> = loops.iter().map(|l| l[0]).collect();
                format!(
                    "{} boundary loops (edges in each: {}), at vertices {}",
                    loops.len(),
                    listed(&sizes),
                    listed(&numbers(&starts))
                )
            }
            Self::Handles { genus, first_faces } => format!(
                "{genus} {}, on the component of face {}",
                if *genus == 1 { "handle" } else { "handles" },
                listed(&first_faces.polygons)
            ),
        }
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.name(), self.message(), self.remedy())
    }
}

fn numbers(vertices: &[VertexId]) -> Vec<u32> {
    vertices.iter().map(|v| v.number()).collect()
}

/// Formats a list, such as "3, 4 and 17 more".
fn listed<T: Display>(items: &[T]) -> String {
    listed_of(items, items.len())
}

/// Formats a list of `count` items, of which `items` holds at least those that are shown.
fn listed_of<T: Display>(items: &[T], count: usize) -> String {
    let shown: Vec<String> = items.iter().take(LISTED).map(T::to_string).collect();
    let more = count - shown.len();
    if more > 0 { format!("{} and {more} more", shown.join(", ")) } else { shown.join(", ") }
}

fn faces(many: &str, one: &str, list: &FaceList) -> String {
    let words = match list.polygons.len() {
        1 => format!("1 face {one} {}", many.split_once(' ').map_or(many, |(_, rest)| rest)),
        count => format!("{count} faces {many}"),
    };
    format!("{words}: {}", listed(&list.polygons))
}

fn vertices(what: &str, list: &[VertexId]) -> String {
    let noun = if list.len() == 1 { "vertex has" } else { "vertices have" };
    format!("{} {noun} {what}: {}", list.len(), listed(&numbers(list)))
}

fn edges(what: &str, list: &[[VertexId; 2]]) -> String {
    let noun = if list.len() == 1 { "edge has" } else { "edges have" };
    let ends: Vec<String> = list.iter().take(LISTED).map(|[a, b]| format!("{}-{}", a.number(), b.number())).collect();
    format!("{} {noun} {what}: {}", list.len(), listed_of(&ends, list.len()))
}
