//! Lines and words of a sheet, in millimetres, y up.

use glam::DVec2;

use super::PatternOptions;
use super::arrange::{GAP, bounds_of};
use super::pieces::Piece;
use super::seams::{PatternSeam, SeamPoint};
use freebound_core::geom::{Bounds, Pole, pole};

/// Length of the scale bar, millimetres.
const BAR: f64 = 100.0;

/// Height of the foot of the sheet, with the words on the pattern and the scale bar, millimetres.
const FOOT: f64 = 26.0;

/// Type size of the foot, millimetres.
const FOOT_WORDS: f64 = 3.5;

/// Length of a notch if there is no allowance, millimetres.
const NOTCH: f64 = 3.0;

/// Largest type size of the number on a piece, millimetres.
const NUMBER_WORDS: f64 = 14.0;

/// Largest type size of words at a seam, millimetres.
const SEAM_WORDS: f64 = 3.5;

/// Type size of words at a seam, relative to the length of the seam.
const SEAM_SHARE: f64 = 0.12;

/// Width of a letter, relative to the type size.
const LETTER: f64 = 0.6;

/// Layer of a line or of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PatternLayer {
    Cut,
    Sew,
    Notch,
    Text,
}

impl PatternLayer {
    pub(super) const ALL: [Self; 4] = [Self::Cut, Self::Sew, Self::Notch, Self::Text];

    /// Name in files.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Cut => "CUT",
            Self::Sew => "SEW",
            Self::Notch => "NOTCH",
            Self::Text => "TEXT",
        }
    }

    /// Width of lines, millimetres.
    pub(super) const fn width(self) -> f64 {
        match self {
            Self::Cut => 0.35,
            Self::Sew | Self::Notch => 0.25,
            Self::Text => 0.2,
        }
    }

    /// Lengths of dashes and gaps, millimetres. `None` for a solid line.
    pub(super) fn dashes(self) -> Option<[f64; 2]> {
        (self == Self::Sew).then_some([3.0, 1.5])
    }
}

/// Line of a sheet.
#[derive(Clone, Debug)]
pub(super) struct PatternLine {
    pub(super) layer: PatternLayer,
    pub(super) points: Vec<DVec2>,
    pub(super) is_closed: bool,
}

/// Words, centred on a point of their baseline.
#[derive(Clone, Debug)]
pub(super) struct PatternWords {
    pub(super) at: DVec2,
    pub(super) size: f64,
    /// Direction of the baseline, of length 1.
    pub(super) along: DVec2,
    pub(super) text: String,
}

/// Sheet with its lines and words. The origin is the lower left corner.
#[derive(Clone, Debug)]
pub(super) struct PatternSheet {
    pub(super) size: DVec2,
    pub(super) lines: Vec<PatternLine>,
    pub(super) words: Vec<PatternWords>,
}

impl PatternSheet {
    /// Sheet with arranged pieces. `about` are the lines of words at the foot.
    pub(super) fn new(pieces: &[Piece], seams: &[PatternSeam], options: PatternOptions, about: [&str; 2]) -> Self {
        let bounds = pieces.iter().map(bounds_of).fold(Bounds::at(DVec2::ZERO, DVec2::splat(GAP)), Bounds::union);
        let foot = BAR.max(words_width(about[0], FOOT_WORDS)).max(words_width(about[1], FOOT_WORDS));
        let width = options.sheet_width.unwrap_or(0.0).max(bounds.high.x + GAP).max(foot + 2.0 * GAP);
        let lift = DVec2::new(0.0, FOOT);
        let mut sheet = Self { size: DVec2::new(width, bounds.high.y + GAP), lines: Vec::new(), words: Vec::new() };
        for piece in pieces {
            sheet.add_piece(piece, options, about[0]);
        }
        for seam in seams {
            sheet.add_seam(seam, pieces, options);
        }
        sheet.lines.iter_mut().flat_map(|line| &mut line.points).for_each(|point| *point += lift);
        sheet.words.iter_mut().for_each(|words| words.at += lift);
        sheet.size += lift;
        sheet.add_foot(about);
        sheet
    }

