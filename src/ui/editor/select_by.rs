//! Selection of elements by the mesh, by the map and by the present selection; of charts on the page.

use super::Editor;
use crate::session::{ChartState, LockState};
use crate::ui::GOOD_ENERGY;
use crate::ui::state::SelectBy;
use crate::view::{ElementKind, ElementMesh, ElementSet};
use freebound_core::mesh::VertexId;
use freebound_core::verify::FaceDistortion;

/// Share of the area that counts as the most distorted.
const WORST: f64 = 0.1;

impl Editor {
    /// True if this way of selecting applies to what is shown.
    pub fn can_select_by(&self, by: SelectBy) -> bool {
        let Some(kind) = self.element_kind() else {
            return match by {
                SelectBy::All | SelectBy::Invert => true,
                SelectBy::Pins | SelectBy::Distorted => {
                    (0..self.chart_count()).any(|chart| self.is_chart_selected_by(chart, by))
                }
                _ => false,
            };
        };
        let has_selection = !self.selected_elements().is_empty();
        match by {
            SelectBy::Grow | SelectBy::Shrink | SelectBy::SharpEdges | SelectBy::Connected => has_selection,
            SelectBy::Loops | SelectBy::Rings => {
                let is_for = kind != ElementKind::Faces || by == SelectBy::Loops;
                let has_loops = |mesh: &ElementMesh<'_>| mesh.has_loops(&self.selected_on_shown_mesh());
                has_selection && is_for && self.on_shown_mesh(has_loops).unwrap_or_default()
            }
            SelectBy::Pins => kind == ElementKind::Vertices && !self.pinned_vertices().is_empty(),
            SelectBy::Distorted => self.distortion_of_charts().is_some(),
            SelectBy::All | SelectBy::Invert | SelectBy::Boundary => self.on_shown_mesh(|_| ()).is_some(),
        }
    }

    pub(super) fn select_by(&mut self, by: SelectBy) {
        if !self.can_select_by(by) {
            return;
        }
        if let Some(kind) = self.element_kind() {
            if let Some(elements) = self.elements_selected_by(kind, by) {
                self.set_elements(elements);
            }
        } else {
            let charts: Vec<usize> =
                (0..self.chart_count()).filter(|&chart| self.is_chart_selected_by(chart, by)).collect();
            self.plane.page.select(charts);
        }
    }

    fn elements_selected_by(&self, kind: ElementKind, by: SelectBy) -> Option<ElementSet> {
        let distortion = if by == SelectBy::Distorted { self.distortion_of_charts()?.concat() } else { Vec::new() };
        self.on_shown_mesh(|mesh| {
            let selected = mesh.converted(&self.selected_on_shown_mesh(), kind);
            match by {
                SelectBy::All => mesh.all(kind),
                SelectBy::Invert => mesh.inverted(&selected),
                SelectBy::Grow => mesh.grown(&selected),
                SelectBy::Shrink => mesh.shrunk(&selected),
                SelectBy::SharpEdges => mesh.up_to_sharp_edges(&selected, self.tools.seam.rules.degrees),
                SelectBy::Connected => mesh.connected(&selected),
                SelectBy::Loops => mesh.loops(&selected),
                SelectBy::Rings => mesh.rings(&selected),
                SelectBy::Boundary => mesh.boundary(kind),
                SelectBy::Pins => mesh.converted(&ElementSet::of_vertices(self.pinned_vertices()), kind),
                SelectBy::Distorted => mesh.greatest(kind, |face| distortion[face].symmetric_dirichlet(), WORST),
            }
        })
    }

    /// Pinned vertices of what is shown.
    fn pinned_vertices(&self) -> Vec<VertexId> {
        let document = self.session.document();
        let Some(scene) = self.plane.page.scene().filter(|_| self.shows_page()) else {
            return document.targets.keys().copied().collect();
        };
        let shown = self.session.chart_on_screen().map(|chart| (chart, &document.targets));
        let others = document.elsewhere.iter().map(|(&chart, edits)| (chart, &edits.targets));
        let all = others.filter(|(chart, _)| Some(*chart) != self.session.chart_on_screen()).chain(shown);
        let on_page = |(chart, vertex): (usize, VertexId)| scene.of_chart(chart, vertex);
        all.flat_map(|(chart, targets)| targets.keys().map(move |&vertex| (chart, vertex)))
            .filter_map(on_page)
            .collect()
    }

    /// Distortion of the triangles of each chart of what is shown. `None` if it has no map.
    fn distortion_of_charts(&self) -> Option<Vec<&[FaceDistortion]>> {
        if self.shows_page() {
            return Some(self.plane.page.scene()?.distortion());
        }
        let (outcome, scene) = (self.session.outcome()?, self.mesh_scene()?);
        let faces = outcome.distortion.faces.as_slice();
        (faces.len() == scene.mesh().real_triangles().len()).then(|| vec![faces])
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
