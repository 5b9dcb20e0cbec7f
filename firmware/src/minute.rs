//! The minute that the program `flight` flies, without a double: the laws are images made where the program is built, and
//! the sensors give whole counts, which a factor takes to the laws' full scales.
//!
//! | signal | a count |
//! |---|---|
//! | acceleration | 1 mm/s2 |
//! | vehicle rate | 0.001 deg/s |
//! | theta | 20 mrad over 2^16: 16 bits of the pick-off |
//! | torques | 1e-5 N m |
//!
//! theta and motor torque are those of the model in f32 with the sensors' noise, kept by the build script
//! (`firmware/build/minute.rs`). Some do not come: the estimator must do without.

use crate::cases::FLIGHT_ROWS;
use crate::onboard::{Laws, Row, Told};
use crate::profile::{self, FLIGHT_STEPS, STOPS_FROM};
use gimbal_servo::estimator::{Flags, Measured};
use gimbal_servo::{BuildError, Config, Digest, Fixed, Input, Number, monitor};

pub use crate::profile::STEPS;

include!(concat!(env!("OUT_DIR"), "/minute.rs"));

/// theta and motor torque in counts: of one flight without the torque, once all has settled, and of the one with it.
static READINGS: [[i16; 2]; 2 * FLIGHT_STEPS as usize] = include!(concat!(env!("OUT_DIR"), "/readings.rs"));

/// Signals that the sensors send at a row: acceleration along x, y and z, vehicle rate, external torque, theta, motor torque.
pub const SIGNALS: usize = 7;

/// What the sensors send at a row.
#[derive(Debug, Clone, Copy)]
pub struct Sent<N> {
    /// The signals, as the laws take them.
    pub signals: [N; SIGNALS],
    /// [`GYRO_IS_THERE`] and [`TORQUE_IS_THERE`].
    pub there: u16,
}

/// theta has been read.
pub const GYRO_IS_THERE: u16 = 1;
/// The motor torque has been read.
pub const TORQUE_IS_THERE: u16 = 2;

/// A number system that the flight has images and sensor factors for.
pub trait Flown: Number {
    /// The laws' images: axis, estimator, monitor.
    const IMAGES: [&'static [u8]; 3];
    /// What a count is to the laws: acceleration, rate, external torque, theta, motor torque.
    const COUNTS: [Self::Factor; 5];
    /// A factor.
    type Factor: Copy;
    /// A reading as the laws take it.
    fn signal(counts: i32, factor: Self::Factor) -> Self;
}

impl Flown for f32 {
    const IMAGES: [&'static [u8]; 3] = F32_IMAGES;
    const COUNTS: [f32; 5] = F32_COUNTS;
    type Factor = f32;

    #[expect(clippy::cast_precision_loss, reason = "counts are below 2^24")]
    fn signal(counts: i32, factor: f32) -> f32 {
        counts as f32 * factor
    }
}

impl Flown for Fixed {
    const IMAGES: [&'static [u8]; 3] = FIXED_IMAGES;
    /// With 16 bits of fraction.
    const COUNTS: [i64; 5] = FIXED_COUNTS;
    type Factor = i64;

    #[expect(clippy::cast_possible_truncation, reason = "the laws' full scales hold every reading")]
    fn signal(counts: i32, factor: i64) -> Fixed {
        Fixed::from_raw(((i64::from(counts) * factor) >> 16) as i32)
    }
}

/// The axis that flies.
#[must_use]
pub fn config() -> Config {
    Config::consistent()
}

/// Its gap monitor: the model is granted the tolerance that the estimator is told of.
#[must_use]
pub fn monitor() -> monitor::Config {
    monitor::Config { model_tolerance: 0.03, ..monitor::Config::default() }
}

/// What the sensors send at row `k`.
#[must_use]
pub fn sent<N: Flown>(k: u32) -> Sent<N> {
    let [accel, rate, external, theta, motor] = N::COUNTS;
    let [x, y, z, vehicle, torque] = profile::met(&FLIGHT_ROWS, k);
    let kept = if k < STOPS_FROM { k % FLIGHT_STEPS } else { k - STOPS_FROM + FLIGHT_STEPS };
    let [gyro, motor_torque] = READINGS.get(kept as usize).copied().unwrap_or_default().map(i32::from);
    let signals = [
        N::signal(x, accel),
        N::signal(y, accel),
        N::signal(z, accel),
        N::signal(vehicle, rate),
        N::signal(torque, external),
        N::signal(gyro, theta),
        N::signal(motor_torque, motor),
    ];
    Sent { signals, there: there(k) }
}

/// Now and then a reading does not come, and once in each flight theta for 30 rows.
fn there(k: u32) -> u16 {
    let outage = (7_000..7_030).contains(&(k % FLIGHT_STEPS));
    let gyro = if outage || k % 97 == 96 { 0 } else { GYRO_IS_THERE };
    let torque = if k % 389 == 388 { 0 } else { TORQUE_IS_THERE };
    gyro | torque
}

/// What the tick takes of it.
#[must_use]
pub fn row<N: Flown>(sent: &Sent<N>) -> Row<N> {
    let [x, y, z, rate, torque, gyro, motor] = sent.signals;
    Row {
        input: Input {
            accel_x_mps2: x,
            accel_y_mps2: y,
            accel_z_mps2: z,
            vehicle_rate_radps: rate,
            torque_nm: torque,
            ..Input::default()
        },
        measured: Measured {
            gyro_angle_rad: (sent.there & GYRO_IS_THERE != 0).then_some(gyro),
            motor_torque_nm: (sent.there & TORQUE_IS_THERE != 0).then_some(motor),
        },
    }
}

/// What has been told over the whole minute.
#[derive(Debug, Clone, Copy, Default)]
pub struct Seen {
    /// Rows.
    pub steps: u32,
    /// Every bit of every row.
    pub digest: Digest,
    /// Every flag that any estimate had.
    pub flags: Flags,
    /// Whether the monitor came to disagree.
    pub disagrees: bool,
}

impl Seen {
    /// Adds a row.
    pub fn add<N: Number>(&mut self, told: &Told<N>) {
        told.digest(&mut self.digest);
        self.steps += 1;
        self.flags |= told.estimate.flags;
        self.disagrees |= told.report.disagrees;
    }
}

/// What `flight` must reach in this number system, with laws built here.
///
/// # Errors
/// A law cannot be built.
pub fn seen<N: Flown>() -> Result<Seen, BuildError> {
    let laws = Laws::<N>::build()?;
    let (mut onboard, mut seen) = (laws.start(), Seen::default());
    for k in 0..STEPS {
        seen.add(&onboard.step(&row(&sent(k))));
    }
    Ok(seen)
}
