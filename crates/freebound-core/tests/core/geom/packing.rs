//! Packing boxes into a picture: disjoint by comparing all pairs, and large compared with shelves. Also the
//! least-area rectangle around points, compared with all rotations.

use freebound_core::geom::{Bounds, Packing, PackingOptions, convex_hull, least_box_turn, pack};
use glam::{DVec2, UVec2};

use freebound_testkit::Random;

/// Rounding tolerance, pixels. Coordinates reach some thousands of pixels.
const ROUNDING: f64 = 1e-6;

fn random_boxes(count: usize, random: &mut Random) -> Vec<DVec2> {
    let mut side = || 0.1 + random.unit().powi(3) * 5.0;
    (0..count).map(|_| DVec2::new(side(), side())).collect()
}

/// Bounds of a packed box, pixels.
fn place_of(size: DVec2, packing: &Packing, k: usize) -> Bounds {
    let packed = packing.places[k];
    let size = packing.scale * if packed.turned { DVec2::new(size.y, size.x) } else { size };
    Bounds::of([packed.low, packed.low + size])
}

/// Packs, and asserts the gap between boxes and half of it to the edge.
#[track_caller]
fn packed(sizes: &[DVec2], options: PackingOptions) -> Packing {
    let packing = pack(sizes, options);
    assert_eq!(packing.places.len(), sizes.len());
    let gap = f64::from(options.gap);
    let places: Vec<Bounds> = sizes.iter().enumerate().map(|(k, &size)| place_of(size, &packing, k)).collect();
    let inside = packing.picture.as_dvec2() - gap / 2.0 + ROUNDING;
    for (k, place) in places.iter().enumerate() {
        assert!(place.low.cmpge(DVec2::splat(gap / 2.0 - ROUNDING)).all(), "box {k} at {place:?}");
        assert!(place.high.cmple(inside).all(), "box {k} at {place:?} in {}", packing.picture);
        assert!(options.turns || !packing.places[k].turned, "box {k}");
    }
    // Sorted by left side, a box can only meet boxes that begin before it ends.
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| places[a].low.x.total_cmp(&places[b].low.x));
    for (at, &a) in order.iter().enumerate() {
        let near = order[at + 1..].iter().take_while(|&&b| places[b].low.x < places[a].high.x + gap - ROUNDING);
        for &b in near {
            let apart = (places[b].low.y - places[a].high.y).max(places[a].low.y - places[b].high.y);
            assert!(apart >= gap - ROUNDING, "boxes {a} and {b}: {:?} {:?}", places[a], places[b]);
        }
    }
    packing
}

/// Largest scale at which boxes fit on shelves: highest first, side by side, a new shelf above a full one.
fn scale_on_shelves(sizes: &[DVec2], options: PackingOptions) -> f64 {
    let gap = f64::from(options.gap);
    let picture = UVec2::from_array(options.picture).as_dvec2();
    let mut highest_first = sizes.to_vec();
    highest_first.sort_by(|a, b| b.y.total_cmp(&a.y));
    let fits = |scale: f64| {
        let (mut corner, mut top) = (DVec2::ZERO, 0.0);
        highest_first.iter().all(|&size| {
            let size = (size * scale).ceil() + gap;
            if corner.x + size.x > picture.x {
                corner = DVec2::new(0.0, top);
            }
            top = f64::max(top, corner.y + size.y);
            corner.x += size.x;
            corner.cmple(picture).all() && top <= picture.y
        })
    };
    let mut range = [0.0, picture.max_element() / 0.1];
    for _ in 0..40 {
        let middle = f64::midpoint(range[0], range[1]);
        range[usize::from(!fits(middle))] = middle;
    }
    range[0]
}

#[test]
fn boxes_keep_their_gap_and_lie_inside_and_are_no_smaller_than_on_shelves() {
    let mut random = Random(5);
    for count in [1, 2, 3, 7, 30, 99, 100, 101, 250] {
        for (gap, picture) in [(0, [512, 512]), (4, [1024, 1024]), (7, [300, 900]), (5, [2048, 256])] {
            let sizes = random_boxes(count, &mut random);
            for turns in [true, false] {
                let options = PackingOptions { picture, gap, turns };
                let packing = packed(&sizes, options);
                assert_eq!(packing.picture.to_array(), options.picture, "the gaps fit");
                let shelves = scale_on_shelves(&sizes, options);
                assert!(packing.scale >= 0.9 * shelves, "{count} in {options:?}: {} {shelves}", packing.scale);
            }
        }
    }
}

#[test]
fn thousands_of_boxes_are_packed_as_dense_as_half_the_picture() {
    let mut random = Random(11);
    let sizes = random_boxes(5000, &mut random);
    let options = PackingOptions { picture: [4096; 2], gap: 2, turns: true };
    let packing = packed(&sizes, options);
    let with_gaps: f64 = sizes.iter().map(|size| (*size * packing.scale + 2.0).element_product()).sum();
    assert!(with_gaps > 0.5 * 4096.0 * 4096.0, "{with_gaps}");
    assert!(packing.scale >= 0.9 * scale_on_shelves(&sizes, options));
}

