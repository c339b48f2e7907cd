//! Automatic seams: short cuts whose maps keep the distortion below a bound.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use freebound_core::cutting::SeamOptions;
use freebound_core::mesh::{HoleTreatment, PolygonMesh, Preparation, Seams, TriMesh, VertexId};
use freebound_core::pipeline::{AutomaticSeams, MeshToCut, PreparedMesh, SeamProgress};
use freebound_core::problem::{Control, Embedding, SolveError};
use freebound_core::verify::{distortion, verdict};
use freebound_core::{PipelineOptions, UnwrapError, unwrap};
use freebound_testkit::cubes::cube;
use freebound_testkit::many_parts::{ball, interleaved, torus};
use freebound_testkit::solids::{cone, frustum, open_tube, plate_with_holes, prism, regular_polygon};
use freebound_testkit::surfaces::without_faces;
use freebound_testkit::{Random, bumpy_ball, fan, grid, shaped, tetrahedron};
use glam::{DVec2, DVec3};

fn polygons(mesh: &TriMesh) -> PolygonMesh {
    let positions: Vec<[f64; 3]> = mesh.positions.iter().map(DVec3::to_array).collect();
    let faces: Vec<[u32; 3]> = mesh.triangles.iter().map(|face| face.map(VertexId::number)).collect();
    PolygonMesh::from_arrays(&positions, &faces.iter().map(<[u32; 3]>::as_slice).collect::<Vec<_>>())
}

/// Mesh without texture coordinates, to be cut.
fn to_cut<'a>(mesh: &'a PolygonMesh, form: &'a Preparation) -> MeshToCut<'a> {
    MeshToCut { mesh, labels: None, form }
}

fn form() -> Preparation {
    Preparation::default().with_all_repairs()
}

fn seams_of(mesh: &PolygonMesh, bound: f64) -> AutomaticSeams {
    AutomaticSeams::find(to_cut(mesh, &form()), SeamOptions::new(bound), Control::unattended(), &|_| {})
        .expect("not cancelled")
}

/// Chart of a mesh along its seams, with the map that was found with them: its mean energy and number of seam edges.
fn energy_along(mesh: &PolygonMesh, seams: &AutomaticSeams) -> f64 {
    let prepared = PreparedMesh::new(mesh, None, seams.form.clone());
    let disk = prepared.disk().expect("one disk");
    let map: Embedding = prepared.map_of_corners(mesh, &seams.corners).expect("every corner has one position");
    assert!(verdict(disk, &map).planar, "{:?}", verdict(disk, &map));
    distortion(disk, &map).summary.symmetric_dirichlet.mean
}

#[test]
fn a_cube_gets_the_seven_seams_of_an_exact_net() {
    let seams = seams_of(&cube(), 4.1);
    assert_eq!(seams.edges().len(), 7);
    assert!((energy_along(&cube(), &seams) - 4.0).abs() < 1e-6);
}

#[test]
fn the_smallest_closed_surface_is_opened_to_a_disk() {
    let mesh = polygons(&tetrahedron());
    let seams = seams_of(&mesh, 4.1);
    // Without a seam to one corner of the four, the corner stays curved.
    assert_eq!(seams.edges().len(), 3);
    assert!((energy_along(&mesh, &seams) - 4.0).abs() < 1e-6);
}

#[test]
fn a_smaller_bound_gets_longer_seams_and_every_bound_is_met() {
    let mesh = bumpy_ball();
    let mut before = 0.0;
    for bound in [5.0, 4.4, 4.2, 4.1] {
        let seams = seams_of(&mesh, bound);
        let energy = energy_along(&mesh, &seams);
        assert!(energy <= bound, "{energy} for {bound}");
        assert!(seams.length > before, "{} after {before}", seams.length);
        before = seams.length;
    }
}

