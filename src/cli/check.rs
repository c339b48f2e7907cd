//! `freebound check`: diagnosis of a mesh, and verdict on its texture coordinates if there are any.

use std::sync::Arc;
use std::time::Instant;

use super::args::CheckArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome};
use super::opened::disk_of;
use super::places::OutputPaths;
use super::progress::{INTERRUPTED, go_on};
use super::say::say;
use super::standard::read_typed;
use super::summary::{deliver, file_words, finding_words, mesh_words, size_words};
use crate::session::Model;
use freebound_core::mesh::{DiskMesh, Part, Preparation, parts};
use freebound_core::pipeline::{PreparedMesh, Surface};
use freebound_core::problem::{Control, SolveError};
use freebound_core::verify::{
    AtlasVerdict, ChartRelations, DistortionSummary, Verdict, distortion, equal_outlines, stacked_atlas_verdict,
    verdict,
};
use freebound_io::{
    JudgeError, JudgedLayout, MeshReport, Report, Seconds, TextureError, TextureMesh, groups_of, verdict_as_in_file,
};

pub(super) fn run(arguments: &CheckArguments) -> Result<CommandOutcome, CommandError> {
    let start = Instant::now();
    let places = OutputPaths::of_check(arguments);
    places.spare(&arguments.mesh, "the mesh")?;
    await_report(arguments.report.as_deref());
    let model = read_typed(&arguments.mesh, arguments.reading)?.in_form(Preparation::default());
    places.spare_materials(&model.source, &arguments.mesh)?;
    let path = model.path_words();
    let read = start.elapsed().as_secs_f64();
    go_on()?;
    let control = Control::new(&INTERRUPTED, &|_| {});
    let JudgedLayout { texture, labels, verdict } =
        match model.source.judged_layout(arguments.options(), arguments.across_materials, control) {
            Ok(found) => found,
            Err(JudgeError::Texture(TextureError::None)) => return check_mesh(&model, arguments, path, start),
            Err(JudgeError::Texture(error)) => return Err(CommandError::Texture { path, error }),
            Err(JudgeError::Cancelled) => return Err(SolveError::Cancelled.into()),
        };
    let found = verdict.judged_by(&arguments.ignore, &arguments.denied_codes());
    go_on()?;
    let outcome = CommandOutcome::of(found.passes);
    let mesh = MeshReport { warnings: model.source.warnings.clone(), ..MeshReport::default() };
    let first = format!("{path}: texture coordinates: {}", found.summary());
    let lines = std::iter::once(first).chain(file_words(&mesh)).chain(found.findings.iter().map(finding_words));
    let words = lines.collect::<Vec<_>>().join("\n");
    if arguments.report.is_none() {
        say(words)?;
        return Ok(outcome);
    }
    let of_surface = OfSurface::of(texture, labels.as_deref(), arguments.stacked, path);
    go_on()?;
    let mesh = MeshReport { warnings: mesh.warnings, ..of_surface.mesh };
    let report = Report {
        verdict: of_surface.verdict,
        distortion: of_surface.distortion,
        atlas: of_surface.atlas,
        layout: Some(found),
        ..report(mesh, start, read)
    };
    deliver(&report, arguments.report.as_deref(), || words)?;
    Ok(outcome)
}

/// Material of all triangles of a chart; `None` if they differ.
fn group_of(labels: &[u32], chart: &Part) -> Option<u32> {
    let all = groups_of(labels, chart.mesh());
    all.first().copied().filter(|first| all.iter().all(|label| label == first))
}

/// Verdicts of the theorems on disks, for the report: of a layout that is a disk, or whose charts are surfaces with
/// boundary.
struct OfSurface {
    mesh: MeshReport,
    verdict: Option<Verdict>,
    distortion: Option<DistortionSummary>,
    atlas: Option<AtlasVerdict>,
}

