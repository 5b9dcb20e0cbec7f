//! What the straight path reads of each lane's law, coefficient by coefficient, all lanes of one side by side.
//!
//! A lane's part of the law is put together anew inside each loop over lanes. The compiler sees that it is made of
//! neighbouring numbers and vectorises across lanes what the law's own functions do with it; what the straight path
//! does not read is zero there and costs nothing.

use crate::bearing::level;
use crate::build::modes::BLOCKS;
use crate::build::poles::ORDER;
use crate::law::Law;
use crate::row::Row;
use crate::state::{Regime, State};
use crate::{free, friction, guard};

/// A coefficient of `L` laws.
type Lanes<const L: usize> = [f32; L];

/// Coefficients of `L` laws.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Coefs<const L: usize> {
    pub(super) stop_limit: [u32; L],
    pub(super) small_angle: [u32; L],
    pub(super) ins_scale: Lanes<L>,
    /// Where the tables begin.
    pub(super) first_power: [i32; L],
    pub(super) first_viscous: [i32; L],
    guard: [[u32; L]; 4],
    unbalance: [Lanes<L>; 2],
    level: [Lanes<L>; 8],
    viscous_break: [u32; L],
    friction: [Lanes<L>; 2],
    gimbal_rate: [Lanes<L>; ORDER],
    gimbal_angle: [Lanes<L>; ORDER],
    motor_torque: [Lanes<L>; ORDER],
    blocks: [[Lanes<L>; 6]; BLOCKS],
    single: [Lanes<L>; 2],
    change: [Lanes<L>; 2],
    /// Inputs are held from row to row.
    pub(super) held_inputs: bool,
}

impl<const L: usize> Coefs<L> {
    pub(super) fn new(laws: &[&Law<f32>; L]) -> Self {
        Self {
            held_inputs: laws.first().is_some_and(|law| law.held_inputs),
            stop_limit: laws.map(|law| law.stop_limit),
            small_angle: laws.map(|law| law.small_angle),
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
                [f32::from_bits(level.largest_radial), s0, s1, static_preload, a0, a1, axial_preload, level.viscous_low]
            }),
            viscous_break: laws.map(|law| law.level.viscous_break),
            friction: side_by_side(laws, |law| [law.friction.slip_rate, law.friction.steepness]),
            gimbal_rate: side_by_side(laws, |law| law.free.gimbal_rate),
            gimbal_angle: side_by_side(laws, |law| law.free.gimbal_angle),
            motor_torque: side_by_side(laws, |law| law.instant.motor_torque.coefs),
            blocks: core::array::from_fn(|block| {
                side_by_side(laws, |law| {
                    let free::Block { transition: [a, b, c, d], drive: [e, f] } = law.free.blocks[block];
                    [a, b, c, d, e, f]
                })
            }),
            single: side_by_side(laws, |law| {
                let free::Single { transition, drive } = law.free.single;
                [transition, drive]
            }),
            change: side_by_side(laws, |law| [law.free.gimbal_rate_gain, law.free.gimbal_angle_gain]),
        }
    }

    /// All bits for a lane that may take the straight path.
    pub(super) fn may(&self, law: &Law<f32>, state: &State<f32>) -> u32 {
        let is_like_others = !law.cross_coupling && law.held_inputs == self.held_inputs;
        if is_like_others && matches!(state.regime, Regime::Free | Regime::Unusual) { u32::MAX } else { 0 }
    }

    #[inline(always)]
    pub(super) fn guard(&self, lane: usize) -> guard::Law {
        let [radial_accel, axial_accel, rate, torque] = at(&self.guard, lane);
        guard::Law { radial_accel, axial_accel, rate, torque }
    }

    #[inline(always)]
    pub(super) fn unbalance(&self, lane: usize) -> Row<f32, 2> {
        Row { coefs: at(&self.unbalance, lane) }
    }

    #[inline(always)]
    pub(super) fn level(&self, lane: usize) -> level::Law<f32> {
        let [largest_radial, s0, s1, static_preload, a0, a1, axial_preload, viscous_low] = at(&self.level, lane);
        level::Law {
            largest_radial: largest_radial.to_bits(),
            static_load: Row { coefs: [s0, s1] },
            axial_load: Row { coefs: [a0, a1] },
            static_preload,
            axial_preload,
            load_shift: 0,
            shift: 0,
            viscous_break: self.viscous_break[lane],
            viscous_low,
        }
    }

    #[inline(always)]
    pub(super) fn friction(&self, lane: usize) -> friction::Law<f32> {
        let [slip_rate, steepness] = at(&self.friction, lane);
        friction::Law { slip_rate, steepness, steepness_shift: 0 }
    }

    /// `T_m` less `T_d`, of the modes at one instant.
    #[inline(always)]
    pub(super) fn motor_torque(&self, lane: usize) -> Row<f32, ORDER> {
        Row { coefs: at(&self.motor_torque, lane) }
    }

    #[inline(always)]
    pub(super) fn free(&self, lane: usize) -> free::Law<f32> {
        let block = |block: usize| {
            let [a, b, c, d, e, f] = at(&self.blocks[block], lane);
            free::Block { transition: [a, b, c, d], drive: [e, f] }
        };
        let [transition, drive] = at(&self.single, lane);
        let [gimbal_rate_gain, gimbal_angle_gain] = at(&self.change, lane);
        free::Law {
            gimbal_rate: at(&self.gimbal_rate, lane),
            gimbal_angle: at(&self.gimbal_angle, lane),
            gimbal_rate_gain,
            gimbal_angle_gain,
            blocks: [block(0), block(1), block(2), block(3)],
            single: free::Single { transition, drive },
            // What the straight path does not read.
            gyro_angle: Row { coefs: [0.0; ORDER + 1] },
        }
    }
}

fn side_by_side<T: Copy + Default, const C: usize, const L: usize>(
    laws: &[&Law<f32>; L],
    coefs: impl Fn(&Law<f32>) -> [T; C],
) -> [[T; L]; C] {
    let mut table = [[T::default(); L]; C];
    for (lane, law) in laws.iter().enumerate() {
        for (lanes, coef) in table.iter_mut().zip(coefs(law)) {
            lanes[lane] = coef;
        }
    }
    table
}

#[inline(always)]
fn at<T: Copy, const C: usize, const L: usize>(table: &[[T; L]; C], lane: usize) -> [T; C] {
    core::array::from_fn(|i| table[i][lane])
}
