//! The platform of three gimbals, against three plants and rotation matrices in f64.

use gimbal_plant::Platform;
use gimbal_servo::platform::{Axis, Config, Gimbal, Input};
use gimbal_servo::{BuildError, Fixed, Number, estimator};

type Vector = [f64; 3];

const ROWS: usize = 3_000;
const PERIOD_S: f64 = 1e-3;

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vehicle that thrusts along y, shakes and turns about all three axes, with the gimbal angles it has then.
fn row(k: usize) -> Input<f64> {
    let t = k as f64 * PERIOD_S;
    Input {
        accel_mps2: [5.0 * (3.0 * t).sin(), 90.0 * (1.0 - (-4.0 * t).exp()), 9.8 + 4.0 * (2.0 * t).cos()],
        vehicle_rate_radps: [0.4 * (1.7 * t).sin(), 0.3 * (2.3 * t).cos(), 0.5 * (1.1 * t).sin()],
        gimbal_angle_rad: [0.3 * t, 0.5 * (0.9 * t).sin(), -0.4 * t],
        torque_nm: [0.002 * (5.0 * t).sin(), 0.0, 0.001],
    }
}

/// phi in the stable member's axes and velocity error after the last row, from three plants.
fn reference(config: &Config) -> (Vec<Vector>, Vector) {
    let platform = Platform::new(config).expect("a platform").with_tolerance(1e-9);
    let samples: Vec<_> = platform.run((0..ROWS).map(row)).collect();
    let velocity = samples.last().expect("rows").velocity_error_mps;
    (samples.iter().map(|sample| sample.attitude_error_rad).collect(), velocity)
}

/// Largest difference of phi over its peak, and of the velocity error over its norm.
fn differences<N: Number>(config: &Config) -> (f64, f64) {
    let (angles, velocity) = reference(config);
    let law = config.build::<N>().expect("a platform that builds");
    let mut state = law.start();
    let (mut largest, mut peak) = (0.0_f64, 0.0_f64);
    for (k, angle) in angles.iter().enumerate() {
        let output = law.step(&mut state, &law.input(&row(k)));
        assert!(!output.gimbal_lock);
        let found = law.angle_rad(output.attitude_error_rad);
        for axis in 0..3 {
            largest = largest.max((found[axis] - angle[axis]).abs());
            peak = peak.max(angle[axis].abs());
        }
    }
    let found = law.velocity_error_mps(&state);
    let error: Vector = core::array::from_fn(|axis| found[axis] - velocity[axis]);
    (largest / peak, (dot(error, error) / dot(velocity, velocity)).sqrt())
}

/// The friction tables and the sine of the gimbal angles are good to 1e-3 and 1e-7; between rows the plant has linear
/// inputs and the law their mean.
#[test]
fn cross_attitude_and_velocity_follow_three_plants_in_every_order() {
    use Axis::{X, Y, Z};
    for order in [[X, Y, Z], [X, Z, Y], [Y, Z, X], [Z, Y, X]] {
        let config = Config::new(order);
        let (attitude, velocity) = differences::<f32>(&config);
        assert!(attitude < 4e-3 && velocity < 4e-3, "f32 {order:?}: {attitude:.2e} {velocity:.2e}");
    }
    let (attitude, velocity) = differences::<Fixed>(&Config::new([Z, X, Y]));
    assert!(attitude < 4e-3 && velocity < 4e-3, "fixed: {attitude:.2e} {velocity:.2e}");
}

