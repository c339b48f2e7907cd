//! Exact verdict on a layout of several charts: each chart is one-to-one, and no two charts overlap.
//!
//! # Proof that a chart is one-to-one
//!
//! Let all faces of a chart be positive, and each of its boundary loops a simple polygon. Along the surface's
//! boundary, the outer loop turns +1, and all other loops, around holes, turn −1. Fill each hole in the plane by a
//! triangulation of its polygon, whose triangles are positive too. The filled surface is a disk: its faces are
//! positive and its boundary is simple. By the theorem of the module `verdict` it is one-to-one, and so is the chart
//! in it. [`parts`](crate::mesh::parts) has made sure that there are no handles. For a mirror image all signs change.
//!
//! # Proof that charts do not overlap
//!
//! Charts that are one-to-one do not overlap if no face of one meets the inside of a face of another. Two triangles
//! have disjoint insides if and only if a side of one has the other on its outer side or on its line. Exact
//! orientations decide this. Charts may touch.

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::geom::{Bounds, BoxTree, Orientation, is_simple, orientation, place_along_curve, turning_number};
use crate::mesh::{FaceId, Part, Polygon, TriMesh};
use crate::problem::Embedding;

/// Largest number of listed pairs of overlapping faces.
pub const OVERLAPS_LISTED: usize = 1000;

/// Number of faces that are compared with the others between two checks of the number of pairs.
const FACES_PER_ROUND: usize = 1 << 14;

/// Verdict on a chart, with its defects. Faces are numbered as in the whole layout.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ChartVerdict {
    /// First face of the chart.
    pub first_face: FaceId,
    /// Number of triangles.
    pub faces: usize,
    /// Number of boundary loops: one more than the number of holes.
    pub boundary_loops: usize,
    /// True if the chart is proved one-to-one, possibly as a mirror image, for every way to cut its polygons into
    /// triangles.
    pub planar: bool,
    /// Faces that are turned over, have area zero, or have a corner that is not finite.
    pub flipped_faces: Vec<FaceId>,
    /// Polygons that another cut into triangles would fold, by their first faces.
    pub concave_polygons: Vec<FaceId>,
    /// Number of boundary loops that meet themselves.
    pub crossed_loops: usize,
    /// True if exactly one loop runs around the outside.
    pub is_bounded: bool,
    /// True if the chart is a mirror image.
    pub mirrored: bool,
}

/// Verdict on a layout of charts.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct AtlasVerdict {
    /// True if each chart is one-to-one and no two charts overlap.
    pub planar: bool,
    /// True if the layout is also planar with all coordinates rounded to 32 bits.
    #[cfg_attr(feature = "serde", serde(rename = "f32"))]
    pub planar_in_f32: bool,
    /// Verdict on each chart.
    pub charts: Vec<ChartVerdict>,
    /// Pairs of overlapping faces of different charts, at most [`OVERLAPS_LISTED`].
    pub overlapping_faces: Vec<[FaceId; 2]>,
    /// True if there are more pairs than listed.
    pub more_overlaps: bool,
}

/// Decides exactly if charts are one-to-one and do not overlap. `embedding` has a position for each vertex of the
/// whole layout.
///
/// # Panics
///
/// If the embedding lacks a vertex of a part.
pub fn atlas_verdict(charts: &[Part], embedding: &Embedding) -> AtlasVerdict {
    let in_f32: Embedding = embedding.iter().map(|z| z.as_vec2().as_dvec2()).collect();
    let found: Vec<ChartVerdict> = charts.par_iter().map(|chart| chart_verdict(chart, embedding)).collect();
    let mut overlapping_faces = overlaps(charts, embedding, OVERLAPS_LISTED + 1);
    let more_overlaps = overlapping_faces.len() > OVERLAPS_LISTED;
    overlapping_faces.truncate(OVERLAPS_LISTED);
    let planar = overlapping_faces.is_empty() && found.iter().all(|chart| chart.planar);
    let kind = |(chart, before): (&Part, &ChartVerdict)| {
        let in_f32 = chart_verdict(chart, &in_f32);
        in_f32.planar && in_f32.mirrored == before.mirrored
    };
    let planar_in_f32 = planar && charts.par_iter().zip(&found).all(kind) && overlaps(charts, &in_f32, 1).is_empty();
    AtlasVerdict { planar, planar_in_f32, charts: found, overlapping_faces, more_overlaps }
}

