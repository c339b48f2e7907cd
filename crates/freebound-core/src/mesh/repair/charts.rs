//! Charts of a repaired mesh: its edge-connected parts, if each of them is a disk.

use std::collections::HashMap;

use super::Repaired;
use super::fill::Filling;
use super::sides::Sides;
use crate::mesh::union::DisjointSets;
use crate::mesh::{FaceId, PolygonMesh, VertexId, parts};

/// A mesh with several charts.
#[derive(Clone, Debug, PartialEq)]
pub struct Charts {
    whole: Repaired,
    /// Faces of each chart in the whole mesh, ascending.
    faces: Vec<Vec<u32>>,
    /// Chart of each vertex of the whole mesh; `None` for unreferenced vertices.
    chart_of_vertex: Vec<Option<u32>>,
    /// Number of vertices of each chart.
    vertex_counts: Vec<usize>,
    /// Chart with the most faces; the first one at a tie.
    largest: usize,
}

/// A chart with its own vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Faces of the chart, each with its face of the given mesh.
    pub repaired: Repaired,
    /// Vertex of the whole mesh for each vertex of the chart, ascending.
    pub vertex_of: Vec<VertexId>,
}

impl Charts {
    /// Returns the charts of a mesh, in the order of their first faces; `None` if it has one part, or a part is not a
    /// disk.
    pub fn of(whole: Repaired) -> Option<Self> {
        Self::try_of(whole).ok()
    }

    /// Returns the charts of a mesh like [`of`](Self::of), or returns the mesh if there are none.
    ///
    /// # Errors
    ///
    /// The mesh, if it has one part only, or a part is not a disk.
    pub fn try_of(whole: Repaired) -> Result<Self, Box<Repaired>> {
        let Some(faces) = disks_of(&whole).filter(|faces| faces.len() > 1) else { return Err(Box::new(whole)) };
        let mut chart_of_vertex = vec![None; whole.polygons.positions.len()];
        for (number, own) in (0..).zip(&faces) {
            for corner in own.iter().flat_map(|&face| whole.polygons.face(face as usize)) {
                chart_of_vertex[corner.index()] = Some(number);
            }
        }
        let size = |&chart: &usize| (faces[chart].len(), std::cmp::Reverse(chart));
        let largest = (0..faces.len()).max_by_key(size).unwrap_or_default();
        let mut vertex_counts = vec![0; faces.len()];
        for &chart in chart_of_vertex.iter().flatten() {
            vertex_counts[chart as usize] += 1;
        }
        Ok(Self { whole, faces, chart_of_vertex, vertex_counts, largest })
    }

    /// Mesh that the charts belong to.
    pub fn whole(&self) -> &Repaired {
        &self.whole
    }

    /// Number of charts.
    pub fn count(&self) -> usize {
        self.faces.len()
    }

    /// Faces of a chart in the whole mesh, ascending.
    pub fn faces(&self, chart: usize) -> &[u32] {
        &self.faces[chart]
    }

    /// Number of vertices of a chart, without those that fill its holes.
    pub fn vertex_count(&self, chart: usize) -> usize {
        self.vertex_counts[chart]
    }

    /// First face of a chart, by its number in the given mesh.
    pub fn first_face(&self, chart: usize) -> FaceId {
        FaceId::new(self.whole.face_of[self.faces[chart][0] as usize])
    }

    /// Chart of a face of the whole mesh; `None` if there is no such face.
    pub fn chart_of_face(&self, face: u32) -> Option<usize> {
        let polygons = &self.whole.polygons;
        let is_there = (face as usize) < polygons.face_count();
        is_there.then(|| polygons.face(face as usize)[0]).and_then(|vertex| self.chart_of_vertex(vertex))
    }

    /// Chart of a face of the given mesh; `None` if a repair left the face out.
    pub fn chart_of_file_face(&self, face: FaceId) -> Option<usize> {
        let in_whole = self.whole.face_of.iter().position(|&of| of == face.number())?;
        self.chart_of_face(u32::try_from(in_whole).ok()?)
    }

    /// Chart of a vertex of the whole mesh.
    pub fn chart_of_vertex(&self, vertex: VertexId) -> Option<usize> {
        self.chart_of_vertex.get(vertex.index()).copied().flatten().map(|chart| chart as usize)
    }

    /// Chart with the most faces; the first one at a tie.
    pub fn largest(&self) -> usize {
        self.largest
    }

    /// Returns the wanted chart if it exists, otherwise the largest chart.
    pub fn pick(&self, wanted: Option<usize>) -> usize {
        wanted.filter(|&wanted| wanted < self.count()).unwrap_or_else(|| self.largest())
    }

