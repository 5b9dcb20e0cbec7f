//! Gimbal bearing friction after Palmgren: the `[bearing]` table and the exact form of the torque.
//!
//! Per bearing, with the load shared equally, `F_a = preload + W |a_z| / (n g)` and `F_r = W A_r / (n g)`:
//!
//! ```text
//! F_s    = 0.42 F_a + 0.5 F_r
//! T_load = c F_s^0.33 * (2.77 F_a - 0.1 F_r)      F_r <= 2.518 F_a                (6.1)
//! T_load = c F_s^0.33 * F_r                       F_r >  2.518 F_a                (6.2)
//! T_visc = k_1 f0 dm^3                            nu n <= 2000 cSt rpm
//! T_visc = k_2 f0 (nu n)^(2/3) dm^3               nu n >  2000 cSt rpm
//! T_f    = (T_load + T_visc) * clamp(w_rel / w_s, -1, 1)       w_rel = vehicle rate - phi'
//! ```
//!
//! Sources: the paper's section 3; T. A. Harris, *Rolling Bearing Analysis*, Wiley 1966, chapter 14.
//!
//! Assumptions: equal sharing of the load by all bearings; lubricant at one temperature; the clamp of width
//! `w_s` stands in for stiction. The printed pair of viscous constants jumps down by 35 % at the break;
//! [`ViscousLaw::Metric`] is continuous there.

pub(crate) mod level;

use crate::BuildError;
use crate::config::{positive, within};
use crate::paper::STANDARD_GRAVITY_MPS2;

/// Parameters of the gimbal's bearings, all alike.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Config {
    /// Number of bearings on the gimbal axis; 0 takes friction out of the model.
    pub count: u32,
    /// Axial preload of each bearing [N].
    pub preload_n: f64,
    /// W, weight of the gimbal at 1 g [N].
    pub gimbal_weight_n: f64,
    /// dm, pitch diameter [m].
    pub pitch_diameter_m: f64,
    /// c, load torque per (N of static equivalent load)^exponent and N of load, geometry included [N m / N^(1+exponent)].
    pub load_torque_nm_per_n: f64,
    /// Exponent of the static equivalent load `F_s`.
    pub load_exponent: f64,
    /// Share of `F_a` in `F_s`.
    pub static_axial_factor: f64,
    /// Share of `F_r` in `F_s`.
    pub static_radial_factor: f64,
    /// Factor of `F_a` in (6.1): 0.9 cot(contact angle).
    pub torque_axial_factor: f64,
    /// Factor of `F_r`, subtracted in (6.1).
    pub torque_radial_factor: f64,
    /// f0, lubrication factor.
    pub lubrication_factor: f64,
    /// nu, kinematic viscosity of the lubricant [m2/s].
    pub viscosity_m2ps: f64,
    /// Which constants the viscous torque uses.
    pub viscous_law: ViscousLaw,
    /// `w_s`, half width of the clamp that stands in for stiction [rad/s].
    pub slip_rate_radps: f64,
}

/// Constants of the viscous torque below and above the Palmgren break.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum ViscousLaw {
    /// The pair that the paper's figures imply: 3.492e-3 and 1.42e-5 in pound-inch units, a 35 % jump down.
    Printed,
    /// Harris's metric pair, 160e-7 and 1e-7 in N mm units, continuous to 1 %.
    Metric,
}

impl Config {
    pub(crate) fn check(&self) -> Result<(), BuildError> {
        within("bearing.count", f64::from(self.count), 0.0, 64.0)?;
        positive("bearing.preload_n", self.preload_n)?;
        positive("bearing.gimbal_weight_n", self.gimbal_weight_n)?;
        positive("bearing.pitch_diameter_m", self.pitch_diameter_m)?;
        positive("bearing.load_torque_nm_per_n", self.load_torque_nm_per_n)?;
        within("bearing.load_exponent", self.load_exponent, 0.0, 2.0)?;
        positive("bearing.static_axial_factor", self.static_axial_factor)?;
        positive("bearing.static_radial_factor", self.static_radial_factor)?;
        positive("bearing.torque_axial_factor", self.torque_axial_factor)?;
        within("bearing.torque_radial_factor", self.torque_radial_factor, 0.0, 10.0)?;
        within("bearing.lubrication_factor", self.lubrication_factor, 0.0, 100.0)?;
        positive("bearing.viscosity_m2ps", self.viscosity_m2ps)?;
        positive("bearing.slip_rate_radps", self.slip_rate_radps)
    }

