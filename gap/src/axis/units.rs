//! Units: columns in another one than the model file says, and what a factor between two columns looks like.

use std::f64::consts::{PI, TAU};

use gimbal_model_file::AxisModel;

use super::motion::{Motion, MotionFrom, NARROW};
use super::plain::{nominal, nominal_rest, plain};
use super::table::AxisLog;

/// A factor is a known one within this.
const SAME: f64 = 0.02;
/// Factors of units that are taken for one another, and how far one may be off them (its logarithm).
const UNITS: [f64; 8] = [1e3, 1e-3, TAU, 1.0 / TAU, 180.0 / PI, PI / 180.0, 100.0, 0.01];
const ALIKE: f64 = 0.35;
/// What the nominal model may leave of a log taken in another unit, over what it leaves of it as it is: parameters by plain
/// regression are what noise and loop make of them where the effort hardly hangs on the motion.
const MENDED: f64 = 0.7;

/// What is in another unit, and its values over what they should be.
#[derive(Debug, Clone, Copy)]
pub(super) enum Unit {
    Motion(f64),
    Time(f64),
}

/// What a log shows of that.
pub(super) struct OtherUnit {
    pub(super) effect: &'static str,
    pub(super) unit: Unit,
    pub(super) words: String,
}

/// Position or time in another unit than the model file says: inertia and viscous friction are off as their powers of it
/// have it, Coulomb friction is not, and the nominal model leaves less of the log in that unit.
///
/// ```text
/// position times k: J / k, B / k        time times k: J k^2, B k
/// ```
pub(super) fn other_unit(
    log: &AxisLog,
    model: &AxisModel,
    from: Option<MotionFrom>,
    effort_sign: f64,
) -> Option<OtherUnit> {
    let from = from?;
    let motion = Motion::new(log, model, from, effort_sign, NARROW);
    let (found, _) = plain(&motion);
    let [inertia, viscous, coulomb] = std::array::from_fn(|place| found[place] / nominal(model)[place]);
    let off = |ratio: f64, by: f64| (ratio.abs() / by).ln().abs() > ALIKE;
    let told = inertia > 0.0 && viscous > 0.0 && off(inertia, 1.0) && !off(coulomb, 1.0);
    if !told {
        return None;
    }
    let known = |factor: f64| UNITS.into_iter().find(|unit| !off(factor, *unit));
    let name = if from == MotionFrom::Position { "position_scale" } else { "velocity_scale" };
    let (effect, unit, of) = match (known(1.0 / inertia), known(inertia.sqrt())) {
        (Some(factor), _) if !off(viscous, inertia) && !model.trusts(name) => {
            (name, Unit::Motion(factor), "position and rate")
        }
        (_, Some(factor)) if log.velocity.is_none() && !off(viscous, inertia.sqrt()) && !model.trusts("time_scale") => {
            ("time_scale", Unit::Time(factor), "time")
        }
        _ => return None,
    };
    let mut mended = log.clone();
    unit.undo(&mut mended);
    let left = |motion: &Motion| nominal_rest(motion, model);
    if left(&Motion::new(&mended, model, from, effort_sign, NARROW)) > MENDED * left(&motion) {
        return None;
    }
    let words = format!(
        "inertia is {inertia:.3e} and viscous friction {viscous:.3e} times the model's, Coulomb friction is not: {of} in \
         another unit than [axis.columns] says, {:.4e} of it ({}); taken in that unit",
        unit.factor(),
        looks_like(unit.factor())
    );
    Some(OtherUnit { effect, unit, words })
}

impl Unit {
    /// Values over what they should be.
    pub(super) fn factor(self) -> f64 {
        match self {
            Self::Motion(factor) | Self::Time(factor) => factor,
        }
    }

    /// Takes a log in the unit that it is in.
    pub(super) fn undo(self, log: &mut AxisLog) {
        match self {
            Self::Time(factor) => {
                log.period_s /= factor;
                log.first_s /= factor;
            }
            Self::Motion(factor) => {
                let AxisLog { position, velocity, position_reference, velocity_reference, .. } = log;
                let columns = [position, velocity, position_reference, velocity_reference];
                columns.into_iter().flatten().flatten().for_each(|value| *value /= factor);
            }
        }
    }
}

/// What a factor looks like.
pub(super) fn looks_like(factor: f64) -> String {
    let size = factor.abs();
    let known = [
        (TAU, "2 pi: turns against radians"),
        (1.0 / TAU, "1/(2 pi): radians against turns"),
        (180.0 / PI, "180/pi: degrees against radians"),
        (PI / 180.0, "pi/180: radians against degrees"),
        (60.0 / TAU, "60/(2 pi): rpm against rad/s"),
        (TAU / 60.0, "2 pi/60: rad/s against rpm"),
        (1e3, "1000: a prefix"),
        (1e-3, "1/1000: a prefix"),
    ];
    let sign = if factor < 0.0 { "the opposite sign, and " } else { "" };
    if (size - 1.0).abs() < SAME {
        return "the opposite sign".to_owned();
    }
    if let Some((_, name)) = known.iter().find(|(value, _)| (size / value - 1.0).abs() < SAME) {
        return format!("{sign}{name}");
    }
    for (value, form) in [(size, ""), (1.0 / size, "1/")] {
        let whole = value.round();
        if (2.0..200.0).contains(&whole) && (value / whole - 1.0).abs() < 0.01 {
            return format!("{sign}{form}{whole}: a ratio of gears, poles or periods");
        }
    }
    format!("{sign}no known ratio")
}
