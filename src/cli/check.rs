//! `freebound check`: the diagnosis of a mesh, and the verdict on its texture coordinates where it has some.

use std::path::Path;
use std::time::Instant;

use super::args::CheckArguments;
use super::flatten::disk_of;
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
    let model = Model::read(&arguments.mesh)?;
    let Some(texture) = texture_of(&model)? else {
        let mesh = disk_of(&model)?;
        let notes = MeshReport::new(model.path_words(), mesh);
        println!(
            "{}: a disk of {} vertices and {} faces, {} on the boundary, {} dividing edges, {} ears; no texture \
             coordinates",
            notes.path, notes.vertices, notes.faces, notes.boundary_vertices, notes.dividing_edges, notes.ears
        );
        return Ok(Status::Fine);
    };
    let read = start.elapsed().as_secs_f64();
    let mesh = DiskMesh::try_from(texture.mesh).map_err(|diagnosis| Failure::NotADisk {
        path: format!("{} (cut along the seams of its texture coordinates)", model.path_words()),
        diagnosis,
    })?;
    let verdict = verdict(&mesh, &texture.embedding);
    let distortion = distortion(&mesh, &texture.embedding);
    println!("{}: texture coordinates: {}", model.path_words(), verdict.summary());
    if let Some(path) = &arguments.report {
        let total = start.elapsed().as_secs_f64();
        let report = Report {
            freebound: env!("CARGO_PKG_VERSION"),
            mesh: MeshReport::new(model.path_words(), &mesh),
            method: None,
            family: None,
            pins: None,
            steps: Vec::new(),
            verdict: verdict_as_in_file(&verdict, mesh.mesh()),
            distortion: distortion.summary,
            new_vertices: 0,
            seconds: Seconds { read, verify: total - read, total, ..Seconds::default() },
            peak_memory_bytes: peak_memory_bytes(),
        };
        write_report(&report, path)?;
    }
    Ok(if verdict.planar { Status::Fine } else { Status::NotPlanar })
}

/// The mesh of the texture coordinates, `None` where the file has none.
fn texture_of(model: &Model) -> Result<Option<TextureMesh>, Failure> {
    match model.source.texture_mesh() {
        Ok(texture) => Ok(Some(texture)),
        Err(TextureError::None) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

fn write_report(report: &Report, path: &Path) -> Result<(), WriteError> {
    if path == Path::new("-") {
        println!("{}", serde_json::to_string_pretty(report).expect("a report is plain data"));
        return Ok(());
    }
    write_atomically(path, |out| serde_json::to_writer_pretty(out, report).map_err(Into::into))
}
