//! One run: the scenario from its first tick to its last, to the computer at the end of a link.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use gimbal_computer::{BUILD, limits, parameters};
use gimbal_wire::{Estimate, Frame, Message, Mode, Outcome as Answer, Receiver, Run as Begin};
use serde_json::json;

use crate::fault::Faults;
use crate::judge::{Judge, Judged, judge};
use crate::link::Link;
use crate::platform::{Moment, Platform};
use crate::record::Recorder;
use crate::scenario::{Action, Scenario, Way};
use crate::station::{Board, StationError};

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

/// How a run came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every requirement is kept.
    Pass,
    /// One is not, or board and host differ.
    Fail,
    /// The run ended before its time.
    Aborted,
}

impl Verdict {
    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Aborted => "aborted",
        }
    }
}

/// Times from a tick's first byte down to its last byte up.
#[derive(Debug, Clone, Default)]
pub struct Deadlines {
    /// Sorted [s].
    pub latencies_s: Vec<f32>,
    /// Answers that came after the next tick was due.
    pub late: u32,
    /// How late ticks began, sorted; in real time only [s].
    pub starts_s: Vec<f32>,
}

impl Deadlines {
    /// A quantile of the latencies [s].
    #[must_use]
    pub fn latency_s(&self, share: f64) -> Option<f64> {
        quantile(&self.latencies_s, share)
    }

    /// A quantile of the delays of starts [s].
    #[must_use]
    pub fn start_s(&self, share: f64) -> Option<f64> {
        quantile(&self.starts_s, share)
    }
}

fn quantile(sorted: &[f32], share: f64) -> Option<f64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    let at = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(at.saturating_sub(1)).map(|value| f64::from(*value))
}

/// A run that is over.
#[derive(Debug)]
pub struct Outcome {
    /// The scenario.
    pub scenario: Scenario,
    /// How it came out.
    pub verdict: Verdict,
    /// What was required.
    pub requirements: Vec<Judged>,
    /// Everything measured.
    pub measures: BTreeMap<&'static str, f64>,
    /// Bits raised, and when first [s].
    pub bits: BTreeMap<&'static str, f64>,
    /// Whose clock.
    pub pace: Pace,
    /// What the link was.
    pub target: String,
    /// Ticks done, and planned.
    pub ticks: [u32; 2],
    /// Period [s].
    pub period_s: f64,
    /// Wall time of the ticks [s].
    pub elapsed_s: f64,
    /// Latencies.
    pub deadlines: Deadlines,
    /// Whether every byte was that of the host's flight code.
    pub host_equals_board: Option<bool>,
    /// Time of the first byte that differed [s].
    pub first_difference_s: Option<f64>,
    /// Digests of the flight code's source: the bench's and the board's.
    pub builds: [u64; 2],
    /// Digests of the model: the scenario's and the one that is loaded.
    pub models: [u64; 2],
    /// Digest of everything that came up.
    pub digest: u64,
    /// What the bench has counted: frames accepted, refused, lost; bytes down, up; ticks asked again.
    pub link: LinkStatistics,
    /// Why it ended before its time.
    pub error: Option<StationError>,
}

/// Both sides' counts.
#[derive(Debug, Clone, Copy, Default)]
pub struct LinkStatistics {
    /// Bytes down and up.
    pub bytes: [u64; 2],
    /// Frames that the bench has accepted behind the link faults.
    pub accepted: u32,
    /// Frames that the bench has refused there.
    pub refused: u32,
    /// Sequence numbers that it has missed there.
    pub lost: u32,
    /// Ticks asked again.
    pub asked_again: u32,
}

