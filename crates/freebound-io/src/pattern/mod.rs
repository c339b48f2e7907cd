//! Cutting patterns: charts in true size, to be cut from paper, cloth or sheet metal and joined along their seams.
//!
//! A surface that is curved has no flat pattern of the same lengths. [`Pattern::strain`] says by how much edges are longer
//! or shorter on the pattern than on the surface. Lengths on a sheet are millimetres, x to the right and y up.
//!
//! | file | contents |
//! |---|---|
//! | `mod` | options, pattern, formats |
//! | `pieces` | charts in true size, with their outlines and cutting lines |
//! | `seams` | sides of charts that are joined, and marks at equal lengths along them |
//! | `arrange` | pieces beside each other on a sheet |
//! | `drawing` | lines and words of the sheet |
//! | `svg`, `dxf` | the sheet as a drawing |
//! | `pdf` | the sheet as a document of one page |
//! | `tiles` | the sheet on pages of A4 or Letter that overlap |

mod arrange;
mod drawing;
mod dxf;
mod pdf;
mod pieces;
mod seams;
mod svg;
mod tiles;

use std::io::{self, Write};
use std::path::Path;

use freebound_core::geom::{OffsetJoins, is_simple};
use freebound_core::pipeline::LaidChart;
use freebound_core::problem::{Labels, NamedOption};

use arrange::arranged;
use drawing::PatternSheet;
use pieces::pieces_of;
use seams::seams_of;

/// Largest side of a page of a PDF document, millimetres (14,400 points).
const LONGEST_PAGE: f64 = 5080.0;

/// Unit of length of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetre.
    #[default]
    Millimetre,
    /// Centimetre.
    Centimetre,
    /// Metre.
    Metre,
    /// Inch.
    Inch,
}

impl LengthUnit {
    /// Length in millimetres.
    pub const fn millimetres(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}

impl NamedOption for LengthUnit {
    const ALL: &'static [Self] = &[Self::Millimetre, Self::Centimetre, Self::Metre, Self::Inch];

    fn labels(&self) -> Labels {
        match self {
            Self::Millimetre => Labels::new("mm", "Millimetre").about("A unit of the mesh is a millimetre"),
            Self::Centimetre => Labels::new("cm", "Centimetre").about("A unit of the mesh is a centimetre"),
            Self::Metre => Labels::new("m", "Metre").about("A unit of the mesh is a metre"),
            Self::Inch => Labels::new("in", "Inch").about("A unit of the mesh is an inch"),
        }
    }
}

/// Shape of the seam allowance at convex corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AllowanceJoins {
    /// Arcs.
    #[default]
    Round,
    /// Straight tips.
    Mitre,
}

impl AllowanceJoins {
    const fn of_offset(self) -> OffsetJoins {
        match self {
            Self::Round => OffsetJoins::Round,
            Self::Mitre => OffsetJoins::Mitre,
        }
    }
}

impl NamedOption for AllowanceJoins {
    const ALL: &'static [Self] = &[Self::Round, Self::Mitre];

    fn labels(&self) -> Labels {
        match self {
            Self::Round => Labels::new("round", "Round").about("Arcs around the corners"),
            Self::Mitre => Labels::new("mitre", "Mitred").about("Straight tips, rounded if they would be long"),
        }
    }
}

/// Pages of a pattern in a PDF document.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PatternPaper {
    /// Single page of the size of the sheet.
    #[default]
    Sheet,
    /// Pages of A4 that overlap, after a page with an overview.
    A4,
    /// Pages of US Letter that overlap, after a page with an overview.
    Letter,
}

impl NamedOption for PatternPaper {
    const ALL: &'static [Self] = &[Self::Sheet, Self::A4, Self::Letter];

    fn labels(&self) -> Labels {
        match self {
            Self::Sheet => Labels::new("sheet", "One sheet").about("One page of the size of the sheet"),
            Self::A4 => Labels::new("a4", "A4").about("Overlapping pages of A4, after an overview"),
            Self::Letter => Labels::new("letter", "Letter").about("Overlapping pages of US Letter, after an overview"),
        }
    }
}

/// Options of a cutting pattern. Lengths are millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatternOptions {
    /// Unit of the mesh.
    pub unit: LengthUnit,
    /// Seam allowance; 0 for none.
    pub allowance: f64,
    /// Shape of the allowance at corners.
    pub joins: AllowanceJoins,
    /// Distance between notches along seams; 0 for none.
    pub notches: f64,
    /// Pages of a PDF document.
    pub paper: PatternPaper,
    /// Width of the sheet. Default: as narrow as the pieces allow on a sheet that is nearly square.
    pub sheet_width: Option<f64>,
}

impl PatternOptions {
    /// Largest allowance, distance between notches and width, millimetres.
    pub const LONGEST: f64 = 1e5;

    /// Least distance between notches, millimetres.
    pub const NEAREST_NOTCHES: f64 = 5.0;
}

impl Default for PatternOptions {
    fn default() -> Self {
        Self {
            unit: LengthUnit::default(),
            allowance: 10.0,
            joins: AllowanceJoins::default(),
            notches: 50.0,
            paper: PatternPaper::default(),
            sheet_width: None,
        }
    }
}

