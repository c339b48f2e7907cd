//! Concave polygons of a one-to-one map made convex: vertices near them move, and the rest of the map stays.
//!
//! A map of the triangles may leave a polygon concave at a corner that is convex on the surface. Vertices within some
//! rings of such polygons move, one connected region after the other. They minimise the symmetric Dirichlet energy of
//! their faces, of the triangles at the corners of their polygons, and of the scaffold at the boundary. A concave
//! corner unfolds like a folded triangle, by the foldover energy with ε > 0. All other triangles are barriers. Once
//! all corners are convex, their triangles have a small weight, so that the energy of the faces is low.
//!
//! A region is accepted if fewer of its polygons are concave, no face is flipped, and the boundary stays simple.
//! Polygons that stay concave are tried again with more rings.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use crate::geom::{Orientation, double_area, is_simple, orientation};
use crate::mesh::{DiskMesh, FaceId, HalfedgeId, Polygon, THINNEST, VertexId};
use crate::nonlinear::Scaffold;
use crate::nonlinear::energy_problem::{EnergyProblem, Limits, Planning, Unfolding};
use crate::nonlinear::foldover_energy::{Element, Energy, Stiffness};
use crate::nonlinear::scaffold::{FRAME_POINTS, outside_elements, outside_of};
use crate::problem::{Control, Embedding, SolveError};
use crate::verify::verdict::concave_polygons;
use crate::weights::equations::length_scale;

/// Rings of vertices around a concave polygon that move, at each attempt.
const RINGS: [usize; 3] = [1, 3, 6];

/// Weight of the scaffold at the boundary, relative to the faces of a region.
const OUTSIDE_WEIGHT: f64 = 0.002;

/// A descent: Newton steps with one scaffold.
struct Stretch {
    /// Energy of all triangles that are not folded.
    unfolded: Energy,
    steps: usize,
    /// Weight of the triangles at the corners of a polygon, together, relative to the faces of the polygon.
    corner_weight: f64,
}

/// Descents of a region, in order: one to unfold the corners, then for a low energy of the faces.
const STRETCHES: [Stretch; 3] = [
    Stretch { unfolded: Energy::Foldover(0.0), steps: 25, corner_weight: 1.0 },
    Stretch { unfolded: Energy::SymmetricDirichlet, steps: 10, corner_weight: 0.05 },
    Stretch { unfolded: Energy::SymmetricDirichlet, steps: 10, corner_weight: 0.05 },
];

/// Least relative gain of a Newton step that is followed by another.
const TOLERANCE: f64 = 1e-4;

/// Makes polygons of a one-to-one embedding convex as far as possible. The result is one-to-one. Corners that are
/// concave on the surface may stay concave.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(crate) fn with_convex_polygons(
    mesh: &DiskMesh,
    embedding: Embedding,
    control: Control<'_>,
) -> Result<Embedding, SolveError> {
    let mut map = Map { scale: plane_from_surface(mesh, &embedding), mesh, embedding };
    for rings in RINGS {
        control.go_on()?;
        let concave = map.concave();
        if concave.is_empty() {
            break;
        }
        for region in map.regions(&concave, rings) {
            control.go_on()?;
            if !map.mend(region.iter().copied(), control)? {
                // The boundary may have been in the way.
                map.mend(region.iter().copied().filter(|&v| mesh.boundary_place(v).is_none()), control)?;
            }
        }
    }
    Ok(map.embedding)
}

/// Factor from lengths of rest shapes to lengths in the plane, at equal total areas.
fn plane_from_surface(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let unit = length_scale(mesh);
    let total =
        |area: &dyn Fn([VertexId; 3]) -> f64| mesh.mesh().real_triangles().iter().map(|&t| area(t)).sum::<f64>();
    let on_surface = total(&|corners| double_area(mesh.rest_shape(corners, unit)));
    let in_plane = total(&|corners| double_area(corners.map(|v| embedding[v])));
    unit * (in_plane / on_surface).sqrt()
}

/// A map whose polygons are mended.
struct Map<'a> {
    mesh: &'a DiskMesh,
    embedding: Embedding,
    /// Factor from lengths on the surface to lengths in the plane.
    scale: f64,
}

