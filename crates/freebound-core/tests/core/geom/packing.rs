//! Packing of shapes: the gap, the page's edge, turns and degenerate shapes, checked without the packer's grids.

use freebound_core::geom::{ChartShape, Packing, PackingInput, PackingOptions, Rotations, pack};
use freebound_testkit::Random;
use glam::DVec2;

const ALL: [Rotations; 3] = [Rotations::None, Rotations::Quarter, Rotations::Free];

/// Rounding of the distances that the tests compute, in pixels.
const ROUNDING: f64 = 1e-9;

fn options(picture: [u32; 2], gap: u32, rotations: Rotations) -> PackingOptions {
    PackingOptions { picture, gap, rotations, ..PackingOptions::default() }
}

fn only(shapes: &[ChartShape]) -> PackingInput<'_> {
    PackingInput { shapes, ..PackingInput::default() }
}

fn packed(shapes: &[ChartShape], options: PackingOptions) -> Packing {
    pack(only(shapes), options, &|| false).expect("nobody cancels")
}

/// Edges of a shape at its place, in pixels, with each tile at its place.
fn placed(shape: &ChartShape, packing: &Packing, number: usize) -> Vec<[DVec2; 2]> {
    let place = packing.places[number];
    let corner = corner(packing, place.tile);
    shape.edges().map(|edge| edge.map(|point| place.position(point, packing.scale) + corner)).collect()
}

/// Lower left corner of a tile in pixels.
fn corner(packing: &Packing, tile: u32) -> DVec2 {
    DVec2::new(f64::from(tile % 10), f64::from(tile / 10)) * packing.picture.as_dvec2()
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
        let corner = corner(packing, packing.places[number].tile);
        for [point, _] in placed(shape, packing, number) {
            let point = point - corner;
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
        assert_eq!(pack(only(&shapes), options([256, 256], 2, Rotations::Free), &|| true), None);
    }
    let calls = std::cell::Cell::new(0);
    let later = || calls.replace(calls.get() + 1) > 5;
    assert_eq!(pack(only(&stars(30, 1)), options([256, 256], 2, Rotations::Free), &later), None);
}

fn at_density(picture: [u32; 2], gap: u32, density: f64) -> PackingOptions {
    PackingOptions { density: Some(density), ..options(picture, gap, Rotations::Free) }
}

#[test]
fn a_density_that_fits_is_met_exactly_in_the_given_picture() {
    for count in [1, 2, 10, 1300] {
        let shapes = stars(count, 11);
        let largest = packed(&shapes, options([512, 256], 2, Rotations::Free)).scale;
        for share in [1e-3, 0.5, 0.9] {
            let packing = packed(&shapes, at_density([512, 256], 2, share * largest));
            assert_valid(&shapes, &packing, 2);
            assert_eq!((packing.scale, packing.picture.to_array()), (share * largest, [512, 256]), "{count} {share}");
        }
    }
}

#[test]
fn the_picture_doubles_until_shapes_fit_at_the_density() {
    for count in [1, 10] {
        let shapes = stars(count, 12);
        let largest = packed(&shapes, options([128, 64], 2, Rotations::Free)).scale;
        for (factor, side) in [(1.2, 256), (5.0, 1024)] {
            let packing = packed(&shapes, at_density([128, 64], 2, factor * largest));
            assert_valid(&shapes, &packing, 2);
            assert_eq!((packing.scale, packing.picture.to_array()), (factor * largest, [side, side / 2]));
        }
    }
}

#[test]
fn several_packings_have_one_density() {
    let packings = [stars(3, 1), stars(20, 2)].map(|shapes| packed(&shapes, at_density([16, 16], 1, 7.0)));
    assert!(packings.iter().all(|packing| packing.scale.to_bits() == 7.0_f64.to_bits()));
    assert!(packings[0].picture.x < packings[1].picture.x);
}

#[test]
fn a_density_beyond_the_largest_picture_gives_the_largest_one_found() {
    for count in [1, 5] {
        let shapes = stars(count, 13);
        for density in [1e9, f64::MAX] {
            let packing = packed(&shapes, at_density([100, 50], 3, density));
            assert_valid(&shapes, &packing, 3);
            assert!(packing.scale < density && packing.scale > 1000.0, "{}", packing.scale);
            assert_eq!(packing.picture.to_array(), [51_200, 25_600]);
        }
    }
}

