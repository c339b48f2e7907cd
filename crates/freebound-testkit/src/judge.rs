//! Judge of a layout in an OBJ file, independent of the program: own parser, own predicates, own search.
//!
//! Signs are computed in 64-bit numbers with an error bound, and in rational numbers where the bound does not decide. A
//! grid finds the pairs of triangles that may overlap. Shares no code with the program.
//!
//! A face is *without a place* if it has no coordinates or its corners lie at one or two points. A face with the corners of
//! an earlier face, in space and in the plane, is a *duplicate*. Both are counted and left out. Faces at points may hold
//! 1 % of the surface.

use std::collections::{HashMap, HashSet};

use num_rational::BigRational;

/// Largest number of cells of the grid along a side.
const MOST_CELLS: f64 = 2048.0;

/// Number of overlapping pairs after which no further cell is searched.
const MOST_OVERLAPS: usize = 1000;

/// Bound on the rounding error of `(b − a) × (c − a)`, relative to the sum of the absolute products (J. R. Shewchuk 1997).
const ERROR: f64 = 4.0 * f64::EPSILON;

/// Largest share of the surface at points of a layout that is planar.
const MOST_AT_POINTS: f64 = 0.01;

/// Verdict on a layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judgement {
    /// Number of polygons.
    pub faces: usize,
    /// Faces without coordinates, or at one or two points.
    pub without_place: usize,
    /// Share of the surface whose faces lie at one or two points each.
    pub share_at_points: f64,
    /// Faces that repeat an earlier face.
    pub duplicates: usize,
    /// Faces with area in space that lie on a line, or whose coordinates are no numbers.
    pub degenerate: usize,
    /// Polygons whose outline in the plane is no simple polygon.
    pub folded: usize,
    /// Pairs of overlapping triangles of different polygons, and of turned-over neighbours. Counting ends above 1000.
    pub overlaps: usize,
}

impl Judgement {
    /// True if the faces with a place are one-to-one.
    pub fn is_planar(&self) -> bool {
        let is_there = self.without_place < self.faces && self.share_at_points <= MOST_AT_POINTS;
        self.degenerate == 0 && self.folded == 0 && self.overlaps == 0 && is_there
    }
}

/// Judges the layout of an OBJ file.
///
/// # Errors
///
/// The line that cannot be read.
pub fn judge_obj(text: &str) -> Result<Judgement, String> {
    Ok(judge(&Layout::of_obj(text)?))
}

type Point = [f64; 2];

#[derive(Default)]
struct Layout {
    positions: Vec<[f64; 3]>,
    coordinates: Vec<Point>,
    /// Corners of each face: position, and coordinate if there is one.
    faces: Vec<Vec<(usize, Option<usize>)>>,
}

impl Layout {
    fn of_obj(text: &str) -> Result<Self, String> {
        let mut layout = Self::default();
        for (number, line) in text.lines().enumerate() {
            let wrong = || format!("line {}: {line}", number + 1);
            let mut words = line.split_whitespace();
            let kind = words.next().unwrap_or_default();
            let numbers = || words.clone().map(str::parse::<f64>).collect::<Result<Vec<_>, _>>().map_err(|_| wrong());
            match kind {
                "v" => {
                    let all = numbers()?;
                    layout.positions.push([0, 1, 2].map(|k| all.get(k).copied().unwrap_or_default()));
                }
                "vt" => {
                    let all = numbers()?;
                    layout.coordinates.push([0, 1].map(|k| all.get(k).copied().unwrap_or_default()));
                }
                "f" => {
                    let corner = |word: &str| layout.corner(word).ok_or_else(wrong);
                    let corners = words.map(corner).collect::<Result<Vec<_>, _>>()?;
                    // Fewer corners have no area. Files keep such lines.
                    if corners.len() >= 3 {
                        layout.faces.push(corners);
                    }
                }
                _ => {}
            }
        }
        Ok(layout)
    }

    /// Corner by its numbers from 1; negative numbers count from the end.
    fn corner(&self, word: &str) -> Option<(usize, Option<usize>)> {
        let index = |text: &str, count: usize| -> Option<usize> {
            let number: i64 = text.parse().ok()?;
            let count = i64::try_from(count).ok()?;
            usize::try_from(if number < 0 { count + number } else { number - 1 }).ok()
        };
        let mut parts = word.split('/');
        let position = index(parts.next()?, self.positions.len())?;
        let coordinate = parts.next().and_then(|text| index(text, self.coordinates.len()));
        (position < self.positions.len()).then_some((position, coordinate.filter(|&k| k < self.coordinates.len())))
    }
}

/// Triangle with its polygon.
struct Triangle {
    polygon: usize,
    corners: [Point; 3],
}

