//! Texts for the terminal: the progress line and the summary of a run.

use std::fmt::Display;
use std::path::Path;

use super::error::CommandError;
use super::error::is_standard;
use super::report_file::put_report;
use super::say::{say, warn};
use freebound_core::cutting::SeamOptions;
use freebound_core::flatten::{Ending, Step};
use freebound_core::geom::PackingOptions;
use freebound_core::mesh::{Diagnosis, Repair};
use freebound_core::pipeline::{PackingSummary, PinsSummary, Placement, SolvedProblem, StackedOn};
use freebound_core::problem::{Method, NamedOption as _, SolveError, Stage};
use freebound_core::verify::{Conflict, DistortionSummary, Finding, FindingSeverity, Verdict};
use freebound_io::{
    BakeReport, CarriedVertex, CarryReport, ChartNumber, ChartReport, Column, ComparisonReport, ComparisonSeconds,
    MeshReport, MorphReport, Output, PinNotes, Report, SeamsReport, Seconds, StepReport, TransferReport,
};

/// Symmetric Dirichlet energy above which a map is badly distorted: twice that of an isometric map.
const BAD_ENERGY: f64 = 8.0;

/// Maximum number of vertices, conflicts or charts that are listed. The others are only counted.
const NAMED: usize = 10;

/// List of elements, shortened if there are many.
fn listed(elements: &[impl Display]) -> String {
    let mut names: Vec<String> = elements.iter().take(NAMED).map(ToString::to_string).collect();
    if elements.len() > NAMED {
        names.push(format!("and {} more", elements.len() - NAMED));
    }
    names.join(", ")
}

/// Warns of conflicting constraints on the mesh of a file, before the solve.
pub(super) fn warn_of(file: &str, conflicts: &[Conflict]) {
    for conflict in conflicts.iter().take(NAMED) {
        warn(format_args!("{file}: {}", conflict.words()));
    }
    if conflicts.len() > NAMED {
        warn(format_args!("{file}: and {} more conflicts", conflicts.len() - NAMED));
    }
}

/// Text for a step, for the progress line.
pub(super) fn step_words(step: &Step) -> String {
    let number = if step.candidate.stage == Stage::Iterate { format!(" {}", step.index) } else { String::new() };
    let left = step.candidate.progress.map(|progress| progress.distance_left).filter(|&distance| distance > 0.0);
    let left = left.map(|distance| format!(", {distance:.2e} from the targets")).unwrap_or_default();
    format!("{}{number}: {}{left}", step.candidate.stage.words(), step.verdict.summary())
}

/// Text for the verdict. For a method with several steps it includes their number, the last stage and the ending.
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
            Ok(Ending::Stalled) => ", no further improvement".to_owned(),
            Ok(Ending::Limit) => ", step limit reached".to_owned(),
            Err(error) => format!("; the next step failed: {error}"),
        };
        let steps = if count == 1 { "step" } else { "steps" };
        let stage = step.candidate.stage.words();
        let is_chosen = outcome.problem.settings.method == Method::Auto && outcome.problem.targets.is_empty();
        let taken = match output.report.written_step {
            Some(written) if is_chosen => format!("at step {written}, the best of {count}"),
            Some(written) => format!("at step {written} of {count}"),
            None => format!("after {count} {steps}"),
        };
        words = format!("{words} {taken} ({stage}{boundary}{why})");
    }
    if output.report.placement == Some(Placement::Unmoved) {
        words += "; not moved into the unit square: rounding there would fold it";
    } else if step.verdict.planar && !output.is_planar() && !is_folded(&output.report) {
        words += "; it was planar before scaling: try --fit true";
    }
    words
}

/// True if rounding to 32 bits folds a planar map.
fn is_folded(report: &Report) -> bool {
    report.rounding.is_some_and(|rounding| rounding.folded)
}

