//! Substitution of right-hand sides through the fronts: up to the root and down again.
//!
//! A front solves for its own unknowns and passes their contribution to the rows below to its parent, like an update
//! of the factorization. On the way down it receives the unknowns of these rows from its parent. So subtrees are
//! independent. Units that await no other run in parallel, the fronts above them in sequence, with threads in large
//! fronts. The summands and their order depend on the pattern alone.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;
use faer::linalg::matmul::matmul;
use faer::traits::Conjugate;
use faer::{Accum, MatMut, MatRef, Par};

use super::dense::{mat, mat_mut};
use super::symbolic::{FrontAnalysis, Shape};
use super::units::Unit;
use crate::linalg::LinalgError;
use crate::linalg::pattern::{NONE, go_on_unless};
use crate::linalg::scalar::Number;

/// Number of right-hand sides solved together.
pub(in crate::linalg) const TOGETHER: usize = 4;

/// Number of entries of a panel from which a dense kernel is worth the call.
pub(in crate::linalg) const LARGE_PANEL: usize = 256;

/// Number of entries of a product above which a further thread is used.
const ENTRIES_PER_TASK: usize = 1 << 15;

/// Operation of a factorization on right-hand sides at each front.
pub(in crate::linalg) trait Substitution<T>: Sync {
    /// Solves for the front's own unknowns and subtracts their contribution from the rows below.
    fn up(&self, supernode: usize, part: Part<'_, T>);

    /// Solves for the front's own unknowns from the known unknowns of the rows below, which do not change.
    fn down(&self, supernode: usize, part: Part<'_, T>);
}

/// Rows of some right-hand sides that belong to a front; column-major.
pub(in crate::linalg) struct Part<'a, T> {
    pub(in crate::linalg) shape: Shape,
    /// Own rows: `columns` of each right-hand side.
    pub(in crate::linalg) own: &'a mut [T],
    /// Rows below: `below` of each right-hand side.
    pub(in crate::linalg) outer: &'a mut [T],
}

impl<T: Number> Part<'_, T> {
    /// Own rows and rows below as matrices.
    pub(in crate::linalg) fn matrices(&mut self) -> (MatMut<'_, T>, MatMut<'_, T>) {
        let (Shape { columns, below }, count) = (self.shape, self.own.len() / self.shape.columns);
        (mat_mut(self.own, columns, count), mat_mut(self.outer, below, count))
    }

    /// Calls `act` with real and imaginary parts as separate right-hand sides, which a real front does not couple.
    pub(in crate::linalg) fn by_parts(self, act: impl FnOnce(Part<'_, T::Part>)) {
        let Shape { columns, below } = self.shape;
        let (mut own, mut outer) = (split_parts(self.own, columns), split_parts(self.outer, below));
        act(Part { shape: self.shape, own: &mut own, outer: &mut outer });
        join_parts(&own, columns, self.own);
        join_parts(&outer, below, self.outer);
    }

    /// Iterates over the right-hand sides.
    pub(in crate::linalg) fn each(&mut self) -> impl Iterator<Item = (&mut [T], &mut [T])> {
        let Shape { columns, below } = self.shape;
        let (mut own, mut outer) = (&mut *self.own, &mut *self.outer);
        std::iter::from_fn(move || {
            let (first, rest) = std::mem::take(&mut own).split_at_mut_checked(columns)?;
            let (first_outer, rest_outer) = std::mem::take(&mut outer).split_at_mut(below);
            (own, outer) = (rest, rest_outer);
            Some((first, first_outer))
        })
    }
}

/// Splits each column of the given length into its real parts, followed by its imaginary parts.
fn split_parts<T: Number>(columns: &[T], length: usize) -> Vec<T::Part> {
    let mut parts = Vec::with_capacity(2 * columns.len());
    for column in columns.chunks_exact(length.max(1)) {
        parts.extend(column.iter().map(|number| number.parts()[0]));
        parts.extend(column.iter().map(|number| number.parts()[1]));
    }
    parts
}

/// Joins real and imaginary parts.
fn join_parts<T: Number>(parts: &[T::Part], length: usize, columns: &mut [T]) {
    let length = length.max(1);
    for (column, parts) in columns.chunks_exact_mut(length).zip(parts.chunks_exact(2 * length)) {
        let (real, imaginary) = parts.split_at(length);
        for (number, parts) in column.iter_mut().zip(real.iter().zip(imaginary)) {
            *number = T::from_parts([*parts.0, *parts.1]);
        }
    }
}

/// Subtracts A B; rows of a large A are processed in parallel.
pub(in crate::linalg) fn subtract_product<T: Number, A: Conjugate<Canonical = T>>(
    target: MatMut<'_, T>,
    a: MatRef<'_, A>,
    b: MatRef<'_, T>,
) {
    let rows = a.nrows();
    if rows < 2 || rows * a.ncols() <= ENTRIES_PER_TASK {
        matmul(target, Accum::Add, a, b, -T::ONE, Par::Seq);
        return;
    }
    let (upper_target, lower_target) = target.split_at_row_mut(rows / 2);
    let (upper, lower) = a.split_at_row(rows / 2);
    crate::parallel::join(|| subtract_product(upper_target, upper, b), || subtract_product(lower_target, lower, b));
}

/// Replaces consecutive right-hand sides, in the order of elimination, by their solutions.
///
/// # Errors
///
/// [`LinalgError::Cancelled`], checked at every unit and every front above the units: `x` is then unusable.
pub(in crate::linalg) fn substitute<T: Number>(
    analysis: &FrontAnalysis,
    how: &impl Substitution<T>,
    x: &mut [T],
    cancel: &AtomicBool,
) -> Result<(), LinalgError> {
    let n = analysis.order.new_to_old.len();
    let way = Way { analysis, how, n, count: x.len() / n };
    let (low, top): (Vec<&Unit>, Vec<&Unit>) = analysis.units.iter().partition(|unit| unit.awaited == 0);
    let up = |unit: &&Unit| go_on_unless(cancel).map(|()| way.up(unit, x));
    let done: Result<Vec<Carried<T>>, LinalgError> = low.par_iter().map(up).collect();
    for (unit, Carried { own, outer }) in low.iter().zip(done?) {
        put(&own, &way.rows(&unit.range), n, x);
        let mut outer = &outer[..];
        for root in way.roots(unit) {
            let (of_root, others) = outer.split_at(analysis.shape(root).below * way.count);
            way.add(root, of_root, x);
            outer = others;
        }
    }
    let fronts = top.iter().flat_map(|unit| unit.range.clone());
    for front in fronts.clone() {
        go_on_unless(cancel)?;
        way.up_top(front, x);
    }
    for front in fronts.rev() {
        go_on_unless(cancel)?;
        way.down_top(front, x);
    }
    let down = |unit: &&Unit| go_on_unless(cancel).map(|()| way.down(unit, x));
    let done: Result<Vec<Vec<T>>, LinalgError> = low.par_iter().map(down).collect();
    low.iter().zip(done?).for_each(|(unit, own)| put(&own, &way.rows(&unit.range), n, x));
    Ok(())
}

/// Data common to all fronts.
struct Way<'a, H> {
    analysis: &'a FrontAnalysis,
    how: &'a H,
    /// Number of rows of a right-hand side.
    n: usize,
    /// Number of right-hand sides.
    count: usize,
}