impl<'a> Map<'a> {
    fn concave(&self) -> Vec<Polygon<'a>> {
        concave_polygons(self.mesh, &self.embedding, Orientation::CounterClockwise).collect()
    }

    /// Connected regions of vertices that may move, around concave polygons.
    fn regions(&self, concave: &[Polygon<'_>], rings: usize) -> Vec<BTreeSet<VertexId>> {
        let mesh = self.mesh;
        let mut near: BTreeSet<VertexId> = concave.iter().flat_map(|polygon| polygon.corners).copied().collect();
        for _ in 0..rings {
            let next: Vec<VertexId> = near.iter().flat_map(|&vertex| self.neighbours(vertex)).collect();
            near.extend(next);
        }
        near.retain(|&vertex| mesh.outgoing(vertex).all(|halfedge| !self.is_virtual(halfedge)));
        let mut regions = Vec::new();
        while let Some(first) = near.pop_first() {
            let (mut region, mut open) = (BTreeSet::from([first]), vec![first]);
            while let Some(vertex) = open.pop() {
                let fresh: Vec<VertexId> = self.neighbours(vertex).filter(|other| near.remove(other)).collect();
                region.extend(&fresh);
                open.extend(fresh);
            }
            regions.push(region);
        }
        regions
    }

    fn neighbours(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.mesh.outgoing(vertex).map(|halfedge| self.mesh.head(halfedge))
    }

    /// True if a halfedge belongs to the filling of a hole.
    fn is_virtual(&self, halfedge: HalfedgeId) -> bool {
        self.mesh.face_of(halfedge).is_some_and(|face| self.mesh.is_virtual(face))
    }

    /// Moves vertices so that fewer polygons are concave. Returns true if such a move was accepted.
    fn mend(&mut self, moving: impl Iterator<Item = VertexId>, control: Control<'_>) -> Result<bool, SolveError> {
        let region = Region::new(self.mesh, moving);
        let before = region.concave_count(&self.embedding);
        if before == 0 {
            return Ok(false);
        }
        let moved = match self.moved(&region, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            // A system without a solution moves nothing.
            Err(_) => return Ok(false),
            Ok(moved) => moved,
        };
        let is_mended = region.concave_count(&moved) < before && region.is_upright(self.mesh, &moved);
        let is_taken = is_mended && (!region.has_boundary(self.mesh) || is_simple(&moved.boundary(self.mesh)));
        if is_taken {
            self.embedding = moved;
        }
        Ok(is_taken)
    }

    fn moved(&self, region: &Region<'_>, control: Control<'_>) -> Result<Embedding, SolveError> {
        let start = Ok(self.embedding.clone());
        STRETCHES.iter().fold(start, |from, stretch| self.descended(region, from?, stretch, control))
    }

    fn descended(
        &self,
        region: &Region<'_>,
        mut embedding: Embedding,
        stretch: &Stretch,
        control: Control<'_>,
    ) -> Result<Embedding, SolveError> {
        let mut z: Vec<DVec2> = region.points.iter().map(|&vertex| embedding[vertex]).collect();
        let mut elements = self.elements(region, stretch.corner_weight);
        if region.has_boundary(self.mesh) {
            let scaffold = outside_of(self.mesh, &embedding, std::iter::empty(), FRAME_POINTS);
            let scaffold = scaffold.ok_or(SolveError::NotPlanar)?;
            let triangles = region.outside(&scaffold, &embedding, &mut z);
            elements.extend(outside_elements(triangles.iter(), &z, OUTSIDE_WEIGHT));
        }
        let is_held = |point: u32| point as usize >= region.moving_count;
        let planning = Planning { order: None, control };
        let problem = EnergyProblem::new(z.len(), elements, Vec::new(), is_held, planning)?;
        let (unfolded, steps, unfolding) = (stretch.unfolded, stretch.steps, Unfolding::BesideBarriers);
        problem.descend(&mut z, Limits { unfolded, steps, unfolding, tolerance: TOLERANCE }, None, control)?;
        for (&vertex, &z) in region.points[..region.moving_count].iter().zip(&z) {
            embedding[vertex] = z;
        }
        Ok(embedding)
    }

    /// Faces of a region, and the triangles at the corners of its polygons. Weights are areas, relative to the region.
    fn elements(&self, region: &Region<'_>, corner_weight: f64) -> Vec<Element> {
        let shape = |corners: [VertexId; 3]| self.mesh.rest_shape(corners, self.scale);
        let area = |corners: [VertexId; 3]| double_area(shape(corners));
        let total: f64 = region.faces.iter().map(|&face| area(self.mesh.face(face))).sum();
        let element = |corners: [VertexId; 3], weight: f64| {
            let stiffness = Stiffness { weight: weight / total, thinnest: THINNEST };
            Element::new(corners.map(|vertex| region.place_of[&vertex]), shape(corners), stiffness)
        };
        let faces = region.faces.iter().map(|&face| self.mesh.face(face));
        let mut elements: Vec<Element> = faces.map(|corners| element(corners, area(corners))).collect();
        for polygon in &region.polygons {
            let own: f64 = polygon.faces().map(|face| area(self.mesh.face(face))).sum();
            let at_corners: f64 = polygon.convex_ears().map(area).sum();
            let weight = if at_corners > 0.0 { corner_weight * own / at_corners } else { 0.0 };
            elements.extend(polygon.convex_ears().map(|ear| element(ear, weight * area(ear))));
        }
        elements
    }
}

