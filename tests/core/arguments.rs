//! What can be typed: options of `flatten`, and names of choices.

use clap::{CommandFactory as _, Parser as _};
use freebound::cli::{Arguments, Command, FlattenArguments};
use freebound::io::Target;
use freebound::mesh::VertexId;
use freebound::solver::{BoundaryShape, Choice, Family, Growth, Method, Treatment};
use glam::DVec2;

/// The arguments of `flatten` with an option.
fn parsed(option: &str, value: &str) -> Option<FlattenArguments> {
    let arguments = Arguments::try_parse_from(["freebound", "flatten", "mesh.obj", option, value]).ok()?;
    match arguments.command {
        Some(Command::Flatten(arguments)) => Some(*arguments),
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

fn assert_told_apart<C: Choice + PartialEq + std::fmt::Debug>() {
    for &choice in C::ALL {
        assert_eq!(C::named(&choice.written()), Some(choice), "a name of its own");
        assert!(!choice.words().title.is_empty() && !choice.words().about.is_empty(), "{choice:?}");
    }
    assert_eq!(C::named("relax"), None);
}

#[test]
fn every_choice_has_a_name_of_its_own_and_a_line_on_it() {
    assert_told_apart::<Method>();
    assert_told_apart::<BoundaryShape>();
    assert_told_apart::<Family>();
    assert_told_apart::<Treatment>();
    assert_told_apart::<Growth>();
}
