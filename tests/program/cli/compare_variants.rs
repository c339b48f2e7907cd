//! `freebound compare`: methods by name, with their weights and shapes.

use std::collections::BTreeSet;
use std::str::FromStr;

use freebound_core::problem::{BoundaryShape, Family, Method, NamedOption, Settings, Variant};
use freebound_io::Column;

use super::compare::{methods, names, tent};
use freebound_testkit::{assert_message, csv_rows};

#[test]
fn every_variant_has_a_name_that_stands_for_it() {
    let base = Settings::default();
    let mut names = BTreeSet::new();
    let mut count = 0;
    for method in Method::ALL {
        let shapes = if method.boundary_shape().is_some() { BoundaryShape::ALL } else { &BoundaryShape::ALL[..1] };
        for method in shapes.iter().map(|shape| method.clone().on_shape(shape.clone())) {
            for &family in Family::ALL.iter().filter(|family| method.uses_family() && family.goes_with(&method)) {
                let variant = Variant { method: method.clone(), family: Some(family) };
                let read = Variant::from_str(&variant.to_string()).expect("its own name");
                assert!(read.settings(&base).resolves_to(&variant.settings(&base)), "{variant}");
                names.insert(variant.to_string());
                count += 1;
            }
            let plain = Variant { method, family: None };
            assert_eq!(Variant::from_str(&plain.to_string()), Ok(plain));
        }
    }
    assert_eq!(names.len(), count);
    for (wrong, topic) in [
        ("best", "unknown-method"),
        ("natural/uniform", "weights-of-a-convex-boundary"),
        ("natural/odd", "unknown-weights"),
        ("lscm/mean-value", "no-choice-of-weights"),
        ("natural@square", "no-choice-of-shape"),
        ("convex@ring", "unknown-shape"),
        ("convex@polygon:0", "no-point"),
        ("lee@polygon:0 0; 0 1; 1 0", "clockwise-polygon"),
        ("", "no-method"),
    ] {
        let error = Variant::from_str(wrong).expect_err(wrong);
        assert_message(&format!("compare-variants-{topic}"), &error);
    }
}

#[test]
fn weights_of_the_settings_are_for_methods_that_name_none_and_go_with_them() {
    let base = Settings { family: Some(Family::Uniform), ..Settings::default() };
    let family = |text: &str| Variant::from_str(text).expect("a variant").settings(&base).family();
    assert_eq!(family("convex"), Family::Uniform);
    assert_eq!(family("natural"), Family::default());
    assert_eq!(family("natural/wachspress"), Family::Wachspress);
    let program = tent();
    let compared = methods(&program, &["tent.obj", "--methods", "natural,convex,lscm", "--family", "mean-value"]);
    assert_eq!(names(&compared), ["natural/mean-value", "convex/mean-value", "lscm"]);
    let compared = methods(&program, &["tent.obj", "--methods", "convex@circle,convex@square"]);
    assert_eq!(names(&compared), ["convex", "convex@square"]);
    assert_eq!((compared[0]["shape"].as_str(), compared[1]["shape"].as_str()), (Some("circle"), Some("square")));
    let compared = methods(&program, &["tent.obj", "--methods", "natural,lee", "--family", "conformal"]);
    assert_eq!(
        names(&compared),
        ["natural", "lee/conformal"],
        "what is asked for is taken, also where it is usual for others"
    );
}

#[test]
fn weights_that_no_method_takes_are_refused_and_the_table_says_which_are_used() {
    let program = tent();
    let with =
        |list: &'static str, family: &'static str| ["compare", "tent.obj", "--methods", list, "--family", family];
    for family in ["uniform", "shape-preserving"] {
        let run = program.run(&with("natural,lscm", family)).expect(2);
        assert_message(&format!("compare-variants-natural-with-{family}"), &run.stderr);
    }
    let run = program.run(&with("natural/mean-value,lscm", "wachspress")).expect(2);
    assert_message("compare-variants-all-name-weights", &run.stderr);
    let arguments = with("natural,convex,lscm", "uniform");
    let run = program.run(&arguments).expect(0);
    let begin = |row: &str| row.split_whitespace().take(2).map(str::to_owned).collect::<Vec<_>>();
    let rows: Vec<Vec<String>> = run.stdout.lines().map(begin).collect();
    for row in [["natural", "conformal"], ["convex/uniform", "uniform"], ["lscm", "–"]] {
        assert!(rows.iter().any(|other| *other == row), "{row:?} is not in\n{}", run.stdout);
    }
    let head = run.stdout.lines().find(|line| line.starts_with(Column::Method.labels().title)).expect("a head");
    assert_message("compare-variants-head-of-the-table", &head.split_whitespace().collect::<Vec<_>>().join(" "));
    let csv = csv_rows(&program.run(&[&arguments[..], &["--csv", "-"]].concat()).expect(0).stdout);
    let at = csv[0].iter().position(|head| head == "family").expect("a column");
    assert_eq!(csv[1..].iter().map(|row| row[at].as_str()).collect::<Vec<_>>(), ["conformal", "uniform", ""]);
}

#[test]
fn what_is_asked_for_counts_even_where_it_is_usual_for_another_method() {
    let program = tent();
    let compared = methods(&program, &["tent.obj", "--methods", "lee,natural", "--family", "conformal"]);
    assert_eq!(names(&compared), ["lee/conformal", "natural"]);
    let compared = methods(&program, &["tent.obj", "--methods", "lee,natural"]);
    assert_eq!(names(&compared), ["lee", "natural"]);
    let slim = |base: &Settings| Variant::from_str("slim").expect("a variant").settings(base).max_steps();
    assert_eq!(slim(&Settings { max_steps: Some(Settings::MAX_STEPS), ..Settings::default() }), Settings::MAX_STEPS);
    assert_eq!(slim(&Settings::default()), 20);
    let twice = ["compare", "tent.obj", "--methods", "lee,lee/mean-value"];
    let run = program.run(&twice).expect(2);
    assert_message("compare-variants-run-twice", &run.stderr);
}