fn chart_verdict(chart: &Part, embedding: &Embedding) -> ChartVerdict {
    let places: Vec<DVec2> = chart.vertex_of().iter().map(|&vertex| embedding[vertex]).collect();
    let turn = |[a, b, c]: [DVec2; 3]| orientation(a, b, c);
    let triangles = &chart.mesh().triangles;
    let turns: Vec<Option<Orientation>> = triangles.iter().map(|t| turn(t.map(|v| places[v.index()]))).collect();
    let some_are = |wanted| turns.contains(&Some(wanted));
    let mirrored = some_are(Orientation::Clockwise) && !some_are(Orientation::CounterClockwise);
    let upright = Some(if mirrored { Orientation::Clockwise } else { Orientation::CounterClockwise });
    let in_whole = |face: usize| chart.face_of()[face];
    let flipped_faces: Vec<FaceId> = (0..turns.len()).filter(|&face| turns[face] != upright).map(in_whole).collect();
    let is_concave = |polygon: &Polygon<'_>| {
        let are_upright = polygon.faces().all(|face| turns[face.index()] == upright);
        are_upright && !polygon.convex_ears().all(|ear| turn(ear.map(|v| places[v.index()])) == upright)
    };
    let concave = chart.polygons().filter(is_concave);
    let concave_polygons: Vec<FaceId> = concave.map(|polygon| in_whole(polygon.first_face.index())).collect();
    let loops = || chart.loops().iter().map(|vertices| vertices.iter().map(|v| places[v.index()]).collect::<Vec<_>>());
    let crossed_loops = loops().filter(|polygon| !is_simple(polygon)).count();
    let outward = if mirrored { -1 } else { 1 };
    let is_bounded = loops().filter(|polygon| turning_number(polygon) == Some(outward)).count() == 1;
    ChartVerdict {
        first_face: in_whole(0),
        faces: triangles.len(),
        boundary_loops: chart.loops().len(),
        planar: flipped_faces.is_empty() && concave_polygons.is_empty() && crossed_loops == 0 && is_bounded,
        flipped_faces,
        concave_polygons,
        crossed_loops,
        is_bounded,
        mirrored,
    }
}

/// A face in the plane, counter-clockwise.
struct Spot {
    chart: usize,
    face: FaceId,
    corners: [DVec2; 3],
    bounds: Bounds,
}

/// Pairs of overlapping faces of different charts, the lower face first, ascending; at most `most`.
fn overlaps(charts: &[Part], embedding: &Embedding, most: usize) -> Vec<[FaceId; 2]> {
    if charts.len() < 2 {
        return Vec::new();
    }
    let mut spots: Vec<Spot> =
        charts.iter().enumerate().flat_map(|(number, chart)| spots_of(number, chart, embedding)).collect();
    let whole = spots.iter().fold(Bounds::EMPTY, |whole, spot| whole.union(spot.bounds));
    spots.sort_by_cached_key(|spot| (place_along_curve(whole, spot.bounds.middle()), spot.face));
    let tree = BoxTree::new(spots.iter().map(|spot| spot.bounds));
    let mut pairs: Vec<[FaceId; 2]> = Vec::new();
    for begin in (0..spots.len()).step_by(FACES_PER_ROUND) {
        let round = begin..(begin + FACES_PER_ROUND).min(spots.len());
        let of_spot = |place: usize| {
            let own = &spots[place];
            let others = tree.later(place).map(|other| &spots[other]);
            let over = others.filter(|other| other.chart != own.chart && own.lies_over(other));
            over.map(|other| [own.face.min(other.face), own.face.max(other.face)]).take(most).collect::<Vec<_>>()
        };
        pairs.par_extend(round.into_par_iter().flat_map_iter(of_spot));
        if pairs.len() >= most {
            break;
        }
    }
    pairs.sort_unstable();
    pairs.truncate(most);
    pairs
}

