//! The Kalman filter of the free gyro in f64: transition, steady gains, variances.
//!
//! With angles per period, `w = T theta'`, `p = T (H/Bo) phi'`, `d = s T_d`, `u = s T_m`, `s = T^2 H / (Bo Jg)`,
//! time in periods:
//!
//! ```text
//! theta' = w      w' = l (p - w)      p' = d - u - c w      d' = noise       l = T Bo/Jo      c = T H^2 / (Bo Jg)
//! ```

use super::config::Config;
use super::matrix::{Square, add, congruence, exponential};

/// theta, w, p, d.
pub(crate) const STATES: usize = 4;

/// Periods after which gains are steady; the slowest filter that `check` admits needs fewer.
const RICCATI_STEPS: usize = 20_000;

/// The filter's numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Filter {
    generator: Square<5>,
    /// Change of the state over a period, for the state itself; theta and d make none.
    pub(crate) change: Square<STATES>,
    /// Correction for an innovation of 1.
    pub(crate) gain: [f64; STATES],
    /// Standard deviation of the innovation [rad].
    pub(crate) innovation_rad: f64,
    /// Variance after the correction.
    pub(crate) variance: Square<STATES>,
    /// s: d for a torque of 1 N m.
    pub(crate) torque_scale: f64,
    /// `Bo / H`.
    pub(crate) ratio: f64,
    /// `Jo / (Bo T)`.
    pub(crate) lead: f64,
}

impl Filter {
    pub(crate) fn new(config: &Config, axis: &crate::Config, walk_nm: f64) -> Self {
        let period = axis.period_s;
        let (jg, jo) = (axis.servo.gimbal_inertia_kg_m2, axis.gyro.float_inertia_kg_m2);
        let (bo, h) = (axis.gyro.damping_nm_s_per_rad, axis.gyro.angular_momentum_nm_s);
        let (lambda, coupling) = (period * bo / jo, period * h * h / (bo * jg));
        let torque_scale = period * period * h / (bo * jg);
        let generator = [
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, -lambda, lambda, 0.0, 0.0],
            [0.0, -coupling, 0.0, 1.0, -torque_scale],
            [0.0; 5],
            [0.0; 5],
        ];
        let whole = exponential(&generator);
        let transition: Square<STATES> = core::array::from_fn(|i| core::array::from_fn(|j| whole[i][j]));
        let drive: [f64; STATES] = core::array::from_fn(|i| whole[i][4]);
        let walk = torque_scale * walk_nm;
        // Two neighbouring samples make the mean that drives the filter.
        let torque_noise = config.sensors.motor_torque_noise_nm * core::f64::consts::FRAC_1_SQRT_2;
        let walk_column: [f64; STATES] = core::array::from_fn(|i| whole[i][3]);
        let noise: Square<STATES> = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                walk * walk * walk_column[i] * walk_column[j] + torque_noise * torque_noise * drive[i] * drive[j]
            })
        });
        let step = config.sensors.gyro_step_rad;
        let reading = config.sensors.gyro_noise_rad * config.sensors.gyro_noise_rad + step * step / 12.0;
        let (gain, variance, innovation) = steady(&transition, &noise, reading);
        let mut change = transition;
        for (place, row) in change.iter_mut().enumerate() {
            row[place] -= 1.0;
        }
        Self {
            generator,
            change,
            gain,
            innovation_rad: libm::sqrt(innovation),
            variance,
            torque_scale,
            ratio: bo / h,
            lead: jo / (bo * period),
        }
    }

    /// theta and w `periods` later for theta, w, p, `d - u` now, d and u kept on.
    pub(crate) fn ahead(&self, periods: f64) -> [[f64; STATES]; 2] {
        let whole = exponential(&self.generator.map(|row| row.map(|x| x * periods)));
        core::array::from_fn(|i| core::array::from_fn(|j| whole[i][j]))
    }

    /// The part of phi that the gyro sees, `(Bo theta + Jo theta') / H`, `periods` later.
    pub(crate) fn seen_row(&self, periods: f64) -> [f64; STATES] {
        let ahead = self.ahead(periods);
        core::array::from_fn(|i| self.ratio * (ahead[0][i] + self.lead * ahead[1][i]))
    }

    /// Standard deviation of a sum of the state.
    pub(crate) fn deviation(&self, row: &[f64; STATES]) -> f64 {
        let mut sum = 0.0;
        for (a, variances) in row.iter().zip(&self.variance) {
            for (b, variance) in row.iter().zip(variances) {
                sum += a * b * variance;
            }
        }
        libm::sqrt(sum.max(0.0))
    }
}

/// Gain, variance after the correction, variance of the innovation.
fn steady(transition: &Square<STATES>, noise: &Square<STATES>, reading: f64) -> ([f64; STATES], Square<STATES>, f64) {
    let mut variance = [[0.0; STATES]; STATES];
    for (place, row) in variance.iter_mut().enumerate() {
        row[place] = reading;
    }
    let mut gain = [0.0; STATES];
    let mut innovation = reading;
    for _ in 0..RICCATI_STEPS {
        let mut before = congruence(transition, &variance);
        add(&mut before, noise);
        innovation = before[0][0] + reading;
        let next: [f64; STATES] = core::array::from_fn(|i| before[i][0] / innovation);
        variance = core::array::from_fn(|i| core::array::from_fn(|j| before[i][j] - next[i] * before[0][j]));
        let moved = next.iter().zip(&gain).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        gain = next;
        if moved < 1e-13 {
            break;
        }
    }
    (gain, variance, innovation)
}
