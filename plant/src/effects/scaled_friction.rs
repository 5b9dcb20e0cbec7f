//! `friction_level`, `load_dependence`, `direction_asymmetry`, `friction_drift`: Palmgren's torque, scaled.
//!
//! ```text
//! friction_level        T_load (1 + s)
//! load_dependence       T_load (1 + k A_r / g)
//! direction_asymmetry   T_f (1 + a sgn w_rel)
//! friction_drift        T_f (1 + d (1 - exp(-t / tau)))        t since the first row
//! ```
//!
//! Block `friction`; `T_f` here is the torque of the bearings, clamp included, without the drags of `viscous.rs`.
//! Changes `gyro_angle_rad`, `motor_torque_nm` and the angles of the gimbal.

use super::Altered;
use crate::bearing::GRAVITY_MPS2;
use crate::row::Row;

/// Factors of the friction torque, as differences from 1.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Scales {
    level: f64,
    per_g: f64,
    pub(crate) asymmetry: f64,
}

/// Friction that settles at another level while the run lasts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drift {
    ratio: f64,
    time_constant_s: f64,
}

impl Scales {
    pub(crate) fn load(&self, row: &Row) -> f64 {
        if self.per_g == 0.0 {
            return 1.0 + self.level;
        }
        (1.0 + self.level) * (1.0 + self.per_g * row.radial_accel_mps2() / GRAVITY_MPS2)
    }

    pub(crate) fn direction(&self, sign: f64) -> f64 {
        1.0 + self.asymmetry * sign
    }
}

impl Drift {
    pub(crate) fn factor(&self, time_s: f64) -> f64 {
        1.0 - self.ratio * (-time_s / self.time_constant_s).exp_m1()
    }
}

pub(super) fn friction_level(values: &[f64], altered: &mut Altered) {
    altered.laws.scales.level += values[0];
}

pub(super) fn load_dependence(values: &[f64], altered: &mut Altered) {
    altered.laws.scales.per_g += values[0];
}

pub(super) fn direction_asymmetry(values: &[f64], altered: &mut Altered) {
    altered.laws.scales.asymmetry += values[0];
}

pub(super) fn friction_drift(values: &[f64], altered: &mut Altered) {
    altered.laws.drift = Some(Drift { ratio: values[0], time_constant_s: values[1] });
}