/// Text for the effect of rounding to 32 bits.
fn rounding_words(report: &Report) -> Option<String> {
    if is_folded(report) {
        // Only a run with a method can cut.
        let can_cut = report.method.is_some() && report.seams.is_none();
        let cut = if can_cut { "add --cut auto, or " } else { "" };
        return Some(format!("planar in 64 bits, but not in 32: {cut}write OBJ or PLY with --precision f64"));
    }
    let moved = report.rounding.map(|rounding| rounding.moved).filter(|&moved| moved > 0)?;
    let vertices = if moved == 1 { "vertex" } else { "vertices" };
    Some(format!(
        "32 bits: {moved} {vertices} moved by a few units of the last place, to keep rounding from folding faces"
    ))
}

/// Text for the errors of the user's pins.
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
        format!("{count} soft met within {:.1e} (farthest: vertex {})", worst.error, worst.vertex)
    });
    let parts: Vec<String> = hard.into_iter().chain(weighted).collect();
    (!parts.is_empty()).then(|| format!("constraints: {}", parts.join(", ")))
}

/// Prints the summary, and writes the report if it is requested. If the report goes to standard output, the summary is
/// omitted.
pub(super) fn deliver(report: &Report, to: Option<&Path>, words: impl FnOnce() -> String) -> Result<(), CommandError> {
    if !to.is_some_and(is_standard) {
        say(words())?;
    }
    to.map_or(Ok(()), |path| Ok(put_report(report, path)?))
}

/// Prints the summary, and writes the report if it is requested. If the result goes to standard output, the
/// summary is omitted.
pub(super) fn deliver_beside(
    is_streamed: bool,
    report: &Report,
    to: Option<&Path>,
    words: impl FnOnce() -> String,
) -> Result<(), CommandError> {
    if is_streamed { to.map_or(Ok(()), |path| Ok(put_report(report, path)?)) } else { deliver(report, to, words) }
}

/// Text for repairs and other treatment of the mesh.
pub(super) fn mesh_words(mesh: &MeshReport) -> Option<String> {
    let some = |count: usize, one: &str, many: &str| (count > 0).then(|| counted(count, one, many));
    let unused = some(mesh.unused_vertices, "unreferenced vertex", "unreferenced vertices");
    let touching = some(mesh.touching_vertices, "vertex touches", "vertices touch");
    let touching = touching.map(|words| format!("{words} other parts (--repair all joins them)"));
    let point =
        some(mesh.degenerate_faces.len(), "degenerate face lies at one point", "degenerate faces lie at one point");
    let point = point.map(|words| format!("{words} of the map: {}", listed(&mesh.degenerate_faces)));
    let longer = Some(mesh.mollification).filter(|&by| by > 0.0);
    let longer = longer.map(|by| format!("zero-area faces, edge lengths increased by {by:.1e}"));
    let notes = [point, unused, touching, longer].into_iter().flatten();
    let words: Vec<String> = mesh.repairs.iter().map(ToString::to_string).chain(notes).collect();
    (!words.is_empty()).then(|| format!("mesh: {}", words.join(", ")))
}

/// Text for what the reader left out of the file, or read once for several places.
pub(super) fn file_words(mesh: &MeshReport) -> Option<String> {
    let words: Vec<String> = mesh.warnings.iter().map(ToString::to_string).collect();
    (!words.is_empty()).then(|| format!("file: {}", words.join(", ")))
}

/// Text for data of the file that the written meshes do not hold.
fn not_kept_words(report: &Report) -> Option<String> {
    let words: Vec<&str> = report.not_kept.iter().map(|data| data.word()).collect();
    (!words.is_empty()).then(|| format!("not written: {} of the file", words.join(", ")))
}

/// First line: size of the mesh.
fn first_words(mesh: &MeshReport) -> String {
    format!("{}: {}", mesh.path, size_words(mesh))
}

/// Numbers of vertices, faces and boundary vertices.
pub(super) fn size_words(mesh: &MeshReport) -> String {
    let vertices = counted(mesh.vertices, "vertex", "vertices");
    let faces = counted(mesh.faces, "face", "faces");
    format!("{vertices}, {faces}, {} on the boundary", mesh.boundary_vertices)
}

