//! Mean-value iteration (paper §4): fixed points, treatments of pins, degenerate and squeezed embeddings.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq as _;
use freebound_core::flatten::{Flattener, Step, largest_move, solve_once};
use freebound_core::linear::Iteration;
use freebound_core::mesh::{DiskMesh, HalfedgeId, VertexId};
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, Stage, Treatment, hard_pins};
use freebound_core::verify::verdict;
use freebound_core::weights::plane_weights::{natural_in_plane, residuals_in_plane};
use freebound_testkit::BuiltIn;
use glam::DVec2;
use num_complex::Complex;

use super::shapes::{area_range, finger, interior_pair};
use freebound_testkit::surfaces::irregular_cube;
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, disk, grid};

/// Largest difference of least-squares solutions from a dense solver, relative to the extent.
const AGAINST_DENSE: f64 = 1e-9;

/// Largest move of a planar embedding in one step, relative to its diameter: the limit.
const FIXED_POINT: f64 = 1e-9;

fn steps_of(mesh: &DiskMesh, settings: Settings, pins: Pins) -> Vec<Step> {
    let mut steps = Vec::new();
    Flattener::new(settings, pins).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

/// Pins vertices at their positions in an embedding.
fn at_place(pinned: &[VertexId], embedding: &Embedding) -> Pins {
    hard_pins(pinned.iter().map(|&v| (v, embedding[v])))
}

/// Takes a step from an embedding, with some of its vertices pinned in place.
fn step(mesh: &DiskMesh, embedding: &Embedding, pinned: &[VertexId], treatment: Treatment) -> Embedding {
    let mut iteration =
        Iteration::new(mesh, embedding, &at_place(pinned, embedding), treatment, Control::unattended()).unwrap();
    iteration.step(mesh, embedding, Control::unattended()).unwrap().embedding
}

/// Flat mesh with vertices moved at random, far enough to fold it.
fn crumpled(columns: u32, random: &mut Random) -> (DiskMesh, Embedding) {
    let mesh = DiskMesh::try_from(grid(columns, columns)).unwrap();
    let mut jitter = || 1.4 * (random.unit() - 0.5);
    let embedding = mesh.mesh().positions.iter().map(|x| DVec2::new(x.x + jitter(), x.y + jitter())).collect();
    (mesh, embedding)
}

/// Minimiser of ‖A z‖ with the pins in place, from all n equations as a dense matrix.
fn dense_least_squares(mesh: &DiskMesh, embedding: &Embedding, pins: &Pins) -> Embedding {
    let equations = natural_in_plane(mesh, embedding, Control::unattended()).unwrap();
    let free: Vec<VertexId> = mesh.vertices().filter(|v| !pins.contains_key(v)).collect();
    let column = |v: VertexId| free.binary_search(&v).ok();
    let mut matrix: Mat<Complex<f64>> = Mat::zeros(mesh.vertex_count(), free.len());
    let mut rhs: Mat<Complex<f64>> = Mat::zeros(mesh.vertex_count(), 1);
    for h in mesh.halfedges() {
        let (tail, head) = (mesh.tail(h), mesh.head(h));
        let coefficient = equations.coefficients[h.index()];
        for (v, sign) in [(head, 1.0), (tail, -1.0)] {
            if let Some(column) = column(v) {
                matrix[(tail.index(), column)] += coefficient * sign;
            } else {
                let target = pins[&v].target;
                rhs[(tail.index(), 0)] -= coefficient * sign * Complex::new(target.x, target.y);
            }
        }
    }
    let solved = matrix.qr().solve_lstsq(&rhs);
    let mut found = embedding.clone();
    for (row, v) in free.iter().enumerate() {
        found[*v] = DVec2::new(solved[(row, 0)].re, solved[(row, 0)].im);
    }
    found
}

#[test]
fn least_squares_agrees_with_a_dense_solution_however_many_pins_there_are() {
    let mut random = Random(7);
    let (mesh, embedding) = crumpled(24, &mut random);
    for count in [1, 2, 3, 8, 9, 40, 500, 624] {
        let mut pinned: Vec<VertexId> = mesh.vertices().collect();
        while pinned.len() > count {
            pinned.swap_remove(random.below(u32::try_from(pinned.len()).unwrap()) as usize);
        }
        pinned.sort_unstable();
        let pins = at_place(&pinned, &embedding);
        let ours = step(&mesh, &embedding, &pinned, Treatment::LeastSquares);
        let dense = dense_least_squares(&mesh, &embedding, &pins);
        let apart = largest_move(&dense, &ours) / embedding.bounds().diameter();
        assert!(apart <= AGAINST_DENSE, "{count} pins: {apart:.1e} apart");
    }
}

#[test]
fn with_every_vertex_pinned_nothing_moves() {
    let (mesh, embedding) = crumpled(4, &mut Random(8));
    let all: Vec<VertexId> = mesh.vertices().collect();
    for treatment in [Treatment::Eliminate, Treatment::LeastSquares] {
        assert_eq!(step(&mesh, &embedding, &all, treatment), embedding);
    }
}

#[test]
fn pins_are_met_to_the_last_bit() {
    let (mesh, embedding) = crumpled(9, &mut Random(9));
    let pinned = [3, 17, 44, 71].map(VertexId::new);
    for treatment in [Treatment::Eliminate, Treatment::LeastSquares] {
        let moved = step(&mesh, &embedding, &pinned, treatment);
        assert!(pinned.iter().all(|v| moved[v.index()] == embedding[v]));
        assert!(largest_move(&embedding, &moved) > 0.1, "the others moved");
    }
}

fn assert_a_planar_embedding_is_a_fixed_point(meshes: Vec<(String, DiskMesh)>) {
    let mut random = Random(10);
    let mut tried = 0;
    for (name, mesh) in meshes {
        // The corridors of the maze are singular in 64 bits for nearly all pins: see `natural`.
        if mesh.face_count() > 25_000 || name.starts_with("maze") {
            continue;
        }
        let first = solve_once(&mesh, &Settings::default(), &Pins::new(), Control::unattended()).unwrap().embedding;
        if !verdict(&mesh, &first).planar {
            continue;
        }
        tried += 1;
        let [a, b] = interior_pair(&mesh, &mut random);
        let boundary = mesh.boundary_loop();
        for pinned in [[a, b], [boundary[0], boundary[boundary.len() / 2]]] {
            let mut pinned = pinned;
            pinned.sort_unstable();
            for treatment in [Treatment::Eliminate, Treatment::LeastSquares] {
                let moved = step(&mesh, &first, &pinned, treatment);
                let share = largest_move(&first, &moved) / first.bounds().diameter();
                println!("{name} {treatment:?} {pinned:?}: {share:.1e}");
                assert!(share <= FIXED_POINT, "{name}, {treatment:?}, pins {pinned:?}: moved by {share:.1e}");
            }
        }
    }
    assert!(tried >= 4);
}

#[test]
fn a_planar_embedding_is_a_fixed_point() {
    let examples = [BuiltIn::Ell, BuiltIn::Dome, BuiltIn::Cube, BuiltIn::BumpyCap];
    let examples = examples.map(|example| (example.name().to_owned(), disk(example.mesh())));
    assert_a_planar_embedding_is_a_fixed_point(examples.into());
}

corpus_test! {
    fn a_planar_embedding_is_a_fixed_point_in_the_corpus() {
        assert_a_planar_embedding_is_a_fixed_point(corpus_disks().iter().map(Entry::named_disk).collect());
    }
}

/// Runs on irregular cubes with two interior pins: number of planar ends, and largest number of steps.
fn on_cubes(count: u32, treatment: Treatment) -> (u32, usize) {
    let mut random = Random(0xc0be5);
    let (mut planar, mut most) = (0, 0);
    for case in 0..count {
        let mesh = irregular_cube(4 + case % 9, &mut random);
        let [a, b] = interior_pair(&mesh, &mut random);
        let distance = mesh.position(a).distance(mesh.position(b));
        let pins = hard_pins([(a, DVec2::ZERO), (b, DVec2::new(distance, 0.0))]);
        let settings = Settings { treatment: Some(treatment), ..Settings::new(Method::Iterate, Family::Conformal) };
        let steps = steps_of(&mesh, settings, pins);
        let last = steps.last().unwrap();
        if last.verdict.planar {
            planar += 1;
            most = most.max(last.index);
        } else {
            let folded: Vec<usize> = steps.iter().map(|step: &Step| step.verdict.defect_count()).collect();
            println!(
                "case {case}, {} faces, {treatment:?}: {} after {folded:?}",
                mesh.face_count(),
                last.verdict.summary()
            );
        }
    }
    (planar, most)
}

#[test]
fn least_squares_iteration_makes_irregular_cubes_planar() {
    let (planar, most) = on_cubes(18, Treatment::LeastSquares);
    assert_eq!(planar, 18, "at most {most} steps");
}

#[test]
#[ignore = "the larger set, for the figures of the README"]
fn least_squares_iteration_makes_ninety_irregular_cubes_planar() {
    let (planar, most) = on_cubes(90, Treatment::LeastSquares);
    let (eliminated, _) = on_cubes(90, Treatment::Eliminate);
    println!("of 90 with least squares: {planar} planar, in at most {most} steps; with elimination {eliminated}");
    assert_eq!(planar, 90);
}

#[test]
fn embeddings_squeezed_over_twenty_decades_iterate_without_breaking_down() {
    let mut random = Random(20);
    for (rings, around) in [(52, 12), (60, 12), (78, 16)] {
        let mesh = finger(rings, around, &mut random);
        let steps = steps_of(&mesh, Settings::new(Method::Iterate, Family::Conformal), Pins::new());
        let [least, greatest] = area_range(&mesh, &steps.last().unwrap().candidate.solution.embedding);
        let folds: Vec<usize> = steps.iter().map(|s| s.verdict.flipped_faces.len()).collect();
        println!("{rings} rings: areas from {least:.1e} to {greatest:.1e}, folds {folds:?}");
        assert!(greatest / least > 1e20, "{rings} rings are squeezed: {:.1e}", greatest / least);
        let end = steps.last().unwrap();
        assert!(end.verdict.planar, "{rings} rings: {} after {folds:?}", end.verdict.summary());
        assert!(end.index <= 2, "{rings} rings: {folds:?}");
    }
}

#[test]
fn beyond_what_doubles_can_tell_apart_the_ladder_ends_planar_all_the_same() {
    let mut random = Random(21);
    for rings in [78, 86] {
        let mesh = finger(rings, 12, &mut random);
        let steps = steps_of(&mesh, Settings::default(), Pins::new());
        assert!(!steps[0].verdict.planar, "{rings} rings: the natural boundary collapses faces");
        let last = steps.last().unwrap();
        println!("{rings} rings: {} after {} steps", last.verdict.summary(), steps.len());
        assert!(last.verdict.planar, "{rings} rings: {}", last.verdict.summary());
    }
}

#[test]
fn a_planar_embedding_satisfies_its_own_equations() {
    let spiral = disk(BuiltIn::Spiral.mesh());
    let flat: Embedding = spiral.mesh().positions.iter().map(|x| DVec2::new(x.x, x.y)).collect();
    let dome = disk(BuiltIn::Dome.mesh());
    let solved = solve_once(&dome, &Settings::default(), &Pins::new(), Control::unattended()).unwrap().embedding;
    for (mesh, embedding) in [(spiral, flat), (dome, solved)] {
        let equations = natural_in_plane(&mesh, &embedding, Control::unattended()).unwrap();
        let left = equations.residual(&mesh, &embedding, |_| true, Control::unattended()).unwrap();
        assert!(left <= 1e-14, "summed up from the weights: {left:.1e}");
        assert!(
            residuals_in_plane(&mesh, &embedding, Control::unattended()).unwrap().iter().all(|left| left.norm() == 0.0),
            "found without rounding"
        );
    }
}

#[test]
fn folds_of_a_large_regular_grid_are_taken_away() {
    // The left kernel of its equations is concentrated in two corners; leaving out equations of pins elsewhere would
    // be singular.
    for columns in [20, 40, 80] {
        let mesh = DiskMesh::try_from(grid(columns, columns)).unwrap();
        let mut embedding: Embedding = mesh.mesh().positions.iter().map(|x| DVec2::new(x.x, x.y)).collect();
        for v in mesh.vertices().skip(columns as usize + 3).step_by(columns as usize * 9 + 1) {
            if mesh.boundary_place(v).is_none() {
                embedding[v] += DVec2::new(1.4, 0.3);
            }
        }
        assert!(!verdict(&mesh, &embedding).planar);
        // The other two corners.
        let pinned = [columns, columns * (columns + 1)].map(VertexId::new);
        let after = step(&mesh, &embedding, &pinned, Treatment::LeastSquares);
        let result = verdict(&mesh, &after);
        assert!(result.planar, "{columns} columns: {}", result.summary());
    }
}

#[test]
fn a_large_regular_grid_stays_where_it_is() {
    // Its free-boundary system is singular in 64 bits for pins at these corners; no solve is needed.
    for columns in [40, 80] {
        let mesh = DiskMesh::try_from(grid(columns, columns)).unwrap();
        let mut run = Flattener::new(Settings::default(), Pins::new());
        let first = run.step(&mesh, Control::unattended()).unwrap();
        assert!(first.verdict.planar);
        let second = run.step(&mesh, Control::unattended()).unwrap();
        assert!(second.max_move.is_some_and(|moved| moved <= 1e-12 * f64::from(columns)), "{:?}", second.max_move);
    }
}

#[test]
fn what_an_embedding_leaves_is_what_its_equations_leave() {
    let mut random = Random(11);
    for columns in [3, 8, 20] {
        let (mesh, mut embedding) = crumpled(columns, &mut random);
        // A face without area, and one with a short edge of length zero.
        embedding[1] = embedding[0].midpoint(embedding[2]);
        embedding[5] = embedding[6];
        let equations = natural_in_plane(&mesh, &embedding, Control::unattended()).unwrap();
        let left = residuals_in_plane(&mesh, &embedding, Control::unattended()).unwrap();
        let size = |v: VertexId| {
            let term = |h: HalfedgeId| equations.coefficients[h.index()].norm();
            mesh.outgoing(v).map(term).sum::<f64>() * embedding.bounds().diameter()
        };
        for v in mesh.vertices() {
            let summed = equations.residual_of(&mesh, &embedding, v);
            let apart = (summed - left[v.index()]).norm() / size(v);
            assert!(apart <= 1e-13, "{v}: {summed} and {}, {apart:.1e} apart", left[v.index()]);
        }
    }
}

#[test]
fn a_degenerate_embedding_says_that_weights_were_bounded_and_goes_on() {
    let mesh = DiskMesh::try_from(grid(5, 5)).unwrap();
    let flat = |x: &glam::DVec3| DVec2::new(x.x, x.y);
    let mut embedding: Embedding = mesh.mesh().positions.iter().map(flat).collect();
    // Three coinciding vertices collapse a face to a point and others to segments; a fourth flattens a face.
    let [a, b, c, d] = [14, 15, 21, 8];
    embedding[b] = embedding[a];
    embedding[c] = embedding[a];
    embedding[d] = embedding[7].midpoint(embedding[9]);
    let corners = [0, 5].map(VertexId::new);
    let mut iteration = Iteration::new(
        &mesh,
        &embedding,
        &at_place(&corners, &embedding),
        Treatment::LeastSquares,
        Control::unattended(),
    )
    .unwrap();
    let solution = iteration.step(&mesh, &embedding, Control::unattended()).unwrap();
    assert!(solution.linear.unwrap().bounded_corners > 0);
    assert!(solution.embedding.iter().all(|z| z.is_finite()));
    let after = verdict(&mesh, &solution.embedding);
    assert!(after.zero_area_faces < verdict(&mesh, &embedding).zero_area_faces, "{}", after.summary());
}

#[test]
fn the_iteration_stops_at_the_limit_and_can_be_taken_on_by_hand() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let pins = hard_pins([(VertexId::new(0), DVec2::ZERO), (VertexId::new(1), DVec2::X)]);
    let settings = Settings { max_steps: Some(2), ..Settings::new(Method::Iterate, Family::Wachspress) };
    let mut run = Flattener::new(settings, pins);
    let mut taken = 0;
    let ending = run.finish(&mesh, Control::unattended(), |_| taken += 1).unwrap();
    println!("{ending:?} after {taken}");
    assert!(taken <= 3);
    let further = run.step(&mesh, Control::unattended()).unwrap();
    assert_eq!((further.candidate.stage, further.index), (Stage::Iterate, taken));
}
