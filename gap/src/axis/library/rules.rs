//! What an effect must be to count: which way it acts, what it must take, what it stands for.

use super::{NOMINAL, Shape};

/// Relative change of a scale that is none: less than half of an effort is another unit.
const LEAST_SCALE: f64 = -0.5;

impl Shape {
    /// Whether it must brake wherever the axis slips: pre-sliding springs back.
    pub(in crate::axis) fn brakes(&self) -> bool {
        self.block() == "friction" && !matches!(self, Self::Presliding { .. })
    }

    /// Whether it stands for another effect, too: a spring has its neutral point, and so an offset; a scale has all nominal
    /// parameters.
    pub(in crate::axis) fn holds(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Spring, Self::Constant)) || *self == Self::Scale && NOMINAL.contains(other)
    }

    /// Whether it hangs on the effort that the motion needs.
    pub(in crate::axis) fn hangs_on_effort(&self) -> bool {
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

    /// Whether it acts at reversals, or through the motion's higher derivatives: it is never quite as it is formulated here.
    pub(in crate::axis) fn is_rough(&self) -> bool {
        matches!(
            self,
            Self::Stribeck { .. }
                | Self::Presliding { .. }
                | Self::LoadDependence
                | Self::InertialLoad
                | Self::Hysteresis { .. }
                | Self::Lag
                | Self::Flexible
                | Self::Mode { .. }
                | Self::Backlash(_)
        )
    }

    /// Whether it yields, at one displacement or at many.
    pub(in crate::axis) fn yields(&self) -> bool {
        matches!(self, Self::Presliding { .. } | Self::Hysteresis { .. })
    }

    /// Share of the effort's power that it must take; what hangs on the place or on a channel is known by that.
    pub(in crate::axis) fn least_of_effort(&self) -> f64 {
        match self {
            _ if self.is_rough() => 1e-4,
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
    pub(in crate::axis) fn many(&self) -> bool {
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
    pub(in crate::axis) fn possible(&self, amplitudes: &[f64], level: f64) -> bool {
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
            | Self::Backlash(_)
            | Self::Flexible => amplitudes[0] > 0.0,
            Self::Presliding { .. } => amplitudes[0] > 0.0 && amplitudes[0] < 1.5 * level.abs(),
            Self::Scale => amplitudes[0] > LEAST_SCALE,
            _ => true,
        }
    }
}
