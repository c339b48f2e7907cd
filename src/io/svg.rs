//! The layout as a drawing: faces, edges, boundary, and what is wrong with it.

use std::io::{self, Write};

use glam::DVec2;

use crate::mesh::{DiskMesh, EdgeId};
use crate::solver::Verdict;

/// Longer side of the drawing without its margin, in SVG user units.
const SIZE: f64 = 1000.0;

/// Free space around it.
const MARGIN: f64 = 20.0;

/// Draws an embedding, v upwards. Flipped faces are red, crossing boundary edges orange, overwound vertices magenta.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_svg(out: &mut impl Write, mesh: &DiskMesh, embedding: &[DVec2], verdict: &Verdict) -> io::Result<()> {
    let frame = Frame::of(embedding);
    let extent = frame.extent();
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.3} {:.3}" stroke-linejoin="round" fill="none">"#,
        extent.x + 2.0 * MARGIN,
        extent.y + 2.0 * MARGIN
    )?;
    let at = |v: crate::mesh::VertexId| frame.place(embedding[v.index()]);
    let outline: Vec<DVec2> = mesh.boundary_loop().iter().map(|&v| at(v)).collect();
    write!(out, r##"<path fill="#efece6" d=""##)?;
    write_closed(out, &outline)?;
    writeln!(out, r#""/>"#)?;
    // Thin enough that the faces of a fine mesh still show between the lines.
    let width = (0.2 * SIZE / (mesh.face_count() as f64).sqrt()).min(1.0);
    write!(out, r##"<path stroke="#8a8680" stroke-width="{width:.4}" d=""##)?;
    for edge in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
        write_edge(out, mesh, edge, &at)?;
    }
    writeln!(out, r#""/>"#)?;
    write!(out, r##"<path fill="#d92d3a" stroke="#d92d3a" stroke-width="{width:.4}" d=""##)?;
    for &face in &verdict.flipped_faces {
        write_closed(out, &mesh.face(face).map(at))?;
    }
    writeln!(out, r#""/>"#)?;
    write!(out, r##"<path stroke="#2c2b29" stroke-width="{:.4}" d=""##, 2.0 * width)?;
    write_closed(out, &outline)?;
    writeln!(out, r#""/>"#)?;
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

fn write_edge(
    out: &mut impl Write,
    mesh: &DiskMesh,
    edge: EdgeId,
    at: &impl Fn(crate::mesh::VertexId) -> DVec2,
) -> io::Result<()> {
    let [a, b] = mesh.ends(edge).map(at);
    write!(out, "M{:.3} {:.3}L{:.3} {:.3}", a.x, a.y, b.x, b.y)
}

fn write_closed(out: &mut impl Write, points: &[DVec2]) -> io::Result<()> {
    for (i, point) in points.iter().enumerate() {
        write!(out, "{}{:.3} {:.3}", if i == 0 { 'M' } else { 'L' }, point.x, point.y)?;
    }
    write!(out, "Z")
}

/// From the plane to the drawing.
struct Frame {
    low: DVec2,
    high: DVec2,
    scale: f64,
}

impl Frame {
    fn of(embedding: &[DVec2]) -> Self {
        let finite = || embedding.iter().copied().filter(|z| z.is_finite());
        let low = finite().fold(DVec2::INFINITY, DVec2::min);
        let high = finite().fold(DVec2::NEG_INFINITY, DVec2::max);
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
