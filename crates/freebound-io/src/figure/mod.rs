//! Figures: panels of meshes and embeddings, laid out on a page, as a drawing (SVG), a document (PDF) and a
//! picture (PNG).
//!
//! All are made from one list of fills, strokes and words on a [`Page`], so their contents agree. Lengths on a page
//! are points; x points right, y down.
//!
//! | file    | contents                                                               |
//! |---------|------------------------------------------------------------------------|
//! | `mod`   | the page and its items                                                 |
//! | `sheet` | panels with their words, in rows, and the caption                      |
//! | `grid`  | cells with lines of numbers, in rows, and a shared colour bar          |
//! | `still` | one large drawing with lines of words: a frame of an animation         |
//! | `panel` | an embedding in a panel: faces, hull and pockets, pins, insets         |
//! | `tinted`| an embedding with a colour on each face                                |
//! | `curves`| a quantity over time                                                   |
//! | `space` | a mesh in space in a panel                                             |
//! | `photo` | a picture with numbered marks in a panel                               |
//! | `plot`  | shares as bars and curves                                              |
//! | `svg`   | a page as a drawing                                                    |
//! | `pdf`   | a page as a document                                                   |
//! | `format`| formats of a page, by the names of files                               |
//! | `axis`  | scales of axes, and their marks                                        |
//! | `steps` | quantities over the steps of a run                                     |
//! | `chessboard` | squares from A1 to H8, as a picture                               |
//! | `ink`   | a page as a picture                                                    |
//! | `font`  | letters made of strokes                                                |

mod axis;
mod chessboard;
mod curves;
mod font;
mod format;
mod grid;
mod ink;
mod panel;
mod pdf;
mod photo;
mod plot;
mod sheet;
mod space;
mod steps;
mod still;
mod svg;
mod tinted;

use glam::DVec2;

use super::raster::Colour;
use freebound_core::geom::{Bounds, Picture, clip_polygon, clip_segment};

pub use axis::{AxisScale, AxisSpan};
pub use chessboard::chessboard;
pub use curves::{Curve, Curves};
pub use font::has_glyph;
use font::{strokes_of, width_of};
pub use format::FigureFormat;
pub use grid::{CellContent, ColourBar, GridCell, PanelGrid};
use panel::placing;
pub use panel::{OutsideShade, PlaneDrawing, Pockets, Window, zones_of};
pub(crate) use pdf::{PdfFile, text_operand, text_width};
pub use photo::PhotoDrawing;
pub use plot::{Bar, Marks, Plot, Shares, plots};
pub use sheet::{Drawing, Panel, PrintedSheet};
pub use space::SpaceDrawing;
pub use steps::{StepCurve, StepFigure};
pub use still::Still;
pub use tinted::TintedDrawing;

/// Colours of figures on white paper.
pub mod colours {
    use crate::raster::Colour;

    /// Background.
    pub const PAPER: Colour = [0xff, 0xff, 0xff];
    /// Words, and lines that must be legible.
    pub const INK: Colour = [0x22, 0x22, 0x22];
    /// Faces.
    pub const FACE: Colour = [0xf1, 0xee, 0xe8];
    /// Edges of faces.
    pub const EDGE: Colour = [0x8a, 0x86, 0x80];
    /// Flipped face.
    pub const FLIPPED: Colour = [0xe5, 0x39, 0x35];
    /// Edges of flipped faces.
    pub const FLIPPED_EDGE: Colour = [0x8e, 0x12, 0x18];
    /// Face that was flipped before.
    pub const MENDED: Colour = [0xf5, 0xdd, 0x92];
    /// Convex hull.
    pub const HULL: Colour = [0xd3, 0x2f, 0x2f];
    /// Pockets between boundary and hull.
    pub const POCKET: Colour = [0x9f, 0xd8, 0xa8];
    /// Edges of the pockets' triangles.
    pub const POCKET_EDGE: Colour = [0x2e, 0x86, 0x3c];
    /// Pinned vertex.
    pub const PIN: Colour = [0x2f, 0x5b, 0xd8];
    /// Constraint.
    pub const CONSTRAINT: Colour = [0x00, 0x8f, 0xa3];
    /// Boundary crossing.
    pub const CROSSING: Colour = [0xe8, 0x70, 0x0a];
    /// Grid lines behind curves.
    pub const GRID: Colour = [0xdd, 0xdb, 0xd7];
    /// Frame around the part that an inset shows.
    pub const FRAME: Colour = [0x2f, 0x5b, 0xd8];
    /// Colours of bars and curves, in order; distinguishable with colour blindness (Okabe and Ito 2008).
    pub const SERIES: [Colour; 6] = [
        [0x00, 0x72, 0xb2],
        [0xe6, 0x9f, 0x00],
        [0x00, 0x9e, 0x73],
        [0xd5, 0x5e, 0x00],
        [0xcc, 0x79, 0xa7],
        [0x56, 0xb4, 0xe9],
    ];
}

