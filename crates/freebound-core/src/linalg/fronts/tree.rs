//! Traversal of the tree of fronts from the leaves to the root: a unit runs on a single thread, units run in
//! parallel.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use crate::parallel::Scope;

use super::places::{Numbers, Places, Room, written_zeros};
use super::symbolic::FrontAnalysis;
use crate::linalg::LinalgError;
use crate::linalg::pattern::{NONE, narrow};
use crate::linalg::scalar::Number;

/// Operation at each front.
pub(in crate::linalg) trait Kernel<T: Number>: Sync {
    /// Stored data of the fronts of a unit.
    type Kept: Send + Sync;

    /// Allocates the stored data of a unit, for the given numbers and columns.
    fn room(&self, unit: usize, room: Room, columns: usize) -> Self::Kept;

    /// Assembles a front from its entries and its children's updates and eliminates its columns. Leaves the Schur
    /// complement in `update`, which is zero before, and real if the front is real.
    fn eliminate(
        &self,
        supernode: usize,
        children: &[Update<T>],
        kept: &mut Self::Kept,
        update: &mut Numbers<T>,
    ) -> Result<(), LinalgError>;
}

/// Number of a supernode, with its update for the parent.
pub(in crate::linalg) type Update<T> = (u32, Numbers<T>);

/// Data shared by the threads of a factorization.
pub(in crate::linalg) struct Tree<'a, T: Number, K: Kernel<T>> {
    analysis: &'a FrontAnalysis,
    places: &'a Places,
    kernel: &'a K,
    cancel: &'a AtomicBool,
    done: Vec<OnceLock<K::Kept>>,
    inboxes: Vec<Mutex<Vec<Update<T>>>>,
    awaited: Vec<AtomicUsize>,
    /// First front in the order of elimination that could not be eliminated.
    failed: Mutex<Option<(usize, LinalgError)>>,
    memory: Memory,
}

#[derive(Default)]
struct Memory {
    now: AtomicUsize,
    peak: AtomicUsize,
}

impl Memory {
    fn take(&self, bytes: usize) {
        let now = self.now.fetch_add(bytes, Ordering::Relaxed) + bytes;
        self.peak.fetch_max(now, Ordering::Relaxed);
    }
    fn give_back(&self, bytes: usize) {
        self.now.fetch_sub(bytes, Ordering::Relaxed);
    }
}

impl<'a, T: Number, K: Kernel<T>> Tree<'a, T, K> {
    /// Processes the whole tree. Returns the stored data of every unit, and the peak numeric memory in bytes.
    ///
    /// # Errors
    ///
    /// [`LinalgError::Cancelled`], and the kernel's error at the first front, in the order of elimination, that it
    /// cannot eliminate.
    pub(in crate::linalg) fn run(
        analysis: &'a FrontAnalysis,
        places: &'a Places,
        kernel: &'a K,
        cancel: &'a AtomicBool,
    ) -> Result<(Vec<K::Kept>, usize), LinalgError> {
        let tree = Self {
            analysis,
            places,
            kernel,
            cancel,
            done: analysis.units.iter().map(|_| OnceLock::new()).collect(),
            inboxes: analysis.units.iter().map(|_| Mutex::default()).collect(),
            awaited: analysis.units.iter().map(|unit| AtomicUsize::new(unit.awaited)).collect(),
            failed: Mutex::default(),
            memory: Memory::default(),
        };
        crate::parallel::scope(|scope| {
            // A thread takes its newest task first, so the last spawned here is the first unit in postorder.
            for unit in (0..analysis.units.len()).rev().filter(|&unit| analysis.units[unit].awaited == 0) {
                let tree = &tree;
                scope.spawn(move |scope| tree.run_unit(unit, scope));
            }
        });
        let failed = tree.failed.into_inner().expect("no task panics while it holds this");
        if let Some((_, error)) = failed.filter(|_| !cancel.load(Ordering::Relaxed)) {
            return Err(error);
        }
        let kept: Option<Vec<_>> = tree.done.into_iter().map(OnceLock::into_inner).collect();
        Ok((kept.ok_or(LinalgError::Cancelled)?, tree.memory.peak.into_inner()))
    }

    fn run_unit<'scope>(&'scope self, unit: usize, scope: &Scope<'scope>) {
        let analysis = self.analysis;
        let range = analysis.units[unit].range.clone();
        let room = self.places.room(analysis, range.clone());
        let columns = (analysis.begin[range.end] - analysis.begin[range.start]) as usize;
        self.memory.take(room.full * size_of::<T>() + room.real * size_of::<T::Part>());
        let mut kept = self.kernel.room(unit, room, columns);
        let mut arrived = std::mem::take(&mut *self.inboxes[unit].lock().expect("no task panics while it holds this"));
        arrived.sort_unstable_by_key(|&(child, _)| child);
        let mut waiting: Vec<Option<Numbers<T>>> = range.clone().map(|_| None).collect();
        for supernode in range.clone() {
            if self.cancel.load(Ordering::Relaxed) || self.has_failed_before(supernode) {
                return;
            }
            let children = analysis.children.column(supernode).iter().map(|&child| {
                let update = if (child as usize) < range.start {
                    let place = arrived.binary_search_by_key(&child, |&(child, _)| child);
                    place.ok().map(|place| std::mem::replace(&mut arrived[place].1, Numbers::Full(Vec::new())))
                } else {
                    waiting[child as usize - range.start].take()
                };
                (child, update.expect("children come before their parent"))
            });
            let children: Vec<Update<T>> = children.collect();
            let length = analysis.shape(supernode).update_len();
            let mut update = if self.places.is_real(supernode) {
                Numbers::Real(written_zeros(length))
            } else {
                Numbers::Full(written_zeros(length))
            };
            self.memory.take(update.bytes());
            if let Err(error) = self.kernel.eliminate(supernode, &children, &mut kept, &mut update) {
                self.fail(supernode, error);
                return;
            }
            self.memory.give_back(children.iter().map(|(_, update)| update.bytes()).sum());
            drop(children);
            match analysis.parent[supernode] {
                NONE => {}
                parent if (parent as usize) < range.end => waiting[supernode - range.start] = Some(update),
                parent => self.send(supernode, parent, update, scope),
            }
        }
        let fresh = self.done[unit].set(kept).is_ok();
        debug_assert!(fresh, "a unit runs once");
    }

    /// True if a front before this front could not be eliminated: then this front is not needed.
    fn has_failed_before(&self, supernode: usize) -> bool {
        let failed = self.failed.lock().expect("no task panics while it holds this");
        failed.as_ref().is_some_and(|&(before, _)| before < supernode)
    }

    /// Records a front that cannot be eliminated. The fronts before it continue, so that the first failed front does
    /// not depend on the number of threads.
    fn fail(&self, supernode: usize, error: LinalgError) {
        let mut failed = self.failed.lock().expect("no task panics while it holds this");
        if failed.as_ref().is_none_or(|&(before, _)| supernode < before) {
            *failed = Some((supernode, error));
        }
    }

    /// Sends an update to another unit, and starts that unit if it awaited only this update.
    fn send<'scope>(&'scope self, supernode: usize, parent: u32, update: Numbers<T>, scope: &Scope<'scope>) {
        let unit = self.analysis.unit_of[parent as usize] as usize;
        self.inboxes[unit].lock().expect("no task panics while it holds this").push((narrow(supernode), update));
        if self.awaited[unit].fetch_sub(1, Ordering::AcqRel) == 1 {
            scope.spawn(move |scope| self.run_unit(unit, scope));
        }
    }
}
