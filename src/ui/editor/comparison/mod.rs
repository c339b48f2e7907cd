//! Methods side by side in the embedding's pane: which ones, one camera and one scale of colours for all, and the order of their
//! table. They run in the session; what is drawn of them is made here.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | what is chosen, and what a request does to it |
//! | `morph.rs` | the morph between two of them: which frame shows, and how |
//! | `drawn.rs` | scenes, faces coloured on one scale, one camera |

mod drawn;
mod morph;

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec2;

use self::drawn::{Drawn, Sight, outcome_of};
use super::paint::Legend;
use super::scene::MeshScene;
use super::{Editor, Pane, Shading};
use crate::io::{Column, Direction};
use crate::session::{Action, Compared, Contender, Failure, MorphState, Outcome, Session, Wake, comparison_report};
use crate::solver::{Choice as _, Method, Variant};
use crate::ui::ComparisonExport;
use crate::view::{CellShading, ComparisonPicture, MorphPicture, PlaneCamera, Quantity};
pub(in crate::ui) use drawn::CellScene;
pub(in crate::ui) use morph::MorphFrame;
pub use morph::{MorphRequest, MorphView};

/// The least and the most methods that are compared.
pub(in crate::ui) const COUNTS: [usize; 2] = [2, 6];

/// Pixels per point of a picture that is written.
const PIXELS: f64 = 2.0;

/// Methods side by side.
#[derive(Debug)]
pub struct ComparisonView {
    /// Those chosen last; they stay while the comparison does not show.
    chosen: Vec<Variant>,
    is_shown: bool,
    /// What faces are coloured by; plain without it.
    quantity: Option<Quantity>,
    /// The column that the table is sorted by, and whether the greatest comes first.
    sort: Option<(Column, Direction)>,
    /// Whether the table shows, where a person said so.
    table: Option<bool>,
    /// Whether there is room for cells and table.
    is_roomy: bool,
    /// Whether the embedding's pane was not in full size before.
    was_beside: bool,
    drawn: Drawn,
    sight: Sight,
    /// The morph between two methods, in the place of the cells.
    pub morph: MorphView,
}

impl ComparisonView {
    pub(in crate::ui::editor) fn new(wake: &Wake) -> Self {
        Self {
            chosen: Vec::new(),
            is_shown: false,
            quantity: Some(Quantity::default()),
            sort: None,
            table: None,
            is_roomy: true,
            was_beside: false,
            drawn: Drawn::new(wake),
            sight: Sight::default(),
            morph: MorphView::default(),
        }
    }

    /// Whether it is on the screen, in the place of the embedding.
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// What faces are coloured by.
    pub fn quantity(&self) -> Option<Quantity> {
        self.quantity
    }

    pub(in crate::ui) fn sort(&self) -> Option<(Column, Direction)> {
        self.sort
    }

    /// Whether the table shows; where nobody said, where there is room for it beside the cells.
    pub(in crate::ui) fn has_table(&self) -> bool {
        self.table.unwrap_or(self.is_roomy)
    }

    pub(in crate::ui) fn toggle_table(&mut self) {
        self.table = Some(!self.has_table());
    }

    /// Takes in whether there is room for cells and table.
    pub(in crate::ui) fn set_roomy(&mut self, is_roomy: bool) {
        self.is_roomy = is_roomy;
    }

    /// Colours faces by another quantity.
    pub(in crate::ui) fn colour_by(&mut self, quantity: Option<Quantity>) {
        self.quantity = quantity;
    }

    /// Sorts the table by a column; again, the other way around; a third time, not at all.
    pub(in crate::ui) fn sort_by(&mut self, column: Column) {
        self.sort = match self.sort {
            Some((before, Direction::Up)) if before == column => Some((column, Direction::Down)),
            Some((before, Direction::Down)) if before == column => None,
            _ => Some((column, Direction::Up)),
        };
    }

    /// Whether all embeddings that the methods have come to are drawn.
    pub fn is_drawn(&self, session: &Session) -> bool {
        session
            .contenders()
            .iter()
            .filter(|contender| outcome_of(contender).is_some())
            .all(|of| self.cell(of).is_some())
    }

    /// The camera of all cells, once there is something to see.
    pub fn camera_now(&self) -> Option<PlaneCamera> {
        self.sight.camera()
    }

    /// Whether what is drawn is still being made.
    pub fn is_making(&self) -> bool {
        self.drawn.is_making()
    }

    pub(in crate::ui::editor) fn take_failure(&mut self) -> Option<Failure> {
        self.drawn.take_failure()
    }

