//! Immutable draw arrays for the GPU, each with its own revision.
//!
//! Faces are drawn without an index buffer: corner `3 f + k` is corner `k` of face `f`. A vertex shader gets face
//! and corner from its vertex index. Flat colours and wireframes need neither a geometry shader nor a storage
//! buffer, so GLES 3 suffices. Positions are repeated about six times. In exchange the three streams (mesh,
//! embedding, paint) change independently, and only a changed stream is uploaded. Fields are public for reading
//! only: a change means a new array with a new revision.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};

use super::space::split_point;
use super::{Range, Scale, Sphere, UnitPlane, bounds_of};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};

/// Identity of an array: every array made in this process has a unique revision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Revision(u64);

impl Revision {
    /// Returns a new, unique revision.
    pub(super) fn fresh() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Mesh in unit space. Built once per mesh on any thread; 100,000 faces take some ten milliseconds.
#[derive(Debug)]
pub struct MeshArrays {
    /// Revision of the mesh.
    pub revision: Revision,
    /// Sphere in the world that unit space stands for.
    pub frame: Sphere,
    /// Mean of the unit face normals, weighted by area: the side that the surface faces. Its length is 1 for a plane
    /// surface and 0 for a closed surface.
    pub mean_normal: DVec3,
    /// Vertices in unit space.
    pub points: Vec<[f32; 3]>,
    /// Positions in unit space, corner by corner.
    pub corner_positions: Vec<[f32; 3]>,
    /// Normals, corner by corner, as 16-bit fractions; the fourth component is unused.
    pub corner_normals: Vec<[i16; 4]>,
    /// Corners of all faces.
    pub triangles: Vec<[VertexId; 3]>,
}

impl MeshArrays {
    /// Builds the draw arrays of triangles over shared positions.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn new(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Self {
        Self::in_frame(positions, triangles, Sphere::around(positions))
    }

    /// Builds the arrays in the unit space of another mesh, so that both can be drawn together.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn in_frame(positions: &[DVec3], triangles: &[[VertexId; 3]], frame: Sphere) -> Self {
        let points: Vec<[f32; 3]> = positions.iter().map(|&p| frame.unit_from_world(p).to_array()).collect();
        let corner_positions = triangles.iter().flatten().map(|v| points[v.index()]).collect();
        let normals = crease_normals(positions, triangles);
        let areas = area_vectors(positions, triangles);
        let sum: DVec3 = areas.iter().sum();
        let total_area: f64 = areas.iter().map(|area| area.length()).sum();
        Self {
            revision: Revision::fresh(),
            frame,
            mean_normal: if total_area > 0.0 { sum / total_area } else { DVec3::ZERO },
            points,
            corner_positions,
            corner_normals: normals.into_iter().map(packed_normal).collect(),
            triangles: triangles.to_vec(),
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "components of a unit vector times 32767")]
fn packed_normal(normal: DVec3) -> [i16; 4] {
    let n = (32767.0 * normal.clamp(DVec3::NEG_ONE, DVec3::ONE)).round();
    [n.x as i16, n.y as i16, n.z as i16, 0]
}

/// Embedding in unit space as sums of two f32 numbers, precise enough to zoom over twelve decades. Built once per
/// embedding.
#[derive(Debug)]
pub struct PlaneArrays {
    /// Revision of the embedding.
    pub revision: Revision,
    /// Position and scale of unit space in the plane.
    pub frame: UnitPlane,
    /// Bounding box of the embedding.
    pub bounds: Bounds,
    /// Vertices: high parts, then low parts.
    pub points: Vec<[f32; 4]>,
    /// Points of all faces, corner by corner.
    pub corners: Vec<[f32; 4]>,
    /// Sum of the areas of all faces in unit space, each positive.
    pub area: f64,
}

impl PlaneArrays {
    /// Builds the draw arrays of an embedding, one point per vertex.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn new(embedding: &[DVec2], triangles: &[[VertexId; 3]]) -> Self {
        Self::in_frame(embedding, triangles, UnitPlane::of(bounds_of(embedding)))
    }

    /// Builds the arrays in the unit space of another embedding, so that both can be drawn over each other.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn in_frame(embedding: &[DVec2], triangles: &[[VertexId; 3]], frame: UnitPlane) -> Self {
        let bounds = bounds_of(embedding);
        let points: Vec<[f32; 4]> = embedding.iter().map(|&p| split_point(frame.unit_from_embedding(p))).collect();
        let corners = triangles.iter().flatten().map(|v| points[v.index()]).collect();
        let area = triangles.iter().map(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|v| frame.unit_from_embedding(embedding[v.index()]));
            0.5 * (b - a).perp_dot(c - a).abs()
        });
        Self { revision: Revision::fresh(), frame, bounds, points, corners, area: area.sum() }
    }
}

/// Colour and flags per face. Rebuilt when the quantity or the verdict changes.
#[derive(Debug)]
pub struct FacePaint {
    /// Revision of the colouring.
    pub revision: Revision,
    /// Red, green, blue and flags, corner by corner.
    pub corners: Vec<[u8; 4]>,
    /// Flipped faces.
    pub flipped: Vec<FaceId>,
}

impl FacePaint {
    /// Bit of a flipped face.
    pub const FLIPPED: u8 = 1;

