//! Mesh of a file with new vertices, or with polygons split into triangles; everything else is unchanged.

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

use super::{MeshFile, NO_TEXTURE, Statement, Texture};
use freebound_core::mesh::{DiskMesh, FaceId, NewVertex, PolygonMesh, Refinement, Repaired, VertexId};
use freebound_core::problem::Embedding;

/// Mesh of a file with the new vertices of its refinements.
#[derive(Debug)]
pub struct Refined {
    /// Refined mesh. Vertices of the file keep their numbers; new ones follow. Polygons that are whole in a
    /// refinement stay unchanged; any other is replaced by its triangles, in place. Statements stay before their
    /// faces. Texture coordinates are dropped: they belong to the unrefined mesh.
    pub mesh: MeshFile,
    /// Vertex of each corner in the concatenated list of the charts' vertices, or [`NO_TEXTURE`].
    corners: Vec<u32>,
    /// Face of the file that each face equals or is a part of.
    pub(crate) face_of: Vec<u32>,
    /// New vertices, on edges of the file. Their numbers follow those of the file's vertices.
    pub(crate) new_vertices: Vec<NewVertex>,
}

/// Chart of a mesh, refined or unchanged.
#[derive(Clone, Copy, Debug)]
pub struct RefinedChart<'a> {
    /// Mesh of the coordinates: that of the refinement, if there is one.
    pub mesh: &'a DiskMesh,
    /// Refinement, if there is one.
    pub refinement: Option<&'a Refinement>,
    /// Vertex of the repaired mesh for each vertex of the chart; `None` if the numbers are equal.
    pub vertex_of: Option<&'a [VertexId]>,
}

impl Refined {
    /// Mesh of the file `source`, from a refinement of it or of its repaired mesh.
    pub fn new(source: &MeshFile, repaired: Option<&Repaired>, refinement: &Refinement) -> Self {
        let only = RefinedChart { mesh: refinement.disk(), refinement: Some(refinement), vertex_of: None };
        Self::of_charts(source, repaired, &[only])
    }

