//! The friction curve as the log has it: the fitted friction and what the motor torque has beside the prediction, in
//! bins of the bearing's rate, with two standard errors to either side.

use crate::fit::{Fit, Problem};
use crate::record::Signal;
use crate::simulate::Prediction;

/// Bins of equal count.
const BINS: usize = 28;
/// Rows whose mean counts as one sample, far beyond the loop's memory.
const TOGETHER: usize = 100;

/// One bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Mean rate of the bearing [rad/s].
    pub rate_radps: f64,
    /// Friction of the nominal model [N m].
    pub nominal_nm: f64,
    /// Friction as fitted [N m].
    pub fitted_nm: f64,
    /// Friction as the log has it [N m].
    pub measured_nm: f64,
    /// Its standard error [N m].
    pub error_nm: f64,
}

/// The curve; empty without a measured torque.
#[must_use]
pub fn curve(problem: &Problem, fit: &Fit, nominal: &Prediction) -> Vec<CurvePoint> {
    let record = problem.record;
    let Some(place) = record.channels.iter().position(|channel| channel.signal == Signal::MotorTorque) else {
        return Vec::new();
    };
    let residual = &problem.residual(&fit.prediction)[place];
    let valid = &record.channels[place].valid;
    let rate = record.inputs.slip_radps(&fit.prediction);
    let mut order: Vec<usize> = (0..record.rows()).filter(|&k| valid[k]).collect();
    order.sort_by(|a, b| rate[*a].total_cmp(&rate[*b]));
    let count = order.len() / BINS;
    if count < 2 * TOGETHER {
        return Vec::new();
    }
    order
        .chunks_exact(count)
        .map(|rows| point(rows, &rate, residual, [&nominal.friction_nm, &fit.prediction.friction_nm]))
        .collect()
}

fn point(rows: &[usize], rate: &[f64], residual: &[f64], friction: [&[f64]; 2]) -> CurvePoint {
    let mean = |values: &[f64]| rows.iter().map(|&k| values[k]).sum::<f64>() / rows.len() as f64;
    let [nominal_nm, fitted_nm] = friction.map(mean);
    let off = mean(residual);
    // samples near in time are one
    let mut in_time = rows.to_vec();
    in_time.sort_unstable();
    let means: Vec<f64> = in_time
        .chunks(TOGETHER)
        .map(|rows| rows.iter().map(|&k| residual[k]).sum::<f64>() / rows.len() as f64)
        .collect();
    let scatter: f64 = means.iter().map(|mean| (mean - off).powi(2)).sum();
    let n = means.len() as f64;
    let error_nm = (scatter / (n * (n - 1.0).max(1.0))).sqrt();
    CurvePoint { rate_radps: mean(rate), nominal_nm, fitted_nm, measured_nm: fitted_nm + off, error_nm }
}