    pub(super) fn lines_of(&self, layer: PatternLayer) -> impl Iterator<Item = &PatternLine> {
        self.lines.iter().filter(move |line| line.layer == layer)
    }

    fn closed(&mut self, layer: PatternLayer, lines: Vec<Vec<DVec2>>) {
        self.lines.extend(lines.into_iter().map(|points| PatternLine { layer, points, is_closed: true }));
    }

    fn open(&mut self, layer: PatternLayer, points: Vec<DVec2>) {
        self.lines.push(PatternLine { layer, points, is_closed: false });
    }

    fn add_piece(&mut self, piece: &Piece, options: PatternOptions, name: &str) {
        self.closed(PatternLayer::Cut, piece.cut.clone());
        let outlines = piece.outlines();
        let pole = pole(&outlines);
        if options.allowance > 0.0 {
            self.closed(PatternLayer::Sew, outlines);
        }
        let Some(Pole { at, distance }) = pole else { return };
        let number = piece.number.to_string();
        // The words lie within the largest circle of the piece.
        let fits = |text: &str, most: f64| most.min(1.5 * distance / (LETTER * text.len().max(1) as f64));
        let size = fits(&number, NUMBER_WORDS).min(0.9 * distance);
        self.words(at, size, number);
        let small = fits(name, size / 3.0);
        self.words(at - DVec2::new(0.0, 1.6 * small), small, name.to_owned());
    }

    fn words(&mut self, at: DVec2, size: f64, text: String) {
        if size > 0.0 && !text.is_empty() {
            self.words.push(PatternWords { at, size, along: DVec2::X, text });
        }
    }

    fn add_seam(&mut self, seam: &PatternSeam, pieces: &[Piece], options: PatternOptions) {
        for (number, length) in (1..).zip(seam.notches(options.notches)) {
            for point in seam.points_at(pieces, length).into_iter().flatten() {
                let ends = if options.allowance > 0.0 {
                    [point.at, point.at + point.outward * options.allowance]
                } else {
                    [point.at, point.at - point.outward * NOTCH]
                };
                self.open(PatternLayer::Notch, ends.to_vec());
                let size = (SEAM_WORDS * 0.7).min(SEAM_SHARE * seam.length);
                let inset = if options.allowance > 0.0 { 0.0 } else { NOTCH };
                self.words_along(point, inset, size, format!("{}.{number}", seam.number));
            }
        }
        let size = SEAM_WORDS.min(SEAM_SHARE * seam.length);
        for point in seam.points_at(pieces, seam.middle(options.notches)).into_iter().flatten() {
            let text = format!("{} > {}", seam.number, pieces[point.across].number);
            self.words_along(point, 0.0, size, text);
        }
    }

    /// Words inside a piece, along its side.
    fn words_along(&mut self, point: SeamPoint, inset: f64, size: f64, text: String) {
        let along = point.outward.perp();
        let along = if along.x < 0.0 { -along } else { along };
        let inwards = -point.outward;
        // Letters stand on their baseline: it lies near the outline if they reach inwards, and farther inside if not.
        let depth = if along.perp().dot(inwards) > 0.0 { 0.5 * size } else { 1.2 * size };
        self.words.push(PatternWords { at: point.at + inwards * (inset + depth), size, along, text });
    }

    fn add_foot(&mut self, about: [&str; 2]) {
        for (text, height) in about.into_iter().zip([18.0, 12.5]) {
            let at = DVec2::new(GAP + words_width(text, FOOT_WORDS) / 2.0, height);
            self.words(at, FOOT_WORDS, text.to_owned());
        }
        let [from, to] = [DVec2::new(GAP, 8.0), DVec2::new(GAP + BAR, 8.0)];
        let tick = DVec2::new(0.0, 1.5);
        self.open(PatternLayer::Text, vec![from, to]);
        for end in [from, to] {
            self.open(PatternLayer::Text, vec![end - tick, end + tick]);
        }
        self.words(from.midpoint(to) - DVec2::new(0.0, 5.0), FOOT_WORDS, format!("{BAR} mm"));
    }
}

/// Width of words, about.
fn words_width(text: &str, size: f64) -> f64 {
    LETTER * size * text.chars().count() as f64
}
