//! The true plant: drifted nominal parameters and everything that the nominal model leaves out.

use gimbal_servo::Config;

/// Everything that decides how the true platform moves. `new` is the nominal platform.
#[derive(Debug, Clone)]
pub struct Truth {
    /// Parameters of the nominal equations, drifted or shifted.
    pub config: Config,
    /// Bearings beyond Palmgren and the clamp.
    pub friction: Friction,
    /// Torques on the gimbal.
    pub torque: Torque,
    /// Between compensator and gimbal, and what the servo sees.
    pub drive: Drive,
    /// On the float.
    pub float: Float,
    /// Parts that move against the stable member.
    pub appendage: Option<Appendage>,
}

/// Friction beyond the nominal level.
#[derive(Debug, Clone, Default)]
pub struct Friction {
    /// Relative change of the load torque.
    pub load_change: f64,
    /// Relative change of the viscous torque.
    pub viscous_change: f64,
    /// Relative change of the load torque per g of radial acceleration.
    pub load_per_g: f64,
    /// [N m s/rad]
    pub linear: f64,
    /// [N m s2/rad2]
    pub quadratic: f64,
    /// Excess [N m], rate [rad/s] and exponent of the Stribeck curve.
    pub stribeck: Option<[f64; 3]>,
    /// How friction builds up after a reversal.
    pub presliding: Option<Presliding>,
    /// Relative difference of the directions, halved.
    pub asymmetry: f64,
    /// Relative growth, time constant [s] and share of a second, four times quicker part.
    pub drift: Option<[f64; 3]>,
    /// Relative modulation, cycles a radian and phase [rad] over the relative angle.
    pub position: Option<[f64; 3]>,
}

/// Pre-sliding, in one of two formulations.
#[derive(Debug, Clone)]
pub enum Presliding {
    /// Bristles as `LuGre` has them, settling on the nominal curve over this displacement [rad].
    Bristles(f64),
    /// Maxwell elements with a yield: displacement [rad] and weight of each.
    MaxwellSlip(Vec<(f64, f64)>),
}

/// Torques on the gimbal that the nominal model does not have.
#[derive(Debug, Clone, Default)]
pub struct Torque {
    /// Change of the unbalance along x and y [kg m].
    pub unbalance_kg_m: [f64; 2],
    /// [N m s4/m2]
    pub anisoelastic: f64,
    /// Linear [N m/rad] and cubic [N m/rad3] stiffness of the cable.
    pub spring: [f64; 2],
    /// Stop operators of the cable: displacement [rad] and torque [N m] of each.
    pub hysteresis: Vec<(f64, f64)>,
    /// Amplitude [N m], cycles a radian, phase [rad].
    pub ripple: Vec<[f64; 3]>,
    /// [N m]
    pub constant_nm: f64,
    /// [N m s2/rad2]
    pub cross_rates: f64,
    /// Torque over the square of the vehicle rate [N m s2/rad2].
    pub rate_squared: f64,
    /// Torque [N m] and half width [rad] of a spring that snaps over.
    pub snap: Option<[f64; 2]>,
    /// A contact at times.
    pub contact: Option<Contact>,
    /// Torque [N m] and displacement [rad] of a brush that sticks and slips, up to a rate [rad/s].
    pub chatter: Option<[f64; 3]>,
    /// Stiffness [N m/rad] and time constant [s] of a cable that creeps.
    pub creep: Option<[f64; 2]>,
    /// Torque over time, one value a row of the track [N m].
    pub series_nm: Vec<f64>,
}

/// A one-sided spring that is there only at times.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Stiffness [N m/rad].
    pub stiffness: f64,
    /// Angle at which it begins, positive side [rad].
    pub from_rad: f64,
    /// Spans of time in which it is there [s].
    pub spans_s: Vec<(f64, f64)>,
}

/// Between compensator and gimbal.
#[derive(Debug, Clone, Default)]
pub struct Drive {
    /// Pure delay of the command [s].
    pub delay_s: f64,
    /// Largest torque [N m].
    pub limit_nm: Option<f64>,
    /// Half width of the dead zone [N m].
    pub dead_zone_nm: f64,
    /// Step of the pick-off [rad].
    pub step_rad: Option<f64>,
    /// Noise of the pick-off that the servo takes for motion, one value a row of the track [rad].
    pub noise_rad: Vec<f64>,
    /// What the integrator holds at the record's beginning beside what it came to [N m].
    pub begins_nm: f64,
    /// Relative loss of torque at full heat, torque of full heat [N m], time constant [s].
    pub heating: Option<[f64; 3]>,
    /// Torque over its own size.
    pub torque_asymmetry: f64,
    /// Spans in which the command stands still [s].
    pub frozen_s: Vec<(f64, f64)>,
}

/// On the float.
#[derive(Debug, Clone, Default)]
pub struct Float {
    /// [N m]
    pub constant_nm: f64,
    /// [N m s2/m], along x.
    pub per_accel: f64,
    /// Elastic restraint [N m/rad].
    pub restraint: f64,
    /// Relative swing of H, frequency [Hz], phase [rad].
    pub hunting: Option<[f64; 3]>,
}

/// A second mass on the stable member; the total inertia stays.
#[derive(Debug, Clone, Copy)]
pub struct Appendage {
    /// Share of the total inertia.
    pub share: f64,
    /// Natural frequency of the appendage on a fixed member [rad/s].
    pub frequency_radps: f64,
    /// Damping ratio of the same.
    pub damping: f64,
    /// Half width of the free play [rad].
    pub play_rad: f64,
}

impl Truth {
    /// The platform of a configuration, with nothing beside.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        Self {
            config: *config,
            friction: Friction::default(),
            torque: Torque::default(),
            drive: Drive::default(),
            float: Float::default(),
            appendage: None,
        }
    }
}
