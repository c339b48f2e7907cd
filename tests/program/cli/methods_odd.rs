//! Every method of `compare`, with all its weights and shapes, on difficult surfaces. It ends with an embedding and
//! an honest verdict, or with an error that suggests a remedy. The output has no NaN. The report states the quality
//! of the solution or the reason for the end.

use freebound::session::{Compared, Document, Model};
use freebound_core::mesh::{PolygonMesh, Preparation, VertexId};
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{BoundaryShape, Control, Family, Method, NamedOption as _, PinKind, Variant};
use freebound_io::ReadOptions;
use glam::{DVec2, DVec3};

use super::program::obj_text;
use freebound_testkit::oracle::{OracleVerdict, examine};
use freebound_testkit::surfaces::without_faces;
use freebound_testkit::{Random, fan, grid, honeycomb, quad_sheet, sheet};

/// Largest residual of linear solves. Needles of 1e-12 leave 5e-5 in 64 bits. That is an error for solved positions;
/// for an eigenvector and a layout of angles it is reported.
const RESIDUAL: f64 = 1e-4;

/// Kinds of errors whose messages suggest another method, other weights or other targets.
const WITH_REMEDY: [&str; 13] = [
    "weight-not-finite",
    "coincident-pins",
    "family-not-applicable",
    "boundary-too-short",
    "no-hull",
    "too-many-pins",
    "targets-too-near",
    "too-fine",
    "all-bent",
    "out-of-range",
    "singular",
    "residual-too-large",
    "linear-solver",
];

/// Surface as in a file, prepared.
struct Odd {
    name: &'static str,
    model: Model,
}

fn odd(name: &'static str, mesh: impl Into<PolygonMesh>) -> Odd {
    let mesh = mesh.into();
    let model = Model::read_stream(name, obj_text(&mesh).as_bytes(), ReadOptions::default(), &|| false)
        .expect("it can be read");
    let model = model.in_form(Preparation::default());
    let disk = model.disk().unwrap_or_else(|| panic!("{name} is no disk"));
    assert!(disk.vertex_count() >= mesh.positions.len(), "{name}: what is odd stays");
    Odd { name, model }
}

fn polygons(positions: &[[f64; 3]], faces: &[&[u32]]) -> PolygonMesh {
    let (mut corners, mut starts) = (Vec::new(), vec![0]);
    for face in faces {
        corners.extend(face.iter().map(|&v| VertexId::new(v)));
        starts.push(u32::try_from(corners.len()).unwrap());
    }
    PolygonMesh { positions: positions.iter().map(|&p| DVec3::from(p)).collect(), corners, starts: Some(starts) }
}

fn moved(mut mesh: PolygonMesh, place: impl Fn(DVec3) -> DVec3) -> PolygonMesh {
    mesh.positions.iter_mut().for_each(|p| *p = place(*p));
    mesh
}

fn bumpy() -> PolygonMesh {
    (&sheet(4, 0.4)).into()
}

/// Degenerate faces: a vertex in the middle of an edge, two coinciding ends of an edge, a fan on one line.
fn without_area() -> Vec<Odd> {
    let at = |column: usize, row: usize| 5 * row + column;
    let [mut on_edge, mut in_one_place, mut on_line] = [(); 3].map(|()| bumpy());
    on_edge.positions[at(2, 2)] = on_edge.positions[at(1, 2)].midpoint(on_edge.positions[at(2, 1)]);
    in_one_place.positions[at(2, 2)] = in_one_place.positions[at(3, 2)];
    for row in 1..4 {
        on_line.positions[at(3, row)] = on_line.positions[at(3, 1)];
    }
    let mut at_boundary = bumpy();
    at_boundary.positions[at(0, 1)] = at_boundary.positions[at(0, 0)];
    vec![
        odd("a vertex on an edge of its neighbour", on_edge),
        odd("an edge without length", in_one_place),
        odd("an edge without length on the boundary", at_boundary),
        odd("vertices in one place", on_line),
    ]
}

