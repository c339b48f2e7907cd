//! `freebound check`: the diagnosis of a mesh, and the verdict on its texture coordinates where it has some.

use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use super::args::CheckArguments;
use super::flatten::{disk_of, go_on, print_report};
use super::progress::is_interrupted;
use super::{Failure, Status};
use crate::io::{
    MeshReport, Report, Seconds, TextureError, TextureMesh, WriteError, peak_memory_bytes, verdict_as_in_file,
    write_atomically,
};
use crate::mesh::DiskMesh;
use crate::session::Model;
use crate::solver::{distortion, verdict};

pub(super) fn run(arguments: &CheckArguments) -> Result<Status, Failure> {
    let start = Instant::now();
    let model = Model::read_until(&arguments.mesh, &is_interrupted)?;
    let path = model.path_words();
    let Some(texture) = texture_of(&model)? else {
        let mesh = disk_of(&model)?;
        go_on()?;
        let report = report(MeshReport::new(path, mesh), start, start.elapsed().as_secs_f64());
        let notes = &report.mesh;
        let words = format!(
            "{}: a disk of {} vertices and {} faces, {} on the boundary, {} dividing edges, {} ears; no texture \
             coordinates",
            notes.path, notes.vertices, notes.faces, notes.boundary_vertices, notes.dividing_edges, notes.ears
        );
        conclude(arguments, &report, &words)?;
        return Ok(Status::Fine);
    };
    let mesh = DiskMesh::try_from(texture.mesh).map_err(|diagnosis| Failure::NotADisk {
        path: format!("{path} (cut along the seams of its texture coordinates)"),
        diagnosis,
    })?;
    let read = start.elapsed().as_secs_f64();
    go_on()?;
    let verdict = verdict(&mesh, &texture.embedding);
    let distortion = distortion(&mesh, &texture.embedding);
    go_on()?;
    let words = format!("{path}: texture coordinates: {}", verdict.summary());
    let report = Report {
        verdict: Some(verdict_as_in_file(&verdict, mesh.mesh())),
        distortion: Some(distortion.summary),
        ..report(MeshReport::new(path, &mesh), start, read)
    };
    conclude(arguments, &report, &words)?;
    Ok(if verdict.planar { Status::Fine } else { Status::FallsShort })
}

/// A report on the mesh alone.
fn report(mesh: MeshReport, start: Instant, read: f64) -> Report {
    let total = start.elapsed().as_secs_f64();
    Report {
        freebound: env!("CARGO_PKG_VERSION"),
        mesh,
        method: None,
        boundary: None,
        placement: None,
        family: None,
        pins: None,
        steps: Vec::new(),
        verdict: None,
        distortion: None,
        new_vertices: 0,
        split_edges: Vec::new(),
        seconds: Seconds { read, verify: total - read, total, ..Seconds::default() },
        peak_memory_bytes: peak_memory_bytes(),
    }
}

/// Writes the report where it is wanted, and the words unless standard output is for the report.
fn conclude(arguments: &CheckArguments, report: &Report, words: &str) -> Result<(), WriteError> {
    match &arguments.report {
        Some(path) if path == Path::new("-") => {
            print_report(report);
            return Ok(());
        }
        Some(path) => write_atomically(path, |out| {
            serde_json::to_writer_pretty(&mut *out, report)?;
            writeln!(out)
        })?,
        None => {}
    }
    println!("{words}");
    Ok(())
}

/// The mesh of the texture coordinates, `None` where the file has none.
fn texture_of(model: &Model) -> Result<Option<TextureMesh>, Failure> {
    match model.source.texture_mesh() {
        Ok(texture) => Ok(Some(texture)),
        Err(TextureError::None) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
