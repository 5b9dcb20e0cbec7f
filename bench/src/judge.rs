//! Measures of a run, and what the scenario requires of them.

use std::collections::BTreeMap;

use gimbal_servo::{Faults, estimator::Flags};
use gimbal_wire::{Computer, Estimate, Frame, Message, Mode, Telemetry};

use crate::platform::Moment;
use crate::scenario::{Requirement, Scenario};

/// Every measure, as scenarios and reports name them.
pub const MEASURES: [&str; 29] = [
    "attitude_error_rms_rad",
    "attitude_error_peak_rad",
    "attitude_error_end_rad",
    "attitude_rms_rad",
    "attitude_peak_rad",
    "bound_coverage_2sigma",
    "velocity_error_before_mps",
    "velocity_error_after_mps",
    "position_error_before_m",
    "position_error_after_m",
    "running_ticks",
    "safe_ticks",
    "empty_ticks",
    "missing_estimates",
    "longest_gap_ticks",
    "recovery_ticks",
    "wrong_frames",
    "board_refused_frames",
    "board_lost_frames",
    "board_held_ticks",
    "board_stale_frames",
    "board_ignored_frames",
    "bench_refused_frames",
    "limit_refused",
    "model_matches",
    "build_matches",
    "host_equals_board",
    "late_frames",
    "asked_again",
];

/// Names of the bits that can be raised.
#[must_use]
pub fn bit_names() -> Vec<&'static str> {
    let flags = Flags::NAMES.iter().map(|(_, name)| *name);
    let faults = Faults::NAMES.iter().map(|(_, name)| *name);
    flags.chain(faults).chain(Computer::NAMES.iter().map(|(_, name)| *name)).chain(["safe"]).collect()
}

/// A requirement and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The measure, or `raised BIT`, `never BIT`.
    pub name: String,
    /// The limit in words.
    pub limit: String,
    /// What was measured; a bit's first time; `None`: nothing.
    pub value: Option<f64>,
    /// Whether it is kept.
    pub passed: bool,
}

/// Adds up a run.
#[derive(Debug)]
pub(crate) struct Judge {
    period_s: f64,
    /// First tick that is scored: the state before the first row is unknown.
    scored_from: u32,
    /// Tick from which on the link or the computer is to recover.
    recovers_from: Option<u32>,
    recovered: Option<u32>,
    count: f64,
    error_square: f64,
    error_peak: f64,
    error_end: f64,
    square: f64,
    peak: f64,
    within: f64,
    modes: [u32; 4],
    missing: u32,
    gap: u32,
    longest_gap: u32,
    wrong: u32,
    velocity: Option<[f64; 2]>,
    position: Option<[f64; 2]>,
    /// Frames as the computer has sent them, by the sequence number's low bits.
    sent: Vec<Option<Frame>>,
    bits: BTreeMap<&'static str, f64>,
    pub(crate) telemetry: Option<Telemetry>,
}

/// How many frames back a delayed one is still known.
const KNOWN: usize = 4096;

impl Judge {
    pub(crate) fn new(scenario: &Scenario, ticks: u32, period_s: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a day at 4 kHz fits")]
        let tick = |time_s: f64| (time_s / period_s).round() as u32;
        let ends = scenario.link_faults.iter().map(|fault| tick(fault.to_s));
        let resets = scenario.events.iter().map(|event| tick(event.at_s));
        Self {
            period_s,
            scored_from: if ticks > 2 * tick(1.0) { tick(1.0) } else { 0 },
            recovers_from: ends.chain(resets).filter(|at| *at < ticks).max(),
            recovered: None,
            count: 0.0,
            error_square: 0.0,
            error_peak: 0.0,
            error_end: 0.0,
            square: 0.0,
            peak: 0.0,
            within: 0.0,
            modes: [0; 4],
            missing: 0,
            gap: 0,
            longest_gap: 0,
            wrong: 0,
            velocity: None,
            position: None,
            sent: vec![None; KNOWN],
            bits: BTreeMap::new(),
            telemetry: None,
        }
    }

