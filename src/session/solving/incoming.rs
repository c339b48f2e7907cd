//! What the background has finished: steps, and runs that have come to rest.

use std::sync::Arc;

use super::Solving;
use super::running::{Delivery, News, Next, Resting, Running, StopReason};
use crate::session::stop::Goal;
use crate::session::{Message, MessagePlace, Messages};
use freebound_core::flatten::{Ending, Flattener};
use freebound_core::problem::SolveError;

impl Solving {
    /// Takes in what the background has finished.
    pub(in crate::session) fn poll(&mut self, messages: &mut Messages) -> News {
        let mut news = News::default();
        let Some(running) = &mut self.running else { return news };
        // Looked at before the deliveries: those of a job that has ended are then all there.
        let end = running.job.poll();
        let deliveries: Vec<Delivery> = running.deliveries.try_iter().collect();
        let has_news = !deliveries.is_empty();
        running.has_delivered |= has_news;
        for delivery in deliveries {
            news.has_begun |= self.take_step(delivery, messages);
        }
        if has_news && self.is_outdated {
            self.give_up();
            news.next = Some(Next::Anew);
            return news;
        }
        match end {
            None => {}
            Some(((), Err(failure))) => {
                self.failed = self.running.take().map(|running| running.problem);
                messages.fail_background(MessagePlace::Embedding, "solving", &failure);
            }
            Some(((), Ok((run, result)))) => {
                let went_on_by_itself = self.running.as_ref().is_some_and(Running::goes_on_by_itself);
                let rest =
                    if result.is_ok() && went_on_by_itself { StopReason::ByItself } else { StopReason::Elsewhere };
                news.next = self.take_back(run, result, messages);
                if news.next.is_none() {
                    news.rest = Some(rest);
                    news.rounds_cut = self.cut_rounds();
                }
            }
        }
        news
    }

    /// Takes in a step. The first one begins a timeline: returns whether it is that.
    fn take_step(&mut self, Delivery { outcome, ending }: Delivery, messages: &mut Messages) -> bool {
        self.forget_message(messages);
        let is_first = outcome.step.index == 0;
        if is_first {
            // What was written no longer shows what is on the screen.
            messages.forget_notes();
            self.kept.prepared.clone_from(&outcome.step.candidate.prepared);
            self.timeline = self.timeline.begun_anew();
        }
        if let Some(start) = &outcome.step.candidate.planar_start {
            self.kept.planar_start = Some(Arc::clone(start));
        }
        self.ending = ending;
        if self.timeline.push(outcome) {
            self.outcome_revision += 1;
        }
        is_first
    }

    /// Takes back a run that has come to rest. Returns how solving goes on, where the goal has changed meanwhile.
    fn take_back(&mut self, run: Flattener, result: Result<(), SolveError>, messages: &mut Messages) -> Option<Next> {
        let Running { problem, paused, shared, .. } = self.running.take()?;
        let has_new_vertices = problem.settings.new_vertices;
        self.failed = result.as_ref().err().filter(|error| **error != SolveError::Cancelled).map(|_| problem.clone());
        self.resting = Some(Resting { problem, run });
        let goal = match result {
            Ok(()) | Err(SolveError::Cancelled) if paused.is_some() => paused.filter(|goal| *goal != Goal::Steps(0)),
            Ok(()) => Some(shared.goal()).filter(|goal| {
                let ending = self.ending;
                self.newest().is_some_and(|newest| !goal.is_reached(newest, ending))
            }),
            Err(SolveError::Cancelled) => None,
            Err(error) => {
                self.tell(&error, has_new_vertices, messages);
                None
            }
        };
        if std::mem::take(&mut self.is_outdated) { Some(Next::Anew) } else { goal.map(Next::On) }
    }

    /// Says what went wrong; where constraints cannot be met, which.
    pub(super) fn tell(&mut self, error: &SolveError, has_new_vertices: bool, messages: &mut Messages) {
        self.forget_message(messages);
        let mut message = Message::error(MessagePlace::Embedding, error.to_string()).with_vertices(error.vertices());
        if matches!(error, SolveError::StagesExhausted { .. }) {
            self.ending = Some(Ending::Done);
        }
        if *error == SolveError::Unmet {
            self.ending = Some(Ending::Unmet);
            let remedy = if has_new_vertices { "move these pins" } else { "allow new vertices, or move these pins" };
            let unmet = self.newest().map(|newest| newest.step.unmet()).unwrap_or_default();
            message = message.with_remedy(remedy).with_vertices(unmet);
        }
        self.message = Some(messages.say(message));
    }

    /// Takes away what a solve before said.
    pub(in crate::session) fn forget_message(&mut self, messages: &mut Messages) {
        if let Some(stale) = self.message.take() {
            messages.dismiss(stale);
        }
    }
}