    /// Bit of a face in the background, plain in every shading.
    pub const FAINT: u8 = 2;

    /// Paint of faces in the background.
    pub fn faint(face_count: usize) -> Self {
        Self {
            revision: Revision::fresh(),
            corners: vec![[255, 255, 255, Self::FAINT]; 3 * face_count],
            flipped: Vec::new(),
        }
    }

    /// White faces with the flipped ones marked. Flipped faces that do not exist are ignored.
    pub fn plain(face_count: usize, flipped: &[FaceId]) -> Self {
        Self::from_colours(vec![[255; 3]; face_count], flipped)
    }

    /// Faces coloured by a quantity, one value per face, with the flipped ones marked.
    pub fn by_value(values: &[f64], scale: Scale, range: Range, flipped: &[FaceId]) -> Self {
        Self::from_colours(values.iter().map(|&v| scale.colour(v, range)).collect(), flipped)
    }

    fn from_colours(colours: Vec<[u8; 3]>, flipped: &[FaceId]) -> Self {
        let flipped: Vec<FaceId> = flipped.iter().copied().filter(|f| f.index() < colours.len()).collect();
        let mut corners: Vec<[u8; 4]> = colours.into_iter().flat_map(|[r, g, b]| [[r, g, b, 0]; 3]).collect();
        for face in &flipped {
            for corner in &mut corners[3 * face.index()..][..3] {
                corner[3] |= Self::FLIPPED;
            }
        }
        Self { revision: Revision::fresh(), corners, flipped }
    }
}

/// Edges drawn as lines: a boundary, crossings, a path.
#[derive(Debug)]
pub struct EdgeList {
    /// Revision of the list.
    pub revision: Revision,
    /// End vertices of each edge.
    pub ends: Vec<[VertexId; 2]>,
}

impl EdgeList {
    /// List of edges by their end vertices.
    pub fn new(ends: Vec<[VertexId; 2]>) -> Self {
        Self { revision: Revision::fresh(), ends }
    }

    /// Closed line through the vertices of a boundary loop.
    pub fn closed_loop(vertices: &[VertexId]) -> Self {
        Self::closed_loops(std::iter::once(vertices))
    }

    /// Closed lines through the vertices of boundary loops.
    pub fn closed_loops<'a>(loops: impl Iterator<Item = &'a [VertexId]>) -> Self {
        let ends = |vertices: &'a [VertexId]| vertices.iter().zip(vertices.iter().cycle().skip(1));
        Self::new(loops.flat_map(ends).map(|(&a, &b)| [a, b]).collect())
    }
}

/// Faces that do not belong to the mesh, filled with one colour, such as the pockets of a virtual boundary.
#[derive(Debug)]
pub struct DrawnFaces {
    /// Revision of the list.
    pub revision: Revision,
    /// Corners of each face.
    pub triangles: Vec<[VertexId; 3]>,
}

impl DrawnFaces {
    /// List of faces by their corners.
    pub fn new(triangles: Vec<[VertexId; 3]>) -> Self {
        Self { revision: Revision::fresh(), triangles }
    }
}

/// Cosine of the crease angle, 70°: an edge between faces that bend more is shaded sharp. A cube has such edges, a
/// coarse nose has none.
const CREASE_COSINE: f64 = 0.34;

/// Returns one normal per corner, in the order of the triangles' corners.
///
/// A corner's normal is the area-weighted mean over the faces around its vertex. Faces that bend away from the
/// corner's own face by the crease angle or more are left out. Faces without area take the normal of their
/// neighbours.
pub fn crease_normals(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<DVec3> {
    let areas = area_vectors(positions, triangles);
    let units: Vec<DVec3> = areas.iter().map(|a| a.normalize_or_zero()).collect();
    let (starts, faces) = faces_by_vertex(positions.len(), triangles);
    let mut normals = Vec::with_capacity(3 * triangles.len());
    for (triangle, &own) in triangles.iter().zip(&units) {
        for vertex in triangle {
            let around = &faces[starts[vertex.index()] as usize..starts[vertex.index() + 1] as usize];
            let gentle =
                around.iter().map(|&f| f as usize).filter(|&f| own == DVec3::ZERO || units[f].dot(own) > CREASE_COSINE);
            let sum: DVec3 = gentle.map(|f| areas[f]).sum();
            normals.push(sum.try_normalize().unwrap_or(own));
        }
    }
    normals
}

/// Area vector of each face: along its normal, twice its area long.
fn area_vectors(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<DVec3> {
    let corners = triangles.iter().map(|triangle| triangle.map(|v| positions[v.index()]));
    corners.map(|[a, b, c]| (b - a).cross(c - a)).collect()
}

/// Returns the faces around each vertex: the start of each vertex's list, and all lists concatenated.
fn faces_by_vertex(vertex_count: usize, triangles: &[[VertexId; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; vertex_count + 1];
    for vertex in triangles.iter().flatten() {
        starts[vertex.index() + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut cursor = starts.clone();
    let mut faces = vec![0_u32; 3 * triangles.len()];
    for (face, triangle) in (0_u32..).zip(triangles) {
        for vertex in triangle {
            let place = &mut cursor[vertex.index()];
            faces[*place as usize] = face;
            *place += 1;
        }
    }
    (starts, faces)
}
