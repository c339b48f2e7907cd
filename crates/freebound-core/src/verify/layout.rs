//! Verdict on any layout: triangles of the plane, whoever placed them.
//!
//! # Planar
//!
//! A layout is *planar* if no two faces overlap, no face is turned over against its neighbours, and every face with
//! area in space has area in the layout. All tests are exact. Two triangles overlap if their insides meet: no side of
//! either has the other triangle on its outer side or on its line. Charts, and parts of one chart, may touch. Nothing is
//! asked of the surface: edges may have three faces, the surface may be closed or one-sided, and its faces may run both
//! ways. The strict [`verdict`](super::verdict::verdict) of a disk also asks that its boundary does not touch itself.
//!
//! A face with the corners of an earlier face, in space and in the layout, is a *duplicate*. Both show one piece of the
//! surface at one place, so duplicates are listed and otherwise left out.
//!
//! A face whose corners lie at one or two points covers nothing: it has *no place*, like a face without coordinates.
//! Such faces are listed. They are an error if they hold more than [`MOST_WITHOUT_PLACE`] of the surface.
//!
//! # Charts
//!
//! A chart is a set of faces joined across edges whose ends agree in space and in the layout. Faces without a place form
//! no chart. Faces of different
//! [groups](PlaneLayout::groups), such as materials with a picture each, are never compared.

use std::collections::{HashMap, HashSet};

use glam::DVec2;

use super::atlas_verdict::{Outline, canonical};
use crate::geom::{self, Bounds, Orientation, double_area, orientation, point_key};
use crate::mesh::union::{DisjointSets, ParitySets};
use crate::mesh::{EdgeTable, FaceId, TriMesh, VertexId, is_zero_area, place_key};
use crate::parallel::prelude::*;
use crate::problem::{Control, Embedding, SolveError};

use super::findings::{FINDINGS_LISTED, Finding, FindingCode, FindingSeverity};

/// Largest share of the surface that may lie at points of the layout. Welding leaves thin faces without a place.
pub const MOST_WITHOUT_PLACE: f64 = 0.01;

/// Distance from the unit square beyond which a coordinate is far away.
const FAR: f64 = 100.0;

/// Triangles with a position in the plane.
#[derive(Clone, Copy, Debug)]
pub struct PlaneLayout<'a> {
    /// Triangles, with one vertex per texture coordinate.
    pub mesh: &'a TriMesh,
    /// Coordinate of each vertex.
    pub coordinates: &'a Embedding,
    /// Group of each triangle. Faces of different groups may overlap. Empty if all faces form one group.
    pub groups: &'a [u32],
    /// Faces of the file without coordinates, ascending. None of the triangles belongs to them.
    pub bare_faces: &'a [u32],
}

/// Smallest distance of two charts in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGap {
    /// Distance, pixels.
    pub least: f64,
    /// Width and height of the picture that fills the unit square, pixels.
    pub picture: DVec2,
}

/// Tests of a layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayoutOptions {
    /// True if faces and charts may share exactly one place.
    pub accepts_stacks: bool,
    /// Smallest distance of two charts. `None` if it is not tested.
    pub gap: Option<PixelGap>,
    /// Largest ratio of a chart's scale to the usual scale, and of the usual scale to the chart's.
    pub scale_ratio: f64,
    /// Largest number of faces or pairs that a finding lists.
    pub listed: usize,
}

impl Default for LayoutOptions {
    fn default() -> Self {
        Self { accepts_stacks: false, gap: None, scale_ratio: 2.0, listed: FINDINGS_LISTED }
    }
}

/// Verdict on a layout. Faces are numbered as in the file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct LayoutVerdict {
    /// True if no finding contradicts that the layout is planar.
    pub planar: bool,
    /// True if the layout is also planar with all coordinates rounded to 32 bits.
    #[cfg_attr(feature = "serde", serde(rename = "f32"))]
    pub planar_in_f32: bool,
    /// True if no finding is an error.
    pub passes: bool,
    /// Number of charts.
    pub charts: usize,
    /// Number of triangles with coordinates.
    pub triangles: usize,
    /// Findings, errors first.
    pub findings: Vec<Finding>,
}

