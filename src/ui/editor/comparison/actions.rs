//! Actions of the method comparison, and its export to files.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::COUNTS;
use crate::session::{Action, Compared, Contender, MorphState, Session, comparison_report};
use crate::ui::editor::Editor;
use crate::ui::state::{ComparisonExport, Pane, ShadingMode};
use crate::view::{CellShading, ComparisonPicture, MorphPicture, Quantity};
use freebound_core::problem::{Method, NamedOption as _, Variant};
use freebound_io::figure::FigureFormat;

impl Editor {
    /// Shows the comparison of methods in place of the embedding, or the embedding again.
    pub(in crate::ui::editor) fn toggle_comparison(&mut self) {
        let view = &mut self.plane.comparison;
        view.is_shown = !view.is_shown;
        if view.is_shown {
            view.was_beside = self.layout.full().is_none();
            self.layout.show_full(Some(Pane::Plane));
            if view.chosen.is_empty() {
                view.chosen = usual_contenders(&self.session);
            }
            let chosen = view.chosen.clone();
            self.session.handle(Action::CompareMethods(chosen));
        } else {
            if view.was_beside && self.layout.full() == Some(Pane::Plane) {
                self.layout.show_full(None);
            }
            self.close_morph();
            self.session.handle(Action::CompareMethods(Vec::new()));
        }
    }

    /// Closes the comparison. Returns true if it was open.
    pub(in crate::ui::editor) fn leave_comparison(&mut self) -> bool {
        let is_shown = self.plane.comparison.is_shown;
        if is_shown {
            self.toggle_comparison();
        }
        is_shown
    }

    /// True if the panes show only the comparison.
    pub(in crate::ui) fn shows_comparison_alone(&self) -> bool {
        self.plane.comparison.is_shown && self.layout.full() == Some(Pane::Plane)
    }

    /// Adds a method to the comparison, or removes it. Keeps the number of methods within [`COUNTS`].
    pub(in crate::ui::editor) fn toggle_contender(&mut self, variant: Variant) {
        let chosen = &mut self.plane.comparison.chosen;
        let [least, most] = COUNTS;
        match chosen.iter().position(|other| *other == variant) {
            Some(place) if chosen.len() > least => drop(chosen.remove(place)),
            None if chosen.len() < most => chosen.push(variant),
            _ => return,
        }
        let chosen = chosen.clone();
        self.session.handle(Action::CompareMethods(chosen));
    }

    /// Action that sets the document's settings to those of a method.
    pub(in crate::ui::editor) fn take_contender(&self, variant: &Variant) -> Action {
        Action::SetSettings(variant.settings(&self.session.document().settings))
    }

    /// Colours the cells by the quantity of a shading. Returns false if the comparison does not show or the shading
    /// has no quantity.
    pub(in crate::ui::editor) fn shade_comparison(&mut self, shading: ShadingMode) -> bool {
        let view = &mut self.plane.comparison;
        let quantity = match shading {
            _ if !view.is_shown => return false,
            ShadingMode::Plain => None,
            ShadingMode::Angle => Some(Quantity::Angle),
            ShadingMode::Area => Some(Quantity::Area),
            ShadingMode::Stretch => Some(Quantity::Stretch),
            ShadingMode::Checker
            | ShadingMode::Picture
            | ShadingMode::Move
            | ShadingMode::SeeThrough
            | ShadingMode::Column => return false,
        };
        view.colour_by(quantity);
        true
    }

    /// Results of the methods that have one, in the order of the table, for files.
    pub(in crate::ui) fn compared(&self) -> Vec<Arc<Compared>> {
        self.contenders_sorted().into_iter().filter_map(|contender| contender.found().cloned()).collect()
    }

    /// Writes the results of the methods that have one.
    pub(in crate::ui::editor) fn export_comparison(&mut self, what: ComparisonExport, path: PathBuf) {
        let Some(model) = self.session.model().cloned() else { return };
        let methods = self.compared();
        let shading = CellShading::By(self.plane.comparison.quantity.unwrap_or_default());
        let morph = self.session.morph();
        self.session.write_file(path, move |mut out| {
            let methods: Vec<&Compared> = methods.iter().map(AsRef::as_ref).collect();
            let page = |methods: &[&Compared]| ComparisonPicture { model: &model, methods, shading }.page();
            match what {
                ComparisonExport::Picture => page(&methods).write(FigureFormat::Png, &mut out),
                ComparisonExport::Drawing => page(&methods).write(FigureFormat::Svg, &mut out),
                ComparisonExport::Document => page(&methods).write(FigureFormat::Pdf, &mut out),
                ComparisonExport::Table => comparison_report(&model, &methods).write_csv(None, &mut out),
                ComparisonExport::Steps => comparison_report(&model, &methods).write_steps(&mut out),
                ComparisonExport::Morph => match (model.disk(), &morph) {
                    (Some(mesh), MorphState::Done(tour)) => MorphPicture::new(mesh, tour, shading).write(out),
                    _ => Err(io::Error::other("the morph no longer exists, because the maps have changed")),
                },
            }
        });
    }

    /// Methods in the order of the table. A sorted table has methods without a result last.
    pub(in crate::ui) fn contenders_sorted(&self) -> Vec<&Contender> {
        let mut all: Vec<&Contender> = self.session.contenders().iter().collect();
        if let Some((column, direction)) = self.plane.comparison.sort {
            all.sort_by(|first, second| match (first.found(), second.found()) {
                (Some(first), Some(second)) => column.compare(direction, [&first.report, &second.report]),
                (first, second) => second.is_some().cmp(&first.is_some()),
            });
        }
        all
    }
}

/// Initial methods of the comparison, in menu order: the document's method, and methods that suit the problem.
/// Methods that continue from a layout are chosen last, because they often reproduce the map of another method.
fn usual_contenders(session: &Session) -> Vec<Variant> {
    let problem = session.document().problem();
    let own = Variant::of(&problem.settings);
    let is_own = |method: &Method| method.name() == own.method.name();
    let mut methods: Vec<(usize, Method)> = Method::ALL.iter().cloned().enumerate().collect();
    methods.retain(|(_, method)| is_own(method) || problem.suits(method));
    methods.sort_by_key(|(place, method)| (!is_own(method), method.continues_from_layout(), *place));
    methods.truncate(COUNTS[1]);
    methods.sort_by_key(|(place, _)| *place);
    let of = |method: Method| Variant::of(&Variant { method, family: None }.settings(&problem.settings));
    methods.into_iter().map(|(_, method)| if is_own(&method) { own.clone() } else { of(method) }).collect()
}
