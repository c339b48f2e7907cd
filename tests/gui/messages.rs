//! Messages of the window on bad files, and during long work.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use freebound::examples::Example;
use freebound::session::{Action, Message, Severity, Status};
use freebound::ui::sentence;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{Surface, Target};
use freebound_core::problem::{Family, Method, Settings};
use freebound_io::read_mesh;
use glam::DVec2;

use crate::dialogs::{ask_where_to_save, name, window};
use crate::harness::{Pill, Window, sheet, write_obj};
use freebound_testkit::{assert_message, corpus, corpus_test};

/// Surface with many holes, which flattens without repair, and a surface with many handles, which is unwrapped.
/// Without optimisation both take minutes.
const SOLVED_FOR_LONG: [&str; 2] = ["holes_plane.obj", "nonmanifold_ArtDemo.obj"];

/// Files of `bad` that can be read as meshes and flattened.
const USABLE: [&str; 3] = ["raw_polygonfaces.obj", "raw_notenoughindices.obj", "degenerate_capsule.obj"];

#[test]
fn a_sentence_has_a_capital_but_a_file_keeps_its_name() {
    assert_eq!(sentence("open"), "Open");
    for words in ["work.freebound: missing", "folder/in", "out.obj, out.mtl"] {
        assert_eq!(sentence(words), words);
    }
}

corpus_test! {
    fn every_bad_file_of_the_corpus_says_what_is_wrong_and_what_to_do() {
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(corpus().join("bad")).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        assert!(files.len() >= 14);
        for file in files {
            let file_name = file.file_name().unwrap().to_string_lossy().into_owned();
            if SOLVED_FOR_LONG.contains(&file_name.as_str()) {
                continue;
            }
            let mut window = window();
            window.open(&file);
            let is_unwrapped = window.editor().session.history().can_undo();
            if is_unwrapped {
                window.give_faults_back();
            }
            let is_error = |message: &&Message| message.severity == Severity::Error;
            let messages: Vec<Message> =
                window.editor().session.messages().iter().filter(is_error).cloned().collect();
            if USABLE.contains(&file_name.as_str()) {
                assert!(messages.is_empty() && !is_unwrapped, "{file_name}: {messages:?}");
                continue;
            }
            assert_eq!(window.has_button("Show faults"), is_unwrapped, "{file_name}");
            if messages.is_empty() {
                assert!(is_unwrapped, "{file_name}");
                continue;
            }
            for message in &messages {
                assert!(message.remedy.as_ref().is_some_and(|remedy| !remedy.is_empty()), "{file_name}: {message:?}");
            }
            let newest = messages.last().expect("a message");
            assert!(window.shows(&sentence(&newest.text)), "{file_name}: {:?}", window.words());
            assert!(window.has_button("Dismiss") && window.has_button("Copy"), "{file_name}");
            if read_mesh(&file).is_err() {
                assert_eq!(name(&window), "sheet.obj", "what cannot be read replaces nothing");
                assert!(window.is_proved(), "{}", window.verdict());
            } else {
                assert_eq!(name(&window), file_name);
                assert!(window.is_faulty(), "{}", window.verdict());
            }
            try_everything(&mut window);
        }
    }
}

/// Performs many user actions, to check that nothing panics.
fn try_everything(window: &mut Window) {
    for key in [Key::F, Key::D, Key::W, Key::Num4, Key::Num2, Key::P, Key::Delete, Key::Escape] {
        window.key(key);
    }
    for modifiers in [Modifiers::NONE, Modifiers::SHIFT] {
        window.click_at(window.mesh_view().center(), modifiers);
        window.click_at(window.plane_view().center(), modifiers);
    }
    for tab in ["Pins", "Vertex"] {
        window.click(tab);
    }
    window.editor_mut().session.handle(Action::Fix(vec![VertexId::new(0)]));
    window.editor_mut().session.handle(Action::Solve);
    window.press(Modifiers::COMMAND, Key::Z);
    window.key(Key::G);
    window.type_text("1");
    window.key(Key::Enter);
    window.key(Key::Escape);
    ask_where_to_save(window);
    window.key(Key::Escape);
}

