//! Outward offset of a region: all points within a distance of it.
//!
//! # Method
//!
//! The offset region is the union of the region, of a strip along the outside of each edge, and of a wedge at each
//! convex corner: every point near the region has its nearest point inside an edge or at a convex corner. The pieces are
//! convex. The outline of the union consists of parts of the outer sides of strips and wedges. These sides are split
//! where they cross; a part belongs to the outline if no other piece holds its middle. Parts join at the crossings they
//! share, so the loops need no tolerance. Two sides that coincide have no proper crossing; the distance is then increased
//! by a ten-millionth, and the search repeated.

use std::collections::HashMap;

use glam::DVec2;

use super::{Bounds, BoxTree, Orientation, is_simple, orientation};

/// Longest tip of a mitre, relative to the distance. Longer tips are rounded.
const MITRE_LIMIT: f64 = 4.0;

/// Turn of an outline, in radians, below which two strips share a corner.
const STRAIGHT: f64 = 1e-3;

/// Relative increase of the distance at each repetition.
const NUDGE: f64 = 1e-7;

/// Number of repetitions.
const TRIES: u32 = 12;

/// Number of grid cells along the longer side of the region.
const CELLS: f64 = 128.0;

/// Shape of an offset at convex corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OffsetJoins {
    /// Arcs around the corners.
    #[default]
    Round,
    /// Straight tips; tips longer than four times the distance are rounded.
    Mitre,
}

/// Distance and shape of an offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetOptions {
    /// Distance, above 0.
    pub distance: f64,
    /// Shape at convex corners.
    pub joins: OffsetJoins,
    /// Largest distance between an arc and its chords.
    pub tolerance: f64,
}

/// Loops around all points within a distance of a region, outer loops counter-clockwise and holes clockwise. The region
/// lies to the left of its loops, which are simple and apart. Every vertex of a round offset has exactly the distance from
/// the region, up to rounding.
///
/// Returns `None` if a coordinate or the distance is not finite and positive, or the loops cross or coincide.
pub fn offset_outward(loops: &[Vec<DVec2>], options: OffsetOptions) -> Option<Vec<Vec<DVec2>>> {
    let is_usable = |value: f64| value.is_finite() && value > 0.0;
    if !(is_usable(options.distance) && is_usable(options.tolerance)) || loops.iter().flatten().any(|z| !z.is_finite())
    {
        return None;
    }
    let loops: Vec<Vec<DVec2>> = loops.iter().map(|line| without_repeats(line)).collect();
    if loops.is_empty() || loops.iter().any(|line| line.len() < 3) {
        return None;
    }
    (0..TRIES).find_map(|attempt| {
        let distance = options.distance * (1.0 + NUDGE * f64::from(attempt));
        let found = Pieces::around(&loops, OffsetOptions { distance, ..options }).outline(&loops)?;
        found.iter().all(|line| is_simple(line)).then_some(found)
    })
}

fn without_repeats(line: &[DVec2]) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::with_capacity(line.len());
    for &point in line {
        if kept.last() != Some(&point) {
            kept.push(point);
        }
    }
    while kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    kept
}

/// Directed outer side of a piece. Sides with a common end have its number in common.
#[derive(Clone, Copy)]
struct OuterSide {
    ends: [DVec2; 2],
    numbers: [u32; 2],
    piece: u32,
}

/// Convex pieces around a region, and their outer sides.
#[derive(Default)]
struct Pieces {
    convex: Vec<Vec<DVec2>>,
    sides: Vec<OuterSide>,
    points: u32,
}

/// End of a part of a side: an end of the side, or its crossing with another side.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Joint {
    End(u32),
    Crossing(u32, u32),
}

/// Part of the outline between two joints.
struct OutlinePart {
    joints: [Joint; 2],
    from: DVec2,
}

/// Corner of an outline with the strips before and after it.
struct Corner {
    at: DVec2,
    /// Outward normals of the edges before and after.
    normals: [DVec2; 2],
    /// Angle of the turn to the left, radians.
    turn: f64,
    /// Length of the shorter of the two edges.
    shorter: f64,
}

impl Corner {
    fn of(line: &[DVec2], place: usize) -> Self {
        let count = line.len();
        let [before, at, after] = [line[(place + count - 1) % count], line[place], line[(place + 1) % count]];
        let [first, second] = [at - before, after - at];
        let turn = first.perp_dot(second).atan2(first.dot(second));
        let normals = [first, second].map(|along| -along.perp().normalize_or_zero());
        Self { at, normals, turn, shorter: first.length().min(second.length()) }
    }

    /// Point that both strips share, if the outline hardly turns.
    fn shared(&self, distance: f64) -> Option<DVec2> {
        let is_straight = self.turn.abs() < STRAIGHT && 2.0 * distance * self.turn.abs() <= self.shorter;
        is_straight.then(|| self.tip(distance)).flatten()
    }

    /// Crossing of the outer sides of the two strips.
    fn tip(&self, distance: f64) -> Option<DVec2> {
        let sum = self.normals[0] + self.normals[1];
        let tip = self.at + sum * (2.0 * distance / sum.length_squared());
        tip.is_finite().then_some(tip)
    }

