//! Which neighbour a vertex may be moved onto, so that it is gone: the best of those that leave all triangles in order.
//!
//! A vertex v that moves onto its neighbour u takes two triangles with it, and the others at v become a fan from u. In the
//! plane all of the fan, the outside's part too, has to be positive, exactly: then surface and outside still cover the
//! frame once, and no edge is there twice. In space the fan's triangles must not be thin, nor turned away from those that
//! they stand for, and between space and plane they must not be much more distorted. Without an embedding, u and v must have
//! no other neighbours in common than the corners across from their edge.

use glam::{DVec2, DVec3};

use super::surface::{Guide, Ring, Surface};
use crate::geom::{Orientation, double_area, orientation};
use crate::mesh::VertexId;
use crate::nonlinear::foldover_energy::{Element, Energy, Stiffness};
use crate::nonlinear::rest_shape::{THINNEST, laid_flat};

/// Vertices with more neighbours stay.
const MOST_NEIGHBOURS: usize = 12;

/// The least quality of a new triangle, unless those before were worse: 1 is equilateral, 0 without area.
const LEAST_QUALITY: f64 = 0.25;

/// The least cosine between the normals of a new triangle and of those that it stands for.
const LEAST_COSINE: f64 = 0.2;

/// The most energy of a new triangle at the size of those before, or so many times their most. Undistorted it is 2.
const MOST_ENERGY: f64 = 6.0;
const MORE_ENERGY: f64 = 2.0;

/// A vertex and the neighbour that it is best moved onto.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Collapse {
    /// Those of low cost come first.
    pub(super) cost: f64,
    pub(super) vertex: u32,
    /// The neighbour's place in the ring.
    pub(super) onto: usize,
}

/// The triangles at a vertex.
struct Star {
    /// Sum of the vector areas in space, doubled.
    normal: DVec3,
    /// Sum of the areas in space, doubled.
    area: f64,
    /// Length in the plane by length in space.
    scale: f64,
    least_quality: f64,
    most_energy: f64,
}

impl Surface<'_> {
    /// The best way to take a vertex away, if there is any. No edge comes to be between two vertices that are kept: where
    /// these are to go, none may be.
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

    /// The least quality of the fan from a neighbour; `None` where that is not in order.
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

    /// Whether no edge of the fan from a neighbour is there already.
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

    /// 4√3 area / Σ side².
    fn quality(&self, face: [u32; 3]) -> f64 {
        let [a, b, c] = self.in_space(face);
        let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        if squares == 0.0 { 0.0 } else { 2.0 * 3_f64.sqrt() * (b - a).cross(c - a).length() / squares }
    }

    /// Half the symmetric Dirichlet energy of a triangle's map, at rest so many times as large as in space.
    fn energy(&self, face: [u32; 3], scale: f64) -> f64 {
        let flat = laid_flat(self.mesh.shape(face.map(VertexId::new))).map(|z| scale * z);
        Element::new([0, 1, 2], flat, Stiffness { weight: 1.0, thinnest: THINNEST })
            .energy(self.in_plane(face), Energy::SymmetricDirichlet)
    }
}
