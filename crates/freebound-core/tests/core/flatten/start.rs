//! Starts from an embedding: it becomes the first step unchanged, and later steps start from it.

use std::sync::Arc;

use freebound_core::flatten::{Ending, Flattener, Options, Step};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, SolveError, Stage, hard_pins};
use freebound_core::verify::distortion;
use glam::DVec2;

use freebound_testkit::surfaces::bump;
use freebound_testkit::{assert_message, disk, grid};

/// View from above, sheared and shifted: planar, but far from isometric.
fn sheared(mesh: &DiskMesh) -> Embedding {
    let place = |v: VertexId| mesh.position(v).truncate();
    let shear = |z: DVec2| DVec2::new(0.1 * z.x + 0.05 * z.y, 0.03 * z.y) + DVec2::new(3.0, -2.0);
    mesh.vertices().map(|v| shear(place(v))).collect()
}

/// Sheared view with one vertex pulled over its neighbours.
fn folded(mesh: &DiskMesh) -> Embedding {
    let mut layout = sheared(mesh);
    let middle = mesh.vertex_count() / 2;
    layout[middle] += DVec2::new(0.4, 0.0);
    layout
}

fn ladder(settings: Settings, pins: Pins, layout: &Embedding) -> Flattener {
    let layout = Some(Arc::new(layout.clone()));
    Flattener::with_options(Options { settings, pins, layout, ..Options::default() })
}

fn finished(mesh: &DiskMesh, mut ladder: Flattener) -> (Vec<Step>, Result<Ending, SolveError>) {
    let mut steps = Vec::new();
    let ending = ladder.finish(mesh, Control::unattended(), |step| steps.push(step));
    (steps, ending)
}

/// Number of triangles without positive area.
fn flipped_count(mesh: &DiskMesh, layout: &Embedding) -> usize {
    let corners = |face| mesh.face(face).map(|v| layout[v]);
    mesh.faces().map(corners).filter(|[a, b, c]| (*b - *a).perp_dot(*c - *a) <= 0.0).count()
}

fn energy(mesh: &DiskMesh, step: &Step) -> f64 {
    distortion(mesh, &step.candidate.solution.embedding).summary.symmetric_dirichlet.mean
}

/// Remark on a step that contains a word.
fn remark_with<'a>(step: &'a Step, word: &str) -> &'a str {
    let note = step.candidate.note.as_deref().unwrap_or_default();
    note.split("; ").find(|remark| remark.contains(word)).expect("it is said")
}

fn one_of_each() -> Settings {
    Settings::new(Method::Auto, Family::Conformal)
}

#[test]
fn a_planar_layout_is_proved_and_stays_as_it_is() {
    let mesh = disk(bump(6));
    let layout = sheared(&mesh);
    for method in [Method::Auto, Method::Iterate] {
        let (steps, ending) =
            finished(&mesh, ladder(Settings::new(method.clone(), Family::Conformal), Pins::new(), &layout));
        assert_eq!((steps.len(), ending), (1, Ok(Ending::Planar)), "{method:?}");
        assert_eq!(steps[0].candidate.stage, Stage::Given);
        assert_eq!(steps[0].candidate.solution.embedding, layout, "to the last bit");
        assert!(steps[0].verdict.planar && steps[0].lies_as_given);
    }
}

#[test]
fn a_planar_layout_of_high_energy_or_of_more_than_32_bits_is_relaxed_only_where_that_is_asked_for() {
    let mesh = disk(bump(6));
    let stretched: Embedding = sheared(&mesh).iter().map(|z| DVec2::new(40.0 * z.x, z.y)).collect();
    let far: Embedding = sheared(&mesh).iter().map(|z| *z + DVec2::splat(1e7)).collect();
    for layout in [stretched, far] {
        let (steps, ending) = finished(&mesh, ladder(one_of_each(), Pins::new(), &layout));
        assert_eq!((steps.len(), ending), (1, Ok(Ending::Planar)));
        assert!(energy(&mesh, &steps[0]) > 20.0 || !steps[0].verdict.planar_in_f32);
        assert_eq!(steps[0].candidate.solution.embedding, layout, "to the last bit");
        // Constraints are met starting from the unchanged embedding.
        let pins = [0, 6, 24, 48].map(|v| (VertexId::new(v), layout[v as usize] + DVec2::new(0.001, 0.0)));
        let settings = Settings::new(Method::Continuation, Family::Conformal);
        let (steps, ending) = finished(&mesh, ladder(settings, hard_pins(pins), &layout));
        assert_eq!(ending, Ok(Ending::Planar));
        assert_eq!(
            [steps[0].candidate.stage.clone(), steps[1].candidate.stage.clone()],
            [Stage::Given, Stage::Continuation]
        );
        let relaxed = Settings { relax_rounds: Some(3), ..one_of_each() };
        let (steps, _) = finished(&mesh, ladder(relaxed, Pins::new(), &layout));
        assert!(steps.len() > 1 && steps[1].candidate.stage == Stage::Relax);
    }
}

