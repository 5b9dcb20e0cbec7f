//! Whether the columns are what their names say: each is held against the others before anything is fitted.

use std::f64::consts::{PI, TAU};

use gimbal_model_file::AxisModel;

use super::channels::{drive, limit, references, stuck};
use super::follows::{SURE, first_order, follows, lateness_error};
use super::judge::BEYOND;
use super::library::rms;
use super::motion::{Motion, MotionFrom, NARROW};
use super::noise::step;
use super::plain::{nominal, plain};
use super::smooth::Kernel;
use super::table::AxisLog;
use super::units::{Unit, looks_like, other_unit};

/// A column that is not what its name says.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnFault {
    /// Name of the effect.
    pub effect: &'static str,
    /// Its parameter, value and unit.
    pub parameters: Vec<(&'static str, f64, f64, String)>,
}

/// What the columns say about each other.
#[derive(Debug, Clone, Default)]
pub(super) struct Checked {
    pub(super) from: Option<MotionFrom>,
    pub(super) effort_sign: f64,
    /// In words, one finding each.
    pub(super) words: Vec<String>,
    pub(super) faults: Vec<ColumnFault>,
    /// What is in another unit than the model file says.
    pub(super) unit: Option<Unit>,
}

impl Checked {
    /// A log whose columns are what their names say; its units are taken for right.
    pub(super) fn mended(&self, log: &AxisLog) -> AxisLog {
        let mut log = log.clone();
        let other_unit = self.unit.is_some();
        let by = |column: &mut Option<Vec<f64>>, factor: f64| {
            column.iter_mut().flatten().for_each(|value| *value /= factor);
        };
        for fault in &self.faults {
            let value = fault.parameters[0].1;
            match fault.effect {
                "position_scale" if !other_unit => by(&mut log.position, value),
                "velocity_scale" if !other_unit => by(&mut log.velocity, value),
                "velocity_unrelated" => log.velocity = None,
                "torque_sign" => log.effort.iter_mut().for_each(|effort| *effort *= value),
                _ => {}
            }
        }
        log
    }
}

/// How much nearer to the model another time must bring its parameters than another position or rate (a logarithm), where
/// it is not the only one that brings them inside of their tolerances.
const OTHER_TIME: f64 = 0.1;
/// Correlation below which two columns have nothing to do with each other.
const UNRELATED: f64 = 0.7;
/// Rows by which the rate may be late: half a row belongs to any difference of two.
const LATE: f64 = 0.8;
/// Least smoothing [rows].
const LEAST_SIGMA: f64 = 3.0;

/// Smoothing that leaves the motion and little of the noise: that of the balance, 3 rows at least.
fn in_band(log: &AxisLog, model: &AxisModel) -> f64 {
    let widest = [MotionFrom::Position, MotionFrom::Velocity].map(|from| Motion::new(log, model, from, 1.0, NARROW));
    let sigma = widest.map(|motion| motion.whole_sigma());
    sigma[0].min(sigma[1]).max(LEAST_SIGMA)
}

/// Position of a rotary axis that wraps, unwrapped.
pub(super) fn unwrap(log: &mut AxisLog) {
    let Some(position) = &mut log.position else { return };
    let jumps = position.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > PI).count();
    let fastest = log.velocity.as_ref().map_or(0.0, |v| v.iter().fold(0.0_f64, |most, v| most.max(v.abs())));
    if jumps == 0 || fastest * log.period_s > PI / 2.0 || jumps * 20 > position.len() {
        return;
    }
    let mut turns = 0.0;
    let mut last = position[0];
    for value in position.iter_mut() {
        let step = *value - last;
        last = *value;
        if step.abs() > PI {
            turns -= step.signum();
        }
        *value += TAU * turns;
    }
    log.notes.push(format!("the position wraps {jumps} times and is unwrapped"));
}

