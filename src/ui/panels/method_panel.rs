//! Tab of the method: method, weights, and the numbers of the last solve.

use eframe::egui::{self, WidgetInfo};

use super::boundary_rows::boundary_rows;
use super::compare_panel::comparison;
use super::surface::{charts_row, holes_row, start_remark, start_row};
use crate::session::Action;
use crate::ui::timeline::chips::residual_words;
use crate::ui::{
    Control, Editor, Measure, Request, Typed, figures, head, list, number, pairs, read_more, remark, sentence, short,
    tip_with_keys, with_keys_set,
};
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Family, Growth, Method, NamedOption, Settings, Treatment};

/// Width of a number of the distortion, characters.
const FIGURE: usize = 8;

/// Range of the slider. Powers outside it give extreme weights.
const POWERS: std::ops::RangeInclusive<f64> = -1.0..=1.0;

pub(in crate::ui) fn method_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let settings = &editor.session.document().settings;
    let mut edit = Edit { settings: settings.clone(), slides: false, ends: false };
    let chosen = &mut edit.settings;
    pairs(ui, "method", [12.0, 8.0], |ui| {
        ui.label("Method");
        method_list(ui, chosen);
        ui.end_row();
        boundary_rows(ui, chosen);
        if chosen.method.uses_family() {
            ui.label("Weights").on_hover_text(Measure::Weights.tip());
            family_list(ui, chosen);
            ui.end_row();
        }
        if chosen.method.uses_pins() && !chosen.method.only_places_pins() {
            ui.label("Pinned");
            treatment_list(ui, &mut chosen.treatment);
            ui.end_row();
        }
        start_row(ui, editor, chosen, requests);
        charts_row(ui, &editor.session, requests);
        holes_row(ui, &editor.session, requests);
    });
    start_remark(ui, editor);
    if let (true, Family::Power(power)) = (settings.method.uses_family(), settings.family()) {
        power_slider(ui, power, &mut edit);
    }
    new_vertices_box(ui, &mut edit.settings);
    ui.add_space(6.0);
    let words = settings.method.labels();
    remark(ui, format!("{}. {}.", sentence(words.about), sentence(words.source)));
    read_more(ui, "Which method?", "methods.md#decision-table", requests);
    more(ui, &mut edit);
    edit.ask_for(settings, requests);
    ui.add_space(8.0);
    solve_and_cancel(ui, editor, requests);
    if let Some(outcome) = editor.step_on_screen() {
        ui.add_space(8.0);
        comparison(ui, editor);
        distortion(ui, outcome, requests);
        ui.add_space(4.0);
        numbers(ui, outcome);
    }
}

/// Changes of the settings in one frame.
struct Edit {
    settings: Settings,
    /// True if the change is part of a gesture.
    slides: bool,
    /// True if a gesture ends.
    ends: bool,
}

impl Edit {
    fn ask_for(self, before: &Settings, requests: &mut Vec<Request>) {
        if self.settings != *before {
            let action = if self.slides { Action::SlideSettings } else { Action::SetSettings };
            requests.push(action(self.settings).into());
        }
        if self.ends {
            requests.push(Action::EndGesture.into());
        }
    }
}

fn solve_and_cancel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let disk = editor.has_disk();
    let busy = editor.session.busy().is_some();
    ui.horizontal(|ui| {
        let solve = ui.add_enabled(disk && !busy, egui::Button::new("Solve"));
        let tip = "Solve from scratch (Ctrl+Enter), ignoring the current map. Changes of method, weights or pins are \
                   solved automatically.";
        let tip = with_keys_set(ui.ctx(), tip, ["(", "Ctrl+Enter", ")"], &Action::Solve.into());
        solve.on_hover_text(tip).asks(Action::Solve, requests);
        let relax = Action::Relax.into();
        let tip = "Lower the distortion of a planar embedding. It stays planar, and hard pins stay on their targets";
        let tip = tip_with_keys(ui, tip, &relax);
        let button = ui.add_enabled(editor.session.can_relax(), egui::Button::new("Relax"));
        button.on_hover_text(&tip).on_disabled_hover_text(tip).asks(relax, requests);
        if busy && editor.busy_for_long().is_some() {
            ui.button("Stop").on_hover_text("Stop the work in the background").asks(Action::Cancel, requests);
        }
    });
    if editor.session.is_continued() {
        remark(
            ui,
            "Continued from the map before the edit. Solving from scratch, as on opening the project, may give \
             another map.",
        );
    }
}

fn method_list(ui: &mut egui::Ui, settings: &mut Settings) {
    list(ui, "Method", 150.0, settings.method.labels().title, |ui| {
        for method in Method::ALL {
            let is_chosen = settings.method.name() == method.name();
            let label = ui.selectable_label(is_chosen, method.labels().title).on_hover_text(method.labels().tip());
            if label.clicked() && !is_chosen {
                let shape = settings.method.boundary_shape().cloned().unwrap_or_default();
                *settings = settings.clone().by(method.clone().on_shape(shape));
            }
        }
    });
}

