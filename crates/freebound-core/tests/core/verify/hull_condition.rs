//! Vertices outside the hull of their neighbours: the theorem of Gortler, Gotsman and Thurston and its converse.
//! Tested on random maps, on solutions with positive weights, and on perturbed ones.

use faer::Mat;
use faer::linalg::solvers::Solve as _;
use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::{Orientation, convex_hull, is_inside_hull, orientation};
use freebound_core::mesh::{DiskMesh, PolygonMesh, Preparation, VertexId};
use freebound_core::problem::{BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, hard_pins};
use freebound_core::verify::{CornerKind, holes_turn_once, hull_standing, verdict, vertices_outside_hull};
use glam::{DVec2, DVec3};

use super::verdict_cases::{Case, grid_case, nearly_planar_case};
use crate::linear::shapes::interior_pair;
use freebound_testkit::surfaces::{irregular_cube, without_faces};
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, data_disks, grid, quad_sheet};

/// True if a point is strictly inside a hull, i.e. to the left of every side.
fn is_inside_by_corners(point: DVec2, others: &[DVec2]) -> bool {
    let corners = convex_hull(others);
    let is_left = |k: usize| {
        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
        orientation(others[a], others[b], point) == Some(Orientation::CounterClockwise)
    };
    corners.len() > 2 && (0..corners.len()).all(is_left)
}

/// Properties that the theorem relates, for one embedding.
#[expect(clippy::struct_excessive_bools, reason = "independent answers about one embedding")]
struct Facts {
    outside: Vec<VertexId>,
    turns_once: bool,
    is_locally_planar: bool,
    has_simple_boundary: bool,
    is_one_to_one: bool,
}

fn facts(mesh: &DiskMesh, embedding: &Embedding) -> Facts {
    let verdict = verdict(mesh, embedding);
    let once = if verdict.mirrored { -1 } else { 1 };
    let is_on_surface =
        |v: &&VertexId| mesh.outgoing(**v).filter_map(|h| mesh.face_of(h)).all(|face| !mesh.is_virtual(face));
    Facts {
        outside: vertices_outside_hull(mesh, embedding, verdict.upright()),
        turns_once: verdict.turning_number == Some(once) && holes_turn_once(mesh, embedding, verdict.upright()),
        is_locally_planar: verdict.flipped_faces.is_empty()
            && verdict.overwound_vertices.iter().find(is_on_surface).is_none(),
        has_simple_boundary: verdict.boundary_crossings.is_empty() && verdict.crossed_holes.is_empty(),
        // The surface alone: the filling of holes may fold.
        is_one_to_one: verdict.flipped_faces.is_empty()
            && verdict.crossed_holes.is_empty()
            && verdict.boundary_crossings.is_empty(),
    }
}

/// Fails if an embedding contradicts the theorem or its converse.
fn assert_theorem(facts: &Facts, what: &dyn std::fmt::Debug) {
    let holds = facts.outside.is_empty() && facts.turns_once;
    assert!(!holds || facts.is_locally_planar, "the conditions hold, and yet it folds: {what:?}");
    assert!(!holds || !facts.has_simple_boundary || facts.is_one_to_one, "a simple boundary, not one-to-one: {what:?}");
    assert!(!facts.is_one_to_one || (facts.outside.is_empty() && facts.turns_once), "{:?}: {what:?}", facts.outside);
}

fn case_facts(case: &Case) -> Facts {
    facts(&case.mesh(), &case.embedding)
}

#[test]
fn a_point_is_inside_a_hull_where_it_is_left_of_all_its_sides_and_only_there() {
    let mut random = Random(31);
    let mut inside = 0;
    for round in 0..60_000 {
        let scale = [1.0, 0.1, 5e-324, 1e-200, 1e300][round % 5];
        let mut point = || DVec2::new(f64::from(random.below(5)), f64::from(random.below(5))) * scale;
        let others: Vec<DVec2> = (0..round % 9).map(|_| point()).collect();
        let point = point();
        let expected = is_inside_by_corners(point, &others);
        assert_eq!(is_inside_hull(point, &others), expected, "{point} in {others:?}");
        inside += usize::from(expected);
    }
    assert!((5_000..40_000).contains(&inside), "{inside} inside: the cases say little");
    assert!(!is_inside_hull(DVec2::ZERO, &[DVec2::X, DVec2::Y, DVec2::new(f64::NAN, -1.0)]));
    assert!(!is_inside_hull(DVec2::ZERO, &[]));
}

