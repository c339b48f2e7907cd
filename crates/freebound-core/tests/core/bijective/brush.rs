//! Strokes of brushes on a planar embedding. Every frame is planar, and the verdict proved for the moved region equals
//! the whole verdict. Pins stay, and so does everything outside the circle.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use freebound_core::bijective::{Brush, BrushFrame, BrushKind, BrushSolver, DragTarget};
use freebound_core::mesh::{DiskMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Pins, SolveError, hard_pins};
use freebound_core::verify::{distortion, verdict};
use glam::DVec2;
use proptest::prelude::*;

use freebound_testkit::{Random, disk, jittered_sheet, quad_sheet};

fn from_above(mesh: &DiskMesh) -> Embedding {
    mesh.mesh().positions.iter().map(|p| p.truncate()).collect()
}

struct Stroke {
    mesh: DiskMesh,
    solver: BrushSolver,
    begin: Embedding,
    pins: Pins,
}

impl Stroke {
    fn new(mesh: DiskMesh, begin: Embedding, brush: Brush, at: DVec2) -> Self {
        let pins = hard_pins([(VertexId::new(0), begin[0])]);
        let target = DragTarget { pins: pins.clone(), sheet: Arc::default() };
        let solver = BrushSolver::new(&mesh, begin.clone(), target, brush, at).expect("planar at first");
        Self { mesh, solver, begin, pins }
    }

    fn on_sheet(kind: BrushKind, strength: f64, at: DVec2) -> Self {
        let mesh = disk(jittered_sheet(20));
        let begin = from_above(&mesh);
        Self::new(mesh, begin, Brush { kind, radius: 0.4, strength }, at)
    }

    fn frame(&mut self, at: DVec2) -> BrushFrame {
        let frame = self.solver.frame(&self.mesh, at, Control::unattended()).unwrap();
        let embedding = self.solver.embedding();
        assert_eq!(frame.verdict, verdict(&self.mesh, embedding), "of what moved and of the whole");
        assert!(frame.verdict.planar);
        for (&vertex, pin) in &self.pins {
            assert_eq!(embedding[vertex], pin.target);
        }
        let moved = self.solver.moved();
        for vertex in self.mesh.vertices().filter(|v| !moved.contains(v)) {
            assert_eq!(embedding[vertex], self.begin[vertex]);
        }
        frame
    }

    /// Sum of the areas of faces with their middles at first within a distance of a point.
    fn area_near(&self, embedding: &Embedding, at: DVec2, radius: f64) -> f64 {
        let middle = |corners: [VertexId; 3]| corners.iter().map(|v| self.begin[*v]).sum::<DVec2>() / 3.0;
        let faces = self.mesh.faces().map(|face| self.mesh.face(face));
        let near = faces.filter(|corners| middle(*corners).distance(at) < radius);
        near.map(|[a, b, c]| 0.5 * (embedding[b] - embedding[a]).perp_dot(embedding[c] - embedding[a])).sum()
    }
}

#[test]
fn a_grab_takes_the_inner_half_along_and_returns_with_the_pointer() {
    let start = DVec2::new(0.1, 0.05);
    let mut stroke = Stroke::on_sheet(BrushKind::Grab, 1.0, start);
    let inner: Vec<VertexId> = stroke.mesh.vertices().filter(|&v| stroke.begin[v].distance(start) < 0.2).collect();
    assert!(inner.len() > 3);
    let by = DVec2::new(0.12, -0.08);
    let settle = |stroke: &mut Stroke, to: DVec2| (0..60).any(|_| stroke.frame(to).is_at_rest);
    assert!(settle(&mut stroke, start + by));
    for &v in &inner {
        assert!(stroke.solver.embedding()[v].distance(stroke.begin[v] + by) < 1e-9);
    }
    for v in stroke.mesh.vertices().filter(|&v| stroke.begin[v].distance(start) >= 0.4) {
        assert_eq!(stroke.solver.embedding()[v], stroke.begin[v], "beyond the circle");
    }
    assert!(settle(&mut stroke, start));
    let farthest = |v: VertexId| stroke.solver.embedding()[v].distance(stroke.begin[v]);
    assert!(stroke.mesh.vertices().map(farthest).fold(0.0, f64::max) < 1e-3);
}

#[test]
fn relaxing_lowers_the_energy_near_the_brush_and_nothing_moves_beyond_it() {
    let mut stroke = Stroke::on_sheet(BrushKind::Relax, 1.0, DVec2::ZERO);
    let random = |v: VertexId| DVec2::new((f64::from(v.number()) * 1.7).sin(), (f64::from(v.number()) * 2.3).cos());
    let shaken = |v: VertexId| if stroke.mesh.boundary_place(v).is_some() { 0.0 } else { 0.02 };
    let begin: Embedding = stroke.mesh.vertices().map(|v| stroke.begin[v] + shaken(v) * random(v)).collect();
    let mesh = disk(jittered_sheet(20));
    let before = distortion(&mesh, &begin).summary.symmetric_dirichlet.mean;
    let brush = Brush { kind: BrushKind::Relax, radius: 0.6, strength: 1.0 };
    stroke = Stroke::new(mesh, begin, brush, DVec2::ZERO);
    assert!((0..30).any(|_| stroke.frame(DVec2::ZERO).is_at_rest));
    let after = distortion(&stroke.mesh, stroke.solver.embedding()).summary.symmetric_dirichlet.mean;
    assert!(after < before, "{after} {before}");
    for v in stroke.mesh.vertices().filter(|&v| stroke.begin[v].length() > 0.6) {
        assert_eq!(stroke.solver.embedding()[v], stroke.begin[v]);
    }
}

