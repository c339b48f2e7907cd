//! What a person reads: the line that follows the work, and the lines that sum it up.

use std::path::Path;

use super::error::CommandError;
use super::error::is_standard;
use super::report_file::put_report;
use super::say::{say, warn};
use freebound_core::flatten::{Ending, Step};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{PackingSummary, PinsSummary, Placement, SolvedProblem};
use freebound_core::problem::{Method, NamedOption as _, SolveError, Stage};
use freebound_core::verify::{Conflict, Verdict};
use freebound_io::{
    ChartNumber, ChartReport, Column, ComparisonReport, ComparisonSeconds, MeshReport, MorphReport, Output, Report,
    Seconds,
};

/// Most vertices or conflicts that are named; the others are only counted.
const NAMED: usize = 10;

/// Vertices by name, the first ones where there are many.
fn listed(vertices: &[VertexId]) -> String {
    let mut names: Vec<String> = vertices.iter().take(NAMED).map(ToString::to_string).collect();
    if vertices.len() > NAMED {
        names.push(format!("and {} more", vertices.len() - NAMED));
    }
    names.join(", ")
}

/// Says on standard error which constraints on a file's mesh contradict each other, before any work is done on them.
pub(super) fn warn_of(file: &str, conflicts: &[Conflict]) {
    for conflict in conflicts.iter().take(NAMED) {
        warn(format_args!("{file}: {}", conflict.words()));
    }
    if conflicts.len() > NAMED {
        warn(format_args!("{file}: and {} more conflicts like these", conflicts.len() - NAMED));
    }
}

/// What a step reached, for the line that follows the work.
pub(super) fn step_words(step: &Step) -> String {
    let number = if step.candidate.stage == Stage::Iterate { format!(" {}", step.index) } else { String::new() };
    let left = step.candidate.progress.map(|progress| progress.distance_left).filter(|&distance| distance > 0.0);
    let left = left.map(|distance| format!(", {distance:.2e} from the targets")).unwrap_or_default();
    format!("{}{number}: {}{left}", step.candidate.stage.words(), step.verdict.summary())
}

/// The verdict, and after how many steps and on which stage a run of several came to it.
pub(super) fn ending_words(solved: &SolvedProblem, output: &Output) -> String {
    let mut words = output.summary();
    let SolvedProblem { outcome, ending } = solved;
    let step = &outcome.step;
    if outcome.problem.settings.method.takes_steps() {
        let count = output.report.steps.len();
        let boundary = if step.candidate.has_convex_boundary() { ", boundary convex" } else { "" };
        let why = match ending {
            Ok(Ending::Planar | Ending::Done) => String::new(),
            Ok(Ending::Unmet) | Err(SolveError::Unmet) => ", constraints not met".to_owned(),
            Ok(Ending::Stalled) => ", which gets no better".to_owned(),
            Ok(Ending::Limit) => ", as many as it may take".to_owned(),
            Err(error) => format!("; the next gave nothing: {error}"),
        };
        let steps = if count == 1 { "step" } else { "steps" };
        let stage = step.candidate.stage.words();
        words = format!("{words} after {count} {steps} ({stage}{boundary}{why})");
    }
    if output.report.placement == Some(Placement::Unmoved) {
        words += "; not moved into the unit square, whose numbers would fold it";
    } else if step.verdict.planar && !output.is_planar() && !is_folded(&output.report) {
        words += "; it was planar before it was brought to this size: try --fit true";
    }
    words
}

/// Whether rounding to 32 bits folds what was planar.
fn is_folded(report: &Report) -> bool {
    report.rounding.is_some_and(|rounding| rounding.folded)
}

/// What rounding to 32 bits did.
fn rounding_words(report: &Report) -> Option<String> {
    if is_folded(report) {
        let text =
            "32 bits are too few: it is planar in 64; write OBJ or PLY with --precision f64, or split it into charts";
        return Some(text.to_owned());
    }
    let moved = report.rounding.map(|rounding| rounding.moved).filter(|&moved| moved > 0)?;
    let vertices = if moved == 1 { "vertex" } else { "vertices" };
    Some(format!("32 bits: {moved} {vertices} moved by a few units of the last place, where rounding folds faces"))
}