fn family_list(ui: &mut egui::Ui, settings: &mut Settings) {
    let method = settings.method.clone();
    list(ui, "Weights", 150.0, settings.family().labels().title, |ui| {
        for &family in Family::ALL.iter().filter(|family| family.goes_with(&method)) {
            let is_chosen = settings.family().name() == family.name();
            let label = ui.selectable_label(is_chosen, family.labels().title).on_hover_text(family.labels().tip());
            if label.clicked() && !is_chosen {
                settings.family = Some(match family {
                    // A power starts at the power of the family before.
                    Family::Power(usual) => Family::Power(settings.family().power().unwrap_or(usual)),
                    named => named,
                });
            }
        }
    });
}

fn treatment_list(ui: &mut egui::Ui, chosen: &mut Option<Treatment>) {
    let automatic = "Automatic";
    let shown = chosen.map_or(automatic, |treatment| treatment.labels().title);
    let list = list(ui, "Equations of pinned vertices", 150.0, shown, |ui| {
        let tip = "Eliminate for up to two pins, which only fix size and position. Least squares for more pins";
        ui.selectable_value(chosen, None, automatic).on_hover_text(tip);
        for &treatment in Treatment::ALL {
            let label = ui.selectable_value(chosen, Some(treatment), treatment.labels().title);
            label.on_hover_text(sentence(&treatment.labels().tip()));
        }
    });
    list.on_hover_text("How to treat the equations of pinned vertices");
}

fn growth_list(ui: &mut egui::Ui, chosen: &mut Growth) {
    let list = list(ui, "Growth of the virtual boundary", 130.0, chosen.labels().title, |ui| {
        for &growth in Growth::ALL {
            let label = ui.selectable_value(chosen, growth, growth.labels().title);
            label.on_hover_text(sentence(&growth.labels().tip()));
        }
    });
    let tip = "While the boundary crosses itself, more of its vertices are pinned on a convex polygon. Sets how many \
               in the next solve";
    list.on_hover_text(tip);
}

/// Checkbox that allows edge splits, for a method that can split edges.
fn new_vertices_box(ui: &mut egui::Ui, settings: &mut Settings) {
    if settings.method == Method::Auto {
        let tip = "Split edges if the constraints cannot be met otherwise. The surface does not change. Off: show \
                   the best planar embedding and its unmet constraints";
        ui.checkbox(&mut settings.new_vertices, "Allow new vertices").on_hover_text(tip);
    }
}

/// Options for experts: step limit, layers, and growth of the virtual boundary.
fn more(ui: &mut egui::Ui, edit: &mut Edit) {
    let method = edit.settings.method.clone();
    let is_padded = method.is_padded();
    if !method.iterates() && !method.bends_boundary() && !is_padded {
        return;
    }
    ui.add_space(4.0);
    egui::CollapsingHeader::new("More").default_open(false).show(ui, |ui| {
        pairs(ui, "more", [12.0, 8.0], |ui| {
            if method.iterates() {
                ui.label("Step limit");
                step_limit(ui, edit);
                ui.end_row();
            }
            if is_padded {
                ui.label("Layers");
                layers(ui, edit);
                ui.end_row();
            }
            if method.bends_boundary() {
                ui.label("Boundary pins");
                growth_list(ui, &mut edit.settings.growth);
                ui.end_row();
            }
        });
    });
}

fn step_limit(ui: &mut egui::Ui, edit: &mut Edit) {
    let typed = Typed::new("the limit", 1.0..=10_000.0).whole();
    let before = edit.settings.max_steps();
    let mut limit = before;
    let drag = egui::DragValue::new(&mut limit).range(1..=10_000).suffix(" steps");
    let field = ui.add(drag.custom_parser(|text| typed.number(text)));
    let field = typed.name(ui, field, "Step limit");
    if limit != before {
        edit.settings.max_steps = Some(limit);
    }
    edit.slides |= field.changed();
    edit.ends |= field.has_ended();
    field.on_hover_text("Maximum number of iterations of a run. Drag, or click to type.");
}

fn layers(ui: &mut egui::Ui, edit: &mut Edit) {
    let range = 1..=usize::from(Settings::MOST_LAYERS);
    let typed = Typed::new("the number of layers", 1.0..=f64::from(Settings::MOST_LAYERS)).whole();
    let drag = egui::DragValue::new(&mut edit.settings.layers).range(range).speed(0.1);
    let field = ui.add(drag.custom_parser(|text| typed.number(text)));
    let field = typed.name(ui, field, "Layers");
    edit.slides |= field.changed();
    edit.ends |= field.has_ended();
    field.on_hover_text("Layers of virtual triangles around the mesh. Drag, or click to type.");
}

