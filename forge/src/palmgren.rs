//! Load and viscous torque of the bearings after Palmgren, written from the equations (6.1) and (6.2).
//!
//! Both constants of the viscous torque are those of the parameter set: `low` below `nu n = 2000 cSt rpm` and
//! `high (nu n / 2000)^(2/3)` above.

use gimbal_servo::bearing;
use gimbal_servo::paper::{STANDARD_GRAVITY_MPS2, VISCOUS_BREAK_M2PS2};

/// Constants of all bearings together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Palmgren {
    count: f64,
    preload_n: f64,
    mass_kg: f64,
    boundary: f64,
    low_nm: f64,
    high_nm: f64,
    break_radps: f64,
    config: bearing::Config,
}

impl Palmgren {
    /// From the parameters of one bearing.
    #[must_use]
    pub(crate) fn new(config: &bearing::Config) -> Self {
        let count = f64::from(config.count);
        let (low, high) = config.viscous_law.coefficients();
        let size = count * config.lubrication_factor * config.pitch_diameter_m.powi(3);
        Self {
            count,
            preload_n: config.preload_n,
            mass_kg: if config.count == 0 { 0.0 } else { config.gimbal_weight_n / STANDARD_GRAVITY_MPS2 / count },
            boundary: config.torque_axial_factor / (1.0 + config.torque_radial_factor),
            low_nm: low * size,
            high_nm: high * size,
            break_radps: VISCOUS_BREAK_M2PS2 / config.viscosity_m2ps,
            config: *config,
        }
    }

    /// Load torque of all bearings [N m].
    #[must_use]
    pub(crate) fn load_nm(&self, accel_mps2: [f64; 3]) -> f64 {
        if self.count == 0.0 {
            return 0.0;
        }
        let [x, y, z] = accel_mps2;
        let axial = self.preload_n + self.mass_kg * z.abs();
        let radial = self.mass_kg * libm::sqrt(x * x + y * y);
        let bearing = &self.config;
        let equivalent = bearing.static_axial_factor * axial + bearing.static_radial_factor * radial;
        let load = if radial > self.boundary * axial {
            radial
        } else {
            bearing.torque_axial_factor * axial - bearing.torque_radial_factor * radial
        };
        self.count * bearing.load_torque_nm_per_n * libm::exp(bearing.load_exponent * libm::log(equivalent)) * load
    }

    /// Viscous torque of all bearings [N m].
    #[must_use]
    pub(crate) fn viscous_nm(&self, rate_radps: f64) -> f64 {
        let over = rate_radps.abs() / self.break_radps;
        if over <= 1.0 { self.low_nm } else { self.high_nm * libm::cbrt(over * over) }
    }
}
