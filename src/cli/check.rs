//! `freebound check`: diagnosis of a mesh, and verdict on its texture coordinates if there are any.

use std::sync::Arc;
use std::time::Instant;

use super::args::CheckArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome};
use super::opened::disk_of;
use super::places::OutputPaths;
use super::progress::go_on;
use super::standard::{MemoryLimit, read_model};
use super::summary::{deliver, file_words, mesh_words};
use crate::session::Model;
use freebound_core::mesh::{DiskMesh, Preparation, parts};
use freebound_core::pipeline::{PreparedMesh, Surface};
use freebound_core::verify::{distortion, equal_outlines, stacked_atlas_verdict, verdict};
use freebound_io::{MeshReport, ReadWarning, Report, Seconds, TextureError, TextureMesh, verdict_as_in_file};

pub(super) fn run(arguments: &CheckArguments) -> Result<CommandOutcome, CommandError> {
    let start = Instant::now();
    let places = OutputPaths::of_check(arguments);
    places.spare(&arguments.mesh, "the mesh")?;
    await_report(arguments.report.as_deref());
    let model = read_model(&arguments.mesh, MemoryLimit::typed(arguments.large))?.in_form(Preparation::default());
    places.spare_materials(&model.source, &arguments.mesh)?;
    let path = model.path_words();
    let mut texture = match model.source.texture_mesh() {
        Ok(texture) => texture,
        Err(TextureError::None) => {
            return check_mesh(&model, arguments, path, start);
        }
        Err(error) => return Err(CommandError::Texture { path, error }),
    };
    let disk = DiskMesh::try_from(texture.mesh.clone()).or_else(|_| {
        // Try again without redundant faces, which repairs leave in the file.
        texture.mesh = std::mem::take(&mut texture.mesh).without_repeats();
        texture.drop_collapsed_faces();
        DiskMesh::try_from(texture.mesh.clone())
    });
    let Ok(mesh) = disk else {
        let warnings = &model.source.warnings;
        let layout = Layout { texture: &texture, is_of_32_bits: model.source.is_turned_over(), warnings };
        return check_charts(arguments, layout, path, start);
    };
    let read = start.elapsed().as_secs_f64();
    go_on()?;
    let mut verdict = verdict(&mesh, &texture.embedding);
    verdict.planar_in_f32 |= verdict.planar && model.source.is_turned_over();
    let distortion = distortion(&mesh, &texture.embedding);
    go_on()?;
    let in_f32 = verdict.summary_in_f32().map(|words| format!("; {words}")).unwrap_or_default();
    let words = format!("{path}: texture coordinates: {}{in_f32}", verdict.summary());
    let report = Report {
        verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
        distortion: Some(distortion.summary),
        ..report(MeshReport { warnings: model.source.warnings.clone(), ..MeshReport::new(path, &mesh) }, start, read)
    };
    deliver(&report, arguments.report.as_deref(), || with_file_words(words, &report))?;
    Ok(if verdict.planar { CommandOutcome::Fine } else { CommandOutcome::FallsShort })
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
    let repairs = model.whole_repaired().map(|repaired| repaired.done().to_vec()).unwrap_or_default();
    let warnings = model.source.warnings.clone();
    let report = report(MeshReport { repairs, warnings, ..mesh }, start, start.elapsed().as_secs_f64());
    let notes = &report.mesh;
    let first = format!(
        "{}: {kind}, {} vertices, {} faces, {} on the boundary, {} dividing edges, {} ears; no texture coordinates",
        notes.path, notes.vertices, notes.faces, notes.boundary_vertices, notes.dividing_edges, notes.ears
    );
    let words = std::iter::once(first).chain(file_words(notes)).chain(mesh_words(notes)).collect::<Vec<_>>().join("\n");
    deliver(&report, arguments.report.as_deref(), || words)?;
    Ok(CommandOutcome::Fine)
}

/// Texture coordinates of a file.
#[derive(Clone, Copy)]
struct Layout<'a> {
    texture: &'a TextureMesh,
    /// True if the file stores only 32-bit numbers, so that a proof also holds in 32 bits.
    is_of_32_bits: bool,
    /// Elements of the file that were left out.
    warnings: &'a [ReadWarning],
}

/// Verdict on a layout of several charts or with holes.
fn check_charts(
    arguments: &CheckArguments,
    Layout { texture, is_of_32_bits, warnings }: Layout<'_>,
    path: String,
    start: Instant,
) -> Result<CommandOutcome, CommandError> {
    let charts = parts(&texture.mesh).map_err(|diagnosis| CommandError::NotADisk {
        path: format!("{path} (cut along the seams of its texture coordinates)"),
        diagnosis,
        remedy: None,
    })?;
    let read = start.elapsed().as_secs_f64();
    go_on()?;
    let stacked_on =
        if arguments.stacked { equal_outlines(&charts, &texture.embedding) } else { vec![None; charts.len()] };
    let verdict = stacked_atlas_verdict(&charts, &texture.embedding, &stacked_on);
    let mut verdict = verdict.as_in_file(&texture.mesh);
    verdict.planar_in_f32 |= verdict.planar && is_of_32_bits;
    go_on()?;
    let in_f32 = if verdict.planar_in_f32 { "; holds in 32 bits" } else { "; does not hold in 32 bits" };
    let in_f32 = if verdict.planar { in_f32 } else { "" };
    let words = format!("{path}: texture coordinates: {}{in_f32}", verdict.summary());
    let status = if verdict.planar { CommandOutcome::Fine } else { CommandOutcome::FallsShort };
    let atlas = Some(verdict);
    let mesh =
        MeshReport { warnings: warnings.to_vec(), ..MeshReport::of_charts(path, texture.mesh.vertex_count(), &charts) };
    let report = Report { atlas, ..report(mesh, start, read) };
    deliver(&report, arguments.report.as_deref(), || with_file_words(words, &report))?;
    Ok(status)
}

/// Verdict with a line for what was left out of the file.
fn with_file_words(verdict: String, report: &Report) -> String {
    std::iter::once(verdict).chain(file_words(&report.mesh)).collect::<Vec<_>>().join("\n")
}

/// Report on the mesh alone.
fn report(mesh: MeshReport, start: Instant, read: f64) -> Report {
    let total = start.elapsed().as_secs_f64();
    Report { seconds: Seconds { read, verify: total - read, total, ..Seconds::default() }, ..Report::of_mesh(mesh) }
}
