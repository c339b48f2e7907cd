//! Pins of the charts on the page.

use std::collections::BTreeMap;

use super::PageScene;
use crate::session::{Action, ChartVertices};
use crate::ui::{Editor, PinMark};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::Target;

/// Reason why pins wait while charts are solved.
const UNSOLVED: &str = "Charts are being solved: wait, or repair those that failed";

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

    /// Reason why the selection cannot be pinned, on the page or on the chart on the screen.
    pub(in crate::ui) fn fix_hindrance(&self) -> Option<&'static str> {
        let is_solved =
            if self.shows_page() { self.session.can_move_charts() } else { self.session.outcome().is_some() };
        if self.selected_elements().is_empty() {
            Some("Select vertices, edges or faces first")
        } else {
            (!is_solved).then_some(UNSOLVED)
        }
    }

    /// Reason why no selected pin can be freed.
    pub(in crate::ui) fn unpin_hindrance(&self) -> Option<&'static str> {
        let page = self.shows_page();
        let has_pins =
            if page { !self.pins_selected_by_chart().is_empty() } else { self.pins_selected().next().is_some() };
        if has_pins {
            (page && !self.session.can_move_charts()).then_some(UNSOLVED)
        } else {
            Some("No pin is selected")
        }
    }

    /// Reason why the pins of what is shown cannot all be freed.
    pub(in crate::ui) fn unpin_all_hindrance(&self) -> Option<&'static str> {
        let page = self.shows_page();
        let is_free = if page { self.pins_by_chart().is_empty() } else { self.session.document().targets.is_empty() };
        if is_free { Some("Place a pin first") } else { (page && !self.session.can_move_charts()).then_some(UNSOLVED) }
    }

    /// Frees all pins of the page, or of the chart on the screen.
    pub(in crate::ui::editor) fn unpin_all(&mut self) {
        let action = if self.shows_page() { Action::UnpinOnPage(self.pins_by_chart()) } else { Action::UnpinAll };
        self.act(action);
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
