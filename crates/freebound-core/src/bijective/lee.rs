//! Lee's virtual boundary: layers of triangles around the mesh, the outermost ring on a convex shape, peeled off
//! afterwards.
//!
//! # Method
//!
//! Each layer adds a ring with as many vertices as the boundary. Ring 0 is the boundary. Each vertex of ring k + 1
//! belongs to an edge of ring k. A layer is therefore a strip of triangles that point outwards and inwards in turn:
//!
//! ```text
//!    v₀ ────── v₁ ────── v₂        ring k + 1
//!   ╱  ╲      ╱  ╲      ╱  ╲
//! b₀    ╲    ╱    ╲    ╱    ╲
//!   ╲─── b₁ ────── b₂ ────── b₃    ring k
//! ```
//!
//! The outermost ring lies on a convex shape. Every other vertex, of the mesh and of the inner rings, is a weighted
//! mean of its neighbours. No edge joins two vertices of the outermost ring except the edges of the ring itself. If
//! the weights are positive, the padded mesh is therefore planar by the theorem of Tutte and Floater, and so is the
//! mesh without padding. Mean-value and equal weights are always positive; conformal, Wachspress and power weights may
//! be negative.
//!
//! The boundary of the mesh is free, but the padding pulls on it. A planar mesh is not reproduced, not even one with a
//! convex boundary (paper §1.1).
//!
//! # Shapes of the padding
//!
//! All weights except equal ones depend on shapes. A virtual triangle has its shape on a straight strip of height h:
//! the edges of a ring in a row, each vertex of the next ring above the middle of its edge.
//!
//! ```text
//! l(vᵢ vᵢ₊₁) = ½ (l(bᵢ bᵢ₊₁) + l(bᵢ₊₁ bᵢ₊₂))        l(bᵢ vᵢ) = l(bᵢ₊₁ vᵢ) = √(¼ l(bᵢ bᵢ₊₁)² + h²)
//! ```
//!
//! with h of an equilateral triangle on the boundary's mean edge. Each triangle has its own shape; the shapes need not
//! fit together around the mesh, so the boundary may have any form.
//!
//! Source: Y. Lee, H. S. Kim, S. Lee, "Mesh Parameterization with a Virtual Boundary", 2002. The triangulation and the
//! shapes of the layers are our own: symmetric, so that no direction along the boundary is preferred.

use std::time::Instant;

use glam::{DVec2, DVec3};

use crate::linalg::Kind;
use crate::linear::convex::{boundary_lengths, on_shape};
use crate::linear::fixed_solve::FixedSolve;
use crate::linear::system::{FreeSystem, Site};
use crate::mesh::{DiskMesh, FIRST_HOLE, TriMesh, VertexId, triangle_of_sides};
use crate::nonlinear::Scaffold;
use crate::problem::{
    Control, Embedding, Family, Phase, PhaseSeconds, PinPositions, Pins, Settings, Solution, SolveError,
};
use crate::weights::corner_weights::{Corner, three_point_weights};
use crate::weights::equations::{Equations, length_scale, sum_corners_of, uniform};
use crate::weights::shape_preserving::shape_preserving_of;

/// Height of a layer, relative to the boundary's mean edge: height of an equilateral triangle.
const HEIGHT: f64 = 0.866_025_403_784_438_6;

/// A mesh with layers of virtual triangles around it.
#[derive(Debug)]
pub struct Padded<'a> {
    mesh: &'a DiskMesh,
    /// Mesh and padding. Virtual vertices follow the mesh vertices, ring by ring; virtual faces follow the mesh faces.
    disk: DiskMesh,
    /// Length of the edge from each vertex to the next, for each ring from the boundary outwards.
    lengths: Vec<Vec<f64>>,
    height: f64,
}

/// Vertex of a ring: number of the ring (0 is the boundary), and place within the ring.
#[derive(Clone, Copy)]
struct OnRing {
    ring: usize,
    place: usize,
}

