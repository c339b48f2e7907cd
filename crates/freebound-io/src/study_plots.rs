//! Plots of a study: how often and how fast the iteration reached a planar map, by its possible causes.

use super::figure::{Bar, Marks, Page, Plot, Shares, plots};
use freebound_core::pipeline::study::{Group, Record, Studied, TrialOutcome, summary};
use freebound_core::problem::{NamedOption as _, Treatment};

/// Criteria of the summary's groups, each with the title of its bars.
const BARS: [(&str, &str); 9] = [
    ("first map, equations of pins kept", "First map not planar; all equations kept"),
    ("first map, equations of pins dropped", "First map not planar; equations of pins dropped"),
    ("treatment of a pair", "Two pins: treatment of their equations"),
    ("treatment of constraints", "Constraints: treatment of their equations"),
    ("distance of a pair", "Two pins: distance in space, relative to the mesh's diagonal"),
    ("displacement of constraints", "Constraints: largest displacement, relative to the map's diagonal"),
    ("angle distortion of the first map", "Mean angle distortion of the first map"),
    ("turning number of the first map", "Turning number of the first map"),
    ("place of a pair", "Two pins: position"),
];

/// Page of plots.
pub fn study_plots(studied: &[Studied]) -> Page {
    let groups = summary(studied);
    let records: Vec<&Record> = studied.iter().flat_map(|of| &of.records).collect();
    let mut panels = vec![curves(&records)];
    panels.extend(BARS.iter().map(|(by, title)| bars(&groups, by, title)));
    let runs = records.len();
    plots(&panels, &format!("{runs} runs on {} meshes; numbers above bars are runs", studied.len()))
}

fn bars(groups: &[Group], by: &str, title: &str) -> Plot {
    let bar = |group: &Group| {
        let rest = group.share_planar() - group.share_at_once();
        Bar {
            name: group
                .name
                .replacen(" to ", "\nto ", 1)
                .replacen("all on the ", "all on the\n", 1)
                .replacen(", ", ",\n", 1)
                .replacen(" flipped", "\nflipped", 1),
            count: group.runs,
            parts: vec![group.share_at_once(), rest],
        }
    };
    let parts = ["planar at once", "made planar by the iteration"].map(str::to_owned).to_vec();
    let marks = Marks::Bars(groups.iter().filter(|group| group.by == by).map(bar).collect(), parts);
    Plot { title: title.to_owned(), along: "per cent of runs that end planar".to_owned(), marks }
}

/// Share of runs that are planar after each number of iterations, among the runs whose first map was not planar.
fn curves(records: &[&Record]) -> Plot {
    let is_to_mend = |record: &&Record| record.first.is_some() && !record.is_planar_at_once();
    let to_mend: Vec<&Record> = records.iter().copied().filter(is_to_mend).collect();
    let last = to_mend.iter().map(|record| record.steps).max().unwrap_or(0);
    let curve = |is_pair: bool, treatment: Treatment| {
        let of: Vec<&Record> = to_mend
            .iter()
            .copied()
            .filter(|record| record.trial.displacement.is_none() == is_pair && record.trial.treatment == treatment)
            .collect();
        let kind = if is_pair { "pair" } else { "constraints" };
        let within = |steps: usize| {
            of.iter().filter(|record| record.outcome == TrialOutcome::Planar && record.steps <= steps).count()
        };
        let share = |steps: usize| within(steps) as f64 / of.len().max(1) as f64;
        Shares { name: format!("{kind}, {}", treatment.name()), shares: (0..=last).map(share).collect() }
    };
    let kinds = [true, false].into_iter();
    let marks = kinds.flat_map(|is_pair| Treatment::ALL.iter().map(move |&of| (is_pair, of)));
    Plot {
        title: "First map not planar: iterations until planar".to_owned(),
        along: "iterations; per cent of runs".to_owned(),
        marks: Marks::Curves(marks.map(|(is_pair, treatment)| curve(is_pair, treatment)).collect()),
    }
}
