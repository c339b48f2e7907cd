//! Handling of requests to the page.

use std::collections::BTreeSet;

use glam::{DAffine2, DVec2};

use crate::session::{Action, ChartMove, movement_about};
use crate::ui::Editor;
use crate::ui::state::{Alignment, Axis, PageGesture, PageRequest, Tool};
use freebound_core::geom::Bounds;

impl Editor {
    /// True if the panes show all charts on the page.
    pub fn shows_page(&self) -> bool {
        let has_page = self.plane.page.scene.is_some() && self.session.page().is_some();
        has_page && self.plane.page.is_wanted && self.has_tool_of_page() && !self.plane.comparison.is_shown()
    }

    /// True if the tool works on all charts of the page. The other tools work on the chart on the screen.
    fn has_tool_of_page(&self) -> bool {
        matches!(self.tools.tool(), Tool::Select | Tool::Brush)
    }

    /// True if the page is to be shown, once all charts are solved.
    pub(in crate::ui) fn awaits_page(&self) -> bool {
        let is_wanted = self.plane.page.is_wanted && self.has_tool_of_page();
        is_wanted
            && self.plane.page.scene.is_none()
            && self.session.charts().is_some()
            && self.session.failed_chart().is_none()
    }

    /// Reason why packing does nothing.
    pub(in crate::ui) fn pack_hindrance(&self) -> Option<&'static str> {
        if !self.shows_page() {
            Some("Show all charts on the page first")
        } else if self.plane.page.selected().is_empty() && !self.session.has_placed_charts() {
            Some("All charts are packed already")
        } else {
            None
        }
    }

    /// Activates a tool. Ends a stroke of the brush, and drops a gesture on charts.
    pub(in crate::ui::editor) fn take_up_tool(&mut self, tool: Tool) {
        if tool != Tool::Select {
            self.drop_gesture();
        }
        if tool != Tool::Brush && self.session.is_brushing() {
            self.act(Action::EndBrush);
        }
        self.tools.take_up(tool);
    }

    pub(in crate::ui::editor) fn handle_page(&mut self, request: PageRequest) {
        match request {
            PageRequest::Show(is_wanted) => self.show_page(is_wanted),
            PageRequest::Toggle if self.session.charts().is_none() => {}
            PageRequest::Toggle => self.show_page(!(self.shows_page() || self.awaits_page())),
            PageRequest::Pick { chart, adds } => {
                if chart.is_some() {
                    self.select_charts_of_elements();
                }
                self.pick_chart(chart, adds);
            }
            PageRequest::Add(charts) => {
                self.select_charts_of_elements();
                let charts: Vec<usize> = self.plane.page.selected().iter().copied().chain(charts).collect();
                self.plane.page.select(charts);
            }
            PageRequest::Open(chart) => self.open_chart(chart),
            PageRequest::Begin(kind) => {
                if self.begin_gesture(kind, self.pointer.in_embedding(), false) && self.tools.tool() != Tool::Select {
                    // Clicks end the gesture, and do not brush.
                    self.take_up_tool(Tool::Select);
                }
            }
            PageRequest::Lock(axis) => self.change_gesture(|gesture| gesture.lock(axis)),
            PageRequest::Type(letter) => self.change_gesture(|gesture| gesture.type_letter(letter)),
            PageRequest::End => drop(self.end_gesture()),
            PageRequest::Align(alignment) => self.align(alignment),
            PageRequest::Distribute(axis) => self.distribute(axis),
            PageRequest::Mirror(axis) => self.mirror(axis),
            PageRequest::SetDensity(density) => self.set_density(density),
            PageRequest::Pack if self.plane.page.selected().is_empty() => self.act(Action::PackCharts(None)),
            PageRequest::Pack => self.act(Action::PackCharts(Some(self.plane.page.selected().clone()))),
            PageRequest::PackAll => self.act(Action::PackCharts(None)),
            PageRequest::Stack => self.act(Action::StackCharts(self.plane.page.selected().clone())),
            PageRequest::Unstack => self.act(Action::UnstackCharts(self.plane.page.selected().clone())),
            PageRequest::SetSnap(snap) => self.plane.page.snap = snap,
        }
    }

    pub(in crate::ui::editor) fn chart_count(&self) -> usize {
        self.session.charts().map_or(0, |charts| charts.count())
    }

    /// Shows the chart on the screen alone, because its elements are to be seen.
    pub(in crate::ui::editor) fn leave_page(&mut self) {
        if self.session.charts().is_some() {
            self.drop_gesture();
            self.plane.page.is_wanted = false;
        }
    }

    fn show_page(&mut self, is_wanted: bool) {
        self.drop_gesture();
        self.plane.page.is_wanted = is_wanted;
        if is_wanted && !self.has_tool_of_page() {
            self.tools.take_up(Tool::Select);
        }
    }

    /// Selects a chart with all charts stacked with it, or adds it to the selection or takes it away.
    fn pick_chart(&mut self, chart: Option<usize>, adds: bool) {
        let Some(chart) = chart else {
            if !adds {
                self.plane.page.select([]);
            }
            return;
        };
        let stack = self.session.page().map(|page| page.with_stacks(&BTreeSet::from([chart]))).unwrap_or_default();
        let before = self.plane.page.selected().clone();
        match (adds, before.contains(&chart)) {
            (false, _) => self.plane.page.select(stack),
            (true, false) => self.plane.page.select(before.union(&stack).copied().collect::<Vec<_>>()),
            (true, true) => self.plane.page.select(before.difference(&stack).copied().collect::<Vec<_>>()),
        }
    }

    /// Shows a chart alone, to work on its vertices.
    fn open_chart(&mut self, chart: Option<usize>) {
        if !self.plane.page.elements().is_empty()
            && let Some(chart) = chart.or(self.charts_of_elements().first().copied())
        {
            return self.open_chart_with_elements(chart);
        }
        let Some(chart) = chart.or(self.plane.page.selected().first().copied()) else { return };
        self.drop_gesture();
        self.plane.page.is_wanted = false;
        if self.session.chart_on_screen() != Some(chart) {
            self.act(Action::ShowChart(chart));
        }
    }

    fn change_gesture(&mut self, change: impl FnOnce(&mut PageGesture)) {
        if let Some(gesture) = &mut self.plane.page.gesture {
            change(gesture);
        }
    }

    /// Selected charts that can be moved, each with its bounds. Of a stack, the chart whose place it is.
    fn boxes(&self) -> Vec<(usize, Bounds)> {
        let (Some(scene), Some(page)) = (&self.plane.page.scene, self.session.page()) else { return Vec::new() };
        let own: BTreeSet<usize> = self.movable_charts().into_iter().map(|chart| page.place_of(chart)).collect();
        own.into_iter().map(|chart| (chart, scene.bounds_of([chart]))).collect()
    }

    fn align(&mut self, alignment: Alignment) {
        let boxes = self.boxes();
        let all = boxes.iter().fold(Bounds::EMPTY, |all, (_, own)| all.union(*own));
        let by = |(chart, own): &(usize, Bounds)| (*chart, DAffine2::from_translation(alignment.shift(*own, all)));
        let moves: Vec<ChartMove> = boxes.iter().map(by).collect();
        self.move_at_once(moves);
    }

    /// Moves the charts between the first and the last one, so that all gaps along an axis are equal.
    fn distribute(&mut self, axis: Axis) {
        let mut boxes = self.boxes();
        if boxes.len() < 3 {
            return;
        }
        let along = |at: DVec2| at.dot(axis.unit());
        boxes.sort_by(|a, b| along(a.1.middle()).total_cmp(&along(b.1.middle())).then(a.0.cmp(&b.0)));
        let taken: f64 = boxes.iter().map(|(_, own)| along(own.size())).sum();
        let (first, last) = (boxes[0].1, boxes[boxes.len() - 1].1);
        let gap = (along(last.high) - along(first.low) - taken) / (boxes.len() - 1) as f64;
        let mut next = along(first.low);
        let by = |(chart, own): &(usize, Bounds)| {
            let shift = next - along(own.low);
            next += along(own.size()) + gap;
            (*chart, DAffine2::from_translation(axis.unit() * shift))
        };
        let moves: Vec<ChartMove> = boxes.iter().map(by).collect();
        self.move_at_once(moves);
    }

    fn mirror(&mut self, axis: Axis) {
        let flip = DAffine2::from_scale(DVec2::ONE - 2.0 * axis.unit());
        let moves = self.boxes().into_iter().map(|(chart, own)| (chart, movement_about(own.middle(), flip))).collect();
        self.move_at_once(moves);
    }

    /// Scales charts in place to a density.
    fn set_density(&mut self, density: f64) {
        // After a move, the densities are known once the layout is judged.
        let densities = self.session.atlas().map(|atlas| atlas.densities.clone()).unwrap_or_default();
        let scaled = |(chart, own): (usize, Bounds)| {
            let factor = density / densities.get(chart)?;
            let by = movement_about(own.middle(), DAffine2::from_scale(DVec2::splat(factor)));
            (factor.is_finite() && factor > 0.0).then_some((chart, by))
        };
        let moves: Vec<ChartMove> = self.boxes().into_iter().filter_map(scaled).collect();
        self.move_at_once(moves);
    }
}
