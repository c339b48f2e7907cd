//! `freebound study`: the mean-value iteration on many random trials, the paper's open question (§7).

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::args::StudyArguments;
use super::error::{CommandError, CommandOutcome};
use super::error::{is_standard, name_of_input};
use super::opened::disk_of;
use super::places::OutputPaths;
use super::progress::go_on;
use super::progress::{INTERRUPTED, ProgressLine};
use super::say::say;
use super::standard::{MemoryLimit, read_model};
use super::threads::set_threads;
use freebound_core::mesh::Preparation;
use freebound_core::pipeline::study::{Group, Limits, Patience, Studied, StudySubject, summary};
use freebound_core::problem::Control;
use freebound_io::{ReadOptions, read_study, study_plots, try_place, write_atomically, write_study};

pub(super) fn run(arguments: &StudyArguments) -> Result<CommandOutcome, CommandError> {
    let places = OutputPaths::of_study(arguments);
    refuse_standard(arguments)?;
    if let Some(option) = arguments.idle_option() {
        return Err(CommandError::Usage(format!(
            "{option} does not apply to the finished runs of --add: name a mesh, too"
        )));
    }
    places.keep_apart()?;
    arguments.meshes.iter().try_for_each(|mesh| places.spare(mesh, "a mesh"))?;
    arguments.add.iter().try_for_each(|table| places.spare(table, "an added table"))?;
    // Check the output paths before all work, so that no results are lost.
    arguments.csv.iter().chain(&arguments.svg).try_for_each(|path| try_place(path))?;
    set_threads(arguments.threads)?;
    let progress = ProgressLine::default();
    progress.follow(|| {
        let mut studied = Vec::new();
        for table in &arguments.add {
            studied.extend(read_study(table)?);
            refuse_other_limits(arguments, &studied, table)?;
        }
        refuse_doubles(&studied, &arguments.meshes)?;
        for (number, path) in arguments.meshes.iter().enumerate() {
            go_on()?;
            progress.enter("reading");
            progress.reach(format!("mesh {} of {}", number + 1, arguments.meshes.len()));
            studied.push(studied_mesh(arguments, &places, path, &progress)?);
        }
        progress.enter("writing");
        if let Some(path) = &arguments.csv {
            go_on()?;
            write_atomically(path, |out| write_study(out, &studied))?;
        }
        if let Some(path) = &arguments.svg {
            go_on()?;
            write_atomically(path, |out| {
                study_plots(&studied).write_svg(out)?;
                out.flush()
            })?;
        }
        say(table(&summary(&studied)))?;
        Ok(CommandOutcome::Fine)
    })
}

/// Rejects a mesh that appears twice, because its runs may be equal.
fn refuse_doubles(added: &[Studied], meshes: &[PathBuf]) -> Result<(), CommandError> {
    let mut names: Vec<String> = added.iter().map(|studied| studied.mesh.clone()).collect();
    names.extend(meshes.iter().map(|path| name_of_input(path)));
    names.sort();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(CommandError::Usage(format!("{}: the mesh is given twice: remove one of them", pair[0]))),
        None => Ok(()),
    }
}

/// Rejects tables whose runs have other limits: totals over them would be meaningless. `table` was read last.
fn refuse_other_limits(arguments: &StudyArguments, studied: &[Studied], table: &Path) -> Result<(), CommandError> {
    let own = (!arguments.meshes.is_empty()).then(|| arguments.limits());
    let Some(first) = own.or(studied.first().map(|studied| studied.limits)) else { return Ok(()) };
    let Some(other) = studied.iter().find(|studied| studied.limits != first) else { return Ok(()) };
    let typed = |limits: Limits| {
        let past_stall = if limits.patience == Patience::ToTheLimit { " --past-stall" } else { "" };
        format!("--max-steps {}{past_stall}", limits.max_steps)
    };
    let text = format!("its runs used {}, others {}", typed(other.limits), typed(first));
    Err(CommandError::Usage(format!("{}: {text}: remove it, or use equal limits for both", table.display())))
}

/// Rejects tables and drawings on standard output, which shows the summary.
fn refuse_standard(arguments: &StudyArguments) -> Result<(), CommandError> {
    let asked = [("--csv", &arguments.csv), ("--svg", &arguments.svg)];
    match asked.into_iter().find(|(_, path)| path.as_deref().is_some_and(is_standard)) {
        Some((option, _)) => {
            Err(CommandError::Usage(format!("{option}: standard output is reserved for the summary: name a file")))
        }
        None => Ok(()),
    }
}

fn studied_mesh(
    arguments: &StudyArguments,
    places: &OutputPaths,
    path: &Path,
    progress: &ProgressLine,
) -> Result<Studied, CommandError> {
    let model =
        read_model(path, MemoryLimit::typed(arguments.large), ReadOptions::default())?.in_form(Preparation::default());
    places.spare_materials(&model.source, path)?;
    let mesh = disk_of(&model)?;
    if model.chart_count() > 1 {
        let text = format!("the mesh has {} charts, but study needs one disk", model.chart_count());
        return Err(CommandError::Usage(format!("{}: {text}: use a file with one chart", model.path_words())));
    }
    let quiet = |_| {};
    let control = Control::new(&INTERRUPTED, &quiet);
    progress.enter("solving");
    let subject = StudySubject::new(mesh, control)?;
    let study = arguments.study(subject.form.faces);
    let done = AtomicU64::new(0);
    let name = name_of_input(path);
    let records = study.records(&subject, control, || {
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress.reach_items(count, study.runs, &format!("runs on {name}"));
    })?;
    Ok(Studied { mesh: name, form: subject.form, limits: study.limits, records })
}

/// Summary in columns, for the terminal.
fn table(groups: &[Group]) -> String {
    let percent = |share: f64| if share.is_nan() { "-".to_owned() } else { format!("{:.1} %", 100.0 * share) };
    let steps = |count: Option<usize>| count.map_or_else(|| "-".to_owned(), |count| count.to_string());
    let head = ["runs", "planar at once", "repaired of the rest", "planar", "median", "p90"].map(str::to_owned);
    let mut rows = vec![(String::new(), head)];
    let mut by = "all";
    for group in groups {
        if group.by != by {
            by = group.by;
            rows.push((by.to_owned(), std::array::from_fn(|_| String::new())));
        }
        let indent = if by == "all" { "" } else { "  " };
        let cells = [
            group.runs.to_string(),
            percent(group.share_at_once()),
            percent(group.share_mended()),
            percent(group.share_planar()),
            steps(group.median_steps),
            steps(group.p90_steps),
        ];
        rows.push((format!("{indent}{}", group.name), cells));
    }
    in_columns(&rows)
}

/// Rows in aligned columns: names left, cells right.
fn in_columns(rows: &[(String, [String; 6])]) -> String {
    let first = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] =
        std::array::from_fn(|k| rows.iter().map(|(_, cells)| cells[k].chars().count()).max().unwrap_or(0));
    let line = |(name, cells): &(String, [String; 6])| {
        let cells = cells.iter().zip(widths).map(|(cell, width)| format!("  {cell:>width$}"));
        format!("{name:<first$}{}", cells.collect::<String>()).trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
