//! Verdict on charts that move among others, against clipping in rational numbers.

use std::collections::BTreeSet;

use freebound_core::geom::Random;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{ChartInPlane, MoveVerdict, move_verdict};
use freebound_testkit::oracle::overlapping_pairs;
use freebound_testkit::sheet;
use glam::DVec2;

/// Flat unit square of this many rows, as a disk, moved in the plane.
fn square(rows: u32, by: DVec2) -> (DiskMesh, Embedding) {
    let disk = DiskMesh::try_from(sheet(rows, 0.0)).expect("a disk");
    let coordinates = sheet(rows, 0.0).positions.iter().map(|at| at.truncate() + by).collect();
    (disk, coordinates)
}

/// Pairs of charts that overlap, found by clipping.
fn clipped(charts: &[(DiskMesh, Embedding)]) -> BTreeSet<[usize; 2]> {
    let (mut triangles, mut chart_of, mut points) = (Vec::new(), Vec::new(), Vec::new());
    for (number, (disk, coordinates)) in charts.iter().enumerate() {
        let first = u32::try_from(points.len()).expect("few");
        triangles.extend(disk.mesh().triangles.iter().map(|corners| corners.map(|vertex| first + vertex.number())));
        chart_of.resize(triangles.len(), number);
        points.extend(coordinates.iter().copied());
    }
    let pairs = overlapping_pairs(&triangles, &points.into());
    let of_charts = pairs.into_iter().map(|[a, b]| [chart_of[a].min(chart_of[b]), chart_of[a].max(chart_of[b])]);
    of_charts.filter(|[a, b]| a != b).collect()
}

fn judged(charts: &[(DiskMesh, Embedding)], moved: &[usize]) -> MoveVerdict {
    let charts: Vec<ChartInPlane<'_>> =
        charts.iter().map(|(mesh, coordinates)| ChartInPlane { mesh, coordinates }).collect();
    move_verdict(&charts, &moved.iter().copied().collect())
}

#[test]
fn overlaps_of_moved_charts_are_those_of_exact_clipping() {
    let mut random = Random(11);
    let (mut apart, mut over) = (0, 0);
    for _ in 0..60 {
        // Places on a grid of quarters, so that edges and corners often coincide.
        let place = |random: &mut Random| DVec2::new(random.below(12).into(), random.below(12).into()) / 4.0;
        let charts: Vec<_> = (1..4).map(|rows| square(rows, place(&mut random))).collect();
        let expected = clipped(&charts);
        let verdict = judged(&charts, &[0, 1, 2]);
        assert_eq!((verdict.overlapping.clone(), verdict.folded.len()), (expected.clone(), 0));
        let of_first: BTreeSet<[usize; 2]> = expected.iter().copied().filter(|pair| pair.contains(&0)).collect();
        assert_eq!(judged(&charts, &[0]).overlapping, of_first, "pairs that stay are not judged");
        if expected.is_empty() {
            apart += 1;
        } else {
            over += 1;
        }
        assert_eq!(verdict.is_planar(), expected.is_empty());
    }
    assert!(apart > 5 && over > 5, "{apart} {over}");
}

#[test]
fn charts_that_touch_along_an_edge_do_not_overlap() {
    let charts = [square(2, DVec2::ZERO), square(3, DVec2::X)];
    assert!(judged(&charts, &[1]).is_planar());
    let charts = [square(2, DVec2::ZERO), square(3, DVec2::X.with_x(1.0 - f64::EPSILON))];
    assert_eq!(judged(&charts, &[1]).overlapping, BTreeSet::from([[0, 1]]));
}

#[test]
fn a_moved_chart_that_folds_is_named_and_a_mirrored_one_is_not() {
    let mut charts = [square(2, DVec2::ZERO), square(3, 3.0 * DVec2::X)];
    charts[1].1 = charts[1].1.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
    assert!(judged(&charts, &[1]).is_planar(), "turned over as a whole");
    let inner = VertexId::new(5);
    charts[1].1[inner] += DVec2::new(0.4, 0.0);
    let verdict = judged(&charts, &[1]);
    assert_eq!((verdict.folded, verdict.overlapping.len()), (vec![1], 0));
}