    /// Mesh of the file `source`, from the charts of it or of its repaired mesh.
    pub fn of_charts(source: &MeshFile, repaired: Option<&Repaired>, charts: &[RefinedChart<'_>]) -> Self {
        let old = Old::of(&source.polygons, repaired, charts);
        let cuts = cuts(&source.polygons, charts);
        let new = New::of(&old, charts, &cuts);
        let mut faces = Faces { starts: vec![0], ..Faces::default() };
        let mut first_face = Vec::with_capacity(source.polygons.face_count());
        for (number, polygon) in (0..).zip(0..source.polygons.face_count()) {
            first_face.push(faces.count());
            let Some(cut) = cuts.get(&number) else {
                let range = source.polygons.corner_range(polygon);
                faces.push(range.map(|corner| (source.polygons.corners[corner], old.slot(corner))), number);
                continue;
            };
            for face in cut.faces() {
                let corner = |vertex: VertexId| {
                    let edge = old.edge_of_new(polygon, charts, cut.chart, vertex);
                    let vertex_in_file = match edge {
                        Some(new_vertex) => new.number_of[&key(cut.chart, vertex, &new_vertex)],
                        None => old.vertex_in(polygon, Old::whole(charts, cut.chart, vertex)),
                    };
                    (vertex_in_file, old.first[cut.chart] + vertex.number())
                };
                faces.push(charts[cut.chart].mesh.face(face).map(corner).into_iter(), number);
            }
        }
        let moved = |statement: &Statement| {
            let before_face = first_face.get(statement.before_face as usize).copied().unwrap_or(faces.count());
            Statement { before_face, text: statement.text.clone() }
        };
        let statements = source.statements.iter().map(moved).collect();
        let changed = source.source.as_ref().map(|file| file.changed(&faces.face_of, &new.vertices));
        let positions = [&source.polygons.positions[..], &new.positions].concat();
        let are_triangles = faces.starts.windows(2).all(|bounds| bounds[1] - bounds[0] == 3);
        let starts = (!are_triangles).then_some(faces.starts);
        let polygons = PolygonMesh { positions, corners: faces.corners, starts };
        Self {
            mesh: MeshFile { polygons, statements, source: changed, ..MeshFile::default() },
            corners: faces.slots,
            face_of: faces.face_of,
            new_vertices: new.vertices,
        }
    }

    /// Assigns coordinates of the charts' vertices, one each, to the corners of the mesh. Coordinates of no corner
    /// are dropped.
    pub fn texture(&self, coordinates: &Embedding) -> Texture {
        let mut number_of = vec![NO_TEXTURE; coordinates.len()];
        let used = || self.corners.iter().filter(|&&slot| slot != NO_TEXTURE);
        used().for_each(|&slot| number_of[slot as usize] = 0);
        let mut kept = Vec::with_capacity(coordinates.len());
        for (number, &coordinate) in number_of.iter_mut().zip(coordinates).filter(|(number, _)| **number == 0) {
            *number = VertexId::from_index(kept.len()).number();
            kept.push(coordinate);
        }
        let corners = self.corners.iter().map(|&slot| number_of.get(slot as usize).copied().unwrap_or(NO_TEXTURE));
        Texture { corners: corners.collect(), coordinates: kept }
    }
}

/// Polygon of the file that is written as triangles.
struct Cut {
    chart: usize,
    /// Numbers of its triangles in the chart.
    triangles: Range<usize>,
}

impl Cut {
    fn faces(&self) -> impl Iterator<Item = FaceId> + use<> {
        self.triangles.clone().map(FaceId::from_index)
    }
}

/// Polygons of the file that are split, by number: those with new vertices, and those that a refinement has only as
/// triangles. Faces with numbers beyond the file's belong to hole fillings and are skipped.
fn cuts(file: &PolygonMesh, charts: &[RefinedChart<'_>]) -> BTreeMap<u32, Cut> {
    let mut cuts = BTreeMap::new();
    for (chart, RefinedChart { mesh, refinement, .. }) in charts.iter().enumerate() {
        let Some(old_count) = refinement.map(Refinement::old_vertex_count) else { continue };
        let whole: HashSet<u32> = mesh.polygons().map(|whole| mesh.mesh().polygon(whole.first_face)).collect();
        let numbers: Vec<u32> = mesh.faces().map(|face| mesh.mesh().polygon(face)).collect();
        let mut begin = 0;
        for run in numbers.chunk_by(|a, b| a == b) {
            let (number, triangles) = (run[0], begin..begin + run.len());
            begin = triangles.end;
            let mut corners = triangles.clone().flat_map(|face| mesh.face(FaceId::from_index(face)));
            let is_whole = run.len() == 1 || whole.contains(&number);
            if (number as usize) < file.face_count() && !(is_whole && corners.all(|v| v.index() < old_count)) {
                cuts.insert(number, Cut { chart, triangles });
            }
        }
    }
    cuts
}

/// Corners of the file, with their vertices in the charts.
struct Old<'a> {
    file: &'a PolygonMesh,
    /// Vertex of the repaired mesh at each corner, if the mesh was repaired.
    repaired: Option<Vec<Option<VertexId>>>,
    /// Index of the first vertex of each chart in the concatenated list.
    first: Vec<u32>,
    /// Index of each vertex of the repaired mesh in the concatenated list, or [`NO_TEXTURE`].
    slot_of: Vec<u32>,
}

impl<'a> Old<'a> {
    fn of(file: &'a PolygonMesh, repaired: Option<&Repaired>, charts: &[RefinedChart<'_>]) -> Self {
        let count = repaired.map_or(file, Repaired::polygons).positions.len();
        let mut slot_of = vec![NO_TEXTURE; count];
        let (mut first, mut end) = (Vec::new(), 0);
        for chart in charts {
            first.push(end);
            match chart.vertex_of {
                Some(vertex_of) => (end..).zip(vertex_of).for_each(|(slot, vertex)| slot_of[vertex.index()] = slot),
                None => (end..).zip(&mut slot_of).for_each(|(slot, of)| *of = slot),
            }
            end += u32::try_from(chart.mesh.vertex_count()).expect("a mesh has fewer than 2^32 vertices");
        }
        Self { file, repaired: repaired.map(|repaired| repaired.vertices_at_corners(file)), first, slot_of }
    }

    /// Vertex of the repaired mesh at a corner of the file.
    fn at(&self, corner: usize) -> Option<VertexId> {
        self.repaired.as_ref().map_or(Some(self.file.corners[corner]), |vertices| vertices[corner])
    }

