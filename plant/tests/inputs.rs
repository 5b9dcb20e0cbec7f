//! How inputs act: between rows, about the spin axis, and through iterators.

use gimbal_plant::{Between, Logged, Plant, Quantity, Row, Sample, Stop};
use gimbal_servo::{Config, Interpolation};

fn rows() -> Vec<Row> {
    (0..400)
        .map(|k| {
            let time_s = 1e-3 * f64::from(k);
            Row {
                accel_y_mps2: 90.0 * (9.0 * time_s).sin(),
                vehicle_rate_radps: 0.4 * (20.0 * time_s).cos(),
                spin_rate_radps: 0.3,
                ..Row::default()
            }
        })
        .collect()
}

/// The same but for the inputs, which were given differently.
fn assert_same(a: Sample, b: Sample) {
    let logged = Logged { inputs: a.logged.inputs, ..b.logged };
    assert_eq!(a, Sample { logged, ..b });
}

#[test]
fn closed_form_held_rows_are_lines_from_a_row_to_itself() {
    let mut config = Config::consistent();
    let line = Plant::new(&config).unwrap();
    config.interpolation = Interpolation::Held;
    let held = Plant::new(&config).unwrap();
    let (mut a, mut b) = (line.start(), held.start());
    for pair in rows().windows(2) {
        assert_same(line.step(&mut a, &pair[0], &pair[0]), held.step(&mut b, &pair[0], &pair[1]));
    }
}

#[test]
fn closed_form_the_mean_of_two_rows_is_held() {
    let plant = Plant::new(&Config::consistent()).unwrap();
    let mean = plant.clone().with_inputs(Between::Mean);
    let (mut a, mut b) = (plant.start(), mean.start());
    for pair in rows().windows(2) {
        let middle = pair[0].toward(&pair[1], 0.5);
        assert_same(plant.step(&mut a, &middle, &middle), mean.step(&mut b, &pair[0], &pair[1]));
    }
}

#[test]
fn closed_form_steps_and_iterator_are_the_same_run() {
    let plant = Plant::new(&Config::consistent()).unwrap();
    let rows = rows();
    let mut state = plant.start();
    let mut samples = vec![plant.sample(&state, &rows[0])];
    samples.extend(rows.windows(2).map(|pair| plant.step(&mut state, &pair[0], &pair[1])));
    assert_eq!(plant.run(rows).collect::<Vec<_>>(), samples);
}

#[test]
fn closed_form_cross_coupling_adds_the_integral_of_theta_times_the_spin_rate() {
    // (2) integrated with the coupling: Jo theta' + Bo theta = H (phi + w_x integral of theta)
    let mut config = Config::consistent();
    config.gyro.cross_coupling = true;
    config.period_s = 0.25e-3;
    let mut integral = 0.0;
    let mut previous = 0.0;
    let mut worst = 0.0_f64;
    let mut seen = 0.0_f64;
    for sample in Plant::new(&config).unwrap().run(rows()) {
        integral += 0.5 * config.period_s * (sample.gyro_angle_rad + previous);
        previous = sample.gyro_angle_rad;
        let gyro = &config.gyro;
        let left = gyro.float_inertia_kg_m2 * sample.gyro_rate_radps + gyro.damping_nm_s_per_rad * previous;
        let coupling = gyro.angular_momentum_nm_s * 0.3 * integral;
        let right = gyro.angular_momentum_nm_s * sample.gimbal_angle_rad;
        worst = worst.max((left - right - coupling).abs());
        seen = seen.max(coupling.abs());
    }
    // the trapezoids are off by 1e-3 of the integral at most, theta turning within some milliseconds
    assert!(worst < 1e-3 * seen, "{worst} {seen}");
}

#[test]
fn closed_form_on_the_stop_the_spin_rate_decides_the_release() {
    // phi' = 0 would hold; H (phi' + theta w_x) < 0 on the positive stop releases as soon as phi' < -theta w_x.
    let mut config = Config::consistent().without_friction().without_unbalance();
    let release = |config: &Config| {
        let plant = Plant::new(config).unwrap();
        let mut state = plant.start();
        let row = Row { torque_nm: 0.03, spin_rate_radps: -1.0, ..Row::default() };
        let samples: Vec<_> = (0..1000).map(|_| plant.step(&mut state, &row, &row)).collect();
        let time_s = state.events()[1].time_s;
        let before = samples.iter().rfind(|sample| sample.time_s <= time_s).unwrap();
        let after = samples.iter().find(|sample| sample.time_s >= time_s).unwrap();
        (time_s, before.gimbal_rate_radps, after.gimbal_rate_radps)
    };
    let (late_s, before, after) = release(&config);
    assert!(before > 0.0 && after < 0.0, "{before} {after}");
    config.gyro.cross_coupling = true;
    let (early_s, before, after) = release(&config);
    let limit = config.gyro.stop_angle_rad;
    assert!(early_s < late_s && before > limit && after < limit, "{before} {after}");
}

#[test]
fn closed_form_a_state_set_by_hand_is_the_settled_one() {
    let row = Row { accel_y_mps2: 50.0, vehicle_rate_radps: 0.3, ..Row::default() };
    let plant = Plant::new(&Config::consistent()).unwrap();
    let mut settled = plant.settled(&row);
    let mut by_hand = plant.start();
    let torque = plant.sample(&settled, &row).motor_torque_nm;
    by_hand.set(Quantity::Integrator, torque);
    by_hand.set(Quantity::MotorTorque, torque);
    assert_eq!(plant.step(&mut by_hand, &row, &row), plant.step(&mut settled, &row, &row));
    assert!(settled.value(Quantity::GimbalAngle).abs() < 1e-15);
}

#[test]
fn closed_form_a_theta_set_beyond_the_stop_is_put_on_it() {
    let config = Config::consistent().without_friction().without_unbalance();
    let plant = Plant::new(&config).unwrap();
    let mut state = plant.start();
    state.set(Quantity::GyroAngle, -0.02);
    state.set(Quantity::GyroRate, -1.0);
    let sample = plant.step(&mut state, &Row::default(), &Row::default());
    assert_eq!(state.events()[0].side, Stop::Negative);
    assert!(sample.gyro_angle_rad.abs() <= config.gyro.stop_angle_rad);
}
