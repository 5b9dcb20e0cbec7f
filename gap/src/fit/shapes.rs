//! What noise looks like in a channel, over frequency.
//!
//! ```text
//! G_theta, G_T: theta and T_m after a torque of 1 N m on the gimbal        S = 1 - G_T
//! |G|^2   noise of the logged inputs        theta: |S|^2, T_m: |S F|^2   noise of the pick-off in the loop
//! F(f) = sum over k of F(i w) h(w), w = 2 pi (f - k / t)        h: sinc exp(-i w t / 2), or sinc^2
//! ```
//!
//! The servo answers what the pick-off says, noise or not: `T_m = F (theta + n)`, so `T_m = S F n` and the pick-off shows
//! `S n`; between two samples, t apart, n is held, or on a line, as it is or behind a filter of its demodulator.

use std::f64::consts::{PI, TAU};

use realfft::num_complex::Complex;

use super::plans::Plans;
use super::signals::Signals;
use crate::record::{Signal, between};
use crate::simulate::Physics;

/// Images of a spectrum that are summed, to either side.
const IMAGES: i32 = 2;
/// Where the filter of a demodulator ends, of second order [Hz].
const FILTER_HZ: f64 = 150.0;

/// The loop after an impulse of torque.
#[derive(Debug, Clone)]
pub(crate) struct Impulse {
    /// Every channel, over its noise.
    pub(crate) channels: Signals,
    /// `T_m` of the platform [N m], and what its loop is made of.
    pub(crate) motor_torque_nm: Vec<f64>,
    pub(crate) physics: Physics,
    /// The torque, over one row [N m].
    pub(crate) torque_nm: f64,
}

/// Powers at the lines of a transform.
#[derive(Debug)]
pub(crate) struct Shapes {
    /// Of the logged inputs' noise.
    inputs: Vec<f64>,
    /// Of the pick-off's in the loop: held, on lines between samples, and these behind a filter.
    in_loop: [Vec<f64>; 3],
    step_hz: f64,
}

impl Shapes {
    /// Of every channel.
    pub(super) fn of(impulse: &Impulse, signals: &[Signal], plans: &Plans, period_s: f64) -> Vec<Self> {
        let step_hz = 1.0 / (plans.length() as f64 * period_s);
        let lines = |series: &[f64]| plans.lines(series.iter().copied());
        let closed: Vec<f64> = lines(&impulse.motor_torque_nm)
            .iter()
            .map(|torque| (1.0 - torque / impulse.torque_nm).norm_sqr())
            .collect();
        let in_loop = |signal: Signal| {
            let of = |(line, closed): (usize, &f64)| {
                let hz = line as f64 * step_hz;
                let [held, on_lines] = match signal {
                    Signal::GyroAngle => [1.0; 2],
                    Signal::MotorTorque if line > 0 => {
                        answers(&impulse.physics, hz, period_s).map(|own| own.norm_sqr())
                    }
                    _ => [0.0; 2],
                };
                [held, on_lines, on_lines * passed(hz, FILTER_HZ, 2)].map(|own| closed * own)
            };
            let powers: Vec<[f64; 3]> = closed.iter().enumerate().map(of).collect();
            [0, 1, 2].map(|shape| powers.iter().map(|own| own[shape]).collect())
        };
        let shapes = |(channel, signal): (&Vec<f64>, &Signal)| Self {
            inputs: lines(channel).iter().map(Complex::norm_sqr).collect(),
            in_loop: in_loop(*signal),
            step_hz,
        };
        impulse.channels.iter().zip(signals).map(shapes).collect()
    }

    /// At a line.
    pub(super) fn line(&self, line: usize) -> [f64; 4] {
        let [held, on_lines, filtered] = &self.in_loop;
        [self.inputs[line], held[line], on_lines[line], filtered[line]]
    }

    /// At a frequency.
    pub(super) fn at(&self, hz: f64) -> [f64; 4] {
        let [held, on_lines, filtered] = &self.in_loop;
        [&self.inputs, held, on_lines, filtered].map(|powers| between(powers, hz / self.step_hz))
    }
}

/// What the motor's torque makes of a pick-off's samples, on lines between them [N m/rad].
pub(crate) fn servo_answer(physics: &Physics, hz: f64, period_s: f64) -> Complex<f64> {
    answers(physics, hz, period_s)[1]
}

/// What sampled noise of the pick-off, held between samples and on lines, makes of the motor's torque: F at a frequency and at
/// its images.
fn answers(physics: &Physics, hz: f64, period_s: f64) -> [Complex<f64>; 2] {
    let mut answers = [Complex::ZERO; 2];
    for image in -IMAGES..=IMAGES {
        let hz = hz - f64::from(image) / period_s;
        let (turn, own) = (PI * hz * period_s, transfer(physics, hz));
        let sinc = turn.sin() / turn;
        answers[0] += own * Complex::from_polar(sinc, -turn);
        answers[1] += own * (sinc * sinc);
    }
    answers
}

/// Power that a Butterworth filter of so many poles passes.
pub(super) fn passed(hz: f64, end_hz: f64, poles: i32) -> f64 {
    1.0 / (1.0 + (hz / end_hz).powi(2 * poles))
}

/// F at a frequency [N m/rad].
fn transfer(physics: &Physics, hz: f64) -> Complex<f64> {
    let servo = &physics.config.servo;
    let s = Complex::new(0.0, TAU * hz);
    let section = |time_s: &f64| 1.0 + time_s * s;
    let zeros: Complex<f64> = servo.lead_time_constants_s.iter().map(section).product();
    let poles: Complex<f64> = servo.lag_time_constants_s.iter().map(section).product();
    // of the motor's delay a share is pure
    let (pure_s, lag_s) = (physics.pure_delay * servo.motor_lag_s, (1.0 - physics.pure_delay) * servo.motor_lag_s);
    servo.gain_nm_per_rad_s * zeros * (-(physics.delay_s + pure_s) * s).exp() / (s * poles * section(&lag_s))
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;
    use realfft::num_complex::Complex;

    use super::{answers, transfer};
    use crate::simulate::Physics;

    #[test]
    fn closed_form_a_slow_sample_is_answered_as_what_is_continuous() {
        let physics = Physics::nominal(&Config::consistent());
        for hz in [0.1, 0.3] {
            let exact = transfer(&physics, hz);
            let late = Complex::from_polar(1.0, -std::f64::consts::PI * hz * 1e-3);
            let [held, on_lines] = answers(&physics, hz, 1e-3);
            assert!((on_lines / exact - 1.0).norm() < 0.01, "{hz}");
            assert!((held / (exact * late) - 1.0).norm() < 0.05, "{hz}");
        }
    }
}
