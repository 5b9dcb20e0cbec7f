//! The solution does not depend on how it is integrated.

use gimbal_plant::{Between, Plant, Row, Sample};
use gimbal_servo::Config;

/// Five seconds with slip reversals, both branches of (6.1) and (6.2), and both gyro stops.
fn flight() -> Vec<Row> {
    let mut seed = 7_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 32).unwrap()) / f64::from(u32::MAX) - 0.5
    };
    (0..=5000)
        .map(|k| {
            let time_s = 1e-3 * f64::from(k);
            Row {
                accel_x_mps2: 80.0 * (1.3 * time_s).sin() + noise(),
                accel_y_mps2: 130.0 * (0.9 * time_s).sin() + noise(),
                accel_z_mps2: 20.0 * (2.1 * time_s).cos() + noise(),
                vehicle_rate_radps: 20.0 * (3.0 * time_s).sin() + 0.01 * noise(),
                torque_nm: if k % 2000 > 1000 { 0.02 } else { -0.02 },
                ..Row::default()
            }
        })
        .collect()
}

fn peak(samples: &[Sample], of: impl Fn(&Sample) -> f64) -> f64 {
    samples.iter().fold(0.0, |peak, sample| f64::max(peak, of(sample).abs()))
}

fn worst(a: &[Sample], b: &[Sample], of: impl Fn(&Sample) -> f64) -> f64 {
    a.iter().zip(b).fold(0.0, |worst, (a, b)| f64::max(worst, (of(a) - of(b)).abs()))
}

type Signal = (&'static str, fn(&Sample) -> f64);

const SIGNALS: [Signal; 5] = [
    ("phi", |sample| sample.gimbal_angle_rad),
    ("theta", |sample| sample.gyro_angle_rad),
    ("motor torque", |sample| sample.motor_torque_nm),
    ("velocity", |sample| sample.velocity_error_mps[0]),
    ("position", |sample| sample.position_error_m[1]),
];

#[test]
fn closed_form_halving_the_tolerance_changes_nothing_beyond_a_billionth_of_the_peak() {
    let rows = flight();
    let plant = Plant::new(&Config::consistent()).unwrap();
    let run = |plant: &Plant| plant.run(rows.iter().copied()).collect::<Vec<_>>();
    let nominal = run(&plant);
    assert!(nominal.iter().any(|sample| sample.stop.sign() > 0.0));
    assert!(nominal.iter().any(|sample| sample.stop.sign() < 0.0));
    for tolerance in [0.5e-10, 1e-13] {
        let finer = run(&plant.clone().with_tolerance(tolerance));
        for (name, of) in SIGNALS {
            let change = worst(&nominal, &finer, of) / peak(&finer, of);
            assert!(change < 1e-9, "{name}: {change:e} at {tolerance:e}");
        }
    }
}

#[test]
fn closed_form_rows_twice_as_dense_on_the_same_lines_change_nothing() {
    let rows = flight();
    let config = Config::consistent();
    let mut dense_config = config;
    dense_config.period_s = 0.5e-3;
    let dense_rows: Vec<Row> =
        rows.windows(2).flat_map(|pair| [pair[0], pair[0].toward(&pair[1], 0.5)]).chain(rows.last().copied()).collect();
    let coarse: Vec<Sample> = Plant::new(&config).unwrap().run(rows).collect();
    let dense: Vec<Sample> = Plant::new(&dense_config).unwrap().run(dense_rows).step_by(2).collect();
    for (name, of) in SIGNALS {
        let change = worst(&coarse, &dense, of) / peak(&dense, of);
        assert!(change < 1e-9, "{name}: {change:e}");
    }
}

#[test]
fn closed_form_inputs_that_do_not_change_are_the_same_however_they_are_taken_between_rows() {
    let row = Row { accel_y_mps2: 100.0, vehicle_rate_radps: 0.5, ..Row::default() };
    let last = |between| {
        let plant = Plant::new(&Config::consistent()).unwrap().with_inputs(between);
        plant.run(std::iter::repeat_n(row, 200)).last().unwrap()
    };
    assert_eq!(last(Between::Line), last(Between::Held));
    assert_eq!(last(Between::Line), last(Between::Mean));
}

#[test]
fn closed_form_free_float_and_gimbal_keep_the_angular_momentum_relation() {
    // (2) integrated: Jo theta' + Bo theta - H phi is constant between the stops.
    let config = Config::consistent();
    let rows = flight().into_iter().map(|row| Row { torque_nm: 0.0, ..row }).take(1000);
    for sample in Plant::new(&config).unwrap().run(rows) {
        let gyro = &config.gyro;
        let constant = gyro.float_inertia_kg_m2 * sample.gyro_rate_radps
            + gyro.damping_nm_s_per_rad * sample.gyro_angle_rad
            - gyro.angular_momentum_nm_s * sample.gimbal_angle_rad;
        assert!(constant.abs() < 1e-16, "{constant:e}");
    }
}
