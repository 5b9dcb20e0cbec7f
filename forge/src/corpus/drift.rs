//! Where the true parameters lie within the tolerance of the nominal ones.

use std::collections::BTreeMap;

use gimbal_servo::Config;
use gimbal_servo::servo;
use serde::{Deserialize, Serialize};

use crate::draw::Draw;
use crate::effects::World;
use crate::sensors::Sensors;
use crate::truth::Truth;

/// Default tolerance of a nominal parameter, relative.
pub(super) const DEFAULT: f64 = 0.03;
/// Tolerance of the bearings' torques, relative: the paper's own scatter.
pub(super) const FRICTION_LEVEL: f64 = 0.15;
/// Largest share of the motor's delay that is pure: the paper calls all of it a delay, the nominal model has a lag, and half
/// of it is what a servo holds that takes samples as far apart as it is long.
const PURE: f64 = 0.5;
/// Its name.
const PURE_DELAY: &str = "pure_delay";
/// Largest turn of an accelerometer [rad].
const MISALIGNMENT_RAD: f64 = 5e-4;

/// Nominal parameters that drift, by the effect that a shift beyond tolerance is, where it is one; the unbalance has two
/// components, and turns of the accelerometers come beside.
pub(super) const NAMES: [&str; 24] = [
    "friction_level",
    "viscous_friction",
    "loop_gain",
    "motor_lag",
    "gyro_damping",
    "angular_momentum",
    "gimbal_inertia",
    "stop_angle",
    "pickoff_scale",
    "torque_scale",
    "mass_unbalance",
    "mass_unbalance_y",
    "float_inertia",
    "slip_rate",
    "T1",
    "T2",
    "T3",
    "T4",
    "T5",
    "T6",
    "T7",
    "T8",
    "T9",
    PURE_DELAY,
];

/// Names of the turns of the accelerometers about x, y, z.
pub(super) const TURNS: [&str; 3] = ["accelerometers_about_x", "accelerometers_about_y", "accelerometers_about_z"];

/// Name of what the integrator holds at the record's beginning beside what it came to, in units of [`BEGINNING_NM`].
pub(super) const BEGINNING: &str = "beginning";
/// Of the size of the torques on the gimbal [N m].
const BEGINNING_NM: f64 = 1e-3;

/// Which axis the accelerometers are turned about.
fn turn(name: &str) -> Option<usize> {
    TURNS.iter().position(|own| *own == name)
}

/// Relative drift by name, and the turns of the accelerometers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// Relative change by name.
    pub relative: BTreeMap<String, f64>,
    /// Turns of the accelerometers about x, y, z [rad].
    pub misalignment_rad: [f64; 3],
}

/// Largest drift to either side of one name, to the upper one alone of the delay's share.
pub(super) fn tolerance(name: &str) -> f64 {
    match name {
        "friction_level" | "viscous_friction" => FRICTION_LEVEL,
        PURE_DELAY => PURE,
        name if turn(name).is_some() => MISALIGNMENT_RAD,
        _ => DEFAULT,
    }
}