#[test]
fn densities_that_are_no_lengths_are_ignored() {
    let shapes = stars(3, 14);
    let largest = packed(&shapes, options([64, 64], 1, Rotations::Free));
    for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(packed(&shapes, at_density([64, 64], 1, density)), largest);
    }
}

#[test]
fn points_and_segments_are_packed_at_a_density() {
    let point = ChartShape::new(vec![vec![DVec2::new(3.0, 4.0)]]);
    let segment = ChartShape::new(vec![vec![DVec2::ZERO, DVec2::new(5.0, 1.0)]]);
    for shapes in [vec![point.clone()], vec![segment.clone()], vec![point.clone(), point.clone()], vec![point, segment]]
    {
        let packing = packed(&shapes, at_density([64, 48], 3, 20.0));
        assert_valid(&shapes, &packing, 3);
        assert_eq!(packing.scale.to_bits(), 20.0_f64.to_bits());
    }
}

#[test]
fn random_shapes_at_random_densities_keep_the_gap() {
    let mut random = Random(15);
    for seed in 0_u32..12 {
        let shapes = stars(1 + seed as usize % 7, seed.into());
        let (density, gap) = (10.0_f64.powf(2.5 * random.unit()), seed % 4);
        let packing = packed(&shapes, at_density([96, 160], gap, density));
        assert_valid(&shapes, &packing, gap);
        assert_eq!(packing.scale.to_bits(), density.to_bits());
        assert_eq!(packing, packed(&shapes, at_density([96, 160], gap, density)));
    }
}

fn in_tiles(picture: [u32; 2], gap: u32, tiles: u32) -> PackingOptions {
    PackingOptions { tiles, ..options(picture, gap, Rotations::Free) }
}

fn packed_beside(input: PackingInput<'_>, options: PackingOptions) -> Packing {
    pack(input, options, &|| false).expect("nobody cancels")
}

/// Number of tiles that hold shapes.
fn used_tiles(packing: &Packing) -> usize {
    packing.places.iter().map(|place| place.tile).collect::<std::collections::BTreeSet<u32>>().len()
}

#[test]
fn tiles_hold_shapes_with_their_gap_at_a_larger_scale() {
    let shapes = stars(24, 21);
    let alone = packed(&shapes, options([128, 96], 2, Rotations::Free)).scale;
    for (tiles, growth) in [(2, 1.25), (4, 1.5), (13, 1.5)] {
        let packing = packed(&shapes, in_tiles([128, 96], 2, tiles));
        assert_valid(&shapes, &packing, 2);
        assert!(packing.places.iter().all(|place| place.tile < tiles));
        assert!(packing.scale > growth * alone, "{tiles} tiles: {} {alone}", packing.scale);
        assert_eq!(packing, packed(&shapes, in_tiles([128, 96], 2, tiles)));
    }
}

#[test]
fn neighbouring_tiles_without_a_gap_do_not_touch() {
    let shapes = vec![ChartShape::new(vec![rectangle(1.0, 1.0)]); 12];
    let packing = packed(&shapes, in_tiles([64, 64], 0, 12));
    assert_valid(&shapes, &packing, 0);
    assert!(least_distance(&shapes, &packing) > 0.0);
    assert!(packing.scale > 63.0, "a square in each tile: {}", packing.scale);
}

#[test]
fn many_shapes_fill_several_tiles() {
    let shapes = stars(1300, 5);
    let packing = packed(&shapes, in_tiles([256, 256], 1, 3));
    assert_valid(&shapes, &packing, 1);
    assert_eq!(used_tiles(&packing), 3);
}

#[test]
fn shapes_lie_in_the_tiles_that_are_given_for_them() {
    for count in [1, 20, 1300] {
        let shapes = stars(count, 22);
        let tiles: Vec<Option<u32>> = (0..count).map(|k| [Some(0), Some(11), None, Some(2)][k % 4]).collect();
        let input = PackingInput { shapes: &shapes, tiles: &tiles, fixed: &[] };
        let packing = packed_beside(input, in_tiles([200, 200], 1, 12));
        assert_valid(&shapes, &packing, 1);
        for (place, tile) in packing.places.iter().zip(&tiles) {
            assert!(tile.is_none_or(|tile| tile == place.tile), "{place:?} {tile:?}");
        }
    }
}

