//! Maps of a surface along seams, and charts whose maps do not overlap themselves.
//!
//! Some charts have no map that is both one-to-one and of low distortion, or only after very many steps. Then a *local*
//! map is found, which has no folds but may overlap itself. This takes a few solves, and its energy tells if the cut is
//! good enough. More seams keep its parts from overlapping (see `overlap`).

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec2;

use super::joining::Joining;
use super::overlap::{self, Division};
use super::rejoining::LocalCharts;
use super::search::{PartCut, SeamOptions};
use super::surface::{CutSurface, Opened, OpenedChart};
use crate::bijective::convexity::with_convex_polygons;
use crate::flatten::{Flattener, Options, Step};
use crate::mesh::{DiskMesh, FaceId, VertexId};
use crate::nonlinear::slim::Slim;
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, Settings, SolveError};
use crate::verify::{distortion, is_one_to_one};

/// Share of the allowed excess at which the relaxing of a large surface ends.
const ENOUGH: f64 = 0.98;

/// Number of faces from which one cut is tried at a time.
pub(super) const MEDIUM: usize = 15_000;

/// Number of faces from which search and relaxing end once the bound is met.
pub(super) const LARGE: usize = 30_000;

/// Energy of a planar start above which the cut is judged by a local map, and a one-to-one map is given up unless one
/// round of relaxing helps. Starts of whole models have up to 210; those of parts whose local maps overlap themselves
/// over and over have 10⁵ to 10¹⁴.
const HOPELESS: f64 = 1e5;

/// Energy of the first map above that of an isometric map, relative to the allowed one, above which relaxing hardly meets
/// the bound. Relaxing leaves some 0.3 of it.
const TOO_FAR: f64 = 4.0;

/// Energy after one round of relaxing above which a one-to-one map is given up.
const STILL_HOPELESS: f64 = 1e3;

/// Steps of a grid across a map on which the map has to stay planar: far more than rounding moves a coordinate.
const GRID: f64 = (1_u64 << 36) as f64;

/// Share of the smallest height of its faces by which a vertex of the boundary moves inwards. Seen in 32 bits, and with
/// an energy of at most some 1e-6 above that of an isometric map.
const HAIR: f64 = 1.0 / 4096.0;

/// Share of the smallest height of its faces by which a vertex of the boundary can move outwards in a clearly planar
/// map: far more than rounding moves it.
const CLEARANCE: f64 = 1.0 / (1 << 30) as f64;

/// Map of a surface along seams.
#[derive(Clone, Debug)]
pub(super) struct Mapped {
    /// True for each edge that is a seam, in the order of the part's edge table.
    pub(super) is_seam: Vec<bool>,
    /// Mean symmetric Dirichlet energy; infinite if the map is not planar.
    pub(super) energy: f64,
    /// Number of charts.
    pub(super) chart_count: usize,
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

/// Largest energies of maps that are taken.
#[derive(Clone, Copy)]
pub(super) struct EnergyLimits {
    /// Energy of a local map that is worth dividing.
    pub(super) local: f64,
    /// Energy of a map whose charts are joined across seams of the cut.
    pub(super) joined: f64,
}

/// Local map of the only chart of a cut, with its conflicts.
#[derive(Clone, Copy)]
struct LocalStart<'a> {
    is_seam: &'a [bool],
    opened: &'a Opened,
    local: &'a ChartMap,
    conflicts: &'a [[u32; 2]],
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

    /// Map without seams, if it meets the bound. `None` if it does not, or if the surface is no disk.
    pub(super) fn uncut(self) -> Result<Option<Mapped>, SolveError> {
        let is_seam = vec![false; self.surface.edges.len()];
        if !self.surface.is_disk() {
            return Ok(None);
        }
        let Ok(opened) = self.surface.opened(&is_seam) else { return Ok(None) };
        let [chart] = &opened.charts[..] else { return Ok(None) };
        let map = self.run(chart, None).finished_within(self.options.bound)?;
        Ok(map.map(|map| joined(is_seam, &opened, vec![map])))
    }