#[test]
fn a_message_is_copied_gone_to_and_dismissed() {
    let mut window = window();
    let mut bad = sheet(4, 0.3);
    bad.triangles[12].reverse();
    write_obj(&window.path("bad.obj"), &bad);
    let file = window.path("bad.obj");
    window.open(&file);
    window.give_faults_back();
    let messages = window.editor().session.messages();
    let message = messages.iter().rev().find(|message| message.severity == Severity::Error).expect("a fault").clone();
    let Some(Surface::Faulty(..)) = window.editor().session.model().map(|model| &model.prepared.surface) else {
        panic!("a face is turned over")
    };
    window.harness.get_by_label("Copy").click();
    window.step();
    let copied = window
        .harness
        .output()
        .platform_output
        .commands
        .iter()
        .any(|command| matches!(command, egui::OutputCommand::CopyText(text) if text.contains(&message.text)));
    assert!(copied, "{:?}", window.harness.output().platform_output.commands);
    window.click("Go to");
    let selected: Vec<VertexId> = window.editor().selection.vertices().iter().copied().collect();
    let mut expected = message.vertices.clone();
    expected.sort_unstable();
    assert_eq!(selected, expected);
    let count = window.editor().session.messages().len();
    window.click("Dismiss");
    assert_eq!(window.editor().session.messages().len(), count - 1);
    assert!(window.editor().session.messages().iter().all(|left| left.id != message.id));
}

#[test]
fn a_good_mesh_after_a_bad_one_takes_its_messages_away() {
    let mut window = window();
    std::fs::write(window.path("broken.obj"), "v 0 0\nf 1 2 3\n").unwrap();
    let file = window.path("broken.obj");
    window.open(&file);
    assert!(!window.editor().session.messages().is_empty());
    window.menu(&["File", "Examples", "Flat L"]);
    assert!(window.editor().session.messages().is_empty());
    assert!(!window.has_button("Dismiss"));
}

/// Window during a long solve.
fn at_work() -> Window {
    let mut window = Window::with_mesh("large.obj", &sheet(120, 0.3));
    window.editor_mut().session.handle(Action::SetSettings(slow(Family::MeanValue)));
    window
}

fn slow(family: Family) -> Settings {
    Settings::new(Method::Natural, family)
}

#[test]
fn a_long_solve_is_cancelled_at_once() {
    let mut window = at_work();
    let before = window.outcome();
    assert!(window.editor().session.busy().is_some());
    let start = Instant::now();
    window.editor_mut().session.handle(Action::Cancel);
    while window.editor().session.busy().is_some() {
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
        window.step();
    }
    assert!(Arc::ptr_eq(&before, &window.outcome()), "what was there stays");
    assert!(matches!(window.editor().session.status(), Status::Stale), "{}", window.verdict());
    assert_eq!(window.pill(), Pill::Stale);
    window.press(Modifiers::COMMAND, Key::Enter);
    assert_eq!(window.outcome().problem.settings, slow(Family::MeanValue), "and can be solved again");
}

#[test]
fn a_newer_request_replaces_an_older_one() {
    let mut window = at_work();
    window.step();
    window.editor_mut().session.handle(Action::SetSettings(slow(Family::Wachspress)));
    window.editor_mut().session.handle(Action::SetSettings(slow(Family::Power(0.5))));
    window.settle();
    assert_eq!(window.outcome().problem.settings, slow(Family::Power(0.5)));
    assert!(window.editor().session.is_current());
}

#[test]
fn the_newer_of_two_meshes_opens() {
    let mut window = window();
    let session = &mut window.editor_mut().session;
    session.handle(Action::OpenExample(Example::BumpyCap));
    session.handle(Action::OpenExample(Example::Ell));
    window.settle();
    assert_eq!(name(&window), Example::Ell.title());
}

#[test]
fn the_window_answers_while_a_solve_runs() {
    let mut window = at_work();
    window.key_now(Key::W);
    assert!(window.editor().pane_shading.wireframe && window.editor().session.busy().is_some(), "no waiting");
    let slowest = (0..10).map(|_| {
        let start = Instant::now();
        window.step();
        start.elapsed()
    });
    assert!(slowest.max().expect("ten frames") < Duration::from_millis(500));
}

/// Clicks a message's link to its vertices.
fn go_to(window: &mut Window, name: &str, vertices: &[u32]) {
    window.click(name);
    let selected: Vec<u32> = window.editor().selection.vertices().iter().map(|vertex| vertex.number()).collect();
    assert_eq!(selected, vertices);
}

