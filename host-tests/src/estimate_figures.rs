//! What the estimator and the gap monitor reach, as tables: `docs/estimator-accuracy.md` comes out of
//! `cargo run --release -p host-tests --example estimator_accuracy`.

mod page;
mod saturations;
mod watch;

pub use page::page;
pub use saturations::{Saturations, saturations};
pub use watch::{Acting, EFFECTS, Grown, Seen, Watch, monitor_law, smallest, swing, watch, watch_plant};

use gimbal_plant::Row;
use gimbal_servo::Config;
use gimbal_servo::estimator::{self, Flags};

use crate::axis::System;
use crate::estimate::{Flight, Noise, Score, estimate, saturates, score};
use crate::random::Random;
use crate::{inputs, rocket};

/// The estimator told that every parameter is exact.
#[must_use]
pub fn exact() -> estimator::Config {
    estimator::Config { tolerance: estimator::Tolerance::EXACT, ..estimator::Config::default() }
}

/// A flight without saturation.
#[derive(Debug, Clone)]
pub struct Case {
    /// What it is.
    pub name: String,
    rows: Vec<Row>,
    config: Config,
    from: usize,
}

/// The flights without saturation that there is input for.
#[must_use]
pub fn cases(manoeuvres: u64) -> Vec<Case> {
    let consistent = Config::consistent();
    let step = |name: &str, rows: Vec<Row>, config: Config| Case { name: name.into(), rows, config, from: 0 };
    let mut cases = vec![
        step("20 g on the unbalance", inputs::unbalance_profile(20.0, 1e-3), consistent.without_friction()),
        step("20 g, friction reversing", inputs::friction_profile(20.0, 1e-3), consistent.without_unbalance()),
    ];
    for seed in 0..manoeuvres {
        let rows = inputs::manoeuvre(10.0, 1e-3, seed);
        cases.push(Case { name: format!("random manoeuvre {seed}"), rows, config: consistent, from: 1000 });
    }
    for (gimbal, name) in [(rocket::Gimbal::Pitch, "rocket, pitch"), (rocket::Gimbal::Roll, "rocket, roll")] {
        if let Some(rows) = rocket::flight(gimbal, 30.0) {
            cases.push(Case { name: name.into(), rows, config: consistent, from: 1000 });
        }
    }
    cases
}

/// Parameters of the gyro, the gimbal and the servo, each changed by a factor.
pub fn altered(nominal: &Config, mut factor: impl FnMut() -> f64) -> Config {
    let mut config = *nominal;
    let (gyro, servo) = (&mut config.gyro, &mut config.servo);
    let parameters = [
        &mut gyro.damping_nm_s_per_rad,
        &mut gyro.float_inertia_kg_m2,
        &mut gyro.angular_momentum_nm_s,
        &mut gyro.stop_angle_rad,
        &mut servo.gimbal_inertia_kg_m2,
        &mut servo.gain_nm_per_rad_s,
        &mut servo.motor_lag_s,
        &mut config.bearing.load_torque_nm_per_n,
        &mut config.unbalance.x_kg_m,
    ];
    for parameter in parameters {
        *parameter *= factor();
    }
    config
}

impl Case {
    /// The case flown, read by the sensors of an estimator.
    #[must_use]
    pub fn flight(&self, config: &estimator::Config) -> Flight {
        Flight::new(&self.config, &config.sensors, &Noise::default(), &self.rows, 7)
    }

    /// How well an estimator does on readings of it.
    #[must_use]
    pub fn score_of(&self, config: &estimator::Config, flight: &Flight) -> Score {
        let estimated = estimate(System::F32, &self.config, config, &flight.readings);
        score(&self.config, flight, &estimated, self.from)
    }
}

/// A case with exact parameters; whether it saturates.
#[must_use]
pub fn free_score(case: &Case, system: System) -> (Score, bool) {
    let config = exact();
    let flight = Flight::new(&case.config, &config.sensors, &Noise::default(), &case.rows, 7);
    let estimated = estimate(system, &case.config, &config, &flight.readings);
    (score(&case.config, &flight, &estimated, case.from), saturates(&flight))
}

/// A case with every parameter wrong by up to 10 %.
#[derive(Debug, Clone, Copy)]
pub struct Wrong {
    /// How well the estimate does.
    pub score: Score,
    /// Relative error of `Bo / H`.
    pub ratio: f64,
    /// Whether the truth saturates.
    pub saturates: bool,
    /// Whether the estimate says that it does, and whether it doubts its offset.
    pub said: [bool; 2],
    /// theta's largest size over the true stop and over the nominal one.
    pub reach: [f64; 2],
}

/// Flies a case with every parameter wrong by up to 10 %; none where the loop is unstable.
#[must_use]
pub fn wrong_score(case: &Case, seed: u64) -> Option<Wrong> {
    let mut random = Random::new(seed);
    let truth = altered(&case.config, || 1.0 + random.between(-0.1, 0.1));
    truth.build::<f32>().ok()?;
    // Uniform over +-10 %: a standard deviation of 5.8 %.
    let tolerance = estimator::Tolerance::with_default(0.1 / 3.0_f64.sqrt());
    let config = estimator::Config { tolerance, ..estimator::Config::default() };
    let flight = Flight::new(&truth, &config.sensors, &Noise::default(), &case.rows, seed);
    let estimated = estimate(System::F32, &case.config, &config, &flight.readings);
    let ratio = truth.gyro.low_frequency_gain() / case.config.gyro.low_frequency_gain() - 1.0;
    let said = |flag: Flags| estimated.points.iter().any(|point| point.flags.contains(flag));
    let peak = flight.truth.iter().map(|sample| sample.gyro_angle_rad.abs()).fold(0.0, f64::max);
    Some(Wrong {
        score: score(&case.config, &flight, &estimated, case.from),
        ratio: ratio.abs(),
        saturates: saturates(&flight),
        said: [Flags::SATURATED, Flags::OFFSET_DOUBTFUL].map(said),
        reach: [&truth, &case.config].map(|config| peak / config.gyro.stop_angle_rad),
    })
}
