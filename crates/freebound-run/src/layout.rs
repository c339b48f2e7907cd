//! A finished run as arrays.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use glam::DVec2;

use super::{Model, Run, SolvedRun};
use freebound_core::mesh::{FaceId, NewVertex, VertexId};
use freebound_core::pipeline::LaidChart;
use freebound_core::problem::Embedding;
use freebound_core::verify::{FaceDistortion, distortion};
use freebound_io::{MeshFile, Output, OutputKind, Precision, Report, Texture, TexturedMesh, WriteError};

/// Value in [`MeshLayout::chart_of_face`] for a face that is not flattened.
pub const NO_CHART: u32 = u32::MAX;

/// Texture coordinates of a mesh, with their proof and their report.
///
/// Faces and vertices of the mesh keep their numbers. New vertices come after all others; a face that they split is
/// replaced by its parts, in place.
#[derive(Debug)]
pub struct MeshLayout {
    /// The mesh, with the new vertices if there are any.
    pub mesh: Arc<MeshFile>,
    /// Texture coordinates, v up, and the index of each corner's coordinate.
    pub texture: Texture,
    /// New vertices, on edges of the input.
    pub new_vertices: Vec<NewVertex>,
    /// Face of the input that each face is, or is a part of. Absent if the faces are those of the input.
    pub face_of: Option<Vec<u32>>,
    /// Chart of each face, or [`NO_CHART`].
    pub chart_of_face: Vec<u32>,
    /// Report of the run. It holds the verdict.
    pub report: Report,
    planar: bool,
    summary: String,
    laid: Vec<LaidTriangles>,
    triangles: OnceLock<Vec<TriangleOfFace>>,
    origin: FinishedRun,
}

/// Triangles of a chart in the plane.
#[derive(Debug)]
struct LaidTriangles {
    /// Position of each vertex of the chart's mesh: texture coordinates, u times the aspect of the picture.
    plane: Embedding,
    /// Face of each triangle in the mesh of the layout.
    faces: Vec<u32>,
}

/// Run that a layout comes from, for writing it again in another precision.
#[derive(Debug)]
pub(super) struct FinishedRun {
    pub(super) model: Model,
    pub(super) run: Run,
    pub(super) solved: SolvedRun,
    /// Precision of the request.
    pub(super) precision: Option<Precision>,
}

/// Triangle of a face, with its distortion.
#[derive(Clone, Copy, Debug)]
pub struct TriangleOfFace {
    /// Number of the face in the mesh of the layout.
    pub face: u32,
    /// Area of the triangle on the surface; 0 if the face is not flattened.
    pub area: f64,
    /// Distortion of the triangle, at the scale at which its chart has the area of its surface. Absent if the face is
    /// not flattened.
    pub distortion: Option<FaceDistortion>,
}

impl TriangleOfFace {
    /// Greater and lesser singular value of the map from the surface to the plane. `None` also if the map collapses the
    /// triangle.
    pub fn singular_values(&self) -> Option<[f64; 2]> {
        let FaceDistortion { angle, area, .. } = self.distortion.filter(|distortion| distortion.area > 0.0)?;
        Some([(area * angle).sqrt(), (area / angle).sqrt()])
    }
}

impl MeshLayout {
    /// Lays out a solved run, and proves the layout in a precision.
    pub(super) fn new(origin: FinishedRun) -> io::Result<Self> {
        let mut output = origin.solved.output(&origin.run)?;
        output.round_to(Some(origin.precision.unwrap_or_default()), OutputKind::Obj);
        let (planar, summary) = (output.is_planar(), output.summary());
        let TexturedMesh { mesh, texture, new_vertices, face_of } = output.textured();
        let source = &origin.model.source;
        let mesh = match mesh {
            Cow::Borrowed(_) => Arc::clone(source),
            Cow::Owned(mesh) => Arc::new(mesh),
        };
        let mut chart_of_face = vec![NO_CHART; mesh.polygons.face_count()];
        let faces = faces_of_triangles(&output, face_of.as_deref(), source.polygons.face_count());
        for (chart, faces) in (0..).zip(&faces) {
            for &face in faces {
                chart_of_face[face as usize] = chart;
            }
        }
        let plane = DVec2::new(output.aspect, 1.0);
        let in_plane = |chart: &LaidChart<'_>| chart.coordinates.iter().map(|uv| *uv * plane).collect();
        let laid =
            output.charts.iter().zip(faces).map(|(chart, faces)| LaidTriangles { plane: in_plane(chart), faces });
        let (laid, report, triangles) = (laid.collect(), output.report, OnceLock::new());
        Ok(Self {
            mesh,
            texture,
            new_vertices,
            face_of,
            chart_of_face,
            report,
            planar,
            summary,
            laid,
            triangles,
            origin,
        })
    }