/// What became of the user's pins.
fn pins_words(pins: &PinsSummary) -> Option<String> {
    let hard = pins.max_hard_error.map(|error| {
        let count = pins.count - pins.soft.len();
        if error == 0.0 {
            return format!("{count} hard met exactly");
        }
        format!("{count} hard missed by up to {error:.1e}, {} not met: {}", pins.unmet.len(), listed(&pins.unmet))
    });
    let worst = pins.soft.iter().max_by(|a, b| a.error.total_cmp(&b.error));
    let weighted = worst.map(|worst| {
        let count = pins.soft.len();
        format!("{count} weighted met within {:.1e} (the farthest is vertex {})", worst.error, worst.vertex)
    });
    let parts: Vec<String> = hard.into_iter().chain(weighted).collect();
    (!parts.is_empty()).then(|| format!("constraints: {}", parts.join(", ")))
}

/// Says the words for a person, and writes the report where one is wanted. On standard output a report stands alone.
pub(super) fn deliver(report: &Report, to: Option<&Path>, words: impl FnOnce() -> String) -> Result<(), CommandError> {
    if !to.is_some_and(is_standard) {
        say(words())?;
    }
    to.map_or(Ok(()), |path| Ok(put_report(report, path)?))
}

/// What had to be done with the mesh.
fn mesh_words(mesh: &MeshReport) -> Option<String> {
    let unused = match mesh.unused_vertices {
        0 => None,
        1 => Some("1 vertex of no face".to_owned()),
        count => Some(format!("{count} vertices of no face")),
    };
    let longer = Some(mesh.mollification).filter(|&by| by > 0.0);
    let longer = longer.map(|by| format!("faces without area, measured by lengths longer by {by:.1e}"));
    let words: Vec<String> = mesh.repairs.iter().map(ToString::to_string).chain(unused).chain(longer).collect();
    (!words.is_empty()).then(|| format!("mesh: {}", words.join(", ")))
}

/// The first line: what the mesh is.
fn first_words(mesh: &MeshReport) -> String {
    format!(
        "{}: {} vertices, {} faces, {} on the boundary, {} dividing edges, {} ears",
        mesh.path, mesh.vertices, mesh.faces, mesh.boundary_vertices, mesh.dividing_edges, mesh.ears
    )
}

/// What a run of several charts came to.
pub(super) fn atlas_summary(report: &Report) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(mesh_words(&report.mesh));
    let family = report.family.map(|family| format!(", {family} weights")).unwrap_or_default();
    if let Some(atlas) = &report.atlas {
        let holds = if atlas.planar_in_f32 { "; holds in 32 bits" } else { "; does not hold in 32 bits" };
        let holds = if atlas.planar { holds } else { "" };
        lines.push(format!(
            "{}{family}: {}{holds}",
            report.method.as_ref().map_or("check", Method::name),
            atlas.summary()
        ));
    }
    lines.extend(rounding_words(report));
    let mut charts: Vec<&ChartReport> = report.charts.iter().collect();
    charts.sort_by(|a, b| b.distortion.symmetric_dirichlet.mean.total_cmp(&a.distortion.symmetric_dirichlet.mean));
    lines.extend(charts.iter().take(NAMED).map(|chart| chart_words(chart, report.packing)));
    if charts.len() > NAMED {
        lines.push(format!("and {} more charts, less distorted", charts.len() - NAMED));
    }
    lines.extend(relaxing_words_of_charts(report));
    lines.extend(report.packing.map(|PackingSummary { picture: [width, height], gap, density, covered }| {
        let percent = 100.0 * covered;
        format!(
            "packed into {width} x {height} pixels, {gap} apart: {percent:.0} % covered, {density:.4} pixels per unit"
        )
    }));
    lines.push(seconds_words(&report.seconds));
    lines.join("\n")
}

/// What can be done about areas that differ badly, where the map is planar.
fn relaxing_words(report: &Report) -> Option<String> {
    let is_planar = report.verdict.as_ref().is_some_and(|verdict| verdict.planar);
    let distortion = report.distortion.as_ref().filter(|_| is_planar && report.method.is_some())?;
    distortion.bad_ratio_of_areas().map(|ratio| areas_words(ratio, "mesh and map"))
}

/// The same of the chart whose areas differ most, where all are planar.
fn relaxing_words_of_charts(report: &Report) -> Option<String> {
    let is_planar = report.atlas.as_ref().is_some_and(|atlas| atlas.planar);
    let charts = report.charts.iter().filter(|_| is_planar && report.method.is_some());
    let ratios = charts.filter_map(|chart| Some((chart.distortion.bad_ratio_of_areas()?, chart.first_face)));
    let (ratio, face) = ratios.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(areas_words(ratio, &format!("mesh and map in the chart of face {}", face.number())))
}

