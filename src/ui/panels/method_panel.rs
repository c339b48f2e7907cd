//! Method and weights, and the numbers of the last solve.

use eframe::egui;
use egui::{RichText, Role, WidgetInfo};

use crate::session::{Action, Outcome};
use crate::solver::{BoundaryShape, FAMILIES, Family, Growth, METHODS, Method, Settings, Treatment};
use crate::ui::theme::theme_of;
use crate::ui::timeline::chips::residual_words;
use crate::ui::{Editor, Request, keys_of};

/// The slider's ends: beyond them weights grow wild.
const POWERS: std::ops::RangeInclusive<f64> = -1.0..=1.0;

/// Shows the panel.
pub(in crate::ui) fn method_panel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let settings = editor.session.document().settings;
    let mut chosen = settings;
    egui::Grid::new("method").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
        ui.label("Method");
        method_menu(ui, &mut chosen);
        ui.end_row();
        if let Method::Convex(shape) = &mut chosen.method {
            ui.label("Boundary");
            ui.horizontal(|ui| {
                ui.selectable_value(shape, BoundaryShape::Circle, "Circle");
                ui.selectable_value(shape, BoundaryShape::Square, "Square");
            });
            ui.end_row();
        }
        if chosen.method.uses_family() {
            ui.label("Weights");
            family_menu(ui, &mut chosen);
            ui.end_row();
        }
    });
    if settings.method.uses_family()
        && let Some(power) = settings.family.power()
    {
        power_slider(ui, settings, power, requests);
    }
    if chosen.method.uses_pins() {
        ui.add_space(2.0);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 12.0;
            ui.label("Pinned");
            treatment_menu(ui, &mut chosen);
        });
    }
    new_vertices_box(ui, &mut chosen);
    if chosen != settings {
        requests.push(Request::Do(Action::SetSettings(chosen)));
    }
    ui.add_space(6.0);
    if let Some(entry) = METHODS.iter().find(|entry| entry.name == settings.method.name()) {
        let words = format!("{}. {}.", sentence(entry.about), entry.source);
        ui.label(RichText::new(words).small().color(theme_of(ui).weak_text));
    }
    more(ui, settings, requests);
    ui.add_space(8.0);
    solve_and_cancel(ui, editor, requests);
    if let Some(outcome) = editor.session.outcome() {
        ui.add_space(8.0);
        distortion(ui, outcome);
        ui.add_space(4.0);
        numbers(ui, outcome);
    }
}

fn solve_and_cancel(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let disk = editor.session.model().is_some_and(|model| model.disk().is_some());
    let busy = editor.session.busy().is_some();
    ui.horizontal(|ui| {
        let solve = ui.add_enabled(disk && !busy, egui::Button::new("Solve"));
        let tip = "Solve again (Ctrl+Enter). A change of method, weights or pins solves by itself.";
        if solve.on_hover_text(tip).clicked() {
            requests.push(Request::Do(Action::Solve));
        }
        let relax = Request::Do(Action::Relax);
        let tip = format!(
            "Lower the distortion of a planar embedding: one-to-one throughout, constraints exact ({})",
            keys_of(ui.ctx(), &relax)
        );
        let button = ui.add_enabled(editor.session.can_relax(), egui::Button::new("Relax"));
        if button.on_hover_text(&tip).on_disabled_hover_text(tip).clicked() {
            requests.push(relax);
        }
        if busy && editor.busy_for_long().is_some() && ui.button("Cancel").clicked() {
            requests.push(Request::Do(Action::Cancel));
        }
    });
}

