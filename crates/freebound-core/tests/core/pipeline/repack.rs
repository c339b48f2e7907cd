//! New places for the charts of a given layout.

use std::sync::atomic::AtomicBool;

use freebound_core::geom::{PackingOptions, Random, Stacking};
use freebound_core::mesh::{FaceId, PolygonMesh};
use freebound_core::pipeline::{
    ChartSizes, GivenLayout, LockedCharts, NO_COORDINATE, RepackError, RepackOptions, Repacked, repack, repack_with,
};
use freebound_core::problem::Control;
use freebound_testkit::{fan, grid, tetrahedron};
use glam::DVec2;
use proptest::prelude::*;

fn rules(sizes: ChartSizes, stack: Stacking) -> RepackOptions {
    let packing = PackingOptions { picture: [256; 2], stack, ..PackingOptions::default() };
    RepackOptions { packing, sizes, locked: LockedCharts::default() }
}

/// Layout of a flat mesh: each face alone, or the positions themselves.
struct Layout {
    mesh: PolygonMesh,
    coordinates: Vec<DVec2>,
    corners: Vec<u32>,
}

impl Layout {
    /// Positions without their heights as coordinates.
    fn flat(mesh: PolygonMesh) -> Self {
        let coordinates = mesh.positions.iter().map(|p| p.truncate()).collect();
        let corners = mesh.corners.iter().map(|vertex| vertex.number()).collect();
        Self { mesh, coordinates, corners }
    }

    /// Every triangle of a mesh as a chart of its own, turned, moved and scaled at random.
    fn scattered(mesh: PolygonMesh, random: &mut Random) -> Self {
        let (mut coordinates, mut corners) = (Vec::new(), Vec::new());
        for face in 0..mesh.face_count() {
            let angle = DVec2::from_angle(6.0 * random.unit()) * (0.1 + random.unit());
            let low = DVec2::new(random.unit(), random.unit());
            let points: Vec<_> = mesh.face(face).iter().map(|vertex| mesh.positions[vertex.index()]).collect();
            let along = (points[1] - points[0]).normalize_or_zero();
            let up = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero().cross(along);
            for point in &points {
                let flat = DVec2::new((*point - points[0]).dot(along), (*point - points[0]).dot(up));
                corners.push(u32::try_from(coordinates.len()).expect("few"));
                coordinates.push(angle.rotate(flat) + low);
            }
        }
        Self { mesh, coordinates, corners }
    }

    fn given(&self) -> GivenLayout<'_> {
        let Self { mesh, coordinates, corners } = self;
        GivenLayout { mesh, coordinates, corners, aspect: 1.0 }
    }

    fn repacked(&self, sizes: ChartSizes, stack: Stacking) -> Repacked {
        repack(self.given(), &rules(sizes, stack)).expect("a layout")
    }
}

/// Area of the whole layout.
fn area(repacked: &Repacked) -> f64 {
    let doubled = |corners: &[freebound_core::mesh::VertexId; 3]| {
        let [a, b, c] = corners.map(|vertex| repacked.coordinates[vertex]);
        (b - a).perp_dot(c - a)
    };
    repacked.mesh.triangles.iter().map(doubled).sum::<f64>() / 2.0
}

#[test]
fn faces_of_a_closed_surface_are_charts_of_one_density() {
    let layout = Layout::scattered((&tetrahedron()).into(), &mut Random(1));
    let repacked = layout.repacked(ChartSizes::EqualDensity, Stacking::None);
    assert!(repacked.is_planar() && repacked.charts.len() == 4);
    assert!(repacked.charts.iter().all(|chart| (chart.density / repacked.packing.density - 1.0).abs() < 1e-9));
    assert!((area(&repacked) / repacked.packing.covered - 1.0).abs() < 1e-9);
    // Three faces are right triangles of equal size. Each shares its place with its copies.
    let stacked = layout.repacked(ChartSizes::EqualDensity, Stacking::Congruent);
    assert!(stacked.is_planar() && stacked.packing.density > 1.2 * repacked.packing.density);
    assert_eq!(stacked.charts.iter().filter(|chart| chart.stacked.is_some()).count(), 2);
}

#[test]
fn a_chart_of_the_whole_page_fills_it_again() {
    let layout = Layout::flat((&grid(4, 4)).into());
    let repacked = layout.repacked(ChartSizes::AsGiven, Stacking::None);
    assert!(repacked.is_planar() && repacked.packing.covered > 0.95, "{}", repacked.packing.covered);
    assert_eq!(repacked.corners, layout.corners_by_first_use());
}

