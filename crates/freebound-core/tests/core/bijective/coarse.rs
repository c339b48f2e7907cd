//! Coarser disks: coarsening and prolongation stay one-to-one; stages of the flattener that use them.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use freebound_core::bijective::multires::{FineLevel, Hierarchy, Level};
use freebound_core::bijective::schnyder;
use freebound_core::flatten::{Ending, Flattener, Options, Step};
use freebound_core::mesh::{DiskMesh, FIRST_HOLE, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Pin, Pins, Settings, SolveError, Stage, hard_pins};
use freebound_core::verify::{FaceDistortion, is_one_to_one};
use glam::DVec2;
use proptest::prelude::*;

use freebound_testkit::{Random, Relief, assert_message, seamed_ball};

/// Hilly square with this number of columns and rows of irregular triangles, and its view from above. The view fills
/// a square of side 2 about the origin.
fn hills(columns: u32, random: &mut Random) -> (DiskMesh, Embedding) {
    let stride = columns + 1;
    let mut at = |k: u32| {
        let within = |k: u32| k > 0 && k < columns;
        let [i, j] = [k % stride, k / stride];
        let mut shifted = |k: u32| f64::from(k) + if within(k) { 0.5 * random.unit() - 0.25 } else { 0.0 };
        (2.0 / f64::from(columns)) * DVec2::new(shifted(i), shifted(j)) - 1.0
    };
    let flat: Embedding = (0..stride * stride).map(&mut at).collect();
    let height = |z: &DVec2| 0.3 * (3.0 * z.x).sin() * (4.0 * z.y + 1.0).cos();
    let positions = flat.iter().map(|z| z.extend(height(z))).collect();
    let cell = |v: u32| [[v, v + 1, v + stride + 1], [v, v + stride + 1, v + stride]];
    let triangles: Vec<[u32; 3]> =
        (0..columns * columns).flat_map(|k| cell(k / columns * stride + k % columns)).collect();
    (DiskMesh::of_topology(TriMesh::new(positions, &triangles)).unwrap(), flat)
}

fn taken(mesh: &DiskMesh, flat: &Embedding, pins: &Pins, target: usize) -> Hierarchy {
    let keeps = |vertex: VertexId| pins.contains_key(&vertex);
    Hierarchy::new(mesh, flat, keeps, target, Control::unattended()).unwrap().expect("most vertices can go")
}

/// Pins six random vertices to the origin.
fn some_pins(mesh: &DiskMesh, random: &mut Random) -> Pins {
    let count = u32::try_from(mesh.vertex_count()).unwrap();
    (0..6).map(|_| (VertexId::new(random.below(count)), Pin::hard(DVec2::ZERO))).collect()
}

fn lifted(hierarchy: &Hierarchy, fine: FineLevel<'_>, coarse: &Embedding) -> Option<Embedding> {
    hierarchy.lifted(fine, coarse, |_, embedding| Ok(embedding), Control::unattended()).unwrap()
}

/// Twists about the origin, most in the middle, then stretches.
fn twisted(z: DVec2, [turn, stretch]: [f64; 2]) -> DVec2 {
    let turned = DVec2::from_angle(turn * (-2.0 * z.length_squared()).exp()).rotate(z);
    DVec2::new(stretch * turned.x, turned.y / stretch)
}

