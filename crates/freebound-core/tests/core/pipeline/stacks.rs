//! Stacks: charts with congruent surfaces share one place.

use freebound_core::geom::{PackingOptions, PictureFrame, Random, Stacking};
use freebound_core::mesh::{PolygonMesh, Preparation, VertexId};
use freebound_core::pipeline::{
    Arrangement, Outcome, PreparedMesh, Problem, SolvedChart, StackedOn, Target, Targets, Unwrapped, atlas,
};
use freebound_core::problem::{Control, Settings};
use freebound_core::verify::AtlasVerdict;
use freebound_core::{PipelineOptions, unwrap};
use freebound_testkit::cubes::cube;

use freebound_testkit::surfaces::without_faces;
use freebound_testkit::{fan, quad_sheet, shaped};
use glam::{DMat3, DQuat, DVec2, DVec3};
use proptest::prelude::*;

/// Options that stack charts, without seams.
fn options(stack: Stacking) -> PipelineOptions {
    let packing = PackingOptions { stack, picture: [256; 2], ..PackingOptions::default() };
    PipelineOptions { packing, distortion: None, ..PipelineOptions::for_any_mesh() }
}

fn unwrapped(parts: &[PolygonMesh], stack: Stacking) -> Unwrapped {
    unwrap(&joined(parts), &options(stack)).expect("planar")
}

/// Meshes one after another in one mesh, with their faces in order.
fn joined(parts: &[PolygonMesh]) -> PolygonMesh {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for part in parts {
        let first = u32::try_from(positions.len()).expect("few");
        positions.extend(part.positions.iter().map(DVec3::to_array));
        let number = |vertex: &VertexId| first + vertex.number();
        faces.extend((0..part.face_count()).map(|face| part.face(face).iter().map(number).collect::<Vec<u32>>()));
    }
    PolygonMesh::from_arrays(&positions, &faces)
}

/// The mesh elsewhere: turned, moved, scaled, with its vertices, faces and first corners in another order.
fn elsewhere(mesh: &PolygonMesh, scale: f64, random: &mut Random) -> PolygonMesh {
    let axis = DVec3::new(random.unit(), random.unit(), random.unit() + 0.1).normalize_or_zero();
    let turn = DMat3::from_quat(DQuat::from_axis_angle(axis, 6.0 * random.unit())) * scale;
    let aside = DVec3::new(random.unit(), random.unit(), random.unit()) * 50.0;
    let order = shuffled(mesh.positions.len(), random);
    let mut positions = vec![[0.0; 3]; order.len()];
    for (&to, &position) in order.iter().zip(&mesh.positions) {
        positions[to] = (turn * position + aside).to_array();
    }
    let face = |face: usize| {
        let mut corners: Vec<u32> =
            mesh.face(face).iter().map(|v| VertexId::from_index(order[v.index()]).number()).collect();
        let first = face % corners.len();
        corners.rotate_left(first);
        corners
    };
    let faces: Vec<Vec<u32>> = shuffled(mesh.face_count(), random).into_iter().map(face).collect();
    PolygonMesh::from_arrays(&positions, &faces)
}

fn shuffled(count: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, random.index(last + 1));
    }
    order
}

/// The mesh as its mirror image, with its faces counter-clockwise again.
fn mirror_image(mesh: &PolygonMesh) -> PolygonMesh {
    let mut mirrored = mesh.turned();
    mirrored.positions.iter_mut().for_each(|position| position.x = -position.x);
    mirrored
}

/// A bent sheet that is not congruent to its mirror image.
fn chiral_sheet() -> PolygonMesh {
    (&shaped(4, 3, |x, y| DVec3::new(x + 0.1 * y * y, y, 0.05 * x * x * y))).into()
}

fn stacked_on(unwrapped: &Unwrapped) -> Vec<Option<StackedOn>> {
    unwrapped.charts.iter().map(|chart| chart.stacked).collect()
}