/// Judges a layout.
///
/// # Panics
///
/// If a triangle names a vertex that the mesh or the coordinates lack, or `groups` is neither empty nor has a group for
/// each triangle.
pub fn layout_verdict(layout: PlaneLayout<'_>, options: LayoutOptions) -> LayoutVerdict {
    layout_verdict_with(layout, options, Control::unattended()).expect("nothing cancels it")
}

/// Judges a layout unless the caller cancels.
///
/// # Errors
///
/// [`SolveError::Cancelled`] if cancelled.
///
/// # Panics
///
/// Panics of [`layout_verdict`].
pub fn layout_verdict_with(
    layout: PlaneLayout<'_>,
    options: LayoutOptions,
    control: Control<'_>,
) -> Result<LayoutVerdict, SolveError> {
    let joined = joined_vertices(layout);
    let (kept, duplicates) = without_duplicates(layout, &joined);
    let layout = kept.as_ref().map_or(layout, |(mesh, groups)| PlaneLayout { mesh, groups, ..layout });
    control.go_on()?;
    let as_given = Judged::new(layout, &joined, options);
    control.go_on()?;
    let mut findings = as_given.errors(options.listed, control);
    control.go_on()?;
    let contradicts = |finding: &Finding| finding.severity == FindingSeverity::Error;
    let planar = !findings.iter().any(contradicts);
    let is_planar_in_f32 = || {
        let in_f32: Embedding = layout.coordinates.iter().map(|z| z.as_vec2().as_dvec2()).collect();
        let rounded = PlaneLayout { coordinates: &in_f32, ..layout };
        !Judged::new(rounded, &joined_vertices(rounded), options).errors(1, control).iter().any(contradicts)
    };
    let planar_in_f32 = planar && is_planar_in_f32();
    control.go_on()?;
    findings.extend(as_given.remarks());
    findings.extend((!duplicates.is_empty()).then(|| Finding::of_faces(FindingCode::Duplicate, duplicates)));
    findings.sort_by_key(|finding| (finding.severity, finding.code));
    for finding in &mut findings {
        finding.faces.truncate(options.listed);
    }
    let (charts, triangles) = (as_given.chart_count, layout.mesh.face_count());
    Ok(LayoutVerdict { planar, planar_in_f32, passes: planar, charts, triangles, findings })
}

impl LayoutVerdict {
    /// Removes the findings of some codes, and turns the findings of others into errors. `planar` stays as it is.
    #[must_use]
    pub fn judged_by(mut self, ignored: &[FindingCode], denied: &[FindingCode]) -> Self {
        self.findings.retain(|finding| !ignored.contains(&finding.code));
        for finding in self.findings.iter_mut().filter(|finding| denied.contains(&finding.code)) {
            finding.severity = FindingSeverity::Error;
        }
        self.findings.sort_by_key(|finding| (finding.severity, finding.code));
        self.passes = !self.findings.iter().any(|finding| finding.severity == FindingSeverity::Error);
        self
    }

    /// Verdict in lower-case words, without the findings.
    pub fn summary(&self) -> String {
        let holds = if self.planar_in_f32 { "holds in 32 bits" } else { "does not hold in 32 bits" };
        match (self.charts, self.planar) {
            (1, true) => format!("planar: proved one-to-one; {holds}"),
            (count, true) => format!("{count} charts, each planar, and apart: proved one-to-one; {holds}"),
            (1, false) => "not planar".to_owned(),
            (count, false) => format!("{count} charts, not planar"),
        }
    }
}

/// Layout with its charts and the orientation of its faces.
struct Judged<'a> {
    layout: PlaneLayout<'a>,
    options: LayoutOptions,
    /// Chart of each triangle. Faces without a place have numbers from `chart_count` on.
    chart_of: Vec<usize>,
    chart_count: usize,
    /// Orientation of each triangle in the layout. `None` if a coordinate is not finite.
    turns: Vec<Option<Orientation>>,
    /// True for each triangle that runs against the first one of its chart on the surface.
    runs_against: Vec<bool>,
    /// True for each chart whose surface has one side only.
    is_one_sided: Vec<bool>,
    /// Triangles of each chart.
    faces_of: Vec<Vec<usize>>,
    /// First chart with the outline of each chart.
    first_like: Vec<usize>,
    /// Sides of one triangle of their group only: side k of triangle t is 3 t + k.
    boundary: Vec<u32>,
}

