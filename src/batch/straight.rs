//! One step of all lanes along the straight path of [`Law::step`], in the same order of operations.

use super::coefs::Coefs;
use super::memory::Memory;
use super::{Others, Rows};
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;

/// All bits.
const YES: u32 = u32::MAX;

/// What a step finds on its way.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Course<const L: usize> {
    /// All ones for a lane that has not left the straight path.
    pub(super) stays: [u32; L],
    other: [f32; L],
    friction_level: [f32; L],
    quiet_rate: [f32; L],
    /// What the modes make of phi.
    quiet_angle: [f32; L],
    brake: [f32; L],
    free_end: [f32; L],
    share: [f32; L],
    /// All bits for a lane whose share is known: its bearing settled one way, or stays in the clamp's zone, throughout.
    settled: [u32; L],
    /// Whole counts of the INS sums.
    pub(super) counts: [[f32; L]; 2],
}

#[inline(always)]
fn mask(condition: bool) -> u32 {
    if condition { YES } else { 0 }
}

/// The bits that all lanes have.
#[inline(always)]
pub(super) fn all<const L: usize>(lanes: &[u32; L]) -> u32 {
    lanes.iter().fold(YES, |all, lane| all & lane)
}

impl<const L: usize> Course<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            stays: [0; L],
            other: zero,
            friction_level: zero,
            quiet_rate: zero,
            quiet_angle: zero,
            brake: zero,
            free_end: zero,
            share: zero,
            settled: [0; L],
            counts: [zero; 2],
        }
    }

    /// The disturbance at the rows, and phi' without friction at the end of the period.
    #[inline(always)]
    pub(super) fn disturb(
        &mut self,
        coefs: &Coefs<L>,
        last: &Memory<L>,
        rows: &Rows<L>,
        next: &mut Memory<L>,
        others: &mut Others<L>,
    ) {
        for lane in 0..L {
            let row = rows.lane(lane);
            self.stays[lane] &= mask(coefs.guard(lane).admits(&row));
            let (unbalance, accel) = (coefs.unbalance(lane), [row.accel_x_mps2, row.accel_y_mps2]);
            others.unbalance_torque[lane] = unbalance.at(&accel);
            next.other_torque[lane] = unbalance.above(row.torque_nm, &accel);
        }
        for lane in 0..L {
            let end_rate;
            if coefs.held_inputs {
                self.other[lane] = last.other_torque[lane] + last.other_torque[lane];
                self.friction_level[lane] = last.friction_level[lane] + last.friction_level[lane];
                end_rate = last.relative_rate[lane] + last.sensed_rate[lane];
            } else {
                self.other[lane] = last.other_torque[lane] + next.other_torque[lane];
                self.friction_level[lane] = last.friction_level[lane] + next.friction_level[lane];
                end_rate = rows.vehicle_rate_radps[lane];
            }
            let free = coefs.free(lane);
            let (rate, angle) = free.quiet(&Heads::of(&last.modes(lane)));
            self.quiet_rate[lane] = rate + free.gimbal_rate_gain * (self.other[lane] - last.torque[lane]);
            self.quiet_angle[lane] = angle;
            self.brake[lane] = free.gimbal_rate_gain * self.friction_level[lane];
            self.free_end[lane] = end_rate - self.quiet_rate[lane];
        }
    }

    /// The share of the friction level that acts.
    #[inline(always)]
    pub(super) fn rub(&mut self, coefs: &Coefs<L>, laws: &[&Law<f32>; L], last: &Memory<L>) {
        for lane in 0..L {
            let slip = coefs.friction(lane).slip_rate;
            let (start, free_end, brake) = (last.relative_rate[lane], self.free_end[lane], self.brake[lane]);
            let up = (start >= slip) & (free_end - brake >= slip);
            let down = (start <= -slip) & (free_end + brake <= -slip);
            self.share[lane] = if up { 1.0 } else { -1.0 };
            self.settled[lane] = mask(up) | mask(down);
        }
        if all(&self.settled) == 0 {
            self.rub_in_zone(coefs, laws, last);
        }
    }

    /// [`Course::rub`] with lanes inside the clamp's zone, or on their way through it.
    #[inline(always)]
    fn rub_in_zone(&mut self, coefs: &Coefs<L>, laws: &[&Law<f32>; L], last: &Memory<L>) {
        for lane in 0..L {
            let law = coefs.friction(lane);
            let start = last.relative_rate[lane];
            let zone = law.zone(start, self.free_end[lane], self.brake[lane]);
            let stays = mask(start.abs() < law.slip_rate) & mask(zone.is_kept());
            self.share[lane] = if self.settled[lane] == 0 { zone.mean() } else { self.share[lane] };
            self.settled[lane] |= stays;
        }
        if all(&self.settled) == 0 {
            for lane in (0..L).filter(|lane| self.settled[*lane] == 0) {
                let (start, free_end, brake) = (last.relative_rate[lane], self.free_end[lane], self.brake[lane]);
                self.share[lane] = laws[lane].friction.mean(start, free_end, brake);
            }
        }
    }

    /// The loop over the period, and the sums of the INS errors.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        coefs: &Coefs<L>,
        last: &Memory<L>,
        rows: &Rows<L>,
        next: &mut Memory<L>,
        offset: &[f32; L],
        others: &mut Others<L>,
    ) {
        for lane in 0..L {
            let free = coefs.free(lane);
            let mut modes = last.modes(lane);
            let heads = Heads::of(&modes);
            let torque = self.other[lane] + self.friction_level[lane].times(self.share[lane]);
            let change = (torque - last.torque[lane]).stirred();
            let sensed_rate = self.quiet_rate[lane] + self.brake[lane].times(self.share[lane]);
            let gyro_angle = free.advance(&mut modes, &heads, change);
            let gimbal_angle = offset[lane] + (self.quiet_angle[lane] + free.gimbal_angle_gain * change);
            self.stays[lane] &=
                mask(!gyro_angle.beyond(coefs.stop_limit[lane])) & mask(!gimbal_angle.beyond(coefs.small_angle[lane]));
            let relative_rate = rows.vehicle_rate_radps[lane] - sensed_rate;
            let friction = next.friction_level[lane].times(coefs.friction(lane).clamp(relative_rate));

            for (next, mode) in next.free.iter_mut().zip(modes) {
                next[lane] = mode;
            }
            next.torque[lane] = torque;
            next.gyro_angle[lane] = gyro_angle;
            next.gimbal_angle[lane] = gimbal_angle;
            next.sensed_rate[lane] = sensed_rate;
            next.relative_rate[lane] = relative_rate;
            others.gimbal_rate[lane] = sensed_rate;
            others.disturbance_torque[lane] = torque.half();
            others.motor_torque[lane] = torque.half() + coefs.motor_torque(lane).at(&modes);
            others.friction_torque[lane] = friction;
            others.stop_change_age[lane] = 0.0;
        }
        next.row = *rows;
    }

    /// The products of acceleration and phi in whole counts.
    #[inline(always)]
    pub(super) fn count(&mut self, coefs: &Coefs<L>, last: &Memory<L>, rows: &Rows<L>, next: &mut Memory<L>) {
        for lane in 0..L {
            let scaled = f32::coarse_scaled(next.gimbal_angle[lane], coefs.ins_scale[lane]);
            let exact = [
                rows.accel_y_mps2[lane] * scaled + last.carry[0][lane],
                rows.accel_x_mps2[lane] * scaled + last.carry[1][lane],
            ];
            let whole = exact.map(whole);
            self.counts[0][lane] = whole[0];
            self.counts[1][lane] = whole[1];
            next.carry[0][lane] = exact[0] - whole[0];
            next.carry[1][lane] = exact[1] - whole[1];
        }
    }
}

/// The whole part, positive where it is zero: what [`Number::count`] gives and takes back, without a conversion to an
/// integer and its saturation, for which there are no vector instructions.
#[inline(always)]
fn whole(exact: f32) -> f32 {
    /// From here on every number is whole.
    const TWO_TO_23: f32 = 8_388_608.0;
    let size = exact.abs();
    let nearest = (size + TWO_TO_23) - TWO_TO_23;
    let below = if nearest > size { nearest - 1.0 } else { nearest };
    let below = if size < TWO_TO_23 { below } else { size };
    f32::from_bits(below.to_bits() | (exact.to_bits() & (1 << 31))) + 0.0
}
