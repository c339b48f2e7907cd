//! `freebound methods`: what there is, with the paper's section or the source of each.

use super::Status;
use crate::solver::{CatalogueEntry, FAMILIES, METHODS};

pub(super) fn run() -> Status {
    print_list("Methods (--method)", METHODS);
    println!();
    print_list("Families of weights (--family)", FAMILIES);
    Status::Fine
}

/// Names on the left; beside each what it does, and below that where it comes from.
fn print_list(head: &str, entries: &[CatalogueEntry]) {
    println!("{head}");
    for entry in entries {
        println!("  {:<17} {}\n  {:<17} {}", entry.name, entry.about, "", entry.source);
    }
}
