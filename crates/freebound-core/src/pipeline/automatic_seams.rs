//! Automatic seams of a whole mesh: a short cut of each part, for a map whose distortion is below a bound.

use std::collections::BTreeSet;
use std::time::Instant;

use glam::DVec2;

use super::PreparedMesh;
use crate::cutting::{BestCut, EdgeCosts, PartCut, PartToCut, SeamOptions, costs_of_shape, uncut_map};
use crate::mesh::{PolygonMesh, Preparation, Repair, Repaired, VertexId};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};

/// Seams of a mesh, and a map along them. The map of a part meets the bound if one of the cuts that were tried does,
/// unless charts were joined to keep their number small.
#[derive(Clone, Debug, Default)]
pub struct AutomaticSeams {
    /// Preparation that cuts the mesh along these seams, among others.
    pub form: Preparation,
    /// Position of each corner of the mesh in the map of its part. `None` in parts that were not mapped.
    pub corners: Vec<Option<DVec2>>,
    /// Length of the seams, in units of the mesh.
    pub length: f64,
    /// Area of the surface, in squared units of the mesh.
    pub area: f64,
    /// Bound on the mean symmetric Dirichlet energy of each part.
    pub bound: f64,
    /// Duration of the search, seconds.
    pub seconds: f64,
}

/// Best cut so far of one part, while the search for seams runs.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamProgress {
    /// Number of the part.
    pub part: usize,
    /// Number of all parts.
    pub part_count: usize,
    /// Seams of the part, by vertices of the mesh.
    pub edges: Vec<[VertexId; 2]>,
    /// Length of the seams, in units of the mesh.
    pub length: f64,
    /// Area of the whole surface, in squared units of the mesh.
    pub area: f64,
    /// Mean symmetric Dirichlet energy of the part's map.
    pub energy: f64,
    /// True if the search of the part has ended.
    pub is_final: bool,
}

/// Receiver of the progress of a search. Several threads may call it at once.
pub type SeamReport<'a> = &'a (dyn Fn(SeamProgress) + Sync);

/// Mesh that is to be cut, with its preparation.
#[derive(Clone, Copy, Debug)]
pub struct MeshToCut<'a> {
    /// The mesh as it is in its file.
    pub mesh: &'a PolygonMesh,
    /// A label for each corner, if the preparation cuts along texture coordinates.
    pub labels: Option<&'a [u32]>,
    /// Preparation: repairs, seams to keep, and costs of edges.
    pub form: &'a Preparation,
}

impl AutomaticSeams {
    /// Finds seams for the parts of a mesh. Seams of the preparation are cut first, and its costs steer the search. A
    /// part that cannot be cut this way, such as a one-sided surface, gets no seams. `report` receives each improvement
    /// of a part. Charts above [`SeamOptions::most_charts`] are joined after the last report.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn find(
        to_cut: MeshToCut<'_>,
        options: SeamOptions,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<Self, SolveError> {
        let parts = PartsToCut::new(to_cut);
        let uncut = parts.uncut(options, control)?;
        parts.found(&uncut, options, control, report)
    }

    /// Finds seams like [`find`](Self::find), without a look at maps that need no cut. For a mesh whose map without a cut
    /// misses the bound.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn find_cut(
        to_cut: MeshToCut<'_>,
        options: SeamOptions,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<Self, SolveError> {
        let parts = PartsToCut::new(to_cut);
        let uncut = vec![None; parts.parts.len()];
        parts.found(&uncut, options, control, report)
    }

    /// Maps a plain disk in its preparation, if its map meets the bound without a seam. `None` if it does not, or if the
    /// mesh is no plain disk. `report` receives the map.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn of_uncut(
        prepared: &PreparedMesh,
        mesh: &PolygonMesh,
        options: SeamOptions,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<Option<Self>, SolveError> {
        let start = Instant::now();
        let Some(disk) = prepared.disk().filter(|_| prepared.is_plain_disk()) else { return Ok(None) };
        let Some((map, energy)) = uncut_map(disk, options, control)? else { return Ok(None) };
        let repaired = prepared.repaired.as_deref();
        let polygons = repaired.map_or(mesh, Repaired::polygons);
        let mut corners = vec![None; mesh.corners.len()];
        for (corner, vertex) in polygons.corners.iter().enumerate() {
            corners[repaired.map_or(corner, |repaired| repaired.corner_of(corner))] = Some(map[*vertex]);
        }
        let form = &prepared.form;
        let form = Preparation { seams: form.seams.with_automatic([], options.bound), ..form.clone() };
        let seconds = start.elapsed().as_secs_f64();
        let (area, edges) = (disk.area(), Vec::new());
        report(SeamProgress { part: 0, part_count: 1, edges, length: 0.0, area, energy, is_final: true });
        Ok(Some(Self { form, corners, length: 0.0, area, bound: options.bound, seconds }))
    }

