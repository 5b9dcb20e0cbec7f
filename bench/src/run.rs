//! One run: the scenario from its first tick to its last, to the computer at the end of a link.

mod deadlines;
mod outcome;

use std::collections::BTreeMap;
use std::time::{Duration, Instant, SystemTime};

use gimbal_computer::{BUILD, limits, parameters};
use gimbal_wire::{Estimate, Frame, Message, Mode, Outcome as Answer, Receiver, Run as Begin};
use serde_json::json;

use crate::exchange::Patience;
use crate::fault::Faults;
use crate::judge::Judge;
use crate::link::Link;
use crate::platform::{Moment, Platform};
use crate::record::Recorder;
use crate::scenario::{Action, Scenario, Way};
use crate::station::{Board, StationError};
use deadlines::wait_until;

pub use deadlines::Deadlines;
pub use outcome::{LinkStatistics, Outcome, Verdict};

/// Whose clock it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// As fast as the link allows: the same bytes every time.
    Lockstep,
    /// One tick a period by the wall clock.
    RealTime,
}

impl Pace {
    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lockstep => "lockstep",
            Self::RealTime => "real time",
        }
    }
}

/// How to fly.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Whose clock it is.
    pub pace: Pace,
    /// How long an answer is waited for.
    pub patience: Patience,
}

/// What a user may see of a tick.
#[derive(Debug)]
pub struct Live<'a> {
    /// Truth and readings.
    pub moment: &'a Moment,
    /// Number of ticks.
    pub ticks: u32,
    /// The estimate, if it has come.
    pub estimate: Option<&'a Estimate>,
    /// Bits raised so far, and when first [s].
    pub bits: &'a BTreeMap<&'static str, f64>,
    /// Period [s].
    pub period_s: f64,
}

/// Whoever watches a run; `false` ends it.
pub trait Watch {
    /// After every tick.
    fn tick(&mut self, live: &Live) -> bool;
}

/// What was found out about the computer before the first tick.
struct Found {
    started: SystemTime,
    builds: [u64; 2],
    models: [u64; 2],
    values: parameters::Values,
}

/// Flies a scenario.
///
/// # Errors
/// The scenario cannot fly, or nobody answers at the end of the link: nothing has been judged then. What fails later
/// stands in the outcome.
pub fn run(
    scenario: &Scenario,
    link: Box<dyn Link>,
    settings: Settings,
    recorder: Option<Recorder>,
    watch: &mut dyn Watch,
) -> Result<Outcome, StationError> {
    let pace = settings.pace;
    let platform = Platform::start(scenario).map_err(StationError::Refused)?;
    let mut board = Board::start(link, settings.patience)?;
    board.exchange.begin_comparison();
    if let Some(recorder) = recorder {
        board.record(recorder, &header(scenario, pace))?;
    }
    let (axis, settings) = scenario.axis(&scenario.model).map_err(StationError::Refused)?;
    let mut flight = Flight {
        judge: Judge::new(scenario, platform.ticks, axis.period_s),
        down: Faults::new(&scenario.link_faults, Way::Down, scenario.seed, axis.period_s),
        up: Faults::new(&scenario.link_faults, Way::Up, scenario.seed, axis.period_s),
        receiver: Receiver::default(),
        deadlines: Deadlines::default(),
        period_s: axis.period_s,
        done: 0,
        limit_refused: None,
        ignored: None,
    };
    let planned = platform.ticks;
    let mut elapsed_s = 0.0;
    let values = parameters::values(&axis, &settings);
    let mut found =
        Found { started: SystemTime::now(), builds: [BUILD, 0], models: [parameters::digest(&values), 0], values };
    let mut ended = prepare(&mut board, scenario, &mut found);
    if ended.is_ok() {
        let start = Instant::now();
        ended = flight.fly(scenario, &mut board, platform, pace, watch, &found);
        elapsed_s = start.elapsed().as_secs_f64();
        if ended.is_ok() {
            ended = board.faults().map(|faults| flight.ignored = Some(faults.ignored));
        }
    }
    Ok(flight.outcome(scenario, board, pace, &found, planned, elapsed_s, ended.err()))
}

/// What stands first in a record.
fn header(scenario: &Scenario, pace: Pace) -> serde_json::Value {
    json!({
        "schema": "gimbal-record/1",
        "scenario": scenario.name,
        "text": scenario.text,
        "pace": pace.name(),
        "protocol": gimbal_wire::VERSION,
        "version": env!("CARGO_PKG_VERSION"),
        "build": format!("{BUILD:016x}"),
    })
}

