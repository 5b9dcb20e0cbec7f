//! How much the loop shakes the gimbal with its own pick-off's noise. The bearing's rate has that, the logged inputs do not:
//! where the bearing turns around it is what noise of the logged rate is.
//!
//! ```text
//! theta = ... + n        T_m = F theta        phi'' = -T_m / J
//! rate^2 = sum over f of Re(conj(F r_theta) r_T) / (2 pi f J)^2
//! ```
//!
//! r: what a fit leaves of both channels, beyond `LEAST_HZ`, where hardly a torque is. A recorder's noise is in one of them
//! alone, and their product has none of it.

use std::f64::consts::TAU;

use crate::fit::{Plans, servo_answer};
use crate::record::Signal;
use crate::settle::Settled;

/// From where on it is looked for [Hz].
const LEAST_HZ: f64 = 30.0;
/// Standard errors by which it must stand out, and share of the noise of the logged rate.
const SURE: f64 = 4.0;
const NOTABLE: f64 = 0.5;
/// Share of the slip rate below which it is no matter.
const LEAST_OF_SLIP: f64 = 5e-4;

/// Rms of the gimbal's rate that the loop's noise makes [rad/s]; none where it is no matter beside that of the logged rate, or
/// where no torque is logged that would tell.
pub(crate) fn shaken(Settled { problem, search, .. }: &Settled) -> Option<f64> {
    let record = problem.record;
    let place = |signal| record.channels.iter().position(|channel| channel.signal == signal);
    let places = [place(Signal::GyroAngle)?, place(Signal::MotorTorque)?];
    let fit = search.closest();
    let residuals = problem.residual(&fit.prediction);
    let both = |row: usize| places.iter().all(|&place| record.channels[place].valid[row]);
    let valid: Vec<bool> = (0..record.rows()).map(both).collect();
    let plans = Plans::new(record.rows());
    let [angle, torque] = places
        .map(|place| plans.lines(residuals[place].iter().zip(&valid).map(|(r, valid)| if *valid { *r } else { 0.0 })));
    let (period_s, servo) = (record.inputs.period_s, &fit.physics.config.servo);
    let step_hz = 1.0 / (plans.length() as f64 * period_s);
    let (mut square, mut chance) = (0.0, 0.0);
    for (line, (angle, torque)) in angle.iter().zip(&torque).enumerate() {
        let hz = line as f64 * step_hz;
        if hz < LEAST_HZ {
            continue;
        }
        let per_torque = (TAU * hz * servo.gimbal_inertia_kg_m2).powi(-2);
        let answer = servo_answer(servo, hz, period_s) * angle;
        square += (answer.conj() * torque).re * per_torque;
        chance += 0.5 * answer.norm_sqr() * torque.norm_sqr() * per_torque * per_torque;
    }
    let counted = valid.iter().filter(|valid| **valid).count().max(1) as f64;
    let mean = |sum: f64| 2.0 * sum / (plans.length() as f64 * counted);
    let rate_radps = mean(square).max(0.0).sqrt();
    let slip_radps = fit.physics.config.bearing.slip_rate_radps;
    let least_radps = (NOTABLE * record.rate_noise.rms_radps).max(LEAST_OF_SLIP * slip_radps);
    (square > SURE * chance.sqrt() && rate_radps > least_radps).then_some(rate_radps)
}
