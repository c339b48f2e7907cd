//! Naive oracle for the verdict: rational numbers, all pairs, textbook definitions. Shares no code with the verdict.
//!
//! Coordinates are rational numbers. Multiplied by their common denominator once, they are integers from then on:
//! every definition below depends on signs only.

use freebound_core::problem::Embedding;
use std::collections::BTreeMap;

use num_bigint::{BigInt, Sign};
use num_rational::BigRational;

/// A point, in units of the common denominator.
type Point = [BigInt; 2];

/// Verdict of the oracle on a map. Elements are named by vertices.
#[derive(Debug, PartialEq)]
pub struct OracleVerdict {
    pub flipped_faces: Vec<usize>,
    /// Pairs of boundary edges, each edge and each pair in ascending order.
    pub boundary_crossings: Vec<[[u32; 2]; 2]>,
    pub overwound_vertices: Vec<u32>,
    pub turning_number: Option<i64>,
    pub zero_area_faces: usize,
    pub mirrored: bool,
    /// True if the map is one-to-one, by a test of all pairs of faces, without knowledge of the boundary.
    pub injective: bool,
}

/// Examines the map of a disk into the plane.
pub fn examine(triangles: &[[u32; 3]], embedding: &Embedding) -> OracleVerdict {
    let points = points(embedding);
    let at = |v: u32| &points[v as usize];
    let signs: Vec<i32> = triangles.iter().map(|&[a, b, c]| sign(&cross(at(a), at(b), at(c)))).collect();
    let mirrored = signs.contains(&-1) && !signs.contains(&1);
    let upright = if mirrored { -1 } else { 1 };
    let boundary = boundary_loop(triangles);
    OracleVerdict {
        flipped_faces: (0..triangles.len()).filter(|&face| signs[face] != upright).collect(),
        boundary_crossings: boundary_crossings(&boundary, &points),
        overwound_vertices: (0..u32::try_from(points.len()).expect("few vertices"))
            .filter(|v| !boundary.contains(v) && is_overwound(*v, triangles, &signs, upright, &points))
            .collect(),
        turning_number: turning_number(&boundary, &points),
        zero_area_faces: signs.iter().filter(|&&s| s == 0).count(),
        mirrored,
        injective: signs.iter().all(|&s| s == upright) && is_injective(triangles, &points),
    }
}

/// Exact points, all multiplied by the factor that makes them whole and small.
fn points(embedding: &Embedding) -> Vec<Point> {
    let exact = |value: f64| BigRational::from_float(value).expect("the oracle takes finite numbers only");
    let points: Vec<[BigRational; 2]> = embedding.iter().map(|p| [exact(p.x), exact(p.y)]).collect();
    // Denominators of floating-point numbers are powers of two: the greatest is a multiple of all.
    let denominator = points.iter().flatten().map(|c| c.denom().clone()).max().expect("a case has vertices");
    let mut points: Vec<Point> =
        points.iter().map(|p| [0, 1].map(|i| p[i].numer() * (&denominator / p[i].denom()))).collect();
    let twos = points.iter().flatten().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
    points.iter_mut().flatten().for_each(|coordinate| *coordinate >>= twos);
    points
}

fn sign(value: &BigInt) -> i32 {
    match value.sign() {
        Sign::Minus => -1,
        Sign::NoSign => 0,
        Sign::Plus => 1,
    }
}

