//! Intervals against the truth: parameters, and how far the gap was closed.

use std::collections::BTreeMap;

use super::judge::Judged;
use super::rate::Rate;

/// Two-sided 95 % of the normal distribution, in standard deviations.
const SIGMAS: f64 = 1.96;

/// Parameters whose 95 % interval holds the truth, of effects that are named as what they are: all, and by effect.
pub(super) fn coverage(all: &[&Judged]) -> (Rate, Vec<(String, Rate)>) {
    let mut by_effect: BTreeMap<String, Rate> = BTreeMap::new();
    for one in all {
        let Some(report) = &one.report else { continue };
        for effect in &one.answer.effects {
            let Some(found) = report.effects.iter().find(|found| found.name == effect.name) else { continue };
            // phases turn round, and sizes beyond the table have no counterpart
            let pairs = effect.parameters.iter().zip(&found.parameters).filter(|(truth, _)| truth.name != "phase");
            for (truth, said) in pairs {
                if let Some(std) = said.std {
                    by_effect
                        .entry(effect.name.clone())
                        .or_default()
                        .add((said.value - truth.value).abs() <= SIGMAS * std);
                }
            }
        }
    }
    let mut total = Rate::default();
    for rate in by_effect.values() {
        total.hits += rate.hits;
        total.of += rate.of;
    }
    (total, by_effect.into_iter().collect())
}

/// Shrink intervals that hold what the true model closes, and the shares of the closable gap that were closed.
pub(super) fn shrink(all: &[&Judged]) -> (Rate, Vec<f64>) {
    let (mut held, mut closed) = (Rate::default(), Vec::new());
    for one in all {
        let Some(shrink) = one.report.as_ref().and_then(|report| report.shrink.as_ref()) else { continue };
        for said in &shrink.signals {
            let Some(truth) = one.answer.signals.iter().find(|truth| truth.name == said.name) else { continue };
            let (Some(before), Some(after)) = (said.before, said.after) else { continue };
            let closable = before * before - truth.best * truth.best;
            // a gap below a tenth of the floor's power cannot be measured
            if closable > 0.1 * truth.best * truth.best {
                closed.push((before * before - after * after) / closable);
            }
            if let (true, Some([low, high]), Some(floor)) = (one.exact, said.ci95_percent, said.noise_floor) {
                let span = before * before - floor * floor;
                if span > 0.0 {
                    let best = 100.0 * (before * before - truth.best * truth.best) / span;
                    held.add((low..=high).contains(&best));
                }
            }
        }
    }
    closed.sort_by(f64::total_cmp);
    (held, closed)
}
