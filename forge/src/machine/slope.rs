//! Slopes of all states.

use super::{
    CREEP, DEFLECTION, DEFLECTION_RATE, HEAT, LAG, Machine, PHI, PHI_RATE, RELATIVE, SERVO, SNAP, STATES, Stage,
    States, Stop, THETA, THETA_RATE, VELOCITY,
};
use crate::compensator::ORDER;

/// Time in which a snapping spring goes over [s].
const SNAP_TIME_S: f64 = 4e-3;

impl Machine<'_> {
    pub(super) fn slope(&self, states: &States, stage: &Stage, offset_s: f64) -> States {
        let config = &self.truth.config;
        let free = self.stop == Stop::Free;
        let theta_rate = if free { states[THETA_RATE] } else { 0.0 };
        let torques = self.torques(states, stage, states[RELATIVE]);
        let net = torques.friction + self.disturbance_nm(states, stage)
            - self.momentum(stage.time_s) * theta_rate
            - torques.motor;
        let mut slope = [0.0; STATES];
        slope[PHI] = states[PHI_RATE];
        slope[RELATIVE] = stage.row.rate_radps - states[PHI_RATE];
        let inertia = config.servo.gimbal_inertia_kg_m2;
        if let Some(part) = self.truth.appendage {
            let own = part.share * inertia;
            let deflection = states[DEFLECTION];
            let stretched = deflection - deflection.clamp(-part.play_rad, part.play_rad);
            let damped = if part.play_rad == 0.0 || stretched != 0.0 { states[DEFLECTION_RATE] } else { 0.0 };
            let spring = own * part.frequency_radps * part.frequency_radps * stretched
                + 2.0 * part.damping * own * part.frequency_radps * damped;
            slope[PHI_RATE] = (net + spring) / (inertia - own);
            slope[DEFLECTION] = states[DEFLECTION_RATE];
            slope[DEFLECTION_RATE] = -spring / own - slope[PHI_RATE];
        } else {
            slope[PHI_RATE] = net / inertia;
        }
        if free {
            slope[THETA] = theta_rate;
            slope[THETA_RATE] = (self.float_torque_nm(states, stage) - config.gyro.damping_nm_s_per_rad * theta_rate)
                / config.gyro.float_inertia_kg_m2;
        }
        self.servo_slope(states, stage.pickoff_noise_rad, theta_rate, offset_s, &mut slope);
        if let Some([_, full_nm, time_s]) = self.truth.drive.heating {
            let load = torques.motor / full_nm;
            slope[HEAT] = (load * load - states[HEAT]) / time_s;
        }
        if let Some([_, time_s]) = self.truth.torque.creep {
            slope[CREEP] = (states[RELATIVE] - states[CREEP]) / time_s;
        }
        if self.truth.torque.snap.is_some() {
            slope[SNAP] = (self.memory.side - states[SNAP]) / SNAP_TIME_S;
        }
        slope[VELOCITY] = stage.row.accel_mps2[1] * states[PHI];
        slope[VELOCITY + 1] = -stage.row.accel_mps2[0] * states[PHI];
        slope
    }

    fn servo_slope(&self, states: &States, noise_rad: f64, theta_rate: f64, offset_s: f64, slope: &mut States) {
        let servo = Self::servo(states);
        let seen = self.seen(states[THETA] + noise_rad);
        let servo_slope = self.compensator.slope(&servo, seen);
        slope[SERVO..SERVO + ORDER].copy_from_slice(&servo_slope);
        let mut command = self.compensator.output_nm(&servo, seen);
        if self.truth.drive.delay_s > 0.0 {
            let rate = self.compensator.output_nm(&servo_slope, theta_rate);
            command = self.delayed(command, rate, offset_s);
        }
        if let Some(frozen) = self.frozen_nm {
            command = frozen;
        }
        slope[LAG] = (command - states[LAG]) / self.truth.config.servo.motor_lag_s;
    }
}
