//! Handling of requests to the seam tool: clicks, rules, and the click under the pointer.

use std::sync::Arc;

use super::Editor;
use super::seam_intent::SeamIntent;
use super::seam_rules::edges_of;
use crate::session::Action;
use crate::ui::controls::{counted, sentence};
use crate::ui::state::{SeamClick, SeamRule, Tool};
use freebound_core::mesh::{Seams, VertexId};

/// Clicks of the seam tool.
impl Editor {
    /// Seams after all listed edges are removed. Seams along texture coordinates stay.
    pub(in crate::ui) fn without_seams(&self) -> Seams {
        let seams = self.session.seams();
        seams.without(seams.edges().iter().copied())
    }

    pub(super) fn take_seam_click(&mut self, click: SeamClick) {
        self.tools.seam.rules.forget_said();
        self.tools.seam.clicks.push_back(click);
        self.go_on_with_seam();
    }

    /// Starts searches for missing paths, and carries out the clicks that waited for them. Call once per frame.
    pub(super) fn go_on_with_seam(&mut self) {
        if self.tools.tool() != Tool::Seam {
            return;
        }
        self.tools.seam.chain.follow_undo(self.session.seams());
        self.tools.seam.refresh(&self.session);
        while let Some(click) = self.tools.seam.clicks.pop_front() {
            match self.tools.seam.intent(click, self.session.seams()) {
                SeamIntent::Wait => return self.tools.seam.clicks.push_front(click),
                SeamIntent::Begin => self.tools.seam.chain.begin(click.vertex, self.session.seams()),
                SeamIntent::Add(edges) => self.cut_along(self.session.seams().with(edges), click.vertex),
                SeamIntent::TakeAway(edges) => self.cut_along(self.session.seams().without(edges), click.vertex),
                SeamIntent::End => drop(self.tools.seam.end()),
                SeamIntent::Nothing => {}
            }
            self.tools.seam.refresh(&self.session);
        }
    }

    /// Sets other seams, and extends the chain to a vertex, if there is a chain.
    fn cut_along(&mut self, seams: Seams, to: VertexId) {
        self.tools.seam.chain.go_on(to, self.session.seams(), &seams);
        self.session.handle(Action::SetSeams(seams));
    }
}

/// Seams by a rule.
impl Editor {
    /// Starts the search for the edges of a rule, and activates the seam tool, which reports the result.
    pub(super) fn cut_by_rule(&mut self, rule: SeamRule) {
        let Some(model) = self.session.model().map(Arc::clone) else { return };
        self.tools.take_up(Tool::Seam);
        let key = (rule, self.session.opening_revision());
        self.tools.seam.rules.job.make(key, move |_| edges_of(rule, &model));
    }

    /// Adds the edges of a rule to the seams once they are found. Waits for the end of a gesture, because the cut
    /// would become part of it. Call once per frame.
    pub(super) fn take_seams_by_rule(&mut self) {
        self.tools.seam.rules.forget_said_of_other(self.session.seams());
        if self.session.is_in_gesture() {
            return;
        }
        let opening = self.session.opening_revision();
        let Some((_, found)) = self.tools.seam.rules.job.poll().filter(|((_, of), _)| *of == opening) else { return };
        let words = match found {
            Err(error) => sentence(&error.to_string()),
            Ok(edges) => {
                let before = self.session.seams();
                let seams = before.with(edges);
                let count = seams.edges().len() - before.edges().len();
                if count > 0 {
                    self.session.handle(Action::SetSeams(seams));
                }
                format!("{} more", counted(count, "edge", "edges"))
            }
        };
        let said = Some((words, self.session.seams().clone()));
        self.tools.seam.rules.said = said.filter(|_| self.tools.tool() == Tool::Seam);
    }
}

/// Click under the pointer.
impl Editor {
    /// Click that a press of the button would make, if the pointer is over a vertex.
    pub(in crate::ui) fn seam_click(&self, has_shift: bool) -> Option<SeamClick> {
        let seam = &self.tools.seam;
        seam.under().map(|vertex| SeamClick { vertex, erases: seam.erases() != has_shift })
    }

    /// Computes the effect of the click under the pointer, unless it is known. Call after the vertex under the
    /// pointer is set.
    pub(in crate::ui) fn foresee_seam(&mut self) {
        let has_shift = self.gpu.context().input(|input| input.modifiers.shift);
        let click = self.seam_click(has_shift).filter(|_| self.tools.tool() == Tool::Seam);
        self.tools.seam.foresee(click, self.session.seams());
    }
}
