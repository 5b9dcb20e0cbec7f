//! Transfer functions of the loop, evaluated in factored form at a complex frequency.
//!
//! With `A(s) = s (s + 1/T6) (s + 1/T7) (s + 1/T8) (s + 1/T9) (s + 1/T)` and `F(s) / (1 + T s) = N(s) / A(s)`,
//! eliminating phi' and `T_m` from (1) to (3) gives
//!
//! ```text
//! P(s) = (Jg Jo s^2 + Jg Bo s + H^2) s A(s) + H N(s)
//! theta / T_d = H A(s) / P(s)        phi' / T_d = s (Jo s + Bo) A(s) / P(s)
//! ```
//!
//! The motor torque in partial fractions, `T_m = y + D theta + sum z_i`: `y' = r_0 theta`,
//! `z_i' = p_i z_i + (r_i / p_i) theta'`, with `r_i` the residues of N/A at its poles `p_i`.

use crate::Config;
use crate::build::complex::Complex;

/// Poles of F(s)/(1 + T s) without the integrator.
pub(crate) const LAGS: usize = 5;

/// The loop's constants in f64.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plant {
    pub(crate) gimbal_inertia: f64,
    pub(crate) float_inertia: f64,
    pub(crate) damping: f64,
    pub(crate) momentum: f64,
    /// Zeros of N, 1/s.
    zeros: [f64; 5],
    /// Factor of the highest power of N.
    leading: f64,
    /// Poles `p_i`, 1/s, all negative.
    pub(crate) lags: [f64; LAGS],
    /// `r_0`, residue of the integrator: K.
    pub(crate) integrator_gain: f64,
    /// `r_i / p_i`.
    pub(crate) lag_gains: [f64; LAGS],
}

impl Plant {
    pub(crate) fn new(config: &Config) -> Self {
        let servo = &config.servo;
        let [t6, t7, t8, t9] = servo.lag_time_constants_s;
        let lag_times = [t6, t7, t8, t9, servo.motor_lag_s];
        let zeros = servo.lead_time_constants_s.map(|t| -1.0 / t);
        let leading = servo.gain_nm_per_rad_s * servo.lead_time_constants_s.iter().product::<f64>()
            / lag_times.iter().product::<f64>();
        let mut plant = Self {
            gimbal_inertia: servo.gimbal_inertia_kg_m2,
            float_inertia: config.gyro.float_inertia_kg_m2,
            damping: config.gyro.damping_nm_s_per_rad,
            momentum: config.gyro.angular_momentum_nm_s,
            zeros,
            leading,
            lags: separated(lag_times.map(|t| -1.0 / t)),
            integrator_gain: servo.gain_nm_per_rad_s,
            lag_gains: [0.0; LAGS],
        };
        plant.lag_gains = core::array::from_fn(|i| plant.residue(i) / plant.lags[i]);
        plant
    }

    /// D: what theta itself adds to the motor torque once the lags have settled.
    pub(crate) fn direct_gain(&self) -> f64 {
        -self.lag_gains.iter().sum::<f64>()
    }

    /// `r_i`: N over the other factors of A, at `p_i`.
    fn residue(&self, lag: usize) -> f64 {
        let pole = self.lags[lag];
        let others: f64 = (0..LAGS).filter(|&j| j != lag).map(|j| pole - self.lags[j]).product();
        self.leading * self.zeros.iter().map(|zero| pole - zero).product::<f64>() / (pole * others)
    }

    pub(crate) fn numerator(&self, s: Complex) -> Complex {
        self.zeros.iter().fold(Complex::real(self.leading), |product, &zero| product * (s - Complex::real(zero)))
    }

    pub(crate) fn numerator_slope(&self, s: Complex) -> Complex {
        (0..self.zeros.len()).fold(Complex::default(), |sum, skipped| {
            let others = (0..self.zeros.len()).filter(|&j| j != skipped);
            sum + others.fold(Complex::real(self.leading), |product, j| product * (s - Complex::real(self.zeros[j])))
        })
    }

    /// A(s) / s.
    pub(crate) fn lag_product(&self, s: Complex) -> Complex {
        self.lags.iter().fold(Complex::ONE, |product, &pole| product * (s - Complex::real(pole)))
    }

    /// A(s) / (s (s - `p_i`)).
    pub(crate) fn lag_product_without(&self, s: Complex, lag: usize) -> Complex {
        (0..LAGS).filter(|&j| j != lag).fold(Complex::ONE, |product, j| product * (s - Complex::real(self.lags[j])))
    }

    /// Jg Jo s^2 + Jg Bo s + H^2.
    pub(crate) fn inertia_factor(&self, s: Complex) -> Complex {
        let square = s * s;
        square.scale(self.gimbal_inertia * self.float_inertia)
            + s.scale(self.gimbal_inertia * self.damping)
            + Complex::real(self.momentum * self.momentum)
    }

    /// P(s).
    pub(crate) fn characteristic(&self, s: Complex) -> Complex {
        self.inertia_factor(s) * s * s * self.lag_product(s) + self.numerator(s).scale(self.momentum)
    }

    /// P's factor of s^9.
    pub(crate) fn characteristic_leading(&self) -> f64 {
        self.gimbal_inertia * self.float_inertia
    }

    /// phi' of a mode whose theta is 1: `s (Jo s + Bo) / H`.
    pub(crate) fn gimbal_rate_of(&self, s: Complex) -> Complex {
        s * self.gimbal_angle_of(s)
    }

    /// phi of a mode whose theta is 1: `(Jo s + Bo) / H`.
    pub(crate) fn gimbal_angle_of(&self, s: Complex) -> Complex {
        (s.scale(self.float_inertia) + Complex::real(self.damping)).scale(1.0 / self.momentum)
    }

    /// `T_m` of a mode whose theta is 1, from (1): `-Jg s phi' - H s`.
    pub(crate) fn motor_torque_of(&self, s: Complex) -> Complex {
        -(s * self.gimbal_rate_of(s)).scale(self.gimbal_inertia) - s.scale(self.momentum)
    }

    /// `z_i` of a mode whose theta is 1: `(r_i / p_i) s / (s - p_i)`; 0 where a zero of F cancels the lag.
    pub(crate) fn lag_state_of(&self, s: Complex, lag: usize) -> Complex {
        let largest = self.lag_gains.iter().fold(0.0, |most: f64, gain| most.max(gain.abs()));
        if self.lag_gains[lag].abs() <= 1e-12 * largest {
            return Complex::default();
        }
        s.scale(self.lag_gains[lag]) / (s - Complex::real(self.lags[lag]))
    }
}

/// The poles, equal ones moved apart by a part in a thousand: partial fractions need distinct poles, and no time
/// constant is known better.
fn separated(mut poles: [f64; LAGS]) -> [f64; LAGS] {
    for i in 1..LAGS {
        while poles[..i].iter().any(|other| (poles[i] - other).abs() < 0.5e-3 * poles[i].abs()) {
            poles[i] *= 1.0 + 1e-3;
        }
    }
    poles
}
