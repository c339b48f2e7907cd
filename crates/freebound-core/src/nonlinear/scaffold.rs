//! Scaffold: the outside of an embedding, triangulated up to a frame. The boundary stays simple while no scaffold
//! triangle folds.
//!
//! The idea is the paper's virtual boundary (§5). Maintaining it while vertices move follows Z. Jiang, S. Schaefer, D.
//! Panozzo, "Simplicial complex augmentation framework for bijective maps", 2017.

use glam::DVec2;

use super::foldover_energy::{Element, Stiffness};
use crate::geom::{Bounds, double_area, outside_triangles};
use crate::linalg::run_apart;
use crate::mesh::{DiskMesh, TriMesh, VertexId};
use crate::problem::{Control, Embedding, SolveError};

/// Number of points on each side of the frame.
pub(crate) const FRAME_POINTS: u32 = 8;

/// Size of the frame, relative to the bounding box of everything within.
const FRAME_SIZE: f64 = 2.0;

/// Smallest ratio of height to longest side; thinner triangles count as if they had this ratio. Their size matters,
/// not their shape.
pub(crate) const THINNEST: f64 = 0.1;

/// Triangulated outside of an embedding, up to a frame. Keeps the boundary simple while vertices move.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaffold {
    /// Points of the frame.
    pub frame: Vec<DVec2>,
    /// Triangles, counter-clockwise. Vertex numbers beyond the step's mesh denote points of the frame.
    pub triangles: Vec<[VertexId; 3]>,
}

/// Square frame around points, with `per_side` points on each side, including one corner of that side;
/// counter-clockwise.
pub(crate) fn frame_around(points: impl Iterator<Item = DVec2>, per_side: u32) -> Vec<DVec2> {
    let bounds = Bounds::of(points);
    let (centre, half) = (bounds.middle(), 0.5 * FRAME_SIZE * bounds.size().max_element());
    let corners = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let side = |k: usize| {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        (0..per_side).map(move |i| from.lerp(to, f64::from(i) / f64::from(per_side)))
    };
    (0..4).flat_map(side).map(|z| centre + half * z).collect()
}

/// Scaffold of an embedding with a simple boundary. The frame encloses the boundary and `further` points.
pub(crate) fn outside_of(
    mesh: &DiskMesh,
    embedding: &Embedding,
    further: impl Iterator<Item = DVec2>,
    per_side: u32,
) -> Option<Scaffold> {
    let boundary = embedding.boundary(mesh);
    let frame = frame_around(boundary.iter().copied().chain(further), per_side);
    let triangles = triangles_around(mesh, &boundary, &frame)?;
    Some(Scaffold { frame, triangles })
}

/// Triangles between the boundary and a frame, or the convex hull if the frame is empty. Vertex numbers beyond the
/// mesh denote points of the frame.
pub(crate) fn triangles_around(mesh: &DiskMesh, boundary: &[DVec2], frame: &[DVec2]) -> Option<Vec<[VertexId; 3]>> {
    let vertex = |corner: u32| {
        let corner = corner as usize;
        let beyond = || VertexId::from_index(mesh.vertex_count() + corner - boundary.len());
        mesh.boundary_loop().get(corner).copied().unwrap_or_else(beyond)
    };
    Some(outside_triangles(boundary, frame)?.into_iter().map(|t| t.map(vertex)).collect())
}

/// Builds a disk from a mesh in the plane.
pub(crate) fn disk_in_plane(points: &[DVec2], triangles: Vec<[VertexId; 3]>) -> Option<DiskMesh> {
    let positions = points.iter().map(|z| z.extend(0.0)).collect();
    DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of: None }).ok()
}

/// Builds a disk from a mesh in the plane on a separate thread, which is abandoned on cancellation.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(crate) fn disk_in_plane_apart(
    points: &[DVec2],
    triangles: Vec<[VertexId; 3]>,
    control: Control<'_>,
) -> Result<Option<DiskMesh>, SolveError> {
    let points = points.to_vec();
    Ok(run_apart(move || disk_in_plane(&points, triangles), control.cancel())?)
}

/// Elements of triangles outside a mesh, with their present shapes as rest shapes and with a total weight of `weight`.
pub(crate) fn outside_elements<'a>(
    triangles: impl Iterator<Item = &'a [VertexId; 3]> + Clone,
    points: &[DVec2],
    weight: f64,
) -> Vec<Element> {
    let shape = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let total: f64 = triangles.clone().map(|t| double_area(shape(t))).sum();
    let element = |t: &[VertexId; 3]| {
        Element::new(
            t.map(VertexId::number),
            shape(t),
            Stiffness { weight: weight * double_area(shape(t)) / total, thinnest: THINNEST },
        )
    };
    triangles.map(element).collect()
}
