//! New vertices: every set of distinct targets is met, and the surface stays what it was.

use freebound::examples::Example;
use freebound::mesh::{DiskMesh, VertexId};
use freebound::solver::{Control, Family, Method, Pin, Pins, Run, Settings, SolveError, Step, verdict};
use glam::DVec2;

use crate::common::{Random, fan, grid};
use crate::shapes::{finger, irregular_cube};

/// Area may change by rounding alone.
const SAME_AREA: f64 = 1e-12;

fn matched(mesh: &DiskMesh, pins: &Pins) -> Result<Step, SolveError> {
    let settings = Settings::new(Method::Matchmaker, Family::default());
    Run::new(settings, pins.clone()).step(mesh, Control::unattended())
}

/// Meets pins with new vertices, and checks everything that must hold.
fn check(mesh: &DiskMesh, pins: &Pins, name: &str) -> Step {
    let step = matched(mesh, pins).unwrap_or_else(|error| panic!("{name}: {error}"));
    let refinement = step.refinement.as_ref().expect("new vertices");
    let (fine, embedding) = (refinement.disk(), &step.solution.embedding);
    assert!(verdict(fine, embedding).planar, "{name}");
    assert!(!step.verdict.mirrored, "{name}");
    for (v, pin) in pins {
        assert_eq!(embedding[v.index()].to_array().map(f64::to_bits), pin.target.to_array().map(f64::to_bits), "{name}");
    }
    let old = mesh.vertex_count();
    assert_eq!(refinement.old_vertex_count(), old);
    assert_eq!(fine.mesh().positions[..old], mesh.mesh().positions[..]);
    for (new, position) in refinement.new_vertices().iter().zip(&fine.mesh().positions[old..]) {
        assert!(new.edge[0] < new.edge[1] && new.at > 0.0 && new.at < 1.0, "{name}");
        assert!(mesh.edges().any(|e| { let [a, b] = mesh.ends(e); [a.min(b), a.max(b)] == new.edge }), "{name}");
        let [a, b] = new.edge.map(|v| mesh.position(v));
        assert_eq!(a.lerp(b, new.at), *position);
    }
    let (before, after) = (mesh.mesh().area(), fine.mesh().area());
    assert!((before - after).abs() <= SAME_AREA * before, "{name}: {before} {after}");
    step
}

/// So many different vertices.
fn vertices(mesh: &DiskMesh, count: usize, random: &mut Random) -> Vec<VertexId> {
    let mut all: Vec<VertexId> = mesh.vertices().collect();
    for i in 0..count {
        let rest = u32::try_from(all.len() - i).unwrap();
        all.swap(i, i + random.below(rest) as usize);
    }
    all.truncate(count);
    all
}

/// Pins at random places of the unit square.
fn random_pins(mesh: &DiskMesh, count: usize, random: &mut Random) -> Pins {
    let pinned = vertices(mesh, count, random);
    pinned.into_iter().map(|v| (v, Pin::hard(DVec2::new(random.unit(), random.unit())))).collect()
}

/// Vertices pinned to where others of them lie without pins.
fn permuted_pins(mesh: &DiskMesh, count: usize, random: &mut Random) -> Pins {
    let flat = Run::new(Settings::default(), Pins::new());
    let mut flat = flat;
    let mut last = None;
    flat.finish(mesh, Control::unattended(), |step| last = Some(step)).unwrap();
    let flat = last.unwrap().solution.embedding;
    let (pinned, mut others) = (vertices(mesh, count, random), Vec::new());
    others.extend(pinned.iter().map(|v| flat[v.index()]));
    for i in 0..count {
        others.swap(i, i + random.below(u32::try_from(count - i).unwrap()) as usize);
    }
    pinned.into_iter().zip(others).map(|(v, target)| (v, Pin::hard(target))).collect()
}

#[test]
fn pins_on_small_grids_are_met_wherever_they_are_to_go() {
    let mut random = Random(1);
    for round in 0..40 {
        let mesh = DiskMesh::try_from(grid(1 + random.below(5), 1 + random.below(5))).unwrap();
        let most = u32::try_from(mesh.vertex_count().min(24)).unwrap();
        let count = (3 + random.below(most - 2)) as usize;
        let pins = random_pins(&mesh, count, &mut random);
        let step = check(&mesh, &pins, &format!("round {round}, {count} pins"));
        println!("round {round}: {count} pins, {} new", step.refinement.unwrap().new_vertices().len());
    }
}

#[test]
fn pins_that_change_places_at_random_are_met_on_irregular_disks() {
    let mut random = Random(2);
    for round in 0..12 {
        let mesh = if round % 2 == 0 { irregular_cube(4, &mut random) } else { finger(5, 7, &mut random) };
        let count = [3, 6, 12, 24][round / 2 % 4];
        let pins = permuted_pins(&mesh, count, &mut random);
        let step = check(&mesh, &pins, &format!("round {round}, {count} pins"));
        println!("round {round}: {count} pins, {} new", step.refinement.unwrap().new_vertices().len());
    }
}

#[test]
fn a_face_with_three_pinned_corners_can_be_turned_over() {
    let mesh = DiskMesh::try_from(grid(2, 2)).unwrap();
    let face = mesh.face(mesh.faces().next().unwrap());
    let corners = face.map(|v| mesh.position(v).truncate());
    let pins = [(face[0], corners[1]), (face[1], corners[0]), (face[2], corners[2])];
    check(&mesh, &pins.map(|(v, target)| (v, Pin::hard(target))).into_iter().collect(), "face");
    let fan = DiskMesh::try_from(fan(3)).unwrap();
    let all = fan.vertices().map(|v| (v, Pin::hard(fan.position(v).truncate() * DVec2::new(-1.0, 1.0))));
    check(&fan, &all.collect(), "fan");
}

#[test]
fn without_pins_nothing_is_split() {
    let mesh = DiskMesh::try_from(Example::Dome.mesh()).unwrap();
    let step = check(&mesh, &Pins::new(), "dome");
    assert!(step.refinement.unwrap().new_vertices().is_empty());
}
