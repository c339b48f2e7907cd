//! Region that moves with dragged pins: its energy, and the longest step.

use std::collections::HashMap;

use crate::parallel::prelude::*;
use crate::parallel::reduce;
use glam::DVec2;

use super::proof::MovedRegion;
use super::scaffold::LocalScaffold;
use crate::geom::double_area;
use crate::mesh::{DiskMesh, FaceId, THINNEST, VertexId};
use crate::nonlinear::energy_problem::{EnergyProblem, Planning, Spring};
use crate::nonlinear::foldover_energy::{Element, Stiffness};
use crate::nonlinear::scaffold::THINNEST as THINNEST_OUTSIDE;
use crate::problem::{Control, Embedding, PinKind, Pins, SolveError};
use crate::verify::UvFrame;

/// Weight of the whole outside, relative to that of the mesh.
const OUTSIDE_WEIGHT: f64 = 0.02;

/// Least thickness, height to longest side. Thinner triangles are measured as if they had it.
const LEAST_THICKNESS: f64 = 1e-12;

/// Share of its rest area that every triangle keeps. Making more room is left to the flattener.
const LEAST_AREA: f64 = 0.01;

/// Share of the longest step that is taken at once.
const ADVANCE_SHARE: f64 = 0.8;

/// Triangles that share the work of one task.
const TRIANGLES_PER_TASK: usize = 1024;

/// Rest shapes of the faces of a region. Fillings of holes and the outside rest as they lie.
#[derive(Clone, Copy)]
pub(super) enum FaceRest<'a> {
    /// Positions at the start of the drag.
    Begin,
    /// Triangles of the surface, their lengths scaled by this factor.
    Surface(f64),
    /// Positions at the start of the drag, each triangle scaled by a factor at its middle.
    Scaled(&'a dyn Fn(DVec2) -> f64),
}

/// Embedding in which a region is to move.
#[derive(Clone, Copy)]
pub(super) struct Ground<'a> {
    pub(super) mesh: &'a DiskMesh,
    /// Embedding at the start of the drag.
    pub(super) begin: &'a Embedding,
    pub(super) rest: FaceRest<'a>,
    pub(super) embedding: &'a Embedding,
    pub(super) pins: &'a Pins,
    pub(super) dragged: &'a [VertexId],
    pub(super) around: Option<&'a LocalScaffold>,
    /// Twice the area of the faces.
    pub(super) double_area: f64,
    /// Stiffness of a spring of weight 1.
    pub(super) spring_unit: f64,
}

/// Vertices that move with dragged pins, and all their triangles.
#[derive(Debug)]
pub(super) struct Patch {
    /// Free vertices first, then dragged hard pins, then the held points around them. Numbers beyond the mesh's
    /// vertices are points of the frame.
    points: Vec<VertexId>,
    free_count: usize,
    moving_count: usize,
    /// Size of the neighbourhood, held pins included.
    nearest_count: usize,
    /// Corners as places in `points`: faces and ears of polygons, then fillings of holes, then the outside.
    triangles: Vec<[u32; 3]>,
    face_count: usize,
    inside_count: usize,
    /// Twice the area that each triangle is to keep.
    floors: Vec<f64>,
    problem: EnergyProblem,
    /// Positions of the points.
    z: Vec<DVec2>,
    has_boundary: bool,
}

/// Longest admissible step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Share of the step that is taken.
    pub(super) share: f64,
    /// Triangle that limits the step.
    pub(super) end: usize,
}

/// Triangles of a patch, with their numbers by kind.
#[derive(Default)]
struct Gathered {
    corners: Vec<[VertexId; 3]>,
    face_count: usize,
    inside_count: usize,
}

