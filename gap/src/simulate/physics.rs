//! What the platform is made of: the nominal parameters and every effect's, in one value.

use gimbal_servo::Config;

use super::corner::Corner;

/// Narrowest clamp of the friction, over the nominal one: a fit may ask for one that is none.
const SHARPEST: f64 = 1e-3;

/// Everything that a prediction depends on beside the inputs and the beginning.
#[derive(Debug, Clone, PartialEq)]
pub struct Physics {
    /// Nominal parameters, shifted where an effect shifts them.
    pub config: Config,
    /// Bearings beyond the nominal law.
    pub friction: Friction,
    /// Torque on the gimbal, constant [N m].
    pub constant_nm: f64,
    /// `k a_x a_y` [N m s4/m2].
    pub anisoelasticity: f64,
    /// `k rate cross_rate` [kg m2].
    pub cross_axis_kg_m2: f64,
    /// Turn of the accelerometers against the platform about x, y, z [rad].
    pub turned_rad: [f64; 3],
    /// Whether inputs run along lines between rows, 0, or along cubics, 1.
    pub curved: f64,
    /// Spring of the cable [N m/rad].
    pub spring_nm_per_rad: f64,
    /// Loop of the cable.
    pub hysteresis: Option<Hysteresis>,
    /// Ripple in rel.
    pub ripple: Option<Ripple>,
    /// Pure delay of the motor torque [s].
    pub delay_s: f64,
    /// Share of the motor's own delay that is pure; the rest is a lag.
    pub pure_delay: f64,
    /// Clamp of the motor torque [N m].
    pub limit_nm: Option<f64>,
    /// Subtractive dead zone of the motor [N m].
    pub dead_zone_nm: f64,
    /// Rms of the torque that the loop makes of its pick-off's noise [N m].
    pub motor_noise_nm: f64,
    /// Step of the pick-off in the loop [rad].
    pub quantum_rad: f64,
    /// Constant torque on the float [N m].
    pub float_nm: f64,
    /// Torque on the float per `a_x` [kg m].
    pub float_kg_m: f64,
    /// Appendage: share of the inertia, frequency [Hz], damping ratio.
    pub appendage: Option<[f64; 3]>,
    /// Sensors.
    pub measurement: Measurement,
}

/// Changes of the friction law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Of `T_load`.
    pub load_factor: f64,
    /// Of `T_visc`.
    pub viscous_factor: f64,
    /// `T_load (1 + k A_r / g)`.
    pub per_g: f64,
    /// `T_f (1 + a sgn w)`.
    pub asymmetry: f64,
    /// How round the clamp's corners are.
    pub corner: Corner,
    /// Share by which the clamp is narrower than the nominal one.
    pub sharper: f64,
    /// Displacement over which the clamp's share follows the rate, at the slip rate and above it [rad].
    pub follows_rad: f64,
    /// Time constant of what it follows by: as springs with a damping do [s].
    pub damped_s: f64,
    /// How straight it follows: 0 exponential, 1 straight to its end.
    pub straight: f64,
    /// `b w` [N m s/rad].
    pub viscous_nm_s: f64,
    /// `b w |w|` [N m s2/rad2].
    pub quadratic_nm_s2: f64,
    /// Excess at low rate.
    pub stribeck: Option<Stribeck>,
    /// Displacement over which friction builds up [rad].
    pub presliding_rad: f64,
    /// How it does.
    pub builds_up: BuildUp,
    /// Ratio and time constant [s].
    pub drift: Option<[f64; 2]>,
}

impl Friction {
    /// Whether the clamp's share follows the rate over a displacement.
    pub(super) fn follows(&self) -> bool {
        self.follows_rad.abs() > 0.0
    }
}

/// Excess of the friction at low rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stribeck {
    /// At rest [N m].
    pub excess_nm: f64,
    /// Its rate [rad/s].
    pub rate_radps: f64,
    /// How it falls.
    pub falls: Fall,
}

/// How the excess of the friction falls with the rate, `x = w / w_s`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fall {
    /// `exp(-x^2)`.
    #[default]
    Gaussian,
    /// `exp(-|x|)`.
    Exponential,
    /// `1 / (1 + x^2)`.
    Lorentzian,
}

impl Stribeck {
    /// The excess at a rate [N m].
    pub(super) fn torque_nm(&self, w: f64) -> f64 {
        let x = w / self.rate_radps;
        let share = match self.falls {
            Fall::Gaussian => (-x * x).exp(),
            Fall::Exponential => (-x.abs()).exp(),
            Fall::Lorentzian => 1.0 / (1.0 + x * x),
        };
        self.excess_nm * share
    }
}

/// How friction builds up after a reversal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BuildUp {
    /// All of it, in the place of the clamp.
    #[default]
    InPlaceOfClamp,
    /// All of it, and settles on the clamp.
    OnClamp,
    /// The load's friction alone, in the place of its clamp.
    LoadAlone,
    /// All of it, behind a chain of springs that yield.
    Sprung,
}

/// Loop of the cable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// Torque at the ends [N m].
    pub torque_nm: f64,
    /// Displacement of the initial stiffness [rad].
    pub displacement_rad: f64,
    /// How it is formulated.
    pub formulation: Loop,
    /// Share of the torque that it has when a run begins: what turned before that has wound it.
    pub wound: f64,
}

