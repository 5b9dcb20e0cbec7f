//! One axis of the library, run over rows in either number system, and the plant beside it.

use std::fmt::Write;

use gimbal_plant::{Plant, Row, StopEventKind};
use gimbal_servo::{BuildError, Config, Faults, Fixed, Input, Law, Number, Output, State, Stop};

/// One of the two number systems.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// `f32`.
    F32,
    /// [`Fixed`].
    Fixed,
}

impl System {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::F32, Self::Fixed];

    /// As in results and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::Fixed => "fixed",
        }
    }
}

/// A law and its state.
#[derive(Debug, Clone)]
pub struct Axis<N: Number> {
    /// The law.
    pub law: Law<N>,
    /// Where it stands.
    pub state: State<N>,
}

impl<N: Number> Axis<N> {
    /// At rest.
    ///
    /// # Errors
    /// Whatever `build` finds wrong.
    pub fn new(config: &Config) -> Result<Self, BuildError> {
        let law = config.build()?;
        let state = law.start();
        Ok(Self { law, state })
    }

    /// One step, SI in and out.
    pub fn step(&mut self, row: &Row) -> Output<f64> {
        let input = self.law.units().input(&si(row));
        let output = self.law.step(&mut self.state, input);
        self.law.units().output(&output)
    }
}

/// A row as the library takes it.
#[must_use]
pub fn si(row: &Row) -> Input<f64> {
    Input {
        accel_x_mps2: row.accel_x_mps2,
        accel_y_mps2: row.accel_y_mps2,
        accel_z_mps2: row.accel_z_mps2,
        vehicle_rate_radps: row.vehicle_rate_radps,
        torque_nm: row.torque_nm,
        spin_rate_radps: row.spin_rate_radps,
    }
}

/// What both the library and the plant say of one instant.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// phi [rad].
    pub gimbal_angle_rad: f64,
    /// theta [rad].
    pub gyro_angle_rad: f64,
    /// `T_m` [N m].
    pub motor_torque_nm: f64,
    /// `T_f` [N m].
    pub friction_torque_nm: f64,
    /// `w_rel` [rad/s].
    pub relative_rate_radps: f64,
    /// INS velocity error [m/s].
    pub velocity_error_mps: [f64; 2],
    /// INS position error [m].
    pub position_error_m: [f64; 2],
    /// Fault bits; none from the plant.
    pub faults: Faults,
}

/// A contact with a stop or a release from it.
#[derive(Debug, Clone, Copy)]
pub struct Event {
    /// When [s].
    pub time_s: f64,
    /// Whether the float met the stop; else it left it.
    pub contact: bool,
    /// Whether it is the positive stop.
    pub positive: bool,
}

/// A whole run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Time between samples [s].
    pub period_s: f64,
    /// One a row.
    pub samples: Vec<Sample>,
    /// Contacts and releases in order.
    pub events: Vec<Event>,
    /// All fault bits that were ever set.
    pub faults: Faults,
    /// What phi moved unseen [rad]; 0 from the plant.
    pub residual_offset_rad: f64,
}

impl Run {
    /// Largest absolute value of a signal.
    pub fn peak(&self, of: impl Fn(&Sample) -> f64) -> f64 {
        self.samples.iter().fold(0.0, |most: f64, sample| most.max(of(sample).abs()))
    }

    /// Largest |phi| [rad].
    #[must_use]
    pub fn peak_phi_rad(&self) -> f64 {
        self.peak(|sample| sample.gimbal_angle_rad)
    }

    /// Largest |theta| [rad].
    #[must_use]
    pub fn peak_theta_rad(&self) -> f64 {
        self.peak(|sample| sample.gyro_angle_rad)
    }

    /// The last sample.
    ///
    /// # Panics
    /// Without any sample.
    #[must_use]
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }

    /// Norm of the last velocity error [m/s].
    #[must_use]
    pub fn velocity_error_mps(&self) -> f64 {
        let [x, y] = self.last().velocity_error_mps;
        x.hypot(y)
    }

    /// Largest difference of a signal from another run's, over the other's peak.
    ///
    /// # Panics
    /// If the runs are not of one length.
    pub fn difference(&self, other: &Self, of: impl Fn(&Sample) -> f64) -> f64 {
        assert_eq!(self.samples.len(), other.samples.len(), "runs of one length");
        let pairs = self.samples.iter().zip(&other.samples);
        let largest = pairs.fold(0.0, |most: f64, (a, b)| most.max((of(a) - of(b)).abs()));
        largest / other.peak(&of)
    }

    /// Signals of `other` that lie farther off than a share `bound` of the peak, as text; empty if none.
    #[must_use]
    pub fn angles_off(&self, other: &Self, bound: f64) -> String {
        let phi = self.difference(other, |sample| sample.gimbal_angle_rad);
        let theta = self.difference(other, |sample| sample.gyro_angle_rad);
        let mut text = String::new();
        for (name, difference) in [("phi", phi), ("theta", theta)] {
            // NaN counts as off
            if difference.is_nan() || difference > bound {
                write!(text, " {name} off by {difference:.3e} of its peak").expect("a string takes all");
            }
        }
        text
    }
}

