//! F(s) in scaled controllable canonical form.
//!
//! ```text
//! F(s) = K N(s) / D(s)      N = (1+T1 s) ... (1+T5 s)      D = s (1+T6 s) ... (1+T9 s)           (3)
//! q = s/W:  D = q^5 + a4 q^4 + ... + a0      N = b5 q^5 + ... + b0      (both over the leading term of D)
//! z_i' = W z_(i+1)      z_4' = W (theta - sum a_i z_i)      T = sum (b_i - b5 a_i) z_i + b5 theta
//! ```

use gimbal_servo::servo;

/// Order of F(s).
pub(crate) const ORDER: usize = 5;
/// W, scale of the frequency [rad/s]: near the geometric middle of the fast poles.
const SCALE_RADPS: f64 = 500.0;

/// Coefficients of the canonical form.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compensator {
    poles: [f64; ORDER],
    output: [f64; ORDER],
    direct: f64,
}

/// Coefficients of a product of (1 + T s), lowest power first, in powers of s/W.
fn product<const LEN: usize>(time_constants_s: &[f64]) -> [f64; LEN] {
    let mut powers = [0.0; LEN];
    powers[0] = 1.0;
    for time_s in time_constants_s {
        for power in (1..LEN).rev() {
            powers[power] += powers[power - 1] * time_s * SCALE_RADPS;
        }
    }
    powers
}

impl Compensator {
    /// The form of the servo's F(s).
    #[must_use]
    pub(crate) fn new(config: &servo::Config) -> Self {
        let zeros: [f64; ORDER + 1] = product(&config.lead_time_constants_s);
        let lags: [f64; ORDER] = product(&config.lag_time_constants_s);
        // D(s) = s * lags, monic in q after division by the last coefficient and W
        let leading = lags[ORDER - 1] * SCALE_RADPS;
        let mut poles = [0.0; ORDER];
        for power in 1..ORDER {
            poles[power] = lags[power - 1] * SCALE_RADPS / leading;
        }
        let scaled = zeros.map(|zero| config.gain_nm_per_rad_s * zero / leading);
        let direct = scaled[ORDER];
        Self { poles, output: core::array::from_fn(|power| scaled[power] - direct * poles[power]), direct }
    }

    /// Of `z_0`, which the other states follow from, what holds a torque for good: `a_0` is 0, as D(s) has the factor s.
    #[must_use]
    pub(crate) fn held(&self, torque_nm: f64) -> f64 {
        torque_nm / self.output[0]
    }

    /// `z'` for the angle that the servo sees.
    #[must_use]
    pub(crate) fn slope(&self, z: &[f64; ORDER], angle_rad: f64) -> [f64; ORDER] {
        let feedback: f64 = self.poles.iter().zip(z).map(|(pole, state)| pole * state).sum();
        core::array::from_fn(|power| SCALE_RADPS * if power + 1 < ORDER { z[power + 1] } else { angle_rad - feedback })
    }

    /// Torque commanded [N m]; with slopes in place of states and angle, its rate.
    #[must_use]
    pub(crate) fn output_nm(&self, z: &[f64; ORDER], angle_rad: f64) -> f64 {
        self.output.iter().zip(z).map(|(gain, state)| gain * state).sum::<f64>() + self.direct * angle_rad
    }
}
