//! Embeddings without the user's pins are upright: the mesh's up is the picture's up, and nothing is mirrored.

use freebound::examples::Example;
use freebound_core::flatten::Step;
use freebound_core::geom::{Bounds, PictureFrame, Similarity, VAxis};
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::pipeline::{Fit, Outcome, Problem};
use freebound_core::problem::{Control, Embedding, GaugeSize, Method, Settings, gauge_pins};
use freebound_core::verify::is_planar;
use glam::{DVec2, DVec3};

use freebound_testkit::{disk, grid};

fn on_picture() -> Problem {
    let frame = PictureFrame { aspect: 1.6, v_axis: VAxis::Up };
    let [low, high] = frame.corners();
    Problem {
        settings: Settings { size: GaugeSize::Within(Bounds { low, high }), ..Settings::default() },
        frame,
        ..Problem::default()
    }
}

fn last_step(mesh: &DiskMesh, problem: &Problem) -> Step {
    let mut last = None;
    problem.flattener().finish(mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    last.expect("a ladder gives steps")
}

/// Plane sheet with its vertices in reverse order, mapped to space by `turn`.
fn reversed(turn: impl Fn(DVec3) -> DVec3) -> DiskMesh {
    let TriMesh { positions, triangles, .. } = grid(6, 4);
    let last = u32::try_from(positions.len()).unwrap() - 1;
    let positions = positions.into_iter().rev().map(turn).collect();
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|corners| corners.map(|v| last - v.number())).collect();
    disk(TriMesh::new(positions, &triangles))
}

/// Rotation, in radians, that best maps vertices in the plane to their seen positions, and the remaining error
/// relative to the extent.
fn turn_to(embedding: &Embedding, seen: impl Fn(VertexId) -> DVec2) -> (f64, f64) {
    let pairs: Vec<[DVec2; 2]> =
        embedding.iter().enumerate().map(|(i, &z)| [z, seen(VertexId::from_index(i))]).collect();
    let best = Similarity::fitting(&pairs).expect("the points differ");
    let turn = (best.apply(DVec2::X) - best.apply(DVec2::ZERO)).to_angle();
    (turn, best.error(&pairs) / Bounds::of(pairs.iter().map(|pair| pair[1])).size().max_element())
}

#[test]
fn a_sheet_that_its_gauge_pins_lay_upside_down_comes_out_upright() {
    let mesh = reversed(|p| DVec3::new(-p.x, -p.y, p.z));
    let [first, second] = gauge_pins(&mesh).into_keys().collect::<Vec<_>>().try_into().expect("two");
    let along = mesh.position(second) - mesh.position(first);
    assert!(along.x < 0.0, "along +x, as the gauge has them, they turn up to down: {along}");
    for problem in [Problem::default(), on_picture()] {
        let step = last_step(&mesh, &problem);
        let (turn, error) = turn_to(&step.candidate.solution.embedding, |v| mesh.position(v).truncate());
        assert!(turn.abs() < 1e-9 && error < 1e-9, "{turn} {error}");
        let (coordinates, ..) = Outcome::new(&mesh, problem.clone(), step).output(&mesh, Fit::Unit);
        // In the file the picture's frame is the unit square.
        let stretch = DVec2::new(problem.frame.aspect, 1.0);
        let coordinates: Embedding = coordinates.iter().map(|&uv| uv * stretch).collect();
        assert!(turn_to(&coordinates, |v| mesh.position(v).truncate()).0.abs() < 1e-9);
        assert!(is_planar(&mesh, &coordinates));
    }
}

#[test]
fn a_sheet_is_seen_from_the_side_that_its_faces_look_at() {
    // With its back to the viewer; lying on the floor, face up and face down; leaning.
    let ways: [fn(DVec3) -> DVec3; 4] = [
        |p| DVec3::new(-p.x, p.y, -p.z),
        |p| DVec3::new(p.x, p.z, -p.y),
        |p| DVec3::new(p.x, -p.z, p.y),
        |p| DVec3::new(p.x, 0.8 * p.y, -0.6 * p.y),
    ];
    for way in ways {
        let mesh = reversed(way);
        let flat = reversed(|p| p);
        let (turn, error) =
            turn_to(&last_step(&mesh, &on_picture()).candidate.solution.embedding, |v| flat.position(v).truncate());
        assert!(turn.abs() < 1e-9 && error < 1e-9, "{turn} {error}");
    }
}

#[test]
fn the_face_stands_upright_as_its_landmarks_say() {
    let mesh = DiskMesh::try_from(Example::Face.mesh()).unwrap();
    for problem in [Problem::default(), on_picture()] {
        let step = last_step(&mesh, &problem);
        assert!(step.verdict.planar && !step.verdict.mirrored);
        let embedding = &step.candidate.solution.embedding;
        let pairs: Vec<[DVec2; 2]> = Example::Face
            .landmarks()
            .into_iter()
            .map(|landmark| [embedding[landmark.vertex], landmark.target.into()])
            .collect();
        let best = Similarity::fitting(&pairs).unwrap();
        let turn = (best.apply(DVec2::X) - best.apply(DVec2::ZERO)).to_angle();
        assert!(turn.abs() < 0.2, "{turn} rad from the portrait");
    }
}

#[test]
fn steps_of_a_run_do_not_turn_about() {
    let mesh = DiskMesh::try_from(Example::BumpyCap.mesh()).unwrap();
    let settings = Settings { method: Method::Iterate, max_steps: Some(4), ..Settings::default() };
    let mut before: Option<Embedding> = None;
    let problem = Problem { settings, ..on_picture() };
    let take = |step: Step| {
        let embedding = step.candidate.solution.embedding;
        if let Some(before) = &before {
            let (turn, _) = turn_to(&embedding, |v| before[v]);
            assert!(turn.abs() < 0.3, "step {}: {turn} rad", step.index);
        }
        before = Some(embedding);
    };
    problem.flattener().finish(&mesh, Control::unattended(), take).unwrap();
}

#[test]
fn a_square_boundary_is_turned_by_quarters_alone() {
    let mesh = reversed(|p| p);
    let settings =
        Settings { method: Method::Convex(freebound_core::problem::BoundaryShape::Square), ..Settings::default() };
    let step = last_step(&mesh, &Problem { settings, ..Problem::default() });
    let embedding = &step.candidate.solution.embedding;
    let bounds = embedding.bounds();
    let on_side = |v: &VertexId| {
        let z = embedding[*v];
        let gap = (z - bounds.low).min(bounds.high - z).min_element();
        gap < 1e-9 * bounds.extent()
    };
    assert!(mesh.boundary_loop().iter().all(on_side), "its sides are level");
    assert!(turn_to(embedding, |v| mesh.position(v).truncate()).0.abs() < 0.8);
}
