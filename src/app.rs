//! The window.
/// Opens the window.
///
/// # Errors
/// always
pub fn run(_: Option<std::path::PathBuf>) -> Result<(), String> {
    Err("no display".to_owned())
}