/// Count with its noun.
fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}

/// Summary of a run with several charts.
pub(super) fn atlas_summary(report: &Report) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(file_words(&report.mesh));
    lines.extend(mesh_words(&report.mesh));
    lines.extend(seams_words(report));
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
    lines.extend(not_kept_words(report));
    let mut charts: Vec<&ChartReport> = report.charts.iter().collect();
    charts.sort_by(|a, b| b.distortion.symmetric_dirichlet.mean.total_cmp(&a.distortion.symmetric_dirichlet.mean));
    lines.extend(charts.iter().take(NAMED).map(|chart| chart_words(chart, report.packing)));
    if charts.len() > NAMED {
        lines.push(format!("and {} more charts, less distorted", charts.len() - NAMED));
    }
    if report.start.is_some() {
        let notes = |chart: &ChartReport| {
            let face = chart.first_face.number();
            let noted = chart.steps.iter().filter_map(|step| Some((step.index, step.note.as_ref()?)));
            noted.map(|(index, note)| format!("chart of face {face}: step {index}: {note}")).collect::<Vec<_>>()
        };
        lines.extend(report.charts.iter().flat_map(notes).take(NAMED));
    }
    lines.extend(distortion_words_of_charts(report));
    lines.extend(packing_words(report));
    lines.push(seconds_words(&report.seconds));
    lines.join("\n")
}

/// Lines on the packing, if charts were packed.
fn packing_words(report: &Report) -> Vec<String> {
    let Some(packing) = report.packing else { return Vec::new() };
    let PackingSummary { picture: [width, height], gap, density, tiles, covered, .. } = packing;
    let percent = 100.0 * covered;
    let size = format!("{width} x {height} pixels");
    let size = if tiles > 1 { format!("{tiles} tiles of {size}") } else { size };
    let unmet = |density| {
        format!("density {density} does not fit into {} pixels a side: lower --density", PackingOptions::LONGEST_SIDE)
    };
    let packed = format!("packed into {size}, {gap} apart: {percent:.0} % covered, {density:.4} pixels per unit");
    std::iter::once(packed).chain(packing.unmet_density().map(unmet)).collect()
}

/// Summary of a layout that was packed again. `faults` keep its charts from being proved.
pub(super) fn pack_summary(report: &Report, faults: Option<&Diagnosis>) -> String {
    let MeshReport { path, vertices, faces, .. } = &report.mesh;
    let charts = counted(report.packed_charts.len(), "chart", "charts");
    let mut lines = vec![format!("{path}: {vertices} vertices, {faces} faces, {charts}")];
    lines.extend(file_words(&report.mesh));
    lines.extend(report.atlas.as_ref().map(|atlas| {
        let holds = if atlas.planar_in_f32 { "; holds in 32 bits" } else { "; does not hold in 32 bits" };
        format!("pack: {}{}", atlas.summary(), if atlas.planar { holds } else { "" })
    }));
    lines.extend(faults.map(|faults| format!("pack: not proved: a chart is no surface with a boundary\n{faults}")));
    lines.extend(rounding_words(report));
    lines.extend(not_kept_words(report));
    let folded = report.packed_charts.iter().filter(|chart| !chart.was_planar).count();
    lines.extend(match folded {
        0 => None,
        1 => Some("1 chart was not planar in the given layout".to_owned()),
        _ => Some(format!("{folded} charts were not planar in the given layout")),
    });
    lines.extend(packing_words(report));
    let Seconds { read, verify, write, total, .. } = report.seconds;
    lines.push(format!("{total:.3} s: read {read:.3}, pack and verify {verify:.3}, write {write:.3}"));
    lines.join("\n")
}