impl<'a> Judged<'a> {
    /// Charts and orientations. `joined` is the result of [`joined_vertices`].
    fn new(layout: PlaneLayout<'a>, joined: &[VertexId], options: LayoutOptions) -> Self {
        let mesh = layout.mesh;
        let has_place = |face: usize| !has_no_place(layout, face);
        let joined_corners = |t: &[VertexId; 3]| t.map(|vertex| joined[vertex.index()]);
        let triangles: Vec<[VertexId; 3]> = mesh.triangles.iter().map(joined_corners).collect();
        let table = EdgeTable::new(mesh.vertex_count(), &triangles);
        let tail = |side: u32| triangles[side as usize / 3][side as usize % 3];
        let group = |side: u32| layout.groups.get(side as usize / 3).copied().unwrap_or_default();
        let mut sets = DisjointSets::new(mesh.face_count());
        let mut directions = ParitySets::new(mesh.face_count());
        let mut contradictions = Vec::new();
        let mut boundary = Vec::new();
        for sides in table.edges() {
            // Faces of one group meet at an edge, whatever faces of other groups do there.
            let mut own: Vec<u32> = sides.iter().copied().filter(|&side| has_place(side as usize / 3)).collect();
            own.sort_by_key(|&side| (group(side), side));
            for own in own.chunk_by(|&a, &b| group(a) == group(b)) {
                for pair in own.windows(2) {
                    sets.join(pair[0] / 3, pair[1] / 3);
                }
                match *own {
                    [side] => boundary.push(side),
                    [a, b] if a / 3 != b / 3 && directions.relate(a / 3, b / 3, tail(a) == tail(b)) => {
                        contradictions.push(a / 3);
                    }
                    _ => {}
                }
            }
        }
        boundary.sort_unstable();
        // Faces without a place come last, each as a set of its own.
        let (mut roots, alone): (Vec<u32>, Vec<u32>) = sets.roots().partition(|&root| has_place(root as usize));
        let chart_count = roots.len();
        roots.extend(alone);
        let number_of: HashMap<u32, usize> = roots.iter().copied().zip(0..).collect();
        let chart_of: Vec<usize> = (0..).take(mesh.face_count()).map(|face| number_of[&sets.find(face)]).collect();
        let mut faces_of = vec![Vec::new(); chart_count];
        for (face, &chart) in chart_of.iter().enumerate().filter(|(_, chart)| **chart < chart_count) {
            faces_of[chart].push(face);
        }
        let one_sided: HashSet<usize> = contradictions.iter().map(|&face| chart_of[face as usize]).collect();
        let judged = |face: usize| {
            let [a, b, c] = corners_of(layout, face);
            orientation(a, b, c).filter(|_| [a, b, c].iter().all(|z| z.is_finite()))
        };
        let charts = Charts { chart_of: &chart_of, faces_of: &faces_of, boundary: &boundary };
        let mut first_like = first_like(layout, &triangles, &charts);
        // Faces without a place are charts of their own.
        first_like.extend(chart_count..roots.len());
        Self {
            layout,
            options,
            first_like,
            chart_count,
            turns: (0..mesh.face_count()).into_par_iter().map(judged).collect(),
            runs_against: (0..).take(mesh.face_count()).map(|face| directions.find(face).1).collect(),
            chart_of,
            is_one_sided: (0..chart_count).map(|chart| one_sided.contains(&chart)).collect(),
            faces_of,
            boundary,
        }
    }

    fn corners(&self, face: usize) -> [DVec2; 3] {
        corners_of(self.layout, face)
    }

