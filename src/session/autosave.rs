//! Copies for recovery, made while a person works, and what is done with those of others.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::recovery::{Recoverable, Slot, left_behind};
use super::{Document, Job, Place, Poll, Session};
use crate::io::{PathStyle, RecoveryNote, WriteError};

/// Time from one copy to the next: what a crash may cost.
const INTERVAL: Duration = Duration::from_secs(5);

/// How long the end of a session waits for a copy that is being written. It is small: longer means that the disk hangs.
const PATIENCE: Duration = Duration::from_secs(2);

/// How long it waits for files that a person asked for, which may be large.
const LONG_PATIENCE: Duration = Duration::from_mins(1);

type CopyJob = Job<(), Result<(), WriteError>>;

/// The copy of this session's work.
#[derive(Debug, Default)]
pub(super) struct Autosave {
    /// Where copies are kept; none are made without it.
    folder: Option<PathBuf>,
    /// What dead sessions have left there.
    found: Vec<Recoverable>,
    slot: Option<Slot>,
    /// The copy that is being opened, to become the slot.
    claimed: Option<Slot>,
    /// The document in the slot.
    written: Option<Document>,
    under_way: Option<(Document, CopyJob)>,
    /// Slots that are given up, but still written to.
    leaving: Vec<(Slot, CopyJob)>,
    begun: Option<Instant>,
    has_failed: bool,
}

impl Autosave {
    /// Takes what a dead session has left. Nothing else is ever taken, so that nothing else is ever deleted.
    pub(super) fn claim(&mut self, path: &Path) -> bool {
        self.claimed = None;
        if self.found.iter().any(|found| found.path == path) {
            self.claimed = Slot::claim(path);
        }
        self.claimed.is_some()
    }

    /// What was claimed stays where it is: it could not be opened.
    pub(super) fn give_up_claim(&mut self) {
        self.claimed = None;
    }

    /// Something else is on the table: the copy of what was there is of no use, and `recovered` has one already.
    pub(super) fn begin_anew(&mut self, recovered: Option<&Document>) {
        self.leave_slot();
        self.slot = self.claimed.take().filter(|_| recovered.is_some());
        self.written = recovered.cloned();
        self.begun = None;
        if let Some(slot) = &self.slot {
            self.found.retain(|found| found.path != slot.path);
        }
    }

    /// Deletes the copy, or has it deleted once it is written.
    fn leave_slot(&mut self) {
        let job = self.under_way.take().map(|(_, job)| job);
        match (self.slot.take(), job) {
            (Some(slot), Some(job)) => self.leaving.push((slot, job)),
            (Some(slot), None) => slot.remove(),
            (None, _) => {}
        }
        self.written = None;
    }

    fn clear_left(&mut self) {
        for (slot, job) in std::mem::take(&mut self.leaving) {
            if matches!(job.poll(), Poll::Running) {
                self.leaving.push((slot, job));
            } else {
                slot.remove();
            }
        }
    }
}

impl Session {
    /// Makes copies for recovery in a folder from now on, and looks at what is there.
    pub fn keep_copies_in(&mut self, folder: PathBuf) {
        self.autosave.found = left_behind(&folder);
        self.autosave.folder = Some(folder);
    }

    /// Work that sessions before have left unsaved, newest first.
    pub fn recoverable(&self) -> &[Recoverable] {
        &self.autosave.found
    }

    /// Waits until all files are written that were asked for, or the disk hangs. For the end of the program, which
    /// would break them off.
    pub fn finish_writing(&mut self) {
        let begun = Instant::now();
        while (!self.saving.is_empty() || self.is_saving_project()) && begun.elapsed() < LONG_PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.poll_saving();
            self.poll_project_saves();
        }
    }

    /// Ends the session as a person wishes: what is not saved is not wanted. A session that is merely dropped leaves
    /// its copy behind.
    pub fn close(&mut self) {
        self.autosave.leave_slot();
        let begun = Instant::now();
        self.autosave.clear_left();
        while !self.autosave.leaving.is_empty() && begun.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.autosave.clear_left();
        }
        self.autosave.folder = None;
    }

    pub(super) fn discard_recovery(&mut self, path: &Path) {
        let is_found = self.autosave.found.iter().any(|found| found.path == path);
        self.autosave.found.retain(|found| found.path != path);
        if let Some(slot) = Slot::claim(path).filter(|_| is_found) {
            slot.remove();
        }
    }

    pub(super) fn poll_autosave(&mut self, now: Instant) {
        self.autosave.clear_left();
        self.take_copy();
        if !self.has_unsaved_work() {
            return self.autosave.leave_slot();
        }
        let is_due = self.autosave.begun.is_none_or(|begun| now.saturating_duration_since(begun) >= INTERVAL);
        let is_new = self.autosave.written.as_ref() != Some(&self.document);
        if is_due && is_new && self.autosave.under_way.is_none() {
            self.begin_copy(now);
        }
    }

    fn take_copy(&mut self) {
        let Some((document, job)) = self.autosave.under_way.take() else { return };
        match job.poll() {
            Poll::Running => self.autosave.under_way = Some((document, job)),
            Poll::Done(Ok(())) => self.autosave.written = Some(document),
            Poll::Done(Err(error)) => self.tell_no_copy(&error.to_string()),
            Poll::Lost => self.tell_no_copy("the copy stopped unexpectedly"),
        }
    }

    fn begin_copy(&mut self, now: Instant) {
        let (Some(folder), Some(mut project)) = (self.autosave.folder.clone(), self.project_file()) else { return };
        self.autosave.begun = Some(now);
        if self.autosave.slot.is_none() {
            match Slot::new(&folder) {
                Ok(slot) => self.autosave.slot = Some(slot),
                Err(error) => return self.tell_no_copy(&format!("{error}: {}", folder.display())),
            }
        }
        let Some(path) = self.autosave.slot.as_ref().map(|slot| slot.path.clone()) else { return };
        let project_path = self.project_path().map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone()));
        project.recovery = Some(RecoveryNote { name: self.project_name().unwrap_or_default(), project: project_path });
        let document = self.document.clone();
        match Job::spawn("copy", self.waker(), move |_| project.write(&path, PathStyle::Absolute)) {
            Ok(job) => self.autosave.under_way = Some((document, job)),
            Err(error) => self.tell_no_copy(&error.to_string()),
        }
    }

    /// Says once that there is no copy: it is no reason to disturb a person again and again.
    fn tell_no_copy(&mut self, reason: &str) {
        if !std::mem::replace(&mut self.autosave.has_failed, true) {
            let text = format!("no copy is kept for recovery: {reason}");
            self.fail(Place::Embedding, text, Some("save the project by hand"));
        }
    }
}