#[test]
fn a_density_uses_few_tiles_and_then_a_larger_picture() {
    let shapes = stars(30, 23);
    let alone = packed(&shapes, options([128, 128], 2, Rotations::Free)).scale;
    let at = |factor: f64, tiles| PackingOptions { density: Some(factor * alone), ..in_tiles([128, 128], 2, tiles) };
    for (factor, tiles, side, least, most) in
        [(0.9, 9, 128, 1, 1), (1.3, 9, 128, 2, 2), (2.0, 9, 128, 4, 5), (1.9, 2, 256, 1, 1)]
    {
        let packing = packed(&shapes, at(factor, tiles));
        assert_valid(&shapes, &packing, 2);
        assert_eq!(packing.scale.to_bits(), (factor * alone).to_bits());
        assert_eq!(packing.picture.x, side, "{factor} {tiles}");
        assert!((least..=most).contains(&used_tiles(&packing)), "{factor}: {} tiles", used_tiles(&packing));
    }
}

#[test]
fn random_shapes_keep_the_gap_to_fixed_shapes() {
    let mut random = Random(31);
    for seed in 0..9_u32 {
        let (gap, tiles) = (seed % 4, 1 + seed % 3);
        let fixed: Vec<ChartShape> = stars(3, u64::from(seed) + 100)
            .iter()
            .map(|star| {
                let at = DVec2::new(random.unit() * f64::from(tiles), random.unit())
                    - star.vertices().next().expect("a vertex") * 0.1;
                ChartShape::new(vec![star.vertices().map(|vertex| vertex * 0.1 + at).collect()])
            })
            .collect();
        let shapes = stars(1 + seed as usize, u64::from(seed));
        let input = PackingInput { shapes: &shapes, tiles: &[], fixed: &fixed };
        let packing = packed_beside(input, in_tiles([160, 120], gap, tiles));
        assert_valid(&shapes, &packing, gap);
        assert_eq!(packing.picture.to_array(), [160, 120]);
        assert_beside(&shapes, &fixed, &packing, gap);
        assert_eq!(packing, packed_beside(input, in_tiles([160, 120], gap, tiles)));
    }
}

/// Asserts the gap between packed shapes and fixed ones.
fn assert_beside(shapes: &[ChartShape], fixed: &[ChartShape], packing: &Packing, gap: u32) {
    let size = packing.picture.as_dvec2();
    for (number, shape) in shapes.iter().enumerate() {
        let own = placed(shape, packing, number);
        for other in fixed {
            let other: Vec<[DVec2; 2]> = other.edges().map(|edge| edge.map(|point| point * size)).collect();
            let distance = shape_distance(&own, &other);
            assert!(distance >= f64::from(gap) - ROUNDING, "{distance} from a fixed shape, gap {gap}");
        }
    }
}

#[test]
fn a_shape_lies_in_the_hole_of_a_fixed_frame() {
    let fixed = [frame(1.0, 0.1)];
    let shapes = [ChartShape::new(vec![rectangle(1.0, 1.0)])];
    let input = PackingInput { shapes: &shapes, tiles: &[], fixed: &fixed };
    let packing = packed_beside(input, options([100, 100], 2, Rotations::Free));
    assert_valid(&shapes, &packing, 2);
    assert_beside(&shapes, &fixed, &packing, 2);
    assert!(packing.scale > 70.0, "the hole is 80 pixels wide: {}", packing.scale);
}

#[test]
fn a_density_beside_fixed_shapes_doubles_the_picture() {
    let fixed = [ChartShape::new(vec![rectangle(1.0, 0.5)])];
    let shapes = vec![ChartShape::new(vec![rectangle(1.0, 1.0)]); 3];
    let input = PackingInput { shapes: &shapes, tiles: &[], fixed: &fixed };
    let with = |density| PackingOptions { density: Some(density), ..options([64, 64], 2, Rotations::Free) };
    for (density, side) in [(18.0, 64), (35.0, 128), (80.0, 256)] {
        let packing = packed_beside(input, with(density));
        assert_valid(&shapes, &packing, 2);
        assert_beside(&shapes, &fixed, &packing, 2);
        assert_eq!((packing.scale, packing.picture.x), (density, side));
    }
}

#[test]
fn a_page_that_fixed_shapes_fill_has_a_scale_of_zero() {
    let fixed = [ChartShape::new(vec![rectangle(1.0, 1.0)])];
    let shapes = stars(2, 1);
    let input = PackingInput { shapes: &shapes, tiles: &[], fixed: &fixed };
    let packing = packed_beside(input, options([64, 64], 2, Rotations::Free));
    assert_eq!(packing.scale.to_bits(), 0.0_f64.to_bits());
}
