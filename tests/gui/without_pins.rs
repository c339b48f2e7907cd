//! Methods that iterate within a single step, chosen in the list: a step of each, and its convergence in the
//! tooltip.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use freebound_core::mesh::DiskMesh;
use freebound_core::problem::{Method, NamedOption as _, Stop};

use crate::harness::{Window, sheet};

/// Name of the only step in the timeline.
fn name_of_step(window: &Window) -> String {
    let mut names = window.controls().into_iter().map(|(_, name, _)| name);
    names.find(|name| name.starts_with("Step 0: ")).expect("a step in the row")
}

#[test]
fn spectral_and_angle_based_maps_are_chosen_by_their_names_and_say_how_they_converged() {
    let mesh = sheet(8, 0.5);
    let mut window = Window::with_mesh("sheet.obj", &mesh);
    let mut seen = Vec::new();
    for method in [Method::AbfPlusPlus, Method::Abf, Method::Spectral] {
        window.choose("Method", method.labels().title);
        assert_eq!(window.editor().session.document().settings.method, method);
        let outcome = window.outcome();
        assert_eq!(
            (outcome.problem.settings.method.clone(), outcome.step.candidate.stage.name(), outcome.step.index),
            (method.clone(), method.name(), 0)
        );
        let found = outcome.step.candidate.solution.convergence.expect("it says how it ended");
        assert_eq!(found.stop, Stop::Converged, "{}", method.name());
        assert!(window.is_proved(), "{}", window.verdict());
        let name = name_of_step(&window);
        window.harness.get_by_role_and_label(Role::Button, &name).hover();
        for _ in 0..60 {
            window.step();
        }
        let words = format!("{}: {}", found.steps, found.stop.words());
        assert!(window.shows(&words), "{words} in {:?}", window.words());
        seen.push(window.embedding());
    }
    let disk = DiskMesh::try_from(mesh).expect("a sheet is a disk");
    let off = |a: usize, b: usize| {
        let apart = disk.vertices().map(|v| seen[a][v].distance(seen[b][v]));
        apart.fold(0.0, f64::max)
    };
    assert!(off(0, 1) < 1e-6, "both systems have the same angles: {}", off(0, 1));
    assert!(off(0, 2) > 1e-3, "and a spectral map has others: {}", off(0, 2));
}