/// Power-on, model, run.
fn prepare(board: &mut Board, scenario: &Scenario, found: &mut Found) -> Result<(), StationError> {
    let identity = board.power_on()?;
    found.builds[1] = identity.build;
    let loaded = scenario.loaded.as_ref().unwrap_or(&scenario.model);
    let (axis, settings) = scenario.axis(loaded).map_err(StationError::Refused)?;
    found.values = parameters::values(&axis, &settings);
    found.models[1] = board.load(&found.values)?;
    board.run(scenario.watchdog_ticks)
}

/// What a run keeps from tick to tick.
struct Flight {
    judge: Judge,
    down: Faults,
    up: Faults,
    /// Behind the link faults.
    receiver: Receiver,
    deadlines: Deadlines,
    period_s: f64,
    done: u32,
    limit_refused: Option<bool>,
    ignored: Option<u32>,
}

impl Flight {
    fn fly(
        &mut self,
        scenario: &Scenario,
        board: &mut Board,
        platform: Platform,
        pace: Pace,
        watch: &mut dyn Watch,
        found: &Found,
    ) -> Result<(), StationError> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a day at 4 kHz fits")]
        let events: Vec<(u32, Action)> =
            scenario.events.iter().map(|event| ((event.at_s / self.period_s).round() as u32, event.action)).collect();
        let (planned, start) = (platform.ticks, Instant::now());
        for moment in platform {
            for (_, action) in events.iter().filter(|(at, _)| *at == moment.tick) {
                self.act(*action, board, scenario)?;
            }
            let due = start + Duration::from_secs_f64(f64::from(moment.tick) * self.period_s);
            if pace == Pace::RealTime {
                wait_until(due);
                self.deadlines.starts_s.push(due.elapsed().as_secs_f32());
            }
            let begun = Instant::now();
            let sensor = board.exchange.frame(Message::Sensor(moment.sensor)).to_vec();
            let (sent, estimate) = board.step(moment.tick, &self.down.pass(moment.tick, vec![sensor]))?;
            let latency_s = if pace == Pace::RealTime { due.elapsed() } else { begun.elapsed() }.as_secs_f32();
            self.deadlines.late += u32::from(pace == Pace::RealTime && f64::from(latency_s) > self.period_s);
            self.deadlines.latencies_s.push(latency_s);
            board.exchange.note(b'T', &truth(&moment))?;
            let came = self.come(moment.tick, &sent);
            let seen = self.judge.take(&moment, &sent, &came);
            self.done = moment.tick + 1;
            // A computer that has lost its model, as it says itself, is given it again.
            if estimate.mode == Mode::Empty {
                board.power_on()?;
                board.load(&found.values)?;
                board.run(scenario.watchdog_ticks)?;
            }
            let live = Live {
                moment: &moment,
                ticks: planned,
                estimate: seen.as_ref(),
                bits: self.judge.bits(),
                period_s: self.period_s,
            };
            if !watch.tick(&live) {
                return Err(StationError::Interrupted);
            }
        }
        Ok(())
    }

    fn act(&mut self, action: Action, board: &mut Board, scenario: &Scenario) -> Result<(), StationError> {
        match action {
            Action::ResetBoard => {
                board.command(Message::Reset(gimbal_wire::Reset { whole: true }))?;
            }
            Action::ResetState => {
                board.command(Message::Reset(gimbal_wire::Reset { whole: false }))?;
                board.run(scenario.watchdog_ticks)?;
            }
            Action::RaiseLimit => {
                let twice = 2 * limits::WATCHDOG_TICKS;
                board.command(Message::Stop)?;
                let ack = board.command(Message::Run(Begin { watchdog_ticks: twice }))?;
                self.limit_refused = Some(ack.outcome == Answer::AboveLimit);
                board.run(scenario.watchdog_ticks)?;
            }
        }
        Ok(())
    }

    /// What of the computer's frames comes through the link faults.
    fn come(&mut self, tick: u32, sent: &[Frame]) -> Vec<Frame> {
        let frames = sent.iter().map(|frame| frame.emit().to_vec()).collect();
        let bytes = self.up.pass(tick, frames).concat();
        bytes.into_iter().filter_map(|byte| self.receiver.push(byte)).collect()
    }
}

/// The truth of a tick, for the record.
fn truth(moment: &Moment) -> Vec<u8> {
    let (row, truth) = (&moment.row, &moment.truth);
    [
        row.accel_x_mps2,
        row.accel_y_mps2,
        row.accel_z_mps2,
        row.vehicle_rate_radps,
        truth.gimbal_angle_rad,
        truth.gyro_angle_rad,
        truth.motor_torque_nm,
        truth.velocity_error_mps[0],
        truth.velocity_error_mps[1],
    ]
    .into_iter()
    .flat_map(f64::to_le_bytes)
    .collect()
}
