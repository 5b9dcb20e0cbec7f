//! Whether the loop sees the steps of its pick-off, or the log alone has them: what the servo makes of a step of q is in
//! the motor torque.
//!
//! ```text
//! e = theta on the grid - prediction        x = F e        T_m - prediction = share x + noise
//! ```
//!
//! beyond `LEAST_HZ`, where the loop is open, and at rows about which theta moves less than half a step: elsewhere the loop saw
//! what is between the rows. The share is that of what the loop sees in the power of e, of which the steps make
//!
//! ```text
//! steps = (q^2 / 12) / mean(e^2)
//! ```
//!
//! A pick-off that steps has a share of one, or of `steps` where the rest of e is noise that the loop does not see; a converter
//! behind the loop has none, or all but `steps` where that rest is the loop's own noise.

use realfft::num_complex::Complex;

use super::grid::on_grid;
use crate::fit::{Fit, Plans, Problem, servo_answer};
use crate::record::Signal;

/// Where the loop is open [Hz], and the share of the sampling rate from which on what is left is looked at.
const LEAST_HZ: f64 = 60.0;
const LEAST_SHARE: f64 = 0.125;
/// Share of a step by which theta may move from row to row.
const SLOW: f64 = 0.5;
/// Fewest rows.
const LEAST_ROWS: usize = 60;
/// Standard errors by which a share must be nearer to those of a pick-off than to those of a converter behind it, or less near.
const SURE: f64 = 4.0;
/// Standard errors by which steps that the noise hides must be seen, and how far off their power the share may be.
const SURE_HIDDEN: f64 = 3.5;
const POWER: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// What the loop sees of e, its standard error, and what the steps make of e.
struct Share {
    seen: f64,
    error: f64,
    steps: f64,
}

/// Whether the loop sees steps of this size; none where this log does not tell.
pub(super) fn loop_sees(problem: &Problem, fit: &Fit, step_rad: f64) -> Option<bool> {
    let Share { seen, error, steps } = share(problem, fit, step_rad)?;
    let off = |shares: [f64; 2]| shares.map(|own| (seen - own).abs()).into_iter().fold(f64::INFINITY, f64::min);
    let nearer = off([0.0, 1.0 - steps]) - off([1.0, steps]);
    (nearer.abs() > SURE * error).then_some(nearer > 0.0)
}

/// Whether the loop sees steps that are no larger than noise which it does not see.
pub(super) fn loop_sees_hidden(problem: &Problem, fit: &Fit, step_rad: f64) -> bool {
    let power = (step_rad / problem.noise[0]).powi(2) / 12.0;
    share(problem, fit, step_rad)
        .is_some_and(|Share { seen, error, .. }| seen > SURE_HIDDEN * error && POWER.contains(&(seen / power)))
}

/// What is in the motor torque of steps of this size; none where too few rows tell.
fn share(problem: &Problem, fit: &Fit, step_rad: f64) -> Option<Share> {
    let theta = problem.record.channel(Signal::GyroAngle)?;
    let torque = problem.record.channel(Signal::MotorTorque)?;
    let period_s = problem.record.inputs.period_s;
    let predicted = &fit.prediction.gyro_angle_rad;
    let rows = predicted.len();
    let on_grid = on_grid(&theta.values, &theta.valid, step_rad);
    let moves = |k: usize| (predicted[k] - predicted[k - 1]).abs() > SLOW * step_rad;
    let told = |k: usize| k > 0 && theta.valid[k] && torque.valid[k] && !moves(k) && (k + 1 == rows || !moves(k + 1));
    let slow: Vec<usize> = (0..rows).filter(|&k| told(k)).collect();
    if slow.len() < LEAST_ROWS {
        return None;
    }
    let left = |valid: bool, of: f64| if valid { of } else { 0.0 };
    let errors: Vec<f64> = (0..rows).map(|k| left(theta.valid[k], on_grid[k] - predicted[k])).collect();
    let torques: Vec<f64> =
        (0..rows).map(|k| left(torque.valid[k], torque.values[k] - fit.prediction.motor_torque_nm[k])).collect();
    let least_hz = LEAST_HZ.max(LEAST_SHARE / period_s);
    let fast = |hz: f64| Complex::from(if hz < least_hz { 0.0 } else { 1.0 });
    // twice the length, so that nothing comes round
    let plans = Plans::new(2 * rows);
    let errors = filtered(&errors, &plans, period_s, fast);
    let torques = filtered(&torques, &plans, period_s, fast);
    let mut about = vec![0.0; rows];
    for &k in &slow {
        about[k] = errors[k];
    }
    let answer = |hz: f64| fast(hz) * servo_answer(&fit.physics, hz.max(least_hz), period_s);
    let answers = filtered(&about, &plans, period_s, answer);
    let with: f64 = slow.iter().map(|&k| answers[k] * torques[k]).sum();
    let square: f64 = slow.iter().map(|&k| answers[k] * answers[k]).sum();
    let seen = with / square;
    let rest: f64 = slow.iter().map(|&k| (torques[k] - seen * answers[k]).powi(2)).sum();
    let count = slow.len() as f64;
    let power = slow.iter().map(|&k| errors[k] * errors[k]).sum::<f64>() / count / (1.0 - 2.0 * least_hz * period_s);
    Some(Share { seen, error: (rest / count / square).sqrt(), steps: (step_rad * step_rad / 12.0 / power).min(1.0) })
}

/// A series through a filter.
fn filtered(series: &[f64], plans: &Plans, period_s: f64, filter: impl Fn(f64) -> Complex<f64>) -> Vec<f64> {
    let length = plans.length() as f64;
    let mut lines = plans.lines(series.iter().copied());
    for (line, value) in lines.iter_mut().enumerate() {
        *value *= filter(line as f64 / (length * period_s)) / length;
    }
    plans.series(&mut lines)
}
