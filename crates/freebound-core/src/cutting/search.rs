//! Search for the cheapest cut whose map meets a bound on its distortion.
//!
//! A *prediction* of the energy steers the search: 8 Var(u) over 4, with u the conformal scale factors (see
//! `scale_factor`). It costs one solve. The energy itself is *measured* a few times: the surface is cut, flattened and
//! relaxed. Relaxing trades angles for areas, so the measured excess over 4 is some 0.3 of the predicted one. The ratio
//! depends on the surface, and little on the cut. So each round of the search corrects it. If costs keep cones away
//! from some vertices, the excess that stays even if the map is free at all other vertices does not count.
//!
//! # Cut for a prediction
//!
//! 1. Cones in a greedy sequence: the next cone is where |u| is greatest if the map is free at the cones before
//!    (M. Ben-Chen, C. Gotsman, G. Bunin 2008). The cut is a Steiner tree through the fewest cones that suffice.
//! 2. Exchange: the cone whose removal saves most for its loss is removed, cones that gain most for their cost are
//!    added until the prediction is met again, and the cheaper cut is kept.
//!
//! If the map of a large surface misses the bound by little, its cut gets more cones instead.
//!
//! # Exact development
//!
//! A surface whose curvature lies at vertices of sharp edges alone, such as a box or a cylinder with caps, is developed
//! without distortion by a cut through all of these vertices. This cut is taken unless it costs much more.
//!
//! # Overlap
//!
//! Some parts would overlap themselves without distortion, however long the seams: a ramp of many turns, or a sheet
//! with many flaps. Their maps are divided into charts (see `mapping` and `overlap`).

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use super::graph::CutGraph;
use super::mapping::{EnergyLimits, LARGE, MEDIUM, Mapped, Mapping, Trial};
use super::scale_factor::{ConformalSystem, ScaleFactors};
use super::surface::{CutSurface, EdgeCosts, Paths};
use crate::mesh::{Repaired, VertexId};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};

/// Most rounds of relaxing of a measured map.
const RELAX_ROUNDS: usize = 40;

/// Ratios of measured and predicted excess that the first round tries.
const FIRST_RATIOS: [f64; 2] = [0.38, 0.31];

/// Share of the allowed excess that a later round aims at.
const AIM: f64 = 0.95;

/// Share of the allowed excess that is close enough to end the search.
const CLOSE: f64 = 0.85;

/// Share of the allowed excess up to which a large surface keeps its cut and gets more seams.
const NEAR: f64 = 1.5;

/// Factor between the two predictions that a round tries.
const BESIDE: f64 = 0.9;

/// Margin of a prediction within its bracket, relative to the bracket.
const MARGIN: f64 = 0.2;

/// Most rounds, if a map meets the bound.
const ROUNDS: usize = 4;

/// Most rounds while no map meets the bound.
const ROUNDS_TO_MEET: usize = 10;

/// Factor of the prediction from one round to the next while no map meets the bound, at most and at least.
const STRICTER: f64 = 0.6;
const STRICTEST: f64 = 0.1;

/// Ratio of measured and predicted excess from which longer seams hardly help: some 25 times the usual ratio. What is
/// left is not due to curvature, but keeps parts of the map from overlapping.
const STUCK: f64 = 8.0;

/// Angle between the normals of two faces from which their edge is sharp, degrees.
const SHARP: f64 = 25.0;

/// Angle defect from which a vertex has curvature, radians.
const CURVED: f64 = 1e-5;

/// Cost of an exact development, at most, relative to the cost of a cut that meets the bound.
const DEVELOPED: f64 = 2.5;

/// Energy of an exact development above that of an isometric map, at most.
const ISOMETRY: f64 = 1e-6;

/// Energy of a divided development above that of an isometric map, at most: joined charts may fit only nearly.
const NEARLY: f64 = 1e-3;

/// Most candidates for a new cone that are compared.
const CANDIDATES: usize = 16;

/// Power of a path's cost by which the gain of a cone is divided.
const POWER: f64 = 0.3;

/// Most exchanges.
const EXCHANGES: usize = 24;

/// Number of exchanges in a row that may be in vain.
const VAIN_EXCHANGES: usize = 3;

/// Number of cones whose removal is tried in an exchange.
const TRIES: usize = 3;

/// Most cones whose worth an exchange finds.
const MOST_TRIED: usize = 64;

