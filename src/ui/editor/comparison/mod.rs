//! Methods side by side in the embedding's pane: which ones, one camera and one scale of colours for all, and the order of their
//! table. They run in the session; what is drawn of them is made here.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | what is chosen |
//! | `actions.rs`, `morph_actions.rs` | requests, carried out |
//! | `morph.rs` | the morph between two of them: which frame shows, and how |
//! | `drawn.rs` | scenes, faces coloured on one scale, one camera |

mod actions;
mod drawn;
mod morph;
mod morph_actions;

use std::sync::Arc;

use glam::DVec2;

use self::drawn::{Drawn, Sight, outcome_of};
use super::paint::Legend;
use super::scene::MeshScene;
use crate::session::{Contender, JobFailure, Session, Wake};
use crate::view::{PlaneCamera, Quantity};
pub(in crate::ui) use drawn::CellScene;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::Variant;
use freebound_io::{Column, Direction};
pub(in crate::ui) use morph::MorphFrame;
pub use morph::MorphView;

/// The least and the most methods that are compared.
pub(in crate::ui) const COUNTS: [usize; 2] = [2, 6];

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

    pub(in crate::ui::editor) fn take_failure(&mut self) -> Option<JobFailure> {
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
