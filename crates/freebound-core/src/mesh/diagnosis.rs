//! Diagnosis of a mesh: is it a disk, and if not, which faults does it have?
//!
//! A disk is a connected, consistently oriented 2-manifold with one boundary loop and no handles. All its positions
//! are finite. [`diagnose`] lists every fault of a mesh at once. Only a mesh whose faults are all harmless becomes a
//! [`DiskMesh`].
//!
//! Limits: handles are counted only if no edge has three or more faces and the surface has two sides. Otherwise the
//! genus is undefined.

use std::fmt;

use glam::DVec2;

use crate::parallel::prelude::*;

use super::area::is_zero_area;
use super::coincident::coincident_vertices;
use super::edges::{EdgeTable, side_ends};
use super::fault::{FaceList, Fault};
use super::measure::{Measure, least_mollification};
use super::orientation::Orientation;
use super::scale::take_unit;
use super::topology::Topology;
use super::{DiskMesh, FaceId, TriMesh, VertexId};

/// Minimum number of faces per task in the area test.
const FACES_PER_TASK: usize = 4096;

/// Result of the diagnosis of a mesh: faults and counts.
///
/// Counts of edges, loops and components leave out the faces that are set aside: see [`Fault`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Diagnosis {
    /// Everything that keeps the mesh from being a disk, and harmless faults.
    pub faults: Vec<Fault>,
    /// Interior edges between two boundary vertices: no fault, but the theorems on planarity do not cover them.
    pub dividing_edges: Vec<[VertexId; 2]>,
    /// Triangles with two or three boundary edges: no fault, but the theorems on planarity do not cover them.
    pub ears: Vec<FaceId>,
    /// Number of vertices, referenced or not.
    pub vertex_count: usize,
    /// Number of triangles.
    pub face_count: usize,
    /// Number of undirected edges.
    pub edge_count: usize,
    /// Number of edges with one face.
    pub boundary_edge_count: usize,
    /// Number of closed chains of boundary edges.
    pub boundary_loop_count: usize,
    /// Number of components, connected across edges.
    pub component_count: usize,
    /// Euler characteristic: referenced vertices − edges + triangles.
    pub euler: i64,
    /// Number of handles of all components; `None` if undefined.
    pub genus: Option<usize>,
}

impl Diagnosis {
    /// True if the mesh is a disk: every fault is harmless.
    pub fn is_disk(&self) -> bool {
        self.faults.iter().all(Fault::is_harmless)
    }

    fn add(&mut self, fault: Fault) {
        if fault.is_present() {
            self.faults.push(fault);
        }
    }
}

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.faults.is_empty() {
            return write!(f, "the mesh is a disk");
        }
        let faults: Vec<String> = self.faults.iter().map(Fault::to_string).collect();
        f.write_str(&faults.join("\n"))
    }
}

impl std::error::Error for Diagnosis {}

/// Lists all faults of a mesh.
pub fn diagnose(mesh: &TriMesh) -> Diagnosis {
    examine(mesh).0
}

impl TriMesh {
    /// Removes faces that name a vertex twice or repeat an earlier face. The remaining faces keep their numbers in the
    /// file.
    #[must_use]
    pub fn without_repeats(self) -> Self {
        let diagnosis = diagnose(&self);
        let repeats = diagnosis.faults.iter().filter_map(|fault| match fault {
            Fault::RepeatedVertices(faces) | Fault::DuplicateFaces(faces) => Some(&faces.triangles),
            _ => None,
        });
        let mut stays = vec![true; self.face_count()];
        repeats.flatten().for_each(|face| stays[face.index()] = false);
        if stays.iter().all(|&stays| stays) {
            return self;
        }
        self.with_faces(&stays)
    }

    /// Removes triangles with two corners at exactly one point, both in space and at these places in the plane. Such
    /// triangles arise if a polygon names a point twice by different vertices. They have no area in space or in the
    /// plane. The remaining faces keep their numbers in the file.
    #[must_use]
    pub fn without_collapsed(self, places: &[DVec2]) -> Self {
        let is_one_place = |a: VertexId, b: VertexId| {
            self.positions[a.index()] == self.positions[b.index()] && places[a.index()] == places[b.index()]
        };
        let stays: Vec<bool> = self
            .triangles
            .iter()
            .map(|&[a, b, c]| ![[a, b], [b, c], [c, a]].iter().any(|&[p, q]| is_one_place(p, q)))
            .collect();
        self.with_faces(&stays)
    }

