//! Session without a screen: opening, solving, pinning, undo, saving; and thousands of random actions.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use freebound::examples::Example;
use freebound::session::{Action, Document, MessagePlace, RecentFiles, SaveRequest, Session, Severity, StopConditions};
use freebound_core::flatten::solve_once;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Fit, Target};
use freebound_core::problem::{Control, Family, Method, NamedOption as _, Settings};
use freebound_io::{OutputKind, read_mesh};
use glam::DVec2;
use tempfile::TempDir;

use freebound_testkit::{Random, assert_message, grid, write_obj};

/// Time limit for the background before a test fails.
const PATIENCE: Duration = Duration::from_secs(90);

pub(crate) fn session() -> Session {
    Session::new(Arc::new(|| ()), RecentFiles::default())
}

/// Polls until the background is idle.
pub(crate) fn settle(session: &mut Session) {
    let start = Instant::now();
    session.poll();
    while session.busy().is_some() || session.is_following() {
        assert!(start.elapsed() < PATIENCE, "{session:?}");
        std::thread::sleep(Duration::from_micros(200));
        session.poll();
    }
}

pub(crate) fn settled(session: &mut Session, action: Action) {
    session.handle(action);
    settle(session);
}

pub(crate) fn opened(example: Example) -> Session {
    let mut session = session();
    settled(&mut session, Action::OpenExample(example));
    session
}

fn id(number: u32) -> VertexId {
    VertexId::new(number)
}

#[test]
fn an_opened_mesh_is_solved_at_once() {
    for example in [Example::Ell, Example::Dome, Example::Spiral] {
        let session = opened(example);
        assert_eq!(session.model().expect("open").name, example.title());
        assert!(session.is_current());
        assert!(session.messages().is_empty());
        assert!(!session.history().can_undo());
    }
}

#[test]
fn a_file_that_is_not_there_leaves_the_mesh_that_was_open() {
    let mut session = opened(Example::Ell);
    let before = session.outcome().expect("solved").clone();
    settled(&mut session, Action::Open(PathBuf::from("/no/such/file.obj")));
    assert_eq!(session.model().expect("open").name, Example::Ell.title());
    assert!(Arc::ptr_eq(&before, session.outcome().expect("solved")));
    assert_eq!(session.messages().len(), 1);
    assert_eq!((session.messages()[0].place, session.messages()[0].severity), (MessagePlace::Mesh, Severity::Error));
    let message = session.messages()[0].id;
    settled(&mut session, Action::Dismiss(message));
    assert!(session.messages().is_empty());
}

#[test]
fn one_fixed_vertex_leaves_the_embedding_where_it_is() {
    let mut session = opened(Example::Dome);
    let before = session.outcome().expect("solved").step.candidate.solution.embedding.clone();
    settled(&mut session, Action::Fix(vec![id(100)]));
    assert_eq!(session.document().targets[&id(100)], Target::fixed(before[100]));
    let after = &session.outcome().expect("solved").step.candidate.solution.embedding;
    assert!(before.iter().zip(after).all(|(a, b)| a.distance(*b) < 1e-9));
}

#[test]
fn another_mesh_starts_from_defaults() {
    let mut session = opened(Example::Dome);
    let settings = Settings::new(Method::Natural, Family::MeanValue);
    settled(&mut session, Action::SetSettings(settings));
    settled(&mut session, Action::SetStop(StopConditions { planar: false, ..StopConditions::default() }));
    settled(&mut session, Action::Fix(vec![id(1), id(2)]));
    settled(&mut session, Action::OpenExample(Example::Ell));
    assert_eq!(*session.document(), Document::default());
    assert_eq!(session.stop_conditions(), StopConditions::default());
    assert!(!session.history().can_undo());
}

#[test]
fn a_drag_by_a_linear_method_ends_where_a_fresh_solve_would() {
    let mut session = opened(Example::Dome);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Conformal)));
    settled(&mut session, Action::Fix(vec![id(3), id(100), id(200)]));
    let from = session.document().targets[&id(100)].uv;
    for i in 1..=40 {
        let target = from + DVec2::new(0.002, 0.001) * f64::from(i);
        session.handle(Action::MovePin { vertex: id(100), target });
        session.poll();
    }
    session.handle(Action::EndGesture);
    settle(&mut session);
    assert!(session.is_current());
    let disk = session.model().expect("open").disk().expect("a disk");
    let document = session.document();
    let fresh = solve_once(disk, &document.settings, &document.pins(), Control::unattended()).expect("solvable");
    assert_eq!(fresh.embedding, session.outcome().expect("solved").step.candidate.solution.embedding);
}

#[test]
fn a_cancelled_solve_can_be_asked_for_again() {
    let mut session = opened(Example::Dome);
    session.handle(Action::SetSettings(Settings::new(Method::Levy, Family::Conformal)));
    settled(&mut session, Action::Cancel);
    assert!(!session.is_current(), "the step that was on its way is not there");
    settled(&mut session, Action::Solve);
    assert!(session.is_current());
}

