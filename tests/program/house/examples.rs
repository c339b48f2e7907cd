//! Built-in meshes: disks of well-shaped triangles.

use std::collections::BTreeMap;
use std::sync::{LazyLock, OnceLock};

use freebound::examples::{Example, Landmark};
use freebound_core::mesh::TriMesh;
use glam::{DVec2, DVec3};

use freebound_testkit::PORTRAIT_SIZE;

/// Landmarks of the face, read once.
static LANDMARKS: LazyLock<Vec<Landmark>> = LazyLock::new(|| Example::Face.landmarks());

/// Mesh shared by all tests.
fn mesh_of(example: Example) -> &'static TriMesh {
    static MESHES: [OnceLock<TriMesh>; 6] = [const { OnceLock::new() }; 6];
    let place = Example::ALL.iter().position(|e| *e == example).expect("one of all");
    MESHES[place].get_or_init(|| example.mesh())
}

/// Directed sides of all triangles, with their counts.
fn sides(mesh: &TriMesh) -> BTreeMap<(u32, u32), usize> {
    let mut count = BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            *count.entry((t[k].number(), t[(k + 1) % 3].number())).or_insert(0) += 1;
        }
    }
    count
}

/// Number of boundary loops; `None` unless every boundary vertex has one side in and one out.
fn boundary_loops(mesh: &TriMesh) -> Option<usize> {
    let sides = sides(mesh);
    let mut next = BTreeMap::new();
    for &(a, b) in sides.keys().filter(|&&(a, b)| !sides.contains_key(&(b, a))) {
        if next.insert(a, b).is_some() {
            return None;
        }
    }
    let mut loops = 0;
    while let Some((start, mut at)) = next.pop_first() {
        while at != start {
            at = next.remove(&at)?;
        }
        loops += 1;
    }
    Some(loops)
}

/// Smallest angle of any corner, degrees.
fn least_angle(mesh: &TriMesh) -> f64 {
    let mut least = f64::INFINITY;
    for t in &mesh.triangles {
        let p = t.map(|v| mesh.positions[v.index()]);
        for k in 0..3 {
            let (u, w) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            least = least.min(u.cross(w).length().atan2(u.dot(w)).to_degrees());
        }
    }
    least
}

/// True if the corners at every vertex form a single fan: their number equals the number reached from face to face.
fn fans_are_single(mesh: &TriMesh) -> bool {
    let mut next: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); mesh.vertex_count()];
    for t in &mesh.triangles {
        for k in 0..3 {
            next[t[k].index()].insert(t[(k + 1) % 3].number(), t[(k + 2) % 3].number());
        }
    }
    next.iter().all(|ring| {
        let Some(start) = ring.keys().find(|a| ring.values().all(|b| b != *a)).or(ring.keys().next()) else {
            return false;
        };
        let (mut at, mut steps) = (*start, 0);
        while let Some(&b) = ring.get(&at) {
            (at, steps) = (b, steps + 1);
            if at == *start {
                break;
            }
        }
        steps == ring.len()
    })
}

#[test]
fn every_example_is_a_disk() {
    for example in Example::ALL {
        let mesh = mesh_of(example);
        let sides = sides(mesh);
        assert!(sides.values().all(|&n| n == 1), "{}: two faces on the same side of an edge", example.name());
        let boundary = sides.keys().filter(|&&(a, b)| !sides.contains_key(&(b, a))).count();
        let edges = usize::midpoint(sides.len(), boundary);
        assert_eq!(mesh.vertex_count() + mesh.face_count(), edges + 1, "{}: Euler number", example.name());
        assert_eq!(boundary_loops(mesh), Some(1), "{}: boundary loops", example.name());
        assert!(fans_are_single(mesh), "{}: a vertex with two fans, or none", example.name());
    }
}

#[test]
fn every_example_has_good_triangles() {
    for example in Example::ALL {
        let mesh = mesh_of(example);
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "{}", example.name());
        let (faces, angle) = match example {
            Example::Face => (5_000..=10_000, 10.0),
            _ => (500..=6_000, 22.0),
        };
        assert!(faces.contains(&mesh.face_count()), "{}: {} faces", example.name(), mesh.face_count());
        assert!(least_angle(mesh) > angle, "{}: least angle {}°", example.name(), least_angle(mesh));
    }
}

