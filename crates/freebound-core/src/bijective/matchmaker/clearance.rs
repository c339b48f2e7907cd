//! Removal of new vertices with clearance: neighbours move so that a new vertex can be removed.
//!
//! If a new vertex cannot be removed in the present map, another position of its neighbours may permit it. The hole
//! that it leaves is triangulated as on the surface, and some of these triangles fold in the plane. A patch around the
//! hole is then unfolded by the foldover energy, with a barrier for all triangles that are not folded ("Foldover-free
//! maps in 50 lines of code", 2021). All vertices outside the patch stay.
//!
//! Removing vertices and moving those around them is an idea of H. Shen, Z. Jiang, D. Zorin, D. Panozzo, "Progressive
//! embedding", 2019.

use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_3;
use std::sync::Arc;

use glam::DVec2;

use super::Matched;
use super::retriangulate::{Hole, OUTSIDE, Patchwork, Triangle};
use super::simplify::{Parts, sides_of, without};
use super::triangulate::shortest_triangulation;
use crate::geom::{Orientation, double_area, orientation};
use crate::mesh::{DiskMesh, FaceId, THINNEST, VertexId, laid_flat};
use crate::nonlinear::energy_problem::{EnergyProblem, Limits, Planning, Unfolding};
use crate::nonlinear::foldover_energy::{Element, Energy, Stiffness, energy_of};
use crate::nonlinear::scaffold::{FRAME_POINTS, THINNEST as THINNEST_OUTSIDE, outside_of};
use crate::problem::{Control, Phase, Pins, SolveError};

/// Rings of triangles around a new vertex that move with it: a small patch first, then a larger one if that is not
/// enough.
const RINGS: [usize; 2] = [1, 2];

/// Newton steps to unfold a patch and lower its energy.
const STEPS: usize = 12;
/// Least relative gain of a Newton step that is followed by another.
const TOLERANCE: f64 = 1e-2;

/// Largest factor by which the energy of a patch may grow.
const HIGHER: f64 = 2.0;

/// Weight of an outside triangle, relative to a mesh triangle of mean size.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// Removes new vertices, moving their neighbours if necessary. Pins stay fixed, and the map stays one-to-one.
///
/// # Errors
///
/// If a linear solve fails, or the caller cancels.
pub fn with_clearance(
    mesh: &DiskMesh,
    matched: Matched,
    pins: &Pins,
    control: Control<'_>,
) -> Result<Matched, SolveError> {
    let Some(mut room) = Room::new(mesh, &matched, pins) else { return Ok(matched) };
    let mut waiting: BTreeSet<u32> = matched.refinement.disk().vertices().map(VertexId::number).collect();
    waiting.retain(|&v| room.is_new(v));
    while let Some(vertex) = waiting.pop_first() {
        control.enter(Phase::Solve)?;
        if let Some(around) = room.remove(vertex, control)? {
            waiting.extend(around.into_iter().filter(|&v| room.is_new(v)));
        }
    }
    room.into_matched(control)
}

/// Present state of the refined mesh with its outside.
struct Room<'a> {
    mesh: &'a DiskMesh,
    matched: &'a Matched,
    patchwork: Patchwork,
    /// Per vertex, true if it is fixed: pins and the frame.
    is_held: Vec<bool>,
    /// Length in the plane per length in space, as a mean.
    scale: f64,
    /// Mean area of a triangle in the plane.
    mean_area: f64,
    removed: BTreeSet<VertexId>,
}

/// Region that moves at once.
struct Patch {
    triangles: Vec<Triangle>,
    /// Corners of the triangles, ascending.
    points: Vec<u32>,
    /// Per point, true if it moves.
    is_free: Vec<bool>,
}

impl<'a> Room<'a> {
    fn new(mesh: &'a DiskMesh, matched: &'a Matched, pins: &Pins) -> Option<Self> {
        let (refinement, embedding) = (&matched.refinement, &matched.embedding);
        let disk = refinement.disk();
        let outside = outside_of(disk, embedding, std::iter::empty(), FRAME_POINTS)?;
        let places: Vec<DVec2> = embedding.iter().chain(&outside.frame).copied().collect();
        let of_mesh = disk.faces().map(|face| (disk.face(face), refinement.source_of(face).number()));
        let of_outside = outside.triangles.iter().map(|&corners| (corners, OUTSIDE));
        let triangle =
            |(corners, source): ([VertexId; 3], u32)| Triangle { corners: corners.map(VertexId::number), source };
        let triangles = of_mesh.chain(of_outside).map(triangle).collect();
        let count = disk.vertex_count();
        let is_held = (0..places.len()).map(|v| v >= count || pins.contains_key(&VertexId::from_index(v))).collect();
        let area_in_plane: f64 = disk.real_faces().map(|face| 0.5 * double_area(embedding.corners(disk, face))).sum();
        Some(Self {
            mesh,
            matched,
            patchwork: Patchwork::new(places, triangles),
            is_held,
            scale: (area_in_plane / disk.mesh().area()).sqrt(),
            mean_area: area_in_plane / disk.real_faces().len() as f64,
            removed: BTreeSet::new(),
        })
    }

