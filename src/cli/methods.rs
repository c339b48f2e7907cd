//! `freebound methods`: what there is, with the paper's section or the source of each.

use super::Status;
use crate::solver::{FAMILIES, METHODS};

pub(super) fn run() -> Status {
    println!("Methods (--method)");
    for entry in METHODS {
        println!("  {:<17} {:<62} {}", entry.name, entry.about, entry.source);
    }
    println!("\nFamilies of weights (--family)");
    for entry in FAMILIES {
        println!("  {:<17} {:<62} {}", entry.name, entry.about, entry.source);
    }
    Status::Fine
}
