//! What an axis can have beyond inertia, viscous and Coulomb friction: effects of the library and effects that it lacks.
//!
//! ```text
//! effort delivered = J a + B v + F(level) + force      level = Fc + sum of levels, all of it times direction
//! ```

/// Everything at one instant that an effect can hang on.
#[derive(Debug, Clone, Copy, Default)]
pub struct State {
    /// Time [s].
    pub t: f64,
    /// Position from the middle of the travel.
    pub q: f64,
    /// Rate.
    pub v: f64,
    /// Acceleration: of a recorded row alone.
    pub a: f64,
    /// Direction, -1 to 1, through pre-sliding.
    pub s: f64,
    /// Effort of the drive.
    pub u: f64,
    /// Load channel.
    pub load: f64,
    /// Play state, -1 to 1, of the hysteresis.
    pub play: f64,
    /// Heat of the motor over what it settles to at the effort's size.
    pub heat: f64,
    /// A force of no pattern, of unit deviation.
    pub random: f64,
}

/// Kinds; those from `CubicSpring` on are not in the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Inertia,
    Viscous,
    Level,
    Scale,
    Constant,
    Asymmetry,
    Stribeck,
    Presliding,
    Quadratic,
    Curve,
    FrictionDrift,
    ViscousDrift,
    BiasDrift,
    LoadDependence,
    PositionFriction,
    Taper,
    Spring,
    Hysteresis,
    Ripple,
    MotorRipple,
    DeadZone,
    TorqueCurve,
    Lag,
    Flexible,
    Backlash,
    Load,
    LoadFriction,
    VelocityDelay,
    VelocityScale,
    TorqueSign,
    CubicSpring,
    HiddenPulses,
    Vibration,
    LocalFriction,
    OneSidedViscous,
    MotorHeating,
    StickyThird,
    RandomForce,
    ClippedUnseen,
}

/// Every kind of the library, and every kind beyond it.
pub const LIBRARY: [Kind; 30] = [
    Kind::Inertia,
    Kind::Viscous,
    Kind::Level,
    Kind::Scale,
    Kind::Constant,
    Kind::Asymmetry,
    Kind::Stribeck,
    Kind::Presliding,
    Kind::Quadratic,
    Kind::Curve,
    Kind::FrictionDrift,
    Kind::ViscousDrift,
    Kind::BiasDrift,
    Kind::LoadDependence,
    Kind::PositionFriction,
    Kind::Taper,
    Kind::Spring,
    Kind::Hysteresis,
    Kind::Ripple,
    Kind::MotorRipple,
    Kind::DeadZone,
    Kind::TorqueCurve,
    Kind::Lag,
    Kind::Flexible,
    Kind::Backlash,
    Kind::Load,
    Kind::LoadFriction,
    Kind::VelocityDelay,
    Kind::VelocityScale,
    Kind::TorqueSign,
];
pub const BEYOND: [Kind; 9] = [
    Kind::CubicSpring,
    Kind::HiddenPulses,
    Kind::Vibration,
    Kind::LocalFriction,
    Kind::OneSidedViscous,
    Kind::MotorHeating,
    Kind::StickyThird,
    Kind::RandomForce,
    Kind::ClippedUnseen,
];

impl Kind {
    /// The name that the diagnosis should give it; of those beyond the library, what the table calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertia => "inertia",
            Self::Viscous => "viscous_friction",
            Self::Level => "friction_level",
            Self::Scale => "torque_scale",
            Self::Constant => "constant_torque",
            Self::Asymmetry => "direction_asymmetry",
            Self::Stribeck => "stribeck",
            Self::Presliding => "presliding",
            Self::Quadratic => "quadratic_drag",
            Self::Curve => "viscous_curve",
            Self::FrictionDrift => "friction_drift",
            Self::ViscousDrift => "viscous_drift",
            Self::BiasDrift => "bias_drift",
            Self::LoadDependence => "load_dependence",
            Self::PositionFriction => "position_friction",
            Self::Taper => "friction_taper",
            Self::Spring => "cable_spring",
            Self::Hysteresis => "cable_hysteresis",
            Self::Ripple => "torque_ripple",
            Self::MotorRipple => "motor_ripple",
            Self::DeadZone => "dead_zone",
            Self::TorqueCurve => "torque_curve",
            Self::Lag => "motor_lag",
            Self::Flexible => "flexible_mode",
            Self::Backlash => "backlash",
            Self::Load => "external_load:load",
            Self::LoadFriction => "load_friction:load",
            Self::VelocityDelay => "velocity_delay",
            Self::VelocityScale => "velocity_scale",
            Self::TorqueSign => "torque_sign",
            Self::CubicSpring => "(cubic spring)",
            Self::HiddenPulses => "(pulses of a load not logged)",
            Self::Vibration => "(vibration at one frequency)",
            Self::LocalFriction => "(friction in one place)",
            Self::OneSidedViscous => "(viscous friction of one direction)",
            Self::MotorHeating => "(motor weaker when hot)",
            Self::StickyThird => "(friction in the middle third of the log)",
            Self::RandomForce => "(coloured force)",
            Self::ClippedUnseen => "(drive clips below its logged command)",
        }
    }
}

