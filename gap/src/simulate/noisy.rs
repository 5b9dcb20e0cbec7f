//! A motor with corners under noise of the loop: what it gives on the average over that noise.
//!
//! ```text
//! E within(u + s n, L) = u - s g((u - L) / s) + s g((-u - L) / s)         g(z) = z Phi(z) + phi(z)
//! ```
//!
//! n: of a normal distribution, s its rms, Phi and phi that distribution and its density, within(u, L) a clamp at +-L. A dead
//! zone of D takes `within(u, D)` away.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::Physics;
use super::lanes::within;

/// Rms of the noise beyond which a corner is not felt.
const FAR: f64 = 6.0;

/// What the motor gives of a command [N m].
pub(super) fn motor_nm(physics: &Physics, command_nm: f64) -> f64 {
    let clamped_at = |limit_nm: f64| clamped_nm(command_nm, limit_nm, physics.motor_noise_nm);
    clamped_at(physics.limit_nm.unwrap_or(f64::INFINITY)) - clamped_at(physics.dead_zone_nm)
}

/// A torque under noise behind a clamp [N m].
fn clamped_nm(torque_nm: f64, limit_nm: f64, noise_nm: f64) -> f64 {
    if noise_nm <= 0.0 || limit_nm <= 0.0 || (torque_nm.abs() - limit_nm).abs() > FAR * noise_nm {
        return within(torque_nm, limit_nm);
    }
    let over = |beyond_nm: f64| noise_nm * mean_beyond(beyond_nm / noise_nm);
    torque_nm - over(torque_nm - limit_nm) + over(-torque_nm - limit_nm)
}

/// Mean of what is above zero of a normal distribution of unit variance about z.
fn mean_beyond(z: f64) -> f64 {
    let below = 0.5 * libm::erfc(-z * FRAC_1_SQRT_2);
    z * below + (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

#[cfg(test)]
mod tests {
    use super::clamped_nm;
    use crate::simulate::lanes::within;

    #[test]
    fn closed_form_a_clamp_under_noise_is_the_mean_over_it() {
        let (limit_nm, noise_nm) = (3e-3, 4e-4);
        for torque_nm in [0.0, 1e-3, 2.7e-3, 3e-3, -3.2e-3, 5e-3] {
            // by the trapezoidal rule over eight standard deviations
            let at = |k: u32| 0.01 * f64::from(k) - 8.0;
            let density = |n: f64| (-0.5 * n * n).exp() / (2.0 * std::f64::consts::PI).sqrt();
            let mean: f64 =
                (0..1601).map(|k| 0.01 * density(at(k)) * within(torque_nm + noise_nm * at(k), limit_nm)).sum();
            let own = clamped_nm(torque_nm, limit_nm, noise_nm);
            assert!((own - mean).abs() < 3e-9, "{own} of {mean} at {torque_nm}");
        }
        for torque_nm in [3e-3, 5e-3] {
            assert_eq!(clamped_nm(torque_nm, limit_nm, 0.0).to_bits(), limit_nm.to_bits());
        }
    }
}
