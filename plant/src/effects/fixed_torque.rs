//! `mass_unbalance`, `anisoelasticity`, `cross_axis_coupling`, `constant_torque`: torques that the inputs alone set.
//!
//! ```text
//! mass_unbalance        du_x a_y - du_y a_x        a change of u, part of T_u
//! anisoelasticity       k a_x a_y
//! cross_axis_coupling   k * vehicle rate * cross rate
//! constant_torque       T
//! ```
//!
//! Block `disturbance`; added to `T_d`. Change `gyro_angle_rad`, `motor_torque_nm` and the angles of the gimbal.

use super::Altered;

pub(super) fn mass_unbalance(values: &[f64], altered: &mut Altered) {
    altered.config.unbalance.x_kg_m += values[0];
    altered.config.unbalance.y_kg_m += values[1];
}

pub(super) fn anisoelasticity(values: &[f64], altered: &mut Altered) {
    altered.laws.anisoelasticity += values[0];
}

pub(super) fn cross_axis_coupling(values: &[f64], altered: &mut Altered) {
    altered.laws.cross_axis_kg_m2 += values[0];
}

pub(super) fn constant_torque(values: &[f64], altered: &mut Altered) {
    altered.laws.constant_nm += values[0];
}
