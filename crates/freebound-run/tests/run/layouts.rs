//! Layouts of meshes in memory.

use std::collections::BTreeMap;
use std::sync::Arc;

use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{PolygonMesh, VertexId};
use freebound_core::pipeline::{Target, Targets};
use freebound_core::problem::{Control, Method, Settings, SolveError};
use freebound_io::{NO_TEXTURE, OutputKind, read_mesh};
use freebound_run::{Model, NO_CHART, PartChoice, RequestFault, Run, RunError, RunRequest, SeamKind};
use freebound_testkit::{jittered_sheet, many_parts};
use glam::{DVec2, DVec3};

fn model(mesh: impl Into<PolygonMesh>) -> Model {
    Model::in_memory("mesh", Arc::new(mesh.into().into()))
}

fn sheet() -> PolygonMesh {
    (&jittered_sheet(6)).into()
}

/// Two closed balls.
fn balls() -> PolygonMesh {
    let ball: PolygonMesh = (&many_parts::ball(12, 6)).into();
    let count = ball.positions.len();
    let moved = ball.positions.iter().map(|position| *position + 5.0);
    let corners = ball.corners.iter().map(|corner| VertexId::from_index(corner.index() + count));
    PolygonMesh {
        positions: ball.positions.iter().copied().chain(moved).collect(),
        corners: ball.corners.iter().copied().chain(corners).collect(),
        starts: None,
    }
}

/// Pins that hold the boundary of a sheet, and turn its middle half around. No map without new vertices meets them.
fn swirl(sheet: &PolygonMesh) -> RunRequest {
    let [low, high] = [DVec3::min, DVec3::max].map(|of| sheet.positions.iter().copied().reduce(of).expect("vertices"));
    let mut targets = Targets::new();
    for (number, position) in (0..).zip(&sheet.positions) {
        let at = ((*position - low) / (high - low)).truncate();
        let from_middle = at - 0.5;
        if from_middle.abs().max_element() > 0.42 {
            targets.insert(VertexId::new(number), Target::hard(at));
        } else if from_middle.abs().max_element() < 0.2 {
            targets.insert(VertexId::new(number), Target::hard(0.5 - from_middle));
        }
    }
    assert!(targets.len() > 24, "{}", targets.len());
    let mut request = RunRequest::default();
    request.run.options.targets = targets;
    request
}

#[test]
fn a_disk_has_a_coordinate_for_each_vertex_and_a_triangle_for_each_face() {
    let mesh = sheet();
    let layout = RunRequest::default().run(&model(mesh.clone())).expect("a disk");
    assert!(layout.is_fine() && layout.new_vertices.is_empty() && layout.face_of.is_none());
    assert_eq!(layout.texture.coordinates.len(), mesh.positions.len());
    assert_eq!(layout.mesh.polygons, mesh);
    let faces: Vec<u32> = layout.triangles().iter().map(|triangle| triangle.face).collect();
    assert_eq!(faces, (0..u32::try_from(mesh.face_count()).unwrap()).collect::<Vec<_>>());
    assert!(layout.chart_of_face.iter().all(|&chart| chart == 0) && layout.cut_edges().is_empty());
}

#[test]
fn the_singular_values_sum_up_to_the_energy_of_the_report() {
    let layout = RunRequest::default().run(&model(sheet())).expect("a disk");
    let area = |face: u32| {
        let [a, b, c] =
            [0, 1, 2].map(|k| layout.mesh.polygons.positions[layout.mesh.polygons.face(face as usize)[k].index()]);
        (b - a).cross(c - a).length()
    };
    let mut sums = [0.0; 2];
    for triangle in layout.triangles() {
        let [s, t] = triangle.singular_values().expect("flattened");
        let weight = area(triangle.face);
        sums[0] += weight * (s * s + t * t + 1.0 / (s * s) + 1.0 / (t * t));
        sums[1] += weight;
    }
    let reported = layout.report.distortion.expect("one chart").symmetric_dirichlet.mean;
    assert!((sums[0] / sums[1] / reported - 1.0).abs() < 1e-12, "{} {reported}", sums[0] / sums[1]);
}

