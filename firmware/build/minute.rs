//! What `flight` flies with: images of its laws, what a count of its sensors is to each number system, and what its gyro
//! and its motor read.

#[allow(unreachable_pub, reason = "modules of the library")]
#[path = "../src/noise.rs"]
mod noise;
#[allow(unreachable_pub, reason = "modules of the library")]
#[path = "../src/profile.rs"]
mod profile;

use gimbal_servo::{Config, Fixed, Input, Law, Number, estimator, monitor};
use noise::Noise;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// 1 mm/s2, 0.001 deg/s, 1e-5 N m, and 16 bits over the pick-off's +-10 mrad.
const ACCEL: f64 = 1e-3;
const RATE: f64 = 1e-3 * std::f64::consts::PI / 180.0;
const TORQUE: f64 = 1e-5;
const THETA: f64 = 20e-3 / 65_536.0;
/// Acceleration, rate, external torque, theta, motor torque.
const COUNTS: [f64; 5] = [ACCEL, RATE, TORQUE, THETA, TORQUE];

/// Writes `readings.rs`, the images, and `minute.rs`, which names them and holds what the counts are.
pub(crate) fn write(out: &Path, rows: &[[i16; 4]]) -> Result<(), Box<dyn Error>> {
    fs::write(out.join("readings.rs"), readings(rows)?)?;
    write_images::<f32>(out, "f32")?;
    let gyro = write_images::<Fixed>(out, "fixed")?;
    let units = *Config::consistent().build::<Fixed>()?.units();
    let scales = [units.accel, units.rate, units.torque, gyro, units.motor_torque];
    // With 16 bits of fraction.
    let fixed = COUNTS.iter().zip(scales).map(|(count, scale)| (count * 2.0_f64.powi(31 + 16 - scale)).round());
    let mut text = String::new();
    name(&mut text, "F32", "f32", COUNTS.iter().map(|count| format!("{:?}", single(*count))))?;
    name(&mut text, "FIXED", "i64", fixed.map(|factor| factor.to_string()))?;
    Ok(fs::write(out.join("minute.rs"), text)?)
}

/// Constants of one number system: its images, and what the counts are to it.
fn name(text: &mut String, number: &str, factor: &str, factors: impl Iterator<Item = String>) -> std::fmt::Result {
    let images = ["axis", "estimator", "monitor"]
        .map(|law| format!("include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{law}-{}.image\"))", number.to_lowercase()))
        .join(", ");
    writeln!(
        text,
        "/// Images of the laws: axis, estimator, monitor.\nconst {number}_IMAGES: [&[u8]; 3] = [{images}];"
    )?;
    let factors = factors.collect::<Vec<_>>().join(", ");
    writeln!(
        text,
        "/// What counts are to the laws: acceleration, rate, external torque, theta, motor torque.\n\
         #[expect(clippy::unreadable_literal, reason = \"made by the build script\")]\n\
         const {number}_COUNTS: [{factor}; 5] = [{factors}];"
    )
}

#[expect(clippy::cast_possible_truncation, reason = "rounds to the nearest")]
fn single(value: f64) -> f32 {
    value as f32
}

/// Writes the images of axis, estimator and monitor; the exponent of theta's full scale as measured.
fn write_images<N: Number>(out: &Path, number: &str) -> Result<i32, Box<dyn Error>> {
    let config = Config::consistent();
    let axis = config.build::<N>()?;
    let mut image = vec![0; Law::<N>::IMAGE_LEN];
    axis.to_image(&mut image)?;
    fs::write(out.join(format!("axis-{number}.image")), image)?;
    let law = estimator::Config::default().build::<N>(&config)?;
    let mut image = vec![0; estimator::Law::<N>::IMAGE_LEN];
    law.to_image(&mut image)?;
    fs::write(out.join(format!("estimator-{number}.image")), image)?;
    // The model is granted the tolerance that the estimator is told of.
    let settings = monitor::Config { model_tolerance: 0.03, ..monitor::Config::default() };
    let test = settings.build::<N>(&config, law.gyro_exponent())?;
    let mut image = vec![0; monitor::Law::<N>::IMAGE_LEN];
    test.to_image(&mut image)?;
    fs::write(out.join(format!("monitor-{number}.image")), image)?;
    Ok(law.gyro_exponent())
}

/// theta and motor torque in counts, as an array: what the model has for them in single precision, with the sensors' noise.
fn readings(rows: &[[i16; 4]]) -> Result<String, Box<dyn Error>> {
    let law = Config::consistent().build::<f32>()?;
    let sensors = estimator::Sensors::default();
    let (mut state, mut noise, mut text) = (law.start(), Noise::new(), String::from("[\n"));
    for k in 0..profile::STEPS {
        let [x, y, z, rate, torque] = profile::met(rows, k).map(f64::from);
        let output = law.step(
            &mut state,
            Input {
                accel_x_mps2: single(x) * single(ACCEL),
                accel_y_mps2: single(y) * single(ACCEL),
                accel_z_mps2: single(z) * single(ACCEL),
                vehicle_rate_radps: single(rate) * single(RATE),
                torque_nm: single(torque) * single(TORQUE),
                ..Input::default()
            },
        );
        // The first flight is not kept, so that what begins with it has died away.
        if (profile::FLIGHT_STEPS..2 * profile::FLIGHT_STEPS).contains(&k) || k >= profile::STOPS_FROM {
            let gyro = f64::from(output.gyro_angle_rad) + noise.next(sensors.gyro_noise_rad);
            let motor = f64::from(output.motor_torque_nm) + noise.next(sensors.motor_torque_noise_nm);
            writeln!(text, "    [{}, {}],", count(gyro / THETA)?, count(motor / TORQUE)?)?;
        }
    }
    Ok(text + "]\n")
}

/// A reading in counts of 16 bits.
#[expect(clippy::cast_possible_truncation, reason = "limits are checked")]
fn count(value: f64) -> Result<i16, String> {
    let rounded = value.round();
    let fits = (f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&rounded);
    if fits { Ok(rounded as i16) } else { Err(format!("a reading of {rounded} counts is more than 16 bits hold")) }
}