#[expect(clippy::unnecessary_wraps, reason = "compared with the optional place of a chart")]
const fn on(chart: usize, mirrored: bool) -> Option<StackedOn> {
    Some(StackedOn { chart, mirrored })
}

/// Corners of the chart's faces in the plane, as sorted bits. `faces` are the polygons of the chart.
fn polygons_in_plane(mesh: &PolygonMesh, unwrapped: &Unwrapped, faces: std::ops::Range<usize>) -> Vec<Vec<[u64; 2]>> {
    let uv = |place: usize| unwrapped.coordinates[VertexId::new(unwrapped.corners[place])].to_array().map(f64::to_bits);
    let polygon = |face: usize| {
        let mut corners: Vec<[u64; 2]> = mesh.corner_range(face).map(uv).collect();
        corners.sort_unstable();
        corners
    };
    let mut polygons: Vec<Vec<[u64; 2]>> = faces.map(polygon).collect();
    polygons.sort_unstable();
    polygons
}

/// Asserts that each chart of `stack` covers the same polygons as the first, bit for bit.
fn assert_equal_places(parts: &[PolygonMesh], unwrapped: &Unwrapped) {
    let mesh = joined(parts);
    let mut first = 0;
    let mut places = parts.iter().map(|part| {
        first += part.face_count();
        polygons_in_plane(&mesh, unwrapped, first - part.face_count()..first)
    });
    let of_first = places.next().expect("a part");
    assert!(places.all(|place| place == of_first));
}

#[test]
fn open_boxes_share_one_place_and_are_proved() {
    let open = without_faces(&cube(), |face| face == 1);
    let random = &mut Random(7);
    let parts: Vec<PolygonMesh> = (0..6).map(|_| elsewhere(&open, 1.0, random)).collect();
    let unwrapped = unwrapped(&parts, Stacking::Congruent);
    assert!(unwrapped.verdict.planar && unwrapped.verdict.planar_in_f32);
    assert_eq!(unwrapped.verdict.stacks, 1);
    assert_eq!(stacked_on(&unwrapped), [&[None][..], &[on(0, false); 5]].concat());
    assert_equal_places(&parts, &unwrapped);
    let densities: Vec<f64> = unwrapped.charts.iter().map(|chart| chart.density).collect();
    assert!(densities.iter().all(|density| (density / densities[0] - 1.0).abs() < 1e-9), "{densities:?}");
}

#[test]
fn a_stack_takes_the_room_of_one_chart() {
    let random = &mut Random(8);
    let parts: Vec<PolygonMesh> = (0..5).map(|_| elsewhere(&chiral_sheet(), 1.0, random)).collect();
    let alone = unwrapped(&[parts[0].clone(), elsewhere(&(&fan(7)).into(), 0.5, random)], Stacking::None);
    let with_fan = [&parts[..], &[elsewhere(&(&fan(7)).into(), 0.5, random)]].concat();
    let [apart, stacked] = [Stacking::None, Stacking::Congruent].map(|stack| unwrapped(&with_fan, stack));
    assert!(stacked.charts[0].density > 1.5 * apart.charts[0].density);
    assert!((stacked.charts[0].density / alone.charts[0].density - 1.0).abs() < 0.05);
    assert!(apart.verdict.stacks == 0 && stacked_on(&apart).iter().all(Option::is_none));
}

#[test]
fn mirror_images_share_a_place_only_if_that_is_asked_for() {
    let random = &mut Random(9);
    let copy = elsewhere(&chiral_sheet(), 1.0, random);
    let parts = [chiral_sheet(), mirror_image(&elsewhere(&chiral_sheet(), 1.0, random)), copy];
    let congruent = unwrapped(&parts, Stacking::Congruent);
    assert_eq!(stacked_on(&congruent), [None, None, on(0, false)]);
    let mirrored = unwrapped(&parts, Stacking::Mirrored);
    assert_eq!(stacked_on(&mirrored), [None, on(0, true), on(0, false)]);
    assert!(mirrored.verdict.planar && mirrored.verdict.stacks == 1);
    let turned: Vec<bool> = mirrored.verdict.charts.iter().map(|chart| chart.mirrored).collect();
    assert_eq!(turned, [false, true, false]);
    assert_equal_places(&parts, &mirrored);
    let energies = mirrored.charts.iter().map(|chart| chart.distortion.symmetric_dirichlet.mean);
    assert!(energies.clone().all(|energy| energy < 5.0), "{:?}", energies.collect::<Vec<_>>());
}