    /// Keeps the triangles for which `stays` is true.
    pub(crate) fn with_faces(self, stays: &[bool]) -> Self {
        let kept = || (0..self.face_count()).filter(|&face| stays[face]).map(FaceId::from_index);
        let polygon_of = Some(kept().map(|face| self.polygon(face)).collect());
        let triangles = kept().map(|face| self.triangles[face.index()]).collect();
        Self { triangles, polygon_of, ..self }
    }
}

impl TryFrom<TriMesh> for DiskMesh {
    type Error = Box<Diagnosis>;

    /// Builds a disk from a mesh. Lengths are mollified if faces have no area.
    ///
    /// # Errors
    ///
    /// The diagnosis, if the mesh has faults that are not harmless.
    fn try_from(mesh: TriMesh) -> Result<Self, Self::Error> {
        Self::measured(mesh, |mesh| take_unit(&mut mesh.positions), true)
    }
}

impl DiskMesh {
    /// Builds a disk from a mesh with its positions unchanged. Degenerate faces keep zero area, and the unit is 1.
    ///
    /// # Errors
    ///
    /// The diagnosis, if the mesh has faults that are not harmless.
    pub fn of_topology(mesh: TriMesh) -> Result<Self, Box<Diagnosis>> {
        Self::measured(mesh, |_| 1.0, false)
    }

    /// Builds a disk in the unit that `take_unit` returns. Mollifies lengths if `mollifies` is set and faces have no
    /// area.
    fn measured(
        mut mesh: TriMesh,
        take_unit: impl FnOnce(&mut TriMesh) -> f64,
        mollifies: bool,
    ) -> Result<Self, Box<Diagnosis>> {
        match examine(&mesh) {
            (diagnosis, Some(table)) if diagnosis.is_disk() => {
                let has_no_area = diagnosis.faults.iter().any(|fault| matches!(fault, Fault::ZeroArea(_)));
                gather_unused(&mut mesh, &diagnosis);
                let unit = take_unit(&mut mesh);
                let mollification = if mollifies && has_no_area { least_mollification(&mesh) } else { 0.0 };
                let disk = Self::join(mesh, &table, diagnosis.dividing_edges, diagnosis.ears);
                Ok(disk.measured_by(Measure { unit, mollification }))
            }
            (diagnosis, _) => Err(Box::new(diagnosis)),
        }
    }
}

/// Moves unreferenced vertices to a vertex of the first face, so that they do not affect the size of the mesh.
fn gather_unused(mesh: &mut TriMesh, diagnosis: &Diagnosis) {
    let first = mesh.positions[mesh.triangles[0][0].index()];
    let lists = diagnosis.faults.iter().filter_map(|fault| match fault {
        Fault::UnreferencedVertices(vertices) => Some(vertices),
        _ => None,
    });
    lists.flatten().for_each(|vertex| mesh.positions[vertex.index()] = first);
}

/// Returns the diagnosis, and the edge table of the whole mesh if no face was set aside.
fn examine(mesh: &TriMesh) -> (Diagnosis, Option<EdgeTable>) {
    let mut diagnosis =
        Diagnosis { vertex_count: mesh.vertex_count(), face_count: mesh.face_count(), ..Diagnosis::default() };
    diagnosis.add(not_finite(mesh));
    if mesh.triangles.is_empty() {
        diagnosis.add(Fault::NoFaces);
        diagnosis.genus = Some(0);
        return (diagnosis, None);
    }
    let (missing, repeated) = unsound_faces(mesh);
    let mut sound = Sound::without(mesh, missing.iter().chain(&repeated));
    let mut table = EdgeTable::new(mesh.vertex_count(), sound.triangles(mesh));
    let duplicates = sound.duplicates(mesh, &table);
    if !duplicates.is_empty() {
        sound = Sound::without(mesh, missing.iter().chain(&repeated).chain(&duplicates));
        table = EdgeTable::new(mesh.vertex_count(), sound.triangles(mesh));
    }
    diagnosis.add(Fault::MissingVertices(FaceList::new(mesh, missing.clone())));
    diagnosis.add(Fault::RepeatedVertices(FaceList::new(mesh, repeated)));
    diagnosis.add(Fault::DuplicateFaces(FaceList::new(mesh, duplicates)));
    let (zero_area, topology) = crate::parallel::join(
        || zero_area_faces(mesh, &sound),
        || Topology::explore(table, mesh.vertex_count(), sound.triangles(mesh)),
    );
    diagnosis.add(Fault::ZeroArea(zero_area));
    describe(&mut diagnosis, mesh, &sound, &topology);
    let table = sound.kept.is_none().then_some(topology.table);
    (diagnosis, table)
}

