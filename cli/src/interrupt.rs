//! Ctrl-C as a flag that long work looks at; a second one ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Failure;

static RAISED: AtomicBool = AtomicBool::new(false);

/// Takes over Ctrl-C. Where that cannot be done, Ctrl-C ends the program as it always did.
pub(crate) fn watch() {
    let _ = ctrlc::set_handler(|| {
        if RAISED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// Whether Ctrl-C was pressed.
pub(crate) fn raised() -> bool {
    RAISED.load(Ordering::Relaxed)
}

/// Ends work that was interrupted.
pub(crate) fn check() -> Result<(), Failure> {
    if raised() { Err(Failure::Interrupted) } else { Ok(()) }
}
