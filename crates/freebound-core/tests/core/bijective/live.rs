//! Dragging pins of a planar embedding. Every frame is planar, and the verdict proved for the moved region equals
//! the whole verdict. The pin follows the pointer if there is clearance; otherwise it stops short and the blockers
//! are named.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use freebound_core::bijective::{Blocker, DragFrame, DragSolver, DragTarget};
use freebound_core::geom::{PictureFrame, VAxis};
use freebound_core::mesh::{DiskMesh, Preparation, TriMesh, VertexId};
use freebound_core::nonlinear::foldover_energy::{Element, Energy, Stiffness};
use freebound_core::problem::{Control, Embedding, Pin, Pins, SolveError, hard_pins};
use freebound_core::verify::{UvFrame, verdict};
use glam::DVec2;
use proptest::prelude::*;

use freebound_testkit::surfaces::without_faces;
use freebound_testkit::{Random, disk, grid, jittered_sheet, quad_sheet};

/// View of a mesh from above, planar for a sheet.
fn from_above(mesh: &DiskMesh) -> Embedding {
    mesh.mesh().positions.iter().map(|p| p.truncate()).collect()
}

fn nearest(embedding: &Embedding, z: DVec2) -> VertexId {
    let at = (0..embedding.len()).min_by(|&a, &b| embedding[a].distance(z).total_cmp(&embedding[b].distance(z)));
    VertexId::from_index(at.unwrap())
}

/// Pins near the given points of a sheet, in place.
fn pins_near(embedding: &Embedding, places: &[[f64; 2]]) -> (Vec<VertexId>, Pins) {
    let vertices: Vec<VertexId> = places.iter().map(|&z| nearest(embedding, z.into())).collect();
    let pins = hard_pins(vertices.iter().map(|&v| (v, embedding[v])));
    (vertices, pins)
}

/// Drag on a mesh; [`Drag::frame`] checks every frame.
struct Drag {
    mesh: DiskMesh,
    live: DragSolver,
    pins: Pins,
    begin: Embedding,
}

impl Drag {
    fn new(mesh: DiskMesh, begin: Embedding, dragged: VertexId, pins: Pins) -> Self {
        let aim = DragTarget { pins: pins.clone(), sheet: Arc::default() };
        let live = DragSolver::new(&mesh, begin.clone(), &[dragged], aim).expect("planar at first");
        Self { mesh, live, pins, begin }
    }

    /// Bumpy sheet with `cells` cells per side. Four pins form a ring about the middle, four are near the corners.
    /// The first is dragged.
    fn on_sheet(cells: u32) -> (Self, VertexId) {
        let mesh = disk(jittered_sheet(cells));
        let begin = from_above(&mesh);
        let ring = [[0.3, 0.0], [0.0, 0.3], [-0.3, 0.0], [0.0, -0.3]];
        let corners = [[0.8, 0.8], [-0.8, 0.8], [-0.8, -0.8], [0.8, -0.8]];
        let (vertices, pins) = pins_near(&begin, &[ring, corners].concat());
        (Self::new(mesh, begin, vertices[0], pins), vertices[0])
    }

    fn frame(&mut self, target: DVec2) -> DragFrame {
        for v in self.live.dragged() {
            self.pins.get_mut(v).unwrap().target = target;
        }
        let aim = DragTarget { pins: self.pins.clone(), sheet: Arc::default() };
        let moved = self.live.drag(&self.mesh, &aim, Control::unattended()).unwrap();
        assert_eq!(moved.verdict, verdict(&self.mesh, self.live.embedding()), "of what moved and of the whole");
        assert!(moved.verdict.planar);
        moved
    }

    /// Runs frames until nothing moves.
    fn rest_at(&mut self, target: DVec2) -> DragFrame {
        for _ in 0..60 {
            let moved = self.frame(target);
            if moved.is_at_rest {
                return moved;
            }
        }
        panic!("it never comes to rest");
    }

