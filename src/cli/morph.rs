//! Planar morph through the maps of compared methods.

use super::args::CompareArguments;
use super::error::CommandError;
use super::progress::{INTERRUPTED, ProgressLine};
use crate::session::{Compared, MORPH_FRAMES, MissingLeg, Model, MorphStops, MorphTour};
use freebound_core::bijective::NoMorph;
use freebound_core::problem::{Control, Phase, SolveError};
use freebound_io::{LeftOutReport, machine_memory_bytes};

/// Finds the requested morphs between consecutive planar maps. `None` if no morph is requested.
///
/// # Errors
///
/// [`CommandError`] if there are fewer than two planar maps, the frames need too much memory, two maps have no morph,
/// or the user interrupts.
///
/// # Panics
///
/// If the model is not a disk.
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

/// Message that there are too few maps, with the reason for each method that is left out.
fn too_few(stops: &MorphStops) -> String {
    let has = if stops.stops.is_empty() { "no method has one that can be used" } else { "only one method has one" };
    let reasons: Vec<String> =
        stops.left_out.iter().map(|LeftOutReport { name, why }| format!("{name}: {why}")).collect();
    format!("a morph needs two planar maps, but {has} ({})", reasons.join("; "))
}
