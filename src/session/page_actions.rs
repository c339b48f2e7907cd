//! Actions on the page: charts are moved, packed, stacked and locked.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DAffine2;

use super::chart_layout::{ChartLayout, ChartPlace};
use super::page::{ChartMove, ChartPage, JudgedMove, MoveState, PageChart};
use super::{Command, LockState, Message, MessagePlace, Session};
use freebound_core::geom::{PackingOptions, Stacking};
use freebound_core::mesh::{Charts, FaceId};
use freebound_core::pipeline::Targets;
use freebound_core::problem::Embedding;
use freebound_core::verify::MoveVerdict;
use freebound_io::PictureFile;

/// Change of scale up to which a movement counts as one without a change of size.
const SAME_SIZE: f64 = 1e-9;

impl Session {
    /// All charts as they lie on the page, once each is solved and laid out. The last page stays while a layout is
    /// being computed.
    pub fn page(&self) -> Option<&ChartPage> {
        let charts = self.charts()?;
        self.page.page().filter(|page| Arc::ptr_eq(&page.of, charts))
    }

    /// Move of charts in progress.
    pub fn move_state(&self) -> Option<&MoveState> {
        self.page.state()
    }

    /// True while the background judges a frame of a move.
    pub fn is_judging_move(&self) -> bool {
        self.page.is_busy()
    }

    /// True if a move of charts has ended, and its newest frame is not judged yet.
    pub fn is_ending_move(&self) -> bool {
        self.page.is_ending()
    }

    /// True from the first frame of a move of charts to its end.
    pub fn is_moving_charts(&self) -> bool {
        self.page.state().is_some()
    }

    /// True if the page shows the charts of the current document, so that they can be moved.
    pub fn can_move_charts(&self) -> bool {
        self.page().is_some() && self.atlas_key().is_some_and(|key| self.page.shows(&key))
    }

    /// True if charts stay where they lie until they are packed.
    pub fn has_placed_charts(&self) -> bool {
        let places = |charts: &Arc<Charts>| {
            (0..charts.count())
                .any(|chart| self.is_movable(chart) && self.document.layout.place_of(charts, chart).is_some())
        };
        self.charts().is_some_and(places)
    }

    /// True if a chart can be moved: neither a lock nor pins hold it.
    pub fn is_movable(&self, chart: usize) -> bool {
        let Some(of) = self.model().and_then(|model| model.prepared.chart.as_ref()) else { return false };
        chart < of.charts.count()
            && self.document.layout.lock_of(&of.charts, chart).is_none()
            && self.targets_of_chart(chart).is_none_or(Targets::is_empty)
    }

    /// Charts of the newest layout that overlap others or are not planar.
    pub fn overlapping_charts(&self) -> Vec<usize> {
        let (Some(charts), Some(atlas)) = (self.charts(), self.newest_atlas()) else { return Vec::new() };
        let faces = atlas.verdict.overlapping_faces.iter().flatten();
        let flat = atlas.verdict.charts.iter().enumerate().filter(|(_, chart)| !chart.planar).map(|(chart, _)| chart);
        let all: BTreeSet<usize> = faces.filter_map(|&face| charts.chart_of_file_face(face)).chain(flat).collect();
        all.into_iter().collect()
    }

    /// Moves charts in the page's plane, as a frame of a gesture. Stacked charts move together. Charts that cannot be
    /// moved stay.
    pub(super) fn move_charts(&mut self, moves: &[ChartMove], insists: bool) {
        if !self.can_move_charts() || self.page.is_ending() {
            return;
        }
        let moves = self.moves_of_stacks(moves);
        if !moves.is_empty() {
            self.page.follow(moves, insists);
        }
    }

    /// Movements of whole stacks. The first movement of a stack counts.
    fn moves_of_stacks(&self, moves: &[ChartMove]) -> Vec<ChartMove> {
        let Some(page) = self.page() else { return Vec::new() };
        let mut places = BTreeSet::new();
        let mut all: Vec<ChartMove> = Vec::new();
        for &(chart, by) in moves.iter().filter(|(chart, by)| *chart < page.charts.len() && by.is_finite()) {
            if places.insert(page.place_of(chart)) {
                let stack = page.with_stacks(&BTreeSet::from([chart]));
                if stack.iter().all(|&chart| self.is_movable(chart)) {
                    all.extend(stack.into_iter().map(|chart| (chart, by)));
                }
            }
        }
        all.sort_unstable_by_key(|(chart, _)| *chart);
        all
    }

    /// Ends a move of charts: it becomes an edit.
    pub(super) fn end_move(&mut self) {
        self.page.end();
        self.poll_page();
    }

    /// Drops a move of charts.
    pub(super) fn give_up_move(&mut self) {
        self.page.give_up();
    }

