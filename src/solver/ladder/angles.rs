//! Angle based flattening: one step, which no pin has a part in.

use super::Candidate;
use super::rung::{Failure, Footing, Latest, Rung};
use super::task::Task;
use crate::solver::{AngleMap, AngleSystem, Control, Family, Method, angle_based};

#[derive(Debug, Default)]
pub(super) struct Angles {
    is_done: bool,
}

impl Rung for Angles {
    fn step(&mut self, from: Footing<'_>, control: Control<'_>) -> Result<Candidate, Failure> {
        let (method, system) = match from.task.settings.method {
            Method::Abf => (Method::Abf, AngleSystem::Full),
            _ => (Method::AbfPlusPlus, AngleSystem::Reduced),
        };
        let found = angle_based(from.mesh, system, control)?;
        self.is_done = true;
        let note = note(&found);
        Ok(Candidate { note, ..Candidate::new(method, Family::default(), found.solution) })
    }

    fn has_more(&self, _: &Task, _: Option<&Latest>) -> bool {
        !self.is_done
    }
}

fn note(found: &AngleMap) -> Option<String> {
    let convergence = found.solution.convergence?;
    let steps = format!("{} Newton steps: {}", convergence.steps, convergence.stop.words());
    let left = format!("conditions on the angles met to {:.1e}, energy {:.4e}", convergence.residual, found.energy);
    let held = if found.barrier > 0.0 {
        format!(", with a barrier of weight {:.2} that keeps {} angles from 0", found.barrier, found.held)
    } else {
        String::new()
    };
    Some(format!("{steps}, {left}{held}"))
}
