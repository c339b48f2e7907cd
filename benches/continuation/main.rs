//! How the ladder meets constraints: `cargo bench --bench continuation`.
//!
//! Words behind `--` choose the parts: `corpus` (the constrained problems of `../shared/corpus`), `synthetic` (bumpy caps
//! with displaced, swirled, stretched and permuted pins), `size` (time and memory by the number of faces); all of them
//! without any. `quick` takes few and small cases.
//!
//! A run that takes longer than two minutes is stopped and says so; one that fails is a row like any other.

#[path = "../common/mod.rs"]
mod common;

mod corpus;
mod outcome;
mod size;
mod synthetic;

use common::arguments;
use common::machine::print_machine;

fn main() {
    print_machine();
    let arguments = arguments();
    let is_quick = arguments.iter().any(|word| word == "quick");
    let chosen: Vec<&str> = arguments.iter().map(String::as_str).filter(|&word| word != "quick").collect();
    for (name, run) in [("corpus", corpus::run as fn(bool)), ("synthetic", synthetic::run), ("size", size::run)] {
        if chosen.is_empty() || chosen.contains(&name) {
            run(is_quick);
        }
    }
}
