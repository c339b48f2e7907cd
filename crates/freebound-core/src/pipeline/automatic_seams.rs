//! Automatic seams of a whole mesh: a short cut of each part, for a map whose distortion is below a bound.

use std::time::Instant;

use glam::DVec2;

use super::PreparedMesh;
use crate::cutting::{PartCut, SeamOptions, cut_part};
use crate::mesh::{PolygonMesh, Preparation, Repair, Repaired, VertexId};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};

/// Seams of a mesh, and a map along them. The map of a part meets the bound if one of the cuts that were tried does.
#[derive(Clone, Debug, Default)]
pub struct AutomaticSeams {
    /// Seams by vertices of the mesh. They are the edges to cut in addition to those of the preparation.
    pub edges: Vec<[VertexId; 2]>,
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

impl AutomaticSeams {
    /// Finds seams for the parts of a mesh. `labels` has one label per corner if the preparation cuts along texture
    /// coordinates. Seams of the preparation are cut first. A part that cannot be cut this way, such as a one-sided
    /// surface, gets no seams.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub fn find(
        mesh: &PolygonMesh,
        labels: Option<&[u32]>,
        form: &Preparation,
        options: SeamOptions,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let start = Instant::now();
        let nothing = Self { corners: vec![None; mesh.corners.len()], bound: options.bound, ..Self::default() };
        let uncut = Preparation { cut: false, seams: form.seams.with_automatic([]), ..form.clone() };
        let repaired = uncut.repaired_along(mesh, labels);
        if !repaired.is_oriented() {
            return Ok(nothing);
        }
        let parts = repaired.separate_parts();
        let cut = |part: &Repaired| match cut_part(part, options, control) {
            Ok(found) => Ok(Some(found)),
            Err(SolveError::Cancelled) => Err(SolveError::Cancelled),
            Err(_) => Ok(None),
        };
        let found: Vec<Result<Option<PartCut>, SolveError>> = parts.par_iter().with_max_len(1).map(cut).collect();
        let mut seams = Self { area: repaired.triangulate().area(), ..nothing };
        for (part, found) in parts.iter().zip(found) {
            let Some(found) = found? else { continue };
            seams.edges.extend(part.seams_in(mesh, &found.is_seam));
            seams.length += found.length;
            for (corner, vertex) in found.corners.iter().enumerate() {
                seams.corners[part.corner_of(corner)] = Some(found.embedding[*vertex]);
            }
        }
        seams.seconds = start.elapsed().as_secs_f64();
        Ok(seams)
    }

    /// Length of the seams relative to the root of the area.
    pub fn relative_length(&self) -> f64 {
        if self.area > 0.0 { self.length / self.area.sqrt() } else { 0.0 }
    }

    /// Preparation that cuts along these seams.
    pub fn cut_in(&self, form: &Preparation) -> Preparation {
        Preparation { seams: form.seams.with_automatic(self.edges.iter().copied()), ..form.clone() }
    }
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
        let mut found: Vec<Option<DVec2>> = vec![None; self.mesh().vertex_count()];
        for (corner, vertex) in polygons.corners.iter().enumerate() {
            let of = self.repaired.as_ref().map_or(corner, |repaired| repaired.corner_of(corner));
            let at = corners[of]?;
            if found[vertex.index()].replace(at).is_some_and(|before| before != at) {
                return None;
            }
        }
        for hole in self.mesh().holes() {
            let rim: Vec<DVec2> = hole.rim.iter().filter_map(|vertex| found[vertex.index()]).collect();
            let middle = rim.iter().sum::<DVec2>() / rim.len().max(1) as f64;
            for vertex in self.mesh().triangles[hole.faces].iter().flatten() {
                found[vertex.index()].get_or_insert(middle);
            }
        }
        Some(found.into_iter().map(Option::unwrap_or_default).collect())
    }
}