#[test]
fn seams_of_a_ball_are_a_tree_and_those_of_a_torus_have_two_loops() {
    for (mesh, loops) in [(ball(24, 12), 0), (torus(16, 32), 2)] {
        let seams = seams_of(&polygons(&mesh), 4.1);
        let vertices: BTreeSet<VertexId> = seams.edges().iter().flatten().copied().collect();
        // Edges − vertices + components: the independent loops of a graph.
        assert_eq!(seams.edges().len() + components(seams.edges()), vertices.len() + loops);
        assert_eq!(components(seams.edges()), 1);
        assert!(energy_along(&polygons(&mesh), &seams) <= 4.1);
    }
}

/// Number of connected components of a graph without isolated vertices.
fn components(edges: &BTreeSet<[VertexId; 2]>) -> usize {
    let mut neighbours: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
    for &[a, b] in edges {
        neighbours.entry(a).or_default().push(b);
        neighbours.entry(b).or_default().push(a);
    }
    let mut left: BTreeSet<VertexId> = neighbours.keys().copied().collect();
    let mut count = 0;
    while let Some(first) = left.pop_first() {
        count += 1;
        let mut stack = vec![first];
        while let Some(vertex) = stack.pop() {
            stack.extend(neighbours[&vertex].iter().filter(|other| left.remove(other)));
        }
    }
    count
}

#[test]
fn a_surface_that_is_nearly_flat_is_not_cut() {
    let sheet = shaped(12, 12, |x, y| DVec3::new(x, y, 0.05 * (3.0 * x).sin()));
    let seams = seams_of(&polygons(&sheet), 4.1);
    assert!(seams.edges().is_empty() && seams.corners.iter().all(Option::is_some));
}

#[test]
fn a_disk_that_needs_no_cut_has_the_map_of_the_search() {
    let mesh = polygons(&shaped(12, 9, |x, y| DVec3::new(x, y, 0.1 * (5.0 * x).sin())));
    let prepared = PreparedMesh::new(&mesh, None, form());
    let options = SeamOptions::new(4.1);
    let news = Mutex::new(Vec::new());
    let report = |progress| news.lock().unwrap().push(progress);
    let uncut = AutomaticSeams::of_uncut(&prepared, &mesh, options, Control::unattended(), &report);
    let uncut = uncut.unwrap().expect("flat enough");
    let found = seams_of(&mesh, 4.1);
    assert_eq!((&uncut.form, &uncut.corners), (&found.form, &found.corners));
    assert!(uncut.edges().is_empty() && energy_along(&mesh, &uncut) < 4.1);
    let [SeamProgress { is_final: true, part_count: 1, energy, .. }] = news.into_inner().unwrap()[..] else {
        panic!("one report")
    };
    assert!(energy < 4.1);
}

#[test]
fn a_surface_above_the_bound_has_no_map_without_a_cut() {
    for mesh in [ball_with_hole(20, 12), cube()] {
        let prepared = PreparedMesh::new(&mesh, None, form());
        let quiet = |_| panic!("nothing is found");
        let uncut = AutomaticSeams::of_uncut(&prepared, &mesh, SeamOptions::new(4.1), Control::unattended(), &quiet);
        assert!(uncut.unwrap().is_none());
    }
}

#[test]
fn a_tube_is_opened_from_end_to_end() {
    let turn = |x: f64| (std::f64::consts::TAU * x).sin_cos();
    // The last column of vertices coincides with the first.
    let tube = shaped(24, 6, |x, y| DVec3::new(turn(x / 24.0).1, turn(x / 24.0).0, 0.5 * y));
    let mesh = polygons(&tube);
    let welded: Vec<VertexId> = (0..mesh.positions.len())
        .map(|v| VertexId::from_index((0..=v).find(|&w| mesh.positions[w].distance(mesh.positions[v]) < 1e-9).unwrap()))
        .collect();
    let corners = mesh.corners.iter().map(|v| welded[v.index()]).collect();
    let mesh = PolygonMesh { corners, ..mesh };
    let seams = seams_of(&mesh, 4.1);
    assert_eq!(seams.edges().len(), 6, "{:?}", seams.edges());
    assert!((energy_along(&mesh, &seams) - 4.0).abs() < 1e-6);
}

