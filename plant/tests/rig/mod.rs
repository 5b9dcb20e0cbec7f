//! What the tests of effects share: plants with one effect, flights, steady states.

#![allow(dead_code, reason = "each test file uses a part of it")]

use gimbal_plant::{Effect, Plant, Row, Sample};
use gimbal_servo::Config;

pub(crate) const GRAVITY_MPS2: f64 = 9.806_65;

/// The consistent plant with one effect.
pub(crate) fn with(name: &str, values: &[f64]) -> Plant {
    on(&Config::consistent(), name, values)
}

/// A plant of the configuration with one effect.
pub(crate) fn on(config: &Config, name: &str, values: &[f64]) -> Plant {
    Plant::new(config).unwrap().with_effect(Effect::from_name(name).unwrap(), values).unwrap()
}

pub(crate) fn nominal() -> Plant {
    Plant::new(&Config::consistent()).unwrap()
}

/// No friction, no unbalance.
pub(crate) fn bare() -> Config {
    Config::consistent().without_friction().without_unbalance()
}

/// Turning at a constant rate under constant acceleration.
pub(crate) fn turning(rate_radps: f64) -> Row {
    Row {
        accel_x_mps2: 3.0 * GRAVITY_MPS2,
        accel_y_mps2: 4.0 * GRAVITY_MPS2,
        accel_z_mps2: GRAVITY_MPS2,
        vehicle_rate_radps: rate_radps,
        cross_rate_radps: 0.7,
        ..Row::default()
    }
}

/// Runs a row long enough for every transient to die, from settled, and returns the last sample.
pub(crate) fn steady(plant: &Plant, row: &Row, periods: usize) -> Sample {
    plant.run_from(plant.settled(row), std::iter::repeat_n(*row, periods + 1)).last().unwrap()
}

/// Two seconds in which every law has something to do, both stops included.
pub(crate) fn flight() -> Vec<Row> {
    (0..=2000)
        .map(|k| {
            let time_s = 1e-3 * f64::from(k);
            Row {
                accel_x_mps2: 40.0 * (1.3 * time_s).sin() + 2.0 * (90.0 * time_s).sin(),
                accel_y_mps2: 70.0 * (0.9 * time_s).sin() + 3.0 * (130.0 * time_s).cos(),
                accel_z_mps2: 20.0 * (2.1 * time_s).cos(),
                vehicle_rate_radps: 0.8 * (2.3 * time_s).sin() + 0.01 * (60.0 * time_s).sin(),
                cross_rate_radps: 0.5 * (1.7 * time_s).cos(),
                torque_nm: match k {
                    700..850 => 0.03,
                    1200..1350 => -0.03,
                    _ => 0.0,
                },
                ..Row::default()
            }
        })
        .collect()
}

#[track_caller]
pub(crate) fn assert_close(value: f64, exact: f64, tolerance: f64) {
    assert!((value - exact).abs() <= tolerance, "{value} is not {exact} within {tolerance}");
}
