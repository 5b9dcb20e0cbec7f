//! Platforms whose bearings hold by bristles, after `LuGre` and after the elasto-plastic law, simulated here: another law about
//! zero rate than the clamp, and no gap.
//!
//! ```text
//! F = T (z + tau z')      d z' = w - |w| z s(z)      s = 1 (LuGre)      s = 0 below z_b, from there (z - z_b) / (1 - z_b)
//! ```

use gimbal_gap::diagnose;
use gimbal_model_file::ModelFile;
use gimbal_plant::Row;
use gimbal_servo::Config;

use crate::corpus::{Excitation, NOISE, ROW_S, SENSED, Simulated, as_log, between, drifted, rng, rows, sensed};
use crate::{names, report};

/// Steps a row, of Heun's method.
const STEPS: usize = 80;
/// Displacement of the bristles [rad], and time constant of their damping [s].
const DISPLACEMENT_RAD: f64 = 2e-6;
const DAMPING_S: f64 = 1.5e-3;

/// Noise of the columns: that of the rates, and that of the outputs over what it is elsewhere.
fn noise(rate_radps: f64, of_outputs: f64) -> [f64; SENSED] {
    let mut noise = NOISE;
    noise[3..5].fill(rate_radps);
    noise[5..].iter_mut().for_each(|sigma| *sigma *= of_outputs);
    noise
}

#[derive(Clone, Copy)]
struct Bristles {
    /// Share of their force up to which they only bend.
    bend: f64,
}

/// phi, phi', theta, theta', z, the integrator's, four sections' and the motor's.
type State = [f64; 11];

impl Bristles {
    /// z' of bristles at a rate w [1/s].
    fn bends(self, w: f64, z: f64) -> f64 {
        let toward = (z * w.signum()).max(0.0);
        let yields = if self.bend > 0.0 { ((toward - self.bend) / (1.0 - self.bend)).clamp(0.0, 1.0) } else { 1.0 };
        (w - w.abs() * z * yields) / DISPLACEMENT_RAD
    }

    fn derivative(self, platform: &Config, row: &Row, x: &State) -> State {
        let (servo, gyro) = (&platform.servo, &platform.gyro);
        let w = row.vehicle_rate_radps - x[1];
        let radial = row.accel_x_mps2.hypot(row.accel_y_mps2);
        let level_nm = platform.bearing.friction_level_nm(radial, row.accel_z_mps2, w);
        let bends = self.bends(w, x[4]);
        let friction_nm = level_nm * (x[4] + DAMPING_S * bends);
        let unbalance_nm = platform.unbalance.torque_nm(row.accel_x_mps2, row.accel_y_mps2);
        let mut out = State::default();
        out[0] = x[1];
        out[1] = (friction_nm + unbalance_nm - gyro.angular_momentum_nm_s * x[3] - x[10]) / servo.gimbal_inertia_kg_m2;
        out[2] = x[3];
        out[3] = (gyro.angular_momentum_nm_s * x[1] - gyro.damping_nm_s_per_rad * x[3]) / gyro.float_inertia_kg_m2;
        out[4] = bends;
        // (1 + T1 s) / s, then a lead over each lag, then the motor
        let leads = &servo.lead_time_constants_s;
        out[5] = servo.gain_nm_per_rad_s * x[2];
        let mut signal = x[5] + leads[0] * out[5];
        for (section, lag_s) in servo.lag_time_constants_s.iter().enumerate() {
            let share = leads[section + 1] / lag_s;
            out[6 + section] = (signal - x[6 + section]) / lag_s;
            signal = share * signal + (1.0 - share) * x[6 + section];
        }
        out[10] = (signal - x[10]) / servo.motor_lag_s;
        out
    }

    /// A log of them, its columns with such noise.
    fn simulate(self, platform: &Config, rows: &[Row], noise: [f64; SENSED], seed: u64) -> Simulated {
        let rng = &mut rng(seed, 3);
        let mut simulated = Simulated::default();
        let mut x = State::default();
        let step_s = ROW_S / STEPS as f64;
        for (k, row) in rows.iter().enumerate() {
            simulated.push(sensed(row, x[2], x[10]), noise, x[0], rng);
            let Some(next) = rows.get(k + 1) else { break };
            for step in 0..STEPS {
                let at = |part: usize| between(row, next, part as f64 / STEPS as f64);
                let slope = self.derivative(platform, &at(step), &x);
                let guess: State = std::array::from_fn(|i| x[i] + step_s * slope[i]);
                let end = self.derivative(platform, &at(step + 1), &guess);
                x = std::array::from_fn(|i| x[i] + 0.5 * step_s * (slope[i] + end[i]));
            }
        }
        simulated
    }
}

#[test]
fn a_bearing_that_holds_by_bristles_is_no_gap() {
    for (excitation, bend) in [(Excitation::RateTable, 0.0), (Excitation::Manoeuvre, 0.0), (Excitation::RateTable, 0.7)]
    {
        let platform = drifted(&Config::consistent(), 0.6, 23);
        let log = as_log(
            &Bristles { bend }.simulate(&platform, &rows(excitation, 14.0, 23), noise(2e-5, 1.0), 23).converted(),
        );
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{excitation:?}, {bend}: {:?}", names(&diagnosis));
    }
}

/// Slews of a table between rests, about a level axis: the rate at a time.
fn slewed(t: f64) -> f64 {
    const SLEWS: [(f64, f64, f64); 9] = [
        (0.3, 1.1, 0.5),
        (2.2, 0.8, -0.9),
        (3.8, 1.3, 0.7),
        (5.9, 0.7, 0.4),
        (7.2, 1.0, -0.6),
        (8.9, 1.2, 0.9),
        (10.8, 0.8, -0.5),
        (12.3, 1.0, -0.8),
        (14.1, 1.1, 0.6),
    ];
    let slew = |&(from, length, rate): &(f64, f64, f64)| {
        let along = ((t - from).min(from + length - t) / 0.15).clamp(0.0, 1.0);
        rate * (1.5 - along) * 2.0 * along * along
    };
    SLEWS.iter().map(slew).sum()
}

/// What holds the gimbal between two slews hangs on less turning than the logged rate tells.
#[test]
fn a_bearing_that_rests_between_slews_is_no_gap() {
    let row = |k: usize| Row {
        accel_x_mps2: 3.3,
        accel_y_mps2: 9.2,
        vehicle_rate_radps: slewed(k as f64 * ROW_S),
        ..Row::default()
    };
    let platform = drifted(&Config::consistent(), 0.5, 29);
    let rows: Vec<Row> = (0..16_000).map(row).collect();
    let log = as_log(&Bristles { bend: 0.0 }.simulate(&platform, &rows, noise(3e-5, 4.0), 29));
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "no_gap", "{:?}", names(&diagnosis));
    assert!(
        diagnosis.record.notes.iter().any(|note| note.starts_with("the bearing rests")),
        "{:?}",
        diagnosis.record.notes
    );
}