    /// Largest distance of a vertex from its initial position.
    fn farthest(&self) -> f64 {
        self.begin.iter().zip(self.live.embedding()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }
}

#[test]
fn a_pin_dragged_around_a_circle_is_on_the_pointer_and_the_sheet_planar_at_every_frame() {
    let (mut drag, pin) = Drag::on_sheet(24);
    let middle = drag.begin[pin] - DVec2::new(0.12, 0.0);
    for k in 1..=24 {
        let target = middle + 0.12 * DVec2::from_angle(f64::from(k) / 24.0 * std::f64::consts::TAU);
        let moved = drag.frame(target);
        assert_eq!((drag.live.embedding()[pin], moved.reached, moved.obstacle), (target, 1.0, None), "frame {k}");
    }
    for (v, held) in drag.pins.iter().filter(|(v, _)| **v != pin) {
        assert_eq!(drag.live.embedding()[v], held.target, "the others stay");
    }
}

#[test]
fn only_a_neighbourhood_moves_and_it_grows_with_the_way() {
    let (mut drag, pin) = Drag::on_sheet(80);
    let from = drag.begin[pin];
    drag.frame(from + DVec2::new(0.002, 0.0));
    let small = drag.live.moving().len();
    assert!(small < drag.mesh.vertex_count() / 2, "{small} of {}", drag.mesh.vertex_count());
    let mut moving = vec![false; drag.mesh.vertex_count()];
    drag.live.moving().iter().for_each(|v| moving[v.index()] = true);
    let stays = |v: VertexId| moving[v.index()] || drag.live.embedding()[v] == drag.begin[v];
    assert!(drag.mesh.vertices().all(stays));
    drag.frame(from + DVec2::new(0.0, 0.2));
    assert!(drag.live.moving().len() > 2 * small, "{} of {small}", drag.live.moving().len());
}

#[test]
fn a_pin_that_comes_back_brings_back_what_it_began_with() {
    let (mut drag, pin) = Drag::on_sheet(60);
    let from = drag.begin[pin];
    drag.frame(from + DVec2::new(0.03, 0.03));
    drag.rest_at(from);
    (0..3).for_each(|_| drop(drag.frame(from)));
    assert!(drag.farthest() < 1e-9, "{:.1e}", drag.farthest());
    let (mut drag, pin) = Drag::on_sheet(16);
    let from = drag.begin[pin];
    for k in 1..=4 {
        drag.frame(from + 0.04 * f64::from(k) * DVec2::new(1.0, 1.0));
    }
    assert!(drag.farthest() > 0.15);
    drag.rest_at(from);
    // Not exact: the scaffold, retriangulated during the drag, does not return to its initial state.
    assert!(drag.farthest() < 2e-3, "{:.1e}", drag.farthest());
}

#[test]
fn at_rest_no_free_vertex_is_drawn_anywhere_by_the_energy_of_the_faces() {
    let (mut drag, pin) = Drag::on_sheet(90);
    let target = drag.begin[pin] + DVec2::new(0.01, 0.015);
    drag.rest_at(target);
    for _ in 0..3 {
        drag.frame(target);
    }
    let gradient_of = |z: &Embedding| {
        let mut gradient = vec![DVec2::ZERO; drag.mesh.vertex_count()];
        for face in drag.mesh.faces() {
            let rest = drag.begin.corners(&drag.mesh, face);
            let area = (rest[1] - rest[0]).perp_dot(rest[2] - rest[0]);
            let element = Element::new(
                drag.mesh.face(face).map(VertexId::number),
                rest,
                Stiffness { weight: area, thinnest: 0.0 },
            );
            let model = element.model(z.corners(&drag.mesh, face), Energy::Foldover(0.0));
            for (v, g) in drag.mesh.face(face).iter().zip(model.gradient.chunks_exact(2)) {
                gradient[v.index()] += DVec2::from_slice(g);
            }
        }
        gradient
    };
    let gradient = gradient_of(drag.live.embedding());
    let free = drag.live.moving().iter().filter(|v| !drag.pins.contains_key(v));
    assert!(drag.live.moving().iter().all(|&v| drag.mesh.boundary_place(v).is_none()), "the outside has no part in it");
    let largest = free.map(|v| gradient[v.index()].length()).fold(0.0, f64::max);
    let at_pin = gradient[pin.index()].length();
    assert!(largest < 1e-6 * at_pin, "{largest:.1e}, at the pin {at_pin:.1e}");
}

#[test]
fn a_pin_dragged_over_another_lags_on_its_line_and_names_it() {
    let (mut drag, pin) = Drag::on_sheet(24);
    let other = *drag.pins.keys().find(|&&v| drag.begin[v].distance(DVec2::new(-0.3, 0.0)) < 0.1).unwrap();
    let (from, over) = (drag.begin[pin], drag.begin[other]);
    let target = over + 0.5 * (over - from);
    let mut last = None;
    for k in 1..=10 {
        last = Some(drag.frame(from.lerp(target, f64::from(k) / 10.0)));
    }
    let stuck = drag.rest_at(target);
    assert_eq!(stuck.obstacle, Some(Blocker::Pin(other)), "{last:?}");
    let place = drag.live.embedding()[pin];
    let (along, across) = ((place - from).dot(over - from), (place - from).perp_dot(over - from));
    let way = over.distance_squared(from);
    assert!(across.abs() < 1e-3 * way, "on its line but for {:.1e}", across / way);
    assert!((0.5 * way..way).contains(&along), "before the other pin: {}", along / way);
    let away = from + DVec2::new(0.0, 0.05);
    for _ in 0..12 {
        drag.frame(away);
    }
    assert_eq!(drag.live.embedding()[pin], away, "it comes away again");
}

#[test]
fn a_boundary_pin_goes_out_beyond_the_frame_and_in_again() {
    let mesh = disk(jittered_sheet(16));
    let begin = from_above(&mesh);
    let (vertices, pins) = pins_near(&begin, &[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.0, 0.0]]);
    assert!(mesh.boundary_place(vertices[0]).is_some());
    let mut drag = Drag::new(mesh, begin, vertices[0], pins);
    let from = drag.begin[vertices[0]];
    for x in [0.1, 0.4, 0.8, 1.4, 2.0] {
        drag.frame(from + DVec2::new(x, 0.2));
    }
    let out = drag.rest_at(from + DVec2::new(2.0, 0.2));
    assert_eq!((out.reached, drag.live.embedding()[vertices[0]]), (1.0, from + DVec2::new(2.0, 0.2)));
    for x in [1.0, 0.2, -0.2, -0.4] {
        drag.frame(from + DVec2::new(x, 0.0));
    }
    let inside = drag.rest_at(from + DVec2::new(-0.4, 0.0));
    assert_eq!((inside.reached, drag.live.embedding()[vertices[0]]), (1.0, from + DVec2::new(-0.4, 0.0)));
}

