//! The linear part of the platform as one matrix.
//!
//! ```text
//! Jg phi''   = u - H theta' - T_m                         (1)      u all torques on the gimbal
//! Jo theta'' = H phi' + v - Bo theta'                     (2)      v a torque on the float; on a stop theta' = 0
//! T_m        = F(s) / (1 + T s) theta                     (3)      a cascade of first-order sections
//! section    : out = r in + y     T y' = (1 - r) in - y            r lead over lag; y as it shows at the output, so
//!                                                                  that where it begins does not multiply lead and lag
//! motor      : (T + b) T_m' = tau + b tau' + c tau'' - T_m        exp(-h T s) / (1 + k T s), k = 1 - h, up to the third order:
//!              b = -2/3 T (1 - k^3) / (1 + k^2)    c = -T b - T^2 (1 - k^2) / 2      h = 0 a lag T, h = 1 a pure delay T (Pade, 2/1)
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
    /// `T_m` jumps by this where theta' does [N m s/rad].
    pub(crate) jump: f64,
}

impl Chain {
    pub(crate) fn states(physics: &Physics) -> usize {
        if physics.delay_s > 0.0 || physics.appendage.is_some() { FULL } else { PLAIN }
    }

    pub(crate) fn new(physics: &Physics, on_stop: bool) -> Self {
        let n = Self::states(physics);
        let mut chain =
            Self { slope: DMatrix::zeros(n, n), drive: DMatrix::zeros(n, INPUTS), command: vec![0.0; n], jump: 0.0 };
        chain.servo(physics, on_stop);
        chain.delay(physics.delay_s);
        chain.gimbal(physics, on_stop);
        if !on_stop {
            chain.gyro(physics);
        }
        chain
    }

    fn servo(&mut self, physics: &Physics, on_stop: bool) {
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
        let motor = Motor::new(physics);
        self.jump = motor.bend_s2 / motor.lag_s * command[THETA];
        let rising = self.rising(&command, physics, on_stop);
        let bending = self.rising(&rising, physics, on_stop);
        for (own, (rising, bending)) in command.iter_mut().zip(rising.iter().zip(&bending)) {
            *own += motor.ahead_s * rising + motor.bend_s2 * bending;
        }
        command[TORQUE] -= 1.0;
        self.set(TORQUE, &command, 1.0 / motor.lag_s);
        if !on_stop {
            self.drive[(TORQUE, 1)] = self.jump / physics.config.gyro.float_inertia_kg_m2;
        }
        self.command[TORQUE] = 1.0;
    }

    /// How fast a signal of the servo rises, as a row like its own; the pick-off's input stands still, and a torque on
    /// the float is not in it.
    fn rising(&self, signal: &[f64], physics: &Physics, on_stop: bool) -> Vec<f64> {
        let n = self.command.len();
        let mut rising = vec![0.0; n + 1];
        for (state, share) in signal.iter().enumerate().take(INTEGRATOR + 1).skip(SECTION) {
            for (column, value) in rising[..n].iter_mut().enumerate() {
                *value += share * self.slope[(state, column)];
            }
            rising[n] += share * self.drive[(state, 2)];
        }
        rising[THETA_RATE] += signal[THETA];
        if !on_stop {
            let [by_gimbal, by_float] = float_slopes(physics);
            rising[PHI_RATE] += by_gimbal * signal[THETA_RATE];
            rising[THETA_RATE] += by_float * signal[THETA_RATE];
        }
        rising
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
        let [by_gimbal, by_float] = float_slopes(physics);
        self.slope[(THETA, THETA_RATE)] = 1.0;
        self.slope[(THETA_RATE, PHI_RATE)] = by_gimbal;
        self.slope[(THETA_RATE, THETA_RATE)] = by_float;
        self.drive[(THETA_RATE, 1)] = 1.0 / physics.config.gyro.float_inertia_kg_m2;
    }
}

/// theta'' after phi' and after theta'.
fn float_slopes(physics: &Physics) -> [f64; 2] {
    let gyro = &physics.config.gyro;
    [gyro.angular_momentum_nm_s, -gyro.damping_nm_s_per_rad].map(|torque| torque / gyro.float_inertia_kg_m2)
}

/// The motor between a lag and a pure delay.
struct Motor {
    /// T + b [s].
    lag_s: f64,
    /// b [s].
    ahead_s: f64,
    /// c, in s2.
    bend_s2: f64,
}

impl Motor {
    fn new(physics: &Physics) -> Self {
        let delay_s = physics.config.servo.motor_lag_s;
        let lag = 1.0 - physics.pure_delay;
        let ahead = -2.0 / 3.0 * (1.0 - lag.powi(3)) / (1.0 + lag * lag);
        let bend = -ahead - 0.5 * (1.0 - lag * lag);
        Self { lag_s: delay_s * (1.0 + ahead), ahead_s: delay_s * ahead, bend_s2: delay_s * delay_s * bend }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Complex, DMatrix, DVector};

    use super::{Chain, INTEGRATOR, PHI_RATE, SECTION, THETA, THETA_RATE, TORQUE, float_slopes};
    use crate::library::platform;
    use crate::simulate::Physics;

    /// `T_m / theta` at a frequency, from the states of the servo alone.
    fn response(physics: &Physics, s: Complex<f64>) -> Complex<f64> {
        let chain = Chain::new(physics, false);
        let count = TORQUE + 1 - SECTION;
        let of = |value: f64| Complex::new(value, 0.0);
        let own = |row: usize, column: usize| of(chain.slope[(SECTION + row, SECTION + column)]);
        let left =
            DMatrix::from_fn(count, count, |row, column| if row == column { s } else { of(0.0) } - own(row, column));
        let drive = |state: usize, row: usize| of(chain.slope[(SECTION + row, state)]);
        let [by_gimbal, by_float] = float_slopes(physics);
        let gimbal_rate = s * (s - by_float) / by_gimbal;
        let right = DVector::from_fn(count, |row, _| {
            drive(THETA, row) + s * drive(THETA_RATE, row) + gimbal_rate * drive(PHI_RATE, row)
        });
        left.lu().solve(&right).expect("regular")[TORQUE - SECTION]
    }

    #[test]
    fn closed_form_the_motor_is_a_lag_a_pure_delay_or_between() {
        assert_eq!(TORQUE, INTEGRATOR + 1);
        let physics = platform(&gimbal_model_file::ModelFile::default());
        let lag_s = physics.config.servo.motor_lag_s;
        for frequency_hz in [0.3, 20.0, 84.0, 300.0] {
            let s = Complex::new(0.0, std::f64::consts::TAU * frequency_hz);
            let lag = response(&physics, s);
            for share in [0.5, 0.125, -0.125] {
                let between = response(&Physics { pure_delay: share, ..physics.clone() }, s);
                let right = lag * (1.0 + s * lag_s) * (-share * lag_s * s).exp() / (1.0 + (1.0 - share) * lag_s * s);
                let fourth = (s.norm() * lag_s).powi(4).min(2.0);
                assert!(
                    (between / right - 1.0).norm() < 0.1 * fourth,
                    "{share} at {frequency_hz} Hz: {between} and {right}"
                );
            }
            let pure = response(&Physics { pure_delay: 1.0, ..physics.clone() }, s);
            let delayed = lag * (1.0 + s * lag_s) * (-s * lag_s).exp();
            assert!((pure / delayed - 1.0).norm() < 0.1 * (s.norm() * lag_s).powi(4).min(20.0), "{frequency_hz} Hz");
        }
    }
}
