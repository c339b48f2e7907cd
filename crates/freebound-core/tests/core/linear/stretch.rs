//! Stretch minimisation: stretch falls from solve to solve, weights stay positive, and it ends when the next solve
//! would raise it.
//!
//! Stretch is computed here independently, from the partial derivatives of Sander et al. 2001, §3. The computation
//! checks `distortion` and the divisors of the weights.

use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::linear::StretchMinimising;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, Spacing, Stage};
use freebound_core::verify::distortion;
use freebound_core::weights::equations;
use freebound_testkit::BuiltIn;
use glam::DVec3;

use freebound_testkit::{
    assert_message, corpus_disks, corpus_entry, corpus_test, data_entry, disk, sheet, stacked, tube,
};

const ON_CIRCLE: Method = Method::Stretch(BoundaryShape::Circle);

fn run(mesh: &DiskMesh, settings: Settings) -> (Vec<Step>, Ending) {
    let mut steps = Vec::new();
    let ending = Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| steps.push(step));
    (steps, ending.expect("solvable"))
}

fn settings(method: Method) -> Settings {
    Settings::new(method, Family::default())
}

/// Twice the area of a face on the surface and in the plane, and its squared L² stretch: `(|S_s|² + |S_t|²) / 2`
/// with the derivatives of the surface by the coordinates of the plane.
fn of_face(mesh: &DiskMesh, embedding: &Embedding, corners: [VertexId; 3]) -> [f64; 3] {
    let [q1, q2, q3] = corners.map(|v| mesh.position(v));
    let [p1, p2, p3] = corners.map(|v| embedding[v]);
    let double_area = (p2 - p1).perp_dot(p3 - p1);
    let by_s = (q1 * (p2.y - p3.y) + q2 * (p3.y - p1.y) + q3 * (p1.y - p2.y)) / double_area;
    let by_t = (q1 * (p3.x - p2.x) + q2 * (p1.x - p3.x) + q3 * (p2.x - p1.x)) / double_area;
    let on_surface = (q2 - q1).cross(q3 - q1).length();
    [on_surface, double_area.abs(), f64::midpoint(by_s.length_squared(), by_t.length_squared())]
}

/// L² stretch of the whole map at equal total areas, and of each vertex relative to it.
fn stretches(mesh: &DiskMesh, embedding: &Embedding) -> (f64, Vec<f64>) {
    let (mut total, mut in_plane, mut weighted) = (0.0, 0.0, 0.0);
    let mut around = vec![[0.0; 2]; mesh.vertex_count()];
    for face in mesh.real_faces() {
        let [area, flat, square] = of_face(mesh, embedding, mesh.face(face));
        total += area;
        in_plane += flat;
        weighted += area * square;
        for v in mesh.face(face) {
            around[v.index()][0] += area * square;
            around[v.index()][1] += area;
        }
    }
    let whole = weighted / total;
    let local = around.iter().map(|[square, area]| (square / area / whole).sqrt()).collect();
    ((whole * in_plane / total).sqrt(), local)
}

/// Numbers in a step's note: its stretch, and that of the next solve if that is not less.
fn stretches_said(step: &Step) -> Vec<f64> {
    let note = step.candidate.note.as_deref().expect("each step says its stretch");
    note.split([' ', ',', ':']).filter_map(|word| word.parse().ok()).collect()
}

/// Built-in meshes, and two of `tests/data`.
fn meshes() -> Vec<(String, DiskMesh)> {
    let built_in = [BuiltIn::Dome, BuiltIn::BumpyCap, BuiltIn::Cube, BuiltIn::Face];
    let built_in = built_in.map(|example| (example.name().to_owned(), disk(example.mesh())));
    built_in.into_iter().chain([data_entry("small-cap").named_disk(), data_entry("open-cube").named_disk()]).collect()
}

fn corpus_meshes() -> Vec<(String, DiskMesh)> {
    ["nefertiti_562.obj", "fran_face.obj"].map(|file| corpus_entry(file).named_disk()).into()
}

