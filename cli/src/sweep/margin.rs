//! Crossover and phase margin of the loop, opened at the motor.
//!
//! ```text
//! L(s) = H F(s) / [(1 + T s) s (Jg Jo s^2 + Jg Bo s + H^2)]
//! ```
//!
//! which is what (1) and (2) make of a motor torque, fed back through (3).

use gimbal_servo::Config;

/// Crossover and phase margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Margin {
    /// Highest frequency at which the loop's gain is 1 [rad/s].
    pub(crate) crossover_radps: f64,
    /// Phase there above -180 deg [deg].
    pub(crate) phase_deg: f64,
}

/// Where the search begins and ends [rad/s].
const HIGHEST_RADPS: f64 = 1e6;
const LOWEST_RADPS: f64 = 1e-3;
/// Steps of the search; 64 a decade and a bisection in the last.
const STEP: f64 = 1.0366;

/// The margin of a configuration's loop; none where the gain does not cross 1.
pub(crate) fn margin(config: &Config) -> Option<Margin> {
    let mut above = HIGHEST_RADPS;
    while above > LOWEST_RADPS {
        let below = above / STEP;
        if log_gain(config, below) >= 0.0 {
            let crossover_radps = bisect(|rate| log_gain(config, rate), below, above);
            let phase_deg = 180.0 + phase_rad(config, crossover_radps).to_degrees();
            return Some(Margin { crossover_radps, phase_deg });
        }
        above = below;
    }
    None
}

/// Logarithm of |L(j w)|.
fn log_gain(config: &Config, rate: f64) -> f64 {
    let factor = |time: f64| 0.5 * (time * rate).powi(2).ln_1p();
    let servo = &config.servo;
    let leads: f64 = servo.lead_time_constants_s.iter().map(|&time| factor(time)).sum();
    let lags: f64 = servo.lag_time_constants_s.iter().map(|&time| factor(time)).sum();
    let (real, imaginary) = gimbal(config, rate);
    let direct = config.gyro.angular_momentum_nm_s * servo.gain_nm_per_rad_s / (rate * rate);
    direct.ln() + leads - lags - factor(servo.motor_lag_s) - real.hypot(imaginary).ln()
}

/// Phase of L(j w), continuous in w.
fn phase_rad(config: &Config, rate: f64) -> f64 {
    let angle = |time: f64| (time * rate).atan();
    let servo = &config.servo;
    let leads: f64 = servo.lead_time_constants_s.iter().map(|&time| angle(time)).sum();
    let lags: f64 = servo.lag_time_constants_s.iter().map(|&time| angle(time)).sum();
    let (real, imaginary) = gimbal(config, rate);
    // One integrator is the servo's, one the gyro's.
    -std::f64::consts::PI + leads - lags - angle(servo.motor_lag_s) - imaginary.atan2(real)
}

/// `Jg Jo s^2 + Jg Bo s + H^2` at s = j w.
fn gimbal(config: &Config, rate: f64) -> (f64, f64) {
    let (inertia, gyro) = (config.servo.gimbal_inertia_kg_m2, &config.gyro);
    let momentum2 = gyro.angular_momentum_nm_s * gyro.angular_momentum_nm_s;
    (momentum2 - inertia * gyro.float_inertia_kg_m2 * rate * rate, inertia * gyro.damping_nm_s_per_rad * rate)
}

fn bisect(function: impl Fn(f64) -> f64, mut below: f64, mut above: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (below + above);
        if function(middle) >= 0.0 {
            below = middle;
        } else {
            above = middle;
        }
    }
    0.5 * (below + above)
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::margin;

    /// Computed beforehand from the coefficients: 526 rad/s and 28 deg, as printed 15 rad/s and 34 deg.
    #[test]
    fn paper_margins_of_both_presets() {
        let consistent = margin(&Config::consistent()).expect("a crossover");
        assert!((consistent.crossover_radps - 526.0).abs() < 0.5 && (consistent.phase_deg - 28.0).abs() < 0.5);
        let printed = margin(&Config::as_printed()).expect("a crossover");
        assert!((printed.crossover_radps - 15.0).abs() < 0.5 && (printed.phase_deg - 34.0).abs() < 0.5);
    }
}
