//! What noise looks like in a channel, over frequency.
//!
//! ```text
//! G_theta, G_T: theta and T_m after a torque of 1 N m on the gimbal        S = 1 - G_T
//! |G|^2   noise of the logged inputs        theta: |S|^2, T_m: |S G_T / G_theta|^2   noise of the pick-off in the loop
//! ```
//!
//! The servo answers what the pick-off says, noise or not: `T_m = F (theta + n)`, so `T_m = S F n` and the pick-off shows
//! `S n`; F is what `T_m` is to theta after the torque.

use realfft::num_complex::Complex;

use super::plans::Plans;
use super::signals::Signals;
use crate::record::{Signal, between};

/// Power of a channel's response over which that is not known to be more than rounding, over its largest.
const ROUNDING: f64 = 1e-12;

/// The loop after an impulse of torque.
#[derive(Debug, Clone)]
pub(crate) struct Impulse {
    /// Every channel, over its noise.
    pub(crate) channels: Signals,
    /// theta and `T_m` of the platform [rad, N m].
    pub(crate) loop_signals: [Vec<f64>; 2],
    /// The torque, over one row [N m].
    pub(crate) torque_nm: f64,
}

/// Powers at the lines of a transform.
#[derive(Debug)]
pub(crate) struct Shapes {
    /// Of the logged inputs' noise.
    inputs: Vec<f64>,
    /// Of the pick-off's in the loop.
    in_loop: Vec<f64>,
    step_hz: f64,
}

impl Shapes {
    /// Of every channel.
    pub(super) fn of(impulse: &Impulse, signals: &[Signal], plans: &Plans, period_s: f64) -> Vec<Self> {
        let step_hz = 1.0 / (plans.length() as f64 * period_s);
        let lines = |series: &[f64]| plans.lines(series.iter().copied());
        let [theta, torque] = impulse.loop_signals.each_ref().map(|series| lines(series));
        let largest = theta.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
        let in_loop = |signal: Signal| -> Vec<f64> {
            let of = |(theta, torque): (&Complex<f64>, &Complex<f64>)| {
                let torque = torque / impulse.torque_nm;
                let closed = (1.0 - torque).norm_sqr();
                match signal {
                    Signal::GyroAngle => closed,
                    Signal::MotorTorque if theta.norm_sqr() > ROUNDING * largest => {
                        closed * torque.norm_sqr() * impulse.torque_nm.powi(2) / theta.norm_sqr()
                    }
                    _ => 0.0,
                }
            };
            theta.iter().zip(&torque).map(of).collect()
        };
        let shapes = |(channel, signal): (&Vec<f64>, &Signal)| Self {
            inputs: lines(channel).iter().map(Complex::norm_sqr).collect(),
            in_loop: in_loop(*signal),
            step_hz,
        };
        impulse.channels.iter().zip(signals).map(shapes).collect()
    }

    /// At a line.
    pub(super) fn line(&self, line: usize) -> [f64; 2] {
        [self.inputs[line], self.in_loop[line]]
    }

    /// At a frequency.
    pub(super) fn at(&self, hz: f64) -> [f64; 2] {
        [between(&self.inputs, hz / self.step_hz), between(&self.in_loop, hz / self.step_hz)]
    }
}
