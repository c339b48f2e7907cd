//! Parallel work: on all cores with the feature `rayon`, on the caller's thread without it.
//!
//! Results are bitwise equal with and without `rayon`: sums that reach a result have a fixed order.

#[cfg(feature = "rayon")]
pub(crate) use rayon::{Scope, current_num_threads, join, prelude, scope};

#[cfg(not(feature = "rayon"))]
pub(crate) use serial::{Scope, join, prelude, scope};

#[cfg(all(test, not(feature = "rayon")))]
pub(crate) use serial::current_num_threads;

/// Parallelism of faer's dense products.
pub(crate) fn parallelism() -> faer::Par {
    #[cfg(feature = "rayon")]
    return faer::Par::rayon(0);
    #[cfg(not(feature = "rayon"))]
    faer::Par::Seq
}

/// Runs work on a separate thread pool. Returns the work if no threads can be created.
///
/// # Errors
///
/// The work, which did not run.
#[cfg(feature = "rayon")]
pub(crate) fn spawn_detached<F: FnOnce() + Send + 'static>(work: F) -> Result<(), F> {
    let threads = rayon::ThreadPoolBuilder::new().num_threads(current_num_threads());
    match threads.thread_name(|_| "apart".to_owned()).build() {
        Ok(pool) => {
            pool.spawn(work);
            Ok(())
        }
        Err(_) => Err(work),
    }
}

/// Runs work on a separate thread. Returns the work if no thread can be created.
///
/// # Errors
///
/// The work, which did not run.
#[cfg(not(feature = "rayon"))]
pub(crate) fn spawn_detached<F: FnOnce() + Send + 'static>(work: F) -> Result<(), F> {
    let slot = std::sync::Arc::new(std::sync::Mutex::new(Some(work)));
    let taken = std::sync::Arc::clone(&slot);
    let take = move |slot: &std::sync::Mutex<Option<F>>| slot.lock().ok().and_then(|mut work| work.take());
    let run = move || {
        if let Some(work) = take(&taken) {
            work();
        }
    };
    match std::thread::Builder::new().name("apart".to_owned()).spawn(run) {
        Ok(_) => Ok(()),
        Err(_) => take(&slot).map_or(Ok(()), Err),
    }
}

/// Combines all items. `identity` starts each share of the work.
#[cfg(feature = "rayon")]
pub(crate) fn reduce<T: Send>(
    items: impl prelude::ParallelIterator<Item = T>,
    identity: impl Fn() -> T + Sync + Send,
    combine: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    items.reduce(identity, combine)
}

/// Combines all items, starting from `identity`.
#[cfg(not(feature = "rayon"))]
pub(crate) fn reduce<T>(items: impl Iterator<Item = T>, identity: impl Fn() -> T, combine: impl Fn(T, T) -> T) -> T {
    items.fold(identity(), combine)
}

/// Serial stand-ins for the parts of rayon that this crate uses.
#[cfg(not(feature = "rayon"))]
mod serial {
    use std::marker::PhantomData;

    /// Number of threads.
    #[cfg(test)]
    pub(crate) const fn current_num_threads() -> usize {
        1
    }