    /// Takes a tick: what the computer has sent, and what has come through; the estimate of this tick, if it has.
    pub(crate) fn take(&mut self, moment: &Moment, sent: &[Frame], came: &[Frame]) -> Option<Estimate> {
        for frame in sent {
            self.sent[usize::from(frame.sequence) % KNOWN] = Some(*frame);
        }
        let mut estimate = None;
        for frame in came {
            let known = self.sent[usize::from(frame.sequence) % KNOWN];
            // By their bytes: a value that is not a number equals nothing.
            if known.is_none_or(|known| known.emit() != frame.emit()) {
                self.wrong += 1;
                continue;
            }
            match frame.message {
                Message::Estimate(message) if frame.tick == moment.tick => estimate = Some(message),
                Message::Telemetry(telemetry) => self.take_telemetry(moment, frame.tick, &telemetry),
                _ => {}
            }
        }
        if let Some(estimate) = &estimate {
            self.score(moment, estimate);
        } else {
            self.missing += 1;
            self.gap += 1;
            self.longest_gap = self.longest_gap.max(self.gap);
        }
        estimate
    }

    fn score(&mut self, moment: &Moment, estimate: &Estimate) {
        self.gap = 0;
        self.modes[estimate.mode as usize] += 1;
        let time_s = f64::from(moment.tick) * self.period_s;
        for (flag, name) in Flags::NAMES {
            self.raise(estimate.flags & flag.bits() != 0, name, time_s);
        }
        for (fault, name) in Faults::NAMES {
            self.raise(estimate.faults & fault.bits() != 0, name, time_s);
        }
        self.raise(estimate.mode == Mode::Safe, "safe", time_s);
        if estimate.mode != Mode::Running {
            return;
        }
        if self.recovered.is_none() && estimate.age <= 1 && self.recovers_from.is_some_and(|from| moment.tick >= from) {
            self.recovered = Some(moment.tick);
        }
        if moment.tick < self.scored_from {
            return;
        }
        let truth = moment.truth.gimbal_angle_rad;
        let error = f64::from(estimate.gimbal_angle_rad) - truth;
        self.count += 1.0;
        self.error_square += error * error;
        self.error_peak = self.error_peak.max(error.abs());
        self.error_end = error.abs();
        self.square += truth * truth;
        self.peak = self.peak.max(truth.abs());
        self.within += f64::from(u8::from(error.abs() <= 2.0 * f64::from(estimate.bound_rad)));
    }

    fn take_telemetry(&mut self, moment: &Moment, tick: u32, telemetry: &Telemetry) {
        let time_s = f64::from(moment.tick) * self.period_s;
        for (bit, name) in Computer::NAMES {
            self.raise(telemetry.computer.contains(bit), name, time_s);
        }
        self.telemetry = Some(*telemetry);
        // One that was delayed belongs to a truth that has gone by.
        if tick == moment.tick {
            let error = |truth: [f64; 2], correction: [f32; 2]| {
                let before = truth[0].hypot(truth[1]);
                let after = (truth[0] + f64::from(correction[0])).hypot(truth[1] + f64::from(correction[1]));
                [before, after]
            };
            self.velocity = Some(error(moment.truth.velocity_error_mps, telemetry.velocity_correction_mps));
            self.position = Some(error(moment.truth.position_error_m, telemetry.position_correction_m));
        }
    }

    fn raise(&mut self, raised: bool, name: &'static str, time_s: f64) {
        if raised {
            self.bits.entry(name).or_insert(time_s);
        }
    }

