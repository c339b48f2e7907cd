//! Pins of the charts on the page.

use std::collections::BTreeMap;

use super::PageScene;
use crate::session::{Action, ChartVertices};
use crate::ui::{Editor, PinMark};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;

/// Pin of a chart on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PagePin {
    /// Vertex of the page.
    pub vertex: VertexId,
    /// Kind that the solver uses.
    pub kind: PinMark,
    /// True if the pin misses its target.
    pub is_unmet: bool,
}

impl Editor {
    /// The user's pins of all charts on the page. None if the method takes no pins.
    pub fn pins_on_page(&self) -> Vec<PagePin> {
        let settings = &self.session.document().settings;
        let scene = self.plane.page.scene().filter(|_| settings.method.uses_pins());
        let Some(scene) = scene else { return Vec::new() };
        let mut pins = Vec::new();
        for (chart, on_page) in scene.charts.iter().enumerate() {
            let Some(targets) = self.session.targets_of_chart(chart).filter(|targets| !targets.is_empty()) else {
                continue;
            };
            let step = &on_page.outcome.step;
            let unmet = if step.verdict.planar { step.unmet() } else { Vec::new() };
            let pin = |(&vertex, target): (&VertexId, &Target)| {
                let kind = PinMark::User(settings.kind_of(target.kind));
                let is_unmet = unmet.binary_search(&vertex).is_ok();
                Some(PagePin { vertex: scene.of_chart(chart, vertex)?, kind, is_unmet })
            };
            pins.extend(targets.iter().filter_map(pin));
        }
        pins
    }

    /// True if vertices are selected that can be pinned: on the page, or on the chart on the screen.
    pub(in crate::ui) fn can_fix_selection(&self) -> bool {
        if self.shows_page() {
            return self.session.can_move_charts() && !self.plane.page.elements().is_empty();
        }
        !self.selection.vertices().is_empty() && self.session.outcome().is_some()
    }

    /// Pins the selected vertices at their current positions.
    pub(in crate::ui::editor) fn fix_selection(&mut self) {
        let action = if self.shows_page() {
            Action::FixOnPage(self.selected_by_chart())
        } else {
            Action::Fix(self.selection.vertices().iter().copied().collect())
        };
        self.act(action);
    }

    /// Frees the selected pins.
    pub(in crate::ui::editor) fn unpin_selected(&mut self) {
        let action = if self.shows_page() {
            Action::UnpinOnPage(self.pins_selected_by_chart())
        } else {
            Action::Unpin(self.pins_selected().collect())
        };
        self.act(action);
    }

    /// True if pins are selected, on the page or on the chart on the screen.
    pub(in crate::ui) fn has_selected_pins(&self) -> bool {
        if self.shows_page() {
            return self.session.can_move_charts() && !self.pins_selected_by_chart().is_empty();
        }
        self.pins_selected().next().is_some()
    }

    /// All pins of the page, by charts.
    pub(in crate::ui) fn pins_by_chart(&self) -> Vec<ChartVertices> {
        let targets = |chart: usize| {
            let targets = self.session.targets_of_chart(chart).filter(|targets| !targets.is_empty())?;
            Some((chart, targets.keys().copied().collect()))
        };
        (0..self.chart_count()).filter_map(targets).collect()
    }

    /// Pins at the selected elements of the page, or of the selected charts.
    fn pins_selected_by_chart(&self) -> Vec<ChartVertices> {
        let pins = self.pins_by_chart();
        if pins.is_empty() {
            return pins;
        }
        let charts = self.plane.page.selected();
        let vertices: BTreeMap<usize, Vec<VertexId>> = self.selected_by_chart().into_iter().collect();
        let is_selected = |chart: usize, vertex: &VertexId| {
            let here = vertices.get(&chart).is_some_and(|vertices| vertices.binary_search(vertex).is_ok());
            here || charts.contains(&chart)
        };
        let selected = |(chart, mut pins): ChartVertices| {
            pins.retain(|vertex| is_selected(chart, vertex));
            (!pins.is_empty()).then_some((chart, pins))
        };
        pins.into_iter().filter_map(selected).collect()
    }

    /// Selected vertices of the page that the file has, by charts, ascending.
    fn selected_by_chart(&self) -> Vec<ChartVertices> {
        self.plane.page.scene().map_or_else(Vec::new, |scene| scene.by_chart(self.plane.page.elements().vertices()))
    }
}

impl PageScene {
    /// Vertices of the page that the file has, by charts.
    fn by_chart<'a>(&self, vertices: impl IntoIterator<Item = &'a VertexId>) -> Vec<ChartVertices> {
        let mut by_chart: BTreeMap<usize, Vec<VertexId>> = BTreeMap::new();
        for (chart, vertex) in vertices.into_iter().filter_map(|vertex| self.on_chart(*vertex)) {
            if self.model_of(chart).is_some_and(|model| vertex.index() < model.vertex_count()) {
                by_chart.entry(chart).or_default().push(vertex);
            }
        }
        by_chart.into_iter().collect()
    }
}
