//! Messages with any values, and random numbers from a seed.

#![allow(dead_code, reason = "no test file uses all of it")]

use gimbal_wire::{
    Ack, Computer, Estimate, Faults, Frame, Hello, Identity, LoadEnd, LoadPart, Message, Mode, Outcome, Reset, RingEnd,
    RingRow, Run, Sensor, Telemetry,
};
use proptest::array::{uniform2, uniform3};
use proptest::option;
use proptest::prelude::*;

/// Any frame whose numbers are numbers, so that frames can be compared.
pub(crate) fn frame() -> impl Strategy<Value = Frame> {
    (any::<u16>(), any::<u32>(), message()).prop_map(|(sequence, tick, message)| Frame { sequence, tick, message })
}

fn real() -> impl Strategy<Value = f32> {
    any::<f32>().prop_filter("a number", |value| !value.is_nan())
}

fn mode() -> impl Strategy<Value = Mode> {
    prop_oneof![Just(Mode::Empty), Just(Mode::Ready), Just(Mode::Running), Just(Mode::Safe)]
}

fn computer() -> impl Strategy<Value = Computer> {
    (0..32_u16).prop_map(|bits| Computer::from_bits(bits).expect("known bits"))
}

fn outcome() -> impl Strategy<Value = Outcome> {
    prop_oneof![
        Just(Outcome::Done),
        Just(Outcome::WrongMode),
        Just(Outcome::AboveLimit),
        Just(Outcome::Incomplete),
        Just(Outcome::WrongModel)
    ]
}

fn message() -> impl Strategy<Value = Message> {
    prop_oneof![
        any::<u64>().prop_map(|build| Message::Hello(Hello { build })),
        (any::<u16>(), uniform3(any::<f64>().prop_filter("a number", |value| !value.is_nan())))
            .prop_map(|(index, values)| Message::LoadPart(LoadPart { index, values })),
        (any::<u16>(), any::<u64>()).prop_map(|(count, digest)| Message::LoadEnd(LoadEnd { count, digest })),
        any::<bool>().prop_map(|whole| Message::Reset(Reset { whole })),
        any::<u16>().prop_map(|watchdog_ticks| Message::Run(Run { watchdog_ticks })),
        Just(Message::Stop),
        Just(Message::ReadFaults),
        Just(Message::DumpRing),
        Just(Message::Clock),
        (uniform3(real()), real(), option::of(real()), option::of(real())).prop_map(
            |(accel_mps2, vehicle_rate_radps, gyro_angle_rad, motor_torque_nm)| Message::Sensor(Sensor {
                accel_mps2,
                vehicle_rate_radps,
                gyro_angle_rad,
                motor_torque_nm
            })
        ),
        (any::<u64>(), any::<u64>(), any::<u16>(), any::<u16>(), mode(), any::<u8>()).prop_map(
            |(build, model, watchdog_ticks, parameters, mode, number)| Message::Identity(Identity {
                build,
                model,
                watchdog_ticks,
                parameters,
                mode,
                number
            })
        ),
        (any::<u8>(), outcome(), any::<u16>(), any::<u16>(), any::<u64>()).prop_map(
            |(command, outcome, sequence, parameter, model)| Message::Ack(Ack {
                command,
                outcome,
                sequence,
                parameter,
                model
            })
        ),
        (any::<u16>(), any::<u16>(), computer(), any::<u16>(), any::<u32>(), any::<u32>()).prop_map(
            |(model, estimator, computer, trips, safe_ticks, ignored)| Message::Faults(Faults {
                model,
                estimator,
                computer,
                trips,
                safe_ticks,
                ignored
            })
        ),
        (any::<u32>(), uniform2(real()), uniform3(real()), real()).prop_map(
            |(row, [measured_gyro_angle_rad, modelled_gyro_angle_rad], accel_mps2, vehicle_rate_radps)| {
                Message::RingRow(RingRow {
                    row,
                    measured_gyro_angle_rad,
                    modelled_gyro_angle_rad,
                    accel_mps2,
                    vehicle_rate_radps,
                })
            }
        ),
        (any::<u16>(), any::<bool>()).prop_map(|(rows, stopped)| Message::RingEnd(RingEnd { rows, stopped })),
        (uniform3(real()), uniform3(real()), uniform3(any::<u16>()), mode(), any::<u8>()).prop_map(
            |([phi, bound, torque], [innovation, gimbal, gyro], [flags, faults, sensor_sequence], mode, age)| {
                Message::Estimate(Estimate {
                    gimbal_angle_rad: phi,
                    bound_rad: bound,
                    disturbance_torque_nm: torque,
                    innovation_rad: innovation,
                    modelled_gimbal_angle_rad: gimbal,
                    modelled_gyro_angle_rad: gyro,
                    flags,
                    faults,
                    sensor_sequence,
                    mode,
                    age,
                })
            }
        ),
        (uniform2(real()), uniform2(real()), any::<u32>(), uniform3(any::<u16>()), uniform2(any::<u16>()), computer())
            .prop_map(|(velocity, position, accepted, [checksum, structure, lost], [held, stale], computer)| {
                Message::Telemetry(Telemetry {
                    velocity_correction_mps: velocity,
                    position_correction_m: position,
                    accepted,
                    checksum,
                    structure,
                    lost,
                    held,
                    stale,
                    computer,
                })
            }),
    ]
}

/// Random bits from a seed (xorshift64*, S. Vigna, 2016).
#[derive(Debug, Clone)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.bits().to_be_bytes()[0]
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.bits() >> 33).expect("31 bits") % end
    }

    /// Uniform from 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }
}
