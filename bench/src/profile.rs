//! What moves the vehicle, row by row.

use std::f64::consts::TAU;

use gimbal_log::{Column, Log, Needs};
use gimbal_plant::Row;
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;

use crate::scenario::{Profile, Scenario};

/// The recorded flight that is shipped: 10 s at 100 Hz, from 0.3 s before the boost.
const ROCKET: &str = include_str!("../scenarios/rocket.csv");

/// Rows as a function of time.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    profile: Profile,
    /// Rows of a log and their times.
    points: Vec<(f64, Row)>,
}

impl Motion {
    pub(crate) fn new(scenario: &Scenario) -> Result<Self, String> {
        let points = match &scenario.profile {
            Profile::Log { log } => points(scenario, log)?,
            _ => Vec::new(),
        };
        Ok(Self { profile: scenario.profile.clone(), points })
    }

    /// The last time that has a row [s].
    pub(crate) fn end_s(&self) -> f64 {
        self.points.last().map_or(f64::INFINITY, |(time_s, _)| *time_s)
    }

    /// The row at a time.
    pub(crate) fn at(&self, time_s: f64) -> Row {
        // Half a millisecond off the edges, so that rounding cannot move them.
        let since_s = time_s + 0.5e-3;
        let accelerated = if since_s < 5.0 { 20.0 * STANDARD_GRAVITY_MPS2 } else { 0.0 };
        match &self.profile {
            Profile::Rest => Row { accel_y_mps2: STANDARD_GRAVITY_MPS2, ..Row::default() },
            Profile::Unbalance => Row { accel_y_mps2: accelerated, ..Row::default() },
            Profile::Friction => {
                let turned = (since_s / 2.0).floor() % 2.0 > 0.5;
                let vehicle_rate_radps = if turned { -0.1 } else { 0.1 };
                Row { accel_y_mps2: accelerated, vehicle_rate_radps, ..Row::default() }
            }
            Profile::Sway { accel_mps2, rate_radps, frequency_hz } => {
                let angle = TAU * frequency_hz * time_s;
                Row {
                    accel_x_mps2: 0.2 * accel_mps2 * libm::cos(0.7 * angle),
                    accel_y_mps2: accel_mps2 * libm::sin(angle),
                    accel_z_mps2: STANDARD_GRAVITY_MPS2,
                    vehicle_rate_radps: rate_radps * libm::cos(1.3 * angle),
                    ..Row::default()
                }
            }
            Profile::Torque { torque_nm, off_s } => Row {
                accel_z_mps2: STANDARD_GRAVITY_MPS2,
                torque_nm: if since_s < *off_s { *torque_nm } else { 0.0 },
                ..Row::default()
            },
            Profile::Log { .. } => self.between(time_s),
        }
    }

    /// On the straight line between two rows of the log.
    fn between(&self, time_s: f64) -> Row {
        let next = self.points.partition_point(|(at_s, _)| *at_s <= time_s);
        match (next.checked_sub(1).and_then(|last| self.points.get(last)), self.points.get(next)) {
            (Some((from_s, from)), Some((to_s, to))) => from.toward(to, (time_s - from_s) / (to_s - from_s)),
            (Some((_, row)), None) | (None, Some((_, row))) => *row,
            (None, None) => Row::default(),
        }
    }
}

fn points(scenario: &Scenario, name: &str) -> Result<Vec<(f64, Row)>, String> {
    let log = if name == "rocket" {
        Log::from_source(ROCKET.as_bytes(), "rocket", Needs::Run)
    } else {
        let folder = scenario.folder.clone().unwrap_or_default();
        Log::open(&folder.join(name), Needs::Run)
    }
    .map_err(|error| error.to_string())?;
    let mut points = Vec::with_capacity(log.len());
    let mut row = Row::default();
    let mut start_s = None;
    for index in 0..log.len() {
        let cells = log.row(index);
        let keep = |value: f64, last: f64| if value.is_finite() { value } else { last };
        row.accel_x_mps2 = keep(cells[Column::AccelX], row.accel_x_mps2);
        row.accel_y_mps2 = keep(cells[Column::AccelY], row.accel_y_mps2);
        row.accel_z_mps2 = keep(cells[Column::AccelZ], row.accel_z_mps2);
        row.vehicle_rate_radps = keep(cells[Column::VehicleRate], row.vehicle_rate_radps);
        let time_s = cells[Column::Time] - *start_s.get_or_insert(cells[Column::Time]);
        // Of rows with one time the first stands.
        if points.last().is_none_or(|(last_s, _)| time_s > *last_s) {
            points.push((time_s, row));
        }
    }
    if points.len() < 2 { Err(format!("{name}: has no two rows")) } else { Ok(points) }
}
