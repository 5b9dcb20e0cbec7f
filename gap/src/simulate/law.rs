//! What each prediction is made of, lane by lane: bearings, torques on the gimbal and on the float, motor, pick-off.

use super::Physics;
use super::bearing::Viscous;
use super::cable::Stops;
use super::chain::{PHI, PHI_RATE};
use super::corner::{NO_CORNER, rounded_area, rounding};
use super::inputs::turned;
use super::lanes::{Lanes, side, within};
use super::now::Now;
use super::physics::BuildUp;
use super::sprung::{Chain, Forces};

const GRAVITY_MPS2: f64 = 9.806_65;

#[allow(clippy::struct_excessive_bools, reason = "what any of the lanes has")]
/// The parameters of all lanes; an effect that a lane does not have has no size there.
pub(super) struct Law<'a, const L: usize> {
    pub(super) physics: [&'a Physics; L],
    viscous: [Viscous; L],
    no_bearing: bool,
    /// Least break between the viscous laws, and what is below it.
    break_radps: f64,
    slow_nm: Lanes<L>,
    load_factor: Lanes<L>,
    asymmetry: Lanes<L>,
    pub(super) slip_radps: Lanes<L>,
    roundness: Lanes<L>,
    is_round: bool,
    pub(super) stop_rad: Lanes<L>,
    unbalance_kg_m: [Lanes<L>; 2],
    constant_nm: Lanes<L>,
    anisoelasticity: Lanes<L>,
    cross_axis_kg_m2: Lanes<L>,
    spring_nm_per_rad: Lanes<L>,
    viscous_nm_s: Lanes<L>,
    quadratic_nm_s2: Lanes<L>,
    float_nm: Lanes<L>,
    float_kg_m: Lanes<L>,
    turns: [Lanes<L>; 3],
    is_turned: bool,
    shaped_friction: bool,
    /// Whether friction builds up over a displacement, in all lanes.
    pub(super) presliding: bool,
    pub(super) has_hysteresis: bool,
    has_ripple: bool,
    /// Whether the motor has a corner.
    pub(super) bends: bool,
    pub(super) quantised: bool,
}

