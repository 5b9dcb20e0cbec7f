//! Parameters of effects with their names, units and errors.

use gimbal_model_file::AxisModel;

use crate::axis::library::{NOMINAL, Shape};
use crate::axis::motion::Motion;
use crate::axis::plain::{nominal, tolerances};

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard error, by bootstrap over blocks.
    pub std: f64,
    /// Unit.
    pub unit: String,
}

pub(in crate::axis) fn deviation(samples: &[Vec<f64>], place: usize) -> f64 {
    let count = samples.len().max(2) as f64;
    let mean = samples.iter().map(|s| s[place]).sum::<f64>() / count;
    (samples.iter().map(|s| (s[place] - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt()
}

/// How well the model knows a factor that its parameters have in common: `1/sqrt(sum 1/tolerance^2)`, of those that are
/// not zero.
fn common_tolerance(model: &AxisModel) -> f64 {
    let tolerances = tolerances(model);
    let known = tolerances.iter().zip(nominal(model)).filter(|(_, parameter)| *parameter > 0.0);
    known.map(|(tolerance, _)| f64::powi(tolerance.max(1e-6), -2)).sum::<f64>().sqrt().recip()
}

/// Parameters of an effect with their names and units.
pub(in crate::axis) fn parameters(
    shape: &Shape,
    own: &[f64],
    samples: &[Vec<f64>],
    model: &AxisModel,
    motion: &Motion,
) -> Vec<Parameter> {
    let unit = |power: u32| model.parameter_unit(power);
    let effort = model.effort_unit.clone();
    let length = model.motion.unit();
    let new = |name: &str, value: f64, std: f64, unit: String| Parameter { name: name.to_owned(), value, std, unit };
    let amplitude = |name: &str, unit: String| new(name, own[0], deviation(samples, 0), unit);
    let one = || "1".to_owned();
    let mut told = match shape {
        Shape::Inertia | Shape::Viscous | Shape::Coulomb => {
            let index = NOMINAL.iter().position(|nominal| nominal == shape).unwrap_or(0);
            let base = nominal(model)[index];
            let unit = [unit(2), unit(1), effort][index].clone();
            let mut told = vec![new("value", base + own[0], deviation(samples, 0), unit)];
            if base > 0.0 {
                told.push(new("relative_change", own[0] / base, deviation(samples, 0) / base, one()));
            }
            told
        }
        Shape::Ripple { .. }
        | Shape::MotorRipple { .. }
        | Shape::PositionFriction { .. }
        | Shape::LoadRipple { .. } => {
            let size = |s: &[f64]| s[0].hypot(s[1]);
            let sizes: Vec<Vec<f64>> = samples.iter().map(|s| vec![size(s)]).collect();
            let unit = if matches!(shape, Shape::MotorRipple { .. }) { one() } else { effort };
            let phase = own[1].atan2(own[0]);
            let phases: Vec<Vec<f64>> = samples
                .iter()
                .map(|s| {
                    let turn = s[1].atan2(s[0]) - phase;
                    vec![turn.sin().atan2(turn.cos())]
                })
                .collect();
            vec![
                new("amplitude", size(own), deviation(&sizes, 0), unit),
                new("phase_rad", phase, deviation(&phases, 0), "rad".to_owned()),
            ]
        }
        // of the model's own parameters, which are known to their tolerances alone
        Shape::Scale => {
            let known = (1.0 + own[0]) * common_tolerance(model);
            vec![new("relative", own[0], deviation(samples, 0).hypot(known), one())]
        }
        Shape::LoadDependence | Shape::DragAsymmetry => vec![amplitude("relative", one())],
        Shape::InertialLoad => {
            let inertia = nominal(model)[0];
            vec![new("relative", own[0] / inertia, deviation(samples, 0) / inertia, one())]
        }
        Shape::Lag | Shape::RateDelay => vec![amplitude("time_s", "s".to_owned())],
        Shape::Quadratic => vec![amplitude("coefficient", format!("{effort} s2/{length}2"))],
        Shape::ViscousCurve { .. } => vec![amplitude("coefficient", format!("{effort} (s/{length})^exponent"))],
        Shape::ViscousDrift { .. } => vec![amplitude("change", unit(1))],
        Shape::Spring => {
            let slack: Vec<Vec<f64>> = samples.iter().map(|s| vec![-s[1] / s[0]]).collect();
            vec![
                amplitude("stiffness", unit(0)),
                new("neutral", motion.middle - own[1] / own[0], deviation(&slack, 0), length.to_owned()),
            ]
        }
        Shape::FrictionTaper => vec![amplitude("stiffness", unit(0))],
        Shape::Flexible => vec![amplitude("coefficient", unit(4))],
        Shape::Mode { .. } => vec![amplitude("inertia", unit(2))],
        Shape::Backlash(play) => vec![
            amplitude("inertia", unit(2)),
            new("friction", play.slowing * own[0], play.slowing * deviation(samples, 0), effort),
        ],
        Shape::LoadGain { .. } => vec![amplitude("relative_per_unit", one())],
        Shape::Load { .. } | Shape::LoadFriction { .. } => {
            vec![amplitude("gain", format!("{effort} per unit"))]
        }
        _ => vec![amplitude("amplitude", effort)],
    };
    if matches!(shape, Shape::Load { .. })
        && let Some(first) = told.first_mut()
    {
        first.value *= model.load_direction;
    }
    for (name, value) in shape.numbers() {
        let (name, value, unit) = match name {
            "wave_number" if motion.rotary => ("waves_per_turn", value, one()),
            "wave_number" => ("wave_length", std::f64::consts::TAU / value, length.to_owned()),
            "rate" => (name, value, format!("{length}/s")),
            "displacement" | "width" => (name, value, length.to_owned()),
            "time_constant" => ("time_constant_s", value, "s".to_owned()),
            "frequency_hz" => (name, value, "Hz".to_owned()),
            _ => (name, value, one()),
        };
        told.push(new(name, value, 0.0, unit));
    }
    told
}
