//! Packing of shapes: the gap, the page's edge, turns and degenerate shapes, checked without the packer's grids.

use freebound_core::geom::{ChartShape, Packing, PackingOptions, Rotations, pack};
use freebound_testkit::Random;
use glam::DVec2;

const ALL: [Rotations; 3] = [Rotations::None, Rotations::Quarter, Rotations::Free];

/// Rounding of the distances that the tests compute, in pixels.
const ROUNDING: f64 = 1e-9;

fn options(picture: [u32; 2], gap: u32, rotations: Rotations) -> PackingOptions {
    PackingOptions { picture, gap, rotations }
}

fn packed(shapes: &[ChartShape], options: PackingOptions) -> Packing {
    pack(shapes, options, &|| false).expect("nobody cancels")
}

/// Edges of a shape at its place, in pixels.
fn placed(shape: &ChartShape, packing: &Packing, number: usize) -> Vec<[DVec2; 2]> {
    let place = packing.places[number];
    shape.edges().map(|edge| edge.map(|point| place.position(point, packing.scale))).collect()
}

fn distance_to_segment(point: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    let along = to - from;
    let square = along.length_squared();
    let share = if square > 0.0 { ((point - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(from + along * share)
}

fn cross(a: [DVec2; 2], b: [DVec2; 2]) -> bool {
    let side = |[from, to]: [DVec2; 2], point: DVec2| (to - from).perp_dot(point - from);
    side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0
}

fn segment_distance(a: [DVec2; 2], b: [DVec2; 2]) -> f64 {
    if cross(a, b) {
        return 0.0;
    }
    let ends = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    ends.into_iter().map(|(point, segment)| distance_to_segment(point, segment)).fold(f64::INFINITY, f64::min)
}

/// Winding number by the sum of angles.
#[expect(clippy::cast_possible_truncation, reason = "a winding number is a small integer")]
fn winding(edges: &[[DVec2; 2]], point: DVec2) -> i32 {
    let angle = |[from, to]: &[DVec2; 2]| (*from - point).perp_dot(*to - point).atan2((*from - point).dot(*to - point));
    (edges.iter().map(angle).sum::<f64>() / std::f64::consts::TAU).round() as i32
}

fn shape_distance(a: &[[DVec2; 2]], b: &[[DVec2; 2]]) -> f64 {
    if winding(a, b[0][0]) != 0 || winding(b, a[0][0]) != 0 {
        return 0.0;
    }
    let pairs = a.iter().flat_map(|&first| b.iter().map(move |&second| segment_distance(first, second)));
    pairs.fold(f64::INFINITY, f64::min)
}

/// Least distance between any two shapes, by brute force.
fn least_distance(shapes: &[ChartShape], packing: &Packing) -> f64 {
    let placed: Vec<_> = shapes.iter().enumerate().map(|(k, shape)| placed(shape, packing, k)).collect();
    let mut least = f64::INFINITY;
    for (k, first) in placed.iter().enumerate() {
        for second in &placed[..k] {
            least = least.min(shape_distance(first, second));
        }
    }
    least
}

fn assert_valid(shapes: &[ChartShape], packing: &Packing, gap: u32) {
    assert_eq!(packing.places.len(), shapes.len());
    assert!(packing.scale.is_finite() && packing.scale > 0.0, "scale {}", packing.scale);
    let gap = f64::from(gap);
    let least = least_distance(shapes, packing);
    assert!(least >= gap - ROUNDING, "least distance {least}, gap {gap}");
    let low = DVec2::splat(gap / 2.0 - ROUNDING);
    let high = packing.picture.as_dvec2() - low;
    for (number, shape) in shapes.iter().enumerate() {
        for [point, _] in placed(shape, packing, number) {
            assert!(point.cmpge(low).all() && point.cmple(high).all(), "{point} is off the page");
        }
    }
}

/// Star-shaped polygons around random centres.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 11 corners")]
fn stars(count: usize, seed: u64) -> Vec<ChartShape> {
    let mut random = Random(seed);
    let star = |_| {
        let corners = 3 + (random.unit() * 9.0) as usize;
        let size = 0.2 + random.unit().powi(3) * 3.0;
        let centre = DVec2::new(random.unit() * 50.0, random.unit() * 50.0);
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / corners as f64;
            centre + DVec2::from_angle(angle) * size * (0.3 + 0.7 * random.unit())
        };
        ChartShape::new(vec![(0..corners).map(corner).collect()])
    };
    (0..count).map(star).collect()
}

fn rectangle(width: f64, height: f64) -> Vec<DVec2> {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(DVec2::from).to_vec()
}

/// Frame whose hole is `thickness` away from its outer edge.
fn frame(side: f64, thickness: f64) -> ChartShape {
    let inner = rectangle(side - 2.0 * thickness, side - 2.0 * thickness);
    let hole = inner.into_iter().rev().map(|point| point + thickness).collect();
    ChartShape::new(vec![rectangle(side, side), hole])
}

#[test]
fn stars_keep_the_gap_for_all_rotations_and_pages() {
    for rotations in ALL {
        for (picture, gap) in [([256, 256], 2), ([300, 97], 5), ([64, 511], 0)] {
            let shapes = stars(10, u64::from(gap) + 1);
            let packing = packed(&shapes, options(picture, gap, rotations));
            assert_valid(&shapes, &packing, gap);
            assert_eq!(packing.picture.to_array(), picture);
        }
    }
}

#[test]
fn many_charts_keep_the_gap() {
    let shapes = stars(1300, 5);
    let packing = packed(&shapes, options([512, 512], 1, Rotations::Quarter));
    assert_valid(&shapes, &packing, 1);
}

#[test]
fn a_chart_alone_keeps_half_of_the_gap_to_the_edge() {
    for rotations in ALL {
        for picture in [[256, 256], [300, 97], [16, 900]] {
            let shapes = stars(1, 7);
            assert_valid(&shapes, &packed(&shapes, options(picture, 3, rotations)), 3);
        }
    }
}

#[test]
fn a_small_chart_lies_in_the_hole_of_a_frame() {
    let shapes = [frame(10.0, 1.0), ChartShape::new(vec![rectangle(7.0, 7.0)])];
    let packing = packed(&shapes, options([256, 256], 2, Rotations::Quarter));
    assert_valid(&shapes, &packing, 2);
    let [outer, inner] = [0, 1].map(|k| placed(&shapes[k], &packing, k));
    assert_eq!(winding(&outer, inner[0][0]), 0);
    assert_eq!(winding(&outer[..4], inner[0][0]), 1, "the square lies in the frame");
    assert!(packing.scale > 24.0, "{}", packing.scale);
}

#[test]
fn a_touching_loop_keeps_its_inside() {
    // Two squares that share a corner, in one loop.
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0), (0.0, 1.0)];
    let shapes = vec![ChartShape::new(vec![corners.map(DVec2::from).to_vec()]); 5];
    let packing = packed(&shapes, options([128, 128], 2, Rotations::Free));
    assert_valid(&shapes, &packing, 2);
}

