//! Charts in true size, with their outlines and cutting lines.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{EdgeStrain, PatternError, PatternOptions};
use freebound_core::flatten::true_area_factor;
use freebound_core::geom::{OffsetOptions, offset_outward};
use freebound_core::mesh::{Refinement, VertexId};
use freebound_core::pipeline::LaidChart;
use freebound_core::problem::Embedding;

/// Largest distance between an arc of a cutting line and its chords, millimetres.
const ARC_TOLERANCE: f64 = 0.01;

/// Position of a vertex in the file, as bits: cuts and joins keep positions.
pub(super) type PlaceKey = [u64; 3];

/// Side of a piece: an edge of the surface.
#[derive(Clone, Debug)]
pub(super) struct PieceSide {
    /// Positions of the ends on the surface.
    pub(super) ends: [PlaceKey; 2],
    /// Line on the sheet from end to end, with new vertices between them.
    pub(super) line: Vec<DVec2>,
    /// Length on the surface, millimetres.
    pub(super) length: f64,
}

/// Chart in true size.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Number of the chart.
    pub(super) number: usize,
    /// Boundary loops, the outer one first and counter-clockwise, holes clockwise.
    pub(super) loops: Vec<Vec<PieceSide>>,
    /// Lines to cut along.
    pub(super) cut: Vec<Vec<DVec2>>,
    pub(super) strain: EdgeStrain,
}

impl Piece {
    /// Corners of each boundary loop.
    pub(super) fn outlines(&self) -> Vec<Vec<DVec2>> {
        let corners = |side: &PieceSide| side.line[..side.line.len() - 1].to_vec();
        self.loops.iter().map(|sides| sides.iter().flat_map(corners).collect()).collect()
    }

    /// Moves the piece.
    pub(super) fn moved(mut self, place: impl Fn(DVec2) -> DVec2) -> Self {
        let lines = self.loops.iter_mut().flatten().map(|side| &mut side.line).chain(&mut self.cut);
        for point in lines.flatten() {
            *point = place(*point);
        }
        self
    }
}

/// Pieces of all charts.
pub(super) fn pieces_of(
    charts: &[LaidChart<'_>],
    aspect: f64,
    options: PatternOptions,
) -> Result<Vec<Piece>, PatternError> {
    let made: Vec<Result<Piece, PatternError>> =
        charts.par_iter().enumerate().map(|(number, chart)| piece(number, chart, aspect, options)).collect();
    made.into_iter().collect()
}

fn piece(number: usize, chart: &LaidChart<'_>, aspect: f64, options: PatternOptions) -> Result<Piece, PatternError> {
    if !chart.verdict.planar {
        return Err(PatternError::NotPlanar(number));
    }
    let plane: Embedding = chart.coordinates.iter().map(|uv| *uv * DVec2::new(aspect, 1.0)).collect();
    let of_unit = chart.mesh.unit() * options.unit.millimetres();
    let scale = true_area_factor(chart.mesh, &plane) * of_unit;
    let flip = if area_of(chart, &plane) < 0.0 { -1.0 } else { 1.0 };
    let placed: Embedding = plane.iter().map(|z| *z * DVec2::new(flip * scale, scale)).collect();
    if !placed.iter().all(|z| z.is_finite()) || !of_unit.is_finite() {
        return Err(PatternError::NotFinite(number));
    }
    let surface = |vertex: VertexId| chart.mesh.position(vertex) * of_unit;
    let rims = chart.mesh.mesh().holes().into_iter().map(|hole| hole.rim.into_iter().rev().collect::<Vec<_>>());
    let loops = std::iter::once(chart.mesh.boundary_loop().to_vec()).chain(rims);
    let loops = loops.map(|line| sides_of(&line, chart.refinement, &placed, surface)).collect();
    let strain = strain_of(chart, &placed, surface);
    let piece = Piece { number, loops, cut: Vec::new(), strain };
    let outlines = piece.outlines();
    let cut = if options.allowance > 0.0 {
        let offset = OffsetOptions {
            distance: options.allowance,
            joins: options.joins.of_offset(),
            tolerance: ARC_TOLERANCE.min(options.allowance / 10.0),
        };
        offset_outward(&outlines, offset).ok_or(PatternError::NoAllowance(number))?
    } else {
        outlines
    };
    Ok(Piece { cut, ..piece })
}

/// Twice the signed area of the faces of a chart.
fn area_of(chart: &LaidChart<'_>, plane: &Embedding) -> f64 {
    let area = |face| {
        let [a, b, c] = chart.mesh.face(face).map(|vertex| plane[vertex]);
        (b - a).perp_dot(c - a)
    };
    chart.mesh.real_faces().map(area).sum()
}

/// Sides of a boundary loop. A side runs from a vertex of the file to the next one.
fn sides_of(
    line: &[VertexId],
    refinement: Option<&Refinement>,
    placed: &Embedding,
    surface: impl Fn(VertexId) -> DVec3,
) -> Vec<PieceSide> {
    let is_old = |vertex: &VertexId| refinement.is_none_or(|of| vertex.index() < of.old_vertex_count());
    let first = line.iter().position(is_old).unwrap_or(0);
    let turned: Vec<VertexId> = line[first..].iter().chain(&line[..=first]).copied().collect();
    let mut sides = Vec::new();
    let mut start = 0;
    for end in 1..turned.len() {
        if !is_old(&turned[end]) && end + 1 < turned.len() {
            continue;
        }
        let run = &turned[start..=end];
        let ends = [run[0], run[run.len() - 1]].map(&surface);
        let length = run.windows(2).map(|pair| surface(pair[0]).distance(surface(pair[1]))).sum();
        let line = run.iter().map(|&vertex| placed[vertex]).collect();
        sides.push(PieceSide { ends: ends.map(key_of), line, length });
        start = end;
    }
    sides
}

/// Bits of a position. Both zeros are one.
fn key_of(position: DVec3) -> PlaceKey {
    position.to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}

fn strain_of(chart: &LaidChart<'_>, placed: &Embedding, surface: impl Fn(VertexId) -> DVec3) -> EdgeStrain {
    let mesh = chart.mesh;
    let changes = mesh.edges().filter(|&edge| !mesh.is_virtual_edge(edge)).filter_map(|edge| {
        let [a, b] = mesh.ends(edge);
        let change = placed[a].distance(placed[b]) / surface(a).distance(surface(b)) - 1.0;
        change.is_finite().then_some(change)
    });
    let strain = |change: f64| EdgeStrain { least: change, most: change };
    changes.map(strain).reduce(EdgeStrain::union).unwrap_or_default()
}