/// A ball without the faces around its south pole.
fn ball_with_hole(around: u32, rows: u32) -> PolygonMesh {
    let mesh = polygons(&ball(around, rows));
    let south = VertexId::new((rows - 1) * around);
    let is_open = |face: usize| mesh.face(face).contains(&south);
    freebound_testkit::surfaces::without_faces(&mesh, is_open)
}

#[test]
fn a_cut_reaches_a_long_boundary() {
    let mesh = ball_with_hole(24, 12);
    let seams = seams_of(&mesh, 4.3);
    assert!(energy_along(&mesh, &seams) <= 4.3);
    // The first ring of vertices.
    assert!(seams.edges().iter().flatten().any(|vertex| vertex.number() < 24));
}

#[test]
fn a_surface_with_a_small_hole_alone_is_opened_like_a_closed_one() {
    let mesh = ball_with_hole(24, 60);
    let seams = seams_of(&mesh, 4.3);
    assert!(!seams.edges().is_empty() && energy_along(&mesh, &seams) <= 4.3);
}

#[test]
fn holes_that_are_to_be_cut_are_reached_however_small_they_are() {
    let mesh = ball_with_hole(24, 60);
    let form = Preparation { holes: HoleTreatment::Cut, ..form() };
    let options = SeamOptions::new(4.3);
    let seams =
        AutomaticSeams::find(to_cut(&mesh, &form), options, Control::unattended(), &|_| {}).expect("not cancelled");
    assert!(seams.edges().iter().flatten().any(|vertex| vertex.number() < 24));
}

#[test]
fn a_disk_of_high_distortion_gets_seams_too() {
    let mesh = ball_with_hole(24, 12);
    let bound = Some(4.2);
    let unwrapped = unwrap(&mesh, &PipelineOptions { distortion: bound, ..PipelineOptions::for_any_mesh() });
    let unwrapped = unwrapped.map_err(|error| error.to_string()).expect("planar");
    assert!(unwrapped.charts[0].distortion.symmetric_dirichlet.mean <= 4.2);
    let whole = unwrap(&mesh, &PipelineOptions { distortion: None, ..PipelineOptions::for_any_mesh() });
    let whole = whole.map_err(|error| error.to_string()).expect("planar");
    assert!(whole.charts[0].distortion.symmetric_dirichlet.mean > 4.2);
}

#[test]
fn seams_by_hand_are_kept_and_completed() {
    let mesh = polygons(&ball(16, 8));
    let by_hand =
        [[VertexId::from_index(0), VertexId::from_index(1)], [VertexId::from_index(1), VertexId::from_index(2)]];
    let form = Preparation { seams: form().seams.with(by_hand), ..form() };
    let seams = AutomaticSeams::find(to_cut(&mesh, &form), SeamOptions::new(4.2), Control::unattended(), &|_| {})
        .expect("not cancelled");
    assert!(by_hand.iter().all(|edge| !seams.edges().contains(edge)), "they are cut already");
    let prepared = PreparedMesh::new(&mesh, None, seams.form.clone());
    assert!(prepared.disk().is_some());
    assert!(by_hand.iter().all(|edge| prepared.form.seams.edges().contains(edge)));
}

/// Seams of a mesh with costs of its edges.
fn seams_with_costs(mesh: &PolygonMesh, costs: impl IntoIterator<Item = ([VertexId; 2], f64)>) -> AutomaticSeams {
    let form = Preparation { seams: form().seams.with_costs(costs), ..form() };
    let found = AutomaticSeams::find(to_cut(mesh, &form), SeamOptions::new(4.2), Control::unattended(), &|_| {});
    found.expect("not cancelled")
}

