//! How much the loop shakes the gimbal with its own pick-off's noise. The bearing's rate has that, the logged inputs do not:
//! where the bearing turns around it is what noise of the logged rate is.
//!
//! ```text
//! theta = ... + n        T_m = F theta        phi'' = -T_m / J
//! rate^2 = sum over f of Re(conj(F r_theta) r_T) / (2 pi f J)^2
//! ```
//!
//! r: what a fit leaves of both channels, beyond `LEAST_HZ`, where hardly a torque is. A recorder's noise is in one of them
//! alone, and their product has none of it. Where no torque is logged, the pick-off's spectrum tells, which the loop gives a
//! shape of its own, `P = |S|^2 N`:
//!
//! ```text
//! rate^2 = sum over f of P |F|^2 / (2 pi f J)^2
//! ```

use std::f64::consts::TAU;

use gimbal_servo::servo;

use crate::fit::{Fit, Plans, Problem, peak, servo_answer};
use crate::record::Signal;
use crate::simulate::Physics;

/// From where on it is looked for [Hz].
const LEAST_HZ: f64 = 30.0;
/// Standard errors by which it must stand out, and share of the noise of the logged rate.
const SURE: f64 = 4.0;
const NOTABLE: f64 = 0.5;
/// Share of the slip rate, and of the largest torque, below which it is no matter.
const LEAST_OF_SLIP: f64 = 5e-4;
const LEAST_OF_PEAK: f64 = 2e-3;

/// Share of the pick-off's noise from which on it is in the loop, by its shape.
const IN_LOOP: f64 = 0.4;
/// Lines of a spectrum that is known by its shape.
const LINES: u32 = 2048;

/// What the loop's noise makes, rms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shaken {
    /// Rate of the gimbal; zero where it is no matter beside the noise of the logged one [rad/s].
    pub(crate) rate_radps: f64,
    /// The motor's torque [N m].
    pub(crate) motor_nm: f64,
}

/// What the loop's noise makes; none where it is no matter.
pub(crate) fn shaken(problem: &Problem, fit: &Fit) -> Option<Shaken> {
    let record = problem.record;
    let place = |signal| record.channels.iter().position(|channel| channel.signal == signal);
    let angle = place(Signal::GyroAngle)?;
    let [rate_radps, motor_nm] = match place(Signal::MotorTorque) {
        Some(torque) => with_torque(problem, fit, [angle, torque]),
        None => by_shape(problem, &fit.physics, angle),
    };
    let slip_radps = fit.physics.slip_rate_radps();
    let least_radps = (NOTABLE * record.rate_noise.rms_radps).max(LEAST_OF_SLIP * slip_radps);
    let least_nm = LEAST_OF_PEAK * peak(&fit.prediction.motor_torque_nm);
    let if_more = |own: f64, least: f64| if own > least { own } else { 0.0 };
    let shaken = Shaken { rate_radps: if_more(rate_radps, least_radps), motor_nm: if_more(motor_nm, least_nm) };
    (shaken.rate_radps > 0.0 || shaken.motor_nm > 0.0).then_some(shaken)
}

/// Rate and torque from what both channels have of it; zero where chance may be all there is.
fn with_torque(problem: &Problem, fit: &Fit, places: [usize; 2]) -> [f64; 2] {
    let record = problem.record;
    let residuals = problem.residual(&fit.prediction);
    let both = |row: usize| places.iter().all(|&place| record.channels[place].valid[row]);
    let valid: Vec<bool> = (0..record.rows()).map(both).collect();
    let plans = Plans::new(record.rows());
    let [angle, torque] = places
        .map(|place| plans.lines(residuals[place].iter().zip(&valid).map(|(r, valid)| if *valid { *r } else { 0.0 })));
    let (period_s, servo) = (record.inputs.period_s, &fit.physics.config.servo);
    let step_hz = 1.0 / (plans.length() as f64 * period_s);
    let (mut squares, mut chances) = ([0.0; 2], [0.0; 2]);
    for (line, (angle, torque)) in angle.iter().zip(&torque).enumerate() {
        let hz = line as f64 * step_hz;
        if hz < LEAST_HZ {
            continue;
        }
        let answer = servo_answer(&fit.physics, hz, period_s) * angle;
        for (place, weight) in [per_torque(servo, hz), 1.0].into_iter().enumerate() {
            squares[place] += (answer.conj() * torque).re * weight;
            chances[place] += 0.5 * answer.norm_sqr() * torque.norm_sqr() * weight.powi(2);
        }
    }
    let counted = valid.iter().filter(|valid| **valid).count().max(1) as f64;
    let mean = |sum: f64| 2.0 * sum / (plans.length() as f64 * counted);
    [0, 1].map(|place| if squares[place] > SURE * chances[place].sqrt() { mean(squares[place]).sqrt() } else { 0.0 })
}

/// The same from the shape of the pick-off's noise, where most of it is what the loop makes.
fn by_shape(problem: &Problem, physics: &Physics, angle: usize) -> [f64; 2] {
    let period_s = problem.record.inputs.period_s;
    let (mut squares, mut in_loop, mut all) = ([0.0; 2], 0.0, 0.0);
    for line in 1..LINES {
        let hz = 0.5 * f64::from(line) / (f64::from(LINES) * period_s);
        if hz < LEAST_HZ {
            continue;
        }
        let [own, every] = problem.in_loop_and_all(angle, hz);
        let torque = own * servo_answer(physics, hz, period_s).norm_sqr();
        squares[0] += torque * per_torque(&physics.config.servo, hz);
        squares[1] += torque;
        in_loop += own;
        all += every;
    }
    squares.map(|square| if in_loop > IN_LOOP * all { (square / f64::from(LINES)).sqrt() } else { 0.0 })
}

/// Square of the gimbal's rate after a torque of some frequency, over that of the torque [(rad/s)^2 / (N m)^2].
fn per_torque(servo: &servo::Config, hz: f64) -> f64 {
    (TAU * hz * servo.gimbal_inertia_kg_m2).powi(-2)
}
