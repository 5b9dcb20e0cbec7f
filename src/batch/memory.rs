//! What the straight path remembers between two steps, all lanes of a signal side by side.

use super::Rows;
use crate::build::poles::ORDER;
use crate::signals::Input;
use crate::state::State;

/// Signals of `L` lanes at one row.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Memory<const L: usize> {
    pub(super) row: Rows<L>,
    pub(super) friction_level: [f32; L],
    pub(super) other_torque: [f32; L],
    pub(super) torque: [f32; L],
    pub(super) gyro_angle: [f32; L],
    pub(super) gimbal_angle: [f32; L],
    pub(super) sensed_rate: [f32; L],
    pub(super) relative_rate: [f32; L],
    pub(super) free: [[f32; L]; ORDER],
    pub(super) carry: [[f32; L]; 2],
}

impl<const L: usize> Memory<L> {
    pub(super) fn new() -> Self {
        let zero = [0.0; L];
        Self {
            row: Input {
                accel_x_mps2: zero,
                accel_y_mps2: zero,
                accel_z_mps2: zero,
                vehicle_rate_radps: zero,
                torque_nm: zero,
                spin_rate_radps: zero,
            },
            friction_level: zero,
            other_torque: zero,
            torque: zero,
            gyro_angle: zero,
            gimbal_angle: zero,
            sensed_rate: zero,
            relative_rate: zero,
            free: [zero; ORDER],
            carry: [zero; 2],
        }
    }

    /// The modes of a lane.
    #[inline(always)]
    pub(super) fn modes(&self, lane: usize) -> [f32; ORDER] {
        core::array::from_fn(|i| self.free[i][lane])
    }

    /// A lane's part of a state.
    pub(super) fn get(&self, lane: usize, state: &mut State<f32>) {
        state.row = self.row.lane(lane);
        state.friction_level = self.friction_level[lane];
        state.other_torque = self.other_torque[lane];
        state.torque = self.torque[lane];
        state.gyro_angle = self.gyro_angle[lane];
        state.gimbal_angle = self.gimbal_angle[lane];
        state.sensed_rate = self.sensed_rate[lane];
        state.relative_rate = self.relative_rate[lane];
        state.free = self.modes(lane);
        for (sums, carries) in state.ins.0.iter_mut().zip(&self.carry) {
            sums.carry = carries[lane];
        }
    }

    /// Takes a lane's part of a state.
    pub(super) fn put(&mut self, lane: usize, state: &State<f32>) {
        let row = &mut self.row;
        row.accel_x_mps2[lane] = state.row.accel_x_mps2;
        row.accel_y_mps2[lane] = state.row.accel_y_mps2;
        row.accel_z_mps2[lane] = state.row.accel_z_mps2;
        row.vehicle_rate_radps[lane] = state.row.vehicle_rate_radps;
        row.torque_nm[lane] = state.row.torque_nm;
        row.spin_rate_radps[lane] = state.row.spin_rate_radps;
        self.friction_level[lane] = state.friction_level;
        self.other_torque[lane] = state.other_torque;
        self.torque[lane] = state.torque;
        self.gyro_angle[lane] = state.gyro_angle;
        self.gimbal_angle[lane] = state.gimbal_angle;
        self.sensed_rate[lane] = state.sensed_rate;
        self.relative_rate[lane] = state.relative_rate;
        for (modes, mode) in self.free.iter_mut().zip(state.free) {
            modes[lane] = mode;
        }
        for (carries, sums) in self.carry.iter_mut().zip(&state.ins.0) {
            carries[lane] = sums.carry;
        }
    }
}

impl<const L: usize> Rows<L> {
    /// The row of a lane.
    ///
    /// # Panics
    /// If there is no such lane.
    #[must_use]
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Input<f32> {
        Input {
            accel_x_mps2: self.accel_x_mps2[lane],
            accel_y_mps2: self.accel_y_mps2[lane],
            accel_z_mps2: self.accel_z_mps2[lane],
            vehicle_rate_radps: self.vehicle_rate_radps[lane],
            torque_nm: self.torque_nm[lane],
            spin_rate_radps: self.spin_rate_radps[lane],
        }
    }
}