#[test]
fn seams_avoid_costly_edges_and_follow_cheap_ones() {
    let mesh = bumpy_ball();
    let plain = seams_of(&mesh, 4.2);
    let avoided: BTreeSet<[VertexId; 2]> = plain.edges().iter().copied().take(plain.edges().len() / 2).collect();
    let others = seams_with_costs(&mesh, avoided.iter().map(|&edge| (edge, Seams::AVOIDED)));
    assert!(others.edges().is_disjoint(&avoided));
    assert!(energy_along(&mesh, &others) <= 4.2);
    let ring: BTreeSet<[VertexId; 2]> = others.edges().difference(plain.edges()).copied().collect();
    let led = seams_with_costs(&mesh, ring.iter().map(|&edge| (edge, 0.01)));
    let share = |seams: &AutomaticSeams| seams.edges().intersection(&ring).count();
    assert!(share(&led) > ring.len() / 2, "{} of {}", share(&led), ring.len());
}

/// Walls over a counter-clockwise polygon, without a bottom and a top.
fn walls(base: &[DVec2], height: f64) -> PolygonMesh {
    let solid = prism(base, height);
    without_faces(&solid, |face| solid.face(face).len() == base.len())
}

#[test]
fn seams_run_through_a_notch_if_it_counts_that_they_show() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.2, 2.0], [1.0, 1.5], [0.8, 2.0], [0.0, 2.0]].map(DVec2::from);
    let notch = corners[4];
    let is_in_notch_with = |visibility: f64, first: usize| {
        let mut base = corners;
        base.rotate_left(first);
        let mesh = walls(&base, 4.0);
        let options = SeamOptions { visibility, ..SeamOptions::new(4.1) };
        let seams = AutomaticSeams::find(to_cut(&mesh, &form()), options, Control::unattended(), &|_| {}).unwrap();
        let ends = seams.edges().iter().flatten().map(|v| mesh.positions[v.index()]);
        ends.into_iter().all(|end| end.truncate() == notch)
    };
    // By length alone, all edges from end to end are as good.
    assert!((0..corners.len()).any(|first| !is_in_notch_with(0.0, first)));
    assert!((0..corners.len()).all(|first| is_in_notch_with(1.0, first)));
}

#[test]
fn parts_that_are_equal_get_equal_seams_wherever_other_parts_stand() {
    // Two equal bodies, the second in the corner of a room.
    let body = bumpy_ball();
    let count = u32::try_from(body.positions.len()).unwrap();
    let wall = [[-2.0, -2.0, -2.0], [2.0, -2.0, -2.0], [2.0, 2.0, -2.0], [-2.0, 2.0, -2.0]];
    let room = [[-2.0, -2.0, 2.0], [2.0, -2.0, 2.0]];
    let positions: Vec<[f64; 3]> = body
        .positions
        .iter()
        .map(|at| *at + 64.0 * DVec3::X)
        .chain(body.positions.iter().copied())
        .map(|at| at.to_array())
        .chain(wall.into_iter().chain(room))
        .collect();
    let faces_of = |from: u32| (0..body.face_count()).map(move |face| (face, from));
    let mut faces: Vec<Vec<u32>> = faces_of(0)
        .chain(faces_of(count))
        .map(|(face, from)| body.face(face).iter().map(|vertex| vertex.number() + from).collect())
        .collect();
    faces.push([0, 1, 2, 3].map(|v| 2 * count + v).to_vec());
    faces.push([1, 0, 4, 5].map(|v| 2 * count + v).to_vec());
    let mesh = PolygonMesh::from_arrays(&positions, &faces);
    let seams = seams_of(&mesh, 4.1);
    let of_body = |from: u32| -> BTreeSet<[u32; 2]> {
        let edges = seams.edges().iter().map(|edge| edge.map(VertexId::number));
        edges.filter(|[a, _]| (from..from + count).contains(a)).map(|edge| edge.map(|v| v - from)).collect()
    };
    assert!(!of_body(0).is_empty());
    assert_eq!(of_body(0), of_body(count));
}

