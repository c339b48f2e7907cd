//! Drawing of an embedding (SVG): faces, edges, boundary and defects.

use std::io::{self, Write};

use glam::DVec2;

use super::ProvedEmbedding;
use super::charts::proved_at;
use super::finite::check_finite;
use super::true_size::scale_to_true_size;
use freebound_core::bijective::VirtualBoundary;
use freebound_core::flatten::Step;
use freebound_core::geom::{Bounds, Similarity};
use freebound_core::mesh::{DiskMesh, EdgeId, EdgeTable, FaceId, TriMesh, VertexId};
use freebound_core::pipeline::{Fit, LaidChart};
use freebound_core::problem::Embedding;

/// Longer side of a drawing without its margin, in units of its line widths.
const SIZE: f64 = 1000.0;

/// Margin around the drawing.
const MARGIN: f64 = 20.0;

/// Draws texture coordinates, v upwards, for a picture of this aspect (width over height).
///
/// Flipped faces are red, crossing boundary edges orange, concave polygons outlined in olive, overwound vertices
/// magenta. With [`Fit::Unit`] the page is the unit square of the picture, enlarged if the embedding leaves it. With
/// [`Fit::True`] a unit of the drawing is a unit of the mesh.
///
/// # Errors
///
/// If `out` cannot be written, or charts of different scales are to be drawn at their true size.
pub(super) fn write_svg(out: &mut impl Write, charts: &[LaidChart<'_>], aspect: f64, fit: Fit) -> io::Result<()> {
    let scale = DVec2::new(aspect, 1.0);
    let laid = |chart: &LaidChart<'_>| chart.coordinates.iter().map(|uv| uv * scale).collect();
    let mut embeddings: Vec<Embedding> = charts.iter().map(laid).collect();
    if fit == Fit::True {
        scale_to_true_size(charts, &mut embeddings)?;
    }
    let points = embeddings.iter().flat_map(|embedding| embedding.iter());
    let frame = match fit {
        Fit::Unit => Frame::of_picture(aspect, points),
        Fit::True => Frame::at_scale(points),
    };
    let shown: Vec<_> = charts.iter().zip(&embeddings).map(|(chart, embedding)| proved_at(chart, embedding)).collect();
    Drawing::new(&shown, frame, None).write(out)
}

/// Layout of a mesh to be drawn.
pub(super) struct LayoutDrawing<'a> {
    /// Triangles over the coordinates.
    pub(super) mesh: &'a TriMesh,
    /// Texture coordinates, v up.
    pub(super) coordinates: &'a Embedding,
    /// Triangles that are drawn as flipped.
    pub(super) flipped: Vec<FaceId>,
    /// Width over height of the picture.
    pub(super) aspect: f64,
}

