//! The float meets a stop: what is known of phi there, and what phi' takes over from the float.

use super::flags::Flags;
use super::law::Law;
use super::signals::Estimate;
use super::state::{Regime, State};
use super::{held, release};
use crate::build::plant::Plant;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::state::State as ModelState;
use crate::stop::Side;
use crate::stored::stored;
use crate::units::Units;

/// What the mean of neighbouring samples misses of the motor torque's impulse after a contact, as phi'.
///
/// At the contact theta' falls to zero, and the servo answers within a few periods: in the terms of (3), for a theta' of 1
/// and the contact d periods before a sample,
///
/// ```text
/// T^2 D d (1 - d) / 2 + sum r_i / p_i^2 (T e^(p_i d T) / (1 - e^(p_i T)) + 1 / p_i - T (1/2 - d))
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contact<N: Number> {
    powers: [ScaledRow<N, 1>; 3],
    shift: u32,
}

stored!([N: Number] Contact<N> { powers, shift });

impl<N: Number> Contact<N> {
    pub(crate) fn build(plant: &Plant, units: &Units, scale: i32, gyro: i32, period: f64) -> Self {
        let at = |d: f64| {
            let lags = plant.lags.iter().zip(&plant.lag_gains).map(|(p, gain)| {
                let x = p * period;
                gain / p * (-period * libm::exp(x * d) / libm::expm1(x) + 1.0 / p - period * (0.5 - d))
            });
            let sum = 0.5 * period * period * plant.direct_gain() * d * (1.0 - d) + lags.sum::<f64>();
            sum / (period * plant.gimbal_inertia)
        };
        let (start, middle, end) = (at(0.0), at(0.5), at(1.0));
        let square = 2.0 * (start + end) - 4.0 * middle;
        let powers = [start, end - start - square, square];
        Self {
            powers: powers.map(|power| ScaledRow::build([power], [scale], units.gimbal_rate)),
            shift: (scale - gyro).unsigned_abs(),
        }
    }

    /// For w at contact, and theta's excess over the stop, mirrored.
    fn increment(&self, w: N, excess: N, side: Side) -> N::Wide {
        let speed = side.mirror(w);
        if speed <= N::ZERO {
            return N::Wide::default();
        }
        let mut excess = excess.shift_down(self.shift);
        if excess > speed {
            excess = excess - speed;
        }
        let part = excess.least(speed).ratio(speed);
        let [a, b, c] = &self.powers;
        a.increment(&[w]) + b.increment(&[w.times(part)]) + c.increment(&[w.times(part).times(part)])
    }
}

impl<N: Number> Law<N> {
    /// The filter has run on beyond the stop by what theta is short of it.
    pub(super) fn meet_stop(
        &self,
        state: &mut State<N>,
        side: Side,
        gyro: N,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        flags: Flags,
    ) -> Estimate<N> {
        let [theta, w, p, d] = state.filter.map(N::head);
        let excess = (theta - gyro.shift_down(self.shift)).shift_up(self.shift);
        let excess = if side.mirror(excess) > N::ZERO { excess } else { N::ZERO };
        let seen = self.seen.increment(&[theta, w, p, d - self.load.times(state.torque)]);
        let angle = state.offset + seen;
        let rate = self.rate.increment(&[p, excess]) - self.contact.increment(w, side.mirror(excess), side);
        let torque = self.torque.times(state.level);
        let moved = self.torque.times(d - state.level).half();
        let modelled = held::modelled_torque(axis, model, N::narrow(rate));
        let coupling = N::head(self.held.rate_share * self.coupling.times(w).abs());
        let noise = self.root_sum.of(self.noise + state.transient, state.offset_bound);
        let seen_doubt = N::head(self.ratio_share * N::narrow(seen).abs());
        let torque_bound = self.root_sum.of_all(&[self.held.torque_noise, coupling, moved]);
        state.held = held::State {
            angle,
            rate,
            rates: [N::narrow(rate); release::RATES],
            first_angle: N::narrow(angle),
            first_rate: N::narrow(rate),
            first_bound: self.root_sum.of(noise, seen_doubt),
            torque_bound,
            first_torque_bound: torque_bound,
            surplus: torque - modelled.shift_down(self.held.torque_shift),
            modelled,
            first_modelled: modelled,
            stop: gyro,
            ..held::State::default()
        };
        state.regime = Regime::Held(side);
        state.lasting = state.lasting.without(Flags::SATURATION_AHEAD);
        state.lasting |= Flags::OFFSET_DOUBTFUL.when(state.trouble > 0 || flags.intersects(Flags::INPUT_SPIKE));
        state.postponed = false;
        state.watched = true;
        self.finish_held(state, flags)
    }
}

/// The side on which an angle lies beyond a limit.
pub(super) fn side_beyond<N: Number>(angle: N, limit: N) -> Option<Side> {
    if angle.within(limit) {
        None
    } else if angle > N::ZERO {
        Some(Side::Positive)
    } else {
        Some(Side::Negative)
    }
}
