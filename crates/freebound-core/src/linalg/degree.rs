//! Approximate minimum degree (Amestoy, Davis and Duff 1996, through faer), with cancellation.

use std::sync::atomic::AtomicBool;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::amd;

use super::LinalgError;
use super::detached::run_apart;
use super::pattern::{Order, Pattern};

/// Number of unknowns from which AMD runs on detached threads. At this size it takes some hundredths of a second.
const WORTH_LEAVING: usize = 50_000;

/// Orders a pattern by AMD, which cannot be stopped. For large patterns AMD runs on detached threads, and a cancelled
/// caller leaves it behind. It ends by itself, in half a second at a million faces.
pub(super) fn minimum_degree(pattern: &Pattern, cancel: &AtomicBool) -> Result<Order, LinalgError> {
    if pattern.order() < WORTH_LEAVING {
        return minimum_degree_to_the_end(pattern);
    }
    let own = pattern.clone();
    run_apart(move || minimum_degree_to_the_end(&own), cancel)?
}

/// Orders a pattern by AMD without cancellation.
pub(super) fn minimum_degree_to_the_end(pattern: &Pattern) -> Result<Order, LinalgError> {
    let n = pattern.order();
    let too_large = LinalgError::TooLarge { order: n };
    let scratch = amd::order_scratch::<u32>(n, pattern.rows.len());
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large.clone())?;
    let (mut new_to_old, mut old_to_new) = (vec![0; n], vec![0; n]);
    let control = amd::Control::default();
    amd::order(&mut new_to_old, &mut old_to_new, pattern.as_faer(), control, MemStack::new(&mut memory))
        .map_err(|_| too_large)?;
    Ok(Order { new_to_old, old_to_new })
}

#[cfg(test)]
mod tests {
    use nalgebra_sparse::pattern::SparsityPattern;

    use super::*;

    /// Chain of unknowns, long enough that AMD runs on a detached thread.
    fn long_chain() -> Pattern {
        let n = WORTH_LEAVING;
        let lanes: Vec<Vec<usize>> = (0..n).map(|k| (k.saturating_sub(1)..(k + 2).min(n)).collect()).collect();
        let ends = lanes.iter().scan(0, |end, lane| {
            *end += lane.len();
            Some(*end)
        });
        let offsets = std::iter::once(0).chain(ends).collect();
        let pattern = SparsityPattern::try_from_offsets_and_indices(n, n, offsets, lanes.concat()).expect("a band");
        Pattern::checked(&pattern, &AtomicBool::new(false)).expect("symmetric")
    }

    #[test]
    fn on_a_thread_of_its_own_the_order_is_the_same_and_a_raised_flag_stops_it() {
        let chain = long_chain();
        let order = minimum_degree(&chain, &AtomicBool::new(false)).expect("small enough");
        assert_eq!(order.new_to_old, minimum_degree_to_the_end(&chain).expect("small enough").new_to_old);
        let stopped = minimum_degree(&chain, &AtomicBool::new(true));
        assert_eq!(stopped.expect_err("cancelled"), LinalgError::Cancelled);
    }
}