#[test]
fn names_differ() {
    let mut names: Vec<&str> = Example::ALL.iter().flat_map(|e| [e.name(), e.title(), e.about()]).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn the_flat_examples_are_flat_and_do_not_overlap() {
    // The L is three unit squares. The strip's area is its width times the length of its middle line, which is ∫
    // √(r² + r′²) dφ with r = 0.22 + 0.3 φ/2π. Chords cut off a little of it.
    let middle: f64 = (0..30_000)
        .map(|k| {
            let turn = (f64::from(k) + 0.5) / 10_000.0;
            let radius = 0.22 + 0.3 * turn;
            (radius * std::f64::consts::TAU).hypot(0.3) / 10_000.0
        })
        .sum();
    for (example, area, tolerance) in [(Example::Ell, 3.0, 1e-12), (Example::Spiral, 0.15 * middle, 0.01)] {
        let mesh = mesh_of(example);
        assert!(mesh.positions.iter().all(|p| p.z == 0.0));
        let up =
            (0..mesh.face_count()).map(freebound_core::mesh::FaceId::from_index).map(|f| mesh.double_area_vector(f).z);
        assert!(up.clone().all(|z| z > 0.0), "{}: a face looks down", example.name());
        // All faces point up, and their total area equals that of the outline, so none overlap.
        assert!((mesh.area() - area).abs() < tolerance * area, "{}: area {} for {area}", example.name(), mesh.area());
    }
}

#[test]
fn the_examples_look_outwards() {
    for (example, inside) in [
        (Example::Cube, DVec3::splat(0.5)),
        (Example::Dome, DVec3::ZERO),
        (Example::BumpyCap, DVec3::ZERO),
        (Example::Face, DVec3::new(0.0, -0.02, -0.12)),
    ] {
        let mesh = mesh_of(example);
        for f in (0..mesh.face_count()).map(freebound_core::mesh::FaceId::from_index) {
            let [a, b, c] = mesh.corners(f);
            let outwards = (a + b + c) / 3.0 - inside;
            assert!(mesh.double_area_vector(f).dot(outwards) > 0.0, "{}: {f}", example.name());
        }
    }
}

#[test]
fn the_bumpy_cap_passes_its_equator() {
    let mesh = mesh_of(Example::BumpyCap);
    let lowest = mesh.positions.iter().map(|p| p.z / p.length()).fold(f64::INFINITY, f64::min);
    assert!(lowest < 120_f64.to_radians().cos(), "cosine of the polar angle {lowest}");
    // Wider at the equator than at its rim, hence no height field.
    let mut rim = 0.0_f64;
    let sides = sides(mesh);
    for &(a, _) in sides.keys().filter(|&&(a, b)| !sides.contains_key(&(b, a))) {
        rim = rim.max(mesh.positions[a as usize].truncate().length());
    }
    let widest = mesh.positions.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    assert!(widest > 1.1 * rim, "{widest} at the widest, {rim} at the rim");
}

#[test]
fn the_cube_has_its_corners_and_an_open_bottom() {
    let mesh = mesh_of(Example::Cube);
    for corner in 0..8_u8 {
        let bit = |k: u8| f64::from(corner >> k & 1);
        let wanted = DVec3::new(bit(0), bit(1), bit(2));
        assert!(mesh.positions.contains(&wanted), "{wanted}");
    }
    assert!((mesh.area() - 5.0).abs() < 1e-12);
    let sides = sides(mesh);
    let boundary = sides.keys().filter(|&&(a, b)| !sides.contains_key(&(b, a)));
    assert!(boundary.clone().count() > 20);
    assert!(boundary.into_iter().all(|&(a, _)| mesh.positions[a as usize].y == 0.0));
}

#[test]
fn the_face_is_a_mask_two_high_and_curved_far_back() {
    let mesh = mesh_of(Example::Face);
    let low = mesh.positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = mesh.positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = high - low;
    assert!((1.8..2.3).contains(&size.y), "{size}");
    assert!(size.z > 0.8, "{size}");
    // The nose protrudes most, on the middle line.
    let tip = mesh.positions.iter().max_by(|a, b| a.z.total_cmp(&b.z)).expect("a vertex");
    assert!(tip.x.abs() < 0.05 && tip.z - 0.2 > 0.5, "{tip}");
}

/// Sum of squared distances after the best similarity (or its mirror image), relative to the targets' own sum.
fn misfit(from: &[DVec2], to: &[DVec2]) -> f64 {
    let mean = |p: &[DVec2]| p.iter().sum::<DVec2>() / p.len() as f64;
    let (a, b) = (mean(from), mean(to));
    // Least squares over complex factors z: to − b ≈ z (from − a), so z = Σ conj(f) t / Σ |f|².
    let (mut factor, mut length, mut spread) = (DVec2::ZERO, 0.0, 0.0);
    for (f, t) in from.iter().zip(to).map(|(f, t)| (*f - a, *t - b)) {
        factor += DVec2::new(f.dot(t), f.perp_dot(t));
        length += f.length_squared();
        spread += t.length_squared();
    }
    1.0 - factor.length_squared() / (length * spread)
}

#[test]
fn landmarks_are_distinct_inside_and_on_their_own_side() {
    let mesh = mesh_of(Example::Face);
    let landmarks = &*LANDMARKS;
    assert!((8..=12).contains(&landmarks.len()));
    for (i, a) in landmarks.iter().enumerate() {
        assert!(a.target.iter().all(|x| (0.05..0.95).contains(x)), "{a:?}");
        for b in &landmarks[..i] {
            assert!(
                a.vertex != b.vertex && a.name != b.name && DVec2::from(a.target).distance(b.target.into()) > 0.01,
                "{a:?} {b:?}"
            );
        }
        // The face looks along +z with y up. Its left is +x, on the right in a picture of its front.
        let x = mesh.positions[a.vertex.index()].x;
        let right_of_middle = a.target[0] - 0.5;
        if a.name.starts_with("left") {
            assert!(x > 0.1 && right_of_middle > 0.02, "{a:?} at x = {x}");
        } else if a.name.starts_with("right") {
            assert!(x < -0.1 && right_of_middle < -0.02, "{a:?} at x = {x}");
        } else {
            // Its own place in the portrait: half an edge beside the middle at most.
            assert!(x.abs() < 0.03 && right_of_middle.abs() < 0.01, "{a:?} at x = {x}");
        }
    }
    let height = |name: &str| {
        let landmark = landmarks.iter().find(|l| l.name == name).expect("a landmark of that name");
        (mesh.positions[landmark.vertex.index()].y, landmark.target[1])
    };
    let order = ["left eye, outer corner", "tip of the nose", "left corner of the mouth", "lower lip"].map(height);
    assert!(order.is_sorted_by(|a, b| a.0 > b.0 && a.1 > b.1), "{order:?}");
}

#[test]
fn no_similarity_fits_the_landmarks() {
    let mesh = mesh_of(Example::Face);
    let (from, to): (Vec<DVec2>, Vec<DVec2>) =
        LANDMARKS.iter().map(|l| (mesh.positions[l.vertex.index()].truncate(), DVec2::from(l.target))).unzip();
    assert!(misfit(&from, &from) < 1e-12, "the measure itself");
    // Root mean square misfit above 2 % of the targets' spread.
    assert!(misfit(&from, &to) > 4e-4, "{}", misfit(&from, &to));
}

#[test]
fn the_portrait_shows_skin_eyes_and_background_where_they_belong() {
    let picture = Example::Face.picture().expect("the face has one");
    assert_eq!([picture.width, picture.height], [PORTRAIT_SIZE; 2]);
    assert_eq!(u32::try_from(picture.pixels.len()).unwrap(), 4 * PORTRAIT_SIZE * PORTRAIT_SIZE);
    let row = |v: f64| {
        (0..PORTRAIT_SIZE).find(|&y| f64::from(y + 1) >= (1.0 - v) * f64::from(PORTRAIT_SIZE)).expect("inside")
    };
    let at = |u: f64, v: f64| {
        let x = row(1.0 - u);
        picture.pixel(x, row(v)).expect("inside").map(f64::from)
    };
    let target = |name: &str| LANDMARKS.iter().find(|l| l.name == name).expect("a landmark").target;
    let [outer, inner] = ["left eye, outer corner", "left eye, inner corner"].map(target);
    let iris = at(f64::midpoint(outer[0], inner[0]) - 0.012, f64::midpoint(outer[1], inner[1]));
    assert!(iris[2] > iris[0], "the iris is blue-green: {iris:?}");
    let nose = target("tip of the nose");
    let skin = at(nose[0], nose[1] + 0.03);
    assert!(skin[0] > 150.0 && skin[0] > skin[1] && skin[1] > skin[2], "skin: {skin:?}");
    let corner = target("left corner of the mouth");
    let lip = at(0.5, corner[1] - 0.018);
    assert!(lip[0] / lip[1] > 1.2 * skin[0] / skin[1], "the lips are redder than the skin: {lip:?} {skin:?}");
    let corner = at(0.02, 0.98);
    assert!(corner[0] < 160.0 && corner[2] >= corner[0], "background: {corner:?}");
}