#[test]
fn overlapping_triangles_are_covered_together() {
    let [a, b, c] = [(0.0, 0.0), (3.0, 0.0), (1.0, 2.0)].map(DVec2::from);
    let folded = ChartShape::of_triangles([[a, b, c], [a, c, b + DVec2::Y]]);
    let small = ChartShape::new(vec![rectangle(0.5, 0.5)]);
    let shapes = [folded, small.clone(), small];
    let packing = packed(&shapes, options([128, 128], 2, Rotations::Free));
    let triangles = |number: usize| {
        let edges = placed(&shapes[number], &packing, number);
        edges.chunks(if number == 0 { 3 } else { 4 }).map(<[_]>::to_vec).collect::<Vec<_>>()
    };
    for (first, second) in [(0, 1), (0, 2), (1, 2)] {
        for a in triangles(first) {
            for b in triangles(second) {
                assert!(shape_distance(&a, &b) >= 2.0 - ROUNDING);
            }
        }
    }
}

#[test]
fn quarter_turns_are_exact() {
    let shapes = stars(20, 3);
    let packing = packed(&shapes, options([256, 256], 2, Rotations::Quarter));
    let quarters = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    for place in &packing.places {
        assert!(quarters.contains(&place.turn), "{}", place.turn);
    }
    let upright = packed(&shapes, options([256, 256], 2, Rotations::None));
    assert!(upright.places.iter().all(|place| place.turn == DVec2::X));
}

#[test]
fn free_turns_have_length_one() {
    let shapes = stars(20, 3);
    let packing = packed(&shapes, options([256, 256], 2, Rotations::Free));
    assert!(packing.places.iter().all(|place| (place.turn.length() - 1.0).abs() < 1e-15));
}