/// Draws the layout of any mesh in the style of [`write_svg`], without other defects than flipped faces.
pub(super) fn write_layout_svg(out: &mut impl Write, layout: &LayoutDrawing<'_>) -> io::Result<()> {
    let LayoutDrawing { mesh, coordinates, flipped, aspect } = layout;
    let plane: Embedding = coordinates.iter().map(|uv| uv * DVec2::new(*aspect, 1.0)).collect();
    let drawing = Drawing::new(&[], Frame::of_picture(*aspect, plane.iter()), None);
    let width = (0.2 * SIZE / (mesh.face_count() as f64).sqrt()).min(1.0);
    let at = |vertex: VertexId| drawing.frame.place(plane[vertex]);
    let page = drawing.frame.page();
    check_finite(plane.iter().chain([&page]))?;
    writeln!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" stroke-linejoin="round" fill="none">"#,
        page.x, page.y
    )?;
    let faces = mesh.triangles.iter().map(|corners| corners.map(at));
    drawing.write_closed(out, &format!(r##"fill="#efece6" stroke="#8a8680" stroke-width="{width}""##), faces)?;
    let flipped = flipped.iter().map(|face| mesh.triangles[face.index()].map(at));
    drawing.write_closed(out, &format!(r##"fill="#d92d3a" stroke="#d92d3a" stroke-width="{width}""##), flipped)?;
    write!(out, r##"<path class="boundary" stroke="#2c2b29" stroke-width="{}" d=""##, 2.0 * width)?;
    for side in EdgeTable::new(mesh.vertex_count(), &mesh.triangles).edges().filter(|sides| sides.len() == 1) {
        let (corners, corner) = (mesh.triangles[side[0] as usize / 3], side[0] as usize % 3);
        drawing.write_line(out, &[corners[corner], corners[(corner + 1) % 3]].map(at))?;
    }
    writeln!(out, r#""/>"#)?;
    writeln!(out, "</svg>")
}

/// Draws a step in the style of [`write_svg`]. A step of the virtual boundary also shows the outline of its solve:
/// the hull as a red line, and the pockets in green. `mesh` is the input mesh; new vertices belong to the step.
pub(super) fn write_step_svg(out: &mut impl Write, mesh: &DiskMesh, step: &Step) -> io::Result<()> {
    let embedding = &step.candidate.solution.embedding;
    let outside = step.candidate.virtual_boundary.as_deref().map(|stages| {
        // The step's embedding may have been rotated and scaled since the solve; move the outside along with it.
        let pairs: Vec<[DVec2; 2]> = stages.solved.iter().zip(embedding).map(|(&from, &to)| [from, to]).collect();
        let fit = Similarity::fitting(&pairs);
        let moved = |&z: &DVec2| fit.map_or(z, |fit| fit.apply(z));
        Outside { embedding: stages.solved.iter().map(moved).collect(), stages }
    });
    let frame = Frame::around(embedding.iter().chain(outside.iter().flat_map(|outside| &outside.embedding)));
    let shown = ProvedEmbedding { mesh: step.candidate.mesh(mesh), embedding, verdict: &step.verdict };
    Drawing::new(&[shown], frame, outside).write(out)
}

/// Outside of the boundary in a step of the virtual boundary.
struct Outside<'a> {
    /// Embedding of all vertices, the virtual ones last.
    embedding: Embedding,
    stages: &'a VirtualBoundary,
}

/// Embeddings on their page.
struct Drawing<'a> {
    charts: &'a [ProvedEmbedding<'a>],
    outside: Option<Outside<'a>>,
    frame: Frame,
    /// Width of the thinnest lines.
    width: f64,
}

impl<'a> Drawing<'a> {
    fn new(charts: &'a [ProvedEmbedding<'a>], frame: Frame, outside: Option<Outside<'a>>) -> Self {
        // Thin enough that the faces of a fine mesh still show between the lines.
        let face_count: usize = charts.iter().map(|chart| chart.mesh.face_count()).sum();
        let width = (0.2 * SIZE / (face_count as f64).sqrt()).min(1.0);
        Self { charts, outside, width: frame.length(width), frame }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let page = self.frame.page();
        let outside = self.outside.iter().flat_map(|outside| &outside.embedding);
        let points = self.charts.iter().flat_map(|chart| chart.embedding.iter());
        check_finite(points.chain(outside).chain([&page]))?;
        let DVec2 { x: width, y: height } = page;
        let size =
            if self.frame.is_to_scale { format!(r#"width="{width}" height="{height}" "#) } else { String::new() };
        writeln!(
            out,
            r#"<svg xmlns="http://www.w3.org/2000/svg" {size}viewBox="0 0 {width} {height}" stroke-linejoin="round" fill="none">"#,
        )?;
        self.write_pockets(out)?;
        self.charts.iter().try_for_each(|chart| self.write_faces(out, *chart))?;
        self.write_hull(out)?;
        self.charts.iter().try_for_each(|chart| self.write_defects(out, *chart))?;
        writeln!(out, "</svg>")
    }

    /// Position of a vertex in the drawing.
    fn at(&self, chart: ProvedEmbedding<'_>, vertex: VertexId) -> DVec2 {
        self.frame.place(chart.embedding[vertex.index()])
    }

    /// Draws faces, inner edges, flipped faces and the boundary.
    fn write_faces(&self, out: &mut impl Write, chart: ProvedEmbedding<'_>) -> io::Result<()> {
        let (mesh, width) = (chart.mesh, self.width);
        let holes = mesh.mesh().holes();
        let loops = std::iter::once(mesh.boundary_loop()).chain(holes.iter().map(|hole| &hole.rim[..]));
        let outlines: Vec<Vec<DVec2>> = loops.map(|of| of.iter().map(|&v| self.at(chart, v)).collect()).collect();
        let ground = r##"fill="#efece6""##;
        let ground = if holes.is_empty() { ground.to_owned() } else { format!(r#"{ground} fill-rule="evenodd""#) };
        self.write_closed(out, &ground, &outlines)?;
        let edges = mesh.edges().filter(|&e| !mesh.is_boundary_edge(e) && !mesh.is_virtual_edge(e));
        self.write_edges(out, chart, &format!(r##"stroke="#8a8680" stroke-width="{width}""##), edges)?;
        let flipped = chart.verdict.flipped_faces.iter().map(|&face| mesh.face(face).map(|v| self.at(chart, v)));
        self.write_closed(out, &format!(r##"fill="#d92d3a" stroke="#d92d3a" stroke-width="{width}""##), flipped)?;
        let style = format!(r##"class="boundary" stroke="#2c2b29" stroke-width="{}""##, 2.0 * width);
        self.write_closed(out, &style, &outlines)
    }

    fn write_pockets(&self, out: &mut impl Write) -> io::Result<()> {
        let Some(outside) = &self.outside else { return Ok(()) };
        let at = |v: VertexId| self.frame.place(outside.embedding[v]);
        let pockets = outside.stages.pockets.iter().map(|pocket| pocket.map(at));
        let style = format!(r##"class="pockets" fill="#cfe8d2" stroke="#3fa34d" stroke-width="{}""##, self.width);
        self.write_closed(out, &style, pockets)
    }

    fn write_hull(&self, out: &mut impl Write) -> io::Result<()> {
        let Some(outside) = &self.outside else { return Ok(()) };
        let hull = outside.stages.hull.iter().map(|v| self.frame.place(outside.embedding[v]));
        let style = format!(r##"class="hull" stroke="#c93a3a" stroke-width="{}""##, 3.0 * self.width);
        self.write_closed(out, &style, [hull.collect::<Vec<_>>()])
    }

    /// Draws crossings, concave polygons, crossed holes and overwound vertices.
    fn write_defects(&self, out: &mut impl Write, chart: ProvedEmbedding<'_>) -> io::Result<()> {
        let ProvedEmbedding { verdict, mesh, .. } = chart;
        let crossings = verdict.boundary_crossings.iter().flatten().copied();
        let style = format!(r##"stroke="#e8700a" stroke-width="{}""##, self.frame.length(3.0));
        self.write_edges(out, chart, &style, crossings)?;
        let concave = verdict.concave_polygons.iter().filter_map(|&face| mesh.polygon_of(face));
        let outlines = concave.map(|polygon| polygon.corners.iter().map(|&v| self.at(chart, v)).collect::<Vec<_>>());
        let style = format!(r##"stroke="#6e7b00" stroke-width="{}""##, self.frame.length(3.0));
        if !verdict.concave_polygons.is_empty() {
            self.write_closed(out, &style, outlines)?;
        }
        let holes = chart.mesh.mesh().holes().into_iter();
        let crossed = holes.filter(|hole| verdict.crossed_holes.contains(&hole.rim[0]));
        let loops: Vec<Vec<DVec2>> =
            crossed.map(|hole| hole.rim.iter().map(|&v| self.at(chart, v)).collect()).collect();
        if !loops.is_empty() {
            let style = format!(r##"stroke="#e8700a" stroke-width="{}""##, self.frame.length(3.0));
            self.write_closed(out, &style, loops)?;
        }
        for &vertex in &verdict.overwound_vertices {
            let (DVec2 { x, y }, decimals) = (self.at(chart, vertex), self.frame.decimals);
            let [radius, width] = [5.0, 2.0].map(|length| self.frame.length(length));
            writeln!(
                out,
                r##"<circle cx="{x:.decimals$}" cy="{y:.decimals$}" r="{radius}" stroke="#c026a8" stroke-width="{width}"/>"##
            )?;
        }
        Ok(())
    }

    fn write_edges(
        &self,
        out: &mut impl Write,
        chart: ProvedEmbedding<'_>,
        style: &str,
        edges: impl Iterator<Item = EdgeId>,
    ) -> io::Result<()> {
        write!(out, r#"<path {style} d=""#)?;
        for edge in edges {
            self.write_line(out, &chart.mesh.ends(edge).map(|v| self.at(chart, v)))?;
        }
        writeln!(out, r#""/>"#)
    }

    fn write_closed<L: AsRef<[DVec2]>>(
        &self,
        out: &mut impl Write,
        style: &str,
        lines: impl IntoIterator<Item = L>,
    ) -> io::Result<()> {
        write!(out, r#"<path {style} d=""#)?;
        for line in lines {
            self.write_line(out, line.as_ref())?;
            write!(out, "Z")?;
        }
        writeln!(out, r#""/>"#)
    }

    fn write_line(&self, out: &mut impl Write, points: &[DVec2]) -> io::Result<()> {
        let decimals = self.frame.decimals;
        for (i, point) in points.iter().enumerate() {
            write!(out, "{}{:.decimals$} {:.decimals$}", if i == 0 { 'M' } else { 'L' }, point.x, point.y)?;
        }
        Ok(())
    }
}

/// Map from the plane to the drawing.
struct Frame {
    bounds: Bounds,
    scale: f64,
    /// Margin, in units of the drawing.
    margin: f64,
    /// Decimals of a coordinate, down to a millionth of the drawing.
    decimals: usize,
    /// True if a unit of the drawing is a unit of the mesh.
    is_to_scale: bool,
}

impl Frame {
    /// Frame around points, scaled to the default size.
    fn around<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> Self {
        let bounds = finite_bounds(points.into_iter().copied());
        let extent = bounds.size().max_element();
        let scale = if extent.is_finite() && extent > 0.0 { SIZE / extent } else { 1.0 };
        Self { bounds, scale, margin: MARGIN, decimals: 3, is_to_scale: false }
    }

    /// Frame of the unit square, as wide as a picture of this aspect, extended to the points outside.
    fn of_picture<'a>(aspect: f64, points: impl Iterator<Item = &'a DVec2>) -> Self {
        let page = [DVec2::ZERO, DVec2::new(aspect, 1.0)];
        let bounds = finite_bounds(points.copied().chain(page));
        Self { bounds, scale: SIZE / aspect.max(1.0), margin: 0.0, decimals: 3, is_to_scale: false }
    }

    /// Frame around points, at true scale.
    fn at_scale<'a>(points: impl Iterator<Item = &'a DVec2>) -> Self {
        let bounds = finite_bounds(points.copied());
        let extent = bounds.size().max_element();
        let decimals = (0..=300).take_while(|&n| extent * 10_f64.powi(n) < SIZE * SIZE).count();
        Self { bounds, scale: 1.0, margin: extent * MARGIN / SIZE, decimals, is_to_scale: true }
    }

    /// Length given in parts of the drawing's size ([`SIZE`]), in units of the drawing.
    fn length(&self, parts: f64) -> f64 {
        let unit = if self.is_to_scale { self.bounds.size().max_element() / SIZE } else { 1.0 };
        parts * unit
    }

    /// Width and height of the page.
    fn page(&self) -> DVec2 {
        self.bounds.size() * self.scale + 2.0 * self.margin
    }

    fn place(&self, z: DVec2) -> DVec2 {
        DVec2::new(z.x - self.bounds.low.x, self.bounds.high.y - z.y) * self.scale + self.margin
    }
}

fn finite_bounds(points: impl IntoIterator<Item = DVec2>) -> Bounds {
    Bounds::of(points.into_iter().filter(|point| point.is_finite()))
}
