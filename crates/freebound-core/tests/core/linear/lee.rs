//! Lee's virtual boundary: planar by Tutte's theorem, equations met by mesh and padding, and no reproduction of flat
//! meshes.

use freebound_core::bijective::Padded;
use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::ConvexPolygon;
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{
    BoundaryShape, Control, Embedding, Family, Method, Pins, Settings, SolveError, Spacing, Stage, hard_pins,
};
use freebound_core::verify::distortion;
use freebound_testkit::BuiltIn;
use glam::{DVec2, DVec3};

use freebound_testkit::{
    Entry, Random, corpus_disks, corpus_entry, corpus_test, data_triangle_disks, disk, grid, quad_sheet, sheet,
};

const POSITIVE: [Family; 3] = [Family::Uniform, Family::MeanValue, Family::ShapePreserving];

fn lee(layers: usize, family: Family) -> Settings {
    Settings { layers, ..Settings::new(Method::Lee(BoundaryShape::Circle), family) }
}

/// Single step of the method.
fn step(mesh: &DiskMesh, settings: Settings) -> Step {
    let mut steps = Vec::new();
    Flattener::new(settings, Pins::new())
        .finish(mesh, Control::unattended(), |step| steps.push(step))
        .expect("solvable");
    assert_eq!(steps.len(), 1);
    steps.remove(0)
}

/// Built-in meshes, and disks of triangles of `tests/data`.
fn meshes() -> Vec<(String, DiskMesh)> {
    let built_in = BuiltIn::ALL.map(|example| (example.name().to_owned(), disk(example.mesh())));
    built_in.into_iter().chain(data_triangle_disks().iter().map(Entry::named_disk)).collect()
}

fn corpus_meshes() -> Vec<(String, DiskMesh)> {
    ["nefertiti_562.obj", "cathead.obj"].map(|file| corpus_entry(file).named_disk()).into()
}

fn assert_positive_weights_end_planar_with_any_number_of_layers_and_any_shape(meshes: Vec<(String, DiskMesh)>) {
    let shapes = [BoundaryShape::Circle, BoundaryShape::Square, BoundaryShape::Polygon(ConvexPolygon::HEXAGON)];
    for (name, mesh) in meshes {
        for (family, (layers, shape)) in POSITIVE.into_iter().zip([1, 3, 8].into_iter().zip(shapes.clone())) {
            let settings = Settings { layers, ..Settings::new(Method::Lee(shape.clone()), family) };
            let step = step(&mesh, settings);
            assert!(step.verdict.planar, "{name}, {family}, {layers} layers: {}", step.verdict.summary());
            assert!(step.candidate.stage == Stage::Lee(shape) && !step.candidate.has_convex_boundary());
            assert!(step.candidate.solution.linear.expect("a linear solve").residual < 1e-10);
            let padding = step.candidate.outside.as_ref().expect("the padding is kept to be looked at");
            let boundary = mesh.boundary_loop().len();
            assert_eq!(padding.frame.len(), layers * boundary);
            assert_eq!(padding.triangles.len(), 2 * layers * boundary);
        }
    }
}

#[test]
fn positive_weights_end_planar_with_any_number_of_layers_and_any_shape() {
    assert_positive_weights_end_planar_with_any_number_of_layers_and_any_shape(meshes());
}

corpus_test! {
    fn positive_weights_end_planar_with_any_number_of_layers_and_any_shape_in_the_corpus() {
        assert_positive_weights_end_planar_with_any_number_of_layers_and_any_shape(corpus_meshes());
    }
}

fn assert_every_vertex_within_the_outermost_ring_lies_at_the_mean_of_its_neighbours(meshes: Vec<(String, DiskMesh)>) {
    // Uniform weights: the mean of the neighbours, counted here from the triangles alone.
    for (name, mesh) in meshes {
        let (solution, padding) = Padded::new(&mesh, 3)
            .solve(&lee(3, Family::Uniform), Control::unattended())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let places: Vec<DVec2> = solution.embedding.iter().chain(&padding.frame).copied().collect();
        let boundary = mesh.boundary_loop().len();
        let mut neighbours = vec![Vec::new(); places.len()];
        for triangle in mesh.mesh().triangles.iter().chain(&padding.triangles) {
            for k in 0..3 {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                neighbours[a.index()].push(b.index());
                neighbours[b.index()].push(a.index());
            }
        }
        for (vertex, around) in neighbours.iter_mut().enumerate() {
            around.sort_unstable();
            around.dedup();
            if vertex >= places.len() - boundary {
                assert!((places[vertex].length() - 1.0).abs() < 1e-12, "{name}: the outermost ring lies on the circle");
            } else if !around.is_empty() {
                let mean = around.iter().map(|&v| places[v]).sum::<DVec2>() / around.len() as f64;
                assert!(mean.distance(places[vertex]) < 1e-11, "{name}: vertex {vertex} is off its mean");
            }
        }
    }
}

