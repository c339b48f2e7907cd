//! Parses any text as a constraint file.
#![no_main]

use freebound_io::Constraints;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(constraints) = Constraints::parse(text, 100) {
        assert!(constraints.targets.iter().all(|(vertex, target)| vertex.index() < 100 && target.uv.is_finite()));
    }
});
