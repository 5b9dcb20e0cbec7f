//! The linear part of the platform as one matrix.
//!
//! ```text
//! Jg phi''   = u - H theta' - T_m                         (1)      u all torques on the gimbal
//! Jo theta'' = H phi' + v - Bo theta'                     (2)      v a torque on the float; on a stop theta' = 0
//! T_m        = F(s) / (1 + T s) theta                     (3)      a cascade of first-order sections
//! section    : out = r in + y     T y' = (1 - r) in - y            r lead over lag; y as it shows at the output, so
//!                                                                  that where it begins does not multiply lead and lag
//! delay d    : T_m = tau - d w'    w'' = 12/d^2 (tau - w) - 6/d w'   (Pade, order 2)
//! appendage  : a = (2 pi f)^2 x + 2 z (2 pi f) x'   x = phi - q   Jg (1-r) phi'' = ... - r Jg a   q'' = a
//! ```

use nalgebra::DMatrix;

use super::Physics;

/// Places in the state.
pub(crate) const PHI_RATE: usize = 0;
pub(crate) const THETA: usize = 1;
pub(crate) const THETA_RATE: usize = 2;
pub(crate) const SECTION: usize = 3;
pub(crate) const INTEGRATOR: usize = 7;
pub(crate) const TORQUE: usize = 8;
pub(crate) const PHI: usize = 9;
/// Those that are torques: sections as they show at the output, integrator, motor.
pub(crate) const TORQUES: std::ops::RangeInclusive<usize> = SECTION..=TORQUE;
/// The float's.
pub(crate) const ANGLES: std::ops::RangeInclusive<usize> = THETA..=THETA_RATE;
/// States of the nominal chain.
pub(crate) const PLAIN: usize = 10;
/// States with delay and appendage.
pub(crate) const FULL: usize = 14;
const DELAY: usize = 10;
const TWIST: usize = 12;
const APPENDAGE_RATE: usize = 13;
/// Inputs: torque on the gimbal, torque on the float, what the pick-off adds to theta.
pub(crate) const INPUTS: usize = 3;

/// Slopes: states from states and inputs, and the row that gives the motor's command.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    pub(crate) slope: DMatrix<f64>,
    pub(crate) drive: DMatrix<f64>,
    pub(crate) command: Vec<f64>,
}

impl Chain {
    pub(crate) fn states(physics: &Physics) -> usize {
        if physics.delay_s > 0.0 || physics.appendage.is_some() { FULL } else { PLAIN }
    }

    pub(crate) fn new(physics: &Physics, on_stop: bool) -> Self {
        let n = Self::states(physics);
        let mut chain = Self { slope: DMatrix::zeros(n, n), drive: DMatrix::zeros(n, INPUTS), command: vec![0.0; n] };
        chain.servo(physics);
        chain.delay(physics.delay_s);
        chain.gimbal(physics, on_stop);
        if !on_stop {
            chain.gyro(physics);
        }
        chain
    }

    fn servo(&mut self, physics: &Physics) {
        let servo = &physics.config.servo;
        let n = self.command.len();
        // the signal along the cascade, as a row over states and the pick-off's input
        let mut signal = vec![0.0; n + 1];
        signal[THETA] = servo.gain_nm_per_rad_s;
        signal[n] = servo.gain_nm_per_rad_s;
        for (index, lag_s) in servo.lag_time_constants_s.iter().enumerate() {
            let ratio = servo.lead_time_constants_s[index] / lag_s;
            let mut drive: Vec<f64> = signal.iter().map(|value| (1.0 - ratio) * value).collect();
            drive[SECTION + index] -= 1.0;
            self.set(SECTION + index, &drive, 1.0 / lag_s);
            for value in &mut signal {
                *value *= ratio;
            }
            signal[SECTION + index] += 1.0;
        }
        self.set(INTEGRATOR, &signal, 1.0);
        let mut command: Vec<f64> = signal.iter().map(|value| servo.lead_time_constants_s[4] * value).collect();
        command[INTEGRATOR] += 1.0;
        command[TORQUE] -= 1.0;
        self.set(TORQUE, &command, 1.0 / servo.motor_lag_s);
        self.command[TORQUE] = 1.0;
    }

    fn set(&mut self, state: usize, row: &[f64], factor: f64) {
        let n = self.command.len();
        for (column, value) in row[..n].iter().enumerate() {
            self.slope[(state, column)] = factor * value;
        }
        self.drive[(state, 2)] = factor * row[n];
    }

    fn delay(&mut self, delay_s: f64) {
        if delay_s <= 0.0 {
            if self.command.len() == FULL {
                // not coupled to anything
                self.slope[(DELAY, DELAY)] = -1.0;
                self.slope[(DELAY + 1, DELAY + 1)] = -1.0;
            }
            return;
        }
        let stiffness = 12.0 / (delay_s * delay_s);
        self.slope[(DELAY, DELAY + 1)] = 1.0;
        self.slope[(DELAY + 1, TORQUE)] = stiffness;
        self.slope[(DELAY + 1, DELAY)] = -stiffness;
        self.slope[(DELAY + 1, DELAY + 1)] = -6.0 / delay_s;
        self.command[DELAY + 1] = -delay_s;
    }

    fn gimbal(&mut self, physics: &Physics, on_stop: bool) {
        let total = physics.config.servo.gimbal_inertia_kg_m2;
        let mut inertia = total;
        self.slope[(PHI, PHI_RATE)] = 1.0;
        if let Some([ratio, frequency_hz, damping]) = physics.appendage {
            let frequency = std::f64::consts::TAU * frequency_hz;
            inertia = total * (1.0 - ratio);
            for (state, gain) in [
                (TWIST, frequency * frequency),
                (PHI_RATE, 2.0 * damping * frequency),
                (APPENDAGE_RATE, -2.0 * damping * frequency),
            ] {
                self.slope[(PHI_RATE, state)] -= ratio * total * gain / inertia;
                self.slope[(APPENDAGE_RATE, state)] += gain;
            }
            self.slope[(TWIST, PHI_RATE)] = 1.0;
            self.slope[(TWIST, APPENDAGE_RATE)] = -1.0;
        } else if self.command.len() == FULL {
            self.slope[(TWIST, TWIST)] = -1.0;
            self.slope[(APPENDAGE_RATE, APPENDAGE_RATE)] = -1.0;
        }
        if !on_stop {
            self.slope[(PHI_RATE, THETA_RATE)] -= physics.config.gyro.angular_momentum_nm_s / inertia;
        }
        for (state, share) in self.command.iter().enumerate() {
            self.slope[(PHI_RATE, state)] -= share / inertia;
        }
        self.drive[(PHI_RATE, 0)] = 1.0 / inertia;
    }

    fn gyro(&mut self, physics: &Physics) {
        let gyro = &physics.config.gyro;
        self.slope[(THETA, THETA_RATE)] = 1.0;
        self.slope[(THETA_RATE, PHI_RATE)] = gyro.angular_momentum_nm_s / gyro.float_inertia_kg_m2;
        self.slope[(THETA_RATE, THETA_RATE)] = -gyro.damping_nm_s_per_rad / gyro.float_inertia_kg_m2;
        self.drive[(THETA_RATE, 1)] = 1.0 / gyro.float_inertia_kg_m2;
    }
}
