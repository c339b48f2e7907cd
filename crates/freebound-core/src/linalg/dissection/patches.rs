//! Patches of a graph, and bisection of their quotient graph.

use std::cmp::Reverse;
use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;

use crate::linalg::LinalgError;
use crate::linalg::pattern::{NONE, Pattern, go_on_unless, narrow, running_sum};

/// Average number of vertices per seed of a patch.
const PATCH: u64 = 64;

/// Number of far patches from which distances are measured.
const LANDMARKS: usize = 6;

/// Least share of the vertices on either side of a cut.
const LEAST_SHARE: f64 = 0.44;

/// Patches of a graph and the edges between them.
pub(super) struct Quotient {
    /// Adjacent patches of each patch.
    around: Pattern,
    /// Number of edges of the graph behind each entry of `around`.
    edges: Vec<u32>,
    /// Number of vertices of each patch.
    size: Vec<u32>,
}

impl Quotient {
    /// Grows patches around vertices scattered over the graph. Returns the patch of every vertex, and the quotient
    /// graph.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(super) fn of_patches(graph: &Pattern, cancel: &AtomicBool) -> Result<(Vec<u32>, Self), LinalgError> {
        let patch = grown(graph);
        go_on_unless(cancel)?;
        let count = patch.iter().max().map_or(0, |&last| last as usize + 1);
        let mut size = vec![0; count];
        for &own in &patch {
            size[own as usize] += 1;
        }
        let mut pairs: Vec<u64> = Vec::new();
        for (vertex, &own) in patch.iter().enumerate() {
            let others = graph.column(vertex).iter().map(|&other| patch[other as usize]).filter(|&other| other != own);
            pairs.extend(others.map(|other| u64::from(own) << 32 | u64::from(other)));
        }
        go_on_unless(cancel)?;
        pairs.par_sort_unstable();
        go_on_unless(cancel)?;
        let (mut counts, mut rows, mut edges) = (vec![0; count], Vec::new(), Vec::new());
        for run in pairs.chunk_by(|a, b| a == b) {
            let [own, other] = [run[0] >> 32, run[0] & u64::from(u32::MAX)];
            counts[usize::try_from(own).expect("32 bits")] += 1;
            rows.push(u32::try_from(other).expect("32 bits"));
            edges.push(narrow(run.len()));
        }
        Ok((patch, Self { around: Pattern { offsets: running_sum(&counts), rows }, edges, size }))
    }

    /// Bisects the quotient graph recursively, `levels` times. Returns the part of every patch; the parts of both
    /// halves of a part are consecutive.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`].
    pub(super) fn parts(&self, levels: u32, cancel: &AtomicBool) -> Result<Vec<u32>, LinalgError> {
        let mut part = vec![0; self.size.len()];
        let mut lists: Vec<Vec<u32>> = vec![(0..narrow(part.len())).collect()];
        for _ in 0..levels {
            go_on_unless(cancel)?;
            let seconds: Vec<Vec<u32>> = lists.par_iter().map(|list| self.second_half(list, &part)).collect();
            let mut halves = Vec::with_capacity(2 * lists.len());
            for (list, second) in lists.into_iter().zip(seconds) {
                for &patch in &second {
                    part[patch as usize] = NONE;
                }
                let first = list.into_iter().filter(|&patch| part[patch as usize] != NONE).collect();
                halves.extend([first, second]);
            }
            lists = halves;
            for (number, list) in (0..).zip(&lists) {
                for &patch in list {
                    part[patch as usize] = number;
                }
            }
        }
        Ok(part)
    }

    fn beside(&self, patch: u32) -> impl Iterator<Item = (u32, u32)> {
        let range = self.around.offsets[patch as usize] as usize..self.around.offsets[patch as usize + 1] as usize;
        self.around.rows[range.clone()].iter().copied().zip(self.edges[range].iter().copied())
    }

    /// Patches of a list on a side of the cheapest cut found. Cuts run along a level line of the distance from a far
    /// patch, or of the difference of two such distances.
    fn second_half(&self, list: &[u32], part: &[u32]) -> Vec<u32> {
        let Some(&first) = list.first() else { return Vec::new() };
        let fields = self.fields(first, list, part);
        let sum = |&patch: &u32| (fields.iter().map(|field| i64::from(field[patch as usize])).sum::<i64>(), patch);
        let mut by_sum = list.to_vec();
        by_sum.sort_by_cached_key(sum);
        let differences: Vec<(usize, Option<usize>)> =
            (0..fields.len()).flat_map(|one| (0..one).map(Some).chain([None]).map(move |other| (one, other))).collect();
        let sorted = |(one, other): (usize, Option<usize>)| {
            let value =
                |patch: u32| fields[one][patch as usize] - other.map_or(0, |other| fields[other][patch as usize]);
            sorted_by(&by_sum, value)
        };
        let cut = |difference| {
            let mut sorted = sorted(difference);
            let (cost, at) = self.cheapest(&sorted, part)?;
            Some((cost, sorted.split_off(at)))
        };
        // Ties go to the first cut.
        let cuts: Vec<Option<(f64, Vec<u32>)>> = differences.into_par_iter().map(cut).collect();
        let best = cuts.into_iter().flatten().reduce(|best, cut| if cut.0 < best.0 { cut } else { best });
        best.map_or_else(|| list[list.len() / 2..].to_vec(), |(_, half)| half)
    }

    /// Cost and position of the cheapest cut of a sorted list.
    fn cheapest(&self, sorted: &[u32], part: &[u32]) -> Option<(f64, usize)> {
        let weight = |patch: u32| f64::from(self.size[patch as usize]);
        let total: f64 = sorted.iter().map(|&patch| weight(patch)).sum();
        let mut is_before = vec![false; self.size.len()];
        let (mut before, mut cut) = (0.0, 0.0);
        let mut best: Option<(f64, usize)> = None;
        for (place, &patch) in sorted.iter().enumerate() {
            is_before[patch as usize] = true;
            before += weight(patch) / total;
            for (other, edges) in self.beside(patch).filter(|&(other, _)| part[other as usize] == part[patch as usize])
            {
                cut += if is_before[other as usize] { -f64::from(edges) } else { f64::from(edges) };
            }
            let cost = cut * (1.0 + 2.0 * (before - 0.5_f64).abs());
            let is_even = (LEAST_SHARE..=1.0 - LEAST_SHARE).contains(&before);
            if is_even && best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, place + 1));
            }
        }
        best
    }

    /// Distances from far patches of a list to all its patches, counted in patches. Unreachable patches get a
    /// distance greater than all others.
    fn fields(&self, first: u32, list: &[u32], part: &[u32]) -> Vec<Vec<i32>> {
        let far = i32::try_from(list.len()).expect("fewer patches than vertices");
        let farthest = |fields: &[Vec<i32>]| {
            let nearest = |patch: u32| fields.iter().map(|field| field[patch as usize]).min();
            list.iter().copied().max_by_key(|&patch| (nearest(patch), Reverse(patch))).unwrap_or(first)
        };
        let mut from = farthest(&[self.distances(first, far, part)]);
        let mut fields = Vec::with_capacity(LANDMARKS);
        for _ in 0..LANDMARKS {
            fields.push(self.distances(from, far, part));
            from = farthest(&fields);
        }
        fields
    }

    fn distances(&self, from: u32, far: i32, part: &[u32]) -> Vec<i32> {
        let mut distances = vec![far; self.size.len()];
        distances[from as usize] = 0;
        let (mut queue, mut next) = (vec![from], 0);
        while let Some(&patch) = queue.get(next) {
            next += 1;
            for (other, _) in self.beside(patch) {
                if part[other as usize] == part[patch as usize] && distances[other as usize] == far {
                    distances[other as usize] = distances[patch as usize] + 1;
                    queue.push(other);
                }
            }
        }
        distances
    }
}