    /// Has made what is missing, and lets go of what is not shown any more. Call once per frame.
    pub(in crate::ui::editor) fn refresh(&mut self, session: &Session, given: Option<&Arc<MeshScene>>) {
        let wanted: Vec<Arc<Outcome>> = session.contenders().iter().filter_map(outcome_of).cloned().collect();
        let given = given.filter(|given| given.model_revision == session.model_revision());
        self.drawn.refresh(&wanted, given);
        self.drawn.paint(self.quantity);
        if let Some(mesh) = session.model().and_then(|model| model.disk()) {
            self.sight.refresh(mesh, &self.drawn);
        }
    }

    /// What the cell of a method draws, once that is made.
    pub(in crate::ui) fn cell(&self, contender: &Contender) -> Option<CellScene> {
        self.drawn.cell(outcome_of(contender)?, &self.sight)
    }

    /// The scale of the colours.
    pub(in crate::ui) fn legend(&self) -> Option<(Quantity, &Legend)> {
        self.quantity.zip(self.drawn.legend())
    }

    /// The camera of all cells, which are so large.
    pub(in crate::ui) fn camera(&mut self, cell: DVec2) -> Option<PlaneCamera> {
        self.sight.camera_in(cell)
    }

    pub(in crate::ui) fn set_camera(&mut self, camera: PlaneCamera) {
        self.sight.set_camera(Some(camera));
    }

    /// Shows all embeddings whole.
    pub(in crate::ui::editor) fn frame(&mut self) {
        self.morph.frame();
        self.sight.set_camera(None);
    }
}

impl Editor {
    /// Shows methods side by side in the place of the embedding, or the embedding again.
    pub(super) fn toggle_comparison(&mut self) {
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
    pub(super) fn leave_comparison(&mut self) -> bool {
        let is_shown = self.plane.comparison.is_shown;
        if is_shown {
            self.toggle_comparison();
        }
        is_shown
    }

    /// Whether the methods side by side are all that the panes show.
    pub(in crate::ui) fn shows_comparison_alone(&self) -> bool {
        self.plane.comparison.is_shown && self.layout.full() == Some(Pane::Plane)
    }

    /// Has a method take part in the comparison, or no more.
    pub(super) fn toggle_contender(&mut self, variant: Variant) {
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
    pub(super) fn take_contender(&self, variant: Variant) -> Action {
        Action::SetSettings(variant.settings(&self.session.document().settings))
    }

    /// Colours the cells as a shading says, where they show and can be coloured so. Returns whether they were.
    pub(super) fn shade_comparison(&mut self, shading: Shading) -> bool {
        let view = &mut self.plane.comparison;
        let quantity = match shading {
            _ if !view.is_shown => return false,
            Shading::Plain => None,
            Shading::Angle => Some(Quantity::Angle),
            Shading::Area => Some(Quantity::Area),
            Shading::Stretch => Some(Quantity::Stretch),
            Shading::Checker | Shading::Picture | Shading::Move | Shading::SeeThrough => return false,
        };
        view.colour_by(quantity);
        true
    }

    /// What the methods have come to that have, for files: in the order of the table.
    pub(in crate::ui) fn compared(&self) -> Vec<Arc<Compared>> {
        self.contenders_sorted().into_iter().filter_map(|contender| contender.found().cloned()).collect()
    }

    /// Writes what the methods have come to that have.
    pub(super) fn export_comparison(&mut self, what: ComparisonExport, path: PathBuf) {
        let Some(model) = self.session.model().cloned() else { return };
        let methods = self.compared();
        let shading = CellShading::By(self.plane.comparison.quantity.unwrap_or_default());
        let morph = self.session.morph();
        self.session.write_file(path, move |mut out| {
            let methods: Vec<&Compared> = methods.iter().map(AsRef::as_ref).collect();
            match what {
                ComparisonExport::Picture => {
                    let page = ComparisonPicture { model: &model, methods: &methods, shading }.page();
                    page.picture(PIXELS).write_png(out)
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
    let mut methods: Vec<(usize, Method)> = Method::ALL.iter().copied().enumerate().collect();
    methods.retain(|(_, method)| is_own(method) || problem.suits(*method));
    methods.sort_by_key(|(place, method)| (!is_own(method), method.goes_on_from_layout(), *place));
    methods.truncate(COUNTS[1]);
    methods.sort_by_key(|(place, _)| *place);
    let of = |method: Method| Variant::of(&Variant { method, family: None }.settings(&problem.settings));
    methods.into_iter().map(|(_, method)| if is_own(&method) { own } else { of(method) }).collect()
}
