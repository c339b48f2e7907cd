//! Collapse of a vertex onto a neighbour: the best neighbour for which all triangles stay valid.
//!
//! Moving a vertex v onto its neighbour u removes two triangles; the other triangles at v become a fan from u. In the
//! plane all triangles of the fan, also those of the outside, must be positive, exactly. Then surface and outside
//! still cover the frame once, and no edge is doubled. In space the triangles of the fan must be neither thin nor
//! turned away from those that they replace. Their distortion from space to plane must not grow much. Without an
//! embedding, u and v must have no common neighbours except the corners opposite their edge.

use glam::{DVec2, DVec3};

use super::surface::{Guide, Ring, Surface};
use crate::geom::{Orientation, double_area, orientation};
use crate::mesh::{THINNEST, VertexId, laid_flat};
use crate::nonlinear::foldover_energy::{Element, Energy, Stiffness};

/// Most neighbours of a vertex that can be removed.
const MOST_NEIGHBOURS: usize = 12;

/// Least quality of a new triangle, unless a replaced one was worse. Quality is 1 for equilateral triangles, 0 without
/// area.
const LEAST_QUALITY: f64 = 0.25;

/// Least cosine between the normals of a new triangle and of the replaced triangles.
const LEAST_COSINE: f64 = 0.2;

/// Largest energy of a new triangle at the scale of the replaced ones. The energy without distortion is 2.
const MOST_ENERGY: f64 = 6.0;
/// Largest ratio of the energy of a new triangle to the largest energy of the replaced ones, if that allows more.
const MORE_ENERGY: f64 = 2.0;

/// Vertex with the best neighbour to move it onto.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Collapse {
    /// Lower costs come first.
    pub(super) cost: f64,
    pub(super) vertex: u32,
    /// Place of the neighbour in the ring.
    pub(super) onto: usize,
}

/// Triangles at a vertex.
struct Star {
    /// Sum of the vector areas in space, doubled.
    normal: DVec3,
    /// Sum of the areas in space, doubled.
    area: f64,
    /// Length in the plane per length in space.
    scale: f64,
    least_quality: f64,
    most_energy: f64,
}

impl Surface<'_> {
    /// Best collapse of a vertex, if any. No collapse creates an edge between two kept vertices: at their targets,
    /// such an edge may be impossible.
    pub(super) fn best_collapse(&self, vertex: u32, kept: &[bool], ring: &mut Ring) -> Option<Collapse> {
        if kept[vertex as usize] || !self.find_ring(vertex, ring) || ring.len() > MOST_NEIGHBOURS {
            return None;
        }
        let star = self.star(vertex, ring);
        let places = if ring.is_of_boundary() { vec![0, ring.inner] } else { (0..ring.len()).collect() };
        let mut best: Option<(f64, usize)> = None;
        for onto in places {
            let joins_kept = |by: usize| kept.get(ring.at(onto + by) as usize) == Some(&true);
            if kept[ring.at(onto) as usize] && (2..ring.len() - 1).any(joins_kept) {
                continue;
            }
            if let Some(quality) = self.quality_onto(onto, ring, &star)
                && best.is_none_or(|(most, _)| quality > most)
            {
                best = Some((quality, onto));
            }
        }
        let (quality, onto) = best?;
        Some(Collapse { cost: star.area / quality, vertex, onto })
    }

    fn star(&self, vertex: u32, ring: &Ring) -> Star {
        let faces = || (0..ring.inner).map(|k| [vertex, ring.at(k), ring.at(k + 1)]);
        let (normal, area) = faces().fold((DVec3::ZERO, 0.0), |(normal, area), face| {
            let of_face = self.double_area_vector(face);
            (normal + of_face, area + of_face.length())
        });
        let flat: f64 = faces().map(|face| double_area(self.in_plane(face))).sum();
        let scale = (flat / area).sqrt();
        let least_quality = faces().map(|face| self.quality(face)).fold(1.0, f64::min);
        let most_energy = faces().map(|face| self.energy(face, scale)).fold(0.0, f64::max);
        Star { normal, area, scale, least_quality, most_energy }
    }

    /// Least quality of the fan from a neighbour. `None` if a triangle of the fan is not valid.
    fn quality_onto(&self, onto: usize, ring: &Ring, star: &Star) -> Option<f64> {
        let u = ring.at(onto);
        let sides = (1..ring.len() - 1).map(|by| (onto + by) % ring.len());
        if self.guide == Guide::Space && !self.leaves_edges_apart(onto, ring) {
            return None;
        }
        let is_positive = |side: usize| {
            let [a, b, c] = self.in_plane([u, ring.at(side), ring.at(side + 1)]);
            orientation(a, b, c) == Some(Orientation::CounterClockwise)
        };
        if self.guide == Guide::Plane && !sides.clone().all(is_positive) {
            return None;
        }
        let most_energy = MOST_ENERGY.max(MORE_ENERGY * star.most_energy);
        let least_quality = LEAST_QUALITY.min(star.least_quality);
        let mut worst = 1.0_f64;
        for side in sides.filter(|&side| side < ring.inner) {
            let face = [u, ring.at(side), ring.at(side + 1)];
            let normal = self.double_area_vector(face);
            let is_turned = normal.dot(star.normal) < LEAST_COSINE * normal.length() * star.normal.length();
            worst = worst.min(self.quality(face));
            let is_distorted = self.guide == Guide::Plane && self.energy(face, star.scale) > most_energy;
            if is_turned || worst < least_quality || worst == 0.0 || is_distorted {
                return None;
            }
        }
        Some(worst)
    }

    /// True if no edge of the fan from a neighbour exists already.
    fn leaves_edges_apart(&self, onto: usize, ring: &Ring) -> bool {
        let is_next = |place: usize| {
            let apart = place.abs_diff(onto);
            apart <= 1 || (!ring.is_of_boundary() && apart == ring.len() - 1)
        };
        (0..ring.len()).filter(|&place| !is_next(place)).all(|place| !self.are_joined(ring.at(onto), ring.at(place)))
    }

    fn in_plane(&self, face: [u32; 3]) -> [DVec2; 3] {
        face.map(|v| self.points[v as usize])
    }

    fn in_space(&self, face: [u32; 3]) -> [DVec3; 3] {
        face.map(|v| self.mesh.position(VertexId::new(v)))
    }

    fn double_area_vector(&self, face: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.in_space(face);
        (b - a).cross(c - a)
    }

    /// Quality of a triangle in space: 4√3 area / Σ side².
    fn quality(&self, face: [u32; 3]) -> f64 {
        let [a, b, c] = self.in_space(face);
        let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        if squares == 0.0 { 0.0 } else { 2.0 * 3_f64.sqrt() * (b - a).cross(c - a).length() / squares }
    }

    /// Symmetric Dirichlet energy, halved, of a triangle's map from its shape in space scaled by `scale`.
    fn energy(&self, face: [u32; 3], scale: f64) -> f64 {
        let flat = laid_flat(self.mesh.shape(face.map(VertexId::new))).map(|z| scale * z);
        Element::new([0, 1, 2], flat, Stiffness { weight: 1.0, thinnest: THINNEST })
            .energy(self.in_plane(face), Energy::SymmetricDirichlet)
    }
}