#[test]
fn a_pinch_gathers_vertices_and_its_inverse_spreads_them() {
    for (strength, is_gathered) in [(1.0, true), (-1.0, false)] {
        let mut stroke = Stroke::on_sheet(BrushKind::Pinch, strength, DVec2::ZERO);
        let before = stroke.area_near(&stroke.begin, DVec2::ZERO, 0.2);
        for _ in 0..5 {
            stroke.frame(DVec2::ZERO);
        }
        let after = stroke.area_near(stroke.solver.embedding(), DVec2::ZERO, 0.2);
        assert_eq!(after < 0.8 * before, is_gathered, "{after} {before}");
        assert_eq!(after > 1.2 * before, !is_gathered, "{after} {before}");
    }
}

#[test]
fn a_brush_for_texels_gives_faces_more_area_and_its_inverse_less() {
    for (strength, factor) in [(1.0, 1.3), (-1.0, 1.0 / 1.3)] {
        let mut stroke = Stroke::on_sheet(BrushKind::Texels, strength, DVec2::ZERO);
        let before = stroke.area_near(&stroke.begin, DVec2::ZERO, 0.2);
        for _ in 0..8 {
            stroke.frame(DVec2::ZERO);
        }
        let after = stroke.area_near(stroke.solver.embedding(), DVec2::ZERO, 0.2);
        assert_eq!(after > factor * before, strength > 0.0, "{after} {before}");
        assert_eq!(after < factor * before, strength < 0.0, "{after} {before}");
    }
}

#[test]
fn smoothing_shortens_the_boundary_and_moves_the_boundary_near_the_brush_alone() {
    let mesh = disk(jittered_sheet(20));
    let mut begin = from_above(&mesh);
    let boundary = mesh.boundary_loop().to_vec();
    for (place, &v) in boundary.iter().enumerate() {
        begin[v] *= if place % 2 == 0 { 1.0 } else { 1.02 };
    }
    let middle = boundary[boundary.len() / 2 + 10];
    let at = begin[middle];
    let mut stroke = Stroke::new(mesh, begin, Brush { kind: BrushKind::Smooth, radius: 0.4, strength: 1.0 }, at);
    let length = |embedding: &Embedding| -> f64 {
        (0..boundary.len())
            .map(|k| embedding[boundary[k]].distance(embedding[boundary[(k + 1) % boundary.len()]]))
            .sum()
    };
    let before = length(&stroke.begin);
    for _ in 0..10 {
        stroke.frame(at);
    }
    assert!(length(stroke.solver.embedding()) < before - 0.01);
    for &v in boundary.iter().filter(|&&v| stroke.begin[v].distance(at) > 0.5) {
        assert_eq!(stroke.solver.embedding()[v], stroke.begin[v]);
    }
}

#[test]
fn a_brush_beside_the_map_or_without_a_size_does_nothing() {
    let mut stroke = Stroke::on_sheet(BrushKind::Relax, 1.0, DVec2::splat(9.0));
    assert!(stroke.frame(DVec2::splat(9.0)).is_at_rest);
    assert!(stroke.frame(DVec2::NAN).is_at_rest);
    assert!(stroke.solver.moved().is_empty());
    let mesh = disk(jittered_sheet(4));
    let begin = from_above(&mesh);
    let target = || DragTarget { pins: Pins::new(), sheet: Arc::default() };
    for (radius, strength, at) in
        [(0.0, 1.0, 0.0), (f64::NAN, 1.0, 0.0), (1.0, f64::NAN, 0.0), (1.0, 1.0, f64::INFINITY)]
    {
        let brush = Brush { kind: BrushKind::Pinch, radius, strength };
        assert!(BrushSolver::new(&mesh, begin.clone(), target(), brush, DVec2::splat(at)).is_none());
    }
    let folded: Embedding = begin.iter().map(|z| DVec2::new(-z.x, z.y)).collect();
    let brush = Brush { kind: BrushKind::Pinch, radius: 1.0, strength: 1.0 };
    assert!(BrushSolver::new(&mesh, folded, target(), brush, DVec2::ZERO).is_none());
}

#[test]
fn a_cancelled_frame_leaves_a_proved_embedding() {
    let mut stroke = Stroke::on_sheet(BrushKind::Relax, 1.0, DVec2::ZERO);
    let cancel = AtomicBool::new(true);
    let result = stroke.solver.frame(&stroke.mesh, DVec2::ZERO, Control::new(&cancel, &|_| {}));
    assert!(matches!(result, Err(SolveError::Cancelled)));
    assert!(verdict(&stroke.mesh, stroke.solver.embedding()).planar);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn every_frame_of_every_brush_is_planar_on_triangles_and_quads(
        kind in 0_usize..5,
        strength in -1.0..1.0,
        radius in 0.02..1.5,
        quads in proptest::bool::ANY,
        way in proptest::collection::vec((-1.5..1.5, -1.5..1.5), 1..6),
    ) {
        let mesh = if quads {
            disk(quad_sheet(8, 8, 0.1, &mut Random(5)).triangulate())
        } else {
            disk(jittered_sheet(10))
        };
        let begin = from_above(&mesh);
        let place = |&(x, y): &(f64, f64)| DVec2::new(x, y);
        let brush = Brush { kind: BrushKind::ALL[kind], radius, strength };
        let mut stroke = Stroke::new(mesh, begin, brush, place(&way[0]));
        for at in &way {
            stroke.frame(place(at));
        }
    }
}
