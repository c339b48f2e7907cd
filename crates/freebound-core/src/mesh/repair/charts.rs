//! The charts of a repaired mesh: its parts that hang together across edges, where every one of them is a disk.

use std::collections::HashMap;

use super::Repaired;
use super::fill::Filling;
use super::sides::Sides;
use crate::mesh::union::DisjointSets;
use crate::mesh::{FaceId, PolygonMesh, VertexId, parts};

/// A mesh of several charts.
#[derive(Clone, Debug, PartialEq)]
pub struct Charts {
    whole: Repaired,
    /// The faces of each chart, of the whole, ascending.
    faces: Vec<Vec<u32>>,
    /// The chart of each vertex of the whole; none where it has no face.
    chart_of_vertex: Vec<Option<u32>>,
}

/// One chart, over vertices of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Its faces, each known as the face of the mesh as given that it is.
    pub repaired: Repaired,
    /// The vertex of the whole that each of its vertices is, ascending.
    pub vertex_of: Vec<VertexId>,
}

impl Charts {
    /// The charts of a mesh, in the order of their first faces; none where it is one part, or a part is no disk.
    pub fn of(whole: Repaired) -> Option<Self> {
        Self::try_of(whole).ok()
    }

    /// As [`of`](Self::of), the mesh given back where there are none.
    ///
    /// # Errors
    ///
    /// The mesh, where it is one part, or a part is no disk.
    pub fn try_of(whole: Repaired) -> Result<Self, Box<Repaired>> {
        let Some(faces) = disks_of(&whole).filter(|faces| faces.len() > 1) else { return Err(Box::new(whole)) };
        let mut chart_of_vertex = vec![None; whole.polygons.positions.len()];
        for (number, own) in (0..).zip(&faces) {
            for corner in own.iter().flat_map(|&face| whole.polygons.face(face as usize)) {
                chart_of_vertex[corner.index()] = Some(number);
            }
        }
        Ok(Self { whole, faces, chart_of_vertex })
    }

    /// The mesh that they are the charts of.
    pub fn whole(&self) -> &Repaired {
        &self.whole
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.faces.len()
    }

    /// The faces of a chart, of the whole, ascending.
    pub fn faces(&self, chart: usize) -> &[u32] {
        &self.faces[chart]
    }

    /// The first face of a chart, as the mesh as given numbers it.
    pub fn first_face(&self, chart: usize) -> FaceId {
        FaceId::new(self.whole.face_of[self.faces[chart][0] as usize])
    }

    /// The chart of a face of the whole; none where there is no such face.
    pub fn chart_of_face(&self, face: u32) -> Option<usize> {
        let polygons = &self.whole.polygons;
        let is_there = (face as usize) < polygons.face_count();
        is_there.then(|| polygons.face(face as usize)[0]).and_then(|vertex| self.chart_of_vertex(vertex))
    }

    /// The chart of a vertex of the whole.
    pub fn chart_of_vertex(&self, vertex: VertexId) -> Option<usize> {
        self.chart_of_vertex.get(vertex.index()).copied().flatten().map(|chart| chart as usize)
    }

    /// The chart with the most faces, the first of these.
    pub fn largest(&self) -> usize {
        (0..self.count()).max_by_key(|&chart| (self.faces[chart].len(), std::cmp::Reverse(chart))).unwrap_or_default()
    }

    /// The chart that is wanted, where there is such a one; the largest where there is not, or none is wanted.
    pub fn pick(&self, wanted: Option<usize>) -> usize {
        wanted.filter(|&wanted| wanted < self.count()).unwrap_or_else(|| self.largest())
    }

    /// One chart by itself.
    pub fn chart(&self, chart: usize) -> Chart {
        let part = compact(&self.whole.polygons, &self.faces[chart]);
        let repaired = Repaired {
            corner_of: part.corner_of.iter().map(|&corner| self.whole.corner_of[corner as usize]).collect(),
            face_of: self.faces[chart].iter().map(|&face| self.whole.face_of[face as usize]).collect(),
            polygons: part.polygons,
            stand_ins: Vec::new(),
            joined: HashMap::new(),
            fills: self.whole.fills,
            filling: Filling::default(),
            left_out: Vec::new(),
            keeps_last: self.whole.keeps_last,
            done: self.whole.done.clone(),
        };
        let repaired = repaired.filled();
        Chart { repaired, vertex_of: part.vertex_of }
    }
}

impl Chart {
    /// The chart's vertex that a vertex of the whole is.
    pub fn vertex_at(&self, of_whole: VertexId) -> Option<VertexId> {
        self.vertex_of.binary_search(&of_whole).ok().map(VertexId::from_index)
    }
}

/// The faces of each part, where every part is a disk, once its holes are filled where they are to be, and no two share a vertex.
pub(super) fn disks_of(whole: &Repaired) -> Option<Vec<Vec<u32>>> {
    let polygons = &whole.polygons;
    let found = parts(&polygons.triangulate()).ok()?;
    let faces = parts_of(polygons, &Sides::new(polygons));
    let are_disks = found.len() == faces.len() && found.iter().all(|part| whole.fills || part.loops().len() == 1);
    // A part has a copy of each vertex that it shares.
    let own_count: usize = found.iter().map(|part| part.vertex_of().len()).sum();
    let mut used: Vec<VertexId> = polygons.corners.clone();
    used.sort_unstable();
    used.dedup();
    (are_disks && own_count == used.len()).then_some(faces)
}

/// Some faces of a mesh, over vertices of their own.
pub(super) struct Compact {
    pub(super) polygons: PolygonMesh,
    /// The corner of the whole that each corner is.
    pub(super) corner_of: Vec<u32>,
    /// The vertex of the whole that each vertex is, ascending.
    vertex_of: Vec<VertexId>,
}

/// Takes some faces of a mesh out.
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

/// The faces of each part that hangs together across edges, in the order of their first faces.
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