/// The words with a capital at the beginning.
pub fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn method_menu(ui: &mut egui::Ui, settings: &mut Settings) {
    let title = METHODS.iter().find(|e| e.name == settings.method.name()).map_or("", |e| e.title);
    let menu = egui::ComboBox::from_id_salt("method menu").selected_text(title).width(150.0).show_ui(ui, |ui| {
        for entry in METHODS {
            let method = match entry.name {
                "convex" => Method::Convex(BoundaryShape::default()),
                "lscm" => Method::Lscm,
                "levy" => Method::Levy,
                "continuation" => Method::Continuation,
                "matchmaker" => Method::Matchmaker,
                "natural" => Method::Natural,
                "iterate" => Method::Iterate,
                "virtual-boundary" => Method::VirtualBoundary,
                _ => Method::Auto,
            };
            let on = settings.method.name() == entry.name;
            let label =
                ui.selectable_label(on, entry.title).on_hover_text(format!("{} ({})", entry.about, entry.source));
            if label.clicked() && !on {
                settings.method = method;
                // Uniform and shape-preserving weights need a convex boundary.
                if settings.family.power().is_none() && !matches!(method, Method::Convex(_)) {
                    settings.family = Family::default();
                }
            }
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Method"));
}

fn family_menu(ui: &mut egui::Ui, settings: &mut Settings) {
    let name = settings.family.to_string();
    let stem = |text: &str| text.split(':').next().unwrap_or_default().to_owned();
    let title = FAMILIES.iter().find(|e| stem(e.name) == stem(&name)).map_or("", |e| e.title);
    let convex = matches!(settings.method, Method::Convex(_));
    let menu = egui::ComboBox::from_id_salt("family menu").selected_text(title).width(150.0).show_ui(ui, |ui| {
        for entry in FAMILIES {
            let family = entry.name.parse().unwrap_or_else(|_| Family::Power(settings.family.power().unwrap_or(0.5)));
            if family.power().is_none() && !convex {
                continue;
            }
            let on = stem(entry.name) == stem(&name);
            let label =
                ui.selectable_label(on, entry.title).on_hover_text(format!("{} ({})", entry.about, entry.source));
            if label.clicked() && !on {
                settings.family = family;
            }
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Weights"));
}

/// What each treatment of the pinned vertices' equations does.
const TREATMENTS: [(Option<Treatment>, &str, &str); 4] = [
    (None, "Automatic", "Two pins only fix size and place: eliminated. More are constraints: least squares"),
    (Some(Treatment::Eliminate), "Eliminate", "The equations of pinned vertices are dropped (paper §3.3)"),
    (
        Some(Treatment::LeastSquares),
        "Least squares",
        "All equations are kept and met as well as can be, the pins exactly (paper §6)",
    ),
    (Some(Treatment::Weighted), "Weighted", "All equations are kept, and all pins pull by their weights (paper §6)"),
];

fn treatment_menu(ui: &mut egui::Ui, settings: &mut Settings) {
    let title = TREATMENTS.iter().find(|(treatment, ..)| *treatment == settings.treatment).map_or("", |entry| entry.1);
    let menu = egui::ComboBox::from_id_salt("treatment menu").selected_text(title).width(150.0).show_ui(ui, |ui| {
        for (treatment, title, about) in TREATMENTS {
            ui.selectable_value(&mut settings.treatment, treatment, title).on_hover_text(about);
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Equations of pinned vertices"));
    menu.response.on_hover_text("What becomes of the equations of pinned vertices");
}

/// Whether edges may be split, where the method can.
fn new_vertices_box(ui: &mut egui::Ui, settings: &mut Settings) {
    if settings.method == Method::Auto {
        let tip = "Where the constraints cannot be met otherwise, split edges: the surface stays the same. Off: the best \
                   planar embedding, and which constraints it does not meet";
        ui.checkbox(&mut settings.new_vertices, "Allow new vertices").on_hover_text(tip);
    }
}

/// What few people need: how long the iteration may go on, and how the virtual boundary does.
fn more(ui: &mut egui::Ui, settings: Settings, requests: &mut Vec<Request>) {
    let iterates = matches!(settings.method, Method::Auto | Method::Iterate);
    let bends = matches!(settings.method, Method::Auto | Method::VirtualBoundary);
    if !iterates && !bends {
        return;
    }
    ui.add_space(4.0);
    egui::CollapsingHeader::new("More").default_open(false).show(ui, |ui| {
        egui::Grid::new("more").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            if iterates {
                ui.label("Step limit");
                step_limit(ui, settings, requests);
                ui.end_row();
            }
            if bends {
                ui.label("Bent vertices");
                let mut chosen = settings;
                growth_menu(ui, &mut chosen);
                if chosen != settings {
                    requests.push(Request::Do(Action::SetSettings(chosen)));
                }
                ui.end_row();
            }
        });
    });
}

fn step_limit(ui: &mut egui::Ui, settings: Settings, requests: &mut Vec<Request>) {
    let mut limit = settings.max_steps;
    let field = ui.add(egui::DragValue::new(&mut limit).range(1..=10_000).suffix(" steps"));
    field.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, "Step limit"));
    let field = field.on_hover_text("The most mean-value iterations of a run. Drag, or click to type.");
    if field.changed() {
        requests.push(Request::Do(Action::SlideSettings(Settings { max_steps: limit, ..settings })));
    }
    if field.drag_stopped() || field.lost_focus() {
        requests.push(Request::Do(Action::EndGesture));
    }
}

fn growth_menu(ui: &mut egui::Ui, settings: &mut Settings) {
    let entries = [
        (Growth::Double, "Twice as many", "Quick: as many again are bent each time"),
        (Growth::One, "One more", "As the paper's §5 has it: the least that is enough, found slowly"),
    ];
    let title = entries.iter().find(|(growth, ..)| *growth == settings.growth).map_or("", |entry| entry.1);
    let menu = egui::ComboBox::from_id_salt("growth menu").selected_text(title).width(130.0).show_ui(ui, |ui| {
        for (growth, title, about) in entries {
            ui.selectable_value(&mut settings.growth, growth, title).on_hover_text(about);
        }
    });
    menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "How the virtual boundary goes on"));
    let tip = "Where the boundary crosses itself, vertices of it are bent to a convex polygon: how many the next time";
    menu.response.on_hover_text(tip);
}

/// From Wachspress over mean value to conformal.
fn power_slider(ui: &mut egui::Ui, settings: Settings, power: f64, requests: &mut Vec<Request>) {
    let mut wanted = power;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 62.0).max(60.0);
        let slider = egui::Slider::new(&mut wanted, POWERS).clamping(egui::SliderClamping::Never).fixed_decimals(2);
        let response = ui.add(slider).on_hover_text(
            "Power p of the offset d = r^p: −1 Wachspress, 0 mean value, 1 conformal. Type any number; double-click resets.",
        );
        response.widget_info(|| WidgetInfo::slider(true, wanted, "Power of the weights"));
        if response.double_clicked() {
            wanted = Family::CONFORMAL_POWER;
        }
        if response.changed() || response.double_clicked() {
            let settings = Settings { family: named_family(wanted), ..settings };
            requests.push(Request::Do(Action::SlideSettings(settings)));
        }
        // Neither a key nor a double click is the beginning of a drag: nothing else ends its gesture.
        let is_whole = response.changed() && !response.dragged() && !ui.ctx().text_edit_focused();
        if is_whole || response.double_clicked() || response.drag_stopped() || response.lost_focus() {
            requests.push(Request::Do(Action::EndGesture));
        }
    });
    ui.horizontal(|ui| {
        for (words, power) in [("Wachspress", -1.0), ("Mean value", 0.0), ("Conformal", 1.0)] {
            if ui.small_button(words).clicked() {
                let settings = Settings { family: named_family(power), ..settings };
                requests.push(Request::Do(Action::SetSettings(settings)));
            }
        }
    });
}

