//! Matchmaker (stage 5 of the flattener): an embedding that meets any distinct targets, on a mesh with edges split to
//! make room for paths between the targets.
//!
//! The mesh lies in an outside up to a frame. Paths on the mesh, which do not cross, match the edges of a
//! triangulation of targets and frame. Faces that a path cuts are triangulated again, with new vertices on the old
//! edges. Then all paths are straightened, and each region between three of them becomes a triangle in the plane. The
//! method always terminates, because a connected region always contains a path between its ends.
//!
//! Sources: I. Eckstein, V. Surazhsky, C. Gotsman, "Texture mapping with hard constraints", 2001; V. Kraevoy,
//! A. Sheffer, C. Gotsman, "Matchmaker: constructing constrained texture maps", 2003. Their paths run on the edges of
//! the mesh. Here paths cross faces too, so that new vertices lie on old edges only.
//!
//! | file | contents |
//! |---|---|
//! | `target_graph.rs` | graph that the paths match: a triangulation of targets and frame |
//! | `paths.rs` | paths on the mesh, one after another |
//! | `path_router.rs` | shortest path between two ends that crosses no other path |
//! | `subdivision.rs`, `triangulate.rs` | faces cut into cells by paths; cells cut into triangles |
//! | `embed_paths.rs` | embedding in which every path is straight |
//! | `simplify.rs` | removal of new vertices that are not needed |
//! | `clearance.rs`, `retriangulate.rs` | removal that moves the neighbours; exchange of triangles for it |

mod clearance;
mod embed_paths;
mod path_router;
mod paths;
mod retriangulate;
mod simplify;
mod subdivision;
mod target_graph;
mod triangulate;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::parallel::prelude::*;
use glam::DVec2;

pub use self::clearance::with_clearance;
use self::embed_paths::{Weights, held_places, straightened};
use self::path_router::PathRouter;
use self::paths::{Ends, Growth, PathStart, Paths, SearchOptions};
pub use self::simplify::simplified;
use self::subdivision::Subdivision;
use self::target_graph::TargetGraph;
use self::triangulate::{Parts, split_collapsing_edges, triangulate};
use crate::linalg::run_apart;
use crate::mesh::{DiskMesh, EdgeId, FaceId, HalfedgeId, NewVertex, Refinement, VertexId};
use crate::nonlinear::Scaffold;
use crate::nonlinear::rest_shape::mean_edge_length;
use crate::nonlinear::scaffold::{disk_in_plane_apart, outside_of};
use crate::problem::{Control, Embedding, Phase, Pins, SolveError};
use crate::verify::is_one_to_one;

/// Length charged for a new vertex, in mean edge lengths.
const CROSSING: f64 = 0.5;

/// Most new vertices per vertex of the mesh. Paths that wind around each other need ever more.
const NEW_VERTICES_PER_VERTEX: usize = 16;
/// Most new vertices on a small mesh, if that allows more.
const NEW_VERTICES_OF_SMALL: usize = 10_000;

/// Largest random factors of the path lengths, for trees that vary at random.
const LUCK: [f64; 2] = [1.3, 2.0];
/// Random trees for each factor in [`LUCK`].
const SEEDS: u64 = 4;
/// Bound for the number of mesh vertices times the number of trees tried.
const VERTICES_OF_ALL_TREES: usize = 200_000;
/// Fewest trees tried on any mesh.
const FEWEST_TREES: usize = 2;

/// Trees tried in parallel, if more than [`FEWEST_TREES`] are tried.
const TREES_AT_ONCE: usize = 2;
/// Number of new vertices in all trees so far after which no further tree is tried.
const POINTS_OF_ALL_TREES: usize = 800_000;

/// Largest ratio of new vertices at which a later tree replaces the first. A smaller saving says nothing about the
/// quality of the map.
const WORTHWHILE: Fraction = Fraction { numerator: 4, denominator: 5 };

/// Fraction of whole numbers.
#[derive(Clone, Copy)]
struct Fraction {
    numerator: usize,
    denominator: usize,
}

impl Fraction {
    /// Fraction of a count, rounded down.
    fn of(self, count: usize) -> usize {
        self.numerator * count / self.denominator
    }
}

/// Planar embedding of a refined mesh that meets all hard pins to the last bit.
#[derive(Clone, Debug)]
pub struct Matched {
    /// Mesh with its new vertices.
    pub refinement: Arc<Refinement>,
    /// Embedding of the refined mesh.
    pub embedding: Embedding,
}

/// Mesh within its outside, at the start.
struct Surroundings {
    /// Disk with the faces of the mesh first, then those of the outside. The frame's corners are the last vertices.
    disk: DiskMesh,
    places: Vec<DVec2>,
    frame: Vec<DVec2>,
}

/// Parameters of the search for paths.
struct Search<'a> {
    ends: Ends,
    /// Length charged for a new vertex.
    crossing: f64,
    control: Control<'a>,
}