    /// Points of the outer side of the wedge, from the first strip to the second.
    fn wedge(&self, options: OffsetOptions) -> Vec<DVec2> {
        let OffsetOptions { distance, joins, tolerance } = options;
        let [first, last] = self.normals.map(|normal| self.at + normal * distance);
        let tip = self.tip(distance).filter(|tip| tip.distance(self.at) <= MITRE_LIMIT * distance);
        if let (OffsetJoins::Mitre, Some(tip)) = (joins, tip) {
            return vec![first, tip, last];
        }
        let step = 2.0 * (1.0 - (tolerance / distance).min(0.5)).acos();
        let count = (self.turn / step).ceil().max(1.0);
        let arc = |k: f64| self.at + DVec2::from_angle(self.turn * k / count).rotate(self.normals[0]) * distance;
        let mut points = vec![first];
        let mut k = 1.0;
        while k < count {
            points.push(arc(k));
            k += 1.0;
        }
        points.push(last);
        points
    }
}

impl Pieces {
    fn around(loops: &[Vec<DVec2>], options: OffsetOptions) -> Self {
        let mut pieces = Self::default();
        for line in loops {
            pieces.add_loop(line, options);
        }
        pieces
    }

    fn add_loop(&mut self, line: &[DVec2], options: OffsetOptions) {
        let count = line.len();
        let corners: Vec<Corner> = (0..count).map(|place| Corner::of(line, place)).collect();
        // Numbered points at the end of the strip before each corner and at the start of the strip after it.
        let mut at_corner: Vec<[(u32, DVec2); 2]> = Vec::with_capacity(count);
        for corner in &corners {
            at_corner.push(self.add_corner(corner, options));
        }
        for place in 0..count {
            let next = (place + 1) % count;
            let [(from_number, from), (to_number, to)] = [at_corner[place][1], at_corner[next][0]];
            let corners = vec![line[next], line[place], from, to];
            self.add_piece(corners, &[(from_number, from), (to_number, to)]);
        }
    }

    /// Adds the wedge at a corner. Returns the points at which the strips before and after meet it.
    fn add_corner(&mut self, corner: &Corner, options: OffsetOptions) -> [(u32, DVec2); 2] {
        if let Some(point) = corner.shared(options.distance) {
            let number = self.number();
            return [(number, point); 2];
        }
        if corner.turn <= 0.0 {
            let [first, last] = corner.normals.map(|normal| corner.at + normal * options.distance);
            return [(self.number(), first), (self.number(), last)];
        }
        let outer: Vec<(u32, DVec2)> = corner.wedge(options).into_iter().map(|point| (self.number(), point)).collect();
        let corners = std::iter::once(corner.at).chain(outer.iter().map(|(_, point)| *point)).collect();
        self.add_piece(corners, &outer);
        [outer[0], outer[outer.len() - 1]]
    }

    fn number(&mut self) -> u32 {
        self.points += 1;
        self.points
    }

    /// Adds a convex piece, counter-clockwise, with its outer sides.
    fn add_piece(&mut self, corners: Vec<DVec2>, outer: &[(u32, DVec2)]) {
        let piece = u32::try_from(self.convex.len()).expect("fewer than 2^32 pieces");
        self.convex.push(corners);
        let side =
            |pair: &[(u32, DVec2)]| OuterSide { ends: [pair[0].1, pair[1].1], numbers: [pair[0].0, pair[1].0], piece };
        self.sides.extend(outer.windows(2).map(side));
    }

    /// Outline of the union of all pieces and the region. `None` if its parts do not close.
    fn outline(&self, loops: &[Vec<DVec2>]) -> Option<Vec<Vec<DVec2>>> {
        let cover = Cover::new(&self.convex, loops);
        let mut parts = Vec::new();
        for (side, mut cuts) in self.sides.iter().zip(self.crossings()) {
            cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let [from, to] = side.ends;
            let last = (1.0, Joint::End(side.numbers[1]));
            let mut start = (0.0, Joint::End(side.numbers[0]));
            for end in cuts.into_iter().chain([last]) {
                let middle = from.lerp(to, f64::midpoint(start.0, end.0));
                if !cover.holds(middle, side.piece) {
                    parts.push(OutlinePart { joints: [start.1, end.1], from: from.lerp(to, start.0) });
                }
                start = end;
            }
        }
        closed_loops(&parts)
    }

    /// Parameters of the proper crossings on each side.
    fn crossings(&self) -> Vec<Vec<(f64, Joint)>> {
        let tree = BoxTree::new(self.sides.iter().map(|side| Bounds::of(side.ends)));
        let mut found = vec![Vec::new(); self.sides.len()];
        for lower in 0..self.sides.len() {
            for higher in tree.later(lower) {
                let [first, second] = [self.sides[lower].ends, self.sides[higher].ends];
                if !cross_properly(first, second) {
                    continue;
                }
                let [along, across] = [first[1] - first[0], second[1] - second[0]];
                let between = second[0] - first[0];
                let area = along.perp_dot(across);
                let number = |side: usize| u32::try_from(side).expect("fewer than 2^32 sides");
                let joint = Joint::Crossing(number(lower), number(higher));
                found[lower].push(((between.perp_dot(across) / area).clamp(0.0, 1.0), joint));
                found[higher].push(((between.perp_dot(along) / area).clamp(0.0, 1.0), joint));
            }
        }
        found
    }
}

