//! `freebound check`: the diagnosis of a mesh, and the verdict on its texture coordinates where it has some.

use std::time::Instant;

use super::args::CheckArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome};
use super::opened::disk_of;
use super::places::OutputPaths;
use super::progress::go_on;
use super::standard::{MemoryLimit, read_model};
use super::summary::deliver;
use freebound_core::mesh::{DiskMesh, Preparation, parts};
use freebound_core::verify::{atlas_verdict, distortion, verdict};
use freebound_io::{MeshReport, Report, Seconds, TextureError, TextureMesh, verdict_as_in_file};

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
            let mesh = disk_of(&model)?;
            go_on()?;
            let report = report(MeshReport::new(path, mesh), start, start.elapsed().as_secs_f64());
            let notes = &report.mesh;
            let holes = match mesh.mesh().holes().len() {
                0 => String::new(),
                1 => "with a hole, ".to_owned(),
                count => format!("with {count} holes, "),
            };
            let words = format!(
                "{}: a disk {holes}of {} vertices and {} faces, {} on the boundary, {} dividing edges, {} ears; no \
                 texture coordinates",
                notes.path, notes.vertices, notes.faces, notes.boundary_vertices, notes.dividing_edges, notes.ears
            );
            deliver(&report, arguments.report.as_deref(), || words)?;
            return Ok(CommandOutcome::Fine);
        }
        Err(error) => return Err(CommandError::Texture { path, error }),
    };
    let disk = DiskMesh::try_from(texture.mesh.clone()).or_else(|_| {
        // Looked at again without faces that add nothing, which a repair leaves in the file.
        texture.mesh = std::mem::take(&mut texture.mesh).without_repeats();
        texture.drop_collapsed_faces();
        DiskMesh::try_from(texture.mesh.clone())
    });
    let Ok(mesh) = disk else {
        let layout = Layout { texture: &texture, is_of_32_bits: model.source.is_turned_over() };
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
        ..report(MeshReport::new(path, &mesh), start, read)
    };
    deliver(&report, arguments.report.as_deref(), || words)?;
    Ok(if verdict.planar { CommandOutcome::Fine } else { CommandOutcome::FallsShort })
}

/// The texture coordinates of a file.
#[derive(Clone, Copy)]
struct Layout<'a> {
    texture: &'a TextureMesh,
    /// Whether the file has no other numbers: what is proved of them holds in 32 bits.
    is_of_32_bits: bool,
}

/// The verdict on a layout of several charts, or of one with holes.
fn check_charts(
    arguments: &CheckArguments,
    Layout { texture, is_of_32_bits }: Layout<'_>,
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
    let mut verdict = atlas_verdict(&charts, &texture.embedding).as_in_file(&texture.mesh);
    verdict.planar_in_f32 |= verdict.planar && is_of_32_bits;
    go_on()?;
    let in_f32 = if verdict.planar_in_f32 { "; holds in 32 bits" } else { "; does not hold in 32 bits" };
    let in_f32 = if verdict.planar { in_f32 } else { "" };
    let words = format!("{path}: texture coordinates: {}{in_f32}", verdict.summary());
    let status = if verdict.planar { CommandOutcome::Fine } else { CommandOutcome::FallsShort };
    let atlas = Some(verdict);
    let report =
        Report { atlas, ..report(MeshReport::of_charts(path, texture.mesh.vertex_count(), &charts), start, read) };
    deliver(&report, arguments.report.as_deref(), || words)?;
    Ok(status)
}

/// A report on the mesh alone.
fn report(mesh: MeshReport, start: Instant, read: f64) -> Report {
    let total = start.elapsed().as_secs_f64();
    Report { seconds: Seconds { read, verify: total - read, total, ..Seconds::default() }, ..Report::of_mesh(mesh) }
}