#[test]
fn the_same_shapes_give_the_same_packing() {
    let shapes = stars(15, 9);
    let first = packed(&shapes, options([256, 256], 2, Rotations::Free));
    assert_eq!(first, packed(&shapes, options([256, 256], 2, Rotations::Free)));
}

#[test]
fn no_shapes_give_an_empty_packing() {
    let packing = packed(&[], options([100, 50], 4, Rotations::Free));
    assert_eq!((packing.picture.to_array(), packing.places.len()), ([100, 50], 0));
}

#[test]
fn degenerate_shapes_are_packed() {
    let point = ChartShape::new(vec![vec![DVec2::new(3.0, 4.0)]]);
    let segment = ChartShape::new(vec![vec![DVec2::ZERO, DVec2::new(5.0, 1.0)]]);
    let flat = ChartShape::new(vec![[(0.0, 0.0), (2.0, 2.0), (1.0, 1.0)].map(DVec2::from).to_vec()]);
    let empty = ChartShape::new(vec![vec![]]);
    let square = ChartShape::new(vec![rectangle(1.0, 1.0)]);
    let sets = [
        vec![point.clone()],
        vec![segment.clone()],
        vec![point.clone(), empty.clone(), point.clone()],
        vec![segment.clone(), flat.clone(), segment.clone()],
        vec![point, segment, flat, empty, square],
    ];
    for shapes in sets {
        for rotations in ALL {
            let packing = packed(&shapes, options([64, 48], 3, rotations));
            assert_valid(&shapes, &packing, 3);
        }
    }
}

#[test]
fn the_picture_doubles_until_the_gaps_fit() {
    for count in [1, 3] {
        let shapes = stars(count, 2);
        let packing = packed(&shapes, options([8, 4], 9, Rotations::Free));
        assert_valid(&shapes, &packing, 9);
        assert!(packing.picture.x > 9 && packing.picture.x == 2 * packing.picture.y);
    }
}

#[test]
fn shapes_far_from_the_origin_keep_the_gap() {
    let shift = DVec2::new(1e5, -3e5);
    let moved = |shape: &ChartShape| ChartShape::new(vec![shape.vertices().map(|point| point + shift).collect()]);
    for count in [1, 12] {
        let shapes: Vec<ChartShape> = stars(count, 4).iter().map(moved).collect();
        let packing = packed(&shapes, options([256, 256], 2, Rotations::Free));
        assert_valid(&shapes, &packing, 2);
    }
}

#[test]
fn tiny_and_huge_units_give_the_same_cover() {
    let shapes = stars(10, 6);
    let first = packed(&shapes, options([256, 256], 2, Rotations::Free));
    for unit in [2.0_f64.powi(-60), 2.0_f64.powi(60)] {
        let scaled = |shape: &ChartShape| ChartShape::new(vec![shape.vertices().map(|point| point * unit).collect()]);
        let scaled: Vec<ChartShape> = shapes.iter().map(scaled).collect();
        let packing = packed(&scaled, options([256, 256], 2, Rotations::Free));
        assert!((packing.scale * unit / first.scale - 1.0).abs() < 0.02, "{unit}");
    }
}

#[test]
fn a_narrow_picture_is_packed() {
    let shapes = stars(6, 8);
    let packing = packed(&shapes, options([65_536, 1], 0, Rotations::Free));
    assert_valid(&shapes, &packing, 0);
}

#[test]
fn one_square_fills_the_page_and_a_diagonal_strip_turns() {
    let square = [ChartShape::new(vec![rectangle(1.0, 1.0)])];
    let packing = packed(&square, options([100, 100], 0, Rotations::None));
    assert!((packing.scale - 100.0).abs() < 1e-6);
    // A square on its corner fills the page once it is turned by 45°.
    let corners = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)].map(DVec2::from);
    let turned = [ChartShape::new(vec![corners.to_vec()])];
    let packing = packed(&turned, options([100, 100], 0, Rotations::Free));
    assert!((packing.scale * 2.0_f64.sqrt() - 100.0).abs() < 1e-6, "{}", packing.scale);
}

#[test]
fn a_cancelled_packing_is_none() {
    for count in [0, 1, 2, 30, 1500] {
        let shapes = stars(count, 1);
        assert_eq!(pack(&shapes, options([256, 256], 2, Rotations::Free), &|| true), None);
    }
    let calls = std::cell::Cell::new(0);
    let later = || calls.replace(calls.get() + 1) > 5;
    assert_eq!(pack(&stars(30, 1), options([256, 256], 2, Rotations::Free), &later), None);
}