#[test]
fn saving_before_anything_is_open_says_what_to_do() {
    let mut session = session();
    let folder = tempfile::tempdir().unwrap();
    settled(&mut session, save(&folder, "a.obj", OutputKind::Obj));
    let [message] = session.messages() else { panic!("{:?}", session.messages()) };
    assert_eq!((message.place, message.severity), (MessagePlace::Embedding, Severity::Error));
    assert_message("basics-nothing-to-save", &message.text);
    assert!(!folder.path().join("a.obj").exists());
}

fn save(folder: &TempDir, name: &str, kind: OutputKind) -> Action {
    Action::Save(SaveRequest { path: folder.path().join(name), kind, fit: Fit::Unit })
}

#[test]
fn every_save_is_answered_even_of_several_at_once() {
    let mut session = opened(Example::Dome);
    let folder = tempfile::tempdir().unwrap();
    let kinds = [
        ("a.obj", OutputKind::Obj),
        ("b.svg", OutputKind::Svg),
        ("c.json", OutputKind::Json),
        ("d.ply", OutputKind::Ply),
        ("e.glb", OutputKind::Glb),
    ];
    for (name, kind) in kinds {
        session.handle(save(&folder, name, kind));
    }
    settle(&mut session);
    for (name, _) in kinds {
        assert!(folder.path().join(name).is_file(), "{name}");
        let told = session.messages().iter().any(|message| message.text.contains(name));
        assert!(told, "{name}: {:?}", session.messages());
    }
}

#[test]
fn a_failed_save_stays_on_the_screen_when_a_solve_ends_well() {
    let mut session = opened(Example::Dome);
    let folder = tempfile::tempdir().unwrap();
    settled(&mut session, save(&folder, "missing/a.obj", OutputKind::Obj));
    assert_eq!(session.messages().len(), 1);
    settled(&mut session, Action::Fix(vec![id(1)]));
    assert_eq!(session.messages().len(), 1, "the file is still not written");
}

#[test]
fn a_solve_s_error_goes_when_a_solve_ends_well() {
    let mut session = opened(Example::Dome);
    settled(&mut session, Action::SetSettings(Settings::new(Method::Natural, Family::Uniform)));
    assert_eq!(session.messages().len(), 1);
    assert!(!session.is_current());
    settled(&mut session, Action::Undo);
    assert!(session.messages().is_empty() && session.is_current());
}

#[test]
fn pins_in_a_saved_file_are_the_user_s_own_numbers() {
    let mut session = opened(Example::Dome);
    settled(&mut session, Action::Fix(vec![id(0), id(200)]));
    let target = DVec2::new(0.1, 0.7);
    settled(&mut session, Action::MovePin { vertex: id(0), target });
    settled(&mut session, Action::EndGesture);
    let folder = tempfile::tempdir().unwrap();
    settled(&mut session, save(&folder, "a.obj", OutputKind::Obj));
    let text = std::fs::read_to_string(folder.path().join("a.obj")).unwrap();
    assert!(text.lines().any(|line| line == "vt 0.1 0.7"), "written with all digits");
}

/// Session with the state that the test must remember.
struct Walk {
    session: Session,
    random: Random,
    folder: TempDir,
    /// Document when the mesh was opened.
    opening: Document,
    /// Revision of the opened mesh.
    revision: u64,
    saves: usize,
}

const SMALL: [Example; 2] = [Example::Ell, Example::Dome];

impl Walk {
    fn new(seed: u64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        write_obj(&folder.path().join("grid.obj"), &grid(9, 7));
        std::fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
        let session = opened(Example::Ell);
        let (opening, revision) = (session.document().clone(), session.model_revision());
        Self { session, random: Random(seed), folder, opening, revision, saves: 0 }
    }

    fn vertex(&mut self) -> VertexId {
        let count = self.session.model().map_or(1, |model| model.mesh().vertex_count());
        id(self.random.below(u32::try_from(count).expect("small")))
    }

    fn point(&mut self) -> DVec2 {
        DVec2::new(self.random.unit(), self.random.unit()) * 2.0 - DVec2::ONE
    }

    fn settings(&mut self) -> Settings {
        // Methods that meet random constraints one-to-one take long, so they are left out.
        let methods: Vec<Method> = Method::ALL.iter().filter(|method| !method.is_one_to_one()).cloned().collect();
        let count = u32::try_from(methods.len()).expect("few");
        let families = [Family::Conformal, Family::MeanValue, Family::Wachspress, Family::Power(0.5), Family::Uniform];
        Settings::new(methods[self.random.below(count) as usize].clone(), families[self.random.below(5) as usize])
    }

