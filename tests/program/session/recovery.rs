//! Recovery copies, and killed sessions: at any moment the disk has a complete version.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use freebound::session::{Action, Session};
use freebound_core::pipeline::Target;
use freebound_io::ProjectFile;
use glam::DVec2;

use super::basics::{session, settle, settled};
use super::documents::{errors, id, place, with_dome, write_dome};

/// Environment variable with the folder of a child process.
const FOLDER_OF_CHILD: &str = "FREEBOUND_TEST_FOLDER";

/// Longer than the time between two copies.
const LONG: Duration = Duration::from_mins(1);

/// Number of times a process is killed. It is a lower bound, extended up to the maximum until both projects were
/// seen.
const KILLS: u32 = 36;
const MOST_KILLS: u32 = 10 * KILLS;

/// Polls until the copies in a folder have these numbers of pins.
fn until_copies(session: &mut Session, now: Instant, (store, pins): (&Path, &[usize])) {
    let begun = Instant::now();
    while pins_in_copies(store) != pins {
        assert!(begun.elapsed() < LONG, "{:?} instead of {pins:?}", pins_in_copies(store));
        session.poll_at(now);
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn pins_in_copies(store: &Path) -> Vec<usize> {
    copies(store).iter().map(|copy| ProjectFile::read(copy).unwrap().pins.targets.len()).collect()
}

fn with_recovery(folder: &Path) -> Session {
    let mut session = session();
    session.keep_copies_in(folder.to_owned());
    session
}

/// Session that finds a copy. Its lock is free as soon as processes that other tests start have begun their programs: until
/// then they hold the files of this process.
fn after_release(store: &Path) -> Session {
    let begun = Instant::now();
    loop {
        let next = with_recovery(store);
        if !next.recoverable().is_empty() {
            return next;
        }
        assert!(begun.elapsed() < LONG, "the copy of the dead session is not found");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn copies(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "freebound")).collect()
}

#[test]
fn what_a_dead_session_leaves_can_be_recovered_and_a_living_one_s_cannot() {
    let (folder, mut doomed) = with_dome();
    let store = folder.path().join("state").join("recovery");
    doomed.keep_copies_in(store.clone());
    let now = Instant::now();
    doomed.poll_at(now);
    assert!(!store.exists(), "there is nothing to lose yet");
    place(&mut doomed, 3, Target::hard(DVec2::X));
    place(&mut doomed, 8, Target::weighted(DVec2::Y, 0.5));
    until_copies(&mut doomed, now + LONG, (&store, &[2]));
    let document = doomed.document().clone();
    assert!(with_recovery(&store).recoverable().is_empty(), "it is alive");
    drop(doomed);

    let mut next = after_release(&store);
    let found = next.recoverable()[0].clone();
    assert_eq!((found.name.as_str(), found.pin_count), ("dome.obj", 2));
    settled(&mut next, Action::Recover(found.path.clone()));
    assert_eq!(*next.document(), document);
    assert!(next.has_unsaved_work() && next.recoverable().is_empty() && next.project_path().is_none());
    assert!(with_recovery(&store).recoverable().is_empty(), "it belongs to the living again");
    next.close();
    assert!(copies(&store).is_empty());
}

#[test]
fn a_save_takes_the_copy_away_and_so_does_undoing_everything() {
    let (folder, mut session) = with_dome();
    let store = folder.path().join("recovery");
    session.keep_copies_in(store.clone());
    let now = Instant::now();
    place(&mut session, 3, Target::hard(DVec2::X));
    until_copies(&mut session, now + LONG, (&store, &[1]));
    settled(&mut session, Action::SaveProject(folder.path().join("work.freebound")));
    until_copies(&mut session, now + LONG, (&store, &[]));
    place(&mut session, 4, Target::hard(DVec2::Y));
    until_copies(&mut session, now + 2 * LONG, (&store, &[2]));
    settled(&mut session, Action::Undo);
    until_copies(&mut session, now + 3 * LONG, (&store, &[]));
}

#[test]
fn copies_are_made_no_oftener_than_every_few_seconds() {
    let (folder, mut session) = with_dome();
    let store = folder.path().join("recovery");
    session.keep_copies_in(store.clone());
    place(&mut session, 3, Target::hard(DVec2::X));
    let now = Instant::now();
    until_copies(&mut session, now, (&store, &[1]));
    place(&mut session, 4, Target::hard(DVec2::Y));
    for _ in 0..50 {
        session.poll_at(now + Duration::from_secs(1));
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(pins_in_copies(&store), [1]);
    until_copies(&mut session, now + LONG, (&store, &[2]));
    session.close();
}

#[test]
fn a_discarded_copy_is_gone_and_nothing_else_ever_is() {
    let (folder, mut doomed) = with_dome();
    let store = folder.path().join("recovery");
    doomed.keep_copies_in(store.clone());
    place(&mut doomed, 3, Target::hard(DVec2::X));
    until_copies(&mut doomed, Instant::now() + LONG, (&store, &[1]));
    let own = folder.path().join("own.freebound");
    settled(&mut doomed, Action::SaveProject(own.clone()));
    place(&mut doomed, 4, Target::hard(DVec2::X));
    until_copies(&mut doomed, Instant::now() + 2 * LONG, (&store, &[2]));
    drop(doomed);

    let mut next = after_release(&store);
    let found = next.recoverable()[0].clone();
    assert_eq!((found.name.as_str(), found.project.as_ref()), ("own", Some(&own)));
    for action in [Action::DiscardRecovery(own.clone()), Action::Recover(own.clone())] {
        settled(&mut next, action);
        assert!(own.is_file() && next.model().is_none());
    }
    settled(&mut next, Action::DiscardRecovery(found.path));
    assert!(next.recoverable().is_empty() && copies(&store).is_empty());
    assert_eq!(fs::read_dir(&store).unwrap().count(), 0, "the lock is gone too");
}

#[test]
fn a_copy_that_cannot_be_opened_stays_for_another_day() {
    let (folder, mut doomed) = with_dome();
    let store = folder.path().join("recovery");
    doomed.keep_copies_in(store.clone());
    place(&mut doomed, 3, Target::hard(DVec2::X));
    until_copies(&mut doomed, Instant::now() + LONG, (&store, &[1]));
    drop(doomed);
    // A mesh that was only moved nearby would be found.
    let (away, far) = (tempfile::tempdir().unwrap(), "dome.obj");
    fs::copy(folder.path().join("dome.obj"), away.path().join(far)).unwrap();
    fs::remove_file(folder.path().join("dome.obj")).unwrap();
    let mut next = after_release(&store);
    let path = next.recoverable()[0].path.clone();
    settled(&mut next, Action::Recover(path));
    assert!(errors(&next)[0].contains("dome.obj") && next.model().is_none());
    assert_eq!(next.recoverable().len(), 1);
    assert_eq!(with_recovery(&store).recoverable().len(), 1);
    settled(&mut next, Action::LocateMesh(away.path().join(far)));
    assert_eq!(next.document().targets.len(), 1, "{:?}", next.messages());
    assert!(next.has_unsaved_work() && errors(&next).is_empty());
}

#[test]
fn a_folder_that_takes_no_copies_is_said_once() {
    let (folder, mut session) = with_dome();
    let store = folder.path().join("dome.obj").join("recovery");
    session.keep_copies_in(store.clone());
    for round in 1..5 {
        place(&mut session, round, Target::hard(DVec2::new(f64::from(round), 0.0)));
        session.poll_at(Instant::now() + round * LONG);
        session.poll();
    }
    let store = store.display().to_string();
    assert_eq!(errors(&session).iter().filter(|text| text.contains(&store)).count(), 1);
}

/// Starts this test program as a child that runs one test in a folder.
fn child(test: &str, folder: &Path) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--ignored", "--exact", test]).env(FOLDER_OF_CHILD, folder);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the tests can be started")
}

/// Kills a child some time after its first write, later in each round.
fn killed(mut child: Child, sign: &Path, round: u32) {
    let begun = Instant::now();
    while !sign.exists() {
        assert!(begun.elapsed() < LONG && child.try_wait().unwrap().is_none(), "the child wrote nothing");
        std::thread::sleep(Duration::from_micros(500));
    }
    std::thread::sleep(Duration::from_micros(u64::from(round) * 733));
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Opens the dome and pins `count` vertices, each at a numbered target.
fn with_pins(folder: &Path, count: u32) -> Session {
    let mut session = session();
    settled(&mut session, Action::Open(folder.join("dome.obj")));
    for vertex in 0..count {
        session.handle(Action::Place { vertex: id(vertex), target: numbered(vertex) });
    }
    session
}

fn numbered(vertex: u32) -> Target {
    Target::hard(DVec2::new(f64::from(vertex), 1.0 / 3.0))
}

#[test]
#[ignore = "the child of a_project_is_whole_whenever_its_writer_is_killed"]
fn child_saves_two_projects_by_turns() {
    let Some(folder) = std::env::var_os(FOLDER_OF_CHILD).map(PathBuf::from) else { return };
    let mut sessions = vec![with_pins(&folder, 0), with_pins(&folder, 30)];
    loop {
        for session in &mut sessions {
            settled(session, Action::SaveProject(folder.join("work.freebound")));
            fs::write(folder.join("sign"), "").unwrap();
        }
    }
}

#[test]
fn a_project_is_whole_whenever_its_writer_is_killed() {
    let folder = tempfile::tempdir().unwrap();
    write_dome(&folder.path().join("dome.obj"), 6, 4);
    let (path, sign) = (folder.path().join("work.freebound"), folder.path().join("sign"));
    let mut seen = [0, 0];
    // On a busy machine all kills may hit one of the projects; further, later ones follow.
    for round in 0..MOST_KILLS {
        if round >= KILLS && !seen.contains(&0) {
            break;
        }
        fs::remove_file(&sign).ok();
        killed(child("session::recovery::child_saves_two_projects_by_turns", folder.path()), &sign, round);
        let project = ProjectFile::read(&path).unwrap_or_else(|error| panic!("round {round}: {error}"));
        match project.pins.targets.len() {
            0 => seen[0] += 1,
            30 => seen[1] += 1,
            count => panic!("{count} pins are of neither project"),
        }
        assert_eq!(copies(folder.path()), std::slice::from_ref(&path), "what is half-written is not called a project");
    }
    assert!(seen[0] > 0 && seen[1] > 0, "the kills came at different moments: {seen:?}");
}

#[test]
#[ignore = "the child of the_work_of_a_killed_session_is_recovered"]
fn child_works_and_keeps_copies() {
    let Some(folder) = std::env::var_os(FOLDER_OF_CHILD).map(PathBuf::from) else { return };
    let mut session = with_pins(&folder, 0);
    settle(&mut session);
    session.keep_copies_in(folder.join("recovery"));
    let begun = Instant::now();
    for round in 0.. {
        let vertex = round % 35;
        session.handle(Action::Place { vertex: id(vertex), target: numbered(vertex) });
        session.poll_at(begun + (round + 1) * LONG);
        std::thread::sleep(Duration::from_micros(300));
        if copies(&folder.join("recovery")).len() == 1 {
            fs::write(folder.join("sign"), "").unwrap();
        }
    }
}

#[test]
fn the_work_of_a_killed_session_is_recovered() {
    let folder = tempfile::tempdir().unwrap();
    write_dome(&folder.path().join("dome.obj"), 6, 4);
    let (store, sign) = (folder.path().join("recovery"), folder.path().join("sign"));
    for round in 0..KILLS / 2 {
        fs::remove_file(&sign).ok();
        killed(child("session::recovery::child_works_and_keeps_copies", folder.path()), &sign, round);
        let mut session = with_recovery(&store);
        assert_eq!(session.recoverable().len(), 1, "round {round}");
        let path = session.recoverable()[0].path.clone();
        settled(&mut session, Action::Recover(path));
        let pins = &session.document().targets;
        assert!(!pins.is_empty() && session.has_unsaved_work(), "{:?}", session.messages());
        assert!((0..).zip(pins).all(|(n, (vertex, pin))| *vertex == id(n) && *pin == numbered(n)), "{pins:?}");
        session.close();
        assert!(copies(&store).is_empty());
    }
}