impl Ground<'_> {
    fn is_hard(&self, vertex: VertexId) -> bool {
        self.pins.get(&vertex).is_some_and(|pin| pin.kind.is_hard())
    }

    /// True if a vertex can move at all. Boundary vertices can move only if there is an outside.
    fn is_movable(&self, vertex: VertexId) -> bool {
        self.mesh.is_used(vertex) && (self.around.is_some() || self.mesh.boundary_place(vertex).is_none())
    }

    /// Rest position of a point: its position at the start of the drag, or at the triangulation of the outside.
    fn at_rest(&self, corner: VertexId, is_outside: bool) -> DVec2 {
        match self.around {
            Some(around) if is_outside => around.at_rest(self.mesh, corner),
            _ => self.begin[corner],
        }
    }

    /// Rest shape of a triangle. Kind 0: faces and ears; 1: fillings of holes; 2: the outside.
    fn rest_of(&self, corners: [VertexId; 3], kind: usize) -> [DVec2; 3] {
        let begin = corners.map(|corner| self.at_rest(corner, kind == 2));
        match self.rest {
            FaceRest::Surface(scale) if kind == 0 => self.mesh.rest_shape(corners, scale),
            FaceRest::Scaled(factor) if kind == 0 => {
                let factor = factor(begin.iter().sum::<DVec2>() / 3.0);
                begin.map(|z| factor * z)
            }
            _ => begin,
        }
    }

    fn place(&self, corner: VertexId) -> DVec2 {
        let of_frame = || self.around.map(|around| around.frame[corner.index() - self.mesh.vertex_count()]);
        self.embedding.get(corner.index()).copied().or_else(of_frame).unwrap_or_default()
    }

    /// All triangles at vertices that move.
    fn triangles_at(&self, moving: &[VertexId], is_moving: impl Fn(VertexId) -> bool) -> Gathered {
        let mesh = self.mesh;
        let faces_at = |&v: &VertexId| mesh.outgoing(v).filter_map(|halfedge| mesh.face_of(halfedge));
        let mut faces: Vec<FaceId> = moving.iter().flat_map(faces_at).collect();
        faces.sort_unstable();
        faces.dedup();
        let filling = faces.split_off(faces.partition_point(|&face| !mesh.is_virtual(face)));
        let mut corners: Vec<[VertexId; 3]> = faces.iter().map(|&face| mesh.face(face)).collect();
        // Faces of one polygon are consecutive.
        let mut last = None;
        for polygon in faces.iter().filter_map(|&face| mesh.polygon_of(face)) {
            if last != Some(polygon.first_face) {
                last = Some(polygon.first_face);
                corners.extend(polygon.convex_ears().filter(|ear| ear.iter().any(|&v| is_moving(v))));
            }
        }
        let face_count = corners.len();
        corners.extend(filling.iter().map(|&face| mesh.face(face)));
        let inside_count = corners.len();
        if let Some(around) = self.around {
            let mut numbers: Vec<u32> = moving.iter().flat_map(|&v| around.at(mesh, v)).copied().collect();
            numbers.sort_unstable();
            numbers.dedup();
            corners.extend(numbers.iter().map(|&number| around.triangles[number as usize]));
        }
        Gathered { corners, face_count, inside_count }
    }
}

impl Patch {
    /// Builds the patch of the vertices nearest to the dragged pins. `similar` is a patch of an equal neighbourhood
    /// with another outside; its elimination order is reused.
    pub(super) fn new(ground: &Ground<'_>, nearest: &[VertexId], similar: Option<&Self>) -> Result<Self, SolveError> {
        let is_free = |v: &VertexId| ground.is_movable(*v) && !ground.is_hard(*v);
        let mut points: Vec<VertexId> = nearest.iter().copied().filter(is_free).collect();
        let free_count = points.len();
        points.extend(ground.dragged.iter().filter(|&&v| ground.is_movable(v) && ground.is_hard(v)));
        let moving_count = points.len();
        let mut place_of: HashMap<VertexId, u32> = points.iter().copied().zip(0..).collect();
        let gathered = ground.triangles_at(&points, |v| place_of.contains_key(&v));
        let mut place = |corner: VertexId| {
            *place_of.entry(corner).or_insert_with(|| {
                points.push(corner);
                u32::try_from(points.len() - 1).expect("points fit")
            })
        };
        let triangles: Vec<[u32; 3]> = gathered.corners.iter().map(|corners| corners.map(&mut place)).collect();
        let (elements, floors) = elements(ground, &gathered, &triangles);
        let springs = springs(ground, &points[..free_count]);
        let is_held = |point: u32| point as usize >= free_count;
        // A neighbourhood is small, so its analysis needs no cancellation.
        let order = similar.and_then(|similar| similar.problem.order());
        let planning = Planning { order: order.as_ref(), control: Control::unattended() };
        let problem = EnergyProblem::new(points.len(), elements, springs, is_held, planning)?;
        let z = points.iter().map(|&point| ground.place(point)).collect();
        let has_boundary = points[..moving_count].iter().any(|&v| ground.mesh.boundary_place(v).is_some());
        let Gathered { face_count, inside_count, .. } = gathered;
        Ok(Self {
            points,
            free_count,
            moving_count,
            nearest_count: nearest.len(),
            triangles,
            face_count,
            inside_count,
            floors,
            problem,
            z,
            has_boundary,
        })
    }

