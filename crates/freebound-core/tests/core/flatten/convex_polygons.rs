//! Polygons stay valid for every triangulation that other programs choose.

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::{DiskMesh, PolygonMesh, TriMesh, VertexId};
use freebound_core::problem::{Control, Embedding, Method, Pins, Settings, fixed_pins, hard_pins};
use freebound_core::verify::verdict;
use glam::{DVec2, DVec3};
use robust::orient2d;

use freebound_testkit::{Random, assert_message, coord, honeycomb, quad_sheet};

/// Triangles by corner indices in a polygon.
type Cut = Vec<[usize; 3]>;

/// Fan from one corner, as in MeshLab, trimesh and assimp; from the next corner it is a quad's other diagonal.
fn fan(count: usize, apex: usize) -> Cut {
    (1..count - 1).map(|k| [apex, (apex + k) % count, (apex + k + 1) % count]).collect()
}

/// Ear clipping, widest angle first, of the polygon seen along its normal: a simplified form of Blender's
/// triangulation.
fn ears(points: &[DVec3]) -> Cut {
    let normal = normal_of(points);
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut cut = Cut::new();
    while left.len() > 3 {
        let count = left.len();
        let corners = |at: usize| [left[(at + count - 1) % count], left[at], left[(at + 1) % count]];
        let turn = |at: usize| {
            let [a, b, c] = corners(at).map(|k| points[k]);
            (b - a).normalize_or_zero().cross((c - b).normalize_or_zero()).dot(normal)
        };
        let best = (0..count).filter(|&at| turn(at) > 0.0).min_by(|&a, &b| turn(a).total_cmp(&turn(b)));
        let best = best.expect("a polygon that is convex in space has ears");
        cut.push(corners(best));
        left.remove(best);
    }
    cut.push([left[0], left[1], left[2]]);
    cut
}

fn normal_of(points: &[DVec3]) -> DVec3 {
    let turns = (1..points.len() - 1).map(|k| (points[k] - points[0]).cross(points[k + 1] - points[0]));
    turns.sum::<DVec3>().normalize_or_zero()
}

/// True if every corner turns left in space by a clear angle.
fn is_convex_in_space(points: &[DVec3]) -> bool {
    let (normal, count) = (normal_of(points), points.len());
    let side = |k: usize| (points[(k + 1) % count] - points[k % count]).normalize_or_zero();
    (0..count).all(|k| side(k).cross(side(k + 1)).dot(normal) > 1e-4)
}

/// Number of folded triangles of whole polygons over all triangulations, and number of polygons checked.
fn folds(whole: &[&[VertexId]], positions: &[DVec3], embedding: &Embedding) -> (usize, usize) {
    let (mut folded, mut looked_at) = (0, 0);
    for polygon in whole {
        let points: Vec<DVec3> = polygon.iter().map(|v| positions[v.index()]).collect();
        if !is_convex_in_space(&points) {
            continue;
        }
        looked_at += 1;
        let fans = (0..points.len()).map(|apex| fan(points.len(), apex));
        for [a, b, c] in fans.chain([ears(&points)]).flatten().map(|t| t.map(|k| embedding[polygon[k]])) {
            folded += usize::from(orient2d(coord(a), coord(b), coord(c)) <= 0.0);
        }
    }
    (folded, looked_at)
}

fn in_f32(embedding: &Embedding) -> Embedding {
    embedding.iter().map(|z| z.as_vec2().as_dvec2()).collect()
}

/// Last step of a flattener.
fn last_step(disk: &DiskMesh, settings: Settings, pins: Pins) -> Step {
    let mut last = None;
    let mut ladder = Flattener::new(settings, pins);
    ladder.finish(disk, Control::unattended(), |step| last = Some(step)).expect("solvable");
    last.expect("a step")
}

/// Polygons that are written whole.
fn whole_polygons<'a>(mesh: &'a PolygonMesh, disk: &DiskMesh, step: &Step) -> Vec<&'a [VertexId]> {
    let cut = step.candidate.refinement.as_ref().map(|refinement| refinement.cut_polygons(disk)).unwrap_or_default();
    let is_whole = |number: &usize| !cut.iter().any(|polygon| polygon.index() == *number);
    (0..mesh.face_count()).filter(is_whole).map(|number| mesh.face(number)).collect()
}