/// What was found out about the computer before the first tick.
struct Found {
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
    pace: Pace,
    recorder: Option<Recorder>,
    watch: &mut dyn Watch,
) -> Result<Outcome, StationError> {
    let platform = Platform::start(scenario).map_err(StationError::Refused)?;
    let mut board = Board::start(link)?;
    board.begin_comparison();
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
    let mut found = Found { builds: [BUILD, 0], models: [parameters::digest(&values), 0], values };
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
            let sensor = board.frame(Message::Sensor(moment.sensor)).to_vec();
            let (sent, estimate) = board.step(moment.tick, &self.down.pass(moment.tick, vec![sensor]))?;
            let latency_s = if pace == Pace::RealTime { due.elapsed() } else { begun.elapsed() }.as_secs_f32();
            self.deadlines.late += u32::from(pace == Pace::RealTime && f64::from(latency_s) > self.period_s);
            self.deadlines.latencies_s.push(latency_s);
            board.note(b'T', &truth(&moment))?;
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

    #[allow(clippy::too_many_arguments, reason = "everything that a report holds")]
    fn outcome(
        mut self,
        scenario: &Scenario,
        mut board: Board,
        pace: Pace,
        found: &Found,
        planned: u32,
        elapsed_s: f64,
        mut error: Option<StationError>,
    ) -> Outcome {
        self.deadlines.latencies_s.sort_by(f32::total_cmp);
        self.deadlines.starts_s.sort_by(f32::total_cmp);
        let (equal, difference) = board.equals_twin();
        let host_equals_board = (self.done > 0).then_some(equal || (error.is_some() && difference.is_none()));
        let truth = |value: bool| f64::from(u8::from(value));
        let mut measures = self.judge.measures();
        let counts = *self.receiver.counts();
        measures.insert("bench_refused_frames", f64::from(counts.refused()));
        measures.insert("model_matches", truth(found.models[0] == found.models[1]));
        measures.insert("build_matches", truth(found.builds[0] == found.builds[1]));
        measures.insert("asked_again", f64::from(board.asked_again()));
        if let Some(equal) = host_equals_board {
            measures.insert("host_equals_board", truth(equal));
        }
        if let Some(refused) = self.limit_refused {
            measures.insert("limit_refused", truth(refused));
        }
        if let Some(ignored) = self.ignored {
            measures.insert("board_ignored_frames", f64::from(ignored));
        }
        if pace == Pace::RealTime {
            measures.insert("late_frames", f64::from(self.deadlines.late));
        }
        let bits = self.judge.bits().clone();
        let requirements = judge(&scenario.requirements, &measures, &bits);
        let kept = requirements.iter().all(|judged| judged.passed) && host_equals_board != Some(false);
        let verdict = |aborted: bool| match (aborted, kept) {
            (true, _) => Verdict::Aborted,
            (false, true) => Verdict::Pass,
            (false, false) => Verdict::Fail,
        };
        if error.is_none() {
            let end = json!({ "verdict": verdict(false).name(), "ticks": self.done, "digest": format!("{:016x}", board.digest()) });
            error = board.note(b'E', end.to_string().as_bytes()).err();
        }
        if let Err(failed) = board.close_record() {
            error.get_or_insert(failed);
        }
        Outcome {
            verdict: verdict(error.is_some()),
            requirements,
            measures,
            bits,
            pace,
            target: board.describe(),
            ticks: [self.done, planned],
            period_s: self.period_s,
            elapsed_s,
            host_equals_board,
            first_difference_s: difference.map(|tick| f64::from(tick) * self.period_s),
            builds: found.builds,
            models: found.models,
            digest: board.digest(),
            link: LinkStatistics {
                bytes: board.bytes(),
                accepted: counts.accepted,
                refused: counts.refused(),
                lost: counts.lost,
                asked_again: board.asked_again(),
            },
            deadlines: self.deadlines,
            scenario: scenario.clone(),
            error,
        }
    }
}

/// Sleeps for most of the time, and turns for the rest: a sleep may end a fraction of a millisecond late.
fn wait_until(due: Instant) {
    const CLOSE: Duration = Duration::from_micros(200);
    let left = due.saturating_duration_since(Instant::now());
    if left > CLOSE {
        std::thread::sleep(left.saturating_sub(CLOSE));
    }
    while Instant::now() < due {
        std::hint::spin_loop();
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
