//! Maps of a surface along seams, and charts whose maps do not overlap themselves.
//!
//! Some charts have no map that is both one-to-one and of low distortion, or only after very many steps. Then a *local*
//! map is found, which has no folds but may overlap itself. This takes a few solves, and its energy tells if the cut is
//! good enough. More seams keep its parts from overlapping (see `overlap`).

use std::sync::Arc;

use glam::DVec2;

use super::overlap::{self, Division};
use super::search::SeamOptions;
use super::surface::{CutSurface, Opened, OpenedChart};
use crate::bijective::convexity::with_convex_polygons;
use crate::flatten::{Flattener, Options, Step};
use crate::mesh::{DiskMesh, VertexId};
use crate::nonlinear::slim::Slim;
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, Settings, SolveError};
use crate::verify::{distortion, is_one_to_one};

/// Share of the allowed excess at which the relaxing of a large surface ends.
const ENOUGH: f64 = 0.98;

/// Number of faces from which one cut is tried at a time, and search and relaxing end once the bound is met.
pub(super) const LARGE: usize = 30_000;

/// Energy of a planar start above which a one-to-one map is given up. Starts of whole models have up to 210; those of
/// parts whose local maps overlap themselves over and over have 10⁵ to 10¹⁴.
const HOPELESS: f64 = 1e5;

/// Energy after one round of relaxing above which a one-to-one map is given up.
const STILL_HOPELESS: f64 = 1e3;

/// Most faces of a chart that is relaxed once before it is given up.
const FEW: usize = 5000;

/// Steps of a grid across a map on which the map has to stay planar: far more than rounding moves a coordinate.
const GRID: f64 = (1_u64 << 36) as f64;

/// Map of a surface along seams.
#[derive(Clone, Debug)]
pub(super) struct Mapped {
    /// True for each edge that is a seam, in the order of the part's edge table.
    pub(super) is_seam: Vec<bool>,
    /// Mean symmetric Dirichlet energy; infinite if the map is not planar.
    pub(super) energy: f64,
    /// True if there are several charts.
    pub(super) is_divided: bool,
    /// True if rounding cannot make the map overlap itself.
    pub(super) is_clear: bool,
    /// Vertex of the map at each corner of the part.
    pub(super) corners: Vec<VertexId>,
    pub(super) embedding: Embedding,
}

/// Map along the seams of one cut.
pub(super) enum Trial {
    /// One-to-one map, perhaps along more seams.
    Map(Mapped),
    /// Energy of a local map that is above the bound. Infinite if there is no local map, or none without overlaps.
    TooDistorted(f64),
}

impl Trial {
    /// No map.
    const FAILED: Self = Self::TooDistorted(f64::INFINITY);
}

/// Surface, settings and control of all maps of a search.
#[derive(Clone, Copy)]
pub(super) struct Mapping<'a> {
    pub(super) surface: &'a CutSurface<'a>,
    pub(super) options: SeamOptions,
    pub(super) control: Control<'a>,
}

impl<'a> Mapping<'a> {
    /// Flattens and relaxes every chart of the surface along seams, one-to-one.
    pub(super) fn map(self, is_seam: Vec<bool>) -> Result<Mapped, SolveError> {
        let opened = self.surface.opened(&is_seam)?;
        let maps = opened.mapped(|chart| self.run(chart, None).finished())?;
        Ok(joined(is_seam, &opened, maps))
    }

    /// Map along the seams of a cut. If a one-to-one map would take very many steps, a local map is found instead, and
    /// more seams keep its parts from overlapping unless its energy is above `most`.
    pub(super) fn tried(self, is_seam: Vec<bool>, most: f64) -> Result<Trial, SolveError> {
        let opened = self.surface.opened(&is_seam)?;
        let [chart] = &opened.charts[..] else { return self.map(is_seam).map(Trial::Map) };
        match self.run(chart, None).finished_unless_hopeless()? {
            Some(map) => Ok(Trial::Map(joined(is_seam, &opened, vec![map]))),
            None => self.apart(&is_seam, &opened, most),
        }
    }

    /// Map along the seams of a cut and more seams that keep its parts from overlapping.
    pub(super) fn tried_apart(self, is_seam: &[bool]) -> Result<Trial, SolveError> {
        let opened = self.surface.opened(is_seam)?;
        if opened.charts.len() == 1 { self.apart(is_seam, &opened, f64::INFINITY) } else { Ok(Trial::FAILED) }
    }

