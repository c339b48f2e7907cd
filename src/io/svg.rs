//! The layout as a drawing: faces, edges, boundary, and what is wrong with it.

use std::io::{self, Write};

use glam::DVec2;

use crate::mesh::{DiskMesh, VertexId};
use crate::solver::{Embedding, Step, Verdict, VirtualBoundary, to_true_area};

/// Longer side of a drawing without its margin, in units of its lines' widths.
const SIZE: f64 = 1000.0;

/// Free space around it.
const MARGIN: f64 = 20.0;

/// What the page of a drawing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SvgPage {
    /// The layout with a margin around it, at whatever size.
    Layout,
    /// The unit square of texture coordinates, where a picture of this aspect (width over height) lies; larger where the
    /// layout leaves it.
    Picture {
        /// Width of the picture over its height.
        aspect: f64,
    },
    /// The layout as large as the surface: a unit of the drawing is a unit of the mesh.
    TrueArea {
        /// Width over height of the picture that the texture coordinates are for.
        aspect: f64,
    },
}

impl SvgPage {
    /// Width over height of the picture that the texture coordinates are for; 1 where there is none.
    pub const fn aspect(self) -> f64 {
        match self {
            Self::Layout => 1.0,
            Self::Picture { aspect } | Self::TrueArea { aspect } => aspect,
        }
    }
}

/// What lies outside the boundary in a step of the virtual boundary.
struct Outside<'a> {
    /// Places of all vertices, the virtual ones last.
    positions: Embedding,
    stages: &'a VirtualBoundary,
}

/// Draws texture coordinates, v upwards. Flipped faces are red, crossing boundary edges orange, overwound vertices
/// magenta.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_svg(
    out: &mut impl Write,
    mesh: &DiskMesh,
    (coordinates, verdict): (&Embedding, &Verdict),
    page: SvgPage,
) -> io::Result<()> {
    let on_picture = |aspect: f64| -> Embedding { coordinates.iter().map(|uv| uv * DVec2::new(aspect, 1.0)).collect() };
    match page {
        SvgPage::Layout => write_layout(out, mesh, (coordinates, verdict), &Frame::around(coordinates.iter())),
        SvgPage::Picture { aspect } => {
            let places = on_picture(aspect);
            write_layout(out, mesh, (&places, verdict), &Frame::of_picture(aspect, &places))
        }
        SvgPage::TrueArea { aspect } => {
            let mut places = on_picture(aspect);
            to_true_area(mesh, &mut places);
            write_layout(out, mesh, (&places, verdict), &Frame::at_scale(&places))
        }
    }
}

/// Draws a step as [`write_svg`] does; one of the virtual boundary with the outline it was solved with (the hull, as a
/// red line) and the pockets (green). `mesh` is the mesh as given; new vertices are the step's own.
///
/// # Errors
///
/// If `out` cannot be written.
pub fn write_step_svg(out: &mut impl Write, mesh: &DiskMesh, step: &Step) -> io::Result<()> {
    let (embedding, mesh) = (&step.solution.embedding, step.mesh(mesh));
    let outside = step.virtual_boundary.as_deref().map(|stages| {
        // The step's embedding may have been turned and scaled since it was solved; the outside goes with it.
        let fit = Similarity::between(&stages.solved[..embedding.len()], embedding);
        let positions = stages.solved.iter().map(|&z| fit.apply(z)).collect();
        Outside { positions, stages }
    });
    let frame = Frame::around(embedding.iter().chain(outside.iter().flat_map(|outside| &outside.positions)));
    write_drawing(out, mesh, (embedding, &step.verdict), (&frame, outside.as_ref()))
}

fn write_layout(
    out: &mut impl Write,
    mesh: &DiskMesh,
    layout: (&Embedding, &Verdict),
    frame: &Frame,
) -> io::Result<()> {
    write_drawing(out, mesh, layout, (frame, None))
}