/// Summary of a layout that was copied to another mesh.
pub(super) fn transfer_summary(report: &Report) -> String {
    let MeshReport { path, vertices, faces, .. } = &report.mesh;
    let mut lines = vec![format!("{path}: {vertices} vertices, {faces} faces")];
    lines.extend(file_words(&report.mesh));
    lines.extend(report.transfer.as_ref().map(|transfer| match *transfer {
        TransferReport::Corners => "transfer: the meshes have equal faces: matched corner by corner".to_owned(),
        TransferReport::NearestPoints { largest_distance, mean_distance, diagonal, .. } => {
            let [largest, mean] = [largest_distance, mean_distance].map(|distance| 100.0 * distance / diagonal);
            format!(
                "transfer: matched by nearest points, {mean:.2} % of the size apart on average, {largest:.2} % at most"
            )
        }
    }));
    lines.extend(report.transfer.filter(TransferReport::is_apart).map(|_| APART.to_owned()));
    lines.extend(report.layout.as_ref().map(|layout| format!("layout: {}", layout.summary())));
    lines.extend(report.layout.iter().flat_map(|layout| layout.findings.iter().map(finding_words)));
    lines.extend(not_kept_words(report));
    let Seconds { read, verify, write, total, .. } = report.seconds;
    lines.push(format!("{total:.3} s: read {read:.3}, copy and verify {verify:.3}, write {write:.3}"));
    lines.join("\n")
}

/// Warning about meshes that lie apart.
const APART: &str = "the meshes lie apart: try --fit, or move and scale them to one place and size";

/// Line of a finding, which begins with its severity and code.
pub(super) fn finding_words(finding: &Finding) -> String {
    let severity = match finding.severity {
        FindingSeverity::Error => "error",
        FindingSeverity::Warning => "warning",
        FindingSeverity::Note => "note",
    };
    format!("{severity} {}: {finding}", finding.code.name())
}

/// Summary of a picture that was drawn for another layout.
pub(super) fn bake_summary(report: &Report, picture: &Path, [width, height]: [u32; 2]) -> String {
    let Some(BakeReport { covered, outside, largest_distance, diagonal }) = report.baked else { return String::new() };
    let mut lines = vec![format!("{}: {width} x {height} pixels, {:.1} % covered", picture.display(), 100.0 * covered)];
    lines.extend(file_words(&report.mesh));
    let percent = 100.0 * largest_distance / diagonal;
    lines.push(format!("bake: the surfaces are {percent:.2} % of the size apart at most"));
    lines.extend(report.baked.filter(BakeReport::is_apart).map(|_| APART.to_owned()));
    lines.extend((outside > 0).then(|| {
        let faces = counted(outside, "triangle lies", "triangles lie");
        format!("{faces} outside the picture, at least in part: pack the new layout first")
    }));
    let Seconds { read, solve, write, total, .. } = report.seconds;
    lines.push(format!("{total:.3} s: read {read:.3}, draw {solve:.3}, write {write:.3}"));
    lines.join("\n")
}

/// Summary of carried constraints: both vertices of each, for a look at the correspondence.
pub(super) fn carry_summary(report: &Report, carried: &CarryReport, notes: &PinNotes) -> String {
    let mut lines: Vec<String> = carried.vertices.iter().map(|vertex| carried_words(carried, vertex, notes)).collect();
    lines.extend(file_words(&report.mesh));
    let counted = counted(carried.count, "constraint", "constraints");
    lines.push(if carried.same_faces {
        format!("{counted} carried: the faces are equal, so vertices keep their numbers")
    } else {
        format!("{counted} carried, vertices move by at most {:.2} % of the mesh's diagonal", carried.largest_percent())
    });
    let lost = carried.lost();
    lines.extend((!lost.is_empty()).then(|| format!("lost: {}: the new mesh has no free vertex near", listed(&lost))));
    lines.extend(carried.is_apart().then(|| APART.to_owned()));
    lines.join("\n")
}

/// Line of a carried constraint.
fn carried_words(report: &CarryReport, carried: &CarriedVertex, notes: &PinNotes) -> String {
    let name = notes.get(&carried.from).and_then(|note| note.name.as_ref());
    let name = name.map(|name| format!(" ({name})")).unwrap_or_default();
    match carried.to {
        Some(to) => {
            format!("{}{name} -> {to}, {:.2} % of the diagonal away", carried.from, report.percent(carried.distance))
        }
        None => format!("{}{name} is lost", carried.from),
    }
}

