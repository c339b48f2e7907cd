//! Results of the background: steps, and runs that have stopped.

use std::sync::Arc;

use super::Solving;
use super::running::{Delivery, News, Next, Resting, Running, StopReason};
use crate::session::numbers::error_in_file;
use crate::session::stop::Goal;
use crate::session::{Message, MessagePlace, Messages, Model};
use freebound_core::flatten::{Ending, Flattener};
use freebound_core::mesh::VertexId;
use freebound_core::problem::SolveError;

impl Solving {
    /// Processes the results of the background.
    pub(in crate::session) fn poll(&mut self, messages: &mut Messages) -> News {
        let mut news = News::default();
        let Some(running) = &mut self.running else { return news };
        // Poll the job before the deliveries: if the job has ended, all its deliveries are there.
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

    /// Adds a step to the timeline. The first step starts a new timeline. Returns true for the first step.
    fn take_step(&mut self, Delivery { outcome, ending }: Delivery, messages: &mut Messages) -> bool {
        self.forget_message(messages);
        let is_first = outcome.step.index == 0;
        if is_first {
            // Reports of written files no longer match the screen.
            messages.forget_written();
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

    /// Stores a run that has stopped. Returns the continuation, if the goal changed meanwhile.
    fn take_back(&mut self, run: Flattener, result: Result<(), SolveError>, messages: &mut Messages) -> Option<Next> {
        let Running { model, problem, paused, shared, .. } = self.running.take()?;
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
                self.tell(&error, &model, has_new_vertices, messages);
                None
            }
        };
        if std::mem::take(&mut self.is_outdated) { Some(Next::Anew) } else { goal.map(Next::On) }
    }

    /// Reports an error of a solve of `model`. If constraints cannot be met, their vertices are highlighted.
    pub(super) fn tell(&mut self, error: &SolveError, model: &Model, has_new_vertices: bool, messages: &mut Messages) {
        self.forget_message(messages);
        let in_file = error_in_file(model, error);
        let mut message =
            Message::error(MessagePlace::Embedding, in_file.to_string()).with_vertices(in_file.vertices());
        if matches!(error, SolveError::StagesExhausted { .. }) {
            self.ending = Some(Ending::Done);
        }
        if *error == SolveError::Unmet {
            self.ending = Some(Ending::Unmet);
            let remedy = if has_new_vertices { "move these pins" } else { "allow new vertices, or move these pins" };
            let unmet = self.newest().map(|newest| newest.step.unmet()).unwrap_or_default();
            let numbers: Vec<VertexId> = unmet.into_iter().map(|vertex| model.vertex_in_file(vertex)).collect();
            message = message.with_remedy(remedy).with_vertices(numbers);
        }
        self.message = Some(messages.say(message));
    }

    /// Dismisses the message of the last solve.
    pub(in crate::session) fn forget_message(&mut self, messages: &mut Messages) {
        if let Some(stale) = self.message.take() {
            messages.dismiss(stale);
        }
    }
}
