//! What is known when theta leaves its stop.
//!
//! At the release phi' is zero. From there on the float follows phi', `w' = l (p - w)`, `theta' = w`, and phi' follows the
//! net torque, which the balance knows to its own error: `phi'(t) - phi'(release)` is right where phi' is not. The release
//! is seen once theta has fallen by more than noise. For each number of periods that may have passed since, the fall
//! is reckoned from the balance's last rates; the one that fits places the release, and the balance's phi' there is the
//! sum of all errors of phi' since contact. phi is corrected by as much as these errors, each with its uncertainty, have
//! moved phi for it.

use super::bound::RootSum;
use super::held;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::stored::stored;
use crate::units::Units;

/// Rates that the balance remembers: the longest time between a release and its being seen, in periods.
pub(crate) const RATES: usize = 12;
/// When the balance has nothing that pulls the float off, it left this long ago, in periods.
const USUAL: usize = 4;

/// The float's way off its stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// p for phi'.
    pub(crate) rate: ScaledRow<N, 1>,
    /// `e^(-l)` and 1 less that.
    keep: N::Coef,
    take: N::Coef,
}

stored!([N: Number] Law<N> { rate, keep, take });

/// What a p of 1 over one period has made of w and theta since.
#[derive(Clone, Copy)]
struct Pulse<N> {
    w: N,
    theta: N,
    /// What its end adds to w one period later.
    end: N,
}

impl<N: Number> Pulse<N> {
    /// Of the period that ends now: half of it acts.
    fn now(law: &Law<N>) -> Self {
        let w = N::head(law.take * N::ONE).half();
        Self { w, theta: w.half(), end: w }
    }

    /// One period later.
    fn age(&mut self, law: &Law<N>) {
        let w = N::head(law.keep * self.w) + self.end;
        self.theta = self.theta + self.w.half() + w.half();
        (self.w, self.end) = (w, N::ZERO);
    }
}

/// What pulses, one for each period, have made of theta and w together.
#[derive(Clone, Copy)]
struct Sum<N: Number> {
    theta: N::Wide,
    w: N::Wide,
    /// The same for pulses of 1; theta in the full scale [`SUM_SCALE`], for it grows with the periods.
    theta_of_one: N,
    w_of_one: N,
}

/// Holds [`RATES`].
const SUM_SCALE: u32 = 4;

impl<N: Number> Default for Sum<N> {
    fn default() -> Self {
        Self { theta: N::Wide::default(), w: N::Wide::default(), theta_of_one: N::ZERO, w_of_one: N::ZERO }
    }
}

impl<N: Number> Sum<N> {
    fn add(&mut self, pulse: &Pulse<N>, p: N) {
        self.theta = self.theta + pulse.theta.product(p);
        self.w = self.w + pulse.w.product(p);
        self.theta_of_one = self.theta_of_one + pulse.theta.shift_down(SUM_SCALE);
        self.w_of_one = self.w_of_one + pulse.w;
    }

    /// theta and w, every pulse less `base`.
    fn above(&self, base: N) -> (N, N) {
        (
            N::narrow(self.theta - N::widen_shifted(self.theta_of_one.product(base), SUM_SCALE)),
            N::narrow(self.w - self.w_of_one.product(base)),
        )
    }
}

/// Where the release was, and what theta and phi' have done since.
#[derive(Clone, Copy)]
pub(crate) struct Fall<N> {
    /// The balance's phi' at the release.
    pub(crate) excess: N,
    /// Its uncertainty.
    pub(crate) excess_bound: N,
    /// w now.
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
        let change = libm::expm1(-bo / jo * period);
        Self {
            rate: ScaledRow::build([period * h / bo], [units.gimbal_rate], filter_scale),
            keep: N::coef(1.0 + change),
            take: N::coef(-change),
        }
    }

    /// From how far theta has fallen and the balance's last rates, the latest first, all mirrored to the positive stop.
    pub(crate) fn fall(&self, fallen: N, rates: &[N; RATES]) -> Fall<N> {
        let [latest, before, ..] = *rates;
        let since_then = |rate: N| self.rate.at(&[rate - latest]);
        let (mut last, mut last_rate, mut last_p) = ((N::ZERO, N::ZERO), latest, N::ZERO);
        let (mut pulse, mut sum) = (Pulse::now(self), Sum::default());
        for &rate in &rates[1..] {
            let p = since_then(rate);
            sum.add(&pulse, last_p);
            let (theta, w) = sum.above(p);
            if -theta >= fallen {
                let part = (fallen + last.0).ratio(last.0 - theta);
                let step = (last_rate - rate).abs();
                return Fall {
                    excess: last_rate + (rate - last_rate).times(part),
                    excess_bound: step.half() + (latest - before).abs().half().half(),
                    slope: last.1 + (w - last.1).times(part),
                };
            }
            (last, last_rate, last_p) = ((theta, w), rate, p);
            pulse.age(self);
        }
        // The disturbance has changed on the stop: the balance says nothing of the release.
        let excess = rates[USUAL];
        Fall { excess, excess_bound: (excess - latest).abs() + excess.abs().half().half(), slope: -fallen.half() }
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