    /// Vertices that move.
    pub(super) fn moving(&self) -> &[VertexId] {
        &self.points[..self.moving_count]
    }

    /// Size of the neighbourhood, held pins included.
    pub(super) fn nearest_count(&self) -> usize {
        self.nearest_count
    }

    pub(super) fn problem(&self) -> &EnergyProblem {
        &self.problem
    }

    pub(super) fn z(&self) -> &[DVec2] {
        &self.z
    }

    /// Accepts positions that are proved.
    pub(super) fn take(&mut self, z: Vec<DVec2>) {
        self.z = z;
    }

    /// Sets the targets of the springs.
    pub(super) fn aim_springs(&mut self, target_of: impl Fn(VertexId) -> DVec2) {
        let points = &self.points;
        self.problem.aim_springs(|point| target_of(points[point as usize]));
    }

    /// Prescribed moves of the dragged hard pins; zero for all other points.
    pub(super) fn shift(&self, of: impl Fn(VertexId, DVec2) -> DVec2) -> Vec<DVec2> {
        let mut shift = vec![DVec2::ZERO; self.points.len()];
        let own = self.free_count..self.moving_count;
        for (shift, (&point, &z)) in
            shift[own.clone()].iter_mut().zip(self.points[own.clone()].iter().zip(&self.z[own]))
        {
            *shift = of(point, z);
        }
        shift
    }

    /// Puts the dragged hard pins on their targets.
    pub(super) fn put_on(&self, z: &mut [DVec2], target: impl Fn(VertexId) -> Option<DVec2>) {
        let own = self.free_count..self.moving_count;
        for (z, &point) in z[own.clone()].iter_mut().zip(&self.points[own]) {
            *z = target(point).unwrap_or(*z);
        }
    }

    /// Share of `moves` that is taken at once: 1 if no triangle is crushed within 1.25 times the moves.
    pub(super) fn room(&self, moves: &[DVec2]) -> Room {
        let of = |(at, triangle): (usize, &[u32; 3])| {
            let [z, by] = [&self.z, moves].map(|all| triangle.map(|corner| all[corner as usize]));
            let floor = self.floors[at].min(0.5 * double_area(z));
            (Element::longest_step_above(floor, z, by), at)
        };
        let shorter = |a: (f64, usize), b: (f64, usize)| if (b.0, b.1) < (a.0, a.1) { b } else { a };
        let all = self.triangles.par_iter().enumerate().with_min_len(TRIANGLES_PER_TASK);
        let (longest, end) = reduce(all.map(of), || (f64::INFINITY, usize::MAX), shorter);
        Room { share: (ADVANCE_SHARE * longest).min(1.0), end }
    }

    /// True if a triangle belongs to the outside.
    pub(super) fn is_outside(&self, triangle: usize) -> bool {
        triangle >= self.inside_count
    }

    /// Corners of a triangle with their positions.
    pub(super) fn corners_of(&self, triangle: usize) -> Option<[(VertexId, DVec2); 3]> {
        let corners = self.triangles.get(triangle)?;
        Some(corners.map(|corner| (self.points[corner as usize], self.z[corner as usize])))
    }