#[test]
fn the_theorem_and_its_converse_hold_on_random_maps() {
    let mut random = Random(32);
    let (mut one_to_one, mut folded_turning_once) = (0, 0);
    for round in 0..30_000 {
        let case = if round % 2 == 0 { grid_case(&mut random) } else { nearly_planar_case(&mut random) };
        let facts = case_facts(&case);
        assert_theorem(&facts, &case);
        one_to_one += usize::from(facts.is_one_to_one);
        folded_turning_once += usize::from(facts.turns_once && !facts.is_one_to_one);
    }
    assert!(one_to_one > 3_000 && folded_turning_once > 2_000, "{one_to_one}, {folded_turning_once}: too few to tell");
}

#[test]
fn an_ear_without_area_on_a_straight_side_has_its_vertex_outside() {
    let places = [[0.0, 0.0], [0.0, 6.0], [4.0, 0.0], [4.0, 6.0], [4.0, 4.0]].map(DVec2::from);
    let ear = Case { triangles: vec![[0, 2, 1], [1, 2, 3], [2, 4, 3]], embedding: places.to_vec().into() };
    let found = case_facts(&ear);
    assert!(found.turns_once && !found.is_locally_planar);
    assert_eq!(found.outside, [VertexId::new(4)]);
}

/// Band of squares that goes around more than once over the same positions.
fn coil(turns: f64) -> (DiskMesh, Embedding) {
    const LENGTH: u32 = 30;
    let mesh = DiskMesh::try_from(grid(LENGTH, 2)).unwrap();
    let place = |p: &DVec3| DVec2::from_angle(-turns * std::f64::consts::TAU * p.x / f64::from(LENGTH)) * (2.0 + p.y);
    let embedding = mesh.mesh().positions.iter().map(place).collect();
    (mesh, embedding)
}

#[test]
fn a_coil_meets_the_conditions_and_is_planar_locally_alone() {
    for (turns, is_one_to_one) in [(0.8, true), (1.6, false)] {
        let (mesh, embedding) = coil(turns);
        let facts = facts(&mesh, &embedding);
        assert_theorem(&facts, &turns);
        assert!(facts.outside.is_empty() && facts.turns_once && facts.is_locally_planar, "{turns} turns");
        assert_eq!(facts.is_one_to_one, is_one_to_one, "{turns} turns");
    }
}

/// Embedding with a given boundary whose inner vertices are weighted means of their neighbours.
fn positive_weight_solution(mesh: &DiskMesh, boundary: &[DVec2], random: &mut Random) -> Embedding {
    let inner: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect();
    let row = |v: VertexId| inner.binary_search(&v).ok();
    let mut matrix: Mat<f64> = Mat::zeros(inner.len(), inner.len());
    let mut rhs: Mat<f64> = Mat::zeros(inner.len(), 2);
    for (k, &v) in inner.iter().enumerate() {
        for h in mesh.outgoing(v) {
            let (weight, head) = (0.1 + random.unit(), mesh.head(h));
            matrix[(k, k)] += weight;
            match (row(head), mesh.boundary_place(head)) {
                (Some(other), _) => matrix[(k, other)] -= weight,
                (None, Some(place)) => [0, 1].into_iter().for_each(|i| rhs[(k, i)] += weight * boundary[place][i]),
                (None, None) => unreachable!("a vertex lies inside or on the boundary"),
            }
        }
    }
    let solved = matrix.partial_piv_lu().solve(&rhs);
    let place = |v: VertexId| match (row(v), mesh.boundary_place(v)) {
        (Some(k), _) => DVec2::new(solved[(k, 0)], solved[(k, 1)]),
        (None, place) => boundary[place.unwrap()],
    };
    mesh.vertices().map(place).collect()
}

/// Polygon around the origin, its corners in order, at distances from `radius`.
fn around_origin(count: usize, mut radius: impl FnMut() -> f64) -> Vec<DVec2> {
    let corner = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    (0..count).map(|k| DVec2::from_angle(corner(k)) * radius()).collect()
}

