//! Exports of the map: files of results, and cutting patterns.

use std::path::{Path, PathBuf};

use super::{Model, PatternRequest, SaveRequest, Written};
use freebound_core::pipeline::Fit;
use freebound_io::{Output, Pattern, PatternError, PatternFormat, PatternOptions, WriteError, write_atomically};

/// Export that the user requested.
#[derive(Clone, Debug)]
pub(super) enum Export {
    /// File of the result.
    Result(SaveRequest),
    /// Cutting pattern.
    Pattern(PatternRequest),
}

impl Export {
    /// Path of the file.
    pub(super) fn path(&self) -> &PathBuf {
        match self {
            Self::Result(request) => &request.path,
            Self::Pattern(request) => &request.path,
        }
    }

    /// Size of the layout in the file.
    pub(super) fn fit(&self) -> Fit {
        match self {
            Self::Result(request) => request.fit,
            // A pattern finds the true size of every chart by itself.
            Self::Pattern(_) => Fit::default(),
        }
    }

    /// Writes the finished map of a mesh.
    pub(super) fn write(&self, mut output: Output<'_>, model: &Model) -> Result<Written, WriteError> {
        match self {
            Self::Result(request) => {
                output.round_to(None, request.kind);
                let files = output.write(request.kind, &request.path)?;
                Ok(Written { files, about: Some(output.summary()) })
            }
            Self::Pattern(PatternRequest { path, options }) => write_pattern(&output, model, path, *options),
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
