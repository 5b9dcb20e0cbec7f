//! What a lab can do to tell two effects apart.

use gimbal_plant::{Block, Effect};

/// The experiment that separates two effects best.
#[must_use]
pub fn experiment(a: &str, b: &str) -> &'static str {
    let pair = |x: &str, y: &str| (a == x && b == y) || (a == y && b == x);
    let either = |x: &str| a == x || b == x;
    let block = |name: &str| Effect::from_name(name).map(Effect::block);
    if pair("torque_bias", "constant_torque") {
        return "switch the servo off with the gimbal caged: what the torque channel still reads is its own bias";
    }
    if either("direction_asymmetry") && (either("torque_bias") || either("constant_torque")) {
        return "reverse the rate at several loads: asymmetry grows with the load, a bias does not";
    }
    if either("anisoelasticity") && either("mass_unbalance") {
        return "tumble by quarter turns at 1 g: unbalance follows a_x and a_y, anisoelasticity their product";
    }
    if either("friction_drift") {
        return "repeat the same rate profile after a warm-up of ten minutes";
    }
    if either("load_dependence") && either("friction_level") {
        return "turn at constant rate at two loads (two tilts, or a centrifuge)";
    }
    if either("cable_spring") && either("cable_hysteresis") {
        return "slow triangle in angle with minor loops of several amplitudes";
    }
    if either("loop_delay") || either("motor_lag") || either("time_skew") {
        return "torque probe of 20 to 60 Hz at the motor with the motor torque logged";
    }
    if either("flexible_mode") {
        return "torque probe swept across 20 to 400 Hz";
    }
    if either("pickoff_scale") || either("gyro_damping") || either("angular_momentum") {
        return "rate-table step with gimbal_angle_rad logged by an autocollimator";
    }
    if either("torque_scale") || either("gimbal_inertia") || either("loop_gain") {
        return "add a known inertia to the gimbal, or calibrate the torque sensor, and repeat";
    }
    if block(a) == Some(Block::Friction) && block(b) == Some(Block::Friction) {
        return "rate staircase over three decades, both directions, at constant load";
    }
    "rate table with reversals at three rates and three tilts, motor torque and gimbal angle logged"
}
