//! `freebound compare`: several methods on one mesh. Each method runs alone, with all threads and from the beginning,
//! so that their times can be compared. Verdicts and failures of the methods are results, not errors.

use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use super::args::{CompareArguments, ComparisonFile};
use super::awaited::await_report;
use super::error::is_standard;
use super::error::{CommandError, CommandOutcome};
use super::morph::tour_of;
use super::opened::{InputSpec, LoadedMesh};
use super::places::OutputPaths;
use super::progress::go_on;
use super::progress::{INTERRUPTED, ProgressLine};
use super::report_file::put_report;
use super::say::say;
use super::summary::comparison_summary;
use super::threads::set_threads;
use crate::session::{Compared, Model, MorphTour, comparison_report};
use crate::view::{ComparisonPicture, MorphPicture};
use freebound_core::geom::PictureFrame;
use freebound_core::pipeline::{Problem, Targets};
use freebound_core::problem::{Control, Family, Method, NamedOption as _, Phase, Start, Variant};
use freebound_io::figure::FigureFormat;
use freebound_io::{
    ComparisonReport, ComparisonSeconds, PictureFile, TimedStep, WriteError, write_atomically, write_to_standard_output,
};

pub(super) fn run(arguments: &CompareArguments) -> Result<CommandOutcome, CommandError> {
    let CompareArguments { input, solve, .. } = arguments;
    let places = OutputPaths::of_compare(arguments);
    places.keep_apart()?;
    places.spare_inputs(input, solve)?;
    if let Some(picture) = &arguments.picture {
        places.spare(picture, "the picture")?;
    }
    let drawn = [&arguments.png, &arguments.svg, &arguments.pdf, &arguments.morph];
    if arguments.shading.is_some() && drawn.iter().all(|path| path.is_none()) {
        return Err(CommandError::Usage("--shading colours pictures only: add --png, --svg, --pdf or --morph".into()));
    }
    await_report(arguments.report.as_deref());
    set_threads(solve.threads)?;
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        let wanted = InputSpec { input, solve, picture: arguments.picture.as_deref() };
        let LoadedMesh { model: whole, picture, targets } = wanted.open(&places, &progress)?;
        let model = chart_of(&whole, arguments.chart)?;
        let aspect = picture.as_ref().map(PictureFile::aspect).or(solve.aspect);
        let frame = PictureFrame { aspect: aspect.unwrap_or(1.0), ..PictureFrame::default() };
        let targets = targets_of_chart(&model, targets)?;
        let problem = Problem::new(&arguments.settings(), frame, aspect.is_some(), targets);
        if problem.settings.start == Start::File {
            model.layout().map_err(|error| CommandError::of_layout(&model, error))?;
        }
        let problems = problems(arguments, &problem)?;
        let read = start.elapsed().as_secs_f64();
        let methods = run_all(&model, problems, &progress)?;
        let methods: Vec<&Compared> = methods.iter().collect();
        let tour = tour_of(arguments, &model, &methods, &progress)?;
        let mut report = comparison_report(&model, &methods);
        report.morph = tour.as_ref().map(MorphTour::report);
        report.seconds = ComparisonSeconds { read, total: start.elapsed().as_secs_f64() };
        progress.enter("writing");
        write(arguments, &report, &Found { model: &model, methods: &methods, tour: tour.as_ref() })?;
        conclude(arguments, &report)
    })
}

/// Requested chart, or the largest one. The mesh itself if it is one chart.
fn chart_of(model: &Model, wanted: Option<usize>) -> Result<Model, CommandError> {
    let count = model.chart_count();
    match wanted {
        Some(number) if number >= count => {
            let has = if count == 1 { "one chart".to_owned() } else { format!("charts 0 to {}", count - 1) };
            Err(CommandError::Usage(format!("{}: --chart {number}: the mesh has {has}", model.path_words())))
        }
        Some(number) => Ok(model.of_chart(number)),
        None => {
            Ok(model.prepared.chart.as_ref().map_or_else(|| model.clone(), |of| model.of_chart(of.charts.pick(None))))
        }
    }
}

/// Targets of the chart, by its own vertices.
fn targets_of_chart(model: &Model, targets: Targets) -> Result<Targets, CommandError> {
    let own = |(vertex, target)| match model.vertex_of_file(vertex) {
        Some(own) => Ok((own, target)),
        // The solver rejects vertices that do not exist.
        None if model.prepared.chart.is_none() => Ok((vertex, target)),
        None => {
            let number = model.prepared.chart.as_ref().map_or(0, |of| of.number);
            let text = format!("vertex {vertex} is pinned, but is not on chart {number}, which is compared");
            Err(CommandError::Usage(format!("{}: {text}: choose its chart with --chart", model.path_words())))
        }
    };
    targets.into_iter().map(own).collect()
}