#[test]
fn pins_on_one_place_are_gone_to_from_the_message() {
    let mut window = window();
    for vertex in [3, 17] {
        let target = Target::hard(DVec2::new(0.5, 0.25));
        window.editor_mut().session.handle(Action::Place { vertex: VertexId::new(vertex), target });
    }
    window.settle();
    let message = window.editor().session.messages()[0].clone();
    assert_eq!(message.vertices, [3, 17].map(VertexId::new));
    assert_message("messages-window-pins-at-one-place", &message.text);
    go_to(&mut window, "Go to vertices v3, v17", &[3, 17]);
}

#[test]
fn the_vertex_of_a_constraint_that_cannot_be_is_gone_to_from_the_message() {
    let cases = [
        ("not-finite", "3 0 0\n17 inf 0\n", "Go to vertex v17", &[17][..]),
        ("negative-weight", "3 0 0 -1\n", "Go to vertex v3", &[3]),
        ("vertex-twice", "3 0 0\n3 1 1\n", "Go to vertex v3", &[3]),
        ("target-twice", "3 0 0\n5 1 1\n17 0 0\n", "Go to vertices v17, v3", &[3, 17]),
    ];
    for (case, text, offer, vertices) in cases {
        let mut window = window();
        std::fs::write(window.path("pins.txt"), text).expect("written");
        let file = window.path("pins.txt");
        window.editor_mut().session.handle(Action::ImportConstraints(file));
        window.settle();
        let message = window.editor().session.messages()[0].clone();
        assert!(message.remedy.is_some(), "{message:?}");
        assert_message(&format!("messages-window-{case}"), &message.text);
        go_to(&mut window, offer, vertices);
    }
}

#[test]
fn a_constraint_of_a_vertex_that_there_is_not_offers_no_way_to_it() {
    let mut window = window();
    std::fs::write(window.path("pins.txt"), "12345 0 0\n").expect("written");
    let file = window.path("pins.txt");
    window.editor_mut().session.handle(Action::ImportConstraints(file));
    window.settle();
    assert_message("messages-window-no-such-vertex", &window.editor().session.messages()[0].text);
    assert!(!window.has_button("Go to vertex v12345") && window.has_button("Dismiss"));
}

#[test]
fn pins_of_a_project_that_the_mesh_has_no_vertices_for_are_named() {
    let mut window = window();
    window.editor_mut().session.handle(Action::Fix([0, 40, 41, 48].map(VertexId::new).to_vec()));
    window.settle();
    window.press(Modifiers::COMMAND, Key::S);
    window.click("Save");
    write_obj(&window.path("sheet.obj"), &sheet(2, 0.3));
    let project = window.path("sheet.freebound");
    window.open(&project);
    let texts: Vec<String> = window.editor().session.messages().iter().map(|m| m.text.clone()).collect();
    let of_pins = texts.iter().find(|text| ["v40", "v41", "v48"].iter().all(|vertex| text.contains(vertex)));
    assert_message("messages-window-pins-left-out", of_pins.unwrap_or_else(|| panic!("{texts:?}")));
}

#[test]
fn faults_of_one_file_form_one_group_that_unfolds() {
    let mut window = window();
    let name = |window: &Window, file: &str| window.path(file);
    for (file, text) in [("first.txt", "3 0 0\n17 inf 0\n"), ("second.txt", "3 0 0 -1\n")] {
        std::fs::write(name(&window, file), text).expect("written");
    }
    for file in ["first.txt", "second.txt", "first.txt", "first.txt"] {
        let path = name(&window, file);
        window.editor_mut().session.handle(Action::ImportConstraints(path));
        window.settle();
    }
    let bars = |window: &Window| window.harness.query_all_by_label("Dismiss").count();
    assert_eq!((window.editor().session.messages().len(), bars(&window)), (4, 2), "one bar a file");
    window.click("Show 2 more problems of first.txt");
    assert_eq!(bars(&window), 4);
    window.click("Hide 2 more problems of first.txt");
    assert_eq!(bars(&window), 2);
    window.click("Dismiss these 3");
    let left: Vec<_> = window.editor().session.messages().iter().map(|message| message.about.clone()).collect();
    assert_eq!(left, [Some(name(&window, "second.txt"))]);
}
