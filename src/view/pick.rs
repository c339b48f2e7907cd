//! Picking under the pointer: the nearest vertex in either pane, and the point of the surface.

use glam::{DMat4, DVec2, DVec3};

use super::orbit::pane_from_clip;
use super::ray_hit::first_hit;
use super::{OrbitCamera, Ray};
use freebound_core::mesh::{FaceId, TriangleTree, VertexId};

/// Largest distance between the pointer and a vertex that it picks, points.
pub const PICK_RADIUS: f64 = 12.0;
/// Margin of hiding, relative to the distance: a face hides a vertex only if it is nearer to the eye by more than
/// this. Both sides of a cut, which coincide, stay visible.
const HIDING_MARGIN: f64 = 1e-6;

/// Vertices of the surface that can be picked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Visibility {
    /// Vertices that no face hides.
    #[default]
    Visible,
    /// All vertices (X-ray).
    All,
}

/// Vertex near the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexPick {
    /// Picked vertex.
    pub vertex: VertexId,
    /// Distance from the pointer, points.
    pub distance_in_points: f64,
}

/// Point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Face that contains the point.
    pub face: FaceId,
    /// Position in the world.
    pub point: DVec3,
    /// Barycentric coordinates in the face; they sum to 1.
    pub weights: [f64; 3],
    /// Distance from the ray's origin, world units.
    pub distance: f64,
}

/// Picking in the 3D pane. Built once per mesh, on any thread.
#[derive(Clone, Debug)]
pub struct SurfacePicker {
    positions: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    /// First face around each vertex, so that a search visits the vertex once.
    first_face: Vec<u32>,
    tree: TriangleTree,
}

impl SurfacePicker {
    /// Prepares picking on triangles over shared positions.
    ///
    /// # Panics
    ///
    /// If a corner names a vertex that is not there.
    pub fn new(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Self {
        let corners: Vec<[DVec3; 3]> = triangles.iter().map(|t| t.map(|v| positions[v.index()])).collect();
        let mut first_face = vec![u32::MAX; positions.len()];
        for (face, triangle) in (0_u32..).zip(triangles) {
            // Faces with a corner that is not finite are not in the hierarchy.
            let is_searched = corners[face as usize].iter().all(|p| p.is_finite());
            for vertex in triangle.iter().filter(|_| is_searched) {
                let first = &mut first_face[vertex.index()];
                *first = face.min(*first);
            }
        }
        Self {
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            first_face,
            tree: TriangleTree::new(&corners),
        }
    }

    /// Positions of all vertices.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Returns the first point of the surface on a ray.
    pub fn hit(&self, ray: Ray) -> Option<SurfaceHit> {
        let (number, [distance, u, v]) =
            first_hit(&self.tree, ray, f64::INFINITY, |number| self.corners(number), |_| true)?;
        Some(SurfaceHit { face: FaceId::new(number), point: ray.at(distance), weights: [1.0 - u - v, u, v], distance })
    }

    /// Returns the vertex nearest to the pointer, within [`PICK_RADIUS`].
    pub fn nearest_vertex(
        &self,
        camera: &OrbitCamera,
        pane_size: DVec2,
        pointer: DVec2,
        visibility: Visibility,
    ) -> Option<VertexPick> {
        let mut near = self.vertices_near(&camera.clip_from_world(pane_size), pane_size, pointer);
        near.sort_unstable_by(|a, b| {
            a.distance_in_points.total_cmp(&b.distance_in_points).then(a.vertex.cmp(&b.vertex))
        });
        let eye = camera.eye();
        near.into_iter().find(|pick| visibility == Visibility::All || self.is_visible(pick.vertex, eye))
    }

    /// True if no face lies between the eye and a vertex.
    pub fn is_visible(&self, vertex: VertexId, eye: DVec3) -> bool {
        let to_vertex = self.positions[vertex.index()] - eye;
        let Some(direction) = to_vertex.try_normalize() else { return true };
        let limit = to_vertex.length() * (1.0 - HIDING_MARGIN);
        let other = |number: u32| !self.triangles[number as usize].contains(&vertex);
        first_hit(&self.tree, Ray { origin: eye, direction }, limit, |number| self.corners(number), other).is_none()
    }

    /// True if the middle of a face is seen from the eye.
    pub fn is_face_visible(&self, face: FaceId, eye: DVec3) -> bool {
        let Some(corners) = self.triangles.get(face.index()) else { return false };
        let middle = corners.iter().map(|&corner| self.positions[corner.index()]).sum::<DVec3>() / 3.0;
        let Some(direction) = (middle - eye).try_normalize() else { return true };
        let hit = self.hit(Ray { origin: eye, direction });
        hit.is_none_or(|hit| hit.face == face || hit.distance >= middle.distance(eye) * (1.0 - HIDING_MARGIN))
    }

    /// Position of each vertex in the pane. `None` for vertices behind the near plane.
    pub fn spots(&self, camera: &OrbitCamera, pane_size: DVec2) -> Vec<Option<DVec2>> {
        let clip_from_world = camera.clip_from_world(pane_size);
        let spot = |position: &DVec3| {
            let clip = clip_from_world * position.extend(1.0);
            pane_from_clip(clip, pane_size).filter(|_| clip.z >= 0.0)
        };
        self.positions.iter().map(spot).collect()
    }

    fn corners(&self, number: u32) -> [DVec3; 3] {
        self.triangles[number as usize].map(|v| self.positions[v.index()])
    }

    /// Vertices within the pick radius.
    fn vertices_near(&self, clip_from_world: &DMat4, pane_size: DVec2, pointer: DVec2) -> Vec<VertexPick> {
        let mut near = Vec::new();
        self.tree.visit(
            |low, high| may_show_near([low, high], clip_from_world, pane_size, pointer),
            |number| {
                let corners = self.triangles[number as usize];
                for vertex in corners.into_iter().filter(|v| self.first_face[v.index()] == number) {
                    let clip = *clip_from_world * self.positions[vertex.index()].extend(1.0);
                    // Nothing in front of the near plane is drawn.
                    let shown = pane_from_clip(clip, pane_size).filter(|_| clip.z >= 0.0);
                    let distance_in_points = shown.map_or(f64::INFINITY, |p| p.distance(pointer));
                    if distance_in_points <= PICK_RADIUS {
                        near.push(VertexPick { vertex, distance_in_points });
                    }
                }
            },
        );
        near
    }
}

/// True if a box may show within the pick radius of the pointer.
fn may_show_near([low, high]: [DVec3; 2], clip_from_world: &DMat4, pane_size: DVec2, pointer: DVec2) -> bool {
    let mut shown = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    for corner in 0..8 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let clip = *clip_from_world * DVec3::new(pick(0), pick(1), pick(2)).extend(1.0);
        // A box that reaches behind the eye may show anywhere.
        let Some(point) = pane_from_clip(clip, pane_size) else { return true };
        shown = [shown[0].min(point), shown[1].max(point)];
    }
    let nearest = pointer.clamp(shown[0], shown[1]);
    nearest.distance_squared(pointer) <= PICK_RADIUS * PICK_RADIUS
}

/// Snaps texture coordinates to the nearest corner or middle of a pixel.
pub fn snapped(target: DVec2, pixels: DVec2) -> DVec2 {
    let at = target * pixels;
    let corner = at.round();
    let middle = at.floor() + 0.5;
    let nearest = if at.distance_squared(corner) < at.distance_squared(middle) { corner } else { middle };
    nearest / pixels
}
