//! All options of a run, collected before anything is read or built.

use std::collections::BTreeMap;

use super::{Arrangement, Outcome, PreparedMesh, Problem, SolvedChart, Targets};
use crate::geom::{PackingOptions, PictureFrame};
use crate::mesh::{Charts, FaceId, Preparation};
use crate::problem::Settings;

/// Options of a run from a mesh to a proved atlas. Default: method `auto` without pins, safe repairs, packed charts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PipelineOptions {
    /// Repairs, cuts, seams, holes and parts.
    pub preparation: Preparation,
    /// Bound on the mean symmetric Dirichlet energy of each part, for automatic seams: 4 is an isometric map. Seams
    /// are found if the preparation allows cuts. Default: none, the shortest cut.
    pub distortion: Option<f64>,
    /// Most charts along automatic seams. Default: no limit.
    pub most_charts: Option<usize>,
    /// Weight of what an automatic seam shows, from 0 to 1: seams prefer creases and hidden places. Default:
    /// [`VISIBILITY`](crate::cutting::SeamOptions::VISIBILITY).
    pub seam_visibility: Option<f64>,
    /// Method and its settings.
    pub settings: Settings,
    /// Position of texture coordinates in the plane.
    pub frame: PictureFrame,
    /// True if the map is made for a picture: an embedding without pins then lies within the picture.
    pub has_picture: bool,
    /// Targets of the user's pins, by vertices of the input.
    pub targets: Targets,
    /// Picture size and gap for packed charts.
    pub packing: PackingOptions,
    /// Placement of charts without pins. Default: packed.
    pub arrangement: Arrangement,
    /// Sizes of packed charts relative to the others, by their first faces. Default: 1.
    pub sizes: BTreeMap<FaceId, f64>,
    /// Tiles in which charts must be packed, by their first faces. Default: any.
    pub tiles: BTreeMap<FaceId, u32>,
}

impl PipelineOptions {
    /// The problem of these options with other targets.
    pub fn problem_with(&self, targets: Targets) -> Problem {
        Problem::new(&self.settings, self.frame, self.has_picture, targets)
    }

    /// The problem of a mesh of one chart.
    pub fn problem(&self) -> Problem {
        self.problem_with(self.targets.clone())
    }

    /// Problem of each chart, with the targets on its vertices. `charts` are all charts of one mesh, in order.
    pub fn problems(&self, charts: &[&PreparedMesh]) -> Vec<Problem> {
        if let [chart] = charts
            && chart.chart.is_none()
        {
            return vec![self.problem()];
        }
        let mut of_chart = vec![Targets::new(); charts.len()];
        let all = charts.first().and_then(|chart| chart.chart.as_ref()).map(|of| &of.charts);
        for (&vertex, &target) in &self.targets {
            if let Some(number) = all.and_then(|all| all.chart_of_vertex(vertex))
                && let Some(own) = charts[number].chart.as_ref().and_then(|of| of.chart.vertex_at(vertex))
            {
                of_chart[number].insert(own, target);
            }
        }
        of_chart.into_iter().map(|targets| self.problem_with(targets)).collect()
    }

    /// Solved chart with its size and its tile.
    pub fn solved_chart<'a>(&self, chart: &'a PreparedMesh, outcome: &'a Outcome) -> SolvedChart<'a> {
        let solved = SolvedChart::new(chart, outcome);
        let Some(of) = &chart.chart else { return solved };
        let (size, tile) = (self.size_of(&of.charts, of.number), self.tile_of(&of.charts, of.number));
        SolvedChart { size, tile, ..solved }
    }

    /// Tile in which a chart must be packed, if one is given.
    pub fn tile_of(&self, charts: &Charts, number: usize) -> Option<u32> {
        self.tiles.get(&charts.first_face(number)).copied()
    }

    /// Size of a packed chart relative to the others.
    pub fn size_of(&self, charts: &Charts, number: usize) -> f64 {
        self.sizes.get(&charts.first_face(number)).copied().unwrap_or(1.0)
    }
}