    /// Index of a corner's vertex in the concatenated list of the charts' vertices.
    fn slot(&self, corner: usize) -> u32 {
        self.at(corner).map_or(NO_TEXTURE, |vertex| self.slot_of[vertex.index()])
    }

    /// Vertex of the repaired mesh for a vertex of a chart that is not new.
    fn whole(charts: &[RefinedChart<'_>], chart: usize, vertex: VertexId) -> VertexId {
        charts[chart].vertex_of.map_or(vertex, |vertex_of| vertex_of[vertex.index()])
    }

    /// Edge of the file that a new vertex of a chart lies on, with the ends that a polygon has; `None` for an old
    /// vertex.
    fn edge_of_new(
        &self,
        polygon: usize,
        charts: &[RefinedChart<'_>],
        chart: usize,
        vertex: VertexId,
    ) -> Option<NewVertex> {
        let refinement = charts[chart].refinement?;
        let NewVertex { edge, at } =
            refinement.new_vertices()[vertex.index().checked_sub(refinement.old_vertex_count())?];
        let edge = edge.map(|end| self.vertex_in(polygon, Self::whole(charts, chart, end)));
        Some(NewVertex { edge, at })
    }

    /// Vertex of the file at the corner of a polygon that has this vertex in the repaired mesh.
    fn vertex_in(&self, polygon: usize, vertex: VertexId) -> VertexId {
        let mut corners = self.file.corner_range(polygon);
        let corner = corners.find(|&corner| self.at(corner) == Some(vertex)).expect("a corner of this polygon");
        self.file.corners[corner]
    }
}

/// Identity of a new vertex: its chart, its number in the chart, and the ends of its edge in the file. If vertices
/// were joined, the faces at an edge may have different ends in the file: each face then has its own new vertex.
type Key = (usize, VertexId, [VertexId; 2]);

fn key(chart: usize, vertex: VertexId, NewVertex { edge: [a, b], .. }: &NewVertex) -> Key {
    (chart, vertex, [*a.min(b), *a.max(b)])
}

/// New vertices, as numbered in the output: those of the first chart come first.
struct New {
    number_of: BTreeMap<Key, VertexId>,
    vertices: Vec<NewVertex>,
    positions: Vec<glam::DVec3>,
}

impl New {
    fn of(old: &Old<'_>, charts: &[RefinedChart<'_>], cuts: &BTreeMap<u32, Cut>) -> Self {
        let mut found: BTreeMap<Key, NewVertex> = BTreeMap::new();
        for (&polygon, cut) in cuts {
            for vertex in cut.faces().flat_map(|face| charts[cut.chart].mesh.face(face)) {
                if let Some(new) = old.edge_of_new(polygon as usize, charts, cut.chart, vertex) {
                    found.entry(key(cut.chart, vertex, &new)).or_insert(new);
                }
            }
        }
        let count = old.file.positions.len();
        let number_of = found.keys().zip(count..).map(|(&key, number)| (key, VertexId::from_index(number))).collect();
        let position = |&NewVertex { edge, at }: &NewVertex| {
            let [a, b] = edge.map(|end| old.file.positions[end.index()]);
            a.lerp(b, at)
        };
        // The end with the lower number comes first.
        let ascending = |NewVertex { edge: [a, b], at }| {
            if a <= b { NewVertex { edge: [a, b], at } } else { NewVertex { edge: [b, a], at: 1.0 - at } }
        };
        let positions = found.values().map(position).collect();
        Self { number_of, positions, vertices: found.into_values().map(ascending).collect() }
    }
}

/// Faces of the refined mesh.
#[derive(Default)]
struct Faces {
    corners: Vec<VertexId>,
    slots: Vec<u32>,
    starts: Vec<u32>,
    /// Face of the file that each face equals or is a part of.
    face_of: Vec<u32>,
}

impl Faces {
    fn count(&self) -> u32 {
        u32::try_from(self.face_of.len()).expect("a mesh has fewer than 2^32 faces")
    }

    /// Adds a face that equals, or is a part of, a face of the file.
    fn push(&mut self, corners: impl Iterator<Item = (VertexId, u32)>, of: u32) {
        for (vertex, slot) in corners {
            self.corners.push(vertex);
            self.slots.push(slot);
        }
        self.starts.push(u32::try_from(self.corners.len()).expect("a mesh has fewer than 2^32 corners"));
        self.face_of.push(of);
    }
}