impl Layout {
    /// Numbers of the corners' vertices in the order of their first use.
    fn corners_by_first_use(&self) -> Vec<u32> {
        let mut number_of = vec![None; self.coordinates.len()];
        let mut next = 0;
        let number = |&corner: &u32| {
            *number_of[corner as usize].get_or_insert_with(|| {
                next += 1;
                next - 1
            })
        };
        self.corners.iter().map(number).collect()
    }
}

#[test]
fn shapes_in_the_plane_decide_about_stacks_too() {
    // Two fans of one surface. One is stretched in the layout.
    let mut positions: Vec<[f64; 3]> = Vec::new();
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for copy in 0..3_u32 {
        let first = u32::try_from(positions.len()).expect("few");
        positions.extend(fan(5).positions.iter().map(|p| [p.x + 10.0 * f64::from(copy), p.y, p.z]));
        faces.extend(fan(5).triangles.iter().map(|corners| corners.map(|vertex| first + vertex.number())));
    }
    let mut layout = Layout::flat(PolygonMesh::from_arrays(&positions, &faces));
    layout.coordinates[12..].iter_mut().for_each(|z| z.x *= 1.5);
    let repacked = layout.repacked(ChartSizes::AsGiven, Stacking::Mirrored);
    let stacked: Vec<bool> = repacked.charts.iter().map(|chart| chart.stacked.is_some()).collect();
    assert_eq!(stacked, [false, true, false]);
    assert!(repacked.is_planar());
}

#[test]
fn charts_that_touch_at_a_corner_part_there() {
    // Two triangles that share one vertex and its coordinate.
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
    let layout = Layout::flat(PolygonMesh::from_arrays(&positions, &[[0, 1, 2], [0, 3, 4]]));
    let repacked = layout.repacked(ChartSizes::AsGiven, Stacking::None);
    assert!(repacked.is_planar() && repacked.charts.len() == 2);
    assert_eq!(repacked.coordinates.len(), 6);
}

#[test]
fn unusable_coordinates_are_named() {
    let mut layout = Layout::flat((&grid(2, 1)).into());
    layout.corners[4] = NO_COORDINATE;
    let missing = repack(layout.given(), &rules(ChartSizes::AsGiven, Stacking::None));
    assert!(matches!(missing, Err(RepackError::Missing(faces)) if faces.len() == 1 && faces[0].number() == 1));
    let mut layout = Layout::flat((&grid(2, 1)).into());
    layout.coordinates[0].x = f64::NAN;
    let infinite = repack(layout.given(), &rules(ChartSizes::AsGiven, Stacking::None));
    assert!(matches!(infinite, Err(RepackError::NotFinite(_))), "{infinite:?}");
    let none = Layout::flat(PolygonMesh::default());
    assert_eq!(repack(none.given(), &rules(ChartSizes::AsGiven, Stacking::None)).err(), Some(RepackError::NoFaces));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 8, ..ProptestConfig::default() })]

    #[test]
    fn scattered_faces_are_packed_and_proved(seed in any::<u64>(), columns in 1_u32..4, rows in 1_u32..3) {
        let layout = Layout::scattered((&grid(columns, rows)).into(), &mut Random(seed));
        for (sizes, stack) in [(ChartSizes::EqualDensity, Stacking::Mirrored), (ChartSizes::AsGiven, Stacking::None)] {
            let repacked = layout.repacked(sizes, stack);
            prop_assert!(repacked.is_planar(), "{:?}", repacked.verdict);
            prop_assert_eq!(repacked.mesh.face_count(), layout.mesh.face_count());
            let page = |z: &DVec2| z.cmpge(DVec2::ZERO).all() && z.cmple(DVec2::ONE).all();
            prop_assert!(repacked.coordinates.iter().all(page));
            let stacks = repacked.charts.iter().filter(|chart| chart.stacked.is_some()).count();
            // All triangles are halves of equal squares.
            let expected = if stack == Stacking::None { 0 } else { layout.mesh.face_count() - 1 };
            prop_assert_eq!(stacks, expected);
        }
    }
}

/// Rules that lock some charts.
fn locking(locked: LockedCharts, sizes: ChartSizes) -> RepackOptions {
    RepackOptions { locked, ..rules(sizes, Stacking::None) }
}

/// A layout whose first chart lies in a corner of the picture and the others anywhere.
fn with_one_in_the_corner() -> Layout {
    let mut layout = Layout::scattered((&grid(3, 2)).into(), &mut Random(7));
    let own = [DVec2::new(0.05, 0.05), DVec2::new(0.25, 0.05), DVec2::new(0.05, 0.25)];
    layout.coordinates[..3].copy_from_slice(&own);
    layout
}

