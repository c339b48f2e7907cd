//! The exact verdict: whether an embedding is one-to-one, and where it is not.
//!
//! # Theorem
//!
//! A piecewise-linear map of a disk into the plane is one-to-one if and only if all its faces have the same nonzero
//! orientation and its boundary polygon is simple. (Y. Lipman, "Bijective mappings of meshes with boundary and the
//! degree in mesh processing", arXiv 1310.0955.) Both are decided without rounding, for the very numbers given, so
//! the verdict is a proof. It must be taken again where these numbers are rounded for a file.
//!
//! # Holes
//!
//! A surface with holes is flattened as a disk: virtual faces fill its inner boundary loops ([`Hole`]). Where these
//! are positive, too, the theorem holds for the whole disk, and so for the surface in it: faces do not overlap; each
//! loop is simple, as the image of a simple loop; the faces around it lie outside of it, because the filling lies
//! within; and no two loops meet.
//!
//! If the filling of a hole folds, the hole is *crossed* unless its loop is a simple polygon that turns +1, in the
//! direction in which the filling runs around. A simple polygon has a triangulation without further vertices, and if
//! it turns +1, its triangles are positive. With it in the place of the filling that folds, the filled surface is a
//! disk again, its faces positive and its boundary simple, if the real faces and the outer boundary are so:
//! one-to-one by the theorem. So an embedding of a surface with holes is one-to-one if its real faces are positive,
//! the outer boundary is simple, and no hole is crossed; and only if, provided that the outer loop lies outside: then
//! all loops are simple polygons, and the surface lies outside of the loops around holes. A surface that lies inside
//! out, the outer loop innermost, counts as crossed.
//!
//! # Polygons
//!
//! Other programs cut polygons into triangles by rules of their own. So a polygon with more than three corners has to
//! turn left at every corner that is convex in space (by a clear angle: [`Polygon`]). In an embedding that is
//! one-to-one over the triangles of our cut it is then strictly convex, if it is so in space, and every way to cut it
//! gives positive triangles. Where it is concave in space its own concave corners may stay; that our cut has positive
//! triangles proves that its outline is simple. An embedding is *planar* where it is one-to-one and no polygon is at
//! fault.
//!
//! # 32 bits
//!
//! Most programs read texture coordinates into 32 bits. A planar embedding *holds in 32 bits* if the proof also holds
//! for every coordinate rounded to the nearest of these numbers.
//!
//! # What goes wrong, by kind
//!
//! * A *flipped face*: its orientation is negative, or zero, or a corner is not finite.
//! * A *concave polygon*: all its triangles are positive, but it does not turn left at a corner that is convex in
//!   space.
//! * A *crossed hole*: its filling folds, and its loop is no simple polygon that has the surface around it.
//! * A *boundary crossing*: two boundary edges that meet other than at a shared end (see [`crossings()`]).
//!   Edges with an end that is not finite take no part; their faces are flipped already.
//! * An *overwound vertex*: all faces around an interior vertex are positive, yet its link winds around it twice or
//!   more. A map without flipped faces and crossings has none, by the theorem.
//! * The *turning number* tells loops of the boundary from mere contact: 1 where it is simple.
//!
//! # Mirror images
//!
//! An embedding is *mirrored* where some face is negative and none is positive. All faces are then judged in the
//! mirror: negative ones are as they should be and are not listed, zero ones stay flipped. The turning number is that
//! of the boundary as it lies, −1 for a mirrored one-to-one map.

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::geom::{Orientation, crossings, is_simple, orientation, turning_number, winding_number};
use crate::mesh::{DiskMesh, EdgeId, FaceId, Hole, Polygon, VertexId};
use crate::problem::{Control, Embedding, SolveError};