/// Holds the columns against each other.
pub(super) fn check(log: &AxisLog, model: &AxisModel) -> Checked {
    let mut checked = Checked { effort_sign: 1.0, ..Checked::default() };
    let names = &model.columns;
    let name = |source: &Option<gimbal_model_file::axis::Source>| {
        source.as_ref().map_or_else(String::new, |source| format!("`{}`", source.name))
    };
    let (position_name, velocity_name) = (name(&names.position), name(&names.velocity));
    let period_ms = 1e3 * log.period_s;
    checked.words.push(format!(
        "rows every {period_ms:.3} ms ({:.0} Hz) for {:.1} s",
        1e3 / period_ms,
        log.effort.len() as f64 * log.period_s
    ));
    let mut from = if log.position.is_some() { MotionFrom::Position } else { MotionFrom::Velocity };
    if let (Some(position), Some(velocity)) = (&log.position, &log.velocity) {
        let sigma = in_band(log, model);
        let rate = Kernel::new(sigma, 1, log.period_s).apply(position);
        let logged = Kernel::new(sigma, 0, log.period_s).apply(velocity);
        let both = follows(&rate, &logged, &log.valid);
        let unit = format!("{}/s", model.motion.unit());
        checked.words.push(format!(
            "{velocity_name} is {:.4} times the derivative of {position_name} (correlation {:.4}, {:.2} ms late), \
             in steps of {:.3e} {unit}",
            both.slope,
            both.correlation,
            both.late_rows * period_ms,
            step(velocity)
        ));
        if rms(&logged) == 0.0 {
            checked.words.push(format!("{velocity_name} is zero throughout: the axis stands, or the column is empty"));
        } else if both.correlation.abs() < UNRELATED {
            let moving = rms(&rate);
            if moving > 2.0 * step(velocity) {
                checked.words.push(format!("{velocity_name} and {position_name} do not belong together"));
                checked.faults.push(ColumnFault {
                    effect: "velocity_unrelated",
                    parameters: vec![("correlation", both.correlation, 0.0, "1".to_owned())],
                });
            } else {
                checked.words.push(format!("{velocity_name} is below its own steps: the axis hardly moves"));
            }
        } else {
            if both.is_of_one_scale() {
                from = finer(log, model);
            } else {
                from = scale(log, model, both.slope, &mut checked, (&position_name, &velocity_name));
            }
            let surely_late = both.late_rows - SURE * lateness_error(&rate, &logged, &both, log);
            if surely_late > LATE && !model.trusts("velocity_delay") {
                let late_s = both.late_rows * log.period_s;
                let why = first_order(&rate, &logged, &both, &log.valid).map_or_else(
                    || "a filter, a difference over several rows, or an older sample".to_owned(),
                    |rows| format!("a filter of first order, time constant {:.1} ms", rows * period_ms),
                );
                checked.words.push(format!("{velocity_name} is {:.1} ms late: {why}", 1e3 * late_s));
                checked.faults.push(ColumnFault {
                    effect: "velocity_delay",
                    parameters: vec![("delay", late_s, 0.1 * log.period_s, "s".to_owned())],
                });
            }
        }
        let used = if from == MotionFrom::Position { &position_name } else { &velocity_name };
        checked.words.push(format!("the balance takes its motion from {used}"));
    }
    checked.from = Some(from);
    sign(log, model, &mut checked);
    if checked.unit.is_none()
        && let Some(other) = other_unit(log, model, checked.from, checked.effort_sign)
    {
        checked.words.push(other.words);
        checked.faults.push(ColumnFault {
            effect: other.effect,
            parameters: vec![("factor", other.unit.factor(), 0.0, "1".to_owned())],
        });
        checked.unit = Some(other.unit);
    }
    checked.words.extend(drive(log, model));
    checked.words.extend(limit(log, model));
    checked.words.extend(stuck(log, model));
    checked.words.extend(references(log, model));
    checked
}

/// The column with less noise in the acceleration.
fn finer(log: &AxisLog, model: &AxisModel) -> MotionFrom {
    let floor = |from| Motion::new(log, model, from, 1.0, NARROW).floor;
    let widest = |from| Motion::new(log, model, from, 1.0, NARROW).band_hz;
    let (p, v) = (MotionFrom::Position, MotionFrom::Velocity);
    // the position is not filtered by anyone: it may cost some of the band
    match widest(p) / widest(v) {
        ratio if ratio > 1.01 => p,
        ratio if ratio < 0.35 => v,
        _ if floor(p) <= 3.0 * floor(v) => p,
        _ => v,
    }
}

