//! Soft pins, alone and mixed with hard ones: against dense least squares, and the meaning of their weights.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use freebound_core::flatten::{Prepared, largest_move, solve_once};
use freebound_core::linear::Iteration;
use freebound_core::mesh::{DiskMesh, TriMesh, VertexId};
use freebound_core::problem::{
    Control, Embedding, Family, Method, Pin, Pins, Settings, SolveError, Treatment, hard_pins,
};
use freebound_core::weights::plane_weights::natural_in_plane;
use freebound_testkit::BuiltIn;
use freebound_testkit::surfaces::bump;
use glam::DVec2;
use num_complex::Complex;

use super::natural::corner_terms;
use freebound_testkit::{Random, disk};

/// Largest difference between two algorithms, relative to the diameter of the solution.
const AGREE: f64 = 1e-9;

const FAMILIES: [Family; 4] = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.5)];

fn v(number: u32) -> VertexId {
    VertexId::new(number)
}

/// Mesh scaled to mean edge length 1.
fn normalised(mesh: &DiskMesh) -> TriMesh {
    let lengths: Vec<f64> =
        mesh.edges().map(|edge| mesh.ends(edge)).map(|[a, b]| mesh.position(a).distance(mesh.position(b))).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    let positions = mesh.mesh().positions.iter().map(|x| *x / mean).collect();
    TriMesh { positions, ..mesh.mesh().clone() }
}

/// Entries of a row by column, and its right-hand side.
type Row = (Vec<(usize, Complex<f64>)>, Complex<f64>);

/// Rows of a dense least-squares problem.
pub(crate) struct Dense {
    rows: Vec<Row>,
}

impl Dense {
    /// Minimiser with the hard pins at their targets.
    pub(crate) fn solve(mut self, count: usize, pins: &Pins) -> Embedding {
        for (vertex, pin) in pins {
            if let freebound_core::problem::PinKind::Soft(weight) = pin.kind {
                let target = Complex::new(pin.target.x, pin.target.y);
                self.rows.push((vec![(vertex.index(), weight.into())], target * weight));
            }
        }
        let is_hard = |i: usize| pins.get(&VertexId::from_index(i)).filter(|pin| pin.kind.is_hard());
        let free: Vec<usize> = (0..count).filter(|&i| is_hard(i).is_none()).collect();
        let mut matrix: Mat<Complex<f64>> = Mat::zeros(self.rows.len(), free.len());
        let mut right: Mat<Complex<f64>> = Mat::zeros(self.rows.len(), 1);
        for (row, (entries, rhs)) in self.rows.iter().enumerate() {
            right[(row, 0)] += rhs;
            for &(at, value) in entries {
                match is_hard(at) {
                    None => matrix[(row, free.binary_search(&at).unwrap())] += value,
                    Some(pin) => right[(row, 0)] -= value * Complex::new(pin.target.x, pin.target.y),
                }
            }
        }
        let solved = matrix.qr().solve_lstsq(&right);
        let mut found: Embedding = (0..count).map(|i| is_hard(i).map_or(DVec2::ZERO, |pin| pin.target)).collect();
        for (column, &i) in free.iter().enumerate() {
            found[i] = DVec2::new(solved[(column, 0)].re, solved[(column, 0)].im);
        }
        found
    }
}

/// Vertex equations at mean edge length 1, assembled corner by corner, without those of some vertices.
pub(crate) fn dense_equations(mesh: &DiskMesh, settings: &Settings, without: impl Fn(VertexId) -> bool) -> Dense {
    let mesh = disk(normalised(mesh));
    let mut rows = vec![(Vec::new(), Complex::ZERO); mesh.vertex_count()];
    for face in mesh.faces() {
        let f = mesh.face(face);
        for k in 0..3 {
            let corner = [f[k], f[(k + 1) % 3], f[(k + 2) % 3]];
            let terms = corner_terms(corner.map(|v| mesh.position(v)), settings);
            if !without(corner[0]) {
                rows[corner[0].index()].0.extend(corner.iter().map(|v| v.index()).zip(terms));
            }
        }
    }
    Dense { rows }
}

