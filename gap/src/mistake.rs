//! A sign that looks wrong may be an effect that imitates it: a large asymmetry, an unbalance on the other side. Both are
//! fitted by the whole library, the log as it is and the log with the mistake undone.
//!
//! ```text
//! L = sum over the channels of ln(rms of what the closest fit leaves)        a mistake: L_undone < L_as_it_is
//! ```

use gimbal_model_file::ModelFile;

use crate::judge::{Verdict, decide};
use crate::record::Record;
use crate::settle::{Settled, settled};

/// What counts as no more where nothing is wrong with the undone log, and as less where something is, in logarithms of an rms
/// a channel: what is slow may hide in the noise of a log that an effect has changed by thousands of times the noise.
const NO_MORE: f64 = 0.1;
const LESS: f64 = 0.25;

/// Whether the mistake explains a log better than the library does: nothing is wrong with the undone log and it leaves no
/// more, or it leaves less.
pub(crate) fn mistaken(as_it_is: &Settled, mut undone: Record, model: &ModelFile) -> bool {
    undone.quieten(&crate::library::platform(model));
    let mended = settled(&undone, model);
    let nothing_wrong = decide(&mended.problem, &mended.search, &model.tolerance).verdict == Verdict::NoGap;
    let margin = if nothing_wrong { NO_MORE } else { -LESS };
    left(&mended) < left(as_it_is) + margin * undone.channels.len() as f64
}

/// What the closest fit leaves.
fn left(Settled { problem, search, .. }: &Settled) -> f64 {
    let record = problem.record;
    let rms = |(residual, valid): (Vec<f64>, &Vec<bool>)| {
        let kept = || residual.iter().zip(valid).filter(|(_, valid)| **valid).map(|(value, _)| value * value);
        (kept().sum::<f64>() / kept().count().max(1) as f64).sqrt()
    };
    let residuals = problem.residual(&search.closest().prediction);
    let masks = record.channels.iter().map(|channel| &channel.valid);
    residuals.into_iter().zip(masks).map(rms).map(|rms| rms.max(f64::MIN_POSITIVE).ln()).sum()
}
