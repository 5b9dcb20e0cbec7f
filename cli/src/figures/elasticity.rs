//! What the paper states as numbers, as functions of the coefficients, and how each follows each.

use gimbal_servo::paper::{DEGREE_RAD, DYNE_CM_NM, STANDARD_GRAVITY_MPS2};
use gimbal_servo::{BuildError, Config, Input, Interpolation, Law};

use crate::sweep::margin::margin;
use crate::sweep::parameter::Parameter;
use crate::sweep::trial::{self, Case};

/// A number that follows from a configuration.
pub(super) struct Quantity {
    /// Short, for a table's head.
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    of: fn(&Config) -> Result<f64, BuildError>,
}

impl Quantity {
    /// Its value.
    pub(super) fn at(&self, config: &Config) -> Result<f64, BuildError> {
        (self.of)(config)
    }

    /// Percent that it changes by when the parameter changes by one: the central difference over +-1 %, of logarithms.
    pub(super) fn elasticity(&self, config: &Config, parameter: &Parameter) -> Result<f64, BuildError> {
        const CHANGE: f64 = 0.01;
        let up = self.at(&parameter.scaled(config, 1.0 + CHANGE))?;
        let down = self.at(&parameter.scaled(config, 1.0 - CHANGE))?;
        Ok((up / down).ln() / ((1.0 + CHANGE) / (1.0 - CHANGE)).ln())
    }
}

/// All of them.
#[rustfmt::skip]
pub(super) static QUANTITIES: [Quantity; 11] = [
    Quantity { name: "theta, 1e5 dyne cm (2-1)", unit: "deg", of: |c| step_theta_deg(c, 1e5) },
    Quantity { name: "phi, 20 g unbalance (7)", unit: "deg", of: |c| Ok(free(c, Case::Unbalance)?[0]) },
    Quantity { name: "theta, 20 g unbalance (7)", unit: "deg", of: |c| Ok(free(c, Case::Unbalance)?[1]) },
    Quantity { name: "velocity error, 20 g unbalance (7)", unit: "m/s", of: |c| Ok(free(c, Case::Unbalance)?[2]) },
    Quantity { name: "theta, 20 g friction (9)", unit: "deg", of: |c| Ok(free(c, Case::Friction)?[1]) },
    Quantity { name: "velocity error, 20 g friction (9)", unit: "m/s", of: |c| Ok(free(c, Case::Friction)?[2]) },
    Quantity { name: "saturation, unbalance (8)", unit: "g", of: |c| saturation(c, Case::Unbalance) },
    Quantity { name: "saturation, friction (10)", unit: "g", of: |c| saturation(c, Case::Friction) },
    Quantity { name: "saturation, both", unit: "g", of: |c| saturation(c, Case::Both) },
    Quantity { name: "load friction, 20 g", unit: "dyne cm", of: |c| Ok(load_friction_dyne_cm(c, 20.0)) },
    Quantity { name: "phase margin", unit: "deg", of: |c| Ok(margin(c).map_or(f64::NAN, |margin| margin.phase_deg)) },
];

fn saturation(config: &Config, case: Case) -> Result<f64, BuildError> {
    // The limit may lie beyond the range that the law is sized for by default.
    let mut config = *config;
    config.range.radial_accel_mps2 = 100.0 * STANDARD_GRAVITY_MPS2;
    config.range.torque_nm = 0.5;
    Ok(trial::saturation_g(&config, case)?.unwrap_or(f64::NAN))
}

/// Largest phi and theta [deg] and velocity error [m/s] at 20 g, the stops out of reach.
pub(super) fn free(config: &Config, case: Case) -> Result<[f64; 3], BuildError> {
    let (law, _) = trial::free_law(config, case)?;
    let outcome = trial::run_law(&law, case, 20.0, config.period_s);
    Ok([
        outcome.peak_gimbal_angle_rad / DEGREE_RAD,
        outcome.peak_gyro_angle_rad / DEGREE_RAD,
        outcome.velocity_error_mps,
    ])
}

/// Largest theta after a torque step [deg], the stops out of reach.
pub(super) fn step_theta_deg(config: &Config, torque_dyne_cm: f64) -> Result<f64, BuildError> {
    let mut config = config.without_friction().without_unbalance();
    config.gyro.stop_angle_rad = 1e3;
    config.interpolation = Interpolation::Held;
    let law: Law<f32> = config.build()?;
    let row = law.units().input(&Input { torque_nm: torque_dyne_cm * DYNE_CM_NM, ..Input::default() });
    let mut state = law.start();
    let peak = (0..10_000).fold(0.0_f32, |peak, _| peak.max(law.step(&mut state, row).gyro_angle_rad.abs()));
    Ok(f64::from(peak) / DEGREE_RAD)
}

/// Load friction of all bearings under a radial acceleration [dyne cm].
pub(super) fn load_friction_dyne_cm(config: &Config, accel_g: f64) -> f64 {
    let bearing = &config.bearing;
    let (axial_n, radial_n) = bearing.loads_n(accel_g * STANDARD_GRAVITY_MPS2, 0.0);
    f64::from(bearing.count) * bearing.load_torque_nm(axial_n, radial_n) / DYNE_CM_NM
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::QUANTITIES;
    use crate::sweep::parameter::Parameter;

    /// phi's integral over a step of torque, and so the velocity error, is `T_d Bo A / (K H)` once the servo has settled; the
    /// slowest mode, of T1 and T6, has not quite after 5 s.
    #[test]
    fn closed_form_velocity_error_follows_gain_and_gyro() {
        let velocity = &QUANTITIES[3];
        assert_eq!(velocity.unit, "m/s");
        for (symbol, exponent) in [("u", 1.0), ("Bo", 1.0), ("K", -1.0), ("H", -1.0), ("T5", 0.0), ("Jg", 0.0)] {
            let parameter = Parameter::find(symbol).expect("a parameter");
            let found = velocity.elasticity(&Config::consistent(), parameter).expect("a preset");
            // f32 carries the sum to 1e-6, over a change of 2 %: 1e-4.
            assert!((found - exponent).abs() < 1e-3, "{symbol}: {found}");
        }
    }
}
