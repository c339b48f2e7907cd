//! Exports of the map: files of results, cutting patterns, and pictures drawn for the map.

use std::path::{Path, PathBuf};

use super::{BakeRequest, Model, PatternRequest, SaveRequest, Written};
use freebound_core::pipeline::Fit;
use freebound_core::problem::{Control, SolveError};
use freebound_io::raster::write_png;
use freebound_io::{
    BakedPicture, MeshFile, Output, PaintedSurface, Pattern, PatternError, PatternFormat, PatternOptions, TextureError,
    TexturedMesh, WriteError, bake, write_atomically,
};

/// Export that the user requested.
#[derive(Clone, Debug)]
pub(super) enum Export {
    /// File of the result.
    Result(SaveRequest),
    /// Layout as a flat mesh.
    FlatMesh(PathBuf),
    /// Cutting pattern.
    Pattern(PatternRequest),
    /// Picture of the file's layout, drawn for the layout on the screen.
    Baked(BakeRequest),
}

impl Export {
    /// Path of the file.
    pub(super) fn path(&self) -> &PathBuf {
        match self {
            Self::Result(request) => &request.path,
            Self::FlatMesh(path) => path,
            Self::Pattern(request) => &request.path,
            Self::Baked(request) => &request.path,
        }
    }

    /// Size of the layout in the file.
    pub(super) fn fit(&self) -> Fit {
        match self {
            Self::Result(request) => request.fit,
            // A flat mesh and a pattern find the true size by themselves, and a picture shows the unit square.
            Self::FlatMesh(_) | Self::Pattern(_) | Self::Baked(_) => Fit::default(),
        }
    }

    /// Writes the finished map of a mesh. Fails by [`WriteError::cancelled`] if the caller cancels in time.
    pub(super) fn write(
        &self,
        mut output: Output<'_>,
        model: &Model,
        control: Control<'_>,
    ) -> Result<Written, WriteError> {
        control.go_on().map_err(|_| WriteError::cancelled(self.path()))?;
        match self {
            Self::Result(request) => {
                output.round_to(None, request.kind);
                let files = output.write(request.kind, &request.path)?;
                Ok(Written { files, about: Some(output.summary()) })
            }
            Self::FlatMesh(path) => {
                output.write_flat_mesh(path)?;
                Ok(Written { about: Some(output.summary()), ..Written::file(path.clone()) })
            }
            Self::Pattern(PatternRequest { path, options }) => write_pattern(&output, model, path, *options),
            Self::Baked(request) => write_baked(&output, model, request, control),
        }
    }
}

fn write_pattern(
    output: &Output<'_>,
    model: &Model,
    path: &Path,
    options: PatternOptions,
) -> Result<Written, WriteError> {
    let name = Path::new(&model.name).file_stem().unwrap_or_default().to_string_lossy();
    let fault = |error: PatternError| WriteError::writing(path, std::io::Error::other(error));
    let pattern = Pattern::new(&output.charts, output.aspect, &name, options).map_err(fault)?;
    let format = PatternFormat::of_path(path).unwrap_or(PatternFormat::Pdf);
    write_atomically(path, |out| pattern.write(format, out))?;
    Ok(Written { about: Some(pattern.summary()), ..Written::file(path.to_owned()) })
}

/// Draws the picture of the file's layout for the finished map.
fn write_baked(
    output: &Output<'_>,
    model: &Model,
    BakeRequest { path, options }: &BakeRequest,
    control: Control<'_>,
) -> Result<Written, WriteError> {
    let fault = |error: TextureError| WriteError::writing(path, std::io::Error::other(error));
    let TexturedMesh { mesh, texture, .. } = output.textured();
    let new = MeshFile { texture: Some(texture), ..mesh.into_owned() };
    let (old, _) = model.source.partial_texture_mesh().map_err(fault)?;
    let (new, _) = new.partial_texture_mesh().map_err(fault)?;
    let picture = output.picture.ok_or_else(|| fault(TextureError::None))?;
    let old = PaintedSurface { layout: old.surface(), picture: &picture.pixels };
    let baked = bake(old, new.surface(), *options, control);
    let BakedPicture { picture, report } = baked.map_err(|error| match error {
        SolveError::Cancelled => WriteError::cancelled(path),
        error => WriteError::writing(path, std::io::Error::other(error)),
    })?;
    write_atomically(path, |out| write_png(&picture, out))?;
    let mut about = format!("{} × {} pixels, {:.0} % covered", picture.width, picture.height, 100.0 * report.covered);
    if report.outside > 0 {
        about.push_str("; some faces lie outside the picture: pack the charts first");
    }
    Ok(Written { about: Some(about), ..Written::file(path.to_owned()) })
}