#[test]
fn relaxing_begins_with_the_layout_and_stays_planar_at_every_step() {
    let mesh = disk(bump(6));
    let layout = sheared(&mesh);
    let settings = Settings { relax_rounds: Some(8), ..one_of_each() };
    let (steps, ending) = finished(&mesh, ladder(settings, Pins::new(), &layout));
    assert_eq!(ending, Ok(Ending::Planar));
    assert!(steps.len() > 2 && steps[1..].iter().all(|step| step.candidate.stage == Stage::Relax));
    assert!(steps.iter().all(|step| step.verdict.planar));
    let energies: Vec<f64> = steps.iter().map(|step| energy(&mesh, step)).collect();
    assert!(energies.is_sorted_by(|before, after| after <= before), "{energies:?}");
    assert!(energies[energies.len() - 1] < 0.6 * energies[0], "{energies:?}");
    // Steps lie over the embedding, at equal size.
    let middle = |z: &Embedding| z.iter().sum::<DVec2>() / z.len() as f64;
    let spread = |z: &Embedding| z.iter().map(|p| p.distance_squared(middle(z))).sum::<f64>();
    for step in &steps {
        let embedding = &step.candidate.solution.embedding;
        assert!(middle(embedding).distance(middle(&layout)) < 1e-9);
        assert!((spread(embedding) / spread(&layout) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn an_iteration_from_a_planar_layout_stays_there() {
    // Mean-value weights of an embedding reproduce it, boundary included.
    let mesh = disk(bump(6));
    let layout = sheared(&mesh);
    let mut ladder = ladder(Settings::new(Method::Iterate, Family::Conformal), Pins::new(), &layout);
    let first = ladder.step(&mesh, Control::unattended()).expect("the layout");
    assert_eq!(first.candidate.stage, Stage::Given);
    for _ in 0..3 {
        let step = ladder.step(&mesh, Control::unattended()).expect("a step by hand");
        assert_eq!(step.candidate.stage, Stage::Iterate);
        let moved = step.max_move.expect("there is a step before");
        assert!(moved < 1e-10 * layout.bounds().diameter(), "{moved}");
    }
}

#[test]
fn a_folded_layout_is_shown_with_its_faults_and_then_solved() {
    let mesh = disk(bump(6));
    let layout = folded(&mesh);
    let count = flipped_count(&mesh, &layout);
    assert!(count > 0);
    let (steps, ending) = finished(&mesh, ladder(one_of_each(), Pins::new(), &layout));
    assert_eq!(ending, Ok(Ending::Planar));
    assert_eq!((steps[0].candidate.stage.clone(), steps[0].verdict.flipped_faces.len()), (Stage::Given, count));
    assert_eq!(steps[0].candidate.solution.embedding, layout);
    assert_eq!(steps[1].candidate.stage, Stage::Natural);
    assert_message("start-folded-layout", remark_with(&steps[1], "restarted"));
    // Later steps equal those without a start, laid over the embedding.
    let (from_scratch, _) = finished(&mesh, Flattener::new(one_of_each(), Pins::new()));
    let shape = |step: &Step| energy(&mesh, step);
    assert!((shape(&steps[1]) - shape(&from_scratch[0])).abs() < 1e-9);
    assert!(size_ratio(&steps[1].candidate.solution.embedding, &layout) < 2.0);
}

/// Ratio of the larger embedding's size to the smaller one's.
fn size_ratio(a: &Embedding, b: &Embedding) -> f64 {
    let ratio = a.bounds().diameter() / b.bounds().diameter();
    ratio.max(ratio.recip())
}

#[test]
fn an_iteration_goes_on_from_a_folded_layout() {
    let mesh = disk(bump(6));
    let layout = folded(&mesh);
    for (method, next) in [(Method::Iterate, Stage::Iterate), (Method::VirtualBoundary, Stage::VirtualBoundary)] {
        let (steps, ending) =
            finished(&mesh, ladder(Settings::new(method.clone(), Family::Conformal), Pins::new(), &layout));
        assert_eq!(
            (steps[0].candidate.stage.clone(), steps[1].candidate.stage.clone()),
            (Stage::Given, next),
            "{method:?}"
        );
        assert_eq!(ending, Ok(Ending::Planar), "{method:?}");
    }
}

#[test]
fn a_mirror_image_is_shown_and_solved_the_right_way_up() {
    let mesh = disk(bump(4));
    let mirrored: Embedding = sheared(&mesh).iter().map(|z| DVec2::new(-z.x, z.y)).collect();
    let (steps, ending) = finished(&mesh, ladder(one_of_each(), Pins::new(), &mirrored));
    assert!(steps[0].verdict.planar && steps[0].verdict.mirrored);
    let last = &steps[steps.len() - 1];
    assert!(ending == Ok(Ending::Planar) && !last.verdict.mirrored);
    assert_message("start-mirrored-layout", remark_with(&steps[1], "restarted"));
    assert!(size_ratio(&last.candidate.solution.embedding, &mirrored) < 2.0);
}

#[test]
fn constraints_are_met_from_the_layout_one_to_one() {
    let mesh = disk(bump(6));
    let layout = sheared(&mesh);
    let Bounds { low, high } = layout.bounds();
    let inside = |x: f64, y: f64| low + DVec2::new(x, y) * (high - low);
    let count = u32::try_from(mesh.vertex_count()).expect("few");
    let pins =
        [(0, inside(0.1, 0.0)), (6, inside(0.9, -0.2)), (count - 1, inside(1.0, 1.1)), (count / 2, inside(0.5, 0.6))];
    let pins = hard_pins(pins.map(|(v, target)| (VertexId::new(v), target)));
    for method in [Method::Auto, Method::Continuation, Method::Matchmaker] {
        let settings = Settings::new(method.clone(), Family::Conformal);
        let (steps, ending) = finished(&mesh, ladder(settings, pins.clone(), &layout));
        assert_eq!(ending, Ok(Ending::Planar), "{method:?}");
        assert_eq!((steps[0].candidate.stage.clone(), &steps[0].candidate.solution.embedding), (Stage::Given, &layout));
        assert!(steps[0].is_of_planar_start(), "the constraints have no part in the layout");
        let stages: Vec<Stage> = steps.iter().map(|step| step.candidate.stage.clone()).collect();
        assert!(!stages.contains(&Stage::Natural) && !stages.contains(&Stage::Iterate), "{stages:?}");
        assert!(steps.iter().all(|step| step.verdict.is_one_to_one()));
        assert!(steps[steps.len() - 1].unmet().is_empty());
    }
}

#[test]
fn one_pin_moves_the_layout_and_turns_and_sizes_nothing() {
    let mesh = disk(bump(4));
    let layout = sheared(&mesh);
    let (vertex, target) = (VertexId::new(7), DVec2::new(0.25, 0.75));
    let (steps, ending) = finished(&mesh, ladder(one_of_each(), hard_pins([(vertex, target)]), &layout));
    assert_eq!((steps.len(), ending), (1, Ok(Ending::Planar)));
    let moved = &steps[0].candidate.solution.embedding;
    assert_eq!(moved[vertex], target);
    for (z, before) in moved.iter().zip(layout.iter()) {
        assert!((*z - *before).distance(target - layout[vertex]) < 1e-12);
    }
}

#[test]
fn a_layout_whose_hole_cannot_be_filled_as_it_is_stays_proved_and_is_not_relaxed() {
    // One corner of the middle hole is drawn in, past the middle of the four.
    let (mesh, layout) = drawn_in(0.15);
    for relax_rounds in [None, Some(5)] {
        let settings = Settings { relax_rounds, ..one_of_each() };
        let (steps, ending) = finished(&mesh, ladder(settings, Pins::new(), &layout));
        assert_eq!((steps.len(), ending), (1, Ok(Ending::Planar)));
        assert!(steps[0].verdict.planar && steps[0].verdict.is_filling_folded);
    }
    // If the filling is not folded, relaxation continues.
    let (mesh, layout) = drawn_in(0.9);
    let settings = Settings { relax_rounds: Some(5), ..one_of_each() };
    let (steps, ending) = finished(&mesh, ladder(settings, Pins::new(), &layout));
    assert!(ending == Ok(Ending::Planar) && steps.len() > 1);
    assert!(steps.iter().all(|step| step.verdict.planar && !step.verdict.is_filling_folded));
}

/// Three by three cells with a hole in the middle. The embedding moves the hole's far corner along its diagonal by
/// `share`.
fn drawn_in(share: f64) -> (DiskMesh, Embedding) {
    let TriMesh { mut positions, mut triangles, .. } = grid(3, 3);
    let middle = |t: &[VertexId; 3]| t.iter().map(|v| positions[v.index()].truncate()).sum::<DVec2>() / 3.0;
    triangles.retain(|t| !(middle(t).cmpgt(DVec2::ONE).all() && middle(t).cmplt(DVec2::splat(2.0)).all()));
    let real = u32::try_from(triangles.len()).expect("few");
    let corners = [5, 6, 10, 9].map(VertexId::new);
    let centre = VertexId::from_index(positions.len());
    triangles.extend((0..4).map(|k| [corners[k], corners[(k + 1) % 4], centre]));
    positions.push(corners.iter().map(|v| positions[v.index()]).sum::<glam::DVec3>() / 4.0);
    let polygon_of = Some((0..real).chain([freebound_core::mesh::FIRST_HOLE; 4]).collect());
    let mesh = disk(TriMesh { positions, triangles, polygon_of });
    let mut layout: Embedding = mesh.vertices().map(|v| mesh.position(v).truncate()).collect();
    layout[10] = DVec2::splat(1.0 + share);
    layout[16] = corners.iter().map(|v| layout[*v]).sum::<DVec2>() / 4.0;
    (mesh, layout)
}
