//! Figures over time: the torque steps (2-1, 2-2), the profile (6) and the 20 g runs (7, 9).

use gimbal_servo::{Config, Input};

use super::sheet::Sheet;
use super::trace::{MOTOR, PHI, POSITION, Signal, THETA, Trace, VELOCITY};
use crate::exit::Failure;
use crate::plot::{Figure, Line, Panel};
use crate::run::model::{Initial, held};
use crate::run::profile::Profile;
use crate::sweep::trial::Case;

const RADIAN_DEG: f64 = 180.0 / std::f64::consts::PI;
pub(super) const MARK_NAME: &str = "differ by more than 0.1 % of the peak";

/// Two lines of a signal: the flight code, and the plant over it.
pub(super) fn both(trace: &Trace, signal: Signal, factor: f64) -> Vec<Line<'static>> {
    vec![
        Line::through("flight code", trace.flight_points(signal, factor)),
        Line::through("plant", trace.plant_points(signal, factor)),
    ]
}

/// theta in degrees with its stops, as far as the run comes near them.
fn gyro_panel(trace: &Trace, config: &Config) -> Panel<'static> {
    let mut lines = both(trace, THETA, RADIAN_DEG);
    let stop_deg = config.gyro.stop_angle_rad * RADIAN_DEG;
    let end_s = trace.times_s.last().copied().unwrap_or_default();
    lines.push(Line::through("stop", vec![(0.0, stop_deg), (end_s, stop_deg)]));
    Panel::new("theta, gyro angle", "deg", lines)
}

fn gimbal_panel(trace: &Trace) -> Panel<'static> {
    Panel::new("phi, gimbal angle", "deg", both(trace, PHI, RADIAN_DEG))
}

/// Figures 2-1 and 2-2.
pub(super) fn steps(config: &Config) -> Result<Vec<Sheet>, Failure> {
    let step = |number, order, torque_nm: f64, title: &str| {
        let config = held(Profile::Torque { torque_nm, off_s: f64::INFINITY }.config(config));
        let rows = vec![Input { torque_nm, ..Input::default() }; 2001];
        let trace = Trace::run(&config, Initial::Zero, rows)?;
        let shaded = trace.marked(&[PHI, THETA]);
        let panels = vec![gimbal_panel(&trace), gyro_panel(&trace, &config)];
        let figure = Figure { title, panels, shaded: &shaded, shaded_name: MARK_NAME };
        let differences = vec![trace.difference("phi", PHI), trace.difference("theta", THETA)];
        Sheet::new(number, order, title.to_owned(), &figure, trace.csv(), differences)
    };
    Ok(vec![
        step("2-1", 21, 0.01, "Figure 2-1: step of 1e5 dyne cm (0.01 N m), the gyro stays off its stop")?,
        step("2-2", 22, 0.03, "Figure 2-2: step of 3e5 dyne cm (0.03 N m), the gyro meets its stop and phi stays")?,
    ])
}

/// Figures 6, 7 and 9.
pub(super) fn accelerations(config: &Config) -> Result<Vec<Sheet>, Failure> {
    let unbalance = trace(config, Case::Unbalance)?;
    let friction = trace(config, Case::Friction)?;
    Ok(vec![
        profile(&friction)?,
        response(
            ("7", 70, "Figure 7: 20 g for 5 s on the unbalance, no friction"),
            &unbalance,
            &Case::Unbalance.config(config),
        )?,
        response(
            ("9", 90, "Figure 9: 20 g for 5 s on the bearings, rate of 0.1 rad/s reversed every 2 s, no unbalance"),
            &friction,
            &Case::Friction.config(config),
        )?,
    ])
}

fn trace(config: &Config, case: Case) -> Result<Trace, Failure> {
    let config = case.config(config);
    let period_s = config.period_s;
    let rows = (0..Profile::len(period_s)).map(|k| case.row(20.0, k, period_s)).collect();
    Trace::run(&config, Initial::Zero, rows)
}

fn profile(trace: &Trace) -> Result<Sheet, Failure> {
    let title = "Figure 6: acceleration of figures 7 to 10, and the rate of figures 9 and 10";
    let input = |signal: fn(&Input<f64>) -> f64| {
        // A held row ends where the next begins.
        let points = trace.times_s.iter().zip(&trace.inputs).zip(trace.times_s.iter().skip(1));
        points.flat_map(|((&from_s, input), &to_s)| [(from_s, signal(input)), (to_s, signal(input))]).collect()
    };
    let panels = vec![
        Panel::new("Acceleration along y", "m/s2", vec![Line::through("", input(|input| input.accel_y_mps2))]),
        Panel::new("Vehicle rate about z", "rad/s", vec![Line::through("", input(|input| input.vehicle_rate_radps))]),
    ];
    let figure = Figure { title, panels, shaded: &[], shaded_name: "" };
    Sheet::new("6", 60, title.to_owned(), &figure, trace.csv(), Vec::new())
}

fn response(
    (number, order, title): (&'static str, u32, &str),
    trace: &Trace,
    config: &Config,
) -> Result<Sheet, Failure> {
    let shaded = trace.marked(&[PHI, THETA, MOTOR, VELOCITY, POSITION]);
    let panels = vec![
        gimbal_panel(trace),
        gyro_panel(trace, config),
        Panel::new("Motor torque", "N m", both(trace, MOTOR, 1.0)),
        Panel::new("Velocity error along x", "m/s", both(trace, VELOCITY, 1.0)),
        Panel::new("Position error along x", "m", both(trace, POSITION, 1.0)),
    ];
    let figure = Figure { title, panels, shaded: &shaded, shaded_name: MARK_NAME };
    let differences = vec![
        trace.difference("phi", PHI),
        trace.difference("theta", THETA),
        trace.difference("motor torque", MOTOR),
        trace.difference("velocity error", VELOCITY),
        trace.difference("position error", POSITION),
    ];
    Sheet::new(number, order, title.to_owned(), &figure, trace.csv(), differences)
}