/// The family of a power, by its own name where it has one. Powers are rounded to what the slider shows.
fn named_family(power: f64) -> Family {
    let power = (power * 100.0).round() / 100.0;
    if power == Family::CONFORMAL_POWER {
        Family::Conformal
    } else if power == Family::WACHSPRESS_POWER {
        Family::Wachspress
    } else if power == 0.0 {
        Family::MeanValue
    } else {
        Family::Power(power)
    }
}

fn distortion(ui: &mut egui::Ui, outcome: &Outcome) {
    let summary = &outcome.distortion.summary;
    ui.strong("Distortion");
    egui::Grid::new("distortion").num_columns(4).spacing([14.0, 4.0]).show(ui, |ui| {
        for words in ["", "mean", "p99", "max"] {
            ui.weak(words);
        }
        ui.end_row();
        for (name, spread) in [("Angle", summary.angle), ("Area", summary.area)] {
            ui.label(name);
            for value in [spread.mean, spread.p99, spread.max] {
                ui.monospace(figure(value));
            }
            ui.end_row();
        }
        ui.label("Stretch");
        ui.monospace(figure(summary.stretch_l2)).on_hover_text("L² stretch (Sander et al. 2001)");
        ui.label("");
        ui.monospace(figure(summary.stretch_linf)).on_hover_text("L∞ stretch");
        ui.end_row();
    });
}

fn figure(value: f64) -> String {
    if !value.is_finite() {
        "∞".to_owned()
    } else if value < 1e4 {
        format!("{value:.3}")
    } else {
        format!("{value:.1e}")
    }
}

fn numbers(ui: &mut egui::Ui, outcome: &Outcome) {
    let solution = &outcome.step.solution;
    egui::CollapsingHeader::new("Numbers of the solve").default_open(false).show(ui, |ui| {
        egui::Grid::new("numbers").num_columns(2).spacing([16.0, 4.0]).show(ui, |ui| {
            let mut row = |name: &str, tip: &str, value: String| {
                ui.label(name).on_hover_text(tip);
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.monospace(value));
                ui.end_row();
            };
            row(
                "Residual",
                "|Ax − b| / |b| of the linear solve",
                residual_words(solution.linear.map(|linear| linear.residual)),
            );
            let tip = "|A z| of all equations, pinned vertices included, relative to their terms";
            row("Equation residual", tip, residual_words(solution.linear.map(|linear| linear.equation_residual)));
            let seconds = &solution.seconds;
            let phases = [
                ("Assembly", seconds.assemble),
                ("Ordering", seconds.analyze),
                ("Factoring", seconds.factor),
                ("Substitution", seconds.solve),
                ("Proof", outcome.step.verify_seconds),
            ];
            for (name, seconds) in phases {
                row(name, "milliseconds", format!("{:.1} ms", 1000.0 * seconds));
            }
            let counts = solution.linear.unwrap_or_default();
            row("Factors", "memory of the factors", format!("{:.1} MB", counts.factor_bytes as f64 / 1e6));
            row("Pivots replaced", "pivots too small to divide by", counts.replaced_pivots.to_string());
            row("Corners bounded", "degenerate corners with a bounded weight", counts.bounded_corners.to_string());
        });
    });
}
