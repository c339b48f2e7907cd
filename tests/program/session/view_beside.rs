//! Embeddings side by side under one camera, and their common scale of colours.

use freebound::examples::Example;
use freebound::view::{CellFrames, PlaneCamera, Quantity};
use freebound_core::geom::PictureFrame;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::pipeline::{Outcome, Problem, hard_targets};
use freebound_core::problem::{Control, Settings, Variant};
use glam::DVec2;

/// First step of a method, with two pinned vertices if it takes pins.
fn outcome(mesh: &DiskMesh, variant: &str, pins: &[(VertexId, DVec2)]) -> Outcome {
    let variant: Variant = variant.parse().expect("a variant");
    let targets = hard_targets(pins.iter().copied());
    let problem = Problem {
        settings: variant.settings(&Settings::default()),
        frame: PictureFrame::default(),
        targets,
        shaped: None,
    };
    let step = problem.flattener().step(mesh, Control::unattended()).expect("solved");
    Outcome::new(mesh, problem, step)
}

fn dome() -> DiskMesh {
    DiskMesh::try_from(Example::Dome.mesh()).expect("a disk")
}

/// Area covered by the faces.
fn area(mesh: &DiskMesh, outcome: &Outcome) -> f64 {
    let embedding = &outcome.step.candidate.solution.embedding;
    let of = |face| {
        let [a, b, c] = mesh.face(face).map(|v| embedding[v]);
        (b - a).perp_dot(c - a).abs() / 2.0
    };
    mesh.faces().map(of).sum()
}

#[test]
fn without_pins_each_is_seen_about_its_own_middle_at_its_own_size() {
    let mesh = dome();
    let outcomes = ["natural", "convex/uniform@square"].map(|variant| outcome(&mesh, variant, &[]));
    let frames = CellFrames::new(&mesh, &[&outcomes[0], &outcomes[1]]);
    assert_eq!(frames.bounds.middle(), DVec2::ZERO);
    for (outcome, frame) in outcomes.iter().zip(&frames.frames) {
        let own = outcome.step.candidate.solution.embedding.bounds();
        assert!(frame.own(DVec2::ZERO).distance(own.middle()) < 1e-12 * own.size().length());
        assert_eq!(frame.size(), 1.0);
        // The whole embedding lies within the shown bounds.
        let [low, high] = [frames.bounds.low, frames.bounds.high].map(|corner| frame.own(corner));
        assert!(low.cmple(own.low).all() && high.cmpge(own.high).all());
    }
}

#[test]
fn where_pins_hold_some_these_stay_and_the_others_have_their_area() {
    let mesh = dome();
    let [a, b] = [mesh.boundary_loop()[0], mesh.boundary_loop()[mesh.boundary_loop().len() / 2]];
    let pins = [(a, DVec2::new(5.0, 5.0)), (b, DVec2::new(5.5, 5.25))];
    let outcomes = ["convex", "natural", "levy"].map(|variant| outcome(&mesh, variant, &pins));
    let frames = CellFrames::new(&mesh, &outcomes.iter().collect::<Vec<_>>());
    let [free, held, other] = [frames.frames[0], frames.frames[1], frames.frames[2]];
    for frame in [held, other] {
        assert_eq!((frame.own(DVec2::new(2.0, -3.0)), frame.size()), (DVec2::new(2.0, -3.0), 1.0));
    }
    let ratio = area(&mesh, &outcomes[0]) / area(&mesh, &outcomes[1]);
    assert!((free.size() - ratio.sqrt()).abs() < 1e-12 * free.size());
    let own = outcomes[0].step.candidate.solution.embedding.bounds();
    assert!(free.own(frames.bounds.middle()).distance(own.middle()) < 1e-9 * own.size().length());
}

#[test]
fn the_same_point_of_the_common_plane_shows_in_the_same_place_of_every_cell() {
    let mesh = dome();
    let pins = [(mesh.boundary_loop()[0], DVec2::new(5.0, 5.0))];
    let outcomes = ["convex", "natural"].map(|variant| outcome(&mesh, variant, &pins));
    let frames = CellFrames::new(&mesh, &[&outcomes[0], &outcomes[1]]);
    let pane = DVec2::new(300.0, 200.0);
    let mut camera = PlaneCamera::framing(frames.bounds, pane);
    camera.zoom_at(DVec2::new(40.0, 150.0), 3.0, pane);
    let point = frames.bounds.low.lerp(frames.bounds.high, 0.3);
    let places = frames.frames.iter().map(|frame| frame.camera(&camera).pane_from_embedding(frame.own(point), pane));
    let expected = camera.pane_from_embedding(point, pane);
    for place in places {
        assert!(place.distance(expected) < 1e-9, "{place} {expected}");
    }
}

#[test]
fn one_that_is_much_larger_than_the_others_does_not_make_them_small() {
    let mesh = dome();
    let [first, second] = ["natural", "levy"].map(|variant| outcome(&mesh, variant, &[]));
    let mut wild = outcome(&mesh, "convex", &[]);
    let embedding = &mut wild.step.candidate.solution.embedding;
    *embedding = embedding.iter().map(|&z| 1e6 * z).collect();
    let usual = CellFrames::new(&mesh, &[&first, &second]).bounds.size();
    let with_wild = CellFrames::new(&mesh, &[&first, &second, &wild]).bounds.size();
    assert!(with_wild.x <= 3.0 * usual.x, "{with_wild} {usual}");
    let broken = {
        let embedding = &mut wild.step.candidate.solution.embedding;
        *embedding = embedding.iter().map(|_| DVec2::NAN).collect();
        CellFrames::new(&mesh, &[&first, &wild])
    };
    assert!(broken.bounds.size().is_finite() && broken.frames.iter().all(|frame| frame.own(DVec2::ONE).is_finite()));
}

#[test]
fn the_common_range_is_not_that_of_one_wild_embedding() {
    let mesh = dome();
    let outcomes = ["natural", "lscm", "levy", "convex/uniform"].map(|variant| outcome(&mesh, variant, &[]));
    let of = |list: &[&Outcome]| {
        Quantity::Angle.common_range(list.iter().map(|outcome| &outcome.distortion)).expect("of some")
    };
    let alone: Vec<_> = outcomes.iter().map(|outcome| of(&[outcome])).collect();
    let [natural, lscm, levy, tutte] = [alone[0], alone[1], alone[2], alone[3]];
    assert!(tutte.high > natural.high && tutte.high > levy.high, "{alone:?}");
    let all = of(&outcomes.iter().collect::<Vec<_>>());
    let mut highs = [natural.high, lscm.high, levy.high, tutte.high];
    highs.sort_by(f64::total_cmp);
    assert_eq!((all.low, all.high), (1.0, highs[2]));
    assert_eq!(Quantity::Area.common_range(std::iter::empty()), None);
    for quantity in Quantity::ALL {
        let range = quantity.common_range(outcomes.iter().map(|outcome| &outcome.distortion)).expect("of some");
        assert!(range.low < range.high, "{quantity:?}");
    }
}
