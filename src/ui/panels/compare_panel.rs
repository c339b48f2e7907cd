//! Comparison of two steps: the numbers of both, and their differences.

use eframe::egui;

use crate::session::{StepDistortion, Timeline};
use crate::ui::{Editor, Measure, figures, heads, short};
use freebound_core::pipeline::Outcome;

/// Width of a number, characters.
const FIGURE: usize = 8;

/// Number of both steps.
struct Row {
    name: &'static str,
    values: [f64; 2],
    is_count: bool,
}

impl Row {
    fn words(&self) -> [String; 3] {
        let [before, now] = self.values;
        let difference = now - before;
        let word = |value: f64| if self.is_count { format!("{value:.0}") } else { short(value) };
        let sign = if difference > 0.0 { "+" } else { "" };
        [word(before), word(now), format!("{sign}{}", word(difference))]
    }
}

/// Shows the numbers of the compared step and of the step on the screen, and their differences.
pub(super) fn comparison(ui: &mut egui::Ui, editor: &Editor) {
    let timeline = editor.session.timeline();
    let on_screen = editor.step_on_screen().and_then(|outcome| timeline.index_of(outcome));
    let Some([before, now]) = timeline.compared().zip(on_screen).map(<[usize; 2]>::from) else { return };
    if before == now {
        return;
    }
    ui.strong("Compared");
    egui::Grid::new("compared").num_columns(4).spacing([8.0, 4.0]).show(ui, |ui| {
        ui.label("");
        heads(ui, FIGURE, &[format!("step {before}"), format!("step {now}"), "change".to_owned()]);
        ui.end_row();
        for row in rows(timeline, [before, now]) {
            let label = ui.label(row.name);
            if let Some(measure) = Measure::called(row.name) {
                label.on_hover_text(measure.tip());
            }
            figures(ui, row.name, FIGURE, &row.words());
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}

fn rows(timeline: &Timeline, steps: [usize; 2]) -> Vec<Row> {
    let count = |name, of: fn(&freebound_io::StepReport) -> usize| {
        let values = steps.map(|step| timeline.records().get(step).map_or(f64::NAN, |record| of(record) as f64));
        Row { name, values, is_count: true }
    };
    let standing = |name, of: fn(&StepDistortion) -> Option<f64>| {
        let values = steps.map(|step| timeline.standings().get(step).and_then(of).unwrap_or(f64::NAN));
        Row { name, values, is_count: false }
    };
    let measured = |name, of: fn(&Outcome) -> f64| {
        let values = steps.map(|step| timeline.outcome(step).map_or(f64::NAN, |outcome| of(outcome)));
        Row { name, values, is_count: false }
    };
    let all = [
        count("Flipped", |record| record.flipped_faces),
        count("Crossings", |record| record.boundary_crossings),
        count("Concave", |record| record.concave_polygons),
        count("Holes", |record| record.crossed_holes),
        count("Overwound", |record| record.overwound_vertices),
        count("Outside hull", |record| record.outside_hull_vertices),
        measured("Angle", |outcome| outcome.distortion.summary.angle.mean),
        measured("Area", |outcome| outcome.distortion.summary.area.mean),
        measured("Stretch", |outcome| outcome.distortion.summary.stretch_l2),
        standing("Energy", |standing| Some(standing.progress?.energy)),
        standing("Distance", |standing| Some(standing.progress?.distance_left)),
    ];
    let has_both = |row: &Row| row.values.iter().all(|value| !value.is_nan());
    let says_something = |row: &Row| !row.is_count || row.values.iter().any(|value| *value != 0.0);
    all.into_iter().filter(|row| has_both(row) && says_something(row)).collect()
}