#[test]
fn vertices_are_taken_until_few_are_left_and_every_disk_on_the_way_is_planar_where_it_lies() {
    let mut random = Random(7);
    let (mesh, flat) = hills(40, &mut random);
    let pins = some_pins(&mesh, &mut random);
    let hierarchy = taken(&mesh, &flat, &pins, 60);
    let levels: Vec<&Level> = hierarchy.levels().chain([hierarchy.coarsest()]).collect();
    let counts: Vec<usize> = levels.iter().map(|level| level.vertices.len()).collect();
    assert!(counts.len() > 2 && counts.is_sorted_by(|a, b| a > b), "{counts:?}");
    assert!(counts.last().is_some_and(|&count| (60..90).contains(&count)), "{counts:?}");
    for level in &levels {
        assert!(is_one_to_one(&level.disk, &level.part_of(&flat)));
        assert!(pins.keys().all(|vertex| level.vertices.binary_search(vertex).is_ok()), "pins stay");
        for (place, &vertex) in level.vertices.iter().enumerate() {
            assert_eq!(level.disk.position(VertexId::from_index(place)), mesh.position(vertex));
        }
    }
    let is_part =
        |few: &Level, many: &Level| few.vertices.iter().all(|vertex| many.vertices.binary_search(vertex).is_ok());
    assert!(levels.windows(2).all(|pair| is_part(pair[1], pair[0])));
    assert!(hierarchy.coarsest().disk.boundary_loop().len() < mesh.boundary_loop().len() / 2, "the boundary, too");
}

#[test]
fn a_boundary_that_is_kept_stays_as_it_is() {
    let (mesh, flat) = hills(24, &mut Random(3));
    let keeps = |vertex: VertexId| mesh.boundary_place(vertex).is_some();
    let hierarchy = Hierarchy::new(&mesh, &flat, keeps, 10, Control::unattended()).unwrap().unwrap();
    let coarsest = hierarchy.coarsest();
    let boundary: Vec<VertexId> = coarsest.disk.boundary_loop().iter().map(|v| coarsest.vertices[v.index()]).collect();
    let begin = mesh.boundary_loop().iter().position(|v| *v == boundary[0]).unwrap();
    let mut expected = mesh.boundary_loop().to_vec();
    expected.rotate_left(begin);
    assert_eq!(boundary, expected);
    assert!(coarsest.vertices.len() < mesh.vertex_count() / 2);
    // No new edge joins two kept vertices.
    for edge in coarsest.disk.edges().filter(|&edge| !coarsest.disk.is_boundary_edge(edge)) {
        let [a, b] = coarsest.disk.ends(edge).map(|v| coarsest.vertices[v.index()]);
        let was_there = || mesh.outgoing(a).any(|side| mesh.head(side) == b);
        assert!(!(keeps(a) && keeps(b)) || was_there(), "{a} {b}");
    }
}

#[test]
fn what_is_put_back_where_the_others_were_left_is_planar_and_hardly_more_distorted() {
    let mut random = Random(11);
    let (mesh, flat) = hills(30, &mut random);
    let pins = some_pins(&mesh, &mut random);
    let hierarchy = taken(&mesh, &flat, &pins, 80);
    let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
    let back = lifted(&hierarchy, fine, &hierarchy.coarsest().part_of(&flat)).expect("there is room");
    assert!(is_one_to_one(&mesh, &back));
    assert!(pins.keys().all(|vertex| back[vertex] == flat[vertex]), "what is held does not move");
    let energy = |z: &Embedding| freebound_core::verify::distortion(&mesh, z).summary.symmetric_dirichlet.mean;
    assert!(energy(&back) < 1.2 * energy(&flat), "{} {}", energy(&back), energy(&flat));
}

/// Hills with a square hole in the middle, which virtual faces fill.
fn hills_with_hole(columns: u32, random: &mut Random) -> (DiskMesh, Embedding) {
    let (hills, flat) = hills(columns, random);
    let middle = columns / 2;
    let is_in_hole = |face: usize| {
        let cell = u32::try_from(face).unwrap() / 2;
        [cell % columns, cell / columns].iter().all(|&place| place.abs_diff(middle) < 3)
    };
    let faces = &hills.mesh().triangles;
    let (hole, real): (Vec<usize>, Vec<usize>) = (0..faces.len()).partition(|&face| is_in_hole(face));
    let numbers = (0..u32::try_from(real.len()).unwrap()).chain(hole.iter().map(|_| FIRST_HOLE)).collect();
    let triangles = real.iter().chain(&hole).map(|&face| faces[face]).collect();
    let mesh = TriMesh { positions: hills.mesh().positions.clone(), triangles, polygon_of: Some(numbers) };
    (DiskMesh::of_topology(mesh).unwrap(), flat)
}

