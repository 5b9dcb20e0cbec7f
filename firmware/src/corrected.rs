//! The law with effects, as a diagnosis corrects it: cases for `digest` and `cost`.

use crate::cases::{Case, FLIGHT, mix, with_sums};
use crate::effects::{all, three};
use gimbal_servo::effects::{Config as Effects, Law};
use gimbal_servo::{Input, Number};

/// One run of the law with effects.
#[derive(Debug, Clone, Copy)]
pub struct Corrected {
    /// Configuration and rows.
    pub case: Case,
    /// What the axis does beside its nominal equations.
    pub effects: fn() -> Effects,
    /// Images of the law in f32 and in fixed point, made by the build script.
    pub images: [&'static [u8]; 2],
}

macro_rules! image {
    ($name:literal) => {
        include_bytes!(concat!(env!("OUT_DIR"), "/", $name, ".image"))
    };
}

/// Every case: all effects under noise, through contact and release, and three of them in flight.
pub const CASES: [Corrected; 2] = [
    Corrected { case: Case { name: "effects-noise", row: noise_row, steps: 3_000, ..FLIGHT }, ..FLIGHT_WITH_ALL },
    Corrected {
        case: Case { name: "effects-flight", steps: 3_000, ..FLIGHT },
        effects: three,
        images: [image!("three-f32"), image!("three-fixed")],
    },
];

/// The recorded flight with every effect.
pub const FLIGHT_WITH_ALL: Corrected = Corrected {
    case: Case { name: "flight-with-effects", ..FLIGHT },
    effects: all,
    images: [image!("all-f32"), image!("all-fixed")],
};

impl Corrected {
    /// As [`Case::digest`].
    #[must_use]
    #[inline(never)]
    pub fn digest<N: Number>(&self) -> u64 {
        let built = (self.case.config)().build_with::<N>(&(self.effects)());
        built.as_ref().map_or(0, |law| self.digest_of(law))
    }

    /// The same by the law of an image, which needs no room beside the law; 0 if there is none in it.
    #[must_use]
    #[inline(never)]
    pub fn image_digest<N: Number>(&self, image: &[u8]) -> u64 {
        let mut law = Law::<N>::BLANK;
        law.read_image(image).map_or(0, |()| self.digest_of(&law))
    }

    fn digest_of<N: Number>(&self, law: &Law<N>) -> u64 {
        let mut state = law.start();
        let outputs = self.case.outputs(law.axis(), |row| law.step(&mut state, row));
        with_sums(outputs, law.axis(), state.axis())
    }
}

/// Forces, rate and torque along lines between random values, 20 a second; once a second a torque that throws the gyro to
/// its stop.
fn noise_row(k: u32) -> Input<f64> {
    const STEPS: u32 = 50;
    let (from, part) = (k / STEPS, f64::from(k % STEPS) * 0.02);
    let noise = |signal: u32, largest: f64| {
        let at = |knot: u32| f64::from(mix(8 * knot + signal).cast_signed()) * (largest / 2_147_483_648.0);
        at(from) + (at(from + 1) - at(from)) * part
    };
    let blow_nm = if (400..480).contains(&(k % 1_000)) { 0.034 } else { 0.0 };
    Input {
        accel_x_mps2: noise(1, 30.0),
        accel_y_mps2: noise(2, 30.0),
        accel_z_mps2: noise(3, 30.0),
        vehicle_rate_radps: noise(4, 0.5),
        torque_nm: blow_nm + noise(5, 2e-3),
        ..Input::default()
    }
}