/// Faces of a chart that have an area.
fn spots_of<'a>(number: usize, chart: &'a Part, embedding: &'a Embedding) -> impl Iterator<Item = Spot> + 'a {
    let places = |face: usize| chart.mesh().triangles[face].map(|v| embedding[chart.vertex_of()[v.index()]]);
    (0..chart.mesh().face_count()).filter_map(move |face| {
        let [a, b, c] = places(face);
        let corners = match orientation(a, b, c)? {
            Orientation::CounterClockwise => [a, b, c],
            Orientation::Clockwise => [a, c, b],
            Orientation::Collinear => return None,
        };
        Some(Spot { chart: number, face: chart.face_of()[face], corners, bounds: Bounds::of(corners) })
    })
}

impl Spot {
    /// True if the insides of two faces meet.
    fn lies_over(&self, other: &Self) -> bool {
        !self.has_beside(other) && !other.has_beside(self)
    }

    /// True if a side has the other face on its outer side or on its line.
    fn has_beside(&self, other: &Self) -> bool {
        let [a, b, c] = self.corners;
        let is_inward =
            |[from, to]: [DVec2; 2], z: DVec2| orientation(from, to, z) == Some(Orientation::CounterClockwise);
        [[a, b], [b, c], [c, a]].into_iter().any(|side| !other.corners.iter().any(|&z| is_inward(side, z)))
    }
}

impl ChartVerdict {
    /// Defects in lower-case words.
    fn fault_words(&self) -> String {
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            _ => Some(format!("{count} {many}")),
        };
        let faults = [
            counted(self.flipped_faces.len(), "flipped face", "flipped faces"),
            counted(self.concave_polygons.len(), "concave polygon", "concave polygons"),
            counted(self.crossed_loops, "self-intersecting boundary loop", "self-intersecting boundary loops"),
            (!self.is_bounded).then(|| "no single outer boundary loop".to_owned()),
        ];
        faults.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

impl AtlasVerdict {
    /// Verdict with faces numbered as in the file. A polygon has a defect if one of its triangles has it.
    #[must_use]
    pub fn as_in_file(&self, mesh: &TriMesh) -> Self {
        let number = |face: FaceId| FaceId::new(mesh.polygon(face));
        let in_file = |faces: &[FaceId]| {
            let mut polygons: Vec<FaceId> = faces.iter().map(|&face| number(face)).collect();
            polygons.dedup();
            polygons
        };
        let chart = |chart: &ChartVerdict| ChartVerdict {
            first_face: number(chart.first_face),
            flipped_faces: in_file(&chart.flipped_faces),
            concave_polygons: in_file(&chart.concave_polygons),
            ..chart.clone()
        };
        let mut overlapping_faces: Vec<[FaceId; 2]> =
            self.overlapping_faces.iter().map(|pair| pair.map(number)).collect();
        overlapping_faces.sort_unstable();
        overlapping_faces.dedup();
        Self { charts: self.charts.iter().map(chart).collect(), overlapping_faces, ..self.clone() }
    }

    /// Verdict in lower-case words.
    pub fn summary(&self) -> String {
        let count = self.charts.len();
        let charts = if count == 1 { "1 chart".to_owned() } else { format!("{count} charts") };
        if self.planar {
            let each =
                if count == 1 { "planar: proved one-to-one" } else { "each planar, and apart: proved one-to-one" };
            return format!("{charts}, {each}");
        }
        let bad = self.charts.iter().filter(|chart| !chart.planar).count();
        let first = self.charts.iter().find(|chart| !chart.planar);
        let of_charts = first.map(|chart| {
            format!(
                "{bad} not planar (first: the chart of face {}: {})",
                chart.first_face.number(),
                chart.fault_words()
            )
        });
        let of_faces = self.overlapping_faces.first().map(|[a, b]| {
            let more = if self.more_overlaps { "more than " } else { "" };
            let count = self.overlapping_faces.len();
            if count == 1 {
                return format!("1 pair of faces of different charts overlaps ({} and {})", a.number(), b.number());
            }
            format!(
                "{more}{count} pairs of faces of different charts overlap (first: {} and {})",
                a.number(),
                b.number()
            )
        });
        let faults: Vec<String> = of_charts.into_iter().chain(of_faces).collect();
        format!("{charts}: {}", faults.join(" · "))
    }
}