fn not_finite(mesh: &TriMesh) -> Fault {
    let finite = |v: &VertexId| mesh.positions[v.index()].is_finite();
    Fault::NotFinite((0..mesh.vertex_count()).map(VertexId::from_index).filter(|v| !finite(v)).collect())
}

/// Faces with a corner beyond the last vertex, and faces that name a vertex twice.
fn unsound_faces(mesh: &TriMesh) -> (Vec<FaceId>, Vec<FaceId>) {
    let (mut missing, mut repeated) = (Vec::new(), Vec::new());
    for (f, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        if a.max(b).max(c).index() >= mesh.vertex_count() {
            missing.push(FaceId::from_index(f));
        } else if a == b || b == c || c == a {
            repeated.push(FaceId::from_index(f));
        }
    }
    (missing, repeated)
}

/// Faces that remain for the topology after unsound faces are set aside.
struct Sound {
    /// Remaining triangles and their indices in the mesh; `None` if all faces remain.
    kept: Option<(Vec<[VertexId; 3]>, Vec<FaceId>)>,
}

impl Sound {
    fn without<'a>(mesh: &TriMesh, faces: impl Iterator<Item = &'a FaceId> + Clone) -> Self {
        if faces.clone().next().is_none() {
            return Self { kept: None };
        }
        let mut keep = vec![true; mesh.face_count()];
        faces.for_each(|f| keep[f.index()] = false);
        let faces: Vec<FaceId> = (0..mesh.face_count()).filter(|&f| keep[f]).map(FaceId::from_index).collect();
        Self { kept: Some((faces.iter().map(|f| mesh.triangles[f.index()]).collect(), faces)) }
    }

    fn triangles<'a>(&'a self, mesh: &'a TriMesh) -> &'a [[VertexId; 3]] {
        self.kept.as_ref().map_or(&mesh.triangles, |(triangles, _)| triangles)
    }

    /// Index in the mesh of a remaining triangle.
    fn face(&self, kept: usize) -> FaceId {
        self.kept.as_ref().map_or_else(|| FaceId::from_index(kept), |(_, faces)| faces[kept])
    }

    /// Faces with the three vertices of an earlier face. The edge table shows whether a search is needed at all.
    fn duplicates(&self, mesh: &TriMesh, table: &EdgeTable) -> Vec<FaceId> {
        let triangles = self.triangles(mesh);
        let far = |side: u32| triangles[side as usize / 3][(side as usize + 2) % 3];
        let suspect = |sides: &[u32]| match *sides {
            [_] => false,
            [a, b] => far(a) == far(b),
            _ => true,
        };
        if !table.edges().any(suspect) {
            return Vec::new();
        }
        let mut sorted: Vec<([VertexId; 3], FaceId)> =
            triangles.iter().enumerate().map(|(f, &corners)| (ascending(corners), self.face(f))).collect();
        sorted.sort_unstable();
        let repeats = sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        let mut faces: Vec<FaceId> = repeats.map(|pair| pair[1].1).collect();
        faces.sort_unstable();
        faces
    }
}

fn ascending(mut corners: [VertexId; 3]) -> [VertexId; 3] {
    corners.sort_unstable();
    corners
}

fn zero_area_faces(mesh: &TriMesh, sound: &Sound) -> FaceList {
    let flat = |&f: &FaceId| {
        let corners = mesh.corners(f);
        corners.iter().all(|p| p.is_finite()) && is_zero_area(corners)
    };
    let faces = (0..sound.triangles(mesh).len()).into_par_iter().with_min_len(FACES_PER_TASK);
    FaceList::new(mesh, faces.map(|f| sound.face(f)).filter(flat).collect())
}

