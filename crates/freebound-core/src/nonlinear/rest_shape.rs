//! Rest shapes: triangles of the surface, each laid out in the plane. The energy of an embedding compares its
//! triangles with them.

use crate::parallel::prelude::*;
use glam::DVec2;

use super::Scaffold;
use super::energy_problem::{EnergyProblem, Planning, Spring};
use super::foldover_energy::{Element, Energy, Stiffness};
use super::scaffold::outside_elements;
use crate::geom::double_area;
use crate::mesh::{DiskMesh, THINNEST, VertexId};
use crate::problem::{Embedding, PinKind, Pins, Progress, SolveError};
use crate::weights::equations::length_scale;

/// Smallest number of triangles per task.
const TRIANGLES_PER_TASK: usize = 4096;

/// Triangles of the surface, each laid out in the plane.
#[derive(Debug)]
pub(crate) struct RestShape {
    shapes: Vec<Shape>,
    /// Triangles that fill holes. Their rest shape is their present shape, as for the scaffold.
    filling: Vec<[VertexId; 3]>,
    /// Area of the surface, in units of the scaled mesh.
    area: f64,
}

#[derive(Debug)]
struct Shape {
    corners: [VertexId; 3],
    flat: [DVec2; 3],
    /// Share of the surface's area.
    share: f64,
}

#[derive(Clone, Copy)]
pub(crate) struct Surrounded<'a> {
    pub(crate) embedding: &'a Embedding,
    pub(crate) outside: &'a Scaffold,
    /// Weight of the scaffold, relative to the mesh with weight 1.
    pub(crate) weight: f64,
}

impl RestShape {
    /// Rest shapes of the real faces.
    pub(crate) fn new(mesh: &DiskMesh) -> Self {
        Self::of(mesh, mesh.real_faces().map(|face| (mesh.face(face), 1.0)))
    }

    /// Rest shapes of the faces and of the triangles at polygon corners, which together count with the polygon's area.
    /// Polygons stay convex while none of these triangles folds. `None` if there are no such corners.
    pub(crate) fn with_ears(mesh: &DiskMesh) -> Option<Self> {
        let mut parts = vec![1.0; mesh.face_count()];
        let can_be_convex = can_be_convex(mesh);
        let mut ears = Vec::new();
        for polygon in mesh.polygons() {
            let convex: Vec<[VertexId; 3]> =
                polygon.convex_ears().filter(|[_, v, _]| can_be_convex[v.index()]).collect();
            let of_ears: f64 = convex.iter().map(|&ear| area(mesh, ear)).sum();
            if of_ears <= 0.0 {
                continue;
            }
            // The four ears of a quad are the triangles of its two diagonals.
            let is_all = polygon.corners.len() == 4 && convex.len() == 4;
            let of_cut = if is_all { 0.0 } else { 0.5 };
            let whole: f64 = polygon.faces().map(|face| area(mesh, mesh.face(face))).sum();
            polygon.faces().for_each(|face| parts[face.index()] = of_cut);
            ears.extend(convex.into_iter().map(|ear| (ear, (1.0 - of_cut) * whole / of_ears)));
        }
        let faces =
            mesh.real_faces().map(|face| (mesh.face(face), parts[face.index()])).filter(|(_, part)| *part > 0.0);
        (!ears.is_empty()).then(|| Self::of(mesh, faces.chain(ears)))
    }

    /// Rest shapes of triangles, each with a factor of its area.
    fn of(mesh: &DiskMesh, triangles: impl Iterator<Item = ([VertexId; 3], f64)>) -> Self {
        let scale = length_scale(mesh);
        let triangles: Vec<([VertexId; 3], f64)> = triangles.collect();
        let shape = |&(corners, part): &([VertexId; 3], f64)| {
            let shape = Shape::new(mesh, scale, corners);
            Shape { share: part * shape.share, ..shape }
        };
        let mut shapes: Vec<Shape> = triangles.par_iter().with_min_len(TRIANGLES_PER_TASK).map(shape).collect();
        let area: f64 = shapes.iter().map(|shape| shape.share).sum();
        for shape in &mut shapes {
            shape.share /= area;
        }
        let filling = mesh.mesh().triangles[mesh.mesh().real_face_count()..].to_vec();
        Self { shapes, filling, area }
    }

