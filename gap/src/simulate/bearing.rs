//! Palmgren's friction level of a row, and the friction law on top of it.
//!
//! ```text
//! F_a    = preload + W |a_z| / (n g)      F_r = W A_r / (n g)      F_s = 0.42 F_a + 0.5 F_r
//! T_load = n c F_s^0.33 max(2.77 F_a - 0.1 F_r, F_r)                                       (6.1) (6.2)
//! T_visc = n f0 dm^3 k_1 | n f0 dm^3 k_2 (nu n)^(2/3)
//! ```

use gimbal_servo::bearing::{Config, ViscousLaw};

/// Standard acceleration of gravity [m/s2].
pub(crate) const GRAVITY_MPS2: f64 = 9.806_65;
const POUND_PER_INCH2_PA: f64 = 6_894.757_293_168_361;
const RADPS_RPM: f64 = 30.0 / std::f64::consts::PI;
const BREAK_CST_RPM: f64 = 2000.0;

/// `T_load` of all bearings [N m].
pub(crate) fn load_nm(bearing: &Config, accel: [f64; 3]) -> f64 {
    let count = f64::from(bearing.count);
    if bearing.count == 0 {
        return 0.0;
    }
    let share = bearing.gimbal_weight_n / (count * GRAVITY_MPS2);
    let axial = bearing.preload_n + share * accel[2].abs();
    let radial = share * accel[0].hypot(accel[1]);
    let equivalent = bearing.static_axial_factor * axial + bearing.static_radial_factor * radial;
    let load = (bearing.torque_axial_factor * axial - bearing.torque_radial_factor * radial).max(radial);
    count * bearing.load_torque_nm_per_n * equivalent.powf(bearing.load_exponent) * load
}

/// `T_visc` as a function of the speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Viscous {
    slow_nm: f64,
    fast_nm: f64,
    break_radps: f64,
}

impl Viscous {
    pub(crate) fn new(bearing: &Config) -> Self {
        let (slow, fast) = match bearing.viscous_law {
            ViscousLaw::Printed => (3.492e-3 * POUND_PER_INCH2_PA, 1.42e-5 * POUND_PER_INCH2_PA),
            ViscousLaw::Metric => (16.0, 0.1),
        };
        let size = f64::from(bearing.count) * bearing.lubrication_factor * bearing.pitch_diameter_m.powi(3);
        let speed = bearing.viscosity_m2ps * 1e6 * RADPS_RPM;
        Self { slow_nm: slow * size, fast_nm: fast * size * speed.powf(2.0 / 3.0), break_radps: BREAK_CST_RPM / speed }
    }

    /// Where one law ends and the other begins [rad/s].
    pub(crate) fn break_radps(&self) -> f64 {
        self.break_radps
    }

    pub(crate) fn torque_nm(&self, speed_radps: f64) -> f64 {
        if speed_radps <= self.break_radps { self.slow_nm } else { self.fast_nm * speed_radps.cbrt().powi(2) }
    }
}
