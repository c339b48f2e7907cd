//! Equation of one vertex (paper, eq. 2 and 3) against the system of all of them.

use freebound_core::flatten::equation_of_step;
use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, NoEquation, Pins, Settings, Stage, Treatment, WeightSource,
};
use freebound_core::weights::equations::Equations;
use freebound_core::weights::plane_weights::natural_in_plane;
use freebound_core::weights::{VertexEquation, equations};
use freebound_testkit::BuiltIn;
use glam::DVec2;
use num_complex::Complex;

use freebound_testkit::{Random, corpus_entry, corpus_test, disk, grid, honeycomb, quad_sheet};

/// Relative difference of sums in another order, relative to the sizes of their terms.
const ROUNDING: f64 = 1e-12;

/// Residual of a solved equation, relative to the sizes of its terms.
const SOLVED: f64 = 1e-8;

fn steps_of(mesh: &DiskMesh, settings: Settings) -> Vec<Step> {
    let mut steps = Vec::new();
    Flattener::new(settings, Pins::new()).finish(mesh, Control::unattended(), |step| steps.push(step)).unwrap();
    steps
}

/// Linear step with its embedding replaced.
fn step_with(mesh: &DiskMesh, family: Family, embedding: Embedding) -> Step {
    let mut step = steps_of(mesh, Settings::new(Method::Natural, family)).swap_remove(0);
    step.candidate.solution.embedding = embedding;
    step
}

fn equation(mesh: &DiskMesh, step: &Step, vertex: VertexId) -> VertexEquation {
    equation_of_step(mesh, step, None, vertex).unwrap().0
}

/// Random positions, which satisfy no equation.
fn at_random(count: usize, seed: u64) -> Embedding {
    let mut random = Random(seed);
    (0..count).map(|_| DVec2::new(random.unit(), random.unit())).collect()
}

/// Asserts that an equation is a row of the system, up to the unit of length.
fn assert_is_row(
    mesh: &DiskMesh,
    found: &VertexEquation,
    all: &Equations<Complex<f64>>,
    embedding: &Embedding,
    vertex: VertexId,
) {
    let row: Vec<(VertexId, Complex<f64>)> =
        mesh.links_from(vertex).map(|h| (mesh.head(h), all.coefficients[h.index()])).collect();
    let sum: f64 = row.iter().map(|(_, a)| a.re).sum();
    assert_eq!(
        found.terms.iter().map(|term| term.neighbour).collect::<Vec<_>>(),
        row.iter().map(|(v, _)| *v).collect::<Vec<_>>()
    );
    let reach: f64 = row.iter().map(|(_, a)| (a.re / sum).abs()).sum();
    for (term, (neighbour, a)) in found.terms.iter().zip(&row) {
        assert!(
            (term.share - a.re / sum).abs() <= 1e-9 * reach,
            "{vertex} to {neighbour}: {} is {}",
            term.share,
            a.re / sum
        );
    }
    let at = |v: VertexId| embedding[v] - embedding[vertex];
    let whole: f64 = row.iter().map(|(v, a)| a.norm() * at(*v).length()).sum();
    let left = all.residual_of(mesh, embedding, vertex).norm() / whole;
    assert!((found.residual - left).abs() < 1e-9, "{vertex}: {} is {left}", found.residual);
}

#[test]
fn each_equation_is_a_row_of_the_system() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let embedding = at_random(mesh.vertex_count(), 1);
    for family in [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.4)] {
        let all = equations::natural(&mesh, family.power().unwrap(), Control::unattended()).unwrap();
        let step = step_with(&mesh, family, embedding.clone());
        for vertex in mesh.vertices() {
            let found = equation(&mesh, &step, vertex);
            assert_is_row(&mesh, &found, &all, &embedding, vertex);
        }
    }
}

