//! Ten thousand random actions, with good and bad input: invariants after each action, and of the idle session.

use std::path::PathBuf;

use freebound::examples::Example;
use freebound::session::{Action, BakeRequest, Document, SaveRequest, Session};
use freebound_core::geom::VAxis;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{Family, Method, NamedOption as _, PinKind, Settings, Treatment};
use freebound_io::{BakeOptions, OutputKind, ProjectFile, Registration};
use glam::DVec2;
use tempfile::TempDir;

use super::basics::{session, settle, settled};
use super::documents::{errors, id, write_dome, write_picture};
use freebound_testkit::Random;

const ACTIONS: u32 = 10_000;

/// Number of actions after which the session gets time to become idle.
const REST: u32 = 40;

struct Fuzz {
    session: Session,
    random: Random,
    folder: TempDir,
    /// Number of requested projects.
    saves: u32,
    /// Number of complete drags that were checked.
    drags: u32,
}

impl Fuzz {
    fn new(seed: u64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write_dome(&at("dome.obj"), 8, 6);
        write_dome(&at("small.obj"), 4, 3);
        write_picture(&at("wide.png"), 6, 4);
        write_picture(&at("high.png"), 3, 5);
        std::fs::write(at("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
        std::fs::write(at("bad.png"), "no picture").unwrap();
        std::fs::write(at("bad.freebound"), "{\"freebound_project\": 1, \"mesh\": {}}").unwrap();
        std::fs::write(at("marks.txt"), "3 0.1 0.2\n9 0.7 0.3 2\n17 0.5 0.9\n").unwrap();
        std::fs::write(at("bad.txt"), "3 0.1 0.2\n3 0.4 0.2\n").unwrap();
        let mut session = session();
        session.keep_copies_in(at("recovery"));
        settled(&mut session, Action::Open(at("dome.obj")));
        // A layout for meshes of any size.
        settled(&mut session, Action::Save(SaveRequest { path: at("uv.obj"), kind: OutputKind::Obj, fit: Fit::Unit }));
        Self { session, random: Random(seed), folder, saves: 0, drags: 0 }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn one_of(&mut self, names: &[&str]) -> PathBuf {
        let count = u32::try_from(names.len()).expect("few");
        let chosen = self.random.below(count) as usize;
        self.at(names[chosen])
    }

    /// Random vertex, mostly a valid one.
    fn vertex(&mut self) -> VertexId {
        let count = self.session.model().map_or(1, |model| model.mesh().vertex_count());
        let beyond = u32::from(self.random.below(20) == 0);
        id(self.random.below(u32::try_from(count).expect("small") + beyond))
    }

    /// Random vertex, mostly a pinned one.
    fn pinned(&mut self) -> VertexId {
        let pins: Vec<VertexId> = self.session.document().targets.keys().copied().collect();
        let any = self.vertex();
        let place = self.random.below(u32::try_from(pins.len()).expect("few") + 1) as usize;
        pins.get(place).copied().unwrap_or(any)
    }

    fn target(&mut self) -> DVec2 {
        match self.random.below(30) {
            0 => DVec2::new(f64::NAN, 0.0),
            1 => DVec2::new(0.0, f64::INFINITY),
            2 => DVec2::ZERO,
            _ => DVec2::new(self.random.unit(), self.random.unit()) * 2.0 - DVec2::ONE,
        }
    }

    fn kind(&mut self) -> PinKind {
        match self.random.below(8) {
            0 => PinKind::Soft(-1.0),
            1 => PinKind::Soft(f64::NAN),
            2 => PinKind::Fixed,
            3 | 4 => PinKind::Soft(self.random.unit() * 10.0 + 0.01),
            _ => PinKind::Hard,
        }
    }

    fn settings(&mut self) -> Settings {
        // Methods that meet random constraints one-to-one take long, so they are left out.
        let methods: Vec<Method> = Method::ALL.iter().filter(|method| !method.is_one_to_one()).cloned().collect();
        let count = u32::try_from(methods.len()).expect("few");
        let families = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.5), Family::Uniform];
        let treatments = [None, Some(Treatment::Eliminate), Some(Treatment::LeastSquares), Some(Treatment::Weighted)];
        Settings {
            treatment: treatments[self.random.below(4) as usize],
            max_steps: Some(5),
            ..Settings::new(methods[self.random.below(count) as usize].clone(), families[self.random.below(5) as usize])
        }
    }

    fn action(&mut self) -> Action {
        match self.random.below(100) {
            0..14 => Action::Place { vertex: self.vertex(), target: Target { uv: self.target(), kind: self.kind() } },
            14..28 => Action::MovePin { vertex: self.pinned(), target: self.target() },
            28..30 => Action::MovePins(vec![(self.pinned(), self.target()), (self.pinned(), self.target())]),
            30..36 => Action::EndGesture,
            36..38 => Action::GiveUpGesture,
            38..40 => Action::Rest,
            40..43 => Action::SetPinKind { vertices: vec![self.pinned(), self.pinned()], kind: self.kind() },
            43..45 => Action::SlideHold { vertices: vec![self.pinned()], kind: self.kind() },
            45..50 => Action::Unpin(vec![self.pinned(), self.vertex()]),
            50..60 => Action::Undo,
            60..68 => Action::Redo,
            68..74 => self.look(),
            _ => self.seldom(),
        }
    }

    fn seldom(&mut self) -> Action {
        match self.random.below(28) {
            0 => Action::Fix(vec![self.vertex(), self.vertex()]),
            1 | 2 => Action::SetSettings(self.settings()),
            3 => Action::SlideSettings(self.settings()),
            4 => Action::MirrorTargets,
            5 => Action::FitTargets,
            6 => Action::SetVAxis(if self.random.below(2) == 0 { VAxis::Up } else { VAxis::Down }),
            7 | 8 => Action::TurnFaces,
            9 | 10 => Action::OpenPicture(self.one_of(&["wide.png", "high.png", "bad.png", "missing.png"])),
            11 => Action::RemovePicture,
            12 | 13 => Action::ImportConstraints(self.one_of(&["marks.txt", "bad.txt", "out.txt", "missing.txt"])),
            14 => Action::ExportConstraints(self.one_of(&["out.txt", "missing/out.txt"])),
            15..18 => {
                self.saves += 1;
                Action::SaveProject(self.one_of(&["a.freebound", "b.freebound", "missing/c.freebound"]))
            }
            18 => Action::Open(self.one_of(&["a.freebound", "b.freebound", "bad.freebound", "missing.freebound"])),
            19 => Action::Open(self.one_of(&["dome.obj", "small.obj", "bad.obj", "missing.obj"])),
            20 => self.save(),
            21 => Action::Cancel,
            22 => Action::Dismiss(u64::from(self.random.below(50))),
            23 => Action::Solve,
            24 => Action::Recover(self.at("a.freebound")),
            25 => Action::CopyLayout(self.one_of(&["uv.obj", "dome.obj", "missing.obj"])),
            26 if self.random.below(2) == 0 => Action::SaveFlatMesh(self.one_of(&["flat.glb", "missing/flat.obj"])),
            26 => {
                let options = BakeOptions { pixels: [16, 16], margin: 2, registration: Registration::AsTheyAre };
                Action::SaveBaked(BakeRequest { path: self.one_of(&["out.png", "missing/out.png"]), options })
            }
            _ if self.random.below(12) == 0 => Action::OpenExample(Example::Ell),
            _ => Action::UnpinAll,
        }
    }

    /// Takes steps, and shows existing ones.
    fn look(&mut self) -> Action {
        let index = self.random.below(6) as usize;
        match self.random.below(6) {
            0 | 1 => Action::Step,
            2 => Action::Run,
            3 => Action::ShowStep(index),
            4 => Action::Compare((index > 0).then_some(index)),
            _ => Action::Cancel,
        }
    }

    fn save(&mut self) -> Action {
        let path = self.one_of(&["out.obj", "missing/out.obj"]);
        Action::Save(SaveRequest { path, kind: OutputKind::Obj, fit: Fit::Unit })
    }

    /// Checks invariants after every action.
    fn check(&self) {
        let Document { targets: pins, .. } = self.session.document();
        let count = self.session.model().map_or(0, |model| model.mesh().vertex_count());
        for (vertex, pin) in pins {
            assert!(vertex.index() < count, "{vertex} of {count}");
            assert!(pin.uv.is_finite(), "{vertex}: {pin:?}");
            assert!(!matches!(pin.kind, PinKind::Soft(weight) if !(weight.is_finite() && weight > 0.0)), "{pin:?}");
        }
        let timeline = self.session.timeline();
        let steps = timeline.records().len();
        for index in [timeline.shown(), timeline.compared(), timeline.newest(), timeline.best()].into_iter().flatten() {
            assert!(index < steps, "{index} of {steps}");
        }
        if let Some(outcome) = self.session.outcome() {
            let new_vertices =
                outcome.step.candidate.refinement.as_ref().map_or(0, |refined| refined.new_vertices().len());
            assert_eq!(outcome.step.candidate.solution.embedding.len(), count + new_vertices);
        }
    }

    /// Checks invariants of an idle session.
    fn check_at_rest(&mut self) {
        self.session.handle(Action::EndGesture);
        settle(&mut self.session);
        if !self.session.is_current() && errors(&self.session).is_empty() {
            // A solve was cancelled, or its message was dismissed.
            settled(&mut self.session, Action::Solve);
        }
        let is_said = !errors(&self.session).is_empty();
        assert!(self.session.is_current() || is_said, "{:?}", self.session);
        self.check_history();
        self.check_exact_pins();
    }

    fn check_exact_pins(&self) {
        let (Some(outcome), Some(model)) = (self.session.outcome(), self.session.model()) else { return };
        let disk = model.disk().expect("only a disk is solved");
        assert!(outcome.step.candidate.solution.embedding.iter().all(|z| z.is_finite()));
        // A cancelled run is shown again in its last state.
        let is_on_its_way = outcome.step.is_of_planar_start() || self.session.can_run();
        if !self.session.is_current() || !outcome.problem.settings.method.uses_pins() || is_on_its_way {
            return;
        }
        let (coordinates, ..) = outcome.output(disk, Fit::Unit);
        for (vertex, pin) in &self.session.document().targets {
            if outcome.problem.settings.is_hard(pin.kind) {
                let bits = |z: DVec2| z.to_array().map(f64::to_bits);
                assert_eq!(bits(coordinates[vertex.index()]), bits(pin.uv), "{vertex}: {pin:?}");
            }
        }
    }

    fn check_history(&mut self) {
        let now = self.session.document().clone();
        if self.session.history().can_undo() {
            self.session.handle(Action::Undo);
            assert_ne!(*self.session.document(), now, "an empty step of undo");
            self.session.handle(Action::Redo);
            assert_eq!(*self.session.document(), now);
            settle(&mut self.session);
        }
    }

    /// Complete drag of a pin: a single undo step, and no lost constraint.
    fn drag(&mut self) {
        self.session.handle(Action::EndGesture);
        settle(&mut self.session);
        let before = self.session.document().clone();
        let (vertex, opening) = (self.pinned(), self.session.opening_revision());
        for _ in 0..=self.random.below(6) {
            let target = self.target();
            self.session.handle(Action::MovePin { vertex, target });
            self.session.poll();
            self.check();
        }
        self.session.handle(Action::EndGesture);
        let after = self.session.document().clone();
        assert_eq!(self.session.opening_revision(), opening);
        assert!(before.targets.keys().all(|vertex| after.targets.contains_key(vertex)), "{before:?}\n{after:?}");
        if after != before {
            self.drags += 1;
            self.session.handle(Action::Undo);
            assert_eq!(*self.session.document(), before);
            self.session.handle(Action::Redo);
            assert_eq!(*self.session.document(), after);
        }
    }
}

#[test]
fn ten_thousand_actions_at_random_break_nothing() {
    let mut fuzz = Fuzz::new(20_050_601);
    for count in 1..=ACTIONS {
        let action = fuzz.action();
        fuzz.session.handle(action);
        fuzz.session.poll();
        fuzz.check();
        if count % REST == 0 {
            fuzz.check_at_rest();
            fuzz.drag();
        }
    }
    fuzz.check_at_rest();
    assert!(fuzz.saves > 100 && fuzz.drags > 100, "{} saves, {} drags", fuzz.saves, fuzz.drags);
    for name in ["a.freebound", "b.freebound"] {
        ProjectFile::read(&fuzz.at(name)).unwrap_or_else(|error| panic!("{error}"));
    }
}