#[test]
fn a_filled_hole_stays_as_it_is_on_every_level() {
    let mut random = Random(13);
    let (mesh, flat) = hills_with_hole(40, &mut random);
    let (pins, at_hole) = (Pins::new(), mesh.vertices_at_holes());
    assert_eq!(at_hole.len(), 36, "25 cells");
    let hierarchy = taken(&mesh, &flat, &pins, 60);
    let faces_of_hole = |disk: &DiskMesh, name: &dyn Fn(VertexId) -> VertexId| {
        let corners = |face| disk.face(face).map(name);
        disk.faces().filter(|&face| disk.is_virtual(face)).map(corners).collect::<Vec<_>>()
    };
    for level in hierarchy.levels().chain([hierarchy.coarsest()]) {
        assert!(is_one_to_one(&level.disk, &level.part_of(&flat)));
        let here = faces_of_hole(&level.disk, &|vertex| level.vertices[vertex.index()]);
        assert_eq!(here, faces_of_hole(&mesh, &|vertex| vertex));
    }
    assert!(hierarchy.coarsest().vertices.len() < 60 + at_hole.len() + 30, "all others can go");
    let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
    let coarse = hierarchy.coarsest().part_of(&flat).iter().map(|&z| twisted(z, [0.5, 1.5])).collect();
    let back = lifted(&hierarchy, fine, &coarse).expect("there is room");
    assert!(is_one_to_one(&mesh, &back));
}

/// Hills with a slit like a saw from the lower side to the middle, and a view from above that opens it by a hair.
/// The tooth tips are faces with all three vertices on the boundary.
fn hills_with_slit(columns: u32, random: &mut Random) -> (DiskMesh, Embedding) {
    let (hills, flat) = hills(columns, random);
    let (stride, middle) = (columns + 1, columns / 2);
    let mut positions = hills.mesh().positions.clone();
    let mut flat: Vec<DVec2> = flat.to_vec();
    let hair = 0.002 / f64::from(columns) * DVec2::new(2.0, 1.0);
    // (middle, j) to (middle + 1, j + 1) to (middle, j + 1), and so on.
    let mut right_of = BTreeMap::new();
    for j in 0..middle {
        for vertex in [j * stride + middle, (j + 1) * stride + middle + 1] {
            right_of.insert(VertexId::new(vertex), VertexId::from_index(positions.len()));
            positions.push(positions[vertex as usize]);
            flat.push(flat[vertex as usize] + hair);
            flat[vertex as usize] -= hair;
        }
    }
    let is_right = |face: usize| {
        let column = u32::try_from(face).unwrap() / 2 % columns;
        column > middle || (column == middle && face.is_multiple_of(2))
    };
    let corner = |face, vertex| right_of.get(&vertex).copied().filter(|_| is_right(face)).unwrap_or(vertex);
    let faces = hills.mesh().triangles.iter().enumerate();
    let triangles = faces.map(|(face, corners)| corners.map(|vertex| corner(face, vertex))).collect();
    (DiskMesh::of_topology(TriMesh { positions, triangles, polygon_of: None }).unwrap(), flat.into())
}

#[test]
fn tips_of_faces_are_put_back_between_the_sides_of_a_slit_without_much_distortion() {
    let (mesh, flat) = hills_with_slit(40, &mut Random(17));
    assert!(is_one_to_one(&mesh, &flat));
    let pins = Pins::new();
    let hierarchy = taken(&mesh, &flat, &pins, 60);
    let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
    let back = lifted(&hierarchy, fine, &hierarchy.coarsest().part_of(&flat)).expect("there is room");
    assert!(is_one_to_one(&mesh, &back));
    let faces = freebound_core::verify::distortion(&mesh, &back).faces;
    let worst = faces.iter().map(FaceDistortion::symmetric_dirichlet).fold(0.0, f64::max);
    assert!(worst < 50.0, "{worst}");
}