fn judge(layout: &Layout) -> Judgement {
    let mut judgement = Judgement { faces: layout.faces.len(), ..Judgement::default() };
    let mut seen: HashSet<Vec<[u64; 5]>> = HashSet::new();
    let (mut whole_area, mut at_points) = (0.0, 0.0);
    let mut triangles: Vec<Triangle> = Vec::new();
    for (polygon, corners) in layout.faces.iter().enumerate() {
        let Some(places) = corners.iter().map(|(_, uv)| uv.map(|k| layout.coordinates[k])).collect::<Option<Vec<_>>>()
        else {
            judgement.without_place += 1;
            continue;
        };
        let in_space: Vec<[f64; 3]> = corners.iter().map(|(position, _)| layout.positions[*position]).collect();
        let area = area_of(&in_space);
        whole_area += area;
        if places.iter().flatten().any(|x| !x.is_finite()) {
            judgement.degenerate += 1;
            continue;
        }
        let other = places.iter().find(|place| !is_same(place, &places[0])).unwrap_or(&places[0]);
        if places.iter().all(|place| is_same(place, &places[0]) || is_same(place, other)) {
            judgement.without_place += 1;
            at_points += area;
            continue;
        }
        let key = |((position, _), place): (&(usize, Option<usize>), &Point)| {
            let [x, y, z] = layout.positions[*position];
            [x, y, z, place[0], place[1]].map(|x| (x + 0.0).to_bits())
        };
        let mut keys: Vec<[u64; 5]> = corners.iter().zip(&places).map(key).collect();
        keys.sort_unstable();
        keys.dedup();
        if !seen.insert(keys) {
            judgement.duplicates += 1;
            continue;
        }
        match cut(&places) {
            Some(cut) if !cut.is_empty() => {
                triangles.extend(cut.into_iter().map(|corners| Triangle { polygon, corners }));
            }
            Some(_) => {
                judgement.degenerate += usize::from(has_area(&in_space));
            }
            None => judgement.folded += 1,
        }
    }
    judgement.overlaps = overlaps(&triangles);
    judgement.share_at_points = if whole_area > 0.0 { at_points / whole_area } else { 0.0 };
    judgement
}

/// Area of a polygon in space, cut from its first corner.
fn area_of(corners: &[[f64; 3]]) -> f64 {
    let side = |k: usize| [0, 1, 2].map(|axis| corners[k][axis] - corners[0][axis]);
    let term = |k: usize| {
        let ([ax, ay, az], [bx, by, bz]) = (side(k), side(k + 1));
        let cross = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
        cross.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
    };
    (1..corners.len().saturating_sub(1)).map(term).sum()
}

/// True if corners in space do not lie on a line.
fn has_area(corners: &[[f64; 3]]) -> bool {
    let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let length = |a: [f64; 3]| a.iter().map(|x| x * x).sum::<f64>().sqrt();
    let size = corners.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let from = corners[0];
    let sides: Vec<[f64; 3]> = corners[1..].iter().map(|&corner| minus(corner, from)).collect();
    let longest = sides.iter().map(|&side| length(side)).fold(0.0, f64::max);
    let heights = sides.windows(2).map(|pair| length(cross(pair[0], pair[1])));
    heights.fold(0.0, f64::max) > 8.0 * f64::EPSILON * longest * size
}

/// Triangles of a polygon, counter-clockwise, by clipping ears. Empty if all corners lie on a line, `None` if the polygon
/// is not simple.
fn cut(places: &[Point]) -> Option<Vec<[Point; 3]>> {
    let mut ring: Vec<Point> = places.to_vec();
    ring.dedup_by(|a, b| is_same(a, b));
    if ring.len() > 1 && is_same(&ring[0], &ring[ring.len() - 1]) {
        ring.pop();
    }
    if ring.iter().all(|&c| ring.iter().all(|&b| side(ring[0], b, c) == 0)) {
        return Some(Vec::new());
    }
    let doubled: f64 = (0..ring.len()).map(|k| area_term(ring[0], ring[k], ring[(k + 1) % ring.len()])).sum();
    if doubled < 0.0 {
        ring.reverse();
    }
    let mut found = Vec::new();
    while ring.len() > 3 {
        let count = ring.len();
        let at = |k: usize| ring[k % count];
        let is_ear = |k: &usize| {
            let [a, b, c] = [at(k + count - 1), at(*k), at(k + 1)];
            let lies_inside = |z: &Point| {
                ![a, b, c].iter().any(|corner| is_same(corner, z))
                    && side(a, b, *z) >= 0
                    && side(b, c, *z) >= 0
                    && side(c, a, *z) >= 0
            };
            side(a, b, c) > 0 && !ring.iter().any(lies_inside)
        };
        let is_straight = |k: &usize| side(at(k + count - 1), at(*k), at(k + 1)) == 0;
        if let Some(k) = (0..count).find(is_ear) {
            found.push([at(k + count - 1), at(k), at(k + 1)]);
            ring.remove(k);
        } else {
            // A corner on a line between its neighbours adds no area.
            let k = (0..count).find(is_straight)?;
            ring.remove(k);
        }
    }
    let [a, b, c] = [ring[0], ring[1], ring[2]];
    match side(a, b, c) {
        1 => found.push([a, b, c]),
        0 => {}
        _ => return None,
    }
    Some(found)
}

fn is_same(a: &Point, b: &Point) -> bool {
    (0..2).all(|k| a[k].partial_cmp(&b[k]) == Some(std::cmp::Ordering::Equal))
}

