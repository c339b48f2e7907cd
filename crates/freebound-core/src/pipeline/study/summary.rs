//! Runs in groups: share and speed of convergence to a planar map, by the properties that it may depend on.

use super::{Defects, Limits, Record, SystemForm, TrialOutcome};
use crate::problem::{NamedOption as _, Treatment};

/// A group of runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Property by which runs are grouped.
    pub by: &'static str,
    /// Value of the property in this group.
    pub name: String,
    /// Number of runs.
    pub runs: usize,
    /// Number of runs whose first map was planar.
    pub at_once: usize,
    /// Number of runs that the iteration made planar, from a first map that was not.
    pub with_all_repairs: usize,
    /// Median number of iterations of the runs that the iteration made planar. Absent if there is none.
    pub median_steps: Option<usize>,
    /// 90th percentile of the iterations of the runs that the iteration made planar. Absent if there is none.
    pub p90_steps: Option<usize>,
}

impl Group {
    fn of(by: &'static str, name: String, records: &[&Record]) -> Self {
        let mut steps: Vec<usize> = records
            .iter()
            .filter(|record| record.outcome == TrialOutcome::Planar && record.steps > 0)
            .map(|record| record.steps)
            .collect();
        steps.sort_unstable();
        Self {
            by,
            name,
            runs: records.len(),
            at_once: records.iter().filter(|record| record.is_planar_at_once()).count(),
            with_all_repairs: steps.len(),
            median_steps: nearest_rank(&steps, 50),
            p90_steps: nearest_rank(&steps, 90),
        }
    }

    /// Share of the runs that ended planar, from 0 to 1.
    pub fn share_planar(&self) -> f64 {
        share(self.at_once + self.with_all_repairs, self.runs)
    }

    /// Share of the runs whose first map was planar, from 0 to 1.
    pub fn share_at_once(&self) -> f64 {
        share(self.at_once, self.runs)
    }

    /// Share that the iteration made planar among the runs whose first map was not. NaN if there is no such run.
    pub fn share_mended(&self) -> f64 {
        share(self.with_all_repairs, self.runs - self.at_once)
    }
}

fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

/// Least value that `percent` per cent of the ascending values do not exceed. `None` for an empty list.
fn nearest_rank(ascending: &[usize], percent: usize) -> Option<usize> {
    let rank = (ascending.len() * percent).div_ceil(100);
    ascending.get(rank.saturating_sub(1)).copied()
}

/// Runs on one mesh.
#[derive(Clone, Debug)]
pub struct Studied {
    /// Name of the mesh.
    pub mesh: String,
    /// Counts of the mesh.
    pub form: SystemForm,
    /// Limits of the runs.
    pub limits: Limits,
    /// Records of the runs, by number.
    pub records: Vec<Record>,
}

/// A run and its mesh.
#[derive(Clone, Copy)]
struct Run<'a> {
    of: &'a Studied,
    record: &'a Record,
}

/// All groups, in the order of the table.
pub fn summary(studied: &[Studied]) -> Vec<Group> {
    let all: Vec<Run<'_>> =
        studied.iter().flat_map(|of| of.records.iter().map(move |record| Run { of, record })).collect();
    let mut table = Table { all: &all, groups: Vec::new() };
    table.add("all", |_| Some("runs".to_owned()));
    table.add("pins", |run| Some(kind(run).to_owned()));
    for (of, by) in [("pair", "treatment of a pair"), ("constraints", "treatment of constraints")] {
        table.add(by, |run| (kind(run) == of).then(|| run.record.trial.treatment.name().to_owned()));
    }
    for (of, by) in [("pair", "family, for a pair"), ("constraints", "family, for constraints")] {
        table.add(by, |run| (kind(run) == of).then(|| run.record.trial.family.name().to_owned()));
    }
    for (of, by) in [("pair", "place of a pair"), ("constraints", "place of constraints")] {
        table.add(by, |run| (kind(run) == of).then(|| place(run.record).to_owned()));
    }
    table.add_quarters("distance of a pair", |run| (kind(run) == "pair").then_some(run.record.pin_distance));
    table.add_quarters("displacement of constraints", |run| run.record.trial.displacement);
    table.add_quarters("angle distortion of the first map", |run| run.record.first.map(|_| run.record.distortion));
    for (is_kept, by) in [(true, "first map, equations of pins kept"), (false, "first map, equations of pins dropped")]
    {
        let is_of = move |run: Run<'_>| (run.record.trial.treatment != Treatment::Eliminate) == is_kept;
        table.add(by, |run| first_map(run).filter(|_| is_of(run)).map(str::to_owned));
    }
    table.add("turning number of the first map", |run| run.record.first.map(turning));
    table.add("crossings of the first map", |run| run.record.first.map(|first| counted(first.crossings)));
    table.add("flipped faces of the first map", |run| run.record.first.map(|first| counted(first.flips)));
    table.add("dividing edges of the mesh", |run| Some(some_or_none(run.of.form.dividing_edges)));
    table.add("ears of the mesh", |run| Some(some_or_none(run.of.form.ears)));
    table.add_in_order("mesh", |run| Some(run.of.mesh.clone()));
    table.groups
}