    /// Points that are held around the patch, with their positions.
    pub(super) fn held(&self) -> impl Iterator<Item = (VertexId, DVec2)> + '_ {
        self.points.iter().copied().zip(self.z.iter().copied()).skip(self.moving_count)
    }

    /// Moved region with the points at `z`, for its proof.
    pub(super) fn moved(&self, mesh: &DiskMesh, z: &[DVec2], sheet: &UvFrame) -> MovedRegion<'_> {
        let written =
            |(&v, &z): (&VertexId, &DVec2)| sheet.written_place((v.index() < mesh.vertex_count()).then_some(v), z);
        MovedRegion {
            faces: &self.triangles[..self.face_count],
            filling: &self.triangles[self.face_count..self.inside_count],
            outside: &self.triangles[self.inside_count..],
            has_boundary: self.has_boundary,
            is_outside_positive: false,
            places: self.points.iter().zip(z).map(written).collect(),
        }
    }

    /// Mean deformation of the faces at the rim of the patch; 0 for rest shapes. Only held points that a larger patch
    /// would move count as rim (`is_rim`).
    pub(super) fn strain_at_rim(&self, is_rim: impl Fn(VertexId) -> bool) -> f64 {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (element, corners) in self.problem.elements().iter().zip(&self.triangles[..self.face_count]) {
            let is_at_rim =
                |corner: &u32| *corner as usize >= self.moving_count && is_rim(self.points[*corner as usize]);
            if corners.iter().any(is_at_rim) {
                let (alpha, beta) = element.derivatives(corners.map(|corner| self.z[corner as usize]));
                sum += element.weight() * ((alpha - DVec2::X).length_squared() + beta.length_squared());
                weight += element.weight();
            }
        }
        if weight > 0.0 { (sum / weight).sqrt() } else { 0.0 }
    }
}

/// Elements of the triangles with their rest shapes, and twice the area that each triangle is to keep.
fn elements(ground: &Ground<'_>, gathered: &Gathered, triangles: &[[u32; 3]]) -> (Vec<Element>, Vec<f64>) {
    let outside = ground.around.map_or(0.0, |around| OUTSIDE_WEIGHT / around.double_area);
    let kinds = [
        Stiffness { weight: 1.0 / ground.double_area, thinnest: THINNEST },
        Stiffness { weight: OUTSIDE_WEIGHT / ground.double_area, thinnest: THINNEST_OUTSIDE },
        Stiffness { weight: outside, thinnest: THINNEST_OUTSIDE },
    ];
    let of = |(at, (corners, &local)): (usize, (&[VertexId; 3], &[u32; 3]))| {
        let kind = usize::from(at >= gathered.face_count) + usize::from(at >= gathered.inside_count);
        let rest = ground.rest_of(*corners, kind);
        let per_area = kinds[kind];
        let area = double_area(rest).max(0.0);
        let weight = per_area.weight * area * softness(rest, per_area.thinnest);
        (Element::new(local, rest, Stiffness { weight, thinnest: LEAST_THICKNESS }), LEAST_AREA * area)
    };
    gathered.corners.iter().zip(triangles).enumerate().map(of).unzip()
}

/// Factor that softens a triangle thinner than `thinnest`, height to longest side. The triangle is as soft as if it
/// had that thickness, but keeps its rest shape.
fn softness([a, b, c]: [DVec2; 3], thinnest: f64) -> f64 {
    let longest = [b - a, c - b, a - c].iter().map(|side| side.length_squared()).fold(0.0, f64::max);
    (double_area([a, b, c]) / (thinnest * longest)).min(1.0).powi(2)
}

/// Springs of the soft pins among free vertices, slack at the start of the drag.
fn springs(ground: &Ground<'_>, free: &[VertexId]) -> Vec<Spring> {
    let spring = |(point, vertex): (u32, &VertexId)| match ground.pins.get(vertex)?.kind {
        PinKind::Soft(weight) => {
            Some(Spring { point, target: ground.begin[vertex], stiffness: weight * weight * ground.spring_unit })
        }
        _ => None,
    };
    (0..).zip(free).filter_map(spring).collect()
}