/// Finds new vertices and an embedding that meets all hard pins, from a planar embedding near the targets.
///
/// The tree of the first paths determines how all others wind. Several trees are tried, and the one with the fewest
/// new vertices is used.
///
/// # Errors
///
/// If targets coincide, the start is not planar, faces are too fine for 64-bit numbers ([`SolveError::TooFine`]),
/// paths need too many new vertices ([`SolveError::TooManyNewVertices`]), or the caller cancels.
pub fn matched(mesh: &DiskMesh, start: &Embedding, pins: &Pins, control: Control<'_>) -> Result<Matched, SolveError> {
    let exact = || pins.iter().filter(|(_, pin)| pin.kind.is_hard());
    let targets: Vec<DVec2> = exact().map(|(_, pin)| pin.target).collect();
    let surroundings = Surroundings::new(mesh, start, &targets, control)?;
    let frame = surroundings.frame.len();
    let corners = (mesh.vertex_count()..).take(frame).map(VertexId::from_index);
    let vertices = exact().map(|(&v, _)| v).chain(corners).map(VertexId::number).collect();
    let graph = TargetGraph::new(&targets, &surroundings.frame);
    control.go_on()?;
    let crossing = CROSSING * mean_edge_length(mesh, start);
    let search = Search { ends: Ends { graph, vertices, frame }, crossing, control };
    let mut manners = manners(mesh);
    loop {
        let (number, paths) = surroundings.with_fewest_points(mesh, &search, &manners)?;
        match surroundings.straightened(mesh, paths, control) {
            // Another tree may lead to faces that are less fine.
            Err(SolveError::TooFine) if manners.len() > 1 => manners.remove(number),
            result => return result,
        };
    }
}

/// Options of the trees to try. Fewer on large meshes.
fn manners(mesh: &DiskMesh) -> Vec<SearchOptions> {
    use Growth::{Anywhere, FromFrame};
    use PathStart::{NearOnMesh, NearTargets};
    let plain = [
        (FromFrame, NearTargets, 0.0),
        (Anywhere, NearOnMesh, 0.0),
        (Anywhere, NearTargets, 0.0),
        (Anywhere, NearOnMesh, 0.3),
        (FromFrame, NearTargets, 1.0),
    ];
    let manner = |(growth, beginning, target_share)| SearchOptions { growth, beginning, target_share, luck: (1.0, 0) };
    let by_chance = LUCK.into_iter().flat_map(|most| (1..=SEEDS).map(move |seed| (most, seed)));
    let varied = by_chance.map(|luck| SearchOptions { luck, ..manner(plain[1]) });
    let count = (VERTICES_OF_ALL_TREES / mesh.vertex_count()).max(FEWEST_TREES);
    plain.into_iter().map(manner).chain(varied).take(count).collect()
}

impl Surroundings {
    fn new(mesh: &DiskMesh, start: &Embedding, targets: &[DVec2], control: Control<'_>) -> Result<Self, SolveError> {
        let Scaffold { frame, triangles } =
            outside_of(mesh, start, targets.iter().copied(), 1).ok_or(SolveError::NotPlanar)?;
        control.go_on()?;
        let triangles = mesh.mesh().triangles.iter().copied().chain(triangles);
        let places: Vec<DVec2> = start.iter().chain(&frame).copied().collect();
        let disk = disk_in_plane_apart(&places, triangles.collect(), control)?.ok_or(SolveError::NotPlanar)?;
        Ok(Self { disk, places, frame })
    }

    /// Paths with the fewest new points, and the place of their options in the list. The result equals that of a
    /// sequential search.
    fn with_fewest_points(
        &self,
        mesh: &DiskMesh,
        search: &Search<'_>,
        manners: &[SearchOptions],
    ) -> Result<(usize, Paths), SolveError> {
        let most = (NEW_VERTICES_PER_VERTEX * mesh.vertex_count()).max(NEW_VERTICES_OF_SMALL);
        let mut fewest: Option<(usize, Paths)> = None;
        let (mut at_most, mut why) = (most, SolveError::TooManyNewVertices { most });
        let (mut number, mut laid) = (0, 0);
        let at_once = if manners.len() > FEWEST_TREES { TREES_AT_ONCE } else { 1 };
        for some in manners.chunks(at_once) {
            let is_by_chance = some.iter().all(|manner| manner.luck.0 > 1.0);
            if (is_by_chance && fewest.is_none()) || (laid > POINTS_OF_ALL_TREES && fewest.is_some()) {
                break;
            }
            let tried: Vec<_> = some.par_iter().map(|&manner| self.laid(search, manner, at_most)).collect();
            for (paths, end) in tried {
                let count = paths.cells.point_count();
                laid += count;
                match end {
                    Ok(()) if count <= at_most => {
                        let worthwhile = if fewest.is_none() { WORTHWHILE.of(count) } else { count };
                        at_most = worthwhile.min(count.saturating_sub(1));
                        fewest = Some((number, paths));
                    }
                    Ok(()) | Err(SolveError::TooManyNewVertices { .. }) => {}
                    // Another tree may avoid the regions of coarse rounding.
                    Err(SolveError::TooFine) => why = SolveError::TooFine,
                    Err(error) => return Err(error),
                }
                number += 1;
            }
        }
        fewest.ok_or(why)
    }