/// From where to where one may still drift from where it is.
pub(super) fn limits(name: &str, now: f64) -> (f64, f64) {
    if name == BEGINNING {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let tolerance = tolerance(name);
    let lower = if name == PURE_DELAY { 0.0 } else { -tolerance };
    (lower - now, tolerance - now)
}

impl Drift {
    /// Draws all drifts; those that an effect of the log shifts stay at zero.
    pub(super) fn draw(draw: &mut Draw, shifted: &[&str]) -> Self {
        let relative = NAMES
            .iter()
            .map(|name| {
                let value = if *name == PURE_DELAY {
                    if draw.chance(0.5) { draw.uniform(0.0, PURE) } else { 0.0 }
                } else {
                    0.5 * tolerance(name) * draw.normal_within(2.0)
                };
                let own = shifted.iter().any(|effect| name.starts_with(effect));
                ((*name).to_owned(), if own { 0.0 } else { value })
            })
            .collect();
        let misalignment_rad = core::array::from_fn(|_| 0.5 * MISALIGNMENT_RAD * draw.normal_within(2.0));
        Self { relative, misalignment_rad }
    }

    pub(super) fn of(&self, name: &str) -> f64 {
        match turn(name) {
            Some(axis) => self.misalignment_rad[axis],
            None => self.relative.get(name).copied().unwrap_or(0.0),
        }
    }

    /// The drifted world of a nominal configuration.
    pub(super) fn world(&self, nominal: &Config) -> World {
        let mut world = World { truth: Truth::new(nominal), sensors: Sensors::default() };
        world.sensors.misalignment_rad = self.misalignment_rad;
        for name in NAMES {
            shift(&mut world, nominal, name, self.of(name));
        }
        world
    }
}

/// Adds a relative change of one nominal parameter to a world.
pub(super) fn shift(world: &mut World, nominal: &Config, name: &str, change: f64) {
    let World { truth, sensors } = world;
    let unbalance = libm::hypot(nominal.unbalance.x_kg_m, nominal.unbalance.y_kg_m);
    match name {
        "friction_level" => truth.friction.load_change += change,
        "viscous_friction" => truth.friction.viscous_change += change,
        "mass_unbalance" => truth.torque.unbalance_kg_m[0] += change * unbalance,
        "mass_unbalance_y" => truth.torque.unbalance_kg_m[1] += change * unbalance,
        "loop_gain" => truth.config.servo.gain_nm_per_rad_s += change * nominal.servo.gain_nm_per_rad_s,
        "motor_lag" => truth.config.servo.motor_lag_s += change * nominal.servo.motor_lag_s,
        // of the same delay another part
        PURE_DELAY => {
            truth.drive.delay_s += change * nominal.servo.motor_lag_s;
            truth.config.servo.motor_lag_s -= change * nominal.servo.motor_lag_s;
        }
        BEGINNING => truth.drive.begins_nm += change * BEGINNING_NM,
        "gyro_damping" => truth.config.gyro.damping_nm_s_per_rad += change * nominal.gyro.damping_nm_s_per_rad,
        "angular_momentum" => truth.config.gyro.angular_momentum_nm_s += change * nominal.gyro.angular_momentum_nm_s,
        "stop_angle" => truth.config.gyro.stop_angle_rad += change * nominal.gyro.stop_angle_rad,
        "gimbal_inertia" => {
            truth.config.servo.gimbal_inertia_kg_m2 += change * nominal.servo.gimbal_inertia_kg_m2;
        }
        "pickoff_scale" => sensors.pickoff_scale += change,
        "torque_scale" => sensors.torque_scale += change,
        "float_inertia" => truth.config.gyro.float_inertia_kg_m2 += change * nominal.gyro.float_inertia_kg_m2,
        "slip_rate" => truth.config.bearing.slip_rate_radps += change * nominal.bearing.slip_rate_radps,
        name => {
            if let Some(axis) = turn(name) {
                sensors.misalignment_rad[axis] += change;
            }
            if let Some((own, nominal)) = time_constant(&mut truth.config.servo, &nominal.servo, name) {
                *own += change * nominal;
            }
        }
    }
}

/// A time constant of the compensator, and what it is nominally.
fn time_constant<'a>(servo: &'a mut servo::Config, nominal: &servo::Config, name: &str) -> Option<(&'a mut f64, f64)> {
    let leads = ["T1", "T2", "T3", "T4", "T5"].into_iter().zip(&mut servo.lead_time_constants_s);
    let lags = ["T6", "T7", "T8", "T9"].into_iter().zip(&mut servo.lag_time_constants_s);
    let nominal = nominal.lead_time_constants_s.iter().chain(&nominal.lag_time_constants_s);
    let own = leads.chain(lags).zip(nominal).find(|((own, _), _)| *own == name);
    own.map(|((_, value), nominal)| (value, *nominal))
}