#[test]
fn parts_that_are_not_chosen_have_no_chart_and_no_coordinates() {
    let mesh = balls();
    let count = mesh.face_count() / 2;
    let request = RunRequest { parts: Some(PartChoice::Numbered([1].into())), ..RunRequest::unwrap() };
    let layout = request.run(&model(mesh)).expect("a ball");
    assert!(layout.is_fine());
    assert!(layout.chart_of_face[..count].iter().all(|&chart| chart == NO_CHART));
    assert!(layout.chart_of_face[count..].iter().all(|&chart| chart != NO_CHART));
    assert!(layout.texture.corners[..3 * count].iter().all(|&corner| corner == NO_TEXTURE));
    assert_eq!(layout.triangles().len(), 2 * count);
    assert!(layout.triangles()[..count].iter().all(|triangle| triangle.distortion.is_none()));
    let missing = RunRequest { parts: Some(PartChoice::Numbered([7].into())), ..RunRequest::unwrap() };
    let refused = missing.run(&model(balls()));
    assert!(
        matches!(refused, Err(RunError::Request(RequestFault::Part(fault))) if fault.part == 7 && fault.count == 2)
    );
}

#[test]
fn new_vertices_lie_on_their_edges_and_their_faces_name_the_faces_of_the_input() {
    let mesh = sheet();
    let request = swirl(&mesh);
    let layout = request.run(&model(mesh.clone())).expect("auto ends planar");
    assert!(layout.is_fine() && !layout.new_vertices.is_empty());
    let polygons = &layout.mesh.polygons;
    for (new, position) in layout.new_vertices.iter().zip(&polygons.positions[mesh.positions.len()..]) {
        let [a, b] = new.edge.map(|vertex| polygons.positions[vertex.index()]);
        assert!((a.lerp(b, new.at) - *position).length() < 1e-12);
    }
    let face_of = layout.face_of.as_ref().expect("faces are split");
    assert_eq!((face_of.len(), layout.triangles().len()), (polygons.face_count(), polygons.face_count()));
    // The parts of a face lie in its plane.
    let normal = |mesh: &PolygonMesh, face: usize| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[mesh.face(face)[k].index()]);
        (b - a).cross(c - a)
    };
    for (face, &of) in face_of.iter().enumerate() {
        let whole = normal(&mesh, of as usize);
        assert!(
            normal(polygons, face).dot(whole) > 0.0 && normal(polygons, face).length() <= whole.length() * 1.000_001
        );
    }
}

#[test]
fn a_pin_at_a_corner_holds_one_side_of_a_seam() {
    let (mesh, _) = cubes_of_quads();
    let request = RunRequest {
        seam_kinds: vec![SeamKind::Sharp(60.0)],
        corner_pins: vec![(0, Target::hard(DVec2::new(0.25, 0.5))), (1, Target::hard(DVec2::new(0.5, 0.5)))],
        ..RunRequest::unwrap()
    };
    let layout = request.run(&model(mesh)).expect("a cube");
    let at: Vec<_> = layout.corner_coordinates().collect();
    assert_eq!([at[0], at[1]], [Some(DVec2::new(0.25, 0.5)), Some(DVec2::new(0.5, 0.5))]);
    assert!(layout.is_planar() && !layout.cut_edges().is_empty());
    // The same place again is no contradiction; another place is.
    let doubled = |uv: DVec2| RunRequest {
        seam_kinds: vec![SeamKind::Sharp(60.0)],
        corner_pins: vec![(0, Target::hard(DVec2::new(0.25, 0.5))), (0, Target::hard(uv))],
        ..RunRequest::unwrap()
    };
    doubled(DVec2::new(0.25, 0.5)).run(&model(cubes_of_quads().0)).expect("one place");
    let refused = doubled(DVec2::new(0.5, 0.5)).run(&model(cubes_of_quads().0));
    assert!(matches!(refused, Err(RunError::Request(RequestFault::PinnedTwice(_)))));
    let outside = RunRequest { corner_pins: vec![(99, Target::hard(DVec2::ZERO))], ..RunRequest::unwrap() };
    let refused = outside.run(&model(cubes_of_quads().0));
    assert!(matches!(refused, Err(RunError::Request(RequestFault::NoSuchCorner(99)))));
}