/// Relative decrease of the cost that counts.
const CHEAPER: f64 = 1e-6;

/// Number of cones after which the greedy sequence grows by one more at a time.
const CONES_PER_BATCH: usize = 16;

/// Most cones of a greedy sequence.
const MOST_CONES: usize = 4096;

/// Settings of the search for seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamOptions {
    /// Bound on the mean symmetric Dirichlet energy; 4 is an isometric map.
    pub bound: f64,
    /// Rounds of relaxing of each measured map.
    pub rounds: usize,
    /// Most charts of the whole mesh. Parts that are not connected, and regions between seams that were given, keep
    /// one each. Default: no limit.
    pub most_charts: Option<usize>,
    /// Weight of what a seam shows, clamped to 0 to 1. At 0 only the length of seams counts; at 1 seams prefer creases and
    /// hidden places most.
    pub visibility: f64,
}

impl SeamOptions {
    /// Energy of an isometric map, which no bound can be below.
    pub const ISOMETRIC: f64 = 4.0;

    /// Default bound on the energy.
    pub const DISTORTION: f64 = 4.1;

    /// Least bound: below it seams would run through all of a curved surface.
    pub const LEAST: f64 = 4.0001;

    /// Default weight of what a seam shows.
    pub const VISIBILITY: f64 = 0.5;

    /// Options for a bound on the mean symmetric Dirichlet energy, at least [`LEAST`](Self::LEAST).
    pub fn new(bound: f64) -> Self {
        Self { bound: bound.max(Self::LEAST), rounds: RELAX_ROUNDS, most_charts: None, visibility: Self::VISIBILITY }
    }
}

/// Cut of one part, with a map that is planar along it.
#[derive(Clone, Debug)]
pub(crate) struct PartCut {
    /// True for each edge that is a seam, in the order of the part's edge table.
    pub(crate) is_seam: Vec<bool>,
    /// Length of the seams.
    pub(crate) length: f64,
    /// Mean symmetric Dirichlet energy of the map.
    pub(crate) energy: f64,
    /// Vertex of the map at each corner of the part.
    pub(crate) corners: Vec<VertexId>,
    /// Map of the part.
    pub(crate) embedding: Embedding,
    /// Number of charts.
    pub(crate) chart_count: usize,
}

impl PartCut {
    fn new(surface: &CutSurface<'_>, map: Mapped) -> Self {
        let Mapped { is_seam, energy, chart_count, corners, embedding, .. } = map;
        Self { length: surface.length_of(&is_seam), energy, is_seam, corners, embedding, chart_count }
    }
}

/// Cut with its map.
#[derive(Clone, Debug)]
struct Measured {
    /// True for each edge that is a seam.
    is_seam: Vec<bool>,
    /// Cost of the seams.
    cost: f64,
    predicted: f64,
    energy: f64,
    /// Energy that remains because vertices are avoided.
    unavoidable: f64,
    /// One-to-one map. `None` if the map is too distorted, so that only its energy was found.
    map: Option<Mapped>,
}

impl Measured {
    /// Energy above that of an isometric map, without the unavoidable energy.
    fn excess(&self) -> f64 {
        self.energy - SeamOptions::ISOMETRIC - self.unavoidable
    }

    /// True if this cut meets the bound at a lower cost, or comes nearer to it if none meets it.
    fn is_better_than(&self, other: &Self, allowed: f64) -> bool {
        match (other.excess() <= allowed, self.excess() <= allowed) {
            (true, true) => self.cost < other.cost,
            (false, false) => self.energy < other.energy,
            (before, now) => now && !before,
        }
    }
}

/// Predictions between which the bound is just met.
struct Bracket {
    allowed: f64,
    /// Largest prediction whose map met the bound; 0 if there is none.
    met: f64,
    /// Smallest prediction whose map did not; infinite if there is none.
    failed: f64,
}

impl Bracket {
    fn new(allowed: f64) -> Self {
        Self { allowed, met: 0.0, failed: f64::INFINITY }
    }

    fn observe(&mut self, found: &Measured) {
        if found.excess() <= self.allowed {
            self.met = self.met.max(found.predicted);
        } else {
            self.failed = self.failed.min(found.predicted);
        }
    }

