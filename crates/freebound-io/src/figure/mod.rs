//! Figures: panels of meshes and embeddings, laid out on a sheet, as a drawing (SVG) and as a picture (PNG).
//!
//! Both come from one list of fills, strokes and words on a [`Page`], so that they show the same. Lengths on a page are
//! points; x runs right, y down.
//!
//! | file    | what it holds                                                          |
//! |---------|------------------------------------------------------------------------|
//! | `mod`   | the page and what is drawn on it                                       |
//! | `sheet` | panels with their words, in rows, and the caption                      |
//! | `grid`  | cells with lines of numbers, in rows, and one bar of colours           |
//! | `still` | one large drawing with lines of words: a frame of an animation           |
//! | `panel` | an embedding in a panel: faces, hull and pockets, pins, insets         |
//! | `tinted`| an embedding with a colour on each face                                |
//! | `curves`| a quantity over time                                                   |
//! | `space` | a mesh in space in a panel                                             |
//! | `photo` | a picture with numbered marks in a panel                               |
//! | `plot`  | shares as bars and curves                                              |
//! | `svg`   | a page as a drawing                                                    |
//! | `ink`   | a page as a picture                                                    |
//! | `font`  | letters made of strokes                                                |

mod curves;
mod font;
mod grid;
mod ink;
mod panel;
mod photo;
mod plot;
mod sheet;
mod space;
mod still;
mod svg;
mod tinted;

use glam::DVec2;

use super::raster::Colour;
use freebound_core::geom::{Bounds, Picture, clip_polygon, clip_segment};

pub use curves::{Curve, Curves};
pub use font::has_glyph;
pub use grid::{CellContent, ColourBar, GridCell, PanelGrid};
use panel::placing;
pub use panel::{OutsideShade, PlaneDrawing, Pockets, Window, zones_of};
pub use photo::PhotoDrawing;
pub use plot::{Bar, Marks, Plot, Shares, plots};
pub use sheet::{Drawing, Panel, PrintedSheet};
pub use space::SpaceDrawing;
pub use still::Still;
pub use tinted::TintedDrawing;

/// Colours of figures on white paper.
pub mod colours {
    use crate::raster::Colour;

    /// Behind everything.
    pub const PAPER: Colour = [0xff, 0xff, 0xff];
    /// Words, and lines that must be read.
    pub const INK: Colour = [0x22, 0x22, 0x22];
    /// Faces.
    pub const FACE: Colour = [0xf1, 0xee, 0xe8];
    /// Edges of faces.
    pub const EDGE: Colour = [0x8a, 0x86, 0x80];
    /// A flipped face.
    pub const FLIPPED: Colour = [0xe5, 0x39, 0x35];
    /// Edges of flipped faces.
    pub const FLIPPED_EDGE: Colour = [0x8e, 0x12, 0x18];
    /// A face that was flipped before.
    pub const MENDED: Colour = [0xf5, 0xdd, 0x92];
    /// The convex hull.
    pub const HULL: Colour = [0xd3, 0x2f, 0x2f];
    /// The pockets between boundary and hull.
    pub const POCKET: Colour = [0x9f, 0xd8, 0xa8];
    /// Edges of the pockets' triangles.
    pub const POCKET_EDGE: Colour = [0x2e, 0x86, 0x3c];
    /// A pinned vertex.
    pub const PIN: Colour = [0x2f, 0x5b, 0xd8];
    /// A constraint.
    pub const CONSTRAINT: Colour = [0x00, 0x8f, 0xa3];
    /// A boundary crossing.
    pub const CROSSING: Colour = [0xe8, 0x70, 0x0a];
    /// Lines behind curves.
    pub const GRID: Colour = [0xdd, 0xdb, 0xd7];
    /// The frame around what an inset shows.
    pub const FRAME: Colour = [0x2f, 0x5b, 0xd8];
    /// Bars and curves, one after another: told apart by people who are colour-blind (Okabe and Ito 2008).
    pub const SERIES: [Colour; 6] = [
        [0x00, 0x72, 0xb2],
        [0xe6, 0x9f, 0x00],
        [0x00, 0x9e, 0x73],
        [0xd5, 0x5e, 0x00],
        [0xcc, 0x79, 0xa7],
        [0x56, 0xb4, 0xe9],
    ];
}

/// What a line or an outline is drawn with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ink {
    /// Colour of the inside.
    pub fill: Option<Colour>,
    /// Colour and width of the line.
    pub stroke: Option<(Colour, f64)>,
}

impl Ink {
    /// The inside alone.
    const fn fill(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: None }
    }

    /// The line alone.
    const fn stroke(colour: Colour, width: f64) -> Self {
        Self { fill: None, stroke: Some((colour, width)) }
    }

    /// Inside and line.
    const fn both(fill: Colour, stroke: Colour, width: f64) -> Self {
        Self { fill: Some(fill), stroke: Some((stroke, width)) }
    }
}

/// Where words stand beside their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Anchor {
    /// They begin at it.
    Start,
    /// They are centred on it.
    Middle,
}

/// Lines of one ink.
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

#[derive(Clone, Debug, PartialEq)]
enum Item {
    Path(Path),
    Words(Words),
    Picture(Bounds, Picture),
}

/// A page of paths, pictures and words, later ones over earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    size: DVec2,
    items: Vec<Item>,
}

impl Page {
    /// An empty page.
    fn new(size: DVec2) -> Self {
        Self { size, items: Vec::new() }
    }

    /// Draws closed outlines, or their parts within an area.
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

    /// Draws open lines, or their parts within an area.
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

/// The parts of an open line within an area, in its order.
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