/// Random constraints, about half of them hard; at least two are.
pub(crate) fn mixed(count: u32, weights: impl Fn(&mut Random) -> f64, mesh: &DiskMesh, random: &mut Random) -> Pins {
    let mut pins = Pins::new();
    while pins.len() < count as usize {
        let vertex = v(random.below(u32::try_from(mesh.vertex_count()).unwrap()));
        let target = DVec2::new(random.unit(), random.unit());
        let exact = pins.len() < 2 || random.below(2) == 0;
        pins.insert(vertex, if exact { Pin::hard(target) } else { Pin::weighted(target, weights(random)) });
    }
    pins
}

fn solve(mesh: &DiskMesh, settings: &Settings, pins: &Pins) -> Embedding {
    solve_once(mesh, settings, pins, Control::unattended()).unwrap().embedding
}

pub(crate) fn apart(a: &Embedding, b: &Embedding) -> f64 {
    largest_move(a, b) / a.bounds().diameter()
}

#[test]
fn mixed_constraints_agree_with_dense_least_squares_in_every_family() {
    let mesh = disk(bump(13));
    let mut random = Random(11);
    for family in FAMILIES {
        for (count, treatment) in
            [(3, Treatment::LeastSquares), (9, Treatment::LeastSquares), (9, Treatment::Eliminate)]
        {
            let pins = mixed(count, |random| 10_f64.powf(4.0 * random.unit() - 2.0), &mesh, &mut random);
            let settings = Settings { treatment: Some(treatment), ..Settings::new(Method::Natural, family) };
            let is_eliminated =
                |v| treatment == Treatment::Eliminate && pins.get(&v).is_some_and(|pin| pin.kind.is_hard());
            let dense = dense_equations(&mesh, &settings, is_eliminated).solve(mesh.vertex_count(), &pins);
            let error = apart(&dense, &solve(&mesh, &settings, &pins));
            assert!(error <= AGREE, "{family} {treatment:?} {count}: {error:.1e}");
        }
    }
}

#[test]
fn weighted_constraints_alone_agree_with_dense_least_squares() {
    let mesh = disk(bump(11));
    for count in [2, 5, 20] {
        let mut random = Random(u64::from(count));
        let pins: Pins = mixed(count, |_| 1.0, &mesh, &mut random)
            .into_iter()
            .map(|(v, pin)| (v, Pin::weighted(pin.target, 0.1 + 3.0 * random.unit())))
            .collect();
        for family in FAMILIES {
            let settings = Settings::new(Method::Natural, family);
            let dense = dense_equations(&mesh, &settings, |_| false).solve(mesh.vertex_count(), &pins);
            let error = apart(&dense, &solve(&mesh, &settings, &pins));
            assert!(error <= AGREE, "{family} {count}: {error:.1e}");
        }
    }
}

#[test]
fn a_step_of_the_iteration_with_weighted_constraints_agrees_with_dense_least_squares() {
    let mesh = disk(bump(11));
    let mut random = Random(5);
    let pins = mixed(7, |random| 0.1 + 3.0 * random.unit(), &mesh, &mut random);
    let start = solve(&mesh, &Settings::new(Method::Natural, Family::Conformal), &pins);
    let mut iteration = Iteration::new(&mesh, &start, &pins, Treatment::LeastSquares, Control::unattended()).unwrap();
    let found = iteration.step(&mesh, &start, Control::unattended()).unwrap().embedding;
    // Oracle: the equations at mean edge length 1.
    let edges = mesh.edges().map(|edge| mesh.ends(edge));
    let lengths: Vec<f64> = edges.map(|[a, b]| start[a.index()].distance(start[b.index()])).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    let flat: Embedding = start.iter().map(|z| *z / mean).collect();
    let equations = natural_in_plane(&mesh, &flat, Control::unattended()).unwrap();
    // Coefficients are scaled by a power of two near mean edge length 1; a mean-value row scales like an inverse
    // length.
    let probe = mesh.halfedges().find(|&h| !mesh.is_boundary_edge(mesh.edge_of(h))).unwrap();
    let unit = raw_coefficient(&mesh, &flat, probe) / equations.coefficients[probe.index()].re;
    let mut rows = vec![(Vec::new(), Complex::ZERO); mesh.vertex_count()];
    for h in mesh.halfedges() {
        let (tail, head) = (mesh.tail(h).index(), mesh.head(h).index());
        let value = equations.coefficients[h.index()] * unit;
        rows[tail].0.extend([(head, value), (tail, -value)]);
    }
    let dense = Dense { rows }.solve(mesh.vertex_count(), &pins);
    let error = apart(&dense, &found);
    assert!(error <= AGREE, "{error:.1e}");
}