/// Runs the library from rest.
///
/// # Panics
/// If the configuration does not build.
#[must_use]
pub fn run(system: System, config: &Config, rows: &[Row]) -> Run {
    match try_run(system, config, rows) {
        Ok(run) => run,
        Err(error) => panic!("{error}"),
    }
}

/// Runs the library from rest.
///
/// # Errors
/// If the configuration does not build.
pub fn try_run(system: System, config: &Config, rows: &[Row]) -> Result<Run, BuildError> {
    match system {
        System::F32 => run_in::<f32>(config, rows),
        System::Fixed => run_in::<Fixed>(config, rows),
    }
}

fn run_in<N: Number>(config: &Config, rows: &[Row]) -> Result<Run, BuildError> {
    let mut axis = Axis::<N>::new(config)?;
    let mut run = Run {
        period_s: config.period_s,
        samples: Vec::with_capacity(rows.len()),
        events: Vec::new(),
        faults: Faults::NONE,
        residual_offset_rad: 0.0,
    };
    let mut stop = Stop::Free;
    for (index, row) in rows.iter().enumerate() {
        let output = axis.step(row);
        if output.stop != stop {
            let contact = output.stop != Stop::Free;
            let side = if contact { output.stop } else { stop };
            let time_s = (index as f64 - output.stop_change_age) * config.period_s;
            run.events.push(Event { time_s, contact, positive: side == Stop::Positive });
            stop = output.stop;
        }
        run.faults |= output.faults;
        run.samples.push(Sample {
            gimbal_angle_rad: output.gimbal_angle_rad,
            gyro_angle_rad: output.gyro_angle_rad,
            motor_torque_nm: output.motor_torque_nm,
            friction_torque_nm: output.friction_torque_nm,
            relative_rate_radps: output.relative_rate_radps,
            velocity_error_mps: axis.law.velocity_error_mps(&axis.state),
            position_error_m: axis.law.position_error_m(&axis.state),
            faults: output.faults,
        });
    }
    run.residual_offset_rad = axis.law.residual_offset_rad(&axis.state);
    Ok(run)
}

/// Runs the plant from rest, its inputs between rows as the configuration says.
///
/// # Panics
/// If the configuration is wrong.
#[must_use]
pub fn run_plant(config: &Config, rows: &[Row]) -> Run {
    run_plant_at(config, rows, 1e-10)
}

/// [`run_plant`] with a local error of its own.
///
/// # Panics
/// If the configuration is wrong.
#[must_use]
pub fn run_plant_at(config: &Config, rows: &[Row], tolerance: f64) -> Run {
    let plant = Plant::new(config).expect("a configuration that builds").with_tolerance(tolerance);
    let mut state = plant.start();
    let mut samples = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        let sample = match index.checked_sub(1) {
            Some(previous) => plant.step(&mut state, &rows[previous], row),
            None => plant.sample(&state, row),
        };
        samples.push(Sample {
            gimbal_angle_rad: sample.gimbal_angle_rad,
            gyro_angle_rad: sample.gyro_angle_rad,
            motor_torque_nm: sample.motor_torque_nm,
            friction_torque_nm: sample.friction_torque_nm,
            relative_rate_radps: row.vehicle_rate_radps - sample.gimbal_rate_radps,
            velocity_error_mps: sample.velocity_error_mps,
            position_error_m: sample.position_error_m,
            faults: Faults::NONE,
        });
    }
    let events = state.events().iter().map(|event| Event {
        time_s: event.time_s,
        contact: event.kind == StopEventKind::Contact,
        positive: event.side == gimbal_plant::Stop::Positive,
    });
    Run { period_s: config.period_s, samples, events: events.collect(), faults: Faults::NONE, residual_offset_rad: 0.0 }
}