#[test]
fn locked_charts_keep_their_bits_and_the_others_are_packed_around_them() {
    let layout = with_one_in_the_corner();
    for sizes in [ChartSizes::EqualDensity, ChartSizes::AsGiven] {
        let locked = LockedCharts::WithFaces([FaceId::new(0)].into());
        let packed = repack(layout.given(), &locking(locked, sizes)).unwrap();
        let corner = |corner: usize| packed.coordinates[packed.corners[corner] as usize];
        assert_eq!([0, 1, 2].map(corner), [0, 1, 2].map(|at| layout.coordinates[at]));
        assert!(
            packed.is_planar() && packed.coordinates.iter().all(|z| z.min_element() > 0.0 && z.max_element() < 1.0)
        );
        let moved = (3..layout.corners.len()).filter(|&at| corner(at) != layout.coordinates[at]).count();
        assert_eq!(moved, layout.corners.len() - 3);
        // The others get no more pixels than the locked chart.
        let densest = packed.charts[1..].iter().map(|chart| chart.density).fold(0.0, f64::max);
        assert!(sizes == ChartSizes::AsGiven || densest <= packed.charts[0].density * (1.0 + 1e-9));
        let by_number = locking(LockedCharts::Numbered([0].into()), sizes);
        assert_eq!(repack(layout.given(), &by_number).unwrap().coordinates, packed.coordinates);
    }
}

#[test]
fn charts_lie_beside_a_locked_chart_that_fills_the_picture() {
    let mut layout = with_one_in_the_corner();
    layout.coordinates[..3].copy_from_slice(&[DVec2::new(-9.0, -9.0), DVec2::new(19.0, -9.0), DVec2::new(0.0, 29.0)]);
    let locked = locking(LockedCharts::Numbered([0].into()), ChartSizes::EqualDensity);
    let packed = repack(layout.given(), &locked).unwrap();
    assert!(packed.is_planar());
    let others = &packed.corners[3..];
    assert!(others.iter().all(|&at| packed.coordinates[at as usize].x > 19.0));
}

#[test]
fn all_charts_may_be_locked() {
    let layout = Layout::flat((&grid(3, 2)).into());
    let mut options = locking(LockedCharts::Numbered([0].into()), ChartSizes::AsGiven);
    options.packing.density = Some(1e6);
    let packed = repack(layout.given(), &options).unwrap();
    let kept: Vec<DVec2> = packed.corners.iter().map(|&at| packed.coordinates[at as usize]).collect();
    assert_eq!(kept, layout.corners.iter().map(|&at| layout.coordinates[at as usize]).collect::<Vec<_>>());
    // The density is that of the chart, and none is wanted, because nothing is packed.
    assert!((packed.packing.density / packed.charts[0].density - 1.0).abs() < 1e-12);
    assert_eq!((packed.packing.unmet_density(), packed.packing.tiles), (None, 1));
}

#[test]
fn tiles_that_hold_locked_charts_alone_count() {
    let mut layout = with_one_in_the_corner();
    for corner in &mut layout.coordinates[..3] {
        corner.x += 1.0;
    }
    let locked = locking(LockedCharts::Numbered([0].into()), ChartSizes::EqualDensity);
    let options = RepackOptions { packing: PackingOptions { tiles: 2, ..locked.packing }, ..locked };
    let packed = repack(layout.given(), &options).unwrap();
    let is_in_first = |z: &DVec2| z.x < 1.0;
    assert!(packed.is_planar() && packed.coordinates.iter().skip(3).all(is_in_first), "the others lie in one tile");
    assert_eq!(packed.packing.tiles, 2);
    let area = area(&packed).abs();
    assert!((packed.packing.covered - area / 2.0).abs() < 1e-9, "{} and {area}", packed.packing.covered);
}

#[test]
fn packing_ends_if_it_is_cancelled() {
    let layout = with_one_in_the_corner();
    let (stop, options) = (AtomicBool::new(true), RepackOptions::default());
    let cancelled = repack_with(layout.given(), &options, Control::new(&stop, &|_| {}));
    assert_eq!(cancelled.err(), Some(RepackError::Cancelled));
}

#[test]
fn a_lock_of_a_chart_or_face_that_does_not_exist_is_refused() {
    let layout = Layout::flat((&grid(3, 2)).into());
    let error = |locked| repack(layout.given(), &locking(locked, ChartSizes::AsGiven)).err();
    let chart = error(LockedCharts::Numbered([0, 1].into()));
    assert_eq!(chart, Some(RepackError::NoSuchChart { chart: 1, count: 1 }));
    let face = FaceId::new(12);
    let wrong = error(LockedCharts::WithFaces([FaceId::new(3), face].into()));
    assert_eq!(wrong, Some(RepackError::NoSuchFace { face, count: 12 }));
}
