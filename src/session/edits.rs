//! Edits of the document: pins and their targets, method and weights. Each edit is undoable and starts a solve.

use std::sync::Arc;

use glam::DVec2;

use super::background_jobs::{BackgroundJob, Flat};
use super::numbers::error_in_file;
use super::v_axis::TurnedV;
use super::{ChartEdits, Command, Document, Message, MessagePlace, Session};
use freebound_core::flatten::Flattener;
use freebound_core::geom::{Bounds, PictureFrame, Similarity, VAxis};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Target, Targets};
use freebound_core::problem::{Control, Family, GaugeSize, Method, PinKind, Pins, Settings};
use freebound_io::{PinName, PinNote};

/// Edits of the document.
impl Session {
    /// Applies edits as one undoable edit and solves.
    pub(super) fn edit(&mut self, mut commands: Vec<Command>) {
        let command = match commands.len() {
            0 => return,
            1 => commands.remove(0),
            _ => Command::Together(commands),
        };
        if self.apply(command) {
            self.solve();
        }
    }

    /// Applies an edit as a separate undo step. Returns true if the document changed.
    pub(super) fn apply(&mut self, command: Command) -> bool {
        self.remember();
        self.history.apply(command, &mut self.document)
    }

    /// Applies an edit that belongs to a gesture.
    fn apply_in_gesture(&mut self, command: Command) {
        if !self.history.is_in_gesture() {
            self.remember();
        }
        self.history.apply_in_gesture(command, &mut self.document);
    }

    /// Applies an edit of a slider drag and solves.
    fn slide(&mut self, command: Command) {
        self.apply_in_gesture(command);
        self.solve();
    }

    /// Sets method and weights. Requested relaxation is dropped, so that the result of the new settings is visible.
    pub(super) fn choose(&mut self, settings: Settings) {
        if settings != self.document.settings {
            let edits = std::iter::once(Command::SetSettings(settings)).chain(self.drop_relaxing());
            self.edit(edits.collect());
        }
    }

    /// Edits that drop the requested relaxation and the maps that the user shaped, on all charts.
    pub(super) fn drop_relaxing(&self) -> Vec<Command> {
        let is_worked = |edits: &ChartEdits| edits.relaxed > 0 || edits.shaped.is_some();
        let worked = self.document.elsewhere.iter().filter(|(_, edits)| is_worked(edits));
        let elsewhere = worked.map(|(&chart, edits)| {
            let edits = ChartEdits { relaxed: 0, shaped: None, ..edits.clone() };
            Command::SetElsewhere { chart, edits }
        });
        [Command::SetRelaxed(0), Command::SetShaped(None)].into_iter().chain(elsewhere).collect()
    }

    /// Sets method and weights during a drag of a slider.
    pub(super) fn slide_settings(&mut self, settings: Settings) {
        if settings != self.document.settings {
            let edits = std::iter::once(Command::SetSettings(settings)).chain(self.drop_relaxing());
            self.slide(Command::Together(edits.collect()));
        }
    }

    /// True if pins can be placed now. Reports the reason if the method takes no pins.
    pub(super) fn takes_pins(&mut self) -> bool {
        if !self.has_form_as_wanted() {
            // The vertices on the screen still belong to another preparation or chart.
            return false;
        }
        if self.document.settings.method.uses_pins() {
            return true;
        }
        let text = "a convex boundary takes no pins: the method places every boundary vertex";
        self.complain(text, Some("choose another method to pin vertices"));
        false
    }
}

/// Edits of pins.
impl Session {
    /// Pins vertices at their current positions.
    pub(super) fn fix(&mut self, vertices: &[VertexId]) {
        let Some(outcome) = self.outcome().cloned().filter(|_| self.takes_pins()) else { return };
        // If there is a preview, the screen shows it instead of the step.
        let preview = self.preview().map(|preview| (self.document.frame(), &*preview.embedding));
        let (frame, shown) = preview.unwrap_or((outcome.problem.frame, &outcome.step.candidate.solution.embedding));
        // New vertices belong to one embedding only and cannot be pinned.
        let count = self.vertex_count();
        let fresh = vertices.iter().filter(|v| v.index() < count && !self.document.targets.contains_key(v));
        let fixed = |z: DVec2| Target::fixed(frame.uv_from_plane(z));
        let target = |vertex: &VertexId| shown.get(vertex.index()).copied().map(fixed);
        let commands = fresh.map(|vertex| Command::SetPin { vertex: *vertex, target: target(vertex) }).collect();
        self.edit(commands);
    }

    /// Pins a vertex, or replaces its pin.
    pub(super) fn place(&mut self, vertex: VertexId, target: Target) {
        let is_valid =
            vertex.index() < self.vertex_count() && target.uv.is_finite() && target.kind.invalid_weight().is_none();
        if is_valid && self.takes_pins() {
            // A pin on a landmark takes its name.
            let name = self.landmark_at(target.uv).map(|landmark| PinNote::named(landmark.name));
            let name = name.map(|note| Command::SetNote { vertex, note });
            self.edit(std::iter::once(pin(vertex, target)).chain(name).collect());
        }
    }