/// Two arms with a slot between them.
fn fork() -> DiskMesh {
    let mesh = grid(13, 9);
    let kept = mesh.triangles.iter().filter(|t| {
        let middle = t.iter().map(|v| mesh.positions[v.index()].truncate()).sum::<DVec2>() / 3.0;
        !((5.0..8.0).contains(&middle.x) && middle.y > 2.0)
    });
    let triangles: Vec<[u32; 3]> = kept.map(|t| t.map(VertexId::number)).collect();
    disk(TriMesh::new(mesh.positions.clone(), &triangles))
}

#[test]
fn an_arm_dragged_against_another_stops_before_it_and_says_so() {
    let mesh = fork();
    let begin = from_above(&mesh);
    let places = [[5.0, 8.0], [8.0, 3.0], [8.0, 4.0], [8.0, 5.0], [8.0, 6.0], [8.0, 7.0], [8.0, 8.0], [8.0, 9.0]];
    let (vertices, pins) = pins_near(&begin, &places);
    let mut drag = Drag::new(mesh, begin, vertices[0], pins);
    let mut obstacles = Vec::new();
    for _ in 0..25 {
        obstacles.extend(drag.frame(DVec2::new(10.0, 8.0)).obstacle);
    }
    let place = drag.live.embedding()[vertices[0]];
    assert!((7.5..8.0).contains(&place.x), "{place}");
    let is_arm = |obstacle: &Blocker| match obstacle {
        Blocker::Boundary(v) | Blocker::Pin(v) => (drag.begin[v].x - 8.0).abs() < 1.5,
        Blocker::Surroundings => false,
    };
    assert!(obstacles.last().is_some_and(is_arm), "{obstacles:?}");
}

