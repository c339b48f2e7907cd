//! Automatic seams of the open mesh: their search in the background, and the edit that cuts the mesh along them.
//!
//! Seams that were found stay known for a while, so that undo and the slider return to their map without a search.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{Background, Message, MessagePlace, Model, Session, Wake};
use freebound_core::cutting::SeamOptions;
use freebound_core::mesh::{Preparation, Repair, Seams, VertexId};
use freebound_core::pipeline::{AutomaticSeams, SeamProgress};
use freebound_core::problem::{Control, SolveError, Start};

/// Name of the search in messages and on the screen.
pub(super) const SEARCHING: &str = "finding short seams";

/// Inputs of a search.
#[derive(Clone, Debug, PartialEq)]
struct Wanted {
    /// Preparation without automatic seams.
    form: Preparation,
    bound: f64,
}

/// Purpose of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// Cut of a mesh that was opened.
    Opening,
    /// Cut at the user's request.
    Edit,
    /// Seams to be shown while a slider moves.
    Preview,
}

/// Progress of a search for automatic seams.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamSearch {
    /// Bound on the mean symmetric Dirichlet energy.
    pub bound: f64,
    /// Number of parts whose search has ended.
    pub done_count: usize,
    /// Number of parts of the mesh; 0 until it is known.
    pub part_count: usize,
    /// Length of the best seams so far, relative to the root of the area.
    pub relative_length: f64,
    /// Greatest mean symmetric Dirichlet energy of a part along its best seams.
    pub energy: f64,
}

/// Search for automatic seams.
pub(super) struct Unwrapping {
    wake: Wake,
    search: Background<Wanted, Result<AutomaticSeams, SolveError>>,
    /// Newest progress of each part.
    progress: Arc<Mutex<Vec<SeamProgress>>>,
    purpose: Purpose,
    /// Bound of the slider while it moves.
    previewed: Option<f64>,
    /// Costs that were painted and are not part of the document yet.
    painted: Option<Seams>,
}

impl Unwrapping {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            wake: Arc::clone(wake),
            search: Background::new("seams", wake),
            progress: Arc::default(),
            purpose: Purpose::Edit,
            previewed: None,
            painted: None,
        }
    }

    /// Starts a search, unless one with these inputs is in progress.
    fn start(&mut self, model: Arc<Model>, wanted: Wanted, purpose: Purpose) {
        self.purpose = purpose;
        if self.search.key() == Some(&wanted) {
            return;
        }
        self.progress = Arc::default();
        let (progress, wake) = (Arc::clone(&self.progress), Arc::clone(&self.wake));
        let Wanted { form, bound, .. } = wanted.clone();
        self.search.start(wanted, move |cancel| {
            let report = |news: SeamProgress| {
                let mut parts = locked(&progress);
                match parts.iter_mut().find(|part| part.part == news.part) {
                    Some(part) => *part = news,
                    None => parts.push(news),
                }
                drop(parts);
                wake();
            };
            model.find_seams(&form, SeamOptions::new(bound), Control::new(cancel, &|_| {}), &report)
        });
    }

    /// Drops the search, the preview, and paint that is not part of the document. Returns true if there was a search.
    pub(super) fn cancel(&mut self) -> bool {
        let was_busy = self.is_busy();
        self.search.cancel();
        (self.previewed, self.painted) = (None, None);
        was_busy
    }

    /// True during a search for the first map of an opened mesh.
    pub(super) fn is_for_opening(&self) -> bool {
        self.is_busy() && self.purpose == Purpose::Opening
    }

    /// True during a search whose result is to be cut.
    pub(super) fn is_cutting(&self) -> bool {
        self.is_busy() && self.purpose != Purpose::Preview
    }

    /// True during a search.
    pub(super) fn is_busy(&self) -> bool {
        self.search.is_busy()
    }

    fn state(&self) -> Option<SeamSearch> {
        let Wanted { bound, .. } = self.search.key()?;
        let parts = locked(&self.progress);
        Some(SeamSearch {
            bound: *bound,
            done_count: parts.iter().filter(|part| part.is_final).count(),
            part_count: parts.first().map_or(0, |part| part.part_count),
            relative_length: parts.iter().map(|part| part.length / part.area.sqrt()).sum(),
            energy: parts.iter().map(|part| part.energy).fold(f64::NAN, f64::max),
        })
    }

    /// Best seams so far, by vertices of the file. `None` if there is no search.
    fn best_edges(&self) -> Option<Vec<[VertexId; 2]>> {
        self.search.key()?;
        Some(locked(&self.progress).iter().flat_map(|part| part.edges.iter().copied()).collect())
    }
}

