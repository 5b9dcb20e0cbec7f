//! What the axis of the cases with effects does beside its nominal equations. The build script and the host's
//! digests read this file, too.

use gimbal_servo::effects::Config as Effects;

/// Every size that the law has.
#[must_use]
pub fn all() -> Effects {
    Effects {
        constant_torque_nm: 3e-4,
        cable_spring_nm_per_rad: 1.2e-3,
        viscous_friction_nm_s_per_rad: 5e-4,
        quadratic_drag_nm_s2_per_rad2: 3e-4,
        anisoelasticity_nm_s4_per_m2: 1e-6,
        stribeck_excess_nm: 6e-4,
        stribeck_rate_radps: 0.05,
        loop_delay_s: 4e-4,
        torque_scale: 0.02,
        torque_bias_nm: 2e-4,
        pickoff_scale: 0.01,
        pickoff_bias_rad: 1e-4,
    }
}

/// A cable, the motor's delay and the bias of its torque's sensor.
#[must_use]
pub fn three() -> Effects {
    Effects { cable_spring_nm_per_rad: 1.2e-3, loop_delay_s: 4e-4, torque_bias_nm: 2e-4, ..Effects::default() }
}