    fn is_new(&self, vertex: u32) -> bool {
        (self.mesh.vertex_count()..self.matched.embedding.len()).contains(&(vertex as usize))
    }

    /// Removes a new vertex if possible. Returns its neighbours, some of which may have become removable.
    fn remove(&mut self, vertex: u32, control: Control<'_>) -> Result<Option<Vec<u32>>, SolveError> {
        let holes = self.patchwork.holes(vertex);
        let around: Vec<u32> = holes.iter().flat_map(|hole| hole.corners.iter().copied()).collect();
        let old: Vec<u32> = holes.iter().flat_map(|hole| hole.triangles.iter().copied()).collect();
        let filled: Option<Vec<Vec<Triangle>>> = holes.iter().map(|hole| self.filled(hole)).collect();
        let Some(filled) = filled else { return Ok(None) };
        let energies = RINGS.map(|rings| self.energy(&self.patch(&around, rings)));
        let new = self.patchwork.exchange(&old, filled.into_iter().flatten());
        let corners = new.iter().map(|&t| self.patchwork.triangle(t).corners);
        let folded: Vec<[u32; 3]> = corners.filter(|&corners| !self.is_positive(corners)).collect();
        let is_fixed = |corners: &[u32; 3]| corners.iter().all(|&v| self.is_held[v as usize]);
        let mut is_unfolded = folded.is_empty();
        if !folded.iter().any(is_fixed) {
            for (rings, before) in RINGS.into_iter().zip(energies) {
                is_unfolded = is_unfolded || self.unfolds(&self.patch(&around, rings), before, control)?;
            }
        }
        if !is_unfolded {
            self.patchwork.undo(&old, &new);
            return Ok(None);
        }
        self.removed.insert(VertexId::new(vertex));
        Ok(Some(around))
    }

    fn is_positive(&self, corners: [u32; 3]) -> bool {
        let [a, b, c] = corners.map(|v| self.patchwork.places[v as usize]);
        orientation(a, b, c) == Some(Orientation::CounterClockwise)
    }

    /// Triangles that cover a hole, none of them degenerate on the surface. All positive in the plane, if possible.
    fn filled(&self, hole: &Hole) -> Option<Vec<Triangle>> {
        self.filled_with(hole, |t| self.is_positive(t)).or_else(|| self.filled_with(hole, |_| true))
    }

    fn filled_with(&self, hole: &Hole, is_good: impl Fn([u32; 3]) -> bool) -> Option<Vec<Triangle>> {
        let Hole { source, corners, .. } = hole;
        let (disk, new_vertices) = (self.matched.refinement.disk(), self.matched.refinement.new_vertices());
        let face = (*source != OUTSIDE).then(|| FaceId::new(*source));
        let sides = |&v: &u32| face.map_or(0, |face| sides_of(self.mesh, new_vertices, face, VertexId::new(v)));
        let on: Vec<u8> = corners.iter().map(sides).collect();
        let length = |i: usize, j: usize| {
            let ends = [corners[i], corners[j]];
            if face.is_none() {
                let [a, b] = ends.map(|v| self.place(v));
                return a.distance_squared(b);
            }
            let [a, b] = ends.map(|v| disk.position(VertexId::new(v)));
            a.distance_squared(b)
        };
        let is_bad = |i: usize, j: usize, k: usize| {
            on[i] & on[j] & on[k] != 0 || !is_good([i, j, k].map(|corner| corners[corner]))
        };
        let triangles = shortest_triangulation(corners.len(), length, is_bad)?;
        Some(triangles.into_iter().map(|t| Triangle { corners: t.map(|i| corners[i]), source: *source }).collect())
    }

    fn place(&self, vertex: u32) -> DVec2 {
        self.patchwork.places[vertex as usize]
    }

    /// Patch of `rings` rings of triangles around vertices that move.
    fn patch(&self, around: &[u32], rings: usize) -> Patch {
        let is_free = |v: &u32| !self.is_held[*v as usize];
        let mut free: BTreeSet<u32> = around.iter().copied().filter(is_free).collect();
        let mut triangles = self.triangles_at(&free);
        for _ in 1..rings {
            free = triangles.iter().flat_map(|&t| self.patchwork.triangle(t).corners).filter(is_free).collect();
            triangles = self.triangles_at(&free);
        }
        let triangles: Vec<Triangle> = triangles.into_iter().map(|t| self.patchwork.triangle(t)).collect();
        let points: BTreeSet<u32> = triangles.iter().flat_map(|t| t.corners).collect();
        let points: Vec<u32> = points.into_iter().collect();
        let is_free = points.iter().map(|v| free.contains(v)).collect();
        Patch { triangles, points, is_free }
    }

