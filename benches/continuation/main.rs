//! Constraints as the flattener meets them: `cargo bench --bench continuation`.
//!
//! Words behind `--` choose the parts: `corpus` (the constrained problems of `../shared/corpus`), `synthetic` (bumpy caps
//! with displaced, swirled, stretched and permuted pins), `size` (time and memory by the number of faces), `relax` (from
//! the conformal map, without constraints), `matchmaker` (new vertices where pins are in each other's way), `seams` (disks
//! with long seams, without constraints), `held` (whole boundaries held); all of them without any. `quick` takes few and
//! small cases; `steps` shows every step.
//!
//! A run that takes longer than three minutes is stopped and says so; one that fails is a row like any other.

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

/// A part of the benchmark, which may take few and small cases.
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