#[test]
fn solutions_with_positive_weights_fold_only_at_reflex_vertices_and_then_one_of_these_is_outside() {
    let mut random = Random(33);
    let mesh = DiskMesh::try_from(grid(5, 5)).unwrap();
    let count = mesh.boundary_loop().len();
    let (mut folded, mut planar_and_reflex) = (0, 0);
    for round in 0..200 {
        let roughness = f64::from(round % 10) * 0.2;
        let boundary = around_origin(count, || 1.0 + roughness * random.unit());
        let embedding = positive_weight_solution(&mesh, &boundary, &mut random);
        let facts = facts(&mesh, &embedding);
        assert_theorem(&facts, &round);
        assert!(facts.turns_once && facts.has_simple_boundary, "a star is simple");
        assert_eq!(facts.is_one_to_one, facts.outside.is_empty(), "{round}");
        for &vertex in &facts.outside {
            let standing = hull_standing(&mesh, &embedding, vertex, Orientation::CounterClockwise).unwrap();
            assert_eq!(standing.corner, CornerKind::Reflex, "{vertex}");
        }
        folded += usize::from(!facts.is_one_to_one);
        planar_and_reflex += usize::from(facts.is_one_to_one && roughness > 0.0);
    }
    assert!(folded > 50 && planar_and_reflex > 2, "{folded} folded, {planar_and_reflex} planar, not convex");
}

#[test]
fn a_vertex_that_leaves_the_ring_of_its_neighbours_is_outside_until_it_comes_back() {
    let mut random = Random(34);
    let mesh = DiskMesh::try_from(grid(6, 6)).unwrap();
    let boundary = around_origin(mesh.boundary_loop().len(), || 1.0);
    for _ in 0..100 {
        let mut embedding = positive_weight_solution(&mesh, &boundary, &mut random);
        assert_eq!(facts(&mesh, &embedding).outside, [], "Tutte's theorem");
        let vertex = VertexId::new(7 * (1 + random.below(5)) + 1 + random.below(5));
        let before = embedding[vertex];
        let reach = mesh.outgoing(vertex).map(|h| embedding[mesh.head(h)].distance(before)).fold(0.0, f64::max);
        embedding[vertex] += DVec2::from_angle(random.unit() * std::f64::consts::TAU) * 1.01 * reach;
        let moved = facts(&mesh, &embedding);
        assert_theorem(&moved, &vertex);
        assert!(moved.outside.contains(&vertex), "{vertex} is not in {:?}", moved.outside);
        embedding[vertex] = before;
        assert_eq!(facts(&mesh, &embedding).outside, []);
    }
}

#[test]
fn a_mirror_image_has_the_same_vertices_outside() {
    let mut random = Random(35);
    let mut outside = 0;
    for _ in 0..2_000 {
        let case = nearly_planar_case(&mut random);
        let mirrored: Embedding = case.embedding.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
        let mesh = case.mesh();
        let here = vertices_outside_hull(&mesh, &case.embedding, Orientation::CounterClockwise);
        assert_eq!(here, vertices_outside_hull(&mesh, &mirrored, Orientation::Clockwise), "{case:?}");
        outside += usize::from(!here.is_empty());
    }
    assert!(outside > 500, "{outside}");
}

#[test]
fn a_vertex_where_the_boundary_goes_straight_on_or_that_is_nowhere_is_told_from_a_reflex_one() {
    let mesh = DiskMesh::try_from(grid(2, 2)).unwrap();
    let mut embedding: Embedding = mesh.mesh().positions.iter().map(|p| p.truncate()).collect();
    let corner_of = |embedding: &Embedding, vertex: u32| {
        hull_standing(&mesh, embedding, VertexId::new(vertex), Orientation::CounterClockwise).unwrap().corner
    };
    assert_eq!(corner_of(&embedding, 4), CornerKind::Interior);
    assert_eq!(corner_of(&embedding, 0), CornerKind::Convex, "a corner");
    assert_eq!(corner_of(&embedding, 1), CornerKind::Straight, "straight on");
    embedding[1].y = 0.5;
    assert_eq!(corner_of(&embedding, 1), CornerKind::Reflex);
    assert_eq!(vertices_outside_hull(&mesh, &embedding, Orientation::CounterClockwise), []);
    embedding[1].y = f64::NAN;
    let nowhere = vertices_outside_hull(&mesh, &embedding, Orientation::CounterClockwise);
    assert!(nowhere.contains(&VertexId::new(1)) && nowhere.contains(&VertexId::new(4)), "{nowhere:?}");
}

