//! Approximate minimum degree (Amestoy, Davis and Duff 1996, through faer), and stopping it.

use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread::Builder;
use std::time::Duration;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::amd;

use super::LinalgError;
use super::order::{Order, Pattern, go_on_unless};

/// Patterns of so many unknowns take AMD some hundredths of a second.
const WORTH_LEAVING: usize = 50_000;

/// How often the wish to stop is looked at meanwhile.
const LOOKS: Duration = Duration::from_millis(5);

/// AMD cannot be stopped. For large patterns it runs on a thread of its own, which a caller who gives up leaves behind:
/// it ends by itself, in half a second at a million faces.
pub(super) fn minimum_degree(pattern: &Pattern, cancel: &AtomicBool) -> Result<Order, LinalgError> {
    if pattern.order() < WORTH_LEAVING {
        return minimum_degree_to_the_end(pattern);
    }
    let (send, receive) = sync_channel(1);
    let own = pattern.clone();
    let found = || minimum_degree_to_the_end(pattern);
    let started = Builder::new().name("order".to_owned()).spawn(move || send.send(minimum_degree_to_the_end(&own)));
    if started.is_err() {
        return found();
    }
    loop {
        go_on_unless(cancel)?;
        match receive.recv_timeout(LOOKS) {
            Ok(order) => return order,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return found(),
        }
    }
}

/// The same, whatever the caller wishes meanwhile.
pub(super) fn minimum_degree_to_the_end(pattern: &Pattern) -> Result<Order, LinalgError> {
    let n = pattern.order();
    let too_large = LinalgError::TooLarge { order: n };
    let scratch = amd::order_scratch::<u32>(n, pattern.rows.len());
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large.clone())?;
    let (mut new_to_old, mut old_to_new) = (vec![0; n], vec![0; n]);
    let control = amd::Control::default();
    amd::order(&mut new_to_old, &mut old_to_new, pattern.as_faer(), control, MemStack::new(&mut memory))
        .map_err(|_| too_large)?;
    Ok(Order { new_to_old, old_to_new })
}