impl<'a> Padded<'a> {
    /// Surrounds a mesh with `layers` layers of virtual triangles, at least one.
    ///
    /// # Panics
    ///
    /// If there are more than 2³¹ virtual faces.
    pub fn new(mesh: &'a DiskMesh, layers: usize) -> Self {
        let layers = layers.max(1);
        let boundary = mesh.boundary_loop();
        let count = boundary.len();
        let vertex = |ring: usize, place: usize| match ring {
            0 => boundary[place % count],
            ring => VertexId::from_index(mesh.vertex_count() + (ring - 1) * count + place % count),
        };
        let strip = |ring: usize| {
            (0..count).flat_map(move |place| {
                let [here, next] = [place, place + 1].map(|place| vertex(ring, place));
                let [above, beyond] = [place, place + 1].map(|place| vertex(ring + 1, place));
                [[here, above, next], [next, above, beyond]]
            })
        };
        let triangles = mesh.mesh().triangles.iter().copied().chain((0..layers).flat_map(strip)).collect();
        // Positions of virtual vertices are arbitrary: their triangles have prescribed shapes.
        let mut positions = mesh.mesh().positions.clone();
        for _ in 0..layers {
            positions.extend(boundary.iter().map(|&v| mesh.position(v)));
        }
        let real = mesh.mesh().real_face_count();
        let of_mesh = mesh.faces().map(|face| mesh.mesh().polygon(face));
        // Faces that fill holes keep their polygon numbers; each padding face gets a number of its own.
        let first = of_mesh.clone().skip(real).max().map_or(FIRST_HOLE, |last| last + 1);
        let of_padding = (first..).take(2 * count * layers);
        let polygon_of = Some(of_mesh.chain(of_padding).collect());
        let disk = DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of })
            .expect("rings around a disk make a disk again");
        let mut lengths = vec![boundary_lengths(mesh)];
        let mean = lengths[0].iter().sum::<f64>() / count as f64;
        for ring in 0..layers {
            let below = &lengths[ring];
            lengths.push((0..count).map(|place| f64::midpoint(below[place], below[(place + 1) % count])).collect());
        }
        Self { mesh, disk, lengths, height: HEIGHT * mean }
    }

    /// Mesh and padding as one disk. Positions of virtual vertices in space are meaningless.
    pub fn disk(&self) -> &DiskMesh {
        &self.disk
    }

    /// Ring and place of a vertex of the padding or of the boundary.
    fn on_ring(&self, vertex: VertexId) -> Option<OnRing> {
        let count = self.lengths[0].len();
        match vertex.index().checked_sub(self.mesh.vertex_count()) {
            Some(number) => Some(OnRing { ring: 1 + number / count, place: number % count }),
            None => self.mesh.boundary_place(vertex).map(|place| OnRing { ring: 0, place }),
        }
    }

    /// Length of an edge of the padding.
    fn length(&self, ends: [VertexId; 2]) -> f64 {
        let [Some(a), Some(b)] = ends.map(|end| self.on_ring(end)) else { return self.mesh.length(ends) };
        let lengths = &self.lengths[a.ring.min(b.ring)];
        if a.ring == b.ring {
            let follows = b.place == (a.place + 1) % lengths.len();
            return lengths[if follows { a.place } else { b.place }];
        }
        let above = if a.ring > b.ring { a.place } else { b.place };
        (0.5 * lengths[above]).hypot(self.height)
    }

    /// Triangle whose shape determines the weights of three vertices.
    pub fn shape(&self, corners: [VertexId; 3]) -> [DVec3; 3] {
        let is_real = corners.iter().all(|corner| corner.index() < self.mesh.vertex_count());
        if is_real {
            return self.mesh.shape(corners);
        }
        let [a, b, c] = corners;
        triangle_of_sides([[a, b], [b, c], [c, a]].map(|ends| self.length(ends)))
    }

    /// Equations of all vertices inside the outermost ring.
    ///
    /// # Errors
    ///
    /// [`SolveError::NotFinite`] if a weight overflows; [`SolveError::Cancelled`].
    pub fn equations(&self, family: Family, control: Control<'_>) -> Result<Equations<f64>, SolveError> {
        let scale = length_scale(self.mesh);
        let shape = |corners| self.shape(corners).map(|x| x * scale);
        match family.power() {
            Some(power) => {
                let weights = |corner| three_point_weights(&Corner::at(corner), power);
                sum_corners_of(&self.disk, shape, weights, control)
            }
            None if family == Family::Uniform => Ok(uniform(&self.disk)),
            None => Ok(shape_preserving_of(&self.disk, &shape)),
        }
    }

    /// Positions of the outermost ring.
    fn places(&self, settings: &Settings) -> Result<PinPositions, SolveError> {
        let shape = settings.method.boundary_shape().cloned().unwrap_or_default();
        let outermost = self.lengths.len() - 1;
        let count = self.lengths[0].len();
        let first = self.mesh.vertex_count() + (outermost - 1) * count;
        let places = on_shape(self.mesh, &self.lengths[outermost], &shape, settings.spacing)?;
        Ok((first..).map(VertexId::from_index).zip(places).collect())
    }

    /// Solves for mesh and padding with the shape, spacing and family of `settings`. Returns the embedding of the
    /// mesh, and the padding around it.
    ///
    /// # Errors
    ///
    /// If the shape does not fit the boundary, the system cannot be solved, or the caller cancels.
    pub fn solve(&self, settings: &Settings, control: Control<'_>) -> Result<(Solution, Scaffold), SolveError> {
        control.enter(Phase::Assemble)?;
        let start = Instant::now();
        let places = self.places(settings)?;
        let equations = self.equations(settings.family(), control)?;
        let system = FreeSystem::new(&self.disk, |v| places.contains_key(&v), control)?;
        let site = Site { mesh: &self.disk, system: &system };
        let assemble = start.elapsed().as_secs_f64();
        control.enter(Phase::Analyze)?;
        let start = Instant::now();
        let analysis = system.analysis(Kind::General, control)?;
        let analyze = start.elapsed().as_secs_f64();
        control.enter(Phase::Factor)?;
        let start = Instant::now();
        let solve = FixedSolve::new(site, equations, &analysis, control)?;
        let factor = start.elapsed().as_secs_f64();
        control.enter(Phase::Solve)?;
        let start = Instant::now();
        let (solved, residual) = solve.solve(site, &places, control)?;
        let linear = Some(solve.numbers(site, &solved, residual, control)?);
        let seconds = PhaseSeconds { assemble, analyze, factor, solve: start.elapsed().as_secs_f64() };
        let embedding = Embedding::of_mesh(self.mesh, &solved);
        let frame: Vec<DVec2> = solved[self.mesh.vertex_count()..].to_vec();
        let triangles = self.disk.mesh().triangles[self.mesh.face_count()..].to_vec();
        let solution =
            Solution { embedding, pins: Pins::new(), gauge_completed: true, linear, convergence: None, seconds };
        Ok((solution, Scaffold { frame, triangles }))
    }
}