/// Solid with the length of the shortest cut that develops it, found by hand.
fn developable_solids() -> Vec<(&'static str, PolygonMesh, f64)> {
    let circle = regular_polygon(24, 1.0);
    let side = circle[0].distance(circle[1]);
    let small = regular_polygon(24, 0.5);
    let rise = (1.5_f64.powi(2) + 0.5_f64.powi(2)).sqrt();
    let steps = [(0, 0), (3, 0), (3, 1), (2, 1), (2, 2), (1, 2), (1, 3), (0, 3)];
    let steps: Vec<DVec2> = steps.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
    vec![
        ("cube", cube(), 7.0),
        // Each cap hangs on by one edge.
        ("cylinder", prism(&circle, 3.0), 2.0 * 23.0 * side + 3.0),
        ("cone", cone(&circle, 2.0), 23.0 * side + 5.0_f64.sqrt()),
        ("frustum", frustum(&circle, &small, 1.5), 23.0 * 1.5 * side + rise),
        // Each end hangs on by its longest edge.
        ("stairs", prism(&steps, 2.0), 2.0 * 9.0 + 2.0),
    ]
}

#[test]
fn boxes_cylinders_and_cones_are_developed_exactly_along_the_shortest_cut() {
    for (name, solid, shortest) in developable_solids() {
        let seams = seams_of(&solid, 4.1);
        assert!(energy_along(&solid, &seams) - 4.0 <= 1e-6, "{name}: {}", energy_along(&solid, &seams));
        assert!(seams.length <= 1.1 * shortest, "{name}: {} for {shortest}", seams.length);
    }
}

#[test]
fn a_long_tube_with_one_end_open_is_opened_along_its_length_too() {
    // The open end is short enough to count as a hole that is filled.
    for (sides, height) in [(16, 80.0), (8, 100.0), (12, 300.0)] {
        let circle = regular_polygon(sides, 1.0);
        let tube = open_tube(&circle, height);
        let seams = seams_of(&tube, 4.1);
        let energy = energy_along(&tube, &seams);
        let around = sides as f64 * circle[0].distance(circle[1]);
        assert!(energy <= 4.1, "{sides} sides: {energy}");
        assert!(seams.length <= height + around, "{sides} sides: {} for {height}", seams.length);
    }
}

/// Torus with the given radius of its tube, around a circle of radius 1.
fn slender_torus(tube: f64) -> PolygonMesh {
    let mut mesh = torus(16, 120);
    for position in &mut mesh.positions {
        let from_axis = position.truncate().length();
        let to_tube = DVec2::new(from_axis - 3.0, position.z) * tube;
        *position = ((1.0 + to_tube.x) / from_axis * position.truncate()).extend(to_tube.y);
    }
    polygons(&mesh)
}

#[test]
fn a_slender_torus_is_cut_along_two_circles() {
    for tube in [0.1, 0.15] {
        let mesh = slender_torus(tube);
        let seams = seams_of(&mesh, 4.1);
        assert!(energy_along(&mesh, &seams) <= 4.1);
        // Around the tube, and along the inner side.
        let shortest = std::f64::consts::TAU * (tube + 1.0 - tube);
        assert!(seams.length <= 1.1 * shortest, "{tube}: {} for {shortest}", seams.length);
    }
}

#[test]
fn a_plate_with_three_holes_is_developed_exactly() {
    let thickness = 0.4;
    let plate = plate_with_holes(3, thickness);
    let seams = seams_of(&plate, 4.1);
    let energy = energy_along(&plate, &seams);
    assert!(energy - 4.0 <= 1e-6, "{energy}");
    // By hand: the upper face hangs on by one long side, the others by the lower face. The sides of each hole hang on by
    // the lower face too. Each hole is connected with the outer side above, and with the next one below.
    let outer = 4.0 * thickness + 7.0 + 3.0 + 3.0;
    let holes = 3.0 * (4.0 + 4.0 * thickness);
    let between = 3.0 + (2.0 + 1.0 + 1.0);
    let by_hand = outer + holes + between;
    assert!(seams.length <= 1.1 * by_hand, "{} for {by_hand}", seams.length);
}