fn assert_stretch_falls_in_every_step_and_every_step_is_planar(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        let (steps, ending) = run(&mesh, settings(ON_CIRCLE));
        assert_eq!(ending, Ending::Planar, "{name}");
        assert!(steps.len() > 1, "{name}: mean-value weights are not the minimum");
        let mut before = f64::INFINITY;
        for (index, step) in steps.iter().enumerate() {
            assert!(step.candidate.stage == Stage::Stretch(BoundaryShape::Circle) && step.index == index);
            assert!(step.verdict.planar, "{name}, step {index}: {}", step.verdict.summary());
            let summary = distortion(&mesh, &step.candidate.solution.embedding).summary;
            let (stretch, _) = stretches(&mesh, &step.candidate.solution.embedding);
            assert!((summary.stretch_l2 / stretch - 1.0).abs() < 1e-9, "{name}: {} {stretch}", summary.stretch_l2);
            assert!(stretch < before, "{name}, step {index}: {stretch} after {before}");
            before = stretch;
            let said = stretches_said(step);
            assert!((said[0] - stretch).abs() < 1e-6, "{said:?}: {stretch}");
            assert!(step.candidate.solution.linear.expect("a linear solve").residual < 1e-10);
            let analysed = step.candidate.solution.seconds.analyze > 0.0;
            assert_eq!(analysed, index == 0, "{name}: one analysis serves all steps");
        }
    }
}

#[test]
fn stretch_falls_in_every_step_and_every_step_is_planar() {
    assert_stretch_falls_in_every_step_and_every_step_is_planar(meshes());
}

corpus_test! {
    fn stretch_falls_in_every_step_and_every_step_is_planar_in_the_corpus() {
        assert_stretch_falls_in_every_step_and_every_step_is_planar(corpus_meshes());
    }
}

fn assert_it_ends_where_the_next_solve_would_not_fall(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        let (steps, _) = run(&mesh, settings(ON_CIRCLE));
        let said = stretches_said(steps.last().expect("a step"));
        let minimising = StretchMinimising::new(&mesh, &BoundaryShape::Circle, Spacing::Chord, Control::unattended())
            .expect("a disk");
        let mut solved = minimising.first(&mesh, Control::unattended()).expect("solvable");
        for _ in 1..steps.len() {
            solved = minimising.after(&solved, &mesh, Control::unattended()).expect("solvable");
        }
        let beyond = minimising.after(&solved, &mesh, Control::unattended()).expect("solvable");
        let [last, next] = [&solved, &beyond].map(|solved| stretches(&mesh, &solved.embedding).0);
        assert!(next >= last * (1.0 - 2e-9), "{name}: {next} after {last}");
        let is_near = |(said, found): (&f64, f64)| (said - found).abs() < 1e-6;
        assert!(said.len() == 2 && said.iter().zip([last, next]).all(is_near), "{name}: {said:?}");
    }
}

#[test]
fn it_ends_where_the_next_solve_would_not_fall() {
    assert_it_ends_where_the_next_solve_would_not_fall(meshes());
}

corpus_test! {
    fn it_ends_where_the_next_solve_would_not_fall_in_the_corpus() {
        assert_it_ends_where_the_next_solve_would_not_fall(corpus_meshes());
    }
}

fn assert_weights_are_divided_by_the_stretch_of_the_neighbour_and_stay_positive(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        let minimising = StretchMinimising::new(&mesh, &BoundaryShape::Circle, Spacing::Even, Control::unattended())
            .expect("a disk");
        let mut solved = minimising.first(&mesh, Control::unattended()).expect("solvable");
        assert_eq!(
            solved.weights(),
            equations::barycentric(&mesh, 0.0, Control::unattended()).expect("finite").coefficients
        );
        for _ in 0..3 {
            let before = solved.clone();
            solved = minimising.after(&before, &mesh, Control::unattended()).expect("solvable");
            let (_, local) = stretches(&mesh, &before.embedding);
            for link in mesh.links() {
                let [old, new] = [&before, &solved].map(|solved| solved.weights()[link.index()]);
                assert!(new > 0.0 && new.is_finite(), "{name}: weight {new}");
                let expected = old / local[mesh.head(link).index()];
                assert!((new / expected - 1.0).abs() < 1e-9, "{name}: {new} is not {expected}");
            }
        }
    }
}

#[test]
fn weights_are_divided_by_the_stretch_of_the_neighbour_and_stay_positive() {
    assert_weights_are_divided_by_the_stretch_of_the_neighbour_and_stay_positive(meshes());
}

corpus_test! {
    fn weights_are_divided_by_the_stretch_of_the_neighbour_and_stay_positive_in_the_corpus() {
        assert_weights_are_divided_by_the_stretch_of_the_neighbour_and_stay_positive(corpus_meshes());
    }
}