    /// Predictions to try next: as the ratio of the best cut suggests, and another one beside it.
    fn next_aims(&self, best: &Measured, round: usize) -> Vec<f64> {
        let aim = AIM * self.allowed * best.predicted / best.excess().max(f64::MIN_POSITIVE);
        if self.met == 0.0 {
            let aim = aim.max(STRICTEST * self.failed);
            let aim = if round == 0 { aim } else { aim.min(STRICTER * self.failed) };
            return vec![aim, BESIDE * aim];
        }
        if self.failed.is_infinite() {
            return vec![aim, BESIDE * aim];
        }
        // Predictions are not exact: a map can meet the bound above one that does not.
        let [low, high] = [self.met.min(self.failed), self.met.max(self.failed)];
        let margin = MARGIN * (high - low);
        vec![aim.clamp(low + margin, high - margin), f64::midpoint(low, high)]
    }
}

/// Best cut so far of a running search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BestCut<'a> {
    /// True for each edge that is a seam, in the order of the part's edge table.
    pub(crate) is_seam: &'a [bool],
    /// Length of the seams.
    pub(crate) length: f64,
    /// Mean symmetric Dirichlet energy of its map.
    pub(crate) energy: f64,
}

/// Part of a mesh that is to be cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartToCut<'a> {
    pub(crate) part: &'a Repaired,
    pub(crate) costs: &'a EdgeCosts,
    pub(crate) options: SeamOptions,
    pub(crate) control: Control<'a>,
}

impl PartToCut<'_> {
    /// Finds a cut. `report` receives each cut that is better than those before.
    ///
    /// # Errors
    ///
    /// Errors of the solves; [`SolveError::NotPlanar`] if no cut makes the part a disk; [`SolveError::Cancelled`].
    pub(crate) fn cut(&self, report: &dyn Fn(BestCut<'_>)) -> Result<PartCut, SolveError> {
        let surface = CutSurface::new(self.part, self.costs);
        let system = ConformalSystem::new(&surface, self.control.cancel())?;
        let mut search = Search {
            surface: &surface,
            system: &system,
            options: self.options,
            control: self.control,
            floor: 0.0,
            cones: Vec::new(),
            is_complete: false,
        };
        search.find_floor()?;
        search.run(report)
    }

    /// Maps the part without a cut, if it is a disk whose map meets the bound. No cut is cheaper.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(crate) fn uncut(&self) -> Result<Option<PartCut>, SolveError> {
        let surface = CutSurface::new(self.part, self.costs);
        let mapping = Mapping { surface: &surface, options: self.options, control: self.control };
        Ok(mapping.uncut()?.map(|map| PartCut::new(&surface, map)))
    }

    /// Maps the part along given seams.
    ///
    /// # Errors
    ///
    /// Errors of the solves, if the seams do not make the part a disk for example; [`SolveError::Cancelled`].
    pub(crate) fn map_along(&self, is_seam: Vec<bool>) -> Result<PartCut, SolveError> {
        let surface = CutSurface::new(self.part, self.costs);
        let mapping = Mapping { surface: &surface, options: self.options, control: self.control };
        Ok(PartCut::new(&surface, mapping.map(is_seam)?))
    }

    /// Joins charts of a cut until at most `most` are left, and maps them. `None` if no two can be joined.
    ///
    /// # Errors
    ///
    /// Errors of the solves; [`SolveError::Cancelled`].
    pub(crate) fn joined(&self, cut: &PartCut, most: usize) -> Result<Option<PartCut>, SolveError> {
        let surface = CutSurface::new(self.part, self.costs);
        let mapping = Mapping { surface: &surface, options: self.options, control: self.control };
        Ok(mapping.joined(cut, most)?.map(|map| PartCut::new(&surface, map)))
    }
}

struct Search<'a> {
    surface: &'a CutSurface<'a>,
    system: &'a ConformalSystem,
    options: SeamOptions,
    control: Control<'a>,
    /// Excess that is predicted if the map is free at all vertices that are not avoided.
    floor: f64,
    /// Greedy sequence of cones.
    cones: Vec<u32>,
    /// True if the sequence cannot be continued.
    is_complete: bool,
}

