//! Picture of a comparison: the embeddings of several methods side by side on one scale and with one colour scale.
//! The numbers of each method are below its embedding.

use glam::DVec2;

use super::{CellFrame, CellFrames, Quantity, Range};
use crate::session::{Compared, Model};
use freebound_core::geom::{Bounds, Picture, double_area};
use freebound_core::mesh::{DiskMesh, FaceId, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Embedding, Labels, NamedOption};
use freebound_core::verify::Distortion;
use freebound_io::figure::{CellContent, ColourBar, Curve, Curves, GridCell, Page, PanelGrid, TintedDrawing, Window};
use freebound_io::raster::{Canvas, Colour, RasterPaint, View, mesh_picture};

/// Number of colours that values are rounded to, which keeps the number of paths small.
const LEVELS: u32 = 64;

/// Checker fields along the side of a square with the area of the embedding.
const CHECKER_FIELDS: f64 = 20.0;

/// Side of a picture of the mesh, pixels.
const PICTURE_SIZE: u32 = 460;

/// Least number of steps for an energy curve over time.
const CURVE_STEPS: usize = 3;

/// Colouring of the cells of a comparison's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellShading {
    /// Faces of the embedding, coloured by a quantity per face.
    By(Quantity),
    /// Mesh in space under a checker pattern of the plane.
    Checker,
}

impl Default for CellShading {
    fn default() -> Self {
        Self::By(Quantity::default())
    }
}

impl NamedOption for CellShading {
    const ALL: &'static [Self] =
        &[Self::By(Quantity::Angle), Self::By(Quantity::Area), Self::By(Quantity::Stretch), Self::Checker];

    fn labels(&self) -> Labels {
        let (name, about) = match self {
            Self::By(Quantity::Angle) => ("angle", "ratio of the singular values of each face: 1 keeps angles"),
            Self::By(Quantity::Area) => ("area", "area in the plane over area on the surface"),
            Self::By(Quantity::Stretch) => ("stretch", "root mean square stretch from the plane to the surface"),
            Self::Checker => ("checker", "the mesh in space, with a checker of the plane"),
        };
        let title = if let Self::By(quantity) = self { quantity.title() } else { "Checker" };
        Labels { name, title, about, source: "" }
    }
}

/// Methods that ran on a model, to be drawn side by side.
#[derive(Clone, Copy, Debug)]
pub struct ComparisonPicture<'a> {
    /// Model that the methods ran on: a disk.
    pub model: &'a Model,
    /// Results of the methods.
    pub methods: &'a [&'a Compared],
    /// Colouring of the cells.
    pub shading: CellShading,
}

