//! Verdict on charts that move among others, against clipping in rational numbers.

use std::collections::BTreeSet;

use freebound_core::geom::Random;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::Embedding;
use freebound_core::verify::{ChartInPlane, MoveVerdict, move_verdict, shaped_verdict, verdict};
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
fn moved_vertices_of_a_chart_are_judged_as_all_of_it_is() {
    let mut random = Random(5);
    let (mut folded, mut over, mut planar) = (0, 0, 0);
    for _ in 0..80 {
        let mut charts =
            [square(3, DVec2::ZERO), square(2, DVec2::new(1.125, 0.25)), square(2, DVec2::new(-1.125, 0.0))];
        // The middle chart is turned over now and then.
        if random.below(2) == 0 {
            charts[0].1 = charts[0].1.iter().map(|z| DVec2::new(1.0 - z.x, z.y)).collect();
        }
        let moved: Vec<VertexId> = (0..=random.below(2)).map(|_| VertexId::new(random.below(16))).collect();
        for &vertex in &moved {
            let by = DVec2::new(random.below(9).into(), random.below(9).into()) / 16.0 - 0.25;
            charts[0].1[vertex] += by;
        }
        let in_plane: Vec<ChartInPlane<'_>> =
            charts.iter().map(|(mesh, coordinates)| ChartInPlane { mesh, coordinates }).collect();
        let shaped = shaped_verdict(&in_plane, 0, &moved);
        assert_eq!(shaped.overlapping, clipped(&charts), "{moved:?}");
        let alone = verdict(&charts[0].0, &charts[0].1);
        assert_eq!(!shaped.folded.is_empty(), !alone.flipped_faces.is_empty(), "{moved:?} {alone:?}");
        folded += usize::from(!shaped.folded.is_empty());
        over += usize::from(!shaped.overlapping.is_empty());
        planar += usize::from(shaped.is_planar());
    }
    assert!(folded > 5 && over > 5 && planar > 5, "{folded} {over} {planar}");
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
