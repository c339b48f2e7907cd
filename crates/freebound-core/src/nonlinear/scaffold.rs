//! The outside of an embedding, triangulated up to a frame: while none of its triangles folds, the boundary stays simple.
//!
//! The idea is the paper's virtual boundary (§5); kept up while vertices move as in Z. Jiang, S. Schaefer, D. Panozzo,
//! "Simplicial complex augmentation framework for bijective maps", 2017.

use glam::DVec2;

use super::foldover_energy::{Element, Stiffness};
use crate::geom::{Bounds, double_area, outside_triangles};
use crate::linalg::run_apart;
use crate::mesh::{DiskMesh, TriMesh, VertexId};
use crate::problem::{Control, Embedding, SolveError};

/// Points on each side of a frame that vertices move within.
pub(crate) const FRAME_POINTS: u32 = 8;

/// Size of the frame, relative to everything within.
const FRAME_SIZE: f64 = 2.0;

/// Triangles thinner than this, height to longest side, count as so thick: their size matters, not their shape.
pub(crate) const THINNEST: f64 = 0.1;

/// The outside of an embedding up to a frame, triangulated: what keeps the boundary simple while vertices move.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaffold {
    /// The frame's points.
    pub frame: Vec<DVec2>,
    /// Triangles, counter-clockwise. Numbers beyond the step's mesh are the frame's points.
    pub triangles: Vec<[VertexId; 3]>,
}

/// The frame around points: a square with so many points on each side, one corner of it among them, counter-clockwise.
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

/// The outside of an embedding with a simple boundary, up to a frame around it and further points.
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

/// The triangles between the boundary and a frame, or the hull where that is empty. Beyond the mesh's vertices they are
/// those of the frame.
pub(crate) fn triangles_around(mesh: &DiskMesh, boundary: &[DVec2], frame: &[DVec2]) -> Option<Vec<[VertexId; 3]>> {
    let vertex = |corner: u32| {
        let corner = corner as usize;
        let beyond = || VertexId::from_index(mesh.vertex_count() + corner - boundary.len());
        mesh.boundary_loop().get(corner).copied().unwrap_or_else(beyond)
    };
    Some(outside_triangles(boundary, frame)?.into_iter().map(|t| t.map(vertex)).collect())
}

/// A mesh in the plane as a disk.
pub(crate) fn disk_in_plane(points: &[DVec2], triangles: Vec<[VertexId; 3]>) -> Option<DiskMesh> {
    let positions = points.iter().map(|z| z.extend(0.0)).collect();
    DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of: None }).ok()
}

/// The same, left behind where the caller gives up.
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

/// The energies of triangles outside a mesh, at rest as they lie: all together weigh so much.
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
