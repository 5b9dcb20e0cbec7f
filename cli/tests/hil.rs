//! `gimbal hil` and `gimbal doctor`: passes, fails, wrong calls. How a run can break is in `hil_broken.rs`.

#![cfg(unix)]

mod program;
mod served;

use std::io::Write;
use std::time::{Duration, Instant};

use gimbal_bench::record::Record;
use gimbal_bench::scenario::SHIPPED;
use program::Bench;
use served::{Ends, serve};

/// Ten seconds that pass.
const SHORT: &str = "about = \"Rest.\"\nduration_s = 2\nprofile = { kind = \"rest\" }\n\
                     [[require]]\nmeasure = \"attitude_error_rms_rad\"\nmost = 1e-4\n";

#[test]
fn contract_every_shipped_scenario_passes_and_replays() {
    let bench = Bench::new();
    let reports = bench.json(&["hil", "all", "--target", "host", "--json", "--out", "out", "--record", "records"]);
    let reports = reports.as_array().expect("a list");
    assert!(SHIPPED.len() >= 10 && reports.len() == SHIPPED.len());
    for (report, shipped) in reports.iter().zip(SHIPPED) {
        assert_eq!((&report["scenario"], &report["verdict"]), (&shipped.name.into(), &"pass".into()), "{report:#}");
        assert_eq!(report["host_equals_board"], true);
        assert!(!report["requirements"].as_array().expect("a list").is_empty(), "{}", shipped.name);
        assert!(bench.read(&format!("out/{}/hil.html", shipped.name)).contains("<svg"));
    }
    let junit = bench.read("out/junit.xml");
    assert_eq!(junit.matches("<testsuite ").count(), SHIPPED.len());
    assert!(!junit.contains("<failure") && !junit.contains("<error"));
    for name in ["link-noise", "reset-in-flight"] {
        let record = format!("records/{name}.rec");
        let again = bench.json(&["hil", "replay", &record, "--target", "host", "--json"]);
        assert_eq!((&again["identical"], &again["complete"]), (&true.into(), &true.into()), "{again}");
        assert!(again["bytes"].as_u64().expect("a count") > 400_000);
        // The same scenario again is the same record.
        bench.succeed(&["hil", name, "--target", "host", "--record", "again.rec"]);
        assert!(std::fs::read(bench.path("again.rec")).ok() == std::fs::read(bench.path(&record)).ok(), "{name}");
    }
}

