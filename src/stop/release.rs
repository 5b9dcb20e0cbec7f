//! The float leaves its stop within a period.
//!
//! For the rest `h` of the period phi' has pulled the float, growing linearly from zero:
//! `Jo theta'' = H phi' - Bo theta'`. theta' follows exactly, theta as a third of `theta' h`, and the motor's lags by
//! theta's move.

use super::State;
use super::curve::{CURVE_SHIFT, Curve};
use crate::build::plant::{LAGS, Plant};
use crate::number::Number;
use crate::row::ScaledRow;
use crate::stored::stored;
use crate::units::Units;

/// What the float has done by the end of the period in which it left the stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    curve: Curve<N>,
    /// theta' for phi' at the end, weighted.
    gyro_rate: ScaledRow<N, 1>,
    /// theta for theta', a third of the time.
    gyro_angle: ScaledRow<N, 1>,
    lags: [ScaledRow<N, 1>; LAGS],
    /// phi less the offset, for theta and theta'.
    gimbal_angle: ScaledRow<N, 2>,
}

stored!([N: Number] Law<N> { curve, gyro_rate, gyro_angle, lags, gimbal_angle });

/// The physical state when the gyro has left its stop.
pub(crate) struct Released<N: Number> {
    pub(crate) gyro_angle: N,
    pub(crate) gyro_rate: N,
    pub(crate) lags: [N; LAGS],
    /// (Jo theta' + Bo theta) / H.
    pub(crate) gimbal_angle: N::Wide,
}

impl<N: Number> Law<N> {
    pub(super) fn build(plant: &Plant, units: &Units, period: f64) -> Self {
        let (jo, bo, h) = (plant.float_inertia, plant.damping, plant.momentum);
        Self {
            curve: Curve::build(-bo / jo * period),
            gyro_rate: ScaledRow::build([h / jo * period], [units.gimbal_rate], units.gyro_rate()),
            gyro_angle: ScaledRow::build([period / 3.0], [units.gyro_rate()], units.gyro_angle),
            lags: core::array::from_fn(|i| ScaledRow::build([plant.lag_gains[i]], [units.gyro_angle], units.lags[i])),
            gimbal_angle: ScaledRow::build([bo / h, jo / h], [units.gyro_angle, units.gyro_rate()], units.gimbal_angle),
        }
    }

    /// The float at the end of the period, `rest` of it after the release; `gimbal_rate` is phi' at that end.
    pub(crate) fn released(&self, state: &State<N>, stop: N, gimbal_rate: N, rest: N) -> Released<N> {
        let weighted = gimbal_rate.times(rest).times(self.curve.at(rest)).shift_up(CURVE_SHIFT);
        let gyro_rate = self.gyro_rate.at(&[weighted]);
        let moved = self.gyro_angle.at(&[gyro_rate.times(rest)]);
        let gyro_angle = stop + moved;
        Released {
            gyro_angle,
            gyro_rate,
            lags: core::array::from_fn(|i| N::narrow(state.lags[i]) + self.lags[i].at(&[moved])),
            gimbal_angle: self.gimbal_angle.increment(&[gyro_angle, gyro_rate]),
        }
    }
}