#[test]
fn of_a_planar_surface_with_holes_no_vertex_is_outside_however_its_filling_lies() {
    let mut random = Random(36);
    let (mut planar, mut folded_filling) = (0, 0);
    for _ in 0..400 {
        let sheet = quad_sheet(6, 6, 0.0, &mut random);
        let hole = [14, 15, 20, 21];
        let mesh = without_faces(&sheet, |face| hole[..=(face % 4)].contains(&face));
        let disk = DiskMesh::try_from(Preparation::default().repaired(&mesh).triangulate()).unwrap();
        let disturb = f64::from(random.below(5)) * 0.25;
        let mut place = |p: &DVec3| p.truncate() + disturb * DVec2::new(random.unit(), random.unit());
        let mut embedding: Embedding = disk.mesh().positions.iter().map(&mut place).collect();
        // The filling of the hole may lie anywhere.
        for vertex in disk.virtual_vertices() {
            embedding[vertex] = DVec2::new(random.unit(), random.unit()) * 6.0;
        }
        let verdict = verdict(&disk, &embedding);
        let outside = vertices_outside_hull(&disk, &embedding, Orientation::CounterClockwise);
        assert!(outside.iter().all(|&vertex| !disk.is_virtual_vertex(vertex)));
        if verdict.flipped_faces.is_empty() && verdict.boundary_crossings.is_empty() && verdict.crossed_holes.is_empty()
        {
            assert_eq!(outside, []);
            planar += 1;
            folded_filling += usize::from(verdict.is_filling_folded);
        }
    }
    assert!(planar > 50, "{planar} planar, {folded_filling} with a folded filling");
}

/// Disk of a polygon mesh with filled holes.
fn filled(mesh: &PolygonMesh) -> DiskMesh {
    DiskMesh::try_from(Preparation::default().repaired(mesh).triangulate()).unwrap()
}

/// Triangles between a regular polygon of radius 3 and one of radius 1, whose vertices are numbered after the outer
/// ones.
pub(crate) fn ring(count: u32) -> DiskMesh {
    let corner = |k: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k % count) / f64::from(count));
    let positions = (0..2 * count).map(|k| (corner(k) * if k < count { 3.0 } else { 1.0 }).extend(0.0)).collect();
    let faces = (0..count).flat_map(|k| {
        let next = (k + 1) % count;
        [[k, next, count + k], [count + k, next, count + next]].concat()
    });
    let corners: Vec<VertexId> = faces.map(VertexId::new).collect();
    let starts = Some((0..=2 * count).map(|face| 3 * face).collect());
    let mesh = filled(&PolygonMesh { positions, corners, starts });
    assert_eq!((mesh.boundary_loop().len(), mesh.mesh().holes().len()), (count as usize, 1));
    mesh
}

/// View of a mesh from above.
fn from_above(mesh: &DiskMesh) -> Embedding {
    mesh.mesh().positions.iter().map(|p| p.truncate()).collect()
}

#[test]
fn a_ring_that_is_mirrored_within_folds_without_a_vertex_outside_for_its_hole_does_not_turn_once() {
    let mesh = ring(3);
    let mut embedding = from_above(&mesh);
    assert!(facts(&mesh, &embedding).is_one_to_one && facts(&mesh, &embedding).turns_once);
    (3..6).for_each(|k| embedding[k].y = -embedding[k].y);
    let verdict = verdict(&mesh, &embedding);
    assert_eq!((verdict.turning_number, verdict.flipped_faces.len()), (Some(1), 2));
    for vertex in (0..6).map(VertexId::new) {
        let standing = hull_standing(&mesh, &embedding, vertex, Orientation::CounterClockwise).unwrap();
        assert_eq!(standing.corner, CornerKind::Convex, "{vertex}");
    }
    assert_eq!(vertices_outside_hull(&mesh, &embedding, Orientation::CounterClockwise), []);
    assert!(!holes_turn_once(&mesh, &embedding, Orientation::CounterClockwise));
    let mirrored: Embedding = embedding.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
    assert!(!holes_turn_once(&mesh, &mirrored, Orientation::Clockwise));
}

/// Sheet without two squares that meet at a corner.
fn holes_about_a_vertex() -> DiskMesh {
    let mut random = Random(38);
    let sheet = quad_sheet(4, 4, 0.0, &mut random);
    filled(&without_faces(&sheet, |face| [5, 10].contains(&face)))
}