    fn action(&mut self) -> Action {
        match self.random.below(110) {
            0 => Action::OpenExample(SMALL[self.random.below(2) as usize]),
            1 => Action::Open(self.folder.path().join("grid.obj")),
            2 => Action::Open(self.folder.path().join("bad.obj")),
            3..15 => Action::Fix(vec![self.vertex(), self.vertex()]),
            15..40 => {
                let pins: Vec<VertexId> = self.session.document().targets.keys().copied().collect();
                let any = self.vertex();
                let place = self.random.below(u32::try_from(pins.len() + 1).expect("few")) as usize;
                Action::MovePin { vertex: pins.get(place).copied().unwrap_or(any), target: self.point() }
            }
            40..48 => Action::EndGesture,
            48..50 => Action::GiveUpGesture,
            50..56 => Action::Unpin(vec![self.vertex(), self.first_pin()]),
            56 => Action::UnpinAll,
            57..70 => Action::Undo,
            70..80 => Action::Redo,
            80..86 => Action::SetSettings(self.settings()),
            86..90 => Action::SlideSettings(Settings {
                family: Some(Family::Power(self.random.unit())),
                ..Settings::default()
            }),
            90..93 => self.save(),
            93..96 => Action::Cancel,
            96 => Action::Dismiss(u64::from(self.random.below(50))),
            97 => Action::Solve,
            _ => self.look(),
        }
    }

    /// Takes steps, and shows existing ones.
    fn look(&mut self) -> Action {
        let index = self.random.below(6) as usize;
        match self.random.below(8) {
            0..3 => Action::Step,
            3 => Action::Run,
            4 | 5 => Action::ShowStep(index),
            6 => Action::Compare((index > 0).then_some(index)),
            _ => Action::SetStop(StopConditions {
                planar: index != 1,
                stalled: index != 2,
                crossing: index == 3,
                at_step: (index > 3).then_some(index),
            }),
        }
    }

    fn first_pin(&mut self) -> VertexId {
        let first = self.session.document().targets.keys().next().copied();
        first.unwrap_or_else(|| self.vertex())
    }

    fn save(&mut self) -> Action {
        self.saves += 1;
        let kinds = [(OutputKind::Obj, "obj"), (OutputKind::Svg, "svg"), (OutputKind::Json, "json")];
        let (kind, extension) = kinds[self.random.below(3) as usize];
        save(&self.folder, &format!("{}.{extension}", self.saves), kind)
    }

    /// Notes if another mesh was opened, which starts a new history.
    fn note_opening(&mut self) {
        if self.session.model_revision() != self.revision {
            self.revision = self.session.model_revision();
            self.opening = Document { settings: self.session.document().settings.clone(), ..Document::default() };
        }
    }

    /// Checks invariants of an idle session.
    fn check(&mut self) {
        settle(&mut self.session);
        self.note_opening();
        let failed = |session: &Session| session.messages().iter().any(|m| m.severity == Severity::Error);
        if !self.session.is_current() && !failed(&self.session) {
            // A solve was cancelled, or its message was dismissed.
            settled(&mut self.session, Action::Solve);
        }
        assert!(self.session.is_current() || failed(&self.session), "{:?}", self.session);
        let Some(outcome) = self.session.outcome() else { return };
        let model = self.session.model().expect("what is solved is open");
        let count = model.mesh().vertex_count() + outcome.new_vertex_count();
        assert_eq!(outcome.step.candidate.solution.embedding.len(), count);
        assert!(outcome.step.candidate.solution.embedding.iter().all(|z| z.is_finite()));
        // A step before the constraints are met is planar, and the last one meets them.
        let is_one_to_one = outcome.step.candidate.stage.is_one_to_one()
            && outcome.step.verdict.planar
            && !outcome.step.unmet().is_empty();
        let is_on_its_way = is_one_to_one || outcome.step.is_of_planar_start();
        if outcome.problem.settings.method.uses_pins() && !is_on_its_way {
            for (vertex, pin) in &outcome.problem.targets {
                assert_eq!(outcome.step.candidate.solution.embedding[vertex], pin.uv);
            }
        }
    }

    /// Undoing everything restores the initial document, and redoing everything the current one.
    fn check_history(&mut self) {
        let now = self.session.document().clone();
        self.session.handle(Action::EndGesture);
        let mut forth = 0;
        while self.session.history().can_redo() {
            self.session.handle(Action::Redo);
            forth += 1;
        }
        let last = self.session.document().clone();
        let mut steps = 0;
        while self.session.history().can_undo() {
            self.session.handle(Action::Undo);
            steps += 1;
        }
        assert_eq!(*self.session.document(), self.opening);
        for _ in 0..steps {
            self.session.handle(Action::Redo);
        }
        assert_eq!(*self.session.document(), last);
        for _ in 0..forth {
            self.session.handle(Action::Undo);
        }
        assert_eq!(*self.session.document(), now);
    }
}

#[test]
fn two_thousand_actions_at_random_break_nothing() {
    let mut walk = Walk::new(20_050_601);
    for count in 0..2000 {
        let action = walk.action();
        walk.session.handle(action);
        walk.session.poll();
        walk.note_opening();
        if count % 25 == 24 {
            walk.check();
            walk.check_history();
            walk.check();
        }
    }
    assert!(walk.saves > 20, "saves were among them");
    for entry in std::fs::read_dir(walk.folder.path()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "obj") && !path.ends_with("bad.obj") {
            assert!(read_mesh(&path).is_ok(), "{} is whole", path.display());
        }
    }
}