impl<'a, const L: usize> Law<'a, L> {
    pub(super) fn new(physics: [&'a Physics; L]) -> Self {
        let viscous = physics.map(|own| Viscous::new(&own.config.bearing));
        let of = |of: &dyn Fn(&Physics) -> f64| Lanes::each(|lane| of(physics[lane]));
        let any = |of: &dyn Fn(&Physics) -> bool| physics.iter().any(|own| of(own));
        Self {
            break_radps: viscous.iter().map(Viscous::break_radps).fold(f64::MAX, f64::min),
            slow_nm: Lanes::each(|lane| viscous[lane].torque_nm(0.0) * physics[lane].friction.viscous_factor),
            viscous,
            no_bearing: physics[0].config.bearing.count == 0,
            load_factor: of(&|own| own.friction.load_factor),
            asymmetry: of(&|own| own.friction.asymmetry),
            slip_radps: of(&|own| own.config.bearing.slip_rate_radps),
            roundness: of(&|own| own.friction.roundness),
            is_round: any(&|own| own.friction.roundness != 0.0),
            stop_rad: of(&Physics::stop_rad),
            unbalance_kg_m: [of(&|own| own.config.unbalance.x_kg_m), of(&|own| own.config.unbalance.y_kg_m)],
            constant_nm: of(&|own| own.constant_nm),
            anisoelasticity: of(&|own| own.anisoelasticity),
            cross_axis_kg_m2: of(&|own| own.cross_axis_kg_m2),
            spring_nm_per_rad: of(&|own| own.spring_nm_per_rad),
            viscous_nm_s: of(&|own| own.friction.viscous_nm_s),
            quadratic_nm_s2: of(&|own| own.friction.quadratic_nm_s2),
            float_nm: of(&|own| own.float_nm),
            float_kg_m: of(&|own| own.float_kg_m),
            turns: [0, 1, 2].map(|axis| of(&|own| own.turned_rad[axis])),
            is_turned: any(&|own| own.turned_rad.iter().any(|angle| angle.abs() > 0.0)),
            shaped_friction: any(&|own| {
                own.friction.per_g != 0.0 || own.friction.stribeck.is_some() || own.friction.drift.is_some()
            }),
            presliding: physics[0].friction.presliding_rad > 0.0,
            has_hysteresis: any(&|own| own.hysteresis.is_some()),
            has_ripple: any(&|own| own.ripple.is_some()),
            bends: any(&|own| own.limit_nm.is_some() || own.dead_zone_nm > 0.0),
            quantised: any(&|own| own.quantum_rad > 0.0),
            physics,
        }
    }

    /// `T_load + T_visc` and what effects make of it.
    #[inline(always)]
    pub(super) fn level(&self, now: &Now<L>, w: Lanes<L>) -> Lanes<L> {
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
    pub(super) fn built_up(&self, level: Lanes<L>, w: Lanes<L>) -> Lanes<L> {
        level * (1.0 + self.asymmetry * w.side())
    }

    /// Share of the friction that is there at a rate: `clamp(x) + roundness (round(x) - clamp(x))`, `x = w / w_s`.
    #[inline(always)]
    pub(super) fn share(&self, w: Lanes<L>) -> Lanes<L> {
        let x = w / self.slip_radps;
        let clamp = x.within(1.0);
        if self.is_round_at(w) { clamp + self.roundness * x.map(rounding) } else { clamp }
    }

    /// The clamp, implicit: `w + brake level share(w) = rate`: w, share of the friction. What is round of it is a small part,
    /// and taken where the clamp by itself ends.
    #[inline(always)]
    pub(super) fn clamp(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
        let mut w = self.hard(rate, brake, level);
        if self.is_round_at(w) {
            let round = self.roundness * (w / self.slip_radps).map(rounding);
            w = self.hard(rate - brake * self.built_up(level, w) * round, brake, level);
        }
        (w, self.share(w))
    }

    /// Whether any of the rates is near a round corner.
    #[inline(always)]
    fn is_round_at(&self, w: Lanes<L>) -> bool {
        self.is_round && w.any(self.slip_radps, |w, slip| w.abs() < NO_CORNER * slip)
    }

    #[inline(always)]
    fn hard(&self, rate: Lanes<L>, brake: Lanes<L>, level: Lanes<L>) -> Lanes<L> {
        let slip = self.slip_radps;
        let pull = brake * self.built_up(level, rate);
        rate.abs().above(slip + pull, rate - pull * rate.signum(), rate / (1.0 + pull / slip))
    }

    /// Whether a step crosses a corner of the clamp, or goes from one viscous law to the other.
    #[inline(always)]
    pub(super) fn crosses(&self, before: Lanes<L>, after: Lanes<L>) -> bool {
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
    pub(super) fn mean_nm(&self, lane: usize, level: f64, before: [f64; 2], after: [f64; 2]) -> Option<f64> {
        let ([from, friction_before], [w, friction]) = (before, after);
        let (slip, asymmetry) = (self.slip_radps[lane], self.asymmetry[lane]);
        let (low, high) = (from.min(w), from.max(w));
        let crosses = (low < -slip && high > -slip) || (low < slip && high > slip);
        if crosses && high - low > 1e-9 {
            let roundness = self.roundness[lane];
            let area = |w: f64| {
                let a = w.abs();
                let hard = if a > slip { a - 0.5 * slip } else { 0.5 * a * a / slip };
                let round = if roundness == 0.0 { 0.0 } else { roundness * slip * rounded_area(a / slip) };
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
    pub(super) fn build_up(&self, lane: usize, from: [f64; 2], [rate, brake, level, step_s]: [f64; 4]) -> [f64; 3] {
        let [before, zeta_before] = from;
        let friction = &self.physics[lane].friction;
        let (along, slip) = (friction.presliding_rad, self.slip_radps[lane]);
        let clamp = |w: f64| within(w / slip, 1.0) + friction.roundness * rounding(w / slip);
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
    pub(super) fn is_sprung(&self, lane: usize) -> bool {
        self.physics[lane].friction.builds_up == BuildUp::Sprung
    }

    /// The springs' build-up of one lane over a step: as for the others, and the springs' forces.
    pub(super) fn sprung(
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

    /// Torques on the gimbal but for the bearings', and what the motor fails to give of its command.
    #[inline(always)]
    pub(super) fn others<const N: usize>(
        &self,
        now: &Now<L>,
        x: &[Lanes<L>; N],
        hysteresis: Lanes<L>,
        command: impl Fn(&[Lanes<L>; N]) -> Lanes<L>,
    ) -> Lanes<L> {
        let [ax, ay, _] = now.accel;
        let [x_kg_m, y_kg_m] = self.unbalance_kg_m;
        let w = now.rate - x[PHI_RATE];
        let rel = now.turned - x[PHI];
        let mut torque = x_kg_m * ay - y_kg_m * ax
            + self.constant_nm
            + self.anisoelasticity * ax * ay
            + self.cross_axis_kg_m2 * now.rate * now.cross
            + self.spring_nm_per_rad * rel
            + (self.viscous_nm_s + self.quadratic_nm_s2 * w.abs()) * w;
        if self.has_hysteresis || self.has_ripple {
            for lane in 0..L {
                torque[lane] = self.with_cable_and_ripple(lane, torque[lane], rel[lane], hysteresis[lane]);
            }
        }
        if self.bends {
            let command = command(x);
            torque += command - self.motor(command);
        }
        torque
    }

    fn with_cable_and_ripple(&self, lane: usize, mut torque: f64, rel: f64, hysteresis: f64) -> f64 {
        if let Some(cable) = self.physics[lane].hysteresis {
            torque += cable.torque_nm * hysteresis;
        }
        if let Some(ripple) = self.physics[lane].ripple {
            let (sine, cosine) = (ripple.cycles * rel).sin_cos();
            torque += ripple.sine_nm * sine + ripple.cosine_nm * cosine;
        }
        torque
    }

    /// The cable's stops where a run begins.
    pub(super) fn stops(&self, share: Lanes<L>) -> Stops<L> {
        Stops::new(self.physics.iter().filter_map(|own| own.hysteresis), share)
    }

    /// Share of the cable's loop after the gimbal has turned.
    #[inline(always)]
    pub(super) fn hysteresis_after(&self, z: Lanes<L>, turned_rad: Lanes<L>, stops: &mut Stops<L>) -> Lanes<L> {
        let mut after = z;
        for lane in 0..L {
            if let Some(cable) = self.physics[lane].hysteresis {
                after[lane] = cable.after(lane, z[lane], turned_rad[lane], stops);
            }
        }
        after
    }

    #[inline(always)]
    pub(super) fn float_nm(&self, now: &Now<L>) -> Lanes<L> {
        self.float_nm + self.float_kg_m * now.accel[0]
    }

    /// Friction that the load's bulge above the line adds.
    #[inline(always)]
    pub(super) fn bulge_nm(&self, now: &Now<L>, zeta: Lanes<L>) -> Lanes<L> {
        now.bulge * self.load_factor * zeta
    }

    /// What the motor makes of a command.
    #[inline(always)]
    pub(super) fn motor(&self, command_nm: Lanes<L>) -> Lanes<L> {
        if !self.bends {
            return command_nm;
        }
        let mut torque = command_nm;
        for lane in 0..L {
            let physics = self.physics[lane];
            let clamped = within(torque[lane], physics.limit_nm.unwrap_or(f64::INFINITY));
            torque[lane] = clamped - within(clamped, physics.dead_zone_nm);
        }
        torque
    }

    /// Whether the motor's torque is near a corner of its characteristic.
    pub(super) fn motor_bends(&self, lane: usize, command_nm: f64) -> bool {
        let physics = self.physics[lane];
        let (dead_nm, limit_nm) = (physics.dead_zone_nm, physics.limit_nm.unwrap_or(f64::MAX));
        if dead_nm <= 0.0 && limit_nm >= f64::MAX {
            return false;
        }
        let command = command_nm.abs();
        command < 2.0 * dead_nm || command > 0.95 * limit_nm
    }

    /// The angle as the pick-off shows it.
    #[inline(always)]
    pub(super) fn seen(&self, theta: Lanes<L>) -> Lanes<L> {
        if !self.quantised {
            return theta;
        }
        let mut seen = theta;
        for lane in 0..L {
            let quantum = self.physics[lane].quantum_rad;
            if quantum > 0.0 {
                seen[lane] = quantum * (theta[lane] / quantum).round();
            }
        }
        seen
    }

    /// Accelerations and load, as the platform has them.
    #[inline(always)]
    pub(super) fn aligned(&self, now: &mut Now<L>, logged: [f64; 3], load_by_turn: [f64; 2]) {
        if !self.is_turned {
            return;
        }
        let [about_x, about_y, about_z] = self.turns;
        now.accel = turned(logged.map(Lanes::all), [about_x, about_y, about_z]);
        now.load += about_x * load_by_turn[0] + about_y * load_by_turn[1];
    }
}
