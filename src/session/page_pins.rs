//! Pins of charts on the page. They are set where the vertices lie, so that no chart moves.

use std::sync::Arc;

use super::chart_layout::ChartPlace;
use super::edits::{pin, unpinned};
use super::page::{ChartPage, ChartVertices, PageChart};
use super::page_actions::given_place;
use super::{ChartEdits, Command, Message, MessagePlace, Session};
use freebound_core::mesh::VertexId;
use freebound_core::pipeline::{ShapedMap, Target, Targets, upright};
use freebound_core::problem::Embedding;

/// Reason why the vertices of a chart cannot be pinned where they lie on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hindrance {
    /// The chart shares the place of another.
    Stacked,
    /// The chart lies mirrored on the page.
    Mirrored,
    /// The map of the chart has flipped faces or crossings.
    Folded,
    /// The page has another shape than the plane of the maps: maps that are pinned there would be stretched.
    OtherShape,
}

impl Hindrance {
    fn of(chart: &PageChart, aspect: f64) -> Option<Self> {
        let verdict = &chart.outcome.step.verdict;
        if chart.stacked.is_some() {
            return Some(Self::Stacked);
        } else if !verdict.planar || verdict.mirrored {
            return Some(Self::Folded);
        } else if aspect.to_bits() != chart.outcome.problem.frame.aspect.to_bits() {
            return Some(Self::OtherShape);
        }
        let at = |vertex: VertexId| chart.coordinates[vertex];
        let corners = chart.mesh().mesh().real_triangles().iter().map(|corners| corners.map(at));
        let doubled: f64 = corners.map(|[a, b, c]| (b - a).perp_dot(c - a)).sum();
        (doubled < 0.0).then_some(Self::Mirrored)
    }

    /// Words on the chart, and what to do.
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Stacked => ["shares the place of another chart", "unstack it first"],
            Self::Mirrored => ["lies mirrored on the page", "mirror it back first"],
            Self::Folded => {
                ["has a map that is not planar", "repair it first, or pin its vertices with the chart alone"]
            }
            Self::OtherShape => {
                ["lies on a page that is not square", "open a picture of its shape first, or make the page square"]
            }
        }
    }
}

/// Pins on the page.
impl Session {
    /// The user's pins of a chart, by the vertices of that chart. `None` if there are no charts, or no such chart.
    pub fn targets_of_chart(&self, chart: usize) -> Option<&Targets> {
        let charts = self.charts().filter(|charts| chart < charts.count())?;
        if charts.pick(self.document.chart) == chart {
            return Some(&self.document.targets);
        }
        self.document.elsewhere.get(&chart).map(|edits| &edits.targets)
    }

    /// Pins vertices of charts where they lie on the page, as one edit. All charts stay where they lie.
    pub(super) fn fix_on_page(&mut self, vertices: &[ChartVertices]) {
        if !self.takes_pins() {
            return;
        }
        let Some((layout, page)) = self.layout_as_it_lies().zip(self.page().cloned()) else { return };
        let (mut commands, mut charts, mut held_back) = (vec![Command::SetLayout(Box::new(layout))], Vec::new(), None);
        for (chart, vertices) in vertices {
            let Some(edits) = self.fixed_on_page(&page, *chart, vertices) else { continue };
            if let Some(hindrance) = Hindrance::of(&page.charts[*chart], page.aspect) {
                held_back = held_back.or(Some((*chart, hindrance)));
                continue;
            }
            charts.push(*chart);
            commands.extend(self.edits_to(*chart, edits));
        }
        self.edit_on_page(commands, charts);
        if let Some((chart, hindrance)) = held_back {
            let [about, remedy] = hindrance.words();
            let text = format!("chart {chart} {about}, so its vertices were not pinned");
            self.messages.say(Message::caution(MessagePlace::Embedding, text).with_remedy(remedy));
        }
    }