impl<'a> Search<'a> {
    fn cancel(&self) -> &'a AtomicBool {
        self.control.cancel()
    }

    fn run(&mut self, report: &dyn Fn(BestCut<'_>)) -> Result<PartCut, SolveError> {
        let mut start = CutGraph::topological(self.surface, self.control)?;
        if start.free_vertices().is_empty() {
            self.open_sphere(&mut start)?;
        }
        start.shorten(self.control)?;
        let allowed = self.options.bound - SeamOptions::ISOMETRIC;
        let mut bracket = Bracket::new(allowed);
        let is_large = self.surface.triangles.len() > LARGE;
        let mut best: Option<Measured> = None;
        let mut aims: Vec<f64> = FIRST_RATIOS.iter().map(|ratio| allowed / ratio).collect();
        let mut known: Vec<Vec<bool>> = Vec::new();
        // Cut of the best map, if it misses the bound by little.
        let mut near_miss: Option<CutGraph<'_>> = None;
        for round in 0..ROUNDS_TO_MEET {
            let cuts = self.cuts_of_round(near_miss.take(), &start, &aims)?;
            let fresh: Vec<CutGraph<'_>> = cuts.into_iter().filter(|cut| !known.contains(&cut.is_seam)).collect();
            if fresh.is_empty() {
                break;
            }
            known.extend(fresh.iter().map(|cut| cut.is_seam.clone()));
            let this = &*self;
            let measured: Vec<Result<Measured, SolveError>> =
                fresh.par_iter().with_max_len(1).map(|cut| this.measured(cut)).collect();
            for (graph, found) in fresh.iter().zip(measured) {
                let found = match found {
                    Ok(found) => found,
                    Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
                    // Another cut may serve.
                    Err(_) => continue,
                };
                bracket.observe(&found);
                if best.as_ref().is_none_or(|best| found.is_better_than(best, allowed)) {
                    let Measured { is_seam, energy, .. } = &found;
                    if energy.is_finite() {
                        report(BestCut { is_seam, length: self.surface.length_of(is_seam), energy: *energy });
                    }
                    let is_near = is_large && (allowed..NEAR * allowed).contains(&found.excess());
                    near_miss = is_near.then(|| graph.clone());
                    best = Some(found);
                }
            }
            let Some(current) = &best else {
                for aim in &mut aims {
                    *aim *= STRICTER;
                }
                continue;
            };
            let share = current.excess() / allowed;
            // The relaxing of a large surface ends early, so that its share says little.
            let is_divided = current.map.as_ref().is_some_and(|map| map.chart_count > 1);
            let is_last = is_large || is_divided || round + 1 >= ROUNDS || current.cost <= start.cost();
            let is_stuck = round > 0 && current.map.is_some() && current.excess() > STUCK * current.predicted;
            if (share <= 1.0 && (share > CLOSE || is_last)) || current.predicted <= 0.0 {
                break;
            }
            aims = bracket.next_aims(current, round);
            // More seams of this kind hardly help.
            let apart = is_stuck.then(|| self.kept_apart(current.clone(), allowed)).transpose()?;
            if let Some(apart) = apart.filter(|apart| apart.excess() <= allowed) {
                best = Some(apart);
                break;
            }
        }
        self.finished(&start, best, allowed)
    }

    /// Cut and map at the end of the rounds.
    fn finished(&self, start: &CutGraph<'a>, best: Option<Measured>, allowed: f64) -> Result<PartCut, SolveError> {
        let best = best.filter(|best| best.energy.is_finite() || best.map.is_none());
        let best = best.map(|best| self.kept_apart(best, allowed)).transpose()?;
        let developed = self.development(start, best.as_ref(), allowed)?;
        let Measured { is_seam, map, .. } = developed.or(best).ok_or(SolveError::NotPlanar)?;
        let map = match map {
            Some(map) => map,
            None => self.mapping().map(is_seam)?,
        };
        if !map.energy.is_finite() {
            return Err(SolveError::NotPlanar);
        }
        Ok(PartCut::new(self.surface, map))
    }

    /// Cut that meets the bound with more seams, where a map overlaps itself unless it is distorted.
    fn kept_apart(&self, best: Measured, allowed: f64) -> Result<Measured, SolveError> {
        if best.excess() <= allowed {
            return Ok(best);
        }
        let limits = EnergyLimits { local: f64::INFINITY, joined: self.options.bound + best.unavoidable };
        let apart = self.with_parts_apart(&best, limits)?;
        Ok(apart.filter(|apart| best.map.is_none() || apart.energy < best.energy).unwrap_or(best))
    }

    /// Cut with more seams, so that a map with little distortion does not overlap itself. `None` if there is none.
    fn with_parts_apart(&self, cut: &Measured, limits: EnergyLimits) -> Result<Option<Measured>, SolveError> {
        match self.mapping().tried_apart(&cut.is_seam, limits) {
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            Ok(Trial::Map(map)) => {
                let cost = self.surface.cost_of(&map.is_seam);
                Ok(Some(Measured { is_seam: map.is_seam.clone(), cost, energy: map.energy, map: Some(map), ..*cut }))
            }
            _ => Ok(None),
        }
    }

    /// Exact development: an isometric map along a cut through all vertices with curvature. `None` unless each of them
    /// lies on a sharp edge or alone, as on parts of machines, and unless its cost is at most [`DEVELOPED`] times that
    /// of the best other cut.
    fn development(
        &self,
        start: &CutGraph<'a>,
        best: Option<&Measured>,
        allowed: f64,
    ) -> Result<Option<Measured>, SolveError> {
        let is_on_sharp_edge = self.surface.on_sharp_edges(SHARP);
        let curved = self.system.curved_nodes(CURVED).map(|node| self.system.vertex_of[node]);
        let curved: Vec<u32> = curved.filter(|&vertex| !self.surface.is_on_required_loop(vertex)).collect();
        let is_curved = self.nodes_of(curved.iter().copied());
        let is_smooth = |vertex: u32| {
            is_curved[self.system.node_of[vertex as usize] as usize] && !is_on_sharp_edge[vertex as usize]
        };
        // The apex of a cone is curved and has no such neighbour.
        let is_alone =
            |vertex: u32| self.surface.at(vertex).iter().all(|&edge| !is_smooth(self.surface.other_end(edge, vertex)));
        let is_natural = |&vertex: &u32| {
            (is_on_sharp_edge[vertex as usize] || is_alone(vertex)) && !self.surface.is_avoided[vertex as usize]
        };
        if curved.is_empty() || curved.len() > MOST_CONES || !curved.iter().all(is_natural) {
            return Ok(None);
        }
        let mut graph = start.clone();
        graph.connect(&curved);
        graph.shorten(self.control)?;
        if best.is_some_and(|best| graph.cost() > DEVELOPED * best.cost) {
            return Ok(None);
        }
        let found = match self.measured(&graph) {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            found => found.ok(),
        };
        let Some(found) = found else { return Ok(None) };
        let has_one_chart = |found: &Measured| found.map.as_ref().is_some_and(|map| map.chart_count == 1);
        let is_good = |found: &Measured, most: f64| {
            let is_flat = |map: &Mapped| map.energy <= SeamOptions::ISOMETRIC + most && map.is_clear;
            // Several charts are taken only if they are shorter than the best other cut, or if that does not serve.
            let is_cheap = best.is_none_or(|best| {
                let factor = if has_one_chart(found) { DEVELOPED } else { 1.0 };
                found.cost <= factor * best.cost || best.excess() > allowed
            });
            found.map.as_ref().is_some_and(is_flat) && is_cheap
        };
        if is_good(&found, ISOMETRY) {
            return Ok(Some(found));
        }
        // A development that overlaps itself is divided.
        let [local, joined] = [ISOMETRY, NEARLY].map(|most| SeamOptions::ISOMETRIC + most);
        let apart = self.with_parts_apart(&found, EnergyLimits { local, joined })?;
        Ok(apart.filter(|apart| is_good(apart, NEARLY)))
    }

    /// Cuts for predictions: the cut that nearly met the bound, with more cones, or new cuts.
    fn cuts_of_round(
        &mut self,
        near_miss: Option<CutGraph<'a>>,
        start: &CutGraph<'a>,
        aims: &[f64],
    ) -> Result<Vec<CutGraph<'a>>, SolveError> {
        let Some(before) = near_miss else { return self.cuts_for(start, aims) };
        let mut graph = before.clone();
        self.grow(&mut graph, self.floor + aims[0])?;
        if graph.is_seam == before.is_seam { self.cuts_for(start, aims) } else { Ok(vec![graph]) }
    }

    /// Different cuts for predictions. A surface that is not small gets one.
    fn cuts_for(&mut self, start: &CutGraph<'a>, aims: &[f64]) -> Result<Vec<CutGraph<'a>>, SolveError> {
        let aims = if self.surface.triangles.len() > MEDIUM { &aims[..1] } else { aims };
        for &most in aims {
            self.extend_sequence(start, self.floor + most)?;
        }
        let this = &*self;
        let cuts: Vec<Result<CutGraph<'a>, SolveError>> =
            aims.par_iter().with_max_len(1).map(|&most| this.cut_for(start, this.floor + most)).collect();
        let mut different: Vec<CutGraph<'a>> = Vec::new();
        for cut in cuts {
            let cut = cut?;
            if different.iter().all(|other| other.is_seam != cut.is_seam) {
                different.push(cut);
            }
        }
        Ok(different)
    }

    /// Finds the excess that no cut outside the avoided vertices can remove.
    fn find_floor(&mut self) -> Result<(), SolveError> {
        let is_free =
            |node: usize| self.is_allowed(node) || self.surface.is_on_required_loop(self.system.vertex_of[node]);
        let is_allowed: Vec<bool> = (0..self.system.node_count()).map(is_free).collect();
        if is_allowed.contains(&false) && is_allowed.contains(&true) {
            self.floor = self.excess(&self.system.solve(is_allowed, self.cancel())?);
        }
        Ok(())
    }

    /// True if a node may become a cone.
    fn is_allowed(&self, node: usize) -> bool {
        !self.surface.is_avoided[self.system.vertex_of[node] as usize]
    }

    /// Joins two far cones of a closed surface.
    fn open_sphere(&self, graph: &mut CutGraph<'_>) -> Result<(), SolveError> {
        let nodes = self.system.node_count();
        let mut is_fixed = vec![false; nodes];
        is_fixed[0] = true;
        let grounded = self.system.solve(is_fixed, self.cancel())?;
        let u = grounded.solved(&self.system.evened(), self.cancel())?;
        let mean = u.iter().sum::<f64>() / u.len() as f64;
        // A closed surface has to be cut somewhere.
        let has_choice = (0..nodes).filter(|&node| self.is_allowed(node)).count() > 1;
        let is_allowed = |node: usize| f64::from(u8::from(!has_choice || self.is_allowed(node)));
        let first = extreme((0..nodes).map(|node| is_allowed(node) * (u[node] - mean).abs()));
        let mut is_fixed = vec![false; nodes];
        is_fixed[first] = true;
        let u = self.system.solve(is_fixed, self.cancel())?.u;
        let second = extreme((0..nodes).map(|node| is_allowed(node) * u[node].abs()));
        let [from, to] = [first, second].map(|node| self.system.vertex_of[node]);
        graph.add_cone(from, []);
        graph.add_cone(to, self.surface.path(&[from], |v| v == to).unwrap_or_default());
        if graph.has_enough() {
            return Ok(());
        }
        // On the smallest surfaces two cones are neighbours.
        let third = self.surface.path(&[from, to], |v| v != from && v != to).unwrap_or_default();
        let end = third.first().map(|&edge| self.surface.edges[edge as usize].ends);
        let end = end.into_iter().flatten().find(|&v| v != from && v != to);
        if let Some(end) = end {
            graph.add_cone(end, third);
        }
        Ok(())
    }

    fn nodes_of(&self, vertices: impl IntoIterator<Item = u32>) -> Vec<bool> {
        let mut is_in = vec![false; self.system.node_count()];
        for vertex in vertices {
            is_in[self.system.node_of[vertex as usize] as usize] = true;
        }
        is_in
    }

    /// Scale factors for a cut.
    fn factors(&self, graph: &CutGraph<'_>) -> Result<ScaleFactors, SolveError> {
        Ok(self.system.solve(self.nodes_of(graph.free_vertices()), self.cancel())?)
    }

    fn excess(&self, factors: &ScaleFactors) -> f64 {
        8.0 * self.system.variance(&factors.u)
    }

    /// Predicted excess of the energy over 4.
    fn predicted(&self, graph: &CutGraph<'_>) -> Result<f64, SolveError> {
        Ok(self.excess(&self.factors(graph)?))
    }

    /// Continues the greedy sequence until a map that is free at its cones alone is predicted to have at most this
    /// excess.
    fn extend_sequence(&mut self, start: &CutGraph<'_>, most: f64) -> Result<(), SolveError> {
        while !self.is_complete && self.cones.len() < MOST_CONES {
            self.control.go_on()?;
            let mut is_fixed = self.nodes_of(start.anchors().into_iter().chain(self.cones.iter().copied()));
            if !is_fixed.contains(&true) {
                is_fixed = self.nodes_of([start.free_vertices()[0]]);
            }
            let factors = self.system.solve(is_fixed, self.cancel())?;
            if self.excess(&factors) <= most {
                return Ok(());
            }
            let peaks = self.peaks(&factors);
            self.is_complete = peaks.is_empty();
            let count = (1 + self.cones.len() / CONES_PER_BATCH).min(peaks.len());
            self.cones.extend(peaks[..count].iter().map(|&node| self.system.vertex_of[node]));
        }
        Ok(())
    }

    /// Cut through the first cones of the sequence.
    fn through(&self, start: &CutGraph<'a>, count: usize) -> Result<CutGraph<'a>, SolveError> {
        let mut graph = start.clone();
        graph.connect(&self.cones[..count]);
        graph.shorten(self.control)?;
        Ok(graph)
    }

    /// Cut through the fewest cones of the sequence for which the prediction is at most `most`.
    fn spread(&self, start: &CutGraph<'a>, most: f64) -> Result<CutGraph<'a>, SolveError> {
        let (mut low, mut high) = (0, self.cones.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.predicted(&self.through(start, middle)?)? <= most {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        self.through(start, high)
    }

    /// Adds cones until the prediction is at most `most`.
    fn grow(&self, graph: &mut CutGraph<'_>, most: f64) -> Result<(), SolveError> {
        loop {
            self.control.go_on()?;
            let factors = self.factors(graph)?;
            if self.excess(&factors) <= most || graph.cones().len() >= MOST_CONES {
                return Ok(());
            }
            let paths = self.surface.paths(&graph.free_vertices());
            let best = self.best_cones(&factors, &paths)?;
            if best.is_empty() {
                return Ok(());
            }
            let count = (1 + graph.cones().len() / CONES_PER_BATCH).min(best.len());
            for &cone in &best[..count] {
                graph.add_cone(cone, paths.to(self.surface, cone));
            }
            graph.shorten(self.control)?;
        }
    }

    /// Candidates for cones, those with the largest gain for the cost of their path first.
    fn best_cones(&self, factors: &ScaleFactors, paths: &Paths) -> Result<Vec<u32>, SolveError> {
        let before = self.system.variance(&factors.u);
        let score = |node: usize| {
            let vertex = self.system.vertex_of[node];
            let gain = before - self.system.variance(&factors.with_fixed(node, self.cancel())?);
            Ok((vertex, gain / paths.far[vertex as usize].powf(POWER)))
        };
        let scored: Vec<Result<(u32, f64), SolveError>> = self.peaks(factors).into_par_iter().map(score).collect();
        let mut scored = scored.into_iter().collect::<Result<Vec<_>, _>>()?;
        // Where no cone lowers the variance by itself, the highest peak comes first.
        scored.sort_by(|a, b| b.1.max(0.0).total_cmp(&a.1.max(0.0)));
        Ok(scored.into_iter().map(|(vertex, _)| vertex).collect())
    }

    /// Nodes where |u| has a local maximum, the largest first.
    fn peaks(&self, factors: &ScaleFactors) -> Vec<usize> {
        let node = |v: u32| self.system.node_of[v as usize] as usize;
        let size = |node: usize| if self.is_allowed(node) { factors.u[node].abs() } else { 0.0 };
        let is_peak = |&at: &usize| {
            let vertex = self.system.vertex_of[at];
            let edges = self.surface.at(vertex);
            let is_higher = |&edge: &u32| size(node(self.surface.other_end(edge, vertex))) <= size(at);
            self.is_allowed(at) && !factors.is_fixed(at) && !edges.is_empty() && edges.iter().all(is_higher)
        };
        let mut peaks: Vec<usize> = (0..self.system.node_count()).filter(is_peak).collect();
        peaks.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        peaks.truncate(CANDIDATES);
        peaks
    }

    /// Exchanges cones while the cut becomes cheaper and the prediction stays at most `most`.
    fn exchange(&self, graph: &mut CutGraph<'a>, most: f64) -> Result<(), SolveError> {
        let mut worth = BTreeMap::new();
        for cone in graph.cones() {
            worth.insert(cone, f64::INFINITY);
        }
        let mut failures = 0;
        for _ in 0..EXCHANGES {
            self.control.go_on()?;
            let before = self.predicted(graph)?;
            let mut cones: Vec<u32> = graph.cones();
            let known = |cone: &u32| worth.get(cone).copied().unwrap_or(f64::INFINITY);
            cones.sort_by(|a, b| known(b).total_cmp(&known(a)).then(a.cmp(b)));
            // Worths that are not known are infinite and come first.
            let fresh = cones.iter().filter(|cone| known(cone).is_infinite()).count();
            cones.truncate(fresh.clamp(2 * TRIES, MOST_TRIED));
            let without = |&cone: &u32| {
                let mut without = graph.clone();
                without.remove_cone(cone);
                let saved = if without.has_enough() { graph.cost() - without.cost() } else { 0.0 };
                let loss = if saved > 0.0 { self.predicted(&without)? - before } else { 0.0 };
                Ok((cone, without, if saved > 0.0 { saved / loss.max(f64::MIN_POSITIVE) } else { 0.0 }))
            };
            let tried: Vec<Result<_, SolveError>> = cones.par_iter().with_max_len(1).map(without).collect();
            let mut tried = tried.into_iter().collect::<Result<Vec<_>, _>>()?;
            for (cone, _, worth_now) in &tried {
                worth.insert(*cone, worth_now.min(f64::MAX));
            }
            tried.retain(|(_, _, worth)| *worth > 0.0);
            tried.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
            tried.truncate(TRIES);
            let regrown = |(cone, mut without, _): (u32, CutGraph<'a>, f64)| {
                without.shorten(self.control)?;
                self.grow(&mut without, most)?;
                Ok((cone, without))
            };
            let regrown: Vec<Result<_, SolveError>> = tried.into_par_iter().with_max_len(1).map(regrown).collect();
            let regrown: Vec<(u32, CutGraph<'a>)> = regrown.into_iter().collect::<Result<Vec<_>, _>>()?;
            for (cone, _) in &regrown {
                // A cone that was tried in vain comes last the next time.
                worth.insert(*cone, 0.0);
            }
            let regrown_count = regrown.len();
            let mut met = Vec::new();
            for (_, cut) in regrown {
                // Where no further cone helps, the prediction stays too high.
                if self.predicted(&cut)? <= most.max(before) {
                    met.push(cut);
                }
            }
            let best = met.into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
            match best.filter(|best| best.cost() < (1.0 - CHEAPER) * graph.cost()) {
                Some(best) => {
                    *graph = best;
                    failures = 0;
                }
                None => failures += 1,
            }
            if failures > VAIN_EXCHANGES || regrown_count == 0 {
                break;
            }
        }
        graph.shorten_all(self.control)
    }

    /// Cut for a prediction of at most `most`.
    fn cut_for(&self, start: &CutGraph<'a>, most: f64) -> Result<CutGraph<'a>, SolveError> {
        let mut graph = self.spread(start, most)?;
        self.grow(&mut graph, most)?;
        self.exchange(&mut graph, most)?;
        // Shorter paths may have raised the prediction.
        self.grow(&mut graph, most)?;
        Ok(graph)
    }

    /// Map of the surface along a cut.
    fn measured(&self, graph: &CutGraph<'a>) -> Result<Measured, SolveError> {
        let predicted = self.predicted(graph)? - self.floor;
        let unavoidable = FIRST_RATIOS[0] * self.floor;
        let is_seam = graph.is_seam.clone();
        let most = self.options.bound + unavoidable;
        let (energy, is_seam, map) = match self.mapping().tried(is_seam, most)? {
            Trial::Map(map) => (map.energy, map.is_seam.clone(), Some(map)),
            Trial::TooDistorted(energy) => (energy, graph.is_seam.clone(), None),
        };
        let cost = self.surface.cost_of(&is_seam);
        Ok(Measured { is_seam, cost, predicted, energy, unavoidable, map })
    }

    fn mapping(&self) -> Mapping<'a> {
        Mapping { surface: self.surface, options: self.options, control: self.control }
    }
}

/// Index of the greatest number, the first of several.
fn extreme(numbers: impl Iterator<Item = f64>) -> usize {
    numbers.enumerate().fold((0, f64::NEG_INFINITY), |best, (at, x)| if x > best.1 { (at, x) } else { best }).0
}