#[test]
fn a_weighted_pin_follows_by_its_weight() {
    let mesh = disk(jittered_sheet(12));
    let begin = from_above(&mesh);
    let follows = |weight: f64| {
        let (vertices, mut pins) = pins_near(&begin, &[[0.0, 0.0], [-0.8, 0.8], [0.8, 0.8], [0.0, -0.8]]);
        pins.insert(vertices[0], Pin::weighted(begin[vertices[0]] + DVec2::new(0.3, 0.0), weight));
        let mut drag = Drag::new(mesh.clone(), begin.clone(), vertices[0], pins);
        // Its target was not met before and need not be met now: the vertex moves as its target moves.
        let target = drag.pins[&vertices[0]].target + DVec2::new(0.0, 0.1);
        drag.rest_at(target);
        drag.live.embedding()[vertices[0]] - begin[vertices[0]]
    };
    let ways = [0.1, 1.0, 100.0].map(follows);
    assert!(ways.is_sorted_by(|a, b| a.y < b.y), "{ways:?}");
    assert!(ways.iter().all(|way| way.x.abs() < 0.02) && (ways[2].y - 0.1).abs() < 1e-3, "{ways:?}");
}

#[test]
fn pins_dragged_together_keep_their_distance() {
    let mesh = disk(jittered_sheet(20));
    let begin = from_above(&mesh);
    let (vertices, pins) = pins_near(&begin, &[[0.1, 0.1], [-0.1, 0.0], [-0.8, 0.8], [0.8, -0.8]]);
    let mut live =
        DragSolver::new(&mesh, begin.clone(), &vertices[..2], DragTarget { pins: pins.clone(), sheet: Arc::default() })
            .unwrap();
    let mut aimed = pins.clone();
    for k in 1..=5 {
        for v in &vertices[..2] {
            aimed.insert(*v, Pin::hard(begin[v] + 0.05 * f64::from(k) * DVec2::Y));
        }
        let aim = DragTarget { pins: aimed.clone(), sheet: Arc::default() };
        let moved = live.drag(&mesh, &aim, Control::unattended()).unwrap();
        assert_eq!(moved.verdict, verdict(&mesh, live.embedding()));
        assert!(vertices.iter().all(|v| live.embedding()[v] == aimed[v].target), "step {k}");
    }
}

#[test]
fn a_drag_gives_the_same_bytes_on_one_thread_and_on_three() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut drag, pin) = Drag::on_sheet(48);
            let from = drag.begin[pin];
            for k in 1..=3 {
                drag.frame(from + 0.05 * f64::from(k) * DVec2::new(-1.0, 0.7));
            }
            drag.live.embedding().clone()
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn what_is_folded_or_mirrored_is_no_start() {
    let mesh = disk(jittered_sheet(6));
    let flat = from_above(&mesh);
    let (vertices, pins) = pins_near(&flat, &[[0.0, 0.0], [0.5, 0.5], [-0.5, 0.5]]);
    let starts = |embedding: Embedding| {
        DragSolver::new(&mesh, embedding, &vertices[..1], DragTarget { pins: pins.clone(), sheet: Arc::default() })
            .is_some()
    };
    assert!(starts(flat.clone()));
    assert!(!starts(flat.iter().map(|z| DVec2::new(-z.x, z.y)).collect()));
    let mut folded = flat.clone();
    folded[vertices[0]] = DVec2::splat(0.9);
    assert!(!starts(folded));
    assert!(!starts(flat.iter().map(|z| z * 1e-200).collect()), "too small to tell");
    let alien =
        DragSolver::new(&mesh, flat, &[VertexId::new(0)], DragTarget { pins: pins.clone(), sheet: Arc::default() });
    assert!(alien.is_none(), "no pin, no drag");
}

