//! What is known when theta leaves its stop.
//!
//! At the release phi' is zero. From there on phi' falls with the net torque, `phi' = -a t`, and theta with it:
//!
//! ```text
//! theta' = -(H a / Bo) (t - (1 - e^(-l t)) / l)      theta = stop - (H a / Bo) (t^2 / 2 - t / l + (1 - e^(-l t)) / l^2)
//! ```
//!
//! The release is seen once theta has fallen by more than noise; how long ago it was follows from how far it has
//! fallen. The balance's phi' less this one is the sum of all errors of phi' since contact; phi is corrected by as much as
//! these errors, each with its uncertainty, have moved phi for it.

use super::bound::RootSum;
use super::held;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::units::Units;

/// Longest time between a release and its being seen, in periods.
const PERIODS: usize = 24;
/// When the balance says that nothing pulls the float off, it left this long ago, in periods.
const USUAL: usize = 5;

/// theta and w that a fall of phi' has made, for each number of periods.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// theta for the change of phi' over a period.
    fall: [ScaledRow<N, 1>; PERIODS],
    /// The change of phi' over a period for theta, at [`USUAL`].
    usual: ScaledRow<N, 1>,
    /// w likewise.
    slope: [ScaledRow<N, 1>; PERIODS],
    /// p for phi'.
    pub(crate) rate: ScaledRow<N, 1>,
}

/// The fall since release, mirrored to the positive stop.
pub(crate) struct Fall<N> {
    /// -phi' now.
    pub(crate) rate: N,
    /// Its uncertainty.
    pub(crate) rate_bound: N,
    /// -w now.
    pub(crate) slope: N,
}

/// How the balance is to be corrected.
pub(crate) struct Correction<N> {
    /// To be taken from phi.
    pub(crate) angle: N,
    /// Uncertainty that remains.
    pub(crate) bound: N,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(axis: &crate::Config, units: &Units, filter_scale: i32) -> Self {
        let period = axis.period_s;
        let (bo, jo, h) =
            (axis.gyro.damping_nm_s_per_rad, axis.gyro.float_inertia_kg_m2, axis.gyro.angular_momentum_nm_s);
        let lambda = bo / jo;
        // The rate changes by 1 over a period: a = 1 / T.
        let gain = h / (bo * period);
        let fall = |periods: usize| {
            let t = (periods + 1) as f64 * period;
            gain * (0.5 * t * t - t / lambda - libm::expm1(-lambda * t) / (lambda * lambda))
        };
        let slope = |periods: usize| {
            let t = (periods + 1) as f64 * period;
            gain * period * (t + libm::expm1(-lambda * t) / lambda)
        };
        Self {
            fall: core::array::from_fn(|i| ScaledRow::build([fall(i)], [units.gimbal_rate], filter_scale)),
            usual: ScaledRow::build([1.0 / fall(USUAL - 1)], [filter_scale], units.gimbal_rate),
            slope: core::array::from_fn(|i| ScaledRow::build([slope(i)], [units.gimbal_rate], filter_scale)),
            rate: ScaledRow::build([period * h / bo], [units.gimbal_rate], filter_scale),
        }
    }

    /// From how far theta has fallen, and how much phi' falls in a period.
    pub(crate) fn fall(&self, fallen: N, rate_change: N) -> Fall<N> {
        let (mut rate, mut last, mut last_slope) = (N::ZERO, N::ZERO, N::ZERO);
        if rate_change > N::ZERO {
            for (fall, slope) in self.fall.iter().zip(&self.slope) {
                let (now, now_slope) = (fall.at(&[rate_change]), slope.at(&[rate_change]));
                if now >= fallen {
                    let part = (fallen - last).ratio(now - last);
                    return Fall {
                        rate: rate + rate_change.times(part),
                        rate_bound: rate_change,
                        slope: last_slope + (now_slope - last_slope).times(part),
                    };
                }
                rate = rate + rate_change;
                (last, last_slope) = (now, now_slope);
            }
        }
        let change = self.usual.at(&[fallen]);
        let mut rate = N::ZERO;
        for _ in 0..USUAL {
            rate = rate + change;
        }
        Fall { rate, rate_bound: rate, slope: self.slope[USUAL - 1].at(&[change]) }
    }

    /// The correction for an error `excess` of phi' times the time since contact, measured to `reading`.
    pub(crate) fn correction(
        held: &held::Law<N>,
        state: &held::State<N>,
        root_sum: &RootSum<N>,
        excess: N,
        reading: N,
    ) -> Correction<N> {
        let modes = held.modes(state);
        let largest = modes.iter().fold(reading, |most, (_, rate)| most.most(rate.abs()));
        let (mut square, mut cross) =
            (eighth(N::ONE.times(reading.ratio(largest)).times(reading.ratio(largest))), N::ZERO);
        for (angle, rate) in &modes {
            let rate = rate.ratio(largest);
            square = square + eighth(rate.times(rate));
            cross = cross + eighth(rate.times(angle.ratio(largest)));
        }
        let gain = cross.ratio(square);
        let [a, b, c, d] = modes.map(|(angle, rate)| angle - rate.times(gain));
        Correction {
            angle: excess.times(gain),
            bound: root_sum.of_all(&[state.first_bound, a, b, c, d, reading.times(gain)]),
        }
    }
}

fn eighth<N: Number>(value: N) -> N {
    value.half().half().half()
}