    /// Distortion of an embedding whose pins are all at their targets. Computes the shapes twice, because memory for
    /// all of them would cost more time.
    pub(crate) fn progress_at_end(mesh: &DiskMesh, embedding: &Embedding) -> Progress {
        let (scale, faces) = (length_scale(mesh), mesh.mesh().real_triangles());
        let areas: Vec<f64> = measured_of(faces, |&corners| Shape::new(mesh, scale, corners).share);
        let area: f64 = areas.iter().sum();
        let element = element_beside(mesh, embedding, area);
        let measure = |&corners: &[VertexId; 3]| {
            let shape = Shape::new(mesh, scale, corners);
            let element = element(&Shape { share: shape.share / area, ..shape });
            let z = corners.map(|vertex| embedding[vertex]);
            (element.energy(z, Energy::SymmetricDirichlet), element.determinant(z))
        };
        progress_of(&measured_of(faces, measure))
    }

    /// Distortion of an embedding whose pins still have `distance_left` to go.
    pub(crate) fn progress(&self, mesh: &DiskMesh, embedding: &Embedding, distance_left: f64) -> Progress {
        let progress = self.progress_where(mesh, embedding, |_| true);
        Progress { distance_left, ..progress }
    }

    /// Distortion of the triangles with a vertex that is not a hard pin. No move of free vertices changes the other
    /// triangles.
    pub(crate) fn progress_of_movable(&self, mesh: &DiskMesh, embedding: &Embedding, pins: &Pins) -> Progress {
        let is_free = |corner: u32| pins.get(&VertexId::new(corner)).is_none_or(|pin| !pin.kind.is_hard());
        self.progress_where(mesh, embedding, |element| element.corners.into_iter().any(is_free))
    }

    fn progress_where(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        counts: impl Fn(&Element) -> bool + Sync,
    ) -> Progress {
        let measured = self.measured(mesh, embedding, |element, z| {
            let counted = counts(&element).then(|| element.energy(z, Energy::SymmetricDirichlet));
            counted.map_or((0.0, f64::INFINITY), |energy| (energy, element.determinant(z)))
        });
        progress_of(&measured)
    }

    /// Energy of an embedding, by rest shapes scaled to its area, of the triangles alone.
    pub(crate) fn energy(&self, mesh: &DiskMesh, embedding: &Embedding, energy: Energy) -> f64 {
        self.measured(mesh, embedding, |element, z| element.energy(z, energy)).iter().sum()
    }

    /// Number of elements of the mesh in the energy problem: triangles, and the filling of holes.
    pub(crate) fn element_count(&self) -> usize {
        self.shapes.len() + self.filling.len()
    }

    /// Number of folded triangles in an embedding.
    pub(crate) fn folded_count(&self, mesh: &DiskMesh, embedding: &Embedding) -> usize {
        let is_folded = self.measured(mesh, embedding, |element, z| element.determinant(z) <= 0.0);
        is_folded.into_iter().filter(|&is_folded| is_folded).count()
    }

    /// Builds the energy problem of the mesh, the filling of its holes and the scaffold, and returns it with all
    /// points.
    ///
    /// Hard pins are held; soft pins pull by springs. The points of the frame come last. An elimination order in
    /// `planning` must come from an earlier problem of this mesh with these pins.
    pub(crate) fn problem(
        &self,
        mesh: &DiskMesh,
        Surrounded { embedding, outside, weight }: Surrounded<'_>,
        pins: &Pins,
        planning: Planning<'_>,
    ) -> Result<(EnergyProblem, Vec<DVec2>), SolveError> {
        let mut points = embedding.to_vec();
        points.extend(&outside.frame);
        let mut elements = Vec::with_capacity(self.shapes.len() + self.filling.len() + outside.triangles.len());
        let element = element_beside(mesh, embedding, self.area);
        planning.control.extend(&mut elements, self.shapes.len(), |i| element(&self.shapes[i]))?;
        planning.control.go_on()?;
        let around = self.filling.iter().chain(&outside.triangles);
        elements.extend(outside_elements(around, &points, weight));
        let is_pulled = pins.values().any(|pin| !pin.kind.is_hard());
        let unit = if is_pulled { spring_unit(mesh, embedding) } else { 0.0 };
        planning.control.go_on()?;
        let springs = pins.iter().filter_map(|(vertex, pin)| match pin.kind {
            PinKind::Soft(weight) => {
                let stiffness = weight * weight * unit;
                Some(Spring { point: vertex.number(), target: pin.target, stiffness })
            }
            _ => None,
        });
        let count = u32::try_from(mesh.vertex_count()).expect("vertices fit");
        let is_hard = |vertex: VertexId| pins.get(&vertex).is_some_and(|pin| pin.kind.is_hard());
        let is_held = |point: u32| {
            let vertex = VertexId::new(point);
            point >= count || is_hard(vertex) || !mesh.is_used(vertex)
        };
        Ok((EnergyProblem::new(points.len(), elements, springs.collect(), is_held, planning)?, points))
    }

