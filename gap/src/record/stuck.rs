//! A channel that stops moving, though it moves elsewhere.

/// Shortest stretch of one value that counts as stuck [s].
const LONGEST_STILL_S: f64 = 0.4;

/// What is wrong, in words; a channel that never moves is not stuck but constant.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub(super) fn told(name: &str, values: &[f64], period_s: f64) -> Option<String> {
    let least = (LONGEST_STILL_S / period_s) as usize;
    let (mut start, mut longest) = (0, (0, 0));
    let mut moves = 0;
    for k in 1..values.len() {
        #[allow(clippy::float_cmp, reason = "the same bits are meant")]
        let still = values[k] == values[k - 1];
        if !still {
            moves += 1;
            start = k;
        }
        if k - start > longest.1 - longest.0 {
            longest = (start, k);
        }
    }
    // a coarse sensor stands still between its steps; one that moves at nearly every row and then stands is stuck
    let usual = moves * 2 > values.len() - (longest.1 - longest.0);
    (usual && longest.1 - longest.0 > least).then(|| {
        format!(
            "{name} is stuck at {} from {:.2} s to {:.2} s after the start",
            values[longest.0],
            longest.0 as f64 * period_s,
            longest.1 as f64 * period_s
        )
    })
}