    fn apart(self, is_seam: &[bool], opened: &Opened, most: f64) -> Result<Trial, SolveError> {
        let chart = &opened.charts[0];
        let Some(local) = self.local_map(chart)? else { return Ok(Trial::FAILED) };
        if local.energy > most {
            return Ok(Trial::TooDistorted(local.energy));
        }
        let Some(conflicts) = overlap::conflicts(chart, &local.embedding) else { return Ok(Trial::FAILED) };
        if conflicts.is_empty() {
            let map = self.started_at(chart, local.embedding)?;
            return Ok(Trial::Map(joined(is_seam.to_vec(), opened, vec![map])));
        }
        Ok(self.divided(is_seam, opened, &local, &conflicts)?.map_or(Trial::FAILED, Trial::Map))
    }

    /// Map of the charts into which conflicts of a local map divide the only chart of a cut. `None` if it is not
    /// planar.
    fn divided(
        self,
        is_seam: &[bool],
        opened: &Opened,
        local: &ChartMap,
        conflicts: &[[u32; 2]],
    ) -> Result<Option<Mapped>, SolveError> {
        let Some(more) = Division::new(self.surface, is_seam, conflicts, self.control).seams()? else {
            return Ok(None);
        };
        let mut all = is_seam.to_vec();
        for edge in more {
            all[edge as usize] = true;
        }
        let Ok(divided) = self.surface.opened(&all) else { return Ok(None) };
        if divided.charts.len() < 2 {
            return Ok(None);
        }
        let before = opened.positions(std::slice::from_ref(&local.embedding));
        let mut positions = vec![DVec2::ZERO; divided.vertex_count];
        for (new, old) in divided.corners.iter().zip(&opened.corners) {
            positions[new.index()] = before[old.index()];
        }
        let map = |chart: &OpenedChart| {
            let start = Embedding::with_holes(chart.disk.mesh(), chart.vertex_of.iter().map(|v| positions[v.index()]));
            self.started_at(chart, start)
        };
        Ok(Some(joined(all, &divided, divided.mapped(map)?)).filter(|map| map.energy.is_finite()))
    }

    /// Map relaxed from a start, or from scratch if the start does not lead to one that is clearly planar.
    fn started_at(self, chart: &OpenedChart, start: Embedding) -> Result<ChartMap, SolveError> {
        let map = self.run(chart, Some(start)).finished()?;
        let is_good = map.energy.is_finite() && is_clearly_planar(&chart.disk, &map.embedding);
        if is_good { Ok(map) } else { self.run(chart, None).finished() }
    }

    fn run<'b>(self, OpenedChart { disk, polygons, .. }: &'b OpenedChart, start: Option<Embedding>) -> Run<'b>
    where
        'a: 'b,
    {
        let settings = Settings { relax_rounds: Some(self.options.rounds), ..Settings::default() };
        let options =
            Options { settings, layout_is_free: start.is_some(), layout: start.map(Arc::new), ..Options::default() };
        let enough = SeamOptions::ISOMETRIC + ENOUGH * (self.options.bound - SeamOptions::ISOMETRIC);
        let enough = (disk.face_count() > LARGE).then_some(enough);
        Run { disk, polygons, flattener: Flattener::with_options(options), enough, control: self.control }
    }

    /// Map without folds that may overlap itself. `None` if folds remain.
    fn local_map(self, chart: &OpenedChart) -> Result<Option<ChartMap>, SolveError> {
        let map = match Slim::unfolding(&chart.disk, self.control) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            map => map.ok().flatten(),
        };
        let of = |map: Slim| {
            let on_surface = map.embedding().into_inner().into_iter().take(chart.vertex_of.len());
            let embedding = Embedding::with_holes(chart.disk.mesh(), on_surface);
            ChartMap { energy: map.progress().energy, embedding }
        };
        Ok(map.map(of).filter(|map| map.energy.is_finite()))
    }
}

/// Run of a chart without pins.
struct Run<'a> {
    disk: &'a DiskMesh,
    /// The disk with its polygons.
    polygons: &'a DiskMesh,
    flattener: Flattener,
    /// Energy at which relaxing ends.
    enough: Option<f64>,
    control: Control<'a>,
}

