//! Cameras, picking, draw arrays and colour scales.

use freebound::view::{
    FacePaint, MeshArrays, OrbitCamera, PICK_RADIUS, PlaneArrays, PlaneCamera, PlanePicker, Range, Scale, Sphere,
    SurfacePicker, UnitPlane, UpAxis, Visibility, crease_normals, nice_step_at_least,
};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{FaceId, VertexId};
use freebound_core::problem::Embedding;
use glam::{DVec2, DVec3, Vec4};
use proptest::prelude::*;

const PANE: DVec2 = DVec2::new(640.0, 480.0);
/// Tolerance of a round trip of the pointer, points.
const POINT_TOLERANCE: f64 = 1e-6;

fn id(v: u32) -> VertexId {
    VertexId::new(v)
}

/// Height field over the unit square with `n` × `n` vertices, faces counter-clockwise from above.
fn terrain(n: u32, height: impl Fn(f64, f64) -> f64) -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    let share = |k: u32| f64::from(k) / f64::from(n - 1);
    let position = |k: u32| {
        let (x, y) = (share(k % n), share(k / n));
        DVec3::new(x, y, height(x, y))
    };
    let squares = (0..n * (n - 1)).filter(|k| k % n != n - 1);
    let triangles = squares.flat_map(|k| [[id(k), id(k + 1), id(k + n + 1)], [id(k), id(k + n + 1), id(k + n)]]);
    ((0..n * n).map(position).collect(), triangles.collect())
}

fn bumps() -> (Vec<DVec3>, Vec<[VertexId; 3]>) {
    terrain(40, |x, y| 0.3 * (9.0 * x).sin() * (7.0 * y).cos())
}

fn some_camera(scene: Sphere) -> impl Strategy<Value = OrbitCamera> {
    let axes = prop_oneof![Just(UpAxis::Y), Just(UpAxis::Z)];
    ((-500.0..500.0, -300.0..300.0), (-100.0..100.0, -100.0..100.0), 0.2..3.0_f64, axes).prop_map(
        move |((across, along), (right, down), factor, up)| {
            let mut camera = OrbitCamera::framing(scene, up);
            camera.orbit(DVec2::new(across, along));
            camera.pan(DVec2::new(right, down), PANE);
            camera.zoom_about(scene.center, factor);
            camera
        },
    )
}

const BALL: Sphere = Sphere { center: DVec3::new(3.0, -2.0, 5.0), radius: 4.0 };