/// Exact verdict on an embedding, with its defects. All lists ascend.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[expect(clippy::struct_excessive_bools, reason = "the report's fields")]
pub struct Verdict {
    /// True if the embedding is proved one-to-one, possibly as a mirror image, for every way to cut its polygons into
    /// triangles.
    pub planar: bool,
    /// Faces that are turned over, have area zero, or have a corner that is not finite.
    pub flipped_faces: Vec<FaceId>,
    /// Polygons that another cut into triangles would fold, by their first faces.
    pub concave_polygons: Vec<FaceId>,
    /// Holes that meet themselves or are turned inside out, each by the lowest vertex around it.
    pub crossed_holes: Vec<VertexId>,
    /// True if virtual faces fold. Stages that keep all faces positive do not continue from such an embedding.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub is_filling_folded: bool,
    /// Pairs of boundary edges that meet other than at a shared end, the lower id first; at most `CROSSINGS_LISTED`.
    pub boundary_crossings: Vec<[EdgeId; 2]>,
    /// True if there are more crossings than listed. The report omits this field if it is false.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "std::ops::Not::not"))]
    pub more_crossings: bool,
    /// Interior vertices whose faces are all positive and wind around them twice or more.
    pub overwound_vertices: Vec<VertexId>,
    /// Turning number of the boundary. Absent if an edge has length zero, turns exactly back or is not finite.
    pub turning_number: Option<i64>,
    /// Number of flipped faces with area zero.
    pub zero_area_faces: usize,
    /// True if the embedding is a mirror image: some face is negative and none is positive.
    pub mirrored: bool,
    /// True if the embedding is also proved planar with its coordinates rounded to 32 bits, mirrored or not as in 64
    /// bits.
    #[cfg_attr(feature = "serde", serde(rename = "f32"))]
    pub planar_in_f32: bool,
}

/// Decides exactly whether an embedding of a disk is one-to-one.
///
/// # Panics
///
/// If the embedding does not have one position per vertex.
pub fn verdict(mesh: &DiskMesh, embedding: &Embedding) -> Verdict {
    verdict_unless(mesh, embedding, Control::unattended()).expect("nobody stops it")
}

/// [`verdict`] with cancellation.
pub(crate) fn verdict_unless(
    mesh: &DiskMesh,
    embedding: &Embedding,
    control: Control<'_>,
) -> Result<Verdict, SolveError> {
    assert_eq!(embedding.len(), mesh.vertex_count(), "an embedding has one position per vertex");
    let orientations: Vec<Option<Orientation>> = orientations(mesh, embedding).collect();
    let real = &orientations[..mesh.mesh().real_face_count()];
    let some_are = |wanted| real.contains(&Some(wanted));
    let mirrored = some_are(Orientation::Clockwise) && !some_are(Orientation::CounterClockwise);
    let upright = if mirrored { Orientation::Clockwise } else { Orientation::CounterClockwise };
    let is_upright = |face: FaceId| orientations[face.index()] == Some(upright);
    control.go_on()?;
    let flipped_faces: Vec<FaceId> = mesh.real_faces().filter(|&face| !is_upright(face)).collect();
    let folded = folded_holes(mesh, is_upright);
    let is_crossed = |hole: &&Hole| !is_around(hole, embedding, upright);
    let crossed_holes: Vec<VertexId> = folded.iter().filter(is_crossed).map(|hole| hole.rim[0]).collect();
    let zero_area_faces = real.iter().filter(|&&o| o == Some(Orientation::Collinear)).count();
    let boundary = embedding.boundary(mesh);
    control.go_on()?;
    let (boundary_crossings, more_crossings) = boundary_crossings(mesh, &boundary);
    control.go_on()?;
    let is_one_to_one = flipped_faces.is_empty() && crossed_holes.is_empty() && boundary_crossings.is_empty();
    let concave_polygons = concave_polygons(mesh, embedding, upright)
        .filter(|polygon| polygon.faces().all(is_upright))
        .map(|polygon| polygon.first_face)
        .collect::<Vec<_>>();
    let planar = is_one_to_one && concave_polygons.is_empty();
    control.go_on()?;
    let overwound = || overwound_vertices(mesh, embedding, is_upright, control);
    let overwound_vertices = if is_one_to_one { Vec::new() } else { overwound()? };
    Ok(Verdict {
        planar,
        flipped_faces,
        concave_polygons,
        crossed_holes,
        is_filling_folded: !folded.is_empty(),
        boundary_crossings,
        more_crossings,
        overwound_vertices,
        turning_number: turning_number(&boundary),
        zero_area_faces,
        mirrored,
        planar_in_f32: planar && sense_of_surface(mesh, &in_f32(embedding)) == Some(upright),
    })
}

/// True if an embedding of a disk is planar, possibly as a mirror image. No defects are listed, as they are by
/// [`verdict`]. Faces that fill holes must be positive, too.
///
/// # Panics
///
/// If the embedding does not have one position per vertex.
pub fn is_planar(mesh: &DiskMesh, embedding: &Embedding) -> bool {
    planar_sense(mesh, embedding).is_some()
}

