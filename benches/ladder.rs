//! Stages at which the flattener ends: `cargo bench --bench ladder`.
//!
//! `auto` on the twenty disks of `../shared/corpus`, each with twenty random pairs of boundary pins and three
//! families: 1200 runs. Each mesh has one line: the number of planar runs by stage, the steps, and the time.
//!
//! `cargo bench --bench ladder -- PAIRS [NAME] [trace]` uses PAIRS pairs, on meshes whose name contains NAME;
//! `trace` prints every step.

mod common;

use std::fs;
use std::path::PathBuf;

use freebound_core::flatten::{Flattener, Step};
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Control, Family, Method, Pins, Settings, Stage, fixed_pins};
use freebound_io::{StepReport, read_mesh};
use glam::DVec2;

use common::machine::print_machine;
use common::table::Table;
use common::{arguments, time};
use freebound_testkit::{Random, corpus};

const PAIRS: usize = 20;

const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

/// End of a run.
#[derive(Clone, Copy)]
enum End {
    Natural,
    Iterate,
    StartedAgain,
    FreeVirtualBoundary,
    Convex,
    Grid,
    NotPlanar,
}

/// Names of the ends, in the order of [`End`].
const ENDS: [&str; 7] =
    ["natural", "iterate", "started again", "virtual boundary, free", "convex", "grid", "not planar"];

/// Statistics over the runs on one mesh, or over all runs.
#[derive(Clone, Copy, Default)]
struct Count {
    runs: usize,
    ends: [usize; ENDS.len()],
    /// Number of runs that were relaxed after their end.
    relaxed: usize,
    steps: usize,
    most_steps: usize,
    seconds: f64,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.runs += other.runs;
        self.ends.iter_mut().zip(other.ends).for_each(|(sum, count)| *sum += count);
        self.relaxed += other.relaxed;
        self.steps += other.steps;
        self.most_steps = self.most_steps.max(other.most_steps);
        self.seconds += other.seconds;
    }

    fn row(&self, name: String) -> Vec<String> {
        let per_run = |sum: f64| format!("{:.2}", sum / self.runs as f64);
        let counts = [self.runs].into_iter().chain(self.ends).chain([self.relaxed]).map(|count| count.to_string());
        let most = self.most_steps.to_string();
        [name].into_iter().chain(counts).chain([per_run(self.steps as f64), most, per_run(self.seconds)]).collect()
    }
}

fn main() {
    print_machine();
    let arguments = arguments();
    let pairs = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(PAIRS);
    let trace = arguments.iter().any(|argument| argument == "trace");
    let name = arguments.get(1).filter(|name| *name != "trace").cloned().unwrap_or_default();
    let heads: Vec<&str> =
        ["mesh", "runs"].into_iter().chain(ENDS).chain(["relaxed", "steps a run", "most", "s a run"]).collect();
    let mut table = Table::new("auto: runs by the rung that first was planar; how many were relaxed then", &heads);
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

/// Disks of the corpus whose name contains `name`, smallest first.
fn meshes(name: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(corpus()).expect("the corpus is a folder");
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
            let (seconds, run) = time(|| run_one(mesh, family, &pins, trace));
            count.add(Count { seconds, ..run });
        }
    }
    count
}

/// Pins two different vertices of the boundary at their distance in space.
fn random_pins(mesh: &DiskMesh, random: &mut Random) -> Pins {
    let boundary = mesh.boundary_loop();
    let mut below = |limit: usize| usize::try_from(random.bits() >> 32).unwrap_or_default() % limit;
    let first = below(boundary.len());
    let second = (first + 1 + below(boundary.len() - 1)) % boundary.len();
    let [first, second] = [boundary[first], boundary[second]];
    let distance = mesh.position(first).distance(mesh.position(second));
    fixed_pins([(first, DVec2::ZERO), (second, DVec2::new(distance, 0.0))])
}

/// Runs once; returns its end and its number of steps as a [`Count`].
fn run_one(mesh: &DiskMesh, family: Family, pins: &Pins, trace: bool) -> Count {
    let mut run = Flattener::new(Settings::new(Method::Auto, family), pins.clone());
    let mut steps: Vec<StepReport> = Vec::new();
    let outcome = run.finish(mesh, Control::unattended(), |step: Step| {
        let report = StepReport::of(&step);
        if trace {
            println!("  {report:?}");
        }
        steps.push(report);
    });
    let last = steps.last();
    if !last.is_some_and(|last| last.planar) {
        println!("not planar: {family}, pins {pins:?}: {outcome:?} after {last:?}");
    }
    let mut ends = [0; ENDS.len()];
    ends[end_of(&steps) as usize] = 1;
    let relaxed = usize::from(last.is_some_and(|last| last.stage == Stage::Relax));
    Count { runs: 1, ends, relaxed, steps: steps.len(), most_steps: steps.len(), seconds: 0.0 }
}

/// Stage of the first planar step, if the last step is planar.
fn end_of(steps: &[StepReport]) -> End {
    let is_planar = steps.last().is_some_and(|last| last.planar);
    let Some(first) = steps.iter().position(|step| step.planar).filter(|_| is_planar) else { return End::NotPlanar };
    let has_begun_again = |step: &StepReport| step.stage == Stage::Natural && (step.index > 0 || step.note.is_some());
    match steps[first].stage {
        Stage::Natural | Stage::Iterate if steps[..=first].iter().any(has_begun_again) => End::StartedAgain,
        Stage::Natural => End::Natural,
        Stage::Iterate => End::Iterate,
        Stage::Schnyder => End::Grid,
        _ if steps[first].bent_vertices == 0 => End::FreeVirtualBoundary,
        _ => End::Convex,
    }
}
