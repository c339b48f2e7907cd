//! Formats of a figure.

use std::io::{self, Write};
use std::path::Path;

use super::Page;
use crate::raster::write_png;

/// Pixels per point of pictures.
const PIXELS: f64 = 2.0;

/// Format of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureFormat {
    /// Picture with 2 pixels per point.
    Png,
    /// Drawing.
    Svg,
    /// Document of one page.
    Pdf,
}

impl FigureFormat {
    /// Format of a file, by the extension of its name. Default: PNG.
    pub fn of_path(path: &Path) -> Self {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        [Self::Svg, Self::Pdf].into_iter().find(|format| format.extension() == extension).unwrap_or(Self::Png)
    }

    /// Extension of the file name.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }
}

impl Page {
    /// Writes the page in a format.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn write(&self, format: FigureFormat, out: &mut impl Write) -> io::Result<()> {
        match format {
            FigureFormat::Png => write_png(&self.picture(PIXELS), out),
            FigureFormat::Svg => self.write_svg(out),
            FigureFormat::Pdf => self.write_pdf(out),
        }
    }
}
