//! Masks: the cells of a grid that a turned and scaled chart touches, with a margin around it.
//!
//! # Conservative raster
//!
//! [`Mask::touched`] marks every cell (closed square) whose distance to the chart is at most the radius. A boundary edge
//! with a margin is a stadium. Its part in a row of cells is convex, so it touches an interval of cells. The interval
//! ends at an arc around an end of the edge or at a side of the stadium; both have closed forms. A cell that no
//! stadium touches is inside or outside as a whole: the winding number at its centre decides.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "coordinates are clamped to cells of a page, which are far fewer than 2³²"
)]

use glam::DVec2;

use crate::geom::Bounds;

/// Cells that a chart with its margin touches.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    /// Number of columns.
    pub(crate) width: usize,
    /// Number of rows.
    pub(crate) height: usize,
    /// Words of 64 cells in a row.
    pub(crate) words: usize,
    /// Marked cells, row by row; the lowest bit is the leftmost cell.
    pub(crate) bits: Vec<u64>,
}

impl Mask {
    /// Mask of all cells within `radius` of a shape, `radius > 0`. Lengths are in cells; `edges` bound the shape.
    ///
    /// The lower left corner of the shape's bounding box lies at `(radius, radius)` in the frame of the mask.
    pub(crate) fn touched(edges: &[[DVec2; 2]], radius: f64) -> Self {
        Self::new(edges, radius, |side| side.floor() as usize + 1, Self::mark_touched)
    }

    /// Mask of the cells whose centres lie within `radius` of a shape; at least one cell.
    pub(crate) fn sampled(edges: &[[DVec2; 2]], radius: f64) -> Self {
        let mut mask = Self::new(edges, radius, |side| side.round().max(1.0) as usize, Self::mark_sampled);
        if mask.count() == 0 {
            mask.mark(mask.height / 2, mask.width / 2, mask.width / 2);
        }
        mask
    }

    /// Mask whose rows are marked by one function and whose sides have as many cells as another one counts.
    fn new(
        edges: &[[DVec2; 2]],
        radius: f64,
        count: impl Fn(f64) -> usize,
        mark_row: impl Fn(&mut Self, &Stadium, usize),
    ) -> Self {
        let Bounds { low, high } = bounds(edges);
        let [width, height] = (high - low + 2.0 * radius).to_array().map(count);
        let mut cells = Self::empty(width, height);
        let moved = edges.iter().map(|edge| edge.map(|point| point - low + radius));
        cells.add(moved, radius, mark_row);
        cells
    }

    /// Marks all cells of the mask within `radius` of a shape, `radius > 0`, whose edges are given in the frame of the
    /// mask. The shape may reach beyond the mask.
    pub(crate) fn add_touched(&mut self, edges: &[[DVec2; 2]], radius: f64) {
        self.add(edges.iter().copied(), radius, Self::mark_touched);
    }

    /// Marks the cells whose centres lie within `radius` of a shape, like [`add_touched`](Self::add_touched).
    pub(crate) fn add_sampled(&mut self, edges: &[[DVec2; 2]], radius: f64) {
        self.add(edges.iter().copied(), radius, Self::mark_sampled);
    }

    fn add(
        &mut self,
        edges: impl Iterator<Item = [DVec2; 2]>,
        radius: f64,
        mark_row: impl Fn(&mut Self, &Stadium, usize),
    ) {
        let mut crossings = Vec::new();
        for [from, to] in edges {
            let stadium = Stadium::new(from, to, radius);
            let [low, high] = [from.y.min(to.y) - radius, from.y.max(to.y) + radius];
            if high >= 0.0 && low <= self.height as f64 {
                for row in cell(low, self.height)..=cell(high, self.height) {
                    mark_row(self, &stadium, row);
                }
            }
            push_crossings(from, to, self.height, &mut crossings);
        }
        crossings.sort_unstable();
        self.fill(&crossings);
    }

    /// Mask without marked cells.
    pub(crate) fn empty(width: usize, height: usize) -> Self {
        let words = width.div_ceil(64);
        Self { width, height, words, bits: vec![0; words * height] }
    }

    /// Words of a row.
    pub(crate) fn row(&self, row: usize) -> &[u64] {
        &self.bits[row * self.words..][..self.words]
    }

    /// Number of marked cells.
    pub(crate) fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Marks the cells of a row from column `first` to `last`, both included.
    fn mark(&mut self, row: usize, first: usize, last: usize) {
        let words = &mut self.bits[row * self.words..][..self.words];
        for (k, word) in words.iter_mut().enumerate().take(last / 64 + 1).skip(first / 64) {
            let low = if k == first / 64 { first % 64 } else { 0 };
            let high = if k == last / 64 { last % 64 } else { 63 };
            *word |= (u64::MAX >> (63 - high)) & (u64::MAX << low);
        }
    }