impl Run<'_> {
    /// Takes all steps.
    fn finished(self) -> Result<ChartMap, SolveError> {
        Ok(self.finished_unless(|_| false)?.expect("the run was not given up"))
    }

    /// Takes all steps. `None` if the conformal map is not planar, and the first planar map is so distorted that very
    /// many steps would follow. A chart of few faces gets one round of relaxing before it is given up.
    fn finished_unless_hopeless(self) -> Result<Option<ChartMap>, SolveError> {
        let disk = self.disk;
        let (mut has_start, mut is_bad) = (false, false);
        self.finished_unless(|step| {
            if is_bad {
                return step.candidate.progress.is_some_and(|progress| progress.energy > STILL_HOPELESS);
            }
            let is_first = step.verdict.planar && !std::mem::replace(&mut has_start, step.verdict.planar);
            is_bad = is_first && step.index > 0 && mean_energy(disk, &step.candidate.solution.embedding) > HOPELESS;
            is_bad && disk.face_count() > FEW
        })
    }

    /// Takes all steps. `None` if `gives_up` is true for one of them.
    fn finished_unless(mut self, mut gives_up: impl FnMut(&Step) -> bool) -> Result<Option<ChartMap>, SolveError> {
        let mut last = None;
        let step = loop {
            let step = match self.flattener.step(self.disk, self.control) {
                Ok(step) => step,
                Err(error) => break last.filter(|_| error != SolveError::Cancelled).ok_or(error)?,
            };
            if self.is_over(&step) {
                break step;
            }
            if gives_up(&step) {
                return Ok(None);
            }
            last = Some(step);
        };
        let embedding = step.candidate.solution.embedding;
        if !step.verdict.planar {
            return Ok(Some(ChartMap { energy: f64::INFINITY, embedding }));
        }
        let embedding = with_convex_polygons(self.polygons, embedding, self.control)?;
        Ok(Some(ChartMap { energy: mean_energy(self.disk, &embedding), embedding }))
    }

    fn is_over(&self, step: &Step) -> bool {
        let energy = step.candidate.progress.map_or(f64::INFINITY, |progress| progress.energy);
        let is_enough = self.enough.is_some_and(|enough| step.verdict.planar && energy <= enough);
        is_enough || self.flattener.ending().is_some()
    }
}

/// Map of one chart.
struct ChartMap {
    /// Mean symmetric Dirichlet energy; infinite if the map is not planar.
    energy: f64,
    embedding: Embedding,
}

impl Opened {
    /// Maps of all charts, or the error of the first that has none.
    fn mapped(
        &self,
        map: impl Fn(&OpenedChart) -> Result<ChartMap, SolveError> + Send + Sync,
    ) -> Result<Vec<ChartMap>, SolveError> {
        let maps: Vec<Result<ChartMap, SolveError>> = self.charts.par_iter().with_max_len(1).map(map).collect();
        maps.into_iter().collect()
    }

    /// Position of each vertex by the maps of all charts.
    fn positions(&self, maps: &[Embedding]) -> Vec<DVec2> {
        let mut positions = vec![DVec2::ZERO; self.vertex_count];
        for (chart, map) in self.charts.iter().zip(maps) {
            for (vertex, position) in chart.vertex_of.iter().zip(map) {
                positions[vertex.index()] = *position;
            }
        }
        positions
    }
}

/// True if a map stays planar once its coordinates are rounded to a grid. The two sides of a seam across a flat region
/// lie on each other in a map without distortion, so that any rounding could cross them.
fn is_clearly_planar(disk: &DiskMesh, embedding: &Embedding) -> bool {
    let step = embedding.bounds().extent() / GRID;
    let rounded: Embedding = embedding.iter().map(|z| (*z / step).round() * step).collect();
    is_one_to_one(disk, &rounded)
}

/// Mean symmetric Dirichlet energy.
fn mean_energy(disk: &DiskMesh, embedding: &Embedding) -> f64 {
    distortion(disk, embedding).summary.symmetric_dirichlet.mean
}

/// Map of a surface by the maps of its charts.
fn joined(is_seam: Vec<bool>, opened: &Opened, maps: Vec<ChartMap>) -> Mapped {
    let areas: Vec<f64> = opened.charts.iter().map(|chart| chart.disk.area()).collect();
    let sum: f64 = maps.iter().zip(&areas).map(|(map, area)| map.energy * area).sum();
    let whole: f64 = areas.iter().sum();
    let energy = if maps.len() == 1 { maps[0].energy } else { sum / whole };
    let maps: Vec<Embedding> = maps.into_iter().map(|map| map.embedding).collect();
    let is_clear = opened.charts.iter().zip(&maps).all(|(chart, map)| is_clearly_planar(&chart.disk, map));
    let embedding = opened.positions(&maps).into();
    Mapped { is_seam, energy, is_divided: maps.len() > 1, is_clear, corners: opened.corners.clone(), embedding }
}
