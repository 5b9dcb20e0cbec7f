//! From the flight computer to the bench.

use core::ops::{BitOr, BitOrAssign};

use crate::fields::{Reader, Writer};
use crate::frame::PAYLOAD_LEN;

/// What the computer is doing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// No model is loaded.
    #[default]
    Empty = 0,
    /// A model is loaded; nothing steps.
    Ready = 1,
    /// It steps, and the output is good.
    Running = 2,
    /// It steps, and the output is the safe one.
    Safe = 3,
}

impl Mode {
    fn from_byte(byte: u8) -> Option<Self> {
        [Self::Empty, Self::Ready, Self::Running, Self::Safe].into_iter().find(|mode| *mode as u8 == byte)
    }

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Ready => "ready",
            Self::Running => "running",
            Self::Safe => "safe",
        }
    }
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// Done.
    Done = 0,
    /// Not in this mode.
    WrongMode = 1,
    /// A limit of the computer, which the bench cannot raise.
    AboveLimit = 2,
    /// Parts are missing, or the digest is another one.
    Incomplete = 3,
    /// A parameter has no meaning, or no law can be built from the model.
    WrongModel = 4,
}

impl Outcome {
    fn from_byte(byte: u8) -> Option<Self> {
        [Self::Done, Self::WrongMode, Self::AboveLimit, Self::Incomplete, Self::WrongModel]
            .into_iter()
            .find(|outcome| *outcome as u8 == byte)
    }
}

/// What the computer itself has to report, beside the faults of the model and the flags of the estimator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Computer(u16);

impl Computer {
    /// Nothing to report.
    pub const NONE: Self = Self(0);
    /// The watchdog has gone off since the last reset.
    pub const WATCHDOG_TRIPPED: Self = Self(1);
    /// More frames came within a tick than are looked at; the others were ignored.
    pub const OVERLOADED: Self = Self(1 << 1);
    /// theta as measured and as modelled have parted.
    pub const MODEL_DISAGREES: Self = Self(1 << 2);
    /// The correction was larger than the computer lets out, and was clamped.
    pub const CORRECTION_CLAMPED: Self = Self(1 << 3);
    /// A whole reset has taken place since the bench said hello.
    pub const RESTARTED: Self = Self(1 << 4);

    /// Every bit with its name in reports.
    pub const NAMES: [(Self, &'static str); 5] = [
        (Self::WATCHDOG_TRIPPED, "watchdog_tripped"),
        (Self::OVERLOADED, "overloaded"),
        (Self::MODEL_DISAGREES, "model_disagrees"),
        (Self::CORRECTION_CLAMPED, "correction_clamped"),
        (Self::RESTARTED, "restarted"),
    ];

    /// The bits.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The bits of a frame; `None` if one has no meaning.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Option<Self> {
        if bits < 1 << 5 { Some(Self(bits)) } else { None }
    }

    /// Whether all bits of `other` are set.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Computer {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Computer {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// Who I am.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// Digest of the flight code's source.
    pub build: u64,
    /// Digest of the model that is loaded; 0: none.
    pub model: u64,
    /// Largest number of ticks that the watchdog waits.
    pub watchdog_ticks: u16,
    /// Number of parameters of a model.
    pub parameters: u16,
    /// What the computer is doing.
    pub mode: Mode,
    /// Number system of the law: 0 `f32`, 1 fixed point.
    pub number: u8,
}

impl Identity {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .long(self.build)
            .long(self.model)
            .half(self.watchdog_ticks)
            .half(self.parameters)
            .byte(self.mode as u8)
            .byte(self.number)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (build, model) = (fields.long()?, fields.long()?);
        let (watchdog_ticks, parameters) = (fields.half()?, fields.half()?);
        let (mode, number) = (Mode::from_byte(fields.byte()?)?, fields.byte()?);
        fields.end(Self { build, model, watchdog_ticks, parameters, mode, number })
    }
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ack {
    /// Kind of the command.
    pub command: u8,
    /// What became of it.
    pub outcome: Outcome,
    /// Sequence number of the command.
    pub sequence: u16,
    /// Number of the parameter that is wrong, if one is.
    pub parameter: u16,
    /// Digest of the model that is loaded; 0: none.
    pub model: u64,
}

impl Ack {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .byte(self.command)
            .byte(self.outcome as u8)
            .half(self.sequence)
            .half(self.parameter)
            .long(self.model)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (command, outcome) = (fields.byte()?, Outcome::from_byte(fields.byte()?)?);
        let (sequence, parameter, model) = (fields.half()?, fields.half()?, fields.long()?);
        fields.end(Self { command, outcome, sequence, parameter, model })
    }
}

/// Everything that has been set since the last reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Faults {
    /// Fault bits of the model's step.
    pub model: u16,
    /// Flags of the estimator.
    pub estimator: u16,
    /// The computer's own.
    pub computer: Computer,
    /// How often the watchdog has gone off.
    pub trips: u16,
    /// Ticks with the safe output.
    pub safe_ticks: u32,
    /// Frames ignored because too many came within a tick.
    pub ignored: u32,
}

impl Faults {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .half(self.model)
            .half(self.estimator)
            .half(self.computer.bits())
            .half(self.trips)
            .word(self.safe_ticks)
            .word(self.ignored)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (model, estimator) = (fields.half()?, fields.half()?);
        let computer = Computer::from_bits(fields.half()?)?;
        let (trips, safe_ticks, ignored) = (fields.half()?, fields.word()?, fields.word()?);
        fields.end(Self { model, estimator, computer, trips, safe_ticks, ignored })
    }
}