/// Advice on a badly distorted map, if it is planar.
fn distortion_words(report: &Report) -> Option<String> {
    let is_planar = report.verdict.as_ref().is_some_and(|verdict| verdict.planar);
    let distortion = report.distortion.as_ref().filter(|_| is_planar && report.method.is_some())?;
    let is_pinned = report.pins.as_ref().is_some_and(|pins| pins.count > 0);
    let remedy = DistortionRemedy::of(distortion, &report.steps, report, is_pinned)?;
    Some(remedy.words(distortion, "mesh and map"))
}

/// Advice on the most distorted chart that a remedy helps, if all charts are planar.
fn distortion_words_of_charts(report: &Report) -> Option<String> {
    let is_planar = report.atlas.as_ref().is_some_and(|atlas| atlas.planar);
    let charts = report.charts.iter().filter(|_| is_planar && report.method.is_some());
    let energy = |chart: &ChartReport| chart.distortion.symmetric_dirichlet.mean;
    let remedies = charts.filter_map(|chart| {
        Some((chart, DistortionRemedy::of(&chart.distortion, &chart.steps, report, chart.pins.count > 0)?))
    });
    let (chart, remedy) = remedies.max_by(|(a, _), (b, _)| energy(a).total_cmp(&energy(b)))?;
    Some(remedy.words(&chart.distortion, &format!("mesh and map in the chart of face {}", chart.first_face.number())))
}

/// Options that lower the distortion of a map.
#[derive(Clone, Copy)]
enum DistortionRemedy {
    /// Relaxing the map.
    Relax,
    /// Cutting holes open instead of filling them.
    Cut,
    /// Cutting along more seams.
    CutMore,
}

impl DistortionRemedy {
    /// Smallest remedy of a map; `None` if its distortion is small, or no option lowers it.
    fn of(distortion: &DistortionSummary, steps: &[StepReport], report: &Report, is_pinned: bool) -> Option<Self> {
        let energy = distortion.symmetric_dirichlet.mean;
        let is_bad = energy > BAD_ENERGY || distortion.bad_ratio_of_areas().is_some();
        // Degenerate faces alone can differ in area, and nothing helps them.
        if !is_bad || energy <= SeamOptions::DISTORTION {
            return None;
        }
        if steps.last().is_some_and(|step| step.stage != Stage::Relax) {
            return Some(Self::Relax);
        }
        let is_filled = report.mesh.repairs.iter().any(|done| done.repair == Repair::FillHoles);
        let remedy = if is_filled { Self::Cut } else { Self::CutMore };
        (energy > BAD_ENERGY && report.seams.is_none() && !is_pinned).then_some(remedy)
    }

    fn words(self, distortion: &DistortionSummary, between: &str) -> String {
        let remedy = match self {
            Self::Relax => "add --relax 20 to lower the distortion",
            Self::Cut => "add --cut auto to cut holes open instead of filling them",
            Self::CutMore => "add --cut auto --distortion 4.1 to cut along seams",
        };
        match distortion.bad_ratio_of_areas() {
            Some(ratio) => {
                let ratio = if ratio < 1e6 { format!("{ratio:.0}") } else { format!("{ratio:.0e}") };
                format!("areas of {between} differ by {ratio} : 1: {remedy}")
            }
            None => format!("{between} differ by an energy of {:.1}: {remedy}", distortion.symmetric_dirichlet.mean),
        }
    }
}

/// Summary of compared methods: a table, followed by the reasons of failures.
pub(super) fn comparison_summary(report: &ComparisonReport, by: Option<Column>) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(file_words(&report.mesh));
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

/// Step that is written: the last one, unless the report names another.
fn written_of(steps: &[StepReport], written: Option<usize>) -> Option<&StepReport> {
    steps.iter().rfind(|step| written.is_none_or(|written| step.index == written))
}