#[test]
fn symmetric_charts_are_stacked_without_a_mirror() {
    let random = &mut Random(10);
    let parts: Vec<PolygonMesh> = (0..4).map(|_| elsewhere(&(&fan(9)).into(), 1.0, random)).collect();
    let unwrapped = unwrapped(&parts, Stacking::Mirrored);
    assert_eq!(stacked_on(&unwrapped), [None, on(0, false), on(0, false), on(0, false)]);
}

#[test]
fn near_copies_beyond_the_tolerance_keep_their_own_places() {
    let random = &mut Random(11);
    let scaled = |scale: f64, random: &mut Random| elsewhere(&chiral_sheet(), scale, random);
    let mut bent = chiral_sheet();
    bent.positions[6].z += 0.02;
    let same_area = elsewhere(&(&shaped(4, 3, |x, y| DVec3::new(1.01 * x, y / 1.01, 0.0))).into(), 1.0, random);
    let flat = elsewhere(&(&shaped(4, 3, |x, y| DVec3::new(x, y, 0.0))).into(), 1.0, random);
    let parts = [
        chiral_sheet(),
        scaled(1.0 + 1e-6, random),
        scaled(1.001, random),
        elsewhere(&bent, 1.0, random),
        flat,
        same_area,
    ];
    let stacks = stacked_on(&unwrapped(&parts, Stacking::Mirrored));
    assert_eq!(stacks, [None, on(0, false), None, None, None, None]);
}

#[test]
fn polygons_cut_differently_into_triangles_still_match() {
    // First corners differ, and with them the diagonals of squares.
    let sheet = quad_sheet(4, 3, 0.1, &mut Random(2));
    let parts: Vec<PolygonMesh> = (0..4).map(|k| elsewhere(&sheet, 1.0, &mut Random(k))).collect();
    let unwrapped = unwrapped(&parts, Stacking::Congruent);
    assert_eq!(unwrapped.verdict.stacks, 1);
    assert_eq!(stacked_on(&unwrapped).iter().flatten().count(), 3);
    assert_equal_places(&parts, &unwrapped);
}

#[test]
fn charts_with_pins_or_another_size_are_not_stacked() {
    let random = &mut Random(12);
    let parts: Vec<PolygonMesh> = (0..4).map(|_| elsewhere(&chiral_sheet(), 1.0, random)).collect();
    let mesh = joined(&parts);
    let first = mesh.face(0)[0];
    let mut options = options(Stacking::Congruent);
    options.targets = [(first, Target::hard(DVec2::ZERO))].into();
    let sized = freebound_core::mesh::FaceId::from_index(3 * parts[0].face_count());
    options.sizes = [(sized, 2.0)].into();
    let unwrapped = unwrap(&mesh, &options).expect("planar");
    assert_eq!(stacked_on(&unwrapped), [None, None, on(1, false), None]);
    assert!(unwrapped.verdict.planar);
}