    /// Applies `of` to each triangle's element and its corners in an embedding. Builds no list of elements, because
    /// its memory would dominate.
    fn measured<T: Send>(
        &self,
        mesh: &DiskMesh,
        embedding: &Embedding,
        of: impl Fn(Element, [DVec2; 3]) -> T + Sync,
    ) -> Vec<T> {
        let element = element_beside(mesh, embedding, self.area);
        measured_of(&self.shapes, |shape| of(element(shape), shape.corners.map(|vertex| embedding[vertex])))
    }
}

impl Shape {
    /// Lays out a triangle in the plane, with its area as its share.
    fn new(mesh: &DiskMesh, scale: f64, corners: [VertexId; 3]) -> Self {
        let flat = mesh.rest_shape(corners, scale);
        Self { corners, flat, share: 0.5 * double_area(flat) }
    }
}

/// Element of a shape, with rest shapes scaled so that their total `area` equals the present area of the embedding.
fn element_beside(mesh: &DiskMesh, embedding: &Embedding, area: f64) -> impl Fn(&Shape) -> Element + Sync {
    let flat =
        measured_of(mesh.mesh().real_triangles(), |face| 0.5 * double_area(face.map(|vertex| embedding[vertex])));
    let scale = (flat.iter().sum::<f64>() / area).sqrt();
    move |shape| {
        Element::new(
            shape.corners.map(VertexId::number),
            shape.flat.map(|z| scale * z),
            Stiffness { weight: shape.share, thinnest: THINNEST },
        )
    }
}

fn measured_of<T: Sync, M: Send>(triangles: &[T], of: impl Fn(&T) -> M + Sync) -> Vec<M> {
    triangles.par_iter().with_min_len(TRIANGLES_PER_TASK).map(&of).collect()
}

/// Total energy and least determinant from the values of all triangles.
fn progress_of(measured: &[(f64, f64)]) -> Progress {
    let half: f64 = measured.iter().map(|(energy, _)| energy).sum();
    let least_determinant = measured.iter().map(|&(_, determinant)| determinant).fold(f64::INFINITY, f64::min);
    Progress { energy: 2.0 * half, least_determinant, distance_left: 0.0 }
}

/// Area of a triangle on the surface.
fn area(mesh: &DiskMesh, corners: [VertexId; 3]) -> f64 {
    let [a, b, c] = mesh.shape(corners);
    0.5 * (b - a).cross(c - a).length()
}

/// True for each vertex at which polygons can be convex. False for interior vertices of just two polygons, whose
/// angles sum to a full turn.
fn can_be_convex(mesh: &DiskMesh) -> Vec<bool> {
    let mut meeting = vec![0_u32; mesh.vertex_count()];
    let mut is_of_polygon = vec![false; mesh.face_count()];
    for polygon in mesh.polygons() {
        polygon.corners.iter().for_each(|v| meeting[v.index()] += 1);
        polygon.faces().for_each(|face| is_of_polygon[face.index()] = true);
    }
    for face in mesh.faces().filter(|face| !is_of_polygon[face.index()]) {
        mesh.face(face).iter().for_each(|v| meeting[v.index()] += 1);
    }
    mesh.vertices().map(|v| meeting[v.index()] != 2 || mesh.boundary_place(v).is_some()).collect()
}

/// Stiffness of weight 1: a vertex one mean edge away costs as much as its share of the surface.
fn spring_unit(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let mean = mean_edge_length(mesh, embedding);
    1.0 / (mean * mean * mesh.used_vertex_count() as f64)
}

pub(crate) fn mean_edge_length(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let length = |edge| {
        let [a, b] = mesh.ends(edge).map(|v| embedding[v]);
        a.distance(b)
    };
    mesh.edges().map(length).sum::<f64>() / mesh.edge_count() as f64
}
