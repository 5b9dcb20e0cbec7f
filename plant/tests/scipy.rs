//! Against the Radau method of `SciPy`, the servo in partial fractions: the table and the program that made it lie beside.

use gimbal_plant::{Plant, Row, Sample};
use gimbal_servo::Config;

const TABLE: &str = include_str!("reference.csv");

/// Largest difference over the peak, for each column of the scenario.
fn differences(scenario: &str, samples: &[Sample]) -> [f64; 7] {
    let mut worst = [0.0_f64; 7];
    let mut peak = [0.0_f64; 7];
    let mut rows = 0;
    for line in TABLE.lines().filter(|line| line.starts_with(scenario)) {
        let cells: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        let sample = samples.iter().find(|sample| (sample.time_s - 1e-3 * cells[0]).abs() < 1e-9).unwrap();
        let values = [
            sample.gimbal_angle_rad,
            sample.gyro_angle_rad,
            sample.motor_torque_nm,
            sample.velocity_error_mps[0],
            sample.velocity_error_mps[1],
            sample.position_error_m[0],
            sample.position_error_m[1],
        ];
        for (index, value) in values.into_iter().enumerate() {
            worst[index] = worst[index].max((value - cells[index + 1]).abs());
            peak[index] = peak[index].max(cells[index + 1].abs());
        }
        rows += 1;
    }
    assert!(rows > 20);
    std::array::from_fn(|index| worst[index] / peak[index])
}

#[test]
fn cross_three_hundred_thousand_dyne_cm_onto_the_stop_and_off_again() {
    let config = Config::consistent().without_friction().without_unbalance();
    let row = Row { accel_x_mps2: 10.0, accel_y_mps2: 20.0, torque_nm: 0.03, ..Row::default() };
    let samples: Vec<_> = Plant::new(&config).unwrap().run(std::iter::repeat_n(row, 601)).collect();
    let differences = differences("stopped", &samples);
    assert!(differences.iter().all(|&difference| difference < 1e-9), "{differences:?}");
}

#[test]
fn cross_turning_flight_with_friction_past_the_viscous_break() {
    let rows = (0..=800).map(|k| {
        let time_s = 1e-3 * f64::from(k);
        Row {
            accel_x_mps2: 60.0 * (5.0 * time_s).sin(),
            accel_y_mps2: 130.0 * (7.0 * time_s + 0.3).sin(),
            accel_z_mps2: 20.0 * (11.0 * time_s).cos(),
            vehicle_rate_radps: 17.0 * (13.0 * time_s + 0.1).sin(),
            ..Row::default()
        }
    });
    let samples: Vec<_> = Plant::new(&Config::consistent()).unwrap().run(rows).collect();
    let differences = differences("flight", &samples);
    assert!(differences.iter().all(|&difference| difference < 1e-9), "{differences:?}");
}
