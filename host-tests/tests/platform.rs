//! The platform of three gimbals, against three plants and rotation matrices in f64.

use gimbal_plant::{Plant, Row};
use gimbal_servo::platform::{Axis, Config, Gimbal, Input};
use gimbal_servo::{BuildError, Fixed, Number, estimator};

type Vector = [f64; 3];
type Matrix = [Vector; 3];

const ROWS: usize = 3_000;
const PERIOD_S: f64 = 1e-3;

fn times(m: &Matrix, v: Vector) -> Vector {
    core::array::from_fn(|i| m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2])
}

fn transposed(m: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| m[j][i]))
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(axis: usize) -> Vector {
    core::array::from_fn(|i| f64::from(u8::from(i == axis)))
}

/// Rodrigues' formula.
fn rotation(axis: usize, angle: f64) -> Matrix {
    let e = unit(axis);
    let columns: Matrix = core::array::from_fn(|j| {
        let v = unit(j);
        let (turned, along) = (cross(e, v), dot(e, v));
        core::array::from_fn(|i| v[i] * angle.cos() + turned[i] * angle.sin() + e[i] * along * (1.0 - angle.cos()))
    });
    transposed(&columns)
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
    let [outer, middle, inner] = config.gimbals.map(|gimbal| gimbal.axis.index());
    let of = |axis: usize| config.gimbals.iter().find(|gimbal| gimbal.axis.index() == axis).expect("an axis");
    let plants = [0, 1, 2].map(|axis| Plant::new(&of(axis).servo).expect("a plant").with_tolerance(1e-9));
    let mut states = [0, 1, 2].map(|axis| plants[axis].start());
    let (mut last, mut own): ([Row; 3], Vector) = ([Row::default(); 3], [0.0; 3]);
    let (mut angles, mut velocity, mut product) = (Vec::new(), [0.0; 3], [0.0; 3]);
    for k in 0..ROWS {
        let input = row(k);
        let [to_middle, to_outer, to_vehicle] =
            [inner, middle, outer].map(|axis| rotation(axis, input.gimbal_angle_rad[axis]));
        let in_middle = times(&to_middle, input.accel_mps2);
        let in_outer = times(&to_outer, in_middle);
        // In the axes of the middle gimbal: w = r_o e_o + r_m e_m + r_i e_i, by Cramer's rule.
        let rate = times(&transposed(&to_outer), times(&transposed(&to_vehicle), input.vehicle_rate_radps));
        let axes = [times(&transposed(&to_outer), unit(outer)), unit(middle), unit(inner)];
        let whole = dot(axes[0], cross(axes[1], axes[2]));
        let mut rates = [0.0; 3];
        rates[outer] = dot(rate, cross(axes[1], axes[2])) / whole;
        rates[middle] = dot(axes[0], cross(rate, axes[2])) / whole;
        rates[inner] = dot(axes[0], cross(axes[1], rate)) / whole;
        let mut forces = [[0.0; 3]; 3];
        (forces[outer], forces[middle], forces[inner]) = (in_outer, in_middle, input.accel_mps2);
        let mut phi = [0.0; 3];
        let mut next = [0.0; 3];
        for axis in 0..3 {
            let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
            let now = Row {
                accel_x_mps2: forces[axis][x],
                accel_y_mps2: forces[axis][y],
                accel_z_mps2: forces[axis][axis],
                vehicle_rate_radps: rates[axis],
                torque_nm: input.torque_nm[axis],
                spin_rate_radps: own[x],
                ..Row::default()
            };
            let sample = if k == 0 {
                plants[axis].sample(&states[axis], &now)
            } else {
                plants[axis].step(&mut states[axis], &last[axis], &now)
            };
            (phi[axis], next[axis], last[axis]) = (sample.gimbal_angle_rad, sample.gimbal_rate_radps, now);
        }
        own = next;
        let phi = times(&transposed(&to_middle), phi);
        let now = cross(input.accel_mps2, phi);
        for axis in 0..3 {
            velocity[axis] += if k > 0 { 0.5 * PERIOD_S * (product[axis] + now[axis]) } else { 0.0 };
        }
        product = now;
        angles.push(phi);
    }
    (angles, velocity)
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