#[test]
fn the_bits_are_the_same_for_any_number_of_threads() {
    let mut random = Random(5);
    let (mesh, flat) = hills(40, &mut random);
    let pins = some_pins(&mesh, &mut random);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let hierarchy = taken(&mesh, &flat, &pins, 60);
            let coarsest = hierarchy.coarsest();
            let coarse = coarsest.part_of(&flat).iter().map(|&z| twisted(z, [0.5, 1.5])).collect();
            let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
            (coarsest.vertices.clone(), lifted(&hierarchy, fine, &coarse).expect("there is room"))
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn taking_and_putting_back_can_be_cancelled() {
    let (mesh, flat) = hills(20, &mut Random(2));
    let raised = AtomicBool::new(true);
    let cancelled = Control::new(&raised, &|_| {});
    assert_eq!(Hierarchy::new(&mesh, &flat, |_| false, 50, cancelled).map(|_| ()), Err(SolveError::Cancelled));
    let (hierarchy, pins) = (taken(&mesh, &flat, &Pins::new(), 50), Pins::new());
    let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
    let coarse = hierarchy.coarsest().part_of(&flat);
    let result = hierarchy.lifted(fine, &coarse, |_, embedding| Ok(embedding), cancelled);
    assert_eq!(result, Err(SolveError::Cancelled));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn a_mesh_follows_its_coarse_disk_one_to_one(
        seed in 1_u32.., columns in 8_u32..24, turn in -1.5_f64..1.5, stretch in 0.2_f64..5.0, scatter in 0.0_f64..0.5,
    ) {
        let mut random = Random(seed.into());
        let (mesh, flat) = hills(columns, &mut random);
        let pins = some_pins(&mesh, &mut random);
        let hierarchy = taken(&mesh, &flat, &pins, mesh.vertex_count() / 8);
        let coarsest = hierarchy.coarsest();
        let mut coarse: Embedding = coarsest.part_of(&flat).iter().map(|&z| twisted(z, [turn, stretch])).collect();
        prop_assume!(is_one_to_one(&coarsest.disk, &coarse));
        // Moves vertices to random positions between their neighbours.
        for vertex in coarsest.disk.vertices() {
            let before = coarse[vertex];
            let reach = coarsest.disk.outgoing(vertex).map(|side| coarse[coarsest.disk.head(side)].distance(before));
            let by = scatter * reach.fold(f64::INFINITY, f64::min) * random.unit();
            coarse[vertex] += by * DVec2::from_angle(std::f64::consts::TAU * random.unit());
            if !is_one_to_one(&coarsest.disk, &coarse) {
                coarse[vertex] = before;
            }
        }
        let fine = FineLevel { mesh: &mesh, embedding: &flat, pins: &pins };
        let back = lifted(&hierarchy, fine, &coarse).expect("there is room");
        prop_assert!(is_one_to_one(&mesh, &back));
        for (vertex, z) in coarsest.vertices.iter().zip(&coarse).filter(|(vertex, _)| pins.contains_key(vertex)) {
            prop_assert_eq!(back[vertex], *z);
        }
    }
}

/// Mesh of some thousand vertices, its view from above, and six pins, four of which turn about the middle.
fn far_pins() -> (DiskMesh, Arc<Embedding>, Pins) {
    let (mesh, flat) = hills(64, &mut Random(13));
    let nearest = |to: DVec2| {
        mesh.vertices().min_by(|a, b| flat[*a].distance(to).total_cmp(&flat[*b].distance(to))).expect("vertices")
    };
    let inner = (0..4).map(|k| 0.4 * DVec2::from_angle(f64::from(k) * 1.57)).map(|z| (nearest(z), z.perp()));
    let outer = [DVec2::NEG_ONE, DVec2::ONE].map(|z| (nearest(z), z));
    let pins = inner.chain(outer).map(|(vertex, target)| (vertex, Pin::hard(target))).collect();
    (mesh, Arc::new(flat), pins)
}

fn ladder(method: Method, relax_rounds: usize, (pins, start): (&Pins, &Arc<Embedding>)) -> Flattener {
    let settings = Settings { relax_rounds: Some(relax_rounds), ..Settings::new(method, Family::default()) };
    let (pins, layout) = (pins.clone(), Some(Arc::clone(start)));
    Flattener::with_options(Options { settings, pins, layout, ..Options::default() })
}

/// Note of a step, with N in place of each number.
fn without_numbers(step: &Step) -> String {
    let note = step.candidate.note.as_deref().expect("a note");
    note.split(' ').map(|word| if word.parse::<f64>().is_ok() { "N" } else { word }).collect::<Vec<_>>().join(" ")
}

fn all_steps(mesh: &DiskMesh, mut ladder: Flattener) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = ladder.finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    (steps, ending)
}