    /// Map along the seams of a cut. If a one-to-one map would take very many steps, a local map is found instead, and
    /// more seams keep its parts from overlapping unless its energy is above `most`.
    pub(super) fn tried(self, is_seam: Vec<bool>, most: f64) -> Result<Trial, SolveError> {
        let opened = self.surface.opened(&is_seam)?;
        let [chart] = &opened.charts[..] else { return self.map(is_seam).map(Trial::Map) };
        let (mut has_start, mut local) = (false, None);
        let map = self.run(chart, None).finished_unless(|step| {
            // One round after a hopeless start.
            if local.is_some() {
                return Ok(step.candidate.progress.is_some_and(|progress| progress.energy > STILL_HOPELESS));
            }
            let is_first = step.verdict.planar && !std::mem::replace(&mut has_start, step.verdict.planar);
            if !is_first || step.index == 0 || mean_energy(&chart.disk, &step.candidate.solution.embedding) <= HOPELESS
            {
                return Ok(false);
            }
            local = self.local_map(chart)?;
            // Another cut is tried if no local map is found, or if it is too distorted.
            Ok(local.as_ref().is_none_or(|map| map.energy > most))
        })?;
        if let Some(map) = map {
            return Ok(Trial::Map(joined(is_seam, &opened, vec![map])));
        }
        self.apart(&is_seam, &opened, local, EnergyLimits { local: most, joined: most })
    }

    /// Map along the seams of a cut and more seams that keep its parts from overlapping.
    pub(super) fn tried_apart(self, is_seam: &[bool], limits: EnergyLimits) -> Result<Trial, SolveError> {
        let opened = self.surface.opened(is_seam)?;
        let [chart] = &opened.charts[..] else { return Ok(Trial::FAILED) };
        self.apart(is_seam, &opened, self.local_map(chart)?, limits)
    }

    /// Map of at most `most` charts: joins those of a cut. `None` if no two can be joined, or if the map is not planar.
    pub(super) fn joined(self, cut: &PartCut, most: usize) -> Result<Option<Mapped>, SolveError> {
        let mut joining = Joining::new(self.surface, &cut.is_seam, |_| true);
        joining.join(most, BTreeSet::new(), |_| true, self.control)?;
        let left = joining.remaining_seams(&cut.is_seam);
        if left == cut.is_seam {
            return Ok(None);
        }
        let opened = self.surface.opened(&left)?;
        let positions = opened.positions_at(cut.corners.iter().map(|vertex| cut.embedding[*vertex]));
        // Charts that were not joined keep their map.
        Ok(Some(self.started_all(left, &opened, &positions)?).filter(|map| map.energy.is_finite()))
    }

    /// Map along the seams of a cut, by the local map of its only chart.
    fn apart(
        self,
        is_seam: &[bool],
        opened: &Opened,
        local: Option<ChartMap>,
        limits: EnergyLimits,
    ) -> Result<Trial, SolveError> {
        let chart = &opened.charts[0];
        let Some(local) = local else { return Ok(Trial::FAILED) };
        if local.energy > limits.local {
            return Ok(Trial::TooDistorted(local.energy));
        }
        let Some(conflicts) = overlap::conflicts(chart, &local.embedding) else { return Ok(Trial::FAILED) };
        if conflicts.is_empty() {
            let map = self.started_at(chart, local.embedding)?;
            return Ok(Trial::Map(joined(is_seam.to_vec(), opened, vec![map])));
        }
        let division = Division::new(self.surface, is_seam, &conflicts, self.control);
        let Some(divided) = division.seams(is_seam)? else { return Ok(Trial::FAILED) };
        let start = LocalStart { is_seam, opened, local: &local, conflicts: &conflicts };
        Ok(self.divided(&divided, start, limits.joined)?.map_or(Trial::FAILED, Trial::Map))
    }