/// Rows of a unit, and contributions to the rows above from each front whose parent belongs to another unit.
struct Carried<T> {
    own: Vec<T>,
    outer: Vec<T>,
}

impl<H> Way<'_, H> {
    /// Own rows of consecutive fronts.
    fn rows(&self, fronts: &Range<usize>) -> Range<usize> {
        let at = |supernode: usize| self.analysis.begin[supernode] as usize;
        at(fronts.start)..at(fronts.end)
    }

    /// Fronts of a unit whose parents belong to other units, ascending.
    fn roots(&self, unit: &Unit) -> impl Iterator<Item = usize> {
        let end = unit.range.end;
        let is_root = move |&supernode: &usize| {
            let parent = self.analysis.parent[supernode];
            parent == NONE || parent as usize >= end
        };
        unit.range.clone().filter(is_root)
    }

    /// Adds the contribution of a front to the rows below it.
    fn add<T: Number>(&self, front: usize, outer: &[T], x: &mut [T]) {
        let rows = self.analysis.rows.column(front);
        if rows.is_empty() {
            return;
        }
        for (column, outer) in x.chunks_exact_mut(self.n).zip(outer.chunks_exact(rows.len())) {
            rows.iter().zip(outer).for_each(|(&row, &value)| column[row as usize] += value);
        }
    }

    /// Appends the rows below a front.
    fn gather<T: Number>(&self, front: usize, x: &[T], outer: &mut Vec<T>) {
        let rows = self.analysis.rows.column(front);
        for column in x.chunks_exact(self.n) {
            outer.extend(rows.iter().map(|&row| column[row as usize]));
        }
    }

    /// Processes a unit that awaits no other, on the way up. In a postorder, the contributions of the children are on
    /// top of a stack.
    fn up<T: Number>(&self, unit: &Unit, x: &[T]) -> Carried<T>
    where
        H: Substitution<T>,
    {
        let rows = self.rows(&unit.range);
        let mut x: Vec<T> = taken(x, self.n, &rows).collect();
        let (mut stack, mut own, mut outer) = (Vec::new(), Vec::new(), Vec::new());
        for front in unit.range.clone() {
            let shape = self.analysis.shape(front);
            let first = self.analysis.begin[front] as usize - rows.start;
            let of_front = first..first + shape.columns;
            own.clear();
            own.extend(taken(&x, rows.len(), &of_front));
            outer.clear();
            outer.resize(shape.below * self.count, T::ZERO);
            let children = self.analysis.children.column(front);
            let left = |&child: &u32| self.analysis.shape(child as usize).below * self.count;
            let begin = stack.len() - children.iter().map(left).sum::<usize>();
            let mut at = begin;
            for child in children {
                let part = Part { shape, own: &mut own, outer: &mut outer };
                self.take_from_child(*child as usize, &stack[at..at + left(child)], part);
                at += left(child);
            }
            stack.truncate(begin);
            self.how.up(front, Part { shape, own: &mut own, outer: &mut outer });
            put(&own, &of_front, rows.len(), &mut x);
            stack.extend_from_slice(&outer);
        }
        Carried { own: x, outer: stack }
    }

    fn take_from_child<T: Number>(&self, child: usize, left: &[T], mut part: Part<'_, T>) {
        let (relative, columns) = (self.analysis.relative(child), part.shape.columns);
        let inside = relative.partition_point(|&row| (row as usize) < columns);
        let mut left = left;
        for (own, outer) in part.each() {
            let (of_column, others) = left.split_at(relative.len());
            left = others;
            let (to_own, to_outer) = of_column.split_at(inside);
            relative.iter().zip(to_own).for_each(|(&row, &value)| own[row as usize] += value);
            relative[inside..].iter().zip(to_outer).for_each(|(&row, &value)| outer[row as usize - columns] += value);
        }
    }

    /// Processes a unit that awaits no other, on the way down. The rows below the next front are on top of the stack.
    fn down<T: Number>(&self, unit: &Unit, x: &[T]) -> Vec<T>
    where
        H: Substitution<T>,
    {
        let mut stack = Vec::new();
        self.roots(unit).for_each(|root| self.gather(root, x, &mut stack));
        let rows = self.rows(&unit.range);
        let mut x: Vec<T> = taken(x, self.n, &rows).collect();
        let (mut own, mut outer) = (Vec::new(), Vec::new());
        for front in unit.range.clone().rev() {
            let shape = self.analysis.shape(front);
            let first = self.analysis.begin[front] as usize - rows.start;
            let of_front = first..first + shape.columns;
            own.clear();
            own.extend(taken(&x, rows.len(), &of_front));
            outer.clear();
            outer.extend_from_slice(&stack[stack.len() - shape.below * self.count..]);
            stack.truncate(stack.len() - outer.len());
            let mut part = Part { shape, own: &mut own, outer: &mut outer };
            self.how.down(front, Part { shape, own: &mut *part.own, outer: &mut *part.outer });
            for &child in self.analysis.children.column(front) {
                let relative = self.analysis.relative(child as usize);
                for (own, outer) in part.each() {
                    let known =
                        |&row: &u32| own.get(row as usize).copied().unwrap_or_else(|| outer[row as usize - own.len()]);
                    stack.extend(relative.iter().map(known));
                }
            }
            put(&own, &of_front, rows.len(), &mut x);
        }
        x
    }

    /// Processes a front above the units that await no other, on the way up.
    fn up_top<T: Number>(&self, front: usize, x: &mut [T])
    where
        H: Substitution<T>,
    {
        let (shape, rows) = (self.analysis.shape(front), self.rows(&(front..front + 1)));
        let mut own: Vec<T> = taken(x, self.n, &rows).collect();
        let mut outer = vec![T::ZERO; shape.below * self.count];
        self.how.up(front, Part { shape, own: &mut own, outer: &mut outer });
        put(&own, &rows, self.n, x);
        self.add(front, &outer, x);
    }

    fn down_top<T: Number>(&self, front: usize, x: &mut [T])
    where
        H: Substitution<T>,
    {
        let (shape, rows) = (self.analysis.shape(front), self.rows(&(front..front + 1)));
        let mut own: Vec<T> = taken(x, self.n, &rows).collect();
        let mut outer = Vec::with_capacity(shape.below * self.count);
        self.gather(front, x, &mut outer);
        self.how.down(front, Part { shape, own: &mut own, outer: &mut outer });
        put(&own, &rows, self.n, x);
    }
}

/// Rows of consecutive right-hand sides of the given length.
fn taken<'a, T: Copy>(x: &'a [T], length: usize, rows: &Range<usize>) -> impl Iterator<Item = T> + use<'a, T> {
    let rows = rows.clone();
    x.chunks_exact(length).flat_map(move |column| &column[rows.clone()]).copied()
}

/// Writes rows back into consecutive right-hand sides.
fn put<T: Copy>(own: &[T], rows: &Range<usize>, length: usize, x: &mut [T]) {
    for (column, own) in x.chunks_exact_mut(length).zip(own.chunks_exact(rows.len())) {
        column[rows.clone()].copy_from_slice(own);
    }
}

/// Sum Σ xᵢ yᵢ over the shorter of both, without conjugation.
pub(in crate::linalg) fn dot<T: Number>(x: &[T], y: &[T]) -> T {
    x.iter().zip(y).fold(T::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// L panel of a front, split below its diagonal block.
pub(in crate::linalg) fn split_panel<T>(left: &[T], shape: Shape) -> (MatRef<'_, T>, MatRef<'_, T>) {
    mat(left, shape.height(), shape.columns).split_at_row(shape.columns)
}
