//! Sides of pieces that are joined, and marks at equal lengths along them.
//!
//! Two sides are joined if they have the same two ends on the surface and run in opposite directions. Sides in a row whose
//! partners are in a row form a seam. Lengths along a seam are those on the surface, so both sides of a seam have their
//! marks at the same points of the surface, whatever the pattern shortens or lengthens.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::pieces::{Piece, PieceSide, PlaceKey};

/// Place of a side: piece, loop, and number in the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct SidePlace {
    piece: usize,
    line: usize,
    side: usize,
}

/// Sides of two pieces, or of one, that are joined.
#[derive(Clone, Debug)]
pub(super) struct PatternSeam {
    /// Number, from 1.
    pub(super) number: usize,
    /// Sides and their partners, in the direction of the sides.
    pairs: Vec<[SidePlace; 2]>,
    /// True if the seam has no ends.
    is_closed: bool,
    /// Length on the surface, millimetres.
    pub(super) length: f64,
}

/// Point of a seam on one of its two sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeamPoint {
    /// Place of the piece on the other side, in the list.
    pub(super) across: usize,
    pub(super) at: DVec2,
    /// Direction away from the piece.
    pub(super) outward: DVec2,
}

impl PatternSeam {
    /// Lengths from the start of the seam at which notches lie, at most `spacing` apart.
    pub(super) fn notches(&self, spacing: f64) -> Vec<f64> {
        if spacing <= 0.0 {
            return Vec::new();
        }
        let mut count = (self.length / spacing).floor();
        if count < 1.0 && self.length >= spacing / 2.0 {
            count = 1.0;
        }
        let mut places = Vec::new();
        let mut k = if self.is_closed { 0.0 } else { 1.0 };
        while k <= count {
            places.push(self.length * k / (count + 1.0));
            k += 1.0;
        }
        places
    }

    /// Length from the start at which the words of the seam stand: between two notches.
    pub(super) fn middle(&self, spacing: f64) -> f64 {
        let gaps = (self.notches(spacing).len() + usize::from(!self.is_closed)) as f64;
        self.length * ((gaps / 2.0).floor() + 0.5).min(gaps - 0.5) / gaps.max(1.0)
    }

    /// Points of both sides at a length from the start.
    pub(super) fn points_at(&self, pieces: &[Piece], length: f64) -> Option<[SeamPoint; 2]> {
        let mut left = length;
        for (place, &pair) in self.pairs.iter().enumerate() {
            let side = side_at(pieces, pair[0]);
            if left <= side.length || place + 1 == self.pairs.len() {
                let share = (left / side.length).clamp(0.0, 1.0);
                let point = |of: SidePlace, across: SidePlace, share: f64| {
                    let (at, outward) = along(&side_at(pieces, of).line, share);
                    SeamPoint { across: across.piece, at, outward }
                };
                return share
                    .is_finite()
                    .then(|| [point(pair[0], pair[1], share), point(pair[1], pair[0], 1.0 - share)]);
            }
            left -= side.length;
        }
        None
    }
}

fn side_at(pieces: &[Piece], place: SidePlace) -> &PieceSide {
    &pieces[place.piece].loops[place.line][place.side]
}

/// Point at a share of the length of a line, and the direction to its right there.
fn along(line: &[DVec2], share: f64) -> (DVec2, DVec2) {
    let total: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let mut left = share * total;
    let last = line.len() - 2;
    for (place, pair) in line.windows(2).enumerate() {
        let length = pair[0].distance(pair[1]);
        if left <= length || place == last {
            let along = (pair[1] - pair[0]).normalize_or_zero();
            return (pair[0] + along * left.min(length), -along.perp());
        }
        left -= length;
    }
    (line[0], DVec2::ZERO)
}

/// Seams of all pieces, in the order of their first sides.
pub(super) fn seams_of(pieces: &[Piece]) -> Vec<PatternSeam> {
    let partners = Partners::of(pieces);
    let mut is_joined = BTreeSet::new();
    let mut seams = Vec::new();
    for &first in partners.of.keys() {
        if is_joined.contains(&first) {
            continue;
        }
        let (start, is_closed) = partners.start_of(first);
        let mut pairs = Vec::new();
        let mut at = Some(start);
        while let Some(side) = at.filter(|side| !is_joined.contains(side)) {
            let partner = partners.of[&side];
            is_joined.extend([side, partner]);
            pairs.push([side, partner]);
            at = partners.next(side);
        }
        let length = pairs.iter().map(|pair| side_at(pieces, pair[0]).length).sum();
        seams.push(PatternSeam { number: seams.len() + 1, pairs, is_closed, length });
    }
    seams
}

/// Partners of sides.
struct Partners<'a> {
    pieces: &'a [Piece],
    of: BTreeMap<SidePlace, SidePlace>,
}

impl<'a> Partners<'a> {
    fn of(pieces: &'a [Piece]) -> Self {
        let mut by_ends: BTreeMap<[PlaceKey; 2], Vec<SidePlace>> = BTreeMap::new();
        for (piece, of) in pieces.iter().enumerate() {
            for (line, sides) in of.loops.iter().enumerate() {
                for (number, side) in sides.iter().enumerate() {
                    let mut ends = side.ends;
                    ends.sort_unstable();
                    by_ends.entry(ends).or_default().push(SidePlace { piece, line, side: number });
                }
            }
        }
        let mut of = BTreeMap::new();
        for pair in by_ends.into_values() {
            // An edge of three sides or more has no unique partner.
            let &[a, b] = &pair[..] else { continue };
            if side_at(pieces, a).ends[0] == side_at(pieces, b).ends[1] {
                of.extend([(a, b), (b, a)]);
            }
        }
        Self { pieces, of }
    }

    fn turned(&self, place: SidePlace, is_forward: bool) -> SidePlace {
        let count = self.pieces[place.piece].loops[place.line].len();
        let side = (place.side + if is_forward { 1 } else { count - 1 }) % count;
        SidePlace { side, ..place }
    }

    /// Side after a side in one seam.
    fn next(&self, side: SidePlace) -> Option<SidePlace> {
        let after = self.turned(side, true);
        let partner = *self.of.get(&after)?;
        let is_in_row = partner == self.turned(self.of[&side], false) && partner != side;
        is_in_row.then_some(after)
    }

    /// Side before a side in one seam.
    fn previous(&self, side: SidePlace) -> Option<SidePlace> {
        let before = self.turned(side, false);
        (self.of.contains_key(&before) && self.next(before) == Some(side)).then_some(before)
    }

    /// First side of the seam of a side, and true if the seam has no ends.
    fn start_of(&self, side: SidePlace) -> (SidePlace, bool) {
        let mut at = side;
        while let Some(before) = self.previous(at) {
            if before == side {
                return (side, true);
            }
            at = before;
        }
        (at, false)
    }
}
