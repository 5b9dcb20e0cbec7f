//! Under which conditions: the share of the contribution in each regime, with false discoveries controlled.

use crate::record::Record;
use crate::simulate::Prediction;

/// A regime and what falls into it.
#[derive(Debug, Clone, PartialEq)]
pub struct Regime {
    /// Name.
    pub name: &'static str,
    /// Share of the contribution.
    pub share: f64,
    /// Share of the time.
    pub time_share: f64,
}

/// False discoveries among the regimes that are told.
const FALSE_DISCOVERIES: f64 = 0.05;

/// Regimes that hold more of the contribution than of the time.
#[must_use]
pub fn regimes(record: &Record, prediction: &Prediction, contribution: &[f64], channels: usize) -> Vec<Regime> {
    type Test<'a> = Box<dyn Fn(usize) -> bool + 'a>;
    let rows = record.rows();
    let inputs = &record.inputs;
    let radial: Vec<f64> = inputs.accel_mps2[0].iter().zip(&inputs.accel_mps2[1]).map(|(x, y)| x.hypot(*y)).collect();
    let torque: Vec<f64> = prediction.motor_torque_nm.iter().map(|value| value.abs()).collect();
    let theta: Vec<f64> = prediction.gyro_angle_rad.iter().map(|value| value.abs()).collect();
    let w = inputs.slip_radps(prediction);
    let (load_high, load_low) = (quantile(&radial, 0.67), quantile(&radial, 0.33));
    let (torque_high, torque_low) = (quantile(&torque, 0.67), quantile(&torque, 0.33));
    let theta_high = quantile(&theta, 0.9);
    let slow = 0.02;
    let rel: Vec<f64> = inputs.turned_rad.iter().map(|value| value.abs()).collect();
    let rel_high = quantile(&rel, 0.67);
    let tests: [(&'static str, Test); 11] = [
        ("reversal of the rate", Box::new(|k| w[k].abs() < slow)),
        ("positive slip", Box::new(|k| w[k] >= slow)),
        ("negative slip", Box::new(|k| w[k] <= -slow)),
        ("high load", Box::new(|k| radial[k] > load_high)),
        ("low load", Box::new(|k| radial[k] < load_low)),
        ("high torque", Box::new(|k| torque[k] > torque_high)),
        ("torque near zero", Box::new(|k| torque[k] < torque_low)),
        ("large gyro angle", Box::new(|k| theta[k] > theta_high)),
        ("first third of the time", Box::new(|k| 3 * k < rows)),
        ("last third of the time", Box::new(|k| 3 * k > 2 * rows)),
        ("far turned", Box::new(|k| rel[k] > rel_high)),
    ];
    let power: Vec<f64> =
        contribution.chunks(channels.max(1)).map(|row| row.iter().map(|value| value * value).sum()).collect();
    // power by blocks of a quarter second, whose scatter says what is chance
    let block = rows / 240 + 1;
    let all: f64 = power.iter().sum::<f64>().max(1e-30);
    let mut cells: Vec<(Regime, f64)> = tests
        .into_iter()
        .map(|(name, test)| {
            let (mut inside, mut time, mut spread) = (0.0, 0.0, 0.0);
            let mut start = 0;
            let mean = all / rows as f64;
            while start < rows {
                let end = (start + block).min(rows);
                let mut excess = 0.0;
                for k in (start..end).filter(|&k| test(k)) {
                    inside += power[k];
                    time += 1.0;
                    excess += power[k] - mean;
                }
                spread += excess * excess;
                start = end;
            }
            let surplus = inside - mean * time;
            let z = surplus / spread.sqrt().max(1e-30);
            let p = 0.5 * libm::erfc(z / std::f64::consts::SQRT_2);
            (Regime { name, share: inside / all, time_share: time / rows as f64 }, p)
        })
        .collect();
    // Benjamini and Hochberg
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let count = cells.len() as f64;
    let kept = (0..cells.len()).rev().find(|&rank| cells[rank].1 <= FALSE_DISCOVERIES * (rank as f64 + 1.0) / count);
    cells.truncate(kept.map_or(0, |rank| rank + 1));
    cells.into_iter().map(|(regime, _)| regime).collect()
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place")]
    let place = ((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1));
    if sorted.is_empty() {
        return 0.0;
    }
    *sorted.select_nth_unstable_by(place, f64::total_cmp).1
}