    /// Faces of the file for triangles, ascending, each once.
    fn in_file(&self, triangles: impl IntoIterator<Item = usize>) -> Vec<FaceId> {
        let number = |face: usize| FaceId::new(self.layout.mesh.polygon(FaceId::from_index(face)));
        let mut faces: Vec<FaceId> = triangles.into_iter().map(number).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    fn faces_where(&self, is_found: impl Fn(usize) -> bool) -> Vec<FaceId> {
        self.in_file((0..self.turns.len()).filter(|&face| is_found(face)))
    }

    /// True if the corners of a triangle lie at one or two points of the layout.
    fn has_no_place(&self, face: usize) -> bool {
        has_no_place(self.layout, face)
    }

    /// True if a triangle has three corners on a line of the layout, and area in space.
    fn is_degenerate(&self, face: usize) -> bool {
        let in_space = self.layout.mesh.triangles[face].map(|v| self.layout.mesh.positions[v.index()]);
        let is_on_line = self.turns[face] == Some(Orientation::Collinear) && !self.has_no_place(face);
        is_on_line && !is_zero_area(in_space)
    }

    /// Findings that can contradict that the layout is planar. Lists at most `most` pairs of overlapping faces.
    fn errors(&self, most: usize, control: Control<'_>) -> Vec<Finding> {
        let mut findings = vec![
            Finding::of_faces(FindingCode::NotFinite, self.faces_where(|face| self.turns[face].is_none())),
            Finding::of_faces(FindingCode::Flipped, self.flipped()),
            Finding::of_faces(FindingCode::Degenerate, self.faces_where(|face| self.is_degenerate(face))),
            Finding::of_faces(FindingCode::ConcavePolygon, self.concave_polygons()),
            self.without_place(),
        ];
        findings.extend(self.overlaps(most, control));
        findings.retain(|finding| finding.count > 0);
        findings
    }

    /// Faces at one or two points: an error if they hold much of the surface.
    fn without_place(&self) -> Finding {
        let is_found = |face: usize| self.turns[face].is_some() && self.has_no_place(face);
        let area = |faces: &mut dyn Iterator<Item = usize>| -> f64 {
            faces.map(|face| self.layout.mesh.double_area_vector(FaceId::from_index(face)).length()).sum()
        };
        let all = 0..self.turns.len();
        let share = area(&mut all.clone().filter(|&face| is_found(face))) / area(&mut all.clone());
        let finding = Finding::of_faces(FindingCode::NoPlace, self.faces_where(is_found));
        if share > MOST_WITHOUT_PLACE { finding.into_error() } else { finding }
    }

    /// Faces turned over against the majority of their chart.
    fn flipped(&self) -> Vec<FaceId> {
        let side = |face: usize| {
            let is_up = match self.turns[face]? {
                Orientation::CounterClockwise => true,
                Orientation::Clockwise => false,
                Orientation::Collinear => return None,
            };
            Some(is_up != self.runs_against[face])
        };
        let of_chart = |faces: &Vec<usize>| {
            let sides: Vec<(usize, bool)> = faces.iter().filter_map(|&face| Some((face, side(face)?))).collect();
            let up = sides.iter().filter(|(_, is_up)| *is_up).count();
            let is_down = 2 * up < sides.len();
            sides.into_iter().filter(move |(_, is_up)| *is_up == is_down).map(|(face, _)| face).collect::<Vec<_>>()
        };
        let two_sided = self.faces_of.iter().zip(&self.is_one_sided).filter(|(_, is_one_sided)| !**is_one_sided);
        self.in_file(two_sided.flat_map(|(faces, _)| of_chart(faces)))
    }

    /// Polygons whose triangles are good and that another cut into triangles would fold.
    fn concave_polygons(&self) -> Vec<FaceId> {
        let is_concave = |polygon: &crate::mesh::Polygon<'_>| {
            let turn = self.turns[polygon.first_face.index()];
            let is_good = turn.is_some_and(|turn| turn != Orientation::Collinear);
            let are_alike = polygon.faces().all(|face| self.turns[face.index()] == turn);
            let ear_turn = |[a, b, c]: [VertexId; 3]| {
                orientation(self.layout.coordinates[a], self.layout.coordinates[b], self.layout.coordinates[c])
            };
            is_good && are_alike && !polygon.convex_ears().all(|ear| ear_turn(ear) == turn)
        };
        let found = self.layout.mesh.polygons_where(is_concave);
        self.in_file(found.into_iter().map(FaceId::index))
    }