fn locked(progress: &Mutex<Vec<SeamProgress>>) -> MutexGuard<'_, Vec<SeamProgress>> {
    progress.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Session {
    /// Repairs the mesh and cuts it along automatic seams for a bound on the distortion. Default: the bound of the
    /// seams that are cut, or [`SeamOptions::DISTORTION`]. Seams by hand are kept and completed. The cut is one edit,
    /// which follows once the seams are found.
    pub(super) fn unwrap(&mut self, bound: Option<f64>) {
        let bound = bound.unwrap_or_else(|| self.seam_bound());
        self.find_seams(bound, Purpose::Edit);
    }

    /// Sets the cost of edges, and cuts the mesh along the seams that are cheapest then. Both are one edit.
    pub(super) fn paint_seams(&mut self, edges: &[[VertexId; 2]], cost: f64) {
        self.unwrapping.painted = Some(self.with_paint().with_costs(edges.iter().map(|&edge| (edge, cost))));
        self.find_seams(self.seam_bound(), Purpose::Edit);
    }

    /// Seams of the requested preparation, with all paint.
    pub fn with_paint(&self) -> Seams {
        let seams = &self.form_to_be().seams;
        self.unwrapping.painted.as_ref().map_or_else(|| seams.clone(), |painted| seams.with_costs_of(painted))
    }

    /// Finds the seams for a bound and shows them, but does not cut the mesh. `None` ends the preview. A search whose
    /// result is to be cut goes on instead.
    pub(super) fn preview_seams(&mut self, bound: Option<f64>) {
        let is_cutting = self.unwrapping.is_cutting();
        self.unwrapping.previewed = bound.filter(|_| !is_cutting);
        match self.unwrapping.previewed {
            Some(bound) => self.find_seams(bound, Purpose::Preview),
            None if !is_cutting => self.unwrapping.search.cancel(),
            None => {}
        }
    }

    /// Unwraps a mesh that was opened, unless it is a single disk. Returns true if a search or an edit follows.
    pub(super) fn unwrap_opened(&mut self) -> bool {
        let Some(model) = self.model().filter(|_| self.can_unwrap()) else { return false };
        let Some(repaired) = model.prepared.remedy.clone().or_else(|| model.prepared.repaired.clone()) else {
            return false;
        };
        let cuts_or_fills = |repair: Repair| matches!(repair, Repair::Cut | Repair::FillHoles);
        if repaired.done().iter().any(|done| cuts_or_fills(done.repair)) || model.prepared.chart_count() > 1 {
            self.find_seams(SeamOptions::DISTORTION, Purpose::Opening);
        } else if model.prepared.remedy.is_some() {
            self.cut_opened(self.form_to_be().with_all_repairs());
            let done: Vec<String> = repaired.done().iter().map(ToString::to_string).collect();
            self.note(format!("repaired: {}; undo restores the mesh as it was", done.join(", ")));
        } else {
            return false;
        }
        true
    }

    /// Finds automatic seams in addition to those of the requested preparation. Costs and paint count.
    fn find_seams(&mut self, bound: f64, purpose: Purpose) {
        let Some(model) = self.model().cloned() else { return };
        if !self.can_unwrap() {
            return self.complain("the mesh cannot be unwrapped", Some("repair the faults that the Defects tab lists"));
        }
        if purpose != Purpose::Preview {
            self.unwrapping.previewed = None;
        }
        let form = self.form_to_search(&model);
        let wanted = Wanted { form, bound: bound.max(SeamOptions::LEAST) };
        match model.known_seams(&wanted.form, wanted.bound) {
            Some(known) => {
                self.unwrapping.search.cancel();
                if purpose != Purpose::Preview {
                    self.unwrapping.painted = None;
                    self.want_form(known.form.clone());
                }
            }
            None => self.unwrapping.start(model, wanted, purpose),
        }
    }

    /// Requested preparation without automatic seams, in which the mesh may be cut. If the map is the layout of the
    /// file, its seams are left out, too.
    fn without_automatic_seams(&self, model: &Model) -> Preparation {
        let wanted = self.form_to_be();
        let repaired = if model.is_faulty() { wanted.with_all_repairs() } else { wanted.clone() };
        Preparation { seams: self.without_layout(wanted.seams.without_automatic()), cut: true, ..repaired }
    }

    /// Preparation whose automatic seams are found, with all paint.
    fn form_to_search(&self, model: &Model) -> Preparation {
        let seams = self.without_layout(self.with_paint().without_automatic());
        Preparation { seams, ..self.without_automatic_seams(model) }
    }

    /// Seams without those of the file's layout, if the map is that layout.
    fn without_layout(&self, mut seams: Seams) -> Seams {
        seams.of_texture &= self.document.settings.start != Start::File;
        seams
    }

    /// Cuts the mesh along seams that were found, if it still is the mesh of the search. Call once per frame.
    pub(super) fn poll_unwrapping(&mut self) {
        let form = self.model().map(|model| self.without_automatic_seams(model));
        let without_costs = |form: &Preparation| Preparation { seams: form.seams.without_costs(), ..form.clone() };
        let is_for = |wanted: &Wanted| form.as_ref().map(without_costs) == Some(without_costs(&wanted.form));
        if self.unwrapping.search.key().is_some_and(|wanted| !is_for(wanted)) {
            // The user has changed the preparation meanwhile.
            self.unwrapping.search.cancel();
        }
        if self.history.is_in_gesture() {
            return;
        }
        let Some((_, found)) = self.unwrapping.search.poll() else { return };
        match found {
            Ok(Ok(seams)) => self.take_automatic_seams(seams),
            Ok(Err(_)) => self.go_on_without_seams(),
            Err(failure) => {
                self.messages.fail_background(MessagePlace::Mesh, SEARCHING, &failure);
                self.go_on_without_seams();
            }
        }
    }

    fn take_automatic_seams(&mut self, seams: AutomaticSeams) {
        let Some(model) = self.model() else { return };
        let (form, words) = (seams.form.clone(), words_of(&seams));
        self.mesh.learn(Arc::new(model.knowing(Arc::new(seams))));
        match self.unwrapping.purpose {
            Purpose::Preview => {}
            Purpose::Opening => self.cut_opened(form),
            Purpose::Edit => {
                self.unwrapping.painted = None;
                self.want_form(form);
                self.note(words);
            }
        }
    }

    fn note(&mut self, words: String) {
        self.messages.forget_notes();
        self.messages.say(Message::note(MessagePlace::Embedding, words));
    }

    /// Sets the preparation of a mesh that was just opened. It is no unsaved work.
    fn cut_opened(&mut self, form: Preparation) {
        self.keeping_saved(|session| session.want_form(form));
    }

    /// Cancels the search for seams. Reports the faults that it was to repair, or solves the mesh as it is.
    pub(super) fn stop_unwrapping(&mut self) {
        if self.unwrapping.cancel() {
            self.go_on_without_seams();
        }
    }

    /// Reports the faults of the mesh. A mesh that was opened without faults is solved as it is.
    pub(super) fn go_on_without_seams(&mut self) {
        self.tell_faults();
        if self.outcome().is_none() && !self.is_running() {
            self.solve();
        }
    }

    /// True if the open mesh can be unwrapped: it is a surface, or repairs make it one.
    pub fn can_unwrap(&self) -> bool {
        self.model().is_some_and(|model| !model.is_faulty() || model.prepared.remedy.is_some())
    }

    /// Progress of the search for automatic seams. `None` if there is none.
    pub fn seam_search(&self) -> Option<SeamSearch> {
        self.unwrapping.state()
    }

    /// Bound for which automatic seams are being found, are cut, or would be found next.
    pub fn seam_bound(&self) -> f64 {
        if let Some(wanted) = self.unwrapping.search.key().filter(|_| self.unwrapping.purpose == Purpose::Edit) {
            return wanted.bound;
        }
        self.form_to_be().seams.bound().unwrap_or(SeamOptions::DISTORTION)
    }

    /// Seams of a search, or of the bound of a moving slider, that the mesh is not cut along yet. By vertices of the
    /// file.
    pub fn seams_to_be(&self) -> Option<Vec<[VertexId; 2]>> {
        if let Some(edges) = self.unwrapping.best_edges() {
            return Some(edges);
        }
        let (model, bound) = (self.model()?, self.unwrapping.previewed?);
        let form = self.form_to_search(model);
        let known = model.known_seams(&form, bound.max(SeamOptions::LEAST))?;
        Some(known.edges().iter().copied().collect())
    }

    /// Automatic seams that the mesh is cut along.
    pub fn automatic_seams(&self) -> Option<&AutomaticSeams> {
        self.model()?.automatic_seams()
    }
}

/// Note on seams that were found.
fn words_of(seams: &AutomaticSeams) -> String {
    format!(
        "unwrapped: {} seam edges, {:.2} times the root of the area; undo restores the mesh as it was",
        seams.edges().len(),
        seams.relative_length()
    )
}
