//! Snapshot of all messages: the only place where tests compare English.

use std::path::Path;

/// Patterns of what differs between runs and machines, and their replacements.
const FILTERS: [(&str, &str); 3] = [
    (r"\d+(\.\d+)? (µs|ms|s|min|h)\b", "TIME"),
    (r"\d+(\.\d+)? (seconds?|minutes?)\b", "TIME"),
    (r"(/[\w.-]+)*/\.tmp\w+", "FOLDER"),
];

/// Asserts that a message is the one in the snapshot `tests/data/messages/NAME.snap`. If a message was changed on
/// purpose, `INSTA_UPDATE=always cargo test` writes the snapshots anew.
///
/// # Panics
///
/// If the message differs or has no snapshot.
pub fn assert_message(name: &str, message: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/messages");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for (pattern, replacement) in FILTERS {
        settings.add_filter(pattern, replacement);
    }
    settings.bind(|| insta::assert_snapshot!(name, message.trim_end()));
}