#[test]
fn pins_far_from_their_targets_are_met_by_way_of_fewer_vertices() {
    let (mesh, start, pins) = far_pins();
    let (steps, ending) = all_steps(&mesh, ladder(Method::Continuation, 0, (&pins, &start)));
    let last = steps.last().unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(last.verdict.planar && last.unmet().is_empty(), "{}", last.verdict.summary());
    assert_message("coarse-way-to-pins", &without_numbers(last));
    assert!(last.candidate.progress.unwrap().energy < 20.0 && last.candidate.progress.unwrap().distance_left == 0.0);
    let of_continuation = steps.iter().filter(|step| step.candidate.stage == Stage::Continuation);
    assert_eq!(of_continuation.count(), 1, "the outer pins hold it where it lies: nothing is fitted");
}

#[test]
fn the_way_by_fewer_vertices_that_is_cancelled_is_taken_anew() {
    let (mesh, start, pins) = far_pins();
    let (whole, _) = all_steps(&mesh, ladder(Method::Continuation, 0, (&pins, &start)));
    let mut ladder = ladder(Method::Continuation, 0, (&pins, &start));
    while ladder.step_count() + 1 < whole.len() {
        ladder.step(&mesh, Control::unattended()).unwrap();
    }
    for allowed in [0, 6, 12] {
        let (flag, phases) = (AtomicBool::new(false), AtomicUsize::new(0));
        let report = |_| flag.store(phases.fetch_add(1, Ordering::Relaxed) >= allowed, Ordering::Relaxed);
        assert_eq!(
            ladder.step(&mesh, Control::new(&flag, &report)).map(|_| ()),
            Err(SolveError::Cancelled),
            "{allowed}"
        );
    }
    let last = ladder.step(&mesh, Control::unattended()).unwrap();
    assert_eq!(last.candidate.solution.embedding, whole.last().unwrap().candidate.solution.embedding);
}

#[test]
fn an_embedding_of_a_huge_energy_is_relaxed_by_way_of_fewer_vertices() {
    let (mesh, flat) = hills(40, &mut Random(17));
    // Crushes the middle: a distance r from it becomes r⁷.
    let crushed: Embedding = flat.iter().map(|z| z.length_squared().powi(3) * *z).collect();
    assert!(is_one_to_one(&mesh, &crushed));
    let (steps, _) = all_steps(&mesh, ladder(Method::Continuation, 1, (&Pins::new(), &Arc::new(crushed))));
    let energies: Vec<f64> =
        steps.iter().filter_map(|step| step.candidate.progress).map(|progress| progress.energy).collect();
    let is_one_round =
        energies.len() >= 2 && steps.iter().filter(|step| step.candidate.stage == Stage::Relax).count() == 1;
    assert!(is_one_round && energies[0] > 1e6, "{energies:?}");
    assert!(energies.last().is_some_and(|&last| last < 10.0), "from the worst to the good: {energies:?}");
    assert!(steps.iter().all(|step| step.verdict.is_one_to_one()));
}