/// Groups under construction.
struct Table<'a> {
    all: &'a [Run<'a>],
    groups: Vec<Group>,
}

impl Table<'_> {
    /// Adds a group for each name that runs have, in alphabetical order.
    fn add(&mut self, by: &'static str, name: impl Fn(Run<'_>) -> Option<String>) {
        let mut names: Vec<String> = self.all.iter().filter_map(|&run| name(run)).collect();
        names.sort();
        names.dedup();
        self.add_named(by, names, name);
    }

    /// Adds a group for each name that runs have, in order of first appearance.
    fn add_in_order(&mut self, by: &'static str, name: impl Fn(Run<'_>) -> Option<String>) {
        let mut names: Vec<String> = Vec::new();
        for name in self.all.iter().filter_map(|&run| name(run)) {
            if names.last() != Some(&name) && !names.contains(&name) {
                names.push(name);
            }
        }
        self.add_named(by, names, name);
    }

    fn add_named(&mut self, by: &'static str, names: Vec<String>, name: impl Fn(Run<'_>) -> Option<String>) {
        for of in names {
            let is_of = |run: &&Run<'_>| name(**run).as_ref() == Some(&of);
            let records: Vec<&Record> = self.all.iter().filter(is_of).map(|run| run.record).collect();
            self.groups.push(Group::of(by, of, &records));
        }
    }

    /// Adds a group for each quarter of the runs that have a value, in ascending order of values.
    fn add_quarters(&mut self, by: &'static str, value: impl Fn(Run<'_>) -> Option<f64>) {
        let mut of: Vec<(f64, &Record)> = self.all.iter().filter_map(|&run| Some((value(run)?, run.record))).collect();
        // Stable sort: runs with equal values keep their order.
        of.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for quarter in 0..4 {
            let part = &of[of.len() * quarter / 4..of.len() * (quarter + 1) / 4];
            let (Some((least, _)), Some((greatest, _))) = (part.first(), part.last()) else { continue };
            let records: Vec<&Record> = part.iter().map(|&(_, record)| record).collect();
            self.groups.push(Group::of(by, format!("{} to {}", rounded(*least), rounded(*greatest)), &records));
        }
    }
}

/// Number with about three digits.
fn rounded(value: f64) -> String {
    match value.abs() {
        size if size >= 1e4 => format!("{value:.0e}"),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.3}"),
    }
}

fn kind(run: Run<'_>) -> &'static str {
    if run.record.trial.displacement.is_some() { "constraints" } else { "pair" }
}

fn place(record: &Record) -> &'static str {
    match record.pins_inside {
        0 => "all on the boundary",
        count if count == record.trial.pins.len() => "all inside",
        _ => "some inside",
    }
}

/// Kind of a first map that is not planar.
fn first_map(run: Run<'_>) -> Option<&'static str> {
    let first = run.record.first.filter(|_| !run.record.is_planar_at_once())?;
    let share = first.flips as f64 / run.of.form.faces as f64;
    Some(match first.turning_number {
        Some(1) if first.flips == 0 => "turns once, no face flipped",
        Some(1) if share <= 0.01 => "turns once, 1 % flipped or less",
        Some(1) if share <= 0.1 => "turns once, 10 % flipped or less",
        Some(1) => "turns once, more flipped",
        _ => "turns otherwise",
    })
}

fn turning(first: Defects) -> String {
    match first.turning_number {
        Some(1) => "1".to_owned(),
        Some(-1) => "-1".to_owned(),
        Some(_) => "another".to_owned(),
        None => "none".to_owned(),
    }
}

fn counted(count: usize) -> String {
    match count {
        0 => "0",
        1..=9 => "1 to 9",
        10..=99 => "10 to 99",
        _ => "100 and more",
    }
    .to_owned()
}

fn some_or_none(count: usize) -> String {
    if count == 0 { "none" } else { "some" }.to_owned()
}