    /// Overlapping faces, by kind.
    ///
    /// Faces that share a place exactly, and charts that share an outline, are stacked. Both cover one region, so only
    /// the first of them is compared with others. Each chart is also compared with itself.
    fn overlaps(&self, most: usize, control: Control<'_>) -> Vec<Finding> {
        let (lowest, stacked) = self.lowest_and_stacked();
        let mut pairs = self.overlapping_pairs(&lowest, most + 1, control);
        let upper = (0..self.chart_count).filter(|&chart| self.first_like[chart] != chart);
        let first_at_place = |chart: usize| -> Vec<usize> {
            let mut seen = HashSet::new();
            self.faces_of[chart].iter().copied().filter(|&face| seen.insert(corners_key(self.corners(face)))).collect()
        };
        let within = upper.flat_map(|chart| self.overlapping_pairs(&first_at_place(chart), most + 1, control));
        pairs.extend(within.take((most + 1).saturating_sub(pairs.len())));
        let are_more = pairs.len() > most;
        let mut found: [Vec<[FaceId; 2]>; 3] = Default::default();
        for pair in pairs {
            let [a, b] = pair.map(|face| self.chart_of[face]);
            let is_mirrored = self.turns[pair[0]] != self.turns[pair[1]];
            let kind = if a == b { 0 } else { 1 + usize::from(is_mirrored) };
            let [a, b] = pair.map(|face| FaceId::new(self.layout.mesh.polygon(FaceId::from_index(face))));
            found[kind].push([a.min(b), a.max(b)]);
        }
        let codes = [FindingCode::Overlap, FindingCode::OverlapOfCharts, FindingCode::OverlapMirrored];
        let finding = |(code, mut pairs): (FindingCode, Vec<[FaceId; 2]>)| {
            pairs.sort_unstable();
            pairs.dedup();
            let finding = Finding::of_pairs(code, pairs, most);
            // The search ends at a number of pairs of all kinds.
            Finding { more: are_more && finding.count > 0, ..finding }
        };
        let stacked = Finding::of_faces(FindingCode::Stacked, self.in_file(stacked));
        let stacked = Some(stacked).filter(|_| !self.options.accepts_stacks);
        codes.into_iter().zip(found).map(finding).chain(stacked).collect()
    }

    /// Faces that are the first at their place, in charts that are the first with their outline; and all other faces with
    /// a place. Faces on a line are in neither.
    fn lowest_and_stacked(&self) -> (Vec<usize>, Vec<usize>) {
        let has_area = |face: &usize| self.turns[*face].is_some_and(|turn| turn != Orientation::Collinear);
        let is_upper = |face: usize| self.first_like[self.chart_of[face]] != self.chart_of[face];
        let key = |face: usize| {
            let group = self.layout.groups.get(face).copied().unwrap_or_default();
            (group, corners_key(self.corners(face)))
        };
        let (upper, lower): (Vec<usize>, Vec<usize>) =
            (0..self.turns.len()).filter(has_area).partition(|&face| is_upper(face));
        // Every lower face takes its place, so that no chart has two faces there.
        let first = first_equals(lower.iter().map(|&face| key(face)));
        let at_first = |at: &usize| first[*at] as usize == *at;
        let (lowest, twice): (Vec<usize>, Vec<usize>) = (0..lower.len()).partition(at_first);
        let stacked = twice.into_iter().map(|at| lower[at]).chain(upper);
        (lowest.into_iter().map(|at| lower[at]).collect(), stacked.collect())
    }

    /// Pairs of overlapping faces of one group among some faces, at most `most`. Too few if cancelled.
    fn overlapping_pairs(&self, faces: &[usize], most: usize, control: Control<'_>) -> Vec<[usize; 2]> {
        let upright = |&face: &usize| {
            let [a, b, c] = self.corners(face);
            match self.turns[face]? {
                Orientation::CounterClockwise => Some((face, [a, b, c])),
                Orientation::Clockwise => Some((face, [a, c, b])),
                Orientation::Collinear => None,
            }
        };
        let (faces, triangles): (Vec<usize>, Vec<[DVec2; 3]>) = faces.iter().filter_map(upright).unzip();
        let group = |at: usize| self.layout.groups.get(faces[at]).copied().unwrap_or_default();
        let pairs = geom::overlaps(&triangles, |a, b| group(a) == group(b) && control.go_on().is_ok(), most);
        pairs.into_iter().map(|pair| pair.map(|at| faces[at])).collect()
    }

