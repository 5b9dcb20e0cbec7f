//! What noise of the logged inputs is to the gimbal, away from where the bearing turns around [N m]:
//!
//! ```text
//! s^2 = |u|^2 n^2 + mean of sum over axes (n dT_load/da)^2 + over coloured ones (m_a dT/da)^2 + (m_w dT/dw)^2
//! dT/dx = -u_y + dT_load/dx sgn w      dT/dy = u_x + dT_load/dy sgn w      dT/dz = dT_load/dz sgn w      dT/dw = T_visc'
//! ```
//!
//! and, where the loop's own noise meets a corner of the motor, which takes a part of it away as no other row does, that noise
//! over the rows where it does.
//!
//! n is what the specific force has from row to row, m what white noise would have that has as much where it is slow as the
//! noise of an axis or of the rate that is not white.

use crate::fit::{Fit, Problem};
use crate::record::slow;
use crate::simulate::{Viscous, load_nm};

/// Rows of which one is looked at.
const EVERY: usize = 7;
/// Steps of the differences [m/s2], and over the slip rate.
const STEP_MPS2: f64 = 0.05;
const STEP: f64 = 0.1;

/// Rms of the loop's noise within which it meets a corner.
const MEETS: f64 = 2.0;

/// Of one row, at some rows.
pub(super) fn random_torque(problem: &Problem, fit: &Fit, at: &[bool]) -> f64 {
    torque_of_inputs(problem, fit, at).hypot(torque_of_corners(fit, at))
}

fn torque_of_corners(fit: &Fit, at: &[bool]) -> f64 {
    let physics = &fit.physics;
    let near_nm = MEETS * physics.motor_noise_nm;
    let meets = |torque_nm: f64| {
        let given_nm = (torque_nm / physics.measurement.torque_factor).abs();
        physics.limit_nm.is_some_and(|limit_nm| given_nm > limit_nm - near_nm)
            || physics.dead_zone_nm > 0.0 && given_nm < near_nm
    };
    let all = fit.prediction.motor_torque_nm.iter().zip(at).filter(|(_, at)| **at);
    let meeting = all.clone().filter(|(torque_nm, _)| meets(**torque_nm)).count() as f64;
    physics.motor_noise_nm * (meeting / all.count().max(1) as f64).sqrt()
}

fn torque_of_inputs(problem: &Problem, fit: &Fit, at: &[bool]) -> f64 {
    let (inputs, rate_noise) = (&problem.record.inputs, &problem.record.rate_noise);
    let (bearing, unbalance) = (&fit.physics.config.bearing, &fit.physics.config.unbalance);
    let force_noise = &problem.record.force_noise;
    let white_mps2 = force_noise.iter().map(|axis| axis.white_mps2).fold(0.0, f64::max);
    let white_nm = unbalance.x_kg_m.hypot(unbalance.y_kg_m) * white_mps2;
    let slow_radps = slow(rate_noise.rms_radps, rate_noise.colour);
    let slip_radps = inputs.slip_radps(&fit.prediction);
    let viscous = Viscous::new(bearing);
    let step_radps = STEP * bearing.slip_rate_radps;
    let fixed = [-unbalance.y_kg_m, unbalance.x_kg_m, 0.0];
    let square = |k: usize| -> f64 {
        let accel = [0, 1, 2].map(|axis| inputs.accel_mps2[axis][k]);
        let still_nm = load_nm(bearing, accel);
        let by = |axis: usize| {
            let mut moved = accel;
            moved[axis] += STEP_MPS2;
            let load = (load_nm(bearing, moved) - still_nm) / STEP_MPS2;
            let noise = force_noise[axis];
            (noise.white_mps2 * load).hypot(noise.slow_mps2 * (fixed[axis] + load * slip_radps[k].signum()))
        };
        let speed = slip_radps[k].abs();
        // at the break it jumps, and a small error of the rate hardly ever gets there
        let breaks = (speed..speed + step_radps).contains(&viscous.break_radps());
        let rise_nm = viscous.torque_nm(speed + step_radps) - viscous.torque_nm(speed);
        let drag = if breaks { 0.0 } else { rise_nm / step_radps };
        [by(0), by(1), by(2), slow_radps * drag].iter().map(|torque| torque * torque).sum()
    };
    let rows: Vec<f64> = (0..at.len()).step_by(EVERY).filter(|&k| at[k]).map(square).collect();
    (white_nm * white_nm + rows.iter().sum::<f64>() / rows.len().max(1) as f64).sqrt()
}
