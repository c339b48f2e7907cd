//! The faces as they lie in space, each laid into the plane: the shapes that an embedding's faces are measured by.

use glam::{DVec2, DVec3};

use super::equations::length_scale;
use super::foldover_energy::{Element, Energy};
use super::membrane::{Membrane, Spring};
use super::outside::outside_elements;
use super::{Embedding, Hold, Outside, Pins, Progress, SolveError};
use crate::mesh::{DiskMesh, VertexId};

/// Faces that are thinner, height to longest side, are measured as if they were so thick.
const THINNEST: f64 = 1e-4;

/// The faces as they lie in space, each laid into the plane.
#[derive(Debug)]
pub(super) struct Rest {
    triangles: Vec<[DVec2; 3]>,
    /// Share of each face in the surface.
    shares: Vec<f64>,
    area: f64,
}

#[derive(Clone, Copy)]
pub(super) struct Surrounded<'a> {
    pub(super) embedding: &'a Embedding,
    pub(super) outside: &'a Outside,
    /// How much the outside weighs, where the mesh weighs 1.
    pub(super) weight: f64,
}

impl Rest {
    pub(super) fn new(mesh: &DiskMesh) -> Self {
        let scale = length_scale(mesh);
        let flat = |face| laid_flat(mesh.mesh().corners(face).map(|x| scale * x));
        let triangles: Vec<[DVec2; 3]> = mesh.faces().map(flat).collect();
        let areas = triangles.iter().map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a));
        let area: f64 = areas.clone().sum();
        let shares = areas.map(|part| part / area).collect();
        Self { triangles, shares, area }
    }

    /// How distorted an embedding is whose pins have so far to go.
    pub(super) fn progress(&self, mesh: &DiskMesh, embedding: &Embedding, distance_left: f64) -> Progress {
        let elements = self.elements(mesh, embedding);
        let placed = || elements.iter().map(|element| (element, element.corners.map(|c| embedding[c as usize])));
        let half: f64 = placed().map(|(element, z)| element.energy(z, Energy::SymmetricDirichlet)).sum();
        let least_determinant = placed().map(|(element, z)| element.determinant(z)).fold(f64::INFINITY, f64::min);
        Progress { energy: 2.0 * half, least_determinant, distance_left }
    }

    /// Mesh and outside of an embedding with its exact pins held and the others on springs; and all points, those of the
    /// frame last. `similar` is one made before for the same mesh and pins.
    pub(super) fn membrane(
        &self,
        mesh: &DiskMesh,
        Surrounded { embedding, outside, weight }: Surrounded<'_>,
        pins: &Pins,
        similar: Option<&Membrane>,
    ) -> Result<(Membrane, Vec<DVec2>), SolveError> {
        let mut points = embedding.to_vec();
        points.extend(&outside.frame);
        let mut elements = self.elements(mesh, embedding);
        elements.extend(outside_elements(outside, &points, weight));
        let is_pulled = pins.values().any(|pin| !pin.hold.is_exact());
        let unit = if is_pulled { spring_unit(mesh, embedding) } else { 0.0 };
        let springs = pins.iter().filter_map(|(vertex, pin)| match pin.hold {
            Hold::Weighted(weight) => {
                let stiffness = weight * weight * unit;
                Some(Spring { point: vertex.number(), target: pin.target, stiffness })
            }
            _ => None,
        });
        let count = u32::try_from(mesh.vertex_count()).expect("vertices fit");
        let is_exact = |vertex: VertexId| pins.get(&vertex).is_some_and(|pin| pin.hold.is_exact());
        let is_held = |point: u32| point >= count || is_exact(VertexId::new(point));
        Ok((Membrane::new(points.len(), elements, springs.collect(), is_held, similar)?, points))
    }

    /// The faces' energies, at rest when as large as the embedding is now.
    fn elements(&self, mesh: &DiskMesh, embedding: &Embedding) -> Vec<Element> {
        let flat: f64 = mesh
            .faces()
            .map(|face| {
                let [a, b, c] = embedding.corners(mesh, face);
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum();
        let scale = (flat / self.area).sqrt();
        let numbers = |face| mesh.face(face).map(VertexId::number);
        mesh.faces()
            .zip(&self.triangles)
            .zip(&self.shares)
            .map(|((face, shape), &share)| Element::new(numbers(face), shape.map(|z| scale * z), (share, THINNEST)))
            .collect()
    }
}

/// The stiffness of weight 1: a vertex that is one mean edge away costs as much as its share of the surface.
fn spring_unit(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let mean = mean_edge_length(mesh, embedding);
    1.0 / (mean * mean * mesh.vertex_count() as f64)
}

pub(super) fn mean_edge_length(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    let length = |edge| {
        let [a, b] = mesh.ends(edge).map(|v| embedding[v]);
        a.distance(b)
    };
    mesh.edges().map(length).sum::<f64>() / mesh.edge_count() as f64
}

/// A triangle of space in the plane, its first side along the x-axis.
fn laid_flat([a, b, c]: [DVec3; 3]) -> [DVec2; 3] {
    let (first, second) = (b - a, c - a);
    let length = first.length();
    if length == 0.0 {
        return [DVec2::ZERO, DVec2::ZERO, DVec2::new(second.length(), 0.0)];
    }
    let along = first.dot(second) / length;
    [DVec2::ZERO, DVec2::new(length, 0.0), DVec2::new(along, first.cross(second).length() / length)]
}
