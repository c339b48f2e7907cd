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
//!
//! # Stacked charts
//!
//! A chart may be stacked on another on purpose. Both are one-to-one, and the boundary loops of both are the same
//! polygons, bit for bit. A one-to-one chart covers the region that its outer loop bounds without the insides of its
//! holes. So both cover the same region, and no face of another chart overlaps one of them unless it overlaps the other.
//! The verdict therefore compares only charts that are not stacked. Charts with other loops do not count as stacked.

use std::collections::{BTreeMap, BTreeSet};

use crate::parallel::prelude::*;
use glam::DVec2;

use crate::geom::{self, Orientation, is_simple, orientation, point_key, turning_number};
use crate::mesh::{FaceId, Part, Polygon, TriMesh, VertexId};
use crate::problem::Embedding;

/// Largest number of listed pairs of overlapping faces.
pub const OVERLAPS_LISTED: usize = 1000;

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
    /// Number of the chart whose place this chart shares on purpose. Absent for a chart with a place of its own.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub stacked_on: Option<usize>,
}

/// Verdict on a layout of charts.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct AtlasVerdict {
    /// True if each chart is one-to-one and no two charts overlap, apart from charts that share a place on purpose.
    pub planar: bool,
    /// True if the layout is also planar with all coordinates rounded to 32 bits.
    #[cfg_attr(feature = "serde", serde(rename = "f32"))]
    pub planar_in_f32: bool,
    /// Verdict on each chart.
    pub charts: Vec<ChartVerdict>,
    /// Number of places that several charts share on purpose.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_zero"))]
    pub stacks: usize,
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
    stacked_atlas_verdict(charts, embedding, &ChartRelations::default())
}

/// Charts that may overlap others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChartRelations {
    /// Number of the chart whose place a chart shares, which has a place of its own. Empty if no chart shares a place.
    pub stacked_on: Vec<Option<usize>>,
    /// Group of each chart, such as its material, which has a picture of its own. Charts of different groups may
    /// overlap. A chart without a group overlaps no other. Empty if there are no groups.
    pub groups: Vec<Option<u32>>,
}

impl ChartRelations {
    /// True if two charts may not overlap.
    fn must_be_apart(&self, a: usize, b: usize) -> bool {
        let group = |chart: usize| self.groups.get(chart).copied().flatten();
        a != b && group(a).zip(group(b)).is_none_or(|(a, b)| a == b)
    }
}

/// [`atlas_verdict`] for charts some of which may overlap. A chart whose boundary differs from that of the chart whose
/// place it shares counts as not stacked.
///
/// # Panics
///
/// If the embedding lacks a vertex of a part.
pub fn stacked_atlas_verdict(charts: &[Part], embedding: &Embedding, relations: &ChartRelations) -> AtlasVerdict {
    let none = vec![None; charts.len()];
    let stacked_on = if relations.stacked_on.is_empty() { &none } else { &relations.stacked_on };
    let outlines: Vec<Option<Outline>> = outlines_of_stacks(charts, embedding, stacked_on);
    let is_alike = |(chart, on): (usize, usize)| stacked_on[on].is_none() && outlines[chart] == outlines[on];
    let stacked_on: Vec<Option<usize>> =
        stacked_on.iter().enumerate().map(|(chart, on)| on.filter(|&on| is_alike((chart, on)))).collect();
    let in_f32: Embedding = embedding.iter().map(|z| z.as_vec2().as_dvec2()).collect();
    let verdict_of =
        |(chart, &stacked_on): (&Part, &Option<usize>)| ChartVerdict { stacked_on, ..chart_verdict(chart, embedding) };
    let found: Vec<ChartVerdict> = charts.par_iter().zip(&stacked_on).map(verdict_of).collect();
    let lowest: Vec<(usize, &Part)> =
        charts.iter().enumerate().filter(|(chart, _)| stacked_on[*chart].is_none()).collect();
    let stacks = stacked_on.iter().flatten().collect::<BTreeSet<_>>().len();
    let mut overlapping_faces = overlaps(&lowest, relations, embedding, OVERLAPS_LISTED + 1);
    let more_overlaps = overlapping_faces.len() > OVERLAPS_LISTED;
    overlapping_faces.truncate(OVERLAPS_LISTED);
    let planar = overlapping_faces.is_empty() && found.iter().all(|chart| chart.planar);
    let kind = |(chart, before): (&Part, &ChartVerdict)| {
        let in_f32 = chart_verdict(chart, &in_f32);
        in_f32.planar && in_f32.mirrored == before.mirrored
    };
    let planar_in_f32 =
        planar && charts.par_iter().zip(&found).all(kind) && overlaps(&lowest, relations, &in_f32, 1).is_empty();
    AtlasVerdict { planar, planar_in_f32, charts: found, stacks, overlapping_faces, more_overlaps }
}

