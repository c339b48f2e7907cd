//! Display of a file's folder in the system's file manager.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{Background, MessagePlace, Messages, Wake};

/// Program that shows a folder.
const PROGRAM: &str = if cfg!(target_os = "windows") {
    "explorer"
} else if cfg!(target_os = "macos") {
    "open"
} else {
    "xdg-open"
};

/// Shows a folder in a program. Returns the reason of a failure.
fn show(program: &str, folder: &Path) -> Result<(), String> {
    let mut command = Command::new(program);
    command.arg(folder).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let status = command.status().map_err(|error| format!("{program}: {error}"))?;
    // The file manager of Windows returns an error code even on success.
    if status.success() || cfg!(target_os = "windows") { Ok(()) } else { Err(format!("{program} failed: {status}")) }
}

/// Background job that shows the folder of a file.
pub(super) struct FolderViewer {
    shown: Background<PathBuf, Result<(), String>>,
}

impl FolderViewer {
    pub(super) fn new(wake: &Wake) -> Self {
        Self { shown: Background::new("folder", wake) }
    }

    /// Shows the folder of a file, in the background because the program may be slow.
    pub(super) fn show(&mut self, file: PathBuf) {
        let folder = std::path::absolute(&file).ok().and_then(|file| file.parent().map(PathBuf::from));
        let folder = folder.unwrap_or_else(|| PathBuf::from("."));
        self.shown.start(file, move |_| show(PROGRAM, &folder));
    }

    /// Reports a folder that could not be shown.
    pub(super) fn poll(&mut self, messages: &mut Messages) {
        match self.shown.poll() {
            Some((file, Ok(Err(reason)))) => {
                let text = format!("the folder of {} cannot be shown: {reason}", file.display());
                messages.fail(MessagePlace::Embedding, text, Some("open it manually"));
            }
            Some((_, Err(failure))) => {
                messages.fail_background(MessagePlace::Embedding, "showing the folder", &failure);
            }
            Some((_, Ok(Ok(())))) | None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let reason = show("no-program-of-this-name", Path::new(".")).expect_err("nothing is called so");
        assert!(reason.starts_with("no-program-of-this-name: "), "{reason}");
    }

    #[test]
    #[cfg(unix)]
    fn a_program_that_fails_is_a_failure_and_one_that_does_not_is_none() {
        let reason = show("false", Path::new(".")).expect_err("it fails");
        freebound_testkit::assert_message("folder-program-failed", &reason);
        assert_eq!(show("true", Path::new(".")), Ok(()));
    }
}