#[test]
fn without_an_embedding_the_surface_says_what_can_go_and_any_planar_drawing_of_the_rest_takes_all_back() {
    for (seed, relief) in [(1, Relief::Bumps), (2, Relief::Folds), (3, Relief::Folds)] {
        let mesh = DiskMesh::try_from(seamed_ball(14, 40, relief, seed)).unwrap();
        let hierarchy = Hierarchy::in_space(&mesh, |_| false, 60, Control::unattended()).unwrap().expect("most can go");
        let coarsest = hierarchy.coarsest();
        let (few, all) = (coarsest.disk.vertex_count(), mesh.vertex_count());
        assert!(8 * few < all, "{few} of {all}");
        for (place, &vertex) in coarsest.vertices.iter().enumerate() {
            assert_eq!(coarsest.disk.position(VertexId::from_index(place)), mesh.position(vertex));
        }
        // A grid drawing is planar by theorem and does not depend on the surface.
        let drawing = schnyder(&coarsest.disk);
        assert!(is_one_to_one(&coarsest.disk, &drawing));
        let nowhere = Embedding::from(vec![DVec2::ZERO; all]);
        let fine = FineLevel { mesh: &mesh, embedding: &nowhere, pins: &Pins::new() };
        let back = lifted(&hierarchy, fine, &drawing).expect("there is room");
        assert!(is_one_to_one(&mesh, &back), "{relief:?}, {seed}");
    }
}

#[test]
fn a_large_disk_whose_boundary_crosses_itself_goes_by_way_of_few_vertices() {
    let mesh = DiskMesh::try_from(seamed_ball(33, 420, Relief::Folds, 5)).unwrap();
    assert!(mesh.vertex_count() > 4000);
    let settings = Settings { relax_rounds: Some(0), ..Settings::default() };
    let (steps, ending) = all_steps(&mesh, Flattener::new(settings, Pins::new()));
    assert_eq!(ending, Ending::Planar);
    assert!(!steps[0].has_simple_boundary(), "the natural boundary crosses itself");
    let is_by_few = |step: &Step| {
        let candidate = &step.candidate;
        candidate.stage == Stage::VirtualBoundary
            && candidate.virtual_boundary.is_none()
            && candidate.progress.is_some()
    };
    let by_few = steps.iter().position(is_by_few).expect("a step by way of few vertices");
    assert_message("coarse-way-to-planar", &without_numbers(&steps[by_few]));
    assert!(steps[by_few].verdict.planar && steps[..by_few].iter().all(|step| !step.verdict.planar));
    // No continuation on the fine mesh: all steps before are linear solves and iterations.
    assert!(steps[..by_few].iter().all(|step| matches!(step.candidate.stage, Stage::Natural | Stage::Iterate)));
    let energy = steps[by_few].candidate.progress.expect("numbers of its energy").energy;
    // A mean energy up to 20 is moderate: the map needs no relaxation first.
    assert!(energy < 20.0, "{energy}, not the millions of a boundary on a circle");
}

/// Small cut ball, and its boundary in a planar embedding.
fn cut_ball() -> (DiskMesh, Vec<DVec2>) {
    let mesh = DiskMesh::try_from(seamed_ball(12, 60, Relief::Folds, 8)).unwrap();
    let (steps, _) = all_steps(&mesh, Flattener::new(Settings::default(), Pins::new()));
    let last = steps.last().filter(|step| step.verdict.planar).expect("a planar embedding");
    let boundary = last.candidate.solution.embedding.boundary(&mesh);
    (mesh, boundary)
}

fn with_boundary_held(mesh: &DiskMesh, places: &[DVec2]) -> (Vec<Step>, Ending) {
    let pins = hard_pins(mesh.boundary_loop().iter().copied().zip(places.iter().copied()));
    let settings = Settings { new_vertices: false, relax_rounds: Some(0), ..Settings::default() };
    all_steps(mesh, Flattener::new(settings, pins))
}

