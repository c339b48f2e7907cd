//! Orders of elimination: a shallow dissection of large patterns with approximate minimum degree in its parts, turned
//! into a postorder of the elimination tree.

use std::sync::atomic::AtomicBool;

use crate::parallel::prelude::*;

use super::LinalgError;
use super::degree::{minimum_degree, minimum_degree_to_the_end};
use super::dissection::Dissection;
use super::elimination::Elimination;
use super::pattern::{Order, Pattern, go_on_unless};

/// Orders a pattern by AMD and a postorder of the elimination tree.
pub(super) fn order(pattern: &Pattern, cancel: &AtomicBool) -> Result<Elimination, LinalgError> {
    let pairs = pattern.of_pairs();
    let degree = minimum_degree(pairs.as_ref().unwrap_or(pattern), cancel)?;
    Elimination::new(pattern, pairs, &degree, cancel)
}

/// Orders a pattern by AMD in the parts of a dissection, in parallel, if the pattern is large and has cheap cuts.
/// Otherwise orders it by AMD.
pub(super) fn dissected(pattern: &Pattern, cancel: &AtomicBool) -> Result<Elimination, LinalgError> {
    let pairs = pattern.of_pairs();
    let graph = pairs.as_ref().unwrap_or(pattern);
    go_on_unless(cancel)?;
    let Some(dissection) = Dissection::new(graph, cancel)? else {
        let degree = minimum_degree(graph, cancel)?;
        return Elimination::new(pattern, pairs, &degree, cancel);
    };
    let order_of = |part: usize| {
        go_on_unless(cancel)?;
        minimum_degree_to_the_end(&dissection.pattern_of(part, graph)).map(|order| order.new_to_old)
    };
    let of_parts: Result<Vec<Vec<u32>>, _> = (0..dissection.parts.len()).into_par_iter().map(order_of).collect();
    let order = Order::from_new_to_old(dissection.order(&of_parts?));
    Elimination::new(pattern, pairs, &order, cancel)
}

/// Uses a given order up to a postorder of its tree. Pairs of unknowns are ordered as pairs if they are neighbours in
/// it.
pub(super) fn in_order(pattern: &Pattern, given: &Order, cancel: &AtomicBool) -> Result<Elimination, LinalgError> {
    let has_pairs = given.new_to_old.chunks(2).all(|pair| pair.iter().all(|&old| old / 2 == pair[0] / 2));
    let pairs = if has_pairs { pattern.of_pairs() } else { None };
    if pairs.is_none() {
        return Elimination::new(pattern, None, given, cancel);
    }
    let of_pairs = given.new_to_old.iter().step_by(2).map(|&old| old / 2).collect();
    Elimination::new(pattern, pairs, &Order::from_new_to_old(of_pairs), cancel)
}
