//! Torques on gimbal and float.

use super::{CREEP, HEAT, LAG, Machine, PHI_RATE, RELATIVE, SNAP, Stage, States, THETA, Torques};

impl Machine<'_> {
    pub(super) fn momentum(&self, time_s: f64) -> f64 {
        let nominal = self.truth.config.gyro.angular_momentum_nm_s;
        self.truth.float.hunting.map_or(nominal, |[swing, frequency_hz, phase]| {
            nominal * (1.0 + swing * libm::sin(2.0 * core::f64::consts::PI * frequency_hz * time_s + phase))
        })
    }

    /// Torque on the float at rest [N m].
    pub(super) fn float_torque_nm(&self, states: &States, stage: &Stage) -> f64 {
        let float = &self.truth.float;
        self.momentum(stage.time_s) * states[PHI_RATE] + float.constant_nm + float.per_accel * stage.row.accel_mps2[0]
            - float.restraint * states[THETA]
    }

    fn motor_nm(&self, states: &States) -> f64 {
        let drive = &self.truth.drive;
        let limited = drive.limit_nm.map_or(states[LAG], |limit| states[LAG].clamp(-limit, limit));
        let width = drive.dead_zone_nm;
        let mut torque = limited - limited.clamp(-width, width);
        if let Some([loss, _, _]) = drive.heating {
            torque *= 1.0 - loss * states[HEAT];
        }
        torque + drive.torque_asymmetry * torque.abs()
    }

    pub(super) fn torques(&self, states: &States, stage: &Stage, relative_rad: f64) -> Torques {
        let friction = &self.truth.friction;
        let path = self.path(states, stage, stage.since_commit_s);
        let rate = stage.row.rate_radps - states[PHI_RATE];
        let [x, y, _] = stage.row.accel_mps2;
        let radial_g = libm::sqrt(x * x + y * y) / gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
        let load_nm = stage.load_nm * (1.0 + friction.load_change) * (1.0 + friction.load_per_g * radial_g);
        let mut level = load_nm + self.palmgren.viscous_nm(rate) * (1.0 + friction.viscous_change);
        if let Some([excess, width, exponent]) = friction.stribeck {
            let over = rate.abs() / width;
            level += excess * libm::exp(-libm::exp(exponent * libm::log(over.max(1e-9))));
        }
        let mut torque = level * self.memory.friction(friction.presliding.as_ref(), path);
        torque *= 1.0 + friction.asymmetry * path.curve;
        if let Some([growth, time_s, quick]) = friction.drift {
            let since = stage.time_s.max(0.0) / time_s;
            let grown = 1.0 - (1.0 - quick) * libm::exp(-since) - quick * libm::exp(-4.0 * since);
            torque *= 1.0 + growth * grown;
        }
        if let Some([swing, cycles, phase]) = friction.position {
            torque *= 1.0 + swing * libm::sin(cycles * relative_rad + phase);
        }
        torque += rate * (friction.linear + friction.quadratic * rate.abs());
        Torques { friction: torque, motor: self.motor_nm(states) }
    }

    /// Torque of everything on the gimbal but friction, servo and gyro [N m].
    pub(super) fn disturbance_nm(&self, states: &States, stage: &Stage) -> f64 {
        let torque = &self.truth.torque;
        let unbalance = &self.truth.config.unbalance;
        let [x, y, _] = stage.row.accel_mps2;
        let (rate, relative) = (stage.row.rate_radps, states[RELATIVE]);
        let path = self.path(states, stage, stage.since_commit_s);
        let mut sum = (unbalance.x_kg_m + torque.unbalance_kg_m[0]) * y
            - (unbalance.y_kg_m + torque.unbalance_kg_m[1]) * x
            + torque.anisoelastic * x * y
            + relative * (torque.spring[0] + torque.spring[1] * relative * relative)
            + torque.constant_nm
            + torque.cross_rates * rate * stage.row.cross_rate_radps
            + torque.rate_squared * rate * rate
            + stage.row.external_nm;
        sum += self.memory.cable_nm(&torque.hysteresis, path);
        for [amplitude, cycles, phase] in &torque.ripple {
            sum += amplitude * libm::sin(cycles * relative + phase);
        }
        if let Some([size, _]) = torque.snap {
            sum += size * states[SNAP];
        }
        if let Some(contact) = torque.contact.as_ref().filter(|_| self.contact_now) {
            sum += contact.stiffness * (relative - contact.from_rad).max(0.0);
        }
        if let Some([size, displacement, limit]) = torque.chatter {
            let slow = (2.0 - (rate - states[PHI_RATE]).abs() / limit).clamp(0.0, 1.0);
            sum += size * slow * self.memory.brush(displacement, path);
        }
        if let Some([stiffness, _]) = torque.creep {
            sum += stiffness * (relative - states[CREEP]);
        }
        sum
    }
}
