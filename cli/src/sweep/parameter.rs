//! The parameters that can be varied, by their names in the model file.

use gimbal_model_file::Tolerance;
use gimbal_servo::Config;

/// One number of the model file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Parameter {
    /// Name in the model file; the place in an array counted from 1, as the paper counts.
    pub(crate) name: &'static str,
    /// The paper's letters.
    pub(crate) symbol: &'static str,
    pub(crate) unit: &'static str,
    /// Name in `[tolerance]`.
    effect: &'static str,
    place: fn(&mut Config) -> &mut f64,
}

impl Parameter {
    /// Its value.
    pub(crate) fn get(&self, config: &Config) -> f64 {
        let mut config = *config;
        *(self.place)(&mut config)
    }

    /// Sets its value.
    pub(crate) fn set(&self, config: &mut Config, value: f64) {
        *(self.place)(config) = value;
    }

    /// The configuration with this parameter times a factor.
    pub(crate) fn scaled(&self, config: &Config, factor: f64) -> Config {
        let mut config = *config;
        let value = self.get(&config);
        self.set(&mut config, factor * value);
        config
    }

    /// How well it is known, relative.
    pub(crate) fn tolerance(&self, tolerance: &Tolerance) -> f64 {
        tolerance.of(self.effect)
    }

    /// The parameter of a name or symbol.
    pub(crate) fn find(name: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.name == name || parameter.symbol == name)
    }
}

const fn parameter(
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    effect: &'static str,
    place: fn(&mut Config) -> &mut f64,
) -> Parameter {
    Parameter { name, symbol, unit, effect, place }
}

/// What `[tolerance]` has no name for is known to its default.
const DEFAULT: &str = "default_relative";

/// All of them; the servo's and the gyro's first.
#[rustfmt::skip]
pub(crate) static PARAMETERS: [Parameter; 27] = [
    parameter("servo.gimbal_inertia_kg_m2", "Jg", "kg m2", "gimbal_inertia", |c| &mut c.servo.gimbal_inertia_kg_m2),
    parameter("servo.gain_nm_per_rad_s", "K", "N m/(rad s)", "loop_gain", |c| &mut c.servo.gain_nm_per_rad_s),
    parameter("servo.lead_time_constants_s[1]", "T1", "s", DEFAULT, |c| &mut c.servo.lead_time_constants_s[0]),
    parameter("servo.lead_time_constants_s[2]", "T2", "s", DEFAULT, |c| &mut c.servo.lead_time_constants_s[1]),
    parameter("servo.lead_time_constants_s[3]", "T3", "s", DEFAULT, |c| &mut c.servo.lead_time_constants_s[2]),
    parameter("servo.lead_time_constants_s[4]", "T4", "s", DEFAULT, |c| &mut c.servo.lead_time_constants_s[3]),
    parameter("servo.lead_time_constants_s[5]", "T5", "s", DEFAULT, |c| &mut c.servo.lead_time_constants_s[4]),
    parameter("servo.lag_time_constants_s[1]", "T6", "s", DEFAULT, |c| &mut c.servo.lag_time_constants_s[0]),
    parameter("servo.lag_time_constants_s[2]", "T7", "s", DEFAULT, |c| &mut c.servo.lag_time_constants_s[1]),
    parameter("servo.lag_time_constants_s[3]", "T8", "s", DEFAULT, |c| &mut c.servo.lag_time_constants_s[2]),
    parameter("servo.lag_time_constants_s[4]", "T9", "s", DEFAULT, |c| &mut c.servo.lag_time_constants_s[3]),
    parameter("servo.motor_lag_s", "T", "s", "motor_lag", |c| &mut c.servo.motor_lag_s),
    parameter("gyro.float_inertia_kg_m2", "Jo", "kg m2", DEFAULT, |c| &mut c.gyro.float_inertia_kg_m2),
    parameter("gyro.damping_nm_s_per_rad", "Bo", "N m s/rad", "gyro_damping", |c| &mut c.gyro.damping_nm_s_per_rad),
    parameter("gyro.angular_momentum_nm_s", "H", "N m s", "angular_momentum", |c| &mut c.gyro.angular_momentum_nm_s),
    parameter("gyro.stop_angle_rad", "stop", "rad", "stop_angle", |c| &mut c.gyro.stop_angle_rad),
    parameter("unbalance.x_kg_m", "u", "kg m", "mass_unbalance", |c| &mut c.unbalance.x_kg_m),
    parameter("bearing.load_torque_nm_per_n", "c", "N m/N^1.33", "friction_level", |c| &mut c.bearing.load_torque_nm_per_n),
    parameter("bearing.load_exponent", "exponent", "", DEFAULT, |c| &mut c.bearing.load_exponent),
    parameter("bearing.preload_n", "preload", "N", DEFAULT, |c| &mut c.bearing.preload_n),
    parameter("bearing.gimbal_weight_n", "W", "N", DEFAULT, |c| &mut c.bearing.gimbal_weight_n),
    parameter("bearing.static_axial_factor", "0.42", "", DEFAULT, |c| &mut c.bearing.static_axial_factor),
    parameter("bearing.static_radial_factor", "0.5", "", DEFAULT, |c| &mut c.bearing.static_radial_factor),
    parameter("bearing.torque_axial_factor", "2.77", "", DEFAULT, |c| &mut c.bearing.torque_axial_factor),
    parameter("bearing.pitch_diameter_m", "dm", "m", DEFAULT, |c| &mut c.bearing.pitch_diameter_m),
    parameter("bearing.lubrication_factor", "f0", "", "viscous_friction", |c| &mut c.bearing.lubrication_factor),
    parameter("bearing.slip_rate_radps", "w_s", "rad/s", DEFAULT, |c| &mut c.bearing.slip_rate_radps),
];

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::PARAMETERS;

    /// Names, places and factors belong together: each parameter alone moves.
    #[test]
    fn contract_each_parameter_is_another_number() {
        let nominal = Config::consistent();
        for parameter in &PARAMETERS {
            let changed = parameter.scaled(&nominal, 1.25);
            let moved: Vec<&str> = PARAMETERS
                .iter()
                .filter(|other| (other.get(&changed) / other.get(&nominal) - 1.0).abs() > 1e-12)
                .map(|other| other.name)
                .collect();
            assert_eq!(moved, [parameter.name]);
        }
    }
}
