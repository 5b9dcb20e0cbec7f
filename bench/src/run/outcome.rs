//! A run that is over: verdict, measures, digests.

use std::collections::BTreeMap;
use std::time::SystemTime;

use gimbal_servo::Digest;
use serde_json::json;

use super::{Deadlines, Flight, Found, Pace};
use crate::judge::{Judged, judge};
use crate::scenario::Scenario;
use crate::station::{Board, StationError};

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
    /// Digest of the board's program, where it is known.
    pub image: Option<u64>,
    /// Digest of the scenario's text.
    pub text: u64,
    /// When it began.
    pub started: SystemTime,
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

impl Flight {
    #[allow(clippy::too_many_arguments, reason = "everything that a report holds")]
    pub(super) fn outcome(
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
        let (equal, difference) = board.exchange.equals_twin();
        let host_equals_board = (self.done > 0).then_some(equal || (error.is_some() && difference.is_none()));
        let truth = |value: bool| f64::from(u8::from(value));
        let mut measures = self.judge.measures();
        let counts = *self.receiver.counts();
        measures.insert("bench_refused_frames", f64::from(counts.refused()));
        measures.insert("model_matches", truth(found.models[0] == found.models[1]));
        measures.insert("build_matches", truth(found.builds[0] == found.builds[1]));
        measures.insert("asked_again", f64::from(board.exchange.asked_again()));
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
            let end = json!({ "verdict": verdict(false).name(), "ticks": self.done, "digest": format!("{:016x}", board.exchange.digest()) });
            error = board.exchange.note(b'E', end.to_string().as_bytes()).err();
        }
        if let Err(failed) = board.exchange.close_record() {
            error.get_or_insert(failed);
        }
        let mut text = Digest::default();
        text.add(scenario.text.as_bytes());
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
            image: board.exchange.image(),
            text: text.value(),
            started: found.started,
            digest: board.exchange.digest(),
            link: LinkStatistics {
                bytes: board.exchange.bytes(),
                accepted: counts.accepted,
                refused: counts.refused(),
                lost: counts.lost,
                asked_again: board.exchange.asked_again(),
            },
            deadlines: self.deadlines,
            scenario: scenario.clone(),
            error,
        }
    }
}
