//! The minute that the program `flight` flies, without a double: the law is an image made where the program is built, and
//! the sensor gives whole counts, which a factor takes to the law's full scales.
//!
//! A count is 1 mm/s2 of acceleration and 0.001 deg/s of rate.

use crate::cases::{FLIGHT, counts};
use gimbal_servo::{Config, Digest, Fixed, Input, Number};

include!(concat!(env!("OUT_DIR"), "/minute.rs"));

/// Steps: the recorded flight six times over.
pub const STEPS: u32 = 60_000;

/// A number system that the flight has an image and sensor factors for.
pub trait Flown: Number {
    /// The law's image.
    const IMAGE: &'static [u8];
    /// What a count of acceleration, and of rate, is to the law.
    const COUNTS: [Self::Factor; 2];
    /// A factor.
    type Factor: Copy;
    /// A reading as the law takes it.
    fn signal(counts: i32, factor: Self::Factor) -> Self;
}

impl Flown for f32 {
    const IMAGE: &'static [u8] = include_bytes!(concat!(env!("OUT_DIR"), "/law-f32.image"));
    const COUNTS: [f32; 2] = F32_COUNTS;
    type Factor = f32;

    #[expect(clippy::cast_precision_loss, reason = "counts are below 2^24")]
    fn signal(counts: i32, factor: f32) -> f32 {
        counts as f32 * factor
    }
}

impl Flown for Fixed {
    const IMAGE: &'static [u8] = include_bytes!(concat!(env!("OUT_DIR"), "/law-fixed.image"));
    /// With 16 bits of fraction.
    const COUNTS: [i32; 2] = FIXED_COUNTS;
    type Factor = i32;

    #[expect(clippy::cast_possible_truncation, reason = "the law's full scales hold every reading")]
    fn signal(counts: i32, factor: i32) -> Fixed {
        Fixed::from_raw(((i64::from(counts) * i64::from(factor)) >> 16) as i32)
    }
}

/// The law of the axis that flies.
#[must_use]
pub fn config() -> Config {
    Config::consistent()
}

/// What the sensor reads at row `k`, as the law takes it: acceleration along x, y and z, and the rate.
#[must_use]
pub fn signals<N: Flown>(k: u32) -> [N; 4] {
    let [accel, rate] = N::COUNTS;
    let [x, y, z, vehicle] = counts(k % FLIGHT.steps);
    [N::signal(x, accel), N::signal(y, accel), N::signal(z, accel), N::signal(vehicle, rate)]
}

/// The law's input of these signals.
#[must_use]
pub fn row<N: Flown>([x, y, z, rate]: [N; 4]) -> Input<N> {
    Input { accel_x_mps2: x, accel_y_mps2: y, accel_z_mps2: z, vehicle_rate_radps: rate, ..Input::default() }
}

/// What `flight` must reach in this number system: digest of all outputs of a law built here; 0 if it cannot be built.
#[must_use]
pub fn digest<N: Flown>() -> u64 {
    let Ok(law) = config().build::<N>() else { return 0 };
    let (mut state, mut digest) = (law.start(), Digest::default());
    for k in 0..STEPS {
        digest.add_output(&law.step(&mut state, row(signals(k))));
    }
    digest.value()
}
