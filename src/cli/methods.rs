//! `freebound methods`: what there is, with the paper's section or the source of each.

use super::Status;
use crate::solver::{Choice, Family, Method};

pub(super) fn run() -> Status {
    println!("Methods (--method)");
    print_list::<Method>();
    println!("\nFamilies of weights (--family)");
    print_list::<Family>();
    Status::Fine
}

/// Names on the left; beside each what it does, and below that where it comes from.
fn print_list<C: Choice>() {
    for words in C::ALL.iter().map(|choice| choice.words()) {
        println!("  {:<17} {}\n  {:<17} {}", words.name, words.about, "", words.source);
    }
}