    /// Moves pins during a drag. If one of them is a gauge pin, all gauge pins become pins of the user first.
    pub(super) fn move_pins(&mut self, moves: &[(VertexId, DVec2)]) {
        if !self.has_form_as_wanted() {
            return;
        }
        let is_users = |(vertex, _): &(VertexId, DVec2)| self.document.targets.contains_key(vertex);
        if !moves.iter().all(is_users) {
            // If the solver chose no gauge, the pins of the outcome are user's pins that were removed since.
            let Some(outcome) = self.outcome().filter(|outcome| outcome.step.candidate.solution.gauge_completed) else {
                return;
            };
            let adopted = adopted(&self.document, &outcome.step.candidate.solution.pins, outcome.problem.frame);
            if !moves.iter().all(|(vertex, _)| adopted.contains_key(vertex)) {
                return;
            }
            let commands = adopted.into_iter().map(|(vertex, target)| pin(vertex, target)).collect();
            self.apply_in_gesture(Command::Together(commands));
        }
        let command = |&(vertex, uv): &(VertexId, DVec2)| {
            let before = self.document.targets.get(&vertex).filter(|before| uv.is_finite() && before.uv != uv)?;
            Some(pin(vertex, Target { uv, ..*before }))
        };
        let commands: Vec<Command> = moves.iter().filter_map(command).collect();
        if commands.is_empty() {
            return;
        }
        self.apply_in_gesture(Command::Together(commands));
        let mut dragged: Vec<VertexId> = moves.iter().map(|(vertex, _)| *vertex).collect();
        dragged.sort_unstable();
        dragged.dedup();
        self.solving.give_up();
        self.follow(dragged);
    }

    /// Changes the kind of pins, as a separate edit.
    pub(super) fn set_pin_kind(&mut self, vertices: &[VertexId], kind: PinKind) {
        let commands = self.holds(vertices, kind);
        self.edit(commands);
    }

    /// Changes the kind of pins during a drag of a slider.
    pub(super) fn slide_hold(&mut self, vertices: &[VertexId], kind: PinKind) {
        let commands = self.holds(vertices, kind);
        if !commands.is_empty() {
            self.slide(Command::Together(commands));
        }
    }

    fn holds(&self, vertices: &[VertexId], kind: PinKind) -> Vec<Command> {
        let command = |&vertex: &VertexId| {
            let before = self.document.targets.get(&vertex).filter(|before| before.kind != kind)?;
            Some(pin(vertex, Target { kind, ..*before }))
        };
        let is_valid = kind.invalid_weight().is_none() && self.has_form_as_wanted();
        vertices.iter().filter(|_| is_valid).filter_map(command).collect()
    }

    /// Unpins vertices.
    pub(super) fn unpin(&mut self, vertices: &[VertexId]) {
        let has_form = self.has_form_as_wanted();
        let pinned = vertices.iter().filter(|v| has_form && self.document.targets.contains_key(v));
        self.edit(pinned.flat_map(|&vertex| unpinned(vertex)).collect());
    }

    /// Unpins all vertices of the mesh or chart.
    pub(super) fn unpin_all(&mut self) {
        let pinned = self.document.targets.keys();
        self.edit(pinned.flat_map(|&vertex| unpinned(vertex)).collect());
    }

    /// Names a pin, or takes its name away.
    pub(super) fn name_pin(&mut self, vertex: VertexId, name: Option<PinName>) {
        let is_pin = self.has_form_as_wanted() && self.document.targets.contains_key(&vertex);
        let key = name.as_ref().map(PinName::key);
        let has_name = |note: &PinNote| note.name.as_ref().map(PinName::key) == key;
        let other = self.document.notes.iter().find(|(other, note)| **other != vertex && has_name(note));
        if let (Some(name), Some((other, _))) = (&name, other) {
            let text = format!("pin {} has the name \"{name}\" already", self.number_of(*other));
            return self.complain(text, Some("choose another name"));
        }
        if is_pin {
            self.apply(Command::SetNote { vertex, note: PinNote { name } });
        }
    }

    /// Joins pins with nearly equal targets: keeps the first pin and frees the second.
    pub(super) fn merge_pins(&mut self, [kept, freed]: [VertexId; 2]) {
        let targets = &self.document.targets;
        if kept == freed || !targets.contains_key(&kept) || !targets.contains_key(&freed) || !self.has_form_as_wanted()
        {
            return;
        }
        let note = |vertex: VertexId| self.document.notes.get(&vertex).cloned().unwrap_or_default();
        let mut commands = unpinned(freed).to_vec();
        if note(kept).name.is_none() {
            commands.push(Command::SetNote { vertex: kept, note: note(freed) });
        }
        self.edit(commands);
    }
}

