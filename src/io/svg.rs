//! The layout as a drawing: faces, edges, boundary, and what is wrong with it.

use std::io::{self, Write};

use glam::DVec2;

use crate::mesh::{DiskMesh, EdgeId, VertexId};
use crate::solver::{Step, Verdict, VirtualBoundary};

/// Longer side of the drawing without its margin, in SVG user units.
const SIZE: f64 = 1000.0;

/// Free space around it.
const MARGIN: f64 = 20.0;

/// What lies outside the boundary in a step of the virtual boundary.
struct Outside<'a> {
    /// Places of all vertices, the virtual ones last.
    positions: Vec<DVec2>,
    stages: &'a VirtualBoundary,
}

/// Draws an embedding, v upwards. Flipped faces are red, crossing boundary edges orange, overwound vertices magenta.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_svg(out: &mut impl Write, mesh: &DiskMesh, embedding: &[DVec2], verdict: &Verdict) -> io::Result<()> {
    write_layout(out, mesh, (embedding, verdict), None)
}

/// Draws a step as [`write_svg`] does; one of the virtual boundary with the outline it was solved with (the hull, as a
/// red line) and the pockets (green).
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_step_svg(out: &mut impl Write, mesh: &DiskMesh, step: &Step) -> io::Result<()> {
    let embedding = &step.solution.embedding;
    let outside = step.virtual_boundary.as_deref().map(|stages| {
        // The step's embedding may have been turned and scaled since it was solved; the outside goes with it.
        let fit = Similarity::between(&stages.solved[..embedding.len()], embedding);
        let positions = stages.solved.iter().map(|&z| fit.apply(z)).collect();
        Outside { positions, stages }
    });
    write_layout(out, mesh, (embedding, &step.verdict), outside.as_ref())
}

