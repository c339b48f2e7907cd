//! The planar morph through the maps that methods have come to.

use super::args::CompareArguments;
use super::error::CommandError;
use super::progress::{INTERRUPTED, ProgressLine};
use crate::session::{Compared, MORPH_FRAMES, MissingLeg, Model, MorphStops, MorphTour};
use freebound_core::bijective::NoMorph;
use freebound_core::problem::{Control, Phase, SolveError};
use freebound_io::{LeftOutReport, machine_memory_bytes};

/// Finds the morphs that are asked for, from each planar map to the next; none where none are asked for.
///
/// # Errors
///
/// Fewer than two planar maps; more frames than there is memory for; two without a morph between them; the user asked to stop.
///
/// # Panics
///
/// If the model is no disk.
pub(super) fn tour_of(
    arguments: &CompareArguments,
    model: &Model,
    methods: &[&Compared],
    progress: &ProgressLine,
) -> Result<Option<MorphTour>, CommandError> {
    if arguments.morph.is_none() {
        return Ok(None);
    }
    let mesh = model.disk().expect("methods run on disks only");
    let stops = MorphStops::of(methods);
    let failure = |what: String| CommandError::NoMorph { path: model.path_words(), what };
    if stops.stops.len() < 2 {
        return Err(failure(too_few(&stops)));
    }
    let frames = arguments.frames.map_or(MORPH_FRAMES, usize::from);
    let too_many = |shortage| CommandError::MorphMemory { path: model.path_words(), shortage };
    stops.check_memory(mesh, frames, machine_memory_bytes()).map_err(too_many)?;
    let report_phase = |phase: Phase| progress.enter(phase.words());
    progress.reach("morph".to_owned());
    let found = MorphTour::through(mesh, stops, frames, Control::new(&INTERRUPTED, &report_phase));
    found.map(Some).map_err(|missing| match missing {
        MissingLeg { reason: NoMorph::Cancelled, .. } => SolveError::Cancelled.into(),
        missing => failure(format!("no morph {missing}")),
    })
}

/// That there are too few maps, with the reason for each that is left out.
fn too_few(stops: &MorphStops) -> String {
    let has = if stops.stops.is_empty() { "no method has one that can take part" } else { "one method alone has it" };
    let reasons: Vec<String> =
        stops.left_out.iter().map(|LeftOutReport { name, why }| format!("{name}: {why}")).collect();
    format!("a morph goes from one planar map to another, and {has} ({})", reasons.join("; "))
}