#[test]
fn a_cost_of_one_is_no_cost_and_the_others_are_clamped() {
    let edge = [VertexId::new(3), VertexId::new(1)];
    let seams = Seams::default().with_costs([(edge, 2.0)]);
    assert_eq!(
        seams.costs().iter().map(|(edge, cost)| (*edge, *cost)).collect::<Vec<_>>(),
        [([edge[1], edge[0]], 2.0)]
    );
    assert!(seams.with_costs([(edge, 1.0)]).is_default());
    assert!(seams.with_costs([(edge, f64::NAN)]).is_default());
    assert_eq!(seams.with_costs([(edge, 0.0)]).costs().values().next(), Some(Seams::COSTS.start()));
}

#[test]
fn the_map_along_known_seams_is_the_map_of_their_search() {
    let mesh = bumpy_ball();
    let found = seams_of(&mesh, 4.2);
    let again = AutomaticSeams::along(to_cut(&mesh, &found.form), SeamOptions::new(4.2), Control::unattended());
    let again = again.expect("not cancelled");
    assert_eq!((&again.form, &again.corners), (&found.form, &found.corners));
    assert!((again.length - found.length).abs() <= 1e-12 * found.length);
}

#[test]
fn every_better_cut_is_reported_and_the_last_report_is_the_result() {
    let mesh = bumpy_ball();
    let reports = Mutex::new(Vec::new());
    let keep = |news: SeamProgress| reports.lock().expect("no panic").push(news);
    let found = AutomaticSeams::find(to_cut(&mesh, &form()), SeamOptions::new(4.1), Control::unattended(), &keep);
    let found = found.expect("not cancelled");
    let reports = reports.into_inner().expect("no panic");
    let (last, before) = reports.split_last().expect("reports");
    assert!(last.is_final && !before.is_empty() && before.iter().all(|news| !news.is_final));
    assert!(reports.iter().all(|news| (news.part, news.part_count) == (0, 1)));
    assert_eq!(last.edges.iter().copied().collect::<BTreeSet<_>>(), *found.edges());
    assert!((last.energy - energy_along(&mesh, &found)).abs() < 1e-9);
}

/// Bent sheet: an extruded profile of two legs and a chamfered corner, so that its caps are concave octagons.
fn bent_sheet() -> PolygonMesh {
    let outside = [[0.0, 0.0], [1.0, 0.0], [1.2, 0.2], [1.2, 1.2]];
    let inside = [[1.1, 1.2], [1.1, 0.2], [1.0, 0.1], [0.0, 0.1]];
    let profile: Vec<DVec2> = outside.into_iter().chain(inside).map(DVec2::from).collect();
    prism(&profile, 2.0)
}

#[test]
fn polygons_are_convex_in_the_map_of_a_search_and_its_energy_counts_that() {
    let mesh = bent_sheet();
    let reports = Mutex::new(Vec::new());
    let keep = |news: SeamProgress| reports.lock().expect("no panic").push(news.energy);
    // Along creases alone, the sheet would be developed exactly.
    let options = SeamOptions { visibility: 0.0, ..SeamOptions::new(4.1) };
    let found = AutomaticSeams::find(to_cut(&mesh, &form()), options, Control::unattended(), &keep);
    let found = found.expect("not cancelled");
    let energy = *reports.lock().expect("no panic").last().expect("reports");
    assert!(4.0 < energy && energy <= 4.1, "{energy}");
    assert!((energy - energy_along(&mesh, &found)).abs() < 1e-9);
    let options = PipelineOptions { seam_visibility: Some(0.0), ..PipelineOptions::for_any_mesh() };
    let unwrapped = unwrap(&mesh, &options).expect("planar");
    let last = unwrapped.charts[0].distortion.symmetric_dirichlet.mean;
    assert!((energy - last).abs() < 1e-9, "{energy} in the search, {last} at the end");
}