#[test]
fn each_equation_on_polygons_is_a_row_of_the_system_with_their_diagonals() {
    for polygons in [quad_sheet(4, 3, 0.1, &mut Random(5)), honeycomb(3, 3, 0.03, &mut Random(6))] {
        let mesh = disk(polygons.triangulate());
        let (before, after) = (at_random(mesh.vertex_count(), 7), at_random(mesh.vertex_count(), 8));
        for family in [Family::Conformal, Family::MeanValue] {
            let all = equations::natural(&mesh, family.power().unwrap(), Control::unattended()).unwrap();
            let mut step = step_with(&mesh, family, after.clone());
            for vertex in mesh.vertices() {
                assert_is_row(&mesh, &equation(&mesh, &step, vertex), &all, &after, vertex);
            }
            step.candidate.stage = Stage::Iterate;
            let all = natural_in_plane(&mesh, &before, Control::unattended()).unwrap();
            for vertex in mesh.vertices() {
                let (found, _) = equation_of_step(&mesh, &step, Some(&before), vertex).unwrap();
                assert_is_row(&mesh, &found, &all, &after, vertex);
            }
        }
    }
}

#[test]
fn each_equation_of_an_iteration_is_a_row_of_its_system() {
    let mesh = disk(BuiltIn::Cube.mesh());
    let (before, after) = (at_random(mesh.vertex_count(), 2), at_random(mesh.vertex_count(), 3));
    let all = natural_in_plane(&mesh, &before, Control::unattended()).unwrap();
    let mut step = step_with(&mesh, Family::Conformal, after.clone());
    step.candidate.stage = Stage::Iterate;
    for vertex in mesh.vertices() {
        let (found, source) = equation_of_step(&mesh, &step, Some(&before), vertex).unwrap();
        assert_eq!(source, WeightSource::StepBefore);
        assert_is_row(&mesh, &found, &all, &after, vertex);
    }
}

#[test]
fn a_planar_ring_and_a_planar_fan_satisfy_it() {
    let mesh = disk(BuiltIn::Ell.mesh());
    let flat: Embedding = mesh.vertices().map(|v| mesh.position(v).truncate()).collect();
    for family in [Family::Conformal, Family::MeanValue, Family::Wachspress] {
        let step = step_with(&mesh, family, flat.clone());
        for vertex in mesh.vertices() {
            let found = equation(&mesh, &step, vertex);
            assert!(found.residual < ROUNDING, "{family} at {vertex}: {}", found.residual);
            let shares: f64 = found.terms.iter().map(|term| term.share).sum();
            assert!((shares - 1.0).abs() < ROUNDING);
            assert_eq!(found.offset_vector.is_some(), mesh.boundary_place(vertex).is_some());
            // The rounding of a sum whose weights nearly cancel is that of its terms.
            let size: f64 = found.terms.iter().map(|term| term.share.abs()).sum();
            let met = found.barycentre + found.offset_vector.unwrap_or_default();
            assert!(met.distance(flat[vertex.index()]) < 1e-10 * size.max(1.0), "{family} at {vertex}: {met}");
        }
    }
}

#[test]
fn an_open_fan_leaves_the_boundary_term() {
    // A vertex in the middle of the lower side of a grid of unit squares: with d = 1 its offset is i(û₂ − û₁) / Σ k.
    // With û₁ to the right and û₂ to the left it points downwards, out of the mesh.
    let mesh = DiskMesh::try_from(grid(4, 4)).unwrap();
    let flat: Embedding = mesh.vertices().map(|v| mesh.position(v).truncate()).collect();
    let vertex = VertexId::new(2);
    let found = equation(&mesh, &step_with(&mesh, Family::MeanValue, flat), vertex);
    let offset = found.offset_vector.unwrap();
    assert!(found.terms.iter().all(|term| (term.offset - 1.0).abs() < f64::EPSILON && term.weight > 0.0));
    assert!((offset * found.weight_sum).distance(DVec2::new(0.0, -2.0)) < ROUNDING, "{offset}");
}

#[test]
fn the_offset_along_an_edge_follows_the_family() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let vertex = mesh.boundary_loop()[3];
    for (family, power) in [(Family::Conformal, 1), (Family::MeanValue, 0), (Family::Wachspress, -1)] {
        let settings = Settings::new(Method::Natural, family);
        let step = steps_of(&mesh, settings).swap_remove(0);
        for term in equation(&mesh, &step, vertex).terms {
            let length: f64 = mesh.position(term.neighbour).distance(mesh.position(vertex));
            assert!((term.offset - length.powi(power)).abs() < ROUNDING * term.offset, "{family}");
        }
    }
}