#[test]
fn rings_share_a_place_with_their_holes() {
    let ring = without_faces(&quad_sheet(5, 5, 0.0, &mut Random(3)), |face| face == 12);
    let parts: Vec<PolygonMesh> = (0..3).map(|k| elsewhere(&ring, 1.0, &mut Random(20 + k))).collect();
    let unwrapped = unwrapped(&parts, Stacking::Congruent);
    assert_eq!(stacked_on(&unwrapped), [None, on(0, false), on(0, false)]);
    assert!(unwrapped.verdict.planar && unwrapped.verdict.charts.iter().all(|chart| chart.boundary_loops == 2));
    assert_equal_places(&parts, &unwrapped);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 8, ..ProptestConfig::default() })]

    #[test]
    fn copies_of_random_sheets_are_found_among_others(seed in any::<u64>(), kinds in 1_u64..5, copies in 1_usize..4) {
        let random = &mut Random(seed);
        let sheets: Vec<PolygonMesh> = (0..kinds).map(|k| quad_sheet(3, 2, 0.2, &mut Random::of_run(seed, k))).collect();
        let parts: Vec<PolygonMesh> = (0..copies)
            .flat_map(|_| sheets.iter().collect::<Vec<_>>())
            .map(|sheet| elsewhere(sheet, 1.0, random))
            .collect();
        if parts.len() > 1 {
            let unwrapped = unwrapped(&parts, Stacking::Congruent);
            let expected: Vec<Option<StackedOn>> =
                (0..parts.len()).map(|k| on(k % sheets.len(), false).filter(|_| k >= sheets.len())).collect();
            prop_assert_eq!(stacked_on(&unwrapped), expected);
            prop_assert!(unwrapped.verdict.planar);
        }
    }
}

/// Verdict and places of charts that are laid out with chart 1 on chart 0 by choice, without stacking by shape.
fn laid_out_by_choice(parts: &[PolygonMesh]) -> (AtlasVerdict, Vec<Option<StackedOn>>) {
    let prepared = PreparedMesh::new(&joined(parts), None, Preparation { cut: true, ..Preparation::default() });
    let charts: Vec<PreparedMesh> = (0..parts.len()).map(|chart| prepared.of_chart(chart)).collect();
    let solved = |chart: &PreparedMesh| {
        let problem = Problem::new(&Settings::default(), PictureFrame::default(), false, Targets::new());
        problem.solve_on(chart.disk().expect("a disk"), None, Control::unattended()).expect("solved").outcome
    };
    let outcomes: Vec<Outcome> = charts.iter().map(solved).collect();
    let of = |(chart, outcome)| SolvedChart::new(chart, outcome);
    let mut solved: Vec<SolvedChart<'_>> = charts.iter().zip(&outcomes).map(of).collect();
    solved[1].stacked_on = Some(0);
    let laid = atlas(&solved, PackingOptions::default(), Arrangement::AsGiven);
    for (chart, on) in laid.summaries.iter().enumerate().filter_map(|(chart, laid)| Some((chart, laid.stacked?))) {
        let places = [chart, on.chart].map(|chart| {
            let mut places: Vec<_> =
                laid.charts[chart].coordinates.iter().map(|uv| uv.to_array().map(f64::to_bits)).collect();
            places.sort_unstable();
            places
        });
        assert_eq!(places[0], places[1], "bit for bit");
    }
    (laid.verdict, laid.summaries.iter().map(|chart| chart.stacked).collect())
}

#[test]
fn a_chart_shares_the_place_of_a_chosen_chart_with_a_congruent_or_a_mirrored_surface() {
    let random = &mut Random(5);
    let sheet = chiral_sheet();
    let parts = [sheet.clone(), elsewhere(&mirror_image(&sheet), 1.0, random), elsewhere(&sheet, 1.0, random)];
    let (verdict, places) = laid_out_by_choice(&parts);
    assert!(verdict.planar, "{}", verdict.summary());
    assert_eq!(places, [None, on(0, true), None], "the third is congruent, but was not chosen");
    let (verdict, places) = laid_out_by_choice(&[parts[0].clone(), parts[2].clone()]);
    assert!(verdict.planar, "{}", verdict.summary());
    assert_eq!(places, [None, on(0, false)]);
}

#[test]
fn a_chart_with_another_surface_keeps_a_place_of_its_own_even_if_a_place_was_chosen() {
    let (verdict, places) = laid_out_by_choice(&[chiral_sheet(), quad_sheet(3, 2, 0.0, &mut Random(1))]);
    assert!(verdict.planar, "{}", verdict.summary());
    assert_eq!(places, [None, None]);
}