    /// Follows moves of charts, and the layout of the document. Call once per frame.
    pub(super) fn poll_page(&mut self) {
        if self.charts().is_none() {
            return self.page.forget();
        }
        if self.is_moving_charts() && !self.can_move_charts() {
            // The document has changed, so the frames of the move are of other charts or places.
            self.page.give_up();
        }
        if let Some(MoveState { accepted, kept_back, .. }) = self.page.poll() {
            if let Some(judged) = accepted {
                self.take_move(&judged);
            }
            if let Some(kept_back) = kept_back {
                self.tell_kept_back(&kept_back.verdict);
            }
        }
        let Some(key) = self.atlas_key().filter(|_| !self.page.is_busy()) else { return };
        let Some(view) = self.atlas_views.find(&key).map(Arc::clone) else { return };
        if let Some(charts) = self.charts().filter(|_| self.page.needs(&key)) {
            let (charts, models) = (Arc::clone(charts), self.solved_models());
            self.page.put(key, charts, models, &view);
        }
    }

    /// Sets or removes the picture, as an edit. Charts that are placed are packed again if the page gets another shape.
    pub(super) fn set_picture(&mut self, picture: Option<Arc<PictureFile>>) {
        let sides = |picture: &Option<Arc<PictureFile>>| {
            let sides = picture.as_ref().map(|picture| [picture.pixels.width, picture.pixels.height]);
            sides.unwrap_or(self.document.layout.packing.picture).map(u64::from)
        };
        let ([w, h], [w_before, h_before]) = (sides(&picture), sides(&self.document.picture));
        let mut edits = vec![Command::SetPicture(picture)];
        if self.document.shaped.is_some() || self.document.elsewhere.values().any(|edits| edits.shaped.is_some()) {
            // A map that the user shaped has a place of its own, not the new picture's.
            edits.extend(self.drop_relaxing());
        }
        if w * h_before != w_before * h && !self.document.layout.placed.is_empty() {
            let layout = ChartLayout { placed: BTreeMap::new(), ..self.document.layout.clone() };
            edits.push(Command::SetLayout(Box::new(layout)));
        }
        self.edit(edits);
    }

    /// Applies a move of charts as one edit. All other charts are placed where they lie.
    fn take_move(&mut self, judged: &JudgedMove) {
        let Some(mut layout) = self.layout_as_it_lies() else { return };
        let (Some(charts), Some(page)) = (self.charts().map(Arc::clone), self.page()) else { return };
        for ((chart, coordinates), (_, by)) in judged.coordinates.iter().zip(&judged.moves) {
            if page.charts[*chart].stacked.is_some() {
                continue;
            }
            let first_face = charts.first_face(*chart);
            let place = given_place(&page.charts[*chart], coordinates);
            layout.placed.insert(first_face, ChartPlace(place));
            let scale = scale_of(*by);
            if (scale - 1.0).abs() > SAME_SIZE {
                layout.set_size(first_face, layout.size_of(&charts, *chart) * scale);
            }
        }
        self.apply(Command::SetLayout(Box::new(layout)));
        if let Some(key) = self.atlas_key() {
            self.page.put_moved(key, judged);
        }
    }

    /// Layout of the document with all charts placed where they lie on the page.
    pub(super) fn layout_as_it_lies(&self) -> Option<ChartLayout> {
        let (charts, page) = (self.charts()?, self.page().filter(|_| self.can_move_charts())?);
        let mut layout = self.document.layout.clone();
        for (number, chart) in page.charts.iter().enumerate() {
            let first_face = charts.first_face(number);
            if let Some(on) = chart.stacked {
                layout.stacked.insert(first_face, charts.first_face(on.chart));
            }
            let has_own_place = chart.stacked.is_none() && self.is_movable(number);
            if has_own_place && layout.place_of(charts, number).is_none() {
                layout.placed.insert(first_face, ChartPlace(given_place(chart, &chart.coordinates)));
            }
        }
        Some(layout)
    }

    /// Tells why charts are kept back.
    pub(super) fn tell_kept_back(&mut self, verdict: &MoveVerdict) {
        let words = match verdict.overlapping.first() {
            Some([a, b]) => format!("charts {a} and {b} would overlap there, so they stay"),
            None => "rounding would fold a chart there, so it stays".to_owned(),
        };
        self.messages.forget_notes();
        let note = Message::caution(MessagePlace::Embedding, words);
        self.messages.say(note.with_remedy("hold Alt at the end to let charts overlap"));
    }

    /// Packs charts that are placed, as an edit: these charts, or all of them. Locked charts stay.
    pub(super) fn pack_charts(&mut self, charts: Option<&BTreeSet<usize>>) {
        let Some(all) = self.charts().map(Arc::clone) else { return };
        let layout = match charts {
            // The others stay where they lie.
            Some(_) => self.layout_as_it_lies(),
            None => Some(self.document.layout.clone()),
        };
        let Some(mut layout) = layout else { return };
        let chosen = charts.map(|charts| self.page().map_or_else(|| charts.clone(), |page| page.with_stacks(charts)));
        let is_packed = |chart: usize| chosen.as_ref().is_none_or(|chosen| chosen.contains(&chart));
        for chart in (0..all.count()).filter(|&chart| is_packed(chart)) {
            layout.placed.remove(&all.first_face(chart));
        }
        self.apply(Command::SetLayout(Box::new(layout)));
    }

