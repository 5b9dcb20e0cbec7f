//! A clamp that follows the rate over a displacement, as bristles do that bend before they slip.

use super::Law;
use crate::simulate::lanes::Lanes;

/// How often a step of bristles is taken, each time by the rate at its end of the last.
const PASSES: usize = 3;

/// Share of the friction that bristles have after a step, and how fast that goes on then [1/s]: of the share before, of the clamp's
/// before, and of the clamp's after.
struct Bends<const L: usize> {
    of: [Lanes<L>; 3],
    onward: [Lanes<L>; 3],
}

/// A clamp that has followed the rate over a step.
pub(in crate::simulate) struct Followed<const L: usize> {
    /// w, and z, what is built up.
    pub(in crate::simulate) w: Lanes<L>,
    pub(in crate::simulate) zeta: Lanes<L>,
    /// Share of the friction, and how much of the clamp's is in that.
    pub(in crate::simulate) share: Lanes<L>,
    pub(in crate::simulate) own: Lanes<L>,
    /// The clamp's share before the step and after it.
    pub(in crate::simulate) clamped: [Lanes<L>; 2],
}

impl<const L: usize> Law<'_, L> {
    /// The clamp with a share z that follows the clamp's over a displacement d, as bristles do whose damping has a time
    /// constant, implicit, from that at the step's begin and the rate there.
    ///
    /// ```text
    /// share = z + tau z'      z' = max(|w|, w_s) / d ((1 - e) (c - z) + e sgn(c - z))      c = share(w)
    /// ```
    ///
    /// e is how straight they bend to their end. With a displacement below zero, which no bearing has and a fit may try, it is
    /// as far ahead.
    #[inline(always)]
    pub(in crate::simulate) fn following(
        &self,
        [from, before]: [Lanes<L>; 2],
        [rate, brake, level]: [Lanes<L>; 3],
        step_s: f64,
    ) -> Followed<L> {
        let late = self.follows_rad.signum();
        let damping_s = late.above(Lanes::all(0.0), self.damped_s, Lanes::all(0.0));
        let pull = brake * self.built_up(level, before);
        let [clamped_before, mut w] = [self.share(before), before];
        let mut all = Followed { w, zeta: from, share: from, own: w, clamped: [clamped_before; 2] };
        for _ in 0..PASSES {
            let Bends { of, onward } = self.bends(from, [before, w], step_s);
            let kept = of[0] * from + of[1] * clamped_before;
            let damped = damping_s * (onward[0] * from + onward[1] * clamped_before);
            let own = 1.0 + late * (of[2] - 1.0) + damping_s * onward[2];
            let before_own = late * kept + damped;
            let clamped;
            (w, clamped) = self.clamp(rate - pull * before_own, brake, level * own);
            let (zeta, share) = (kept + of[2] * clamped, before_own + own * clamped);
            all = Followed { w, zeta, share, own, clamped: [clamped_before, clamped] };
        }
        all
    }

    /// Bristles over a step between two rates.
    #[inline(always)]
    fn bends(&self, from: Lanes<L>, [before, w]: [Lanes<L>; 2], step_s: f64) -> Bends<L> {
        let fast = |w: Lanes<L>| w.abs().above(self.slip_radps, w.abs(), self.slip_radps);
        let (begin, end) = (fast(before), fast(w));
        let over_sum = 1.0 / (begin + end);
        // one over the displacements of the step, m: exp(-m) is 1 / (1 + m + m^2 / 2), and the clamp goes on a line
        let along = self.follows_rad.abs() * (2.0 / step_s) * over_sum;
        let whole = 1.0 / (along * along + along + 0.5);
        let (left, mean) = (along * whole, (along + 0.5) * whole);
        let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
        let far = (w.side() - from).abs() * along;
        let reaches = far.above(one, one / far, one);
        let bending = far.above(one, reaches, zero);
        let blend = |exponential: Lanes<L>, straight: Lanes<L>| exponential + self.straight * (straight - exponential);
        let rate = end * over_sum * (2.0 / step_s);
        Bends {
            of: [
                blend(along * left, one - reaches),
                blend(along * (mean - left), zero),
                blend(one - along * mean, reaches),
            ],
            onward: [
                zero - rate * blend(left, bending),
                zero - rate * blend(mean - left, zero),
                rate * blend(mean, bending),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::library::platform;
    use crate::simulate::{Begin, Friction, Inputs, Physics, Prediction, predict};

    fn following(base: &Physics, inputs: &Inputs, follows_rad: f64) -> Prediction {
        let physics = Physics { friction: Friction { follows_rad, ..base.friction }, ..base.clone() };
        predict(&physics, inputs, &Begin::at(&physics, inputs, 0.0, None), inputs.len())
    }

    /// `z' = (clamp(w / w_s) - z) / tau` through a turn at an even rate, with `tau = d / w_s` within the slip rate.
    #[test]
    fn closed_form_a_clamp_that_follows_is_late_by_its_displacement_over_the_slip_rate() {
        let (rows, follows_rad, rise) = (400, 1e-6, 0.2);
        let mut base = platform(&gimbal_model_file::ModelFile::default());
        let slip_radps = base.config.bearing.slip_rate_radps;
        let zero = || vec![0.0; rows];
        let rate = |k: usize| rise * (k as f64 - 200.0) * 1e-3;
        let mut inputs = Inputs {
            period_s: 1e-3,
            accel_mps2: [zero(), zero(), zero()],
            rate_radps: (0..rows).map(rate).collect(),
            ..Inputs::default()
        };
        inputs.complete(&base.config.bearing, 0.0);
        // a gimbal that hardly moves
        base.config.servo.gimbal_inertia_kg_m2 *= 1e6;
        let [clamp, late, ahead] =
            [0.0, follows_rad, -follows_rad].map(|own| following(&base, &inputs, own).friction_nm);
        let (late_s, level_nm) = (follows_rad / slip_radps, clamp[300]);
        for k in (0..rows).filter(|&k| rate(k).abs() < slip_radps) {
            // on a line, but for what is left of its begin
            let since_s = (rate(k) + slip_radps) / rise;
            let share = late_s * rise / slip_radps * (1.0 - (-since_s / late_s).exp());
            let lag = (clamp[k] - late[k]) / level_nm;
            assert!((lag - share).abs() < 3e-3, "row {k}: {lag} and {share}");
            assert!((ahead[k] - clamp[k] - lag * level_nm).abs() < 1e-3 * level_nm, "row {k}: {}", ahead[k]);
        }
        assert!((clamp[300] - late[300]).abs() < 1e-6 * clamp[300]);
    }

    /// Also where the bearing goes from one viscous law to the other, as fast as a rocket rolls.
    #[test]
    fn contract_a_clamp_that_follows_over_next_to_nothing_is_the_clamp() {
        let rows = 3000_usize;
        let base = platform(&gimbal_model_file::ModelFile::default());
        let wave =
            |size: f64, hz: f64| (0..rows).map(move |k| size * (std::f64::consts::TAU * hz * k as f64 * 1e-3).sin());
        let mut inputs = Inputs {
            period_s: 1e-3,
            accel_mps2: [wave(3.0, 0.7), wave(5.0, 1.1), wave(9.0, 0.4)].map(Iterator::collect),
            rate_radps: wave(18.0, 0.9).zip(wave(0.5, 7.0)).map(|(a, b)| a + b).collect(),
            ..Inputs::default()
        };
        inputs.complete(&base.config.bearing, 0.0);
        let [clamp, follows] = [0.0, 1e-13].map(|own| following(&base, &inputs, own).gyro_angle_rad);
        let peak = clamp.iter().fold(0.0, |peak: f64, own| peak.max(own.abs()));
        let apart = clamp.iter().zip(&follows).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(apart < 1e-5 * peak, "{apart:e} of {peak:e}");
    }
}
