//! Layout of another mesh file, copied to the open mesh: the mesh cut along its seams, and the charts in it.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;

use super::reshaping::Reshaped;
use super::{Document, Model};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, Preparation, Seams, VertexId};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Control, Embedding};
use freebound_io::{ReadError, ReadOptions, Registration, TransferError, TransferReport, copied_texture};

/// Layout of another mesh file on the open mesh.
pub(super) struct LayoutOfOther {
    /// Mesh cut along the seams of the layout.
    pub(super) reshaped: Reshaped,
    /// Charts that are planar in the layout.
    pub(super) charts: Vec<CopiedChart>,
    /// True if the other mesh was moved and scaled to this one.
    pub(super) is_moved: bool,
    /// Correspondence of the two meshes.
    pub(super) report: TransferReport,
}

/// Chart in a copied layout.
pub(super) struct CopiedChart {
    /// Number of the chart.
    pub(super) number: usize,
    /// First face of the chart in the file. `None` if the mesh is a single chart.
    pub(super) first_face: Option<FaceId>,
    /// Texture coordinates of its vertices, v up.
    pub(super) coordinates: Arc<Embedding>,
    /// True if the chart was mirrored in the layout, and turned over.
    pub(super) is_turned: bool,
    /// Two vertices far from each other, if the mesh is a single chart.
    pub(super) held: Option<[VertexId; 2]>,
}

/// Reason why a layout was not copied.
#[derive(Debug, thiserror::Error)]
pub(super) enum LayoutOfOtherError {
    /// The file cannot be read.
    #[error("{}", .0.to_string().lines().next().unwrap_or_default())]
    Read(#[from] ReadError),
    /// The layout cannot be copied.
    #[error(transparent)]
    Transfer(#[from] TransferError),
}

impl LayoutOfOther {
    /// Copies the layout of a file to a mesh of a document, which may be faulty: it is repaired.
    pub(super) fn read(
        path: &Path,
        before: Arc<Model>,
        document: &Document,
        control: Control<'_>,
    ) -> Result<Self, LayoutOfOtherError> {
        let other = Model::read_formless(path, ReadOptions::default(), &|| control.go_on().is_err())?;
        let is_turned = before.prepared.form.faces_turned;
        let source = if is_turned { Arc::new(other.source.turned()) } else { other.source };
        let copied = |registration| copied_texture(&source, &before.source, registration, control);
        let (mut texture, mut report) = copied(Registration::AsTheyAre)?;
        let mut is_moved = false;
        if report.is_apart() {
            let by_box = copied(Registration::ByBox)?;
            if !by_box.1.is_apart() {
                ((texture, report), is_moved) = (by_box, true);
            }
        }
        if is_turned {
            // The layout as it is seen from the other side.
            turn_over(&mut texture.coordinates);
        }
        let seams = Seams::default().with(texture.seams(&before.source.polygons));
        let form = Preparation { seams, ..document.form.with_all_repairs() };
        let reshaped = Reshaped::new(before, form, control);
        let laid = reshaped.now().clone().with_layout(path.display().to_string(), texture);
        let charts = (0..laid.chart_count().max(1)).filter_map(|number| {
            let model = if laid.prepared.chart.is_some() { laid.of_chart(number) } else { laid.clone() };
            let given = model.layout().ok()?;
            let problem = document.problem_with(super::ChartEdits::default());
            let if_planar = |coordinates: &Embedding| {
                let map = Outcome::of_saved_map(model.disk()?, problem.clone(), problem.in_plane(coordinates));
                map.map(|_| coordinates.clone())
            };
            let upright = if_planar(&given);
            let is_turned = upright.is_none();
            let coordinates = upright.or_else(|| if_planar(&turned_over(&given)))?;
            let boundary = model.disk()?.boundary_loop().to_vec();
            let first_face = model.prepared.chart.as_ref().map(|of| of.charts.first_face(number));
            let held = if first_face.is_none() { farthest(&boundary, &coordinates) } else { None };
            Some(CopiedChart { number, first_face, coordinates: Arc::new(coordinates), is_turned, held })
        });
        let charts = charts.collect();
        Ok(Self { reshaped, charts, is_moved, report })
    }

    /// Number of charts that are not planar in the layout.
    pub(super) fn missing(&self) -> usize {
        self.reshaped.now().chart_count().max(1) - self.charts.len()
    }
}

/// Mirrors coordinates within their box, from left to right.
fn turn_over(coordinates: &mut [DVec2]) {
    let Bounds { low, high } = Bounds::of(coordinates.iter().copied());
    for uv in coordinates {
        uv.x = low.x + (high.x - uv.x);
    }
}

fn turned_over(embedding: &Embedding) -> Embedding {
    let mut coordinates = embedding.to_vec();
    turn_over(&mut coordinates);
    coordinates.into()
}

/// Two of these vertices that lie far from each other.
fn farthest(vertices: &[VertexId], embedding: &Embedding) -> Option<[VertexId; 2]> {
    let from = |from: VertexId| {
        let away = |vertex: &VertexId| embedding[vertex].distance_squared(embedding[from]);
        vertices.iter().copied().max_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let first = from(*vertices.first()?)?;
    Some([first, from(first)?])
}
