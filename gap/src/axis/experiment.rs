//! What tells two effects of an axis apart.

use crate::judge::experiment as of_platform;

/// The experiment for a pair; names may carry a channel.
pub(super) fn experiment(a: &str, b: &str) -> &'static str {
    let either = |name: &str| a.starts_with(name) || b.starts_with(name);
    let pair = |x: &str, y: &str| either(x) && either(y);
    if pair("constant_torque", "direction_asymmetry") {
        return "hold the axis between its two breakaways: an offset moves the middle of the efforts that start it either way, \
                an asymmetry does so by as much as the friction grows under load";
    }
    if either("bias_drift") && (either("constant_torque") || either("direction_asymmetry") || either("torque_bias")) {
        return "repeat the run when the axis is warm: a drift has gone, an offset and an asymmetry have not";
    }
    if pair("dead_zone", "friction_level") {
        return "accelerate harder: a dead zone changes sides with the effort, friction with the rate";
    }
    if either("cable_spring") || either("cable_hysteresis") {
        return of_platform("cable_spring", "cable_hysteresis");
    }
    if either("inertia") || either("torque_scale") {
        return "add a known mass, and repeat";
    }
    if either("motor_lag") || either("flexible_mode") || either("backlash") {
        return "sweep a small effort across the band, at rest and in motion";
    }
    if either("friction_drift") || either("viscous_drift") {
        return "repeat the same run when the axis is warm";
    }
    if either("load_dependence") || either("torque_curve") {
        return "run at constant rates under two loads";
    }
    if either("ripple") || either("torque_ripple") || either("motor_ripple") || either("position_friction") {
        return "cross the travel at three constant rates, both ways";
    }
    "constant rates over three decades, both ways"
}