/// Charts with the outline of an earlier chart, each with the number of the first such chart. Charts are compared by
/// their boundary loops, bit for bit, as they lie or mirrored.
pub fn equal_outlines(charts: &[Part], embedding: &Embedding) -> Vec<Option<usize>> {
    let outlines: Vec<Outline> = charts.par_iter().map(|chart| outline(chart, embedding)).collect();
    let mut first: BTreeMap<&Outline, usize> = BTreeMap::new();
    outlines
        .iter()
        .enumerate()
        .map(|(chart, of)| Some(*first.entry(of).or_insert(chart)).filter(|&on| on != chart))
        .collect()
}

/// Boundary loops of a chart as bits, in a form that does not depend on the beginning or direction of a loop.
pub(super) type Outline = Vec<Vec<[u64; 2]>>;

/// Outlines of all charts that are stacked or have charts on them.
fn outlines_of_stacks(charts: &[Part], embedding: &Embedding, stacked_on: &[Option<usize>]) -> Vec<Option<Outline>> {
    let lower: BTreeSet<usize> = stacked_on.iter().flatten().copied().collect();
    let is_of_stack = |chart: usize| stacked_on[chart].is_some() || lower.contains(&chart);
    let of = |(number, chart): (usize, &Part)| is_of_stack(number).then(|| outline(chart, embedding));
    charts.par_iter().enumerate().map(of).collect()
}

fn outline(chart: &Part, embedding: &Embedding) -> Outline {
    let bits = |vertex: &VertexId| point_key(embedding[chart.vertex_of()[vertex.index()]]);
    let mut loops: Outline =
        chart.loops().iter().map(|vertices| canonical(vertices.iter().map(bits).collect())).collect();
    loops.sort_unstable();
    loops
}

/// Cycle that begins at its least element and goes on in the direction of the lesser neighbour.
pub(super) fn canonical(mut cycle: Vec<[u64; 2]>) -> Vec<[u64; 2]> {
    let rotated = |cycle: &mut Vec<[u64; 2]>| {
        let least = (0..cycle.len()).min_by_key(|&at| cycle[at]).unwrap_or_default();
        cycle.rotate_left(least);
    };
    rotated(&mut cycle);
    let mut reversed: Vec<[u64; 2]> = cycle.iter().rev().copied().collect();
    rotated(&mut reversed);
    cycle.min(reversed)
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
const fn is_zero(count: &usize) -> bool {
    *count == 0
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
        stacked_on: None,
    }
}

/// Pairs of overlapping faces of different charts, the lower face first, ascending; at most `most`.
fn overlaps(
    charts: &[(usize, &Part)],
    relations: &ChartRelations,
    embedding: &Embedding,
    most: usize,
) -> Vec<[FaceId; 2]> {
    if charts.len() < 2 {
        return Vec::new();
    }
    let spots = charts.iter().flat_map(|&(number, chart)| spots_of(number, chart, embedding));
    let (spots, triangles): (Vec<Spot>, Vec<[DVec2; 3]>) = spots.unzip();
    let found = geom::overlaps(&triangles, |a, b| relations.must_be_apart(spots[a].chart, spots[b].chart), most);
    let in_order = |[a, b]: [FaceId; 2]| [a.min(b), a.max(b)];
    let mut pairs: Vec<[FaceId; 2]> =
        found.into_iter().map(|pair| in_order(pair.map(|spot| spots[spot].face))).collect();
    pairs.sort_unstable();
    pairs
}

/// A face with its chart.
struct Spot {
    chart: usize,
    face: FaceId,
}

/// Faces of a chart that have an area, with their corners counter-clockwise.
fn spots_of<'a>(chart: usize, of: &'a Part, embedding: &'a Embedding) -> impl Iterator<Item = (Spot, [DVec2; 3])> + 'a {
    let places = |face: usize| of.mesh().triangles[face].map(|v| embedding[of.vertex_of()[v.index()]]);
    (0..of.mesh().face_count()).filter_map(move |face| {
        let [a, b, c] = places(face);
        let corners = match orientation(a, b, c)? {
            Orientation::CounterClockwise => [a, b, c],
            Orientation::Clockwise => [a, c, b],
            Orientation::Collinear => return None,
        };
        Some((Spot { chart, face: of.face_of()[face] }, corners))
    })
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
        let stacked = self.charts.iter().filter(|chart| chart.stacked_on.is_some()).count();
        if self.planar && stacked > 0 {
            return format!("{charts}, {stacked} stacked on others, each planar, stacks apart: each proved one-to-one");
        }
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
