//! Constrained flattening: `cargo bench --bench continuation`.
//!
//! Arguments after `--` select the parts. Default: all parts.
//!
//! - `corpus`: constrained problems of `../shared/corpus`
//! - `synthetic`: bumpy caps with displaced, swirled, stretched and permuted pins
//! - `size`: time and memory by the number of faces
//! - `relax`: relaxation from the conformal map, without constraints
//! - `matchmaker`: new vertices if pins block each other
//! - `seams`: disks with long seams, without constraints
//! - `held`: whole boundaries pinned
//!
//! `quick` selects few and small cases; `steps` prints every step.
//!
//! A run that takes longer than three minutes is cancelled, and its row reports that. A run that fails gets a row
//! too.

#[path = "../common/mod.rs"]
mod common;

mod corpus;
mod matchmaker;
mod outcome;
mod relax;
mod seams;
mod size;
mod synthetic;

use std::sync::atomic::Ordering;

use common::arguments;
use common::machine::print_machine;
use outcome::SHOWS_STEPS;

/// Part of the benchmark; true selects few and small cases.
type Part = fn(bool);

fn main() {
    print_machine();
    let arguments = arguments();
    let is_quick = arguments.iter().any(|word| word == "quick");
    SHOWS_STEPS.store(arguments.iter().any(|word| word == "steps"), Ordering::Relaxed);
    let words = arguments.iter().map(String::as_str);
    let chosen: Vec<&str> = words.filter(|word| !["quick", "steps"].contains(word)).collect();
    let parts: [(&str, Part); 7] = [
        ("corpus", corpus::run),
        ("synthetic", synthetic::run),
        ("size", size::run),
        ("relax", relax::run),
        ("matchmaker", matchmaker::run),
        ("seams", seams::run_free),
        ("held", seams::run_held),
    ];
    for (name, run) in parts {
        if chosen.is_empty() || chosen.contains(&name) {
            run(is_quick);
        }
    }
}
