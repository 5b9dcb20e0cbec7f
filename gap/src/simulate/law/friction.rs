//! The bearings' friction: its level, the clamp, steps that cross a corner, build-up over a displacement.

use super::Law;
use crate::simulate::GRAVITY_MPS2;
use crate::simulate::corner::NO_CORNER;
use crate::simulate::lanes::{Lanes, side, within};
use crate::simulate::now::Now;
use crate::simulate::physics::BuildUp;
use crate::simulate::sprung::{Chain, Forces};

/// How often a step of bristles is taken, each time by the rate at its end of the last.
const PASSES: usize = 3;

/// Share of the friction that bristles have after a step, and how fast that goes on then [1/s]: of the share before, of the clamp's
/// before, and of the clamp's after.
struct Bends<const L: usize> {
    of: [Lanes<L>; 3],
    onward: [Lanes<L>; 3],
}

impl<const L: usize> Law<'_, L> {
    /// `T_load + T_visc` and what effects make of it.
    #[inline(always)]
    pub(in crate::simulate) fn level(&self, now: &Now<L>, w: Lanes<L>) -> Lanes<L> {
        if self.no_bearing {
            return Lanes::all(0.0);
        }
        if self.shaped_friction || w.any(w, |w, _| w.abs() > self.break_radps) {
            let mut level = w;
            for lane in 0..L {
                level[lane] = self.shaped(lane, now, w[lane]);
            }
            return level;
        }
        now.load * self.load_factor + self.slow_nm
    }

    /// The level of one lane with every effect.
    fn shaped(&self, lane: usize, now: &Now<L>, w: f64) -> f64 {
        let friction = &self.physics[lane].friction;
        let mut load = now.load[lane] * friction.load_factor;
        if friction.per_g != 0.0 {
            load *= 1.0 + friction.per_g * now.accel[0][lane].hypot(now.accel[1][lane]) / GRAVITY_MPS2;
        }
        let mut level = load + self.viscous[lane].torque_nm(w.abs()) * friction.viscous_factor;
        if let Some(stribeck) = friction.stribeck {
            level += stribeck.torque_nm(w);
        }
        if let Some([ratio, time_s]) = friction.drift {
            level *= 1.0 - ratio * (-now.time_s / time_s).exp_m1();
        }
        level
    }

    /// Friction fully built up, by its direction.
    #[inline(always)]
    pub(in crate::simulate) fn built_up(&self, level: Lanes<L>, w: Lanes<L>) -> Lanes<L> {
        level * (1.0 + self.asymmetry * w.side())
    }

    /// Share of the friction that is there at a rate: `clamp(x)` and what its corners have more, `x = w / w_s`.
    #[inline(always)]
    pub(in crate::simulate) fn share(&self, w: Lanes<L>) -> Lanes<L> {
        let x = w / self.slip_radps;
        let clamp = x.within(1.0);
        if self.is_round_at(w) { clamp + self.rounding(x) } else { clamp }
    }

    /// The clamp, implicit: `w + brake level share(w) = rate`: w, share of the friction. What is round of it is a small part,
    /// and taken where the clamp by itself ends.
    #[inline(always)]
    pub(in crate::simulate) fn clamp(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
        let mut w = self.hard(rate, brake, level);
        if self.is_round_at(w) {
            let round = self.rounding(w / self.slip_radps);
            w = self.hard(rate - brake * self.built_up(level, w) * round, brake, level);
        }
        (w, self.share(w))
    }

    /// The same with a share z that follows the clamp's over a displacement d, as bristles do whose damping has a time
    /// constant, implicit, from that at the step's begin and the rate there: w, z, share of the friction, and how much of the
    /// clamp's is in that.
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
    ) -> [Lanes<L>; 4] {
        let late = self.follows_rad.signum();
        let damping_s = late.above(Lanes::all(0.0), self.damped_s, Lanes::all(0.0));
        let pull = brake * self.built_up(level, before);
        let [clamped_before, mut w] = [self.share(before), before];
        let mut all = [w; 4];
        for _ in 0..PASSES {
            let Bends { of, onward } = self.bends(from, [before, w], step_s);
            let kept = of[0] * from + of[1] * clamped_before;
            let damped = damping_s * (onward[0] * from + onward[1] * clamped_before);
            let own = 1.0 + late * (of[2] - 1.0) + damping_s * onward[2];
            let before_own = late * kept + damped;
            let clamped;
            (w, clamped) = self.clamp(rate - pull * before_own, brake, level * own);
            all = [w, kept + of[2] * clamped, before_own + own * clamped, own];
        }
        all
    }

    /// Bristles over a step between two rates.
    #[inline(always)]
    fn bends(&self, from: Lanes<L>, [before, w]: [Lanes<L>; 2], step_s: f64) -> Bends<L> {
        let fast = |w: Lanes<L>| w.abs().above(self.slip_radps, w.abs(), self.slip_radps);
        let (begin, end) = (fast(before), fast(w));
        // one over the displacements of the step, m: exp(-m) is 1 / (1 + m + m^2 / 2), and the clamp goes on a line
        let along = self.follows_rad.abs() / (0.5 * step_s * (begin + end));
        let whole = along * along + along + 0.5;
        let (left, mean) = (along / whole, (along + 0.5) / whole);
        let (zero, one) = (Lanes::all(0.0), Lanes::all(1.0));
        let far = (w.side() - from).abs() * along;
        let reaches = far.above(one, one / far, one);
        let bending = far.above(one, reaches, zero);
        let blend = |exponential: Lanes<L>, straight: Lanes<L>| exponential + self.straight * (straight - exponential);
        let rate = end / (begin + end) * (2.0 / step_s);
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

    /// What the corners have more than a clamp, at a rate over the slip rate.
    #[inline(always)]
    fn rounding(&self, x: Lanes<L>) -> Lanes<L> {
        Lanes::each(|lane| self.corner[lane].rounding(x[lane]))
    }

    /// Whether any of the rates is near a round corner.
    #[inline(always)]
    fn is_round_at(&self, w: Lanes<L>) -> bool {
        self.is_round && (self.has_tails || w.any(self.slip_radps, |w, slip| w.abs() < NO_CORNER * slip))
    }

    #[inline(always)]
    fn hard(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> Lanes<L> {
        let slip = self.slip_radps;
        let pull = brake * self.built_up(level, rate);
        rate.abs().above(slip + pull, rate - pull * rate.signum(), rate / (1.0 + pull / slip))
    }

    /// Whether a step crosses a corner of the clamp, or goes from one viscous law to the other.
    #[inline(always)]
    pub(in crate::simulate) fn crosses(&self, before: Lanes<L>, after: Lanes<L>) -> bool {
        let slip = self.slip_radps;
        let apart = |a: f64, b: f64, edge: f64| (a < edge) != (b < edge);
        let mut any = false;
        for lane in 0..L {
            let (a, b, slip) = (before[lane], after[lane], slip[lane]);
            any |= apart(a, b, slip) | apart(a, b, -slip);
        }
        any || before.any(before, |w, _| w.abs() >= self.break_radps)
            || after.any(after, |w, _| w.abs() >= self.break_radps)
    }

    /// Mean friction of a step of one lane that crosses a corner: from w and friction before to those after.
    pub(in crate::simulate) fn mean_nm(
        &self,
        lane: usize,
        level: f64,
        before: [f64; 2],
        after: [f64; 2],
    ) -> Option<f64> {
        let ([from, friction_before], [w, friction]) = (before, after);
        let (slip, asymmetry) = (self.slip_radps[lane], self.asymmetry[lane]);
        let (low, high) = (from.min(w), from.max(w));
        let crosses = (low < -slip && high > -slip) || (low < slip && high > slip);
        if crosses && high - low > 1e-9 {
            let corner = self.corner[lane];
            let area = |w: f64| {
                let a = w.abs();
                let hard = if a > slip { a - 0.5 * slip } else { 0.5 * a * a / slip };
                let round = if corner.is_round() { slip * corner.rounded_area(a / slip) } else { 0.0 };
                level * (1.0 + asymmetry * side(w)) * (hard + round)
            };
            return Some((area(high) - area(low)) / (high - low));
        }
        // the two viscous laws do not meet
        let edge = self.viscous[lane].break_radps();
        let crosses = (low < edge && high > edge) || (low < -edge && high > -edge);
        let share = (edge - from.abs()) / (w.abs() - from.abs());
        crosses.then_some(friction_before + (1.0 - share) * (friction - friction_before))
    }

    /// Dahl's build-up of one lane over the displacement of a step, in one of its formulations: w that is left, share built
    /// up of what builds up, and share of all friction.
    pub(in crate::simulate) fn build_up(
        &self,
        lane: usize,
        from: [f64; 2],
        [rate, brake, level, step_s]: [f64; 4],
    ) -> [f64; 3] {
        let [before, zeta_before] = from;
        let friction = &self.physics[lane].friction;
        let (along, slip) = (friction.presliding_rad, self.slip_radps[lane]);
        let clamp = |w: f64| within(w / slip, 1.0) + friction.corner.rounding(w / slip);
        let full = |w: f64| if friction.builds_up == BuildUp::OnClamp { clamp(w) } else { side(w) };
        let clamped = if friction.builds_up == BuildUp::LoadAlone {
            (self.viscous[lane].torque_nm(rate.abs()) * friction.viscous_factor / level.max(1e-30)).min(1.0)
        } else {
            0.0
        };
        // the clamp of what does not build up is implicit
        let left = |zeta: f64| {
            let (w, pull) = (rate - brake * level * (1.0 - clamped) * zeta, brake * level * clamped);
            if w.abs() > slip + pull { w - pull * w.signum() } else { w / (1.0 + pull / slip) }
        };
        let mut zeta = zeta_before;
        for _ in 0..3 {
            let w = left(zeta);
            let leg = |zeta: f64, w: f64, moved: f64| {
                let full = full(w);
                full + (zeta - full) * (-moved.abs() / along).exp()
            };
            zeta = if w * before < 0.0 {
                let share = before / (before - w);
                let turned = leg(zeta_before, 0.5 * before, 0.5 * before * share * step_s);
                leg(turned, 0.5 * w, 0.5 * w * (1.0 - share) * step_s)
            } else {
                leg(zeta_before, 0.5 * (before + w), 0.5 * (before + w) * step_s)
            };
        }
        let w = left(zeta);
        [w, zeta, (1.0 - clamped) * zeta + clamped * within(w / slip, 1.0)]
    }

    /// Whether friction is behind springs.
    pub(in crate::simulate) fn is_sprung(&self, lane: usize) -> bool {
        self.physics[lane].friction.builds_up == BuildUp::Sprung
    }

    /// The springs' build-up of one lane over a step: as for the others, and the springs' forces.
    pub(in crate::simulate) fn sprung(
        &self,
        lane: usize,
        before: f64,
        forces: Forces,
        [rate, brake, level, step_s]: [f64; 4],
    ) -> ([f64; 3], Forces) {
        let along = self.physics[lane].friction.presliding_rad;
        let chain = Chain::new([along, self.slip_radps[lane]], forces, before, step_s);
        let (w, share, forces) = chain.solve(rate, brake * level);
        ([w, share, share], forces)
    }

    /// Friction that the load's bulge above the line adds.
    #[inline(always)]
    pub(in crate::simulate) fn bulge_nm(&self, now: &Now<L>, zeta: Lanes<L>) -> Lanes<L> {
        if self.no_bearing { Lanes::all(0.0) } else { now.bulge * self.load_factor * zeta }
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
