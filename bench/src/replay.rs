//! A record runs again: the recorded bytes go down, and what comes up is compared byte for byte.

use crate::record::Record;
use crate::station::{Board, StationError};

/// What a replay has shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Replayed {
    /// Exchanges sent again.
    pub exchanges: u64,
    /// Bytes compared.
    pub bytes: u64,
    /// Tick and byte within its answer of the first difference.
    pub difference: Option<(u32, usize)>,
}

/// Sends a record's bytes to a board that has just been started.
///
/// # Errors
/// The link fails, or `stopped` says that the user has interrupted it.
pub fn replay(
    board: &mut Board,
    record: &Record,
    mut stopped: impl FnMut(u64) -> bool,
) -> Result<Replayed, StationError> {
    let mut replayed = Replayed { exchanges: 0, bytes: 0, difference: None };
    let mut entries = record.entries.iter().filter(|entry| matches!(entry.kind, b'D' | b'U')).peekable();
    while let Some(entry) = entries.next() {
        if entry.kind != b'D' {
            continue;
        }
        if stopped(replayed.exchanges) {
            return Err(StationError::Interrupted);
        }
        let mut expected = Vec::new();
        while let Some(answer) = entries.next_if(|entry| entry.kind == b'U') {
            expected.extend_from_slice(&answer.content);
        }
        let answer = board.exchange.replay(entry.tick, &entry.content, expected.len())?;
        replayed.exchanges += 1;
        replayed.bytes += expected.len() as u64;
        if answer != expected {
            let at = answer.iter().zip(&expected).position(|(a, b)| a != b).unwrap_or(answer.len().min(expected.len()));
            replayed.difference = Some((entry.tick, at));
            break;
        }
    }
    Ok(replayed)
}