    /// Findings that do not contradict that the layout is planar.
    fn remarks(&self) -> Vec<Finding> {
        let mirrored = |faces: &Vec<usize>| {
            let count = |turn| faces.iter().filter(|&&face| self.turns[face] == Some(turn)).count();
            count(Orientation::Clockwise) > count(Orientation::CounterClockwise)
        };
        let of_charts = |is_found: &dyn Fn(&Vec<usize>) -> bool| {
            self.in_file(self.faces_of.iter().filter(|faces| is_found(faces)).map(|faces| faces[0]))
        };
        let is_far = |face: usize| {
            let corners = self.corners(face);
            corners.iter().any(|z| z.is_finite() && (*z - DVec2::splat(0.5)).abs().max_element() > 0.5 + FAR)
        };
        let bare = self.layout.bare_faces.iter().copied().map(FaceId::new).collect();
        let mut findings = vec![
            Finding::of_faces(FindingCode::NoCoordinates, bare),
            Finding::of_faces(FindingCode::FarAway, self.faces_where(is_far)),
            Finding::of_faces(FindingCode::Outside, of_charts(&|faces| self.tile(faces).is_none())),
            Finding::of_faces(FindingCode::Scale, self.charts_of_other_scale()),
            Finding::of_faces(FindingCode::Mirrored, of_charts(&mirrored)),
            Finding::of_faces(FindingCode::Turned, self.faces_where(|face| self.runs_against[face])),
            Finding::of_faces(
                FindingCode::Tiles,
                of_charts(&|faces| self.tile(faces).is_some_and(|tile| tile != [0; 2])),
            ),
        ];
        if let Some(gap) = self.options.gap {
            let pairs = self.near_charts(gap);
            findings.push(Finding::of_pairs(FindingCode::Gap, pairs, self.options.listed));
        }
        findings.retain(|finding| finding.count > 0);
        findings
    }

    /// Unit square of the grid that holds a chart; `None` if no single one does.
    #[expect(clippy::cast_possible_truncation, reason = "casts saturate, and far tiles are no tiles")]
    fn tile(&self, faces: &[usize]) -> Option<[i64; 2]> {
        let points = faces.iter().flat_map(|&face| self.corners(face)).filter(|z| z.is_finite());
        let bounds = Bounds::of(points);
        if bounds == Bounds::EMPTY {
            return Some([0; 2]);
        }
        let tile = bounds.middle().floor();
        let holds = bounds.low.cmpge(tile).all() && bounds.high.cmple(tile + DVec2::ONE).all();
        holds.then(|| tile.to_array().map(|x| x as i64))
    }

    /// Charts, by their first faces, whose scale differs from the usual one: the median over the surface.
    fn charts_of_other_scale(&self) -> Vec<FaceId> {
        let mesh = self.layout.mesh;
        let scale = |faces: &Vec<usize>| {
            let in_space = |face: usize| {
                let [a, b, c] = mesh.triangles[face].map(|v| mesh.positions[v.index()]);
                (b - a).cross(c - a).length()
            };
            let in_plane = |face: usize| double_area(self.corners(face)).abs();
            let space: f64 = faces.iter().map(|&face| in_space(face)).sum();
            let plane: f64 = faces.iter().map(|&face| in_plane(face)).sum();
            (faces[0], (plane / space).sqrt(), space)
        };
        let mut scales: Vec<(usize, f64, f64)> = self.faces_of.iter().map(scale).collect();
        scales.retain(|(_, scale, _)| scale.is_finite() && *scale > 0.0);
        scales.sort_by(|(_, a, _), (_, b, _)| a.total_cmp(b));
        let half = scales.iter().map(|(.., area)| area).sum::<f64>() / 2.0;
        let mut up_to = 0.0;
        let usual = scales.iter().find(|(.., area)| {
            up_to += area;
            up_to >= half
        });
        let Some(&(_, usual, _)) = usual else { return Vec::new() };
        let differs = |scale: f64| (scale / usual).max(usual / scale) > self.options.scale_ratio;
        self.in_file(scales.into_iter().filter(|(_, scale, _)| differs(*scale)).map(|(face, ..)| face))
    }