#[test]
fn a_box_fills_the_picture_and_is_turned_where_that_is_larger() {
    let options = PackingOptions { picture: [400, 100], gap: 0, turns: true };
    let upright = packed(&[DVec2::new(1.0, 4.0)], options);
    assert!(upright.places[0].turned && (upright.scale - 100.0).abs() < 1e-3, "{upright:?}");
    let lying = packed(&[DVec2::new(1.0, 4.0)], PackingOptions { turns: false, ..options });
    assert!(!lying.places[0].turned && (lying.scale - 25.0).abs() < 1e-3, "{lying:?}");
}

#[test]
fn there_may_be_no_box_and_boxes_without_size() {
    let options = PackingOptions::default();
    assert_eq!(packed(&[], options).picture.to_array(), options.picture);
    let packing = packed(&[DVec2::ZERO, DVec2::ONE, DVec2::new(0.0, 1.0)], options);
    assert!(packing.scale > 400.0, "boxes without area take next to no room: {packing:?}");
    assert!(packed(&[DVec2::ZERO; 3], options).scale > 0.0);
}

#[test]
fn boxes_of_any_unit_are_packed_alike() {
    let mut random = Random(2);
    for count in [12, 200] {
        let sizes = random_boxes(count, &mut random);
        let options = PackingOptions::default();
        let packing = packed(&sizes, options);
        for power in [-900, 900] {
            let unit = 2.0_f64.powi(power);
            let other = pack(&sizes.iter().map(|&size| size * unit).collect::<Vec<_>>(), options);
            assert_eq!(other.places, packing.places);
            assert_eq!(other.scale, packing.scale / unit);
        }
    }
}

#[test]
fn the_picture_grows_where_gaps_alone_do_not_fit() {
    let options = PackingOptions { picture: [20, 10], gap: 16, turns: true };
    let packing = packed(&[DVec2::ONE; 9], options);
    assert_eq!(packing.picture.x, 2 * packing.picture.y, "it keeps its form");
    assert!(packing.picture.x > 20 && packing.picture.x.is_multiple_of(20), "{}", packing.picture);
}

#[test]
fn the_same_boxes_are_packed_in_the_same_way() {
    let mut random = Random(9);
    for count in [40, 400] {
        let sizes = random_boxes(count, &mut random);
        let options = PackingOptions::default();
        assert_eq!(pack(&sizes, options), pack(&sizes, options));
    }
}

/// Area of the bounding box of rotated points.
fn box_area(points: &[DVec2], turn: DVec2) -> f64 {
    Bounds::of(points.iter().map(|z| turn.rotate(*z))).size().element_product()
}

#[test]
fn no_turn_gives_points_a_smaller_box() {
    let mut random = Random(21);
    for case in 0..300 {
        let count = 3 + random.index(30);
        let stretch = 0.05 + random.unit();
        let by = DVec2::from_angle(random.unit() * std::f64::consts::TAU);
        let mut place = || by.rotate(DVec2::new(random.unit(), random.unit() * stretch));
        let points: Vec<DVec2> = (0..count).map(|_| place()).collect();
        let turn = least_box_turn(&points);
        assert!((turn.length() - 1.0).abs() < 1e-12);
        let least = box_area(&points, turn);
        let hull = convex_hull(&points);
        let sides = (0..hull.len()).map(|k| points[hull[(k + 1) % hull.len()]] - points[hull[k]]);
        let turns = sides.map(|along| DVec2::new(along.x, -along.y).try_normalize().expect("a side has a length"));
        let angles = (0..720).map(|k| DVec2::from_angle(f64::from(k) * std::f64::consts::PI / 720.0));
        for other in turns.chain(angles) {
            assert!(least <= box_area(&points, other) * (1.0 + 1e-12), "case {case}: {turn} {other}");
        }
    }
}

#[test]
fn a_turned_rectangle_is_brought_upright() {
    for degrees in 0..90 {
        let by = DVec2::from_angle(f64::from(degrees).to_radians());
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(|z| by.rotate(DVec2::from(z)));
        let area = box_area(&corners, least_box_turn(&corners));
        assert!((area - 3.0).abs() < 1e-12, "{degrees}: {area}");
    }
}

#[test]
fn points_that_span_no_area_need_no_turn_or_lie_on_an_axis() {
    assert_eq!(least_box_turn(&[]), DVec2::X);
    assert_eq!(least_box_turn(&[DVec2::ONE; 3]), DVec2::X);
    let line: Vec<DVec2> = (0..4).map(|k| f64::from(k) * DVec2::new(3.0, 4.0)).collect();
    assert!(box_area(&line, least_box_turn(&line)) < 1e-12);
    let hole = [DVec2::ZERO, DVec2::NAN, DVec2::X, DVec2::ONE];
    assert!(least_box_turn(&hole).is_finite());
}
