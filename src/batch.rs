//! Many axes side by side: the step of a law in `f32`, vectorised across lanes.
//!
//! Each lane has a law, a state and rows of its own. Lanes on the straight path of a step, the gyro free and the row
//! inside its ranges, are taken together: signals and coefficients of all lanes lie side by side, and loops run over
//! lanes through the same functions as the scalar step. A lane that leaves the straight path takes that step through
//! [`Law::step`] itself. Either way its bits are those of the scalar step.
//!
//! How wide the vectors are is the compiler's matter: build for the processor at hand, or call from a function that
//! enables its features.

#![allow(
    clippy::needless_range_loop,
    clippy::needless_bitwise_bool,
    reason = "loops over lanes of many signals, without branches"
)]

mod coefs;
mod level;
mod memory;
mod straight;
mod sums;

use crate::faults::Faults;
use crate::law::Law;
use crate::signals::{Input, Stop};
use crate::state::State;
use coefs::Coefs;
use level::Levels;
use memory::Memory;
use straight::Course;
use sums::Sums;

/// Rows of `L` lanes, signal by signal.
pub type Rows<const L: usize> = Input<[f32; L]>;

/// The rows of several axes as one of all lanes.
#[must_use]
pub fn side_by_side<const L: usize>(rows: &[Input<f32>; L]) -> Rows<L> {
    Input {
        accel_x_mps2: rows.map(|row| row.accel_x_mps2),
        accel_y_mps2: rows.map(|row| row.accel_y_mps2),
        accel_z_mps2: rows.map(|row| row.accel_z_mps2),
        vehicle_rate_radps: rows.map(|row| row.vehicle_rate_radps),
        torque_nm: rows.map(|row| row.torque_nm),
        spin_rate_radps: rows.map(|row| row.spin_rate_radps),
    }
}

/// `L` axes that step together; 32 lanes stay within a first-level cache.
///
/// ```
/// use gimbal_servo::{Config, Input, Stop, batch::Batch};
///
/// let law = Config::consistent().build::<f32>()?;
/// let mut batch = Batch::new([&law; 32]);
/// let zero = [0.0; 32];
/// let rows = Input {
///     accel_x_mps2: zero,
///     accel_y_mps2: core::array::from_fn(|lane| lane as f32),
///     accel_z_mps2: zero,
///     vehicle_rate_radps: [0.1; 32],
///     torque_nm: zero,
///     spin_rate_radps: zero,
/// };
/// let output = batch.step(&rows);
/// assert_eq!(output.stop[31], Stop::Free);
/// # Ok::<(), gimbal_servo::BuildError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Batch<'a, const L: usize> {
    laws: [&'a Law<f32>; L],
    coefs: Coefs<L>,
    /// At the last row and at the row to come, in turn.
    memories: [Memory<L>; 2],
    is_second: bool,
    levels: Levels<L>,
    course: Course<L>,
    sums: Sums<L>,
    others: Others<L>,
    /// What the straight path leaves alone.
    rest: [State<f32>; L],
    offset: [f32; L],
    lasting: [Faults; L],
    /// All bits for a lane that may take the straight path.
    may: [u32; L],
}

/// Outputs that the next step does not need.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Others<const L: usize> {
    gimbal_rate: [f32; L],
    disturbance_torque: [f32; L],
    motor_torque: [f32; L],
    friction_torque: [f32; L],
    unbalance_torque: [f32; L],
    stop_change_age: [f32; L],
    stop: [Stop; L],
    faults: [Faults; L],
}

/// What a step of all lanes gives: [`crate::Output`] signal by signal.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs, reason = "the fields of `Output`")]
pub struct Output<'a, const L: usize> {
    pub gimbal_angle_rad: &'a [f32; L],
    pub gimbal_rate_radps: &'a [f32; L],
    pub gyro_angle_rad: &'a [f32; L],
    pub motor_torque_nm: &'a [f32; L],
    pub friction_torque_nm: &'a [f32; L],
    pub unbalance_torque_nm: &'a [f32; L],
    pub disturbance_torque_nm: &'a [f32; L],
    pub relative_rate_radps: &'a [f32; L],
    pub stop: &'a [Stop; L],
    pub stop_change_age: &'a [f32; L],
    pub faults: &'a [Faults; L],
}

