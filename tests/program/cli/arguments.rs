//! Command-line values: options of `flatten`, and names of choices.

use clap::{CommandFactory as _, Parser as _};
use freebound::cli::{Arguments, FlattenArguments, Subcommands};
use freebound_core::geom::ConvexPolygon;
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;
use freebound_core::problem::{BoundaryShape, Family, Growth, Method, NamedOption, Settings, Spacing, Treatment};
use glam::DVec2;

use super::program::Program;

/// Arguments of `flatten` with an option.
fn parsed(option: &str, value: &str) -> Option<FlattenArguments> {
    let arguments = Arguments::try_parse_from(["freebound", "flatten", "mesh.obj", option, value]).ok()?;
    match arguments.command {
        Some(Subcommands::Flatten(arguments)) => Some(*arguments),
        other => panic!("not flatten: {other:?}"),
    }
}

#[test]
fn the_arguments_hold_together() {
    Arguments::command().debug_assert();
}

#[test]
fn a_pin_is_a_vertex_and_two_numbers_and_perhaps_a_weight() {
    let uv = DVec2::new(0.5, -2.0);
    let pins = |text: &str| parsed("--pin", text).map(|arguments| arguments.solve.pins);
    assert_eq!(pins("7:0.5,-2").unwrap(), [(VertexId::new(7), Target::hard(uv))]);
    assert_eq!(pins("7:0.5,-2:3e2").unwrap(), [(VertexId::new(7), Target::weighted(uv, 300.0))]);
    for wrong in ["", "7", "7:1", "7:1,x", "-1:0,0", "7:1,2,3", "7:1,2:", "7:1,2:x", "7:1,2:0", "7:1,2:-1", "7:1,2:inf"]
    {
        assert!(pins(wrong).is_none(), "{wrong}");
    }
}

#[test]
fn an_aspect_is_a_width_and_a_height() {
    let aspect = |text: &str| parsed("--aspect", text)?.solve.aspect;
    assert_eq!(aspect("3:2").unwrap().to_bits(), 1.5_f64.to_bits());
    for wrong in ["", "3", "3:0", "0:3", "-3:2", "nan:1", "inf:1", "3x2", "1e300:1e-300"] {
        assert!(aspect(wrong).is_none(), "{wrong}");
    }
}

fn assert_told_apart<C: NamedOption + PartialEq + std::fmt::Debug>() {
    for choice in C::ALL {
        assert_eq!(C::named(&choice.written()), Some(choice.clone()), "a name of its own");
        assert!(!choice.labels().title.is_empty() && !choice.labels().about.is_empty(), "{choice:?}");
    }
    assert_eq!(C::named("relax"), None);
}

#[test]
fn every_choice_has_a_name_of_its_own_and_a_line_on_it() {
    assert_told_apart::<Method>();
    assert_told_apart::<BoundaryShape>();
    assert_told_apart::<Spacing>();
    assert_told_apart::<Family>();
    assert_told_apart::<Treatment>();
    assert_told_apart::<Growth>();
}

#[test]
fn a_boundary_is_a_name_or_corners() {
    let shape = |text: &str| parsed("--boundary", text)?.boundary.map(|typed| typed.shape);
    assert_eq!(shape("hull"), Some(BoundaryShape::Hull));
    let triangle = ConvexPolygon::parse("0 0\n1 0\n0 1").expect("convex");
    assert_eq!(shape("polygon:0 0; 1 0; 0,1"), Some(BoundaryShape::Polygon(triangle)));
    assert_eq!(
        BoundaryShape::named("polygon:0 0; 1 0; 0 1").map(|shape| shape.written().into_owned()).as_deref(),
        Some("polygon:0 0; 1 0; 0 1")
    );
    for wrong in ["heart", "polygon", "polygon:", "polygon:0 0; 1 0", "polygon:0 0; 1 0; 2 0", "polygon:0 0; 0 1; 1 0"]
    {
        assert!(shape(wrong).is_none(), "{wrong}");
    }
}

#[test]
fn what_is_not_typed_follows_from_the_method() {
    let settings = |method: &str| parsed("--method", method).expect("a method").settings();
    assert_eq!(settings("slim").max_steps(), 20);
    assert_eq!(settings("stretch").max_steps(), Settings::MAX_STEPS);
    assert_eq!((settings("lee").family(), settings("lee").layers), (Family::MeanValue, Settings::LAYERS));
    assert_eq!((settings("convex").family(), settings("convex").spacing), (Family::Conformal, Spacing::Chord));
    let limited = parsed("--max-steps", "60").expect("a number").settings();
    assert_eq!(limited.by(Method::Slim).max_steps(), 60, "asked for, though usual for auto");
    assert_eq!(Settings::default().by(Method::Slim).max_steps(), 20);
    assert_eq!(parsed("--layers", "7").expect("a number").settings().layers, 7);
    assert!(parsed("--layers", "0").is_none() && parsed("--layers", "101").is_none());
}

#[test]
fn completions_and_manual_pages_name_every_command() {
    let program = Program::new();
    let commands: Vec<String> =
        Arguments::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = program.run(&["completions", shell]).expect(0).stdout;
        assert!(commands.iter().all(|command| text.contains(command.as_str())), "{shell}");
        assert!(text.contains("--distortion") || text.contains("distortion"), "{shell}");
    }
    program.run(&["man", "pages"]).expect(0);
    for name in
        commands.iter().map(|command| format!("pages/freebound-{command}.1")).chain(["pages/freebound.1".into()])
    {
        let page = std::fs::read_to_string(program.path(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(page.contains(".SH NAME") && page.contains(".SH OPTIONS"), "{name}");
    }
    let unwrap = std::fs::read_to_string(program.path("pages/freebound-unwrap.1")).expect("a page");
    assert!(unwrap.contains("freebound unwrap") || unwrap.contains("freebound\\-unwrap"), "{unwrap}");
}
