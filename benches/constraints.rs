//! Constraint problems in bulk: `cargo bench --bench constraints -- FOLDER COUNT [FIRST] [SECONDS]`.
//!
//! FOLDER holds meshes, such as those that `.ci/meshes` fetches. Each gives its largest part, cut to a disk. A disk gets
//! problems of every kind, with 3 to 128 pins at targets that are derived from its flat map:
//!
//! | kind | targets |
//! |---|---|
//! | displaced | each pin moved by up to 15 % of the map's size |
//! | swirled | pins turned around the middle, up to two radians there |
//! | permuted | pins exchange their places in a cycle |
//! | held | all boundary vertices at their places, the pins within moved by up to 5 % |
//!
//! COUNT problems are solved, each within SECONDS (60 by default), and a table of the kinds is printed. *Met* means: all
//! pins on their targets to the last bit, and planar by the program and by the judge of the tests. Problems that are not
//! met are listed with their numbers; FIRST starts at such a number again.

mod common;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use freebound_core::flatten::{Flattener, Step};
use freebound_core::geom::Bounds;
use freebound_core::mesh::{DiskMesh, Preparation, Repairs, VertexId};
use freebound_core::pipeline::{PreparedMesh, Surface};
use freebound_core::problem::{Control, Embedding, Family, Method, Pins, Settings, fixed_pins};
use freebound_io::read_mesh;
use glam::DVec2;

use common::arguments;
use common::machine::print_machine;
use common::table::Table;
use freebound_testkit::Random;
use freebound_testkit::judge::judge_obj;

/// Fewest and most faces of a disk.
const FACES: std::ops::RangeInclusive<usize> = 50..=20_000;

/// Fewest and most pins.
const PINS: [u32; 2] = [3, 128];

/// Most pins that exchange their places.
const MOST_PERMUTED: u32 = 16;

/// Problems of each kind on a disk.
const PER_KIND: usize = 2;

/// Kinds of targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Displaced,
    Swirled,
    Permuted,
    Held,
}

const KINDS: [Kind; 4] = [Kind::Displaced, Kind::Swirled, Kind::Permuted, Kind::Held];

/// Results of one kind.
#[derive(Default)]
struct Results {
    seconds: Vec<f64>,
    met: usize,
    with_new_vertices: usize,
    late: usize,
}

fn main() {
    print_machine();
    let words = arguments();
    let number = |place: usize| words.get(place).and_then(|word| word.parse::<usize>().ok());
    let Some(folder) = words.first().filter(|word| Path::new(word).is_dir()) else {
        println!("skipped: name a folder of meshes, such as `.ci/meshes FOLDER` makes");
        return;
    };
    let (count, first) = (number(1).unwrap_or(100), number(2).unwrap_or(0));
    let limit = Duration::from_secs(number(3).unwrap_or(60) as u64);
    let mut results: BTreeMap<Kind, Results> = BTreeMap::new();
    let mut done = 0;
    for (place, file) in meshes(Path::new(folder)).into_iter().enumerate() {
        let begin = place * KINDS.len() * PER_KIND;
        if done >= count || begin + KINDS.len() * PER_KIND <= first {
            continue;
        }
        let Some((mesh, map)) = disk_and_map(&file) else { continue };
        for (at, kind) in (0..PER_KIND).flat_map(|_| KINDS).enumerate() {
            let problem = begin + at;
            if problem < first || done >= count {
                continue;
            }
            done += 1;
            let pins = pins_of(&mesh, &map, kind, problem);
            let solved = solved(&mesh, &pins, limit);
            let own = results.entry(kind).or_default();
            own.seconds.push(solved.seconds);
            own.met += usize::from(solved.fault.is_none());
            own.with_new_vertices += usize::from(solved.has_new_vertices);
            own.late += usize::from(solved.is_late);
            if let Some(fault) = solved.fault {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                println!("problem {problem}, {name}, {kind:?}, {} faces: {fault}", mesh.mesh().face_count());
            }
        }
    }
    print(&results);
}

fn print(results: &BTreeMap<Kind, Results>) {
    let heads = ["targets", "problems", "met", "with new vertices", "out of time", "median s", "95 % s", "longest s"];
    let mut table = Table::new("constraint problems: met, planar and judged", &heads);
    for (kind, own) in results {
        let mut seconds = own.seconds.clone();
        seconds.sort_by(f64::total_cmp);
        let at = |percent: usize| format!("{:.2}", seconds[(seconds.len() - 1) * percent / 100]);
        let counts = [own.seconds.len(), own.met, own.with_new_vertices, own.late].map(|count| count.to_string());
        let times = [at(50), at(95), at(100)];
        table.row([format!("{kind:?}").to_lowercase()].into_iter().chain(counts).chain(times));
    }
    table.print();
}

/// Mesh files of a folder, by name.
fn meshes(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path()).collect();
    files.retain(|file| {
        file.extension().is_some_and(|own| ["obj", "stl", "ply", "off", "glb"].iter().any(|end| own == *end))
    });
    files.sort();
    files
}

