//! The virtual boundary: the outside of an embedding is triangulated up to a convex polygon, and mesh and outside are
//! embedded together (paper §5).
//!
//! # Theorem
//!
//! The extended mesh is a triangulated disk. With its boundary on a convex polygon and positive weights, every face is
//! positive (Tutte 1963, Floater 2003), provided that the disk is simplicial and that no interior edge joins two
//! vertices of one side of the polygon. Mean-value weights are positive, and reproduce a planar embedding.
//!
//! # If the hull is not enough
//!
//! A pocket's edge may join two vertices that the mesh itself joins: a dividing edge, or the base of a flap that is
//! folded inward. The double edge would collapse the faces beside it. A dividing edge may also lie on a side of the
//! hull. In these cases the outside is triangulated up to a strictly convex frame around the hull, and every doubled
//! edge is split by a virtual vertex. The frame's vertices and the virtual vertices are removed afterwards, as are the
//! virtual faces.

use std::collections::BTreeSet;

use glam::DVec2;
use num_complex::Complex;

use crate::geom::{Bounds, Orientation, orientation};
use crate::linalg::Kind;
use crate::linear::fixed_solve::FixedSolve;
use crate::linear::system::{FreeSystem, Site};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::scaffold::{disk_in_plane, triangles_around};
use crate::problem::{Control, Embedding, LinearSolve, Phase, SolveError};
use crate::weights::equations::Equations;

/// Corners of the frame, relative to half the extent of the boundary: an octagon whose corner angles are far from
/// straight.
const FRAME: [DVec2; 8] = [
    DVec2::new(3.0, -1.5),
    DVec2::new(3.0, 1.5),
    DVec2::new(1.5, 3.0),
    DVec2::new(-1.5, 3.0),
    DVec2::new(-3.0, 1.5),
    DVec2::new(-3.0, -1.5),
    DVec2::new(-1.5, -3.0),
    DVec2::new(1.5, -3.0),
];

/// Outer limit of the triangulated outside of an embedding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// The convex hull of the boundary (paper §5).
    Hull,
    /// A frame around the hull.
    Frame,
}

/// Intermediate results of paper §5, for display. Vertices numbered beyond those of the mesh are virtual.
#[derive(Clone, Debug, PartialEq)]
pub struct VirtualBoundary {
    /// Number of boundary vertices by which the previous embedding was pinned.
    pub pinned: usize,
    /// Outer limit of the triangulated outside.
    pub outline: Outline,
    /// Embedding before the joint solve, with the virtual vertices at its end.
    pub before: Embedding,
    /// True if the weights are mean-value weights of `before`. Other weights are the last resort if rounding collapses
    /// faces.
    pub weights_of_before: bool,
    /// Vertices of the convex outline B′, counter-clockwise.
    pub hull: Vec<VertexId>,
    /// Faces between the boundary and the outline.
    pub pockets: Vec<[VertexId; 3]>,
    /// Mesh and outside after the joint solve.
    pub solved: Embedding,
}

/// Embedding together with its outside: E′ of the paper.
#[derive(Debug)]
pub struct Extended {
    /// Mesh and outside as one disk.
    pub disk: DiskMesh,
    /// Outer limit of the triangulated outside.
    pub outline: Outline,
    /// Embedding of mesh and outside, the virtual vertices last.
    pub embedding: Embedding,
    /// Faces between the boundary and the outline.
    pub pockets: Vec<[VertexId; 3]>,
}

impl Extended {
    /// Extends an embedding with a simple, positively oriented boundary up to the hull, else up to a frame. `None` if
    /// both fail.
    pub fn new(mesh: &DiskMesh, embedding: &Embedding) -> Option<Self> {
        Self::up_to_hull(mesh, embedding).or_else(|| Self::up_to_frame(mesh, embedding))
    }

    /// Extends an embedding up to its hull. `None` if its boundary is not simple or Tutte's theorem does not apply.
    pub fn up_to_hull(mesh: &DiskMesh, embedding: &Embedding) -> Option<Self> {
        let pockets = triangles_around(mesh, &embedding.boundary(mesh), &[])?;
        let extended = Self::join(mesh, Outline::Hull, embedding.clone(), pockets)?;
        (!extended.has_edge_along_outline()).then_some(extended)
    }

