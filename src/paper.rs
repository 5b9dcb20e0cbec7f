//! The paper's figures, each as printed and converted once, and the two presets made of them.
//!
//! Kim, Chung and Oh, "The simulation of INS error due to gimbal servo dynamics" (Daejeon).
//! The paper's units are CGS and pound-inch; nothing outside this file knows them.

use crate::bearing::ViscousLaw;
use crate::config::{Config, DEFAULT_PERIOD_S, Interpolation, Range};
use crate::{bearing, gyro, servo, unbalance};

/// Standard gravity [m/s2].
pub const STANDARD_GRAVITY_MPS2: f64 = 9.806_65;
/// One degree [rad].
pub const DEGREE_RAD: f64 = core::f64::consts::PI / 180.0;
/// One dyne cm [N m].
pub const DYNE_CM_NM: f64 = 1e-7;
/// One g cm2 [kg m2].
pub const GRAM_CM2_KG_M2: f64 = 1e-7;
/// One pound force [N].
pub const POUND_FORCE_N: f64 = 4.448_221_615_260_5;
/// One inch [m].
pub const INCH_M: f64 = 0.0254;
/// One pound-force inch [N m].
pub const POUND_INCH_NM: f64 = POUND_FORCE_N * INCH_M;
/// One centistokes [m2/s].
pub const CENTISTOKES_M2PS: f64 = 1e-6;
/// One revolution a minute [rad/s].
pub const RPM_RADPS: f64 = core::f64::consts::PI / 30.0;

/// nu n of the Palmgren break, in cSt rpm.
pub const CST_RPM_BREAK: f64 = 2000.0;
/// nu n of the Palmgren break [m2/s2].
pub const VISCOUS_BREAK_M2PS2: f64 = CST_RPM_BREAK * CENTISTOKES_M2PS * RPM_RADPS;
/// Viscous constant below the break, 3.492e-3 lbf in per in3 [N/m2].
pub const VISCOUS_LOW_PA: f64 = 3.492e-3 * POUND_INCH_NM / (INCH_M * INCH_M * INCH_M);
/// Viscous constant above the break, 1.42e-5 lbf in per in3 and (cSt rpm)^(2/3) [N/m2 per (cSt rpm)^(2/3)].
pub const VISCOUS_HIGH_PA: f64 = 1.42e-5 * POUND_INCH_NM / (INCH_M * INCH_M * INCH_M);
/// Harris's metric constant below the break, 160e-7 N mm per mm3 [N/m2].
pub const VISCOUS_LOW_METRIC_PA: f64 = 160e-7 * 1e6;
/// Harris's metric constant above the break, 1e-7 N mm per mm3 and (cSt rpm)^(2/3) [N/m2 per (cSt rpm)^(2/3)].
pub const VISCOUS_HIGH_METRIC_PA: f64 = 1e-7 * 1e6;

/// T5 as printed [s]: equal to T8, which it would cancel.
pub const T5_PRINTED_S: f64 = 0.00168;
/// T5 with the one power-of-ten slip mended that all the paper's angles ask for [s].
pub const T5_CONSISTENT_S: f64 = 0.168;

impl Config {
    /// The paper's platform with T5 = 0.168 s, which meets the paper's own results: the default.
    #[must_use]
    pub fn consistent() -> Self {
        Self::with_t5(T5_CONSISTENT_S)
    }

    /// The paper's platform with every coefficient as printed.
    #[must_use]
    pub fn as_printed() -> Self {
        Self::with_t5(T5_PRINTED_S)
    }

    /// The same platform with its bearings taken away.
    #[must_use]
    pub fn without_friction(mut self) -> Self {
        self.bearing.count = 0;
        self
    }

    /// The same platform, balanced.
    #[must_use]
    pub fn without_unbalance(mut self) -> Self {
        self.unbalance = unbalance::Config { x_kg_m: 0.0, y_kg_m: 0.0 };
        self
    }

    fn with_t5(t5_s: f64) -> Self {
        Self {
            servo: servo::Config {
                // 32,964 g cm2 (printed "g cm2/sec")
                gimbal_inertia_kg_m2: 32_964.0 * GRAM_CM2_KG_M2,
                // 83,448,323 dyne cm/rad, per second because F has an integrator
                gain_nm_per_rad_s: 83_448_323.0 * DYNE_CM_NM,
                // T1 2.16, T2 0.0385, T3 0.0156, T4 0.0127, T5 0.00168 s
                lead_time_constants_s: [2.16, 0.0385, 0.0156, 0.0127, t5_s],
                // T6 2.24, T7 0.00306, T8 0.00168, T9 0.00131 s
                lag_time_constants_s: [2.24, 0.003_06, 0.001_68, 0.001_31],
                // T 1 ms, printed as a delay
                motor_lag_s: 0.001,
            },
            gyro: gyro::Config {
                // Jo 340 g cm2
                float_inertia_kg_m2: 340.0 * GRAM_CM2_KG_M2,
                // Bo 92,700 dyne cm/(rad/s)
                damping_nm_s_per_rad: 92_700.0 * DYNE_CM_NM,
                // H 400,000 g cm2/s
                angular_momentum_nm_s: 400_000.0 * GRAM_CM2_KG_M2,
                // +-0.5 deg
                stop_angle_rad: 0.5 * DEGREE_RAD,
                cross_coupling: false,
            },
            bearing: bearing::Config {
                // two pairs
                count: 4,
                // 5 lbf
                preload_n: 5.0 * POUND_FORCE_N,
                // 5.49 lbf
                gimbal_weight_n: 5.49 * POUND_FORCE_N,
                // 0.974 in
                pitch_diameter_m: 0.974 * INCH_M,
                // 1.604e-4 lbf in per lbf^1.33
                load_torque_nm_per_n: 1.604e-4 * POUND_INCH_NM / libm::pow(POUND_FORCE_N, 1.33),
                load_exponent: 0.33,
                // F_s = 0.42 F_a + 0.5 F_r
                static_axial_factor: 0.42,
                static_radial_factor: 0.5,
                // 0.9 cot 18 deg = 2.77 (printed "2.7")
                torque_axial_factor: 2.77,
                torque_radial_factor: 0.1,
                // f0 1
                lubrication_factor: 1.0,
                // 13.7 cSt
                viscosity_m2ps: 13.7 * CENTISTOKES_M2PS,
                viscous_law: ViscousLaw::Printed,
                // w_s 2 mrad/s, this project's stand-in for stiction
                slip_rate_radps: 2e-3,
            },
            // 9,800 dyne cm per g, psi measured from x
            unbalance: unbalance::Config { x_kg_m: 9_800.0 * DYNE_CM_NM / STANDARD_GRAVITY_MPS2, y_kg_m: 0.0 },
            range: Range::default(),
            period_s: DEFAULT_PERIOD_S,
            interpolation: Interpolation::Mean,
        }
    }
}

impl Default for Config {
    /// [`Config::consistent`].
    fn default() -> Self {
        Self::consistent()
    }
}
