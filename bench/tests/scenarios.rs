//! Every shipped scenario on the flight code in process: passes, repeats itself, replays.

use std::path::Path;

use gimbal_bench::link::{Host, Link, LinkError};
use gimbal_bench::record::{Record, Recorder};
use gimbal_bench::replay::replay;
use gimbal_bench::report;
use gimbal_bench::run::{Live, Outcome, Pace, Settings, Verdict, Watch, run};
use gimbal_bench::scenario::{SHIPPED, Scenario};
use gimbal_bench::{Board, Patience};

/// Watches to the end, or to a tick.
struct Until(u32);

impl Watch for Until {
    fn tick(&mut self, live: &Live) -> bool {
        live.moment.tick < self.0
    }
}

fn fly(scenario: &Scenario, link: Box<dyn Link>, record: Option<&Path>, until: u32) -> Outcome {
    let recorder = record.map(|path| Recorder::create(path).expect("made"));
    run(scenario, link, Settings { pace: Pace::Lockstep, patience: Patience::default() }, recorder, &mut Until(until))
        .expect("flies")
}

#[test]
fn contract_every_shipped_scenario_passes() {
    assert!(SHIPPED.len() >= 10);
    for shipped in SHIPPED {
        let scenario = Scenario::open(shipped.name).expect("reads");
        let outcome = fly(&scenario, Box::new(Host::new()), None, u32::MAX);
        assert_eq!(outcome.verdict, Verdict::Pass, "{}", report::text(&outcome));
        assert!(!outcome.requirements.is_empty(), "{}", shipped.name);
        assert_eq!(outcome.host_equals_board, Some(true));
    }
}

#[test]
fn contract_a_seed_gives_the_same_record_and_the_record_the_same_answers() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, second] = ["first.rec", "second.rec"].map(|name| folder.path().join(name));
    let mut scenario = Scenario::open("link-noise").expect("reads");
    let outcome = fly(&scenario, Box::new(Host::new()), Some(&first), u32::MAX);
    assert_eq!(outcome.verdict, Verdict::Pass);
    fly(&scenario, Box::new(Host::new()), Some(&second), u32::MAX);
    let bytes = std::fs::read(&first).expect("read");
    assert!(bytes == std::fs::read(&second).expect("read"));
    scenario.seed += 1;
    fly(&scenario, Box::new(Host::new()), Some(&second), u32::MAX);
    assert!(bytes != std::fs::read(&second).expect("read"));

    let record = Record::open(&first).expect("a record");
    assert_eq!(record.cut, None);
    let mut board = Board::start(Box::new(Host::new()), Patience::default()).expect("answers");
    let replayed = replay(&mut board, &record, |_| false).expect("replays");
    assert_eq!((replayed.difference, replayed.bytes), (None, outcome.link.bytes[1]));
}

/// A link that fails after some exchanges.
struct Failing(Host, u32);

impl Link for Failing {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.1 -= 1;
        if self.1 == 0 { Err(LinkError::new("the cable is cut", "mend it")) } else { self.0.send(bytes) }
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: std::time::Duration) -> Result<(), LinkError> {
        self.0.receive(bytes, wait)
    }

    fn describe(&self) -> String {
        "a bad cable".to_owned()
    }
}

#[test]
fn contract_a_run_that_breaks_off_is_reported_as_far_as_it_went() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.rec");
    let scenario = Scenario::open("rocket").expect("reads");
    let outcome = fly(&scenario, Box::new(Failing(Host::new(), 1_000)), Some(&path), u32::MAX);
    assert_eq!(outcome.verdict, Verdict::Aborted);
    assert!(outcome.error.as_ref().is_some_and(|error| error.to_string().contains("the cable is cut; mend it")));
    assert!((900..1_000).contains(&outcome.ticks[0]));
    let json = report::json(&outcome);
    assert_eq!((&json["verdict"], &json["schema"]), (&"aborted".into(), &"gimbal-hil/1".into()));
    assert!(report::junit(&[outcome]).contains("<error message=\"the cable is cut; mend it\"/>"));
    let record = Record::open(&path).expect("a record");
    assert!(record.cut.is_some());
    let mut board = Board::start(Box::new(Host::new()), Patience::default()).expect("answers");
    assert_eq!(replay(&mut board, &record, |_| false).expect("replays").difference, None);
    let stopped = fly(&scenario, Box::new(Host::new()), None, 200);
    assert_eq!((stopped.verdict, stopped.ticks[0]), (Verdict::Aborted, 201));
}