    /// Extracts a chart with its own vertices and fills its holes if holes are to be filled.
    pub fn chart(&self, chart: usize) -> Chart {
        let Chart { repaired, vertex_of } = self.whole.of_faces(&self.faces[chart]);
        Chart { repaired: repaired.filled(), vertex_of }
    }
}

impl Repaired {
    /// Extracts faces with their own vertices.
    pub(super) fn of_faces(&self, faces: &[u32]) -> Chart {
        let part = compact(&self.polygons, faces);
        let repaired = Self {
            corner_of: part.corner_of.iter().map(|&corner| self.corner_of[corner as usize]).collect(),
            face_of: faces.iter().map(|&face| self.face_of[face as usize]).collect(),
            polygons: part.polygons,
            stand_ins: Vec::new(),
            joined: HashMap::new(),
            fills: self.fills,
            filling: Filling::default(),
            left_out: Vec::new(),
            degenerate: Vec::new(),
            keeps_last: self.keeps_last,
            done: self.done.clone(),
        };
        Chart { repaired, vertex_of: part.vertex_of }
    }
}

impl Chart {
    /// Vertex of the chart for a vertex of the whole mesh.
    pub fn vertex_at(&self, of_whole: VertexId) -> Option<VertexId> {
        self.vertex_of.binary_search(&of_whole).ok().map(VertexId::from_index)
    }
}

/// Faces of each part. `None` unless every part is a disk, once holes are filled if allowed, and no two parts share a
/// vertex.
pub(super) fn disks_of(whole: &Repaired) -> Option<Vec<Vec<u32>>> {
    let polygons = &whole.polygons;
    let found = parts(&polygons.triangulate()).ok()?;
    let faces = parts_of(polygons, &Sides::new(polygons));
    let are_disks = found.len() == faces.len() && found.iter().all(|part| whole.fills || part.loops().len() == 1);
    // A part has its own copy of each vertex that it shares.
    let own_count: usize = found.iter().map(|part| part.vertex_of().len()).sum();
    let mut used: Vec<VertexId> = polygons.corners.clone();
    used.sort_unstable();
    used.dedup();
    (are_disks && own_count == used.len()).then_some(faces)
}

/// Some faces of a mesh, with their own vertices.
pub(super) struct Compact {
    pub(super) polygons: PolygonMesh,
    /// Corner of the whole mesh for each corner.
    pub(super) corner_of: Vec<u32>,
    /// Vertex of the whole mesh for each vertex, ascending.
    vertex_of: Vec<VertexId>,
}

/// Extracts faces of a mesh with their own vertices.
pub(super) fn compact(whole: &PolygonMesh, faces: &[u32]) -> Compact {
    let count = |count: usize| u32::try_from(count).expect("a mesh has fewer than 2^32 corners");
    let places = || faces.iter().flat_map(|&face| whole.corner_range(face as usize));
    let mut vertex_of: Vec<VertexId> = places().map(|place| whole.corners[place]).collect();
    vertex_of.sort_unstable();
    vertex_of.dedup();
    let own = |vertex: VertexId| {
        VertexId::from_index(vertex_of.binary_search(&vertex).expect("every vertex of these faces is in the list"))
    };
    let mut starts = vec![0];
    for &face in faces {
        starts.push(starts[starts.len() - 1] + count(whole.corner_range(face as usize).len()));
    }
    let polygons = PolygonMesh {
        positions: vertex_of.iter().map(|vertex| whole.positions[vertex.index()]).collect(),
        corners: places().map(|place| own(whole.corners[place])).collect(),
        starts: starts.windows(2).any(|ends| ends[1] - ends[0] != 3).then_some(starts),
    };
    Compact { polygons, corner_of: places().map(count).collect(), vertex_of }
}

/// Faces of each edge-connected part, in the order of their first faces.
pub(super) fn parts_of(polygons: &PolygonMesh, sides: &Sides<'_>) -> Vec<Vec<u32>> {
    let mut sets = DisjointSets::new(polygons.face_count());
    for on in sides.table.edges() {
        for pair in on.windows(2) {
            sets.join(sides.face[pair[0] as usize], sides.face[pair[1] as usize]);
        }
    }
    let mut part_of_root = vec![None; polygons.face_count()];
    let mut parts: Vec<Vec<u32>> = Vec::new();
    for face in (0..).take(polygons.face_count()) {
        let part = *part_of_root[sets.find(face) as usize].get_or_insert_with(|| {
            parts.push(Vec::new());
            parts.len() - 1
        });
        parts[part].push(face);
    }
    parts
}