#[test]
fn a_frame_that_is_stopped_or_asked_for_the_impossible_leaves_what_is_proved() {
    let (mut drag, pin) = Drag::on_sheet(12);
    let target = drag.begin[pin] + DVec2::new(0.05, 0.0);
    drag.frame(target);
    let before = drag.live.embedding().clone();
    let pins = hard_pins([(pin, target + 0.1)]).into_iter().chain(drag.pins.clone()).collect();
    let stop = AtomicBool::new(true);
    let result = drag.live.drag(&drag.mesh, &DragTarget { pins, sheet: Arc::default() }, Control::new(&stop, &|_| {}));
    assert_eq!(result.unwrap_err(), SolveError::Cancelled);
    assert_eq!(*drag.live.embedding(), before);
    for wild in [DVec2::splat(f64::NAN), DVec2::splat(f64::INFINITY)] {
        drag.frame(wild);
        assert_eq!(*drag.live.embedding(), before);
    }
    drag.frame(DVec2::splat(1e300));
    drag.frame(target);
}

/// Random drags with every frame checked: on triangles, on quads, and around filled holes. Returns true if there was
/// a planar embedding to begin with.
fn random_drags(kind: u32, sheet: &UvFrame, offset: DVec2, random: &mut Random) -> Result<bool, TestCaseError> {
    let mesh = match kind {
        0 => disk(jittered_sheet(5 + random.below(4))),
        1 => disk(quad_sheet(6, 6, 0.1, random).triangulate()),
        _ => {
            let holed = without_faces(&quad_sheet(6, 6, 0.0, random), |face| face == 14 || face == 28);
            disk(Preparation::default().repaired(&holed).triangulate())
        }
    };
    let begin: Embedding = from_above(&mesh).iter().map(|z| z + offset).collect();
    let size = begin.bounds().extent();
    let count = u32::try_from(mesh.real_vertex_count()).unwrap();
    let vertices: Vec<VertexId> = (0..5).map(|_| VertexId::new(random.below(count))).collect();
    let mut pins = hard_pins(vertices.iter().map(|&v| (v, begin[v])));
    let aim = DragTarget { pins: pins.clone(), sheet: Arc::new(sheet.clone()) };
    let start = verdict(&mesh, &sheet.written(&begin));
    let live = DragSolver::new(&mesh, begin, &vertices[..1], aim);
    prop_assert_eq!(live.is_some(), start.planar && !start.mirrored && !start.is_filling_folded);
    let Some(mut live) = live else { return Ok(false) };
    for _ in 0..6 {
        let by = size * 0.4 * DVec2::new(random.unit() - 0.5, random.unit() - 0.5);
        pins.insert(vertices[0], Pin::hard(live.embedding()[vertices[0]] + by));
        let aim = DragTarget { pins: pins.clone(), sheet: Arc::new(sheet.clone()) };
        let moved = live.drag(&mesh, &aim, Control::unattended()).unwrap();
        let whole = verdict(&mesh, &live.sheet().written(live.embedding()));
        prop_assert!(whole.planar && !whole.is_filling_folded);
        prop_assert_eq!(moved.verdict, whole);
    }
    Ok(true)
}

#[test]
fn polygons_stay_convex_and_filled_holes_open() {
    for kind in 0..3 {
        let begun =
            (1..=8).filter(|&seed| random_drags(kind, &UvFrame::default(), DVec2::ZERO, &mut Random(seed)).unwrap());
        assert!(begun.count() > 4, "kind {kind}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 24, ..ProptestConfig::default() })]

    /// Far from the origin few digits remain in 32 bits, and coordinates are rounded for pictures that are not
    /// square.
    #[test]
    fn what_is_proved_of_the_region_is_the_verdict_on_the_whole(kind in 0_u32..3, far in 0_u32..3, seed in 1_u32..) {
        let mut random = Random(seed.into());
        let offset = [DVec2::ZERO, DVec2::new(1e5, 0.0), DVec2::new(3e6, -1e6)][far as usize];
        let frame = PictureFrame { aspect: 1.3, v_axis: if seed % 2 == 0 { VAxis::Up } else { VAxis::Down } };
        let sheet = if seed % 3 == 0 { UvFrame::default() } else { UvFrame::new(frame, freebound_core::problem::PinPositions::new()) };
        random_drags(kind, &sheet, offset, &mut random)?;
    }
}