/// Polygons other than triangles, and filled holes.
fn polygonal() -> Vec<Odd> {
    let mut random = Random(3);
    let concave = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.1], [0.5, 0.5, 0.2], [0.0, 2.0, 0.0], [2.0, 2.0, 0.5]];
    let holed = |sheet: PolygonMesh, holes: &[usize]| without_faces(&sheet, |face| holes.contains(&face));
    vec![
        odd("quads", quad_sheet(3, 3, 0.1, &mut random)),
        odd("rough hexagons", honeycomb(3, 2, 0.2, &mut random)),
        odd("a concave quad", polygons(&concave, &[&[0, 1, 2, 3], &[1, 4, 2], &[4, 3, 2]])),
        odd("one concave quad", polygons(&concave[..4], &[&[0, 1, 2, 3]])),
        odd("a filled hole", holed(quad_sheet(4, 4, 0.1, &mut random), &[5, 6])),
        odd("a hole beside another", holed(quad_sheet(4, 4, 0.0, &mut random), &[5, 10])),
    ]
}

/// Smallest possible numbers of faces and inner vertices.
fn small() -> Vec<Odd> {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0]];
    let around: Vec<[f64; 3]> = [[0.0, 0.0, 0.0]]
        .into_iter()
        .chain((0..6).map(|k| f64::from(k) / 2.0).map(|angle| [angle.cos(), angle.sin(), 0.1 * angle]))
        .collect();
    let open_fan: Vec<[u32; 3]> = (1..6).map(|k| [0, k, k + 1]).collect();
    let open_fan: Vec<&[u32]> = open_fan.iter().map(|face| &face[..]).collect();
    let raised = |sides: u32, height: f64| {
        let mut fan = fan(sides);
        fan.positions[0].z = height;
        fan
    };
    vec![
        odd("a triangle", polygons(&square[..3], &[&[0, 1, 2]])),
        odd("two triangles", polygons(&square, &[&[0, 1, 2], &[0, 2, 3]])),
        odd("an open fan", polygons(&around, &open_fan)),
        odd("a pyramid", &raised(5, 1.0)),
        odd("a spire", &raised(3, 40.0)),
        odd("a strip", &grid(7, 1)),
    ]
}

/// Numbers and angles near the limits of 64 bits.
fn extreme() -> Vec<Odd> {
    let scaled = |name, scale: DVec3| odd(name, moved(bumpy(), |p| p * scale));
    let mut needles = bumpy();
    let middle = needles.positions[12];
    needles.positions[13] = middle + 1e-12 * (needles.positions[13] - middle);
    vec![
        scaled("huge", DVec3::splat(1e150)),
        scaled("tiny", DVec3::splat(1e-150)),
        odd("far away", moved(bumpy(), |p| p + DVec3::splat(1e6))),
        scaled("needles", DVec3::new(1e12, 1.0, 1.0)),
        odd("needles in the middle", needles),
    ]
}

/// All variants: each method with all its weights, and on all its shapes with the default weights.
fn variants() -> Vec<Variant> {
    let mut variants = Vec::new();
    for method in Method::ALL {
        let families = Family::ALL.iter().filter(|family| method.uses_family() && family.goes_with(method));
        variants.extend(families.map(|&family| Variant { method: method.clone(), family: Some(family) }));
        if !method.uses_family() {
            variants.push(Variant { method: method.clone(), family: None });
        }
        let others = BoundaryShape::ALL.iter().filter(|&shape| method.boundary_shape().is_some_and(|own| own != shape));
        variants.extend(others.map(|shape| Variant { method: method.clone().on_shape(shape.clone()), family: None }));
    }
    variants
}

/// Three targets that no similarity meets.
fn constrained(model: &Model) -> Document {
    let boundary = model.disk().expect("a disk").boundary_loop();
    let places = [DVec2::new(0.1, 0.2), DVec2::new(0.9, 0.1), DVec2::new(0.6, 0.8)];
    let vertices = [0, boundary.len() / 3, 2 * boundary.len() / 3].map(|k| boundary[k]);
    let targets = vertices.into_iter().zip(places).map(|(vertex, uv)| (vertex, Target { uv, kind: PinKind::Hard }));
    Document { targets: targets.collect(), ..Document::default() }
}