    /// Unpins vertices of charts, as one edit. All other charts stay where they lie. A chart without pins stays, too, if
    /// the user shaped its map; if not, it is solved again and packed.
    pub(super) fn unpin_on_page(&mut self, vertices: &[ChartVertices]) {
        if !self.has_form_as_wanted() {
            return;
        }
        let Some((mut layout, page)) = self.layout_as_it_lies().zip(self.page().cloned()) else { return };
        let (mut commands, mut charts) = (Vec::new(), Vec::new());
        for (chart, vertices) in vertices {
            let Some(edits) = self.freed_on_page(&page, *chart, vertices) else { continue };
            let first_face = page.of.first_face(*chart);
            if edits.targets.is_empty() && !layout.locked.contains_key(&first_face) {
                let on_page = &page.charts[*chart];
                layout.placed.remove(&first_face);
                if edits.shaped.is_some() {
                    layout.placed.insert(first_face, ChartPlace(given_place(on_page, &on_page.coordinates)));
                }
            }
            charts.push(*chart);
            commands.extend(self.edits_to(*chart, edits));
        }
        commands.push(Command::SetLayout(Box::new(layout)));
        self.edit_on_page(commands, charts);
    }

    /// Applies edits of charts as one edit and solves these charts.
    fn edit_on_page(&mut self, commands: Vec<Command>, charts: Vec<usize>) {
        let Some(shown) = self.chart_on_screen().filter(|_| !charts.is_empty()) else { return };
        let is_shown_edited = charts.contains(&shown);
        self.remember_charts(charts);
        if self.apply(Command::Together(commands)) && is_shown_edited {
            self.solve();
        }
    }

    /// Commands that give a chart these edits.
    fn edits_to(&self, chart: usize, edits: ChartEdits) -> Vec<Command> {
        if self.chart_on_screen() != Some(chart) {
            return vec![Command::SetElsewhere { chart, edits }];
        }
        let now = &self.document;
        let gone = now.targets.keys().filter(|vertex| !edits.targets.contains_key(vertex));
        let mut commands: Vec<Command> = gone.flat_map(|&vertex| unpinned(vertex)).collect();
        let fresh = edits.targets.iter().filter(|(vertex, target)| now.targets.get(vertex) != Some(target));
        commands.extend(fresh.map(|(&vertex, &target)| pin(vertex, target)));
        commands.extend([Command::SetShaped(edits.shaped), Command::SetRelaxed(edits.relaxed)]);
        commands
    }

    /// Edits of a chart with more vertices pinned where they lie on the page. `None` if none is added.
    ///
    /// The chart keeps the map of the page as one that the user shaped, so that pins do not change it. A map with new
    /// vertices, or with pins that miss their targets, is solved again.
    fn fixed_on_page(&self, page: &ChartPage, chart: usize, vertices: &[VertexId]) -> Option<ChartEdits> {
        let on_page = page.charts.get(chart)?;
        let mut edits = self.document.edits_of(chart, on_page.model.prepared.chart.as_ref()?);
        let place: &Embedding = &given_place(on_page, &on_page.coordinates);
        let upright = upright(place, self.document.v_axis);
        let at = upright.as_ref().unwrap_or(place);
        let fresh = vertices.iter().filter(|vertex| !edits.targets.contains_key(vertex));
        let fixed = |&vertex: &VertexId| Some((vertex, Target::fixed(*at.get(vertex.index())?)));
        let added: Targets = fresh.filter_map(fixed).filter(|(_, target)| target.uv.is_finite()).collect();
        if added.is_empty() {
            return None;
        }
        edits.targets.extend(added);
        let problem = self.document.problem_with(edits.clone());
        let mut in_plane = problem.in_plane(&on_page.coordinates);
        // The page has v up; turning v rounds.
        for (vertex, pin) in problem.settings.held(&problem.pins()).iter().filter(|(_, pin)| pin.kind.is_hard()) {
            in_plane[*vertex] = pin.target;
        }
        let step = &on_page.outcome.step;
        if step.candidate.refinement.is_none() && step.unmet().is_empty() {
            (edits.shaped, edits.relaxed) = (Some(ShapedMap(Arc::new(in_plane))), 0);
        }
        Some(edits)
    }

    /// Edits of a chart without pins of these vertices. `None` if none is removed.
    fn freed_on_page(&self, page: &ChartPage, chart: usize, vertices: &[VertexId]) -> Option<ChartEdits> {
        let on_page = page.charts.get(chart)?;
        let mut edits = self.document.edits_of(chart, on_page.model.prepared.chart.as_ref()?);
        let before = edits.targets.len();
        for vertex in vertices {
            edits.targets.remove(vertex);
            edits.notes.remove(vertex);
        }
        (edits.targets.len() < before).then_some(edits)
    }
}
