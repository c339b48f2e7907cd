//! Requests to the comparison of methods, carried out; files written of it.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::COUNTS;
use crate::session::{Action, Compared, Contender, MorphState, Session, comparison_report};
use crate::ui::editor::Editor;
use crate::ui::state::{ComparisonExport, Pane, ShadingMode};
use crate::view::{CellShading, ComparisonPicture, MorphPicture, Quantity};
use freebound_core::problem::{Method, NamedOption as _, Variant};

/// Pixels per point of a picture that is written.
const PIXELS: f64 = 2.0;

impl Editor {
    /// Shows methods side by side in the place of the embedding, or the embedding again.
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

    /// Leaves the comparison. Returns whether there was one.
    pub(in crate::ui::editor) fn leave_comparison(&mut self) -> bool {
        let is_shown = self.plane.comparison.is_shown;
        if is_shown {
            self.toggle_comparison();
        }
        is_shown
    }

    /// True if the methods side by side are all that the panes show.
    pub(in crate::ui) fn shows_comparison_alone(&self) -> bool {
        self.plane.comparison.is_shown && self.layout.full() == Some(Pane::Plane)
    }

    /// Has a method take part in the comparison, or no more.
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

    /// Takes a method as that of the document.
    pub(in crate::ui::editor) fn take_contender(&self, variant: &Variant) -> Action {
        Action::SetSettings(variant.settings(&self.session.document().settings))
    }

    /// Colours the cells as a shading says, where they show and can be coloured so. Returns whether they were.
    pub(in crate::ui::editor) fn shade_comparison(&mut self, shading: ShadingMode) -> bool {
        let view = &mut self.plane.comparison;
        let quantity = match shading {
            _ if !view.is_shown => return false,
            ShadingMode::Plain => None,
            ShadingMode::Angle => Some(Quantity::Angle),
            ShadingMode::Area => Some(Quantity::Area),
            ShadingMode::Stretch => Some(Quantity::Stretch),
            ShadingMode::Checker | ShadingMode::Picture | ShadingMode::Move | ShadingMode::SeeThrough => return false,
        };
        view.colour_by(quantity);
        true
    }

    /// Results of the methods that have one, for files: in the order of the table.
    pub(in crate::ui) fn compared(&self) -> Vec<Arc<Compared>> {
        self.contenders_sorted().into_iter().filter_map(|contender| contender.found().cloned()).collect()
    }

    /// Writes what the methods have come to that have.
    pub(in crate::ui::editor) fn export_comparison(&mut self, what: ComparisonExport, path: PathBuf) {
        let Some(model) = self.session.model().cloned() else { return };
        let methods = self.compared();
        let shading = CellShading::By(self.plane.comparison.quantity.unwrap_or_default());
        let morph = self.session.morph();
        self.session.write_file(path, move |mut out| {
            let methods: Vec<&Compared> = methods.iter().map(AsRef::as_ref).collect();
            match what {
                ComparisonExport::Picture => {
                    let page = ComparisonPicture { model: &model, methods: &methods, shading }.page();
                    freebound_io::raster::write_png(&page.picture(PIXELS), out)
                }
                ComparisonExport::Table => comparison_report(&model, &methods).write_csv(None, &mut out),
                ComparisonExport::Steps => comparison_report(&model, &methods).write_steps(&mut out),
                ComparisonExport::Morph => match (model.disk(), &morph) {
                    (Some(mesh), MorphState::Done(tour)) => MorphPicture::new(mesh, tour, shading).write(out),
                    _ => Err(io::Error::other("the morph has gone: the maps have changed")),
                },
            }
        });
    }

    /// The methods in the order of the table; those without numbers last.
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

/// The methods to begin with, in the order of menus: the document's, and those that have something to do there. Methods that go on
/// from a map of another's come after those with a map of their own, which they often end with.
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