/// Closed cube of quads, and its number of faces.
fn cubes_of_quads() -> (PolygonMesh, usize) {
    let positions: Vec<[f64; 3]> = (0..8_u32).map(|k| [k & 1, (k >> 1) & 1, k >> 2].map(f64::from)).collect();
    let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (PolygonMesh::from_arrays(&positions, &faces), faces.len())
}

#[test]
fn sizes_name_charts_and_charts_that_are_not_there_are_refused() {
    let (mesh, faces) = cubes_of_quads();
    let sized = |sizes: BTreeMap<usize, f64>| RunRequest {
        seam_kinds: vec![SeamKind::Sharp(60.0)],
        chart_sizes: sizes,
        ..RunRequest::unwrap()
    };
    let layout = sized([(0, 2.0)].into()).run(&model(mesh.clone())).expect("a cube");
    let side = |face: usize| {
        let at: Vec<DVec2> = layout.corner_coordinates().skip(4 * face).take(2).flatten().collect();
        at[0].distance(at[1])
    };
    assert!((1..faces).all(|face| (side(0) / side(face) - 2.0).abs() < 1e-6));
    let refused = sized([(6, 2.0)].into()).run(&model(mesh));
    assert!(matches!(refused, Err(RunError::Request(RequestFault::NoSuchChart { chart: 6, count: 6 }))));
}

#[test]
fn a_layout_that_misses_a_pin_is_returned_and_says_so() {
    let mut request = swirl(&sheet());
    request.run.options.settings = Settings { new_vertices: false, ..Settings::default() };
    let layout = request.run(&model(sheet())).expect("a planar map");
    assert!(layout.is_planar() && !layout.is_fine() && !layout.report.unmet_pins().is_empty());
}

#[test]
fn a_run_can_be_cancelled_by_its_flag_and_by_its_observer() {
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let control = Control::new(&cancel, &|_| {});
    let ended = RunRequest::unwrap().run_with(&model(balls()), control, |_, _| Ok::<(), String>(()));
    assert!(matches!(ended, Err(RunError::Solve(SolveError::Cancelled))));
    let stopped =
        RunRequest::default().run_with(&model(sheet()), Control::unattended(), |_, _| Err("enough".to_owned()));
    assert!(matches!(stopped, Err(RunError::Observer(words)) if words == "enough"));
}

#[test]
fn a_mesh_that_is_no_disk_is_refused_with_its_faults() {
    let refused = RunRequest::default().run(&model(cubes_of_quads().0));
    assert!(matches!(refused, Err(RunError::NotADisk(diagnosis)) if !diagnosis.faults.is_empty()));
}

#[test]
fn a_layout_is_written_in_any_format_and_read_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let layout = RunRequest::unwrap().run(&model(balls())).expect("balls");
    for name in ["balls.obj", "balls.ply", "balls.glb"] {
        let path = folder.path().join(name);
        layout.write(&path, OutputKind::of_mesh(&path), None).expect("written");
        let read = read_mesh(&path).expect("a mesh");
        assert!(read.texture.is_some(), "{name}");
    }
}

#[test]
fn the_whole_of_a_run_depends_on_its_own_options_only() {
    // Methods, packing and sizes are those of the request, whatever ran before.
    let packing = PackingOptions { picture: [256, 256], gap: 8, ..PackingOptions::default() };
    let mut request = RunRequest::unwrap();
    request.run.options.packing = packing;
    let first = request.run(&model(balls())).expect("balls");
    let natural =
        RunRequest { run: Run { options: with_method(Method::Natural), ..Run::default() }, ..RunRequest::default() };
    natural.run(&model(sheet())).expect("a sheet");
    let again = request.run(&model(balls())).expect("balls");
    assert_eq!(first.texture, again.texture);
}

fn with_method(method: Method) -> freebound_core::pipeline::PipelineOptions {
    let settings = Settings { method, ..Settings::default() };
    freebound_core::pipeline::PipelineOptions { settings, ..Default::default() }
}