/// Largest part of a mesh as a disk, and its flat map. `None` if it is no disk of a fitting size.
fn disk_and_map(file: &Path) -> Option<(DiskMesh, Embedding)> {
    let mesh = read_mesh(file).ok()?;
    let form = Preparation { repair: Repairs::ALL, cut: true, ..Preparation::default() };
    let Surface::Disk(disk) = PreparedMesh::new(&mesh.polygons, None, form).surface else { return None };
    let disk = DiskMesh::clone(&disk);
    if !FACES.contains(&disk.mesh().face_count()) || !disk.virtual_vertices().is_empty() || disk.mollification() > 0.0 {
        return None;
    }
    let step = last_step(&disk, Pins::new(), &AtomicBool::new(false))?;
    step.verdict.planar.then(|| (disk, step.candidate.solution.embedding.clone())).filter(|(disk, map)| {
        // Polygons of a start without new vertices stay whole.
        map.len() == disk.vertex_count()
    })
}

fn last_step(mesh: &DiskMesh, pins: Pins, is_late: &AtomicBool) -> Option<Step> {
    let mut last = None;
    let mut flattener = Flattener::new(Settings::new(Method::Auto, Family::default()), pins);
    let control = Control::new(is_late, &|_| {});
    // A failure after a step leaves the step.
    let _ = flattener.finish(mesh, control, |step| last = Some(step));
    last
}

fn pins_of(mesh: &DiskMesh, map: &Embedding, kind: Kind, seed: usize) -> Pins {
    let mut random = Random::of_run(0xc0_5743, seed as u64);
    let bounds = Bounds::of(map.iter().copied());
    let (middle, size) = (bounds.middle(), bounds.extent());
    let boundary: Vec<VertexId> = mesh.boundary_loop().to_vec();
    let all: Vec<VertexId> = mesh.vertices().filter(|&vertex| mesh.is_used(vertex)).collect();
    let most = u32::try_from(all.len() / 4).unwrap_or(u32::MAX).clamp(PINS[0], PINS[1]);
    let most = if kind == Kind::Permuted { most.min(MOST_PERMUTED) } else { most };
    let wanted = PINS[0] + random.below(most - PINS[0] + 1);
    let mut chosen: Vec<VertexId> = (0..wanted).map(|_| all[random.index(all.len())]).collect();
    chosen.sort_unstable();
    chosen.dedup();
    let jitter =
        |random: &mut Random, most: f64| DVec2::new(random.between(-most, most), random.between(-most, most)) * size;
    let pins: Vec<(VertexId, DVec2)> = match kind {
        Kind::Displaced => chosen.iter().map(|&vertex| (vertex, map[vertex] + jitter(&mut random, 0.15))).collect(),
        Kind::Swirled => {
            let swirled = |vertex: VertexId| {
                let from = map[vertex] - middle;
                let angle = 2.0 * (1.0 - from.length() / size).max(0.0);
                middle + DVec2::from_angle(angle).rotate(from)
            };
            chosen.iter().map(|&vertex| (vertex, swirled(vertex))).collect()
        }
        Kind::Permuted => {
            let next = chosen.iter().cycle().skip(1);
            chosen.iter().zip(next).map(|(&vertex, &other)| (vertex, map[other])).collect()
        }
        Kind::Held => {
            let held = boundary.iter().map(|&vertex| (vertex, map[vertex]));
            let inner: Vec<VertexId> = chosen.iter().copied().filter(|vertex| !boundary.contains(vertex)).collect();
            let moved: Vec<(VertexId, DVec2)> =
                inner.into_iter().map(|vertex| (vertex, map[vertex] + jitter(&mut random, 0.05))).collect();
            held.chain(moved).collect()
        }
    };
    fixed_pins(pins)
}

/// Outcome of a problem.
struct Solved {
    seconds: f64,
    has_new_vertices: bool,
    is_late: bool,
    /// Reason why the problem is not met.
    fault: Option<String>,
}

fn solved(mesh: &DiskMesh, pins: &Pins, limit: Duration) -> Solved {
    let (is_late, is_done) = (AtomicBool::new(false), AtomicBool::new(false));
    let begin = Instant::now();
    let step = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_done.load(Ordering::Relaxed) {
                is_late.fetch_or(begin.elapsed() > limit, Ordering::Relaxed);
                std::thread::sleep(Duration::from_millis(10));
            }
        });
        let step = last_step(mesh, pins.clone(), &is_late);
        is_done.store(true, Ordering::Relaxed);
        step
    });
    let seconds = begin.elapsed().as_secs_f64();
    let is_late = is_late.into_inner();
    let Some(step) = step else {
        return Solved { seconds, has_new_vertices: false, is_late, fault: Some("no step".to_owned()) };
    };
    let of = step.candidate.mesh(mesh);
    let has_new_vertices = of.vertex_count() > mesh.vertex_count();
    Solved { seconds, has_new_vertices, is_late, fault: fault_of(&step, of, pins) }
}

fn fault_of(step: &Step, mesh: &DiskMesh, pins: &Pins) -> Option<String> {
    let map = &step.candidate.solution.embedding;
    let missed = pins.iter().filter(|(vertex, pin)| map[*vertex] != pin.target).count();
    if !step.verdict.planar || missed > 0 {
        return Some(format!("{}; {missed} of {} pins missed", step.verdict.summary(), pins.len()));
    }
    let mut text = String::new();
    for (vertex, place) in mesh.vertices().zip(map) {
        let at = mesh.position(vertex);
        writeln!(text, "v {} {} {}\nvt {} {}", at.x, at.y, at.z, place.x, place.y).expect("text grows");
    }
    for face in mesh.real_faces() {
        let [a, b, c] = mesh.face(face).map(|vertex| vertex.number() + 1);
        writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}").expect("text grows");
    }
    let judgement = judge_obj(&text).expect("an OBJ file");
    (!judgement.is_planar()).then(|| format!("the judge disagrees: {judgement:?}"))
}