#[test]
fn a_linear_solve_and_an_iteration_satisfy_theirs_but_at_pins() {
    let mesh = disk(BuiltIn::Face.mesh());
    let settings =
        Settings { treatment: Some(Treatment::Eliminate), ..Settings::new(Method::Iterate, Family::MeanValue) };
    let steps = steps_of(&mesh, settings);
    assert!(steps.len() > 1, "the first step folds");
    let mut before: Option<&Embedding> = None;
    for step in &steps {
        for vertex in mesh.vertices().filter(|v| !step.candidate.solution.pins.contains_key(v)) {
            let (found, _) = equation_of_step(&mesh, step, before, vertex).unwrap();
            assert!(found.residual < SOLVED, "step {} at {vertex}: {}", step.index, found.residual);
        }
        before = Some(&step.candidate.solution.embedding);
    }
}

/// Asserts that all vertices off the outline satisfy the equations of mesh and scaffold.
fn assert_virtual_boundary_is_solved(mesh: &DiskMesh, step: &Step) {
    let stages = step.candidate.virtual_boundary.as_ref().unwrap();
    let mut closed = 0;
    for vertex in mesh.vertices() {
        let found = equation_of_step(mesh, step, None, vertex);
        if stages.hull.contains(&vertex) {
            assert_eq!(found, Err(NoEquation::Prescribed));
            continue;
        }
        let (found, source) = found.unwrap();
        assert_eq!((source, found.offset_vector), (WeightSource::Extended, None));
        assert!(found.residual < SOLVED, "{vertex}: {}", found.residual);
        closed += usize::from(mesh.boundary_place(vertex).is_some());
    }
    assert!(closed > 0, "some boundary vertices lie in pockets");
}

#[test]
fn a_boundary_vertex_in_a_pocket_has_a_whole_ring() {
    let mesh = disk(BuiltIn::Face.mesh());
    let steps = steps_of(&mesh, Settings::new(Method::VirtualBoundary, Family::Conformal));
    assert_virtual_boundary_is_solved(&mesh, &steps[1]);
}

corpus_test! {
    fn virtual_vertices_are_neighbours_too() {
        let mesh = corpus_entry("cow_seamster.obj").disk();
        let steps = steps_of(&mesh, Settings::new(Method::VirtualBoundary, Family::Conformal));
        let step = steps.iter().find(|step| step.candidate.virtual_boundary.is_some()).unwrap();
        let first_virtual = VertexId::from_index(mesh.vertex_count());
        let of_vertex = |&v: &VertexId| equation_of_step(&mesh, step, None, v).unwrap().0;
        let has_virtual = |equation: VertexEquation| equation.terms.iter().any(|term| term.neighbour >= first_virtual);
        assert!(mesh.boundary_loop().iter().map(of_vertex).any(has_virtual));
        assert_virtual_boundary_is_solved(&mesh, step);
    }
}

#[test]
fn what_has_no_equation_says_why() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let boundary = mesh.boundary_loop()[0];
    let inside = mesh.vertices().find(|&v| mesh.boundary_place(v).is_none()).unwrap();
    let reason = |method, family, vertex| {
        let settings = Settings::new(method, family);
        let step = steps_of(&mesh, settings).pop().unwrap();
        equation_of_step(&mesh, &step, None, vertex)
    };
    let convex = Method::Convex(BoundaryShape::Circle);
    assert_eq!(reason(convex.clone(), Family::MeanValue, boundary), Err(NoEquation::Prescribed));
    assert_eq!(reason(Method::Levy, Family::Conformal, inside), Err(NoEquation::OfTriangles));
    for family in [Family::MeanValue, Family::Uniform, Family::ShapePreserving] {
        assert!(reason(convex.clone(), family, inside).unwrap().0.residual < SOLVED, "{family}");
    }
    assert_eq!(reason(Method::Spectral, Family::Conformal, boundary), Err(NoEquation::OfEigenvector));
    assert!(reason(Method::Spectral, Family::Conformal, inside).unwrap().0.residual < SOLVED);
    let mut step = steps_of(&mesh, Settings::default()).pop().unwrap();
    step.candidate.stage = Stage::Iterate;
    let missing = equation_of_step(&mesh, &step, None, inside);
    assert_eq!(missing, Err(NoEquation::StepBeforeMissing));
}