#[test]
fn the_bits_are_the_same_for_any_number_of_threads() {
    let mesh = bumpy_ball();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let seams = pool.install(|| seams_of(&mesh, 4.2));
        let bits = |at: &Option<DVec2>| at.map(|at| at.to_array().map(f64::to_bits));
        (seams.edges().clone(), seams.corners.iter().map(bits).collect::<Vec<_>>())
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn a_raised_flag_cancels_the_search() {
    let cancel = AtomicBool::new(true);
    let control = Control::new(&cancel, &|_| {});
    let found = AutomaticSeams::find(to_cut(&bumpy_ball(), &form()), SeamOptions::new(4.1), control, &|_| {});
    assert_eq!(found.err(), Some(SolveError::Cancelled));
}

#[test]
fn a_one_sided_part_does_not_keep_the_other_parts_from_their_seams() {
    let parts = [polygons(&freebound_testkit::band(12, 1)), bumpy_ball()];
    let both = interleaved(&parts, &mut Random(3));
    let (alone, beside) = (seams_of(&parts[1], 4.3), seams_of(&both, 4.3));
    assert!(!alone.edges().is_empty());
    assert!((beside.length - alone.length).abs() < 0.2 * alone.length, "{} and {}", beside.length, alone.length);
}

#[test]
fn a_one_sided_surface_falls_back_to_the_shortest_cut() {
    let band = polygons(&freebound_testkit::band(12, 1));
    let seams = seams_of(&band, 4.1);
    assert!(seams.edges().is_empty());
    match unwrap(&band, &PipelineOptions::for_any_mesh()) {
        Ok(unwrapped) => assert!(unwrapped.verdict.planar),
        Err(error) => panic!("a band is cut across: {error}"),
    }
}

#[test]
fn a_part_without_area_never_makes_a_run_fail() {
    // A square, and a triangle whose corners are on one line.
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [3.0, 0.0, 0.0],
        [3.5, 0.0, 0.0],
        [4.0, 0.0, 0.0],
    ];
    let faces: [&[u32]; 3] = [&[0, 1, 2], &[0, 2, 3], &[4, 5, 6]];
    let mesh = PolygonMesh::from_arrays(&positions, &faces);
    let unwrapped = unwrap(&mesh, &PipelineOptions::for_any_mesh());
    let unwrapped = unwrapped.map_err(|error: UnwrapError| error.to_string()).expect("planar");
    assert_eq!(unwrapped.charts.len(), 2);
    assert!(unwrapped.verdict.planar && unwrapped.verdict.planar_in_f32);
}

#[test]
fn parts_that_need_no_cut_keep_their_map_and_others_get_their_own_seams() {
    let (flat, round) = (grid(4, 4), ball(16, 8));
    let cone = fan(7);
    let meshes = [&flat, &round, &cone].map(polygons);
    let mesh = freebound_testkit::many_parts::interleaved(&meshes, &mut freebound_testkit::Random(5));
    let seams = seams_of(&mesh, 4.1);
    let unwrapped = unwrap(&mesh, &PipelineOptions::for_any_mesh()).expect("planar");
    assert_eq!(unwrapped.charts.len(), 3);
    assert!(!seams.edges().is_empty());
    assert!(unwrapped.charts.iter().all(|chart| chart.distortion.symmetric_dirichlet.mean <= 4.1 + 1e-9));
}

