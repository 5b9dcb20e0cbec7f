//! A log as CSV and a nominal model as TOML, as the contracts ask for them.

use std::fmt::Write;

use gimbal_servo::Config;
use serde::Serialize;

use super::drift::{DEFAULT, FRICTION_LEVEL};

/// One column: its name, digits after the point, one value a row.
pub(super) struct Column {
    pub(super) name: &'static str,
    pub(super) digits: usize,
    pub(super) values: Vec<f64>,
}

/// Header and rows.
pub(super) fn csv(columns: &[Column]) -> String {
    let rows = columns.first().map_or(0, |column| column.values.len());
    let mut text = String::with_capacity(rows * columns.len() * 11);
    for (place, column) in columns.iter().enumerate() {
        text.push_str(if place == 0 { "" } else { "," });
        text.push_str(column.name);
    }
    text.push('\n');
    for row in 0..rows {
        for (place, column) in columns.iter().enumerate() {
            text.push_str(if place == 0 { "" } else { "," });
            let _ = write!(text, "{:.*}", column.digits, column.values[row]);
        }
        text.push('\n');
    }
    text
}

#[derive(Serialize)]
struct Tolerance {
    default_relative: f64,
    friction_level: f64,
    viscous_friction: f64,
}

#[derive(Serialize)]
struct Model<'a> {
    preset: &'a str,
    servo: &'a gimbal_servo::servo::Config,
    gyro: &'a gimbal_servo::gyro::Config,
    bearing: &'a gimbal_servo::bearing::Config,
    unbalance: &'a gimbal_servo::unbalance::Config,
    tolerance: Tolerance,
}

/// The nominal model and its tolerances.
pub(super) fn model(preset: &str, config: &Config) -> String {
    let model = Model {
        preset,
        servo: &config.servo,
        gyro: &config.gyro,
        bearing: &config.bearing,
        unbalance: &config.unbalance,
        tolerance: Tolerance {
            default_relative: DEFAULT,
            friction_level: FRICTION_LEVEL,
            viscous_friction: FRICTION_LEVEL,
        },
    };
    // numbers and names alone: nothing in it can fail
    toml::to_string(&model).unwrap_or_default()
}