proptest! {
    #[test]
    fn a_ray_passes_through_what_shows_at_its_pixel(
        camera in some_camera(BALL), x in 0.0..640.0, y in 0.0..480.0, depth in 0.1..50.0,
    ) {
        let pointer = DVec2::new(x, y);
        let shown = camera.pane_from_world(camera.ray(pointer, PANE).at(depth), PANE).expect("before the eye");
        prop_assert!(shown.distance(pointer) < POINT_TOLERANCE, "{shown}");
    }

    #[test]
    fn zooming_in_3d_keeps_the_point_under_the_pointer(
        camera in some_camera(BALL), x in 0.0..640.0, y in 0.0..480.0, factor in 0.5..2.0_f64,
    ) {
        let pointer = DVec2::new(x, y);
        let anchor = camera.point_at_pivot_depth(pointer, PANE);
        let mut nearer = camera;
        nearer.zoom_about(anchor, factor);
        let shown = nearer.pane_from_world(anchor, PANE).expect("before the eye");
        prop_assert!(shown.distance(pointer) < POINT_TOLERANCE, "{shown}");
        prop_assert!((nearer.distance() / camera.distance() - factor).abs() < 1e-12);
    }

    #[test]
    fn panning_in_3d_moves_the_pivot_with_the_pointer(camera in some_camera(BALL), dx in -90.0..90.0, dy in -90.0..90.0) {
        let before = camera.pivot();
        let shown_before = camera.pane_from_world(before, PANE).expect("before the eye");
        let mut moved = camera;
        moved.pan(DVec2::new(dx, dy), PANE);
        let shown = moved.pane_from_world(before, PANE).expect("before the eye");
        prop_assert!((shown - shown_before).distance(DVec2::new(dx, dy)) < POINT_TOLERANCE);
    }

    #[test]
    fn up_stays_up(camera in some_camera(BALL), dx in -900.0..900.0, dy in -900.0..900.0) {
        let mut turned = camera;
        turned.orbit(DVec2::new(dx, dy));
        // The world's up axis never leans to a side on the screen and never points down.
        let view = turned.view_from_world();
        let up_is = |axis: DVec3| view.transform_vector3(axis);
        let up = if up_is(DVec3::Y).x.abs() < 1e-9 { up_is(DVec3::Y) } else { up_is(DVec3::Z) };
        prop_assert!(up.x.abs() < 1e-9 && up.y > -1e-9, "{up}");
    }

    #[test]
    fn zooming_in_the_plane_keeps_the_point_under_the_pointer(
        x in 0.0..640.0, y in 0.0..480.0, factor in 0.01..100.0_f64,
    ) {
        let pointer = DVec2::new(x, y);
        let mut camera = PlaneCamera::framing(Bounds { low: DVec2::new(-3.0, 2.0), high: DVec2::new(5.0, 9.0) }, PANE);
        let under = camera.embedding_from_pane(pointer, PANE);
        camera.zoom_at(pointer, factor, PANE);
        prop_assert!(camera.pane_from_embedding(under, PANE).distance(pointer) < POINT_TOLERANCE);
    }

    #[test]
    fn the_planes_clip_transform_agrees_with_its_pane(x in -9.0..9.0, y in -9.0..9.0) {
        let camera = PlaneCamera::framing(Bounds::UNIT, PANE);
        let unit = UnitPlane::of(Bounds { low: DVec2::new(-3.0, 2.0), high: DVec2::new(5.0, 9.0) });
        let (center, scale) = camera.unit_view(unit, PANE);
        let clip = (unit.unit_from_embedding(DVec2::new(x, y)) - center) * scale;
        let from_clip = (clip * DVec2::new(1.0, -1.0) + 1.0) / 2.0 * PANE;
        prop_assert!(from_clip.distance(camera.pane_from_embedding(DVec2::new(x, y), PANE)) < POINT_TOLERANCE);
    }

    #[test]
    fn the_nearest_vertex_in_the_plane_is_that_of_a_search_of_all(
        points in prop::collection::vec((0.0..1.0, 0.0..1.0), 1..60), x in 0.0..640.0, y in 0.0..480.0, decades in 0..12_i32,
    ) {
        // Half of the points are squeezed into a corner.
        let squeeze = 10_f64.powi(-decades);
        let embedding: Embedding = points
            .iter()
            .enumerate()
            .map(|(k, &(x, y))| DVec2::new(x, y) * if k % 2 == 0 { 1.0 } else { squeeze })
            .collect();
        let camera = PlaneCamera::framing(Bounds::UNIT, PANE);
        let pointer = DVec2::new(x, y);
        let expected = embedding
            .iter()
            .map(|&p| camera.pane_from_embedding(p, PANE).distance(pointer))
            .filter(|&distance| distance <= PICK_RADIUS)
            .min_by(f64::total_cmp);
        let found = PlanePicker::new(&embedding).nearest_vertex(&camera, PANE, pointer).map(|p| p.distance_in_points);
        prop_assert_eq!(found.is_some(), expected.is_some());
        prop_assert!(found.zip(expected).is_none_or(|(a, b)| (a - b).abs() < POINT_TOLERANCE));
    }

    #[test]
    fn the_nearest_vertex_on_the_mesh_is_that_of_a_search_of_all(x in 0.0..640.0, y in 0.0..480.0, turn in 0.0..900.0) {
        let (positions, triangles) = bumps();
        let mut camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Z);
        camera.orbit(DVec2::new(turn, 60.0));
        let pointer = DVec2::new(x, y);
        let picker = SurfacePicker::new(&positions, &triangles);
        for visibility in [Visibility::All, Visibility::Visible] {
            let expected = (0..)
                .zip(&positions)
                .filter(|&(v, _)| visibility == Visibility::All || picker.is_visible(id(v), camera.eye()))
                .filter_map(|(_, &p)| Some(camera.pane_from_world(p, PANE)?.distance(pointer)))
                .filter(|&distance| distance <= PICK_RADIUS)
                .min_by(f64::total_cmp);
            let found = picker.nearest_vertex(&camera, PANE, pointer, visibility);
            prop_assert_eq!(found.map(|pick| pick.distance_in_points), expected);
        }
    }

    #[test]
    fn the_first_hit_is_that_of_a_search_of_all_faces(x in 0.0..640.0, y in 0.0..480.0, turn in 0.0..900.0) {
        let (positions, triangles) = bumps();
        let mut camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Z);
        camera.orbit(DVec2::new(turn, 0.0));
        let ray = camera.ray(DVec2::new(x, y), PANE);
        let alone = |t: &[VertexId; 3]| SurfacePicker::new(&positions, std::slice::from_ref(t)).hit(ray);
        let expected = triangles.iter().filter_map(alone).map(|hit| hit.distance).min_by(f64::total_cmp);
        let hit = SurfacePicker::new(&positions, &triangles).hit(ray);
        prop_assert_eq!(hit.map(|hit| hit.distance), expected);
        if let Some(hit) = hit {
            let corners = triangles[hit.face.index()].map(|v| positions[v.index()]);
            let point: DVec3 = corners.iter().zip(hit.weights).map(|(&p, w)| w * p).sum();
            prop_assert!(point.distance(hit.point) < 1e-9);
        }
    }
}