fn random_pins(disk: &DiskMesh, count: usize, random: &mut Random) -> Pins {
    let size = disk.mesh().area().sqrt();
    let pin = |_| {
        let vertex = VertexId::from_index(random.index(disk.vertex_count()));
        let [x, y, _] = (disk.position(vertex) / size).to_array();
        (vertex, DVec2::new(x + random.between(-0.2, 0.2), y + random.between(-0.2, 0.2)))
    };
    hard_pins((0..count).map(pin))
}

/// Sheets of quads and of hexagons, from gentle to rough.
fn sheets(count: u32) -> impl Iterator<Item = (String, PolygonMesh, Random)> {
    (0..count).map(|seed| {
        let mut random = Random(u64::from(seed));
        let roughness = [0.02, 0.1, 0.2, 0.3][seed as usize % 4];
        let (columns, rows) = (3 + random.below(7), 3 + random.below(7));
        let (kind, mesh) = match seed % 3 {
            0 => ("honeycomb", honeycomb(columns, rows, roughness / 3.0, &mut random)),
            _ => ("quads", quad_sheet(columns, rows, roughness, &mut random)),
        };
        (format!("{kind} {columns} x {rows}, roughness {roughness}, seed {seed}"), mesh, random)
    })
}

fn assert_no_folds(count: u32) {
    let (mut planar, mut looked_at, mut whole_share) = (0, 0, 0.0);
    for (name, mesh, mut random) in sheets(count) {
        let disk = DiskMesh::try_from(mesh.triangulate()).expect("a disk");
        let pins = if random.below(2) == 0 { random_pins(&disk, 8, &mut random) } else { Pins::new() };
        let step = last_step(&disk, Settings::default(), pins);
        if !step.verdict.planar {
            continue;
        }
        planar += 1;
        let whole = whole_polygons(&mesh, &disk, &step);
        whole_share += whole.len() as f64 / mesh.face_count() as f64;
        let embedding = &step.candidate.solution.embedding;
        let (folded, polygons) = folds(&whole, &mesh.positions, embedding);
        assert_eq!(folded, 0, "{name}");
        looked_at += polygons;
        if step.verdict.planar_in_f32 {
            assert_eq!(folds(&whole, &mesh.positions, &in_f32(embedding)).0, 0, "{name} in 32 bits");
        }
    }
    assert_eq!(planar, count, "planar ones");
    assert!(looked_at > 10 * count as usize, "{looked_at} polygons were looked at");
    assert!(whole_share > 0.9 * f64::from(planar), "{whole_share} of {planar} are whole");
}

#[test]
fn planar_polygons_fold_in_no_other_program() {
    assert_no_folds(36);
}

#[test]
#[ignore = "a longer run of the test above"]
fn planar_polygons_fold_in_no_other_program_over_300_meshes() {
    assert_no_folds(300);
}

/// Wavy sheet of `side`² quads in the unit square.
fn waves(side: u32) -> PolygonMesh {
    let mut mesh = quad_sheet(side, side, 0.0, &mut Random(0));
    for position in &mut mesh.positions {
        let [x, y] = [position.x, position.y].map(|x| x / f64::from(side));
        *position = DVec3::new(x, y, 0.25 * (6.0 * x).sin() * (5.0 * y).cos());
    }
    mesh
}

#[test]
fn polygons_near_a_pin_far_from_its_place_unfold_and_are_not_cut() {
    for (side, target) in [(20, DVec2::new(0.6, 0.4)), (40, DVec2::new(0.7, 0.5))] {
        let mesh = waves(side);
        let disk = DiskMesh::try_from(mesh.triangulate()).expect("a disk");
        let place = |row: u32, column: u32| VertexId::new(row * (side + 1) + column);
        let pins = hard_pins([
            (place(0, 0), DVec2::ZERO),
            (place(0, side), DVec2::new(1.0, 0.2)),
            (place(side / 2, side / 3), target),
            (place(side, side), DVec2::ONE),
        ]);
        let step = last_step(&disk, Settings::default(), pins);
        assert!(step.verdict.planar, "{side}: {}", step.verdict.summary());
        assert!(step.candidate.refinement.is_none(), "{side}: some polygons are cut");
    }
}

