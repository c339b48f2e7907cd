//! Slots for work on background threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::Duration;

use freebound::session::{Background, JobFailure, Wake};

/// Slot, and the receiver of its wakes.
fn slot<K, T>() -> (Background<K, T>, Receiver<()>) {
    let (sender, woken) = sync_channel(8);
    (Background::new("test", &(Arc::new(move || sender.send(()).unwrap()) as Wake)), woken)
}

fn until_cancelled(cancel: &AtomicBool) -> u8 {
    while !cancel.load(Ordering::Relaxed) {
        thread::sleep(Duration::from_micros(50));
    }
    7
}

#[test]
fn interrupted_work_hands_its_outcome_out_once() {
    let (mut slot, woken) = slot();
    slot.start("count", until_cancelled);
    assert!(slot.poll().is_none() && slot.key() == Some(&"count"));
    slot.interrupt();
    woken.recv().unwrap();
    assert_eq!(slot.poll(), Some(("count", Ok(7))));
    assert!(slot.poll().is_none() && !slot.is_busy());
}

#[test]
fn work_is_replaced_by_what_starts_after_it() {
    let (mut slot, woken) = slot();
    slot.start(1, until_cancelled);
    slot.start(2, |_| 8);
    for _ in 0..2 {
        woken.recv().unwrap();
    }
    assert_eq!(slot.poll(), Some((2, Ok(8))));
    assert!(slot.poll().is_none());
}

#[test]
fn work_that_is_added_runs_beside_the_other() {
    let (mut slot, woken) = slot();
    slot.add(1, until_cancelled);
    slot.add(2, |_| 8);
    woken.recv().unwrap();
    assert_eq!(slot.poll(), Some((2, Ok(8))));
    assert_eq!(slot.keys().collect::<Vec<_>>(), [&1]);
}

#[test]
fn a_panic_is_told_once() {
    let (mut slot, _woken) = slot::<(), ()>();
    slot.start((), |_| panic!("on purpose"));
    let found = loop {
        if let Some(found) = slot.poll() {
            break found;
        }
        thread::yield_now();
    };
    assert_eq!(found, ((), Err(JobFailure::Lost)));
    assert!(!slot.is_busy());
}