/// Problems of the requested methods. Default: all methods that suit the pins.
fn problems(arguments: &CompareArguments, problem: &Problem) -> Result<Vec<Problem>, CommandError> {
    let suited = || Method::ALL.iter().filter(|method| problem.suits(method));
    let mut variants = arguments.methods.clone();
    if variants.is_empty() {
        variants = suited().map(|method| Variant { method: method.clone(), family: None }).collect();
    }
    let methods: Vec<Method> = variants.iter().map(|variant| variant.method.clone()).collect();
    if arguments.morph.is_some() && methods.len() < 2 {
        return Err(CommandError::Usage("--morph needs the maps of at least two methods: add one to --methods".into()));
    }
    if let Some((option, why)) = arguments.solve.idle_option(&methods) {
        return Err(CommandError::Usage(format!("no compared method uses {option}: {}: {why}", methods[0].name())));
    }
    if let Some(family) = arguments.solve.family {
        give_weights(&mut variants, family)?;
    }
    let problems: Vec<Problem> = variants.into_iter().map(|variant| problem.by(&variant)).collect();
    for (count, second) in problems.iter().enumerate() {
        if problems[..count].iter().any(|first| first.settings.resolves_to(&second.settings)) {
            let name = Variant::of(&second.settings);
            return Err(CommandError::Usage(format!("--methods: {name} would run twice: remove one of them")));
        }
    }
    Ok(problems)
}

/// Sets the requested weights for the methods that name none and support them.
///
/// # Errors
///
/// [`CommandError`] if there is no such method.
fn give_weights(variants: &mut [Variant], family: Family) -> Result<(), CommandError> {
    let mut refused = None;
    let mut are_given = false;
    for variant in variants.iter_mut().filter(|variant| variant.method.uses_family() && variant.family.is_none()) {
        match family.check_for(&variant.method) {
            Ok(()) => (variant.family, are_given) = (Some(family), true),
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    match refused {
        _ if are_given => Ok(()),
        Some(error) => Err(error.into()),
        None => Err(CommandError::Usage("no compared method uses --family: all name their own weights".into())),
    }
}

/// Runs each method to its end.
///
/// # Errors
///
/// [`CommandError`] if the user interrupts, or no method supports the pins.
fn run_all(model: &Model, problems: Vec<Problem>, progress: &ProgressLine) -> Result<Vec<Compared>, CommandError> {
    let report_phase = |phase: Phase| progress.enter(phase.words());
    let control = Control::new(&INTERRUPTED, &report_phase);
    let mut methods = Vec::new();
    for problem in problems {
        let name = Variant::of(&problem.settings).to_string();
        progress.reach(name.clone());
        let follow = |step: &TimedStep| progress.reach(format!("{name}, step {}", step.step.index));
        let compared = Compared::run(model, problem, control, follow)?;
        if let Err(error) = &compared.ending
            && error.is_of_pins()
        {
            return Err(error.clone().renumbered(|vertex| model.vertex_in_file(vertex)).into());
        }
        methods.push(compared);
    }
    Ok(methods)
}

/// Results to be drawn.
struct Found<'a> {
    model: &'a Model,
    methods: &'a [&'a Compared],
    tour: Option<&'a MorphTour>,
}

/// Writes all files except the report. The picture is drawn only if it is requested, and only once.
fn write(arguments: &CompareArguments, report: &ComparisonReport, found: &Found<'_>) -> Result<(), CommandError> {
    let Found { model, methods, tour } = *found;
    let shading = arguments.shading.unwrap_or_default();
    let is_drawn = [&arguments.png, &arguments.svg, &arguments.pdf].iter().any(|path| path.is_some());
    let page = is_drawn.then(|| ComparisonPicture { model, methods, shading }.page());
    let morph = model.disk().zip(tour).map(|(mesh, tour)| MorphPicture::new(mesh, tour, shading));
    for (file, _, path) in arguments.outputs() {
        go_on()?;
        put(path, |mut out| match (file, &page, &morph) {
            (ComparisonFile::Table, ..) => report.write_csv(arguments.sort, out),
            (ComparisonFile::Steps, ..) => report.write_steps(out),
            (ComparisonFile::Png, Some(page), _) => page.write(FigureFormat::Png, &mut out),
            (ComparisonFile::Svg, Some(page), _) => page.write(FigureFormat::Svg, &mut out),
            (ComparisonFile::Pdf, Some(page), _) => page.write(FigureFormat::Pdf, &mut out),
            (ComparisonFile::Morph, _, Some(morph)) => morph.write(out),
            (ComparisonFile::Png | ComparisonFile::Svg | ComparisonFile::Pdf | ComparisonFile::Morph, ..) => Ok(()),
        })?;
    }
    Ok(())
}

/// Writes a file atomically, or to standard output for `-`.
fn put(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    if is_standard(path) {
        write_to_standard_output(|out| write(out))
    } else {
        write_atomically(path, |out| write(out))
    }
}

/// Prints the table and writes the report. If a file goes to standard output, nothing else is printed there.
fn conclude(arguments: &CompareArguments, report: &ComparisonReport) -> Result<CommandOutcome, CommandError> {
    let to = arguments.report.as_deref();
    let is_taken = arguments.outputs().iter().any(|(_, _, path)| is_standard(path)) || to.is_some_and(is_standard);
    if !is_taken {
        say(comparison_summary(report, arguments.sort))?;
    }
    to.map_or(Ok(()), |path| put_report(report, path))?;
    Ok(CommandOutcome::Fine)
}