#[test]
fn framing_shows_the_whole_mesh_at_any_scale_and_place() {
    for scale in [1e-6, 1.0, 1e6] {
        for pane in [DVec2::new(900.0, 300.0), DVec2::new(200.0, 700.0)] {
            let (positions, triangles) = bumps();
            let positions: Vec<DVec3> = positions.iter().map(|&p| scale * (p + 1000.0)).collect();
            let arrays = MeshArrays::new(&positions, &triangles);
            let mut camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Y);
            // A pane of any size shows what one of another size shows.
            camera.frame(Sphere::around(&positions));
            let clip_from_unit = camera.clip_from_unit(arrays.frame, pane);
            for &[x, y, z] in &arrays.points {
                let clip = clip_from_unit * Vec4::new(x, y, z, 1.0);
                let ndc = clip.truncate() / clip.w;
                assert!(
                    ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0 && (0.0..=1.0).contains(&ndc.z),
                    "{scale} {pane}: {ndc}"
                );
            }
        }
    }
}

#[test]
fn setting_the_pivot_brings_it_to_the_middle_and_does_not_turn() {
    let mut camera = OrbitCamera::framing(BALL, UpAxis::Y);
    let before = camera.view_from_world();
    let point = BALL.center + DVec3::new(1.0, 2.0, -0.5);
    camera.set_pivot(point);
    let shown = camera.pane_from_world(point, PANE).expect("before the eye");
    assert!(shown.distance(PANE / 2.0) < POINT_TOLERANCE, "{shown}");
    let turned = before.transform_vector3(DVec3::X) - camera.view_from_world().transform_vector3(DVec3::X);
    assert!(turned.length() < 1e-12);
}

#[test]
fn the_first_view_is_of_the_side_that_the_surface_faces() {
    for normal in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::Z, DVec3::NEG_Z, DVec3::new(1.0, 1.0, -1.0)] {
        for up in [UpAxis::Y, UpAxis::Z] {
            let camera = OrbitCamera::facing(BALL, up, normal);
            let to_eye = camera.eye() - BALL.center;
            // Surfaces that face down are seen from the side: the turntable starts no view from below.
            let is_down = normal == DVec3::NEG_Z && up == UpAxis::Z;
            assert!(to_eye.dot(normal) > 0.0 || is_down, "{normal} {up:?}");
        }
    }
}