/// An effect of one axis: its size, its number (wave number, rate, time, width) and phase.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    pub kind: Kind,
    pub size: f64,
    pub number: f64,
    pub phase: f64,
}

impl Term {
    /// What it adds to the level of friction.
    pub fn level(&self, x: &State) -> f64 {
        let shape = match self.kind {
            Kind::Level => 1.0,
            Kind::Asymmetry => x.s.signum(),
            Kind::Stribeck => (-(x.v / self.number).powi(2)).exp(),
            Kind::Curve => (x.v.abs() / self.number).powf(self.phase),
            Kind::FrictionDrift => 1.0 - (-x.t / self.number).exp(),
            Kind::LoadDependence => x.u.abs(),
            Kind::PositionFriction => (self.number * x.q - self.phase).cos(),
            Kind::Taper => x.q,
            Kind::LoadFriction => x.load,
            Kind::LocalFriction => (-((x.q - self.phase) / self.number).powi(2)).exp(),
            Kind::StickyThird => f64::from((self.number..2.0 * self.number).contains(&x.t)),
            _ => 0.0,
        };
        self.size * shape
    }

    /// What it adds to the force against the motor.
    pub fn force(&self, x: &State) -> f64 {
        let shape = match self.kind {
            Kind::Viscous => x.v,
            Kind::Constant => 1.0,
            Kind::Quadratic => x.v * x.v.abs(),
            Kind::ViscousDrift => x.v * (1.0 - (-x.t / self.number).exp()),
            Kind::BiasDrift => 1.0 - (-x.t / self.number).exp(),
            Kind::Spring => x.q,
            Kind::Hysteresis => x.play,
            Kind::Ripple => (self.number * x.q - self.phase).cos(),
            Kind::Load => x.load,
            Kind::CubicSpring => (x.q / self.number).powi(3),
            Kind::HiddenPulses => {
                let place = (x.t / self.number + self.phase).fract();
                f64::from(place < 0.22) - 0.6 * f64::from((0.5..0.6).contains(&place))
            }
            Kind::Vibration => (self.number * x.t + self.phase).sin(),
            Kind::OneSidedViscous => x.v.max(0.0),
            Kind::RandomForce => x.random,
            _ => 0.0,
        };
        self.size * shape
    }

    /// What the drive gives of an effort.
    pub fn delivered(&self, u: f64, x: &State) -> f64 {
        match self.kind {
            Kind::Scale => u / (1.0 + self.size),
            Kind::MotorRipple => u * (1.0 - self.size * (self.number * x.q - self.phase).cos()),
            Kind::DeadZone => u.signum() * (u.abs() - self.size).max(0.0),
            Kind::TorqueCurve => u * (1.0 - self.size * (u / self.number).powi(2)).max(0.3),
            Kind::MotorHeating => u * (1.0 - self.size * x.heat),
            Kind::ClippedUnseen => u.clamp(-self.size, self.size),
            _ => u,
        }
    }

    /// Effort of one unit of its size at a recorded row: what it is sized by. None of those whose size is drawn.
    pub fn unit(&self, x: &State) -> Option<f64> {
        let one = Self { size: 1.0, ..*self };
        match self.kind {
            Kind::Inertia => Some(x.a),
            Kind::Scale => Some(x.u),
            Kind::MotorRipple => Some(x.u * (self.number * x.q - self.phase).cos()),
            Kind::DeadZone => Some(x.u.signum()),
            Kind::TorqueCurve => Some(x.u * (x.u / self.number).powi(2)),
            Kind::MotorHeating => Some(x.u * x.heat),
            Kind::Presliding
            | Kind::Lag
            | Kind::Flexible
            | Kind::Backlash
            | Kind::VelocityDelay
            | Kind::VelocityScale
            | Kind::TorqueSign
            | Kind::ClippedUnseen => None,
            _ => Some(one.force(x) + x.s * one.level(x)),
        }
    }
}