impl<'a, const L: usize> Batch<'a, L> {
    /// All lanes at rest, before their first row.
    #[must_use]
    pub fn new(laws: [&'a Law<f32>; L]) -> Self {
        Self::resume(laws, laws.map(Law::start))
    }

    /// Lanes that go on from states of their laws.
    #[must_use]
    pub fn resume(laws: [&'a Law<f32>; L], states: [State<f32>; L]) -> Self {
        let coefs = Coefs::new(&laws);
        let mut memory = Memory::new();
        for (lane, state) in states.iter().enumerate() {
            memory.put(lane, state);
        }
        Self {
            laws,
            memories: [memory, memory],
            is_second: false,
            levels: Levels::new(),
            course: Course::new(),
            sums: Sums::new(),
            others: Others {
                gimbal_rate: [0.0; L],
                disturbance_torque: [0.0; L],
                motor_torque: [0.0; L],
                friction_torque: [0.0; L],
                unbalance_torque: [0.0; L],
                stop_change_age: states.map(|state| state.stop_change_age),
                stop: states.map(|state| state.regime.stop()),
                faults: states.map(|state| state.faults),
            },
            offset: states.map(|state| state.offset),
            lasting: states.map(|state| state.lasting),
            may: core::array::from_fn(|lane| coefs.may(laws[lane], &states[lane])),
            rest: states,
            coefs,
        }
    }

    /// The state of a lane, as the scalar step would have it.
    ///
    /// # Panics
    /// If there is no such lane.
    #[must_use]
    pub fn state(&self, lane: usize) -> State<f32> {
        let mut state = self.rest[lane];
        self.memories[usize::from(self.is_second)].get(lane, &mut state);
        self.sums.complete(lane, &mut state.ins);
        state.stop_change_age = self.others.stop_change_age[lane];
        state.faults = self.others.faults[lane];
        state
    }

    /// Takes the rows of this instant and gives the state of every axis at it.
    pub fn step(&mut self, rows: &Rows<L>) -> Output<'_, L> {
        self.step_on(Baseline, rows)
    }

    /// [`Batch::step`] with all that a processor can do.
    #[inline(always)]
    pub fn step_on(&mut self, processor: impl Processor, rows: &Rows<L>) -> Output<'_, L> {
        let [first, second] = &mut self.memories;
        let (last, next) = if self.is_second { (second, first) } else { (first, second) };
        let course = &mut self.course;
        course.stays = self.may;
        processor.run(|| self.levels.take(&self.coefs, &self.laws, last, rows, &mut next.friction_level));
        processor.run(|| self.others.set_faults(&self.levels.table_end, &self.lasting));
        processor.run(|| course.disturb(&self.coefs, last, rows, next, &mut self.others));
        processor.run(|| course.rub(&self.coefs, &self.laws, last));
        processor.run(|| course.advance(&self.coefs, last, rows, next, &self.offset, &mut self.others));
        self.is_second = !self.is_second;
        processor.run(|| course.count(&self.coefs, last, rows, next));
        if straight::all(&course.stays) == 0 {
            self.step_aside(rows);
        }
        processor.run(|| self.sums.add(&self.course.counts, &mut self.rest));
        self.output()
    }

    /// Takes the lanes that left the straight path through the scalar step.
    #[inline(never)]
    fn step_aside(&mut self, rows: &Rows<L>) {
        let course = &mut self.course;
        let [first, second] = &mut self.memories;
        let (last, next) = if self.is_second { (first, second) } else { (second, first) };
        for lane in (0..L).filter(|lane| course.stays[*lane] == 0) {
            let state = &mut self.rest[lane];
            last.get(lane, state);
            self.sums.complete(lane, &mut state.ins);
            self.sums.restart(lane);
            course.counts.iter_mut().for_each(|counts| counts[lane] = 0.0);
            let output = self.laws[lane].step(state, rows.lane(lane));
            next.put(lane, state);
            self.others.put(lane, &output);
            self.offset[lane] = state.offset;
            self.lasting[lane] = state.lasting;
            self.may[lane] = self.coefs.may(self.laws[lane], state);
        }
    }

    #[inline(always)]
    fn output(&self) -> Output<'_, L> {
        let memory = &self.memories[usize::from(self.is_second)];
        Output {
            gimbal_angle_rad: &memory.gimbal_angle,
            gimbal_rate_radps: &self.others.gimbal_rate,
            gyro_angle_rad: &memory.gyro_angle,
            motor_torque_nm: &self.others.motor_torque,
            friction_torque_nm: &self.others.friction_torque,
            unbalance_torque_nm: &self.others.unbalance_torque,
            disturbance_torque_nm: &self.others.disturbance_torque,
            relative_rate_radps: &memory.relative_rate,
            stop: &self.others.stop,
            stop_change_age: &self.others.stop_change_age,
            faults: &self.others.faults,
        }
    }
}

impl<const L: usize> Others<L> {
    #[inline(always)]
    fn set_faults(&mut self, table_end: &[u32; L], lasting: &[Faults; L]) {
        for lane in 0..L {
            self.faults[lane] = Faults::TABLE_END.when(table_end[lane] != 0) | lasting[lane];
        }
    }

    fn put(&mut self, lane: usize, output: &crate::Output<f32>) {
        self.gimbal_rate[lane] = output.gimbal_rate_radps;
        self.disturbance_torque[lane] = output.disturbance_torque_nm;
        self.motor_torque[lane] = output.motor_torque_nm;
        self.friction_torque[lane] = output.friction_torque_nm;
        self.unbalance_torque[lane] = output.unbalance_torque_nm;
        self.stop_change_age[lane] = output.stop_change_age;
        self.stop[lane] = output.stop;
        self.faults[lane] = output.faults;
    }
}

/// How loops over lanes are run: a caller that knows its processor lets them use all of it.
///
/// Whatever the width of the vectors, the bits are the same.
pub trait Processor: Copy {
    /// Runs a loop, inside a function that the processor's features are enabled for.
    fn run<R>(self, work: impl FnOnce() -> R) -> R;
}

/// Every processor of the target that the library is built for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Baseline;

impl Processor for Baseline {
    // A function of its own: inside a larger one the compiler no longer sees that lanes are independent.
    #[inline(never)]
    fn run<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
}
