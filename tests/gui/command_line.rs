//! The document as a command line.

use clap::Parser as _;
use eframe::egui;
use egui_kittest::kittest::Queryable as _;
use freebound::cli::{Arguments, FlattenArguments, Subcommands};
use freebound::session::Action;
use freebound_core::mesh::VertexId;
use freebound_core::problem::{BoundaryShape, Family, Method, PinKind, Settings, Treatment};

use crate::harness::{Window, sheet};

/// Text that the menu copies.
fn copied(window: &mut Window) -> String {
    window.menu(&["File", "Export"]);
    window.harness.get_by_label("Copy as command line").click();
    for _ in 0..4 {
        window.step();
        let commands = window.harness.output().platform_output.commands.clone();
        let text = commands.into_iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text),
            _ => None,
        });
        if let Some(text) = text {
            return text;
        }
    }
    panic!("nothing was copied");
}

/// Words of a command as a shell splits them, without comments.
fn words(text: &str) -> Vec<String> {
    let line = text.lines().find(|line| !line.starts_with('#')).expect("a command");
    let (mut words, mut is_quoted, mut is_escaped) = (vec![String::new()], false, false);
    for c in line.chars() {
        match c {
            _ if is_escaped => {
                words.last_mut().unwrap().push(c);
                is_escaped = false;
            }
            '\'' => is_quoted = !is_quoted,
            '\\' if !is_quoted => is_escaped = true,
            ' ' if !is_quoted => words.push(String::new()),
            _ => words.last_mut().unwrap().push(c),
        }
    }
    words
}

fn parsed(text: &str) -> FlattenArguments {
    let arguments = Arguments::try_parse_from(words(text)).unwrap_or_else(|error| panic!("{text}: {error}"));
    match arguments.command {
        Some(Subcommands::Flatten(arguments)) => *arguments,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_copied_command_has_the_settings_and_pins_of_the_document() {
    let mut window = Window::with_mesh("it's a sheet.obj", &sheet(5, 0.3));
    let pins = [0, 5, 35].map(VertexId::new).to_vec();
    window.editor_mut().session.handle(Action::Fix(pins.clone()));
    window.editor_mut().session.handle(Action::SetPinKind { vertices: pins[..1].to_vec(), kind: PinKind::Soft(2.5) });
    for settings in [
        Settings::default(),
        Settings { treatment: Some(Treatment::LeastSquares), ..Settings::new(Method::Natural, Family::Power(1.5)) },
        Settings { max_steps: Some(7), relax_rounds: Some(3), ..Settings::new(Method::Iterate, Family::MeanValue) },
        Settings::new(Method::Convex(BoundaryShape::Square), Family::Uniform),
    ] {
        window.editor_mut().session.handle(Action::SetSettings(settings.clone()));
        window.settle();
        let text = copied(&mut window);
        let arguments = parsed(&text);
        assert_eq!(arguments.settings(), settings, "{text}");
        assert!(arguments.idle_option().is_none(), "{text}");
        assert_eq!(arguments.input.mesh, window.path("it's a sheet.obj"));
        let targets = &window.editor().session.document().targets;
        let expected = if settings.method.uses_pins() { targets.len() } else { 0 };
        assert_eq!(arguments.solve.pins.len(), expected, "{text}");
        for (vertex, target) in &arguments.solve.pins {
            assert_eq!(target.uv, targets[vertex].uv, "{text}");
            assert_eq!(matches!(target.kind, PinKind::Soft(_)), matches!(targets[vertex].kind, PinKind::Soft(_)));
        }
    }
}

#[test]
fn comments_say_what_the_command_does_not_express() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(5, 0.3));
    let before = copied(&mut window);
    window.editor_mut().session.handle(Action::TurnFaces);
    window.settle();
    let text = copied(&mut window);
    assert!(text.lines().filter(|line| line.starts_with('#')).count() > before.matches('#').count(), "{text}");
    parsed(&text);
    let all: Vec<VertexId> = (0..36).map(VertexId::new).collect();
    window.editor_mut().session.handle(Action::Fix(all));
    window.settle();
    let text = copied(&mut window);
    assert!(text.contains("sheet-constraints.txt"), "{text}");
    assert!(parsed(&text).solve.constraints.is_some());
}
