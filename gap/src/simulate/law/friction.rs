//! The bearings' friction: its level, the clamp, steps that cross a corner, build-up over a displacement.

use super::Law;
use crate::simulate::GRAVITY_MPS2;
use crate::simulate::corner::Corners;
use crate::simulate::lanes::{Lanes, side, within};
use crate::simulate::now::Now;
use crate::simulate::physics::BuildUp;
use crate::simulate::sprung::Flow;

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
        let x = w * self.over_slip_s;
        let clamp = x.within(1.0);
        if self.corners.are_round_at(x) { clamp + self.corners.rounding(x) } else { clamp }
    }

    /// The clamp, implicit: `w + brake level share(w) = rate`: w, share of the friction. What is round of it is a small part,
    /// and taken where the clamp by itself ends.
    #[inline(always)]
    pub(in crate::simulate) fn clamp(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
        let mut w = self.hard(rate, brake, level);
        let x = w * self.over_slip_s;
        if self.corners.are_round_at(x) {
            let round = self.corners.rounding(x);
            w = self.hard(rate - brake * self.built_up(level, w) * round, brake, level);
        }
        (w, self.share(w))
    }

    #[inline(always)]
    fn hard(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> Lanes<L> {
        let pull = brake * self.built_up(level, rate);
        let least = self.slip_radps + pull;
        let slips = rate - pull * rate.signum();
        // a quotient that nothing waits for where all slip
        if rate.any(least, |rate, least| rate.abs() <= least) {
            rate.abs().above(least, slips, rate / (1.0 + pull * self.over_slip_s))
        } else {
            slips
        }
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
        let corner = Corners::new([self.corner[lane]]);
        let clamp = |w: f64| within(w / slip, 1.0) + corner.rounding(Lanes::all(w / slip))[0];
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

    /// What steps of so many lengths do to the springs before the friction, where it is behind some.
    pub(in crate::simulate) fn flows<const S: usize>(&self, lane: usize, steps_s: [f64; S]) -> Option<[Flow; S]> {
        let friction = &self.physics[lane].friction;
        let along = [friction.presliding_rad, self.slip_radps[lane]];
        (friction.builds_up == BuildUp::Sprung).then(|| steps_s.map(|step_s| Flow::new(along, step_s)))
    }

    /// Friction that the load's bulge above the line adds.
    #[inline(always)]
    pub(in crate::simulate) fn bulge_nm(&self, now: &Now<L>, zeta: Lanes<L>) -> Lanes<L> {
        if self.no_bearing { Lanes::all(0.0) } else { now.bulge * self.load_factor * zeta }
    }
}