#[test]
fn contract_a_changed_record_does_not_replay() {
    let bench = Bench::new();
    bench.write("short.toml", SHORT);
    bench.succeed(&["hil", "short.toml", "--target", "host", "--record", "run.rec"]);
    let record = Record::open(&bench.path("run.rec")).expect("a record");
    // One byte of one answer, under a checksum that fits.
    let mut other = gimbal_bench::record::Recorder::create(&bench.path("other.rec")).expect("made");
    for entry in &record.entries {
        let mut content = entry.content.clone();
        if entry.kind == b'U' && entry.tick == 1_234 {
            content[20] ^= 1;
        }
        other.add(entry.kind, entry.tick, &content).expect("written");
    }
    other.close().expect("closed");
    let output = bench.run(&["hil", "replay", "other.rec", "--target", "host"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("DIFFERS at tick 1234, byte 20"));
}

#[test]
fn contract_a_requirement_that_is_missed_is_status_1() {
    let bench = Bench::new();
    bench.write("strict.toml", SHORT.replace("1e-4", "1e-12"));
    let output = bench.run(&["hil", "strict.toml", "--target", "host", "--out", "out"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("FAIL   attitude_error_rms_rad"));
    assert!(bench.read("out/junit.xml").contains("<failure message=\"attitude_error_rms_rad"));
}

#[test]
fn contract_wrong_scenarios_say_what_where_and_what_would_be_right() {
    let bench = Bench::new();
    for (text, told) in [
        (SHORT.replace("duration_s", "duration"), "line 2, column 1"),
        (SHORT.replace("\"rest\"", "\"resting\""), "line 3"),
        (
            SHORT.replace("attitude_error_rms_rad", "attitude"),
            "`attitude` is no measure; there are attitude_error_rms_rad",
        ),
        (SHORT.replace("most = 1e-4", ""), "give `most`, `least` or both"),
        (SHORT.replace("duration_s = 2", "duration_s = -2"), "`duration_s` is -2; it must lie between"),
        (format!("{SHORT}[[effect]]\nname = \"strybeck\"\n"), "`strybeck` is no effect; there are friction_level"),
        (SHORT.replace("\"rest\"", "\"log\", log = \"no.csv\""), "no.csv"),
    ] {
        bench.write("wrong.toml", &text);
        let line = bench.fail(2, &["hil", "wrong.toml", "--target", "host"]);
        assert!(line.contains(told), "{line}");
    }
    assert!(bench.fail(2, &["hil", "nothing"]).contains("there are paper-unbalance"));
    bench.write("log.csv", "time_s\n");
    assert!(bench.fail(2, &["hil", "replay", "log.csv", "--target", "host"]).contains("is no record"));
    assert!(
        bench
            .fail(2, &["hil", "--port", "/dev/null", "--baud", "115200", "--realtime"])
            .contains("takes 1936843 or more")
    );
}

#[test]
fn contract_what_is_missing_is_status_3_with_the_command_that_mends_it() {
    let bench = Bench::new();
    let output = bench.command(&["hil"]).env("PATH", "").output().expect("runs");
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("apt-get install qemu-system-arm"));
    let output = bench.command(&["doctor", "--port", "/dev/ttyNONE", "--json"]).env("PATH", "").output().expect("runs");
    assert_eq!(output.status.code(), Some(3));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let missing: Vec<&str> = found["findings"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|finding| finding["ok"] == false)
        .inspect(|finding| assert!(finding["mend"].as_str().is_some_and(|mend| !mend.is_empty())))
        .filter_map(|finding| finding["name"].as_str())
        .collect();
    for name in ["emulator", "compiler", "port"] {
        assert!(missing.contains(&name), "{missing:?}");
    }
    assert!(bench.fail(3, &["hil", "--port", "/dev/ttyNONE"]).contains("cannot be opened"));
    assert!(bench.fail(3, &["hil", "--connect", "127.0.0.1:1"]).contains("cannot connect"));
}

#[test]
fn contract_a_socket_is_as_good_as_a_port() {
    let bench = Bench::new();
    bench.write("short.toml", SHORT);
    for _ in 0..2 {
        let served = serve(Ends::Never);
        let report = bench.json(&["hil", "short.toml", "--connect", &served.address, "--json"]);
        assert_eq!((&report["verdict"], &report["host_equals_board"]), (&"pass".into(), &true.into()), "{report:#}");
    }
    let served = serve(Ends::Never);
    let paced = bench.json(&["hil", "short.toml", "--connect", &served.address, "--realtime", "--json"]);
    let elapsed_s = paced["deadlines"]["elapsed_s"].as_f64().expect("a time");
    assert!(elapsed_s > 1.99 && paced["deadlines"]["latency_p99_s"].as_f64().is_some_and(|p99| p99 > 0.0), "{paced:#}");
}

#[test]
fn contract_a_board_that_computes_otherwise_is_found() {
    let bench = Bench::new();
    bench.write("short.toml", SHORT);
    let served = serve(Ends::Lies);
    let output = bench.run(&["hil", "short.toml", "--connect", &served.address, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&report["verdict"], &report["host_equals_board"]), (&"fail".into(), &false.into()));
    assert_eq!(report["first_difference_s"], 0.5);
}

#[test]
fn contract_a_serial_port_carries_the_same_frames() {
    use serialport::{SerialPort, TTYPort};
    let bench = Bench::new();
    bench.write("short.toml", SHORT);
    let (mut master, slave) = TTYPort::pair().expect("a pair of terminals");
    let name = slave.name().expect("a name");
    drop(slave);
    master.set_timeout(Duration::from_millis(20)).expect("set");
    let served = std::thread::spawn(move || {
        let mut host = gimbal_bench::link::Host::new();
        let mut buffer = [0; 1024];
        let begun = Instant::now();
        let mut last = Instant::now();
        while begun.elapsed() < Duration::from_mins(1) && last.elapsed() < Duration::from_secs(20) {
            // Nobody has opened the other end yet, or has closed it.
            let Ok(count) = std::io::Read::read(&mut master, &mut buffer) else { continue };
            let mut answers = Vec::new();
            host.answer(&buffer[..count], &mut answers);
            if master.write_all(&answers).is_err() {
                return;
            }
            last = Instant::now();
        }
    });
    let report = bench.json(&["hil", "short.toml", "--port", &name, "--json"]);
    assert_eq!((&report["verdict"], &report["host_equals_board"]), (&"pass".into(), &true.into()), "{report:#}");
    drop(served);
}
