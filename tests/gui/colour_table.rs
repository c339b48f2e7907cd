//! Faces coloured by a column of a table.

use freebound::session::Severity;
use freebound::ui::{Pane, ShadingMode};
use freebound::view::Scale;
use freebound_core::mesh::FaceId;

use crate::harness::{Window, sheet};

/// Window with a sheet, and a table with this text opened.
fn with_table(text: &str) -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(4, 0.3));
    std::fs::write(window.path("numbers.csv"), text).unwrap();
    window.menu(&["File", "Colour by column…"]);
    window.click("numbers.csv");
    window.click("Open");
    while window.editor().files.table.is_reading() {
        window.step();
    }
    window.settle();
    window
}

/// Table with a row for each of `count` elements.
fn table(head: &str, count: usize, row: impl Fn(usize) -> String) -> String {
    std::iter::once(head.to_owned()).chain((0..count).map(row)).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_column_colours_both_panes_with_a_legend_and_another_is_chosen() {
    let mut window = with_table(&table("height,balance", 25, |k| format!("{k},{}", k as f64 - 12.0)));
    assert_eq!(window.shadings(), [ShadingMode::Column; 2]);
    let paint = |window: &Window| window.editor().pane_shading.paint(Pane::Plane).expect("coloured").clone();
    let legend = paint(&window).legend.expect("a legend");
    assert_eq!(legend.scale, Scale::Column);
    assert!(legend.range.low > 0.0 && legend.range.high < 24.0, "faces take the mean of their corners");
    assert!(window.shows("height (vertex)"));
    let before = paint(&window).faces;
    window.menu(&["View", "Shading of the mesh", "Column: balance"]);
    let legend = paint(&window).legend.expect("a legend");
    assert_eq!(legend.scale, Scale::SignedColumn);
    assert_eq!(legend.range.low, -legend.range.high);
    assert!(window.shows("balance (vertex)") && !std::sync::Arc::ptr_eq(&before, &paint(&window).faces));
}

#[test]
fn a_row_for_each_face_colours_the_faces_as_they_are() {
    let window = with_table(&table("area", 32, |k| format!("{k}")));
    let paint = window.editor().pane_shading.paint(Pane::Mesh).expect("coloured");
    let legend = paint.legend.as_ref().expect("a legend");
    assert_eq!([legend.range.low, legend.range.high], [0.0, 31.0]);
    let disk = window.editor().session.model().and_then(|model| model.disk()).cloned().expect("a disk");
    assert_eq!(disk.faces().last(), Some(FaceId::new(31)));
    assert!(window.shows("area (face)"));
}

#[test]
fn a_table_that_does_not_fit_says_so_with_its_line_and_a_remedy() {
    for (text, part) in [("x\n1\n2\n", "2 rows"), ("vertex,x\n3,1\n77,2\n", "line 3")] {
        let window = with_table(text);
        assert_ne!(window.shadings(), [ShadingMode::Column; 2]);
        let message = &window.editor().session.messages()[0];
        assert_eq!(message.severity, Severity::Error);
        assert!(message.text.contains(part) && message.remedy.is_some(), "{}", message.text);
    }
}

#[test]
fn another_mesh_forgets_the_table() {
    let mut window = with_table(&table("height", 25, |k| format!("{k}")));
    let path = window.path("second.obj");
    crate::harness::write_obj(&path, &sheet(6, 0.2));
    window.open(&path);
    assert_eq!(window.editor().files.table.chosen(), None);
    assert_eq!(window.shadings(), [ShadingMode::Checker; 2]);
}
