//! What is kept of fronts: complex numbers, or real ones where nothing else occurs.
//!
//! A matrix may be complex in a few places alone, as the equations of a free boundary are, and then so are its factors in the
//! fronts that such an entry lies in or below. All others take half the memory as real ones, and a quarter of the
//! multiplications. A matrix of real numbers has no use for that: its fronts hold what they are given.

use std::ops::Range;

use rayon::prelude::*;

use super::symbolic::FrontAnalysis;
use crate::linalg::order::NONE;
use crate::linalg::scalar::Number;

/// Fronts whose entries are looked at by one task.
const FRONTS_PER_TASK: usize = 1024;

/// Which fronts hold real parts alone, and where the numbers of each begin among those of its unit that are of its kind.
#[derive(Debug)]
pub(in crate::linalg) struct Places {
    is_real: Vec<bool>,
    starts: Vec<usize>,
}

/// Numbers of one front.
#[derive(Debug)]
pub(in crate::linalg) enum Numbers<T: Number> {
    Whole(Vec<T>),
    /// Real parts, where all imaginary ones are zero.
    Real(Vec<T::Part>),
}

/// The numbers of a front among others.
#[derive(Clone, Copy)]
pub(in crate::linalg) enum Panel<'a, T: Number> {
    Whole(&'a [T]),
    Real(&'a [T::Part]),
}

/// The numbers of a unit's fronts, one after another.
#[derive(Debug)]
pub(in crate::linalg) struct Kept<T: Number> {
    pub(in crate::linalg) whole: Vec<T>,
    pub(in crate::linalg) real: Vec<T::Part>,
}

impl Places {
    /// Those where every front holds what it is given.
    pub(in crate::linalg) fn whole(analysis: &FrontAnalysis) -> Self {
        Self::of(analysis, vec![false; analysis.count()])
    }

    /// Those of a matrix whose values `value` gives by their places in the analysed pattern.
    pub(in crate::linalg) fn new<T: Number>(analysis: &FrontAnalysis, value: impl Fn(usize) -> T + Sync) -> Self {
        let mut is_real = vec![T::IS_COMPLEX; analysis.count()];
        if T::IS_COMPLEX {
            let is_real_entry = |source: u32| value(source as usize).parts()[1] == T::Part::ZERO;
            let has_real_entries = |front| analysis.entries(front).iter().all(|entry| is_real_entry(entry.source));
            let fronts = is_real.par_iter_mut().enumerate().with_min_len(FRONTS_PER_TASK);
            fronts.for_each(|(front, is_real)| *is_real = has_real_entries(front));
            // Children come before their parents.
            for front in 0..analysis.count() {
                let parent = analysis.parent[front];
                if parent != NONE && !is_real[front] {
                    is_real[parent as usize] = false;
                }
            }
        }
        Self::of(analysis, is_real)
    }

    fn of(analysis: &FrontAnalysis, is_real: Vec<bool>) -> Self {
        let mut starts = Vec::with_capacity(analysis.count());
        for unit in &analysis.units {
            let mut next = [0; 2];
            for front in unit.range.clone() {
                let next = &mut next[usize::from(is_real[front])];
                starts.push(*next);
                *next += analysis.kept_len(front);
            }
        }
        Self { is_real, starts }
    }

    /// Whether a front holds real parts alone.
    pub(in crate::linalg) fn is_real(&self, front: usize) -> bool {
        self.is_real[front]
    }

    /// How many numbers are kept of some fronts: whole ones, and real parts.
    pub(super) fn room(&self, analysis: &FrontAnalysis, fronts: Range<usize>) -> [usize; 2] {
        let mut room = [0; 2];
        fronts.for_each(|front| room[usize::from(self.is_real[front])] += analysis.kept_len(front));
        room
    }

    /// The numbers of a front among those of its unit.
    pub(in crate::linalg) fn panel<'a, T: Number>(
        &self,
        analysis: &FrontAnalysis,
        front: usize,
        unit: &'a Kept<T>,
    ) -> Panel<'a, T> {
        let start = self.starts[front];
        let range = start..start + analysis.kept_len(front);
        if self.is_real[front] { Panel::Real(&unit.real[range]) } else { Panel::Whole(&unit.whole[range]) }
    }
}

impl<T: Number> Kept<T> {
    /// Room for so many whole numbers and real parts.
    pub(in crate::linalg) fn with_room([whole, real]: [usize; 2]) -> Self {
        Self { whole: Vec::with_capacity(whole), real: Vec::with_capacity(real) }
    }

    pub(in crate::linalg) fn bytes(&self) -> usize {
        size_of_val(&self.whole[..]) + size_of_val(&self.real[..])
    }
}

impl<T: Number> Default for Kept<T> {
    fn default() -> Self {
        Self { whole: Vec::new(), real: Vec::new() }
    }
}

impl<T: Number> Numbers<T> {
    /// The real parts that a front has which lies in a real one.
    ///
    /// # Panics
    ///
    /// If it has others.
    pub(in crate::linalg) fn real(&self) -> &[T::Part] {
        match self {
            Self::Real(numbers) => numbers,
            Self::Whole(_) => unreachable!("what lies in a real front is real"),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Whole(numbers) => size_of_val(&numbers[..]),
            Self::Real(numbers) => size_of_val(&numbers[..]),
        }
    }
}

/// Appends so many zeros, and returns them.
pub(in crate::linalg) fn appended<T: Number>(numbers: &mut Vec<T>, count: usize) -> &mut [T] {
    let start = numbers.len();
    numbers.resize(start + count, T::ZERO);
    &mut numbers[start..]
}