fn write_drawing(
    out: &mut impl Write,
    mesh: &DiskMesh,
    (embedding, verdict): (&Embedding, &Verdict),
    (frame, outside): (&Frame, Option<&Outside>),
) -> io::Result<()> {
    let DVec2 { x: width, y: height } = frame.page();
    let size = if frame.is_to_scale { format!(r#"width="{width}" height="{height}" "#) } else { String::new() };
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" {size}viewBox="0 0 {width} {height}" stroke-linejoin="round" fill="none">"#,
    )?;
    // Thin enough that the faces of a fine mesh still show between the lines.
    let width = (0.2 * SIZE / (mesh.face_count() as f64).sqrt()).min(1.0);
    let pen = Pen { frame, width: frame.length(width) };
    if let Some(outside) = outside {
        pen.write_pockets(out, outside)?;
    }
    let at = |v: VertexId| frame.place(embedding[v]);
    pen.write_faces(out, (mesh, verdict), &at)?;
    if let Some(outside) = outside {
        pen.write_hull(out, outside)?;
    }
    write!(out, r##"<path stroke="#e8700a" stroke-width="{}" d=""##, frame.length(3.0))?;
    for edge in verdict.boundary_crossings.iter().flatten() {
        pen.write_edge(out, mesh.ends(*edge).map(at))?;
    }
    writeln!(out, r#""/>"#)?;
    for &vertex in &verdict.overwound_vertices {
        let (DVec2 { x, y }, decimals) = (at(vertex), frame.decimals);
        let [radius, width] = [5.0, 2.0].map(|length| frame.length(length));
        writeln!(
            out,
            r##"<circle cx="{x:.decimals$}" cy="{y:.decimals$}" r="{radius}" stroke="#c026a8" stroke-width="{width}"/>"##
        )?;
    }
    writeln!(out, "</svg>")
}

/// What lines are written with.
struct Pen<'a> {
    frame: &'a Frame,
    /// Width of the thinnest.
    width: f64,
}

impl Pen<'_> {
    /// Faces, inner edges, flipped faces, boundary.
    fn write_faces(
        &self,
        out: &mut impl Write,
        (mesh, verdict): (&DiskMesh, &Verdict),
        at: &impl Fn(VertexId) -> DVec2,
    ) -> io::Result<()> {
        let width = self.width;
        let outline: Vec<DVec2> = mesh.boundary_loop().iter().map(|&v| at(v)).collect();
        write!(out, r##"<path fill="#efece6" d=""##)?;
        self.write_closed(out, &outline)?;
        writeln!(out, r#""/>"#)?;
        write!(out, r##"<path stroke="#8a8680" stroke-width="{width}" d=""##)?;
        for edge in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
            self.write_edge(out, mesh.ends(edge).map(at))?;
        }
        writeln!(out, r#""/>"#)?;
        write!(out, r##"<path fill="#d92d3a" stroke="#d92d3a" stroke-width="{width}" d=""##)?;
        for &face in &verdict.flipped_faces {
            self.write_closed(out, &mesh.face(face).map(at))?;
        }
        writeln!(out, r#""/>"#)?;
        write!(out, r##"<path class="boundary" stroke="#2c2b29" stroke-width="{}" d=""##, 2.0 * width)?;
        self.write_closed(out, &outline)?;
        writeln!(out, r#""/>"#)
    }

    fn write_pockets(&self, out: &mut impl Write, outside: &Outside) -> io::Result<()> {
        let at = |v: VertexId| self.frame.place(outside.positions[v.index()]);
        let width = self.width;
        write!(out, r##"<path class="pockets" fill="#cfe8d2" stroke="#3fa34d" stroke-width="{width}" d=""##)?;
        for pocket in &outside.stages.pockets {
            self.write_closed(out, &pocket.map(at))?;
        }
        writeln!(out, r#""/>"#)
    }

    fn write_hull(&self, out: &mut impl Write, outside: &Outside) -> io::Result<()> {
        let at = |v: &VertexId| self.frame.place(outside.positions[v.index()]);
        let outline: Vec<DVec2> = outside.stages.hull.iter().map(at).collect();
        write!(out, r##"<path class="hull" stroke="#c93a3a" stroke-width="{}" d=""##, 3.0 * self.width)?;
        self.write_closed(out, &outline)?;
        writeln!(out, r#""/>"#)
    }

    fn write_edge(&self, out: &mut impl Write, [a, b]: [DVec2; 2]) -> io::Result<()> {
        let decimals = self.frame.decimals;
        write!(out, "M{:.decimals$} {:.decimals$}L{:.decimals$} {:.decimals$}", a.x, a.y, b.x, b.y)
    }

    fn write_closed(&self, out: &mut impl Write, points: &[DVec2]) -> io::Result<()> {
        let decimals = self.frame.decimals;
        for (i, point) in points.iter().enumerate() {
            write!(out, "{}{:.decimals$} {:.decimals$}", if i == 0 { 'M' } else { 'L' }, point.x, point.y)?;
        }
        write!(out, "Z")
    }
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
    /// Free space around it, in the drawing's units.
    margin: f64,
    /// Digits behind the point that are a millionth of the drawing.
    decimals: usize,
    /// Whether the drawing's units mean something.
    is_to_scale: bool,
}

impl Frame {
    /// Around some points, at a size of its own.
    fn around<'a>(points: impl Iterator<Item = &'a DVec2>) -> Self {
        let [low, high] = bounds(points);
        let extent = (high - low).max_element();
        let scale = if extent.is_finite() && extent > 0.0 { SIZE / extent } else { 1.0 };
        Self { low, high, scale, margin: MARGIN, decimals: 3, is_to_scale: false }
    }

    /// The unit square, as wide as a picture of this aspect, and whatever lies outside.
    fn of_picture(aspect: f64, points: &[DVec2]) -> Self {
        let [low, high] = bounds(points.iter().chain(&[DVec2::ZERO, DVec2::new(aspect, 1.0)]));
        Self { low, high, scale: SIZE / aspect.max(1.0), margin: 0.0, decimals: 3, is_to_scale: false }
    }

    /// Around some points, lengths as they are.
    fn at_scale(points: &[DVec2]) -> Self {
        let [low, high] = bounds(points.iter());
        let extent = (high - low).max_element();
        let decimals = (0..=300).take_while(|&n| extent * 10_f64.powi(n) < SIZE * SIZE).count();
        Self { low, high, scale: 1.0, margin: extent * MARGIN / SIZE, decimals, is_to_scale: true }
    }

    /// A length that is measured in parts of the drawing's size.
    fn length(&self, parts: f64) -> f64 {
        let unit = if self.is_to_scale { (self.high - self.low).max_element() / SIZE } else { 1.0 };
        parts * unit
    }

    /// Width and height.
    fn page(&self) -> DVec2 {
        (self.high - self.low) * self.scale + 2.0 * self.margin
    }

    fn place(&self, z: DVec2) -> DVec2 {
        DVec2::new(z.x - self.low.x, self.high.y - z.y) * self.scale + self.margin
    }
}

/// Lower left and upper right corner of the box around the points that are finite.
fn bounds<'a>(points: impl Iterator<Item = &'a DVec2>) -> [DVec2; 2] {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for point in points.filter(|point| point.is_finite()) {
        (low, high) = (low.min(*point), high.max(*point));
    }
    [low, high]
}