    /// Runs two closures, in order.
    pub(crate) fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
        (first(), second())
    }

    /// Scope whose tasks may spawn further tasks.
    pub(crate) struct Scope<'scope> {
        lifetime: PhantomData<&'scope ()>,
    }

    impl<'scope> Scope<'scope> {
        /// Runs a task at once.
        #[expect(clippy::unused_self, reason = "rayon's call has it")]
        pub(crate) fn spawn(&self, work: impl FnOnce(&Scope<'scope>) + 'scope) {
            work(&Scope { lifetime: PhantomData });
        }
    }

    /// Runs a closure and all tasks that it spawns.
    pub(crate) fn scope<'scope, T>(work: impl FnOnce(&Scope<'scope>) -> T) -> T {
        work(&Scope { lifetime: PhantomData })
    }

    /// Traits with rayon's method names.
    pub(crate) mod prelude {
        use std::slice::{Chunks, ChunksExact, ChunksExactMut, ChunksMut, Iter, IterMut};

        /// Types that can be iterated.
        pub(crate) trait IntoParallelIterator: IntoIterator + Sized {
            /// Iterates in order.
            fn into_par_iter(self) -> Self::IntoIter {
                self.into_iter()
            }
        }

        impl<I: IntoIterator> IntoParallelIterator for I {}

        /// Slices.
        pub(crate) trait ParallelSlice<T> {
            /// Iterates over references.
            fn par_iter(&self) -> Iter<'_, T>;
            /// Iterates over mutable references.
            fn par_iter_mut(&mut self) -> IterMut<'_, T>;
            /// Iterates over chunks.
            fn par_chunks(&self, size: usize) -> Chunks<'_, T>;
            /// Iterates over whole chunks.
            fn par_chunks_exact(&self, size: usize) -> ChunksExact<'_, T>;
            /// Iterates over mutable chunks.
            fn par_chunks_mut(&mut self, size: usize) -> ChunksMut<'_, T>;
            /// Iterates over whole mutable chunks.
            fn par_chunks_exact_mut(&mut self, size: usize) -> ChunksExactMut<'_, T>;
            /// Sorts.
            fn par_sort_unstable(&mut self)
            where
                T: Ord;
            /// Sorts by a comparison.
            fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> std::cmp::Ordering);
        }

        impl<T> ParallelSlice<T> for [T] {
            fn par_iter(&self) -> Iter<'_, T> {
                self.iter()
            }

            fn par_iter_mut(&mut self) -> IterMut<'_, T> {
                self.iter_mut()
            }

            fn par_chunks(&self, size: usize) -> Chunks<'_, T> {
                self.chunks(size)
            }

            fn par_chunks_exact(&self, size: usize) -> ChunksExact<'_, T> {
                self.chunks_exact(size)
            }

            fn par_chunks_mut(&mut self, size: usize) -> ChunksMut<'_, T> {
                self.chunks_mut(size)
            }

            fn par_chunks_exact_mut(&mut self, size: usize) -> ChunksExactMut<'_, T> {
                self.chunks_exact_mut(size)
            }

            fn par_sort_unstable(&mut self)
            where
                T: Ord,
            {
                self.sort_unstable();
            }

            fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> std::cmp::Ordering) {
                self.sort_unstable_by(compare);
            }
        }

        /// Lists that grow.
        pub(crate) trait ParallelExtend<T> {
            /// Appends all items.
            fn par_extend(&mut self, items: impl IntoIterator<Item = T>);
        }

        impl<T> ParallelExtend<T> for Vec<T> {
            fn par_extend(&mut self, items: impl IntoIterator<Item = T>) {
                self.extend(items);
            }
        }

        /// Adaptors that only rayon's iterators have.
        pub(crate) trait ParallelIterator: Iterator + Sized {
            /// Changes nothing.
            fn with_min_len(self, _: usize) -> Self {
                self
            }

            /// Changes nothing.
            fn with_max_len(self, _: usize) -> Self {
                self
            }

            /// Maps items to iterators and concatenates them.
            fn flat_map_iter<U: IntoIterator, F: FnMut(Self::Item) -> U>(
                self,
                map: F,
            ) -> std::iter::FlatMap<Self, U, F> {
                self.flat_map(map)
            }

            /// Maps with a state that is made once.
            fn map_init<S, U>(
                self,
                init: impl FnOnce() -> S,
                map: impl Fn(&mut S, Self::Item) -> U,
            ) -> impl Iterator<Item = U> {
                let mut state = init();
                self.map(move |item| map(&mut state, item))
            }

            /// Index of the first item that a test accepts.
            fn position_first(mut self, test: impl Fn(Self::Item) -> bool) -> Option<usize> {
                self.position(test)
            }

            /// Collects into a list.
            fn collect_into_vec(self, list: &mut Vec<Self::Item>) {
                list.clear();
                list.extend(self);
            }
        }

        impl<I: Iterator> ParallelIterator for I {}

        /// Iterators of known length. Any iterator is one here.
        pub(crate) trait IndexedParallelIterator: Iterator {}

        impl<I: Iterator> IndexedParallelIterator for I {}
    }
}
