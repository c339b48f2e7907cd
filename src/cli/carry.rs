//! `freebound carry`: constraints of one mesh on another mesh of the surface.

use std::time::Instant;

use super::args::CarryArguments;
use super::awaited::await_report;
use super::error::{CommandError, CommandOutcome, is_standard};
use super::places::OutputPaths;
use super::progress::{ProgressLine, go_on};
use super::standard::read_typed;
use super::summary::{carry_summary, deliver_beside};
use super::transfer::{mesh_as_read, refuse_two_streams};
use freebound_io::{
    Constraints, Registration, Report, Seconds, carried_constraints, write_atomically, write_constraints,
    write_to_standard_output,
};

pub(super) fn run(arguments: &CarryArguments) -> Result<CommandOutcome, CommandError> {
    refuse_two_streams(&arguments.old, &arguments.new)?;
    let places = OutputPaths::of_carry(arguments);
    places.keep_apart()?;
    places.spare(&arguments.old, "the old mesh")?;
    places.spare(&arguments.new, "the new mesh")?;
    places.spare(&arguments.constraints, "the constraint file")?;
    await_report(arguments.report.as_deref());
    let progress = ProgressLine::default();
    progress.follow(|| {
        let start = Instant::now();
        progress.enter("reading");
        let old = read_typed(&arguments.old, arguments.reading)?;
        let new = read_typed(&arguments.new, arguments.reading)?;
        let constraints = Constraints::read(&arguments.constraints, old.vertex_count_in_file())?;
        let read = start.elapsed().as_secs_f64();
        go_on()?;
        progress.enter("carrying");
        let registration = Registration::of(arguments.fit);
        let carried = carried_constraints(&constraints, &old.source.polygons, &new.source.polygons, registration);
        let solve = start.elapsed().as_secs_f64() - read;
        go_on()?;
        progress.enter("writing");
        let before_writing = Instant::now();
        let (targets, notes) = (&carried.constraints.targets, &carried.constraints.notes);
        let is_streamed = is_standard(&arguments.output);
        if is_streamed {
            write_to_standard_output(|out| write_constraints(out, targets, notes))?;
        } else {
            write_atomically(&arguments.output, |out| write_constraints(out, targets, notes))?;
        }
        let write = before_writing.elapsed().as_secs_f64();
        let mesh = mesh_as_read(&new, new.source.polygons.face_count());
        let total = start.elapsed().as_secs_f64();
        let seconds = Seconds { read, solve, write, total, ..Seconds::default() };
        let report = Report { carried: Some(carried.report.clone()), seconds, ..Report::of_mesh(mesh) };
        let words = || carry_summary(&report, &carried.report, &constraints.notes);
        deliver_beside(is_streamed, &report, arguments.report.as_deref(), words)?;
        Ok(CommandOutcome::of(carried.report.lost().is_empty()))
    })
}
