//! The effects of an axis: each is a shape that its motion alone draws, times amplitudes that the balance finds.
//!
//! ```text
//! effort = J a + B v + F s + sum amplitude * shape(q, v, a, t, needed, load)
//! ```
//!
//! Nothing here is a function of the logged effort: what hangs on the effort (`dead_zone`, `torque_curve`, lag, delay)
//! hangs on the effort that the motion needs, so that no column can be the regressand in disguise.

mod drawn;
mod rules;

use super::memory::Yields;
use super::play::Play;

/// What an effect looks like; numbers are its shape parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    Inertia,
    Viscous,
    Coulomb,
    Scale,
    Constant,
    /// Of friction that is one number, and of all of it.
    Asymmetry,
    DragAsymmetry,
    Stribeck {
        rate: f64,
        exponent: f64,
    },
    Presliding {
        displacement: f64,
        yields: Yields,
    },
    Quadratic,
    ViscousCurve {
        exponent: f64,
    },
    FrictionDrift {
        time_s: f64,
    },
    ViscousDrift {
        time_s: f64,
    },
    BiasDrift {
        time_s: f64,
    },
    /// Of the effort needed, and of the inertia's alone.
    LoadDependence,
    InertialLoad,
    PositionFriction {
        wave_number: f64,
    },
    FrictionTaper,
    Spring,
    Hysteresis {
        width: f64,
        yields: Yields,
    },
    Ripple {
        wave_number: f64,
    },
    MotorRipple {
        wave_number: f64,
    },
    DeadZone,
    TorqueCurve,
    Lag,
    /// A mode above the band, of which the balance shows how it begins.
    Flexible,
    /// A mass on a spring, its frequency in the band.
    Mode {
        frequency_hz: f64,
        damping: f64,
    },
    Backlash(Play),
    Load {
        channel: usize,
    },
    LoadFriction {
        channel: usize,
    },
    LoadGain {
        channel: usize,
    },
    LoadRipple {
        channel: usize,
        wave_number: f64,
    },
    /// Of the control law alone: the rate that the loop sees is late.
    RateDelay,
}

/// Parameters of the nominal model.
pub(super) const NOMINAL: [Shape; 3] = [Shape::Inertia, Shape::Viscous, Shape::Coulomb];

impl Shape {
    /// Name of the effect.
    pub(super) fn effect(&self) -> &'static str {
        match self {
            Self::Inertia => "inertia",
            Self::Viscous => "viscous_friction",
            Self::Coulomb => "friction_level",
            Self::Scale => "torque_scale",
            Self::Constant => "constant_torque",
            Self::Asymmetry | Self::DragAsymmetry => "direction_asymmetry",
            Self::Stribeck { .. } => "stribeck",
            Self::Presliding { .. } => "presliding",
            Self::Quadratic => "quadratic_drag",
            Self::ViscousCurve { .. } => "viscous_curve",
            Self::FrictionDrift { .. } => "friction_drift",
            Self::ViscousDrift { .. } => "viscous_drift",
            Self::BiasDrift { .. } => "bias_drift",
            Self::LoadDependence | Self::InertialLoad => "load_dependence",
            Self::PositionFriction { .. } => "position_friction",
            Self::FrictionTaper => "friction_taper",
            Self::Spring => "cable_spring",
            Self::Hysteresis { .. } => "cable_hysteresis",
            Self::Ripple { .. } => "torque_ripple",
            Self::MotorRipple { .. } => "motor_ripple",
            Self::DeadZone => "dead_zone",
            Self::TorqueCurve => "torque_curve",
            Self::Lag => "motor_lag",
            Self::Flexible | Self::Mode { .. } => "flexible_mode",
            Self::Backlash(_) => "backlash",
            Self::Load { .. } => "external_load",
            Self::LoadFriction { .. } => "load_friction",
            Self::LoadGain { .. } => "load_gain",
            Self::LoadRipple { .. } => "compensation",
            Self::RateDelay => "velocity_delay",
        }
    }

    /// Its block.
    pub(super) fn block(&self) -> &'static str {
        match self {
            Self::Viscous
            | Self::Coulomb
            | Self::Asymmetry
            | Self::DragAsymmetry
            | Self::Stribeck { .. }
            | Self::Presliding { .. }
            | Self::Quadratic
            | Self::ViscousCurve { .. }
            | Self::FrictionDrift { .. }
            | Self::ViscousDrift { .. }
            | Self::LoadDependence
            | Self::InertialLoad
            | Self::PositionFriction { .. }
            | Self::FrictionTaper
            | Self::LoadFriction { .. } => "friction",
            Self::Constant
            | Self::Spring
            | Self::Hysteresis { .. }
            | Self::Ripple { .. }
            | Self::LoadRipple { .. }
            | Self::Load { .. } => "disturbance",
            Self::RateDelay
            | Self::MotorRipple { .. }
            | Self::DeadZone
            | Self::TorqueCurve
            | Self::Lag
            | Self::LoadGain { .. } => "servo",
            Self::Inertia | Self::Flexible | Self::Mode { .. } | Self::Backlash(_) => "structure",
            Self::Scale | Self::BiasDrift { .. } => "measurement",
        }
    }

    /// Its shape parameters: name and value.
    pub(super) fn numbers(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Stribeck { rate, exponent } => vec![("rate", rate), ("exponent", exponent)],
            Self::Presliding { displacement, yields } => {
                [vec![("displacement", displacement)], yields.numbers()].concat()
            }
            Self::Hysteresis { width, yields } => [vec![("width", width)], yields.numbers()].concat(),
            Self::ViscousCurve { exponent } => vec![("exponent", exponent)],
            Self::FrictionDrift { time_s } | Self::ViscousDrift { time_s } | Self::BiasDrift { time_s } => {
                vec![("time_constant", time_s)]
            }
            Self::PositionFriction { wave_number }
            | Self::LoadRipple { wave_number, .. }
            | Self::Ripple { wave_number }
            | Self::MotorRipple { wave_number } => vec![("wave_number", wave_number)],
            Self::Backlash(Play { width, .. }) => vec![("width", width)],
            Self::Mode { frequency_hz, damping } => vec![("frequency_hz", frequency_hz), ("damping_ratio", damping)],
            _ => Vec::new(),
        }
    }

    /// The same shape with its first number changed.
    pub(super) fn with(&self, number: f64) -> Self {
        let mut other = self.clone();
        match &mut other {
            Self::Stribeck { rate: place, .. }
            | Self::Presliding { displacement: place, .. }
            | Self::ViscousCurve { exponent: place }
            | Self::FrictionDrift { time_s: place }
            | Self::ViscousDrift { time_s: place }
            | Self::BiasDrift { time_s: place }
            | Self::PositionFriction { wave_number: place }
            | Self::LoadRipple { wave_number: place, .. }
            | Self::Ripple { wave_number: place }
            | Self::MotorRipple { wave_number: place }
            | Self::Hysteresis { width: place, .. }
            | Self::Mode { frequency_hz: place, .. }
            | Self::Backlash(Play { width: place, .. }) => *place = number,
            _ => {}
        }
        other
    }
}

/// Root mean square.
pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