/// Counting sort of a list by small numbers, stable. It takes a fraction of the time of a comparison sort.
fn sorted_by(list: &[u32], value: impl Fn(u32) -> i32) -> Vec<u32> {
    let (least, greatest) = list
        .iter()
        .map(|&patch| value(patch))
        .fold((i32::MAX, i32::MIN), |(least, greatest), value| (least.min(value), greatest.max(value)));
    let place = |patch: u32| value(patch).abs_diff(least) as usize;
    let mut counts = vec![0; greatest.abs_diff(least) as usize + 1];
    for &patch in list {
        counts[place(patch)] += 1;
    }
    let mut next = running_sum(&counts);
    let mut sorted = vec![0; list.len()];
    for &patch in list {
        let next = &mut next[place(patch)];
        sorted[*next as usize] = patch;
        *next += 1;
    }
    sorted
}

/// Patch of every vertex: the patch of the nearest seed.
fn grown(graph: &Pattern) -> Vec<u32> {
    let n = graph.order();
    let mut patch = vec![NONE; n];
    // A hash of vertex numbers (Fibonacci hashing) scatters the seeds, since consecutive numbers may be neighbours.
    let is_seed = |vertex: &u64| (vertex.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32).is_multiple_of(PATCH);
    let mut queue: Vec<u32> = (0..n as u64).filter(is_seed).filter_map(|vertex| u32::try_from(vertex).ok()).collect();
    queue.reserve_exact(n - queue.len());
    for (number, &seed) in (0..).zip(&queue) {
        patch[seed as usize] = number;
    }
    let (mut next, mut count) = (0, narrow(queue.len()));
    for start in 0..n {
        while let Some(&vertex) = queue.get(next) {
            next += 1;
            for &other in graph.column(vertex as usize) {
                if patch[other as usize] == NONE {
                    patch[other as usize] = patch[vertex as usize];
                    queue.push(other);
                }
            }
        }
        if patch[start] == NONE {
            patch[start] = count;
            count += 1;
            queue.push(narrow(start));
        }
    }
    patch
}
