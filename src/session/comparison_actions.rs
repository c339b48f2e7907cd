//! Actions and queries of the session for compared methods and the morph between two of them.

use std::sync::Arc;

use super::morphing::{Ends, refused};
use super::{Compared, Contender, ContenderState, MorphState, Session, morph_end};
use freebound_core::problem::Variant;

impl Session {
    /// Methods that are compared, in the order in which they were chosen. Empty without a comparison.
    pub fn contenders(&self) -> &[Contender] {
        self.comparing.contenders()
    }

    /// Number of changes of the comparison. Cached views compare it.
    pub fn comparison_revision(&self) -> u64 {
        self.comparing.revision()
    }

    /// State of a method relative to the document.
    pub fn contender_state(&self, contender: &Contender) -> ContenderState {
        let is_there = self.disk().is_some() && self.has_form_as_wanted();
        self.comparing.state_of(contender, is_there && !self.history.is_in_gesture())
    }

    /// True if a method is still to be run and the mesh is a disk.
    pub fn is_comparing(&self) -> bool {
        self.disk().is_some() && self.comparing.is_open()
    }

    /// Sets the methods to compare. An empty list ends the comparison.
    pub(super) fn compare_methods(&mut self, variants: &[Variant]) {
        self.comparing.choose(variants);
        self.poll_comparing();
    }

    /// Stores the results of methods and starts the next method. Methods run only while nothing else is solved, so that
    /// their times can be compared.
    pub(super) fn poll_comparing(&mut self) {
        if self.comparing.contenders().is_empty() {
            return;
        }
        self.comparing.follow_mesh(self.model_revision());
        self.comparing.poll();
        // During a gesture the document changes every frame.
        if self.history.is_in_gesture() || !self.has_form_as_wanted() {
            return;
        }
        let problem = self.document.problem();
        self.comparing.restart_outdated(&problem);
        let model = self.model().filter(|model| model.disk().is_some()).cloned();
        let is_free = !self.is_running() && self.busy().is_none() && !self.morphing.is_running();
        if let Some(model) = model.filter(|_| is_free) {
            self.comparing.begin_next(&model, &problem);
        }
    }
}

/// Morph between two methods.
impl Session {
    /// State of the requested morph.
    pub fn morph(&self) -> MorphState {
        self.morphing.state()
    }

    /// Methods at the ends of the requested morph.
    pub fn morph_between(&self) -> Option<[Variant; 2]> {
        self.morphing.between()
    }

    /// True if the requested morph is still to be found and both methods have a result.
    pub fn is_morphing(&self) -> bool {
        let is_open = matches!(self.morph(), MorphState::Waiting | MorphState::Running(..));
        is_open && self.ends_of_morph().is_some()
    }

    /// Methods with a map that a morph can begin or end with, in their order.
    pub fn morph_ends(&self) -> Vec<(Variant, Arc<Compared>)> {
        let of = |contender: &Contender| {
            let found = contender.found().filter(|_| self.contender_state(contender) == ContenderState::Done)?;
            morph_end(found).is_ok().then(|| (contender.variant(), Arc::clone(found)))
        };
        self.contenders().iter().filter_map(of).collect()
    }

    /// Requests the morph between two methods, or ends it.
    pub(super) fn want_morph(&mut self, between: Option<[Variant; 2]>) {
        self.morphing.want(between);
        self.poll_morph();
    }

    /// Results of both methods, once they have run.
    fn ends_of_morph(&self) -> Option<Ends> {
        let [first, second] = self.morphing.between()?;
        let found = |variant: Variant| {
            let contender = self.contenders().iter().find(|contender| contender.variant() == variant)?;
            contender.found().filter(|_| self.contender_state(contender) == ContenderState::Done).cloned()
        };
        Some([found(first)?, found(second)?])
    }

    /// Stores a morph that was found and drops one between other maps. Begins the requested morph once both results
    /// exist and nothing else is running.
    pub(super) fn poll_morph(&mut self) {
        let now = self.ends_of_morph();
        self.morphing.keep_of(now.as_ref());
        self.morphing.poll();
        let Some(ends) = now.filter(|_| self.morphing.is_open()) else { return };
        let Some(model) = self.model().cloned() else { return };
        if let Some(refused) = refused(&model, &ends, self.files.memory()) {
            self.morphing.refuse(refused, ends);
            return;
        }
        if !self.is_comparing() && !self.is_running() && self.busy().is_none() {
            self.morphing.begin(model, ends);
        }
    }
}