/// True if two segments cross at an inner point of both.
fn cross_properly(first: [DVec2; 2], second: [DVec2; 2]) -> bool {
    let splits = |line: [DVec2; 2], ends: [DVec2; 2]| {
        let sides = ends.map(|end| orientation(line[0], line[1], end));
        matches!(
            sides,
            [Some(Orientation::Clockwise), Some(Orientation::CounterClockwise)]
                | [Some(Orientation::CounterClockwise), Some(Orientation::Clockwise)]
        )
    };
    splits(first, second) && splits(second, first)
}

/// Joins parts at their common ends. `None` unless exactly one part begins at each end of a part.
fn closed_loops(parts: &[OutlinePart]) -> Option<Vec<Vec<DVec2>>> {
    let mut starting = HashMap::with_capacity(parts.len());
    for (number, part) in parts.iter().enumerate() {
        if starting.insert(part.joints[0], number).is_some() {
            return None;
        }
    }
    let mut is_used = vec![false; parts.len()];
    let mut loops = Vec::new();
    for first in 0..parts.len() {
        let (mut line, mut at) = (Vec::new(), first);
        while !is_used[at] {
            is_used[at] = true;
            line.push(parts[at].from);
            at = *starting.get(&parts[at].joints[1])?;
        }
        if !line.is_empty() {
            if at != first {
                return None;
            }
            loops.push(without_repeats(&line));
        }
    }
    (!loops.is_empty() && loops.iter().all(|line| line.len() > 2)).then_some(loops)
}

/// Grid over the pieces and rows over the edges of a region, for tests of points.
struct Cover<'a> {
    pieces: &'a [Vec<DVec2>],
    low: DVec2,
    cell: f64,
    columns: usize,
    cells: Vec<Vec<u32>>,
    rows: Vec<Vec<[DVec2; 2]>>,
}

impl<'a> Cover<'a> {
    fn new(pieces: &'a [Vec<DVec2>], loops: &[Vec<DVec2>]) -> Self {
        let bounds = Bounds::of(pieces.iter().flatten().copied());
        let cell = bounds.extent() / CELLS;
        let [columns, rows] = bounds.size().to_array().map(|side| index_of(side / cell) + 1);
        let (low, cells) = (bounds.low, vec![Vec::new(); columns * rows]);
        let mut cover = Self { pieces, low, cell, columns, cells, rows: vec![Vec::new(); rows] };
        for (number, piece) in (0..).zip(pieces) {
            let Bounds { low, high } = Bounds::of(piece.iter().copied());
            let [from, to] = [cover.place(low), cover.place(high)];
            for row in from[1]..=to[1] {
                for column in from[0]..=to[0] {
                    cover.cells[row * columns + column].push(number);
                }
            }
        }
        for line in loops {
            for (place, &from) in line.iter().enumerate() {
                let to = line[(place + 1) % line.len()];
                let [a, b] = [cover.place(from)[1], cover.place(to)[1]];
                for row in &mut cover.rows[a.min(b)..=a.max(b)] {
                    row.push([from, to]);
                }
            }
        }
        cover
    }

    /// Column and row of a point.
    fn place(&self, point: DVec2) -> [usize; 2] {
        let [column, row] = ((point - self.low) / self.cell).to_array().map(index_of);
        [column.min(self.columns - 1), row.min(self.rows.len() - 1)]
    }

    /// True if a point lies inside the region, or inside a piece other than `own`.
    fn holds(&self, point: DVec2, own: u32) -> bool {
        let [column, row] = self.place(point);
        let near = self.cells[row * self.columns + column].iter();
        near.filter(|&&piece| piece != own).any(|&piece| is_within(&self.pieces[piece as usize], point))
            || self.is_in_region(point, row)
    }

    fn is_in_region(&self, point: DVec2, row: usize) -> bool {
        let mut winding = 0;
        for &[from, to] in &self.rows[row] {
            if (from.y > point.y) != (to.y > point.y) {
                match (to.y > from.y, orientation(from, to, point)) {
                    (true, Some(Orientation::CounterClockwise)) => winding += 1,
                    (false, Some(Orientation::Clockwise)) => winding -= 1,
                    _ => {}
                }
            }
        }
        winding != 0
    }
}

/// True if a point lies inside a convex polygon, and not on its outline.
fn is_within(corners: &[DVec2], point: DVec2) -> bool {
    (0..corners.len()).all(|place| {
        let [from, to] = [corners[place], corners[(place + 1) % corners.len()]];
        from == to || orientation(from, to, point) == Some(Orientation::CounterClockwise)
    })
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places in a small grid")]
fn index_of(place: f64) -> usize {
    place.max(0.0) as usize
}