    /// Pairs of charts that are nearer to each other than the gap, by their first faces.
    fn near_charts(&self, PixelGap { least: gap, picture }: PixelGap) -> Vec<[FaceId; 2]> {
        let in_pixels = |(chart, ends): (usize, [DVec2; 2])| (chart, ends.map(|z| z * picture));
        // Stacked charts lie on the first of them.
        let is_lowest = |(chart, _): &(usize, [DVec2; 2])| self.first_like[*chart] == *chart;
        let edges = self.boundary_sides().into_iter().filter(is_lowest).map(in_pixels);
        let edges: Vec<(usize, [DVec2; 2])> = edges.collect();
        let mut order: Vec<usize> = (0..edges.len()).collect();
        let bounds = |at: usize| Bounds::of(edges[at].1);
        let whole = (0..edges.len()).fold(Bounds::EMPTY, |whole, at| whole.union(bounds(at)));
        order.sort_by_cached_key(|&at| (geom::place_along_curve(whole, bounds(at).middle()), at));
        let grown = |at: usize| {
            let Bounds { low, high } = bounds(at);
            Bounds { low: low - gap / 2.0, high: high + gap / 2.0 }
        };
        let tree = geom::BoxTree::new(order.iter().map(|&at| grown(at)));
        let group = |chart: usize| self.layout.groups.get(self.faces_of[chart][0]).copied().unwrap_or_default();
        let near = |place: usize| {
            let (chart, side) = edges[order[place]];
            let others = tree.later(place).map(|other| edges[order[other]]);
            let is_near = move |(other, _): &(usize, [DVec2; 2])| *other != chart && group(*other) == group(chart);
            let others = others.filter(is_near).filter(|(_, other)| distance(side, *other) < gap);
            others.map(|(other, _)| [chart.min(other), chart.max(other)]).collect::<Vec<_>>()
        };
        let mut pairs: Vec<[usize; 2]> = (0..order.len()).into_par_iter().flat_map_iter(near).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let first = |chart: usize| FaceId::new(self.layout.mesh.polygon(FaceId::from_index(self.faces_of[chart][0])));
        pairs.into_iter().map(|pair| pair.map(first)).collect()
    }

    /// Boundary sides of all charts, each with its chart.
    fn boundary_sides(&self) -> Vec<(usize, [DVec2; 2])> {
        let side = |side: u32| {
            let corners = self.corners(side as usize / 3);
            [corners[side as usize % 3], corners[(side as usize + 1) % 3]]
        };
        let sides = self.boundary.iter().map(|&at| (self.chart_of[at as usize / 3], side(at)));
        sides.filter(|(_, ends)| ends.iter().all(|z| z.is_finite())).collect()
    }
}

/// Triangles of a layout and their groups without duplicate faces, and these faces. `None` if there are none.
fn without_duplicates(layout: PlaneLayout<'_>, joined: &[VertexId]) -> (Option<(TriMesh, Vec<u32>)>, Vec<FaceId>) {
    let mesh = layout.mesh;
    let number = |face: usize| mesh.polygon(FaceId::from_index(face));
    let group = |face: usize| layout.groups.get(face).copied().unwrap_or_default();
    let key = |face: usize| {
        let mut corners = mesh.triangles[face].map(|vertex| joined[vertex.index()]);
        corners.sort_unstable();
        (group(face), corners)
    };
    let first = first_equals((0..mesh.face_count()).map(key));
    let mut is_repeated = vec![false; mesh.face_count()];
    first
        .iter()
        .zip(0..)
        .filter(|(first, face)| *first != face)
        .for_each(|(&first, _)| is_repeated[first as usize] = true);
    // Polygons as their triangles, each by the first triangle that equals it. Most have no triangle twice.
    let mut seen: HashSet<Vec<u32>> = HashSet::new();
    let mut stays = vec![true; mesh.face_count()];
    let mut duplicates = Vec::new();
    let faces: Vec<usize> = (0..mesh.face_count()).collect();
    // Triangles of one polygon are consecutive.
    for polygon in faces.chunk_by(|&a, &b| number(a) == number(b)) {
        if !polygon.iter().all(|&face| is_repeated[first[face] as usize]) {
            continue;
        }
        let mut triangles: Vec<u32> = polygon.iter().map(|&face| first[face]).collect();
        triangles.sort_unstable();
        if !seen.insert(triangles) {
            for &face in polygon {
                stays[face] = false;
            }
            duplicates.push(FaceId::new(number(polygon[0])));
        }
    }
    if duplicates.is_empty() {
        return (None, duplicates);
    }
    let groups = layout.groups.iter().zip(&stays).filter(|(_, stays)| **stays).map(|(group, _)| *group).collect();
    (Some((mesh.clone().with_faces(&stays), groups)), duplicates)
}

