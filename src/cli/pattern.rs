//! Cutting pattern of a run.

use std::path::Path;

use super::args::PatternArguments;
use super::error::CommandError;
use super::progress::go_on;
use freebound_io::{Output, Pattern, PatternFormat, PatternOptions, write_atomically};

/// Cutting pattern to write.
#[derive(Clone, Copy)]
pub(super) struct PatternJob<'a> {
    path: &'a Path,
    format: PatternFormat,
    options: PatternOptions,
}

impl<'a> PatternJob<'a> {
    /// Requested pattern, if there is one.
    pub(super) fn typed(arguments: &'a PatternArguments) -> Result<Option<Self>, CommandError> {
        let Some(path) = arguments.pattern.as_deref() else { return Ok(None) };
        let Some(format) = PatternFormat::of_path(path) else {
            let text = format!("{}: --pattern: end the name in .pdf, .svg or .dxf", path.display());
            return Err(CommandError::Usage(text));
        };
        let options = arguments.options();
        if options.notches > 0.0 && options.notches < PatternOptions::NEAREST_NOTCHES {
            let text = format!("--notches: write 0 for none, or {} mm or more", PatternOptions::NEAREST_NOTCHES);
            return Err(CommandError::Usage(text));
        }
        Ok(Some(Self { path, format, options }))
    }

    /// Writes the pattern and returns its summary.
    pub(super) fn write(self, output: &Output<'_>, name: &str) -> Result<String, CommandError> {
        go_on()?;
        let name = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
        let pattern = Pattern::new(&output.charts, output.aspect, &name, self.options)?;
        write_atomically(self.path, |out| pattern.write(self.format, out))?;
        Ok(pattern.summary())
    }
}