fn write_layout(
    out: &mut impl Write,
    mesh: &DiskMesh,
    (embedding, verdict): (&[DVec2], &Verdict),
    outside: Option<&Outside>,
) -> io::Result<()> {
    let frame = Frame::of(embedding.iter().chain(outside.iter().flat_map(|outside| &outside.positions)));
    let extent = frame.extent();
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.3} {:.3}" stroke-linejoin="round" fill="none">"#,
        extent.x + 2.0 * MARGIN,
        extent.y + 2.0 * MARGIN
    )?;
    // Thin enough that the faces of a fine mesh still show between the lines.
    let width = (0.2 * SIZE / (mesh.face_count() as f64).sqrt()).min(1.0);
    if let Some(outside) = &outside {
        write_pockets(out, outside, width, &frame)?;
    }
    let at = |v: VertexId| frame.place(embedding[v.index()]);
    write_faces(out, (mesh, verdict), width, &at)?;
    if let Some(outside) = &outside {
        write_hull(out, outside, width, &frame)?;
    }
    write!(out, r##"<path stroke="#e8700a" stroke-width="3" d=""##)?;
    for edge in verdict.boundary_crossings.iter().flatten() {
        write_edge(out, mesh, *edge, &at)?;
    }
    writeln!(out, r#""/>"#)?;
    for &vertex in &verdict.overwound_vertices {
        let DVec2 { x, y } = at(vertex);
        writeln!(out, r##"<circle cx="{x:.3}" cy="{y:.3}" r="5" stroke="#c026a8" stroke-width="2"/>"##)?;
    }
    writeln!(out, "</svg>")
}

/// Faces, inner edges, flipped faces, boundary.
fn write_faces(
    out: &mut impl Write,
    (mesh, verdict): (&DiskMesh, &Verdict),
    width: f64,
    at: &impl Fn(VertexId) -> DVec2,
) -> io::Result<()> {
    let outline: Vec<DVec2> = mesh.boundary_loop().iter().map(|&v| at(v)).collect();
    write!(out, r##"<path fill="#efece6" d=""##)?;
    write_closed(out, &outline)?;
    writeln!(out, r#""/>"#)?;
    write!(out, r##"<path stroke="#8a8680" stroke-width="{width:.4}" d=""##)?;
    for edge in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
        write_edge(out, mesh, edge, at)?;
    }
    writeln!(out, r#""/>"#)?;
    write!(out, r##"<path fill="#d92d3a" stroke="#d92d3a" stroke-width="{width:.4}" d=""##)?;
    for &face in &verdict.flipped_faces {
        write_closed(out, &mesh.face(face).map(at))?;
    }
    writeln!(out, r#""/>"#)?;
    write!(out, r##"<path stroke="#2c2b29" stroke-width="{:.4}" d=""##, 2.0 * width)?;
    write_closed(out, &outline)?;
    writeln!(out, r#""/>"#)
}

fn write_pockets(out: &mut impl Write, outside: &Outside, width: f64, frame: &Frame) -> io::Result<()> {
    let at = |v: VertexId| frame.place(outside.positions[v.index()]);
    write!(out, r##"<path class="pockets" fill="#cfe8d2" stroke="#3fa34d" stroke-width="{width:.4}" d=""##)?;
    for pocket in &outside.stages.pockets {
        write_closed(out, &pocket.map(at))?;
    }
    writeln!(out, r#""/>"#)
}

fn write_hull(out: &mut impl Write, outside: &Outside, width: f64, frame: &Frame) -> io::Result<()> {
    let outline: Vec<DVec2> = outside.stages.hull.iter().map(|v| frame.place(outside.positions[v.index()])).collect();
    write!(out, r##"<path class="hull" stroke="#c93a3a" stroke-width="{:.4}" d=""##, 3.0 * width)?;
    write_closed(out, &outline)?;
    writeln!(out, r#""/>"#)
}

fn write_edge(out: &mut impl Write, mesh: &DiskMesh, edge: EdgeId, at: &impl Fn(VertexId) -> DVec2) -> io::Result<()> {
    let [a, b] = mesh.ends(edge).map(at);
    write!(out, "M{:.3} {:.3}L{:.3} {:.3}", a.x, a.y, b.x, b.y)
}

fn write_closed(out: &mut impl Write, points: &[DVec2]) -> io::Result<()> {
    for (i, point) in points.iter().enumerate() {
        write!(out, "{}{:.3} {:.3}", if i == 0 { 'M' } else { 'L' }, point.x, point.y)?;
    }
    write!(out, "Z")
}

/// The map z ↦ factor·z + shift of complex numbers.
struct Similarity {
    factor: DVec2,
    shift: DVec2,
}

impl Similarity {
    /// The one that takes points nearest to others, in the sense of least squares.
    fn between(from: &[DVec2], to: &[DVec2]) -> Self {
        let mean = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len().max(1) as f64;
        let (a, b) = (mean(from), mean(to));
        let (mut factor, mut length) = (DVec2::ZERO, 0.0);
        for (f, t) in from.iter().zip(to).map(|(f, t)| (*f - a, *t - b)) {
            factor += DVec2::new(f.dot(t), f.perp_dot(t));
            length += f.length_squared();
        }
        let factor = if length > 0.0 { factor / length } else { DVec2::X };
        Self { factor, shift: b - factor.rotate(a) }
    }

    fn apply(&self, z: DVec2) -> DVec2 {
        self.factor.rotate(z) + self.shift
    }
}

/// From the plane to the drawing.
struct Frame {
    low: DVec2,
    high: DVec2,
    scale: f64,
}

impl Frame {
    fn of<'a>(points: impl Iterator<Item = &'a DVec2>) -> Self {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for point in points.filter(|point| point.is_finite()) {
            (low, high) = (low.min(*point), high.max(*point));
        }
        let extent = (high - low).max_element();
        let scale = if extent.is_finite() && extent > 0.0 { SIZE / extent } else { 1.0 };
        Self { low, high, scale }
    }

    fn extent(&self) -> DVec2 {
        (self.high - self.low) * self.scale
    }

    fn place(&self, z: DVec2) -> DVec2 {
        DVec2::new(z.x - self.low.x, self.high.y - z.y) * self.scale + MARGIN
    }
}
