//! What the GPU is given: arrays that never change once made, each with a revision of its own.
//!
//! Faces are drawn without an index buffer: corner `3 f + k` is corner `k` of face `f`. A vertex shader then knows
//! face and corner from its running number, so flat colours and wireframes need neither a geometry shader nor a
//! storage buffer, and runs on GLES 3. The price is that positions repeat about six times; in exchange the three
//! streams (mesh, embedding, paint) change apart from each other, and only what changed is sent. Fields are there to be
//! read: what is changed is made anew.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};

use super::space::split_point;
use super::{Range, Scale, Sphere, UnitPlane, bounds_of};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};

/// Says whether two arrays are the same: every array made in this process has its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Revision(u64);

impl Revision {
    /// A revision that nothing else has.
    pub(super) fn fresh() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// The mesh in unit space. Made once per mesh; 100 k faces take some ten milliseconds, on any thread.
#[derive(Debug)]
pub struct MeshArrays {
    /// Which mesh this is.
    pub revision: Revision,
    /// Where unit space lies in the world.
    pub frame: Sphere,
    /// The mean of the faces' normals, weighted by area: the side that the surface shows. Its length is 1 for a plane
    /// sheet and 0 for a closed surface.
    pub mean_normal: DVec3,
    /// Vertices in unit space.
    pub points: Vec<[f32; 3]>,
    /// Positions in unit space, corner by corner.
    pub corner_positions: Vec<[f32; 3]>,
    /// Normals, corner by corner, as 16-bit fractions; the fourth is nothing.
    pub corner_normals: Vec<[i16; 4]>,
    /// Corners of all faces.
    pub triangles: Vec<[VertexId; 3]>,
}

impl MeshArrays {
    /// Draw arrays of triangles over shared positions.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn new(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Self {
        Self::in_frame(positions, triangles, Sphere::around(positions))
    }

    /// The same in the unit space of another mesh, so that both can be drawn beside each other.
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

/// An embedding in unit space, as sums of two f32, so that one can zoom in twelve decades. Made once per embedding.
#[derive(Debug)]
pub struct PlaneArrays {
    /// Which embedding this is.
    pub revision: Revision,
    /// Where unit space lies in the plane.
    pub frame: UnitPlane,
    /// The smallest box around it.
    pub bounds: Bounds,
    /// Vertices: high parts, then low parts.
    pub points: Vec<[f32; 4]>,
    /// The same, corner by corner.
    pub corners: Vec<[f32; 4]>,
}

impl PlaneArrays {
    /// Draw arrays of an embedding, one point per vertex.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn new(embedding: &[DVec2], triangles: &[[VertexId; 3]]) -> Self {
        Self::in_frame(embedding, triangles, UnitPlane::of(bounds_of(embedding)))
    }

    /// The same in the unit space of another embedding, so that both can be drawn over each other.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn in_frame(embedding: &[DVec2], triangles: &[[VertexId; 3]], frame: UnitPlane) -> Self {
        let bounds = bounds_of(embedding);
        let points: Vec<[f32; 4]> = embedding.iter().map(|&p| split_point(frame.unit_from_embedding(p))).collect();
        let corners = triangles.iter().flatten().map(|v| points[v.index()]).collect();
        Self { revision: Revision::fresh(), frame, bounds, points, corners }
    }
}

/// A colour and flags per face. Made anew when a quantity or the verdict changes.
#[derive(Debug)]
pub struct FacePaint {
    /// Which colouring this is.
    pub revision: Revision,
    /// Red, green, blue and the flags, corner by corner.
    pub corners: Vec<[u8; 4]>,
    /// The flipped faces.
    pub flipped: Vec<FaceId>,
}

impl FacePaint {
    /// The bit of a face that is flipped.
    pub const FLIPPED: u8 = 1;

    /// The bit of a face that stands back, plain in every shading.
    pub const FAINT: u8 = 2;

    /// Faces that stand back.
    pub fn faint(face_count: usize) -> Self {
        Self {
            revision: Revision::fresh(),
            corners: vec![[255, 255, 255, Self::FAINT]; 3 * face_count],
            flipped: Vec::new(),
        }
    }

    /// White faces with the flipped ones marked. Faces that are not there are passed over.
    pub fn plain(face_count: usize, flipped: &[FaceId]) -> Self {
        Self::from_colours(vec![[255; 3]; face_count], flipped)
    }

    /// Faces coloured by a quantity, one value each, with the flipped ones marked.
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

/// Edges that are drawn as lines: the boundary, crossings, a path.
#[derive(Debug)]
pub struct EdgeList {
    /// Which list this is.
    pub revision: Revision,
    /// The ends of each edge.
    pub ends: Vec<[VertexId; 2]>,
}

impl EdgeList {
    /// Edges by their ends.
    pub fn new(ends: Vec<[VertexId; 2]>) -> Self {
        Self { revision: Revision::fresh(), ends }
    }

    /// The closed line through the vertices of a boundary loop.
    pub fn closed_loop(vertices: &[VertexId]) -> Self {
        Self::closed_loops(std::iter::once(vertices))
    }

    /// The closed lines through the vertices of boundary loops.
    pub fn closed_loops<'a>(loops: impl Iterator<Item = &'a [VertexId]>) -> Self {
        let ends = |vertices: &'a [VertexId]| vertices.iter().zip(vertices.iter().cycle().skip(1));
        Self::new(loops.flat_map(ends).map(|(&a, &b)| [a, b]).collect())
    }
}

/// Faces that are not the mesh's, filled with one colour: the pockets of a virtual boundary.
#[derive(Debug)]
pub struct DrawnFaces {
    /// Which list this is.
    pub revision: Revision,
    /// The corners of each face.
    pub triangles: Vec<[VertexId; 3]>,
}

impl DrawnFaces {
    /// Faces by their corners.
    pub fn new(triangles: Vec<[VertexId; 3]>) -> Self {
        Self { revision: Revision::fresh(), triangles }
    }
}

/// Cosine of the angle between two faces above which the edge between them shows, 70°: a cube has edges, and a
/// coarse nose has none.
const CREASE_COSINE: f64 = 0.34;

/// One normal per corner, in the order of the triangles' corners.
///
/// A corner's normal is the area-weighted mean over the faces around its vertex that bend away from its own face by
/// less than the crease angle. Faces without area take that of their neighbours.
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

/// Twice the area of each face, along its normal.
fn area_vectors(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<DVec3> {
    let corners = triangles.iter().map(|triangle| triangle.map(|v| positions[v.index()]));
    corners.map(|[a, b, c]| (b - a).cross(c - a)).collect()
}

/// For each vertex the faces around it: where its list begins, and all lists one after the other.
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