    /// Axial and radial load of one bearing [N].
    #[must_use]
    pub fn loads_n(&self, radial_accel_mps2: f64, axial_accel_mps2: f64) -> (f64, f64) {
        let share = self.gimbal_weight_n / (f64::from(self.count.max(1)) * STANDARD_GRAVITY_MPS2);
        (self.preload_n + share * axial_accel_mps2.abs(), share * radial_accel_mps2)
    }

    /// `F_r / F_a` at which (6.1) meets (6.2): 2.518 for the paper's bearing.
    #[must_use]
    pub fn load_boundary(&self) -> f64 {
        self.torque_axial_factor / (1.0 + self.torque_radial_factor)
    }

    /// Load torque of one bearing [N m], (6.1) and (6.2).
    #[must_use]
    pub fn load_torque_nm(&self, axial_load_n: f64, radial_load_n: f64) -> f64 {
        let static_load = self.static_axial_factor * axial_load_n + self.static_radial_factor * radial_load_n;
        let load = if radial_load_n <= self.load_boundary() * axial_load_n {
            self.torque_axial_factor * axial_load_n - self.torque_radial_factor * radial_load_n
        } else {
            radial_load_n
        };
        self.load_torque_nm_per_n * libm::pow(static_load, self.load_exponent) * load
    }

    /// Rate above which the viscous torque grows [rad/s]: nu n = 2000 cSt rpm.
    #[must_use]
    pub fn viscous_break_radps(&self) -> f64 {
        crate::paper::VISCOUS_BREAK_M2PS2 / self.viscosity_m2ps
    }

    /// Viscous torque of one bearing [N m] at the speed `|rate_radps|`.
    #[must_use]
    pub fn viscous_torque_nm(&self, rate_radps: f64) -> f64 {
        let (low_pa, high_pa) = self.viscous_law.coefficients();
        let diameter3 = self.pitch_diameter_m * self.pitch_diameter_m * self.pitch_diameter_m;
        let speed = self.viscosity_m2ps * rate_radps.abs();
        let pressure = if speed <= crate::paper::VISCOUS_BREAK_M2PS2 {
            low_pa
        } else {
            high_pa * libm::pow(speed / crate::paper::VISCOUS_BREAK_M2PS2, 2.0 / 3.0)
        };
        pressure * self.lubrication_factor * diameter3
    }

    /// Size of the friction torque of all bearings [N m], before the clamp.
    #[must_use]
    pub fn friction_level_nm(&self, radial_accel_mps2: f64, axial_accel_mps2: f64, rate_radps: f64) -> f64 {
        let (axial, radial) = self.loads_n(radial_accel_mps2, axial_accel_mps2);
        f64::from(self.count) * (self.load_torque_nm(axial, radial) + self.viscous_torque_nm(rate_radps))
    }

    /// Friction torque on the gimbal [N m] at the relative rate `w_rel`.
    #[must_use]
    pub fn friction_torque_nm(&self, level_nm: f64, relative_rate_radps: f64) -> f64 {
        level_nm * (relative_rate_radps / self.slip_rate_radps).clamp(-1.0, 1.0)
    }
}

impl ViscousLaw {
    /// Torque over f0 dm^3 [N/m2], below the break and just above it.
    #[must_use]
    pub fn coefficients(self) -> (f64, f64) {
        use crate::paper::{
            CST_RPM_BREAK, VISCOUS_HIGH_METRIC_PA, VISCOUS_HIGH_PA, VISCOUS_LOW_METRIC_PA, VISCOUS_LOW_PA,
        };
        let break_power = libm::pow(CST_RPM_BREAK, 2.0 / 3.0);
        match self {
            Self::Printed => (VISCOUS_LOW_PA, VISCOUS_HIGH_PA * break_power),
            Self::Metric => (VISCOUS_LOW_METRIC_PA, VISCOUS_HIGH_METRIC_PA * break_power),
        }
    }
}
