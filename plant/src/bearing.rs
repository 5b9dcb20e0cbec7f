//! Palmgren's friction of the gimbal bearings, written from the pound-inch form.
//!
//! ```text
//! F_a    = preload + W |a_z| / (n g)          F_r = W A_r / (n g)          F_s = 0.42 F_a + 0.5 F_r
//! T_load = c F_s^0.33 (2.77 F_a - 0.1 F_r)    F_r <= 2.518 F_a                                  (6.1)
//! T_load = c F_s^0.33 F_r                     F_r >  2.518 F_a                                  (6.2)
//! T_visc = f0 dm^3 * (3.492e-3 | 1.42e-5 (nu n)^(2/3))    below | above nu n = 2000 cSt rpm     [lbf in, in]
//! T_f    = (T_load + T_visc) * clamp(w_rel / w_s, -1, 1)
//! ```
//!
//! Source: the paper's section 3; T. A. Harris, *Rolling Bearing Analysis*, Wiley 1966, chapter 14.

use gimbal_servo::bearing::{Config, ViscousLaw};

use crate::row::{Interval, Row};

/// 1 g [m/s2].
pub(crate) const GRAVITY_MPS2: f64 = 9.806_65;
/// 1 lbf/in2 [N/m2].
const POUND_PER_INCH2_PA: f64 = 6_894.757_293_168_361;
/// nu n at the break [cSt rpm].
const BREAK_CST_RPM: f64 = 2000.0;
/// 1 rad/s in revolutions a minute.
const RADPS_RPM: f64 = 30.0 / std::f64::consts::PI;

/// All bearings of the axis together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bearings {
    config: Config,
    count: f64,
    /// Load of one bearing per specific force [N / (m/s2)].
    load_share: f64,
    /// `F_r / F_a` where (6.1) meets (6.2).
    boundary: f64,
    /// `T_visc` of all bearings below the break [N m].
    slow_nm: f64,
    /// `T_visc` of all bearings above it, over `(nu n)^(2/3)` [N m].
    fast_nm: f64,
    /// Speed at the break [rad/s].
    pub(crate) break_radps: f64,
}

impl Bearings {
    pub(crate) fn new(config: &Config) -> Self {
        let count = f64::from(config.count);
        let (slow_pa, fast_pa) = match config.viscous_law {
            ViscousLaw::Printed => (3.492e-3 * POUND_PER_INCH2_PA, 1.42e-5 * POUND_PER_INCH2_PA),
            // N mm and mm: 160e-7 and 1e-7
            ViscousLaw::Metric => (16.0, 0.1),
        };
        let size = count * config.lubrication_factor * config.pitch_diameter_m.powi(3);
        Self {
            config: *config,
            count,
            load_share: if config.count == 0 { 0.0 } else { config.gimbal_weight_n / (count * GRAVITY_MPS2) },
            boundary: config.torque_axial_factor / (1.0 + config.torque_radial_factor),
            slow_nm: slow_pa * size,
            fast_nm: fast_pa * size,
            break_radps: BREAK_CST_RPM / (config.viscosity_m2ps * 1e6) / RADPS_RPM,
        }
    }

    pub(crate) fn present(&self) -> bool {
        self.count > 0.0
    }

    pub(crate) fn slip_rate_radps(&self) -> f64 {
        self.config.slip_rate_radps
    }

    /// `(F_a, F_r)` of one bearing [N].
    fn loads_n(&self, row: &Row) -> (f64, f64) {
        let axial = self.config.preload_n + self.load_share * row.accel_z_mps2.abs();
        (axial, self.load_share * row.radial_accel_mps2())
    }

    /// `T_load` of all bearings [N m].
    pub(crate) fn load_torque_nm(&self, row: &Row) -> f64 {
        if !self.present() {
            return 0.0;
        }
        let (axial, radial) = self.loads_n(row);
        let equivalent = self.config.static_axial_factor * axial + self.config.static_radial_factor * radial;
        let load = if radial <= self.boundary * axial {
            self.config.torque_axial_factor * axial - self.config.torque_radial_factor * radial
        } else {
            radial
        };
        self.count * self.config.load_torque_nm_per_n * equivalent.powf(self.config.load_exponent) * load
    }

    /// `T_visc` of all bearings [N m]; `fast` tells on which side of the break the formula is read.
    pub(crate) fn viscous_torque_nm(&self, speed_radps: f64, fast: bool) -> f64 {
        if fast {
            let speed_cst_rpm = self.config.viscosity_m2ps * 1e6 * speed_radps * RADPS_RPM;
            self.fast_nm * speed_cst_rpm.powf(2.0 / 3.0)
        } else {
            self.slow_nm
        }
    }

    /// Times within the interval at which `T_load` has a corner, rising, the end of the interval last [s].
    ///
    /// Between two bends of the load `F_r - 2.518 F_a` is convex, and it crosses zero at most once between a bend
    /// and the next.
    pub(crate) fn corners_s(&self, interval: &Interval) -> ([f64; 8], usize) {
        let mut shares = [1.0; 8];
        let mut used = 0;
        if self.present() {
            let bends = interval.bends();
            let mut marks = [0.0, bends[0].unwrap_or(1.0), bends[1].unwrap_or(1.0), 1.0];
            marks.sort_by(f64::total_cmp);
            let excess = |share: f64| {
                let (axial, radial) = self.loads_n(&interval.at(share * interval.period_s()));
                radial - self.boundary * axial
            };
            for pair in marks.windows(2) {
                if excess(pair[0]) * excess(pair[1]) < 0.0 {
                    shares[used] = zero_between(pair[0], pair[1], excess);
                    used += 1;
                }
                if pair[1] < 1.0 {
                    shares[used] = pair[1];
                    used += 1;
                }
            }
        }
        (shares.map(|share| share * interval.period_s()), used + 1)
    }
}

/// Root of a function of opposite signs at both ends, by halving.
fn zero_between(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    let rising = function(high) > 0.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (function(middle) > 0.0) == rising { high = middle } else { low = middle }
    }
    high
}
