//! Storage of fronts: complex numbers, or real numbers if no others occur.
//!
//! A matrix may be complex in a few places alone, like the equations of a free boundary along the boundary. Then its
//! factors are complex in the fronts that contain such an entry and in the fronts above them. All other fronts take
//! half the memory as real numbers, and a quarter of the multiplications. A real matrix needs no distinction: all its
//! fronts are stored in full.

use std::convert::identity;
use std::ops::Range;

use crate::parallel::prelude::*;

use super::symbolic::FrontAnalysis;
use super::tree::Update;
use crate::linalg::pattern::NONE;
use crate::linalg::scalar::Number;

/// Number of fronts per task.
const FRONTS_PER_TASK: usize = 1024;

/// Kind of each front (real parts alone, or full numbers), and the start of its numbers among the numbers of that
/// kind in its unit.
#[derive(Debug)]
pub(in crate::linalg) struct Places {
    is_real: Vec<bool>,
    starts: Vec<usize>,
}

/// Numbers of a front.
#[derive(Debug)]
pub(in crate::linalg) enum Numbers<T: Number> {
    Full(Vec<T>),
    /// Real parts; all imaginary parts are zero.
    Real(Vec<T::Part>),
}

/// Borrowed numbers of a front.
#[derive(Clone, Copy)]
pub(in crate::linalg) enum FrontNumbers<'a, T: Number> {
    Full(&'a [T]),
    Real(&'a [T::Part]),
}

/// Consecutive numbers of a unit's fronts.
#[derive(Debug)]
pub(in crate::linalg) struct Kept<T: Number> {
    pub(in crate::linalg) full: Vec<T>,
    pub(in crate::linalg) real: Vec<T::Part>,
}

/// Number of stored numbers of some fronts.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::linalg) struct Room {
    /// Numbers of full fronts.
    pub(in crate::linalg) full: usize,
    /// Numbers of real fronts.
    pub(in crate::linalg) real: usize,
}

impl Room {
    fn of_kind(&mut self, is_real: bool) -> &mut usize {
        if is_real { &mut self.real } else { &mut self.full }
    }
}

impl Places {
    /// Storage with all fronts in full.
    pub(in crate::linalg) fn all_full(analysis: &FrontAnalysis) -> Self {
        Self::of(analysis, vec![false; analysis.count()])
    }

    /// Storage for a matrix. `value` returns a value by its index in the analysed pattern.
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
            let mut room = Room::default();
            for front in unit.range.clone() {
                let count = room.of_kind(is_real[front]);
                starts.push(*count);
                *count += analysis.kept_len(front);
            }
        }
        Self { is_real, starts }
    }

    /// True if a front holds real parts alone.
    pub(in crate::linalg) fn is_real(&self, front: usize) -> bool {
        self.is_real[front]
    }

    /// Number of stored numbers of some fronts.
    pub(super) fn room(&self, analysis: &FrontAnalysis, fronts: Range<usize>) -> Room {
        let mut room = Room::default();
        fronts.for_each(|front| *room.of_kind(self.is_real[front]) += analysis.kept_len(front));
        room
    }

    /// Numbers of a front among the numbers of its unit.
    pub(in crate::linalg) fn numbers_of<'a, T: Number>(
        &self,
        analysis: &FrontAnalysis,
        front: usize,
        unit: &'a Kept<T>,
    ) -> FrontNumbers<'a, T> {
        let start = self.starts[front];
        let range = start..start + analysis.kept_len(front);
        if self.is_real[front] { FrontNumbers::Real(&unit.real[range]) } else { FrontNumbers::Full(&unit.full[range]) }
    }
}

impl<T: Number> Kept<T> {
    pub(in crate::linalg) fn with_room(Room { full, real }: Room) -> Self {
        Self { full: Vec::with_capacity(full), real: Vec::with_capacity(real) }
    }

    pub(in crate::linalg) fn bytes(&self) -> usize {
        size_of_val(&self.full[..]) + size_of_val(&self.real[..])
    }
}

impl<T: Number> Default for Kept<T> {
    fn default() -> Self {
        Self { full: Vec::new(), real: Vec::new() }
    }
}

impl<T: Number> Numbers<T> {
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Full(numbers) => size_of_val(&numbers[..]),
            Self::Real(numbers) => size_of_val(&numbers[..]),
        }
    }
}

/// Front to which the updates of its children are added.
pub(in crate::linalg) trait Gather<N> {
    /// Adds a child's update. `number` converts its numbers to those of the front; `relative` holds the positions of
    /// its rows in this front, ascending.
    fn extend_add<S: Copy>(&mut self, update: &[S], relative: &[u32], number: impl Fn(S) -> N + Copy);
}

/// Adds the updates of all children to a front that is stored in full.
pub(in crate::linalg) fn gather_in_full<T: Number>(
    analysis: &FrontAnalysis,
    children: &[Update<T>],
    front: &mut impl Gather<T>,
) {
    for (child, update) in children {
        let relative = analysis.relative(*child as usize);
        match update {
            Numbers::Full(update) => front.extend_add(update, relative, identity),
            Numbers::Real(update) => front.extend_add(update, relative, T::from_real_part),
        }
    }
}

/// Adds the updates of all children to a real front; these updates are real, too.
pub(in crate::linalg) fn gather_real<T: Number>(
    analysis: &FrontAnalysis,
    children: &[Update<T>],
    front: &mut impl Gather<T::Part>,
) {
    for (child, update) in children {
        let Numbers::Real(update) = update else { unreachable!("what lies in a real front is real") };
        front.extend_add(update, analysis.relative(*child as usize), identity);
    }
}

/// Appends `count` zeros and returns them.
pub(in crate::linalg) fn append_zeros<T: Number>(numbers: &mut Vec<T>, count: usize) -> &mut [T] {
    let start = numbers.len();
    numbers.resize(start + count, T::ZERO);
    &mut numbers[start..]
}

/// Returns `count` zeros that have been written. The system only promises zeros in new memory. Reading it before
/// writing then costs two page faults and a message to the other cores.
pub(in crate::linalg) fn written_zeros<T: Number>(count: usize) -> Vec<T> {
    let mut numbers = Vec::with_capacity(count);
    append_zeros(&mut numbers, count);
    numbers
}