    /// Paths for some options with at most `at_most` new points, or as far as they were laid, with the outcome.
    fn laid(&self, search: &Search<'_>, manner: SearchOptions, at_most: usize) -> (Paths, Result<(), SolveError>) {
        let mut router = PathRouter::new(search.crossing, search.control);
        let mut paths = Paths::new(Subdivision::new(&self.disk, &self.places), search.ends.clone(), manner);
        let end = search.control.go_on().and_then(|()| paths.lay_all(&mut router, at_most));
        (paths, end)
    }

    /// Embedding in which all paths are straight.
    fn straightened(&self, mesh: &DiskMesh, paths: Paths, control: Control<'_>) -> Result<Matched, SolveError> {
        let Paths { mut cells, graph, lines, .. } = paths;
        split_collapsing_edges(&mut cells, &graph);
        control.go_on()?;
        let parts = triangulate(&mut cells, &graph, &self.disk);
        control.enter(Phase::Assemble)?;
        let held = held_places(&cells, &graph, &lines);
        control.go_on()?;
        let whole = self.refined(&cells, &parts, control)?;
        let (refinement, vertices) = refined(mesh, &Cut { whole: &self.disk, cells: &cells, parts: &parts }, control)?;
        for weights in [Weights::MeanValue, Weights::Uniform] {
            let places = match straightened(&whole, &cells, &held, weights, control) {
                Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
                Err(_) => continue,
                Ok(places) => places,
            };
            let embedding: Embedding = vertices.iter().map(|&v| places[v as usize]).collect();
            control.go_on()?;
            if is_one_to_one(refinement.disk(), &embedding) {
                return Ok(Matched { refinement, embedding });
            }
        }
        Err(SolveError::TooFine)
    }

    /// Mesh and outside, cut into parts.
    fn refined(&self, cells: &Subdivision, parts: &Parts, control: Control<'_>) -> Result<DiskMesh, SolveError> {
        let of_face = |face: FaceId| match parts.get(&face) {
            Some(parts) => parts.iter().map(|t| t.map(VertexId::new)).collect(),
            None => vec![self.disk.face(face)],
        };
        let triangles = self.disk.faces().flat_map(of_face).collect();
        let disk = disk_in_plane_apart(&cells.places, triangles, control)?;
        Ok(disk.expect("the parts of a disk's faces are a disk"))
    }
}

/// Mesh and outside, with their cut.
struct Cut<'a> {
    whole: &'a DiskMesh,
    cells: &'a Subdivision,
    parts: &'a Parts,
}

/// Extracts the refined mesh from the subdivision of mesh and outside. Also returns the subdivision's vertex of each
/// vertex.
fn refined(
    mesh: &DiskMesh,
    &Cut { whole, cells, parts }: &Cut<'_>,
    control: Control<'_>,
) -> Result<(Arc<Refinement>, Vec<u32>), SolveError> {
    let is_of_mesh = |edge: &EdgeId| {
        let h = whole.halfedge(*edge);
        [h, whole.twin(h)].iter().any(|h: &HalfedgeId| h.index() < 3 * mesh.face_count())
    };
    let mut vertices: Vec<u32> = mesh.vertices().map(VertexId::number).collect();
    let mut new_vertices = Vec::new();
    let mut number_of_point = BTreeMap::new();
    for edge in whole.edges().filter(is_of_mesh) {
        let [a, b] = whole.ends(edge);
        let points = &cells.points[edge.number() as usize];
        for (place, &point) in points.iter().enumerate() {
            let share = (place + 1) as f64 / (points.len() + 1) as f64;
            let at = if a < b { share } else { 1.0 - share };
            number_of_point.insert(point, VertexId::from_index(vertices.len()));
            vertices.push(point);
            new_vertices.push(NewVertex { edge: [a.min(b), a.max(b)], at });
        }
    }
    let renumbered = |v: u32| number_of_point.get(&v).copied().unwrap_or(VertexId::new(v));
    let of_mesh = parts.range(..FaceId::from_index(mesh.face_count()));
    let parts = of_mesh.map(|(&face, parts)| (face, parts.iter().map(|t| t.map(renumbered)).collect())).collect();
    Ok((refinement(mesh, new_vertices, &parts, control)?, vertices))
}

/// Mesh with new vertices and with its faces cut into parts.
fn refinement(
    mesh: &DiskMesh,
    new_vertices: Vec<NewVertex>,
    parts: &BTreeMap<FaceId, Vec<[VertexId; 3]>>,
    control: Control<'_>,
) -> Result<Arc<Refinement>, SolveError> {
    let cut = Refinement::cut(mesh, new_vertices, parts);
    let joined = run_apart(move || cut.join(), control.cancel())?;
    Ok(Arc::new(joined.expect("the parts of a disk's faces are a disk")))
}