#[test]
fn the_boundary_stays_on_its_shape() {
    let mesh = disk(BuiltIn::BumpyCap.mesh());
    let (steps, _) = run(&mesh, settings(Method::Stretch(BoundaryShape::Square)));
    let corners = |step: &Step| {
        let embedding = &step.candidate.solution.embedding;
        let bounds = embedding.bounds();
        let on_side = |z: &glam::DVec2| {
            let from_low = (*z - bounds.low).min_element();
            from_low.min((bounds.high - *z).min_element()) < 1e-12 * bounds.diameter()
        };
        embedding.boundary(&mesh).iter().all(on_side)
    };
    assert!(steps.len() > 1 && steps.iter().all(corners));
    assert!(
        steps.iter().all(|step| step.candidate.has_convex_boundary()
            && step.candidate.solution.pins.len() == mesh.boundary_loop().len())
    );
}

#[test]
fn a_limit_of_steps_ends_it_and_is_said() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let (all, _) = run(&mesh, settings(ON_CIRCLE));
    let mut reasons = Vec::new();
    for limit in 0..3 {
        let (steps, _) = run(&mesh, Settings { max_steps: Some(limit), ..settings(ON_CIRCLE) });
        assert_eq!(steps.len(), (limit + 1).min(all.len()));
        if steps.len() < all.len() {
            let note = steps.last().and_then(|step| step.candidate.note.as_deref()).expect("a note");
            let (_, reason) = note.split_once(": ").expect("a reason");
            reasons.push(reason.to_owned());
        }
        for (limited, free) in steps.iter().zip(&all) {
            assert_eq!(limited.candidate.solution.embedding, free.candidate.solution.embedding);
        }
    }
    reasons.dedup();
    assert_message("stretch-limit", &reasons.join("\n"));
}

/// True if a last step states its reason, which follows a colon.
fn has_reason(last: &Step) -> bool {
    last.candidate.note.as_deref().is_some_and(|note| note.contains(": "))
}

#[test]
fn what_rounding_collapses_ends_honestly() {
    // Faces deep inside exceed 64-bit precision, so their stretch cannot be computed.
    let mut random = freebound_testkit::Random(7);
    let meshes = [tube(3, 60), tube(3, 240), stacked(60, 4, &mut random), stacked(240, 4, &mut random)];
    let mut collapsed = 0;
    for mesh in meshes {
        let mesh = disk(mesh);
        let (steps, _) = run(&mesh, settings(ON_CIRCLE));
        let last = steps.last().expect("a step");
        assert!(has_reason(last), "{:?}", last.candidate.note);
        collapsed += usize::from(!last.verdict.flipped_faces.is_empty());
    }
    assert!(collapsed > 0, "otherwise this tests nothing");
}

#[test]
fn a_flat_sheet_on_its_own_outline_is_at_the_minimum_at_once() {
    // Mean-value weights reproduce a planar mesh with an unchanged boundary: nothing is stretched.
    let mesh = disk(sheet(8, 0.0));
    let flat: Vec<DVec3> = mesh.mesh().positions.clone();
    assert!(flat.iter().all(|p| p.z == 0.0));
    let (steps, _) = run(&mesh, settings(Method::Stretch(BoundaryShape::Square)));
    assert_eq!(steps.len(), 1, "{:?}", steps.iter().map(|step| step.candidate.note.clone()).collect::<Vec<_>>());
    let (stretch, _) = stretches(&mesh, &steps[0].candidate.solution.embedding);
    assert!((stretch - 1.0).abs() < 1e-12, "{stretch}");
    assert_message("stretch-minimum", steps[0].candidate.note.as_deref().expect("a reason"));
}

corpus_test! {
    #[ignore = "all disks of the corpus take half a minute without optimisation"]
    fn every_disk_of_the_corpus_ends_with_less_stretch_and_a_reason() {
        for entry in corpus_disks() {
            let mesh = entry.disk();
            let start = std::time::Instant::now();
            let (steps, _) = run(&mesh, settings(ON_CIRCLE));
            let [first, last] = [&steps[0], &steps[steps.len() - 1]]
                .map(|step| distortion(&mesh, &step.candidate.solution.embedding).summary.stretch_l2);
            println!(
                "{}: {} faces, {} steps, L² {first:.3} to {last:.3}, {:.2} s, {}, {}",
                entry.file,
                mesh.face_count(),
                steps.len(),
                start.elapsed().as_secs_f64(),
                steps[steps.len() - 1].verdict.summary(),
                steps[steps.len() - 1].candidate.note.as_deref().unwrap_or_default()
            );
            assert!(steps.len() == 1 || last < first, "{}", entry.file);
            assert!(has_reason(&steps[steps.len() - 1]), "{}: {:?}", entry.file, steps[steps.len() - 1].candidate.note);
        }
    }
}