#[test]
fn a_hidden_vertex_is_picked_with_x_ray_only() {
    // A small triangle with vertex 4 on its middle axis, and a large one in front of it.
    let positions = [
        DVec3::new(-3.0, -3.0, 1.0),
        DVec3::new(3.0, -3.0, 1.0),
        DVec3::new(0.0, 3.0, 1.0),
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(0.1, 0.0, 0.0),
        DVec3::new(0.0, 0.1, 0.0),
    ];
    let triangles = [[id(0), id(1), id(2)], [id(3), id(4), id(5)]];
    let picker = SurfacePicker::new(&positions, &triangles);
    let mut camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Y);
    camera.orbit(DVec2::new(50.0, -0.2 / 0.007));
    let pointer = camera.pane_from_world(positions[3], PANE).expect("before the eye");
    assert_eq!(picker.nearest_vertex(&camera, PANE, pointer, Visibility::Visible), None);
    let all = picker.nearest_vertex(&camera, PANE, pointer, Visibility::All).expect("one lies there");
    assert_eq!(all.vertex, id(3));
    // Seen from behind, nothing hides it.
    camera.orbit(DVec2::new(std::f64::consts::PI / 0.007, 0.0));
    let pointer = camera.pane_from_world(positions[3], PANE).expect("before the eye");
    assert_eq!(picker.nearest_vertex(&camera, PANE, pointer, Visibility::Visible).map(|p| p.vertex), Some(id(3)));
}

#[test]
fn nothing_is_picked_far_from_all_vertices() {
    let (positions, triangles) = bumps();
    let camera = OrbitCamera::framing(Sphere::around(&positions), UpAxis::Z);
    let picker = SurfacePicker::new(&positions, &triangles);
    assert_eq!(picker.nearest_vertex(&camera, PANE, DVec2::new(2.0, 2.0), Visibility::All), None);
}

#[test]
fn split_points_tell_apart_what_one_f32_cannot() {
    let near = 1e-12;
    let triangles = [[id(0), id(1), id(2)]];
    let arrays =
        PlaneArrays::new(&[DVec2::new(0.3, 0.0), DVec2::new(0.3 + near, 0.0), DVec2::new(1.0, 1.0)], &triangles);
    let x = |v: usize| f64::from(arrays.points[v][0]) + f64::from(arrays.points[v][2]);
    let expected = near / arrays.frame.embedding_per_unit;
    assert!((x(1) - x(0) - expected).abs() < 0.01 * expected, "{}", x(1) - x(0));
}

#[test]
fn a_cube_has_edges_and_a_bent_sheet_has_none() {
    let fold = |angle: f64| {
        let positions = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
            DVec3::new(-1.0, 0.0, 0.0),
            DVec3::new(angle.cos(), 0.0, angle.sin()),
        ];
        crease_normals(&positions, &[[id(0), id(1), id(2)], [id(1), id(0), id(3)]])
    };
    let right_angle = fold(std::f64::consts::FRAC_PI_2);
    assert_eq!(right_angle[0], DVec3::Z);
    let gentle = fold(0.4);
    assert!((gentle[0] - gentle[4]).length() < 1e-12, "both sides of the bend share their normal");
}

#[test]
fn every_array_has_its_own_revision_and_flags_stay_with_their_faces() {
    let paint = FacePaint::plain(3, &[FaceId::new(1), FaceId::new(99)]);
    let other = FacePaint::plain(3, &[FaceId::new(1)]);
    assert_ne!(paint.revision, other.revision);
    assert_eq!(paint.flipped, [FaceId::new(1)]);
    let flags: Vec<u8> = paint.corners.iter().map(|corner| corner[3]).collect();
    assert_eq!(flags, [0, 0, 0, 1, 1, 1, 0, 0, 0]);
}

#[test]
fn one_outlier_in_a_hundred_does_not_widen_a_range() {
    let mut values: Vec<f64> = (0..1000).map(|k| 1.0 + f64::from(k) / 1000.0).collect();
    values[17] = 1e9;
    values[18] = f64::NAN;
    let range = Scale::Angle.robust_range(&values);
    assert!(range.low.to_bits() == 1.0_f64.to_bits() && (1.9..2.1).contains(&range.high), "{range:?}");
    let logs: Vec<f64> = values.iter().map(|v| v.log2()).collect();
    let range = Scale::Area.robust_range(&logs);
    assert!((range.low + range.high).abs() < 1e-15 && (0.9..1.1).contains(&range.high), "{range:?}");
}