fn areas_words(ratio: f64, between: &str) -> String {
    let ratio = if ratio < 1e6 { format!("{ratio:.0}") } else { format!("{ratio:.0e}") };
    format!("areas differ {ratio} : 1 between {between}: --relax 20 lowers the distortion, one-to-one throughout")
}

/// What methods that were compared came to: a table, and below it why some failed.
pub(super) fn comparison_summary(report: &ComparisonReport, by: Option<Column>) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(mesh_words(&report.mesh));
    lines.extend(report.chart.map(|ChartNumber { number, of }| format!("chart {number} of {of}")));
    lines.push(report.table(by));
    let failed = report.sorted(by).into_iter().filter_map(|method| Some((&method.name, method.error.as_ref()?)));
    lines.extend(failed.map(|(name, error)| format!("{name}: {}", error.message)));
    lines.extend(report.morph.iter().flat_map(MorphReport::lines));
    let ComparisonSeconds { read, total } = report.seconds;
    lines.push(format!("{total:.3} s: read {read:.3}"));
    lines.join("\n")
}

fn chart_words(chart: &ChartReport, packing: Option<PackingSummary>) -> String {
    let face = chart.first_face.number();
    let steps = if chart.steps.len() == 1 { "1 step".to_owned() } else { format!("{} steps", chart.steps.len()) };
    let stage = chart.steps.last().map(|step| format!(" ({})", step.stage.words())).unwrap_or_default();
    let faces = if chart.faces == 1 { "1 face".to_owned() } else { format!("{} faces", chart.faces) };
    let energy = chart.distortion.symmetric_dirichlet.mean;
    let pins = pins_words(&chart.pins).map(|words| format!("; {words}")).unwrap_or_default();
    // Most charts have the density that all are packed at.
    let is_own = packing.is_none_or(|packing| (chart.density / packing.density - 1.0).abs() > 1e-6);
    let density = if is_own { format!("; {:.4} pixels per unit", chart.density) } else { String::new() };
    format!("chart of face {face}: {faces}, {steps}{stage}; symmetric Dirichlet energy {energy:.3}{density}{pins}")
}

fn seconds_words(seconds: &Seconds) -> String {
    format!(
        "{:.3} s: read {:.3}, solve {:.3}, verify {:.3}, write {:.3}",
        seconds.total, seconds.read, seconds.solve, seconds.verify, seconds.write
    )
}

/// What a run came to.
pub(super) fn summary(report: &Report, verdict: &str) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(mesh_words(&report.mesh));
    let family = report.family.map(|family| format!(", {family} weights")).unwrap_or_default();
    // Where there is no linear system, there is no residual.
    let residual = report.steps.last().and_then(|step| step.residual).filter(|residual| residual.is_finite());
    let residual = residual.map(|residual| format!("; residual {residual:.1e}")).unwrap_or_default();
    let in_f32 = report.verdict.as_ref().and_then(Verdict::summary_in_f32);
    let in_f32 = in_f32.map(|words| format!("; {words}")).unwrap_or_default();
    lines
        .push(format!("{}{family}: {verdict}{residual}{in_f32}", report.method.as_ref().map_or("check", Method::name)));
    lines.extend(rounding_words(report));
    if report.new_vertices > 0 {
        lines.push(format!("new vertices: {} on {} split edges", report.new_vertices, report.split_edges.len()));
    }
    let falls_short = report.verdict.as_ref().is_some_and(|verdict| !verdict.planar);
    let noted = report.steps.iter().filter(|_| falls_short).filter_map(|step| Some((step.index, step.note.as_ref()?)));
    lines.extend(noted.map(|(index, note)| format!("step {index}: {note}")));
    lines.extend(report.pins.as_ref().and_then(pins_words));
    if let Some(distortion) = &report.distortion {
        lines.push(format!(
            "angle distortion {:.3} mean, {:.3} p99; area {:.3} mean; stretch L² {:.3}, L∞ {:.3}; symmetric Dirichlet energy {:.3}",
            distortion.angle.mean,
            distortion.angle.p99,
            distortion.area.mean,
            distortion.stretch_l2,
            distortion.stretch_linf,
            distortion.symmetric_dirichlet.mean
        ));
    }
    lines.extend(relaxing_words(report));
    lines.push(seconds_words(&report.seconds));
    lines.join("\n")
}
