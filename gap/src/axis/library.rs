//! The effects of an axis: each is a shape that its motion alone draws, times amplitudes that the balance finds.
//!
//! ```text
//! effort = J a + B v + F s + sum amplitude * shape(q, v, a, t, needed, load)
//! ```
//!
//! Nothing here is a function of the logged effort: what hangs on the effort (`dead_zone`, `torque_curve`, lag, delay)
//! hangs on the effort that the motion needs, so that no column can be the regressand in disguise.

use super::memory::{dahl_state, play_state};
use super::motion::Motion;
use super::resonance;

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
    Backlash {
        width: f64,
    },
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

/// Relative change of a scale that is none: less than half of an effort is another unit.
const LEAST_SCALE: f64 = -0.5;

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
            Self::Backlash { .. } => "backlash",
            Self::Load { .. } => "external_load",
            Self::LoadFriction { .. } => "load_friction",
            Self::LoadGain { .. } => "load_gain",
            Self::LoadRipple { .. } => "load_ripple",
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
            Self::Inertia | Self::Flexible | Self::Mode { .. } | Self::Backlash { .. } => "structure",
            Self::Scale | Self::BiasDrift { .. } => "measurement",
        }
    }

    /// Whether it must brake wherever the axis slips: pre-sliding springs back.
    pub(super) fn brakes(&self) -> bool {
        self.block() == "friction" && !matches!(self, Self::Presliding { .. })
    }

    /// Whether it stands for another effect, too: a spring has its neutral point, and so an offset; a scale has all nominal
    /// parameters.
    pub(super) fn holds(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Spring, Self::Constant)) || *self == Self::Scale && NOMINAL.contains(other)
    }

    /// Whether it hangs on the effort that the motion needs.
    pub(super) fn hangs_on_effort(&self) -> bool {
        matches!(
            self,
            Self::LoadDependence
                | Self::MotorRipple { .. }
                | Self::DeadZone
                | Self::TorqueCurve
                | Self::Lag
                | Self::LoadGain { .. }
        )
    }

    /// Share of the effort's power that it must take. What acts at reversals, or through the motion's higher derivatives, is
    /// never quite as it is formulated here; what hangs on the place or on a channel is known by that.
    pub(super) fn least_of_effort(&self) -> f64 {
        match self {
            Self::Stribeck { .. }
            | Self::Presliding { .. }
            | Self::LoadDependence
            | Self::InertialLoad
            | Self::Hysteresis { .. }
            | Self::Lag
            | Self::Flexible
            | Self::Mode { .. }
            | Self::Backlash { .. } => 1e-4,
            Self::Spring
            | Self::FrictionTaper
            | Self::PositionFriction { .. }
            | Self::Ripple { .. }
            | Self::MotorRipple { .. }
            | Self::Load { .. }
            | Self::LoadFriction { .. }
            | Self::LoadGain { .. }
            | Self::LoadRipple { .. } => 1e-6,
            _ => 1e-5,
        }
    }

    /// Whether several of it, each with another number, may act at once.
    pub(super) fn many(&self) -> bool {
        matches!(
            self,
            Self::Ripple { .. }
                | Self::MotorRipple { .. }
                | Self::PositionFriction { .. }
                | Self::Load { .. }
                | Self::LoadFriction { .. }
                | Self::LoadGain { .. }
                | Self::LoadRipple { .. }
        )
    }

    /// Whether amplitudes are possible: friction brakes, springs pull back, lags are late. `level` is the friction.
    pub(super) fn possible(&self, amplitudes: &[f64], level: f64) -> bool {
        match self {
            Self::Stribeck { .. } => amplitudes[0] > 0.0 && amplitudes[0] < 3.0 * level.abs(),
            // what falls with the rate at all rates is the loop's law; at slow ones it is Stribeck's
            Self::ViscousCurve { .. }
            | Self::Quadratic
            | Self::LoadDependence
            | Self::InertialLoad
            | Self::Spring
            | Self::Hysteresis { .. }
            | Self::DeadZone
            | Self::Lag
            | Self::RateDelay
            | Self::Mode { .. }
            | Self::Flexible => amplitudes[0] > 0.0,
            Self::Presliding { .. } => amplitudes[0] > 0.0 && amplitudes[0] < 1.5 * level.abs(),
            Self::Backlash { .. } => amplitudes[0] < 0.0 && amplitudes[1] < 0.0,
            Self::Scale => amplitudes[0] > LEAST_SCALE,
            _ => true,
        }
    }

    /// Its shape parameters: name and value.
    pub(super) fn numbers(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Stribeck { rate, exponent } => vec![("rate", rate), ("exponent", exponent)],
            Self::Presliding { displacement } => vec![("displacement", displacement)],
            Self::ViscousCurve { exponent } => vec![("exponent", exponent)],
            Self::FrictionDrift { time_s } | Self::ViscousDrift { time_s } | Self::BiasDrift { time_s } => {
                vec![("time_constant", time_s)]
            }
            Self::PositionFriction { wave_number }
            | Self::LoadRipple { wave_number, .. }
            | Self::Ripple { wave_number }
            | Self::MotorRipple { wave_number } => vec![("wave_number", wave_number)],
            Self::Hysteresis { width } | Self::Backlash { width } => vec![("width", width)],
            Self::Mode { frequency_hz, damping } => vec![("frequency_hz", frequency_hz), ("damping_ratio", damping)],
            _ => Vec::new(),
        }
    }

    /// The same shape with its first number changed.
    pub(super) fn with(&self, number: f64) -> Self {
        let mut other = self.clone();
        match &mut other {
            Self::Stribeck { rate: place, .. }
            | Self::Presliding { displacement: place }
            | Self::ViscousCurve { exponent: place }
            | Self::FrictionDrift { time_s: place }
            | Self::ViscousDrift { time_s: place }
            | Self::BiasDrift { time_s: place }
            | Self::PositionFriction { wave_number: place }
            | Self::LoadRipple { wave_number: place, .. }
            | Self::Ripple { wave_number: place }
            | Self::MotorRipple { wave_number: place }
            | Self::Hysteresis { width: place }
            | Self::Mode { frequency_hz: place, .. }
            | Self::Backlash { width: place } => *place = number,
            _ => {}
        }
        other
    }

    /// The shapes of the effect at every row, one for each amplitude.
    pub(super) fn columns(&self, m: &Motion) -> Vec<Vec<f64>> {
        let by = |f: &dyn Fn(usize) -> f64| (0..m.q.len()).map(f).collect::<Vec<f64>>();
        let waves = |k: f64, carrier: &dyn Fn(usize) -> f64| {
            vec![by(&|i| carrier(i) * (k * m.q[i]).cos()), by(&|i| carrier(i) * (k * m.q[i]).sin())]
        };
        let warm = |time_s: f64, i: usize| 1.0 - (-m.time_s(i) / time_s).exp();
        let (size, middle, nominal) = (m.size, m.middle, m.nominal);
        match *self {
            Self::Inertia => vec![m.a.clone()],
            Self::Viscous => vec![m.v.clone()],
            Self::Coulomb => vec![m.s.clone()],
            Self::Scale => vec![by(&|i| nominal[0] * m.a[i] + nominal[1] * m.v[i] + nominal[2] * m.s[i])],
            Self::Constant => vec![vec![1.0; m.q.len()]],
            // once it slips it is an offset; rows of rest, which would tell, are not in the balance
            Self::Asymmetry => vec![vec![1.0; m.q.len()]],
            Self::DragAsymmetry => vec![by(&|i| (nominal[1] * m.v[i] + nominal[2] * m.s[i]).abs())],
            Self::Stribeck { rate, exponent } => {
                vec![by(&|i| m.s[i] * (-(m.v[i].abs() / rate).powf(exponent)).exp())]
            }
            Self::Presliding { displacement } => {
                let z = dahl_state(&m.q, displacement);
                vec![by(&|i| z[i] - m.s[i])]
            }
            Self::Quadratic => vec![by(&|i| m.v[i] * m.v[i].abs())],
            Self::ViscousCurve { exponent } => vec![by(&|i| m.s[i] * m.v[i].abs().powf(exponent))],
            Self::FrictionDrift { time_s } => vec![by(&|i| m.s[i] * warm(time_s, i))],
            Self::ViscousDrift { time_s } => vec![by(&|i| m.v[i] * warm(time_s, i))],
            Self::BiasDrift { time_s } => vec![by(&|i| warm(time_s, i))],
            Self::LoadDependence => vec![by(&|i| m.s[i] * m.needed[i].abs())],
            Self::InertialLoad => vec![by(&|i| m.s[i] * m.a[i].abs())],
            Self::PositionFriction { wave_number } => waves(wave_number, &|i| m.s[i]),
            Self::FrictionTaper => vec![by(&|i| m.s[i] * (m.q[i] - middle))],
            // where it is slack is not known
            Self::Spring => vec![by(&|i| m.q[i] - middle), vec![1.0; m.q.len()]],
            Self::Hysteresis { width } => vec![play_state(&m.q, width)],
            Self::Ripple { wave_number } => waves(wave_number, &|_| 1.0),
            Self::MotorRipple { wave_number } => waves(wave_number, &|i| m.needed[i]),
            Self::DeadZone => vec![by(&|i| (m.needed[i] / (0.02 * size)).clamp(-1.0, 1.0))],
            Self::TorqueCurve => vec![by(&|i| (m.needed[i] / size).powi(3))],
            Self::RateDelay => vec![m.a.clone()],
            Self::Lag => vec![m.derivative(&m.whole.apply(&m.needed))],
            Self::Flexible => vec![m.derivative(&m.derivative(&m.rest.apply(&m.a)))],
            Self::Mode { frequency_hz, damping } => vec![resonance::column(&m.a, m.period_s, frequency_hz, damping)],
            Self::Backlash { width } => {
                let p = play_state(&m.q, width);
                vec![by(&|i| (1.0 - p[i].abs()) * m.a[i]), by(&|i| (1.0 - p[i].abs()) * m.s[i])]
            }
            Self::Load { channel } => vec![m.auxiliary[channel].1.clone()],
            Self::LoadFriction { channel } => vec![by(&|i| m.s[i] * m.auxiliary[channel].1[i])],
            Self::LoadRipple { channel, wave_number } => waves(wave_number, &|i| m.auxiliary[channel].1[i]),
            Self::LoadGain { channel } => vec![by(&|i| m.needed[i] * m.auxiliary[channel].1[i])],
        }
    }

    /// The shapes on the grid of the balance.
    pub(super) fn on_grid(&self, m: &Motion) -> Vec<Vec<f64>> {
        if *self == Self::Scale {
            let own: Vec<Vec<f64>> = NOMINAL.iter().flat_map(|shape| shape.on_grid(m)).collect();
            let sum = |row: usize| own.iter().zip(m.nominal).map(|(column, nominal)| nominal * column[row]).sum();
            return vec![(0..m.rows.len()).map(sum).collect()];
        }
        let smoothed = matches!(self, Self::Inertia | Self::Viscous | Self::Mode { .. });
        self.columns(m).iter().map(|column| if smoothed { m.smoothed(column) } else { m.raw(column) }).collect()
    }
}

/// Root mean square.
pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