    /// Lays charts on the first of them, as an edit. All surfaces have to be congruent to the first, or its mirror
    /// images; the others are named and stay.
    pub(super) fn stack_charts(&mut self, charts: &BTreeSet<usize>) {
        let Some(mut layout) = self.layout_as_it_lies().filter(|_| self.can_move_charts()) else { return };
        let (Some(all), Some(page)) = (self.charts().map(Arc::clone), self.page()) else { return };
        let Some(&first) = charts.first() else { return };
        let on = page.place_of(first);
        let (mut others, mut is_changed): (Vec<usize>, bool) = (Vec::new(), false);
        for &chart in charts.iter().filter(|&&chart| page.place_of(chart) != on) {
            let is_congruent = || page.charts[chart].solved().is_congruent_to(&page.charts[on].solved());
            let members = page.with_stacks(&BTreeSet::from([chart]));
            let fits = members.iter().all(|&member| self.is_movable(member)) && is_congruent();
            if !fits {
                others.push(chart);
                continue;
            }
            is_changed = true;
            // Charts that lie on this one move with it.
            for member in members {
                layout.stacked.insert(all.first_face(member), all.first_face(on));
                layout.placed.remove(&all.first_face(member));
            }
        }
        if is_changed {
            self.apply(Command::SetLayout(Box::new(layout)));
        }
        if !others.is_empty() {
            let numbers: Vec<String> = others.iter().map(ToString::to_string).collect();
            let text = format!("not stacked on chart {on}: {}", numbers.join(", "));
            self.complain(
                text,
                Some("stack charts whose surfaces are congruent or mirror images, without pins or locks"),
            );
        }
    }

    /// Gives stacked charts places of their own, as an edit. They are packed around the other charts.
    pub(super) fn unstack_charts(&mut self, charts: &BTreeSet<usize>) {
        let Some(mut layout) = self.layout_as_it_lies() else { return };
        let (Some(all), Some(page)) = (self.charts().map(Arc::clone), self.page()) else { return };
        let stacked = page.with_stacks(charts).into_iter().filter(|&chart| page.charts[chart].stacked.is_some());
        let first_faces: Vec<FaceId> = stacked.map(|chart| all.first_face(chart)).collect();
        if first_faces.is_empty() {
            return;
        }
        for first_face in &first_faces {
            layout.stacked.remove(first_face);
            layout.placed.remove(first_face);
        }
        // Stacking by shape would lay them on each other again.
        layout.packing = PackingOptions { stack: Stacking::None, ..layout.packing };
        self.apply(Command::SetLayout(Box::new(layout)));
    }

    /// Locks charts where they lie, or unlocks them, as an edit. Charts that cannot be locked, see
    /// [`lock_state`](Self::lock_state), stay unlocked. All other charts stay where they lie until they are packed.
    pub(super) fn lock_charts(&mut self, charts: &BTreeSet<usize>, lock: bool) {
        let Some(all) = self.charts().map(Arc::clone) else { return };
        let is_changed = |&chart: &usize| match self.lock_state(chart) {
            LockState::Open => lock,
            LockState::Locked => !lock,
            LockState::Pinned | LockState::Stacked | LockState::NoPlace => false,
        };
        let Some(mut layout) = self.layout_as_it_lies().filter(|_| charts.iter().any(is_changed)) else { return };
        for &chart in charts.iter().filter(|&&chart| chart < all.count()) {
            let first_face = all.first_face(chart);
            match (self.lock_state(chart), lock) {
                (LockState::Open, true) => {
                    let Some(on_page) = self.page().map(|page| &page.charts[chart]) else { continue };
                    let place = given_place(on_page, &on_page.coordinates);
                    layout.placed.remove(&first_face);
                    layout.locked.insert(first_face, ChartPlace(place));
                }
                (LockState::Locked, false) => {
                    if let Some(place) = layout.locked.remove(&first_face) {
                        layout.placed.insert(first_face, place);
                    }
                }
                _ => {}
            }
        }
        self.apply(Command::SetLayout(Box::new(layout)));
    }
}

/// Coordinates of a chart without those of new vertices.
pub(super) fn given_place(chart: &PageChart, coordinates: &Arc<Embedding>) -> Arc<Embedding> {
    match chart.given_count() {
        count if count == coordinates.len() => Arc::clone(coordinates),
        count => Arc::new(coordinates.iter().take(count).copied().collect()),
    }
}

/// Factor by which a movement changes lengths.
fn scale_of(by: DAffine2) -> f64 {
    by.matrix2.determinant().abs().sqrt()
}
