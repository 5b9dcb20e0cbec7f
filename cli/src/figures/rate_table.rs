//! Figure 3: the paper's check of its model on a rate table.
//!
//! A square-wave rate about the gimbal axis reverses the friction. The motor torque on both sides of a reversal gives
//! the friction's size; a step of that size, fed to the model without friction, must give the gyro angle measured. Here
//! the full model stands in for the measurement: what is checked is the method and how much of the answer the step
//! misses, because friction passes through the clamp and does not jump.

use std::fmt::Write;

use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Input};

use super::sheet::Sheet;
use super::time::{MARK_NAME, both};
use super::trace::{MOTOR, THETA, Trace};
use crate::exit::Failure;
use crate::plot::{Figure, Line, Panel};
use crate::run::model::{Initial, held};

/// The table's rate [rad/s], and how long it keeps its sign [s].
const RATE_RADPS: f64 = 0.05;
const HALF_S: f64 = 2.0;
const HALVES: usize = 4;

/// Figure 3.
pub(super) fn sheets(config: &Config) -> Result<Vec<Sheet>, Failure> {
    let full = held(config.without_unbalance());
    let rows_each = rows_in(HALF_S, full.period_s);
    let sign = |k: usize| if (k / rows_each).is_multiple_of(2) { 1.0 } else { -1.0 };
    let count = HALVES * rows_each + 1;
    let rows = (0..count).map(|k| Input {
        accel_z_mps2: STANDARD_GRAVITY_MPS2,
        vehicle_rate_radps: RATE_RADPS * sign(k.min(count - 2)),
        ..Input::default()
    });
    let table = Trace::run(&full, Initial::Settled, rows.collect())?;
    let level_nm = friction_nm(&table, rows_each);
    let steps = (0..count).map(|k| Input { torque_nm: level_nm * sign(k.min(count - 2)), ..Input::default() });
    let bare = Trace::run(&full.without_friction(), Initial::Settled, steps.collect())?;

    let title = format!(
        "Figure 3: rate table, +-{RATE_RADPS} rad/s at 1 g; friction from the motor torque {:.2} mN m, fed back as a step",
        1e3 * level_nm
    );
    let rate = table.times_s.iter().zip(&table.inputs).map(|(&time_s, row)| (time_s, row.vehicle_rate_radps));
    let mut gyro = both(&table, THETA, 1.0);
    gyro.push(Line::through("step fed back", bare.flight_points(THETA, 1.0)));
    // One reversal, close up.
    let window_s = (HALF_S - 0.02)..(HALF_S + 0.48);
    let near = |points: Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        points.into_iter().filter(|(time_s, _)| window_s.contains(time_s)).collect()
    };
    let shaded = table.marked(&[THETA, MOTOR]);
    let panels = vec![
        Panel::new("Rate of the table", "rad/s", vec![Line::through("", rate.collect())]),
        Panel::new("Motor torque", "N m", both(&table, MOTOR, 1.0)),
        Panel::new("theta, gyro angle", "rad", gyro),
    ];
    let whole = Figure { title: &title, panels, shaded: &shaded, shaded_name: MARK_NAME };
    let mut differences = vec![table.difference("theta", THETA), table.difference("motor torque", MOTOR)];
    let fed_back = Trace { plant: bare.flight.clone(), ..table };
    let method = fed_back.difference("theta", THETA);
    let caption = format!(
        "{title}. The step's gyro angle differs from the table's by at most {:.3} % of the peak, at {}: the bearing's rate \
         passes the clamp's zone, the step does not.",
        100.0 * method.of_peak,
        method.at
    );
    let mut csv = "time_s,vehicle_rate_radps,flight_gyro_angle_rad,step_gyro_angle_rad,motor_torque_nm\n".to_owned();
    for (k, time_s) in fed_back.times_s.iter().enumerate() {
        let (table, step) = (&fed_back.flight[k], &fed_back.plant[k]);
        let rate = fed_back.inputs[k].vehicle_rate_radps;
        let (theta, motor) = (table.gyro_angle_rad, table.motor_torque_nm);
        let _ = writeln!(csv, "{time_s:.6},{rate},{theta:.7e},{:.7e},{motor:.7e}", step.gyro_angle_rad);
    }
    let close_title = format!("Figure 3, close up: the reversal at {HALF_S} s");
    let close = Figure {
        title: &close_title,
        panels: vec![Panel::new(
            "theta, gyro angle",
            "rad",
            vec![
                Line::through("rate table", near(fed_back.flight_points(THETA, 1.0))),
                Line::through("step fed back", near(fed_back.plant_points(THETA, 1.0))),
            ],
        )],
        shaded: &[],
        shaded_name: "",
    };
    let close_caption = format!("{close_title}. The same shape and size, as the paper found.");
    let close = Sheet::new("3-close", 31, close_caption, &close, csv.clone(), Vec::new())?;
    differences.truncate(2);
    Ok(vec![Sheet::new("3", 30, caption, &whole, csv, differences)?, close])
}

/// Half the difference of the motor torque before and after the first reversal, each the mean of the last half second
/// before the rate turns again.
fn friction_nm(trace: &Trace, rows_each: usize) -> f64 {
    let mean = |half: usize| {
        let end = (half + 1) * rows_each;
        let last = &trace.flight[end - rows_each / 4..end];
        last.iter().map(MOTOR).sum::<f64>() / last.len() as f64
    };
    0.5 * (mean(0) - mean(1))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
fn rows_in(span_s: f64, period_s: f64) -> usize {
    (span_s / period_s).round() as usize
}