    /// Maps the parts of a mesh along the automatic seams of its preparation, which a search found before.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn along(to_cut: MeshToCut<'_>, options: SeamOptions, control: Control<'_>) -> Result<Self, SolveError> {
        let MeshToCut { mesh, form, .. } = to_cut;
        let automatic = form.seams.automatic();
        let parts = PartsToCut::new(to_cut);
        // The search has joined charts already.
        let options = SeamOptions { most_charts: None, ..options };
        let seams = parts.seams(options, control, |number, part| {
            part.map_along(parts.parts[number].by_edge_in(mesh, |edge| automatic.contains(&edge)))
        })?;
        // A part that could not be mapped keeps its seams.
        Ok(Self { form: form.clone(), ..seams })
    }

    /// Seams by vertices of the mesh: edges to cut in addition to the other seams of the preparation.
    pub fn edges(&self) -> &BTreeSet<[VertexId; 2]> {
        self.form.seams.automatic()
    }

    /// Length of the seams relative to the root of the area.
    pub fn relative_length(&self) -> f64 {
        if self.area > 0.0 { self.length / self.area.sqrt() } else { 0.0 }
    }
}

/// Parts of a mesh, each to be cut.
struct PartsToCut<'a> {
    mesh: &'a PolygonMesh,
    form: &'a Preparation,
    parts: Vec<Repaired>,
    /// Costs of the edges of each part.
    costs: Vec<EdgeCosts>,
    area: f64,
    /// Start of the search.
    start: Instant,
}

impl<'a> PartsToCut<'a> {
    /// Parts of a mesh in its preparation, without the automatic seams. Edges have the costs that were stated.
    fn new(MeshToCut { mesh, labels, form }: MeshToCut<'a>) -> Self {
        let start = Instant::now();
        let uncut = Preparation { cut: false, seams: form.seams.without_automatic(), ..form.clone() };
        let repaired = uncut.repaired_along(mesh, labels);
        let are_finite = repaired.polygons().positions.iter().all(|position| position.is_finite());
        let parts = if repaired.has_faces() && are_finite { repaired.separate_parts() } else { Vec::new() };
        let cost = |edge: [VertexId; 2]| form.seams.costs().get(&edge).copied().unwrap_or(1.0);
        let costs = parts.iter().map(|part| EdgeCosts::new(part.by_edge_in(mesh, cost))).collect();
        Self { mesh, form, parts, costs, area: repaired.triangulate().area(), start }
    }

    /// Part of this number.
    fn part<'b>(&'b self, number: usize, options: SeamOptions, control: Control<'b>) -> PartToCut<'b> {
        PartToCut { part: &self.parts[number], costs: &self.costs[number], options, control }
    }

    /// Maps of the parts that need no cut.
    fn uncut(&self, options: SeamOptions, control: Control<'_>) -> Result<Vec<Option<PartCut>>, SolveError> {
        let numbers = (0..self.parts.len()).into_par_iter().with_max_len(1);
        let uncut = |number: usize| {
            if self.parts[number].is_oriented() { self.part(number, options, control).uncut() } else { Ok(None) }
        };
        let found: Vec<Result<Option<PartCut>, SolveError>> = numbers.map(uncut).collect();
        found.into_iter().collect()
    }

