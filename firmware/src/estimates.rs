//! Digests of estimator and gap monitor on the model's own signals with a pick-off's noise, and of a platform of three gimbals.

use crate::cases::Case;
use crate::noise::Noise;
use gimbal_servo::platform::{self, Axis};
use gimbal_servo::{Digest, Number, estimator, monitor};

/// Steps of the platform's run.
pub const PLATFORM_STEPS: u32 = 2_000;
/// One reading in so many is missing.
const MISSING: u32 = 97;

/// Digest of every estimate and of every report of the monitor, the sums too; 0 if a law cannot be built.
#[must_use]
#[inline(never)]
pub fn digest<N: Number>(case: &Case) -> u64 {
    let config = (case.config)();
    // By reference: laws are some kilobytes, and moving them out would make copies.
    let built = config.build::<N>();
    let Ok(axis) = &built else { return 0 };
    let built = estimator::Config::default().build::<N>(&config);
    let Ok(law) = &built else { return 0 };
    let built = monitor::Config::default().build::<N>(&config, law.gyro_exponent());
    let Ok(test) = &built else { return 0 };
    let (mut model, mut state, mut watch) = (axis.start(), law.start(), test.start());
    let (mut digest, mut noise) = (Digest::default(), Noise::new());
    for k in 0..case.steps {
        let modelled = axis.step(&mut model, case.input(axis, k));
        let si = axis.units().output(&modelled);
        let theta = si.gyro_angle_rad + noise.next(2e-6);
        let torque = si.motor_torque_nm + noise.next(1e-5);
        let measured = law.measured((k % MISSING != MISSING - 1).then_some(theta), Some(torque));
        let estimate = law.step(&mut state, &measured, axis, &model, modelled.faults);
        add_estimate(&mut digest, &law.si(&estimate));
        let report = test.step(&mut watch, measured.gyro_angle_rad, &model);
        add(&mut digest, report.residual_rad.to_f64(test.residual_exponent()));
        add(&mut digest, report.score.to_f64(0));
        digest.add(&[u8::from(report.disagrees), report.regime as u8]);
    }
    for sum in
        law.velocity_correction_mps(&state).into_iter().chain([law.offset_rad(&state), law.offset_bound_rad(&state)])
    {
        add(&mut digest, sum);
    }
    digest.value()
}

/// Digest of a platform's attitude error, estimates and sums; 0 if the law cannot be built.
#[must_use]
#[inline(never)]
pub fn platform_digest<N: Number>() -> u64 {
    let built = platform::Config::new([Axis::Z, Axis::X, Axis::Y]).build::<N>();
    let Ok(law) = &built else { return 0 };
    let mut state = law.start();
    let (mut digest, mut noise) = (Digest::default(), Noise::new());
    for k in 0..PLATFORM_STEPS {
        let output = law.step(&mut state, &law.input(&platform_row(k)));
        let mut readings = [(None, None); 3];
        for (reading, axis) in readings.iter_mut().zip(&output.axes) {
            digest.add_output(axis);
            // What the law has for theta and torque of its own loops, in units of its own, is not told; any reading serves.
            *reading = (Some(noise.next(1e-4)), Some(noise.next(1e-3)));
        }
        let measured = law.measured(readings.map(|reading| reading.0), readings.map(|reading| reading.1));
        let estimate = law.estimate(&mut state, &measured);
        for angles in [output.attitude_error_rad, estimate.attitude_error_rad, estimate.bound_rad] {
            for angle in law.angle_rad(angles) {
                add(&mut digest, angle);
            }
        }
    }
    for sum in law.velocity_error_mps(&state).into_iter().chain(law.velocity_correction_mps(&state)) {
        add(&mut digest, sum);
    }
    digest.value()
}

/// Three gimbals that turn steadily under a force that swings.
fn platform_row(k: u32) -> platform::Input<f64> {
    let time = f64::from(k) * 1e-3;
    let swing = f64::from(k % 500) * 4e-3 - 1.0;
    platform::Input {
        accel_mps2: [5.0 * swing, 60.0, 9.8 - 2.0 * swing],
        vehicle_rate_radps: [0.3 * swing, 0.1, -0.2 * swing],
        gimbal_angle_rad: [0.4 * time, 0.3 * swing, -0.5 * time],
        torque_nm: [0.002 * swing, 0.0, 0.001],
    }
}

fn add_estimate(digest: &mut Digest, estimate: &estimator::Estimate<f64>) {
    for value in
        [estimate.gimbal_angle_rad, estimate.bound_rad, estimate.disturbance_torque_nm, estimate.innovation_rad]
    {
        add(digest, value);
    }
    digest.add(&estimate.flags.bits().to_le_bytes());
}

fn add(digest: &mut Digest, value: f64) {
    digest.add(&value.to_bits().to_le_bytes());
}