    /// Extends an embedding up to a frame. `None` if its boundary is not simple.
    pub fn up_to_frame(mesh: &DiskMesh, embedding: &Embedding) -> Option<Self> {
        let boundary = embedding.boundary(mesh);
        let bounds = Bounds::of(boundary.iter().copied());
        let (centre, half) = (bounds.middle(), bounds.size().max_element() / 2.0);
        let frame = FRAME.map(|corner| centre + half * corner);
        let mut pockets = triangles_around(mesh, &boundary, &frame)?;
        let mut positions = embedding.to_vec();
        positions.extend(frame);
        split_doubled_edges(mesh, &mut positions, &mut pockets);
        Self::join(mesh, Outline::Frame, positions.into(), pockets)
    }

    fn join(mesh: &DiskMesh, outline: Outline, embedding: Embedding, pockets: Vec<[VertexId; 3]>) -> Option<Self> {
        let triangles = mesh.mesh().triangles.iter().chain(&pockets).copied().collect();
        let disk = disk_in_plane(&embedding, triangles)?;
        Some(Self { disk, outline, embedding, pockets })
    }

    /// True if an interior edge lies on a side of the outline, which Tutte's theorem excludes.
    fn has_edge_along_outline(&self) -> bool {
        let outline = self.disk.boundary_loop();
        let at = |v: VertexId| self.embedding[v];
        self.disk.dividing_edges().iter().any(|&[u, v]| {
            let Some(place) = self.disk.boundary_place(u) else { return false };
            let beside = [place + 1, place + outline.len() - 1].map(|p| outline[p % outline.len()]);
            beside.iter().any(|&w| orientation(at(u), at(w), at(v)) == Some(Orientation::Collinear))
        })
    }

    /// Solves equations of mesh and outside for the move from `start`, with the outline fixed. `residuals` holds the
    /// residuals at `start`, per vertex of the disk, if more accurate ones than direct evaluation are known.
    ///
    /// # Errors
    ///
    /// If the system cannot be solved, or the caller cancels.
    pub fn solve(
        &self,
        equations: Equations<f64>,
        start: &Embedding,
        residuals: Option<&[Complex<f64>]>,
        control: Control<'_>,
    ) -> Result<(Embedding, LinearSolve), SolveError> {
        let system = FreeSystem::new(&self.disk, |v| self.disk.boundary_place(v).is_some(), control)?;
        let site = Site { mesh: &self.disk, system: &system };
        let residual_of = |v: &VertexId| match residuals {
            Some(residuals) => residuals[v.index()],
            None => equations.residual_of(&self.disk, start, *v),
        };
        let residuals: Vec<DVec2> = system.free().iter().map(residual_of).map(|z| DVec2::new(z.re, z.im)).collect();
        control.enter(Phase::Analyze)?;
        let analysis = system.analysis(Kind::General, control)?;
        control.enter(Phase::Factor)?;
        let solve = FixedSolve::new(site, equations, &analysis, control)?;
        control.enter(Phase::Solve)?;
        let (embedding, residual) = solve.solve_from(site, start, &residuals, control)?;
        let numbers = solve.numbers(site, &embedding, residual, control)?;
        Ok((embedding, numbers))
    }
}

/// Splits each pocket edge that is also an interior edge of the mesh at its middle.
fn split_doubled_edges(mesh: &DiskMesh, positions: &mut Vec<DVec2>, pockets: &mut Vec<[VertexId; 3]>) {
    let key = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
    let sides = |t: [VertexId; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let edges: BTreeSet<[VertexId; 2]> = pockets.iter().flat_map(|&t| sides(t)).map(|(a, b)| key(a, b)).collect();
    let both = mesh.dividing_edges().iter().map(|&[a, b]| key(a, b)).filter(|edge| edges.contains(edge));
    let doubled: Vec<[VertexId; 2]> = both.collect();
    for [a, b] in doubled {
        let has_edge = |t: &[VertexId; 3]| sides(*t).iter().any(|&(u, v)| key(u, v) == [a, b]);
        let (split, mut kept): (Vec<_>, Vec<_>) = pockets.iter().copied().partition(has_edge);
        let middle = VertexId::from_index(positions.len());
        positions.push(positions[a.index()].midpoint(positions[b.index()]));
        for triangle in split {
            for end in [a, b] {
                kept.push(triangle.map(|v| if v == end { middle } else { v }));
            }
        }
        *pockets = kept;
    }
}