    /// Seams of the parts. `uncut` has the maps of those that need no cut.
    fn found(
        mut self,
        uncut: &[Option<PartCut>],
        options: SeamOptions,
        control: Control<'_>,
        report: SeamReport<'_>,
    ) -> Result<AutomaticSeams, SolveError> {
        self.add_costs_of_shape(|number| uncut[number].is_none(), options.visibility, control)?;
        let progress = |number: usize, best: BestCut<'_>, is_final: bool| SeamProgress {
            part: number,
            part_count: self.parts.len(),
            edges: self.parts[number].seams_in(self.mesh, best.is_seam),
            length: best.length,
            area: self.area,
            energy: best.energy,
            is_final,
        };
        self.seams(options, control, |number, part| {
            let found = match &uncut[number] {
                Some(uncut) => uncut.clone(),
                None => part.cut(&|best| report(progress(number, best, false)))?,
            };
            let best = BestCut { is_seam: &found.is_seam, length: found.length, energy: found.energy };
            report(progress(number, best, true));
            Ok(found)
        })
    }

    /// Makes seams prefer creases and hidden places, in the parts that are cut. `visibility` is the weight of what a
    /// seam shows.
    fn add_costs_of_shape(
        &mut self,
        is_cut: impl Fn(usize) -> bool,
        visibility: f64,
        control: Control<'_>,
    ) -> Result<(), SolveError> {
        for (number, part) in self.parts.iter().enumerate().filter(|(number, _)| is_cut(*number)) {
            if let Some(shape) = costs_of_shape(part, visibility, control)? {
                self.costs[number].multiply(&shape);
            }
        }
        Ok(())
    }

    /// Seams of all parts. `cut` cuts one of them, by its number. A part that cannot be cut gets no seams.
    fn seams(
        &self,
        options: SeamOptions,
        control: Control<'_>,
        cut: impl Fn(usize, PartToCut<'_>) -> Result<PartCut, SolveError> + Sync,
    ) -> Result<AutomaticSeams, SolveError> {
        let cut_one = |number: usize| {
            if !self.parts[number].is_oriented() {
                return Ok(None);
            }
            match cut(number, self.part(number, options, control)) {
                Ok(found) => Ok(Some(found)),
                Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
                Err(_) => Ok(None),
            }
        };
        let numbers = (0..self.parts.len()).into_par_iter().with_max_len(1);
        let found: Vec<Result<Option<PartCut>, SolveError>> = numbers.map(cut_one).collect();
        let found = self.with_few_charts(found.into_iter().collect::<Result<_, _>>()?, options, control)?;
        let corners = vec![None; self.mesh.corners.len()];
        let mut seams = AutomaticSeams { corners, bound: options.bound, area: self.area, ..AutomaticSeams::default() };
        let mut edges = Vec::new();
        for (part, found) in self.parts.iter().zip(found) {
            let Some(found) = found else { continue };
            edges.extend(part.seams_in(self.mesh, &found.is_seam));
            seams.length += found.length;
            for (corner, vertex) in found.corners.iter().enumerate() {
                seams.corners[part.corner_of(corner)] = Some(found.embedding[*vertex]);
            }
        }
        seams.form = Preparation { seams: self.form.seams.with_automatic(edges, options.bound), ..self.form.clone() };
        seams.seconds = self.start.elapsed().as_secs_f64();
        Ok(seams)
    }

    /// Cuts of all parts, with charts joined in those that have most, until the whole mesh has few enough.
    fn with_few_charts(
        &self,
        found: Vec<Option<PartCut>>,
        options: SeamOptions,
        control: Control<'_>,
    ) -> Result<Vec<Option<PartCut>>, SolveError> {
        let counts: Vec<usize> = found.iter().map(|cut| cut.as_ref().map_or(1, |cut| cut.chart_count)).collect();
        let Some(most) = options.most_charts.and_then(|limit| most_of_a_part(&counts, limit)) else { return Ok(found) };
        let joined = |(number, cut): (usize, Option<PartCut>)| {
            let before = match cut {
                Some(before) if before.chart_count > most => before,
                cut => return Ok(cut),
            };
            match self.part(number, options, control).joined(&before, most) {
                Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
                after => Ok(after.ok().flatten().or(Some(before))),
            }
        };
        found.into_par_iter().enumerate().with_max_len(1).map(joined).collect()
    }
}

/// Most charts of a part, so that all parts have at most `limit` together; 1 if there is no such number. `None` if the
/// parts have few enough.
fn most_of_a_part(counts: &[usize], limit: usize) -> Option<usize> {
    let sum = |most: usize| counts.iter().map(|&count| count.min(most)).sum::<usize>();
    let largest = counts.iter().copied().max()?;
    (sum(largest) > limit).then(|| (1..largest).rev().find(|&most| sum(most) <= limit).unwrap_or(1))
}

impl PreparedMesh {
    /// True if the mesh is one disk without holes, so that it need not be cut.
    pub fn is_plain_disk(&self) -> bool {
        let done = self.whole_repaired().map(Repaired::done).unwrap_or_default();
        let is_changed = done.iter().any(|done| matches!(done.repair, Repair::Cut | Repair::FillHoles));
        self.disk().is_some() && self.chart.is_none() && !is_changed
    }

    /// Map of this mesh or chart from the positions of corners. `None` if a vertex has no position, or several.
    pub fn map_of_corners(&self, mesh: &PolygonMesh, corners: &[Option<DVec2>]) -> Option<Embedding> {
        let polygons = self.repaired.as_ref().map_or(mesh, |repaired| repaired.polygons());
        let mut found: Vec<Option<DVec2>> = vec![None; polygons.positions.len()];
        for (corner, vertex) in polygons.corners.iter().enumerate() {
            let of = self.repaired.as_ref().map_or(corner, |repaired| repaired.corner_of(corner));
            let at = corners[of]?;
            if found[vertex.index()].replace(at).is_some_and(|before| before != at) {
                return None;
            }
        }
        let on_surface = found.into_iter().map(Option::unwrap_or_default);
        Some(Embedding::with_holes(self.mesh(), on_surface))
    }
}