/// (b − a) × (c − a).
fn cross(a: &Point, b: &Point, c: &Point) -> BigInt {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// (b − a) · (c − a).
fn dot(a: &Point, b: &Point, c: &Point) -> BigInt {
    (&b[0] - &a[0]) * (&c[0] - &a[0]) + (&b[1] - &a[1]) * (&c[1] - &a[1])
}

/// Follows the directed sides that have no opposite.
fn boundary_loop(triangles: &[[u32; 3]]) -> Vec<u32> {
    let sides: Vec<[u32; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let next: BTreeMap<u32, u32> =
        sides.iter().filter(|&&[a, b]| !sides.contains(&[b, a])).map(|&[a, b]| (a, b)).collect();
    let mut boundary = vec![*next.keys().next().expect("a disk has a boundary")];
    while boundary.len() < next.len() {
        boundary.push(next[&boundary[boundary.len() - 1]]);
    }
    boundary
}

/// Intersection of two closed segments.
#[derive(PartialEq)]
enum Common {
    Nothing,
    OnePoint,
    Segment,
}

fn common([a, b]: [&Point; 2], [c, d]: [&Point; 2]) -> Common {
    let determinant = (&b[0] - &a[0]) * (&d[1] - &c[1]) - (&b[1] - &a[1]) * (&d[0] - &c[0]);
    if sign(&determinant) == 0 {
        let on_one_line = [cross(a, b, c), cross(a, b, d), cross(c, d, a), cross(c, d, b)].iter().all(|x| sign(x) == 0);
        if !on_one_line {
            return Common::Nothing;
        }
        // Lexicographic order along the line.
        return match a.min(b).max(c.min(d)).cmp(a.max(b).min(c.max(d))) {
            std::cmp::Ordering::Less => Common::Segment,
            std::cmp::Ordering::Equal => Common::OnePoint,
            std::cmp::Ordering::Greater => Common::Nothing,
        };
    }
    // a + s (b − a) = c + t (d − c), by Cramer's rule: numerators of s and t.
    let of_first = (&c[0] - &a[0]) * (&d[1] - &c[1]) - (&c[1] - &a[1]) * (&d[0] - &c[0]);
    let of_second = (&c[0] - &a[0]) * (&b[1] - &a[1]) - (&c[1] - &a[1]) * (&b[0] - &a[0]);
    let zero_to_one = BigInt::ZERO.min(determinant.clone())..=BigInt::ZERO.max(determinant);
    if zero_to_one.contains(&of_first) && zero_to_one.contains(&of_second) { Common::OnePoint } else { Common::Nothing }
}

fn boundary_crossings(boundary: &[u32], points: &[Point]) -> Vec<[[u32; 2]; 2]> {
    let edge = |i: usize| [boundary[i], boundary[(i + 1) % boundary.len()]];
    let mut crossings = Vec::new();
    for i in 0..boundary.len() {
        for j in 0..i {
            let common = common(edge(i).map(|v| &points[v as usize]), edge(j).map(|v| &points[v as usize]));
            // Neighbours share one point: their common end.
            let are_neighbours = edge(i).iter().any(|v| edge(j).contains(v));
            let crosses = common == Common::Segment || (common == Common::OnePoint && !are_neighbours);
            if crosses {
                crossings.push(sorted_pair(edge(i), edge(j)));
            }
        }
    }
    crossings.sort_unstable();
    crossings
}

/// Pair of edges in a fixed order, so that pairs are comparable.
pub fn sorted_pair(mut first: [u32; 2], mut second: [u32; 2]) -> [[u32; 2]; 2] {
    first.sort_unstable();
    second.sort_unstable();
    [first.min(second), first.max(second)]
}

/// Angle between two directions, given by their cross and dot products, in (−π, π]. Its sign is exact.
fn angle(cross: &BigInt, dot: &BigInt) -> f64 {
    const BITS: u32 = 60;
    let size = |x: &BigInt| BigInt::from(x.magnitude().clone());
    let greatest = size(cross).max(size(dot));
    let scaled = |x: &BigInt| i64::try_from((x << BITS) / &greatest).expect("at most 2^60") as f64;
    f64::from(sign(cross)) * scaled(&size(cross)).atan2(scaled(dot))
        + if sign(cross) == 0 && sign(dot) < 0 { std::f64::consts::PI } else { 0.0 }
}

/// Number of full turns in a sum of angles, which must be whole.
fn full_turns(sum: f64) -> i64 {
    let turns = sum / std::f64::consts::TAU;
    assert!((turns - turns.round()).abs() < 1e-9, "{turns} turns");
    #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
    let whole = turns.round() as i64;
    whole
}

fn turning_number(boundary: &[u32], points: &[Point]) -> Option<i64> {
    let count = boundary.len();
    let mut sum = 0.0;
    for i in 0..count {
        let [a, b, c] = [0, 1, 2].map(|k| &points[boundary[(i + k) % count] as usize]);
        // Exterior angle at b: both directions start at b, the first one reversed.
        let (cross, dot) = (cross(a, b, c), -dot(b, a, c));
        if b == c || a == b || (sign(&cross) == 0 && sign(&dot) < 0) {
            return None;
        }
        sum += angle(&cross, &dot);
    }
    Some(full_turns(sum))
}

fn is_overwound(vertex: u32, triangles: &[[u32; 3]], signs: &[i32], upright: i32, points: &[Point]) -> bool {
    let mut sum = 0.0;
    for (&triangle, &sign) in triangles.iter().zip(signs) {
        let Some(corner) = triangle.iter().position(|&v| v == vertex) else { continue };
        if sign != upright {
            return false;
        }
        let [a, b, c] = [0, 1, 2].map(|k| &points[triangle[(corner + k) % 3] as usize]);
        sum += angle(&cross(a, b, c), &dot(a, b, c));
    }
    full_turns(sum).abs() > 1
}

/// True if any two faces, none of area zero, have in common in the plane exactly what they share in the mesh.
fn is_injective(triangles: &[[u32; 3]], points: &[Point]) -> bool {
    (0..triangles.len()).all(|i| (0..i).all(|j| meet_as_in_the_mesh(triangles[i], triangles[j], points)))
}

/// True if two triangles have in common in the plane exactly what they share in the mesh.
///
/// The intersection of two triangles is convex. Its extreme points are corners of one triangle inside the other, and
/// points at which two sides cross between their ends. Shared corners are allowed. All other extreme points are
/// outside the shared simplex: a corner at another corner, or on the opposite side, would make a face of area zero.
fn meet_as_in_the_mesh(first: [u32; 3], second: [u32; 3], points: &[Point]) -> bool {
    let at = |v: u32| &points[v as usize];
    let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let side = |[a, b]: [u32; 2], v: u32| sign(&cross(at(a), at(b), at(v)));
    let lies_in = |v: u32, [a, b, c]: [u32; 3]| {
        let inside = side([a, b], c);
        sides([a, b, c]).iter().all(|&s| side(s, v) * inside >= 0)
    };
    let strays = |from: [u32; 3], into: [u32; 3]| from.iter().any(|&v| !into.contains(&v) && lies_in(v, into));
    let apart = |s: [u32; 2], t: [u32; 2]| side(s, t[0]) * side(s, t[1]) < 0;
    let cross_between_ends = sides(first).iter().any(|&s| sides(second).iter().any(|&t| apart(s, t) && apart(t, s)));
    !cross_between_ends && !strays(first, second) && !strays(second, first)
}

/// Pairs of triangles whose intersection has area, the lower one second. The intersection is found by clipping one
/// triangle at the sides of the other, in rational numbers.
pub fn overlapping_pairs(triangles: &[[u32; 3]], embedding: &Embedding) -> Vec<[usize; 2]> {
    let points: Vec<RationalPoint> =
        points(embedding).into_iter().map(|point| point.map(BigRational::from_integer)).collect();
    let corners = |face: usize| {
        let mut corners = triangles[face].map(|v| points[v as usize].clone()).to_vec();
        if doubled_area(&corners) < BigRational::ZERO {
            corners.reverse();
        }
        corners
    };
    let overlap = |a: usize, b: usize| {
        let (clip, mut rest) = (corners(b), corners(a));
        if doubled_area(&clip) == BigRational::ZERO {
            return false;
        }
        for k in 0..3 {
            rest = clipped(&rest, [&clip[k], &clip[(k + 1) % 3]]);
        }
        doubled_area(&rest) > BigRational::ZERO
    };
    (0..triangles.len()).flat_map(|a| (0..a).map(move |b| [a, b])).filter(|&[a, b]| overlap(a, b)).collect()
}

type RationalPoint = [BigRational; 2];

fn doubled_area(polygon: &[RationalPoint]) -> BigRational {
    let product = |k: usize| {
        let [p, q] = [&polygon[k], &polygon[(k + 1) % polygon.len()]];
        &p[0] * &q[1] - &p[1] * &q[0]
    };
    (0..polygon.len()).map(product).sum()
}

/// Part of a convex polygon to the left of a line.
fn clipped(polygon: &[RationalPoint], [from, to]: [&RationalPoint; 2]) -> Vec<RationalPoint> {
    let height =
        |p: &RationalPoint| (&to[0] - &from[0]) * (&p[1] - &from[1]) - (&to[1] - &from[1]) * (&p[0] - &from[0]);
    let mut kept = Vec::new();
    for k in 0..polygon.len() {
        let (p, q) = (&polygon[k], &polygon[(k + 1) % polygon.len()]);
        let (at_p, at_q) = (height(p), height(q));
        if at_p >= BigRational::ZERO {
            kept.push(p.clone());
        }
        if (at_p > BigRational::ZERO) != (at_q > BigRational::ZERO) && at_p != at_q {
            let share = &at_p / (&at_p - &at_q);
            kept.push([0, 1].map(|i| &p[i] + (&q[i] - &p[i]) * &share));
        }
    }
    kept
}