    /// Triangles of the proof, in the order of the faces. A face that is not flattened has one without distortion. The
    /// first call computes them.
    pub fn triangles(&self) -> &[TriangleOfFace] {
        self.triangles.get_or_init(|| {
            let mut triangles = Vec::with_capacity(self.laid.iter().map(|laid| laid.faces.len()).sum());
            for (chart, laid) in self.solved().charts.iter().zip(&self.laid) {
                let mesh = chart.mesh();
                let distortions = distortion(mesh, &laid.plane).faces;
                for ((number, &face), distortion) in (0..).zip(&laid.faces).zip(distortions) {
                    let area = 0.5 * mesh.mesh().double_area_vector(FaceId::new(number)).length();
                    triangles.push(TriangleOfFace { face, area, distortion: Some(distortion) });
                }
            }
            let left_out = (0..).zip(&self.chart_of_face).filter(|(_, chart)| **chart == NO_CHART);
            triangles.extend(left_out.map(|(face, _)| TriangleOfFace { face, area: 0.0, distortion: None }));
            triangles.sort_by_key(|triangle| triangle.face);
            triangles
        })
    }

    /// True if the coordinates are proved one-to-one.
    pub fn is_planar(&self) -> bool {
        self.planar
    }

    /// Verdict in lower-case words.
    pub fn summary(&self) -> &str {
        &self.summary
    }

    /// True if the coordinates are proved one-to-one, all hard pins are met, and charts have the density that was asked
    /// for.
    pub fn is_fine(&self) -> bool {
        self.planar && self.report.meets_request()
    }

    /// The mesh in its preparation.
    pub fn model(&self) -> &Model {
        &self.origin.model
    }

    /// Charts with their last steps.
    pub fn solved(&self) -> &SolvedRun {
        &self.origin.solved
    }

    /// Coordinates in 64 bits, laid out and proved again.
    ///
    /// # Errors
    ///
    /// Errors of [`SolvedRun::output`].
    pub fn output(&self) -> io::Result<Output<'_>> {
        self.origin.solved.output(&self.origin.run)
    }

    /// Texture coordinate of each corner, `None` at corners of faces that are not flattened.
    pub fn corner_coordinates(&self) -> impl Iterator<Item = Option<DVec2>> {
        self.texture.corners.iter().map(|&number| self.texture.coordinates.get(number as usize).copied())
    }

    /// Inner edges of the mesh whose sides have different coordinates, by its vertices, in ascending order.
    pub fn cut_edges(&self) -> Vec<[VertexId; 2]> {
        let polygons = &self.mesh.polygons;
        let mut sides: HashMap<[VertexId; 2], Vec<[u32; 2]>> = HashMap::new();
        for face in 0..polygons.face_count() {
            let range = polygons.corner_range(face);
            let count = range.len();
            for at in 0..count {
                let corners = [range.start + at, range.start + (at + 1) % count];
                let mut edge = corners.map(|corner| polygons.corners[corner]);
                let mut side = corners.map(|corner| self.texture.corners[corner]);
                if edge[0] > edge[1] {
                    edge.reverse();
                    side.reverse();
                }
                sides.entry(edge).or_default().push(side);
            }
        }
        let is_cut = |sides: &[[u32; 2]]| sides.iter().any(|side| *side != sides[0]);
        let mut edges: Vec<_> = sides.into_iter().filter(|(_, sides)| is_cut(sides)).map(|(edge, _)| edge).collect();
        edges.sort_unstable();
        edges
    }

    /// Writes a mesh file with the coordinates, or another kind of file. Default of the precision: that of the request, or
    /// the usual one of the kind. Coordinates that 32 bits fold are written, and are not planar.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(
        &self,
        path: &Path,
        kind: OutputKind,
        precision: Option<Precision>,
    ) -> Result<WrittenLayout, WriteError> {
        let mut output = self.output().map_err(|source| WriteError::writing(path, source))?;
        output.round_to(precision.or(self.origin.precision), if kind.is_mesh() { kind } else { OutputKind::Obj });
        output.report.not_kept = output.not_kept_in(kind).into_iter().collect::<BTreeSet<_>>().into_iter().collect();
        let files = output.write(kind, path)?;
        Ok(WrittenLayout { files, planar: output.is_planar(), summary: output.summary() })
    }
}

/// Layout in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenLayout {
    /// Files that were written, that of the layout first.
    pub files: Vec<PathBuf>,
    /// True if the written numbers are proved one-to-one.
    pub planar: bool,
    /// Verdict on the written numbers in lower-case words.
    pub summary: String,
}

/// Written face of each triangle, chart by chart. `face_of` is the face of the input for each face of the written mesh, if
/// they differ.
fn faces_of_triangles(output: &Output<'_>, face_of: Option<&[u32]>, input_faces: usize) -> Vec<Vec<u32>> {
    // First written face of each face of the input.
    let mut first: Vec<u32> = vec![0; input_faces + 1];
    match face_of {
        Some(face_of) => {
            for &face in face_of {
                first[face as usize + 1] += 1;
            }
            (0..input_faces).for_each(|face| first[face + 1] += first[face]);
        }
        None => (0..).zip(&mut first).for_each(|(face, first)| *first = face),
    }
    let of_chart = |chart: &LaidChart<'_>| {
        let triangles = chart.mesh.mesh();
        let count = triangles.real_face_count();
        let polygons: Vec<u32> = (0..count).map(|face| triangles.polygon(FaceId::from_index(face))).collect();
        let mut faces = Vec::with_capacity(count);
        for polygon in polygons.chunk_by(|a, b| a == b) {
            let [begin, end] = [first[polygon[0] as usize], first[polygon[0] as usize + 1]];
            // The face is whole, or each of its triangles is a face.
            faces.extend((begin..end).cycle().take(polygon.len()));
        }
        faces
    };
    output.charts.iter().map(of_chart).collect()
}