/// One row of the ring, the oldest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingRow {
    /// Number of the step.
    pub row: u32,
    /// theta as measured; not a number where there was no reading [rad].
    pub measured_gyro_angle_rad: f32,
    /// theta as modelled [rad].
    pub modelled_gyro_angle_rad: f32,
    /// Specific force along x, y, z [m/s2].
    pub accel_mps2: [f32; 3],
    /// Vehicle rate [rad/s].
    pub vehicle_rate_radps: f32,
}

impl RingRow {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .word(self.row)
            .real([self.measured_gyro_angle_rad, self.modelled_gyro_angle_rad])
            .real(self.accel_mps2)
            .real([self.vehicle_rate_radps])
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let row = fields.word()?;
        let [measured_gyro_angle_rad, modelled_gyro_angle_rad] = fields.real()?;
        let (accel_mps2, [vehicle_rate_radps]) = (fields.real()?, fields.real()?);
        fields.end(Self { row, measured_gyro_angle_rad, modelled_gyro_angle_rad, accel_mps2, vehicle_rate_radps })
    }
}

/// That was the last row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RingEnd {
    /// How many there were.
    pub rows: u16,
    /// Whether an alarm has stopped the ring.
    pub stopped: bool,
}

impl RingEnd {
    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        Writer::new().half(self.rows).byte(u8::from(self.stopped)).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (rows, stopped) = (fields.half()?, fields.flag()?);
        fields.end(Self { rows, stopped })
    }
}

/// The estimate at the frame's tick: the last frame of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// phi, the attitude error; zero in mode safe [rad].
    pub gimbal_angle_rad: f32,
    /// Its uncertainty, 1 sigma; 1 rad in mode safe [rad].
    pub bound_rad: f32,
    /// Disturbance torque [N m].
    pub disturbance_torque_nm: f32,
    /// theta's innovation [rad].
    pub innovation_rad: f32,
    /// phi of the model [rad].
    pub modelled_gimbal_angle_rad: f32,
    /// theta of the model [rad].
    pub modelled_gyro_angle_rad: f32,
    /// Flags of the estimator.
    pub flags: u16,
    /// Fault bits of the model's step.
    pub faults: u16,
    /// Sequence number of the sensor frame that was used last.
    pub sensor_sequence: u16,
    /// What the computer is doing.
    pub mode: Mode,
    /// Age of the sensor frame [ticks]; 255: older, or none yet.
    pub age: u8,
}

impl Estimate {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .real([self.gimbal_angle_rad, self.bound_rad, self.disturbance_torque_nm, self.innovation_rad])
            .real([self.modelled_gimbal_angle_rad, self.modelled_gyro_angle_rad])
            .half(self.flags)
            .half(self.faults)
            .half(self.sensor_sequence)
            .byte(self.mode as u8)
            .byte(self.age)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let [gimbal_angle_rad, bound_rad, disturbance_torque_nm, innovation_rad] = fields.real()?;
        let [modelled_gimbal_angle_rad, modelled_gyro_angle_rad] = fields.real()?;
        let (flags, faults, sensor_sequence) = (fields.half()?, fields.half()?, fields.half()?);
        let (mode, age) = (Mode::from_byte(fields.byte()?)?, fields.byte()?);
        fields.end(Self {
            gimbal_angle_rad,
            bound_rad,
            disturbance_torque_nm,
            innovation_rad,
            modelled_gimbal_angle_rad,
            modelled_gyro_angle_rad,
            flags,
            faults,
            sensor_sequence,
            mode,
            age,
        })
    }
}

/// Corrections, and what the computer has counted on the link; counts stay at their largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Telemetry {
    /// What the navigation adds to its velocity along x and y [m/s].
    pub velocity_correction_mps: [f32; 2],
    /// What it adds to its position along x and y [m].
    pub position_correction_m: [f32; 2],
    /// Frames accepted.
    pub accepted: u32,
    /// Frames whose checksum did not fit.
    pub checksum: u16,
    /// Bytes between delimiters that were no frame otherwise.
    pub structure: u16,
    /// Sequence numbers left out.
    pub lost: u16,
    /// Ticks without a new sensor frame.
    pub held: u16,
    /// Sensor frames that came too late, twice or out of order.
    pub stale: u16,
    /// The computer's own bits.
    pub computer: Computer,
}

impl Telemetry {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .real(self.velocity_correction_mps)
            .real(self.position_correction_m)
            .word(self.accepted)
            .half(self.checksum)
            .half(self.structure)
            .half(self.lost)
            .half(self.held)
            .half(self.stale)
            .half(self.computer.bits())
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (velocity_correction_mps, position_correction_m) = (fields.real()?, fields.real()?);
        let (accepted, checksum, structure) = (fields.word()?, fields.half()?, fields.half()?);
        let (lost, held, stale) = (fields.half()?, fields.half()?, fields.half()?);
        let computer = Computer::from_bits(fields.half()?)?;
        fields.end(Self {
            velocity_correction_mps,
            position_correction_m,
            accepted,
            checksum,
            structure,
            lost,
            held,
            stale,
            computer,
        })
    }
}
