//! Charts of a part joined with their neighbours, those with the costliest border first.
//!
//! Two charts are joined along one line of their common border: no other chart and no seam within a chart meets it
//! between its ends. Along an open line, two disks become one. A closed line joins a disk with a chart around it.

use std::collections::{BTreeMap, BTreeSet};

use super::surface::CutSurface;
use crate::mesh::VertexId;
use crate::mesh::union::DisjointSets;
use crate::problem::{Control, SolveError};

/// Seam between two charts.
struct Border {
    edge: u32,
    faces: [u32; 2],
    cost: f64,
    /// Vertex of the opened part at both ends of the edge, as each of the two faces has it.
    ends: [[u32; 2]; 2],
    /// True if the edge ceased to be a seam.
    is_closed: bool,
}

/// Two charts along a line of their common border.
pub(super) struct Meeting {
    /// Numbers of the charts, the lower first.
    pub(super) charts: [u32; 2],
    /// Vertices of the first and the second chart at both ends of each edge of the line.
    pub(super) spans: Vec<[[u32; 2]; 2]>,
    /// Numbers of the borders.
    borders: Vec<usize>,
    cost: f64,
}

impl Meeting {
    /// Vertices of the first and the second chart along the line.
    pub(super) fn ends(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.spans.iter().flatten().copied()
    }
}

/// Charts of a part, some of which are joined.
pub(super) struct Joining {
    borders: Vec<Border>,
    /// Chart of each face.
    chart_of: Vec<u32>,
    chart_count: usize,
    /// Euler characteristic of each chart: 1 for a disk.
    euler: Vec<i64>,
    /// Vertices of the opened part that became one.
    vertices: DisjointSets,
}

impl Joining {
    /// Takes a part and its seams. Only edges for which `may_close` is true can cease to be seams.
    pub(super) fn new(surface: &CutSurface<'_>, is_seam: &[bool], may_close: impl Fn(u32) -> bool) -> Self {
        let (part, polygons) = (surface.part(), surface.part().polygons());
        let faces_of_edges = part.faces_of_edges();
        let opened = part.opened_along(is_seam);
        let vertex_at = |face: u32, vertex: u32| {
            let range = polygons.corner_range(face as usize);
            let corner = range.clone().find(|&corner| polygons.corners[corner].number() == vertex);
            opened.polygons().corners[corner.unwrap_or(range.start)]
        };
        let (chart_of, chart_count) = charts(polygons.face_count(), &faces_of_edges, is_seam);
        let border = |(edge, faces): (u32, &Vec<u32>)| {
            let &[a, b] = &faces[..] else { return None };
            let of = &surface.edges[edge as usize];
            let ends = of.ends.map(|end| [a, b].map(|face| vertex_at(face, end).number()));
            let is_border = chart_of[a as usize] != chart_of[b as usize] && may_close(edge);
            is_border.then_some(Border { edge, faces: [a, b], cost: of.cost, ends, is_closed: false })
        };
        let borders = (0..).zip(&faces_of_edges).filter_map(border).collect();
        let mut euler = vec![0; chart_count];
        let mut is_counted = vec![false; opened.polygons().positions.len()];
        for (face, &chart) in chart_of.iter().enumerate() {
            euler[chart as usize] += 1;
            for vertex in opened.polygons().face(face).iter().copied().map(VertexId::index) {
                euler[chart as usize] += i64::from(!std::mem::replace(&mut is_counted[vertex], true));
            }
        }
        for (faces, &is_seam) in faces_of_edges.iter().zip(is_seam) {
            let sides = if is_seam { faces.len() } else { 1 };
            faces.iter().take(sides).for_each(|&face| euler[chart_of[face as usize] as usize] -= 1);
        }
        Self { borders, chart_of, chart_count, euler, vertices: DisjointSets::new(is_counted.len()) }
    }

    /// Chart of a face, by the first of the charts that were joined.
    pub(super) fn chart_of(&self, face: u32) -> u32 {
        self.chart_of[face as usize]
    }

    /// Charts of two faces, the lower number first.
    pub(super) fn pair_of(&self, faces: [u32; 2]) -> [u32; 2] {
        ascending(faces.map(|face| self.chart_of(face)))
    }