/// Edits of all targets together.
impl Session {
    /// Mirrors all targets left to right within their bounding box.
    pub(super) fn mirror_targets(&mut self) {
        let across = self.document.targets.values().map(|target| target.uv.x);
        let (low, high) = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
        let mirrored = |target: &Target| DVec2::new(low + (high - target.uv.x), target.uv.y);
        let targets: Vec<DVec2> = self.document.targets.values().map(mirrored).collect();
        self.move_targets(&targets);
    }

    /// Flattens the mesh in the background to fit the targets to it.
    pub(super) fn fit_targets(&mut self) {
        if self.document.targets.len() < 2 {
            let text = "fitting needs at least two pins";
            return self.complain(text, Some("add another pin"));
        }
        let model = self.model().cloned();
        let Some((model, disk)) = model.and_then(|model| model.disk().map(Arc::clone).map(|disk| (model, disk))) else {
            return self.complain("targets cannot be fitted to a mesh with faults: repair it first", None);
        };
        let (frame, form, chart) = (self.document.frame(), model.prepared.form.clone(), self.chart_on_screen());
        let [low, high] = frame.corners();
        let size = GaugeSize::Within(Bounds { low, high });
        let settings = Settings { size, ..Settings::new(Method::Natural, Family::Conformal) };
        self.jobs.send("fitting the targets", move |cancel| {
            let step = Flattener::new(settings, Pins::new()).step(&disk, Control::new(cancel, &|_| {}));
            let embedding = step.map(|step| step.candidate.solution.embedding);
            let embedding = embedding.map_err(|error| error_in_file(&model, &error));
            BackgroundJob::Flat(Flat { frame, form, chart, embedding })
        });
    }

    /// Fits the targets to the flattened mesh.
    pub(super) fn take_flat(&mut self, flat: &Flat) {
        let embedding = match &flat.embedding {
            Ok(embedding) => embedding,
            Err(error) => {
                let message = Message::error(MessagePlace::Embedding, format!("the targets cannot be fitted: {error}"));
                self.messages.say(message.with_vertices(error.vertices()));
                return;
            }
        };
        let is_of_chart = flat.chart == self.chart_on_screen() && self.has_form_as_wanted();
        if flat.frame != self.document.frame() || flat.form != self.document.form || !is_of_chart {
            let text = "the targets were not fitted: picture, faces or chart have changed";
            return self.complain(text, Some("fit them again"));
        }
        let pairs: Vec<[DVec2; 2]> =
            (self.document.pins().into_iter()).map(|(vertex, pin)| [pin.target, embedding[vertex]]).collect();
        let fitted = Similarity::fitting(&pairs).map(|similarity| -> Vec<DVec2> {
            pairs.iter().map(|[target, _]| flat.frame.uv_from_plane(similarity.apply(*target))).collect()
        });
        match fitted.filter(|targets| targets.iter().all(|target| target.is_finite())) {
            Some(targets) => self.move_targets(&targets),
            None => self.complain("no rotation and scale fits these targets", None),
        }
    }

    /// Sets the targets of all pins, in their order, as one edit.
    fn move_targets(&mut self, targets: &[DVec2]) {
        let moved = self.document.targets.iter().zip(targets).filter(|((_, before), uv)| before.uv != **uv);
        self.edit(moved.map(|((&vertex, before), &uv)| pin(vertex, Target { uv, ..*before })).collect());
    }
}

/// Side of the picture with v = 0.
impl Session {
    /// Sets the side with v = 0. The targets keep their positions on the picture. Setting it back restores them
    /// exactly.
    pub(super) fn set_v_axis(&mut self, v_axis: VAxis) {
        if v_axis == self.document.v_axis {
            return;
        }
        let mut into = TurnedV::default();
        let shown = self.charts().map_or(0, |charts| charts.pick(self.document.chart));
        let here = self.turned_v.targets(shown, &self.document.targets, &mut into);
        let mut commands = vec![Command::SetVAxis(v_axis)];
        commands.extend(here.into_iter().map(|(vertex, target)| Command::SetPin { vertex, target: Some(target) }));
        for (&chart, edits) in &self.document.elsewhere {
            let targets = self.turned_v.targets(chart, &edits.targets, &mut into);
            commands.push(Command::SetElsewhere { chart, edits: ChartEdits { targets, ..edits.clone() } });
        }
        self.turned_v = into;
        self.edit(commands);
    }
}

/// Edits that free a pin and take its name away.
pub(super) fn unpinned(vertex: VertexId) -> [Command; 2] {
    [Command::SetPin { vertex, target: None }, Command::SetNote { vertex, note: PinNote::default() }]
}

pub(super) fn pin(vertex: VertexId, target: Target) -> Command {
    Command::SetPin { vertex, target: Some(target) }
}

/// Gauge pins as targets of the user, at their current positions. Pins of the user are not changed.
fn adopted(document: &Document, in_force: &Pins, frame: PictureFrame) -> Targets {
    let fresh = in_force.iter().filter(|(vertex, _)| !document.targets.contains_key(vertex));
    fresh.map(|(&vertex, pin)| (vertex, Target::fixed(frame.uv_from_plane(pin.target)))).collect()
}