/// True if an embedding of a disk is one-to-one, possibly as a mirror image, with polygons cut and holes filled as in
/// the mesh.
///
/// # Panics
///
/// If the embedding does not have one position per vertex.
pub fn is_one_to_one(mesh: &DiskMesh, embedding: &Embedding) -> bool {
    sense(mesh, embedding).is_some()
}

/// [`sense`] of an embedding without concave polygons. `None` if there is a concave polygon.
pub(crate) fn planar_sense(mesh: &DiskMesh, embedding: &Embedding) -> Option<Orientation> {
    sense(mesh, embedding).filter(|&upright| concave_polygons(mesh, embedding, upright).next().is_none())
}

/// Polygons that turn the wrong way, or not at all, at a corner that is convex in space.
pub(crate) fn concave_polygons<'a, 'b>(
    mesh: &'a DiskMesh,
    embedding: &'b Embedding,
    upright: Orientation,
) -> impl Iterator<Item = Polygon<'a>> + use<'a, 'b> {
    let turns = move |ear: [VertexId; 3]| {
        let [a, b, c] = ear.map(|v| embedding[v]);
        orientation(a, b, c) == Some(upright)
    };
    mesh.polygons().filter(move |polygon| !polygon.convex_ears().all(turns))
}

/// [`planar_sense`] of the surface, whose filled holes may fold.
pub(crate) fn sense_of_surface(mesh: &DiskMesh, embedding: &Embedding) -> Option<Orientation> {
    planar_sense(mesh, embedding).or_else(|| {
        let orientations: Vec<Option<Orientation>> = orientations(mesh, embedding).collect();
        let upright = orientations[0]?;
        let folded = folded_holes(mesh, |face| orientations[face.index()] == Some(upright));
        let is_surface = upright != Orientation::Collinear
            && !folded.is_empty()
            && orientations[..mesh.mesh().real_face_count()].iter().all(|&other| other == Some(upright))
            && folded.iter().all(|hole| is_around(hole, embedding, upright))
            && is_simple(&embedding.boundary(mesh))
            && concave_polygons(mesh, embedding, upright).next().is_none();
        is_surface.then_some(upright)
    })
}

/// Holes whose filling has faces that are not upright.
fn folded_holes(mesh: &DiskMesh, is_upright: impl Fn(FaceId) -> bool) -> Vec<Hole> {
    let is_folded = |faces: std::ops::Range<usize>| !faces.map(FaceId::from_index).all(&is_upright);
    if !is_folded(mesh.mesh().real_face_count()..mesh.face_count()) {
        return Vec::new();
    }
    mesh.mesh().holes().into_iter().filter(|hole| is_folded(hole.faces.clone())).collect()
}

/// True if the loop around a hole is a simple polygon with the surface outside of it.
fn is_around(hole: &Hole, embedding: &Embedding, upright: Orientation) -> bool {
    let places: Vec<DVec2> = hole.rim.iter().map(|&v| embedding[v]).collect();
    let turns = if upright == Orientation::Clockwise { -1 } else { 1 };
    turning_number(&places) == Some(turns) && is_simple(&places)
}

/// Orientation of all faces of a one-to-one embedding. `None` if it is not one-to-one.
fn sense(mesh: &DiskMesh, embedding: &Embedding) -> Option<Orientation> {
    assert_eq!(embedding.len(), mesh.vertex_count(), "an embedding has one position per vertex");
    let [a, b, c] = embedding.corners(mesh, mesh.faces().next()?);
    let of_first = orientation(a, b, c).filter(|&first| first != Orientation::Collinear)?;
    let are_alike = orientations(mesh, embedding).all(|other| other == Some(of_first));
    let is_simple = || is_simple(&embedding.boundary(mesh));
    (are_alike && is_simple()).then_some(of_first)
}

/// Exact orientation of every face. `None` if a corner is not finite.
fn orientations<'a>(
    mesh: &'a DiskMesh,
    embedding: &'a Embedding,
) -> impl IndexedParallelIterator<Item = Option<Orientation>> + 'a {
    mesh.mesh().triangles.par_iter().with_min_len(FACES_PER_TASK).map(|triangle| {
        let [a, b, c] = triangle.map(|v| embedding[v]);
        orientation(a, b, c)
    })
}

/// Embedding as read by programs that keep 32 bits of every coordinate.
pub(crate) fn in_f32(embedding: &Embedding) -> Embedding {
    embedding.iter().map(|z| z.as_vec2().as_dvec2()).collect()
}

