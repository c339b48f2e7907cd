//! Curves of the steps: enlarged, linear or logarithmic, and in files.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::harness::{SIZE, Window, sheet};

/// Window with a sheet after some steps.
fn with_steps() -> Window {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    for _ in 0..3 {
        window.key(Key::Space);
    }
    window
}

/// Name of the enlarged curve, if one shows.
fn enlarged(window: &Window) -> Option<String> {
    let mut images = window.harness.query_all_by_role(Role::Image);
    images.find_map(|node| node.accesskit_node().label().filter(|name| name.starts_with("Enlarged curve: ")))
}

#[test]
fn a_click_on_a_name_enlarges_the_curve_and_escape_closes_it() {
    for size in [SIZE, egui::vec2(640.0, 420.0)] {
        let mut window = with_steps();
        window.click("Enlarge the curve: Equation residual");
        window.harness.set_size(size);
        window.settle();
        let name = enlarged(&window).expect("a large curve");
        assert!(name.contains("Equation residual"), "{name}");
        let plot = window.rect(Role::Image, &name);
        assert!(plot.width() > 300.0 && plot.height() > 150.0 && plot.right() < size.x, "{plot:?}");
        assert!(window.words().iter().any(|words| words == "Step"), "the axis has a name");
        let at = egui::pos2(plot.left() + 66.0, plot.center().y);
        window.click_at(at, Modifiers::NONE);
        assert_eq!(window.editor().session.timeline().shown(), Some(0));
        window.choose("Enlarged curve", "Largest move");
        assert!(enlarged(&window).expect("another curve").contains("Largest move"));
        window.key(Key::Escape);
        assert_eq!(enlarged(&window), None);
    }
}

#[test]
fn the_scale_of_each_curve_is_remembered_and_values_without_a_place_are_marked() {
    let mut window = with_steps();
    let residual = "Curve: |A z| of all equations relative to their terms";
    let by_powers = format!("{residual}; by powers of ten");
    assert!(window.harness.query_by_role_and_label(Role::Image, &by_powers).is_some());
    window.click("Enlarge the curve: Equation residual");
    window.click("Linear");
    window.key(Key::Escape);
    assert!(window.harness.query_by_role_and_label(Role::Image, residual).is_some());
    // The numbers of outer vertices fall to 0 or stay there in some step; 0 has no place among powers of ten.
    window.click("Enlarge the curve: Equation residual");
    window.choose("Enlarged curve", "Crossings");
    let marks = |window: &Window| window.words().iter().filter(|words| *words == "≤ 0").count();
    let before = marks(&window);
    window.click("Logarithmic");
    assert!(marks(&window) > before);
}

#[test]
fn curves_are_written_as_a_table_with_all_digits_and_as_figures() {
    let mut window = with_steps();
    for entry in ["Curves as a table…", "Curves as a drawing…", "Curves as a document…"] {
        window.menu(&["File", "Export", "Steps and curves", entry]);
        window.click("Export");
    }
    let table = std::fs::read_to_string(window.path("sheet-curves.csv")).unwrap();
    let mut rows = table.lines();
    let heads: Vec<&str> = rows.next().expect("heads").split(',').collect();
    assert_eq!(heads[..3], ["Step", "Stage", "Flipped [faces]"]);
    assert_eq!(heads.len(), 13);
    let records = window.editor().session.timeline().records().to_vec();
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len(), records.len());
    let column = heads.iter().position(|head| *head == "Largest move [units of the plane]").expect("a column");
    for (row, record) in rows.iter().zip(&records) {
        assert_eq!(row[column].parse().ok(), record.max_move, "{row:?}");
        assert_eq!(row[1], record.stage.short_words());
    }
    let drawing = std::fs::read_to_string(window.path("sheet-curves.svg")).unwrap();
    assert!(drawing.contains("<svg") && drawing.contains(">Equation residual<") && drawing.contains(">step<"));
    assert!(std::fs::read(window.path("sheet-curves.pdf")).unwrap().starts_with(b"%PDF-"));
}

#[test]
fn pictures_of_all_steps_are_numbered_and_have_one_camera() {
    let mut window = with_steps();
    window.menu(&["File", "Export", "Steps and curves", "Pictures of all steps…"]);
    window.fill_in(Role::TextInput, "Name", "run.svg");
    window.click("Export");
    let count = window.editor().session.timeline().records().len();
    let texts: Vec<String> = (0..count)
        .map(|step| std::fs::read_to_string(window.path(&format!("run-{step:04}.svg"))).expect("a file per step"))
        .collect();
    let size = |text: &String| text.lines().next().map(str::to_owned);
    assert!(count >= 3 && texts.iter().all(|text| size(text) == size(&texts[0])));
    // A camera that follows each step would make all of them equally large.
    let extent = |text: &String| {
        let outline = text.lines().filter(|line| line.starts_with("<path")).find(|line| line.contains("1.000\""));
        let path = outline.and_then(|line| line.split("d=\"").nth(1)).expect("a boundary");
        let xs = path.split(['M', 'L', 'Z', '"']).filter_map(|pair| pair.split(' ').next()?.parse::<f64>().ok());
        xs.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
    };
    let timeline = window.editor().session.timeline();
    let own: Vec<f64> =
        timeline.kept().map(|(_, outcome)| outcome.step.candidate.solution.embedding.bounds().size().x).collect();
    let drawn: Vec<f64> = texts.iter().map(extent).map(|(low, high)| high - low).collect();
    for (own_size, drawn_size) in own.iter().zip(&drawn) {
        assert!((own_size / own[0] - drawn_size / drawn[0]).abs() < 1e-2, "{own:?} {drawn:?}");
    }
}
