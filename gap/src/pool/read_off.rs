//! What the samples of a log show by themselves, without a fit: a stop elsewhere, steps of the pick-off. A log that shows
//! one is enough; what several show is averaged by their errors.

use gimbal_plant::Effect;

use super::values::{Shared, chance};
use crate::diagnose::Diagnosis;
use crate::judge::READ_OFF;

/// Scatter less probable than this is drift.
const BY_CHANCE: f64 = 0.01;

/// Each that a log shows.
pub(super) fn read_off(diagnoses: &[Diagnosis], logs: &[usize]) -> Vec<Shared> {
    READ_OFF.iter().filter_map(|name| one(diagnoses, logs, Effect::from_name(name)?)).collect()
}

fn one(diagnoses: &[Diagnosis], logs: &[usize], effect: Effect) -> Option<Shared> {
    let found = |log: &usize| {
        let found = diagnoses[*log].decision.iter().flat_map(|own| &own.found);
        let own = found.into_iter().find(|own| own.effect == effect.name())?;
        Some((*log, own.values[0], own.errors[0])).filter(|(.., error)| *error > 0.0)
    };
    let values: Vec<(usize, f64, f64)> = logs.iter().filter_map(found).collect();
    if values.is_empty() {
        return None;
    }
    let weights: f64 = values.iter().map(|(.., error)| error.powi(-2)).sum();
    let mean = values.iter().map(|(_, value, error)| value * error.powi(-2)).sum::<f64>() / weights;
    let chi2 = values.iter().map(|(_, value, error)| ((value - mean) / error).powi(2)).sum();
    let by_chance = chance(chi2, values.len() - 1);
    let parameter = effect.parameters()[0];
    Some(Shared {
        effect: effect.name(),
        parameter: parameter.name,
        unit: parameter.unit,
        values,
        mean: [mean, weights.powf(-0.5)],
        chi2,
        by_chance,
        shared_nats: None,
        drifts: by_chance < BY_CHANCE,
    })
}