#[test]
fn every_vertex_within_the_outermost_ring_lies_at_the_mean_of_its_neighbours() {
    assert_every_vertex_within_the_outermost_ring_lies_at_the_mean_of_its_neighbours(meshes());
}

corpus_test! {
    fn every_vertex_within_the_outermost_ring_lies_at_the_mean_of_its_neighbours_in_the_corpus() {
        assert_every_vertex_within_the_outermost_ring_lies_at_the_mean_of_its_neighbours(corpus_meshes());
    }
}

fn assert_weights_of_the_padded_mesh_are_positive(meshes: Vec<(String, DiskMesh)>) {
    for (name, mesh) in meshes {
        for family in POSITIVE {
            let padded = Padded::new(&mesh, 2);
            let equations = padded.equations(family, Control::unattended()).expect("finite");
            for link in padded.disk().links() {
                let weight = equations.coefficients[link.index()];
                let is_inside = padded.disk().boundary_place(padded.disk().tail(link)).is_none();
                assert!(!is_inside || (weight >= 0.0 && weight.is_finite()), "{name}, {family}: {weight}");
            }
        }
    }
}

#[test]
fn weights_of_the_padded_mesh_are_positive() {
    assert_weights_of_the_padded_mesh_are_positive(meshes());
}

corpus_test! {
    fn weights_of_the_padded_mesh_are_positive_in_the_corpus() {
        assert_weights_of_the_padded_mesh_are_positive(corpus_meshes());
    }
}

#[test]
fn virtual_triangles_have_the_shapes_of_a_straight_strip() {
    let mesh = disk(BuiltIn::Ell.mesh());
    let padded = Padded::new(&mesh, 2);
    let boundary = mesh.boundary_loop();
    let count = boundary.len();
    let ring = |ring: usize, place: usize| match ring {
        0 => boundary[place % count],
        ring => VertexId::from_index(mesh.vertex_count() + (ring - 1) * count + place % count),
    };
    let sides = |[a, b, c]: [DVec3; 3]| [a.distance(b), b.distance(c), c.distance(a)];
    let mut below: Vec<f64> = (0..count).map(|k| mesh.length([ring(0, k), ring(0, k + 1)])).collect();
    let mean = below.iter().sum::<f64>() / count as f64;
    let height = 0.75_f64.sqrt() * mean;
    for layer in 0..2 {
        let above: Vec<f64> = (0..count).map(|k| 0.5 * (below[k] + below[(k + 1) % count])).collect();
        for k in 0..count {
            // Straight strip: the edges of the ring in a row, each vertex above the middle of its edge.
            let slant = |k: usize| (0.25 * below[k % count].powi(2) + height * height).sqrt();
            let upwards = sides(padded.shape([ring(layer, k), ring(layer + 1, k), ring(layer, k + 1)]));
            let downwards = sides(padded.shape([ring(layer, k + 1), ring(layer + 1, k), ring(layer + 1, k + 1)]));
            for (found, expected) in
                [(upwards, [slant(k), slant(k), below[k]]), (downwards, [slant(k), above[k], slant(k + 1)])]
            {
                for (found, expected) in found.into_iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-12, "layer {layer}, place {k}: {found} is not {expected}");
                }
            }
        }
        below = above;
    }
    // Faces of the mesh keep their own shape.
    let face = mesh.mesh().triangles[3];
    assert_eq!(padded.shape(face), mesh.shape(face));
}

/// Area-weighted mean ratio of singular values, 1 if angles are preserved.
fn angle_distortion(mesh: &DiskMesh, embedding: &Embedding) -> f64 {
    distortion(mesh, embedding).summary.angle.mean
}

#[test]
fn a_flat_mesh_does_not_come_back_but_is_distorted_less_than_on_a_convex_boundary() {
    let mesh = disk(BuiltIn::Ell.mesh());
    for family in POSITIVE {
        let on_circle = Settings::new(Method::Convex(BoundaryShape::Circle), family);
        let convex = angle_distortion(&mesh, &step(&mesh, on_circle).candidate.solution.embedding);
        let padded = angle_distortion(&mesh, &step(&mesh, lee(2, family)).candidate.solution.embedding);
        assert!(1.05 < padded && padded < convex, "{family}: {padded} after {convex}");
    }
    // Not even a square, whose boundary is convex, on that very shape (the paper, §1.1).
    let square = disk(sheet(8, 0.0));
    let on_square = Settings::new(Method::Lee(BoundaryShape::Square), Family::MeanValue);
    assert!(angle_distortion(&square, &step(&square, on_square).candidate.solution.embedding) > 1.01);
}