/// How the cable's loop is formulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Loop {
    /// One smooth law.
    #[default]
    BoucWen,
    /// Stops in parallel that yield one after the other.
    Stops,
    /// The same with exponent 1: it loads along an exponential.
    Exponential,
    /// Dahl's, which springs back along one, too.
    Dahl,
}

/// `s sin(n rel) + c cos(n rel)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ripple {
    /// s [N m].
    pub sine_nm: f64,
    /// c [N m].
    pub cosine_nm: f64,
    /// n [1].
    pub cycles: f64,
}

/// Sensors that only write the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Of the pick-off.
    pub pickoff_factor: f64,
    /// [rad].
    pub pickoff_bias_rad: f64,
    /// Of the torque sensor.
    pub torque_factor: f64,
    /// [N m].
    pub torque_bias_nm: f64,
    /// Of the logged vehicle rate [rad/s].
    pub rate_bias_radps: f64,
    /// Inputs logged late by this [s].
    pub skew_s: f64,
    /// Motor torque logged late by this [s].
    pub torque_late_s: f64,
}

impl Default for Friction {
    fn default() -> Self {
        Self {
            load_factor: 1.0,
            viscous_factor: 1.0,
            per_g: 0.0,
            asymmetry: 0.0,
            corner: Corner::default(),
            sharper: 0.0,
            follows_rad: 0.0,
            damped_s: 0.0,
            straight: 0.0,
            viscous_nm_s: 0.0,
            quadratic_nm_s2: 0.0,
            stribeck: None,
            presliding_rad: 0.0,
            builds_up: BuildUp::default(),
            drift: None,
        }
    }
}

impl Default for Measurement {
    fn default() -> Self {
        Self {
            pickoff_factor: 1.0,
            pickoff_bias_rad: 0.0,
            torque_factor: 1.0,
            torque_bias_nm: 0.0,
            rate_bias_radps: 0.0,
            skew_s: 0.0,
            torque_late_s: 0.0,
        }
    }
}

impl Physics {
    /// Where the float stops [rad]; the configured angle is what the pick-off reads there, less its bias.
    pub(super) fn stop_rad(&self) -> f64 {
        self.config.gyro.stop_angle_rad / self.measurement.pickoff_factor
    }

    /// Rate up to which the friction of the bearings follows the rate [rad/s].
    pub(crate) fn slip_rate_radps(&self) -> f64 {
        self.config.bearing.slip_rate_radps * (1.0 - self.friction.sharper).max(SHARPEST)
    }

    /// The nominal platform.
    #[must_use]
    pub fn nominal(config: &Config) -> Self {
        Self {
            config: *config,
            friction: Friction::default(),
            constant_nm: 0.0,
            anisoelasticity: 0.0,
            cross_axis_kg_m2: 0.0,
            turned_rad: [0.0; 3],
            curved: 0.0,
            spring_nm_per_rad: 0.0,
            hysteresis: None,
            ripple: None,
            delay_s: 0.0,
            pure_delay: 0.0,
            limit_nm: None,
            dead_zone_nm: 0.0,
            motor_noise_nm: 0.0,
            quantum_rad: 0.0,
            float_nm: 0.0,
            float_kg_m: 0.0,
            appendage: None,
            measurement: Measurement::default(),
        }
    }

    /// Whether the motor's torque has a ceiling or a dead zone.
    pub(crate) fn has_corners(&self) -> bool {
        self.limit_nm.is_some() || self.dead_zone_nm > 0.0
    }

    /// The loop, without what disturbs it and without what bends it.
    #[must_use]
    pub(crate) fn loop_alone(&self) -> Self {
        let mut config = self.config;
        config.bearing.count = 0;
        config.unbalance.x_kg_m = 0.0;
        config.unbalance.y_kg_m = 0.0;
        let Self { delay_s, pure_delay, appendage, .. } = *self;
        Self { delay_s, pure_delay, appendage, ..Self::nominal(&config) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Fall, Physics, Stribeck};

    #[test]
    fn contract_a_clamp_that_is_as_sharp_as_can_be_is_one() {
        let mut physics = Physics::nominal(&gimbal_model_file::ModelFile::default().config);
        let nominal_radps = physics.slip_rate_radps();
        for (sharper, share) in [(0.5, 0.5), (0.999_5, 1e-3), (1.0, 1e-3), (1.5, 1e-3)] {
            physics.friction.sharper = sharper;
            assert!((physics.slip_rate_radps() / nominal_radps - share).abs() < 1e-12, "{sharper}");
        }
    }

    #[test]
    fn closed_form_the_excess_falls_with_the_rate_in_either_direction() {
        for (falls, half) in
            [(Fall::Gaussian, 2.0_f64.ln().sqrt()), (Fall::Exponential, 2.0_f64.ln()), (Fall::Lorentzian, 1.0)]
        {
            let own = Stribeck { excess_nm: 3e-4, rate_radps: 0.02, falls };
            for (x, share) in [(0.0, 1.0), (half, 0.5), (-half, 0.5)] {
                assert!((own.torque_nm(x * 0.02) / 3e-4 - share).abs() < 1e-12, "{falls:?} at {x}");
            }
        }
    }
}