    /// Joins charts until `most` are left, or no two can be joined. Pairs of charts in `apart` stay apart, the lower
    /// number first, and so do those for which `fits` is false.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(super) fn join(
        &mut self,
        most: usize,
        mut apart: BTreeSet<[u32; 2]>,
        mut fits: impl FnMut(&Meeting) -> bool,
        control: Control<'_>,
    ) -> Result<(), SolveError> {
        let mut refused = BTreeSet::new();
        while self.chart_count > most {
            let mut best = None;
            for meeting in self.meetings(&apart) {
                control.go_on()?;
                if refused.contains(&meeting.borders[0]) {
                    continue;
                }
                let euler = self.euler_if_joined(&meeting);
                if euler <= 1 && fits(&meeting) {
                    best = Some((meeting, euler));
                    break;
                }
                refused.insert(meeting.borders[0]);
            }
            let Some((meeting, euler)) = best else { break };
            let [kept, gone] = meeting.charts;
            for [a, b] in meeting.ends() {
                self.vertices.join(a, b);
            }
            for border in meeting.borders {
                self.borders[border].is_closed = true;
            }
            self.euler[kept as usize] = euler;
            self.chart_of.iter_mut().filter(|of| **of == gone).for_each(|of| *of = kept);
            self.chart_count -= 1;
            let renamed = |pair: [u32; 2]| ascending(pair.map(|chart| if chart == gone { kept } else { chart }));
            apart = apart.into_iter().map(renamed).collect();
        }
        Ok(())
    }

    /// Lines along which charts may be joined, the costliest first.
    fn meetings(&mut self, apart: &BTreeSet<[u32; 2]>) -> Vec<Meeting> {
        let mut common: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (number, border) in self.borders.iter().enumerate() {
            let charts = self.pair_of(border.faces);
            if charts[0] != charts[1] && !apart.contains(&charts) {
                common.entry(charts).or_default().push(number);
            }
        }
        let mut meetings: Vec<Meeting> =
            common.into_iter().flat_map(|(charts, borders)| self.lines(charts, &borders)).collect();
        meetings.sort_by(|a, b| b.cost.total_cmp(&a.cost).then(a.borders.cmp(&b.borders)));
        meetings
    }

    /// Lines of the common border of two charts.
    fn lines(&mut self, charts: [u32; 2], borders: &[usize]) -> Vec<Meeting> {
        let mut places: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut place = |end: [u32; 2]| {
            let next = u32::try_from(places.len()).expect("vertices fit");
            *places.entry(end).or_insert(next)
        };
        let spans: Vec<[[u32; 2]; 2]> = borders.iter().map(|&border| self.span(charts, border)).collect();
        let at: Vec<[u32; 2]> = spans.iter().map(|span| span.map(&mut place)).collect();
        let mut sets = DisjointSets::new(places.len());
        for [from, to] in &at {
            sets.join(*from, *to);
        }
        let mut lines: BTreeMap<u32, Meeting> = BTreeMap::new();
        for ((&border, span), [from, _]) in borders.iter().zip(spans).zip(at) {
            let empty = || Meeting { charts, spans: Vec::new(), borders: Vec::new(), cost: 0.0 };
            let line = lines.entry(sets.find(from)).or_insert_with(empty);
            line.spans.push(span);
            line.borders.push(border);
            line.cost += self.borders[border].cost;
        }
        lines.into_values().collect()
    }

    /// Vertices of two charts at both ends of a border.
    fn span(&mut self, charts: [u32; 2], border: usize) -> [[u32; 2]; 2] {
        let Border { faces, ends, .. } = &self.borders[border];
        let is_turned = self.chart_of[faces[0] as usize] == charts[1];
        ends.map(|[a, b]| {
            let [a, b] = [a, b].map(|vertex| self.vertices.find(vertex));
            if is_turned { [b, a] } else { [a, b] }
        })
    }

    /// Euler characteristic of two charts joined along a line.
    fn euler_if_joined(&self, meeting: &Meeting) -> i64 {
        let is_open = meeting.ends().collect::<BTreeSet<_>>().len() > meeting.spans.len();
        meeting.charts.map(|chart| self.euler[chart as usize]).iter().sum::<i64>() - i64::from(is_open)
    }

    /// First of the vertices of the opened part that became one with a vertex.
    pub(super) fn root(&mut self, vertex: VertexId) -> usize {
        self.vertices.find(vertex.number()) as usize
    }

    /// Seams that are left of some seams.
    pub(super) fn remaining_seams(&self, is_seam: &[bool]) -> Vec<bool> {
        let mut is_seam = is_seam.to_vec();
        for border in self.borders.iter().filter(|border| border.is_closed) {
            is_seam[border.edge as usize] = false;
        }
        is_seam
    }
}

/// Chart of each face, and the number of charts.
fn charts(face_count: usize, faces_of_edges: &[Vec<u32>], is_seam: &[bool]) -> (Vec<u32>, usize) {
    let mut sets = DisjointSets::new(face_count);
    for (faces, _) in faces_of_edges.iter().zip(is_seam).filter(|(_, is_seam)| !**is_seam) {
        faces.windows(2).for_each(|pair| _ = sets.join(pair[0], pair[1]));
    }
    let mut number_of = vec![u32::MAX; face_count];
    let count = (0..).zip(sets.roots()).map(|(number, root)| number_of[root as usize] = number).count();
    let chart_of = (0..).take(face_count).map(|face| number_of[sets.find(face) as usize]).collect();
    (chart_of, count)
}

/// Two numbers, the lower first.
fn ascending([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
