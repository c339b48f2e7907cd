//! Selection of vertices by the mesh, by the map and by the present selection; of charts on the page.

use std::collections::BTreeSet;

use super::Editor;
use crate::session::{ChartState, LockState};
use crate::ui::GOOD_ENERGY;
use crate::ui::state::SelectBy;
use crate::view::{EdgeLoops, VertexSets};
use freebound_core::mesh::VertexId;

/// Share of the area that counts as the most distorted.
const WORST: f64 = 0.1;

impl Editor {
    /// True if this way of selecting applies to what is shown.
    pub fn can_select_by(&self, by: SelectBy) -> bool {
        if self.shows_page() {
            return match by {
                SelectBy::All | SelectBy::Invert => true,
                SelectBy::Pins | SelectBy::Distorted => {
                    (0..self.chart_count()).any(|chart| self.is_chart_selected_by(chart, by))
                }
                _ => false,
            };
        }
        let Some(scene) = self.mesh_scene().filter(|scene| self.is_of_session(scene)) else { return false };
        match by {
            SelectBy::Grow | SelectBy::Shrink | SelectBy::SharpEdges => !self.selection.vertices().is_empty(),
            SelectBy::Loops | SelectBy::Rings => {
                scene.disk().is_some_and(|disk| EdgeLoops(disk).has_edge(self.selection.vertices()))
            }
            SelectBy::Pins => !self.session.document().targets.is_empty(),
            SelectBy::Distorted => self
                .session
                .outcome()
                .is_some_and(|outcome| outcome.distortion.faces.len() == scene.mesh().real_triangles().len()),
            SelectBy::All | SelectBy::Invert | SelectBy::Boundary => true,
        }
    }

    pub(super) fn select_by(&mut self, by: SelectBy) {
        if !self.can_select_by(by) {
            return;
        }
        if self.shows_page() {
            let charts: Vec<usize> =
                (0..self.chart_count()).filter(|&chart| self.is_chart_selected_by(chart, by)).collect();
            self.plane.page.select(charts);
        } else if let Some(vertices) = self.vertices_selected_by(by) {
            self.selection.select(vertices);
        }
    }

    fn vertices_selected_by(&self, by: SelectBy) -> Option<BTreeSet<VertexId>> {
        // Just after a change of chart, the scene has the vertices of the chart before.
        let scene = self.mesh_scene().filter(|scene| self.is_of_session(scene))?;
        let sets = VertexSets { positions: &scene.mesh().positions, triangles: scene.mesh().real_triangles() };
        let selected = self.selection.vertices();
        Some(match by {
            SelectBy::All => sets.all(),
            SelectBy::Invert => sets.inverted(selected),
            SelectBy::Grow => sets.grown(selected),
            SelectBy::Shrink => sets.shrunk(selected),
            SelectBy::SharpEdges => sets.up_to_sharp_edges(selected, self.tools.seam.rules.degrees),
            SelectBy::Loops => EdgeLoops(scene.disk()?).loops(selected),
            SelectBy::Rings => EdgeLoops(scene.disk()?).rings(selected),
            SelectBy::Boundary => sets.boundary(),
            SelectBy::Pins => self.session.document().targets.keys().copied().collect(),
            SelectBy::Distorted => {
                let outcome = self.session.outcome()?;
                sets.greatest(|face| outcome.distortion.faces[face].symmetric_dirichlet(), WORST)
            }
        })
    }

    fn is_chart_selected_by(&self, chart: usize, by: SelectBy) -> bool {
        match by {
            SelectBy::Invert => !self.plane.page.selected().contains(&chart),
            SelectBy::Pins => self.session.lock_state(chart) == LockState::Pinned,
            SelectBy::Distorted => match self.session.chart_state(chart) {
                ChartState::Solved(outcome) => outcome.distortion.summary.symmetric_dirichlet.mean > GOOD_ENERGY,
                _ => false,
            },
            _ => true,
        }
    }
}
