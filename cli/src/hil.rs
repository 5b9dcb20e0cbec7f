//! `gimbal hil`: a flight computer in the loop with the simulated platform, judged by scenarios.

mod live;
mod page;
mod place;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};
use gimbal_bench::record::{Record, Recorder};
use gimbal_bench::replay::replay;
use gimbal_bench::report as told;
use gimbal_bench::run::{Outcome, Pace, Settings, Verdict, run};
use gimbal_bench::scenario::{SHIPPED, Scenario};
use gimbal_bench::{Board, StationError};
use gimbal_log::AtomicFile;
use serde_json::{Value, json};

use crate::exit::Failure;
use crate::{interrupt, report};
use live::Live;
use place::Place;

/// A flight computer in the loop: emulated unless another is named.
#[derive(Debug, Parser)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    fly: Fly,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs a record again and compares byte for byte.
    Replay(Again),
    /// Names the shipped scenarios.
    List,
}

#[derive(Debug, Parser)]
struct Fly {
    /// Scenario: a shipped one (`gimbal hil list`), a file, or `all` shipped ones
    #[arg(default_value = "paper-friction")]
    scenario: String,
    #[command(flatten)]
    place: Place,
    /// One tick a period by the wall clock, instead of as fast as the link allows
    #[arg(long)]
    realtime: bool,
    /// Another duration than the scenario's [s]
    #[arg(long, value_name = "S")]
    duration_s: Option<f64>,
    /// Another seed than the scenario's
    #[arg(long)]
    seed: Option<u64>,
    /// Record everything both ways; with `all`, a folder
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Folder for hil.json, hil.html and junit.xml; with `all`, a folder in it for each
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the report as JSON; with `all`, a list
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Parser)]
struct Again {
    /// Record
    record: PathBuf,
    #[command(flatten)]
    place: Place,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Does what the command line says.
pub(crate) fn hil(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Some(Command::Replay(again)) => run_again(again),
        Some(Command::List) => list(),
        None => fly(&args.fly),
    }
}

fn list() -> Result<(), Failure> {
    let mut lines = Vec::new();
    for shipped in SHIPPED {
        let scenario = Scenario::open(shipped.name).map_err(|error| Failure::input(error.to_string()))?;
        lines.push(format!("{:<16} {:>4} s  {}", shipped.name, scenario.duration_s, scenario.about));
    }
    report::print(&lines.join("\n"), None)
}

fn fly(options: &Fly) -> Result<(), Failure> {
    let all = options.scenario == "all";
    let names: Vec<&str> =
        if all { SHIPPED.iter().map(|shipped| shipped.name).collect() } else { vec![&options.scenario] };
    let mut scenarios = Vec::new();
    for name in names {
        scenarios.push(scenario(name, options)?);
    }
    let pace = if options.realtime { Pace::RealTime } else { Pace::Lockstep };
    if options.realtime {
        options.place.refuse_slow(1e-3)?;
    }
    let settings = Settings { pace, patience: options.place.patience() };
    let place = options.place.ready()?;
    let mut outcomes = Vec::new();
    for scenario in &scenarios {
        let recorder = recorder(options, all, &scenario.name)?;
        let mut live = Live::new(scenario);
        let link = place.link()?;
        let mut outcome = run(scenario, link, settings, recorder, &mut live).map_err(failure)?;
        live.finish();
        if interrupt::raised() && outcome.error.is_none() {
            outcome.error = Some(StationError::Interrupted);
        }
        let written = options.out.as_deref().map_or(Ok(()), |out| {
            let folder = if all { out.join(&scenario.name) } else { out.to_owned() };
            fs::create_dir_all(&folder).map_err(Failure::write(&folder))?;
            write(&folder.join("hil.json"), &format!("{:#}\n", told::json(&outcome)))?;
            write(&folder.join("hil.html"), &page::html(&outcome, &live)?)
        });
        let aborted = outcome.error.is_some();
        outcomes.push(outcome);
        if aborted || written.is_err() {
            let told = finish(options, &outcomes);
            written?;
            told?;
            break;
        }
        if !options.json && all {
            println!("{}\n", told::text(&outcomes[outcomes.len() - 1]));
        }
    }
    if outcomes.iter().all(|outcome| outcome.error.is_none()) {
        finish(options, &outcomes)?;
    }
    let missed: Vec<String> =
        outcomes.iter().filter(|o| o.verdict == Verdict::Fail).map(|o| o.scenario.name.clone()).collect();
    match outcomes.into_iter().find_map(|outcome| outcome.error) {
        Some(error) => Err(failure(error)),
        None if missed.is_empty() => Ok(()),
        None => Err(Failure::Fails(format!("failed: {}", missed.join(", ")))),
    }
}