/// Runs a variant and returns the faults of its result.
fn faults(model: &Model, document: &Document, variant: &Variant) -> Vec<String> {
    let problem = document.problem().by(variant);
    let compared = Compared::run(model, problem, Control::unattended(), |_| {}).expect("nobody cancels");
    let mut faults = Vec::new();
    let mut expect = |holds: bool, what: String| {
        if !holds {
            faults.push(what);
        }
    };
    let report = &compared.report;
    let words = format!("{report:?}");
    expect(!words.contains("NaN"), format!("NaN in the report: {words}"));
    if let Some(error) = &report.error {
        // Where no stage is left, the errors of the stages stand in the message.
        let is_of_stages = error.kind == "stages-exhausted" && error.message.matches(": ").count() > 1;
        let has_remedy = WITH_REMEDY.contains(&error.kind) || is_of_stages;
        expect(has_remedy, format!("{}: {}", error.kind, error.message));
    }
    expect(report.error.is_some() || compared.outcome.is_some(), "neither result nor error".to_owned());
    for timed in &report.steps {
        let step = &timed.step;
        let is_solved = step.residual.is_none_or(|residual| (0.0..=RESIDUAL).contains(&residual));
        expect(is_solved, format!("step {} has residual {:?}", step.index, step.residual));
    }
    if let Some(last) = report.steps.last().map(|timed| &timed.step) {
        let is_measured = last.residual.is_some() || last.energy.is_some();
        let says_why = last.convergence.is_some() || last.note.is_some();
        expect(is_measured || says_why, format!("the last step, {}, says nothing of its end", last.stage.name()));
    }
    let Some(outcome) = &compared.outcome else { return faults };
    let steps = report.steps.iter().map(|timed| timed.step.clone()).collect();
    let output = model.finished(outcome, steps, Fit::Unit);
    let chart = &output.charts[0];
    if chart.coordinates.iter().any(|z| !z.is_finite()) {
        faults.push("what is written is not finite".to_owned());
        return faults;
    }
    let triangles: Vec<[u32; 3]> = chart.mesh.faces().map(|face| chart.mesh.face(face).map(VertexId::number)).collect();
    let OracleVerdict { injective, mirrored, .. } = examine(&triangles, &chart.coordinates);
    let verdict = &chart.verdict;
    let mut expect = |holds: bool, what: &str| {
        if !holds {
            faults.push(format!("{what}: {}", verdict.summary()));
        }
    };
    expect(verdict.is_one_to_one() == injective, "the verdict and the rational numbers disagree");
    expect(verdict.mirrored == mirrored, "mirrored or not");
    expect(!verdict.planar || injective, "called planar");
    faults
}

/// Runs all variants on all surfaces.
#[track_caller]
fn assert_honest(surfaces: Vec<Odd>) {
    let mut found = Vec::new();
    for Odd { name, model } in surfaces {
        for document in [Document::default(), constrained(&model)] {
            let problem = document.problem();
            for variant in variants().into_iter().filter(|variant| problem.suits(&variant.method)) {
                let of = format!("{name}, {variant}, {} pins", document.targets.len());
                let run = std::panic::catch_unwind(|| faults(&model, &document, &variant));
                match run {
                    Ok(faults) => found.extend(faults.into_iter().map(|fault| format!("{of}: {fault}"))),
                    Err(_) => found.push(format!("{of}: panic")),
                }
            }
        }
    }
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

#[test]
fn every_method_is_honest_about_faces_without_area() {
    assert_honest(without_area());
}

#[test]
fn every_method_is_honest_about_polygons_and_holes() {
    assert_honest(polygonal());
}

#[test]
fn every_method_is_honest_about_the_smallest_disks() {
    assert_honest(small());
}

#[test]
fn every_method_is_honest_about_extreme_numbers() {
    assert_honest(extreme());
}
