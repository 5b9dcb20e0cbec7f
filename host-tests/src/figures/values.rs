//! Quantities with an expected value.

use gimbal_servo::paper::{DEGREE_RAD, DYNE_CM_NM, STANDARD_GRAVITY_MPS2 as G};
use gimbal_servo::{Config, Faults};

use super::{Bound, Value};
use crate::Row;
use crate::axis::{Run, System, run, run_plant};
use crate::compare::slope;
use crate::inputs::{bare, held, torque_pulse, torque_step, unbalance_profile};

pub(super) const NOTE: &str = "
The paper prints 0.13 m/s for the velocity error after the 20 g case. Its own equations give 0.107 m/s, whatever T5 is: the
difference of 18 % is open, and nothing here is tuned towards it. The switched-off case is a small difference of two drifts of
5.6 deg.
";

fn step(dyne_cm: f64, time_s: f64) -> impl Fn(&Config) -> Vec<Row> {
    move |config| torque_step(dyne_cm, time_s, config.period_s)
}

/// A value of three runs.
fn figure(
    quantity: impl Into<String>,
    unit: &'static str,
    (expected, source, bound): (f64, &'static str, Bound),
    config: &Config,
    rows: impl Fn(&Config) -> Vec<Row>,
    of: impl Fn(&Run) -> f64,
) -> Value {
    let rows = rows(config);
    Value {
        quantity: quantity.into(),
        unit,
        expected,
        source,
        f32: of(&run(System::F32, config, &rows)),
        fixed: of(&run(System::Fixed, config, &rows)),
        plant: Some(of(&run_plant(config, &rows))),
        bound,
    }
}

/// A value of the configuration, the same in both number systems.
fn formula(
    quantity: &str,
    unit: &'static str,
    (expected, source, bound): (f64, &'static str, Bound),
    value: f64,
) -> Value {
    Value { quantity: quantity.into(), unit, expected, source, f32: value, fixed: value, plant: None, bound }
}

pub(super) fn all() -> Vec<Value> {
    let mut values = steps();
    values.extend(unbalance());
    values.extend(friction());
    values
}

fn steps() -> Vec<Value> {
    let consistent = bare(Config::consistent());
    let mut unstopped = consistent;
    unstopped.gyro.stop_angle_rad = 0.1;
    let mut printed = bare(Config::as_printed());
    printed.gyro.stop_angle_rad = 0.1;
    let peak = |run: &Run| run.peak_phi_rad() / DEGREE_RAD;
    let left = |run: &Run| run.last().gimbal_angle_rad / DEGREE_RAD;
    let half = Bound::Share(0.005);
    let mut values = vec![
        figure("peak phi, 1e5 dyne cm", "deg", (0.0566, "f64", half), &consistent, step(1e5, 2.0), peak),
        figure("peak phi, 1.96e5 dyne cm", "deg", (0.111, "f64", half), &consistent, step(1.96e5, 2.0), peak),
        figure("peak phi, 3e5 dyne cm, no stops", "deg", (0.1699, "f64", half), &unstopped, step(3e5, 2.0), peak),
        figure("peak phi, *as printed*, 1e5, no stops", "deg", (0.1523, "f64", half), &printed, step(1e5, 2.0), peak),
    ];
    let share = Bound::Share(0.002);
    for (dyne_cm, expected) in [(2.2e5, 0.1346), (2.5e5, 1.099), (3e5, 5.609), (4e5, 31.67)] {
        let name = format!("phi left, {dyne_cm:e} dyne cm kept on 10 s");
        values.push(figure(name, "deg", (expected, "f64", share), &consistent, step(dyne_cm, 10.0), left));
    }
    let pulse = |config: &Config| torque_pulse(3e5, 4.0, 10.0, config.period_s);
    let name = "phi left, 3e5 dyne cm switched off after 4 s";
    values.push(figure(name, "deg", (-0.04, "f64", Bound::Within(0.001)), &held(consistent), pulse, left));
    for (event, name, expected) in [(0, "contact, 3e5 dyne cm", 61.0), (1, "release, 3e5 dyne cm", 422.3)] {
        let at = |run: &Run| run.events[event].time_s * 1e3;
        values.push(figure(name, "ms", (expected, "f64", Bound::Within(0.1)), &consistent, step(3e5, 1.0), at));
    }
    let ramp = |_: &Config| (0..=10_000).map(|k| Row { torque_nm: 4e-6 * f64::from(k), ..Row::default() }).collect();
    let gain = |run: &Run| run.last().gyro_angle_rad / run.last().gimbal_angle_rad;
    values.push(figure("theta/phi, slow ramp", "", (4.315, "H/Bo", Bound::Share(0.001)), &consistent, ramp, gain));
    values
}

type Signal = fn(&Run) -> f64;

fn unbalance() -> Vec<Value> {
    let config = Config::consistent().without_friction();
    let profile = |accel_g: f64| move |_: &Config| unbalance_profile(accel_g, 1e-3);
    let velocity = (0.1072, "f64", Bound::Share(0.002));
    let mut values = vec![
        figure(
            "velocity error, 20 g on the unbalance",
            "m/s",
            velocity,
            &config,
            profile(20.0),
            Run::velocity_error_mps,
        ),
        figure(
            "the same against the printed figure",
            "m/s",
            (0.13, "paper, fig. 7", Bound::Open),
            &config,
            profile(20.0),
            Run::velocity_error_mps,
        ),
    ];
    let exponent = |of: &dyn Fn(&Run) -> f64, make: &dyn Fn(&[Row]) -> Run| {
        let points = [1.0, 2.0, 4.0, 8.0, 12.0, 16.0, 20.0].map(|accel_g: f64| {
            let run = make(&unbalance_profile(accel_g, 1e-3));
            (accel_g.ln(), of(&run).ln())
        });
        slope(&points)
    };
    for (name, expected, of) in [
        ("exponent of peak phi in A, 1 to 20 g", 1.0, Run::peak_phi_rad as Signal),
        ("exponent of peak theta in A", 1.0, Run::peak_theta_rad),
        ("exponent of the velocity error in A", 2.0, Run::velocity_error_mps),
    ] {
        values.push(Value {
            quantity: name.into(),
            unit: "",
            expected,
            source: "closed form",
            f32: exponent(&of, &|rows| run(System::F32, &config, rows)),
            fixed: exponent(&of, &|rows| run(System::Fixed, &config, rows)),
            plant: Some(exponent(&of, &|rows| run_plant(&config, rows))),
            bound: Bound::Within(0.005),
        });
    }
    let saturates_from = |saturates: &dyn Fn(&[Row]) -> bool| {
        let (mut free, mut limited) = (20.0, 22.0);
        while limited - free > 1e-4 {
            let middle = 0.5 * (free + limited);
            if saturates(&unbalance_profile(middle, 1e-3)[..1000]) { limited = middle } else { free = middle }
        }
        limited
    };
    let law =
        |system| saturates_from(&|rows: &[Row]| run(system, &config, rows).faults.contains(Faults::GYRO_SATURATED));
    values.push(Value {
        quantity: "the unbalance saturates the gyro from".into(),
        unit: "g",
        expected: 20.9,
        source: "f64",
        f32: law(System::F32),
        fixed: law(System::Fixed),
        plant: Some(saturates_from(&|rows| !run_plant(&config, rows).events.is_empty())),
        bound: Bound::Within(0.05),
    });
    values
}

fn friction() -> Vec<Value> {
    let bearing = Config::consistent().bearing;
    let load = |accel_g: f64| {
        let (axial, radial) = bearing.loads_n(accel_g * G, 0.0);
        4.0 * bearing.load_torque_nm(axial, radial) / DYNE_CM_NM
    };
    let viscous = |rate: f64| 4.0 * bearing.viscous_torque_nm(rate) / DYNE_CM_NM;
    let at = bearing.viscous_break_radps();
    // (6.1) over (6.2) at the printed boundary.
    let ratio = (bearing.torque_axial_factor - bearing.torque_radial_factor * 2.518) / 2.518;
    let share = Bound::Share(0.002);
    vec![
        formula("load friction, four bearings, 1 g radial", "dyne cm", (13_940.0, "f64", share), load(1.0)),
        formula("load friction, four bearings, 20 g radial", "dyne cm", (49_500.0, "f64", share), load(20.0)),
        formula("viscous friction below 876 deg/s", "dyne cm", (14_582.0, "f64", share), viscous(10.0)),
        formula("the same as printed", "dyne cm", (14_571.0, "paper", share), viscous(10.0)),
        formula(
            "drop at the Palmgren break, printed pair",
            "",
            (0.35, "closed form", Bound::Within(0.005)),
            1.0 - viscous(at * (1.0 + 1e-9)) / viscous(at * (1.0 - 1e-9)),
        ),
        formula(
            "jump of the load at F_r = 2.518 F_a, relative",
            "",
            (0.0, "closed form", Bound::Within(1e-4)),
            ratio - 1.0,
        ),
    ]
}