fn describe(diagnosis: &mut Diagnosis, mesh: &TriMesh, sound: &Sound, topology: &Topology) {
    let triangles = sound.triangles(mesh);
    let in_mesh = |faces: Vec<FaceId>| FaceList::new(mesh, faces.iter().map(|f| sound.face(f.index())).collect());
    let orientation = Orientation::inspect(topology, triangles);
    diagnosis.add(Fault::UnreferencedVertices(topology.unreferenced.clone()));
    diagnosis.add(Fault::NonManifoldEdges(topology.crowded_edges.clone()));
    diagnosis.add(Fault::NonManifoldVertices(topology.split_vertices.clone()));
    let two_sided = orientation.one_sided_edges.is_empty();
    diagnosis.add(Fault::MixedOrientation { edges: orientation.mixed_edges, faces: in_mesh(orientation.turn) });
    diagnosis.add(Fault::NonOrientable(orientation.one_sided_edges));

    let components = &topology.components;
    let first_faces = |wanted: &dyn Fn(usize) -> bool| {
        let chosen = components.iter().enumerate().filter(|&(c, _)| wanted(c));
        in_mesh(chosen.map(|(_, component)| component.first_face).collect())
    };
    if components.len() > 1 {
        let sizes = components.iter().map(|component| component.faces).collect();
        diagnosis.add(Fault::CoincidentVertices(coincident_vertices(mesh, triangles)));
        diagnosis.add(Fault::SeveralComponents { first_faces: first_faces(&|_| true), sizes });
    }
    diagnosis.add(Fault::Closed {
        first_faces: first_faces(&|c| components[c].loops == 0),
        component_count: components.len(),
    });
    let mut loops: Vec<Vec<VertexId>> = topology
        .loops
        .iter()
        .filter(|boundary_loop| components[boundary_loop.component].loops > 1)
        .map(|boundary_loop| boundary_loop.vertices.clone())
        .collect();
    loops.sort_by_key(|vertices| std::cmp::Reverse(vertices.len()));
    diagnosis.add(Fault::SeveralBoundaryLoops(loops));
    if two_sided && topology.crowded_edges.is_empty() {
        let genus = components.iter().map(super::topology::Component::genus).sum();
        diagnosis.add(Fault::Handles { genus, first_faces: first_faces(&|c| components[c].genus() > 0) });
        diagnosis.genus = Some(genus);
    }
    count(diagnosis, triangles, topology);
    diagnosis.ears = ears(topology).into_iter().map(|f| sound.face(f)).collect();
    diagnosis.dividing_edges = dividing_edges(mesh.vertex_count(), triangles, topology);
}

fn count(diagnosis: &mut Diagnosis, triangles: &[[VertexId; 3]], topology: &Topology) {
    let signed = |count: usize| i64::try_from(count).expect("counts are far below 2^63");
    diagnosis.edge_count = topology.table.edge_count();
    diagnosis.boundary_edge_count = topology.boundary.len();
    diagnosis.boundary_loop_count = topology.loops.len();
    diagnosis.component_count = topology.components.len();
    diagnosis.euler = signed(topology.referenced_count) - signed(diagnosis.edge_count) + signed(triangles.len());
}

/// Triangles with two or three boundary sides.
fn ears(topology: &Topology) -> Vec<usize> {
    let mut faces: Vec<u32> = topology.boundary.iter().map(|side| side / 3).collect();
    faces.sort_unstable();
    let mut ears: Vec<usize> = faces.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0] as usize).collect();
    ears.dedup();
    ears
}

/// Edges with two faces whose ends are both boundary vertices.
fn dividing_edges(vertex_count: usize, triangles: &[[VertexId; 3]], topology: &Topology) -> Vec<[VertexId; 2]> {
    let mut on_boundary = vec![false; vertex_count];
    for &side in &topology.boundary {
        let (tail, head) = side_ends(triangles, side);
        on_boundary[tail.index()] = true;
        on_boundary[head.index()] = true;
    }
    let ends = topology.table.edges().filter(|sides| sides.len() == 2).map(|sides| side_ends(triangles, sides[0]));
    let divides = |&(tail, head): &(VertexId, VertexId)| on_boundary[tail.index()] && on_boundary[head.index()];
    ends.filter(divides).map(|(tail, head)| [tail.min(head), tail.max(head)]).collect()
}