#[test]
fn a_dart_of_positive_triangles_is_named_as_a_concave_polygon() {
    let mesh = quad_sheet(2, 1, 0.0, &mut Random(0));
    let disk = DiskMesh::try_from(mesh.triangulate()).expect("a disk");
    let mut flat: Embedding = mesh.positions.iter().map(|p| p.truncate()).collect();
    assert!(verdict(&disk, &flat).planar);
    let polygon = disk.polygons().next().expect("two quads");
    // One end of the cut's diagonal crosses the other diagonal; both triangles stay positive.
    let is_end = |v: &VertexId| polygon.faces().all(|face| disk.face(face).contains(v));
    let at = polygon.corners.iter().position(is_end).expect("the cut has a diagonal");
    let [tip, side, far, other] = [0, 1, 2, 3].map(|k| polygon.corners[(at + k) % 4]);
    let middle = flat[side].midpoint(flat[other]);
    flat[tip] = middle.lerp(flat[far], 0.1);
    let found = verdict(&disk, &flat);
    assert_eq!(found.concave_polygons, [polygon.first_face]);
    assert!(found.is_one_to_one() && !found.planar && !found.planar_in_f32, "{}", found.summary());
    assert_message("convex-polygons-concave", &found.summary());
}

/// Triangulates every polygon as a fan from a random corner.
fn cut_in_fans(mesh: &PolygonMesh, random: &mut Random) -> TriMesh {
    let mut triangles = mesh.triangulate();
    let mut next = 0;
    for polygon in (0..mesh.face_count()).map(|number| mesh.face(number)) {
        for cut in fan(polygon.len(), random.index(polygon.len())) {
            triangles.triangles[next] = cut.map(|k| polygon[k]);
            next += 1;
        }
    }
    triangles
}

#[test]
fn the_cut_of_polygons_does_not_show_in_a_linear_solve() {
    for seed in 0..6 {
        let mut random = Random(seed);
        let mesh = if seed % 2 == 0 { quad_sheet(6, 5, 0.1, &mut random) } else { honeycomb(4, 4, 0.03, &mut random) };
        let pins = fixed_pins([(VertexId::new(0), DVec2::ZERO), (VertexId::new(9), DVec2::X)]);
        for method in [Method::Natural, Method::Lscm] {
            let solve = |triangles: TriMesh| {
                let disk = DiskMesh::try_from(triangles).expect("a disk");
                last_step(&disk, Settings { method: method.clone(), ..Settings::default() }, pins.clone())
                    .candidate
                    .solution
                    .embedding
                    .clone()
            };
            let (first, second) = (solve(mesh.triangulate()), solve(cut_in_fans(&mesh, &mut random)));
            let off = first.iter().zip(&second).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off < 1e-9, "{off} for {method:?}, seed {seed}");
        }
    }
}

#[test]
fn two_quads_around_a_vertex_of_valence_two_are_a_disk_and_end_planar() {
    // A vertex inside a quad with two edges: two quads share three corners.
    let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [1.1, 0.9, 0.1]];
    let faces = [[0, 1, 4, 3], [1, 2, 3, 4]];
    let mesh = PolygonMesh {
        positions: positions.map(DVec3::from).to_vec(),
        corners: faces.as_flattened().iter().map(|&v| VertexId::new(v)).collect(),
        starts: Some(vec![0, 4, 8]),
    };
    for shift in 0..4 {
        let mut mesh = mesh.clone();
        mesh.corners[..4].rotate_left(shift);
        let disk = DiskMesh::try_from(mesh.triangulate()).unwrap_or_else(|faults| panic!("{faults}"));
        let step = last_step(&disk, Settings::default(), Pins::new());
        assert!(step.verdict.planar, "{}", step.verdict.summary());
        let whole = whole_polygons(&mesh, &disk, &step);
        assert_eq!(folds(&whole, &mesh.positions, &step.candidate.solution.embedding).0, 0);
        assert!(!whole.is_empty(), "one of the two at most is cut");
    }
}