#[test]
fn a_torus_with_a_hole_anywhere_is_opened_to_one_disk() {
    let whole = polygons(&torus(12, 24));
    for centre in [0, 40, 150, 280] {
        let centre = VertexId::new(centre);
        let mesh = freebound_testkit::surfaces::without_faces(&whole, |face| whole.face(face).contains(&centre));
        for holes in [HoleTreatment::Fill, HoleTreatment::Cut] {
            let form = Preparation { holes, ..form() };
            let options = SeamOptions::new(4.2);
            let seams = AutomaticSeams::find(to_cut(&mesh, &form), options, Control::unattended(), &|_| {})
                .expect("not cancelled");
            assert!(seams.corners.iter().all(Option::is_some), "hole at {centre}, {holes:?}");
            let prepared = PreparedMesh::new(&mesh, None, seams.form.clone());
            let disk = prepared.disk().expect("one disk");
            let map = prepared.map_of_corners(&mesh, &seams.corners).expect("a map");
            assert!(distortion(disk, &map).summary.symmetric_dirichlet.mean <= 4.2);
        }
    }
}

/// Ramp between two radii that winds around the z-axis, with a small pitch: nearly flat, so that its development lies
/// over itself.
fn ramp(turns: f64, steps: u32) -> PolygonMesh {
    let at = |step: u32, radius: f64| {
        let angle = std::f64::consts::TAU * turns * f64::from(step) / f64::from(steps);
        [radius * angle.cos(), radius * angle.sin(), 0.02 * angle]
    };
    let positions: Vec<[f64; 3]> = (0..=steps).flat_map(|step| [at(step, 0.2), at(step, 1.5)]).collect();
    let faces: Vec<[u32; 3]> =
        (0..steps).map(|step| 2 * step).flat_map(|low| [[low, low + 1, low + 3], [low, low + 3, low + 2]]).collect();
    PolygonMesh::from_arrays(&positions, &faces.iter().map(<[u32; 3]>::as_slice).collect::<Vec<_>>())
}

#[test]
fn a_ramp_of_many_turns_is_cut_into_charts_that_do_not_overlap() {
    let mesh = ramp(3.5, 168);
    let seams = seams_of(&mesh, 4.1);
    let prepared = PreparedMesh::new(&mesh, None, seams.form.clone());
    // Each chart winds less than once.
    let count = prepared.chart_count();
    assert!((4..=7).contains(&count), "{count} charts, seams {}", seams.length);
    for chart in (0..count).map(|chart| prepared.of_chart(chart)) {
        let disk = chart.disk().expect("a disk");
        let map = chart.map_of_corners(&mesh, &seams.corners).expect("every corner has one position");
        assert!(verdict(disk, &map).planar);
        let energy = distortion(disk, &map).summary.symmetric_dirichlet.mean;
        assert!(energy <= 4.1, "{energy}");
    }
    // A straight cut across the ramp is 1.3 long.
    let length = 1.3 * (count - 1) as f64;
    assert!(seams.length <= 1.1 * length, "{} for {length}", seams.length);
}

#[test]
fn a_limit_on_the_number_of_charts_joins_those_of_a_divided_part() {
    let mesh = ramp(3.5, 168);
    let limited = |most: usize| {
        let options = SeamOptions { most_charts: Some(most), ..SeamOptions::new(4.1) };
        AutomaticSeams::find(to_cut(&mesh, &form()), options, Control::unattended(), &|_| {}).unwrap()
    };
    let free = seams_of(&mesh, 4.1);
    for most in [1, 3] {
        let seams = limited(most);
        let prepared = PreparedMesh::new(&mesh, None, seams.form.clone());
        assert_eq!(prepared.chart_count().max(1), most);
        assert!(seams.length < free.length && seams.edges().is_subset(free.edges()));
        let charts = (0..prepared.chart_count()).map(|chart| prepared.of_chart(chart));
        for chart in charts.chain((most == 1).then(|| prepared.clone())) {
            let disk = chart.disk().expect("a disk");
            let map = chart.map_of_corners(&mesh, &seams.corners).expect("every corner has one position");
            assert!(verdict(disk, &map).planar);
        }
    }
    assert_eq!(limited(100).edges(), free.edges());
}