/// Mean-value coefficient of an inner halfedge, from the angles beside it.
fn raw_coefficient(mesh: &DiskMesh, flat: &[DVec2], h: freebound_core::mesh::HalfedgeId) -> f64 {
    let at = |v: VertexId| flat[v.index()];
    let (tail, head) = (at(mesh.tail(h)), at(mesh.head(h)));
    let half_tangent = |third: DVec2| ((head - tail).angle_to(third - tail).abs() / 2.0).tan();
    let thirds = [mesh.head(mesh.next(h)), mesh.head(mesh.next(mesh.twin(h)))].map(at);
    thirds.into_iter().map(half_tangent).sum::<f64>() / head.distance(tail)
}

#[test]
fn a_weight_means_the_same_at_every_size_of_the_mesh() {
    let small = disk(bump(9));
    let positions = small.mesh().positions.iter().map(|x| *x * 1000.0).collect();
    let large = disk(TriMesh { positions, ..small.mesh().clone() });
    let mut random = Random(2);
    let pins = mixed(6, |_| 0.7, &small, &mut random);
    for family in FAMILIES {
        for method in [Method::Natural, Method::Iterate] {
            let settings = Settings { max_steps: Some(1), ..Settings::new(method.clone(), family) };
            let last = |mesh: &DiskMesh| {
                let mut run = freebound_core::flatten::Flattener::new(settings.clone(), pins.clone());
                let mut found = Embedding::default();
                run.finish(mesh, Control::unattended(), |step| found = step.candidate.solution.embedding).unwrap();
                found
            };
            let error = apart(&last(&small), &last(&large));
            assert!(error <= AGREE, "{family} {method:?}: {error:.1e}");
        }
    }
}

#[test]
fn heavier_weights_bring_vertices_nearer_and_very_heavy_ones_are_as_good_as_hard() {
    let mesh = disk(bump(9));
    let mut random = Random(4);
    let hard = mixed(6, |_| 1.0, &mesh, &mut random);
    let hard = hard_pins(hard.into_iter().map(|(v, pin)| (v, pin.target)));
    for family in FAMILIES {
        let settings = Settings::new(Method::Natural, family);
        let exact = solve(&mesh, &settings, &hard);
        // In every least-squares problem the sum of squared distances falls as a common weight grows.
        let error = |weight: f64| {
            let pins: Pins = hard.iter().map(|(&v, pin)| (v, Pin::weighted(pin.target, weight))).collect();
            let found = solve(&mesh, &settings, &pins);
            hard.iter().map(|(v, pin)| found[v.index()].distance_squared(pin.target)).sum::<f64>().sqrt()
        };
        let errors = [0.01, 0.1, 1.0, 10.0, 100.0, 1e6].map(error);
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{family}: {errors:?}");
        assert!(errors[5] < 1e-9, "{family}: {errors:?}");
        let pins: Pins = hard.iter().map(|(&v, pin)| (v, Pin::weighted(pin.target, 1e9))).collect();
        assert!(apart(&exact, &solve(&mesh, &settings, &pins)) < 1e-9, "{family}");
    }
}

#[test]
fn the_face_takes_its_landmarks_with_any_weight() {
    let mesh = disk(BuiltIn::Face.mesh());
    for weight in [1e-3, 1.0, 10.0, 1e3, 1e6] {
        for family in [Family::Conformal, Family::MeanValue] {
            let landmarks = BuiltIn::Face.landmarks();
            let pins: Pins = landmarks.iter().map(|l| (l.vertex, Pin::weighted(l.target.into(), weight))).collect();
            let settings = Settings::new(Method::Natural, family);
            let solved = solve_once(&mesh, &settings, &pins, Control::unattended());
            let residual = solved.map(|solution| solution.linear.unwrap().residual);
            assert!(residual.as_ref().is_ok_and(|&residual| residual < 1e-12), "{weight} {family}: {residual:?}");
        }
    }
}

