//! Choice of the compared methods.

use eframe::egui::{self, Role};

use crate::ui::editor::comparison::COUNTS;
use crate::ui::{Control, Editor, Request, remark, sentence};
use freebound_core::problem::{BoundaryShape, Family, Method, NamedOption as _, Variant};

/// Button that opens the list of methods.
pub(super) fn chooser(ui: &mut egui::Ui, editor: &Editor, requests: &mut Vec<Request>) {
    let count = editor.session.contenders().len();
    let [_, most] = COUNTS;
    let config =
        egui::containers::menu::MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    let button = egui::containers::menu::MenuButton::new(format!("Methods {count}")).config(config);
    let (response, _) = button.ui(ui, |ui| {
        let height = (ui.ctx().content_rect().height() - 120.0).clamp(120.0, 560.0);
        egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
            ui.set_min_width(230.0);
            // Narrower row spacing, because the list is long.
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.spacing_mut().interact_size.y = 19.0;
            remark(ui, format!("Two to {most} methods, with the pins and settings of the document"));
            for variant in usual(editor) {
                entry(ui, editor, variant, requests);
            }
            egui::CollapsingHeader::new("Other weights and boundaries").show(ui, |ui| {
                for variant in others(editor) {
                    entry(ui, editor, variant, requests);
                }
            });
        });
    });
    response.named(Role::Button, "Methods that are compared").on_hover_text("Choose the methods that are compared");
}

/// Every method, with the weights of the document if the method uses weights.
fn usual(editor: &Editor) -> Vec<Variant> {
    let settings = &editor.session.document().settings;
    let usual = |method: &Method| Variant::of(&Variant { method: method.clone(), family: None }.settings(settings));
    Method::ALL.iter().map(usual).collect()
}

/// Every method that uses weights, with all other weights and boundary shapes.
fn others(editor: &Editor) -> Vec<Variant> {
    let usual = usual(editor);
    let mut all = Vec::new();
    for method in Method::ALL.iter().filter(|method| method.uses_family()) {
        let on_shapes = match method {
            Method::Convex(_) => BoundaryShape::ALL.iter().cloned().map(Method::Convex).collect(),
            method => vec![method.clone()],
        };
        for method in on_shapes {
            let families = Family::ALL.iter().filter(|family| family.goes_with(&method));
            all.extend(families.map(|&family| Variant { method: method.clone(), family: Some(family) }));
        }
    }
    all.retain(|variant| !usual.contains(variant));
    all
}

/// Checkbox of a method.
fn entry(ui: &mut egui::Ui, editor: &Editor, variant: Variant, requests: &mut Vec<Request>) {
    let chosen = editor.session.contenders();
    let mut is_chosen = chosen.iter().any(|contender| contender.variant() == variant);
    let [least, most] = COUNTS;
    let suits = editor.session.document().problem().suits(&variant.method);
    let why_not = match (is_chosen, suits) {
        (true, _) if chosen.len() <= least => Some("A comparison needs at least two methods"),
        (false, _) if chosen.len() >= most => Some("At most six methods: remove another one first"),
        (false, false) => Some("This method does not apply to the current pins"),
        _ => None,
    };
    let tip = sentence(&variant.method.labels().tip());
    let check = ui.add_enabled(why_not.is_none(), egui::Checkbox::new(&mut is_chosen, variant.title()));
    let check = check.on_hover_text(tip).on_disabled_hover_text(why_not.unwrap_or_default());
    if check.changed() {
        requests.push(Request::ToggleContender(variant));
    }
}