/// Number of faces in one task: enough to outweigh its scheduling.
const FACES_PER_TASK: usize = 4096;

/// Crossings as pairs of edge ids, and true if there are more.
fn boundary_crossings(mesh: &DiskMesh, boundary: &[DVec2]) -> (Vec<[EdgeId; 2]>, bool) {
    let found = crossings(boundary);
    let edge_at = |place: u32| mesh.boundary_edge(place as usize);
    let mut pairs: Vec<[EdgeId; 2]> = found
        .pairs
        .iter()
        .map(|&[first, second]| {
            let (first, second) = (edge_at(first), edge_at(second));
            [first.min(second), first.max(second)]
        })
        .collect();
    pairs.sort_unstable();
    (pairs, found.has_more)
}

/// Interior vertices whose faces are all upright and whose link winds around them more than once.
fn overwound_vertices(
    mesh: &DiskMesh,
    embedding: &Embedding,
    is_upright: impl Fn(FaceId) -> bool + Sync,
    control: Control<'_>,
) -> Result<Vec<VertexId>, SolveError> {
    let is_overwound = |link: &mut Vec<DVec2>, vertex: usize| {
        let vertex = VertexId::from_index(vertex);
        if mesh.boundary_place(vertex).is_some() {
            return false;
        }
        link.clear();
        for halfedge in mesh.outgoing(vertex) {
            if !mesh.face_of(halfedge).is_some_and(&is_upright) {
                return false;
            }
            link.push(embedding[mesh.head(halfedge)]);
        }
        winding_number(link, embedding[vertex]).is_some_and(|turns| turns.abs() > 1)
    };
    let overwound: Vec<bool> = control.each_with(mesh.vertex_count(), Vec::new, is_overwound)?;
    Ok(mesh.vertices().filter(|&vertex| overwound[vertex.index()] && !mesh.is_virtual_vertex(vertex)).collect())
}

impl Verdict {
    /// True if the embedding is one-to-one, with polygons cut and holes filled as in the mesh.
    pub fn is_one_to_one(&self) -> bool {
        self.flipped_faces.is_empty() && !self.is_filling_folded && self.boundary_crossings.is_empty()
    }

    /// Orientation by which the faces are judged.
    pub fn upright(&self) -> Orientation {
        if self.mirrored { Orientation::Clockwise } else { Orientation::CounterClockwise }
    }

    /// Number of boundary crossings in words, with "more than" if not all are listed.
    pub fn crossing_count_in_words(&self) -> String {
        let more = if self.more_crossings { "more than " } else { "" };
        format!("{more}{}", self.boundary_crossings.len())
    }

    /// Number of flipped faces, concave polygons, crossed holes, listed boundary crossings and overwound vertices
    /// together.
    pub fn defect_count(&self) -> usize {
        let crossings = self.boundary_crossings.len();
        let faces = self.flipped_faces.len() + self.concave_polygons.len() + self.crossed_holes.len();
        faces + crossings + self.overwound_vertices.len()
    }

    /// Result of rounding a planar embedding to 32 bits, in lower-case words. `None` if it is not planar in 64 bits.
    pub fn summary_in_f32(&self) -> Option<&'static str> {
        let words = if self.planar_in_f32 { "holds in 32 bits" } else { "does not hold in 32 bits" };
        self.planar.then_some(words)
    }

    /// The verdict in a few lower-case words, for a line on the screen or the terminal.
    pub fn summary(&self) -> String {
        if self.planar {
            let mirror = if self.mirrored { ", mirrored" } else { "" };
            return format!("planar: proved one-to-one{mirror}");
        }
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            _ => Some(format!("{count} {many}")),
        };
        let crossings = match self.boundary_crossings.len() {
            0 | 1 => counted(self.boundary_crossings.len(), "boundary crossing", ""),
            _ => Some(format!("{} boundary crossings", self.crossing_count_in_words())),
        };
        let faults = [
            counted(self.flipped_faces.len(), "flipped face", "flipped faces"),
            counted(self.concave_polygons.len(), "concave polygon", "concave polygons"),
            counted(self.crossed_holes.len(), "crossed hole", "crossed holes"),
            crossings,
            counted(self.overwound_vertices.len(), "overwound vertex", "overwound vertices"),
            self.mirrored.then(|| "mirrored".to_owned()),
        ];
        faults.into_iter().flatten().collect::<Vec<_>>().join(" · ")
    }
}
