//! Bijective continuation: from a planar embedding without the constraints to one that meets them, one-to-one at every
//! step (rung 4 of the ladder).
//!
//! The mesh lies in an outside that is triangulated up to a frame. The pins jump toward their targets, mesh and outside
//! follow, and what folds on the way is unfolded with the pins held where they are. A jump that cannot be unfolded is
//! halved; after every jump that can, the outside is triangulated again. While all triangles are unfolded the boundary
//! is simple, and the embedding is one-to-one; every step is accepted by the exact verdict alone.
//!
//! Sources: the outside is the paper's virtual boundary (§5), kept up as in Z. Jiang, S. Schaefer, D. Panozzo,
//! "Simplicial complex augmentation framework for bijective maps", 2017; the energy is that of the module
//! `foldover_energy`.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::foldover_energy::Element;
use super::membrane::{Descent, Limits, Membrane, Spring};
use super::{Control, Hold, Outside, Pins, Places, Progress, SolveError, verdict};
use crate::geom::outside_triangles;
use crate::mesh::{DiskMesh, VertexId};

/// Points on each side of the frame.
const FRAME_POINTS: u32 = 8;

/// Faces and triangles of the outside that are thinner, height to longest side, are measured as if they were so thick.
const THINNEST: [f64; 2] = [1e-4, 0.1];

/// Size of the frame, relative to everything within.
const FRAME_SIZE: f64 = 2.0;

/// Weight of the whole outside, that of the mesh being 1: while pins move, and while the embedding relaxes.
const OUTSIDE_WEIGHT: [f64; 2] = [0.02, 0.002];

/// The smallest jump, as a share of the way that is left.
const SMALLEST_JUMP: f64 = 1.0 / 1024.0;

/// Newton steps to unfold a jump, and to settle after it.
const UNFOLD_STEPS: usize = 60;
const SETTLE_STEPS: usize = 6;

/// The least share of the energy that a Newton step must gain to be followed by another.
const TOLERANCE: f64 = 1e-4;

/// A one-to-one embedding on its way.
#[derive(Debug)]
pub(super) struct Continuation {
    rest: Rest,
    pins: Pins,
    embedding: Vec<DVec2>,
    /// Share of the way left that is tried next.
    jump: f64,
}

/// A state on the way, accepted by the verdict.
#[derive(Debug)]
pub(super) struct Accepted {
    pub(super) embedding: Vec<DVec2>,
    pub(super) progress: Progress,
    pub(super) outside: Arc<Outside>,
}

/// The faces as they lie in space, each laid into the plane.
#[derive(Debug)]
pub(super) struct Rest {
    triangles: Vec<[DVec2; 3]>,
    /// Share of each face in the surface.
    shares: Vec<f64>,
    area: f64,
}

