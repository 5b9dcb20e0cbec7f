//! Runs under equal inputs: what they have differently is each run's own.

use crate::diagnose::Diagnosis;

/// Inputs are equal when their difference is this share of their change.
const EQUAL: f64 = 0.05;

/// Two runs under equal inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeat {
    /// Both logs.
    pub logs: [usize; 2],
    /// Signal, unit, rms of what is one run's own.
    pub floors: Vec<(&'static str, &'static str, f64)>,
}

/// All such pairs.
pub(super) fn repeats(logs: &[usize], diagnoses: &[Diagnosis]) -> Vec<Repeat> {
    pairs(logs).filter_map(|(a, b)| repeat(a, b, diagnoses)).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

fn pairs(logs: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    logs.iter().enumerate().flat_map(move |(place, &a)| logs[place + 1..].iter().map(move |&b| (a, b)))
}

/// What two runs under equal inputs have differently.
fn repeat(a: usize, b: usize, diagnoses: &[Diagnosis]) -> Option<Repeat> {
    let (one, other) = (&diagnoses[a].record, &diagnoses[b].record);
    let rows = one.rows();
    if rows != other.rows() {
        return None;
    }
    let equal = |x: &[f64], y: &[f64]| {
        let level = mean(x.iter().copied());
        let change = mean(x.iter().map(|value| (value - level).powi(2)));
        let off = mean(x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).collect::<Vec<_>>().into_iter());
        off <= EQUAL * EQUAL * change.max(1e-12)
    };
    let same = equal(&one.inputs.rate_radps, &other.inputs.rate_radps)
        && (0..2).all(|axis| equal(&one.inputs.accel_mps2[axis], &other.inputs.accel_mps2[axis]));
    if !same {
        return None;
    }
    let floors = one.channels.iter().filter_map(|channel| {
        let twin = other.channel(channel.signal)?;
        let valid = (0..rows).filter(|&k| channel.valid[k] && twin.valid[k]);
        let half: Vec<f64> = valid.map(|k| 0.5 * (channel.values[k] - twin.values[k])).collect();
        let column = channel.signal.column();
        let rms = (2.0 * mean(half.iter().map(|value| value * value))).sqrt();
        Some((column.name(), column.unit(), rms))
    });
    Some(Repeat { logs: [a, b], floors: floors.collect() })
}