    /// Map of the charts into which seams `all` divide the only chart of a cut. Charts are joined across seams of the
    /// cut if the energy of the whole is then at most `most`. `None` if the map is not planar.
    fn divided(self, all: &[bool], start: LocalStart<'_>, most: f64) -> Result<Option<Mapped>, SolveError> {
        let LocalStart { is_seam, opened, local, conflicts } = start;
        // The local map holds across new seams alone.
        let mut joining = Joining::new(self.surface, all, |edge| !is_seam[edge as usize]);
        let apart = conflicts.iter().map(|pair| joining.pair_of(*pair)).collect();
        joining.join(1, apart, |_| true, self.control)?;
        let all = joining.remaining_seams(all);
        let Ok(divided) = self.surface.opened(&all) else { return Ok(None) };
        if divided.charts.len() < 2 {
            return Ok(None);
        }
        let before = opened.positions(std::slice::from_ref(&local.embedding));
        let positions = divided.positions_at(opened.corners.iter().map(|vertex| before[vertex.index()]));
        let is_good = |map: &Mapped| map.energy.is_finite();
        let rejoined = match self.rejoined(&all, &divided, &positions) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            rejoined => rejoined.ok().flatten(),
        };
        if let Some(map) = rejoined.filter(|map| is_good(map) && map.energy <= most) {
            return Ok(Some(map));
        }
        Ok(Some(self.started_all(all, &divided, &positions)?).filter(is_good))
    }

    /// Map of charts of a local map, some of which are moved to neighbours and joined with them. `None` if none fit.
    fn rejoined(self, is_seam: &[bool], divided: &Opened, positions: &[DVec2]) -> Result<Option<Mapped>, SolveError> {
        let mut joining = Joining::new(self.surface, is_seam, |_| true);
        let mut triangles = vec![Vec::new(); divided.charts.len()];
        for chart in &divided.charts {
            let corners = |face: usize| chart.disk.face(FaceId::from_index(face));
            let faces = (0..chart.face_of.len()).map(corners);
            triangles[joining.chart_of(chart.face_of[0]) as usize] =
                faces.map(|face| face.map(|vertex| chart.vertex_of[vertex.index()].number())).collect();
        }
        let mut local = LocalCharts { positions: positions.to_vec(), triangles };
        joining.join(1, BTreeSet::new(), |meeting| local.bring_together(meeting), self.control)?;
        let left = joining.remaining_seams(is_seam);
        if left == is_seam {
            return Ok(None);
        }
        let Ok(opened) = self.surface.opened(&left) else { return Ok(None) };
        let positions =
            opened.positions_at(divided.corners.iter().map(|vertex| local.positions[joining.root(*vertex)]));
        self.started_all(left, &opened, &positions).map(Some)
    }

    /// Maps all charts from a start, the position of each vertex of the opened part.
    fn started_all(self, is_seam: Vec<bool>, opened: &Opened, positions: &[DVec2]) -> Result<Mapped, SolveError> {
        let map = |chart: &OpenedChart| {
            let start = Embedding::with_holes(chart.disk.mesh(), chart.vertex_of.iter().map(|v| positions[v.index()]));
            self.started_at(chart, start)
        };
        Ok(joined(is_seam, opened, opened.mapped(map)?))
    }

    /// Map relaxed from a start, or from scratch if the start does not lead to one that is clearly planar. A start whose
    /// boundary touches itself is parted there.
    fn started_at(self, chart: &OpenedChart, start: Embedding) -> Result<ChartMap, SolveError> {
        let start = if is_clearly_planar(&chart.disk, &start) { start } else { parted(&chart.disk, &start) };
        let map = self.run(chart, Some(start)).finished()?;
        if map.is_clear {
            return Ok(map);
        }
        let from_scratch = self.run(chart, None).finished()?;
        let is_better = from_scratch.is_clear || !map.energy.is_finite();
        Ok(if is_better { from_scratch } else { map })
    }

    fn run<'b>(self, OpenedChart { disk, polygons, .. }: &'b OpenedChart, start: Option<Embedding>) -> Run<'b>
    where
        'a: 'b,
    {
        Run::new([disk, polygons], start, self.options, self.control)
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
            ChartMap { energy: map.progress().energy, is_clear: false, embedding }
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

/// Map of a disk without seams and its mean energy, if it meets the bound.
///
/// # Errors
///
/// [`SolveError::Cancelled`].
pub(crate) fn uncut_map(
    polygons: &DiskMesh,
    options: SeamOptions,
    control: Control<'_>,
) -> Result<Option<(Embedding, f64)>, SolveError> {
    let disk = polygons.without_polygons();
    let map = Run::new([&disk, polygons], None, options, control).finished_within(options.bound)?;
    Ok(map.map(|map| (map.embedding, map.energy)))
}

impl<'a> Run<'a> {
    /// Run of a disk, given without and with its polygons, from a start or from scratch.
    fn new(
        [disk, polygons]: [&'a DiskMesh; 2],
        start: Option<Embedding>,
        options: SeamOptions,
        control: Control<'a>,
    ) -> Self {
        let settings = Settings { relax_rounds: Some(options.rounds), ..Settings::default() };
        let enough = SeamOptions::ISOMETRIC + ENOUGH * (options.bound - SeamOptions::ISOMETRIC);
        let enough = (disk.face_count() > LARGE).then_some(enough);
        let options =
            Options { settings, layout_is_free: start.is_some(), layout: start.map(Arc::new), ..Options::default() };
        Self { disk, polygons, flattener: Flattener::with_options(options), enough, control }
    }

    /// Takes all steps. `None` if the map misses a bound on its energy, or if its first step is far above it.
    fn finished_within(self, bound: f64) -> Result<Option<ChartMap>, SolveError> {
        let too_far = SeamOptions::ISOMETRIC + TOO_FAR * (bound - SeamOptions::ISOMETRIC);
        let disk = self.disk;
        let is_too_far =
            |step: &Step| !step.verdict.planar || mean_energy(disk, &step.candidate.solution.embedding) > too_far;
        match self.finished_unless(|step| Ok(step.index == 0 && is_too_far(step))) {
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            map => Ok(map.ok().flatten().filter(|map| map.energy <= bound)),
        }
    }

    /// Takes all steps.
    fn finished(self) -> Result<ChartMap, SolveError> {
        Ok(self.finished_unless(|_| Ok(false))?.expect("the run was not given up"))
    }

    /// Takes all steps. `None` if `gives_up` is true for one of them.
    fn finished_unless(
        mut self,
        mut gives_up: impl FnMut(&Step) -> Result<bool, SolveError>,
    ) -> Result<Option<ChartMap>, SolveError> {
        let mut last = None;
        let step = loop {
            let step = match self.flattener.step(self.disk, self.control) {
                Ok(step) => step,
                Err(error) => break last.filter(|_| error != SolveError::Cancelled).ok_or(error)?,
            };
            if self.is_over(&step) {
                break step;
            }
            if gives_up(&step)? {
                return Ok(None);
            }
            last = Some(step);
        };
        let embedding = step.candidate.solution.embedding;
        if !step.verdict.planar {
            return Ok(Some(ChartMap { energy: f64::INFINITY, is_clear: false, embedding }));
        }
        // Rounding in the packed layout could make a boundary cross itself where it touches itself.
        let was_clear = is_clearly_planar(self.disk, &embedding);
        let clear = (!was_clear).then(|| parted(self.disk, &embedding));
        let clear = clear.filter(|parted| is_clearly_planar(self.disk, parted));
        let is_clear = was_clear || clear.is_some();
        let before = clear.unwrap_or(embedding);
        let embedding = with_convex_polygons(self.polygons, before.clone(), self.control)?;
        let is_clear = if embedding == before { is_clear } else { is_clearly_planar(self.disk, &embedding) };
        Ok(Some(ChartMap { energy: mean_energy(self.disk, &embedding), is_clear, embedding }))
    }

    fn is_over(&self, step: &Step) -> bool {
        let energy = || match step.candidate.progress {
            Some(progress) => progress.energy,
            None => mean_energy(self.disk, &step.candidate.solution.embedding),
        };
        let is_enough = self.enough.is_some_and(|enough| step.verdict.planar && energy() <= enough);
        is_enough || self.flattener.ending().is_some()
    }
}

/// Map of one chart.
struct ChartMap {
    /// Mean symmetric Dirichlet energy; infinite if the map is not planar.
    energy: f64,
    /// True if the map is planar, and rounding cannot make it overlap itself.
    is_clear: bool,
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

    /// Position of each vertex by the positions of the part's corners.
    fn positions_at(&self, corners: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
        let mut positions = vec![DVec2::ZERO; self.vertex_count];
        for (vertex, position) in self.corners.iter().zip(corners) {
            positions[vertex.index()] = position;
        }
        positions
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

/// Map with its boundary moved inwards by a hair, so that the two sides of a seam across a flat region part.
fn parted(disk: &DiskMesh, embedding: &Embedding) -> Embedding {
    with_boundary_moved(disk, embedding, HAIR)
}

/// Map with each vertex of the boundary moved inwards, by a share of the smallest height of its faces.
fn with_boundary_moved(disk: &DiskMesh, embedding: &Embedding, share: f64) -> Embedding {
    let mut moved = embedding.clone();
    for &vertex in disk.boundary_loop() {
        let around: Vec<DVec2> =
            disk.outgoing(vertex).map(|side| embedding[disk.head(side)] - embedding[vertex]).collect();
        let (mut angle, mut height) = (0.0, f64::INFINITY);
        for pair in around.windows(2) {
            angle += pair[0].angle_to(pair[1]).abs();
            let longest = pair[0].length().max(pair[1].length()).max(pair[0].distance(pair[1]));
            height = f64::min(height, pair[0].perp_dot(pair[1]).abs() / longest);
        }
        let inwards = DVec2::from_angle(angle / 2.0).rotate(around[0].normalize_or_zero());
        moved[vertex] += share * height * inwards;
    }
    moved
}

/// True if a map stays planar once its boundary is moved outwards and its coordinates are rounded to a grid. The two
/// sides of a seam across a flat region lie on each other in a map without distortion, so that any rounding could cross
/// them.
fn is_clearly_planar(disk: &DiskMesh, embedding: &Embedding) -> bool {
    let step = embedding.bounds().extent() / GRID;
    let moved = with_boundary_moved(disk, embedding, -CLEARANCE);
    let rounded: Embedding = moved.iter().map(|z| (*z / step).round() * step).collect();
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
    let is_clear = maps.iter().all(|map| map.is_clear);
    let maps: Vec<Embedding> = maps.into_iter().map(|map| map.embedding).collect();
    let embedding = opened.positions(&maps).into();
    Mapped { is_seam, energy, chart_count: maps.len(), is_clear, corners: opened.corners.clone(), embedding }
}