/// Slider of the power, from Wachspress over mean value to conformal.
fn power_slider(ui: &mut egui::Ui, power: f64, edit: &mut Edit) {
    let mut wanted = power;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 62.0).max(60.0);
        let slider = egui::Slider::new(&mut wanted, POWERS).clamping(egui::SliderClamping::Never).fixed_decimals(2);
        let slider = slider.custom_parser(|text| text.trim().parse().ok().filter(|power: &f64| power.is_finite()));
        let response = ui.add(slider).on_hover_text(
            "Power p of the offset d = r^p: −1 Wachspress, 0 mean value, 1 conformal. Type any number; double-click \
             resets.",
        );
        response.widget_info(|| WidgetInfo::slider(true, wanted, "Power of the weights"));
        if response.double_clicked() {
            wanted = Family::CONFORMAL_POWER;
        }
        if (response.changed() || response.double_clicked()) && wanted.is_finite() {
            // Round to the two digits of the slider.
            edit.settings.family = Some(Family::Power((wanted * 100.0).round() / 100.0));
            edit.slides = true;
        }
        // A key or a double click is a complete gesture, because no drag follows that would end it.
        let is_whole = response.changed() && !response.dragged() && !ui.ctx().text_edit_focused();
        edit.ends |= is_whole || response.double_clicked() || response.has_ended();
    });
}

fn distortion(ui: &mut egui::Ui, outcome: &Outcome, requests: &mut Vec<Request>) {
    let summary = &outcome.distortion.summary;
    ui.horizontal(|ui| {
        ui.strong("Distortion");
        read_more(ui, "What do the numbers mean?", "methods.md#columns", requests);
    });
    egui::Grid::new("distortion").num_columns(4).spacing([8.0, 4.0]).show(ui, |ui| {
        ui.label("");
        for (words, measure) in [("mean", Measure::Mean), ("p99", Measure::P99), ("max", Measure::Max)] {
            head(ui, FIGURE, words).on_hover_text(measure.tip());
        }
        ui.end_row();
        let spreads = [("Angle", summary.angle, Measure::Angle), ("Area", summary.area, Measure::Area)];
        for (name, spread, measure) in spreads {
            ui.label(name).on_hover_text(measure.tip());
            figures(ui, name, FIGURE, &[spread.mean, spread.p99, spread.max].map(figure));
            ui.end_row();
        }
        let stretch = [Measure::StretchL2, Measure::StretchLinf].map(Measure::tip).join("\n\nAt the right: ");
        ui.label("Stretch").on_hover_text(stretch);
        figures(ui, "Stretch", FIGURE, &[figure(summary.stretch_l2), String::new(), figure(summary.stretch_linf)]);
        ui.end_row();
    });
}

fn figure(value: f64) -> String {
    if !value.is_finite() {
        "∞".to_owned()
    } else if value < 10.0 {
        format!("{value:.3}")
    } else if value < 1e4 {
        short(value)
    } else {
        format!("{value:.1e}")
    }
}

fn numbers(ui: &mut egui::Ui, outcome: &Outcome) {
    let solution = &outcome.step.candidate.solution;
    let linear = solution.linear.unwrap_or_default();
    let residual = solution.linear.map(|linear| linear.residual);
    let equation_residual = solution.linear.map(|linear| linear.equation_residual);
    let seconds = &solution.seconds;
    let milliseconds = |seconds: f64| format!("{:.1} ms", 1000.0 * seconds);
    let of_all = "|A z| of all equations, pinned vertices included, relative to their terms";
    let rows = [
        ("Residual", "|Ax − b| / |b| of the linear solve", residual_words(residual)),
        ("Equation residual", of_all, residual_words(equation_residual)),
        ("Assembly", "milliseconds", milliseconds(seconds.assemble)),
        ("Ordering", "milliseconds", milliseconds(seconds.analyze)),
        ("Factoring", "milliseconds", milliseconds(seconds.factor)),
        ("Substitution", "milliseconds", milliseconds(seconds.solve)),
        ("Proof", "milliseconds", milliseconds(outcome.step.verify_seconds)),
        ("Factors", "memory of the factors", format!("{:.1} MB", linear.factor_bytes as f64 / 1e6)),
        ("Pivots replaced", "pivots too small to divide by", linear.replaced_pivots.to_string()),
        ("Corners bounded", "degenerate corners with a bounded weight", linear.bounded_corners.to_string()),
    ];
    egui::CollapsingHeader::new("Numbers of the solve").default_open(false).show(ui, |ui| {
        pairs(ui, "numbers", [16.0, 4.0], |ui| {
            for (name, tip, value) in rows {
                number(ui, name, value).on_hover_text(tip);
            }
        });
    });
}