/// Reason why charts have no pattern.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PatternError {
    /// A chart folds or crosses itself, so no outline bounds it.
    #[error("chart {0} folds or overlaps itself: only a planar chart has a pattern")]
    NotPlanar(usize),
    /// No simple line surrounds a chart at the distance of the allowance.
    #[error("chart {0} has no simple line at this seam allowance: change the allowance a little")]
    NoAllowance(usize),
    /// A chart is wider than the sheet.
    #[error("chart {chart} is {width:.1} mm wide, the sheet {sheet:.1} mm: widen the sheet")]
    TooWide {
        /// Number of the chart.
        chart: usize,
        /// Its least width, millimetres.
        width: f64,
        /// Width of the sheet, millimetres.
        sheet: f64,
    },
    /// The sheet takes too many pages of paper.
    #[error("up to {pages} pages are more than {most}: check the unit of the mesh", most = tiles::MOST_PAGES)]
    TooManyPages {
        /// Number of pages that cover the sheet.
        pages: u64,
    },
    /// The lengths are not finite.
    #[error("chart {0} has no finite size: check the unit of the mesh")]
    NotFinite(usize),
}

/// Relative change of the lengths of edges, from the surface to the pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeStrain {
    /// Least change; −0.02 for an edge that is 2 % shorter on the pattern.
    pub least: f64,
    /// Largest change.
    pub most: f64,
}

impl EdgeStrain {
    fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }
}

/// Charts of a mesh in true size on a sheet, with everything that is drawn there.
#[derive(Clone, Debug)]
pub struct Pattern {
    sheet: PatternSheet,
    options: PatternOptions,
    /// Number of pieces.
    pub pieces: usize,
    /// Number of seams that join two sides.
    pub seams: usize,
    /// Change of the lengths of edges on all pieces.
    pub strain: EdgeStrain,
}

/// Format of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternFormat {
    /// Drawing in millimetres.
    Svg,
    /// Document, one page or pages of paper.
    Pdf,
    /// Drawing exchange format, release 12, in millimetres.
    Dxf,
}

impl PatternFormat {
    /// Extensions of the formats, the usual one first.
    pub const EXTENSIONS: &'static [&'static str] = &["pdf", "svg", "dxf"];

    /// Format of a file, by the extension of its name.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "svg" => Some(Self::Svg),
            "pdf" => Some(Self::Pdf),
            "dxf" => Some(Self::Dxf),
            _ => None,
        }
    }
}

impl Pattern {
    /// Pattern of charts whose texture coordinates belong to a picture of this aspect, width over height. `name` is
    /// written on every piece. Charts that are mirror images of the surface are turned over, so that all pieces show the
    /// outside of the surface.
    ///
    /// # Errors
    ///
    /// [`PatternError`] names the first chart without a pattern.
    pub fn new(
        charts: &[LaidChart<'_>],
        aspect: f64,
        name: &str,
        options: PatternOptions,
    ) -> Result<Self, PatternError> {
        let pieces = arranged(pieces_of(charts, aspect, options)?, options)?;
        let seams = seams_of(&pieces);
        let strain = pieces.iter().map(|piece| piece.strain).reduce(EdgeStrain::union).unwrap_or_default();
        let about = about(options, strain);
        let sheet = PatternSheet::new(&pieces, &seams, options, [name, &about]);
        let pages = tiles::pages_to_cover(&sheet, options.paper);
        if pages > tiles::MOST_PAGES {
            return Err(PatternError::TooManyPages { pages });
        }
        Ok(Self { sheet, options, pieces: pieces.len(), seams: seams.len(), strain })
    }

    /// Width and height of the sheet, millimetres.
    pub fn size(&self) -> [f64; 2] {
        self.sheet.size.to_array()
    }

    /// Summary in words.
    pub fn summary(&self) -> String {
        let [width, height] = self.size();
        let count = |count: usize, one: &str| format!("{count} {one}{}", if count == 1 { "" } else { "s" });
        let pages = match self.options.paper {
            PatternPaper::Sheet => String::new(),
            paper => format!(", {} of {}", count(tiles::page_count(&self.sheet, paper), "page"), paper.labels().title),
        };
        format!(
            "{}, {}, sheet {width:.0} × {height:.0} mm{pages}; {}",
            count(self.pieces, "piece"),
            count(self.seams, "seam"),
            about(self.options, self.strain)
        )
    }

    /// Writes the pattern.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written, or the sheet is longer than a page of a PDF document can be.
    pub fn write(&self, format: PatternFormat, out: &mut impl Write) -> io::Result<()> {
        match (format, self.options.paper) {
            (PatternFormat::Svg, _) => svg::write_svg(out, &self.sheet),
            (PatternFormat::Dxf, _) => dxf::write_dxf(out, &self.sheet),
            (PatternFormat::Pdf, PatternPaper::Sheet) if self.sheet.size.max_element() > LONGEST_PAGE => {
                let text = format!("a page cannot be longer than {LONGEST_PAGE} mm: use pages of A4, or write DXF");
                Err(io::Error::new(io::ErrorKind::InvalidData, text))
            }
            (PatternFormat::Pdf, PatternPaper::Sheet) => pdf::write_sheet(out, &self.sheet),
            (PatternFormat::Pdf, paper) => tiles::write_tiles(out, &self.sheet, paper),
        }
    }

    /// True if all cutting lines are simple.
    pub fn has_simple_cuts(&self) -> bool {
        self.sheet.lines_of(drawing::PatternLayer::Cut).all(|line| is_simple(&line.points))
    }
}

/// Unit, allowance and strain in words.
fn about(options: PatternOptions, strain: EdgeStrain) -> String {
    let percent = |change: f64| format!("{:+.2} %", 100.0 * change).replace('-', "−");
    let allowance =
        if options.allowance > 0.0 { format!("allowance {} mm", options.allowance) } else { "no allowance".to_owned() };
    let unit = options.unit.name();
    format!(
        "1 unit of the mesh = 1 {unit}, {allowance}, edges {} to {} in length",
        percent(strain.least),
        percent(strain.most)
    )
}