impl OfSurface {
    fn of(mut texture: TextureMesh, labels: Option<&[u32]>, accepts_stacks: bool, path: String) -> Self {
        let disk = DiskMesh::try_from(texture.mesh.clone()).or_else(|_| {
            // Try again without redundant faces, which repairs leave in the file.
            texture.mesh = std::mem::take(&mut texture.mesh).without_repeats();
            texture.drop_collapsed_faces();
            DiskMesh::try_from(texture.mesh.clone())
        });
        let (vertices, faces) = (texture.mesh.vertex_count(), texture.mesh.face_count());
        if let Ok(disk) = disk {
            let verdict = verdict(&disk, &texture.embedding);
            return Self {
                mesh: MeshReport::new(path, &disk),
                distortion: Some(distortion(&disk, &texture.embedding).summary),
                verdict: Some(verdict_as_in_file(&verdict, disk.mesh())),
                atlas: None,
            };
        }
        let Ok(charts) = parts(&texture.mesh) else {
            let mesh = MeshReport { path, vertices, faces, ..MeshReport::default() };
            return Self { mesh, verdict: None, distortion: None, atlas: None };
        };
        let stacked_on = if accepts_stacks { equal_outlines(&charts, &texture.embedding) } else { Vec::new() };
        let groups = labels.map(|labels| charts.iter().map(|chart| group_of(labels, chart)).collect());
        let relations = ChartRelations { stacked_on, groups: groups.unwrap_or_default() };
        let atlas = stacked_atlas_verdict(&charts, &texture.embedding, &relations).as_in_file(&texture.mesh);
        let mesh = MeshReport::of_charts(path, vertices, &charts);
        Self { mesh, verdict: None, distortion: None, atlas: Some(atlas) }
    }
}

/// Diagnosis of a mesh without texture coordinates: its size, and all faults that a default run repairs or ignores.
fn check_mesh(
    model: &Model,
    arguments: &CheckArguments,
    path: String,
    start: Instant,
) -> Result<CommandOutcome, CommandError> {
    let disk = disk_of(model)?;
    go_on()?;
    let count = model.prepared.chart_count();
    let (mesh, kind) = if count > 1 {
        let charts: Vec<PreparedMesh> = (0..count).map(|chart| model.prepared.of_chart(chart)).collect();
        let disk = |chart: &PreparedMesh| match &chart.surface {
            Surface::Disk(disk) => Ok(Arc::clone(disk)),
            Surface::Faulty(_, diagnosis) => {
                let (path, diagnosis) = (path.clone(), Box::new(diagnosis.as_ref().clone()));
                Err(CommandError::NotADisk { path, diagnosis, remedy: None })
            }
        };
        let disks = charts.iter().map(disk).collect::<Result<Vec<_>, _>>()?;
        let holes = match disks.iter().map(|disk| disk.mesh().holes().len()).sum::<usize>() {
            0 => String::new(),
            1 => ", with a hole".to_owned(),
            count => format!(", with {count} holes"),
        };
        let given = model.source.polygons.positions.len();
        let vertices = model.whole_repaired().map_or(given, |whole| whole.polygons().positions.len());
        (
            MeshReport::of_disks(path, vertices, disks.iter().map(AsRef::as_ref)),
            format!("{count} parts, each a disk{holes}"),
        )
    } else {
        let holes = match disk.mesh().holes().len() {
            0 => String::new(),
            1 => " with a hole".to_owned(),
            count => format!(" with {count} holes"),
        };
        (MeshReport::new(path, disk), format!("a disk{holes}"))
    };
    let mesh = mesh.prepared(&model.source, &model.prepared);
    let report = report(mesh, start, start.elapsed().as_secs_f64());
    let notes = &report.mesh;
    let first = format!("{}: {kind}, {}; no texture coordinates", notes.path, size_words(notes));
    let words = std::iter::once(first).chain(file_words(notes)).chain(mesh_words(notes)).collect::<Vec<_>>().join("\n");
    deliver(&report, arguments.report.as_deref(), || words)?;
    Ok(CommandOutcome::Fine)
}

/// Report on the mesh alone.
fn report(mesh: MeshReport, start: Instant, read: f64) -> Report {
    let total = start.elapsed().as_secs_f64();
    Report { seconds: Seconds { read, verify: total - read, total, ..Seconds::default() }, ..Report::of_mesh(mesh) }
}