#[test]
fn rounding_is_not_shown_as_distortion() {
    let nearly_conformal: Vec<f64> = (0..100).map(|k| 1.0 + 1e-12 * f64::from(k)).collect();
    let range = Scale::Angle.robust_range(&nearly_conformal);
    assert_eq!(Scale::Angle.colour(nearly_conformal[99], range), [255, 255, 255]);
    for scale in [Scale::Angle, Scale::Area, Scale::Stretch] {
        for values in [&[][..], &[f64::NAN], &[2.0], &[0.0, 0.0]] {
            let range = scale.robust_range(values);
            assert!(range.high > range.low && range.low.is_finite() && range.high.is_finite(), "{scale:?} {values:?}");
        }
    }
}

#[test]
fn scales_mean_what_their_legends_say() {
    let range = Range { low: -2.0, high: 2.0 };
    let [r, g, b] = Scale::Area.colour(0.0, range);
    assert!(r > 240 && g > 240 && b > 240, "equal areas are white");
    let [r, _, b] = Scale::Area.colour(2.0, range);
    assert!(r > 2 * b, "enlarged is red");
    let [r, _, b] = Scale::Area.colour(-5.0, range);
    assert!(b > 2 * r, "shrunk is blue, and beyond the range stays so");
    let labels: Vec<String> = Scale::Area.ticks(range).into_iter().map(|tick| tick.label).collect();
    assert_eq!(labels, ["¼", "½", "1", "2", "4"]);
}

#[test]
fn ticks_are_nice_numbers_in_order_within_the_bar() {
    for (low, high) in [(1.0, 1.1), (1.0, 2.37), (0.002, 0.9), (1.0, 1234.5), (1e-9, 3e-9)] {
        let ticks = Scale::Stretch.ticks(Range { low, high });
        assert!((2..=6).contains(&ticks.len()), "{low} {high}: {ticks:?}");
        assert!(ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.at)));
        assert!(ticks.windows(2).all(|pair| pair[0].at < pair[1].at && pair[0].label != pair[1].label), "{ticks:?}");
    }
    let labels: Vec<String> = Scale::Angle.ticks(Range { low: 1.0, high: 2.1 }).into_iter().map(|t| t.label).collect();
    assert_eq!(labels, ["1.0", "1.5", "2.0"]);
}

#[test]
fn nice_steps_are_one_two_or_five() {
    for (width, at_least) in [(0.9, 1.0), (1.0, 1.0), (2.1, 5.0), (0.03, 0.05), (70.0, 100.0)] {
        assert!((nice_step_at_least(width) / at_least - 1.0).abs() < 1e-12, "{width}");
    }
}

#[test]
fn grid_lines_keep_a_readable_distance_through_all_zooms() {
    let mut camera = PlaneCamera::framing(Bounds::UNIT, PANE);
    for _ in 0..200 {
        let grid = camera.grid();
        let spacing = grid.step * camera.points_per_unit();
        assert!((17.9..=46.0).contains(&spacing), "{spacing}");
        let major = (grid.step * f64::from(grid.steps_per_major)).log10();
        assert!((major - major.round()).abs() < 1e-9, "stronger lines stand at powers of ten: {grid:?}");
        camera.zoom_at(PANE / 2.0, 1.1, PANE);
    }
}

#[test]
fn a_face_is_seen_unless_another_hides_its_middle() {
    // A small sheet hides the middle of a large one below it.
    let (mut positions, mut triangles) = terrain(9, |_, _| 0.0);
    let (large, faces) = (positions.len(), triangles.len());
    let (small, others) = terrain(3, |_, _| 0.3);
    positions.extend(small.iter().map(|&at| at * DVec3::new(0.5, 0.5, 1.0) + DVec3::new(0.25, 0.25, 0.0)));
    let moved = |vertex: VertexId| VertexId::from_index(large + vertex.index());
    triangles.extend(others.iter().map(|corners| corners.map(moved)));
    let picker = SurfacePicker::new(&positions, &triangles);
    let eye = DVec3::new(0.5, 0.5, 100.0);
    for (face, corners) in triangles.iter().enumerate() {
        let middle = corners.iter().map(|corner| positions[corner.index()]).sum::<DVec3>() / 3.0;
        let is_below = face < faces && (middle - 0.5).truncate().abs().max_element() < 0.25;
        assert_eq!(picker.is_face_visible(FaceId::from_index(face), eye), !is_below, "{face}");
    }
    assert!(!picker.is_face_visible(FaceId::from_index(triangles.len()), eye), "no such face");
}
