//! New vertices: every set of distinct targets is met, and the surface does not change.

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Family, Method, Pin, Pins, Settings, SolveError, Stage, hard_pins};
use freebound_core::verify::verdict;
use freebound_testkit::BuiltIn;
use glam::DVec2;

use crate::linear::shapes::finger;
use freebound_testkit::surfaces::irregular_cube;
use freebound_testkit::{Random, assert_message, disk, fan, grid};

/// Relative change of the area by rounding.
const SAME_AREA: f64 = 1e-12;

/// Step that adds the new vertices, after the planar start was moved to the constraints.
fn matched(mesh: &DiskMesh, pins: &Pins) -> Result<Step, SolveError> {
    let mut run = Flattener::new(Settings::new(Method::Matchmaker, Family::default()), pins.clone());
    let mut start = run.step(mesh, Control::unattended())?;
    while start.is_of_planar_start() {
        start = run.step(mesh, Control::unattended())?;
    }
    assert!(start.verdict.planar && start.candidate.refinement.is_none());
    let step = run.step(mesh, Control::unattended())?;
    assert_eq!(step.candidate.stage, Stage::Matchmaker);
    Ok(step)
}

/// Meets pins with new vertices, and checks all required properties.
fn check(mesh: &DiskMesh, pins: &Pins, name: &str) -> Step {
    let step = matched(mesh, pins).unwrap_or_else(|error| panic!("{name}: {error}"));
    let refinement = step.candidate.refinement.as_ref().expect("new vertices");
    let (fine, embedding) = (refinement.disk(), &step.candidate.solution.embedding);
    assert!(verdict(fine, embedding).planar, "{name}");
    assert!(!step.verdict.mirrored, "{name}");
    for (v, pin) in pins {
        assert_eq!(embedding[v].to_array().map(f64::to_bits), pin.target.to_array().map(f64::to_bits), "{name}");
    }
    let old = mesh.vertex_count();
    assert_eq!(refinement.old_vertex_count(), old);
    assert_eq!(fine.mesh().positions[..old], mesh.mesh().positions[..]);
    for (new, position) in refinement.new_vertices().iter().zip(&fine.mesh().positions[old..]) {
        assert!(new.edge[0] < new.edge[1] && new.at > 0.0 && new.at < 1.0, "{name}");
        assert!(
            mesh.edges().any(|e| {
                let [a, b] = mesh.ends(e);
                [a.min(b), a.max(b)] == new.edge
            }),
            "{name}"
        );
        let [a, b] = new.edge.map(|v| mesh.position(v));
        assert_eq!(a.lerp(b, new.at), *position);
    }
    let (before, after) = (mesh.mesh().area(), fine.mesh().area());
    assert!((before - after).abs() <= SAME_AREA * before, "{name}: {before} {after}");
    step
}

/// Random distinct vertices.
fn vertices(mesh: &DiskMesh, count: usize, random: &mut Random) -> Vec<VertexId> {
    let mut all: Vec<VertexId> = mesh.vertices().collect();
    for i in 0..count {
        let rest = u32::try_from(all.len() - i).unwrap();
        all.swap(i, i + random.below(rest) as usize);
    }
    all.truncate(count);
    all
}

/// Pins at random points of the unit square.
fn random_pins(mesh: &DiskMesh, count: usize, random: &mut Random) -> Pins {
    let pinned = vertices(mesh, count, random);
    pinned.into_iter().map(|v| (v, Pin::hard(DVec2::new(random.unit(), random.unit())))).collect()
}