/// First chart of the group and with the outline of each chart: equal boundaries, bit for bit, as they lie or mirrored. A
/// chart whose boundary is no set of simple cycles is the first of its kind.
fn first_like(layout: PlaneLayout<'_>, triangles: &[[VertexId; 3]], charts: &Charts<'_>) -> Vec<usize> {
    let mut sides_of = vec![Vec::new(); charts.faces_of.len()];
    for &side in charts.boundary {
        let ends = [side, side - side % 3 + (side + 1) % 3];
        let ends = ends.map(|corner| triangles[corner as usize / 3][corner as usize % 3]);
        sides_of[charts.chart_of[side as usize / 3]].push(ends);
    }
    let outline = |sides: &Vec<[VertexId; 2]>| outline_of(layout.coordinates, sides);
    let found: Vec<Option<Outline>> = sides_of.par_iter().map(outline).collect();
    let group = |chart: usize| layout.groups.get(charts.faces_of[chart][0]).copied().unwrap_or_default();
    let mut first: HashMap<(u32, Result<Outline, usize>), usize> = HashMap::new();
    let keys = found.into_iter().enumerate().map(|(chart, outline)| (chart, (group(chart), outline.ok_or(chart))));
    keys.map(|(chart, key)| *first.entry(key).or_insert(chart)).collect()
}

/// Charts of a layout, as far as their outlines need them.
struct Charts<'a> {
    chart_of: &'a [usize],
    faces_of: &'a [Vec<usize>],
    boundary: &'a [u32],
}

fn corners_of(layout: PlaneLayout<'_>, face: usize) -> [DVec2; 3] {
    layout.mesh.triangles[face].map(|vertex| layout.coordinates[vertex])
}

fn has_no_place(layout: PlaneLayout<'_>, face: usize) -> bool {
    let [a, b, c] = corners_of(layout, face);
    a == b || b == c || c == a
}

/// First vertex with the position and the coordinate of each vertex.
fn joined_vertices(layout: PlaneLayout<'_>) -> Vec<VertexId> {
    let vertices = layout.mesh.positions.iter().zip(layout.coordinates);
    let first = first_equals(vertices.map(|(position, uv)| (place_key(*position), point_key(*uv))));
    first.into_iter().map(VertexId::new).collect()
}

/// Number of the first item with the key of each item.
fn first_equals<K: Ord + Copy + Send>(keys: impl Iterator<Item = K>) -> Vec<u32> {
    let mut order: Vec<(K, u32)> = keys.zip(0..).collect();
    order.par_sort_unstable();
    let mut first = vec![0; order.len()];
    for equals in order.chunk_by(|a, b| a.0 == b.0) {
        for (_, item) in equals {
            first[*item as usize] = equals[0].1;
        }
    }
    first
}

/// Key of the corners of a triangle, in any order.
fn corners_key(corners: [DVec2; 3]) -> [[u64; 2]; 3] {
    let mut bits = corners.map(point_key);
    bits.sort_unstable();
    bits
}

/// Boundary loops of a chart from its boundary sides. `None` if a vertex has other than two sides, or there are none.
fn outline_of(coordinates: &Embedding, sides: &[[VertexId; 2]]) -> Option<Outline> {
    let mut around: HashMap<VertexId, Vec<VertexId>> = HashMap::new();
    for &[a, b] in sides {
        around.entry(a).or_default().push(b);
        around.entry(b).or_default().push(a);
    }
    if around.is_empty() || around.values().any(|ends| ends.len() != 2) {
        return None;
    }
    let bits = |vertex: VertexId| point_key(coordinates[vertex]);
    let mut starts: Vec<VertexId> = around.keys().copied().collect();
    starts.sort_unstable();
    let mut loops = Vec::new();
    for start in starts {
        let mut found = Vec::new();
        let mut at = start;
        while let Some(ends) = around.remove(&at) {
            found.push(bits(at));
            at = ends.into_iter().find(|end| around.contains_key(end)).unwrap_or(start);
        }
        if !found.is_empty() {
            loops.push(canonical(found));
        }
    }
    loops.sort_unstable();
    Some(loops)
}

/// Distance of two segments that do not cross.
fn distance(a: [DVec2; 2], b: [DVec2; 2]) -> f64 {
    let to_segment = |z: DVec2, [from, to]: [DVec2; 2]| {
        let along = to - from;
        let share = ((z - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        z.distance(from + along * if share.is_finite() { share } else { 0.0 })
    };
    let of_ends = a.map(|end| to_segment(end, b)).into_iter().chain(b.map(|end| to_segment(end, a)));
    of_ends.fold(f64::INFINITY, f64::min)
}