#[test]
fn the_weighted_treatment_gives_hard_constraints_the_default_weight() {
    let mesh = disk(bump(7));
    let hard = hard_pins([(v(3), DVec2::ZERO), (v(30), DVec2::X), (v(40), DVec2::ONE)]);
    let weighted: Pins = hard.iter().map(|(&v, pin)| (v, Pin::weighted(pin.target, Pin::DEFAULT_WEIGHT))).collect();
    let settings = Settings::new(Method::Natural, Family::Conformal);
    let asked = Settings { treatment: Some(Treatment::Weighted), ..settings.clone() };
    assert_eq!(solve(&mesh, &asked, &hard), solve(&mesh, &settings, &weighted));
}

#[test]
fn a_weighted_constraint_alone_moves_the_map_onto_its_target_as_a_hard_one_does() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let target = DVec2::new(0.25, -7.5);
    for family in FAMILIES {
        let settings = Settings::new(Method::Natural, family);
        let soft = solve(&mesh, &settings, &Pins::from([(v(5), Pin::weighted(target, 0.001))]));
        assert_eq!(soft[5], target);
        assert_eq!(soft, solve(&mesh, &settings, &hard_pins([(v(5), target)])));
    }
}

#[test]
fn exact_constraints_are_met_to_the_last_bit_beside_weighted_ones_at_every_step() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let mut random = Random(8);
    let pins = mixed(9, |_| 1.0, &mesh, &mut random);
    let mut run = freebound_core::flatten::Flattener::new(
        Settings { max_steps: Some(5), ..Settings::new(Method::Iterate, Family::default()) },
        pins.clone(),
    );
    let mut count = 0;
    run.finish(&mesh, Control::unattended(), |step| {
        count += 1;
        for (vertex, pin) in pins.iter().filter(|(_, pin)| pin.kind.is_hard()) {
            assert_eq!(step.candidate.solution.embedding[vertex], pin.target, "step {}", step.index);
        }
    })
    .unwrap();
    assert!(count > 1, "it folds at first");
}

#[test]
fn weights_that_pull_nowhere_are_refused_and_weighted_constraints_may_share_a_place() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let settings = Settings::default();
    for weight in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let pins = Pins::from([(v(1), Pin::hard(DVec2::ZERO)), (v(2), Pin::weighted(DVec2::X, weight))]);
        let error = solve_once(&mesh, &settings, &pins, Control::unattended()).unwrap_err();
        assert!(matches!(error, SolveError::WeightNotPositive { vertex, .. } if vertex == v(2)), "{error}");
    }
    let shared = Pins::from([
        (v(1), Pin::hard(DVec2::ZERO)),
        (v(2), Pin::weighted(DVec2::ZERO, 1.0)),
        (v(30), Pin::hard(DVec2::X)),
        (v(31), Pin::weighted(DVec2::ZERO, 1.0)),
    ]);
    assert!(solve_once(&mesh, &settings, &shared, Control::unattended()).is_ok());
}

#[test]
fn moving_pins_by_their_column_is_solving_anew() {
    let mesh = disk(bump(11));
    let mut random = Random(9);
    for family in FAMILIES {
        for treatment in [Treatment::LeastSquares, Treatment::Eliminate] {
            let pins = mixed(8, |_| 0.5, &mesh, &mut random);
            let settings = Settings { treatment: Some(treatment), ..Settings::new(Method::Natural, family) };
            let prepared = Prepared::new(&mesh, &settings, &pins, Control::unattended()).unwrap();
            let base = prepared.solve(&mesh, &pins, Control::unattended()).unwrap().embedding;
            let by = DVec2::new(-0.3, 0.8);
            let ids: Vec<VertexId> = pins.keys().copied().collect();
            for moved in [&ids[..1], &ids[3..4], &ids[2..6], &ids[..]] {
                let column = prepared.column(&mesh, moved).unwrap();
                let followed: Embedding = base.iter().zip(&column).map(|(z, c)| *z + by.rotate(*c)).collect();
                let mut there = pins.clone();
                for v in moved {
                    there.get_mut(v).unwrap().target += by;
                }
                let error = apart(&solve(&mesh, &settings, &there), &followed);
                assert!(error <= AGREE, "{family} {treatment:?} {moved:?}: {error:.1e}");
            }
        }
    }
}