#[test]
fn holes_and_polygons_are_padded_as_they_are() {
    let mesh = DiskMesh::try_from(quad_sheet(6, 5, 0.1, &mut Random(3)).triangulate()).expect("a disk");
    assert!(mesh.polygons().len() > 0);
    let padded = Padded::new(&mesh, 2);
    assert_eq!(padded.disk().polygons().len(), mesh.polygons().len(), "weights are the means over their fans");
    assert_eq!(padded.disk().mesh().real_face_count(), mesh.face_count(), "the padding is of no face of the file");
    for family in POSITIVE {
        let step = step(&mesh, lee(2, family));
        assert!(step.verdict.planar, "{family}: {}", step.verdict.summary());
    }
}

#[test]
fn spacing_moves_the_outermost_ring() {
    let mesh = disk(BuiltIn::Face.mesh());
    let [chord, even] = [Spacing::Chord, Spacing::Even].map(|spacing| {
        let settings = Settings { spacing, ..lee(1, Family::MeanValue) };
        Padded::new(&mesh, 1).solve(&settings, Control::unattended()).expect("solvable").1.frame
    });
    let gaps = |ring: &[DVec2]| -> Vec<f64> {
        ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).collect()
    };
    let spread = |gaps: &[f64]| {
        let [least, most] = gaps.iter().fold([f64::INFINITY, 0.0_f64], |[a, b], &gap| [a.min(gap), b.max(gap)]);
        most / least
    };
    assert!(spread(&gaps(&even)) < 1.0 + 1e-9 && spread(&gaps(&chord)) > 1.1);
}

#[test]
fn two_pins_say_where_it_lies_and_more_are_refused() {
    let mesh = disk(BuiltIn::Dome.mesh());
    let [a, b, c] = [0, 5, 10].map(|k| mesh.boundary_loop()[k]);
    let targets = [(a, DVec2::new(3.0, 1.0)), (b, DVec2::new(4.0, -1.0)), (c, DVec2::ZERO)];
    let two = hard_pins(targets[..2].iter().copied());
    let step =
        Flattener::new(lee(2, Family::MeanValue), two.clone()).step(&mesh, Control::unattended()).expect("solvable");
    assert!(two.iter().all(|(v, pin)| step.candidate.solution.embedding[*v] == pin.target));
    let three = hard_pins(targets);
    let refused = Flattener::new(lee(2, Family::MeanValue), three).step(&mesh, Control::unattended()).err();
    assert_eq!(refused, Some(SolveError::TooManyPins { method: "Lee's virtual boundary", count: 3, most: 2 }));
}

#[test]
fn a_single_triangle_can_be_padded() {
    let mesh = disk(grid(1, 1));
    for layers in [1, 4] {
        let step = step(&mesh, lee(layers, Family::Uniform));
        assert!(step.verdict.planar, "{}", step.verdict.summary());
    }
}

/// Number of faces that are not counter-clockwise, in exact arithmetic.
fn faces_not_positive(mesh: &DiskMesh, embedding: &Embedding) -> usize {
    let at = |vertex: VertexId| robust::Coord { x: embedding[vertex].x, y: embedding[vertex].y };
    let faces = mesh.mesh().triangles.iter();
    faces.filter(|corners| robust::orient2d(at(corners[0]), at(corners[1]), at(corners[2])) <= 0.0).count()
}

corpus_test! {
    #[ignore = "all disks of the corpus take half a minute without optimisation"]
    fn every_disk_of_the_corpus_ends_with_an_honest_verdict() {
        for entry in corpus_disks() {
            let mesh = entry.disk();
            for (layers, family) in
                [(1, Family::MeanValue), (2, Family::MeanValue), (4, Family::MeanValue), (2, Family::Uniform)]
            {
                let start = std::time::Instant::now();
                let settings = lee(layers, family);
                let mut last = None;
                let outcome = Flattener::new(settings, Pins::new())
                    .finish(&mesh, Control::unattended(), |step| last = Some(step));
                let words = match (&outcome, &last) {
                    (Ok(_), Some(step)) => {
                        let flipped = faces_not_positive(&mesh, &step.candidate.solution.embedding);
                        assert_eq!(step.verdict.flipped_faces.len(), flipped, "{}", entry.file);
                        let summary = distortion(&mesh, &step.candidate.solution.embedding).summary;
                        let stretch = (summary.angle.mean, summary.area.mean, summary.stretch_l2);
                        format!("{stretch:.3?}, {}", step.verdict.summary())
                    }
                    (Err(error), None) => {
                        assert!(error.is_failure_of_method(), "{}: {error}", entry.file);
                        error.to_string()
                    }
                    (outcome, step) => panic!("{}: {outcome:?} with {step:?}", entry.file),
                };
                let seconds = start.elapsed().as_secs_f64();
                println!("{}, {layers} layers, {family}: {seconds:.2} s, {words}", entry.file);
            }
        }
    }
}