/// Position and velocity differ by a factor: the nominal parameters tell whether one of them is wrong, or the time that
/// turns one into the other.
fn scale(
    log: &AxisLog,
    model: &AxisModel,
    slope: f64,
    checked: &mut Checked,
    (position_name, velocity_name): (&str, &str),
) -> MotionFrom {
    let distance = |log: &AxisLog, from| {
        let (found, _) = plain(&Motion::new(log, model, from, 1.0, NARROW));
        let away = |place: usize| {
            let ratio = found[place].abs() / nominal(model)[place].max(1e-300);
            if nominal(model)[place] > 0.0 { ratio.max(1e-6).ln().abs().min(6.0) } else { 0.0 }
        };
        let beyond = away(0) > BEYOND * model.tolerance.inertia || away(1) > BEYOND * model.tolerance.viscous;
        (away(0) + away(1), beyond)
    };
    // a column that is known to be good is not the wrong one
    let unless = |effect: &str, distance: (f64, bool)| if model.trusts(effect) { (f64::MAX, true) } else { distance };
    let by_position = unless("velocity_scale", distance(log, MotionFrom::Position));
    let by_velocity = unless("position_scale", distance(log, MotionFrom::Velocity));
    let time = Unit::Time(slope);
    let by_time = if slope > 0.0 && !model.trusts("time_scale") {
        let mut other = log.clone();
        time.undo(&mut other);
        distance(&other, MotionFrom::Position)
    } else {
        (f64::MAX, true)
    };
    let looks = looks_like(slope);
    let nearest = by_position.0.min(by_velocity.0);
    let time_alone = !by_time.1 && by_position.1 && by_velocity.1 && by_time.0 < nearest;
    let (right, nearest, wrong, effect, value) = if time_alone || by_time.0 + OTHER_TIME < nearest {
        checked.unit = Some(time);
        (MotionFrom::Position, "both", "the time column", "time_scale", slope)
    } else if by_velocity.0 < by_position.0 {
        (MotionFrom::Velocity, velocity_name, position_name, "position_scale", 1.0 / slope)
    } else {
        (MotionFrom::Position, position_name, velocity_name, "velocity_scale", slope)
    };
    checked.words.push(format!(
        "{velocity_name} and {position_name} differ by {slope:.4} ({looks}); inertia and viscous friction are nearest to \
         the model's with {nearest}: {wrong} is {value:.4} of what it should be",
    ));
    checked
        .faults
        .push(ColumnFault { effect, parameters: vec![("factor", value, 0.01 * value.abs(), "1".to_owned())] });
    right
}

/// A positive effort must accelerate towards positive positions.
fn sign(log: &AxisLog, model: &AxisModel, checked: &mut Checked) {
    let Some(from) = checked.from else { return };
    let motion = Motion::new(log, model, from, 1.0, NARROW);
    if motion.stands {
        checked.words.push(format!(
            "the axis stands {:.0} % of the time, or moves no faster than its rate is told from noise ({:.2e} {}/s): the \
             balance is one of rest, without inertia or viscous friction",
            100.0 * motion.at_rest,
            motion.quiet,
            model.motion.unit()
        ));
        return;
    }
    let (found, _) = plain(&motion);
    let drag = found[1] * rms(&motion.v) + found[2];
    let name = &model.columns.effort.name;
    if found[0] < 0.0 && drag < 0.0 && !model.trusts("torque_sign") {
        checked.effort_sign = -1.0;
        checked.words.push(format!(
            "`{name}` has the opposite sign: it decelerates where it should accelerate, and friction would drive; turned round"
        ));
        checked
            .faults
            .push(ColumnFault { effect: "torque_sign", parameters: vec![("factor", -1.0, 0.0, "1".to_owned())] });
    } else if found[0] < 0.0 {
        checked.words.push(format!(
            "`{name}` does not go with the acceleration (inertia by plain regression {:.3e}); friction alone shows its sign",
            found[0]
        ));
    } else {
        checked.words.push(format!("`{name}` has the sign of the acceleration"));
    }
    checked.words.push(format!(
        "plain regression: inertia {:.4e}, viscous {:.4e}, Coulomb {:.4e}, constant {:.3e} (model: {:.4e}, {:.4e}, {:.4e}, 0)",
        found[0], found[1], found[2], found[3], model.inertia, model.viscous, model.coulomb
    ));
}