    /// Marks the cells of a row that a stadium touches.
    fn mark_touched(&mut self, stadium: &Stadium, row: usize) {
        let interval = stadium.interval(row as f64, (row + 1) as f64);
        if let Some([left, right]) = interval.filter(|&[left, right]| right >= 0.0 && left <= self.width as f64) {
            self.mark(row, cell(left, self.width), cell(right, self.width));
        }
    }

    /// Marks the cells of a row whose centres a stadium covers.
    fn mark_sampled(&mut self, stadium: &Stadium, row: usize) {
        let centre = row as f64 + 0.5;
        if let Some([left, right]) = stadium.interval(centre, centre) {
            let first = (left - 0.5).ceil().max(0.0) as usize;
            // The number after the last cell; zero or less casts to zero.
            let end = ((right + 0.5).floor().max(0.0) as usize).min(self.width);
            if first < end {
                self.mark(row, first, end - 1);
            }
        }
    }

    /// Marks the cells whose centres have a winding number other than zero. Crossings come in order.
    fn fill(&mut self, crossings: &[Crossing]) {
        let mut winding = 0;
        for pair in crossings.windows(2) {
            winding += pair[0].sign;
            let [first, end] = [pair[0].column, pair[1].column.min(self.width)];
            if winding != 0 && pair[0].row == pair[1].row && first < end {
                self.mark(pair[0].row, first, end - 1);
            }
        }
    }
}

/// Index of the cell that holds a coordinate, clamped to a number of cells.
fn cell(coordinate: f64, cells: usize) -> usize {
    // The cast clamps negative numbers to zero.
    (coordinate.floor() as usize).min(cells - 1)
}

/// Bounding box of edges.
pub(crate) fn bounds(edges: &[[DVec2; 2]]) -> Bounds {
    Bounds::of(edges.iter().flatten().copied())
}

/// Points within a radius of a segment.
struct Stadium {
    ends: [DVec2; 2],
    /// Segments parallel to the axis, at the distance of the radius. `None` if the axis has no direction.
    sides: Option<[[DVec2; 2]; 2]>,
    radius: f64,
}

impl Stadium {
    fn new(from: DVec2, to: DVec2, radius: f64) -> Self {
        let offset = (to - from).try_normalize().map(|direction| direction.perp() * radius);
        let sides = offset.map(|offset| [[from + offset, to + offset], [from - offset, to - offset]]);
        Self { ends: [from, to], sides, radius }
    }

    /// Interval of x that the stadium takes between two heights. `None` if it does not come there.
    fn interval(&self, low: f64, high: f64) -> Option<[f64; 2]> {
        let discs = self.ends.iter().filter_map(|&end| interval_of_disc(end, self.radius, low, high));
        let sides = self.sides.iter().flatten().filter_map(|&side| interval_of_segment(side, low, high));
        discs.chain(sides).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

fn interval_of_disc(centre: DVec2, radius: f64, low: f64, high: f64) -> Option<[f64; 2]> {
    let distance = (low - centre.y).max(centre.y - high).max(0.0);
    let square = radius * radius - distance * distance;
    (square >= 0.0).then(|| [centre.x - square.sqrt(), centre.x + square.sqrt()])
}

fn interval_of_segment([from, to]: [DVec2; 2], low: f64, high: f64) -> Option<[f64; 2]> {
    let (down, up) = if from.y <= to.y { (from, to) } else { (to, from) };
    if up.y < low || down.y > high {
        return None;
    }
    let x = |y: f64| down.x + (up.x - down.x) * ((y - down.y) / (up.y - down.y));
    let first = if down.y < low { x(low) } else { down.x };
    let last = if up.y > high { x(high) } else { up.x };
    Some([first.min(last), first.max(last)])
}

/// Crossing of an edge with the centre line of a row. Sorted by row, then by column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Crossing {
    row: usize,
    /// Number of cells of the row whose centres lie to the left.
    column: usize,
    /// 1 for an upward edge, −1 for a downward edge.
    sign: i32,
}

/// Appends the crossings of an edge with the centre lines of the rows below `height`. An edge owns its lower end and
/// not its upper end.
fn push_crossings(from: DVec2, to: DVec2, height: usize, crossings: &mut Vec<Crossing>) {
    let (down, up, sign) = if from.y <= to.y { (from, to, 1) } else { (to, from, -1) };
    let row_from = |y: f64| (y - 0.5).ceil().max(0.0) as usize;
    // The cast clamps negative numbers to zero.
    for row in row_from(down.y)..row_from(up.y).min(height) {
        let x = down.x + (up.x - down.x) * ((row as f64 + 0.5 - down.y) / (up.y - down.y));
        crossings.push(Crossing { row, column: (x - 0.5).ceil().max(0.0) as usize, sign });
    }
}