/// Vertices that move together, with their faces and polygons.
struct Region<'a> {
    /// Vertices that move, then the other corners of the faces and polygons.
    points: Vec<VertexId>,
    moving_count: usize,
    place_of: BTreeMap<VertexId, u32>,
    faces: Vec<FaceId>,
    polygons: Vec<Polygon<'a>>,
}

impl<'a> Region<'a> {
    fn new(mesh: &'a DiskMesh, moving: impl Iterator<Item = VertexId>) -> Self {
        let mut points: Vec<VertexId> = moving.collect();
        let moving_count = points.len();
        let at = |&vertex: &VertexId| mesh.outgoing(vertex).filter_map(|halfedge| mesh.face_of(halfedge));
        let touching: BTreeSet<FaceId> = points.iter().flat_map(at).collect();
        let polygons: BTreeMap<FaceId, Polygon<'a>> = touching
            .iter()
            .filter_map(|&face| mesh.polygon_of(face))
            .map(|polygon| (polygon.first_face, polygon))
            .collect();
        let polygons: Vec<Polygon<'a>> = polygons.into_values().collect();
        // Faces of a polygon whose corner moves count even if none of their own corners moves.
        let faces: BTreeSet<FaceId> = touching.into_iter().chain(polygons.iter().flat_map(Polygon::faces)).collect();
        let mut place_of: BTreeMap<VertexId, u32> = points.iter().copied().zip(0..).collect();
        for vertex in faces.iter().flat_map(|&face| mesh.face(face)) {
            place_of.entry(vertex).or_insert_with(|| {
                points.push(vertex);
                u32::try_from(points.len() - 1).expect("vertices fit")
            });
        }
        Self { points, moving_count, place_of, faces: faces.into_iter().collect(), polygons }
    }

    /// Triangles of a scaffold at vertices that move. Corners are places in `z`, to which the corners of the scaffold
    /// are added.
    fn outside(&self, scaffold: &Scaffold, embedding: &Embedding, z: &mut Vec<DVec2>) -> Vec<[VertexId; 3]> {
        let mut place_of = self.place_of.clone();
        let is_moving =
            |vertex: &VertexId| self.place_of.get(vertex).is_some_and(|&at| (at as usize) < self.moving_count);
        let position = |vertex: VertexId| {
            let on_mesh = embedding.get(vertex.index()).copied();
            on_mesh.unwrap_or_else(|| scaffold.frame[vertex.index() - embedding.len()])
        };
        let mut place = |vertex: VertexId| {
            let place = *place_of.entry(vertex).or_insert_with(|| {
                z.push(position(vertex));
                u32::try_from(z.len() - 1).expect("points fit")
            });
            VertexId::from_index(place as usize)
        };
        let touching = scaffold.triangles.iter().filter(|corners| corners.iter().any(is_moving));
        touching.map(|corners| corners.map(&mut place)).collect()
    }

    fn concave_count(&self, embedding: &Embedding) -> usize {
        let is_concave = |polygon: &&Polygon<'_>| !polygon.convex_ears().all(|ear| turns_left(embedding, ear));
        self.polygons.iter().filter(is_concave).count()
    }

    fn is_upright(&self, mesh: &DiskMesh, embedding: &Embedding) -> bool {
        self.faces.iter().all(|&face| turns_left(embedding, mesh.face(face)))
    }

    fn has_boundary(&self, mesh: &DiskMesh) -> bool {
        self.points[..self.moving_count].iter().any(|&vertex| mesh.boundary_place(vertex).is_some())
    }
}

fn turns_left(embedding: &Embedding, corners: [VertexId; 3]) -> bool {
    let [a, b, c] = corners.map(|vertex| embedding[vertex]);
    orientation(a, b, c) == Some(Orientation::CounterClockwise)
}
