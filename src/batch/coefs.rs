//! What the straight path reads of each lane's law, coefficient by coefficient, all lanes of one side by side.
//!
//! A lane's part of the law is put together anew inside each loop over lanes. The compiler sees that it is made of
//! neighbouring numbers and vectorises across lanes what the law's own functions do with it; what the straight path
//! does not read is zero there and costs nothing.

use crate::bearing::level;
use crate::build::modes::BLOCKS;
use crate::build::poles::ORDER;
use crate::law::Law;
use crate::row::{Row, ScaledRow};
use crate::state::{Regime, State};
use crate::{free, friction, guard};

/// A coefficient of `L` laws.
type Lanes<const L: usize> = [f32; L];

/// Coefficients of `L` laws.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Coefs<const L: usize> {
    pub(super) stop_angle: Lanes<L>,
    pub(super) small_angle: Lanes<L>,
    pub(super) stir: Lanes<L>,
    pub(super) ins_scale: Lanes<L>,
    /// Where the tables begin.
    pub(super) first_power: [i32; L],
    pub(super) first_viscous: [i32; L],
    guard: [Lanes<L>; 4],
    unbalance: [Lanes<L>; 2],
    level: [Lanes<L>; 10],
    friction: [Lanes<L>; 2],
    gimbal_rate: [Lanes<L>; ORDER + 1],
    blocks: [[Lanes<L>; 10]; BLOCKS],
    single: [Lanes<L>; 4],
    change: [Lanes<L>; 3],
    /// Inputs are held from row to row.
    pub(super) held_inputs: bool,
}

impl<const L: usize> Coefs<L> {
    pub(super) fn new(laws: &[&Law<f32>; L]) -> Self {
        Self {
            held_inputs: laws.first().is_some_and(|law| law.held_inputs),
            stop_angle: laws.map(|law| law.stop.angle),
            small_angle: laws.map(|law| law.small_angle),
            stir: laws.map(|law| law.stir),
            ins_scale: laws.map(|law| law.ins.scale),
            first_power: laws.map(|law| law.tables.power.first()),
            first_viscous: laws.map(|law| law.tables.viscous_high.first()),
            guard: side_by_side(laws, |law| {
                let guard::Law { radial_accel, axial_accel, rate, torque } = law.guard;
                [radial_accel, axial_accel, rate, torque]
            }),
            unbalance: side_by_side(laws, |law| law.unbalance.coefs),
            level: side_by_side(laws, |law| {
                let level = &law.level;
                let ([s0, s1], [a0, a1]) = (level.static_load.coefs, level.axial_load.coefs);
                let (static_preload, axial_preload) = (level.static_preload, level.axial_preload);
                let [radial] = level.radial_load.coefs;
                let (most, rate, low) = (level.largest_radial, level.viscous_break, level.viscous_low);
                [most, s0, s1, static_preload, a0, a1, axial_preload, radial, rate, low]
            }),
            friction: side_by_side(laws, |law| [law.friction.slip_rate, law.friction.steepness.coefs[0]]),
            gimbal_rate: side_by_side(laws, |law| law.free.gimbal_rate.coefs),
            blocks: core::array::from_fn(|block| {
                side_by_side(laws, |law| {
                    let free::Block { transition: [a, b, c, d], drive, gimbal_angle, motor_torque } =
                        law.free.blocks[block];
                    let ([e, f], [g, h], [i, j]) = (drive, gimbal_angle, motor_torque);
                    [a, b, c, d, e, f, g, h, i, j]
                })
            }),
            single: side_by_side(laws, |law| {
                let free::Single { transition, drive, gimbal_angle, motor_torque } = law.free.single;
                [transition, drive, gimbal_angle, motor_torque]
            }),
            change: side_by_side(laws, |law| {
                [law.free.gimbal_angle, law.free.motor_torque, law.free.gimbal_rate_gain.coefs[0]]
            }),
        }
    }

    /// All bits for a lane that may take the straight path.
    pub(super) fn may(&self, law: &Law<f32>, state: &State<f32>) -> u32 {
        let is_like_others = !law.cross_coupling && law.held_inputs == self.held_inputs;
        if is_like_others && state.regime == Regime::Free { u32::MAX } else { 0 }
    }

    #[inline(always)]
    pub(super) fn guard(&self, lane: usize) -> guard::Law<f32> {
        let [radial_accel, axial_accel, rate, torque] = at(&self.guard, lane);
        guard::Law { radial_accel, axial_accel, rate, torque }
    }

    #[inline(always)]
    pub(super) fn unbalance(&self, lane: usize) -> Row<f32, 2> {
        Row { coefs: at(&self.unbalance, lane) }
    }

    #[inline(always)]
    pub(super) fn level(&self, lane: usize) -> level::Law<f32> {
        let [largest_radial, s0, s1, static_preload, a0, a1, axial_preload, radial, viscous_break, viscous_low] =
            at(&self.level, lane);
        level::Law {
            largest_radial,
            static_load: Row { coefs: [s0, s1] },
            static_preload,
            axial_load: Row { coefs: [a0, a1] },
            axial_preload,
            radial_load: Row { coefs: [radial] },
            shift: 0,
            viscous_break,
            viscous_low,
        }
    }

    #[inline(always)]
    pub(super) fn friction(&self, lane: usize) -> friction::Law<f32> {
        let [slip_rate, steepness] = at(&self.friction, lane);
        friction::Law { slip_rate, steepness: ScaledRow { coefs: [steepness], shift: 0 } }
    }

    #[inline(always)]
    pub(super) fn free(&self, lane: usize) -> free::Law<f32> {
        let block = |block: usize| {
            let [a, b, c, d, e, f, g, h, i, j] = at(&self.blocks[block], lane);
            free::Block { transition: [a, b, c, d], drive: [e, f], gimbal_angle: [g, h], motor_torque: [i, j] }
        };
        let [transition, drive, gimbal_angle, motor_torque] = at(&self.single, lane);
        let single = free::Single { transition, drive, gimbal_angle, motor_torque };
        let [gimbal_angle, motor_torque, gimbal_rate_gain] = at(&self.change, lane);
        free::Law {
            gimbal_rate: Row { coefs: at(&self.gimbal_rate, lane) },
            blocks: [block(0), block(1), block(2), block(3)],
            single,
            gimbal_angle,
            motor_torque,
            gyro_angle: Row { coefs: [0.0; ORDER + 1] },
            gimbal_rate_gain: Row { coefs: [gimbal_rate_gain] },
            gyro_move: UNREAD,
            motor: [UNREAD; 6],
            entry: [UNREAD; ORDER],
        }
    }
}

/// What the straight path does not read.
const UNREAD: ScaledRow<f32, ORDER> = ScaledRow { coefs: [0.0; ORDER], shift: 0 };

fn side_by_side<const C: usize, const L: usize>(
    laws: &[&Law<f32>; L],
    coefs: impl Fn(&Law<f32>) -> [f32; C],
) -> [Lanes<L>; C] {
    let mut table = [[0.0; L]; C];
    for (lane, law) in laws.iter().enumerate() {
        for (lanes, coef) in table.iter_mut().zip(coefs(law)) {
            lanes[lane] = coef;
        }
    }
    table
}

#[inline(always)]
fn at<const C: usize, const L: usize>(table: &[Lanes<L>; C], lane: usize) -> [f32; C] {
    core::array::from_fn(|i| table[i][lane])
}