fn chart_words(chart: &ChartReport, packing: Option<PackingSummary>) -> String {
    let face = chart.first_face.number();
    let steps = counted(chart.steps.len(), "step", "steps");
    let written = written_of(&chart.steps, chart.written_step);
    let stage = written.map(|step| format!(" ({})", step.stage.words())).unwrap_or_default();
    let faces = counted(chart.faces, "face", "faces");
    let energy = chart.distortion.symmetric_dirichlet.mean;
    let pins = pins_words(&chart.pins).map(|words| format!("; {words}")).unwrap_or_default();
    // Most charts have the common density of the packing.
    let is_own = packing.is_none_or(|packing| (chart.density / packing.density - 1.0).abs() > 1e-6);
    let density = if is_own && chart.placement != Placement::True && chart.density.is_finite() {
        format!("; {:.4} pixels per unit", chart.density)
    } else {
        String::new()
    };
    let tile = chart.tile.filter(|_| packing.is_some_and(|packing| packing.tiles > 1));
    let tile = tile.map(|tile| format!("; tile {tile}")).unwrap_or_default();
    let locked = if chart.placement == Placement::Locked { "; locked" } else { "" };
    let stacked = chart.stacked.map(|StackedOn { chart, mirrored }| {
        let how = if mirrored { "mirrored on" } else { "stacked on" };
        format!("; {how} chart {chart}")
    });
    let stacked = stacked.unwrap_or_default();
    let words = format!("chart of face {face}: {faces}, {steps}{stage}; symmetric Dirichlet energy {energy:.3}");
    format!("{words}{density}{tile}{locked}{stacked}{pins}")
}

/// Line on automatic seams, if some were cut.
fn seams_words(report: &Report) -> Option<String> {
    let seams = report.seams.filter(|seams| seams.length > 0.0)?;
    let SeamsReport { length, relative_length, bound } = seams;
    Some(format!("seams: {length:.4} long, {relative_length:.2} √area; wanted energy: at most {bound}"))
}

fn seconds_words(seconds: &Seconds) -> String {
    let cut = if seconds.cut > 0.0 { format!(", cut {:.3}", seconds.cut) } else { String::new() };
    format!(
        "{:.3} s: read {:.3}{cut}, solve {:.3}, verify {:.3}, write {:.3}",
        seconds.total, seconds.read, seconds.solve, seconds.verify, seconds.write
    )
}

/// Summary of a run.
pub(super) fn summary(report: &Report, verdict: &str) -> String {
    let mut lines = vec![first_words(&report.mesh)];
    lines.extend(file_words(&report.mesh));
    lines.extend(mesh_words(&report.mesh));
    lines.extend(seams_words(report));
    let family = report.family.map(|family| format!(", {family} weights")).unwrap_or_default();
    // Without a linear system there is no residual.
    let written = written_of(&report.steps, report.written_step);
    let residual = written.and_then(|step| step.residual).filter(|residual| residual.is_finite());
    let residual = residual.map(|residual| format!("; residual {residual:.1e}")).unwrap_or_default();
    let in_f32 = report.verdict.as_ref().and_then(Verdict::summary_in_f32);
    let in_f32 = in_f32.map(|words| format!("; {words}")).unwrap_or_default();
    lines
        .push(format!("{}{family}: {verdict}{residual}{in_f32}", report.method.as_ref().map_or("check", Method::name)));
    lines.extend(rounding_words(report));
    lines.extend(not_kept_words(report));
    if report.new_vertices > 0 {
        lines.push(format!("new vertices: {} on {} split edges", report.new_vertices, report.split_edges.len()));
    }
    // Notes say why a given layout was not kept, or why the map is not planar.
    let is_noted = report.start.is_some() || report.verdict.as_ref().is_some_and(|verdict| !verdict.planar);
    let noted = report.steps.iter().filter(|_| is_noted).filter_map(|step| Some((step.index, step.note.as_ref()?)));
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
    lines.extend(distortion_words(report));
    lines.push(seconds_words(&report.seconds));
    lines.join("\n")
}