impl ComparisonPicture<'_> {
    /// Lays out the page.
    ///
    /// # Panics
    ///
    /// If the model is no disk.
    pub fn page(&self) -> Page {
        let mesh = self.model.disk().expect("methods run on disks only");
        let outcomes: Vec<&Outcome> = self.outcomes().collect();
        let beside = CellFrames::new(mesh, &outcomes);
        let mut frames = beside.frames.iter();
        let range = match self.shading {
            CellShading::By(quantity) => quantity.common_range(self.outcomes().map(|outcome| &outcome.distortion)),
            CellShading::Checker => None,
        };
        let mut cells: Vec<GridCell> = self
            .methods
            .iter()
            .map(|method| {
                let content = match (&method.outcome, self.shading, range) {
                    (Some(outcome), CellShading::By(quantity), Some(range)) => {
                        let window = frames.next().map(|frame| window(*frame, beside.bounds));
                        let window = window.expect("every embedding has its frame");
                        CellContent::Plane(tinted(mesh, outcome, quantity, range, window))
                    }
                    (Some(outcome), ..) => {
                        let step = &outcome.step;
                        CellContent::Photo(checkered(step.candidate.mesh(mesh), &step.candidate.solution.embedding))
                    }
                    (None, ..) => CellContent::Words(method.report.error_words()),
                };
                let lines = std::iter::once(method.report.verdict_line()).chain(method.report.number_lines());
                GridCell { title: method.report.title.clone(), lines: lines.collect(), content }
            })
            .collect();
        cells.extend(self.curves());
        let bar = match (self.shading, range) {
            (CellShading::By(quantity), Some(range)) => Some(bar(quantity, range)),
            _ => None,
        };
        PanelGrid { cells, bar, caption: self.caption(mesh) }.page()
    }

    fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        self.methods.iter().filter_map(|method| method.outcome.as_deref())
    }

    fn caption(&self, mesh: &DiskMesh) -> String {
        let faces = mesh.mesh().real_face_count();
        let pins = self.methods.first().map_or(0, |method| method.problem.targets.len());
        let pins = if pins == 0 { String::new() } else { format!(", {pins} pinned") };
        format!("{}: {} vertices, {faces} faces{pins}. All at one scale.", self.model.name, mesh.real_vertex_count())
    }

    /// Energy over time of the methods that take at least [`CURVE_STEPS`] steps.
    fn curves(&self) -> Option<GridCell> {
        let curve = |method: &&Compared| {
            let report = &method.report;
            let points = report.steps.iter().map(|step| DVec2::new(step.elapsed, step.energy)).collect();
            (report.steps.len() >= CURVE_STEPS).then(|| Curve { name: report.title.clone(), points })
        };
        let curves: Vec<Curve> = self.methods.iter().filter_map(curve).collect();
        let axes = ["seconds".to_owned(), "energy".to_owned()];
        (!curves.is_empty()).then(|| GridCell {
            title: "energy over time".to_owned(),
            lines: vec!["a square for each step".to_owned()],
            content: CellContent::Curves(Curves { axes, curves }),
        })
    }
}

/// Window of a cell's embedding that shows the square `bounds` of the common plane.
fn window(frame: CellFrame, bounds: Bounds) -> Window {
    Window { centre: frame.own(bounds.middle()), half: frame.size() * bounds.size().max_element() / 2.0 }
}

fn tinted(mesh: &DiskMesh, outcome: &Outcome, quantity: Quantity, range: Range, window: Window) -> TintedDrawing {
    TintedDrawing::of_step(mesh, &outcome.step, colours_of(&outcome.distortion, quantity, range), window)
}

/// Returns one colour per face.
pub(super) fn colours_of(distortion: &Distortion, quantity: Quantity, range: Range) -> Vec<Colour> {
    let levels = f64::from(LEVELS - 1);
    let colour = |value: f64| quantity.scale().colour_at((range.share(value) * levels).round() / levels);
    quantity.values(distortion).into_iter().map(colour).collect()
}

/// Draws the mesh in space under a checker pattern of the plane. The view faces the side that most of the surface
/// faces. A closed surface that was cut open is seen from the front.
pub(super) fn checkered(disk: &DiskMesh, embedding: &Embedding) -> Picture {
    let mesh = disk.mesh();
    let triangles = mesh.real_triangles();
    let view = View::facing((0..triangles.len()).map(|face| mesh.double_area_vector(FaceId::from_index(face))));
    let covered = |corners: &[VertexId; 3]| double_area(corners.map(|v| embedding[v])).abs();
    let area: f64 = triangles.iter().map(covered).sum::<f64>() / 2.0;
    let size = (area.sqrt() / CHECKER_FIELDS).max(f64::MIN_POSITIVE);
    let paint = RasterPaint::Checker { coordinates: embedding, size };
    mesh_picture(&mesh.positions, triangles, &view, &Canvas::clay(PICTURE_SIZE, PICTURE_SIZE), paint)
}

pub(super) fn bar(quantity: Quantity, range: Range) -> ColourBar {
    let levels = f64::from(LEVELS - 1);
    ColourBar {
        title: quantity.title().to_owned(),
        colours: (0..LEVELS).map(|level| quantity.scale().colour_at(f64::from(level) / levels)).collect(),
        ticks: quantity.scale().ticks(range).into_iter().map(|tick| (tick.at, tick.label)).collect(),
    }
}
