//! Where the ladder ends: `cargo bench --bench ladder`.
//!
//! `auto` on the twenty disks of `../shared/corpus`, each from twenty random pairs of boundary pins and with three
//! families: 1200 runs. One line a mesh: how many ended planar on which rung, how many steps that took, and the time.
//!
//! `cargo bench --bench ladder -- PAIRS [NAME] [trace]` takes so many pairs, on meshes whose name contains NAME, and
//! prints every step.

mod common;
#[path = "../examples/makers/mod.rs"]
mod makers;

use std::fs;
use std::path::PathBuf;

use freebound::io::{StepReport, read_mesh};
use freebound::mesh::DiskMesh;
use freebound::solver::{Control, Family, Ladder, Method, Pins, Settings, Step, fixed_pins};
use glam::DVec2;

use common::machine::print_machine;
use common::table::Table;
use common::{arguments, time};
use makers::{Random, corpus};

const PAIRS: usize = 20;

const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

/// Where a run can end.
#[derive(Clone, Copy)]
enum End {
    Natural,
    Iterate,
    StartedAgain,
    FreeVirtualBoundary,
    Convex,
    NotPlanar,
}

/// The names of the ends, in their order.
const ENDS: [&str; 6] = ["natural", "iterate", "started again", "virtual boundary, free", "convex", "not planar"];

/// What is added up over the runs on one mesh, and over all.
#[derive(Clone, Copy, Default)]
struct Count {
    runs: usize,
    ends: [usize; ENDS.len()],
    steps: usize,
    most_steps: usize,
    seconds: f64,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.runs += other.runs;
        self.ends.iter_mut().zip(other.ends).for_each(|(sum, count)| *sum += count);
        self.steps += other.steps;
        self.most_steps = self.most_steps.max(other.most_steps);
        self.seconds += other.seconds;
    }

    fn row(&self, name: String) -> [String; 11] {
        let [natural, iterate, again, free, convex, not_planar] = self.ends.map(|count| count.to_string());
        let per_run = |sum: f64| format!("{:.2}", sum / self.runs as f64);
        let (steps, seconds) = (per_run(self.steps as f64), per_run(self.seconds));
        let most = self.most_steps.to_string();
        [name, self.runs.to_string(), natural, iterate, again, free, convex, not_planar, steps, most, seconds]
    }
}

fn main() {
    print_machine();
    let arguments = arguments();
    let pairs = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(PAIRS);
    let trace = arguments.iter().any(|argument| argument == "trace");
    let name = arguments.get(1).filter(|name| *name != "trace").cloned().unwrap_or_default();
    let heads: Vec<&str> = ["mesh", "runs"].into_iter().chain(ENDS).chain(["steps a run", "most", "s a run"]).collect();
    let mut table = Table::new("auto: runs by the rung that they ended planar on", &heads);
    let mut all = Count::default();
    for path in meshes(&name) {
        let mesh = DiskMesh::try_from(read_mesh(&path).expect("readable").polygons.triangulate()).expect("a disk");
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let count = on_mesh(&mesh, pairs, trace);
        println!("{}", count.row(name.clone()).join("  "));
        table.row(count.row(name));
        all.add(count);
    }
    table.row(all.row("all".to_owned()));
    table.print();
}

/// The disks of the corpus whose name contains `name`, small ones first.
fn meshes(name: &str) -> Vec<PathBuf> {
    let Some(entries) = corpus().and_then(|folder| fs::read_dir(folder).ok()) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "obj"));
    paths.retain(|path| path.file_name().is_some_and(|file| file.to_string_lossy().contains(name)));
    paths.sort_by_key(|path| (fs::metadata(path).map_or(0, |data| data.len()), path.clone()));
    paths
}

fn on_mesh(mesh: &DiskMesh, pairs: usize, trace: bool) -> Count {
    let mut count = Count::default();
    let mut random = Random(0x1add_e200);
    for _ in 0..pairs {
        let pins = random_pins(mesh, &mut random);
        for family in FAMILIES {
            let (seconds, (end, steps)) = time(|| run_one(mesh, family, &pins, trace));
            let mut ends = [0; ENDS.len()];
            ends[end as usize] = 1;
            count.add(Count { runs: 1, ends, steps, most_steps: steps, seconds });
        }
    }
    count
}

/// Two different vertices of the boundary, at their distance in space.
fn random_pins(mesh: &DiskMesh, random: &mut Random) -> Pins {
    let boundary = mesh.boundary_loop();
    let mut below = |limit: usize| usize::try_from(random.bits() >> 32).unwrap_or_default() % limit;
    let first = below(boundary.len());
    let second = (first + 1 + below(boundary.len() - 1)) % boundary.len();
    let [first, second] = [boundary[first], boundary[second]];
    let distance = mesh.position(first).distance(mesh.position(second));
    fixed_pins([(first, DVec2::ZERO), (second, DVec2::new(distance, 0.0))])
}

/// Where a run ended, and after how many steps.
fn run_one(mesh: &DiskMesh, family: Family, pins: &Pins, trace: bool) -> (End, usize) {
    let mut run = Ladder::new(Settings::new(Method::Auto, family), pins.clone());
    let mut steps: Vec<(StepReport, bool)> = Vec::new();
    let outcome = run.finish(mesh, Control::unattended(), |step: Step| {
        let report = StepReport::of(&step);
        if trace {
            println!("  {report:?}");
        }
        steps.push((report, step.rung == Method::Natural));
    });
    let started_again = steps.iter().any(|(step, is_linear)| *is_linear && (step.index > 0 || step.note.is_some()));
    let end = match steps.last() {
        Some((last, _)) if last.planar => match last.rung {
            Method::Natural | Method::Iterate if started_again => End::StartedAgain,
            Method::Natural => End::Natural,
            Method::Iterate => End::Iterate,
            _ if last.bent_vertices == 0 => End::FreeVirtualBoundary,
            _ => End::Convex,
        },
        last => {
            println!("not planar: {family}, pins {pins:?}: {outcome:?} after {last:?}");
            End::NotPlanar
        }
    };
    (end, steps.len())
}