/// First remark of the steps that contains a word.
fn remark_with<'a>(steps: &'a [Step], word: &str) -> &'a str {
    let notes = steps.iter().filter_map(|step| step.candidate.note.as_deref());
    notes.flat_map(|note| note.split("; ")).find(|remark| remark.contains(word)).expect("it is said")
}

#[test]
fn a_boundary_held_on_a_circle_is_met_by_one_solve_that_fixes_it() {
    let (mesh, boundary) = cut_ball();
    let count = boundary.len() as f64;
    let circle: Vec<DVec2> =
        (0..boundary.len()).map(|k| DVec2::from_angle(std::f64::consts::TAU * k as f64 / count)).collect();
    let (steps, ending) = with_boundary_held(&mesh, &circle);
    let last = steps.last().unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(last.verdict.planar && last.unmet().is_empty());
    assert_message("coarse-boundary-on-targets", remark_with(&steps, "mean-value"));
    assert_eq!(
        steps.iter().filter(|step| step.candidate.stage == Stage::Continuation).count(),
        1,
        "nothing is left to be done"
    );
}

#[test]
fn a_boundary_held_on_waves_is_met_from_a_circle() {
    let (mesh, boundary) = cut_ball();
    let size = boundary.iter().map(|z| z.abs().max_element()).fold(0.0, f64::max);
    let wave = |by: f64| 0.3 * size * (6.0 * by / size).sin();
    // Shear along x, then along y: a one-to-one map of the plane.
    let sheared = |z: &DVec2| {
        let x = z.x + wave(z.y);
        DVec2::new(x, z.y + wave(x))
    };
    let waves: Vec<DVec2> = boundary.iter().map(sheared).collect();
    let (steps, ending) = with_boundary_held(&mesh, &waves);
    let last = steps.last().unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(last.verdict.planar && last.unmet().is_empty(), "{}", last.verdict.summary());
    assert_message("coarse-boundary-on-circle", remark_with(&steps, "circle"));
    assert!(steps.iter().all(|step| !step.is_of_planar_start()), "no free boundary had to be found first");
    let distances = steps
        .iter()
        .filter(|step| step.candidate.stage == Stage::Continuation)
        .filter_map(|step| step.candidate.progress);
    let distances: Vec<f64> = distances.map(|progress| progress.distance_left).collect();
    assert!(distances[0] > 0.0 && distances.last() == Some(&0.0), "{distances:?}");
}

#[test]
fn a_boundary_held_on_a_flower_is_met_with_new_vertices_where_faces_between_its_vertices_would_turn_over() {
    let (mesh, _) = cut_ball();
    let boundary = mesh.boundary_loop();
    let turn = |k: usize| std::f64::consts::TAU * k as f64 / boundary.len() as f64;
    let target = |k: usize| (1.0 + 0.4 * (5.0 * turn(k)).cos()) * DVec2::from_angle(turn(k));
    let pins = hard_pins((0..boundary.len()).map(|k| (boundary[k], target(k))));
    let is_turned = |face| {
        let corners: Vec<DVec2> = mesh.face(face).iter().filter_map(|v| Some(pins.get(v)?.target)).collect();
        matches!(corners[..], [a, b, c] if (b - a).perp_dot(c - a) <= 0.0)
    };
    assert!(mesh.faces().any(is_turned), "no map without new vertices meets that");
    let (steps, ending) = all_steps(&mesh, Flattener::new(Settings::default(), pins));
    let last = steps.last().unwrap();
    assert_eq!(ending, Ending::Planar);
    assert!(last.verdict.planar && last.unmet().is_empty(), "{}", last.verdict.summary());
    assert_message("coarse-new-vertices-on-edges", remark_with(&steps, "edges"));
    let joins_boundary = |&&edge: &&[VertexId; 2]| edge.iter().all(|&vertex| mesh.boundary_place(vertex).is_some());
    let edges = last.candidate.refinement.as_ref().expect("new vertices").split_edges();
    assert!(!edges.is_empty() && edges.iter().filter(joins_boundary).count() == edges.len(), "{edges:?}");
}