fn area_term(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Sign of `(b − a) × (c − a)`, exact.
fn side(a: Point, b: Point, c: Point) -> i32 {
    let (left, right) = ((b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0]));
    let bound = ERROR * (left.abs() + right.abs());
    if (left - right).abs() > bound && bound > f64::MIN_POSITIVE / f64::EPSILON {
        return if left > right { 1 } else { -1 };
    }
    let exact = |x: f64| BigRational::from_float(x).expect("coordinates are numbers");
    let minus = |p: Point, k: usize| exact(p[k]) - exact(a[k]);
    let product = |p: Point, q: Point| minus(p, 0) * minus(q, 1);
    match product(b, c).cmp(&product(c, b)) {
        std::cmp::Ordering::Greater => 1,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Less => -1,
    }
}

/// True if the insides of two counter-clockwise triangles meet: no side of either separates them.
fn meet(a: &[Point; 3], b: &[Point; 3]) -> bool {
    let separates = |own: &[Point; 3], other: &[Point; 3]| {
        (0..3).any(|k| other.iter().all(|&z| side(own[k], own[(k + 1) % 3], z) <= 0))
    };
    !separates(a, b) && !separates(b, a)
}

/// Number of pairs of triangles of different polygons that overlap. Triangles are found in the cells of a grid.
fn overlaps(triangles: &[Triangle]) -> usize {
    let bounds = |corners: &[Point; 3], k: usize| {
        corners.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| [low.min(z[k]), high.max(z[k])])
    };
    let mut whole = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for triangle in triangles {
        for (k, [low, high]) in whole.iter_mut().enumerate() {
            let [own_low, own_high] = bounds(&triangle.corners, k);
            (*low, *high) = (low.min(own_low), high.max(own_high));
        }
    }
    let cells = (triangles.len() as f64).sqrt().ceil().clamp(1.0, MOST_CELLS);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the number of cells")]
    let cell = |x: f64, k: usize| {
        let [low, high] = whole[k];
        (((x - low) / (high - low) * cells).floor().clamp(0.0, cells - 1.0)) as u32
    };
    let range = |corners: &[Point; 3], k: usize| {
        let [low, high] = bounds(corners, k);
        cell(low, k)..=cell(high, k)
    };
    let mut grid: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (number, triangle) in triangles.iter().enumerate() {
        for x in range(&triangle.corners, 0) {
            for y in range(&triangle.corners, 1) {
                grid.entry([x, y]).or_default().push(number);
            }
        }
    }
    let is_first_common = |a: &[Point; 3], b: &[Point; 3], at: [u32; 2]| {
        // A pair that meets in several cells counts in the lowest one.
        (0..2).all(|k| *range(a, k).start().max(range(b, k).start()) == at[k])
    };
    let boxes_meet = |a: &[Point; 3], b: &[Point; 3]| {
        (0..2).all(|k| {
            let ([low, high], [other_low, other_high]) = (bounds(a, k), bounds(b, k));
            low < other_high && other_low < high
        })
    };
    let mut count = 0;
    for (at, members) in &grid {
        if count >= MOST_OVERLAPS {
            break;
        }
        for (k, &i) in members.iter().enumerate() {
            for &j in &members[k + 1..] {
                let (a, b) = (&triangles[i], &triangles[j]);
                count += usize::from(
                    a.polygon != b.polygon
                        && boxes_meet(&a.corners, &b.corners)
                        && is_first_common(&a.corners, &b.corners, *at)
                        && meet(&a.corners, &b.corners),
                );
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.2 0.5\n";

    #[test]
    fn plain_layouts_are_planar_and_damage_is_found() {
        let judged = |faces: &str| judge_obj(&format!("{SQUARE}{faces}")).expect("an OBJ file");
        assert!(judged("f 1/1 2/2 3/3 4/4\n").is_planar());
        assert!(judged("f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n").is_planar());
        assert_eq!(judged("f 1/1 2/2 3/3\nf 1/1 2/2 4/4\n").overlaps, 1);
        assert_eq!(judged("f 1/1 2/2 3/3\nf 1/1 3/3 4/2\n").overlaps, 1);
        assert_eq!(judged("f 1/1 3/3 2/2 4/4\n").folded, 1);
        assert!(!judged("f 1/1 2/2 3/3\nf 1/1 2/2 4/1\n").is_planar());
        assert_eq!(judged("f 1/1 2/2 3/3\nf 3/3 1/1 2/2\n").duplicates, 1);
        assert_eq!(judged("f 1/1 2/2 3/3\nf 1/1 2/1 3/1\nf 1 2 4\n").without_place, 2);
    }

    #[test]
    fn signs_are_exact() {
        let tiny = f64::EPSILON;
        assert_eq!(side([0.0, 0.0], [1.0, 1.0], [0.5, 0.5 + tiny]), 1);
        assert_eq!(side([0.0, 0.0], [1.0, 1.0], [0.5, 0.5]), 0);
        assert_eq!(side([1e-200, 1e-200], [3e-200, 3e-200], [2e-200, 1e-200]), -1);
    }
}