impl Rest {
    /// Lays every face into the plane.
    pub(super) fn new(mesh: &DiskMesh) -> Self {
        let triangles: Vec<[DVec2; 3]> = mesh.faces().map(|face| laid_flat(mesh.mesh().corners(face))).collect();
        let areas = triangles.iter().map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a));
        let area: f64 = areas.clone().sum();
        let shares = areas.map(|part| part / area).collect();
        Self { triangles, shares, area }
    }

    /// The faces' energies, at rest when as large as the embedding is now.
    fn elements(&self, mesh: &DiskMesh, embedding: &[DVec2]) -> Vec<Element> {
        let flat: f64 = mesh
            .faces()
            .map(|face| {
                let [a, b, c] = mesh.face(face).map(|v| embedding[v.index()]);
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum();
        let scale = (flat / self.area).sqrt();
        let numbers = |face| mesh.face(face).map(VertexId::number);
        mesh.faces()
            .zip(&self.triangles)
            .zip(&self.shares)
            .map(|((face, shape), &share)| Element::new(numbers(face), shape.map(|z| scale * z), (share, THINNEST[0])))
            .collect()
    }
}

/// A triangle of space in the plane, its first side along the x-axis.
fn laid_flat([a, b, c]: [DVec3; 3]) -> [DVec2; 3] {
    let (u, v) = (b - a, c - a);
    let length = u.length();
    if length == 0.0 {
        return [DVec2::ZERO, DVec2::ZERO, DVec2::new(v.length(), 0.0)];
    }
    let along = u.dot(v) / length;
    [DVec2::ZERO, DVec2::new(length, 0.0), DVec2::new(along, u.cross(v).length() / length)]
}

/// The frame around points: a square with its corners and points between them, counter-clockwise.
fn frame_around(points: impl Iterator<Item = DVec2> + Clone) -> Vec<DVec2> {
    let low = points.clone().fold(DVec2::INFINITY, DVec2::min);
    let high = points.fold(DVec2::NEG_INFINITY, DVec2::max);
    let (centre, half) = (low.midpoint(high), 0.5 * FRAME_SIZE * (high - low).max_element());
    let corners = [DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    let side = |k: usize| {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        (0..FRAME_POINTS).map(move |i| from.lerp(to, f64::from(i) / f64::from(FRAME_POINTS)))
    };
    (0..4).flat_map(side).map(|z| centre + half * z).collect()
}

/// The outside of an embedding with a simple boundary, up to a frame around it and further points.
pub(super) fn outside_of(
    mesh: &DiskMesh,
    embedding: &[DVec2],
    further: impl Iterator<Item = DVec2> + Clone,
) -> Option<Outside> {
    let boundary: Vec<DVec2> = mesh.boundary_loop().iter().map(|&v| embedding[v.index()]).collect();
    let frame = frame_around(boundary.iter().copied().chain(further));
    let vertex = |corner: u32| {
        let corner = corner as usize;
        let beyond = || VertexId::from_index(embedding.len() + corner - boundary.len());
        mesh.boundary_loop().get(corner).copied().unwrap_or_else(beyond)
    };
    let triangles = outside_triangles(&boundary, &frame)?.into_iter().map(|t| t.map(vertex)).collect();
    Some(Outside { frame, triangles })
}

/// The outside's energies, at rest as it lies.
fn outside_elements(outside: &Outside, points: &[DVec2], weight: f64) -> Vec<Element> {
    let shape = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let area = |[a, b, c]: [DVec2; 3]| (b - a).perp_dot(c - a);
    let total: f64 = outside.triangles.iter().map(|t| area(shape(t))).sum();
    let element = |t: &[VertexId; 3]| {
        Element::new(t.map(VertexId::number), shape(t), (weight * area(shape(t)) / total, THINNEST[1]))
    };
    outside.triangles.iter().map(element).collect()
}

impl Continuation {
    /// Begins at a planar embedding, wherever it lies.
    pub(super) fn new(mesh: &DiskMesh, embedding: Vec<DVec2>, pins: &Pins) -> Self {
        Self { rest: Rest::new(mesh), pins: pins.clone(), embedding, jump: 1.0 }
    }

    /// Where exact pins are to go.
    fn targets(&self) -> Places {
        let exact = self.pins.iter().filter(|(_, pin)| pin.hold.is_exact());
        exact.map(|(&vertex, pin)| (vertex, pin.target)).collect()
    }

    fn distance_left(&self) -> f64 {
        self.targets().iter().map(|(v, target)| self.embedding[v.index()].distance(*target)).fold(0.0, f64::max)
    }

    /// Whether every exact pin is on its target.
    pub(super) fn has_arrived(&self) -> bool {
        self.targets().iter().all(|(v, target)| self.embedding[v.index()] == *target)
    }

    /// Mesh and outside of the present embedding, with the pins held, and all points.
    fn membrane(&self, mesh: &DiskMesh, outside: &Outside, weight: f64) -> Result<(Membrane, Vec<DVec2>), SolveError> {
        let mut points = self.embedding.clone();
        points.extend(&outside.frame);
        let mut elements = self.rest.elements(mesh, &self.embedding);
        elements.extend(outside_elements(outside, &points, weight));
        let springs = self.pins.iter().filter_map(|(vertex, pin)| match pin.hold {
            Hold::Weighted(weight) => {
                Some(Spring { point: vertex.number(), target: pin.target, stiffness: weight * weight })
            }
            _ => None,
        });
        let targets = self.targets();
        let count = u32::try_from(mesh.vertex_count()).expect("vertices fit");
        let is_held = |point: u32| point >= count || targets.contains_key(&VertexId::new(point));
        Ok((Membrane::new(points.len(), elements, springs.collect(), is_held)?, points))
    }

    /// Goes on by one jump, as long as can be. `None` where not even the smallest one goes.
    pub(super) fn step(&mut self, mesh: &DiskMesh, control: Control<'_>) -> Result<Option<Accepted>, SolveError> {
        let targets = self.targets();
        let Some(outside) = outside_of(mesh, &self.embedding, targets.values().copied()) else { return Ok(None) };
        let outside = Arc::new(outside);
        let (membrane, points) = self.membrane(mesh, &outside, OUTSIDE_WEIGHT[0])?;
        while self.jump >= SMALLEST_JUMP {
            if let Some(least_determinant) = self.try_jump(mesh, (&membrane, &points), &targets, control)? {
                self.jump = (2.0 * self.jump).min(1.0);
                let energy = membrane.energy(&points, 0.0);
                let progress = Progress { energy, least_determinant, distance_left: self.distance_left() };
                return Ok(Some(Accepted { embedding: self.embedding.clone(), progress, outside }));
            }
            self.jump *= 0.5;
        }
        Ok(None)
    }

    /// Moves the pins by the present jump. Returns the smallest determinant where the embedding is then planar.
    fn try_jump(
        &mut self,
        mesh: &DiskMesh,
        (membrane, points): (&Membrane, &[DVec2]),
        targets: &Places,
        control: Control<'_>,
    ) -> Result<Option<f64>, SolveError> {
        let mut z = points.to_vec();
        let mut shift = vec![DVec2::ZERO; z.len()];
        for (v, target) in targets {
            shift[v.index()] = self.jump * (*target - z[v.index()]);
        }
        membrane.follow(&mut z, &shift, control)?;
        if self.jump >= 1.0 {
            for (v, target) in targets {
                z[v.index()] = *target;
            }
        }
        let limits = Limits { steps: UNFOLD_STEPS, until_unfolded: true, tolerance: TOLERANCE };
        let Descent { least_determinant, steps, .. } = membrane.descend(&mut z, limits, control)?;
        if std::env::var_os("FB_TRACE").is_some() {
            eprintln!("jump {} -> least {least_determinant:.3e} after {steps}", self.jump);
        }
        if least_determinant <= 0.0 {
            return Ok(None);
        }
        let limits = Limits { steps: SETTLE_STEPS, until_unfolded: false, tolerance: TOLERANCE };
        let Descent { least_determinant, .. } = membrane.descend(&mut z, limits, control)?;
        z.truncate(mesh.vertex_count());
        if !verdict(mesh, &z).planar {
            return Ok(None);
        }
        self.embedding = z;
        Ok(Some(least_determinant))
    }
}
