//! The bench's side: a scenario flown over a line that drops, changes, adds and cuts bytes on the way up. The run ends,
//! a changed answer never counts as the host's, and every report can be written.

#![no_main]

use std::sync::LazyLock;
use std::time::Duration;

use gimbal_bench::link::{Host, Link, LinkError};
use gimbal_bench::report;
use gimbal_bench::run::{Live, Pace, Settings, Verdict, Watch, run};
use gimbal_bench::scenario::Scenario;
use gimbal_bench::{Patience, StationError};
use gimbal_wire::FRAME_LEN;
use libfuzzer_sys::fuzz_target;

const TEXT: &str = "about = \"Rest.\"\nduration_s = 0.1\nprofile = { kind = \"rest\" }\n\
                    [[require]]\nmeasure = \"missing_estimates\"\nmost = 0\n";

static SCENARIO: LazyLock<Scenario> = LazyLock::new(|| Scenario::parse(TEXT, "rest", None).expect("a scenario"));

/// Before the comparison begins, the answer and one frame go up; what is changed in them is not judged [bytes].
const JUDGED: usize = 2 * FRAME_LEN;
/// How a line describes itself that has changed a byte which is judged.
const SEEN: &str = ", as has been seen";

/// The flight code behind a bad line.
struct Bad {
    host: Host,
    script: std::vec::IntoIter<u8>,
    /// Bytes that pass before the next change.
    gap: u32,
    sent: Vec<u8>,
    passed: Vec<u8>,
}

impl Bad {
    fn new(script: &[u8]) -> Self {
        let mut bad = Self {
            host: Host::new(),
            script: script.to_vec().into_iter(),
            gap: 0,
            sent: Vec::new(),
            passed: Vec::new(),
        };
        bad.gap = bad.next_gap();
        bad
    }

    /// Two bytes; without any more, no further change.
    fn next_gap(&mut self) -> u32 {
        match (self.script.next(), self.script.next()) {
            (Some(low), Some(high)) => u32::from(low) + 32 * u32::from(high),
            _ => u32::MAX,
        }
    }

    /// Appends what is left of a byte; `None`: the line is cut.
    fn pass(&mut self, byte: u8) -> Option<()> {
        self.sent.push(byte);
        if self.gap > 0 {
            self.gap -= u32::from(self.gap < u32::MAX);
            self.passed.push(byte);
            return Some(());
        }
        let (kind, value) = (self.script.next().unwrap_or(2), self.script.next().unwrap_or_default());
        match kind % 8 {
            0 => return None,
            1 | 2 => {}
            3 | 4 => self.passed.push(byte ^ value),
            5 => self.passed.extend([value, byte]),
            _ => self.passed.extend([byte, byte]),
        }
        self.gap = self.next_gap();
        Some(())
    }

    /// Whether a byte beyond the first `judged` differs from what was sent: changes that undo each other are none.
    fn changed_after(&self, judged: usize) -> bool {
        let same = self.sent.iter().zip(&self.passed).take_while(|(sent, passed)| sent == passed).count();
        same >= judged && same < self.sent.len().max(self.passed.len())
    }
}

impl Link for Bad {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.host.send(bytes)
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError> {
        let mut came = Vec::new();
        self.host.receive(&mut came, wait)?;
        let before = self.passed.len();
        let all = came.into_iter().try_for_each(|byte| self.pass(byte));
        bytes.extend_from_slice(&self.passed[before..]);
        all.ok_or_else(|| LinkError::new("the line is cut", "mend it"))
    }

    fn describe(&self) -> String {
        format!("a bad line{}", if self.changed_after(JUDGED) { SEEN } else { "" })
    }
}

struct ToTheEnd;

impl Watch for ToTheEnd {
    fn tick(&mut self, _: &Live) -> bool {
        true
    }
}

fuzz_target!(|bytes: &[u8]| {
    // No patience: what does not come at once never comes.
    let patience = Patience { answer: Duration::ZERO, ..Patience::default() };
    let settings = Settings { pace: Pace::Lockstep, patience };
    match run(&SCENARIO, Box::new(Bad::new(bytes)), settings, None, &mut ToTheEnd) {
        Ok(outcome) => {
            let changed = outcome.target.ends_with(SEEN);
            assert!(
                !(changed && outcome.verdict == Verdict::Pass),
                "a changed answer passes: {}",
                report::text(&outcome)
            );
            assert_eq!(report::json(&outcome)["verdict"], outcome.verdict.name());
            assert!(report::junit(&[outcome]).ends_with("</testsuites>\n"));
        }
        Err(StationError::Link(_) | StationError::Refused(_)) => {}
        Err(error) => panic!("{error}"),
    }
});