/// Pins vertices to each other's positions in the embedding without pins.
fn permuted_pins(mesh: &DiskMesh, count: usize, random: &mut Random) -> Pins {
    let mut last = None;
    let mut run = Flattener::new(Settings::default(), Pins::new());
    run.finish(mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    let flat = last.unwrap().candidate.solution.embedding;
    let pinned = vertices(mesh, count, random);
    let mut others: Vec<DVec2> = pinned.iter().map(|v| flat[v.index()]).collect();
    // A single cycle (Sattolo 1986), so no vertex keeps its position.
    for i in 1..count {
        others.swap(i, random.below(u32::try_from(i).unwrap()) as usize);
    }
    pinned.into_iter().zip(others).map(|(v, target)| (v, Pin::hard(target))).collect()
}

#[test]
fn pins_on_small_grids_are_met_wherever_they_are_to_go() {
    let mut random = Random(1);
    for round in 0..40 {
        let mesh = DiskMesh::try_from(grid(1 + random.below(5), 1 + random.below(5))).unwrap();
        let most = u32::try_from(mesh.vertex_count().min(24)).unwrap();
        let count = (3 + random.below(most - 2)) as usize;
        let pins = random_pins(&mesh, count, &mut random);
        check(&mesh, &pins, &format!("round {round}, {count} pins"));
    }
}

#[test]
fn pins_that_change_places_at_random_are_met_on_irregular_disks() {
    let mut random = Random(2);
    for round in 0..12 {
        let mesh = if round % 2 == 0 { irregular_cube(4, &mut random) } else { finger(5, 7, &mut random) };
        let count = [3, 6, 12, 24][round / 2 % 4];
        let pins = permuted_pins(&mesh, count, &mut random);
        check(&mesh, &pins, &format!("round {round}, {count} pins"));
    }
}

#[test]
fn all_vertices_of_a_mesh_can_change_places() {
    let mut random = Random(3);
    for round in 0..20 {
        let mesh = DiskMesh::try_from(grid(2 + round % 3, 3)).unwrap();
        let pins = permuted_pins(&mesh, mesh.vertex_count(), &mut random);
        check(&mesh, &pins, &format!("round {round}, {} pins", pins.len()));
    }
}

#[test]
fn targets_may_be_a_millionth_of_their_extent_apart() {
    let mut random = Random(4);
    for round in 0..12 {
        let mesh = irregular_cube(4, &mut random);
        let pinned = vertices(&mesh, 3 + 7 * (round % 4), &mut random);
        let centres = [(); 3].map(|()| DVec2::new(random.unit(), random.unit()));
        let mut target = |place: f64| {
            let jitter = DVec2::new(random.unit(), random.unit());
            centres[random.below(3) as usize] + 1e-6 * (DVec2::new(1.5 * place, 0.0) + 0.4 * jitter)
        };
        let pins: Pins = pinned.into_iter().zip(0..).map(|(v, k)| (v, Pin::hard(target(f64::from(k))))).collect();
        check(&mesh, &pins, &format!("round {round}, {} pins", pins.len()));
    }
}

#[test]
fn a_face_with_three_pinned_corners_can_be_turned_over() {
    let mesh = DiskMesh::try_from(grid(2, 2)).unwrap();
    let face = mesh.face(mesh.faces().next().unwrap());
    let corners = face.map(|v| mesh.position(v).truncate());
    let pins = [(face[0], corners[1]), (face[1], corners[0]), (face[2], corners[2])];
    check(&mesh, &pins.map(|(v, target)| (v, Pin::hard(target))).into_iter().collect(), "face");
    let fan = DiskMesh::try_from(fan(3)).unwrap();
    let all = fan.vertices().map(|v| (v, Pin::hard(fan.position(v).truncate() * DVec2::new(-1.0, 1.0))));
    check(&fan, &all.collect(), "fan");
}

#[test]
fn without_pins_nothing_is_split() {
    let mesh = DiskMesh::try_from(BuiltIn::Dome.mesh()).unwrap();
    let mut run = Flattener::new(Settings::new(Method::Matchmaker, Family::default()), Pins::new());
    for _ in 0..2 {
        let step = run.step(&mesh, Control::unattended()).unwrap();
        assert!(step.verdict.planar && step.candidate.refinement.is_none());
    }
}

#[test]
fn targets_in_a_hopeless_order_are_given_up_with_a_reason() {
    // Every inner vertex gets the position of another at random, so the paths wind around each other many times.
    let mesh = disk(grid(12, 12));
    let mut random = Random(5);
    let inside: Vec<VertexId> = mesh.vertices().filter(|&v| mesh.boundary_place(v).is_none()).collect();
    let mut places: Vec<DVec2> = inside.iter().map(|&v| mesh.position(v).truncate()).collect();
    for i in 1..places.len() {
        places.swap(i, random.below(u32::try_from(i).unwrap() + 1) as usize);
    }
    let error = matched(&mesh, &hard_pins(inside.into_iter().zip(places))).expect_err("too many");
    assert_eq!(error, SolveError::TooManyNewVertices { most: 10_000 });
    assert!(error.is_failure_of_method(), "{error}");
    assert_message("matchmaker-too-many-new-vertices", &error.to_string());
}