/// Width of the strokes of letters, relative to their size.
const LETTER_STROKE: f64 = 0.085;

/// Style of a line or an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ink {
    /// Colour of the interior.
    pub fill: Option<Colour>,
    /// Colour and width of the line.
    pub stroke: Option<(Colour, f64)>,
}

impl Ink {
    /// Interior only.
    const fn fill(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: None }
    }

    /// Line only.
    const fn stroke(colour: Colour, width: f64) -> Self {
        Self { fill: None, stroke: Some((colour, width)) }
    }

    /// Interior and line.
    const fn both(fill: Colour, stroke: Colour, width: f64) -> Self {
        Self { fill: Some(fill), stroke: Some((stroke, width)) }
    }
}

/// Alignment of words at their position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Anchor {
    /// The words begin at the position.
    Start,
    /// The words are centred on the position.
    Middle,
}

/// Lines in a single ink.
#[derive(Clone, Debug, PartialEq)]
struct Path {
    lines: Vec<Vec<DVec2>>,
    is_closed: bool,
    ink: Ink,
}

/// Words on their baseline.
#[derive(Clone, Debug, PartialEq)]
struct Words {
    at: DVec2,
    anchor: Anchor,
    size: f64,
    text: String,
}

impl Words {
    /// Strokes of the letters.
    fn as_strokes(&self) -> Path {
        let shift = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width_of(&self.text, self.size) / 2.0,
        };
        let lines = strokes_of(&self.text, self.at - DVec2::new(shift, 0.0), self.size);
        Path { lines, is_closed: false, ink: Ink::stroke(colours::INK, LETTER_STROKE * self.size) }
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Item {
    Path(Path),
    Words(Words),
    Picture(Bounds, Picture),
}

/// Page of paths, pictures and words; later items cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    size: DVec2,
    items: Vec<Item>,
}

impl Page {
    /// Empty page.
    fn new(size: DVec2) -> Self {
        Self { size, items: Vec::new() }
    }

    /// Draws closed outlines, clipped to an area if there is one.
    fn outlines(&mut self, lines: Vec<Vec<DVec2>>, ink: Ink, within: Option<Bounds>) {
        let Some(area) = within else { return self.path(lines, true, ink) };
        if let Some(fill) = ink.fill {
            let inside = lines.iter().map(|line| clip_polygon(line, area)).collect();
            self.path(inside, true, Ink::fill(fill));
        }
        let closed = lines.into_iter().map(|mut line| {
            line.extend(line.first().copied());
            line
        });
        self.lines(closed.collect(), Ink { fill: None, ..ink }, within);
    }

    /// Draws open lines, clipped to an area if there is one.
    fn lines(&mut self, lines: Vec<Vec<DVec2>>, ink: Ink, within: Option<Bounds>) {
        let Some(area) = within else { return self.path(lines, false, ink) };
        self.path(lines.iter().flat_map(|line| parts_within(line, area)).collect(), false, ink);
    }

    fn path(&mut self, mut lines: Vec<Vec<DVec2>>, is_closed: bool, ink: Ink) {
        lines.retain(|line| line.len() > 1 && line.iter().all(|p| p.is_finite()));
        if !lines.is_empty() && ink != Ink::default() {
            self.items.push(Item::Path(Path { lines, is_closed, ink }));
        }
    }

    /// Writes words on their baseline.
    fn words(&mut self, at: DVec2, anchor: Anchor, size: f64, text: &str) {
        if !text.is_empty() {
            self.items.push(Item::Words(Words { at, anchor, size, text: text.to_owned() }));
        }
    }
}

/// Parts of an open line within an area, in order.
fn parts_within(line: &[DVec2], area: Bounds) -> Vec<Vec<DVec2>> {
    let mut parts: Vec<Vec<DVec2>> = Vec::new();
    for pair in line.windows(2) {
        let Some([from, to]) = clip_segment([pair[0], pair[1]], area) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
    }
    parts
}