    fn triangles_at(&self, vertices: &BTreeSet<u32>) -> BTreeSet<u32> {
        vertices.iter().flat_map(|&v| self.patchwork.at(v).iter().copied()).collect()
    }

    /// Element of each triangle of a patch. The rest shape of an outside or hole-filling triangle is its present
    /// shape; if it is folded, an equilateral triangle of its size.
    fn elements(&self, patch: &Patch) -> Vec<Element> {
        let disk = self.matched.refinement.disk();
        let element = |t: &Triangle| {
            let corners = t.corners.map(|v| patch.number_of(v));
            if t.source != OUTSIDE && !self.mesh.is_virtual(FaceId::new(t.source)) {
                let flat = laid_flat(t.corners.map(|v| disk.position(VertexId::new(v)))).map(|z| self.scale * z);
                return Element::new(
                    corners,
                    flat,
                    Stiffness { weight: 0.5 * double_area(flat) / self.mean_area, thinnest: THINNEST },
                );
            }
            let [a, b, c] = t.corners.map(|v| self.place(v));
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let equilateral = [DVec2::ZERO, DVec2::X, DVec2::from_angle(FRAC_PI_3)].map(|z| longest * z);
            let flat = if self.is_positive(t.corners) { [a, b, c] } else { equilateral };
            Element::new(corners, flat, Stiffness { weight: OUTSIDE_WEIGHT, thinnest: THINNEST_OUTSIDE })
        };
        patch.triangles.iter().map(element).collect()
    }

    fn places(&self, patch: &Patch) -> Vec<DVec2> {
        patch.points.iter().map(|&v| self.place(v)).collect()
    }

    fn energy(&self, patch: &Patch) -> f64 {
        energy_of(&self.elements(patch), &self.places(patch), Energy::SymmetricDirichlet)
    }

    /// Moves the points of a patch so that no triangle is folded. Returns true if that succeeds and the energy is at
    /// most [`HIGHER`] times `before`; otherwise nothing moves.
    fn unfolds(&mut self, patch: &Patch, before: f64, control: Control<'_>) -> Result<bool, SolveError> {
        let (elements, mut z) = (self.elements(patch), self.places(patch));
        let is_held = |point: u32| !patch.is_free[point as usize];
        let planning = Planning { order: None, control };
        let problem = EnergyProblem::new(z.len(), elements, Vec::new(), is_held, planning)?;
        let unfolding = Unfolding::BesideBarriers;
        let limits = Limits { unfolded: Energy::SymmetricDirichlet, steps: STEPS, unfolding, tolerance: TOLERANCE };
        match problem.descend(&mut z, limits, None, control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            // No descent direction except for rounding.
            Err(_) => return Ok(false),
            Ok(_) => {}
        }
        let is_positive = |t: &Triangle| {
            let [a, b, c] = t.corners.map(|v| z[patch.number_of(v) as usize]);
            orientation(a, b, c) == Some(Orientation::CounterClockwise)
        };
        let after = energy_of(problem.elements(), &z, Energy::SymmetricDirichlet);
        let is_sound = patch.triangles.iter().all(is_positive) && after <= HIGHER * before;
        if is_sound {
            for (&v, place) in patch.points.iter().zip(z) {
                self.patchwork.places[v as usize] = place;
            }
        }
        Ok(is_sound)
    }

    /// Result without the removed vertices.
    fn into_matched(self, control: Control<'_>) -> Result<Matched, SolveError> {
        let Self { mesh, matched, patchwork, removed, .. } = self;
        let mut parts = Parts::new();
        for triangle in patchwork.all().filter(|triangle| triangle.source != OUTSIDE) {
            parts.entry(FaceId::new(triangle.source)).or_default().push(triangle.corners.map(VertexId::new));
        }
        parts.retain(|&face, triangles| *triangles != [mesh.face(face)]);
        let embedding = patchwork.places[..matched.embedding.len()].iter().copied().collect();
        let matched = Matched { refinement: Arc::clone(&matched.refinement), embedding };
        without(mesh, &matched, &removed, parts, control)
    }
}

impl Patch {
    /// Place of a vertex among the points.
    fn number_of(&self, vertex: u32) -> u32 {
        let place = self.points.binary_search(&vertex).expect("a corner of the patch");
        u32::try_from(place).expect("points fit")
    }
}