    /// Bits that have been raised, and when first [s].
    pub(crate) fn bits(&self) -> &BTreeMap<&'static str, f64> {
        &self.bits
    }

    /// The measures so far; a measure that has no value is left out.
    pub(crate) fn measures(&self) -> BTreeMap<&'static str, f64> {
        let mut measures = BTreeMap::new();
        if self.count > 0.0 {
            measures.insert("attitude_error_rms_rad", (self.error_square / self.count).sqrt());
            measures.insert("attitude_error_peak_rad", self.error_peak);
            measures.insert("attitude_error_end_rad", self.error_end);
            measures.insert("attitude_rms_rad", (self.square / self.count).sqrt());
            measures.insert("attitude_peak_rad", self.peak);
            measures.insert("bound_coverage_2sigma", self.within / self.count);
        }
        if let (Some([v_before, v_after]), Some([p_before, p_after])) = (self.velocity, self.position) {
            measures.insert("velocity_error_before_mps", v_before);
            measures.insert("velocity_error_after_mps", v_after);
            measures.insert("position_error_before_m", p_before);
            measures.insert("position_error_after_m", p_after);
        }
        let [empty, ready, running, safe] = self.modes.map(f64::from);
        measures.insert("running_ticks", running);
        measures.insert("safe_ticks", safe);
        measures.insert("empty_ticks", empty + ready);
        measures.insert("missing_estimates", f64::from(self.missing));
        measures.insert("longest_gap_ticks", f64::from(self.longest_gap));
        measures.insert("wrong_frames", f64::from(self.wrong));
        if let (Some(from), Some(at)) = (self.recovers_from, self.recovered) {
            measures.insert("recovery_ticks", f64::from(at - from));
        }
        if let Some(telemetry) = &self.telemetry {
            let refused = u32::from(telemetry.checksum) + u32::from(telemetry.structure);
            measures.insert("board_refused_frames", f64::from(refused));
            measures.insert("board_lost_frames", f64::from(telemetry.lost));
            measures.insert("board_held_ticks", f64::from(telemetry.held));
            measures.insert("board_stale_frames", f64::from(telemetry.stale));
        }
        measures
    }
}

/// Holds measures and bits against the requirements.
pub(crate) fn judge(
    requirements: &[Requirement],
    measures: &BTreeMap<&'static str, f64>,
    bits: &BTreeMap<&'static str, f64>,
) -> Vec<Judged> {
    requirements.iter().map(|requirement| judged(requirement, measures, bits)).collect()
}

fn judged(
    requirement: &Requirement,
    measures: &BTreeMap<&'static str, f64>,
    bits: &BTreeMap<&'static str, f64>,
) -> Judged {
    if let Some(bit) = &requirement.raised {
        let at_s = bits.get(bit.as_str()).copied();
        let limit = requirement.by_s.map_or_else(|| "raised".to_owned(), |by_s| format!("by {by_s} s"));
        let passed = at_s.is_some_and(|at_s| requirement.by_s.is_none_or(|by_s| at_s <= by_s));
        return Judged { name: format!("raised {bit}"), limit, value: at_s, passed };
    }
    if let Some(bit) = &requirement.never {
        let at_s = bits.get(bit.as_str()).copied();
        return Judged { name: format!("never {bit}"), limit: "never".to_owned(), value: at_s, passed: at_s.is_none() };
    }
    let name = requirement.measure.clone().unwrap_or_default();
    let value = measures.get(name.as_str()).copied();
    let within = |value: f64| {
        requirement.most.is_none_or(|most| value <= most) && requirement.least.is_none_or(|least| value >= least)
    };
    let limit = match (requirement.least, requirement.most) {
        (Some(least), Some(most)) => format!("{} to {}", limit_text(least), limit_text(most)),
        (Some(least), None) => format!(">= {}", limit_text(least)),
        (None, Some(most)) => format!("<= {}", limit_text(most)),
        (None, None) => String::new(),
    };
    Judged { name, limit, value, passed: value.is_some_and(within) }
}

/// A limit as people write it: 5e-6, 0.9, 300.
fn limit_text(limit: f64) -> String {
    if limit.abs() < 1e-3 && limit.abs() > 0.0 { format!("{limit:e}") } else { format!("{limit}") }
}
