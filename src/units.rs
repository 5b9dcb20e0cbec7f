//! Full scales of the signals: how SI values become numbers of the law, once, when it is built.

use crate::Config;
use crate::build::modes::{ANGLE, GIMBAL_RATE, INTEGRATOR, LAG, Modes, PHYSICAL, RATE};
use crate::build::plant::{LAGS, Plant};
use crate::build::poles::ORDER;
use crate::number::Number;
use crate::row::Row;
use crate::stored::stored;

/// Exponents of the full scales; all 0 for `f32`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Units {
    /// Specific force, of 1 m/s2.
    pub accel: i32,
    /// Vehicle and spin-axis rates, of 1 rad/s.
    pub rate: i32,
    /// Disturbance torques, of 1 N m.
    pub torque: i32,
    /// phi, of 1 rad.
    pub gimbal_angle: i32,
    /// phi', of 1 rad/s.
    pub gimbal_rate: i32,
    /// theta, of 1 rad.
    pub gyro_angle: i32,
    /// `T_m`, of 1 N m.
    pub motor_torque: i32,
    pub(crate) modes: [i32; ORDER],
    pub(crate) lags: [i32; LAGS],
}

stored!([] Units { accel, rate, torque, gimbal_angle, gimbal_rate, gyro_angle, motor_torque, modes, lags });

impl Units {
    pub(crate) fn new<N: Number>(config: &Config, plant: &Plant, modes: &Modes) -> Self {
        let range = &config.range;
        let accel = N::exponent(range.radial_accel_mps2.max(range.axial_accel_mps2));
        let largest_accel = libm::ldexp(1.0, N::exponent(range.radial_accel_mps2.max(range.axial_accel_mps2)));
        let friction =
            config.bearing.friction_level_nm(range.radial_accel_mps2, range.axial_accel_mps2, range.rate_radps);
        let unbalance = (config.unbalance.x_kg_m.abs() + config.unbalance.y_kg_m.abs()) * largest_accel;
        let drift = if config.gyro.cross_coupling { range.torque_nm } else { 0.0 };
        let largest_torque = friction + unbalance + range.torque_nm + drift;

        let bounds = modes.bounds().map(|bound| bound * largest_torque);
        let torque = N::exponent(4.0 * largest_torque);
        // A coefficient is a fraction: a mode's full scale also holds what the torque's full scale drives.
        let drive = modes.drive(config.period_s).map(|factor| N::exponent(N::rescaled(0.5 * factor.abs(), torque)));
        let mut mode_scales: [i32; ORDER] = core::array::from_fn(|i| N::exponent(bounds[i]).max(drive[i]));
        let (transitions, _) = modes.transition(config.period_s);
        for (pair, [_, to_first, to_second, _]) in mode_scales.chunks_exact_mut(2).zip(transitions) {
            // What one coordinate gives to the other is a fraction, too. The factors' product is below 1, so that the
            // second does not undo the first.
            let excess = |factor: f64, from: i32, to: i32| N::exponent(N::rescaled(factor.abs(), from - to)).max(0);
            pair[0] += excess(to_first, pair[1], pair[0]);
            pair[1] += excess(to_second, pair[0], pair[1]);
        }
        // Each mode's part of an output is a fraction of the output's full scale.
        let output =
            |row: [f64; ORDER], least: f64| Row::<N, ORDER>::exponent(row, mode_scales).max(N::exponent(least));
        let reach =
            |row: &[f64; ORDER]| -> f64 { row.iter().zip(&bounds).map(|(factor, bound)| (factor * bound).abs()).sum() };
        let angle_row = modes.row(|s| plant.gimbal_angle_of(s));
        let rate_row = modes.row(|s| plant.gimbal_rate_of(s));
        let torque_row = modes.row(|s| plant.motor_torque_of(s));
        let rate_change = 0.5 * config.period_s / plant.gimbal_inertia * libm::ldexp(1.0, torque);
        let gimbal_rate = output(rate_row, reach(&rate_row).max(rate_change).max(1.0));
        // theta' of a few rad/s: beyond, the gyro crosses from stop to stop within a few periods.
        let fastest_gyro = 4.0;
        Self {
            accel,
            // the difference of two rates must fit
            rate: N::exponent(2.0 * range.rate_radps).max(gimbal_rate),
            // the change of a torque over a period must fit, both ends added
            torque,
            gimbal_angle: output(angle_row, 0.9),
            gimbal_rate,
            gyro_angle: output([1.0; ORDER], 8.0 * config.gyro.stop_angle_rad),
            motor_torque: output(torque_row, reach(&torque_row) + 2.0 * largest_torque).max(torque),
            modes: mode_scales,
            lags: core::array::from_fn(|i| {
                N::exponent((fastest_gyro * plant.lag_gains[i] / plant.lags[i]).abs().max(0.1 * largest_torque))
            }),
        }
    }

    /// Full scales of a physical state.
    pub(crate) fn physical(&self) -> [i32; PHYSICAL] {
        let mut scales = [self.motor_torque; PHYSICAL];
        debug_assert_eq!(INTEGRATOR, 0);
        scales[LAG..ANGLE].copy_from_slice(&self.lags);
        scales[ANGLE] = self.gyro_angle;
        scales[RATE] = self.gyro_rate();
        scales[GIMBAL_RATE] = self.gimbal_rate;
        scales
    }

    /// theta', of 1 rad/s.
    pub(crate) fn gyro_rate(&self) -> i32 {
        self.gyro_angle
    }
}
