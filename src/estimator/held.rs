//! phi while the gyro sits on a stop: torque balance, and how uncertain it becomes.
//!
//! ```text
//! Jg phi'' = T_d - T_m      T_d = T_d(contact) + (modelled T_d - modelled T_d at contact)
//! ```
//!
//! What may be wrong, each a mode with its own part in phi and in phi': the rate at contact (a share of it, and noise),
//! Jg (a share of all that has been added since), and `T_d` (a constant, and a share of what the model has changed).

use super::bound::RootSum;
use super::config::Config;
use super::filter::Filter;
use super::law::share;
use super::release::RATES;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::state::State as ModelState;
use crate::stored::stored;
use crate::units::Units;

/// Periods of which [`State::time`] is a share.
pub(crate) const TIME_PERIODS: f64 = 4096.0;

/// The balance at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number> {
    /// phi and phi'.
    pub(crate) angle: N::Wide,
    pub(crate) rate: N::Wide,
    /// Both at contact.
    pub(crate) first_angle: N,
    pub(crate) first_rate: N,
    /// Uncertainty of phi at contact, of phi' at contact by noise, and of `T_d` now.
    pub(crate) first_bound: N,
    pub(crate) torque_bound: N,
    pub(crate) first_torque_bound: N,
    /// phi less that of the rate at contact alone.
    pub(crate) coasted: N::Wide,
    /// What an error of `T_d` by its uncertainty does.
    pub(crate) torque_angle: N::Wide,
    pub(crate) torque_rate: N::Wide,
    /// `T_d` at contact, less what the model had for it then.
    pub(crate) surplus: N,
    /// The modelled disturbance at the last row and at contact.
    pub(crate) modelled: N,
    pub(crate) first_modelled: N,
    /// phi' at the last rows, the latest first.
    pub(crate) rates: [N; RATES],
    /// Where theta rests.
    pub(crate) stop: N,
    /// Share of [`TIME_PERIODS`] since contact.
    pub(crate) time: N,
}

/// The balance over one period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// phi' for a torque of 1: `T / Jg`.
    pub(crate) rate_change: ScaledRow<N, 1>,
    /// phi for phi' and a torque.
    angle_change: ScaledRow<N, 2>,
    /// A rate times a share of [`TIME_PERIODS`].
    span: ScaledRow<N, 1>,
    tick: N,
    /// Shares: of the rate at contact, of Jg, of the modelled change, of the coupling torque `H theta'`.
    pub(crate) rate_share: N::Coef,
    pub(crate) inertia_share: N::Coef,
    model_share: N::Coef,
    /// What placing the contact within its period leaves of phi'.
    contact_share: N::Coef,
    /// Noise of phi' and of `T_d` at contact.
    pub(crate) rate_noise: N,
    pub(crate) torque_noise: N,
    pub(crate) torque_shift: u32,
}

stored!([N: Number] Law<N> {
    rate_change, angle_change, span, tick, rate_share, inertia_share, model_share, contact_share, rate_noise,
    torque_noise, torque_shift,
});

impl<N: Number> Law<N> {
    pub(crate) fn build(config: &Config, axis: &crate::Config, units: &Units, filter: &Filter) -> Self {
        let (period, jg) = (axis.period_s, axis.servo.gimbal_inertia_kg_m2);
        let tolerance = &config.tolerance;
        let rate_of = filter.ratio / period;
        Self {
            rate_change: ScaledRow::build([period / jg], [units.motor_torque], units.gimbal_rate),
            angle_change: ScaledRow::build(
                [period, 0.5 * period * period / jg],
                [units.gimbal_rate, units.motor_torque],
                units.gimbal_angle,
            ),
            span: ScaledRow::build([TIME_PERIODS * period], [units.gimbal_rate], units.gimbal_angle),
            tick: N::quantise(1.0 / TIME_PERIODS, 0),
            rate_share: share::<N>(libm::hypot(tolerance.damping, tolerance.angular_momentum)),
            inertia_share: share::<N>(tolerance.gimbal_inertia),
            contact_share: share::<N>(0.01),
            model_share: share::<N>(tolerance.friction_level),
            rate_noise: N::quantise(rate_of * filter.deviation(&[0.0, 0.0, 1.0, 0.0]), units.gimbal_rate),
            torque_noise: N::quantise(
                0.6 * filter.deviation(&[0.0, 0.0, 0.0, 1.0]) / filter.torque_scale,
                units.motor_torque,
            ),
            torque_shift: (units.motor_torque - units.torque).unsigned_abs(),
        }
    }

    /// One period under the mean motor torque `torque`.
    pub(crate) fn advance(
        &self,
        state: &mut State<N>,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        torque: N,
        inputs_well: bool,
    ) {
        let rate = N::narrow(state.rate);
        let modelled = if inputs_well { modelled_torque(axis, model, rate) } else { state.modelled };
        let mean = (state.modelled.half() + modelled.half()).shift_down(self.torque_shift);
        state.modelled = modelled;
        let net = state.surplus + mean - torque;
        state.coasted = N::confine(state.coasted + self.angle_change.increment(&[state.first_rate, N::ZERO]));
        state.angle = N::confine(state.angle + self.angle_change.increment(&[rate, net]));
        state.rate = N::confine(state.rate + self.rate_change.increment(&[net]));
        state.rates.copy_within(..RATES - 1, 1);
        state.rates[0] = N::narrow(state.rate);
        let change = (modelled - state.first_modelled).shift_down(self.torque_shift);
        let doubt = state.first_torque_bound + N::head(self.model_share * change.abs());
        state.torque_bound = state.torque_bound.most(doubt);
        let doubt_rate = N::narrow(state.torque_rate);
        state.torque_angle =
            N::confine(state.torque_angle + self.angle_change.increment(&[doubt_rate, state.torque_bound]));
        state.torque_rate = N::confine(state.torque_rate + self.rate_change.increment(&[state.torque_bound]));
        state.time = state.time + self.tick;
    }

    /// A rate times the time since contact.
    pub(crate) fn spanned(&self, state: &State<N>, rate: N) -> N {
        self.span.at(&[rate.times(state.time)])
    }

    /// Each mode's part in phi, and in phi' times the time since contact.
    pub(crate) fn modes(&self, state: &State<N>) -> [(N, N); 4] {
        let coasted = N::narrow(state.coasted);
        let gained = N::narrow(state.angle) - state.first_angle - coasted;
        let gained_rate = N::narrow(state.rate) - state.first_rate;
        let share = N::head(self.contact_share * state.first_rate.abs());
        let noise = self.spanned(state, self.rate_noise + share);
        let rate_part = N::head(self.rate_share * coasted);
        [
            (rate_part, rate_part),
            (N::head(self.inertia_share * gained), N::head(self.inertia_share * self.spanned(state, gained_rate))),
            (N::narrow(state.torque_angle), self.spanned(state, N::narrow(state.torque_rate))),
            (noise, noise),
        ]
    }

    /// Uncertainty of phi, 1 sigma.
    pub(crate) fn bound(&self, state: &State<N>, root_sum: &RootSum<N>) -> N {
        let [a, b, c, d] = self.modes(state).map(|(angle, _)| angle);
        root_sum.of_all(&[state.first_bound, a, b, c, d])
    }
}

/// The modelled disturbance with the bearing's rate as phi' makes it.
pub(crate) fn modelled_torque<N: Number>(axis: &crate::Law<N>, model: &ModelState<N>, rate: N) -> N {
    let relative = model.row.vehicle_rate_radps - rate.shift_down(axis.rate_shift);
    model.other_torque + model.friction_level.times(axis.friction.clamp(relative))
}