/// Prints all reports, and writes the one for CI.
fn finish(options: &Fly, outcomes: &[Outcome]) -> Result<(), Failure> {
    if let Some(out) = &options.out {
        fs::create_dir_all(out).map_err(Failure::write(out))?;
        write(&out.join("junit.xml"), &told::junit(outcomes))?;
    }
    let mut reports: Vec<Value> = outcomes.iter().map(told::json).collect();
    let json = if reports.len() == 1 { reports.remove(0) } else { Value::Array(reports) };
    let text = if outcomes.len() == 1 {
        told::text(&outcomes[0])
    } else {
        let passed = outcomes.iter().filter(|outcome| outcome.verdict == Verdict::Pass).count();
        format!("{passed} of {} scenarios pass", outcomes.len())
    };
    report::print(&text, options.json.then_some(&json))
}

fn scenario(name: &str, options: &Fly) -> Result<Scenario, Failure> {
    let mut scenario = Scenario::open(name).map_err(|error| Failure::input(error.to_string()))?;
    if let Some(duration_s) = options.duration_s {
        if !(0.1..=86_400.0).contains(&duration_s) {
            return Err(Failure::input(format!("--duration-s is {duration_s}; it must lie between 0.1 and 86400")));
        }
        scenario.duration_s = duration_s;
    }
    if let Some(seed) = options.seed {
        scenario.seed = seed;
    }
    Ok(scenario)
}

fn recorder(options: &Fly, all: bool, name: &str) -> Result<Option<Recorder>, Failure> {
    let Some(path) = &options.record else { return Ok(None) };
    let path = if all {
        fs::create_dir_all(path).map_err(Failure::write(path))?;
        path.join(format!("{name}.rec"))
    } else {
        path.clone()
    };
    Recorder::create(&path).map(Some).map_err(Failure::write(&path))
}

fn failure(error: StationError) -> Failure {
    match error {
        StationError::Interrupted => Failure::Interrupted,
        _ if interrupt::raised() => Failure::Interrupted,
        StationError::Refused(_) => Failure::Input(error.into()),
        StationError::Link(_) | StationError::Record(_) => Failure::Environment(error.into()),
    }
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let mut file = AtomicFile::create(path).map_err(Failure::write(path))?;
    file.write_all(text.as_bytes()).map_err(Failure::write(path))?;
    file.commit().map_err(Failure::write(path))
}

fn run_again(options: &Again) -> Result<(), Failure> {
    let record = Record::open(&options.record).map_err(Failure::input)?;
    if let Some(cut) = &record.cut {
        eprintln!("note: {cut}");
    }
    let link = options.place.ready()?.link()?;
    let mut board = Board::start(link, options.place.patience()).map_err(failure)?;
    let replayed = replay(&mut board, &record, |_| interrupt::raised()).map_err(failure)?;
    let scenario =
        record.header().and_then(|header| header["scenario"].as_str().map(str::to_owned)).unwrap_or_default();
    let same = replayed.difference.is_none();
    let difference = replayed.difference.map(|(tick, byte)| json!({ "tick": tick, "byte": byte }));
    let result = json!({
        "record": options.record.display().to_string(),
        "scenario": scenario,
        "complete": record.cut.is_none(),
        "target": board.describe(),
        "exchanges": replayed.exchanges,
        "bytes": replayed.bytes,
        "identical": same,
        "difference": difference,
    });
    let what = match replayed.difference {
        None => "identical, byte for byte".to_owned(),
        Some((tick, byte)) => format!("DIFFERS at tick {tick}, byte {byte} of the answer"),
    };
    let text = format!(
        "{scenario}: {} exchanges, {} bytes up: {what}\n{}",
        replayed.exchanges,
        replayed.bytes,
        board.describe()
    );
    report::print(&text, options.json.then_some(&result))?;
    if same { Ok(()) } else { Err(Failure::Fails(what)) }
}