#[test]
fn the_theorem_and_its_converse_hold_with_holes_whose_loops_all_turn_once() {
    let mut random = Random(37);
    let meshes = [ring(3), ring(4), ring(5), holes_about_a_vertex()];
    let (mut one_to_one, mut folded_turning_once, mut only_holes_tell) = (0, 0, 0);
    for round in 0..24_000 {
        let mesh = &meshes[round % meshes.len()];
        let scale = f64::from(1 + random.below(5));
        let mut embedding = from_above(mesh);
        let size = u32::try_from(1 + round % 4).unwrap();
        for place in embedding.iter_mut() {
            let by = DVec2::new(f64::from(random.below(2 * size + 1)), f64::from(random.below(2 * size + 1)));
            *place = (scale * *place + by - f64::from(size)).round();
        }
        let facts = facts(mesh, &embedding);
        assert_theorem(&facts, &(round, &embedding));
        one_to_one += usize::from(facts.is_one_to_one);
        folded_turning_once += usize::from(facts.turns_once && !facts.is_locally_planar);
        let is_missed = facts.outside.is_empty() && !facts.is_locally_planar;
        only_holes_tell += usize::from(is_missed && verdict(mesh, &embedding).turning_number == Some(1));
    }
    let counts = [one_to_one, folded_turning_once, only_holes_tell];
    assert!(one_to_one > 1_000 && folded_turning_once > 1_000 && only_holes_tell > 20, "{counts:?}: too few to tell");
}

fn steps_of(mesh: &DiskMesh, settings: Settings) -> Vec<Step> {
    let mut steps = Vec::new();
    Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

fn assert_steps_list_the_vertices_outside_and_planar_steps_have_none(disks: Vec<Entry>) {
    for entry in disks {
        let mesh = entry.disk();
        for family in [Family::Conformal, Family::MeanValue] {
            for step in steps_of(&mesh, Settings::new(Method::Natural, family)) {
                let found = vertices_outside_hull(&mesh, &step.candidate.solution.embedding, step.verdict.upright());
                assert_eq!(step.outside_hull, found, "{}", entry.file);
                assert!(!step.verdict.is_one_to_one() || found.is_empty(), "{}", entry.file);
            }
        }
        let convex = Settings::new(Method::Convex(BoundaryShape::Circle), Family::MeanValue);
        let [step] = &steps_of(&mesh, convex)[..] else { panic!("one step") };
        assert_theorem(&facts(&mesh, &step.candidate.solution.embedding), &entry.file);
    }
}

#[test]
fn steps_list_the_vertices_outside_and_planar_steps_have_none() {
    assert_steps_list_the_vertices_outside_and_planar_steps_have_none(data_disks());
}

corpus_test! {
    fn steps_list_the_vertices_outside_and_planar_steps_have_none_in_the_corpus() {
        let is_small = |entry: &Entry| entry.number("F").is_some_and(|faces| faces < 3_000);
        let small = corpus_disks().into_iter().filter(is_small);
        assert_steps_list_the_vertices_outside_and_planar_steps_have_none(small.collect());
    }
}

#[test]
fn a_folded_step_with_a_boundary_that_turns_once_has_a_vertex_outside() {
    let mut random = Random(0xc0be5);
    let mut folded = 0;
    for case in 0..12 {
        let mesh = irregular_cube(4 + case % 4, &mut random);
        let [a, b] = interior_pair(&mesh, &mut random);
        let pins = hard_pins([(a, DVec2::ZERO), (b, DVec2::new(mesh.position(a).distance(mesh.position(b)), 0.0))]);
        let mut ladder = Flattener::new(Settings::new(Method::Iterate, Family::Conformal), pins);
        ladder
            .finish(&mesh, Control::unattended(), |step| {
                assert_eq!(step.hull_seconds > 0.0, !step.verdict.is_one_to_one(), "looked for only where it folds");
                let is_folded = !step.verdict.flipped_faces.is_empty() && step.verdict.turning_number == Some(1);
                folded += usize::from(is_folded);
                assert!(!is_folded || !step.outside_hull.is_empty(), "step {} of cube {case}", step.index);
            })
            .unwrap();
    }
    assert!(folded > 5, "{folded} folded steps");
}
