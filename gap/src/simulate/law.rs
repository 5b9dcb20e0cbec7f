//! What each prediction is made of, lane by lane: bearings, torques on the gimbal and on the float, motor, pick-off.

mod bristles;
mod friction;

use super::Physics;
use super::bearing::Viscous;
use super::cable::Stops;
use super::chain::{PHI, PHI_RATE};
use super::corner::{Corner, Corners};
use super::inputs::{Inputs, turned};
use super::lanes::Lanes;
use super::noisy::motor_nm;
use super::now::Now;

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
    /// One over that.
    over_slip_s: Lanes<L>,
    corner: [Corner; L],
    corners: Corners<L>,
    follows_rad: Lanes<L>,
    damped_s: Lanes<L>,
    straight: Lanes<L>,
    /// Whether the clamp follows the rate over a displacement, in all lanes.
    pub(super) follows: bool,
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
    rate_bias_radps: Lanes<L>,
    turns: [Lanes<L>; 3],
    is_turned: bool,
    curved: Lanes<L>,
    is_curved: bool,
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
            slip_radps: of(&Physics::slip_rate_radps),
            over_slip_s: of(&|own| 1.0 / own.slip_rate_radps()),
            corner: physics.map(|own| own.friction.corner),
            corners: Corners::new(physics.map(|own| own.friction.corner)),
            follows_rad: of(&|own| own.friction.follows_rad),
            straight: of(&|own| own.friction.straight),
            damped_s: of(&|own| own.friction.damped_s),
            follows: physics[0].friction.follows(),
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
            rate_bias_radps: of(&|own| own.measurement.rate_bias_radps),
            turns: [0, 1, 2].map(|axis| of(&|own| own.turned_rad[axis])),
            curved: of(&|own| own.curved),
            is_curved: any(&|own| own.curved.abs() > 0.0),
            is_turned: any(&|own| own.turned_rad.iter().any(|angle| angle.abs() > 0.0)),
            shaped_friction: any(&|own| {
                own.friction.per_g != 0.0 || own.friction.stribeck.is_some() || own.friction.drift.is_some()
            }),
            presliding: physics[0].friction.presliding_rad > 0.0,
            has_hysteresis: any(&|own| own.hysteresis.is_some()),
            has_ripple: any(&|own| own.ripple.is_some()),
            bends: any(&|own| own.has_corners()),
            quantised: any(&|own| own.quantum_rad > 0.0),
            physics,
        }
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

    /// Share of the cable's loop where a run begins.
    pub(super) fn wound(&self) -> Lanes<L> {
        Lanes::each(|lane| self.physics[lane].hysteresis.map_or(0.0, |cable| cable.wound))
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

    /// What the motor makes of a command.
    #[inline(always)]
    pub(super) fn motor(&self, command_nm: Lanes<L>) -> Lanes<L> {
        if !self.bends {
            return command_nm;
        }
        let mut torque = command_nm;
        for lane in 0..L {
            torque[lane] = motor_nm(self.physics[lane], torque[lane]);
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

    /// Rate, accelerations and load, as the platform has them.
    #[inline(always)]
    pub(super) fn aligned(&self, now: &mut Now<L>, logged: [f64; 3], load_by_turn: [f64; 2]) {
        now.rate = now.rate - self.rate_bias_radps;
        if !self.is_turned {
            return;
        }
        let [about_x, about_y, about_z] = self.turns;
        now.accel = turned(logged.map(Lanes::all), [about_x, about_y, about_z]);
        now.load += about_x * load_by_turn[0] + about_y * load_by_turn[1];
    }

    /// Inputs that run along curves between rows.
    #[inline(always)]
    pub(super) fn between_rows(&self, now: &mut Now<L>, inputs: &Inputs, k: usize) {
        if !self.is_curved {
            return;
        }
        let curve = &inputs.curve;
        for axis in 0..3 {
            now.accel[axis] += self.curved * curve.accel_mps2[axis][k];
        }
        now.bend = self.curved * curve.rate_radps[k];
        now.rate += now.bend;
        now.bulge += self.curved * inputs.bulge_by_curve_nm[k];
    }
}
