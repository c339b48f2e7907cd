//! Rung 1 once more, with conformal weights and the default pins, moved to where the user's pins want it.
//!
//! This is our addition to the ladder. The virtual boundary keeps a boundary that is simple and bends one that is not to
//! a circle. Before it has to bend, the ladder starts once more, if other weights or pins were asked for: the default
//! ones' boundary is simple far more often, and stays free.

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{Control, Family, Method, Pins, Settings, solve_once};

#[derive(Debug, Default)]
pub(super) struct Again {
    is_done: bool,
}

impl Rung for Again {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let settings = Settings { size: from.task.settings.size, ..Settings::new(Method::Natural, Family::default()) };
        let mut solution = solve_once(from.mesh, &settings, &Pins::new(), control)
            .map_err(|error| Failure::of("starting again", error))?;
        self.is_done = true;
        solution.pins = Pins::new();
        let note = "started again with conformal weights and the farthest boundary vertices as pins".to_owned();
        Ok(Candidate { note: Some(note), ..Candidate::new(Method::Natural, settings.family(), solution) })
    }

    fn has_more(&self, task: &Task, latest: Option<&Latest>) -> bool {
        let is_other = task.settings.family() != Family::default() || !task.pins.is_empty();
        is_other && !self.is_done && latest.is_none_or(|latest| !latest.has_simple_boundary)
    }
}
