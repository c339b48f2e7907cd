//! Method comparison in the embedding pane: choice of methods, common camera and colour scale, and order of the
//! table. The methods run in the session; their scenes are made here.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | the choice of methods and the options of the view |
//! | `actions.rs`, `morph_actions.rs` | actions of comparison and morph |
//! | `morph.rs` | the morph between two methods: its frame on the screen, its camera |
//! | `drawn.rs` | scenes, face colours on one scale, one camera |

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

/// Least and greatest number of compared methods.
pub(in crate::ui) const COUNTS: [usize; 2] = [2, 6];

/// State of the method comparison.
#[derive(Debug)]
pub struct ComparisonView {
    /// Methods chosen last, kept while the comparison is closed.
    chosen: Vec<Variant>,
    is_shown: bool,
    /// Quantity that colours the faces; `None` for plain faces.
    quantity: Option<Quantity>,
    /// Sort column and direction of the table.
    sort: Option<(Column, Direction)>,
    /// The user's choice to show or hide the table, if made.
    table: Option<bool>,
    /// True if there is room for cells and table.
    is_roomy: bool,
    /// True if both panes showed before the comparison opened.
    was_beside: bool,
    drawn: Drawn,
    sight: Sight,
    /// Morph between two methods, in place of the cells.
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

    /// True if the comparison is on the screen, in place of the embedding.
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// Quantity that colours the faces.
    pub fn quantity(&self) -> Option<Quantity> {
        self.quantity
    }

    pub(in crate::ui) fn sort(&self) -> Option<(Column, Direction)> {
        self.sort
    }

    /// True if the table shows. Default: if there is room for the table beside the cells.
    pub(in crate::ui) fn has_table(&self) -> bool {
        self.table.unwrap_or(self.is_roomy)
    }

    pub(in crate::ui) fn toggle_table(&mut self) {
        self.table = Some(!self.has_table());
    }

    /// Sets whether there is room for cells and table.
    pub(in crate::ui) fn set_roomy(&mut self, is_roomy: bool) {
        self.is_roomy = is_roomy;
    }

    /// Colours the faces by another quantity.
    pub(in crate::ui) fn colour_by(&mut self, quantity: Option<Quantity>) {
        self.quantity = quantity;
    }

    /// Cycles the sorting by a column: ascending, descending, unsorted.
    pub(in crate::ui) fn sort_by(&mut self, column: Column) {
        self.sort = match self.sort {
            Some((before, Direction::Up)) if before == column => Some((column, Direction::Down)),
            Some((before, Direction::Down)) if before == column => None,
            _ => Some((column, Direction::Up)),
        };
    }

    /// True if the latest embeddings of all methods are drawn.
    pub fn is_drawn(&self, session: &Session) -> bool {
        session
            .contenders()
            .iter()
            .filter(|contender| outcome_of(contender).is_some())
            .all(|of| self.cell(of).is_some())
    }

    /// Camera of all cells, once there is one.
    pub fn camera_now(&self) -> Option<PlaneCamera> {
        self.sight.camera()
    }

    /// True while scenes are being made.
    pub fn is_making(&self) -> bool {
        self.drawn.is_making()
    }

    pub(in crate::ui::editor) fn take_failure(&mut self) -> Option<JobFailure> {
        self.drawn.take_failure()
    }

    /// Starts jobs for missing scenes and drops old ones. Call once per frame.
    pub(in crate::ui::editor) fn refresh(&mut self, session: &Session, given: Option<&Arc<MeshScene>>) {
        let wanted: Vec<Arc<Outcome>> = session.contenders().iter().filter_map(outcome_of).cloned().collect();
        let given = given.filter(|given| given.model_revision == session.model_revision());
        self.drawn.refresh(&wanted, given);
        self.drawn.paint(self.quantity);
        if let Some(mesh) = session.model().and_then(|model| model.disk()) {
            self.sight.refresh(mesh, &self.drawn);
        }
    }

    /// Drawn data of the cell of a method, once it is made.
    pub(in crate::ui) fn cell(&self, contender: &Contender) -> Option<CellScene> {
        self.drawn.cell(outcome_of(contender)?, &self.sight)
    }

    /// Colour scale of the faces.
    pub(in crate::ui) fn legend(&self) -> Option<(Quantity, &Legend)> {
        self.quantity.zip(self.drawn.legend())
    }

    /// Camera of all cells, for cells of this size.
    pub(in crate::ui) fn camera(&mut self, cell: DVec2) -> Option<PlaneCamera> {
        self.sight.camera_in(cell)
    }

    pub(in crate::ui) fn set_camera(&mut self, camera: PlaneCamera) {
        self.sight.set_camera(Some(camera));
    }

    /// Frames all embeddings.
    pub(in crate::ui::editor) fn frame(&mut self) {
        self.morph.frame();
        self.sight.set_camera(None);
    }
}
