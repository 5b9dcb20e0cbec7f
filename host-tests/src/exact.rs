//! Exact discretisation of the free loop in f64, for a torque held over each period.
//!
//! Equations (1) to (3) in the physical state: phi, phi', theta, theta', the integrator of F(s), and one state for each
//! of its lead-lag sections `(1 + T_a s) / (1 + T_b s)`, the last of which has the motor lag below. The tenth state and
//! the held torque make one matrix, whose exponential over a period is the discretisation: no modes, no partial fractions.

use gimbal_servo::Config;

/// phi, phi', theta, theta', y, five sections, torque.
const ORDER: usize = 11;
type Matrix = [[f64; ORDER]; ORDER];

const PHI: usize = 0;
const PHI_RATE: usize = 1;
const THETA: usize = 2;
const THETA_RATE: usize = 3;
const INTEGRATOR: usize = 4;
const SECTION: usize = 5;
const TORQUE: usize = 10;

/// The loop over one period, the gyro's stops left out.
#[derive(Debug, Clone)]
pub struct Exact {
    transition: Matrix,
    state: [f64; ORDER],
}

impl Exact {
    /// At rest.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        let a = system(config);
        Self { transition: exponential(&a.map(|row| row.map(|x| x * config.period_s))), state: [0.0; ORDER] }
    }

    /// phi and theta at the end of a period over which the torque was held.
    pub fn step(&mut self, torque_nm: f64) -> (f64, f64) {
        self.state[TORQUE] = torque_nm;
        let old = self.state;
        self.state = self.transition.map(|row| row.iter().zip(&old).map(|(a, x)| a * x).sum());
        (self.state[PHI], self.state[THETA])
    }

    /// phi and theta at each row under torques held from row to row.
    pub fn run(config: &Config, torques_nm: impl IntoIterator<Item = f64>) -> Vec<(f64, f64)> {
        let mut exact = Self::new(config);
        let mut angles = vec![(0.0, 0.0)];
        angles.extend(torques_nm.into_iter().map(|torque| exact.step(torque)));
        // The last row's torque acts after the run.
        angles.pop();
        angles
    }
}

fn system(config: &Config) -> Matrix {
    let (servo, gyro) = (&config.servo, &config.gyro);
    let (jg, jo) = (servo.gimbal_inertia_kg_m2, gyro.float_inertia_kg_m2);
    let (bo, h) = (gyro.damping_nm_s_per_rad, gyro.angular_momentum_nm_s);
    let [t6, t7, t8, t9] = servo.lag_time_constants_s;
    let lags = [t6, t7, t8, t9, servo.motor_lag_s];
    let mut a = [[0.0; ORDER]; ORDER];
    // What goes into the next section, as a row over the state.
    let mut signal = [0.0; ORDER];
    signal[INTEGRATOR] = 1.0;
    for (section, (lead, lag)) in servo.lead_time_constants_s.iter().zip(lags).enumerate() {
        let place = SECTION + section;
        for (entry, input) in a[place].iter_mut().zip(&signal) {
            *entry = input / lag;
        }
        a[place][place] -= 1.0 / lag;
        // w + T_a w', and w' is the row just written.
        signal = a[place].map(|entry| lead * entry);
        signal[place] += 1.0;
    }
    a[INTEGRATOR][THETA] = servo.gain_nm_per_rad_s;
    a[PHI][PHI_RATE] = 1.0;
    a[THETA][THETA_RATE] = 1.0;
    a[THETA_RATE][PHI_RATE] = h / jo;
    a[THETA_RATE][THETA_RATE] = -bo / jo;
    a[PHI_RATE] = signal.map(|entry| -entry / jg);
    a[PHI_RATE][THETA_RATE] -= h / jg;
    a[PHI_RATE][TORQUE] += 1.0 / jg;
    a
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..ORDER).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Taylor series of a part of A that is small, squared up again. `e^A - 1` is carried, so that small entries keep their
/// digits beside the unit matrix.
fn exponential(a: &Matrix) -> Matrix {
    const HALVINGS: i32 = 16;
    let small = a.map(|row| row.map(|x| x * 0.5_f64.powi(HALVINGS)));
    let (mut term, mut change) = (small, small);
    for order in 2..14 {
        term = product(&term, &small).map(|row| row.map(|x| x / f64::from(order)));
        for (row, more) in change.iter_mut().zip(&term) {
            for (entry, more) in row.iter_mut().zip(more) {
                *entry += more;
            }
        }
    }
    for _ in 0..HALVINGS {
        let square = product(&change, &change);
        for (row, more) in change.iter_mut().zip(&square) {
            for (entry, more) in row.iter_mut().zip(more) {
                *entry = 2.0 * *entry + more;
            }
        }
    }
    for (place, row) in change.iter_mut().enumerate() {
        row[place] += 1.0;
    }
    change
}