/// One axis alone is the one-axis model, and (7) then gives `(a_y phi, -a_x phi)`.
#[test]
fn closed_form_gimbal_angles_of_zero_give_three_axes_by_themselves() {
    let config = Config::new([Axis::X, Axis::Y, Axis::Z]);
    let law = config.build::<f32>().unwrap();
    let alone = config.gimbals[2].servo.build::<f32>().unwrap();
    let (mut state, mut single) = (law.start(), alone.start());
    for _ in 0..500 {
        let input = Input { accel_mps2: [3.0, 0.0, 0.0], torque_nm: [0.0, 0.0, 5e-3], ..Input::default() };
        let output = law.step(&mut state, &law.input(&input));
        let row = gimbal_servo::Input { accel_x_mps2: 3.0, torque_nm: 5e-3, ..gimbal_servo::Input::default() };
        let one = alone.step(&mut single, row);
        assert_eq!(output.axes[2].gimbal_angle_rad.to_bits(), one.gimbal_angle_rad.to_bits());
    }
    let [x, y, _] = law.velocity_error_mps(&state);
    let [of_x, of_y] = alone.velocity_error_mps(&single);
    let size = of_x.hypot(of_y);
    // The other two axes see the same 3 m/s2 on their unbalance, which tilts them across it.
    assert!((y - of_y).abs() < 1e-5 * size && x.abs() < 1e-9 + of_x.abs() + size, "{x} {y} beside {of_x} {of_y}");
}

#[test]
fn closed_form_estimates_turn_with_the_inner_gimbal() {
    let config = Config::alike(
        [Axis::X, Axis::Y, Axis::Z],
        gimbal_servo::Config::consistent().without_friction(),
        estimator::Config::default(),
    );
    let law = config.build::<f32>().unwrap();
    for (angle, along) in [(0.0, 0), (core::f64::consts::FRAC_PI_2, 1)] {
        let mut state = law.start();
        let mut last = None;
        for k in 0..300_u32 {
            let gimbal_angle_rad = [0.0, 0.0, angle];
            law.step(&mut state, &law.input(&Input { gimbal_angle_rad, ..Input::default() }));
            // Readings that differ from row to row, as real ones do.
            let ripple = 1e-7 * f64::from(k % 2);
            let measured = law.measured([Some(1e-3 + ripple), Some(ripple), Some(ripple)], [Some(1e-3 + ripple); 3]);
            last = Some(law.estimate(&mut state, &measured));
        }
        let found = law.angle_rad(last.unwrap().attitude_error_rad);
        // phi = Bo theta / H about the outer axis; by a right angle of the inner gimbal that is the stable member's -y.
        let size = 1e-3 / config.gimbals[0].servo.gyro.low_frequency_gain();
        assert!((found[along].abs() - size).abs() < 0.01 * size, "{found:?} {size}");
        assert!(found[1 - along].abs() < 0.01 * size, "{found:?} {size}");
    }
}

#[test]
fn closed_form_what_is_wrong_with_a_platform_is_told() {
    let same = Config::new([Axis::X, Axis::Y, Axis::X]).build::<f32>().unwrap_err();
    assert_eq!(same, BuildError::SameAxis);
    let mut config = Config::new([Axis::X, Axis::Y, Axis::Z]);
    let slow: &mut Gimbal = &mut config.gimbals[1];
    slow.servo.period_s = 2e-3;
    let error = config.build::<f32>().unwrap_err();
    assert!(matches!(error, BuildError::OutOfRange { field: "gimbals.period_s", .. }), "{error}");
}

#[test]
fn closed_form_gimbal_lock_and_wrong_angles_are_bits() {
    let law = Config::new([Axis::X, Axis::Y, Axis::Z]).build::<f32>().unwrap();
    let mut state = law.start();
    let locked = Input { gimbal_angle_rad: [0.0, 1.55, 0.0], vehicle_rate_radps: [1.0; 3], ..Input::default() };
    let output = law.step(&mut state, &law.input(&locked));
    assert!(output.gimbal_lock && output.attitude_error_rad.iter().all(|angle| angle.is_finite()));
    let mut wrong = law.input(&Input::default());
    wrong.gimbal_angle_rad[2] = f32::NAN;
    let output = law.step(&mut state, &wrong);
    assert!(output.faults.contains(gimbal_servo::Faults::INPUT_NOT_FINITE));
    assert!(output.attitude_error_rad.iter().all(|angle| angle.is_finite()));
}
